"""Which distros a text names."""

from __future__ import annotations

import pytest
from rosimpact.corpus.distros import find_distros


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("Fails on noetic, fine on Melodic", ("melodic", "noetic")),
        ("apt install ros-kinetic-cv-bridge", ("kinetic",)),
        ("source /opt/ros/iron/setup.bash", ("iron",)),
        ("ROS2 Rolling and ROS 2 Iron", ("iron", "rolling")),
        ("ROS_DISTRO=galactic", ("galactic",)),
        ("branch hydro-devel", ("hydro",)),
        ("humble/iron builds", ("humble", "iron")),
        ("from indigo to kinetic", ("indigo", "kinetic")),
        ("Kinetic Kame", ("kinetic",)),
        ("[ROS Lunar] no topic", ("lunar",)),
        # ordinary words
        ("the rolling average of electric current", ()),
        ("iron out the crystal's kinetic energy", ()),
        ("a dashing robot of jade", ()),
        ("melodically", ()),
        ("microkinetic ros", ()),
        ("", ()),
        ("noetic noetic NOETIC", ("noetic",)),
    ],
)
def test_names(text, named):
    assert find_distros(text) == named
