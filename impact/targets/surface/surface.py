"""What one version of one package offers, in the form that is stored."""

from __future__ import annotations

import msgspec

from ...facts.interface import Interface
from ...facts.python.surface import ModuleSurface
from ...facts.surface import HeaderSurface


class Surface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What one version of one package offers.

    headers: by the path that dependants write; generated ones are in the build only. interfaces: by `msg/Name`,
    without comments. guessed: the build does not tell which headers are installed, so those of `include/` are taken.
    runs_with: packages that come along when this one is installed. parameters: that its nodes declare, by name, with
    their default: None for none, `?` where it is no plain value, or not one. mentioned: names that its sources mention,
    as ParametersFile.mentioned, and those of its parameters; None where they are not known, as in what is stored. The
    C++ standard, re-exported packages, targets, programs and launch files are in the build.
    """

    package: str
    version: str
    build: BuildSurface
    python: PythonSurface
    headers: tuple[tuple[str, HeaderSurface], ...] = ()
    interfaces: tuple[tuple[str, Interface], ...] = ()
    guessed: bool = False
    runs_with: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str | None], ...] = ()
    mentioned: tuple[str, ...] | None = None


class InstalledModule(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An installed module. name: dotted. path: its source, relative to the package. package: it is an `__init__.py`."""

    name: str
    path: str
    package: bool
    surface: ModuleSurface


class PythonSurface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a package version offers to Python. unknown: dotted names below which there may be anything: extensions,
    generated interfaces. unresolved: what kept the modules from being told, in a clause each."""

    package: str
    modules: tuple[InstalledModule, ...] = ()
    unknown: tuple[str, ...] = ()
    unresolved: tuple[str, ...] = ()


class ExportedTarget(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A CMake target that dependants can link. name: with its namespace. kind: as of BuildTarget. standard: the C++
    standard that it asks for, 0 for none. sure: False where a condition decides whether it is there."""

    name: str
    kind: str
    standard: int = 0
    sure: bool = True


class Header(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A header that is installed. include: what dependants write. installed: its path in the prefix. source: its path
    in the package, empty for one that is generated. sure: as of ExportedTarget."""

    include: str
    installed: str
    source: str = ""
    sure: bool = True


class InstalledProgram(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An executable. place: the folder in the prefix. how: `binary`, `script`, `component` or `entry point`."""

    name: str
    place: str
    how: str
    sure: bool = True


TREE_NODE = "BT::TreeNode"


class Plugin(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A plugin: lookup name, type, base class. A component has the base `rclcpp_components`, a node of behaviour trees
    TREE_NODE."""

    name: str
    type: str
    base: str
    sure: bool = True


class InstalledLaunchFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An installed launch file. path: in the package's share folder. arguments: name and default, None where it must be
    given, `?` where the default is no plain text."""

    path: str
    arguments: tuple[tuple[str, str | None], ...] = ()


class BuildSurface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What one version of a package offers to CMake and at run time.

    cmake_names: what find_package() takes. libraries: what is in `<package>_LIBRARIES`. include_dirs: exported folders
    of the prefix. dependencies: packages that it brings along (what dependants may include and link through it);
    system: what it brings by DEPENDS of catkin_package().
    commands: functions and macros; variables: besides those that every package has.
    standard: the C++ standard that its users need, 0 where nothing says. unknown: (part, why) of what cannot be known,
    part being `targets`, `libraries`, `headers`, `commands`, `programs`, `launches` or `system`. pkgconfig: of system
    libraries, names of pkg-config files, each with the libraries that it links behind it.
    """

    package: str
    version: str = ""
    build_type: str = ""
    cmake_names: tuple[str, ...] = ()
    targets: tuple[ExportedTarget, ...] = ()
    libraries: tuple[str, ...] = ()
    include_dirs: tuple[str, ...] = ()
    dependencies: tuple[str, ...] = ()
    system: tuple[str, ...] = ()
    commands: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    standard: int = 0
    programs: tuple[InstalledProgram, ...] = ()
    plugins: tuple[Plugin, ...] = ()
    launches: tuple[InstalledLaunchFile, ...] = ()
    headers: tuple[Header, ...] = ()
    unknown: tuple[tuple[str, str], ...] = ()
    pkgconfig: tuple[str, ...] = ()

    @property
    def has_empty_folders(self) -> bool:
        """Whether folders of headers are exported and no header is known in them, so that they were not found."""
        return bool(self.include_dirs) and not self.headers
