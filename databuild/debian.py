"""Builds data/changes_debian.json and uses_debian.json: what versions of platform libraries no longer have, or take.

    python -P -m rosimpact.databuild.debian FOLDER --clones CLONES --output DATA

FOLDER holds a folder for each Debian release, with the development packages of the libraries as `apt-get download
PACKAGE=VERSION` gives them. Their headers are read as `surface diff` reads those of an installed package, and those of
consecutive versions compared. CLONES holds git clones (`OWNER+NAME`); versions before the first packaged one are read
at their release tags there, into changes_library_tags.json. Only names and versions are kept.

A header is gone when no package of that release, or of a later one, has it. A name is gone when its last part is not
even a word in any header of its library in that version or a later one: then no macro, alias, specialisation or
`using` can have it. Names that the reviewed tables treat, and those that a ROS package has, are left out.
"""

from __future__ import annotations

import argparse
import json
import re
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

from ..edges.files import write_file
from ..impact.facts.cpp import surface as surface_cpp
from ..impact.facts.surface import CLASSES, Entity, HeaderSurface, offered
from ..impact.targets.changes import all_rows, all_uses
from ..impact.targets.platform import CODENAMES
from ..impact.targets.snapshot import DATA
from ..impact.targets.surface.store import shipped
from ..impact.targets.version import at_least, parts
from . import library_tags
from .includes import platform_versions
from .surface.unpacked_deb import members


class Library(NamedTuple):
    """A library as Debian packages it. name: as in platform_versions.yaml. packages: whole names of its development
    packages. headers: paths below the include folder, whose group `path` is how they are included. names: how names of
    its own look, as a whole; bare ones only where nobody else would call anything so."""

    name: str
    packages: re.Pattern[str]
    headers: re.Pattern[str]
    names: re.Pattern[str]


def _library(name: str, packages: str, headers: str, names: str) -> Library:
    return Library(
        name,
        re.compile(rf"(?:{packages})\Z"),
        re.compile(rf"(?:x86_64-linux-gnu/)?(?:{headers})\Z"),
        re.compile(rf"(?:{names})\Z"),
    )


_ENDING = r"\.(?:h|hpp|hh|hxx|inl|ipp)"
LIBRARIES = (
    _library("opencv", r"libopencv-[\w-]+", rf"opencv4/(?P<path>opencv2/.+{_ENDING})", r"cv::.+|CV_\w+"),
    _library("pcl", "libpcl-dev", rf"pcl-[\d.]+/(?P<path>pcl/.+{_ENDING})", r"pcl::.+|PCL_\w+"),
    _library("boost", r"libboost1\.\d+-dev", rf"(?P<path>boost/.+{_ENDING})", r"boost::.+"),
    _library("eigen3", "libeigen3-dev", r"eigen3/(?P<path>(?:Eigen|unsupported)/.+)", r"Eigen::.+|EIGEN_\w+"),
    _library("yaml-cpp", "libyaml-cpp-dev", rf"(?P<path>yaml-cpp/.+{_ENDING})", r"YAML::.+"),
    _library("fmt", "libfmt-dev", rf"(?P<path>fmt/.+{_ENDING})", r"fmt::.+"),
    _library("tinyxml", "libtinyxml-dev", rf"(?P<path>tinyxml{_ENDING}|tinystr{_ENDING})", r"TiXml\w+"),
    _library("tinyxml2", "libtinyxml2-dev", rf"(?P<path>tinyxml2{_ENDING})", r"tinyxml2::.+"),
    _library("bullet", "libbullet-dev", rf"bullet/(?P<path>.+{_ENDING})", r"bt[A-Z]\w+(?:::.+)?|BT_[A-Z]\w+"),
    _library("orocos-kdl", "liborocos-kdl-dev", rf"(?P<path>kdl/.+{_ENDING})", r"KDL::.+"),
    _library("assimp", "libassimp-dev", rf"(?P<path>assimp/.+{_ENDING})", r"Assimp::.+|ai[A-Z]\w+(?:::.+)?"),
    _library("ceres", "libceres-dev", rf"(?P<path>ceres/.+{_ENDING})", r"ceres::.+"),
    _library("fcl", "libfcl-dev", rf"(?P<path>fcl/.+{_ENDING})", r"fcl::.+"),
    _library("ompl", "libompl-dev", rf"(?:ompl-[\d.]+/)?(?P<path>ompl/.+{_ENDING})", r"ompl::.+"),
    _library("octomap", "liboctomap-dev", rf"(?P<path>octomap/.+{_ENDING})", r"octomap::.+|octomath::.+"),
    _library("spdlog", "libspdlog-dev", rf"(?P<path>spdlog/.+{_ENDING})", r"spdlog::.+|SPDLOG_\w+"),
    _library("protobuf", "libprotobuf-dev", rf"(?P<path>google/protobuf/.+{_ENDING})", r"google::protobuf::.+"),
    _library(
        "ffmpeg-libavcodec",
        r"libav(?:codec|util|format|device)-dev|libswscale-dev",
        rf"(?P<path>lib(?:av|sw)\w+/.+{_ENDING})",
        r"av(?:codec|format|device|io|filter)?_\w+|AV_[A-Z]\w+|AVCodec\w+|AVFormat\w+|AVPicture\w*|AVFrame\w+|sws_\w+",
    ),
    _library(
        "console-bridge", "libconsole-bridge-dev", rf"(?P<path>console_bridge/.+{_ENDING})", r"console_bridge::.+"
    ),
    _library(
        "urdfdom-headers",
        "liburdfdom-headers-dev",
        rf"(?:urdfdom_headers/)?(?P<path>urdf_\w+/.+{_ENDING})",
        r"urdf::.+",
    ),
    _library("urdfdom", "liburdfdom-dev", rf"(?:urdfdom/)?(?P<path>urdf_parser/.+{_ENDING})", r"urdf::.+"),
    _library(
        "geographiclib", r"libgeographic(?:lib)?-dev", rf"(?P<path>GeographicLib/.+{_ENDING})", r"GeographicLib::.+"
    ),
    _library("glog", "libgoogle-glog-dev", rf"(?P<path>glog/.+{_ENDING})", r"google::.+"),
    _library("tbb", "libtbb-dev", rf"(?P<path>(?:tbb|oneapi)/.+{_ENDING})", r"tbb::.+"),
    _library("jsoncpp", "libjsoncpp-dev", rf"(?:jsoncpp/)?(?P<path>json/.+{_ENDING})", r"Json::.+"),
    _library("nlohmann-json", "nlohmann-json3-dev", rf"(?P<path>nlohmann/.+{_ENDING})", r"nlohmann::.+"),
    _library("flann", "libflann-dev", rf"(?P<path>flann/.+{_ENDING})", r"flann::.+"),
    _library("ccd", "libccd-dev", rf"(?P<path>ccd/.+{_ENDING})", r"ccd_\w+"),
    _library("nlopt", "libnlopt-dev", r"(?P<path>nlopt\.hp?p?)", r"nlopt::.+|nlopt_\w+"),
    _library("gtest", "libg(?:test|mock)-dev", rf"(?P<path>g(?:test|mock)/.+{_ENDING})", r"testing::.+"),
    _library("zeromq", "libzmq3-dev", r"(?P<path>zmq(?:_utils)?\.h)", r"zmq_\w+|ZMQ_\w+"),
    _library("poco", "libpoco-dev", rf"(?P<path>Poco/.+{_ENDING})", r"Poco::.+"),
    _library("ogre", r"libogre-1\.\d+-dev", rf"OGRE/(?P<path>.+{_ENDING})", r"Ogre::.+"),
)
_LIBAV = _library(
    "libav",
    "",
    "",
    r"av(?:codec|format|device|io|filter)?_\w+|AV_[A-Z]\w+|AVCodec\w+|AVFormat\w+|AVPicture\w*|AVFrame\w+|sws_\w+",
)
"""What no Debian release of today packages."""
# What nobody outside of a library is meant to include or to call; and libraries of Boost that are made for others.
_PARTS = (
    r"_?details?|internals?|_?impl|_?private|priv|aux_?|preprocessed|hal|cuda|gpu|3rdparty|third_party|src|arch|compiler"
    r"|mpl|fusion|spirit2?|phoenix|proto|typeof|hana|yap|metaparse|vmd|preprocessor|msm|wave|compute|qvm|type_traits"
    r"|contract|intrusive|move|mysql|redis|cobalt|beast|outcome|leaf|mp11|hof|describe|safe_numerics|gil|histogram|icl"
    r"|log/support|(?:test|asio)/traits|regex/v[45]|dll|stl_interfaces|unit_test|charconv|mqtt5|decimal|callable_traits"
    r"|machine|winapi|interfaces?\d+|v\d+|boost(?:/|::)(?:geometry|numeric|math|parameter|config|json|url|stacktrace|hash2)"
)
_INNER = re.compile(
    rf"(?:^|[/_])(?:{_PARTS}|win32|wince|win32u|windows|macos|sunos|vx|cygwin|posix|aix)(?:[/_.]|$)", re.IGNORECASE
)
_INNER_NAME = re.compile(rf"(?:^|::)(?:_\w+|\w+_detail|{_PARTS})(?:::|$)", re.IGNORECASE)
_GUARD = re.compile(r"_(?:H|HH|HPP|HXX|H_|HPP_|INCLUDED|INC|EXPORTS?|API|DECL)_*\Z|\w*(?:EXPORT|IMPORT|_INLINE)\w*\Z")
_KINDS = CLASSES | {"enum", "alias", "function", "enumerator", "macro", "variable"}
_WORD = re.compile(r"[A-Za-z_]\w*")
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_DEB = re.compile(r"(?P<package>[^_]+)_(?P<version>[^_]+)_[^_]+\.deb\Z")
_ORDER = {name: place for place, name in enumerate(name.split()[1] for name in CODENAMES.values())}
_SHORTEST = 6
"""Letters of the last part of a name. A shorter one is a word of everyday use, and may be anybody's."""


class Version(NamedTuple):
    """A library in one Debian release, or at its tags (release empty). number: as upstream has it. headers: by the path
    that is included. words: in any of them, comments left out."""

    release: str
    number: str
    headers: Mapping[str, HeaderSurface]
    words: frozenset[str]


def upstream(version: str) -> str:
    """The version of the library itself: `7:5.1.9-0+deb12u1` is 5.1.9, `2.1.0+really2.1.0+dfsg-1` is 2.1.0."""
    version = re.split(r"\+really|\.really\.", version.rpartition(":")[2])[-1]
    found = re.match(r"\d+(?:\.\d+)*", version)
    return found.group() if found else version


def read_library(library: Library, folder: Path) -> Version | None:
    """A library in the folder of one release; None when it has no package there. Raises DebError and OSError."""
    texts: dict[str, bytes] = {}
    number = ""
    for file in sorted(folder.glob("*.deb")):
        told = _DEB.match(file.name)
        if told is None or not library.packages.match(told["package"]):
            continue
        # Of a library that a release has twice, the newer one counts.
        if number and parts(upstream(told["version"])) > parts(number) and told["package"].startswith("libboost"):
            texts.clear()
        number = max(number, upstream(told["version"].replace("%3a", ":")), key=parts)
        for path, member in members(file).items():
            found = (
                library.headers.match(path.removeprefix("usr/include/")) if path.startswith("usr/include/") else None
            )
            if found is not None:
                texts[found["path"]] = member.data
    if not number:
        return None
    words = frozenset(
        word for data in texts.values() for word in _WORD.findall(_COMMENT.sub(" ", data.decode("utf-8", "replace")))
    )
    surfaces = {
        path: HeaderSurface(()) if _INNER.search(path) else surface_cpp.extract(data)
        for path, data in sorted(texts.items())
    }
    return Version(folder.name, number, surfaces, words)


class Lost(NamedTuple):
    """What one version lacks and the one before it had. headers and names: to what stands for them, empty for nothing
    known; calls: a function to the numbers of arguments that it no longer takes."""

    before: Version
    now: Version
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


def _rests(versions: Sequence[Version]) -> list[_Rest]:
    found: list[_Rest] = []
    last = _Rest()
    for version in reversed(versions):
        there = [(e.name, e.name.rpartition("::")[2], e.kind) for e in offered(version.headers.values())]
        last = _Rest(
            last.headers.union(version.headers),
            last.words | version.words,
            last.declared.union(short for _, short, _ in there),
            last.others.union(name for name, _, kind in there if kind != "function"),
            last.simple.union(short for _, short, kind in there if kind in ("macro", "using")),
        )
        found.append(last)
    return found[::-1]


def lost(library: Library, versions: Sequence[Version], steps: int | None = None) -> Iterator[Lost]:
    """What went from each version to the next one for good. versions: oldest first. steps: to how many of them that is
    told, by default to all; the others say what came back."""
    rests = _rests(versions)
    functions = [_functions(library, version) for version in versions]
    for place, (before, now) in enumerate(pairwise(versions[: None if steps is None else steps + 1])):
        if parts(before.number) == parts(now.number):
            continue
        rest = rests[place + 1]
        there = {e.name for e in offered(now.headers.values())}
        headers = {
            path: _new_place(before, now, path)
            for path in before.headers
            if not _INNER.search(path) and path not in rest.headers
        }
        names = {
            one.name: _successor(one, there)
            for one in offered(before.headers.values())
            if _told(library, one)
            and (last := one.name.rpartition("::")[2]) in before.words
            and last not in rest.words
            and last not in rest.declared  # a macro may put names together
        }
        # Members of what went as a whole are no more than it.
        names = {name: new for name, new in names.items() if name.rpartition("::")[0] not in names}
        yield Lost(before, now, headers, names, _calls(functions[place], functions[place + 1 :], rest))


def _told(library: Library, one: Entity) -> bool:
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
        and _INNER_NAME.search(one.name) is None
        and not (one.kind == "macro" and _GUARD.search(one.name))
    )


def _new_place(before: Version, now: Version, path: str) -> str:
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


def _successor(one: Entity, there: Collection[str]) -> str:
    """What its deprecation said to use, where that is there."""
    found = _USE.search(one.deprecated or "")
    if found is None:
        return ""
    scope = one.name.rpartition("::")[0]
    return next((name for name in (f"{scope}::{found[1]}", found[1]) if name in there), "")


def _accepted(one: Entity) -> tuple[int, float]:
    given = one.parameters or ()
    endless = "variadic" in one.traits or any(p.pack for p in given)
    needed = sum(1 for p in given if p.default is None and not p.pack)
    return needed, float("inf") if endless else len(given)


def _takes(one: Sequence[Entity], count: int) -> bool:
    return any(low <= count <= high for low, high in map(_accepted, one))


def _calls(
    old: Mapping[str, Sequence[Entity]], later: Sequence[Mapping[str, Sequence[Entity]]], rest: _Rest
) -> dict[str, tuple[int, ...]]:
    """Functions of namespaces that are there still, to the numbers of arguments that no version from then on takes."""
    found: dict[str, tuple[int, ...]] = {}
    for name, forms in old.items():
        # What a macro, an alias or anything but a function may be called by a later version is not told.
        if name in rest.others or name.rpartition("::")[2] in rest.simple or not all(name in known for known in later):
            continue
        counts = {n for one in forms if (ends := _accepted(one))[1] < 12 for n in range(ends[0], int(ends[1]) + 1)}
        gone = tuple(sorted(n for n in counts if n and not any(_takes(known[name], n) for known in later)))
        if gone:
            found[name] = gone
    return found


def _functions(library: Library, version: Version) -> dict[str, list[Entity]]:
    """Functions outside classes by name."""
    found: dict[str, list[Entity]] = defaultdict(list)
    classes = {e.name for e in offered(version.headers.values()) if e.kind in CLASSES}
    for one in offered(version.headers.values()):
        scope, _, last = one.name.rpartition("::")
        if one.kind != "function" or not scope or scope in classes or not last.isidentifier() or "<" in one.name:
            continue
        if library.names.match(one.name) and not _INNER_NAME.search(one.name) and len(last) >= _SHORTEST:
            found[one.name].append(one)
    return found


def _tails(name: str) -> Iterator[str]:
    yield name
    while "::" in name:
        name = name.partition("::")[2]
        yield name


def groups(
    library: Library, versions: Sequence[Version], known: Callable[[str, str], bool], steps: int | None = None
) -> Iterator[tuple[str, dict]]:
    """Groups of rows as in data/changes.json and data/uses_libraries.json, with which of both it is. known: whether a
    kind and name are told elsewhere already. steps: as lost() has it."""
    for step in lost(library, versions, steps):
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
            kept = {name: now for name, now in sorted(names.items()) if not known(kind, name)}
            if kept:
                yield "changes", {"kind": kind, **shared, "names": kept}
        uses = {
            f"{name} with {count} arguments" if count > 1 else f"{name} with one argument": _pattern(name, count)
            for name, counts in sorted(step.calls.items())
            for count in counts
            if not known("api-removed", name)
        }
        if uses:
            yield "uses", {"kind": "call-changed", **shared, "uses": uses}


def _pattern(name: str, count: int) -> dict[str, str]:
    scope, _, last = name.rpartition("::")
    before = r"\s*::\s*".join(scope.split("::"))
    return {"word": last, "before": rf"\b{before}\s*::\s*", "arguments": str(count)}


def told_elsewhere() -> Callable[[str, str], bool]:
    """What the reviewed tables treat, under any part of its name, and what some ROS package has or had."""
    reviewed = {name for row in all_rows() if not row.last_in for name in (row.old, row.new) if name}
    used = {row.pattern.word for row in all_uses().values() if row.pattern is not None and not row.last_in}
    ros = _of_ros_packages()

    def told(kind: str, name: str) -> bool:
        if kind.startswith("header"):
            return name in reviewed or name in ros
        last = name.rpartition("::")[2]
        return not reviewed.isdisjoint(_tails(name)) or last in used or name in ros

    return told


def _of_ros_packages() -> frozenset[str]:
    """Headers and C++ names that any stored version of any ROS package has."""
    stored, found = shipped(), set()
    for package in stored.packages:
        for ros in stored.generations(package):
            if (history := stored.history(package, ros)) is not None:
                found |= history.names().keys()
    return frozenset(found)


def _packaged(folder: Path, library: Library) -> list[Version]:
    read = (read_library(library, release) for release in sorted(folder.iterdir()) if release.is_dir())
    known = [version for version in read if version is not None]
    return sorted(known, key=lambda version: (parts(version.number), _ORDER.get(version.release, len(_ORDER))))


def _tagged(clones: Path, library: Library, packaged: Sequence[Version]) -> tuple[list[Version], int]:
    """The versions at release tags, then the packaged ones; and how many steps lead to the first packaged one, or where
    there is none, to the last one that a platform has."""
    platforms = platform_versions(library.name)
    tagged = [Version("", *one) for one in library_tags.read(clones, library.name, platforms, _INNER)]
    if not tagged:
        return [], 0
    last = packaged[0].number if packaged else max(platforms, key=parts)
    steps = sum(1 for version in tagged[1:] if at_least(last, version.number))
    return [*tagged, *packaged], steps


_Groups = list[tuple[str, dict]]


def _one(folder: Path, clones: Path | None, known: Callable[[str, str], bool], library: Library) -> list[_Groups]:
    """Groups by Debian's packages, and those by tags."""
    packaged = _packaged(folder, library)
    versions, steps = _tagged(clones, library, packaged) if clones is not None else ([], 0)
    # Macros that only old versions have may declare more than is read, so that no numbers of arguments are told.
    early = [one for one in groups(library, versions, known, steps) if one[0] == "changes"] if steps else []
    return [list(groups(library, packaged, known)), early]


def write(file: Path, key: str, rows: Iterable[dict]) -> None:
    """Writes a table, a line for each group."""
    text = ",\n".join(json.dumps(row) for row in rows)
    more = ',\n"transitive": []' if key == "changes" else ""
    write_file(file, f'{{"{key}": [\n{text}\n]{more}}}\n'.encode())


def main(arguments: list[str] | None = None) -> None:
    """Writes both tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--clones", type=Path, help="read older versions at the tags of the git clones in this folder")
    parser.add_argument("--output", type=Path, default=DATA)
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args(arguments)
    if not any(asked.folder.glob("*/*.deb")):
        parser.error(f"{asked.folder} has no folder with Debian packages; `apt-get download PACKAGE=VERSION` into one")
    known = told_elsewhere()
    libraries = LIBRARIES if asked.clones is None else (*LIBRARIES, _LIBAV)
    with ProcessPoolExecutor(asked.jobs, mp_context=get_context("fork"), initializer=_keep, initargs=(known,)) as pool:
        found = list(pool.map(partial(_work, asked.folder, asked.clones), libraries))
    for place, key, name in ((0, "changes", "debian"), (0, "uses", "debian"), (1, "changes", "library_tags")):
        if place == 0 or asked.clones is not None:
            rows = [group for one in found for kind, group in one[place] if kind == key]
            write(asked.output / f"{key}_{name}.json", key, rows)


_KNOWN: list[Callable[[str, str], bool]] = []


def _keep(known: Callable[[str, str], bool]) -> None:
    _KNOWN[:] = [known]


def _work(folder: Path, clones: Path | None, library: Library) -> list[_Groups]:
    return _one(folder, clones, _KNOWN[0], library)


if __name__ == "__main__":
    main()
