"""missing-include: a name is used and its header reaches the file only by luck.

What it does
    Reports names of the standard library, and of libraries that the known-changes table covers, in files that do not
    include the header that offers them, neither themselves nor through files of the package.

Why it breaks
    Some other header brings it today. The next compiler or library version stops including it, and the build fails on the
    machine that has that version.

Severity
    error when the target's compiler or library is known to have dropped it and nothing else could bring it; warning when
    another included library may still bring it.

Example
    uint32_t width;                             // and no #include <cstdint>: GCC 13 stops here

Use instead
    #include <cstdint>

Not reported
    Names for which no target has the version that dropped the header.
"""

from ...model.view import View
from ...targets.version import at_least
from ..rule import Hit, rule


@rule(severity="warning")
def missing_include(view: View):
    dropped = {}
    for row in view.transitive:
        version = view.target.library(row.library) or view.target.version(row.library)
        if version and at_least(version, row.since):
            dropped[row.name] = row, version
    if not dropped:
        return
    for package in view:
        told = set()
        for need in package.digest.needed_headers:
            known = dropped.get(need.name)
            if known is None or need.role == "aside" or not view.active(need.conditions):
                continue
            row, version = known
            header = row.headers[0]
            if (need.at.path, header) in told:
                continue
            outside = [r for r in need.reach if not view.is_standard(r)]
            sure = not outside and view.certain(need.conditions)
            if row.through and not any(r.startswith(row.through) for r in need.reach):
                continue
            if outside and not row.through:
                continue
            told.add((need.at.path, header))
            yield Hit(need.at, header, f"`{need.name}` is used without `<{header}>`, which {row.library} {version} no longer brings along",
                      f"#include <{header}>", package.name,
                      severity="error" if sure and need.role == "build" and not row.through and row.sure else "warning")  # fmt: skip
