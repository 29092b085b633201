"""Which release of a ROS package has which header, module and CMake file, read from git trees.

rosdistro says which version of a repository a distro released and when; the repository's tag of that version gives the
files. Trees that did not change from tag to tag are read once.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ..impact.targets.snapshot import Snapshot, load_snapshot
from ..impact.targets.version import parse
from .surface.releases import Release, find_git_directory, find_tag, list_releases


class RosFacts(NamedTuple):
    """headers: (path, package) to spans. packages: package to the spans read. modules, cmake: name to packages."""

    headers: dict[tuple[str, str], str]
    packages: dict[str, str]
    modules: dict[str, str]
    cmake: dict[str, str]


class FolderOffers(NamedTuple):
    """What one package folder offers: header include paths, Python modules, find_package names."""

    name: str
    headers: frozenset[str]
    modules: frozenset[str]
    cmake: frozenset[str]


_HEADER = re.compile(r"\.(?:h|hh|hpp|hxx|h\+\+|inl|ipp|tcc|cuh)(?:\.in|\.em)?$")
_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
_ASIDE = frozenset(
    (
        *("test", "tests", "testing", "doc", "docs", "example", "examples", "benchmark", "benchmarks"),
        *("third_party", "thirdparty", "3rdparty"),
    )
)
_NO_MODULE = _ASIDE | frozenset(
    (
        *("launch", "scripts", "script", "cfg", "config", "msg", "srv", "action", "include", "src", "cmake"),
        *("resource", "rviz", "urdf", "worlds", "models"),
    )
)
# Sources that are installed as headers from where they lie, as rviz does.
_INSTALLED_SOURCES = re.compile(
    r"install\s*\(\s*DIRECTORY\s+(\.?/?(?:src/)?[\w./${}-]*)\s+DESTINATION\s+\$\{CATKIN_PACKAGE_INCLUDE_DESTINATION\}",
    re.IGNORECASE,
)
_SHIPS_MODULES = re.compile(r"cmake_modules$|_cmake_modules?$|_vendor$|cmake_helpers$")
# A package's CMake extras that put a folder below include/ on the path as well, as xmlrpcpp does for its old names.
_EXTRA_INCLUDE = re.compile(r"_INCLUDE_DIRS\b[^)]*?(?:include|INCLUDE_DESTINATION@)/(\w+)\b")
_TREE = "tree"


class SurfaceReader:
    """Surfaces of the packages in a git repository at any commit. repository: a pygit2.Repository."""

    def __init__(self, repository):
        self._repository = repository
        self._folders: dict[bytes, tuple[FolderOffers, ...]] = {}

    def read_packages(self, tree) -> tuple[FolderOffers, ...]:
        """All packages in a tree, as colcon finds them: the first package.xml on the way down."""
        known = self._folders.get(tree.id.raw)
        if known is None:
            known = self._folders[tree.id.raw] = tuple(self._find_packages(tree))
        return known

    def _find_packages(self, tree) -> Iterator[FolderOffers]:
        entries = {entry.name: entry for entry in tree}
        manifest = entries.get("package.xml")
        if manifest is not None and manifest.type_str == "blob":
            match = _NAME.search(manifest.data)
            if match:
                yield self._read_surface(match.group(1).decode("utf-8", "replace"), tree)
            return
        for name, entry in entries.items():
            if entry.type_str == _TREE and name not in _ASIDE and not name.startswith("."):
                yield from self.read_packages(entry)

    def _read_surface(self, name: str, tree) -> FolderOffers:
        headers: set[str] = set()
        modules: set[str] = set()
        cmake: set[str] = set()
        beside: set[str] = set()
        for path, entry in _walk(tree, ""):
            where, _, file = path.rpartition("/")
            if _HEADER.search(file):
                head, found, rest = f"/{path}".partition("/include/")
                if found and not _ASIDE & set(head.split("/")):
                    headers.add(re.sub(r"\.(?:in|em)$", "", rest))
            elif file == "__init__.py":
                folders = where.split("/")
                if len(folders) == 2 and folders[0] == "src":
                    modules.add(folders[1])
                elif len(folders) == 1 and folders[0] and folders[0] not in _NO_MODULE:
                    modules.add(folders[0])
            elif file.endswith(".cmake") or (".cmake." in file and file.endswith(".in")):
                if "extras" in file:
                    beside.update(_EXTRA_INCLUDE.findall(entry.data.decode("utf-8", "replace")))
                plain = file.removesuffix(".in").removesuffix(".cmake")
                if plain.startswith("Find") and _SHIPS_MODULES.search(name):
                    cmake.add(plain[len("Find") :])
                for end in ("Config", "-config"):
                    asked = plain.removesuffix(end)
                    if asked != plain and _normalize_name(asked) == _normalize_name(name.removesuffix("_vendor")):
                        cmake.add(asked)
            elif file == "CMakeLists.txt" and path.count("/") < 3:
                for match in _INSTALLED_SOURCES.finditer(entry.data.decode("utf-8", "replace")):
                    folder = match.group(1).replace("${PROJECT_NAME}", name)
                    if not folder.startswith("include"):
                        headers.update(self._list_installed_headers(name, tree, where, folder))
        for folder in beside:
            headers.update([h.removeprefix(f"{folder}/") for h in headers if h.startswith(f"{folder}/")])
        return FolderOffers(name, frozenset(headers), frozenset(modules - {name}), frozenset(cmake - {name, ""}))

    def _list_installed_headers(self, name: str, tree, where: str, folder: str) -> Iterator[str]:
        plain = "/".join(part for part in f"{where}/{folder}".split("/") if part not in ("", "."))
        try:
            below = tree[plain] if plain else tree
        except KeyError:
            return
        if below.type_str == _TREE:
            base = "" if folder.endswith(("/", ".")) else plain.rpartition("/")[2] + "/"
            for path, _ in _walk(below, ""):
                if _HEADER.search(path):
                    yield f"{name}/{base}{path}"


def _normalize_name(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def _walk(tree, prefix: str):
    for entry in tree:
        if entry.type_str == _TREE:
            yield from _walk(entry, f"{prefix}{entry.name}/")
        elif entry.type_str == "blob":
            yield prefix + entry.name, entry


# Releases


class _Known(NamedTuple):
    """Releases of a package that were read: distro to versions in order, and header to the versions that have it."""

    versions: dict[str, list[str]]
    headers: dict[str, dict[str, set[str]]]


def read_repositories(folder: Path, snapshot: Snapshot | None = None) -> RosFacts:
    """Facts of all bare clones in a folder (`OWNER+NAME`, or a git directory below it)."""
    import pygit2

    known: dict[str, _Known] = defaultdict(lambda: _Known({}, {}))
    seen: set[tuple[str, str]] = set()
    modules: dict[str, set[str]] = defaultdict(set)
    cmake: dict[str, set[str]] = defaultdict(set)
    data = snapshot or load_snapshot()
    for clone in sorted(folder.iterdir()):
        where = find_git_directory(clone)
        if where is None:
            continue
        repository = pygit2.Repository(str(where))
        reader = SurfaceReader(repository)
        tags = {ref.removeprefix("refs/tags/"): ref for ref in repository.references if ref.startswith("refs/tags/")}
        releases = list_releases(data, clone.name.replace("+", "/"))
        surfaces = list(_read_tips(repository, reader, releases))
        for release in releases:
            ref = find_tag(tags, release.version, clone.name.rpartition("+")[2])
            tree = ref and _find_tree(repository, ref)
            if not tree:
                continue
            for surface in reader.read_packages(tree):
                if surface.name in release.packages:
                    _record(known[surface.name], release, surface)
                    surfaces.append(surface)
        for surface in set(surfaces):
            seen.update((header, surface.name) for header in surface.headers)
            for name in surface.modules:
                modules[name].add(surface.name)
            for name in surface.cmake:
                cmake[name].add(surface.name)
    headers = {(header, package): "" for header, package in seen}
    for package, facts in known.items():
        for header, having in facts.headers.items():
            headers[header, package] = _format_spans(facts.versions, having)
    return RosFacts(
        headers,
        {package: _format_all_spans(facts.versions) for package, facts in known.items()},
        {name: " ".join(sorted(packages)) for name, packages in modules.items()},
        {name: " ".join(sorted(packages)) for name, packages in cmake.items()},
    )


def _find_tree(repository, ref: str):
    import pygit2

    try:
        return repository.revparse_single(ref).peel(pygit2.Tree)
    except (KeyError, ValueError, pygit2.GitError):
        return None


def _read_tips(repository, reader: SurfaceReader, releases: list[Release]) -> Iterator[FolderOffers]:
    """Packages at the branches' ends that any distro released: who has a header, not since when."""
    released = frozenset().union(*(release.packages for release in releases)) if releases else frozenset()
    for ref in repository.references:
        if ref.startswith(("refs/heads/", "refs/remotes/origin/")) and "/" not in ref.split("/", 2)[2]:
            tree = _find_tree(repository, ref)
            if tree:
                yield from (s for s in reader.read_packages(tree) if s.name in released)


def _record(known: _Known, release: Release, surface: FolderOffers) -> None:
    versions = known.versions.setdefault(release.distro, [])
    if release.version not in versions:
        versions.append(release.version)
    for header in surface.headers:
        known.headers.setdefault(header, {}).setdefault(release.distro, set()).add(release.version)


def _format_spans(versions: dict[str, list[str]], having: dict[str, set[str]]) -> str:
    """Runs of versions that have something, one line each: distro, first, last or `-` at the end."""
    lines = []
    for distro in sorted(versions):
        order = sorted(versions[distro], key=parse)
        start = None
        for place, version in enumerate(order):
            has = version in having.get(distro, ())
            if has and start is None:
                start = version
            if start is not None and not has:
                lines.append(f"{distro} {start} {order[place - 1]}")
                start = None
        if start is not None:
            lines.append(f"{distro} {start} -")
    return "\n".join(lines)


def _format_all_spans(versions: dict[str, list[str]]) -> str:
    return "\n".join(
        f"{distro} {min(known, key=parse)} {max(known, key=parse)}" for distro, known in sorted(versions.items())
    )
