"""What catkin is asked to find, and cannot: find modules, system libraries as components; and ROS's include folder."""

from ...model.view import View
from ..rule import Diagnostic
from ..severity import Doubt
from ..text import Text

TEXTS = {
    "find module": Text(
        "`Find{name}.cmake` comes with `{subject}`, which CMakeLists.txt does not find",
        "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...) and to package.xml",
    ),
    "include directories": Text(
        "`{target}` includes `{header}` but does not get {subject}", "include_directories(${{catkin_INCLUDE_DIRS}})"
    ),
    "component": Text(
        "`{subject}` is a system library in {distro}, not a catkin component",
        "find_package({subject} REQUIRED), or pkg-config, on its own",
    ),
}

# Find modules that cmake_modules puts on CMake's path, once it is found itself. Catkin did so until Hydro.
_FIND_MODULES = frozenset({"Eigen", "NUMPY", "TBB", "TinyXML", "TinyXML2", "UUID", "Xenomai", "GSL"})


def check_find_modules(view: View, package):
    """find_package calls whose find module comes with a package that is not found before."""
    if package.build_type != "catkin" or view.target.ros != 1 or view.target.distro in ("groovy", "hydro"):
        return
    names = {f.name for f in package.build.found}
    own = {p.rsplit("/", 1)[-1] for p in package.files if p.endswith(".cmake")}
    for found in package.build.found:
        if found.name not in _FIND_MODULES or found.how != "find_package" or f"Find{found.name}.cmake" in own:
            continue
        if "cmake_modules" in names or view.providers.cmake_platforms(found.name) or not view.active(found.conditions):
            continue
        needed = found.required or (found.name == "Eigen" and _lacks_eigen(view, package))
        doubts = (
            needed or Doubt.DISPENSABLE,
            found.required or Doubt.OPTIONAL,
            view.certain(found.conditions) or Doubt.CONDITIONAL,
        )
        yield Diagnostic(found.at, "cmake_modules", package.name, {"name": found.name}, "find module", doubts)


def _lacks_eigen(view: View, package) -> bool:
    """True when code that is built here includes Eigen, whose headers lie in a folder of their own, and nothing that is
    found brings it."""
    found = {f.name for f in package.build.found} - {"Eigen"}
    if any("$" in name for name in found):
        return False
    reached = view.spread({*found, *(p.name for name in found for p in view.cmake(name)[:1])})
    return any(
        need.how == "include" and need.subject.startswith(("Eigen/", "unsupported/Eigen/"))
        and need.role == "build" and need.certain and not view.answered(need.providers, reached)
        for need in view.needs(package)
    )  # fmt: skip


def check_include_directories(view: View, package):
    """catkin packages that are found, and whose include directories no target gets."""
    build = package.build
    if package.build_type != "catkin" or not any(f.how == "catkin" for f in build.found) or build.unresolved:
        return
    given = " ".join(
        [item for item, _ in build.include_dirs]
        + [link.item for t in build.targets for link in t.links if link.how == "include"]
    )
    if "catkin_INCLUDE_DIRS" in given or "/opt/ros" in given:
        return
    if any(f"{f.name}_INCLUDE_DIRS" in given for f in build.found if f.how == "catkin"):
        return  # all of /opt/ros lies in one folder
    for target in build.targets:
        if target.kind not in ("executable", "library") or not view.certain(target.conditions):
            continue
        include = next(
            (
                i
                for i in package.digest.includes
                if target.name in i.targets
                and view.certain(i.conditions)
                and any(p.kind == "ros" and p.name not in view.workspace.packages for p in view.header(i.path))
            ),
            None,
        )
        if include is not None:
            data = {"target": target.name, "header": include.path}
            doubts = (Doubt.LUCKY,) if view.target.distro in _WITH_CPATH else ()
            subject = "catkin_INCLUDE_DIRS"
            yield Diagnostic(target.at, subject, package.name, data, "include directories", doubts)
            return


# Distros whose setup files put the include folder of ROS into CPATH. Source: catkin's change log, 0.7.0.
_WITH_CPATH = ("groovy", "hydro", "indigo", "jade")


def check_components(view: View, package):
    """Components asked of catkin that are system libraries on the target, which catkin cannot find as components. One
    that was found before is found again: CMake remembers where it is."""
    before: set[str] = set()
    for found in package.build.found:
        name = found.name
        if found.how == "find_package":
            before.add(name)
        if found.how != "catkin" or name == "catkin" or name in before or not view.certain(found.conditions):
            continue
        if found.quiet and not found.required:
            continue
        if name in view.workspace.packages or view.target.version(name) is not None or view.private(name):
            continue
        key = view.target.resolve(name) is not None
        if not key and not any(p.kind == "system" and view.target.resolve(p.name) for p in view.cmake(name)):
            continue
        doubts = (found.required or Doubt.OPTIONAL, not view.underlaid or Doubt.INCOMPLETE)
        yield Diagnostic(found.at, name, package.name, {"distro": view.target.distro}, "component", doubts)
