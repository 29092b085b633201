"""contract-mismatch: a node and the NoDL file that describes it name different endpoints.

What it does
    Compares each NoDL 2 file of a package (`*.nodl.yaml`) with the code of the program that it describes: the one that
    `ament_nodl_register` names, else the one that the file is named after. Reports endpoints that the file names and
    the code does not create, endpoints that the code creates and the file lacks, and types and quality of service that
    differ.

Why it matters
    Who generates code, documentation or tests from the file, or wires a system by it, relies on endpoints that do not
    exist or behave differently.

Example
    publishers:
      - name: scan                     # the code publishes scan_filtered
        type: sensor_msgs/msg/LaserScan
        qos: {history: KEEP_LAST, depth: 10, reliability: RELIABLE}

Use instead
      - name: scan_filtered

Not reported
    Endpoints of ROS itself (`/rosout`, services for parameters and lifecycle); programs that create endpoints of this
    type under names that are not known, load plugins, or pass their node to code outside of the workspace; endpoints
    that the code creates only under a condition; what a file may get by `include` from outside of the workspace;
    quality of service that the file or the code leaves open; names that launch files give.
"""

from collections.abc import Iterator
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.nodl import NodlEndpoint
from ...model.flow.contracts import Contract, is_of_framework, list_contracts
from ...model.flow.edges import Flow, build_whole_flow, get_label
from ...model.flow.escape_analysis import EscapeAnalysis
from ...model.flow.graph import Endpoint, Node, Qos, Role
from ...model.flow.join import Running
from ...model.flow.names import NameRefused, resolve_ros2_name
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

_POLICIES = ("reliability", "durability", "history", "liveliness")
_OPEN_POLICIES = ("SYSTEM_DEFAULT", "BEST_AVAILABLE")


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts={
        "missing": Text(
            "`{program}` creates no {role} `{subject}`, which this file names",
            help="create it in the node, or remove it from the file",
        ),
        "extra": Text(
            "`{program}` creates the {role} `{subject}`, which `{file}` does not name",
            help="add it to `{file}`, or remove it from the node",
        ),
        "type": Text(
            "the type of the {role} `{subject}` is `{written}` in this file, but `{made}` in `{program}` ({place})",
            help="use one type in both",
        ),
        "qos": Text(
            "the {role} `{subject}` has {written} in this file, but {made} in `{program}` ({place})",
            help="use one quality of service in both",
        ),
    },
)
def contract_mismatch(workspace: Workspace):
    contracts = list(list_contracts(workspace))
    if not contracts or workspace.ros == 1:
        return
    flow, join = build_whole_flow(workspace), get_flow(workspace).code
    escapes = EscapeAnalysis(workspace, join)
    launched = _collect_launched_names(workspace)
    running = group_pairs((one.node.package, one) for one in join.list_running())
    made = group_pairs((one.node, one) for one in flow.graph.endpoints)
    for contract in contracts:
        one = _find_program(contract, running.get(contract.package, []))
        if one is not None:
            compared = _Compared(contract, one.node, flow, made.get(one.node.id, []), launched)
            if not escapes.find_unknown_reasons(one).names and not _has_unread(one, flow):
                yield from compared.find_missing()
            yield from compared.find_extra()
            yield from compared.find_different()


def _find_program(contract: Contract, running: list[Running]) -> Running | None:
    """The only program, or the only node of one, that a file may be about."""

    def list_names(one: Running) -> set[str]:
        program, plugin = one.program.executable, one.program.plugin
        return {program, program.removesuffix(".py"), plugin.rpartition("::")[2], one.node.name.rpartition("/")[2]}

    named = [one for one in running if contract.program in list_names(one)]
    by_node = [one for one in named if one.node.name.rpartition("/")[2] == contract.program]
    found = named if len(named) == 1 else by_node
    return found[0] if len(found) == 1 and found[0].program.kind != "plugin" else None


def _has_unread(one: Running, flow: Flow) -> bool:
    return not {fn.source.path for fn in one.functions}.isdisjoint(flow.graph.coverage.unread)


_Made = tuple[Role, str, int, str]


def _collect_launched_names(workspace: Workspace) -> dict[_Made, list[str]]:
    """The names that an endpoint has in launch files."""
    launches = get_flow(workspace).launches
    return group_pairs((_identify(one), one.topic) for launch in launches for one in launch.graph.endpoints)


def _identify(one: Endpoint) -> _Made:
    return one.role, one.path, one.line, one.code_name


class _Entry(NamedTuple):
    """An endpoint of a contract. name: in full, where the node has the name that its code gives; type: without the
    folder."""

    role: Role
    path: str
    written: NodlEndpoint
    name: str
    type: str


class _Compared:
    """A contract beside the endpoints of its node."""

    def __init__(
        self, contract: Contract, node: Node, flow: Flow, made: list[Endpoint], launched: dict[_Made, list[str]]
    ):
        self.contract, self.node, self.flow, self.made, self.launched = contract, node, flow, made, launched
        self.entries = list(self._list_entries())
        self.program = get_label(node)

    def _list_entries(self) -> Iterator[_Entry]:
        namespace, _, own = self.node.name.rpartition("/")
        for role, path, one in self.contract.entries:
            package, _, rest = one.type.partition("/")
            type_ = f"{package}/{rest.rpartition('/')[2]}"
            try:
                name = resolve_ros2_name(one.name, own, namespace or "/")
            except NameRefused:
                continue
            if not is_of_framework(role, name, type_):
                yield _Entry(role, path, one, name, type_)

    def _fits(self, entry: _Entry, one: Endpoint) -> bool:
        """Whether an endpoint of the code is meant by an entry, which may have the name that a launch gives it."""
        if entry.role != one.role or not one.topic:
            return False
        if entry.name == one.topic or entry.name in self.launched.get(_identify(one), ()):
            return True
        relative = one.code_name.removeprefix("~/")
        absolute = entry.written.name.startswith("/")
        return absolute and bool(relative) and relative[0] != "/" and entry.name.endswith(f"/{relative}")

    def find_missing(self) -> Iterator[Diagnostic]:
        """Entries that the code has no endpoint for."""
        for entry in self.entries:
            same = [one for one in self.made if one.role == entry.role]
            unsure = (one for one in same if not self.flow.is_sure(one))
            if any(self._fits(entry, one) for one in same) or entry.path != self.contract.path:
                continue
            if not any(one.type in ("", "*", entry.type) for one in unsure):
                yield self._report(entry, "missing")

    def find_extra(self) -> Iterator[Diagnostic]:
        """Endpoints that the code creates for certain and that the contract lacks."""
        reported = set()
        for one in self.made if self.contract.whole else ():
            certain = self.flow.is_sure(one) and not one.only_if and not one.guards and not one.implied
            if not certain or is_of_framework(one.role, one.topic, one.type):
                continue
            if self.flow.find_type(one) and not any(self._fits(entry, one) for entry in self.entries):
                if (one.role, one.topic) not in reported:
                    data = {"program": self.program, "role": _describe_role(one.role), "file": self.contract.path}
                    yield Diagnostic(At(one.path, one.line), one.topic, self.node.package, data, "extra")
                reported.add((one.role, one.topic))

    def find_different(self) -> Iterator[Diagnostic]:
        """Entries whose type or quality of service no endpoint of the code has."""
        for entry in self.entries:
            same = [one for one in self.made if self._fits(entry, one)]
            types = {self.flow.find_type(one) for one in same}
            if not same or "" in types:
                continue
            data = {"place": f"{same[0].path}:{same[0].line}"}
            if entry.type not in types:
                yield self._report(entry, "type", **data, written=entry.type, made=" or ".join(sorted(types)))
                continue
            every = [_list_policies(one.qos) for one in same if one.type == entry.type]
            known = {key: value for key, value in every[0].items() if all(key in each for each in every)}
            asked = {key: value for key, value in entry.written.qos.items() if value not in _OPEN_POLICIES}
            if asked.get("history") != "KEEP_LAST":
                asked.pop("depth", None)
            apart = [key for key in known if key in asked and all(each[key] != asked[key] for each in every)]
            if apart:
                written, made = (
                    ", ".join(f"{key} {values[key]}" for key in apart) for values in (asked, known)
                )  # fmt: skip
                yield self._report(entry, "qos", **data, written=written, made=made)

    def _report(self, entry: _Entry, kind: str, **data: str) -> Diagnostic:
        data |= {"program": self.program, "role": _describe_role(entry.role)}
        return Diagnostic(At(entry.path, entry.written.line), entry.written.name, self.contract.package, data, kind)


def _describe_role(role: Role) -> str:
    return f"service {role}" if role in ("server", "client") else role


def _list_policies(qos: Qos | None) -> dict[str, object]:
    """What the code fixes of a quality of service, by the names of NoDL."""
    if qos is None:
        return {}
    found: dict[str, object] = {name: getattr(qos, name).upper() for name in _POLICIES}
    found = {name: value for name, value in found.items() if value and value not in _OPEN_POLICIES}
    if qos.history == "keep_last" and qos.depth >= 0:
        found["depth"] = qos.depth
    if qos.deadline is not None:
        found["deadline_ns"] = round(qos.deadline * 1e9)
    if qos.lease is not None:
        found["liveliness_lease_duration_ns"] = round(qos.lease * 1e9)
    return found
