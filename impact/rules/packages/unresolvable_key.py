"""unresolvable-key: rosdep cannot resolve a declared key on a target's platform.

What it does
    Reports dependencies of a manifest that are neither in the workspace nor released on the target, and that are rosdep
    keys, but none for the target's platform.

Why it breaks
    `rosdep install` stops with "No definition of [x] for OS version", and bloom refuses to release the package.

Severity
    error; warning for what only the documentation is made with (`doc_depend`), which `rosdep install` leaves out.

Example
    <depend>eigen3</depend>                     <!-- which is a key of other platforms -->

Use instead
    <depend>eigen</depend>

Not reported
    Packages that some distro has released (unreleased-package reports them), dependencies under a condition that does
    not hold on the target, and names listed in `[workspace] private` or `installed`.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .unresolved_names import find_installing, list_name_doubts, list_unresolved, replace_name

_MESSAGE = "rosdep has no rule for `{subject}` on {platform}"


@rule(
    texts={
        "no rule": Text(_MESSAGE, "declare a key that exists on the target, or put a condition on the dependency"),
        "no rule, similar": Text(_MESSAGE, "declare `{replacement}`"),
    },
)
def unresolvable_key(view: TargetView, package: Package):
    target = view.target
    for name, at, resolution in list_unresolved(view, package):
        if resolution is not None or view.may_be_unread(name) or target.was_ever_released(name):
            continue
        if target.knows_key(name) and target.has_rosdep_rules():
            similar = next(iter(target.find_replacement_keys(name)), "")
            installing = "" if similar else find_installing(view, package, name)
            fix = replace_name(view, package, name, installing) if installing else ()
            data = {"platform": target.platform, "replacement": similar or installing}
            kind = "no rule, similar" if similar or installing else "no rule"
            doubts = list_name_doubts(view, package, name)
            yield Diagnostic(at, name, package.name, data, kind, doubts, fix)
