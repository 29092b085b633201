"""The file of results: JSON Lines that a run adds to and a later run continues, and the same as Parquet."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec

from ...edges.console import UserError
from ...edges.files import append_file, open_for_replacing, read_file, write_file
from ...edges.limits import get_limits
from .intervals import NetworkResult
from .plan import Conditions, NetworkCell

SCHEMA = 1


class RunHeader(msgspec.Struct, frozen=True, kw_only=True):
    """The first line of the file: under which conditions the others were measured, on what machine, by which clock."""

    schema: int = SCHEMA
    rosimpact: str = ""
    started: str = ""
    conditions: Conditions = Conditions()
    clock: str = ""
    machine: dict[str, str] = {}


class ResultsFile:
    """The results of one set of conditions in a file. Opening it reads what is there; a line that a run left unfinished
    is removed. Raises UserError for a file of other conditions, or of something else."""

    def __init__(self, path: Path, header: RunHeader):
        self.path = path
        self.results: list[NetworkResult] = []
        there = _read(path)
        if not there:
            write_file(path, _encode(header))
            return
        lines = there.split(b"\n")
        unfinished = lines.pop()  # empty behind a line end
        if not lines:
            raise UserError(f"{path}: holds no results; give another file with --output")
        old = _decode_header(lines[0], path)
        if old.conditions != header.conditions:
            raise UserError(
                f"{path}: holds results of other conditions ({_name_differences(old.conditions, header.conditions)}); "
                "give another file with --output, or the same options"
            )
        self.results = [_decode_result(line, path, number) for number, line in enumerate(lines[1:], 2)]
        if unfinished:
            write_file(path, b"\n".join(lines) + b"\n", instead_of=there)

    def has(self, cell: NetworkCell, repetition: int) -> bool:
        """Whether this repetition of a cell was measured already."""
        return any(each.repetition == repetition and each.cell == cell for each in self.results)

    def add(self, result: NetworkResult) -> None:
        """Adds a result to the file. Raises OSError."""
        append_file(self.path, _encode(result))
        self.results.append(result)


def load_results(path: Path) -> tuple[RunHeader, list[NetworkResult]]:
    """A finished file of results. Raises UserError."""
    lines = [line for line in _read(path).split(b"\n") if line]
    if not lines:
        raise UserError(f"{path}: holds no results; `rosimpact measure network --output {path}` makes them")
    header = _decode_header(lines[0], path)
    return header, [_decode_result(line, path, number) for number, line in enumerate(lines[1:], 2)]


def _read(path: Path) -> bytes:
    try:
        return read_file(path, get_limits().report)
    except FileNotFoundError:
        return b""


def _encode(value: Any) -> bytes:
    return msgspec.json.encode(value) + b"\n"


def _decode_header(line: bytes, path: Path) -> RunHeader:
    try:
        header = msgspec.json.decode(line, type=RunHeader)
    except (msgspec.DecodeError, msgspec.ValidationError, RecursionError) as error:
        raise UserError(f"{path}:1: is no header of results ({error}); give another file with --output") from None
    if header.schema != SCHEMA or not header.clock:
        raise UserError(f"{path}:1: is no header of results of this version; give another file with --output")
    return header


def _decode_result(line: bytes, path: Path, number: int) -> NetworkResult:
    try:
        return msgspec.json.decode(line, type=NetworkResult)
    except (msgspec.DecodeError, msgspec.ValidationError, RecursionError) as error:
        raise UserError(f"{path}:{number}: is no result ({error}); remove the line, or give another file") from None


def _name_differences(old: Conditions, new: Conditions) -> str:
    names = [name for name in Conditions.__struct_fields__ if getattr(old, name) != getattr(new, name)]
    return ", ".join(f"{name} {getattr(old, name)}, not {getattr(new, name)}" for name in names[:3])


def need_parquet(path: Path) -> None:
    """Raises UserError where Parquet cannot be written, so that it is known before anything is measured."""
    from importlib.util import find_spec

    if find_spec("pyarrow") is None:
        raise UserError(f"--parquet {path}: needs pyarrow; install it with `pip install 'rosimpact[measure]'`")


def write_parquet(path: Path, results: Iterable[NetworkResult], conditions: Conditions) -> None:
    """Writes results as Parquet: a column for each field, and for each of the conditions. Raises UserError, OSError."""
    need_parquet(path)
    import pyarrow
    from pyarrow import parquet

    same = {
        name: ",".join(value) if isinstance(value, tuple) else value
        for name, value in msgspec.structs.asdict(conditions).items()
    }
    columns = [*_list_columns(pyarrow, NetworkResult), *_list_columns(pyarrow, Conditions)]
    rows = [{**same, **msgspec.structs.asdict(result)} for result in results]
    table = pyarrow.Table.from_pylist(rows, schema=pyarrow.schema(columns))
    with open_for_replacing(path) as file:
        parquet.write_table(table, file, compression="zstd")


def _list_columns(pyarrow: Any, type_: type[msgspec.Struct]) -> list[tuple[str, Any]]:
    kinds = {int: pyarrow.int64(), str: pyarrow.string(), tuple[str, ...]: pyarrow.string()}
    return [(field.name, kinds.get(field.type, pyarrow.float64())) for field in msgspec.structs.fields(type_)]
