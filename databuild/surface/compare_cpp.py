"""What changed in the C++ headers of a package between two versions: pure functions over what both offer."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from difflib import SequenceMatcher

import msgspec

from ...impact.facts.surface import CLASSES, FUNCTIONS, CppParameter, Entity, HeaderSurface, drop_inline


class CppChange(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One difference. name: of the entity.

    | kind | holds |
    |---|---|
    | removed, added | the entity; what is `overload` where others of its name stay; members of a class that goes or
      comes as a whole are not listed one by one; what the compiler makes then by itself is compatible |
    | moved | the same entity in another header; members are not listed beside their class |
    | renamed | a hint: a removed and an added entity that look alike; sure: how much, 0 to 1. Both are told as removed
      and added too |
    | signature | what: arity, types, result, const, static, virtual, template, ref, explicit, override (whoever
      overrides it no longer does), kind (a class became an alias, ...), type (of a variable, field or alias) |
    | default | the default of a parameter, or of a parameter of a template, is another |
    | deprecated | it warns now |
    | value | an enumerator or constant has another value |
    | base | the bases of a class |
    | access | it was public and is protected, or is gone from both |
    | deleted, pure, final | it became so |

    compatible: whoever uses the old one still compiles. old_header, new_header: where it stands or stood."""

    kind: str
    name: str
    old: Entity | None = None
    new: Entity | None = None
    old_header: str = ""
    new_header: str = ""
    what: tuple[str, ...] = ()
    compatible: bool = False
    sure: float = 1.0


_Placed = tuple[str, Entity]
_SIMILAR = 0.6
"""Names less alike than this are no hint; the figure of difflib.SequenceMatcher.ratio()."""


def compare(old: Mapping[str, HeaderSurface], new: Mapping[str, HeaderSurface]) -> tuple[CppChange, ...]:
    """The differences between the headers of two versions of a package, by their paths as they are included. Sorted by
    name; nothing for what only moved its line, changed its spacing or the names of its parameters."""
    changes: list[CppChange] = []
    before, after = _group_offered(old), _group_offered(new)
    names = {name for _, name in after}
    gone: list[_Placed] = []
    come: list[_Placed] = []
    for key in sorted(before.keys() | after.keys()):
        olds, news = before.get(key, []), after.get(key, [])
        if not news:
            if key[1] in names:
                changes += _list_kind_changes(olds, key[1], after)
            else:
                gone += _remove_duplicates(olds)
        elif not olds:
            come += _remove_duplicates(news)
        else:
            changes += _compare_same_name(olds, news)
    lost, found = {one.name for _, one in gone}, {one.name for _, one in come}
    known_before = {name for _, name in before}
    changes += _guess_renamed(gone, come)
    for path, one in gone:
        if _find_owner(one.name) not in lost:
            changes.append(CppChange("removed", one.name, one, None, path, "", (), _is_implicit(one)))
    for path, one in come:
        if _find_owner(one.name) in found:
            continue
        if one.name not in known_before:
            changes.append(CppChange("added", one.name, None, one, "", path, compatible="pure" not in one.traits))
    moved = {change.name for change in changes if change.kind == "moved"}
    return tuple(
        sorted(
            (change for change in changes if not (change.kind == "moved" and _find_owner(change.name) in moved)),
            key=lambda change: (change.name, change.kind, change.old_header, change.new_header),
        )
    )


def _is_implicit(one: Entity) -> bool:
    """Whether the compiler makes it when nobody writes it: a destructor, and constructors with no others beside."""
    if one.kind == "destructor":
        return "virtual" not in one.traits
    return one.kind == "constructor" and (
        _is_copy(one) or all(parameter.default is not None for parameter in one.parameters or ())
    )


def _is_copy(one: Entity) -> bool:
    """Whether it is a copy or move constructor."""
    types = _get_types(one)
    return (
        one.kind == "constructor"
        and len(types) == 1
        and types[0].removeprefix("const ").rstrip("&") == _strip_owner(one.name)
    )


def _group_offered(headers: Mapping[str, HeaderSurface]) -> dict[tuple[str, str], list[_Placed]]:
    """Entities by family and name, as users write it."""
    inline = {name for surface in headers.values() for name in surface.inline}
    found: dict[tuple[str, str], list[_Placed]] = defaultdict(list)
    for path in sorted(headers):
        for one in headers[path].entities:
            if one.kind == "using namespace":
                continue
            name = drop_inline(one.name, inline)
            if one.arguments:
                name = f"{name}<{one.arguments}>"
            if name != one.name:
                one = msgspec.structs.replace(one, name=name)
            found[_find_family(one), name].append((path, one))
    return found


def _find_family(one: Entity) -> str:
    if one.kind in FUNCTIONS:
        return "function"
    if one.kind in CLASSES or one.kind in ("alias", "enum"):
        return "type"
    if one.kind in ("variable", "field", "enumerator"):
        return "value"
    return one.kind


def _find_owner(name: str) -> str:
    """The scope of a name; template arguments may hold `::` too."""
    depth = 0
    for place in range(len(name) - 1, 0, -1):
        sign = name[place]
        depth += (sign == ">") - (sign == "<")
        if sign == ":" and depth == 0 and name[place - 1] == ":":
            return name[: place - 1]
    return ""


def _strip_owner(name: str) -> str:
    owner = _find_owner(name)
    return name[len(owner) + 2 :] if owner else name


def _remove_duplicates(placed: Sequence[_Placed]) -> list[_Placed]:
    seen: set[tuple] = set()
    kept: list[_Placed] = []
    for path, one in placed:
        key = _make_signature(one)
        if key not in seen:
            seen.add(key)
            kept.append((path, one))
    return kept


def _get_types(one: Entity) -> tuple[str, ...]:
    return tuple(parameter.type for parameter in one.parameters or ())


def _make_signature(one: Entity) -> tuple:
    """What tells overloads apart."""
    return (one.kind, _get_types(one), "const" in one.traits, "&" in one.traits, "&&" in one.traits, _get_template(one))


def _get_template(one: Entity) -> tuple[tuple[str, str, bool], ...]:
    return tuple((parameter.kind, parameter.type, parameter.pack) for parameter in one.template or ())


def _list_kind_changes(
    olds: Sequence[_Placed], name: str, after: Mapping[tuple[str, str], list[_Placed]]
) -> Iterable[CppChange]:
    path, one = olds[0]
    there, other = next(placed[0] for (_, offered), placed in after.items() if offered == name)
    yield CppChange("signature", name, one, other, path, there, ("kind",), other.kind in ("using", "alias"))


def _compare_same_name(olds: Sequence[_Placed], news: Sequence[_Placed]) -> list[CppChange]:
    """Differences of the entities of one name, overloads paired."""
    if len(olds) == len(news) and all(map(_is_unchanged, olds, news)):
        return []
    changes: list[CppChange] = []
    old_paths, new_paths = {path for path, _ in olds}, {path for path, _ in news}
    left = _remove_duplicates(news)
    unpaired: list[_Placed] = []
    pairs: list[tuple[_Placed, _Placed]] = []
    for placed in _remove_duplicates(olds):
        match = next((other for other in left if _make_signature(other[1]) == _make_signature(placed[1])), None)
        if match is None:
            unpaired.append(placed)
        else:
            left.remove(match)
            pairs.append((placed, match))
    candidates = sorted(
        (
            (_compute_distance(placed[1], other[1]), first, second)
            for first, placed in enumerate(unpaired)
            for second, other in enumerate(left)
        ),
    )
    alone = len(unpaired) == 1 and len(left) == 1
    used_old: set[int] = set()
    used_new: set[int] = set()
    for cost, first, second in candidates:
        if first in used_old or second in used_new or (cost > 0.5 and not alone):
            continue
        used_old.add(first)
        used_new.add(second)
        pairs.append((unpaired[first], left[second]))
    for (path, one), (there, other) in pairs:
        changes += _compare_pair(path, one, there, other, [offered for _, offered in news])
    removed = [placed for number, placed in enumerate(unpaired) if number not in used_old]
    added = [placed for number, placed in enumerate(left) if number not in used_new]
    for path, one in removed:
        # an overload that another one takes over is no loss
        taken = _is_copy(one) or ("virtual" not in one.traits and is_still_callable(one, [other for _, other in news]))
        changes.append(CppChange("removed", one.name, one, None, path, "", ("overload",), taken))
    for path, one in added:
        changes.append(CppChange("added", one.name, None, one, "", path, ("overload",), "pure" not in one.traits))
    if not old_paths & new_paths:
        path, one = olds[0]
        there, other = news[0]
        changes.append(CppChange("moved", one.name, one, other, path, there))
    return changes


def _is_unchanged(old: _Placed, new: _Placed) -> bool:
    """Whether nothing changed but the line. Most entities of two versions are so, and no more is asked of them."""
    (path, one), (there, other) = old, new
    return path == there and (one == other or msgspec.structs.replace(one, line=other.line) == other)


def _compute_distance(one: Entity, other: Entity) -> float:
    """0 for the same parameters, 1 for nothing in common."""
    mine, theirs = _get_types(one), _get_types(other)
    ratio = 1.0 if not mine and not theirs else SequenceMatcher(None, mine, theirs, autojunk=False).ratio()
    return 1 - ratio + 0.1 * (one.type != other.type) + 0.1 * (("const" in one.traits) != ("const" in other.traits))


def _compare_pair(path: str, one: Entity, there: str, other: Entity, offered: Sequence[Entity]) -> list[CppChange]:
    """Differences of two entities; offered: all of that name in the new version."""
    changes: list[CppChange] = []

    def add_change(kind: str, compatible: bool, *what: str) -> None:
        changes.append(CppChange(kind, one.name, one, other, path, there, what, compatible))

    if one.deprecated is None and other.deprecated is not None:
        add_change("deprecated", True)
    if one.kind == "enumerator" and other.kind == "enumerator":
        if one.value != other.value:
            add_change("value", True)
        return changes
    what = _list_differences(one, other)
    if what:
        add_change("signature", _is_compatible(one, other, what, offered), *what)
    if one.value and other.value and one.value != other.value:
        add_change("value", True)
    if _changes_defaults(one.parameters, other.parameters) or _changes_template_defaults(one, other):
        add_change("default", _find_family(one) != "function" or is_still_callable(one, offered))
    if one.kind in CLASSES and other.kind in CLASSES and one.bases != other.bases:
        add_change("base", {base.type for base in one.bases} <= {base.type for base in other.bases})
    if one.access == "public" and other.access in ("protected", "private"):
        add_change("access", False)
    for trait in ("deleted", "pure", "final"):
        if trait in other.traits and trait not in one.traits:
            add_change(trait, False)
    return changes


def _list_differences(one: Entity, other: Entity) -> list[str]:
    """In what two entities of one name differ, in the words of Change."""
    what: list[str] = []
    if _find_family(one) != "function":
        if one.kind != other.kind and not (one.kind in CLASSES and other.kind in CLASSES):
            what.append("kind")
        elif one.type != other.type and one.kind not in CLASSES:
            what.append("type")
        if one.kind == "macro" and _get_macro_arity(one) != _get_macro_arity(other):
            what.append("arity")
        if one.kind == "enum" and ("scoped" in one.traits) != ("scoped" in other.traits):
            what.append("kind")
        if ("static" in one.traits) != ("static" in other.traits) and one.kind == "field":
            what.append("static")
        if _get_template(one) != _get_template(other):
            what.append("template")
        return what
    mine, theirs = _get_types(one), _get_types(other)
    if len(mine) != len(theirs) or ("variadic" in one.traits) != ("variadic" in other.traits):
        what.append("arity")
        if mine[: len(theirs)] != theirs[: len(mine)]:
            what.append("types")
    elif mine != theirs:
        what.append("types")
    if one.type != other.type:
        what.append("result")
    for trait in ("const", "static", "virtual", "explicit"):
        if (trait in one.traits) != (trait in other.traits):
            what.append(trait)
    if {"&", "&&"} & set(one.traits) != {"&", "&&"} & set(other.traits):
        what.append("ref")
    if _get_template(one) != _get_template(other):
        what.append("template")
    if "virtual" in one.traits and {"arity", "types", "result", "const", "virtual"} & set(what):
        what.append("override")
    return what


def _get_macro_arity(one: Entity) -> tuple[str, ...] | int | None:
    if one.parameters is None:
        return None
    return len(one.parameters)


def _is_compatible(one: Entity, other: Entity, what: Sequence[str], offered: Sequence[Entity]) -> bool:
    if _find_family(one) != "function":
        return list(what) == ["kind"] and other.kind == "alias"
    if "override" in what or "ref" in what:
        return False
    if "template" in what and one.template:
        return False
    return is_still_callable(one, offered)


def is_still_callable(one: Entity, offered: Sequence[Entity]) -> bool:
    """Whether every call of a function still finds one that takes it, by the types of its parameters as written."""
    mine = one.parameters or ()
    least = sum(parameter.default is None and not parameter.pack for parameter in mine)
    return all(any(_accepts(one, mine[:count], other) for other in offered) for count in range(least, len(mine) + 1))


def _accepts(one: Entity, given: Sequence[CppParameter], other: Entity) -> bool:
    """Whether what is given to one function can be given to another instead."""
    taken = other.parameters or ()
    if "deleted" in other.traits or _find_family(other) != "function":
        return False
    if one.type not in (other.type, "void"):
        return False
    if "const" in one.traits and "const" not in other.traits and "static" not in other.traits:
        return False
    if "static" in one.traits and "static" not in other.traits and one.access:
        return False
    if "explicit" in other.traits and "explicit" not in one.traits:
        return False
    if "variadic" in one.traits and "variadic" not in other.traits:
        return False
    if len(taken) < len(given) or not all(map(_takes, given, taken)):
        return False
    return all(parameter.default is not None or parameter.pack for parameter in taken[len(given) :])


def _takes(given: CppParameter, taken: CppParameter) -> bool:
    """Whether what could be given to a parameter of one type can be given to one of another."""
    if given.type == taken.type:
        return True
    mine, theirs = given.type, taken.type
    if theirs.endswith("&") and not theirs.endswith("&&") and theirs.startswith("const "):
        bare = theirs[6:-1]
        return mine in (bare, bare + "&")
    return mine == f"const {theirs}&"


def _changes_defaults(mine: Sequence[CppParameter] | None, theirs: Sequence[CppParameter] | None) -> bool:
    return any(
        one.default is not None and one.default != other.default and one.type == other.type
        for one, other in zip(mine or (), theirs or (), strict=False)
    )


def _changes_template_defaults(one: Entity, other: Entity) -> bool:
    return any(
        mine.default is not None and mine.default != theirs.default
        for mine, theirs in zip(one.template or (), other.template or (), strict=False)
    )


def _guess_renamed(gone: Sequence[_Placed], come: Sequence[_Placed]) -> list[CppChange]:
    """Hints: what is gone and what has come with a near name in the same scope, or with the same name in another one,
    and otherwise alike. Each of them is in one hint at most, the surest."""
    members_gone, members_come = _collect_members(gone), _collect_members(come)
    by_scope: dict[tuple[str, str], list[int]] = defaultdict(list)
    by_name: dict[tuple[str, str], list[int]] = defaultdict(list)
    for number, (_, one) in enumerate(come):
        by_scope[one.kind, _find_owner(one.name)].append(number)
        by_name[one.kind, _strip_owner(one.name)].append(number)
    lost, found = {one.name for _, one in gone}, {one.name for _, one in come}
    hints: list[tuple[float, bool, int, int]] = []
    for first, (_, one) in enumerate(gone):
        simple = _strip_owner(one.name)
        if one.kind in ("constructor", "destructor") or _find_owner(one.name) in lost:
            continue
        for second in {*by_scope[one.kind, _find_owner(one.name)], *by_name[one.kind, simple]}:
            other = come[second][1]
            if _find_owner(other.name) in found:
                continue
            sure = _compute_likeness(one, other, members_gone, members_come)
            if sure >= _SIMILAR:
                hints.append((-sure, gone[first][0] != come[second][0], first, second))
    changes: list[CppChange] = []
    used_old: set[int] = set()
    used_new: set[int] = set()
    for less, _, first, second in sorted(hints):  # of what is equally alike, that in the same header
        if first in used_old or second in used_new:
            continue
        used_old.add(first)
        used_new.add(second)
        (path, one), (there, other) = gone[first], come[second]
        changes.append(CppChange("renamed", one.name, one, other, path, there, (), False, round(-less, 2)))
    return changes


def _collect_members(placed: Sequence[_Placed]) -> dict[str, set[str]]:
    found: dict[str, set[str]] = defaultdict(set)
    for _, one in placed:
        if one.kind not in ("constructor", "destructor"):
            found[_find_owner(one.name)].add(_strip_owner(one.name))
    return found


def _compute_likeness(
    one: Entity, other: Entity, members_gone: Mapping[str, set[str]], members_come: Mapping[str, set[str]]
) -> float:
    """How sure it is that both are one thing under two names, 0 to 1."""
    mine, theirs = _strip_owner(one.name), _strip_owner(other.name)
    names = SequenceMatcher(
        None, mine.lower().replace("_", ""), theirs.lower().replace("_", ""), autojunk=False
    ).ratio()
    if names < _SIMILAR:
        return 0.0
    if one.kind in CLASSES or one.kind == "enum":
        inner, outer = members_gone.get(one.name, set()), members_come.get(other.name, set())
        if not inner and not outer:
            return names * 0.8
        return (names + len(inner & outer) / len(inner | outer)) / 2
    if one.kind in FUNCTIONS:
        if _get_types(one) != _get_types(other) or one.type != other.type:
            return 0.0
        # without parameters, alike signatures say little
        return names if one.parameters else names * 0.9
    if one.kind == "enumerator":
        return names if one.value == other.value else 0.0
    if one.kind == "macro":
        return names if _get_macro_arity(one) == _get_macro_arity(other) and one.value == other.value else 0.0
    return names if one.type == other.type else 0.0
