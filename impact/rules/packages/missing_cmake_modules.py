"""missing-cmake-modules: a find module comes with cmake_modules, and that is not found before it.

What it does
    Reports find_package() of ROS 1 packages whose find module (`FindEigen.cmake`) neither CMake nor the package has: it
    comes with the package cmake_modules, which puts it on CMake's path once it is found itself.

Why it breaks
    CMake stops: "Could not find a package configuration file". Until Hydro catkin had these modules itself.

Severity
    error for a package that is required; warning under a condition that is not known; note for others.

Example
    find_package(catkin REQUIRED COMPONENTS roscpp)
    find_package(TinyXML REQUIRED)

Use instead
    find_package(catkin REQUIRED COMPONENTS roscpp cmake_modules)
    find_package(TinyXML REQUIRED)

Not reported
    Packages with a module of their own; libraries whose platform package has a configuration for CMake; packages one of
    whose catkin components finds cmake_modules in turn.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    group="missing-find-package",
    texts=Text(
        "`Find{name}.cmake` comes with `{subject}`, which CMakeLists.txt does not find",
        "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...) and to package.xml",
    ),
)
def missing_cmake_modules(view: TargetView, package: Package):
    if view.target.ros != 1 or view.target.distro in ("groovy", "hydro"):
        return
    if package.build_type != "catkin":
        return
    names = view.roles.list_found_with(package.build.catkin_components) | {f.name for f in package.build.found}
    own = {p.rsplit("/", 1)[-1] for p in package.files if p.endswith(".cmake")}
    for found in package.build.found:
        if found.how != "find_package" or f"Find{found.name}.cmake" in own:
            continue
        if not any(p.kind == "ros" and p.name == "cmake_modules" for p in view.providers.find_cmake(found.name)):
            continue
        if "cmake_modules" in names or view.providers.list_cmake_platforms(found.name):
            continue
        needed = found.required or (found.name == "Eigen" and _lacks_eigen(view, package))
        doubts = (
            needed or Doubt.DISPENSABLE,
            found.required or Doubt.OPTIONAL,
            view.is_sure(found.conditions) or Doubt.CONDITIONAL,
        )
        yield Diagnostic(found.at, "cmake_modules", package.name, {"name": found.name}, doubts=doubts)


def _lacks_eigen(view: TargetView, package: Package) -> bool:
    """True when code that is built here includes Eigen, whose headers lie in a folder of their own, and nothing that is
    found brings it."""
    found = {f.name for f in package.build.found} - {"Eigen"}
    if any("$" in name for name in found):
        return False
    reached = view.list_transitive({*found, *(p.name for name in found for p in view.find_cmake(name)[:1])})
    return any(
        need.how == "include" and need.subject.startswith(("Eigen/", "unsupported/Eigen/"))
        and need.role == "build" and need.certain and not view.is_met(need.providers, reached)
        for need in view.list_needs(package)
    )  # fmt: skip
