"""Tables as files of the data folder; impact/targets/tables.py reads them."""

from pathlib import Path
from typing import Any

import msgspec
import zstandard

from ..edges.files import write_file


def write_table(file: Path, table: Any) -> int:
    """Writes a table as JSON, packed as read_table() reads it. Returns its size in bytes, packed. Raises OSError."""
    packed = zstandard.ZstdCompressor(level=19).compress(msgspec.json.encode(table))
    write_file(file, packed)
    return len(packed)
