"""Which release of a ROS package has which header, module and CMake file, read from git trees."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class RosFacts(NamedTuple):
    """headers: (path, package) to spans. packages: package to the spans read. modules, cmake: name to packages."""

    headers: dict[tuple[str, str], str]
    packages: dict[str, str]
    modules: dict[str, str]
    cmake: dict[str, str]


def read_repositories(folder: Path) -> RosFacts:
    """Facts of all repositories in a folder."""
    return RosFacts({}, {}, {}, {})
