// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include "porter_vision/marker_detector.hpp"

#include <algorithm>
#include <cstddef>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace porter_vision
{

MarkerDetector::MarkerDetector(double side)
: model_{
    {-side / 2.0, side / 2.0, 0.0},
    {side / 2.0, side / 2.0, 0.0},
    {side / 2.0, -side / 2.0, 0.0},
    {-side / 2.0, -side / 2.0, 0.0}},
  detector_(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50))
{
}

std::vector<Marker> MarkerDetector::detect(
  const cv::Mat & image, const cv::Matx33d & camera, const std::vector<double> & distortion) const
{
  cv::Mat levelled;
  cv::equalizeHist(image, levelled);

  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  detector_.detectMarkers(levelled, corners, ids);

  std::vector<Marker> markers;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Marker marker;
    marker.id = ids[i];
    std::copy_n(corners[i].begin(), 4, marker.corners.begin());
    if (cv::solvePnP(
        model_, corners[i], camera, distortion, marker.rotation, marker.position, false,
        cv::SOLVEPNP_IPPE_SQUARE))
    {
      markers.push_back(marker);
    }
  }
  return markers;
}

}  // namespace porter_vision
