"""Which version in a file of surfaces stands for what is asked for, when there are no clones."""

import pytest
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.clones import VersionError
from rosimpact.databuild.surface.compare import RepositorySurfaces, compare
from rosimpact.databuild.surface.stored_versions import StoredVersions
from rosimpact.databuild.surface_file import write
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.surface.store import Surfaces
from rosimpact.impact.targets.surface.surface import BuildSurface, PythonSurface, Surface

HUMBLE, JAZZY = (DistroTarget(distro).find_version("rclcpp") for distro in ("humble", "jazzy"))
EARLY = DistroTarget("humble", "2024-03-01").find_version("rclcpp")
"""What humble had then, and has now, are not the same."""


def surface(package, version, code):
    headers = ((f"{package}/{package}.hpp", header(code.encode())),)
    return Surface(package, version, BuildSurface(package, version), PythonSurface(package), headers)


@pytest.fixture
def versions(tmp_path):
    """rclcpp and rclcpp_action, which one repository releases, and of jazzy a branch."""
    packing = Packing()
    codes = {
        EARLY: ("void f(); void early();", ""),
        HUMBLE: ("void f();", ""),
        JAZZY: ("", "void f();"),
    }
    for version, (first, second) in codes.items():
        state = RepositorySurfaces({name: surface(name, version, code) for name, code in
                       (("rclcpp", first), ("rclcpp_action", second))})  # fmt: skip
        for name in state.surfaces:
            packing.add(name, version, (2,), state, version == JAZZY)
    file = tmp_path / "surfaces.sqlite"
    write(file, packing.pack_packages())
    return StoredVersions(Surfaces(file))


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ("humble", (HUMBLE, HUMBLE, False)),
        ("humble@2024-03-01", (EARLY, EARLY, False)),
        (HUMBLE, (HUMBLE, HUMBLE, False)),
        # A branch was read for it, which answers for no distro.
        (JAZZY, (JAZZY, JAZZY, True)),
        # The newest before what it has.
        ("jazzy", (JAZZY, HUMBLE, True)),
        ("kilted", (DistroTarget("kilted").find_version("rclcpp"), HUMBLE, True)),
    ],
)
def test_what_stands_for_what(versions, asked, found):
    assert versions.find("rclcpp", asked) == (*found, 2)


@pytest.mark.parametrize(
    ("package", "asked", "why"),
    [
        ("rclcpp", "1.2.3", f"`rclcpp` 1.2.3 is not shipped, others from {EARLY} to {JAZZY} are"),
        ("rclcpp", "foxy", "is not shipped, others from"),
        ("rclcpp", "noetic", "noetic has no `rclcpp`; released in "),
        ("rclcpp", "jazy", "jazy"),
        ("rclpy", "humble", "surfaces of `rclpy` are not shipped"),
    ],
)
def test_what_does_not(versions, package, asked, why):
    with pytest.raises(VersionError, match=why):
        versions.find(package, asked)


def test_packages_that_were_released_together_are_seen_together(versions):
    (_, before), (_, after) = (versions.find_surface("rclcpp", asked) for asked in ("humble", JAZZY))
    changes = compare(before.surfaces["rclcpp"], after.surfaces["rclcpp"], before, after)
    assert [(c.kind, c.name, c.moved_to) for c in changes] == [("moved", "f", "rclcpp_action")]


def test_the_newest_distro_that_has_it(versions):
    assert versions.find_newest("roscpp") == "noetic"
    with pytest.raises(VersionError, match="no distro ever had `no_such_thing`"):
        versions.find_newest("no_such_thing")
