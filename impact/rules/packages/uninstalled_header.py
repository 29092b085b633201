"""uninstalled-header: an installed header includes a header of its own package that is not installed.

What it does
    Compares the headers that install rules copy, patterns included, with what these headers include: a header of the
    package that lies in its source folder, or that a PATTERN or EXCLUDE leaves out, is not there for dependants.

Why it breaks
    The package builds from its own tree; whoever includes the installed header gets "No such file or directory".

Severity
    error where another package of the workspace compiles the including header and each package is installed into a
    place that others look in (ROS 2); warning; note where no dependant of the workspace includes headers of the package
    and the including header lies in a folder of implementation details, and for all but the first where more than two
    are missing.

Example
    install(DIRECTORY include/ DESTINATION include FILES_MATCHING PATTERN "*.h")   # and a.h includes "p/b.hpp"

Use instead
    install(DIRECTORY include/ DESTINATION include FILES_MATCHING PATTERN "*.h" PATTERN "*.hpp")

Not reported
    Headers that the build makes; includes under a condition; packages of which it cannot be known what they install.
"""

import posixpath
import re

from ...model.cmake.installed import collect_installed_headers
from ...model.package import IncludeUse, find_folder_role, is_header
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule
from .dependants import is_compiled_elsewhere

_ONCE = (Together("header not installed", few=2),)
_DETAIL = re.compile(r"/(?:detail|details|impl|internal)/")


@rule(
    texts=Text(
        "`{header}` is installed and includes `{subject}`, which is not installed",
        help="install `{file}`, or include it from sources alone",
    ),
)
def uninstalled_header(view: TargetView, package: Package):
    if not package.build.files or not package.linked.public_headers:
        return
    installed = collect_installed_headers(package.build, package.linked.files)
    if not installed.known:
        return
    made = set(package.build.made)
    reported = set()
    written = dict(package.linked.written_inner)
    for path, inner in package.linked.inner:
        place = installed.headers.get(path)
        if place is None or find_folder_role(package.strip_path(path)):
            continue
        lost = [to for to in inner if to not in installed.headers and to not in reported and not to.endswith(".in")]
        for to in lost if lost else ():
            include = _find_include(view, written.get(path, ()), to)
            if include is None or not is_header(to) or to in made:
                continue
            if view.is_standard(include.path) or _is_answered(installed.headers, place, include.path):
                continue
            reported.add(to)
            data = {"header": posixpath.basename(path), "file": package.strip_path(to)}
            doubts = _collect_doubts(view, package, path)
            yield Diagnostic(include.at, include.path, package.name, data, doubts=doubts, together=_ONCE)


def _collect_doubts(view: TargetView, package: Package, path: str) -> tuple[Doubt, ...]:
    """Of an installed header that lacks one of its own package: whoever includes it stops."""
    if _DETAIL.search(path) and package.name not in view.workspace.includers:
        return (Doubt.UNCOMPILED,)
    # Catkin's devel space shows dependants the folder of the sources.
    stops = view.target.ros == 2 and is_compiled_elsewhere(view, package, path)
    return () if stops else (Doubt.DISTURBS,)


def _find_include(view: TargetView, includes: tuple[IncludeUse, ...], to: str) -> IncludeUse | None:
    """The include that names another file of the package and stands under no condition."""
    named = (include for include in includes if posixpath.basename(include.path) == posixpath.basename(to))
    return next((include for include in named if view.is_sure(include.conditions)), None)


def _is_answered(headers: dict[str, str], place: str, include: str) -> bool:
    """Whether an installed header answers an include of the header that lies at a place of the prefix."""
    beside = posixpath.normpath(posixpath.join(posixpath.dirname(place), include))
    ending = "/" + include.lstrip("./")
    return any(other == beside or other.endswith(ending) for other in headers.values())
