#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/float32.hpp>

class Chart : public rclcpp::Node
{
public:
  Chart() : Node("chart")
  {
    subscription_ = create_subscription<std_msgs::msg::Float32>(
      "depth", 10, [this](const std_msgs::msg::Float32 & depth) { RCLCPP_INFO(get_logger(), "%f", depth.data); });
  }

private:
  rclcpp::Subscription<std_msgs::msg::Float32>::SharedPtr subscription_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Chart>());
  return 0;
}
