"""Downloads and reads the system libraries that rosdep keys name, by Debian release, for debian.py.

APT_CONF is an apt configuration of one suite with folders of its own, in which `apt-get update` was run. WORK keeps the
state: the development packages that keys of released packages name, and those of the same source, are downloaded
library by library, read, and deleted; a run that was stopped goes on where it was. What cannot be read is counted.

A library is what one source package makes, without the version in its name (`boost1.74` is `boost`). Of each version:
headers with what they include and declare, CMake configurations with their targets and variables, pkg-config files,
and the libraries to link. Only names, signatures and versions are kept.
"""

from __future__ import annotations

import hashlib
import os
import posixpath
import re
import sqlite3
import subprocess
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import msgspec
import zstandard

from ..edges.files import write_file
from ..impact.facts.surface import HeaderSurface
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.surface.surface import ExportedTarget
from .extract import cpp
from .providers import include_paths, is_of_compiler, is_ros_source, list_cmake, read_dependencies, read_keys, unpack
from .surface.headers import keep_compiled_includes
from .surface.unpacked_deb import DebError, read_members_and_links

# What nobody outside of a library is meant to include or to call; and libraries of Boost that are made for others.
_PARTS = (
    r"_?details?|internals?|_?impl|_?private|priv|aux_?|preprocessed|hal|cuda|gpu|3rdparty|third_party|src|arch|compiler"
    r"|mpl|fusion|spirit2?|phoenix|proto|typeof|hana|yap|metaparse|vmd|preprocessor|msm|wave|compute|qvm|type_traits"
    r"|contract|intrusive|move|mysql|redis|cobalt|beast|outcome|leaf|mp11|hof|describe|safe_numerics|gil|histogram|icl"
    r"|log/support|(?:test|asio)/traits|regex/v[45]|dll|stl_interfaces|unit_test|charconv|mqtt5|decimal|callable_traits"
    r"|machine|winapi|interfaces?\d+|v\d+|boost(?:/|::)(?:geometry|numeric|math|parameter|config|json|url|stacktrace|hash2)"
)
INNER = re.compile(
    rf"(?:^|[/_])(?:{_PARTS}|win32|wince|win32u|windows|macos|sunos|vx|cygwin|posix|aix)(?:[/_.]|$)", re.IGNORECASE
)
INNER_NAME = re.compile(rf"(?:^|::)(?:_\w+|\w+_detail|{_PARTS})(?:::|$)", re.IGNORECASE)
_LARGEST = 2_000_000
"""Bytes of a header above which it holds data rather than declarations."""
_WORD = re.compile(r"[A-Za-z_]\w*")
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)
# Compilers of other languages, and libraries that only compilers are made of.
_APART = re.compile(
    r"lib(?:32|x32|64)?(?:stdc\+\+|gcc|\w*san|objc|gfortran|quadmath|itm|gnat|gphobos|go|d)-?[\d.]*-[\d.]+-dev"
    r"|libstd-rust-dev|linux-headers-.*|libpython[\d.]+(?:-\w+)?-dev"
)
_LINK = re.compile(r"usr/lib/(?:x86_64-linux-gnu/)?lib([\w.+-]+?)\.(?:so|a)\Z")
_CMAKE = re.compile(r"usr/(?:lib|share)/.*\.cmake\Z")
_PC = re.compile(r"usr/(?:lib|share)/.*pkgconfig/([^/]+)\.pc\Z")
_TARGET = re.compile(
    r"""\badd_library\s*\(\s*"?([\w:.+-]+)"?\s+(SHARED|STATIC|MODULE|INTERFACE|UNKNOWN|OBJECT|ALIAS)\b""", re.IGNORECASE
)
_MADE = re.compile(r"\badd_library\s*\(\s*\"?[^\s\")]*\$", re.IGNORECASE)
_SET = re.compile(r"^[ \t]*set\s*\(\s*(\w+)[\s)]", re.MULTILINE | re.IGNORECASE)
_KINDS = {"SHARED": "library", "STATIC": "library", "MODULE": "module", "INTERFACE": "interface", "UNKNOWN": "imported"}
_DIRECTIVE = re.compile(r"^[ \t]*#[ \t]*(\w+)([^\n]*)", re.MULTILINE)
_ROOT = re.compile(r"-I\s*/?usr/include/(?:x86_64-linux-gnu(?:/|\b))?([\w.+/-]*)")


class Packaged(NamedTuple):
    """A development package of a suite. library: that it belongs to."""

    name: str
    version: str
    size: int
    library: str


class HeaderFile(msgspec.Struct, frozen=True, array_like=True):
    """A header as it lies in a package. path: as dependants include it. sha: of what it holds. links: stems of the
    libraries in the same package (`yaml-cpp`)."""

    path: str
    sha: str
    links: tuple[str, ...]


class LibraryFacts(msgspec.Struct, frozen=True):
    """What one suite has of a library. packages: those that were read. roots: folders below the system's include folder
    that its flags name. targets_open: some targets are named by what CMake works out."""

    library: str
    version: str
    packages: tuple[str, ...]
    headers: tuple[HeaderFile, ...]
    roots: tuple[str, ...]
    links: tuple[str, ...]
    cmake: tuple[str, ...]
    targets: tuple[ExportedTarget, ...]
    targets_open: bool
    variables: tuple[str, ...]
    pkgconfig: tuple[tuple[str, tuple[str, ...]], ...]
    unread: tuple[tuple[str, str], ...] = ()


class HeaderText(msgspec.Struct, frozen=True, array_like=True):
    """What a header holds, by its hash. words: outside of comments. refuses: the message of `#error`, where it holds
    nothing else."""

    surface: HeaderSurface
    words: tuple[str, ...]
    refuses: str = ""


def extract_upstream_version(version: str) -> str:
    """The version of the library itself: `7:5.1.9-0+deb12u1` is 5.1.9, `2.1.0+really2.1.0+dfsg-1` is 2.1.0."""
    version = re.split(r"\+really|\.really\.", version.rpartition(":")[2])[-1]
    found = re.match(r"\d+(?:\.\d+)*", version)
    return found.group() if found else version


def list_packages(lists: Path, named: Iterable[str], besides: Sequence[re.Pattern[str]] = ()) -> list[Packaged]:
    """The development packages of a suite that these names bring: those among them, and what they depend on of the same
    source. lists: the folder of apt's lists. besides: patterns of further names."""
    fields = read_fields(lists)
    depends = read_dependencies(lists)
    source = {name: reported.get("Source", name).partition(" ")[0] for name, reported in fields.items()}
    sources = frozenset(source.values())
    library = {name: derive_library_name(one, sources) for name, one in source.items()}
    found: dict[str, Packaged] = {}
    for start in {*named, *(name for name in fields if any(one.match(name) for one in besides))}:
        ring, seen = [start] if start in fields else [], {start}
        while ring:
            one = ring.pop()
            reported = fields[one]
            if _is_development(one, reported):
                found[one] = Packaged(one, reported["Version"], int(reported["Size"]), library[one])
            following = [n for n in depends.get(one, ()) if library.get(n) == library[one] and n not in seen]
            seen.update(following)
            ring += following
    return sorted(found.values())


def read_fields(lists: Path) -> dict[str, dict[str, str]]:
    """Size, version, source and section of each package of a suite. lists: the folder of apt's lists."""
    fields: dict[str, dict[str, str]] = {}
    name = ""
    for index in sorted(lists.glob("*_Packages*")):
        for line in unpack(index):
            key, _, value = line.decode("utf-8", "replace").partition(": ")
            if key == "Package":
                name = value.strip()
                fields[name] = {}
            elif key in ("Size", "Version", "Source", "Section"):
                fields[name][key] = value.strip()
    return fields


def derive_library_name(source: str, sources: Collection[str]) -> str:
    """A source package without versions: `boost1.74` and `boost-defaults` are `boost`, `tinyxml2` is itself, and so is
    `libusb-1.0` where `libusb` is another one of these sources."""
    plain = re.sub(r"-?\d+\.[\d.]+\Z", "", source.removesuffix("-defaults"))
    return source if plain != source and plain in sources else plain or source


def _is_development(name: str, reported: Mapping[str, str]) -> bool:
    """Whether a package is for those who compile with a library."""
    if not (name.endswith("-dev") or reported.get("Section", "").endswith("libdevel")):
        return False
    source = reported.get("Source", name).partition(" ")[0]
    return not (is_ros_source(source) or is_of_compiler(name) or _APART.fullmatch(name))


def count_uses() -> Counter[str]:
    """The Debian packages that rosdep keys of released packages install, or ever did, and how often manifests name
    them."""
    keys = read_keys(load_snapshot())
    found: Counter[str] = Counter()
    for key, count in keys.uses.items():
        found.update(dict.fromkeys(keys.debian.get(key, ()), count))
    return found


class Texts:
    """What headers hold, by their hash, so that what two releases share is read once."""

    def __init__(self, file: Path):
        self._db = sqlite3.connect(file)
        self._db.execute("CREATE TABLE IF NOT EXISTS text(sha TEXT PRIMARY KEY, data BLOB) WITHOUT ROWID")
        self._db.execute("PRAGMA synchronous=OFF")
        self._pack = zstandard.ZstdCompressor(level=3)

    def add(self, data: bytes) -> str:
        """Keeps a header, and gives its hash. Raises RecursionError and ValueError where it cannot be read."""
        sha = hashlib.sha1(data).hexdigest()
        if self._db.execute("SELECT 1 FROM text WHERE sha = ?", (sha,)).fetchone() is None:
            plain = _COMMENT.sub(" ", data.decode("utf-8", "replace"))
            surface = keep_compiled_includes(cpp.extract(data))
            text = HeaderText(surface, tuple(sorted(set(_WORD.findall(plain)))), find_refusal(plain))
            self._db.execute("INSERT INTO text VALUES(?, ?)", (sha, self._pack.compress(_encode(text))))
        return sha

    def get(self, sha: str) -> HeaderText:
        """What was kept by a hash."""
        (data,) = self._db.execute("SELECT data FROM text WHERE sha = ?", (sha,)).fetchone()
        return _decode_text(zstandard.ZstdDecompressor().decompress(data))

    def commit(self) -> None:
        """Makes it last."""
        self._db.commit()

    def close(self) -> None:
        """Ends it."""
        self._db.close()


_encode = msgspec.msgpack.Encoder().encode
_decode_text = msgspec.msgpack.Decoder(HeaderText).decode
_decode_facts = msgspec.msgpack.Decoder(LibraryFacts).decode


def find_refusal(plain: str) -> str:
    """The message of a header, given without comments, that holds nothing but `#error`; empty for others."""
    message = ""
    depth = 0
    guard = ""
    for reported in _DIRECTIVE.finditer(plain):
        what, rest = reported[1], reported[2].strip()
        if what == "ifndef" and not guard and not depth:
            guard = rest
        elif what == "define" and rest == guard:
            continue
        elif what == "error" and not depth:
            message = rest.strip('"') or "#error"
        elif what in ("if", "ifdef", "ifndef"):
            depth += 1
        elif what == "endif":
            depth = max(0, depth - 1)
        elif what != "pragma":
            return ""
    return message if not _DIRECTIVE.sub("", plain).strip() else ""


def read_packages(library: str, files: Sequence[tuple[Packaged, Path]], texts: Texts) -> LibraryFacts:
    """A library in one suite. files: its packages with where they were downloaded."""
    unread: list[tuple[str, str]] = []
    read: list[tuple[Packaged, dict[str, bytes], tuple[str, ...]]] = []
    for package, file in files:
        try:
            held, links = read_members_and_links(file)
        except (DebError, OSError) as error:
            unread.append((package.name, str(error)))
            continue
        stems = {reported[1] for path in (*held, *links) if (reported := _LINK.match(path))}
        read.append((package, {path: member.data for path, member in held.items()}, tuple(sorted(stems))))
    flags = [parse_pkgconfig(path, data) for _, held, _ in read for path, data in held.items() if _PC.match(path)]
    roots = {root.strip("/") for _, _, folders in flags for root in folders}
    headers: dict[str, HeaderFile] = {}
    counts: Counter[str] = Counter()
    for package, held, stems in read:
        for path, data in sorted(held.items()):
            paths = include_paths(path)
            if not paths:
                continue
            include = find_include_path(paths, roots)
            if include in headers:
                continue
            counts[package.version] += 1
            if len(data) > _LARGEST:
                unread.append((path, "too large"))
                data = b""
            try:
                sha = texts.add(data)
            except (RecursionError, ValueError) as error:
                unread.append((path, str(error) or type(error).__name__))
                sha = texts.add(b"")
            headers[include] = HeaderFile(include, sha, stems)
            roots.update({paths[0].removesuffix(f"/{include}")} if paths[0] != include else ())
    cmake = [(path, data) for _, held, _ in read for path, data in held.items() if _CMAKE.match(path)]
    names, targets, is_open, variables = read_cmake(cmake)
    versions = counts or Counter(package.version for package, _, _ in read)
    return LibraryFacts(
        library,
        versions.most_common(1)[0][0] if versions else "",
        tuple(package.name for package, _, _ in read),
        tuple(headers[path] for path in sorted(headers)),
        tuple(sorted(roots - {""})),
        tuple(sorted({stem for _, _, stems in read for stem in stems})),
        names,
        targets,
        is_open,
        variables,
        tuple(sorted({name: stems for name, stems, _ in flags}.items())),
        tuple(unread),
    )


def find_include_path(paths: Sequence[str], roots: Iterable[str]) -> str:
    """How dependants include a header, of the ways in which they may: below the deepest folder that flags name."""
    inside = [paths[0][len(root) + 1 :] for root in roots if root and paths[0].startswith(f"{root}/")]
    return min((*paths, *inside), key=len)


_EXPAND = re.compile(r"\$\{(\w+)\}")


def parse_pkgconfig(path: str, data: bytes) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    """A pkg-config file: its name, the libraries that it links, and the folders below the system's include folder."""
    reported = _PC.match(path)
    assert reported is not None
    values: dict[str, str] = {"pcfiledir": f"/{posixpath.dirname(path)}"}
    fields: dict[str, str] = {}
    for line in data.decode("utf-8", "replace").replace("\\\n", " ").splitlines():
        line = line.partition("#")[0]
        match = re.match(r"\s*([\w.]+)\s*([=:])\s*(.*)", line)
        if match is not None:
            text = match[3]
            for _ in range(5):
                text = _EXPAND.sub(lambda m: values.get(m[1], ""), text)
            (values if match[2] == "=" else fields)[match[1]] = text.strip()
    stems = tuple(dict.fromkeys(re.findall(r"(?<!\S)-l([\w.+-]+)", fields.get("Libs", ""))))
    folders = tuple(dict.fromkeys(_ROOT.findall(normalize_flags(fields.get("Cflags", "")))))
    return reported[1], stems, folders


def normalize_flags(flags: str) -> str:
    """Flags with their folders made plain: no `..`, one slash."""
    return " ".join(
        f"-I{posixpath.normpath(flag[2:].strip() or '/')}" if flag.startswith("-I") else flag for flag in flags.split()
    )


def read_cmake(
    files: Iterable[tuple[str, bytes]],
) -> tuple[tuple[str, ...], tuple[ExportedTarget, ...], bool, tuple[str, ...]]:
    """CMake files of a library: names of configurations, targets, whether others may be there, and variables that begin
    as a configuration is called."""
    names: set[str] = set()
    targets: dict[str, ExportedTarget] = {}
    variables: set[str] = set()
    is_open = False
    each = [(path, data.decode("utf-8", "replace")) for path, data in files]
    for path, _ in each:
        names.update(list_cmake(path)[:1])
    starts = {re.sub(r"\W", "", name).lower() for name in names}
    for _, text in each:
        plain = re.sub(r"#[^\n]*", "", text)
        is_open = is_open or _MADE.search(plain) is not None
        for name, kind in _TARGET.findall(plain):
            targets.setdefault(name, ExportedTarget(name, _KINDS.get(kind.upper(), "imported")))
        for name in _SET.findall(plain):
            head, _, last = name.rpartition("_")
            if last and head and re.sub(r"\W|_", "", head).lower() in {s.replace("_", "") for s in starts}:
                variables.add(name)
    ordered = tuple(targets[name] for name in sorted(targets))
    return tuple(sorted(names)), ordered, is_open, tuple(sorted(variables))


class Run:
    """Downloads and reads into a folder; what is there already is not done again."""

    def __init__(self, work: Path, say: Callable[[str], None] = print):
        self.work, self._say = work, say
        (work / "read").mkdir(parents=True, exist_ok=True)
        self.texts = Texts(work / "texts.sqlite")

    def read_suite(self, suite: str, configuration: Path, besides: Sequence[re.Pattern[str]] = ()) -> None:
        """Reads all libraries of a suite. besides: packages that count though no key names them."""
        lists = find_lists(configuration)
        by_library: dict[str, list[Packaged]] = defaultdict(list)
        for package in list_packages(lists, count_uses(), besides):
            by_library[package.library].append(package)
        for stale in (self.work / "read" / suite).glob("*.msgpack"):
            if stale.stem not in by_library:
                stale.unlink()
        for place, (library, packages) in enumerate(sorted(by_library.items()), 1):
            done = self.work / "read" / suite / f"{library}.msgpack"
            if done.exists():
                continue
            files = self._download(suite, configuration, packages)
            missing = len(packages) - len(files)
            facts = read_packages(library, files, self.texts)
            self.keep(suite, facts)
            for _, file in files:
                file.unlink()
            size = sum(package.size for package in packages) / 1e6
            self._say(
                f"{suite} {place}/{len(by_library)} {library} {facts.version}: {len(packages)} packages, "
                f"{size:.1f} MB, {len(facts.headers)} headers, {len(facts.unread) + missing} not read"
            )

    def _download(
        self, suite: str, configuration: Path, packages: Sequence[Packaged]
    ) -> list[tuple[Packaged, Path]]:
        folder = self.work / "debs" / suite
        folder.mkdir(parents=True, exist_ok=True)
        missing = [package for package in packages if _find_downloaded(folder, package) is None]
        if missing:
            subprocess.run(
                ["apt-get", "-qq", "download", *(f"{package.name}={package.version}" for package in missing)],
                cwd=folder,
                env={**os.environ, "APT_CONFIG": str(configuration)},
                check=False,
                capture_output=True,
            )
        return [(package, file) for package in packages if (file := _find_downloaded(folder, package)) is not None]

    def list_suites(self) -> list[str]:
        """The suites of which something was read."""
        return [folder.name for folder in (self.work / "read").iterdir()]

    def keep(self, suite: str, facts: LibraryFacts) -> None:
        """Keeps what was read of a library."""
        self.texts.commit()
        folder = self.work / "read" / suite
        folder.mkdir(parents=True, exist_ok=True)
        write_file(folder / f"{facts.library}.msgpack", _encode(facts))

    def read_facts(self, suite: str) -> Iterator[LibraryFacts]:
        """The libraries of a suite that were read."""
        for file in sorted((self.work / "read" / suite).glob("*.msgpack")):
            yield _decode_facts(file.read_bytes())


def _find_downloaded(folder: Path, package: Packaged) -> Path | None:
    return next(iter(folder.glob(f"{package.name}_{package.version.replace(':', '%3a')}_*.deb")), None)


def find_lists(configuration: Path) -> Path:
    """The folder of lists of an apt configuration."""
    return Path(_ask_apt(configuration, "Dir::State::lists/d"))


def _ask_apt(configuration: Path, name: str) -> str:
    reported = subprocess.run(
        ["apt-config", "shell", "VALUE", name],
        env={**os.environ, "APT_CONFIG": str(configuration)},
        check=True,
        capture_output=True,
        text=True,
    )
    return reported.stdout.partition("=")[2].strip().strip("'")
