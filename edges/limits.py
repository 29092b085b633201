"""Every limit in one place: generous for real workspaces, small enough that no input can stop a run.

A limit that is exceeded costs one file, which is named in the coverage; the rest is analysed. Only the person who runs
rosimpact changes limits, through the environment variable ROSIMPACT_LIMITS: `cpp=32MB,seconds=60`. A workspace cannot.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache

VARIABLE = "ROSIMPACT_LIMITS"
KB, MB, GB = 1 << 10, 1 << 20, 1 << 30


class LimitError(ValueError):
    """ROSIMPACT_LIMITS cannot be read; the text says how to write it."""


@dataclass(frozen=True)
class Limits:
    """Bytes of one file, by what it is; then other limits, in the unit that each says.

    Sizes: manifest (package.xml), cmake, interface (msg, srv, action, idl), cpp, python, launch (launch, xacro, urdf,
    other XML), parameters (YAML), script, settings (rosimpact.toml, colcon.meta, colcon.pkg, defaults.yaml, setup.cfg,
    .gitmodules, .repos), text (whatever a pattern is looked for in), baseline, capture, listing (dpkg -l), library
    (ELF files), deb (a Debian package as downloaded, and unpacked), index (of git), object (a git object), report (bug
    reports, models), row (of the cache).
    """

    manifest: int = 1 * MB
    cmake: int = 4 * MB
    interface: int = 1 * MB
    cpp: int = 8 * MB
    python: int = 8 * MB
    launch: int = 8 * MB
    parameters: int = 8 * MB
    script: int = 8 * MB
    settings: int = 1 * MB
    text: int = 8 * MB
    baseline: int = 256 * MB
    capture: int = 64 * MB
    listing: int = 64 * MB
    library: int = 512 * MB
    deb: int = 512 * MB
    index: int = 256 * MB
    object: int = 16 * MB
    report: int = 512 * MB
    row: int = 512 * MB
    bag: int = 2 * GB  # of memory that reading a recording may need beyond what the process has
    entries: int = 2_000_000  # files and folders of one tree
    depth: int = 200  # folders, or nested nodes of a document
    nodes: int = 200_000  # of one YAML document, aliases expanded
    items: int = 20_000  # of one sort that one file lists: includes, imports, dependencies, commands
    seconds: int = 3  # of processor time that the extraction of one file may take, and as many more for each MB
    memory: int = 768 * MB  # that extraction may need beyond what the process has


# What decides whether something is read at all, and not what is found in it.
_OF_THE_RUN = frozenset(("baseline", "bag", "capture", "listing", "index", "row", "entries", "seconds", "memory"))

_UNITS = {"": 1, "k": KB, "kb": KB, "m": MB, "mb": MB, "g": GB, "gb": GB}


def parse(text: str) -> Limits:
    """Limits from `name=value` pairs separated by commas; sizes in bytes, or with KB, MB or GB. Raises LimitError."""
    known = [field.name for field in fields(Limits)]
    changed: dict[str, int] = {}
    for pair in filter(None, (part.strip() for part in text.split(","))):
        name, _, value = (part.strip() for part in pair.partition("="))
        match = re.fullmatch(r"([0-9]{1,12})\s*([kmg]?b?)", value.lower())
        if name not in known or match is None or match[2] not in _UNITS or not int(match[1]):
            names = ", ".join(known)
            raise LimitError(f"{VARIABLE}: `{pair}` is not a limit; write for example cpp=32MB; known are {names}")
        changed[name] = int(match[1]) * _UNITS[match[2]]
    return Limits(**changed)


@cache
def get_limits() -> Limits:
    """The limits of this run. Raises LimitError."""
    return read_limits(os.environ)


def read_limits(environment: Mapping[str, str]) -> Limits:
    """The limits that an environment asks for. Raises LimitError."""
    return parse(environment.get(VARIABLE, ""))


@cache
def format_limits() -> str:
    """What the user's limits add to the key of anything that is remembered; empty with the usual ones."""
    usual, asked = Limits(), get_limits()
    changed = ((field.name, getattr(asked, field.name)) for field in fields(Limits) if field.name not in _OF_THE_RUN)
    return "".join(f" {name}={value}" for name, value in changed if value != getattr(usual, name))


def format_size(size: int) -> str:
    """`8 MB`, `1.5 MB`, `900 bytes`."""
    for unit, name in ((GB, "GB"), (MB, "MB"), (KB, "KB")):
        if size >= unit:
            return f"{size / unit:.1f}".removesuffix(".0") + f" {name}"
    return f"{size} bytes"
