"""Versions of platform libraries as the release tags of their repositories have them, for those no archive keeps.

What a build would make of a template is not among the headers; whether something is gone is told with those of Debian's
packages beside them (debian.py), which have all that is installed.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..impact.facts.surface import HeaderSurface
from ..impact.targets.version import is_at_least, parse
from .extract import cpp
from .history import _find_tree
from .includes import AV_HEADERS
from .surface.releases import find_git_directory

if TYPE_CHECKING:
    import pygit2

_ENDING = r"\.(?:h|hpp|hh|hxx|inl|ipp)"


class LibraryClones(NamedTuple):
    """The clones of a library. names: their folders, `OWNER+NAME`, with `*` for any. headers: paths in them, whose
    group `path` is how they are included. below: what stands before that."""

    names: str
    headers: re.Pattern[str]
    below: str = ""


def _make_clones(names: str, headers: str, below: str = "") -> LibraryClones:
    return LibraryClones(names, re.compile(rf"(?:{headers})\Z"), below)


def _make_include_pattern(folder: str) -> str:
    return rf"(?:[\w-]+/)*include/(?P<path>{folder}/.+{_ENDING})"


SOURCES = {
    "pcl": _make_clones("PointCloudLibrary+pcl", _make_include_pattern("pcl")),
    "boost": _make_clones("boostorg+*", rf"(?:[\w-]+/)?include/(?P<path>boost/.+{_ENDING})"),
    "eigen3": _make_clones("eigenteam+eigen-git-mirror", r"(?P<path>(?:Eigen|unsupported/Eigen)/[\w./]+)"),
    "yaml-cpp": _make_clones("jbeder+yaml-cpp", _make_include_pattern("yaml-cpp")),
    "fmt": _make_clones("fmtlib+fmt", rf"(?:include/)?(?P<path>fmt/.+{_ENDING})"),
    "tinyxml2": _make_clones("leethomason+tinyxml2", rf"(?P<path>tinyxml2{_ENDING})"),
    "bullet": _make_clones("bulletphysics+bullet3", rf"src/(?P<path>.+{_ENDING})"),
    "orocos-kdl": _make_clones(
        "orocos+orocos_kinematics_dynamics", rf"orocos_kdl/src/(?P<path>(?:utilities/)?\w+{_ENDING})", "kdl/"
    ),
    "assimp": _make_clones("assimp+assimp", _make_include_pattern("assimp")),
    "ceres": _make_clones("ceres-solver+ceres-solver", _make_include_pattern("ceres")),
    "fcl": _make_clones("flexible-collision-library+fcl", _make_include_pattern("fcl")),
    "ompl": _make_clones("ompl+ompl", rf"src/(?P<path>ompl/.+{_ENDING})"),
    "octomap": _make_clones("OctoMap+octomap", _make_include_pattern("octomap")),
    "spdlog": _make_clones("gabime+spdlog", _make_include_pattern("spdlog")),
    "libav": _make_clones("libav+libav", rf"(?P<path>{AV_HEADERS.pattern})"),
    "console-bridge": _make_clones("ros+console_bridge", _make_include_pattern("console_bridge")),
    "urdfdom-headers": _make_clones("ros+urdfdom_headers", _make_include_pattern(r"urdf_\w+")),
    "urdfdom": _make_clones("ros+urdfdom", _make_include_pattern("urdf_parser")),
    "flann": _make_clones("flann-lib+flann", rf"src/cpp/(?P<path>flann/.+{_ENDING})"),
    "gtest": _make_clones("google+googletest", _make_include_pattern("g(?:test|mock)")),
    "ogre": _make_clones("OGRECave+ogre", rf"OgreMain/include/(?P<path>Ogre\w+{_ENDING})"),
}
"""Platform libraries by their names in platform_versions.yaml."""
_TAG = re.compile(r"(?:(?:rel/)?v|pcl-|release-|yaml-cpp-|boost-)?(\d+(?:[._-]\d+){1,3})(?:-src)?\Z")
_ASIDE = re.compile(r"(?:^|/)(?:tests?|docs?|examples?|benchmarks?|samples?|apps|third_?party|3rdparty|gpu|cuda)/")
_WORD = re.compile(r"[A-Za-z_]\w*")
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


class TaggedLibrary(NamedTuple):
    """A library at one version's tags: headers by the path that is included, and the words in any of them."""

    number: str
    headers: Mapping[str, HeaderSurface]
    words: frozenset[str]


def read(folder: Path, library: str, platforms: Collection[str], inner: re.Pattern[str]) -> Iterator[TaggedLibrary]:
    """The versions of a library from the oldest one that some platform has on, oldest first, none twice; of a library
    of many clones only those that platforms have. folder: of the clones. platforms: the versions of platforms. inner:
    paths of headers that nobody includes. Nothing where no clone is there."""
    import pygit2

    reported = SOURCES.get(library)
    versions: dict[str, dict[str, bytes]] = defaultdict(dict)
    known: dict[bytes, tuple[HeaderSurface, frozenset[str]]] = {}
    if reported is None or not platforms:
        return
    for where in filter(None, map(find_git_directory, sorted(folder.glob(reported.names)))):
        repository = pygit2.Repository(str(where))
        for number, tree in _find_versions(repository, min(platforms, key=parse)).items():
            if "*" in reported.names and number not in platforms:
                continue
            for path, blob in _list_headers(tree, reported):
                versions[number][path] = blob.id.raw
                if blob.id.raw not in known:
                    text = blob.data
                    words = frozenset(_WORD.findall(_COMMENT.sub(" ", text.decode("utf-8", "replace"))))
                    known[blob.id.raw] = (HeaderSurface(()) if inner.search(path) else cpp.extract(text), words)
    for number in sorted(versions, key=parse):
        found = versions[number]
        words = frozenset().union(*(known[blob][1] for blob in found.values()))
        yield TaggedLibrary(number, {path: known[blob][0] for path, blob in sorted(found.items())}, words)


def _find_versions(repository: pygit2.Repository, oldest: str) -> dict[str, pygit2.Tree]:
    found: dict[str, pygit2.Tree] = {}
    for ref in sorted(repository.references):
        match = _TAG.match(ref.removeprefix("refs/tags/")) if ref.startswith("refs/tags/") else None
        tree = _find_tree(repository, ref) if match else None
        if match and tree is not None:
            found.setdefault(re.sub(r"[_-]", ".", match.group(1)), tree)
    first = max((v for v in found if is_at_least(oldest, v)), key=parse, default="0")
    return {version: tree for version, tree in found.items() if is_at_least(version, first)}


def _list_headers(tree: pygit2.Tree, reported: LibraryClones) -> Iterator[tuple[str, pygit2.Blob]]:
    import pygit2

    stack = [(tree, "")]
    while stack:
        at, prefix = stack.pop()
        for entry in at:
            path = f"{prefix}{entry.name}"
            if isinstance(entry, pygit2.Tree):
                stack.append((entry, f"{path}/"))
            elif isinstance(entry, pygit2.Blob) and (match := reported.headers.match(path)) and not _ASIDE.search(path):
                yield reported.below + match["path"], entry
