"""Edits of CMakeLists.txt and package.xml for lighter messages."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ..rules.fix_actions import Edit

_COMMENT = re.compile(rb"#[^\n]*")
_GLOB = re.compile(rb"(?is)\bfile\s*\(\s*GLOB\w*[^)]*\.msg|\badd_message_files\s*\((?:(?!FILES)[^)])*\)")


def list_messages(path: str, data: bytes, old: str, new: list[str]) -> list[Edit] | None:
    """The edits of a CMakeLists.txt that name new messages wherever it names an old one; none where it takes all files
    of a folder. None where it names it nowhere. old, new: names of messages."""
    blank = _COMMENT.sub(lambda match: b" " * len(match[0]), data)
    pattern = re.compile(rb"(?P<quote>\"?)(?P<folder>[\w./${}-]*?)\b" + old.encode() + rb"\.msg(?P=quote)(?![\w.])")
    edits: list[Edit] = []
    for match in pattern.finditer(blank):
        start = blank.rfind(b"\n", 0, match.start()) + 1
        before = blank[start : match.start()]
        between = "\n" + before.decode() if not before.strip() else " "
        quote, folder = match["quote"].decode(), match["folder"].decode()
        text = "".join(f"{between}{quote}{folder}{name}.msg{quote}" for name in new)
        edits.append(Edit(path, match.end(), match.end(), text))
    if not edits and not _GLOB.search(blank):
        return None
    return edits


_COMMAND = re.compile(
    rb"(?P<name>[A-Za-z_]\w*)\s*\((?P<arguments>(?:[^()#\"]|\"(?:[^\"\\]|\\.)*\"|\([^()]*\)|#[^\n]*\n)*)\)"
)
_LISTING = frozenset(
    (b"ament_target_dependencies", b"ament_export_dependencies", b"set", b"catkin_package", b"target_link_libraries",
     b"ament_auto_find_build_dependencies", b"list", b"foreach")
)  # fmt: skip


def write_package(name: str, ros: int, messages: Iterable[str], needs: Iterable[str]) -> dict[str, bytes]:
    """The files of a package for lighter messages, besides these. messages: their names; needs: packages of messages
    that they are made of."""
    needed, listed = sorted(needs), sorted(messages)
    if ros == 1:
        tags = [
            "<buildtool_depend>catkin</buildtool_depend>", "<build_depend>message_generation</build_depend>",
            *(f"<depend>{each}</depend>" for each in needed), "<exec_depend>message_runtime</exec_depend>",
        ]  # fmt: skip
        depends = f"generate_messages(DEPENDENCIES {' '.join(needed)})" if needed else "generate_messages()"
        build = [
            f"find_package(catkin REQUIRED COMPONENTS {' '.join(['message_generation', *needed])})", "",
            "add_message_files(", "  FILES", *(f"  {each}.msg" for each in listed), ")", depends, "",
            f"catkin_package(CATKIN_DEPENDS {' '.join(['message_runtime', *needed])})",
        ]  # fmt: skip
    else:
        tags = [
            "<buildtool_depend>ament_cmake</buildtool_depend>",
            "<buildtool_depend>rosidl_default_generators</buildtool_depend>",
            *(f"<depend>{each}</depend>" for each in needed), "<exec_depend>rosidl_default_runtime</exec_depend>",
            "<member_of_group>rosidl_interface_packages</member_of_group>", "<export>",
            "  <build_type>ament_cmake</build_type>", "</export>",
        ]  # fmt: skip
        build = [
            "find_package(ament_cmake REQUIRED)", "find_package(rosidl_default_generators REQUIRED)",
            *(f"find_package({each} REQUIRED)" for each in needed), "", "rosidl_generate_interfaces(${PROJECT_NAME}",
            *(f'  "msg/{each}.msg"' for each in listed), *([f"  DEPENDENCIES {' '.join(needed)}"] if needed else []),
            ")", "", "ament_export_dependencies(rosidl_default_runtime)", "ament_package()",
        ]  # fmt: skip
    head = [
        '<?xml version="1.0"?>', f'<package format="{2 if ros == 1 else 3}">', f"  <name>{name}</name>",
        "  <version>0.0.0</version>",
        "  <description>Messages with the fields that are read, made by rosimpact prune.</description>",
        '  <maintainer email="nobody@example.org">nobody</maintainer>', "  <license>Apache-2.0</license>",
    ]  # fmt: skip
    manifest = "\n".join((*head, *(f"  {tag}" for tag in tags), "</package>")) + "\n"
    start = [f"cmake_minimum_required(VERSION 3.{5 if ros == 1 else 8})", f"project({name})", ""]
    return {"package.xml": manifest.encode(), "CMakeLists.txt": ("\n".join((*start, *build)) + "\n").encode()}


def use_package(path: str, data: bytes, old: str, new: str, ros: int) -> list[Edit] | None:
    """The edits of a CMakeLists.txt that find and link a new package of messages wherever an old one is. None where it
    names the old one nowhere, and is not of catkin."""
    edits: list[Edit] = []
    word = re.compile(rb"(?<![\w${:.\-/])" + re.escape(old.encode()) + rb"(?![\w:.\-/}])")
    blank = _COMMENT.sub(lambda match: b" " * len(match[0]), data)
    found = False
    for command in _COMMAND.finditer(blank):
        name, start = command["name"].lower(), command.start("arguments")
        arguments = command["arguments"]
        words = arguments.split()
        first = words[0] if words else b""
        if name == b"find_package" and first == old.encode():
            indent = blank[blank.rfind(b"\n", 0, command.start()) + 1 : command.start()].decode()
            required = " REQUIRED" if b"REQUIRED" in words else ""
            edits.append(Edit(path, command.end(), command.end(), f"\n{indent}find_package({new}{required})"))
            found = True
        elif name == b"find_package" and first == b"catkin":
            at = word.search(arguments)
            end = start + (at.end() if at is not None else len(arguments.rstrip()))
            if b"COMPONENTS" not in words and at is None:
                continue
            edits.append(Edit(path, end, end, f"{_find_gap(blank, end - len(old) if at is not None else end)}{new}"))
            found = True
        elif name in _LISTING:
            at = word.search(arguments)
            if at is not None and (name != b"set" or first != old.encode()):
                end = start + at.end()
                edits.append(Edit(path, end, end, f"{_find_gap(blank, start + at.start())}{new}"))
                found = True
            for pattern, text in (
                (rf"{re.escape(old)}::{re.escape(old)}(?!\w)", f"{new}::{new}"),
                (rf"\$\{{{re.escape(old)}_TARGETS\}}", f"${{{new}_TARGETS}}"),
            ):
                at = re.search(pattern.encode(), arguments)
                if at is not None:
                    end = start + at.end()
                    edits.append(Edit(path, end, end, f"{_find_gap(blank, start + at.start())}{text}"))
                    found = True
    return edits if found else None


def _find_gap(data: bytes, at: int) -> str:
    """What stands before a word of a list: a line and its indentation where it begins one, else a blank."""
    start = data.rfind(b"\n", 0, at) + 1
    before = data[start:at]
    return "\n" + before.decode() if before and not before.strip() else " "


def order_after(path: str, data: bytes, targets: Iterable[str]) -> list[Edit]:
    """The edits that build targets of catkin after the messages they use, where CMakeLists.txt does not say so yet."""
    blank = _COMMENT.sub(lambda match: b" " * len(match[0]), data)
    wanted = set(targets)
    edits: list[Edit] = []
    for command in _COMMAND.finditer(blank):
        words = command["arguments"].split()
        name = words[0].decode("utf-8", "replace") if words else ""
        if command["name"].lower() in (b"add_executable", b"add_library") and name in wanted:
            said = re.search(
                rb"(?i)add_dependencies\s*\(\s*" + re.escape(name.encode()) + rb"\b[^)]*catkin_EXPORTED_TARGETS", blank
            )
            if said is None:
                text = f"\nadd_dependencies({name} ${{catkin_EXPORTED_TARGETS}})"
                edits.append(Edit(path, command.end(), command.end(), text))
    return edits
