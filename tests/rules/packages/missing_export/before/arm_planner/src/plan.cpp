#include <arm_geometry/elbow.hpp>

int main() { return arm_geometry::elbow(7.0) > 0.0 ? 0 : 1; }
