"""DistroTarget on the shipped data: facts that can be looked up in rosdistro's tags, one row each."""

import pickle

import pytest
from rosimpact.impact.targets.distro.distro import DistroTarget, TargetError
from rosimpact.impact.targets.distro.known import list_known_distros


def target(text, **more):
    distro, _, date = text.partition("@")
    return DistroTarget(distro, date or None, **more)


VERSIONS = [
    # target, package, version. Source: DISTRO/distribution.yaml at the sync tag in force on that day.
    ("humble@2024-03-01", "rclcpp", "16.0.8"),
    ("humble", "rclcpp", "16.0.19"),
    ("humble@2022-06-01", "cv_bridge", "3.0.3"),
    ("noetic", "roscpp", "1.17.4"),
    ("noetic", "rclcpp", None),
    ("jazzy", "roscpp", None),
    ("melodic@2019-01-01", "roscpp", "1.14.3"),
    ("indigo", "roscpp", "1.11.21"),
    ("groovy", "roscpp", "1.9.55"),
    ("hydro", "roscpp", "1.10.12"),
    ("ardent@2018-01-01", "rclcpp", "0.4.0"),
    ("humble", "no_such_package", None),
]


@pytest.mark.parametrize(("text", "package", "version"), VERSIONS)
def test_version(text, package, version):
    assert target(text).find_version(package) == version


COUNTS = [  # packages in the distribution file of the last sync or, without syncs, of the last commit
    ("noetic", 2175),
    ("indigo", 2779),
    ("groovy", 685),
    ("foxy", 1149),
    ("galactic", 1007),
]


@pytest.mark.parametrize(("text", "count"), COUNTS)
def test_released_names(text, count):
    assert len(target(text).list_released()) == count


def test_a_release_counts_from_the_sync_that_brought_it():
    day_before, day = DistroTarget("humble", "2026-08-06"), DistroTarget("humble", "2026-08-07")
    assert day_before.list_released() != day.list_released()
    assert not day_before.approximate
    assert not day.approximate


@pytest.mark.parametrize(
    ("text", "approximate"),
    [("melodic@2019-01-01", True), ("melodic@2021-01-01", False), ("indigo", True), ("humble@2022-05-01", True)],
)
def test_before_the_first_sync_the_commit_stands(text, approximate):
    assert target(text).approximate is approximate


@pytest.mark.parametrize(
    ("versions", "has", "waits"),
    [
        ([("maliput_viz", "0.1.0")], "1.1.0", True),
        ([("maliput_viz", "0.1.0"), ("own", "0.1.0")], "1.1.0", True),
        ([("maliput_viz", "0.2.0")], "1.0.7", False),
        ([("maliput_viz", "0.1.0"), ("rclcpp", "2.4.2")], "1.0.7", False),  # that one was synced
        ([], "1.0.7", False),
    ],
)
def test_a_release_that_waits_for_the_next_sync_has_what_it_is_built_against(versions, has, waits):
    synced = DistroTarget("foxy", "2023-03-12")
    found = synced.follow_release(versions)
    assert (found.find_version("maliput"), found is not synced, bool(found.notes)) == (has, waits, waits)
    travelled = pickle.loads(pickle.dumps(found))
    assert (travelled.find_version("maliput"), travelled.notes) == (has, found.notes)
    assert travelled.compute_identity() == found.compute_identity()


def test_a_release_that_waits_is_built_for_the_platform_that_its_distro_has_moved_to():
    synced = DistroTarget("rolling", "2026-05-20")
    assert synced.platform == "ubuntu noble"
    assert synced.follow_release([("robot_arm_demo", "0.1.0")]).platform == "ubuntu resolute"


def test_a_machine_with_versions_of_its_own_stays():
    robot = DistroTarget("foxy", "2023-03-12", versions={"opencv": "4.9"})
    assert robot.follow_release([("maliput_viz", "0.1.0")]) is robot


def test_a_date_before_the_first_release_is_moved_with_a_note():
    early = target("jazzy@2020-01-01")
    assert early.date == "2024-04-19"
    assert early.notes == ("jazzy had no release on 2020-01-01: moved to its first, 2024-04-19",)
    assert early.find_version("rclcpp")


def test_a_date_after_the_data_is_answered_with_a_note():
    late = target("jazzy@2199-01-01")
    assert late.find_version("rclcpp") == target("jazzy").find_version("rclcpp")
    assert "ends on" in late.notes[0]


@pytest.mark.parametrize("known", list_known_distros(), ids=lambda known: known.name)
def test_every_distro_answers(known):
    found = DistroTarget(known.name)
    assert found.list_released()
    assert found.platform
    assert found.find_library("cmake")
    assert found.resolve("boost")
    assert found.ros == known.ros


def test_distros_are_listed_by_age():
    names = [known.name for known in list_known_distros()]
    assert names.index("kinetic") < names.index("melodic") < names.index("noetic")
    assert [n for n in names if n in ("humble", "jazzy", "lyrical")] == ["humble", "jazzy", "lyrical"]
    assert len(names) == 21


@pytest.mark.parametrize("name", ["jazy", "", "Humble", "humble ", "x" * 1000, "'; DROP TABLE distro"])
def test_an_unknown_distro_lists_what_is_known(name):
    with pytest.raises(TargetError, match="groovy, hydro, indigo"):
        DistroTarget(name)


@pytest.mark.parametrize("date", ["yesterday", "2024-13-01", "01.03.2024", ""])
def test_a_malformed_date_is_named(date):
    with pytest.raises(TargetError, match="is no date"):
        DistroTarget("humble", date)


PLATFORMS = [
    ("rolling@2021-01-01", "ubuntu focal", 8),
    ("rolling@2023-01-01", "ubuntu jammy", 10),
    ("rolling@2025-01-01", "ubuntu noble", 12),
    ("rolling@2024-03-10", "ubuntu jammy", 10),  # four days after the move to noble, before the first sync there
    ("rolling@2024-06-01", "ubuntu noble", 12),
    ("noetic", "ubuntu focal", 8),
    ("melodic", "ubuntu bionic", 0),  # Python 2
    ("crystal", "ubuntu bionic", 6),
]


@pytest.mark.parametrize(("text", "platform", "python"), PLATFORMS)
def test_platform_and_python_follow_distro_and_day(text, platform, python):
    assert (target(text).platform, target(text).python) == (platform, python)


def test_a_platform_without_a_sync_is_noted():
    (note,) = target("rolling@2024-03-10").notes
    assert note == "rolling had moved to ubuntu noble, not yet synced there: answered as of its last on ubuntu jammy"
    assert target("rolling@2024-03-10", platform="ubuntu noble").notes == ()


@pytest.mark.parametrize(
    ("platform", "versions", "known"),
    [
        ("ubuntu noble", {}, None),
        ("conda-forge", {}, None),
        ("debian sid", {}, None),
        ("fedora", {}, "no library versions of fedora are known: what they lack is not reported"),
        ("fedora", {"opencv": "4.9"}, "no library versions of fedora are known besides those given for the target: "
                                      "what they lack is not reported"),
    ],
)  # fmt: skip
def test_platform_without_library_versions(platform, versions, known):
    asked = DistroTarget("jazzy", platform=platform, versions=versions)
    assert asked.notes == ((known,) if known else ())
    assert asked.knows_libraries is (known is None)


LIBRARIES = [
    ("humble", "opencv", "4.5.4"),
    ("jazzy", "opencv", "4.6.0"),
    ("indigo", "gazebo-classic", "2"),  # REP 3 gives each distro its own, on one platform
    ("jade", "gazebo-classic", "5"),
    ("indigo", "libavutil", "52.3.0"),
    ("kinetic", "opencv", "3.3.1"),  # from its own package opencv3, not Ubuntu's 2.4.9
    ("melodic", "boost", "1.65.1"),
    ("noetic", "python3", "3.8.2"),
    ("indigo", "cmake", "2.8.12"),
    ("jazzy", "no_such_library", None),
]


@pytest.mark.parametrize(("text", "library", "version"), LIBRARIES)
def test_library(text, library, version):
    assert target(text).find_library(library) == version


RESOLVED = [
    # target, platform, key, packages or None
    ("jazzy", None, "python3-transforms3d", ("python3-transforms3d",)),
    ("foxy", None, "python3-transforms3d", ("transforms3d",)),  # by pip on focal
    ("humble", None, "boost", ("libboost-all-dev",)),
    ("jazzy", "debian bookworm", "libopencv-dev", ("libopencv-dev",)),
    ("jazzy", "rhel 9", "boost", ("boost-devel", "boost-python%{python3_pkgversion}-devel")),
    ("kinetic", None, "python-numpy", ("python-numpy",)),  # dropped later, stood at kinetic's end
    ("jazzy", None, "python-numpy", None),
    ("jazzy", None, "no-such-key", None),
]


@pytest.mark.parametrize(("text", "platform", "key", "packages"), RESOLVED)
def test_resolve(text, platform, key, packages):
    found = target(text, platform=platform).resolve(key)
    assert (found and found.packages) == packages


def test_keys_of_a_debian_package():
    assert "libopencv-dev" in target("jazzy").find_keys("libopencv-dev")
    assert target("jazzy").find_keys("no-such-package") == ()


def names(found, kind):
    return {dependency.name for dependency in found if dependency.kind == kind}


def test_declared_dependencies_with_kinds():
    found = target("jazzy").list_dependencies("cv_bridge")
    assert {"rclcpp", "sensor_msgs", "libopencv-dev"} <= names(found, "build") & names(found, "exec")
    assert "ament_cmake_gtest" in names(found, "test")
    assert "ament_cmake_gtest" not in names(found, "exec")


def test_conditions_are_evaluated_for_the_target():
    assert "python3-rospkg" in names(target("noetic").list_dependencies("rosbag"), "exec")
    assert "python-rospkg" in names(target("melodic").list_dependencies("rosbag"), "exec")


CONDITIONS = [
    # on jazzy: what catkin_pkg's own evaluation says
    ("$ROS_VERSION == 2", True),
    ("$ROS_VERSION==1", False),
    ("$ROS_DISTRO != jazzy", False),
    ("$ROS_DISTRO >= humble", True),
    ("$ROS_PYTHON_VERSION == 3", True),
    ("$GZ_VERSION == ''", True),
    ('$GZ_VERSION != ""', False),
    ("$ROS_VERSION == 2 and $ROS_DISTRO == jazzy", True),
    ("$ROS_VERSION == 1 or ($ROS_DISTRO == humble or $ROS_DISTRO == jazzy)", True),
    ("$ROS_VERSION ==", False),
    ("nonsense", False),
    ("", False),
]


@pytest.mark.parametrize(("condition", "expected"), CONDITIONS)
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_manifest_conditions(condition, expected):
    assert target("jazzy").holds(condition) is expected


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
@pytest.mark.parametrize("text", ["'a'", "b", "c-d", '"x y"'])
@pytest.mark.parametrize("compare", ["==", "!=", "<", "<=", ">", ">="])
@pytest.mark.parametrize("value", ["", "a", "b", "c-d", "z"])
def test_single_comparisons_agree_with_catkin_pkg(text, compare, value):
    from catkin_pkg.condition import evaluate_condition
    from rosimpact.impact.conditions import Environment
    from rosimpact.impact.conditions.manifest import evaluate

    condition = f"${'ROS_DISTRO' if value else 'UNSET'} {compare} {text}"
    assert evaluate(condition, Environment(value)) == evaluate_condition(condition, {"ROS_DISTRO": value})


def test_version_bounds_are_kept():
    bounds = {d.name: d.bounds for d in target("noetic").list_dependencies("bondcpp")}
    assert bounds["cmake_modules"] == (("version_gte", "0.3.2"),)
    assert bounds["roscpp"] == ()


def test_unknown_manifests():
    assert target("jazzy").knows_manifests is True
    assert target("jazzy").list_dependencies("no_such_package") is None


def test_manifests_of_distros_without_a_cache():
    assert "rosconsole" in {d.name for d in target("kinetic").list_dependencies("roscpp")}
    assert "boost" in {
        d.name for d in target("hydro").list_dependencies("console_bridge")
    }  # bloom's release repository
    # pcl_ros passed the headers of PCL on from 1.1.8 on
    early, late = target("hydro@2014-01-10"), target("hydro@2014-06-01")
    assert (early.find_version("pcl_ros"), late.find_version("pcl_ros")) == ("1.1.7", "1.1.8")
    passed_on = [{d.name for d in t.list_dependencies("pcl_ros") if d.kind == "exec"} for t in (early, late)]
    assert ["libpcl-all-dev" in names for names in passed_on] == [False, True]


def test_what_a_package_may_bring_in_any_distro():
    jazzy = target("jazzy")
    assert jazzy.list_dependencies("orocos_kdl") is None
    assert "eigen" in jazzy.list_possible("orocos_kdl")
    assert jazzy.list_possible("no_such_package") == jazzy.list_possible("eigen") == frozenset()
    # what only builds it does not come along
    assert "message_generation" not in target("noetic").list_possible("std_msgs")


def test_what_the_next_known_manifest_brings_where_this_version_has_none():
    rolling = target("rolling@2022-12-12")
    assert "diagnostic_updater" not in {d.name for d in rolling.list_dependencies("controller_manager")}
    assert "diagnostic_updater" in rolling.list_later_dependencies("controller_manager")
    assert target("rolling").list_later_dependencies("controller_manager") == frozenset()  # its own is known
    assert rolling.list_later_dependencies("no_such_package") == rolling.list_later_dependencies("eigen") == frozenset()


def test_packages_of_the_other_ros():
    assert target("rolling").is_other_generation("eigen_conversions")
    assert not target("noetic").is_other_generation("eigen_conversions")
    assert not target("rolling").is_other_generation("no_such_package")


def test_every_build_type_of_a_package():
    assert target("groovy").list_build_types("orocos_kdl") == {"cmake"}
    assert target("noetic").list_build_types("roscpp") == {""}
    assert target("noetic").list_build_types("no_such_package") == frozenset()


def test_closure_follows_exports_and_ends_at_keys():
    found = target("jazzy").list_transitive("nav2_bringup", ("exec", "build_export"))
    assert {"nav2_controller", "rclcpp", "rcl", "tinyxml2_vendor"} <= found
    assert "nav2_bringup" not in found
    assert target("jazzy").list_transitive("no_such_package") == frozenset()


def test_dependencies_of_the_nearest_distro_that_knows_a_package():
    jazzy = target("jazzy")
    assert jazzy.list_dependencies("orocos_kdl") is None
    assert {d.name for d in jazzy.list_similar("orocos_kdl")} >= {"cmake", "eigen"}
    assert jazzy.list_similar("eigen") is None and jazzy.list_similar("no_such_package") is None


def test_history_and_since():
    jazzy = target("jazzy")
    steps = jazzy.list_releases("cv_bridge")
    assert steps[0] == (jazzy.find_first_day("cv_bridge"), "4.0.0")
    assert [day for day, _ in steps] == sorted(day for day, _ in steps)
    assert jazzy.list_releases("no_such_package") == ()
    assert jazzy.find_first_day("no_such_package") == ""


def test_repository_of_a_package():
    assert target("humble").find_repository("rclcpp") == ("rclcpp", "https://github.com/ros2/rclcpp.git", "humble")


def test_overrides_change_libraries_and_packages():
    robot = target("humble", versions={"opencv": "4.9", "rclcpp": "99.0.0", "own_package": "1.0", "nav2_core": ""})
    assert robot.find_library("opencv") == "4.9"
    assert robot.find_version("rclcpp") == "99.0.0"
    assert robot.find_version("own_package") == "1.0"
    assert "own_package" in robot.list_released()
    assert robot.find_version("nav2_core") is None
    assert "nav2_core" not in robot.list_released()
    assert robot.find_version("opencv") is None  # a library, not a package
    assert robot.list_dependencies("rclcpp")


def test_a_target_travels_between_processes():
    robot = target("humble@2024-03-01", versions={"opencv": "4.9"}, name="robot")
    copy = pickle.loads(pickle.dumps(robot))
    assert (copy.name, copy.date, copy.find_library("opencv")) == ("robot", "2024-03-01", "4.9")
    assert copy.list_released() == robot.list_released()


@pytest.mark.parametrize(
    ("name", "ended"), [("humble", "2027-05-31"), ("noetic", "2025-05-31"), ("melodic", "2023-06-27"), ("rolling", "")]
)
def test_end_of_life(name, ended):
    assert target(name).end_of_life == ended


def test_ever_released():
    assert target("jazzy").was_ever_released("roscpp")
    assert not target("jazzy").was_ever_released("no_such_package")


@pytest.mark.parametrize(
    ("text", "distro"),
    [
        ("foxy", "lyrical"),
        ("rolling@2022-02-21", "lyrical"),  # a rolling of that day is older than the newest long-term distro
        ("rolling", None),
        ("lyrical", None),
        ("melodic", "noetic"),
        ("noetic", None),
    ],
)
def test_the_newest_long_term_distro(text, distro):
    newest = target(text).find_newest()
    assert (newest.distro if newest is not None else None) == distro


@pytest.mark.parametrize(
    ("text", "package", "here", "near"),
    [
        ("melodic", "orocos_kdl", "cmake", "cmake"),
        ("hydro", "libg2o", "", "cmake"),  # its manifest in hydro is not known
        ("noetic", "fcl", "cmake", "cmake"),
        ("noetic", "no_such_package", "", ""),
    ],
)
def test_build_type(text, package, here, near):
    machine = target(text)
    assert (machine.build_type(package), machine.find_similar_build_type(package)) == (here, near)


@pytest.mark.parametrize(
    ("platform", "expected"),
    [(None, True), ("fedora 41", True), ("debian sid", True), ("conda-forge", False), ("macos", False)],
)
def test_rosdep_says_nothing_of_systems_that_it_does_not_know(platform, expected):
    assert DistroTarget("jazzy", platform=platform).has_rosdep_rules() is expected


@pytest.mark.parametrize(
    ("text", "platform", "library", "version"),
    [("humble@2026-03-06", "robostack", "asio", "1.36.0"), ("jazzy@2026-06-19", "robostack", "boost", "1.90.0"),
     ("humble@2024-10-01", "conda-forge", "boost", "1.84.0"), ("humble@2022-10-01", "conda-forge", "boost", "1.74.0"),
     ("jazzy@2026-02-01", "robostack", "fmt", "12.1.0"), ("jazzy@2025-08-01", "robostack", "cmake", "3.31.6"),
     ("jazzy@2025-08-01", "conda", "cmake", "4.0.3"), ("humble@2025-08-01", "conda-forge", "python", None),
     ("jazzy@2025-08-01", "conda-forge", "no-such-library", None),
     ("rolling@2025-06-01", "debian sid", "boost", "1.83.0"), ("rolling@2025-06-01", "debian sid", "cmake", "3.31.6"),
     ("rolling@2026-08-01", "debian sid", "python", "3.14.6")],
)  # fmt: skip
def test_conda_forge_robostack_and_debian_unstable_have_versions_by_day(text, platform, library, version):
    distro, day = text.split("@")
    assert DistroTarget(distro, day, platform).find_library(library) == version


@pytest.mark.parametrize(
    ("distro", "key", "first"),
    [("jazzy", "python-numpy", "python3-numpy"), ("noetic", "python-catkin-pkg", "python3-catkin-pkg"),
     ("jazzy", "gazebo", ""), ("jazzy", "no-such-key", "")],
)  # fmt: skip
def test_keys_that_install_the_same_instead(distro, key, first):
    assert next(iter(target(distro).find_replacement_keys(key)), "") == first
