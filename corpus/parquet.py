"""Reports as a Parquet file, for tools that read columns."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path

import msgspec

from ..edges.files import open_for_replacing
from .report import BugReport, CorpusError

_AT_ONCE = 5_000


def write_parquet(path: Path, reports: Iterable[BugReport]) -> int:
    """Writes reports, whole or not at all: a column for each field of BugReport, `tags` a list. Returns how many.
    Raises CorpusError."""
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise CorpusError(f"{path}: Parquet needs pyarrow; install it with `pip install rosimpact[study]`") from None
    texts = [(field.name, pyarrow.string()) for field in msgspec.structs.fields(BugReport) if field.name != "tags"]
    schema = pyarrow.schema([*texts, ("tags", pyarrow.list_(pyarrow.string()))])
    count = 0
    try:
        rest = iter(reports)
        with open_for_replacing(path) as file, parquet.ParquetWriter(file, schema, compression="zstd") as writer:
            while part := [msgspec.structs.asdict(report) for report in islice(rest, _AT_ONCE)]:
                writer.write_table(pyarrow.Table.from_pylist(part, schema=schema))
                count += len(part)
    except OSError as error:
        raise CorpusError(f"{path}: cannot be written: {error.strerror or error}; give another file") from None
    return count
