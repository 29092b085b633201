"""One malformed file, of every kind: the healthy package's finding is reported all the same."""

from __future__ import annotations

from collections.abc import Callable

from .harness import COMMANDS, NEEDS_GIT, STATUS, Attack, Place, commit, write
from .kinds import KINDS, Kind

GROUP = "files"
CHECK = (*COMMANDS["check"], "--notes", "-f", "json")

SPOILED: dict[str, Callable[[bytes], bytes]] = {
    "of random bytes": lambda data: bytes((index * 167 + 13) % 256 for index in range(5_000)),
    "cut off": lambda data: data[: len(data) * 2 // 3],
    "in UTF-16": lambda data: data.decode().encode("utf-16"),
    "with null bytes": lambda data: data.replace(b" ", b"\0 "),
    "with wrong UTF-8": lambda data: data.replace(b"WORD", b"\xff\xfe\xc3(\xed\xa0\x80"),
}


def making(kind: Kind, spoil: Callable[[bytes], bytes]) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        write(place.ws, {**kind.beside, kind.path: spoil(kind.text.encode())})

    return make


def in_git(make: Callable[[Place], None]) -> Callable[[Place], None]:
    def both(place: Place) -> None:
        make(place)
        text = (place.ws / "src/healthy/src/node.cpp").read_text()
        write(place.ws, {"src/healthy/src/node.cpp": text.replace("> 3", "> 4")})
        commit(place.ws, "more", time=1_700_000_200)

    return both


def rows() -> list[Attack]:
    found = [
        Attack(f"{kind.name} {name}", GROUP, making(kind, spoil), CHECK, refusable=kind.setting)
        for kind in KINDS
        for name, spoil in SPOILED.items()
    ]
    for command in COMMANDS:
        if command == "check":
            continue
        for name in ("manifest", "cmake", "node", "launch.py", "msg", "python"):
            kind = next(kind for kind in KINDS if kind.name == name)
            make = making(kind, SPOILED["of random bytes"])
            found.append(
                Attack(
                    f"{command}: {name} of random bytes",
                    GROUP,
                    in_git(make) if command in NEEDS_GIT else make,
                    COMMANDS[command],
                    (STATUS[command],),
                    git=command in NEEDS_GIT,
                )
            )
    found.append(Attack("every kind spoiled at once", GROUP, all_spoiled, CHECK))
    found.append(Attack("installed command: every kind spoiled at once", GROUP, all_spoiled, CHECK, direct=True))
    return found


def all_spoiled(place: Place) -> None:
    for kind in KINDS:
        if not kind.setting:
            write(place.ws, {kind.path: SPOILED["of random bytes"](b"")})
