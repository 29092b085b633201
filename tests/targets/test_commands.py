"""Commands that packages give to those who find them, read from sources and from installed files."""

from pathlib import Path

from rosimpact.databuild.commands import find_commands
from rosimpact.impact.targets.providers.providers import load_providers

AMENT = "<export><build_type>ament_cmake</build_type></export>"


def test_functions_of_packages(tmp_path: Path):
    """Those of scripts and templates count for their own package; what is private, or a file of a test, does not."""
    files = {
        "wheels/package.xml": f"<package><name>wheels</name>{AMENT}</package>",
        "wheels/cmake/wheels_add_tyre.cmake": "function(Wheels_Add_Tyre name)\nendfunction()",
        "wheels/wheels-extras.cmake.in": "macro(wheels_pump)\nendmacro()\nmacro(_wheels_inner)\nendmacro()",
        "wheels/test/help.cmake": "macro(wheels_in_test)\nendmacro()",
        "wheels/inner/package.xml": "<package><name>spokes</name></package>",
        "wheels/inner/cmake/spokes.cmake": "macro(spokes_bend)\nendmacro()\nmacro(bend)\nendmacro()",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    assert sorted(find_commands(tmp_path)) == [
        (1, "spokes_bend", "spokes"),
        (2, "wheels_add_tyre", "wheels"),
        (2, "wheels_pump", "wheels"),
    ]


def test_shipped_commands():
    """What every workspace calls is known, and what CMake defines itself is nobody's."""
    commands = load_providers().commands
    assert commands[1]["catkin_package"] == "catkin" and commands[1]["catkin_add_gtest"] == "catkin"
    assert commands[2]["ament_package"] == "ament_cmake_core"
    assert "add_library" not in commands[1] and "pkg_check_modules" not in commands[1]
