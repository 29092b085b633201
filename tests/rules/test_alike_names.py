"""What a target has in the place of what is gone, where its name shows it or the last version said so."""

import pytest
import rule_cases
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options


@pytest.mark.parametrize(
    ("package", "program", "help_"),
    [
        ("controller_manager", "spawner.py", "controller_manager has `spawner`"),
        ("moveit_servo", "servo_node_main", "moveit_servo has `servo_node`"),
        ("moveit_servo", "fake_command_publisher", ""),
    ],
)
def test_a_program_with_a_similar_name_is_named(package, program, help_, tmp_path):
    files = dict(rule_cases.read_changed_files("api/removed_executable"))
    launch = "arm_bringup/launch/arm.launch.py"
    assert "package='controller_manager', executable='spawner.py'" in files[launch]
    files[launch] = files[launch].replace(
        "'controller_manager', executable='spawner.py'", f"'{package}', executable='{program}'"
    )
    found = rule_cases.check_files(files, Options(targets=("jazzy",), cache=tmp_path / "cache")).findings
    assert [f.help for f in found if f.rule == "removed-executable" and f.subject == program] == [help_]


def test_what_the_header_said_before_a_name_went_is_repeated(tmp_path):
    files = {
        "package.xml": '<package format="3"><name>arm</name><version>1.0.0</version><description>arm</description>'
        '<maintainer email="robots@example.org">R</maintainer><license>MIT</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend><depend>control_toolbox</depend></package>",
        "CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"
        "find_package(control_toolbox REQUIRED)\nadd_library(arm arm.cpp)\n"
        "target_link_libraries(arm control_toolbox::control_toolbox)\nament_package()\n",
        "arm.cpp": "#include <control_toolbox/pid_ros.hpp>\n\n"
        "void start(control_toolbox::PidROS & pid) { pid.initPid(); }\n",
    }
    for name, text in files.items():
        (tmp_path / "arm").mkdir(exist_ok=True)
        (tmp_path / "arm" / name).write_text(text)
    found = check(tmp_path, Options(targets=("lyrical",), cache=tmp_path / "cache", jobs=1)).findings
    assert [(f.subject, f.help) for f in found if f.rule == "removed-symbol"] == [
        ("control_toolbox::PidROS::initPid", "its declaration says: Use initialize_from_args() instead")
    ]
