"""Bags of ROS 1, read from the beginning to the end: http://wiki.ros.org/Bags/Format/2.0

rosbags keeps an entry of every message in memory, needs the index, and unpacks whatever it is given. Here one chunk is
in memory at a time, what was recorded before a crash is read without an index, and no chunk unpacks to more than it
says.
"""

from __future__ import annotations

import bz2
import os
import struct
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import IO, Any, NamedTuple

from ...edges.files import open_regular

_MAGIC = b"#ROSBAG V"
_VERSION = b"#ROSBAG V2.0\n"
_MESSAGE, _HEADER, _INDEX, _CHUNK, _CHUNK_INFO, _CONNECTION = 2, 3, 4, 5, 6, 7
_HEADER_AT_MOST = 1 << 20
_UINT32 = struct.Struct("<I").unpack_from
_UINT64 = struct.Struct("<Q").unpack_from
_TIME = struct.Struct("<II").unpack_from


class RosbagError(ValueError):
    """A bag of ROS 1 cannot be read; the text is a clause."""


class BagConnection(NamedTuple):
    """A connection. type: as written. definition: text of the message and those nested in it. form: `msg` or `idl`,
    which that is written in. kind: how messages are serialized, where that is said."""

    id: int
    topic: str
    type: str
    definition: str
    form: str = "msg"
    kind: str = ""


class RosbagFile:
    """A bag of ROS 1 while it is open. count: messages that its index tells of, 0 without an index."""

    def __init__(self, path: Path):
        self._path = path
        self._file: IO[bytes] = os.fdopen(open_regular(path), "rb")
        self.connections: dict[int, BagConnection] = {}
        self.count = 0
        self.distro = ""
        try:
            self._size = os.fstat(self._file.fileno()).st_size
            self._open()
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> RosbagFile:
        return self

    def __exit__(self, *exception: object) -> None:
        self._file.close()

    def _open(self) -> None:
        magic = self._file.read(len(_VERSION))
        if magic != _VERSION:
            if magic.startswith(_MAGIC):
                raise RosbagError(f"its format is {magic[len(_MAGIC) :].decode('latin-1').strip()}, not supported")
            raise RosbagError("it does not begin as a bag does" if magic else "it is empty")
        header, _ = self._read_record()
        if header.get(b"op") != bytes((_HEADER,)):
            raise RosbagError("it does not begin as a bag does")
        if header.get(b"encryptor"):
            raise RosbagError("encryption is not supported")
        self._start = self._file.tell()
        index = _get_number(header, b"index_pos", _UINT64)
        if not (index and self._read_index(index)):
            self._scan()

    def _scan(self) -> None:
        """Looks for connections among the messages, as far as they can be read."""
        self.connections.clear()
        self.count = 0
        try:
            for op, fields, data in self._read_all():
                if op == _CONNECTION:
                    self._add_connection(fields, data)
                self.count += op == _MESSAGE
        except RosbagError:
            if not self.connections:
                raise

    def _read_index(self, at: int) -> bool:
        """Whether what stands behind the chunks could be read."""
        try:
            self._file.seek(at)
            while self._file.tell() < self._size:
                fields, data = self._read_record()
                op = fields[b"op"][0]
                if op == _CONNECTION:
                    self._add_connection(fields, data)
                elif op == _CHUNK_INFO:
                    self.count += sum(_UINT32(data, place)[0] for place in range(4, len(data) - 3, 8))
        except (RosbagError, KeyError, IndexError, OSError, OverflowError, struct.error):
            return False
        return bool(self.connections)

    def _add_connection(self, fields: dict[bytes, bytes], data: bytes) -> None:
        own = _parse_fields(data, 0, len(data))
        number = _get_number(fields, b"conn", _UINT32)
        topic, type_, definition = (
            part.decode("utf-8", "replace")
            for part in (fields.get(b"topic", b""), own.get(b"type", b""), own.get(b"message_definition", b""))
        )
        self.connections.setdefault(number, BagConnection(number, topic, type_, definition))

    def read_messages(self, wanted: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        """(number of the connection, time in nanoseconds, bytes) of each message as they were written. wanted: numbers
        of connections. Raises RosbagError at the first thing that cannot be read."""
        for op, fields, data in self._read_all(wanted):
            if op == _MESSAGE:
                seconds, nanoseconds = _TIME(fields[b"time"])
                yield _UINT32(fields[b"conn"])[0], seconds * 1_000_000_000 + nanoseconds, data

    def _read_all(self, wanted: Collection[int] | None = None) -> Iterator[tuple[int, dict[bytes, bytes], bytes]]:
        """(op, fields, data) of the records of all chunks, and of those that stand outside of chunks."""
        self._file.seek(self._start)
        while self._file.tell() < self._size:
            fields, data = self._read_record()
            op = _get_number(fields, b"op", _get_byte)
            if op == _CHUNK:
                yield from _read_chunk(_unpack(fields, data), wanted)
            elif op in (_MESSAGE, _CONNECTION):
                yield op, fields, data

    def _read_record(self) -> tuple[dict[bytes, bytes], bytes]:
        header = self._read_sized(_HEADER_AT_MOST)
        return _parse_fields(header, 0, len(header)), self._read_sized(self._size)

    def _read_sized(self, most: int) -> bytes:
        at = self._file.tell()
        head = self._file.read(4)
        size = _UINT32(head)[0] if len(head) == 4 else self._size
        # What the file cannot hold is not asked for.
        if len(head) < 4 or at + 4 + size > self._size:
            raise RosbagError(f"it ends in the middle of what begins at byte {at:,}")
        if size > most:
            raise RosbagError(f"there is no record at byte {at:,}")
        return self._file.read(size)


def _read_chunk(data: bytes, wanted: Collection[int] | None) -> Iterator[tuple[int, dict[bytes, bytes], bytes]]:
    at, end = 0, len(data)
    try:
        while at < end:
            size = _UINT32(data, at)[0]
            head, at = at + 4, at + 4 + size
            length = _UINT32(data, at)[0]
            body, at = at + 4, at + 4 + length
            if at > end:
                raise RosbagError("a chunk ends in the middle of a record")
            fields = _parse_fields(data, head, head + size)
            op = fields[b"op"][0]
            asked = op == _MESSAGE and (wanted is None or _UINT32(fields[b"conn"])[0] in wanted)
            if asked or op == _CONNECTION:
                yield op, fields, data[body:at]
    except (struct.error, KeyError, IndexError):
        raise RosbagError("a chunk holds what is no record") from None


def _parse_fields(data: bytes, at: int, end: int) -> dict[bytes, bytes]:
    fields: dict[bytes, bytes] = {}
    while at < end:
        if at + 4 > end:
            raise RosbagError("a record's header ends early")
        size = _UINT32(data, at)[0]
        at += 4
        mark = data.find(b"=", at, at + size)
        if mark < 0 or at + size > end:
            raise RosbagError("a record's header has no fields")
        fields[data[at:mark]] = data[mark + 1 : at + size]
        at += size
    return fields


def _get_byte(data: bytes) -> tuple[int]:
    return (data[0],)


def _get_number(fields: dict[bytes, bytes], name: bytes, unpack: Callable[..., tuple[Any, ...]]) -> int:
    try:
        return unpack(fields[name])[0]
    except (KeyError, IndexError, struct.error):
        raise RosbagError(f"a record has no {name.decode()}") from None


def _unpack(fields: dict[bytes, bytes], data: bytes) -> bytes:
    """A chunk's contents, which are as many bytes as it says."""
    size = _get_number(fields, b"size", _UINT32)
    kind = fields.get(b"compression", b"none")
    if kind == b"none":
        return data
    try:
        if kind == b"bz2":
            found = bz2.BZ2Decompressor().decompress(data, size + 1)
        elif kind == b"lz4":
            from lz4.frame import LZ4FrameDecompressor  # pyright: ignore[reportMissingImports]

            found = LZ4FrameDecompressor().decompress(data, size + 1)
        else:
            raise RosbagError(f"compression by {kind[:20].decode('latin-1')} is not supported")
    except (OSError, EOFError, RuntimeError):
        raise RosbagError("a chunk cannot be unpacked") from None
    if len(found) != size:
        raise RosbagError(f"a chunk unpacks to other than the {size:,} bytes that it says")
    return found
