"""Is it there, on this target? One answer for all kinds of names, from what is shipped."""

import pytest
from rosimpact.impact.targets import availability
from rosimpact.impact.targets.availability import Availabilities, list_horizons
from rosimpact.impact.targets.changes import ChangeRow
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.symbol import CppUseForm, Symbol

OLD, NEW = "tf2_geometry_msgs/tf2_geometry_msgs.h", "tf2_geometry_msgs/tf2_geometry_msgs.hpp"
TF2, CONTROL = ("tf2_geometry_msgs",), ("controller_manager",)


@pytest.mark.parametrize(
    ("distro", "symbol", "state", "since", "replacement"),
    [
        ("humble", Symbol("header", OLD, TF2), "deprecated", "0.18.0", NEW),
        ("jazzy", Symbol("header", OLD, TF2), "removed", "0.36.0", NEW),
        ("foxy", Symbol("header", NEW, TF2), "not yet", "0.18.0", OLD),
        ("jazzy", Symbol("header", "cv_bridge/cv_bridge.hpp", ("cv_bridge",)), "present", "", ""),
        # Headers that a build makes are in no source tree.
        ("jazzy", Symbol("header", "rclcpp/logging.hpp", ("rclcpp",)), "present", "", ""),
        ("humble", Symbol("header", "message_filters/connection.hpp", ("message_filters",)), "present", "", ""),
        ("jazzy", Symbol("header", "cv_bridge/no_such.hpp", ("cv_bridge",)), "not yet", "", ""),
        ("jazzy", Symbol("header", "rclcpp/version.h", ("rclcpp",)), "present", "", ""),
        ("jazzy", Symbol("header", "nav2_msgs/action/navigate_to_pose.hpp", ("nav2_msgs",)), "present", "", ""),
        # No version has a header that the version here surely lacks; of others more is made, or was not read.
        ("jazzy", Symbol("header", "hardware_interface/sytem_interface.hpp", ("hardware_interface",)),
         "not yet", "", ""),
        ("jazzy", Symbol("header", "rclcpp/node_interfaces/node_base_interface_traits.hpp", ("rclcpp",)),
         "unknown", "", ""),
        ("jazzy", Symbol("header", "rviz_common/version.h", ("rviz_common",)), "unknown", "", ""),
        # Made from an interface whose definition lies in another package.
        ("jazzy", Symbol("header", "test_msgs/action/fibonacci.hpp", ("test_msgs",)), "present", "", ""),
        ("jazzy", Symbol("header", "test_msgs/action/no_such.hpp", ("test_msgs",)), "unknown", "", ""),
        ("jazzy", Symbol("header", "octomap_msgs/conversions.h", ("octomap_msgs",)), "unknown", "", ""),
        # A macro of the package writes its configuration since 0.2.15, so that no command is seen.
        ("noetic", Symbol("command", "target_cxx_version", ("ros_industrial_cmake_boilerplate",)), "unknown", "", ""),
        ("jazzy", Symbol("package", "nav2_recoveries"), "removed", "humble", "nav2_behaviors"),
        ("jazzy", Symbol("package", "rclcpp"), "present", "", ""),
        ("jazzy", Symbol("package", "no_such_package_at_all"), "unknown", "", ""),
        # CMake minds no case in names of commands: `macro(MOVEIT_PACKAGE)` defines moveit_package.
        ("jazzy", Symbol("command", "moveit_package", ("moveit_common",)), "present", "", ""),
        ("jazzy", Symbol("command", "MoveIt_Package", ("moveit_common",)), "present", "", ""),
        # A package of ROS 1 does not answer for one of ROS 2 of the same name and version.
        ("foxy", Symbol("executable", "ros2_control_node", CONTROL), "present", "", ""),
        ("noetic", Symbol("executable", "ros2_control_node", CONTROL), "unknown", "", ""),
        ("kinetic", Symbol("c++", "hardware_interface::RobotHW", ("hardware_interface",)), "present", "", ""),
        # Versions between two that were read say nothing where these differ.
        ("iron", Symbol("field", "srv/SwitchController.activate_controllers", ("controller_manager_msgs",)),
         "present", "", ""),
        ("foxy", Symbol("field", "srv/SwitchController.activate_controllers", ("controller_manager_msgs",)),
         "not yet", None, ""),
        # How a name is used is asked about too.
        ("jazzy", Symbol("c++", "rclcpp::Duration::Duration", ("rclcpp",), CppUseForm("call", 4)), "present", "", ""),
        ("foxy", Symbol("c++", "rclcpp::GenericPublisher", ("rclcpp",), CppUseForm("name")), "not yet", "9.0.0", ""),
        ("humble", Symbol("c++", "rclcpp::executor::Executor", ("rclcpp",), CppUseForm("name")), "removed", "9.0.0",
         None),
        # Components of libraries, by their versions.
        ("melodic", Symbol("component", "signals", ("Boost",)), "present", "", ""),
        ("noetic", Symbol("component", "signals", ("Boost",)), "removed", "", ""),
        ("noetic", Symbol("component", "any", ("NoSuchLibrary",)), "unknown", "", ""),
        # Of platform libraries, reviewed rows tell.
        ("noetic", Symbol("c++", "CV_LOAD_IMAGE_COLOR"), "removed", None, None),
        ("jazzy", Symbol("python", "no.such.name", ("rclpy",)), "unknown", "", ""),
    ],
)  # fmt: skip
def test_how_a_target_stands_to_a_symbol(distro, symbol, state, since, replacement):
    found = Availabilities(DistroTarget(distro)).find_availability(symbol)
    assert found.state == state
    assert since is None or state == "present" or found.since == since
    assert replacement is None or state == "present" or found.replacement == replacement


def test_a_use_that_an_update_refuses_is_upcoming_where_it_counts():
    symbol = Symbol("component", "system", ("Boost",))
    jazzy = Availabilities(DistroTarget("jazzy"))
    coming = jazzy.find_on_horizon(symbol)
    assert (coming.state, coming.library, coming.detail[:18]) == ("upcoming", True, "drop the component")
    assert jazzy.find_on_horizon(symbol, lambda horizon: False).state == "present"


def test_what_reviewed_rows_say_of_a_name_comes_with_what_is_to_come():
    melodic, noetic = (Availabilities(DistroTarget(name)) for name in ("melodic", "noetic"))
    assert [row.state for row in noetic.find_reviewed("c++", "CV_LOAD_IMAGE_COLOR")] == ["removed"]
    assert [row.state for row in melodic.find_reviewed("c++", "CV_LOAD_IMAGE_COLOR")] == ["upcoming"]
    lyrical = Availabilities(DistroTarget("lyrical"))
    # CMake minds no case in names of commands, and does in those of variables.
    states = {kind: [row.state for row in lyrical.find_reviewed(kind, "AMENT_TARGET_DEPENDENCIES")]
              for kind in ("command", "variable")}  # fmt: skip
    assert states == {"command": ["removed"], "variable": []}


def test_what_will_go_is_upcoming_on_the_nearest_horizon():
    field = Symbol("field", "srv/SwitchController.Request.start_asap", ("controller_manager_msgs",))
    there = Symbol("c++", "CV_LOAD_IMAGE_COLOR")
    melodic = Availabilities(DistroTarget("melodic")).find_on_horizon(there)
    assert (melodic.state, melodic.library) == ("upcoming", True)
    assert melodic.horizon is not None and (melodic.horizon.name, melodic.horizon.platform) == ("noetic", True)
    assert melodic.evidence is not None and melodic.evidence.ahead
    # What packages of the newest distro lack is no matter of an update.
    subscriber = Symbol("header", "message_filters/subscriber.h", ("message_filters",))
    assert Availabilities(DistroTarget("jazzy")).find_on_horizon(subscriber).state == "present"
    # But what warns already is left in time.
    assert Availabilities(DistroTarget("kilted")).find_on_horizon(subscriber).state == "upcoming"
    assert Availabilities(DistroTarget("humble")).find_on_horizon(Symbol("header", OLD, TF2)).state == "upcoming"
    command = Symbol("command", "ament_target_dependencies", ("ament_cmake_target_dependencies",))
    distros = (DistroTarget(name) for name in ("jazzy", "kilted", "lyrical"))
    ahead = [Availabilities(distro).find_on_horizon(command).state for distro in distros]
    assert ahead == ["present", "upcoming", "removed"]
    assert Availabilities(DistroTarget("noetic")).find_on_horizon(field).state == "unknown"


@pytest.mark.parametrize(
    ("target", "asked", "expected"),
    [
        (DistroTarget("noetic"), (), []),
        (DistroTarget("melodic"), (), [("noetic", True, True)]),  # which nobody maintains any longer
        (DistroTarget("melodic"), ("noetic",), []),
        (DistroTarget("indigo"), (), [("noetic", True, True)]),
    ],
)
def test_the_newest_distro_is_a_horizon_for_its_platform(target, asked, expected):
    found = [one for one in list_horizons(target, asked) if "next sync" not in one.name]
    assert [(one.name, one.platform, one.far) for one in found] == expected


def test_it_is_near_while_the_distro_is_maintained():
    *_, newest = list_horizons(DistroTarget("melodic", "2020-06-01"))
    assert (newest.name, newest.platform, newest.far) == ("noetic", True, False)


def test_a_date_has_a_next_sync_and_an_update():
    soon, later, newest = list_horizons(DistroTarget("iron", "2023-06-04"))
    assert (soon.name, soon.platform) == ("the next sync of iron", False)
    assert later.name.startswith("iron of 20") and not later.platform
    assert newest.platform


def test_what_the_next_sync_removes_is_asked_of_the_packages_that_wait_for_it():
    target = DistroTarget("rolling", "2023-04-05")
    (soon,) = (ahead for ahead in list_horizons(target) if "next sync" in ahead.name)
    (coming,) = Availabilities(target).find_reviewed("c++", "SHARED_PTR_DEFINITIONS")
    assert (coming.state, coming.horizon and coming.horizon.name) == ("upcoming", soon.name)
    # What is gone already does not go again.
    (gone,) = Availabilities(soon.target).find_reviewed("c++", "SHARED_PTR_DEFINITIONS")
    assert gone.state == "removed"
    assert soon.target.compute_identity() != target.compute_identity()


def test_no_row_denies_what_the_stored_version_has(monkeypatch):
    rows = {
        ("header", name): [ChangeRow(kind="header-removed", package="tf2", old=name, source="x", removed_in="lyrical")]
        for name in ("tf2/visibility_control.h", "tf2/time.h")
    }
    monkeypatch.setattr(availability, "index_rows", lambda: (rows, {}))
    lyrical = Availabilities(DistroTarget("lyrical"), ahead=())
    assert [one.state for one in lyrical.find_reviewed("header", "tf2/time.h")] == ["removed"]
    assert lyrical.find_reviewed("header", "tf2/visibility_control.h") == ()
