// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#ifndef GANTRY_VISION_GRADER_H
#define GANTRY_VISION_GRADER_H

#include <string>
#include <vector>

#include <gantry_msgs/Potato.h>
#include <opencv2/core.hpp>

namespace gantry_vision
{

struct GradingLimits
{
  int threshold;     ///< grey values above the empty belt
  double smallest;   ///< pixels
  double greenness;  ///< share of green, 0 to 1
};

/// Finds potatoes by comparing an image with one of the empty belt.
class Grader
{
public:
  /// Reads the image of the empty belt; throws std::runtime_error when it cannot be read.
  explicit Grader(const std::string& empty_belt);

  /// The potatoes in a colour image of the same size as that of the empty belt.
  std::vector<gantry_msgs::Potato> grade(const cv::Mat& image, const GradingLimits& limits) const;

private:
  cv::Mat empty_;
};

}  // namespace gantry_vision

#endif
