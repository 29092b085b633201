"""What a target answers with: providers, resolved keys and dependencies."""

from __future__ import annotations

from typing import NamedTuple


class Provider(NamedTuple):
    """Who offers a header, CMake package, Python module or executable.

    kind: `ros` (a released package; `name` is the package) or `system` (`name` is a rosdep key, `package` the Debian
    one).
    sure: False when it was told by convention (first path part) rather than by a file list.
    """

    kind: str
    name: str
    package: str = ""
    sure: bool = True


class Resolution(NamedTuple):
    """A rosdep key on a platform: the manager (apt, pip, ...) and what it installs (empty tuple: nothing needed)."""

    manager: str
    packages: tuple[str, ...]


class ReleasedDependency(NamedTuple):
    """One dependency of a released package, as its package.xml of that day has it (conditions already evaluated)."""

    name: str
    kind: str
    bounds: tuple[tuple[str, str], ...]
