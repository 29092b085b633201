#pragma once

namespace winch_driver
{
struct Drum
{
  double radius;
  double angle;
};
}  // namespace winch_driver
