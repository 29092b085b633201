#pragma once

namespace gait_library
{
inline double period(double frequency) { return 1.0 / frequency; }
}  // namespace gait_library
