"""What moveit_configs_utils makes in launch files in Python: MoveIt's parameters, and nodes that its functions start.

Sources: moveit_configs_builder.py, launches.py and launch_utils.py of moveit_configs_utils, Humble to 2024. What they
look for on the disk, or read from the robot's description, is not known here: it stands under a condition.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from .actions import (
    Action,
    ActionCondition,
    Value,
    ValuePart,
    find_literal,
    join_all,
    make_literal,
    make_named,
    make_other,
)
from .python_calls import LaunchCall
from .python_calls import make as make_any
from .python_values import (
    ConditionalValue,
    Items,
    LaunchConstant,
    MoveItConfig,
    MoveItFile,
    Pairs,
    TextValue,
    YamlContent,
    add_action_conditions,
    is_given,
    split_conditions,
)
from .python_walk import Walker

PACKAGE = "moveit_configs_utils"
_ANY = "all"


class MoveItNode(NamedTuple):
    """A node that a function starts. sections: of the parameters that it is given; parameters: others, by the argument
    that gives them; options: its command line, where `$NAME` is an argument; when: the argument that it hangs on;
    debugged: it is started by a debugger instead where the argument `debug` says so."""

    package: str
    executable: str
    sections: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str], ...] = ()
    options: tuple[str, ...] = ()
    when: str = ""
    debugged: bool = False


_SHOWN = "publish_monitored_planning_scene"
LAUNCHES: dict[str, tuple[tuple[tuple[str, str], ...], tuple[MoveItNode, ...]]] = {
    "generate_rsp_launch": (
        (("publish_frequency", "15.0"),),
        (MoveItNode("robot_state_publisher", "robot_state_publisher", ("robot_description",),
                    (("publish_frequency", "publish_frequency"),)),),
    ),
    "generate_moveit_rviz_launch": (
        (("debug", "False"), ("rviz_config", "config/moveit.rviz")),
        (MoveItNode("rviz2", "rviz2", ("planning_pipelines", "robot_description_kinematics", "joint_limits"), (),
                    ("-d", "$rviz_config"), debugged=True),),
    ),
    "generate_setup_assistant_launch": (
        (("debug", "False"),),
        (MoveItNode("moveit_setup_assistant", "moveit_setup_assistant", debugged=True),),
    ),
    "generate_warehouse_db_launch": (
        (("moveit_warehouse_database_path", "default_warehouse_mongo_db"), ("reset", "False"),
         ("moveit_warehouse_port", "33829"), ("moveit_warehouse_host", "localhost")),
        (MoveItNode("warehouse_ros_mongo", "mongo_wrapper_ros.py", (),
                    (("database_path", "moveit_warehouse_database_path"), ("warehouse_port", "moveit_warehouse_port"),
                     ("warehouse_host", "moveit_warehouse_host"))),
         MoveItNode("moveit_ros_warehouse", "moveit_init_demo_warehouse", when="reset")),
    ),
    "generate_move_group_launch": (
        (("debug", "False"), ("allow_trajectory_execution", "True"), (_SHOWN, "True"), ("capabilities", ""),
         ("disable_capabilities", ""), ("monitor_dynamics", "False")),
        (MoveItNode("moveit_ros_move_group", "move_group", (_ANY,),
                    (("allow_trajectory_execution", "allow_trajectory_execution"), ("capabilities", "capabilities"),
                     ("disable_capabilities", "disable_capabilities"), ("publish_planning_scene", _SHOWN),
                     ("publish_geometry_updates", _SHOWN), ("publish_state_updates", _SHOWN),
                     ("publish_transforms_updates", _SHOWN)), debugged=True),),
    ),
}  # fmt: skip
"""By function: the arguments that it declares with their defaults (paths are below the configuration's package), and
the nodes that it starts."""
_PATHS = frozenset(("rviz_config", "moveit_warehouse_database_path"))
# Section: the parameter that the file's content is below, empty for none, and the file that is read by default.
_FILES = {
    "robot_description_kinematics": ("robot_description_kinematics", "config/kinematics.yaml"),
    "joint_limits": ("robot_description_planning", "config/joint_limits.yaml"),
    "pilz_cartesian_limits": ("robot_description_planning", "config/pilz_cartesian_limits.yaml"),
    "moveit_cpp": ("", "config/moveit_cpp.yaml"),
    "sensors_3d": ("", "config/sensors_3d.yaml"),
    "trajectory_execution": ("", "config/moveit_controllers.yaml"),
}
# Which of several files is taken, or whether there is one, is told by what is on the disk.
_ON_DISK = frozenset(("sensors_3d", "trajectory_execution"))
_SECTIONS = (*_FILES, "planning_pipelines", "robot_description", "robot_description_semantic", "planning_scene_monitor",
             "move_group_capabilities")  # fmt: skip
_BY_DEFAULT = ("robot_description_kinematics", "trajectory_execution", "sensors_3d", "joint_limits")
_DEMO = (("rsp", ""), ("move_group", ""), ("moveit_rviz", "use_rviz"), ("warehouse_db", "db"))


def make(walker: Walker, node: ast.Call, path: str, arguments: list[Any], keywords: dict[str, Any]) -> Any:
    """What a call of an imported name makes, as for python_calls.make(), with the names of moveit_configs_utils."""
    name = path.rpartition(".")[2]
    if path.partition(".")[0] != PACKAGE:
        return make_any(walker, node, path, arguments, keywords)
    call = LaunchCall(walker, node, path, arguments, keywords)
    if arguments and isinstance(arguments[0], MoveItConfig) and path == f"{arguments[0].path}.{name}":
        return _call_method(arguments[0], call)
    maker = _MAKERS.get(name)
    if maker is not None:
        return maker(call)
    if name in LAUNCHES:
        return call.make_list(_start_listed(call, *LAUNCHES[name]), "launch")
    return make_any(walker, node, path, arguments, keywords)


def _call_method(config: MoveItConfig, call: LaunchCall) -> Any:
    """What a method of a builder, or of what it builds, gives. call: with the builder before the arguments."""
    name = call.path.rpartition(".")[2]
    if name == "to_moveit_configs":
        whole = MoveItConfig(config.path, config.folder, dict(config.files), True, dict(config.attributes))
        whole.attributes |= {
            section: call.make_list(_list_parts(whole, (section,), call.line), "parameters") for section in _SECTIONS
        }
        return whole
    if name == "to_dict":
        return call.make_list(_list_parts(config, (_ANY,), call.line), "parameters")
    if name == "planning_pipelines":
        given = call.get(2, "pipelines")
        items = given.items if isinstance(given, Items) else ()
        names = [call.make_text(split_conditions(item)[0]) for item in items]
        paths = (join_all([make_literal("config/"), each, make_literal("_planning.yaml")]) for each in names)
        config.files[name] = [
            MoveItFile(each, _join(config, path), True) for each, path in zip(names, paths, strict=True)
        ]
    elif name in _FILES:
        given, (below, default) = call.get(1, "file_path"), _FILES[name]
        file = call.make_text(given) if is_given(given) else make_literal(default)
        on_disk = name in _ON_DISK and (not is_given(given) or name == "sensors_3d")
        config.files[name] = [MoveItFile(make_literal(below) if below else None, _join(config, file), on_disk)]
    return config


def _make_builder(call: LaunchCall) -> Any:
    robot, package = call.get(0, "robot_name"), call.get(2, "package_name")
    if is_given(package):
        name = call.make_text(package)
    elif robot is not None:
        name = join_all([call.make_text(robot), make_literal("_moveit_config")])
    else:
        return call.unknown
    folder: Value = (make_named("find", name),)
    return MoveItConfig(f"{PACKAGE}.MoveItConfigs", folder, attributes={"package_path": TextValue(folder)})


def _join(config: MoveItConfig, file: Value) -> Value:
    return (ValuePart("join", "", (config.folder, file)),)


def _list_parts(config: MoveItConfig, sections: tuple[str, ...], line: int) -> Iterator[Any]:
    """The parameters of some sections, as a node is given them; the robot's description is not known."""
    files = config.files
    if config.is_whole:
        # What is not asked for is read from where it is by default.
        defaults = {name: _find_default(config, name) for name in _BY_DEFAULT}
        files = defaults | files
    for section in files if _ANY in sections else sections:
        for one in files.get(section, ()):
            content: Any = YamlContent(one.file)
            if one.below is not None:
                content = Pairs([(TextValue(one.below), content)], 0)
            reason = ActionCondition("if", (make_other("it is there, and no other instead"),), line)
            yield ConditionalValue(content, (reason,)) if one.on_disk else content


def _find_default(config: MoveItConfig, section: str) -> list[MoveItFile]:
    below, file = _FILES[section]
    return [MoveItFile(make_literal(below) if below else None, _join(config, make_literal(file)), section in _ON_DISK)]


def _make_argument(name: str) -> Value:
    return (ValuePart("arg", name),)


def _declare(call: LaunchCall, name: str, default: Value) -> Action:
    return Action("argument", call.line, (("name", make_literal(name)), ("default", default)))


def _start_listed(
    call: LaunchCall, arguments: tuple[tuple[str, str], ...], nodes: tuple[MoveItNode, ...]
) -> Iterator[Action]:
    """The actions of a function of LAUNCHES."""
    config = call.get(0, "moveit_config")
    known = config if isinstance(config, MoveItConfig) else None
    for name, default in arguments:
        text = make_literal(default)
        if name in _PATHS:
            text = _join(known, text) if known is not None else (make_other(default),)
        yield _declare(call, name, text)
    for one in nodes:
        conditions = [ActionCondition("if", _make_argument(one.when), call.line)] if one.when else []
        yield _make_node(call, known, one, tuple(conditions))


def _make_node(
    call: LaunchCall, config: MoveItConfig | None, one: MoveItNode, conditions: tuple[ActionCondition, ...]
) -> Action:
    options = [_make_argument(word[1:]) if word[:1] == "$" else make_literal(word) for word in one.options]
    attributes = [("package", make_literal(one.package)), ("executable", make_literal(one.executable))]
    attributes += [("arguments", option) for option in options]
    children: list[Action] = []
    if config is not None:
        children += call.list_parameters(call.make_list(_list_parts(config, one.sections, call.line)))
    elif one.sections:
        children.append(Action("unknown", call.line, (("text", (make_other("parameters: moveit_config"),)),)))
    children += [
        Action("parameter", call.line, (("name", make_literal(name)), ("value", _make_argument(argument))))
        for name, argument in one.parameters
    ]
    if not one.debugged:
        return Action("node", call.line, tuple(attributes), conditions, tuple(children))
    debugged = (ActionCondition(kind, _make_argument("debug"), call.line) for kind in ("unless", "if"))
    both = tuple(Action("node", call.line, tuple(attributes), (each,), tuple(children)) for each in debugged)
    return Action("group", call.line, (("scoped", make_literal("false")),), conditions, both)


def _make_possible(call: LaunchCall, reason: str) -> tuple[ActionCondition, ...]:
    return (ActionCondition("each", (make_other(reason),), call.line),)


def _start_spawners(call: LaunchCall) -> Any:
    program = (("package", make_literal("controller_manager")), ("executable", make_literal("spawner")))
    each = _make_possible(call, "for each controller of moveit_simple_controller_manager")
    made = (
        Action("node", call.line, (*program, ("arguments", (make_other("controller"),))), each),
        Action("node", call.line, (*program, ("arguments", make_literal("joint_state_broadcaster")))),
    )
    return call.make_list(made, "launch")


def _send_virtual_joints(call: LaunchCall) -> Any:
    attributes = (
        ("package", make_literal("tf2_ros")), ("executable", make_literal("static_transform_publisher")),
        ("name", (ValuePart("text", "static_transform_publisher"), make_other("number"))),
    )  # fmt: skip
    conditions = _make_possible(call, "for each virtual joint of the semantic description")
    return call.make_list([Action("node", call.line, attributes, conditions)], "launch")


def _start_demo(call: LaunchCall) -> Any:
    config, elsewhere = call.get(0, "moveit_config"), call.get(1, "launch_package_path")
    if not isinstance(config, MoveItConfig):
        return call.unknown
    folder = call.make_text(elsewhere) if is_given(elsewhere) else config.folder

    def include(name: str, *more: tuple[str, Value], when: str = "") -> Action:
        file = (ValuePart("join", "", (folder, make_literal(f"launch/{name}.launch.py"))),)
        conditions = (ActionCondition("if", _make_argument(when), call.line),) if when else ()
        return Action("include", call.line, (("file", file), *more), conditions)

    yaml = Action("parameter-file", call.line, (("file", _join(config, make_literal("config/ros2_controllers.yaml"))),))
    # Newer versions alone give this remapping.
    remap = Action(
        "remap", call.line,
        (("from", make_literal("/controller_manager/robot_description")), ("to", make_literal("/robot_description"))),
        _make_possible(call, "newer than Iron"),
    )  # fmt: skip
    control = (("package", make_literal("controller_manager")), ("executable", make_literal("ros2_control_node")))
    made = [
        *(_declare(call, name, make_literal(value)) for name, value in (("db", "False"), ("debug", "False"),
                                                                         ("use_rviz", "True"))),
        include("static_virtual_joint_tfs", ("optional", make_literal("true"))),
        *(include(name, when=when) for name, when in _DEMO),
        Action("node", call.line, control, (), (yaml, remap)),
        include("spawn_controllers"),
    ]  # fmt: skip
    return call.make_list(made, "launch")


def _add_debuggable_node(call: LaunchCall) -> Any:
    """add_debuggable_node(): a node that is added to a description twice, with and without a debugger."""
    description = call.get(0, "ld")
    own = {"ld", "condition_name", "commands_file", "extra_debug_args"}
    keywords = {name: value for name, value in call.keywords.items() if name not in own}
    for place, name in enumerate(("package", "executable"), 1):
        if len(call.arguments) > place:
            keywords[name] = call.arguments[place]
    made = make_any(call.walker, call.node, "launch_ros.actions.Node", [], keywords)
    given = call.get(3, "condition_name")
    name = find_literal(call.make_text(given)) if given is not None else "debug"
    if not isinstance(description, Items) or not isinstance(made, Action) or name is None:
        return call.unknown
    for kind in ("unless", "if"):
        condition = ActionCondition(kind, _make_argument(name), call.line)
        call.walker.extend(description, [add_action_conditions(made, (condition,))])
    return LaunchConstant(None)


_MAKERS: dict[str, Callable[[LaunchCall], Any]] = {
    "MoveItConfigsBuilder": _make_builder,
    "generate_demo_launch": _start_demo,
    "generate_spawn_controllers_launch": _start_spawners,
    "generate_static_virtual_joint_tfs_launch": _send_virtual_joints,
    "add_debuggable_node": _add_debuggable_node,
}
