// image_transport: images come and go as they are.
#pragma once
#if RI_ROS == 1
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
namespace ri { namespace images = ::sensor_msgs; }
#else
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>
namespace ri { namespace images = ::sensor_msgs::msg; }
#endif
#include "ri_filters.hpp"

namespace image_transport {
struct SingleSubscriberPublisher {};
typedef std::function<void(const SingleSubscriberPublisher &)> SubscriberStatusCallback;
struct Publisher : ri::Named {
  template <class M> void publish(const M &message) const { if constexpr (ri::is_message<M>::value) ri::publish("publish", ri_name, message); else ri::publish("publish", ri_name, *message); }
  uint32_t getNumSubscribers() const { ri_enter("~publisher"); ri_enter(ri_name); uint64_t v = ri_integer("subscribers", 32, 0); ri_leave(); ri_leave(); return static_cast<uint32_t>(v); }
  std::string getTopic() const { return {}; } void shutdown() {} explicit operator bool() const { return true; }
};
struct CameraPublisher : Publisher {
  using Publisher::publish;
  template <class I, class C> void publish(const I &image, const C &) const { Publisher::publish(image); }
  template <class I, class C, class T> void publish(I &image, C &, T) const { Publisher::publish(image); }
};
struct Subscriber { void ri_set_name(const char *) {} void shutdown() {} std::string getTopic() const { return {}; } std::string getTransport() const { return {}; } uint32_t getNumPublishers() const { return static_cast<uint32_t>(ri_integer("~publishers", 32, 0)); } explicit operator bool() const { return true; } };
using CameraSubscriber = Subscriber;
struct TransportHints { template <class... A> TransportHints(A &&...) {} std::string getTransport() const { return {}; } };
using Image = ri::images::Image;
using CameraInfo = ri::images::CameraInfo;
template <class F> void ri_give_camera(F callback, const char *file, int line) {
  ri::give("subscriber", file, line, &message_filters::SyncHolder<F, Image, CameraInfo>::run, new message_filters::SyncHolder<F, Image, CameraInfo>{callback});
}
struct ImageTransport {
  void ri_set_name(const char *) {}
  template <class... A> explicit ImageTransport(A &&...) {}
  template <class... A> Publisher advertise(const std::string &topic, A &&...) { Publisher made; made.ri_keep_name(topic); return made; }
  template <class... A> CameraPublisher advertiseCamera(const std::string &topic, A &&...) { CameraPublisher made; made.ri_keep_name(topic); return made; }
  template <class F, class = std::enable_if_t<!std::is_member_pointer<F>::value>> Subscriber subscribe(const std::string &, uint32_t, const F &callback, RI_HERE) { ri::give_callback<Image>("subscriber", callback, ri_file, ri_line); return {}; }
  template <class T, class U, class P> Subscriber subscribe(const std::string &, uint32_t, void (T::*method)(P), U object, const TransportHints & = {}, RI_HERE) {
    ri::give_callback<Image>("subscriber", [method, object](P p) { ((*object).*method)(std::forward<P>(p)); }, ri_file, ri_line); return {};
  }
  template <class F, class = std::enable_if_t<!std::is_member_pointer<F>::value>> Subscriber subscribeCamera(const std::string &, uint32_t, const F &callback, RI_HERE) { ri_give_camera(callback, ri_file, ri_line); return {}; }
  template <class T, class U, class P, class Q> Subscriber subscribeCamera(const std::string &, uint32_t, void (T::*method)(P, Q), U object, const TransportHints & = {}, RI_HERE) {
    ri_give_camera([method, object](P p, Q q) { ((*object).*method)(std::forward<P>(p), std::forward<Q>(q)); }, ri_file, ri_line); return {};
  }
};
#if RI_ROS == 2
template <class N, class... A> Publisher create_publisher(N &&, const std::string &topic, A &&...) { Publisher made; made.ri_keep_name(topic); return made; }
template <class N, class... A> CameraPublisher create_camera_publisher(N &&, const std::string &topic, A &&...) { CameraPublisher made; made.ri_keep_name(topic); return made; }
template <class N, class F> Subscriber create_subscription(N &&, const std::string &, const F &callback, const std::string &, const rmw_qos_profile_t & = {}, RI_HERE) { ri::give_callback<Image>("subscriber", callback, ri_file, ri_line); return {}; }
template <class N, class F, class Q, class O> Subscriber create_subscription(N &&, const std::string &, const F &callback, const std::string &, const Q &, const O &, RI_HERE) { ri::give_callback<Image>("subscriber", callback, ri_file, ri_line); return {}; }
template <class N, class F> CameraSubscriber create_camera_subscription(N &&, const std::string &, const F &callback, const std::string &, const rmw_qos_profile_t & = {}, RI_HERE) { ri_give_camera(callback, ri_file, ri_line); return {}; }
#endif
template <class... A> std::string getCameraInfoTopic(const std::string &topic) { return topic; }
struct SubscriberFilter : message_filters::SimpleFilter<Image> { SubscriberFilter() = default; template <class... A> explicit SubscriberFilter(A &&...) {} template <class... A> void subscribe(A &&...) {} void unsubscribe() {} std::string getTopic() const { return {}; } };
}  // namespace image_transport
