"""The doors to the file system: every file that is read, and every file that is written.

Reading opens regular files only, which is checked on the open descriptor; it never waits for another process (named
pipes, terminals), and never reads more than a limit. Writing replaces a whole file at once and refuses links, so that
nothing is written anywhere but where it was asked for. All faults are OSError, whose strerror says why.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import stat
from collections.abc import Iterable, Iterator
from typing import IO

from .limits import format_size

_CHUNK = 1 << 20
_READ = os.O_RDONLY | os.O_CLOEXEC | os.O_NOCTTY | os.O_NONBLOCK
_FOLDER = os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY | os.O_NOFOLLOW
# What a shell gives a command to write to, `>(tee log)` too; they are no files of anybody's.
_STREAMS = {"/dev/stdout": 1, "/dev/stderr": 2}
_NOWHERE = -1
_DESCRIPTOR = re.compile(r"/(?:dev|proc/self)/fd/([0-9]{1,6})\Z")
# Characters that HFS+ leaves out when it compares names, and the short name of `.git` on NTFS.
_NOT_COMPARED = re.compile("[\u200c-\u200f\u202a-\u202e\u206a-\u206f\ufeff]")
_GIT = (".git", "git~1")
NOT_REGULAR = "not a regular file"
CHANGED = "changed since it was read"

Path = str | os.PathLike[str]


def open_regular(path: Path, *, follow: bool = True) -> int:
    """A descriptor of a regular file, opened for reading. follow: False refuses a path whose last part is a link.

    Raises OSError: EINVAL with NOT_REGULAR for named pipes, devices, sockets; ENXIO, ELOOP, ENOENT and so on.
    """
    # Opening a device can have effects of its own, so the kind is asked before, and again on what was opened.
    try:
        mode = (os.stat if follow else os.lstat)(path).st_mode
    except ValueError:
        raise _make_name_error(path) from None
    if not stat.S_ISREG(mode):
        raise _make_not_regular_error(path)
    descriptor = os.open(path, _READ if follow else _READ | os.O_NOFOLLOW)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise _make_not_regular_error(path)
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor


def _make_name_error(path: Path) -> OSError:
    return OSError(errno.EINVAL, "is no name that a file can have", os.fspath(path))


def _make_not_regular_error(path: Path) -> OSError:
    kind = errno.EISDIR if os.path.isdir(path) else errno.EINVAL
    return OSError(kind, "is a folder" if kind == errno.EISDIR else NOT_REGULAR, os.fspath(path))


def read_file(path: Path, limit: int, *, follow: bool = True) -> bytes:
    """The bytes of a regular file. Raises OSError, with EFBIG when it holds more than `limit` bytes."""
    return read_with_status(path, limit, follow=follow)[0]


def read_with_status(path: Path, limit: int, *, follow: bool = True) -> tuple[bytes, os.stat_result]:
    """The same, with the status of the file that was read, taken after reading."""
    descriptor = open_regular(path, follow=follow)
    try:
        return _read(descriptor, path, limit), os.fstat(descriptor)
    finally:
        os.close(descriptor)


def _read(descriptor: int, path: Path, limit: int) -> bytes:
    size = os.fstat(descriptor).st_size
    if size > limit:
        raise make_size_error(path, limit)
    data = os.read(descriptor, size + 1)
    if len(data) == size and size:
        return data
    # Files of /proc say 0, others grow or shrink while they are read.
    parts = [data]
    total = len(data)
    while parts[-1]:
        if total > limit:
            raise make_size_error(path, limit)
        parts.append(os.read(descriptor, _CHUNK))
        total += len(parts[-1])
    return b"".join(parts)


def make_size_error(path: Path, limit: int) -> OSError:
    """The error for a file that holds more than a limit of bytes."""
    return OSError(errno.EFBIG, f"larger than {format_size(limit)}", os.fspath(path))


def read_start(path: Path, size: int) -> bytes:
    """Up to `size` bytes from the beginning of a regular file, however large it is. Raises OSError."""
    descriptor = open_regular(path)
    try:
        return os.read(descriptor, size)
    finally:
        os.close(descriptor)


def read_chunks(path: Path, size: int = _CHUNK, *, follow: bool = True) -> Iterator[bytes]:
    """A regular file piece by piece, for what is searched and not kept. follow: as for open_regular(). Raises
    OSError."""
    descriptor = open_regular(path, follow=follow)
    try:
        while data := os.read(descriptor, size):
            yield data
    finally:
        os.close(descriptor)


def read_text(path: Path, limit: int, errors: str = "strict") -> str:
    """A regular file as UTF-8 text without its byte-order mark. Raises OSError, and UnicodeDecodeError."""
    return read_file(path, limit).decode("utf-8-sig", errors)


def write_file(path: Path, data: bytes, *, beneath: Path | None = None, instead_of: bytes | None = None) -> None:
    """Writes a whole file, or leaves the old one whole; folders on the way are made.

    beneath: a folder that must hold the file without any link in between. Without it the user named the path, whose
    folders may be links. In both cases the last part may not be a link, may be nothing but a regular file if it is
    there, and no part of the path may be called `.git`. instead_of: what the file must hold until it is replaced; an
    error with CHANGED otherwise, and no folders are made. The old file's permissions are kept. A file of several names
    (hard links) is replaced under this one alone: the others keep the old content.
    Raises OSError.
    """
    target = os.fspath(path)
    if beneath is None and (stream := _find_descriptor(target)) is not None:
        if stream != _NOWHERE:
            write_all(stream, data)
        return
    with _open_folder(target, beneath, make=instead_of is None) as (folder, name):
        mode = _read_mode(folder, name, target)
        with _open_temporary(folder, name, mode) as file:
            file.write(data)
            if instead_of is not None:
                file.flush()
                _check_unchanged(folder, name, instead_of, target)


def write_scratch_file(path: Path, data: bytes) -> None:
    """Writes a file into a temporary folder of ours, which nobody else writes into and which does not outlive this
    process: it is not replaced at once, and nothing waits for the disk. Raises OSError."""
    descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
    try:
        write_all(descriptor, data)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def open_for_replacing(path: Path) -> Iterator[IO[bytes]]:
    """A file written piece by piece, which takes the place of the old one when the block ends, and goes when it fails.

    Refuses what write_file() refuses. Raises OSError.
    """
    target = os.fspath(path)
    with _open_folder(target, None) as (folder, name):
        mode = _read_mode(folder, name, target)
        with _open_temporary(folder, name, mode) as file:
            yield file


def check_writable_path(path: Path, *, beneath: Path | None = None) -> None:
    """Raises OSError where write_file() would refuse the path, so that long work is not begun for nothing. Nothing is
    written or made."""
    target = os.fspath(path)
    if beneath is None and (stream := _find_descriptor(target)) is not None:
        if stream != _NOWHERE:
            os.fstat(stream)
        return
    place, parts = _split_target(target, beneath)
    for part in parts[:-1]:
        place = os.path.join(place, part)
        if beneath is not None and os.path.islink(place):
            raise _link_on_the_way(part, target)
        if os.path.lexists(place) and not os.path.isdir(place):
            raise OSError(errno.ENOTDIR, f"`{part}` on the way is no folder", target)
    _refuse_git(os.path.realpath(place), target)
    try:
        _refuse_unless_regular(os.lstat(os.path.join(place, parts[-1])), target)
    except FileNotFoundError:
        while not os.path.exists(place):
            place = os.path.dirname(place)
        if not os.access(place, os.W_OK | os.X_OK):
            raise OSError(errno.EACCES, os.strerror(errno.EACCES), target) from None


def find_outermost(path: Path, folders: Iterable[Path]) -> str | None:
    """The first folder on the way to a path, as the path is written, that is one of some folders; None when it lies in
    none of them. What lies below belongs to whoever made that folder, links included: see write_file(beneath=)."""
    known = set()
    for folder in folders:
        with contextlib.suppress(OSError, ValueError):
            status = os.stat(folder)
            known.add((status.st_dev, status.st_ino))
    place = ""
    for part in os.path.dirname(os.path.abspath(path)).split(os.sep):
        place = f"{place}{os.sep}" if place.strip(os.sep) else os.sep
        place += part
        try:
            status = os.stat(place)
        except (OSError, ValueError):
            return None
        if (status.st_dev, status.st_ino) in known:
            return place
    return None


def append_file(path: Path, data: bytes) -> None:
    """Adds to the end of a file, which is made when it is missing. Refuses links and all but regular files."""
    if _find_descriptor(os.fspath(path)) is not None:
        write_file(path, data)
        return
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK
    descriptor = os.open(path, flags, 0o666)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise _make_not_regular_error(path)
        write_all(descriptor, data)
    finally:
        os.close(descriptor)


def _find_descriptor(target: str) -> int | None:
    """The open descriptor that a path names, _NOWHERE for /dev/null, None for the path of a file."""
    if target == os.devnull:
        return _NOWHERE
    if target in _STREAMS:
        return _STREAMS[target]
    match = _DESCRIPTOR.match(target)
    return int(match[1]) if match else None


def _refuse_git(path: str, target: str) -> None:
    if any(_NOT_COMPARED.sub("", part).lower() in _GIT for part in path.split(os.sep)):
        raise OSError(errno.EPERM, "lies in a .git folder, where nothing is written", target)


def _link_on_the_way(part: str, target: str) -> OSError:
    return OSError(errno.ELOOP, f"`{part}` on the way is a link, and links are not written through", target)


def _refuse_unless_regular(status: os.stat_result, target: str) -> None:
    mode = status.st_mode
    if stat.S_ISLNK(mode):
        raise OSError(errno.ELOOP, "is a link, and links are not written through", target)
    if stat.S_ISDIR(mode):
        raise OSError(errno.EISDIR, "is a folder", target)
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, NOT_REGULAR, target)
    if not mode & 0o222:
        raise OSError(errno.EACCES, "is read-only", target)


def _split_target(target: str, beneath: Path | None) -> tuple[str, list[str]]:
    """(folder to begin at, the folders from there to a file and its name). Raises OSError for a path that is refused
    as it is written."""
    try:
        os.fsencode(target)
    except ValueError:
        raise _make_name_error(target) from None
    if "\0" in target:
        raise _make_name_error(target)
    if target.endswith((os.sep, os.sep + ".")) or target in ("", "."):
        raise OSError(errno.EISDIR, "is a folder", target)
    if beneath is None:
        absolute = os.path.abspath(target)
        _refuse_git(absolute, target)
        return os.sep, absolute.lstrip(os.sep).split(os.sep)
    relative = os.path.relpath(os.path.abspath(target), os.path.abspath(beneath))
    _refuse_git(relative, target)
    parts = relative.split(os.sep)
    # A name such as `a/../b` means something else where `a` is a link.
    if ".." in (*parts, *target.split(os.sep)) or parts == ["."]:
        raise OSError(errno.EPERM, "lies outside of the folder that may be written", target)
    return os.fspath(beneath), parts


@contextlib.contextmanager
def _open_folder(target: str, beneath: Path | None, *, make: bool = True) -> Iterator[tuple[int, str]]:
    """(descriptor of the folder that holds a file, the file's name). make: also folders that are missing. Raises
    OSError."""
    start, (*folders, name) = _split_target(target, beneath)
    if beneath is None:
        start, folders = os.path.join(start, *folders), []
        _refuse_git(os.path.realpath(start), target)
        if make:
            os.makedirs(start, exist_ok=True)
    descriptor = os.open(start, os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY)
    try:
        for each in folders:
            if make:
                with contextlib.suppress(FileExistsError):
                    os.mkdir(each, dir_fd=descriptor)
            inner = _enter(each, descriptor, target)
            os.close(descriptor)
            descriptor = inner
        yield descriptor, name
    finally:
        os.close(descriptor)


def _enter(name: str, folder: int, target: str) -> int:
    """A descriptor of a folder in a folder; a link to one is refused."""
    try:
        return os.open(name, _FOLDER, dir_fd=folder)
    except OSError as error:
        if error.errno not in (errno.ELOOP, errno.ENOTDIR):
            raise
        if _is_link(name, folder):
            raise _link_on_the_way(name, target) from None
        raise OSError(errno.ENOTDIR, f"`{name}` on the way is no folder", target) from None


def _is_link(name: str, folder: int) -> bool:
    try:
        return stat.S_ISLNK(os.lstat(name, dir_fd=folder).st_mode)
    except OSError:
        return False


def _read_mode(folder: int, name: str, target: str) -> int | None:
    """The permissions that a file has; None when there is none. Raises OSError where it is no regular file."""
    try:
        status = os.stat(name, dir_fd=folder, follow_symlinks=False)
    except FileNotFoundError:
        return None
    _refuse_unless_regular(status, target)
    return stat.S_IMODE(status.st_mode)


def _check_unchanged(folder: int, name: str, content: bytes, target: str) -> None:
    """Raises OSError with CHANGED where a file is not what was read before."""
    try:
        descriptor = os.open(name, _READ | os.O_NOFOLLOW, dir_fd=folder)
    except FileNotFoundError:
        raise OSError(errno.ESTALE, CHANGED, target) from None
    try:
        if os.fstat(descriptor).st_size != len(content) or _read(descriptor, target, len(content)) != content:
            raise OSError(errno.ESTALE, CHANGED, target)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def _open_temporary(folder: int, name: str, mode: int | None) -> Iterator[IO[bytes]]:
    """A new file beside another, whose name it gets at the end."""
    # Names end at 255 bytes. What others may not read is not readable while it is written either.
    temporary = b"." + os.fsencode(name)[:100] + b"." + secrets.token_hex(6).encode() + b".part"
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW
    descriptor = os.open(temporary, flags, 0o666 if mode is None else 0o600, dir_fd=folder)
    try:
        with open(descriptor, "wb") as file:
            yield file
            file.flush()
            if mode is not None:
                os.fchmod(descriptor, mode)
            os.fsync(descriptor)
        os.rename(temporary, name, src_dir_fd=folder, dst_dir_fd=folder)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(temporary, dir_fd=folder)
        raise


def write_all(descriptor: int, data: bytes) -> None:
    """Writes bytes, however few of them are taken at once."""
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]
