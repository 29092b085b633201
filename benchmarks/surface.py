"""Compares what is read from C++ headers with what a compiler sees in them, and times the reading.

usage: surface.py compare HEADER ... [-- COMPILER ARGUMENTS]     needs libclang (pip install libclang)
       surface.py speed REPOSITORY ...                           bare mirrors or clones, at HEAD

compare: every header is compiled by itself; those with errors are left out and counted. Entities under preprocessor
conditions that the compiler leaves out, and what macros declare that only the compiler expands, are told apart.
Both sides give (kind, name); for pairs of them every attribute is compared.
speed: CPU time of all headers of a repository, beside a bare tree-sitter parse of the same bytes.
"""

from __future__ import annotations

import argparse
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Any, NamedTuple

HEADER = re.compile(r"\.(?:h|hpp|hh|hxx|h\+\+|ipp|tpp|tcc|inl|cuh)$")
ATTRIBUTES = (
    "parameters", "types", "names", "defaults", "result", "const", "static", "virtual", "pure", "explicit", "deleted",
    "defaulted", "noexcept", "access", "deprecated", "template", "bases", "value", "line",
)  # fmt: skip


class Seen(NamedTuple):
    """An entity as both sides tell it: kind, name, attributes."""

    kind: str
    name: str
    attributes: dict[str, Any]


# What the compiler sees


def compiled(paths: list[str], arguments: list[str]) -> dict[str, list[Seen]]:
    """Public and protected entities that headers declare themselves, by header. All are compiled in one unit, without
    those that have errors by themselves when it has any."""
    from clang import cindex

    index = cindex.Index.create()

    def unit_of(chosen: list[str]):
        return index.parse(
            "all.cpp",
            args=["-x", "c++", "-std=c++17", *arguments],
            unsaved_files=[("all.cpp", "".join(f'#include "{path}"\n' for path in chosen))],
            options=cindex.TranslationUnit.PARSE_SKIP_FUNCTION_BODIES,
        )

    def errors(unit) -> list[str]:
        return [
            str(diagnostic.location.file)
            for diagnostic in unit.diagnostics
            if diagnostic.severity >= cindex.Diagnostic.Error
        ]

    unit = unit_of(paths)
    while bad := errors(unit):
        kept = [path for path in paths if path not in bad]
        if len(kept) == len(paths):
            kept = [path for path in paths if not errors(unit_of([path]))]
            if len(kept) == len(paths):
                sys.exit(f"these headers compile alone and not together: {bad[:5]}")
        paths = kept
        unit = unit_of(paths)
    found: dict[str, list[Seen]] = {path: [] for path in paths}
    wanted = {os.path.realpath(path): path for path in paths}
    names: dict[str, str | None] = {}
    for child in unit.cursor.get_children():
        file = child.location.file
        if file is None:
            continue
        name = file.name
        if name not in names:
            names[name] = wanted.get(os.path.realpath(name))
        known = names[name]
        if known is not None:
            _take(child, name, "", found[known])
    return found


_KINDS = {
    "CLASS_DECL": "class", "STRUCT_DECL": "struct", "UNION_DECL": "union", "ENUM_DECL": "enum",
    "CLASS_TEMPLATE": "class", "CLASS_TEMPLATE_PARTIAL_SPECIALIZATION": "class", "FUNCTION_DECL": "function",
    "CXX_METHOD": "method", "CONSTRUCTOR": "constructor", "DESTRUCTOR": "destructor", "CONVERSION_FUNCTION":
    "conversion", "FUNCTION_TEMPLATE": "function", "VAR_DECL": "variable", "FIELD_DECL": "field", "TYPEDEF_DECL":
    "alias", "TYPE_ALIAS_DECL": "alias", "TYPE_ALIAS_TEMPLATE_DECL": "alias",
}  # fmt: skip


def _descend(cursor, path: str, prefix: str, found: list[Seen]) -> None:
    for child in cursor.get_children():
        where = child.location
        if where.file is not None and where.file.name == path:
            _take(child, path, prefix, found)


def _take(child, path: str, prefix: str, found: list[Seen]) -> None:
    kind = child.kind.name
    if kind in ("NAMESPACE", "LINKAGE_SPEC", "UNEXPOSED_DECL"):
        name = child.spelling if kind == "NAMESPACE" and "(anonymous" not in child.spelling else ""
        _descend(child, path, prefix + (name + "::" if name else ""), found)
        return
    if kind == "FRIEND_DECL":
        for declared in child.get_children():
            if declared.kind.name in ("FUNCTION_DECL", "FUNCTION_TEMPLATE") and not _elsewhere(declared):
                space = declared.semantic_parent
                if not declared.spelling.startswith("~"):
                    found.append(Seen("function", _space(space) + declared.spelling, _function(declared, friend=True)))
        return
    if kind not in _KINDS:
        return
    known = _KINDS[kind]
    if child.lexical_parent is not None and child.semantic_parent != child.lexical_parent and child.semantic_parent:
        if child.semantic_parent.kind.name not in ("NAMESPACE", "TRANSLATION_UNIT", "LINKAGE_SPEC"):
            return
        if _space(child.semantic_parent) != prefix:
            return
    access = child.access_specifier.name.lower()
    access = access if access in ("public", "protected", "private") else ""
    if known in ("class", "struct", "union", "enum"):
        _type(child, known, access, path, prefix, found)
        return
    if known in ("function", "method", "constructor", "destructor", "conversion"):
        seen = _function(child, friend=False)
        if kind == "FUNCTION_TEMPLATE":
            known = _template_kind(child)
        if access == "private" and not (seen["virtual"] or seen["deleted"] or known in ("constructor", "destructor")):
            return
        name = re.sub(r"<[^()]*>$", "", child.spelling) if known in ("constructor",) else child.spelling
        if kind == "FUNCTION_DECL" and _explicit(child):
            return
        if kind == "FUNCTION_TEMPLATE":
            name = re.sub(r"<[^()]*>$", "", name) if known == "constructor" else name
        if known == "destructor":
            name = name.partition("<")[0]
        if known == "guide":
            return
        if known == "destructor":
            name = name.partition("<")[0]
        found.append(Seen(known, prefix + name, seen))
        return
    if access == "private":
        return
    name = child.spelling
    if not name:
        return
    attributes: dict[str, Any] = {
        "access": access,
        "line": child.location.line,
        "column": child.location.column,
        "deprecated": _deprecated(child),
    }
    if known == "alias":
        attributes["result"] = child.underlying_typedef_type.spelling if "TEMPLATE" not in kind else None
    else:
        attributes["result"] = child.type.spelling
        if known == "variable":
            attributes["static"] = None
            if child.semantic_parent.kind.name in (
                "CLASS_DECL",
                "STRUCT_DECL",
                "CLASS_TEMPLATE",
                "UNION_DECL",
                "CLASS_TEMPLATE_PARTIAL_SPECIALIZATION",
            ):
                known = "field"
    found.append(Seen(known, prefix + name, attributes))


def _elsewhere(cursor) -> bool:
    """Whether a friend is named with its scope, so that it is declared elsewhere."""
    words = [token.spelling for token in cursor.get_tokens()]
    name = cursor.spelling
    for place, word in enumerate(words):
        if word == name and place and words[place - 1] == "::":
            return True
        if word == "operator" and place and words[place - 1] == "::":
            return True
    return False


def _explicit(cursor) -> bool:
    """`template<> void f<int>()`: what is offered is the general one."""
    words = [token.spelling for _, token in zip(range(3), cursor.get_tokens(), strict=False)]
    return words == ["template", "<", ">"] or words[:1] == ["template"]


def _space(cursor) -> str:
    parts = []
    while cursor is not None and cursor.kind.name != "TRANSLATION_UNIT":
        if cursor.spelling and cursor.kind.name != "LINKAGE_SPEC" and "(anonymous" not in cursor.spelling:
            parts.insert(0, cursor.spelling)
        cursor = cursor.semantic_parent
    return "".join(part + "::" for part in parts)


def _template_kind(cursor) -> str:
    parent = cursor.semantic_parent
    within = parent.kind.name in (
        "CLASS_DECL", "STRUCT_DECL", "CLASS_TEMPLATE", "UNION_DECL", "CLASS_TEMPLATE_PARTIAL_SPECIALIZATION",
    )  # fmt: skip
    if cursor.spelling.startswith("<deduction guide"):
        return "guide"
    if not within:
        return "function"
    bare = re.sub(r"<.*", "", cursor.spelling)
    if bare == re.sub(r"<.*", "", parent.spelling):
        return "constructor"
    if cursor.spelling.startswith("operator ") and cursor.result_type.spelling == cursor.spelling[9:]:
        return "conversion"
    return "method"


def _type(child, known: str, access: str, path: str, prefix: str, found: list[Seen]) -> None:
    kind = child.kind.name
    if kind.startswith("CLASS_TEMPLATE"):
        words = [token.spelling for token in child.get_tokens()]
        depth = 0
        for word in words:
            depth += (word == "<") - (word == ">")
            if depth == 0 and word in ("class", "struct", "union"):
                known = word
                break
    if access == "private" or not child.is_definition():
        return
    anonymous = child.is_anonymous() or "(unnamed" in child.spelling or "(anonymous" in child.spelling
    name = "" if anonymous else child.spelling
    own = None
    if (
        child.semantic_parent is not None
        and child.lexical_parent is not None
        and child.semantic_parent != child.lexical_parent
        and _space(child.semantic_parent) != prefix
    ):
        return
    if name:
        own = {
            "access": access,
            "line": child.location.line,
            "column": child.location.column,
            "deprecated": _deprecated(child),
            "bases": [one.type.spelling for one in child.get_children() if one.kind.name == "CXX_BASE_SPECIFIER"],
            "template": None,
        }
        if kind.startswith("CLASS_TEMPLATE") and "PARTIAL" not in kind:
            own["template"] = _templates(child)
        found.append(Seen(known, prefix + name, own))
    if kind == "ENUM_DECL":
        scoped = child.is_scoped_enum()
        for one in child.get_children():
            if one.kind.name == "ENUM_CONSTANT_DECL":
                found.append(
                    Seen(
                        "enumerator",
                        prefix + (name + "::" if scoped and name else "") + one.spelling,
                        {
                            "value": None if _dependent(child) else one.enum_value,
                            "line": one.location.line,
                            "column": one.location.column,
                            "deprecated": _deprecated(one),
                        },
                    )
                )
        return
    shown = name
    if name and (
        kind.endswith("PARTIAL_SPECIALIZATION")
        or ("<" in child.type.spelling.rpartition("::")[2] and kind != "CLASS_TEMPLATE")
    ):
        shown = name + "<>"
    _descend(child, path, prefix + (shown + "::" if shown else ""), found)


def _templates(cursor) -> int:
    return sum(
        one.kind.name in ("TEMPLATE_TYPE_PARAMETER", "TEMPLATE_NON_TYPE_PARAMETER", "TEMPLATE_TEMPLATE_PARAMETER")
        for one in cursor.get_children()
    )


def _deprecated(cursor) -> bool:
    return cursor.availability.name == "DEPRECATED"


def _function(cursor, *, friend: bool) -> dict[str, Any]:
    template = cursor.kind.name == "FUNCTION_TEMPLATE"
    given = [one for one in cursor.get_children() if one.kind.name == "PARM_DECL"]
    specification = cursor.exception_specification_kind.name
    return {
        "parameters": len(given),
        "types": [one.type.spelling for one in given],
        "names": [one.spelling for one in given],
        "defaults": [any(token.spelling == "=" for token in one.get_tokens()) for one in given],
        "result": None
        if cursor.kind.name in ("CONSTRUCTOR", "DESTRUCTOR") or _template_kind(cursor) == "constructor"
        else cursor.result_type.spelling,
        "const": cursor.is_const_method(),
        "static": cursor.is_static_method() if _access(cursor) else None,
        "virtual": _says_virtual(cursor) and (cursor.is_virtual_method() or _dependent(cursor)),
        "pure": cursor.is_pure_virtual_method(),
        "explicit": cursor.is_explicit_method() if hasattr(cursor, "is_explicit_method") and not template else None,
        "deleted": cursor.is_deleted_method() if hasattr(cursor, "is_deleted_method") and not template else None,
        "defaulted": cursor.is_default_method() if not template else None,
        "noexcept": specification in ("BASIC_NOEXCEPT", "COMPUTED_NOEXCEPT", "DYNAMIC_NONE")
        if cursor.kind.name != "DESTRUCTOR"
        and specification not in ("UNEVALUATED", "UNINSTANTIATED", "UNPARSED")
        and "COMPUTED" not in specification
        else None,
        "access": "" if friend else _access(cursor),
        "deprecated": _deprecated(cursor),
        "template": _templates(cursor) if template else None,
        "line": cursor.location.line,
        "column": cursor.location.column,
    }


def _says_virtual(cursor) -> bool:
    """Whether the declaration itself says so: what a base class tells is not in the header."""
    for token in cursor.get_tokens():
        if token.spelling in ("virtual", "override", "final"):
            return True
        if token.spelling == "{":
            return False
    return False


def _dependent(cursor) -> bool:
    """Whether it stands in a template, where the compiler knows neither bases nor values yet."""
    while cursor is not None and cursor.kind.name != "TRANSLATION_UNIT":
        if cursor.kind.name.startswith("CLASS_TEMPLATE"):
            return True
        cursor = cursor.semantic_parent
    return False


def _access(cursor) -> str:
    access = cursor.access_specifier.name.lower()
    return access if access in ("public", "protected", "private") else ""


# What is read


def read(path: str) -> tuple[list[Seen], set[int]]:
    """The same from our reader, and which of them (by place) stand under a condition or come from a macro."""
    from rosimpact.databuild.extract.cpp import extract
    from rosimpact.impact.facts.surface import FUNCTIONS

    found: list[Seen] = []
    unsure: set[int] = set()
    for entity in extract(pathlib.Path(path).read_bytes()).entities:
        if entity.kind in ("macro", "using", "using namespace", "namespace alias", "concept"):
            continue
        traits = entity.traits
        attributes: dict[str, Any] = {
            "access": entity.access,
            "line": entity.line,
            "deprecated": entity.deprecated is not None,
            "result": entity.type if entity.kind not in ("constructor", "destructor") else None,
            "template": len(entity.template) if entity.template is not None else None,
            "bases": [base.type for base in entity.bases],
            "value": int(entity.value) if re.fullmatch(r"-?\d+", entity.value) else None,
        }
        if entity.kind in FUNCTIONS and entity.parameters is not None:
            attributes |= {
                "parameters": len(entity.parameters),
                "types": [parameter.type for parameter in entity.parameters],
                "names": [parameter.name for parameter in entity.parameters],
                "defaults": [parameter.default is not None for parameter in entity.parameters],
                **{word: word in traits for word in ATTRIBUTES if word in ALL_TRAITS},
            }
        if entity.conditions or entity.macro:
            unsure.add(len(found))
        found.append(Seen(entity.kind, entity.name, attributes))
    return found, unsure


ALL_TRAITS = frozenset(("const", "static", "virtual", "pure", "explicit", "deleted", "defaulted", "noexcept"))


# Both


def bare(type_: str) -> str:
    """A type without the scopes that one side resolves and the other leaves as written."""
    from rosimpact.databuild.extract.cpp_types import read_parameter, split_tokens

    if type_ is None:
        return ""
    text = read_parameter([*split_tokens(type_)]).type if type_ else ""
    text = re.sub(r"\b\w+::", "", text)
    return re.sub(r"\b_Bool\b", "bool", text).replace(" ", "")


def _spelt(lines: list[str], other: Seen) -> bool:
    """Whether the header names it where the compiler sees it: what a macro declares has the place of the macro."""
    word = "operator" if "operator" in other.name else other.name.rpartition("::")[2]
    if "operator" in word:
        word = "operator"
    return lines[other.attributes["line"] - 1][other.attributes["column"] - 1 :].startswith(word.partition("<")[0])


def _alike(mine: str, theirs: str, name: str) -> bool:
    """Whether both are one type. The compiler writes the template arguments of the class that a member stands in."""
    one, other = bare(mine), bare(theirs)
    if one == other:
        return True
    around = name.split("::")[-2:-1]
    if around and around[0]:
        pattern = re.compile(rf"{re.escape(around[0].partition('<')[0])}<[^&*]*>(?=[&*]|$)")
        return pattern.sub(around[0].partition("<")[0], one) == pattern.sub(around[0].partition("<")[0], other)
    return "(unnamed" in theirs or "(anonymous" in theirs


def compare(paths: list[str], arguments: list[str], listed: int) -> int:
    """Prints precision, recall and how often each attribute agrees."""
    both = ours_only = theirs_only = skipped = unsure_only = by_macro = used = 0
    agree: dict[str, list[int]] = defaultdict(lambda: [0, 0])
    wrong: dict[str, list[str]] = defaultdict(list)
    kinds: Counter[str] = Counter()
    seen = compiled(paths, arguments)
    skipped = len(paths) - len(seen)
    for path, theirs in seen.items():
        used += 1
        ours, unsure = read(path)
        lines = pathlib.Path(path).read_text(errors="replace").splitlines()
        left: dict[tuple[str, str], list[tuple[int, Seen]]] = defaultdict(list)
        for place, one in enumerate(ours):
            left[_key(one)].append((place, one))
        taken: set[tuple[str, str]] = set()
        met: set[tuple[str, str, int]] = set()
        for other in theirs:
            # a second declaration of the same is not missed
            candidates = left.get(_key(other))
            if (
                not candidates
                and other.kind == "alias"
                and any(
                    left.get((kind, _key(other)[1])) or (kind, _key(other)[1]) in taken for kind in ("type", "enum")
                )
            ):
                continue  # `typedef struct {} Name`: the type itself is called so
            if not candidates:
                identity = (*_key(other), other.attributes["line"])
                if not _spelt(lines, other):
                    by_macro += 1
                elif identity not in met:
                    theirs_only += 1
                    wrong["missed"].append(f"{path}:{other.attributes['line']}: {other.kind} {other.name}")
                continue
            best = min(candidates, key=lambda pair: _distance(pair[1], other))
            candidates.remove(best)
            taken.add(_key(other))
            both += 1
            kinds[other.kind] += 1
            one = best[1]
            met.add((*_key(other), other.attributes["line"]))
            for name, value in other.attributes.items():
                if value is None or name not in one.attributes or name not in ATTRIBUTES:
                    continue
                mine = one.attributes[name]
                if name in ("types", "bases"):
                    same = len(mine) == len(value) and all(map(_alike, mine, value, [other.name] * len(mine)))
                elif name == "result":
                    same = _alike(mine, value, other.name)
                elif name == "value" and mine is None:
                    continue
                else:
                    same = mine == value
                agree[name][0] += same
                agree[name][1] += 1
                if not same:
                    wrong[name].append(f"{path}:{other.attributes['line']}: {other.name}: {mine} | {value}")
        for candidates in left.values():
            for place, one in candidates:
                if place in unsure:
                    unsure_only += 1
                else:
                    ours_only += 1
                    wrong["extra"].append(f"{path}:{one.attributes['line']}: {one.kind} {one.name}")
    print(
        f"headers {used}, not compiled {skipped}; entities both {both}, missed {theirs_only} "
        f"(and {by_macro} that the header does not spell out), extra {ours_only}, "
        f"extra under conditions or by macros {unsure_only}"
    )
    print(f"precision {both / max(1, both + ours_only):.4f}  recall {both / max(1, both + theirs_only):.4f}")
    print("  ".join(f"{kind} {number}" for kind, number in kinds.most_common()))
    for name in ATTRIBUTES:
        if agree[name][1]:
            print(f"{name:12} {agree[name][0] / agree[name][1]:.4f}  of {agree[name][1]}")
    for name, rows in wrong.items():
        for row in rows[:listed]:
            print(f"{name}\t{row}")
    return 0


def _key(one: Seen) -> tuple[str, str]:
    kind = {"class": "type", "struct": "type", "union": "type", "method": "function", "conversion": "function"}.get(
        one.kind, one.kind
    )
    name = re.sub(r"(operator) [\w:].*", r"\1 ", one.name) if one.kind == "conversion" else one.name
    scopes, _, last = name.partition("operator") if "operator" in name else ("", "", "")
    if not last:
        place = len(name)
        while (place := name.rfind("::", 0, place)) >= 0 and name.count("<", place) != name.count(">", place):
            pass
        scopes, last = name[: max(place, 0)], name[place + 2 if place >= 0 else 0 :]
    while "<" in scopes and (bare_scopes := re.sub(r"<[^<>]*>", "", scopes)) != scopes:
        scopes = bare_scopes
    return kind, re.sub(r"\s+", "", scopes + "::" + last)


def _distance(one: Seen, other: Seen) -> tuple[bool, int]:
    mine, theirs = one.attributes, other.attributes
    return mine["line"] != theirs["line"], sum(
        mine.get(name) != theirs.get(name) for name in ("parameters", "const", "static", "names")
    )


# Speed


def headers(repository: str) -> Iterator[bytes]:
    """The headers of a repository at HEAD."""
    listing = subprocess.run(
        ["git", "-C", repository, "ls-tree", "-r", "-z", "HEAD"], capture_output=True, check=True
    ).stdout.decode(errors="replace")
    identities = []
    for row in listing.split("\0"):
        meta, _, path = row.partition("\t")
        if HEADER.search(path) and meta.split()[1] == "blob":
            identities.append(meta.split()[2])
    given = "\n".join(dict.fromkeys(identities)).encode() + b"\n"
    answer = subprocess.run(
        ["git", "-C", repository, "cat-file", "--batch"], input=given, capture_output=True, check=True
    ).stdout
    place = 0
    while identities and place < len(answer):
        end = answer.index(b"\n", place)
        size = int(answer[place:end].split()[2])
        yield answer[end + 1 : end + 1 + size]
        place = end + size + 2


def speed(repositories: list[str]) -> int:
    """Prints the CPU time of each repository's headers, and medians over all."""
    from rosimpact.databuild.extract.cpp import extract
    from rosimpact.impact.facts.cpp.flow_grammar import LANGUAGE
    from tree_sitter import Parser

    parser = Parser(LANGUAGE)
    took: list[float] = []
    ours = bare_parse = 0.0
    number = 0
    for repository in repositories:
        sources = list(headers(repository))
        if not sources:
            continue
        start = time.process_time()
        for data in sources:
            extract(data)
        middle = time.process_time()
        for data in sources:
            parser.parse(data)
        end = time.process_time()
        took.append(middle - start)
        ours += middle - start
        bare_parse += end - middle
        number += len(sources)
        print(f"{middle - start:8.3f} s  bare parse {end - middle:8.3f} s  {len(sources):5} headers  {repository}")
    if took:
        print(
            f"{len(took)} repositories with headers: median {statistics.median(took):.3f} s; {number} headers, "
            f"{1000 * ours / number:.2f} ms each, {ours / bare_parse:.2f} times a bare parse"
        )
    return 0


def main() -> int:
    arguments = sys.argv[1:]
    compiler: list[str] = []
    if "--" in arguments:
        cut = arguments.index("--")
        arguments, compiler = arguments[:cut], arguments[cut + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("compare", "speed"))
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--list", type=int, default=0, metavar="N", help="print up to N differences of each sort")
    given = parser.parse_args(arguments)
    return compare(given.paths, compiler, given.list) if given.what == "compare" else speed(given.paths)


if __name__ == "__main__":
    sys.exit(main())
