// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include "gantry_vision/grader.h"

#include <cstddef>
#include <stdexcept>

#include <opencv2/highgui.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gantry_vision
{

Grader::Grader(const std::string& empty_belt) : empty_(cv::imread(empty_belt, CV_LOAD_IMAGE_GRAYSCALE))
{
  if (empty_.empty())
  {
    throw std::runtime_error("cannot read the image of the empty belt: " + empty_belt);
  }
}

std::vector<gantry_msgs::Potato> Grader::grade(const cv::Mat& image, const GradingLimits& limits) const
{
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::Mat mask;
  cv::absdiff(grey, empty_, mask);
  cv::threshold(mask, mask, limits.threshold, 255, cv::THRESH_BINARY);

  std::vector<std::vector<cv::Point> > contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);

  std::vector<gantry_msgs::Potato> potatoes;
  for (std::size_t i = 0; i < contours.size(); ++i)
  {
    const double area = cv::contourArea(contours[i]);
    if (area < limits.smallest)
    {
      continue;
    }
    const cv::Moments moments = cv::moments(contours[i]);
    cv::Mat inside = cv::Mat::zeros(image.size(), CV_8UC1);
    cv::drawContours(inside, contours, static_cast<int>(i), cv::Scalar(255), -1);
    const cv::Scalar colour = cv::mean(image, inside);
    const double sum = colour[0] + colour[1] + colour[2];

    gantry_msgs::Potato potato;
    potato.centre.x = moments.m10 / moments.m00;
    potato.centre.y = moments.m01 / moments.m00;
    potato.area = static_cast<float>(area);
    potato.grade = sum > 0.0 && colour[1] / sum > limits.greenness ? gantry_msgs::Potato::GRADE_GREEN :
                                                                     gantry_msgs::Potato::GRADE_GOOD;
    potatoes.push_back(potato);
  }
  return potatoes;
}

}  // namespace gantry_vision
