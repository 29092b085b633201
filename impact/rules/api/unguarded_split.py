"""unguarded-split: the targets asked for need different names, and nothing tells them apart.

What it does
    Reports, once for each package of the workspace and each package or library that changed, that names it uses have
    one name on some of the targets asked for and another on the others. The places are reported by the rules on
    what is gone or not there yet, each with the guarded form as help; this is the sum of them, for whoever keeps one
    branch for all targets.

Why it matters
    The fix that one developer applies breaks the build of another: no single name works on all targets asked for.

Example
    #include <cv_bridge/cv_bridge.h>            // Humble has only this one, Jazzy only the other

Use instead
    #if __has_include(<cv_bridge/cv_bridge.hpp>)
    #include <cv_bridge/cv_bridge.hpp>
    #else
    #include <cv_bridge/cv_bridge.h>
    #endif

Not reported
    Names of which one is there on all targets asked for; uses under a test that tells the versions apart.
"""

from collections.abc import Iterable, Iterator

from ...targets.evidence_record import Evidence
from ..vocabulary import At, Diagnostic, Finding, Text, rule

_MESSAGE = "no single name works on {where} for {names}, which changed in `{subject}`"


@rule(
    scope="workspace",
    severity="note",
    texts={
        "one name": Text(_MESSAGE),
        "names": Text(_MESSAGE, "keep both names in one header of your own, and include that"),
    },
)
def unguarded_split(workspace):
    """What splits is known only after the rules ran on all targets, so check.py calls list_splits()."""
    return iter(())


def list_splits(
    findings: Iterable[tuple[Finding, Evidence, tuple[str, ...], tuple[str, ...]]],
) -> Iterator[tuple[str, Diagnostic]]:
    """(target, diagnostic) of names that no single name replaces. findings: each with its evidence, and the targets
    that take only the old or only the new name."""
    groups: dict[tuple[str, str], list] = {}
    for entry in findings:
        if entry[0].severity == "note":
            continue  # such code is not compiled everywhere, or stands under a test
        groups.setdefault((entry[0].package, entry[1].package), []).append(entry)
    for (package, changed), entries in groups.items():
        names = tuple(dict.fromkeys(finding.subject for finding, *_ in entries))
        first, _, old, new = entries[0]
        targets = [*old, *new]
        data = {"names": names, "where": f"{', '.join(targets[:-1])} and {targets[-1]}"}
        at = At(first.path, first.line, first.column)
        for target in targets:
            yield target, Diagnostic(at, changed, package, data, "names" if len(names) > 1 else "one name")
