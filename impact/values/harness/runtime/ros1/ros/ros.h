// roscpp without ROS: what is published, called and logged is told; callbacks are kept until the harness wants one.
#pragma once
#include <algorithm>
#include <iostream>
#include <thread>
#include <boost/bind.hpp>
#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <boost/thread.hpp>
#include <ros/ri_message.h>
#include "ri_core.hpp"

#define RI_HERE const char *ri_file = __builtin_FILE(), int ri_line = __builtin_LINE()

namespace XmlRpc {
struct XmlRpcException {
  std::string text; int code;
  XmlRpcException(const std::string &t, int c = -1) : text(t), code(c) {}
  const std::string &getMessage() const { return text; }
  int getCode() const { return code; }
};
struct XmlRpcValue : ri::Anything {
  using ri::Anything::Anything;
  enum Type { TypeInvalid, TypeBoolean, TypeInt, TypeDouble, TypeString, TypeDateTime, TypeBase64, TypeArray, TypeStruct };
  XmlRpcValue() { name = "XmlRpc::XmlRpcValue"; }
  Type getType() const { ri::unknown(name); return TypeInvalid; }
  int size() const { ri::unknown(name); return 0; }
  bool hasMember(const std::string &) const { ri::unknown(name); return false; }
  bool valid() const { ri::unknown(name); return false; }
  template <class K> XmlRpcValue &operator[](const K &) { ri::unknown(name); return *this; }
#ifdef RI_EXTRA_XmlRpc_XmlRpcValue
  RI_EXTRA_XmlRpc_XmlRpcValue
#endif
};
}  // namespace XmlRpc

namespace ros {
using VoidPtr = boost::shared_ptr<void>;
using VoidConstPtr = boost::shared_ptr<void const>;
using M_string = std::map<std::string, std::string>;
using V_string = std::vector<std::string>;
using VP_string = std::vector<std::pair<std::string, std::string>>;

struct Exception : std::runtime_error { using std::runtime_error::runtime_error; };
struct InvalidNodeNameException : Exception { using Exception::Exception; };
struct InvalidNameException : Exception { using Exception::Exception; };
struct ConflictingSubscriptionException : Exception { using Exception::Exception; };
struct InvalidParameterException : Exception { using Exception::Exception; };
struct serialization_error : Exception { using Exception::Exception; };

template <class M> using MessageEvent = ri::Event<std::remove_const_t<M>>;

struct TimerEvent {
  Time last_expected, last_real, current_expected, current_real, last_expired;
  struct Profile { WallDuration last_duration; } profile;
};
struct WallTimerEvent {
  WallTime last_expected, last_real, current_expected, current_real, last_expired;
  struct Profile { WallDuration last_duration; } profile;
};
using SteadyTimerEvent = WallTimerEvent;

struct SingleSubscriberPublisher {
  template <class M> void publish(const M &message) const { ri::publish("publish", "subscriber", message); }
  std::string getTopic() const { return {}; }
  std::string getSubscriberName() const { return {}; }
};
using SubscriberStatusCallback = boost::function<void(const SingleSubscriberPublisher &)>;

struct Publisher : ri::Named {
  std::string ri_topic;
  template <class M> void publish(const M &message) const {
    if constexpr (ri::is_pointer_like<M>::value) ri::publish("publish", ri_name, *message);
    else ri::publish("publish", ri_name, message);
  }
  uint32_t getNumSubscribers() const { return static_cast<uint32_t>(ask("subscribers")); }
  std::string getTopic() const { return ri_topic; }
  bool isLatched() const { return false; }
  void shutdown() {}
  explicit operator bool() const { return true; }
  operator void *() const { return const_cast<Publisher *>(this); }
  bool operator==(const Publisher &other) const { return this == &other; }
  uint64_t ask(const char *what) const {
    ri_enter("~publisher"); ri_enter(ri_name); uint64_t value = ri_integer(what, 32, 0); ri_leave(); ri_leave();
    return value;
  }
#ifdef RI_EXTRA_ros_Publisher
  RI_EXTRA_ros_Publisher
#endif
};
struct Subscriber {
  std::string ri_topic;
  void ri_set_name(const char *) {}
  std::string getTopic() const { return ri_topic; }
  uint32_t getNumPublishers() const { return static_cast<uint32_t>(ri_integer("~publishers", 32, 0)); }
  void shutdown() {}
  explicit operator bool() const { return true; }
};
struct ServiceServer {
  void ri_set_name(const char *) {}
  void shutdown() {}
  std::string getService() const { return {}; }
  explicit operator bool() const { return true; }
};
struct ServiceClient : ri::Named {
  std::string ri_service;
  template <class S> bool call(S &service) { return call(service.request, service.response); }
  template <class Q, class R> bool call(Q &request, R &response) {
    ri::publish("service", ri_name, request);
    ri_enter("~service"); ri_enter(ri_name);
    bool found = ri_boolean("ok") != 0;
    if (found) ri::fill(response, "response");
    ri_leave(); ri_leave();
    return found;
  }
  bool exists() { return ask("exists"); }
  bool waitForExistence(Duration = Duration(-1)) { return ask("exists"); }
  bool isValid() const { return true; }
  bool isPersistent() const { return false; }
  std::string getService() const { return ri_service; }
  void shutdown() {}
  explicit operator bool() const { return true; }
  bool ask(const char *what) {
    ri_enter("~service"); ri_enter(ri_name); bool value = ri_boolean(what) != 0; ri_leave(); ri_leave();
    return value;
  }
};
template <class D> struct TimerOf {
  void ri_set_name(const char *) {}
  void start() { ri::effect("actuator", "timer"); }
  void stop() { ri::effect("actuator", "timer"); }
  bool hasPending() { return ri_boolean("~pending") != 0; }
  void setPeriod(const D &, bool = true) { ri::effect("actuator", "timer"); }
  bool hasStarted() const { return true; }
  bool isValid() { return true; }
  explicit operator bool() const { return true; }
};
using Timer = TimerOf<Duration>;
using WallTimer = TimerOf<WallDuration>;
using SteadyTimer = TimerOf<WallDuration>;

struct TransportHints {
  TransportHints &tcp() { return *this; }
  TransportHints &udp() { return *this; }
  TransportHints &reliable() { return *this; }
  TransportHints &unreliable() { return *this; }
  TransportHints &tcpNoDelay(bool = true) { return *this; }
  TransportHints &maxDatagramSize(int) { return *this; }
};
struct CallbackInterface { virtual ~CallbackInterface() = default; };
struct CallbackQueueInterface { virtual ~CallbackQueueInterface() = default; };
struct CallbackQueue : CallbackQueueInterface {
  explicit CallbackQueue(bool = true) {}
  void callAvailable() { ri::deliver(); }
  template <class D> void callAvailable(const D &) { ri::deliver(); }
  template <class... D> void callOne(const D &...) { ri::deliver(); }
  void clear() {} void enable() {} void disable() {}
  bool isEmpty() { return true; } bool empty() { return true; } bool isEnabled() { return true; }
};
inline CallbackQueue *getGlobalCallbackQueue() { static CallbackQueue *queue = new CallbackQueue(); return queue; }

template <class P> struct TypeOfParameter {
  using Plain = std::remove_cv_t<std::remove_reference_t<P>>;
  template <class T> static T find(const T *);
  template <class T> static T find(const boost::shared_ptr<T> *);
  template <class T> static T find(const ri::Event<T> *);
  using type = std::remove_const_t<decltype(find(static_cast<const Plain *>(nullptr)))>;
};

template <class Event, class F> void give_timer(F callback, const char *file, int line) {
  ri::give_plain("timer", [callback]() mutable {
    if constexpr (std::is_invocable<F &, const Event &>::value) callback(Event());
    else if constexpr (std::is_invocable<F &>::value) callback();
    else ri_unknown("a timer's callback");
  }, file, line);
}

template <class Q, class R, class F> struct ServiceHolder {
  F callback;
  static void run(void *self) {
    Q request; R response;
    ri::fill(request, "request");
    ri::begin();
    bool done = static_cast<ServiceHolder *>(self)->callback(request, response);
    if (done) ri::publish("reply", "response", response);
  }
};
template <class Q, class R, class F> void give_service(F callback, const char *file, int line) {
  ri::give("service", file, line, &ServiceHolder<Q, R, F>::run, new ServiceHolder<Q, R, F>{std::move(callback)});
}

struct AdvertiseOptions { std::string topic; template <class M> static AdvertiseOptions create(...) { return {}; } CallbackQueueInterface *callback_queue = nullptr; bool latch = false; };
struct SubscribeOptions {
  std::string topic; CallbackQueueInterface *callback_queue = nullptr; TransportHints transport_hints;
  bool allow_concurrent_callbacks = false; VoidConstPtr tracked_object;
  template <class M, class F> static SubscribeOptions create(
      const std::string &topic, uint32_t, const F &callback, const VoidConstPtr & = {}, CallbackQueueInterface *queue = nullptr, RI_HERE) {
    ri::give_callback<M>("subscriber", callback, ri_file, ri_line);
    SubscribeOptions made; made.topic = topic; made.callback_queue = queue; return made;
  }
  template <class M, class F> void init(const std::string &name, uint32_t, const F &callback, RI_HERE) {
    topic = name; ri::give_callback<M>("subscriber", callback, ri_file, ri_line);
  }
};
struct TimerOptions {}; struct AdvertiseServiceOptions {};

struct NodeHandle {
  std::string ri_space;
  explicit NodeHandle(const std::string &space = "", const M_string & = {}) : ri_space(space) {}
  NodeHandle(const NodeHandle &) = default;
  NodeHandle(const NodeHandle &, const std::string &space) : ri_space(space) {}
  NodeHandle(const NodeHandle &, const std::string &space, const M_string &) : ri_space(space) {}
  NodeHandle &operator=(const NodeHandle &) = default;
  void ri_set_name(const char *) {}
  const std::string &getNamespace() const { return ri_space; }
  const std::string &getUnresolvedNamespace() const { return ri_space; }
  std::string resolveName(const std::string &name, bool = true) const { return name; }
  bool ok() const { return true; }
  void shutdown() {}
  void setCallbackQueue(CallbackQueueInterface *) {}
  CallbackQueueInterface *getCallbackQueue() const { return getGlobalCallbackQueue(); }

  template <class M> Publisher advertise(const std::string &topic, uint32_t, bool = false) {
    Publisher made; made.ri_topic = topic; made.ri_keep_name(topic); return made;
  }
  template <class M, class... A> Publisher advertise(const std::string &topic, uint32_t, const SubscriberStatusCallback &, A &&...) {
    return advertise<M>(topic, 1u);
  }
  Publisher advertise(AdvertiseOptions &options) { Publisher made; made.ri_keep_name(options.topic); return made; }

  Subscriber ri_made(const std::string &topic) { Subscriber made; made.ri_topic = topic; return made; }
  template <class P, class T, class U>
  Subscriber subscribe(const std::string &topic, uint32_t, void (T::*method)(P), U *object, const TransportHints & = {}, RI_HERE) {
    T *self = object;
    ri::give_callback<typename TypeOfParameter<P>::type>("subscriber", [method, self](P p) { (self->*method)(std::forward<P>(p)); }, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class P, class T, class U>
  Subscriber subscribe(const std::string &topic, uint32_t, void (T::*method)(P) const, U *object, const TransportHints & = {}, RI_HERE) {
    const T *self = object;
    ri::give_callback<typename TypeOfParameter<P>::type>("subscriber", [method, self](P p) { (self->*method)(std::forward<P>(p)); }, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class P, class T, class U>
  Subscriber subscribe(const std::string &topic, uint32_t, void (T::*method)(P), const boost::shared_ptr<U> &object, const TransportHints & = {}, RI_HERE) {
    boost::shared_ptr<U> self = object;
    ri::give_callback<typename TypeOfParameter<P>::type>("subscriber", [method, self](P p) { ((*self).*method)(std::forward<P>(p)); }, ri_file, ri_line);
    return ri_made(topic);
  }
  // With the message's type written out: subscribe<M>(topic, 1, &T::method, this).
  template <class M, class T, class U>
  Subscriber subscribe(const std::string &topic, uint32_t, void (T::*method)(const boost::shared_ptr<M const> &), U *object, const TransportHints & = {}, RI_HERE) {
    T *self = object;
    ri::give_callback<M>("subscriber", [method, self](const boost::shared_ptr<M const> &p) { (self->*method)(p); }, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class M, class T, class U, class = std::enable_if_t<ri::is_message<M>::value>>
  Subscriber subscribe(const std::string &topic, uint32_t, void (T::*method)(const M &), U *object, const TransportHints & = {}, RI_HERE) {
    T *self = object;
    ri::give_callback<M>("subscriber", [method, self](const M &p) { (self->*method)(p); }, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class M, class = std::enable_if_t<ri::is_message<M>::value>>
  Subscriber subscribe(const std::string &topic, uint32_t, void (*callback)(const boost::shared_ptr<M const> &), const TransportHints & = {}, RI_HERE) {
    ri::give_callback<M>("subscriber", callback, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class P>
  Subscriber subscribe(const std::string &topic, uint32_t, void (*callback)(P), const TransportHints & = {}, RI_HERE) {
    ri::give_callback<typename TypeOfParameter<P>::type>("subscriber", callback, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class M, class F, class = std::enable_if_t<ri::is_message<std::remove_const_t<M>>::value && !std::is_function<std::remove_pointer_t<F>>::value>>
  Subscriber subscribe(const std::string &topic, uint32_t, const F &callback, const VoidConstPtr & = {}, const TransportHints & = {}, RI_HERE) {
    ri::give_callback<std::remove_const_t<M>>("subscriber", callback, ri_file, ri_line);
    return ri_made(topic);
  }
  template <class P, class = std::enable_if_t<!ri::is_message<P>::value>>
  Subscriber subscribe(const std::string &topic, uint32_t, const boost::function<void(P)> &callback, const VoidConstPtr & = {}, const TransportHints & = {}, RI_HERE) {
    ri::give_callback<typename TypeOfParameter<P>::type>("subscriber", callback, ri_file, ri_line);
    return ri_made(topic);
  }
  Subscriber subscribe(SubscribeOptions &options) { return ri_made(options.topic); }

  template <class T, class U, class Q, class R>
  ServiceServer advertiseService(const std::string &, bool (T::*method)(Q &, R &), U *object, RI_HERE) {
    T *self = object;
    give_service<Q, R>([method, self](Q &q, R &r) { return (self->*method)(q, r); }, ri_file, ri_line);
    return {};
  }
  template <class T, class U, class Q, class R>
  ServiceServer advertiseService(const std::string &, bool (T::*method)(Q &, R &), const boost::shared_ptr<U> &object, RI_HERE) {
    boost::shared_ptr<U> self = object;
    give_service<Q, R>([method, self](Q &q, R &r) { return ((*self).*method)(q, r); }, ri_file, ri_line);
    return {};
  }
  template <class Q, class R> ServiceServer advertiseService(const std::string &, bool (*callback)(Q &, R &), RI_HERE) {
    give_service<Q, R>(callback, ri_file, ri_line);
    return {};
  }
  template <class Q, class R>
  ServiceServer advertiseService(const std::string &, const boost::function<bool(Q &, R &)> &callback, const VoidConstPtr & = {}, RI_HERE) {
    give_service<Q, R>(callback, ri_file, ri_line);
    return {};
  }
  template <class Q, class R, class F, class = std::enable_if_t<ri::is_message<Q>::value>>
  ServiceServer advertiseService(const std::string &, F callback, RI_HERE) {
    give_service<Q, R>(callback, ri_file, ri_line);
    return {};
  }
  template <class S> ServiceClient serviceClient(const std::string &name, bool = false, const M_string & = {}) {
    ServiceClient made; made.ri_service = name; made.ri_keep_name(name); return made;
  }
  template <class Q, class R> ServiceClient serviceClient(const std::string &name, bool = false, const M_string & = {}) {
    ServiceClient made; made.ri_service = name; made.ri_keep_name(name); return made;
  }
  template <class Event, class T, class E, class U> void ri_timer(void (T::*method)(E), U *object, const char *file, int line) {
    T *self = object;
    give_timer<Event>([method, self](const Event &e) { (self->*method)(e); }, file, line);
  }
#define RI_TIMER(name, Kind, Span, Event)                                                                     \
  template <class T, class E, class U> Kind name(const Span &, void (T::*method)(E), U *object, bool = false, bool = true, RI_HERE) { \
    ri_timer<Event>(method, object, ri_file, ri_line); return {};                                             \
  }                                                                                                           \
  template <class T, class E, class U> Kind name(const Span &, void (T::*method)(E) const, U *object, bool = false, bool = true, RI_HERE) { \
    const T *self = object;                                                                                   \
    give_timer<Event>([method, self](const Event &e) { (self->*method)(e); }, ri_file, ri_line); return {};   \
  }                                                                                                           \
  template <class F, class = std::enable_if_t<!std::is_member_pointer<F>::value>>                             \
  Kind name(const Span &, const F &callback, bool = false, bool = true, RI_HERE) {                            \
    give_timer<Event>(callback, ri_file, ri_line); return {};                                                 \
  }
  RI_TIMER(createTimer, Timer, Duration, TimerEvent)
  RI_TIMER(createWallTimer, WallTimer, WallDuration, WallTimerEvent)
  RI_TIMER(createSteadyTimer, SteadyTimer, WallDuration, SteadyTimerEvent)
#undef RI_TIMER
  template <class T, class E, class U> Timer createTimer(const Rate &, void (T::*method)(E), U *object, bool = false, bool = true, RI_HERE) {
    ri_timer<TimerEvent>(method, object, ri_file, ri_line); return {};
  }

  template <class T> bool getParam(const std::string &name, T &value) const { return ri::find_parameter(name.c_str(), value); }
  template <class T> bool getParamCached(const std::string &name, T &value) const { return getParam(name, value); }
  template <class T> void setParam(const std::string &name, const T &) const { ri::effect("parameter", name.c_str()); }
  bool hasParam(const std::string &name) const { return ri::is_parameter_set(name.c_str()); }
  bool deleteParam(const std::string &name) const { ri::effect("parameter", name.c_str()); return true; }
  bool searchParam(const std::string &name, std::string &out) const { out = name; return ri::is_parameter_set(name.c_str()); }
  bool getParamNames(std::vector<std::string> &) const { ri::unknown("ros::NodeHandle::getParamNames"); return false; }
  template <class T> bool param(const std::string &name, T &value, const T &otherwise) const {
    value = ri::get_parameter<T>(name.c_str(), otherwise);
    return ri::is_parameter_set(name.c_str());
  }
  template <class T, class D, class = std::enable_if_t<!std::is_same<T, D>::value>>
  bool param(const std::string &name, T &value, const D &otherwise) const { return param<T>(name, value, static_cast<T>(otherwise)); }
  template <class T> T param(const std::string &name, const T &otherwise) const { return ri::get_parameter<T>(name.c_str(), otherwise); }
  std::string param(const std::string &, const char *otherwise) const { return otherwise; }
#ifdef RI_EXTRA_ros_NodeHandle
  RI_EXTRA_ros_NodeHandle
#endif
};

namespace init_options { enum InitOption { NoSigintHandler = 1, AnonymousName = 2, NoRosout = 4 }; }
using InitOption = init_options::InitOption;
template <class... A> void init(A &&...) {}
inline void removeROSArgs(int argc, const char *const argv[], V_string &out) { for (int i = 0; i < argc; ++i) out.push_back(argv[i]); }
inline bool isInitialized() { return true; }
inline bool isStarted() { return true; }
inline bool isShuttingDown() { return false; }
inline bool ok() {
  static int rounds = 0;
  if (ri::phase && !ri::is_main) return ri_boolean("~ok") != 0;
  return ++rounds < 3;
}
inline void start() {}
inline void shutdown() { ri::effect("shutdown", "ros"); }
inline void requestShutdown() { ri::effect("shutdown", "ros"); }
inline void spinOnce() { if (!ri::phase) ri::deliver(); }
inline void spin() { if (!ri::phase) ri::deliver_or_drop(); }
template <class S> void spin(S &) { spin(); }
inline void waitForShutdown() { spin(); }
struct Spinner { virtual ~Spinner() = default; virtual void spin(CallbackQueue * = nullptr) { ros::spin(); } };
struct SingleThreadedSpinner : Spinner {};
struct MultiThreadedSpinner : Spinner { explicit MultiThreadedSpinner(uint32_t = 0) {} };
struct AsyncSpinner {
  explicit AsyncSpinner(uint32_t, CallbackQueue * = nullptr) {}
  void start() {} void stop() {} bool canStart() { return true; }
};
namespace this_node {
inline const std::string &getName() { static std::string name = "/node"; return name; }
inline const std::string &getNamespace() { static std::string name = "/"; return name; }
}  // namespace this_node
namespace names {
inline std::string resolve(const std::string &name, bool = true) { return name; }
inline std::string append(const std::string &a, const std::string &b) { return a + "/" + b; }
inline std::string remap(const std::string &name) { return name; }
inline std::string clean(const std::string &name) { return name; }
inline bool validate(const std::string &, std::string &) { return true; }
}  // namespace names
namespace param {
template <class T> bool get(const std::string &name, T &value) { return ri::find_parameter(name.c_str(), value); }
template <class T> bool getCached(const std::string &name, T &value) { return get(name, value); }
template <class T> void set(const std::string &name, const T &) { ri::effect("parameter", name.c_str()); }
inline bool has(const std::string &name) { return ri::is_parameter_set(name.c_str()); }
inline bool del(const std::string &name) { ri::effect("parameter", name.c_str()); return true; }
template <class T, class D> bool param(const std::string &name, T &value, const D &otherwise) {
  value = ri::get_parameter<T>(name.c_str(), static_cast<T>(otherwise)); return has(name);
}
template <class T> T param(const std::string &name, const T &otherwise) { return ri::get_parameter<T>(name.c_str(), otherwise); }
}  // namespace param
namespace topic {
template <class M, class... A> boost::shared_ptr<M const> waitForMessage(const std::string &, A &&...) {
  ri_enter("~waited"); bool came = ri_boolean("came") != 0;
  boost::shared_ptr<M const> made;
  if (came) made = ri::make_message<M>("message");
  ri_leave();
  return made;
}
}  // namespace topic
namespace service {
inline bool waitForService(const std::string &, Duration = Duration(-1)) { return ri_boolean("~service_found") != 0; }
inline bool waitForService(const std::string &, int32_t) { return ri_boolean("~service_found") != 0; }
inline bool exists(const std::string &, bool) { return ri_boolean("~service_found") != 0; }
template <class S> bool call(const std::string &name, S &service) {
  ServiceClient client; client.ri_keep_name(name); return client.call(service);
}
template <class Q, class R> bool call(const std::string &name, Q &request, R &response) {
  ServiceClient client; client.ri_keep_name(name); return client.call(request, response);
}
}  // namespace service
namespace master {
inline bool check() { return true; }
inline const std::string &getHost() { static std::string name; return name; }
struct TopicInfo { std::string name, datatype; };
using V_TopicInfo = std::vector<TopicInfo>;
inline bool getTopics(V_TopicInfo &) { ri::unknown("ros::master::getTopics"); return false; }
}  // namespace master
namespace console {
namespace levels { enum Level { Debug, Info, Warn, Error, Fatal, Count }; }
using Level = levels::Level;
inline bool set_logger_level(const std::string &, Level) { return true; }
inline void notifyLoggerLevelsChanged() {}
}  // namespace console
namespace message_traits {
template <class M> struct HasHeader : std::false_type {};
template <class M> const char *datatype() { return ""; }
}  // namespace message_traits
}  // namespace ros

#define ROSCONSOLE_DEFAULT_NAME "ros"
#define ROSCONSOLE_SEVERITY_DEBUG 0
#define ROS_ASSERT(condition) assert(condition)
#define ROS_ASSERT_MSG(condition, ...) assert(condition)
#define ROS_ASSERT_CMD(condition, command) assert(condition)
#define ROS_ISSUE_BREAK() abort()
#define ROS_BREAK() abort()
#define ROS_DEPRECATED
#define ROS_FORCE_INLINE inline
#define RI_LOG(level, ...) do { ::ri::log_all(level, __VA_ARGS__); } while (0)
#define RI_LOG_STREAM(level, args) do { ::ri::log(level); ::ri::Stream() << args; } while (0)
#define ROS_LOG(level, name, ...) RI_LOG("log", __VA_ARGS__)
#define ROS_LOG_STREAM(level, name, args) RI_LOG_STREAM("log", args)
#define ROS_DEBUG(...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM(args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_NAMED(n, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_NAMED(n, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_COND(c, ...) do { if (c) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define ROS_DEBUG_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("debug", args); } while (0)
#define ROS_DEBUG_COND_NAMED(c, n, ...) do { if (c) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define ROS_DEBUG_STREAM_COND_NAMED(c, n, args) do { if (c) RI_LOG_STREAM("debug", args); } while (0)
#define ROS_DEBUG_ONCE(...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_ONCE(args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_ONCE_NAMED(n, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_ONCE_NAMED(n, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_THROTTLE(p, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_THROTTLE(p, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_THROTTLE_NAMED(p, n, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_DELAYED_THROTTLE(p, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_DELAYED_THROTTLE(p, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_DELAYED_THROTTLE_NAMED(p, n, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_DELAYED_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_FILTER(f, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_FILTER(f, args) RI_LOG_STREAM("debug", args)
#define ROS_DEBUG_FILTER_NAMED(f, n, ...) RI_LOG("debug", __VA_ARGS__)
#define ROS_DEBUG_STREAM_FILTER_NAMED(f, n, args) RI_LOG_STREAM("debug", args)
#define ROS_INFO(...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM(args) RI_LOG_STREAM("info", args)
#define ROS_INFO_NAMED(n, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_NAMED(n, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_COND(c, ...) do { if (c) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define ROS_INFO_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("info", args); } while (0)
#define ROS_INFO_COND_NAMED(c, n, ...) do { if (c) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define ROS_INFO_STREAM_COND_NAMED(c, n, args) do { if (c) RI_LOG_STREAM("info", args); } while (0)
#define ROS_INFO_ONCE(...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_ONCE(args) RI_LOG_STREAM("info", args)
#define ROS_INFO_ONCE_NAMED(n, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_ONCE_NAMED(n, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_THROTTLE(p, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_THROTTLE(p, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_THROTTLE_NAMED(p, n, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_DELAYED_THROTTLE(p, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_DELAYED_THROTTLE(p, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_DELAYED_THROTTLE_NAMED(p, n, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_DELAYED_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_FILTER(f, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_FILTER(f, args) RI_LOG_STREAM("info", args)
#define ROS_INFO_FILTER_NAMED(f, n, ...) RI_LOG("info", __VA_ARGS__)
#define ROS_INFO_STREAM_FILTER_NAMED(f, n, args) RI_LOG_STREAM("info", args)
#define ROS_WARN(...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM(args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_NAMED(n, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_NAMED(n, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_COND(c, ...) do { if (c) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define ROS_WARN_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("warn", args); } while (0)
#define ROS_WARN_COND_NAMED(c, n, ...) do { if (c) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define ROS_WARN_STREAM_COND_NAMED(c, n, args) do { if (c) RI_LOG_STREAM("warn", args); } while (0)
#define ROS_WARN_ONCE(...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_ONCE(args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_ONCE_NAMED(n, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_ONCE_NAMED(n, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_THROTTLE(p, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_THROTTLE(p, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_THROTTLE_NAMED(p, n, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_DELAYED_THROTTLE(p, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_DELAYED_THROTTLE(p, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_DELAYED_THROTTLE_NAMED(p, n, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_DELAYED_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_FILTER(f, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_FILTER(f, args) RI_LOG_STREAM("warn", args)
#define ROS_WARN_FILTER_NAMED(f, n, ...) RI_LOG("warn", __VA_ARGS__)
#define ROS_WARN_STREAM_FILTER_NAMED(f, n, args) RI_LOG_STREAM("warn", args)
#define ROS_ERROR(...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM(args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_NAMED(n, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_NAMED(n, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_COND(c, ...) do { if (c) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define ROS_ERROR_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("error", args); } while (0)
#define ROS_ERROR_COND_NAMED(c, n, ...) do { if (c) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define ROS_ERROR_STREAM_COND_NAMED(c, n, args) do { if (c) RI_LOG_STREAM("error", args); } while (0)
#define ROS_ERROR_ONCE(...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_ONCE(args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_ONCE_NAMED(n, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_ONCE_NAMED(n, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_THROTTLE(p, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_THROTTLE(p, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_THROTTLE_NAMED(p, n, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_DELAYED_THROTTLE(p, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_DELAYED_THROTTLE(p, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_DELAYED_THROTTLE_NAMED(p, n, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_DELAYED_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_FILTER(f, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_FILTER(f, args) RI_LOG_STREAM("error", args)
#define ROS_ERROR_FILTER_NAMED(f, n, ...) RI_LOG("error", __VA_ARGS__)
#define ROS_ERROR_STREAM_FILTER_NAMED(f, n, args) RI_LOG_STREAM("error", args)
#define ROS_FATAL(...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM(args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_NAMED(n, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_NAMED(n, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_COND(c, ...) do { if (c) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define ROS_FATAL_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("fatal", args); } while (0)
#define ROS_FATAL_COND_NAMED(c, n, ...) do { if (c) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define ROS_FATAL_STREAM_COND_NAMED(c, n, args) do { if (c) RI_LOG_STREAM("fatal", args); } while (0)
#define ROS_FATAL_ONCE(...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_ONCE(args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_ONCE_NAMED(n, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_ONCE_NAMED(n, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_THROTTLE(p, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_THROTTLE(p, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_THROTTLE_NAMED(p, n, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_DELAYED_THROTTLE(p, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_DELAYED_THROTTLE(p, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_DELAYED_THROTTLE_NAMED(p, n, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_DELAYED_THROTTLE_NAMED(p, n, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_FILTER(f, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_FILTER(f, args) RI_LOG_STREAM("fatal", args)
#define ROS_FATAL_FILTER_NAMED(f, n, ...) RI_LOG("fatal", __VA_ARGS__)
#define ROS_FATAL_STREAM_FILTER_NAMED(f, n, args) RI_LOG_STREAM("fatal", args)
