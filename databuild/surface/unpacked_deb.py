"""Files of a Debian package as it is downloaded: an `ar` archive with a compressed tar archive in it (deb(5)).

Read piece by piece within limits: neither what an archive unpacks to nor what it claims to hold can take all memory.
"""

from __future__ import annotations

import io
import lzma
import os
import posixpath
import tarfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ...edges.console import UserError
from ...edges.files import make_size_error, open_regular
from ...edges.limits import format_size, get_limits

_MAGIC = b"!<arch>\n"
_LARGEST = 64 * 1024 * 1024
"""Bytes above which a file of a package is left out: nobody writes such a header."""
_MEMBERS = 200_000
# A long name of GNU tar; dpkg installs no archive with other headers before a file's own.
_LONG_NAME = 16_384
_LONG_NAMES = (tarfile.GNUTYPE_LONGNAME, tarfile.GNUTYPE_LONGLINK)
_PLAIN = (tarfile.REGTYPE, tarfile.AREGTYPE, tarfile.LNKTYPE, tarfile.SYMTYPE, tarfile.DIRTYPE, tarfile.CHRTYPE,
          tarfile.BLKTYPE, tarfile.FIFOTYPE, tarfile.CONTTYPE)  # fmt: skip
# Of the decompressors: dpkg-deb's strongest settings need 65 MB (xz -9) and 128 MB (zstd --long=27).
_XZ_MEMORY = 200 << 20
_ZSTD_WINDOW = 128 << 20
_STREAMS = 1000
_CHUNK = 1 << 18


class DebError(UserError):
    """A file that is no Debian package, or is broken; the message names it and says what to do."""


class _TooMuch(Exception):
    """An archive holds more than a limit; the text says which."""


class DebFile(NamedTuple):
    """A file of a package. executable: by its mode."""

    data: bytes
    executable: bool


def read_members(path: Path) -> dict[str, DebFile]:
    """The regular files of a package by their path from the root (`usr/include/a.h`); links within the package stand
    for what they lead to. Raises DebError, and OSError where it cannot be read."""
    return read_members_and_links(path)[0]


def read_members_and_links(path: Path) -> tuple[dict[str, DebFile], dict[str, str]]:
    """The same, and all links with what they lead to, be it in the package or not."""
    descriptor = open_regular(path)
    try:
        size = os.fstat(descriptor).st_size
        if size > get_limits().deb:
            raise make_size_error(path, get_limits().deb)
        name, start, end = _find_archive(path, descriptor, size)
        files, links = _read(_Unpacked(_find_codec(path, name)(_read_pieces(descriptor, start, end)), get_limits().deb))
    except (_TooMuch, tarfile.TarError, lzma.LZMAError, zlib.error, EOFError, ValueError, RecursionError) as error:
        raise DebError(f"{path}: is broken ({error or type(error).__name__}); download it again") from None
    finally:
        os.close(descriptor)
    for link, to in links.items():
        if to in files:
            files.setdefault(link, files[to])
    return files, links


class _Header(tarfile.TarInfo):
    """A header of an archive, refused where it is none that dpkg would install."""

    @classmethod
    def frombuf(cls, buf: bytes | bytearray, encoding: str | None, errors: str) -> _Header:
        found = super().frombuf(buf, encoding, errors)  # type: ignore[arg-type]
        if found.size < 0 or (found.type in _LONG_NAMES and found.size > _LONG_NAME):
            raise _TooMuch("a header that is too long")
        if found.type not in (*_PLAIN, *_LONG_NAMES):
            raise _TooMuch("a header that dpkg does not know")
        return found  # type: ignore[return-value]


def _read(stream: Any) -> tuple[dict[str, DebFile], dict[str, str]]:
    """The files of a tar archive, and its links with what they lead to."""
    files: dict[str, DebFile] = {}
    links: dict[str, str] = {}
    left, count = get_limits().deb // 2, 0
    with tarfile.open(fileobj=stream, mode="r|", tarinfo=_Header, bufsize=_CHUNK) as archive:
        while (entry := archive.next()) is not None:
            archive.members = []  # type: ignore[attr-defined]  # it would keep them all
            count += 1
            if count > _MEMBERS:
                raise _TooMuch(f"more than {_MEMBERS:,} files")
            name = posixpath.normpath(entry.name).lstrip("/")
            if entry.issym():
                links[name] = posixpath.normpath(posixpath.join("/", posixpath.dirname(name), entry.linkname))[1:]
            elif entry.islnk():
                links[name] = posixpath.normpath(entry.linkname).lstrip("/")
            elif entry.isfile() and entry.size <= _LARGEST:
                left -= entry.size
                if left < 0:
                    raise _TooMuch(f"files of more than {format_size(get_limits().deb // 2)}")
                read = archive.extractfile(entry)
                files[name] = DebFile(read.read() if read is not None else b"", bool(entry.mode & 0o111))
    return files, links


def _find_archive(path: Path, descriptor: int, whole: int) -> tuple[str, int, int]:
    """Name, beginning and end of the tar archive of what is installed."""
    if os.pread(descriptor, len(_MAGIC), 0) != _MAGIC:
        raise DebError(f"{path}: is no Debian package; `apt-get download PACKAGE` fetches one")
    at = len(_MAGIC)
    # The archive comes third.
    for _ in range(20):
        head = os.pread(descriptor, 60, at)
        size = head[48:58].strip()
        if len(head) < 60 or not size.isdigit():
            break
        at += 60
        name = head[:16].decode("ascii", "replace").rstrip().rstrip("/")
        if name.startswith("data.tar"):
            return name, at, min(at + int(size), whole)
        at += int(size) + int(size) % 2
    raise DebError(f"{path}: holds no files; download it again")


def _read_pieces(descriptor: int, start: int, end: int) -> Iterator[bytes]:
    """A part of a file, from its beginning to its end."""
    while start < end:
        data = os.pread(descriptor, min(_CHUNK, end - start), start)
        if not data:
            return
        start += len(data)
        yield data


class _Unpacked:
    """What an iterator gives, to be read as a file, up to a limit of bytes."""

    def __init__(self, pieces: Iterator[bytes], limit: int):
        self._pieces, self._limit, self._left = pieces, limit, limit
        self._rest = b""

    def read(self, size: int) -> bytes:
        parts = [self._rest]
        have = len(self._rest)
        while have < size:
            piece = next(self._pieces, b"")
            if not piece:
                break
            self._left -= len(piece)
            if self._left < 0:
                raise _TooMuch(f"unpacks to more than {format_size(self._limit)}")
            parts.append(piece)
            have += len(piece)
        data = b"".join(parts)
        self._rest = data[size:]
        return data[:size]


def _find_codec(path: Path, name: str) -> Callable[[Iterator[bytes]], Iterator[bytes]]:
    """What unpacks an archive of that name. Raises DebError."""
    if name.endswith(".xz"):
        return lambda pieces: _decompress(pieces, lambda: lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=_XZ_MEMORY))
    if name.endswith(".gz"):
        return lambda pieces: _decompress(pieces, _Gzip)
    if name.endswith(".zst"):
        return _decompress_zstd
    if name == "data.tar":
        return lambda pieces: pieces
    raise DebError(f"{path}: is packed as `{name}`, which is not known; give an unpacked prefix instead")


class _Gzip:
    """zlib's decompressor with the interface of those of xz."""

    def __init__(self) -> None:
        self._inner = zlib.decompressobj(31)

    @property
    def eof(self) -> bool:
        return self._inner.eof

    @property
    def needs_input(self) -> bool:
        return not self._inner.unconsumed_tail

    @property
    def unused_data(self) -> bytes:
        return self._inner.unused_data

    def decompress(self, data: bytes, max_length: int) -> bytes:
        return self._inner.decompress(self._inner.unconsumed_tail + data, max_length)


def _decompress(pieces: Iterator[bytes], decompressor: Callable[[], Any]) -> Iterator[bytes]:
    """What compressed streams, one after another, hold. Raises EOFError when the last one is cut off."""
    inner = decompressor()
    for _ in range(_STREAMS):
        while not inner.eof:
            data = b""
            if inner.needs_input:
                data = next(pieces, b"")
                if not data:
                    raise EOFError("it is cut off")
            if out := inner.decompress(data, max_length=_CHUNK):
                yield out
        rest = inner.unused_data.lstrip(b"\0") or next(pieces, b"").lstrip(b"\0")
        if not rest:
            return
        inner = decompressor()
        if out := inner.decompress(rest, max_length=_CHUNK):
            yield out
    raise _TooMuch(f"more than {_STREAMS:,} compressed parts")


def _decompress_zstd(pieces: Iterator[bytes]) -> Iterator[bytes]:
    import zstandard

    class _Source(io.RawIOBase):
        def read(self, size: int = -1) -> bytes:
            return next(pieces, b"")

    source: Any = _Source()
    try:
        decompressor = zstandard.ZstdDecompressor(max_window_size=_ZSTD_WINDOW)
        with decompressor.stream_reader(source, read_across_frames=True) as stream:
            while data := stream.read(_CHUNK):
                yield data
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from None
