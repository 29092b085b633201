"""What headers that are not here declare, as far as a file uses it: worked out of the compiler's errors.

Every name becomes something that takes any use (`ri::Anything`) and says in the callback that nothing is known of it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

_ERROR = re.compile(r"^(?P<path>[^\s:][^:]*):(?P<line>\d+):(?P<column>\d+): (?:fatal )?error: (?P<text>.*)$")
_QUOTED = re.compile(r"'([^']*)'")
_OWN = ("std", "__gnu_cxx", "ri")
_NAME = re.compile(r"[A-Za-z_]\w*")
_ASKED = re.compile(r"\s*(?:\.|->)\s*(?:template\s+)?([A-Za-z_]\w*)")
_FOLLOWED = 4
"""Lines of the code in which the use of a name may go on."""
_HOOKS = frozenset(
    ("rclcpp::Node", "rclcpp::Publisher", "rclcpp::Subscription", "rclcpp::QoS", "rclcpp::NodeOptions",
     "ros::NodeHandle", "ros::Publisher", "XmlRpc::XmlRpcValue", "ri::Anything")
)  # fmt: skip


_FACADES = frozenset(
    ("ros", "rclcpp", "rclcpp_action", "rclcpp_lifecycle", "tf", "tf2", "tf2_ros", "nodelet", "cv", "cv_bridge")
)


class CompileError(NamedTuple):
    """An error of a compiler. text: without its place."""

    path: str
    line: int
    column: int
    text: str


def parse_errors(output: str) -> list[CompileError]:
    """The errors in what a compiler wrote."""
    found = (_ERROR.match(line) for line in output.splitlines())
    return [CompileError(m["path"], int(m["line"]), int(m["column"]), m["text"]) for m in found if m is not None]


class StubTable:
    """What is declared so far. read_line: a line of a file, counted from 1, empty where there is none. is_own: whether
    the code itself declares a name in a scope, so that it is not for us to declare. list_bases: the bases of a class
    of the code, as written. extras: members that other units of the workspace added to classes of the facades."""

    def __init__(
        self,
        read_line: Callable[[str, int], str],
        is_own: Callable[[str, str], bool] = lambda scope, name: False,
        list_bases: Callable[[str], Sequence[str]] = lambda name: (),
        extras: Mapping[str, Mapping[str, str]] = MappingProxyType({}),
    ):
        self._read_line, self._is_own, self._list_bases = read_line, is_own, list_bases
        # Scope and name to what it is: `namespace`, `type`, `template`, `function`, `variable`, `constant`.
        self._names: dict[tuple[str, str], str] = {}
        # Class to its members and what these are: `member`, `function`, `type`, `constant`, `number`.
        self._members: dict[str, dict[str, str]] = {owner: dict(rows) for owner, rows in extras.items()}
        self.flags: set[str] = set()
        self._banned: set[tuple[str, str]] = set()
        # The errors that something came of, in their order.
        self.lessons: dict[CompileError, None] = {}

    def __bool__(self) -> bool:
        return bool(self._names or self._members)

    def _is_type(self, full: str) -> bool:
        scope, _, last = full.rpartition("::")
        return self._names.get((scope, last)) in ("type", "template")

    def _find_type(self, written: str) -> str:
        """What is stood for under a name as it is written somewhere, empty for nothing."""
        written = _strip_arguments(written).removeprefix("::")
        full = (f"{scope}::{name}".lstrip(":") for scope, name in self._names)
        return next((one for one in full if self._is_type(one) and f"::{one}".endswith(f"::{written}")), "")

    @property
    def extras(self) -> dict[str, dict[str, str]]:
        """What is added to classes of the facades: class to its members and what these are."""
        return {owner: self._members[owner] for owner in sorted(_HOOKS & self._members.keys())}

    def list_names(self) -> list[str]:
        """What is stood for, by its full name."""
        return sorted(
            f"{scope}::{name}".lstrip(":") for (scope, name), kind in self._names.items() if kind != "namespace"
        )

    def learn(self, errors: Sequence[CompileError]) -> bool:
        """Takes in what errors say; gives whether anything new came of them. What is wrong with a macro or a type has
        further errors follow, so that these are looked at only where there is nothing of the kind."""
        for rank in (_is_of_macro, self._is_of_scope, lambda _: True):
            new = [each for each in errors if rank(each) and self._learn_one(each)]
            if new:
                self.lessons.update(dict.fromkeys(new))
                return True
        return False

    def learn_again(self, lessons: Iterable[CompileError]) -> None:
        """Takes in what another unit learnt of headers that both include."""
        for each in lessons:
            self._learn_one(each)

    def _is_of_scope(self, error: CompileError) -> bool:
        """Whether a type is missing, or a namespace."""
        if _is_of_type(error):
            return True
        if not error.text.startswith("use of undeclared identifier"):
            return False
        return self._peek(error, _QUOTED.findall(error.text)[0]).startswith("::")

    def remove_names(self, errors: Sequence[CompileError]) -> bool:
        """Takes names back that the code declares itself, as errors say; these are not made again. Gives whether
        there were any."""
        found = False
        for each in errors:
            text, quoted = each.text, _QUOTED.findall(each.text)
            if not quoted or not re.search(r"redefinition (?:of|with different)|is ambiguous|redeclared", text):
                continue
            names = [key for key in self._names if key[1] == _strip_arguments(quoted[0]).rpartition("::")[2]]
            written = text.rpartition(" vs ")[2]
            exact = [key for key in names if f"'{'::'.join(filter(None, key))}'" in written]
            for key in exact or names:
                del self._names[key]
                self._banned.add(key)
                found = True
        return found

    def _learn_one(self, error: CompileError) -> bool:
        text, quoted = error.text, _QUOTED.findall(error.text)
        if text.startswith("function-like macro") and text.endswith("is not defined"):
            flag = f"-D{quoted[0]}(...)=0"
            known = flag in self.flags
            self.flags.add(flag)
            return not known
        if _is_of_macro(error):
            flag = f"-D{quoted[0].rpartition(' ')[2]}="
            known = flag in self.flags
            self.flags.add(flag)
            return not known
        if "marked 'override' but does not override" in text or "can be marked 'override'" in text:
            known = "-Doverride=" in self.flags
            self.flags.add("-Doverride=")
            return not known
        if "expected namespace name" in text or "is not a namespace name" in text:
            return self._learn_namespace(error)
        if text.startswith("expected class name"):
            return self._learn_base(error)
        if text.startswith("statement requires expression of integer type") and "ri::Anything" in text:
            return self._learn_number(error)
        if not quoted:
            return False
        name = quoted[0]
        if text.startswith("no type named"):
            return self._add_type(quoted[1], name, "type", "in namespace" in text)
        if text.startswith(("no template named", "no class template named")):
            return self._add_type(
                quoted[1] if len(quoted) > 1 else "", name, "template", len(quoted) < 2 or "in namespace" in text
            )
        if text.startswith("cannot refer to type member") and len(quoted) > 1:
            return self._make_function(name)
        if text.startswith("must use '") and " tag to refer to type " in text:
            return self._make_type(quoted[1])
        if text.startswith("no member named") and len(quoted) > 1:
            kind = self._guess(error)
            if "in namespace" in text or "in the global namespace" in text:
                return self._add_name(quoted[1], name, kind) and self._follow(error, name, kind)
            return self._add_member(quoted[1], name, kind) and self._follow(error, name, kind)
        if text.startswith("unknown type name") and (macro := self._find_macro(error, name)):
            known = macro in self.flags
            self.flags.add(macro)
            return not known
        if text.startswith("unknown type name"):
            return self._add_name("", name, "template" if self._peek(error, name).startswith("<") else "type")
        if text.startswith(("use of undeclared identifier", "unknown class name", "undeclared")):
            kind = self._guess(error)
            return self._add_name("", name, kind) and self._follow(error, name, kind)
        if "unexpected namespace name" in text or "unexpected type name" in text:
            return self._add_name("", name, "type")
        if "template template" in text or "template argument for template type parameter must be a type" in text:
            return False
        return False

    def _follow(self, error: CompileError, name: str, kind: str) -> bool:
        """Adds what the code asks of what a new name gives, `name(...).second().third`. Gives True, since the name
        itself is new."""
        if kind not in ("function", "variable"):
            return True
        text = " ".join(self._read_line(error.path, error.line + more) for more in range(_FOLLOWED))
        at = text.find(name, max(error.column - 1, 0))
        at = _skip_use(text, at + len(name)) if at >= 0 else len(text)
        while (found := _ASKED.match(text, at)) is not None:
            at = found.end()
            behind = _skip_use(text, at)
            self._add_member("ri::Anything", found[1], "function" if behind > at else "variable")
            at = behind
        return True

    def _make_type(self, name: str) -> bool:
        """What hides a type is one."""
        hiding = [key for key, kind in self._names.items() if key[1] == name and kind in ("function", "variable")]
        for key in hiding:
            self._names[key] = "type"
        return bool(hiding)

    def _make_function(self, name: str) -> bool:
        """What is called of an object is no type."""
        owners = [each for each, rows in self._members.items() if rows.get(name) == "type"]
        for owner in owners:
            self._members[owner][name] = "function"
        return bool(owners)

    def _learn_number(self, error: CompileError) -> bool:
        """What a `switch` asks for is a number."""
        found = re.search(r"switch\s*\(.*?(\w+)\s*\)", self._read_line(error.path, error.line))
        if found is None:
            return False
        owners = [each for each, rows in self._members.items() if rows.get(found[1]) == "member"]
        for owner in owners:
            self._members[owner][found[1]] = "number"
        return bool(owners)

    def _find_macro(self, error: CompileError, name: str) -> str:
        """The flag that makes a macro nothing, where a word in capitals is a line of its own; empty for no macro."""
        line = self._read_line(error.path, error.line).strip().rstrip(";")
        if not re.fullmatch(r"[A-Z][A-Z0-9]*_[A-Z0-9_]+", name) or not line.startswith(name):
            return ""
        rest = line[len(name) :].strip()
        return f"-D{name}=" if not rest else f"-D{name}(...)=" if rest.startswith("(") and rest.endswith(")") else ""

    def _learn_namespace(self, error: CompileError) -> bool:
        line = self._read_line(error.path, error.line)
        found = re.search(r"(?:using\s+namespace|namespace\s+\w+\s*=)\s+(?:::)?([\w:]+)", line)
        return found is not None and self._add_namespace(found[1])

    def _add_namespace(self, full: str) -> bool:
        scope, new = "", False
        for part in full.split("::"):
            if self._names.get((scope, part)) is None and part not in _OWN:
                self._names[scope, part] = "namespace"
                new = True
            scope = f"{scope}::{part}".lstrip(":")
        return new

    def _learn_base(self, error: CompileError) -> bool:
        line = self._read_line(error.path, error.line)
        rest = line[error.column - 1 :]
        found = _NAME.match(rest)
        if found is None:
            return False
        before = re.search(r"((?:\w+::)+)$", line[: error.column - 1])
        scope = before[1].rstrip(":") if before is not None else ""
        return self._add_type(scope, found[0], "template" if rest[found.end() :].startswith("<") else "type", True)

    def _peek(self, error: CompileError, name: str) -> str:
        """What follows a name in the line of an error."""
        line = self._read_line(error.path, error.line)
        at = line.find(name, max(error.column - 1, 0))
        return line[at + len(name) :].lstrip() if at >= 0 else ""

    def _guess(self, error: CompileError) -> str:
        """What a name is by how it is used."""
        name = _QUOTED.findall(error.text)[0]
        rest = self._peek(error, name)
        line = self._read_line(error.path, error.line)
        before = line[: max(error.column - 1, 0)].rstrip()
        before = re.sub(r"(\w+::)+$", "", before).rstrip()
        if rest.startswith("::"):
            return "namespace"
        if before.endswith("case"):
            return "constant"
        if before.endswith("new"):
            return "type"
        if before.endswith("using") and rest.startswith(";"):
            return "type" if name[:1].isupper() and not name.isupper() else "function"
        if rest.startswith("<") and not re.match(r"<\s*[\w.()+\-]+\s*[;)&|]", rest) and ">" in rest:
            behind = rest[rest.rindex(">") + 1 :].lstrip()
            return "function" if behind.startswith("(") and not name[:1].isupper() else "template"
        if rest.startswith("(") and re.search(r"(?:->|\.)$", before):
            return "function"
        if rest.startswith("("):
            return "type" if name[:1].isupper() and not name.isupper() else "function"
        if (
            rest.startswith("{")
            or re.match(r"(const\b\s*)?[&*]*\s*[A-Za-z_]\w*\s*[;=,({)\[]", rest)
            or re.match(r"[&*]+\s*[,>)]", rest)
        ):
            return "type"
        if re.match(r"(>|,)", rest) and re.search(r"<[^<>]*$", before) and name[:1].isupper():
            return "type"
        return "variable"

    def _add_type(self, scope: str, name: str, kind: str, in_namespace: bool) -> bool:
        scope = _strip_arguments(scope)
        if not in_namespace and scope:
            return self._add_member(scope, name, "type")
        return self._add_name(scope, name, kind)

    def _add_name(self, scope: str, name: str, kind: str) -> bool:
        scope = _strip_arguments(scope).removeprefix("::")
        if (
            scope.partition("::")[0] in _OWN
            or not _NAME.fullmatch(name)
            or (scope, name) in self._banned
            or (kind != "namespace" and self._is_own(scope, name))
        ):
            return False
        if scope:
            self._add_namespace(scope)
        known = self._names.get((scope, name))
        if known is not None and _RANKS.index(known) >= _RANKS.index(kind):
            return False
        self._names[scope, name] = kind
        return True

    def _add_member(self, owner: str, name: str, kind: str) -> bool:
        owner = _strip_arguments(owner).replace("const ", "").strip(" &*").removeprefix("::")
        if not _NAME.fullmatch(name):
            return False
        head = owner.partition("::")[0]
        if owner not in _HOOKS and not self._is_type(owner):
            owner = next((one for base in self._list_bases(owner) if (one := self._find_type(base))), "")
            if not owner and head not in _FACADES:
                return False
            # Many classes of the facades are of what takes any use.
            owner = owner or "ri::Anything"
        members = self._members.setdefault(owner, {})
        kind = {"template": "function", "variable": "member", "namespace": "type"}.get(kind, kind)
        if name in members and (members[name] in (kind, "number") or kind == "member"):
            return False
        members[name] = kind
        return True

    def render(self) -> str:
        """The header, to be included before all else."""
        lines = ["#pragma once", *self.render_extras(), '#include "ri_core.hpp"']
        lines += self._define_members()
        for (scope, name), kind in sorted(self._names.items(), key=_get_order):
            opened = "".join(f"namespace {part} {{ " for part in scope.split("::") if part)
            closed = " }" * opened.count("{")
            full = f"{scope}::{name}".lstrip(":")
            lines.append(f"{opened}{self._spell(full, name, kind)}{closed}")
        return "\n".join([*lines, ""])

    def render_extras(self) -> list[str]:
        """The macros that add members to classes of the facades."""
        rows = []
        for owner in self.extras:
            members = " ".join(self._spell_members(owner, "ri::Anything" if owner == "ri::Anything" else ""))
            rows.append(f"#define RI_EXTRA_{owner.replace('::', '_')} {members}")
        return rows

    def _spell(self, full: str, name: str, kind: str) -> str:
        if kind == "namespace":
            return f"namespace {name} {{ }}"
        if kind == "function":
            body = f'{{ ri::foreign("{full}", a...); return {{}}; }}'
            return f"template <class... RiT, class... RiA> ri::Anything {name}(RiA &&...a) {body}"
        if kind == "variable":
            return f"inline ri::Anything {name};"
        if kind == "constant":
            return f"inline constexpr int {name} = {_make_number(full)};"
        members = " ".join(self._spell_members(full, name))
        head = "template <class... RiT> " if kind == "template" else ""
        return f"{head}struct {name} : ri::Anything {{ RI_STAND_IN({name}) {members} }};"

    def _spell_members(self, owner: str, own: str) -> list[str]:
        rows = []
        for name, kind in sorted(self._members.get(owner, {}).items()):
            if kind == "type":
                pointed = own.rpartition("::")[2] or "ri::Anything"
                constant = "const " if "Const" in name else ""
                made = "std::unique_ptr" if "Unique" in name else "std::shared_ptr" if name.endswith("Ptr") else ""
                if made:
                    rows.append(f"using {name} = {made}<{constant}{pointed}>;")
                elif owner == "ri::Anything":  # which is no base of what is declared in it
                    rows.append(f"using {name} = Anything;")
                else:
                    rows.append(f"struct {name} : ri::Anything {{ RI_STAND_IN({name}) }};")
            elif kind == "function":
                body = f'{{ ri::foreign("{owner}::{name}", a...); return {{}}; }}'
                rows.append(f"template <class... RiM, class... RiB> static ri::Anything {name}(RiB &&...a) {body}")
            elif kind == "constant":
                rows.append(f"static constexpr int {name} = {_make_number(owner + name)};")
            elif kind == "number":
                rows.append(f"static inline ri::Number {name};")
            elif owner == "ri::Anything":
                rows.append(f"static Anything {name};")
            else:
                rows.append(f"static inline ri::Anything {name};")
        return rows

    def _define_members(self) -> list[str]:
        """The definitions of the members of what stands for anything."""
        names = [n for n, kind in sorted(self._members.get("ri::Anything", {}).items()) if kind == "member"]
        return [f"inline ri::Anything ri::Anything::{name};" for name in names]


def _skip_use(text: str, at: int) -> int:
    """Where what follows a name ends that belongs to its use: template arguments, arguments and indices."""
    found = re.compile(r"\s*<[\w:<>,\s*&]*>(?=\s*\()").match(text, at)
    place = found.end() if found is not None else at
    while (opened := re.compile(r"\s*([(\[])").match(text, place)) is not None:
        depth, place = 0, opened.end() - 1
        while place < len(text):
            depth += (text[place] in "([") - (text[place] in ")]")
            place += 1
            if depth == 0:
                break
    return place


def _is_of_macro(error: CompileError) -> bool:
    """Whether a word stands before a class's name that is a macro of a header that is not here."""
    if error.text.startswith("function-like macro") and error.text.endswith("is not defined"):
        return True
    return re.search(r"incomplete type '(?:class|struct) [A-Z][A-Z0-9_]+'", error.text) is not None


def _is_of_type(error: CompileError) -> bool:
    return error.text.startswith(
        ("no type named", "no template named", "no class template", "unknown type name", "unknown class name",
         "expected class name", "expected namespace name")
    ) or "in namespace" in error.text  # fmt: skip


_RANKS = ("namespace", "variable", "function", "constant", "type", "template")


def _get_order(row: tuple[tuple[str, str], str]) -> tuple[int, int, str, str]:
    (scope, name), kind = row
    return (0 if kind in ("type", "template") else 1, scope.count("::"), scope, name)


def _strip_arguments(name: str) -> str:
    kept, depth = [], 0
    for character in name:
        depth += (character == "<") - (character == ">")
        if depth == 0 and character != ">":
            kept.append(character)
    return "".join(kept)


def _make_number(text: str) -> int:
    return sum(ord(c) * (31**n % 9973) for n, c in enumerate(text)) % 1_000_003
