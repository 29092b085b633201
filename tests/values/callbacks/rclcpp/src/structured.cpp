// Callbacks of rclcpp: containers, optional values, virtual calls, templates, lambdas, parameters.
#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/msg/twist.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/int32.hpp>
#include <std_msgs/msg/string.hpp>
#include <std_msgs/msg/u_int8.hpp>

using std::placeholders::_1;

struct Behaviour
{
  virtual ~Behaviour() = default;
  virtual int act(int value) const = 0;
};
struct Keep : Behaviour
{
  int act(int value) const override { return value; }
};
struct Divide : Behaviour
{
  int act(int value) const override { return 100 / value; }  // onVirtual DIVISION
};

template <typename T>
bool isBetween(T value, T low, T high)
{
  return !(value < low) && !(high < value);
}

class Structured : public rclcpp::Node
{
public:
  Structured() : Node("structured")
  {
    limit_ = declare_parameter("limit", 5);
    pub_ = create_publisher<std_msgs::msg::Int32>("out", 1);
    add(create_subscription<std_msgs::msg::Int32>("virtual", 1, std::bind(&Structured::onVirtual, this, _1)));
    add(create_subscription<std_msgs::msg::Int32>("template", 1, std::bind(&Structured::onTemplate, this, _1)));
    add(create_subscription<std_msgs::msg::String>("map_at", 1, std::bind(&Structured::onMapAt, this, _1)));
    add(create_subscription<std_msgs::msg::String>("map_find", 1, std::bind(&Structured::onMapFind, this, _1)));
    add(create_subscription<std_msgs::msg::UInt8>("optional", 1, std::bind(&Structured::onOptional, this, _1)));
    add(create_subscription<std_msgs::msg::UInt8>("value", 1, std::bind(&Structured::onValue, this, _1)));
    add(create_subscription<std_msgs::msg::UInt8>("array", 1, std::bind(&Structured::onArray, this, _1)));
    add(create_subscription<sensor_msgs::msg::JointState>("joints", 1, std::bind(&Structured::onJoints, this, _1)));
    add(create_subscription<std_msgs::msg::Int32>("queue", 1, std::bind(&Structured::onQueue, this, _1)));
    add(create_subscription<std_msgs::msg::Bool>("switch", 1, std::bind(&Structured::onSwitch, this, _1)));
    add(create_subscription<std_msgs::msg::Int32>("limited", 1, std::bind(&Structured::onLimited, this, _1)));
    add(create_subscription<std_msgs::msg::Int32>(
      "lambda", 1, [this](const std_msgs::msg::Int32::SharedPtr msg) {
        if (msg->data == 4) send(1000 / (msg->data - 4));  // lambda DIVISION
      }));
    add(create_subscription<geometry_msgs::msg::Twist>("twist", 1, std::bind(&Structured::onTwist, this, _1)));
  }

private:
  void add(rclcpp::SubscriptionBase::SharedPtr one) { all_.push_back(one); }
  void send(int value)
  {
    std_msgs::msg::Int32 out;
    out.data = value;
    pub_->publish(out);
  }
  void onVirtual(const std_msgs::msg::Int32::SharedPtr msg)
  {
    std::unique_ptr<Behaviour> one;
    if (msg->data > 50) one = std::make_unique<Keep>();
    else one = std::make_unique<Divide>();
    send(one->act(msg->data));
  }
  void onTemplate(const std_msgs::msg::Int32::SharedPtr msg)
  {
    if (isBetween<int>(msg->data, 10, 20)) send(msg->data);
  }
  void onMapAt(const std_msgs::msg::String::SharedPtr msg)
  {
    static const std::map<std::string, int> codes{{"on", 1}, {"off", 0}};
    send(codes.at(msg->data));  // onMapAt EXCEPTION
  }
  void onMapFind(const std_msgs::msg::String::SharedPtr msg)
  {
    static const std::map<std::string, int> codes{{"on", 1}, {"off", 0}};
    const auto found = codes.find(msg->data);
    if (found == codes.end()) return;
    send(found->second);
  }
  std::optional<int> half(int value)
  {
    if (value % 2) return std::nullopt;
    return value / 2;
  }
  void onOptional(const std_msgs::msg::UInt8::SharedPtr msg)
  {
    send(*half(msg->data));  // onOptional EMPTY
  }
  void onValue(const std_msgs::msg::UInt8::SharedPtr msg)
  {
    send(half(msg->data).value());  // onValue EXCEPTION
  }
  void onArray(const std_msgs::msg::UInt8::SharedPtr msg)
  {
    const std::array<int, 3> table{{1, 2, 3}};
    send(table[msg->data]);  // onArray INDEX
  }
  void onJoints(const sensor_msgs::msg::JointState::SharedPtr msg)
  {
    if (msg->name.size() != msg->position.size()) return;
    const auto largest = std::max_element(msg->position.begin(), msg->position.end());
    if (largest == msg->position.end()) return;
    if (*largest > 1.0) send(1);
  }
  void onQueue(const std_msgs::msg::Int32::SharedPtr msg)
  {
    if (msg->data < 0) return;
    queue_.push_back(msg->data);
  }
  void onSwitch(const std_msgs::msg::Bool::SharedPtr msg)
  {
    if (msg->data == on_) return;
    on_ = msg->data;
    send(on_ ? 1 : 0);
  }
  void onLimited(const std_msgs::msg::Int32::SharedPtr msg)
  {
    if (msg->data > limit_) return;
    send(msg->data);
  }
  void onTwist(geometry_msgs::msg::Twist::UniquePtr msg)
  {
    if (msg->linear.x > 0.5) send(1);
    else if (msg->linear.x < -0.5) RCLCPP_WARN(get_logger(), "backwards");
  }
  int takeFirst() { return queue_.empty() ? 0 : queue_.front(); }

  rclcpp::Publisher<std_msgs::msg::Int32>::SharedPtr pub_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> all_;
  std::deque<int> queue_;
  bool on_ = false;
  int limit_ = 0;
};

int main(int argc, char **argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Structured>());
  rclcpp::shutdown();
}
