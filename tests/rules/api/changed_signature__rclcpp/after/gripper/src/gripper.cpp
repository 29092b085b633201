#include <memory>
#include <string>

#include <rclcpp/rclcpp.hpp>
#include <std_srvs/srv/trigger.hpp>

class Gripper : public rclcpp::Node
{
public:
  Gripper()
  : Node("gripper")
  {
    port_ = declare_parameter<std::string>("port", "/dev/ttyUSB0");
    client_ = create_client<std_srvs::srv::Trigger>("calibrate");
  }

  void calibrate(double patience)
  {
    const auto until = now() + rclcpp::Duration::from_seconds(patience);
    auto request = std::make_shared<std_srvs::srv::Trigger::Request>();
    auto answer = client_->async_send_request(request);
    while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) {
      if (now() > until) {
        RCLCPP_ERROR(get_logger(), "no answer from %s", port_.c_str());
        return;
      }
    }
  }

private:
  std::string port_;
  rclcpp::Client<std_srvs::srv::Trigger>::SharedPtr client_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  std::make_shared<Gripper>()->calibrate(2.0);
  rclcpp::shutdown();
  return 0;
}
