"""export-without-components: dependants find an exported library without the components that they need.

What it does
    Reports packages of ament that export a library whose configuration has components, such as Boost or Qt, by
    ament_export_dependencies(), which finds it without any: where its configuration stops without components, and where
    an exported target links a component publicly.

Why it breaks
    find_package() of the package stops at the library's configuration, or at a target that it does not define.

Example
    ament_export_dependencies(Boost)            # and the exported target links Boost::filesystem publicly

Use instead
    ament_package(CONFIG_EXTRAS cmake/boost.cmake)      # which calls find_package(Boost REQUIRED COMPONENTS filesystem)

Not reported
    Libraries that a file of CONFIG_EXTRAS finds with components; links that are private.
"""

from collections.abc import Iterator

from ...model.cmake.links import list_exported_targets, list_public_links, resolve_package
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .ament_exports import AmentExports, read_ament_exports

_COMPONENTS = "find it with its components in a file given to ament_package(CONFIG_EXTRAS ...)"


@rule(
    severity="warning",
    group="missing-export",
    texts={
        "no components": Text(
            "dependants find `{subject}` without components, so its configuration stops", _COMPONENTS
        ),
        "component": Text(
            "`{target}` links `{item}` publicly, but dependants find {subject} without components", _COMPONENTS
        ),
    },
)
def export_without_components(view: TargetView, package: Package):
    ament = read_ament_exports(view, package)
    if ament is not None:
        yield from _list_without_components(view, package, ament)


# Packages whose configuration defines targets for the components asked for alone, and of these the components that need
# not be asked for; and those that are not found at all without components. Source: FindBoost in cmake-modules(7);
# Qt5Config.cmake and Qt6Config.cmake: of files of CMake the stored indices have the names alone.
_COMPONENTS_ALONE = {"Boost": frozenset({"boost", "headers"}), "Qt5": frozenset(), "Qt6": frozenset()}
_NONE_WITHOUT = frozenset({"Qt5", "Qt6"})


def _list_without_components(view: TargetView, package: Package, ament: AmentExports) -> Iterator[Diagnostic]:
    """Targets of components that an exported target passes on, whose package dependants find without components."""
    handed = {f.name for f in package.build.handed_on if f.components}
    seen: set[str] = set()
    for export in ament.exports:
        if export.how == "ament_export_dependencies" and export.item in _NONE_WITHOUT - handed - seen:
            seen.add(export.item)
            yield Diagnostic(export.at, export.item, package.name, kind="no components", doubts=(Doubt.DISTURBS,))
    for target in list_exported_targets(package):
        if not view.is_sure(target.conditions):
            continue
        for link in list_public_links(target):
            head = resolve_package(link.item)
            if head not in _COMPONENTS_ALONE or head in seen or head not in ament.dependencies or head in handed:
                continue
            asked = {name for f in package.build.found if f.name == head for name, _ in f.components}
            rest = link.item.partition("::")[2]
            names = ({rest} & asked if rest else asked if link.how == "ament" else set()) - _COMPONENTS_ALONE[head]
            if names:
                seen.add(head)
                data = {"target": target.name, "item": f"{head}::{min(names)}"}
                yield Diagnostic(link.at, head, package.name, data, "component", (Doubt.DISTURBS,))
