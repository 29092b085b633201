"""Builds data/libraries.sqlite, changes_debian.json.zst and uses_debian.json: what versions of system libraries have,
and what they no longer have, or take.

    python -P -m rosimpact.databuild.debian WORK --suite bullseye=APT_CONF --suite bookworm=APT_CONF ... --clones CLONES

Libraries are read as libraries.py has it, written by library_file.py, and consecutive versions compared. CLONES holds
git clones (`OWNER+NAME`); versions before the first packaged one are read at their release tags there, into
changes_library_tags.json.zst. Only names and versions are kept.

A header is gone when no package of that release, or of a later one, has it. A name is gone when its last part is not
even a word in any header of its library in that version or a later one: then no macro, alias, specialisation or
`using` can have it. Names that the reviewed tables treat, and those that a ROS package has, are left out.
"""

from __future__ import annotations

import argparse
import json
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import zstandard

from ..edges.files import write_file
from ..impact.facts.surface import CLASSES, Entity, HeaderSurface, list_offered
from ..impact.targets.changes import load_rows, load_uses
from ..impact.targets.platform import CODENAMES
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA
from ..impact.targets.version import is_at_least, parse
from . import library_file, library_tags
from .includes import list_platform_versions
from .libraries import INNER, INNER_NAME, LibraryFacts, Run, Texts, count_uses, extract_upstream_version


class DebianLibrary(NamedTuple):
    """A library as Debian packages it. name: as in platform_versions.yaml. packages: whole names of its development
    packages. headers: paths below the include folder, whose group `path` is how they are included. names: how names of
    its own look, as a whole; bare ones only where nobody else would call anything so."""

    name: str
    packages: re.Pattern[str]
    headers: re.Pattern[str]
    names: re.Pattern[str]


def _make_library(name: str, packages: str, headers: str, names: str) -> DebianLibrary:
    return DebianLibrary(
        name,
        re.compile(rf"(?:{packages})\Z"),
        re.compile(rf"(?:x86_64-linux-gnu/)?(?:{headers})\Z"),
        re.compile(rf"(?:{names})\Z"),
    )


_ENDING = r"\.(?:h|hpp|hh|hxx|inl|ipp)"
LIBRARIES = (
    _make_library("opencv", r"libopencv-[\w-]+", rf"opencv4/(?P<path>opencv2/.+{_ENDING})", r"cv::.+|CV_\w+"),
    _make_library("pcl", "libpcl-dev", rf"pcl-[\d.]+/(?P<path>pcl/.+{_ENDING})", r"pcl::.+|PCL_\w+"),
    _make_library("boost", r"libboost1\.\d+-dev", rf"(?P<path>boost/.+{_ENDING})", r"boost::.+"),
    _make_library("eigen3", "libeigen3-dev", r"eigen3/(?P<path>(?:Eigen|unsupported)/.+)", r"Eigen::.+|EIGEN_\w+"),
    _make_library("yaml-cpp", "libyaml-cpp-dev", rf"(?P<path>yaml-cpp/.+{_ENDING})", r"YAML::.+"),
    _make_library("fmt", "libfmt-dev", rf"(?P<path>fmt/.+{_ENDING})", r"fmt::.+"),
    _make_library("tinyxml", "libtinyxml-dev", rf"(?P<path>tinyxml{_ENDING}|tinystr{_ENDING})", r"TiXml\w+"),
    _make_library("tinyxml2", "libtinyxml2-dev", rf"(?P<path>tinyxml2{_ENDING})", r"tinyxml2::.+"),
    _make_library("bullet", "libbullet-dev", rf"bullet/(?P<path>.+{_ENDING})", r"bt[A-Z]\w+(?:::.+)?|BT_[A-Z]\w+"),
    _make_library("orocos-kdl", "liborocos-kdl-dev", rf"(?P<path>kdl/.+{_ENDING})", r"KDL::.+"),
    _make_library("assimp", "libassimp-dev", rf"(?P<path>assimp/.+{_ENDING})", r"Assimp::.+|ai[A-Z]\w+(?:::.+)?"),
    _make_library("ceres", "libceres-dev", rf"(?P<path>ceres/.+{_ENDING})", r"ceres::.+"),
    _make_library("fcl", "libfcl-dev", rf"(?P<path>fcl/.+{_ENDING})", r"fcl::.+"),
    _make_library("ompl", "libompl-dev", rf"(?:ompl-[\d.]+/)?(?P<path>ompl/.+{_ENDING})", r"ompl::.+"),
    _make_library("octomap", "liboctomap-dev", rf"(?P<path>octomap/.+{_ENDING})", r"octomap::.+|octomath::.+"),
    _make_library("spdlog", "libspdlog-dev", rf"(?P<path>spdlog/.+{_ENDING})", r"spdlog::.+|SPDLOG_\w+"),
    _make_library("protobuf", "libprotobuf-dev", rf"(?P<path>google/protobuf/.+{_ENDING})", r"google::protobuf::.+"),
    _make_library(
        "ffmpeg-libavcodec",
        r"libav(?:codec|util|format|device)-dev|libswscale-dev",
        rf"(?P<path>lib(?:av|sw)\w+/.+{_ENDING})",
        r"av(?:codec|format|device|io|filter)?_\w+|AV_[A-Z]\w+|AVCodec\w+|AVFormat\w+|AVPicture\w*|AVFrame\w+|sws_\w+",
    ),
    _make_library(
        "console-bridge", "libconsole-bridge-dev", rf"(?P<path>console_bridge/.+{_ENDING})", r"console_bridge::.+"
    ),
    _make_library(
        "urdfdom-headers",
        "liburdfdom-headers-dev",
        rf"(?:urdfdom_headers/)?(?P<path>urdf_\w+/.+{_ENDING})",
        r"urdf::.+",
    ),
    _make_library("urdfdom", "liburdfdom-dev", rf"(?:urdfdom/)?(?P<path>urdf_parser/.+{_ENDING})", r"urdf::.+"),
    _make_library(
        "geographiclib", r"libgeographic(?:lib)?-dev", rf"(?P<path>GeographicLib/.+{_ENDING})", r"GeographicLib::.+"
    ),
    _make_library("glog", "libgoogle-glog-dev", rf"(?P<path>glog/.+{_ENDING})", r"google::.+"),
    _make_library("tbb", "libtbb-dev", rf"(?P<path>(?:tbb|oneapi)/.+{_ENDING})", r"tbb::.+"),
    _make_library("jsoncpp", "libjsoncpp-dev", rf"(?:jsoncpp/)?(?P<path>json/.+{_ENDING})", r"Json::.+"),
    _make_library("nlohmann-json", "nlohmann-json3-dev", rf"(?P<path>nlohmann/.+{_ENDING})", r"nlohmann::.+"),
    _make_library("flann", "libflann-dev", rf"(?P<path>flann/.+{_ENDING})", r"flann::.+"),
    _make_library("ccd", "libccd-dev", rf"(?P<path>ccd/.+{_ENDING})", r"ccd_\w+"),
    _make_library("nlopt", "libnlopt-dev", r"(?P<path>nlopt\.hp?p?)", r"nlopt::.+|nlopt_\w+"),
    _make_library("gtest", "libg(?:test|mock)-dev", rf"(?P<path>g(?:test|mock)/.+{_ENDING})", r"testing::.+"),
    _make_library("zeromq", "libzmq3-dev", r"(?P<path>zmq(?:_utils)?\.h)", r"zmq_\w+|ZMQ_\w+"),
    _make_library("poco", "libpoco-dev", rf"(?P<path>Poco/.+{_ENDING})", r"Poco::.+"),
    _make_library("ogre", r"libogre-1\.\d+-dev", rf"OGRE/(?P<path>.+{_ENDING})", r"Ogre::.+"),
)
_LIBAV = _make_library(
    "libav",
    "",
    "",
    r"av(?:codec|format|device|io|filter)?_\w+|AV_[A-Z]\w+|AVCodec\w+|AVFormat\w+|AVPicture\w*|AVFrame\w+|sws_\w+",
)
"""What no Debian release of today packages."""
_GUARD = re.compile(r"_(?:H|HH|HPP|HXX|H_|HPP_|INCLUDED|INC|EXPORTS?|API|DECL)_*\Z|\w*(?:EXPORT|IMPORT|_INLINE)\w*\Z")
_KINDS = CLASSES | {"enum", "alias", "function", "enumerator", "macro", "variable"}
_ORDER = {name: place for place, name in enumerate(name.split()[1] for name in CODENAMES.values())}
Suites = Mapping[str, Mapping[str, LibraryFacts]]
"""Debian releases, oldest first, with their libraries by source package."""
_SHORTEST = 6
"""Letters of the last part of a name. A shorter one is a word of everyday use, and may be anybody's."""


class LibraryVersion(NamedTuple):
    """A library in one Debian release, or at its tags (release empty). number: as upstream has it. headers: by the path
    that is included. words: in any of them, comments left out."""

    release: str
    number: str
    headers: Mapping[str, HeaderSurface]
    words: frozenset[str]


def read_library(library: DebianLibrary, facts: LibraryFacts, release: str, texts: Texts) -> LibraryVersion | None:
    """A library in one release, of what was read of the source package; None when that has none of its headers."""
    headers: dict[str, HeaderSurface] = {}
    words: set[str] = set()
    for header in facts.headers:
        ways = (library.headers.match(f"{root}{header.path}") for root in ("", *(f"{one}/" for one in facts.roots)))
        reported = next(filter(None, ways), None)
        text = texts.get(header.sha) if reported is not None else None
        if reported is not None and text is not None and not text.refuses:
            path = reported["path"]
            headers[path] = HeaderSurface(()) if INNER.search(path) else text.surface
            words.update(text.words)
    if not headers:
        return None
    return LibraryVersion(release, extract_upstream_version(facts.version), headers, frozenset(words))


class LibraryRemovals(NamedTuple):
    """What one version lacks and the one before it had. headers and names: to what stands for them, empty for nothing
    known; calls: a function to the numbers of arguments that it no longer takes."""

    before: LibraryVersion
    now: LibraryVersion
    headers: Mapping[str, str]
    names: Mapping[str, str]
    calls: Mapping[str, tuple[int, ...]]


class _Rest(NamedTuple):
    """What some version from one on has. headers: paths. words: in any header. declared: last parts of names. others:
    names of what is no function. simple: last parts of those of macros and `using`."""

    headers: frozenset[str] = frozenset()
    words: frozenset[str] = frozenset()
    declared: frozenset[str] = frozenset()
    others: frozenset[str] = frozenset()
    simple: frozenset[str] = frozenset()


def _collect_rests(versions: Sequence[LibraryVersion]) -> list[_Rest]:
    found: list[_Rest] = []
    last = _Rest()
    for version in reversed(versions):
        there = [(e.name, e.name.rpartition("::")[2], e.kind) for e in list_offered(version.headers.values())]
        last = _Rest(
            last.headers.union(version.headers),
            last.words | version.words,
            last.declared.union(short for _, short, _ in there),
            last.others.union(name for name, _, kind in there if kind != "function"),
            last.simple.union(short for _, short, kind in there if kind in ("macro", "using")),
        )
        found.append(last)
    return found[::-1]


def find_lost(
    library: DebianLibrary, versions: Sequence[LibraryVersion], steps: int | None = None
) -> Iterator[LibraryRemovals]:
    """What went from each version to the next one for good. versions: oldest first. steps: to how many of them that is
    told, by default to all; the others say what came back."""
    rests = _collect_rests(versions)
    functions = [_group_functions(library, version) for version in versions]
    for place, (before, now) in enumerate(pairwise(versions[: None if steps is None else steps + 1])):
        if parse(before.number) == parse(now.number):
            continue
        rest = rests[place + 1]
        there = {e.name for e in list_offered(now.headers.values())}
        headers = {
            path: _find_new_header(before, now, path)
            for path in before.headers
            if not INNER.search(path) and path not in rest.headers
        }
        names = {
            one.name: _find_successor(one, there)
            for one in list_offered(before.headers.values())
            if _is_named_by_users(library, one)
            and (last := one.name.rpartition("::")[2]) in before.words
            and last not in rest.words
            and last not in rest.declared  # a macro may put names together
        }
        # Members of what went as a whole are no more than it.
        names = {name: new for name, new in names.items() if name.rpartition("::")[0] not in names}
        yield LibraryRemovals(
            before, now, headers, names, _find_rejected_calls(functions[place], functions[place + 1 :], rest)
        )


def _is_named_by_users(library: DebianLibrary, one: Entity) -> bool:
    """Whether an entity is one that users name, of a name that is its own."""
    last = one.name.rpartition("::")[2]
    return (
        one.kind in _KINDS
        and not one.internal
        and not one.arguments
        and one.access in ("", "public")
        and len(last) >= _SHORTEST
        and last.isidentifier()
        and not last.startswith("_")
        and not last.endswith("_")
        and library.names.match(one.name) is not None
        and INNER_NAME.search(one.name) is None
        and not (one.kind == "macro" and _GUARD.search(one.name))
    )


def _find_new_header(before: LibraryVersion, now: LibraryVersion, path: str) -> str:
    """The header that has most of what a lost one had, or that it took in; empty where there is none."""
    surface = before.headers[path]
    if surface.instead in now.headers:
        return surface.instead
    had = {e.name for e in surface.entities if e.kind != "macro" and not e.internal}
    counts: dict[str, int] = defaultdict(int)
    for other, there in now.headers.items():
        counts[other] = len(had.intersection(e.name for e in there.entities))
    best = max(counts, key=lambda other: (counts[other], other), default="")
    return best if had and best and counts[best] * 2 > len(had) and best not in before.headers else ""


_USE = re.compile(r"\b[Uu]se\s+(?:the\s+)?['`\"]?([A-Za-z_][\w:]+)")


def _find_successor(one: Entity, there: Collection[str]) -> str:
    """What its deprecation said to use, where that is there."""
    found = _USE.search(one.deprecated or "")
    if found is None:
        return ""
    scope = one.name.rpartition("::")[0]
    return next((name for name in (f"{scope}::{found[1]}", found[1]) if name in there), "")


def _count_args(one: Entity) -> tuple[int, float]:
    given = one.parameters or ()
    endless = "variadic" in one.traits or any(p.pack for p in given)
    needed = sum(1 for p in given if p.default is None and not p.pack)
    return needed, float("inf") if endless else len(given)


def _takes(one: Sequence[Entity], count: int) -> bool:
    return any(low <= count <= high for low, high in map(_count_args, one))


def _find_rejected_calls(
    old: Mapping[str, Sequence[Entity]], later: Sequence[Mapping[str, Sequence[Entity]]], rest: _Rest
) -> dict[str, tuple[int, ...]]:
    """Functions of namespaces that are there still, to the numbers of arguments that no version from then on takes."""
    found: dict[str, tuple[int, ...]] = {}
    for name, forms in old.items():
        # What a macro, an alias or anything but a function may be called by a later version is not known.
        if name in rest.others or name.rpartition("::")[2] in rest.simple or not all(name in known for known in later):
            continue
        counts = {n for one in forms if (ends := _count_args(one))[1] < 12 for n in range(ends[0], int(ends[1]) + 1)}
        gone = tuple(sorted(n for n in counts if n and not any(_takes(known[name], n) for known in later)))
        if gone:
            found[name] = gone
    return found


def _group_functions(library: DebianLibrary, version: LibraryVersion) -> dict[str, list[Entity]]:
    """Functions outside classes by name."""
    found: dict[str, list[Entity]] = defaultdict(list)
    classes = {e.name for e in list_offered(version.headers.values()) if e.kind in CLASSES}
    for one in list_offered(version.headers.values()):
        scope, _, last = one.name.rpartition("::")
        if one.kind != "function" or not scope or scope in classes or not last.isidentifier() or "<" in one.name:
            continue
        if library.names.match(one.name) and not INNER_NAME.search(one.name) and len(last) >= _SHORTEST:
            found[one.name].append(one)
    return found


def _list_suffixes(name: str) -> Iterator[str]:
    yield name
    while "::" in name:
        name = name.partition("::")[2]
        yield name


def group_rows(
    library: DebianLibrary,
    versions: Sequence[LibraryVersion],
    known: Callable[[str, str], bool],
    steps: int | None = None,
    elsewhere: Callable[[str, str, str], bool] = lambda kind, name, release: False,
) -> Iterator[tuple[str, dict]]:
    """Groups of rows as in data/changes.json and data/uses_libraries.json, with which of both it is. known: whether a
    kind and name are told elsewhere already. steps: as lost() has it. elsewhere: whether any library has such a thing
    in a release or a later one."""
    for step in find_lost(library, versions, steps):
        old, new = step.before, step.now
        where = (
            f"Debian's packages: {old.number} in {old.release} and {new.number} in {new.release} compared"
            if old.release
            else f"release tags of {old.number} and {new.number} compared"
        )
        shared = {
            "package": library.name,
            "source": where,
            "library": True,
            "last_in": old.number,
            "removed_in": new.number,
        }
        for kind, names in (("header-removed", step.headers), ("api-removed", step.names)):
            kept = {
                name: instead
                for name, instead in sorted(names.items())
                if not known(kind, name) and not elsewhere(kind, name, new.release)
            }
            if kept:
                yield "changes", {"kind": kind, **shared, "names": kept}
        uses = {
            f"{name} with {count} arguments" if count > 1 else f"{name} with one argument": _make_pattern(name, count)
            for name, counts in sorted(step.calls.items())
            for count in counts
            if not known("api-removed", name)
        }
        if uses:
            yield "uses", {"kind": "call-changed", **shared, "uses": uses}


def _make_pattern(name: str, count: int) -> dict[str, str]:
    scope, _, last = name.rpartition("::")
    before = r"\s*::\s*".join(scope.split("::"))
    return {"word": last, "before": rf"\b{before}\s*::\s*", "arguments": str(count)}


def find_treated_elsewhere() -> Callable[[str, str], bool]:
    """What the reviewed tables treat, under any part of its name, and what some ROS package has or had."""
    reviewed = {name for row in load_rows() if not row.last_in for name in (row.old, row.new) if name}
    used = {row.pattern.word for row in load_uses().values() if row.pattern is not None and not row.last_in}
    ros = _collect_ros_names()

    def is_treated(kind: str, name: str) -> bool:
        if kind.startswith("header"):
            return name in reviewed or name in ros
        last = name.rpartition("::")[2]
        return not reviewed.isdisjoint(_list_suffixes(name)) or last in used or name in ros

    return is_treated


def _collect_ros_names() -> frozenset[str]:
    """Headers and C++ names that any stored version of any ROS package has."""
    stored, found = load_shipped(), set()
    for package in stored.packages:
        for ros in stored.list_ros(package):
            if (history := stored.find_history(package, ros)) is not None:
                found |= history.index_names().keys()
    return frozenset(found)


def _list_tagged_versions(
    clones: Path, library: DebianLibrary, packaged: Sequence[LibraryVersion]
) -> tuple[list[LibraryVersion], int]:
    """The versions at release tags, then the packaged ones; and how many steps lead to the first packaged one, or where
    there is none, to the last one that a platform has."""
    platforms = list_platform_versions(library.name)
    tagged = [LibraryVersion("", *one) for one in library_tags.read(clones, library.name, platforms, INNER)]
    if not tagged:
        return [], 0
    last = packaged[0].number if packaged else max(platforms, key=parse)
    steps = sum(1 for version in tagged[1:] if is_at_least(last, version.number))
    return [*tagged, *packaged], steps


def list_packaged_versions(library: DebianLibrary, suites: Suites, texts: Texts) -> list[LibraryVersion]:
    """The versions of a library that releases have, oldest first."""
    found = []
    for suite, libraries in suites.items():
        for facts in libraries.values():
            if any(library.packages.match(name) for name in facts.packages):
                version = read_library(library, facts, suite, texts)
                found += [version] if version is not None else []
    return sorted(found, key=lambda version: (parse(version.number), _ORDER.get(version.release, len(_ORDER))))


_OWN = 0.95
_FEWEST = 8
_KEPT = 0.6
_USED = 30
"""Shares of the names with one beginning that one library has for these names to be its own, and of headers that the
next version has where what it lacks is told; how many such names there have to be; and how many manifests name the
library, since each row costs all checks a little."""


def find_start(name: str) -> str:
    """The outermost namespace or class of a name: `cv::` of `cv::Mat`; empty for bare names, which macros often make of
    several words."""
    head, colons, _ = name.partition("::")
    return f"{head}::" if colons else ""


def find_other_libraries(suites: Suites, texts: Texts) -> list[DebianLibrary]:
    """The libraries besides LIBRARIES, with the names that are theirs alone among all that were read."""
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    packages: dict[str, set[str]] = defaultdict(set)
    read: set[tuple[str, str]] = set()
    for libraries in suites.values():
        for name, facts in libraries.items():
            packages[name].update(facts.packages)
            fresh = {(name, header.sha) for header in facts.headers} - read
            read |= fresh
            for _, sha in fresh:
                for one in texts.get(sha).surface.entities:
                    counts[find_start(one.name) if one.kind in _KINDS else ""][name] += 1
    del counts[""]
    own: dict[str, list[str]] = defaultdict(list)
    for start, each in counts.items():
        (library, most), *_ = each.most_common(1)
        if most >= _FEWEST and most >= _OWN * each.total():
            own[library].append(re.escape(start))
    by_hand = [one.packages for one in LIBRARIES]
    return [
        DebianLibrary(
            name,
            re.compile(rf"(?:{'|'.join(map(re.escape, sorted(packages[name])))})\Z"),
            re.compile(r"(?P<path>.+/.+)\Z"),
            re.compile(rf"(?:{'|'.join(sorted(own[name])) or '(?!)'})\w.*\Z"),
        )
        for name in sorted(packages)
        if not any(pattern.match(package) for pattern in by_hand for package in packages[name])
    ]


class Elsewhere:
    """What any library has in a release or a later one."""

    def __init__(self, suites: Suites, texts: Texts):
        self._words: dict[str, set[str]] = {}
        self._paths: dict[str, set[str]] = {}
        words: set[str] = set()
        paths: set[str] = set()
        refused: dict[str, bool] = {}
        for suite, libraries in reversed(list(suites.items())):
            for header in (header for facts in libraries.values() for header in facts.headers):
                if header.sha not in refused:
                    text = texts.get(header.sha)
                    words.update(text.words)
                    refused[header.sha] = bool(text.refuses)
                paths.update(() if refused[header.sha] else {header.path})
            self._words[suite], self._paths[suite] = set(words), set(paths)

    def has(self, kind: str, name: str, release: str) -> bool:
        """Whether a header of any library is, or has, that."""
        if kind.startswith("header"):
            return name in self._paths.get(release, ())
        return name.rpartition("::")[2] in self._words.get(release, ())


def _has_shrunk(versions: Sequence[LibraryVersion]) -> bool:
    """Whether some version has far fewer headers than the one before: they may be in a package that was not read."""
    return any(
        sum(path in now.headers for path in before.headers) < _KEPT * len(before.headers)
        for before, now in pairwise(versions)
    )


def write(file: Path, key: str, rows: Iterable[dict]) -> None:
    """Writes a table, a line for each group; compressed where the file's name ends so."""
    text = ",\n".join(json.dumps(row) for row in rows)
    more = ',\n"transitive": []' if key == "changes" else ""
    data = f'{{"{key}": [\n{text}\n]{more}}}\n'.encode()
    write_file(file, zstandard.ZstdCompressor(level=19).compress(data) if file.suffix == ".zst" else data)


def derive(suites: Suites, texts: Texts, clones: Path | None, output: Path) -> None:
    """Writes the tables of what went."""
    reviewed = find_treated_elsewhere()
    everywhere = Elsewhere(suites, texts)
    changes: list[dict] = []
    uses: list[dict] = []
    early: list[dict] = []
    for library in (*LIBRARIES, *((_LIBAV,) if clones is not None else ())):
        versions = list_packaged_versions(library, suites, texts)
        for key, group in group_rows(library, versions, reviewed, elsewhere=everywhere.has):
            (changes if key == "changes" else uses).append(group)
        tagged, steps = _list_tagged_versions(clones, library, versions) if clones is not None else ([], 0)
        # Macros that only old versions have may declare more than is read, so that no numbers of arguments are told.
        early += [group for key, group in group_rows(library, tagged, reviewed, steps) if key == "changes" and steps]
    uses_of = count_uses()
    for library in find_other_libraries(suites, texts):
        if sum(count for name, count in uses_of.items() if library.packages.match(name)) < _USED:
            continue
        versions = list_packaged_versions(library, suites, texts)
        if not _has_shrunk(versions):
            reported = group_rows(library, versions, reviewed, elsewhere=everywhere.has)
            changes += [group for key, group in reported if key == "changes"]
    write(output / "changes_debian.json.zst", "changes", changes)
    write(output / "uses_debian.json", "uses", uses)
    if clones is not None:
        write(output / "changes_library_tags.json.zst", "changes", early)


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=Path, help="folder that keeps what was read")
    parser.add_argument("--suite", action="append", default=[], metavar="NAME=APT_CONF", help="read it first")
    parser.add_argument("--clones", type=Path, help="read older versions at the tags of the git clones in this folder")
    parser.add_argument("--output", type=Path, default=DATA)
    asked = parser.parse_args(arguments)
    run = Run(asked.work, lambda text: print(text, flush=True))
    for item in asked.suite:
        name, _, configuration = item.partition("=")
        run.read_suite(name, Path(configuration).absolute(), [one.packages for one in LIBRARIES])
    names = sorted(run.list_suites(), key=lambda name: _ORDER.get(name, len(_ORDER)))
    suites = {name: {facts.library: facts for facts in run.read_facts(name)} for name in names}
    if not suites:
        parser.error(f"{asked.work}: nothing was read yet; give a --suite for each Debian release")
    print(library_file.write(asked.output / "libraries.sqlite", suites, run.texts), flush=True)
    derive(suites, run.texts, asked.clones, asked.output)


if __name__ == "__main__":
    main()
