"""The order in which a workspace's packages are built: catkin_pkg's, which catkin follows."""

from .view import TargetView

# What catkin_pkg calls the dependencies of a kind.
_LISTS = {
    "build": "build_depends", "build_export": "build_export_depends", "buildtool": "buildtool_depends",
    "buildtool_export": "buildtool_export_depends", "exec": "exec_depends", "test": "test_depends",
}  # fmt: skip


def build_order(view: TargetView) -> list[str]:
    """Names of the workspace's packages, those first that others need; of those that do not need each other, by name.

    Dependencies under a condition that does not hold on the view's target do not count; those on a group do. Packages
    in a circle, and what needs them, come last.
    """
    from catkin_pkg.package import Dependency, Package
    from catkin_pkg.topological_order import topological_order_packages

    groups: dict[str, list[str]] = {}
    for package in view.workspace:
        for dependency in package.manifest.dependencies:
            if dependency.kind == "member_of_group":
                groups.setdefault(dependency.name, []).append(package.name)
    packages = {}
    for package in view.workspace:
        lists: dict[str, list[Dependency]] = {}
        for name, kinds in view.collect_declared(package).items():
            for kind in kinds & _LISTS.keys():
                lists.setdefault(_LISTS[kind], []).append(Dependency(name))
        for dependency in package.manifest.dependencies:
            if dependency.kind == "group" and view.is_declaration_active(dependency.condition):
                members = [Dependency(name) for name in groups.get(dependency.name, ()) if name != package.name]
                lists.setdefault("build_depends", []).extend(members)
        packages[package.name] = Package(name=package.name, **lists)
    order = [path for path, _ in topological_order_packages(packages) if path is not None]
    return [*order, *sorted(packages.keys() - set(order))]
