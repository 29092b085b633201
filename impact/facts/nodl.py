"""Interfaces of nodes that a package writes down: files in NoDL 2 (`*.nodl.yaml`,
https://github.com/ros-tooling/nodl/blob/main/nodl_schema/nodl_schema/schemas/nodl.schema.yaml)."""

from collections.abc import Iterator
from typing import Any

import msgspec

from .launch.parameter_files import YamlNode, parse_yaml_tree
from .markup import decode
from .place import Problem

_SECTIONS = (
    "publishers", "subscriptions", "service_servers", "service_clients", "action_servers", "action_clients",
)  # fmt: skip


class NodlEndpoint(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An endpoint of a NoDL file. section: the list it stands in. type: as written, `package/msg/Name` or
    `package/Name`. qos: its settings as written, by name."""

    section: str
    name: str
    type: str
    line: int
    qos: dict[str, Any] = {}


class NodlFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a NoDL file names. version: 0 for none. includes: references to other NoDL files, as written."""

    version: int
    endpoints: tuple[NodlEndpoint, ...] = ()
    includes: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()


def extract(data: bytes) -> NodlFile:
    """What a NoDL file names. Never raises; entries that are not as the schema has them are left out, as problems."""
    root, problems = parse_yaml_tree(decode(data))
    top = _get_fields(root)
    version = top["nodl_version"].value if "nodl_version" in top else 0
    endpoints: list[NodlEndpoint] = []
    for section in _SECTIONS:
        for item in _list_items(top.get(section)):
            fields = _get_fields(item)
            name, type_ = (fields[key].value if key in fields else None for key in ("name", "type"))
            if not (isinstance(name, str) and name and isinstance(type_, str) and type_):
                problems.append(Problem(item.line, f"an entry of `{section}` lacks a name or a type"))
                continue
            qos = {key: node.value for key, node in _get_fields(fields.get("qos")).items() if node.kind == "scalar"}
            endpoints.append(NodlEndpoint(section, name, type_, fields["name"].line, qos))
    includes = (_get_fields(item).get("ref") for item in _list_items(top.get("include")))
    return NodlFile(
        version if isinstance(version, int) else 0, tuple(endpoints),
        tuple(str(one.value) for one in includes if one is not None), tuple(problems),
    )  # fmt: skip


def _get_fields(node: YamlNode | None) -> dict[str, YamlNode]:
    return dict(node.value) if node is not None and node.kind == "map" else {}


def _list_items(node: YamlNode | None) -> Iterator[YamlNode]:
    return iter(node.value if node is not None and node.kind == "list" else ())
