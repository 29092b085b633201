"""What lies around a workspace besides the public distro: built underlays, a company's rosdep rules and index.

Everything is read from disk, nothing over the network: a clone of an index is named instead of its address. Underlays
and indexes may lie anywhere, since nothing but names and versions of packages is taken from them; rosdep rules, whose
texts are shown, lie in the workspace unless the user names the configuration.
"""

import os
import re
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

from ....edges import files
from ....edges.documents import DocumentError, load_yaml
from ....edges.limits import get_limits
from ...config import Config, ConfigError, check_inside, lies_in
from ..capture import read_name_and_version

_NAME = re.compile(r"[A-Za-z][\w-]{0,200}")
_VERSION = re.compile(r"[\w.+~:-]{1,100}")
_MANIFESTS_AT_MOST = 20_000
_FILES_AT_MOST = 50


class Surroundings(NamedTuple):
    """versions: package to version, of underlays and of the index for one distro. rules: rosdep key to its rules by
    operating system, as in a rosdep file."""

    versions: dict[str, str]
    rules: dict[str, Any]


_NOTHING = Surroundings({}, {})


def load_surroundings(config: Config, distro: str) -> Surroundings:
    """What `[workspace]` of a rosimpact.toml names, for targets of a distro. Raises ConfigError, naming the file."""
    if config.path is None or not (config.underlays or config.rosdep_sources or config.index):
        return _NOTHING
    folder = config.path.parent
    versions = _index(folder, config.index, distro, config.path) if config.index else {}
    for underlay in config.underlays:
        versions = {**versions, **_read_underlay(folder / _expand_path(underlay))}
    rules: dict[str, Any] = {}
    for source in config.rosdep_sources:
        path = folder / _expand_path(source)
        if "://" not in source:
            check_inside(path, config, f"{config.path}: [workspace] rosdep_sources: {source}")
        for key, rule in _load_rosdep(path, config.path).items():
            rules.setdefault(key, rule)  # as in rosdep, the first source that has a key counts
    return Surroundings(versions, rules)


def _expand_path(text: str) -> Path:
    """A path as written in the configuration, `~` resolved where that is known."""
    return Path(os.path.expanduser(text.replace("\0", "")))


@cache
def _read_underlay(prefix: Path) -> dict[str, str]:
    """Package to version of an installed prefix, merged or isolated; empty where this machine has no such folder."""
    found = {}
    for manifest in islice(_iterate_manifests(str(prefix)), _MANIFESTS_AT_MOST):
        name, version = read_name_and_version(Path(manifest))
        if name:
            found[name] = version
    return found


def _iterate_manifests(prefix: str) -> Iterator[str]:
    """share/*/package.xml of a prefix, then those of the folders in it."""
    for share in (f"{prefix}/share", *(f"{folder}/share" for folder in _list_folders(prefix))):
        yield from (f"{folder}/package.xml" for folder in _list_folders(share))


def _list_folders(folder: str) -> list[str]:
    try:
        with os.scandir(folder) as scan:
            return sorted(item.path for item in islice(scan, _MANIFESTS_AT_MOST) if item.is_dir())
    except (OSError, ValueError):
        return []


@cache
def _load_rosdep(path: Path, config: Path) -> dict[str, Any]:
    where = f"{config}: [workspace] rosdep_sources: {path}"
    if ":/" in path.as_posix():
        raise ConfigError(f"{where}: is not fetched; download it and give its path")
    try:
        rules = load_yaml(files.read_file(path, get_limits().settings))
    except OSError as error:
        raise ConfigError(f"{where}: cannot be read: {error.strerror}") from None
    except DocumentError as error:
        raise ConfigError(f"{where}: is no YAML: {error}") from None
    if not isinstance(rules, dict) or not all(isinstance(rule, Mapping) for rule in rules.values()):
        raise ConfigError(
            f"{where}: must map rosdep keys to rules by operating system, as in rosdistro's rosdep/*.yaml"
        )
    return {str(key): rule for key, rule in rules.items()}


@cache
def _index(folder: Path, index: str, distro: str, config: Path) -> dict[str, str]:
    """Package to version that an index's distribution files release for a distro; empty when it has no such distro."""
    where = f"{config}: [workspace] index: {index}"
    path = folder / _expand_path(index.removeprefix("file://"))
    if index.startswith(("http://", "https://")):
        raise ConfigError(f"{where}: is not fetched; clone the repository and give the path of its index-v4.yaml")
    if not path.is_file():
        raise ConfigError(f"{where}: there is no such file")
    known = _load_document(path, where).get("distributions")
    listed = known.get(distro) if isinstance(known, dict) else None
    named = listed.get("distribution") if isinstance(listed, dict) else None
    named = [named] if isinstance(named, str) else named
    if not isinstance(known, dict) or (listed is not None and not isinstance(named, list)):
        raise ConfigError(f"{where}: cannot be read: is no index-v4.yaml")
    found: dict[str, str] = {}
    for name in (named or [])[:_FILES_AT_MOST]:
        file = path.parent / str(name)
        if "://" in str(name):
            raise ConfigError(f"{where}: names a web address, which is not fetched; clone what it leads to")
        if not lies_in(file, path.parent):
            raise ConfigError(f"{where}: names a file outside of its folder, which is not read")
        found.update(_iterate_released(_load_document(file, where)))
    return found


def _load_document(path: Path, where: str) -> dict[str, Any]:
    """A YAML file that is a table. What is wrong with it is told without its text, which may be anybody's."""
    try:
        data = load_yaml(files.read_file(path, get_limits().settings))
    except OSError as error:
        raise ConfigError(f"{where}: cannot be read: {path.name}: {error.strerror}") from None
    except DocumentError as error:
        at = f" in line {error.line}" if error.line else ""
        raise ConfigError(f"{where}: cannot be read: {path.name} is no YAML{at}") from None
    if not isinstance(data, dict):
        raise ConfigError(f"{where}: cannot be read: {path.name} is no file of an index")
    return data


def _iterate_released(distribution: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """(package, version) of all that a distribution file releases (REP 143); anything else in it is left out."""
    repositories = distribution.get("repositories")
    for repository, entry in repositories.items() if isinstance(repositories, dict) else ():
        release = entry.get("release") if isinstance(entry, dict) else None
        version = release.get("version") if isinstance(release, dict) else None
        if not isinstance(release, dict) or not isinstance(version, str) or not _VERSION.fullmatch(version):
            continue
        packages = release.get("packages") or [repository]
        for package in packages if isinstance(packages, (list, dict)) else ():
            if isinstance(package, str) and _NAME.fullmatch(package):
                yield package, version.rpartition("-")[0]
