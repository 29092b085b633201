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

from ....edges.groups import group_pairs
from ...model.flow.contracts import (
    OPEN_POLICIES,
    ContractOfNode,
    FullEntry,
    collect_launched_names,
    find_program,
    is_of_framework,
    list_contracts,
    list_policies,
)
from ...model.flow.edges import Flow, build_whole_flow, get_label
from ...model.flow.escape_analysis import EscapeAnalysis
from ...model.flow.graph import Role
from ...model.flow.join import Running
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Text, Workspace, rule


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
    launched = collect_launched_names(workspace)
    running = group_pairs((one.node.package, one) for one in join.list_running())
    made = group_pairs((one.node, one) for one in flow.graph.endpoints)
    for contract in contracts:
        one = find_program(contract, running.get(contract.package, []))
        if one is not None:
            compared = _Compared(ContractOfNode(contract, one.node, made.get(one.node.id, []), launched), flow)
            if not escapes.find_unknown_reasons(one).names and not _has_unread(one, flow):
                yield from compared.find_missing()
            yield from compared.find_extra()
            yield from compared.find_different()


def _has_unread(one: Running, flow: Flow) -> bool:
    return not {fn.source.path for fn in one.functions}.isdisjoint(flow.graph.coverage.unread)


class _Compared:
    """A contract beside the endpoints of its node."""

    def __init__(self, contract: ContractOfNode, flow: Flow):
        self.contract, self.node, self.flow = contract.contract, contract.node, flow
        self.entries, self.made, self.fits = contract.entries, contract.made, contract.fits
        self.program = get_label(contract.node)

    def find_missing(self) -> Iterator[Diagnostic]:
        """Entries that the code has no endpoint for."""
        for entry in self.entries:
            same = [one for one in self.made if one.role == entry.role]
            unsure = (one for one in same if not self.flow.is_sure(one))
            if any(self.fits(entry, one) for one in same) or entry.path != self.contract.path:
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
            if self.flow.find_type(one) and not any(self.fits(entry, one) for entry in self.entries):
                if (one.role, one.topic) not in reported:
                    data = {"program": self.program, "role": _describe_role(one.role), "file": self.contract.path}
                    yield Diagnostic(At(one.path, one.line), one.topic, self.node.package, data, "extra")
                reported.add((one.role, one.topic))

    def find_different(self) -> Iterator[Diagnostic]:
        """Entries whose type or quality of service no endpoint of the code has."""
        for entry in self.entries:
            same = [one for one in self.made if self.fits(entry, one)]
            types = {self.flow.find_type(one) for one in same}
            if not same or "" in types:
                continue
            data = {"place": f"{same[0].path}:{same[0].line}"}
            if entry.type not in types:
                yield self._report(entry, "type", **data, written=entry.type, made=" or ".join(sorted(types)))
                continue
            every = [list_policies(one.qos) for one in same if one.type == entry.type]
            known = {key: value for key, value in every[0].items() if all(key in each for each in every)}
            asked = {key: value for key, value in entry.written.qos.items() if value not in OPEN_POLICIES}
            if asked.get("history") != "KEEP_LAST":
                asked.pop("depth", None)
            apart = [key for key in known if key in asked and all(each[key] != asked[key] for each in every)]
            if apart:
                written, made = (
                    ", ".join(f"{key} {values[key]}" for key in apart) for values in (asked, known)
                )  # fmt: skip
                yield self._report(entry, "qos", **data, written=written, made=made)

    def _report(self, entry: FullEntry, kind: str, **data: str) -> Diagnostic:
        data |= {"program": self.program, "role": _describe_role(entry.role)}
        return Diagnostic(At(entry.path, entry.written.line), entry.written.name, self.contract.package, data, kind)


def _describe_role(role: Role) -> str:
    return f"service {role}" if role in ("server", "client") else role
