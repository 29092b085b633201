"""What a target has in the place of a program or launch file that is gone, where its name shows it."""

import shutil
from pathlib import Path

import pytest
from rosimpact.impact.check import Options, check

CASE = Path(__file__).parent / "api/removed_executable/before"


@pytest.mark.parametrize(
    ("package", "program", "help_"),
    [
        ("controller_manager", "spawner.py", "it has `spawner`"),
        ("moveit_servo", "servo_node_main", "it has `servo_node`"),
        ("moveit_servo", "fake_command_publisher", ""),
    ],
)
def test_a_program_with_a_similar_name_is_named(package, program, help_, tmp_path):
    workspace = tmp_path / "ws"
    shutil.copytree(CASE, workspace)
    launch = workspace / "arm_bringup/launch/arm.launch.py"
    code = launch.read_text()
    assert "package='controller_manager', executable='spawner.py'" in code
    launch.write_text(
        code.replace("'controller_manager', executable='spawner.py'", f"'{package}', executable='{program}'")
    )
    found = check(workspace, Options(targets=("jazzy",), cache=tmp_path / "cache", jobs=1)).findings
    assert [f.help for f in found if f.rule == "removed-executable" and f.subject == program] == [help_]
