"""What a package uses by name, as the rules on what it declares in vain ask for it."""

from ..vocabulary import Package, TargetView

OF_ENVIRONMENT = ("ros_environment", "roslib")
"""Packages whose use is that CMake reads the environment of ROS."""


def shows_uses(package: Package) -> bool:
    """Whether the files of a package tell what it uses: it is no metapackage, and has code or launch files."""
    linked = package.linked
    if package.manifest.metapackage or (package.build_type == "ament_python" and not linked.imports):
        return False
    return bool(linked.includes or linked.imports or linked.references)


def list_used_names(view: TargetView, package: Package) -> frozenset[str]:
    """Names of packages and keys that something in a package means: includes, imports, launch files, interfaces,
    exports, commands of CMake, words of YAML and robot descriptions, or the environment of ROS that CMake reads; also
    what they mean on other targets alone."""
    linked, build = view.workspace.packages.get(package.name, package).linked, package.build
    return frozenset((
        *(provider.name for need in view.list_needs(package) for provider in need.providers),
        *(name for made in build.generated for name, _ in made.dependencies),
        *(export.item for export in build.exports),
        *(f.type.split("/")[0] for i in linked.interfaces for s in i.definition.sections for f in s.fields),
        *(include.path.split("/", 1)[0] for include in linked.includes),
        *(item.module.split(".")[0] for item in linked.imports),
        *(use.reference.package for use in linked.references),
        *linked.named,
        *(OF_ENVIRONMENT if any(use.kind == "environment" for use in build.uses) else ()),
    ))  # fmt: skip


def stands_in_cmake(package: Package, name: str) -> bool:
    """Whether CMake looks for a name, links something called like it, or asks a variable that begins with it."""
    build = package.build
    return (
        any(name == found.name for found in build.found)
        or any(name in link.item for link in build.target_links)
        or any(use.name.startswith(name) for use in build.uses)
    )
