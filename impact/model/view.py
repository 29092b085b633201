"""A workspace as one target sees it: what rules ask. On top of what holds and who provides what, what packages need.

This is the join that most rules ask: model by target. Nothing here reads files.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import chain
from typing import NamedTuple

from msgspec import structs

from ...edges.groups import group_pairs
from ...edges.memory import cache_method
from ..conditions.cmake import list_tested_packages
from ..facts.condition import Condition
from ..targets.changes import DISTROS
from ..targets.platform import strip_to_letters
from ..targets.symbol import Symbol
from ..targets.target import Provider
from ..targets.tree_nodes import load_tree_nodes
from .cmake.build import At, FoundPackage, Stop, is_for_tests
from .on_target import INTERFACES, PACKAGE, UnresolvedUse, WorkspaceOnTarget
from .package import ReferenceUse, find_folder_role
from .roles import Roles
from .settings import get_plugin_package
from .unknown_contents import UnknownContents
from .workspace import Package

# A file that Gazebo loads.
_LIBRARY = re.compile(r"(?:lib)?([\w-]+?)(?:\.so)?")
# Packages and rosdep keys of what loads the plugins of worlds and models.
_SIMULATOR = re.compile(r"gazebo(?:_dev)?|(?:lib)?(?:gazebo|ignition-gazebo|gz-sim)\d+(?:-dev)?|gz_sim_vendor")
# How files end that describe robots and worlds.
_DESCRIBES = (".xacro", ".urdf", ".sdf", ".world", ".xml")
_DISTRO = re.compile(rf"(?<![A-Za-z0-9])(?:{'|'.join(DISTROS)})(?![A-Za-z0-9])")


def _mark_distro(path: str) -> tuple[str, str] | None:
    """The distro that a file or its folder is called as, behind what those for other distros have in common."""
    found = _DISTRO.search(path)
    if found is None:
        return None
    before, behind = path[: found.start()], path[found.end() :]
    is_folder = behind.startswith("/") and before[-1:] in ("", "/")
    return before + ("/" if is_folder else behind), found.group()


class Need(NamedTuple):
    """Something a package uses of somebody else.

    how: tool (of the build type), find_package, part (a component of it), component (of catkin), pkg-config, program,
    environment, include, import, launch, plugin, shell or setting (what settings or a description name). subject: as
    written. providers: who could give it, best first. role: build, test, run or aside. certain: stands under no
    condition that is unknown on the target. required: its absence stops the configuration (find_package) or the
    program.
    """

    how: str
    subject: str
    providers: tuple[Provider, ...]
    at: At
    role: str
    certain: bool
    required: bool = True
    public: bool = False
    targets: tuple[str, ...] = ()


# Build types whose tool is called like them.
_TOOLS = frozenset(("ament_cmake", "catkin", "cmake"))
_HOW = {
    "tool": 0, "find_package": 0, "component": 0, "pkg-config": 0, "program": 0, "part": 0, "environment": 0,
    "include": 1, "import": 2, "plugin": 3, "launch": 4, "shell": 5, "setting": 6,
}  # fmt: skip
_ROLE = {"build": 0, "run": 1, "test": 2, "aside": 3}


def make_sort_key(need: Need) -> tuple:
    """Sort key: what is surest to break comes first."""
    return (_ROLE[need.role], not need.certain, not need.required, _HOW[need.how], need.at.path, need.at.line)


# What a package that generates messages hands on to whoever uses them.
_RUNTIMES = frozenset({"message_runtime", "message_generation", "rosidl_default_runtime"})
_OF_INTERFACE = re.compile(r"[\w-]+/(?:[A-Z]\w*\.h|(?:msg|srv|action)/[a-z]\w*\.hpp)\Z")
# The folders of generated headers and modules, by the kind of interface.
_OF_KIND = ("msg/", "srv/", "action/")
_NAME = re.compile(r"[a-z][a-z0-9_]*")
_DEFINED = re.compile(r"\bDEFINED ENV\{(ROS_(?:DISTRO|VERSION|PYTHON_VERSION))\}")


class TargetView(WorkspaceOnTarget):
    """One workspace on one target. providers answers for everything outside the workspace. asked: the distros of all
    targets of the same run, each of which has a view of its own."""

    @cached_property
    def unknown_contents(self) -> UnknownContents:
        """What may be there although nobody is known to have it."""
        return UnknownContents(self)

    @cached_property
    def roles(self) -> Roles:
        """What packages have at hand in each role, and what is handed on to them."""
        return Roles(self)

    @cache_method
    def list_needs(self, package: Package) -> tuple[Need, ...]:
        """Everything a package uses of others on this target."""
        return tuple(self._collect(package))

    @cache_method
    def sort_needs(self, package: Package) -> tuple[Need, ...]:
        """The same, what is surest to break first."""
        return tuple(sorted(self.list_needs(package), key=make_sort_key))

    @cache_method
    def find_stop(self, package: Package) -> Stop | None:
        """Where configuring a package stops on this target for its distro, None where it does not."""
        for stop in package.build.stops:
            if any("ROS_DISTRO" in condition.text for condition in stop[2]) and self.is_sure(stop[2]):
                return stop
        return None

    def is_refused(self, package: str, place: tuple[str, int, int]) -> bool:
        """Whether what stands at a place (path, line, column) is not for this target: its file is called as another
        distro, and one for this distro lies beside it, or the CMake of its package stops here, at another place. What
        the manifest declares is looked for even so."""
        own, path = self.workspace.packages.get(package), place[0]
        if own is None or path.endswith("package.xml"):
            return False
        distro, marked = self.target.distro, _mark_distro(own.strip_path(path))
        is_other = marked is not None and marked[1] != distro and (marked[0], distro) in self._list_marked(own)
        stop = self.find_stop(own)
        return is_other or (stop is not None and (stop[0].path, stop[0].line, stop[0].column) != place)

    @cache_method
    def _list_marked(self, package: Package) -> frozenset[tuple[str, str] | None]:
        """The files of a package that are called as distros."""
        return frozenset(_mark_distro(package.strip_path(path)) for path in package.files)

    def is_circular(self, package: Package, name: str) -> bool:
        """True when what would be declared comes with the package itself, or is of the workspace and needs it."""
        other = self.workspace.packages.get(name)
        if other is None:
            return package.name in self.list_transitive([name])
        return package.name in self.build_environment(other) or any(
            provider.name == package.name for need in self.list_needs(other) for provider in need.providers[:1]
        )

    def generates_header(self, name: str, header: str) -> bool:
        """Whether a package makes the header of an interface, which no tree of the released package shows."""
        return bool(_OF_INTERFACE.match(header)) and not _RUNTIMES.isdisjoint(self.list_installed_with(name))

    def _collect(self, package: Package) -> Iterator[Need]:
        linked = package.linked
        if package.build_type in _TOOLS and package.build.files:
            yield from self._list_tool_needs(package, package.build_type)
        for found in package.build.found:
            if found.how == "pkg_check_modules" and self.applies(found.conditions):
                yield from self._list_module_needs(found)
            if found.how == "program" and self.applies(found.conditions):
                yield from self._list_program_needs(package, found)
            if found.how not in ("find_package", "catkin") or not self.applies(found.conditions):
                continue
            if found.name == package.name or package.name in self.workspace.find_modules.get(found.name, ()):
                continue
            providers = self.find_cmake(found.name) or self._guess_by_form(found.name, found.how == "catkin")
            if not providers and found.required and self._may_be_package(package, found):
                providers = (Provider("ros", found.name),)
            if not providers:
                self.unresolved.add(UnresolvedUse(package.name, "cmake", found.name))
                continue
            role, how = _find_role(found.conditions), "find_package" if found.how == "find_package" else "component"
            in_tests = find_folder_role(package.strip_path(found.at.path)) == "test"
            certain = self.is_sure(found.conditions)
            required = (
                found.required
                or (found.how == "catkin" and not found.quiet)
                or (found.name == "PkgConfig" and self._requires_modules(package))
                or self._is_called(package, found.name)
                or self._is_linked(package, found.name)
            )
            yield Need(how, found.name, providers, found.at, "test" if in_tests else role, certain, required)
            yield from self._list_component_needs(found, role, certain)
        if self.target.find_version("ros_environment") is not None:
            yield from self._list_environment_needs(package)
        for include in linked.includes:
            if not self.applies(include.conditions):
                continue
            providers = self.find_header(include.path)
            if not providers:
                path = include.path.lstrip("./")
                known = path != include.path and self.find_header(path)
                if known or self.offers.list_packages_with(path, self.build_environment(package)):
                    continue
                made_apart = self.unknown_contents.is_made_apart(package, path)
                providers = () if made_apart else self.guess_by_include(path)
            if not providers:
                self.unresolved.add(UnresolvedUse(package.name, "include", include.path))
                continue
            if not providers[0].name:
                continue  # the compiler has it, and nobody else is asked
            if not any(p.sure or p.name in self.workspace.packages for p in providers):
                found = self.find_header_availability(include.path)
                if found is not None and found.state == "unknown":
                    self.unresolved.add(UnresolvedUse(package.name, "include", include.path))
            named = providers[0].kind == "ros" and providers[0].name == include.path.partition("/")[0]
            if not named and self.unknown_contents.is_made_apart(package, include.path):
                continue
            if len(providers) > 1 and any(p.name == package.name for p in providers):
                continue  # the package has one of its own
            yield Need("include", include.path, providers, include.at, include.role, self.is_sure(include.conditions),
                       True, include.public, include.targets)  # fmt: skip
        for item in linked.imports:
            head, _, rest = item.module.partition(".")
            if head == package.name or not self.applies(item.conditions):
                continue
            providers = self.find_module(item.module) or (
                self._guess_by_form(head) if rest.partition(".")[0] in ("msg", "srv", "action") else ()
            )
            if not providers:
                self.unresolved.add(UnresolvedUse(package.name, "import", item.module))
                continue
            if any(not p.name for p in providers):
                continue
            certain = self.is_sure(item.conditions)
            yield Need("import", item.module, providers, item.at, item.role, certain, certain and not item.lazy)
        named = ((use, use.at) for use in linked.references)
        for use, at in chain(named, self._list_described(package)):
            reference = use.reference
            name = reference.package
            if reference.kind == "command":
                # What other code runs is often a tool of who develops it, or one of several that it tries.
                if "launch" in posixpath.basename(use.at.path):
                    yield from self._list_started(package, use)
                continue
            if not name and reference.kind in ("plugin", "library"):
                name = self._find_loaded(package, use)
            if not name or name == package.name or "$" in name:
                continue
            known, of_launch = self.is_package(name), ".launch" in use.at.path
            is_plugin = reference.kind in ("plugin", "library")
            # What a launch file starts, or a description includes, cannot be anything else.
            included = not known and reference.kind == "file" and reference.name.endswith(".xacro")
            if not known and not (PACKAGE.match(name) and (of_launch or included)):
                continue
            how = "plugin" if is_plugin else "launch"
            if at != use.at or (not of_launch and (included or (is_plugin and not reference.package))):
                how = "setting"
            certain = not reference.conditional
            yield Need(how, name, (Provider("ros", name),), at, use.role, certain, certain)

    def _list_tool_needs(self, package: Package, tool: str) -> Iterator[Need]:
        """The tool that packages of a build type are built with: CMake itself, or a package of ROS, where neither a
        part of it is declared to build with, such as ament_cmake_core, nor what is brings it."""
        named = next((one for one in package.manifest.exports if one.text == tool), package.manifest)
        at = At(package.linked.manifest_path, named.line, named.column)
        providers = tuple(self.providers.find_executable(tool)) if tool == "cmake" else self.find_cmake(tool)
        first = [name for name, kinds in self.collect_declared(package).items() if kinds & {"build", "buildtool"}]
        parts = any(name.startswith(tool) for name in first)
        if tool == "cmake" or not (parts or self.is_met(providers, self.list_transitive(first))):
            yield Need("tool", tool, providers, at, "build", True)

    def _list_environment_needs(self, package: Package) -> Iterator[Need]:
        """Environment variables of ROS that CMake tests, or stops without, where nothing that sets them comes along:
        ros_environment, or before that roslib."""
        providers = Provider("ros", "ros_environment"), Provider("ros", "roslib")
        if self.is_met(providers, self.build_environment(package)):
            return
        read = [(use.name, use.at, use.conditions) for use in package.build.uses if use.kind == "environment"]
        for at, _, conditions in package.build.stops:
            for test in conditions:
                asked = _DEFINED.search(test.text)
                if asked and " AND " not in test.text and test.text.startswith("NOT ") != test.negated:
                    read.append((asked[1], at, tuple(other for other in conditions if other is not test)))
        for name, at, conditions in read:
            if self.applies(conditions):
                yield Need("environment", name, providers, at, _find_role(conditions), self.is_sure(conditions))

    def _guess_by_form(self, name: str, sure: bool = False) -> tuple[Provider, ...]:
        """The package that a name nobody is known to provide stands for: it is called as packages of interfaces are, or
        another manifest of the workspace declares it. sure: its place tells that already."""
        if not PACKAGE.match(name) or not (sure or INTERFACES.search(name) or name in self.declared_somewhere):
            return ()
        return (Provider("ros", name),)

    def guess_by_include(self, path: str) -> tuple[Provider, ...]:
        """The package that an include of a header which nobody is known to have is of: by its form it is the header of
        an interface, or its folder is called as what another manifest of the workspace declares."""
        head, _, rest = path.partition("/")
        of_interface = _OF_INTERFACE.match(path) and (INTERFACES.search(head) or rest.startswith(_OF_KIND))
        if of_interface and _NAME.fullmatch(head):
            return (Provider("ros", head),)
        return (Provider("ros", head),) if rest and PACKAGE.match(head) and head in self.declared_somewhere else ()

    def is_surely_package(self, package: Package, name: str) -> bool:
        """Whether a name that nobody is known to provide is one of a package of ROS, by its form, by what a manifest of
        the workspace declares, or since a package uses interfaces of it."""
        return bool(self._guess_by_form(name)) or self.has_interfaces_of(package, name)

    def _may_be_package(self, package: Package, found: FoundPackage) -> bool:
        """Whether what CMake looks for, and nobody is known to provide, most likely is a package of ROS, and nothing is
        known that could bring something else of its name: no find module, download, folder that was not read or that
        CMake is pointed to, or dependency that is called after it."""
        name, letters = found.name, strip_to_letters(found.name)
        if self.has_interfaces_of(package, name):
            return True
        # What is given to ament_target_dependencies() is a package, unless it is a library that others know.
        given = any(link.how == "ament" and link.item == name for link in package.build.target_links)
        return (
            (PACKAGE.match(name) is not None or (given and _NAME.fullmatch(name) is not None))
            and not found.placed
            and package.build_type in _TOOLS - {"cmake"}
            and name not in self.workspace.find_modules
            and not self.workspace.unread
            and not package.build.builds_others
            and not any(target.kind in ("external", "fetched") for target in package.build.targets)
            and not any(letters in strip_to_letters(one) for one in self.build_environment(package))
        )

    @cache_method
    def has_interfaces_of(self, package: Package, name: str) -> bool:
        """Whether a package includes or imports interfaces of a name, as only packages of ROS have them."""
        modules = tuple(f"{name}.{kind.rstrip('/')}" for kind in _OF_KIND)
        imported = any(item.module.startswith(modules) for item in package.linked.imports)
        return imported or self.includes_interfaces_of(package, name)

    @cache_method
    def includes_interfaces_of(self, package: Package, name: str) -> bool:
        """Whether a package includes headers of interfaces of a name as ROS 2 calls them."""
        folders = tuple(f"{name}/{kind}" for kind in _OF_KIND)
        return any(use.path.startswith(folders) and _OF_INTERFACE.match(use.path) for use in package.linked.includes)

    @cached_property
    def declared_somewhere(self) -> frozenset[str]:
        """What manifests of the workspace declare, besides keys."""
        names = {dependency.name for package in self.workspace for dependency in package.manifest.dependencies}
        return frozenset(name for name in names if not self.target.knows_key(name))

    def _requires_modules(self, package: Package) -> bool:
        """Whether pkg_check_modules(REQUIRED) is called in any case, which stops where find_package(PkgConfig) has not
        found the program."""
        asked = (f for f in package.build.found if f.how == "pkg_check_modules" and f.required)
        return any(self.is_sure(f.conditions) for f in asked)

    def _is_called(self, package: Package, name: str) -> bool:
        """Whether a command that a package defines is called wherever it was looked for, found or not."""
        commands = self.providers.commands.get(self.target.ros, {})
        return any(
            name in commands.get(use.name, "").split() and "_FOUND" not in " ".join(c.text for c in use.conditions)
            for use in package.build.uses
            if use.kind == "command" and self.is_sure(use.conditions)
        )

    def _is_linked(self, package: Package, name: str) -> bool:
        """Whether a target that a package defines is linked wherever it was looked for, found or not."""
        targets, prefix = package.build.targets, f"{name}::"
        if any(t.name.startswith(prefix) or t.name.lower() == name.lower() for t in targets):
            return False  # it is downloaded, or made here
        return any(
            link.item.startswith(prefix)
            and self.is_sure(link.conditions)
            and not any(name.lower() in condition.text.lower() for condition in link.conditions)
            for link in package.build.target_links
            if link.how == "link"
        )

    def _list_module_needs(self, found: FoundPackage) -> Iterator[Need]:
        """What a call of pkg_check_modules asks for; modules that a package of the workspace may write are left out."""
        name = re.split(r"[<>=]", found.name)[0]
        providers = tuple(self.providers.find_pkgconfig(name))
        if name in self.workspace.packages:
            return
        if self.target.find_version(name) is not None and all(p.name != name for p in providers):
            # A library that is released as a package (fcl, octomap) writes its own, and so does catkin.
            types = {one.partition(":")[0] for one in self.target.build_type(name).split(";")}
            providers = (*providers, Provider("ros", name, "", bool(types & {"cmake", "catkin"})))
        if not providers:
            return
        # Also where its module has more words in its name than the package (orocos-bfl of bfl).
        words = (word for word in re.split(r"[-_.]", name)[1:] if self.target.find_version(word) is not None)
        providers = (*providers, *(Provider("ros", word, "", False) for word in words))
        certain = self.is_sure(found.conditions)
        yield Need("pkg-config", found.name, providers, found.at, _find_role(found.conditions), certain, found.required)

    def _list_component_needs(self, found: FoundPackage, role: str, certain: bool) -> Iterator[Need]:
        """Components of a system library that have a CMake configuration of their own (`boost_filesystem`,
        `Qt5Widgets`), and so maybe a package."""
        for component, at in found.components if found.required else ():
            if self.find_availability(Symbol("component", component, (found.name,))).is_missing:
                continue  # no package has it, which library-component says
            for name in (f"{found.name.lower()}_{component}", f"{found.name}{component}"):
                installed = self.providers.find_installed_cmake(name)
                # The component's own package is what to declare, not one that has all of them.
                providers = tuple(sorted(installed, key=lambda p: component.lower() not in p.name))
                if providers:
                    yield Need("part", name, providers, at, role, certain)

    def _list_program_needs(self, package: Package, found: FoundPackage) -> Iterator[Need]:
        """A program that CMake starts; those that every machine has are left out. What a package builds where a library
        is not found, it builds on some machine, unless it declares that library."""
        providers = tuple(self.providers.find_executable(found.name))
        if providers and providers[0].name and found.name not in self.apt.base:
            tested = {name for c in found.conditions for name in list_tested_packages(c.text)}
            declared = self.build_environment(package)
            there = any(self.is_met(known, declared) for name in tested if (known := self.find_cmake(name)))
            certain = not there and all(self.is_sure((c,)) or list_tested_packages(c.text) for c in found.conditions)
            required = self.is_sure(found.conditions)
            yield Need("program", found.name, providers, found.at, _find_role(found.conditions), certain, required)

    def _find_loaded(self, package: Package, use: ReferenceUse) -> str:
        """The package that a plugin is of, which a launch file names, or settings and models of a package that starts
        what loads it; empty where there is none."""
        name, library = use.reference.name, _LIBRARY.fullmatch(use.reference.name)
        if ".launch" in use.at.path:
            return name.partition("/")[0] if "/" in name else ""  # nodelets are called `package/Class`
        owners = self._list_library_owners(library[1]) if library is not None else (get_plugin_package(name),)
        if len(owners) != 1 or name.startswith("transmission_interface/"):  # a word for whoever reads the description
            return ""
        (owner,) = owners
        along, started = self.list_installed_with(owner), self._list_started_packages(package)
        if library is not None:
            loaders = started.union(self._list_launched_packages(package)) - {owner}
            return owner if any(self._loads_libraries(one, owner, use.reference.kind) for one in loaders) else ""
        if self.offers.has_plugin(owner, name) is False and owner not in self.workspace.packages:
            return ""  # it may be called after another package than its own
        # Who loads plugins brings their base class, in a package beside its own.
        bases = {self.target.find_repository(one) for one in along} - {None}
        loaders = (one for one in started.difference(along) if "pluginlib" in self.list_installed_with(one))
        return owner if any(not along or self.target.find_repository(one) in bases for one in loaders) else ""

    @cache_method
    def _list_started_packages(self, package: Package) -> frozenset[str]:
        """Packages whose programs a package starts."""
        return frozenset(u.reference.package for u in package.linked.references if u.reference.kind == "executable")

    @cache_method
    def _list_launched_packages(self, package: Package) -> frozenset[str]:
        """Packages of which a package starts launch files."""
        files = (u.reference for u in package.linked.references if u.reference.kind in ("file", "sought"))
        return frozenset(file.package for file in files if "launch" in file.name)

    @cache_method
    def _list_library_owners(self, library: str) -> tuple[str, ...]:
        """The packages that make a library of this name: of the workspace, else released ones that are called after
        it."""
        own = tuple(one.name for one in self.workspace if library in _list_library_names(one))
        return own or tuple(self.offers.list_library_owners(library))

    def _loads_libraries(self, loader: str, owner: str, kind: str) -> bool:
        """Whether a package that is started may load libraries of another: both bring the same simulator, or
        BehaviorTree.CPP for those of nodes. Gazebo is also started by a package that is called after it."""
        mine, theirs = self.list_transitive([owner]), self.list_transitive([loader])
        if kind == "library":
            return not load_tree_nodes().libraries.isdisjoint(mine & theirs)
        word = owner.partition("_")[0]
        return any(map(_SIMULATOR.fullmatch, mine & theirs)) or (loader in mine and loader.partition("_")[0] == word)

    def _list_described(self, package: Package) -> Iterator[tuple[ReferenceUse, At]]:
        """The plugins that descriptions of other packages of the workspace name which a package starts something with,
        and where it names the description."""
        for use in package.linked.references:
            if use.reference.kind == "file" and use.reference.package != package.name:
                for named in self._list_named_plugins(use.reference.package, use.reference.name):
                    conditional = use.reference.conditional or named.reference.conditional
                    reference = structs.replace(named.reference, conditional=conditional)
                    yield ReferenceUse(reference, named.at, use.role), use.at

    @cache_method
    def _list_named_plugins(self, owner: str, name: str) -> tuple[ReferenceUse, ...]:
        """What a file of a package of the workspace names of plugins, and the files that it includes."""
        found: dict[ReferenceUse, None] = {}
        todo, done = [(owner, name)], set[tuple[str, str]]()
        while todo:
            one = todo.pop()
            package = self.workspace.packages.get(one[0])
            if one in done or package is None or not one[1].endswith(_DESCRIBES):
                continue
            done.add(one)
            path = posixpath.join(package.path, one[1])
            for use in self._references_by_file.get(path, ()):
                if use.reference.kind == "file":
                    todo.append((use.reference.package or package.name, use.reference.name))
                else:
                    found[use] = None
        return tuple(found)

    @cached_property
    def _references_by_file(self) -> dict[str, list[ReferenceUse]]:
        """What descriptions of the workspace name of plugins, and the files that they include."""
        uses = (use for package in self.workspace for use in package.linked.references)
        kinds = ("file", "plugin")
        return group_pairs((u.at.path, u) for u in uses if u.reference.kind in kinds and u.at.path.endswith(_DESCRIBES))

    def _list_started(self, package: Package, use: ReferenceUse) -> Iterator[Need]:
        """A program of a ROS package that a launch file runs by its name alone, and that the workspace does not make.
        Which key brings a program of the platform is not sure enough: several do, and other packages vendor it."""
        name, certain = use.reference.name, not use.reference.conditional
        providers = tuple(self.providers.find_executable(name))
        if not providers or providers[0].kind != "ros" or name in self.workspace.packages:
            return
        if any(target.name == name for target in package.build.targets):
            return
        yield Need("shell", name, providers, use.at, use.role, certain, certain)


def _list_library_names(package: Package) -> frozenset[str]:
    """The names of the libraries that a package makes."""
    targets = (one for one in package.build.targets if one.kind in ("library", "module"))
    return frozenset(one.output_name or one.name for one in targets)


def _find_role(conditions: Iterable[Condition]) -> str:
    """What is built under conditions: tests or the rest."""
    return "test" if is_for_tests(conditions) else "build"


def find_included_interface(view: TargetView, include: str) -> str | None:
    """The package whose interface an include path names by its form (`p/msg/x.hpp`, `p/X.h`), None for others."""
    head, _, rest = include.partition("/")
    package = view.workspace.packages.get(head)
    if package is not None:
        return head if package.is_interface_package and view.workspace.is_interface_header(head, rest) else None
    if not head.endswith(("_msgs", "_srvs", "_interfaces", "_actions")) and not rest.startswith(
        ("msg/", "srv/", "action/")
    ):
        return None
    return head
