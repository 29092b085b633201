"""Updates impact/model/cmake/names.toml: commands, modules and policies of CMake, and the versions that brought them.

    python -P -m rosimpact.databuild.cmake_names MANUAL MODULES

MANUAL is the folder of the manual's sources (`/usr/share/doc/cmake-doc/html/_sources` of Debian's cmake-doc), MODULES
that of the modules (`/usr/share/cmake-3.25/Modules`). What the table has and this CMake lacks stays: older and newer
versions have it.
"""

from __future__ import annotations

import argparse
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path

from ..edges.files import write_file
from ..impact.model.cmake.names import TABLE, read_table

_ADDED = re.compile(r"\A\s*(?:\.\. )?(\S+?)(?:\(\))?\s*\n[-=^]{3,}\s*\n\s*\.\. versionadded:: (\d+\.\d+)")
_COMMAND = re.compile(r"^\.\. command:: (\w+)\s*\n\s*\n?\s*\.\. versionadded:: (\d+\.\d+)", re.MULTILINE)
_DOCUMENTATION = re.compile(r"#\[=*\[\.rst:\n(.*?)#?\]=*\]", re.DOTALL)


def find_versions(manual: Path, modules: Path) -> Iterator[tuple[str, str]]:
    """Each name with the version that brought it, where the manual tells one."""
    texts = [path.read_text() for kind in ("command", "policy") for path in sorted((manual / kind).glob("*.txt"))]
    for path in sorted(modules.glob("*.cmake")):
        texts += _DOCUMENTATION.findall(path.read_text(errors="replace"))
    for text in texts:
        if added := _ADDED.match(text):
            yield added[1], added[2]
        yield from ((name.lower(), version) for name, version in _COMMAND.findall(text))


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("manual", type=Path)
    parser.add_argument("modules", type=Path)
    given = parser.parse_args(arguments)
    known = read_table()
    commands, modules = ({path.name.partition(".")[0] for path in (given.manual / kind).glob("*.txt")}
                         for kind in ("command", "module"))  # fmt: skip
    versions = dict(find_versions(given.manual, given.modules))
    since = {**known.since, **{name: version for name, version in versions.items() if version[0] != "2"}}
    text = TABLE.read_text(encoding="utf-8")
    for name, found in (("commands", commands), ("modules", modules)):
        every = sorted({*found, *getattr(known, name).split()})
        lines = textwrap.fill(" ".join(every), 120, break_long_words=False, break_on_hyphens=False)
        text = re.sub(rf'^{name} = """.*?"""', f'{name} = """\n{lines}\n"""', text, flags=re.DOTALL | re.MULTILINE)
    rows = "".join(f'{name} = "{version}"\n' for name, version in sorted(since.items()))
    text = re.sub(r"^\[since\]\n.*?(?=^\[)", f"[since]\n{rows}\n", text, flags=re.DOTALL | re.MULTILINE)
    write_file(TABLE, text.encode())
    print(len(since), "versions")


if __name__ == "__main__":
    main()
