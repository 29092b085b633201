#include <memory>

#include <controller_manager_msgs/srv/list_controllers.hpp>
#include <controller_manager_msgs/srv/switch_controller.hpp>
#include <rclcpp/rclcpp.hpp>

using Switch = controller_manager_msgs::srv::SwitchController;

struct Plan
{
  bool start_asap = true;
};

void fill(Switch::Request & request)
{
  Plan plan;
  request.start_asap = plan.start_asap;
}

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto request = std::make_shared<controller_manager_msgs::srv::SwitchController::Request>();
  request->start_controllers = {"arm"};
  fill(*request);
  return 0;
}
