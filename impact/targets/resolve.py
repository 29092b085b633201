"""From what a person writes after `--target`, or writes nowhere, to targets."""

from __future__ import annotations

import datetime
import os
import posixpath
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...edges import files
from ...edges.console import escape
from ...edges.limits import get_limits
from ..config import Config, check_inside, lies_in
from ..tree import Tree
from . import snapshot as snapshots
from .default_distros import StatedVersion, find_default_distros
from .distro.distro import DistroTarget, TargetError
from .distro.known import KnownDistro, list_known_distros, list_rosdep_systems, suggest_name
from .platform import CODENAMES, OTHER_RELEASES, OTHER_SYSTEMS, normalize_library_name, normalize_platform
from .snapshot import Snapshot

__all__ = ["Chosen", "TargetError", "choose_targets", "parse_target"]

_DPKG = ".dpkg.txt"
_DOCKER = "docker:"
_DATE = re.compile(r"\d{4}-\d\d?-\d\d?$")


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
        distro = [known.name for known in distros if known.ros == 2 and known.lts][-1]
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


def choose_targets(
    asked: Sequence[str],
    config: Config,
    ros: int,
    tree: Tree,
    data: Snapshot | None = None,
    packages: Sequence[StatedVersion] = (),
) -> tuple[Chosen, ...]:
    """The targets of a run, each with the reason for it.

    asked: texts given after `--target`. config: rosimpact.toml. ros: the generation of the workspace, 1 or 2.
    tree: where CI files are read. packages: those of the workspace. Raises TargetError, and ConfigError for
    surroundings that cannot be read.
    """
    chosen = _choose_targets(asked, config, ros, tree, data, packages)
    if not (config.underlays or config.rosdep_sources or config.index):
        return chosen
    from .distro.surroundings import load_surroundings

    return tuple(
        Chosen(target.add_surroundings(*load_surroundings(config, target.distro)), reason) for target, reason in chosen
    )


def _choose_targets(
    asked: Sequence[str],
    config: Config,
    ros: int,
    tree: Tree,
    data: Snapshot | None,
    packages: Sequence[StatedVersion],
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
    distros, reason = find_default_distros(ros, tree, packages, data)
    return tuple(Chosen(DistroTarget(distro, data=data), reason) for distro in distros)


