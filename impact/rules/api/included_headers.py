"""What is known of the headers that packages include, as the rules on them ask for it."""

import posixpath
import re
from collections.abc import Iterator
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...model.cmake.interpreter import calls_unmodelled
from ...model.misspelling import is_slip
from ...model.package import IncludeUse
from ...targets.providers.library import find_versioned_folder
from ...targets.symbol import Availability
from ..vocabulary import Doubt, FixAction, Package, TargetView, list_place_doubts
from .moved_header import respell
from .parameter_header import ParameterHeaders


class HeaderLoss(NamedTuple):
    """What the first source that knows of a header tells of it. found: how the target stands to it; None where it
    cannot be told. kind: of the text, where the state of that does not say it. ordered: places in sources go before
    those in headers."""

    found: Availability | None
    kind: str = ""
    fix: tuple[FixAction, ...] = ()
    ordered: bool = False


class IncludedHeaders:
    """Headers of others that a workspace includes, on one target."""

    def __init__(self, view: TargetView):
        self._view = view
        self._quiet: set[str] = set()
        self._parameters = ParameterHeaders(view)

    def list_asked(self, package: Package) -> Iterator[tuple[IncludeUse, tuple[Doubt, ...]]]:
        """The includes of a package that the target compiles, with what speaks against an error there. Those of headers
        that the workspace provides are left out, and those that rules of their own report; of a package that is made
        for both generations of ROS also those of files for the other one, unless they are surely compiled here."""
        view = self._view
        foreign = _list_files_of_other_generation(view, package)
        for include in package.linked.includes:
            path = include.path
            if path in self._quiet or not view.applies(include.conditions):
                continue
            if self._parameters.find_fault(package, include):
                continue
            if view.workspace.provides_header(path):
                self._quiet.add(path)
                continue
            if find_versioned_folder(view.target, path) is None:
                doubts = self._collect_doubts(package, include)
                if not doubts or include.at.path not in foreign:
                    yield include, doubts

    def _collect_doubts(self, package: Package, include: IncludeUse) -> tuple[Doubt, ...]:
        doubts = list_place_doubts(self._view, include.role, include.conditions)
        if not include.targets:
            return (*doubts, Doubt.UNCOMPILED)
        compiling = (target for target in package.build.targets if target.name in include.targets)
        return doubts if any(self._view.is_sure(t.conditions) for t in compiling) else (*doubts, Doubt.CONDITIONAL)

    def skip(self, path: str) -> None:
        """Leaves a header of which nothing is known to be wrong out from now on, unless a place may say otherwise."""
        known = any(row.state != "deprecated" for row in self._view.find_reviewed("header", path))
        if not known and is_answered(self._view, path):
            self._quiet.add(path)

    def find_loss(self, package: Package, include: IncludeUse) -> HeaderLoss | None:
        """What reviewed rows, stored releases and platforms tell of an included header; None where they have it, or
        never had."""
        view, path = self._view, include.path
        rows = {row.state: row for row in view.find_reviewed("header", path)}
        row = self._find_row(rows) or rows.get("upcoming")
        if row is not None and (row.horizon is None or view.is_active_on(row.horizon, include.conditions)):
            as_it_is = row.form == "renamed" and row.state != "not yet"
            fix = respell(view, package, include, row.replacement) if as_it_is else ()
            return HeaderLoss(row, fix=fix, ordered=row.state == "upcoming")
        found = view.find_header_availability(path, include.conditions)
        if found is not None and (found.is_missing or found.state == "upcoming"):
            fix = () if found.state == "not yet" else respell(view, package, include, found.replacement)
            return HeaderLoss(found, fix=fix, ordered=True)
        found = view.find_lost_header(path)
        if found is None:
            return None
        if found.form == "platform" and view.unknown_contents.may_hold(package, path):
            return HeaderLoss(None)
        return HeaderLoss(found, found.form)

    def _find_row(self, rows: dict[str, Availability]) -> Availability | None:
        """The reviewed row on a path that the target lacks. rows: all on that path, by their state."""
        view = self._view
        row = rows.get("removed")
        if row is not None and row.package in view.workspace.unread_names:
            return None
        if row is not None and not view.has_nested_header(row.package, row.symbol.name):
            return row
        row = rows.get("not yet")
        path = row.symbol.name if row is not None else ""
        if row is None or row.form != "renamed" or view.has_released_header(path.partition("/")[0], path):
            return None  # the package that it is called after has it
        return row if view.has_released_header(row.package, path) is False else None


# What the C++ files of a generation of ROS include.
_CLIENT_LIBRARIES = {1: "ros/", 2: "rclcpp/"}


def _list_files_of_other_generation(view: TargetView, package: Package) -> frozenset[str]:
    """The C++ files of a package for both generations that are for the one which the target is not of."""
    own, other = (_CLIENT_LIBRARIES[ros] for ros in (view.target.ros, 3 - view.target.ros))
    including = {
        client: frozenset(i.at.path for i in package.linked.includes if i.path.startswith(client))
        for client in (own, other)
    }
    return including[other] - including[own] if including[own] else frozenset()


@cache_in_derived
def get_included_headers(view: TargetView) -> IncludedHeaders:
    """Those of a view, made once."""
    return IncludedHeaders(view)


# Letters of a file's name: shorter ones are alike by chance.
_SHORTEST = 8
_ENDING = re.compile(r"\.(?:h|hh|hpp|hxx)\Z")
_OF_RECONFIGURE = re.compile(r"(?P<package>\w+)/\w+Config\.h\Z")


def find_misspelt(view: TargetView, package: Package, path: str, includer: str = "") -> str | None:
    """The header of the package that an include path means: it misses it by one letter, by case or ending, or names a
    generated one below what is no package. includer: the file that a path such as `../a.h` starts at. None where
    somebody has what it names."""
    if path.startswith("."):
        return _find_other_ending(package, path, includer)
    answered = any(provider.sure or provider.name != package.name for provider in view.find_header(path))
    if answered or len(path.rpartition("/")[2]) < _SHORTEST:
        return None
    bare = "/" not in path
    for header in package.linked.headers:
        own = header.rpartition("/")[2] if bare else f"/{header}".rpartition("/include/")[2]
        if is_slip(path, own) or _ENDING.sub("", path).lower() == _ENDING.sub("", own).lower():
            return own
    generated = _OF_RECONFIGURE.match(path)
    if generated is None or not any(made.how == "reconfigure" for made in package.build.generated):
        return None
    known = view.is_package(generated["package"]) or generated["package"] in view.collect_declared(package)
    return None if known else f"{package.name}/{path.rpartition('/')[2]}"


def is_answered(view: TargetView, path: str) -> bool:
    """Whether somebody may have a header; a package of the workspace has no more than is known of it."""
    return any(p.sure or p.name not in view.workspace.packages for p in view.find_header(path))


def is_nowhere(view: TargetView, package: Package, include: IncludeUse) -> bool:
    """Whether an include names what no file of the workspace is called, no build here makes and nobody is known to
    have."""
    path, build = include.path, package.build
    if not include.targets or not view.is_sure(include.conditions) or build.unresolved:
        return False
    if is_answered(view, path):
        return False
    name = path.rpartition("/")[2]
    if not re.fullmatch(r"[\w./+-]+\.(?:h|hh|hpp|hxx|H)", path) or name in _list_file_names(view):
        return False
    if calls_unmodelled(build) or any(made.rstrip("/").endswith(name) or made.endswith("/") for made in build.made):
        return False
    if any(t.kind in ("custom", "external", "fetched", "unknown") for t in build.targets) or view.workspace.unread:
        return False
    searched = (*(item for item, _ in build.include_dirs), *(link.item for link in build.target_links))
    if any(item.startswith(("/", "~", "$ENV{")) for item in searched):
        return False  # a folder of the machine
    if view.unknown_contents.may_hold(package, path.lstrip("./")):
        return False
    return path.startswith(".") or all(_has_known_headers(view, one) for one in _list_direct(view, package))


def _list_direct(view: TargetView, package: Package) -> set[str]:
    """What a package declares and finds itself."""
    passed = {one.item for target in package.build.targets for one in target.links if one.how == "ament"}
    return {*view.collect_declared(package), *(one.name for one in package.build.found), *passed}


def _has_known_headers(view: TargetView, name: str) -> bool:
    """Whether all headers of what has a name are known: a package of the workspace or a released one that a surface is
    stored of, a library of the platform."""
    if (own := view.workspace.packages.get(name)) is not None:
        made = own.build.unresolved or any(t.kind in ("external", "fetched") for t in own.build.targets)
        return not (made or name.endswith("_vendor"))
    if name in view.preinstalled or name.startswith("python"):
        return True
    if view.is_package(name):
        return view.offers.find_package(name) is not None and not view.unknown_contents.is_carried_library(name)
    keys = (name, *view.list_debs(name), *(p.package or p.name for p in view.find_cmake(name)))
    return view.providers.knows_system(keys)


@cache_in_derived
def _list_file_names(view: TargetView) -> frozenset[str]:
    """The names of all files of the workspace."""
    files = (path for package in view.workspace for path in package.linked.files)
    return frozenset(path.rpartition("/")[2] for path in files)


def _find_other_ending(package: Package, path: str, includer: str) -> str | None:
    """The path of the header that lies where a relative path leads, with another ending."""
    place = posixpath.normpath(posixpath.join(posixpath.dirname(includer), path))
    last = path.lstrip("./")
    if place in package.files or any(f"/{header}".endswith(f"/{last}") for header in package.linked.files):
        return None
    stem = _ENDING.sub("", place)
    for header in package.linked.headers:
        if header != place and _ENDING.sub("", header) == stem:
            return posixpath.join(posixpath.dirname(path), posixpath.basename(header))
    return None


def is_bridge(view: TargetView, package: Package) -> bool:
    """Whether a package is built for both generations of ROS, or with packages of ROS 1 that ros1_bridge finds, and
    therefore includes headers of both."""
    if view.target.ros != 2:
        return False
    bridged = "ros1_bridge" in view.collect_declared(package)
    return bridged or any(include.path.startswith("ros/") for include in package.linked.includes)
