#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/float32.hpp>

using namespace std::chrono_literals;

class Mast : public rclcpp::Node
{
public:
  Mast() : Node("mast")
  {
    publisher_ = create_publisher<std_msgs::msg::Float32>("wind", 10);
    timer_ = create_wall_timer(1s, [this]() { publisher_->publish(std_msgs::msg::Float32()); });
  }

private:
  rclcpp::Publisher<std_msgs::msg::Float32>::SharedPtr publisher_;
  rclcpp::TimerBase::SharedPtr timer_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Mast>());
  return 0;
}
