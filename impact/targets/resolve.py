"""From what a person writes after `--target`, or writes nowhere, to targets."""

from __future__ import annotations

import datetime
import os
import posixpath
import re
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from ...edges import files
from ...edges.console import escape
from ...edges.limits import get_limits
from ..config import Config, check_inside, lies_in
from ..tree import GitTree, Tree, TreeError, WorkingTree
from ..tree.ignore import find_git_dir
from ..tree.paths import is_vendored
from . import snapshot as snapshots
from .distro.distro import DistroTarget, TargetError
from .distro.known import KnownDistro, list_known_distros, list_rosdep_systems, suggest_name
from .platform import CODENAMES, OTHER_RELEASES, OTHER_SYSTEMS, normalize_library_name, normalize_platform
from .snapshot import Snapshot

__all__ = ["Chosen", "TargetError", "choose_default_distros", "choose_targets", "find_named_distros", "parse_target"]

_DPKG = ".dpkg.txt"
_DOCKER = "docker:"
_DATE = re.compile(r"\d{4}-\d\d?-\d\d?$")
_LARGEST = 200_000
_AT_MOST = 4


class Chosen(NamedTuple):
    """A target and one clause that says why it was chosen."""

    target: DistroTarget
    reason: str


def parse_target(
    text: str, config: Config | None = None, folder: Path = Path(), data: Snapshot | None = None
) -> DistroTarget:
    """One target from its text.

    text: `jazzy`, `humble@2024-03-01`, a target's name in rosimpact.toml (a date may follow it too), a captured
    machine (`envs/laptop.json`), a listing of `dpkg -l` (`robot.dpkg.txt`), or `docker:osrf/ros:humble-desktop`, told
    by its tag without network. folder: what file names are relative to. Raises TargetError, which lists what is known.
    """
    text = text.strip()
    if text.startswith(_DOCKER):
        return _parse_docker(text, data)
    if text.endswith((_DPKG, ".json")):
        if "\0" in text:
            raise TargetError(f"`{escape(text)}` is no path of a file")
        return _load_dpkg(folder / text, text, data) if text.endswith(_DPKG) else _load_captured(folder / text, text)
    named = config.targets if config else {}
    base, at, date = text.partition("@")
    for name, day in ((text, None), (base, date if at else None)):
        if name in named:
            assert config is not None
            return _make_configured(name, named[name], config, day, text, data)
    if at and not _DATE.match(date):
        raise TargetError(f"`{text}`: `{date}` is no date: write it as in `{base}@2024-03-01`")
    if base not in {known.name for known in list_known_distros(data)}:
        raise TargetError(_describe_unknown(text, base, named, folder, data))
    return DistroTarget(base, date if at else None, name=text, data=data)


def _describe_unknown(text: str, base: str, named: Mapping[str, Any], folder: Path, data: Snapshot | None) -> str:
    distros = [known.name for known in list_known_distros(data)]
    hint = suggest_name(base, [*distros, *named], "; ") or "."
    own = f" Targets of rosimpact.toml: {', '.join(sorted(named))}." if named else ""
    if (folder / text).exists() and (folder == Path() or lies_in(folder / text, folder)):
        hint = f": a file is read as a target when its name ends in `.json` or `{_DPKG}`."
    return f"unknown target `{text}`{hint} Known distros: {', '.join(distros)}.{own}"


def _make_configured(
    name: str, table: Mapping[str, Any], config: Config, day: str | None, asked: str, data: Snapshot | None
) -> DistroTarget:
    """A [targets.NAME] table. Keys: distro or file, date, platform, versions."""
    where = f"{config.path or 'rosimpact.toml'}: [targets.{name}]"
    unknown = sorted(set(table) - {"distro", "file", "date", "platform", "versions"})
    if unknown:
        raise TargetError(f"{where} has no `{unknown[0]}`; known are distro, file, date, platform, versions")
    versions = table.get("versions", {})
    if not isinstance(versions, Mapping):
        raise TargetError(f'{where}: `versions` must be a table, such as {{ opencv = "4.9" }}')
    try:
        versions = {str(key): str(value) for key, value in versions.items()}
    except ValueError:  # an integer of thousands of digits
        raise TargetError(f'{where}: `versions` must be texts, such as {{ opencv = "4.9" }}') from None
    try:
        date = day or (str(table["date"]) if "date" in table else None)
        platform = str(table["platform"]) if "platform" in table else None
        file = str(table["file"]) if "file" in table else ""
    except ValueError:  # as above
        raise TargetError(f"{where}: `date`, `platform` and `file` must be texts") from None
    if "file" in table:
        folder = config.path.parent if config.path else Path()
        if config.path:
            check_inside(folder / file, config, f"{where} `file`")
        base = parse_target(file, None, folder, data)
        _check_table(where, platform, versions, data)
        return base.copy_with_changes(date=date, platform=platform, versions=versions, name=asked)
    distro = table.get("distro", "")
    if "@" in distro:
        distro, _, written = distro.partition("@")
        date = date or written
    _check_table(where, platform, versions, data)
    try:
        return DistroTarget(distro, date, platform, versions, asked, data)
    except TargetError as error:
        raise TargetError(f"{where}: {error}") from None


def _check_table(where: str, platform: str | None, versions: Mapping[str, str], data: Snapshot | None) -> None:
    """Raises TargetError for a platform, or a name in `versions`, that nobody knows."""
    data = data or snapshots.load_snapshot()
    known = data.list_values("package") | data.list_values("library")
    for name in versions:
        if name not in known and normalize_library_name(name) not in known:
            hint = suggest_name(name, sorted(known)) or "a ROS package or a platform library is meant"
            raise TargetError(f"{where}: `versions` has an unknown name `{escape(name)}`; {hint}")
    words = normalize_platform(platform or "").split()
    if not words:
        return
    systems = list_rosdep_systems(data) | OTHER_SYSTEMS
    releases = {name.split()[1] for name in CODENAMES.values()} | OTHER_RELEASES
    if words[0] not in systems:
        hint = suggest_name(words[0], sorted(systems | releases)) or f"known systems: {', '.join(sorted(systems))}"
    elif words[0] in ("ubuntu", "debian") and words[1:2] and words[1].isalpha() and words[1] not in releases:
        hint = suggest_name(words[1], sorted(releases)) or f"known releases: {', '.join(sorted(releases))}"
    else:
        return
    raise TargetError(f"{where}: unknown platform `{escape(str(platform))}`; {hint}")


def _load_captured(path: Path, text: str) -> DistroTarget:
    from .capture import load_capture

    if not os.path.exists(path):
        raise TargetError(f"{text}: there is no such file; write one with `rosimpact env capture -o {text}`")
    return load_capture(path)


# dpkg listings

_STAMP = re.compile(r"-\d+([a-z]+)\.(2\d{3})(\d\d)(\d\d)(?:\.\d+)?$", re.ASCII)


class DpkgRow(NamedTuple):
    """An installed Debian package."""

    name: str
    version: str


def parse_dpkg(text: str) -> list[DpkgRow]:
    """Installed packages of a `dpkg -l` listing (or `dpkg-query -W`, two columns); other lines are left out."""
    rows = []
    for line in text.splitlines():
        words = line.split()
        if len(words) >= 3 and len(words[0]) in (2, 3) and words[0][:2] in ("ii", "hi"):
            rows.append(DpkgRow(words[1].split(":")[0], words[2]))
        elif len(words) == 2 and re.match(r"[a-z0-9][a-z0-9.+-]*(:\w+)?$", words[0]) and words[1][:1].isdigit():
            rows.append(DpkgRow(words[0].split(":")[0], words[1]))
    return rows


def _load_dpkg(path: Path, text: str, data: Snapshot | None) -> DistroTarget:
    """A machine from a listing of its packages. Its day is that of its newest ROS package, told by the build stamp."""
    from .capture import read_dpkg_rows

    try:
        listing = files.read_text(path, get_limits().listing, errors="replace")
    except OSError as error:
        raise TargetError(f"{text}: cannot be read ({error.strerror}); write it with `dpkg -l > {text}`") from None
    rows = parse_dpkg(listing)
    if not rows:
        raise TargetError(f"{text}: lists no installed package; write it with `dpkg -l > {text}`")
    distro, packages, libraries, _ = read_dpkg_rows(rows)
    if not distro:
        raise TargetError(f"{text}: lists no package of a ROS distro (ros-<distro>-...)")
    stamps = [match for row in rows if row.name.startswith(f"ros-{distro}-") and (match := _STAMP.search(row.version))]
    date = max(filter(_is_day, ("-".join(match.groups()[1:]) for match in stamps)), default=None)
    codename = Counter(match[1] for match in stamps).most_common(1)
    platform = normalize_platform(codename[0][0]) if codename else None
    name = posixpath.basename(text).removesuffix(_DPKG)
    return DistroTarget(distro, date, platform, {**libraries, **packages}, name, data)


def _is_day(text: str) -> bool:
    try:
        datetime.date.fromisoformat(text)
    except ValueError:
        return False
    return True


_WORD = re.compile(r"[a-z0-9.]+")


def parse_image(image: str, distros: Sequence[KnownDistro]) -> tuple[str, str | None] | None:
    """(distro, platform or None) that a Docker image's name tells; None when it tells none.

    The official `ros` image without a tag, or with `latest`, is the newest long-term release.
    """
    name = image.partition("@")[0].lower()
    repository, colon, tag = name.rpartition(":")
    if not colon or "/" in tag:
        repository, tag = name, "latest"
    names = {known.name for known in distros}
    codenames = {platform.split()[1]: platform for platform in CODENAMES.values()}
    words = _WORD.findall(tag)
    distro = next((word for word in words if word in names), None)
    if distro is None:
        last = repository.rpartition("/")[2]
        distro = next((word for word in _WORD.findall(last) if word in names), None)
    if distro is None and tag == "latest" and repository in ("ros", "library/ros", "docker.io/library/ros"):
        distro = _find_newest_lts(distros, 2)
    if distro is None:
        return None
    # `jammy` and `22.04` both name Ubuntu's release; `12` alone names nothing.
    release = next((codenames[word] for word in words if word in codenames), None)
    release = release or next((CODENAMES[f"ubuntu {word}"] for word in words if f"ubuntu {word}" in CODENAMES), None)
    return distro, release


def _parse_docker(text: str, data: Snapshot | None) -> DistroTarget:
    distros = list_known_distros(data)
    image = text[len(_DOCKER) :]
    found = parse_image(image, distros)
    if found is None:
        names = ", ".join(known.name for known in distros)
        raise TargetError(
            f"`{text}`: the image's name tells no distro; write the distro itself, or a tag that names one of {names}"
        )
    return DistroTarget(found[0], None, found[1], None, text, data)


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


def choose_default_distros(
    ros: int,
    texts: Iterable[tuple[str, str, str]],
    branches: Iterable[tuple[str, str]],
    distros: Sequence[KnownDistro],
    environment: Mapping[str, str] = os.environ,
    today: str = "",
    installing: Iterable[tuple[str, str, str]] = (),
    above: Iterable[tuple[str, str, str]] = (),
) -> tuple[tuple[str, ...], str]:
    """Distros to check against when nobody said any, and the reason as a clause.

    ros: generation of the workspace, 1 or 2. texts: (repository, path, text) of CI files, Dockerfiles, pixi.toml, and
    files that list repositories (.repos, .rosinstall). branches: (repository, branch). today: ISO day that tells which
    distros have ended, the data's day. installing: as texts, of files that tell how to install things, which are read
    where nothing else names a distro. above: as texts, of the CI files of the repository that the workspace is a folder
    of, which are read where nothing in the workspace but what tells how to install things names a distro.

    The sourced environment comes first; then what the workspace's repositories name in their files, else in their
    branches and in those of the repositories that they list, else in what tells how to install things: those distros
    that most repositories name, at most four of them, and no ended one beside a living one; at last the newest long-
    term distro of the generation. A repository inside another, which is somebody else's there, counts where the outer
    one names none.
    """
    fitting = {known.name: known for known in distros if known.ros == ros}
    sourced = environment.get("ROS_DISTRO", "")
    if sourced in fitting:
        return (sourced,), "the sourced environment (ROS_DISTRO)"
    named: dict[str, dict[str, str]] = {}
    by_branch: dict[str, dict[str, str]] = {}
    for repository, path, text in texts:
        if _REPOSITORY_FILE.search(path):
            for distro in _list_distros(" ".join(_BRANCH.findall(text)), fitting):
                by_branch.setdefault(repository, {}).setdefault(distro, path)
            continue
        for distro in find_named_distros(text, fitting):
            named.setdefault(repository, {}).setdefault(distro, path)
    named = _drop_inner(named)

    def lives(distro: str) -> bool:
        return not fitting[distro].end_of_life or fitting[distro].end_of_life > today

    if not any(lives(distro) for found in named.values() for distro in found):
        # CI files of long ended distros are often left behind; a branch says what is meant now.
        for repository, branch in branches:
            own = {distro: f"branch {branch}" for distro in _list_distros(branch, fitting)}
            if own:  # says more than the branches of what it depends on
                by_branch[repository] = own
        by_branch = _drop_inner(by_branch)
        if not named or any(lives(distro) for found in by_branch.values() for distro in found):
            named = by_branch
    if not named:
        for repository, path, text in above:
            for distro in find_named_distros(text, fitting):
                named.setdefault(repository, {}).setdefault(distro, path)
    if not named:
        from ..facts.distros import list_installed_distros

        for repository, path, text in installing:
            for distro in list_installed_distros(text):
                if distro in fitting and lives(distro):
                    named.setdefault(repository, {}).setdefault(distro, path)
        named = _drop_inner(named)
    old: list[str] = []
    if named:
        old = sorted({distro for found in named.values() for distro in found})
        if not any(lives(distro) for found in named.values() for distro in found):
            # Files of long ended distros are often left behind; only long-term ones are still deployed.
            named = {
                repository: {distro: place for distro, place in found.items() if fitting[distro].lts}
                for repository, found in named.items()
            }
    if any(named.values()):
        counts = Counter(distro for found in named.values() for distro in found)
        most = max(counts.values())
        chosen = [distro for distro in fitting if counts[distro] == most]
        chosen = ([distro for distro in chosen if lives(distro)] or chosen)[-_AT_MOST:]
        places = list(dict.fromkeys(found[distro] for found in named.values() for distro in chosen if distro in found))
        where = places[0] + (f" and {len(places) - 1} more" if len(places) > 1 else "")
        return tuple(chosen), f"named by the workspace ({where})"
    if old:
        why = f"since {', '.join(old)} ended long ago"
        return (_find_newest_lts(distros, ros),), f"the newest long-term distro of ROS {ros}, {why}"
    return (_find_newest_lts(distros, ros),), f"the newest long-term distro of ROS {ros}, since nothing names another"


def _list_distros(text: str, distros: Container[str]) -> list[str]:
    return [word for word in re.findall(r"[a-z]+", text.lower()) if word in distros]


def _drop_inner(named: dict[str, dict[str, str]]) -> dict[str, dict[str, str]]:
    """What repositories name without those that lie inside another of them."""
    return {
        folder: found
        for folder, found in named.items()
        if not any(other != folder and (not other or folder.startswith(f"{other}/")) for other in named)
    }


def _find_newest_lts(distros: Sequence[KnownDistro], ros: int) -> str:
    return [known.name for known in distros if known.ros == ros and known.lts][-1]


def choose_targets(
    asked: Sequence[str], config: Config, ros: int, tree: Tree, data: Snapshot | None = None
) -> tuple[Chosen, ...]:
    """The targets of a run, each with the reason for it.

    asked: texts given after `--target`. config: rosimpact.toml. ros: the generation of the workspace, 1 or 2.
    tree: where CI files are read. Raises TargetError, and ConfigError for surroundings that cannot be read.
    """
    chosen = _choose_targets(asked, config, ros, tree, data)
    if not (config.underlays or config.rosdep_sources or config.index):
        return chosen
    from .distro.surroundings import load_surroundings

    return tuple(
        Chosen(target.add_surroundings(*load_surroundings(config, target.distro)), reason) for target, reason in chosen
    )


def _choose_targets(
    asked: Sequence[str], config: Config, ros: int, tree: Tree, data: Snapshot | None
) -> tuple[Chosen, ...]:
    if asked:
        return tuple(Chosen(parse_target(text, config, data=data), "asked for") for text in dict.fromkeys(asked))
    if config.default_targets:
        folder = config.path.parent if config.path else Path()
        reason = f"named in {config.path.name if config.path else 'rosimpact.toml'}"
        for text in config.default_targets:
            if config.path and text.strip().endswith((_DPKG, ".json")):
                check_inside(folder / text.strip(), config, f"{config.path}: [check] targets: {text}")
        return tuple(Chosen(parse_target(text, config, folder, data), reason) for text in config.default_targets)
    known = list_known_distros(data)
    day = (data or snapshots.load_snapshot()).date
    revision = getattr(tree, "revision", "")
    # What is checked out says nothing of another revision; the name of that one does, if it is a branch or a tag.
    current = not revision or revision.startswith(("HEAD", "@")) or getattr(tree, "is_checked_out", False)
    branches = _list_branches(tree) if current else [("", revision)]
    texts, installing = _iterate_texts(tree, _CI_FILE, _REPOSITORY_FILE), _iterate_texts(tree, _INSTALLING)
    above = _iterate_texts_above(tree)
    distros, reason = choose_default_distros(ros, texts, branches, known, today=day, installing=installing, above=above)
    return tuple(Chosen(DistroTarget(distro, data=data), reason) for distro in distros)


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
