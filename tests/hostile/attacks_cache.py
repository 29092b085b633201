"""A cache that is damaged, of wrong types, read-only, someone else's, or used by many at once: an answer is never lost
nor wrong."""

from __future__ import annotations

import os
import sqlite3
import struct
import subprocess
import sys
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path

from .harness import COMMANDS, ENTRY, STATUS, Attack, Ended, Place, remove

GROUP = "cache"
CHECK = COMMANDS["check"]
DATABASES = ("facts", "distros", "providers")


def database(place: Place, name: str) -> Path:
    return next(iter(sorted(place.cache.glob(f"{name}*.sqlite"))), place.cache / f"{name}.sqlite")


def tables(path: Path) -> dict[str, list[str]]:
    with sqlite3.connect(path) as connection:
        names = [row[0] for row in connection.execute("select name from sqlite_master where type = 'table'")]
        return {name: [row[1] for row in connection.execute(f'pragma table_info("{name}")')] for name in names}


def rewritten(name: str, change: Callable[[object], object], only: str = "") -> Callable[[Place], None]:
    """All values of all tables (or one) that hold data, changed."""

    def before(place: Place) -> None:
        path = database(place, name)
        connection = sqlite3.connect(path)
        connection.text_factory = lambda data: data.decode("utf-8", "surrogateescape")
        connection.create_function("changed", 1, change)
        for table, columns in tables(path).items():
            if only and table != only:
                continue
            for column in columns:
                if column in (
                    "id",
                    "key",
                    "name",
                    "bit",
                    "path",
                    "distro",
                    "package",
                    "repository",
                    "ts",
                    "version",
                    "kind",
                ):
                    continue
                # Large values in tens of thousands of rows would fill the disk.
                large = len(_as_bytes(change(b"x"))) > 9_999
                some = f" where rowid in (select rowid from \"{table}\" limit 20)" if large else ""
                try:
                    connection.execute(f'update "{table}" set "{column}" = changed("{column}"){some}')
                except sqlite3.Error:
                    continue
        connection.commit()
        connection.close()

    return before


def _as_bytes(value: object) -> bytes:
    return value if isinstance(value, bytes) else str(value).encode("utf-8", "surrogateescape")


@cache
def _bomb() -> bytes:
    """1.5 GB of zeros as the cache packs a value: 150 times the same packed 10 MB, which takes a moment to make."""
    packer, size, count = zlib.compressobj(9, wbits=-15), 10_000_000, 150
    block = packer.compress(bytes(size)) + packer.flush(zlib.Z_FULL_FLUSH)
    check = struct.pack(">I", (size * count % 65521) << 16 | 1)  # Adler-32 of that many zeros
    return b"z\x78\xda" + block * count + packer.flush() + check


CHANGES: dict[str, Callable[[object], object]] = {
    "NULL": lambda value: None,
    "empty": lambda value: b"",
    "numbers": lambda value: 7,
    "text": lambda value: "evil",
    "no UTF-8": lambda value: b"\xff\xfe" * 20,
    "cut off": lambda value: _as_bytes(value)[: len(_as_bytes(value)) // 2],
    "a bit flipped": lambda value: _as_bytes(value)[:-1] + bytes([_as_bytes(value)[-1] ^ 1]) if value else value,
    "garbage that is packed": lambda value: b"z" + zlib.compress(b"\xff" * 3_000),
    "garbage that is not packed": lambda value: b"-" + b"\x91" * 300,
    "deeply nested": lambda value: b"-" + b"\x91" * 1_000_000,
    "pickled": lambda value: b"-cos\nsystem\n(S'touch {marker}'\ntR.",
}


def spoiled(name: str, change: Callable[[bytes], bytes]) -> Callable[[Place], None]:
    def before(place: Place) -> None:
        path = database(place, name)
        for extra in ("-wal", "-shm"):
            remove(Path(f"{path}{extra}"))
        data = path.read_bytes() if path.exists() else b""
        path.write_bytes(change(data))

    return before


def _flipped(data: bytes) -> bytes:
    changed = bytearray(data)
    for index in range(200, len(changed), 1009):
        changed[index] ^= 0xFF
    return bytes(changed)


FILES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda data: b"",
    "of text": lambda data: b"hello\n" * 1_000,
    "cut off": lambda data: data[: len(data) // 2],
    "cut in the header": lambda data: data[:50],
    "with bytes flipped": _flipped,
    "with a wrong header": lambda data: b"SQLite format 9\0" + data[16:],
    "of a page size of 0": lambda data: data[:16] + b"\0\0" + data[18:],
    "with its first page gone": lambda data: data[:100] + b"\0" * 4_000 + data[4_100:],
    "of a future version": lambda data: data[:60] + b"\xff\xff\xff\xff" + data[64:],
}


def statement(name: str, *statements: str) -> Callable[[Place], None]:
    def before(place: Place) -> None:
        connection = sqlite3.connect(database(place, name))
        for each in statements:
            for table in tables(database(place, name)) if "{table}" in each else ("",):
                connection.execute(each.replace("{table}", table))
        connection.commit()
        connection.close()

    return before


SCHEMAS = {
    "no table": ("drop table {table}",),
    "no row": ("delete from {table}",),
    "other columns": ("alter table {table} rename to old_{table}", "create table other(a, b)"),
    "a view that loops": (
        "create view evil as with recursive x(n) as (select 1 union all select n + 1 from x) select * from x",
    ),
    "a trigger": ("create table evil(a)", "insert into evil values (zeroblob(100000000))"),
    "a journal": ("pragma journal_mode = wal",),
}


def view_for_table(name: str, table: str) -> Callable[[Place], None]:
    """A table replaced by a view that never ends."""
    loop = (
        "with recursive x(n) as (select 1 union all select n + 1 from x) select n as id, n as key, n as used, "
        "n as data from x"
    )
    return statement(name, f"drop table if exists {table}", f"create view {table} as {loop}")


def locked(place: Place) -> None:
    """Someone else writes, and does not end."""
    script = (
        "import sqlite3, sys, time; c = sqlite3.connect(sys.argv[1]); c.execute('begin exclusive'); "
        "print('x', flush=True); time.sleep(40)"
    )
    process = subprocess.Popen([sys.executable, "-c", script, str(database(place, "facts"))], stdout=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.readline()
    place.locker = process  # pyright: ignore[reportAttributeAccessIssue]


def unlocked(place: Place, ended: Ended) -> list[str]:
    process = place.locker  # pyright: ignore[reportAttributeAccessIssue]
    process.kill()
    process.wait()
    process.stdout.close()
    return []


def a_file_in_the_way(place: Place) -> None:
    remove(place.cache)
    place.cache.write_text("x")


def a_folder_in_the_way(name: str) -> Callable[[Place], None]:
    def before(place: Place) -> None:
        path = database(place, name)
        remove(path)
        path.mkdir()
        (path / "x").write_text("x")

    return before


def link_outside(name: str) -> Callable[[Place], None]:
    def before(place: Place) -> None:
        path = database(place, name)
        remove(path)
        for extra in ("-wal", "-shm"):
            remove(Path(f"{path}{extra}"))
        path.symlink_to(place.outside / "secret.txt")

    return before


def many_at_once(place: Place, ended: Ended) -> list[str]:
    """Ten more runs at once, over a cache that is empty."""
    remove(place.cache)
    environment = {
        "PATH": os.environ["PATH"],
        "HOME": str(place.home),
        "ROSIMPACT_CACHE": str(place.cache),
        "LANG": "C.UTF-8",
    }
    interpreter = place.interpreter  # pyright: ignore[reportAttributeAccessIssue]
    command = [
        interpreter,
        "-c",
        ENTRY,
        "check",
        str(place.ws),
        "-q",
        "-t",
        "jazzy",
    ]
    running = [
        subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(10)
    ]
    answers = [(*process.communicate(timeout=300), process.returncode) for process in running]
    wrong = []
    for out, err, status in answers:
        text = (out + err).decode()
        if status != 1 or "asks for OpenCV 9" not in text or "Traceback" in text or "fault of rosimpact" in text:
            wrong.append(f"one of ten at once: status {status}: {text[-200:]!r}")
    return wrong[:1]


def once_more(place: Place, ended: Ended) -> list[str]:
    """A second run, over what the first one left: as good as the first, and it says nothing any longer."""
    environment = {
        "PATH": os.environ["PATH"],
        "HOME": str(place.home),
        "ROSIMPACT_CACHE": str(place.cache),
        "LANG": "C.UTF-8",
    }
    interpreter = place.interpreter  # pyright: ignore[reportAttributeAccessIssue]
    command = [
        interpreter,
        "-c",
        ENTRY,
        "check",
        str(place.ws),
        "-q",
        "-t",
        "jazzy",
    ]
    again = subprocess.run(command, env=environment, capture_output=True, timeout=120)
    if again.returncode != 1 or b"asks for OpenCV 9" not in again.stdout:
        return [f"a second run: status {again.returncode}: {again.stderr[-200:]!r}"]
    return []


def same_answer(place: Place, ended: Ended) -> list[str]:
    """The report is the one that an undamaged cache gives."""
    text = ended.out.decode("utf-8", "replace")
    missing = [
        word
        for word in ("asks for OpenCV 9", "tf2_geometry_msgs.h` is not available", "src/healthy/CMakeLists.txt:4")
        if word not in text
    ]
    return [f"another answer than usual: {missing[0]!r} is missing"] if missing else []


def rows() -> list[Attack]:
    found: list[Attack] = []
    for name in DATABASES:
        for label, change in CHANGES.items():
            for table in ("facts", "memo") if name == "facts" else ("",):
                found.append(
                    Attack(
                        f"{name} {table}: rows that are {label}".replace(" :", ":"),
                        GROUP,
                        {},
                        CHECK,
                        (1,),
                        before=rewritten(name, change, table),
                        after=same_answer,
                        snapshot=False,
                    )
                )
        for label, change in FILES.items():
            found.append(
                Attack(
                    f"{name}: a file {label}",
                    GROUP,
                    {},
                    CHECK,
                    (1,),
                    before=spoiled(name, change),
                    after=same_answer,
                    snapshot=False,
                )
            )
        for label, statements in SCHEMAS.items():
            if "other" in label:
                statements = statements[:1]
            found.append(
                Attack(
                    f"{name}: {label}",
                    GROUP,
                    {},
                    CHECK,
                    (1,),
                    before=statement(name, *statements),
                    after=same_answer,
                    snapshot=False,
                )
            )
        found.append(
            Attack(
                f"{name}: a folder in its place",
                GROUP,
                {},
                CHECK,
                (1,),
                before=a_folder_in_the_way(name),
                after=same_answer,
                snapshot=False,
            )
        )
        found.append(
            Attack(
                f"{name}: a link to a file outside",
                GROUP,
                {},
                CHECK,
                (1,),
                before=link_outside(name),
                after=same_answer,
            )
        )
    for table in ("facts", "memo"):
        found.append(
            Attack(
                f"facts: a view without end for {table}",
                GROUP,
                {},
                CHECK,
                (1,),
                before=view_for_table("facts", table),
                after=same_answer,
                snapshot=False,
            )
        )
        found.append(
            Attack(
                f"facts {table}: rows that inflate to 1.5 GB",
                GROUP,
                {},
                CHECK,
                (1,),
                before=rewritten("facts", lambda value: _bomb(), table),
                after=same_answer,
                snapshot=False,
            )
        )
    for command in ("graph", "upgrade", "why", "env"):
        for name in DATABASES:
            for label in ("no UTF-8", "cut off", "garbage that is packed"):
                found.append(
                    Attack(
                        f"{command}, {name}: rows that are {label}",
                        GROUP,
                        {},
                        COMMANDS[command],
                        (STATUS[command],),
                        before=rewritten(name, CHANGES[label]),
                        snapshot=False,
                    )
                )
    for command in ("impact", "logic"):
        for label in ("no UTF-8", "garbage that is packed", "a bit flipped"):
            found.append(
                Attack(
                    f"{command}, facts: rows that are {label}",
                    GROUP,
                    {},
                    COMMANDS[command],
                    (STATUS[command],),
                    git=True,
                    before=warmed(command, rewritten("facts", CHANGES[label])),
                    snapshot=False,
                )
            )
    found += [
        Attack(
            "a file where the cache should be",
            GROUP,
            {},
            CHECK,
            (1,),
            before=a_file_in_the_way,
            after=same_answer,
            snapshot=False,
        ),
        Attack(
            "no cache, and nowhere to make one",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "/proc/nowhere/cache"},
            after=same_answer,
            seconds=8,
        ),
        Attack(
            "a cache below a file",
            GROUP,
            {"x": ""},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "{ws}/x/cache"},
            after=same_answer,
            seconds=8,
        ),
        Attack(
            "a cache of no home",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "UNSET", "XDG_CACHE_HOME": "UNSET", "HOME": "/nowhere"},
            after=same_answer,
            seconds=8,
        ),
        Attack(
            "a cache of ~nobody",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "~nobody/x"},
            after=same_answer,
            seconds=8,
            snapshot=False,
        ),
        Attack(
            "a cache of ~unknown",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "{home}/~unknownuser/x"},
            after=same_answer,
            seconds=8,
        ),
        Attack(
            "a cache with a name of 5,000 letters",
            GROUP,
            {},
            CHECK,
            (1,),
            environment={"ROSIMPACT_CACHE": "{home}/" + "x" * 5_000},
            after=same_answer,
            seconds=8,
        ),
        Attack("a database that is locked", GROUP, {}, CHECK, (1,), before=locked, after=unlocked, snapshot=False),
        Attack("ten runs at once", GROUP, {}, CHECK, (1,), after=many_at_once, snapshot=False),
        Attack(
            "facts of garbage, twice",
            GROUP,
            {},
            CHECK,
            (1,),
            before=spoiled("facts", FILES["of text"]),
            after=once_more,
            snapshot=False,
        ),
        Attack(
            "distros of garbage, twice",
            GROUP,
            {},
            CHECK,
            (1,),
            before=spoiled("distros", FILES["with bytes flipped"]),
            after=once_more,
            snapshot=False,
        ),
        Attack(
            "installed command: rows that are no UTF-8",
            GROUP,
            {},
            CHECK,
            (1,),
            before=rewritten("facts", CHANGES["no UTF-8"]),
            after=same_answer,
            direct=True,
            snapshot=False,
        ),
    ]
    return found


def warmed(command: str, then: Callable[[Place], None]) -> Callable[[Place], None]:
    """Damages a cache that the same command has filled before."""

    def before(place: Place) -> None:
        environment = {
            "PATH": os.environ["PATH"],
            "HOME": str(place.home),
            "ROSIMPACT_CACHE": str(place.cache),
            "LANG": "C.UTF-8",
        }
        interpreter = place.interpreter  # pyright: ignore[reportAttributeAccessIssue]
        arguments = [place.filled(argument) for argument in COMMANDS[command]]
        subprocess.run(
            [interpreter, "-c", ENTRY, *arguments],
            env=environment,
            capture_output=True,
            timeout=120,
        )
        then(place)

    return before
