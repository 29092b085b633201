"""Launch files in XML and YAML as one kind of document, so that what reads them need not know which it is."""

from __future__ import annotations

from typing import Any

from ..markup import Attribute, Document, Element, decode, scan
from ..place import Problem
from .parameter_files import MOST_ENTRIES, YamlNode, yaml_tree


def read_document(data: bytes, kind: str) -> Document:
    """The elements of a launch file of the kind launch_xml or launch_yaml; none of a YAML file without a `launch:`
    list. An attribute that is a list in YAML stands once for each item. Raises RecursionError alone."""
    if kind != "launch_yaml":
        return scan(data)
    text = decode(data)
    root, problems = yaml_tree(text)
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
    if body.kind == "list":
        _add_listed(body, elements, place)
    elif body.kind == "scalar":
        element.text = _as_text(body.value)
    for key, value in body.value if body.kind == "map" else ():
        listed = value.kind == "list"
        items = value.value if listed else [value]
        if key == "children" and value.kind != "scalar":
            _add_listed(value, elements, place)
        elif all(item.kind == "scalar" for item in items):
            given = [Attribute(key, _as_text(item.value), item.offset, listed) for item in items]
            element.attributes += tuple(given) or (Attribute(key, "[]", value.offset),)
        else:
            for item in items:
                _add(key, item, elements, place)


def _as_text(value: Any) -> str:
    """A scalar as launch would write it."""
    if value is None:
        return ""
    return ("true" if value else "false") if isinstance(value, bool) else str(value)
