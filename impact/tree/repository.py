"""Opening a git repository that anybody may have written, and reading its objects within limits.

libgit2 opens what it finds by name, and waits for ever where that is a named pipe. So all that it may open is looked
at before: each must be a file or a folder, and none but objects and packs may be large. Links within a repository and
alternates may lead elsewhere, as those of shared clones do: only objects whose id is known can be read through them.
"""

import errno
import os
import stat
import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

from ...edges import files
from ...edges.limits import KB, format_size, get_limits
from ...edges.memory import cache_method
from .ignore import find_git_dir
from .paths import LONGEST_PATH, TreeError, shown

MODE_FOLDER, MODE_LINK, MODE_SUBMODULE = 0o040000, 0o120000, 0o160000
MISSING = "its object is missing from this repository"
DAMAGED = "its object is damaged"
_SMALL_FILE = 64 * KB
_ALTERNATES_DEEP = 5
_INCLUDES_DEEP = 10
_MOST_NAMED = 3
_TREE, _BLOB = 2, 3
# Folders of a repository that libgit2 opens files in.
_FOLDERS = frozenset(("refs", "objects", "info", "logs", "reftable"))
# Files beside them: HEAD, FETCH_HEAD and the like, and these. Others may be anything (fsmonitor keeps a socket there).
_FILES = frozenset(("config", "config.worktree", "packed-refs", "index", "shallow", "commondir", "gitdir"))


class OpenedRepository(NamedTuple):
    """A repository; ids of objects that are not read since their files are too large; files of loose objects by id."""

    repository: Any
    refused: frozenset[str]
    loose: dict[str, str]


def open_repository(place: str) -> OpenedRepository:
    """The repository at or above a folder. Raises TreeError."""
    import pygit2

    # Git refuses repositories of other users because it would run their hooks. Here only objects are read.
    pygit2.option(pygit2.enums.Option.SET_OWNER_VALIDATION, False)
    try:
        check = _Check()
        check.check_enclosing(os.path.realpath(place))
        found = pygit2.discover_repository(place)
        if found is None:
            if not os.path.exists(place):
                raise TreeError(f"`{shown(place)}` does not exist; give a git repository, or a folder in one")
            raise TreeError(f"`{shown(place)}` is not in a git repository; {_suggest_inner(place)}")
        check.check_repository(os.path.realpath(found))
        return OpenedRepository(pygit2.Repository(found), frozenset(check.refused), check.loose)
    except (pygit2.GitError, KeyError, ValueError, OSError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        named = f"`{shown(str(error.filename))}`: " if isinstance(error, OSError) and error.filename else ""
        text = f"the git repository `{shown(place)}` cannot be opened: {named}{shown(str(reason))}; repair or remove it"
        raise TreeError(text) from None


def _suggest_inner(place: str) -> str:
    """What to give instead of a folder that is in no repository: one of those in it, or any."""
    from .working import WorkingTree

    inner = [os.path.join(place, folder) for folder in sorted(WorkingTree(place).repositories)]
    if not inner:
        return "give a folder that is in one"
    named = ", ".join(f"`{shown(folder)}`" for folder in inner[:_MOST_NAMED])
    more = f" and {len(inner) - _MOST_NAMED:,} more" if len(inner) > _MOST_NAMED else ""
    return f"a revision is one of a single repository: give one of those in it ({named}{more})"


class _Check:
    """Looks at all that libgit2 may open of a repository. Raises OSError for what could stop it. refused: ids of loose
    objects whose files are too large to be read."""

    def __init__(self):
        self.refused: set[str] = set()
        self.loose: dict[str, str] = {}
        self._seen: set[str] = set()
        self._left = get_limits().entries

    def check_enclosing(self, folder: str) -> None:
        """The first repository at or above a folder, as git looks for it."""
        while True:
            if os.path.lexists(os.path.join(folder, ".git")):
                with_git = os.path.join(folder, ".git")
                if not os.path.isdir(with_git) and not stat.S_ISREG(os.stat(with_git).st_mode):
                    raise OSError(errno.EINVAL, files.NOT_REGULAR, with_git)
                try:
                    self.check_repository(os.path.realpath(find_git_dir(folder)))
                except OSError as error:
                    if error.errno != errno.EINVAL or error.filename != with_git:
                        raise
                return None
            if all(os.path.lexists(os.path.join(folder, name)) for name in ("HEAD", "objects", "refs")):
                return self.check_repository(folder)
            parent = os.path.dirname(folder)
            if parent == folder:
                return None
            folder = parent

    def check_repository(self, place: str) -> None:
        """A git directory, and the one that it shares its objects with (a worktree's)."""
        if place in self._seen or not os.path.isdir(place):
            return
        self._seen.add(place)
        with os.scandir(place) as scan:
            items = list(scan)
        for item in items:
            if item.name in _FOLDERS:
                self._check_folder(item.path, objects=item.name == "objects")
            elif item.name in _FILES or item.name.isupper():
                self._check_file(item, get_limits().index)
        self._includes(os.path.join(place, "config"), 0)
        common = os.path.join(place, "commondir")
        if os.path.isfile(common):
            text = os.fsdecode(files.read_file(common, _SMALL_FILE)).strip()
            if "\0" not in text:
                self.check_repository(os.path.realpath(os.path.join(place, text)))

    def _check_folder(self, top: str, objects: bool = False, deep: int = 0) -> None:
        """A folder with all that it holds; of one with objects, the folders too that its alternates name."""
        stack = [top]
        while stack:
            folder = stack.pop()
            real = os.path.realpath(folder)
            if real in self._seen or not os.path.isdir(real):
                if os.path.exists(real) and not os.path.isdir(real):
                    raise OSError(errno.ENOTDIR, "not a folder", folder)
                continue
            self._seen.add(real)
            with os.scandir(folder) as scan:
                items = list(scan)
            self._left -= len(items)
            if self._left < 0:
                raise OSError(errno.E2BIG, f"more than {get_limits().entries:,} files", top)
            name = os.path.basename(folder)
            loose = name if objects and len(name) == 2 else ""
            for item in items:
                if item.is_dir():
                    stack.append(item.path)
                elif objects and name == "pack":
                    self._check_file(item, 0)
                elif loose:
                    if self._check_file(item, 0) > get_limits().object:
                        self.refused.add(loose + item.name)
                    self.loose[loose + item.name] = item.path
                    _check_commit(item.path)
                else:
                    self._check_file(item, get_limits().index)
        if objects and deep < _ALTERNATES_DEEP:
            for other in _list_alternates(top):
                self._check_folder(other, objects=True, deep=deep + 1)

    def _check_file(self, item: os.DirEntry[str], limit: int) -> int:
        """The size of a file. Raises OSError where it is none, or larger than the limit when there is one."""
        try:
            status = item.stat()
        except OSError:
            return 0  # a broken link, or gone by now: libgit2 finds that out too
        if stat.S_ISDIR(status.st_mode):
            return 0
        if not stat.S_ISREG(status.st_mode) or (item.is_symlink() and _is_system_path(os.path.realpath(item.path))):
            raise OSError(errno.EINVAL, files.NOT_REGULAR, item.path)
        if limit and status.st_size > limit:
            raise OSError(errno.EFBIG, f"larger than {format_size(limit)}", item.path)
        return status.st_size

    def _includes(self, config: str, deep: int) -> None:
        """Files that a configuration includes, which libgit2 reads too."""
        if deep > _INCLUDES_DEEP or not os.path.lexists(config):
            return
        try:
            text = os.fsdecode(files.read_file(config, get_limits().settings))
        except FileNotFoundError:
            return
        included = False
        for line in text.splitlines():
            line = line.strip()
            if line.startswith("["):
                included = line[1:].lstrip().lower().startswith("include")
            name, _, value = line.rpartition("]")[2].partition("=")
            if included and name.strip().lower() == "path" and "\0" not in value:
                path = os.path.expanduser(value.strip().strip('"'))
                self._includes(os.path.join(os.path.dirname(config), path), deep + 1)


def _check_commit(place: str) -> None:
    """Raises OSError for a loose commit or tag that is cut off: libgit2 would wait for the rest for ever, and reads
    commits by itself. Files and folders are looked at when they are read."""
    try:
        data = files.read_start(place, 64)
        start = zlib.decompressobj().decompress(data, 7)
    except (OSError, zlib.error):
        return  # libgit2 fails on it too
    if data and (not start or start.startswith((b"commit ", b"tag "))) and not _is_whole(place):
        raise OSError(errno.EIO, "a damaged object of git", place)


def _is_whole(place: str) -> bool:
    """Whether a loose object's file is not cut off. Other faults are libgit2's to find."""
    reader = zlib.decompressobj()
    try:
        data = files.read_file(place, get_limits().object)
        left = get_limits().object + _SMALL_FILE
        while data and left > 0:
            left -= len(reader.decompress(data, _SMALL_FILE))
            data = reader.unconsumed_tail
    except (OSError, zlib.error):
        return False
    return reader.eof


def _is_system_path(real: str) -> bool:
    """Whether a path lies where reading a regular file can wait for ever, or has no end."""
    return real.startswith(("/proc/", "/sys/", "/dev/"))


def _list_alternates(objects: str) -> Iterator[str]:
    """Folders in which a repository's objects are looked for too."""
    place = os.path.join(objects, "info", "alternates")
    if not os.path.isfile(place):
        return
    for line in os.fsdecode(files.read_file(place, get_limits().settings)).splitlines():
        if line and not line.startswith("#") and "\0" not in line:
            yield os.path.join(objects, line)


def resolve(repo: Any, revision: str, place: str) -> tuple[str, Any]:
    """(id of the commit, id of its tree) of a revision; a tree without a commit has one id twice. Raises TreeError.

    The tree itself is not read: it may be damaged, and Objects looks at it before libgit2 does.
    """
    import pygit2

    for spelling in (revision, f"origin/{revision}"):
        try:
            found = repo.revparse_single(spelling)
        except (KeyError, ValueError, TypeError, OSError, pygit2.GitError):
            continue
        try:
            commit = found.peel(pygit2.Commit)
            return str(commit.id), commit.tree_id
        except (KeyError, ValueError, TypeError, OSError, pygit2.GitError):
            if found.type_str == "tree":
                return str(found.id), found.id
    remedy = "its history is cut off (shallow), fetch more of it" if repo.is_shallow else "git rev-parse must know it"
    raise TreeError(f"`{shown(revision)}` is no revision of `{shown(place)}`; {remedy}")


def merge_base(repo: Any, commit: str, other: str) -> str | None:
    """The newest commit that both share; None when there is none. Raises TreeError where history cannot be read."""
    import pygit2

    try:
        found = repo.merge_base(pygit2.Oid(hex=commit), pygit2.Oid(hex=other))
    except (KeyError, ValueError, TypeError, OSError, pygit2.GitError) as error:
        reason = shown(str(error))
        raise TreeError(f"the history from {commit[:10]} to {other[:10]} cannot be read: {reason}; git fsck") from None
    return None if found is None else str(found)


class RepositoryObjects:
    """A repository's files and folders by id, each asked for its size before it is read.

    Folders are kept, since revisions of one repository share most of theirs. All faults are OSError.
    """

    def __init__(self, opened: OpenedRepository):
        import pygit2

        self._repo = opened.repository
        self._refused = opened.refused
        self._loose = opened.loose
        self._faults = (KeyError, ValueError, TypeError, AttributeError, pygit2.GitError)
        self._header = getattr(opened.repository.odb, "read_header", None)

    def read_size(self, oid: Any) -> int:
        """Bytes of a file. Reads the object's header alone where this pygit2 can."""
        return self._read_kind_and_size(oid)[1]

    def _read_kind_and_size(self, oid: Any) -> tuple[int, int]:
        """(kind, bytes) of an object."""
        if self._refused and str(oid) in self._refused:
            raise OSError(errno.EFBIG, f"larger than {format_size(get_limits().object)}")
        try:
            if self._header is None:
                self._check(oid)
                found = self._repo[oid]
                return int(found.type), found.size if found.type_str == "blob" else 0
            header = self._header(oid)
            kind, size = header if isinstance(header, tuple) else (header.type, header.size)
            return int(kind), size
        except KeyError:
            raise FileNotFoundError(errno.ENOENT, MISSING) from None
        except self._faults:
            raise OSError(errno.EIO, DAMAGED) from None

    def _check(self, oid: Any) -> None:
        """Raises OSError for a loose object that is cut off, which libgit2 would read for ever."""
        place = self._loose.get(str(oid))
        if place is not None and not _is_whole(place):
            raise OSError(errno.EIO, DAMAGED)

    def read_blob(self, oid: Any, limit: int) -> bytes:
        """A file's bytes, at most as many as `limit`."""
        limit = min(limit, get_limits().object)
        kind, size = self._read_kind_and_size(oid)
        if kind != _BLOB:
            raise OSError(errno.EIO, "its object is not a file")
        if size > limit:
            raise OSError(errno.EFBIG, f"larger than {format_size(limit)}")
        self._check(oid)
        try:
            return self._repo[oid].data
        except self._faults:
            raise OSError(errno.EIO, DAMAGED) from None

    @cache_method
    def read_folder(self, oid: Any) -> tuple[tuple[str, int, Any], ...]:
        """(name, mode, id) of everything in a folder; names that no file can have are left out."""
        kind, size = self._read_kind_and_size(oid)
        if kind != _TREE:
            raise OSError(errno.EIO, "its object is not a folder")
        if size > get_limits().object:
            raise OSError(errno.EFBIG, f"larger than {format_size(get_limits().object)}")
        self._check(oid)
        try:
            return tuple(
                (name, int(item.filemode), item.id)
                for item in self._repo[oid]
                if "/" not in (name := item.raw_name.decode("utf-8", "surrogateescape")) and name not in ("", ".", "..")
            )
        except self._faults:
            raise OSError(errno.EIO, DAMAGED) from None

    @cache_method
    def index_folder(self, oid: Any) -> dict[str, tuple[int, Any]]:
        """(mode, id) of what a folder has under each name."""
        return {name: (mode, item) for name, mode, item in self.read_folder(oid)}

    @cache_method
    def link(self, oid: Any) -> str:
        """What a link leads to."""
        return self.read_blob(oid, LONGEST_PATH).decode("utf-8", "surrogateescape")
