"""removed-symbol: a class, function, constant or macro that is used is gone on a target.

What it does
    Reports names that the known-changes table says the target's version of a package or library no longer has, in
    packages that declare or include that package or library; names of platform libraries that the newest distro no
    longer has; and C++ names that the stored versions of a released package tell to be gone, or not there yet, on the
    target: written with their scopes, members of objects whose type shows, inherited ones.

Why it breaks
    The compiler stops with "was not declared in this scope", or Python with an AttributeError or ImportError.

Severity
    error for unguarded names in code that is built or run, tests in Python that CMake runs and ROS 2's in C++ included,
    and for what goes with the next sync; warning in other tests, under conditions of CMake that are not known, where
    the name stays and changed its meaning, and for the first name of each package or library that goes with a later
    update, or on the newest distro's platform; note under other tests of the code itself, in examples, and for the rest
    of those.

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

from ...facts.condition import Condition
from ...model.package import NameUse, is_header
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import Horizon, Symbol
from ...targets.changes import excuses, removed_in
from ...targets.evidence import evidence_of, of_offered
from ...targets.providers.library import include_roots
from ...targets.providers.stdlib import stood_in_for
from ...targets.target import Change
from ...targets.version import parts
from ..rule import Hit, rule
from ..severity import Doubt, doubts_of_place, severity
from .cpp_api import doubts_of, line_of, uses_coming, uses_judged, when
from .upcoming import Upcoming, rated

_KINDS = ("api-removed", "api-renamed", "api-changed", "python-removed", "python-api")


# What stands in a `try` whose except catches a missing name, or in that except, is for both versions.
_TRIED = frozenset({Condition("python", "try"), Condition("python", "try", True)})
# Namespaces of libraries whose names are in the table without them.
_ROOTS = ("cv::", "boost::", "pcl::", "YAML::", "gazebo::", "rclcpp::", "ros::")


@rule(severity="error")
def removed_symbol(view: View):
    told = set()
    for hit in _reviewed(view):
        told.add(line_of(hit))
        yield hit
    for package in view:
        for use, found in uses_judged(view, package):
            if found.kind not in ("removed", "absent") or (use.at.path, use.at.line) in told:
                continue
            offered = found.offered
            since = f"{'removed' if found.kind == 'removed' else 'added'} in {offered.first}" if offered.first else ""
            yield Hit(
                use.at,
                use.name,
                f"`{use.name}` is not available in {offered.package} {offered.version}{f' ({since})' if since else ''}",
                f"use `{offered.instead}`" if offered.instead else when(found),
                package.name,
                severity=severity(*doubts_of(view, use, found)),
                evidence=of_offered(offered),
            )
        yield from rated(
            Upcoming(_will_go(use.at, use.name, found.offered.package, found.offered.version, ahead,
                              found.offered.instead, package.name, of_offered(found.offered)),
                     found.offered.package, ahead, doubts_of(view, use, found),
                     (use.at.path, use.at.line, use.at.column))
            for use, found, ahead in uses_coming(view, package)
            if found.kind == "removed" and (use.at.path, use.at.line) not in told
        )  # fmt: skip


def _will_go(at, name, package, version, ahead: Horizon, instead, owner, evidence) -> Hit:
    message = f"`{name}` will be removed: not in {package} {version} ({ahead.name})"
    return Hit(at, name, message, f"use `{instead}`" if instead else "", owner, evidence=evidence)


def _reviewed(view: View) -> Iterator[Hit]:
    """What the tables of known changes tell."""
    cpp: dict[str, list[Change]] = {}
    python: dict[str, list[Change]] = {}
    for change in view.changes(*_KINDS):
        # What the workspace itself brings is as it brings it, whatever a release did.
        if change.state == "removed" and change.old and change.package not in view.workspace.packages:
            (python if change.kind.startswith("python") else cpp).setdefault(change.old, []).append(change)
    early: dict[str, list[Change]] = {}
    for change in view.changes(*_KINDS):
        if change.state == "absent" and change.new and change.package not in view.workspace.packages:
            early.setdefault(change.new, []).append(change)
    # A method that a header of the workspace has may be meant wherever its name stands.
    own = {
        use.text
        for package in view.workspace
        for use in package.digest.names
        if use.language == "cpp" and is_header(use.at.path) and "::" not in use.text and not use.text.isupper()
    }
    own.update(name for package in view.workspace for name in package.digest.defined)
    for package in view:
        included = None
        coming: list[Upcoming] = []
        for use in package.digest.names:
            if "::" in use.text and use.text in own:
                continue  # the workspace defines it
            named = (python if use.language == "python" else cpp).get(use.text, ())
            if not named and use.language == "cpp" and use.text.count("::") == 1 and use.text.startswith(_ROOTS):
                named = cpp.get(use.text.rsplit("::", 1)[-1], ())
            change = next((c for c in named if view.concerned(package, c, use.at.path)), None)
            ahead = None
            if change is None and use.text in early and use.text not in own and view.certain(use.conditions):
                change = next((c for c in early[use.text] if view.concerned(package, c, use.at.path)), None)
                if change is not None and use.role in ("build", "run"):
                    yield Hit(
                        use.at,
                        use.text,
                        f"`{use.text}` is not available in {change.package} {change.version}".strip()
                        + (f" (added in {change.since})" if change.since else ""),
                        f"use `{change.old}`" if change.old else "",
                        package.name,
                        severity=severity(Doubt.AMBIGUOUS),
                        evidence=evidence_of(change),
                    )
                continue
            if change is None:
                change, ahead = view.coming.get(use.text, (None, None))
                if change is not None and change.kind not in _KINDS:
                    continue
            if (
                change is None
                or (change.new and use.text.endswith(change.new))
                or (use.language == "python" and _TRIED.intersection(use.conditions))
                or not view.active(use.conditions)
                or not view.concerned(package, change, use.at.path)
                or (ahead is None and _is_there(view, use, change))
            ):
                continue
            endings = excuses(change)
            if endings:
                if included is None:
                    included = _by_file(package)
                if any(_brings_back(view, change, endings, path) for path in included.get(use.at.path, included[""])):
                    continue
            role = "run" if use.language == "python" and _is_run(package, use) else use.role
            doubts = [*doubts_of_place(view, role, use.conditions)]
            if use.text in own:
                doubts.append(Doubt.OWN)
            if use.language == "python" and role == "test":
                doubts.append(Doubt.TEST)
            if (use.language == "python" and stood_in_for(use.text)) or change.kind == "api-changed":
                doubts.append(Doubt.INCOMPLETE)
            # It only moved to another header, which the headers of whatever uses the library may include.
            paths = included.get(use.at.path, included[""]) if endings and included is not None else ()
            if not doubts and any(_may_bring(view, change, path) for path in paths):
                doubts.append(Doubt.INCOMPLETE)
            if ahead is not None:
                if view.active_on(ahead, use.conditions):
                    hit = _will_go(use.at, use.text, change.package, change.version, ahead, change.new, package.name,
                                   evidence_of(change))  # fmt: skip
                    order = (parts(removed_in(change)), use.at.path, use.at.line, use.at.column)
                    coming.append(Upcoming(hit, change.package, ahead, tuple(doubts), order))
                continue
            changed = change.kind == "api-changed"
            where = f"{change.package} {change.version}".strip()
            since = f" (removed in {bound})" if (bound := removed_in(change)) and not changed else ""
            available = f", available since {change.since}" if change.since else ""
            yield Hit(
                use.at,
                use.text,
                f"`{use.text}` {'has changed' if changed else 'is not available'} in {where}{since}",
                f"use `{change.new}`{available}" if change.new else "",
                package.name,
                severity=severity(*doubts),
                evidence=evidence_of(change),
            )
        yield from rated(coming)


def _is_there(view: View, use: NameUse, change: Change) -> bool:
    """Whether what is stored of the very release contradicts a reviewed row."""
    if change.library or change.kind == "api-changed":
        return False
    kind = "python" if use.language == "python" else "c++"
    return view.availability(Symbol(kind, change.old, (change.package,))).state in ("present", "deprecated")


def _is_run(package: Package, use: NameUse) -> bool:
    """Whether the package runs a Python file, as a program or as a test that CMake is told of."""
    if use.role != "test":
        return use.role in ("build", "run")
    return any(use.at.path in target.sources for target in package.build.targets if target.kind == "test")


_CMAKE_NAME = {"opencv": "OpenCV", "boost": "Boost", "pcl": "PCL"}


def _may_bring(view: View, change: Change, path: str) -> bool:
    """True for headers of packages that depend on the changed library, and of nobody known."""
    if path.startswith(include_roots(change.package) or "\0") or view.is_standard(path):
        return False
    providers = view.header(path)
    keys = {provider.name for provider in view.cmake(_CMAKE_NAME.get(change.package, change.package))}
    return not providers or any(p.kind == "ros" and not keys.isdisjoint(view.spread((p.name,))) for p in providers)


def _brings_back(view: View, change: Change, endings: tuple[str, ...], path: str) -> bool:
    """True for headers that bring the name back, and for those of other packages that include one of the library's that
    does, at whatever distance."""
    roots = include_roots(change.package)
    if path.endswith(endings) or not roots or path.startswith(roots):
        return path.endswith(endings)
    return any(h.startswith(roots) and h.endswith(endings) for h in view.machine.brought(path).headers)


def _by_file(package) -> dict[str, set[str]]:
    """What each file includes of others, with what the package's own headers do, since any of them may come before."""
    found: dict[str, set[str]] = {}
    found[""] = shared = {i.path for i in package.digest.includes if is_header(i.at.path)}
    for include in package.digest.includes:
        found.setdefault(include.at.path, set(shared)).add(include.path)
    return found
