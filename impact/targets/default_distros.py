"""The distros that a workspace is for, told by itself where nobody says any."""

from __future__ import annotations

import os
import posixpath
import re
from collections import Counter
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ...edges import files
from ...edges.groups import group_pairs
from ..tree import GitTree, Tree, TreeError, WorkingTree
from ..tree.ignore import find_git_dir
from ..tree.paths import is_vendored
from . import snapshot as snapshots
from .distro.known import KnownDistro, find_release, list_known_distros
from .snapshot import Snapshot

_LARGEST = 200_000
_AT_MOST = 4
_CI_FILE = re.compile(
    r"(?:^|/)(?:\.github/workflows/[^/]+\.ya?ml|\.gitlab-ci\.ya?ml|\.gitlab/[^/]+\.ya?ml|\.travis\.ya?ml"
    r"|\.circleci/config\.ya?ml|azure-pipelines\.ya?ml|Jenkinsfile|\.devcontainer/(?:[^/]+/)?devcontainer\.json"
    r"|(?:(?:[^/]*\.)?[Dd]ockerfile(?:\.[^/]*|[_-][^/.]*)?|[^/]*[_-][Dd]ockerfile)|(?:docker-)?compose\.ya?ml|pixi\.toml)$"
)
_AT_ROOT = re.compile(r"(?:\.github|\.gitlab-ci|\.gitlab|\.travis|\.circleci|azure-pipelines|Jenkinsfile)(?=[/.]|$)")
"""What CI services read at the root of a repository alone."""
_CI_FOLDERS = (".github/workflows", ".gitlab", ".circleci")
_CI_FILES = (".gitlab-ci.yml", ".gitlab-ci.yaml", ".travis.yml", ".travis.yaml", "azure-pipelines.yml", "Jenkinsfile")
"""What of these has a name that is known beforehand."""
_REPOSITORY_FILE = re.compile(r"\.(?:repos|rosinstall)$")
_BRANCH = re.compile(r"\bversion[\"']?\s*:\s*[\"']?([\w./-]+)")
_COMMENT = re.compile(r"^\s*(?:#|//).*|\s#\s.*")
_SAYS_ROS = re.compile(r"(?i)ros|distro|robostack")
_ITEM = re.compile(r"^\s*-\s*[\"']?([a-z]+)[\"']?\s*,?\s*$")
_LOOP = re.compile(r"\bfor\s+(\w+)\s+in\s")
# Before the variable of a loop over distros that are built for; others are branches, labels or file names.
_OF_DISTRO = r"(?:ros[-:/_]|(?i:distro)\W{1,4}|image\W.*)\$\{?"
_INSTALLING = re.compile(
    r"(?:^|/)(?:(?i:readme|install)[^/]*|[^/]*requirements[^/]*|[^/]+\.(?:sh|bash|zsh)|Makefile|justfile)$"
)
"""Files that tell how to install what a workspace needs."""


def find_named_distros(text: str, distros: Iterable[str]) -> list[str]:
    """Distros that a CI file or Dockerfile names, in order of first mention; comments do not count.

    Many names are ordinary words (iron, rolling, crystal), so a line must speak of ROS or a distro, or, in a file that
    speaks of ROS, name two distros or be an item of a list. What a shell loop runs through counts where its variable
    names an image, a package or a folder of ROS.
    """
    names = set(distros)
    speaks_of_ros = re.search(r"(?i)\bros|ros[_-]", text) is not None
    found: dict[str, None] = {}
    for line in text.splitlines():
        line = _COMMENT.sub("", line)
        words = [word for word in re.findall(r"[a-z]+", line) if word in names]
        if not words:
            continue
        loop = _LOOP.search(line)
        if loop is not None and not re.search(rf"{_OF_DISTRO}{loop[1]}\b", text):
            continue
        item = _ITEM.match(line)
        listed = item or len(set(words)) > 1
        if (listed and speaks_of_ros) or _SAYS_ROS.search(re.sub(r"\b\w*\$\{?\w+", "", line)):
            found.update(dict.fromkeys(words))
    return list(found)


class StatedVersion(NamedTuple):
    """A package of a workspace with the version that its manifest states. path: its folder. repository: the git
    repository that it lies in, None without one."""

    path: str
    repository: str | None
    name: str
    version: str


class ReleasedPackage(NamedTuple):
    """A package of a workspace that some distro has released. home: the repository that released it, as rosdistro calls
    it. distros: those that released the version that the workspace has."""

    package: StatedVersion
    home: str
    distros: tuple[str, ...]


Text = tuple[str, str, str]
"""A file: the repository that it belongs to, its path and its text."""
_Named = dict[str, dict[str, str]]
"""By repository the distros that it names, each with where."""


def choose_default_distros(
    ros: int,
    texts: Iterable[Text],
    branches: Iterable[tuple[str, str]],
    distros: Sequence[KnownDistro],
    environment: Mapping[str, str] = os.environ,
    today: str = "",
    installing: Iterable[Text] = (),
    above: Iterable[Text] = (),
    released: Sequence[ReleasedPackage] = (),
    packages: Iterable[StatedVersion] = (),
) -> tuple[tuple[str, ...], str]:
    """Distros to check against when nobody said any, and the reason as a clause.

    ros: generation of the workspace, 1 or 2. texts: CI files, Dockerfiles, pixi.toml, and files that list repositories
    (.repos, .rosinstall). branches: (repository, branch). today: ISO day that tells which distros have ended, the
    data's day. installing: files that tell how to install things. above: the CI files of the repository that the
    workspace is a folder of. packages: those of the workspace. released: which of them were released.

    The sourced environment comes first. Then the first of these that names a distro which still stands, or else the
    first that names any: the CI files; the branches of the repositories and those that these list; the CI files above;
    what tells how to install things; the versions of released packages; and at last the files that came with packages
    of somebody else. Of what it names those count that most repositories name, at most four of them, and no ended one
    beside a living one. Where nothing names any: the newest long-term distro of the generation. A repository inside
    another, which is somebody else's there, counts where the outer one names none.
    """
    fitting = {known.name: known for known in distros if known.ros == ros}
    sourced = environment.get("ROS_DISTRO", "")
    if sourced in fitting:
        return (sourced,), "the sourced environment (ROS_DISTRO)"

    def lives(distro: str) -> bool:
        return not fitting[distro].end_of_life or fitting[distro].end_of_life > today

    living = {distro for distro in fitting if lives(distro)}
    lasting = [distro for distro in fitting if fitting[distro].lts]
    newest = lasting[-1]
    # Of a generation that has ended as a whole, what builds a workspace names the long-term one that people have, and
    # what only tells of it is as old as it is.
    standing, told = living or set(lasting), living or {newest}
    named: _Named = {}
    says = ""
    foreign = find_foreign_folders(released, packages)
    for how, found in _list_named(texts, branches, above, installing, released, foreign, fitting, told):
        stands = any(distro in standing for places in found.values() for distro in places)
        if found and (stands or not named):
            named, says = found, how
        if stands:
            break
    old = sorted({distro for found in named.values() for distro in found})
    counts = Counter(distro for found in named.values() for distro in found)
    if not living.intersection(old):
        # Files of long ended distros are often left behind; only long-term ones are still deployed.
        counts = Counter({distro: count for distro, count in counts.items() if fitting[distro].lts})
    if not counts:
        why = f"since {', '.join(old)} ended long ago" if old else "since nothing names another"
        return (newest,), f"the newest long-term distro of ROS {ros}, {why}"
    most = max(counts.values())
    chosen = [distro for distro in fitting if counts[distro] == most]
    chosen = ([distro for distro in chosen if distro in living] or chosen)[-_AT_MOST:]
    places = list(dict.fromkeys(found[distro] for found in named.values() for distro in chosen if distro in found))
    where = places[0] + (f" and {len(places) - 1} more" if len(places) > 1 else "")
    return tuple(chosen), f"{says} ({where})"


_BY_FILES = "named by the workspace"
_BY_VERSIONS = "what released the versions of packages here"


def _list_named(
    texts: Iterable[Text],
    branches: Iterable[tuple[str, str]],
    above: Iterable[Text],
    installing: Iterable[Text],
    released: Iterable[ReleasedPackage],
    foreign: Collection[str],
    fitting: Collection[str],
    living: Collection[str],
) -> Iterator[tuple[str, _Named]]:
    """What names distros of a workspace, the most telling first, each with how it does.

    foreign: the folders of somebody else's packages. fitting: the distros of the generation. living: those that count
    where a text or a version only tells of them."""
    by_file: tuple[_Named, _Named] = {}, {}
    by_branch: tuple[_Named, _Named] = {}, {}
    for repository, path, text in texts:
        is_theirs = _is_below(path, foreign)
        if _REPOSITORY_FILE.search(path):
            found, kept = _list_distros(" ".join(_BRANCH.findall(text)), fitting), by_branch[is_theirs]
        else:
            found, kept = find_named_distros(text, fitting), by_file[is_theirs]
        for distro in found:
            kept.setdefault(repository, {}).setdefault(distro, path)
    yield _BY_FILES, _drop_inner(by_file[0])
    for repository, branch in branches:
        own = {distro: f"branch {branch}" for distro in _list_distros(branch, fitting)}
        if own:  # says more than the branches of what it depends on
            by_branch[0][repository] = own
    yield _BY_FILES, _drop_inner(by_branch[0])
    yield _BY_FILES, _collect_named(above, partial(find_named_distros, distros=fitting))
    told = list(installing)
    read = partial(_list_installed, living=living)
    yield _BY_FILES, _drop_inner(_collect_named((text for text in told if not _is_below(text[1], foreign)), read))
    by_version: _Named = {}
    for one in released:
        for distro in set(living).intersection(one.distros):
            by_version.setdefault(one.home, {}).setdefault(distro, f"{one.package.name} {one.package.version}")
    yield _BY_VERSIONS, by_version
    yield _BY_FILES, _drop_inner(by_file[1])
    yield _BY_FILES, _drop_inner(by_branch[1])
    yield _BY_FILES, _drop_inner(_collect_named((text for text in told if _is_below(text[1], foreign)), read))


def _collect_named(texts: Iterable[Text], read: Callable[[str], Iterable[str]]) -> _Named:
    """The distros that are read in texts."""
    named: _Named = {}
    for repository, path, text in texts:
        for distro in read(text):
            named.setdefault(repository, {}).setdefault(distro, path)
    return named


def _list_installed(text: str, living: Collection[str]) -> list[str]:
    """The distros that a text tells to install, of those that count."""
    from ..facts.distros import list_installed_distros

    return [distro for distro in list_installed_distros(text) if distro in living]


def _is_below(path: str, folders: Iterable[str]) -> bool:
    return any(path == folder or path.startswith(f"{folder}/") for folder in folders)


def find_foreign_folders(
    released: Iterable[ReleasedPackage], packages: Iterable[StatedVersion]
) -> tuple[str, ...]:
    """The folders of a workspace with released packages of somebody else: all released ones but those of a git
    repository that releases its own packages, which are at least half of what it holds and of one home.

    packages: all of the workspace."""
    around = group_pairs((one.repository, one.path) for one in packages)
    found: list[str] = []
    for repository, those in group_pairs((one.package.repository, one) for one in released).items():
        every = around[repository]
        homes = group_pairs((one.home, one.package.path) for one in those)
        if len(homes) == 1 and len(those) * 2 >= len(every):
            continue
        for paths in homes.values():
            shared = posixpath.commonpath(paths)
            inside = [path for path in every if _is_below(path, (shared,))]
            others = {path for home in homes.values() if home is not paths for path in home}
            whole = shared not in ("", repository) and len(paths) * 2 >= len(inside) and others.isdisjoint(inside)
            found += [shared] if whole else paths
    return tuple(found)


def _list_distros(text: str, distros: Container[str]) -> list[str]:
    return [word for word in re.findall(r"[a-z]+", text.lower()) if word in distros]


def _drop_inner(named: dict[str, dict[str, str]]) -> dict[str, dict[str, str]]:
    """What repositories name without those that lie inside another of them."""
    return {
        folder: found
        for folder, found in named.items()
        if not any(other != folder and (not other or folder.startswith(f"{other}/")) for other in named)
    }


def find_default_distros(
    ros: int, tree: Tree, packages: Sequence[StatedVersion], data: Snapshot | None = None
) -> tuple[tuple[str, ...], str]:
    """What choose_default_distros() gives for a tree with these packages."""
    data = data or snapshots.load_snapshot()
    revision = getattr(tree, "revision", "")
    # What is checked out says nothing of another revision; the name of that one does, if it is a branch or a tag.
    current = not revision or revision.startswith(("HEAD", "@")) or getattr(tree, "is_checked_out", False)
    found = ((package, find_release(package.name, package.version, data)) for package in packages)
    return choose_default_distros(
        ros,
        _iterate_texts(tree, _CI_FILE, _REPOSITORY_FILE),
        _list_branches(tree) if current else [("", revision)],
        list_known_distros(data),
        today=data.date,
        installing=_iterate_texts(tree, _INSTALLING),
        above=_iterate_texts_above(tree),
        packages=packages,
        released=[ReleasedPackage(package, *release) for package, release in found if release is not None],
    )


def _list_branches(tree: Tree) -> list[tuple[str, str]]:
    found = ((folder, read_branch(Path(path))) for folder, path in tree.repositories.items())
    return [(folder, branch) for folder, branch in found if branch]


def _iterate_texts(tree: Tree, *patterns: re.Pattern[str]) -> Iterator[tuple[str, str, str]]:
    """The files whose paths match a pattern, each with the repository that it belongs to. A folder with files that CI
    services read at the root of a repository alone is one, also where its history was left out."""
    paths = [
        entry.path
        for entry in tree.list_entries()
        if entry.size <= _LARGEST
        and any(pattern.search(entry.path) for pattern in patterns)
        and not is_vendored(entry.path)
    ]
    roots = {path[: at.start()].rstrip("/") for path in paths if (at := _AT_ROOT.search(path))}
    owners = sorted({folder.strip("./") for folder in tree.repositories} | roots, key=len, reverse=True)
    for path in paths:
        owner = next((folder for folder in owners if not folder or path.startswith(f"{folder}/")), "")
        yield from ((owner, path, text) for text in _read_text(tree, path))


def _read_text(tree: Tree, path: str) -> Iterator[str]:
    """The text of a file; nothing where it cannot be read."""
    with suppress(OSError):
        yield tree.read(path, _LARGEST).decode("utf-8", "replace")


def _iterate_texts_above(tree: Tree) -> Iterator[tuple[str, str, str]]:
    """What CI services read at the root of the repository that a tree is a folder of, as _iterate_texts() has it; paths
    are relative to the tree. Of the rest of the repository nothing is read."""
    if not isinstance(tree, GitTree | WorkingTree) or (depth := tree.count_levels_in_repository()) == 0:
        return
    for folder in ("", *_CI_FOLDERS):
        try:
            found = tree.open_folder_of_repository(folder)
            names = [name for name in _CI_FILES if found.exists(name)] if not folder else [
                entry.path for entry in found.list_entries() if entry.size <= _LARGEST
            ]  # fmt: skip
        except TreeError:
            continue
        for name in names:
            path = f"{folder}/{name}" if folder else name
            if _CI_FILE.search(path):
                yield from (("", "../" * depth + path, text) for text in _read_text(found, name))


def read_branch(repository: Path) -> str:
    """The branch checked out in a git repository, empty when none is (a detached or bare one without HEAD)."""
    try:
        place = find_git_dir(os.fspath(repository)) if os.path.lexists(repository / ".git") else os.fspath(repository)
        head = files.read_text(os.path.join(place, "HEAD"), _LARGEST)
    except (OSError, UnicodeDecodeError):
        return ""
    return head.splitlines()[0].strip().removeprefix("ref: refs/heads/") if head.startswith("ref: refs/heads/") else ""
