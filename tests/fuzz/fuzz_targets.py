"""What is fuzzed: for each reader of rosimpact a function of bytes that raises when the reader breaks its word.

A check passes when the reader gives an answer or raises what its documentation says. Whatever else comes out of a check
is a fault: an undocumented exception, or a Violated for a property that does not hold.
"""

from __future__ import annotations

import contextlib
import fnmatch
import io
import json
import posixpath
import re
import struct
import tarfile
import tempfile
from collections.abc import Callable, Iterable
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
from fuzz_words import WORDS
from rosimpact.corpus import robust
from rosimpact.corpus.polite import ServiceAnswer
from rosimpact.corpus.report import CorpusError, read_labels, read_reports
from rosimpact.corpus.sources import markup, ros_answers, stack_exchange
from rosimpact.databuild.extract import cpp, python
from rosimpact.databuild.extract import parameters as declared
from rosimpact.databuild.surface import unpacked_deb
from rosimpact.edges import console
from rosimpact.edges.documents import DocumentError, load_json, load_toml, load_yaml
from rosimpact.impact import config, tree
from rosimpact.impact.analysis import findings
from rosimpact.impact.analysis import result_cache as memo
from rosimpact.impact.analysis import revision_compare as base
from rosimpact.impact.conditions import Environment, holds
from rosimpact.impact.facts import allow, elf, kinds, nodl, store
from rosimpact.impact.facts.cmake import extract as extract_cmake
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.facts.launch import flow as flow_launch
from rosimpact.impact.facts.launch import parameter_files as flow_parameters
from rosimpact.impact.facts.usage import Rows
from rosimpact.impact.model import discovery
from rosimpact.impact.model.cmake import regex
from rosimpact.impact.model.cmake.interpret import interpret, list_extras
from rosimpact.impact.model.cmake.interpreter import MAX_STEPS
from rosimpact.impact.model.launch import follow as launch
from rosimpact.impact.model.launch import text as launch_text
from rosimpact.impact.model.tracked_names import load_watched
from rosimpact.impact.report import github, markdown_text
from rosimpact.impact.targets import capture, resolve, version
from rosimpact.impact.targets.distro.distro import TargetError
from rosimpact.impact.tree import TreeEntry, ignore, working

for _module, _ in kinds.EXTRACTORS.values():
    if _module:  # they are imported when they are first needed, which no check should pay for
        import_module(f"rosimpact.impact.facts.{_module}")

SEEDS = Path(__file__).with_name("seeds")


class Violated(AssertionError):
    """A property does not hold; the text says which."""


class Target(NamedTuple):
    """check: raises for a fault. language: of the words that mutations insert, one of WORDS. seeds: what mutations
    begin with, by name. promise: what must hold, in a clause."""

    check: Callable[[bytes], None]
    language: str
    seeds: Callable[[], dict[str, bytes]]
    promise: str


def require(holds: bool, what: str) -> None:
    if not holds:
        raise Violated(what)


def seeds_of(*folders: str) -> Callable[[], dict[str, bytes]]:
    """The files of these folders of seeds; `folder/name` for one file alone."""

    def read() -> dict[str, bytes]:
        paths = [
            path for folder in folders for path in sorted(SEEDS.glob(f"{folder}/*" if "/" not in folder else folder))
        ]
        return {f"{path.parent.name}-{path.name}": path.read_bytes() for path in paths}

    return read


@cache
def _folder() -> Path:
    """A folder for readers that want a path, in memory where that can be had."""
    memory = Path("/dev/shm")
    kept = tempfile.TemporaryDirectory(prefix="rosimpact-fuzz-", dir=memory if memory.is_dir() else None)
    _KEPT.append(kept)
    return Path(kept.name)


_KEPT: list[Any] = []


def written(name: str, data: bytes) -> Path:
    path = _folder() / name
    path.write_bytes(data)
    return path


# Extractors

_FAILED = re.compile(r"cannot be read: (?!RecursionError)\w+: ")
# A file is no Python, or no YAML.
_DOCUMENTED = re.compile(
    r"cannot be read: (?:SyntaxError|IndentationError|TabError|UnicodeDecodeError|DocumentError): "
)


def _is_documented(kind: str, message: str) -> bool:
    """Whether an extractor leaves it to kinds.extract() to say so."""
    return kind.startswith(declared.__name__) and _DOCUMENTED.match(message) is not None


def extractor(kind: str) -> Callable[[bytes], None]:
    """Facts of a kind: extraction never raises and hides no exception; facts encode and decode to the same."""

    def check(data: bytes) -> None:
        if kind in kinds.SEARCHES:
            first = {"searched_text": "python"}.get(kind, "cpp")
            facts = kinds.extract(first, data).facts
            table = _tables().get(kind) or Rows((*facts.words.split(" ")[:20], "operator+="))
            if kind == "used_cpp":
                mentions = kinds.search("mentioned_cpp", data, facts, table).facts.mentions
                table = Rows([(one.word, one.offset) for one in mentions])
            found = kinds.search(kind, data, facts, table)
        else:
            found = kinds.extract(kind, data)
        for problem in getattr(found.facts, "problems", ()):
            if _FAILED.match(problem.message) and not _is_documented(kind, problem.message):
                _raise_again(found.kind, data)
                raise Violated(problem.message)
        encoded = kinds.encode(found)
        require(kinds.decode(kind, encoded) == found, "facts decode to others")

    return check


@cache
def _tables() -> dict[str, object]:
    """What searches are given to look for."""
    names = load_watched()
    rows = Rows([row for group in (*names.modules.values(), names.parameters) for row in group])
    return {"searched_cpp": names.in_cpp, "searched_text": rows}


def _raise_again(kind: str, data: bytes) -> None:
    """Runs an extractor without what catches its exceptions."""
    if kind in kinds.SEARCHES:
        return  # its problem alone says what failed
    if kind in kinds.EXTRACTORS:
        module = kinds.EXTRACTORS[kind][0]
        path, variant = f"rosimpact.impact.facts.{module}", kind if module in kinds.WITH_KIND else ""
    else:
        path, _, variant = kind.partition(":")
    read = import_module(path).extract
    _ = read(data, variant) if variant else read(data)
    if kind == "setup_py":
        _raise_again("python", data)


class _Sources:
    """Launch and parameter files, all of them the same one."""

    def __init__(self, data: bytes, kind: str):
        self.file, self.values = flow_launch.extract(data, kind), flow_parameters.extract(data)

    def find_launch_file(self, package: str, path: str) -> Any:
        return self.file

    def find_parameter_file(self, package: str, path: str) -> Any:
        return self.values


def launched(kind: str) -> Callable[[bytes], None]:
    """A launch file that includes itself at most is read, and followed to all that it starts."""

    def check(data: bytes) -> None:
        found = launch.follow("p", "launch/a", _Sources(data, kind), {"use": "true"})
        for place, _ in enumerate(found.started):
            if place < 5:
                found.collect_parameters(found.started[place], "")

    return check


def parameters(data: bytes) -> None:
    flow_parameters.extract(data)
    nodl.extract(data)


# CMake

_OTHER = b"set(OTHER x)\nif(Y)\n  set(Z a b)\nendif()\n"


def cmake_build(data: bytes) -> None:
    """A package's CMakeLists.txt is interpreted beside a file that it may include."""
    files = {
        "pkg/CMakeLists.txt": data,
        "pkg/other.cmake": _OTHER,
        "pkg/sub/CMakeLists.txt": _OTHER,
        "pkg/src/a.cpp": b"",
    }

    def glob(pattern: str, recursive: bool) -> list[str]:
        folder, _, last = pattern.rpartition("/")
        return [
            path
            for path in files
            if fnmatch.fnmatchcase(posixpath.basename(path), last)
            and (posixpath.dirname(path) == folder or (recursive and path.startswith(folder + "/")))
        ]

    def read(path: str) -> Any:
        return extract_cmake(files[path]) if path in files else None

    built = interpret("pkg", read, files.__contains__, glob, package="pkg")
    msgspec.msgpack.encode(built)
    list_extras("pkg", glob)


class _Spent(Exception):
    """A match costs more than a package may."""


def cmake_regex(data: bytes) -> None:
    """First line: a regular expression of CMake; the rest: a text."""
    pattern, _, text = data.decode("utf-8", "surrogateescape").partition("\n")
    left = MAX_STEPS

    def spend(steps: int) -> None:
        nonlocal left
        left -= steps
        if left < 0:
            raise _Spent

    try:
        found = regex.match(pattern, text, spend)
    except _Spent:
        return
    require(found is None or found is False or all(isinstance(group, str) for group in found), "groups are no texts")


_HUMBLE = Environment(
    ros_distro="humble",
    ros_version="2",
    python=(3, 10),
    codename="jammy",
    versions={"rclcpp": "16.0.11", "opencv": "4.5.4+dfsg", "gcc": "11.2", "cmake": "3.22.1"}.get,
    headers={"a/b.h": False, "vector": True}.get,
)


def conditions(data: bytes) -> None:
    """First byte: the language; the rest: a condition, an expression of a launch file, or two versions."""
    text = data[1:].decode("utf-8", "replace")
    which = data[:1].decode("latin-1") or "0"
    place = ord(which) % 6
    if place < 4:
        language = ("cpp", "manifest", "python", "cmake")[place]
        value = holds(Condition(language, text), _HUMBLE)
        require(value in (True, False, None), "a condition holds neither way")
    elif place == 4:
        with contextlib.suppress(launch_text.CannotTell):
            launch_text.evaluate(text, {"x": "y"}, {"arg": lambda name: name})
        launch_text.parse_ros1_value(text)
        launch_text.parse_yaml_value(text)
    else:
        first, _, second = text.partition("\n")
        require(version.compare(first, second) == -version.compare(second, first), "an order of versions is one-sided")
        version.is_at_least(first, second)
        capture.strip_version(first)


# Documents and settings


def documents(load: Callable[[Any], Any]) -> Callable[[bytes], None]:
    def check(data: bytes) -> None:
        try:
            load(data.decode("utf-8", "replace") if load is load_toml else data)
        except DocumentError as error:
            require("\n" not in str(error), "an error of two lines")

    return check


def settings(data: bytes) -> None:
    """A rosimpact.toml."""
    try:
        config.parse(data, Path("ws/rosimpact.toml"))
    except config.ConfigError:
        return


def pinned(data: bytes) -> None:
    """A .repos or .rosinstall file."""
    try:
        base.read_pinned(written("a.repos", data))
    except base.BaseError:
        return


def baseline(data: bytes) -> None:
    try:
        findings.read_baseline(data)
    except findings.SettingsError:
        return


def captured(data: bytes) -> None:
    try:
        capture.dump_capture(capture.read(written("captured.json", data))).encode("utf-8", "surrogatepass")
    except TargetError:
        return


def listing(data: bytes) -> None:
    """A listing of `dpkg -l`."""
    capture.read_dpkg_rows(resolve.parse_dpkg(data.decode("utf-8", "replace")))


def allowed(data: bytes) -> None:
    lines = data.count(b"\n") + 1
    for found in allow.allows(data):
        require(1 <= found.line <= lines and bool(found.rules), "a comment where there is none")


class _Files:
    """A tree in memory, with as much of a Tree as finding packages asks for."""

    def __init__(self, files: dict[str, bytes]):
        self.files = files
        self.name, self.label = "ws", "ws"
        self.problems, self.skipped, self.aliases = [], [], {}
        self.repositories: dict[str, str] = {}

    def list_entries(self) -> list[TreeEntry]:
        return [TreeEntry(path, len(data)) for path, data in sorted(self.files.items())]

    def read(self, path: str, limit: int = 0) -> bytes:
        if path not in self.files:
            raise FileNotFoundError(2, "No such file or directory", path)
        return self.files[path]

    def exists(self, path: str) -> bool:
        return path in self.files or self.is_dir(path)

    def is_dir(self, path: str) -> bool:
        return any(each.startswith(path + "/") for each in self.files)


class _Facts:
    """The facts of such a tree."""

    def __init__(self, files: _Files):
        self.files = files
        self.problems: list[Any] = []
        self.kinds = {path: kind for path in files.files if (kind := kinds.find_kind(path)) is not None}

    def list_paths(self, *wanted: str) -> list[str]:
        return [path for path, kind in self.kinds.items() if kind in wanted]

    def preload(self, paths: Iterable[str]) -> None: ...

    def get_facts(self, path: str) -> Any:
        return kinds.extract(self.kinds[path], self.files.read(path))

    def look(self, paths: Iterable[str], kind: str, on_error: Any = None) -> dict[str, Any]:
        return {path: kinds.extract(kind, self.files.read(path)).facts for path in paths}


_PART = re.compile(rb"(?m)^== ([^\n]{1,80})\n")


def discovered(data: bytes) -> None:
    """Files, each behind a line `== path`, among which packages are found."""
    parts = _PART.split(data)
    files = _Files({})
    for name, content in zip(parts[1::2], parts[2::2], strict=True):
        path = tree.normalize_path(name.decode("utf-8", "replace"))
        if path:
            files.files[path] = content
    found = discovery.discover(files, _Facts(files))  # pyright: ignore[reportArgumentType]
    for place in (*found.packages, *found.foreign, *found.ignored):
        require(bool(place.name) and isinstance(place.name, str), "a package without a name")
    found.find_owner("src/arm/a.cpp")


# Binary files


def binary(data: bytes) -> None:
    """An ELF file."""
    found = elf.read(data)
    if found is not None:
        encoded = msgspec.msgpack.encode(found)
        require(
            msgspec.msgpack.encode(msgspec.msgpack.decode(encoded, type=elf.Elf)) == encoded, "facts decode to others"
        )
    for symbol in elf.read_defined_symbols(data) or ():
        elf.parse_symbol(symbol)
    elf.parse_symbol(data[:200].decode("utf-8", "replace"))


def deb(data: bytes) -> None:
    try:
        unpacked_deb.read_members(written("a.deb", data))
    except unpacked_deb.DebError:
        return


_KINDS = sorted((
    *kinds.EXTRACTORS, cpp.__name__, python.__name__, *map(declared.make_kind, declared.LIMITS),
))  # fmt: skip


def rows(data: bytes) -> None:
    """First byte: a kind; the rest: its facts as they would lie in the cache."""
    kind = _KINDS[(data[0] if data else 0) % len(_KINDS)]
    try:
        unpacked = store.unpack(data[1:])
    except ValueError:
        unpacked = data[1:]
    for each in (unpacked, data[1:]):
        try:
            found = kinds.decode(kind, each)
        except msgspec.DecodeError:
            continue
        kinds.encode(found)


class _Memo:
    """A store in which one row is remembered under every key."""

    def __init__(self, data: bytes):
        self.data = data

    def find_memo(self, table: str, key: bytes) -> bytes:
        return self.data

    def remember(self, table: str, rows: object) -> None: ...


def memories(data: bytes) -> None:
    """What a run remembers for the next one: findings, the tree's stamps, git's index."""
    memo.load_yielded(_Memo(data), b"key")  # pyright: ignore[reportArgumentType]
    for path, (stamp, content) in working._decode_memory(data).items():
        require(isinstance(path, str) and len(stamp) == 4 and len(content) == 40, "a memory of another shape")
    # Version 4 is read path by path, the others are searched first.
    for index in (data, data[:4] + b"\0\0\0\4" + data[8:]):
        ignore.Index(index).tracks_below("build")


# What is printed

_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ud800-\udfff]")
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_COMMAND_ANYWHERE = re.compile(r"##[A-Za-z]{0,20}\[")


def printed(data: bytes) -> None:
    """A text of a workspace, as it is shown to people."""
    text = data.decode("utf-8", "surrogateescape")
    one = console.escape(text)
    require(not _CONTROL.search(one) and "\n" not in one and "\t" not in one, "visible() leaves a control character")
    require(not _COMMAND_ANYWHERE.search(one), "visible() leaves a command")
    require(console.escape(one) == one, "visible() twice differs")
    lines = console.escape_lines(text)
    require(not _CONTROL.search(lines), "visible_lines() leaves a control character")
    require(lines.count("\n") == text.count("\n"), "visible_lines() changes the lines")
    stream = io.StringIO()
    console.write(text, stream)
    out = stream.getvalue()
    require(not _CONTROL.search(_COLOUR.sub("", out)), "write() lets a control character through")
    require(not any(line.lstrip().startswith("::") for line in out.split("\n")), "write() lets a command through")
    require(not _COMMAND_ANYWHERE.search(out), "write() lets a command through")
    told = console.format_json(text)
    require(json.loads(told) == text and not console.is_obeyed(told), "JSON of a text says something else")
    for parameter in (github._escape_data(text), github._escape_property(text)):
        require("\n" not in parameter and "\r" not in parameter, "a workflow command of two lines")


@cache
def _markdown() -> Any:
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark").enable(["table", "strikethrough"])


def marked(data: bytes) -> None:
    """A text of a workspace in a table and a paragraph of Markdown."""
    text = data.decode("utf-8", "replace")
    for shown in (markdown_text.escape_markdown(text), markdown_text.quote(text)):
        require("\n" not in shown and not _CONTROL.search(shown), "Markdown of two lines")
        for token in _markdown().parse(f"x {shown} y"):
            for child in token.children or ():
                require(child.type in ("text", "code_inline"), f"Markdown makes {child.type} of a text")
        table = _markdown().parse(f"| a | b |\n|---|---|\n| {markdown_text.format_cell(shown)} | end |\n")
        cells = [token.content for token in table if token.type == "inline"]
        require(len(cells) == 4 and cells[3] == "end", "a text breaks a table")


# The corpus


def reports(data: bytes) -> None:
    """JSON Lines of reports and labels, and what an API answers."""
    path = written("reports.jsonl", data)
    for read in (read_reports, read_labels):
        try:
            for row in read(path):
                msgspec.json.encode(row)
        except CorpusError:
            continue
    try:
        item = ServiceAnswer(200, "", {}, data).parse_json()
    except ValueError:
        return
    if isinstance(item, dict):
        for parse in (ros_answers.parse_item, stack_exchange.convert):
            try:
                parse(item)
            except CorpusError:
                continue


def archived(data: bytes) -> None:
    """A question as an archive or a page has it, or a record of ROBUST."""
    with contextlib.suppress(CorpusError):
        ros_answers.parse_archived(data, "a.md")
    with contextlib.suppress(ValueError):
        robust.map_record(robust._parse_record(written("a.bug", data)), "a")


def pages(data: bytes) -> None:
    html = data.decode("utf-8", "replace")
    markup.convert_to_markdown(html)
    try:
        ros_answers.parse_page(html)
    except CorpusError:
        return


# Seeds that are made


def _elf_seeds() -> dict[str, bytes]:
    def made(names: bytes, tags: list[tuple[int, int]]) -> bytes:
        start = 64 + 2 * 56
        size = 16 * (len(tags) + 3)
        rows = [*tags, (5, start + size), (10, len(names)), (0, 0)]
        dynamic = b"".join(struct.pack("<QQ", *row) for row in rows)
        symbols = bytes(24) + struct.pack("<IBBHQQ", 1, 0x12, 0, 0, 0, 0) + struct.pack("<IBBHQQ", 9, 0x12, 0, 1, 64, 8)
        at = start + size + len(names)
        sections = struct.pack("<IIQQQQIIQQ", 1, 11, 2, 0, at, len(symbols), 1, 1, 8, 24)
        sections += struct.pack("<IIQQQQIIQQ", 1, 3, 2, 0, start + size, len(names), 0, 0, 1, 0)
        sections += struct.pack("<IIQQQQIIQQ", 1, 0x6FFFFFFE, 2, 0, start, 32, 1, 1, 4, 0)
        sections += struct.pack("<IIQQQQIIQQ", 1, 0x6FFFFFFD, 2, 0, start, 32, 1, 1, 4, 0)
        sections += struct.pack("<IIQQQQIIQQ", 1, 7, 2, 0, start, 48, 0, 0, 4, 0)
        whole = at + len(symbols)
        ident = b"\x7fELF" + bytes([2, 1, 1]) + bytes(9)
        head = ident + struct.pack("<HHIQQQIHHHHHH", 3, 62, 1, 0, 64, whole, 0, 64, 56, 2, 64, 5, 1)
        load = struct.pack("<IIQQQQQQ", 1, 5, 0, 0, 0, whole, whole, 4096)
        segment = struct.pack("<IIQQQQQQ", 2, 6, start, start, start, size, size, 8)
        return head + load + segment + dynamic + names + symbols + sections

    names = b"\0libc.so\0_ZN1a1bEv\0$ORIGIN:/x\0"
    return {"library": made(names, [(1, 1), (14, 1), (29, 19)]), "bare": made(b"\0", [])}


def _deb_seeds() -> dict[str, bytes]:
    archive = io.BytesIO()
    with tarfile.open(fileobj=archive, mode="w") as tar:
        entry = tarfile.TarInfo("./usr/include/a.h")
        entry.size = 3
        tar.addfile(entry, io.BytesIO(b"int"))
        link = tarfile.TarInfo("./usr/include/b.h")
        link.type, link.linkname = tarfile.SYMTYPE, "a.h"
        tar.addfile(link)
    packed = archive.getvalue()

    def deb_of(name: str, data: bytes) -> bytes:
        members = (("debian-binary", b"2.0\n"), (name, data))
        parts = [b"!<arch>\n"]
        for each, content in members:
            parts.append(
                f"{each:<16}{0:<12}{0:<6}{0:<6}{644:<8}{len(content):<10}`\n".encode()
                + content
                + b"\n" * (len(content) % 2)
            )
        return b"".join(parts)

    import gzip
    import lzma

    import zstandard

    return {
        "plain": deb_of("data.tar", packed[:3072]),
        "xz": deb_of("data.tar.xz", lzma.compress(packed)),
        "gz": deb_of("data.tar.gz", gzip.compress(packed, mtime=0)),
        "zst": deb_of("data.tar.zst", zstandard.ZstdCompressor().compress(packed)),
    }


_SEED_FOLDERS = {
    "manifest": "manifest", "manifest_variant": "manifest", "cmake": "cmake", "msg": "interface", "srv": "interface",
    "action": "interface", "idl": "interface", "cpp": "cpp", "flow_cpp": "cpp", cpp.__name__: "cpp",
    declared.make_kind("cpp"): "cpp", "launch_xml": "launch_xml", "xacro": "launch_xml", "plugin_xml": "launch_xml",
    "xml": "launch_xml", "launch_yaml": "launch_yaml", "params": "launch_yaml",
    declared.make_kind("yaml"): "launch_yaml",
    "shell": "shell", "script": "shell", "flow_script": "shell", "setup_cfg": "cfg", "pyproject": "toml",
}  # fmt: skip


def language_of(kind: str) -> str:
    return _SEED_FOLDERS.get(kind, "python")


def _row_seeds() -> dict[str, bytes]:
    found = {}
    for place, kind in enumerate(_KINDS):
        for name, data in seeds_of(language_of(kind))().items():
            found[f"{kind}-{name}"] = bytes([place]) + store.pack(kinds.encode(kinds.extract(kind, data)))
    return found


def _memory_seeds() -> dict[str, bytes]:
    stamps = {"src/a.cpp": ((3, 4, 5, 6), "ab" * 20), "b": ((1, 2, 3, 4), "00" * 20)}
    row = (
        "removed-header",
        "a.cpp",
        3,
        1,
        "x",
        "message",
        "help",
        "arm",
        "error",
        (("Replace", ("a", 1, "b", "c")),),
        None,
    )
    return {
        "stamps": working._encode_memory(stamps),
        "hits": msgspec.msgpack.encode(((row,), {"packages": ("a",)})),
        "index": b"DIRC\0\0\0\2\0\0\0\1" + bytes(62) + b"build/a\0\0\0" + bytes(20),
    }


_EXTRACT = "extraction never raises and hides no exception; facts encode and decode to the same"
_FOLLOWED = "following a launch file never raises"
TARGETS: dict[str, Target] = {
    f"facts_{kind.removeprefix('rosimpact.databuild.')}": Target(
        extractor(kind), language_of(kind), seeds_of(language_of(kind)), _EXTRACT
    )
    for kind in _KINDS
}
TARGETS.update({
    "launch_xml": Target(launched("launch_xml"), "launch_xml", seeds_of("launch_xml"), _FOLLOWED),
    "launch_yaml": Target(launched("launch_yaml"), "launch_yaml", seeds_of("launch_yaml"), _FOLLOWED),
    "launch_python": Target(launched("launch_python"), "python", seeds_of("python"), _FOLLOWED),
    "parameters": Target(parameters, "launch_yaml", seeds_of("launch_yaml", "yaml"), "reading parameters never raises"),
    "cmake_build": Target(cmake_build, "cmake", seeds_of("cmake"), "interpreting a package never raises"),
    "cmake_regex": Target(cmake_regex, "regex", seeds_of("regex"), "matching never raises"),
    "conditions": Target(conditions, "conditions", seeds_of("conditions"), "conditions and versions never raise"),
    "yaml": Target(documents(load_yaml), "yaml", seeds_of("yaml", "launch_yaml"), "raises DocumentError alone"),
    "toml": Target(documents(load_toml), "toml", seeds_of("toml"), "raises DocumentError alone"),
    "json": Target(documents(load_json), "json", seeds_of("json"), "raises DocumentError alone"),
    "settings": Target(settings, "toml", seeds_of("toml"), "raises ConfigError alone"),
    "pinned": Target(pinned, "yaml", seeds_of("yaml"), "raises BaseError alone"),
    "baseline": Target(baseline, "json", seeds_of("json"), "raises SettingsError alone"),
    "captured": Target(captured, "json", seeds_of("json"), "raises TargetError alone"),
    "listing": Target(listing, "listing", seeds_of("listing"), "reading a listing never raises"),
    "allow": Target(allowed, "allow", seeds_of("allow", "cpp"), "comments lie within the file"),
    "discovery": Target(discovered, "yaml", seeds_of("discovery"), "finding packages never raises; each has a name"),
    "elf": Target(binary, "bytes", _elf_seeds, "reading a library never raises; facts encode and decode to the same"),
    "deb": Target(deb, "bytes", _deb_seeds, "raises DebError alone"),
    "rows": Target(rows, "bytes", _row_seeds, "damaged rows raise DecodeError or ValueError alone"),
    "memories": Target(memories, "bytes", _memory_seeds, "damaged memories are forgotten"),
    "console": Target(printed, "text", seeds_of("text"), "prints no control character, no command, no further line"),
    "markdown": Target(marked, "text", seeds_of("text"), "texts stay texts, and tables tables"),
    "reports": Target(reports, "json", seeds_of("json"), "raises CorpusError alone"),
    "archived": Target(archived, "html", seeds_of("html", "yaml"), "raises CorpusError or ValueError alone"),
    "pages": Target(pages, "html", seeds_of("html"), "raises CorpusError alone"),
})  # fmt: skip
"""Every target by its name on the command line."""

assert all(target.language in WORDS for target in TARGETS.values())
