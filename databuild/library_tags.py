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
from ..impact.targets.version import at_least, parts
from .extract import cpp
from .history import _tree
from .includes import AV_HEADERS
from .surface.releases import git_directory

if TYPE_CHECKING:
    import pygit2

_ENDING = r"\.(?:h|hpp|hh|hxx|inl|ipp)"


class LibraryClones(NamedTuple):
    """The clones of a library. names: their folders, `OWNER+NAME`, with `*` for any. headers: paths in them, whose
    group `path` is how they are included. below: what stands before that."""

    names: str
    headers: re.Pattern[str]
    below: str = ""


def _sources(names: str, headers: str, below: str = "") -> LibraryClones:
    return LibraryClones(names, re.compile(rf"(?:{headers})\Z"), below)


def _of_include(folder: str) -> str:
    return rf"(?:[\w-]+/)*include/(?P<path>{folder}/.+{_ENDING})"


SOURCES = {
    "pcl": _sources("PointCloudLibrary+pcl", _of_include("pcl")),
    "boost": _sources("boostorg+*", rf"(?:[\w-]+/)?include/(?P<path>boost/.+{_ENDING})"),
    "eigen3": _sources("eigenteam+eigen-git-mirror", r"(?P<path>(?:Eigen|unsupported/Eigen)/[\w./]+)"),
    "yaml-cpp": _sources("jbeder+yaml-cpp", _of_include("yaml-cpp")),
    "fmt": _sources("fmtlib+fmt", rf"(?:include/)?(?P<path>fmt/.+{_ENDING})"),
    "tinyxml2": _sources("leethomason+tinyxml2", rf"(?P<path>tinyxml2{_ENDING})"),
    "bullet": _sources("bulletphysics+bullet3", rf"src/(?P<path>.+{_ENDING})"),
    "orocos-kdl": _sources(
        "orocos+orocos_kinematics_dynamics", rf"orocos_kdl/src/(?P<path>(?:utilities/)?\w+{_ENDING})", "kdl/"
    ),
    "assimp": _sources("assimp+assimp", _of_include("assimp")),
    "ceres": _sources("ceres-solver+ceres-solver", _of_include("ceres")),
    "fcl": _sources("flexible-collision-library+fcl", _of_include("fcl")),
    "ompl": _sources("ompl+ompl", rf"src/(?P<path>ompl/.+{_ENDING})"),
    "octomap": _sources("OctoMap+octomap", _of_include("octomap")),
    "spdlog": _sources("gabime+spdlog", _of_include("spdlog")),
    "libav": _sources("libav+libav", rf"(?P<path>{AV_HEADERS.pattern})"),
    "console-bridge": _sources("ros+console_bridge", _of_include("console_bridge")),
    "urdfdom-headers": _sources("ros+urdfdom_headers", _of_include(r"urdf_\w+")),
    "urdfdom": _sources("ros+urdfdom", _of_include("urdf_parser")),
    "flann": _sources("flann-lib+flann", rf"src/cpp/(?P<path>flann/.+{_ENDING})"),
    "gtest": _sources("google+googletest", _of_include("g(?:test|mock)")),
    "ogre": _sources("OGRECave+ogre", rf"OgreMain/include/(?P<path>Ogre\w+{_ENDING})"),
}
"""Platform libraries by their names in platform_versions.yaml."""
_TAG = re.compile(r"(?:(?:rel/)?v|pcl-|release-|yaml-cpp-|boost-)?(\d+(?:[._-]\d+){1,3})(?:-src)?\Z")
_ASIDE = re.compile(r"(?:^|/)(?:tests?|docs?|examples?|benchmarks?|samples?|apps|third_?party|3rdparty|gpu|cuda)/")
_WORD = re.compile(r"[A-Za-z_]\w*")
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


class Tagged(NamedTuple):
    """A library at one version's tags: headers by the path that is included, and the words in any of them."""

    number: str
    headers: Mapping[str, HeaderSurface]
    words: frozenset[str]


def read(folder: Path, library: str, platforms: Collection[str], inner: re.Pattern[str]) -> Iterator[Tagged]:
    """The versions of a library from the oldest one that some platform has on, oldest first, none twice; of a library
    of many clones only those that platforms have. folder: of the clones. platforms: the versions of platforms. inner:
    paths of headers that nobody includes. Nothing where no clone is there."""
    import pygit2

    told = SOURCES.get(library)
    versions: dict[str, dict[str, bytes]] = defaultdict(dict)
    known: dict[bytes, tuple[HeaderSurface, frozenset[str]]] = {}
    if told is None or not platforms:
        return
    for where in filter(None, map(git_directory, sorted(folder.glob(told.names)))):
        repository = pygit2.Repository(str(where))
        for number, tree in _versions(repository, min(platforms, key=parts)).items():
            if "*" in told.names and number not in platforms:
                continue
            for path, blob in _headers(tree, told):
                versions[number][path] = blob.id.raw
                if blob.id.raw not in known:
                    text = blob.data
                    words = frozenset(_WORD.findall(_COMMENT.sub(" ", text.decode("utf-8", "replace"))))
                    known[blob.id.raw] = (HeaderSurface(()) if inner.search(path) else cpp.extract(text), words)
    for number in sorted(versions, key=parts):
        found = versions[number]
        words = frozenset().union(*(known[blob][1] for blob in found.values()))
        yield Tagged(number, {path: known[blob][0] for path, blob in sorted(found.items())}, words)


def _versions(repository: pygit2.Repository, oldest: str) -> dict[str, pygit2.Tree]:
    found: dict[str, pygit2.Tree] = {}
    for ref in sorted(repository.references):
        match = _TAG.match(ref.removeprefix("refs/tags/")) if ref.startswith("refs/tags/") else None
        tree = _tree(repository, ref) if match else None
        if match and tree is not None:
            found.setdefault(re.sub(r"[_-]", ".", match.group(1)), tree)
    first = max((v for v in found if at_least(oldest, v)), key=parts, default="0")
    return {version: tree for version, tree in found.items() if at_least(version, first)}


def _headers(tree: pygit2.Tree, told: LibraryClones) -> Iterator[tuple[str, pygit2.Blob]]:
    import pygit2

    stack = [(tree, "")]
    while stack:
        at, prefix = stack.pop()
        for entry in at:
            path = f"{prefix}{entry.name}"
            if isinstance(entry, pygit2.Tree):
                stack.append((entry, f"{path}/"))
            elif isinstance(entry, pygit2.Blob) and (match := told.headers.match(path)) and not _ASIDE.search(path):
                yield told.below + match["path"], entry
