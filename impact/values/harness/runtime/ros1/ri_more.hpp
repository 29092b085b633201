// nodelet, pluginlib, dynamic_reconfigure, actionlib, image_transport, realtime_tools, as far as callbacks meet them.
#pragma once
#include <ros/ros.h>
#include "ri_core.hpp"
#define PLUGINLIB_EXPORT_CLASS(...)
#define PLUGINLIB_DECLARE_CLASS(...)
#define PLUGINLIB_REGISTER_CLASS(...)
#define CLASS_LOADER_REGISTER_CLASS(...)
namespace nodelet {
struct Nodelet {
  virtual ~Nodelet() = default;
  virtual void onInit() = 0;
  ros::NodeHandle &getNodeHandle() const { return ri_handle; } ros::NodeHandle &getPrivateNodeHandle() const { return ri_handle; }
  ros::NodeHandle &getMTNodeHandle() const { return ri_handle; } ros::NodeHandle &getMTPrivateNodeHandle() const { return ri_handle; }
  ros::CallbackQueueInterface &getMTCallbackQueue() const { return *ros::getGlobalCallbackQueue(); } ros::CallbackQueueInterface &getSTCallbackQueue() const { return *ros::getGlobalCallbackQueue(); }
  const std::string &getName() const { return ri_nodelet_name; } const std::vector<std::string> &getMyArgv() const { return ri_argv; } std::string getSuffixedName(const std::string &s) const { return s; }
  mutable ros::NodeHandle ri_handle; std::string ri_nodelet_name = "nodelet"; std::vector<std::string> ri_argv;
};
struct Loader : ri::Anything { using ri::Anything::Anything; };
}  // namespace nodelet
namespace pluginlib {
struct PluginlibException : std::runtime_error { using std::runtime_error::runtime_error; };
using LibraryLoadException = PluginlibException; using CreateClassException = PluginlibException; using LibraryUnloadException = PluginlibException;
template <class T> struct ClassLoader {
  template <class... A> explicit ClassLoader(A &&...) {}
  std::shared_ptr<T> createInstance(const std::string &) { ri::unknown("a plugin"); return {}; } std::shared_ptr<T> createUniqueInstance(const std::string &) { ri::unknown("a plugin"); return {}; } T *createUnmanagedInstance(const std::string &) { ri::unknown("a plugin"); return nullptr; }
  bool isClassAvailable(const std::string &) { return true; } std::vector<std::string> getDeclaredClasses() { return {}; } std::string getName(const std::string &s) { return s; } void unloadLibraryForClass(const std::string &) {}
};
}  // namespace pluginlib
namespace dynamic_reconfigure {
template <class C> struct Server {
  typedef boost::function<void(C &, uint32_t)> CallbackType;
  void ri_set_name(const char *) {}
  template <class... A> explicit Server(A &&...) {}
  template <class F> void setCallback(F &&) {} template <class F> void clearCallback(F &&) {} void clearCallback() {} void updateConfig(const C &) { ri::effect("parameter", "reconfigure"); }
  void setConfigDefault(const C &) {} void setConfigMin(const C &) {} void setConfigMax(const C &) {}
};
template <class C> struct Client : ri::Anything { using ri::Anything::Anything; };
}  // namespace dynamic_reconfigure
namespace realtime_tools {
template <class M> struct RealtimePublisher : ri::Named {
  M msg_;
  RealtimePublisher() = default;
  template <class... A> explicit RealtimePublisher(A &&...) {}
  bool trylock() { return ri_boolean("~trylock") != 0; } void lock() {} void unlock() {} void unlockAndPublish() { ri::publish("publish", ri_name, msg_); } void init(...) {}
};
template <class T> struct RealtimeBuffer {
  T ri_value{};
  RealtimeBuffer() = default; explicit RealtimeBuffer(const T &v) : ri_value(v) {}
  void writeFromNonRT(const T &v) { ri_value = v; } void initRT(const T &v) { ri_value = v; } T *readFromRT() { return &ri_value; } T *readFromNonRT() { return &ri_value; } void reset() {}
};
}  // namespace realtime_tools
#define NODELET_DEBUG(...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define NODELET_DEBUG_STREAM(args) do { RI_LOG_STREAM("debug", args); } while (0)
#define NODELET_DEBUG_ONCE(...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define NODELET_DEBUG_STREAM_ONCE(args) do { RI_LOG_STREAM("debug", args); } while (0)
#define NODELET_DEBUG_COND(c, ...) do { if (c) ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define NODELET_DEBUG_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("debug", args); } while (0)
#define NODELET_DEBUG_THROTTLE(p, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define NODELET_DEBUG_STREAM_THROTTLE(p, args) do { RI_LOG_STREAM("debug", args); } while (0)
#define NODELET_DEBUG_NAMED(n, ...) do { ::ri::log_all("debug", __VA_ARGS__); } while (0)
#define NODELET_DEBUG_STREAM_NAMED(n, args) do { RI_LOG_STREAM("debug", args); } while (0)
#define NODELET_INFO(...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define NODELET_INFO_STREAM(args) do { RI_LOG_STREAM("info", args); } while (0)
#define NODELET_INFO_ONCE(...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define NODELET_INFO_STREAM_ONCE(args) do { RI_LOG_STREAM("info", args); } while (0)
#define NODELET_INFO_COND(c, ...) do { if (c) ::ri::log_all("info", __VA_ARGS__); } while (0)
#define NODELET_INFO_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("info", args); } while (0)
#define NODELET_INFO_THROTTLE(p, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define NODELET_INFO_STREAM_THROTTLE(p, args) do { RI_LOG_STREAM("info", args); } while (0)
#define NODELET_INFO_NAMED(n, ...) do { ::ri::log_all("info", __VA_ARGS__); } while (0)
#define NODELET_INFO_STREAM_NAMED(n, args) do { RI_LOG_STREAM("info", args); } while (0)
#define NODELET_WARN(...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define NODELET_WARN_STREAM(args) do { RI_LOG_STREAM("warn", args); } while (0)
#define NODELET_WARN_ONCE(...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define NODELET_WARN_STREAM_ONCE(args) do { RI_LOG_STREAM("warn", args); } while (0)
#define NODELET_WARN_COND(c, ...) do { if (c) ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define NODELET_WARN_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("warn", args); } while (0)
#define NODELET_WARN_THROTTLE(p, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define NODELET_WARN_STREAM_THROTTLE(p, args) do { RI_LOG_STREAM("warn", args); } while (0)
#define NODELET_WARN_NAMED(n, ...) do { ::ri::log_all("warn", __VA_ARGS__); } while (0)
#define NODELET_WARN_STREAM_NAMED(n, args) do { RI_LOG_STREAM("warn", args); } while (0)
#define NODELET_ERROR(...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define NODELET_ERROR_STREAM(args) do { RI_LOG_STREAM("error", args); } while (0)
#define NODELET_ERROR_ONCE(...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define NODELET_ERROR_STREAM_ONCE(args) do { RI_LOG_STREAM("error", args); } while (0)
#define NODELET_ERROR_COND(c, ...) do { if (c) ::ri::log_all("error", __VA_ARGS__); } while (0)
#define NODELET_ERROR_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("error", args); } while (0)
#define NODELET_ERROR_THROTTLE(p, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define NODELET_ERROR_STREAM_THROTTLE(p, args) do { RI_LOG_STREAM("error", args); } while (0)
#define NODELET_ERROR_NAMED(n, ...) do { ::ri::log_all("error", __VA_ARGS__); } while (0)
#define NODELET_ERROR_STREAM_NAMED(n, args) do { RI_LOG_STREAM("error", args); } while (0)
#define NODELET_FATAL(...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define NODELET_FATAL_STREAM(args) do { RI_LOG_STREAM("fatal", args); } while (0)
#define NODELET_FATAL_ONCE(...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define NODELET_FATAL_STREAM_ONCE(args) do { RI_LOG_STREAM("fatal", args); } while (0)
#define NODELET_FATAL_COND(c, ...) do { if (c) ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define NODELET_FATAL_STREAM_COND(c, args) do { if (c) RI_LOG_STREAM("fatal", args); } while (0)
#define NODELET_FATAL_THROTTLE(p, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define NODELET_FATAL_STREAM_THROTTLE(p, args) do { RI_LOG_STREAM("fatal", args); } while (0)
#define NODELET_FATAL_NAMED(n, ...) do { ::ri::log_all("fatal", __VA_ARGS__); } while (0)
#define NODELET_FATAL_STREAM_NAMED(n, args) do { RI_LOG_STREAM("fatal", args); } while (0)
