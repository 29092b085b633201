"""Builds data/changes_pypi.json.zst: names that versions of Python libraries lost or deprecate, by PyPI's wheels.

    python -P -m rosimpact.databuild.pypi WORK [--only NAME ...]

Of each library the versions that some platform has are read, an older one and the newest; where one lost names that the
one before has, the first releases of the minor versions between them are read too, until the one is found that lost
them. Of names that a module lost before all wheels, such as those of PyQt4's QtGui, the newest wheel says where they
are. Wheels are downloaded with pip, a few at a time, read as archives and deleted; nothing is installed or run. WORK
keeps what was read of each, so that a run that was stopped goes on with the next wheel; it is read anew when the code
that reads is another. What pip cannot download is asked for once more; a library of which a wheel is lacking then keeps
the rows that it has, and is named at the end.

A name is in a version when a module, or its stub, binds it. It is gone from a version on when from then on no version
has it and each surely lacks it: its module can be read in full and does not bind it, its module's `__getattr__` lists
it only to raise for it, or its stub had it and no longer has, and no file says it any more. Names that are private,
that tests have, or that stand in what is gone itself, are left out.
"""

from __future__ import annotations

import argparse
import ast
import hashlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, cached_property, partial
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import zstandard

from ..edges.console import UserError
from ..edges.files import write_file
from ..edges.memory import cache_method
from ..impact.facts.python import source, surface
from ..impact.facts.python.source import read
from ..impact.facts.python.surface import ModuleSurface, is_private
from ..impact.targets.surface.python import UNKNOWN, PythonName, SurfaceNames
from ..impact.targets.surface.surface import InstalledModule, PythonSurface
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import is_at_least, parse
from .extract import module_getattr, python
from .extract.module_getattr import read_module_getattr
from .extract.python import extract
from .includes import list_platform_versions
from .python_std import prepare_stub
from .table_file import write_table

FILE = "changes_pypi.json.zst"
PROJECTS = {name: name for name in (
    "flask", "jinja2", "matplotlib", "networkx", "numpy", "paho-mqtt", "pillow", "pyserial", "pytest",
    "pyyaml", "scikit-image", "scipy", "setuptools", "shapely", "transforms3d",
)}  # fmt: skip
"""Platform libraries, by their names in platform_versions.yaml, with what PyPI calls them: those behind rosdep's keys
`python3-*` that released packages name, and that PyPI has under the versions of the platforms."""


class MovedNames(NamedTuple):
    """Names that a library took out of a module with a version that came before all wheels. project: as PyPI calls it.
    module: what had them. homes: the modules that have them since. removed_in: that version. source: who says so."""

    project: str
    module: str
    homes: tuple[str, ...]
    removed_in: str
    source: str


MOVED = {
    "pyqt5": MovedNames("PyQt5", "PyQt5.QtGui", ("PyQt5.QtWidgets", "PyQt5.QtPrintSupport"), "5.0",
                        "wheels of PyQt5; Differences Between PyQt4 and PyQt5"),
}  # fmt: skip
"""By their names in platform_versions.yaml."""
Report = Callable[[str], None]
_PYTHONS = ("3.12", "3.10", "3.8", "3.6", "3.14", "2.7")
_MACHINES = ("manylinux_2_28_x86_64", "manylinux_2_17_x86_64", "manylinux2014_x86_64", "manylinux2010_x86_64",
             "manylinux1_x86_64")  # fmt: skip
_LAST_PYTHON = 14
_DOWNLOADS = "wheel-"
_AT_A_TIME = 3
"""Wheels that are downloaded at a time: pip mostly waits."""
_TRIES, _PATIENCE = 2, 600
_MANY = 12
"""So many deprecated names of one module are one fact: that the module is not to be used."""
_OLDER = 8
"""So many minor versions before the first that a platform has may be read: code may still be written for them."""
_FINAL = re.compile(r"\d+(?:\.\d+)+\Z")
_ASIDE = re.compile(r"(?:.*[._])?(?:tests?|conftest|setup|examples?|benchmarks?|docs?|vendor|extern|externals)"
                    r"(?:[._].*)?\Z")  # fmt: skip
_NATIVE = (".so", ".pyd")
_WORD = re.compile(rb"[A-Za-z_]\w{2,}")


class PyPIRelease(msgspec.Struct, frozen=True, array_like=True):
    """What a version of a library offers. modules: as written in Python. stubs: modules as `.pyi` files tell them.
    native: modules that are built. refused: dotted names that a module's `__getattr__` only raises for. words: where
    there are stubs, what any other file says, a word on each line."""

    version: str
    modules: tuple[InstalledModule, ...] = ()
    stubs: tuple[InstalledModule, ...] = ()
    native: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()
    words: str = ""


class OfferedNames:
    """A release, ready to be asked."""

    def __init__(self, release: PyPIRelease):
        self.release = release
        self._refused = frozenset(release.refused)
        self._python = SurfaceNames(PythonSurface("", release.modules, release.native))
        self._stubbed = {stub.name for stub in release.stubs}
        beside = (module for module in release.modules if module.name not in self._stubbed)
        built = tuple(name for name in release.native if name not in self._stubbed)
        self._stubs = SurfaceNames(PythonSurface("", (*release.stubs, *beside), built))
        self._sides = (self._python, self._stubs) if self._stubbed else (self._python,)

    @cache_method
    def find_each(self, name: str) -> tuple[PythonName | None, ...]:
        """What Python and the stubs say of a name: None for what they have not, UNKNOWN where that cannot be known."""
        return tuple(names.find(name) for names in self._sides)

    @cache_method
    def find(self, name: str) -> PythonName | None:
        """What a name surely is; None where it is not there, or that cannot be known."""
        each = self.find_each(name)[: 1 if name in self._refused else None]
        return next((one for one in each if one is not None and one is not UNKNOWN), None)

    def lacks(self, name: str, before: OfferedNames) -> bool:
        """Whether a name is surely not there. before: a version that has it. Python's word counts for what Python had
        before. Stubs leave out what is there: their word counts for what stubs had, where no file says the name."""
        if self.find(name) is not None:
            return False
        if name in self._refused:
            return True
        here, had = self.find_each(name), before.find_each(name)
        module, _, last = name.rpartition(".")
        if any(module in one.modules and last in (one.modules[module].surface.all or ()) for one in self._sides):
            return False  # it says that it has it: another module puts it there
        if here[0] is None:
            return had[0] not in (None, UNKNOWN)
        if len(here) == 1 or len(had) == 1 or here[1] is not None or had[1] in (None, UNKNOWN):
            return False
        of = next((scope for scope in _list_scopes(name) if scope in self._stubbed), None)
        return of is not None and f"{name.rpartition('.')[2]}\n" not in self.release.words

    @cached_property
    def public(self) -> frozenset[str]:
        """All that others may use: modules and what they offer."""
        found: set[str] = set()
        for names in self._sides:
            found.update(module for module in names.modules if _is_public(module))
            for name, entry in names.offered.items():
                of = names.modules.get(name.rpartition(".")[0])
                if _is_public(name) and (of is None or names is self._stubs or _is_meant_for_others(of, name, entry)):
                    found.add(name)
        return frozenset(found)


def _is_meant_for_others(module: InstalledModule, name: str, entry: PythonName) -> bool:
    """Whether a name of a module is for those who import it: one that its `__all__` lists; without that, what is no
    variable that it needs itself."""
    listed, last = module.surface.all, name.rpartition(".")[2]
    if entry.bound is not None and entry.bound.deprecated:
        return True
    if listed and not module.surface.all_open and not any(one.startswith("+") for one in listed) and last not in listed:
        return False
    # A variable in lower case may be set by another module, which is not followed.
    return entry.kind != "attribute" or last[:1].isupper()


def _list_scopes(name: str) -> Iterator[str]:
    """What a dotted name stands in, the nearest first."""
    while "." in name:
        name = name.rpartition(".")[0]
        yield name


def _is_public(name: str) -> bool:
    return not any(is_private(part) or part.startswith("__") for part in name.split(".")) and not _ASIDE.match(name)


# -- reading -----------------------------------------------------------------------------------------------------------


def read_wheel(file: Path, version: str) -> PyPIRelease:
    """What a wheel holds."""
    modules, stubs, native, refused, words = {}, {}, set(), set(), set()
    with zipfile.ZipFile(file) as archive:
        for path in sorted(archive.namelist()):
            parts = path.split("/")
            if ".dist-info" in parts[0] or ".data" in parts[0] or _is_test(parts):
                continue
            stem, _, ending = parts[-1].partition(".")
            name = ".".join([*parts[:-1], stem]).removesuffix(".__init__").removesuffix("-stubs")
            if not all(part.isidentifier() for part in name.split(".")):
                continue
            if path.endswith((*_NATIVE, ".py")):
                words.update(_WORD.findall(archive.read(path)))
            if path.endswith(_NATIVE):
                native.add(name)
            elif ending in ("py", "pyi"):
                data = archive.read(path)
                if ending == "py":
                    listed = _list_refused(data, partial(_read_sibling, archive, path))
                    refused.update(f"{name}.{one}" for one in listed)
                else:
                    data = _prepare_stub(data)
                kept = modules if ending == "py" else stubs
                facts = _strip_surface(extract(data))
                if ending == "py" and b"attach_stub(" in data and f"{path}i" in archive.NameToInfo:
                    facts = _add_served(facts, extract(archive.read(f"{path}i")))
                kept[name] = InstalledModule(name, "", stem == "__init__", facts)
    return PyPIRelease(version, tuple(modules.values()), tuple(stubs.values()),
                   tuple(sorted(native - modules.keys())), tuple(sorted(refused)),
                   "\n".join(sorted(word.decode() for word in words)) + "\n" if stubs else "")  # fmt: skip


def _prepare_stub(data: bytes) -> bytes:
    """A stub as a module; as it is where it has the syntax of a newer Python than this one, and cannot be read."""
    try:
        return prepare_stub(data, _LAST_PYTHON)
    except SyntaxError:
        return data


def _is_test(parts: Sequence[str]) -> bool:
    return any(part in ("tests", "test") or part.startswith(("test_", "conftest")) for part in parts)


def _strip_surface(surface: ModuleSurface) -> ModuleSurface:
    """A module without what is not asked: parameters, values and lines."""
    replace = msgspec.structs.replace
    names = (replace(one, line=0, parameters=(), value="", annotation="") for one in surface.names
             if one.kind not in ("method", "property", "instance"))  # fmt: skip
    return replace(surface, names=tuple(names), problems=())


def _add_served(module: ModuleSurface, stub: ModuleSurface) -> ModuleSurface:
    """A module whose `__getattr__` is that of lazy_loader.attach_stub() (SPEC 1 of scientific-python.org), which serves
    what the stub beside it imports from its own package."""
    served = tuple(taken for taken in stub.imports if taken.level == 1)
    left = tuple(one for one in module.open if one != ("", "__getattr__"))
    return msgspec.structs.replace(module, imports=(*module.imports, *served), open=left)


def _list_refused(data: bytes, load: Callable[[str], bytes]) -> frozenset[str]:
    """What a module's `__getattr__` lists to raise for it. load: reads a module beside it."""
    tree = read(data).tree if b"def __getattr__" in data else None
    if tree is None:
        return frozenset()
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == "__getattr__"
                 and node.args.args and node.args.args[0].arg != "self"]  # fmt: skip
    body = []
    for node in tree.body:
        beside = read(load(node.module or "")).tree if isinstance(node, ast.ImportFrom) and node.level == 1 else None
        taken = {alias.name for alias in node.names} if isinstance(node, ast.ImportFrom) else set()
        assigned = [one for one in (beside.body if beside is not None else ())
                    if isinstance(one, ast.Assign) and ast.unparse(one.targets[0]) in taken]  # fmt: skip
        body += assigned or [node]
    return read_module_getattr(functions[0], body).refused if len(functions) == 1 else frozenset()


def _read_sibling(archive: zipfile.ZipFile, path: str, module: str) -> bytes:
    """The source of a module in the folder of another; empty for one that is not there."""
    beside = f"{path.rpartition('/')[0]}/{module.replace('.', '/')}.py"
    return archive.read(beside) if module and beside in archive.NameToInfo else b""


class PyPIIndex:
    """PyPI, as pip shows it, and what was read of it. work: the folder that keeps that. downloads: of each wheel that
    was downloaded, its bytes and the seconds that pip took."""

    def __init__(self, work: Path):
        self.work = work
        self.downloads: list[tuple[int, float]] = []
        for left in work.glob(f"{_DOWNLOADS}*"):  # by a run that was stopped
            shutil.rmtree(left)

    def list_versions(self, project: str) -> list[str]:
        """The final releases of a project, oldest first."""
        said = self._run("index", "versions", "--ignore-requires-python", project).stdout
        found = re.search(r"^Available versions: (.+)$", said, re.MULTILINE)
        versions = found[1].split(", ") if found else []
        return sorted(filter(_FINAL.match, versions), key=parse)

    @cache_method
    def list_wheels(self, project: str, python: str) -> frozenset[tuple[int, ...]]:
        """The versions of a project, parsed, that have a wheel for a version of Python on Linux, or one for all. pip
        lists them when it is asked for a version that nobody has."""
        said = self._run(*_select_wheels(python), f"{project}==0.dev0").stderr
        found = re.search(r"\(from versions: ([^)]*)\)", said)
        return frozenset(map(parse, found[1].split(", "))) if found and found[1] != "none" else frozenset()

    def read(self, project: str, version: str) -> PyPIRelease | None:
        """A release; None for one without a wheel for Linux."""
        kept = self.work / f"{project}-{version}.{_compute_reader_stamp()}.msgpack.zst"
        if kept.exists():
            data = kept.read_bytes()
            return msgspec.msgpack.decode(zstandard.decompress(data), type=PyPIRelease) if data else None
        with tempfile.TemporaryDirectory(dir=self.work, prefix=_DOWNLOADS) as folder:
            wheel = self._download(project, version, Path(folder))
            release = read_wheel(wheel, version) if wheel is not None else None
        packed = zstandard.ZstdCompressor(level=9).compress(msgspec.msgpack.encode(release)) if release else b""
        write_file(kept, packed)
        return release

    def _download(self, project: str, version: str, folder: Path) -> Path | None:
        having = (python for python in _PYTHONS if parse(version) in self.list_wheels(project, python))
        python = next(having, None)
        if python is None:
            return None
        started = time.monotonic()
        done = self._run(*_select_wheels(python), "--quiet", "--dest", str(folder), f"{project}=={version}")
        wheel = next(folder.glob("*.whl"), None)
        if wheel is None:
            raise UserError(f"pip has no wheel of {project} {version}: {done.stderr.strip()[-300:]}")
        self.downloads.append((wheel.stat().st_size, time.monotonic() - started))
        return wheel

    def _run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Runs pip, and once more where it fails otherwise than that there is no such version. Raises UserError where
        that fails, too."""
        command = [sys.executable, "-m", "pip", "--disable-pip-version-check", *arguments]
        failure = ""
        for _ in range(_TRIES):
            try:
                done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_PATIENCE)
            except subprocess.TimeoutExpired:
                failure = f"no answer for {_PATIENCE} seconds"
                continue
            # Without an answer of the network, pip knows no version either.
            nothing = "No matching distribution" in done.stderr and "Retrying (" not in done.stderr
            if not done.returncode or nothing:
                return done
            failure = done.stderr.strip()[-300:]
        raise UserError(f"pip {' '.join(arguments)}: {failure}")


@cache
def _compute_reader_stamp() -> str:
    """Differs whenever the code does that reads wheels, so that what another state of it has read is not used."""
    sources = (Path(__file__), *(Path(module.__file__ or "") for module in (module_getattr, python, source, surface)))
    return hashlib.sha1(b"".join(path.read_bytes() for path in sources)).hexdigest()[:8]


def _select_wheels(python: str) -> list[str]:
    """The arguments with which pip downloads wheels alone, of a version of Python on Linux."""
    machines = (word for machine in _MACHINES for word in ("--platform", machine))
    return ["download", "--no-deps", "--only-binary=:all:", "--ignore-requires-python", "--python-version", python,
            *machines]  # fmt: skip


# -- comparing ---------------------------------------------------------------------------------------------------------


def read_versions(
    wanted: Iterable[str], available: Sequence[str], load: Callable[[str], PyPIRelease | None]
) -> list[OfferedNames]:
    """The wanted versions, the newest, an old one, which code may still be written for, and those first
    ones of minor versions between them that tell where names went; oldest first. load: reads a release."""
    known = {parse(version): version for version in available}
    ends = {parse(known[key]) for version in wanted if (key := parse(version)) in known}
    if not ends:
        return []
    minors = {}
    for key in sorted(known):
        minors.setdefault(key[:2], key)
    ends.add(max(minors.values()))
    read: dict[tuple[int, ...], OfferedNames | None] = {}

    def get(key: tuple[int, ...]) -> OfferedNames | None:
        if key not in read:
            release = load(known[key])
            read[key] = OfferedNames(release) if release is not None else None
        return read[key]

    older = [key for key in sorted(minors.values()) if key < min(ends)][-_OLDER:]
    starts = (older[len(older) * part // 4] for part in range(3) if older)
    ends.add(next((key for key in starts if get(key) is not None), min(ends)))
    with ThreadPoolExecutor(_AT_A_TIME) as pool:

        def get_all(keys: Iterable[tuple[int, ...]]) -> list[tuple[int, ...]]:
            """Those of some versions that can be read, oldest first."""
            asked = sorted(keys)
            return [key for key, found in zip(asked, pool.map(get, asked), strict=True) if found is not None]

        firsts = sorted(minors.values())
        gaps = [(one, two, [key for key in firsts if one < key < two]) for one, two in pairwise(get_all(ends))]
        while gaps := [(one, two, keys) for one, two, keys in gaps if keys and _has_losses(get(one), get(two))]:
            found = set(get_all(keys[len(keys) // 2] for _, _, keys in gaps))
            left = []
            for one, two, keys in gaps:
                middle = keys.pop(len(keys) // 2)
                if middle in found:
                    left.append((one, middle, [key for key in keys if key < middle]))
                    left.append((middle, two, [key for key in keys if key > middle]))
                else:
                    left.append((one, two, keys))
            gaps = left
    return [found for _, found in sorted(read.items()) if found is not None]


def _has_losses(before: OfferedNames | None, after: OfferedNames | None) -> bool:
    return before is not None and after is not None and any(_iterate_losses(before, after))


def _iterate_losses(before: OfferedNames, after: OfferedNames) -> Iterator[str]:
    return (name for name in before.public if after.lacks(name, before))


class Loss(NamedTuple):
    """What became of a name. last_in: the last version that surely has it. removed_in: the first one that surely has
    not, empty while all have it. deprecated_in: the first one from which on it warns."""

    name: str
    last_in: str
    removed_in: str
    deprecated_in: str


def find_losses(versions: Sequence[OfferedNames]) -> list[Loss]:
    """The names that versions, oldest first, lost or deprecate."""
    found = {}
    for name in sorted({name for one in versions for name in one.public}):
        entries = [one.find(name) for one in versions]
        has = max((place for place, entry in enumerate(entries) if entry is not None), default=None)
        if has is None:
            continue
        gone = _find_loss(versions, name, has)
        warned = [bool(e.bound is not None and e.bound.deprecated) if e is not None else None for e in entries]
        since = next((n for n in range(has + 1) if all(warned[n:gone])), None)
        removed = versions[gone].release.version if gone < len(versions) else ""
        if removed or since is not None:
            deprecated = versions[since].release.version if since is not None else ""
            last = has if removed else len(versions) - 1
            found[name] = Loss(name, versions[last].release.version, removed, deprecated)

    shares = Counter(loss.name.rpartition(".")[0] for loss in found.values() if not loss.removed_in)

    def is_told(loss: Loss) -> bool:
        """Whether what it stands in tells it, or so much of a module is deprecated that the module itself is."""
        scopes = [found[scope] for scope in _list_scopes(loss.name) if scope in found]
        gone = (scope for scope in scopes if scope.removed_in)
        if any(not loss.removed_in or is_at_least(loss.removed_in, scope.removed_in) for scope in gone):
            return True
        return not loss.removed_in and shares[loss.name.rpartition(".")[0]] > _MANY

    return [loss for loss in found.values() if not is_told(loss)]


def _find_loss(versions: Sequence[OfferedNames], name: str, has: int) -> int:
    """The place of the first version that surely lacks a name, where the newest does; as many as there are for none.
    Two in a row count though it cannot be known of later ones, whose module has a `__getattr__`. has: the place of the
    last version that has the name."""
    lacking = [version.lacks(name, versions[has]) for version in versions[has + 1 :]]
    if not lacking or not lacking[-1]:
        return len(versions)
    twice = next((place for place, both in enumerate(pairwise(lacking)) if all(both)), len(lacking))
    last = len(lacking) - 1
    while last and lacking[last - 1]:
        last -= 1
    return has + 1 + min(twice, last)


def group_losses(library: str, project: str, losses: Iterable[Loss]) -> list[dict[str, Any]]:
    """Losses as rows of a table of changes, by their versions."""
    groups: dict[tuple[str, str, str], dict[str, str]] = {}
    for loss in losses:
        bounds = loss.removed_in and loss.last_in, loss.removed_in, loss.deprecated_in
        groups.setdefault(bounds, {})[loss.name] = ""
    made = []
    for (last, removed, deprecated), names in sorted(groups.items(), key=lambda item: tuple(map(parse, item[0]))):
        group = {"kind": "python-removed", "package": library, "library": True, "source": f"wheels of {project}"}
        bounds = {"last_in": last, "removed_in": removed, "deprecated_in": deprecated}
        made.append({**group, **{key: value for key, value in bounds.items() if value}, "names": names})
    return made


def group_moved(library: str, moved: MovedNames, release: OfferedNames) -> dict[str, Any]:
    """Classes that a version has in other modules than its older sister had, and not in that one any more, as a row of
    a table of changes."""
    names = {}
    for name in sorted(release.public):
        home, _, last = name.rpartition(".")
        old = f"{moved.module}.{last}"
        if home in moved.homes and last[:1].isupper() and not last.isupper() and old not in release.public:
            names[old] = name
    return {"kind": "python-removed", "package": library, "library": True, "source": moved.source,
            "removed_in": moved.removed_in, "names": names}  # fmt: skip


def build_moved(library: str, moved: MovedNames, index: PyPIIndex, report: Report) -> list[dict[str, Any]]:
    """The row of what a module no longer has, by the newest version that a platform has."""
    available = {parse(version): version for version in index.list_versions(moved.project)}
    keys = sorted(available.keys() & set(map(parse, list_platform_versions(library))))
    release = index.read(moved.project, available[keys[-1]]) if keys else None
    if release is None:
        raise UserError("no version that a platform has is there as a wheel")
    group = group_moved(library, moved, OfferedNames(release))
    report(f"{library}: {release.version} read; {len(group['names'])} names that moved")
    return [group]


def build_losses(library: str, project: str, index: PyPIIndex, report: Report) -> list[dict[str, Any]]:
    """The rows of a library. report: is told what was read of it."""
    wanted, available = list_platform_versions(library), index.list_versions(project)
    versions = read_versions(wanted, available, lambda version: index.read(project, version))
    if not versions:
        raise UserError("no version that a platform has is there as a wheel")
    made = group_losses(library, project, find_losses(versions))
    have = {parse(one.release.version) for one in versions}
    lacking = " ".join(one for one in sorted(wanted, key=parse) if parse(one) not in have)
    rows = sum(len(group["names"]) for group in made)
    report(f"{library}: {len(versions)} versions read, {rows} names" + (f"; no wheel of {lacking}" if lacking else ""))
    return made


def build_groups(index: PyPIIndex, names: Collection[str], report: Report) -> tuple[list[dict[str, Any]], list[str]]:
    """The rows of some libraries, and which of them could not be read. names: as in PROJECTS and MOVED."""
    groups: list[dict[str, Any]] = []
    unread = []
    for library in sorted(names):
        try:
            if library in PROJECTS:
                groups += build_losses(library, PROJECTS[library], index, report)
            else:
                groups += build_moved(library, MOVED[library], index, report)
        except (UserError, OSError, zipfile.BadZipFile) as error:
            report(f"{library}: not read: {error}")
            unread.append(library)
    return groups, unread


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=Path, help="folder that keeps what was read")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="read these libraries alone")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    given.work.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    index, file = PyPIIndex(given.work), given.output / FILE
    names = sorted(name for name in (*PROJECTS, *MOVED) if not given.only or name in given.only)
    made, unread = build_groups(index, names, lambda text: print(text, flush=True))
    if len(unread) == len(names):
        raise UserError(f"none of {len(names)} libraries could be read; {FILE} stays as it is")
    anew = set(names) - set(unread)
    before = read_table(file, dict[str, Any])["changes"] if file.exists() else []
    kept = [one for one in before if one["package"] not in anew] if given.only or unread else []
    size = write_table(file, {"changes": sorted([*kept, *made], key=lambda group: group["package"])})
    megabytes, waited = sum(one for one, _ in index.downloads) / 1e6, sum(seconds for _, seconds in index.downloads)
    print(
        f"{len(index.downloads)} wheels downloaded, {megabytes:.0f} MB; {_AT_A_TIME} at a time, {waited:.0f} s in all"
    )
    print(f"{size} bytes, {time.monotonic() - started:.0f} s")
    print(f"{len(anew)} of {len(names)} libraries read" + (f"; not read: {', '.join(unread)}" if unread else ""))


if __name__ == "__main__":
    main()
