"""System libraries: how Debian's packages of them are read, and what the shipped file answers."""

import pytest
from rosimpact.databuild.libraries import (
    HeaderFile,
    HeaderText,
    LibraryFacts,
    derive_library_name,
    find_include_path,
    find_refusal,
    parse_pkgconfig,
    read_cmake,
)
from rosimpact.databuild.library_file import write
from rosimpact.impact.facts.cpp.lexical import Include
from rosimpact.impact.facts.surface import HeaderSurface
from rosimpact.impact.targets.platform import find_neighbours
from rosimpact.impact.targets.providers.libraries import SystemLibraries, load_libraries
from rosimpact.impact.targets.snapshot import SnapshotError


@pytest.mark.parametrize(
    ("source", "library"),
    [
        ("boost1.74", "boost"),
        ("boost-defaults", "boost"),
        ("ogre-1.12", "ogre"),
        ("tinyxml2", "tinyxml2"),
        ("libusb-1.0", "libusb-1.0"),  # libusb is another one
        ("libusb", "libusb"),
    ],
)
def test_a_library_is_a_source_package_without_its_version(source, library):
    assert derive_library_name(source, {"boost1.74", "boost1.81", "libusb", "libusb-1.0", "tinyxml"}) == library


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("#error use new.h instead\n", "use new.h instead"),
        ('#ifndef OLD_H\n#define OLD_H\n#error "gone"\n#endif\n', "gone"),
        ("#pragma once\n#error gone\n", "gone"),
        ("#ifndef __cplusplus\n#error C++ only\n#endif\nclass A;\n", ""),
        ("#ifndef OLD_H\n#define OLD_H\n#include <new.h>\n#endif\n", ""),
        ("", ""),
    ],
)
def test_a_header_of_nothing_but_error_refuses_who_includes_it(text, message):
    assert find_refusal(text) == message


def test_a_pkg_config_file_names_what_it_links_and_where_headers_lie():
    text = b"prefix=/usr\nincludedir=${prefix}/include\nLibs: -L/usr/lib -lSDL2 -lm\nCflags: -I${includedir}/SDL2 -DX\n"
    assert parse_pkgconfig("usr/lib/x86_64-linux-gnu/pkgconfig/sdl2.pc", text) == ("sdl2", ("SDL2", "m"), ("SDL2",))


def test_cmake_files_name_configurations_targets_and_variables():
    config = b"set(YAML_CPP_LIBRARIES yaml-cpp)\nset(other 1)\n# add_library(no SHARED IMPORTED)\n"
    targets = b"add_library(yaml-cpp::yaml-cpp SHARED IMPORTED)\nadd_library(yaml-cpp ALIAS yaml-cpp::yaml-cpp)\n"
    folder = "usr/lib/cmake/yaml-cpp"
    names, found, is_open, variables = read_cmake(
        [(f"{folder}/yaml-cpp-config.cmake", config), (f"{folder}/yaml-cpp-targets.cmake", targets)]
    )
    assert (names, is_open, variables) == (("yaml-cpp",), False, ("YAML_CPP_LIBRARIES",))
    assert {target.name: target.kind for target in found} == {"yaml-cpp::yaml-cpp": "library", "yaml-cpp": "imported"}
    assert read_cmake([(f"{folder}/a.cmake", b"foreach(t x)\nadd_library(y::${t} SHARED IMPORTED)\n")])[2]


@pytest.mark.parametrize(
    ("path", "roots", "include"),
    [
        ("opencv4/opencv2/core.hpp", {"opencv4"}, "opencv2/core.hpp"),
        ("SDL2/SDL.h", {"SDL2"}, "SDL.h"),
        ("yaml-cpp/yaml.h", set(), "yaml-cpp/yaml.h"),
    ],
)
def test_headers_are_included_below_the_folders_that_flags_name(path, roots, include):
    assert find_include_path((path,), roots) == include


DEBIAN = ("debian bullseye", "debian bookworm", "debian trixie")


@pytest.mark.parametrize(
    ("platform", "expected"),
    [
        ("debian bookworm", ("debian bookworm", "debian bookworm")),
        ("ubuntu jammy", ("debian bullseye", "debian bookworm")),
        ("ubuntu focal", ("", "debian bullseye")),
        ("ubuntu resolute", ("debian trixie", "")),
        ("fedora 40", ("", "")),
    ],
)
def test_ubuntu_lies_between_two_releases_of_debian(platform, expected):
    assert find_neighbours(platform, DEBIAN) == expected


class Headers:
    """What headers hold; their hash is what they include."""

    def get(self, sha):
        includes = tuple(Include(path, False, 0, 0) for path in sha.split())
        return HeaderText(HeaderSurface((), includes=includes), ())


def release(version, headers, roots=()):
    """A library `arm` of one release. headers: by path, what they include."""
    listed = tuple(HeaderFile(path, includes, ("arm", "arm_core")) for path, includes in headers.items())
    return {"arm": LibraryFacts("arm", version, ("libarm-dev",), listed, roots, ("arm",), ("arm",), (), False, (), ())}


MANY = {f"arm/part{number:03}.h": "" for number in range(300)}
RELEASES = {
    "bullseye": release("1.0-1", {**MANY, "arm/arm.h": "part000.h arm/part001.h", "arm/old.h": ""}),
    "bookworm": release("1.2-1", {**MANY, "arm/arm.h": "part000.h core.h", "arm/core.h": ""}, ("arm-1.2",)),
    "trixie": release("2.0-1", {**MANY, "arm/arm.h": "arm/core.h"}),
    "sid": release("2.0-3", {**MANY, "arm/arm.h": "", "arm/new.h": ""}),
}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    file = tmp_path_factory.mktemp("libraries") / "libraries.sqlite"
    write(file, RELEASES, Headers())
    return SystemLibraries(file)


def test_a_written_file_tells_of_each_header_which_versions_have_it(written, monkeypatch):
    monkeypatch.setattr(
        SystemLibraries, "find_by_header", lambda self, header: "arm" if self.has("arm", header) else ""
    )
    assert written.list_versions("arm") == {
        "debian bullseye": "1.0", "debian bookworm": "1.2", "debian trixie": "2.0", "debian sid": "2.0"
    }  # fmt: skip
    assert written.build("arm", "1.2").include_dirs == ("arm-1.2",)
    names = ("arm/arm.h", "arm/part299.h", "arm-1.2/arm/core.h", "arm/new.h", "arm/part300.h", "arm.h", "zzz")
    assert [name for name in names if written.has("arm", name)] == list(names[:4])
    old, between = "debian bullseye", "ubuntu jammy"
    assert written.find_included("arm/arm.h", old).paths == ("arm/part000.h", "arm/part001.h")
    assert written.find_included("arm/arm.h", between).paths == ("arm/part000.h", "arm/part001.h", "arm/core.h")
    assert (
        written.find_included("arm/old.h", between).paths == ()
        and written.find_included("arm/old.h", "debian trixie") is None
    )


def test_a_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(SnapshotError, match=r"none\.sqlite: .*install rosimpact again"):
        SystemLibraries(tmp_path / "none.sqlite")


# -- what is shipped ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("target", "platform", "here", "lost"),
    [
        ("yaml-cpp::yaml-cpp", "ubuntu focal", False, False),
        ("yaml-cpp::yaml-cpp", "ubuntu jammy", False, False),
        ("yaml-cpp::yaml-cpp", "ubuntu noble", None, False),  # it came between Debian 12 and 13
        ("yaml-cpp::yaml-cpp", "debian trixie", True, False),
        ("fmt::fmt", "ubuntu jammy", True, False),
        ("fmt::fmt", "fedora 40", None, False),
    ],
)
def test_a_target_is_there_where_the_releases_around_a_platform_agree(target, platform, here, lost):
    found = load_libraries().find_target(target, platform, lambda library: None)
    assert found is not None and (found.here, found.lost) == (here, lost)


def test_a_version_that_was_read_tells_more_than_those_around_it():
    found = load_libraries().find_target("yaml-cpp::yaml-cpp", "ubuntu noble", {"yaml-cpp": "0.8.0"}.get)
    assert found is not None and found.here


def test_headers_of_ros_and_of_the_compiler_are_of_no_library():
    assert load_libraries().find_by_header("rclcpp/rclcpp.hpp") == load_libraries().find_by_header("stdio.h") == ""
