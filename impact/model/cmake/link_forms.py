"""How a target is linked to a package that is found: its imported targets, or else its variables."""

from __future__ import annotations

from typing import NamedTuple

from ...targets.providers.libraries import load_libraries
from ...targets.providers.library import list_variables
from ...targets.surface.surface import BuildSurface
from ..view import TargetView
from ..workspace import Package
from .links import list_exported_targets

# What has no more than that on a target was not read, or is not linked.
_LINKED = ("library", "interface", "generated")


class LinkForm(NamedTuple):
    """What gives a target all that a package has for it. links: for target_link_libraries(); folders, definitions: for
    target_include_directories() and target_compile_definitions(), where its imported targets do not bring them."""

    links: tuple[str, ...] = ()
    folders: tuple[str, ...] = ()
    definitions: tuple[str, ...] = ()

    @property
    def items(self) -> tuple[str, ...]:
        """All of it."""
        return (*self.links, *self.folders, *self.definitions)


def find_link_form(view: TargetView, name: str) -> LinkForm | None:
    """How a target is linked to a package, by the name that find_package() takes; None where that is not known."""
    own = view.workspace.packages.get(name)
    if own is not None:
        return _read_own(own)
    offer = view.offers.find_package(name)
    if offer is not None:
        return _read_released(view, name, offer.build)
    return None if view.is_package(name) else _read_library(view, name)


def _read_own(package: Package) -> LinkForm | None:
    if package.is_interface_package:
        return LinkForm((f"${{{package.name}_TARGETS}}",))
    exports = [export for export in package.build.exports if export.how == "ament_export_targets"]
    spaces = {export.item: export.context or f"{package.name}::" for export in exports}
    links = []
    for target in list_exported_targets(package):
        sets = [i for i in package.build.installs if i.kind == "targets" and target.name in i.items and i.export]
        if target.conditions or len(sets) != 1 or sets[0].conditions or sets[0].export not in spaces:
            return None
        links.append(f"{spaces[sets[0].export]}{target.export_name or target.name}")
    return LinkForm(tuple(links)) if links and not any("$" in link for link in links) else None


def _read_released(view: TargetView, name: str, build: BuildSurface) -> LinkForm | None:
    unknown = {part for part, _ in build.unknown}
    generated = "targets" in unknown and any(target.kind == "generated" for target in build.targets)
    if generated and build.build_type == "ament_cmake":
        # Which type supports there are depends on what is installed.
        return LinkForm((f"${{{name}_TARGETS}}",))
    if "targets" in unknown or not all(target.sure for target in build.targets):
        return None
    links = tuple(target.name for target in build.targets if target.kind in _LINKED)
    if links:
        return LinkForm(links) if not any(target.kind == "unknown" for target in build.targets) else None
    if build.build_type != "ament_cmake" or "libraries" in unknown or not (build.include_dirs or build.libraries):
        return None
    # Its variables hold those of what it exports, but not the imported targets of these.
    forms = [find_link_form(view, dependency) for dependency in build.dependencies if dependency != name]
    known = [form for form in forms if form is not None]
    if len(known) < len(forms):
        return None
    libraries = (f"${{{name}_LIBRARIES}}",) if build.libraries else ()
    folders = (f"${{{name}_INCLUDE_DIRS}}",) if build.include_dirs else ()
    return LinkForm(
        tuple(dict.fromkeys((*libraries, *(link for form in known for link in form.links)))),
        tuple(dict.fromkeys((*folders, *(folder for form in known for folder in form.folders)))),
        tuple(dict.fromkeys(definition for form in known for definition in form.definitions)),
    )


def _read_library(view: TargetView, name: str) -> LinkForm | None:
    """A library of the platform: its one imported target, else the variables that find_package() is known to set."""
    libraries = load_libraries()
    owners = view.list_libraries(name)
    for library in owners if len(owners) == 1 else ():
        versions = libraries.find_range(library, view.target.platform)
        builds = [libraries.build(library, version) for version in versions if version]
        exported = {build.targets if build is not None and name in build.cmake_names else () for build in builds}
        if len(versions) == len(builds) and len(exported) == 1:
            (targets,) = exported
            if len(targets) == 1 and targets[0].sure and not any(build.unknown for build in builds if build):
                return LinkForm((targets[0].name,))
    variables = list_variables(name) or frozenset()
    if not variables.issuperset((f"{name}_LIBRARIES", f"{name}_INCLUDE_DIRS")):
        return None
    definitions = (f"${{{name}_DEFINITIONS}}",) if f"{name}_DEFINITIONS" in variables else ()
    return LinkForm((f"${{{name}_LIBRARIES}}",), (f"${{{name}_INCLUDE_DIRS}}",), definitions)
