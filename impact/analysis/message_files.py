"""Where definitions of messages lie: the files of folders, and of the installation of a sourced environment."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from ...edges.console import UserError, escape
from ...edges.files import read_file
from ...edges.limits import get_limits
from ..facts.manifest import extract as extract_manifest
from ..tree import Tree, WorkingTree

_PREFIXES = ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH")


class MessageFolders:
    """The messages of some folders. A folder is a workspace, a package, or the `share` of an installation."""

    def __init__(self, folders: Iterable[Path], environment: Mapping[str, str]):
        self._folders = tuple(folders)
        self._environment = environment
        self._trees: list[tuple[Tree, dict[str, list[str]], set[str]]] | None = None
        self._packages: dict[tuple[int, str], str] = {}

    def find(self, full_name: str) -> bytes | None:
        """The text of a message, of the first folder that has it; else that of the sourced environment. Raises
        UserError where a folder cannot be read."""
        package, _, name = full_name.rpartition("/")
        for number, (tree, by_name, _) in enumerate(self._open_trees()):
            for path in by_name.get(f"{name}.msg", ()):
                if self._find_package(number, path) == package:
                    return _read_safely(tree, path)
        for variable in _PREFIXES if package else ():
            for prefix in filter(None, self._environment.get(variable, "").split(os.pathsep)):
                for folder in ("share", ""):
                    try:
                        return read_file(Path(prefix, folder, package, "msg", f"{name}.msg"), get_limits().interface)
                    except OSError:
                        continue
        return None

    def _open_trees(self) -> list[tuple[Tree, dict[str, list[str]], set[str]]]:
        if self._trees is None:
            self._trees = []
            for folder in self._folders:
                if not folder.is_dir():
                    raise UserError(f"{escape(str(folder))}: is no folder; name a workspace or a folder of packages")
                tree = WorkingTree(folder)
                by_name: dict[str, list[str]] = {}
                manifests: set[str] = set()
                for entry in tree.list_entries():
                    name = entry.path.rpartition("/")[2]
                    if name.endswith(".msg"):
                        by_name.setdefault(name, []).append(entry.path)
                    elif name == "package.xml":
                        manifests.add(entry.path)
                self._trees.append((tree, by_name, manifests))
        return self._trees

    def _find_package(self, number: int, path: str) -> str:
        """The name of the package that a file of a tree belongs to; the folder's name where no manifest tells."""
        folder = path.rpartition("/")[0]
        if (number, folder) not in self._packages:
            tree, _, manifests = self._open_trees()[number]
            place, name = folder, ""
            while True:
                manifest = f"{place}/package.xml".lstrip("/")
                if manifest in manifests:
                    name = extract_manifest(_read_safely(tree, manifest)).name or place.rpartition("/")[2]
                    break
                if not place:
                    name = folder.removesuffix("/msg").rpartition("/")[2]
                    break
                place = place.rpartition("/")[0]
            self._packages[number, folder] = name
        return self._packages[number, folder]


class ReleasedMessages:
    """The messages of released packages: of the sourced environment, else as rosbags has them, where that is there.
    ros: the generation."""

    def __init__(self, ros: int):
        self._ros = ros
        self._folders = MessageFolders((), os.environ)
        self._known: dict[str, bytes | None] = {}

    def find(self, full_name: str) -> bytes | None:
        """The text of the message `package/Name`, None where it is not known."""
        if full_name not in self._known:
            self._known[full_name] = self._folders.find(full_name) or self._write(full_name)
        return self._known[full_name]

    def _write(self, full_name: str) -> bytes | None:
        try:
            from rosbags.typesys import Stores, get_typestore  # pyright: ignore[reportMissingImports]
        except ImportError:
            return None
        store = get_typestore(Stores.ROS1_NOETIC if self._ros == 1 else Stores.LATEST)
        package, _, name = full_name.partition("/")
        key = f"{package}/msg/{name}"
        if key not in store.fielddefs:
            return None
        text = store.generate_msgdef(key, ros_version=self._ros)[0]
        return text.partition("=" * 80)[0].encode()


def _read_safely(tree: Tree, path: str) -> bytes:
    try:
        return tree.read(path, get_limits().interface)
    except OSError as error:
        raise UserError(
            f"{escape(path)}: cannot be read: {error.strerror or error}; mend it, or leave it out"
        ) from None


def locate_package(file: Path) -> tuple[str, Path]:
    """(name, folder) of the package that a message's file belongs to. Without a manifest above it, that is the folder
    above `msg`, else none, with the file's own folder."""
    here = Path(os.path.abspath(file)).parent
    for folder in (here, *here.parents):
        manifest = folder / "package.xml"
        if manifest.is_file():
            try:
                return extract_manifest(read_file(manifest, get_limits().manifest)).name or folder.name, folder
            except OSError:
                break
    return (here.parent.name, here.parent) if here.name == "msg" else ("", here)
