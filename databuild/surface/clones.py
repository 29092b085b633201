"""Released versions of packages in a folder of git clones: which clone, which tag, and the surfaces there."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ...edges.console import UserError
from ...impact.targets.distro.distro import DistroTarget, TargetError
from ...impact.targets.distro.known import list_known_distros
from ...impact.targets.snapshot import Snapshot, load_snapshot
from ...impact.targets.surface.surface import Surface
from ...impact.targets.version import parse
from ...impact.tree import GitTree, TreeError
from .compare import RepositorySurfaces
from .package import build_tree_surfaces
from .releases import find_git_directory, find_tag, list_releases, normalize_url

if TYPE_CHECKING:
    from ...impact.facts.store import Store


class VersionError(UserError):
    """A version that cannot be read from the clones; the message says why and what to do."""


class DistroVersion(NamedTuple):
    """A version that a distro has or had. urls: of its sources, those known. superseded: it has a newer one now."""

    distro: str
    version: str
    urls: tuple[str, ...]
    branch: str
    superseded: bool = False


class Version(NamedTuple):
    """A repository state that stands for a version. version: as released, empty where only a revision was asked for.
    approximate: there is no tag, so a branch stands for it."""

    clone: Clone
    revision: str
    version: str = ""
    approximate: bool = False


_BLOOM = re.compile(r"release/([^/]+)/([^/]+)/([^/-]+)(?:-([^/]+))?")


class Clone:
    """A git repository, bare or not. name: `owner/name` or its folder's name."""

    def __init__(self, place: Path, name: str = ""):
        where = find_git_directory(place)
        if where is None:
            raise VersionError(f"{place} is no git repository; give a clone with its tags")
        self.place, self.name = where, name or place.name.replace("+", "/")
        self._tree: GitTree | None = None

    @cached_property
    def tags(self) -> dict[str, str]:
        """Refs by the names of tags."""
        start = "refs/tags/"
        return {ref.removeprefix(start): ref for ref in self._repository.references if ref.startswith(start)}

    @cached_property
    def _repository(self) -> Any:
        import pygit2

        try:
            return pygit2.Repository(str(self.place))
        except (pygit2.GitError, KeyError):
            raise VersionError(f"{self.place} is no git repository; give a clone with its tags") from None

    def tag(self, version: str, package: str = "", distro: str = "") -> str | None:
        """The ref of the tag of a version: as developers name them, else as bloom does in release repositories. Of the
        latter one that holds the whole repository counts more than one that holds the package alone."""
        found = find_tag(self.tags, version, self.name.rpartition("/")[2])
        if found is not None:
            return found
        released = self.released.get((package, version), {})
        alone = released.get(distro) if distro else next(iter(released.values()), None)
        return None if alone is None else self.tags.get(f"upstream/{version}", alone)

    @cached_property
    def released(self) -> dict[tuple[str, str], dict[str, str]]:
        """Of a release repository of bloom (`release/humble/rclcpp/16.0.11-1`): package and version to distro to ref,
        that of the last increment."""
        found: dict[tuple[str, str], dict[str, tuple[tuple[int, ...], str]]] = {}
        for name, ref in self.tags.items():
            reported = _BLOOM.fullmatch(name)
            if reported is not None:
                distro, package, version, increment = reported.groups()
                each = found.setdefault((package, version), {})
                each[distro] = max(each.get(distro, ((), "")), (parse(increment or ""), ref))
        return {key: {distro: ref for distro, (_, ref) in each.items()} for key, each in found.items()}

    def find_branch(self, *names: str) -> str | None:
        """The ref of the first of these branches that there is."""
        known = set(self._repository.references)
        spelt = (f"{start}{name}" for name in names if name for start in ("refs/heads/", "refs/remotes/origin/"))
        return next((ref for ref in spelt if ref in known), None)

    def is_one_of(self, urls: Iterable[str]) -> bool:
        """Whether it is a clone from one of these addresses."""
        return self.name.lower() in map(normalize_url, urls)

    def is_older(self, version: str) -> bool:
        """Whether there are tags, all of them of versions before this one."""
        known = [parse(tag) for tag in self.tags if re.fullmatch(r"v?\d+\.\d+(?:\.\d+)?", tag)]
        return bool(known) and max(known) < parse(version)

    def read_surfaces(self, revision: str, store: Store, jobs: int | None = None) -> dict[str, Surface]:
        """The surfaces of all packages at a revision. Raises TreeError."""
        return build_tree_surfaces(self.read_tree(revision), store, self.find_folder_id(revision), jobs)

    def read_tree(self, revision: str) -> GitTree:
        """The files of a revision; folders that revisions share are read once. Raises TreeError."""
        self._tree = GitTree(self.place, revision) if self._tree is None else self._tree.open_revision(revision)
        return self._tree

    def find_folder_id(self, revision: str) -> str:
        """Git's id of all that a revision holds. Raises TreeError."""
        import pygit2

        try:
            return str(self._repository.revparse_single(revision).peel(pygit2.Tree).id)
        except (KeyError, ValueError, pygit2.GitError):
            raise TreeError(f"{self.name}: there is no revision `{revision}`; `git tag` lists what there is") from None


def find_release(package: str, asked: str, data: Snapshot) -> DistroVersion:
    """What a distro (`jazzy`, `jazzy@2024-08-01`) has of a package. Raises VersionError when it does not have it."""
    name, _, date = asked.partition("@")
    try:
        target = DistroTarget(name, date or None, data=data)
    except TargetError as error:
        raise VersionError(str(error)) from None
    version = target.find_version(package)
    if version is None:
        having = [known.name for known in list_known_distros(data) if DistroTarget(known.name).find_version(package)]
        where = f"; released in {', '.join(having)}" if having else ", and no other distro either"
        raise VersionError(f"{asked} has no `{package}`{where}")
    _, url, branch = target.find_repository(package) or ("", "", "")
    return DistroVersion(name, version, (url,) if url else (), branch)


def find_newest_distro(package: str, data: Snapshot) -> str:
    """The newest distro that has a package. Raises VersionError when none has it."""
    for known in reversed(list_known_distros(data)):
        if DistroTarget(known.name, data=data).find_version(package):
            return known.name
    raise VersionError(f"no distro ever had `{package}`; say which version is meant: {package}@1.0.0")


def _find_tagged_versions(clones: Iterable[Clone], package: str, version: str, distro: str = "") -> Iterator[Version]:
    for clone in clones:
        tag = clone.tag(version, package, distro)
        if tag is not None:
            yield Version(clone, tag, version)


class Clones:
    """A folder of clones, called `OWNER+NAME` or by the repository's name (the git directory may lie below)."""

    def __init__(self, folder: Path, data: Snapshot | None = None):
        if not folder.is_dir():
            raise VersionError(f"{folder}: no such folder; give one that holds clones of the repositories")
        self.folder, self._data = folder, data or load_snapshot()
        self._clones: dict[str, Clone] = {}
        self._known: dict[str, list[Clone]] = {}

    @cached_property
    def _places(self) -> dict[str, list[Path]]:
        """Folders of clones by the last part of their name, in lower case."""
        found: dict[str, list[Path]] = {}
        for place in sorted(self.folder.iterdir()):
            if place.is_dir() and find_git_directory(place) is not None:
                name = place.name.rpartition("+")[2].removesuffix(".git").lower()
                found.setdefault(name, []).append(place)
        return found

    def list_clones(self) -> Iterator[Clone]:
        """Every clone."""
        for places in self._places.values():
            yield from map(self._open, places)

    def _open(self, place: Path) -> Clone:
        if place.name not in self._clones:
            self._clones[place.name] = Clone(place)
        return self._clones[place.name]

    def find_clones(self, package: str) -> list[Clone]:
        """Clones of the repositories that ever released a package."""
        if package not in self._known:
            self._known[package] = self._find_clones(package)
        return self._known[package]

    def _find_clones(self, package: str) -> list[Clone]:
        urls = self._data.fetch(
            "SELECT DISTINCT u.text FROM package p JOIN home h ON h.package = p.id JOIN source s ON"
            " s.distro = h.distro AND s.repository = h.repository JOIN url u ON u.id = s.url WHERE p.name = ?",
            (package,),
        )
        names = dict.fromkeys(normalize_url(text) for (text,) in urls if text)
        found = [place for name in names for place in self._places.get(name.rpartition("/")[2], ())]
        # The clone of the very owner first; forks and moved repositories have the same tags.
        exact = [place for place in found if place.name.lower().replace("+", "/") in names]
        return [*(self._open(place) for place in dict.fromkeys((*exact, *found))), *self._releasing.get(package, ())]

    @cached_property
    def _releasing(self) -> dict[str, list[Clone]]:
        """Release repositories of bloom by the packages that they have. Their names need not tell the repository's."""
        found: dict[str, list[Clone]] = {}
        for name, places in self._places.items():
            for clone in map(self._open, places) if name.endswith("-release") else ():
                for package in {package for package, _ in clone.released}:
                    found.setdefault(package, []).append(clone)
        return found

    def list_clone_releases(self, clone: Clone) -> dict[str, dict[str, frozenset[str]]]:
        """What a repository released: distro to version, in order, to packages."""
        found: dict[str, dict[str, frozenset[str]]] = {}
        for release in list_releases(self._data, clone.name):
            found.setdefault(release.distro, {})[release.version] = release.packages
        return found

    def find(self, package: str, asked: str) -> Iterator[Version]:
        """States that may stand for a version (`28.1.0`), or for a distro's (`jazzy`, `jazzy@2024-08-01`), of a
        package, best first. Raises VersionError when the distro never had it, or there is no clone."""
        clones = self.find_clones(package)
        if not clones:
            raise VersionError(f"no clone in {self.folder} has `{package}`; clone its repository there, with tags")
        if not asked or asked[0].isdigit():
            yield from _find_tagged_versions(clones, package, asked)
            return
        release = find_release(package, asked, self._data)
        if not self._find_release_clones(package, release):
            url = release.urls[0]
            raise VersionError(
                f"{asked} has `{package}` from {url}, of which there is no clone in {self.folder}; clone it there"
            )
        yield from self.find_candidates(package, release)

    def find_candidates(self, package: str, release: DistroVersion) -> Iterator[Version]:
        """States that may stand for a package of a release, best first."""
        clones = self._find_release_clones(package, release)
        yield from _find_tagged_versions(clones, package, release.version, release.distro)
        if release.superseded:
            return  # a branch went on since
        for clone in clones:
            tip = clone.find_branch(release.branch, release.distro, f"{release.distro}-devel")
            if tip is None and clone.is_one_of(release.urls) and clone.is_older(release.version):
                tip = "HEAD"  # released after all that the clone has a tag for
            if tip is not None:
                yield Version(clone, tip, release.version, True)

    def _find_release_clones(self, package: str, release: DistroVersion) -> list[Clone]:
        """The clones that may have what a distro released."""
        clones = self.find_clones(package)
        own = [clone for clone in clones if clone.is_one_of(release.urls)]
        # A release repository says itself what it released for whom.
        bloomed = [clone for clone in clones if release.distro in clone.released.get((package, release.version), ())]
        # Another owner's repository of the same name may be another project: geometry2 of ROS 1 and of ROS 2.
        names = {normalize_url(url).rpartition("/")[2] for url in release.urls}
        alike = [clone for clone in clones if not names or clone.name.lower().rpartition("/")[2] in names]
        return list(dict.fromkeys((*own, *bloomed))) or alike

    def find_newest(self, package: str) -> str:
        """The newest distro that has a package. Raises VersionError when none has it."""
        return find_newest_distro(package, self._data)

    def find_surface(
        self, package: str, asked: str, store: Store, jobs: int | None = None
    ) -> tuple[Version, RepositorySurfaces]:
        """The state that stands for a version of a package, see find(). Raises VersionError where there is none."""
        tried = []
        for version in self.find(package, asked):
            surfaces = version.clone.read_surfaces(version.revision, store, jobs)
            if package in surfaces:
                return version, RepositorySurfaces(surfaces)
            tried.append(version.revision.removeprefix("refs/").partition("/")[2])
        clones = ", ".join(clone.name for clone in self.find_clones(package))
        what = f"{', '.join(tried)} in {clones} does not have it" if tried else f"{clones} has no tag for it"
        raise VersionError(f"`{package}` {asked} cannot be read: {what}; `git fetch --tags` may bring it")
