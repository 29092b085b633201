"""Builds data/providers.sqlite.zst: who provides a header, CMake package, pkg-config file, Python module or executable.

The system part joins the Contents and Packages indices of Debian and Ubuntu suites, as apt keeps them, with the package
names of rosdep's keys (from the shipped snapshot). The ROS part reads git trees of ROS repositories: which package of
which release has which header. Only names, versions and their relations are kept.

    python -P -m rosimpact.databuild.providers --suite "ubuntu jammy=LISTS" --repositories DIR --output DATA

LISTS is a `Dir::State::lists` folder of an apt that was told to fetch Contents indices as well.
"""

from __future__ import annotations

import argparse
import contextlib
import hashlib
import re
import sqlite3
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import msgspec

from ..edges.files import write_file
from ..impact.targets.distro.rosdep import decode_rule
from ..impact.targets.providers.providers import BY_FOLDER
from ..impact.targets.snapshot import Snapshot, load_snapshot
from ..impact.targets.tables import DATA
from .history import RosFacts, read_repositories

SCHEMA = """
CREATE TABLE platform(bit INTEGER PRIMARY KEY, name TEXT);
CREATE TABLE provider(id INTEGER PRIMARY KEY, entries TEXT);
CREATE TABLE header(name TEXT PRIMARY KEY, provider INTEGER, platforms INTEGER) WITHOUT ROWID;
CREATE TABLE cmake(name TEXT PRIMARY KEY, provider INTEGER, platforms INTEGER) WITHOUT ROWID;
CREATE TABLE pkgconfig(name TEXT PRIMARY KEY, provider INTEGER, platforms INTEGER) WITHOUT ROWID;
CREATE TABLE module(name TEXT PRIMARY KEY, provider INTEGER, platforms INTEGER) WITHOUT ROWID;
CREATE TABLE program(name TEXT PRIMARY KEY, provider INTEGER, platforms INTEGER) WITHOUT ROWID;
CREATE TABLE pattern(id INTEGER PRIMARY KEY, spans TEXT);
CREATE TABLE ros_header(path TEXT, package TEXT, pattern INTEGER, PRIMARY KEY(path, package)) WITHOUT ROWID;
CREATE TABLE ros_package(name TEXT PRIMARY KEY, pattern INTEGER) WITHOUT ROWID;
CREATE TABLE ros_module(name TEXT PRIMARY KEY, packages TEXT) WITHOUT ROWID;
CREATE TABLE ros_cmake(name TEXT PRIMARY KEY, packages TEXT) WITHOUT ROWID;
"""
"""Tables of the shipped database.

provider.entries: one line for each provider, best first: a rosdep key and, where it differs, the Debian package that it
installs; an empty line stands for the C library and compiler. platforms: bits of the platforms that have the name.
pattern.spans: one line for each unbroken run of releases: distro, first version, last version (`-` when the newest
release known still counts). ros_header: where a package's header is. ros_package: the releases whose trees were read.
ros_module, ros_cmake: packages, space separated.
"""

_HEADER_DEPTH = 4
_MODULE_DEPTH = 2
_PROGRAM_DEPTH = 1


def _split_words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_APT_MANAGERS = frozenset({"apt"})
_OTHER_MANAGERS = frozenset({"pip", "gem", "source", "npm", "snap", "dnf", "yum", "packages"})


class SuiteContents(NamedTuple):
    """What the indices of one suite say. contents: its Contents files. depends: package to what it pulls in.

    essential: packages of every machine. ros: packages that Debian builds of ROS itself, told better by ROS's releases.
    source: package to the family of its source package, without version (`boost1.74` and `boost-defaults` are `boost`).
    """

    platform: str
    contents: tuple[Path, ...]
    depends: dict[str, tuple[str, ...]]
    essential: frozenset[str]
    ros: frozenset[str]
    source: dict[str, str]

    def list_files(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """(path, Debian packages) of every file that may be a header, module, program or configuration."""
        for index in self.contents:
            for line in unpack(index):
                path, _, where = line.rstrip().rpartition(b" " if b"\t" not in line else b"\t")
                path = path.rstrip()
                if _WANTED.match(path) and not _SKIP.match(path):
                    names = tuple(sys.intern(item.rpartition(b"/")[2].decode()) for item in where.strip().split(b","))
                    yield path.decode("utf-8", "replace"), names


# Paths worth keeping: programs, Python modules, CMake and pkg-config files, and everything below an include folder.
_WANTED = re.compile(
    rb"(?:usr/)?s?bin/[^/]+$|usr/games/[^/]+$|.*/(?:include|pkgconfig)/|.*\.cmake$|.*/(?:dist-packages|pyshared)/|usr/lib/gcc/"
)
_SKIP = re.compile(rb"usr/share/(?:doc|gir-1\.0|perl5|icons|javascript|nodejs|cargo|gocode|go-)|usr/lib/debug|usr/src/")


_ROS_SOURCE = re.compile(r"(?:ros|ament|ros2|rosidl)-|ament_|catkin$")


_ROS_TOOLS = ("ros", "python-catkin", "colcon", "bloom", "vcstool", "osrf-pycommon")
"""How the sources of tools begin that ROS's archive has."""


def is_ros_source(source: str) -> bool:
    """Whether a Debian source package is of ROS itself."""
    return _ROS_SOURCE.match(source) is not None


def unpack(path: Path) -> Iterator[bytes]:
    """Lines of an index however apt compressed it, through apt's own helper."""
    with subprocess.Popen(["/usr/lib/apt/apt-helper", "cat-file", str(path)], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        yield from process.stdout


def read_suite(platform: str, lists: Path) -> SuiteContents:
    """Reads one suite's Contents and Packages indices from an apt lists folder.

    Raises FileNotFoundError without them.
    """
    contents = sorted(lists.glob("*Contents-*"))
    packages = sorted(lists.glob("*_Packages*"))
    if not contents or not packages:
        raise FileNotFoundError(f"{lists}: no Contents or no Packages index; enable apt's Contents targets and update")
    essential: set[str] = set()
    ros: set[str] = set()
    source: dict[str, str] = {}
    for name, fields in _read_fields(packages):
        if fields.get("Essential") == "yes" or fields.get("Priority") == "required":
            essential.add(name)
        origin = fields.get("Source", name).partition(" ")[0]
        source[name] = sys.intern(re.sub(r"-?[\d.]+$", "", origin.removesuffix("-defaults")))
        if is_ros_source(origin):
            ros.add(name)
    real = read_dependencies(lists)
    return SuiteContents(platform, tuple(contents), real, frozenset(essential), frozenset(ros), source)


def read_dependencies(lists: Path) -> dict[str, tuple[str, ...]]:
    """Each package of a suite to what it depends on, read from the Packages indices in an apt lists folder; virtual
    packages are replaced by the first one that provides them."""
    depends: dict[str, tuple[str, ...]] = {}
    provides: dict[str, list[str]] = defaultdict(list)
    for name, fields in _read_fields(sorted(lists.glob("*_Packages*"))):
        depends[name] = _parse_relations(fields.get("Pre-Depends", "") + "," + fields.get("Depends", ""))
        for other in _parse_relations(fields.get("Provides", "")):
            provides[other].append(name)
    return {
        name: tuple(d if d in depends else next(iter(provides.get(d, (d,)))) for d in found)
        for name, found in depends.items()
    }


def read_names(lists: Path) -> frozenset[str]:
    """The packages of a suite, virtual ones included, from the Packages indices in an apt lists folder. Raises
    FileNotFoundError without them."""
    indices = sorted(lists.glob("*_Packages*"))
    if not indices:
        raise FileNotFoundError(f"{lists}: no Packages index; run `apt-get update`")
    found: set[str] = set()
    for name, fields in _read_fields(indices):
        found.update((name, *_parse_relations(fields.get("Provides", ""))))
    return frozenset(found)


def list_ros_packages(lists: Path) -> Iterator[str]:
    """The packages of a suite that ROS's own archive has too: those of ROS, and of the tools that are made for it."""
    for name, fields in _read_fields(sorted(lists.glob("*_Packages*"))):
        source = fields.get("Source", name).partition(" ")[0]
        if is_ros_source(source) or source.startswith(_ROS_TOOLS):
            yield from (name, *_parse_relations(fields.get("Provides", "")))


def _read_fields(indices: Iterable[Path]) -> Iterator[tuple[str, dict[str, str]]]:
    for index in indices:
        yield from _parse_paragraphs(unpack(index))


def _parse_paragraphs(lines: Iterable[bytes]) -> Iterator[tuple[str, dict[str, str]]]:
    wanted = (b"Package", b"Source", b"Depends", b"Pre-Depends", b"Provides", b"Essential", b"Priority")
    fields: dict[str, str] = {}
    for line in lines:
        head, colon, rest = line.partition(b":")
        if colon and head in wanted:
            key = head.decode()
            if key == "Package" and fields:
                yield fields["Package"], fields
                fields = {}
            fields[key] = rest.decode("utf-8", "replace").strip()
    if "Package" in fields:
        yield fields["Package"], fields


def _parse_relations(text: str) -> tuple[str, ...]:
    """`a (>= 1), b | c, d:any` gives a, b, d: apt takes the first alternative."""
    found = []
    for item in text.split(","):
        match = re.match(r"\s*([a-z0-9][a-z0-9+.-]*)", item)
        if match:
            found.append(sys.intern(match.group(1)))
    return tuple(found)


# rosdep keys


class Keys(NamedTuple):
    """debian: key to the Debian and Ubuntu packages it ever installed. uses: key to how many manifests name it."""

    debian: dict[str, tuple[str, ...]]
    uses: Counter[str]


def read_keys(snapshot: Snapshot) -> Keys:
    """rosdep keys with their packages, the newest rule's first, and how often released manifests name them."""
    found: dict[str, dict[str, None]] = defaultdict(dict)
    for key, rule in snapshot.fetch("SELECT key, rule FROM rule WHERE os IN ('debian', 'ubuntu') ORDER BY ts DESC"):
        for name in _list_apt_names(decode_rule(rule)):
            found[key].setdefault(name)
    uses: Counter[str] = Counter()
    for (entries,) in snapshot.fetch("SELECT d.entries FROM manifest m JOIN dependencies d ON d.id = m.dependencies"):
        uses.update({line.partition("\t")[0] for line in (entries or "").splitlines()})
    return Keys({key: tuple(names) for key, names in found.items()}, uses)


def _list_apt_names(rule: object) -> Iterator[str]:
    if isinstance(rule, str):
        yield from rule.split() if "\n" not in rule.strip() else ()
    elif isinstance(rule, list):
        yield from (str(name) for name in rule)
    elif isinstance(rule, dict):
        for name, value in rule.items():
            if name in _APT_MANAGERS and isinstance(value, dict):
                yield from _list_apt_names(value.get("packages"))
            elif name not in _OTHER_MANAGERS:
                yield from _list_apt_names(value)


# What a path means

# Folders below /usr/include that a package's own flags put on the include path (its .pc or CMake file says -I there).
# Most carry a version in their name; these do not.
_ROOTS = _split_words(
    """
    OGRE opencv bullet jsoncpp suitesparse cairo ni nite OpenNI2 openni2 nss qwt openmpi mpi ImageMagick tirpc
    postgresql mysql mariadb Imath OpenEXR nspr superlu libxml2 schroedinger libcec coin Inventor opencascade oce
    hdf5 webkitgtk eigen2 serial atlas xenomai raul schifra ompl freetype
    """
)
_VERSIONED = re.compile(r"[A-Za-z][\w.+-]*?[-_.]?v?\d[\d.]*$")
_NOT_ROOTS = frozenset(("opencv2", "tinyxml2", "asm-x86_64", "i2c", "tf2"))
_ASIDE_INCLUDE = re.compile(r"usr/(?:lib|share)/(?!.*dist-packages)")
_MULTIARCH = re.compile(r"(?:x86_64|i386|aarch64)-linux-gnu/")
_COMPILER = re.compile(r"(?:c\+\+/[\d.]+|(?:x86_64-linux-gnu)/c\+\+/[\d.]+)/(.+)")
_GCC = re.compile(r"usr/lib/gcc(?:-cross)?/[^/]+/[\d.]+/(?:include|include-fixed)/(.+)")
_NO_HEADER = re.compile(
    r"\.(?:cmake|pc|mod|pas|txt|vala|a|so|py|json|xml|in|cu|cl|f90|f|gz|html|tcl|la|o|sh|rst|md|am|dox|png)$"
)
_PRIVATE = re.compile(r"(?:^|/)\d+\.\d+\.\d+/|/private/|(?:^|/)boost/.*/preprocessed/|/arch-|__pycache__")


def _is_root(folder: str) -> bool:
    return folder in _ROOTS or (folder not in _NOT_ROOTS and _VERSIONED.fullmatch(folder) is not None)


def include_paths(path: str) -> tuple[str, ...]:
    """How code may include an installed file: `usr/include/eigen3/Eigen/Core` gives that and `Eigen/Core`.

    Empty for what is no header. The first one is the path below the default include folder.
    """
    gcc = _GCC.match(path)
    if gcc:
        return (gcc.group(1),)
    if path.startswith("usr/include/"):
        rest = path[len("usr/include/") :]
    elif "/include/" in path and ("/dist-packages/numpy/" in path or _ASIDE_INCLUDE.match(path)):
        rest = path.split("/include/", 1)[1]
    else:
        return ()
    rest = _MULTIARCH.sub("", rest, count=1) if _MULTIARCH.match(rest) and not _COMPILER.match(rest) else rest
    compiler = _COMPILER.match(rest)
    if compiler:
        return (_MULTIARCH.sub("", compiler.group(1), count=1),)
    if _NO_HEADER.search(rest) or _PRIVATE.search(rest):
        return ()
    found = [rest]
    parts = rest.split("/")
    while len(parts) > 1:
        head = parts[0]
        again = parts.index(head, 1) if head in parts[1:-1] else 0
        if again:
            parts = parts[again:]
        elif (head.startswith("Qt") and len(parts) == 2) or (len(found) == 1 and _is_root(head)):
            parts = parts[1:]
        else:
            break
        found.append("/".join(parts))
    if rest.startswith("OGRE/") and rest.count("/") > 1:
        found.append(rest.rpartition("/")[2])
    return tuple(dict.fromkeys(found))


# Names that any project gives its own headers: without a folder they say nothing about whose they are.
_TOO_COMMON = _split_words(
    """
    config.h types.h common.h util.h utils.h version.h defs.h error.h errors.h log.h logger.h logging.h debug.h
    main.h list.h queue.h thread.h threads.h timer.h vector.h matrix.h array.h buffer.h object.h node.h event.h
    export.h global.h image.h info.h macros.h memory.h message.h misc.h options.h parser.h point.h settings.h
    socket.h stream.h string.h table.h test.h tools.h tree.h value.h window.h file.h base.h color.h core.h data.h
    constants.h context.h client.h server.h driver.h device.h camera.h frame.h function.h graph.h hash.h io.h math.h
    model.h filter.h platform.h visibility.h config.hpp types.hpp common.hpp utils.hpp version.hpp thread.hpp
    timer.hpp
    """
)
_CMAKE_CONFIG = re.compile(r"([^/]+?)(Config|-config)\.cmake$")
_CMAKE_FIND = re.compile(r"usr/share/cmake-[\d.]+/Modules/Find([^/]+)\.cmake$")
_PKGCONFIG = re.compile(r".*/pkgconfig/([^/]+)\.pc$")
_MODULE = re.compile(r"usr/(?:lib/python([23])[\d.]*/dist-packages|share/pyshared)/(.+)$")
_MODULE_FILE = re.compile(r"([A-Za-z_]\w*)(?:\.py|(?:\.[\w-]+)?\.so)?$")
_PROGRAM = re.compile(r"(?:usr/)?(?:s?bin|games)/([^/]+)$")


def list_cmake(path: str) -> tuple[str, ...]:
    """The find_package names that a file answers in config mode: `…/PCLConfig.cmake` gives `PCL`.

    `sdl2-config.cmake` gives `sdl2` and `sdl2-config`; the latter marks that any letter case finds it.
    """
    match = _CMAKE_CONFIG.search(path)
    if not match:
        return ()
    return (match.group(1),) if match.group(2) == "Config" else (match.group(1), f"{match.group(1).lower()}-config")


def list_modules(path: str) -> tuple[str, ...]:
    """Python modules that a file gives, outermost first: `…/dist-packages/ruamel/yaml/x.py` gives two names."""
    match = _MODULE.match(path)
    if not match or ".egg-info" in path or ".dist-info" in path:
        return ()
    parts = match.group(2).split("/")
    if parts[0].startswith("__pycache__"):
        return ()
    names: list[str] = []
    for place, part in enumerate(parts[:2]):
        plain = _MODULE_FILE.fullmatch(part)
        if not plain or (place == len(parts) - 1 and part == plain.group(1)):
            break
        if plain.group(1) == "__init__":
            break
        names.append(".".join([*names[-1:], plain.group(1)]))
    return tuple(names)


# The join


class _Reach(NamedTuple):
    """How a key brings a package: how many dependencies down, from which package that the key installs.

    Packages of one source are at distance 0: libopencv-dev exists to bring libopencv-core-dev.
    """

    distance: int
    package: str


def reach(keys: Keys, suites: Iterable[SuiteContents]) -> tuple[dict[str, dict[str, _Reach]], list[set[str]]]:
    """Debian package to the keys that bring it on some suite; for each suite the packages that any key brings there."""
    found: dict[str, dict[str, _Reach]] = defaultdict(dict)
    by_suite = []
    for suite in suites:
        here: set[str] = set()
        by_suite.append(here)
        for key, names in keys.debian.items():
            for start in names:
                if start not in suite.depends:
                    continue
                ring, seen = [start], {start}
                for distance in range(_HEADER_DEPTH + 1):
                    following = []
                    here.update(ring)
                    for name in ring:
                        old = found[name].get(key)
                        near = 0 if suite.source.get(name) == suite.source.get(start) else distance
                        if old is None or near <= old.distance:
                            found[name][key] = _Reach(near, start)
                        following.extend(d for d in suite.depends.get(name, ()) if d not in seen)
                        seen.update(following)
                    ring = following
                    if not ring:
                        break
    return found, by_suite


class _Names(NamedTuple):
    """name to the Debian packages that give it, and the suites (as bits) where one does."""

    packages: dict[str, set[str]]
    suites: dict[str, int]

    def add(self, name: str, packages: Iterable[str], bit: int) -> None:
        self.packages.setdefault(name, set()).update(packages)
        self.suites[name] = self.suites.get(name, 0) | bit


_COMPILER_PACKAGE = re.compile(
    r"libc6-dev(?:-\w+)?|linux-libc-dev|libcrypt-dev|libnsl-dev|gcc|(?:gcc|g\+\+|cpp)-[\d.]+"
    r"|lib(?:32|x32|64)?(?:stdc\+\+|gcc)-[\d.]+-dev"
)


def is_of_compiler(package: str) -> bool:
    """Whether a Debian package is behind the compiler and the C library: build-essential's headers, which everybody
    has."""
    return _COMPILER_PACKAGE.fullmatch(package) is not None


def _add_python_twins(names: Iterable[str]) -> set[str]:
    """Adds the Python 2 name of a Python 3 package and the other way round: keys of old distros name those."""
    found = set(names)
    for name in tuple(found):
        if name.startswith("python3-"):
            found.add("python-" + name[len("python3-") :])
        elif name.startswith("python-"):
            found.add("python3-" + name[len("python-") :])
    return found


class Tables(NamedTuple):
    """Everything that is written: for each kind of name, name to (providers, suites); providers as (key, package)."""

    header: dict[str, tuple[tuple[tuple[str, str], ...], int]]
    cmake: dict[str, tuple[tuple[tuple[str, str], ...], int]]
    pkgconfig: dict[str, tuple[tuple[tuple[str, str], ...], int]]
    module: dict[str, tuple[tuple[tuple[str, str], ...], int]]
    program: dict[str, tuple[tuple[tuple[str, str], ...], int]]


def join(suites: list[SuiteContents], keys: Keys) -> Tables:
    """Names of all suites with the rosdep keys that bring them, best key first."""
    reached, by_suite = reach(keys, suites)
    named = frozenset(package for packages in keys.debian.values() for package in packages)
    tables = [_Names({}, {}) for _ in range(5)]
    header, cmake, pkgconfig, module, program = tables
    compiler = frozenset(name for suite in suites for name in suite.depends if is_of_compiler(name))
    essential = frozenset().union(*(suite.essential for suite in suites))
    direct: set[str] = set()

    def has_compiler_package(packages: tuple[str, ...]) -> bool:
        return any(package in compiler for package in packages)

    for place, suite in enumerate(suites):
        installable = by_suite[place] | compiler | essential
        for path, packages in suite.list_files():
            # A package that only another suite's keys bring tells who provides a name, not that this suite has it.
            bit = 0 if installable.isdisjoint(packages) else 1 << place
            packages = tuple(p for p in packages if p not in suite.ros or p in named)
            if not any(p in reached or p in compiler or p in essential for p in packages):
                if not path.startswith("usr/lib/python"):
                    continue
                packages = tuple(p for p in _add_python_twins(packages) if p in reached)
                if not packages:
                    continue
            for place_, name in enumerate(include_paths(path)):
                if "/" in name or name not in _TOO_COMMON or has_compiler_package(packages):
                    header.add(name, packages, bit)
                    if not place_:
                        direct.add(name)
            if path.endswith(".cmake"):
                own = _CMAKE_FIND.match(path)
                if own and "cmake-data" not in packages:
                    cmake.add(own.group(1), packages, bit)
                for name in list_cmake(path):
                    cmake.add(name, packages, bit)
            elif path.endswith(".pc"):
                match = _PKGCONFIG.match(path)
                if match:
                    pkgconfig.add(match.group(1), packages, bit)
            elif "-packages/" in path or "/pyshared/" in path:
                for name in list_modules(path):
                    module.add(name, _add_python_twins(packages), bit)
            else:
                match = _PROGRAM.match(path)
                if match:
                    program.add(match.group(1), packages, bit)
    ranked = _Ranking(reached, keys)
    return Tables(
        {
            name: (entry, header.suites[name] | (0 if "/" in name or name in direct else BY_FOLDER))
            for name, packages in header.packages.items()
            if (entry := (("", ""),) if packages & compiler else ranked.rank(packages, _HEADER_DEPTH))
        },
        _rank(cmake, ranked, _HEADER_DEPTH),
        _rank(pkgconfig, ranked, _HEADER_DEPTH),
        _drop_repetition(_rank(module, ranked, _MODULE_DEPTH)),
        {
            name: (entry, program.suites[name])
            for name, packages in program.packages.items()
            if (entry := (("", ""),) if packages & essential else ranked.rank(packages, _PROGRAM_DEPTH))
        },
    )


class _Ranking:
    """Providers of a set of Debian packages, best first: nearest, then most used in released manifests."""

    def __init__(self, reached: Mapping[str, Mapping[str, _Reach]], keys: Keys):
        self._reached, self._uses = reached, keys.uses
        self._known: dict[tuple[frozenset[str], int], tuple[tuple[str, str], ...]] = {}

    def rank(self, packages: Iterable[str], depth: int) -> tuple[tuple[str, str], ...]:
        wanted = frozenset(packages)
        known = self._known.get((wanted, depth))
        if known is None:
            best: dict[str, _Reach] = {}
            for package in wanted:
                for key, way in self._reached.get(package, {}).items():
                    if way.distance <= depth and (key not in best or way.distance < best[key].distance):
                        best[key] = way
            nearest = min((way.distance for way in best.values()), default=0)
            order = sorted(best, key=lambda k: (best[k].distance - nearest, -self._uses[k], len(k), k))
            known = self._known[wanted, depth] = tuple((key, best[key].package) for key in order)
        return known


def _rank(names: _Names, ranked: _Ranking, depth: int) -> dict[str, tuple[tuple[tuple[str, str], ...], int]]:
    return {
        name: (entry, names.suites[name])
        for name, packages in names.packages.items()
        if (entry := ranked.rank(packages, depth))
    }


def _drop_repetition(
    modules: dict[str, tuple[tuple[tuple[str, str], ...], int]],
) -> dict[str, tuple[tuple[tuple[str, str], ...], int]]:
    """Drops `a.b` where `a` has the same providers: the lookup falls back to it."""
    return {
        name: entry
        for name, entry in modules.items()
        if "." not in name or modules.get(name.partition(".")[0], ((), 0))[0] != entry[0]
    }


# Writing


def write(tables: Tables, platforms: list[str], ros: RosFacts, output: Path) -> bytes:
    """Writes the database (packed, with its hash beside it) into the data folder; gives the unpacked bytes."""
    import zstandard

    connection = sqlite3.connect(":memory:")
    connection.executescript(SCHEMA)
    connection.executemany("INSERT INTO platform VALUES(?, ?)", enumerate(platforms))
    sets: dict[tuple[tuple[str, str], ...], int] = {}
    for table, names in zip(("header", "cmake", "pkgconfig", "module", "program"), tables, strict=True):
        connection.executemany(
            f"INSERT INTO {table} VALUES(?, ?, ?)",
            ((name, sets.setdefault(entry, len(sets)), bits) for name, (entry, bits) in sorted(names.items())),
        )
    connection.executemany(
        "INSERT INTO provider VALUES(?, ?)",
        ((number, "\n".join(k if k == p else f"{k} {p}" for k, p in entry)) for entry, number in sets.items()),
    )
    patterns: dict[str, int] = {}
    connection.executemany(
        "INSERT INTO ros_header VALUES(?, ?, ?)",
        ((h, p, patterns.setdefault(text, len(patterns))) for (h, p), text in sorted(ros.headers.items())),
    )
    connection.executemany(
        "INSERT INTO ros_package VALUES(?, ?)",
        ((p, patterns.setdefault(text, len(patterns))) for p, text in sorted(ros.packages.items())),
    )
    connection.executemany("INSERT INTO pattern VALUES(?, ?)", ((n, text) for text, n in patterns.items()))
    connection.executemany("INSERT INTO ros_module VALUES(?, ?)", sorted(ros.modules.items()))
    connection.executemany("INSERT INTO ros_cmake VALUES(?, ?)", sorted(ros.cmake.items()))
    connection.commit()
    connection.execute("VACUUM")
    raw = _dump_database(connection)
    packed = zstandard.ZstdCompressor(level=22).compress(raw)
    write_file(output / "providers.sqlite.zst", packed)
    sha = hashlib.sha256(raw).hexdigest()
    about = msgspec.json.format(msgspec.json.encode({"sha256": sha}), indent=1) + b"\n"
    write_file(output / "providers.json", about)
    return raw


def _dump_database(connection: sqlite3.Connection) -> bytes:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "providers.sqlite"
        with contextlib.closing(sqlite3.connect(path)) as disk:
            disk.execute("PRAGMA page_size=4096")
            connection.backup(disk)
        return path.read_bytes()


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", action="append", default=[], help='"ubuntu jammy=LISTS"')
    parser.add_argument("--repositories", type=Path, help="folder of bare clones, OWNER+NAME or OWNER+NAME/repo")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    suites = []
    for item in given.suite:
        platform, _, lists = item.partition("=")
        suites.append(read_suite(platform, Path(lists)))
        print(platform, len(suites[-1].depends), "packages", flush=True)
    tables = join(suites, read_keys(load_snapshot()))
    ros = read_repositories(given.repositories) if given.repositories else RosFacts({}, {}, {}, {})
    raw = write(tables, [suite.platform for suite in suites], ros, given.output)
    print({name: len(part) for name, part in zip(Tables._fields, tables, strict=True)}, len(raw), "bytes unpacked")


if __name__ == "__main__":
    main()
