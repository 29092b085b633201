"""other-qt: a package finds Qt 4 beside rviz or rqt, which are built with Qt 5.

What it does
    Reports packages that find Qt4 and not Qt 5, and depend on rviz or rqt_gui_cpp of a version that is built with Qt 5:
    since rviz 1.12 in Kinetic.

Why it breaks
    Plugins of both Qt versions in one program: the linker or the loader stops, or the program crashes.

Severity
    error; warning where Qt 4 is optional, or found under a condition that is not known.

Example
    find_package(Qt4 REQUIRED COMPONENTS QtCore QtGui)

Use instead
    find_package(Qt5 REQUIRED COMPONENTS Core Widgets)

Not reported
    Packages that find Qt 5 too.
"""

from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    group="library-component",
    texts=Text(
        "`{package}` finds Qt 4, but rviz {version} is built with Qt 5", "find_package(Qt5 COMPONENTS Core Widgets)"
    ),
)
def other_qt(view: TargetView, package: Package):
    rviz = view.target.find_version("rviz") or ""
    if not rviz or not is_at_least(rviz, "1.12"):
        return
    found = {f.name: f for f in package.build.found if f.how == "find_package"}
    qt4 = found.get("Qt4")
    if qt4 is None or found.keys() & {"Qt5Widgets", "Qt5"}:
        return
    if view.collect_declared(package).keys() & {"rviz", "rqt_gui_cpp"}:
        doubts = (qt4.required or Doubt.OPTIONAL, view.is_sure(qt4.conditions) or Doubt.CONDITIONAL)
        yield Diagnostic(qt4.at, "Qt4", package.name, {"version": rviz}, doubts=doubts)
