"""Platforms: their names, spelled one way, and the Python they bring. The facts are in `data/platforms.json`."""

import re
from collections.abc import Collection
from functools import lru_cache

import msgspec

from .tables import find_table
from .unpacked import read_table
from .version import parse_number


class _Platforms(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the file holds. codenames: release number → codename. frozen: platforms in the order in which their packages
    were frozen. other_systems: that ROS runs on and rosdep has no rules for. other_releases: of Debian by role, and of
    Ubuntu between the long-term ones. library_aliases: other names under which people ask for a platform library.
    python_libraries: platform libraries that PyPI has under the same name and in the same versions, each with the
    Debian package that has it."""

    source: str
    codenames: dict[str, str]
    frozen: tuple[str, ...]
    other_systems: str
    other_releases: str
    library_aliases: dict[str, str]
    python_libraries: dict[str, str]


_SHIPPED = read_table(find_table("platforms.json"), _Platforms)
CODENAMES, _FROZEN = _SHIPPED.codenames, _SHIPPED.frozen
OTHER_SYSTEMS, OTHER_RELEASES = frozenset(_SHIPPED.other_systems.split()), frozenset(_SHIPPED.other_releases.split())
PYTHON_LIBRARIES = _SHIPPED.python_libraries
_KNOWN = {name.split()[1]: name for name in CODENAMES.values()}


def find_neighbours(platform: str, known: Collection[str]) -> tuple[str, str]:
    """The platforms among those known that were frozen last before one and first after it, itself for one of them;
    empty where there is none. Ubuntu takes what Debian has at the time, so that what both have and lack it does too."""
    if platform not in _FROZEN:
        return "", ""
    place = _FROZEN.index(platform)
    before = [one for one in _FROZEN[: place + 1] if one in known]
    after = [one for one in _FROZEN[place:] if one in known]
    return before[-1] if before else "", after[0] if after else ""


def normalize_platform(text: str) -> str:
    """One spelling for a platform: `Ubuntu 22.04`, `jammy`, `ubuntu-jammy`, `ubuntu:jammy` → `ubuntu jammy`.

    Unknown names are only lowered and spaced.
    """
    words = re.sub(r"[\s:_/-]+", " ", text.strip().lower()).strip()
    if words in _KNOWN:
        return _KNOWN[words]
    if words in ("conda", "conda forge"):
        return "conda-forge"
    os_name, _, release = words.partition(" ")
    match = re.match(r"\d+(\.\d+)?", release)
    if match:
        number = match.group() if os_name == "ubuntu" else match.group().split(".")[0]
        return CODENAMES.get(f"{os_name} {number}", f"{os_name} {number}")
    return words


def parse_python_minor(version: str | None) -> int | None:
    """`3.10.4` → 10, None when it cannot be read."""
    match = re.match(r"\d+\.(\d+)", version or "")
    return parse_number(match.group(1)) if match else None


def normalize_library_name(name: str) -> str:
    """The name a platform library has in platform_versions.yaml."""
    lowered = name.lower()
    return _SHIPPED.library_aliases.get(lowered, lowered)


def strip_separators(name: str) -> str:
    """The letters and digits of a library's name, in lower case: what spellings of it have in common."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


@lru_cache(maxsize=10000)
def strip_to_letters(name: str) -> str:
    """The letters of a library's name, without what its package, key and variables differ in."""
    return re.sub(r"[^a-z]|^lib|dev$", "", name.lower())
