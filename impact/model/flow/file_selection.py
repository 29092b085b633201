"""Which files of a tree the message flow reads, told before any of them is read."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

from ...facts.extract import ExtractedFacts
from ...facts.kinds import FLOW, find_kind
from ...source_keys import compute_code_stamp
from ...tree.paths import Tree
from ..package import find_folder_role
from ..workspace import Workspace

_READ = frozenset(("cpp", "python", "script", "launch_xml", "launch_yaml", "params", "xml", "manifest", "cmake"))
_NAME = re.compile(rb"<name>([^<>]{1,200})</name>")
_NAMES_ROS = re.compile(rb"\b(?:rospy|rclpy)\b")
_MANIFESTS = ("manifest", "manifest_variant")
BUILD = frozenset(
    (*_MANIFESTS, "cmake", "setup_py", "setup_cfg", "plugin_xml", "xml", "msg", "srv", "action")
)  # fmt: skip
"""Kinds of files that tell what is built of the code, and which interfaces there are."""
_CODE_READS = BUILD | {"params"}


def make_code_selector(tree: Tree) -> Callable[[str], str | None]:
    """The kind of flow facts wanted of a path of a tree; None for what is no code, tests, and what no package owns, but
    for programs in Python that are run by hand.

    Which folders are packages is not known before files are read: a file is left out when it would be a test of
    whatever manifest lies above it.
    """
    paths = [entry.path for entry in tree.list_entries()]
    roots = {path.rpartition("/")[0] for path in paths if find_kind(path) in _MANIFESTS}
    names = {root: _read_name(tree, root) for root in _list_doubtful(paths, roots)}
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
        if not inside and may_be_run_by_hand(path):
            return kind if _NAMES_ROS.search(_read(tree, path)) else None
        own = ((start, names.get(path[: max(0, start - 1)], "")) for start in inside)
        return kind if any(is_code(path, start, name) for start, name in own) else None

    return select_kind


def _list_doubtful(paths: Iterable[str], roots: Collection[str]) -> set[str]:
    """The packages that have a folder of Python which is called like one of tests, and may be their module."""
    inner = (path.removesuffix("/__init__.py") for path in paths if path.endswith("/__init__.py"))
    rows = (folder.rpartition("/") for folder in inner)
    return {root for root, _, name in rows if root in roots and find_folder_role(f"{name}/_.py") == "test"}


def _read_name(tree: Tree, root: str) -> str:
    """What the manifest of a package calls it; empty where it has none such."""
    found = _NAME.search(_read(tree, f"{root}/package.xml".lstrip("/")))
    return found[1].decode("utf-8", "replace").strip() if found is not None else ""


def _read(tree: Tree, path: str) -> bytes:
    """A file of a tree, empty where it cannot be read."""
    try:
        return tree.read(path)
    except (OSError, KeyError):
        return b""


def list_run_by_hand(kinds: Mapping[str, str], manifests: Mapping[str, str]) -> Iterator[str]:
    """The programs in Python, and what they import, that lie outside of all packages. kinds: of flow facts, by path;
    manifests: paths of a tree to their kinds."""
    roots = {path.rpartition("/")[0] for path, kind in manifests.items() if kind in _MANIFESTS}
    for path in kinds:
        parts = path.split("/")[:-1]
        above = ("/".join(parts[:count]) for count in range(len(parts) + 1))
        if may_be_run_by_hand(path) and roots.isdisjoint(above):
            yield path


def may_be_run_by_hand(path: str) -> bool:
    """Whether a file outside of all packages may be a program that is run by hand, or what one imports."""
    *folders, name = path.split("/")
    # Only of a package can more be said to be its tests.
    kept = not any(folder[:1] == "." or folder in ("test", "tests") for folder in folders)
    tested = name.startswith("test_") or name.endswith("_test.py")
    return kept and not tested and name.endswith(".py") and name not in ("setup.py", "conf.py")


def is_code(path: str, start: int, name: str = "") -> bool:
    """Whether a file is part of what a package runs: neither a test nor in a hidden folder. start: where its path
    within the package begins; name: the package's, where it is known."""
    modules = {path[: max(0, start - 1)].rpartition("/")[2], name}
    inner = path[start:]
    return "/." not in f"/{inner}" and any(find_folder_role(inner, module) != "test" for module in modules)


def compute_stamp(workspace: Workspace) -> bytes:
    """Differs whenever something does that message flow, or what launch files start, is joined from."""
    main = workspace.extraction
    return _hash_files(workspace.identity, ((main, _READ), (main.second, None)))


def compute_code_key(workspace: Workspace, second: ExtractedFacts) -> bytes:
    """Differs whenever the code does, what is built of it, or a file that it may read; not with what launch files
    start. second: its flow facts."""
    packages = [(package.name, package.path, package.build_type) for package in workspace]
    return _hash_files(repr((workspace.ros, packages)).encode(), ((second, None), (workspace.extraction, _CODE_READS)))


def _hash_files(first: bytes, chosen: Iterable[tuple[ExtractedFacts | None, frozenset[str] | None]]) -> bytes:
    """A digest of paths and contents of files. chosen: which kinds of which, all where there are none."""
    found = hashlib.sha1(first + compute_code_stamp().encode())
    for extraction, kinds in chosen:
        for path in sorted(extraction.kinds if extraction is not None else ()):
            if extraction is not None and (kinds is None or extraction.kinds[path] in kinds):
                row = f"{path} {extraction.ids.get(path, '')} {extraction.kinds[path]}\n"
                found.update(row.encode("utf-8", "surrogateescape"))
    return found.digest()
