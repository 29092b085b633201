#include <nav2_util/lifecycle_node.hpp>
#include <nav2_costmap_2d/costmap_2d.hpp>

bool blocked(const nav2_costmap_2d::Costmap2D & map) { return map.getCost(0, 0) > 250; }
