"""msg, srv, action and IDL definitions to facts."""

import re
from typing import NamedTuple

import msgspec

from .markup import Document, decode
from .place import Problem


class Field(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A field. type is as written without array part (`geometry_msgs/Point`, `string<=10`); array is ``, `[]`, `[3]`
    or `[<=3]`; default as written or empty. comment: the comment lines right above and the one behind it, without
    their marks. annotations: as written, `@` included."""

    name: str
    type: str
    array: str
    default: str
    line: int
    column: int = 0
    comment: str = ""
    annotations: tuple[str, ...] = ()


class Constant(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A constant; value as written. An unquoted string constant reaches to the end of its line, `#` included."""

    name: str
    type: str
    value: str
    line: int
    column: int = 0


class Section(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One part of a definition: `message`; `request` and `response`; `goal`, `result` and `feedback`."""

    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]


class Interface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A definition. kind is msg, srv, action or idl (then `name` and `module` come from the text).

    Types of an IDL file are given in the words of .msg files (`geometry_msgs/msg/Point`, `float64`, `string<=10`), so
    that both compare. A further struct of an IDL file is a section of its own name. unread: line and text of what is
    neither a field nor a constant; each is a problem too.
    """

    kind: str
    sections: tuple[Section, ...]
    name: str = ""
    problems: tuple[Problem, ...] = ()
    module: str = ""
    unread: tuple[tuple[int, str], ...] = ()


PRIMITIVES = frozenset({
    "bool", "byte", "char", "octet", "wchar", "string", "wstring", "float32", "float64", "float128",
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
})  # fmt: skip
"""Types of fields that are no interfaces, in .msg and IDL files of ROS 2; ROS 1 has `time` and `duration` besides."""
TIMES = frozenset(("time", "duration"))
"""What ROS 1 has besides, and ROS 2 as messages of builtin_interfaces."""
SECTIONS = {"msg": ("message",), "srv": ("request", "response"), "action": ("goal", "result", "feedback")}


def make_full_name(type_: str, package: str) -> str:
    """`package/Name` of the message that a field's type names, as either generation of ROS writes it. type_: no
    primitive type, without bounds. package: whose definition it stands in."""
    if type_ == "Header":
        return "std_msgs/Header"
    if type_ in TIMES:
        return f"builtin_interfaces/{type_.title()}"
    plain = type_.replace("/msg/", "/")
    return plain if "/" in plain else f"{package}/{plain}"


# The grammar of http://wiki.ros.org/msg and https://docs.ros.org/en/rolling/Concepts/Basic/About-Interfaces.html
DECLARATION = re.compile(
    r"(?P<type>[A-Za-z][\w/]*(?:<=[0-9]+)?)(?P<array>\[(?:<=)?[0-9]*\])?\s+(?P<name>[A-Za-z_]\w*)"
    r"(?:\s*=(?P<constant>.*)|\s+(?P<default>[^\s#].*)|\s*(?:\#.*)?)$"
)
ANNOTATION = re.compile(r"@[A-Za-z_]\w*(?:\((?:[^()\"]|\"[^\"]*\")*\))?\s*")
BEFORE_COMMENT = re.compile(r"(?:[^#\"']|\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'|[\"'])*")
QUOTED = re.compile(r"\s*(\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*')\s*(?:\#.*)?$")


def extract(data: bytes, kind: str) -> Interface:
    """Facts of a definition of the kind msg, srv, action or idl; never raises. A line that is neither a field nor a
    constant is a problem, the others count."""
    text = decode(data)
    return _parse_idl(text) if kind == "idl" else _parse_ros(text, kind)


def _parse_ros(text: str, kind: str) -> Interface:
    names = SECTIONS[kind]
    sections: list[Section] = []
    fields: list[Field] = []
    constants: list[Constant] = []
    problems: list[Problem] = []
    unread: list[tuple[int, str]] = []
    above: list[str] = []
    annotations: list[str] = []
    for number, raw in enumerate(text.split("\n"), 1):
        line = raw.strip()
        if not line:
            above.clear()
            continue
        if line[0] == "#":
            above.append(line.lstrip("#").strip())
            continue
        if line.startswith("---"):
            if len(sections) + 1 < len(names):
                sections.append(Section(names[len(sections)], tuple(fields), tuple(constants)))
                fields, constants = [], []
            else:
                problems.append(
                    Problem(number, f"has more than {len(names)} parts, which is all a .{kind} file may have")
                )
            above.clear()
            continue
        column = len(raw) - len(raw.lstrip()) + 1
        while line.startswith("@"):
            annotation = ANNOTATION.match(line)
            if annotation is None:
                break
            annotations.append(annotation.group().strip())
            line = line[annotation.end() :]
            column += annotation.end()
        if not line or (line[0] == "#" and annotations):
            continue
        found = DECLARATION.match(line)
        if found is None:
            problems.append(Problem(number, f"`{_shorten(line)}` is neither a field nor a constant"))
            unread.append((number, line))
            above.clear()
            annotations.clear()
            continue
        type_, name = found["type"], found["name"]
        value = found["constant"]
        if value is not None:
            constants.append(Constant(name, type_, _normalize_constant(type_, value), number, column))
        else:
            default, comment = "", line[found.end("name") :].strip()
            if found["default"] is not None:
                rest = found["default"]
                cut = BEFORE_COMMENT.match(rest)
                end = cut.end() if cut is not None else len(rest)
                default, comment = rest[:end].strip(), rest[end:]
            behind = comment.lstrip("#").strip()
            comment = "\n".join([*above, behind] if behind else above)
            fields.append(
                Field(name, type_, found["array"] or "", default, number, column, comment, tuple(annotations))
            )
        above.clear()
        annotations.clear()
    sections.append(Section(names[len(sections)], tuple(fields), tuple(constants)))
    if len(sections) < len(names):
        missing = names[len(sections) :]
        last = text.count("\n") + (0 if text.endswith("\n") else 1)
        problems.append(Problem(max(last, 1), f"has no `---` before its {' and '.join(missing)}"))
        sections.extend(Section(name, (), ()) for name in missing)
    return Interface(kind, tuple(sections), "", tuple(problems), unread=tuple(unread))


def _shorten(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def _normalize_constant(type_: str, value: str) -> str:
    if type_.startswith(("string", "wstring")):
        quoted = QUOTED.match(value)
        return quoted.group(1) if quoted is not None else value.strip()
    return value.partition("#")[0].strip()


# A string that is never closed ends with the file, or the line: it is not looked at again from each mark in it.
IDL_TOKEN = re.compile(
    r"(?P<space>\s+)|(?P<comment>//[^\n]*|/\*.*?(?:\*/|\Z))|(?P<directive>\#[^\n]*)"
    r"|(?P<string>L?\"(?:[^\"\\]|\\.)*(?:\"|\\?\Z)|'(?:[^'\\\n]|\\.)*(?:'|(?=\n)|\\?\Z))"
    r"|(?P<annotation>@\s*[A-Za-z_]\w*)"
    r"|(?P<name>(?:::)?[A-Za-z_]\w*(?:\s*::\s*[A-Za-z_]\w*)*)|(?P<number>[-+]?[0-9.][0-9A-Za-z.]*)|(?P<mark>.)",
    re.DOTALL,
)
# https://design.ros2.org/articles/idl_interface_definition.html
IDL_TYPES = {
    "boolean": "bool",
    "octet": "byte",
    "char": "uint8",
    "wchar": "wchar",
    "float": "float32",
    "double": "float64",
    "long double": "float128",
    "short": "int16",
    "unsigned short": "uint16",
    "long": "int32",
    "unsigned long": "uint32",
    "long long": "int64",
    "unsigned long long": "uint64",
}
IDL_PARTS = {
    "Request": ("srv", "request"),
    "Response": ("srv", "response"),
    "Goal": ("action", "goal"),
    "Result": ("action", "result"),
    "Feedback": ("action", "feedback"),
}


class _Token(NamedTuple):
    kind: str
    text: str
    offset: int


class _Unreadable(Exception):
    """The tokens from here on do not form what was expected."""


class _Idl:
    """A cursor over the tokens of an IDL file, and what has been read so far."""

    def __init__(self, text: str):
        self.text = text
        self.locate = Document(text).locate
        self.tokens = [
            _Token(m.lastgroup or "mark", m.group(), m.start())
            for m in IDL_TOKEN.finditer(text)
            if m.lastgroup not in ("space", "comment", "directive")
        ]
        self.at = 0
        self.modules: list[str] = []
        self.typedefs: dict[str, tuple[str, str]] = {}
        self.structs: list[tuple[str, tuple[str, ...], list[Field]]] = []
        self.constants: dict[str, list[Constant]] = {}
        self.problems: list[Problem] = []

    def peek(self) -> str:
        return self.tokens[self.at].text if self.at < len(self.tokens) else ""

    def take_token(self) -> _Token:
        if self.at >= len(self.tokens):
            raise _Unreadable("ends in the middle")
        self.at += 1
        return self.tokens[self.at - 1]

    def start(self) -> int:
        """Offset of the next token."""
        if self.at >= len(self.tokens):
            raise _Unreadable("ends in the middle")
        return self.tokens[self.at].offset

    def expect(self, text: str) -> None:
        token = self.take_token()
        if token.text != text:
            raise _Unreadable(f"`{_shorten(token.text)}` stands where `{text}` should")

    def take_word(self) -> _Token:
        token = self.take_token()
        if token.kind != "name":
            raise _Unreadable(f"`{_shorten(token.text)}` stands where a name should")
        return token

    def get_line(self) -> int:
        at = min(self.at, len(self.tokens)) - 1
        return self.locate(self.tokens[at].offset)[0] if self.tokens else 1


def _parse_idl(text: str) -> Interface:
    idl = _Idl(text)
    annotations: list[str] = []
    while idl.at < len(idl.tokens):
        try:
            _parse_idl_item(idl, annotations)
        except _Unreadable as error:
            idl.problems.append(Problem(idl.get_line(), str(error)))
            annotations.clear()
            while idl.at < len(idl.tokens) and idl.take_token().text not in (";", "}"):
                pass
    if idl.modules and not idl.problems:
        idl.problems.append(Problem(idl.get_line(), "ends in the middle"))
    return _assemble(idl)


def _parse_idl_item(idl: _Idl, annotations: list[str]) -> None:
    """One step at module level: opens or closes a module, or reads a struct, constant or typedef."""
    token = idl.tokens[idl.at]
    if token.kind == "annotation":
        annotations.append(_parse_annotation(idl))
        return
    idl.take_token()
    if token.text == "module":
        idl.modules.append(idl.take_word().text)
        idl.expect("{")
    elif token.text == "}":
        if idl.modules:
            idl.modules.pop()
    elif token.text == "struct":
        _parse_struct(idl)
    elif token.text == "const":
        start = idl.start()
        type_ = _parse_type(idl)[0]
        name = idl.take_word()
        idl.expect("=")
        first = idl.take_token()
        last = first
        while idl.peek() not in (";", ""):
            last = idl.take_token()
        value = idl.text[first.offset : last.offset + len(last.text)]
        idl.expect(";")
        owner = idl.modules[-1] if idl.modules else ""
        idl.constants.setdefault(owner, []).append(Constant(name.text, type_, value, *idl.locate(start)))
    elif token.text == "typedef":
        type_, array = _parse_type(idl)
        name = idl.take_word().text
        own = _parse_bounds(idl)
        idl.typedefs[name] = (type_, own or array)
        idl.expect(";")
    elif token.text == "enum":
        idl.take_word()
        while idl.take_token().text != "}":
            pass
    elif token.text != ";":
        raise _Unreadable(f"`{_shorten(token.text)}` opens nothing that ROS interfaces are made of")
    annotations.clear()


def _parse_annotation(idl: _Idl) -> str:
    first = idl.take_token()
    end = first.offset + len(first.text)
    if idl.peek() == "(":
        depth = 0
        while True:
            token = idl.take_token()
            depth += (token.text == "(") - (token.text == ")")
            if depth == 0:
                end = token.offset + 1
                break
    return idl.text[first.offset : end]


def _parse_struct(idl: _Idl) -> None:
    name = idl.take_word().text
    fields: list[Field] = []
    idl.structs.append((name, tuple(idl.modules), fields))
    idl.expect("{")
    annotations: list[str] = []
    while idl.peek() != "}":
        if idl.at < len(idl.tokens) and idl.tokens[idl.at].kind == "annotation":
            annotations.append(_parse_annotation(idl))
            continue
        start = idl.start()
        type_, array = _parse_type(idl)
        while True:
            field = idl.take_word()
            own = _parse_bounds(idl)
            default = next((_parse_argument(a) for a in annotations if a.startswith("@default")), "")
            comment = next((_parse_argument(a) for a in annotations if a.startswith("@verbatim")), "")
            fields.append(
                Field(field.text, type_, own or array, default, *idl.locate(start), comment, tuple(annotations))
            )
            if idl.peek() != ",":
                break
            idl.take_token()
        annotations.clear()
        idl.expect(";")
    idl.expect("}")


STRINGS = re.compile(r"\"((?:[^\"\\]|\\.)*)(?:\"|\\?\Z)")


def _parse_argument(annotation: str) -> str:
    """The value of `@default (value=1)`, or the text of `@verbatim (language="comment", text="a" "b")`."""
    if annotation.startswith("@verbatim"):
        return "".join(STRINGS.findall(annotation.partition("text")[2])).replace("\\n", "\n")
    return annotation.partition("=")[2].rstrip(") \t\n").strip()


def _parse_type(idl: _Idl) -> tuple[str, str]:
    """A type in the words of .msg files, and its array part."""
    word = idl.take_word().text
    if word == "sequence":
        idl.expect("<")
        inner, array = _parse_type(idl)
        bound = ""
        if idl.peek() == ",":
            idl.take_token()
            bound = "<=" + idl.take_token().text
        idl.expect(">")
        if array:
            raise _Unreadable("a sequence of sequences has no place in ROS interfaces")
        return inner, f"[{bound}]"
    if word in ("string", "wstring"):
        if idl.peek() != "<":
            return word, ""
        idl.take_token()
        bound = idl.take_token().text
        idl.expect(">")
        return f"{word}<={bound}", ""
    if word in ("unsigned", "long"):
        while idl.peek() in ("long", "short", "double"):
            word += " " + idl.take_token().text
    if word in IDL_TYPES:
        return IDL_TYPES[word], ""
    if word in idl.typedefs:
        return idl.typedefs[word]
    return re.sub(r"\s*::\s*", "/", word).lstrip("/"), ""


def _parse_bounds(idl: _Idl) -> str:
    """The `[3]` behind a name; of several dimensions the product, as that many values are sent."""
    sizes: list[str] = []
    while idl.peek() == "[":
        idl.take_token()
        sizes.append(idl.take_token().text)
        idl.expect("]")
    if len(sizes) < 2:
        return f"[{sizes[0]}]" if sizes else ""
    product = 1
    for size in sizes:
        if not size.isdecimal() or len(size) > 9:
            return f"[{'*'.join(sizes)}]"
        product *= int(size)
    return f"[{product}]"


def _assemble(idl: _Idl) -> Interface:
    """Structs and constant modules as sections; a service or action is told by the endings of its structs' names."""
    sections: list[Section] = []
    name, module = "", ""
    for struct, modules, fields in idl.structs:
        constants = tuple(idl.constants.pop(f"{struct}_Constants", ()))
        stem, _, part = struct.rpartition("_")
        role = IDL_PARTS.get(part)
        owns = role is not None and stem and role[0] in modules[-1:]
        title = role[1] if role is not None and owns else ("message" if not sections else struct)
        if not name:
            name, module = (stem if owns else struct), "/".join(modules)
        sections.append(Section(title, tuple(fields), constants))
    leftover = tuple(constant for group in idl.constants.values() for constant in group)
    if leftover:
        if sections:
            first = sections[0]
            sections[0] = Section(first.name, first.fields, first.constants + leftover)
        else:
            sections.append(Section("message", (), leftover))
    return Interface("idl", tuple(sections), name, tuple(idl.problems), module)
