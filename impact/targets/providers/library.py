"""What is known of platform libraries beside their headers: which components are compiled and which are gone in which
version, what their CMake packages answer to, which C++ standard they need. The facts are in
`data/system_libraries.json`, each table with its source.
"""

import re
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from ..distro.conda import CHANNELS
from ..tables import find_table
from ..unpacked import read_table
from ..version import is_at_least, parse
from .components import find_missing_component
from .libraries import load_libraries

if TYPE_CHECKING:
    from ..distro.distro import DistroTarget


class _Boost(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Boost's libraries. compiled: that are linked against. brought: that come with another one. of_roscpp: in
    catkin_LIBRARIES wherever roscpp is found. headers: whose use needs a compiled library."""

    class HeaderPrefix(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
        """Headers by how their path begins. until: the version that needs none any more."""

        start: str
        component: str
        until: str = ""

    compiled_source: str
    compiled: str
    brought_source: str
    brought: dict[str, str]
    of_roscpp_source: str
    of_roscpp: str
    headers_source: str
    headers: list[HeaderPrefix]


class _Gone(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    package: str
    component: str
    library: str
    gone_in: str
    source: str
    help: str = ""


class _CMakePackage(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """library: its name in platform_versions.yaml; of others that is theirs in lower case, with `-`. same_major: its
    version file accepts only the same major version; others accept anything newer. variables: that find_package() sets,
    by how they begin, where their spelling is not the package's own."""

    library: str = ""
    same_major: bool = False
    variables: dict[str, str] = {}


class _Standard(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Headers that do not compile below a C++ standard, by the start of their path. distros: where every release of the
    package needs it, so that one built from source does too. sure: False where its targets ask CMake for it themselves.
    """

    prefix: str
    package: str
    since: str
    standard: int
    source: str
    library: bool = False
    sure: bool = True
    distros: frozenset[str] = frozenset()


class _Exact(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A package whose `x-config.cmake`, which answers to X in any case, became `xConfig.cmake`: that answers to `x`."""

    name: str
    library: str
    since: str
    source: str


class _Facts(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """opencv: functions by the library that they are compiled into, of those libraries that cv_bridge does not hand on
    since Kinetic (it does core, imgproc and imgcodecs). packages: by the name that find_package() takes. standards: the
    newest first. roots: how include paths begin, by the library's name in platform_versions.yaml. debian: the Debian
    packages whose version tells that of a library, the first that is installed."""

    boost: _Boost
    opencv_source: str
    opencv: dict[str, str]
    gone: list[_Gone]
    packages_source: str
    packages: dict[str, _CMakePackage]
    standards: list[_Standard]
    exact: list[_Exact]
    roots: dict[str, tuple[str, ...]]
    debian: dict[str, tuple[str, ...]]


_KNOWN = read_table(find_table("system_libraries.json"), _Facts)
_OTHER = _CMakePackage()
BOOST_COMPILED = frozenset(_KNOWN.boost.compiled.split())
BOOST_BROUGHT = {library: set(others.split()) for library, others in _KNOWN.boost.brought.items()}
BOOST_OF_ROSCPP = frozenset(_KNOWN.boost.of_roscpp.split())
OPENCV_FUNCTIONS = {f"cv::{name}": library for library, names in _KNOWN.opencv.items() for name in names.split()}
DEBIAN_PACKAGES = _KNOWN.debian


def find_compiled_component(header: str, version: str) -> str | None:
    """The compiled Boost library that code with this include needs to be linked to in a Boost version, None when it is
    headers alone or not known. version: empty where it is not known, which counts as the newest."""
    if not header.startswith("boost/"):
        return None
    for row in _KNOWN.boost.headers:
        if header.startswith(row.start):
            return None if row.until and (not version or is_at_least(version, row.until)) else row.component
    return None


class Gone(NamedTuple):
    """A component that a library's version lacks, and what to do."""

    version: str
    help: str


def find_gone_component(target: "DistroTarget", package: str, component: str) -> Gone | None:
    """What a target's version of a CMake package lacks of its components, None when it is there or not known."""
    for row in _KNOWN.gone:
        if row.package == package and row.component == component:
            version = target.find_library(row.library)
            if version and is_at_least(version, row.gone_in):
                return Gone(version, row.help)
    missing = find_missing_component(target, package, component)
    if missing is not None:
        return Gone(missing.version, f"did you mean `{missing.near}`?" if missing.near else "")
    # The configuration of Boost finds one for each component, `boost_json`.
    library = _KNOWN.packages.get(package, _OTHER).library
    found = load_libraries().find_configuration(library, f"{library}_{component}", target.platform, target.find_library)
    return (
        Gone(target.find_library(library) or found.version, "") if found is not None and found.here is False else None
    )


def knows_components(target: "DistroTarget", package: str) -> bool:
    """Whether it is known which components a target's version of a CMake package has."""
    return package in _KNOWN.packages and bool(target.find_library(_KNOWN.packages[package].library))


class VersionAnswer(NamedTuple):
    """Whether a version request holds, and the version that is there."""

    holds: bool
    version: str


def check_version(target: "DistroTarget", package: str, request: str, exact: bool) -> VersionAnswer | None:
    """Whether find_package(package request [EXACT]) holds by the platform's version; None when that is not known."""
    known = _KNOWN.packages.get(package, _OTHER)
    if not known.library and target.platform not in CHANNELS and target.find_version(package) is not None:
        return None  # a released package's own; conda's channels build libraries that the distro releases too
    versions = target.list_library_versions(name_library(package))
    if known.library == "python" and parse(request)[:1] != parse(versions[0] if versions else "")[:1]:
        return None  # Python 2 may be there beside it
    fitting = (version for version in versions if _accepts_version(version, request, exact, known.same_major))
    found = next(fitting, None)
    return VersionAnswer(found is not None, found or versions[0]) if versions else None


def name_library(package: str) -> str:
    """The platform library that find_package(package) looks for."""
    return _KNOWN.packages.get(package, _OTHER).library or package.lower().replace("_", "-")


def _accepts_version(version: str, request: str, exact: bool, same_major: bool) -> bool:
    """Whether a version file accepts a request."""
    low, _, high = request.partition("...")
    if exact:
        return parse(version)[: len(parse(low))] == parse(low)
    holds = is_at_least(version, low)
    if holds and high:
        bound = high.lstrip("<")
        included = not high.startswith("<") and parse(version)[: len(parse(bound))] == parse(bound)
        return included or not is_at_least(version, bound)
    return holds and not (same_major and parse(version)[:1] != parse(low)[:1])


class NeededStandard(NamedTuple):
    """A C++ standard that a header needs: 11, 14, 17 ...; of which package, which version; sure when all users do.

    version: empty where the package is not released on the target, and every release for its distro needs it.
    """

    standard: int
    package: str
    version: str
    sure: bool


def find_needed_standard(target: "DistroTarget", include: str) -> NeededStandard | None:
    """The C++ standard that an include path needs on a target, None when nothing is known."""
    for row in _KNOWN.standards:
        if include.startswith(row.prefix):
            version = target.find_library(row.package) if row.library else target.find_version(row.package)
            if is_at_least(version, row.since) if version else target.distro in row.distros:
                return NeededStandard(row.standard, row.package, version or "", row.sure)
    return None


def find_default_standard(target: "DistroTarget") -> int | None:
    """Year of the C++ standard that the target's compiler takes by default (1998, 2014, 2017), None when not known.

    Source: GCC's documentation of -std: gnu++98 before 6, gnu++14 from 6, gnu++17 from 11.
    """
    gcc = target.find_library("gcc")
    if not gcc:
        return None
    return 2017 if is_at_least(gcc, "11") else 2014 if is_at_least(gcc, "6") else 1998


def get_year(number: int) -> int:
    """The year of a C++ standard as flags and CMake write it: 98 and 3 come before 11."""
    return 1998 if number in (98, 3) else 2000 + number % 100


def find_misspelled_version(target: "DistroTarget", package: str) -> str:
    """The target's version of a library whose CMake package does not answer to this spelling of its name; empty where
    it does, or nothing is known."""
    for row in _KNOWN.exact:
        if package.lower() == row.name and package != row.name:
            version = target.find_library(row.library) or ""
            return version if version and is_at_least(version, row.since) else ""
    return ""


def list_variables(package: str) -> frozenset[str] | None:
    """Variables that find_package(package) sets, None where they are not known."""
    known = _KNOWN.packages.get(package, _OTHER).variables
    return frozenset(f"{stem}_{end}" for stem, ends in known.items() for end in ends.split()) if known else None


def sets_variables(package: str, stem: str) -> bool:
    """Whether find_package(package) sets variables that begin with a stem, as far as they are known."""
    names = list_variables(package)
    if names is None:
        return package.lower() == stem.lower()
    return any(n.startswith(f"{stem}_") and not n.endswith(("FOUND", "VERSION", "DIR")) for n in names)


# Folders in which Debian and Ubuntu put the headers of one version of a library beside those of others: the library and
# its version. Source: lists of files of Debian's packages libopencv-core-dev, libpcl-dev and libompl-dev.
# `opencv2/` is how all versions from 2 on are included.
_FOLDER = re.compile(r"(?:opencv(?P<opencv>[3-9])|pcl-(?P<pcl>\d+\.\d+)|ompl-(?P<ompl>\d+\.\d+))/")


class Folder(NamedTuple):
    """The folder of one version of a library in an include path. there: whether a target has that version. path: as
    the library's own headers and its documentation write it."""

    library: str
    version: str
    there: bool
    path: str


def find_versioned_folder(target: "DistroTarget", path: str) -> Folder | None:
    """The folder of a version in an include path; None where there is none, or the library's version is not known."""
    found = _FOLDER.match(path)
    if found is None or found.lastgroup is None:
        return None
    version = target.find_library(found.lastgroup)
    if not version:
        return None
    meant = parse(found[found.lastgroup])
    return Folder(found.lastgroup, version, parse(version)[: len(meant)] == meant, path[found.end() :])


def include_roots(name: str) -> tuple[str, ...]:
    """How include paths of a library or package begin, empty where that is not known."""
    return _KNOWN.roots.get(name, ())
