// tf2 and tf2_ros: a transform that is looked up may be any, or missing; one that is sent is told.
#pragma once
#include "ri_linear.hpp"
#if RI_ROS == 1
#include <ros/ros.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
namespace ri { namespace geo = ::geometry_msgs; using RosTime = ::ros::Time; using RosDuration = ::ros::Duration; }
#else
#include <rclcpp/rclcpp.hpp>
#include <geometry_msgs/msg/point_stamped.hpp>
#include <geometry_msgs/msg/pose_array.hpp>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <geometry_msgs/msg/quaternion_stamped.hpp>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <geometry_msgs/msg/twist.hpp>
#include <geometry_msgs/msg/vector3_stamped.hpp>
#include <geometry_msgs/msg/wrench_stamped.hpp>
namespace ri { namespace geo = ::geometry_msgs::msg; using RosTime = ::rclcpp::Time; using RosDuration = ::rclcpp::Duration; }
#endif
#ifndef RI_HERE
#define RI_HERE const char *ri_file = __builtin_FILE(), int ri_line = __builtin_LINE()
#endif

namespace tf2 {
struct TransformException : std::runtime_error { using std::runtime_error::runtime_error; };
struct ConnectivityException : TransformException { using TransformException::TransformException; };
struct LookupException : TransformException { using TransformException::TransformException; };
struct ExtrapolationException : TransformException { using TransformException::TransformException; };
struct InvalidArgumentException : TransformException { using TransformException::TransformException; };
struct TimeoutException : TransformException { using TransformException::TransformException; };
using Duration = std::chrono::nanoseconds;
using TimePoint = std::chrono::time_point<std::chrono::system_clock, Duration>;
using IDuration = std::chrono::duration<int, std::nano>;
inline const TimePoint TimePointZero = TimePoint(std::chrono::nanoseconds::zero());
inline Duration durationFromSec(double s) { return Duration(static_cast<int64_t>(s * 1e9)); }
inline double durationToSec(const Duration &d) { return static_cast<double>(d.count()) / 1e9; }
inline TimePoint timeFromSec(double s) { return TimePoint(durationFromSec(s)); }
inline double timeToSec(const TimePoint &t) { return durationToSec(t.time_since_epoch()); }
inline TimePoint get_now() { return TimePoint(Duration(ri::get_now())); }
template <class T> struct Stamped : T {
  TimePoint stamp_; std::string frame_id_;
  Stamped() = default;
  template <class S> Stamped(const T &from, const S &, const std::string &frame) : T(from), frame_id_(frame) {}
  void setData(const T &from) { static_cast<T &>(*this) = from; }
};
template <class T> struct WithCovarianceStamped : Stamped<T> { std::array<std::array<double, 6>, 6> cov_mat_; };

inline void fromMsg(const ri::geo::Quaternion &m, Quaternion &q) { q.setValue(m.x, m.y, m.z, m.w); }
inline void fromMsg(const ri::geo::Vector3 &m, Vector3 &v) { v.setValue(m.x, m.y, m.z); }
inline void fromMsg(const ri::geo::Point &m, Vector3 &v) { v.setValue(m.x, m.y, m.z); }
inline void fromMsg(const ri::geo::Transform &m, Transform &t) { Quaternion q; fromMsg(m.rotation, q); Vector3 v; fromMsg(m.translation, v); t = Transform(q, v); }
inline void fromMsg(const ri::geo::Pose &m, Transform &t) { Quaternion q; fromMsg(m.orientation, q); Vector3 v; fromMsg(m.position, v); t = Transform(q, v); }
template <class M, class T> void fromMsg(const M &m, Stamped<T> &t) {
  if constexpr (std::is_same<M, ri::geo::TransformStamped>::value) fromMsg(m.transform, static_cast<T &>(t));
  else if constexpr (std::is_same<M, ri::geo::PoseStamped>::value) fromMsg(m.pose, static_cast<T &>(t));
  else ri::unknown("tf2::fromMsg");
  t.frame_id_ = m.header.frame_id;
}
inline ri::geo::Quaternion toMsg(const Quaternion &q) { ri::geo::Quaternion m; m.x = q.x(); m.y = q.y(); m.z = q.z(); m.w = q.w(); return m; }
inline ri::geo::Vector3 toMsg(const Vector3 &v) { ri::geo::Vector3 m; m.x = v.x(); m.y = v.y(); m.z = v.z(); return m; }
inline void toMsg(const Vector3 &v, ri::geo::Point &m) { m.x = v.x(); m.y = v.y(); m.z = v.z(); }
inline ri::geo::Transform toMsg(const Transform &t) { ri::geo::Transform m; m.translation = toMsg(t.getOrigin()); m.rotation = toMsg(t.getRotation()); return m; }
inline void toMsg(const Transform &t, ri::geo::Pose &m) { toMsg(t.getOrigin(), m.position); m.orientation = toMsg(t.getRotation()); }
template <class A, class B> void convert(const A &a, B &b) {
  if constexpr (std::is_same<A, B>::value) b = a;
  else if constexpr (ri::is_message<A>::value) fromMsg(a, b);
  else if constexpr (std::is_same<B, ri::geo::Pose>::value || std::is_same<B, ri::geo::Point>::value) toMsg(a, b);
  else b = toMsg(a);
}
// What any transform makes of a pose is any pose: an input, so that nobody has to solve for sines. It is finite where the
// pose was.
inline void ri_move(double &out, double in, const char *name) {
  out = ri_float64(name);
  ri_assume(std::isfinite(out) || !std::isfinite(in));
}
template <class P> void ri_move_vector(P &out, const P &in) {
  P moved = in;
  ri_move(moved.x, in.x, "x"); ri_move(moved.y, in.y, "y"); ri_move(moved.z, in.z, "z");
  out = moved;
}
template <class Q> void ri_turn(Q &out, const Q &in) { ri_move_vector(out, in); ri_move(out.w, in.w, "w"); }
template <class P> void ri_move_pose(P &out, const P &in) {
  ri_enter("position"); ri_move_vector(out.position, in.position); ri_leave();
  ri_enter("orientation"); ri_turn(out.orientation, in.orientation); ri_leave();
}
inline int ri_moved = 0;
template <class M> void doTransform(const M &in, M &out, const ri::geo::TransformStamped &by) {
  M made = in;
  ri_enter("~moved"); ri_enter_index(static_cast<uint64_t>(ri_moved++));
  if constexpr (std::is_same<M, ri::geo::Point>::value || std::is_same<M, ri::geo::Vector3>::value) ri_move_vector(made, in);
  else if constexpr (std::is_same<M, ri::geo::Pose>::value) ri_move_pose(made, in);
  else if constexpr (std::is_same<M, ri::geo::Quaternion>::value) ri_turn(made, in);
  else if constexpr (std::is_same<M, ri::geo::PointStamped>::value) { ri_move_vector(made.point, in.point); made.header = by.header; }
  else if constexpr (std::is_same<M, ri::geo::Vector3Stamped>::value) { ri_move_vector(made.vector, in.vector); made.header = by.header; }
  else if constexpr (std::is_same<M, ri::geo::QuaternionStamped>::value) { ri_turn(made.quaternion, in.quaternion); made.header = by.header; }
  else if constexpr (std::is_same<M, ri::geo::PoseStamped>::value) { ri_move_pose(made.pose, in.pose); made.header = by.header; }
  else ri::unknown("tf2::doTransform");
  ri_leave(); ri_leave();
  out = made;
}
namespace impl {
inline Quaternion toQuaternion(const Quaternion &q) { return q; }
inline Quaternion toQuaternion(const ri::geo::Quaternion &m) { Quaternion q; fromMsg(m, q); return q; }
template <class T> double getYaw(const T &t) { double y, p, r; Matrix3x3(toQuaternion(t)).getEulerYPR(y, p, r); return y; }
}  // namespace impl
inline double getYaw(const Quaternion &q) { return impl::getYaw(q); }
inline double getYaw(const ri::geo::Quaternion &q) { return impl::getYaw(q); }
template <class A> void getEulerYPR(const A &a, double &y, double &p, double &r) { Matrix3x3(impl::toQuaternion(a)).getEulerYPR(y, p, r); }
template <class A> A getTransformIdentity() { A a; a.setIdentity(); return a; }
template <class M> std::string getFrameId(const M &m) { return m.header.frame_id; }

struct BufferCore {
  virtual ~BufferCore() = default;
  void ri_set_name(const char *) {}
  static int &ri_count() { static int count = 0; return count; }
  static bool ri_found() {
    ri_enter("~transform"); ri_enter_index(static_cast<uint64_t>(ri_count()++));
    bool found = ri_boolean("found") != 0;
    ri_leave(); ri_leave();
    return found;
  }
  // Any transform there may be, or an exception.
  ri::geo::TransformStamped ri_look_up(const std::string &target, const std::string &source) const {
    ri::geo::TransformStamped made;
    ri_enter("~transform"); ri_enter_index(static_cast<uint64_t>(ri_count()++));
    bool found = ri_boolean("found") != 0;
    ri::fill(made.transform, "transform");
    ri::fill(made.header.stamp, "stamp");
    ri_leave(); ri_leave();
    if (!found) throw LookupException("no transform");
    made.header.frame_id = target; made.child_frame_id = source;
    return made;
  }
  template <class... A> ri::geo::TransformStamped lookupTransform(const std::string &target, const std::string &source, A &&...) const { return ri_look_up(target, source); }
  template <class A, class B, class D> ri::geo::TransformStamped lookupTransform(const std::string &target, const A &, const std::string &source, const B &, const std::string &, const D &) const { return ri_look_up(target, source); }
  template <class... A> bool canTransform(const std::string &, A &&...) const { return ri_found(); }
  template <class M, class... A> M &transform(const M &in, M &out, const std::string &target, A &&...) const { doTransform(in, out, ri_look_up(target, "")); return out; }
  template <class M, class... A> M transform(const M &in, const std::string &target, A &&...) const { M out; doTransform(in, out, ri_look_up(target, "")); return out; }
  template <class M> bool setTransform(const M &, const std::string &, bool = false) { ri::effect("transform", "buffer"); return true; }
  void clear() {} std::string allFramesAsString() const { return {}; } std::string allFramesAsYAML() const { return {}; }
  std::vector<std::string> getAllFrameNames() const { ri::unknown("tf2::BufferCore::getAllFrameNames"); return {}; }
  void setUsingDedicatedThread(bool) {} bool _frameExists(const std::string &) const { return ri_found(); }
};
}  // namespace tf2
namespace tf2_ros {
struct Buffer : tf2::BufferCore {
  using SharedPtr = std::shared_ptr<Buffer>; using ConstSharedPtr = std::shared_ptr<const Buffer>; using UniquePtr = std::unique_ptr<Buffer>;
  template <class... A> explicit Buffer(A &&...) {}
  template <class... A> void setCreateTimerInterface(A &&...) {}
  template <class... A> ri::Anything waitForTransform(A &&...) { ri::unknown("tf2_ros::Buffer::waitForTransform"); return {}; }
};
using BufferInterface = Buffer; using BufferClient = Buffer;
struct TransformListener { void ri_set_name(const char *) {} template <class... A> explicit TransformListener(A &&...) {} };
struct TransformBroadcaster : ri::Named {
  TransformBroadcaster() { ri_name = "transform broadcaster"; }
  template <class A, class... B> explicit TransformBroadcaster(A &&, B &&...) { ri_name = "transform broadcaster"; }
  void sendTransform(const ri::geo::TransformStamped &one) { ri::publish("transform", ri_name, one); }
  void sendTransform(const std::vector<ri::geo::TransformStamped> &all) { for (auto &one : all) sendTransform(one); }
};
struct StaticTransformBroadcaster : TransformBroadcaster { using TransformBroadcaster::TransformBroadcaster; StaticTransformBroadcaster() = default; };
struct CreateTimerROS { template <class... A> explicit CreateTimerROS(A &&...) {} };
template <class M, class B = Buffer> struct MessageFilter {
  void ri_set_name(const char *) {}
  template <class... A> explicit MessageFilter(A &&...) {}
  template <class F> ri::Anything registerCallback(F callback, RI_HERE) { ri::give_callback<M>("subscriber", callback, ri_file, ri_line); return {}; }
  template <class T, class P> ri::Anything registerCallback(void (T::*method)(P), T *self, RI_HERE) {
    ri::give_callback<M>("subscriber", [method, self](P p) { (self->*method)(std::forward<P>(p)); }, ri_file, ri_line); return {};
  }
  template <class... A> void setTargetFrame(A &&...) {} template <class... A> void setTargetFrames(A &&...) {} template <class... A> void setTolerance(A &&...) {}
  template <class... A> void registerFailureCallback(A &&...) {} template <class... A> void connectInput(A &&...) {} void clear() {}
};
inline ri::RosTime ri_time() { return ri::RosTime(); }
#if RI_ROS == 2
inline tf2::TimePoint fromMsg(const builtin_interfaces::msg::Time &t) { return tf2::TimePoint(std::chrono::nanoseconds(static_cast<int64_t>(t.sec) * 1000000000LL + t.nanosec)); }
inline tf2::Duration fromMsg(const builtin_interfaces::msg::Duration &t) { return std::chrono::nanoseconds(static_cast<int64_t>(t.sec) * 1000000000LL + t.nanosec); }
inline tf2::TimePoint fromRclcpp(const rclcpp::Time &t) { return tf2::TimePoint(std::chrono::nanoseconds(t.nanoseconds())); }
inline tf2::Duration fromRclcpp(const rclcpp::Duration &t) { return std::chrono::nanoseconds(t.nanoseconds()); }
inline rclcpp::Time toRclcpp(const tf2::TimePoint &t) { return rclcpp::Time(t.time_since_epoch().count(), RCL_ROS_TIME); }
inline rclcpp::Duration toRclcpp(const tf2::Duration &t) { return rclcpp::Duration(t); }
#endif
}  // namespace tf2_ros
