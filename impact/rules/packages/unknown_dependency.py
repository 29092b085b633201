"""unknown-dependency: no distro releases a declared dependency, and rosdep has no key for it.

What it does
    Reports names in a manifest that are neither in the workspace, nor released by any distro, nor keys of rosdep, and
    that resemble none of these.

Why it breaks
    `rosdep install` stops with "Cannot locate rosdep definition for [x]", and bloom refuses to release the package.

Severity
    note for names that may belong to a private repository, to a submodule that was not read, or to a repository that a
    .repos or .rosinstall file lists; warning for those that
    nothing in the package uses, that have the form of a key (`python3-x`, `libx-dev`, `x-pip`, `x_1.2`), or that are
    called after the package that declares them.

Example
    <depend>our_matrices</depend>               <!-- and nothing in the package uses it -->

Use instead
    Nothing, or the name of the package that is used.

Not reported
    Dependencies under a condition that does not hold on the target; names listed in `[workspace] private` or
    `installed`.
"""

import re

from ...model.on_target import is_called_after
from ...model.package import BUILD_TOOLS
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .unresolved_names import find_intended, list_unknown
from .used_names import list_used_names, shows_uses, stands_in_cmake

# How keys are called, and packages are not: names with dots, and those of packages of Debian or pip.
_KEY = re.compile(r"python3?-[a-z0-9.+-]+|lib[a-z0-9.+-]+-dev|[a-z0-9.+-]+-pip|\w+\.[\w.+-]+")


@rule(
    severity="warning",
    group="unresolvable-key",
    texts={
        "unused": Text(
            "no distro releases `{subject}`, rosdep has no such key, and nothing in `{package}` is known to use it",
            "bring its source into the workspace, remove it, or correct the name",
        ),
        "called after": Text(
            "`{subject}` is called after `{package}` but is neither in the workspace nor released by any distro",
            "remove it, correct the name, or add it to `[workspace] private` in rosimpact.toml",
        ),
        "unread": Text(
            "no distro releases `{subject}`, rosdep has no such key, and it may be in a submodule that was not read: "
            "{unread}",
            "run `git submodule update --init`, or, if it is your own, add it to `[workspace] private`",
        ),
        "listed": Text(
            "no distro releases `{subject}`, rosdep has no such key, and `{listed}` lists its repository, which is not "
            "imported",
            "vcs import < {listed}",
        ),
        "unknown": Text(
            "no distro releases `{subject}`, and rosdep has no such key",
            "if it is your own, add it to `[workspace] private` in rosimpact.toml",
        ),
    },
)
def unknown_dependency(view: TargetView, package: Package):
    for name, at, _ in list_unknown(view, package):
        of_submodule, listing = view.may_be_in_submodule(name), view.find_listing(name)
        if not (of_submodule or listing) and (name in BUILD_TOOLS or find_intended(view, package, name) is not None):
            continue
        unread = view.workspace.outside.unread_submodules
        data = {}
        if listing is not None and not of_submodule:
            kind, doubt, data = "listed", Doubt.PRIVATE, {"listed": listing[0]}
        elif not of_submodule and _KEY.fullmatch(name):
            kind, doubt = "unknown", Doubt.AMBIGUOUS
        elif of_submodule or unread:
            after = [path for path in unread if is_called_after(name, path.rpartition("/")[2])]
            kind, doubt, data = "unread", Doubt.PRIVATE, {"unread": tuple(after or unread)}
        elif name.startswith(f"{package.name}_"):
            kind, doubt = "called after", Doubt.AMBIGUOUS
        elif _may_use(view, package, name):
            kind, doubt = "unknown", Doubt.PRIVATE
        else:
            kind, doubt = "unused", Doubt.AMBIGUOUS
        yield Diagnostic(at, name, package.name, data, kind, (doubt,))


def _may_use(view: TargetView, package: Package, name: str) -> bool:
    """Whether the package uses a name, as those that declare private packages do, or may use it unseen."""
    hidden = package.build.unresolved or not shows_uses(package)
    return bool(hidden) or stands_in_cmake(package, name) or name in list_used_names(view, package)
