"""rosimpact.toml: targets by name, workspace surroundings, what is reported and how severe."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, NamedTuple

from ..edges import files
from ..edges.console import UserError
from ..edges.documents import DocumentError, load_toml
from ..edges.limits import get_limits
from .tree.paths import VERSION_CONTROL


class ConfigError(UserError, ValueError):
    """rosimpact.toml cannot be used; the message names the file and what to change."""


class PathSetting(NamedTuple):
    """Settings for the files that match a glob: rules or families left out or let in, severities changed."""

    pattern: str
    ignore: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    severity: dict[str, str] = {}  # noqa: RUF012  NamedTuple default, never changed


class SystemSetting(NamedTuple):
    """A system: the launch files that it is started with, each as `graph --launch` takes it, and arguments that are for
    all of them."""

    launch: tuple[str, ...]
    arguments: dict[str, str]


class Config(NamedTuple):
    """What a rosimpact.toml says. path is None when there is none. trusted: the user named the file, and so it may name
    files outside of the workspace whose content is shown. talks: targets whose nodes talk to each other. closed_topics:
    topics that nobody outside of the workspace subscribes to."""

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
    index: str = ""  # pyright: ignore[reportIncompatibleMethodOverride]
    private: tuple[str, ...] = ()
    installed: tuple[str, ...] = ()
    talks: tuple[str, ...] = ()
    systems: dict[str, SystemSetting] = {}  # noqa: RUF012
    closed_topics: tuple[str, ...] = ()
    trusted: bool = False


_TABLES = {"fields", "targets", "workspace", "check", "paths", "system", "systems"}
_FAIL_ON = ("error", "warning", "note", "never")


def load(folder: Path, file: Path | None = None, *, follow_links: bool = False) -> Config:
    """Reads rosimpact.toml of a workspace (or the given file). No file gives an empty Config.

    A workspace's own file has to lie in it, unless follow_links. Raises ConfigError for what cannot be read, syntax
    errors, unknown keys and values of the wrong type.
    """
    path = file or folder / "rosimpact.toml"
    trusted = file is not None or follow_links
    if not trusted and not lies_in(path, folder):
        raise ConfigError(
            f"{path}: is a link that leads out of the workspace, or into `.git`, and is not read; give the file with "
            "--config, or follow links with --follow-links"
        )
    try:
        data = files.read_file(path, get_limits().settings)
    except (FileNotFoundError, NotADirectoryError):
        if file is not None:
            raise ConfigError(f"{file}: there is no such file; give an existing configuration with --config") from None
        return Config()
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}; correct the file or remove it") from None
    return parse(data, path, trusted=trusted)


def lies_in(path: str | os.PathLike[str], folder: str | os.PathLike[str]) -> bool:
    """Whether a path really leads to something below a folder, outside of the version control's own folders."""
    real, top = os.path.realpath(path), os.path.realpath(folder)
    if real != top and not real.startswith(top.rstrip(os.sep) + os.sep):
        return False
    return VERSION_CONTROL.isdisjoint(real[len(top) :].split(os.sep))


def check_inside(path: Path, config: Config, where: str) -> None:
    """Raises ConfigError for a file named by a workspace's own configuration that lies elsewhere: what it holds is
    shown, and CI shows it to everybody. where: the setting."""
    if config.path is not None and not config.trusted and not lies_in(path, config.path.parent):
        raise ConfigError(
            f"{where}: lies outside of the workspace and is not read; move it there, or give the configuration with "
            "--config"
        )


def parse(data: bytes, path: Path, *, trusted: bool = False) -> Config:
    """What a rosimpact.toml says. data: its bytes. path: where it lies, for messages. Raises ConfigError."""
    try:
        tables = load_toml(data.decode("utf-8-sig"))
    except (DocumentError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read: {error}; correct the file or remove it") from None
    if _has_null(tables):
        raise ConfigError(f"{path}: contains a null byte, which no name or path can contain; remove it")
    for key in tables:
        if key not in _TABLES:
            raise ConfigError(
                f"{path}: unknown table `{key}`{_hint(key, _TABLES)}; known are {', '.join(sorted(_TABLES))}"
            )
    workspace, check = _read_table(path, tables, "workspace"), _read_table(path, tables, "check")
    targets, system = _read_table(path, tables, "targets"), _read_table(path, tables, "system")
    for name, target in targets.items():
        if not isinstance(target, dict) or not isinstance(target.get("distro", target.get("file")), str):
            raise ConfigError(f'{path}: [targets.{name}] needs a `distro` (such as "humble") or a `file`')
    _check_keys(path, "workspace", workspace, {"underlays", "repos", "rosdep_sources", "index", "private", "installed"})
    _check_keys(path, "check", check, {"targets", "select", "ignore", "severity", "fail_on"})
    _check_keys(path, "system", system, {"talks"})
    fields = _read_table(path, tables, "fields")
    _check_keys(path, "fields", fields, {"closed"})
    fail_on = _parse_string(path, check, "fail_on")
    if fail_on not in ("", *_FAIL_ON):
        raise ConfigError(
            f"{path}: [check] `fail_on` is `{fail_on}`; choose {', '.join(_FAIL_ON[:-1])} or {_FAIL_ON[-1]}"
        )
    return Config(
        path=path,
        targets=targets,
        default_targets=_read_list(path, check, "targets") or tuple(targets),
        select=_read_list(path, check, "select"),
        ignore=_read_list(path, check, "ignore"),
        severity=_read_severity(path, "check", check),
        fail_on=fail_on,
        paths=tuple(_read_entry(path, pattern, entry) for pattern, entry in _read_table(path, tables, "paths").items()),
        underlays=_read_list(path, workspace, "underlays"),
        repos=_read_list(path, workspace, "repos"),
        rosdep_sources=_read_list(path, workspace, "rosdep_sources"),
        index=_parse_string(path, workspace, "index"),
        private=_read_list(path, workspace, "private"),
        installed=_read_list(path, workspace, "installed"),
        talks=_read_list(path, system, "talks"),
        systems={name: _read_system(path, name, entry) for name, entry in _read_table(path, tables, "systems").items()},
        closed_topics=_read_list(path, fields, "closed"),
        trusted=trusted,
    )


def _read_entry(path: Path, pattern: str, entry: Any) -> PathSetting:
    name = f'paths."{pattern}"'
    if not isinstance(entry, dict):
        raise ConfigError(f'{path}: [{name}] must be a table, such as ignore = ["unused-dependency"]')
    _check_keys(path, name, entry, {"ignore", "select", "severity"})
    return PathSetting(
        pattern, _read_list(path, entry, "ignore"), _read_list(path, entry, "select"), _read_severity(path, name, entry)
    )


def _read_system(path: Path, name: str, entry: Any) -> SystemSetting:
    name = f"systems.{name}"
    if not isinstance(entry, dict) or not _read_list(path, entry, "launch"):
        raise ConfigError(f'{path}: [{name}] needs `launch`, a list of files, such as ["base/launch/a.launch.py"]')
    _check_keys(path, name, entry, {"launch", "arguments"})
    given = entry.get("arguments", {})
    if not isinstance(given, dict) or not all(isinstance(value, str | bool | int | float) for value in given.values()):
        raise ConfigError(f"{path}: [{name}] `arguments` must be a table of values, such as {{ sim = true }}")
    texts = {key: str(value).lower() if isinstance(value, bool) else str(value) for key, value in given.items()}
    return SystemSetting(_read_list(path, entry, "launch"), texts)


def _read_severity(path: Path, name: str, table: dict[str, Any]) -> dict[str, str]:
    value = table.get("severity", {})
    if not isinstance(value, dict) or not all(isinstance(each, str) for each in value.values()):
        raise ConfigError(f'{path}: [{name}] `severity` must be a table, such as {{ unused-dependency = "warning" }}')
    return value


def _has_null(value: Any) -> bool:
    if isinstance(value, dict):
        return any(_has_null(key) or _has_null(item) for key, item in value.items())
    return "\0" in value if isinstance(value, str) else isinstance(value, list) and any(map(_has_null, value))


def _read_table(path: Path, data: dict[str, Any], name: str) -> dict[str, Any]:
    value = data.get(name, {})
    if not isinstance(value, dict):
        raise ConfigError(f"{path}: `{name}` must be a table, such as [{name}]")
    return value


def _check_keys(path: Path, name: str, table: dict[str, Any], keys: set[str]) -> None:
    for key in table:
        if key not in keys:
            raise ConfigError(f"{path}: [{name}] has no `{key}`{_hint(key, keys)}; known are {', '.join(sorted(keys))}")


def _hint(key: str, keys: set[str]) -> str:
    from difflib import get_close_matches

    close = get_close_matches(key, sorted(keys), 1)
    return f", did you mean `{close[0]}`" if close else ""


def _parse_string(path: Path, table: dict[str, Any], key: str) -> str:
    value = table.get(key, "")
    if not isinstance(value, str):
        raise ConfigError(f"{path}: `{key}` must be a string")
    return value


def _read_list(path: Path, table: dict[str, Any], key: str) -> tuple[str, ...]:
    value = table.get(key, [])
    if isinstance(value, str):
        value = [value]
    if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
        raise ConfigError(f"{path}: `{key}` must be a list of strings")
    return tuple(value)
