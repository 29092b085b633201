"""The one answer to "may this be there although nobody is known to have it?", for rules that state an absence.

What a package uses, directly or through what it finds, may have contents that are not known completely: what its own
build downloads or makes, folders that were not read, libraries of archives that were not read, releases whose files are
not stored, packages whose dependencies are not known. What is looked for may come from there.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from functools import cached_property, lru_cache

from ...edges.memory import cache_method
from ..targets.platform import strip_separators, strip_to_letters
from ..targets.target import Provider
from .cmake.build import is_for_tests
from .cmake.interpreter import calls_unmodelled
from .cmake.names import MODULES
from .on_target import INTERFACES, SHORTEST_NAME, WorkspaceOnTarget
from .workspace import Package

# What makes interfaces and runs with them.
_WITH_INTERFACES = (
    "rosidl_default_generators", "rosidl_default_runtime", "message_generation", "message_runtime",
)  # fmt: skip
# How CMake finds packages whose configurations find others in turn.
FINDING = ("find_package", "catkin", "declared", "ament_lint_auto")
_IN_BUILD = re.compile(r"\$\{(?:CMAKE|PROJECT)(?:_CURRENT)?_BINARY_DIR\}/")
# What is stored of headers that are not known: the folder that is installed.
_INSTALLED_FOLDER = re.compile(r"`[^`]*/(\w+)/?` is installed")
# Debian packages that hold a library alone, which are called after its version: `libtinyxml2-6`, `libzmq5t64`.
_LIBRARY = re.compile(r"lib.*\d(?:[a-z]|v5|t64|ldbl)?")
# Folders that are not called after what they hold.
_PLAIN_FOLDERS = frozenset(("include", "src", "lib"))


def _may_be_called_after(name: str, wanted: str) -> bool:
    """Whether a library's package may be called after what is wanted of it. A package that carries one library is
    called after all of the library's name; a release of many may be called after its beginning."""
    whole, stem = _find_stems(wanted)
    if name.endswith("_vendor"):
        return len(whole) >= SHORTEST_NAME and whole in name.replace("_", "")
    return len(stem) >= SHORTEST_NAME and stem in name


@lru_cache(maxsize=4096)
def _find_stems(wanted: str) -> tuple[str, str]:
    """The letters of the first part of something wanted, and the first of them that stand together."""
    first = re.split(r"/|::", wanted.lower())[0]
    return re.sub(r"[^a-z]", "", first), re.split(r"[^a-z]", wanted.lower())[0]


class UnknownContents:
    """What may be there for the packages of a workspace on one target although nobody is known to have it."""

    def __init__(self, view: WorkspaceOnTarget):
        self._view = view

    def may_hold(self, package: Package, wanted: str, providers: tuple[Provider, ...] = ()) -> bool:
        """Whether something that a package lacks may be there all the same. wanted: a header, CMake package, target,
        library or other package; for a variable, what it is called after. providers: who is known to have it."""
        return (
            self.may_come_along(package, wanted, providers)
            or bool(self.list_opaque(package))
            or any(name != wanted for name in self.list_unknown_found(package))
            or self.is_likely(package, wanted)
        )

    def may_come_along(self, package: Package, wanted: str = "", providers: tuple[Provider, ...] = ()) -> bool:
        """Whether something may come along by dependencies that are not known: those of a package that no index has, of
        the members of a group, or of a release whose manifest is not known. Packages that are called as those of
        interfaces are bring only others of them, and what they run with."""
        unknown = self._list_unknown_along(package)
        if wanted and not INTERFACES.search(wanted) and wanted not in self._with_interfaces:
            unknown = tuple(name for name in unknown if not INTERFACES.search(name))
        grouped = any(dependency.kind == "group" for dependency in package.manifest.dependencies)
        if grouped or any(name != wanted for name in unknown):
            return True
        return bool(providers) and self._view.is_met(providers, self._view.may_bring(package))

    def is_likely(self, package: Package, wanted: str) -> bool:
        """Whether something wanted is most likely there, since something of unknown contents is called after it: made
        apart, or coming along as the release of a library that is built with plain CMake or Meson, or that a package of
        ROS carries (`mrpt2`, `sdformat_vendor`), or one that no index has (`glog_catkin`), or a declared release whose
        files are not stored, or a key of which nobody knows what it brings."""
        unknown = (*self._list_of_unknown_contents(package), *self.list_opaque(package))
        return self.is_made_apart(package, wanted) or any(_may_be_called_after(name, wanted) for name in unknown)

    def may_install_folder(self, package: Package, header: str) -> bool:
        """Whether a declared release installs a folder of headers that its build makes, called as that of a header."""
        folder, within, _ = header.partition("/")
        return bool(within) and folder in self._list_made_folders(package)

    @cache_method
    def _list_made_folders(self, package: Package) -> frozenset[str]:
        view = self._view
        names = (name for name in view.collect_declared(package) if name not in view.workspace.packages)
        offers = (offer for name in names if (offer := view.offers.find_package(name)) is not None)
        whys = (why for offer in offers for part, why in offer.build.unknown if part == "headers")
        return frozenset(found[1] for why in whys if (found := _INSTALLED_FOLDER.match(why)))

    @cache_method
    def _list_of_unknown_contents(self, package: Package) -> list[str]:
        unknown = {*self._list_unknown_along(package), *self.list_unread(package)}
        names = self._view.build_environment(package)
        return [name for name in names if name in unknown or self.is_carried_library(name)]

    @cache_method
    def list_unread(self, package: Package) -> tuple[str, ...]:
        """Declared releases of the target whose files are not stored, so that they may install what they bundle, and
        under names of their own, and packages of the workspace, the package among them, whose build downloads
        something or calls the build of something else. Packages that are called as those of interfaces are install no
        more than these."""
        view = self._view
        declared = view.collect_declared(package)
        building = (one for one in view.workspace.packages.values() if one.build.builds_others)
        near = view.build_environment(package)
        return (
            *(one.name for one in building if one.name == package.name or one.name in near),
            *(
                name for name in declared
                if name not in view.workspace.packages and not INTERFACES.search(name)
                and view.target.find_version(name) is not None and view.offers.find_package(name) is None
            ),
        )  # fmt: skip

    def is_made_apart(self, package: Package, wanted: str) -> bool:
        """Whether something, or its folder, is called after what the build of a package downloads, or after a folder
        that was not read, such as a submodule."""
        made = self._list_made_apart(package)
        return bool(made) and any(part.startswith(made) for part in re.split(r"/|::", wanted.lower()))

    def may_make_target(self, package: Package, name: str) -> bool:
        """Whether a target of a system library may come from something else than its own configuration: a find module,
        its own or of a package that is found."""
        space = strip_separators(name.partition("::")[0])
        named = [f.name for f in package.build.found if f.how == "find_package" and strip_separators(f.name) == space]
        return (
            not named
            or bool(package.build.unresolved)
            or self.is_made_apart(package, name)
            or any(f"Find{one}" in MODULES or one in self._view.workspace.find_modules for one in named)
            or any(provider.kind == "ros" for one in named for provider in self._view.find_cmake(one)[:1])
        )

    def may_define_target(self, package: Package, item: str, found: Collection[str]) -> bool:
        """Whether something else than find_package() of its namespace may define a target: the configuration of a
        library that is found, a package that shares the namespace, or what cannot be read. found: with all that comes
        along."""
        space, _, target = item.partition("::")
        view, build, providers = self._view, package.build, self._view.find_cmake(space)
        if not providers or build.unresolved or view.is_met(providers, found):
            return True
        if view.is_package(space):
            offer = view.offers.find_package(space)
            if offer is None:
                return space not in view.workspace.packages or (target != space and view.is_package(target))
            return item not in {one.name for one in offer.build.targets}
        letters = strip_to_letters(space)
        sought = {n for f in build.found if not is_for_tests(f.conditions) for n in (f.name, f.prefix)}
        alike = (letters in name or name in letters for name in filter(None, map(strip_to_letters, sought)))
        if calls_unmodelled(build) or any(alike):
            return True
        bringing = view.apt.list_bringing(frozenset(p.package for p in providers if p.package))
        return any(not bringing.isdisjoint(view.list_debs(name)) for name in found)

    def may_build_library(self, package: Package, name: str) -> bool:
        """Whether a package that comes along is called like the library of a target, so that it may have another
        version of it."""
        space = strip_separators(name.partition("::")[0])
        along = self._view.list_transitive(f.name for f in package.build.found if f.how == "find_package")
        return any(space in strip_separators(one) for one in along if self._view.is_package(one))

    def list_opaque(self, package: Package) -> tuple[str, ...]:
        """Declared keys whose contents and own dependencies are not known, since no archive of the platform has them
        (Gazebo and its metapackages come from their own): they may bring any system library."""
        return self._list_opaque_along(self._view.build_environment(package))

    def list_unknown(self, names: frozenset[str]) -> tuple[str, ...]:
        """Those of the names whose dependencies are not known anywhere."""
        view, target = self._view, self._view.target
        return tuple(
            n for n in names
            if n not in view.workspace.packages and n not in view.preinstalled and target.resolve(n) is None
            and not target.knows_key(n)  # a key that the platform lacks brings nothing
            and target.list_dependencies(n) is None and target.list_similar(n) is None
            and not target.is_other_generation(n)  # nor does a package that cannot be had
        )  # fmt: skip

    @cache_method
    def list_unknown_found(self, package: Package) -> tuple[str, ...]:
        """What CMake finds and nobody is known to provide, so that it may find anything else in turn."""
        view, modules = self._view, self._view.workspace.find_modules
        found = {f.name for f in package.build.found if f.how in FINDING and view.applies(f.conditions)}
        # Of what is declared, ament_auto looks for keys too, which are no packages of CMake.
        keys = {f.name for f in package.build.found if f.how == "declared" and self._is_known_key(f.name)}
        return tuple(
            name for name in found - keys if "$" not in name and name not in modules and not view.find_cmake(name)
        )

    def _is_known_key(self, name: str) -> bool:
        """Whether a name is a rosdep key whose packages' contents are all known."""
        debs = () if self._view.is_package(name) else self._view.list_debs(name)
        return bool(debs) and all(self._view.apt.knows(debian) for debian in debs)

    @cache_method
    def _list_unknown_along(self, package: Package) -> tuple[str, ...]:
        return self.list_unknown(self._view.build_environment(package))

    @cached_property
    def _with_interfaces(self) -> frozenset[str]:
        return self._view.list_transitive(_WITH_INTERFACES)

    @cache_method
    def _list_made_apart(self, package: Package) -> tuple[str, ...]:
        """How names begin of what a package downloads, and of its folders that were not read. A download is called
        after its project, or one of the folders that it fills in the build is."""
        workspace, build = self._view.workspace, package.build
        folder = f"{package.path}/" if package.path else ""
        unread = {path for path in workspace.unread if path.startswith(folder)}
        downloads = [target.name for target in build.targets if target.kind in ("external", "fetched")]
        given = (*build.links, *build.target_links)
        searched = {one for one, _ in build.include_dirs}.union(link.item for link in given)
        unread.update(one for one in searched if unread and "$" not in one and workspace.is_unread(one))
        filled = [one for one in searched if downloads and _IN_BUILD.match(one)]
        names = {part for path in (*unread, *filled) for part in path.removeprefix(folder).split("/")}
        names.update(downloads, *(re.split(r"[-_]", name) for name in downloads))
        first = (re.match(r"[a-z0-9]+", name.lower()) for name in names - _PLAIN_FOLDERS)
        return tuple({one.group() for one in first if one and len(one.group()) >= SHORTEST_NAME})

    @cache_method
    def _list_opaque_along(self, names: frozenset[str]) -> tuple[str, ...]:
        return tuple(n for n in names if n not in self._view.workspace.packages and self._is_opaque(n))

    @cache_method
    def _is_opaque(self, name: str) -> bool:
        bringing = [] if name.startswith("python") else list(self._list_bringing(name))
        return bool(bringing) and (
            name.startswith("gazebo") or not self._view.providers.knows_system([name, *bringing])
        )

    def _list_bringing(self, key: str) -> Iterator[str]:
        """The packages of a key that may bring libraries: those for development, Gazebo's, and collections of no
        archive that was read."""
        for debian in self._view.list_debs(key):
            collects = not _LIBRARY.fullmatch(debian) and not self._view.apt.knows(debian)
            if collects or debian.endswith("-dev") or debian.startswith("gazebo"):
                yield debian

    @cache_method
    def is_carried_library(self, name: str) -> bool:
        """Whether a package that is not of the workspace is another project's library, whose installed files are not
        all stored: built with plain CMake or Meson, or a package that carries it."""
        view = self._view
        if name in view.workspace.packages:
            return False
        types = {one.partition(":")[0] for one in view.target.build_type(name).split(";")}
        plain = view.target.find_version(name) is not None and not types.isdisjoint(("cmake", "meson"))
        return plain or name.endswith("_vendor")
