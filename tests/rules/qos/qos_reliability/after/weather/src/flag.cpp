#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/float32.hpp>

using namespace std::chrono_literals;

class Flag : public rclcpp::Node
{
public:
  Flag() : Node("flag")
  {
    subscription_ = create_subscription<std_msgs::msg::Float32>(
      "wind", 10,
      [this](const std_msgs::msg::Float32 & wind) { RCLCPP_INFO(get_logger(), "%f", wind.data); });
  }

private:
  rclcpp::Subscription<std_msgs::msg::Float32>::SharedPtr subscription_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Flag>());
  return 0;
}
