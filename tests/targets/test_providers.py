"""Who provides what: lookups in the shipped table, and the pieces that it is built with."""

import sqlite3

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.databuild.providers import SCHEMA, include_paths, list_cmake, list_modules
from rosimpact.databuild.surface.releases import find_tag, normalize_url
from rosimpact.impact.targets.providers.providers import Providers, add_facts, load_providers
from rosimpact.impact.targets.providers.stdlib import is_in_stdlib, was_ever_in_stdlib
from rosimpact.impact.targets.snapshot import SnapshotError


@pytest.fixture(scope="module")
def providers():
    return load_providers()


@pytest.mark.parametrize(
    ("path", "first"),
    [
        ("opencv2/core.hpp", "libopencv-dev"),
        ("Eigen/Core", "eigen"),
        ("eigen3/Eigen/Core", "eigen"),
        ("boost/thread.hpp", "boost"),
        ("pcl/point_types.h", "libpcl-all-dev"),
        ("yaml-cpp/yaml.h", "yaml-cpp"),
        ("tinyxml2.h", "tinyxml2"),
        ("QtWidgets/QWidget", "qtbase5-dev"),
        ("Python.h", "python3"),
        ("ros/ros.h", "roscpp"),
        ("ros/time.h", "rostime"),
        ("ros/console.h", "rosconsole"),
        ("rosbag/bag.h", "rosbag_storage"),
        ("moveit/planning_scene/planning_scene.h", "moveit_core"),
        ("moveit/move_group_interface/move_group_interface.h", "moveit_ros_planning_interface"),
        ("ecl/geometry.hpp", "ecl_geometry"),
        ("fmt/format.h", "fmt"),  # plotjuggler carries a copy
        ("vector", ""),
        ("sys/socket.h", ""),
        ("linux/can.h", ""),
        ("omp.h", ""),
    ],
)
def test_header_is_provided_by(providers, path, first):
    assert providers.find_header(path)[0].name == first


@pytest.mark.parametrize("path", ["config.h", "utils.h", "no/such/header.hpp", ""])
def test_header_that_says_nothing_about_its_owner(providers, path):
    assert providers.find_header(path) == ()


def test_header_of_a_reviewed_folder_is_not_sure(providers):
    (found,) = providers.find_header("gz/math/Some_new_header.hh")
    assert (found.kind, found.name, found.sure) == ("ros", "gz_math_vendor", False)


@pytest.mark.parametrize(
    ("package", "distro", "version", "there"),
    [
        ("angles", "jazzy", "1.16.0", True),
        ("ament_cmake_core", "jazzy", "2.5.0", False),  # a release without a header in its tree
        ("angles", "jazzy", "0.0.1", None),  # no such release
        ("no_such_package", "jazzy", "1.0.0", None),
    ],
)
def test_whether_a_release_has_headers_at_all(providers, package, distro, version, there):
    assert providers.has_headers(package, distro, version) is there


@pytest.mark.parametrize(
    ("name", "first", "sure"),
    [
        ("Boost", "boost", True),
        ("OpenCV", "libopencv-dev", True),
        ("PCL", "libpcl-all-dev", True),
        ("Eigen3", "eigen", True),
        ("Eigen", "cmake_modules", True),
        ("SDL2", "sdl2", True),  # sdl2-config.cmake answers any letter case
        ("opencv", "libopencv-dev", False),
        ("Threads", "", True),
        ("BehaviorTree", "behaviortree_cpp", True),
    ],
)
def test_cmake_name_is_provided_by(providers, name, first, sure):
    found = providers.find_cmake(name)[0]
    assert (found.name, found.sure) == (first, sure)


@pytest.mark.parametrize(
    ("module", "names"),
    [
        ("yaml", ["python3-yaml", "python-yaml"]),
        ("cv2", ["python3-opencv", "python-opencv"]),
        ("PIL.Image", ["python3-pil"]),
        ("serial", ["python3-serial", "python-serial"]),
        ("rospkg", ["python3-rospkg"]),
        ("google.protobuf.text_format", ["python3-protobuf"]),
    ],
)
def test_module_is_provided_by(providers, module, names):
    found = [provider.name for provider in providers.find_module(module)]
    assert set(names) <= set(found[: len(names) + 1])


@pytest.mark.parametrize(("name", "first"), [("xterm", "xterm"), ("bash", ""), ("make", ""), ("ros2", "ros2cli")])
def test_executable_is_provided_by(providers, name, first):
    assert providers.find_executable(name)[0].name == first


def test_pkgconfig_is_provided_by(providers):
    assert providers.find_pkgconfig("libusb-1.0")[0].name == "libusb-1.0-dev"


@pytest.mark.parametrize(
    ("header", "platform", "has"),
    [
        ("opencv/cv.h", "ubuntu bionic", True),
        ("opencv/cv.h", "ubuntu focal", False),
        ("boost/signals.hpp", "ubuntu bionic", True),
        ("boost/signals.hpp", "ubuntu focal", False),
        ("vector", "ubuntu focal", None),
        ("no/such/header.hpp", "ubuntu focal", None),
        ("opencv/cv.h", "fedora 40", None),
    ],
)
def test_system_header_on_a_platform(providers, header, platform, has):
    assert providers.has_system_header(header, platform) is has


@pytest.mark.parametrize(
    ("package", "header", "distro", "version", "has"),
    [
        ("tf2_geometry_msgs", "tf2_geometry_msgs/tf2_geometry_msgs.hpp", "humble", "0.25.0", True),
        ("tf2_geometry_msgs", "tf2_geometry_msgs/tf2_geometry_msgs.hpp", "foxy", "0.13.0", False),
        ("xmlrpcpp", "xmlrpcpp/XmlRpcException.h", "indigo", "1.11.21", False),
        ("xmlrpcpp", "xmlrpcpp/XmlRpcException.h", "kinetic", "1.12.7", True),
        ("xmlrpcpp", "XmlRpcException.h", "noetic", "1.15.0", True),  # its CMake extras keep the old names
        ("rviz", "rviz/display.h", "noetic", "1.14.0", True),  # installed from src/
        ("roscpp", "ros/ros.h", "noetic", "99.0.0", None),
        ("no_such_package", "a/b.h", "noetic", "1.0.0", None),
    ],
)
def test_header_history(providers, package, header, distro, version, has):
    assert providers.has_header(package, header, distro, version) is has


def test_every_reviewed_fact_names_something(providers):
    for kind, name, entries in providers.fetch("SELECT kind, name, entries FROM fact"):
        assert kind in ("cmake", "pkgconfig", "module", "program", "header", "vendor", "folder"), name
        assert all(entry == entry.strip() for entry in entries.split("\n")), name


@given(st.text(max_size=40))
def test_any_text_is_answered(text):
    table = load_providers()
    for lookup in (table.find_header, table.find_cmake, table.find_module, table.find_executable, table.find_pkgconfig):
        assert all(provider.kind in ("ros", "system") for provider in lookup(text))


def test_damaged_table_is_named(tmp_path):
    (tmp_path / "providers.json").write_text('{"sha256": "0"}')
    (tmp_path / "providers.yaml").write_text("cmake: {}\n")
    (tmp_path / "providers.sqlite.zst").write_bytes(b"no database")
    with pytest.raises(SnapshotError, match="install rosimpact again"):
        Providers(tmp_path, tmp_path / "cache").find_header("a.h")


def test_no_place_for_a_cache(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert Providers(cache=blocked / "below").find_header("ros/ros.h")[0].name == "roscpp"


def test_truncated_cache_is_unpacked_again(tmp_path):
    Providers(cache=tmp_path).find_header("a.h")
    (file,) = tmp_path.glob("providers-*.sqlite")
    file.write_bytes(file.read_bytes()[:5000])
    assert Providers(cache=tmp_path).find_header("ros/ros.h")[0].name == "roscpp"


def test_facts_are_read_in_their_order():
    connection = sqlite3.connect(":memory:")
    connection.executescript(SCHEMA)
    add_facts(connection, b'cmake: {Foo: [foo libfoo-dev, "ros:foo_vendor"], Bar: ""}')
    rows = dict(connection.execute("SELECT name, entries FROM fact"))
    assert rows == {"Foo": "foo libfoo-dev\nros:foo_vendor", "Bar": ""}


# Building


@pytest.mark.parametrize(
    ("path", "names"),
    [
        ("usr/include/tinyxml2.h", ("tinyxml2.h",)),
        ("usr/include/eigen3/Eigen/Core", ("eigen3/Eigen/Core", "Eigen/Core")),
        ("usr/include/opencv4/opencv2/core.hpp", ("opencv4/opencv2/core.hpp", "opencv2/core.hpp")),
        ("usr/include/x86_64-linux-gnu/qt5/QtCore/QString", ("qt5/QtCore/QString", "QtCore/QString", "QString")),
        ("usr/include/x86_64-linux-gnu/curl/curl.h", ("curl/curl.h",)),
        ("usr/include/ignition/math6/ignition/math.hh", ("ignition/math6/ignition/math.hh", "ignition/math.hh")),
        ("usr/include/boost/thread.hpp", ("boost/thread.hpp",)),
        ("usr/include/c++/12/vector", ("vector",)),
        ("usr/lib/gcc/x86_64-linux-gnu/12/include/omp.h", ("omp.h",)),
        ("usr/lib/x86_64-linux-gnu/glib-2.0/include/glibconfig.h", ("glibconfig.h",)),
        ("usr/include/vtk-9.1/vtkdiy2/thread.hpp", ("vtk-9.1/vtkdiy2/thread.hpp", "vtkdiy2/thread.hpp")),
        ("usr/lib/python3/dist-packages/yaml/__init__.py", ()),
        ("usr/include/foo/FooConfig.cmake", ()),
    ],
)
def test_include_paths(path, names):
    assert include_paths(path) == names


@pytest.mark.parametrize(
    ("path", "names"),
    [
        ("usr/share/pcl-1.12/PCLConfig.cmake", ("PCL",)),
        ("usr/lib/cmake/SDL2/sdl2-config.cmake", ("sdl2", "sdl2-config")),
        ("usr/lib/cmake/SDL2/SDL2Targets.cmake", ()),
    ],
)
def test_cmake_names(path, names):
    assert list_cmake(path) == names


@pytest.mark.parametrize(
    ("path", "names"),
    [
        ("usr/lib/python3/dist-packages/yaml/__init__.py", ("yaml",)),
        ("usr/lib/python3/dist-packages/six.py", ("six",)),
        ("usr/lib/python3/dist-packages/cv2.cpython-310-x86_64-linux-gnu.so", ("cv2",)),
        ("usr/lib/python2.7/dist-packages/ruamel/yaml/main.py", ("ruamel", "ruamel.yaml")),
        ("usr/lib/python3/dist-packages/PyYAML-6.0.egg-info/top_level.txt", ()),
        ("usr/lib/python3/dist-packages/README.txt", ()),
        ("usr/bin/python3", ()),
    ],
)
def test_module_names(path, names):
    assert list_modules(path) == names


@given(st.text(alphabet=st.sampled_from("usr/include/lib-0.a+h"), max_size=60))
def test_paths_never_raise(path):
    assert all(isinstance(name, str) for name in (*include_paths(path), *list_cmake(path), *list_modules(path)))


@pytest.mark.parametrize(
    ("version", "name", "tag"),
    [
        ("1.2.3", "", "refs/tags/1.2.3"),
        ("2.0.0", "", "refs/tags/v2.0.0"),
        ("3.0.0", "foo", "refs/tags/foo-3.0.0"),
        ("9.9.9", "", None),
    ],
)
def test_tag_of_a_version(version, name, tag):
    tags = {"1.2.3": "refs/tags/1.2.3", "v2.0.0": "refs/tags/v2.0.0", "foo-3.0.0": "refs/tags/foo-3.0.0"}
    assert find_tag(tags, version, name) == tag


@pytest.mark.parametrize(
    "url",
    ["https://github.com/Ros/geometry2.git", "git@github.com:ros/geometry2.git", "https://github.com/ros/geometry2/"],
)
def test_plain_url(url):
    assert normalize_url(url) == "ros/geometry2"


# Python's standard library


@pytest.mark.parametrize(
    ("module", "minor", "major", "there"),
    [
        ("os.path", 12, 3, True),
        ("distutils.core", 11, 3, True),
        ("distutils.core", 12, 3, False),
        ("imp", 11, 3, True),
        ("imp", 12, 3, False),
        ("cgi", 13, 3, False),
        ("dataclasses", 6, 3, False),
        ("dataclasses", 7, 3, True),
        ("tomllib", 10, 3, False),
        ("tomllib", 11, 3, True),
        ("urllib2", 10, 3, False),
        ("urllib2", 7, 2, True),
        ("queue", 7, 2, False),
        ("ConfigParser", 7, 2, True),
        ("numpy", 10, 3, False),
        ("_thread", 10, 3, True),
    ],
)
def test_standard_library(module, minor, major, there):
    assert is_in_stdlib(module, minor, major) is there


@pytest.mark.parametrize(("module", "ever"), [("imp", True), ("urllib2", True), ("tomllib", True), ("rospy", False)])
def test_ever_in_the_standard_library(module, ever):
    assert was_ever_in_stdlib(module) is ever


@pytest.mark.parametrize(
    ("name", "spelled"), [("eigen", {"Eigen"}), ("zlib", {"ZLIB"}), ("ZLIB", {"ZLIB"}), ("NoSuchThing", set())]
)
def test_spellings_of_a_cmake_name(name, spelled):
    assert set(load_providers().list_spellings(name)) == spelled
