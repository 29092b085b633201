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
  hardware_interface::return_type read() override;
  hardware_interface::return_type write() override;
};
}  // namespace winch

#endif  // WINCH__WINCH_HPP_
