// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#ifndef PORTER_VISION__MARKER_DETECTOR_HPP_
#define PORTER_VISION__MARKER_DETECTOR_HPP_

#include <array>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/objdetect/aruco_detector.hpp>

namespace porter_vision
{

/// A marker in an image: its corners in pixels, its position in metres and rotation (Rodrigues) before the camera.
struct Marker
{
  int id = -1;
  std::array<cv::Point2f, 4> corners;
  cv::Vec3d position;
  cv::Vec3d rotation;
};

/// Finds the square markers of the docks.
class MarkerDetector
{
public:
  /// side: edge of a marker in metres.
  explicit MarkerDetector(double side);

  /// Markers of a grey image. camera is the 3x3 matrix, distortion the coefficients of plumb_bob.
  std::vector<Marker> detect(
    const cv::Mat & image, const cv::Matx33d & camera, const std::vector<double> & distortion) const;

private:
  std::vector<cv::Point3d> model_;
  cv::aruco::ArucoDetector detector_;
};

}  // namespace porter_vision

#endif  // PORTER_VISION__MARKER_DETECTOR_HPP_
