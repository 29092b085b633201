"""What a launch file starts and sets, as written, whatever its syntax."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from ..place import Problem


class ValuePart(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A part of a value. text: by kind; parts: values it is made of.

    Where a name may itself be computed (`$(find-pkg-share $(var robot))`) text is empty and the name is parts[0].

    | kind | text | parts |
    |---|---|---|
    | text | the literal | |
    | arg | name of a launch argument or configuration | its own default, if it brings one |
    | env | name of an environment variable | its own default, if it brings one |
    | find | package, for its share folder | |
    | prefix | package, for the folder it is installed in | |
    | executable | | name, package |
    | program | name of a program on the search path | |
    | dirname, filename | | |
    | anon | what an anonymous name starts with | |
    | eval | `roslaunch` or `launch`: whose rules the expression follows | the expression |
    | command | | the command line whose output it is |
    | content | | the path of the file whose content it is |
    | yaml | | the path of a YAML file, then the keys that lead to the value in it |
    | has-node | | a parameter file, the name of a node: whether it has parameters for it |
    | join | | parts of a path |
    | equals, and, or, in | | two values; values; values; what is sought and the values it may be |
    | not | | a value |
    | choose | | condition, value if it is true, value if not |
    | method | name of a method of str | the text it is called on, its arguments |
    | rewritten | | a parameter file, its root key, then name and value of each parameter it changes |
    | replaced | | a text file, then each text and what replaces it |
    | other | the source, at most 120 characters | |
    """

    kind: str
    text: str = ""
    parts: tuple[tuple[ValuePart, ...], ...] = ()


Value = tuple[ValuePart, ...]


class ActionCondition(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What an action hangs on. kind: `if` or `unless` the value is true; `each` once for each of what is walked
    through; `after` an event or some time, which the value describes."""

    kind: str
    value: Value
    line: int


class Action(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Something a launch file does. attributes: (name, value), in the file's order, under the names of this table.

    | kind | attributes | children |
    |---|---|---|
    | argument | name, default, value (ROS 1: constant) | |
    | let | name, value | |
    | pass | name, value: an argument given to an include | |
    | node, lifecycle, test | package, executable, name, namespace, arguments (several), clear | remap, parameter,
      parameter-file, environment |
    | container | as node | as node, and composable |
    | composable | package, plugin, name, namespace | remap, parameter, parameter-file |
    | load | container: its full name, or container-node: the name of a container of the same file, before the
      namespaces that are pushed | composable |
    | include | file, namespace, pass-all (ROS 1), clear, optional: only if it is there | pass, environment |
    | group | namespace (ROS 1), scoped, forwarding, clear | any |
    | namespace | namespace: pushed for what follows | |
    | remap | from, to | |
    | parameter | name, value, type; instead of value: textfile, binfile, command | |
    | parameter-file | file or text (YAML), name (below which), command, substitute; below (several): keys in the file
      whose values alone are given, as plain parameters | |
    | environment | name, value | |
    | process | command (several) | |
    | unknown | text: what could not be followed | |
    """

    kind: str
    line: int
    attributes: tuple[tuple[str, Value], ...] = ()
    conditions: tuple[ActionCondition, ...] = ()
    children: tuple[Action, ...] = ()

    def get(self, name: str) -> Value | None:
        """The first attribute of a name, None when there is none."""
        return next((value for key, value in self.attributes if key == name), None)

    def list_values(self, name: str) -> tuple[Value, ...]:
        """All attributes of a name."""
        return tuple(value for key, value in self.attributes if key == name)


class LaunchFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """language: `xml`, `yaml` or `python`. generation: 1 or 2, 0 where an XML file could be of either. imports: what a
    file in Python imports, dotted, other than of launch itself."""

    language: str
    generation: int
    actions: tuple[Action, ...] = ()
    problems: tuple[Problem, ...] = ()
    imports: tuple[str, ...] = ()


SHOWN = 120
TEXT_METHODS = frozenset(
    ("lower", "upper", "strip", "lstrip", "rstrip", "startswith", "endswith", "replace", "capitalize", "title",
     "removeprefix", "removesuffix"),
)  # fmt: skip
"""The methods of str that a value may be the result of."""


def make_literal(text: str) -> Value:
    """A value that is plain text."""
    return (ValuePart("text", text),)


def find_literal(value: Value | None) -> str | None:
    """The text of a value that is all literal, None for any other."""
    if value is None or any(piece.kind != "text" for piece in value):
        return None
    return "".join(piece.text for piece in value)


def join_all(values: Iterator[Value] | list[Value] | tuple[Value, ...]) -> Value:
    """Values one after the other as one, literal neighbours joined."""
    pieces: list[ValuePart] = []
    for value in values:
        for piece in value:
            if piece.kind == "text" and pieces and pieces[-1].kind == "text":
                pieces[-1] = ValuePart("text", pieces[-1].text + piece.text)
            elif piece.kind != "text" or piece.text:
                pieces.append(piece)
    return tuple(pieces) or make_literal("")


def make_named(kind: str, name: Value, *rest: Value) -> ValuePart:
    """A piece whose name may be computed."""
    text = find_literal(name)
    return ValuePart(kind, text, rest) if text else ValuePart(kind, "", (name, *rest))


def make_other(source: str) -> ValuePart:
    """A piece that could not be read."""
    return ValuePart("other", " ".join(source.split())[:SHOWN])


BRIDGE_FILE: Value = (ValuePart("find", "ros_gz_bridge"), ValuePart("text", "/launch/ros_gz_bridge.launch.py"))
"""What the action of ros_gz_bridge includes."""
