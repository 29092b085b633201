"""removed-header: an included header is gone, or not there yet, on a target.

What it does
    Reports `#include` lines whose header the target's version of the providing package does not install: removed,
    renamed, or only added in a later version; headers of platform libraries that the newest distro no longer has;
    generated headers whose interface the version lacks, no version has, or another package of the workspace has; own
    headers with a letter wrong; spellings of generated headers that belong to the other ROS generation, or to C where
    rclcpp is used; headers of generate_parameter_library by a path that its version does not make, or does not install;
    and paths that name the folder which a platform has for one version of a library (`opencv4/opencv2/core.hpp`).

Why it breaks
    The compiler stops with "No such file or directory" on that developer's machine and nowhere else.

Severity
    error for compiled code that is not guarded, tests of ROS 2 included, and for what goes with the next sync (which
    the build farm builds against already), and for an installed header that includes what nobody has, so that nobody
    can compile it; warning for tests of ROS 1, under CMake conditions that are not known, for the first include of each
    header that goes with a later update or on the newest distro's platform, for headers of C where nothing else brings
    the C++ types, for installed headers that include what is not installed, and once in a package for a path through
    the folder of a version that is there, since another machine may have it elsewhere; note for its other includes, for
    examples, for installed headers that the package does not compile itself, and under other tests of the code itself.

Example
    #include <tf2_geometry_msgs/tf2_geometry_msgs.h>     // gone from tf2_geometry_msgs 0.36

Use instead
    #include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>   // there since 0.25

Not reported
    Includes under `#if __has_include(...)` or a version test that excludes the target; headers of the workspace itself;
    headers that no known package has, where something that the package depends on has unknown contents;
    ROS 1 names in a package that also includes ROS 1 headers, as bridges do.
"""

import re

from ...model.misspelling import one_edit
from ...model.package import IncludeUse, is_header
from ...model.view import Misnamed, View
from ...model.workspace import Package
from ...targets.availability import Horizon
from ...targets.changes import removed_in
from ...targets.evidence import evidence_of
from ...targets.providers.library import Folder, versioned_folder
from ...targets.target import Change
from ...targets.version import at_least
from ..rule import Hit, rule
from ..severity import Doubt, Repeats, doubts_of_place, severity
from .build_api import hit_of, rate
from .moved_header import respelt
from .upcoming import Upcoming, rated


@rule(severity="error")
def removed_header(view: View):
    gone = {
        c.old: c
        for c in view.changes("header-removed", "header-renamed", "header-moved")
        if c.state == "removed" and c.old
    }
    early = {c.new: c for c in view.changes("header-renamed", "header-moved") if c.state == "absent" and c.new}
    quiet: set[str] = set()  # paths of which nothing can be said, whoever includes them
    parameters = _Parameters(view)
    for package in view:
        dual = view.target.ros == 2 and any(i.path.startswith("ros/") for i in package.digest.includes)
        coming: list[Upcoming] = []
        repeats = Repeats()
        for include in package.digest.includes:
            path = include.path
            if path in quiet or not view.active(include.conditions):
                continue
            if (made := parameters.lost(package, include)) is not None:
                yield made
                continue
            if view.workspace.provides_header(path):
                quiet.add(path)
                continue
            doubts = doubts_of_place(view, include.role, include.conditions)
            if not include.targets:
                doubts = (*doubts, Doubt.UNCOMPILED)
            bad = severity(*doubts)
            folder = versioned_folder(view.target, path)
            if folder is not None:
                if folder.there:
                    bad = repeats.severity(path, *doubts, Doubt.DISTURBS)
                yield _in_folder(package, include, folder, bad)
                continue
            change = gone.get(path)
            if change is not None and not view.nested_header(change.package, path):
                where = f"{change.package} {change.version}".strip()
                since = removed_in(change)
                yield Hit(
                    include.at,
                    path,
                    f"`{path}` is not available in {where}" + (f" (removed in {since})" if since else ""),
                    f"include `{change.new}`" + (f", available since {change.since}" if change.since else "")
                    if change.new
                    else "",
                    package.name,
                    severity=bad,
                    fix=respelt(view, package, include, change),
                    evidence=evidence_of(change),
                )
                continue
            change = early.get(path)
            if change is not None and view.has_released_header(change.package, path) is False:
                where = f"{change.package} {change.version}".strip()
                yield Hit(
                    include.at,
                    path,
                    f"`{path}` is not available in {where}" + (f" (added in {change.since})" if change.since else ""),
                    f"include `{change.old}`, or choose with __has_include",
                    package.name,
                    severity=bad,
                    evidence=evidence_of(change),
                )
                continue
            change, ahead = view.coming.get(path, (None, None))
            if (
                change is not None
                and ahead is not None
                and change.kind.startswith("header")
                and view.active_on(ahead, include.conditions)
            ):
                coming.append(_will_go(view, package, include, change, ahead, doubts))
                continue
            found = view.header_availability(path)
            if found is not None and (found.is_missing or found.state == "upcoming"):
                advice = f"include `{found.replacement}`" if found.replacement else ""
                hit = hit_of(found, include.at, path, package.name, advice)
                moved = Change("header-renamed", found.package, path, found.replacement, "", found.version, "", "")
                fix = () if found.state == "not yet" else respelt(view, package, include, moved)
                rating = rate(found, hit._replace(fix=fix), doubts)
                if isinstance(rating, Upcoming):
                    coming.append(rating._replace(order=_rank(include)))
                else:
                    yield rating
                continue
            lost = view.lost_header(path)
            if lost is not None and lost.closed and (view.sealed(package) or view.blind(package)):
                continue  # something that comes along has contents that are not known
            if lost is not None:
                yield Hit(
                    include.at, path, lost.message, lost.help, package.name, severity=bad, evidence=lost.evidence
                )
                continue
            if (own := _misspelt(view, package, path)) is not None:
                yield Hit(
                    include.at,
                    path,
                    f"nothing has `{path}`, and `{package.name}` has `{own}`",
                    f"include `{own}`",
                    package.name,
                    severity=severity(*_doubts_of_misspelt(view, package, include)),
                )
                continue
            wrong = view.misnamed_interface(path) or view.lost_interface(path)
            soon = view.coming_interface(path) if wrong is None else None
            if soon is not None and soon.ahead is not None:
                hit = Hit(include.at, path, soon.message, soon.help, package.name, evidence=soon.evidence)
                coming.append(Upcoming(hit, path.partition("/")[0], soon.ahead, doubts, _rank(include)))
                continue
            if wrong is None and (in_c := _in_c(view, path)) is not None:
                if include.role != "aside" and (of_cpp := _of_cpp(view, package, include)) is not None:
                    yield Hit(include.at, path, in_c.message, in_c.help, package.name, severity=of_cpp)
                continue
            if wrong is None and path not in gone and path not in early and path not in view.coming:
                quiet.add(path)
            if wrong and wrong.never and include.public and include.role != "aside":
                # Nobody can compile what is installed.
                bad = severity(view.certain(include.conditions) or Doubt.GUARDED)
            if wrong and not dual:
                yield Hit(
                    include.at,
                    path,
                    wrong.message,
                    wrong.help,
                    package.name,
                    severity=bad,
                    evidence=wrong.evidence,
                )
        yield from rated(coming)


def _will_go(
    view: View, package: Package, include: IncludeUse, change: Change, ahead: Horizon, doubts: tuple[Doubt, ...]
) -> Upcoming:
    message = f"`{include.path}` will be removed: not in {change.package} {change.version} ({ahead.name})"
    advice = f"include `{change.new}`" if change.new else ""
    hit = Hit(include.at, include.path, message, advice, package.name, fix=respelt(view, package, include, change),
              evidence=evidence_of(change))  # fmt: skip
    return Upcoming(hit, f"{change.package} {include.path}", ahead, doubts, _rank(include))


def _misspelt(view: View, package: Package, path: str) -> str | None:
    """The header of the package that an include path misses by one letter; None where somebody has what it names, or
    may make it."""
    if view.header(path) or len(path.rpartition("/")[2]) < _SHORTEST:
        return None
    bare = "/" not in path
    for header in package.digest.headers:
        own = header.rpartition("/")[2] if bare else f"/{header}".rpartition("/include/")[2]
        if one_edit(path, own) and re.findall(r"\d", path) == re.findall(r"\d", own):
            return own
    return None


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


def _in_folder(package: Package, include: IncludeUse, folder: Folder, bad: str) -> Hit:
    """What is wrong with the folder of one version of a library in a path."""
    where = include.path.partition("/")[0]
    text = (
        f"`{where}/` is where this platform puts {folder.library} {folder.version}, and others need not"
        if folder.there
        else f"`{include.path}` is not there with {folder.library} {folder.version}"
    )
    return Hit(include.at, include.path, text, f"include `{folder.path}`", package.name, severity=bad)


_C_HEADER = re.compile(r"(?P<stem>(?P<package>\w+)/(?:msg|srv|action)/[a-z0-9_]+)\.h\Z")


def _in_c(view: View, path: str) -> Misnamed | None:
    """What is wrong with a generated header of ROS 2 for C, where C++ includes it."""
    found = _C_HEADER.match(path) if view.target.ros == 2 else None
    if found is None or not view.generates_interfaces(found["package"]):
        return None
    return Misnamed(f"`{path}` has the types of C, not those of C++", f"include `{found['stem']}.hpp`")


def _of_cpp(view: View, package: Package, include: IncludeUse) -> str | None:
    """How bad it is that a file includes a header of C; None where the file may be about C."""
    beside = {i.path for i in package.digest.includes if i.at.path == include.at.path} - {include.path}
    if include.path + "pp" in beside or not any(path.startswith("rclcpp") for path in beside):
        return None
    own = any(path == include.at.path and inner for path, inner in package.digest.inner)
    if own or not is_header(include.at.path) or not view.certain(include.conditions):
        return "note"  # what the package's own headers bring along is not followed
    machine, wanted = view.machine, include.path + "pp"
    known = frozenset(beside)
    unknown = [path for path in machine.outside(known) if path in known and not view.is_standard(path)]
    brought = machine.bits((wanted,)) & machine.mask(known)
    return "note" if unknown or brought else "warning"


class _Parameters:
    """Headers that generate_parameter_library makes, which have been `name.hpp`, and are `package/name.hpp`.

    Source: its CMake at the tags: from 0.4.0 on `package/name.hpp` is installed, and the other is made for the package
    itself only; 1.0.0 makes that no more."""

    def __init__(self, view: View):
        version = view.target.version("generate_parameter_library")
        own = "generate_parameter_library" in view.workspace.packages
        self.version = "" if own else version or ""
        self.owner = {
            item.target: package.name
            for package in view.workspace
            for item in package.build.generated
            if item.how == "parameters" and self.version
        }

    def lost(self, package: Package, include: IncludeUse) -> Hit | None:
        """What is wrong with the include of such a header."""
        head, _, file = include.path.rpartition("/")
        owner = self.owner.get(file.removesuffix(".hpp")) if file.endswith(".hpp") else None
        if owner is None or head not in ("", owner) or include.role == "aside":
            return None
        new = f"{owner}/{file}"
        if head and not at_least(self.version, "0.4.0"):
            return self._hit(package, include, f"`{new}` is not made by", f"include `{file}`", severity())
        if not head and at_least(self.version, "1.0.0"):
            return self._hit(package, include, f"`{file}` is no longer made by", f"include `{new}`", severity())
        if not head and include.public and at_least(self.version, "0.4.0"):
            text = f"an installed header includes `{file}`, which is installed as `{new}` by"
            return self._hit(package, include, text, f"include `{new}`", severity(Doubt.DISTURBS))
        return None

    def _hit(self, package: Package, include: IncludeUse, text: str, cure: str, bad: str) -> Hit:
        message = f"{text} generate_parameter_library {self.version}"
        return Hit(include.at, include.path, message, cure, package.name, severity=bad)


def _rank(include: IncludeUse) -> tuple[bool, str, int]:
    return not is_header(include.at.path), include.at.path, include.at.line
