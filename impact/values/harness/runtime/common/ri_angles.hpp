// angles
#pragma once
#include <cmath>
#include <utility>
#ifndef M_PI
#define M_PI 3.14159265358979323846
#endif
namespace angles {
inline double from_degrees(double d) { return d * M_PI / 180.0; }
inline double to_degrees(double r) { return r * 180.0 / M_PI; }
inline double normalize_angle(double a) { const double r = std::fmod(a + M_PI, 2.0 * M_PI); return r <= 0.0 ? r + M_PI : r - M_PI; }
inline double normalize_angle_positive(double a) { const double r = std::fmod(a, 2.0 * M_PI); return r < 0 ? r + 2.0 * M_PI : r; }
inline double shortest_angular_distance(double from, double to) { return normalize_angle(to - from); }
inline double two_pi_complement(double a) { if (a > 2 * M_PI || a < -2.0 * M_PI) a = std::fmod(a, 2.0 * M_PI); return a < 0 ? 2 * M_PI + a : a > 0 ? -2 * M_PI + a : 2 * M_PI; }
}  // namespace angles
