"""Writes the manifest of a data folder: format, date, and size and hash of each table (see impact/targets/tables.py).

    python -P -m rosimpact.databuild.table_manifest [FOLDER]

`rosimpact data build` does so at its end. What another builder, or an editor, changed in the shipped folder is noted by
the command; the date stays while no table changes.
"""

import argparse
import datetime
import hashlib
import json
from pathlib import Path

import msgspec

from ..edges.console import write
from ..edges.files import read_chunks, write_file
from ..impact.targets.tables import DATA, FORMAT, MANIFEST, DataManifest, StoredTable, read_manifest


def make_manifest(folder: Path, date: str) -> DataManifest:
    """The manifest of a folder's tables: those of its files that are called like a shipped one. date: ISO. Raises
    OSError."""
    names = sorted(path.name for path in DATA.iterdir() if path.is_file() and path.name != MANIFEST)
    return DataManifest(FORMAT, date, {name: _measure(folder / name) for name in names if (folder / name).exists()})


def _measure(file: Path) -> StoredTable:
    digest, size = hashlib.sha256(), 0
    for chunk in read_chunks(file):
        digest.update(chunk)
        size += len(chunk)
    return StoredTable(size, digest.hexdigest())


def write_manifest(folder: Path) -> DataManifest:
    """Writes the manifest of a data folder and returns it. Its date is today's when a table differs from those that the
    old one tells of. Raises OSError."""
    made = make_manifest(folder, datetime.datetime.now(datetime.timezone.utc).date().isoformat())
    try:
        old = read_manifest(folder)
    except (OSError, ValueError):
        old = None
    if old is not None and old.tables == made.tables:
        return old
    write_file(folder / MANIFEST, format_manifest(made))
    return made


def format_manifest(manifest: DataManifest) -> bytes:
    """A manifest as text, with a line for each table."""
    rows = ",\n".join(f'"{name}": {json.dumps(msgspec.to_builtins(one))}' for name, one in manifest.tables.items())
    return f'{{"format": {manifest.format}, "date": "{manifest.date}", "tables": {{\n{rows}\n}}}}\n'.encode()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=DATA)
    made = write_manifest(parser.parse_args().folder)
    write(f"{len(made.tables)} tables of {made.date}")


if __name__ == "__main__":
    main()
