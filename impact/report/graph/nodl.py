"""The interfaces of nodes in NoDL 2, the Node Definition Language of ROS 2 (https://github.com/ros-tooling/nodl)."""

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from ....edges.console import UserError
from ....edges.groups import group_pairs
from ...model.flow.connections import format_conditions
from ...model.flow.contracts import INTERFACE_FOLDERS, SECTIONS, is_of_framework, is_parameter_of_framework
from ...model.flow.graph import Endpoint, Graph, Node, ParameterUse, Qos

# What runs by itself; plugins and libraries have no interface of their own.
_KINDS = frozenset(("executable", "script", "component"))
# What the schema accepts (`rosName`, `rosType`; names of parameters are free).
_NAME = re.compile(r"[A-Za-z]\Z|[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]\Z")
_TYPE = re.compile(r"([a-zA-Z][a-zA-Z0-9_]*)/([A-Z][a-zA-Z0-9]*)\Z")
_NOT_IN_A_FILE_NAME = re.compile(r"[^\w.-]+")
# Policies that the schema does not let out have this value where they are not known, as `ros2 nodl describe` writes.
_UNKNOWN = "SYSTEM_DEFAULT"
_SCALARS = {bool: "bool", int: "int", float: "double", str: "string"}
_WRAPPED = re.compile(r"(?:rclcpp::ParameterValue|std::string)\s*[({](.*)[)}]\Z", re.DOTALL)
_VECTOR = re.compile(r"std::vector<([\w:]+)>\((.*)\)\Z", re.DOTALL)
_ELEMENTS = {"std::string": "string", "double": "double", "int64_t": "int", "std::int64_t": "int", "bool": "bool"}
_DECLARED_TYPE = re.compile(r"(?:\w+(?:::|\.))*(?:PARAMETER_|Type\.)(\w+)\Z")
_TYPES = {
    "BOOL": "bool", "INTEGER": "int", "DOUBLE": "double", "STRING": "string", "BYTE_ARRAY": "byte_array",
    "BOOL_ARRAY": "bool_array", "INTEGER_ARRAY": "int_array", "DOUBLE_ARRAY": "double_array",
    "STRING_ARRAY": "string_array",
}  # fmt: skip


def make_documents(graph: Graph) -> dict[str, str]:
    """The NoDL document of each node that runs by itself, by the path of a file for it: `package/program.nodl.yaml`.

    What has no name or type that is known, or none that the schema accepts, is left out, and a comment at the top says
    so. Raises UserError for nodes of ROS 1.
    """
    if graph.ros == 1:
        raise UserError("--format nodl: NoDL describes nodes of ROS 2, and this is a workspace of ROS 1")
    endpoints = group_pairs((one.node, one) for one in graph.endpoints)
    parameters = group_pairs((one.node, one) for one in graph.parameters)
    nodes = [node for node in graph.nodes if node.kind in _KINDS and node.package]
    programs = group_pairs(((node.package, _name_program(node)), node) for node in nodes)
    found: dict[str, str] = {}
    for (package, program), those in programs.items():
        for node in those:
            name = program if len(those) == 1 else f"{program}.{node.name.strip('/')}"
            path = f"{package}/{_NOT_IN_A_FILE_NAME.sub('_', name)}.nodl.yaml"
            found[path] = _format_document(node, endpoints.get(node.id, []), parameters.get(node.id, []))
    return found


def _name_program(node: Node) -> str:
    return node.executable or node.plugin.rpartition("::")[2]


def _format_document(node: Node, endpoints: list[Endpoint], parameters: list[ParameterUse]) -> str:
    import yaml

    left_out: list[str] = []
    sections: dict[str, Any] = {"nodl_version": 2}
    declared = _make_parameters(parameters, left_out)
    if declared:
        sections["parameters"] = declared
    for role, section in SECTIONS.items():
        own = (one for one in endpoints if one.role == role and not is_of_framework(role, one.topic, one.type))
        rows = list(_make_rows(node, own, left_out))
        if rows:
            sections[section] = sorted(rows, key=lambda row: (row["name"], row["type"]))
    started = f", as {node.name} started at {node.started}" if node.started else ""
    comments = [f"{_name_program(node)} of {node.package}{started}"]
    comments += [f"It may have another name, or not be started: {reason}" for reason in node.uncertain]
    comments += [f"Left out: {each}" for each in dict.fromkeys(left_out)]
    head = "".join("# " + " ".join(one.split()) + "\n" for one in comments)
    return head + yaml.safe_dump(sections, sort_keys=False, allow_unicode=False, width=120)


def _make_rows(node: Node, endpoints: Iterable[Endpoint], left_out: list[str]) -> Iterator[dict[str, Any]]:
    """Endpoints of one role; several of one name and type are one."""
    seen = set()
    for one in endpoints:
        what = f"{one.role} of {one.type or 'a type that is not known'} at {one.path}:{one.line}"
        name = one.topic if node.started or not _NAME.match(one.code_name) else one.code_name
        type_ = _TYPE.match(one.type)
        if not one.topic or not _NAME.match(name):
            reason = f"its name is known in part ({one.topic})" if one.topic else one.reason
            left_out.append(f"{what}: {reason or 'its name is not known'}")
        elif type_ is None:
            left_out.append(f"{what}: NoDL has no such type")
        elif (name, one.type) not in seen:
            seen.add((name, one.type))
            row: dict[str, Any] = {"name": name, "type": f"{type_[1]}/{INTERFACE_FOLDERS[one.role]}/{type_[2]}"}
            if one.role in ("publisher", "subscriber"):
                row["qos"] = make_qos(one.qos or Qos())
            condition = one.only_if or format_conditions(one.guards)
            conditions = [f"only if {condition}"] if condition else []
            conditions += ["the name is the default of a parameter"] if one.how == "default" else []
            if conditions:
                row["description"] = "; ".join(" ".join(each.split()) for each in conditions)
            yield row


def make_qos(qos: Qos) -> dict[str, Any]:
    """A quality of service as the schema has it."""
    keeps = qos.history == "keep_last" and qos.depth < 1  # of a depth that the schema cannot say
    found: dict[str, Any] = {"history": _UNKNOWN if keeps or not qos.history else qos.history.upper()}
    if found["history"] == "KEEP_LAST":
        found["depth"] = qos.depth
    found["reliability"] = qos.reliability.upper() or _UNKNOWN
    for field in ("durability", "liveliness"):
        if getattr(qos, field):
            found[field] = getattr(qos, field).upper()
    for field, seconds in (("deadline_ns", qos.deadline), ("liveliness_lease_duration_ns", qos.lease)):
        if seconds is not None:
            found[field] = round(seconds * 1e9)
    return found


def _make_parameters(parameters: Iterable[ParameterUse], left_out: list[str]) -> Mapping[str, Any]:
    """Declared parameters whose type is known by the default or given, by name."""
    found: dict[str, dict[str, Any]] = {}
    for one in sorted(parameters, key=lambda each: each.name):
        if one.kind != "declared" or one.name in found or is_parameter_of_framework(one.name):
            continue
        made = make_parameter(one.default)
        if made is None or "<" in one.name:
            lacking = "its name is known in part" if "<" in one.name else "its type is not known"
            left_out.append(f"parameter {one.name} at {one.path}:{one.line}: {lacking}")
        else:
            found[one.name] = made
    return found


def make_parameter(default: str) -> dict[str, Any] | None:
    """The type, and the value where the source writes it out, that a declaration gives to a parameter."""
    text = default.strip()
    declared = _DECLARED_TYPE.match(text)
    if declared is not None:
        return {"type": _TYPES[declared[1]]} if declared[1] in _TYPES else None
    while wrapped := _WRAPPED.match(text):
        text = wrapped[1].strip()
    vector = _VECTOR.match(text)
    if vector is not None and not vector[2]:
        return {"type": f"{_ELEMENTS[vector[1]]}_array", "default_value": []} if vector[1] in _ELEMENTS else None
    if vector is not None:
        text = vector[2]
    if vector is not None or text.startswith("{"):
        text = f"[{text.removeprefix('{').removesuffix('}')}]"
    if len(text) > 1 and text[0] == text[-1] == '"' and '"' not in text[1:-1]:
        return {"type": "string", "default_value": text[1:-1]}
    if text in ("true", "false"):
        return {"type": "bool", "default_value": text == "true"}
    number = re.fullmatch(r"(-?[\d.]+(?:[eE][-+]?\d+)?)[fF]?", text)
    try:
        value = ast.literal_eval(number[1] if number else text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None
    kind = _SCALARS.get(type(value))
    if kind is not None:
        return {"type": kind, "default_value": value}
    if isinstance(value, list) and value and len({type(each) for each in value}) == 1 and type(value[0]) in _SCALARS:
        return {"type": f"{_SCALARS[type(value[0])]}_array", "default_value": value}
    return None
