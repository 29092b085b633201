"""What an installed package offers: from a prefix and from Debian packages, in the form that its sources give."""

import io
import lzma
import os
import tarfile

import pytest
from rosimpact.databuild.surface.clones import VersionError
from rosimpact.databuild.surface.compare import RepositorySurfaces, compare
from rosimpact.databuild.surface.installed import is_installed, read_surface
from rosimpact.databuild.surface.package import build_surfaces
from rosimpact.impact.facts.store import Store
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>arm</name><version>1.2.0</version><description>d</description>
<maintainer email="a@example.com">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<depend>rclcpp</depend><export><build_type>ament_cmake</build_type></export></package>"""
HEADER = "#pragma once\nnamespace arm\n{\nclass Gripper\n{\npublic:\n  void close(double force = 1.0);\n};\n}\n"
LAUNCH = '<launch><arg name="speed" default="3"/><arg name="name"/></launch>'
INSTALLED = {
    "share/arm/package.xml": MANIFEST,
    "share/arm/cmake/armConfig.cmake": "# made by ament",
    "share/arm/cmake/export_armExport.cmake": "add_library(arm::arm SHARED IMPORTED)\n",
    "share/arm/cmake/ament_cmake_export_dependencies-extras.cmake": 'set(_exported_dependencies "rclcpp")\n',
    "share/arm/msg/Grip.msg": "float64 force  # in newton\n",
    "share/arm/msg/Grip.idl": "// the same",
    "share/arm/launch/arm.launch.xml": LAUNCH,
    "include/arm/arm/gripper.hpp": HEADER,
    "include/arm/arm/msg/grip.hpp": "// generated from rosidl_generator_cpp/resource/idl.hpp.em\nstruct Grip {};\n",
    "lib/arm/arm_node": "\x7fELF",
    "lib/arm/helper.txt": "",
    "lib/python3.12/site-packages/arm/__init__.py": "def open(width, slow=False):\n    pass\n",
    "lib/python3.12/site-packages/arm/msg/__init__.py": "from arm.msg._grip import Grip\n",
    "lib/python3.12/site-packages/arm/_arm.cpython-312-x86_64-linux-gnu.so": "\x7fELF",
    # Another package in the same prefix.
    "share/leg/package.xml": MANIFEST.replace("arm", "leg"),
    "include/leg/leg/knee.hpp": "void bend();\n",
}
SOURCES = {
    "arm/package.xml": MANIFEST,
    "arm/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
find_package(ament_cmake_python REQUIRED)
find_package(rclcpp REQUIRED)
add_library(arm src/gripper.cpp)
add_executable(arm_node src/node.cpp)
install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
install(TARGETS arm EXPORT export_arm)
install(TARGETS arm_node DESTINATION lib/${PROJECT_NAME})
ament_python_install_package(arm)
ament_export_targets(export_arm NAMESPACE arm::)
ament_export_dependencies(rclcpp)
ament_package()
""",
    "arm/include/arm/gripper.hpp": HEADER,
    "arm/src/gripper.cpp": "",
    "arm/src/node.cpp": "int main() {}\n",
    "arm/launch/arm.launch.xml": LAUNCH,
    "arm/arm/__init__.py": "def open(width, slow=False):\n    pass\n",
}


def put(folder, files):
    for path, text in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="latin-1")
        if path.startswith("lib/arm/arm_node"):
            file.chmod(0o755)
    return folder


@pytest.fixture
def installed(tmp_path):
    return put(tmp_path / "opt/ros/jazzy", INSTALLED)


def deb(file, files, packed=lzma.compress, name="data.tar.xz"):
    """Writes a Debian package that installs files below opt/ros/jazzy."""
    archive = io.BytesIO()
    with tarfile.open(fileobj=archive, mode="w") as tar:
        for path, text in files.items():
            entry = tarfile.TarInfo(f"./opt/ros/jazzy/{path}")
            entry.size, entry.mode = len(text.encode("latin-1")), 0o755 if path.endswith("_node") else 0o644
            tar.addfile(entry, io.BytesIO(text.encode("latin-1")))
        link = tarfile.TarInfo("./opt/ros/jazzy/include/arm/arm/same.hpp")
        link.type, link.linkname = tarfile.SYMTYPE, "gripper.hpp"
        tar.addfile(link)
    parts = (("debian-binary", b"2.0\n"), (name, packed(archive.getvalue())))
    data = b"!<arch>\n"
    for part, content in parts:
        data += f"{part:<16}{0:<12}{0:<6}{0:<6}{'100644':<8}{len(content):<10}`\n".encode() + content
        data += b"\n" * (len(content) % 2)
    file.write_bytes(data)
    return file


def told(surface):
    return {
        "headers": [path for path, _ in surface.headers],
        "generated": [header.include for header in surface.build.headers if not header.source],
        "names": [entity.name for _, header in surface.headers for entity in header.entities],
        "messages": [name for name, _ in surface.interfaces],
        "targets": [(target.name, target.kind) for target in surface.build.targets],
        "cmake": surface.build.cmake_names,
        "dependencies": surface.build.dependencies,
        "programs": [(program.name, program.how) for program in surface.build.programs],
        "launches": [(launch.path, launch.arguments) for launch in surface.build.launches],
        "modules": [module.name for module in surface.python.modules],
        "unknown": surface.python.unknown,
    }


EXPECTED = {
    "headers": ["arm/gripper.hpp"],
    "generated": ["arm/msg/grip.hpp"],
    "names": ["arm::Gripper", "arm::Gripper::close"],
    "messages": ["msg/Grip"],
    "targets": [("arm::arm", "library")],
    "cmake": ("arm",),
    "dependencies": ("rclcpp",),
    "programs": [("arm_node", "binary")],
    "launches": [("launch/arm.launch.xml", (("speed", "3"), ("name", None)))],
    "modules": ["arm"],
    "unknown": ("arm._arm", "arm.msg"),
}


def test_a_prefix_is_read_package_by_package(installed):
    surface, _ = read_surface("arm", str(installed))
    assert (surface.package, surface.version, told(surface)) == ("arm", "1.2.0", EXPECTED)
    assert [path for path, _ in read_surface("leg", str(installed))[0].headers] == ["leg/knee.hpp"]


@pytest.mark.parametrize(
    ("packed", "name"), [(lzma.compress, "data.tar.xz"), (lambda data: data, "data.tar")], ids=["xz", "plain"]
)
def test_so_are_debian_packages_and_links_in_them(tmp_path, packed, name):
    own = {path: text for path, text in INSTALLED.items() if "leg" not in path}
    expected = EXPECTED | {"headers": ["arm/gripper.hpp", "arm/same.hpp"], "names": EXPECTED["names"] * 2}
    file = deb(tmp_path / "ros-jazzy-arm_1.2.0-1_amd64.deb", own, packed, name)
    assert told(read_surface("arm", str(file))[0]) == expected
    assert told(read_surface("arm", f"{tmp_path}/")[0]) == expected


def test_what_is_installed_is_what_the_sources_of_that_version_offer(tmp_path):
    installed = put(tmp_path / "jazzy", {path: text for path, text in INSTALLED.items() if "msg" not in path})
    with Store(tmp_path / "store.sqlite") as store:
        before = RepositorySurfaces(build_surfaces(WorkingTree(put(tmp_path / "ws", SOURCES)), store, jobs=1))
    surface, after = read_surface("arm", str(installed))
    changes = compare(before.surfaces["arm"], surface, before, after)
    assert [(change.kind, change.what, change.name) for change in changes if change.breaks and change.sure >= 1] == []


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ("opt/ros/jazzy", "there is no `hand` (no share/hand/package.xml); it has arm, leg"),
        ("opt", "is no prefix of ROS packages"),
        ("broken.deb", "is no Debian package"),
        ("empty.deb", "holds no files"),
        ("odd.deb", "is packed as `data.tar.lz9`"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, installed, asked, says):
    (tmp_path / "broken.deb").write_bytes(b"no archive")
    (tmp_path / "empty.deb").write_bytes(b"!<arch>\n")
    deb(tmp_path / "odd.deb", {}, name="data.tar.lz9")
    with pytest.raises(VersionError) as error:
        read_surface("hand", str(tmp_path / asked))
    assert says in str(error.value) and str(tmp_path) in str(error.value)


def test_versions_and_distros_are_no_paths(installed, monkeypatch):
    monkeypatch.chdir(installed.parent)
    assert is_installed(str(installed)) and is_installed("./jazzy") and is_installed("/no/such/folder")
    assert not is_installed("jazzy") and not is_installed("28.1.0")


def test_a_file_that_cannot_be_read_costs_itself_only(installed):
    whole, _ = read_surface("arm", str(installed))
    include = installed / "include/arm/arm"
    include.mkdir(parents=True, exist_ok=True)
    with open(include / "sparse.hpp", "wb") as file:
        file.truncate(3 << 30)
    os.mkfifo(include / "pipe.hpp")
    (include / "zero.hpp").symlink_to("/dev/zero")
    with open(installed / "share/arm/sparse.cmake", "wb") as file:
        file.truncate(3 << 30)
    found, _ = read_surface("arm", str(installed))
    assert {path for path, header in found.headers if header.entities} == {p for p, h in whole.headers if h.entities}
    lost = set(found.build.unknown) - set(whole.build.unknown)
    assert ("headers", "include/arm/arm/sparse.hpp cannot be read: larger than 8 MB") in lost
    assert {part for part, _ in lost} == {"headers", "files"} and len(lost) == 2
