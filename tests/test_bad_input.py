"""Malformed and hostile input: each is named, with what to do, nothing else is lost, and no traceback is seen.

Every case stands beside a healthy package with one known finding, which has to be found all the same.
"""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple, TypeAlias

import pygit2
import pytest
from rosimpact.impact.targets import snapshot, tables
from rosimpact.impact.targets.providers import providers

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>{depend}</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(bad)\nfind_package(ament_cmake REQUIRED)\nament_package()\n"
# OpenCV 9 is on no target, so this package has one error wherever it is checked.
HEALTHY = {
    "src/healthy/package.xml": MANIFEST.format(name="healthy", depend="libopencv-dev"),
    "src/healthy/CMakeLists.txt": CMAKE.replace("bad", "healthy").replace(
        "ament_package", "find_package(OpenCV 9 REQUIRED)\nament_package"
    ),
}
FOUND = "error[library-version]"
Content: TypeAlias = "str | bytes | Callable[[], bytes]"
BAD = {"src/bad/package.xml": MANIFEST.format(name="bad", depend="rclcpp"), "src/bad/CMakeLists.txt": CMAKE}
BOMB = "<!DOCTYPE x [<!ENTITY a '" + "A" * 1000 + "'>" + "".join(
    f"<!ENTITY {chr(98 + n)} '{f'&{chr(97 + n)};' * 10}'>" for n in range(9)
) + "]>"  # fmt: skip


def write(root: Path, files: Mapping[str, Content]) -> Path:
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        content = content() if callable(content) else content
        path.write_bytes(content.encode("utf-8", "surrogateescape") if isinstance(content, str) else content)
    return root


@pytest.fixture
def ws(tmp_path) -> Path:
    return write(tmp_path / "ws", HEALTHY | BAD)


def clean(said) -> None:
    """What holds for every answer, whatever was asked."""
    assert "Traceback" not in said.text
    assert "this is a fault of rosimpact" not in said.text


def is_named(said, words: tuple[str, ...]) -> None:
    for word in words:
        assert word in said.text


# -- files of a package ------------------------------------------------------------------------------------------------


class Bad(NamedTuple):
    """name; files that go over the package `bad`; words that the report has to hold."""

    name: str
    files: Mapping[str, Content]
    words: tuple[str, ...] = ()


def manifest(name: str, content: str | bytes, *words: str) -> Bad:
    return Bad(f"manifest {name}", {"src/bad/package.xml": content}, ("src/bad/package.xml", *words))


def cmake(name: str, content: str | bytes, *words: str) -> Bad:
    return Bad(
        f"CMake {name}", {"src/bad/CMakeLists.txt": content}, ("src/bad/CMakeLists.txt", *words) if words else ()
    )


def named(path: str, content: str | bytes, name: str, *words: str) -> Bad:
    return Bad(name, {f"src/bad/{path}": content}, (f"src/bad/{path}", *words) if words else ())


GOOD = MANIFEST.format(name="bad", depend="rclcpp")
FILES = [
    manifest("empty", "", "not well-formed"),
    manifest("truncated", GOOD[:200]),
    manifest("entity bomb", BOMB + GOOD.split("?>")[1].replace("<description>d", "<description>&j;")),
    manifest(
        "external entity",
        "<!DOCTYPE x [<!ENTITY e SYSTEM 'file:///etc/passwd'>]>" + GOOD.split("?>")[1].replace(">d<", ">&e;<"),
    ),
    manifest("of null bytes", b"\0" * 500),
    manifest("with a null byte", GOOD.replace("Apache", "A\0")),
    manifest("in Latin-1 that says UTF-8", GOOD.replace(">a<", ">M\xfcller<").encode("latin-1")),
    manifest("without a name", GOOD.replace("<name>bad</name>", ""), "name"),
    manifest("with an empty name", GOOD.replace("<name>bad</name>", "<name/>"), "name"),
    manifest("named with spaces", GOOD.replace("<name>bad</name>", "<name>my bad one</name>"), "my bad one"),
    manifest("with two names", GOOD.replace("<name>bad</name>", "<name>bad</name><name>worse</name>"), "name"),
    manifest("that is a web page", "<!doctype html><html><body><p>404<br></body></html>"),
    manifest("with another root", "<robot name='r'/>"),
    manifest("nested deeply", "<package format='3'>" + "<a>" * 100_000),
    manifest("of an unknown format", GOOD.replace('format="3"', 'format="9"'), "format"),
    manifest("with a wrong version", GOOD.replace("1.0.0", "one"), "version"),
    manifest("with a broken condition", GOOD.replace("<depend>", '<depend condition="$ROS_VERSION == (">')),
    manifest("cut in a character", GOOD.encode()[:120] + "\u20ac".encode()[:2]),
    manifest("that is two documents", GOOD + GOOD.split("?>")[1]),
    cmake("open parenthesis", CMAKE + "add_library(x a.cpp\n", "add_library() is never closed"),
    cmake("open quote", CMAKE + 'set(X "abc\n'),
    cmake("open bracket", CMAKE + "set(X [==[abc\n"),
    cmake("open bracket comment", CMAKE + "#[[ abc\n"),
    cmake("stray closing parenthesis", CMAKE + ")))\n", "CMakeLists.txt"),
    cmake("100,000 parentheses", CMAKE + "if(" + "(" * 100_000),
    cmake("5,000 nested blocks", CMAKE + "if(A)\n" * 5_000 + "find_package(rclcpp)\n" + "endif()\n" * 5_000),
    cmake("blocks that do not end", CMAKE + "if(A)\n" * 100 + "foreach(x a b)\n", "CMakeLists.txt"),
    cmake("ends without beginnings", CMAKE + "endif()\nendforeach()\nendfunction()\n", "CMakeLists.txt"),
    cmake("in UTF-16", CMAKE.encode("utf-16"), "UTF-16"),
    cmake("in Latin-1", CMAKE.encode() + "# M\xfcller\nset(X \xfc)\n".encode("latin-1")),
    cmake("null bytes", CMAKE.encode() + b"\0\0\0find_package(x\0)"),
    cmake("include of itself", CMAKE + "include(${CMAKE_CURRENT_LIST_FILE})\ninclude(CMakeLists.txt)\n"),
    Bad(
        "CMake include cycle",
        {
            "src/bad/CMakeLists.txt": CMAKE + "include(cmake/a.cmake)\n",
            "src/bad/cmake/a.cmake": "include(${CMAKE_CURRENT_LIST_DIR}/b.cmake)\n",
            "src/bad/cmake/b.cmake": "include(${CMAKE_CURRENT_LIST_DIR}/a.cmake)\n",
        },
    ),
    cmake("add_subdirectory of itself", CMAKE + "add_subdirectory(.)\nadd_subdirectory(../bad)\n"),
    Bad(
        "CMake add_subdirectory cycle",
        {
            "src/bad/CMakeLists.txt": CMAKE + "add_subdirectory(a)\n",
            "src/bad/a/CMakeLists.txt": "add_subdirectory(${CMAKE_SOURCE_DIR} x)\n",
        },
    ),
    cmake("missing subdirectory", CMAKE + "add_subdirectory(nowhere)\ninclude(nowhere.cmake)\n"),
    cmake("recursive function", CMAKE + "function(f)\n  f()\n  f()\nendfunction()\nf()\n"),
    cmake(
        "recursive macros",
        CMAKE + "macro(f x)\n  g(${x}${x})\nendmacro()\nmacro(g x)\n  f(${x}${x})\nendmacro()\nf(a)\n",
    ),
    cmake("while(TRUE)", CMAKE + "while(TRUE)\n  list(APPEND L x)\nendwhile()\n"),
    cmake("foreach over a huge range", CMAKE + "foreach(i RANGE 1000000000)\n  set(x ${i})\nendforeach()\n"),
    cmake("nested foreach", CMAKE + "foreach(a RANGE 999)\n" * 5 + "set(x 1)\n" + "endforeach()\n" * 5),
    cmake("text that doubles", CMAKE + 'set(A "x;y")\n' + 'set(A "${A};${A}")\n' * 64 + "add_library(l ${A})\n"),
    cmake("text repeated without end", CMAKE + "string(REPEAT xyz 1000000000 A)\nset(B ${A})\n"),
    cmake("regular expression that explodes", CMAKE + f'string(REGEX REPLACE "(a+)+b" "x" A "{"a" * 5000}")\n'),
    cmake("variables in a circle", CMAKE + "set(A ${B})\nset(B ${A}${A})\n" * 50 + "add_library(l ${A} ${${${A}}})\n"),
    cmake("generator expression that does not end", CMAKE + "add_library(l " + "$<IF:" * 3000 + ")\n"),
    cmake("list(GET) far outside", CMAKE + 'list(GET L 99999999999999999999 X)\nmath(EXPR Y "1/0")\n'),
    named("src/node.cpp", b"#include <a.h>\0\0\0int main() {}", "C++ null bytes"),
    named("src/node.cpp", "namespace a {" * 50_000, "C++ nested deeply"),
    named("src/node.cpp", "int x = " + "(" * 100_000, "C++ parentheses"),
    named("src/node.cpp", "/* never closed " + "x" * 1000, "C++ open comment"),
    named("src/node.cpp", 'auto s = R"(never closed', "C++ open raw string"),
    named("src/node.cpp", "#include <rclcpp/rclcpp.hpp>\nint main() {}\n".encode("utf-16"), "C++ in UTF-16"),
    named("src/node.cpp", "#if A\n" * 20_000, "C++ open conditions"),
    named("src/node.cpp", "int a = 1; " * 100_000, "C++ on one line"),
    named("bad/node.py", b"import rclpy\0\n", "Python null bytes", "node.py"),
    named("bad/node.py", "x = " + "(" * 5_000 + ")" * 5_000, "Python nested deeply", "node.py"),
    named("bad/node.py", "x = " + "1+" * 100_000 + "1\n", "Python long expression"),
    named("bad/node.py", "if True:\n\tx = 1\n        y = 2\n", "Python tabs and spaces"),
    named("bad/node.py", "# -*- coding: klingon -*-\nimport rclpy\n", "Python of an unknown encoding"),
    named("bad/node.py", "import rclpy\n".encode("utf-16"), "Python in UTF-16", "node.py"),
    named("bad/node.py", "def f(:\n", "Python syntax", "node.py"),
    named("bad/node.py", "x = 0x" + "f" * 100_000 + "\ny = " + "9" * 10_000, "Python huge numbers"),
    named(
        "setup.py", "raise SystemExit('never run this')\nimport os; os.remove('package.xml')\n", "setup.py that raises"
    ),
    named("setup.py", "from setuptools import setup\nsetup(name=", "setup.py cut off", "setup.py"),
    named("setup.cfg", "[metadata\nname = x\n= y\n", "setup.cfg malformed", "setup.cfg"),
    named("pyproject.toml", "[project\nname = ", "pyproject.toml malformed", "pyproject.toml"),
    named("msg/Bad.msg", "int32 int32 int32\n=== \n\xff[[[\nfloat64[<=] x\n", "msg of garbage", "Bad.msg"),
    named("msg/Bad.msg", b"int32 a\0b\n\xff\xfe\n", "msg of bytes", "Bad.msg"),
    named("msg/Bad.msg", 'string x "never closed\n' + "[" * 10_000, "msg open quote", "Bad.msg"),
    named("srv/Bad.srv", "---\n---\n---\nint32 a\n", "srv with four parts", "Bad.srv"),
    named("action/Bad.action", "int32 a\n", "action with one part", "Bad.action"),
    named("msg/Bad.idl", "module a { module b { struct C { sequence<sequence<", "idl cut off", "Bad.idl"),
    named("msg/Bad.idl", "module a {" * 20_000, "idl nested deeply", "Bad.idl"),
    named(
        "launch/a.launch.xml", "<launch>&nbsp;&undefined;<node pkg='rclcpp'/></launch>", "launch entity", "a.launch.xml"
    ),
    named("launch/a.launch", BOMB + "<launch>&j;</launch>", "launch entity bomb", "a.launch"),
    named(
        "launch/a.launch.xml",
        "<launch><include file='$(dirname)/a.launch.xml'/></launch>",
        "launch that includes itself",
    ),
    named("launch/a.launch.xml", "<launch>" + "<group>" * 50_000, "launch nested deeply", "a.launch.xml"),
    named(
        "launch/a.launch.xml", "<launch>$(find $(find $(find" + "$(eval " * 5000 + "</launch>", "launch substitutions"
    ),
    named("launch/a.launch.py", "def generate_launch_description(:\n", "launch.py syntax", "a.launch.py"),
    named("launch/a.launch.yaml", "launch:\n  - node: {pkg: [", "launch.yaml cut off", "a.launch.yaml"),
    named(
        "config/a.yaml",
        "a: &a [x,x,x,x,x,x,x,x,x]\n"
        + "".join(f"{chr(98 + n)}: &{chr(98 + n)} [{','.join(['*' + chr(97 + n)] * 9)}]\n" for n in range(12)),
        "YAML alias bomb",
    ),
    named("config/a.yaml", "a: &a\n  b: *a\n", "YAML that holds itself"),
    named("launch/a.launch.yaml", "launch: " + "[" * 50_000, "launch.yaml nested deeply", "a.launch.yaml"),
    named("config/a.yaml", "!!python/object/apply:os.system ['touch pwned']\n", "YAML that would run code"),
    named(
        "urdf/a.urdf.xacro",
        "<robot><xacro:macro name='m'><xacro:m/></xacro:macro><xacro:m/>",
        "xacro recursive macro",
        "a.urdf.xacro",
    ),
    named("plugins.xml", "<library path='x'><class type=</library>", "plugin malformed"),
    named("run.sh", "#!/bin/bash\nros2 run 'never closed\n$(" + "$(" * 10_000, "shell open quote"),
    named("CHANGELOG.rst", b"\xff\xfe\0", "changelog of bytes"),
    Bad(
        "colcon.pkg malformed",
        {
            "src/bad/colcon.pkg": "{a: [",
        },
        ("colcon.pkg",),
    ),
    Bad("colcon.meta malformed", {"colcon.meta": "names: ["}, ("colcon.meta",)),
    Bad("defaults.yaml malformed", {"defaults.yaml": "build: [\n"}, ("defaults.yaml",)),
    Bad("colcon.meta of other types", {"colcon.meta": "names: 3\npaths: [1]\n", "defaults.yaml": "- 1\n"}),
    Bad("names with control characters", {"src/bad/a\nb\x1b[31m.msg": "int32 a\n", "src/bad/src/\x07.cpp": "int a;\n"}),
    Bad(
        "names that are no UTF-8",
        {"src/bad/src/caf\udce9.cpp": "#include <a.h>\n", "src/bad/b\udcff.msg": "x\n"},
        ("not valid UTF-8",),
    ),
    Bad("a very deep folder", {"src/bad/" + "d/" * 300 + "CMakeLists.txt": CMAKE}),
    Bad(
        "a Git LFS pointer",
        {"src/bad/src/a.cpp": "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n"},
        ("LFS",),
    ),
    Bad("50 MB of generated code", {"src/bad/src/big.cpp": lambda: b"int a;\n" * 7_500_000}, ("big.cpp", "MB")),
]


@pytest.mark.parametrize("bad", FILES, ids=lambda bad: bad.name)
def test_files(say, ws, tmp_path, bad):
    write(ws, bad.files)
    said = say("check", ws, "--target", "jazzy", "--notes", "--quiet")
    clean(said)
    assert FOUND in said.out
    assert said.status == 1
    is_named(said, bad.words)
    assert "root:" not in said.text
    assert "\x1b" not in said.text
    assert not list(tmp_path.rglob("pwned")) and (ws / "src/bad/package.xml").exists()


# -- workspaces --------------------------------------------------------------------------------------------------------


def check(say, ws, *arguments):
    said = say("check", ws, "--target", "jazzy", "--notes", "--quiet", *arguments)
    clean(said)
    return said


def no_packages(ws: Path) -> None:
    for path in (ws / "src/healthy", ws / "src/bad"):
        for file in path.iterdir():
            file.unlink()


def all_ignored(ws: Path) -> None:
    (ws / "src/COLCON_IGNORE").touch()


def ignored_by_colcon(ws: Path) -> None:
    write(ws, {"defaults.yaml": "build:\n  packages-ignore: [healthy, bad]\n"})


def manifests_that_are_folders(ws: Path) -> None:
    no_packages(ws)
    (ws / "src/bad/package.xml").mkdir()


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (no_packages, ("no package was found", "give the folder of a workspace")),
        (all_ignored, ("all are ignored", "src", "COLCON_IGNORE", "remove the markers")),
        (ignored_by_colcon, ("all are ignored", "healthy", "packages-ignore in defaults.yaml")),
        (manifests_that_are_folders, ("no package was found",)),
    ],
)
@pytest.mark.parametrize("format", ["text", "json", "sarif", "github", "markdown", "html"])
def test_nothing_to_analyse_is_a_failure(say, ws, spoil, words, format):
    spoil(ws)
    said = check(say, ws, "--format", format)
    assert said.status == 2
    is_named(said, () if format in ("html", "sarif") else words)
    if format in ("json", "sarif"):
        assert json.loads(said.out)
    if format == "json":
        assert json.loads(said.out)["failure"]


def linked_in_a_circle(ws: Path) -> None:
    (ws / "src/bad/loop").symlink_to(".")
    (ws / "src/bad/up").symlink_to("../..")
    (ws / "src/bad/self.cpp").symlink_to("self.cpp")


def broken_link(ws: Path) -> None:
    (ws / "src/bad/node.cpp").symlink_to("nowhere.cpp")


def manifest_link_is_broken(ws: Path) -> None:
    (ws / "src/bad/package.xml").unlink()
    (ws / "src/bad/package.xml").symlink_to("../../gone.xml")


def named_pipe(ws: Path) -> None:
    os.mkfifo(ws / "src/bad/node.cpp")


def manifest_is_a_folder(ws: Path) -> None:
    (ws / "src/bad/package.xml").unlink()
    (ws / "src/bad/package.xml").mkdir()


def duplicate_names(ws: Path) -> None:
    write(ws, {"src/twin/package.xml": GOOD, "src/twin/CMakeLists.txt": CMAKE})


def cyclic_dependencies(ws: Path) -> None:
    write(ws, {
        "src/bad/package.xml": MANIFEST.format(name="bad", depend="worse"),
        "src/worse/package.xml": MANIFEST.format(name="worse", depend="bad"),
    })  # fmt: skip


def depends_on_itself(ws: Path) -> None:
    write(ws, {"src/bad/package.xml": MANIFEST.format(name="bad", depend="bad")})


def two_without_a_name(ws: Path) -> None:
    write(ws, {"src/bad/package.xml": "<package/>", "src/worse/package.xml": "<package/>"})


def broken_git(ws: Path) -> None:
    write(
        ws, {".git": "gitdir: /nowhere/at/all\n", "src/bad/.git/HEAD": "garbage", "src/bad/.git/index": b"DIRC\0\xff"}
    )


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (linked_in_a_circle, ("src/bad/loop", "parent folders", "src/bad/self.cpp")),
        (broken_link, ("src/bad/node.cpp", "nowhere.cpp", "broken")),
        (manifest_link_is_broken, ("src/bad/package.xml", "broken")),
        (named_pipe, ("src/bad/node.cpp", "neither a file nor a folder")),
        (manifest_is_a_folder, ()),
        (duplicate_names, ("src/bad/package.xml", "`bad`", "src/twin")),
        (cyclic_dependencies, ("dependency cycle", "bad", "worse")),
        (depends_on_itself, ("src/bad/package.xml",)),
        (two_without_a_name, ("src/bad/package.xml", "src/worse/package.xml")),
        (broken_git, ()),
    ],
)
def test_workspaces(say, ws, spoil, words):
    spoil(ws)
    said = check(say, ws)
    assert said.status == 1
    assert FOUND in said.out
    is_named(said, words)


def test_a_file_that_vanishes_while_it_is_read(say, ws, monkeypatch):
    from rosimpact.impact.tree import WorkingTree

    read = WorkingTree.read_with_id

    def gone(self, path, limit=0):
        if path == "src/bad/CMakeLists.txt":
            raise FileNotFoundError(2, "No such file or directory", path)
        return read(self, path, limit)

    monkeypatch.setattr(WorkingTree, "read_with_id", gone)
    said = check(say, write(ws, {"src/bad/CMakeLists.txt": CMAKE + "# read here alone\n"}))
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("src/bad/CMakeLists.txt", "no such file or directory"))


def test_a_file_that_may_not_be_read(say, ws, monkeypatch):
    from rosimpact.impact.tree import WorkingTree

    read = WorkingTree.read_with_id

    def denied(self, path, limit=0):
        if path == "src/bad/package.xml":
            raise PermissionError(13, "Permission denied", path)
        return read(self, path, limit)

    monkeypatch.setattr(WorkingTree, "read_with_id", denied)
    said = check(say, write(ws, {"src/bad/package.xml": GOOD + "<!-- read here alone -->"}))
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("src/bad/package.xml", "permission denied"))


def test_an_extractor_that_fails_costs_its_file_alone(say, ws, monkeypatch):
    from rosimpact.impact.facts import kinds

    extract = kinds.extract

    def fails(kind, data):
        if b"poison" in data:
            raise RuntimeError("out of cheese")
        return extract(kind, data)

    monkeypatch.setattr(kinds, "extract", fails)
    said = check(say, write(ws, {"src/bad/src/a.cpp": "// poison\n"}))
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("src/bad/src/a.cpp", "RuntimeError: out of cheese"))


def test_a_rule_that_fails_is_named_and_the_others_are_heard(say, ws, monkeypatch):
    from rosimpact.impact.rules import rule as registry

    def fails(view):
        raise RuntimeError("out of cheese")
        yield

    # What was remembered of such a package knows nothing of the failure: a package of its own.
    write(ws, {"src/bad/CMakeLists.txt": CMAKE + "find_package(judged_by_a_rule_that_fails)\n"})
    rules = registry.load_rules()
    monkeypatch.setitem(registry._RULES, "removed-header", rules["removed-header"]._replace(run=fails))
    said = say("check", ws, "--target", "jazzy", "--target", "humble", "--format", "json")
    report = json.loads(said.out)
    assert said.status == 2
    assert "the rule removed-header failed on jazzy, humble" in report["failure"]
    assert "RuntimeError" in report["failure"] and "report it" in report["failure"]
    assert "library-version" in {finding["rule"] for finding in report["findings"]}
    assert "Traceback" not in said.text


def test_an_unforeseen_error_is_one_line(say, ws, monkeypatch):
    from rosimpact.impact.model import workspace

    monkeypatch.setattr(workspace, "link", lambda *_, **__: 1 / 0)
    said = say("check", ws, "--format", "json")
    assert said.status == 2
    assert "ZeroDivisionError" in json.loads(said.out)["failure"]
    assert len(said.err.splitlines()) == 1 and "please report it" in said.err
    monkeypatch.setenv("ROSIMPACT_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        say("check", ws)


# -- what is asked for -------------------------------------------------------------------------------------------------


def toml(text: str | bytes) -> dict[str, str | bytes]:
    return {"rosimpact.toml": text}


class Asked(NamedTuple):
    """Arguments beside the workspace, files of the workspace, words of the answer. `WS` stands for the workspace."""

    arguments: tuple[str, ...]
    files: Mapping[str, Content]
    words: tuple[str, ...]


def target(text: str, *words: str, **files: str | bytes) -> Asked:
    return Asked(("--target", text), {}, words)


def machine(content: str | bytes, *words: str, name: str = "lap.json") -> Asked:
    return Asked(("--target", f"WS/{name}"), {name: content}, (name, *words))


def known(content: str | bytes, *words: str) -> Asked:
    return Asked(("--baseline", "WS/known.json"), {"known.json": content}, ("known.json", "--write-baseline", *words))


def setting(content: str | bytes, *words: str) -> Asked:
    return Asked((), toml(content), ("rosimpact.toml", *words))


def repos(content: str | bytes, *words: str) -> Asked:
    return Asked(("--base", "WS/pinned.repos"), {"pinned.repos": content}, ("pinned.repos", *words))


ASKED = {
    "unknown distro": target("jazy", "jazy", "did you mean `jazzy`", "noetic"),
    "empty target": target("", "Known distros"),
    "wrong month": target("humble@2024-13-45", "2024-13-45", "humble@2024-03-01"),
    "date in words": target("humble@yesterday", "yesterday", "humble@2024-03-01"),
    "no date": target("humble@", "no date"),
    "target that is a folder": target(".", "Known distros"),
    "captured machine that is not there": target("nowhere.json", "nowhere.json", "rosimpact env capture"),
    "captured machine, empty": machine("", "rosimpact env capture"),
    "captured machine, cut off": machine('{"rosimpact_target": 1, "distro"', "rosimpact env capture"),
    "captured machine, a list": machine("[]", "rosimpact env capture"),
    "captured machine of the future": machine('{"rosimpact_target": 99}', "rosimpact env capture"),
    "captured machine without a distro": machine('{"rosimpact_target": 1}', "distro"),
    "captured machine of an unknown distro": machine('{"rosimpact_target": 1, "distro": "gutsy"}', "gutsy"),
    "captured machine with a wrong date": machine('{"rosimpact_target": 1, "distro": "humble", "date": "x"}', "`x`"),
    "captured machine of bytes": machine(b"\xff\xfe\0", "rosimpact env capture"),
    "captured machine nested deeply": machine("[" * 100_000, "rosimpact env capture"),
    "dpkg listing, empty": machine("", "dpkg -l", name="robot.dpkg.txt"),
    "dpkg listing of something else": machine("hello world this is text\n" * 9, "dpkg -l", name="robot.dpkg.txt"),
    "dpkg listing of bytes": machine(b"\xff\0\xfe" * 99, "dpkg -l", name="robot.dpkg.txt"),
    "dpkg listing without ROS": machine("ii  bash  5.1-6  amd64  shell\n", "ROS", name="robot.dpkg.txt"),
    "dpkg listing that is not there": target("gone.dpkg.txt", "gone.dpkg.txt", "dpkg -l"),
    "docker image of no distro": target("docker:alpine:3.20", "docker:alpine:3.20", "humble"),
    "unknown rule": Asked(("--select", "removed-haeder"), {}, ("removed-haeder", "did you mean `removed-header`")),
    "unknown rule to ignore": Asked(("--ignore", "x,removed-header"), {}, ("--ignore", "`x`")),
    "unknown format": Asked(("--format", "xml"), {}, ("xml", "sarif")),
    "unknown threshold": Asked(("--fail-on", "fatal"), {}, ("fatal", "never")),
    "output below a file": Asked(("--output", "WS/rosimpact.txt/x"), {"rosimpact.txt": ""}, ("rosimpact.txt/x",)),
    "output is a folder": Asked(("--output", "WS/src"), {}, ("src", "give another file")),
    "baseline that is not there": Asked(("--baseline", "WS/gone.json"), {}, ("gone.json", "--write-baseline")),
    "baseline is a folder": Asked(("--baseline", "WS/src"), {}, ("src", "--write-baseline")),
    "baseline, empty": known(""),
    "baseline, a list": known("[]"),
    "baseline of another schema": known('{"schema": 7, "findings": []}', "schema 7")._replace(
        words=("known.json", "schema 7")
    ),
    "baseline of other types": known('{"schema": 1, "findings": [{"fingerprint": "a", "count": "many"}]}'),
    "baseline of bytes": known(b"\xff\xfe\0"),
    "baseline nested deeply": known("[" * 100_000),
    "pruning without a baseline": Asked(("--prune-baseline",), {}, ("--baseline",)),
    "pruning of what some rules find": Asked(
        ("--baseline", "WS/known.json", "--prune-baseline", "--select", "removed-header"), {}, ("--select",)
    ),
    "new baseline below a file": Asked(("--write-baseline", "WS/a/b"), {"a": ""}, ("a/b", "give another file")),
    "configuration that is not there": Asked(("--config", "WS/gone.toml"), {}, ("gone.toml", "--config")),
    "configuration cut off": setting('[targets.robot]\ndistro = "hum', "cannot be read"),
    "configuration of bytes": setting(b"\xff\xfe\0", "cannot be read"),
    "configuration nested deeply": setting("a = " + "[" * 100_000, "cannot be read"),
    "configuration with an unknown table": setting(
        "[target.robot]\ndistro = 'humble'\n", "`target`", "did you mean `targets`"
    ),
    "configuration with an unknown key": setting("[check]\nfailon = 'error'\n", "`failon`", "did you mean `fail_on`"),
    "configuration with a wrong threshold": setting("[check]\nfail_on = 'fatal'\n", "fatal", "never"),
    "configuration with a threshold of another type": setting("[check]\nfail_on = 3\n", "fail_on"),
    "configuration with an unknown rule": setting("[check]\nselect = ['nonsense']\n", "[check]", "nonsense"),
    "configuration with an unknown severity": setting(
        "[check]\nseverity = {removed-header = 'fatal'}\n", "[check]", "fatal", "off"
    ),
    "configuration with the severity of an unknown rule": setting(
        "[check]\nseverity = {nonsense = 'off'}\n", "[check]", "nonsense"
    ),
    "configuration with severities of another type": setting("[check]\nseverity = 'error'\n", "severity", "table"),
    "configuration with rules of another type": setting("[check]\nignore = [1]\n", "ignore", "list of strings"),
    "configuration where a table is a number": setting("check = 3\n", "[check]"),
    "configuration where a path is a list": setting("[paths]\n'src/**' = ['all']\n", "src/**", "table"),
    "configuration with an unknown key of a path": setting(
        "[paths.'src/**']\nignores = ['all']\n", "did you mean `ignore`"
    ),
    "configuration with an unknown rule of a path": setting(
        "[paths.'src/**']\nignore = ['nonsense']\n", "src/**", "nonsense"
    ),
    "configuration with a target of no distro": setting(
        "[targets.robot]\ndate = 2024-01-01\n", "targets.robot", "distro"
    ),
    "configuration with a target of a wrong distro": setting("[targets.robot]\ndistro = 'gutsy'\n", "gutsy", "humble"),
    "configuration with a target of a wrong date": setting(
        "[targets.robot]\ndistro = 'humble'\ndate = 'x'\n", "robot", "`x`"
    ),
    "configuration with a target of versions": setting(
        "[targets.robot]\ndistro = 'humble'\nversions = 4\n", "robot", "versions"
    ),
    "configuration with a target that is a number": setting("[targets]\nrobot = 4\n", "targets.robot"),
    "configuration with a target of an unknown key": setting("[targets.robot]\ndistro = 'humble'\nos = 'x'\n", "`os`"),
    "configuration that asks for an unknown target": setting("[check]\ntargets = ['robbot']\n", "robbot")._replace(
        words=("robbot", "Known distros")
    ),
    "configuration of targets in a list": setting("targets = ['humble']\n", "[targets]"),
    "revision of no repository": Asked(("--rev", "HEAD"), {}, ("git repository",)),
    "base of no repository": Asked(("--base", "main"), {}, ("git repository",)),
    "base of an unknown folder": Asked(("--base", "src/bad=main"), {}, ("src/bad", "git repository")),
    "base without a revision": Asked(("--base", "src/bad="), {}, ("src/bad=REV",)),
    "base given twice": Asked(("--base", "a", "--base", "b"), {}, ("--base b", "PATH=REV")),
    ".repos that is not there": Asked(("--base", "WS/gone.repos"), {}, ("gone.repos",)),
    ".repos that is no YAML": repos("repositories: [", "vcs export"),
    ".repos of bytes": repos(b"\xff\0", "vcs export"),
    ".repos that is a list of text": repos("- a\n- b\n", "pins no version"),
    ".repos that is text": repos("hello\n", "vcs export"),
    ".repos without versions": repos("repositories:\n  a: {type: git, url: x}\n", "vcs export"),
    ".repos of other types": repos("repositories:\n  a: 3\n  b: [1]\n", "vcs export"),
    ".repos of other repositories": repos("repositories:\n  a: {type: git, version: main}\n")._replace(
        words=("no repository", "(a)")
    ),
    ".repos nested deeply": repos("[" * 100_000, "vcs export"),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_is_asked_for(say, ws, name):
    asked = ASKED[name]
    write(ws, asked.files)
    arguments = [argument.replace("WS", str(ws)) for argument in asked.arguments]
    if "--target" not in arguments and "rosimpact.toml" not in asked.files:
        arguments += ["--target", "jazzy"]
    said = say("check", ws, "--quiet", *arguments)
    clean(said)
    assert said.status == 2
    assert len([line for line in said.err.splitlines() if line]) == 1
    is_named(said, asked.words)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("nowhere", ("nowhere", "does not exist", "give the folder")),
        ("src/bad/CMakeLists.txt", ("CMakeLists.txt", "is a file", "give the folder")),
        ("src/bad/CMakeLists.txt/x", ("does not exist",)),
        ("a\x00b", ("a\\x00b", "null byte")),
        ("n" * 5000, ("n" * 100,)),
    ],
)
@pytest.mark.parametrize("command", ["check", "why"])
def test_paths(say, ws, command, path, words):
    before = ["why", "rclcpp"] if command == "why" else ["check"]
    said = say(*before, f"{ws}/{path}", "--target", "jazzy")
    clean(said)
    assert said.status == 2
    is_named(said, words)


# -- git ---------------------------------------------------------------------------------------------------------------


def committed(folder: Path, bare: bool = False) -> pygit2.Repository:
    repository = pygit2.init_repository(str(folder), bare=bare, initial_head="main")
    if not bare:
        repository.index.add_all()
        repository.index.write()
        who = pygit2.Signature("a", "a@b.org", 1_700_000_000, 0)
        repository.create_commit("HEAD", who, who, "one", repository.index.write_tree(), [])
    return repository


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--rev", "v9.9"), ("`v9.9`", "no revision")),
        (("--base", "v9.9"), ("`v9.9`", "no revision")),
        (("--base", "src=v9.9"), ("`src`", "no git repository")),
        (("--base", ".=v9.9"), ("`v9.9`", "no revision")),
        (("--rev", "HEAD:src/bad/package.xml"), ("no revision",)),
        (("--rev", "HEAD", "--fix"), ("--fix", "remove --rev")),
        (("--rev", ""), ("--rev", "is empty")),
        (("--base", ""), ("--base", "is empty")),
    ],
)
def test_revisions(say, ws, arguments, words):
    committed(ws)
    said = check(say, ws, *arguments)
    assert said.status == 2
    is_named(said, words)


def test_a_bare_repository_without_commits(say, tmp_path):
    committed(tmp_path / "bare.git", bare=True)
    said = check(say, tmp_path / "bare.git")
    assert said.status == 2
    is_named(said, ("bare.git", "no revision"))


def test_a_repository_without_commits(say, ws):
    pygit2.init_repository(str(ws), initial_head="main")
    assert check(say, ws).status == 1
    said = check(say, ws, "--base", "main")
    assert said.status == 2
    is_named(said, ("no revision",))


def test_a_repository_whose_objects_are_gone(say, ws):
    repository = committed(ws)
    objects = Path(repository.path) / "objects"
    for file in objects.rglob("*"):
        if file.is_file():
            file.chmod(0o644)
            file.write_bytes(b"")
    for arguments in (("--rev", "HEAD"), ("--base", "HEAD")):
        said = check(say, ws, *arguments)
        assert said.status == 2
        assert said.err


def test_equal_files_whose_object_is_missing_cost_themselves_alone(say, ws):
    for name in ("one", "two"):
        (ws / f"src/healthy/{name}.cpp").write_text("int only_here();\n")
        (ws / f"src/healthy/scripts_{name}").write_text("#!/usr/bin/env python3\nprint(1)\n")
    repository = committed(ws)
    for name in ("one.cpp", "scripts_one"):
        id = str(repository.revparse_single(f"HEAD:src/healthy/{name}").id)
        (Path(repository.path) / "objects" / id[:2] / id[2:]).unlink()
    said = check(say, ws, "--rev", "HEAD")
    assert said.status == 1 and FOUND in said.out
    said = say("graph", ws, "--rev", "HEAD")
    assert said.status == 0, said.err


def test_branches_without_a_common_ancestor(say, ws):
    repository = committed(ws)
    who = pygit2.Signature("b", "b@b.org", 1_700_000_001, 0)
    other = repository.create_commit(None, who, who, "other", repository.index.write_tree(), [])
    repository.create_branch("other", repository[other])
    said = check(say, ws, "--base", "other")
    assert said.status == 2
    is_named(said, ("other", "share no history"))


# -- the shipped data --------------------------------------------------------------------------------------------------


@pytest.fixture
def data(ws, tmp_path, monkeypatch) -> Path:
    """A copy of the shipped data that can be broken, a workspace that asks it for a header, and an empty cache."""
    import shutil

    write(ws, {"src/bad/src/node.cpp": "#include <rclcpp/rclcpp.hpp>\n"})
    folder = tmp_path / "data"
    shutil.copytree(tables.DATA, folder)
    # What an earlier test's check came to is remembered there, and would be said again without a look at the data.
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(snapshot, "_default", snapshot.Snapshot(folder, tmp_path / "unpacked", folder))
    monkeypatch.setattr(providers, "_default", providers.Providers(folder, tmp_path / "unpacked"))
    return folder


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def garbage(path: Path) -> None:
    path.write_bytes(b"\xff\0garbage")


@pytest.mark.parametrize("spoil", [Path.unlink, cut, garbage], ids=lambda f: f.__name__)
@pytest.mark.parametrize("name", ["snapshot.json", "distros.sqlite.zst", "providers.json", "providers.sqlite.zst"])
@pytest.mark.parametrize("command", ["check", "why"])
def test_broken_data(say, ws, data, name, spoil, command):
    spoil(data / name)
    before = ["why", "rclcpp"] if command == "why" else ["check"]
    said = say(*before, ws, "--target", "jazzy")
    clean(said)
    assert said.status == 2
    is_named(said, (name.split(".")[0], "install rosimpact again"))


@pytest.mark.parametrize("spoil", [cut, garbage], ids=lambda f: f.__name__)
def test_unpacked_data_that_broke_is_unpacked_again(say, ws, data, tmp_path, spoil, monkeypatch):
    assert check(say, ws).status == 1
    unpacked = list((tmp_path / "unpacked").glob("*.sqlite"))
    assert len(unpacked) == 2
    whole = {file: file.stat().st_size for file in unpacked}
    for file in unpacked:
        file.chmod(0o644)
        spoil(file)
    write(ws, {"src/bad/CMakeLists.txt": CMAKE + "find_package(Eigen3)\n"})  # or the first answer is remembered
    monkeypatch.setattr(snapshot, "_default", snapshot.Snapshot(data, tmp_path / "unpacked", data))
    monkeypatch.setattr(providers, "_default", providers.Providers(data, tmp_path / "unpacked"))
    said = check(say, ws)
    assert said.status == 1 and FOUND in said.out
    assert {file: file.stat().st_size for file in unpacked} == whole


# -- the cache ---------------------------------------------------------------------------------------------------------


def test_a_cache_that_cannot_be_written(say, ws, tmp_path, monkeypatch, data):
    (tmp_path / "file").touch()
    monkeypatch.setattr(snapshot, "_default", snapshot.Snapshot(data, tmp_path / "file/x", data))
    monkeypatch.setattr(providers, "_default", providers.Providers(data, tmp_path / "file/x"))
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "file/x"))
    said = check(say, ws)
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("file/x", "ROSIMPACT_CACHE"))


class FullDisk(sqlite3.Connection):
    """Writes nothing, as on a full disk."""

    def executemany(self, *arguments):
        raise sqlite3.OperationalError("database or disk is full")


def test_a_full_disk(say, ws, tmp_path, monkeypatch):
    connect = sqlite3.connect
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "full"))
    monkeypatch.setattr(
        sqlite3, "connect", lambda *a, **k: connect(*a, **(k | {"factory": FullDisk} if "facts" in str(a[0]) else k))
    )
    said = check(say, ws)
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("disk is full", "ROSIMPACT_CACHE"))


@pytest.mark.parametrize("spoil", [cut, garbage], ids=lambda f: f.__name__)
def test_a_damaged_cache_is_started_anew(say, ws, tmp_path, monkeypatch, spoil):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    assert check(say, ws).status == 1
    spoil(tmp_path / "cache/facts.sqlite")
    said = check(say, ws)
    assert said.status == 1 and FOUND in said.out
    is_named(said, ("facts.sqlite", "damaged"))
    assert "damaged" not in check(say, ws).text


def test_a_cache_of_something_else(say, ws, tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    (tmp_path / "cache").mkdir()
    with sqlite3.connect(tmp_path / "cache/facts.sqlite") as other:
        other.execute("CREATE TABLE facts (id, nonsense)")
        other.execute("PRAGMA user_version = 1")
    said = check(say, ws)
    assert said.status == 1 and FOUND in said.out


# -- processes ---------------------------------------------------------------------------------------------------------


def many_sources(ws: Path, count: int = 60) -> Path:
    return write(
        ws,
        {
            f"src/bad/src/f{n}.cpp": f"#include <a{n}.h>\n" + f"int f{n}() {{ return {n}; }}\n" * 500
            for n in range(count)
        },
    )


def started(ws: Path, cache: Path) -> subprocess.Popen:
    return subprocess.Popen(
        [sys.executable, "-m", "rosimpact.impact.cli", "check", str(ws), "--target", "jazzy", "--format", "json"],
        env={**os.environ, "ROSIMPACT_CACHE": str(cache)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


def findings(process: subprocess.Popen) -> set[tuple[str, str]]:
    out, err = process.communicate(timeout=120)
    assert b"Traceback" not in err
    assert process.returncode == 1
    return {(finding["rule"], finding["package"]) for finding in json.loads(out)["findings"]}


def rows(cache: Path) -> int:
    try:
        with contextlib.closing(sqlite3.connect(f"file:{cache}/facts.sqlite?mode=ro", uri=True)) as database:
            return database.execute("SELECT count(*) FROM facts").fetchone()[0]
    except sqlite3.Error:
        return 0


def test_killed_in_the_middle_and_run_again(ws, tmp_path):
    many_sources(ws)
    cache = tmp_path / "cache"
    first = started(ws, cache)
    while not rows(cache) and first.poll() is None:
        time.sleep(0.01)
    first.kill()
    first.communicate()
    assert ("library-version", "healthy") in findings(started(ws, cache))
    assert rows(cache) > 60


def test_interrupted(ws, tmp_path):
    import signal

    many_sources(ws, 300)
    first = started(ws, tmp_path / "cache")
    while not rows(tmp_path / "cache") and first.poll() is None:
        time.sleep(0.01)
    first.send_signal(signal.SIGINT)
    _, err = first.communicate(timeout=60)
    assert b"Traceback" not in err
    if first.returncode == 130:  # it may have been through already
        assert b"what was parsed is kept" in err


def test_two_runs_at_once(ws, tmp_path):
    many_sources(ws)
    runs = [started(ws, tmp_path / "cache") for _ in range(2)]
    first, second = (findings(run) for run in runs)
    assert first == second
    assert ("library-version", "healthy") in first
