#include "arm_geometry/elbow.hpp"

double arm_geometry_zero() { return arm_geometry::elbow(0.0); }
