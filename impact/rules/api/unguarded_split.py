"""unguarded-split: the targets asked for need different spellings, and nothing tells them apart.

What it does
    Reports, once for each package of the workspace and each package or library that changed, that names it uses have
    one spelling on some of the targets asked for and another on the others. The places are reported by the rules on
    what is gone or not there yet, each with the guarded form as help; this is the sum of them, for whoever keeps one
    branch for all targets.

Why it matters
    The cure that one developer applies breaks the build of another: no spelling is right on all targets asked for.

Severity
    note.

Example
    #include <cv_bridge/cv_bridge.h>            // Humble has only this one, Jazzy only the other

Use instead
    #if __has_include(<cv_bridge/cv_bridge.hpp>)
    #include <cv_bridge/cv_bridge.hpp>
    #else
    #include <cv_bridge/cv_bridge.h>
    #endif

Not reported
    Names of which one spelling is there on all targets asked for; uses under a test that tells the versions apart.
"""

from collections.abc import Iterable, Iterator

from ...model.cmake.build import At
from ...targets.evidence import Evidence
from ..rule import Finding, Hit, rule


@rule(scope="workspace", severity="note")
def unguarded_split(workspace):
    """What splits is known only after all targets were judged, so check.py calls split()."""
    return iter(())


def split(findings: Iterable[tuple[Finding, Evidence, tuple[str, ...], tuple[str, ...]]]) -> Iterator[tuple[str, Hit]]:
    """(target, hit) of names that no spelling serves. findings: each with its evidence, and the targets that take only
    the old or only the new spelling."""
    groups: dict[tuple[str, str], list] = {}
    for entry in findings:
        if entry[0].severity == "note":
            continue  # such code is not compiled everywhere, or stands under a test
        groups.setdefault((entry[0].package, entry[1].package), []).append(entry)
    for (package, changed), entries in groups.items():
        names = list(dict.fromkeys(finding.subject for finding, *_ in entries))
        first, _, old, new = entries[0]
        told = ", ".join(f"`{name}`" for name in names[:_MOST]) + (
            f" and {len(names) - _MOST} more" if len(names) > _MOST else ""
        )
        count = "one name" if len(names) == 1 else f"{len(names)} names"
        has = "has" if len(names) == 1 else "have"
        message = f"{count} of {changed} {has} no spelling that is right on {_listed([*old, *new])}: {told}"
        cure = "keep both spellings in one header of your own, and include that" if len(names) > 1 else ""
        for target in (*old, *new):
            yield target, Hit(At(first.path, first.line, first.column), changed, message, cure, package, "note")


_MOST = 4


def _listed(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"
