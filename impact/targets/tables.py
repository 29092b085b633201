"""Which data folder is in use: the shipped one, or the tables that `rosimpact data update --from` fetched.

What was fetched is a whole data folder, `updated/tables-DIGEST` in the user's cache folder; the file `updated/tables`
names it. It is used while it is whole, of this program's format and not older than what is shipped. To tell that, its
manifest is read and its files are stat'ed; nothing is hashed.
"""

import datetime
import hashlib
import os
import re
from functools import cache
from pathlib import Path
from typing import Annotated, NamedTuple

import msgspec

from ...edges.files import read_file
from ...edges.limits import get_limits
from ..cache import cache_folder

FORMAT = 1
"""The form of the tables, taken together. It is raised when the loaders of this version cannot read the tables of older
ones, or the other way round; tests/targets/test_tables.py notices a change of their types."""
MANIFEST = "manifest.json"
POINTER = "tables"
LARGEST = 64 << 20
"""Bytes of one table, as it is stored."""
DATA_VARIABLE = "ROSIMPACT_DATA"
"""A variable of the environment that names another data folder than the shipped one, as `rosimpact data build` made."""
DATA = Path(os.environ.get(DATA_VARIABLE) or Path(__file__).parent / "data")
_FOLDER = re.compile(r"tables-[0-9a-f]{16}")


class StoredTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A file of a data folder. size: in bytes."""

    size: Annotated[int, msgspec.Meta(ge=0, le=LARGEST)]
    sha256: Annotated[str, msgspec.Meta(pattern=r"\A[0-9a-f]{64}\Z")]


class DataManifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What `manifest.json` says of a data folder. date: the day on which a table last changed. tables: by file name."""

    format: int
    date: Annotated[str, msgspec.Meta(pattern=r"\A\d{4}-\d{2}-\d{2}\Z")]
    tables: Annotated[dict[str, StoredTable], msgspec.Meta(max_length=1000)]


class FetchedTables(NamedTuple):
    """What `data update --from` fetched last. manifest: None when it cannot be read. unused: why it is not in use, as a
    clause; empty when it is."""

    folder: Path
    manifest: DataManifest | None
    unused: str


class FormatError(ValueError):
    """A manifest is of another format; the text says which."""


class _AnyManifest(msgspec.Struct, frozen=True):
    format: int


def parse_manifest(text: bytes) -> DataManifest:
    """A manifest. Raises FormatError for one of another format, ValueError for what is none."""
    try:
        form = msgspec.json.decode(text, type=_AnyManifest).format
        if form != FORMAT:
            raise FormatError(f"is of format {form}; this version of rosimpact reads format {FORMAT}")
        manifest = msgspec.json.decode(text, type=DataManifest)
    except RecursionError:
        raise ValueError("is nested too deeply") from None
    datetime.date.fromisoformat(manifest.date)
    return manifest


def read_manifest(folder: Path) -> DataManifest:
    """The manifest of a data folder. Raises OSError, and as parse_manifest() does."""
    return parse_manifest(read_file(folder / MANIFEST, get_limits().settings))


def find_updated_folder() -> Path:
    """Where `rosimpact data update` keeps what it made."""
    return cache_folder() / "updated"


def read_fetched() -> FetchedTables | None:
    """The tables that `data update --from` fetched last; None when there are none."""
    home = find_updated_folder()
    try:
        name = read_file(home / POINTER, 100).decode()
    except FileNotFoundError:
        return None
    except (OSError, ValueError):
        return FetchedTables(home, None, f"{home / POINTER} cannot be read")
    folder = home / name
    if not _FOLDER.fullmatch(name):
        return FetchedTables(home, None, f"{home / POINTER} names no folder of tables")
    try:
        manifest = read_manifest(folder)
    except (OSError, ValueError) as error:
        return FetchedTables(folder, None, f"{folder / MANIFEST}: {error}")
    return FetchedTables(folder, manifest, _find_fault(folder, manifest))


def _find_fault(folder: Path, manifest: DataManifest) -> str:
    """Why a folder of tables is not used, as a clause; empty when it is."""
    if os.environ.get(DATA_VARIABLE):
        return f"{DATA_VARIABLE} names another data folder"
    try:
        shipped = read_manifest(DATA)
    except (OSError, ValueError):
        shipped = manifest
    if manifest.date < shipped.date:
        return f"the shipped tables of {shipped.date} are newer"
    for name in sorted(manifest.tables.keys() | shipped.tables):
        try:
            whole = os.stat(folder / name).st_size == manifest.tables[name].size
        except (OSError, KeyError):
            whole = False
        if not whole:
            return f"{folder / name} is missing or damaged"
    return ""


@cache
def find_data_folder() -> Path:
    """The data folder that this process answers from."""
    fetched = read_fetched()
    return DATA if fetched is None or fetched.unused else fetched.folder


def find_table(name: str) -> Path:
    """The file in use of a table."""
    return find_data_folder() / name


def list_tables(pattern: str) -> list[Path]:
    """The files in use whose names match a pattern."""
    return sorted(find_data_folder().glob(pattern))


def compute_data_stamp() -> tuple[tuple[str, int, int], ...]:
    """The folder in use, and sizes and times of its files; differs whenever one of them does."""
    folder = find_data_folder()
    with os.scandir(folder) as entries:
        files = sorted((entry.name, entry.stat()) for entry in entries if entry.is_file())
    return (str(folder), 0, 0), *((name, status.st_size, status.st_mtime_ns) for name, status in files)


@cache
def compute_data_version() -> str:
    """Differs whenever the manifest of the folder in use does; the same on every machine that has these tables."""
    try:
        known = read_file(find_table(MANIFEST), get_limits().settings)
    except OSError:
        known = repr(compute_data_stamp()).encode()
    return hashlib.sha1(known).hexdigest()[:16]


def suggest_repair() -> str:
    """What to do about a table that cannot be read, as a clause."""
    return "install rosimpact again" if find_data_folder() == DATA else "run `rosimpact data update --shipped`"
