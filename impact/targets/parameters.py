"""Parameters of nodes that got another name, and what their names are made of.

Which parameters a version declares is told by the surfaces; that one came for another is what a person found in the
sources. The facts are in `data/parameters.json`, each with the address that says so.
"""

from functools import cache

import msgspec

from .tables import find_table
from .unpacked import read_table


def find_last_part(name: str) -> str:
    """The last part of a parameter's name, in either generation of ROS."""
    return name.replace("/", ".").rpartition(".")[2].lstrip("~")


class RenamedParameters(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Parameters that got other names in a version of these packages, since. names: old to new, by their last parts.
    source: an address."""

    packages: tuple[str, ...]
    since: str
    source: str
    names: dict[str, str]


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    renamed: list[RenamedParameters]


@cache
def find_renamed_parameters(package: str) -> dict[str, tuple[str, ...]]:
    """The other names, old or new, of a package's parameters, all by their last parts. Raises SnapshotError when the
    data file cannot be read."""
    found: dict[str, tuple[str, ...]] = {}
    for row in load_renamed_parameters():
        for old, new in row.names.items() if package in row.packages else ():
            found[old] = (*found.get(old, ()), new)
            found[new] = (*found.get(new, ()), old)
    return found


@cache
def load_renamed_parameters() -> list[RenamedParameters]:
    """Every row. Raises SnapshotError."""
    return read_table(find_table("parameters.json"), _File).renamed
