"""Which files of a tree the message flow reads, told before any of them is read."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable

from ...facts.extract import ExtractedFacts
from ...facts.kinds import FLOW, find_kind
from ...source_keys import compute_code_stamp
from ...tree.paths import Tree
from ..package import find_folder_role
from ..workspace import Workspace

_READ = frozenset(("cpp", "python", "script", "launch_xml", "launch_yaml", "params", "xml", "manifest", "cmake"))
_MANIFESTS = ("manifest", "manifest_variant")
BUILD = frozenset(
    (*_MANIFESTS, "cmake", "setup_py", "setup_cfg", "plugin_xml", "xml", "msg", "srv", "action")
)  # fmt: skip
"""Kinds of files that tell what is built of the code, and which interfaces there are."""


def make_code_selector(tree: Tree) -> Callable[[str], str | None]:
    """The kind of flow facts wanted of a path of a tree; None for what is no code, tests, and what no package owns.

    Which folders are packages is not known before files are read: a file is left out when it would be a test of
    whatever manifest lies above it.
    """
    roots = {entry.path.rpartition("/")[0] for entry in tree.list_entries() if find_kind(entry.path) in _MANIFESTS}
    above: dict[str, tuple[int, ...]] = {}

    def list_starts(folder: str) -> tuple[int, ...]:
        """Where paths within each package that may own a folder begin."""
        known = above.get(folder)
        if known is None:
            found = [0] if "" in roots else []
            outer = folder
            while outer:
                if outer in roots:
                    found.append(len(outer) + 1)
                outer = outer.rpartition("/")[0]
            known = above[folder] = tuple(found)
        return known

    def select_kind(path: str) -> str | None:
        kind = FLOW.get(find_kind(path) or "")
        if kind is None:
            return None
        inside = list_starts(path.rpartition("/")[0])
        return kind if any(is_code(path, start) for start in inside) else None

    return select_kind


def is_code(path: str, start: int) -> bool:
    """Whether a file is part of what a package runs: neither a test nor in a hidden folder. start: where its path
    within the package begins."""
    module = path[: max(0, start - 1)].rpartition("/")[2]
    return "/." not in f"/{path[start:]}" and find_folder_role(path[start:], module) != "test"


def compute_stamp(workspace: Workspace) -> bytes:
    """Differs whenever something does that message flow, or what launch files start, is joined from."""
    main = workspace.extraction
    return _hash_files(workspace.identity, ((main, _READ), (main.second, None)))


def compute_code_key(workspace: Workspace, second: ExtractedFacts) -> bytes:
    """Differs whenever the code does, or what is built of it; not with what launch files start. second: its flow
    facts."""
    packages = [(package.name, package.path, package.build_type) for package in workspace]
    return _hash_files(repr((workspace.ros, packages)).encode(), ((second, None), (workspace.extraction, BUILD)))


def _hash_files(first: bytes, chosen: Iterable[tuple[ExtractedFacts | None, frozenset[str] | None]]) -> bytes:
    """A digest of paths and contents of files. chosen: which kinds of which, all where there are none."""
    found = hashlib.sha1(first + compute_code_stamp().encode())
    for extraction, kinds in chosen:
        for path in sorted(extraction.kinds if extraction is not None else ()):
            if extraction is not None and (kinds is None or extraction.kinds[path] in kinds):
                row = f"{path} {extraction.ids.get(path, '')} {extraction.kinds[path]}\n"
                found.update(row.encode("utf-8", "surrogateescape"))
    return found.digest()
