"""What ament_auto is told to require is to be declared by the same name; and what an unknown package may bring."""

from pathlib import Path

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

MANIFEST = (
    '<package format="3"><name>buoy</name><version>1.0.0</version><description>d</description>'
    '<maintainer email="robots@example.org">Robots</maintainer><license>MIT</license>'
    "<buildtool_depend>ament_cmake_auto</buildtool_depend>{depends}"
    "<export><build_type>ament_cmake</build_type></export></package>"
)
CMAKE = (
    "cmake_minimum_required(VERSION 3.8)\nproject(buoy)\nfind_package(ament_cmake_auto REQUIRED)\n{}"
    "ament_auto_package()\n"
)


def told(folder: Path, subject: str, cmake: str, *depends: str, target: str = "humble") -> set[str]:
    (folder / "package.xml").write_text(MANIFEST.format(depends="".join(depends)))
    (folder / "CMakeLists.txt").write_text(CMAKE.format(cmake))
    options = Options(targets=(target,), select=("undeclared-package",), cache=folder / "cache", jobs=1)
    return {f.severity for f in check(folder, options).findings if f.subject == subject}


@pytest.mark.parametrize(
    ("depend", "expected"),
    [
        ("<depend>eigen</depend>", {"error"}),
        ("<exec_depend>Eigen3</exec_depend><depend>eigen</depend>", {"error"}),
        ("<build_depend>Eigen3</build_depend>", set()),
        ("<buildtool_depend>Eigen3</buildtool_depend>", set()),
    ],
)
@pytest.mark.parametrize("target", ["bouncy", "humble"])
def test_the_name_of_a_key_is_not_the_one_that_is_required(target, depend, expected, tmp_path):
    cmake = "set(needed Eigen3)\nament_auto_find_build_dependencies(REQUIRED ${needed})\n"
    assert told(tmp_path, "Eigen3", cmake, depend, target=target) == expected


def test_nothing_is_refused_where_nothing_is_required(tmp_path):
    cmake = "ament_auto_find_build_dependencies()\nfind_package(Eigen3 REQUIRED)\n"
    assert told(tmp_path, "Eigen3", cmake, "<depend>eigen</depend>") == set()


@pytest.mark.parametrize(
    ("unknown", "expected"),
    [
        ("yard_crane_msgs", {"error"}),  # interfaces, which bring no library
        ("yard_crane_driver", {"warning"}),  # which may bring anything
    ],
)
def test_what_a_package_known_nowhere_may_bring(unknown, expected, tmp_path):
    cmake = "find_package(laser_geometry REQUIRED)\n"
    assert told(tmp_path, "laser_geometry", cmake, f"<depend>{unknown}</depend>") == expected


@pytest.mark.parametrize("wanted", ["geometry_msgs", "rosidl_runtime_c"])
def test_interfaces_bring_interfaces_and_what_they_run_with(wanted, tmp_path):
    told_of = told(tmp_path, wanted, f"find_package({wanted} REQUIRED)\n", "<depend>yard_crane_msgs</depend>")
    assert told_of == {"warning"}
