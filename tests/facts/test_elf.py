"""What built files say they need, told from their bytes alone."""

from __future__ import annotations

import shutil
import struct
import subprocess
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.facts import elf
from rosimpact.impact.facts.elf import Elf, parse_symbol, read, split_soname


def test_the_dynamic_section_is_read(made_elf):
    data = made_elf("EM_AARCH64", ["libpcl_common.so.1.12", "libc.so.6"], "libwinch.so.2", "$ORIGIN/../lib:/opt/x")
    assert read(data) == Elf(
        machine="EM_AARCH64",
        bits=64,
        soname="libwinch.so.2",
        needed=("libpcl_common.so.1.12", "libc.so.6"),
        search=("$ORIGIN/../lib", "/opt/x"),
        dynamic=True,
    )


def test_a_program_is_told_from_a_library(made_elf):
    found = [read(made_elf("EM_X86_64", ["libc.so.6"], program=program)) for program in (True, False)]
    assert [each is not None and each.program for each in found] == [True, False]


@pytest.mark.parametrize("data", [b"", b"#!/bin/sh\n", b"\x7fEL", b"!<arch>\n", b"\0" * 100])
def test_what_is_no_elf_file_gives_nothing(data):
    assert read(data) is None


@pytest.mark.parametrize("length", [4, 5, 16, 40, 63, 64, 100, 176, 200])
def test_of_a_file_that_is_cut_off_that_is_told(made_elf, length):
    found = read(made_elf("EM_X86_64", ["libpcl_common.so.1.12"])[:length])
    assert found is not None
    assert found.problem
    assert found.needed == ()


@settings(deadline=None, max_examples=300)
@given(st.data())
def test_damaged_bytes_never_raise(made_elf, data):
    whole = bytearray(made_elf("EM_X86_64", ["liba.so.1", "libb.so.2"], "libc.so.3", "/opt"))
    for _ in range(data.draw(st.integers(1, 6))):
        whole[data.draw(st.integers(4, len(whole) - 1))] = data.draw(st.integers(0, 255))
    assert isinstance(read(bytes(whole)), Elf)


@pytest.mark.parametrize(
    ("soname", "parts"),
    [
        ("libpcl_common.so.1.12", ("libpcl_common.so", "1.12")),
        ("libopencv_core.so.4.5d", ("libopencv_core.so", "4.5d")),
        ("librclcpp.so", ("librclcpp.so", "")),
        ("libvtkCommonCore-9.1.so.1", ("libvtkCommonCore-9.1.so", "1")),
        ("ld-linux-x86-64.so.2", ("ld-linux-x86-64.so", "2")),
    ],
)
def test_a_soname_has_a_stem_and_a_version(soname, parts):
    assert split_soname(soname) == parts


# Files that a real linker made


@pytest.fixture(scope="module")
def linked(tmp_path_factory) -> Path:
    """A folder with libwinch.so.2, whose symbols have versions, and a program `crane` that is linked with it."""
    compiler = shutil.which("gcc")
    if compiler is None:
        pytest.skip("no gcc: install it to read files that a real linker made")
    folder = tmp_path_factory.mktemp("linked")
    (folder / "winch.c").write_text("int rope(void) { return 3; }\nint hook(void) { return 4; }\n")
    (folder / "winch.map").write_text("WINCH_1 { global: rope; local: *; };\nWINCH_2 { global: hook; } WINCH_1;\n")
    (folder / "crane.c").write_text(
        "int rope(void); int hook(void); extern int maybe(void) __attribute__((weak));\n"
        "int main(void) { return rope() + hook() + (maybe ? maybe() : 0); }\n"
    )
    run(compiler, folder, "-shared", "-fPIC", "-Wl,-soname,libwinch.so.2", "-Wl,--version-script=winch.map",
        "-o", "libwinch.so.2", "winch.c")  # fmt: skip
    run(compiler, folder, "-o", "crane", "crane.c", "./libwinch.so.2", "-Wl,--build-id=0x1234abcd",
        "-Wl,--enable-new-dtags,-rpath,$ORIGIN")  # fmt: skip
    run(compiler, folder, "-c", "-o", "crane.o", "crane.c")
    return folder


def run(compiler: str, folder: Path, *arguments: str) -> None:
    subprocess.run([compiler, *arguments], cwd=folder, check=True, capture_output=True)


def read_file(path: Path) -> Elf:
    found = read(path.read_bytes())
    assert found is not None and not found.problem
    return found


def test_a_linked_library_says_what_it_offers(linked):
    library = read_file(linked / "libwinch.so.2")
    assert (library.soname, library.program, library.offers) == ("libwinch.so.2", False, ("WINCH_1", "WINCH_2"))
    assert library.defined >= 2


def test_a_linked_program_says_what_it_needs_and_in_which_versions(linked):
    program = read_file(linked / "crane")
    assert program.program and program.dynamic
    assert "libwinch.so.2" in program.needed
    assert program.search == ("$ORIGIN",)
    assert {asked.library: asked.versions for asked in program.asked}["libwinch.so.2"] == ("WINCH_1", "WINCH_2")
    undefined = {symbol.name: symbol for symbol in program.undefined}
    assert (undefined["rope"].version, undefined["hook"].version) == ("WINCH_1", "WINCH_2")
    assert (undefined["maybe"].version, undefined["maybe"].weak, undefined["rope"].weak) == ("", True, False)


def test_an_object_file_is_not_linked_at_run_time(linked):
    assert not read_file(linked / "crane.o").dynamic


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_a_linked_program_that_is_cut_off_is_told(linked, share):
    data = (linked / "crane").read_bytes()
    found = elf.read(data[: int(len(data) * share)])
    assert found is not None and found.problem


@pytest.mark.parametrize(
    ("symbol", "name", "scope"),
    [
        ("_ZN6rclcpp4Node3nowEv", "rclcpp::Node::now", "6rclcpp4Node"),
        ("_ZNK6rclcpp4Node8get_nameEv", "rclcpp::Node::get_name", "6rclcpp4Node"),
        ("_ZN6rclcpp4NodeC1ERKNS_11NodeOptionsE", "rclcpp::Node", "6rclcpp4Node"),
        ("_ZTVN6rclcpp4NodeE", "rclcpp::Node", "6rclcpp4Node"),
        ("_ZN3pcl9VoxelGridINS_8PointXYZEE11applyFilterEv", "pcl::VoxelGrid", "3pcl9VoxelGrid"),
        ("_Z4foldi", "fold", ""),
    ],
)
def test_what_a_symbol_is_a_member_of(symbol, name, scope):
    assert parse_symbol(symbol) == (name, scope)


@pytest.mark.parametrize("symbol", ["malloc", "_ZNSt6thread4joinEv", "_ZdlPv", "_Z"])
def test_symbols_that_are_of_no_class_of_ones_own(symbol):
    assert parse_symbol(symbol) is None


# Files that claim what no file has


def head(count=0, segments=0, names=0) -> bytes:
    """The header of a 64-bit library whose segments, or else sections, follow it."""
    table, other = (64, 0) if segments else (0, 64)
    sizes = (64, 56, segments, 64, count, names)
    return b"\x7fELF\2\1\1" + bytes(9) + struct.pack("<HHIQQQI6H", 3, 62, 1, 0, table, other, 0, *sizes)


def section(kind=0, offset=256, size=1000, link=2, info=0) -> bytes:
    return struct.pack("<IIQQQQIIQQ", 0, kind, 0, 0, offset, size, link, info, 0, 24)


def symbols(count: int, length: int) -> bytes:
    names = b"\0" + b"a" * length + b"\0"
    table = b"".join(struct.pack("<IBBHQQ", 1 + i % 100, 0x10, 0, 0, 0, 0) for i in range(count))
    first = section() + section(11, 256 + len(names), len(table)) + section(3, 256, len(names))
    return head(3, names=2) + first + names + table


STRINGS = section(3, 256, 100)
HOSTILE = {
    "2^31 sections": head() + section(size=2**31, link=0) + section() * 10,
    "a dynamic section without an end": lambda: head(segments=1)
    + struct.pack("<IIQQQQQQ", 2, 4, 120, 0, 0, 2**40, 2**40, 8)
    + struct.pack("<QQ", 1, 5) * 400_000,
    "needed versions that lead back": head(3, names=2) + section(link=0) + section(0x6FFFFFFE, info=2**31) + STRINGS
    + struct.pack("<HHIII", 1, 65535, 0, 0, 0) + bytes(1000),
    "defined versions that lead back": head(3, names=2) + section(link=0) + section(0x6FFFFFFD, info=2**31) + STRINGS
    + struct.pack("<HHHHIII", 1, 0, 1, 65535, 0, 0, 0) + bytes(1000),
    "names that overlap": lambda: symbols(1000, 1_000_000),
    "2^31 symbols": head(3, names=2) + section() + section(11, size=24 * 2**31) + STRINGS + bytes(1000),
    "a table behind the end": head(3, names=2) + section() + section(11, 2**62, 24) + STRINGS + bytes(1000),
    "names without an end": lambda: (
        head(3, names=2) + section() + section(7) + section(3, 256, 2**40) + b"x" * 70_000_000
    ),
}  # fmt: skip


@pytest.mark.parametrize("data", HOSTILE.values(), ids=HOSTILE)
def test_what_a_file_claims_costs_a_second_at_most(data):
    data = data() if callable(data) else data
    began = time.process_time()
    found = read(data)
    elf.read_defined_symbols(data)
    assert time.process_time() - began < 5
    assert found is not None and found.machine == "EM_X86_64" and found.problem


def test_more_libraries_than_any_file_asks_for(made_elf):
    found = read(made_elf("EM_X86_64", [f"lib{n}.so.1" for n in range(3000)]))
    assert found is not None and len(found.needed) == 1000 and "more libraries" in found.problem


def test_a_name_that_gives_a_length_of_5000_digits():
    assert parse_symbol("_ZN1a" + "9" * 5000 + "bE") is not None
