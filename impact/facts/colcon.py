"""What colcon reads of a workspace besides manifests: its own settings, and names of packages without manifest.

Source: colcon-core 0.21, colcon-cmake 0.2.30, colcon-metadata 0.3.1, colcon-python-setup-py 0.2.9 and
colcon-defaults 0.2.9.
"""

import re
from typing import Any

import msgspec

from ...edges.documents import DocumentError, load_yaml
from .place import Problem

_COMMENT = re.compile(r"(?m)#.*$")
_PROJECT = re.compile(r'project\s*\(\s*("?)([a-zA-Z0-9_-]+)\1(?=[\s)])', re.I)
_SETUP_CALL = re.compile(r"\bsetup\s*\(")
_SETUP_NAME = re.compile(r"""(?:^|[\s,(])name\s*=\s*(?:["']([\w.-]+)["']|([A-Za-z_]\w*))""")
_CFG_NAME = re.compile(r"(?ms)^\[metadata\][^\[]*?^name\s*[=:]\s*([\w.-]+)")
_TOML_NAME = re.compile(r"""(?ms)^\[project\](?:(?!^\[).)*?^name\s*=\s*["']([\w.-]+)["']""")


class ColconFile(msgspec.Struct, frozen=True, array_like=True):
    """name: of the project, empty where none shows. is_top: the file that catkin puts above all packages. settings: of
    colcon.pkg, colcon.meta and defaults.yaml."""

    name: str = ""
    is_top: bool = False
    settings: dict[str, Any] = {}
    problems: tuple[Problem, ...] = ()


def extract(data: bytes, kind: str) -> ColconFile:
    """What a file tells colcon. kind: colcon_ and `cmake`, `setup_py`, `setup_cfg`, `pyproject` or `settings`. A
    problem of settings is a clause that says why they are no YAML."""
    text = data.decode("utf-8", "replace")
    if kind == "colcon_settings":
        return _parse_settings(text)
    if kind == "colcon_cmake":
        match = _PROJECT.search(_COMMENT.sub("", text))
        name = match[2] if match else ""
        return ColconFile(name, name == "Project" and "catkin_workspace()" in _COMMENT.sub("", text))
    if kind == "colcon_setup_py":
        return ColconFile(_find_name_in_setup(text))
    match = (_CFG_NAME if kind == "colcon_setup_cfg" else _TOML_NAME).search(text)
    return ColconFile(match[1] if match else "")


def _parse_settings(text: str) -> ColconFile:
    try:
        found = load_yaml(text)
        # As it is read back from the store: dates become text.
        found = msgspec.msgpack.decode(msgspec.msgpack.encode(found))
    except (DocumentError, OverflowError, TypeError, UnicodeEncodeError) as error:
        return ColconFile(problems=(Problem(1, f"is no YAML ({error})"),))
    # A name that is no text, as in `1: 2`, is no setting.
    pairs = found.items() if isinstance(found, dict) else ()
    return ColconFile(settings={name: value for name, value in pairs if isinstance(name, str)})


def _find_name_in_setup(text: str) -> str:
    call = _SETUP_CALL.search(text)
    match = _SETUP_NAME.search(text, call.end() - 1) if call else None
    if match is None or match[1]:
        return match[1] if match else ""
    value = re.search(rf"""(?m)^{match[2]}\s*=\s*["']([\w.-]+)["']""", text)
    return value[1] if value else ""
