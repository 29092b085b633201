"""How this machine's dynamic loader finds a shared library: its cache, its standard folders, what the shell sourced.

As ld.so(8) describes: DT_RUNPATH or DT_RPATH of the file, LD_LIBRARY_PATH, the cache, the standard folders.
"""

import os
import re
import shutil
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from functools import cache, cached_property
from pathlib import Path
from typing import IO

from ....edges.files import make_size_error, open_regular, read_start
from ....edges.groups import group_pairs
from ....edges.limits import get_limits
from ....edges.memory import cache_method
from ...facts import elf
from ...facts.elf import Elf, split_soname

_STANDARD = ("lib", "lib64", "usr/lib", "usr/lib64", "usr/local/lib")
_ORIGIN = re.compile(r"\$(?:ORIGIN\b|\{ORIGIN\})")
_MULTIARCH = re.compile(r"[a-z0-9_]+-linux-(?:gnu|musl)\w*$")
_CACHED = re.compile(r"\t(\S+) \(.*?\) => (.+)$")


class Loader:
    """Finds libraries on this machine.

    folders: library folders of prefixes besides the system's. root, environment and run (a command to its output) are
    for tests.
    """

    def __init__(
        self,
        folders: Iterable[str] = (),
        root: Path = Path("/"),
        environment: Mapping[str, str] = os.environ,
        run: Callable[[list[str]], str] | None = None,
    ):
        from ..capture import run_command

        self._root, self._run = root, run or run_command
        sourced = [folder for folder in environment.get("LD_LIBRARY_PATH", "").split(":") if folder]
        self._folders = [*sourced, *folders]
        self._read_head = cache(_read_head)

    @property
    def knows_prefixes(self) -> bool:
        """Whether any folder besides the system's is searched: that of ROS, when it is sourced."""
        return bool(self._folders)

    @cached_property
    def standard(self) -> list[str]:
        """The system's library folders that are there."""
        found = []
        for name in _STANDARD:
            folder = self._root / name
            if folder.is_dir():
                found += [str(folder), *sorted(str(p) for p in folder.iterdir() if _MULTIARCH.match(p.name))]
        return found

    @cached_property
    def _cached(self) -> dict[str, list[str]]:
        """soname to paths, as the loader's cache has them."""
        program = shutil.which("ldconfig") or "/sbin/ldconfig"
        matches = map(_CACHED.match, self._run([program, "-p"]).splitlines())
        return group_pairs((match[1], match[2]) for match in matches if match)

    def find(self, soname: str, asker: Elf, folder: str = "") -> str:
        """The file that the loader takes for a library that a file asks for, empty when there is none.

        asker: the file, whose own search folders and kind of machine count; folder: where it lies. A name with a slash
        is the path of the library.
        """
        if "/" in soname:
            path = _ORIGIN.sub(lambda _: folder or ".", soname)
            return path if self._fits(path, asker) else ""
        own = [_ORIGIN.sub(lambda _: folder or ".", place) for place in asker.search]
        places = [os.path.join(place, soname) for place in (*own, *self._folders)]
        places += self._cached.get(soname, ())
        places += [os.path.join(place, soname) for place in self.standard]
        return next((path for path in places if self._fits(path, asker)), "")

    def lies_about(self, soname: str) -> bool:
        """Whether a file of this name lies anywhere below the library folders, where a program that knows more than
        the loader (a plugin host, an alternative) may find it."""
        return soname in self._everything

    def list_others(self, soname: str) -> list[str]:
        """What there is of the same stem, shortest version first."""
        stem = split_soname(soname)[0]
        names = {name for name in self._everything | self._cached.keys() if name.startswith(stem + ".")}
        return sorted(names, key=lambda name: (len(name), name))

    def list_symbol_versions(self, path: str) -> frozenset[str]:
        """Versions of symbols that a library defines; empty for one without versions, or that cannot be read."""
        found = self._read_elf(path)
        return frozenset(found.offers) if found else frozenset()

    @cache_method
    def _read_elf(self, path: str) -> Elf | None:
        with suppress(OSError), open_library(path) as file:
            return elf.read(file)
        return None

    def list_loaded(self, asker: Elf, folder: str, own: Mapping[str, str]) -> tuple[str, ...] | None:
        """The libraries that are loaded with a file, those that they need in turn included; None where one is not
        found, or cannot be read. own: further names to files."""
        found: dict[str, None] = {}
        stack = [(asker, folder)]
        while stack:
            by, place = stack.pop()
            for soname in by.needed:
                path = own.get(soname) or self.find(soname, by, place)
                if path in found:
                    continue
                library = self._read_elf(path) if path else None
                if library is None or library.problem:
                    return None
                found[path] = None
                stack.append((library, os.path.dirname(os.path.realpath(path))))
        return tuple(found)

    @cache_method
    def list_defined_symbols(self, path: str) -> frozenset[str] | None:
        """The C++ symbols that a library has; None for one that cannot be read."""
        with suppress(OSError), open_library(path) as file:
            return elf.read_defined_symbols(file)
        return None

    @cached_property
    def _everything(self) -> frozenset[str]:
        top = [folder for folder in self.standard if not _MULTIARCH.match(os.path.basename(folder))]
        opt = self._root / "opt"
        found = set()
        for start in [*top, *self._folders, *([str(opt)] if opt.is_dir() else [])]:
            for _, _, files in os.walk(start):
                found.update(name for name in files if ".so" in name)
        return frozenset(found)

    def _fits(self, path: str, asker: Elf) -> bool:
        return self._read_head(path) == (asker.machine, asker.bits)


def open_library(path: str) -> IO[bytes]:
    """Opens a built file for reading. Raises OSError for what is no regular file, or larger than a library may be."""
    file = open(open_regular(path), "rb")  # noqa: SIM115
    try:
        if os.fstat(file.fileno()).st_size > get_limits().library:
            raise make_size_error(path, get_limits().library)
    except BaseException:
        file.close()
        raise
    return file


def _read_head(path: str) -> tuple[str, int] | None:
    """(machine, bits) of an ELF file, None when there is none."""
    from elftools.elf.enums import ENUM_E_MACHINE

    try:
        head = read_start(path, 20)
    except OSError:
        return None
    if head[:4] != elf.MAGIC or len(head) < 20:
        return None
    number = int.from_bytes(head[18:20], "little" if head[5] == 1 else "big")
    return next((name for name, value in ENUM_E_MACHINE.items() if value == number), ""), 64 if head[4] == 2 else 32


def detect_machine() -> str:
    """This machine as elf.h names it (`EM_X86_64`), told by the program that runs here; empty where there is no ELF."""
    for path in ("/proc/self/exe", "/bin/sh"):
        head = _read_head(path)
        if head is not None:
            return head[0]
    return ""
