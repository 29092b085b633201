"""What an installed package offers: read from a prefix (`/opt/ros/humble`, `/usr` of Debian's ROS), or from Debian
packages. In the form of surface.py, so that it can be compared with what the sources of a version offer.

Which headers are whose is told by Debian's lists of files where a prefix has them, else by the folder they lie in.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from ...edges.files import make_size_error, read_file, read_start
from ...edges.limits import get_limits
from ...impact.facts import interface as interfaces
from ...impact.facts import manifest as manifests
from ...impact.facts.interface import Field, Interface, Section
from ...impact.facts.kinds import HEADER_ENDINGS
from ...impact.facts.launch import flow as flow_launch
from ...impact.facts.surface import HeaderSurface
from ...impact.targets.surface.fields import ROS1_SUFFIXES
from ...impact.targets.surface.surface import (
    BuildSurface,
    ExportedTarget,
    Header,
    InstalledLaunchFile,
    InstalledModule,
    InstalledProgram,
    PythonSurface,
    Surface,
)
from ..extract import cpp, python
from .build import classify_launch_file, launch_arguments
from .clones import VersionError
from .compare import RepositorySurfaces
from .headers import keep_compiled_includes
from .unpacked_deb import DebError, DebFile, read_members

_DPKG = Path("/var/lib/dpkg/info")
_START = 4
_PYTHON = re.compile(r"(?:local/)?lib/python3?[\d.]*/(?:dist|site)-packages/(.+)")
_EXTENSION = re.compile(r"(?:\.cpython-[\w-]+|\.abi3)?\.so\Z")
_CONFIGURATION = re.compile(r"(.+?)(?:-config|Config)\.cmake\Z")
_IMPORTED = re.compile(r"\badd_library\s*\(\s*([\w:.+-]+)\s+(SHARED|STATIC|MODULE|INTERFACE|UNKNOWN)\s+IMPORTED\b")
_COMMAND = re.compile(r"^\s*(?:function|macro)\s*\(\s*([A-Za-z]\w*)", re.MULTILINE | re.IGNORECASE)
_DEPENDENCIES = re.compile(r"""set\s*\(\s*(?:_exported_dependencies|depends)\s+"([\w;]*)"\s*\)""")
_STANDARD = re.compile(r"\bcxx_std_(\d\d)\b")
_KINDS = {"SHARED": "library", "STATIC": "library", "MODULE": "module", "INTERFACE": "interface", "UNKNOWN": "imported"}
# What gencpp and the generators of rosidl begin their headers with.
_GENERATED = re.compile(rb"[Gg]enerated (?:by gencpp|from rosidl_)")
_INTERFACES = ("msg", "srv", "action")
_LIBRARIES = re.compile(r"""^set\s*\(\s*libraries\s+"([^"]*)"\s*\)""", re.MULTILINE)
_TOLD = (
    ("system", "what DEPENDS named is spelt out in an installed prefix"),
    ("plugins", "plugins are not read from an installed prefix"),
)


class InstalledFiles(NamedTuple):
    """Files that were installed together: by one Debian package, or in a prefix without any. paths: from the prefix.
    read: the content of one; start: its first bytes. Both raise OSError."""

    paths: frozenset[str]
    read: Callable[[str], bytes]
    start: Callable[[str], bytes]
    executable: Callable[[str], bool]
    convention: bool = False

    @property
    def packages(self) -> frozenset[str]:
        """ROS packages of which it has the manifest, or anything else below their share folder."""
        return frozenset(found[1] for path in self.paths if (found := re.match(r"share/([^/]+)/package\.xml\Z", path)))


def is_installed(asked: str) -> bool:
    """Whether a user means an installed prefix, a Debian package or a folder of those, not a version."""
    return os.sep in asked


def read_surface(package: str, asked: str) -> tuple[Surface, RepositorySurfaces]:
    """What a package offers that is installed in a prefix, or in a .deb or a folder of them. Raises VersionError."""
    place = Path(asked)
    if not place.exists():
        raise VersionError(f"{asked}: no such file or folder; give an installed prefix, a .deb or a folder of those")
    try:
        parts = load([place]) if place.is_file() else load(found) if (found := sorted(place.glob("*.deb"))) else None
        if parts is None:
            parts = read_prefix(place, package)
    except (DebError, OSError) as error:
        raise VersionError(str(error)) from None
    if not any(f"share/{package}/package.xml" in part.paths for part in parts):
        known = sorted(frozenset().union(*(part.packages for part in parts)))
        names = f"; it has {', '.join(known[:8])}" if known else ""
        raise VersionError(f"{asked}: there is no `{package}` (no share/{package}/package.xml){names}")
    surface = build_surface(package, parts)
    return surface, RepositorySurfaces({package: surface})


# -- where files are ---------------------------------------------------------------------------------------------------


def read_prefix(folder: Path, package: str) -> list[InstalledFiles]:
    """The files of one package in a prefix, and of what its Debian packages have besides."""
    share = folder / "share" / package
    if not share.is_dir():
        have = sorted(path.parent.name for path in folder.glob("share/*/package.xml"))
        if not have:
            raise VersionError(f"{folder}: is no prefix of ROS packages (nothing has share/PACKAGE/package.xml)")
        return [_make_part(folder, [f"share/{name}/package.xml" for name in have])]
    owned = _list_dpkg_files(folder, package)
    if owned:
        return [_make_part(folder, paths) for paths in owned]
    roots = [f"share/{package}", f"include/{package}", f"lib/{package}"]
    roots += [str(path.relative_to(folder)) for path in folder.glob(f"lib/python3*/*-packages/{package}")]
    roots += [str(path.relative_to(folder)) for path in folder.glob(f"local/lib/python3*/*-packages/{package}")]
    found = (path for root in roots for path in (folder / root).rglob("*") if path.is_file())
    return [_make_part(folder, [path.relative_to(folder).as_posix() for path in found], convention=True)]


def _make_part(folder: Path, paths: Iterable[str], convention: bool = False) -> InstalledFiles:
    return InstalledFiles(
        frozenset(paths),
        lambda path: read_file(folder / path, get_limits().text),
        lambda path: read_start(folder / path, _START),
        lambda path: os.access(folder / path, os.X_OK),
        convention,
    )


def _list_dpkg_files(folder: Path, package: str) -> list[list[str]]:
    """Files below a prefix by Debian package, of those that have something of a ROS package; empty without dpkg."""
    start = f"{folder.resolve().as_posix().rstrip('/')}/"
    marks = [f"\n{start}share/{package}/".encode()]
    marks += [f"\n{start}lib/{name}/dist-packages/{package}/".encode() for name in ("python3", "python2.7")]
    found = []
    for file in sorted(_DPKG.glob("*.list")):
        try:
            data = read_file(file, get_limits().listing)
        except OSError:
            continue
        if any(mark in data for mark in marks):
            lines = data.decode("utf-8", "replace").splitlines()
            paths = [line.removeprefix(start) for line in lines if line.startswith(start)]
            found.append([path for path in paths if (folder / path).is_file()])
    return found


def _get_content(files: Mapping[str, DebFile], path: str) -> bytes:
    data = files[path].data
    if len(data) > get_limits().text:
        raise make_size_error(path, get_limits().text)
    return data


def load(files: Sequence[Path]) -> list[InstalledFiles]:
    """The files of Debian packages, from the prefix in which their ROS packages lie. Raises DebError and OSError."""
    parts = []
    for file in files:
        held = read_members(file)
        starts = {found[1] for path in held if (found := re.match(r"((?:usr|opt/ros/[^/]+)/)", path))}
        for start in sorted(starts):
            inside = {path.removeprefix(start): member for path, member in held.items() if path.startswith(start)}
            parts.append(
                InstalledFiles(
                    frozenset(inside),
                    partial(_get_content, inside),
                    partial(lambda inside, path: inside[path].data[:_START], inside),
                    partial(lambda inside, path: inside[path].executable, inside),
                )
            )
    return parts


# -- what they tell ----------------------------------------------------------------------------------------------------


def build_surface(package: str, parts: Sequence[InstalledFiles]) -> Surface:
    """The surface of a package by its installed files. One of the parts has its manifest. What cannot be read is left
    out, and listed as unknown."""
    share = f"share/{package}/"
    unread: dict[str, str] = {}
    parts = [
        part._replace(read=partial(_read_or_note, part.read, unread), start=partial(_read_or_note, part.start, unread))
        for part in parts
    ]
    home = next(part for part in parts if f"{share}package.xml" in part.paths)
    manifest = manifests.extract(home.read(f"{share}package.xml"))
    mine = [part for part in parts if package in part.packages or _touches(part, package)]
    defined = dict(_read_interfaces(package, mine))
    headers: list[tuple[str, HeaderSurface]] = []
    listed: list[Header] = []
    for part, path in _list_headers(package, mine):
        include, data = _include(path), part.read(path)
        if _GENERATED.search(data[:400]):
            listed.append(Header(include, path))
            continue
        listed.append(Header(include, path, path))
        headers.append((include, keep_compiled_includes(cpp.extract(data))))
    cmake = _read_cmake(package, mine)
    modules, unknown = _read_python(package, mine)
    declared = [d.name for d in manifest.dependencies if d.kind in ("exec", "build_export")]
    build = BuildSurface(
        package,
        manifest.version,
        cmake_names=tuple(sorted(cmake.names)),
        targets=tuple(sorted(cmake.targets, key=lambda target: target.name)),
        libraries=tuple(cmake.libraries),
        dependencies=tuple(cmake.dependencies),
        commands=tuple(sorted(cmake.commands)),
        standard=max((target.standard for target in cmake.targets), default=0),
        programs=tuple(_list_programs(package, mine)),
        launches=tuple(_read_launch_files(package, mine)),
        headers=tuple(sorted(set(listed), key=lambda header: (header.include, header.installed))),
        unknown=(*_TOLD, *_list_unread(unread)),
    )
    return Surface(
        package,
        manifest.version,
        build,
        PythonSurface(package, tuple(modules), tuple(sorted(unknown))),
        tuple(sorted(headers, key=lambda item: item[0])),
        tuple(sorted(defined.items())),
        any(part.convention for part in mine),
        tuple(sorted(set(declared))),
    )


def _read_or_note(read: Callable[[str], bytes], unread: dict[str, str], path: str) -> bytes:
    """What a file holds, nothing where it cannot be read, which is noted."""
    try:
        return read(path)
    except OSError as error:
        unread[path] = error.strerror or type(error).__name__
        return b""


def _list_unread(files: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    for path, reason in sorted(files.items()):
        yield "headers" if path.endswith(HEADER_ENDINGS) else "files", f"{path} cannot be read: {reason}"


def _touches(part: InstalledFiles, package: str) -> bool:
    """Whether a Debian package has something of a ROS package whose manifest another one has."""
    starts = (f"share/{package}/", f"include/{package}/", f"lib/{package}/")
    return any(path.startswith(starts) or _get_module_path(path).startswith(f"{package}/") for path in part.paths)


def _get_module_path(path: str) -> str:
    found = _PYTHON.match(path)
    return found[1] if found else ""


def _list_headers(package: str, parts: Sequence[InstalledFiles]) -> Iterator[tuple[InstalledFiles, str]]:
    for part in parts:
        alone = not part.convention and part.packages == {package}
        for path in sorted(part.paths):
            if path.startswith("include/") and path.endswith(HEADER_ENDINGS):
                folder = re.sub(r"\Ainclude/(?:[\w]+-linux-gnu\w*/)?", "", path).partition("/")[0]
                if alone or folder == package:
                    yield part, path


def _include(path: str) -> str:
    """What dependants write: since Humble a package has a folder of its own below include/ (`include/a/a/b.hpp`)."""
    inside = re.sub(r"\Ainclude/(?:[\w]+-linux-gnu\w*/)?", "", path)
    first, _, rest = inside.partition("/")
    return rest if rest.startswith(f"{first}/") else inside


def _read_interfaces(package: str, parts: Sequence[InstalledFiles]) -> Iterator[tuple[str, Interface]]:
    wanted = re.compile(rf"share/{re.escape(package)}/(msg|srv|action)/([A-Za-z]\w*)\.(msg|srv|action)\Z")
    found: dict[str, Interface] = {}
    for part in parts:
        for path in sorted(part.paths):
            reported = wanted.match(path)
            if reported is not None and reported[1] == reported[3]:
                read = interfaces.extract(part.read(path), reported[3])
                sections = tuple(
                    Section(s.name, tuple(Field(f.name, f.type, f.array, f.default, f.line) for f in s.fields),
                            s.constants)
                    for s in read.sections
                )  # fmt: skip
                found.setdefault(f"{reported[1]}/{reported[2]}", Interface(reported[1], sections))
    # What genmsg makes of an action is no message that anybody wrote.
    made = {f"msg/{name[7:]}{suffix}" for name in found if name.startswith("action/")
            for suffix in ROS1_SUFFIXES["action"]}  # fmt: skip
    yield from ((name, one) for name, one in found.items() if name not in made)


class _CMake(NamedTuple):
    """What the CMake files of a package tell, as in BuildSurface."""

    targets: set[ExportedTarget]
    commands: set[str]
    names: set[str]
    libraries: dict[str, None]
    dependencies: dict[str, None]


def _read_cmake(package: str, parts: Sequence[InstalledFiles]) -> _CMake:
    found = _CMake(set(), set(), set(), {}, {})
    # Debian keeps configurations below the folder of the architecture.
    place = re.compile(
        rf"(?:share/{re.escape(package)}/|lib/(?:[\w]+-linux-gnu\w*/)?cmake/{re.escape(package)}/).*\.cmake\Z"
    )
    for part in parts:
        for path in sorted(filter(place.match, part.paths)):
            text = part.read(path).decode("utf-8", "replace")
            reported = _CONFIGURATION.match(path.rpartition("/")[2])
            if reported is not None:
                found.names.add(reported[1])
            standard = max((int(number) for number in _STANDARD.findall(text)), default=0)
            found.targets.update(ExportedTarget(name, _KINDS[kind], standard) for name, kind in _IMPORTED.findall(text))
            if not reported:
                found.commands.update(_COMMAND.findall(text))
            for names in _LIBRARIES.findall(text):
                found.libraries.update((name, None) for name in names.split(";") if re.fullmatch(r"[\w.+]+", name))
            for names in _DEPENDENCIES.findall(text):
                found.dependencies.update((name, None) for name in names.split(";") if name)
    return found


def _read_python(package: str, parts: Sequence[InstalledFiles]) -> tuple[list[InstalledModule], set[str]]:
    modules: dict[str, InstalledModule] = {}
    unknown: set[str] = set()
    for part in parts:
        alone = not part.convention and part.packages == {package}
        for path in sorted(part.paths):
            inside = _get_module_path(path)
            if not inside or ".egg-info/" in inside or not (inside.startswith(f"{package}/") or alone):
                continue
            dotted = inside.replace("/", ".")
            if inside.endswith(".so"):
                unknown.add(_EXTENSION.sub("", inside).replace("/", "."))
            elif any(inside.startswith(f"{package}/{kind}/") for kind in _INTERFACES):
                unknown.add(f"{package}.{inside.split('/')[1]}")
            elif inside.endswith(".py"):
                init = inside.endswith("/__init__.py")
                name = dotted.removesuffix(".__init__.py").removesuffix(".py")
                modules[name] = InstalledModule(name, path, init, python.extract(part.read(path)))
    return [modules[name] for name in sorted(modules)], unknown


def _list_programs(package: str, parts: Sequence[InstalledFiles]) -> Iterator[InstalledProgram]:
    found = {}
    for part in parts:
        for path in part.paths:
            folder, _, name = path.rpartition("/")
            if folder == f"lib/{package}" and "." not in name.removesuffix(".py") and part.executable(path):
                how = "binary" if part.start(path).startswith(b"\x7fELF") else "script"
                found[name] = InstalledProgram(name, folder, how)
    return iter(sorted(found.values(), key=lambda program: program.name))


def _read_launch_files(package: str, parts: Sequence[InstalledFiles]) -> Iterator[InstalledLaunchFile]:
    share = f"share/{package}/"
    for part in parts:
        for path in sorted(part.paths):
            kind = classify_launch_file(path) if path.startswith(share) and "launch" in path else None
            if kind and not path.endswith("__init__.py"):
                actions = flow_launch.extract(part.read(path), kind).actions
                yield InstalledLaunchFile(path.removeprefix(share), tuple(launch_arguments(actions)))
