"""The examples break where examples/README.md says they do; nothing else is called an error."""

from pathlib import Path

import pytest
from rosimpact.impact import check_workspace

EXAMPLES = Path(__file__).parents[2] / "examples"

# ruff: noqa: E501
# Severity, rule, path, subject, targets.
BREAKS = {
    "ros2_ws": """
        error   removed-header     src/porter_vision/src/marker_node.cpp  cv_bridge/cv_bridge.h  laptop,ci
        error   removed-header     src/porter_vision/src/marker_node.cpp  message_filters/subscriber.hpp  robot
        error   removed-header     src/porter_vision/src/marker_node.cpp  message_filters/time_synchronizer.hpp  robot
        error   library-version    src/porter_vision/CMakeLists.txt  OpenCV  laptop,ci
        error   changed-signature  src/porter_vision/include/porter_vision/marker_detector.hpp  cv::aruco::ArucoDetector  laptop,ci
        error   changed-signature  src/porter_vision/src/marker_node.cpp  message_filters::Subscriber::subscribe  ci
        error   undeclared-package src/porter_bringup/launch/porter.launch.py  v4l2_camera  laptop,robot,ci
        """,
    "ros1_ws": """
        error   removed-symbol     src/gantry_vision/src/grader.cpp  CV_LOAD_IMAGE_GRAYSCALE  laptop
        error   library-component  src/gantry_control/CMakeLists.txt  signals  laptop
        error   removed-header     src/gantry_control/include/gantry_control/axis.h  boost/signal.hpp  laptop
        error   removed-symbol     src/gantry_control/include/gantry_control/axis.h  boost::signal  laptop
        error   cmake-version      src/gantry_control/CMakeLists.txt  3.13  robot,old
        note    uninstalled-file   src/gantry_vision/CMakeLists.txt  launch  robot,laptop,old
        """,
}


@pytest.fixture(scope="module", params=BREAKS)
def told(request):
    """What is expected of an example, and what is found."""
    expected = {tuple(row.split()) for row in BREAKS[request.param].strip().splitlines()}
    findings = check_workspace(EXAMPLES / request.param)
    return expected, {(f.severity, f.rule, f.path, f.subject, ",".join(f.targets)) for f in findings}


def test_what_is_said_to_break_is_found(told):
    expected, found = told
    assert expected - found == set()


def test_nothing_else_is_called_an_error(told):
    expected, found = told
    assert {finding for finding in found - expected if finding[0] == "error"} == set()
