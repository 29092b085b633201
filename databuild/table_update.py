"""`rosimpact data update --from`: takes tables from elsewhere into use, whole and verified or not at all.

A manifest is read first (impact/targets/tables.py); tables that are here already, by their hash, are not fetched. All
are put into a folder of their own, which comes into use at the end, when the file that names it is replaced. An
interrupted run leaves that file as it is, and the next run goes on with what has been fetched.
"""

import contextlib
import datetime
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import NamedTuple

from ..edges.console import UserError
from ..edges.files import open_for_replacing, read_chunks, write_file
from ..edges.limits import get_limits
from ..impact.cache import CACHE_VARIABLE
from ..impact.targets.tables import (
    DATA,
    DATA_VARIABLE,
    FORMAT,
    MANIFEST,
    POINTER,
    DataManifest,
    FormatError,
    StoredTable,
    find_updated_folder,
    parse_manifest,
    read_fetched,
    read_manifest,
)
from .git import Report
from .table_manifest import format_manifest
from .table_source import ReadTable, open_source

_TRIAL_SECONDS = 300
_STALE = 3600


class TablesUpdate(NamedTuple):
    """What an update did. date: of the tables in use. fetched: those that were not here. changed: those that are not as
    shipped."""

    date: str
    folder: Path
    fetched: tuple[str, ...]
    changed: tuple[str, ...]


def update_tables(source: str, report: Report | None = None) -> TablesUpdate:
    """Takes the tables of a source into use: a folder that has a manifest.json, an archive of one, or its address.

    Raises UserError where the source, or what it holds, cannot be used; the data in use then stay. OSError as well.
    """
    tell = report or (lambda what, done, total: None)
    if os.environ.get(DATA_VARIABLE):
        raise UserError(f"{DATA_VARIABLE} names the data in use; unset it to update those of rosimpact")
    shipped, home = _read_shipped(), find_updated_folder()
    with open_source(source, (MANIFEST, *shipped.tables), home) as read:
        tell("reading the manifest", 0, 0)
        named = _read_named(source, read, shipped)
        whole = DataManifest(FORMAT, named.date, {**shipped.tables, **named.tables})
        text = format_manifest(whole)
        folder = home / f"tables-{hashlib.sha256(text).hexdigest()[:16]}"
        before = read_fetched()
        at_hand = (folder, *((before.folder,) if before is not None and before.manifest is not None else ()), DATA)
        fetched = []
        for number, (name, table) in enumerate(sorted(whole.tables.items())):
            file = _find_at_hand(name, table, at_hand)
            if file is None and name not in named.tables:
                raise UserError(f"{DATA / name}: is not what {MANIFEST} beside it says; install rosimpact again")
            if file is None:
                tell(f"fetching {name}", number, len(whole.tables))
                _store(read(name), table, folder / name, f"{source}: `{name}`")
                fetched.append(name)
            elif file.parent != folder:
                _store(read_chunks(file), table, folder / name, str(file))
    tell("reading the tables", 0, 0)
    _check_tables(folder, source)
    write_file(folder / MANIFEST, text)
    write_file(home / POINTER, folder.name.encode())
    _remove_others(home, {folder.name, *((before.folder.name,) if before is not None else ())})
    changed = tuple(name for name, table in sorted(whole.tables.items()) if table != shipped.tables[name])
    return TablesUpdate(whole.date, folder, tuple(fetched), changed)


def reset_tables() -> bool:
    """Goes back to the shipped data, snapshot included, and removes what updates left. Returns whether there was
    anything. Raises OSError."""
    home = find_updated_folder()
    if not os.path.lexists(home):
        return False
    # Without it nothing else of the folder's tables is looked at.
    with contextlib.suppress(FileNotFoundError):
        os.unlink(home / POINTER)
    shutil.rmtree(home)
    return True


def _read_shipped() -> DataManifest:
    try:
        return read_manifest(DATA)
    except (OSError, ValueError) as error:
        raise UserError(f"{DATA / MANIFEST}: {error}; install rosimpact again") from None


def _read_named(source: str, read: ReadTable, shipped: DataManifest) -> DataManifest:
    """The manifest of a source, if its tables may come into use."""
    limit, text = get_limits().settings, b""
    for chunk in read(MANIFEST):
        text += chunk
        if len(text) > limit:
            raise UserError(f"{source}: {MANIFEST} is too large; name what `rosimpact data build` made")
    place = f"{source}: {MANIFEST}"
    try:
        named = parse_manifest(text)
    except FormatError as error:
        raise UserError(f"{place}: {error}; upgrade rosimpact, or take data of that format") from None
    except ValueError as error:
        raise UserError(f"{place}: {error}; name what `rosimpact data build` made") from None
    unknown = sorted(named.tables.keys() - shipped.tables)
    if unknown:
        raise UserError(f"{place}: `{unknown[0][:100]}` is no table of this version of rosimpact; upgrade rosimpact")
    if not named.tables:
        raise UserError(f"{place}: names no tables; name what `rosimpact data build` made")
    if named.date < shipped.date:
        raise UserError(f"{place}: its tables of {named.date} are older than the shipped ones of {shipped.date}")
    tomorrow = datetime.datetime.now(datetime.timezone.utc).date() + datetime.timedelta(days=1)
    if named.date > max(tomorrow.isoformat(), shipped.date):
        raise UserError(f"{place}: its date {named.date} is in the future; check the clock of this machine")
    return named


def _find_at_hand(name: str, table: StoredTable, folders: Iterable[Path]) -> Path | None:
    """The first of some folders' files of this name that is a table."""
    for folder in folders:
        with contextlib.suppress(OSError):
            file = folder / name
            if os.lstat(file).st_size == table.size and _compute_sha256(file) == table.sha256:
                return file
    return None


def _compute_sha256(file: Path) -> str:
    digest = hashlib.sha256()
    for chunk in read_chunks(file, follow=False):
        digest.update(chunk)
    return digest.hexdigest()


def _store(chunks: Iterable[bytes], table: StoredTable, file: Path, what: str) -> None:
    """Writes a table if it is the one that a manifest says. Raises UserError when it is not."""
    digest, size = hashlib.sha256(), 0
    with open_for_replacing(file) as opened:
        for chunk in chunks:
            size += len(chunk)
            if size > table.size:
                break
            digest.update(chunk)
            opened.write(chunk)
        if size != table.size or digest.hexdigest() != table.sha256:
            said = "more" if size > table.size else "less" if size < table.size else "something else"
            raise UserError(f"{what}: holds {said} than {MANIFEST} says; try again, or get it from another source")


def _check_tables(folder: Path, source: str) -> None:
    """Raises UserError where a check could not read the tables of a folder."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, DATA_VARIABLE: str(folder), CACHE_VARIABLE: cache, "PYTHONSAFEPATH": "1"}
        try:
            ended = subprocess.run(
                [sys.executable, "-m", "rosimpact.databuild.table_trial"], stdin=subprocess.DEVNULL, check=False,
                capture_output=True, text=True, errors="replace", timeout=_TRIAL_SECONDS, env=environment, cwd=cache,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise UserError(f"{source}: its tables take too long to read; get them from another source") from None
    if ended.returncode:
        said = (ended.stderr.strip().splitlines() or ["no reason given"])[-1].removeprefix("rosimpact: ")
        raise UserError(f"{source}: cannot be used: {said.partition(';')[0]}; get it from another source")


def _remove_others(home: Path, kept: Collection[str]) -> None:
    """Removes tables of earlier updates and what killed runs left. What is younger than an hour may be in use."""
    for folder in (*home.glob("tables-*"), *home.glob("unpacked-*")):
        with contextlib.suppress(OSError):
            if folder.name not in kept and folder.stat().st_mtime < time.time() - _STALE:
                shutil.rmtree(folder)
