// message_filters: a synchronizer's callback is given one message of each topic: `msg` for the one that is asked about, `msg1` to `msg9` for the others.
#pragma once
#if RI_ROS == 1
#include <ros/ros.h>
#else
#include <rclcpp/rclcpp.hpp>
#endif
#include "ri_core.hpp"

namespace message_filters {
struct Connection { void disconnect() {} };
template <class M> using ri_const = std::shared_ptr<M const>;

template <class F, class... M> struct SyncHolder {
  F callback;
  template <size_t... I> static void deliver(F &call, std::index_sequence<I...>) {
    static const char *names[] = {"msg1", "msg2", "msg3", "msg4", "msg5", "msg6", "msg7", "msg8", "msg9"};
    auto made = std::make_tuple(ri_const<M>(ri::make_message<M>(static_cast<int>(I) == ri::wanted_place ? "msg" : names[I]))...);
    ri::begin();
    if constexpr (std::is_invocable<F &, const ri_const<M> &...>::value) call(std::get<I>(made)...);
    else if constexpr (std::is_invocable<F &, const M &...>::value) call(*std::get<I>(made)...);
    else ri_unknown("a synchronizer's callback");
  }
  static void run(void *self) { deliver(static_cast<SyncHolder *>(self)->callback, std::make_index_sequence<sizeof...(M)>()); }
};
template <class M> struct SimpleFilter {
  void ri_set_name(const char *) {}
  template <class F> Connection registerCallback(const F &callback, RI_HERE) { ri::give_callback<M>("subscriber", callback, ri_file, ri_line); return {}; }
  template <class P> Connection registerCallback(void (*callback)(P), RI_HERE) { ri::give_callback<M>("subscriber", callback, ri_file, ri_line); return {}; }
  template <class T, class P> Connection registerCallback(void (T::*method)(P), T *self, RI_HERE) {
    ri::give_callback<M>("subscriber", [method, self](P p) { (self->*method)(std::forward<P>(p)); }, ri_file, ri_line); return {};
  }
  void setName(const std::string &) {}
};
template <class M, class N = void> struct Subscriber : SimpleFilter<M> {
  Subscriber() = default;
  template <class... A> explicit Subscriber(A &&...) {}
  template <class... A> void subscribe(A &&...) {} void unsubscribe() {} std::string getTopic() const { return {}; }
};
template <class M> struct PassThrough : SimpleFilter<M> { template <class... A> explicit PassThrough(A &&...) {} };
template <class M> struct Cache : SimpleFilter<M> {
  template <class... A> explicit Cache(A &&...) {}
  template <class T> std::shared_ptr<M const> getElemBeforeTime(const T &) const { ri::unknown("message_filters::Cache"); return {}; }
  template <class T> std::shared_ptr<M const> getElemAfterTime(const T &) const { ri::unknown("message_filters::Cache"); return {}; }
};
template <class... M> struct SyncBase {
  void ri_set_name(const char *) {}
  template <class F> Connection registerCallback(const F &callback, RI_HERE) { return keep(callback, ri_file, ri_line); }
  template <class F> Connection registerCallback(F &callback, RI_HERE) { return keep(callback, ri_file, ri_line); }
  template <class T, class U, class... P> Connection registerCallback(void (T::*method)(P...), U *self, RI_HERE) {
    return keep([method, self](const ri_const<M> &...m) { (self->*method)(m...); }, ri_file, ri_line);
  }
  template <class F> Connection keep(F callback, const char *file, int line) {
    ri::give("subscriber", file, line, &SyncHolder<F, M...>::run, new SyncHolder<F, M...>{callback}); return {};
  }
  template <class... A> void connectInput(A &&...) {}
  void setQueueSize(uint32_t) {} template <class... A> void setAgePenalty(A &&...) {} template <class... A> void setMaxIntervalDuration(A &&...) {} template <class... A> void setInterMessageLowerBound(A &&...) {}
};
template <class... M> struct TimeSynchronizer : SyncBase<M...> { template <class... A> explicit TimeSynchronizer(A &&...) {} };
namespace sync_policies {
template <class... M> struct ri_policy { template <class... A> explicit ri_policy(A &&...) {} using Base = SyncBase<M...>; template <class... A> void setMaxIntervalDuration(A &&...) {} template <class... A> void setAgePenalty(A &&...) {} };
template <class... M> struct ApproximateTime : ri_policy<M...> { using ri_policy<M...>::ri_policy; };
template <class... M> struct ExactTime : ri_policy<M...> { using ri_policy<M...>::ri_policy; };
template <class... M> struct ApproximateEpsilonTime : ri_policy<M...> { using ri_policy<M...>::ri_policy; };
template <class... M> struct LatestTime : ri_policy<M...> { using ri_policy<M...>::ri_policy; };
}  // namespace sync_policies
template <class P> struct Synchronizer : P::Base { using Policy = P; template <class... A> explicit Synchronizer(A &&...) {} P *getPolicy() { static P policy; return &policy; } template <class... A> void setMaxIntervalDuration(A &&...) {} };
}  // namespace message_filters
