"""The linked workspace: every linked package, and who in the workspace offers what.

A linked package is remembered by the content of everything it was joined from: the names of the package's files, their
content ids, and those of CMake files of other packages that its CMake reads. Time plays no part in it. The identity of
the workspace is made of the linked packages: an edit that changes none of them changes nothing that rules can see. An
edit of code is seen by the packages alone that have to do with the edited one, see `groups`.
"""

from __future__ import annotations

import hashlib
import itertools
import posixpath
import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cached_property
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
from msgspec import structs

from ...edges import processes
from ...edges.groups import group_pairs
from ...edges.limits import format_limits
from ...edges.memory import cache_method
from ...edges.reach import walk
from ..facts.condition import Condition
from ..facts.distros import ContainerFile, DistroFile
from ..facts.extract import ExtractedFacts
from ..facts.kinds import HEADER_ENDINGS, make_overall_version
from ..facts.manifest import Manifest
from ..facts.repositories import ListedRepository
from ..facts.requirements import RequirementsFile
from ..facts.setup import SetupFile
from ..facts.store import Store
from ..source_keys import compute_source_key
from ..targets.surface.fields import ROS1_SUFFIXES, make_snake_case
from ..targets.tables import compute_data_version
from ..tree.paths import Tree, is_vendored
from .cmake.build import At, Build
from .cmake.installed import collect_installed_headers
from .cmake.interpret import interpret, list_extras
from .cmake.interpreter import calls_unmodelled
from .cpp.offered_headers import OfferedHeaders
from .discovery import Discovered, PackagePlace, detect_generation, discover, find_manifest
from .ignored import holds_ignored, is_ignored
from .package import LinkedPackage, PackageJoin, Watched, build_type_of, encode_outline

if TYPE_CHECKING:
    from ..targets.asked_versions import AskedVersions
    from .api import Changes

# Starting processes costs about as much as joining packages with this many files here.
_ALONE_FILES = 100


class Package:
    """A package of the workspace, linked, with indices made when first asked for.

    linked: all that was read of its files. path: its folder, relative to the workspace and empty for the workspace
    itself. manifest: what package.xml says. build: what CMakeLists.txt builds, installs and exports, on all machines or
    on the one that it is seen from. build_type: `catkin`, `ament_cmake`, `ament_python`, `cmake` ..., for the
    generation of the workspace.
    """

    linked: LinkedPackage
    name: str
    path: str
    manifest: Manifest
    build: Build
    build_type: str

    def __init__(self, linked: LinkedPackage, build: Build | None = None):
        self.linked = linked
        self.name, self.path = linked.name, linked.path
        self.manifest, self.build, self.build_type = linked.manifest, build or linked.build, linked.build_type

    def __repr__(self) -> str:
        return f"Package({self.name})"

    @cached_property
    def declared(self) -> dict[str, set[str]]:
        """Dependency name to the kinds it is declared as, conditions ignored."""
        wanted = (each for each in self.manifest.dependencies if each.kind not in ("conflict", "replace"))
        return {name: set(kinds) for name, kinds in group_pairs((each.name, each.kind) for each in wanted).items()}

    @property
    def setup_files(self) -> Iterator[tuple[str, SetupFile]]:
        """Its own setup.py, setup.cfg and pyproject.toml, which install it; none where others do."""
        if self.build_type in ("ament_python", "catkin"):
            for path, setup in self.linked.setup:
                if posixpath.dirname(path) == self.path:
                    yield path, setup

    def list_requirements(self) -> Iterator[tuple[At, str]]:
        """The Python packages that it asks for in its setup files and requirements.txt."""
        for path, file in (*self.setup_files, *self.linked.requirements):
            for requirement in file.requirements:
                yield At(path, requirement.line), requirement.text

    @property
    def is_ros_cmake(self) -> bool:
        """True when CMake builds it with the macros of catkin or ament."""
        return self.build_type in ("catkin", "ament_cmake", "ament_cmake_auto")

    @cached_property
    def is_interface_package(self) -> bool:
        """True when it generates messages, services or actions."""
        return bool(self.linked.interfaces) or any(g.how in ("rosidl", "catkin") for g in self.build.generated)

    @cached_property
    def files(self) -> frozenset[str]:
        """Paths of its files, relative to the workspace."""
        return frozenset(self.linked.files)

    @cached_property
    def folders(self) -> frozenset[str]:
        """Paths of the folders of its files, relative to the workspace."""
        found = set()
        for path in self.linked.files:
            while "/" in path:
                path = path.rsplit("/", 1)[0]
                if path in found:
                    break
                found.add(path)
        return frozenset(found)

    def strip_path(self, path: str) -> str:
        """The path of one of its files or folders, relative to its own folder."""
        return path[len(self.path) :].lstrip("/")

    def find_doubled(self, path: str) -> str:
        """The file that a path means where the name of the package's folder stands twice: below the folder itself as
        CMAKE_SOURCE_DIR, and in the path. Relative to the package; empty for other paths."""
        doubled = f"{self.path}/{posixpath.basename(self.path)}/" if self.path else f"{self.name}/"
        inside = path[len(doubled) :] if path.startswith(doubled) and path not in self.files else ""
        return inside if inside and posixpath.join(self.path, inside) in self.files else ""

    def has_files(self, folder: str) -> bool:
        """True when a file lies in the folder (relative to the package)."""
        return (f"{self.path}/{folder}" if self.path else folder) in self.folders


class FilesOutside:
    """What files say that belong to no package. lists_repositories: as Discovered has it. unread_submodules: the
    folders of submodules that were not read, in order. listed: what lists of repositories name, with the paths of
    these. twice: names that several packages have, of which one is read.
    """

    def __init__(self, discovered: Discovered, extraction: ExtractedFacts):
        self._extraction = extraction
        self.lists_repositories = discovered.lists_repositories
        self.unread_submodules = sorted(problem.path for problem in extraction.problems if problem.is_submodule)
        counts = Counter(place.name for place in discovered.packages)
        self.twice = sorted(name for name, count in counts.items() if count > 1)
        scripts = extraction.list_paths("shell", "script")
        self._scripts = [path for path in scripts if discovered.find_owner(path) is None]
        self._requirements = [p for p in extraction.list_paths("requirements") if discovered.find_owner(p) is None]
        self._containers = [path for path in extraction.list_paths("dockerfile", "ci") if not is_vendored(path)]
        self._lists = [path for path in extraction.list_paths("repositories") if not is_vendored(path)]

    @property
    def identity(self) -> bytes:
        """Differs whenever one of them does."""
        paths = (*self._scripts, *self._requirements, *self._containers, *self._lists)
        ids = [(path, self._extraction.ids[path]) for path in paths]
        said = (ids, self.lists_repositories, self.unread_submodules, self.twice)
        return repr(said).encode("utf-8", "backslashreplace")

    @cached_property
    def distro_scripts(self) -> dict[str, DistroFile]:
        """Shell scripts that name folders of distros."""
        self._extraction.preload(self._scripts)
        found = ((path, self._extraction.get_facts(path).distros) for path in self._scripts)
        return {path: distros for path, distros in found if distros is not None}

    @cached_property
    def requirements(self) -> dict[str, RequirementsFile]:
        """Files called requirements.txt."""
        self._extraction.preload(self._requirements)
        return {path: self._extraction.get_facts(path).facts for path in self._requirements}

    @cached_property
    def containers(self) -> dict[str, ContainerFile]:
        """The workspace's own Dockerfiles and CI files."""
        self._extraction.preload(self._containers)
        return {path: self._extraction.get_facts(path).facts for path in self._containers}

    @cached_property
    def listed(self) -> tuple[tuple[str, ListedRepository], ...]:
        """The repositories that files of vcstool and wstool name."""
        self._extraction.preload(self._lists)
        files = ((path, self._extraction.get_facts(path).facts) for path in self._lists)
        return tuple((path, one) for path, facts in files if facts is not None for one in facts.repositories)


class Workspace:
    """All packages of a tree, linked. packages: by name."""

    packages: dict[str, Package]

    def __init__(
        self,
        packages: Iterable[LinkedPackage],
        discovered: Discovered,
        ros: int,
        extraction: ExtractedFacts,
        read: Callable[[str], bytes],
        identity: bytes = b"",
        whole: bool = True,
        unread: frozenset[str] = frozenset(),
        outside: FilesOutside | None = None,
        outline: bytes = b"",
        contents: Mapping[str, bytes] = MappingProxyType({}),
    ):
        self.packages = {d.name: Package(d) for d in packages}
        self.discovered, self.ros, self.extraction, self.read = discovered, ros, extraction, read
        # Files and folders that were not read, as submodules that are not checked out.
        self.unread = unread
        self.outside = outside or FilesOutside(discovered, extraction)
        # Differs whenever a linked package, their order or the generation does.
        self.identity = identity
        # The same of what any package may be asked about the others, see encode_outline(), and each package's own.
        self.outline, self.contents = outline, contents
        # False where a package could not be joined, or not be stored: the next run may tell otherwise.
        self.whole = whole
        # What later joins made of it, see cache_in_derived().
        self.derived: dict[Any, Any] = {}

    def find_owning_package(self, path: str) -> str:
        """The name of the package that a file belongs to, empty for none and for duplicates."""
        owner = self.discovered.find_owner(path)
        return next((name for name, each in self.packages.items() if owner and each.path == owner.path), "")

    def __iter__(self):
        return iter(self.packages.values())

    @property
    def hidden(self) -> Iterator[PackagePlace]:
        """Packages that are not analysed, since another of the same name stands for them."""
        present = {package.path for package in self}
        for place in self.discovered.packages:
            if place.path not in present and place.manifest_path in self.extraction.kinds:
                yield place

    @cached_property
    def _around_unread(self) -> frozenset[str]:
        parts = (itertools.accumulate(path.split("/"), "{}/{}".format) for path in self.unread)
        return frozenset(itertools.chain.from_iterable(parts))

    @cached_property
    def unread_names(self) -> frozenset[str]:
        """Names of folders that were not read, such as submodules that are not checked out."""
        return frozenset(path.rpartition("/")[2] for path in self.unread)

    def is_unread(self, path: str) -> bool:
        """Whether a file or folder was not read, lies in a folder that was not, or holds such ones."""
        inside = itertools.accumulate(path.split("/"), "{}/{}".format)
        return path in self._around_unread or not self.unread.isdisjoint(inside)

    @cached_property
    def headers(self) -> dict[str, list[str]]:
        """Include path to the packages whose files answer it, for every suffix of every header's path."""
        return _group(
            ("/".join(parts[at:]), package.name)
            for package in self
            for path in package.linked.headers
            for parts in (path.removesuffix(".in").split("/"),)
            for at in range(len(parts))
        )

    @cached_property
    def rooted_headers(self) -> dict[str, list[str]]:
        """Include paths as they follow an `include` folder, and again after a folder named as the package (the layout
        of ROS 2), or a folder of the sources that the package exports, to the packages that have them."""
        folders = {
            package.name: [posixpath.join(one.item, "") for one in package.build.exports if one.how == "include_dirs"]
            for package in self
        }

        def list_spellings(package: Package, path: str) -> Iterator[str]:
            for folder in folders[package.name]:
                if path.startswith(folder):
                    yield path.removesuffix(".in").removeprefix(folder)
            _, root, rest = f"/{path.removesuffix('.in')}".rpartition("/include/")
            if root:
                yield rest
                head, _, tail = rest.partition("/")
                if head == package.name and tail:
                    yield tail

        headers = ((package, path) for package in self for path in package.linked.headers)
        return _group((each, one.name) for one, path in headers for each in list_spellings(one, path))

    @cached_property
    def generated_headers(self) -> dict[str, list[str]]:
        """Basename of headers made while building (parameters, protobuf, Qt forms, configure_file, custom commands) to
        the packages, the last first."""
        found: dict[str, list[str]] = {}
        for package in reversed(list(self)):
            made = {posixpath.basename(path) for path in package.build.made if path.endswith(HEADER_ENDINGS)}
            for item in package.build.generated:
                if item.how == "parameters":
                    made.add(f"{item.target}.hpp")
                elif item.how == "protobuf":
                    made.update(posixpath.basename(file).replace(".proto", ".pb.h") for file in item.files)
            for path in package.linked.files:
                name = posixpath.basename(path)
                if name.endswith(".ui"):
                    made.add("ui_" + name[:-3] + ".h")
                elif name.endswith((".h.in", ".hpp.in", ".hh.in")):
                    made.add(name[:-3])
                elif name.endswith(".proto"):
                    made.add(name.replace(".proto", ".pb.h"))
            for name in made:
                found.setdefault(name, []).append(package.name)
        return found

    @cached_property
    def interface_names(self) -> dict[str, set[str]]:
        """Package to the names of its interfaces."""
        return {p.name: {i.name for i in p.linked.interfaces} for p in self if p.linked.interfaces}

    @cached_property
    def interface_texts(self) -> dict[str, dict[str, str]]:
        """The constants of messages that are strings, with their values, by `package/Name`."""
        found: dict[str, dict[str, str]] = {}
        for package in self:
            for interface in package.linked.interfaces:
                sections = interface.definition.sections if interface.definition.kind in ("msg", "idl") else ()
                constants = (one for section in sections[:1] for one in section.constants)
                texts = {one.name: one.value for one in constants if one.type.startswith(("string", "wstring"))}
                if self.ros == 2:  # which takes quotes off: rosidl_parser, parse_primitive_value_string()
                    texts = {name: value[1:-1] if value[:1] in ("'", '"') else value for name, value in texts.items()}
                if texts:
                    found[f"{package.name}/{interface.name}"] = texts
        return found

    @cached_property
    def library_names(self) -> frozenset[str]:
        """What may be the name of a library that a package of it builds, as PluginClass has it."""
        targets = [t for p in self for t in p.build.targets if t.kind not in ("custom", "executable", "test")]
        names = (name for target in targets for name in (target.name, target.output_name) if name)
        return frozenset(name.removeprefix("lib").removesuffix(".so") for name in names)

    @cached_property
    def modules(self) -> dict[str, list[str]]:
        """Python module name to the packages of the workspace that have one of that name."""
        return _group((module, package.name) for package in self for module in {package.name, *list_modules(package)})

    @cached_property
    def cmake_files(self) -> frozenset[str]:
        """Names of the workspace's CMake modules and configurations, without their folders."""
        paths = (path for package in self for path in package.linked.files)
        return frozenset(posixpath.basename(path) for path in paths if path.endswith(".cmake"))

    @cached_property
    def find_modules(self) -> dict[str, set[str]]:
        """Names of find modules that packages of the tree carry for themselves, to those packages."""
        found: dict[str, set[str]] = {}
        for package in self:
            for path in package.linked.files:
                if path.endswith(".cmake"):
                    name = posixpath.basename(path).removesuffix(".cmake")
                    if name.startswith("Find") and name != "Find":
                        found.setdefault(name.removeprefix("Find"), set()).add(package.name)
        return found

    @cached_property
    def provides_cmake(self) -> dict[str, str]:
        """Names that find_package may use for something the tree itself makes (projects, exported configurations)."""
        found = {}
        for package in self:
            found[package.name] = package.name
            if package.build.project:
                found.setdefault(package.build.project, package.name)
            for path in package.linked.files:
                if path.endswith((".cmake", ".cmake.in")):
                    match = _CONFIGURATION.match(posixpath.basename(path))
                    if match:
                        found.setdefault(match.group(1), package.name)
        return found

    @cache_method
    def provides_header(self, include: str) -> list[str]:
        """Packages of the workspace whose files, or whose generated files, answer an include path."""
        owners = self.rooted_headers.get(include) or self.headers.get(include)
        if owners:
            return owners
        makers = self.generated_headers.get(include.rsplit("/", 1)[-1])
        if makers:
            return makers
        head, _, rest = include.partition("/")
        package = self.packages.get(head)
        return [head] if package is not None and rest and self._generates(package, rest) else []

    def generates_header(self, package: Package, include: str) -> bool:
        """Whether a package makes a header from its interfaces or parameters, as far as its path tells."""
        head, _, rest = include.partition("/")
        return head == package.name and bool(rest) and self._generates(package, rest)

    def _generates(self, package: Package, rest: str) -> bool:
        if not package.build.files or package.manifest.metapackage:
            return False
        if rest.endswith("Config.h") and any(g.how == "reconfigure" for g in package.build.generated):
            return True
        if rest.rsplit("/", 1)[-1] in _OFTEN_MADE:
            return True
        return package.is_interface_package and self.is_interface_header(package.name, rest)

    def is_interface_header(self, package: str, rest: str) -> bool:
        """True when `rest` (an include path after `package/`) is generated from an interface of the package."""
        return _names_interface(rest, self._get_interface_stems(package))

    @cache_method
    def _get_interface_stems(self, package: str) -> tuple[frozenset[str], frozenset[str]]:
        return _make_stems(self.interface_names.get(package, ()))

    @cached_property
    def broken_headers(self) -> frozenset[str]:
        """Include paths that begin with a package of the workspace, and that no file or generator of it answers.

        Only of packages whose headers all lie in the tree, or that are generated from interfaces alone."""
        found = set()
        for package in self:
            for include in package.linked.includes:
                head, _, rest = include.path.partition("/")
                owner = self.packages.get(head)
                if owner is None or not rest or "_export." in rest:
                    continue
                if owner.manifest.metapackage or not self._is_closed(owner) or self.provides_header(include.path):
                    continue
                if any(path.endswith(f"/{include.path}") for path in owner.linked.files):
                    continue  # a file that is not called like a header (`types.macro`)
                if any(rule.rename == posixpath.basename(rest) for rule in owner.build.installs):
                    continue  # another file is installed as it
                if owner is not package and self._may_install(owner, include.path):
                    continue
                found.add(include.path)
        return frozenset(found)

    def _may_install(self, package: Package, header: str) -> bool:
        """Whether a package installs a file as a header, wherever it lies in the tree, or what is not known."""
        installed = collect_installed_headers(package.build, package.linked.files)
        return not installed.known or any(f"/{place}".endswith(f"/{header}") for place in installed.headers.values())

    def _is_closed(self, package: Package) -> bool:
        """True when nothing in a package makes headers but its interfaces and dynamic_reconfigure."""
        if (
            any(g.how not in ("rosidl", "catkin", "reconfigure") for g in package.build.generated)
            or package.build.unresolved
        ):
            return False
        if any(
            path.endswith((".in", ".em", ".proto", ".ui", ".fbs", ".idl", ".xtext")) for path in package.linked.files
        ):
            return False
        if any(t.kind in ("custom", "external", "fetched", "unknown") for t in package.build.targets):
            return False
        if any("$" in path for g in package.build.generated for path in g.files):
            return False  # generates what another package lists
        if package.build.starts:
            return False  # its own scripts may fetch or write headers while it is configured
        return bool(package.linked.headers or package.linked.interfaces) and not calls_unmodelled(package.build)

    @cached_property
    def includers(self) -> dict[str, set[str]]:
        """Package to the other packages of the workspace that include its headers."""
        found: dict[str, set[str]] = {}
        for package in self:
            for path in {i.path for i in package.linked.includes}:
                for owner in self.provides_header(path):
                    if owner != package.name:
                        found.setdefault(owner, set()).add(package.name)
        return found


    @cached_property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """The packages, parted so that none has to do with one of another group: they name nothing of each other in
        manifests, CMake, code or launch files. What the code of one says then changes nothing for the others. Small
        groups that follow each other are put together."""
        beside: dict[str, set[str]] = {name: set() for name in self.packages}
        for package in self:
            for name in self._list_named(package):
                if name in beside:
                    beside[package.name].add(name)
                    beside[name].add(package.name)
        groups: list[list[str]] = []
        seen: set[str] = set()
        for name in beside:
            if name not in seen:
                together = set(walk([name], beside.__getitem__))
                seen |= together
                if groups and len(groups[-1]) < _SMALL_GROUP:
                    groups[-1].extend(each for each in beside if each in together)
                else:
                    groups.append([each for each in beside if each in together])
        return tuple(map(tuple, groups))

    def _list_named(self, package: Package) -> Iterator[str]:
        """The names by which a package has to do with others of the workspace."""
        linked = package.linked
        yield from (dependency.name for dependency in package.manifest.dependencies)
        for found in package.build.found:
            yield from (found.name, self.provides_cmake.get(found.name, ""))
        for path in {include.path for include in linked.includes}:
            yield from (path.partition("/")[0], *self.provides_header(path))
        for module in {item.module.partition(".")[0] for item in linked.imports}:
            yield from (module, *self.modules.get(module, ()))
        yield from (use.reference.package for use in linked.references)
        for interface in linked.interfaces:
            yield from (
                field.type.partition("/")[0] for section in interface.definition.sections for field in section.fields
            )


# Packages of a group that is not put together with the next.
_SMALL_GROUP = 16
# Headers that macros of CMake make under these names.
_OFTEN_MADE = frozenset(("visibility_control.h", "visibility_control.hpp", "version.h", "version.hpp", "export.h"))
_CONFIGURATION = re.compile(r"(.+?)-?[Cc]onfig\.cmake(?:\.in)?$")


def list_modules(package: Package) -> set[str]:
    """Top-level Python modules that others can import once the package is installed: `name/__init__.py` and `name.py`
    in the package's folder or its src/, and what setup.py lists."""
    found = set()
    for path in package.linked.files:
        if not path.endswith(".py"):
            continue
        parts = package.strip_path(path).split("/")
        if parts[0] == "src":
            parts = parts[1:]
        if len(parts) == 2 and parts[1] == "__init__.py":
            found.add(parts[0])
    for _, setup in package.linked.setup:
        found.update(name.split(".")[0].split("/")[-1] for name in setup.packages if name and name != "*")
    return found


_ROS1_SUFFIXES = frozenset().union(*ROS1_SUFFIXES.values())


def _make_stems(names: Iterable[str]) -> tuple[frozenset[str], frozenset[str]]:
    """Stems of the headers generated from interfaces: in ROS 2's spelling and in ROS 1's."""
    names = tuple(names)
    return frozenset(make_snake_case(n) for n in names), frozenset(n + s for n in names for s in _ROS1_SUFFIXES)


def _names_interface(rest: str, stems: tuple[frozenset[str], frozenset[str]]) -> bool:
    parts = rest.split("/")
    if parts[0] in ("msg", "srv", "action") and len(parts) > 1:
        stem = parts[-1].partition(".")[0].partition("__")[0]
        while stem:
            if stem in stems[0]:
                return True
            stem = stem.rpartition("_")[0]
        return False
    return len(parts) == 1 and parts[-1].removesuffix(".h") in stems[1]


def is_interface_header(rest: str, names: Iterable[str]) -> bool:
    """True when `rest` (an include path after `package/`) is generated from one of the named interfaces."""
    return _names_interface(rest, _make_stems(names))


def _group(named: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """Names to those that have them, each once and in order. named: pairs of the two."""
    groups = group_pairs(named)
    return {name: list(dict.fromkeys(those)) if len(those) > 1 else those for name, those in groups.items()}


def link(
    tree: Tree,
    extraction: ExtractedFacts,
    store: Store | None,
    ros: int | None,
    watched: Watched,
    jobs: int | None = None,
    discovered: Discovered | None = None,
    asked: AskedVersions | None = None,
) -> Workspace:
    """Joins the facts of a tree into a workspace. ros: 1 or 2, None to tell it from the manifests. store remembers
    linked packages; None joins everything anew. jobs: processes to use, all available cores when None. discovered: the
    packages of the tree, where they are known. asked: the versions of other packages that uses may be wrong in, all
    when None.
    """
    discovered = discovered or discover(tree, extraction)
    ros = ros or detect_generation(discovered, extraction)
    linker = _Linker(tree, extraction, discovered, ros, watched, jobs or processes.count_cores(), asked)
    linked = linker.link_packages(store)
    outside = FilesOutside(discovered, extraction)
    for found in (linker.identity, linker.outline):
        found.update(outside.identity)
    return Workspace(
        *(linked, discovered, ros, extraction, tree.read, linker.identity.digest(), linker.whole, linker.unread),
        *(outside, linker.outline.digest(), linker.contents),
    )


def _list_conditional(manifest: Manifest) -> dict[str, Condition]:
    """The packages that a manifest declares under conditions alone, with the test that one of them holds."""
    found = group_pairs((dependency.name, dependency.condition) for dependency in manifest.dependencies)
    return {
        name: Condition("manifest", " or ".join(f"({text})" for text in dict.fromkeys(texts)))
        for name, texts in found.items()
        if all(texts)
    }


def _list_named(manifest: Manifest, *kinds: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(d.name for d in manifest.dependencies if d.kind in kinds))


class _Stale(NamedTuple):
    """A linked package whose own files say what they did, and what is remembered of the headers of others."""

    linked: LinkedPackage
    headers: dict[str, str]


class _Head(msgspec.Struct, frozen=True, array_like=True):
    """What is remembered beside a linked package. read: what other packages' files say that it rests on, the content
    ids of CMake files, and headers as OfferedHeaders describes them. outline: a digest of encode_outline()."""

    read: dict[str, str]
    outline: bytes


class _Joined(NamedTuple):
    """A linked package, the same encoded (empty where its names cannot be), the digest of its outline, and its _Head,
    encoded (None: not to be stored)."""

    linked: LinkedPackage
    packed: bytes | memoryview
    outline: bytes
    head: bytes | None


# A package may take as much time as a file of this size, and as much more for each of its files: 12 seconds, and one
# for 17 files. The slowest packages of ros2_control, navigation2 and moveit2 take 0.7 s.
_JOIN_BYTES, _JOIN_BYTES_OF_FILE = 3 << 20, 20 << 10
# Of a package: paths that its CMake looks for.
_REMEMBERED = 5_000_000
_INTERFACES = frozenset(("msg", "srv", "action", "idl"))


def _join(linker: _Linker, tasks: dict[str, tuple[PackagePlace, _Stale | None]], path: str):
    """What a process of its own does with a folder of tasks: a _Joined, with the package in one form only."""
    processes.begin_part(0, _JOIN_BYTES + len(linker.paths_of[path]) * _JOIN_BYTES_OF_FILE)
    joined = linker.join_one(*tasks[path])
    return joined._replace(linked=None) if joined.packed else joined


def _detect_build_type(build: Build, manifest: Manifest, ros: int) -> str:
    """The build type of a package by what its CMake calls, where that is one of the two alone: a manifest often still
    says what the package was ported from, unless it chooses by the generation."""
    declared = build_type_of(manifest, ros)
    catkin, ament = build.catkin_package is not None, build.ament_package is not None
    chooses = any(condition for _, condition in manifest.build_types)
    if catkin == ament or chooses or declared not in ("catkin", "ament_cmake"):
        return declared
    return "catkin" if catkin else "ament_cmake"


class _Linker:
    def __init__(
        self,
        tree: Tree,
        extraction: ExtractedFacts,
        discovered: Discovered,
        ros: int,
        watched: Watched,
        jobs: int,
        asked: AskedVersions | None,
    ):
        self.tree, self.extraction, self.discovered, self.ros, self.watched = tree, extraction, discovered, ros, watched
        self.jobs, self.asked = jobs, asked
        self.paths_of: dict[str, list[str]] = {p.path: [] for p in discovered.packages}
        for entry in tree.list_entries():
            owner = discovered.find_owner(entry.path)
            if owner is not None and owner.path in self.paths_of:
                self.paths_of[owner.path].append(entry.path)
        self.all_paths = frozenset(e.path for e in tree.list_entries())
        self.by_name = {p.name: p for p in discovered.packages}
        self._extras: dict[str, tuple[str, ...]] = {}
        self.whole = True
        self.code = f"{compute_source_key(__name__)} {make_overall_version()} {compute_data_version()}"
        self.unread = frozenset(problem.path for problem in (*extraction.problems, *tree.skipped))
        self.identity = hashlib.sha1(f"{self.code} {ros} {sorted(self.unread)}".encode("utf-8", "backslashreplace"))
        self.outline = self.identity.copy()
        self.contents: dict[str, bytes] = {}

    def link_packages(self, store: Store | None) -> list[LinkedPackage]:
        places = [p for p in self.discovered.packages if find_manifest(self.extraction, p.manifest_path) is not None]
        keys = {p.path: self.compute_key(p) for p in places}
        decoder = msgspec.msgpack.Decoder(LinkedPackage)
        remembered = store.find_memos("digest", list(keys.values())) if store is not None else {}
        found: dict[str, _Joined] = {}
        stale: dict[str, _Stale] = {}
        for place in places:
            blob = remembered.get(keys[place.path])
            if blob is not None:
                size = int.from_bytes(blob[:4], "big")
                packed = memoryview(blob)[4 + size :]
                try:
                    read, outline = structs.astuple(msgspec.msgpack.decode(blob[4 : 4 + size], type=_Head))
                    before = decoder.decode(packed)
                except msgspec.MsgspecError:
                    continue  # of another version: made anew
                headers = {path: described for path, described in read.items() if " " in described}
                if not all(self.offered.is_unchanged(path, described) for path, described in headers.items()):
                    continue
                if all(self.extraction.ids.get(path, "") == oid for path, oid in read.items() if path not in headers):
                    found[place.path] = _Joined(before, packed, outline, None)
                else:
                    stale[place.path] = _Stale(before, headers)
        made = dict(self.combine([p for p in places if p.path not in found], stale))
        self.whole = all(one.packed and one.head is not None for one in made.values())
        found.update(made)
        fresh: list[tuple[bytes, bytes]] = []
        for place in places:
            linked, packed, outline, head = found[place.path]
            # Names that are no UTF-8 cannot be stored, and are read anew each time.
            self.identify(linked.name, packed or repr(linked).encode("utf-8", "backslashreplace"), outline)
            if packed and head is not None:
                fresh.append((keys[place.path], len(head).to_bytes(4, "big") + head + packed))
        if store is not None and fresh:
            store.remember("digest", fresh)
        return [found[p.path].linked for p in places]

    def combine(self, places: Iterable[PackagePlace], stale: dict[str, _Stale]) -> Iterator[tuple[str, _Joined]]:
        """Folder and join of these packages, several at once where there is much to do. stale: those of an
        earlier run that may still hold, by folder."""
        tasks = {p.path: (p, stale.get(p.path)) for p in places}
        order = sorted(tasks, key=lambda path: (-len(self.paths_of[path]), path))
        files = sum(len(self.paths_of[path]) for path in order)
        if not order or not processes.may_fork():
            yield from ((path, self.join_one(*tasks[path])) for path in order)
            return
        jobs = 1 if len(order) < 2 or files < _ALONE_FILES else self.jobs
        self.extraction.store.close()  # every process opens it for itself
        _ = self.watched.in_cpp  # made once and for all processes
        if self.watched.surfaces is not None or self.watched.fields is not None:
            import_module(".cpp.uses", __package__)  # once, not in every process
        decoder = msgspec.msgpack.Decoder(LinkedPackage)
        for path, result in processes.run_forked(_join, order, jobs, self, tasks):
            if isinstance(result, processes.Died):
                place, _ = tasks[path]
                yield path, self.encode_package(self.make_failed(place, f"its analysis {result.why}"), None)
            else:
                yield path, result._replace(linked=result.linked or decoder.decode(result.packed))

    def join_one(self, place: PackagePlace, before: _Stale | None) -> _Joined:
        try:
            with self.extraction.defer_storing():
                linked, read = self.join(place, before)
        except MemoryError:
            raise  # ends a process, whose package is then tried in a new one
        except Exception as error:
            # One package that nobody foresaw must not take the others with it.
            why = f"{type(error).__name__}: {error}; this is a fault of rosimpact, please report it"
            linked, read = self.make_failed(place, why), None
        return self.encode_package(linked, read)

    def encode_package(self, linked: LinkedPackage, read: dict[str, str] | None) -> _Joined:
        """A linked package with what is remembered of it."""
        try:
            outline = hashlib.sha1(encode_outline(linked)).digest()
            head = msgspec.msgpack.encode(_Head(read, outline)) if read is not None else None
            return _Joined(linked, msgspec.msgpack.encode(linked), outline, head)
        except UnicodeEncodeError:
            return _Joined(linked, b"", hashlib.sha1(repr(linked).encode("utf-8", "backslashreplace")).digest(), None)

    def identify(self, name: str, linked: bytes | memoryview, outline: bytes) -> None:
        """Takes a linked package, as bytes, and the digest of its outline into the workspace's identities."""
        content = self.contents[name] = hashlib.sha1(linked).digest()
        self.identity.update(content)
        self.outline.update(outline)

    def make_failed(self, place, reason: str) -> LinkedPackage:
        """What stands for a package whose join failed: its manifest, and a problem that says so."""
        manifest = find_manifest(self.extraction, place.manifest_path)
        assert manifest is not None
        why = f"the package could not be analysed: {reason}"
        return LinkedPackage(place.name, place.path, place.manifest_path, manifest, build_type_of(manifest, self.ros),
                             Build(), problems=((place.manifest_path, 0, why),),
                             files=tuple(self.paths_of[place.path]))  # fmt: skip

    def compute_key(self, place) -> bytes:
        """Everything of the package itself that it is linked from."""
        ids = self.extraction.ids
        asked = self.asked.identity if self.asked is not None else ""
        versions = f"{self.code}{format_limits()} {self.watched.version} {asked}"
        about = f"{versions} {self.ros} {self._extras_key} {self.offered.key} {sorted(self.home)} {place.path}\n"
        key = hashlib.sha1(about.encode("utf-8", "surrogateescape"))
        key.update(
            "\n".join([f"{path} {ids.get(path, '')}" for path in self.paths_of[place.path]]).encode(
                "utf-8", "surrogateescape"
            )
        )
        return key.digest()

    @cached_property
    def home(self) -> frozenset[str]:
        """Packages of the tree of which surfaces are stored, or that define interfaces: what was released of them does
        not count here."""
        stored = self.watched.surfaces.packages if self.watched.surfaces is not None else frozenset()
        kinds = self.extraction.kinds
        places = (p for p in self.discovered.packages if find_manifest(self.extraction, p.manifest_path))
        return frozenset(
            p.name
            for p in places
            if p.name in stored or any(kinds.get(path) in _INTERFACES for path in self.paths_of[p.path])
        )

    @cached_property
    def _extras_key(self) -> str:
        """Which CMake files packages give their dependants; what is in them is told by the packages that read them."""
        given = [path for place in self.discovered.packages for path in self.find_extras(place.name)]
        return hashlib.sha1("\n".join(given).encode("utf-8", "surrogateescape")).hexdigest()

    def exists(self, path: str) -> bool | None:
        """Whether a path is there; None below what was not read, such as a submodule that is not checked out."""
        if path in self.all_paths:
            return True
        above = itertools.accumulate(path.split("/"), "{}/{}".format)
        return False if self.unread.isdisjoint(above) else None

    def join(self, place, before: _Stale | None) -> tuple[LinkedPackage, dict[str, str]]:
        """A linked package, and what files of others say that it rests on. before: a linked package of the very same
        files of its own; where the CMake files of others still say the same, it holds."""
        extraction = self.extraction
        manifest = find_manifest(extraction, place.manifest_path)
        assert manifest is not None
        files = self.paths_of[place.path]
        extraction.preload(files)
        read: dict[str, str] = {}

        def read_cmake(path: str):
            path = posixpath.normpath(path)
            if extraction.kinds.get(path) != "cmake":
                return None
            if not (path.startswith(place.path + "/") or not place.path):
                read[path] = extraction.ids.get(path, "")
            file = extraction.get_facts(path)
            return file.facts if file is not None else None

        build = (
            interpret(
                place.path,
                read_cmake,
                self.exists,
                self.make_glob(files),
                package=manifest.name,
                dependencies=_list_named(manifest, "build", "buildtool"),
                test_dependencies=_list_named(manifest, "test"),
                exported_dependencies=_list_named(manifest, "build_export", "buildtool_export", "exec"),
                conditional_dependencies=_list_conditional(manifest),
                extras=self.find_extras,
            )
            if build_type_of(manifest, self.ros) != "ament_python"
            and (f"{place.path}/CMakeLists.txt" if place.path else "CMakeLists.txt") in self.all_paths
            else Build()
        )
        ignored = (*self.list_ignored(build, read), *sorted(self.list_ignored_modules(files, read)))
        build = structs.replace(build, made=(*build.made, *ignored)) if ignored else build
        if before is not None and build == before.linked.build:
            return before.linked, {**read, **before.headers}
        build_type = _detect_build_type(build, manifest, self.ros)
        joined = PackageJoin(
            *(place, manifest, build, build_type, files, extraction),
            *(self.watched, self.home, self.asked, self.changing, self.offered),
        )
        linked = joined.build_package()
        return linked, {**read, **{path: self.offered.describe(path) for path in joined.offered_read}}

    @cached_property
    def offered(self) -> OfferedHeaders:
        """The headers that packages offer each other."""
        return OfferedHeaders(self.paths_of, self.extraction)

    @cached_property
    def changing(self) -> Changes | None:
        """C++ names of other packages that are not the same in all versions which are asked about."""
        from .api import Changes

        surfaces = self.watched.surfaces
        return Changes(surfaces.find_lines, self.asked, surfaces.find_history) if surfaces is not None else None

    def list_ignored(self, build: Build, read: dict[str, str]) -> Iterator[str]:
        """What the package installs, compiles or includes in CMake and git ignores, so that it is there once it was
        made. read: as join() returns it, completed by the files that tell."""
        named = [
            (item, one.kind == "directory")
            for one in build.installs if one.kind in ("files", "programs", "directory") for item in one.items
        ]  # fmt: skip
        named += [(one.path, False) for one in build.list_paths() if one.how in ("read", "source", "test")]
        for item, is_folder in dict.fromkeys(named):
            path = posixpath.normpath(item)
            if "$" in item or path.startswith(("/", "..")) or path in self.all_paths:
                continue
            rules = self._list_ignore_rules(path, read)
            if rules and (is_ignored(path, rules) or (is_folder and holds_ignored(path, rules))):
                yield path

    def list_ignored_modules(self, files: list[str], read: dict[str, str]) -> set[str]:
        """Modules that Python files of a package import, that are not there, and that git ignores, so that a generator
        makes them; each as the outermost path that is ignored. files: of the package. read: as above."""
        if not self._ignoring:
            return set()
        folders = group_pairs((name, above) for above, name in map(posixpath.split, map(posixpath.dirname, files)))
        found: set[str] = set()
        asked: set[str] = set()
        for path in files:
            facts = self.extraction.get_facts(path) if self.extraction.kinds.get(path) == "python" else None
            for item in facts.facts.imports if facts is not None else ():
                head, *rest = item.module.split(".")
                around = path
                for _ in range(item.level):
                    around = posixpath.dirname(around)
                roots = {around} if item.level else {*folders.get(head, ())} if rest else set()
                asked.update(posixpath.join(root, *head.split(), *rest) for root in roots)
        for path in asked:
            if f"{path}.py" in self.all_paths or f"{path}/__init__.py" in self.all_paths:
                continue
            rules = self._list_ignore_rules(path, read)
            above = itertools.accumulate(path.split("/"), "{}/{}".format)
            ignored = next((one for one in above if rules and is_ignored(one, rules)), None)
            if ignored is not None:
                found.add(f"{ignored}.py")
        return found

    @cached_property
    def _ignoring(self) -> bool:
        return any(kind == "gitignore" for kind in self.extraction.kinds.values())

    def _list_ignore_rules(self, path: str, read: dict[str, str]) -> list[tuple[str, tuple[str, ...]]]:
        """The folders of the .gitignore files on the way to a path, outermost first, with their patterns."""
        rules = []
        for folder in ("", *itertools.accumulate(path.split("/")[:-1], "{}/{}".format)):
            file = f"{folder}/.gitignore" if folder else ".gitignore"
            if self.extraction.kinds.get(file) == "gitignore":
                read[file] = self.extraction.ids.get(file, "")
                facts = self.extraction.get_facts(file)
                rules.append((folder, facts.facts.patterns if facts is not None else ()))
        return rules

    def make_glob(self, files: list[str]):
        import fnmatch

        by_folder = group_pairs((path.rpartition("/")[0], path) for path in files)
        folders = sorted(by_folder)
        known: dict[tuple[str, bool], list[str]] = {}

        def find(pattern: str, recurse: bool = False) -> list[str]:
            found = known.get((pattern, recurse))
            if found is None:
                found = sorted(list_matching(pattern, recurse))
                if len(known) * len(files) < _REMEMBERED:
                    known[pattern, recurse] = found
            return found

        def list_matching(pattern: str, recurse: bool) -> Iterator[str]:
            folder, _, name = pattern.rpartition("/")
            matches = re.compile(fnmatch.translate(name)).match
            within: Iterable[str] = (folder,)
            if re.search(r"[*?\[]", folder):
                within = filter(re.compile(fnmatch.translate(folder)).match, folders)
            elif recurse and not folder:
                within = folders
            elif recurse:
                # `/` is followed by `0`.
                below = folders[bisect_left(folders, folder + "/") : bisect_left(folders, folder + "0")]
                within = (folder, *below)
            for at in within:
                yield from (path for path in by_folder.get(at, ()) if matches(path[len(at) + 1 if at else 0 :]))

        return find

    def find_extras(self, package: str) -> tuple[str, ...]:
        """CMake files that a package of the workspace gives its dependants."""
        known = self._extras.get(package)
        if known is None:
            place = self.by_name.get(package)
            cmake = [path for path in self.paths_of[place.path] if ".cmake" in path] if place is not None else []
            known = list_extras(place.path, self.make_glob(cmake)) if place is not None and cmake else ()
            self._extras[package] = known
        return known
