"""What launch files in XML and YAML do for some distros alone: their if and unless that ask for the environment, what
stands under them, and the names that they compare ROS_DISTRO with."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ....edges.groups import group_pairs
from ..condition import UNDECIDED, Condition
from ..distro_branches import VARIABLE, Branch, BranchedName, ComparedDistro
from ..markup import Document, Element
from ..python.branches import list_compared_distros

_EVAL = re.compile(r"\s*\$\(\s*eval\s+(.*)\)\s*\Z", re.DOTALL)
_FUNCTION = re.compile(r"\s*\$\(\s*(equals|not-equals|not|and|or|all|any)\s+(.*)\)\s*\Z", re.DOTALL)
_JOINED = {"equals": " == ", "not-equals": " != ", "and": " and ", "or": " or ", "all": " and ", "any": " or "}
_QUOTED_WHOLE = re.compile(r"""(['"])((?:(?!\1)[^\\]|\\.)*)\1\Z""", re.DOTALL)
_VARIABLE = re.compile(r"""(['"])\$\((?:opt)?env\s+(ROS_\w+)[^()]*\)\1|\b(?:opt)?env\(\s*['"](ROS_\w+)['"]""")
_ENVIRONMENT = re.compile(r"\$\(\s*(?:opt)?env\s+(ROS_\w+)[^()]*\)\Z")
_OTHER = re.compile(r"""(['"]?)\$\([^()]*\)\1""")
_ARGUMENT = re.compile(r"""\$\(\s*(?:arg|var)\s+([\w.-]+)\s*\)|\b(?:arg|var)\(\s*['"]([\w.-]+)['"]\s*\)""")
_PIECE = re.compile(r"""[()]|'[^']*'|"[^"]*"|\s+|[^()'"\s]+""")
_DEEPEST = 20


def read_machine_test(text: str, negated: bool, held: Mapping[str, str]) -> Condition:
    """An if or unless that asks for a variable of the environment that ROS sets, as a test of Python; UNDECIDED for any
    other. held: what arguments stand for."""

    def replace(match: re.Match[str]) -> str:
        value = held.get(match[1] or match[2], "").strip()
        variable = _ENVIRONMENT.match(value)
        return match[0] if variable is None else value if match[1] else f"env('{variable[1]}')"

    test = _convert(_ARGUMENT.sub(replace, text), 0) if "ROS_" in text or held else ""
    asks = _EVAL.match(text) is not None or _FUNCTION.match(text) is not None
    return Condition("python", test, negated) if asks and "ROS_" in test else UNDECIDED


def _convert(text: str, depth: int) -> str:
    """A substitution as an expression of Python: `undecided` for what is not known."""
    function, evaluated = _FUNCTION.match(text), _EVAL.match(text)
    if function is not None and depth < _DEEPEST:
        parts = [_convert(part, depth + 1) for part in _split_arguments(function[2])]
        if function[1] == "not" and len(parts) == 1:
            return f"not ({parts[0]})"
        return f"({_JOINED[function[1]].join(parts)})" if len(parts) > 1 and function[1] in _JOINED else "undecided"
    if evaluated is not None:
        whole = _QUOTED_WHOLE.match(evaluated[1].strip())
        inner = re.sub(r"\\(['\"])", r"\1", whole[2] if whole is not None else evaluated[1])
        inner = _VARIABLE.sub(lambda m: f"os.environ['{m[2]}']" if m[2] else f"os.environ.get('{m[3]}'", inner)
        return _OTHER.sub("undecided", inner).strip()
    if (variable := _ENVIRONMENT.match(text.strip())) is not None:
        return f"os.environ['{variable[1]}']"
    return "undecided" if "$(" in text else repr(text.strip().strip("'\""))


def _split_arguments(text: str) -> list[str]:
    """The arguments of a substitution, parted by blanks outside of others and of quotes."""
    parts, depth = [""], 0
    for piece in _PIECE.findall(text):
        depth += {"(": 1, ")": -1}.get(piece, 0)
        if piece.isspace() and not depth:
            parts.append("")
        else:
            parts[-1] += piece
    return [part for part in parts if part]


def list_compared(document: Document, held: Mapping[str, str]) -> Iterator[ComparedDistro]:
    """The texts that attributes compare ROS_DISTRO with."""
    for element in document.elements:
        for attribute in element.attributes if "$(" in "".join(a.value for a in element.attributes) else ():
            test = read_machine_test(attribute.value, False, held)
            tree = _parse(test.text) if VARIABLE in test.text else None
            for one in list_compared_distros(tree) if tree is not None else ():
                yield ComparedDistro(one.name, *document.locate(attribute.offset))


def _parse(text: str) -> ast.Module | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return ast.parse(text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return None


class _Started(NamedTuple):
    """An element that starts something under a test of the distro. names: what tells what that is."""

    element: Element
    conditions: tuple[Condition, ...]
    names: frozenset[str]


_SETTING = frozenset(("let", "arg"))
_USE = re.compile(r"\$\(\s*(?:arg|var)\s+([\w.-]+)\s*\)")


def list_branched(
    document: Document, conditions: Sequence[tuple[Condition, ...]], starting: Iterable[str]
) -> Iterator[BranchedName]:
    """Arguments that are set in branches on the distro alone, with their first use outside of all, and what is started
    in several of them. conditions: of each element. starting: names of elements that start something."""
    if not any(VARIABLE in one.text for some in conditions for one in some):
        return
    yield from _list_arguments(document, conditions)
    yield from _list_started(document, conditions, frozenset(starting))


def _list_arguments(document: Document, conditions: Sequence[tuple[Condition, ...]]) -> Iterator[BranchedName]:
    set_in: dict[str, list[tuple[Condition, ...]]] = {}
    given: set[str] = set()
    for element, under in zip(document.elements, conditions, strict=True):
        around = document.elements[element.parent].name if element.parent >= 0 else ""
        if element.name in _SETTING and around in ("launch", "group"):
            set_in.setdefault(element.get("name"), []).append(under)
            if element.find("value") is None:
                given.add(element.get("name"))
    for name, branches in set_in.items():
        if all(branches) and any(VARIABLE in one.text for under in branches for one in under):
            for element, under in zip(document.elements, conditions, strict=True):
                used = (a for a in element.attributes if name in _USE.findall(a.value)) if not under else ()
                if (first := next(iter(used), None)) is not None:
                    function = "arguments" if name in given else ""
                    ways = tuple(map(Branch, branches))
                    yield BranchedName(name, *document.locate(first.offset), ways, function)
                    break


def _list_started(
    document: Document, conditions: Sequence[tuple[Condition, ...]], starting: frozenset[str]
) -> Iterator[BranchedName]:
    by_parent: dict[int, list[_Started]] = {}
    always: dict[int, set[str]] = {}
    for element, under in zip(document.elements, conditions, strict=True):
        if element.parent < 0 or conditions[element.parent]:
            continue
        names = frozenset(_list_names(element, starting, " ".join(one.text for one in under)))
        if not under:
            always.setdefault(element.parent, set()).update(names)
        elif names and all(VARIABLE in one.text for one in under):
            by_parent.setdefault(element.parent, []).append(_Started(element, under, names))
    for parent, started in by_parent.items():
        same = group_pairs((name, one) for one in started for name in sorted(one.names - always.get(parent, set())))
        for alternatives in dict.fromkeys(map(tuple, same.values())):
            if len({one.conditions for one in alternatives}) > 1:
                branches = tuple(Branch(one.conditions) for one in alternatives)
                place = document.locate(alternatives[0].element.offset)
                yield BranchedName(VARIABLE, *place, branches, kind="start")


def _list_names(element: Element, starting: frozenset[str], test: str) -> Iterator[str]:
    """What tells what an element starts, itself or by what it holds: its name, else its package and program, or a file
    without the names that the test has under which it stands."""
    waiting = [element]
    while waiting:
        one = waiting.pop()
        waiting.extend(one.children if one.name == "group" else ())
        if one.name not in starting:
            continue
        if file := one.get("file").rpartition("/")[2]:
            for word in re.findall(r"'(\w+)'", test):
                file = file.replace(word, "")
            yield f"file {file}"
        else:
            program = one.find("exec", "type")
            yield one.get("name") or f"{one.get('pkg')} {program.value if program is not None else one.get('cmd')}"
