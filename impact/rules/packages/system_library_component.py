"""system-library-component: catkin is asked for a system library as for one of its packages.

What it does
    Reports components of find_package(catkin) that are system libraries on the target, and no packages of catkin.

Why it breaks
    CMake stops: catkin looks for the configuration file of a package of that name.

Severity
    error; warning for components that are not required, where an underlay may have a package of that name, and where
    code includes headers below a folder called so, of which none is known; note for keys that install programs alone,
    since a package of that name may be meant.

Example
    find_package(catkin REQUIRED COMPONENTS roscpp bullet)

Use instead
    find_package(catkin REQUIRED COMPONENTS roscpp)
    find_package(Bullet REQUIRED)

Not reported
    Names that were found before on their own, since CMake remembers where; packages of the workspace.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    group="missing-find-package",
    texts=Text(
        "`{subject}` is a system library in {distro}, not a catkin component",
        "find_package({subject} REQUIRED), or pkg-config, on its own",
    ),
)
def system_library_component(view: TargetView, package: Package):
    if not package.is_ros_cmake:
        return
    before: set[str] = set()  # what is found again, since CMake remembers where it is
    for found in package.build.found:
        name = found.name
        if found.how == "find_package":
            before.add(name)
        if found.how != "catkin" or name == "catkin" or name in before or not view.is_sure(found.conditions):
            continue
        if found.quiet and not found.required:
            continue
        if name in view.workspace.packages or view.target.find_version(name) is not None or view.is_private(name):
            continue
        key = view.target.resolve(name) is not None
        if not key and not any(p.kind == "system" and view.target.resolve(p.name) for p in view.find_cmake(name)):
            continue
        unsure = view.underlaid or view.means_package(name)
        doubts = (found.required or Doubt.OPTIONAL, not unsure or Doubt.INCOMPLETE)
        if view.is_program(name):  # most likely a package from source has its name
            doubts = (Doubt.PRIVATE,)
        yield Diagnostic(found.at, name, package.name, {"distro": view.target.distro}, doubts=doubts)
