"""Builds data/compiled.json.zst: which C and C++ names need a link, since they are compiled into a library.

    python -P -m rosimpact.databuild.compiled WORK [--suite bookworm=APT_CONF] [--clones CLONES] --output DATA

Of a suite of Debian the shared libraries of the packages in data/libraries.sqlite are downloaded with the development
packages, and of those that have no shared ones the static libraries; and those of the packages of ROS 1 that Debian
has. What a library defines for itself counts (`nm`: a strong symbol); inline functions and templates are in it as weak
symbols, or not at all. Of packages of ROS that Debian has not, the sources of the newest release in a clone tell: a
function that a compiled file of an installed library defines.

Kept are names that a header declares: functions without a receiver, and classes of which no object can be made without
the library, since each constructor, or the destructor, is compiled into it. A function of C may be declared by macros
(`YAML_DECLARE(int) yaml_parser_load(...)`): of these the word before a parenthesis in a header counts. Names,
libraries and packages only.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path

import msgspec
import zstandard

from ..edges.files import write_file
from ..impact.facts.cpp.lexical import COMMENT, scan
from ..impact.facts.store import Store
from ..impact.facts.surface import CLASSES, Entity, list_offered
from ..impact.targets.providers.compiled import FILE, CompiledTable
from ..impact.targets.providers.libraries import load_libraries
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import parse
from ..impact.tree import TreeError
from .extract.cpp_directives import blank_directives
from .libraries import count_uses, find_lists, read_fields
from .providers import is_ros_source, read_dependencies
from .surface.clones import Clone, VersionError
from .surface.package import build_surfaces, link_build, list_compiled
from .surface.unpacked_deb import DebError, read_members_and_links
from .table_file import write_table

_LARGEST = 120_000_000
"""Bytes of the packages of a library above which it is left out: makers' own archives of all that they have."""
_RARE = 50
"""Libraries of which manifests name the packages less often are left out."""
_SHARED = re.compile(r"(?:usr/)?lib/(?:[^/]*/)*?lib([\w.+-]+?)(?:-[\d.]+)?\.so[\d.]*\Z")
_HEADER = re.compile(r"usr/include/.*\.(?:h|hh|hpp|hxx)\Z")
_STATIC = re.compile(r"(?:usr/)?lib/(?:[^/]*/)*?lib([\w.+-]+)\.a\Z")
_SYMBOL = re.compile(r"^[0-9a-f]* *([TBDRSi]) (.+)$", re.MULTILINE)
_TAG = re.compile(r"\[abi:\w+\]|@+[\w.]+\Z")
_HEAD = re.compile(r"([A-Za-z_][\w:]*(?:::~\w+)?)(?:\(|\Z)")
_TABLE = "vtable for "
_DEFINED = re.compile(r"^([\w \t:<>,&*]*?)\b((?:\w+::)*~?\w+)[ \t]*\(([^;{}]{0,1000})\{", re.MULTILINE)
"""A function that is defined at the start of a line."""
_RELEASE = re.compile(r"v?\d+(?:\.\d+)+")
_CALLED = re.compile(r"\b([A-Za-z_]\w*)(?:\s*\(|\s+[A-Z_][A-Z0-9_]*\s*\(\()")
"""A word before a parenthesis, or before a macro for compilers of old: `deflate OF((z_streamp strm, int flush))`."""
_Kept = tuple[dict[str, set[str]], set[str], dict[str, str], bool, set[str]]
_NAME = re.compile(r"[A-Za-z]\w*(?:::[A-Za-z]\w*)*\Z")
_PARTS = 2
"""A library of more parts is left out: which of them a name needs hangs on the version, and whoever links one part gets
others along."""
_SHORTEST = 6
"""Characters of a name of C below which a word may mean anything."""


class Symbols:
    """What libraries define for themselves. overloads: functions by their names, without what is around them where
    `outer` is not known. tables: classes whose table of virtual functions is theirs. stems: of the library that has a
    name, as it is linked. whole: whether names are qualified by their namespaces. called: words that stand before a
    parenthesis in headers."""

    def __init__(
        self,
        overloads: Mapping[str, set[str]] | None = None,
        tables: Iterable[str] = (),
        stems: Mapping[str, str] | None = None,
        whole: bool = True,
        called: Iterable[str] = (),
    ) -> None:
        self.overloads: dict[str, set[str]] = defaultdict(set, overloads or {})
        self.tables, self.stems = set(tables), dict(stems or {})
        self.whole, self.called = whole, set(called)

    def add(self, stem: str, text: str) -> None:
        """What `nm -C` prints of a library. stem: as it is linked."""
        for kind, name in _SYMBOL.findall(text):
            plain = _TAG.sub("", name)
            if plain.startswith(_TABLE):
                if kind in "DRBS":
                    self.tables.add(plain.removeprefix(_TABLE))
                    self.stems.setdefault(plain.removeprefix(_TABLE), stem)
            elif kind in "Ti" and (head := _HEAD.match(plain)):
                self.overloads[head[1]].add(plain)
                self.stems.setdefault(head[1], stem)

    def list_c_functions(self, seen: Collection[str]) -> Iterator[str]:
        """Functions of C that headers declare in a way that is not read. seen: names whose declarations are."""
        for name, each in self.overloads.items():
            if name in self.called and each == {name} and name not in seen:
                yield name

    def select(self, declared: Iterable[Entity]) -> dict[str, str]:
        """Of what headers declare, the names that need a library, each with its stem; `{}` follows those of classes."""
        functions: dict[str, list[Entity]] = defaultdict(list)
        classes = set()
        for one in declared:
            if one.kind in ("function", "constructor", "destructor", "method"):
                functions[one.name].append(one)
            elif one.kind in CLASSES and one.template is None and not one.arguments:
                classes.add(one.name)
        found = {name: self._find_stem(name) for name in self.list_c_functions(functions.keys())}
        for name, each in functions.items():
            alone = all(one.kind == "function" or (one.kind == "method" and "static" in one.traits) for one in each)
            if alone and self._has_all(name, each):
                found[name] = self._find_stem(name)
        for name in classes:
            if (holder := self._find_holder(name, functions)) is not None:
                found[f"{name}{{}}"] = self._find_stem(holder)
        kept = ((name, stem) for name, stem in found.items() if _NAME.match(name.removesuffix("{}")))
        return {name: stem for name, stem in kept if "::" in name or len(name) >= _SHORTEST}

    def _spell(self, name: str) -> Iterator[str]:
        """How a name may be written here: by itself, and as its last parts where namespaces are not known."""
        yield name
        parts = name.split("::")
        if not self.whole:
            yield from ("::".join(parts[place:]) for place in range(1, len(parts)))

    def _find_stem(self, name: str) -> str:
        return next((self.stems[one] for one in self._spell(name) if one in self.stems), "")

    def _list_overloads(self, name: str) -> Collection[str]:
        return next((self.overloads[one] for one in self._spell(name) if one in self.overloads), ())

    def _has_all(self, name: str, each: Collection[Entity]) -> bool:
        """Whether all functions of a name are compiled into a library."""
        if any(one.template is not None or not _OWN.isdisjoint(one.traits) for one in each):
            return False
        return len(self._list_overloads(name)) >= len({_make_key(one) for one in each}) > 0

    def _find_holder(self, name: str, functions: Mapping[str, list[Entity]]) -> str | None:
        """What of a class shows that each of its objects needs a library: its destructor, its table of virtual
        functions, or its constructors; None where nothing does."""
        last = name.rpartition("::")[2]
        whole = f"{name}::~{last}", f"{name}::{last}"
        if self.whole and (self._list_overloads(whole[0]) or name in self.tables):
            return whole[0] if whole[0] in self.stems else name
        destroyed = [one for one in functions.get(whole[0], ()) if _OWN.isdisjoint(one.traits)]
        if not self.whole and destroyed and any(f"{last}::~{last}" in one for one in self._list_overloads(whole[0])):
            return whole[0]
        made = [one for one in functions.get(whole[1], ()) if "deleted" not in one.traits]
        if not self.whole and not any(f"{last}::{last}" in one for one in self._list_overloads(whole[1])):
            return None
        return whole[1] if made and self._has_all(whole[1], made) else None


_OWN = frozenset(("inline", "constexpr", "consteval", "defaulted", "pure", "deleted", "friend"))


def _make_key(one: Entity) -> tuple[object, ...]:
    return (tuple(parameter.type for parameter in one.parameters or ()), "const" in one.traits)


def read_symbols(files: Iterable[tuple[str, bytes]], symbols: Symbols) -> None:
    """Adds what libraries define, and what headers name. files: paths with what they hold; a shared library hides what
    its static one has. Several libraries may have one stem, with other versions in their names."""
    shared: dict[tuple[str, bytes], None] = {}
    static: dict[tuple[str, bytes], None] = {}
    for path, data in files:
        if found := _SHARED.match(path):
            shared[found[1], data] = None  # a link has what it leads to
        elif found := _STATIC.match(path):
            static[found[1], data] = None
        elif _HEADER.match(path):
            symbols.called.update(_CALLED.findall(blank_directives(scan(data))[0]))
    for stem, data in shared or static:
        with tempfile.NamedTemporaryFile() as file:
            file.write(data)
            file.flush()
            options = ["-D"] if shared else []
            ran = subprocess.run(
                ["nm", *options, "-C", "--defined-only", file.name], capture_output=True, text=True, check=False,
                errors="replace",
            )  # fmt: skip
        symbols.add(stem, ran.stdout)


class SuiteSymbols:
    """What the libraries of a suite define. work: the folder that keeps it."""

    def __init__(self, work: Path, suite: str, configuration: Path):
        self.platform = f"debian {suite}"
        self._work, self._configuration = work / suite, configuration
        self._debs = self._work / "debs"
        self._work.mkdir(parents=True, exist_ok=True)
        lists = find_lists(configuration)
        self._fields, self._depends = read_fields(lists), read_dependencies(lists)

    def _get_source(self, name: str) -> str:
        return self._fields[name].get("Source", name).partition(" ")[0]

    def _holds_libraries(self, name: str) -> bool:
        return name in self._fields and self._fields[name].get("Section", "").endswith("libs")

    def read(self, library: str, packages: Collection[str]) -> Symbols:
        """The symbols of packages, remembered as those of a library."""
        kept = self._find_kept(library)
        if kept.exists():
            data = zstandard.ZstdDecompressor().decompress(kept.read_bytes())
            return Symbols(*msgspec.msgpack.decode(data, type=_Kept))
        symbols = Symbols()
        read_symbols(self._read_packages(packages), symbols)
        form = (symbols.overloads, symbols.tables, symbols.stems, symbols.whole, symbols.called)
        write_file(kept, zstandard.ZstdCompressor(level=9).compress(msgspec.msgpack.encode(form)))
        return symbols

    def _find_kept(self, library: str) -> Path:
        return self._work / f"{library}.msgpack.zst"

    def download(self, wanted: Iterable[tuple[str, Collection[str]]]) -> None:
        """Downloads the packages of libraries that were not read yet, in one go: apt takes long to start."""
        names = [name for library, packages in wanted if not self._find_kept(library).exists() for name in packages]
        self._debs.mkdir(exist_ok=True)
        asked = [f"{name}={self._fields[name]['Version']}" for name in names if not list(self._debs.glob(f"{name}_*"))]
        if asked:
            subprocess.run(
                ["apt-get", "-qq", "download", *asked], cwd=self._debs, check=False, capture_output=True,
                env={**os.environ, "APT_CONFIG": str(self._configuration)},
            )  # fmt: skip

    def _read_packages(self, packages: Iterable[str]) -> Iterator[tuple[str, bytes]]:
        """The libraries and headers in downloaded packages: paths with what they hold."""
        for file in (file for name in packages for file in self._debs.glob(f"{name}_*.deb")):
            try:
                held, _ = read_members_and_links(file)
            except (DebError, OSError) as error:
                print(file.name, error, flush=True)
                continue
            for path, member in held.items():
                if _SHARED.match(path) or _STATIC.match(path) or _HEADER.match(path):
                    yield path, member.data
            file.unlink()

    def list_libraries(self) -> Iterator[tuple[str, list[str]]]:
        """Each library that manifests name, with the packages that hold it: its development packages, and the shared
        ones of the same source that these need."""
        uses = count_uses()
        developing: dict[str, set[str]] = defaultdict(set)
        for name in self._fields:
            if library := load_libraries().find_by_package(name):
                developing[library].add(name)
        for library, names in sorted(developing.items()):
            if sum(uses[name] for name in names) < _RARE:
                continue
            sources = {self._get_source(name) for name in names}
            sources |= {self._get_source(other) for name in names for other in self._depends.get(name, ())
                        if load_libraries().find_by_package(other) == library}  # fmt: skip
            held = {other for name in names for other in self._depends.get(name, ())
                    if self._holds_libraries(other) and self._get_source(other) in sources}  # fmt: skip
            packages = sorted(held | names)
            if sum(int(self._fields[name]["Size"]) for name in held or names) > _LARGEST:
                print(library, "is too large and was not read", flush=True)
                continue
            yield library, packages

    def list_ros(self) -> list[str]:
        """The packages with shared libraries of ROS."""
        return sorted(
            name for name in self._fields if self._holds_libraries(name) and is_ros_source(self._get_source(name))
        )


def build_system_names(suite: SuiteSymbols) -> dict[str, dict[str, str]]:
    """Library to stem to the names that need it."""
    found = {}
    libraries = list(suite.list_libraries())
    suite.download(libraries)
    for library, packages in libraries:
        declared = load_libraries().list_declared(library, suite.platform)
        names = _group_names(suite.read(library, packages).select(declared))
        print(library, len(packages), "packages,", sum(len(each.split()) for each in names.values()), flush=True)
        if 0 < len(names) <= _PARTS:
            found[library] = names
    return found


def _group_names(names: Mapping[str, str]) -> dict[str, str]:
    by_stem: dict[str, list[str]] = defaultdict(list)
    for name, stem in names.items():
        by_stem[stem].append(name)
    return {stem: " ".join(sorted(each)) for stem, each in sorted(by_stem.items())}


def build_ros_names(suite: SuiteSymbols) -> dict[str, list[str]]:
    """Packages of ROS 1 to their names that need a link, by the libraries of a suite."""
    suite.download([("ros", suite.list_ros())])
    symbols = suite.read("ros", suite.list_ros())
    found = {}
    for package in sorted(load_shipped().packages):
        history = load_shipped().find_history(package, 1)
        if history is None:
            continue
        version = history.versions[-1]
        build = history.build(version, ("libraries",))
        own = {package, *(build.libraries if build is not None else ())}
        names = symbols.select(history.list_entities(version))
        if kept := sorted(name for name, stem in names.items() if stem in own):
            found[package] = kept
    return found


# -- sources -----------------------------------------------------------------------------------------------------------


def build_source_names(clones: Path) -> dict[tuple[str, int], list[str]]:
    """The same by the sources of the newest release in each clone, by package and generation of ROS."""
    found = {}
    with Store() as store:
        for place in sorted(clones.iterdir()):
            try:
                clone = Clone(place)
                tree = clone.read_tree(_find_newest(clone))
                workspace = link_build(tree, store)
                surfaces = build_surfaces(tree, store)
            except (TreeError, VersionError, OSError) as error:
                print(f"{place.name}: {error}", file=sys.stderr, flush=True)
                continue
            for package in workspace:
                symbols = read_sources(list_compiled(package), tree.read)
                declared = (one for _, header in surfaces[package.name].headers for one in list_offered((header,)))
                names = symbols.select(declared)
                if names:
                    found[package.name, 1 if package.build_type == "catkin" else 2] = sorted(names)
    return found


def _find_newest(clone: Clone) -> str:
    """The tag of the newest release of a clone, or the state that it is at."""
    released = {tag: ref for tag, ref in clone.tags.items() if _RELEASE.fullmatch(tag)}
    return released[max(released, key=lambda tag: parse(tag.removeprefix("v")))] if released else "HEAD"


def read_sources(paths: Iterable[str], load: Callable[[str], bytes]) -> Symbols:
    """What compiled files define outside of classes, without their namespaces: `Class::function`, `function`."""
    symbols = Symbols(whole=False)
    for path in paths:
        try:
            data = load(path)
        except OSError:
            continue  # what the build generates
        plain = COMMENT.sub(" ", data.decode("utf-8", "replace"))
        for found in _DEFINED.finditer(plain):
            if "inline" not in found[1].split() and "template" not in plain[max(0, found.start() - 200):found.start()]:
                symbols.overloads[found[2]].add(f"{found[2]}({found[3]})")
                symbols.stems.setdefault(found[2], "")
    return symbols


# -- the table ---------------------------------------------------------------------------------------------------------


def build_table(system: Mapping[str, dict[str, str]], ros: Mapping[tuple[str, int], Iterable[str]]) -> CompiledTable:
    """The shipped table. A name that two packages or libraries have tells of neither."""
    of_ros: dict[int, dict[str, str]] = {1: {}, 2: {}}
    for (package, generation), names in sorted(ros.items()):
        of_ros[generation][package] = " ".join(names)
    return CompiledTable(dict(system), of_ros)


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=Path)
    parser.add_argument("--suite", default="", help='"bookworm=APT_CONF"')
    parser.add_argument("--clones", type=Path)
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    before = read_table(given.output / FILE, CompiledTable) if (given.output / FILE).exists() else CompiledTable()
    system = before.system
    ros = {(name, one): each.split() for one, packages in before.ros.items() for name, each in packages.items()}
    if given.suite:
        name, _, configuration = given.suite.partition("=")
        suite = SuiteSymbols(given.work, name, Path(configuration))
        system = build_system_names(suite)
        ros.update(((name, 1), names) for name, names in build_ros_names(suite).items())
    if given.clones is not None:
        for key, names in build_source_names(given.clones).items():
            ros.setdefault(key, names)
    size = write_table(given.output / FILE, build_table(system, ros), level=22)
    print(len(system), "libraries,", len(ros), "packages,", size, "bytes packed")


if __name__ == "__main__":
    main()
