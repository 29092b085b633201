"""Declared dependencies of released packages, from the rosdistro caches that superflore commits into meta-ros.

`meta-ros1-DISTRO/files/DISTRO/generated/cache.yaml` (and meta-ros2-...) is the official rosdistro cache of a day: it
holds the package.xml of every released package. Only what is declared is kept, never a text.
"""

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import msgspec
import yaml

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_SECTION = re.compile(rb"^release_package_xmls:[ \t]*\r?\n", re.MULTILINE)
_NEXT_SECTION = re.compile(rb"^[^\s#]", re.MULTILINE)
_BLOCK = re.compile(rb"\n(?=  [^\s])")
_FOLDER = re.compile(r"meta-ros[12]?-([a-z]+)$")
_STAMP = re.compile(rb"^#.*?\b(\d{14})\b", re.MULTILINE)

KIND_LETTERS = {
    "build_depend": "b",
    "build_export_depend": "e",
    "buildtool_depend": "t",
    "buildtool_export_depend": "o",
    "exec_depend": "x",
    "run_depend": "ex",
    "depend": "bex",
    "test_depend": "s",
    "doc_depend": "d",
    "conflict": "c",
    "replace": "r",
    "group_depend": "g",
    "member_of_group": "m",
}
"""Tag → letters of snapshot.KINDS. Source: REP 127 (format 1: run_depend), REP 140 and REP 149."""

_BOUNDS = ("version_lt", "version_lte", "version_eq", "version_gte", "version_gt")
_ORDER = "betoxsdcrgm"


class DeclaredVersion(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One package version of a distro: its dependencies as lines (see write.SCHEMA) and its build type."""

    distro: str
    package: str
    version: str
    entries: str
    build_type: str


def parse_manifest(distro: str, text: str) -> DeclaredVersion | None:
    """What a package.xml declares, None when it is none. Entities are refused by size, since a manifest needs none."""
    if "<!ENTITY" in text:
        return None
    try:
        root = ElementTree.fromstring(text.encode())
    except ElementTree.ParseError:
        return None
    name, version = (root.findtext("name") or "").strip(), (root.findtext("version") or "").strip()
    if not name:
        return None
    kinds: dict[tuple[str, str, str], set[str]] = {}
    for element in root:
        letters = KIND_LETTERS.get(element.tag) if isinstance(element.tag, str) else None
        target = " ".join((element.text or "").split())
        if not letters or not target:
            continue
        bounds = " ".join(f"{bound}={element.get(bound, '').strip()}" for bound in _BOUNDS if element.get(bound))
        condition = " ".join((element.get("condition") or "").split())
        kinds.setdefault((target, condition, bounds), set()).update(letters)
    lines = []
    for (target, condition, bounds), letters in sorted(kinds.items()):
        ordered = "".join(letter for letter in _ORDER if letter in letters)
        lines.append("\t".join((target, ordered, condition, bounds)).rstrip("\t"))
    return DeclaredVersion(distro, name, version, "\n".join(lines), _build_type(root))


def _build_type(root: ElementTree.Element) -> str:
    """Build types of the export section, `type:condition` where they are conditional, separated by `;`."""
    export = root.find("export")
    found = []
    for element in export.findall("build_type") if export is not None else ():
        condition = " ".join((element.get("condition") or "").split())
        found.append((element.text or "").strip() + (f":{condition}" if condition else ""))
    return ";".join(found)


def split_cache(data: bytes) -> list[bytes]:
    """The blocks `name: <package.xml>` of a cache file."""
    start = _SECTION.search(data)
    if start is None:
        return []
    body = data[start.end() :]
    end = _NEXT_SECTION.search(body)
    return _BLOCK.split(b"\n" + (body[: end.start()] if end else body))[1:]


def cache_stamp(data: bytes) -> str:
    """The moment (YYYYMMDDhhmmss) that superflore wrote in the first line of a cache, empty when it did not."""
    found = _STAMP.match(data[:400])
    return found.group(1).decode() if found else ""


def cache_blobs(repository: Any, done: Callable[[int], None] | None = None) -> dict[str, list[str]]:
    """{distro: blob ids of every cache ever committed on any branch}, in order of first sight, oldest first."""
    import pygit2

    walker = repository.walk(None, pygit2.enums.SortMode.TOPOLOGICAL | pygit2.enums.SortMode.REVERSE)
    for name in repository.references:
        commit = repository.references[name].peel()
        if isinstance(commit, pygit2.Commit):
            walker.push(commit.id)
    found: dict[str, dict[str, None]] = {}
    seen: set[Any] = set()
    for count, commit in enumerate(walker):
        if done and count % 1000 == 0:
            done(count)
        if commit.tree_id in seen:
            continue
        seen.add(commit.tree_id)
        for entry in commit.tree:
            match = _FOLDER.match(entry.name or "")
            if match is None or entry.id in seen or entry.type_str != "tree":
                continue
            seen.add(entry.id)
            distro = match.group(1)
            try:
                cache = entry / "files" / distro / "generated" / "cache.yaml"
            except KeyError:
                continue
            found.setdefault(distro, {})[str(cache.id)] = None
    return {distro: list(blobs) for distro, blobs in found.items()}


def read_caches(distro: str, caches: Iterable[bytes]) -> list[DeclaredVersion]:
    """Every package version in a distro's caches. Where two caches disagree on one version the later one stands."""
    memo: set[bytes] = set()
    found: dict[tuple[str, str], DeclaredVersion] = {}
    for data in sorted(caches, key=cache_stamp):
        for block in split_cache(data):
            if block in memo:
                continue
            memo.add(block)
            text = _extract_text(block)
            declared = parse_manifest(distro, text) if text else None
            if declared:
                found[declared.package, declared.version] = declared
    return list(found.values())


def _extract_text(block: bytes) -> str:
    try:
        parsed = yaml.load(block, Loader=_LOADER)
    except (yaml.YAMLError, ValueError):
        return ""
    if not isinstance(parsed, dict):
        return ""
    value = next(iter(parsed.values()), "")
    return value if isinstance(value, str) else ""


def changes_only(declared: Sequence[DeclaredVersion], version_key: Callable[[str], list[int]]) -> list[DeclaredVersion]:
    """One entry where the declaration changed with a version, in version order; what lies between is the same."""
    by_package: dict[tuple[str, str], list[DeclaredVersion]] = {}
    for item in declared:
        by_package.setdefault((item.distro, item.package), []).append(item)
    kept = []
    for items in by_package.values():
        items.sort(key=lambda item: (version_key(item.version), item.version))
        before: tuple[str, str] | None = None
        for item in items:
            if (item.entries, item.build_type) != before:
                kept.append(item)
                before = (item.entries, item.build_type)
    return sorted(kept, key=lambda item: (item.distro, item.package, version_key(item.version)))
