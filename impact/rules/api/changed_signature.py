"""changed-signature: a call or a type is written as the target's version of a library does not take it.

What it does
    Reports calls with arguments, template arguments, or in a form that the known-changes table says the target's
    version of a package or library takes no longer, or not yet; calls of C++ functions with so many arguments as no
    overload of the target's stored version takes and another version's does, or with arguments that show themselves to
    be of another type; methods that override none of their base's there and did, or do, in another version; what the
    C++ standard that the package is compiled with refuses or lacks; and what libraries of the newest distro take no
    longer.

Why it breaks
    The compiler finds no matching function, or Python raises a TypeError or an AttributeError: the name is there, but
    not with these arguments.

Severity
    error for code that is built or run, tests of ROS 2 included; warning in tests of ROS 1 and in Python's, under CMake
    conditions that are not known, and for the first call of a library, in tests too, that only the newest distro
    refuses, where that is at most two long-term distros ahead; note in examples, under an `#if` that is not known, and
    for the rest. A method that no longer overrides, and does not say `override`, compiles: warning.

Example
    auto timeout = rclcpp::Duration(0.5);       // Humble's Duration takes no floating point number

Use instead
    auto timeout = rclcpp::Duration::from_seconds(0.5);

Not reported
    Code that a version test excludes on the target; packages that do not depend on the library; what is passed in
    variables whose type does not show in the file.
"""

from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.package import CppApiUse, NameUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.evidence import evidence_of, of_offered
from ...targets.providers.library import default_standard, standard_year
from ...targets.surface.offers_cpp import Judged
from ...targets.target import Change
from ...targets.uses import function_of, standards_of
from ...targets.version import at_least
from ..rule import Hit, rule
from .cpp_api import line_of, severity_of, uses_judged, when

# What every C++ file is compiled with, whatever its package declares.
_COMPILER = frozenset({"gcc", "glibc", "linux-headers"})


@rule(severity="error")
def changed_signature(view: View):
    told = set()
    for hit in _reviewed(view):
        told.add(line_of(hit))
        yield hit
    for package in view:
        for use, found in uses_judged(view, package):
            if found.kind not in ("arguments", "types", "override") or (use.at.path, use.at.line) in told:
                continue
            severity = severity_of(view, use, found)
            if found.kind == "override" and severity == "error" and "override" not in use.given:
                severity = "warning"  # it compiles, and nobody calls it
            yield Hit(
                use.at,
                use.name,
                f"{_what(use, found)} in {found.offered.package} {found.offered.version}",
                f"use `{found.offered.instead}`" if found.offered.instead else when(found),
                package.name,
                severity=severity,
                evidence=of_offered(found.offered),
            )


def _what(use: CppApiUse, found: Judged) -> str:
    """What is wrong with a use, as a clause without its place."""
    time = "no longer" if found.earlier else "not yet"
    if found.kind == "override":
        return f"this {time} overrides `{use.name}`" if found.earlier else f"this does not yet override `{use.name}`"
    if found.kind == "types":
        return f"`{use.name}` {'no longer takes' if found.earlier else 'does not yet take'} such arguments"
    many = "one argument" if use.arguments == 1 else f"{use.arguments or 'no'} arguments"
    return f"`{use.name}` {'no longer takes' if found.earlier else 'does not yet take'} {many}"


def _reviewed(view: View) -> Iterator[Hit]:
    """What the tables of known changes tell."""
    # What the workspace itself brings is as it brings it, whatever a release did.
    refused = {c.old: c for c in view.changes("call-changed") if c.package not in view.workspace.packages}
    coming = {label: c for label, c in view.later.items() if c.kind == "call-changed" and c.package not in _COMPILER}
    if not refused and not coming:
        return
    for package in view:
        # A method that the package or what it is built with declares may be meant wherever its name is called.
        within = [view.workspace.packages[name] for name in view.closure(package) if name in view.workspace.packages]
        own = {function for each in within for function in each.digest.functions}
        soon: list[tuple[NameUse, Change, bool]] = []
        for use in package.digest.uses:
            if function_of(use.text) in own:
                continue
            change = refused.get(use.text)
            later = None if change is not None else coming.get(use.text)
            change = change or later
            if (
                change is None
                or not view.active(use.conditions)
                or not (change.package in _COMPILER or view.concerned(package, change, use.at.path))
                or (later is not None and not view.later_active(use.conditions))
            ):
                continue
            where = _under_standard(view, package, use, change)
            if where is None:
                continue
            shown = use.shown or use.text
            certain = use.language == "cpp" and view.certain(use.conditions)
            if later is not None:
                soon.append((use, later, view.horizon_is_near and certain and use.role != "aside"))
                continue
            when = "is no longer" if change.state == "removed" else "is not yet"
            yield Hit(
                use.at,
                shown,
                f"`{shown}` {when} taken by {change.package} {change.version}{where}",
                change.new,
                package.name,
                severity=_how_bad(view, use, certain),
                evidence=evidence_of(change),
            )
        yield from _what_is_coming(view, package, soon)


def _what_is_coming(view: View, package: Package, soon: list[tuple[NameUse, Change, bool]]) -> Iterator[Hit]:
    """Of each library the first place loudly, the rest as notes."""
    first: dict[str, At] = {}
    for use, later, loud in soon:
        if loud:
            first[later.package] = min(first.get(later.package, use.at), use.at, key=_place)
    for use, later, loud in soon:
        shown = use.shown or use.text
        yield Hit(
            use.at,
            shown,
            f"`{shown}` is taken, and no longer by {later.package} {later.version} of {view.horizon}",
            later.new,
            package.name,
            severity="warning" if loud and first[later.package] == use.at else "note",
            evidence=evidence_of(later, ahead=True),
        )


def _place(at: At) -> tuple[str, int, int]:
    return at.path, at.line, at.column


def _how_bad(view: View, use: NameUse, certain: bool) -> str:
    if use.role == "aside" or (not certain and any(c.language in ("cpp", "macro") for c in use.conditions)):
        return "note"  # an #if around it most likely tells the versions apart
    return "error" if certain and view.built(use.role) else "warning"


def _raised_to(view: View) -> int:
    """The standard that CMake raises a package's to, since the exported targets of rclcpp and others ask for it. Rclcpp
    does since 9.0 (its CMakeLists.txt); of others before, none is known to ask for more than C++14."""
    if view.target.ros == 1:
        return 0
    if not at_least(view.target.version("rclcpp") or "9.0", "9.0"):
        return 2014
    return 2020 if at_least(view.target.library("gcc") or "", "15") else 2017


def _under_standard(view: View, package: Package, use: NameUse, change: Change) -> str | None:
    """How a message names the C++ standard that a use fails under (empty: under any); None where it does not fail."""
    refused_from, needs = standards_of(change.old)
    if not refused_from and not needs:
        return ""
    build = package.build
    default = default_standard(view.target)
    own = [t.standard for t in build.targets if t.name in use.targets and t.standard]
    fixed = view.standard(package)
    set_for = ([fixed[0]] if fixed else []) + own
    have = max((standard_year(number) for number in set_for), default=default)
    if have is None:
        return None
    if not set_for and any(u.kind == "command" for u in build.uses):
        return None  # a macro of another package may set it
    if refused_from:
        return f" in C++{have % 100:02d}" if have >= refused_from else None
    if max(have, _raised_to(view)) >= needs or not use.targets or use.role != "build":
        return None
    if not view.certain(use.conditions):
        return None
    return f" in C++{have % 100:02d}"
