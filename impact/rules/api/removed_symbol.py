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
    warning in other tests, under conditions that are not known, where the name stays and changed its meaning, and for
    the first name of a library that only the newest distro lacks; note in examples and for the rest of those.

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
from ...targets.changes import excuses, removed_in
from ...targets.evidence import evidence_of, of_offered
from ...targets.providers.library import include_roots
from ...targets.providers.stdlib import stood_in_for
from ...targets.target import Change
from ...targets.version import parts
from ..rule import Hit, rule
from .cpp_api import line_of, severity_of, uses_judged, when

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
            state = "is gone" if found.kind == "removed" else "is not there yet"
            yield Hit(
                use.at,
                use.name,
                f"`{use.name}` {state} in {offered.package} {offered.version}",
                f"use `{offered.instead}`" if offered.instead else when(found),
                package.name,
                severity=severity_of(view, use, found),
                evidence=of_offered(offered),
            )


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
        coming: list[tuple[NameUse, Change, bool]] = []
        for use in package.digest.names:
            named = (python if use.language == "python" else cpp).get(use.text, ())
            if not named and use.language == "cpp" and use.text.count("::") == 1 and use.text.startswith(_ROOTS):
                named = cpp.get(use.text.rsplit("::", 1)[-1], ())
            change = next((c for c in named if view.concerned(package, c, use.at.path)), None)
            later = None
            if change is None and use.text in early and use.text not in own and view.certain(use.conditions):
                change = next((c for c in early[use.text] if view.concerned(package, c, use.at.path)), None)
                if change is not None and use.role in ("build", "run"):
                    yield Hit(
                        use.at,
                        use.text,
                        f"`{use.text}` is not there yet in {change.package} {change.version}".strip(),
                        f"use `{change.old}`" if change.old else "",
                        package.name,
                        severity="warning",
                        evidence=evidence_of(change),
                    )
                continue
            if change is None:
                change = later = view.later.get(use.text)
                if later is not None and later.kind.startswith("header"):
                    continue
            if (
                change is None
                or (change.new and use.text.endswith(change.new))
                or (use.language == "python" and _TRIED.intersection(use.conditions))
                or not view.active(use.conditions)
                or not view.concerned(package, change, use.at.path)
            ):
                continue
            endings = excuses(change)
            if endings:
                if included is None:
                    included = _by_file(package)
                if any(_brings_back(view, change, endings, path) for path in included.get(use.at.path, included[""])):
                    continue
            guarded = use.role == "aside" or use.text in own or not view.certain(use.conditions)
            built = view.built(use.role) if use.language == "cpp" else _is_run(package, use)
            brought_back = use.language == "python" and stood_in_for(use.text)
            sure = built and not brought_back and not guarded and change.kind != "api-changed"
            if endings and sure and included is not None:
                # It only moved to another header, which the headers of whatever uses the library may include.
                sure = not any(_may_bring(view, change, path) for path in included.get(use.at.path, included[""]))
            if later is not None and not view.later_active(use.conditions):
                continue
            if later is not None:
                loud = (
                    use.language == "cpp"
                    and use.role == "build"
                    and view.certain(use.conditions)
                    and later.kind != "api-changed"
                    and later.package != "python"
                )
                coming.append((use, later, loud))
                continue
            verb = "changed" if change.kind == "api-changed" else "is gone"
            yield Hit(
                use.at,
                use.text,
                f"`{use.text}` {verb} in {change.package} {change.version}".strip(),
                f"use `{change.new}`" + (f", there since {change.since}" if change.since else "") if change.new else "",
                package.name,
                severity="error" if sure else "note" if guarded else "warning",
                evidence=evidence_of(change),
            )
        yield from _what_is_coming(view, package.name, coming)


def _is_run(package: Package, use: NameUse) -> bool:
    """Whether the package runs a Python file, as a program or as a test that CMake is told of."""
    if use.role != "test":
        return use.role in ("build", "run")
    return any(use.at.path in target.sources for target in package.build.targets if target.kind == "test")


def _what_is_coming(view: View, package: str, coming: list[tuple[NameUse, Change, bool]]) -> Iterator[Hit]:
    """Enough to see it: of each library the first place of what breaks first loudly, the rest as notes."""
    first: dict[str, tuple] = {}
    for use, later, loud in coming:
        rank = (parts(removed_in(later)), use.at.path, use.at.line, use.at.column)
        if loud and (later.package not in first or rank < first[later.package]):
            first[later.package] = rank
    for use, later, loud in coming:
        rank = (parts(removed_in(later)), use.at.path, use.at.line, use.at.column)
        yield Hit(
            use.at,
            use.text,
            f"`{use.text}` is there, and gone in {later.package} {later.version} of {view.horizon}",
            f"use `{later.new}`" if later.new else "",
            package,
            severity="warning" if loud and first.get(later.package) == rank else "note",
            evidence=evidence_of(later, ahead=True),
        )


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
