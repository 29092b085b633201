"""What the install rules of a package copy where: the files of its tree by their paths in the prefix."""

from __future__ import annotations

import fnmatch
import posixpath
import re
from collections.abc import Iterator
from typing import NamedTuple

from ...facts.kinds import HEADER_ENDINGS
from .build import Build, Install


class InstalledHeaders(NamedTuple):
    """The headers of a package that are installed. headers: path in the tree to its path in the prefix. known: nothing
    else can be there, as no rule installs what cannot be known."""

    headers: dict[str, str]
    known: bool


def collect_installed_headers(build: Build, files: tuple[str, ...]) -> InstalledHeaders:
    """The headers that a package's rules install, whatever condition they stand under. files: all of the package."""
    found: dict[str, str] = {}
    known = not build.unresolved
    for install in build.installs:
        destination = posixpath.normpath(install.destination.replace("${CMAKE_INSTALL_INCLUDEDIR}", "include"))
        if install.kind not in ("files", "directory", "programs"):
            continue
        if "$" in destination:
            known = known and not any(item.endswith(HEADER_ENDINGS) or "include" in item for item in install.items)
            continue
        if not f"{destination}/".startswith("include/"):
            continue
        known = known and not any("$" in item for item in install.items)
        for path, place in list_copied_files(install, destination, files):
            if place.endswith(HEADER_ENDINGS):
                found[path] = place
    if build.finds_declared:
        known = known and build.packaged is not None
    return InstalledHeaders(found, known)


def list_copied_files(install: Install, destination: str, files: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """(path in the tree, path in the prefix) of the files that an install rule copies; items that hold a variable are
    passed over."""
    for item in install.items:
        if "$" in item:
            continue
        if install.kind != "directory":
            yield item, f"{destination}/{install.rename or posixpath.basename(item)}"
            continue
        folder = item.rstrip("/")
        base = "" if folder in ("", ".") else f"{folder}/"
        top = destination if item.endswith("/") or not folder else f"{destination}/{posixpath.basename(folder)}"
        for path in files:
            if path.startswith(base) and lets_in(install, path[len(base) :]):
                yield path, f"{top}/{path[len(base) :]}"


def lets_in(install: Install, inside: str) -> bool:
    """Whether the patterns of install(DIRECTORY) let a file in; they are for names, or folders above them."""
    let_in = not install.only
    parts = inside.split("/")
    for pattern in install.patterns:
        text = pattern.lstrip("!")
        if text.startswith("~"):
            try:
                # CMake's regular expressions are close to Python's; they are matched against the whole path.
                hit = re.search(text[1:], f"/{inside}") is not None
            except re.error:
                continue
        else:
            hit = any(fnmatch.fnmatchcase(part, text) for part in parts) or fnmatch.fnmatchcase(inside, f"*{text}")
        if hit and pattern.startswith("!"):
            return False
        let_in = let_in or hit
    return let_in
