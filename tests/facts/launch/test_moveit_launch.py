"""What launch files start with moveit_configs_utils."""

import pytest
from rosimpact.impact.facts.launch.flow import extract
from rosimpact.impact.facts.launch.python_moveit import LAUNCHES
from rosimpact.impact.model.launch.follow import follow
from rosimpact.impact.model.launch.result import SettingFile

HEAD = """
from launch import LaunchDescription
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg, add_debuggable_node
from moveit_configs_utils.launches import *
from moveit_configs_utils.launches import (
    generate_demo_launch, generate_move_group_launch, generate_moveit_rviz_launch, generate_rsp_launch,
    generate_setup_assistant_launch, generate_spawn_controllers_launch, generate_static_virtual_joint_tfs_launch,
    generate_warehouse_db_launch,
)

BUILDER = MoveItConfigsBuilder("arm")

def generate_launch_description():
"""
OF_ARM = "$(find arm_moveit_config)/config"


class Files:
    """Launch files of the package arm_moveit_config."""

    def __init__(self, **texts):
        self.files = {f"launch/{name}.launch.py": text for name, text in texts.items()}

    def find_launch_file(self, package, path):
        text = self.files.get(path) if package == "arm_moveit_config" else None
        return None if text is None else extract(f"{HEAD}    {text}\n".encode(), "launch_python")

    def find_parameter_file(self, package, path):
        return None


def start(text, arguments=None, **more):
    return follow("arm_moveit_config", "launch/a.launch.py", Files(a=text, **more), arguments)


def programs(launched):
    return [(one.package.value, one.executable.value, bool(one.conditions)) for one in launched.started]


def files(started):
    """The parameter files of a start, with what their content is below, and whether they may be others."""
    return [(one.file.value, bool(one.conditions)) for one in started.settings if isinstance(one, SettingFile)]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("rsp", [("robot_state_publisher", "robot_state_publisher", False)]),
        ("moveit_rviz", [("rviz2", "rviz2", False)]),
        ("setup_assistant", [("moveit_setup_assistant", "moveit_setup_assistant", False)]),
        ("warehouse_db", [("warehouse_ros_mongo", "mongo_wrapper_ros.py", False)]),
        ("move_group", [("moveit_ros_move_group", "move_group", False)]),
        ("spawn_controllers", [("controller_manager", "spawner", True), ("controller_manager", "spawner", False)]),
        ("static_virtual_joint_tfs", [("tf2_ros", "static_transform_publisher", True)]),
    ],
)
def test_nodes_of_functions(name, expected):
    assert programs(start(f"return generate_{name}_launch(BUILDER.to_moveit_configs())")) == expected
    # without the configuration the nodes are the same
    assert programs(start(f"return generate_{name}_launch(far())")) == expected


@pytest.mark.parametrize("name", LAUNCHES)
def test_all_parameters_rest_on_declared_arguments(name):
    found = start(f"return {name}(BUILDER.to_moveit_configs())")
    declared = {argument for argument, _ in LAUNCHES[name][0]}
    assert found.arguments == declared
    assert all(one.text.value is not None for each in found.started for one in each.settings if hasattr(one, "text"))


def test_arguments_of_a_function():
    text = "return generate_warehouse_db_launch(BUILDER.to_moveit_configs())"
    assert len(start(text).started) == 1
    found = start(text, {"reset": "true", "moveit_warehouse_port": "1"})
    assert [one.executable.value for one in found.started] == ["mongo_wrapper_ros.py", "moveit_init_demo_warehouse"]
    values = {one.name: one.text.value for one in found.started[0].settings}
    assert (values["warehouse_port"], values["database_path"]) == (
        "1", "$(find arm_moveit_config)/default_warehouse_mongo_db",
    )  # fmt: skip


def test_a_virtual_joint_has_no_certain_name():
    (one,) = start("return generate_static_virtual_joint_tfs_launch(BUILDER.to_moveit_configs())").started
    assert (one.name.value, one.name.shown) == (None, "static_transform_publisher<number>")


@pytest.mark.parametrize(
    ("chain", "expected"),
    [
        ("BUILDER.to_moveit_configs()",
         {f"{OF_ARM}/kinematics.yaml": False, f"{OF_ARM}/moveit_controllers.yaml": True,
          f"{OF_ARM}/sensors_3d.yaml": True, f"{OF_ARM}/joint_limits.yaml": False}),
        ("BUILDER.robot_description_kinematics(file_path='config/k.yaml').joint_limits('config/j.yaml')"
         ".trajectory_execution(file_path='config/t.yaml').moveit_cpp('config/m.yaml').to_moveit_configs()",
         {f"{OF_ARM}/k.yaml": False, f"{OF_ARM}/j.yaml": False, f"{OF_ARM}/t.yaml": False, f"{OF_ARM}/m.yaml": False,
          f"{OF_ARM}/sensors_3d.yaml": True}),
        ("BUILDER.planning_pipelines(pipelines=['ompl', 'pilz'])",
         {f"{OF_ARM}/ompl_planning.yaml": True, f"{OF_ARM}/pilz_planning.yaml": True}),
        ("MoveItConfigsBuilder('arm', package_name='other').moveit_cpp()",
         {"$(find other)/config/moveit_cpp.yaml": False}),
        ("MoveItConfigsBuilder(robot_name='arm', package_name='other').moveit_cpp(file_path='m.yaml')",
         {"$(find other)/m.yaml": False}),
    ],
)  # fmt: skip
def test_parameter_files_of_a_configuration(chain, expected):
    node = "Node(package='p', executable='e', parameters=[config.to_dict(), {'a': 1}])"
    (one,) = start(f"config = {chain}\n    return LaunchDescription([{node}])").started
    assert dict(files(one)) == expected
    assert [each.name for each in one.settings if hasattr(each, "text")] == ["a"]


@pytest.mark.parametrize(
    ("section", "expected"),
    [
        ("robot_description_kinematics", [(f"{OF_ARM}/kinematics.yaml", False)]),
        ("joint_limits", [(f"{OF_ARM}/joint_limits.yaml", False)]),
        ("robot_description", []),
        ("robot_description_semantic", []),
        ("moveit_cpp", []),
    ],
)
def test_sections_of_a_configuration(section, expected):
    node = f"Node(package='p', executable='e', parameters=[config.{section}])"
    (one,) = start(f"config = BUILDER.to_moveit_configs()\n    return LaunchDescription([{node}])").started
    assert files(one) == expected


def test_a_dictionary_of_parameters_is_added_to():
    text = "given = BUILDER.moveit_cpp().to_dict()\n    given.update({'a': 1})\n    return LaunchDescription([NODE])"
    (one,) = start(text.replace("NODE", "Node(package='p', executable='e', parameters=[given])")).started
    assert files(one) == [(f"{OF_ARM}/moveit_cpp.yaml", False)]
    assert [each.name for each in one.settings if hasattr(each, "text")] == ["a"]


INCLUDED = {
    name: f"return generate_{name}_launch(BUILDER.to_moveit_configs())"
    for name in ("rsp", "move_group", "moveit_rviz", "warehouse_db", "spawn_controllers")
}


def test_a_demonstration():
    found = start("return generate_demo_launch(BUILDER.to_moveit_configs())", **INCLUDED)
    assert programs(found) == [
        ("robot_state_publisher", "robot_state_publisher", False),
        ("moveit_ros_move_group", "move_group", False),
        ("rviz2", "rviz2", False),
        ("controller_manager", "ros2_control_node", False),
        ("controller_manager", "spawner", True),
        ("controller_manager", "spawner", False),
    ]
    assert found.outside == ()
    control = found.started[3]
    assert files(control) == [(f"{OF_ARM}/ros2_controllers.yaml", False)]
    assert [bool(remap.conditions) for remap in control.remaps] == [True]


def test_a_demonstration_without_its_launch_files():
    """That of virtual joints need not be there, the others have to."""
    found = start("return generate_demo_launch(BUILDER.to_moveit_configs())", {"use_rviz": "false"})
    lost = [one.executable.value for one in found.outside]
    assert lost == [f"launch/{name}.launch.py" for name in ("rsp", "move_group", "spawn_controllers")]


def test_a_node_that_can_be_debugged():
    text = (
        "ld = LaunchDescription()\n    ld.add_action(DeclareBooleanLaunchArg('debug', default_value=False))\n"
        "    add_debuggable_node(ld, package='p', executable='e', name='n', commands_file='x')\n    return ld"
    )
    assert [(one.name.value, one.conditions) for one in start(text).started] == [("n", ())]
    assert len(start(text, {"debug": "true"}).started) == 1


def test_functions_of_other_packages_are_not_those_of_moveit():
    text = "from mine import generate_rsp_launch as made\n    return made(BUILDER.to_moveit_configs())"
    assert start(text).started == ()
