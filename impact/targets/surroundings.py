"""What lies around a workspace besides the public distro: built underlays, a company's rosdep rules and index.

Everything is read from disk. An index that is only known by its web address is not fetched: a clone of it is named
instead.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from ..config import Config, ConfigError
from .capture import name_and_version


class Surroundings(NamedTuple):
    """versions: package to version, of underlays and of the index for one distro. rules: rosdep key to its rules by
    operating system, as in a rosdep file."""

    versions: dict[str, str]
    rules: dict[str, Any]


_NOTHING = Surroundings({}, {})


def surroundings(config: Config, distro: str) -> Surroundings:
    """What `[workspace]` of a rosimpact.toml names, for targets of a distro. Raises ConfigError, naming the file."""
    if config.path is None or not (config.underlays or config.rosdep_sources or config.index):
        return _NOTHING
    folder = config.path.parent
    versions = _index(folder, config.index, distro, config.path) if config.index else {}
    for underlay in config.underlays:
        versions = {**versions, **_underlay(folder / Path(underlay).expanduser())}
    rules: dict[str, Any] = {}
    for source in config.rosdep_sources:
        for key, rule in _rosdep(folder / Path(source).expanduser(), config.path).items():
            rules.setdefault(key, rule)  # as in rosdep, the first source that has a key counts
    return Surroundings(versions, rules)


@cache
def _underlay(prefix: Path) -> dict[str, str]:
    """Package to version of an installed prefix, merged or isolated; empty where this machine has no such folder."""
    found = {}
    for pattern in ("share/*/package.xml", "*/share/*/package.xml"):
        for manifest in sorted(prefix.glob(pattern)):
            name, version = name_and_version(manifest)
            if name:
                found[name] = version
    return found


@cache
def _rosdep(path: Path, config: Path) -> dict[str, Any]:
    where = f"{config}: [workspace] rosdep_sources: {path}"
    if ":/" in path.as_posix():
        raise ConfigError(f"{where}: is not fetched; download it and give its path")
    try:
        rules = yaml.load(path.read_bytes(), getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except OSError as error:
        raise ConfigError(f"{where}: cannot be read: {error.strerror}") from None
    except (yaml.YAMLError, RecursionError) as error:
        raise ConfigError(f"{where}: is no YAML: {' '.join(str(error).split())}") from None
    if not isinstance(rules, dict) or not all(isinstance(rule, Mapping) for rule in rules.values()):
        raise ConfigError(
            f"{where}: must map rosdep keys to rules by operating system, as in rosdistro's rosdep/*.yaml"
        )
    return {str(key): rule for key, rule in rules.items()}


@cache
def _index(folder: Path, index: str, distro: str, config: Path) -> dict[str, str]:
    """Package to version that an index's distribution files release for a distro; empty when it has no such distro."""
    where = f"{config}: [workspace] index: {index}"
    path = folder / Path(index.removeprefix("file://")).expanduser()
    if index.startswith(("http://", "https://")):
        raise ConfigError(f"{where}: is not fetched; clone the repository and give the path of its index-v4.yaml")
    if not path.is_file():
        raise ConfigError(f"{where}: there is no such file")
    import rosdistro

    try:
        known = rosdistro.get_index(path.resolve().as_uri())
        if distro not in known.distributions:
            return {}
        files = rosdistro.get_distribution_files(known, distro)
    except Exception as error:  # rosdistro raises whatever its parsers meet
        raise ConfigError(f"{where}: cannot be read: {error}") from None
    found = {}
    for file in files:
        for repository in file.repositories.values():
            release = repository.release_repository
            if release is not None and release.version:
                found.update({name: release.version.rpartition("-")[0] for name in release.package_names})
    return found
