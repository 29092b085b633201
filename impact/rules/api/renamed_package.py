"""renamed-package: a package that is used has another name on a target.

What it does
    As removed-package, for packages that live on under a new name.

Why it breaks
    The old name is installed by nothing there, and the new one by nothing on older targets.

Severity
    error for a build or run dependency and for a find_package(REQUIRED) that surely counts on the target; warning for
    dependencies of tests and documentation, for optional or guarded calls, and for the first use of a package that is
    still there; note for such calls that ask for a package of the other generation of ROS, and for the other uses.

Example
    <exec_depend>nav2_recoveries</exec_depend>          <!-- nav2_behaviors since Humble -->

Use instead
    <exec_depend condition="$ROS_DISTRO == galactic">nav2_recoveries</exec_depend>
    <exec_depend condition="$ROS_DISTRO != galactic">nav2_behaviors</exec_depend>

Not reported
    Names that the workspace, the target's distro or rosdep provides all the same; dependencies under a condition that
    does not hold on the target; what find_package(... QUIET) looks for where a test of its X_FOUND follows.
"""

from ..vocabulary import Package, TargetView, rule
from .removed_package import TEXTS, list_gone_packages


@rule(texts=TEXTS)
def renamed_package(view: TargetView, package: Package):
    return list_gone_packages(view, package, "renamed")
