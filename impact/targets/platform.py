"""Platforms: their names, spelled one way, and the Python they bring."""

import re
from collections.abc import Collection

from .version import number_of

CODENAMES: dict[str, str] = {
    "ubuntu 12.04": "ubuntu precise",
    "ubuntu 14.04": "ubuntu trusty",
    "ubuntu 16.04": "ubuntu xenial",
    "ubuntu 18.04": "ubuntu bionic",
    "ubuntu 20.04": "ubuntu focal",
    "ubuntu 22.04": "ubuntu jammy",
    "ubuntu 24.04": "ubuntu noble",
    "ubuntu 26.04": "ubuntu resolute",
    "debian 8": "debian jessie",
    "debian 9": "debian stretch",
    "debian 10": "debian buster",
    "debian 11": "debian bullseye",
    "debian 12": "debian bookworm",
    "debian 13": "debian trixie",
}
"""Release number → codename. Sources: releases.ubuntu.com, debian.org/releases."""

_KNOWN = {name.split()[1]: name for name in CODENAMES.values()}


_FROZEN = (
    *("ubuntu xenial", "debian stretch", "ubuntu bionic", "debian buster", "ubuntu focal", "debian bullseye"),
    *("ubuntu jammy", "debian bookworm", "ubuntu noble", "debian trixie", "ubuntu resolute"),
    *("debian forky", "debian sid"),
)
"""Platforms in the order in which their packages were frozen. Sources: releases.ubuntu.com, debian.org/releases."""


def neighbours(platform: str, known: Collection[str]) -> tuple[str, str]:
    """The platforms among those known that were frozen last before one and first after it, itself for one of them;
    empty where there is none. Ubuntu takes what Debian has at the time, so that what both have and lack it does too."""
    if platform not in _FROZEN:
        return "", ""
    place = _FROZEN.index(platform)
    before = [one for one in _FROZEN[: place + 1] if one in known]
    after = [one for one in _FROZEN[place:] if one in known]
    return before[-1] if before else "", after[0] if after else ""


def normal_platform(text: str) -> str:
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


def python_minor(version: str | None) -> int | None:
    """`3.10.4` → 10, None when it cannot be read."""
    match = re.match(r"\d+\.(\d+)", version or "")
    return number_of(match.group(1)) if match else None


LIBRARY_ALIASES: dict[str, str] = {
    "python3": "python",
    "eigen": "eigen3",
    "opencv4": "opencv",
    "g++": "gcc",
    "qt5": "qt",
    "yamlcpp": "yaml-cpp",
    "yaml_cpp": "yaml-cpp",
    "libboost": "boost",
}
"""Other names under which people ask for a platform library."""


def library_name(name: str) -> str:
    """The name a platform library has in platform_versions.yaml."""
    lowered = name.lower()
    return LIBRARY_ALIASES.get(lowered, lowered)
