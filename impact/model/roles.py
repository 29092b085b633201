"""What a package has at hand in each role (build, run, test), and what the packages that it declares hand on.

A manifest says which packages are installed together. What a package *exports* is less: CMake hands on what
ament_export_dependencies or CATKIN_DEPENDS and DEPENDS of catkin_package name, and a manifest promises what it declares
as `build_export_depend`. What is installed and exported by nobody is there only by chance: it leaves when the package
that happens to need it drops it.
"""

from __future__ import annotations

from collections.abc import Iterable

from ...edges.memory import cache_method
from ...edges.reach import TransitiveNames, walk
from .on_target import WorkspaceOnTarget
from .workspace import Package

KINDS = {
    "build": frozenset({"build", "buildtool", "build_export", "buildtool_export"}),
    "run": frozenset({"exec", "build_export", "buildtool_export"}),
    "test": frozenset({"build", "buildtool", "build_export", "buildtool_export", "exec", "test"}),
    "tests alone": frozenset({"test"}),
}
"""Kinds of dependencies that install what a role needs. Tests are built and run where everything is; what is for them
alone is asked for by itself."""

_BUILD_DEPENDS = frozenset({"build", "buildtool", "test"})
# The day of bloom 0.11.0. Source: its commit 53beb52.
_FARM_MAKES_NO_TESTS = "2022-04-19"
_TOOLS = frozenset({"buildtool_export"})
_PROMISES = _TOOLS | {"build_export"}
_HANDED_ON = ("ament_export_dependencies", "catkin_depends", "system_depends")


class Roles:
    """The closures of the packages of one view."""

    def __init__(self, view: WorkspaceOnTarget):
        self._view = view
        self._by_cmake = TransitiveNames(lambda name: (*self.list_exports(name), *self.list_tools(name)))
        self._by_promises = TransitiveNames(lambda name: (*self.list_exports(name), *self.list_promises(name)))

    @cache_method
    def list_at_hand(self, package: Package, role: str) -> frozenset[str]:
        """Everything that is installed along with what a package declares for a role: a key of KINDS."""
        declared = self._view.collect_declared(package)
        start = [name for name, kinds in declared.items() if kinds & KINDS[role]]
        return self._view.list_transitive(start) | {package.name}

    @property
    def farm_makes_tests(self) -> bool:
        """Whether the build farm configures packages with tests, as it did before bloom 0.11.0."""
        return self._view.target.date < _FARM_MAKES_NO_TESTS

    @cache_method
    def list_on_build_farm(self, package: Package) -> frozenset[str]:
        """Everything that may be on the machine which builds the package's release: what is declared to build and to
        test, but not what is declared to run. Source: bloom's Build-Depends, without those for tests from 0.11.0 on."""
        view = self._view
        start = [name for name, kinds in view.collect_declared(package).items() if kinds & _BUILD_DEPENDS]
        return view.list_widest_dependencies(start).union(view.preinstalled, (package.name,))

    @cache_method
    def list_handed_on(self, package: Package, role: str, promised: bool) -> frozenset[str]:
        """What a package declares for a role, and what that exports in turn. promised: what its manifests promise to
        export counts as well as what its CMake does."""
        declared = self._view.collect_declared(package)
        start = [name for name, kinds in declared.items() if kinds & KINDS[role]]
        return self._by_promises.collect(start) if promised else self.list_brought(start)

    def list_brought(self, names: Iterable[str]) -> frozenset[str]:
        """These names, and all that their CMake is known to hand on where CMake finds them."""
        return self._by_cmake.collect(names)

    def list_tools(self, name: str) -> tuple[str, ...]:
        """What the CMake extensions of a package need where it is used: `buildtool_export_depend`."""
        return tuple(n for n, kind in self._list_dependencies(name) if kind in _TOOLS)

    def has_build_tool(self, package: Package, tool: str) -> bool:
        """Whether a package declares a tool of its own build, or a tool that exports it."""
        declared = self._view.collect_declared(package)
        return tool in walk((n for n, kinds in declared.items() if "buildtool" in kinds or n == tool), self.list_tools)

    def comes_with_launch(self, name: str, path: str) -> bool:
        """Whether whoever starts launch files has a package: all that comes along with the command that does, for the
        launch files themselves; the command's own packages for what is made for them."""
        tool = "ros2launch" if self._view.target.ros == 2 else "roslaunch"
        if "launch" in path.rpartition("/")[2]:
            return name in self._view.list_transitive([tool])
        return name == tool or name in self._view.list_installed_with(tool)

    def comes_with_client_library(self, name: str) -> bool:
        """Whether a package comes along with the client library of C++: whoever builds a node finds it all the same."""
        return name in self._view.list_transitive(("rclcpp" if self._view.target.ros == 2 else "roscpp",))

    @cache_method
    def list_exports(self, name: str) -> tuple[str, ...]:
        """What a package hands on by CMake; by its manifest where its CMake is not known."""
        own = self._view.workspace.packages.get(name)
        handed = self._view.offers.list_exports(name) if own is None else self._list_own_exports(own)
        return self.list_promises(name) if handed is None else tuple(key for item in handed for key in self._find(item))

    @cache_method
    def list_promises(self, name: str) -> tuple[str, ...]:
        """What the manifest of a package promises to hand on. A manifest of format 1 calls both that and what is needed
        to run `run_depend`, which promises nothing."""
        wanted = KINDS["run"] if self._bundles(name) else _TOOLS if self._promises_nothing(name) else _PROMISES
        return tuple(n for n, kind in self._list_dependencies(name) if kind in wanted)

    def _list_own_exports(self, package: Package) -> list[str] | None:
        """What CMake looks for wherever it finds a package of the workspace; None where that is not known, as of a
        package of plain CMake, which writes its configuration itself."""
        build = package.build
        if package.build_type == "cmake":
            return None
        names = [e.item for e in build.exports if e.how in _HANDED_ON and self._view.applies(e.conditions)]
        if any("$" in name for name in names) or build.finds_declared:
            return None
        names.extend(f.name for f in build.handed_on)
        # rosidl exports what interfaces are made of; generate_messages() leaves that to CATKIN_DEPENDS.
        names.extend(name for made in build.generated if made.how == "rosidl" for name, _ in made.dependencies)
        return names

    def list_found_with(self, names: Iterable[str]) -> frozenset[str]:
        """All that CMake may find where it finds these: of packages of the workspace what they export, of others all
        that their manifests depend on."""
        walked = walk(names, lambda name: self._list_exported_here(name) or ())
        return frozenset().union(*map(self._list_brought_along, walked))

    @cache_method
    def _list_exported_here(self, name: str) -> list[str] | None:
        """What a package of the workspace exports; None for others, and where that is not known."""
        own = self._view.workspace.packages.get(name)
        return self._list_own_exports(own) if own is not None and own.build.files else None

    @cache_method
    def _list_brought_along(self, name: str) -> frozenset[str]:
        """A name, and all that its manifest brings where it is not known what it exports."""
        if self._list_exported_here(name) is not None:
            return frozenset((name,))
        return self._view.list_transitive({name, *(provider.name for provider in self._view.find_cmake(name))})

    def _find(self, item: str) -> Iterable[str]:
        """The package of this name, or who answers find_package() of a system library's CMake name."""
        view = self._view
        if item in view.workspace.packages or view.target.find_version(item) is not None:
            return (item,)
        return [provider.name for provider in view.find_cmake(item)]

    def _promises_nothing(self, name: str) -> bool:
        """True where `run_depend` of format 1 is all that a manifest says, and CMake says more. Of released packages of
        ROS 1 the format is not known."""
        own = self._view.workspace.packages.get(name)
        if own is not None:
            return own.manifest.format == 1
        return self._view.target.ros == 1 and self._view.offers.list_exports(name) is not None

    def _bundles(self, name: str) -> bool:
        """True for a package that has nothing of its own and is there to bring others, as a metapackage does."""
        own = self._view.workspace.packages.get(name)
        if own is not None:
            return own.manifest.metapackage or not (own.build.targets or own.build.installs or own.linked.imports)
        return self._view.offers.is_bundle(name)

    def _list_dependencies(self, name: str) -> Iterable[tuple[str, str]]:
        view = self._view
        own = view.workspace.packages.get(name)
        if own is not None:
            return [(n, kind) for n, kinds in view.collect_declared(own).items() for kind in kinds]
        released = view.target.list_dependencies(name) or view.target.list_similar(name) or ()
        return [(d.name, d.kind) for d in released]
