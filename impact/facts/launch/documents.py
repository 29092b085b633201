"""Launch files in XML and YAML as one kind of document, so that what reads them need not know which it is."""

import re
from typing import Any

from ..markup import Attribute, Document, Element, decode, scan
from ..place import Problem
from .parameter_files import MOST_ENTRIES, YamlNode, parse_yaml_tree

KINDS_2 = {
    "let": "let",
    "lifecycle_node": "lifecycle",
    "node_container": "container",
    "composable_node_container": "container",
    "composable_node": "composable",
    "load_composable_node": "load",
    "push_ros_namespace": "namespace",
    "push-ros-namespace": "namespace",
    "set_remap": "remap",
    "set_parameter": "parameter",
    "set_parameters_from_file": "parameter-file",
    "set_use_sim_time": "parameter",
    "set_env": "environment",
    "executable": "process",
    "timer": "group",
}
"""What an element of ROS 2 alone stands for, by its name."""
_ONLY_1 = re.compile(r"\$\((?:find|arg|optenv) ")
_ONLY_2 = re.compile(r"\$\((?:var|find-pkg-share|find-pkg-prefix|find-exec|exec-in-pkg|not|and|or|equals|not-equals) ")
_TAGS_1 = frozenset({"rosparam", "test", "machine"})


def read_document(data: bytes, kind: str) -> Document:
    """The elements of a launch file of the kind launch_xml or launch_yaml; none of a YAML file without a `launch:`
    list. An attribute that is a list in YAML stands once for each item. Raises RecursionError alone."""
    if kind != "launch_yaml":
        return scan(data)
    text = decode(data)
    root, problems = parse_yaml_tree(text)
    body = dict(root.value).get("launch") if root is not None and root.kind == "map" else None
    elements: list[Element] = []
    if body is not None:
        elements.append(Element("launch", (), body.offset, -1, body.offset))
        _add_listed(body, elements, 0)
        if len(elements) >= MOST_ENTRIES:
            problems.append(Problem(1, f"has more than {MOST_ENTRIES} elements"))
    return Document(text, elements, tuple(problems))


def _add_listed(node: YamlNode, elements: list[Element], parent: int) -> None:
    """Adds the elements of a list of one-key mappings, or of one mapping."""
    for item in node.value if node.kind == "list" else [node]:
        for tag, body in item.value if item.kind == "map" else ():
            _add(tag, body, elements, parent)


def _add(tag: str, body: YamlNode, elements: list[Element], parent: int) -> None:
    """Adds an element and all below it."""
    if len(elements) >= MOST_ENTRIES:  # a node may stand in many places
        return
    element = Element(tag, (), body.offset, parent, body.offset)
    place = len(elements)
    elements.append(element)
    elements[parent].children.append(element)
    if body.kind == "list":
        _add_listed(body, elements, place)
    elif body.kind == "scalar":
        element.text = _format_scalar(body.value)
    for key, value in body.value if body.kind == "map" else ():
        listed = value.kind == "list"
        items = value.value if listed else [value]
        if key == "children" and value.kind != "scalar":
            _add_listed(value, elements, place)
        elif all(item.kind == "scalar" for item in items):
            given = [Attribute(key, _format_scalar(item.value), item.offset, listed) for item in items]
            element.attributes += tuple(given) or (Attribute(key, "[]", value.offset),)
        else:
            for item in items:
                _add(key, item, elements, place)


def _format_scalar(value: Any) -> str:
    """A scalar as launch would write it."""
    if value is None:
        return ""
    return ("true" if value else "false") if isinstance(value, bool) else str(value)


def find_generation(document: Document) -> int:
    """1 or 2 by what only that generation writes, 0 where nothing tells."""
    counts = [0, 0, 0]
    for element in document.elements:
        names = {a.name for a in element.attributes}
        if element.name in _TAGS_1 or "ns" in names or (element.name == "node" and "type" in names):
            counts[1] += 1
        elif element.name in KINDS_2 or names & {"exec", "namespace"} or (element.name == "param" and "from" in names):
            counts[2] += 1
        for attribute in element.attributes:
            if "$(" in attribute.value:
                counts[1] += bool(_ONLY_1.search(attribute.value))
                counts[2] += bool(_ONLY_2.search(attribute.value))
    return 1 if counts[1] > counts[2] else 2 if counts[2] else 0
