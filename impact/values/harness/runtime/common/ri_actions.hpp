// actionlib and rclcpp_action: what is sent and answered is told; goals come by the harness.
#pragma once
#if RI_ROS == 1
#include <ros/ros.h>
#include <actionlib_msgs/GoalStatus.h>
#include "ri_core.hpp"
namespace actionlib {
struct SimpleClientGoalState {
  enum StateEnum { PENDING, ACTIVE, RECALLED, REJECTED, PREEMPTED, ABORTED, SUCCEEDED, LOST };
  StateEnum state_ = PENDING;
  SimpleClientGoalState(StateEnum s = PENDING, const std::string & = "") : state_(s) {}
  bool operator==(const SimpleClientGoalState &o) const { return state_ == o.state_; } bool operator!=(const SimpleClientGoalState &o) const { return state_ != o.state_; }
  bool operator==(StateEnum s) const { return state_ == s; } bool operator!=(StateEnum s) const { return state_ != s; }
  bool isDone() const { return state_ > ACTIVE; } std::string toString() const { return {}; } std::string getText() const { return {}; }
};
template <class A> struct RiParts {
  using Goal = std::decay_t<decltype(std::declval<A &>().action_goal.goal)>; using Result = std::decay_t<decltype(std::declval<A &>().action_result.result)>; using Feedback = std::decay_t<decltype(std::declval<A &>().action_feedback.feedback)>;
};
template <class A> struct SimpleActionClient : ri::Named {
  using Goal = typename RiParts<A>::Goal; using Result = typename RiParts<A>::Result; using Feedback = typename RiParts<A>::Feedback;
  using ResultConstPtr = std::shared_ptr<Result const>; using FeedbackConstPtr = std::shared_ptr<Feedback const>;
  typedef boost::function<void(const SimpleClientGoalState &, const ResultConstPtr &)> SimpleDoneCallback; typedef boost::function<void()> SimpleActiveCallback; typedef boost::function<void(const FeedbackConstPtr &)> SimpleFeedbackCallback;
  template <class... B> explicit SimpleActionClient(const std::string &name, B &&...) { ri_keep_name(name); }
  template <class... B> SimpleActionClient(ros::NodeHandle &, const std::string &name, B &&...) { ri_keep_name(name); }
  template <class... D> bool waitForServer(const D &...) const { return ask("server"); } bool isServerConnected() const { return ask("server"); }
  template <class... F> void sendGoal(const Goal &goal, F &&...) { ri::publish("action", ri_name, goal); }
  template <class... D> SimpleClientGoalState sendGoalAndWait(const Goal &goal, const D &...) { ri::publish("action", ri_name, goal); return getState(); }
  template <class... D> bool waitForResult(const D &...) { return ask("result_came"); }
  ResultConstPtr getResult() const { ri_enter("~action"); ri_enter(ri_name); ResultConstPtr made = ri::make_message<Result>("result"); ri_leave(); ri_leave(); return made; }
  SimpleClientGoalState getState() const { ri_enter("~action"); ri_enter(ri_name); uint64_t s = ri_integer("state", 8, 0); ri_leave(); ri_leave(); ri_assume(s <= 7); return SimpleClientGoalState(static_cast<SimpleClientGoalState::StateEnum>(s)); }
  void cancelGoal() { ri::effect("action", ri_name); } void cancelAllGoals() { ri::effect("action", ri_name); } template <class T> void cancelGoalsAtAndBeforeTime(const T &) { ri::effect("action", ri_name); } void stopTrackingGoal() {}
  bool ask(const char *what) const { ri_enter("~action"); ri_enter(ri_name); bool v = ri_boolean(what) != 0; ri_leave(); ri_leave(); return v; }
};
template <class A> struct SimpleActionServer : ri::Named {
  using Goal = typename RiParts<A>::Goal; using Result = typename RiParts<A>::Result; using Feedback = typename RiParts<A>::Feedback;
  using GoalConstPtr = std::shared_ptr<Goal const>; typedef boost::function<void(const GoalConstPtr &)> ExecuteCallback;
  static GoalConstPtr &ri_goal() { static GoalConstPtr goal; return goal; }
  SimpleActionServer(const std::string &name, const ExecuteCallback &callback, bool, RI_HERE) { keep(name, callback, ri_file, ri_line); }
  SimpleActionServer(ros::NodeHandle, const std::string &name, const ExecuteCallback &callback, bool, RI_HERE) { keep(name, callback, ri_file, ri_line); }
  SimpleActionServer(const std::string &name, bool) { ri_keep_name(name); } SimpleActionServer(ros::NodeHandle, const std::string &name, bool) { ri_keep_name(name); }
  void keep(const std::string &name, const ExecuteCallback &callback, const char *file, int line) { ri_keep_name(name); if (callback) ri::give_callback<Goal>("action", [callback](const GoalConstPtr &g) { ri_goal() = g; callback(g); }, file, line); }
  template <class F> void registerGoalCallback(F callback, RI_HERE) {
    struct Holder { F call; static void run(void *self) { ri_goal() = ri::make_message<Goal>("msg"); ri::begin(); static_cast<Holder *>(self)->call(); } };
    ri::give("action", ri_file, ri_line, &Holder::run, new Holder{callback});
  }
  template <class F> void registerPreemptCallback(F callback, RI_HERE) { ri::give_plain("preempt", callback, ri_file, ri_line); }
  GoalConstPtr acceptNewGoal() { if (!ri_goal()) ri_goal() = ri::make_message<Goal>("msg"); ri::effect("action", ri_name); return ri_goal(); }
  bool isActive() { return ask("active"); } bool isNewGoalAvailable() { return ask("new_goal"); } bool isPreemptRequested() { return ask("preempt"); }
  void setSucceeded(const Result &r = {}, const std::string & = "") { ri::publish("reply", ri_name, r); } void setAborted(const Result &r = {}, const std::string & = "") { ri::publish("reply", ri_name, r); } void setPreempted(const Result &r = {}, const std::string & = "") { ri::publish("reply", ri_name, r); }
  void publishFeedback(const Feedback &f) { ri::publish("reply", ri_name, f); } void publishFeedback(const std::shared_ptr<Feedback> &f) { ri::publish("reply", ri_name, *f); } void start() {} void shutdown() {}
  bool ask(const char *what) const { ri_enter("~action"); ri_enter(ri_name); bool v = ri_boolean(what) != 0; ri_leave(); ri_leave(); return v; }
};
}  // namespace actionlib
#else
#include <rclcpp/rclcpp.hpp>
#include "ri_core.hpp"
namespace rclcpp_action {
using GoalUUID = std::array<uint8_t, 16>;
inline std::string to_string(const GoalUUID &) { return "goal"; }
enum class GoalResponse : int8_t { REJECT = 1, ACCEPT_AND_EXECUTE = 2, ACCEPT_AND_DEFER = 3 };
enum class CancelResponse : int8_t { REJECT = 1, ACCEPT = 2 };
enum class ResultCode : int8_t { UNKNOWN = 0, SUCCEEDED = 4, CANCELED = 5, ABORTED = 6 };
namespace exceptions { struct UnknownGoalHandleError : std::invalid_argument { using std::invalid_argument::invalid_argument; }; struct UnawareGoalHandleError : std::runtime_error { using std::runtime_error::runtime_error; }; }
template <class A> struct ServerGoalHandle {
  RCLCPP_SMART_PTR_DEFINITIONS(ServerGoalHandle<A>)
  std::shared_ptr<typename A::Goal> ri_goal;
  std::shared_ptr<const typename A::Goal> get_goal() const { return ri_goal; } const GoalUUID &get_goal_id() const { static GoalUUID id{}; return id; }
  void succeed(const std::shared_ptr<typename A::Result> &r) { ri::publish("reply", "result", *r); } void abort(const std::shared_ptr<typename A::Result> &r) { ri::publish("reply", "result", *r); } void canceled(const std::shared_ptr<typename A::Result> &r) { ri::publish("reply", "result", *r); }
  void publish_feedback(const std::shared_ptr<typename A::Feedback> &f) { ri::publish("reply", "feedback", *f); } void execute() { ri::effect("action", "execute"); }
  bool is_canceling() const { return ri_boolean("~canceling") != 0; } bool is_active() const { return ri_boolean("~active") != 0; } bool is_executing() const { return ri_boolean("~executing") != 0; }
};
template <class A> struct Server { RCLCPP_SMART_PTR_DEFINITIONS(Server<A>) void ri_set_name(const char *) {} };
template <class A, class F> struct AcceptHolder {
  F callback;
  static void run(void *self) { auto made = std::make_shared<ServerGoalHandle<A>>(); made->ri_goal = ri::make_message<typename A::Goal>("msg"); ri::begin(); static_cast<AcceptHolder *>(self)->callback(made); }
};
template <class A, class F> struct GoalHolder {
  F callback;
  static void run(void *self) {
    std::shared_ptr<const typename A::Goal> goal = ri::make_message<typename A::Goal>("msg"); GoalUUID id{}; ri::begin();
    if (static_cast<GoalHolder *>(self)->callback(id, goal) != GoalResponse::REJECT) ri::effect("action", "accept");
  }
};
template <class A, class N, class G, class C, class F> std::shared_ptr<Server<A>> ri_serve(G goal, C, F accepted, const char *file, int line) {
  ri::give("goal", file, line, &GoalHolder<A, G>::run, new GoalHolder<A, G>{goal});
  ri::give("action", file, line, &AcceptHolder<A, F>::run, new AcceptHolder<A, F>{accepted});
  return std::make_shared<Server<A>>();
}
template <class A, class N, class G, class C, class F> std::shared_ptr<Server<A>> create_server(N &&, const std::string &, G goal, C cancel, F accepted, RI_HERE) { return ri_serve<A, N>(goal, cancel, accepted, ri_file, ri_line); }
template <class A, class N, class G, class C, class F, class O> std::shared_ptr<Server<A>> create_server(N &&, const std::string &, G goal, C cancel, F accepted, const O &, std::shared_ptr<rclcpp::CallbackGroup> = nullptr, RI_HERE) { return ri_serve<A, N>(goal, cancel, accepted, ri_file, ri_line); }
template <class A, class B, class L, class W, class Q, class G, class C, class F> std::shared_ptr<Server<A>> create_server(B &&, L &&, W &&, Q &&, const std::string &, G goal, C cancel, F accepted, RI_HERE) { return ri_serve<A, B>(goal, cancel, accepted, ri_file, ri_line); }
template <class A> struct ClientGoalHandle {
  RCLCPP_SMART_PTR_DEFINITIONS(ClientGoalHandle<A>)
  struct WrappedResult { GoalUUID goal_id{}; ResultCode code = ResultCode::UNKNOWN; std::shared_ptr<typename A::Result> result; };
  const GoalUUID &get_goal_id() const { static GoalUUID id{}; return id; } int8_t get_status() { return static_cast<int8_t>(ri_integer("~goal_status", 8, 1)); } bool is_result_aware() { return true; }
  using FeedbackCallback = std::function<void(SharedPtr, const std::shared_ptr<const typename A::Feedback>)>; using ResultCallback = std::function<void(const WrappedResult &)>;
};
template <class A> struct Client : ri::Named {
  RCLCPP_SMART_PTR_DEFINITIONS(Client<A>)
  using GoalHandle = ClientGoalHandle<A>; using WrappedResult = typename GoalHandle::WrappedResult; using Goal = typename A::Goal; using Feedback = typename A::Feedback; using Result = typename A::Result;
  using GoalResponseCallback = std::function<void(typename GoalHandle::SharedPtr)>;
  struct SendGoalOptions { std::function<void(typename GoalHandle::SharedPtr)> goal_response_callback; typename GoalHandle::FeedbackCallback feedback_callback; typename GoalHandle::ResultCallback result_callback; };
  template <class... D> bool wait_for_action_server(const D &...) { return ri_boolean("~action_server") != 0; } bool action_server_is_ready() const { return ri_boolean("~action_server") != 0; }
  rclcpp::RiFuture<typename GoalHandle::SharedPtr> async_send_goal(const Goal &goal, const SendGoalOptions & = {}) {
    ri::publish("action", ri_name, goal); rclcpp::RiFuture<typename GoalHandle::SharedPtr> made; if (ri_boolean("~goal_accepted")) made.ri_value = std::make_shared<GoalHandle>(); return made;
  }
  template <class... B> rclcpp::RiFuture<WrappedResult> async_get_result(B &&...) { rclcpp::RiFuture<WrappedResult> made; made.ri_value.result = ri::make_message<Result>("~result"); made.ri_value.code = static_cast<ResultCode>(ri_integer("~result_code", 8, 1)); return made; }
  template <class... B> rclcpp::RiFuture<std::shared_ptr<ri::Anything>> async_cancel_goal(B &&...) { ri::effect("action", ri_name); return {}; } template <class... B> rclcpp::RiFuture<std::shared_ptr<ri::Anything>> async_cancel_all_goals(B &&...) { ri::effect("action", ri_name); return {}; }
};
template <class A, class N, class... B> std::shared_ptr<Client<A>> create_client(N &&, const std::string &name, B &&...) { auto made = std::make_shared<Client<A>>(); made->ri_keep_name(name); return made; }
}  // namespace rclcpp_action
#endif
