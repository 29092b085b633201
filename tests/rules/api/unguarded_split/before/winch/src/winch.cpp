#include <cv_bridge/cv_bridge.h>

int main()
{
  cv_bridge::CvImage image;
  return image.image.rows;
}
