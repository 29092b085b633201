"""What a version of a package offers to Python: names that can be imported, with re-exports followed, and what changed.

Modules that are built rather than written (extensions, generated messages) are known to be there and no more: a name in
them is neither there nor missing.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from ...impact.facts.kinds import find_kind as kind_by_name
from ...impact.facts.python.surface import ModuleSurface
from ...impact.facts.setup import SetupFile
from ...impact.targets.surface.surface import InstalledModule, PythonSurface
from ..extract import python

if TYPE_CHECKING:
    from ...impact.model.cmake.build import Install
    from ...impact.model.workspace import Package


class InstalledModules(NamedTuple):
    """Which modules a package installs: path relative to the workspace by dotted name; the rest as in PythonSurface."""

    modules: dict[str, str]
    unknown: tuple[str, ...]
    unresolved: tuple[str, ...]


def find_kind(path: str) -> str | None:
    """The kind of facts that a Python surface wants of a path, besides those of the build: None for none."""
    return python.__name__ if path.endswith(".py") and kind_by_name(path) == "python" else None


def build_surface(package: Package, facts: Callable[[str], ModuleSurface | None]) -> PythonSurface:
    """The Python surface of a package. facts: of a path relative to the workspace, None for a file that could not be
    read."""
    found = find_installed_modules(package)
    start = len(package.path) + 1 if package.path else 0
    modules, unknown = [], list(found.unknown)
    for name, path in sorted(found.modules.items()):
        surface = facts(path)
        if surface is None:
            unknown.append(name)
        else:
            modules.append(InstalledModule(name, path[start:], path.endswith("/__init__.py"), surface))
    return PythonSurface(package.name, tuple(modules), tuple(dict.fromkeys(unknown)), found.unresolved)


# -- which modules are installed ---------------------------------------------------------------------------------------

# Where CMake puts Python: ament_cmake_python's variable, catkin's folders as the interpreter of CMake writes them.
_SITE = re.compile(r"(?:^|/)(?:site|dist)-packages(?:/(?P<inside>.*))?$|^\$\{PYTHON_INSTALL_DIR\}(?:/(?P<ament>.*))?$")
_TESTS = frozenset(("test", "tests"))


def find_installed_modules(package: Package) -> InstalledModules:
    """Which modules a package installs, by its setup.py, install_python_package() and install() rules."""
    finder = _Installed(package)
    finder.run()
    modules = {name: path for name, path in finder.modules.items() if all(p.isidentifier() for p in name.split("."))}
    return InstalledModules(modules, tuple(dict.fromkeys(finder.unknown)), tuple(dict.fromkeys(finder.unresolved)))


class _Installed:
    def __init__(self, package: Package):
        self.package = package
        self.files = [path for path in package.linked.files if path.endswith((".py", ".pyx", ".so"))]
        self.all = frozenset(self.files)
        self.modules: dict[str, str] = {}
        self.unknown: list[str] = []
        self.unresolved: list[str] = []

    def run(self) -> None:
        package = self.package
        setups = {path: file for path, file in package.linked.setup}
        wanted = package.build_type == "ament_python"
        for install in package.build.installs:
            if install.kind == "python" and any(item.endswith("setup.py") for item in install.items):
                wanted = True
            elif install.kind == "python":
                for item in install.items:
                    self.add_folder(item.rstrip("/"), install.destination)
            else:
                self.add_installed(install)
        if wanted:
            for name in ("setup.py", "setup.cfg", "pyproject.toml"):
                file = setups.get(self.resolve_path(name))
                if file is not None:
                    self.add_from_setup(file)
        self.add_generated()

    def resolve_path(self, inside: str) -> str:
        """A path of the package, relative to the workspace."""
        return posixpath.normpath(posixpath.join(self.package.path, inside))

    def add(self, name: str, path: str) -> None:
        if path.endswith("/__init__.py"):
            name = name.rpartition(".")[0]
        if not path.endswith(".py"):
            self.unknown.append(name.partition("-")[0])
        elif name:
            self.modules.setdefault(name, path)

    def add_folder(self, folder: str, name: str) -> None:
        """A folder that is copied as it is, under a dotted name (empty: into the place where modules lie)."""
        if folder.endswith(".py"):
            stem = posixpath.basename(folder)[:-3]
            self.add(f"{name}.{stem}" if name else stem, folder)
            return
        if "$" in folder:
            self.unresolved.append(f"`{folder}` is installed for Python")
            return
        base = f"{folder}/" if folder and folder != "." else ""
        for path in self.files:
            if path.startswith(base):
                parts = [*name.split("."), *path[len(base) :].partition(".")[0].split("/")]
                self.add(".".join(part for part in parts if part), path)

    def add_from_setup(self, setup: SetupFile) -> None:
        """What setup.py, setup.cfg or pyproject.toml name."""
        self.unresolved += [clause for clause in setup.unresolved if clause.startswith(("packages", "py_modules"))]
        base = self.resolve_path(setup.package_dirs.get("", ""))
        base = "" if base == "." else base
        for name in setup.packages:
            if name == "*":
                self.add_every_package(base)
                continue
            folder = self.find_package_folder(name, setup)
            single = f"{folder}.py"
            inside = [path for path in self.files if posixpath.dirname(path) == folder]
            for path in inside:
                self.add(f"{name}.{posixpath.basename(path).partition('.')[0]}".replace("/", "."), path)
            if not inside and single in self.all:
                self.add(name, single)

    def find_package_folder(self, name: str, setup: SetupFile) -> str:
        """The folder of a package that setup.py lists, by package_dir as distutils reads it."""
        parts = name.replace("/", ".").split(".")
        for length in range(len(parts), 0, -1):
            given = setup.package_dirs.get(".".join(parts[:length]))
            if given is not None:
                return self.resolve_path("/".join([given.rstrip("/"), *parts[length:]]))
        return self.resolve_path("/".join([setup.package_dirs.get("", "").rstrip("/") or ".", *parts]))

    def add_every_package(self, base: str) -> None:
        """find_packages(): every folder with an `__init__.py` whose parents have one too; folders of tests are mostly
        excluded there."""
        prefix = f"{base}/" if base else ""
        for path in self.files:
            if not path.startswith(prefix):
                continue
            folder = posixpath.dirname(path)
            inside = folder[len(prefix) :] if folder != base else ""
            if not inside:
                continue
            parts = inside.split("/")
            heads = ["/".join(parts[: number + 1]) for number in range(len(parts))]
            if parts[0] not in _TESTS and all(f"{prefix}{head}/__init__.py" in self.all for head in heads):
                self.add(".".join([*parts, posixpath.basename(path).partition(".")[0]]), path)

    def add_installed(self, install: Install) -> None:
        """An install() rule that puts something where Python looks for modules."""
        place = _SITE.search(install.destination.rstrip("/"))
        if place is None:
            if "PYTHON" in install.destination.upper():
                self.unresolved.append(f"`{install.destination}` may be where Python looks")
            return
        name = (place["inside"] or place["ament"] or "").strip("/").replace("/", ".")
        if install.kind == "targets":
            outputs = {target.name: target.output_name or target.name for target in self.package.build.targets}
            for item in install.items:
                stem = outputs.get(item, item)
                self.unknown.append(f"{name}.{stem}" if name else stem)
            return
        for item in install.items:
            if install.kind != "directory" or item.endswith(("/", ".py")):
                self.add_folder(item.rstrip("/"), name)
            else:
                stem = posixpath.basename(item)
                self.add_folder(item, f"{name}.{stem}" if name else stem)

    def add_generated(self) -> None:
        """Modules made while building, and extensions."""
        package = self.package
        for made in package.build.generated:
            if not made.offered:
                continue
            if made.how in ("rosidl", "catkin"):
                kinds = {posixpath.splitext(path)[1].lstrip(".") for path in made.files} | {
                    posixpath.basename(posixpath.dirname(interface.path)) for interface in package.linked.interfaces
                }
                names = {"action": ("action", "msg"), "idl": ("msg", "srv", "action")}
                for kind in kinds:
                    self.unknown += [f"{package.name}.{n}" for n in names.get(kind, (kind,))]
            elif made.how == "reconfigure":
                self.unknown.append(f"{package.name}.cfg")
            elif made.how == "parameters":
                self.unknown.append(f"{package.name}.{made.target}")
            else:
                self.unresolved.append(f"`{made.target}` is generated")
        self.unknown.sort()


# -- what a name stands for --------------------------------------------------------------------------------------------


# -- what changed ------------------------------------------------------------------------------------------------------


