"""Which of two libraries with the same names a package means: standalone Asio, and Boost's under a shorter name."""

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>relay</name>
  <version>1.0.0</version>
  <description>relay</description>
  <maintainer email="robots@example.org">Robots</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>{depend}</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(relay)
find_package(ament_cmake REQUIRED)
add_executable(relay relay.cpp)
install(TARGETS relay DESTINATION lib/${PROJECT_NAME})
ament_package()
"""
CODE = """#include <{header}>
{alias}
int main()
{{
  asio::io_service io;
  return asio::ip::address::from_string("127.0.0.1").is_v4() ? 0 : 1;
}}
"""
CONFIG = """[targets.packager]
distro = "humble"
date = {day}
platform = "robostack"
"""


@pytest.mark.parametrize(
    ("header", "alias", "depend", "day", "library"),
    [
        ("asio.hpp", "", "asio", "2026-03-06", "asio 1.36.0"),
        ("asio.hpp", "", "asio", "2026-02-01", ""),
        ("boost/asio.hpp", "namespace asio = boost::asio;", "libboost-dev", "2026-03-06", "boost 1.88.0"),
        ("boost/asio.hpp", "namespace asio = boost::asio;", "libboost-dev", "2024-03-06", ""),
    ],
)
def test_names_of_asio(tmp_path, header, alias, depend, day, library):
    files = {
        "package.xml": MANIFEST.format(depend=depend),
        "CMakeLists.txt": CMAKE,
        "relay.cpp": CODE.format(header=header, alias=alias),
        "rosimpact.toml": CONFIG.format(day=day),
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    found = check(str(tmp_path), Options(config=tmp_path / "rosimpact.toml", jobs=1)).findings
    said = [one.message for one in found if one.rule == "removed-symbol" and one.severity == "error"]
    assert len(said) == (2 if library else 0)
    assert all(library in message for message in said)
