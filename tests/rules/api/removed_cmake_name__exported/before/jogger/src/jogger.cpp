#include <grid_map_core/GridMap.hpp>

int main()
{
  return 0;
}
