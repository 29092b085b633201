// tf of ROS 1, by what tf2 has.
#pragma once
#include "ri_tf2.hpp"
namespace tf {
using Vector3 = tf2::Vector3; using Point = tf2::Vector3; using Quaternion = tf2::Quaternion; using Matrix3x3 = tf2::Matrix3x3; using Transform = tf2::Transform; using Pose = tf2::Transform;
using TransformException = tf2::TransformException; using LookupException = tf2::LookupException; using ConnectivityException = tf2::ConnectivityException; using ExtrapolationException = tf2::ExtrapolationException; using InvalidArgument = tf2::InvalidArgumentException;
template <class T> struct Stamped : T {
  ros::Time stamp_; std::string frame_id_;
  Stamped() = default;
  Stamped(const T &from, const ros::Time &stamp, const std::string &frame) : T(from), stamp_(stamp), frame_id_(frame) {}
  void setData(const T &from) { static_cast<T &>(*this) = from; }
};
struct StampedTransform : Transform {
  ros::Time stamp_; std::string frame_id_, child_frame_id_;
  StampedTransform() = default;
  StampedTransform(const Transform &t, const ros::Time &s, const std::string &f, const std::string &c) : Transform(t), stamp_(s), frame_id_(f), child_frame_id_(c) {}
  void setData(const Transform &from) { static_cast<Transform &>(*this) = from; }
};
inline void quaternionMsgToTF(const geometry_msgs::Quaternion &m, Quaternion &q) { q.setValue(m.x, m.y, m.z, m.w); }
inline void quaternionTFToMsg(const Quaternion &q, geometry_msgs::Quaternion &m) { m = tf2::toMsg(q); }
inline void vector3MsgToTF(const geometry_msgs::Vector3 &m, Vector3 &v) { v.setValue(m.x, m.y, m.z); }
inline void vector3TFToMsg(const Vector3 &v, geometry_msgs::Vector3 &m) { m = tf2::toMsg(v); }
inline void pointMsgToTF(const geometry_msgs::Point &m, Vector3 &v) { v.setValue(m.x, m.y, m.z); }
inline void pointTFToMsg(const Vector3 &v, geometry_msgs::Point &m) { tf2::toMsg(v, m); }
inline void poseMsgToTF(const geometry_msgs::Pose &m, Transform &t) { tf2::fromMsg(m, t); }
inline void poseTFToMsg(const Transform &t, geometry_msgs::Pose &m) { tf2::toMsg(t, m); }
inline void transformMsgToTF(const geometry_msgs::Transform &m, Transform &t) { tf2::fromMsg(m, t); }
inline void transformTFToMsg(const Transform &t, geometry_msgs::Transform &m) { m = tf2::toMsg(t); }
inline void poseStampedMsgToTF(const geometry_msgs::PoseStamped &m, Stamped<Transform> &t) { tf2::fromMsg(m.pose, t); t.stamp_ = m.header.stamp; t.frame_id_ = m.header.frame_id; }
inline void poseStampedTFToMsg(const Stamped<Transform> &t, geometry_msgs::PoseStamped &m) { tf2::toMsg(t, m.pose); m.header.stamp = t.stamp_; m.header.frame_id = t.frame_id_; }
inline void transformStampedTFToMsg(const StampedTransform &t, geometry_msgs::TransformStamped &m) { m.transform = tf2::toMsg(t); m.header.stamp = t.stamp_; m.header.frame_id = t.frame_id_; m.child_frame_id = t.child_frame_id_; }
inline void transformStampedMsgToTF(const geometry_msgs::TransformStamped &m, StampedTransform &t) { tf2::fromMsg(m.transform, t); t.stamp_ = m.header.stamp; t.frame_id_ = m.header.frame_id; t.child_frame_id_ = m.child_frame_id; }
inline double getYaw(const Quaternion &q) { return tf2::getYaw(q); }
inline double getYaw(const geometry_msgs::Quaternion &q) { return tf2::getYaw(q); }
inline Quaternion createQuaternionFromRPY(double r, double p, double y) { Quaternion q; q.setRPY(r, p, y); return q; }
inline Quaternion createQuaternionFromYaw(double y) { return createQuaternionFromRPY(0, 0, y); }
inline geometry_msgs::Quaternion createQuaternionMsgFromYaw(double y) { return tf2::toMsg(createQuaternionFromYaw(y)); }
inline geometry_msgs::Quaternion createQuaternionMsgFromRollPitchYaw(double r, double p, double y) { return tf2::toMsg(createQuaternionFromRPY(r, p, y)); }
inline Quaternion createIdentityQuaternion() { return {0, 0, 0, 1}; }
inline std::string resolve(const std::string &prefix, const std::string &name) { return prefix.empty() ? name : prefix + "/" + name; }
inline std::string getPrefixParam(ros::NodeHandle &) { return {}; }
inline std::string strip_leading_slash(const std::string &name) { return !name.empty() && name[0] == '/' ? name.substr(1) : name; }
struct TransformListener : tf2::BufferCore {
  template <class... A> explicit TransformListener(A &&...) {}
  void lookupTransform(const std::string &target, const std::string &source, const ros::Time &, StampedTransform &out) const { transformStampedMsgToTF(ri_look_up(target, source), out); }
  template <class... A> bool waitForTransform(const std::string &, A &&...) const { return ri_found(); }
  template <class A, class B> void ri_move(const std::string &target, const A &in, B &out) const { tf2::doTransform(in, out, ri_look_up(target, "")); }
  void transformPose(const std::string &target, const geometry_msgs::PoseStamped &in, geometry_msgs::PoseStamped &out) const { ri_move(target, in, out); }
  void transformPose(const std::string &target, const Stamped<Pose> &in, Stamped<Pose> &out) const { Transform t; tf2::fromMsg(ri_look_up(target, in.frame_id_).transform, t); out.setData(t * in); out.stamp_ = in.stamp_; out.frame_id_ = target; }
  void transformPoint(const std::string &target, const geometry_msgs::PointStamped &in, geometry_msgs::PointStamped &out) const { ri_move(target, in, out); }
  void transformVector(const std::string &target, const geometry_msgs::Vector3Stamped &in, geometry_msgs::Vector3Stamped &out) const { ri_move(target, in, out); }
  std::string resolve(const std::string &name) const { return name; }
  bool frameExists(const std::string &) const { return ri_found(); }
  template <class... A> int getLatestCommonTime(const std::string &, const std::string &, ros::Time &out, A &&...) const { out = ros::Time::now(); return 0; }
  template <class... A> void transformQuaternion(A &&...) const { ri::unknown("tf::TransformListener::transformQuaternion"); }
  template <class... A> void transformPointCloud(A &&...) const { ri::unknown("tf::TransformListener::transformPointCloud"); }
  template <class... A> void lookupTwist(A &&...) const { ri::unknown("tf::TransformListener::lookupTwist"); }
};
using Transformer = TransformListener;
struct TransformBroadcaster : tf2_ros::TransformBroadcaster {
  using tf2_ros::TransformBroadcaster::sendTransform;
  void sendTransform(const StampedTransform &t) { geometry_msgs::TransformStamped m; transformStampedTFToMsg(t, m); sendTransform(m); }
  void sendTransform(const std::vector<StampedTransform> &all) { for (auto &one : all) sendTransform(one); }
};
template <class M> using MessageFilter = tf2_ros::MessageFilter<M>;
}  // namespace tf
#include "ri_filters.hpp"
