"""What only the newest distro's libraries refuse: a warning where that distro is near, a note where it is far."""

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

FILES = rule_cases.read_changed_files("api/changed_signature")


@pytest.mark.parametrize(
    ("target", "expected"),
    [
        ("melodic@2020-06-01", {"warning"}),
        ("lunar@2019-01-01", {"warning"}),
        ("melodic", {"note"}),  # which gets no update any longer
        ("jade", {"note"}),
        ("noetic", {"error"}),
    ],
)
def test_floating_point_durations_of_boost(target, expected, tmp_path):
    report = rule_cases.check_files(FILES, Options(targets=(target,), cache=tmp_path))
    told = {f.severity for f in report.findings if f.subject.startswith("boost::posix_time::milliseconds")}
    assert told == expected


def test_nothing_is_coming_where_the_newest_distro_is_asked_for_itself(tmp_path):
    def told(*targets):
        report = rule_cases.check_files(FILES, Options(targets=targets, cache=tmp_path))
        return {(f.severity, f.targets) for f in report.findings if f.subject.startswith("boost::posix_time::millis")}

    melodic = "melodic@2020-06-01"
    assert told(melodic) == {("warning", (melodic,))}
    assert told(melodic, "noetic") == {("error", ("noetic",))}
    assert told(melodic) == {("warning", (melodic,))}  # and what was said of two targets is not remembered for one


@pytest.mark.parametrize(
    ("target", "expected"),
    [
        ("iron@2023-06-01", {"warning"}),  # some update will take it away
        ("iron@2023-06-04", {"warning"}),  # released on the day before, in the sync of the 16th
        ("iron@2023-06-20", {"error"}),
    ],
)
def test_a_field_that_goes_with_the_next_sync(target, expected, tmp_path):
    (tmp_path / "package.xml").write_text(
        '<package format="3"><name>sled</name><version>1.0.0</version><description>sled</description>'
        '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
        "<depend>control_msgs</depend><export><build_type>ament_cmake</build_type></export></package>"
    )
    (tmp_path / "CMakeLists.txt").write_text("project(sled)\nadd_library(sled sled.cpp)\nament_package()\n")
    (tmp_path / "sled.cpp").write_text(
        "#include <control_msgs/msg/joint_trajectory_controller_state.hpp>\n"
        "void drive(control_msgs::msg::JointTrajectoryControllerState & state) { state.actual.positions.clear(); }\n"
    )
    found = check(tmp_path, Options(targets=(target,), select=("unknown-field",), cache=tmp_path / "cache", jobs=1))
    assert {f.severity for f in found.findings} == expected


@pytest.mark.parametrize(
    ("target", "expected"), [("melodic@2020-06-01", ["note", "warning"]), ("noetic", ["error", "error"])]
)
def test_a_component_that_goes_with_the_newest_distro_is_one_warning_for_the_workspace(target, expected, tmp_path):
    alarm = rule_cases.read_changed_files("packages/library_component")
    again = {path.replace("alarm/", "bell/", 1): text.replace("alarm", "bell") for path, text in alarm.items()}
    report = rule_cases.check_files(alarm | again, Options(targets=(target,), cache=tmp_path / "cache"))
    assert sorted(f.severity for f in report.findings if f.rule == "library-component") == expected
