"""removed-header: an included header is not available on a target.

What it does
    Reports `#include` lines whose header the target's version of the providing package does not install: removed,
    renamed, or only added in a later version; headers of platform libraries that the newest distro no longer has;
    generated headers whose interface the version lacks, no version has, or another package of the workspace has; own
    headers with a letter wrong; and spellings of generated headers that belong to the other ROS generation, or to C
    where rclcpp is used.

Why it breaks
    The compiler stops with "No such file or directory" on that developer's machine and nowhere else.

Severity
    error for compiled code that is not guarded, tests of ROS 2 included, and for what goes with the next sync (which
    the build farm builds against already), and for an installed header that includes what nobody has, so that nobody
    can compile it; warning for tests of ROS 1, under CMake conditions that are not known, for the first include of each
    header that goes with a later update or on the newest distro's platform, and for headers of C where nothing else
    brings the C++ types; note for its other includes, for examples, for installed headers that the package does not
    compile itself, and under other tests of the code itself.

Example
    #include <tf2_geometry_msgs/tf2_geometry_msgs.h>     // gone from tf2_geometry_msgs 0.36

Use instead
    #include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>   // there since 0.25

Not reported
    Includes under `#if __has_include(...)` or a version test that excludes the target; headers of the workspace itself;
    headers that no known package has, where something that the package depends on has unknown contents;
    ROS 1 names in a package that also includes ROS 1 headers, as bridges do.
"""

from collections.abc import Iterator

from ...model.misspelling import is_slip
from ...model.package import IncludeUse, is_header
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import of_row
from ...targets.providers.library import versioned_folder
from ...targets.symbol import Symbol
from ...targets.target import Change
from ..rule import Diagnostic, rule
from ..severity import Doubt, doubts_of_place
from ..text import Text
from ..upcoming import Upcoming, rate_upcoming
from .diagnosis import availability_texts, diagnose
from .interface_headers import TEXTS as INTERFACE_TEXTS
from .interface_headers import doubts_of_c_header, find_interface_fault
from .moved_header import respell
from .parameter_header import ParameterHeaders

_INCLUDE = "[[include `{replacement}`]]"


@rule(
    scope="target",
    severity="error",
    texts={
        **availability_texts("include"),
        **INTERFACE_TEXTS,
        "broken": Text("no package of the workspace has or generates `{subject}`"),
        "platform": Text("no package of {upstream} has `{subject}`"),
        "nested": Text("`{subject}` is not installed by {upstream} {version}", _INCLUDE),
        "misspelt": Text("no package has `{subject}`, but `{package}` has `{replacement}`", "include `{replacement}`"),
    },
)
def removed_header(view: View):
    rows = _Rows(view)
    for package in view:
        yield from rate_upcoming(_list_removed(view, package, rows))


class _Rows:
    """What is known for the whole view: the reviewed rows by path, and paths of which nothing can be said."""

    def __init__(self, view: View):
        kinds = ("header-removed", "header-renamed", "header-moved")
        self.gone = {c.old: c for c in view.changes(*kinds) if c.state == "removed" and c.old}
        self.early = {c.new: c for c in view.changes(*kinds[1:]) if c.state == "absent" and c.new}
        self.quiet: set[str] = set()
        self.parameters = ParameterHeaders(view)

    def find(self, view: View, path: str) -> Change | None:
        """The row on a path that the target lacks."""
        change = self.gone.get(path)
        if change is not None and not view.nested_header(change.package, path):
            return change
        change = self.early.get(path)
        return change if change is not None and view.has_released_header(change.package, path) is False else None


def _list_removed(view: View, package: Package, rows: _Rows) -> Iterator[Diagnostic | Upcoming]:
    for include in package.digest.includes:
        path = include.path
        if path in rows.quiet or not view.active(include.conditions):
            continue
        if rows.parameters.find_fault(include) or versioned_folder(view.target, path) is not None:
            continue  # which rules of their own report
        if view.workspace.provides_header(path):
            rows.quiet.add(path)
            continue
        doubts = doubts_of_place(view, include.role, include.conditions)
        if not include.targets:
            doubts = (*doubts, Doubt.UNCOMPILED)
        yield from _of_release(view, package, include, rows, doubts)


def _of_release(
    view: View, package: Package, include: IncludeUse, rows: _Rows, doubts: tuple[Doubt, ...]
) -> Iterator[Diagnostic | Upcoming]:
    """What is to be said of a header of others, by the first source that knows of it."""
    path, at, symbol = include.path, include.at, Symbol("header", include.path)
    order = (not is_header(at.path), at.path, at.line)
    if (change := rows.find(view, path)) is not None:
        found = of_row(symbol, change)
        as_it_is = found.state == "removed" and change.kind != "header-removed"
        fix = respell(view, package, include, found.replacement) if as_it_is else ()
        yield diagnose(found, at, path, package.name, doubts, fix=fix)
        return
    change, ahead = view.coming.get(path, (None, None))
    is_header_row = change is not None and change.kind.startswith("header")
    if change is not None and ahead is not None and is_header_row and view.active_on(ahead, include.conditions):
        fix = respell(view, package, include, change.new) if change.kind != "header-removed" else ()
        found, changed = of_row(symbol, change).on(ahead), f"{change.package} {path}"
        yield diagnose(found, at, path, package.name, doubts, fix=fix, changed=changed, order=order)
        return
    found = view.header_availability(path)
    if found is not None and (found.is_missing or found.state == "upcoming"):
        fix = () if found.state == "not yet" else respell(view, package, include, found.replacement)
        yield diagnose(found, at, path, package.name, doubts, fix=fix, order=order)
        return
    found = view.lost_header(path)
    if found is not None:
        if found.form != "platform" or not (view.opaque_libraries(package, path) or view.blind(package)):
            yield diagnose(found, at, path, package.name, doubts, kind=found.form)
        return  # else something that comes along has contents that are not known
    if (own := _find_misspelt(view, package, path)) is not None:
        doubts = _doubts_of_misspelt(view, package, include)
        yield Diagnostic(at, path, package.name, {"replacement": own}, "misspelt", doubts)
        return
    yield from _of_interface(view, package, include, rows, doubts, order)


def _of_interface(
    view: View, package: Package, include: IncludeUse, rows: _Rows, doubts: tuple[Doubt, ...], order: tuple
) -> Iterator[Diagnostic | Upcoming]:
    """What is to be said of a header that is generated from an interface."""
    path, at = include.path, include.at
    fault = find_interface_fault(view, path)
    if fault is None:
        if path not in rows.gone and path not in rows.early and path not in view.coming:
            rows.quiet.add(path)
        return
    if fault.kind == "c":
        of_c = doubts_of_c_header(view, package, include)
        if of_c is not None:
            yield Diagnostic(at, path, package.name, fault.data, "c", of_c)
        return
    if fault.found is not None and fault.found.state == "upcoming":
        changed = path.partition("/")[0]
        yield diagnose(fault.found, at, path, package.name, doubts, changed=changed, order=order)
        return
    if view.target.ros == 2 and any(other.path.startswith("ros/") for other in package.digest.includes):
        return  # a bridge, which is built for both generations
    if fault.found is not None:
        yield diagnose(fault.found, at, path, package.name, doubts)
        return
    if fault.kind == "never generated" and include.public and include.role != "aside":
        # Nobody can compile what is installed.
        doubts = () if view.certain(include.conditions) else (Doubt.GUARDED,)
    yield Diagnostic(at, path, package.name, fault.data, fault.kind, doubts)


def _doubts_of_misspelt(view: View, package: Package, include: IncludeUse) -> tuple[Doubt, ...]:
    """Nobody can compile an installed header with it, nor the package itself where it does."""
    if include.role == "aside" or not (include.targets or include.public):
        return (Doubt.UNCOMPILED,)
    name = include.path.rpartition("/")[2]
    if package.build.unresolved or any(path.rstrip("/").endswith(name) for path in package.build.made):
        return (Doubt.INCOMPLETE,)  # the build may make it
    return () if view.certain(include.conditions) else (Doubt.GUARDED,)


# Letters of a file's name: shorter ones are alike by chance.
_SHORTEST = 8


def _find_misspelt(view: View, package: Package, path: str) -> str | None:
    """The header of the package that an include path misses by one letter; None where somebody has what it names, or
    may make it."""
    if view.header(path) or len(path.rpartition("/")[2]) < _SHORTEST:
        return None
    bare = "/" not in path
    for header in package.digest.headers:
        own = header.rpartition("/")[2] if bare else f"/{header}".rpartition("/include/")[2]
        if is_slip(path, own):
            return own
    return None
