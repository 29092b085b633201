"""Whose names a namespace holds that a package declares something in."""

import pytest
from rosimpact.impact.rules.api.uses import _is_of_another

NEAR = frozenset({"tl_expected", "libboost-dev", "moveit_core", "tf2", "point_cloud_transport"})


@pytest.mark.parametrize(
    ("space", "package", "of_another"),
    [
        ("point_cloud_transport", "point_cloud_transport", False),
        ("tl", "point_cloud_transport", True),  # a copy of tl_expected
        ("boost", "roscpp", True),  # what an older Boost did not have yet
        ("tf2", "tf2_ros", True),
        ("moveit", "moveit_core", False),
        ("ros", "roscpp", False),
        ("Eigen", "roscpp", False),  # nothing at hand is called so
    ],
)
def test_a_namespace_may_be_of_another_package(space, package, of_another):
    assert _is_of_another(space, package, NEAR) is of_another
