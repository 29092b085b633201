"""Whether all that a program does with its node is known: only then is a name that its code lacks a dead one.

Unknown is what code of other packages does with a node that it is given, what is loaded at run time, and names
that are put together from what is not known. Whoever asks errs on the side of "not known".
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cached_property
from itertools import chain
from typing import NamedTuple

from ....edges.memory import cache_method
from ...facts.flow import FlowExpr
from ..workspace import Workspace
from .code import Fn, get_tail, list_made
from .join import Join, Running
from .types import split_name

_LOADERS = frozenset(
    ("createInstance", "createSharedInstance", "createUniqueInstance", "createUnmanagedInstance", "loadLibraryForClass",
     "load_component", "registerFromPlugin")
)  # fmt: skip
_PYTHON_LOADERS = frozenset(("import_module", "__import__", "eval", "exec"))
# Functions that take a node and name nothing with it.
_RUNS = frozenset(
    ("spin", "spin_some", "spin_once", "spin_until_future_complete", "add_node", "remove_node", "bind", "move",
     "shared_from_this", "get_node_base_interface", "__init__", "partial", "callback_group", "ref", "cref",
     "isinstance", "reset", "make_shared", "make_unique", "push_back", "emplace_back", "append", "static_pointer_cast",
     "dynamic_pointer_cast", "hasattr", "print", "str", "super", "async", "thread", "get",
     "create_timer", "create_wall_timer", "Bond", "TransportHints")
)  # fmt: skip
# Functions that read files of YAML, as those of parameters are.
_READERS = frozenset(("LoadFile", "LoadAllFromFile", "safe_load", "safe_load_all", "full_load"))
# Functions that ask for parameters whose names the code does not say one by one.
_WHOLE = frozenset(
    ("get_parameters_by_prefix", "list_parameters", "get_parameters", "declare_parameters", "getParamNames",
     "get_param_names", "searchParam", "search_param", "get_parameter_overrides", "allow_undeclared_parameters",
     "automatically_declare_parameters_from_overrides", "ParamListener", "set_parameters_from_yaml", "TransportHints")
)  # fmt: skip
_GIVES_NODE = ("shared_from_this", "getNodeHandle", "getPrivateNodeHandle")
_OPTIONS = ("automatically_declare_parameters_from_overrides", "allow_undeclared_parameters")
# Frameworks that read parameters of the node they are given.
_ASKING = frozenset(
    ("dynamic_reconfigure", "image_transport", "diagnostic_updater", "actionlib", "point_cloud_transport")
)
# Packages, and folders of headers of libraries, that name nothing in ROS's graph, or only what the table of frameworks
# knows.
_PLAIN = frozenset(
    ("ros", "rclcpp", "rclcpp_action", "rclcpp_lifecycle", "rclcpp_components", "rclpy", "rospy", "roslib",
     "rosgraph", "rcutils", "rcpputils", "rcl", "rmw", "rcl_interfaces", "rosidl_runtime_cpp", "builtin_interfaces",
     "unique_identifier_msgs", "tf2", "tf2_ros", "tf", "tf2_eigen", "tf2_kdl", "tf2_geometry_msgs",
     "tf2_sensor_msgs", "tf_transformations", "tf_conversions", "eigen_conversions", "message_filters", "actionlib",
     "nodelet", "image_transport", "cv_bridge", "image_geometry", "pcl_conversions", "laser_geometry", "angles",
     "std_srvs", "diagnostic_updater", "dynamic_reconfigure", "class_loader", "pluginlib", "bond", "uuid",
     "lifecycle_msgs", "ament_index_python", "ament_index_cpp", "rospkg", "urdf", "urdf_parser_py", "kdl_parser",
     "kdl", "sensor_msgs_py", "bondcpp", "ros2_numpy", "launch", "launch_ros", "XmlRpcValue.h", "xmlrpcpp",
     "console_bridge", "sophus", "Eigen", "eigen3", "boost", "opencv2", "opencv", "pcl", "yaml-cpp", "yaml",
     "numpy", "cv2", "scipy", "matplotlib", "serial", "sys", "GL", "std", "experimental", "fmt", "nlohmann",
     "tinyxml2", "geometry", "octomap", "ceres", "g2o", "gtest", "PIL", "requests", "psutil", "usb", "smbus",
     "transforms3d", "tty", "six", "pandas", "zmq", "linux", "netinet", "arpa", "bits", "mach", "GeographicLib",
     "behaviortree_cpp", "behaviortree_cpp_v3", "ompl", "rcl_action", "PyKDL", "rosbag", "genpy", "tf2_py",
     "LinearMath", "ecl", "dynamixel_sdk", "rtree", "geopandas", "colorama", "termcolor", "tqdm", "pkg_resources",
     "StringIO", "cStringIO", "cPickle", "urlparse", "xmlrpclib", "commands", "rttest")
)  # fmt: skip
_INTERFACES = ("_msgs", "_interfaces", "_srvs", "_actions")
_BASES = frozenset(("object", "Node", "LifecycleNode", "Nodelet", "enable_shared_from_this", "Thread", "Exception",
                    "Enum", "IntEnum", "ABC", "NamedTuple", "QObject", "QWidget", "TestCase", "exception"))  # fmt: skip


# Where the classes of the frameworks themselves stand.
_OWN = frozenset(
    ("std", "rclcpp", "rclpy", "ros", "rospy", "rclcpp_lifecycle", "message_filters", "tf", "tf2_ros", "XmlRpc")
)


class UnknownReasons(NamedTuple):
    """Why not all names, and not all parameters, of a program are known; empty where they are. reads: it reads files of
    YAML by itself, which may be those of its parameters."""

    names: str
    parameters: str
    reads: bool = False


class EscapeAnalysis:
    """Asks a body of code, joined, what a program does with its node outside of it."""

    def __init__(self, workspace: Workspace, join: Join):
        self.workspace, self.join = workspace, join

    def find_unknown_reasons(self, one: Running) -> UnknownReasons:
        """Why some names or parameters of a program may be unknown."""
        functions = sorted(one.functions, key=self._order.__getitem__)
        if not one.program.roots or not functions:
            return UnknownReasons("its code is not in the workspace", "its code is not in the workspace")
        paths = {fn.source.path for fn in functions}
        paths.update(cls.source.path for key in one.classes for cls in self.join.code.list_class_bodies(key))
        steps = (self._list_outside(paths), self._list_bases(one), self._list_given(functions), self._list_dead(one))
        both = next(chain(*steps), "")
        names = both or next(self._list_unnamed(functions), "")
        reads = any(get_tail(call.callee) in _READERS for fn in functions for call in fn.facts.calls)
        return UnknownReasons(names, both or next(self._list_unlisted(functions), ""), reads)

    @cached_property
    def _order(self) -> dict[Fn, int]:
        return {fn: place for place, fn in enumerate(self.join.code.functions)}

    def _list_outside(self, paths: set[str]) -> Iterator[str]:
        for path in sorted(paths):
            yield from (f"`{name}` is outside of the workspace" for name in self._uses.get(path, ()))

    @cached_property
    def _uses(self) -> dict[str, list[str]]:
        """By file the packages and libraries it uses whose names are not known."""
        found: dict[str, list[str]] = {}
        for package in self.workspace:
            for include in package.linked.includes:
                head, slash, _ = include.path.partition("/")
                if slash and not self._is_plain(head) and not self.workspace.provides_header(include.path):
                    found.setdefault(include.at.path, []).append(head)
            for imported in package.linked.imports:
                head = imported.module.split(".")[0]
                known = head in sys.stdlib_module_names or head in self.workspace.modules or self._is_plain(head)
                if head and not known:
                    found.setdefault(imported.at.path, []).append(head)
        return found

    def _is_plain(self, name: str) -> bool:
        return name in _PLAIN or name.endswith(_INTERFACES) or name in self.workspace.packages

    def _list_bases(self, one: Running) -> Iterator[str]:
        code, table = self.join.code, self.join.calls.table
        for key in sorted(one.classes):
            for cls in code.list_class_bodies(key):
                followed = {get_tail(base.name) for base in code.list_bases(cls)}
                for base in code.list_base_names(cls):
                    known = get_tail(base) in _BASES or get_tail(base) in followed or table.find_kind(base)
                    if base and not known and split_name(base)[0] not in _OWN:
                        yield f"`{base}` is not followed"

    def _list_given(self, functions: list[Fn]) -> Iterator[str]:
        """Functions and objects of others that are given the node, and what is loaded by name."""
        for fn in functions:
            yield from self._collect_given(fn)

    @cache_method
    def _collect_given(self, fn: Fn) -> tuple[str, ...]:
        return tuple(self._list_given_in(fn))

    def _list_given_in(self, fn: Fn) -> Iterator[str]:
        """Of one function; it may be one of many programs."""
        code, calls = self.join.code, self.join.calls
        python = fn.source.facts.language == "python"
        for call in fn.facts.calls:
            last = get_tail(call.callee)
            if python and self._is_lost(call.callee, fn):
                yield f"`{call.callee}` is not followed"
            use = calls.find_use(fn, call)
            loads = last in _LOADERS or (python and last in _PYTHON_LOADERS)
            if loads or (use is not None and use.row.does == "load"):
                yield f"`{last}` loads code by name"
                continue
            known = last in _RUNS or (python and last[:1].isupper())
            # `updater.add("state", this, &A::diagnose)`
            known = known or (last == "add" and any(argument.kind == "function" for argument in call.arguments))
            if known or not any(self._is_node(argument, fn) for argument in call.arguments):
                continue
            if not code.list_targets(call.callee, fn) and use is None:
                yield f"`{last}` is given the node"
        for name, arguments, _ in list_made(fn, code):
            if not python and self._is_unknown(name, fn):
                yield f"`{get_tail(name)}` is not followed"
            if any(self._is_node(argument, fn) for argument in arguments):
                kind = code.resolve_written(name, fn.source, fn.scope).name if not python else name
                known = code.find_class(kind, fn.source, fn.scope) if kind else None
                own = split_name(kind or name)[0] in _OWN or get_tail(name) in _RUNS
                table = calls.table.list_objects(kind or name, python) or calls.table.find_kind(kind or name)
                if known is None and not own and not table:
                    yield f"`{get_tail(kind or name)}` is given the node"

    def _is_unknown(self, name: str, fn: Fn) -> bool:
        """Whether a class in C++ would be the workspace's own by its namespace, and is not among its classes."""
        code, (head, *inner) = self.join.code, split_name(name)
        if head not in self._namespaces or get_tail(name) in self._aliased:
            return False
        if not self.workspace.interface_names.get(head, set()).isdisjoint(inner):
            return False
        return code.find_class_of_type(name, fn.source, fn.scope) is None

    @cached_property
    def _aliased(self) -> set[str]:
        """The names that stand for another type somewhere."""
        return {get_tail(name) for aliases in self.join.code.aliases.values() for name in aliases}

    def _is_lost(self, callee: str, fn: Fn) -> bool:
        """Whether a call in Python goes to a module of the workspace that has no such function or class there."""
        code = self.join.code
        meant = code.resolve_name(callee, fn.source)
        head, *inner = split_name(meant)
        if head not in self.workspace.modules or not inner or head in self.workspace.interface_names:
            return False
        return not code.list_targets(callee, fn) and code.find_class(meant, fn.source, fn.scope) is None

    @cached_property
    def _namespaces(self) -> set[str]:
        """The outermost namespaces of the workspace's own classes."""
        every = (cls for classes in self.join.code.classes.values() for cls in classes)
        return {split_name(cls.name)[0] for cls in every if "::" in cls.name} - _OWN

    def _list_dead(self, one: Running) -> Iterator[str]:
        """What the program is built from and, as far as can be known, never runs."""
        for use in self.join.calls.uses:
            path = use.fn.source.path
            if path in one.program.files and use.fn not in self._reached:
                yield f"`{use.fn.name}` is not seen to be reached"

    @cached_property
    def _reached(self) -> set[Fn]:
        return {fn for one in self.join.list_running() for fn in one.functions}

    def _is_node(self, value: FlowExpr, fn: Fn) -> bool:
        calls = self.join.calls
        if value.kind in ("keyword", "list") and value.parts:
            return any(self._is_node(part, fn) for part in value.parts)
        if value.kind == "name" and value.text in ("this", "self", "*this"):
            return bool(calls.find_own_kinds(fn) & {"node", "handle"})
        if value.kind == "other":
            return value.text == "*this" and bool(calls.find_own_kinds(fn) & {"node", "handle"})
        if value.kind == "call" and get_tail(value.text) in _GIVES_NODE:
            return True
        if value.kind in ("name", "call"):
            return bool(calls.find_kinds(self.join.code.resolve_type(value, fn), fn) & {"node", "handle"})
        return False

    def _list_unnamed(self, functions: list[Fn]) -> Iterator[str]:
        inside = set(functions)
        for site in self.join.sites.endpoints:
            if site.use.fn in inside and any(value.text is None for value in site.names):
                yield f"the name of a {site.role} is not known"
        for use in self.join.sites.wrapped:
            if use.fn in inside:
                yield "names are made in a wrapper"
                return

    def _list_unlisted(self, functions: list[Fn]) -> Iterator[str]:
        inside = set(functions)
        for fn in functions:
            for call in fn.facts.calls:
                if get_tail(call.callee) in _WHOLE or any(_says(argument, _OPTIONS) for argument in call.arguments):
                    yield f"`{get_tail(call.callee)}` asks for more than one parameter"
            for name, _, _ in list_made(fn, self.join.code):
                if get_tail(name) in _WHOLE:
                    yield f"`{get_tail(name)}` asks for more than one parameter"
        for use in self.join.calls.uses:
            if use.fn not in inside:
                continue
            if use.row.framework in _ASKING:
                yield f"`{use.row.framework}` asks for parameters of its own"
            if use.row.does == "parameter":
                values = self.join.values.evaluate(
                    self.join.calls.find_argument(use, use.row.topic), use.fn, use.call.line
                )
                if not values or any(not value.text for value in values):
                    yield "the name of a parameter is not known"


def _says(value: FlowExpr, words: tuple[str, ...]) -> bool:
    return any(word in value.text for word in words) or any(_says(part, words) for part in value.parts)
