"""The unpacked snapshot in the cache: made once, remade when broken, done without where nothing can be written."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
import yaml
from rosimpact.impact.cache import cache_folder
from rosimpact.impact.targets import snapshot as snapshots
from rosimpact.impact.targets import unpacked
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.snapshot import Snapshot, SnapshotError
from rosimpact.impact.targets.tables import DATA


def answers(snapshot):
    return DistroTarget("humble", "2024-03-01", data=snapshot).find_version("rclcpp") == "16.0.8"


def test_it_is_unpacked_once(tmp_path):
    first = Snapshot(cache=tmp_path)
    assert answers(first)
    made, sum = sorted(tmp_path.iterdir())
    assert sum.name == f"{made.name}.sum"
    stamp = made.stat().st_mtime_ns
    assert answers(Snapshot(cache=tmp_path))
    assert sorted(tmp_path.iterdir()) == [made, sum]
    assert made.stat().st_mtime_ns == stamp


@pytest.mark.parametrize("damage", ["empty", "half", "text", "folder", "emptied-table"])
def test_a_broken_file_is_made_again(tmp_path, damage):
    snapshot = Snapshot(cache=tmp_path)
    assert answers(snapshot)
    path = snapshot.get_path()
    whole = path.read_bytes()
    if damage == "empty":
        path.write_bytes(b"")
    elif damage == "half":
        path.write_bytes(whole[: len(whole) // 2])
    elif damage == "text":
        path.write_bytes(b"no database " * 1000)
    elif damage == "folder":
        path.unlink()
        path.mkdir()
    else:
        path.write_bytes(whole[:4096] + os.urandom(len(whole) - 4096))
    assert answers(Snapshot(cache=tmp_path))


def test_a_changed_byte_is_noticed_whatever_it_says(tmp_path):
    """SQLite notices damage of its tables, and none of what they hold."""
    snapshot = Snapshot(cache=tmp_path)
    assert answers(snapshot)
    path = snapshot.get_path()
    whole = path.read_bytes()
    changed = whole.replace(b"16.0.8", b"16.0.9")
    assert changed != whole
    for _ in range(2):
        path.write_bytes(changed)
        assert answers(Snapshot(cache=tmp_path))
        assert path.read_bytes() == whole


def test_times_that_changed_cost_a_look_and_nothing_else(tmp_path):
    snapshot = Snapshot(cache=tmp_path)
    assert answers(snapshot)
    path = snapshot.get_path()
    inode = path.stat().st_ino
    os.utime(path, (1_000_000_000, 1_000_000_000))
    assert answers(Snapshot(cache=tmp_path))
    assert path.stat().st_ino == inode
    assert str(path.stat().st_mtime_ns) in Path(f"{path}.sum").read_text()


SUMS = {
    "nothing": Path.unlink,
    "empty": lambda path: path.write_bytes(b""),
    "bytes": lambda path: path.write_bytes(bytes(range(256))),
    "another file's": lambda path: path.write_text("0" * 32 + path.read_text()[32:]),
    "much": lambda path: path.write_bytes(b"0" * 10_000_000),
    "a named pipe": lambda path: (path.unlink(), os.mkfifo(path)),
    "a folder": lambda path: (path.unlink(), path.mkdir()),
    "a link": lambda path: (path.unlink(), path.symlink_to("/dev/zero")),
}


@pytest.mark.parametrize("damage", SUMS.values(), ids=SUMS)
def test_whatever_lies_where_the_sum_is_kept(tmp_path, damage):
    snapshot = Snapshot(cache=tmp_path)
    assert answers(snapshot)
    damage(Path(f"{snapshot.get_path()}.sum"))
    assert answers(Snapshot(cache=tmp_path))
    assert answers(Snapshot(cache=tmp_path))


@pytest.mark.parametrize("make", [os.mkfifo, lambda path: path.symlink_to("/dev/zero"), os.mkdir])
def test_what_is_no_file_in_place_of_the_data(tmp_path, make):
    make(Snapshot(cache=tmp_path).get_path())
    assert answers(Snapshot(cache=tmp_path))


def test_a_file_that_breaks_while_it_is_read(tmp_path):
    snapshot = Snapshot(cache=tmp_path)
    assert answers(snapshot)
    path = snapshot.get_path()
    with open(path, "r+b") as file:
        file.seek(4096)
        file.write(os.urandom(path.stat().st_size - 4096))
    snapshot.fetch("PRAGMA shrink_memory")
    assert {answers(snapshot), len(snapshot.fetch("SELECT * FROM release")) > 1000} == {True}


def test_a_bomb_in_place_of_an_update(tmp_path, monkeypatch):
    import zstandard

    monkeypatch.setattr(unpacked, "_UNPACKED_BYTES", 1 << 20)
    bomb = zstandard.ZstdCompressor(level=19).compress(bytes(2 << 20))
    (tmp_path / "x.zst").write_bytes(bomb)
    with pytest.raises(SnapshotError, match="claims to hold too much"):
        unpacked.decompress(tmp_path / "x.zst", "", "x.json")


def test_files_of_other_data_and_of_killed_runs_are_removed(tmp_path):
    for name in ("distros-1-old-old.sqlite", "distros-1-old-old.sqlite.sum"):
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "somebody-elses.sqlite").write_bytes(b"")
    for name, age in ((".distros-killed.part", 7200), (".distros-at-work.part", 10)):
        (tmp_path / name).write_bytes(b"")
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    assert answers(Snapshot(cache=tmp_path))
    names = {path.name for path in tmp_path.iterdir()}
    assert {"somebody-elses.sqlite", ".distros-at-work.part"} < names
    assert not names & {"distros-1-old-old.sqlite", "distros-1-old-old.sqlite.sum", ".distros-killed.part"}


def test_without_a_writable_folder_it_lives_in_memory(tmp_path):
    (tmp_path / "file").write_text("a file where a folder is wanted")
    assert answers(Snapshot(cache=tmp_path / "file"))


def test_without_deserialize_it_lives_in_memory_too(tmp_path, monkeypatch):
    """Python 3.10's sqlite3 cannot open bytes."""
    monkeypatch.setattr(unpacked, "_find_deserializer", lambda connection: None)
    (tmp_path / "file").write_text("a file where a folder is wanted")
    assert answers(Snapshot(cache=tmp_path / "file"))


def test_the_environment_chooses_the_folder(tmp_path):
    assert cache_folder({"ROSIMPACT_CACHE": str(tmp_path)}) == tmp_path
    assert cache_folder({}).name == "rosimpact"


@pytest.mark.parametrize("name", ["distros.sqlite.zst", "snapshot.json", "platform_versions.yaml"])
def test_broken_shipped_data_is_named(tmp_path, name):
    for file in ("distros.sqlite.zst", "snapshot.json", "platform_versions.yaml", "distros.yaml"):
        (tmp_path / file).write_bytes((DATA / file).read_bytes())
    (tmp_path / name).unlink()
    with pytest.raises(SnapshotError, match=name.replace(".", r"\.")):
        answers(Snapshot(tmp_path, tmp_path / "cache", tmp_path))
    if name == "distros.sqlite.zst":
        (tmp_path / name).write_bytes(b"\x28\xb5\x2f\xfd broken")
        with pytest.raises(SnapshotError, match="install rosimpact again"):
            answers(Snapshot(tmp_path, tmp_path / "cache", tmp_path))


def test_two_runs_at_once_both_answer(tmp_path):
    code = (
        "from rosimpact.impact.targets.distro.distro import DistroTarget;"
        "print(DistroTarget('jazzy').find_version('rclcpp'))"
    )
    environment = {**os.environ, "ROSIMPACT_CACHE": str(tmp_path)}
    runs = [
        subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(4)
    ]
    said = {run.communicate()[0].strip() for run in runs}
    assert all(run.returncode == 0 for run in runs)
    assert said == {DistroTarget("jazzy").find_version("rclcpp")}
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [".sqlite", ".sum"]


def test_what_an_update_made_is_used_while_it_is_newer_and_whole(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path))
    updated = tmp_path / "updated"
    updated.mkdir()
    info = json.loads((DATA / "snapshot.json").read_text())

    def write(date):
        (updated / "snapshot.json").write_text(json.dumps({**info, "date": date}))

    write("2199-01-01")
    assert snapshots._find_newest_folder() == DATA  # its database is missing
    (updated / "distros.sqlite.zst").write_bytes((DATA / "distros.sqlite.zst").read_bytes())
    assert snapshots._find_newest_folder() == updated
    assert answers(Snapshot(updated))
    write("2001-01-01")
    assert snapshots._find_newest_folder() == DATA
    for text in ("{", "[" * 100_000, json.dumps({**info, "date": "tomorrow"}), json.dumps({**info, "sha256": "../x"})):
        (updated / "snapshot.json").write_text(text)
        assert snapshots._find_newest_folder() == DATA
    (updated / "snapshot.json").unlink()
    os.mkfifo(updated / "snapshot.json")
    assert snapshots._find_newest_folder() == DATA


def test_a_broken_update_is_passed_over(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path))
    updated = tmp_path / "updated"
    updated.mkdir()
    (updated / "snapshot.json").write_bytes((DATA / "snapshot.json").read_bytes().replace(b"20", b"21", 1))
    (updated / "distros.sqlite.zst").write_bytes(b"broken")
    found = Snapshot(updated)
    assert answers(found)
    assert found.data == DATA


# The reviewed fact files


def platform_cells():
    table = yaml.safe_load((DATA / "platform_versions.yaml").read_text())
    return table["sources"], [
        (platform, name, cell) for platform, cells in table["platforms"].items() for name, cell in cells.items()
    ]


def test_every_library_cell_is_a_version_with_a_source():
    sources, cells = platform_cells()
    for platform, name, cell in cells:
        assert set(cell) <= {"version", "source", "note"}, (platform, name)
        assert isinstance(cell["version"], str), (platform, name)
        assert cell["version"][0].isdigit() or cell["version"].startswith(("gnu++", "r")), (platform, name)
        assert cell["source"] in sources, (platform, name)
    assert {cell["source"] for _, _, cell in cells} == set(sources)


def test_every_distro_has_its_facts():
    facts = yaml.safe_load((DATA / "distros.yaml").read_text())["distros"]
    names = {name for (name,) in Snapshot().fetch("SELECT name FROM distro")}
    assert set(facts) == names
    for name, fact in facts.items():
        assert fact["end_of_life"] is None or fact["released"] < fact["end_of_life"], name


def test_the_shipped_files_are_small():
    sizes = [path.stat().st_size for path in Path(DATA).iterdir() if path.name.startswith(("distros", "platform"))]
    assert sum(sizes) < 2_000_000
