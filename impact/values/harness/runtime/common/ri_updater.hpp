// diagnostic_updater: what is reported is no reaction.
#pragma once
#if RI_ROS == 1
#include <ros/ros.h>
#include <diagnostic_msgs/DiagnosticStatus.h>
namespace ri { using DiagnosticStatus = ::diagnostic_msgs::DiagnosticStatus; }
#else
#include <rclcpp/rclcpp.hpp>
#include <diagnostic_msgs/msg/diagnostic_status.hpp>
namespace ri { using DiagnosticStatus = ::diagnostic_msgs::msg::DiagnosticStatus; }
#endif
#include "ri_core.hpp"

namespace diagnostic_updater {
struct DiagnosticStatusWrapper : ri::DiagnosticStatus {
  template <class... A> void summary(A &&...) {} template <class... A> void summaryf(A &&...) {} template <class... A> void add(A &&...) {} template <class... A> void addf(A &&...) {}
  template <class... A> void mergeSummary(A &&...) {} template <class... A> void mergeSummaryf(A &&...) {} void clearSummary() {} void clear() {}
};
using TaskFunction = std::function<void(DiagnosticStatusWrapper &)>;
struct DiagnosticTask { std::string name_; explicit DiagnosticTask(const std::string &name) : name_(name) {} virtual ~DiagnosticTask() = default; virtual void run(DiagnosticStatusWrapper &) = 0; const std::string &getName() { return name_; } };
struct Updater {
  void ri_set_name(const char *) {}
  template <class... A> explicit Updater(A &&...) {} template <class... A> void setHardwareID(A &&...) {} template <class... A> void setHardwareIDf(A &&...) {}
  template <class... A> void add(A &&...) {} void update() {} void force_update() {} template <class... A> void broadcast(A &&...) {} template <class... A> void setPeriod(A &&...) {} bool removeByName(const std::string &) { return true; } bool verbose_ = false;
};
struct FrequencyStatusParam { template <class... A> FrequencyStatusParam(A &&...) {} };
struct TimeStampStatusParam { template <class... A> TimeStampStatusParam(A &&...) {} };
struct FrequencyStatus { template <class... A> explicit FrequencyStatus(A &&...) {} void tick() {} void clear() {} };
struct TimeStampStatus { template <class... A> explicit TimeStampStatus(A &&...) {} template <class... A> void tick(A &&...) {} };
struct Heartbeat { Heartbeat() {} };
struct HeaderlessTopicDiagnostic { void ri_set_name(const char *) {} template <class... A> explicit HeaderlessTopicDiagnostic(A &&...) {} void tick() {} template <class... A> void addTask(A &&...) {} void clear_window() {} };
struct TopicDiagnostic : HeaderlessTopicDiagnostic { using HeaderlessTopicDiagnostic::HeaderlessTopicDiagnostic; template <class... A> void tick(A &&...) {} };
template <class M> struct DiagnosedPublisher : ri::Named {
  template <class... A> explicit DiagnosedPublisher(A &&...) {}
  template <class P> void publish(const P &message) { if constexpr (ri::is_message<P>::value) ri::publish("publish", ri_name, message); else ri::publish("publish", ri_name, *message); }
};
template <class... A> struct FunctionDiagnosticTask : DiagnosticTask { template <class F> FunctionDiagnosticTask(const std::string &name, F &&) : DiagnosticTask(name) {} void run(DiagnosticStatusWrapper &) override {} };
using CompositeDiagnosticTask = FunctionDiagnosticTask<>;
}  // namespace diagnostic_updater
