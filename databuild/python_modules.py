"""Builds data/python_modules.json: which top-level modules each version of Python has.

    python -P -m rosimpact.databuild.python_modules STDLIB ... [--python 2.7=FOLDER ...] --output DATA

STDLIB is a folder `stdlib` of typeshed, oldest first, whose table VERSIONS says since when there is a module and until
when. FOLDER holds the unpacked libraries of a version of Python, as Debian packages them (libpython2.7-stdlib and
libpython2.7-minimal); they tell of modules that typeshed has no stubs of, and of Python 2. What serves instead of a
module that is gone is told by no table: it is kept as it was reviewed, and lib2to3 in a folder tells it of Python 2.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import msgspec

from ..edges.files import write_file
from ..impact.targets.providers.stdlib import FILE, Modules
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table

_OLDEST = 4
"""The first minor version of Python 3 that is told apart from those before it."""
_ROW = re.compile(r"^([A-Za-z_]\w*): *(\d)\.(\d+)-(?:(\d)\.(\d+))?", re.MULTILINE)
_NOT_PRIVATE = frozenset(("__future__", "__main__", "__builtin__", "_thread"))
_ASIDE = re.compile(r"_typeshed|__phello__|_sysconfigdata.*|config-.*|site-packages|LICENSE"
                    r"|dist-packages|lib-dynload|sitecustomize|_test\w*|_xx\w*|xx\w*|_ctypes_test")  # fmt: skip


def read_versions(folder: Path) -> dict[str, tuple[tuple[int, int], int | None]]:
    """Modules of typeshed with the first version that has them, and the minor version of Python 3 that has them last,
    None where the newest has."""
    text = (folder / "VERSIONS").read_text(encoding="utf-8")
    return {
        found[1]: ((int(found[2]), int(found[3])), int(found[5]) if found[5] else None)
        for found in _ROW.finditer(re.sub(r"#[^\n]*", "", text))
    }


def list_modules(folder: Path) -> Iterator[str]:
    """The top-level modules in unpacked libraries of Python."""
    for place in folder.glob("usr/lib/python*"):
        for path in (*place.iterdir(), *(place / "lib-dynload").glob("*")):
            name = path.name.partition(".")[0]
            is_module = path.suffix in (".py", ".so") or (path / "__init__.py").is_file()
            if is_module and name.isidentifier() and not _ASIDE.fullmatch(name):
                yield name


def read_renamed(folder: Path) -> dict[str, str]:
    """What lib2to3 writes for modules of Python 2: `ConfigParser` to `configparser`."""
    found: dict[str, str] = {}
    for file in sorted(folder.glob("usr/lib/python*/lib2to3/fixes/fix_imports*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "MAPPING":
                found.update(ast.literal_eval(node.value))
    return found


def build_table(stubs: Iterable[Path], pythons: Mapping[tuple[int, int], Path], before: Modules) -> Modules:
    """The table. stubs: folders of typeshed, oldest first. pythons: version to folder. before: the table before, with
    what serves instead of modules."""
    folders = list(stubs)
    ranges: dict[str, tuple[tuple[int, int], int | None]] = {}
    for folder in folders:
        for name, (first, last) in read_versions(folder).items():
            known = ranges.get(name)
            ranges[name] = (min(known[0], first) if known is not None else first, last)
    there = {version: frozenset(list_modules(folder)) for version, folder in pythons.items()}
    three = {version[1]: names for version, names in there.items() if version[0] == 3}
    for name in sorted(frozenset().union(*three.values()) - ranges.keys()) if three else ():
        having = sorted(minor for minor, names in three.items() if name in names)
        since = (3, having[0] if having[0] > min(three) else 0)
        ranges[name] = (since, None if having[-1] == max(three) else having[-1])
    running, dropped = sys.version_info.minor, set()
    for name, (first, last) in list(ranges.items()):
        if first > (3, running) or (last is not None and last < running):
            continue
        if name not in sys.stdlib_module_names | _NOT_PRIVATE and not any(name in names for names in three.values()):
            del ranges[name]  # typeshed has stubs of more
            dropped.add(name)
    for name in sys.stdlib_module_names - ranges.keys():
        ranges[name] = ((3, 0), None)
    renamed = {old: new for folder in pythons.values() for old, new in read_renamed(folder).items()}
    # Those that were renamed have stubs under their new names alone.
    new = {name.partition(".")[0] for name in renamed.values()} - set(there.get((2, 7), ()))
    two = {*there.get((2, 7), ()), *renamed}
    two.update(path.stem for folder in folders for path in (folder / "@python2").glob("*") if path.stem not in new)
    two.update(name for name, (first, _) in ranges.items() if first[0] == 2 and name not in new)
    two -= dropped
    kept = frozenset(name for name in two if not _ASIDE.fullmatch(name))
    return _make_table(ranges, kept, {**renamed, **_collect_successors(before)})


def _make_table(
    ranges: Mapping[str, tuple[tuple[int, int], int | None]], two: frozenset[str], successors: Mapping[str, str]
) -> Modules:
    def write(names: Iterable[str]) -> str:
        return " ".join(f"{name}={successors[name]}" if name in successors else name for name in sorted(names))

    public = {name: each for name, each in ranges.items() if not _is_private(name) and not _ASIDE.fullmatch(name)}
    added = {name: first[1] for name, (first, _) in public.items() if first[0] == 3 and first[1] > _OLDEST}
    removed: dict[int, list[str]] = {}
    for name, (_, last) in public.items():
        if last is not None:
            removed.setdefault(last + 1, []).append(name)
    always = public.keys() - added.keys() - {name for names in removed.values() for name in names}
    old = {name for name in two if name not in public and not _is_private(name)}
    return Modules(
        "VERSIONS of typeshed; libraries of Python in Debian; what serves instead: lib2to3, What's New of each",
        " ".join(sorted(always)),
        dict(sorted(added.items(), key=lambda item: (item[1], item[0]))),
        {minor: write(names) for minor, names in sorted(removed.items())},
        write(old),
        " ".join(sorted(name for name in always if name not in two)),
        " ".join(sorted(name for name in ranges if _is_private(name) and not _ASIDE.fullmatch(name))),
    )


def _is_private(name: str) -> bool:
    return name.startswith("_") and name not in _NOT_PRIVATE


def _collect_successors(before: Modules) -> dict[str, str]:
    words = (word for text in (before.python2, *before.removed.values()) for word in text.split())
    return {old: new for old, _, new in (word.partition("=") for word in words) if new}


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stubs", nargs="+", type=Path)
    parser.add_argument("--python", action="append", default=[], help="2.7=FOLDER")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    pythons = {}
    for item in given.python:
        version, _, folder = item.partition("=")
        major, _, minor = version.partition(".")
        pythons[int(major), int(minor)] = Path(folder)
    file = given.output / FILE
    made = build_table(given.stubs, pythons, read_table(file, Modules))
    write_file(file, msgspec.json.format(msgspec.json.encode(made), indent=1) + b"\n")
    print(len(made.always.split()), "modules,", len(made.added), "added")


if __name__ == "__main__":
    main()
