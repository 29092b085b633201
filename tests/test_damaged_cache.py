"""A check on a cache that is damaged, full, of nobody or used by many: the same answer as without one."""

from __future__ import annotations

import json
import os
import random
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = '#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n#include "rclcpp/rclcpp.hpp"\nint main() { return 0; }\n'
MANIFEST = """\
<package format="3"><name>a</name><version>1.0.0</version><description>a</description>
<maintainer email="a@example.org">A</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<depend>rclcpp</depend><export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(a)\nfind_package(rclcpp)\nadd_executable(a a.cpp)\n"
PROGRAM = "from rosimpact.impact.cli.app import main; main()"


def answered(out: str) -> tuple[dict, list[str]]:
    """(the report without notes on the cache, those notes)."""
    report = json.loads(out)
    notes = [note for target in report["targets"] for note in target.get("notes", ())]
    for target in report["targets"]:
        target["notes"] = [note for note in target.get("notes", ()) if "the cache" not in note]
    return report, [note for note in notes if "the cache" in note]


@pytest.fixture(scope="module")
def workspace(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("ws") / "a"
    folder.mkdir()
    for name, text in (("package.xml", MANIFEST), ("CMakeLists.txt", CMAKE), ("a.cpp", SOURCE)):
        (folder / name).write_text(text)
    return folder


def begin(workspace: Path, cache: Path, **more) -> subprocess.Popen:
    environment = {**os.environ, "ROSIMPACT_CACHE": str(cache)}
    command = [sys.executable, "-P", "-c", PROGRAM] if sys.version_info >= (3, 11) else [sys.executable, "-c", PROGRAM]
    command += ["check", str(workspace), "--target", "jazzy", "--format", "json"]
    return subprocess.Popen(command, env=environment, stdout=-1, stderr=-1, text=True, **more)


@pytest.fixture(scope="module")
def filled(workspace, tmp_path_factory) -> tuple[Path, int, dict]:
    """A cache, the exit status and the report that were given when it was filled."""
    cache = tmp_path_factory.mktemp("filled")
    process = begin(workspace, cache)
    out, err = process.communicate(timeout=100)
    report, notes = answered(out)
    assert (process.returncode, err, notes) == (1, "", []) and report["findings"]
    return cache, process.returncode, report


def test_any_change_of_any_file_gives_the_same_answer(workspace, filled, say, tmp_path, monkeypatch):
    """In this process, which is many times faster than one for each change; every fourth change meets processes that
    are forked."""
    from rosimpact.edges import processes
    from rosimpact.impact.targets import snapshot
    from rosimpact.impact.targets.providers import providers

    cache, status, expected = filled
    chance = random.Random(15)
    names = sorted(path.name for path in cache.iterdir())
    may_fork = processes.may_fork
    for turn in range(40):
        monkeypatch.setattr(processes, "may_fork", may_fork if turn % 4 == 0 else lambda: False)
        damaged = tmp_path / f"{turn}"
        shutil.copytree(cache, damaged)
        file = damaged / ("facts.sqlite" if turn % 2 else chance.choice(names))
        data = bytearray(file.read_bytes())
        for _ in range((1, 10, 1000)[turn % 3]):
            data[chance.randrange(100 if turn % 8 == 0 else len(data)) % len(data)] = chance.randrange(256)
        if turn % 10 == 0:
            del data[chance.randrange(len(data)) :]
        file.write_bytes(data)
        monkeypatch.setenv("ROSIMPACT_CACHE", str(damaged))
        monkeypatch.setattr(snapshot, "_default", None)
        monkeypatch.setattr(providers, "_default", None)
        said = say("check", workspace, "--target", "jazzy", "--format", "json")
        report, notes = answered(said.out)
        assert (said.status, said.err, report) == (status, "", expected), (turn, file.name)
        assert len(notes) <= 1
        shutil.rmtree(damaged)


def replaced(folder: Path, make) -> None:
    for file in list(folder.iterdir()):
        file.unlink()
        make(file)


PLACES = {
    "a named pipe": lambda folder: replaced(folder, os.mkfifo),
    "folders": lambda folder: replaced(folder, os.mkdir),
    "links to a device": lambda folder: replaced(folder, lambda path: path.symlink_to("/dev/zero")),
    "empty files": lambda folder: replaced(folder, lambda path: path.write_bytes(b"")),
    "bytes": lambda folder: replaced(folder, lambda path: path.write_bytes(os.urandom(9999))),
    "a file": lambda folder: (shutil.rmtree(folder), folder.write_text("")),
    "a pipe": lambda folder: (shutil.rmtree(folder), os.mkfifo(folder)),
    "a device": lambda folder: (shutil.rmtree(folder), folder.symlink_to("/dev/full")),
}


@pytest.mark.parametrize("change", PLACES.values(), ids=PLACES)
def test_whatever_lies_where_the_cache_is(workspace, filled, tmp_path, change):
    cache, status, expected = filled
    shutil.copytree(cache, tmp_path / "c")
    change(tmp_path / "c")
    process = begin(workspace, tmp_path / "c")
    out, err = process.communicate(timeout=60)
    report, notes = answered(out)
    assert (process.returncode, err, report) == (status, "", expected)
    assert len(notes) <= 1


def test_a_disk_that_is_full(workspace, filled, tmp_path):
    _, status, expected = filled
    process = begin(
        workspace, tmp_path / "c", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, 9_000))
    )
    out, err = process.communicate(timeout=60)
    report, notes = answered(out)
    assert (process.returncode, err, report) == (status, "", expected)
    assert len(notes) == 1 and "cannot be" in notes[0]


def test_ten_runs_at_once(workspace, filled, tmp_path):
    cache, status, expected = filled
    damaged = tmp_path / "damaged"
    shutil.copytree(cache, damaged)
    for file in damaged.iterdir():
        data = bytearray(file.read_bytes())
        data[len(data) // 3 : len(data) // 2] = os.urandom(len(data) // 2 - len(data) // 3)
        file.write_bytes(data)
    processes = [begin(workspace, folder) for folder in (tmp_path / "empty", damaged) for _ in range(5)]
    for process in processes:
        out, err = process.communicate(timeout=200)
        report, notes = answered(out)
        assert (process.returncode, err, report) == (status, "", expected)
        assert len(notes) <= 1
