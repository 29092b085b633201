"""Tables as files of the data folder; impact/targets/tables.py reads them."""

from pathlib import Path
from typing import Any, Literal

import msgspec
import zstandard

from ..edges.files import write_file


def write_table(file: Path, table: Any, order: Literal["sorted"] | None = None, level: int = 19) -> int:
    """Writes a table as JSON, packed as read_table() reads it. order: of the keys, else as they are. Returns its size
    in bytes, packed. Raises OSError."""
    packed = zstandard.ZstdCompressor(level=level).compress(msgspec.json.encode(table, order=order))
    write_file(file, packed)
    return len(packed)
