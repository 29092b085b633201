"""What a rule proposes to change, by name and place. Rules see no bytes; fix.py makes byte edits of it."""

import msgspec


class Declare(msgspec.Struct, frozen=True, array_like=True, tag=True):
    """Declare a dependency in a manifest. tag: as format 2 and 3 know it (`depend`, `exec_depend`, ...)."""

    path: str
    name: str
    tag: str = "depend"


# REP 127, format 1: run_depend stands for what a package's users need when building and when running.
_FORMAT_1 = {
    "depend": ("build_depend", "run_depend"),
    "exec_depend": ("run_depend",),
    "build_export_depend": ("run_depend",),
    "buildtool_export_depend": (),
    "doc_depend": (),
}


def translate_tag(tag: str, manifest_format: int) -> tuple[str, ...]:
    """The tags of a format that say what a tag of format 2 and 3 says."""
    return _FORMAT_1.get(tag, (tag,)) if manifest_format == 1 else (tag,)


class Remove(msgspec.Struct, frozen=True, array_like=True, tag=True):
    """Take a dependency out of a manifest: one tag of it, or all when tag is empty."""

    path: str
    name: str
    tag: str = ""


class Replace(msgspec.Struct, frozen=True, array_like=True, tag=True):
    """Replace `old`, which stands at a line and column (characters, from 1), by `new`. column 0: the only one. needs:
    packages of CMake, each with something of LinkForm.items that it has to have; empty where `new` is a header."""

    path: str
    line: int
    column: int
    old: str
    new: str
    needs: tuple[tuple[str, str], ...] = ()


class Insert(msgspec.Struct, frozen=True, array_like=True, tag=True):
    """Put lines behind a line (0: at the start of the file), with that line's indentation; in CMake, behind the command
    that the line belongs to. text: without a line end. needs: as of Replace."""

    path: str
    line: int
    text: str
    needs: tuple[tuple[str, str], ...] = ()


class Edit(msgspec.Struct, frozen=True, array_like=True, tag=True):
    """A replacement in one file, by byte offsets; start == end inserts."""

    path: str
    start: int
    end: int
    text: str


FixAction = Edit | Declare | Remove | Replace | Insert
