"""catkin-package-order: catkin_package() is called after a target is added, or before messages are generated.

What it does
    Reports libraries and programs that CMake adds before it comes to catkin_package(), or to a macro that calls
    catkin_destinations(), as generate_messages() does. Reports generate_messages() and
    generate_dynamic_reconfigure_options() that are called after catkin_package().

Why it breaks
    It sets where targets are built and what they export: those that were added before it land in the build folder
    instead of the devel space, where nothing that depends on the package, and no rosrun, finds them. The macros stop:
    "generate_messages() must be called before catkin_package()".

Severity
    error for macros that stop; warning for targets, since installed packages do without the devel space.

Example
    add_library(arm src/arm.cpp)
    catkin_package(LIBRARIES arm)

Use instead
    catkin_package(LIBRARIES arm)
    add_library(arm src/arm.cpp)

Not reported
    Tests; targets under a condition that is unknown on the target; packages that never call catkin_package(), which
    missing-package-call reports.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .refused_names import diagnose_refused


@rule(
    texts={
        "": Text("`{subject}()` is called after catkin_package(), so it stops", "call it before catkin_package()"),
        "targets": Text(
            "catkin_package() is called after {targets}", "call it before add_library() and add_executable()"
        ),
    },
)
def catkin_package_order(view: TargetView, package: Package):
    yield from diagnose_refused(view, package, "late")
    call = package.build.catkin_package
    if package.build_type != "catkin" or call is None:
        return
    before = set(package.build.before_catkin_destinations)
    early = tuple(
        target.name
        for target in package.build.targets
        if target.name in before
        and target.kind in ("library", "executable", "module")
        and view.is_sure(target.conditions)
    )
    if early:
        yield Diagnostic(call, "catkin_package", package.name, {"targets": early}, "targets", (Doubt.DISTURBS,))
