"""Updates impact/model/cmake/names.toml: commands, modules and policies of CMake, the versions that brought them, and
what policies take away.

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
_REMOVED_OLD = re.compile(r"^\.\. \|REMOVED_IN_CMAKE_VERSION\| replace:: (\d+\.\d+)", re.MULTILINE)
_TAKEN_AWAY = re.compile(r"^The :(?:module|command):`.*(?:modules? (?:is|are) removed|command should not be called)\.$",
                         re.MULTILINE)  # fmt: skip
_FORMS = """# Arguments, as the first or, for project(), anywhere. Source: "New in version" of cmake-commands(7).
"""
_NAMED = re.compile(r":(?:module|command):`(\w+)`")
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


def _quote(name: str) -> str:
    """A name as a key of TOML."""
    return name if name.replace("_", "").isalnum() else f'"{name}"'


def find_policies(manual: Path) -> tuple[dict[str, str], dict[str, str]]:
    """The policies that cannot be OLD any longer, with the version from which on; and the commands and modules that a
    policy takes away where it is NEW, with that policy."""
    only_new, dropped = {}, {}
    for path in sorted((manual / "policy").glob("CMP*.txt")):
        text, policy = path.read_text(), path.name.partition(".")[0]
        if removed := _REMOVED_OLD.search(text):
            only_new[policy] = removed[1]
        if taken := _TAKEN_AWAY.search(text):
            dropped.update(dict.fromkeys(_NAMED.findall(taken[0]), policy))
    return only_new, dropped


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
    rows, forms = (
        "".join(f'{_quote(name)} = "{version}"\n' for name, version in sorted(since.items()) if ("(" in name) == form)
        for form in (False, True)
    )
    only_new, dropped = find_policies(given.manual)
    by_version = {version: [one for one in only_new if only_new[one] == version] for version in only_new.values()}
    lines = "".join(f'"{version}" = """\n{textwrap.fill(" ".join(policies), 120)}\n"""\n'
                    for version, policies in sorted(by_version.items()))  # fmt: skip
    tables = {
        "since": f"{rows}{_FORMS}{forms}",
        "only_new": lines,
        "dropped": "".join(f'{name} = "{policy}"\n' for name, policy in sorted({**known.dropped, **dropped}.items())),
    }
    for name, lines in tables.items():
        text = re.sub(rf"^\[{name}\]\n.*?(?=^\[)", f"[{name}]\n{lines}\n", text, flags=re.DOTALL | re.MULTILINE)
    write_file(TABLE, text.encode())
    print(len(since), "versions")


if __name__ == "__main__":
    main()
