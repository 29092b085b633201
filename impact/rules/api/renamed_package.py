"""renamed-package: a package that is used has another name on a target.

What it does
    As removed-package, for packages that live on under a new name.

Why it breaks
    The old name is installed by nothing there, and the new one by nothing on older targets.

Example
    <depend>hokuyo_node</depend>

Use instead
    <depend condition="$ROS_DISTRO == melodic">old_name</depend>
    <depend condition="$ROS_DISTRO != melodic">new_name</depend>
"""

from ...model.view import View
from ..rule import rule
from .removed_package import gone_packages


@rule(severity="error")
def renamed_package(view: View):
    yield from gone_packages(view, "package-renamed")
