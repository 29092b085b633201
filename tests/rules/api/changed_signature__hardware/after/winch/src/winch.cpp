#include "winch/winch.hpp"

#include <pluginlib/class_list_macros.hpp>

namespace winch
{
std::vector<hardware_interface::StateInterface> Winch::export_state_interfaces() { return {}; }
std::vector<hardware_interface::CommandInterface> Winch::export_command_interfaces() { return {}; }
hardware_interface::return_type Winch::read(const rclcpp::Time &, const rclcpp::Duration &) { return hardware_interface::return_type::OK; }
hardware_interface::return_type Winch::write(const rclcpp::Time &, const rclcpp::Duration &) { return hardware_interface::return_type::OK; }
}  // namespace winch

PLUGINLIB_EXPORT_CLASS(winch::Winch, hardware_interface::SystemInterface)
