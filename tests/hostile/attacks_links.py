"""Links that leave the tree: their contents must not be read, nor quoted; links in the tree go on working."""

from __future__ import annotations

import os
from collections.abc import Callable

import pygit2

from .attacks_bombs import commit_blob
from .harness import COMMANDS, NEEDS_GIT, STATUS, Attack, Place, cmake, commit, link, manifest, write
from .kinds import KINDS, Kind

GROUP = "links"
CHECK = (*COMMANDS["check"], "--notes", "--preview")


def absolute(place: Place, kind: Kind) -> None:
    write(place.outside, {"x/" + os.path.basename(kind.path): kind.content(place.token)})
    link(place.ws / kind.path, place.outside / "x" / os.path.basename(kind.path))


def relative(place: Place, kind: Kind) -> None:
    write(place.outside, {"x/" + os.path.basename(kind.path): kind.content(place.token)})
    up = "../" * kind.path.count("/") + "../outside/x/"
    link(place.ws / kind.path, up + os.path.basename(kind.path))


def chain(place: Place, kind: Kind) -> None:
    write(place.outside, {"x": kind.content(place.token)})
    link(place.ws / "chain1", place.outside / "x")
    link(place.ws / "chain2", "chain1")
    link(place.ws / kind.path, place.ws / "chain2")


def environ(place: Place, kind: Kind) -> None:
    link(place.ws / kind.path, "/proc/self/environ")


def dangling(place: Place, kind: Kind) -> None:
    link(place.ws / kind.path, place.outside / "nothing")


def loop(place: Place, kind: Kind) -> None:
    link(place.ws / kind.path, os.path.basename(kind.path) + ".2")
    link(place.ws / (kind.path + ".2"), os.path.basename(kind.path))


def through_a_folder(place: Place, kind: Kind) -> None:
    write(place.outside, {"folder/" + os.path.basename(kind.path): kind.content(place.token)})
    link((place.ws / kind.path).parent, place.outside / "folder")


# Kinds for which each way is tried; the others stand for those that behave like an absolute link or a missing file.
FEW = ("manifest", "cmake", "node", "launch.py", "msg", "toml", "gitmodules", "defaults.yaml", "colcon.meta")
WAYS: list[Callable[[Place, Kind], None]] = [absolute, relative, chain, environ, dangling, loop]


def making(kind: Kind, way: Callable[[Place, Kind], None]) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        write(place.ws, dict(kind.beside))
        way(place, kind)

    return make


def rows() -> list[Attack]:
    found = [
        Attack(f"{way.__name__} link as {kind.name}", GROUP, making(kind, way), CHECK, refusable=kind.setting)
        for kind in KINDS
        for way in WAYS
        if way not in (relative, dangling, loop) or kind.name in FEW
    ]
    folders = [kind for kind in KINDS if kind.path.count("/") == 3]
    found += [
        Attack(f"folder link above {kind.name}", GROUP, making(kind, through_a_folder), CHECK) for kind in folders
    ]
    found += [in_the_tree(kind) for kind in KINDS if kind.shown]
    for command in COMMANDS:
        if command == "check":
            continue
        for name in ("manifest", "cmake", "node", "launch.py", "msg", "header"):
            kind = next(kind for kind in KINDS if kind.name == name)
            found.append(
                Attack(
                    f"{command}: absolute link as {name}",
                    GROUP,
                    making(kind, absolute),
                    COMMANDS[command],
                    (STATUS[command],),
                    git=command in NEEDS_GIT,
                )
            )
        for way in (package_elsewhere, folder_of_folders):
            found.append(
                Attack(
                    f"{command}: {way.__name__}",
                    GROUP,
                    way,
                    COMMANDS[command],
                    (STATUS[command],),
                    git=command in NEEDS_GIT,
                )
            )
    for format in ("text", "sarif", "github", "markdown", "html"):
        kind = KINDS[4]
        found.append(
            Attack(
                f"check {format}: absolute link as cpp",
                GROUP,
                making(kind, absolute),
                (*COMMANDS["check"], "--notes", "-f", format),
            )
        )
        found.append(
            Attack(
                f"check {format}: environ as cmake",
                GROUP,
                making(KINDS[1], environ),
                (*COMMANDS["check"], "--notes", "-f", format),
            )
        )
    found += [
        Attack("package linked from elsewhere", GROUP, package_elsewhere, CHECK),
        Attack("folder of packages linked from elsewhere", GROUP, folder_of_folders, CHECK),
        Attack("link to /", GROUP, lambda place: link(place.ws / "src/root", "/"), CHECK),
        Attack("link to /proc", GROUP, lambda place: link(place.ws / "src/bad/src", "/proc/self"), CHECK),
        Attack("link to the folder above", GROUP, lambda place: link(place.ws / "src/bad/up", ".."), CHECK),
        Attack("link to itself", GROUP, lambda place: link(place.ws / "src/bad/me", "me"), CHECK),
        Attack("link to the workspace", GROUP, lambda place: link(place.ws / "src/again", place.ws), CHECK),
        Attack("200 links in a row", GROUP, many_links, CHECK),
        Attack("2^20 paths through links", GROUP, doubling_links, CHECK),
        Attack("include of CMake outside", GROUP, cmake_outside, CHECK),
        Attack("include of CMake by ..", GROUP, cmake_above, CHECK),
        Attack("add_subdirectory outside", GROUP, subdirectory_outside, CHECK),
        Attack("file(STRINGS) outside", GROUP, cmake_strings, CHECK),
        Attack("file(READ) of the environment", GROUP, cmake_read("/proc/self/environ"), CHECK),
        Attack("configure_file outside", GROUP, configure_file, CHECK),
        Attack(
            "CMake reads $ENV",
            GROUP,
            {"src/bad/CMakeLists.txt": cmake("bad", "find_package($ENV{CANARY} REQUIRED)")},
            CHECK,
        ),
        Attack("XML entity of a file", GROUP, external_entity("package.xml"), CHECK),
        Attack("XML entity of a file in a launch file", GROUP, external_entity("launch/a.launch.xml"), CHECK),
        Attack("XInclude of a file", GROUP, xinclude, CHECK),
        Attack("launch file includes outside", GROUP, launch_outside, CHECK),
        Attack(
            "graph: launch file includes outside",
            GROUP,
            launch_outside,
            (*COMMANDS["graph"], "--launch", "a.launch.xml", "-f", "json"),
        ),
        Attack(
            "graph: launch file reads the environment",
            GROUP,
            launch_environment,
            (*COMMANDS["graph"], "--launch", "a.launch.xml", "-f", "json"),
        ),
        Attack(
            "graph: launch file reads a file by substitution",
            GROUP,
            launch_file_content,
            (*COMMANDS["graph"], "--launch", "a.launch.xml", "-f", "json"),
        ),
        Attack(
            "graph: parameters outside",
            GROUP,
            parameters_outside,
            (*COMMANDS["graph"], "--launch", "a.launch.py", "-f", "json"),
        ),
        Attack(
            "graph: the launch file is a link",
            GROUP,
            making(KINDS[12], absolute),
            (*COMMANDS["graph"], "--launch", "a.launch.py", "-f", "json"),
            status=(0, 2),
            found="",
        ),
        Attack("xacro includes outside", GROUP, xacro_outside, CHECK),
        Attack("setup.py reads a file", GROUP, setup_reads, CHECK),
        Attack(
            "setup.cfg: version of a file",
            GROUP,
            {"src/bad/setup.cfg": "[metadata]\nname = bad\nversion = file: {outside}/secret.txt\n"},
            CHECK,
        ),
        Attack("colcon.meta names a file outside", GROUP, metas_outside, CHECK),
        Attack("message type by ..", GROUP, message_outside, CHECK),
        Attack("#include of a path outside", GROUP, include_outside, CHECK),
        Attack(
            "rosimpact.toml: target file outside",
            GROUP,
            toml_file("[targets.x]\nfile = '{outside}/secret.txt'\n"),
            CHECK,
            refusable="rosimpact.toml",
            status=(0, 1, 2),
            found="",
        ),
        Attack(
            "rosimpact.toml: target file of the environment",
            GROUP,
            toml_file("[targets.x]\nfile = '/proc/self/environ'\n"),
            ("check", "{ws}"),
            status=(0, 1, 2),
            found="",
        ),
        Attack("rosimpact.toml: underlay outside", GROUP, underlay_outside, CHECK, refusable="rosimpact.toml"),
        Attack(
            "rosimpact.toml: repos outside",
            GROUP,
            toml_file("[workspace]\nrepos = ['{outside}/secret.txt']\n"),
            CHECK,
            refusable="rosimpact.toml",
        ),
        Attack(
            "rosimpact.toml: rosdep sources outside",
            GROUP,
            toml_file("[workspace]\nrosdep_sources = ['{outside}/secret.txt']\n"),
            CHECK,
            refusable="secret.txt",
        ),
        Attack(
            "rosimpact.toml: rosdep sources by file:",
            GROUP,
            toml_file("[workspace]\nrosdep_sources = ['file://{outside}/secret.txt']\n"),
            CHECK,
            refusable="rosimpact.toml",
        ),
        Attack(
            "rosimpact.toml: index outside",
            GROUP,
            toml_file("[workspace]\nindex = '{outside}/secret.txt'\n"),
            CHECK,
            refusable="secret.txt",
        ),
        Attack(
            "rosimpact.toml: index by file:",
            GROUP,
            toml_file("[workspace]\nindex = 'file://{outside}/secret.txt'\n"),
            CHECK,
            refusable="rosimpact.toml",
        ),
        Attack("rosimpact.toml: rosdep sources linked", GROUP, linked_sources, CHECK, refusable="rosdep.list"),
    ]
    found += [by_revision(kind) for kind in KINDS if kind.name in REVISED]
    for command in ("graph", "impact", "logic", "upgrade"):
        arguments = COMMANDS[command] + (("--rev", "HEAD") if command in ("graph", "upgrade") else ())
        found.append(
            Attack(
                f"{command}: committed link as node",
                GROUP,
                committed_link(KINDS[6]),
                arguments,
                (STATUS[command],),
                git=True,
            )
        )
    found += [
        Attack(
            ".git is a link to a repository outside",
            GROUP,
            git_link,
            (*CHECK, "--base", "HEAD"),
            status=(0, 1, 2),
            found="",
        ),
        Attack(
            ".git file names a folder outside", GROUP, git_file, (*CHECK, "--base", "HEAD"), status=(0, 1, 2), found=""
        ),
        Attack("core.worktree outside", GROUP, git_worktree, (*CHECK, "--rev", "HEAD"), git=True),
        Attack("core.worktree outside, base", GROUP, git_worktree, (*CHECK, "--base", "HEAD~1"), git=True, found=""),
        Attack("core.worktree outside, files", GROUP, git_worktree, CHECK, git=True),
        Attack(
            "git config includes outside",
            GROUP,
            git_include,
            (*CHECK, "--base", "HEAD~1"),
            git=True,
            found="",
            status=(0, 1, 2),
        ),
        Attack("alternates outside", GROUP, git_alternates, (*CHECK, "--rev", "HEAD"), git=True),
        Attack("HEAD is a link", GROUP, git_head_link, (*CHECK, "--rev", "HEAD"), git=True, status=(0, 1, 2), found=""),
        Attack(
            "a ref that is a link to a secret",
            GROUP,
            git_ref_link,
            (*CHECK, "--rev", "evil"),
            git=True,
            status=(2,),
            found="",
        ),
    ]
    for command in ("check", "graph", "impact", "upgrade", "why"):
        found.append(follows(command))
    return found


def in_the_tree(kind: Kind) -> Attack:
    def make(place: Place) -> None:
        write(
            place.ws, {**kind.beside, "kept/" + os.path.basename(kind.path) + ".kept": kind.content("intheworkspace")}
        )
        link(place.ws / kind.path, "../" * kind.path.count("/") + "kept/" + os.path.basename(kind.path) + ".kept")

    return Attack(
        f"link in the tree as {kind.name}", GROUP, make, CHECK, words=("intheworkspace",), refusable=kind.setting
    )


def package_elsewhere(place: Place) -> None:
    write(
        place.outside,
        {
            "pkg/package.xml": manifest(place.token, "rclcpp", place.token + "_dep"),
            "pkg/CMakeLists.txt": cmake(place.token, f"find_package(OpenCV 8 REQUIRED)  # {place.token}"),
            "pkg/src/node.cpp": KINDS[6].content(place.token),
        },
    )
    link(place.ws / "src/elsewhere", place.outside / "pkg")


def folder_of_folders(place: Place) -> None:
    package_elsewhere(place)
    (place.ws / "src/elsewhere").unlink()
    link(place.ws / "src/more", "../../outside")


def many_links(place: Place) -> None:
    write(place.outside, {"x": KINDS[1].content(place.token)})
    link(place.ws / "l0", place.outside / "x")
    for number in range(30):
        link(place.ws / f"l{number + 1}", f"l{number}")
    link(place.ws / "src/bad/CMakeLists.txt", "../../l30")


def doubling_links(place: Place) -> None:
    for number in range(20):
        folder = place.ws / f"src/d{number}"
        folder.mkdir()
        link(folder / "a", f"../d{number + 1}")
        link(folder / "b", f"../d{number + 1}")
    write(place.ws, {"src/d20/x.txt": ""})


def cmake_outside(place: Place) -> None:
    write(place.outside, {"x.cmake": f"find_package(OpenCV 8 REQUIRED)  # {place.token}\n"})
    write(place.ws, {"src/bad/CMakeLists.txt": cmake("bad", f"include({place.outside}/x.cmake)")})


def cmake_above(place: Place) -> None:
    write(place.outside, {"x.cmake": f"find_package(OpenCV 8 REQUIRED)  # {place.token}\n"})
    write(place.ws, {"src/bad/CMakeLists.txt": cmake("bad", "include(../../../outside/x.cmake)")})


def subdirectory_outside(place: Place) -> None:
    write(place.outside, {"sub/CMakeLists.txt": f"find_package(OpenCV 8 REQUIRED)  # {place.token}\n"})
    write(place.ws, {"src/bad/CMakeLists.txt": cmake("bad", "add_subdirectory(../../../outside/sub x)")})


def cmake_strings(place: Place) -> None:
    more = f"file(STRINGS {place.outside}/secret.txt S)\nfind_package(${{S}} REQUIRED)"
    write(place.ws, {"src/bad/CMakeLists.txt": cmake("bad", more)})


def cmake_read(path: str) -> dict[str, str]:
    return {"src/bad/CMakeLists.txt": cmake("bad", f"file(READ {path} S)\nfind_package(${{S}} REQUIRED)")}


def configure_file(place: Place) -> None:
    more = f"configure_file({place.outside}/secret.txt x.cmake)\ninclude(${{CMAKE_CURRENT_BINARY_DIR}}/x.cmake)"
    write(place.ws, {"src/bad/CMakeLists.txt": cmake("bad", more)})


def external_entity(name: str) -> dict[str, str]:
    head = "<?xml version='1.0'?><!DOCTYPE x [<!ENTITY e SYSTEM 'file://{outside}/secret.txt'>]>"
    if name == "package.xml":
        return {"src/bad/package.xml": head + manifest("bad", "&e;").split("?>")[1]}
    return {f"src/bad/{name}": head + "<launch><node pkg='bad' exec='&e;'/></launch>"}


def xinclude(place: Place) -> None:
    include = f"<xi:include xmlns:xi='http://www.w3.org/2001/XInclude' href='{place.outside}/secret.txt' parse='text'/>"
    text = manifest("bad").replace("<description>d", f"<depend>{include}</depend><description>{include}")
    write(place.ws, {"src/bad/package.xml": text})


def launch_outside(place: Place) -> None:
    inner = f"<launch><node pkg='bad' exec='{place.token}' name='{place.token}'/></launch>"
    write(place.outside, {"a.launch.xml": inner})
    write(
        place.ws,
        {
            "src/bad/launch/a.launch.xml": f"<launch><node pkg='healthy' exec='healthy_node'/><include "
            f"file='{place.outside}/a.launch.xml'/></launch>"
        },
    )


def launch_environment(place: Place) -> None:
    write(
        place.ws,
        {
            "src/bad/launch/a.launch.xml": "<launch><node pkg='healthy' exec='healthy_node' namespace='$(env "
            "CANARY)'/></launch>"
        },
    )


def launch_file_content(place: Place) -> None:
    write(
        place.ws,
        {
            "src/bad/launch/a.launch.xml": "<launch><node pkg='healthy' exec='healthy_node' "
            f"namespace=\"$(command 'cat {place.outside}/secret.txt')$(file-content {place.outside}/secret.txt)"
            f'"/></launch>'
        },
    )


def parameters_outside(place: Place) -> None:
    write(place.outside, {"p.yaml": f"/**:\n  ros__parameters:\n    {place.token}: {place.token}\n"})
    write(
        place.ws,
        {
            "src/bad/launch/a.launch.py": "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
            "def generate_launch_description():\n    return LaunchDescription([Node(package='healthy', "
            "executable='healthy_node', "
            f"parameters=['{place.outside}/p.yaml'])])\n"
        },
    )


def xacro_outside(place: Place) -> None:
    write(place.outside, {"a.xacro": f"<robot><plugin filename='$(find {place.token})'/></robot>"})
    text = f"<robot xmlns:xacro='x'><xacro:include filename='{place.outside}/a.xacro'/></robot>"
    write(place.ws, {"src/bad/urdf/a.urdf.xacro": text})


def setup_reads(place: Place) -> None:
    text = f"from setuptools import setup\nsetup(name='bad', version=open('{place.outside}/secret.txt').read())\n"
    write(place.ws, {"src/bad/setup.py": text})


def metas_outside(place: Place) -> None:
    write(place.outside, {"meta": f"names: [{place.token}: {{"})
    write(place.ws, {"defaults.yaml": f"build:\n  metas: [{place.outside}/meta, ../outside/meta]\n"})


def message_outside(place: Place) -> None:
    kind = next(kind for kind in KINDS if kind.name == "msg")
    write(place.outside, {"Bad.msg": f"{place.token}/X x\n"})
    text = str(kind.beside["src/bad/CMakeLists.txt"]).replace("msg/Bad.msg", "../../../outside/Bad.msg")
    write(place.ws, {**kind.beside, "src/bad/CMakeLists.txt": text})


def include_outside(place: Place) -> None:
    write(place.outside, {"a.h": KINDS[4].content(place.token)})
    write(place.ws, {"src/bad/src/node.cpp": f'#include "../../../../outside/a.h"\n#include "{place.outside}/a.h"\n'})


def toml_file(text: str) -> dict[str, str]:
    return {"rosimpact.toml": text}


def underlay_outside(place: Place) -> None:
    package_elsewhere(place)
    (place.ws / "src/elsewhere").unlink()
    write(place.ws, {"rosimpact.toml": f"[workspace]\nunderlays = ['{place.outside}']\n"})


def linked_sources(place: Place) -> None:
    link(place.ws / "rosdep.list", place.outside / "secret.txt")
    write(place.ws, {"rosimpact.toml": "[workspace]\nrosdep_sources = ['rosdep.list']\n"})


REVISED = (
    "manifest",
    "cmake",
    "cpp",
    "header",
    "python",
    "launch.py",
    "launch.xml",
    "msg",
    "toml",
    "gitmodules",
    "colcon.meta",
    "cmake-include",
)


def committed_link(kind: Kind) -> Callable[[Place], None]:
    def make(place: Place) -> None:
        write(place.ws, dict(kind.beside))
        if kind.name == "gitmodules":  # no index takes such a link; a tree does
            repository = pygit2.Repository(str(place.ws))
            target = repository.create_blob(str(place.outside / "secret.txt").encode())
            commit_blob(repository, kind.path, target, pygit2.GIT_FILEMODE_LINK)
            return
        absolute(place, kind)
        commit(place.ws, "link")
        write(
            place.ws,
            {"src/healthy/src/node.cpp": (place.ws / "src/healthy/src/node.cpp").read_text().replace("> 3", "> 4")},
        )
        commit(place.ws, "more", time=1_700_000_200)

    return make


def by_revision(kind: Kind) -> Attack:
    return Attack(
        f"committed link as {kind.name}",
        GROUP,
        committed_link(kind),
        (*CHECK, "--rev", "HEAD"),
        git=True,
        refusable=kind.setting,
    )


def _outside_repository(place: Place) -> None:
    folder = place.outside / "repo"
    write(
        folder,
        {
            "src/elsewhere/package.xml": manifest(place.token, place.token),
            "src/elsewhere/CMakeLists.txt": cmake(place.token, f"find_package(OpenCV 8 REQUIRED)  # {place.token}"),
        },
    )
    commit(folder)


def git_link(place: Place) -> None:
    _outside_repository(place)
    link(place.ws / ".git", place.outside / "repo/.git")


def git_file(place: Place) -> None:
    _outside_repository(place)
    write(place.ws, {".git": f"gitdir: {place.outside}/repo/.git\n"})


def git_worktree(place: Place) -> None:
    _outside_repository(place)
    pygit2.Repository(str(place.ws)).config["core.worktree"] = str(place.outside / "repo")


def git_include(place: Place) -> None:
    write(place.outside, {"config": f"[{place.token}\n"})
    with open(place.ws / ".git/config", "a") as file:
        file.write(f"[include]\n\tpath = {place.outside}/config\n")


def git_alternates(place: Place) -> None:
    _outside_repository(place)
    write(place.ws, {".git/objects/info/alternates": f"{place.outside}/repo/.git/objects\n"})


def git_head_link(place: Place) -> None:
    link(place.ws / ".git/HEAD", place.outside / "secret.txt")


def git_ref_link(place: Place) -> None:
    link(place.ws / ".git/refs/heads/evil", place.outside / "secret.txt")


def follows(command: str) -> Attack:
    """The user asks for links to be followed."""

    def make(place: Place) -> None:
        write(
            place.outside,
            {
                "pkg/package.xml": manifest("followed", "libopencv-dev", "rclcpp", "std_msgs"),
                "pkg/CMakeLists.txt": cmake(
                    "followed",
                    "find_package(OpenCV 9 REQUIRED)\nament_target_dependencies(x rclcpp)\n"
                    "add_executable(followed src/node.cpp)",
                ),
                "pkg/src/node.cpp": KINDS[6].content("followed"),
            },
        )
        link(place.ws / "src/elsewhere", place.outside / "pkg")
        if command == "impact":
            commit(place.ws, "link")

    return Attack(
        f"{command} --follow-links",
        GROUP,
        make,
        (*COMMANDS[command], "--follow-links"),
        (STATUS[command],),
        found="" if command == "impact" else None,
        git=command in NEEDS_GIT,
        words=() if command == "impact" else ("followed",) if command != "why" else ("elsewhere",),
    )
