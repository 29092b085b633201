"""A workspace on one target: what holds there, what is declared there, who provides what is used."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property, lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

from msgspec import structs

from ...edges.groups import group_pairs
from ...edges.memory import cache_method
from ...edges.reach import Reach, TransitiveNames, walk
from ..conditions import Environment, evaluate_all
from ..config import Config
from ..facts.condition import Condition
from ..facts.manifest import Dependency
from ..facts.repositories import ListedRepository, fold_repository
from ..targets.availability import Availabilities, Availability, Horizon, Symbol, list_horizons
from ..targets.changes import DISTROS
from ..targets.distro.distro import DistroTarget, ReleasedDependency
from ..targets.evidence_record import Evidence
from ..targets.providers import message_headers
from ..targets.providers.apt import Apt, load_apt
from ..targets.providers.includes import HeadersOfMachine, load_machine, make_machine
from ..targets.providers.libraries import load_libraries
from ..targets.providers.library import check_version, find_default_standard, get_year, include_roots, name_library
from ..targets.providers.providers import Providers
from ..targets.providers.stdlib import is_in_stdlib, was_ever_in_stdlib
from ..targets.surface.offers import Offers
from ..targets.target import Provider
from ..targets.version import is_at_least
from .cmake.build import At, select_active
from .cmake.names import MODULES, SINCE
from .misspelling import SpellingIndex
from .package import ReferenceUse
from .python.api import find_python_packages
from .workspace import Package, Workspace

# Dependency kinds whose packages a machine has once the package itself is installed (bloom's mapping to Debian's
# Depends).
_INSTALLED_WITH = frozenset({"exec", "build_export", "buildtool_export"})
# Kinds that are on the machine that builds the package from source.
_BUILT_WITH = frozenset({"build", "buildtool", "build_export", "buildtool_export", "exec", "test", "doc"})


SHORTEST_NAME = 3
"""Letters of a name by which something else is called after it."""
# How packages are called (REP 144).
PACKAGE = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)+\Z")
# How packages of interfaces are called.
INTERFACES = re.compile(r"_(?:msgs?|messages|srvs|actions|interfaces)\Z")

# Metapackages whose name other packages' headers begin with (ros/ros.h is roscpp's).
_UMBRELLAS = frozenset({"ros", "moveit", "ecl", "pcl", "opencv2", "gazebo", "boost", "rtt", "visp", "flann"})
# Headers that the package's build writes from templates in some releases.
_GENERATED = ("rclcpp/node_interfaces/", "rclcpp/logging.hpp")
# System packages so broad that they bring half of ROS along.
_BROAD = frozenset({"mrpt"})
# Debian packages of libraries and modules: what installs none of them is programs and data alone.
_LIBRARIES = re.compile(r"lib|python|.*-dev\Z")
_UNCONFIGURED = Config()
# What may be known by its identity as long as it is kept, since it does not change.
_LASTING = (frozenset, MappingProxyType)


class UnresolvedUse(NamedTuple):
    """What a package uses and nobody is known to have. kind: cmake, include, import or shared
    library, which is of no package."""

    package: str
    kind: str
    name: str


class WorkspaceOnTarget:
    """One workspace on one target. providers answers for everything outside the workspace. asked: the distros of all
    targets of the same run, each of which has a view of its own."""

    def __init__(
        self,
        workspace: Workspace,
        target: DistroTarget,
        providers: Providers,
        config: Config = _UNCONFIGURED,
        asked: frozenset[str] = frozenset(),
    ):
        self.workspace, self.target, self.providers, self.config = workspace, target, providers, config
        self.asked = asked
        # Names of the packages that rules are to report on, all when None.
        self.part: frozenset[str] | None = None
        # By name, it and what comes along with it, and with what may come along.
        self._whole = TransitiveNames(self.list_installed_with)
        self._widest = TransitiveNames(self._list_possibly_with)
        self._answered: dict[tuple[int, int], tuple[object, object, bool]] = {}
        self._reached: dict[int, tuple[object, frozenset[str], frozenset[str], frozenset[str]]] = {}
        self._outward_sets: dict[tuple[int, int], tuple[frozenset[str], frozenset[str]]] = {}
        self._reach_of_headers = Reach(self._look_at_header)
        # Of what was reached: headers of the workspace, and with them those that it generates.
        self._own_headers = self._owned = 0
        # What others worked out about it, see cache_in_derived().
        self.derived: dict[Any, Any] = {}
        self.unresolved: set[UnresolvedUse] = set()

    def __iter__(self) -> Iterator[Package]:
        """Packages that are built on this target and that rules are to report on: all of them, or those of `part`."""
        for package in self.list_built():
            if self.reports_on(package.name):
                yield package

    def reports_on(self, name: str) -> bool:
        """True for packages that rules are to report on; the others are there to be looked at."""
        return self.part is None or name in self.part

    def list_built(self) -> Iterator[Package]:
        """All packages of the workspace that are built on this target, as they are built there."""
        return map(self._select_active, filter(self.builds, self.workspace))

    @cache_method
    def _select_active(self, package: Package) -> Package:
        """A package without what its CMake surely does not do on this target."""
        build = select_active(package.build, self.applies)
        references = self._select_references(package.linked.references)
        if build is package.build and references is package.linked.references:
            return package
        return Package(structs.replace(package.linked, references=references), build)

    def _select_references(self, references: tuple[ReferenceUse, ...]) -> tuple[ReferenceUse, ...]:
        """Without those that surely do not count on this target, and with those as unconditional that surely do."""
        if not any(use.reference.conditions for use in references):
            return references
        kept = []
        for use in references:
            conditions = use.reference.conditions
            if self.applies(conditions):
                if conditions and self.is_sure(conditions):
                    use = structs.replace(use, reference=structs.replace(use.reference, conditional=False))
                kept.append(use)
        return tuple(kept)

    def builds(self, package: Package) -> bool:
        """False for a package that is built with the tools of the other generation of ROS."""
        return package.build_type != "catkin" if self.target.ros == 2 else not package.build_type.startswith("ament")

    @cached_property
    def environment(self) -> Environment:
        """What conditions are evaluated against."""
        return self._make_environment(self.target)

    @cache_method
    def _make_environment(self, target: DistroTarget) -> Environment:
        def find_version(name: str) -> str | None:
            return target.find_version(name) or target.find_library(name.lower())

        return Environment(
            ros_distro=target.distro,
            ros_version=str(target.ros),
            python=(2, 7) if target.python_major == 2 else (3, target.python) if target.python else None,
            codename=target.platform.split(" ")[-1],
            versions=find_version,
            packages=lambda name: self._has_package(name, target),
            headers=self._has_header if target is self.target else lambda path: None,
            testing=True,
            gone=lambda kind, name: self._is_gone(kind, name, target),
        )

    def _has_package(self, name: str, target: DistroTarget) -> bool | None:
        """Whether a package is there, on a target or in the workspace; None for names that no package ever had."""
        if name in self.workspace.packages or target.find_version(name) is not None:
            return True
        return False if target.was_ever_released(name) else None

    def _is_gone(self, kind: str, name: str, target: DistroTarget) -> bool:
        """Whether known changes tell that a target has a package, or a command of CMake, no longer."""
        if kind == "package" and (self._has_package(name, target) or target.resolve(name) is not None):
            return False
        reviewed = Availabilities(target, ahead=()).find_reviewed(kind, name)
        return any(found.state == "removed" for found in reviewed)

    def _has_header(self, path: str) -> bool | None:
        """Whether the compiler finds a header on the target, for __has_include; None when that is not known."""
        if self.workspace.provides_header(path):
            return True
        states = {found.state for found in self.find_reviewed("header", path)}
        if not states.isdisjoint(("removed", "deprecated")):
            return "deprecated" in states
        if (replacing := self.availabilities.has_replacing_header(path)) is not None:
            return replacing
        known = {*self._find_releases_having(path, self.find_header(path)).values()}
        if True in known or known == {False}:
            return True in known
        found = self.find_header_availability(path)
        if found is None or found.state == "unknown" or (found.is_missing and not found.sure):
            return None
        return not found.is_missing

    def applies(self, conditions: Iterable[Condition]) -> bool:
        """False only when a statement under these conditions surely does not count on the target."""
        conditions = tuple(conditions)
        return not conditions or self._hold(conditions) is not False

    def is_sure(self, conditions: Iterable[Condition]) -> bool:
        """True only when a statement under these conditions surely counts on the target."""
        conditions = tuple(conditions)
        return not conditions or self._hold(conditions) is True

    @cache_method
    def _hold(self, conditions: tuple[Condition, ...]) -> bool | None:
        return evaluate_all(conditions, self.environment)

    def find_standard(self, package: Package) -> tuple[int, At] | None:
        """The highest C++ standard that a package sets for everything on this target, and where."""
        build = package.build
        held = [(number, at) for number, at, conditions in build.standards if self.applies(conditions)]
        return max(held, key=lambda entry: get_year(entry[0])) if held else None

    @cache_method
    def compute_language(self, package: Package) -> int:
        """The year of the highest C++ standard that a part of a package may be compiled under on this target, as far
        as the workspace tells: what it sets itself or packages that it finds do, C++17, or the compiler's default."""
        years = [2017, find_default_standard(self.target) or 2017]
        for name in {package.name, *self.list_transitive(found.name for found in package.build.found)}:
            own = self.workspace.packages.get(name)
            if own is not None:
                years.extend(get_year(number) for number, *_ in own.build.standards)
                years.extend(get_year(max(t.standard, t.public_standard)) for t in own.build.targets)
        return max(years)

    def compute_asked_language(self, package: Package, offers: Offers) -> int:
        """The same, and what the released packages ask for that come along with those which it finds. offers: those of
        the target, or of the newest distro, where other packages may come along."""
        found = self.list_transitive(found.name for found in package.build.found) - self.workspace.packages.keys()
        if offers.target is not self.target:
            found = frozenset(walk(found, lambda name: _list_installed_with(offers.target.list_dependencies(name))))
        return max(self.compute_language(package), *(get_year(offers.find_standard(name)) for name in found), 0)

    def is_built(self, role: str) -> bool:
        """True for code that is built or run wherever the package is: colcon builds tests along, catkin on request."""
        return role in ("build", "run") or (role == "test" and self.target.ros == 2)

    def is_declaration_active(self, condition: str) -> bool:
        """False only when the condition attribute of a dependency surely does not hold on the target."""
        return not condition or self.applies((Condition("manifest", condition),))

    def list_dependencies(self, package: Package) -> Iterator[Dependency]:
        """What the manifest of a package declares on this target to be installed."""
        for dependency in package.manifest.dependencies:
            installed = dependency.kind not in ("conflict", "replace", "group", "member_of_group")
            if installed and self.is_declaration_active(dependency.condition):
                yield dependency

    def find_place(self, package: Package, dependency: Dependency | str) -> At:
        """Where a dependency is declared, or the first of a name."""
        if isinstance(dependency, str):
            dependency = next(one for one in package.manifest.dependencies if one.name == dependency)
        return At(package.linked.manifest_path, dependency.line, dependency.column)

    @cached_property
    def known_names(self) -> SpellingIndex:
        """Every name a manifest may declare here: packages of the workspace, released ones, rosdep keys."""
        return SpellingIndex({*self.workspace.packages, *self.target.list_released(), *self.target.list_keys()})

    def is_available(self, name: str) -> bool:
        """True when a package of this name is in the workspace, released on the target, or a rosdep key there."""
        target = self.target
        return (
            name in self.workspace.packages or target.find_version(name) is not None or target.resolve(name) is not None
        )

    @cached_property
    def machine(self) -> HeadersOfMachine:
        """The headers that the target has, see targets/includes.py."""
        return make_machine(self.target)

    @cached_property
    def offers(self) -> Offers:
        """What the released packages offer here, beside what other versions of them do."""
        return Offers(self.target)

    @cached_property
    def later_offers(self) -> Offers:
        """What they offer on the newest distro, see newest; here where there is none."""
        return Offers(self.newest) if self.newest is not None else self.offers

    @cached_property
    def own_modules(self) -> frozenset[str]:
        """Top-level Python modules that packages of the workspace bring, or may bring."""
        names = self.workspace.packages
        found = {*names, *(name.removesuffix("_py") for name in names), *self.workspace.unread_names}
        for package in self.workspace:
            found |= find_python_packages(package.linked.files)
        return frozenset(found)

    @cached_property
    def newest(self) -> DistroTarget | None:
        """The newest long-term distro of this generation; None when this target is it or newer, or when it is asked for
        itself, so that its own view tells of it."""
        newest = self.target.find_newest()
        return None if newest is None or newest.distro in self.asked else newest

    @cached_property
    def later_machine(self) -> HeadersOfMachine | None:
        """Those of the newest long-term distro, see newest."""
        newest = self.newest
        return load_machine(newest.distro, newest.ros) if newest is not None else None

    @cached_property
    def earlier_machines(self) -> tuple[HeadersOfMachine, ...]:
        """Those of the earlier distros of the same generation, newest first."""
        first, last = DISTROS["ardent" if self.target.ros == 2 else "groovy"], DISTROS.get(self.target.distro, 0)
        earlier = [name for name, place in DISTROS.items() if first <= place < last]
        return tuple(load_machine(name, self.target.ros) for name in reversed(earlier))

    @cache_method
    def find_outward(self, paths: tuple[str, ...]) -> tuple[frozenset[str], frozenset[str]]:
        """What these include paths bring along in the workspace: paths of other places, and of its own headers; those
        that it generates from interfaces are among both."""
        return self._find_outward_by_masks(*self._reach_of_headers.collect_masks(paths))

    def _find_outward_by_masks(self, reached: int, along: int) -> tuple[frozenset[str], frozenset[str]]:
        """What outward() says where an include leads to these headers. One answer is one object, so that joins of it
        are found again at once."""
        masks = reached & ~self._own_headers, reached & self._owned | along
        known = self._outward_sets.get(masks)
        if known is None:
            found, own = (frozenset(self._reach_of_headers.list_names(mask)) for mask in masks)
            known = self._outward_sets[masks] = found, own
        return known

    def _look_at_header(self, path: str) -> tuple[list[str], list[str]]:
        """What an include path leads to, and the paths of its files as others write them."""
        bit, files = self._reach_of_headers.assign_bit(path), self._list_header_files(path)
        inner = () if files else self._list_generated_includes(path)
        if files:
            self._own_headers |= bit
        if files or inner:
            self._owned |= bit
        leads = list(inner)
        for file in files:
            leads += self._outward.get(file, ())
            leads += self._inner.get(file, ())
        return leads, [f"/{file}".rpartition("/include/")[2] for file in files]

    @cache_method
    def _list_generated_includes(self, path: str) -> tuple[str, ...]:
        """The generated headers that one which the workspace generates includes, itself first; none for others."""
        package, inner = message_headers.find_package(path, self.target.ros), None
        if package is not None and package in self.workspace.packages:
            interfaces = self._collect_own_interfaces(package)
            inner = message_headers.list_included(path, self.target.ros, interfaces, self._parts_apart)
        return () if inner is None else (path, *inner)

    @cache_method
    def _collect_own_interfaces(self, package: str) -> message_headers.Definitions:
        """The interfaces of a package of the workspace, by `msg/Name`."""
        known = message_headers.Definitions()
        for file in self.workspace.packages[package].linked.interfaces:
            made = file.definition
            folder = made.module.rpartition("/")[2] if made.kind == "idl" else made.kind
            known[f"{folder}/{file.name}"] = made
        return known

    @cached_property
    def _parts_apart(self) -> bool:
        """Whether the parts of a generated header lie in a folder of their own."""
        return is_at_least(self.target.find_version("rosidl_generator_cpp") or "0.9.0", "0.9.0")

    @cache_method
    def _list_header_files(self, path: str) -> tuple[str, ...]:
        """The headers of the workspace that an include path names; a file's own path names itself."""
        if path in self._header_files:
            return (path,)
        ending, found = "/" + path.lstrip("./"), []
        for provider in self.find_header(path):
            package = self.workspace.packages.get(provider.name) if provider.kind == "ros" else None
            if package is not None:
                found.extend(h for h in package.linked.headers if h.removesuffix(".in").endswith(ending))
        return tuple(found)

    @cached_property
    def _header_files(self) -> frozenset[str]:
        return frozenset(h for package in self.workspace for h in package.linked.headers)

    @cached_property
    def _inner(self) -> dict[str, tuple[str, ...]]:
        return {path: inner for package in self.workspace for path, inner in package.linked.inner}

    @cached_property
    def _outward(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = {}
        for package in self.workspace:
            for use in package.linked.includes:
                if use.at.path in self._header_files:
                    found.setdefault(use.at.path, []).append(use.path)
        return found

    def find_successor(self, name: str) -> str:
        """What the known-changes table says to use instead of a package; empty when it says nothing."""
        found = (one.replacement for one in self.find_reviewed("package", name) if one.state != "upcoming")
        return next((f"depend on `{replacement}`" for replacement in found if replacement), "")

    @property
    def underlaid(self) -> bool:
        """True when the configuration names underlays or .repos files, whose packages are not looked into."""
        return bool(self.config.underlays or self.config.repos)

    def is_private(self, name: str) -> bool:
        """True for packages that the configuration calls one's own, or has on every machine."""
        return name in self.config.private or name in self.config.installed

    @cache_method
    def is_program(self, name: str) -> bool:
        """True for a rosdep key that installs programs alone, so that CMake means something else by its name."""
        debs = self.list_debs(name)
        return bool(debs) and not any(map(_LIBRARIES.match, debs)) and not self.find_cmake(name)

    def means_package(self, name: str) -> bool:
        """Whether a name that is a rosdep key too stands for a package: code of the workspace includes headers below a
        folder called so, and none of them is known of anything."""
        includes = (one.path for package in self.workspace for one in package.linked.includes)
        below = {path for path in includes if path.startswith(f"{name}/")}
        return bool(below) and not any(map(self.find_header, below))

    @cached_property
    def installed(self) -> frozenset[str]:
        """Packages and rosdep keys that every machine has by the configuration, and what is installed with them."""
        return self.list_transitive(self.config.installed)

    @cache_method
    def is_standard(self, header: str) -> bool:
        """True for headers of the C and C++ standard libraries and of the operating system."""
        return any(not p.name for p in self.providers.find_header(header))

    def find_header_availability(self, path: str, conditions: Iterable[Condition] = ()) -> Availability | None:
        """How the target stands to a header of released packages; None where something else may have it. conditions:
        as in find_availability()."""
        providers = self.find_header(path)
        owners = [p.name for p in providers if p.kind == "ros" and p.name not in self.workspace.packages]
        if not owners or len(owners) < len(providers) or any(self.has_nested_header(owner, path) for owner in owners):
            return None
        return self.find_availability(Symbol("header", path, tuple(owners)), conditions)

    @cache_method
    def find_lost_header(self, path: str) -> Availability | None:
        """How the target stands to a header that every released package which has, or had, it lacks in its version
        here, where find_header_availability() does not tell. Its form is `broken` where the workspace names it and
        nobody makes it, `platform` where nobody is known to have it, so that whatever brings unknown contents may,
        `nested` where it is installed under another path."""
        target, symbol = self.target, Symbol("header", path)
        if path in self.workspace.broken_headers:
            # A package that was split may share its folder of headers with another.
            others = (p.name for p in self.providers.find_header(path) if p.sure)
            known = any(name not in self.workspace.packages for name in others)
            return None if known else Availability(symbol, "removed", form="broken")
        if self.providers.has_system_header(path, target.platform) is False and all(
            p.kind == "system" for p in self.find_header(path)
        ):
            return Availability(symbol, "removed", target.platform, form="platform")
        owners = [p.name for p in self.find_header(path) if p.kind == "ros" and not self.may_have(p.name)]
        if not owners or any(p.kind != "ros" for p in self.find_header(path)):
            return None
        lacking = [(name, version) for name in owners if (version := target.find_version(name)) is not None]
        if not lacking or any(self.has_released_header(name, path) is not False for name, _ in lacking):
            return None
        name, version = lacking[0]
        if any(self.has_nested_header(owner, path) for owner, _ in lacking) or path.startswith(_GENERATED):
            return None
        if not self.providers.has_headers(name, target.distro, version):
            return None  # a release without any header in its tree gets them while it is built
        if not self.providers.list_header_spans(name, path):
            head, _, rest = path.partition("/")
            if rest.startswith(head + "/") and self.has_released_header(name, rest):
                return Availability(symbol, "removed", name, version, replacement=rest, form="nested")
            return None
        other = self._find_renamed(name, path)
        evidence = Evidence(name, "removed", path, other, "header", header=path)
        return Availability(symbol, "removed", name, version, replacement=other, evidence=evidence)

    def has_released_header(self, package: str, path: str) -> bool | None:
        """Whether the target's release of a package has a header; None when its tree is not known."""
        version = self.target.find_version(package)
        return self.providers.has_header(package, path, self.target.distro, version) if version else None

    def may_have_released_header(self, package: str, path: str) -> bool:
        """The same, or where the tree of the target's release is not known, whether that of the newest which is has."""
        version = self.target.find_version(package)
        if not version:
            return False
        found = self.has_released_header(package, path)
        return self.providers.has_kept_header(package, path, self.target.distro, version) if found is None else found

    def _find_releases_having(self, path: str, providers: Iterable[Provider]) -> dict[str, bool | None]:
        """The same by the packages among providers that the target has."""
        named = (p.name for p in providers if p.kind == "ros" and self.target.find_version(p.name))
        return {name: self.has_released_header(name, path) for name in named}

    def has_nested_header(self, package: str, path: str) -> bool:
        """True when the release has the header in a subfolder that it exports too (xmlrpcpp/XmlRpc.h as XmlRpc.h)."""
        return "/" not in path and bool(self.has_released_header(package, f"{package}/{path}"))

    def _find_renamed(self, name: str, path: str) -> str:
        """The same header under another ending that the release has."""
        others = (path.rpartition(".")[0] + ending for ending in (".hpp", ".h", ".hh"))
        return next((other for other in others if other != path and self.has_released_header(name, other)), "")

    @cache_method
    def list_around(self, path: str) -> frozenset[str]:
        """Who could answer an include path, all that is installed along with them, and the platform libraries that
        these names stand for; empty when nobody could."""
        names = self.list_transitive(provider.name for provider in self.find_header(path))
        return names.union(*map(self.list_libraries, names))

    @cache_method
    def list_libraries(self, name: str) -> list[str]:
        """Platform libraries whose version a rosdep key or CMake name stands for."""
        folded = name.lower().removeprefix("lib").removesuffix("-dev").removesuffix("-all")
        known = self._library_names
        return [n for n in dict.fromkeys((name.lower(), folded, folded.rstrip("0123456789"))) if n in known]

    @cache_method
    def list_components(self, package: str) -> dict[str, bool]:
        """The components that the CMake package of a system library has in some version, as its configurations or
        targets tell them, each with whether the target has it; none where they are not known."""
        configured = self.providers.list_configured_components(package)
        if configured:
            return {name: self.target.platform in platforms for name, platforms in configured.items()}
        library = name_library(package)
        here = {version for version in load_libraries().find_range(library, self.target.platform) if version}
        known = load_libraries().list_components(library, package) if here else {}
        return {name: here <= versions for name, versions in known.items()}

    def find_library_version(self, package: str) -> str:
        """The version of the system library that a CMake package is of; empty where it is not known."""
        return self.target.find_library(name_library(package)) or ""

    @cached_property
    def _library_names(self) -> frozenset[str]:
        return self.target.list_library_names()

    def find_reviewed(self, kind: str, name: str) -> tuple[Availability, ...]:
        """What reviewed rows say of a name that is not as it was: what is in force on the target, then what is upcoming
        on the nearest horizon. kind: as of symbols, and `use`, whose name is the label."""
        return self.availabilities.find_reviewed(kind, name)

    @cached_property
    def horizons(self) -> tuple[Horizon, ...]:
        """What the target is going to be, soonest first; distros that are asked for themselves left out."""
        return list_horizons(self.target, self.asked)

    @cached_property
    def updates(self) -> tuple[tuple[Horizon, Availabilities], ...]:
        """Those of them that an update of this distro brings, with what is there then."""
        return tuple(one for one in self.availabilities.ahead if not one[0].platform)

    @cached_property
    def availabilities(self) -> Availabilities:
        """What of released packages and platform libraries is there."""
        return Availabilities(self.target, self.offers, self.providers, self.horizons)

    def may_have(self, name: str) -> bool:
        """Whether the workspace has a package, or may have it in a folder that was not read."""
        return name in self.workspace.packages or self.may_be_unread(name)

    @cache_method
    def may_be_unread(self, name: str) -> bool:
        """Whether a folder of the workspace that was not read may hold a package: a submodule most likely holds what is
        called after it, or comes from a repository that is called as it is, in a version of its own. So does a
        repository that is listed and not imported, unless its version is that of the distro."""
        listing = self.find_listing(name)
        if listing is not None and listing[1].version != self.target.distro:
            return True
        return self.may_be_in_submodule(name)

    @cache_method
    def find_listing(self, name: str) -> tuple[str, ListedRepository] | None:
        """The list of repositories for this target that names the repository of a package which is not imported, with
        what it says of that."""
        if not self.workspace.outside.listed or name in self.workspace.packages:
            return None
        urls = (ListedRepository("", url).names for url in self.target.list_repository_urls(name))
        homes = {fold_repository(each) for each in (name, *self.target.list_repositories(name))}.union(*urls)
        return next((one for one in self._missing_listings if not one[1].names.isdisjoint(homes)), None)

    @cached_property
    def _missing_listings(self) -> list[tuple[str, ListedRepository]]:
        """What lists for this target name that no folder of the workspace is called like."""
        here = {part for package in self.workspace for part in package.path.lower().replace("-", "_").split("/")}
        others = DISTROS.keys() - {self.target.distro}
        return [
            (path, one)
            for path, one in self.workspace.outside.listed
            if one.names.isdisjoint(here)
            and others.isdisjoint(re.split(r"[^a-z]+", path.lower()))
            and one.version not in others
        ]

    def may_be_in_submodule(self, name: str) -> bool:
        """The same of submodules and other folders that were not read alone."""
        unread = self.workspace.unread_names
        if any(is_called_after(name, folder) for folder in unread):
            return True
        return bool(unread) and not unread.isdisjoint(self.target.list_repositories(name))

    def find_availability(self, symbol: Symbol, conditions: Iterable[Condition] = ()) -> Availability:
        """How the target stands to something outside the workspace; what the workspace brings itself is there. What is
        to come counts where a use under these conditions does on that horizon too."""
        if symbol.kind != "component" and any(map(self.may_have, symbol.packages)):
            return Availability(symbol, "present")
        return self.availabilities.find_on_horizon(symbol, lambda ahead: self.is_active_on(ahead, conditions))

    def is_active_on(self, ahead: Horizon, conditions: Iterable[Condition]) -> bool:
        """False when a statement under these conditions surely does not count on a horizon."""
        return self._is_active_on(ahead.target, tuple(conditions))

    @cache_method
    def _is_active_on(self, target: DistroTarget, conditions: tuple[Condition, ...]) -> bool:
        return evaluate_all(conditions, self._make_environment(target)) is not False

    def is_active_later(self, conditions: Collection[Condition]) -> bool:
        """The same on the newest distro."""
        return not conditions or not self.newest or self._is_active_on(self.newest, tuple(conditions))

    @property
    def horizon(self) -> str:
        """Name of the newest distro of this generation, see newest."""
        newest = self.newest
        return newest.distro if newest is not None else ""

    def may_concern(self, package: Package, head: str, path: str, language: str = "") -> bool:
        """True when a file can mean a changed package by a name: the package declares or includes something of it, and
        the workspace does not hold it in a version of its own. head: the changed package. language: of the name."""
        if self.may_have(head):
            return False
        if path.endswith(".py") or language == "python":
            return True
        if self.takes_other_version(package, head):
            return False
        names = self.build_environment(package)
        if head in names or (any(head in (p.name, p.package) for p in self.find_cmake(head)) and head in names):
            return True
        roots = include_roots(head)
        return any(i.path.startswith(roots) for i in package.linked.includes) if roots else head in names

    @cache_method
    def takes_other_version(self, package: Package, library: str) -> bool:
        """Whether CMake is asked for a version of a library that another copy has than the one which it finds first."""
        answers = (
            check_version(self.target, found.name, found.version, found.exact)
            for found in package.build.found
            if found.version and name_library(found.name) == library and self.applies(found.conditions)
        )
        return any(each and each.holds and each.version != self.target.find_library(library) for each in answers)

    @cache_method
    def includes_library(self, package: Package, library: str) -> bool:
        """Whether a package includes a header of a library, by how its paths begin."""
        roots = include_roots(library)
        return bool(roots) and any(include.path.startswith(roots) for include in package.linked.includes)

    @cache_method
    def is_included_under_conditions(self, package: Package, library: str) -> bool:
        """Whether a package includes headers of a library only under conditions that may not hold, as where it carries
        a copy of its own beside the platform's."""
        roots = include_roots(library)
        found = [i for i in package.linked.includes if roots and i.path.startswith(roots)]
        return bool(found) and not any(self.is_sure(include.conditions) for include in found)

    @cache_method
    def collect_declared(self, package: Package) -> Mapping[str, set[str]]:
        """Names the package declares on this target, with the kinds they are declared as."""
        found = group_pairs((dependency.name, dependency.kind) for dependency in self.list_dependencies(package))
        return MappingProxyType({name: set(kinds) for name, kinds in found.items()})

    @cache_method
    def list_installed_with(self, name: str) -> tuple[str, ...]:
        """Direct dependencies that come with a package or key when it is installed."""
        package = self.workspace.packages.get(name)
        if package is not None:
            return tuple(n for n, kinds in self.collect_declared(package).items() if kinds & _INSTALLED_WITH)
        return _list_installed_with(self.target.list_dependencies(name) or self.target.list_similar(name))

    @cache_method
    def build_environment(self, package: Package) -> frozenset[str]:
        """Everything on a machine that has just what the package declares, the package itself included."""
        return self.list_transitive(self._list_built_with(package)).union(self.preinstalled, (package.name,))

    @cache_method
    def build_known_environment(self, package: Package) -> frozenset[str]:
        """The same, of what is in the workspace or released on the target alone: whether another distro's version of
        something that is not there brings anything is a guess."""

        def list_known(name: str) -> Iterable[str]:
            known = name in self.workspace.packages or self.target.list_dependencies(name) is not None
            return self.list_installed_with(name) if known else ()

        found = walk(self._list_built_with(package), list_known)
        return self.preinstalled.union(found, (package.name,))

    def _list_built_with(self, package: Package) -> list[str]:
        return [name for name, kinds in self.collect_declared(package).items() if kinds & _BUILT_WITH]

    @cached_property
    def brought_to_workspace(self) -> frozenset[str]:
        """Everything on a machine that has just what all packages of the workspace declare."""
        return frozenset().union(*(self.build_environment(package) for package in self.list_built()))

    @cached_property
    def apt(self) -> Apt:
        """What comes along with the platform's packages."""
        return load_apt(self.target.platform)

    @cached_property
    def preinstalled(self) -> frozenset[str]:
        """What the build farm puts on every machine besides the platform's compiler: the workspace of ROS 2."""
        return self.list_transitive(["ros_workspace"]) if self.target.ros == 2 else frozenset()

    @cache_method
    def may_bring(self, package: Package) -> frozenset[str]:
        """build_environment(), and all that packages whose manifests are not known for their version here bring in the
        next one that is, or in any distro: what is not in it is sure to be missing, unless something of
        unknown_contents may come along."""
        return self.list_widest_dependencies(self.build_environment(package))

    def list_widest_dependencies(self, names: Iterable[str]) -> frozenset[str]:
        """list_transitive(), and all that packages whose manifests are not known for their version here bring
        in the next one that is, or in any distro."""
        return self._widest.collect(names)

    @cache_method
    def _list_possibly_with(self, name: str) -> Iterable[str]:
        if name in self.workspace.packages:
            return self.list_installed_with(name)
        if self.target.list_dependencies(name) is None:
            return self.target.list_possible(name)
        return self.target.list_later_dependencies(name).union(self.list_installed_with(name))

    def list_transitive(self, names: Iterable[str]) -> frozenset[str]:
        """These names and everything that is installed along with them."""
        return self._find_transitive(frozenset(names))

    @cache_method
    def _find_transitive(self, names: frozenset[str]) -> frozenset[str]:
        return self._whole.collect(names)

    @cache_method
    def list_debs(self, name: str) -> frozenset[str]:
        """What a rosdep key installs here."""
        resolution = self.target.resolve(name)
        return frozenset(resolution.packages if resolution else ())

    def is_for_other_python(self, name: str) -> bool:
        """Whether a rosdep key installs modules of the other Python than the one that the target runs ROS with."""
        other = "python-" if self.target.python_major >= 3 else "python3-"
        debs = () if self.is_package(name) else self.list_debs(name)
        return bool(debs) and all(debian.startswith(other) for debian in debs)

    def is_met(self, providers: tuple[Provider, ...], names: Collection[str]) -> bool:
        """True when one of the providers is among the names, as itself, as a key that installs the same package, or
        another version of it that no list of files tells of, or as the package that vendors it."""
        if not isinstance(names, _LASTING) or type(providers) is not tuple:
            return self._is_answered(providers, names)  # they may change until they are asked again
        # Asked of the same two again and again; both are kept, so that no other object gets their ids.
        key = id(providers), id(names)
        known = self._answered.get(key)
        if known is None:
            known = self._answered[key] = (providers, names, self._is_answered(providers, names))
        return known[2]

    def _is_answered(self, providers: tuple[Provider, ...], names: Collection[str]) -> bool:
        for provider in providers:
            if not provider.name or provider.name in names or provider.name in self.installed:
                return True
        vendored, installed, unlisted = self._reach(names)
        for provider in providers:
            if unlisted and _strip_version(provider.package) in unlisted:
                return True
            if vendored and not vendored.isdisjoint(_list_stems(provider.name)):
                return True
            if provider.package in installed or not installed.isdisjoint(self.list_debs(provider.name)):
                return True
        return False

    def _reach(self, names) -> tuple[frozenset[str], frozenset[str], frozenset[str]]:
        """What a set of names vendors, the system packages that its keys install, and what those of them are called
        without a version whose contents are not known, such as those of another archive than the platform's."""
        known = self._reached.get(id(names))
        if known is None:
            vendored = frozenset(
                n.removesuffix("_vendor").removeprefix("rviz_") for n in names if n.endswith("_vendor")
            )
            installed = self.apt.base.union(
                *(self.apt.list_added(d) for n in names if n not in self.workspace.packages for d in self.list_debs(n)),
                *(self.apt.list_added(d) for n in self.installed for d in self.list_debs(n) or {n}),
            )
            given = (d for n in names if n not in self.workspace.packages for d in self.list_debs(n))
            versioned = ((d, plain) for d in given if (plain := _strip_version(d)) != d)
            unlisted = frozenset(plain for d, plain in versioned if not self.providers.knows_system((d,)))
            known = (names, vendored, installed, unlisted)
            if isinstance(names, _LASTING):
                self._reached[id(names)] = known
        return known[1:]

    @cache_method
    def find_header(self, path: str) -> tuple[Provider, ...]:
        """Who could answer an include path; empty when nobody is known to, a nameless one when the compiler does."""
        if "/" not in path and self.is_standard(path):
            return (Provider("system", ""),)
        own = self.workspace.provides_header(path)
        head = path.split("/", 1)[0]
        if (
            own
            and head not in own
            and self.target.was_ever_released(head)
            and (path not in (rooted := self.workspace.rooted_headers) or all(f"{o}/{path}" in rooted for o in own))
        ):
            own = []  # a file of the workspace ends like this by chance
        if own:
            return tuple(Provider("ros", name) for name in own)
        found = list(self.providers.find_header(path))
        if any(not p.name for p in found):
            return tuple(found)
        found = self._keep_having(path, self._keep_bringing(path, found))
        if "/" in path and not any(p.name == head for p in found) and self.is_package(head) and head not in _UMBRELLAS:
            convention = Provider("ros", head, "", False)
            if self.target.find_version(head) is not None or not found or head in self.workspace.packages:
                found.insert(0, convention)
            else:
                found.append(convention)
        # A key that only depends on the package which has the header can satisfy a need, and is never its name.
        return tuple(_drop_broad(found))

    def _keep_bringing(self, path: str, found: list[Provider]) -> list[Provider]:
        """Without the keys that bring the library of a header on other platforms than this one: whose packages were
        read, and neither have the header nor bring it along."""
        libraries = load_libraries()
        first = next((p.package for p in found if p.kind == "system"), "")
        own = libraries.find_by_package(first) if first else ""
        if not own or libraries.find_by_header(path) != own or not all(libraries.find_range(own, self.target.platform)):
            return found
        bringing = self.apt.list_bringing(libraries.list_packages(own))
        return [
            p
            for p in found
            if p.kind != "system"
            or p.package in bringing
            or not bringing.isdisjoint(names := self.list_debs(p.name) | {p.package})
            or not all(of := [libraries.find_by_package(name) for name in names])
            or any(libraries.has(library, path) for library in of)
        ]

    def _keep_having(self, path: str, found: list[Provider]) -> list[Provider]:
        """Without the packages whose version here surely lacks a header that another one's surely has: it moved."""
        if len(found) < 2:
            return found
        has = self._find_releases_having(path, (p for p in found if p.name not in self.workspace.packages))
        return [p for p in found if has.get(p.name) is not False] if True in has.values() else found

    def is_package(self, name: str) -> bool:
        """True when the workspace has a package of this name, or any distro ever released one."""
        return name in self.workspace.packages or self.target.was_ever_released(name)

    @cache_method
    def find_cmake(self, name: str) -> tuple[Provider, ...]:
        """Who could answer find_package(name)."""
        own = self.workspace.provides_cmake.get(name)
        found = [Provider("ros", own)] if own else []
        if not own:
            # `x-config.cmake` answers to any spelling of X, and ROS packages name theirs so, or with dashes.
            for spelling in dict.fromkeys((name, name.lower(), name.lower().replace("-", "_"))):
                if self.target.find_version(spelling) is not None or spelling in self.workspace.packages:
                    found.append(Provider("ros", spelling, "", "-" not in name or spelling == name))
            found.extend(self._find_cmake_elsewhere(name))
            if not found:
                # `gz-sim8` is what gz_sim_vendor brings.
                vendor = re.sub(r"\d+$", "", name).replace("-", "_").lower() + "_vendor"
                known = (n for n in (name, vendor) if self.target.was_ever_released(n))
                # What is called as packages of interfaces are is nothing else.
                found = [Provider("ros", n, "", n == name and INTERFACES.search(n) is not None) for n in known]
        return tuple(found)

    def _find_cmake_elsewhere(self, name: str) -> list[Provider]:
        known = self.providers.find_cmake(name)
        if name != name.lower():
            # `x-config.cmake` answers to any spelling of X.
            known = known + [p for p in self.providers.find_cmake(name.lower()) if p not in known]
        found = _drop_broad([p for p in known if p.name != name or p.kind != "ros"])
        modules = [p for p in found if p.sure and p.name in ("cmake_modules", "eigen3_cmake_module")]
        if modules and not self._has_find_module(name):
            # The library alone brings no find module of this name; catkin itself did until hydro.
            if self.target.distro in ("groovy", "hydro"):
                return [Provider("system", "")]
            configured = {
                *self.providers.find_installed_cmake(name),
                *self.providers.find_installed_cmake(name.lower()),
            }
            return [p for p in found if p.kind == "ros" or p in configured]
        return found

    def _has_find_module(self, name: str) -> bool:
        """Whether the target's CMake finds a package of this name by a module of its own."""
        module = f"Find{name}"
        version = self.target.find_library("cmake")
        return module in MODULES and (not version or is_at_least(version, SINCE.get(module, "0")))

    def may_find_module_elsewhere(self, package: Package, module: str) -> bool:
        """Whether another package may have a module, so that an import of it need not mean this one's."""
        head = module.partition(".")[0]
        if head and head != package.name and any(one.name == head for one in package.manifest.dependencies):
            return True
        providers = (*self.find_module(module), *self.providers.find_module(module)) if head else ()
        return any(provider.name != package.name for provider in providers)

    @cache_method
    def find_module(self, module: str) -> tuple[Provider, ...]:
        """Who could answer `import module`."""
        head = module.split(".")[0]
        owners = self.workspace.modules.get(head, ())
        if head in owners:
            owners = [head]
        if owners:
            return tuple(Provider("ros", owner) for owner in owners)
        # What is gone from Python is nobody else's module, and python-version says so.
        if is_in_stdlib(module, self.target.python or 99, self.target.python_major) or was_ever_in_stdlib(module):
            return (Provider("system", ""),)
        found = list(self.providers.find_module(module))
        if not any(p.name == head for p in found) and self.is_package(head):
            found.insert(0, Provider("ros", head, "", False))
        if len(found) > 1:
            found = [p for p in found if not self._has_lost_module(p, head)] or found
        if found:
            # A key of any name that has pip install what is called as the module.
            names = dict.fromkeys((head, head.replace("_", "-")))
            found += [Provider("system", f"python3-{name}-pip", name, False) for name in names]
        return tuple(found)

    def _has_lost_module(self, provider: Provider, module: str) -> bool:
        """Whether a package of the target had a module in other versions alone, as one does that was divided."""
        offer = self.offers.find_package(provider.name) if provider.kind == "ros" else None
        offered = offer.get("python", module) if offer is not None else None
        return offered is not None and offered.state in ("removed", "moved", "absent")


def is_called_after(name: str, folder: str) -> bool:
    """Whether a package is called after a folder of this name, which most likely holds it."""
    return len(folder) >= SHORTEST_NAME and name.startswith(folder.replace("-", "_"))


def _list_installed_with(dependencies: Iterable[ReleasedDependency] | None) -> tuple[str, ...]:
    return tuple(each.name for each in dependencies or () if each.kind in _INSTALLED_WITH)


def _drop_broad(found: list[Provider]) -> list[Provider]:
    """Without packages so broad that they bring half of ROS along, unless nobody else answers."""
    return [p for p in found if p.name not in _BROAD] or found


@lru_cache(maxsize=10_000)
def _strip_version(package: str) -> str:
    """The name of a system package without the version in it: `libgazebo5-dev` gives `libgazebo-dev`."""
    return re.sub(r"-?\d[\d.]*(?=-dev\Z|\Z)", "", package)


@lru_cache(maxsize=10000)
def _list_stems(name: str) -> frozenset[str]:
    """What a package that vendors a key may be called after: `libogre-1.9-dev` gives `ogre`, `libyaml-cpp-dev` also
    `yaml_cpp`."""
    plain = name.removeprefix("lib").removesuffix("-dev")
    return frozenset({re.split(r"[-.]", plain)[0], plain.replace("-", "_")})
