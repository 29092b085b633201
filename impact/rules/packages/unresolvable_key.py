"""unresolvable-key: rosdep cannot resolve a declared key on a target's platform.

What it does
    Reports dependencies of a manifest that are neither in the workspace nor released on the target, and that are rosdep
    keys, but none for the target's platform; and keys of a package that the platform's archive does not
    have.

Why it breaks
    `rosdep install` stops with "No definition of [x] for OS version", or where apt says "Unable to locate package";
    bloom refuses to release a package without a rule.

Severity
    error; warning for what only the documentation is made with (`doc_depend`), which `rosdep install` leaves out, and
    for what Ubuntu's archive lacks, since only lists of files and Debian's archives show that.

Example
    <depend>eigen3</depend>                     <!-- which is a key of other platforms -->

Use instead
    <depend>eigen</depend>

Not reported
    Packages of Debian that no archive which was read ever had; packages that some distro has released
    (unreleased-package reports them), dependencies under a condition that does not hold on the target, and names listed
    in `[workspace] private` or `installed`.
"""

from ...targets.providers.archive import load_archives
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .unresolved_names import find_installing, list_name_doubts, list_unresolved, replace_name

_MESSAGE = "rosdep has no rule for `{subject}` on {platform}"


@rule(
    texts={
        "no rule": Text(_MESSAGE, "declare a key that exists on the target, or put a condition on the dependency"),
        "no rule, similar": Text(_MESSAGE, "declare `{replacement}`"),
        "not in archive": Text(
            "`{subject}` stands for `{installs}`, which the archive of {platform} does not have",
            "declare a key that installs what replaced it, or put a condition on the dependency",
        ),
    },
)
def unresolvable_key(view: TargetView, package: Package):
    target = view.target
    for name, at, resolution in list_unresolved(view, package):
        if resolution is not None and resolution.manager == "apt":
            lacking = [one for one in resolution.packages if load_archives().lacks(target.platform, one)]
            doubts = list_name_doubts(view, package, name)
            if not load_archives().knows(target.platform):
                doubts = (*doubts, Doubt.INCOMPLETE)
            data = {"platform": target.platform, "installs": " ".join(lacking)}
            if lacking and name not in view.installed:
                yield Diagnostic(at, name, package.name, data, "not in archive", doubts)
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
