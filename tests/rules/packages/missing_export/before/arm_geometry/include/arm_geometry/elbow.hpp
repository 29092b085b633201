#pragma once
#include <angles/angles.h>

namespace arm_geometry
{
inline double elbow(double angle) { return angles::normalize_angle(angle); }
}  // namespace arm_geometry
