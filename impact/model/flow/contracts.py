"""Interfaces of nodes written down as NoDL: where a workspace has them, and what every node has beside what it says."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from ....edges.groups import group_pairs
from ....edges.reach import walk
from ...facts.nodl import NodlEndpoint, NodlFile
from ..package import find_folder_role
from ..workspace import Package, Workspace
from .graph import Endpoint, Node, Qos, Role
from .join import Running
from .names import NameRefused, resolve_ros2_name
from .workspace import get_flow

SECTIONS: dict[Role, str] = {
    "publisher": "publishers", "subscriber": "subscriptions", "server": "service_servers",
    "client": "service_clients", "action server": "action_servers", "action client": "action_clients",
}  # fmt: skip
"""The sections of a NoDL document, and fields of rosgraph_msgs/Node, by role."""
INTERFACE_FOLDERS: dict[Role, str] = {
    "publisher": "msg", "subscriber": "msg", "server": "srv", "client": "srv", "action server": "action",
    "action client": "action",
}  # fmt: skip
"""What stands between package and name in a type of ROS 2."""
_OF_NODES: dict[tuple[Role, str], frozenset[str]] = {
    ("publisher", "rosout"): frozenset(("rcl_interfaces", "rosgraph_msgs")),
    ("publisher", "parameter_events"): frozenset(("rcl_interfaces",)),
    ("subscriber", "parameter_events"): frozenset(("rcl_interfaces",)),
    ("subscriber", "clock"): frozenset(("rosgraph_msgs",)),
    ("publisher", "transition_event"): frozenset(("lifecycle_msgs",)),
    ("publisher", "bond"): frozenset(("bond",)),
    ("subscriber", "bond"): frozenset(("bond",)),
    **{
        ("server", name): frozenset((package,))
        for package, names in (
            ("rcl_interfaces", ("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters",
                                "set_parameters", "set_parameters_atomically", "get_logger_levels",
                                "set_logger_levels")),
            ("type_description_interfaces", ("get_type_description",)),
            ("lifecycle_msgs", ("change_state", "get_state", "get_available_states", "get_available_transitions",
                                "get_transition_graph")),
            ("roscpp", ("get_loggers", "set_logger_level")),
        )
        for name in names
    },
}  # fmt: skip
_PARAMETERS = frozenset(("use_sim_time", "start_type_description_service"))


def is_of_framework(role: Role, name: str, type_: str) -> bool:
    """Whether ROS makes an endpoint of this name and type for nodes by itself. type_: `package/Name`, empty when it is
    not known, as `rosnode info` does not tell it of services."""
    packages = _OF_NODES.get((role, name.rpartition("/")[2]))
    return packages is not None and (not type_ or type_.partition("/")[0] in packages)


def is_parameter_of_framework(name: str) -> bool:
    """Whether ROS declares a parameter of this name for nodes by itself."""
    return name in _PARAMETERS or name.startswith("qos_overrides.")


_ENDING = ".nodl.yaml"
# Packages whose NoDL documents describe what is_of_framework() knows.
_FRAMEWORKS = frozenset(("nodl_common_interfaces", "rclcpp", "rclcpp_lifecycle", "rclpy"))


class ContractEntry(NamedTuple):
    """An endpoint of a NoDL document. path: of the file that has it."""

    role: Role
    path: str
    written: NodlEndpoint


class Contract(NamedTuple):
    """A NoDL 2 document of a package. program: what it describes. entries: its endpoints with those that it includes.
    whole: all that it includes is in the workspace, or of ROS itself."""

    path: str
    package: str
    program: str
    entries: tuple[ContractEntry, ...]
    whole: bool


def list_contracts(workspace: Workspace) -> Iterator[Contract]:
    """The NoDL 2 documents of a workspace, those of tests left out."""
    programs = {path: (package.name, name) for package in workspace for path, name in _list_documents(package)}
    if not programs:
        return
    for package in workspace:
        programs |= {path: (package.name, name) for path, name in _list_registered(workspace, package, programs)}
    found: Mapping[str, NodlFile] = workspace.extraction.look(sorted(programs), "flow_nodl")
    files = {path: file for path, file in found.items() if file.version == 2}
    places = {f"nodl://{package}/{name}": path for path, (package, name) in programs.items()}

    def resolve(path: str, reference: str) -> str:
        if reference.startswith("local://"):
            return posixpath.normpath(posixpath.join(posixpath.dirname(path), reference.removeprefix("local://")))
        return places.get(reference, "")

    def list_included(path: str) -> Iterator[str]:
        return (one for each in files[path].includes if (one := resolve(path, each)) in files)

    roles: dict[str, Role] = {section: role for role, section in SECTIONS.items()}
    for path, (package, program) in programs.items():
        if path not in files:
            continue
        every = list(walk([path], list_included))
        entries = (ContractEntry(roles[one.section], file, one) for file in every for one in files[file].endpoints)
        missing = {each for file in every for each in files[file].includes if resolve(file, each) not in files}
        strange = {each for each in missing if each.removeprefix("nodl://").partition("/")[0] not in _FRAMEWORKS}
        whole = not strange and not any(files[file].problems for file in every)
        yield Contract(path, package, program, tuple(entries), whole)


def _list_documents(package: Package) -> Iterator[tuple[str, str]]:
    """(path, program by its name) of the NoDL documents of a package."""
    start = len(package.path) + 1 if package.path else 0
    for path in package.linked.files:
        if path.endswith(_ENDING) and find_folder_role(path[start:]) != "test":
            yield path, posixpath.basename(path).removesuffix(_ENDING)


def _list_registered(
    workspace: Workspace, package: Package, known: Mapping[str, object]
) -> Iterator[tuple[str, str]]:  # fmt: skip
    """(path, program) of the documents that the CMake of a package registers: `ament_nodl_register(NAME FILE PATH)`."""
    for path in package.build.files:
        for command in workspace.extraction.get_facts(path).facts.commands if path in package.files else ():
            words = [argument.text for argument in command.arguments]
            if command.name.startswith("ament_nodl_register") and "FILE" in words[1:-1]:
                file = words[words.index("FILE") + 1].rpartition("}/")[2]
                document = posixpath.normpath(posixpath.join(posixpath.dirname(path), file))
                if document in known:
                    yield document, words[0]


def find_program(contract: Contract, running: list[Running]) -> Running | None:
    """The only program, or the only node of one, that a file may be about."""

    def list_names(one: Running) -> set[str]:
        program, plugin = one.program.executable, one.program.plugin
        return {program, program.removesuffix(".py"), plugin.rpartition("::")[2], one.node.name.rpartition("/")[2]}

    named = [one for one in running if contract.program in list_names(one)]
    by_node = [one for one in named if one.node.name.rpartition("/")[2] == contract.program]
    found = named if len(named) == 1 else by_node
    return found[0] if len(found) == 1 and found[0].program.kind != "plugin" else None


MadeKey = tuple[Role, str, int, str]


def collect_launched_names(workspace: Workspace) -> dict[MadeKey, list[str]]:
    """The names that an endpoint has in launch files."""
    launches = get_flow(workspace).launches
    return group_pairs((_identify(one), one.topic) for launch in launches for one in launch.graph.endpoints)


def _identify(one: Endpoint) -> MadeKey:
    return one.role, one.path, one.line, one.code_name


class FullEntry(NamedTuple):
    """An endpoint of a contract. name: in full, where the node has the name that its code gives; type: without the
    folder."""

    role: Role
    path: str
    written: NodlEndpoint
    name: str
    type: str


class ContractOfNode:
    """A contract beside the endpoints of its node."""

    def __init__(self, contract: Contract, node: Node, made: list[Endpoint], launched: dict[MadeKey, list[str]]):
        self.contract, self.node, self.made, self.launched = contract, node, made, launched
        self.entries = list(self._list_entries())

    def _list_entries(self) -> Iterator[FullEntry]:
        namespace, _, own = self.node.name.rpartition("/")
        for role, path, one in self.contract.entries:
            package, _, rest = one.type.partition("/")
            type_ = f"{package}/{rest.rpartition('/')[2]}"
            try:
                name = resolve_ros2_name(one.name, own, namespace or "/")
            except NameRefused:
                continue
            if not is_of_framework(role, name, type_):
                yield FullEntry(role, path, one, name, type_)

    def fits(self, entry: FullEntry, one: Endpoint) -> bool:
        """Whether an endpoint of the code is meant by an entry, which may have the name that a launch gives it."""
        if entry.role != one.role or not one.topic:
            return False
        if entry.name == one.topic or entry.name in self.launched.get(_identify(one), ()):
            return True
        relative = one.code_name.removeprefix("~/")
        absolute = entry.written.name.startswith("/")
        return absolute and bool(relative) and relative[0] != "/" and entry.name.endswith(f"/{relative}")


OPEN_POLICIES = ("SYSTEM_DEFAULT", "BEST_AVAILABLE")
"""Values of NoDL that leave a policy to the middleware."""
_POLICIES = ("reliability", "durability", "history", "liveliness")


def list_policies(qos: Qos | None) -> dict[str, object]:
    """What the code fixes of a quality of service, by the names of NoDL."""
    if qos is None:
        return {}
    found: dict[str, object] = {name: getattr(qos, name).upper() for name in _POLICIES}
    found = {name: value for name, value in found.items() if value and value not in OPEN_POLICIES}
    if qos.history == "keep_last" and qos.depth >= 0:
        found["depth"] = qos.depth
    if qos.deadline is not None:
        found["deadline_ns"] = round(qos.deadline * 1e9)
    if qos.lease is not None:
        found["liveliness_lease_duration_ns"] = round(qos.lease * 1e9)
    return found
