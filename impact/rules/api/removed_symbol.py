"""removed-symbol: a class, function, constant or macro that is used is gone on a target.

What it does
    Reports names that the known-changes table says the target's version of a package or library no longer has, in
    packages that declare or include that package or library; names of platform libraries that the newest distro no
    longer has; and C++ names that the stored versions of a released package tell to be gone, or not there yet, on the
    target: written with their scopes, members of objects whose type shows, inherited ones.

Why it breaks
    The compiler stops with "was not declared in this scope", or Python with an AttributeError or ImportError.

Severity
    error for unguarded names in code that is built or run, tests in Python that CMake runs and ROS 2's in C++
    included; warning in other tests, in Python files that nothing is known to install, under conditions of CMake that
    are not known, where the name stays and changed its meaning, and for the first name of each package or library
    that goes with an update, or on the newest distro's platform; note under other tests of the code itself, in
    examples, and for the rest of those.

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

from collections.abc import Iterable, Iterator

from ...facts.condition import Condition
from ...model.package import NameUse
from ...model.returned_names import ReturnedNames
from ...targets.changes import list_excuses
from ...targets.providers.stdlib import has_substitute
from ...targets.symbol import Availability
from ...targets.version import parse
from ..packages.install_rules import may_stay_behind
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rate_upcoming, rule
from .diagnosis import UPSTREAM, build_availability_texts, diagnose
from .reviewed_names import ReviewedNames
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
    headers = ReturnedNames(view, package)
    for use in package.linked.names:
        if "::" in use.text and use.text in rows.own:
            continue  # the workspace defines it
        kind = "python" if use.language == "python" else "c++"

        def choose(found: Iterable[Availability], use: NameUse = use) -> Availability | None:
            concerned = [row for row in found if view.may_concern(package, row.package, use.at.path, use.language)]
            if len(concerned) < 2:
                return next(iter(concerned), None)
            # Two libraries may have a name: Asio, and Boost under a shorter name of its namespace.
            scope = use.text.partition("::")[0]
            return min(
                concerned, key=lambda row: (not view.includes_library(package, row.package), row.package != scope)
            )

        row = choose(rows.find(use))
        early = rows.list_rows(kind, use.text, "not yet") if row is None and use.text not in rows.own else []
        if early and view.is_sure(use.conditions):
            row = choose(early)
            if row is not None and use.role in ("build", "run"):
                yield diagnose(row, use.at, use.text, package.name, (Doubt.AMBIGUOUS,))
            continue
        row = row or choose(one for one in view.find_reviewed(kind, use.text) if one.state == "upcoming")
        if (
            row is None
            or (use.text != row.symbol.name and _is_replacement(use.text, row.replacement))
            or (use.language == "python" and _TRIED.intersection(use.conditions))
            or not view.applies(use.conditions)
            or (row.horizon is not None and not view.is_active_on(row.horizon, use.conditions))
        ):
            continue
        excuses = list_excuses(row.package, row.symbol.name)
        bringing = headers.bring_back(use.at.path, row.package, excuses) if excuses else "no"
        if bringing == "yes":
            continue
        doubts = _list_doubts(view, package, use, row, rows)
        if not doubts and bringing == "maybe":
            doubts.append(Doubt.INCOMPLETE)
        order = (parse(row.since), use.at.path, use.at.line, use.at.column)
        yield diagnose(row, use.at, use.text, package.name, doubts, order=order)


def _is_replacement(text: str, new: str) -> bool:
    """Whether a name is what a row says to use instead: `cv::X` is found by the row of `X`."""
    return bool(new) and (text == new or text.endswith((f"::{new}", f".{new}")))


def _list_doubts(
    view: TargetView, package: Package, use: NameUse, row: Availability, rows: ReviewedNames
) -> list[Doubt]:
    role = "run" if use.language == "python" and _is_run(package, use) else use.role
    doubts = [*list_place_doubts(view, role, use.conditions)]
    if use.language == "python" and role == "run" and may_stay_behind(view, package, use.at.path):
        doubts.append(Doubt.LATE)
    if use.text in rows.own:
        doubts.append(Doubt.OWN)
    if view.is_included_under_conditions(package, row.package):
        doubts.append(Doubt.GUARDED)
    if use.language == "python" and role == "test":
        doubts.append(Doubt.TEST)
    if (use.language == "python" and has_substitute(use.text)) or row.form == "meaning":
        doubts.append(Doubt.INCOMPLETE)
    return doubts


def _is_run(package: Package, use: NameUse) -> bool:
    """Whether the package runs a Python file, as a program or as a test that CMake is told of."""
    if use.role != "test":
        return use.role in ("build", "run")
    return any(use.at.path in target.sources for target in package.build.targets if target.kind == "test")
