#include <Eigen/Geometry>

int main() { return Eigen::Vector3d::UnitX().norm() > 0.5 ? 0 : 1; }
