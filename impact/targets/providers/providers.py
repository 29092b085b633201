"""Who provides a header, CMake package, pkg-config file, Python module or program: looked up in the shipped table.

The table (`data/providers.sqlite.zst`, made by databuild/providers.py) is unpacked once into the user's cache and read
as SQLite, together with the reviewed facts of `data/providers.yaml` that no index gives. A lookup reads one row and
remembers it.
"""

import sqlite3
from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ....edges.memory import cache_method
from ..tables import find_data_folder
from ..target import Provider
from ..unpacked import ShippedDatabase, read_table
from ..version import parse

__all__ = ["HeaderSpan", "Providers", "load_providers"]

FACT_SCHEMA = """
CREATE TABLE fact(kind TEXT, name TEXT, entries TEXT, PRIMARY KEY(kind, name)) WITHOUT ROWID;
CREATE INDEX ros_header_of ON ros_header(package, pattern);
"""
"""Made while unpacking. fact is filled from data/providers.yaml: kind is a table's name, entries are as in provider,
`ros:NAME` for a released package. The index is quicker made than shipped."""

BY_FOLDER = 1 << 30
"""Bit in header.platforms: a bare file name that is found only where a package's own folder is on the include path."""

_LIBC = Provider("system", "", "")


class HeaderSpan(NamedTuple):
    """An unbroken run of a distro's releases that have a header; last is None when it is there to the end."""

    distro: str
    first: str
    last: str | None


def add_facts(connection: sqlite3.Connection, facts: bytes) -> None:
    """Loads data/providers.yaml: kind, name, then providers (`key`, `key debian-package`, `ros:package`, empty)."""
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    tables = yaml.load(facts, Loader=loader) or {}
    connection.executescript(FACT_SCHEMA)
    connection.executemany(
        "INSERT INTO fact VALUES(?, ?, ?)",
        (
            (kind, str(name), "\n".join([providers] if isinstance(providers, str) else providers))
            for kind, names in tables.items()
            for name, providers in names.items()
        ),
    )
    connection.commit()


class Providers(ShippedDatabase):
    """Lookups in the shipped table."""

    kind, info_file, fact_files, table = "providers", "providers.json", ("providers.yaml",), "fact"
    form = 2
    fill = staticmethod(add_facts)

    def __init__(self, data: Path | None = None, cache: Path | None = None):
        folder = data or find_data_folder()
        super().__init__(folder, cache, folder)

    def __reduce__(self):
        return Providers, (self.data, self._cache)

    @cache_method
    def find_header(self, path: str) -> tuple[Provider, ...]:
        """Who installs a header that is included as path (`ros/ros.h`, `opencv2/core.hpp`), best first.

        A provider with an empty name is the C library, the kernel's headers or the compiler. That `pkg/x.h` is of the
        released package `pkg` is a convention which the caller adds; what is here was seen in a file list. Released
        packages of both ROS generations are listed; the caller knows which its target has.
        """
        found = self._find_facts("header", path)
        system = self._find_system("header", path)
        released = [
            Provider("ros", name)
            for (name,) in self.fetch(
                "SELECT h.package FROM ros_header h JOIN pattern p ON p.id = h.pattern WHERE h.path = ?"
                " ORDER BY length(p.spans) DESC, h.package",
                (path,),
            )
        ]
        if system:
            # Some packages carry a copy of a library; the library itself is meant, but where the package is named so.
            head = path.partition("/")[0]
            own = [provider for provider in released if head in provider.name]
            found += [*own, system[0], *self._find_facts("vendor", system[0].name), *system[1:], *released]
        else:
            found += released or self._find_by_prefix(path)
        return tuple(_deduplicate(found))

    def find_cmake(self, name: str) -> list[Provider]:
        """Who answers find_package(name), best first. Where only another letter case is known, sure is False.

        An empty provider name: CMake's own find module succeeds on every machine that builds (Threads, PkgConfig).
        """
        found = [*self._find_everywhere("cmake", name), *self._find_sought(name)]
        if not found:
            # find_package(SDL2) also reads sdl2-config.cmake.
            found = self._find_system("cmake", f"{name.lower()}-config")
        if not found:
            for other in self._folded_cmake.get(name.lower(), ()):
                found += [*self._find_everywhere("cmake", other), *self._find_sought(other)]
            found = [provider._replace(sure=False) for provider in found]
        return _deduplicate(found)

    def find_installed_cmake(self, name: str) -> list[Provider]:
        """Which system packages install a CMake configuration of exactly this name, best first."""
        return self._find_system("cmake", name)

    def _find_sought(self, module: str) -> list[Provider]:
        """Who brings what a find module of CMake looks for, so that it succeeds."""
        found: list[Provider] = []
        for kind, names in self._find_modules.get(module, {}).items():
            for name in names:
                found += self.find_header(name) if kind == "header" else self.find_executable(name)
        return found

    @cached_property
    def _find_modules(self) -> dict[str, dict[str, list[str]]]:
        """What CMake's find modules look for, see databuild/find_modules.py."""
        return read_table(self.data / "find_modules.json", dict[str, dict[str, list[str]]])

    @cached_property
    def commands(self) -> dict[int, dict[str, str]]:
        """The packages that define a CMake function or macro, by generation of ROS and its name in lower case, see
        databuild/commands.py."""
        return read_table(self.data / "commands.json.zst", dict[int, dict[str, str]])

    def list_spellings(self, name: str) -> tuple[str, ...]:
        """Every known CMake package whose name differs from this one in letter case at most."""
        return tuple(self._folded_cmake.get(name.lower(), ()))

    @cache_method
    def list_configured_components(self, name: str) -> dict[str, tuple[str, ...]]:
        """The components of a CMake package each of which has a configuration of its own beside the package's
        (`Qt5Widgets`, `gz-math7-eigen3`), with the platforms that have it; none of a package with fewer than three."""
        if not self._find_row("cmake", name):
            return {}
        found: dict[str, tuple[str, ...]] = {}
        for other in (other for names in self._folded_cmake.values() for other in names):
            rest = other[len(name) :] if other.lower().startswith(name.lower()) else ""
            same = other.startswith(name) and rest[:1].isupper()
            if same or (rest[:1] in ("-", "_") and other.startswith((name, name.lower()))):
                found[rest.lstrip("-_")] = self.list_cmake_platforms(other)
        return found if len(found) >= _FEWEST_COMPONENTS else {}

    def find_pkgconfig(self, name: str) -> list[Provider]:
        """Who installs `name.pc`, best first."""
        return _deduplicate(self._find_facts("pkgconfig", name) + self._find_system("pkgconfig", name))

    def find_module(self, dotted: str) -> list[Provider]:
        """Who installs a Python module (`yaml`, `google.protobuf.text_format`), best first.

        The standard library is not here, see stdlib.py. The longest known beginning of the dotted name counts.
        """
        parts_ = dotted.split(".")
        for size in range(min(len(parts_), 2), 0, -1):
            name = ".".join(parts_[:size])
            found = self._find_everywhere("module", name)
            if found:
                return _deduplicate(found)
        return []

    def find_executable(self, name: str) -> list[Provider]:
        """Who installs a program on the PATH, best first. An empty provider name: every Debian or Ubuntu has it."""
        return _deduplicate(self._find_facts("program", name) + self._find_system("program", name))

    def list_header_platforms(self, path: str) -> tuple[str, ...]:
        """Platforms (`ubuntu jammy`) whose system packages have a header; empty for headers of ROS packages alone."""
        return self._list_platforms("header", path)

    def has_system_header(self, header: str, platform: str) -> bool | None:
        """Whether a platform's packages have a header that the system packages of some platform have.

        None when no platform's have it, when the C library or compiler has it, or the platform is not in the table.
        """
        if platform not in self.platforms:
            return None
        where = self.list_header_platforms(header)
        if not where or any(not provider.name for provider in self._find_system("header", header)):
            return None
        return platform in where

    def knows_system(self, packages: Iterable[str]) -> bool:
        """True when the contents of one of these Debian packages, or rosdep keys, are in the table."""
        return not self._system_names.isdisjoint(packages)

    @cached_property
    def _system_names(self) -> frozenset[str]:
        return frozenset(name for (entries,) in self.fetch("SELECT entries FROM provider") for name in entries.split())

    def list_provider_groups(self) -> list[tuple[str, ...]]:
        """For every header and pkg-config file of the system the packages that bring it, best first."""
        entries = {
            number: tuple(dict.fromkeys(p.package for p in _decode(text) if p.package))
            for number, text in self.fetch("SELECT id, entries FROM provider")
        }
        return [
            packages
            for table in ("header", "pkgconfig")
            for (number,) in self.fetch(f"SELECT provider FROM {table} ORDER BY name")
            if (packages := entries[number])
        ]

    def list_packages_of_names(self) -> Iterator[tuple[tuple[str, ...], int]]:
        """For every name of the system's packages: the packages that bring it on some platform, best first, and the
        bits of the platforms that have it."""
        entries = {
            number: tuple(dict.fromkeys(p.package for p in _decode(text) if p.package))
            for number, text in self.fetch("SELECT id, entries FROM provider")
        }
        for table in ("header", "cmake", "pkgconfig", "module", "program"):
            for number, bits in self.fetch(f"SELECT provider, platforms FROM {table}"):
                yield entries[number], bits

    def list_cmake_platforms(self, name: str) -> tuple[str, ...]:
        """Platforms whose system packages bring a CMake configuration or find module of this name."""
        return self._list_platforms("cmake", name)

    @cached_property
    def platforms(self) -> tuple[str, ...]:
        """Platforms whose system packages are in the table."""
        return tuple(name for (name,) in self.fetch("SELECT name FROM platform ORDER BY bit"))

    def list_header_spans(self, package: str, header: str) -> tuple[HeaderSpan, ...]:
        """Releases of a ROS package that have a header (include path), by distro; empty when none is known to.

        Only releases whose source tree was read count; known_releases tells which.
        """
        number = self._list_headers(package).get(header)
        return self._load_pattern(number) if number is not None else ()

    @cache_method
    def list_known_releases(self, package: str) -> tuple[HeaderSpan, ...]:
        """Releases of a ROS package whose source trees were read, as spans by distro."""
        rows = self.fetch("SELECT pattern FROM ros_package WHERE name = ?", (package,))
        return self._load_pattern(rows[0][0]) if rows else ()

    def has_header(self, package: str, header: str, distro: str, version: str) -> bool | None:
        """Whether a package's release in a distro has a header; None when that release's tree is not known."""
        if not _contains_version(self.list_known_releases(package), distro, version):
            return None
        return _contains_version(self.list_header_spans(package, header), distro, version)

    def has_kept_header(self, package: str, header: str, distro: str, version: str) -> bool:
        """Whether the distro's newest release that was read, before a version or this one, has a header: later ones of
        a distro rarely drop any."""
        wanted = parse(version)
        spans = self.list_header_spans(package, header)
        return any(one.distro == distro and one.last is None and parse(one.first) <= wanted for one in spans)

    def has_headers(self, package: str, distro: str, version: str) -> bool | None:
        """Whether a package's release in a distro has any header; None when that release's tree is not known."""
        if not _contains_version(self.list_known_releases(package), distro, version):
            return None
        patterns = {*self._list_headers(package).values()}
        return any(_contains_version(self._load_pattern(number), distro, version) for number in patterns)

    @cache_method
    def _list_headers(self, package: str) -> dict[str, int]:
        """The headers that a ROS package ever had, with their patterns."""
        return dict(self.fetch("SELECT path, pattern FROM ros_header WHERE package = ?", (package,)))

    def _find_by_prefix(self, path: str) -> list[Provider]:
        """Reviewed owners of whole folders (`gz/math`), longest first; not seen in a file list, so sure is False."""
        folders = path.split("/")[:-1]
        for size in range(len(folders), 0, -1):
            found = self._find_facts("folder", "/".join(folders[:size]))
            if found:
                return [provider._replace(sure=False) for provider in found]
        return []

    def _find_everywhere(self, kind: str, name: str) -> list[Provider]:
        """Reviewed facts, released packages and those of the system, in this order. kind: `cmake` or `module`."""
        return [*self._find_facts(kind, name), *self._find_ros(f"ros_{kind}", name), *self._find_system(kind, name)]

    def _find_facts(self, kind: str, name: str) -> list[Provider]:
        entries = self._reviewed.get((kind, name))
        return [] if entries is None else _decode(entries)

    @cached_property
    def _reviewed(self) -> dict[tuple[str, str], str]:
        """The facts of data/providers.yaml, a few hundred, by kind and name."""
        return {(kind, name): entries for kind, name, entries in self.fetch("SELECT kind, name, entries FROM fact")}

    def _find_system(self, table: str, name: str) -> list[Provider]:
        row = self._find_row(table, name)
        if row is None:
            return []
        number, platforms = row
        known = self._load_set(number)
        return [provider._replace(sure=False) for provider in known] if platforms & BY_FOLDER else list(known)

    @cache_method
    def _load_set(self, number: int) -> tuple[Provider, ...]:
        ((entries,),) = self.fetch("SELECT entries FROM provider WHERE id = ?", (number,))
        return tuple(_decode(entries))

    @cache_method
    def _find_row(self, table: str, name: str) -> tuple[int, int] | None:
        """(provider, platforms) of a name in one of the tables of the system's packages, None when it is not there."""
        rows = self.fetch(f"SELECT provider, platforms FROM {table} WHERE name = ?", (name,))
        return rows[0] if rows else None

    def _find_ros(self, table: str, name: str) -> list[Provider]:
        for (packages,) in self.fetch(f"SELECT packages FROM {table} WHERE name = ?", (name,)):
            return [Provider("ros", package) for package in packages.split(" ")]
        return []

    def _list_platforms(self, table: str, name: str) -> tuple[str, ...]:
        row = self._find_row(table, name)
        if row is None:
            return ()
        return tuple(platform for place, platform in enumerate(self.platforms) if row[1] >> place & 1)

    @cache_method
    def _load_pattern(self, number: int) -> tuple[HeaderSpan, ...]:
        ((text,),) = self.fetch("SELECT spans FROM pattern WHERE id = ?", (number,))
        spans = (line.split(" ") for line in text.split("\n") if line)
        return tuple(HeaderSpan(distro, first, None if last == "-" else last) for distro, first, last in spans)

    @cached_property
    def _folded_cmake(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = {}
        for (name,) in self.fetch(
            "SELECT name FROM cmake UNION SELECT name FROM ros_cmake UNION SELECT name FROM fact WHERE kind = 'cmake'"
        ):
            found.setdefault(name.lower(), []).append(name)
        for name in self._find_modules:
            if name.lower() not in found:
                found[name.lower()] = [name]
        return found


_FEWEST_COMPONENTS = 3


def _deduplicate(providers: list[Provider]) -> list[Provider]:
    """Each provider once, first mention first; the machine itself (no name) makes all others pointless."""
    if any(not provider.name for provider in providers):
        return [_LIBC]
    found: dict[tuple[str, str], Provider] = {}
    for provider in providers:
        found.setdefault((provider.kind, provider.name), provider)
    return list(found.values())


def _decode(entries: str) -> list[Provider]:
    found = []
    for line in entries.split("\n"):
        name, _, package = line.partition(" ")
        if name.startswith("ros:"):
            found.append(Provider("ros", name[len("ros:") :]))
        else:
            found.append(Provider("system", name, package or name))
    return found


def _contains_version(spans: tuple[HeaderSpan, ...], distro: str, version: str) -> bool:
    wanted = parse(version)
    return any(
        span.distro == distro and parse(span.first) <= wanted and (span.last is None or wanted <= parse(span.last))
        for span in spans
    )


_default: Providers | None = None


def load_providers() -> Providers:
    """The shipped table, one for each process."""
    global _default
    if _default is None:
        _default = Providers()
    return _default
