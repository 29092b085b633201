#include <cfloat>

#include <pcl/filters/voxel_grid.h>

float nearest(const float * distances, int count)
{
  float found = FLT_MAX;
  for (int i = 0; i < count; i++) {
    found = distances[i] < found ? distances[i] : found;
  }
  return found;
}
