"""removed-symbol: a class, function, constant or macro that is used is gone on a target.

What it does
    Reports names that the known-changes table says the target's version of a package or library no longer has, in
    packages that declare or include that package or library; names of platform libraries that the newest distro no
    longer has; and C++ names that the stored versions of a released package tell to be gone, or not there yet, on the
    target: written with their scopes, members of objects whose type shows, inherited ones.

Why it breaks
    The compiler stops with "was not declared in this scope", or Python with an AttributeError or ImportError.

Severity
    error for unguarded names in code that is built or run, tests in Python that CMake runs and ROS 2's in C++ included;
    warning in other tests, under conditions of CMake that are not known, where the name stays and changed its meaning,
    and for the first name of each package or library that goes with an update, or on the newest distro's platform; note
    under other tests of the code itself, in examples, and for the rest of those.

Example
    cv::imread(path, CV_LOAD_IMAGE_ANYDEPTH)    // gone in OpenCV 4

Use instead
    cv::imread(path, cv::IMREAD_ANYDEPTH)       // there since OpenCV 3

Not reported
    Code that a version test excludes on the target, or a `try` whose except catches the missing name; names that a
    header which the file includes brings back (`cv_bridge` brings OpenCV's C constants); names that the package defines
    itself, or that another package of the target offers under the same spelling; members of objects whose type does not
    show.
"""

from collections.abc import Iterator
from functools import cached_property
from typing import Literal

from ...facts.condition import Condition
from ...model.package import NameUse, is_header
from ...targets.availability import convert_row
from ...targets.changes import find_removal_version, list_excuses
from ...targets.providers.library import include_roots
from ...targets.providers.stdlib import has_substitute
from ...targets.symbol import Symbol
from ...targets.target import ChangeInForce
from ...targets.version import parse
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rate_upcoming, rule
from .diagnosis import UPSTREAM, build_availability_texts, diagnose
from .reviewed_names import KINDS_OF_NAMES, ReviewedNames, is_contradicted
from .uses import list_cpp_uses

# What stands in a `try` whose except catches a missing name, or in that except, is for both versions.
_TRIED = frozenset({Condition("python", "try"), Condition("python", "try", True)})


@rule(
    scope="target",
    texts={
        **build_availability_texts(),
        "changed": Text(f"`{{subject}}` has changed in {UPSTREAM}", "[[use `{replacement}`]]"),
    },
)
def removed_symbol(view: TargetView):
    rows = ReviewedNames(view)
    seen = set()
    for package in view:
        for found in rate_upcoming(_list_reviewed(view, package, rows)):
            seen.add((found.at.path, found.at.line))
            yield found
    for package in view:
        yield from rate_upcoming(
            diagnose(use.found, use.at, use.name, package.name, use.doubts)
            for use in list_cpp_uses(view, package)
            if (use.found.is_missing or (use.found.state == "upcoming" and not use.found.form))
            and (use.at.path, use.at.line) not in seen
        )


def _list_reviewed(view: TargetView, package: Package, rows: ReviewedNames) -> Iterator[Diagnostic | Upcoming]:
    """What the tables of known changes tell."""
    headers = _Headers(view, package)
    for use in package.digest.names:
        if "::" in use.text and use.text in rows.own:
            continue  # the workspace defines it
        change = next((c for c in rows.find(use) if view.may_concern(package, c, use.at.path)), None)
        symbol = Symbol("python" if use.language == "python" else "c++", use.text)
        early = rows.find_early(use.text) if change is None and use.text not in rows.own else []
        if early and view.is_sure(use.conditions):
            change = next((c for c in early if view.may_concern(package, c, use.at.path)), None)
            if change is not None and use.role in ("build", "run"):
                yield diagnose(convert_row(symbol, change), use.at, use.text, package.name, (Doubt.AMBIGUOUS,))
            continue
        ahead = None
        if change is None and use.text in view.coming:
            change, ahead = view.coming[use.text]
        if (
            change is None
            or change.kind not in KINDS_OF_NAMES
            or (use.text != change.old and _is_replacement(use.text, change))
            or (use.language == "python" and _TRIED.intersection(use.conditions))
            or not view.applies(use.conditions)
            or not view.may_concern(package, change, use.at.path)
            or (ahead is not None and not view.is_active_on(ahead, use.conditions))
            or (ahead is None and is_contradicted(view, symbol, change))
        ):
            continue
        bringing = headers.bring_back(use.at.path, change) if list_excuses(change) else "no"
        if bringing == "yes":
            continue
        doubts = _list_doubts(view, package, use, change, rows)
        if not doubts and bringing == "maybe":
            doubts.append(Doubt.INCOMPLETE)
        found = convert_row(symbol, change)
        order = (parse(find_removal_version(change)), use.at.path, use.at.line, use.at.column)
        yield diagnose(
            found if ahead is None else found.apply_horizon(ahead), use.at, use.text, package.name, doubts, order=order
        )


def _is_replacement(text: str, change: ChangeInForce) -> bool:
    """Whether a name is what a row says to use instead: `cv::X` is found by the row of `X`."""
    return bool(change.new) and (text == change.new or text.endswith((f"::{change.new}", f".{change.new}")))


def _list_doubts(
    view: TargetView, package: Package, use: NameUse, change: ChangeInForce, rows: ReviewedNames
) -> list[Doubt]:
    role = "run" if use.language == "python" and _is_run(package, use) else use.role
    doubts = [*list_place_doubts(view, role, use.conditions)]
    if use.text in rows.own:
        doubts.append(Doubt.OWN)
    if view.is_included_under_conditions(package, change.package):
        doubts.append(Doubt.GUARDED)
    if use.language == "python" and role == "test":
        doubts.append(Doubt.TEST)
    if (use.language == "python" and has_substitute(use.text)) or change.kind == "api-changed":
        doubts.append(Doubt.INCOMPLETE)
    return doubts


def _is_run(package: Package, use: NameUse) -> bool:
    """Whether the package runs a Python file, as a program or as a test that CMake is told of."""
    if use.role != "test":
        return use.role in ("build", "run")
    return any(use.at.path in target.sources for target in package.build.targets if target.kind == "test")


_CMAKE_NAME = {"opencv": "OpenCV", "boost": "Boost", "pcl": "PCL"}


class _Headers:
    """What the files of a package include: some headers bring back a name which a library took out of its usual ones
    (`_c.h` for OpenCV's C constants)."""

    def __init__(self, view: TargetView, package: Package):
        self._view, self._package = view, package

    @cached_property
    def _included(self) -> dict[str, set[str]]:
        """What each file includes of others, with what the package's own headers do, since any of them may come
        before."""
        includes = self._package.digest.includes
        found: dict[str, set[str]] = {}
        found[""] = shared = {i.path for i in includes if is_header(i.at.path)}
        for include in includes:
            found.setdefault(include.at.path, set(shared)).add(include.path)
        return found

    def bring_back(self, file: str, change: ChangeInForce) -> Literal["yes", "maybe", "no"]:
        """Whether a file has a name in spite of a change, by what it includes."""
        paths = self._included.get(file, self._included[""])
        endings = list_excuses(change)
        if any(self._brings(change, endings, path) for path in paths):
            return "yes"
        return "maybe" if any(self._may_bring(change, path) for path in paths) else "no"

    def _brings(self, change: ChangeInForce, endings: tuple[str, ...], path: str) -> bool:
        """True for headers that bring the name back, and for those of other packages that include one of the library's
        that does, at whatever distance."""
        roots = include_roots(change.package)
        if path.endswith(endings) or not roots or path.startswith(roots):
            return path.endswith(endings)
        return any(h.startswith(roots) and h.endswith(endings) for h in self._view.machine.find_brought(path).headers)

    def _may_bring(self, change: ChangeInForce, path: str) -> bool:
        """True for headers of packages that depend on the changed library, and of nobody known."""
        view = self._view
        if path.startswith(include_roots(change.package) or "\0") or view.is_standard(path):
            return False
        providers = view.find_header(path)
        keys = {provider.name for provider in view.find_cmake(_CMAKE_NAME.get(change.package, change.package))}
        return not providers or any(
            p.kind == "ros" and not keys.isdisjoint(view.list_transitive((p.name,))) for p in providers
        )
