"""The doors to the file system: every file that is read, and every file that is written.

Reading opens regular files only, which is checked on the open descriptor; it never waits for another process (named
pipes, terminals), and never reads more than a limit. Writing replaces a whole file at once and refuses links, so that
nothing is written anywhere but where it was asked for. All faults are OSError, whose strerror says why.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
from collections.abc import Iterator
from typing import IO

from .limits import size_text

_CHUNK = 1 << 20
_READ = os.O_RDONLY | os.O_CLOEXEC | os.O_NOCTTY | os.O_NONBLOCK
_FOLDER = os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY | os.O_NOFOLLOW
# What a shell gives a command to write to; they are no files of anybody's.
_STREAMS = ("/dev/null", "/dev/stdout", "/dev/stderr")
NOT_REGULAR = "not a regular file"

Path = str | os.PathLike[str]


def open_regular(path: Path, *, follow: bool = True) -> int:
    """A descriptor of a regular file, opened for reading. follow: False refuses a path whose last part is a link.

    Raises OSError: EINVAL with NOT_REGULAR for named pipes, devices, sockets; ENXIO, ELOOP, ENOENT and so on.
    """
    # Opening a device can have effects of its own, so the kind is asked before, and again on what was opened.
    if not stat.S_ISREG((os.stat if follow else os.lstat)(path).st_mode):
        raise _not_regular(path)
    descriptor = os.open(path, _READ if follow else _READ | os.O_NOFOLLOW)
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            raise _not_regular(path)
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor


def _not_regular(path: Path) -> OSError:
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
        raise too_large(path, limit)
    data = os.read(descriptor, size + 1)
    if len(data) == size and size:
        return data
    # Files of /proc say 0, others grow or shrink while they are read.
    parts = [data]
    total = len(data)
    while parts[-1]:
        if total > limit:
            raise too_large(path, limit)
        parts.append(os.read(descriptor, _CHUNK))
        total += len(parts[-1])
    return b"".join(parts)


def too_large(path: Path, limit: int) -> OSError:
    """The error for a file that holds more than a limit of bytes."""
    return OSError(errno.EFBIG, f"larger than {size_text(limit)}", os.fspath(path))


def read_start(path: Path, size: int) -> bytes:
    """Up to `size` bytes from the beginning of a regular file, however large it is. Raises OSError."""
    descriptor = open_regular(path)
    try:
        return os.read(descriptor, size)
    finally:
        os.close(descriptor)


def read_chunks(path: Path, size: int = _CHUNK) -> Iterator[bytes]:
    """A regular file piece by piece, for what is searched and not kept. Raises OSError."""
    descriptor = open_regular(path)
    try:
        while data := os.read(descriptor, size):
            yield data
    finally:
        os.close(descriptor)


def read_text(path: Path, limit: int, errors: str = "strict") -> str:
    """A regular file as UTF-8 text without its byte-order mark. Raises OSError, and UnicodeDecodeError."""
    return read_file(path, limit).decode("utf-8-sig", errors)


def write_file(path: Path, data: bytes, *, beneath: Path | None = None) -> None:
    """Writes a whole file, or leaves the old one whole; folders on the way are made.

    beneath: a folder that must hold the file without any link in between. Without it the user named the path, whose
    folders may be links. In both cases the last part may not be a link, may be nothing but a regular file if it is
    there, and no part of the path may be called `.git`. The old file's permissions are kept.
    Raises OSError.
    """
    target = os.fspath(path)
    if beneath is None and target in _STREAMS:
        with open(target, "wb") as stream:
            stream.write(data)
        return
    folder, name = _folder_of(target, None if beneath is None else os.fspath(beneath))
    try:
        mode = _mode(folder, name, target)
        _replace(folder, name, data, mode)
    finally:
        os.close(folder)


@contextlib.contextmanager
def writing(path: Path) -> Iterator[IO[bytes]]:
    """A file written piece by piece, which takes the place of the old one when the block ends, and goes when it fails.

    Refuses what write_file() refuses. Raises OSError.
    """
    target = os.fspath(path)
    folder, name = _folder_of(target, None)
    try:
        mode = _mode(folder, name, target)
        with _temporary(folder, name, mode) as file:
            yield file
    finally:
        os.close(folder)


def check_writable_path(path: Path) -> None:
    """Raises OSError where write_file() would refuse the path, so that long work is not begun for nothing."""
    target = os.fspath(path)
    if target in _STREAMS:
        return
    _refuse_git(target)
    with contextlib.suppress(FileNotFoundError):
        _refuse_unless_regular(os.lstat(target).st_mode, target)


def append_file(path: Path, data: bytes) -> None:
    """Adds to the end of a file, which is made when it is missing. Refuses links and all but regular files."""
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK
    descriptor = os.open(path, flags, 0o666)
    try:
        _refuse_unless_regular(os.fstat(descriptor).st_mode, os.fspath(path))
        _write_all(descriptor, data)
    finally:
        os.close(descriptor)


def _refuse_git(target: str) -> None:
    if any(part.lower() == ".git" for part in target.split(os.sep)):
        raise OSError(errno.EPERM, "lies in a .git folder, where nothing is written", target)


def _refuse_unless_regular(mode: int, target: str) -> None:
    if stat.S_ISLNK(mode):
        raise OSError(errno.ELOOP, "is a link, and links are not written through", target)
    if stat.S_ISDIR(mode):
        raise OSError(errno.EISDIR, "is a folder", target)
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, NOT_REGULAR, target)


def _folder_of(target: str, beneath: str | None) -> tuple[int, str]:
    """(descriptor of the folder that holds a file, the file's name). Raises OSError."""
    relative = target if beneath is None else os.path.relpath(target, beneath)
    _refuse_git(relative)
    if beneath is None:
        target = os.path.abspath(target)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        return os.open(os.path.dirname(target), os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY), os.path.basename(target)
    *folders, name = relative.split(os.sep)
    if ".." in folders or name in ("", ".", "..") or os.path.isabs(relative):
        raise OSError(errno.EPERM, "lies outside of the folder that may be written", target)
    descriptor = os.open(beneath, os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY)
    try:
        for each in folders:
            inner = _enter(each, descriptor, target)
            os.close(descriptor)
            descriptor = inner
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor, name


def _enter(name: str, folder: int, target: str) -> int:
    """A descriptor of a folder in a folder, made when it is missing; a link to one is refused."""
    with contextlib.suppress(FileExistsError):
        os.mkdir(name, dir_fd=folder)
    try:
        return os.open(name, _FOLDER, dir_fd=folder)
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.ENOTDIR):
            raise OSError(errno.ELOOP, f"`{name}` on the way is a link or no folder", target) from None
        raise


def _mode(folder: int, name: str, target: str) -> int | None:
    """The permissions that a file has; None when there is none. Raises OSError where it is no regular file."""
    try:
        status = os.stat(name, dir_fd=folder, follow_symlinks=False)
    except FileNotFoundError:
        return None
    _refuse_unless_regular(status.st_mode, target)
    return stat.S_IMODE(status.st_mode)


def _replace(folder: int, name: str, data: bytes, mode: int | None) -> None:
    with _temporary(folder, name, mode) as file:
        file.write(data)


@contextlib.contextmanager
def _temporary(folder: int, name: str, mode: int | None) -> Iterator[IO[bytes]]:
    """A new file beside another, whose name it gets at the end."""
    temporary = f".{name[:100]}.{secrets.token_hex(6)}.part"
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC | os.O_NOFOLLOW
    descriptor = os.open(temporary, flags, 0o666, dir_fd=folder)
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


def _write_all(descriptor: int, data: bytes) -> None:
    view = memoryview(data)
    while view:
        view = view[os.write(descriptor, view) :]
