"""moved-header of headers that no reviewed table names: the stored surfaces know that they warn."""

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

MANIFEST = """<package format="3">
  <name>winch</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@example.com">a</maintainer><license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend><depend>rosidl_typesupport_cpp</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(winch)
find_package(ament_cmake REQUIRED)
find_package(rosidl_typesupport_cpp REQUIRED)
add_executable(winch src/winch.cpp)
target_link_libraries(winch rosidl_typesupport_cpp::rosidl_typesupport_cpp)
install(TARGETS winch DESTINATION lib/${PROJECT_NAME})
ament_package()
"""


@pytest.mark.parametrize(("target", "told"), [("foxy", False), ("galactic", True)])
def test_a_header_that_warns_since_galactic(tmp_path, target, told):
    """rosidl_typesupport_cpp/type_support_map.h forwards to rosidl_typesupport_c since 1.1.0, with a warning."""
    (tmp_path / "src").mkdir()
    (tmp_path / "package.xml").write_text(MANIFEST)
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    (tmp_path / "src/winch.cpp").write_text("#include <rosidl_typesupport_cpp/type_support_map.h>\nint main() {}\n")
    options = Options(targets=(target,), select=("moved-header",), cache=tmp_path / "cache", jobs=1)
    found = check(tmp_path, options).findings
    assert [(f.line, f.help, f.evidence is not None and f.evidence.first) for f in found] == (
        [(1, "include `rosidl_typesupport_c/type_support_map.h`", "1.1.0")] if told else []
    )
