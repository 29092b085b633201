"""Files of a Debian package as it is downloaded: an `ar` archive with a compressed tar archive in it (deb(5))."""

from __future__ import annotations

import gzip
import io
import lzma
import posixpath
import tarfile
from pathlib import Path
from typing import NamedTuple

from ...edges.console import UserError

_MAGIC = b"!<arch>\n"
_LARGEST = 64 * 1024 * 1024
"""Bytes above which a file of a package is left out: nobody writes such a header."""


class DebError(UserError):
    """A file that is no Debian package, or is broken; the message names it and says what to do."""


class Member(NamedTuple):
    """A file of a package. executable: by its mode."""

    data: bytes
    executable: bool


def members(path: Path) -> dict[str, Member]:
    """The regular files of a package by their path from the root (`usr/include/a.h`); links within the package stand
    for what they lead to. Raises DebError, and OSError where it cannot be read."""
    packed = _part(path, path.read_bytes())
    files: dict[str, Member] = {}
    links: dict[str, str] = {}
    try:
        with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
            for entry in archive:
                name = posixpath.normpath(entry.name).lstrip("/")
                if entry.issym():
                    links[name] = posixpath.normpath(posixpath.join("/", posixpath.dirname(name), entry.linkname))[1:]
                elif entry.islnk():
                    links[name] = posixpath.normpath(entry.linkname).lstrip("/")
                elif entry.isfile() and entry.size <= _LARGEST:
                    read = archive.extractfile(entry)
                    files[name] = Member(read.read() if read is not None else b"", bool(entry.mode & 0o111))
    except (tarfile.TarError, EOFError, ValueError) as error:
        raise DebError(f"{path}: is broken ({error}); download it again") from None
    for name, to in links.items():
        if to in files:
            files.setdefault(name, files[to])
    return files


def _part(path: Path, data: bytes) -> bytes:
    """The tar archive of what is installed."""
    if not data.startswith(_MAGIC):
        raise DebError(f"{path}: is no Debian package; `apt-get download PACKAGE` fetches one")
    at = len(_MAGIC)
    while at + 60 <= len(data):
        head = data[at : at + 60]
        try:
            size = int(head[48:58])
        except ValueError:
            break
        name = head[:16].decode("ascii", "replace").rstrip().rstrip("/")
        if name.startswith("data.tar"):
            return _unpacked(path, name, data[at + 60 : at + 60 + size])
        at += 60 + size + size % 2
    raise DebError(f"{path}: holds no files; download it again")


def _unpacked(path: Path, name: str, data: bytes) -> bytes:
    try:
        if name.endswith(".xz"):
            return lzma.decompress(data)
        if name.endswith(".gz"):
            return gzip.decompress(data)
        if name.endswith(".zst"):
            import zstandard

            with zstandard.ZstdDecompressor().stream_reader(data) as stream:
                return stream.read()
        if name == "data.tar":
            return data
    except Exception as error:  # each library has its own
        raise DebError(f"{path}: is broken ({error}); download it again") from None
    raise DebError(f"{path}: is packed as `{name}`, which is not known; give an unpacked prefix instead")
