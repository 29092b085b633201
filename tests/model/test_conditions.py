"""Conditions as written in files, against machines: true, false, or unknown."""

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.conditions import Environment, evaluate_all, holds
from rosimpact.impact.facts.condition import Condition

VERSIONS = {
    "rclcpp": "16.0.11",
    "roscpp": "1.16.0",
    "tf2_geometry_msgs": "0.25.8",
    "opencv": "4.5.4+dfsg",
    "boost": "1.74.0",
    "libavcodec": "58.134.100",
    "pcl": "1.12.1",
    "eigen3": "3.4.0",
    "qt": "5.15.3",
    "gcc": "11.2",
    "cmake": "3.22.1",
    "ogre-ros": "1.12.1",
    "fcl": "0.7",
    "gazebo-classic": "11.10",
    "orocos-kdl": "1.5.1",
    "ompl": "1.5.2",
    "vtk": "9",
}
HEADERS = {"tf2/utils.hpp": False, "vector": True, "cv_bridge/cv_bridge.hpp": None}
HUMBLE = Environment(
    ros_distro="humble",
    ros_version="2",
    python=(3, 10),
    codename="jammy",
    versions=VERSIONS.get,
    headers=HEADERS.get,
    testing=True,
)
MELODIC = Environment(ros_distro="melodic", ros_version="1", python=(2, 7), codename="bionic")
UNKNOWN = Environment()

CPP = [
    ("1", True),
    ("0", False),
    ("", None),
    ("defined(SOME_OPTION)", None),
    ("SOME_OPTION", None),
    ("SOME_OPTION && 0", False),
    ("SOME_OPTION || 1", True),
    ("!SOME_OPTION", None),
    ("defined(__linux__)", True),
    ("defined __linux__ and not defined(_WIN32)", True),
    ("defined(_WIN32) || defined(__APPLE__)", False),
    ("_MSC_VER >= 1900", False),
    ("defined(__cplusplus)", True),
    ("__cplusplus >= 201703L", None),
    ("__GNUC__ >= 7", True),
    ("__GNUC__ > 11 || (__GNUC__ == 11 && __GNUC_MINOR__ >= 3)", False),
    ("CV_MAJOR_VERSION >= 4", True),
    ("CV_VERSION_MAJOR == 3", False),
    ("(CV_MAJOR_VERSION >= 4) || (CV_MAJOR_VERSION >= 3 && CV_MINOR_VERSION >= 3)", True),
    ("defined(CV_VERSION_EPOCH)", False),
    ("RCLCPP_VERSION_GTE(28,0,0)", False),
    ("RCLCPP_VERSION_GTE(16, 0, 0)", True),
    ("RCLCPP_VERSION_MAJOR >= 17", False),
    ("ROS_VERSION_MINIMUM(1,14,0)", True),
    ("ROS_VERSION_MINIMUM(1, 17, 0)", False),
    ("PCL_VERSION_COMPARE(>=,1,12,0)", True),
    ("PCL_VERSION_COMPARE (<, 1, 9, 0)", False),
    ("PCL_VERSION >= PCL_VERSION_CALC(1,10,0)", True),
    ("PCL_VERSION < PCL_VERSION_CALC(1, 12, 0)", False),
    ("PCL_MAJOR_VERSION >= 1 && PCL_MINOR_VERSION >= 12", True),
    ("BOOST_VERSION >= 106700", True),
    ("BOOST_VERSION < 106000", False),
    ("BOOST_VERSION / 100 % 1000 >= 65", True),
    ("EIGEN_VERSION_AT_LEAST(3,3,90)", True),
    ("EIGEN_VERSION_AT_LEAST(3,4,1)", False),
    ("EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4", True),
    ("QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)", False),
    ("QT_VERSION >= 0x050000", True),
    ("MOVEIT_FCL_VERSION >= FCL_VERSION_CHECK(0, 6, 0)", True),
    ("GAZEBO_MAJOR_VERSION >= 8", True),
    ("GAZEBO_MAJOR_VERSION == 11 && GAZEBO_MINOR_VERSION > 12", False),
    ("KDL_VERSION_LESS(1, 4, 1)", False),
    ("OMPL_VERSION_VALUE >= 2000000", False),
    ("VTK_MAJOR_VERSION > 8", True),
    ("LIBAVCODEC_VERSION_INT < AV_VERSION_INT(55, 28, 1)", False),
    ("LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(58, 134, 100)", True),
    ("LIBAVCODEC_VERSION_MAJOR == 58", True),
    ("VTK_MINOR_VERSION >= 1", None),
    ("PY_MAJOR_VERSION >= 3", True),
    ("AMENT_INDEX_CPP_VERSION_GTE(1, 14, 0)", None),
    ("__has_include(<tf2/utils.hpp>)", False),
    ('__has_include("vector")', True),
    ("__has_include(<cv_bridge/cv_bridge.hpp>)", None),
    ("!__has_include(<tf2/utils.hpp>) || FOO", True),
    ("1 ? 0 : 1", False),
    ("FOO ? 1 : 1", True),
    ("(1 << 16 | 9 << 8) == 67840", True),
    ("1 << 9999999999", None),
    ("1 / 0", None),
    ("010 == 8", True),
    ("1 +", None),
    ("((1)", None),
    ("<too many conditions>", None),
]

CMAKE = [
    ('$ENV{ROS_DISTRO} STREQUAL "humble"', True),
    ('"$ENV{ROS_DISTRO}" STREQUAL "jazzy"', False),
    ("ROS_DISTRO STREQUAL humble", True),
    ('NOT "${ROS_DISTRO}" STREQUAL "humble"', False),
    ("${ROS_DISTRO} STREQUAL foxy OR ${ROS_DISTRO} STREQUAL humble", True),
    ('"${ROS_DISTRO}" MATCHES "^(foxy|galactic|humble)$"', True),
    ('"$ENV{ROS_DISTRO}" STRLESS "jazzy"', True),
    ('"$ENV{ROS_DISTRO}" STRGREATER "indigo"', False),
    ("$ENV{ROS_VERSION} EQUAL 1", False),
    ("$ENV{ROS_VERSION} EQUAL 2 AND NOT WIN32", True),
    ("DEFINED ENV{ROS_DISTRO}", True),
    ("DEFINED MY_OPTION", None),
    ("rclcpp_VERSION VERSION_GREATER_EQUAL 28", False),
    ("${rclcpp_VERSION} VERSION_GREATER_EQUAL 16.0", True),
    ('tf2_geometry_msgs_VERSION VERSION_LESS "0.26"', True),
    ("unknown_package_VERSION VERSION_LESS 2", None),
    ("OpenCV_VERSION VERSION_LESS 4", False),
    ("OpenCV_VERSION_MAJOR EQUAL 4", True),
    ("Boost_VERSION LESS 106700", False),
    ('Boost_VERSION_STRING VERSION_LESS "1.80"', True),
    ("CMAKE_VERSION VERSION_GREATER_EQUAL 3.27", False),
    ("Python_VERSION VERSION_GREATER_EQUAL 3.12.0", False),
    ("BUILD_TESTING", True),
    ("BUILD_TESTING AND UNKNOWN_OPTION", None),
    ("CATKIN_ENABLE_TESTING OR NOT BUILD_TESTING", False),
    ("NOT BUILD_TESTING AND UNKNOWN_OPTION", False),
    ("( BUILD_TESTING OR UNKNOWN_OPTION ) AND UNIX", True),
    ("NOT ( WIN32 OR APPLE )", True),
    ("catkin_FOUND", False),
    ("ament_cmake_FOUND", True),
    ("OpenCV_FOUND", None),
    ("TARGET foo::foo", None),
    ("EXISTS /etc/foo", None),
    ('EXISTS "/opt/ros/humble/setup.sh"', True),
    ("NOT EXISTS /opt/ros/$ENV{ROS_DISTRO}", False),
    ("EXISTS /opt/ros/foxy OR EXISTS /opt/ros/galactic/", False),
    ("IS_DIRECTORY /opt/ros/humble/share/winch", None),
    ("MY_VAR STREQUAL foo", None),
    ("ON", True),
    ("0", False),
    ("X-NOTFOUND", False),
    ('"${MY_VAR}" STREQUAL ""', None),
    ('CMAKE_CXX_COMPILER_ID MATCHES "Clang"', False),
    ("CMAKE_SYSTEM_NAME STREQUAL Linux", True),
    ('ROS_DISTRO MATCHES "["', None),
    ("( BUILD_TESTING", None),
    ("", None),
]

PYTHON = [
    ("try", None),
    ("TYPE_CHECKING", False),
    ("sys.version_info[0] == 2", False),
    ("sys.version_info[0] < 3", False),
    ("sys.version_info.major >= 3", True),
    ("sys.version_info >= (3, 8)", True),
    ("sys.version_info < (3,)", False),
    ("sys.version_info[:2] == (3, 10)", True),
    ("sys.version_info == (3, 10)", False),
    ("sys.version_info > (3, 10)", True),
    ("sys.version_info >= (3, 10, 4)", None),
    ("(3, 8) <= sys.version_info < (3, 11)", True),
    ("sys.version_info >= (3, 12) or unknown()", None),
    ("sys.version_info >= (3, 8) or unknown()", True),
    ("PY3", True),
    ("six.PY2", False),
    ("sys.version[0] == '3'", True),
    ("int(sys.version[0]) < 3", False),
    ("sys.hexversion > 0x03000000", True),
    ("sys.version.startswith('2')", False),
    ("sys.platform == 'win32'", False),
    ("sys.platform.startswith('linux')", True),
    ("os.environ['ROS_DISTRO'] == 'humble'", True),
    ("os.environ.get('ROS_DISTRO', '') in ('foxy', 'galactic')", False),
    ("os.getenv('ROS_VERSION') == '2'", True),
    ("int(os.environ['ROS_VERSION']) == 1", False),
    ("self.debug", None),
    ("x ==", None),
    ("'a'.lower(", None),
    ("'a'.startswith()", None),
    ("sys.version_info[9]", None),
    ("1 < 'a'", None),
]

MANIFEST = [
    ("", True),
    ("$ROS_VERSION == 2", True),
    ("$ROS_VERSION == 1", False),
    ("$ROS_VERSION==2", True),
    ("$ROS_VERSION == 2 and $ROS_DISTRO != foxy", True),
    ("$ROS_DISTRO >= jazzy", False),
    ("$ROS_DISTRO == foxy or $ROS_DISTRO == humble", True),
    ("($ROS_DISTRO == foxy or $ROS_DISTRO == humble) and $ROS_VERSION == 1", False),
    ("$ROS_VERSION == 2 or $ROS_VERSION == 1 and $ROS_DISTRO == foxy", True),
    ("'$ROS_VERSION' == 2", False),
    ("$ROS_PYTHON_VERSION == 3", True),
    ("$NEVER_SET != 1", True),
    ("$ROS_VERSION", None),
    ("$ROS_VERSION = 2", None),
    ("((", None),
]

TABLE = [
    (language, text, expected)
    for language, rows in (("cpp", CPP), ("cmake", CMAKE), ("python", PYTHON), ("manifest", MANIFEST))
    for text, expected in rows
]


@pytest.mark.parametrize(("language", "text", "expected"), TABLE)
def test_on_humble(language, text, expected):
    assert holds(Condition(language, text), HUMBLE) is expected
    opposite = None if expected is None else not expected
    assert holds(Condition(language, text, True), HUMBLE) is opposite


@pytest.mark.parametrize(
    ("language", "text", "expected"),
    [
        ("cmake", "catkin_FOUND", True),
        ("cmake", "rclcpp_FOUND", False),
        ("cmake", "$ENV{ROS_DISTRO} STREQUAL melodic", True),
        ("cmake", "BUILD_TESTING", None),
        ("python", "sys.version_info[0] == 2", True),
        ("python", "sys.version_info >= (3, 0)", False),
        ("manifest", "$ROS_PYTHON_VERSION == 2", True),
        ("cpp", "CV_MAJOR_VERSION >= 4", None),
        ("cpp", "PY_MAJOR_VERSION < 3", True),
    ],
)
def test_on_melodic(language, text, expected):
    assert holds(Condition(language, text), MELODIC) is expected


INSTALLED = {"rclcpp": True, "arm_msgs": True, "gripper_msgs": False}
WITH_PACKAGES = Environment(ros_version="2", versions=VERSIONS.get, packages=INSTALLED.get)


@pytest.mark.parametrize(
    ("text", "declared", "expected"),
    [
        ("arm_msgs_FOUND", ("arm_msgs",), True),
        ("arm_msgs_FOUND", (), None),  # it may be installed, or not
        ("gripper_msgs_FOUND", ("gripper_msgs",), None),  # it may be built from its sources
        ("NOT arm_msgs_FOUND", ("arm_msgs",), False),
        ("arm_msgs_FOUND AND CUDA_FOUND", ("arm_msgs",), None),
        ("arm_msgs_FOUND OR CUDA_FOUND", ("arm_msgs",), True),
        ("catkin_FOUND", ("catkin",), False),
    ],
)
def test_what_a_package_declares_is_found_where_it_is_there(text, declared, expected):
    assert holds(Condition("cmake", text, declared=declared), WITH_PACKAGES) is expected


@pytest.mark.parametrize(
    ("text", "declared", "expected"),
    [
        ("old_FOUND", (), False),
        ("NOT old_FOUND", (), True),
        ("old_FOUND", ("old",), None),  # it may be built from its sources
        ("other_FOUND", (), None),
        ("COMMAND old_macro", (), False),
        ("NOT COMMAND old_macro", (), True),
        ("COMMAND other_macro", (), None),
    ],
)
def test_what_is_gone_is_not_found(text, declared, expected):
    gone = {("package", "old"), ("command", "old_macro")}
    environment = Environment(ros_version="2", gone=lambda kind, name: (kind, name) in gone)
    assert holds(Condition("cmake", text, declared=declared), environment) is expected


@pytest.mark.parametrize(
    ("text", "negated", "expected"),
    [
        ("NOT CUDA_FOUND", True, True),
        ("CUDA_FOUND", False, True),
        ("NOT CUDA_FOUND OR NOT arm_msgs_FOUND", True, True),
        ("NOT gripper_msgs_FOUND", True, None),  # without it nothing is built here, so that nothing breaks
        ("NOT catkin_FOUND", True, False),
        ("NOT rclcpp_FOUND", True, True),
    ],
)
def test_what_stands_behind_a_gate_holds_wherever_the_package_is_built(text, negated, expected):
    gate = Condition("cmake", text, negated, gate=True)
    assert holds(gate, WITH_PACKAGES) is expected
    assert holds(msgspec.structs.replace(gate, gate=False), WITH_PACKAGES) is (None if "CUDA" in text else expected)


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("cmake", "$ENV{ROS_DISTRO} STREQUAL melodic"),
        ("cmake", "catkin_FOUND"),
        ("python", "sys.version_info >= (3, 0)"),
        ("manifest", "$ROS_VERSION == 2"),
        ("cpp", "__has_include(<vector>)"),
        ("launch", "$(var x)"),
    ],
)
def test_nothing_is_told_of_an_unknown_machine(language, text):
    assert holds(Condition(language, text), UNKNOWN) is None


def test_all_hold_is_false_as_soon_as_one_is():
    yes, no, open_ = Condition("cpp", "1"), Condition("cpp", "0"), Condition("cpp", "FOO")
    assert evaluate_all((), HUMBLE) is True
    assert evaluate_all((yes, yes), HUMBLE) is True
    assert evaluate_all((yes, open_), HUMBLE) is None
    assert evaluate_all((open_, no, yes), HUMBLE) is False


SPELT = """( ) < > ! & | " ' $ , [ ] { } : . = + - * / % ? ~ && || AND OR NOT defined __has_include(<a>) STREQUAL
MATCHES ${ $ENV{ROS_DISTRO} VERSION_LESS 1.2 999999999999999999999999 << sys.version_info and not (3, == >= int(
RCLCPP_VERSION_GTE PCL_VERSION_COMPARE( rclcpp_VERSION DEFINED $ROS_VERSION 'a'.startswith("""
PIECES = st.sampled_from(SPELT.split())


@given(
    st.sampled_from(["cmake", "cpp", "python", "manifest", "launch", ""]), st.lists(PIECES, max_size=12).map(" ".join)
)
def test_never_raises_on_pieces(language, text):
    assert holds(Condition(language, text), HUMBLE) in (True, False, None)


@given(st.sampled_from(["cmake", "cpp", "python", "manifest"]), st.text())
def test_never_raises_on_any_text(language, text):
    assert holds(Condition(language, text), HUMBLE) in (True, False, None)


@pytest.mark.parametrize("language", ["cmake", "cpp", "python", "manifest"])
@pytest.mark.parametrize(
    "text", ["(" * 50000, "!" * 50000 + "1", "NOT " * 50000, "not " * 50000 + "x", "-" * 9999 + "1"]
)
def test_deep_nesting_is_unknown(language, text):
    assert holds(Condition(language, text), HUMBLE) is None
