"""Which shared libraries are there when a built file starts: on this machine, or on a machine that is described.

Both answer alike: yes, no, or not known. A no is said where it is sure.
"""

import os
import re
from collections.abc import Container, Mapping
from functools import cached_property, cmp_to_key
from typing import NamedTuple

from ...facts import elf
from ...facts.elf import AskedSymbolVersions, Elf, split_soname
from ..distro.distro import DistroTarget
from ..platform import strip_separators
from ..version import compare
from .loader import Loader
from .sonames import Sonames

# A name this short is the beginning of too many others.
_LONG_ENOUGH = 3


class MissingVersion(NamedTuple):
    """A version of symbols that is not there, and which is (empty when it is not known)."""

    version: str
    there: str


class MissingSymbol(NamedTuple):
    """A C++ symbol without a version that none of the libraries which are loaded with a file has. name: as code writes
    it; library: which of them has others of the same class, empty where none has; more: how many others
    of it are lost."""

    name: str
    library: str
    more: int


class SharedLibraries:
    """The shared libraries of a machine, real or described.

    Attributes: target (its name), name (`this machine`, `ubuntu jammy`), machine (`EM_X86_64`, empty where any may be),
    platform (`ubuntu jammy`)."""

    target: str
    name: str
    machine: str
    platform: str

    def has(self, soname: str, asker: Elf, folder: str) -> bool | None:
        """Whether a library is there for a file that lies in a folder, None when it is not known."""
        raise NotImplementedError

    def find_other(self, soname: str) -> str:
        """What is there of the library in another version: its file, or else its name and version; empty when nothing
        is."""
        raise NotImplementedError

    def find_package(self, soname: str) -> str:
        """The Debian package of a library that is not installed and can be; empty where none is known."""
        return ""

    def lacks(self, asked: AskedSymbolVersions, asker: Elf, folder: str) -> tuple[MissingVersion, ...] | None:
        """The versions of symbols that are asked of a library and not there; None when it is not known."""
        raise NotImplementedError

    def find_lost_symbols(self, asker: Elf, folder: str, own: Mapping[str, str]) -> tuple[MissingSymbol, ...] | None:
        """Symbols without a version that a file asks for and that are not there, one for each library; None when it is
        not known. own: the files that are installed with it, by name."""
        return None


# How symbols begin that only the library of a class has: constructors, destructors, its table of virtual functions.
_OF_CLASSES = ("_ZN{}C", "_ZN{}D", "_ZTVN{}", "_ZTIN{}")


class InstalledLibraries(SharedLibraries):
    """This machine."""

    name = "this machine"

    def __init__(self, target: str, loader: Loader, machine: str, platform: str, sonames: Sonames):
        self.target, self.machine, self.platform = target, machine, platform
        self._loader, self._sonames = loader, sonames

    def has(self, soname: str, asker: Elf, folder: str) -> bool | None:
        if self._loader.find(soname, asker, folder):
            return True
        if "/" in soname:  # looked for nowhere else
            return False
        # A library without a version is of ROS or of one's own, and may be in a prefix that nobody named.
        if not split_soname(soname)[1] and not self._loader.knows_prefixes:
            return None
        return None if self._loader.lies_about(soname) else False

    def find_other(self, soname: str) -> str:
        return next(iter(self._loader.list_others(soname)), "")

    def find_package(self, soname: str) -> str:
        return self._sonames.find_package(soname) if self._sonames.has(self.platform, soname) else ""

    def lacks(self, asked: AskedSymbolVersions, asker: Elf, folder: str) -> tuple[MissingVersion, ...] | None:
        path = self._loader.find(asked.library, asker, folder)
        offers = self._loader.list_symbol_versions(path) if path else frozenset()
        if not offers:
            return None  # the loader only warns of a library without versions
        return tuple(
            MissingVersion(version, _find_max(offers, version)) for version in asked.versions if version not in offers
        )

    def find_lost_symbols(self, asker: Elf, folder: str, own: Mapping[str, str]) -> tuple[MissingSymbol, ...] | None:
        wanted = {u.name for u in asker.undefined if not u.version and not u.weak and u.name.startswith("_Z")}
        paths = self._loader.list_loaded(asker, folder, own) if wanted else ()
        if paths is None:
            return None
        known = {path: self._loader.list_defined_symbols(path) for path in paths}
        if None in known.values():
            return None
        absent = wanted.difference(*filter(None, known.values()))
        found: dict[str, list[str]] = {}
        for member in sorted(filter(None, map(elf.parse_symbol, absent))):
            marks = tuple(mark.format(member.scope) for mark in _OF_CLASSES)
            owners = (path for path, names in known.items() if any(n.startswith(marks) for n in names or ()))
            owner = os.path.basename(next(owners, "")) if member.scope else ""
            # What is loaded as a plugin may find in its host what its own libraries never had.
            if owner or asker.program:
                found.setdefault(owner, []).append(member.name)
        return tuple(MissingSymbol(names[0], owner, len(names) - 1) for owner, names in found.items())


class DescribedLibraries(SharedLibraries):
    """A machine that is described: the packages of its platform, and those of its ROS distro."""

    machine = ""

    def __init__(
        self,
        target: DistroTarget,
        sonames: Sonames,
        own: Container[str] = frozenset(),
        near: Container[str] = frozenset(),
    ):
        """own: libraries of underlays that go with the workspace. near: libraries of prefixes on this machine, which
        tell that ROS packages bring them, and not in which version they are elsewhere."""
        self.target, self.name, self.platform = target.name, target.platform, target.platform
        self._described, self._sonames, self._own, self._near = target, sonames, own, near

    def has(self, soname: str, asker: Elf, folder: str) -> bool | None:
        if soname in self._own or soname in self._sonames.reviewed.everywhere:
            return True
        stem, version = split_soname(soname)
        platform = self._described.platform
        known = self._sonames.has(platform, soname)
        library = self._sonames.find_family(soname)
        there = self._described.find_library(library) if library else None
        fits = self._sonames.fits(soname, there) if there else None
        # A version that a person or a capture gives goes over that of the platform.
        if known or fits or (not version and self._is_of_ros(stem)):
            return True
        if not version or soname in self._near or soname.startswith(self._sonames.reviewed.elsewhere):
            return None
        if self._may_be_of_ros(soname):
            return None
        return False if known is False else fits

    def find_other(self, soname: str) -> str:
        library = self._sonames.find_family(soname)
        there = self._described.find_library(library) if library else None
        others = self._sonames.list_others(self._described.platform, soname)
        return others[0] if others else f"{library} {there}" if there else ""

    def lacks(self, asked: AskedSymbolVersions, asker: Elf, folder: str) -> tuple[MissingVersion, ...] | None:
        found = []
        for name in asked.versions:
            kind, _, version = name.partition("_")
            limit = self._reach.get(kind)
            if limit and re.fullmatch(r"[\d.]+", version) and compare(version, limit) > 0:
                found.append(MissingVersion(name, f"{kind}_{limit}"))
        return tuple(found)

    @cached_property
    def _reach(self) -> dict[str, str]:
        """How far the versions of symbols reach, by their kind; empty where it is not known."""
        glibc, glibcxx = (self._sonames.reach(self.platform, kind) for kind in ("GLIBC", "GLIBCXX"))
        return {"GLIBC": glibc or self._described.find_library("glibc") or "", "GLIBCXX": glibcxx}

    @cached_property
    def _released(self) -> frozenset[str]:
        """Names of ROS packages without what spelling may change, and without `vendor` and `lib`."""
        names = (strip_separators(name) for name in self._described.list_released())
        return frozenset(name.removesuffix("vendor").removeprefix("lib") for name in names)

    def _is_of_ros(self, stem: str) -> bool:
        """Whether a library is called after a released package: `librclcpp.so`, `libstd_msgs__rosidl_cpp.so`."""
        name = stem.removeprefix("lib").removesuffix(".so")
        return self._described.find_version(name.partition("__")[0]) is not None

    def _may_be_of_ros(self, soname: str) -> bool:
        """Whether a released package may bring the library in: it is called like the library, or its beginning, or like
        the Debian package that has it."""
        stem = strip_separators(split_soname(soname)[0].removesuffix(".so").removeprefix("lib"))
        debian = re.sub(r"[\d.]+[a-z]?\d*$", "", self._sonames.find_package(soname))
        package = strip_separators(debian.removeprefix("lib"))
        library = strip_separators(self._sonames.find_family(soname))
        return any(
            name[:length] in self._released
            for name in (stem, package, library)
            for length in range(_LONG_ENOUGH, len(name) + 1)
        )


def _find_max(offers: frozenset[str], version: str) -> str:
    """The highest version that is offered of the same kind: of `GLIBC_2.38` in an older libc, `GLIBC_2.36`."""
    kind = version.rpartition("_")[0]
    parted = (offer.rpartition("_") for offer in offers)
    same = [number for head, _, number in parted if head == kind and re.fullmatch(r"[\d.]+", number)]
    return f"{kind}_{max(same, key=cmp_to_key(compare))}" if same else ""
