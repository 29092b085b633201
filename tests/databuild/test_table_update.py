"""`data update --from`: tables come into use whole and verified, or not at all; no answer of older ones is given."""

from __future__ import annotations

import functools
import http.server
import io
import json
import os
import shutil
import subprocess
import sys
import tarfile
import threading
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest
import zstandard
from rosimpact.databuild import table_manifest, table_source, table_update
from rosimpact.databuild.table_manifest import format_manifest, make_manifest, write_manifest
from rosimpact.databuild.table_update import reset_tables, update_tables
from rosimpact.edges.console import UserError
from rosimpact.impact.targets import tables
from rosimpact.impact.targets.tables import DATA, read_fetched, read_manifest

SHIPPED = read_manifest(DATA)
SMALL = {"behaviour.json": b'{"behaviour": []}', "parameters.json": b'{"renamed": []}'}


@pytest.fixture
def home(tmp_path, monkeypatch) -> Path:
    """Where updates are kept."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    monkeypatch.delenv("ROSIMPACT_DATA", raising=False)
    return tmp_path / "cache/updated"


@pytest.fixture
def untried(monkeypatch) -> None:
    """Leaves out the process that reads all tables."""
    monkeypatch.setattr(table_update, "_check_tables", lambda folder, source: None)


def publish(folder: Path, files: dict[str, bytes], **otherwise: object) -> Path:
    """A source that has these tables. otherwise: fields of its manifest."""
    folder.mkdir(exist_ok=True)
    for name, data in files.items():
        (folder / name).write_bytes(data)
    manifest = msgspec.to_builtins(make_manifest(folder, SHIPPED.date)) | otherwise
    (folder / "manifest.json").write_text(json.dumps(manifest))
    return folder


@pytest.fixture
def source(tmp_path) -> Path:
    return publish(tmp_path / "source", SMALL)


def list_kept(home: Path) -> list[str]:
    """What is kept of all updates."""
    return sorted(str(path.relative_to(home)) for path in home.rglob("*")) if home.exists() else []


# Sources


def test_a_folder_comes_into_use_whole(home, source):
    found = update_tables(str(source))
    assert (found.fetched, found.changed) == (tuple(SMALL), tuple(SMALL))
    fetched = read_fetched()
    assert fetched is not None and not fetched.unused and fetched.folder == found.folder
    assert {path.name for path in found.folder.iterdir()} == {"manifest.json", *SHIPPED.tables}
    for name in SHIPPED.tables:
        expected = SMALL.get(name) or (DATA / name).read_bytes()
        assert (found.folder / name).read_bytes() == expected, name
    assert make_manifest(found.folder, SHIPPED.date) == fetched.manifest


def pack_tar(compress: Callable[[bytes], bytes]) -> Callable[[Path, Path], None]:
    def pack(folder: Path, file: Path) -> None:
        packed = io.BytesIO()
        with tarfile.open(fileobj=packed, mode="w") as archive:
            archive.add(folder, "data")
        file.write_bytes(compress(packed.getvalue()))

    return pack


def pack_zip(folder: Path, file: Path) -> None:
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in folder.iterdir():
            archive.write(path, path.name)


def gzip_bytes(data: bytes) -> bytes:
    import gzip

    return gzip.compress(data)


ARCHIVES = {
    "data.tar.zst": pack_tar(lambda data: zstandard.ZstdCompressor().compress(data)),
    "data.tar.gz": pack_tar(gzip_bytes),
    "data.zip": pack_zip,
}


@pytest.mark.parametrize("name", ARCHIVES)
def test_archives_are_unpacked(home, source, tmp_path, untried, name):
    (source / "notes.txt").write_text("no table")
    ARCHIVES[name](source, tmp_path / name)
    found = update_tables(str(tmp_path / name))
    assert found.fetched == tuple(SMALL)
    assert (found.folder / "parameters.json").read_bytes() == SMALL["parameters.json"]
    assert sorted(path.name for path in home.iterdir()) == ["tables", found.folder.name]


@pytest.fixture
def serve() -> Iterator[Callable[[Path], tuple[str, list[str]]]]:
    """Serves a folder on this machine; gives its address, and the list to which each asked path is added."""
    running = []

    def start(folder: Path) -> tuple[str, list[str]]:
        asked: list[str] = []

        class Handler(http.server.SimpleHTTPRequestHandler):
            def do_GET(self) -> None:
                asked.append(self.path)
                if self.path == "/moved/manifest.json":
                    self.send_response(302)
                    self.send_header("Location", "/moved/manifest.json")
                    self.end_headers()
                elif self.path.startswith("/cut/") and self.path.endswith("parameters.json"):
                    self.send_response(200)
                    self.send_header("Content-Length", "15")
                    self.end_headers()
                    self.wfile.write(b'{"rena')
                else:
                    self.path = self.path.removeprefix("/cut")
                    super().do_GET()

            def log_message(self, format: str, *args: object) -> None:
                pass

        server = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Handler, directory=os.fspath(folder))
        )
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        running.append((server, thread))
        return f"http://127.0.0.1:{server.server_port}", asked

    yield start
    for server, thread in running:
        server.shutdown()
        server.server_close()
        thread.join()


def test_an_address_is_asked_for_what_is_not_here(home, source, serve, untried):
    for name in ("distros.yaml", "platforms.json"):
        shutil.copyfile(DATA / name, source / name)
    write_manifest(source)
    manifest = make_manifest(source, SHIPPED.date)
    (source / "manifest.json").write_bytes(format_manifest(manifest))
    address, asked = serve(source)
    assert update_tables(f"{address}/").fetched == tuple(SMALL)
    assert asked == ["/manifest.json", "/behaviour.json", "/parameters.json"]
    assert update_tables(address).fetched == ()
    assert asked[3:] == ["/manifest.json"]


def test_what_was_interrupted_goes_on_and_nothing_changes_before(home, source, serve, untried):
    first = update_tables(str(publish(source.parent / "first", {"platforms.json": b"{}"})))
    address, asked = serve(source)
    with pytest.raises(UserError, match=r"parameters.json: .*; run it again to go on"):
        update_tables(f"{address}/cut")
    fetched = read_fetched()
    assert fetched is not None and fetched.folder == first.folder and not fetched.unused
    assert not list(home.rglob("*.part"))
    asked.clear()
    second = update_tables(address)
    assert asked == ["/manifest.json", "/parameters.json"]
    fetched = read_fetched()
    assert fetched is not None and fetched.folder == second.folder != first.folder


def test_ctrl_c_leaves_the_data_in_use(home, source, untried, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(table_update, "_store", interrupt)
    with pytest.raises(KeyboardInterrupt):
        update_tables(str(source))
    assert read_fetched() is None


ADDRESSES = {
    "{address}/nowhere": "the server answers 404; check the address",
    "{address}/moved": "is redirected more than 5 times",
    "http://127.0.0.1:1": "cannot be reached",
    "{address}/?token=x": "without a name, password or query",
    "http://me:secret@127.0.0.1/": "without a name, password or query",
    "http://[": "without a name, password or query",
    "http://127.0.0.1:99999999/": "InvalidURL",
}


@pytest.mark.parametrize("address", ADDRESSES)
def test_addresses_that_do_not_answer_are_said(home, source, serve, address):
    with pytest.raises(UserError) as told:
        update_tables(address.format(address=serve(source)[0]))
    assert ADDRESSES[address] in str(told.value) and "secret" not in str(told.value)
    assert list_kept(home) == []


# What is wrong with a source

LINE = {"size": 1, "sha256": "0" * 64}
MANIFESTS = {
    "format": ({"format": 99}, "is of format 99; this version of rosimpact reads format 1; upgrade rosimpact, or take"),
    "unknown table": ({"tables": {"news.json": LINE}}, "`news.json` is no table of this version of rosimpact; upgrade"),
    "path": ({"tables": {"../../platforms.json": LINE}}, "`../../platforms.json` is no table"),
    "absolute path": ({"tables": {"/etc/passwd": LINE}}, "`/etc/passwd` is no table"),
    "itself": ({"tables": {"manifest.json": LINE}}, "`manifest.json` is no table"),
    "size": ({"tables": {"platforms.json": LINE | {"size": 1 << 40}}}, "Expected `int` <="),
    "negative size": ({"tables": {"platforms.json": LINE | {"size": -1}}}, "Expected `int` >="),
    "hash": ({"tables": {"platforms.json": LINE | {"sha256": "../x"}}}, "matching regex"),
    "nothing": ({"tables": {}}, "names no tables"),
    "past": ({"date": "2001-01-01"}, f"of 2001-01-01 are older than the shipped ones of {SHIPPED.date}"),
    "future": ({"date": "9999-01-01"}, "9999-01-01 is in the future"),
    "no date": ({"date": "2026-13-01"}, "month must be in 1..12"),
    "more": ({"further": 1}, "unknown field `further`"),
}


@pytest.mark.parametrize("fault", MANIFESTS)
def test_manifests_that_cannot_be_are_refused(home, source, fault):
    otherwise, said = MANIFESTS[fault]
    publish(source, {}, **otherwise)
    with pytest.raises(UserError) as told:
        update_tables(str(source))
    assert said in str(told.value)
    assert list_kept(home) == []


@pytest.mark.parametrize("text", [b"", b"[]", b"\xff", b"[" * 100_000, b" " * (2 << 20)])
def test_what_is_no_manifest_is_refused(home, source, text):
    (source / "manifest.json").write_bytes(text)
    with pytest.raises(UserError, match="name what `rosimpact data build` made"):
        update_tables(str(source))
    assert list_kept(home) == []


@pytest.mark.parametrize(
    ("data", "said"), [(b'{"renamed": [ ]}', "more"), (b"{}", "less"), (b'{"renamed": []]', "something else")]
)
def test_tables_that_the_manifest_does_not_tell_of_are_refused(home, source, data, said):
    (source / "parameters.json").write_bytes(data)
    with pytest.raises(UserError, match=f"`parameters.json`: holds {said} than manifest.json says"):
        update_tables(str(source))
    assert read_fetched() is None and not list(home.rglob("parameters.json"))


def link_table(source: Path) -> None:
    (source / "parameters.json").unlink()
    (source / "parameters.json").symlink_to("/etc/passwd")


def pipe_table(source: Path) -> None:
    (source / "parameters.json").unlink()
    os.mkfifo(source / "parameters.json")


@pytest.mark.parametrize("spoil", [link_table, pipe_table], ids=lambda spoil: spoil.__name__)
def test_only_regular_files_of_a_folder_are_read(home, source, spoil):
    spoil(source)
    with pytest.raises(OSError):
        update_tables(str(source))
    assert read_fetched() is None


def test_what_is_no_source_is_said(home, tmp_path):
    (tmp_path / "data.rar").touch()
    for name, said in {"nowhere": "not there", "data.rar": "neither a folder nor an archive"}.items():
        with pytest.raises(UserError, match=said):
            update_tables(str(tmp_path / name))
    (tmp_path / "empty").mkdir()
    with pytest.raises(UserError, match=r"has no manifest\.json"):
        update_tables(str(tmp_path / "empty"))


def add_link(archive: tarfile.TarFile) -> None:
    link = tarfile.TarInfo("data/parameters.json")
    link.type, link.linkname = tarfile.SYMTYPE, "/etc/passwd"
    archive.addfile(link)


def add_twice(archive: tarfile.TarFile) -> None:
    for _ in range(2):
        archive.addfile(tarfile.TarInfo("data/parameters.json"))


def add_outside(archive: tarfile.TarFile) -> None:
    for name in ("../../escaped.json", "/tmp/escaped.json", "data/deeper/still/manifest.json"):
        archive.addfile(tarfile.TarInfo(name))


def add_large(archive: tarfile.TarFile) -> None:
    member = tarfile.TarInfo("data/parameters.json")
    member.size = 3 << 20
    archive.addfile(member, io.BytesIO(bytes(member.size)))


HOSTILE = {
    "a link": (add_link, "`parameters.json` is no regular file"),
    "a name twice": (add_twice, "`parameters.json` is there twice"),
    "names outside": (add_outside, r"has no manifest\.json"),
    "a large table": (add_large, "unpacks to more than 2 MB"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_archives_are_refused(home, tmp_path, monkeypatch, name):
    monkeypatch.setattr(table_source, "LARGEST", 2 << 20)
    add, said = HOSTILE[name]
    with tarfile.open(tmp_path / "data.tar.gz", "w:gz") as archive:
        add(archive)
    with pytest.raises(UserError, match=said):
        update_tables(str(tmp_path / "data.tar.gz"))
    assert list_kept(home) == []


@pytest.mark.parametrize("name", ["data.tar.gz", "data.tar.zst"])
def test_what_unpacks_to_too_much_is_refused(home, tmp_path, monkeypatch, name):
    monkeypatch.setattr(table_source, "_LARGEST_ARCHIVE", 1 << 20)
    bomb = bytes(64 << 20)
    packed = gzip_bytes(bomb) if name.endswith("gz") else zstandard.ZstdCompressor().compress(bomb)
    assert len(packed) < 1 << 20
    (tmp_path / name).write_bytes(packed)
    with pytest.raises(UserError, match="unpacks to more than 1 MB"):
        update_tables(str(tmp_path / name))
    assert list_kept(home) == []


def test_a_zip_that_holds_a_link_or_a_bomb_is_refused(home, tmp_path, monkeypatch):
    monkeypatch.setattr(table_source, "LARGEST", 2 << 20)
    for member, data, said in (
        (zipfile.ZipInfo("manifest.json"), b"/etc/passwd", "is no regular file"),
        (zipfile.ZipInfo("parameters.json"), bytes(3 << 20), "unpacks to more than 2 MB"),
    ):
        member.external_attr = (0o120777 if said == "is no regular file" else 0o100644) << 16
        member.compress_type = zipfile.ZIP_DEFLATED
        with zipfile.ZipFile(tmp_path / "data.zip", "w") as archive:
            archive.writestr(member, data)
        with pytest.raises(UserError, match=said):
            update_tables(str(tmp_path / "data.zip"))
    assert list_kept(home) == []


@pytest.mark.parametrize("name", ARCHIVES)
@pytest.mark.parametrize("data", [b"", b"no archive at all", None], ids=["empty", "garbage", "cut"])
def test_damaged_archives_are_refused(home, source, tmp_path, name, data):
    ARCHIVES[name](source, tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: len(whole) // 3] if data is None else data)
    with pytest.raises(UserError, match=f"{name}: cannot be unpacked|has no manifest.json"):
        update_tables(str(tmp_path / name))
    assert list_kept(home) == []


@pytest.mark.parametrize(
    ("name", "data"),
    [("parameters.json", b'{"renames": []}'), ("platforms.json", b"{}"), ("snapshot.json", b"{}"),
     ("surfaces.sqlite", b"no database"), ("fields.json.zst", zstandard.ZstdCompressor().compress(b"[]"))],
)  # fmt: skip
def test_tables_that_a_check_cannot_read_never_come_into_use(home, tmp_path, name, data):
    with pytest.raises(UserError, match=f"cannot be used: .*{name}.*; get it from another source"):
        update_tables(str(publish(tmp_path / "source", {name: data})))
    assert read_fetched() is None


def test_every_table_is_read_before_it_comes_into_use(tmp_path):
    code = (
        "import sys; seen = set()\n"
        "opens = ('open', 'sqlite3.connect')\n"
        "sys.addaudithook(lambda event, given: seen.add(str(given[0])) if event in opens else None)\n"
        "from rosimpact.databuild.table_trial import read_tables\n"
        "from rosimpact.impact.targets.tables import DATA, MANIFEST\n"
        "read_tables()\n"
        "names = {path.name for path in DATA.iterdir()} - {MANIFEST}\n"
        "print(sorted(name for name in names if not any(name in path for path in seen)))\n"
    )
    environment = {**os.environ, "ROSIMPACT_CACHE": str(tmp_path), "ROSIMPACT_DATA": ""}
    said = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert said.stdout == "[]\n"


# What is in use


def test_the_newer_tables_win(home, source, untried, tmp_path, monkeypatch):
    update_tables(str(source))
    upgraded = tmp_path / "upgraded"
    upgraded.mkdir()
    monkeypatch.setattr(tables, "DATA", upgraded)
    for date, unused in ((SHIPPED.date, ""), ("2999-01-01", "the shipped tables of 2999-01-01 are newer")):
        (upgraded / "manifest.json").write_bytes(format_manifest(msgspec.structs.replace(SHIPPED, date=date)))
        fetched = read_fetched()
        assert fetched is not None and fetched.unused == unused


def damage_table(folder: Path) -> None:
    (folder / "apt.json.zst").write_bytes(b"")


def lose_table(folder: Path) -> None:
    (folder / "surfaces.sqlite").unlink()


def change_format(folder: Path) -> None:
    (folder / "manifest.json").write_text('{"format": 0}')


def lose_manifest(folder: Path) -> None:
    (folder / "manifest.json").unlink()


def garble_pointer(folder: Path) -> None:
    (folder.parent / "tables").write_text("../..")


def lose_all(folder: Path) -> None:
    shutil.rmtree(folder)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [(damage_table, "apt.json.zst is missing or damaged"), (lose_table, "surfaces.sqlite is missing or damaged"),
     (change_format, "is of format 0"), (lose_manifest, "No such file"), (garble_pointer, "names no folder of tables"),
     (lose_all, "No such file")],
)  # fmt: skip
def test_what_is_not_whole_is_passed_over(home, source, untried, spoil, said):
    spoil(update_tables(str(source)).folder)
    fetched = read_fetched()
    assert fetched is not None and said in fetched.unused


def test_old_tables_are_removed_when_nobody_can_use_them(home, tmp_path, untried):
    folders = []
    for number in range(3):
        found = update_tables(str(publish(tmp_path / "source", {"parameters.json": b" " * number + b"{}"})))
        folders.append(found.folder)
        os.utime(found.folder, (0, 0))
    assert [folder.exists() for folder in folders] == [False, True, True]


def test_going_back_removes_all(home, source, untried):
    assert reset_tables() is False
    update_tables(str(source))
    assert reset_tables() is True
    assert not home.exists() and read_fetched() is None


def test_with_another_data_folder_nothing_is_updated(home, source, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_DATA", str(DATA))
    with pytest.raises(UserError, match="ROSIMPACT_DATA names the data in use; unset it"):
        update_tables(str(source))


# The command

WORKSPACE = {
    "package.xml": """<package format="3"><name>winch</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<depend>rclcpp</depend><export><build_type>ament_cmake</build_type></export></package>
""",
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(winch)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
add_executable(winch src/winch.cpp)
target_link_libraries(winch rclcpp::rclcpp)
ament_package()
""",
    "src/winch.cpp": """#include <rclcpp/rclcpp.hpp>
int main() { rclcpp::executors::MultiThreadedExecutor executor; executor.spin(); }
""",
}


@pytest.fixture
def rosimpact(tmp_path) -> Callable[..., str]:
    """Runs the command in a process of its own, which remembers nothing but what is in the cache folder."""
    environment = {**os.environ, "ROSIMPACT_CACHE": str(tmp_path / "cache"), "NO_COLOR": "1"}
    environment.pop("ROSIMPACT_DATA", None)

    def run(*arguments: object, status: int = 0) -> str:
        said = subprocess.run(
            [sys.executable, "-m", "rosimpact.impact.cli", *map(str, arguments)],
            env=environment, cwd=tmp_path, capture_output=True, text=True,
        )  # fmt: skip
        assert said.returncode == status, said.stderr
        return said.stdout + said.stderr

    return run


def test_a_check_after_an_update_says_nothing_of_before(rosimpact, source, tmp_path):
    for path, text in WORKSPACE.items():
        (tmp_path / "ws" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "ws" / path).write_text(text)

    def check() -> bool:
        said = rosimpact("check", tmp_path / "ws", "--target", "jazzy", "--format", "json")
        return "behaves differently since rclcpp 17.1.0" in said

    assert [check(), check()] == [True, True]
    said = rosimpact("data", "update", "--from", source)
    assert "2 fetched, 2 not as shipped: behaviour.json, parameters.json" in said
    assert [check(), check()] == [False, False]
    said = rosimpact("data", "status")
    assert f"tables of {SHIPPED.date}, updated: behaviour.json, parameters.json" in said
    assert json.loads(rosimpact("data", "status", "--format", "json"))["tables"] == {
        "date": SHIPPED.date, "updated": ["behaviour.json", "parameters.json"], "unused": "",
    }  # fmt: skip
    assert "back to the shipped data" in rosimpact("data", "update", "--shipped")
    assert check()
    assert f"tables of {SHIPPED.date}, as shipped with rosimpact\n" in rosimpact("data", "status")


def test_going_back_works_whatever_became_of_the_tables(rosimpact, source, tmp_path, home, untried):
    found = update_tables(str(source))
    for name in ("snapshot.json", "platforms.json"):
        (found.folder / name).write_bytes(b"x" * (found.folder / name).stat().st_size)
    said = rosimpact("data", "status", status=2)
    assert "snapshot.json" in said and "run `rosimpact data update --shipped`" in said
    rosimpact("data", "update", "--shipped")
    rosimpact("data", "status")


def test_options_that_exclude_each_other_are_said(rosimpact, source):
    said = rosimpact("data", "update", "--from", source, "--shipped", status=2)
    assert "--shipped: has no effect with --from" in said


# Manifests


def test_the_date_stays_while_no_table_changes(tmp_path):
    folder = publish(tmp_path / "data", SMALL, date="2020-01-01")
    before = (folder / "manifest.json").read_bytes()
    assert write_manifest(folder).date == "2020-01-01"
    assert (folder / "manifest.json").read_bytes() == before
    (folder / "parameters.json").write_bytes(b"{}")
    assert write_manifest(folder).date > "2020-01-01"
    assert read_manifest(folder).tables["parameters.json"].size == 2


def test_what_is_no_table_is_not_listed(tmp_path):
    folder = publish(tmp_path / "data", {**SMALL, "notes.txt": b""})
    assert set(table_manifest.make_manifest(folder, SHIPPED.date).tables) == set(SMALL)
