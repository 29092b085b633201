"""unreleased-package: a declared package is released in ROS, but not on a target.

What it does
    Reports dependencies on packages that some distro has released and the target's distro, at its date, has not, when
    the workspace does not bring them either.

Why it breaks
    Nothing can install the package there: `rosdep install` fails, find_package fails, the node does not start.

Severity
    error, since `rosdep install` stops; warning where the package waits for the first sync on another platform (whoever
    is there has ros-testing until then), and where a .repos or .rosinstall file of the workspace may bring it, since
    people also build dependencies from source in an underlay (name it in `[workspace] underlays`, `repos` or
    `private`).

Example
    <depend>moveit_plugins</depend>             # on a distro where MoveIt is not released

Use instead
    The package's successor there, a `.repos` file that brings the source, or
    <depend condition="$ROS_DISTRO != kilted">moveit_plugins</depend>

Not reported
    Packages of the workspace, names listed in `[workspace] private`, dependencies under a condition that does not hold
    on the target, and packages with a known successor (renamed-package and removed-package say it). Assumed is that
    whatever the distro names at its last sync can be installed from its archive: which packages the build farm failed
    to build, or leaves out on a platform, is not recorded where it could be read.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_LISTED = "[[; `{listed}` lists its repository, which is not imported]]"
_HELP = "[[vcs import < {listed}, or ]]bring its source into the workspace, or put a condition on the dependency"


@rule(
    texts={
        "never": Text(
            f"`{{subject}}` is not released in {{distro}}[[ (last released in {{last}})]]{_LISTED}", _HELP
        ),
        "later": Text(f"`{{subject}}` was not released in {{distro}} on that date{_LISTED}", _HELP),
        "dropped": Text(f"`{{subject}}` is no longer released in {{distro}} (since {{day}}){_LISTED}", _HELP),
        "waiting": Text(
            f"`{{subject}}` waits for the next sync of {{distro}}{_LISTED}", f"use ros-testing, or {_HELP}"
        ),
    },
)
def unreleased_package(view: TargetView, package: Package):
    target = view.target
    beside = view.underlaid or view.workspace.outside.lists_repositories
    seen = set()
    for dependency in view.list_dependencies(package):
        name = dependency.name
        if name in seen or view.is_available(name):
            continue
        if any(found.state == "removed" for found in view.find_reviewed("package", name)):
            continue  # removed-package or renamed-package says so
        if not target.was_ever_released(name) or view.is_private(name) or view.find_successor(name):
            continue
        if view.may_be_in_submodule(name):
            continue
        seen.add(name)
        last = target.find_last_distro(name)
        waits = (testing := target.find_testing()) is not None and testing.find_version(name) is not None
        releases = tuple(target.list_releases(name))
        before = [day for day, version in releases if day <= target.date and version is None]
        kind = "waiting" if waits else "dropped" if before else "later" if releases else "never"
        listing = view.find_listing(name)
        listed = listing[0] if listing is not None else ""
        yield Diagnostic(
            view.find_place(package, dependency),
            name,
            package.name,
            {"distro": target.distro, "last": last, "day": before[-1] if before else "", "listed": listed},
            kind=kind,
            doubts=(not (beside or (waits and target.moving)) or Doubt.INCOMPLETE,),
        )
