"""Malformed and hostile input: each is named, with what to do, nothing else is lost, and no traceback is seen.

Every case stands beside a healthy package with one known finding, which has to be found all the same.
"""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pygit2
import pytest
from rosimpact.impact import cli
from rosimpact.impact.targets import providers, snapshot

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
BAD = {"src/bad/package.xml": MANIFEST.format(name="bad", depend="rclcpp"), "src/bad/CMakeLists.txt": CMAKE}
BOMB = "<!DOCTYPE x [<!ENTITY a '" + "A" * 1000 + "'>" + "".join(
    f"<!ENTITY {chr(98 + n)} '{f'&{chr(97 + n)};' * 10}'>" for n in range(9)
) + "]>"  # fmt: skip


def write(root: Path, files: dict[str, str | bytes]) -> Path:
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode("utf-8", "surrogateescape") if isinstance(content, str) else content)
    return root


class Said(NamedTuple):
    """What a command said, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def text(self) -> str:
        return self.out + self.err


@pytest.fixture
def say(capfd, tmp_path, monkeypatch) -> Callable[..., Said]:
    """Runs the command line in this process, with a cache of its own for facts; the unpacked data is shared."""
    monkeypatch.setenv("NO_COLOR", "1")
    for name in ("ROS_DISTRO", "GITHUB_WORKSPACE", "GITHUB_STEP_SUMMARY"):
        monkeypatch.delenv(name, raising=False)

    def run(*arguments: object) -> Said:
        monkeypatch.setattr(sys, "argv", ["rosimpact", *map(os.fsdecode, map(str, arguments))])
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            cli.main()
        out, err = capfd.readouterr()
        code = ended.value.code
        return Said(code if isinstance(code, int) else 0 if code is None else 1, out, err)

    return run


@pytest.fixture
def ws(tmp_path) -> Path:
    return write(tmp_path / "ws", HEALTHY | BAD)


def clean(said: Said) -> None:
    """What holds for every answer, whatever was asked."""
    assert "Traceback" not in said.text
    assert "this is a fault of rosimpact" not in said.text


def is_named(said: Said, words: tuple[str, ...]) -> None:
    for word in words:
        assert word in said.text


# -- files of a package ------------------------------------------------------------------------------------------------


class Bad(NamedTuple):
    """name; files that go over the package `bad`; words that the report has to hold."""

    name: str
    files: dict[str, str | bytes]
    words: tuple[str, ...] = ()


def manifest(name: str, content: str | bytes, *words: str) -> Bad:
    return Bad(f"manifest {name}", {"src/bad/package.xml": content}, ("src/bad/package.xml", *words))


def cmake(name: str, content: str | bytes, *words: str) -> Bad:
    return Bad(f"CMake {name}", {"src/bad/CMakeLists.txt": content}, ("src/bad/CMakeLists.txt", *words) if words else ())


def named(path: str, content: str | bytes, name: str, *words: str) -> Bad:
    return Bad(name, {f"src/bad/{path}": content}, (f"src/bad/{path}", *words) if words else ())


GOOD = MANIFEST.format(name="bad", depend="rclcpp")
FILES = [
    manifest("empty", "", "not well-formed"),
    manifest("truncated", GOOD[:200]),
    manifest("entity bomb", BOMB + GOOD.split("?>")[1].replace("<description>d", "<description>&j;")),
    manifest("external entity", "<!DOCTYPE x [<!ENTITY e SYSTEM 'file:///etc/passwd'>]>" + GOOD.split("?>")[1].replace(">d<", ">&e;<")),
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
    Bad("CMake include cycle", {
        "src/bad/CMakeLists.txt": CMAKE + "include(cmake/a.cmake)\n",
        "src/bad/cmake/a.cmake": "include(${CMAKE_CURRENT_LIST_DIR}/b.cmake)\n",
        "src/bad/cmake/b.cmake": "include(${CMAKE_CURRENT_LIST_DIR}/a.cmake)\n",
    }),
    cmake("add_subdirectory of itself", CMAKE + "add_subdirectory(.)\nadd_subdirectory(../bad)\n"),
    Bad("CMake add_subdirectory cycle", {
        "src/bad/CMakeLists.txt": CMAKE + "add_subdirectory(a)\n",
        "src/bad/a/CMakeLists.txt": "add_subdirectory(${CMAKE_SOURCE_DIR} x)\n",
    }),
    cmake("missing subdirectory", CMAKE + "add_subdirectory(nowhere)\ninclude(nowhere.cmake)\n"),
    cmake("recursive function", CMAKE + "function(f)\n  f()\n  f()\nendfunction()\nf()\n"),
    cmake("recursive macros", CMAKE + "macro(f x)\n  g(${x}${x})\nendmacro()\nmacro(g x)\n  f(${x}${x})\nendmacro()\nf(a)\n"),
    cmake("while(TRUE)", CMAKE + "while(TRUE)\n  list(APPEND L x)\nendwhile()\n"),
    cmake("foreach over a huge range", CMAKE + "foreach(i RANGE 1000000000)\n  set(x ${i})\nendforeach()\n"),
    cmake("nested foreach", CMAKE + "foreach(a RANGE 999)\n" * 5 + "set(x 1)\n" + "endforeach()\n" * 5),
    cmake("text that doubles", CMAKE + 'set(A "x;y")\n' + 'set(A "${A};${A}")\n' * 64 + "add_library(l ${A})\n"),
    cmake("text repeated without end", CMAKE + "string(REPEAT xyz 1000000000 A)\nset(B ${A})\n"),
    cmake("regular expression that explodes", CMAKE + f'string(REGEX REPLACE "(a+)+b" "x" A "{"a" * 5000}")\n'),
    cmake("variables in a circle", CMAKE + "set(A ${B})\nset(B ${A}${A})\n" * 50 + "add_library(l ${A} ${${${A}}})\n"),
    cmake("generator expression that does not end", CMAKE + "add_library(l " + "$<IF:" * 3000 + ")\n"),
    cmake("list(GET) far outside", CMAKE + "list(GET L 99999999999999999999 X)\nmath(EXPR Y \"1/0\")\n"),
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
    named("setup.py", "raise SystemExit('never run this')\nimport os; os.remove('package.xml')\n", "setup.py that raises"),
    named("setup.py", "from setuptools import setup\nsetup(name=", "setup.py cut off", "setup.py"),
    named("setup.cfg", "[metadata\nname = x\n= y\n", "setup.cfg malformed", "setup.cfg"),
    named("pyproject.toml", "[project\nname = ", "pyproject.toml malformed", "pyproject.toml"),
    named("msg/Bad.msg", "int32 int32 int32\n=== \n\xff[[[\nfloat64[<=] x\n", "msg of garbage", "Bad.msg"),
    named("msg/Bad.msg", b"int32 a\0b\n\xff\xfe\n", "msg of bytes", "Bad.msg"),
    named("msg/Bad.msg", "string x \"never closed\n" + "[" * 10_000, "msg open quote", "Bad.msg"),
    named("srv/Bad.srv", "---\n---\n---\nint32 a\n", "srv with four parts", "Bad.srv"),
    named("action/Bad.action", "int32 a\n", "action with one part", "Bad.action"),
    named("msg/Bad.idl", "module a { module b { struct C { sequence<sequence<", "idl cut off", "Bad.idl"),
    named("msg/Bad.idl", "module a {" * 20_000, "idl nested deeply", "Bad.idl"),
    named("launch/a.launch.xml", "<launch>&nbsp;&undefined;<node pkg='rclcpp'/></launch>", "launch entity", "a.launch.xml"),
    named("launch/a.launch", BOMB + "<launch>&j;</launch>", "launch entity bomb", "a.launch"),
    named("launch/a.launch.xml", "<launch><include file='$(dirname)/a.launch.xml'/></launch>", "launch that includes itself"),
    named("launch/a.launch.xml", "<launch>" + "<group>" * 50_000, "launch nested deeply", "a.launch.xml"),
    named("launch/a.launch.xml", "<launch>$(find $(find $(find" + "$(eval " * 5000 + "</launch>", "launch substitutions"),
    named("launch/a.launch.py", "def generate_launch_description(:\n", "launch.py syntax", "a.launch.py"),
    named("launch/a.launch.yaml", "launch:\n  - node: {pkg: [", "launch.yaml cut off", "a.launch.yaml"),
    named(
        "config/a.yaml",
        "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(f"{chr(98 + n)}: &{chr(98 + n)} [{','.join(['*' + chr(97 + n)] * 9)}]\n" for n in range(12)),
        "YAML alias bomb",
    ),
    named("config/a.yaml", "a: &a\n  b: *a\n", "YAML that holds itself"),
    named("config/a.yaml", "type: a/b\nc: " + "[" * 50_000, "YAML nested deeply", "a.yaml"),
    named("config/a.yaml", "!!python/object/apply:os.system ['touch pwned']\n", "YAML that would run code"),
    named("urdf/a.urdf.xacro", "<robot><xacro:macro name='m'><xacro:m/></xacro:macro><xacro:m/>", "xacro recursive macro", "a.urdf.xacro"),
    named("plugins.xml", "<library path='x'><class type=</library>", "plugin malformed"),
    named("run.sh", "#!/bin/bash\nros2 run 'never closed\n$(" + "$(" * 10_000, "shell open quote"),
    named("CHANGELOG.rst", b"\xff\xfe\0", "changelog of bytes"),
    Bad("colcon.pkg malformed", {"src/bad/colcon.pkg": "{a: [", }, ("colcon.pkg",)),
    Bad("colcon.meta malformed", {"colcon.meta": "names: ["}, ("colcon.meta",)),
    Bad("defaults.yaml malformed", {"defaults.yaml": "build: [\n"}, ("defaults.yaml",)),
    Bad("colcon.meta of other types", {"colcon.meta": "names: 3\npaths: [1]\n", "defaults.yaml": "- 1\n"}),
    Bad("names with control characters", {"src/bad/a\nb\x1b[31m.msg": "int32 a\n", "src/bad/src/\x07.cpp": "int a;\n"}),
    Bad("names that are no UTF-8", {"src/bad/src/caf\udce9.cpp": "#include <a.h>\n", "src/bad/b\udcff.msg": "x\n"}, ("not valid UTF-8",)),
    Bad("a very deep folder", {"src/bad/" + "d/" * 300 + "CMakeLists.txt": CMAKE}),
    Bad("a Git LFS pointer", {"src/bad/src/a.cpp": "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n"}, ("LFS",)),
    Bad("50 MB of generated code", {"src/bad/src/big.cpp": b"int a;\n" * 7_500_000}, ("big.cpp", "MB")),
]  # fmt: skip


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
