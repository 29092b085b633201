"""What an install space holds of built files: which package each is of, and what it asks of a machine.

Install spaces of catkin (devel and install), of colcon (isolated and merged), and the prefix of a single package.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import stat
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from ...edges import processes
from ...edges.console import UserError, format_count
from ...edges.files import read_start, read_text
from ...edges.limits import get_limits
from ..facts import elf
from ..facts.elf import Elf
from ..facts.store import Store, make_fact_key, pack, unpack
from ..targets.machine.loader import open_library
from ..tree import PathProblem, shown

if TYPE_CHECKING:
    from ..config import Config
    from ..targets.machine.shared_libraries import SharedLibraries
    from ..targets.resolve import Chosen
    from .workspace import Workspace

THIS_MACHINE = "this machine"

# What is never a program or library, so that it need not be opened.
_TEXTS = (
    ".h .hh .hpp .hxx .cuh .py .pyc .cmake .xml .xacro .urdf .sdf .msg .srv .action .idl .json .yaml .yml .txt "
    ".md .rst .sh .bash .zsh .ps1 .dsv .bat .in .em .launch .rviz .dae .stl .obj .png .jpg .pc .a .html .css .js .rb"
)
_TEXT_ENDS = tuple(_TEXTS.split())
_BELOW_A_PREFIX = frozenset(("lib", "lib64", "bin", "share", "opt"))
_LEFT_OUT = frozenset((".debug", ".git", "CMakeFiles"))
# Below this, reading takes less time than starting processes.
_ALONE_BYTES = 20_000_000
_PARTS_PER_JOB = 4
# that an install space is said to be built on
_PREFIXES = 100
_PREFIX_OF_COLCON = re.compile(r'^COLCON_CURRENT_PREFIX="([^"$]+)"', re.M)
_PREFIXES_OF_CATKIN = re.compile(r"CMAKE_PREFIX_PATH = r?'([^']*)'")


class InstallError(UserError):
    """There is no install space to read; the text says what to do."""


class Binary(NamedTuple):
    """A built file. path: below the install space; folder: where it really lies; package: empty where nothing tells."""

    path: str
    folder: str
    package: str
    elf: Elf


class InstallSpace(NamedTuple):
    """An install space. label: as it was given. libraries: names by which its own libraries can be found. problems:
    files that could not be read in full. underlays: prefixes that it was built on."""

    label: str
    binaries: tuple[Binary, ...]
    libraries: frozenset[str]
    problems: tuple[PathProblem, ...]
    underlays: tuple[str, ...]

    @property
    def places(self) -> dict[str, str]:
        """The files of its own libraries, by the names by which they can be found."""
        found: dict[str, str] = {}
        for binary in self.binaries:
            name = binary.path.rpartition("/")[2]
            for known in (name, binary.elf.soname):
                if known and ".so" in known:
                    found.setdefault(known, os.path.join(binary.folder, name))
        return found


def read_installed(
    folder: Path,
    store: Store,
    packages: Iterable[str] = (),
    owners: Mapping[str, str] | None = None,
    jobs: int | None = None,
) -> InstallSpace:
    """Reads an install space. packages: names of the workspace's packages. owners: names of libraries and programs that
    they build, to the package. jobs: processes to read with, all available cores when None.

    What a file asks for is kept by its content. Raises InstallError when there is no such folder, or nothing built in
    it.
    """
    label = shown(os.fspath(folder))
    if not folder.is_dir():
        what = "is a file" if folder.exists() else "there is no such folder"
        raise InstallError(f"--install {label}: {what}; give the install or devel folder of a built workspace")
    problems: list[PathProblem] = []
    files = list(_list_candidates(folder, problems))
    facts = _read_facts([real for _, real in files], store, jobs or processes.count_cores())
    binaries = []
    names = set()
    owner = _Owner(folder, packages, owners or {})
    listed = set()
    seen = False
    for path, real in files:
        found = facts[real]
        if isinstance(found, str):
            problems.append(PathProblem(_join_path(label, path), found))
            continue
        if found is None:
            continue
        seen = True
        if found.problem:
            problems.append(PathProblem(_join_path(label, path), found.problem))
        if not found.dynamic:
            continue
        names.update((path.rpartition("/")[2], *([found.soname] if found.soname else [])))
        if real not in listed:
            listed.add(real)
            binaries.append(Binary(path, os.path.dirname(real), owner.find_package(path, real), found))
    if not seen:
        unread = f" ({problems[0].path}: {problems[0].message})" if problems else ""
        raise InstallError(
            f"--install {label}: holds no built program or library (no ELF file){unread}; build the workspace first, "
            "or give another folder"
        )
    return InstallSpace(
        label, tuple(binaries), frozenset(names), tuple(problems), tuple(islice(_read_underlays(folder), _PREFIXES))
    )


def _join_path(label: str, path: str) -> str:
    return os.path.join(label, path).replace(os.sep, "/")


def _list_candidates(folder: Path, problems: list[PathProblem]) -> Iterator[tuple[str, str]]:
    """(path below the folder, the file it leads to) of what may be built files, sorted."""

    def add_unread(error: OSError) -> None:
        where = os.path.relpath(os.fsdecode(error.filename or folder), folder)
        problems.append(PathProblem(_join_path(shown(os.fspath(folder)), shown(where)), _explain(error)))

    entries = 0
    for here, folders, names in os.walk(folder, onerror=add_unread):
        folders[:] = sorted(name for name in folders if name not in _LEFT_OUT)
        if folders and here.count(os.sep) - os.fspath(folder).count(os.sep) >= get_limits().depth:
            add_unread(OSError(errno.ELOOP, f"folders nested deeper than {get_limits().depth}", here))
            folders.clear()
        entries += len(names)
        if entries > get_limits().entries:
            add_unread(OSError(errno.EFBIG, f"more than {get_limits().entries:,} files, the others are left out", here))
            return
        for name in sorted(names):
            if name.endswith(_TEXT_ENDS):
                continue
            whole = os.path.join(here, name)
            path = os.path.relpath(whole, folder).replace(os.sep, "/")
            try:
                real = os.path.realpath(whole)
                if stat.S_ISREG(os.stat(real).st_mode):
                    yield path, real
            except OSError as error:
                if not os.path.islink(whole):
                    problems.append(PathProblem(_join_path(shown(os.fspath(folder)), shown(path)), _explain(error)))


def _read_facts(paths: Iterable[str], store: Store, jobs: int) -> dict[str, Elf | str | None]:
    """What each file asks for: None for one that is no ELF file, a text that says why one could not be read."""
    result: dict[str, Elf | str | None] = {}
    sizes: dict[str, int] = {}
    for path in dict.fromkeys(paths):
        try:
            if read_start(path, 4) == elf.MAGIC:
                sizes[path] = os.stat(path).st_size
            else:
                result[path] = None
        except OSError as error:
            result[path] = _explain(error)
    keys: dict[str, bytes] = {}
    for path in sizes:
        try:
            keys[path] = make_fact_key(_compute_content_id(path), elf.EXTRACTOR)
        except OSError as error:
            result[path] = _explain(error)
    known: dict[bytes, Elf] = {}
    for key, data in store.get(set(keys.values())):
        try:
            known[key] = msgspec.msgpack.decode(unpack(data), type=Elf)
        except (ValueError, msgspec.MsgspecError):
            continue
    wanted = {key: path for path, key in keys.items() if key not in known}
    fresh = {key: data for key, data in _read_all(wanted, sizes, store, jobs) if data}
    store.put(list(fresh.items()))
    known.update((key, msgspec.msgpack.decode(unpack(data), type=Elf)) for key, data in fresh.items())
    result.update((path, known.get(key, "cannot be read")) for path, key in keys.items())
    return result


def _read_all(
    wanted: Mapping[bytes, str], sizes: Mapping[str, int], store: Store, jobs: int
) -> Iterator[tuple[bytes, bytes]]:
    items = sorted(wanted.items(), key=lambda item: -sizes[item[1]])
    parts = [part for at in range(jobs * _PARTS_PER_JOB) if (part := items[at :: jobs * _PARTS_PER_JOB])]
    jobs = 1 if sum(sizes[path] for _, path in items) < _ALONE_BYTES else jobs
    store.close()  # no other process may go on with a connection of this one
    for _, rows in processes.run_forked_rows(_extract_facts, parts, jobs):
        yield from (row for row in rows if row is not None)


def _extract_facts(items: Iterable[tuple[bytes, str]]) -> list[tuple[bytes, bytes]]:
    """(key, packed facts) of files; no facts for one that cannot be read any more."""
    rows = []
    for number, (key, path) in enumerate(items):
        try:
            processes.begin_part(number, os.path.getsize(path))
            with open_library(path) as file:
                found = elf.read(file)
        except OSError:
            found = None
        rows.append((key, pack(msgspec.msgpack.encode(found)) if found is not None else b""))
    return rows


def _compute_content_id(path: str) -> str:
    """git's id of the file's content."""
    with open_library(path) as file:
        digest = hashlib.sha1(b"blob %d\0" % os.fstat(file.fileno()).st_size, usedforsecurity=False)
        while chunk := file.read(1 << 20):
            digest.update(chunk)
    return digest.hexdigest()


def _explain(error: OSError) -> str:
    return f"cannot be read: {(error.strerror or type(error).__name__).lower()}"


def read_space(folder: Path, root: Path, workspace: Workspace, store: Store, jobs: int | None = None) -> InstallSpace:
    """The install space of a workspace whose root is given. Raises as read_installed() does."""
    owners: dict[str, str] = {}
    for package in workspace:
        for target in package.build.targets:
            # A name that two packages build tells nothing.
            owners[target.name] = package.name if owners.get(target.name, package.name) == package.name else ""
    found = read_installed(
        folder, store, workspace.packages, {name: owner for name, owner in owners.items() if owner}, jobs
    )
    inside = os.path.relpath(os.path.realpath(folder), os.path.realpath(root))
    return found if inside.startswith("..") else found._replace(label=inside.replace(os.sep, "/"))


def list_shared_libraries(installed: InstallSpace, targets: Sequence[Chosen], config: Config) -> list[SharedLibraries]:
    """What each target has to run the files with, and this machine, on its own where no target is it."""
    from ..targets.capture import list_prefixes, read_platform
    from ..targets.machine.loader import Loader, detect_machine
    from ..targets.machine.shared_libraries import DescribedLibraries, InstalledLibraries
    from ..targets.machine.sonames import load_sonames
    from ..targets.platform import normalize_platform

    base = config.path.parent if config.path else Path()
    underlays = [str(base / os.path.expanduser(underlay)) for underlay in config.underlays]
    sourced = [str(prefix) for prefix in list_prefixes(Path("/"), dict(os.environ))]
    own, near = _list_library_folders(underlays), _list_library_folders([*installed.underlays, *sourced])
    platform = normalize_platform(read_platform(Path("/")))
    loader, machine = Loader([*own, *near]), detect_machine()
    found: list[SharedLibraries] = []
    distro = os.environ.get("ROS_DISTRO", "")
    for chosen in targets:
        target = chosen.target
        # Sourced here and not dated otherwise: then it is this very machine, and its files say more than any list.
        if target.name == target.distro == distro and target.platform == platform:
            found.append(InstalledLibraries(target.name, loader, machine, platform, load_sonames()))
        else:
            found.append(
                DescribedLibraries(target, load_sonames(), _list_library_names(own), _list_library_names(near))
            )
    if not any(isinstance(libraries, InstalledLibraries) for libraries in found):
        found.append(InstalledLibraries(THIS_MACHINE, loader, machine, platform, load_sonames()))
    return found


def list_foreign_files(installed: InstallSpace, shared_libraries: Iterable[SharedLibraries]) -> Iterator[PathProblem]:
    """What cannot be known of files that are built for another kind of machine than one that would run them."""
    for libraries in shared_libraries:
        others = Counter(
            b.elf.machine for b in installed.binaries if libraries.machine and b.elf.machine != libraries.machine
        )
        for machine, count in sorted(others.items()):
            kind = machine.removeprefix("EM_").lower() or "a machine that is not named"
            files = format_count(count, "file")
            yield PathProblem(installed.label, f"{files} built for {kind}, not checked against {libraries.name}")


def _list_library_folders(prefixes: Iterable[str]) -> list[str]:
    """Folders with libraries of prefixes: merged, isolated, and those of vendor packages."""
    patterns = ("lib", "lib64", "lib/*-linux-gnu*", "opt/*/lib", "*/lib")
    found: dict[str, None] = {}
    for prefix in prefixes:
        for pattern in patterns:
            found.update(dict.fromkeys(str(place) for place in sorted(Path(prefix).glob(pattern)) if place.is_dir()))
    return list(found)


def _list_library_names(folders: Iterable[str]) -> frozenset[str]:
    names: set[str] = set()
    for folder in folders:
        try:
            names.update(name for name in os.listdir(folder) if ".so" in name)
        except OSError:
            continue
    return frozenset(names)


class _Owner:
    """Tells which package an installed file is of.

    In this order: colcon's folder for each package, catkin's `.private`, the folder in `build` that a linked file lies
    in, folders named after a package (`lib/<package>`, `share/<package>`, a Python package), the build's own lists
    (install_manifest.txt), what the workspace builds under that name, generated libraries of interfaces, the name.
    """

    def __init__(self, folder: Path, packages: Iterable[str], built: Mapping[str, str]):
        self._built = built
        self._isolated = {
            place.name
            for place in _list_folders(folder)
            if (place / "share" / place.name / "package.xml").exists()
            or (place / "share" / "colcon-core" / "packages" / place.name).exists()
        }
        self._known = {manifest.parent.name for manifest in folder.glob("share/*/package.xml")} | self._isolated
        self._known.update(path.name for path in folder.glob("share/ament_index/resource_index/packages/*"))
        self._known.update(path.name for path in folder.glob("share/colcon-core/packages/*"))
        self._single = next(iter(self._known)) if len(self._known) == 1 else ""
        self._known.update(packages)
        self._builds = [folder.parent / "build", folder.parent / "build_isolated", folder.parent.parent / "build"]
        self._listed = self._read_manifests(folder)

    def find_package(self, path: str, real: str) -> str:
        """The package of a file, empty where nothing tells."""
        parts = path.split("/")
        if len(parts) > 2 and (parts[0] in self._isolated or (parts[0] in self._known and parts[1] in _BELOW_A_PREFIX)):
            return parts[0]
        whole = real.split("/")
        for marker in (".private", "build", "build_isolated"):
            for at, part in enumerate(whole[:-2]):
                if part == marker and whole[at + 1] in self._known:
                    return whole[at + 1]
        for part in reversed(parts[1:-1]):
            if part in self._known:
                return part
        name = parts[-1]
        if path in self._listed:
            return self._listed[path]
        if name in self._built:
            return self._built[name]
        stem = re.sub(r"^lib|(?:\.cpython[^.]*|\.[\w-]+-linux-gnu\w*)?\.so.*$", "", name)
        for candidate in (self._built.get(stem, ""), stem.partition("__")[0], stem):
            if candidate in self._known:
                return candidate
        return self._single

    def _read_manifests(self, folder: Path) -> dict[str, str]:
        """Paths below the folder to the package whose build listed them as installed."""
        found = {}
        start = os.path.realpath(folder)
        for build in self._builds:
            for manifest in sorted(build.glob("*/install_manifest.txt")):
                try:
                    lines = read_text(manifest, get_limits().listing, "replace").splitlines()
                except OSError:
                    continue
                for line in lines:
                    if line.startswith(start + "/"):
                        found[line[len(start) + 1 :]] = manifest.parent.name
        return found


def _list_folders(folder: Path) -> list[Path]:
    try:
        return [place for place in folder.iterdir() if place.is_dir()]
    except OSError:
        return []


def _read_underlays(folder: Path) -> Iterator[str]:
    """Prefixes that an install space was built on, as its own setup files name them; for the prefix of one package the
    install space around it."""
    marks = ("share", "share/colcon-core/packages")
    if folder.name and any((folder / mark / folder.name).exists() for mark in marks):
        yield str(folder.parent)
        yield from _read_underlays(folder.parent)
    for name, pattern, parted in (
        ("setup.sh", _PREFIX_OF_COLCON, ""),
        ("_setup_util.py", _PREFIXES_OF_CATKIN, ";"),
    ):
        try:
            text = read_text(folder / name, get_limits().settings, "replace")
        except OSError:
            continue
        for match in pattern.finditer(text):
            yield from (prefix for prefix in (match[1].split(parted) if parted else [match[1]]) if prefix)
