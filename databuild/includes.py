"""Builds data/includes.json.zst: which headers each header of a library or ROS package includes, version by version.

    python -P -m rosimpact.databuild.includes FOLDER --installed boost=1.74=DIR ... --output DATA
    python -P -m rosimpact.databuild.includes --shipped

FOLDER holds git clones (`OWNER+NAME`, or a git directory below it); their release tags are read. Boost is put together
from all clones of `boostorg` that are named, at the tags of versions that some platform has. DIR is an include folder
of one version, for libraries whose repositories are too large to be read; a Debian package unpacked has one.
With `--onto`, what the table that is there tells stays, and only what is named is read: libraries with clones anew,
others as more versions. Only names and versions are kept. What the shipped surfaces tell is left out; `--shipped` does
only that, to the shipped table, when they are new.

Headers of detail folders are not kept: what they include counts as included by who includes them.
"""

from __future__ import annotations

import argparse
import re
from collections import Counter, defaultdict
from collections.abc import Container, Iterable, Iterator, Sequence
from functools import cache
from itertools import pairwise
from pathlib import Path

import msgspec

from ..impact.facts.condition import Condition
from ..impact.targets.changes import DISTROS
from ..impact.targets.distro.distro import DistroTarget
from ..impact.targets.providers import includes
from ..impact.targets.surface.includes import Included
from ..impact.targets.surface.store import TYPES, Surfaces, load_shipped
from ..impact.targets.tables import DATA
from ..impact.targets.version import parse
from .history import _find_tree
from .surface.releases import find_git_directory
from .table_file import write_table

_HEADER = re.compile(r"(?:\.(?:h|hh|hpp|hxx|h\+\+|inl|ipp|tcc)(?:\.in|\.em|\.template)?|/[A-Z][A-Za-z]+)$")
_INNER = re.compile(r"(?:^|/)(?:details?|impl|internal|aux_|preprocessed|src|arch|private|hal|cuda|experimental/impl)/")
_ASIDE = frozenset(
    (
        *("test", "tests", "doc", "docs", "example", "examples", "benchmark", "third_party", "3rdparty"),
        *("mock_core", "gpu", "cuda", "recognition", "outofcore", "simulation", "people", "apps"),
    )
)
_LIBRARIES = {
    "PointCloudLibrary+pcl": "pcl",
    "jbeder+yaml-cpp": "yaml-cpp",
    "flexible-collision-library+fcl": "fcl",
    "ros+console_bridge": "console-bridge",
    "ros+urdfdom_headers": "urdfdom-headers",
    "orocos+orocos_kinematics_dynamics": "orocos-kdl",
    "google+googletest": "gtest",
    "OctoMap+octomap": "octomap",
    "libav+libav": "libav",
    "apache+logging-log4cxx": "log4cxx",
}
"""Clones of platform libraries, by their names in platform_versions.yaml; all others but Boost's hold ROS packages."""
_BOOST = "boostorg+"
"""How clones of Boost's libraries begin."""
AV_HEADERS = re.compile(
    r"lib(?:avutil/\w+|avcodec/(?:avcodec|codec\w*|packet|defs|bsf|version\w*|old_codec_ids)"
    r"|avformat/(?:avformat|avio|version\w*)|avdevice/(?:avdevice|version\w*)|swscale/(?:swscale|version\w*))\.h"
)
"""Headers of libav and FFmpeg that programs include, or that those include."""
# Headers that a library's build makes, and that include nothing.
_MADE = {"libav": ("libavutil/avconfig.h",)}
# Interfaces of rclcpp's nodes, for which its build makes headers from templates.
_INTERFACES = tuple(
    f"node_{name}"
    for name in ("base", "clock", "graph", "logging", "parameters", "services", "time_source", "timers", "topics",
                 "type_descriptions", "waitables")
)  # fmt: skip
# Headers of large libraries that programs include themselves; of others, only those that something includes are kept.
_MEANT = re.compile(
    r"boost/(?:algorithm/string|any|array|asio|bind|chrono|date_time(?:/\w+)?|filesystem|format|function|functional"
    r"|interprocess(?:/sync)?|iostreams(?:/\w+)?|iterator|lexical_cast|math(?:/special_functions)?|multi_array|optional"
    r"|program_options|property_tree|random|range(?:/\w+)?|serialization|signals2|smart_ptr|system|thread|timer|tuple"
    r"|unordered|utility|uuid|variant)/\w+\.hpp|opencv2/(\w+)/\1\.hpp"
)
_VERSION = re.compile(r"(?:(?:rel/)?v|pcl-|release-|yaml-cpp-|ros2_|[a-z_]+-)?(\d+(?:[._]\d+){1,3})$")
_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
_DIRECTIVE = re.compile(
    r"^[ \t]*#[ \t]*(include|if|ifdef|ifndef|elif|else|endif)\b[ \t]*((?:[^\n\\]|\\\n)*)", re.MULTILINE
)
# Macros of other compilers, systems and processors, and of parts that no package of ROS compiles.
_ELSEWHERE = re.compile(
    r"(?:_WIN32|WIN32|_MSC_VER|__APPLE__|__BORLANDC__|__CODEGEARC__|_WIN64|__CYGWIN__|__MINGW\w*|_LIBCPP_VERSION|__QNX\w*"
    r"|__ANDROID__|__VXWORKS__|HAVE_AV_CONFIG_H|__CUDACC__|__CUDA_ARCH__|__CUDA__|__NVCC__|__HIPCC__|__HIP\w*|__SYCL\w*"
    r"|__SUNPRO_CC|__sun|__hpux|__HP_aCC|__IBMCPP__|__ibmxl__|_AIX|__sgi|__INTEL_COMPILER|__ICL|__ICC|__clang__|__DMC__"
    r"|__MWERKS__|__COMO__|__GCCXML__|__WATCOMC__|__EDG__|__PATHCC__|__PGI|_CRAYC|_STLPORT_VERSION|__SGI_STL_PORT"
    r"|_RWSTD_VER|__FreeBSD__|__OpenBSD__|__NetBSD__|__DragonFly__|__EMSCRIPTEN__|__BEOS__|__HAIKU__|__CLOUDABI__"
    r"|EIGEN_GPU\w*|EIGEN_CUDA\w*|EIGEN_HIP\w*|EIGEN_HAS_GPU\w*|EIGEN_USE_(?:SYCL|GPU|MKL\w*|BLAS|LAPACKE\w*)"
    r"|EIGEN_COMP_(?:MSVC|CLANG|ICC|ARM|PGI|IBM)|EIGEN_VECTORIZE_(?:NEON|ALTIVEC|VSX|ZVECTOR|MSA|SVE)"
    r"|__ARM\w*|__ALTIVEC__|__VSX__|__ZVECTOR__|__wasm\w*|__powerpc\w*|__mips\w*|__sparc\w*|__SWITCH__)\Z"
)
_WORD = re.compile(r"defined\s*(?:\(\s*(\w+)\s*\)|(\w+))|\b([A-Za-z_]\w*)\b")


def _replace_foreign_macros(text: str) -> str:
    """A test with 0 for every macro that GCC on Linux surely lacks."""

    def replace_macro(match: re.Match[str]) -> str:
        name = match[1] or match[2] or match[3]
        return "0" if _ELSEWHERE.match(name) else match[0]

    return _WORD.sub(replace_macro, text.replace("\\\n", " "))


def list_includes(text: str) -> tuple[str, ...]:
    """Include paths of a header, without those that GCC on Linux surely skips."""
    found: dict[str, None] = {}
    groups: list[_Group] = []
    for directive, rest in _DIRECTIVE.findall(_COMMENT.sub(lambda m: "\n" * m.group().count("\n"), text)):
        if directive in ("if", "ifdef", "ifndef"):
            groups.append(_Group())
            groups[-1].reach(_evaluate_directive(directive, rest))
        elif directive in ("else", "elif") and groups:
            groups[-1].reach(None if directive == "else" else _evaluate_directive("if", rest))
        elif directive == "endif" and groups:
            groups.pop()
        elif directive == "include" and all(group.read for group in groups):
            path = re.match(r'[<"]\s*([^>"]+?)\s*[>"]', rest)
            if path:
                found[path.group(1)] = None
    return tuple(found)


class _Group:
    """The branches of one #if. read: whether the branch that was reached last may be read."""

    def __init__(self) -> None:
        self.read, self.done = True, False

    def reach(self, test: bool | None) -> None:
        """The next branch, and whether its test holds."""
        self.read = not self.done and test is not False
        self.done = self.done or test is True


def _evaluate_directive(directive: str, rest: str) -> bool | None:
    from ..impact.conditions import Environment, holds

    text = rest if directive == "if" else f"defined({rest.split()[0] if rest.split() else ''})"
    condition = Condition("cpp", _replace_foreign_macros(text), directive == "ifndef")
    return holds(condition, Environment())


# Where a class, structure, enumeration or alias of a namespace is defined or only announced.
_TOKEN = re.compile(
    r"\bnamespace\s+(?P<space>[\w:]+)\s*(?:\[\[.*?\]\]\s*)?\{|\b(?:class|struct)\s+(?:[A-Z][A-Z0-9_]{3,}\s+|alignas\([^)]*\)\s*)*(?P<type>[A-Za-z_]\w*)"
    r"\s*(?P<after>final\b|[;{:<])|\busing\s+(?P<alias>\w+)\s*=|\btypedef\b[^;{}]*?\b(?P<old>\w+)\s*;|[{}]"
)


def find_types(text: str) -> tuple[frozenset[str], frozenset[str]]:
    """Qualified names of types that a header defines, and of those that it only announces."""
    text = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', _COMMENT.sub(" ", text))
    text = re.sub(r"^[ \t]*#(?:[^\n\\]|\\\n|\\)*", "", text, flags=re.MULTILINE)
    names, announced, stack = set(), set(), []
    for match in _TOKEN.finditer(text):
        token = match.group()
        inside = None not in stack
        prefix = "::".join(s for s in stack if s) + "::" if stack else ""
        if match.group("space"):
            stack.append(match.group("space") if inside else None)
        elif match.group("type"):
            after = match.group("after")
            if inside and prefix:
                (announced if after == ";" else names).add(prefix + match.group("type"))
            if after == "{":
                stack.append(None)
        elif match.group("alias") or match.group("old"):
            if inside and prefix:
                names.add(prefix + (match.group("alias") or match.group("old")))
        elif token == "{":
            stack.append(None)
        elif stack:
            stack.pop()
    return frozenset(names), frozenset(announced - names)


_PRIVATE = re.compile(
    r"^(?:std|testing|cv|tl|boost|Eigen)::|(?:^|::)(?:detail|details|impl|internal|deprecated)(?:::|_)|_impl$"
)


_MANY = 4
"""Headers that define a name, which is then too common to be one type."""


class HeaderContent(msgspec.Struct, frozen=True):
    """What one state of a header includes, defines and announces."""

    includes: tuple[str, ...]
    defined: frozenset[str]
    announced: frozenset[str]


def _read(data: bytes) -> HeaderContent:
    text = data.decode("utf-8", "replace")
    return HeaderContent(list_includes(text), *find_types(text))


class ClonePackages:
    """The packages of a git clone at any tag: package to include path to header."""

    def __init__(self, repository, library: str):
        self.repository, self.library = repository, library
        self.blobs: dict[bytes, HeaderContent] = {}
        self.trees: dict[bytes, dict[str, dict[str, bytes]]] = {}

    def read_packages(self, tree) -> dict[str, dict[str, bytes]]:
        """Package to include path to blob; a platform library is one package."""
        if self.library:
            headers: dict[str, bytes] = {}
            for path, entry in _walk(tree, ""):
                self._add(headers, path, entry, "")
            for path in _MADE.get(self.library, ()) if headers else ():
                self.blobs.setdefault(b"", HeaderContent((), frozenset(), frozenset()))
                headers.setdefault(path, b"")
            return {self.library: headers}
        known = self.trees.get(tree.id.raw)
        if known is None:
            known = self.trees[tree.id.raw] = self._find_packages(tree)
        return known

    def _find_packages(self, tree) -> dict[str, dict[str, bytes]]:
        entries = {entry.name: entry for entry in tree}
        manifest = entries.get("package.xml")
        if manifest is not None and manifest.type_str == "blob":
            match = _NAME.search(manifest.data)
            headers: dict[str, bytes] = {}
            name = match.group(1).decode("utf-8", "replace") if match else ""
            for path, entry in _walk(tree, ""):
                self._add(headers, path, entry, name)
            return {name: headers}
        found = {}
        for name, entry in entries.items():
            if entry.type_str == "tree" and name not in _ASIDE and not name.startswith("."):
                found.update(self.read_packages(entry))
        return found

    def _add(self, headers: dict[str, bytes], path: str, entry, package: str) -> None:
        if not _HEADER.search("/" + path):
            return
        head, found, rest = f"/{path}".partition("/include/")
        if path.startswith(f"src/{package}/") and package == "rviz":
            found, rest, head = "x", path.removeprefix("src/"), ""
        if self.library == "orocos-kdl" and path.startswith("orocos_kdl/src/"):
            found, rest, head = "x", "kdl/" + path.removeprefix("orocos_kdl/src/"), ""
        if self.library == "libav" and AV_HEADERS.fullmatch(path):
            found, rest, head = "x", path, ""
        if package.startswith("rosidl_generator_cpp") or package == "gencpp":
            return
        if path.startswith("resource/") and path.endswith((".h.em", ".hpp.em", ".hpp.in")):
            found, rest, head = "x", f"{package}/{path.removeprefix('resource/')}", ""
        if not found or _ASIDE & set(head.split("/")):
            return
        rest = re.sub(r"\.(?:in|em|template)$", "", rest)
        first, _, below = rest.partition("/")
        if below.startswith(first + "/") and first == package:
            rest = below
        if entry.id.raw not in self.blobs:
            self.blobs[entry.id.raw] = _read(entry.data)
        for name in _INTERFACES if rest in ("rclcpp/get_interface.hpp", "rclcpp/interface_traits.hpp") else ("",):
            made = rest.replace("rclcpp/get_", f"rclcpp/node_interfaces/get_{name}_") if name else rest
            made = made.replace("rclcpp/interface_", f"rclcpp/node_interfaces/{name}_interface_") if name else made
            headers.setdefault(made, entry.id.raw)


def _walk(tree, prefix: str):
    for entry in tree:
        if entry.type_str == "tree":
            yield from _walk(entry, f"{prefix}{entry.name}/")
        elif entry.type_str == "blob":
            yield prefix + entry.name, entry


State = dict[str, HeaderContent]
"""Include path to header, of one version of one owner."""


def read_clones(folder: Path, names: Iterable[str]) -> Iterator[tuple[str, str, State]]:
    """(package or library, version, its headers) at every release tag of the clones; Boost's last, of all its clones
    together. Of Boost, a version is left out that more than a tenth of the clones stop before."""
    whole: dict[str, dict[str, State]] = {}
    for name in names:
        if name.startswith(_BOOST):
            wanted = list_platform_versions("boost")
            whole[name] = {v: state for _, v, state in _read_clone(folder / name, "boost", wanted)}
        else:
            yield from _read_clone(folder / name, _LIBRARIES.get(name, ""))
    for version in sorted({v for found in whole.values() for v in found}, key=parse):
        begun = [found for found in whole.values() if any(parse(v) <= parse(version) for v in found)]
        there = [found[version] for found in begun if version in found]
        if len(there) * 10 >= len(begun) * 9:
            yield "boost", version, {path: header for state in there for path, header in state.items()}


def _read_clone(folder: Path, library: str, wanted: Container[str] | None = None) -> Iterator[tuple[str, str, State]]:
    """wanted: the versions that are read, by default all."""
    import pygit2

    where = find_git_directory(folder)
    if where is None:
        raise FileNotFoundError(f"{folder}: no git directory")
    repository = pygit2.Repository(str(where))
    clone = ClonePackages(repository, library)
    for ref in sorted(repository.references):
        match = _VERSION.match(ref.removeprefix("refs/tags/")) if ref.startswith("refs/tags/") else None
        version = match.group(1).replace("_", ".") if match else ""
        if not version or (wanted is not None and version not in wanted):
            continue
        tree = _find_tree(repository, ref)
        for package, headers in clone.read_packages(tree).items() if tree else ():
            yield package, version, {h: clone.blobs[b] for h, b in headers.items()}


@cache
def list_platform_versions(library: str) -> frozenset[str]:
    """The versions of a library that platforms have."""
    import yaml

    reported = yaml.safe_load((DATA / "platform_versions.yaml").read_bytes())["platforms"].values()
    return frozenset(libraries[library]["version"] for libraries in reported if library in libraries)


def read_generators(folder: Path) -> Iterator[tuple[str, str, State]]:
    """What a generated message header includes, as `message1` and `message2` of the generators' versions."""
    import pygit2

    for name, below, kind, package in (
        ("ros+gencpp", ("scripts", ""), "msg.h.template", "gencpp"),
        ("ros2+rosidl", ("rosidl_generator_cpp/resource",), ".em", "rosidl_generator_cpp"),
    ):
        where = find_git_directory(folder / name)
        repository = pygit2.Repository(str(where))
        for ref in sorted(repository.references):
            match = _VERSION.match(ref.removeprefix("refs/tags/")) if ref.startswith("refs/tags/") else None
            tree = match and _find_tree(repository, ref)
            if not match or not tree:
                continue
            found: dict[str, None] = {}
            for path, entry in _walk(tree, ""):
                if path.startswith(below) and path.endswith(kind):
                    text = entry.data.decode("utf-8", "replace")
                    found.update(
                        dict.fromkeys(p for p in re.findall(r"""['"\s]*#include\s*[<"]([\w./+]+)[>"]""", text))
                    )
                    found.update(dict.fromkeys(re.findall(r"^\s*'((?:rosidl|\w+/)[\w./]+\.hpp)',?$", text, re.M)))
            if found:
                yield package, match.group(1), {f"<{package}>": HeaderContent(tuple(found), frozenset(), frozenset())}


def read_folder(folder: Path) -> State:
    """The headers of an include folder."""
    return {
        path.relative_to(folder).as_posix(): _read(path.read_bytes())
        for path in sorted(folder.rglob("*"))
        if path.is_file() and _HEADER.search("/" + path.relative_to(folder).as_posix())
    }


_COMPUTED = {
    "boost/config.hpp": tuple(
        f"boost/config/{what}.hpp" for what in ("stdlib/libstdcpp3", "compiler/gcc", "platform/linux")
    ),
}
"""Headers to those that they include by a macro, with GCC on Linux."""


def list_direct(state: State, kept) -> dict[str, tuple[str, ...]]:
    """Header to what it includes, through headers that are not kept. kept: include path to whether it is."""

    def resolve_include(path: str, by: str) -> str:
        beside = by.rpartition("/")[0]
        while path.startswith("../"):
            path, beside = path[3:], beside.rpartition("/")[0]
        path = path.removeprefix("./")
        near = f"{beside}/{path}" if beside else path
        return near if near in state else path

    found = {}
    for header in state:
        if not kept(header):
            continue
        reached: dict[str, None] = {}
        stack, seen = [header], {header}
        while stack:
            at = stack.pop()
            for path in (*state[at].includes, *_COMPUTED.get(at, ())):
                to = resolve_include(path, at)
                if to in seen:
                    continue
                seen.add(to)
                if to in state and not kept(to):
                    stack.append(to)
                elif to != header:
                    reached[to] = None
        found[header] = tuple(sorted(reached))
    return found


def build_table(states: dict[str, dict[str, dict[str, tuple[str, ...]]]], libraries, sparse) -> includes.IncludesTable:
    """states: owner to version to header to its includes."""
    places: dict[str, int] = {}
    owners = {}
    for owner, versions in sorted(states.items()):
        order = sorted(versions, key=parse)
        rows = {}
        for header in sorted({h for v in versions.values() for h in v}):
            runs, last = [], None
            for version in order:
                now = versions[version].get(header)
                if now != last:
                    last = now
                    text = "-" if now is None else " ".join(str(places.setdefault(p, len(places))) for p in now)
                    runs.append(f"{version} {text}".rstrip())
            rows[header] = ";".join(runs)
        owners[owner] = rows
    read = {owner: tuple(sorted(states[owner], key=parse)) for owner in sorted(sparse)}
    return includes.IncludesTable(tuple(places), owners, frozenset(libraries), read)


def _main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("clones", nargs="*", help="OWNER+NAME")
    parser.add_argument("--shipped", action="store_true")
    parser.add_argument("--onto", action="store_true", help="add to the shipped table")
    parser.add_argument("--installed", action="append", default=[], metavar="LIBRARY=VERSION=DIR")
    parser.add_argument("--output", type=Path, default=DATA)
    asked = parser.parse_args()
    if asked.shipped:
        _write(drop_stored(load_shipped(), includes.load_includes().table), asked.output)
        return
    if asked.folder is None:
        parser.error("a folder of clones is needed, or --shipped")
    reported = [item.split("=") for item in asked.installed]
    states: dict[str, dict[str, dict[str, tuple[str, ...]]]] = defaultdict(dict)
    defining: dict[str, set[str]] = defaultdict(set)
    announcing: dict[str, set[str]] = defaultdict(set)

    def note(state: State) -> None:
        for path, header in state.items():
            for name in header.defined:
                defining[name].add(path)
            for name in header.announced:
                announcing[name].add(path)

    large: list[tuple[str, str, State]] = []
    generators = () if asked.onto else read_generators(asked.folder)
    for owner, version, state in (*read_clones(asked.folder, asked.clones), *generators):
        if owner == "boost":
            large.append((owner, version, state))
        elif version not in states[owner] and state:
            states[owner][version] = list_direct(state, lambda h: not _INNER.search(h))
            note(state)
    used = {p for versions in states.values() for v in versions.values() for found in v.values() for p in found}
    if asked.onto:
        used.update(includes.load_includes().table.paths)
    anew = {*states, *(owner for owner, _, _ in large)}
    large += [(library, version, read_folder(Path(where))) for library, version, where in reported]
    libraries, sparse = (set(_LIBRARIES.values()) | {"boost"}) & anew | {one[0] for one in reported}, set()
    for owner, version, state in large:
        sparse.add(owner)
        states[owner][version] = list_direct(
            state,
            lambda h: (
                (h.count("/") == 1 and not h.startswith("lib"))
                or h in used
                or AV_HEADERS.fullmatch(h) is not None
                or (_MEANT.match(h) is not None and not _INNER.search(h))
            ),
        )
        note({p: h for p, h in state.items() if not p.startswith("boost/")})
    if asked.onto:
        known = includes.load_includes().table
        rest = {o: h for o, h in known.owners.items() if not (o in known.libraries and o in anew)}
        _write(extend_table(msgspec.structs.replace(known, owners=rest), states, libraries, sparse), asked.output)
        return
    table = build_table({o: v for o, v in states.items() if any(v.values())}, libraries, sparse)
    table = msgspec.structs.replace(
        table,
        versions={distro: _list_versions(distro, table) for distro in DISTROS},
        names={n: tuple(sorted(p)) for n, p in defining.items() if len(p) < _MANY and not _PRIVATE.search(n)},
    )
    stopped = frozenset().union(*(_find_stopped_types(table, ros) for ros in (1, 2)))
    names = {n: p for n, p in table.names.items() if n in stopped}
    announced = {n: tuple(sorted(p)) for n, p in announcing.items() if n in names}
    _write(drop_stored(load_shipped(), msgspec.structs.replace(table, names=names, announced=announced)), asked.output)


def drop_stored(surfaces: Surfaces, table: includes.IncludesTable) -> includes.IncludesTable:
    """The table without what stored surfaces tell: what their packages' headers include, from the first stored version
    of each on. Names get the headers that define or announce them there, and those of much used packages are added."""
    numbers: dict[str, int] = {}
    owners: dict[str, dict[str, str]] = {}
    names = {name: dict.fromkeys(headers) for name, headers in {**_find_used_names(surfaces), **table.names}.items()}
    announced = {name: dict.fromkeys(headers) for name, headers in table.announced.items()}
    for owner, headers in table.owners.items():
        each = [] if owner in table.libraries else [surfaces.find_included(owner, n) for n in surfaces.list_ros(owner)]
        kept = _select_unstored([one for one in each if one is not None], headers) if each else headers
        if kept:
            owners[owner] = {header: _renumber_states(states, table.paths, numbers) for header, states in kept.items()}
    for package in sorted(surfaces.packages):
        for ros in surfaces.list_ros(package):
            history = surfaces.find_history(package, ros)
            if history is None:
                continue
            for name, where in history.index_types().items():
                if name in names:
                    names[name].update(dict.fromkeys(where))
            for name, where in _find_announcing_headers(history.included).items():
                if name in names:
                    announced.setdefault(name, {}).update(dict.fromkeys(where))
    versions = {
        distro: {owner: version for owner, version in known.items() if owner == "gcc" or owner in owners}
        for distro, known in table.versions.items()
    }
    return msgspec.structs.replace(
        table,
        paths=tuple(numbers),
        owners=owners,
        names={name: tuple(headers) for name, headers in names.items()},
        announced={name: tuple(headers) for name, headers in announced.items()},
        versions=versions,
    )


_USED = 5
"""How many released packages have to declare a package in a distro, for its names to be much used."""
# Macros that guard a header, or that a build defines.
_SETTING = re.compile(r"_(?:H|HPP|HH)_?$|_(?:PUBLIC|LOCAL|EXPORT|IMPORT|TYPE)$|_VERSION")


def _find_used_names(surfaces: Surfaces) -> dict[str, tuple[str, ...]]:
    """Types in a namespace that a folder or file with them is called after, and macros that begin as their package is
    called, of much used packages and of no other one, with the headers that define them."""
    used = frozenset().union(*(_list_used_packages(distro) for distro in DISTROS))
    owners: dict[str, set[str]] = defaultdict(set)
    found: dict[str, dict[str, None]] = defaultdict(dict)
    own: set[str] = set()
    for package in surfaces.packages:
        for ros in surfaces.list_ros(package):
            history = surfaces.find_history(package, ros)
            for name, where in history.index_types({*TYPES, "macro"}).items() if history is not None else ():
                head = name.partition("::")[0]
                if head != name or (name.startswith(f"{package.upper()}_") and not _SETTING.search(name)):
                    owners[name].add(package)
                    found[name].update(dict.fromkeys(where))
                    called = head == name or any(includes.is_called_after(path, head) for path in where)
                    own.update([name] if called else ())
    return {
        name: tuple(sorted(where))
        for name, where in sorted(found.items())
        if name in own and len(where) < _MANY and "<" not in name and not _PRIVATE.search(name)
        if len(owners[name]) == 1 and not owners[name].isdisjoint(used)
    }


def _list_used_packages(distro: str) -> list[str]:
    target = DistroTarget(distro)
    declared = Counter(
        name
        for package in target.list_released()
        for name in {dependency.name for dependency in target.list_dependencies(package) or ()}
    )
    return [name for name, count in declared.items() if count >= _USED]


def _select_unstored(each: Sequence[Included], headers: dict[str, str]) -> dict[str, str]:
    """The states of headers that no stored version stands for: of those that surfaces never have, all. each: of the
    ROS generations that have the package."""
    firsts = [next(included.read(), None) for included in each]
    known = [parse(first) for first in firsts if first is not None]
    found = {}
    for header, states in headers.items():
        runs = states.split(";")
        if known and any(header in included.headers for included in each):
            runs = [run for run in runs if parse(run.partition(" ")[0]) < max(known)]
        if runs:
            found[header] = ";".join(runs)
    return found


def _renumber_states(states: str, paths: tuple[str, ...], numbers: dict[str, int]) -> str:
    """States of a header with other numbers for its paths."""
    runs = []
    for run in states.split(";"):
        version, *reported = run.split(" ")
        again = (n if n == "-" else str(numbers.setdefault(paths[int(n)], len(numbers))) for n in reported)
        runs.append(" ".join((version, *again)))
    return ";".join(runs)


_States = dict[str, dict[str, dict[str, tuple[str, ...]]]]
"""Owner to version to header to what it includes."""


def extend_table(
    known: includes.IncludesTable, states: _States, libraries: Iterable[str], sparse: Iterable[str]
) -> includes.IncludesTable:
    """A table with more versions and owners. Which types stopped coming along stays as it was."""
    merged: _States = {}
    for owner, headers in known.owners.items():
        versions = merged[owner] = {v: {} for text in headers.values() for v, _ in _parse_states(text)}
        versions.update((v, {}) for v in known.sparse.get(owner, ()))
        for header, text in headers.items():
            runs = _parse_states(text)
            for version, found in versions.items():
                now = [places for first, places in runs if parse(first) <= parse(version)]
                if now and now[-1] != "-":
                    found[header] = tuple(known.paths[int(place)] for place in now[-1].split())
    for owner, versions in states.items():
        merged.setdefault(owner, {}).update(versions)
    table = build_table(merged, known.libraries.union(libraries), {*known.sparse, *sparse} & merged.keys())
    versions = {d: {**_list_versions(d, table), **known.versions.get(d, {})} for d in DISTROS}
    return msgspec.structs.replace(table, names=known.names, announced=known.announced, versions=versions)


def _parse_states(text: str) -> list[tuple[str, str]]:
    """The states of a header, oldest first: first version, and the places of what it includes."""
    return [(version, places) for version, _, places in (run.partition(" ") for run in text.split(";"))]


def _list_versions(distro: str, table: includes.IncludesTable) -> dict[str, str]:
    """The version of each owner in a distro, as the shipped snapshot has it at its end."""
    target = DistroTarget(distro)
    found = {"gcc": target.find_library("gcc") or ""}
    for owner in table.owners:
        found[owner] = (
            (target.find_library(owner) if owner in table.libraries else None) or target.find_version(owner) or ""
        )
    return {owner: version for owner, version in found.items() if version}


def _find_stopped_types(table: includes.IncludesTable, ros: int) -> set[str]:
    """Types of which some header brings the definition in one distro and not in the next."""
    distros = [d for d in DISTROS if d != "rolling" and DistroTarget(d).ros == ros]
    found: set[str] = set()
    names = table.names
    by_header: dict[str, set[str]] = defaultdict(set)
    shipped = includes.Includes(table)
    for name, headers in names.items():
        for header in headers:
            by_header[header].add(name)
    for before, after in pairwise(includes.load_machine(d, ros, shipped) for d in distros):
        for header in shipped.owners_of:
            if before.includes(header) is None or after.includes(header) is None:
                continue
            had, has = before.find_brought(header).headers, after.find_brought(header).headers
            for name in {n for lost in had - has for n in by_header.get(lost, ())} - found:
                if has.isdisjoint(names[name]) and any(after.includes(h) is not None for h in names[name]):
                    found.add(name)
    return found


def _write(table: includes.IncludesTable, output: Path) -> None:
    write_table(output / "includes.json.zst", table, order="sorted")


def _find_announcing_headers(included: Included) -> dict[str, tuple[str, ...]]:
    """Types with the headers that announce them in any version."""
    found: dict[str, dict[str, None]] = {}
    for header, rows in included.headers.items():
        for number in {number for row in rows for number in row.announced}:
            found.setdefault(included.types[number], {})[header] = None
    return {name: tuple(sorted(headers)) for name, headers in found.items()}


if __name__ == "__main__":
    _main()
