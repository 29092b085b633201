"""The examples break where examples/README.md says they do, and nowhere else."""

from pathlib import Path

import pytest
from rosimpact.impact import check_workspace

EXAMPLES = Path(__file__).parents[2] / "examples"

# Severity, rule, path, subject, targets.
BREAKS = {
    "ros2_ws": """
        error   removed-header     src/porter_vision/src/marker_node.cpp  cv_bridge/cv_bridge.h  laptop,ci
        error   removed-header     src/porter_vision/src/marker_node.cpp  message_filters/subscriber.hpp  robot
        error   removed-header     src/porter_vision/src/marker_node.cpp  message_filters/time_synchronizer.hpp  robot
        error   library-version    src/porter_vision/CMakeLists.txt  OpenCV  laptop,ci
        warning undeclared-package src/porter_bringup/launch/porter.launch.py  v4l2_camera  laptop,robot,ci
        """,
    "ros1_ws": """
        error   removed-symbol     src/gantry_vision/src/grader.cpp  CV_LOAD_IMAGE_GRAYSCALE  laptop
        error   library-component  src/gantry_control/CMakeLists.txt  signals  laptop
        error   removed-header     src/gantry_control/include/gantry_control/axis.h  boost/signal.hpp  laptop
        error   removed-symbol     src/gantry_control/include/gantry_control/axis.h  boost::signal  laptop
        error   cmake-version      src/gantry_control/CMakeLists.txt  3.13  robot,old
        warning missing-install    src/gantry_vision/CMakeLists.txt  launch  robot,laptop,old
        """,
}


@pytest.mark.parametrize("workspace", BREAKS)
def test_breaks(workspace):
    expected = {tuple(row.split()) for row in BREAKS[workspace].strip().splitlines()}
    found = {
        (f.severity, f.rule, f.path, f.subject, ",".join(f.targets))
        for f in check_workspace(EXAMPLES / workspace)
        if f.severity != "note"
    }
    assert found == expected
