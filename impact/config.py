"""rosimpact.toml: targets by name, workspace surroundings, what is reported and how severe."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


class ConfigError(ValueError):
    """rosimpact.toml cannot be used; the message names the file and what to change."""


class PathSetting(NamedTuple):
    """Settings for the files that match a glob: rules or families left out or let in, severities changed."""

    pattern: str
    ignore: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    severity: dict[str, str] = {}  # noqa: RUF012  NamedTuple default, never changed


class Config(NamedTuple):
    """What a rosimpact.toml says. path is None when there is none."""

    path: Path | None = None
    targets: dict[str, dict[str, Any]] = {}  # noqa: RUF012
    default_targets: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    severity: dict[str, str] = {}  # noqa: RUF012
    fail_on: str = ""
    paths: tuple[PathSetting, ...] = ()
    underlays: tuple[str, ...] = ()
    repos: tuple[str, ...] = ()
    rosdep_sources: tuple[str, ...] = ()
    index: str = ""
    private: tuple[str, ...] = ()


_TABLES = {"targets", "workspace", "check", "paths"}


def load(folder: Path, file: Path | None = None) -> Config:
    """Reads rosimpact.toml of a workspace (or the given file). No file gives an empty Config.

    Raises ConfigError for syntax errors, unknown keys and values of the wrong type.
    """
    path = file or folder / "rosimpact.toml"
    if not path.is_file():
        if file is not None:
            raise ConfigError(f"{file}: there is no such file; give an existing configuration with --config")
        return Config()
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, OSError) as error:
        raise ConfigError(f"{path}: cannot be read: {error}; correct the file or remove it") from error
    for key in data:
        if key not in _TABLES:
            raise ConfigError(f"{path}: unknown table `{key}`; known are {', '.join(sorted(_TABLES))}")
    workspace, check = _table(path, data, "workspace"), _table(path, data, "check")
    targets = _table(path, data, "targets")
    for name, target in targets.items():
        if not isinstance(target, dict) or not isinstance(target.get("distro", target.get("file")), str):
            raise ConfigError(f"{path}: [targets.{name}] needs a `distro` (such as \"humble\") or a `file`")
    _known(path, "workspace", workspace, {"underlays", "repos", "rosdep_sources", "index", "private"})
    _known(path, "check", check, {"targets", "select", "ignore", "severity", "fail_on"})
    paths = tuple(
        PathSetting(pattern, _strings(path, setting, "ignore"), _strings(path, setting, "select"), dict(setting.get("severity", {})))
        for pattern, setting in _table(path, data, "paths").items()
    )
    return Config(
        path, targets, _strings(path, check, "targets") or tuple(targets), _strings(path, check, "select"),
        _strings(path, check, "ignore"), dict(check.get("severity", {})), str(check.get("fail_on", "")), paths,
        _strings(path, workspace, "underlays"), _strings(path, workspace, "repos"),
        _strings(path, workspace, "rosdep_sources"), str(workspace.get("index", "")), _strings(path, workspace, "private"),
    )  # fmt: skip


def _table(path: Path, data: dict[str, Any], name: str) -> dict[str, Any]:
    value = data.get(name, {})
    if not isinstance(value, dict):
        raise ConfigError(f"{path}: `{name}` must be a table, such as [{name}]")
    return value


def _known(path: Path, name: str, table: dict[str, Any], keys: set[str]) -> None:
    for key in table:
        if key not in keys:
            raise ConfigError(f"{path}: [{name}] has no `{key}`; known are {', '.join(sorted(keys))}")


def _strings(path: Path, table: dict[str, Any], key: str) -> tuple[str, ...]:
    value = table.get(key, [])
    if isinstance(value, str):
        value = [value]
    if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
        raise ConfigError(f"{path}: `{key}` must be a list of strings")
    return tuple(value)
