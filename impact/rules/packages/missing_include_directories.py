"""missing-include-directories: a package of catkin finds others and no target gets their include directories.

What it does
    Reports packages that call find_package(catkin REQUIRED COMPONENTS ...), compile headers of ROS, and use
    `catkin_INCLUDE_DIRS` nowhere.

Why it breaks
    The compiler stops: "No such file or directory". Until Jade the setup files of ROS put its folder on CPATH.

Severity
    error since Kinetic; warning before.

Example
    add_executable(node src/node.cpp)           # and no include_directories(${catkin_INCLUDE_DIRS})

Use instead
    include_directories(${catkin_INCLUDE_DIRS})

Not reported
    Packages that use the include directories of any package of ROS, since all of ROS lies in one folder; headers that a
    system package has too.
"""

import re

from ...targets.platform import strip_to_letters
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    group="missing-find-package",
    texts=Text(
        "`{target}` includes `{header}` but does not get {subject}", "include_directories(${{catkin_INCLUDE_DIRS}})"
    ),
)
def missing_include_directories(view: TargetView, package: Package):
    if package.build_type != "catkin":
        return
    build = package.build
    if not build.catkin_components or build.unresolved:
        return
    given = " ".join(
        [item for item, _ in build.include_dirs]
        + [link.item for link in build.target_links if link.how == "include"]
    )
    if "catkin_INCLUDE_DIRS" in given or "/opt/ros" in given:
        return
    if any(f"{name}_INCLUDE_DIRS" in given for name in build.catkin_components):
        return  # all of /opt/ros lies in one folder
    for target in build.targets:
        if target.kind not in ("executable", "library") or not view.is_sure(target.conditions):
            continue
        own = (i for i in package.linked.includes if target.name in i.targets and view.is_sure(i.conditions))
        include = next((i for i in own if _is_released(view, i.path) and not _is_given(package, i.path, given)), None)
        if include is not None:
            data = {"target": target.name, "header": include.path}
            doubts = (Doubt.LUCKY,) if view.target.distro in _WITH_CPATH else ()
            subject = "catkin_INCLUDE_DIRS"
            yield Diagnostic(target.at, subject, package.name, data, doubts=doubts)
            return


def _is_released(view: TargetView, path: str) -> bool:
    """Whether nothing but released packages has a header: the system's own folder is searched in any case."""
    providers = view.find_header(path)
    return bool(providers) and all(p.kind == "ros" and p.name not in view.workspace.packages for p in providers)


def _is_given(package: Package, path: str, given: str) -> bool:
    """Whether a header may lie in a folder that a package gives which is found on its own, and called as the header's
    folder is: `${Sophus_INCLUDE_DIRS}` for `sophus/se3.h`."""
    head = strip_to_letters(path.partition("/")[0])
    alone = {strip_to_letters(n) for f in package.build.found if f.how != "catkin" for n in (f.name, f.prefix) if n}
    variables = (strip_to_letters(name) for name in _FOLDERS.findall(given))
    return any(name in alone and (head.startswith(name) or name.startswith(head)) for name in variables)


_FOLDERS = re.compile(r"\$\{(\w+?)_INCLUDE_?(?:DIRS?|PATH)\}", re.IGNORECASE)
# Distros whose setup files put the include folder of ROS into CPATH. Source: catkin's change log, 0.7.0.
_WITH_CPATH = ("groovy", "hydro", "indigo", "jade")
