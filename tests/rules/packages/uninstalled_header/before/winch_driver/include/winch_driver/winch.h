#pragma once
#include "winch_driver/drum.hpp"

namespace winch_driver
{
double length(const Drum & drum);
}  // namespace winch_driver
