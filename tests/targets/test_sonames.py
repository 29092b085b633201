"""Which platform has which shared library: the shipped table, the reviewed rows, and how the table is made."""

from __future__ import annotations

from pathlib import Path

import pytest
from rosimpact.databuild.sonames import SuiteLibraries, build_table, parse_libraries, parse_symbols
from rosimpact.impact.facts.elf import AskedSymbolVersions, Elf
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.machine.loader import Loader
from rosimpact.impact.targets.machine.shared_libraries import DescribedLibraries, InstalledLibraries
from rosimpact.impact.targets.machine.sonames import load_sonames, parse_numbers

SONAMES = load_sonames()
ASKER = Elf(machine="EM_X86_64", bits=64)
DEBIAN = ("debian bullseye", "debian bookworm", "debian trixie")

# soname: whether Debian 11, 12 and 13 have it (None: nobody can tell)
KNOWN = {
    "libpcl_common.so.1.11": (True, False, False),
    "libpcl_common.so.1.13": (False, True, False),
    "libopencv_core.so.406": (False, True, False),
    "libboost_thread.so.1.74.0": (True, True, False),
    "libyaml-cpp.so.0.8": (False, False, True),
    "libconsole_bridge.so.1.0": (False, True, True),
    "libblas.so.3": (True, True, True),  # an alternative, in a folder of its own
    "libropes.so.7": (None, None, None),
    "librclcpp.so": (None, None, None),
}


@pytest.mark.parametrize(("soname", "expected"), KNOWN.items())
def test_debian_has(soname, expected):
    assert tuple(SONAMES.has(platform, soname) for platform in DEBIAN) == expected


def test_of_a_platform_without_a_file_list_nothing_is_known():
    assert SONAMES.has("ubuntu jammy", "libpcl_common.so.1.11") is None


LOADERS = {"ld-linux-aarch64.so.1", "ld-linux-armhf.so.3"}  # of machines whose packages the index does not hold


@pytest.mark.parametrize("soname", [name for name in SONAMES.reviewed.everywhere if name not in LOADERS])
def test_what_is_reviewed_as_everywhere_is_in_every_index(soname):
    assert [SONAMES.has(platform, soname) for platform in DEBIAN] == [True] * len(DEBIAN)


@pytest.mark.parametrize("soname", ["libnvme.so.1", "libnvcore.so.2", "libcue.so.2", "libtorrent.so.21"])
def test_makers_libraries_are_not_mistaken_for_debians_own(soname):
    assert not soname.startswith(SONAMES.reviewed.elsewhere)
    assert any(SONAMES.has(platform, soname) is not None for platform in DEBIAN)


def test_what_is_there_instead_comes_shortest_first():
    assert SONAMES.list_others("debian bookworm", "libpcl_common.so.1.11") == [
        "libpcl_common.so.1.13",
        "libpcl_common.so.1.13.0",
    ]
    assert SONAMES.find_package("libpcl_common.so.1.13") == "libpcl-common1.13"


@pytest.mark.parametrize("library", SONAMES.reviewed.libraries)
@pytest.mark.parametrize("platform", DEBIAN)
def test_reviewed_libraries_count_as_the_file_lists_do(library, platform):
    """Every soname that Debian has of such a library fits the version that it has of it, and those of other releases
    fit it only where the numbers agree: so platforms without a file list may be judged by the version alone."""
    version = DistroTarget("noetic", None, platform).find_library(library)
    assert version
    own = [name for name in SONAMES.list_names(platform) if SONAMES.find_family(name) == library]
    assert own and [name for name in own if SONAMES.fits(name, version) is False] == []
    for other in DEBIAN:
        for name in SONAMES.list_names(other):
            if SONAMES.find_family(name) == library and SONAMES.fits(name, version) is False:
                assert SONAMES.has(platform, name) is False


@pytest.mark.parametrize(
    ("version", "numbers"), [("1.12", [1, 12]), ("4.5d", [4, 5]), ("406", [4, 6]), ("410", [4, 10]), ("2", [2])]
)
def test_numbers_of_a_soname(version, numbers):
    assert parse_numbers(version) == numbers


REACH = [*zip(DEBIAN, ("2.31", "2.36", "2.41"), ("3.4.28", "3.4.30", "3.4.33"), strict=True), ("ubuntu jammy", "", "")]


@pytest.mark.parametrize(("platform", "glibc", "glibcxx"), REACH)
def test_how_far_the_versions_of_symbols_reach(platform, glibc, glibcxx):
    assert (SONAMES.reach(platform, "GLIBC"), SONAMES.reach(platform, "GLIBCXX")) == (glibc, glibcxx)


# A machine that is described

DESCRIBED = [
    # distro, platform, soname, there
    ("humble", None, "libpcl_common.so.1.12", True),
    ("humble", None, "libpcl_common.so.1.13", False),
    ("humble", None, "libopencv_core.so.4.5d", True),
    ("humble", None, "libopencv_core.so.406", False),
    ("humble", None, "libboost_thread.so.1.71.0", None),  # a platform may have several versions of Boost
    ("humble", None, "libyaml-cpp.so.0.6", None),  # yaml_cpp_vendor may bring it
    ("humble", None, "libc.so.6", True),
    ("humble", None, "librclcpp.so", True),
    ("humble", None, "libstd_msgs__rosidl_typesupport_cpp.so", True),
    ("humble", None, "libcompany_secret.so", None),
    ("humble", None, "libpcl_company.so.3", None),  # not one of PCL's own
    ("noetic", "debian trixie", "libboost_thread.so.1.74.0", False),
    ("noetic", "debian trixie", "libboost_thread.so.1.83.0", True),
    ("noetic", "debian trixie", "liburdfdom_model.so.3.0", None),  # the package urdfdom may bring it
    ("noetic", "debian trixie", "libgazebo.so.9", None),  # its makers have an archive of their own
]


@pytest.mark.parametrize(("distro", "platform", "soname", "there"), DESCRIBED)
def test_what_a_described_machine_has(distro, platform, soname, there):
    libraries = DescribedLibraries(DistroTarget(distro, None, platform), SONAMES)
    assert libraries.has(soname, ASKER, "") is there


def test_a_version_of_ones_own_goes_over_that_of_the_platform():
    own = DescribedLibraries(DistroTarget("noetic", None, "debian bookworm", {"opencv": "4.9.0"}), SONAMES)
    assert [own.has(f"libopencv_core.so.{n}", ASKER, "") for n in ("409", "410")] == [True, False]


def test_what_an_underlay_has_is_there():
    libraries = DescribedLibraries(
        DistroTarget("humble"), SONAMES, own={"libpcl_common.so.1.9"}, near={"libpcl_ml.so.1.9"}
    )
    assert [libraries.has(f"libpcl_{name}.so.1.9", ASKER, "") for name in ("common", "ml", "io")] == [True, None, False]


LACKS = [
    ("humble", None, "libc.so.6", ("GLIBC_2.34", "GLIBC_2.35"), []),
    ("humble", None, "libc.so.6", ("GLIBC_2.34", "GLIBC_2.38"), [("GLIBC_2.38", "GLIBC_2.35")]),
    ("noetic", "debian bullseye", "libstdc++.so.6", ("GLIBCXX_3.4.29",), [("GLIBCXX_3.4.29", "GLIBCXX_3.4.28")]),
    ("noetic", "debian bookworm", "libstdc++.so.6", ("GLIBCXX_3.4.30", "CXXABI_1.3.13"), []),
    ("humble", None, "libstdc++.so.6", ("GLIBCXX_3.4.40",), []),  # no list of Ubuntu's files: not known
]


@pytest.mark.parametrize(("distro", "platform", "library", "versions", "lacking"), LACKS)
def test_versions_of_symbols_that_a_described_machine_lacks(distro, platform, library, versions, lacking):
    libraries = DescribedLibraries(DistroTarget(distro, None, platform), SONAMES)
    assert [tuple(lack) for lack in libraries.lacks(AskedSymbolVersions(library, versions), ASKER, "") or ()] == lacking


# This machine


@pytest.fixture
def root(tmp_path: Path, made_elf) -> Path:
    """A small system: one library in a standard folder, one in the loader's cache, one that lies about."""
    for path, soname in (
        ("usr/lib/x86_64-linux-gnu/libropes.so.7", "libropes.so.7"),
        ("opt/maker/lib/libhook.so.1", "libhook.so.1"),
        ("usr/lib/host/plugins/libplug.so.3", "libplug.so.3"),
    ):
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(made_elf("EM_X86_64", soname=soname))
    return tmp_path


@pytest.mark.parametrize(
    ("soname", "machine", "there"),
    [
        ("libropes.so.7", "EM_X86_64", True),
        ("libhook.so.1", "EM_X86_64", True),
        ("libplug.so.3", "EM_X86_64", None),
        ("libropes.so.6", "EM_X86_64", False),
    ],
)
def test_what_this_machine_has(root, soname, machine, there):
    listing = f"1 libs found in cache\n\tlibhook.so.1 (libc6,x86-64) => {root}/opt/maker/lib/libhook.so.1\n"
    loader = Loader((), root, {}, lambda command: listing)
    libraries = InstalledLibraries("robot", loader, "EM_X86_64", "debian bookworm", SONAMES)
    assert libraries.has(soname, Elf(machine=machine, bits=64), "") is there


def test_a_library_without_a_version_is_missed_where_prefixes_are_known(root):
    alone, sourced = (Loader(folders, root, {}, lambda command: "") for folders in ((), (str(root / "opt/ros/lib"),)))
    shared_libraries = [InstalledLibraries(
        "robot", loader, "EM_X86_64", "debian bookworm", SONAMES
    ) for loader in (alone, sourced)]
    assert [libraries.has("librclcpp.so", ASKER, "") for libraries in shared_libraries] == [None, False]


def test_the_files_own_search_folders_count(root, made_elf):
    (root / "ws/lib").mkdir(parents=True)
    (root / "ws/bin").mkdir()
    (root / "ws/lib/libsled.so.1").write_bytes(made_elf("EM_X86_64"))
    loader = Loader((), root, {}, lambda command: "")
    asker = Elf(machine="EM_X86_64", bits=64, search=("$ORIGIN/../lib",))
    assert loader.find("libsled.so.1", asker, str(root / "ws/bin")) == f"{root}/ws/bin/../lib/libsled.so.1"
    assert loader.find("libsled.so.1", ASKER, str(root / "ws/bin")) == ""


def test_a_library_for_another_kind_of_machine_is_none(root, made_elf):
    (root / "usr/lib/libropes.so.9").write_bytes(made_elf("EM_AARCH64"))
    assert Loader((), root, {}, lambda command: "").find("libropes.so.9", ASKER) == ""


def test_what_can_be_installed_is_named():
    libraries = InstalledLibraries(
        "robot", Loader((), Path("/nowhere"), {}, lambda c: ""), "", "debian bookworm", SONAMES
    )
    assert libraries.find_package("libpcl_common.so.1.13") == "libpcl-common1.13"
    assert libraries.find_package("libpcl_common.so.1.11") == ""


# How the table is made

CONTENTS = b"""\
bin/bash                                                shells/bash
lib/x86_64-linux-gnu/libz.so.1                          libs/zlib1g
usr/lib/x86_64-linux-gnu/libropes.so                    libdevel/libropes-dev
usr/lib/x86_64-linux-gnu/libropes.so.7                  libs/libropes7,libs/libropes7-nox
usr/lib/x86_64-linux-gnu/knots/libknot.so.2             non-free/libs/libknot2
usr/lib/debug/usr/lib/libropes.so.6                     debug/libropes-dbg
usr/share/gdb/auto-load/usr/lib/libropes.so.7-gdb.py    libs/libropes7
"""


def test_versioned_libraries_of_an_index():
    assert parse_libraries(CONTENTS.splitlines()) == {
        "libz.so.1": "zlib1g", "libropes.so.7": "libropes7", "libknot.so.2": "libknot2",
    }  # fmt: skip


def test_how_far_symbols_reach_is_told_by_the_package_and_the_file():
    packages = b"Package: libc6\nVersion: 2.36-9+deb12u7\n\nPackage: zlib1g\nVersion: 1:1.2\n"
    libraries = {
        "libstdc++.so.6.0.30": "libstdc++6",
        "libstdc++.so.6.0.99": "gcc-snapshot",
        "libstdc++.so.6": "libstdc++6",
    }
    assert parse_symbols(libraries, packages.splitlines()) == {"GLIBC": "2.36", "GLIBCXX": "3.4.30"}


def test_a_table_says_which_platforms_have_a_library():
    table = build_table(
        [SuiteLibraries(
            "one", {"a.so.1": "a1"}, {}
        ), SuiteLibraries("two", {"a.so.1": "a1x", "b.so.2": "b2"}, {"GLIBC": "2"})]
    )
    assert table.names.splitlines() == ["a.so.1 3 a1x", "b.so.2 2 b2"]
    assert (table.platforms, table.symbols) == (("one", "two"), ({}, {"GLIBC": "2"}))
