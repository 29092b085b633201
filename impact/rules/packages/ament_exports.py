"""The exports of ament packages, as the rules on them ask for it."""

from collections.abc import Iterable
from typing import NamedTuple

from ...model.cmake.build import CMakeExport
from ..vocabulary import Package, TargetView

_HOWS = frozenset(
    {"ament_export_targets", "ament_export_libraries", "ament_export_include_directories", "ament_export_dependencies"}
)


class AmentExports(NamedTuple):
    """What an ament package exports. exports: all of them. dependencies: the packages of
    ament_export_dependencies(). found: all that dependants find along with it."""

    exports: tuple[CMakeExport, ...]
    dependencies: frozenset[str]
    found: frozenset[str]

    @property
    def hows(self) -> frozenset[str]:
        """The commands that export something."""
        return frozenset(export.how for export in self.exports)


def read_ament_exports(view: TargetView, package: Package) -> AmentExports | None:
    """The exports of an ament package, or of one of plain CMake that installs a configuration of its own; None where it
    exports nothing, or where what it exports cannot be seen."""
    handed = {f.name for f in package.build.handed_on}
    if package.build.ament_package is None:
        written = package.build.catkin_package is None and any(i.kind == "export" for i in package.build.installs)
        if not handed or not written:
            return None
        near = {provider.name for name in handed for provider in view.find_cmake(name)[:1]}
        return AmentExports((), frozenset(), frozenset(handed) | view.list_transitive(near))
    exports = package.build.exports
    dependencies = frozenset(e.item for e in exports if e.how == "ament_export_dependencies")
    if not exports_something(exports) or any("$" in name for name in dependencies):
        return None
    if package.build.finds_declared:
        return None
    return AmentExports(exports, dependencies, view.roles.list_found_with(dependencies | handed))


def exports_something(exports: Iterable[CMakeExport]) -> bool:
    """Whether a package of ament calls a command that exports packages, targets, libraries or include directories."""
    return any(export.how in _HOWS for export in exports)
