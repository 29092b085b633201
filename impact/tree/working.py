"""A directory as it stands."""

import os
import stat
import time
from array import array
from itertools import islice

import msgspec

from ...edges import files
from ...edges.limits import get_limits
from .ignore import Index, find_enclosing_repository
from .paths import (
    LEAVES,
    VERSION_CONTROL,
    PathProblem,
    TreeEntry,
    TreeError,
    Walked,
    compute_blob_id,
    find_file_size_limit,
    find_ignore_marker,
    is_within,
    join,
    make_outside_error,
    normalize_path,
    shown,
)

PRODUCTS = frozenset(("build", "install", "devel", "log"))
# A file whose time stamp is this close to the moment it was read may change once more without its time stamp showing
# it (FAT keeps two seconds), so its id is not remembered. Git calls such entries racy.
RACY_NS = 2_000_000_000
# Hidden folders of files that people write, such as those that name the workspace's distro.
_SETTINGS = frozenset((".circleci", ".devcontainer", ".docker", ".github", ".gitlab"))
LINKED_FILES_AT_MOST = 20_000
_INDEX_FORMAT = 1


class WorkingTree(Walked):
    """A directory as it stands, uncommitted and untracked files included.

    root: a folder, or a link to one; raises TreeError when it is none. follow_links: also follow links that leave the
    folder, and read what they lead to. Nothing is read before entries() or another question is asked.
    """

    def __init__(self, root: str | os.PathLike[str], *, follow_links: bool = False):
        self.root = os.path.abspath(os.fsdecode(root))
        if not os.path.isdir(self.root):
            what = "is a file, not a folder" if os.path.exists(self.root) else "does not exist"
            raise TreeError(f"`{shown(self.root)}` {what}; give the folder of a workspace or a package")
        self.name = os.path.basename(self.root)
        self.label = shown(self.name or self.root)
        self.follow_links = follow_links
        self._begin()
        self._real_root = os.path.realpath(self.root)
        self._device = os.stat(self.root).st_dev
        self._repositories: dict[str, str] = {}
        self._folders: set[str] = set()
        self._stats: dict[str, tuple[int, int, int, int]] = {}
        self._devices: dict[str, int] = {}
        self._ids: dict[str, str] = {}
        self._remembered: dict[str, tuple[tuple[int, int, int, int], str]] = {}
        self._fresh = False
        self._indexes: dict[str, Index | None] = {}
        self.submodules: list[str] = []
        """Folders that .gitmodules name, once the entries are known."""

    @property
    def repositories(self) -> dict[str, str]:
        self.list_entries()
        return self._repositories

    def count_levels_in_repository(self) -> int:
        """How far below the root of its git repository the tree is; 0 at the root and outside of repositories."""
        enclosing = find_enclosing_repository(self._real_root)
        folder = os.path.relpath(self._real_root, enclosing or self._real_root)
        return 0 if folder == os.curdir else folder.count(os.sep) + 1

    def open_folder_of_repository(self, folder: str) -> "WorkingTree":
        """A folder of the repository that holds the tree, by its path in that. Raises TreeError where there is none."""
        return WorkingTree(os.path.join(find_enclosing_repository(self._real_root) or self._real_root, folder))

    def _walk(self, found: list[TreeEntry]) -> None:
        real_root = self._real_root
        enclosing = find_enclosing_repository(real_root)
        if enclosing and enclosing != real_root:
            self._repositories[""] = enclosing
        links: list[tuple[str, str, tuple[str, ...]]] = []
        # (folder relative to the root, its real path, the repository that governs it)
        stack = [("", real_root, enclosing)]
        while stack and self._left > 0:
            folder, real, repository = stack.pop()
            self._list_folder(folder, real, repository, (), stack, links, found)
        followed: set[str] = set()
        visited: set[str] = set()
        links.sort()  # a folder's order on the disk decides nothing
        for link, target, parents in links:  # grows while links lead to further links
            known = len(links)
            if not self._may_follow(link, target, parents, followed):
                continue
            in_tree = is_within(target, real_root)
            self.aliases[link] = os.path.relpath(target, real_root) if in_tree else target
            stack = [(link, target, find_enclosing_repository(target))]
            limit = len(found) + LINKED_FILES_AT_MOST
            while stack and self._left > 0:
                folder, real, repository = stack.pop()
                if real in visited:
                    continue
                visited.add(real)
                if not in_tree and len(found) > limit:
                    message = f"the link leads to more than {LINKED_FILES_AT_MOST} files, the rest is left out"
                    self.problems.append(PathProblem(link, message))
                    break
                self._list_folder(folder, real, repository, parents, stack, links, found)
            links[known:] = sorted(links[known:])

    def _list_folder(
        self, folder: str, real: str, repository: str | None, parents: tuple[str, ...],
        stack: list[tuple[str, str, str | None]], links: list[tuple[str, str, tuple[str, ...]]], found: list[TreeEntry],
    ) -> None:  # fmt: skip
        """Lists one folder: files go to found, folders onto the stack, links to folders into links."""
        try:
            with os.scandir(os.path.join(self.root, folder)) as scan:
                items = list(islice(scan, self._left + 1))
        except OSError as error:
            self.problems.append(PathProblem(folder or ".", f"the folder cannot be listed: {_format_reason(error)}"))
            return
        names = {item.name for item in items}
        if marker := find_ignore_marker(names):
            self.skipped.append(PathProblem(folder or ".", f"holds {marker}"))
            return
        self._count(folder, len(items), folder or ".")
        if ".git" in names:
            repository = real
            self._repositories[folder] = real
        self._folders.add(folder)
        prefix = folder + "/" if folder else ""
        device = self._device
        for item in items:
            name = item.name
            path = prefix + name
            try:
                if item.is_dir(follow_symlinks=False):
                    why = self._explain_untracked(name, path, os.path.join(real, name), repository)
                    if why:
                        self.skipped.append(PathProblem(path, why))
                    elif name not in VERSION_CONTROL:
                        stack.append((path, os.path.join(real, name), repository))
                    continue
                if name in VERSION_CONTROL:
                    continue
                target = ""
                if item.is_symlink():
                    target = os.path.realpath(os.path.join(self.root, path))
                    why = self._explain_refused(target)
                    if why:
                        self.problems.append(PathProblem(path, why))
                        continue
                    status = os.stat(os.path.join(self.root, path))
                else:
                    status = item.stat(follow_symlinks=False)
            except OSError as error:
                self.problems.append(PathProblem(path, self._explain_unreadable(path, error)))
                continue
            if stat.S_ISREG(status.st_mode):
                found.append(TreeEntry(path, status.st_size))
                self._stats[path] = _make_stamp(status)
                if status.st_dev != device:
                    self._devices[path] = status.st_dev
            elif stat.S_ISDIR(status.st_mode):
                links.append((path, target or os.path.realpath(os.path.join(self.root, path)), (*parents, real)))
            else:
                self.problems.append(PathProblem(path, "neither a file nor a folder"))
        if ".gitmodules" in names:
            self._note_submodules(folder)

    def _explain_refused(self, real: str) -> str:
        """Why what has this real path is not read, or an empty string."""
        if not is_within(real, self._real_root):
            return "" if self.follow_links else LEAVES
        parts = real[len(self._real_root) :].split("/")
        closed = next((part for part in parts if part in VERSION_CONTROL), "")
        return f"the link leads into `{closed}`, which is not read" if closed else ""

    def _explain_unreadable(self, path: str, error: OSError) -> str:
        try:
            target = os.readlink(os.path.join(self.root, path))
        except OSError:
            return f"cannot be read: {_format_reason(error)}"
        return f"the link to `{shown(target)}` is broken: {_format_reason(error)}"

    def _explain_untracked(self, name: str, path: str, real: str, repository: str | None) -> str:
        """Why a folder is left out, or an empty string."""
        if name in VERSION_CONTROL or repository is None:
            return ""
        if path in PRODUCTS:
            why = "looks like a product of the build, and git tracks nothing in it"
        elif name[0] == "." and name not in _SETTINGS:
            why = "hidden, and git tracks nothing in it"
        elif name == "node_modules" or (name.endswith(("env", "ENV")) and os.path.lexists(f"{real}/pyvenv.cfg")):
            why = "holds installed packages, and git tracks nothing in it"
        else:
            return ""
        if os.path.lexists(os.path.join(real, ".git")):
            return ""
        if repository not in self._indexes:
            self._indexes[repository] = Index.open_index(repository)
        index = self._indexes[repository]
        inner = os.path.relpath(real, repository).replace(os.sep, "/")
        return "" if index is None or index.tracks_below(inner) else why

    def _note_submodules(self, folder: str) -> None:
        """Names the submodules of a repository that are not checked out."""
        try:
            text = self.read(join(folder, ".gitmodules"), get_limits().settings)
        except OSError:
            return
        for line in text.splitlines():
            key, _, value = line.partition(b"=")
            if key.strip() != b"path":
                continue
            path = normalize_path(join(folder, value.strip().strip(b'"').decode("utf-8", "surrogateescape")))
            if path:
                self.submodules.append(path)
            if path and not self._holds_something(path):
                self.problems.append(PathProblem(path, "submodule that is not checked out"))

    def _holds_something(self, path: str) -> bool:
        try:
            with os.scandir(self._resolve_contained(path)) as scan:
                return next(scan, None) is not None
        except OSError:
            return False

    def find_known_id(self, path: str) -> str | None:
        known = self._ids.get(path)
        if known is None:
            remembered = self._remembered.get(path)
            if remembered is not None and remembered[0] == self._stats.get(path):
                known = self._ids[path] = remembered[1]
        return known

    def find_state(self, path: str) -> object | None:
        """What tells the content of a file that was walked from what it was at other times, without reading it; None
        where it may still change without its time stamp showing it."""
        stamp = self._stats[path]
        known = self.find_known_id(path)
        return known or (stamp if max(stamp[1], stamp[3]) < time.time_ns() - RACY_NS else None)

    def find_content_id(self, path: str) -> str:
        return self.find_known_id(path) or self.read_with_id(path)[1]

    def read(self, path: str, limit: int = 0) -> bytes:
        return self._read(path, limit)[0]

    def read_with_id(self, path: str, limit: int = 0) -> tuple[bytes, str]:
        data, status = self._read(path, limit)
        content = compute_blob_id(data)
        self._ids[path] = content
        stamp = _make_stamp(status)
        self._stats[path] = stamp
        if max(status.st_mtime_ns, status.st_ctime_ns) < time.time_ns() - RACY_NS and status.st_size == len(data):
            self._remembered[path] = (stamp, content)
            self._fresh = True
        elif self._remembered.pop(path, None):
            self._fresh = True
        return data, content

    def _read(self, path: str, limit: int) -> tuple[bytes, os.stat_result]:
        """A regular file's bytes and status. What the walk found is read as it stands where it is still the same file;
        anything else must really lie where it may be read."""
        walked = self._stats.get(path)
        place = os.path.join(self.root, path) if walked is not None else self._resolve_contained(path)
        data, status = files.read_with_status(place, limit or find_file_size_limit())
        if walked is not None and (
            walked[2] != _make_stamp(status)[2] or status.st_dev != self._devices.get(path, self._device)
        ):
            self._resolve_contained(path)
            self._devices[path] = status.st_dev
        return data, status

    def _resolve_contained(self, path: str) -> str:
        """The absolute path of what may be read. Raises OSError for what really lies outside of the tree."""
        clean = normalize_path(path)
        if clean is None:
            raise make_outside_error(path)
        real = os.path.realpath(os.path.join(self.root, clean))
        if self._explain_refused(real):
            raise make_outside_error(path)
        return real

    def exists(self, path: str) -> bool:
        if path in self._stats or path in self._folders:
            return True
        real = self._find_real_path(path)
        return real is not None and os.path.exists(real)

    def is_dir(self, path: str) -> bool:
        if path in self._stats:
            return False
        if path in self._folders:
            return True
        real = self._find_real_path(path)
        return real is not None and os.path.isdir(real)

    def _find_real_path(self, path: str) -> str | None:
        """The real path of what may be asked about; None for what lies outside."""
        clean = normalize_path(path)
        if clean is None:
            return None
        real = os.path.realpath(os.path.join(self.root, clean))
        return real if self.follow_links or is_within(real, self._real_root) else None

    def make_memory_key(self) -> bytes | None:
        return self.root.encode("utf-8", "surrogateescape")

    def recall(self, memory: bytes) -> None:
        self._remembered = _decode_memory(memory)

    def make_memory(self) -> bytes | None:
        stale = len(self._remembered) > 2 * len(self._stats) + 100
        if not self._fresh and not stale:
            return None
        stats = self._stats
        return _encode_memory({path: kept for path, kept in self._remembered.items() if path in stats})


def _make_stamp(status: os.stat_result) -> tuple[int, int, int, int]:
    return (status.st_size, status.st_mtime_ns, status.st_ino & 0x7FFFFFFFFFFFFFFF, status.st_ctime_ns)


def _format_reason(error: OSError) -> str:
    return (error.strerror or type(error).__name__).lower()


def _encode_memory(remembered: dict[str, tuple[tuple[int, int, int, int], str]]) -> bytes:
    stamps = array("q")
    for stamp, _ in remembered.values():
        stamps.extend(stamp)
    paths = "\0".join(remembered).encode("utf-8", "surrogateescape")
    ids = bytes.fromhex("".join(content for _, content in remembered.values()))
    return msgspec.msgpack.encode((_INDEX_FORMAT, paths, stamps.tobytes(), ids))


def _decode_memory(memory: bytes) -> dict[str, tuple[tuple[int, int, int, int], str]]:
    try:
        version, paths, packed, ids = msgspec.msgpack.decode(memory, type=tuple[int, bytes, bytes, bytes])
        stamps = array("q")
        stamps.frombytes(packed)
    except (msgspec.MsgspecError, ValueError):
        return {}
    names = paths.decode("utf-8", "surrogateescape").split("\0") if paths else []
    if version != _INDEX_FORMAT or len(stamps) != 4 * len(names) or len(ids) != 20 * len(names):
        return {}
    digits = ids.hex()
    four = iter(stamps)
    rows = zip(four, four, four, four, strict=True)
    return {
        name: (stamp, digits[40 * at : 40 * at + 40]) for at, (name, stamp) in enumerate(zip(names, rows, strict=True))
    }
