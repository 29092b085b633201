"""`rosimpact check --install`: built files of an install space against the libraries of machines."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

import pytest
from rosimpact.edges.limits import Limits
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.install_space import read_installed
from rosimpact.impact.targets.machine.loader import detect_machine

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>1.0.0</version>
  <description>{name}</description>
  <maintainer email="robots@example.org">Robots</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  {depends}
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = (
    "cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{more}ament_package()\n"
)


def workspace(folder: Path, *names: str, depends: dict[str, str] | None = None, more: str = "") -> Path:
    """A workspace with these packages in src/. depends: package to one that it depends on."""
    for name in names:
        place = folder / "src" / name
        place.mkdir(parents=True)
        on = (depends or {}).get(name)
        place.joinpath("package.xml").write_text(
            MANIFEST.format(name=name, depends=f"<depend>{on}</depend>" if on else "")
        )
        place.joinpath("CMakeLists.txt").write_text(CMAKE.format(name=name, more=more))
    return folder


def put(folder: Path, path: str, data: bytes = b"") -> Path:
    file = folder / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(data)
    return file


@pytest.fixture
def check(say):
    """Runs the check with this rule alone and gives (exit status, findings, coverage)."""

    def run(*arguments):
        said = say("check", *arguments, "--select", "stale-binary", "--format", "json", "--quiet")
        report = json.loads(said.out)
        return said.status, report["findings"], report["coverage"]

    return run


# Whose a file is

LAYOUTS = {
    "colcon, a folder for each package": (["winch/share/winch/package.xml"], "winch/lib/libropes.so", "winch"),
    "colcon, merged: a program": (["share/winch/package.xml", "share/crane/package.xml"], "lib/winch/run", "winch"),
    "merged: a library that says it": (
        ["share/winch/package.xml", "share/crane/package.xml"], "lib/libwinch__rosidl_typesupport_cpp.so", "winch"),
    "merged: a library of the package's name": (
        ["share/winch/package.xml", "share/crane/package.xml"], "lib/libcrane.so", "crane"),
    "merged: only the resource index names packages": (
        ["share/ament_index/resource_index/packages/winch", "share/ament_index/resource_index/packages/crane"],
        "lib/crane/run", "crane"),
    "a Python extension": (
        ["share/winch/package.xml", "share/crane/package.xml"],
        "lib/python3.10/site-packages/winch/_ropes.cpython-310-x86_64-linux-gnu.so", "winch"),
    "the prefix of one package": (["share/winch/package.xml"], "lib/libropes.so", "winch"),
    "nothing tells": (["share/winch/package.xml", "share/crane/package.xml"], "lib/libropes.so", ""),
}  # fmt: skip


@pytest.mark.parametrize(("marks", "path", "package"), LAYOUTS.values(), ids=LAYOUTS)
def test_whose_a_file_is(tmp_path, made_elf, marks, path, package):
    for mark in marks:
        put(tmp_path / "install", mark)
    put(tmp_path / "install", path, made_elf("EM_X86_64", ["libc.so.6"]))
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path / "install", store)
    assert [(binary.path, binary.package) for binary in found.binaries] == [(path, package)]


def test_whose_a_library_is_is_told_by_what_cmake_builds(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "winch", more="add_library(ropes SHARED ropes.cpp)\n")
    put(ws / "install", "lib/libropes.so", made_elf("EM_RISCV", ["libpcl_common.so.1.12"]))
    put(ws / "install", "share/crane/package.xml")
    _, findings, _ = check(ws, "--install", ws / "install", "--target", "jazzy")
    assert [finding["package"] for finding in findings] == ["winch"]


def test_whose_a_library_is_is_told_by_the_list_of_what_was_installed(tmp_path, made_elf):
    put(tmp_path, "build/winch/install_manifest.txt", f"{tmp_path}/install/lib/libropes.so\n".encode())
    put(tmp_path / "install", "lib/libropes.so", made_elf("EM_X86_64"))
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path / "install", store)
    assert [binary.package for binary in found.binaries] == ["winch"]


def test_links_of_a_devel_space_lead_to_the_package(tmp_path, made_elf):
    put(tmp_path / "devel", "share/winch/package.xml")
    put(tmp_path / "devel", "share/crane/package.xml")
    real = put(tmp_path / "devel", ".private/winch/lib/libropes.so", made_elf("EM_X86_64"))
    (tmp_path / "devel/lib").mkdir()
    (tmp_path / "devel/lib/libropes.so").symlink_to(real)
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path / "devel", store)
    assert [binary.package for binary in found.binaries] == ["winch"]  # and it counts once


# What is said


def test_one_finding_for_each_package_and_library_counts_the_files_and_gives_the_build_order(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "anchor", "winch", depends={"anchor": "winch"})
    for path in ("anchor/lib/anchor/one", "anchor/lib/anchor/two", "winch/lib/libwinch.so"):
        put(ws / "install", path, made_elf("EM_RISCV", ["libpcl_common.so.1.12"]))
    status, findings, _ = check(ws, "--install", ws / "install", "--target", "jazzy")
    assert status == 1
    assert [(f["package"], f["path"], f["subject"], f["message"], f["help"]) for f in findings] == [
        (
            "anchor",
            "src/anchor/package.xml",
            "libpcl_common.so.1.12",
            "`libpcl_common.so.1.12`, needed by `anchor/lib/anchor/one` and `anchor/lib/anchor/two`, "
            "is not available on ubuntu noble, which has `pcl 1.14.0`",
            "rebuild winch, anchor in this order",
        ),
        (
            "winch",
            "src/winch/package.xml",
            "libpcl_common.so.1.12",
            "`libpcl_common.so.1.12`, needed by `winch/lib/libwinch.so`, is not available on ubuntu noble, "
            "which has `pcl 1.14.0`",
            "rebuild winch, anchor in this order",
        ),
    ]


def test_a_library_of_the_install_space_is_there(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "winch")
    put(ws / "install", "winch/lib/libpcl_common.so.1.12", made_elf("EM_RISCV", soname="libpcl_common.so.1.12"))
    put(ws / "install", "winch/lib/winch/run", made_elf("EM_RISCV", ["libpcl_common.so.1.12"]))
    assert check(ws, "--install", ws / "install", "--target", "jazzy")[:2] == (0, [])


def test_what_a_target_may_have_is_counted_and_not_reported(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "winch")
    put(ws / "install", "winch/lib/winch/run", made_elf("EM_RISCV", ["libropes.so.7", "libpcl_common.so.1.14"]))
    status, findings, coverage = check(ws, "--install", ws / "install", "--target", "jazzy")
    assert (status, findings, coverage["unresolved"]) == (0, [], {"shared library": 1})


def test_files_for_another_kind_of_machine_are_not_checked_against_this_one(tmp_path, made_elf, say):
    ws = workspace(tmp_path, "winch")
    put(ws / "install", "winch/lib/winch/run", made_elf("EM_RISCV", ["libropes.so.7"]))
    said = say("check", ws, "--install", ws / "install", "--target", "jazzy", "--notes")
    assert "1 file built for riscv, not checked against this machine" in said.out
    assert "stale-binary" not in said.out


def test_a_sourced_target_is_this_machine(tmp_path, made_elf, say, monkeypatch):
    release = Path("/etc/os-release").read_text() if Path("/etc/os-release").exists() else ""
    codename = re.search(r"VERSION_CODENAME=(\w+)", release)
    if not codename or "ID=debian" not in release.splitlines():
        pytest.skip("not on Debian: its name stands in the test's rosimpact.toml")
    ws = workspace(tmp_path, "winch")
    put(ws, "rosimpact.toml", f'[targets.jazzy]\ndistro = "jazzy"\nplatform = "debian {codename[1]}"\n'.encode())
    put(ws / "install", "winch/lib/winch/run", made_elf(detect_machine(), ["libropes.so.7", "libc.so.6"]))
    arguments = ("check", ws, "--install", ws / "install", "--config", ws / "rosimpact.toml", "--target", "jazzy",
                 "--select", "stale-binary", "--format", "json")  # fmt: skip
    alone = json.loads(say(*arguments).out)
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    sourced = json.loads(say(*arguments).out)
    assert [t["name"] for t in alone["targets"]] == ["jazzy", "this machine"]
    assert [t["name"] for t in sourced["targets"]] == ["jazzy"]
    assert [f["targets"] for report in (alone, sourced) for f in report["findings"]] == [["this machine"], ["jazzy"]]


@pytest.mark.parametrize("format", ["text", "json", "sarif", "github", "markdown", "html"])
def test_every_format_takes_a_finding_on_this_machine(tmp_path, made_elf, say, format):
    ws = workspace(tmp_path, "winch")
    put(ws / "install", "winch/lib/winch/run", made_elf(detect_machine(), ["libropes.so.7"]))
    said = say("check", ws, "--install", ws / "install", "--target", "jazzy", "--format", format)
    assert said.status == 1 and "libropes.so.7" in said.out and "failed" not in said.err


def test_what_lies_beside_the_prefix_of_one_package_is_there(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "winch")
    machine = detect_machine()
    put(ws / "install", "winch/share/winch/package.xml")
    put(ws / "install", "crane/lib/libcrane.so.1", made_elf(machine, soname="libcrane.so.1"))
    put(ws / "install", "winch/lib/winch/run", made_elf(machine, ["libcrane.so.1", "libhook.so.1"]))
    _, findings, _ = check(ws, "--install", ws / "install/winch", "--target", "jazzy")
    assert [finding["subject"] for finding in findings] == ["libhook.so.1"]


def test_with_a_base_a_stale_file_is_still_said(tmp_path, made_elf, check):
    ws = workspace(tmp_path, "winch")
    put(ws, ".gitignore", b"install\n")
    for command in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "All"]):
        identity = ["-c", "user.name=Robots", "-c", "user.email=robots@example.org"]
        subprocess.run(["git", *identity, *command], cwd=ws, check=True)
    put(ws / "install", "winch/lib/winch/run", made_elf("EM_RISCV", ["libpcl_common.so.1.12"]))
    status, findings, _ = check(ws, "--install", ws / "install", "--target", "jazzy", "--base", "HEAD")
    assert (status, [finding["new"] for finding in findings]) == (1, [True])


# What cannot be read

WRONG = {
    "no such folder": ("nowhere", "there is no such folder; give the install or devel folder of a built workspace"),
    "a file": ("src/winch/package.xml", "is a file; give the install or devel folder of a built workspace"),
    "nothing built": ("src", "holds no built program or library (no ELF file); build the workspace first"),
}


@pytest.mark.parametrize(("folder", "message"), WRONG.values(), ids=WRONG)
def test_a_wrong_folder_is_named(tmp_path, say, folder, message):
    ws = workspace(tmp_path, "winch")
    said = say("check", ws, "--install", ws / folder)
    assert said.status == 2
    assert f"--install {ws / folder}: {message}" in said.err
    assert said.err.count("\n") == 1


def test_damaged_files_are_listed_and_the_others_checked(tmp_path, made_elf, say):
    ws = workspace(tmp_path, "winch")
    put(ws / "install", "winch/lib/winch/run", made_elf("EM_RISCV", ["libpcl_common.so.1.12"]))
    put(ws / "install", "winch/lib/libwinch.so", made_elf("EM_RISCV")[:100])
    said = say("check", ws, "--install", ws / "install", "--target", "jazzy", "--notes")
    assert "install/winch/lib/libwinch.so" in said.out and "no ELF file that can be read to its end" in said.out
    assert "error[stale-binary]" in said.out


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads everything")
def test_a_file_that_may_not_be_read_is_listed(tmp_path, made_elf):
    put(tmp_path, "lib/libwinch.so", made_elf("EM_X86_64"))
    put(tmp_path, "lib/libcrane.so", made_elf("EM_X86_64")).chmod(0)
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path, store)
    assert [problem.message for problem in found.problems] == ["cannot be read: permission denied"]


def test_a_second_run_reads_no_file_anew(tmp_path, made_elf, monkeypatch):
    put(tmp_path / "install", "lib/libwinch.so", made_elf("EM_X86_64", ["libc.so.6"]))
    first = read_installed(tmp_path / "install", Store(tmp_path / "cache"))
    monkeypatch.setattr("rosimpact.impact.facts.elf.read", lambda data: pytest.fail("read again"))
    assert read_installed(tmp_path / "install", Store(tmp_path / "cache")) == first


# The real thing


@pytest.fixture
def gcc():
    compiler = shutil.which("gcc")
    if compiler is None:
        pytest.skip("no gcc: install it to build what is then made stale")

    def run(folder: Path, *arguments: str) -> None:
        subprocess.run([compiler, *arguments], cwd=folder, check=True, capture_output=True)

    return run


def test_a_program_goes_stale_when_its_library_is_replaced(tmp_path, gcc, check, monkeypatch):
    system = tmp_path / "system"
    system.mkdir()
    ws = workspace(tmp_path / "ws", "winch")
    (ws / "install/winch/lib/winch").mkdir(parents=True)
    (system / "foo.c").write_text("int foo(void) { return 0; }\n")
    (system / "main.c").write_text("int foo(void);\nint main(void) { return foo(); }\n")
    gcc(system, "-shared", "-fPIC", "-Wl,-soname,libfoo.so.1", "-o", "libfoo.so.1", "foo.c")
    gcc(system, "-o", str(ws / "install/winch/lib/winch/run"), "main.c", "./libfoo.so.1")
    monkeypatch.setenv("LD_LIBRARY_PATH", str(system))
    program = [ws / "install/winch/lib/winch/run"]
    assert subprocess.run(program, check=False).returncode == 0
    assert check(ws, "--install", ws / "install")[:2] == (0, [])

    (system / "libfoo.so.1").unlink()
    gcc(system, "-shared", "-fPIC", "-Wl,-soname,libfoo.so.2", "-o", "libfoo.so.2", "foo.c")
    assert subprocess.run(program, check=False, capture_output=True).returncode == 127  # what ld.so ends with
    status, (finding,), _ = check(ws, "--install", ws / "install")
    assert (status, finding["package"], finding["targets"], finding["help"]) == (
        1, "winch", ["this machine"], "rebuild winch")  # fmt: skip
    assert finding["message"] == (
        "`libfoo.so.1`, needed by `winch/lib/winch/run`, is not available on this machine, which has `libfoo.so.2`"
    )


def test_a_version_of_a_symbol_that_the_library_lost_is_reported(tmp_path, gcc, check, monkeypatch):
    system = tmp_path / "system"
    system.mkdir()
    ws = workspace(tmp_path / "ws", "winch")
    (ws / "install/winch/lib/winch").mkdir(parents=True)
    (system / "foo.c").write_text("int foo(void) { return 0; }\n")
    (system / "main.c").write_text("int foo(void);\nint main(void) { return foo(); }\n")
    for version in ("FOO_1.2", "FOO_1.1"):
        (system / "foo.map").write_text(version + " { global: foo; };\n")
        gcc(system, "-shared", "-fPIC", "-Wl,-soname,libfoo.so.1", "-Wl,--version-script=foo.map", "-o", "libfoo.so.1",
            "foo.c")  # fmt: skip
        if version == "FOO_1.2":
            gcc(system, "-o", str(ws / "install/winch/lib/winch/run"), "main.c", "./libfoo.so.1")
    monkeypatch.setenv("LD_LIBRARY_PATH", str(system))
    _, (finding,), _ = check(ws, "--install", ws / "install")
    assert finding["message"] == (
        "`FOO_1.2` of `libfoo.so.1`, needed by `winch/lib/winch/run`, is not available on this machine, "
        "which has `FOO_1.1`"
    )


def test_a_library_that_is_asked_for_by_its_path_is_looked_for_beside_the_file(tmp_path, gcc, check):
    ws = workspace(tmp_path / "ws", "winch")
    program = ws / "install/winch/lib/winch/run"
    (program.parent / "own").mkdir(parents=True)
    (tmp_path / "foo.c").write_text("int foo(void) { return 0; }\n")
    (tmp_path / "main.c").write_text("int foo(void);\nint main(void) { return foo(); }\n")
    library = program.parent / "own/libfoo.so"
    gcc(tmp_path, "-shared", "-fPIC", "-Wl,-soname,$ORIGIN/own/libfoo.so", "-o", str(library), "foo.c")
    gcc(tmp_path, "-o", str(program), "main.c", str(library))
    assert subprocess.run([program], check=False).returncode == 0
    assert check(ws, "--install", ws / "install")[:2] == (0, [])

    library.unlink()
    status, (finding,), _ = check(ws, "--install", ws / "install")
    assert (status, finding["subject"]) == (1, "$ORIGIN/own/libfoo.so")


@pytest.mark.parametrize("kind", ["program", "plugin"])
def test_a_function_that_a_library_lost_is_reported(kind, tmp_path, gcc, check, monkeypatch):
    system = tmp_path / "system"
    system.mkdir()
    ws = workspace(tmp_path / "ws", "winch")
    built = ws / "install/winch/lib/winch" / ("run" if kind == "program" else "libplugin.so")
    built.parent.mkdir(parents=True)
    (system / "main.cpp").write_text(
        "namespace rope { struct Drum { Drum(); int turn(int); int length(); }; }\n"
        "int host();\n"
        + ("int host() { return 0; }\n" if kind == "program" else "")
        + "int main() { return rope::Drum().turn(1) + rope::Drum().length() + host(); }\n"
    )
    for arguments in ("int", "double"):  # the second is built after the program, and takes another argument
        (system / "drum.cpp").write_text(
            f"namespace rope {{ struct Drum {{ Drum(); int turn({arguments}); int length(); }}; }}\n"
            "rope::Drum::Drum() {}\n"
            f"int rope::Drum::turn({arguments}) {{ return 0; }}\nint rope::Drum::length() {{ return 0; }}\n"
        )
        gcc(system, "-shared", "-fPIC", "-Wl,-soname,libdrum.so", "-o", "libdrum.so", "drum.cpp")
        if arguments == "int":
            how = () if kind == "program" else ("-shared", "-fPIC")
            gcc(system, *how, "-o", str(built), "main.cpp", "./libdrum.so")
            monkeypatch.setenv("LD_LIBRARY_PATH", str(system))
            assert check(ws, "--install", ws / "install")[:2] == (0, [])  # host() may be the plugin's host's
    _, (finding,), _ = check(ws, "--install", ws / "install")
    assert (finding["severity"], finding["subject"], finding["help"]) == ("error", "rope::Drum::turn", "rebuild winch")
    assert finding["message"] == (
        f"`rope::Drum::turn` of `libdrum.so`, needed by `winch/lib/winch/{built.name}`, "
        "is not found in any library that is loaded"
    )


def test_what_runs_on_this_machine_gives_no_finding(tmp_path, check):
    """The programs of this system itself, a hundred of them."""
    ws = workspace(tmp_path, "winch")
    (ws / "install/winch/lib/winch").mkdir(parents=True)
    count = 0
    for program in sorted(Path("/usr/bin").iterdir()):
        if count < 100 and program.is_file() and not program.is_symlink():
            with program.open("rb") as file:
                if file.read(4) == b"\x7fELF":
                    count += 1
                    (ws / "install/winch/lib/winch" / program.name).symlink_to(program)
    if not count:
        pytest.skip("no built programs in /usr/bin")
    _, findings, _ = check(ws, "--install", ws / "install")
    assert [finding["message"] for finding in findings if "this machine" in finding["targets"]] == []


# What lies in an install space that nobody built


def strange(folder: Path, made_elf) -> None:
    """Files of every kind beside two good libraries, one with a name that is no UTF-8."""
    put(folder, "lib/libgood.so", made_elf("EM_X86_64", ["libc.so.6"], "libgood.so"))
    with open(os.fsencode(folder) + b"/lib/lib\xff\n::error::x.so", "wb") as file:
        file.write(made_elf("EM_X86_64", ["libm.so.6"]))
    with open(folder / "lib/libsparse.so", "wb") as file:
        file.write(made_elf("EM_X86_64", []))
        file.truncate(3 << 30)
    os.mkfifo(folder / "lib/libpipe.so")
    os.symlink("/dev/zero", folder / "lib/libzero.so")
    os.symlink("libloop.so", folder / "lib/libloop.so")
    os.symlink("..", folder / "lib/up")
    put(folder, "lib/libtext.so", b"INPUT(libreal.so)")
    put(folder, "lib/libcut.so", made_elf("EM_X86_64", ["liba.so.1"])[:80])
    os.mkfifo(folder / "setup.sh")
    os.symlink("/dev/zero", folder / "_setup_util.py")


def test_what_is_no_built_file_costs_itself_only(tmp_path, made_elf):
    strange(tmp_path / "install", made_elf)
    began = time.monotonic()
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path / "install", store, jobs=1)
    assert time.monotonic() - began < 10
    assert [binary.elf.needed for binary in found.binaries] == [("libc.so.6",), ("libm.so.6",)]
    problems = {problem.path.rpartition("/")[2]: problem.message for problem in found.problems}
    assert problems.keys() == {"libcut.so", "libsparse.so"}
    assert problems["libsparse.so"] == "cannot be read: larger than 512 mb"


def test_what_is_no_built_file_is_checked_around(tmp_path, made_elf, say):
    workspace(tmp_path, "winch")
    strange(tmp_path / "install", made_elf)
    for format in ("text", "json", "github", "html"):
        said = say("check", tmp_path, "--install", tmp_path / "install", "--format", format, "--target", "jazzy")
        assert said.status in (0, 1), said.err
        assert not re.search(r"(?m)^::error::x", said.out + said.err)


def test_a_tree_of_more_files_or_folders_than_its_limits(tmp_path, made_elf, monkeypatch):
    monkeypatch.setattr("rosimpact.impact.model.install_space.get_limits", lambda: Limits(entries=20, depth=5))
    put(tmp_path, "a/liba.so", made_elf("EM_X86_64", []))
    put(tmp_path, "b/" + "deep/" * 9 + "libb.so", made_elf("EM_X86_64", []))
    for n in range(30):
        put(tmp_path, f"c/{n}")
    put(tmp_path, "d/libd.so", made_elf("EM_X86_64", []))
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path, store, jobs=1)
    assert [binary.path for binary in found.binaries] == ["a/liba.so"]
    assert [problem.message for problem in found.problems] == [
        "cannot be read: folders nested deeper than 5",
        "cannot be read: more than 20 files, the others are left out",
    ]


def test_where_its_own_libraries_are_found(tmp_path, made_elf):
    put(tmp_path, "arm/lib/liba.so.1.2", made_elf("EM_X86_64", [], "liba.so.1"))
    put(tmp_path, "arm/lib/arm/reach", made_elf("EM_X86_64", []))
    with Store(tmp_path / "cache") as store:
        places = read_installed(tmp_path, store, jobs=1).places
    there = str(tmp_path / "arm/lib/liba.so.1.2")
    assert places == {"liba.so.1.2": there, "liba.so.1": there}


@pytest.mark.parametrize(
    ("folder", "file", "text", "underlays"),
    [
        ("", "setup.sh", 'COLCON_CURRENT_PREFIX="/opt/ros/jazzy"\n. a\nCOLCON_CURRENT_PREFIX="/home/me/base"\n',
         ["/opt/ros/jazzy", "/home/me/base"]),
        ("", "setup.sh", '# COLCON_CURRENT_PREFIX="/a"\nCOLCON_CURRENT_PREFIX="$PREFIX"\n', []),
        ("", "_setup_util.py", "CMAKE_PREFIX_PATH = r'/opt/ros/noetic;;/home/me/devel'",
         ["/opt/ros/noetic", "/home/me/devel"]),
        ("arm", "setup.sh", 'COLCON_CURRENT_PREFIX="/opt/ros/jazzy"', ["{around}", "/opt/ros/jazzy"]),
    ],
)  # fmt: skip
def test_prefixes_that_setup_files_name(tmp_path, made_elf, folder, file, text, underlays):
    put(tmp_path, "arm/share/arm/liba.so", made_elf("EM_X86_64", []))
    put(tmp_path, file, text.encode())
    with Store(tmp_path / "cache") as store:
        found = read_installed(tmp_path / folder, store, jobs=1).underlays
    assert list(found) == [each.format(around=tmp_path) for each in underlays]


def test_prefixes_that_setup_files_name_have_a_limit(tmp_path, made_elf):
    put(tmp_path, "lib/liba.so", made_elf("EM_X86_64", []))
    put(tmp_path, "_setup_util.py", b"CMAKE_PREFIX_PATH = '" + b";".join(b"/%d" % n for n in range(9999)) + b"'")
    with Store(tmp_path / "cache") as store:
        assert len(read_installed(tmp_path, store, jobs=1).underlays) == 100
