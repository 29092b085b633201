"""misspelt-cmake-variable: a variable of a package that CMake finds is misspelt, and therefore empty.

What it does
    Reports variables such as `Eigen3_INCLUDE_DIR` that no find_package sets, one edit or case away from one that a
    find_package of the same package does set; and other variables in install, link and target commands that nothing
    sets, where a variable with one word more or less in its name is set.

Why it breaks
    CMake takes an unknown variable as empty and says nothing: an include folder or a library is missing later on.

Example
    find_package(OpenCV REQUIRED)
    include_directories(${OPENCV_INCLUDE_DIRS})

Use instead
    include_directories(${OpenCV_INCLUDE_DIRS})

Not reported
    Variables of packages that somebody is known to provide under that spelling, and those that other commands set.
"""

import re

from ...model.misspelling import is_slip
from ...targets.providers.library import list_variables
from ..vocabulary import Diagnostic, Doubt, Package, Replace, TargetView, Text, Together, rule

_VARIABLE = re.compile(
    r"(.+)(_(?:INCLUDE_DIRS?|LIBRARIES|LIBRARY|LIBS|EXPORTED_TARGETS|DEFINITIONS|VERSION))\Z"
)  # fmt: skip


@rule(
    severity="warning",
    group="misspelt-cmake-name",
    texts={
        "variable": Text("nothing sets `{subject}`; find_package({found}) is called", "write `{replacement}`"),
        "alike": Text("nothing sets `{subject}`, but `{variable}` is set", "write `{replacement}`"),
        "other variable": Text(
            "find_package({found}) sets `{variable}`, so `{subject}` is empty", "write `{replacement}`"
        ),
    },
)
def misspelt_cmake_variable(view: TargetView, package: Package):
    found = sorted({f.name for f in package.build.found})
    folded = {name.lower(): name for name in found}
    prefixes = {f.prefix for f in package.build.found}  # of variables, in calls other than find_package()
    seen = set()
    for use in package.build.uses:
        if use.name in seen or use.kind != "variable":
            continue
        if use.alike:
            seen.add(use.name)
            yield _diagnose_variable(package, use, "", use.alike, "alike")
            continue
        match = _VARIABLE.match(use.name)
        if match is None:
            continue
        stem, suffix = match.groups()
        meant = next((name for name in found if name.isidentifier() and _is_misspelt(stem, name)), None)
        if meant is not None and not view.find_cmake(stem) and stem not in prefixes:
            seen.add(use.name)
            yield _diagnose_variable(package, use, meant, f"{meant}{suffix}", "variable")
            continue
        if stem.lower() not in folded or (stem in found and list_variables(stem) is None):
            continue
        meant = folded[stem.lower()]
        sets = list_variables(meant)
        if meant == "Eigen3" and "eigen3_cmake_module" in found:
            continue  # it sets the variables in both spellings
        if sets is None or use.name in sets:
            continue
        right = next((v for v in sorted(sets) if v.endswith(suffix)), None)
        if right is None:
            right = next(
                (v for v in sorted(sets) if v.lower() == use.name.lower() or v.lower() == use.name.lower() + "s"), None
            )
        if right is not None:
            seen.add(use.name)
            if stem in prefixes:
                continue
            yield _diagnose_variable(package, use, meant, right, "other variable")


def _is_misspelt(stem: str, name: str) -> bool:
    """True when the stem of a variable is a letter or an underscore away from a package's name; a library's variables
    often have another number or other separators in them than its name."""
    letters = re.sub(r"[\W_\d]", "", name)
    return (
        len(letters) > 4
        and is_slip(stem, name)
        and stem.lower() != name.lower()
        and (len(stem) > len(name) or re.sub(r"[\W_]", "", stem) != re.sub(r"[\W_]", "", name))
    )


def _diagnose_variable(package: Package, use, found: str, variable: str, kind: str) -> Diagnostic:
    """That a variable is empty, where another one was meant. found: the find_package() that sets it, empty for none."""
    new = f"${{{variable}}}"
    fix = (Replace(use.at.path, use.at.line, use.at.column, f"${{{use.name}}}", new),)
    data = {"found": found, "variable": variable, "replacement": new}
    together = (Together(found),) if found else ()
    return Diagnostic(use.at, use.name, package.name, data, kind, (Doubt.INCOMPLETE,), fix=fix, together=together)
