"""missing-include: a name is used and its header reaches the file only by luck.

What it does
    Reports names of the standard library, and of libraries that the known-changes table covers, in files that do not
    include the header that offers them, neither themselves nor through files of the package.

Why it breaks
    Some other header brings it today. The next compiler or library version stops including it, and the build fails on
    the machine that has that version.

Severity
    error when only standard headers reach a source file and none of them brings the name in the target's compiler;
    warning for headers, which something may precede, and for what an included library no longer brings; note when that
    lies ahead, in the newest distro.

Example
    uint32_t width;                             // and no #include <cstdint>: GCC 13 stops here

Use instead
    #include <cstdint>

Not reported
    Names that a standard header which reaches the file still brings; files that include headers of other packages,
    unless a library that once brought the name is among them.
"""

from ...model.package import is_header
from ...model.view import View
from ...targets.standard import reaches
from ...targets.version import at_least, parts
from ..cure import Insert
from ..rule import Hit, rule


@rule(severity="warning")
def missing_include(view: View):
    here, coming = _dropped(view, view.target), {}
    newest = view.target.newest()
    if newest is not None:
        coming = {name: known for name, known in _dropped(view, newest).items() if name not in here}
    for package in view:
        told = set()
        beyond: dict[str, list[str]] = {}  # what is not of the standard library and reaches a file
        for need in package.digest.needed_headers:
            known = here.get(need.name) or coming.get(need.name)
            if known is None or need.role == "aside" or not view.active(need.conditions):
                continue
            if need.name not in here and not view.later_active(need.conditions):
                continue
            row, version = known
            header = row.headers[0]
            if (need.at.path, header) in told:
                continue
            outside = beyond.get(need.at.path)
            if outside is None:
                outside = beyond[need.at.path] = [r for r in need.reach if not view.is_standard(r)]
            if (row.through and not any(r.startswith(row.through) for r in need.reach)) or (
                outside and not row.through
            ):
                continue
            missed = row.through or _out_of_reach(need, row.library, version)
            if not missed:
                continue
            told.add((need.at.path, header))
            now = need.name in here
            sure = (
                now
                and need.role == "build"
                and not row.through
                and not outside
                and not is_header(need.at.path)
                and view.certain(need.conditions)
            )
            where = "" if now else f" of {view.horizon}"
            yield Hit(
                need.at,
                header,
                f"`{need.name}` is used without `<{header}>`, "
                f"which {row.library} {version}{where} no longer brings along",
                f"#include <{header}>",
                package.name,
                severity="error"
                if sure
                else "warning"
                if now and not (row.through and is_header(need.at.path))
                else "note",
                fix=_included(view, package, need, header) if not row.through else (),
            )


def _included(view: View, package, need, header: str) -> tuple[Insert, ...]:
    """The cure that includes a header behind the standard C++ headers of the file that sort before it; nothing where it
    includes none outside of conditions."""
    standard = [
        i
        for i in package.digest.includes
        if i.at.path == need.at.path
        and i.at.line < need.at.line
        and not i.conditions
        and "." not in i.path
        and view.is_standard(i.path)
    ]
    before = [i for i in standard if i.path < header] or standard
    return (Insert(need.at.path, max(i.at.line for i in before), f"#include <{header}>"),) if before else ()


def _dropped(view: View, target):
    """Names whose header a target's compiler or libraries no longer bring along, with the row and the version."""
    found = {}
    for row in view.transitive:
        version = target.library(row.library) or target.version(row.library)
        if version and at_least(version, row.since):
            found[row.name] = row, version
    return found


def _out_of_reach(need, library: str, version: str) -> bool:
    """True when no standard header that reaches the file brings the name in that GCC, by what its headers include."""
    if library != "gcc":
        return True
    headers = frozenset(r for r in need.reach)
    return reaches(headers, need.name, parts(version)[0]) is False
