"""What one version of one package offers: headers, interfaces, Python, CMake and programs; and what changed.

`surfaces_of` reads all packages of one repository state; `compare` tells every kind of change in one form.
"""

from __future__ import annotations

import hashlib
import posixpath
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import msgspec

from ...edges.limits import format_limits
from ...impact.conditions import Environment, evaluate_all
from ...impact.facts import kinds
from ...impact.facts.cpp.tree_nodes import COMPUTED
from ...impact.facts.interface import Field, Interface, Section
from ...impact.facts.store import encode_rows
from ...impact.model.package import find_folder_role
from ...impact.source_keys import compute_source_key
from ...impact.targets.parameters import find_last_part
from ...impact.targets.surface.surface import TREE_NODE, BuildSurface, Plugin, Surface
from ..extract import cpp, parameters, python
from . import build as surface_build
from . import python as surface_python
from .headers import keep_compiled_includes

if TYPE_CHECKING:
    from ...impact.facts.extract import ExtractedFacts
    from ...impact.facts.store import Store
    from ...impact.model.workspace import Package, Workspace
    from ...impact.tree import Tree


# -- reading -----------------------------------------------------------------------------------------------------------


def build_surfaces(tree: Tree, store: Store, jobs: int | None = None) -> dict[str, Surface]:
    """The surfaces of all packages of a tree, by name. What is equal in two trees is worked out once: facts by the
    content of their file, surfaces by all that they are made from. jobs: processes to parse with. Raises TreeError."""
    from ...impact.facts.extract import extract_all

    workspace = link_build(tree, store, jobs)
    builds = {package.name: surface_build.build_surface(workspace, package) for package in workspace}
    wanted: dict[str, str] = {}
    headers: dict[str, dict[str, str]] = {}
    guessed: set[str] = set()
    for package in workspace:
        found, sure = _collect_headers(package, builds[package.name])
        headers[package.name] = found
        if not sure:
            guessed.add(package.name)
        wanted.update((path, cpp.__name__) for path in found.values())
        for path in surface_python.find_installed_modules(package).modules.values():
            if surface_python.find_kind(path) is not None:
                wanted[path] = python.__name__
    declaring = {package.name: dict(_list_declaring_files(package)) for package in workspace}
    looked = extract_all(tree, store, jobs=jobs, kind_of=wanted.get)
    sources = {path: kind for each in declaring.values() for path, kind in each.items()}
    declared = extract_all(tree, store, jobs=jobs, kind_of=sources.get)

    def get_facts(path: str) -> Any:
        file = looked.get_facts(path) if path in looked.kinds else None
        return None if file is None else file.facts

    surfaces = {}
    for package in workspace:
        name = package.name
        looked.preload(headers[name].values())
        known = [(include, get_facts(path)) for include, path in sorted(headers[name].items())]
        surfaces[name] = Surface(
            name,
            package.manifest.version,
            _add_tree_nodes(package, builds[name], declared, declaring[name]),
            surface_python.build_surface(package, get_facts),
            tuple((include, keep_compiled_includes(surface)) for include, surface in known if surface is not None),
            tuple(sorted(dict(_list_interfaces(package)).items())),
            name in guessed,
            tuple(sorted(name for name, how in package.declared.items() if how & _WITH)),
            *_merge_parameters(declared, declaring[name]),
        )
    return surfaces


def link_build(tree: Tree, store: Store, jobs: int | None = None) -> Workspace:
    """The packages of a tree with what their builds tell alone. Raises TreeError."""
    from ...impact.facts.extract import extract_all
    from ...impact.model.package import Watched
    from ...impact.model.workspace import link

    extraction = extract_all(tree, store, jobs=jobs, kind_of=_find_build_kind)
    return link(tree, extraction, store, None, Watched(), jobs)


_WITH = frozenset(("exec", "build_export"))


def _list_declaring_files(package: Package) -> Iterator[tuple[str, str]]:
    """Files that may declare parameters of nodes, with the kind of facts that tells it."""
    base = f"{package.path}/" if package.path else ""
    for path in package.files:
        full = path if path.startswith(base) else f"{base}{path}"
        kind = kinds.find_kind(full)
        if kind in ("cpp", "python") and find_folder_role(full[len(base) :]) is None:
            yield full, parameters.make_kind(kind)
    for made in package.build.generated:
        language = {"parameters": "yaml", "reconfigure": "cfg"}.get(made.how)
        if language is not None and made.offered:
            yield from ((path, parameters.make_kind(language)) for path in made.files if "$" not in path)


def _merge_parameters(
    declared: ExtractedFacts, files: Iterable[str]
) -> tuple[tuple[tuple[str, str | None], ...], tuple[str, ...]]:
    """The parameters that some files declare, each with the default that all of them give it, and what they mention."""
    found: dict[str, set[str | None]] = defaultdict(set)
    mentioned: set[str] = set()
    for path in files:
        facts = declared.get_facts(path) if path in declared.kinds else None
        if facts is not None and facts.facts is not None:
            for one in facts.facts.parameters:
                found[one.name].add(one.default)
            mentioned.update(facts.facts.mentioned)
    mentioned.update(find_last_part(name) for name in found)
    parameters = tuple((name, next(iter(each)) if len(each) == 1 else "?") for name, each in sorted(found.items()))
    return parameters, tuple(sorted(mentioned))


_NOTHING_KNOWN = Environment()


def _add_tree_nodes(
    package: Package, build: BuildSurface, declared: ExtractedFacts, files: Iterable[str]
) -> BuildSurface:
    """A build with the nodes of behaviour trees that its installed libraries register, as plugins of their own kind.
    files: those that may register some."""
    found: dict[str, Plugin] = {}
    for path in sorted(list_compiled(package).intersection(files)):
        facts = declared.get_facts(path) if path in declared.kinds else None
        for node in facts.facts.tree_nodes if facts is not None and facts.facts is not None else ():
            holds = evaluate_all(node.conditions, _NOTHING_KNOWN)
            if holds is not False and node.name != COMPUTED and (holds or node.name not in found):
                found[node.name] = Plugin(node.name, node.type, TREE_NODE, bool(holds))
    nodes = (found[name] for name in sorted(found))
    return msgspec.structs.replace(build, plugins=(*build.plugins, *nodes)) if found else build


def list_compiled(package: Package, kinds: Collection[str] = ("library", "module")) -> frozenset[str]:
    """What the targets of some kinds are compiled from that a package installs."""
    installs = (one for one in package.build.installs if one.kind == "targets" and one.destination[:5] != "share")
    installed = {name for install in installs for name in install.items}
    targets = (one for one in package.build.targets if one.kind in kinds and one.name in installed)
    return frozenset(path for target in targets for path in target.sources)


def build_tree_surfaces(tree: Tree, store: Store, folder: str = "", jobs: int | None = None) -> dict[str, Surface]:
    """The same as surfaces_of, remembered as a whole for trees that git names by one id. folder: that id, empty for a
    tree that has none."""
    key = hashlib.sha1(f"{folder} {compute_source_key(__name__)} {format_limits()}".encode()).digest()
    if folder:
        memory = store.find_memo("surface", key)
        if memory is not None:
            try:
                return _decoder.decode(memory)
            except msgspec.MsgspecError:
                pass  # of another version; it is made again
    surfaces = build_surfaces(tree, store, jobs)
    if folder:
        store.remember("surface", encode_rows([(key, surfaces)]))
    return surfaces


_decoder = msgspec.msgpack.Decoder(dict[str, Surface])


def _find_build_kind(path: str) -> str | None:
    kind = kinds.find_kind(path)
    return kind if kind in surface_build.KINDS else None


def _collect_headers(package: Package, build: BuildSurface) -> tuple[dict[str, str], bool]:
    """Path in the workspace by what dependants write, and whether the build tells that."""
    base = f"{package.path}/" if package.path else ""
    found = {}
    for header in build.headers:
        if header.source and kinds.find_kind(header.source) == "cpp":
            found.setdefault(header.include, f"{base}{header.source}")
    if found or not any(part == "headers" for part, _ in build.unknown):
        return found, True
    start = f"{base}include/"
    for path in package.files:
        full = path if path.startswith(base) else f"{base}{path}"
        if full.startswith(start) and kinds.find_kind(full) == "cpp":
            found[full[len(start) :]] = full
    return found, not found


def _list_interfaces(package: Package) -> Iterator[tuple[str, Interface]]:
    made = {path: False for one in package.build.generated if not one.offered for path in one.files}
    made.update((path, True) for one in package.build.generated if one.offered for path in one.files)
    for file in package.linked.interfaces:
        if not made.get(file.path, True):
            continue
        kind = file.definition.kind
        if kind == "idl":
            kind = posixpath.basename(posixpath.dirname(file.path)) or "msg"
        sections = tuple(
            Section(
                section.name,
                tuple(Field(f.name, f.type, f.array, f.default, f.line) for f in section.fields),
                section.constants,
            )
            for section in file.definition.sections
        )
        yield f"{kind}/{posixpath.splitext(posixpath.basename(file.path))[0]}", Interface(kind, sections)


# -- a repository state ------------------------------------------------------------------------------------------------


# -- what changed ------------------------------------------------------------------------------------------------------


# C++


# Python


# Messages


# The build


