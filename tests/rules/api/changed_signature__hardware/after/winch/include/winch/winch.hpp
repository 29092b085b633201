#ifndef WINCH__WINCH_HPP_
#define WINCH__WINCH_HPP_

#include <vector>

#include <hardware_interface/system_interface.hpp>

namespace winch
{
class Winch : public hardware_interface::SystemInterface
{
public:
  std::vector<hardware_interface::StateInterface> export_state_interfaces() override;
  std::vector<hardware_interface::CommandInterface> export_command_interfaces() override;
  hardware_interface::return_type read(const rclcpp::Time &, const rclcpp::Duration &) override;
  hardware_interface::return_type write(const rclcpp::Time &, const rclcpp::Duration &) override;
};
}  // namespace winch

#endif  // WINCH__WINCH_HPP_
