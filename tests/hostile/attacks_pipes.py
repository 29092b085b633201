"""Files that are none: pipes, sockets, devices and folders, wherever a file is opened."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from .harness import COMMANDS, NEEDS_GIT, STATUS, Attack, Place, fifo, link, remove, unix_socket, write
from .kinds import KINDS, Kind

GROUP = "pipes"
CHECK = (*COMMANDS["check"], "--notes", "-f", "json")


def zero(path: Path) -> None:
    link(path, "/dev/zero")


def standard_input(path: Path) -> None:
    link(path, "/dev/stdin")


def linked_pipe(path: Path) -> None:
    fifo(path.parent / "a_pipe")
    link(path, "a_pipe")


def kernel(path: Path) -> None:
    link(path, "/proc/kmsg")


def folder(path: Path) -> None:
    remove(path)
    path.mkdir(parents=True)


FEW = ("manifest", "cmake", "node", "launch.py", "msg", "toml", "gitmodules", "defaults.yaml", "colcon.meta")
WAYS: list[Callable[[Path], None]] = [fifo, unix_socket, zero, linked_pipe]


def rows() -> list[Attack]:
    found = [
        Attack(f"{way.__name__} as {kind.name}", GROUP, making(kind, way), CHECK, refusable=kind.setting)
        for kind in KINDS
        for way in WAYS
        if way in (fifo, zero) or kind.name in FEW
    ]
    for kind in KINDS:
        found.append(Attack(f"folder as {kind.name}", GROUP, making(kind, folder), CHECK, refusable=kind.setting))
    for command in COMMANDS:
        if command == "check":
            continue
        for name in ("manifest", "cmake", "cpp", "launch.py", "gitmodules", "defaults.yaml"):
            kind = next(kind for kind in KINDS if kind.name == name)
            found.append(
                Attack(
                    f"{command}: fifo as {name}",
                    GROUP,
                    making(kind, fifo),
                    COMMANDS[command],
                    (STATUS[command],),
                    git=command in NEEDS_GIT,
                )
            )
    for name in INSIDE_GIT:
        for way in (fifo, zero):
            found.append(
                Attack(
                    f"{way.__name__} as .git/{name}",
                    GROUP,
                    inside_git(name, way),
                    (*CHECK, "--base", "HEAD~1"),
                    status=(0, 1, 2),
                    git=True,
                    found="",
                )
            )
    for name in ("index", "HEAD", "config", "refs/heads/main", "packed-refs"):
        found.append(
            Attack(f"fifo as .git/{name}, no revision asked for", GROUP, inside_git(name, fifo), CHECK, git=True)
        )
    for way in (fifo, zero, folder, kernel):
        for pattern in ("facts.sqlite", "facts.sqlite-wal", "distros-*.sqlite", "providers-*.sqlite"):
            found.append(
                Attack(f"{way.__name__} as {pattern} of the cache", GROUP, {}, CHECK, before=in_cache(pattern, way))
            )
    for what, (place_of, command) in ASKED.items():
        for way in (fifo, zero):
            found.append(
                Attack(
                    f"{way.__name__} as {what}",
                    GROUP,
                    at(place_of, way),
                    command,
                    status=(2,),
                    found="",
                    words=(os.path.basename(place_of),),
                )
            )
    found += [
        Attack(
            "fifo as a library of an install space",
            GROUP,
            at("install/bad/lib/libbad.so", fifo),
            (*CHECK, "--install", "{ws}/install"),
            (0, 1, 2),
            found="",
        ),
        Attack(
            "/dev/zero as a library of an install space",
            GROUP,
            at("install/bad/lib/libbad.so", zero),
            (*CHECK, "--install", "{ws}/install"),
            (0, 1, 2),
            found="",
        ),
        Attack(
            "fifo as setup.sh of an install space",
            GROUP,
            at("install/bad/setup.sh", fifo),
            (*CHECK, "--install", "{ws}/install"),
            (0, 1, 2),
            found="",
        ),
        Attack(
            "fifo as the workspace",
            GROUP,
            at("pipe", fifo),
            ("check", "{ws}/pipe", "-t", "jazzy"),
            status=(2,),
            found="",
        ),
        Attack("/dev/zero as the workspace", GROUP, {}, ("check", "/dev/zero", "-t", "jazzy"), status=(2,), found=""),
        Attack(
            "fifo as a report to triage", GROUP, at("report", fifo), ("triage", "{ws}/report"), status=(0, 2), found=""
        ),
        Attack(
            "/dev/zero as a report to triage",
            GROUP,
            at("report", zero),
            ("triage", "{ws}/report"),
            status=(0, 2),
            found="",
        ),
        Attack(
            "fifo as the labels",
            GROUP,
            at("labels.jsonl", fifo),
            ("corpus", "stats", "--labels", "{ws}/labels.jsonl"),
            status=(2,),
            found="",
        ),
        Attack(
            "/dev/zero as the labels",
            GROUP,
            at("labels.jsonl", zero),
            ("corpus", "stats", "--labels", "{ws}/labels.jsonl"),
            status=(2,),
            found="",
        ),
        Attack(
            "fifo as the corpus",
            GROUP,
            at("corpus.sqlite", fifo),
            ("corpus", "status", "--store", "{ws}/corpus.sqlite"),
            status=(2,),
            found="",
        ),
        Attack(
            "/dev/zero as the corpus",
            GROUP,
            at("corpus.sqlite", zero),
            ("corpus", "status", "--store", "{ws}/corpus.sqlite"),
            status=(2,),
            found="",
        ),
        Attack(
            "fifo as the texts of the corpus",
            GROUP,
            at("r.jsonl", fifo),
            ("corpus", "label", "--list", "--reports", "{ws}/r.jsonl"),
            status=(2,),
            found="",
        ),
        Attack(
            "fifo as a model", GROUP, at("m", fifo), ("triage", "it fails", "--model", "{ws}/m"), status=(2,), found=""
        ),
        Attack(
            "/dev/zero as a model",
            GROUP,
            at("m", zero),
            ("triage", "it fails", "--model", "{ws}/m"),
            status=(2,),
            found="",
        ),
        Attack("fifo as the cache", GROUP, at("cache", fifo), CHECK, environment={"ROSIMPACT_CACHE": "{ws}/cache"}),
        Attack("/dev/null as the cache", GROUP, {}, CHECK, environment={"ROSIMPACT_CACHE": "/dev/null"}),
        Attack(
            "stdin that never ends as rosimpact.toml",
            GROUP,
            at("rosimpact.toml", standard_input),
            CHECK,
            refusable="rosimpact.toml",
            stdin="/dev/zero",
        ),
        Attack("/proc/kmsg as CMakeLists.txt", GROUP, at("src/bad/CMakeLists.txt", kernel), CHECK),
        Attack("/proc/kmsg as rosimpact.toml", GROUP, at("rosimpact.toml", kernel), CHECK, refusable="rosimpact.toml"),
        Attack("/dev/tty as .gitmodules", GROUP, at(".gitmodules", lambda path: link(path, "/dev/tty")), CHECK),
        Attack(
            "/dev/urandom as a source", GROUP, at("src/bad/src/a.cpp", lambda path: link(path, "/dev/urandom")), CHECK
        ),
        Attack("a pipe for every kind at once", GROUP, all_pipes, CHECK),
        Attack("fifo as a git repository", GROUP, at("x.git", fifo), ("logic", "{ws}/x.git"), status=(2,), found=""),
        Attack(
            "installed command: fifo as rosimpact.toml",
            GROUP,
            at("rosimpact.toml", fifo),
            CHECK,
            refusable="rosimpact.toml",
            direct=True,
        ),
    ]
    return found


INSIDE_GIT = (
    "index",
    "HEAD",
    "config",
    "refs/heads/main",
    "packed-refs",
    "objects/info/alternates",
    "shallow",
    "info/exclude",
    "commondir",
    "refs",
    "objects",
    "logs/HEAD",
    "FIRST",
)
ASKED = {
    "the baseline": ("known.json", (*CHECK, "--baseline", "{ws}/known.json")),
    "the configuration": ("other.toml", (*CHECK, "--config", "{ws}/other.toml")),
    "a captured machine": ("laptop.json", ("check", "{ws}", "-t", "{ws}/laptop.json")),
    "a listing of dpkg": ("robot.dpkg.txt", ("check", "{ws}", "-t", "{ws}/robot.dpkg.txt")),
    "pinned repositories": ("pinned.repos", (*CHECK, "--base", "{ws}/pinned.repos")),
    "a Debian package": ("a.deb", ("surface", "diff", "rclcpp", "{ws}/a.deb", "jazzy")),
    "one of two machines": ("one.json", ("env", "diff", "{ws}/one.json", "jazzy")),
}


def making(kind: Kind, way: Callable[[Path], None]) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        write(place.ws, dict(kind.beside))
        way(place.ws / kind.path)

    return make


def at(path: str, way: Callable[[Path], None]) -> Callable[[Place], None]:
    return lambda place: way(place.ws / path)


def inside_git(name: str, way: Callable[[Path], None]) -> Callable[[Place], None]:
    """FIRST stands for the first loose object."""

    def make(place: Place) -> None:
        path = place.ws / ".git" / name
        if name == "FIRST":
            path = sorted(each for each in (place.ws / ".git/objects").glob("??/*"))[0]
        remove(path)
        way(path)

    return make


def in_cache(pattern: str, way: Callable[[Path], None]) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        for path in list(place.cache.glob(pattern)) or [place.cache / pattern.replace("*", "x")]:
            remove(path)
            way(path)

    return make


def all_pipes(place: Place) -> None:
    for kind in KINDS:
        if not kind.setting and kind.path != "src/bad/package.xml":
            fifo(place.ws / kind.path)
