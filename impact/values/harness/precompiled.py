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
from collections.abc import Sequence
from pathlib import Path

from ....edges.files import read_file, read_text, write_file
from ...cache import cache_folder
from .facade import RUNTIME, find_facade, list_folders
from .interfaces import KnownInterfaces, write_headers
from .toolchain import describe_version, run_compiler

_MOST = 6
"""Facades that are kept; each needs about 16 MB."""
_LARGEST = 200_000_000
_INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"\n]+)[>"]', re.MULTILINE)


class Facade:
    """The facade of one generation of ROS, with the messages as a workspace defines them. headers: those that are
    generated for it, by path."""

    def __init__(self, definitions: KnownInterfaces):
        self.ros = definitions.ros
        self.name = "rclcpp/rclcpp.hpp" if self.ros == 2 else "ros/ros.h"
        self.headers, self._digest = _collect_headers(definitions, self.name)
        self._known: dict[tuple[str, ...], Path | None] = {}

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
        shutil.rmtree(made.parent, ignore_errors=True)

    def _find(self, clang: str, flags: Sequence[str]) -> Path | None:
        about = "\n".join((describe_version(clang), *flags, self._digest))
        folder = cache_folder() / "facades" / hashlib.sha256(about.encode()).hexdigest()[:20]
        made, listed = folder / "facade.pch", folder / "facade.txt"
        if _is_whole(made, listed):
            with contextlib.suppress(OSError):
                os.utime(folder)
            return made
        for path, text in self.headers.items():
            _write_once(folder / "include" / path, text)
        header = folder / "facade.hpp"
        _write_once(header, f'#pragma once\n#include "ri_core.hpp"\n#include <{self.name}>\n')
        folders = [f"-I{each}" for each in (folder / "include", *list_folders(self.ros))]
        # Made beside it, so that whoever reads one meanwhile reads a whole one. Units are in other folders at other
        # times; what counts is that headers are of the same text.
        new = folder / f"new{os.getpid()}.pch"
        rule = folder / f"new{os.getpid()}.d"
        command = [
            clang, "-x", "c++-header", *flags, *folders, "-Xclang", "-fno-pch-timestamp",
            "-fpch-instantiate-templates", "-MD", "-MF", str(rule), str(header), "-o", str(new),
        ]  # fmt: skip
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


def split_dependencies(text: str) -> list[str]:
    """The paths that a make rule names behind its target."""
    rest = text.partition(":")[2].replace("\\\n", " ")
    return [each.replace("\\ ", " ") for each in re.findall(r"(?:\\ |\S)+", rest)]
