// rclcpp without ROS: what is published, called and logged is told; callbacks are kept until the harness wants one.
#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <future>
#include <iostream>
#include <memory_resource>
#include <thread>
#include <rosidl_runtime_cpp/ri_message.hpp>
#include <builtin_interfaces/msg/duration.hpp>
#include <builtin_interfaces/msg/time.hpp>
#include <rcl_interfaces/msg/floating_point_range.hpp>
#include <rcl_interfaces/msg/integer_range.hpp>
#include <rcl_interfaces/msg/parameter.hpp>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <rcl_interfaces/msg/parameter_event.hpp>
#include <rcl_interfaces/msg/parameter_type.hpp>
#include <rcl_interfaces/msg/set_parameters_result.hpp>
#include "ri_core.hpp"

#define RI_HERE const char *ri_file = __builtin_FILE(), int ri_line = __builtin_LINE()

#define RCLCPP_SMART_PTR_DEFINITIONS(...)                                                                     \
  using SharedPtr = std::shared_ptr<__VA_ARGS__>; using ConstSharedPtr = std::shared_ptr<const __VA_ARGS__>;  \
  using WeakPtr = std::weak_ptr<__VA_ARGS__>; using ConstWeakPtr = std::weak_ptr<const __VA_ARGS__>;          \
  using UniquePtr = std::unique_ptr<__VA_ARGS__>;                                                             \
  template <class... RiA> static std::shared_ptr<__VA_ARGS__> make_shared(RiA &&...a) {                       \
    return std::make_shared<__VA_ARGS__>(std::forward<RiA>(a)...);                                            \
  }
#define RCLCPP_SMART_PTR_DEFINITIONS_NOT_COPYABLE(...) RCLCPP_SMART_PTR_DEFINITIONS(__VA_ARGS__)
#define RCLCPP_SMART_PTR_ALIASES_ONLY(...) RCLCPP_SMART_PTR_DEFINITIONS(__VA_ARGS__)
#define RCLCPP_SHARED_PTR_DEFINITIONS(...) RCLCPP_SMART_PTR_DEFINITIONS(__VA_ARGS__)
#define RCLCPP_UNIQUE_PTR_DEFINITIONS(...) using UniquePtr = std::unique_ptr<__VA_ARGS__>;
#define RCLCPP_WEAK_PTR_DEFINITIONS(...) using WeakPtr = std::weak_ptr<__VA_ARGS__>;
#define RCLCPP_DISABLE_COPY(...) __VA_ARGS__(const __VA_ARGS__ &) = delete; __VA_ARGS__ &operator=(const __VA_ARGS__ &) = delete;
#define RCLCPP_PUBLIC
#define RCLCPP_VERSION_MAJOR 30
#define RCLCPP_VERSION_MINOR 1
#define RCLCPP_VERSION_PATCH 6
#define RCLCPP_VERSION_STR "30.1.6"
#define RCLCPP_VERSION_GTE(major, minor, patch)                                                               \
  ((major) < 30 || ((major) == 30 && ((minor) < 1 || ((minor) == 1 && (patch) <= 6))))
#define RCLCPP_LOCAL

typedef int rcl_ret_t;
enum rcl_clock_type_t { RCL_CLOCK_UNINITIALIZED, RCL_ROS_TIME, RCL_SYSTEM_TIME, RCL_STEADY_TIME };
typedef int64_t rcl_time_point_value_t;
typedef int64_t rcl_duration_value_t;
enum { RCUTILS_LOG_SEVERITY_UNSET = 0, RCUTILS_LOG_SEVERITY_DEBUG = 10, RCUTILS_LOG_SEVERITY_INFO = 20, RCUTILS_LOG_SEVERITY_WARN = 30, RCUTILS_LOG_SEVERITY_ERROR = 40, RCUTILS_LOG_SEVERITY_FATAL = 50 };
#define RCUTILS_RET_OK 0
#define RCL_RET_OK 0
inline int rcutils_logging_set_logger_level(const char *, int) { return 0; }
struct rmw_request_id_t { int8_t writer_guid[16]; int64_t sequence_number; };
struct rmw_qos_profile_t { int history = 0; size_t depth = 0; int reliability = 0; int durability = 0; };
enum rmw_qos_history_policy_t { RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT, RMW_QOS_POLICY_HISTORY_KEEP_LAST, RMW_QOS_POLICY_HISTORY_KEEP_ALL };
enum rmw_qos_reliability_policy_t { RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_RELIABILITY_RELIABLE, RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT };
enum rmw_qos_durability_policy_t { RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT, RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL, RMW_QOS_POLICY_DURABILITY_VOLATILE };
inline const rmw_qos_profile_t rmw_qos_profile_default{}, rmw_qos_profile_sensor_data{}, rmw_qos_profile_services_default{}, rmw_qos_profile_parameters{}, rmw_qos_profile_system_default{};

namespace rclcpp {
namespace exceptions {
struct ParameterNotDeclaredException : std::runtime_error { using std::runtime_error::runtime_error; };
struct ParameterAlreadyDeclaredException : std::runtime_error { using std::runtime_error::runtime_error; };
struct InvalidParameterTypeException : std::runtime_error { using std::runtime_error::runtime_error; };
struct InvalidParameterValueException : std::runtime_error { using std::runtime_error::runtime_error; };
struct ParameterUninitializedException : std::runtime_error { using std::runtime_error::runtime_error; };
struct ParameterModifiedInCallbackException : std::runtime_error { using std::runtime_error::runtime_error; };
struct RCLError : std::runtime_error { using std::runtime_error::runtime_error; };
struct RCLInvalidArgument : RCLError { using RCLError::RCLError; };
}  // namespace exceptions
struct ParameterTypeException : std::runtime_error { using std::runtime_error::runtime_error; };

struct Duration {
  int64_t ri_value = 0;
  Duration() = default;
  Duration(int32_t s, uint32_t n) : ri_value(static_cast<int64_t>(s) * 1000000000LL + n) {}
  explicit Duration(int64_t nanoseconds) : ri_value(nanoseconds) {}
  template <class R, class P> Duration(const std::chrono::duration<R, P> &d) : ri_value(std::chrono::duration_cast<std::chrono::nanoseconds>(d).count()) {}
  Duration(const builtin_interfaces::msg::Duration &m) : Duration(m.sec, m.nanosec) {}
  int64_t nanoseconds() const { return ri_value; }
  double seconds() const { return static_cast<double>(ri_value) / 1e9; }
  static Duration from_seconds(double s) { return Duration(static_cast<int64_t>(s * 1e9)); }
  static Duration from_nanoseconds(int64_t n) { return Duration(n); }
  static Duration max() { return Duration(INT64_MAX); }
  template <class D> D to_chrono() const { return std::chrono::duration_cast<D>(std::chrono::nanoseconds(ri_value)); }
  operator builtin_interfaces::msg::Duration() const {
    builtin_interfaces::msg::Duration made;
    made.sec = static_cast<int32_t>(ri_value / 1000000000LL); made.nanosec = static_cast<uint32_t>(ri_value % 1000000000LL);
    return made;
  }
  Duration operator+(const Duration &o) const { return Duration(ri_value + o.ri_value); }
  Duration operator-(const Duration &o) const { return Duration(ri_value - o.ri_value); }
  Duration operator*(double s) const { return Duration(static_cast<int64_t>(static_cast<long double>(ri_value) * s)); }
  Duration &operator+=(const Duration &o) { ri_value += o.ri_value; return *this; }
  Duration &operator-=(const Duration &o) { ri_value -= o.ri_value; return *this; }
  bool operator==(const Duration &o) const { return ri_value == o.ri_value; }
  bool operator!=(const Duration &o) const { return ri_value != o.ri_value; }
  bool operator<(const Duration &o) const { return ri_value < o.ri_value; }
  bool operator>(const Duration &o) const { return ri_value > o.ri_value; }
  bool operator<=(const Duration &o) const { return ri_value <= o.ri_value; }
  bool operator>=(const Duration &o) const { return ri_value >= o.ri_value; }
};
struct Time {
  int64_t ri_value = 0;
  rcl_clock_type_t ri_clock = RCL_SYSTEM_TIME;
  Time(int32_t s, uint32_t n, rcl_clock_type_t c = RCL_SYSTEM_TIME) : ri_value(static_cast<int64_t>(s) * 1000000000LL + n), ri_clock(c) {
    if (s < 0) throw std::runtime_error("cannot store a negative time point in rclcpp::Time");
  }
  explicit Time(int64_t nanoseconds = 0, rcl_clock_type_t c = RCL_SYSTEM_TIME) : ri_value(nanoseconds), ri_clock(c) {}
  Time(const builtin_interfaces::msg::Time &m, rcl_clock_type_t c = RCL_ROS_TIME) : Time(m.sec, m.nanosec, c) {}
  Time(const Time &) = default;
  Time &operator=(const Time &) = default;
  Time &operator=(const builtin_interfaces::msg::Time &m) { *this = Time(m); return *this; }
  operator builtin_interfaces::msg::Time() const {
    builtin_interfaces::msg::Time made;
    made.sec = static_cast<int32_t>(ri_value / 1000000000LL); made.nanosec = static_cast<uint32_t>(ri_value % 1000000000LL);
    return made;
  }
  int64_t nanoseconds() const { return ri_value; }
  double seconds() const { return static_cast<double>(ri_value) / 1e9; }
  rcl_clock_type_t get_clock_type() const { return ri_clock; }
  static Time max(rcl_clock_type_t c = RCL_SYSTEM_TIME) { return Time(INT64_MAX, c); }
  void check(const Time &o) const { if (ri_clock != o.ri_clock) throw std::runtime_error("can't compare times with different time sources"); }
  Duration operator-(const Time &o) const {
    if (ri_clock != o.ri_clock) throw std::runtime_error("can't subtract times with different time sources [" + std::string("]"));
    return Duration(ri_value - o.ri_value);
  }
  Time operator-(const Duration &o) const { return Time(ri_value - o.ri_value, ri_clock); }
  Time operator+(const Duration &o) const { return Time(ri_value + o.ri_value, ri_clock); }
  Time &operator+=(const Duration &o) { ri_value += o.ri_value; return *this; }
  Time &operator-=(const Duration &o) { ri_value -= o.ri_value; return *this; }
  bool operator==(const Time &o) const { check(o); return ri_value == o.ri_value; }
  bool operator!=(const Time &o) const { return !(*this == o); }
  bool operator<(const Time &o) const { check(o); return ri_value < o.ri_value; }
  bool operator>(const Time &o) const { check(o); return ri_value > o.ri_value; }
  bool operator<=(const Time &o) const { check(o); return ri_value <= o.ri_value; }
  bool operator>=(const Time &o) const { check(o); return ri_value >= o.ri_value; }
};
inline Time operator+(const Duration &d, const Time &t) { return t + d; }
struct Clock {
  RCLCPP_SMART_PTR_DEFINITIONS(Clock)
  rcl_clock_type_t ri_type;
  explicit Clock(rcl_clock_type_t type = RCL_SYSTEM_TIME) : ri_type(type) {}
  Time now() const {
    int64_t value = ri::get_now();
    ri_assume(value >= 0 && value < 4000000000000000000LL);
    return Time(value, ri_type);
  }
  rcl_clock_type_t get_clock_type() const { return ri_type; }
  bool ros_time_is_active() { return ri_boolean("~sim_time") != 0; }
  template <class... A> bool sleep_until(A &&...) { return true; }
  template <class... A> bool sleep_for(A &&...) { return true; }
  bool started() { return true; }
  template <class... A> bool wait_until_started(A &&...) { return true; }
};

struct Logger {
  enum class Level { Unset = 0, Debug = 10, Info = 20, Warn = 30, Error = 40, Fatal = 50 };
  Logger get_child(const std::string &) const { return {}; }
  const char *get_name() const { return "node"; }
  void set_level(Level) {}
  Level get_effective_level() const { return Level::Info; }
};
inline Logger get_logger(const std::string &) { return {}; }
inline Logger get_node_logger(const void *) { return {}; }

enum class ReliabilityPolicy { BestEffort, Reliable, SystemDefault, BestAvailable, Unknown };
enum class DurabilityPolicy { Volatile, TransientLocal, SystemDefault, BestAvailable, Unknown };
enum class HistoryPolicy { KeepLast, KeepAll, SystemDefault, Unknown };
enum class LivelinessPolicy { Automatic, ManualByTopic, SystemDefault, BestAvailable, Unknown };
struct QoSInitialization { size_t depth = 10; static QoSInitialization from_rmw(const rmw_qos_profile_t &) { return {}; } };
struct KeepLast : QoSInitialization { explicit KeepLast(size_t d, bool = true) { depth = d; } };
struct KeepAll : QoSInitialization {};
struct QoS {
  size_t ri_depth = 10;
  QoS() = default;
  QoS(size_t depth) : ri_depth(depth) {}
  QoS(const QoSInitialization &from) : ri_depth(from.depth) {}
  QoS(const QoSInitialization &from, const rmw_qos_profile_t &) : ri_depth(from.depth) {}
  QoS &keep_last(size_t d) { ri_depth = d; return *this; }
  QoS &keep_all() { return *this; }
  QoS &reliable() { return *this; } QoS &best_effort() { return *this; } QoS &transient_local() { return *this; }
  QoS &durability_volatile() { return *this; } QoS &reliability_best_available() { return *this; }
  template <class... A> QoS &history(A...) { return *this; } template <class... A> QoS &reliability(A...) { return *this; }
  template <class... A> QoS &durability(A...) { return *this; } template <class... A> QoS &liveliness(A...) { return *this; }
  template <class... A> QoS &deadline(A &&...) { return *this; } template <class... A> QoS &lifespan(A &&...) { return *this; }
  template <class... A> QoS &liveliness_lease_duration(A &&...) { return *this; }
  QoS &avoid_ros_namespace_conventions(bool) { return *this; }
  size_t depth() const { return ri_depth; }
  rmw_qos_profile_t get_rmw_qos_profile() const { return {}; }
#ifdef RI_EXTRA_rclcpp_QoS
  RI_EXTRA_rclcpp_QoS
#endif
};
#define RI_QOS(name) struct name : QoS { explicit name(const QoSInitialization & = {}) : QoS(10) {} };
RI_QOS(SensorDataQoS) RI_QOS(SystemDefaultsQoS) RI_QOS(ServicesQoS) RI_QOS(ParametersQoS) RI_QOS(ParameterEventsQoS)
RI_QOS(ClockQoS) RI_QOS(RosoutQoS) RI_QOS(BestAvailableQoS)
#undef RI_QOS
enum class QosPolicyKind { Depth, Durability, History, Reliability, Invalid };
struct QosOverridingOptions { QosOverridingOptions(std::initializer_list<QosPolicyKind> = {}) {} static QosOverridingOptions with_default_policies() { return {}; } };
struct EventInfo { int total_count = 0, total_count_change = 0, current_count = 0, current_count_change = 0, alive_count = 0, not_alive_count = 0, last_policy_kind = 0, alive_count_change = 0, not_alive_count_change = 0; };
using QOSDeadlineRequestedInfo = EventInfo; using QOSDeadlineOfferedInfo = EventInfo; using QOSLivelinessChangedInfo = EventInfo;
using QOSLivelinessLostInfo = EventInfo; using QOSRequestedIncompatibleQoSInfo = EventInfo; using QOSOfferedIncompatibleQoSInfo = EventInfo;
using QOSMessageLostInfo = EventInfo; using MatchedInfo = EventInfo; using IncompatibleTypeInfo = EventInfo;
struct PublisherEventCallbacks { std::function<void(EventInfo &)> deadline_callback, liveliness_callback, incompatible_qos_callback, incompatible_type_callback, matched_callback; };
struct SubscriptionEventCallbacks { std::function<void(EventInfo &)> deadline_callback, liveliness_callback, incompatible_qos_callback, message_lost_callback, incompatible_type_callback, matched_callback; };

enum class CallbackGroupType { MutuallyExclusive, Reentrant };
struct CallbackGroup { RCLCPP_SMART_PTR_DEFINITIONS(CallbackGroup) CallbackGroupType ri_type = CallbackGroupType::MutuallyExclusive; };
namespace callback_group { using rclcpp::CallbackGroupType; using rclcpp::CallbackGroup; }
enum class IntraProcessSetting { Enable, Disable, NodeDefault };
struct ContentFilterOptions { std::string filter_expression; std::vector<std::string> expression_parameters; };
struct PublisherOptions {
  std::shared_ptr<void> allocator;
  PublisherEventCallbacks event_callbacks; bool use_default_callbacks = true; CallbackGroup::SharedPtr callback_group;
  QosOverridingOptions qos_overriding_options; IntraProcessSetting use_intra_process_comm = IntraProcessSetting::NodeDefault;
};
struct TopicStatisticsOptions { int state = 0; std::chrono::milliseconds publish_period{1}; std::string publish_topic; };
struct SubscriptionOptions {
  std::shared_ptr<void> allocator;
  SubscriptionEventCallbacks event_callbacks; bool use_default_callbacks = true, ignore_local_publications = false;
  CallbackGroup::SharedPtr callback_group; QosOverridingOptions qos_overriding_options; ContentFilterOptions content_filter_options;
  IntraProcessSetting use_intra_process_comm = IntraProcessSetting::NodeDefault; TopicStatisticsOptions topic_stats_options;
};
template <class A> using PublisherOptionsWithAllocator = PublisherOptions;
template <class A> using SubscriptionOptionsWithAllocator = SubscriptionOptions;
struct MessageInfo { MessageInfo() = default; MessageInfo(const ri::Info &) {} bool get_from_intra_process() const { return false; } ri::Anything get_rmw_message_info() const { return {}; } };
struct SerializedMessage : ri::Anything { using ri::Anything::Anything; };
template <class M> struct LoanedMessage {
  std::shared_ptr<M> ri_message = std::make_shared<M>();
  M &get() { return *ri_message; }
  bool is_valid() const { return true; }
};

struct PublisherBase : ri::Named {
  RCLCPP_SMART_PTR_DEFINITIONS(PublisherBase)
  std::string ri_topic;
  virtual ~PublisherBase() = default;
  const char *get_topic_name() const { return ri_topic.c_str(); }
  size_t get_subscription_count() const { return ask("subscribers"); }
  size_t get_intra_process_subscription_count() const { return ask("intra_subscribers"); }
  bool assert_liveliness() const { return true; }
  bool can_loan_messages() const { return false; }
  QoS get_actual_qos() const { return QoS(10); }
  template <class... A> bool wait_for_all_acked(A &&...) const { return true; }
  uint64_t ask(const char *what) const {
    ri_enter("~publisher"); ri_enter(ri_name); uint64_t value = ri_integer(what, 32, 0); ri_leave(); ri_leave();
    return value;
  }
};
template <class M, class A = void> struct Publisher : PublisherBase {
  RCLCPP_SMART_PTR_DEFINITIONS(Publisher<M, A>)
  using MessageUniquePtr = std::unique_ptr<M>;
  void publish(const M &message) { ri::publish("publish", ri_name, message); }
  void publish(std::unique_ptr<M> message) { ri::publish("publish", ri_name, *message); }
  void publish(LoanedMessage<M> &&message) { ri::publish("publish", ri_name, message.get()); }
  LoanedMessage<M> borrow_loaned_message() { return {}; }
  void on_activate() {} void on_deactivate() {} bool is_activated() const { return true; }
#ifdef RI_EXTRA_rclcpp_Publisher
  RI_EXTRA_rclcpp_Publisher
#endif
};
struct SubscriptionBase {
  RCLCPP_SMART_PTR_DEFINITIONS(SubscriptionBase)
  std::string ri_topic;
  virtual ~SubscriptionBase() = default;
  void ri_set_name(const char *) {}
  const char *get_topic_name() const { return ri_topic.c_str(); }
  size_t get_publisher_count() const { return ri_integer("~publishers", 32, 0); }
  QoS get_actual_qos() const { return QoS(10); }
  bool is_cft_enabled() const { return false; }
};
template <class M, class A = void> struct Subscription : SubscriptionBase {
  RCLCPP_SMART_PTR_DEFINITIONS(Subscription<M, A>)
#ifdef RI_EXTRA_rclcpp_Subscription
  RI_EXTRA_rclcpp_Subscription
#endif
};
using GenericSubscription = SubscriptionBase;
using GenericPublisher = PublisherBase;
struct ServiceBase { RCLCPP_SMART_PTR_DEFINITIONS(ServiceBase) virtual ~ServiceBase() = default; void ri_set_name(const char *) {} const char *get_service_name() { return ""; } };
template <class S> struct Service : ServiceBase {
  RCLCPP_SMART_PTR_DEFINITIONS(Service<S>)
  void send_response(rmw_request_id_t &, typename S::Response &response) { ri::publish("reply", "response", response); }
  template <class... A> void configure_introspection(A &&...) {}
};

enum class FutureReturnCode { SUCCESS, INTERRUPTED, TIMEOUT };
namespace executor { using rclcpp::FutureReturnCode; }
inline std::ostream &operator<<(std::ostream &out, const FutureReturnCode &) { return out; }
// What a service gives: any response. It comes at once, or never.
template <class T> struct RiFuture {
  T ri_value{}; int64_t request_id = 0; std::shared_ptr<T> ri_made;
  T get() const { return ri_value; }
  bool valid() const { return true; }
  void wait() const {}
  template <class D> std::future_status wait_for(const D &) const { return ri_boolean("~answered") ? std::future_status::ready : std::future_status::timeout; }
  template <class D> std::future_status wait_until(const D &d) const { return wait_for(d); }
  const RiFuture &share() const { return *this; }
  const RiFuture &future_() const { return *this; }
  struct Inner; const RiFuture *ri_self() const { return this; }
};
template <class T> struct RiFutureAndId : RiFuture<T> {
  RiFuture<T> future;
  RiFutureAndId() {}
  explicit RiFutureAndId(const RiFuture<T> &of) : RiFuture<T>(of), future(of) {}
  operator RiFuture<T>() const { return future; }
};
struct ClientBase : ri::Named {
  RCLCPP_SMART_PTR_DEFINITIONS(ClientBase)
  std::string ri_service;
  virtual ~ClientBase() = default;
  const char *get_service_name() const { return ri_service.c_str(); }
  bool service_is_ready() const { return ask("ready"); }
  template <class... D> bool wait_for_service(const D &...) { return ask("ready"); }
  bool ask(const char *what) const {
    ri_enter("~service"); ri_enter(ri_name); bool value = ri_boolean(what) != 0; ri_leave(); ri_leave();
    return value;
  }
};
template <class S> struct Client : ClientBase {
  RCLCPP_SMART_PTR_DEFINITIONS(Client<S>)
  using Request = typename S::Request; using Response = typename S::Response;
  using SharedRequest = std::shared_ptr<Request>; using SharedResponse = std::shared_ptr<Response>;
  using Future = RiFuture<SharedResponse>; using SharedFuture = RiFuture<SharedResponse>;
  using SharedFutureWithRequest = RiFuture<std::pair<SharedRequest, SharedResponse>>;
  using FutureAndRequestId = RiFutureAndId<SharedResponse>; using SharedFutureAndRequestId = FutureAndRequestId;
  using CallbackType = std::function<void(SharedFuture)>;
  FutureAndRequestId async_send_request(const SharedRequest &request) {
    ri::publish("service", ri_name, *request);
    SharedFuture made;
    ri_enter("~service"); ri_enter(ri_name); made.ri_value = ri::make_message<Response>("response"); ri_leave(); ri_leave();
    return FutureAndRequestId(made);
  }
  template <class F> FutureAndRequestId async_send_request(const SharedRequest &request, F &&callback, RI_HERE) {
    auto made = async_send_request(request);
    ri::give_plain("response", [callback]() mutable { (void)callback; }, ri_file, ri_line);
    return made;
  }
  template <class... A> void configure_introspection(A &&...) {}
  bool remove_pending_request(...) { return true; }
  size_t prune_pending_requests() { return 0; }
};
struct TimerBase {
  RCLCPP_SMART_PTR_DEFINITIONS(TimerBase)
  virtual ~TimerBase() = default;
  void ri_set_name(const char *) {}
  void cancel() { ri::effect("actuator", "timer"); }
  bool is_canceled() { return ri_boolean("~timer_canceled") != 0; }
  void reset() { ri::effect("actuator", "timer"); }
  bool is_ready() { return true; }
  bool is_steady() { return true; }
  void execute_callback() {}
  std::chrono::nanoseconds time_until_trigger() { return std::chrono::nanoseconds(0); }
};
template <class F = std::function<void()>> struct WallTimer : TimerBase { RCLCPP_SMART_PTR_DEFINITIONS(WallTimer<F>) };
template <class F = std::function<void()>> struct GenericTimer : TimerBase { RCLCPP_SMART_PTR_DEFINITIONS(GenericTimer<F>) };
using VoidCallbackType = std::function<void()>;

enum ParameterType { PARAMETER_NOT_SET, PARAMETER_BOOL, PARAMETER_INTEGER, PARAMETER_DOUBLE, PARAMETER_STRING, PARAMETER_BYTE_ARRAY, PARAMETER_BOOL_ARRAY, PARAMETER_INTEGER_ARRAY, PARAMETER_DOUBLE_ARRAY, PARAMETER_STRING_ARRAY };
inline std::string to_string(ParameterType) { return "type"; }
struct ParameterValue {
  ParameterType ri_type = PARAMETER_NOT_SET;
  bool ri_bool = false; int64_t ri_int = 0; double ri_double = 0; std::string ri_string;
  std::vector<uint8_t> ri_bytes; std::vector<bool> ri_bools; std::vector<int64_t> ri_ints; std::vector<double> ri_doubles; std::vector<std::string> ri_strings;
  ParameterValue() = default;
  template <class T, class = std::enable_if_t<std::is_arithmetic<T>::value || std::is_enum<T>::value>> explicit ParameterValue(T v) {
    if constexpr (std::is_same<T, bool>::value) { ri_type = PARAMETER_BOOL; ri_bool = v; }
    else if constexpr (std::is_floating_point<T>::value) { ri_type = PARAMETER_DOUBLE; ri_double = static_cast<double>(v); }
    else { ri_type = PARAMETER_INTEGER; ri_int = static_cast<int64_t>(v); }
  }
  explicit ParameterValue(const std::string &v) : ri_type(PARAMETER_STRING), ri_string(v) {}
  explicit ParameterValue(const char *v) : ri_type(PARAMETER_STRING), ri_string(v) {}
  explicit ParameterValue(const std::vector<uint8_t> &v) : ri_type(PARAMETER_BYTE_ARRAY), ri_bytes(v) {}
  explicit ParameterValue(const std::vector<bool> &v) : ri_type(PARAMETER_BOOL_ARRAY), ri_bools(v) {}
  explicit ParameterValue(const std::vector<int64_t> &v) : ri_type(PARAMETER_INTEGER_ARRAY), ri_ints(v) {}
  explicit ParameterValue(const std::vector<int> &v) : ri_type(PARAMETER_INTEGER_ARRAY), ri_ints(v.begin(), v.end()) {}
  explicit ParameterValue(const std::vector<double> &v) : ri_type(PARAMETER_DOUBLE_ARRAY), ri_doubles(v) {}
  explicit ParameterValue(const std::vector<float> &v) : ri_type(PARAMETER_DOUBLE_ARRAY), ri_doubles(v.begin(), v.end()) {}
  explicit ParameterValue(const std::vector<std::string> &v) : ri_type(PARAMETER_STRING_ARRAY), ri_strings(v) {}
  ParameterType get_type() const { return ri_type; }
  template <ParameterType T> auto get() const {
    if constexpr (T == PARAMETER_BOOL) return ri_bool;
    else if constexpr (T == PARAMETER_INTEGER) return ri_int;
    else if constexpr (T == PARAMETER_DOUBLE) return ri_double;
    else if constexpr (T == PARAMETER_BYTE_ARRAY) return ri_bytes;
    else if constexpr (T == PARAMETER_BOOL_ARRAY) return ri_bools;
    else if constexpr (T == PARAMETER_INTEGER_ARRAY) return ri_ints;
    else if constexpr (T == PARAMETER_DOUBLE_ARRAY) return ri_doubles;
    else if constexpr (T == PARAMETER_STRING_ARRAY) return ri_strings;
    else return ri_string;
  }
  template <class T> auto get() const {
    if constexpr (std::is_same<T, bool>::value) return ri_bool;
    else if constexpr (std::is_floating_point<T>::value) return ri_double;
    else if constexpr (std::is_integral<T>::value) return ri_int;
    else if constexpr (std::is_same<T, std::vector<uint8_t>>::value) return ri_bytes;
    else if constexpr (std::is_same<T, std::vector<bool>>::value) return ri_bools;
    else if constexpr (std::is_same<T, std::vector<int64_t>>::value || std::is_same<T, std::vector<int>>::value) return ri_ints;
    else if constexpr (std::is_same<T, std::vector<double>>::value || std::is_same<T, std::vector<float>>::value) return ri_doubles;
    else if constexpr (std::is_same<T, std::vector<std::string>>::value) return ri_strings;
    else return ri_string;
  }
};
struct Parameter {
  std::string ri_name; ParameterValue ri_value;
  Parameter() = default;
  explicit Parameter(const std::string &name) : ri_name(name) {}
  Parameter(const std::string &name, const ParameterValue &value) : ri_name(name), ri_value(value) {}
  template <class T, class = std::enable_if_t<!std::is_same<T, ParameterValue>::value>> Parameter(const std::string &name, const T &value) : ri_name(name), ri_value(value) {}
  ParameterType get_type() const { return ri_value.ri_type; }
  std::string get_type_name() const { return "type"; }
  const std::string &get_name() const { return ri_name; }
  const ParameterValue &get_parameter_value() const { return ri_value; }
  template <class T> auto get_value() const { return ri_value.get<T>(); }
  template <ParameterType T> auto get_value() const { return ri_value.get<T>(); }
  bool as_bool() const { return ri_value.ri_bool; }
  int64_t as_int() const { return ri_value.ri_int; }
  double as_double() const { return ri_value.ri_double; }
  const std::string &as_string() const { return ri_value.ri_string; }
  const std::vector<double> &as_double_array() const { return ri_value.ri_doubles; }
  const std::vector<int64_t> &as_integer_array() const { return ri_value.ri_ints; }
  const std::vector<bool> &as_bool_array() const { return ri_value.ri_bools; }
  const std::vector<std::string> &as_string_array() const { return ri_value.ri_strings; }
  const std::vector<uint8_t> &as_byte_array() const { return ri_value.ri_bytes; }
  std::string value_to_string() const { return ri_value.ri_string; }
};
struct RiKept { Parameter parameter; RiKept *next; };

// A parameter as it is set, else what the code says.
inline ParameterValue ri_find_value(const std::string &name, const ParameterValue &otherwise) {
  ParameterValue value = otherwise;
  if (value.ri_type == PARAMETER_BOOL) value.ri_bool = ri::get_parameter<bool>(name.c_str(), value.ri_bool);
  else if (value.ri_type == PARAMETER_INTEGER) value.ri_int = ri::get_parameter<int64_t>(name.c_str(), value.ri_int);
  else if (value.ri_type == PARAMETER_DOUBLE) value.ri_double = ri::get_parameter<double>(name.c_str(), value.ri_double);
  return value;
}
template <class T> ParameterValue ri_make_value(const T &value) {
  if constexpr (std::is_same<T, ParameterValue>::value) return value;
  else if constexpr (std::is_constructible<ParameterValue, const T &>::value) return ParameterValue(value);
  else return {};
}

struct Context { RCLCPP_SMART_PTR_DEFINITIONS(Context) bool is_valid() const { return true; } template <class... A> void init(A &&...) {} bool shutdown(const std::string &) { ri::effect("shutdown", "rclcpp"); return true; } };
namespace contexts { using DefaultContext = rclcpp::Context; inline Context::SharedPtr get_global_default_context() { static auto made = std::make_shared<Context>(); return made; } }
struct NodeOptions {
  std::vector<Parameter> ri_overrides; std::vector<std::string> ri_arguments;
  NodeOptions &use_intra_process_comms(bool) { return *this; } NodeOptions &allow_undeclared_parameters(bool) { return *this; }
  NodeOptions &automatically_declare_parameters_from_overrides(bool) { return *this; } NodeOptions &start_parameter_services(bool) { return *this; }
  NodeOptions &start_parameter_event_publisher(bool) { return *this; } NodeOptions &use_global_arguments(bool) { return *this; }
  NodeOptions &enable_rosout(bool) { return *this; } NodeOptions &enable_topic_statistics(bool) { return *this; }
  NodeOptions &enable_logger_service(bool) { return *this; } template <class... A> NodeOptions &clock_type(A...) { return *this; }
  NodeOptions &arguments(const std::vector<std::string> &v) { ri_arguments = v; return *this; }
  const std::vector<std::string> &arguments() const { return ri_arguments; }
  NodeOptions &parameter_overrides(const std::vector<Parameter> &v) { ri_overrides = v; return *this; }
  std::vector<Parameter> &parameter_overrides() { return ri_overrides; }
  const std::vector<Parameter> &parameter_overrides() const { return ri_overrides; }
  template <class T> NodeOptions &append_parameter_override(const std::string &n, const T &v) { ri_overrides.emplace_back(n, v); return *this; }
  bool use_intra_process_comms() const { return false; }
  NodeOptions &context(Context::SharedPtr) { return *this; } Context::SharedPtr context() const { return contexts::get_global_default_context(); }
#ifdef RI_EXTRA_rclcpp_NodeOptions
  RI_EXTRA_rclcpp_NodeOptions
#endif
};

template <class T> struct TypeOfCallback { using type = void; };

class Node;
namespace node_interfaces {
struct OnSetParametersCallbackHandle : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(OnSetParametersCallbackHandle) };
struct PostSetParametersCallbackHandle : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(PostSetParametersCallbackHandle) };
struct PreSetParametersCallbackHandle : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(PreSetParametersCallbackHandle) };
// The interfaces of a node are the node.
struct RiInterface {
  Node *ri_node = nullptr;
  Node &ri_get() const { if (!ri_node) ri_unknown("an interface of a node that is not known"); return *ri_node; }
};
#define RI_INTERFACE(Name, ...)                                                                             \
  struct Name : RiInterface, ri::Anything {                                                                 \
    RCLCPP_SMART_PTR_DEFINITIONS(Name)                                                                      \
    Name(Node *node = nullptr) { ri_node = node; }                                                          \
    __VA_ARGS__                                                                                             \
  };
RI_INTERFACE(NodeBaseInterface,
  const char *get_name() const; const char *get_namespace() const; const char *get_fully_qualified_name() const;
  Context::SharedPtr get_context() { return contexts::get_global_default_context(); }
  CallbackGroup::SharedPtr create_callback_group(CallbackGroupType type, bool = true) { auto made = std::make_shared<CallbackGroup>(); made->ri_type = type; return made; }
  CallbackGroup::SharedPtr get_default_callback_group() { return std::make_shared<CallbackGroup>(); }
  std::string resolve_topic_or_service_name(const std::string &, bool, bool = false) const { ri_unknown("how a name is resolved"); return {}; })
RI_INTERFACE(NodeTopicsInterface,
  std::string resolve_topic_name(const std::string &, bool = false) const { ri_unknown("how a name is resolved"); return {}; }
  NodeBaseInterface *get_node_base_interface() const { return new NodeBaseInterface(ri_node); })
RI_INTERFACE(NodeServicesInterface, std::string resolve_service_name(const std::string &, bool = false) const { ri_unknown("how a name is resolved"); return {}; })
RI_INTERFACE(NodeTimersInterface)
RI_INTERFACE(NodeLoggingInterface, Logger get_logger() const { return {}; } const char *get_logger_name() const { return "node"; })
RI_INTERFACE(NodeClockInterface, std::shared_ptr<Clock> get_clock(); std::shared_ptr<const Clock> get_clock() const;)
RI_INTERFACE(NodeGraphInterface,
  size_t count_publishers(const std::string &) const { return ri_integer("~publishers", 32, 0); }
  size_t count_subscribers(const std::string &) const { return ri_integer("~subscribers", 32, 0); })
RI_INTERFACE(NodeParametersInterface,
  const ParameterValue &declare_parameter(const std::string &, const ParameterValue &, const rcl_interfaces::msg::ParameterDescriptor & = {}, bool = false);
  bool has_parameter(const std::string &) const; Parameter get_parameter(const std::string &) const; bool get_parameter(const std::string &, Parameter &) const;
  std::vector<Parameter> get_parameters(const std::vector<std::string> &) const;
  std::vector<rcl_interfaces::msg::SetParametersResult> set_parameters(const std::vector<Parameter> &);
  rcl_interfaces::msg::SetParametersResult set_parameters_atomically(const std::vector<Parameter> &);
  template <class F> std::shared_ptr<OnSetParametersCallbackHandle> add_on_set_parameters_callback(F &&) { return std::make_shared<OnSetParametersCallbackHandle>(); }
  template <class F> std::shared_ptr<PostSetParametersCallbackHandle> add_post_set_parameters_callback(F &&) { return std::make_shared<PostSetParametersCallbackHandle>(); }
  template <class F> std::shared_ptr<PreSetParametersCallbackHandle> add_pre_set_parameters_callback(F &&) { return std::make_shared<PreSetParametersCallbackHandle>(); })
RI_INTERFACE(NodeWaitablesInterface) RI_INTERFACE(NodeTimeSourceInterface) RI_INTERFACE(NodeTypeDescriptionsInterface)
#undef RI_INTERFACE
}  // namespace node_interfaces
struct Event { RCLCPP_SMART_PTR_DEFINITIONS(Event) };

template <class Q, class R, class F> struct RiServiceHolder {
  F callback;
  static void run(void *self) {
    auto request = ri::make_message<Q>("request");
    auto response = std::make_shared<R>();
    F &call = static_cast<RiServiceHolder *>(self)->callback;
    ri::begin();
    if constexpr (std::is_invocable<F &, std::shared_ptr<Q>, std::shared_ptr<R>>::value) call(request, response);
    else if constexpr (std::is_invocable<F &, std::shared_ptr<rmw_request_id_t>, std::shared_ptr<Q>, std::shared_ptr<R>>::value)
      call(std::make_shared<rmw_request_id_t>(), request, response);
    else if constexpr (std::is_invocable<F &, std::shared_ptr<rmw_request_id_t>, std::shared_ptr<Q>>::value) {
      call(std::make_shared<rmw_request_id_t>(), request); return;
    }
    else { ri_unknown("a service callback in a form that is not modelled"); }
    ri::publish("reply", "response", *response);
  }
};

class Node : public std::enable_shared_from_this<Node> {
 public:
  RCLCPP_SMART_PTR_DEFINITIONS(Node)
  explicit Node(const std::string &name, const NodeOptions &options = {}) : ri_node_name(name), ri_options(options) {}
  Node(const std::string &name, const std::string &space, const NodeOptions &options = {}) : ri_node_name(name), ri_space(space), ri_options(options) {}
  virtual ~Node() = default;
  const char *get_name() const { return ri_node_name.c_str(); }
  const char *get_namespace() const { return ri_space.c_str(); }
  const char *get_fully_qualified_name() const { return ri_node_name.c_str(); }
  std::string get_effective_namespace() const { return ri_space; }
  std::string get_sub_namespace() const { return {}; }
  Node::SharedPtr create_sub_node(const std::string &) { return shared_from_this(); }
  Logger get_logger() const { return {}; }
  Clock::SharedPtr get_clock() { return ri_clock; }
  Clock::ConstSharedPtr get_clock() const { return ri_clock; }
  Time now() const { return ri_clock->now(); }
  const NodeOptions &get_node_options() const { return ri_options; }
  CallbackGroup::SharedPtr create_callback_group(CallbackGroupType type, bool = true) { auto made = std::make_shared<CallbackGroup>(); made->ri_type = type; return made; }

  template <class M, class... O> std::shared_ptr<Publisher<M>> create_publisher(const std::string &topic, const QoS &, O &&...) {
    auto made = std::make_shared<Publisher<M>>(); made->ri_topic = topic; made->ri_keep_name(topic); return made;
  }
  template <class M, class A, class P> std::shared_ptr<Publisher<M>> create_publisher(const std::string &topic, const QoS &qos) { return create_publisher<M>(topic, qos); }
  template <class M, class F> std::shared_ptr<Subscription<M>> create_subscription(const std::string &topic, const QoS &, F &&callback, RI_HERE) {
    return ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line);
  }
  template <class M, class F, class O, class = std::enable_if_t<!std::is_convertible<O, const char *>::value>>
  std::shared_ptr<Subscription<M>> create_subscription(const std::string &topic, const QoS &, F &&callback, O &&, RI_HERE) {
    return ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line);
  }
  template <class M, class F, class O, class P, class = std::enable_if_t<!std::is_convertible<P, const char *>::value>, class = std::enable_if_t<!std::is_convertible<O, const char *>::value>>
  std::shared_ptr<Subscription<M>> create_subscription(const std::string &topic, const QoS &, F &&callback, O &&, P &&, RI_HERE) {
    return ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line);
  }
  template <class M, class F> std::shared_ptr<Subscription<M>> ri_subscribe(const std::string &topic, F &&callback, const char *file, int line) {
    if constexpr (ri::is_message<M>::value) ri::give_callback<M>("subscriber", std::decay_t<F>(std::forward<F>(callback)), file, line);
    else ri::give_plain("subscriber", []() { ri_unknown("a subscription whose type is adapted"); }, file, line);
    auto made = std::make_shared<Subscription<M>>(); made->ri_topic = topic; return made;
  }
  template <class S, class F> std::shared_ptr<Service<S>> create_service(const std::string &, F &&callback, RI_HERE) {
    return ri_serve<S>(std::forward<F>(callback), ri_file, ri_line);
  }
  template <class S, class F> std::shared_ptr<Service<S>> create_service(const std::string &, F &&callback, const QoS &, CallbackGroup::SharedPtr = nullptr, RI_HERE) {
    return ri_serve<S>(std::forward<F>(callback), ri_file, ri_line);
  }
  template <class S, class F> std::shared_ptr<Service<S>> create_service(const std::string &, F &&callback, const rmw_qos_profile_t &, CallbackGroup::SharedPtr = nullptr, RI_HERE) {
    return ri_serve<S>(std::forward<F>(callback), ri_file, ri_line);
  }
  template <class S, class F> std::shared_ptr<Service<S>> ri_serve(F &&callback, const char *file, int line) {
    using Q = typename S::Request; using R = typename S::Response; using D = std::decay_t<F>;
    ri::give("service", file, line, &RiServiceHolder<Q, R, D>::run, new RiServiceHolder<Q, R, D>{D(std::forward<F>(callback))});
    return std::make_shared<Service<S>>();
  }
  template <class S, class... O> std::shared_ptr<Client<S>> create_client(const std::string &name, O &&...) {
    auto made = std::make_shared<Client<S>>(); made->ri_service = name; made->ri_keep_name(name); return made;
  }
  template <class D, class F> std::shared_ptr<WallTimer<>> create_wall_timer(const D &, F callback, RI_HERE) {
    ri_time(callback, ri_file, ri_line); return std::make_shared<WallTimer<>>();
  }
  template <class D, class F> std::shared_ptr<WallTimer<>> create_wall_timer(const D &, F callback, const CallbackGroup::SharedPtr &, bool = true, RI_HERE) {
    ri_time(callback, ri_file, ri_line); return std::make_shared<WallTimer<>>();
  }
  template <class D, class F> std::shared_ptr<GenericTimer<>> create_timer(const D &, F callback, RI_HERE) {
    ri_time(callback, ri_file, ri_line); return std::make_shared<GenericTimer<>>();
  }
  template <class D, class F> std::shared_ptr<GenericTimer<>> create_timer(const D &, F callback, const CallbackGroup::SharedPtr &, bool = true, RI_HERE) {
    ri_time(callback, ri_file, ri_line); return std::make_shared<GenericTimer<>>();
  }
  template <class F> void ri_time(F callback, const char *file, int line) {
    ri::give_plain("timer", [callback]() mutable {
      if constexpr (std::is_invocable<F &>::value) callback();
      else if constexpr (std::is_invocable<F &, TimerBase &>::value) { static TimerBase timer; callback(timer); }
      else ri_unknown("a timer's callback");
    }, file, line);
  }
  template <class... A> std::shared_ptr<PublisherBase> create_generic_publisher(const std::string &, A &&...) { return std::make_shared<PublisherBase>(); }
  template <class... A> std::shared_ptr<SubscriptionBase> create_generic_subscription(const std::string &, A &&...) { return std::make_shared<SubscriptionBase>(); }

  Parameter *ri_find(const std::string &name) const {
    for (RiKept *one = ri_parameters; one; one = one->next) if (one->parameter.ri_name == name) return &one->parameter;
    return nullptr;
  }
  const ParameterValue &ri_keep(const std::string &name, const ParameterValue &value) {
    ri_parameters = new RiKept{Parameter(name, value), ri_parameters}; return ri_parameters->parameter.ri_value;
  }
  template <class T, class... A> auto declare_parameter(const std::string &name, const T &otherwise, A &&...) {
    const ParameterValue &kept = ri_keep(name, ri_find_value(name, ri_make_value(otherwise)));
    if constexpr (std::is_same<T, ParameterValue>::value) return kept;
    else if constexpr (std::is_same<T, ParameterType>::value || std::is_same<T, rcl_interfaces::msg::ParameterDescriptor>::value) return kept;
    else if constexpr (std::is_pointer<std::decay_t<T>>::value) return kept.ri_string;
    else return static_cast<std::decay_t<T>>(ri_give<std::decay_t<T>>(kept));
  }
  template <class T> static T ri_give(const ParameterValue &value) {
    if constexpr (std::is_pointer<T>::value) return value.ri_string.c_str();
    else if constexpr (std::is_same<T, std::vector<int>>::value) return T(value.ri_ints.begin(), value.ri_ints.end());
    else if constexpr (std::is_same<T, std::vector<float>>::value) return T(value.ri_doubles.begin(), value.ri_doubles.end());
    else if constexpr (std::is_constructible<ParameterValue, const T &>::value) return static_cast<T>(value.get<T>());
    else { ri::unknown("a parameter"); return T(); }
  }
  template <class T> auto declare_parameter(const std::string &name) {
    ParameterValue value = ri_make_value(T());
    return ri_give<T>(ri_keep(name, ri_find_value(name, value)));
  }
  ParameterValue declare_parameter(const std::string &name) { return ri_keep(name, {}); }
  template <class T> void declare_parameters(const std::string &space, const std::map<std::string, T> &all) {
    for (auto &one : all) declare_parameter(space.empty() ? one.first : space + "." + one.first, one.second);
  }
  void undeclare_parameter(const std::string &) {}
  bool has_parameter(const std::string &name) const { return ri_find(name) != nullptr; }
  Parameter get_parameter(const std::string &name) const {
    Parameter *found = ri_find(name);
    if (!found) throw exceptions::ParameterNotDeclaredException(name);
    return *found;
  }
  bool get_parameter(const std::string &name, Parameter &out) const { Parameter *found = ri_find(name); if (found) out = *found; return found != nullptr; }
  template <class T> bool get_parameter(const std::string &name, T &out) const {
    Parameter *found = ri_find(name);
    if (found) out = ri_give<T>(found->ri_value);
    return found != nullptr;
  }
  template <class T> bool get_parameter_or(const std::string &name, T &out, const T &otherwise) const {
    Parameter *found = ri_find(name);
    out = found ? ri_give<T>(found->ri_value) : otherwise;
    return found != nullptr;
  }
  template <class T> T get_parameter_or(const std::string &name, const T &otherwise) const { T out; get_parameter_or(name, out, otherwise); return out; }
  std::vector<Parameter> get_parameters(const std::vector<std::string> &names) const { std::vector<Parameter> all; for (auto &name : names) all.push_back(get_parameter(name)); return all; }
  template <class T> bool get_parameters(const std::string &, std::map<std::string, T> &) const { ri::unknown("rclcpp::Node::get_parameters"); return false; }
  rcl_interfaces::msg::SetParametersResult set_parameter(const Parameter &parameter) {
    ri::effect("parameter", parameter.ri_name.c_str());
    if (Parameter *found = ri_find(parameter.ri_name)) *found = parameter;
    rcl_interfaces::msg::SetParametersResult made; made.successful = true; return made;
  }
  std::vector<rcl_interfaces::msg::SetParametersResult> set_parameters(const std::vector<Parameter> &all) {
    std::vector<rcl_interfaces::msg::SetParametersResult> made; for (auto &one : all) made.push_back(set_parameter(one)); return made;
  }
  rcl_interfaces::msg::SetParametersResult set_parameters_atomically(const std::vector<Parameter> &all) {
    for (auto &one : all) set_parameter(one);
    rcl_interfaces::msg::SetParametersResult made; made.successful = true; return made;
  }
  template <class F> std::shared_ptr<node_interfaces::OnSetParametersCallbackHandle> add_on_set_parameters_callback(F &&) { return std::make_shared<node_interfaces::OnSetParametersCallbackHandle>(); }
  template <class F> std::shared_ptr<node_interfaces::PostSetParametersCallbackHandle> add_post_set_parameters_callback(F &&) { return std::make_shared<node_interfaces::PostSetParametersCallbackHandle>(); }
  template <class F> std::shared_ptr<node_interfaces::PreSetParametersCallbackHandle> add_pre_set_parameters_callback(F &&) { return std::make_shared<node_interfaces::PreSetParametersCallbackHandle>(); }
  using OnSetParametersCallbackHandle = node_interfaces::OnSetParametersCallbackHandle;
  rcl_interfaces::msg::ParameterDescriptor describe_parameter(const std::string &) const { return {}; }

  size_t count_publishers(const std::string &) const { return ri_integer("~publishers", 32, 0); }
  size_t count_subscribers(const std::string &) const { return ri_integer("~subscribers", 32, 0); }
  std::vector<std::string> get_node_names() const { ri::unknown("rclcpp::Node::get_node_names"); return {}; }
  std::map<std::string, std::vector<std::string>> get_topic_names_and_types() const { ri::unknown("rclcpp::Node::get_topic_names_and_types"); return {}; }
  Event::SharedPtr get_graph_event() { return std::make_shared<Event>(); }
  template <class... A> void wait_for_graph_change(A &&...) {}
#define RI_GIVES(getter, Name) node_interfaces::Name::SharedPtr getter() { return std::make_shared<node_interfaces::Name>(this); }
  RI_GIVES(get_node_base_interface, NodeBaseInterface) RI_GIVES(get_node_topics_interface, NodeTopicsInterface) RI_GIVES(get_node_services_interface, NodeServicesInterface)
  RI_GIVES(get_node_timers_interface, NodeTimersInterface) RI_GIVES(get_node_logging_interface, NodeLoggingInterface) RI_GIVES(get_node_parameters_interface, NodeParametersInterface)
  RI_GIVES(get_node_clock_interface, NodeClockInterface) RI_GIVES(get_node_graph_interface, NodeGraphInterface) RI_GIVES(get_node_waitables_interface, NodeWaitablesInterface)
  RI_GIVES(get_node_time_source_interface, NodeTimeSourceInterface) RI_GIVES(get_node_type_descriptions_interface, NodeTypeDescriptionsInterface)
#undef RI_GIVES
  std::string ri_node_name, ri_space;
  NodeOptions ri_options;
  Clock::SharedPtr ri_clock = std::make_shared<Clock>(RCL_ROS_TIME);
  RiKept *ri_parameters = nullptr;
#ifdef RI_EXTRA_rclcpp_Node
  RI_EXTRA_rclcpp_Node
#endif
};

namespace node_interfaces {
inline const char *NodeBaseInterface::get_name() const { return ri_get().get_name(); }
inline const char *NodeBaseInterface::get_namespace() const { return ri_get().get_namespace(); }
inline const char *NodeBaseInterface::get_fully_qualified_name() const { return ri_get().get_fully_qualified_name(); }
inline std::shared_ptr<Clock> NodeClockInterface::get_clock() { return ri_get().get_clock(); }
inline std::shared_ptr<const Clock> NodeClockInterface::get_clock() const { return ri_get().get_clock(); }
inline const ParameterValue &NodeParametersInterface::declare_parameter(const std::string &name, const ParameterValue &otherwise, const rcl_interfaces::msg::ParameterDescriptor &, bool) { Node &node = ri_get(); return node.ri_keep(name, ri_find_value(name, otherwise)); }
inline bool NodeParametersInterface::has_parameter(const std::string &name) const { return ri_get().has_parameter(name); }
inline Parameter NodeParametersInterface::get_parameter(const std::string &name) const { return ri_get().get_parameter(name); }
inline bool NodeParametersInterface::get_parameter(const std::string &name, Parameter &out) const { return ri_get().get_parameter(name, out); }
inline std::vector<Parameter> NodeParametersInterface::get_parameters(const std::vector<std::string> &names) const { return ri_get().get_parameters(names); }
inline std::vector<rcl_interfaces::msg::SetParametersResult> NodeParametersInterface::set_parameters(const std::vector<Parameter> &all) { return ri_get().set_parameters(all); }
inline rcl_interfaces::msg::SetParametersResult NodeParametersInterface::set_parameters_atomically(const std::vector<Parameter> &all) { return ri_get().set_parameters_atomically(all); }
template <class T, class = void> struct ri_has_node : std::false_type {};
template <class T> struct ri_has_node<T, std::void_t<decltype(std::declval<T &>().ri_node)>> : std::true_type {};
template <class T, class = void> struct ri_gives_base : std::false_type {};
template <class T> struct ri_gives_base<T, std::void_t<decltype(std::declval<T &>().get_node_base_interface())>> : std::true_type {};
template <class T, class = void> struct ri_points : std::false_type {};
template <class T> struct ri_points<T, std::void_t<decltype(*std::declval<T &>())>> : std::true_type {};
// The node behind a node, one of its interfaces, or a pointer to either.
template <class N> Node *ri_find_node(N &&given) {
  using D = std::decay_t<N>;
  if constexpr (std::is_base_of<Node, D>::value) return const_cast<D *>(&given);
  else if constexpr (ri_has_node<D>::value) return given.ri_node;
  else if constexpr (ri_gives_base<D>::value) return ri_find_node(given.get_node_base_interface());
  else if constexpr (ri_points<D>::value) return ri_find_node(*given);
  else return nullptr;
}
template <class N> Node &ri_require_node(N &&given) {
  Node *node = ri_find_node(given);
  if (!node) ri_unknown("something that is made for a node that is not known");
  return *node;
}
// Several of them in one.
template <class... I> struct NodeInterfaces {
  RCLCPP_SMART_PTR_DEFINITIONS(NodeInterfaces<I...>)
  Node *ri_node = nullptr;
  NodeInterfaces() = default;
  template <class N, class... A> NodeInterfaces(N &&node, A &&...) : ri_node(ri_find_node(node)) {}
  template <class T> std::shared_ptr<T> get() const { return std::make_shared<T>(ri_node); }
#define RI_GIVES(getter, Name) Name::SharedPtr getter() const { return std::make_shared<Name>(ri_node); }
  RI_GIVES(get_node_base_interface, NodeBaseInterface) RI_GIVES(get_node_topics_interface, NodeTopicsInterface) RI_GIVES(get_node_services_interface, NodeServicesInterface)
  RI_GIVES(get_node_timers_interface, NodeTimersInterface) RI_GIVES(get_node_logging_interface, NodeLoggingInterface) RI_GIVES(get_node_parameters_interface, NodeParametersInterface)
  RI_GIVES(get_node_clock_interface, NodeClockInterface) RI_GIVES(get_node_graph_interface, NodeGraphInterface) RI_GIVES(get_node_waitables_interface, NodeWaitablesInterface)
#undef RI_GIVES
};
template <class T, class = void> struct ri_is_interface : std::false_type {};
template <class T> struct ri_is_interface<T, std::enable_if_t<ri::is_pointer_like<std::decay_t<T>>::value>> : std::is_base_of<RiInterface, typename std::decay_t<T>::element_type> {};
}  // namespace node_interfaces
template <class T> using RiIfInterface = std::enable_if_t<node_interfaces::ri_is_interface<T>::value>;
template <class T> using RiIfNone = std::enable_if_t<!std::is_convertible<T, const char *>::value>;

// What makes publishers and the like for a node, or for one of its interfaces. What the code names as the class of what
// is made is made.
template <class M, class P> using RiPublisher = std::conditional_t<std::is_void<P>::value, Publisher<M>, P>;
template <class P, class N> std::shared_ptr<P> ri_make_publisher(N &&node, const std::string &topic) {
  node_interfaces::ri_require_node(node);
  auto made = std::make_shared<P>(); made->ri_topic = topic; made->ri_keep_name(topic); return made;
}
template <class M, class A = void, class P = void, class N, class... O> std::shared_ptr<RiPublisher<M, P>> create_publisher(N &&node, const std::string &topic, const QoS &, O &&...) { return ri_make_publisher<RiPublisher<M, P>>(node, topic); }
template <class M, class A = void, class P = void, class N, class T, class... O, class = RiIfInterface<T>> std::shared_ptr<RiPublisher<M, P>> create_publisher(N &&, T &&topics, const std::string &topic, const QoS &, O &&...) { return ri_make_publisher<RiPublisher<M, P>>(topics, topic); }
template <class M, class F, class N> std::shared_ptr<Subscription<M>> create_subscription(N &&node, const std::string &topic, const QoS &, F &&callback, RI_HERE) { return node_interfaces::ri_require_node(node).template ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line); }
template <class M, class F, class N, class O, class = RiIfNone<O>> std::shared_ptr<Subscription<M>> create_subscription(N &&node, const std::string &topic, const QoS &, F &&callback, O &&, RI_HERE) { return node_interfaces::ri_require_node(node).template ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line); }
template <class M, class F, class N, class O, class P, class = RiIfNone<O>, class = RiIfNone<P>> std::shared_ptr<Subscription<M>> create_subscription(N &&node, const std::string &topic, const QoS &, F &&callback, O &&, P &&, RI_HERE) { return node_interfaces::ri_require_node(node).template ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line); }
template <class M, class F, class N, class T, class = RiIfInterface<T>> std::shared_ptr<Subscription<M>> create_subscription(N &&, T &&topics, const std::string &topic, const QoS &, F &&callback, RI_HERE) { return node_interfaces::ri_require_node(topics).template ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line); }
template <class M, class F, class N, class T, class O, class = RiIfInterface<T>, class = RiIfNone<O>> std::shared_ptr<Subscription<M>> create_subscription(N &&, T &&topics, const std::string &topic, const QoS &, F &&callback, O &&, RI_HERE) { return node_interfaces::ri_require_node(topics).template ri_subscribe<M>(topic, std::forward<F>(callback), ri_file, ri_line); }
template <class D, class F, class B, class T> std::shared_ptr<WallTimer<F>> create_wall_timer(const D &, F callback, const CallbackGroup::SharedPtr &, B &&node, T &&, bool = true, RI_HERE) { node_interfaces::ri_require_node(node).ri_time(callback, ri_file, ri_line); return std::make_shared<WallTimer<F>>(); }
template <class D, class F, class B, class T, class = std::enable_if_t<std::is_pointer<std::decay_t<B>>::value>> std::shared_ptr<GenericTimer<F>> create_timer(Clock::SharedPtr, const D &, F callback, const CallbackGroup::SharedPtr &, B &&node, T &&, bool = true, RI_HERE) { node_interfaces::ri_require_node(node).ri_time(callback, ri_file, ri_line); return std::make_shared<GenericTimer<F>>(); }
template <class N, class F> std::shared_ptr<GenericTimer<F>> create_timer(N &&node, Clock::SharedPtr, const Duration &, F callback, CallbackGroup::SharedPtr = nullptr, bool = true, RI_HERE) { node_interfaces::ri_require_node(node).ri_time(callback, ri_file, ri_line); return std::make_shared<GenericTimer<F>>(); }
template <class B, class T, class F, class = RiIfInterface<T>> std::shared_ptr<GenericTimer<F>> create_timer(B &&node, T &&, Clock::SharedPtr, const Duration &, F callback, CallbackGroup::SharedPtr = nullptr, bool = true, RI_HERE) { node_interfaces::ri_require_node(node).ri_time(callback, ri_file, ri_line); return std::make_shared<GenericTimer<F>>(); }
template <class S, class B, class V, class F, class Q> std::shared_ptr<Service<S>> create_service(B &&node, V &&, const std::string &, F &&callback, const Q &, CallbackGroup::SharedPtr = nullptr, RI_HERE) { return node_interfaces::ri_require_node(node).template ri_serve<S>(std::forward<F>(callback), ri_file, ri_line); }
template <class S, class B, class G, class V, class... O> std::shared_ptr<Client<S>> create_client(B &&node, G &&, V &&, const std::string &name, O &&...) { return node_interfaces::ri_require_node(node).template create_client<S>(name); }

struct InitOptions { bool shutdown_on_signal = true; };
enum class SignalHandlerOptions { All, SigInt, SigTerm, None };
template <class... A> void init(A &&...) {}
template <class... A> std::vector<std::string> init_and_remove_ros_arguments(A &&...) { return {"node"}; }
template <class... A> std::vector<std::string> remove_ros_arguments(A &&...) { return {"node"}; }
template <class... A> bool install_signal_handlers(A &&...) { return true; }
template <class... A> bool ok(A &&...) {
  static int rounds = 0;
  if (ri::phase && !ri::is_main) return ri_boolean("~ok") != 0;
  return ++rounds < 3;
}
template <class... A> bool shutdown(A &&...) { ri::effect("shutdown", "rclcpp"); return true; }
template <class F> void on_shutdown(F &&) {}
inline void ri_spin() { if (!ri::phase) ri::deliver_or_drop(); }
inline void ri_spin_some() { if (!ri::phase) ri::deliver(); }
template <class... A> void spin(A &&...) { ri_spin(); }
template <class... A> void spin_some(A &&...) { ri_spin_some(); }
template <class... A> void spin_all(A &&...) { ri_spin_some(); }
template <class N, class F, class... D> FutureReturnCode spin_until_future_complete(N &&, const F &, const D &...) { return ri_boolean("~answered") ? FutureReturnCode::SUCCESS : FutureReturnCode::TIMEOUT; }
template <class... D> bool sleep_for(const D &...) { return true; }
struct ExecutorOptions { Context::SharedPtr context; };
struct Executor {
  RCLCPP_SMART_PTR_DEFINITIONS(Executor)
  Executor(const ExecutorOptions & = {}) {}
  virtual ~Executor() = default;
  template <class... N> void add_node(N &&...) {} template <class... N> void remove_node(N &&...) {} template <class... N> void add_callback_group(N &&...) {}
  virtual void spin() { ri_spin(); }
  template <class... D> void spin_some(D &&...) { ri_spin_some(); } template <class... D> void spin_once(D &&...) { ri_spin_some(); } template <class... D> void spin_all(D &&...) { ri_spin_some(); }
  template <class... D> void spin_node_some(D &&...) { ri_spin_some(); } template <class... D> void spin_node_once(D &&...) { ri_spin_some(); }
  template <class F, class... D> FutureReturnCode spin_until_future_complete(const F &, const D &...) { return ri_boolean("~answered") ? FutureReturnCode::SUCCESS : FutureReturnCode::TIMEOUT; }
  void cancel() {} bool is_spinning() { return false; }
};
namespace executors {
struct SingleThreadedExecutor : Executor { using Executor::Executor; RCLCPP_SMART_PTR_DEFINITIONS(SingleThreadedExecutor) };
struct MultiThreadedExecutor : Executor { using Executor::Executor; RCLCPP_SMART_PTR_DEFINITIONS(MultiThreadedExecutor) MultiThreadedExecutor(const ExecutorOptions & = {}, size_t = 0, bool = false, std::chrono::nanoseconds = std::chrono::nanoseconds(0)) {} };
struct StaticSingleThreadedExecutor : Executor { using Executor::Executor; RCLCPP_SMART_PTR_DEFINITIONS(StaticSingleThreadedExecutor) };
template <class... A> FutureReturnCode spin_node_until_future_complete(A &&...) { return ri_boolean("~answered") ? FutureReturnCode::SUCCESS : FutureReturnCode::TIMEOUT; }
}  // namespace executors
namespace experimental { namespace executors { using EventsExecutor = rclcpp::executors::SingleThreadedExecutor; } }
struct RateBase { RCLCPP_SMART_PTR_DEFINITIONS(RateBase) virtual ~RateBase() = default; };
struct Rate : RateBase { RCLCPP_SMART_PTR_DEFINITIONS(Rate) template <class... A> explicit Rate(A &&...) {} bool sleep() { return true; } void reset() {} };
using WallRate = Rate;
template <class... A> using GenericRate = Rate;
template <class T> struct ri_adapted {};
template <class T, class M = void> struct TypeAdapter;
template <class T> struct AsyncParametersClientOf {};
struct SyncParametersClient : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(SyncParametersClient) };
struct AsyncParametersClient : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(AsyncParametersClient) };
struct ParameterEventHandler : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(ParameterEventHandler) };
struct ParameterCallbackHandle : ri::Anything { using ri::Anything::Anything; RCLCPP_SMART_PTR_DEFINITIONS(ParameterCallbackHandle) };
template <class M> struct Serialization : ri::Anything { using ri::Anything::Anything; };
}  // namespace rclcpp
namespace rmw { using ri_unused = int; }

#define RI_LOG(level, ...) do { ::ri::log_all(level, __VA_ARGS__); } while (0)
#define RI_LOG_STREAM(level, args) do { ::ri::log(level); ::ri::Stream() << args; } while (0)
#define RCLCPP_COMPONENTS_REGISTER_NODE(...)
#define CLASS_LOADER_REGISTER_CLASS(...)
#define PLUGINLIB_EXPORT_CLASS(...)
#define RCLCPP_DEBUG(logger, ...) do { (void)(logger); ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM(logger, args) do { (void)(logger); RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_ONCE(logger, ...) do { (void)(logger); ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_ONCE(logger, args) do { (void)(logger); RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_SKIPFIRST(logger, ...) do { (void)(logger); ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_SKIPFIRST(logger, args) do { (void)(logger); RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_EXPRESSION(logger, e, ...) do { (void)(logger); if (e) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_EXPRESSION(logger, e, args) do { (void)(logger); if (e) RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_FUNCTION(logger, f, ...) do { (void)(logger); if ((f)()) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_FUNCTION(logger, f, args) do { (void)(logger); if ((f)()) RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_DEBUG_SKIPFIRST_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCLCPP_DEBUG_STREAM_SKIPFIRST_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("debug", args); } while (0)
#define RCLCPP_INFO(logger, ...) do { (void)(logger); ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM(logger, args) do { (void)(logger); RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_ONCE(logger, ...) do { (void)(logger); ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_ONCE(logger, args) do { (void)(logger); RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_SKIPFIRST(logger, ...) do { (void)(logger); ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_SKIPFIRST(logger, args) do { (void)(logger); RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_EXPRESSION(logger, e, ...) do { (void)(logger); if (e) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_EXPRESSION(logger, e, args) do { (void)(logger); if (e) RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_FUNCTION(logger, f, ...) do { (void)(logger); if ((f)()) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_FUNCTION(logger, f, args) do { (void)(logger); if ((f)()) RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_INFO_SKIPFIRST_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCLCPP_INFO_STREAM_SKIPFIRST_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("info", args); } while (0)
#define RCLCPP_WARN(logger, ...) do { (void)(logger); ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM(logger, args) do { (void)(logger); RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_ONCE(logger, ...) do { (void)(logger); ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_ONCE(logger, args) do { (void)(logger); RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_SKIPFIRST(logger, ...) do { (void)(logger); ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_SKIPFIRST(logger, args) do { (void)(logger); RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_EXPRESSION(logger, e, ...) do { (void)(logger); if (e) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_EXPRESSION(logger, e, args) do { (void)(logger); if (e) RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_FUNCTION(logger, f, ...) do { (void)(logger); if ((f)()) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_FUNCTION(logger, f, args) do { (void)(logger); if ((f)()) RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_WARN_SKIPFIRST_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCLCPP_WARN_STREAM_SKIPFIRST_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("warn", args); } while (0)
#define RCLCPP_ERROR(logger, ...) do { (void)(logger); ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM(logger, args) do { (void)(logger); RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_ONCE(logger, ...) do { (void)(logger); ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_ONCE(logger, args) do { (void)(logger); RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_SKIPFIRST(logger, ...) do { (void)(logger); ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_SKIPFIRST(logger, args) do { (void)(logger); RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_EXPRESSION(logger, e, ...) do { (void)(logger); if (e) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_EXPRESSION(logger, e, args) do { (void)(logger); if (e) RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_FUNCTION(logger, f, ...) do { (void)(logger); if ((f)()) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_FUNCTION(logger, f, args) do { (void)(logger); if ((f)()) RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_ERROR_SKIPFIRST_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCLCPP_ERROR_STREAM_SKIPFIRST_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("error", args); } while (0)
#define RCLCPP_FATAL(logger, ...) do { (void)(logger); ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM(logger, args) do { (void)(logger); RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_ONCE(logger, ...) do { (void)(logger); ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_ONCE(logger, args) do { (void)(logger); RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_SKIPFIRST(logger, ...) do { (void)(logger); ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_SKIPFIRST(logger, args) do { (void)(logger); RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_EXPRESSION(logger, e, ...) do { (void)(logger); if (e) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_EXPRESSION(logger, e, args) do { (void)(logger); if (e) RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_FUNCTION(logger, f, ...) do { (void)(logger); if ((f)()) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_FUNCTION(logger, f, args) do { (void)(logger); if ((f)()) RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("fatal", args); } while (0)
#define RCLCPP_FATAL_SKIPFIRST_THROTTLE(logger, k, d, ...) do { (void)(logger); ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCLCPP_FATAL_STREAM_SKIPFIRST_THROTTLE(logger, k, d, args) do { (void)(logger); RI_LOG_STREAM("fatal", args); } while (0)
#define RCUTILS_LOG_DEBUG(...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_NAMED(n, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_ONCE(...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_ONCE_NAMED(n, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_EXPRESSION(e, ...) do { if (e) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_EXPRESSION_NAMED(e, n, ...) do { if (e) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_THROTTLE(t, d, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_THROTTLE_NAMED(t, d, n, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_DEBUG_SKIPFIRST_NAMED(n, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO(...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_NAMED(n, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_ONCE(...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_ONCE_NAMED(n, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_EXPRESSION(e, ...) do { if (e) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_EXPRESSION_NAMED(e, n, ...) do { if (e) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_THROTTLE(t, d, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_THROTTLE_NAMED(t, d, n, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_INFO_SKIPFIRST_NAMED(n, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN(...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_NAMED(n, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_ONCE(...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_ONCE_NAMED(n, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_EXPRESSION(e, ...) do { if (e) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_EXPRESSION_NAMED(e, n, ...) do { if (e) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_THROTTLE(t, d, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_THROTTLE_NAMED(t, d, n, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_WARN_SKIPFIRST_NAMED(n, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR(...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_NAMED(n, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_ONCE(...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_ONCE_NAMED(n, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_EXPRESSION(e, ...) do { if (e) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_EXPRESSION_NAMED(e, n, ...) do { if (e) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_THROTTLE(t, d, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_THROTTLE_NAMED(t, d, n, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_ERROR_SKIPFIRST_NAMED(n, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL(...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_NAMED(n, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_ONCE(...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_ONCE_NAMED(n, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_EXPRESSION(e, ...) do { if (e) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_EXPRESSION_NAMED(e, n, ...) do { if (e) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_THROTTLE(t, d, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_THROTTLE_NAMED(t, d, n, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define RCUTILS_LOG_FATAL_SKIPFIRST_NAMED(n, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
