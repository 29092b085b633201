"""`rosimpact data build SOURCES.toml`: makes every derived table anew, from the sources that a file names.

Each table has a builder of its own; this runs them in the order in which one reads what another wrote, each in a
process of its own, and remembers in a work folder which have ended: a build that was stopped goes on where it was. A
table whose sources the file does not name, or that are not there, or whose builder fails, and one that is reviewed by
hand, stays as it is, and the builders behind it read it so. See DATA.md for what each builder reads.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

import msgspec

from ..edges.console import UserError
from ..edges.documents import DocumentError, load_toml
from ..edges.files import check_writable_path, read_file, write_file
from ..edges.limits import get_limits
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA, DATA_VARIABLE, MANIFEST
from .git import Report
from .table_manifest import write_manifest

_STATE = "steps.json"
LOGS = "logs"


class CMakeSources(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """manual: the folder `_sources` of CMake's documentation. modules: folders of modules, the oldest CMake first."""

    manual: str = ""
    modules: tuple[str, ...] = ()


class IncludeSources(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """clones: their names, `OWNER+NAME`. installed: `LIBRARY=VERSION=FOLDER` of headers."""

    clones: tuple[str, ...] = ()
    installed: tuple[str, ...] = ()


class Sources(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where what the builders read lies; paths are relative to the file that names them, and what is left out is not
    at hand.

    rosdistro, meta_ros: clones. clones: a folder of clones called `OWNER+NAME`, with their tags. distros: those whose
    packages' surfaces are read; empty for those of the shipped ones. lists: the folder of lists of an apt, with its
    Contents indices, by platform (`debian bookworm`). apt: an apt configuration with folders of its own, by release
    of Debian. gcc, python: a folder of unpacked packages, by version. stubs: folders `stdlib` of typeshed, oldest
    first. commands: folders of packages that define CMake commands. pypi: whether pip may download wheels.
    opencv: the folder `cv2` of an unpacked wheel of opencv-contrib-python. release_tags: whether what ROS packages lost
    at release tags is read anew, which nobody has reviewed then."""

    rosdistro: str = ""
    meta_ros: str = ""
    clones: str = ""
    distros: tuple[str, ...] = ()
    lists: dict[str, str] = {}
    apt: dict[str, str] = {}
    gcc: dict[str, str] = {}
    python: dict[str, str] = {}
    stubs: tuple[str, ...] = ()
    commands: tuple[str, ...] = ()
    cmake: CMakeSources = CMakeSources()
    includes: IncludeSources = IncludeSources()
    pypi: bool = False
    opencv: str = ""
    release_tags: bool = False


class BuildStep(NamedTuple):
    """A builder. makes: the files that it writes. after: steps whose files it reads. arguments: what it is called with,
    given the sources, the data folder and one of its own for what it keeps; None where its sources are not at hand."""

    name: str
    makes: tuple[str, ...]
    after: tuple[str, ...]
    arguments: Callable[[Sources, Path, Path], list[str] | None]


class BuiltTable(NamedTuple):
    """What became of a step: `made`, `kept` (made by an earlier run), `left` (its sources are not named), `unreached`
    (some that are named are not there, which is said), or `failed`. seconds: what it took. said: the last lines that it
    printed."""

    step: str
    outcome: str
    seconds: float
    said: tuple[str, ...]


class _Ended(msgspec.Struct, frozen=True):
    key: str
    seconds: float
    said: tuple[str, ...]


def _call(module: str, *arguments: object) -> list[str]:
    return [f"rosimpact.{module}", *map(str, arguments)]


def _list_suites(suites: Mapping[str, str], only: str = "") -> list[str]:
    named = ((name, path) for name, path in suites.items() if name.startswith(only))
    return [word for name, path in named for word in ("--suite", f"{name}={path}")]


def _build_snapshot(sources: Sources, data: Path, own: Path) -> list[str] | None:
    if not sources.rosdistro:
        return None
    meta = ["--meta-ros", sources.meta_ros] if sources.meta_ros else []
    return _call("impact.cli", "data", "build", sources.rosdistro, "--output", data, "--work", own, *meta)


def _build_surfaces(sources: Sources, data: Path, own: Path) -> list[str] | None:
    if not sources.clones:
        return None
    names = sources.distros or load_shipped().about.distros.split()
    distros = (word for name in names for word in ("--distro", name))
    file = data / "surfaces.sqlite"
    return _call("impact.cli", "surface", "build", "--all-versions", *distros, "--repos", sources.clones,
                 "--output", file, "--quiet")  # fmt: skip


def _read_clones(module: str) -> Callable[[Sources, Path, Path], list[str] | None]:
    """The arguments of a builder that reads the folder of clones."""
    return lambda sources, data, own: _call(module, sources.clones) if sources.clones else None


def _build_providers(sources: Sources, data: Path, own: Path) -> list[str] | None:
    clones = ["--repositories", sources.clones] if sources.clones else []
    return _call("databuild.providers", *_list_suites(sources.lists), *clones) if sources.lists else None


def _read_debian_lists(module: str) -> Callable[[Sources, Path, Path], list[str] | None]:
    """The arguments of a builder that reads the indices of Debian's suites."""

    def list_arguments(sources: Sources, data: Path, own: Path) -> list[str] | None:
        suites = _list_suites(sources.lists, "debian ")
        return _call(module, *suites) if suites else None

    return list_arguments


def _build_compiled(sources: Sources, data: Path, own: Path) -> list[str] | None:
    """The newest stable release of Debian that has the packages of ROS 1 counts, which is the one that is named so."""
    suite = ["--suite", f"bookworm={sources.apt['bookworm']}"] if "bookworm" in sources.apt else []
    clones = ["--clones", sources.clones] if sources.clones else []
    return _call("databuild.compiled", own, *suite, *clones, "--output", data) if suite else None


def _build_libraries(sources: Sources, data: Path, own: Path) -> list[str] | None:
    clones = ["--clones", sources.clones] if sources.clones else []
    return _call("databuild.debian", own, *_list_suites(sources.apt), *clones) if sources.apt else None


def _build_includes(sources: Sources, data: Path, own: Path) -> list[str] | None:
    named = sources.includes
    if not sources.clones or not named.clones:
        return None
    installed = (word for one in named.installed for word in ("--installed", one))
    return _call("databuild.includes", sources.clones, *named.clones, *installed)


def _build_std_names(sources: Sources, data: Path, own: Path) -> list[str] | None:
    folders = [f"{version}={folder}" for version, folder in sources.gcc.items()]
    return _call("databuild.std_names", *folders) if folders else None


def _build_std_includes(sources: Sources, data: Path, own: Path) -> list[str] | None:
    folders = [f"{version}={folder}" for version, folder in sources.gcc.items()]
    return _call("databuild.std_includes", *folders) if folders else None


def _build_std_headers(sources: Sources, data: Path, own: Path) -> list[str] | None:
    folders = [f"{version}={folder}" for version, folder in sources.gcc.items()]
    return _call("databuild.std_headers", *folders, "--work", own, "--output", data) if folders else None


def _build_components(sources: Sources, data: Path, own: Path) -> list[str] | None:
    clones = ["--clones", sources.clones] if sources.clones else []
    asked = [*_list_suites(sources.apt), *clones]
    return _call("databuild.components", own, *asked, "--output", data) if asked else None


def _build_python_modules(sources: Sources, data: Path, own: Path) -> list[str] | None:
    folders = (word for version, folder in sources.python.items() for word in ("--python", f"{version}={folder}"))
    return _call("databuild.python_modules", *sources.stubs, *folders, "--output", data) if sources.stubs else None


def _build_cmake_names(sources: Sources, data: Path, own: Path) -> list[str] | None:
    named = sources.cmake
    return _call("databuild.cmake_names", named.manual, named.modules[0]) if named.manual and named.modules else None


STEPS = (
    BuildStep("snapshot", ("distros.sqlite.zst", "snapshot.json"), (), _build_snapshot),
    BuildStep("manifests", (), ("snapshot",), _read_clones("databuild.manifest_tags")),
    BuildStep("surfaces", ("surfaces.sqlite",), ("manifests",), _build_surfaces),
    BuildStep("python-std", (), ("surfaces",),
         lambda sources, data, own: _call("databuild.python_std", *sources.stubs) if sources.stubs else None),
    BuildStep("providers", ("providers.sqlite.zst", "providers.json"), ("manifests",), _build_providers),
    BuildStep("apt", ("apt.json.zst",), ("providers",), _read_debian_lists("databuild.apt")),
    BuildStep("archive", ("archive.json.zst",), ("providers",), _read_debian_lists("databuild.archive")),
    BuildStep("sonames", ("sonames.json.zst",), (), _read_debian_lists("databuild.sonames")),
    BuildStep("find-modules", ("find_modules.json",), (),
         lambda sources, data, own: _call("databuild.find_modules", *sources.cmake.modules)
         if sources.cmake.modules else None),
    BuildStep("cmake-names", (), (), _build_cmake_names),
    BuildStep("commands", ("commands.json.zst",), ("surfaces", "cmake-names"),
         lambda sources, data, own: _call("databuild.commands", *sources.commands) if sources.commands else None),
    BuildStep("std-names", ("std_names.json.zst",), (), _build_std_names),
    BuildStep("std-headers", ("std_headers.json",), (), _build_std_headers),
    BuildStep("std-includes", ("providers_std.json.zst",), ("std-headers",), _build_std_includes),
    BuildStep("python-modules", ("python_modules.json",), (), _build_python_modules),
    BuildStep("fields", ("fields.json.zst",), ("manifests",),
         lambda sources, data, own: _call("databuild.fields", sources.clones, "--output", data / "fields.json.zst")
         if sources.clones else None),
    BuildStep("gazebo-topics", ("gazebo_topics.json.zst",), (), _read_clones("databuild.gazebo_topics")),
    BuildStep("constants", ("constants.json.zst",), ("manifests",), _read_clones("databuild.constants")),
    BuildStep("gz-systems", ("gz_systems.json.zst",), (), _read_clones("databuild.gz_systems")),
    BuildStep("tree-nodes", ("tree_nodes.json.zst",), ("manifests",), _read_clones("databuild.tree_nodes")),
    BuildStep("conda", ("conda.json.zst",), (), _read_clones("databuild.conda")),
    BuildStep("sid", (), ("conda",),
         lambda sources, data, own: _call("databuild.sid", own, sources.apt["sid"], "--output", data)
         if "sid" in sources.apt else None),
    BuildStep("libraries",
         ("libraries.sqlite", "changes_debian.json.zst", "uses_debian.json", "changes_library_tags.json.zst"),
         ("surfaces", "providers"), _build_libraries),
    BuildStep("compiled", ("compiled.json.zst",), ("surfaces", "libraries"), _build_compiled),
    BuildStep("components", ("components.json.zst",), (), _build_components),
    BuildStep("release-tags", ("changes_ros_tags.json.zst",), ("surfaces",),
         lambda sources, data, own: _call("databuild.release_tags", sources.clones, own, "--output", data)
         if sources.clones and sources.release_tags else None),
    BuildStep("includes", ("includes.json.zst",), ("surfaces",), _build_includes),
    BuildStep("pypi", ("changes_pypi.json.zst",), (),
         lambda sources, data, own: _call("databuild.pypi", own, "--output", data) if sources.pypi else None),
    BuildStep("opencv-python", ("uses_opencv.json",), (),
         lambda sources, data, own: _call("databuild.opencv_python", sources.opencv, "--output", data)
         if sources.opencv else None),
    BuildStep("superseded", (), ("python-std", "libraries", "pypi", "release-tags"),
         lambda sources, data, own: _call("databuild.superseded", "--write")
         if sources.clones or sources.stubs or sources.apt or sources.pypi else None),
)  # fmt: skip
"""Every builder, each behind those whose files it reads."""


def read_sources(file: Path) -> tuple[Sources, frozenset[str]]:
    """The sources that a file names, with absolute paths, and those paths that do not exist. Raises UserError for one
    that cannot be read, and that names what is no source."""
    try:
        text = read_file(file, get_limits().settings).decode()
        named = msgspec.convert(load_toml(text), Sources)
    except DocumentError as error:
        raise UserError(f"{file}:{error.line}: {error}") from None
    except (OSError, ValueError) as error:
        raise UserError(f"{file}: {error}") from None
    home = file.absolute().parent
    absent: set[str] = set()

    def locate(path: str) -> str:
        found = home / path
        if path and not found.exists():
            absent.add(str(found))
        return str(found) if path else ""

    def locate_all(paths: Mapping[str, str]) -> dict[str, str]:
        return {name: locate(path) for name, path in paths.items()}

    installed = (one.rpartition("=")[::2] for one in named.includes.installed)
    located = Sources(
        rosdistro=locate(named.rosdistro),
        meta_ros=locate(named.meta_ros),
        clones=locate(named.clones),
        distros=named.distros,
        lists=locate_all(named.lists),
        apt=locate_all(named.apt),
        gcc=locate_all(named.gcc),
        python=locate_all(named.python),
        stubs=tuple(map(locate, named.stubs)),
        commands=tuple(map(locate, named.commands)),
        cmake=CMakeSources(locate(named.cmake.manual), tuple(map(locate, named.cmake.modules))),
        includes=IncludeSources(
            named.includes.clones, tuple(f"{version}={locate(path)}" for version, path in installed)
        ),
        pypi=named.pypi,
        opencv=locate(named.opencv),
        release_tags=named.release_tags,
    )
    return located, frozenset(absent)


def build_everything(
    file: Path,
    output: Path,
    work: Path,
    only: Collection[str] = (),
    again: Collection[str] = (),
    report: Report | None = None,
) -> Iterator[BuiltTable]:
    """Runs the builders of the tables whose sources a file names, and gives what became of each when it has ended.

    output: the data folder; what is missing in it of the shipped tables is copied there first, so that the reviewed
    ones are in it. work: keeps which steps have ended, what the builders keep, and what they print. only: names of
    steps, all when empty. again: steps that are run although they have ended. Of a step that fails the tables stay as
    they were. Raises UserError for unknown steps and a file of sources that cannot be read.
    """
    known = {step.name for step in STEPS}
    unknown = sorted({*only, *again} - known)
    if unknown:
        raise UserError(f"no step `{unknown[0]}`; the steps are {', '.join(step.name for step in STEPS)}")
    sources, absent = read_sources(file)
    check_writable_path(output / "snapshot.json")
    output, work = output.absolute(), work.absolute()
    for folder in (output, work / LOGS):
        folder.mkdir(parents=True, exist_ok=True)
    _copy_missing(output)
    ended = _read_state(work / _STATE)
    for place, step in enumerate(STEPS):
        if report is not None:
            report(step.name, place, len(STEPS))
        arguments = step.arguments(sources, output, work / step.name) if not only or step.name in only else None
        if arguments is None:
            yield BuiltTable(step.name, "left", 0.0, ())
            continue
        unreached = tuple(f"{path} is not there" for path in sorted(absent) if any(path in word for word in arguments))
        if unreached:
            yield BuiltTable(step.name, "unreached", 0.0, unreached)
            continue
        key = _compute_key(arguments, _list_read(step, output))
        before = ended.get(step.name)
        if before is not None and before.key == key and step.name not in again:
            yield BuiltTable(step.name, "kept", before.seconds, before.said)
            continue
        stored = {path: path.read_bytes() for path in (output / name for name in step.makes) if path.exists()}
        started = time.monotonic()
        status, said = _run(arguments, output, work, work / LOGS / f"{step.name}.txt")
        seconds = time.monotonic() - started
        if status:
            for path, data in stored.items():
                write_file(path, data)
            yield BuiltTable(step.name, "failed", seconds, said[-1:])
            continue
        # Some add to what they read.
        ended[step.name] = _Ended(_compute_key(arguments, _list_read(step, output)), seconds, said)
        write_file(work / _STATE, msgspec.json.encode(ended))
        yield BuiltTable(step.name, "made", seconds, said)
    write_manifest(output)


def _copy_missing(output: Path) -> None:
    for path in sorted(DATA.iterdir()):
        if path.is_file() and path.name != MANIFEST and not (output / path.name).exists():
            shutil.copyfile(path, output / path.name)


def _read_state(file: Path) -> dict[str, _Ended]:
    try:
        return msgspec.json.decode(file.read_bytes(), type=dict[str, _Ended])
    except FileNotFoundError:
        return {}
    except (OSError, ValueError) as error:
        raise UserError(f"{file}: {error}; delete it to build everything anew") from None


def _list_before(step: BuildStep) -> list[str]:
    """The steps whose output a step reads, directly or by what those read."""
    by_name = {one.name: one for one in STEPS}
    found = list(step.after)
    for name in found:
        found.extend(one for one in by_name[name].after if one not in found)
    return found


def _list_read(step: BuildStep, output: Path) -> list[Path]:
    """The files of the steps whose output a step reads, whatever made them."""
    before = _list_before(step)
    return sorted(output / file for one in STEPS if one.name in before for file in one.makes)


def _compute_key(arguments: Iterable[str], read: Iterable[Path]) -> str:
    """Differs whenever a step is called with something else, or what it reads of other steps is."""
    digest = hashlib.sha256("\0".join(arguments).encode())
    for path in read:
        if path.is_file():
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def _run(arguments: list[str], output: Path, work: Path, log: Path) -> tuple[int, tuple[str, ...]]:
    """Runs a builder on a data folder. Returns its exit status and the last lines that it printed."""
    environment = {**os.environ, DATA_VARIABLE: str(output), "PYTHONSAFEPATH": "1"}
    with log.open("wb") as opened:
        ended = subprocess.run(
            [sys.executable, "-m", *arguments], stdin=subprocess.DEVNULL, stdout=opened, stderr=subprocess.STDOUT,
            env=environment, cwd=work, check=False,
        )  # fmt: skip
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return ended.returncode, tuple(line for line in lines if line.strip())[-5:]
