"""Bags opened: the topics of a recording, and its messages one by one, of whatever form it is."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from ...edges.console import UserError, escape, format_count
from ...edges.documents import DocumentError, load_yaml
from ...edges.files import open_for_replacing, open_regular, read_file
from ...edges.limits import get_limits
from ...edges.processes import limit_memory
from ..model.wire import Encoding
from .rosbag_file import BagConnection, RosbagFile

_METADATA = "metadata.yaml"
_STORAGE = (".mcap", ".db3")
# What `rosbag record` has not closed ends in `.active`.
_ROS1 = (".bag", ".active")
_COMPRESSED = ".zstd"
_PIECE = 1 << 20
_NAME_ONE = "name a .bag, .mcap or .db3 file, or the folder of a bag"
_INSTALL = "install it with `pip install 'rosimpact[bags]'`"
_REPAIRS = {
    "rosbag": "repair it with `rosbag reindex`",
    "mcap": "repair it with `mcap recover`",
    "sqlite3": "repair it with `sqlite3 FILE .recover`, or record it again",
}


class BagError(UserError):
    """A bag cannot be read; the text names it and what to do."""


class BagTopic(NamedTuple):
    """A connection of a bag. type: `package/Name`. definition: text of the message and those nested in it, empty where
    the bag has none; form: `msg` or `idl`, which that is written in. problem: why its messages are not understood."""

    id: int
    topic: str
    type: str
    definition: str
    form: str
    problem: str = ""


class _Reader(Protocol):
    """A file or folder that holds messages. connections: by a number of its own. count: messages that it says to hold.
    distro: of ROS, where it says so."""

    connections: dict[int, BagConnection]
    count: int
    distro: str

    def read_messages(self, wanted: Collection[int]) -> Iterator[tuple[int, int, bytes]]: ...


class _Rosbag2:
    """What rosbags reads of a bag of ROS 2."""

    def __init__(self, reader: Any):
        self._reader = reader
        self.count: int = reader.message_count
        self.distro: str = reader.ros_distro or ""
        self._chosen = dict(enumerate(reader.connections))
        self.connections = {
            number: BagConnection(
                number, each.topic, each.msgtype, each.msgdef.data, each.msgdef.format.name.lower(),
                each.ext.serialization_format,
            )
            for number, each in self._chosen.items()
        }  # fmt: skip

    def read_messages(self, wanted: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        chosen = [self._chosen[number] for number in wanted]
        numbers = {each.id: number for number, each in self._chosen.items()}
        for connection, time, data in self._reader.messages(connections=chosen) if chosen else ():
            yield numbers[connection.id], time, data


class OpenedBag:
    """A bag while it is open. form: rosbag (of ROS 1), sqlite3 or mcap. count: messages that it says to hold. distro:
    of ROS, that it says it was recorded on."""

    def __init__(self, path: Path, form: str, readers: Sequence[_Reader]):
        self.path = path
        self.form = form
        self.encoding: Encoding = "ros1" if form == "rosbag" else "cdr"
        self.distro = next((reader.distro for reader in readers if reader.distro), "")
        self.count = sum(reader.count for reader in readers)
        self._readers = readers
        ids: dict[BagConnection, int] = {}
        self._ids = [
            {number: ids.setdefault(each._replace(id=0), len(ids)) for number, each in reader.connections.items()}
            for reader in readers
        ]
        self.topics = [_make_topic(number, each) for each, number in ids.items()]

    def read_messages(self, wanted: Collection[int]) -> Iterator[tuple[int, int, bytes]]:
        """(id of the topic, time in nanoseconds, bytes) of each message of some topics. Raises BagError."""
        number = 0
        for reader, ids in zip(self._readers, self._ids, strict=True):
            try:
                for own, time, data in reader.read_messages({own for own, each in ids.items() if each in wanted}):
                    yield ids[own], time, data
                    number += 1
            except Exception as error:
                where = f"is damaged after {format_count(number, 'message')}" if number else "is damaged"
                part = f", or measure what is before with --limit {number}" if number else ""
                raise BagError(
                    f"{escape(str(self.path))}: {where}: {_describe(error)}; {_suggest(error, self.form)}{part}"
                ) from None


def _make_topic(number: int, connection: BagConnection) -> BagTopic:
    kind, form = connection.kind, connection.form
    problem = "" if kind in ("cdr", "") else f"is serialized as {escape(kind[:40])}, and only cdr is read"
    type_ = connection.type.replace("/msg/", "/")
    topic = "/" + "/".join(filter(None, connection.topic.split("/")))
    return BagTopic(number, topic, type_, connection.definition, form if form in ("msg", "idl") else "", problem)


@contextlib.contextmanager
def open_bag(path: Path) -> Iterator[OpenedBag]:
    """Opens a bag: a .bag file of ROS 1; a folder, its metadata.yaml, or a single .mcap or .db3 file of ROS 2. What
    reading needs of memory is limited meanwhile. Raises BagError."""
    name = escape(str(path))
    if path.name == _METADATA:
        path = path.parent
    try:
        files = _list_files(path)
    except OSError as error:
        raise BagError(f"{name}: {error.strerror or error}; {_NAME_ONE}") from None
    form = "rosbag" if files[0].suffix in _ROS1 else "mcap" if ".mcap" in files[0].suffixes else "sqlite3"
    with contextlib.ExitStack() as stack:
        stack.enter_context(limit_memory(get_limits().bag))
        if any(file.name.endswith(_COMPRESSED) for file in files):
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            files = [_unpack(file, folder) for file in files]
            whole = False
        else:
            whole = path.is_dir() and (path / _METADATA).exists()
        try:
            opened = OpenedBag(
                path, form, [stack.enter_context(_open_file(each, form)) for each in ([path] if whole else files)]
            )
        except ImportError as error:
            module = (error.name or "rosbags").partition(".")[0]
            raise BagError(f"{name}: needs the Python package `{module}`; {_INSTALL}") from None
        except Exception as error:
            raise BagError(f"{name}: {_describe(error)}; {_suggest(error, form)}") from None
        yield opened


@contextlib.contextmanager
def _open_file(path: Path, form: str) -> Iterator[_Reader]:
    if form == "rosbag":
        with RosbagFile(path) as bag:
            yield bag
        return
    from rosbags.rosbag2 import Reader  # pyright: ignore[reportMissingImports]

    with Reader(path) as reader:
        yield _Rosbag2(reader)


def _list_files(path: Path) -> list[Path]:
    """The files that hold a bag's messages. Raises OSError, BagError."""
    if not path.is_dir():
        files = [path]
    elif (path / _METADATA).exists():
        files = _read_metadata(path)
    else:
        files = sorted(each for each in path.iterdir() if each.name.removesuffix(_COMPRESSED).endswith(_STORAGE))
        if not files:
            raise BagError(f"{escape(str(path))}: holds no {_METADATA} and no .mcap or .db3 file; name a bag")
    for file in files:
        os.close(open_regular(file))  # refuses what is no file before a library opens it
        if file.suffix not in (*_ROS1, *_STORAGE) and not file.name.endswith(_COMPRESSED):
            raise BagError(f"{escape(str(file))}: is no bag; {_NAME_ONE}")
    return files


def _unpack(file: Path, folder: Path) -> Path:
    """A file of a bag as it was before it was compressed, in another folder. Raises BagError."""
    import zstandard

    target = folder / file.name.removesuffix(_COMPRESSED)
    left = shutil.disk_usage(folder).free // 2
    name = escape(str(file))
    try:
        with os.fdopen(open_regular(file), "rb") as packed, open_for_replacing(target) as plain:
            reader = zstandard.ZstdDecompressor().stream_reader(packed, read_across_frames=True)
            while data := reader.read(_PIECE):
                left -= len(data)
                if left < 0:
                    raise BagError(
                        f"{name}: unpacks to more than half of what is free in {escape(str(folder.parent))}; "
                        "name a larger folder with TMPDIR"
                    )
                plain.write(data)
    except (OSError, zstandard.ZstdError) as error:
        raise BagError(f"{name}: cannot be unpacked: {_describe(error)}; copy or record it again") from None
    return target


def _read_metadata(folder: Path) -> list[Path]:
    name = escape(str(folder / _METADATA))
    try:
        found = load_yaml(read_file(folder / _METADATA, get_limits().capture))
        names = found["rosbag2_bagfile_information"]["relative_file_paths"]
        files = [folder / Path(each).name for each in names]
    except DocumentError as error:
        raise BagError(f"{name}, line {error.line}: {error}; make it anew with `ros2 bag reindex`") from None
    except (KeyError, TypeError, AttributeError):
        raise BagError(f"{name}: does not name the files of a bag; make it anew with `ros2 bag reindex`") from None
    missing = [file.name for file in files if not file.exists()]
    if missing or not files:
        what = f"{escape(missing[0])} is not there" if missing else "names no file"
        raise BagError(f"{name}: {what}; copy the whole folder of the bag, or make it anew with `ros2 bag reindex`")
    return files


def _describe(error: Exception) -> str:
    if isinstance(error, MemoryError) or "memory" in str(error).lower():
        return "a part of it needs too much memory"
    text = escape(" ".join(str(error).split())[:200]).rstrip(".")
    kind = type(error).__name__
    return (
        f"{text[:1].lower()}{text[1:]}" if text and kind.endswith("Error") and " " in text else f"{kind} {text}".strip()
    )


def _suggest(error: Exception, form: str) -> str:
    text = str(error).lower()
    if isinstance(error, MemoryError) or "memory" in text:
        return "allow more with ROSIMPACT_LIMITS=bag=8GB if you trust it"
    if "profile" in text:
        return "only what `ros2 bag record` writes is read"
    if "not supported" in text:
        return "convert it with `rosbags-convert`, or record it again"
    return _REPAIRS[form]
