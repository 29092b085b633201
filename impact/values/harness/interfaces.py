"""Messages, services and actions as C++ headers, in the form of either generation of ROS, without ROS.

The structs have the names, types, constants and header paths that genmsg (http://wiki.ros.org/msg) and
rosidl_generator_cpp (https://design.ros2.org/articles/generated_interfaces_cpp.html) give them, and one function more:
`ri_each(visitor, message)`, by which inputs are filled and sent values are told.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...facts.interface import PRIMITIVES, TIMES, Constant, Field, Interface, Section, make_full_name
from ...model.flow.definitions import make_key
from ...model.flow.parameter_terms import list_configurations
from ...model.workspace import Workspace
from ...targets.surface.fields import make_snake_case
from ...targets.surface.store import load_shipped

_FIXED = re.compile(r"\[([0-9]+)\]")
_BOUNDED = re.compile(r"\[<=([0-9]+)\]")
_CPP = {
    "bool": "bool", "byte": "uint8_t", "char": "uint8_t", "octet": "uint8_t", "int8": "int8_t", "uint8": "uint8_t",
    "int16": "int16_t", "uint16": "uint16_t", "int32": "int32_t", "uint32": "uint32_t", "int64": "int64_t",
    "uint64": "uint64_t", "float32": "float", "float64": "double", "float128": "long double", "string": "std::string",
    "wstring": "std::u16string", "wchar": "char16_t",
}  # fmt: skip
# genmsg makes a signed byte of it, and a bool a byte.
_CPP_ROS1 = {**_CPP, "byte": "int8_t", "bool": "uint8_t"}
_KEYWORDS = frozenset((
    "alignas", "alignof", "and", "asm", "auto", "bool", "break", "case", "catch", "char", "class", "const",
    "constexpr", "continue", "default", "delete", "do", "double", "else", "enum", "explicit", "export", "extern",
    "false", "float", "for", "friend", "goto", "if", "inline", "int", "long", "mutable", "namespace", "new",
    "noexcept", "not", "nullptr", "operator", "or", "private", "protected", "public", "register", "return", "short",
    "signed", "sizeof", "static", "struct", "switch", "template", "this", "throw", "true", "try", "typedef",
    "typename", "union", "unsigned", "using", "virtual", "void", "volatile", "while", "xor",
))  # fmt: skip
_SECTIONS = {"request": "Request", "response": "Response", "goal": "Goal", "result": "Result", "feedback": "Feedback"}
_CONFIGURATION = re.compile(r"(\w+)/(\w+)Config\.h")
_CONFIGURED = {"bool": "bool", "integer": "int", "double": "double"}
_HEADER_1 = re.compile(r"(\w+)/(\w+)\.h")
_HEADER_2 = re.compile(r"(\w+)/(msg|srv|action)/(?:detail/)?(\w+?)(?:__(?:struct|traits|builder|type_support))?\.hpp")


class KnownInterfaces:
    """The interfaces of a workspace and of released packages."""

    def __init__(self, workspace: Workspace):
        self._workspace = workspace
        self.ros = workspace.ros
        self._own: dict[str, dict[str, Interface]] = {}
        for package in workspace:
            for each in package.linked.interfaces:
                kind = each.definition.kind
                folder = kind if kind != "idl" else each.path.rpartition("/")[0].rpartition("/")[2]
                self._own.setdefault(package.name, {})[f"{folder}/{each.name}"] = each.definition
        self._released: dict[str, dict[str, Interface]] = {}

    def list_of(self, package: str) -> dict[str, Interface]:
        """The interfaces of a package by `msg/Name`: of the workspace, else of its newest release that is stored."""
        if package in self._own:
            return self._own[package]
        if package not in self._released:
            history = load_shipped().find_history(package, self.ros)
            self._released[package] = history.load_interfaces(history.versions[-1]) if history is not None else {}
        return self._released[package]

    def find(self, key: str) -> Interface | None:
        """The interface `package/msg/Name`, None where it is not known. ROS 1 makes messages of an action's parts."""
        package, _, name = key.partition("/")
        known = self.list_of(package)
        found = known.get(name)
        if found is None and self.ros == 1 and name.startswith("msg/"):
            found = self._find_part(package, name.removeprefix("msg/"), known)
        return found

    def _find_part(self, package: str, name: str, known: dict[str, Interface]) -> Interface | None:
        for ending, rows in _ACTION_PARTS.items():
            action = known.get(f"action/{name.removesuffix(ending)}") if name.endswith(ending) else None
            if action is None:
                continue
            stem = name.removesuffix(ending)
            if not rows:
                section = next((one for one in action.sections if one.name == ending.lower()), None)
                return Interface("msg", (section,)) if section is not None else None
            fields = tuple(Field(of, type_.format(f"{package}/{stem}"), "", "", 0) for of, type_ in rows)
            return Interface("msg", (Section("message", fields, ()),))
        return None

    def find_key_of_header(self, header: str) -> str:
        """The key of the interface whose generated header has a path, empty for none."""
        if self.ros == 1:
            found = _HEADER_1.fullmatch(header)
            if found is None:
                return ""
            package, name = found.groups()
            for folder in ("msg", "srv"):
                for stem in (name, re.sub(r"(Request|Response)$", "", name)):
                    if self.find(f"{package}/{folder}/{stem}") is not None:
                        return f"{package}/{folder}/{stem}"
            return ""
        found = _HEADER_2.fullmatch(header)
        if found is None:
            return ""
        package, folder, snake = found.groups()
        for name in self.list_of(package):
            kind, _, last = name.partition("/")
            if kind == folder and make_snake_case(last) == snake:
                return f"{package}/{name}"
        return ""

    def write_configuration(self, header: str) -> str:
        """The header that dynamic_reconfigure generates of a `.cfg` file of the workspace, empty for any other."""
        found = _CONFIGURATION.fullmatch(header)
        if found is None or self.ros != 1:
            return ""
        package, name = found.groups()
        rows = {one.name: one.type for _, one in list_configurations(self._workspace).get((package, name), ())}
        if not rows:
            return ""
        fields = "".join(f"  {_CONFIGURED.get(type_, 'std::string')} {field}{{}};\n" for field, type_ in rows.items())
        visits = " ".join(f'visit("{field}", message.{field});' for field in rows)
        return (
            f"#pragma once\n#include <ros/ri_message.h>\nnamespace {package} {{\nstruct {name}Config {{\n"
            f"  using ri_is_message = void;\n{fields}"
            f"  template <class V, class M> static void ri_each(V &visit, M &message) {{ {visits} }}\n"
            f"  static {name}Config __getDefault__() {{ return {{}}; }}\n"
            f"  static {name}Config __getMin__() {{ return {{}}; }}\n"
            f"  static {name}Config __getMax__() {{ return {{}}; }}\n}};\n}}\n"
        )


_ACTION_PARTS: dict[str, tuple[tuple[str, str], ...]] = {
    "ActionGoal": (("header", "Header"), ("goal_id", "actionlib_msgs/GoalID"), ("goal", "{}Goal")),
    "ActionResult": (("header", "Header"), ("status", "actionlib_msgs/GoalStatus"), ("result", "{}Result")),
    "ActionFeedback": (("header", "Header"), ("status", "actionlib_msgs/GoalStatus"), ("feedback", "{}Feedback")),
    "Action": (
        ("action_goal", "{}ActionGoal"), ("action_result", "{}ActionResult"), ("action_feedback", "{}ActionFeedback"),
    ),
    "Goal": (),
    "Result": (),
    "Feedback": (),
}  # fmt: skip


def list_constants(definitions: KnownInterfaces, key: str) -> dict[str, tuple[str, str]]:
    """The constants of an interface, by name its type and value as written."""
    found = definitions.find(key)
    sections = found.sections if found is not None else ()
    return {one.name: (one.type, one.value) for section in sections for one in section.constants}


def write_headers(definitions: KnownInterfaces, key: str) -> dict[str, str]:
    """The headers of an interface and of those nested in it, by path. Those that are not known are not written."""
    found: dict[str, str] = {}
    left, seen = [key], set()
    while left:
        one = left.pop()
        interface = definitions.find(one)
        if one in seen or interface is None:
            continue
        seen.add(one)
        writer = _Writer1 if definitions.ros == 1 else _Writer2
        made = writer(definitions, one, interface)
        found.update(made.list_files())
        left += made.nested
    return found


class _Writer1:
    """An interface in the form of ROS 1."""

    types = _CPP_ROS1

    def __init__(self, definitions: KnownInterfaces, key: str, interface: Interface):
        self.package, self.folder, self.name = key.split("/")
        self.definitions, self.interface = definitions, interface
        self.nested: list[str] = []

    def list_files(self) -> Iterator[tuple[str, str]]:
        structs = [self.write_struct(self.name_struct(section), section) for section in self.interface.sections]
        body = "\n".join(structs)
        includes = "".join(f"#include <{each}>\n" for each in self.list_includes())
        here = f"{self.package}/{self.name}"
        if self.folder == "srv":
            body += (
                f"struct {self.name} {{\n  using Request = {self.name}Request;\n  using Response = "
                f"{self.name}Response;\n  using ri_is_service = void;\n  Request request;\n  Response response;\n}};\n"
            )
            for part in ("Request", "Response"):
                yield f"{here}{part}.h", f"#pragma once\n#include <{here}.h>\n"
        yield (
            f"{here}.h",
            f"#pragma once\n#include <ros/ri_message.h>\n{includes}namespace {self.package} {{\n{body}}}\n",
        )

    def name_struct(self, section: Section) -> str:
        return self.name + ("" if self.folder == "msg" else _SECTIONS.get(section.name, ""))

    def list_includes(self) -> list[str]:
        found: dict[str, None] = {}
        for section in self.interface.sections:
            for field in section.fields:
                key = self.find_nested(field)
                if key:
                    self.nested.append(key)
                    found[self.name_header(key)] = None
        return list(found)

    def name_header(self, key: str) -> str:
        package, _, name = key.split("/")
        return f"{package}/{name}.h"

    def find_nested(self, field: Field) -> str:
        plain = field.type.partition("<=")[0]
        if plain in PRIMITIVES or self.is_time(plain):
            return ""
        return make_key("topic", make_full_name(plain, self.package))

    def is_time(self, plain: str) -> bool:
        return plain in TIMES

    def spell_type(self, field: Field) -> str:
        """The C++ type of one value."""
        plain = field.type.partition("<=")[0]
        if plain in self.types:
            return self.types[plain]
        if self.is_time(plain):
            return f"::ros::{plain.title()}"
        package, _, name = self.find_nested(field).split("/")
        return f"::{package}::{name}"

    def spell(self, field: Field) -> str:
        """The C++ type of a field."""
        one = self.spell_type(field)
        fixed = _FIXED.fullmatch(field.array)
        if fixed is not None:
            return f"::boost::array<{one}, {fixed[1]}>"
        return f"std::vector<{one}>" if field.array else one

    def write_struct(self, name: str, section: Section) -> str:
        types = [(self.spell_name(field.name), self.spell(field), field) for field in section.fields]
        lines = [f"struct {name} {{", "  using ri_is_message = void;", f"  using Type = {name};"]
        lines += [f"  typedef {type_} _{field}_type;" for field, type_, _ in types]
        lines += [f"  {each}" for each in map(self.spell_constant, section.constants) if each]
        lines += [f"  {type_} {field}{self.write_default(given)};" for field, type_, given in types]
        lines += [f"  {each}" for each in self.list_extras(name)]
        visits = " ".join(f'visit("{given.name}", message.{field});' for field, _, given in types)
        lines.append(
            f"  template <class V, class M> static void ri_each(V &visit, M &message) "
            f"{{ (void)visit; (void)message; {visits} }}"
        )
        equal = " && ".join(f"{field} == other.{field}" for field, _, _ in types) or "true"
        lines.append(f"  bool operator==(const {name} &other) const {{ (void)other; return {equal}; }}")
        lines.append(f"  bool operator!=(const {name} &other) const {{ return !(*this == other); }}")
        lines.append("};")
        return "\n".join([*lines, *self.list_after(name), ""])

    def list_extras(self, name: str) -> Iterator[str]:
        yield f"typedef boost::shared_ptr<{name}> Ptr; typedef boost::shared_ptr<{name} const> ConstPtr;"

    def list_after(self, name: str) -> Iterator[str]:
        yield f"typedef boost::shared_ptr<{name}> {name}Ptr; typedef boost::shared_ptr<{name} const> {name}ConstPtr;"
        yield f"template <class A> using {name}_ = {name};"
        yield f"inline std::ostream &operator<<(std::ostream &out, const {name} &) {{ return out; }}"

    def spell_name(self, name: str) -> str:
        return name

    def write_default(self, field: Field) -> str:
        return "{}"

    def spell_constant(self, constant: Constant) -> str:
        plain = constant.type.partition("<=")[0]
        type_ = self.types.get(plain)
        if type_ is None:
            return ""
        if type_ in ("std::string", "std::u16string"):
            return f"static inline const {type_} {constant.name} = {_quote(constant.value, type_ != 'std::string')};"
        value = _write_number(constant.value, type_)
        return f"static constexpr {type_} {constant.name} = {value};" if value else ""


class _Writer2(_Writer1):
    """An interface in the form of ROS 2."""

    types = _CPP

    def list_files(self) -> Iterator[tuple[str, str]]:
        includes = "".join(f"#include <{each}>\n" for each in self.list_includes())
        snake = make_snake_case(self.name)
        if self.folder == "msg":
            body = "".join(self.write_struct(self.name, section) for section in self.interface.sections[:1])
        else:
            names = {
                section.name: f"{self.name}_{_SECTIONS.get(section.name, '')}" for section in self.interface.sections
            }
            body = "".join(self.write_struct(names[one.name], one) for one in self.interface.sections)
            uses = "".join(f" using {_SECTIONS.get(part, part)} = {name};" for part, name in names.items())
            mark = "ri_is_service" if self.folder == "srv" else "ri_is_action"
            more = self.write_action() if self.folder == "action" else ""
            body += f"struct {self.name} {{ using {mark} = void;{uses}{more} }};\n"
        path = f"{self.package}/{self.folder}/{snake}.hpp"
        open_, close = f"namespace {self.package} {{ namespace {self.folder} {{\n", "} }\n"
        yield path, f"#pragma once\n#include <rosidl_runtime_cpp/ri_message.hpp>\n{includes}{open_}{body}{close}"
        for part in ("struct", "traits", "builder", "type_support"):
            yield f"{self.package}/{self.folder}/detail/{snake}__{part}.hpp", f"#pragma once\n#include <{path}>\n"

    def write_action(self) -> str:
        whole = f"{self.name}_FeedbackMessage"
        return f" struct Impl {{ struct FeedbackMessage {{ {self.name}_Feedback feedback; }}; }}; /* {whole} */"

    def name_header(self, key: str) -> str:
        package, folder, name = key.split("/")
        return f"{package}/{folder}/{make_snake_case(name)}.hpp"

    def is_time(self, plain: str) -> bool:
        return False

    def spell_type(self, field: Field) -> str:
        plain = field.type.partition("<=")[0]
        if plain in self.types:
            return self.types[plain]
        package, _, name = self.find_nested(field).split("/")
        return f"::{package}::msg::{name}"

    def spell(self, field: Field) -> str:
        one = self.spell_type(field)
        fixed, bounded = _FIXED.fullmatch(field.array), _BOUNDED.fullmatch(field.array)
        if fixed is not None:
            return f"std::array<{one}, {fixed[1]}>"
        if bounded is not None:
            return f"::rosidl_runtime_cpp::BoundedVector<{one}, {bounded[1]}>"
        return f"std::vector<{one}>" if field.array else one

    def list_extras(self, name: str) -> Iterator[str]:
        yield f"using SharedPtr = std::shared_ptr<{name}>; using ConstSharedPtr = std::shared_ptr<{name} const>;"
        yield f"using UniquePtr = std::unique_ptr<{name}>; using ConstUniquePtr = std::unique_ptr<{name} const>;"
        yield f"using WeakPtr = std::weak_ptr<{name}>; using ConstWeakPtr = std::weak_ptr<{name} const>;"
        yield f"using RawPtr = {name} *; using ConstRawPtr = const {name} *;"
        yield f"explicit {name}(rosidl_runtime_cpp::MessageInitialization) {{}}"
        yield f"{name}() = default;"

    def list_after(self, name: str) -> Iterator[str]:
        yield f"template <class A> using {name}_ = {name};"

    def spell_name(self, name: str) -> str:
        return f"{name}_" if name in _KEYWORDS else name

    def write_default(self, field: Field) -> str:
        if not field.default:
            return "{}"
        type_ = self.types.get(field.type.partition("<=")[0], "")
        if type_ in ("std::string",) and not field.array:
            return f"{{{_quote(field.default)}}}"
        if not field.array and type_ and (value := _write_number(field.default, type_)):
            return f"{{{value}}}"
        if field.default.startswith("[") and type_ not in ("", "std::string", "std::u16string"):
            values = [_write_number(each, type_) for each in field.default.strip("[] ").split(",") if each.strip()]
            opened, closed = ("{{", "}}") if _FIXED.fullmatch(field.array) else ("{", "}")
            return f"{opened}{', '.join(values)}{closed}" if all(values) else "{}"
        return "{}"


_NUMBER = re.compile(r"[-+]?(?:0[xX][0-9a-fA-F]+|[0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?|\.[0-9]+(?:[eE][-+]?[0-9]+)?)")


def _write_number(text: str, type_: str) -> str:
    """A number or bool of a definition as C++, empty where it is none."""
    text = text.strip().replace("_", "")
    if text.lower() in ("true", "false"):
        return f"static_cast<{type_}>({text.lower()})"
    if _NUMBER.fullmatch(text) is None:
        special = {"nan": '__builtin_nan("")', "inf": "__builtin_inf()", "-inf": "-__builtin_inf()"}
        return f"static_cast<{type_}>({special[text.lower()]})" if text.lower() in special else ""
    if type_ in ("float", "double", "long double"):
        return f"static_cast<{type_}>({text})"
    plain = re.fullmatch(r"([-+]?)0*([0-9].*)", text)
    if plain is not None and not plain[2].lower().startswith(("0x",)) and "x" not in text.lower():
        text = plain[1] + (plain[2] if plain[2] else "0")
    if "." in text or ("e" in text.lower() and "x" not in text.lower()):
        return ""
    number = int(text, 16 if "x" in text.lower() else 10)
    if number == -(2**63):
        return "(-9223372036854775807LL - 1)"
    return f"static_cast<{type_}>({number}{'ULL' if number > 2**63 - 1 else 'LL'})"


def _quote(text: str, wide: bool = False) -> str:
    """A text of a definition as a C++ literal."""
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'":
        text = text[1:-1]
    shown = "".join(
        f"\\{c}" if c in '"\\' else c if " " <= c <= "~" else "".join(f"\\{b:03o}" for b in c.encode()) for c in text
    )
    return f'{"u" if wide else ""}"{shown}"'
