"""What is known of the headers that packages include, as the rules on them ask for it."""

import posixpath
import re
from collections.abc import Iterator
from typing import NamedTuple

from ....edges.memory import kept_with
from ...model.misspelling import is_slip
from ...model.package import IncludeUse
from ...model.view import TargetView
from ...model.workspace import Package
from ...targets.availability import of_row
from ...targets.providers.library import versioned_folder
from ...targets.symbol import Availability, Symbol
from ...targets.target import ChangeInForce
from ..rule import Doubt, FixAction, doubts_of_place
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
        kinds = ("header-removed", "header-renamed", "header-moved")
        self._gone = {c.old: c for c in view.changes(*kinds) if c.state == "removed" and c.old}
        self._early = {c.new: c for c in view.changes(*kinds[1:]) if c.state == "absent" and c.new}
        self._quiet: set[str] = set()
        self._parameters = ParameterHeaders(view)

    def list_asked(self, package: Package) -> Iterator[tuple[IncludeUse, tuple[Doubt, ...]]]:
        """The includes of a package that the target compiles, with what speaks against an error there. Those of headers
        that the workspace provides are left out, and those that rules of their own report."""
        view = self._view
        for include in package.digest.includes:
            path = include.path
            if path in self._quiet or not view.active(include.conditions):
                continue
            if self._parameters.find_fault(include):
                continue
            if view.workspace.provides_header(path):
                self._quiet.add(path)
                continue
            if versioned_folder(view.target, path) is None:
                doubts = doubts_of_place(view, include.role, include.conditions)
                yield include, doubts if include.targets else (*doubts, Doubt.UNCOMPILED)

    def skip(self, path: str) -> None:
        """Leaves a header of which nothing is known to be wrong out from now on, unless a place may say otherwise."""
        known = path in self._gone or path in self._early or path in self._view.coming
        if not known and self._view.header(path):
            self._quiet.add(path)

    def find_loss(self, package: Package, include: IncludeUse) -> HeaderLoss | None:
        """What reviewed rows, stored releases and platforms tell of an included header; None where they have it, or
        never had."""
        view, path = self._view, include.path
        symbol = Symbol("header", path)
        if (change := self._find_row(path)) is not None:
            found = of_row(symbol, change)
            as_it_is = found.state == "removed" and change.kind != "header-removed"
            return HeaderLoss(found, fix=respell(view, package, include, found.replacement) if as_it_is else ())
        change, ahead = view.coming.get(path, (None, None))
        is_header_row = change is not None and change.kind.startswith("header")
        if change is not None and ahead is not None and is_header_row and view.active_on(ahead, include.conditions):
            fix = respell(view, package, include, change.new) if change.kind != "header-removed" else ()
            return HeaderLoss(of_row(symbol, change).on(ahead), fix=fix, ordered=True)
        found = view.header_availability(path)
        if found is not None and view.breaks_under(found, include.conditions):
            fix = () if found.state == "not yet" else respell(view, package, include, found.replacement)
            return HeaderLoss(found, fix=fix, ordered=True)
        found = view.lost_header(path)
        if found is None:
            return None
        if found.form == "platform" and view.unknown_contents.may_hold(package, path):
            return HeaderLoss(None)
        return HeaderLoss(found, found.form)

    def _find_row(self, path: str) -> ChangeInForce | None:
        """The reviewed row on a path that the target lacks."""
        view = self._view
        change = self._gone.get(path)
        if change is not None and not view.nested_header(change.package, path):
            return change
        change = self._early.get(path)
        if change is None or view.has_released_header(path.partition("/")[0], path):
            return None  # the package that it is called after has it
        return change if view.has_released_header(change.package, path) is False else None


@kept_with
def included_headers(view: TargetView) -> IncludedHeaders:
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
    answered = any(provider.sure or provider.name != package.name for provider in view.header(path))
    if answered or len(path.rpartition("/")[2]) < _SHORTEST:
        return None
    bare = "/" not in path
    for header in package.digest.headers:
        own = header.rpartition("/")[2] if bare else f"/{header}".rpartition("/include/")[2]
        if is_slip(path, own) or _ENDING.sub("", path).lower() == _ENDING.sub("", own).lower():
            return own
    generated = _OF_RECONFIGURE.match(path)
    if generated is None or not any(made.how == "reconfigure" for made in package.build.generated):
        return None
    known = view.is_package(generated["package"]) or generated["package"] in view.declared(package)
    return None if known else f"{package.name}/{path.rpartition('/')[2]}"


def _find_other_ending(package: Package, path: str, includer: str) -> str | None:
    """The path of the header that lies where a relative path leads, with another ending."""
    place = posixpath.normpath(posixpath.join(posixpath.dirname(includer), path))
    last = path.lstrip("./")
    if place in package.files or any(f"/{header}".endswith(f"/{last}") for header in package.digest.files):
        return None
    stem = _ENDING.sub("", place)
    for header in package.digest.headers:
        if header != place and _ENDING.sub("", header) == stem:
            return posixpath.join(posixpath.dirname(path), posixpath.basename(header))
    return None


def is_bridge(view: TargetView, package: Package) -> bool:
    """Whether a package is built for both generations of ROS, or with packages of ROS 1 that ros1_bridge finds, and
    therefore includes headers of both."""
    if view.target.ros != 2:
        return False
    bridged = "ros1_bridge" in view.declared(package)
    return bridged or any(include.path.startswith("ros/") for include in package.digest.includes)
