"""The CMake of one package, interpreted across files: what is found, built, linked, generated, installed, exported."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from typing import NamedTuple

import msgspec

from ....edges.reach import walk
from ...facts.condition import Condition

LINKING = ("link", "ament", "objects")
"""How targets are given what they are linked to."""


class At(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A place in the workspace: path relative to its root, line, column (from 1; column 0 is the whole line)."""

    path: str
    line: int
    column: int = 0


Stop = tuple[At, str, tuple[Condition, ...]]
"""A message(FATAL_ERROR) under conditions, with its text."""


class FoundPackage(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A package looked for by CMake.

    how: `find_package`, `catkin` (a component of find_package(catkin)), `declared` (what package.xml declares is looked
    for, by ament_auto_find_build_dependencies or catkin_simple), `pkg_check_modules`, `find_library`, `find_path`,
    `find_program`, `program` (not looked for: what ExternalProject_Add and FetchContent_Declare start), `passed` (given
    to a command that nothing defines and that is called like `find_our_package`).
    version: as asked for, empty when not; components: of find_package, catkin excepted (each is its own Found).
    conditions: everything the call stands under, outermost first. at is the argument's own place.
    prefix: the variable or variable prefix of pkg_check_modules and find_library; its further names are in
    optional_components. via: the command of another package that looks for it (`moveit_package`), empty when this
    package asks itself; at is then the call of that command. placed: the package says where it lies, by a variable or
    an argument.
    """

    name: str
    how: str
    at: At
    required: bool = False
    quiet: bool = False
    version: str = ""
    exact: bool = False
    components: tuple[tuple[str, At], ...] = ()
    optional_components: tuple[str, ...] = ()
    prefix: str = ""
    conditions: tuple[Condition, ...] = ()
    via: str = ""
    placed: bool = False


class DefinedMacro(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A preprocessor macro that CMake defines (-DNAME=value) for one target, or, where that is empty, for all."""

    name: str
    value: str
    target: str
    conditions: tuple[Condition, ...] = ()


class Link(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One item given to a target. how: `link` (target_link_libraries), `ament` (ament_target_dependencies),
    `include` (target_include_directories), `order` (add_dependencies), `interfaces` (rosidl_target_interfaces),
    `objects` ($<TARGET_OBJECTS:>).
    item: as written with variables expanded; an unset X_LIBRARIES, X_INCLUDE_DIRS, X_EXPORTED_TARGETS or X_TARGETS
    stays as `${X_LIBRARIES}` so that what it stands for can still be told, and so does any other variable that nothing
    sets. visibility: PUBLIC, PRIVATE, INTERFACE or empty. conditions: those of the target first.
    """

    item: str
    how: str
    at: At
    visibility: str = ""
    conditions: tuple[Condition, ...] = ()


class BuildTarget(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Something CMake builds.

    kind: executable, library, interface (INTERFACE library), module, test (add_gtest, ament_add_gtest, rostest ...),
    custom (add_custom_target), generated (rosidl_generate_interfaces, generate_messages, generate_parameter_library,
    generate_dynamic_reconfigure_options ...), imported, alias, external (ExternalProject_Add, ament_vendor), fetched
    (FetchContent), unknown (something is given to it, but nothing that could be read makes it).
    sources: paths relative to the workspace root when they can be known, else as written. guarded: of those, each that
    stands under conditions besides the target's own, with these. export_name: what it is called where it is exported,
    empty for its name. public_standard: the C++ standard that it asks of those who link it. installed_includes: folders
    of the prefix that those search for headers, from $<INSTALL_INTERFACE:>. static: an archive by its type. excluded:
    built on request only (EXCLUDE_FROM_ALL). archive: an archive, by its type or without one.
    """

    name: str
    kind: str
    at: At
    sources: tuple[str, ...] = ()
    links: tuple[Link, ...] = ()
    definitions: tuple[str, ...] = ()
    standard: int = 0
    output_name: str = ""
    alias_of: str = ""
    conditions: tuple[Condition, ...] = ()
    guarded: tuple[tuple[str, tuple[Condition, ...]], ...] = ()
    export_name: str = ""
    public_standard: int = 0
    installed_includes: tuple[str, ...] = ()
    static: bool = False
    excluded: bool = False
    archive: bool = False


class Install(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An install rule. kind: targets, files, programs, directory, python (catkin_python_setup,
    ament_python_install_package), export. items: paths relative to the workspace root, or target names.
    patterns: of PATTERN/REGEX/FILES_MATCHING; excluded patterns start with `!`, and regular expressions then with `~`.
    only: with FILES_MATCHING, so that nothing but what the patterns name is installed. rename: of files. export: the
    export set that targets are put into. namespace: of an export. includes: INCLUDES DESTINATION of targets.
    executable: a folder whose files keep, or are given, the permission to be executed. rewritten: the first line of
    programs in Python is made to name the interpreter that the package is built with. optional: files that need not be
    there. guessed: the destination of files rests on a value that is not known, or differs between branches."""

    kind: str
    items: tuple[str, ...]
    destination: str
    at: At
    patterns: tuple[str, ...] = ()
    conditions: tuple[Condition, ...] = ()
    only: bool = False
    rename: str = ""
    export: str = ""
    namespace: str = ""
    includes: tuple[str, ...] = ()
    executable: bool = False
    rewritten: bool = False
    optional: bool = False
    guessed: bool = False


class CMakeExport(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Something the package promises its dependants.

    how: ament_export_dependencies, ament_export_include_directories, ament_export_libraries, ament_export_targets,
    catkin_depends, system_depends (DEPENDS), include_dirs, libraries, cfg_extras, plugin_description, component
    (rclcpp_components: item is the class).
    context: for a plugin description the package of the base class, for a component the library it is in, for
    ament_export_targets the namespace where one is given.
    executable: the program that is made to run the component alone, empty for none.
    """

    item: str
    how: str
    at: At
    conditions: tuple[Condition, ...] = ()
    context: str = ""
    executable: str = ""


class GeneratedInterfaces(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One generator call: files relative to the workspace root, packages it depends on, the CMake target it makes.
    how: rosidl, catkin (add_*_files plus generate_messages), reconfigure, parameters (generate_parameter_library),
    protobuf. installed: False where what is made is for the package itself alone (SKIP_INSTALL)."""

    how: str
    target: str
    files: tuple[str, ...]
    dependencies: tuple[tuple[str, At], ...]
    at: At
    conditions: tuple[Condition, ...] = ()
    installed: bool = True

    @property
    def offered(self) -> bool:
        """Whether others find what is made."""
        return self.installed and not is_for_tests(self.conditions)


class ReadFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A file of CMake code that include() or add_subdirectory() reads, where it lies outside of the package or does not
    exist. path: relative to the workspace root, or as written where it lies above that. command: what reads it."""

    path: str
    command: str
    at: At
    conditions: tuple[Condition, ...] = ()


class CMakeUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A command called that nothing in the tree or in CMake itself defines (`ament_add_gtest`, `catkin_add_nosetests`),
    a variable read that nothing sets (`Eigen3_INCLUDE_DIR`), or something known that not every version of CMake or not
    every machine has. kind: `command`, `variable`, `unset`, `feature`, `dropped`, `old policy`, `policies` or
    `environment`.
    for variable, context is the command it is read in; `unset` is a variable that install() reads and that nothing can
    have set; for a command of one of CMake's modules, the module that would
    have to be included or found first (`FindPkgConfig` for `pkg_check_modules`); for a `feature`, which is a command,
    module or policy of CMake itself, the version that brought it; for a `dropped` command or module the policy that is
    NEW there and takes it away; for an `old policy`, set to OLD, the version that refuses that; `policies` are those of
    the version `name`, which a file of a subdirectory or cmake_policy() asks for; an `environment` is a variable that
    ros_environment sets, read by a test. alike: of a variable that nothing can have set, one
    that is set there and has one word more or less in its name. makes: of a command, what it may make: its first
    argument, and its DESTINATION."""

    kind: str
    name: str
    at: At
    context: str = ""
    conditions: tuple[Condition, ...] = ()
    alike: str = ""
    makes: tuple[str, ...] = ()


class DependencyCall(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A call of ament_target_dependencies(). arguments: each as written, where it stands, and the words that it stands
    for; empty where these, or where it stands, cannot be known."""

    at: At
    target: str
    arguments: tuple[tuple[str, At, tuple[str, ...]], ...]
    conditions: tuple[Condition, ...] = ()


class RefusedName(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name at which CMake stops. kind: `twice` (a target that is added a second time; conditions are those of
    both times), `mixed` (a target that is linked with keywords and without), `no scope` (an argument that stands
    where a command wants PUBLIC, PRIVATE or INTERFACE), `no target` (something is given to a target that is not
    there yet, or never), `branch` (the same, where it is there under one of `ways` alone, the conditions of what
    makes it), `branch sources` (a target whose sources, `patterns`, are none under one of `ways`), `project`
    (catkin_package() or ament_package() finds another name in package.xml than that of the project), `version`
    (project() is given a version under the policies of a CMake before 3.0), `no value` (a property of
    set_target_properties() whose value is a variable that nothing sets), `no sources` (a library or executable of
    what file(GLOB) finds with `patterns`, which is nothing), `late` (a macro that has to come before
    catkin_package()), `unguarded` (a command for tests that is called although tests may be switched off)."""

    kind: str
    name: str
    at: At
    conditions: tuple[Condition, ...] = ()
    ways: tuple[tuple[Condition, ...], ...] = ()
    patterns: tuple[str, ...] = ()


def is_for_tests(conditions: Iterable[Condition]) -> bool:
    """True for what CMake finds or makes only where tests are built."""
    return any("TESTING" in c.text for c in conditions)


class WrittenPath(NamedTuple):
    """A path in CMake. how: `source`, `test` or `read`, which have to exist, `install`, `link` or `include`. by: the
    target or command that takes it."""

    path: str
    how: str
    by: str
    at: At
    conditions: tuple[Condition, ...]


class Build(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What the CMake of a package says. minimum: cmake_minimum_required's version and place. standard: the highest C++
    standard set for everything (CMAKE_CXX_STANDARD, -std= flags, compile features), None when there is none, with
    its place. standards: every one, with its place and conditions. standard_default_only: it is only set where the
    user or a toolchain has not chosen one. standard_by_flag: by -std= flags alone, so that CMake adds what linked
    targets ask for only where the compiler's default is lower. open_flags: the compiler is given the value of a
    variable that is not known, which may set one. macros: what is given to the compiler with -D. message_files:
    what generators of interfaces are given. unresolved: (place, reason) of what could not be known. files: the
    CMake files read, relative to the root. made: paths that configuring or building writes, or of the tree that git
    ignores; a folder ends with a slash, and what lies in the build folder starts with ${CMAKE_BINARY_DIR}. starts:
    files of the package that configuring starts as programs, and other programs of whose answer CMake takes
    nothing, which all may write anything. from_found: paths that start at the CMake folder of a package that is
    found, with that package. handed_on: what the scripts look for that the package gives to those who find it
    (CONFIG_EXTRAS, what these include, and extensions that they register). catkin_destinations: catkin_package(),
    or a macro that calls catkin_destinations() as generate_messages() does, sets where targets are built, so that
    the devel space has them. before_catkin_destinations: targets that are added before their folders are set.
    refused: names at which CMake stops. read_elsewhere: the CMake files that it asks for and that do not lie in the
    package. asked: the packages whose X_FOUND a test reads. stops: each message(FATAL_ERROR) under conditions, with
    its text. dependency_calls: the calls of ament_target_dependencies(). compared: the words that tests compare
    ROS_DISTRO with."""

    project: str = ""
    minimum: tuple[str, At] | None = None
    standard: tuple[int, At] | None = None
    standard_default_only: bool = False
    found: tuple[FoundPackage, ...] = ()
    targets: tuple[BuildTarget, ...] = ()
    installs: tuple[Install, ...] = ()
    exports: tuple[CMakeExport, ...] = ()
    generated: tuple[GeneratedInterfaces, ...] = ()
    uses: tuple[CMakeUse, ...] = ()
    include_dirs: tuple[tuple[str, At], ...] = ()
    links: tuple[Link, ...] = ()
    catkin_package: At | None = None
    ament_package: At | None = None
    unresolved: tuple[tuple[At, str], ...] = ()
    files: tuple[str, ...] = ()
    standard_by_flag: bool = False
    open_flags: bool = False
    message_files: tuple[WrittenPath, ...] = ()
    standards: tuple[tuple[int, At, tuple[Condition, ...]], ...] = ()
    macros: tuple[DefinedMacro, ...] = ()
    made: tuple[str, ...] = ()
    starts: tuple[str, ...] = ()
    from_found: tuple[tuple[str, str], ...] = ()
    handed_on: tuple[FoundPackage, ...] = ()
    before_catkin_destinations: tuple[str, ...] = ()
    refused: tuple[RefusedName, ...] = ()
    read_elsewhere: tuple[ReadFile, ...] = ()
    asked: tuple[str, ...] = ()
    stops: tuple[Stop, ...] = ()
    dependency_calls: tuple[DependencyCall, ...] = ()
    compared: tuple[tuple[str, At], ...] = ()
    catkin_destinations: bool = False

    @property
    def finds_declared(self) -> bool:
        """Whether CMake looks for what package.xml declares, so that more is found and handed on than it names."""
        return any(found.how == "declared" for found in self.found)

    @property
    def packaged(self) -> At | None:
        """Where it calls catkin_package() or ament_package()."""
        return self.catkin_package or self.ament_package

    @property
    def catkin_components(self) -> frozenset[str]:
        """The packages that find_package(catkin) is asked for."""
        return frozenset(found.name for found in self.found if found.how == "catkin")

    @property
    def target_links(self) -> tuple[Link, ...]:
        """What is given to targets, target by target."""
        return tuple(link for target in self.targets for link in target.links)

    @property
    def installed_targets(self) -> frozenset[str]:
        """The targets that install rules name."""
        return frozenset(item for install in self.installs if install.kind == "targets" for item in install.items)

    @property
    def builds_others(self) -> bool:
        """Whether it downloads or calls the build of something else."""
        return any(target.kind in ("external", "fetched") for target in self.targets)

    @property
    def makes_environment(self) -> bool:
        """Whether it makes a virtual environment, for a Python and with modules that it chooses itself."""
        return any(use.kind == "command" and "virtualenv" in use.name for use in self.uses)

    @property
    def may_add_targets(self) -> bool:
        """Whether what is not read may add targets and set variables."""
        return bool(self.unresolved) or self.builds_others or any(target.name.endswith("()") for target in self.targets)

    def list_uses(self) -> list[CMakeUse]:
        """Its uses, and as those of the kind `target` the items that targets are given."""
        return [*self.uses, *(CMakeUse("target", one.item, one.at, "", one.conditions) for one in self.target_links)]

    def list_linked_items(self, target: str, hows: Container[str] | None = LINKING) -> set[str] | None:
        """All that a target is linked to, itself and through targets of its package; None where that cannot be known.
        hows: what counts, with None all that it is given."""
        items = {link.item for link in self.links}
        for own in self.list_reached_targets((target, *items), hows):
            if own.kind in ("unknown", "external", "fetched", "imported"):
                return None
            items.update(link.item for link in own.links if hows is None or link.how in hows)
        return items

    def find_linked(self, target: str) -> set[str] | None:
        """A target with all that it is linked to, and the targets that this has other names for; None where that cannot
        be told."""
        items = self.list_linked_items(target)
        if items is None:
            return None
        return {target, *items, *(one.alias_of for one in self.targets if one.name in items)}

    def list_reached_targets(self, names: Iterable[str], hows: Container[str] | None = None) -> Iterator[BuildTarget]:
        """Targets, by name, and those that they are given in turn. hows: what counts, all when None."""
        targets = {one.name: one for one in self.targets}

        def list_linked(name: str) -> Iterator[str]:
            own = targets.get(name)
            if own is not None:
                yield own.alias_of
                yield from (link.item for link in own.links if hows is None or link.how in hows)

        return (targets[name] for name in walk(names, list_linked) if name in targets)

    def list_paths(self) -> Iterator[WrittenPath]:
        """The paths of the tree that it reads, compiles, links, searches and installs."""
        for read in self.read_elsewhere:
            yield WrittenPath(read.path, "read", read.command, read.at, read.conditions)
        yield from self.message_files
        for target in self.targets:
            guarded = dict(target.guarded)
            for path in target.sources if target.kind in ("executable", "library", "module", "test") else ():
                conditions = (*target.conditions, *guarded.get(path, ()))
                # A test whose only source is no code that is compiled runs that file.
                alone = target.kind == "test" and target.sources == (path,)
                how = "test" if alone and not path.endswith((".c", ".cc", ".cpp", ".cxx")) else "source"
                yield WrittenPath(path, how, target.name, target.at, conditions)
            for link in target.links:
                if link.how in ("link", "include"):
                    yield WrittenPath(link.item, link.how, target.name, link.at, link.conditions)
        for path, at in self.include_dirs:
            yield WrittenPath(path, "include", "", at, ())
        for install in self.installs:
            for path in install.items if install.kind in ("files", "programs", "directory") else ():
                yield WrittenPath(path, "install", "", install.at, install.conditions)


_CONDITIONAL = ("found", "targets", "installs", "exports", "generated", "uses", "links", "handed_on", "refused",
                "dependency_calls")  # fmt: skip


def select_active(build: Build, active: Callable[[tuple[Condition, ...]], bool]) -> Build:
    """What of a build counts on one machine: what surely does not is left out. active: whether a statement under these
    conditions may count there."""
    changed = {}
    for field in _CONDITIONAL:
        items = getattr(build, field)
        kept = tuple(item for item in items if active(item.conditions))
        if len(kept) != len(items):
            changed[field] = kept
    return msgspec.structs.replace(build, **changed) if changed else build


class DeclaredPackages(msgspec.Struct, frozen=True, gc=False):
    """What package.xml declares, as far as CMake reads it: see interpret(). conditions: the condition of those that are
    declared under one alone."""

    build: tuple[str, ...] = ()
    test: tuple[str, ...] = ()
    exported: tuple[str, ...] = ()
    conditions: Mapping[str, Condition] = {}

    @property
    def names(self) -> frozenset[str]:
        """All of them, whatever they are declared for."""
        return frozenset((*self.build, *self.test, *self.exported))

    def add_condition(self, name: str, conditions: tuple[Condition, ...]) -> tuple[Condition, ...]:
        """The conditions, and that of a declared package."""
        own = self.conditions.get(name)
        return conditions if own is None else (*conditions, own)
