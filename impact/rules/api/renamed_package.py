"""renamed-package: a package that is used has another name, or a successor, on a target.

What it does
    As removed-package, for packages that live on under a new name: at least half of their headers, modules, programs
    and interfaces are there. Another package that took over the task is said to be a successor with another API.

Why it breaks
    The old name is installed by nothing there, and the new one by nothing on older targets. Code that uses a package
    which ended has to be ported to its successor.

Severity
    error for a build or run dependency and for a find_package(REQUIRED) that surely counts on the target; warning for
    dependencies of tests and documentation, for optional or guarded calls, and for the first use of a package that is
    still there; note for such calls that ask for a package of the other generation of ROS, and for the other uses.

Example
    <exec_depend>ros_ign_bridge</exec_depend>           <!-- ros_gz_bridge since Jazzy -->

Use instead
    <exec_depend condition="$ROS_DISTRO == humble">ros_ign_bridge</exec_depend>
    <exec_depend condition="$ROS_DISTRO != humble">ros_gz_bridge</exec_depend>

Not reported
    Names that the workspace, the target's distro or rosdep provides all the same; dependencies under a condition that
    does not hold on the target; what find_package(... QUIET) looks for where a test of its X_FOUND follows.
"""

from ..vocabulary import Package, TargetView, rule
from .removed_package import TEXTS, list_gone_packages


@rule(texts=TEXTS)
def renamed_package(view: TargetView, package: Package):
    return list_gone_packages(view, package, "renamed")
