// rclcpp_lifecycle: a node that the harness configures and activates.
#pragma once
#include <rclcpp/rclcpp.hpp>
#include <lifecycle_msgs/msg/state.hpp>
#include <lifecycle_msgs/msg/transition.hpp>
namespace rclcpp_lifecycle {
struct State { uint8_t ri_id = 0; State(uint8_t id = 0, const std::string & = "") : ri_id(id) {} uint8_t id() const { return ri_id; } std::string label() const { return "state"; } };
struct Transition { uint8_t id() const { return 0; } std::string label() const { return ""; } };
namespace node_interfaces {
struct LifecycleNodeInterface {
  enum class CallbackReturn : uint8_t { SUCCESS = 97, FAILURE = 98, ERROR = 99 };
  virtual ~LifecycleNodeInterface() = default;
  virtual CallbackReturn on_configure(const State &) { return CallbackReturn::SUCCESS; } virtual CallbackReturn on_cleanup(const State &) { return CallbackReturn::SUCCESS; } virtual CallbackReturn on_shutdown(const State &) { return CallbackReturn::SUCCESS; }
  virtual CallbackReturn on_activate(const State &) { return CallbackReturn::SUCCESS; } virtual CallbackReturn on_deactivate(const State &) { return CallbackReturn::SUCCESS; } virtual CallbackReturn on_error(const State &) { return CallbackReturn::SUCCESS; }
};
}  // namespace node_interfaces
using LifecycleNodeInterface = node_interfaces::LifecycleNodeInterface;
template <class M, class A = void> struct LifecyclePublisher : rclcpp::Publisher<M> { RCLCPP_SMART_PTR_DEFINITIONS(LifecyclePublisher<M, A>) };
class LifecycleNode : public rclcpp::Node, public node_interfaces::LifecycleNodeInterface {
 public:
  RCLCPP_SMART_PTR_DEFINITIONS(LifecycleNode)
  using rclcpp::Node::Node;
  explicit LifecycleNode(const std::string &name, const rclcpp::NodeOptions &options = {}, bool = true) : rclcpp::Node(name, options) {}
  LifecycleNode(const std::string &name, const std::string &space, const rclcpp::NodeOptions &options, bool) : rclcpp::Node(name, space, options) {}
  std::shared_ptr<LifecycleNode> shared_from_this() { return std::static_pointer_cast<LifecycleNode>(rclcpp::Node::shared_from_this()); }
  template <class M, class... O> std::shared_ptr<LifecyclePublisher<M>> create_publisher(const std::string &topic, const rclcpp::QoS &, O &&...) { auto made = std::make_shared<LifecyclePublisher<M>>(); made->ri_topic = topic; made->ri_keep_name(topic); return made; }
  const State &get_current_state() const { static State state(3); return state; } template <class... A> const State &trigger_transition(A &&...) { return get_current_state(); } template <class... A> const State &configure(A &&...) { return get_current_state(); } template <class... A> const State &activate(A &&...) { return get_current_state(); } template <class... A> const State &deactivate(A &&...) { return get_current_state(); } template <class... A> const State &shutdown(A &&...) { ri::effect("shutdown", "node"); return get_current_state(); } template <class... A> const State &cleanup(A &&...) { return get_current_state(); }
  template <class F> bool register_on_configure(F &&) { return true; } template <class F> bool register_on_activate(F &&) { return true; }
};
}  // namespace rclcpp_lifecycle
