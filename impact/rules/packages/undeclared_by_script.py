"""undeclared-by-script: a CMake script that dependants run finds a package that package.xml does not hand on.

What it does
    Reads the scripts that a package gives to those who find it (CONFIG_EXTRAS, CFG_EXTRAS, what they include, and
    extensions that they register), and compares the packages that these scripts require with package.xml.

Why it breaks
    find_package() of the package stops on a machine that has only what package.xml declares, in every dependant.

Example
    find_package(rmw REQUIRED)      # in arm-extras.cmake, and package.xml has only <build_depend>rmw</build_depend>

Use instead
    <build_export_depend>rmw</build_export_depend>

Not reported
    Packages that declared ones bring along, optional ones, and those under a condition that is unknown on the target.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_TOOLS = frozenset({"ament_cmake", "ament_cmake_auto", "ament_cmake_ros", "catkin"})
_HANDED_ON = frozenset({"build_export", "buildtool_export", "exec"})


@rule(
    doubts=(Doubt.DISTURBS,),
    texts=Text(
        "a script that dependants run finds `{found}`, but package.xml does not export `{subject}`",
        help="add `<build_export_depend>{subject}</build_export_depend>` to {manifest}",
    ),
)
def undeclared_by_script(view: TargetView, package: Package):
    if not package.build.handed_on:
        return
    declared = view.collect_declared(package)
    # Who finds the package builds with the same tool.
    closure = view.list_transitive(n for n, kinds in declared.items() if kinds & _HANDED_ON or n in _TOOLS)
    reported = {package.name}
    for found in package.build.handed_on:
        if not found.required or not view.is_sure(found.conditions) or found.name in reported or "$" in found.name:
            continue
        reported.add(found.name)
        providers = view.find_cmake(found.name)
        ros = bool(providers) and all(p.kind == "ros" for p in providers)
        own = any(p.name == package.name for p in providers)  # it brings a library that others find by another name
        if not ros or own or view.is_met(providers, closure) or view.unknown_contents.may_come_along(package):
            continue
        name = providers[0].name
        data = {"found": found.name, "manifest": package.linked.manifest_path}
        yield Diagnostic(found.at, name, package.name, data)
