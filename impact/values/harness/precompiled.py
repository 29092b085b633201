"""The facade of ROS, compiled once for all harnesses that are compiled alike, and kept in the cache folder.

A precompiled header holds the paths of the headers that it was made of, so what it needs of generated headers lies
beside it. Its folder is named after all that it depends on; a list of the system's headers tells whether one of them
was changed since.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

from ....edges.files import read_file, read_text, write_file
from ...cache import cache_folder
from .facade import RUNTIME, find_facade, list_folders
from .interfaces import KnownInterfaces, write_headers
from .toolchain import CompilerRun, describe_version, run_compiler

_MOST = 10
"""Facades that are kept, of which exploring and replaying need one each; each needs about 16 MB."""
_MOST_EXTENDED = 2
_LARGEST = 200_000_000
_INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"\n]+)[>"]', re.MULTILINE)

_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*([a-z_]+)\b([^\n]*)", re.MULTILINE)


class Facade:
    """The facade of one generation of ROS, with the messages as a workspace defines them. headers: those that are
    generated for it, by path."""

    def __init__(self, definitions: KnownInterfaces):
        self.ros = definitions.ros
        self.name = "rclcpp/rclcpp.hpp" if self.ros == 2 else "ros/ros.h"
        self.headers, self._digest = _collect_headers(definitions, self.name)
        self._known: dict[tuple[str, ...], Path | None] = {}
        self._extended: dict[tuple[str, ...], Path] = {}
        self._refused: set[tuple[str, ...]] = set()

    def find_precompiled(self, clang: str, flags: Sequence[str]) -> Path | None:
        """The precompiled header for a compiler and its flags (without folders of headers), made where it is not there
        yet; None where it cannot be made or kept."""
        key = (clang, *flags)
        if key not in self._known:
            with contextlib.suppress(OSError):
                self._known[key] = self._find(clang, flags)
        return self._known.setdefault(key, None)

    def forget(self, made: Path) -> None:
        """Removes a precompiled header that the compiler refuses."""
        self._known = {key: None if path == made else path for key, path in self._known.items()}
        self._refused |= {key for key, path in self._extended.items() if path == made}
        self._extended = {key: path for key, path in self._extended.items() if path != made}
        shutil.rmtree(made.parent, ignore_errors=True)

    def _find(self, clang: str, flags: Sequence[str]) -> Path | None:
        about = "\n".join((describe_version(clang), *flags, self._digest))
        folder = cache_folder() / "facades" / hashlib.sha256(about.encode()).hexdigest()[:20]
        made, listed = folder / "facade.pch", folder / "facade.txt"
        if _is_whole(made, listed):
            with contextlib.suppress(OSError):
                os.utime(folder)
            return made
        # Made beside it, so that whoever reads one meanwhile reads a whole one. Units are in other folders at other
        # times; what counts is that headers are of the same text.
        new = folder / f"new{os.getpid()}.pch"
        rule = folder / f"new{os.getpid()}.d"
        more = ("-fpch-instantiate-templates", "-MD", "-MF", str(rule))
        command = [*self._write_sources(clang, flags, folder, ()), *more, "-o", str(new)]
        try:
            if run_compiler(command, folder).status != 0:
                return None
            rows = _describe_headers(new, read_text(rule, _LARGEST))
            os.replace(new, made)
            write_file(listed, rows.encode())
        finally:
            for each in (new, rule):
                each.unlink(missing_ok=True)
        _remove_old(folder.parent)
        return made

    def find_extended(
        self, clang: str, flags: Sequence[str], extras: Sequence[str], folder: Path, run: Callable[..., CompilerRun]
    ) -> Path | None:
        """The same with members that are added to its classes. extras: the macros that do it; folder: where it is made,
        for one run of ours; run: runs a compiler. The two that were asked for last are kept."""
        key = (clang, *flags, *extras)
        known = self._extended.pop(key, None)
        if known is not None or key in self._refused:
            self._extended.update({key: known} if known is not None else {})
            return known
        name = hashlib.sha256("\n".join(key).encode()).hexdigest()[:20]
        own, made = folder / name, folder / name / "facade.pch"
        is_made = False
        with contextlib.suppress(OSError):
            command = self._write_sources(clang, flags, own, extras)
            is_made = run([*command, "-o", str(made)], own).status == 0
        if not is_made:
            self._refused.add(key)
            return None
        while len(self._extended) >= _MOST_EXTENDED:
            shutil.rmtree(self._extended.pop(next(iter(self._extended))).parent, ignore_errors=True)
        self._extended[key] = made
        return made

    def _write_sources(self, clang: str, flags: Sequence[str], folder: Path, extras: Sequence[str]) -> list[str]:
        """Writes what a facade is made of. Gives the command that compiles it, but for where to."""
        for path, text in self.headers.items():
            _write_once(folder / "include" / path, text)
        header = folder / "facade.hpp"
        lines = ["#pragma once", *extras, '#include "ri_core.hpp"', f"#include <{self.name}>", ""]
        _write_once(header, "\n".join(lines))
        folders = [f"-I{each}" for each in (folder / "include", *list_folders(self.ros))]
        return [clang, "-x", "c++-header", *flags, *folders, "-Xclang", "-fno-pch-timestamp", str(header)]


def _collect_headers(definitions: KnownInterfaces, name: str) -> tuple[dict[str, str], str]:
    """The headers that are generated for a facade, and a digest of them and of those that lie in our folders."""
    folders = list_folders(definitions.ros)
    digest = hashlib.sha256(str(RUNTIME).encode())
    made: dict[str, str] = {}
    waiting, seen = ["ri_core.hpp", name], set()
    while waiting:
        header = waiting.pop()
        if header in seen:
            continue
        seen.add(header)
        own = next((each / header for each in folders if (each / header).is_file()), None)
        if own is not None:
            text = read_text(own, _LARGEST)
        else:
            if key := definitions.find_key_of_header(header):
                made.update(write_headers(definitions, key))
            elif facade := find_facade(header, definitions.ros):
                made[header] = f"#pragma once\n#include <{facade}>\n"
            if (text := made.get(header)) is None:
                continue  # one of the system
        digest.update(f"{header}\n{text}\n".encode())
        waiting.extend(find_includes(text))
    return made, digest.hexdigest()


def _write_once(path: Path, text: str) -> None:
    """Writes a header, but not again where it is there: to a precompiled header it would be another file."""
    with contextlib.suppress(OSError, UnicodeDecodeError):
        if read_text(path, _LARGEST) == text:
            return
    write_file(path, text.encode())


def _describe_headers(made: Path, rule: str) -> str:
    """A line for the precompiled header, with its sum, and one for each header that it was made of."""
    lines = [f"{_compute_sum(made)} {made.stat().st_size}"]
    for path in split_dependencies(rule):
        status = os.stat(path)
        lines.append(f"{status.st_mtime_ns} {status.st_size} {path}")
    return "\n".join([*lines, ""])


def _is_whole(made: Path, listed: Path) -> bool:
    """Whether a precompiled header is as it was written, and all headers that it was made of are as they were."""
    try:
        first, *rows = read_text(listed, _LARGEST).splitlines()
        if first != f"{_compute_sum(made)} {made.stat().st_size}":
            return False
        for row in rows:
            time, size, path = row.split(" ", 2)
            status = os.stat(path)
            if (status.st_mtime_ns, status.st_size) != (int(time), int(size)):
                return False
    except (OSError, ValueError):
        return False
    return bool(rows)


def _compute_sum(path: Path) -> str:
    return hashlib.blake2b(read_file(path, _LARGEST), digest_size=16).hexdigest()


def _remove_old(folder: Path) -> None:
    """Keeps the facades that were used last."""
    with contextlib.suppress(OSError):
        found = sorted(folder.iterdir(), key=lambda each: each.stat().st_mtime, reverse=True)
        for each in found[_MOST:]:
            shutil.rmtree(each, ignore_errors=True)


def find_includes(text: str) -> list[str]:
    """The headers that a text includes, whatever the conditions."""
    return _INCLUDE.findall(text)


def find_plain_includes(text: str) -> set[str]:
    """The headers that a text includes without a condition, but for the one that keeps it from being read twice."""
    found: set[str] = set()
    conditions: list[bool] = []
    rows = [(each[1], each[2].strip()) for each in _DIRECTIVE.finditer(text)]
    for number, (word, rest) in enumerate(rows):
        if word.startswith("if"):
            behind = rows[number + 1] if number + 1 < len(rows) else ("", "")
            is_guard = word == "ifndef" and behind[0] == "define" and behind[1].split()[:1] == rest.split()[:1]
            conditions.append(not is_guard)
        elif word == "endif" and conditions:
            conditions.pop()
        elif word.startswith("el") and conditions:
            conditions[-1] = True
        elif word == "include" and not any(conditions):
            found.update(find_includes(f"#include {rest}"))
    return found


def split_dependencies(text: str) -> list[str]:
    """The paths that a make rule names behind its target."""
    rest = text.partition(":")[2].replace("\\\n", " ")
    return [each.replace("\\ ", " ") for each in re.findall(r"(?:\\ |\S)+", rest)]
