"""The versions of libraries that conda-forge and RoboStack build against, and that Debian unstable has, by day:
data/conda.json.zst, see DATA.md."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from ..tables import find_table
from ..unpacked import read_table

CHANNELS = frozenset(("conda-forge", "robostack"))
"""Channels that this knows: conda-forge, and RoboStack, which holds a distro's packages to versions of its own."""
SID = "debian sid"
"""The platform beside them whose versions are known by day."""

_Rows = dict[str, dict[str, str]]


@cache
def _load_table() -> dict[str, _Rows]:
    return read_table(find_table("conda.json.zst"), dict[str, _Rows])


def find_libraries(platform: str, distro: str, day: str) -> dict[str, tuple[str, str]]:
    """The version of each library on a day, with the channel that states it; empty for other platforms. Raises
    SnapshotError."""
    if platform not in CHANNELS and platform != SID:
        return {}
    found: dict[str, tuple[str, str]] = {}
    for channel in ("conda-forge", distro) if platform == "robostack" else (platform,):
        for name, rows in _load_table().get(channel, {}).items():
            version = _find_last_version(rows, day)
            if version:
                found[name] = version, channel
    return found


def _find_last_version(rows: Mapping[str, str], day: str) -> str:
    """The version that stands on a day, of versions by the first day of each, oldest first."""
    return next((version for since, version in reversed([*rows.items()]) if since <= day), "")
