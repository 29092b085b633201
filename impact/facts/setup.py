"""setup.py, setup.cfg and pyproject.toml to facts: what an ament_python or catkin package installs."""

from __future__ import annotations

import msgspec

from .place import Problem
from .python import PythonFile


class SetupFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Installed things, read from literals (setup.py is parsed, never run).

    entry_points: (name, module, line) of console_scripts. data_files: (destination, pattern, line), where glob(...) and
    os.path.join(...) of literals become a pattern such as `launch/*.launch.py`. scripts, packages: as written, `*` when
    find_packages. requires: install_requires names. unresolved: what was not a literal, in one clause each.
    python: of a setup.py, its imports and syntax like those of any Python file (filled by kinds.extract).
    """

    packages: tuple[str, ...] = ()
    package_dirs: dict[str, str] = {}
    entry_points: tuple[tuple[str, str, int], ...] = ()
    data_files: tuple[tuple[str, str, int], ...] = ()
    scripts: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    unresolved: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()
    python: PythonFile | None = None
