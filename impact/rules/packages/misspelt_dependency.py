"""misspelt-dependency: a declared dependency has a name that is no package or rosdep key, but stands for one.

What it does
    Reports names in a manifest that neither rosdep nor any distro knows, where a key installs the package of Debian,
    CMake or pkg-config that is called so, where the name is that of the Debian package of a package of ROS, is one edit
    away from a known one, is that of a repository whose packages are called after it, of a target of the package
    itself, of a module of Python's standard library that the package imports, or of a build type.

Why it breaks
    `rosdep install` stops with "Cannot locate rosdep definition for [x]", and bloom refuses to release the package.

Severity
    error; warning for a name `x` or `x2` if exactly one package or key such as `x_vendor` or `libx-dev` exists, for one
    that differs from a package of the workspace in the ending of a word or, in a package that is there to bring others,
    in a word that is left out, for a target of the package, and for what only the documentation is made with
    (`doc_depend`), which `rosdep install` leaves out.

Example
    <depend>Eigen3</depend>

Use instead
    <depend>eigen</depend>

Not reported
    Dependencies under a condition that does not hold on the target; names listed in `[workspace] private` or
    `installed`, or that may belong to a submodule that was not read.
"""

import re

from ...model.misspelling import is_slip
from ...model.package import BUILD_TOOLS
from ..vocabulary import Diagnostic, Doubt, Package, Remove, TargetView, Text, rule
from .unresolved_names import find_intended, find_packaged, list_name_doubts, list_unknown, replace_name

_NEEDLESS = ("standard library", "target")
"""What a name stands for that is not to be declared."""


@rule(
    group="unresolvable-key",
    texts={
        "misspelt": Text("`{subject}` is neither a package nor a rosdep key", "declare `{replacement}`"),
        "system package": Text("`{subject}` is a system package, not a rosdep key", "declare `{replacement}`"),
        "standard library": Text(
            "`{subject}` is a module of Python's standard library, not a package or rosdep key", "remove it"
        ),
        "target": Text("`{subject}` is a target of `{package}`, not a package or rosdep key", "remove it"),
        "repository": Text(
            "`{subject}` is neither a package nor a rosdep key, but {packages} are packages",
            "declare the packages that are used",
        ),
        "build type": Text("`{subject}` is a build type, not a package or rosdep key", "declare it as build_type only"),
    },
)
def misspelt_dependency(view: TargetView, package: Package):
    for name, at, _ in list_unknown(view, package):
        intended = find_intended(view, package, name)
        if intended is None:
            if name in BUILD_TOOLS and not view.may_be_unread(name):
                yield Diagnostic(at, name, package.name, kind="build type", fix=(Remove(at.path, name),))
            continue
        kind, names = intended
        replacement = names[0]
        data = {"replacement": replacement, "packages": names[:2]}
        doubts = (Doubt.AMBIGUOUS,) if kind in ("target", "related") else list_name_doubts(view, package, name)
        fix = ()
        if kind in _NEEDLESS:
            fix = (Remove(at.path, name),)
        elif kind == "installing" or (kind == "near" and _is_surely_meant(name, replacement)):
            fix = replace_name(view, package, name, replacement)
        if kind not in (*_NEEDLESS, "repository"):
            of_system = kind == "installing" and (view.target.find_keys(name) or find_packaged(view, name))
            kind = "system package" if of_system else "misspelt"
        yield Diagnostic(at, name, package.name, data, kind, doubts, fix)


def _is_surely_meant(name: str, near: str) -> bool:
    """Whether no other name can be meant; a digit tells versions apart."""
    plain, other = (re.sub(r"[-_.\s]", "", each.lower()) for each in (name, near))
    return plain == other or (len(name) > 5 and is_slip(name, near))
