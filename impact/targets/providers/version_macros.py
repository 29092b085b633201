"""How code asks which version of a package or library it is compiled with: the macros of data/version_macros.json."""

from functools import cache
from typing import NamedTuple

import msgspec

from ..tables import find_table
from ..unpacked import read_table
from ..version import is_at_least, parse


class _Row(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How some packages tell their version. since: the first version that has the macro. form: the test, with the
    numbers of a version as {0}, {1} and {2}, or as one {number} made with weights; major: the same where only the first
    number is not 0. only_major: the macro knows no more. ros: only in this generation."""

    packages: tuple[str, ...]
    since: str
    header: str
    form: str
    source: str
    major: str = ""
    weights: tuple[int, ...] = ()
    only_major: bool = False
    ros: int = 0


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    macros: tuple[_Row, ...]
    libraries: tuple[_Row, ...]


class VersionTest(NamedTuple):
    """The expression of an `#if` that holds from a version on, and the header that it needs."""

    text: str
    header: str


def make_version_test(package: str, library: bool, version: str, *, ros: int, oldest: str) -> VersionTest | None:
    """The test for at least this version of a package or platform library; None where no macro is known.

    oldest: the lowest version that has to understand it. Raises SnapshotError when the table cannot be read.
    """
    row = _load_rows().get((package, library))
    if row is None or not is_at_least(oldest, row.since) or row.ros not in (0, ros):
        return None
    numbers = (*parse(version), 0, 0, 0)[:3]
    if row.only_major and any(numbers[1:]):
        return None
    form = row.major if row.major and not any(numbers[1:]) else row.form
    number = sum(weight * part for weight, part in zip(row.weights, numbers, strict=False))
    return VersionTest(form.format(*numbers, number=number), row.header)


@cache
def _load_rows() -> dict[tuple[str, bool], _Row]:
    file = read_table(find_table("version_macros.json"), _File)
    return {(name, library): row for rows, library in ((file.macros, False), (file.libraries, True)) for row in rows
            for name in row.packages}  # fmt: skip
