// tf2/LinearMath (of Bullet) as far as callbacks use it, in doubles.
#pragma once
#include "ri_core.hpp"

typedef double tf2Scalar;
typedef double tfScalar;
#define TF2SIMD_PI 3.14159265358979323846
#define TF2_PI TF2SIMD_PI
#define TFSIMD_PI TF2SIMD_PI

namespace tf2 {
struct Vector3 {
  double m_floats[4] = {0, 0, 0, 0};
  Vector3() = default;
  Vector3(double x, double y, double z) : m_floats{x, y, z, 0} {}
  double x() const { return m_floats[0]; } double y() const { return m_floats[1]; } double z() const { return m_floats[2]; }
  double getX() const { return m_floats[0]; } double getY() const { return m_floats[1]; } double getZ() const { return m_floats[2]; }
  void setX(double v) { m_floats[0] = v; } void setY(double v) { m_floats[1] = v; } void setZ(double v) { m_floats[2] = v; }
  void setValue(double x, double y, double z) { m_floats[0] = x; m_floats[1] = y; m_floats[2] = z; }
  void setZero() { setValue(0, 0, 0); }
  double operator[](int i) const { return m_floats[i]; } double &operator[](int i) { return m_floats[i]; }
  double dot(const Vector3 &o) const { return x() * o.x() + y() * o.y() + z() * o.z(); }
  double length2() const { return dot(*this); } double length() const { return std::sqrt(length2()); }
  double distance(const Vector3 &o) const { return (o - *this).length(); } double distance2(const Vector3 &o) const { return (o - *this).length2(); }
  Vector3 cross(const Vector3 &o) const { return {y() * o.z() - z() * o.y(), z() * o.x() - x() * o.z(), x() * o.y() - y() * o.x()}; }
  Vector3 &normalize() { return *this = *this / length(); } Vector3 normalized() const { return *this / length(); }
  double angle(const Vector3 &o) const { return std::acos(dot(o) / std::sqrt(length2() * o.length2())); }
  Vector3 lerp(const Vector3 &o, double t) const { return *this + (o - *this) * t; }
  Vector3 operator+(const Vector3 &o) const { return {x() + o.x(), y() + o.y(), z() + o.z()}; }
  Vector3 operator-(const Vector3 &o) const { return {x() - o.x(), y() - o.y(), z() - o.z()}; }
  Vector3 operator-() const { return {-x(), -y(), -z()}; }
  Vector3 operator*(double s) const { return {x() * s, y() * s, z() * s}; } Vector3 operator/(double s) const { return {x() / s, y() / s, z() / s}; }
  Vector3 &operator+=(const Vector3 &o) { return *this = *this + o; } Vector3 &operator-=(const Vector3 &o) { return *this = *this - o; }
  Vector3 &operator*=(double s) { return *this = *this * s; } Vector3 &operator/=(double s) { return *this = *this / s; }
  bool operator==(const Vector3 &o) const { return x() == o.x() && y() == o.y() && z() == o.z(); }
};
inline Vector3 operator*(double s, const Vector3 &v) { return v * s; }
inline double tf2Distance(const Vector3 &a, const Vector3 &b) { return a.distance(b); }
struct Quaternion {
  double m_floats[4] = {0, 0, 0, 0};
  Quaternion() = default;
  Quaternion(double x, double y, double z, double w) : m_floats{x, y, z, w} {}
  Quaternion(const Vector3 &axis, double angle) { setRotation(axis, angle); }
  double x() const { return m_floats[0]; } double y() const { return m_floats[1]; } double z() const { return m_floats[2]; } double w() const { return m_floats[3]; }
  double getX() const { return x(); } double getY() const { return y(); } double getZ() const { return z(); } double getW() const { return w(); }
  void setX(double v) { m_floats[0] = v; } void setY(double v) { m_floats[1] = v; } void setZ(double v) { m_floats[2] = v; } void setW(double v) { m_floats[3] = v; }
  void setValue(double x, double y, double z, double w) { m_floats[0] = x; m_floats[1] = y; m_floats[2] = z; m_floats[3] = w; }
  double operator[](int i) const { return m_floats[i]; } double &operator[](int i) { return m_floats[i]; }
  void setRotation(const Vector3 &axis, double angle) { double s = std::sin(angle * 0.5) / axis.length(); setValue(axis.x() * s, axis.y() * s, axis.z() * s, std::cos(angle * 0.5)); }
  void setRPY(double roll, double pitch, double yaw) {
    double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2), cp = std::cos(pitch / 2), sp = std::sin(pitch / 2), cr = std::cos(roll / 2), sr = std::sin(roll / 2);
    setValue(sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy);
  }
  void setEuler(double yaw, double pitch, double roll) { setRPY(pitch, yaw, roll); }
  void setEulerZYX(double yaw, double pitch, double roll) { setRPY(roll, pitch, yaw); }
  double dot(const Quaternion &o) const { return x() * o.x() + y() * o.y() + z() * o.z() + w() * o.w(); }
  double length2() const { return dot(*this); } double length() const { return std::sqrt(length2()); }
  Quaternion &normalize() { return *this = *this / length(); } Quaternion normalized() const { return *this / length(); }
  Quaternion inverse() const { return {-x(), -y(), -z(), w()}; }
  double getAngle() const { return 2 * std::acos(w()); }
  double getAngleShortestPath() const { return w() < 0 ? 2 * std::acos(-w()) : 2 * std::acos(w()); }
  double angle(const Quaternion &o) const { return std::acos(dot(o) / std::sqrt(length2() * o.length2())); }
  double angleShortestPath(const Quaternion &o) const { double d = dot(o), s = std::sqrt(length2() * o.length2()); return d < 0 ? std::acos(-d / s) * 2 : std::acos(d / s) * 2; }
  Vector3 getAxis() const { double s = 1 - w() * w(); if (s < 10 * 2.2204460492503131e-16) return {1, 0, 0}; double r = std::sqrt(s); return {x() / r, y() / r, z() / r}; }
  Quaternion slerp(const Quaternion &, double) const { ri::unknown("tf2::Quaternion::slerp"); return *this; }
  Quaternion operator*(const Quaternion &q) const {
    return {w() * q.x() + x() * q.w() + y() * q.z() - z() * q.y(), w() * q.y() + y() * q.w() + z() * q.x() - x() * q.z(),
            w() * q.z() + z() * q.w() + x() * q.y() - y() * q.x(), w() * q.w() - x() * q.x() - y() * q.y() - z() * q.z()};
  }
  Quaternion &operator*=(const Quaternion &q) { return *this = *this * q; }
  Quaternion operator*(double s) const { return {x() * s, y() * s, z() * s, w() * s}; } Quaternion operator/(double s) const { return {x() / s, y() / s, z() / s, w() / s}; }
  Quaternion operator+(const Quaternion &o) const { return {x() + o.x(), y() + o.y(), z() + o.z(), w() + o.w()}; }
  Quaternion operator-(const Quaternion &o) const { return {x() - o.x(), y() - o.y(), z() - o.z(), w() - o.w()}; }
  Quaternion operator-() const { return {-x(), -y(), -z(), -w()}; }
  bool operator==(const Quaternion &o) const { return x() == o.x() && y() == o.y() && z() == o.z() && w() == o.w(); }
  static Quaternion getIdentity() { return {0, 0, 0, 1}; }
};
struct Matrix3x3 {
  Vector3 m_el[3];
  Matrix3x3() = default;
  explicit Matrix3x3(const Quaternion &q) { setRotation(q); }
  Matrix3x3(double a, double b, double c, double d, double e, double f, double g, double h, double i) { setValue(a, b, c, d, e, f, g, h, i); }
  void setValue(double a, double b, double c, double d, double e, double f, double g, double h, double i) { m_el[0] = {a, b, c}; m_el[1] = {d, e, f}; m_el[2] = {g, h, i}; }
  void setIdentity() { setValue(1, 0, 0, 0, 1, 0, 0, 0, 1); }
  static Matrix3x3 getIdentity() { return {1, 0, 0, 0, 1, 0, 0, 0, 1}; }
  void setRotation(const Quaternion &q) {
    double s = 2.0 / q.length2(), xs = q.x() * s, ys = q.y() * s, zs = q.z() * s, wx = q.w() * xs, wy = q.w() * ys, wz = q.w() * zs;
    double xx = q.x() * xs, xy = q.x() * ys, xz = q.x() * zs, yy = q.y() * ys, yz = q.y() * zs, zz = q.z() * zs;
    setValue(1 - (yy + zz), xy - wz, xz + wy, xy + wz, 1 - (xx + zz), yz - wx, xz - wy, yz + wx, 1 - (xx + yy));
  }
  void setRPY(double roll, double pitch, double yaw) { Quaternion q; q.setRPY(roll, pitch, yaw); setRotation(q); }
  void setEulerYPR(double yaw, double pitch, double roll) { setRPY(roll, pitch, yaw); }
  const Vector3 &operator[](int i) const { return m_el[i]; } Vector3 &operator[](int i) { return m_el[i]; }
  Vector3 getRow(int i) const { return m_el[i]; } Vector3 getColumn(int i) const { return {m_el[0][i], m_el[1][i], m_el[2][i]}; }
  Vector3 operator*(const Vector3 &v) const { return {m_el[0].dot(v), m_el[1].dot(v), m_el[2].dot(v)}; }
  Matrix3x3 transpose() const { return {m_el[0][0], m_el[1][0], m_el[2][0], m_el[0][1], m_el[1][1], m_el[2][1], m_el[0][2], m_el[1][2], m_el[2][2]}; }
  Matrix3x3 operator*(const Matrix3x3 &o) const { Matrix3x3 t = o.transpose(), r; for (int i = 0; i < 3; ++i) for (int j = 0; j < 3; ++j) r.m_el[i][j] = m_el[i].dot(t.m_el[j]); return r; }
  void getEulerYPR(double &yaw, double &pitch, double &roll, unsigned = 1) const {
    if (std::fabs(m_el[2].x()) >= 1) {
      yaw = 0;
      double delta = std::atan2(m_el[2].y(), m_el[2].z());
      pitch = m_el[2].x() < 0 ? TF2SIMD_PI / 2 : -TF2SIMD_PI / 2; roll = delta;
      return;
    }
    pitch = -std::asin(m_el[2].x());
    double c = std::cos(pitch);
    roll = std::atan2(m_el[2].y() / c, m_el[2].z() / c); yaw = std::atan2(m_el[1].x() / c, m_el[0].x() / c);
  }
  void getEulerZYX(double &yaw, double &pitch, double &roll, unsigned n = 1) const { getEulerYPR(yaw, pitch, roll, n); }
  void getRPY(double &roll, double &pitch, double &yaw, unsigned n = 1) const { getEulerYPR(yaw, pitch, roll, n); }
  void getRotation(Quaternion &q) const {
    double trace = m_el[0].x() + m_el[1].y() + m_el[2].z();
    if (trace > 0) {
      double s = std::sqrt(trace + 1), w = s * 0.5; s = 0.5 / s;
      q.setValue((m_el[2].y() - m_el[1].z()) * s, (m_el[0].z() - m_el[2].x()) * s, (m_el[1].x() - m_el[0].y()) * s, w);
      return;
    }
    int i = m_el[0].x() < m_el[1].y() ? (m_el[1].y() < m_el[2].z() ? 2 : 1) : (m_el[0].x() < m_el[2].z() ? 2 : 0), j = (i + 1) % 3, k = (i + 2) % 3;
    double s = std::sqrt(m_el[i][i] - m_el[j][j] - m_el[k][k] + 1), t[4];
    t[i] = s * 0.5; s = 0.5 / s; t[3] = (m_el[k][j] - m_el[j][k]) * s; t[j] = (m_el[j][i] + m_el[i][j]) * s; t[k] = (m_el[k][i] + m_el[i][k]) * s;
    q.setValue(t[0], t[1], t[2], t[3]);
  }
};
struct Transform {
  Matrix3x3 m_basis = Matrix3x3::getIdentity(); Vector3 m_origin;
  Transform() = default;
  explicit Transform(const Quaternion &q, const Vector3 &v = {}) : m_basis(q), m_origin(v) {}
  explicit Transform(const Matrix3x3 &m, const Vector3 &v = {}) : m_basis(m), m_origin(v) {}
  static Transform getIdentity() { return {}; } void setIdentity() { *this = {}; }
  const Vector3 &getOrigin() const { return m_origin; } Vector3 &getOrigin() { return m_origin; } void setOrigin(const Vector3 &v) { m_origin = v; }
  const Matrix3x3 &getBasis() const { return m_basis; } Matrix3x3 &getBasis() { return m_basis; } void setBasis(const Matrix3x3 &m) { m_basis = m; }
  Quaternion getRotation() const { Quaternion q; m_basis.getRotation(q); return q; } void setRotation(const Quaternion &q) { m_basis.setRotation(q); }
  Transform inverse() const { Matrix3x3 t = m_basis.transpose(); return Transform(t, t * -m_origin); }
  Transform inverseTimes(const Transform &t) const { return inverse() * t; }
  Vector3 operator*(const Vector3 &v) const { return m_basis * v + m_origin; } Vector3 operator()(const Vector3 &v) const { return *this * v; }
  Quaternion operator*(const Quaternion &q) const { return getRotation() * q; }
  Transform operator*(const Transform &t) const { return Transform(m_basis * t.m_basis, *this * t.m_origin); }
  Transform &operator*=(const Transform &t) { return *this = *this * t; }
  void mult(const Transform &a, const Transform &b) { *this = a * b; }
};
inline Vector3 quatRotate(const Quaternion &q, const Vector3 &v) { return Matrix3x3(q) * v; }
inline Quaternion inverse(const Quaternion &q) { return q.inverse(); }
inline double angle(const Quaternion &a, const Quaternion &b) { return a.angle(b); }
inline double dot(const Quaternion &a, const Quaternion &b) { return a.dot(b); }
inline Quaternion slerp(const Quaternion &a, const Quaternion &b, double t) { return a.slerp(b, t); }
inline tf2Scalar tf2Sqrt(tf2Scalar v) { return std::sqrt(v); }
}  // namespace tf2
