"""Writing: what was asked for and nothing else, not through links, not into .git, whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from .harness import COMMANDS, FORMATS, NEEDS_GIT, STATUS, Attack, Ended, Place, fifo, link, manifest, remove, write
from .kinds import KINDS

GROUP = "writes"
CHECK = COMMANDS["check"]
FIX = (*CHECK, "--fix")
SOURCE = "src/healthy/src/node.cpp"
GOOD = "#include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>"
BAD_HEADER = "#include <tf2_geometry_msgs/tf2_geometry_msgs.h>"


def fixed(place: Place, ended: Ended) -> list[str]:
    """What can be fixed is fixed."""
    return [] if GOOD in (place.ws / SOURCE).read_text() else [f"{SOURCE} is not fixed"]


def outside_source(place: Place) -> None:
    write(place.outside, {"node.cpp": (place.ws / SOURCE).read_text()})


def linked_source(place: Place) -> None:
    outside_source(place)
    link(place.ws / SOURCE, place.outside / "node.cpp")


def linked_folder(place: Place) -> None:
    outside_source(place)
    remove(place.ws / "src/healthy/src")
    link(place.ws / "src/healthy/src", place.outside)


def linked_package(place: Place) -> None:
    for name in ("package.xml", "CMakeLists.txt", "src/node.cpp"):
        write(
            place.outside,
            {f"pkg/{name}": (place.ws / "src/healthy" / name).read_text().replace("healthy", "elsewhere")},
        )
    link(place.ws / "src/elsewhere", place.outside / "pkg")


def linked_to_git(place: Place) -> None:
    write(place.ws, {".git/hooks/node.cpp": (place.ws / SOURCE).read_text()})
    link(place.ws / SOURCE, "../../../.git/hooks/node.cpp")


def package_in_git(place: Place) -> None:
    for name in ("package.xml", "CMakeLists.txt", "src/node.cpp"):
        write(
            place.ws, {f".git/pkg/{name}": (place.ws / "src/healthy" / name).read_text().replace("healthy", "hidden")}
        )
    link(place.ws / "src/hidden", "../.git/pkg")


def linked_in_the_tree(place: Place) -> None:
    write(place.ws, {"kept/node.cpp": (place.ws / SOURCE).read_text()})
    link(place.ws / SOURCE, "../../../kept/node.cpp")


def hard_link(place: Place) -> None:
    outside_source(place)
    remove(place.ws / SOURCE)
    os.link(place.outside / "node.cpp", place.ws / SOURCE)


def linked_manifest(place: Place) -> None:
    write(place.outside, {"package.xml": manifest("healthy", "rclcpp")})
    link(place.ws / "src/healthy/package.xml", place.outside / "package.xml")


def read_only(place: Place) -> None:
    (place.ws / SOURCE).chmod(0o444)


def odd_source(text: str | bytes) -> dict[str, str | bytes]:
    return {SOURCE: text}


LINES = str(KINDS[6].text.replace("WORD", "x"))


def link_at(path: str, target: str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        link(Path(place.filled(path)), place.filled(target))

    return make


def folder_link(path: str, target: str) -> Callable[[Place], None]:
    return link_at(path, target)


def untouched(name: str, content: str) -> Callable[[Place, Ended], list[str]]:
    def after(place: Place, ended: Ended) -> list[str]:
        path = Path(place.filled(name))
        if not path.exists() or path.read_text() != content:
            return [f"{path.name} is changed or cut"]
        left = [each for each in path.parent.iterdir() if each != path and each.name not in ("report", "src")]
        return [f"leaves {left[0].name} behind"] if left else []

    return after


def old_file(name: str) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        path = Path(place.filled(name))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("old\n")

    return make


OUTPUTS: dict[str, tuple[tuple[str, ...], str]] = {
    **{
        f"{command} {format} --output": ((*COMMANDS[command], "-f", format, "-o", "PATH"), command)
        for command in ("check", "graph", "impact", "upgrade", "logic")
        for format in (FORMATS[command][0], FORMATS[command][-1])
    },
    "env diff --output": ((*COMMANDS["env"], "-o", "PATH"), "env"),
    "env capture --output": (("env", "capture", "-o", "PATH"), ""),
    "check --write-baseline": ((*CHECK, "--write-baseline", "PATH"), ""),
    "surface show --output": (("surface", "show", "rclcpp@jazzy", "-o", "PATH"), ""),
    "surface diff --output": (("surface", "diff", "rclcpp", "humble", "jazzy", "-o", "PATH"), ""),
}


def rows() -> list[Attack]:
    found: list[Attack] = [
        Attack("--fix fixes", GROUP, {}, FIX, (1,), changes=(SOURCE,), after=fixed),
        Attack("--fix through a link of a file", GROUP, linked_source, FIX, (0, 1)),
        Attack("--fix through a link of a folder", GROUP, linked_folder, FIX, (0, 1)),
        Attack("--fix through a link of a package", GROUP, linked_package, FIX, (0, 1), changes=(SOURCE,), after=fixed),
        Attack("--fix through a link of a manifest", GROUP, linked_manifest, FIX, (0, 1), changes=(SOURCE,), found=""),
        Attack("--fix into .git", GROUP, linked_to_git, FIX, (0, 1), git=True),
        Attack(
            "--fix into a package in .git", GROUP, package_in_git, FIX, (0, 1), git=True, changes=(SOURCE,), after=fixed
        ),
        Attack(
            "--fix of a link in the tree keeps the link",
            GROUP,
            linked_in_the_tree,
            FIX,
            (2,),  # its fix belongs to where it lies
        ),
        Attack("--fix of a hard link", GROUP, hard_link, FIX, (0, 1), changes=(SOURCE,)),
        Attack("--fix of a file that is read-only", GROUP, read_only, FIX, (2,)),
        Attack(
            "--fix keeps carriage returns",
            GROUP,
            odd_source(str(LINES).replace("\n", "\r\n")),
            FIX,
            (0, 1),
            changes=(SOURCE,),
            after=keeps(b"\r\n"),
        ),
        Attack(
            "--fix keeps bytes that are no UTF-8",
            GROUP,
            odd_source(LINES.encode() + b"// caf\xe9\n"),
            FIX,
            (0, 1),
            changes=(SOURCE,),
            after=keeps(b"caf\xe9"),
        ),
        Attack(
            "--fix keeps a byte order mark",
            GROUP,
            odd_source(b"\xef\xbb\xbf" + LINES.encode()),
            FIX,
            (0, 1),
            changes=(SOURCE,),
            after=keeps(b"\xef\xbb\xbf"),
        ),
        Attack("--fix with a link of its temporary name", GROUP, temporary_links, FIX, (0, 1), changes=(SOURCE,)),
        Attack(
            "--fix on a full disk",
            GROUP,
            {SOURCE: LINES + "// more\n" * 100_000},
            FIX,
            (0, 1, 2),
            limits={"RLIMIT_FSIZE": 100_000},
            found="",
            after=whole_source,
            changes=(SOURCE,),
        ),
        Attack("--diff changes nothing", GROUP, {}, (*CHECK, "--diff"), (1,), found=""),
        Attack("check changes nothing", GROUP, {}, CHECK, (1,), git=True),
        Attack("installed command: --fix through a link", GROUP, linked_source, FIX, (0, 1), direct=True),
        Attack(
            "--prune-baseline through a link",
            GROUP,
            linked_baseline,
            (*CHECK, "--baseline", "{ws}/known.json", "--prune-baseline"),
            (0, 1, 2),
            found="",
        ),
        Attack(
            "--write-baseline over the healthy package",
            GROUP,
            {},
            (*CHECK, "--write-baseline", "{ws}/src"),
            (2,),
            found="",
        ),
    ]
    for name, (command, kind) in OUTPUTS.items():
        status = (STATUS[kind],) if kind else (0,)
        git = kind in NEEDS_GIT

        def asked(path: str, command: tuple[str, ...] = command) -> tuple[str, ...]:
            return tuple(part.replace("PATH", path) for part in command)

        found += [
            Attack(
                f"{name} over a link to a file outside",
                GROUP,
                link_at("{out}/report", "{outside}/secret.txt"),
                asked("{out}/report"),
                (2,),
                git=git,
                found="",
            ),
            Attack(
                f"{name} over a link of the workspace",
                GROUP,
                link_at("{ws}/report", "{outside}/new"),
                asked("{ws}/report"),
                (2,),
                git=git,
                found="",
            ),
            Attack(f"{name} into .git", GROUP, {}, asked("{ws}/.git/report"), (2,), git=True, found=""),
            Attack(f"{name} over a pipe", GROUP, a_pipe, asked("{out}/report"), (2,), git=git, found=""),
            Attack(
                f"{name} on a full disk",
                GROUP,
                old_file("{out}/report"),
                asked("{out}/report"),
                (2,),
                git=git,
                found="",
                limits={"RLIMIT_FSIZE": 20},
                environment={"ROSIMPACT_CACHE": "/nowhere/cache"},
                seconds=8,
                after=untouched("{out}/report", "old\n"),
            ),
        ]
        if kind in ("check", "") and "html" not in name:
            found += [
                Attack(
                    f"{name} through a folder that is a link of the workspace",
                    GROUP,
                    folder_link("{ws}/reports", "{outside}"),
                    asked("{ws}/reports/new"),
                    (2,),
                    git=git or not kind,
                    found="",
                ),
                Attack(
                    f"{name} over a link to .git",
                    GROUP,
                    link_at("{ws}/report", ".git/config"),
                    asked("{ws}/report"),
                    (2,),
                    git=True,
                    found="",
                ),
                Attack(
                    f"{name} through a link to .git",
                    GROUP,
                    link_at("{ws}/reports", ".git/hooks"),
                    asked("{ws}/reports/pre-commit"),
                    (2,),
                    git=True,
                    found="",
                ),
                Attack(
                    f"{name} over a link that dangles",
                    GROUP,
                    link_at("{out}/report", "{outside}/new"),
                    asked("{out}/report"),
                    (2,),
                    found="",
                ),
                Attack(
                    f"{name} over a link that loops",
                    GROUP,
                    link_at("{out}/report", "report"),
                    asked("{out}/report"),
                    (2,),
                    found="",
                ),
                Attack(f"{name} into a path with a null byte", GROUP, {}, asked("{out}/a\\x00b"), status, found=""),
            ]
    for format in FORMATS["check"]:
        found.append(
            Attack(
                f"check {format}: killed while it writes",
                GROUP,
                old_file("{out}/report"),
                (*CHECK, "-f", format, "-o", "{out}/report"),
                (1, -9),
                found="",
                signal=(9, 0.3, "group"),
                after=old_or_whole,
            )
        )
    for name, path in {
        "/dev/full": "/dev/full",
        "/dev/null": "/dev/null",
        "/dev/stdout": "/dev/stdout",
        "/proc/self/mem": "/proc/self/mem",
    }.items():
        found.append(Attack(f"check --output {name}", GROUP, {}, (*CHECK, "-o", path), (1, 2), found=""))
    return found


def keeps(part: bytes) -> Callable[[Place, Ended], list[str]]:
    def after(place: Place, ended: Ended) -> list[str]:
        return [] if part in (place.ws / SOURCE).read_bytes() else [f"{part!r} is lost"]

    return after


def whole_source(place: Place, ended: Ended) -> list[str]:
    data = (place.ws / SOURCE).read_text()
    return [] if data.endswith("// more\n") and data.count("// more\n") == 100_000 else [f"{SOURCE} is cut"]


def temporary_links(place: Place) -> None:
    for name in ("node.cpp~", "node.cpp.tmp", ".node.cpp.tmp", "node.cpp.new", ".node.cpp.swp", "node.cpp.bak"):
        link(place.ws / "src/healthy/src" / name, place.outside / "secret.txt")


def linked_baseline(place: Place) -> None:
    write(place.outside, {"known.json": '{"schema": 1, "findings": [{"fingerprint": "x", "count": 1}]}\n'})
    link(place.ws / "known.json", place.outside / "known.json")


def a_pipe(place: Place) -> None:
    fifo(place.out / "report")


def old_or_whole(place: Place, ended: Ended) -> list[str]:
    data = (place.out / "report").read_text()
    return (
        []
        if data == "old\n" or ("asks for OpenCV 9" in data and len(data) > 300)
        else [f"the report is cut: {len(data)} bytes"]
    )
