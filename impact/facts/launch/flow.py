"""What one launch file starts and sets, as written: XML of both generations and YAML here, Python in its own module.

All of them give the same facts, so that whatever follows a launch need not know which it reads. Nothing is resolved:
values are sequences of pieces.
"""

from __future__ import annotations

import re

from ..markup import TOKEN, Document, Element, unescape
from ..place import Problem
from .actions import (
    BRIDGE_FILE,
    Action,
    ActionCondition,
    LaunchFile,
    Value,
    ValuePart,
    join_all,
    make_literal,
    make_named,
    make_other,
)
from .documents import KINDS_2, find_generation, read_document
from .parameter_files import DEEPEST


def extract(data: bytes, kind: str) -> LaunchFile:
    """The facts of a launch file of the kind launch_xml, launch_yaml or launch_python, or the same with `flow_` before
    it. Never raises."""
    kind = kind.removeprefix("flow_")
    if kind == "launch_python":
        from .python import extract as extract_python

        return extract_python(data)
    try:
        return _launch(data, kind)
    except RecursionError:
        return LaunchFile(kind.removeprefix("launch_"), 0, (), (Problem(1, "nested too deeply to be read"),))


_ROS1 = re.compile(r"\$\(([^$()]*)\)")


def parse_substitutions(text: str, generation: int) -> Value:
    """A text of a launch or parameter file as a value, by the rules of ROS 1 (roslaunch) or ROS 2 (launch)."""
    if "$(" not in text:
        return make_literal(text)
    return _parse_ros1(text) if generation == 1 else _Template(text).parse_value()


def _parse_ros1(text: str) -> Value:
    if text.startswith("$(eval ") and text.endswith(")"):
        return (ValuePart("eval", "roslaunch", (make_literal(text[7:-1]),)),)
    values: list[Value] = []
    at = 0
    for m in _ROS1.finditer(text):
        values += (_parse_between(text[at : m.start()]), (_parse_ros1_piece(m[1].split(), m[0]),))
        at = m.end()
    values.append(_parse_between(text[at:]))
    return join_all(values)


def _parse_between(text: str) -> Value:
    """Text between substitutions; one that opens a substitution and is none cannot be read."""
    return (make_other(text),) if "$(" in text else make_literal(text)


def _parse_ros1_piece(words: list[str], source: str) -> ValuePart:
    verb, args = (words[0], words[1:]) if words else ("", [])
    if verb in ("arg", "anon", "env", "find") and len(args) == 1:
        return ValuePart(verb, args[0])
    if verb == "optenv" and args:
        return ValuePart("env", args[0], (make_literal(" ".join(args[1:])),))
    if verb == "dirname" and not args:
        return ValuePart("dirname")
    return make_other(source)


_IDENTIFIER = re.compile(r"[A-Za-z][\w-]*")
# What ends nothing and begins nothing, wherever it stands.
_PLAIN = re.compile(r"[\w./:,;=+*-]+")


class _Template:
    """A text with launch's substitutions, by the grammar of launch/frontend/grammar.lark."""

    def __init__(self, text: str):
        self.text = text
        self.at = 0

    def parse_value(self, depth: int = 0, quote: str = "", quoted: bool = True) -> Value:
        """Literals and substitutions up to a closing quote or, outside of quotes, a blank or bracket; or to the end.
        quote: in which this stands."""
        values: list[Value] = []
        text = self.text
        while self.at < len(text):
            plain = _PLAIN.match(text, self.at)
            if plain is not None:
                values.append(make_literal(plain[0]))
                self.at = plain.end()
                continue
            c = text[self.at]
            if c == quote if quoted else c == ")" or c.isspace():
                break
            if text.startswith("$(", self.at):
                values.append((self._parse_substitution(depth + 1, quote),))
                continue
            step = 2 if c == "\\" and self.at + 1 < len(text) else 1
            values.append(make_literal(text[self.at + step - 1]))
            self.at += step
        return join_all(values)

    def _parse_substitution(self, depth: int, quote: str) -> ValuePart:
        begin = self.at
        m = _IDENTIFIER.match(self.text, begin + 2)
        if m is None or depth > DEEPEST:
            self.at = len(self.text)
            return make_other(self.text[begin:])
        self.at = m.end()
        args: list[Value] = []
        while self.at < len(self.text):
            c = self.text[self.at]
            if c == ")":
                self.at += 1
                return _parse_ros2_piece(m[0], args, self.text[begin : self.at])
            if c.isspace():
                self.at += 1
            elif c in "'\"" and c != quote:
                self.at += 1
                args.append(self.parse_value(depth, c))
                self.at += 1
            else:
                args.append(self.parse_value(depth, quote, False))
        return make_other(self.text[begin:])


def _parse_ros2_piece(verb: str, args: list[Value], source: str) -> ValuePart:
    if verb in _ROS2_NAMED and 1 <= len(args) <= 2:
        return make_named(_ROS2_NAMED[verb], *args)
    if verb in ("find-pkg-share", "find-pkg-prefix", "find-exec", "anon") and len(args) == 1:
        return make_named(_ROS2_PLACES.get(verb, verb), args[0])
    if verb == "eval" and args:
        return ValuePart("eval", "launch", (join_with_separator(args),))
    if verb == "command" and args:
        return ValuePart("command", "", (args[0],))
    if verb == "not-equals" and len(args) == 2:
        return ValuePart("not", "", ((ValuePart("equals", "", tuple(args)),),))
    if verb == "if" and len(args) == 2:
        args = [*args, make_literal("")]
    kind, numbers = _ROS2_PIECES.get(verb, ("", ()))
    return ValuePart(kind, "", tuple(args)) if numbers is None or len(args) in numbers else make_other(source)


_ROS2_PLACES = {"find-pkg-share": "find", "find-pkg-prefix": "prefix", "find-exec": "program"}
_ROS2_NAMED = {"var": "arg", "env": "env", "optenv": "env"}
# What others are here, and how many arguments they take; None for any number.
_ROS2_PIECES: dict[str, tuple[str, tuple[int, ...] | None]] = {
    "exec-in-pkg": ("executable", (2,)), "dirname": ("dirname", (0,)), "filename": ("filename", (0,)),
    "file-content": ("content", (1,)), "equals": ("equals", (2,)), "not": ("not", (1,)), "if": ("choose", (3,)),
    "and": ("and", None), "all": ("and", None), "or": ("or", None), "any": ("or", None),
}  # fmt: skip


def join_with_separator(values: list[Value], separator: str = " ") -> Value:
    """Values as one, with a separator between them."""
    return join_all([part for value in values for part in (make_literal(separator), value)][1:])


def _launch(data: bytes, kind: str) -> LaunchFile:
    document = read_document(data, kind)
    is_yaml = kind == "launch_yaml"
    language = "yaml" if is_yaml else "xml"
    if not document.elements or document.elements[0].name != "launch":
        lacking = Problem(1, "has no `launch:` list" if is_yaml else "has no `<launch>` element")
        return LaunchFile(language, 2 if is_yaml else 0, (), (*document.problems, lacking))
    generation = 2 if is_yaml else find_generation(document)
    reader = _Reader(document, is_yaml, generation)
    actions = reader.read_actions(document.elements[0].children)
    return LaunchFile(language, generation, actions, (*document.problems, *reader.problems))


_BLANK = re.compile(r"\r\n|[\r\n\t]")
_COMMENT_OR_CDATA = re.compile(r"<!--.*?(?:-->|\Z)|<!\[CDATA\[(.*?)\]\]>", re.DOTALL)


def _read_own_text(document: Document, element: Element) -> str:
    """The text of an element without children as it stands, line ends around comments included: YAML needs them."""
    opened = TOKEN.match(document.text, element.offset)
    start = opened.end() if opened is not None else element.offset
    end = document.text.find("</", start)
    raw = document.text[start : end if end >= 0 else len(document.text)]
    return unescape(_COMMENT_OR_CDATA.sub(lambda m: m[1] or "", raw))


_KINDS = {
    **KINDS_2,
    "node": "node",
    "test": "test",
    "include": "include",
    "arg": "argument",
    "group": "group",
    "remap": "remap",
    "param": "parameter",
    "rosparam": "parameter-file",
    "env": "environment",
}
# What starts nothing and sets nothing that a node could read.
_IDLE = frozenset(
    ("machine", "master", "log", "log_info", "shutdown", "unset_env", "reset", "keep", "extra_arg", "append_env",
     "prepend_env", "set_ros_log_dir", "launch", "lifecycle_transition", "description", "on_exit", "emit_event"),
)  # fmt: skip
_ATTRIBUTES = {
    "pkg": "package",
    "type": "executable",
    "exec": "executable",
    "node-name": "name",
    "test-name": "test-name",
    "ns": "namespace",
    "args": "arguments",
    "clear_params": "clear",
    "pass_all_args": "pass-all",
    "target": "container",
    "cmd": "command",
    "subst_value": "substitute",
    "allow_substs": "substitute",
    "filename": "file",
    "from": "from",
    "to": "to",
    **{
        name: name
        for name in (
            *("plugin", "name", "namespace", "file", "value", "default", "command", "textfile", "binfile"),
            *("scoped", "forwarding"),
        )
    },
}


class _Reader:
    """Elements to actions."""

    def __init__(self, document: Document, is_yaml: bool, generation: int):
        self.document, self.is_yaml, self.generation = document, is_yaml, generation
        self.problems: list[Problem] = []
        self.depth = 1

    def read_actions(
        self, elements: list[Element], inside: str = "", above: tuple[Value, ...] = ()
    ) -> tuple[Action, ...]:
        """inside: the kind of the action around. above: what the names of parameters begin with."""
        if self.depth == DEEPEST:
            self.problems += (Problem(self.find_line(one), f"nested more than {DEEPEST} deep") for one in elements)
            return ()
        self.depth += 1
        found = [action for element in elements for action in self.read_action(element, inside, above)]
        self.depth -= 1
        return tuple(found)

    def find_line(self, element: Element) -> int:
        return self.document.locate(element.offset)[0]

    def read_values(self, element: Element) -> dict[str, Value]:
        """The values of attributes by their names; the first of two of a name counts."""
        found: dict[str, Value] = {}
        lists: dict[str, list[Value]] = {}
        for name, text, _, listed in element.attributes:
            # XML's readers make blanks of line ends and tabs in values.
            value = parse_substitutions(text if self.is_yaml else _BLANK.sub(" ", text), self.generation)
            found.setdefault(name, value)
            if listed:
                lists.setdefault(name, []).append(value)
        for name, items in lists.items():
            found[name] = join_all([make_literal("["), join_with_separator(items, ", "), make_literal("]")])
        return found

    def read_action(self, element: Element, inside: str, above: tuple[Value, ...]) -> tuple[Action, ...]:
        tag, line, values = element.name.lower(), self.find_line(element), self.read_values(element)
        conditions = tuple(
            ActionCondition(kind, values[kind], line) for kind in ("if", "unless") if kind in values
        )
        if tag == "ros_gz_bridge":
            given = ((("name", make_literal(name)), ("value", value)) for name, value in values.items())
            passed = tuple(Action("pass", line, pair) for pair in given)
            return (Action("include", line, (("file", BRIDGE_FILE),), conditions, passed),)
        kind = _KINDS.get(tag)
        if kind is None:
            text = make_literal(f"<{tag}>")
            return () if tag in _IDLE else (Action("unknown", line, (("text", text),), conditions),)
        if inside == "include" and kind in ("argument", "let"):
            kind = "pass"
        if tag == "param" and "from" in values:
            kind = "parameter-file"
        attributes = _list_attributes(values, kind)
        if tag == "set_use_sim_time":
            attributes.insert(0, ("name", make_literal("use_sim_time")))
        if kind == "parameter":
            attributes = [(key, join_all([*above, value]) if key == "name" else value) for key, value in attributes]
            nested = [child for child in element.children if child.name.lower() == "param"]
            if nested:  # whose names are joined by dots
                name = dict(attributes).get("name", join_all(above))
                return self.read_actions(nested, "", (name, make_literal(".")))
            return (Action(kind, line, tuple(attributes), conditions),)
        if tag == "timer":
            period = join_all([values.get("period", make_literal("")), make_literal(" s")])
            conditions = (*conditions, ActionCondition("after", period, line))
        if tag == "rosparam" and element.text:
            text = _read_own_text(self.document, element)
            fill = "subst_value" in values
            attributes.append(("text", parse_substitutions(text, self.generation) if fill else make_literal(text)))
        return (Action(kind, line, tuple(attributes), conditions, self.read_actions(element.children, kind)),)


def _list_attributes(values: dict[str, Value], kind: str) -> list[tuple[str, Value]]:
    """The attributes of an action from those of its element."""
    if kind in ("test", "node") and "test-name" in values:
        values.setdefault("name", values.pop("test-name"))
    found: list[tuple[str, Value]] = []
    for name, value in values.items():
        if kind == "parameter-file":
            # ROS 1's `ns` and `param` name what the file is loaded below, ROS 2's `from` the file
            key = {"from": "file", "param": "name"}.get(name) or _ATTRIBUTES.get(name)
            if key == "name" and "ns" in values:
                continue
            if name == "ns":
                below = [value]
                if "param" in values:
                    below += (make_literal("/"), values["param"])
                found.append(("name", join_all(below)))
                continue
        elif kind == "parameter" and name == "type":
            key = "type"
        elif name == "ros_args":
            found += [("arguments", make_literal("--ros-args"))]
            key = "arguments"
        else:
            key = _ATTRIBUTES.get(name)
        if key == "arguments" or (key == "command" and kind == "process"):
            found += [(key, word) for word in split_command_line(value)]
        elif key is not None:
            found.append((key, value))
    return found


def split_command_line(value: Value) -> list[Value]:
    """A command line as its words, split at the blanks of its literal pieces outside quotes; quotes are taken off."""
    found: list[Value] = []
    word: list[Value] = []
    quote, begun = "", False
    for piece in value:
        for part in piece.text if piece.kind == "text" else (piece,):
            if not isinstance(part, str):
                word.append((part,))
                begun = True
            elif part == quote:
                quote = ""
            elif not quote and part in "'\"":
                quote, begun = part, True
            elif not quote and part.isspace():
                found += [join_all(word)] if begun else []
                word, begun = [], False
            else:
                word.append(make_literal(part))
                begun = True
    return [*found, join_all(word)] if begun else found
