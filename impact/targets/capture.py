"""This machine as a target: what `rosimpact env capture` writes, and how it is read back.

A captured file holds versions and nothing else: no user names, host names or paths, so that it can be committed.
"""

import datetime
import json
import os
import platform as machine
import re
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

from ...edges import files
from ...edges.documents import DocumentError, load_json
from ...edges.limits import get_limits
from .distro.distro import DistroTarget, TargetError
from .distro.known import list_known_distros
from .providers.library import DEBIAN_PACKAGES
from .version import compare

SCHEMA = 1
_ROS_DEBIAN = re.compile(r"ros-([a-z]+)-([a-z0-9-]+)$")


class CapturedMachine(NamedTuple):
    """What was read from a machine. packages: ROS packages; debian: system packages that matter; pip: Python
    distributions outside the system's own; tools: compilers, CMake. All map names to versions."""

    distro: str
    date: str
    platform: str
    packages: dict[str, str]
    libraries: dict[str, str]
    debian: dict[str, str]
    pip: dict[str, str]
    tools: dict[str, str]


def strip_version(version: str) -> str:
    """A Debian version without epoch, revision and packaging suffixes: `1:4.5.4+dfsg-9` gives `4.5.4`."""
    return re.split(r"[-+~]", version.split(":", 1)[-1], maxsplit=1)[0]


def _find_library_version(version: str) -> str:
    """The library's version that a Debian package's tells. One without a revision is of a package that is Debian's own,
    such as boost-defaults 1.74.0.3ubuntu7: behind the library's three numbers it counts its own changes."""
    own = re.fullmatch(r"(?:\d+:)?(\d+\.\d+\.\d+)\.[^-]*", version)
    return own[1] if own else strip_version(version)


def read_dpkg_rows(rows: Iterable[tuple[str, str]]) -> tuple[str, dict[str, str], dict[str, str], dict[str, str]]:
    """(distro, ROS packages, libraries, system packages that matter) from (Debian name, version) pairs.

    Where packages of several distros are installed, the one with most packages is taken. Debian's own packages of ROS
    (`ros-image-proc`) are of no distro.
    """
    known = {one.name for one in list_known_distros()}
    installed = {name.split(":", 1)[0]: version for name, version in rows}
    by_distro: dict[str, dict[str, str]] = {}
    for name, version in installed.items():
        match = _ROS_DEBIAN.match(name)
        if match and match[1] in known and not name.endswith(("-dbgsym", "-dbg")):
            by_distro.setdefault(match[1], {})[match[2].replace("-", "_")] = strip_version(version)
    distro = max(by_distro, key=lambda d: (len(by_distro[d]), d), default="")
    libraries = {}
    matter = {}
    for library, names in DEBIAN_PACKAGES.items():
        for name in names:
            if name in installed:
                libraries[library] = _find_library_version(installed[name])
                matter[name] = installed[name]
                break
    return distro, by_distro.get(distro, {}), libraries, matter


def capture(
    run: Callable[[list[str]], str] | None = None, root: Path = Path("/"), environment: dict[str, str] | None = None
) -> CapturedMachine:
    """Reads this machine. run: a command to its output (empty when it fails); root and environment are for tests."""
    run = run or run_command
    environment = dict(os.environ) if environment is None else environment
    listing = run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev}\t${Package}\t${Version}\n"])
    rows = [line.split("\t")[1:3] for line in listing.splitlines() if line.startswith("ii") and line.count("\t") == 2]
    distro, packages, libraries, debian = read_dpkg_rows((name, version) for name, version in rows)
    for prefix in list_prefixes(root, environment):
        for manifest in sorted(prefix.glob("share/*/package.xml")):
            name, version = read_name_and_version(manifest)
            if name:
                packages[name] = version  # an overlay comes after what it covers
    tools = {}
    for name, command in (
        ("gcc", ["g++", "-dumpfullversion"]),
        ("clang", ["clang", "-dumpversion"]),
        ("cmake", ["cmake", "--version"]),
    ):
        match = re.search(r"\d+(?:\.\d+)+", run(command))
        if match:
            tools[name] = match[0]
    libraries.update({name: version for name, version in tools.items() if name in ("gcc", "cmake")})
    # The system's Python where it is known; this one may be of a virtual environment.
    libraries.setdefault("python3", machine.python_version())
    return CapturedMachine(
        environment.get("ROS_DISTRO") or distro or _find_only_distro(root),
        datetime.date.today().isoformat(),
        read_platform(root),
        *(dict(sorted(each.items())) for each in (packages, libraries, debian, _list_pip_packages(), tools)),
    )


def dump_capture(captured: CapturedMachine) -> str:
    """The captured file: small, sorted, the same bytes for the same machine on the same day."""
    return json.dumps({"rosimpact_target": SCHEMA, **captured._asdict()}, indent=1, sort_keys=True) + "\n"


def read(path: Path) -> CapturedMachine:
    """Reads a captured file. Raises TargetError with what is wrong and what to do."""
    try:
        data = load_json(files.read_file(path, get_limits().capture))
        # Half a pair of surrogates (`\\ud800`) is valid JSON, and no text that can be written again.
        json.dumps(data, ensure_ascii=False).encode()
    except (OSError, DocumentError, UnicodeEncodeError, RecursionError) as error:
        reason = getattr(error, "strerror", None) or (error if isinstance(error, DocumentError) else "is no text")
        raise TargetError(
            f"{path}: cannot be read as a captured machine: {reason}; write it anew with `rosimpact env capture`"
        ) from None
    if not isinstance(data, dict) or data.get("rosimpact_target") != SCHEMA:
        raise TargetError(f"{path}: is no captured machine of this version; write it anew with `rosimpact env capture`")

    def get_versions(key: str) -> dict[str, str]:
        value = data.get(key, {})
        return {str(k): str(v) for k, v in value.items()} if isinstance(value, dict) else {}

    return CapturedMachine(
        str(data.get("distro", "")), str(data.get("date", "")), str(data.get("platform", "")), get_versions("packages"),
        get_versions("libraries"), get_versions("debian"), get_versions("pip"), get_versions("tools"),
    )  # fmt: skip


def load_capture(path: Path) -> DistroTarget:
    """A captured file as a target. Packages that are not installed there can still be installed: they have the version
    of the distro on the day of the capture. Raises TargetError."""
    return make_target(read(path), path.name.removesuffix(".json"), str(path))


def make_target(captured: CapturedMachine, name: str, where: str) -> DistroTarget:
    """A machine as a target. where: the file it came from, for messages."""
    if not captured.distro:
        raise TargetError(f"{where}: names no ROS distro; set `distro` in it, or capture with ROS sourced")
    versions = {**captured.libraries, **captured.packages}
    try:
        return DistroTarget(captured.distro, captured.date or None, captured.platform or None, versions, name)
    except TargetError as error:
        raise TargetError(f"{where}: {error}") from None


class MachineDifference(NamedTuple):
    """One thing that two machines have in different versions; an empty version means that it is not there."""

    kind: str
    name: str
    first: str
    second: str


def find_differences(first: DistroTarget, second: DistroTarget) -> list[MachineDifference]:
    """What differs between two targets: distro, platform, libraries, released packages."""
    found = []
    for kind, a, b in (("distro", first.distro, second.distro), ("platform", first.platform, second.platform),
                       ("date", first.date, second.date)):  # fmt: skip
        if a != b:
            found.append(MachineDifference(kind, kind, a, b))
    for name in sorted(first.list_library_names() | second.list_library_names()):
        a, b = first.find_library(name) or "", second.find_library(name) or ""
        if a and b and compare(a, b):
            found.append(MachineDifference("library", name, a, b))
    for name in sorted(first.list_released() | second.list_released()):
        a, b = first.find_version(name) or "", second.find_version(name) or ""
        if a != b:
            found.append(MachineDifference("package", name, a, b))
    return found


def run_command(command: list[str]) -> str:
    try:
        found = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", errors="replace", timeout=60,
            check=False,
        )  # fmt: skip
        return found.stdout
    except (OSError, subprocess.TimeoutExpired):
        return ""


def list_prefixes(root: Path, environment: dict[str, str]) -> list[Path]:
    """Installed prefixes, overlaid ones first, so that what covers them is read last."""
    listed = [
        Path(p)
        for key in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "COLCON_PREFIX_PATH")
        for p in environment.get(key, "").split(os.pathsep)
        if p
    ]
    found = sorted((root / "opt" / "ros").glob("*")) if environment.get("ROS_DISTRO") is None else []
    found += [root / "opt" / "ros" / environment["ROS_DISTRO"]] if environment.get("ROS_DISTRO") else []
    return [p for p in [*found, *reversed(listed)] if p.is_dir()]


def _find_only_distro(root: Path) -> str:
    names = [p.name for p in (root / "opt" / "ros").glob("*") if p.is_dir()]
    return names[0] if len(names) == 1 else ""


def read_name_and_version(manifest: Path) -> tuple[str, str]:
    """Name and version that a package.xml gives, two empty texts where it cannot be read."""
    try:
        text = files.read_text(manifest, get_limits().manifest, errors="replace")
    except OSError:
        return "", ""
    name, version = (
        re.search(r"<name>\s*([\w.-]+)\s*</name>", text),
        re.search(r"<version[^<>]*>\s*([\d.]+)\s*</version>", text),
    )
    return (name[1], version[1]) if name and version else ("", "")


def read_platform(root: Path) -> str:
    try:
        text = files.read_text(root / "etc" / "os-release", get_limits().settings, "replace")
    except OSError:
        return ""
    fields = dict(re.findall(r'^(\w+)="?([^"\n]*)"?$', text, re.M))
    release = fields.get("VERSION_CODENAME") or fields.get("UBUNTU_CODENAME") or fields.get("VERSION_ID", "")
    return f"{fields.get('ID', '')} {release}".strip()


def _list_pip_packages() -> dict[str, str]:
    """Python distributions that pip put there for the user or the machine, not the system's packages nor a virtual
    environment's (rosimpact itself often runs in one)."""
    from importlib import metadata

    if sys.prefix != sys.base_prefix:
        return {}
    found = {}
    for item in metadata.distributions():
        name, where = item.metadata["Name"], str(getattr(item, "_path", ""))
        if name and "dist-packages" not in where.split("/usr/lib", 1)[-1]:
            found[name] = item.version
    return dict(sorted(found.items()))
