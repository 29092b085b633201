#if __has_include(<cv_bridge/cv_bridge.hpp>)
#include <cv_bridge/cv_bridge.hpp>
#else
#include <cv_bridge/cv_bridge.h>
#endif

int main()
{
  cv_bridge::CvImage image;
  return image.image.rows;
}
