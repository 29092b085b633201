"""package-linked-by-name: a target links the bare name of a package that has no library.

What it does
    Reports names of found packages in link_target_libraries() where the package has no compiled library and exports no
    target of that name.

Why it breaks
    CMake passes a name that is not a target to the linker, which stops: "cannot find -lname".

Severity
    error; warning in tests of ROS 1 and under a condition that cannot be decided.

Example
    target_link_libraries(arm pluginlib)

Use instead
    target_link_libraries(arm pluginlib::pluginlib)

Not reported
    Packages of catkin; packages whose exports are not known; names that a system library may have.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(
    texts=Text(
        "`{target}` links `{subject}`, but package `{subject}` has no library",
        "[[link `{replacement}`]]",
    ),
)
def package_linked_by_name(view: TargetView, package: Package):
    own = {t.name for t in package.build.targets} | {t.output_name for t in package.build.targets}
    found = {f.name for f in package.build.found if f.how in ("find_package", "declared")} - own
    seen = set()
    if package.build_type != "ament_cmake" or package.build.unresolved:
        return
    for target in package.build.targets if found else ():
        if target.static or target.kind not in ("executable", "library", "module", "test"):
            continue
        for link in target.links:
            name, conditions = link.item, link.conditions
            if link.how != "link" or name not in found or name in seen or not view.applies(conditions):
                continue
            exported = _list_exported(view, name)
            if exported is None or name in exported:
                continue
            seen.add(name)
            role = "test" if target.kind == "test" or any("TESTING" in c.text for c in conditions) else "build"
            known = tuple(c for c in conditions if "TESTING" not in c.text)
            data = {"target": target.name, "replacement": exported[0] if len(exported) == 1 else ""}
            yield Diagnostic(link.at, name, package.name, data, doubts=list_place_doubts(view, role, known))


def _list_exported(view: TargetView, name: str) -> list[str] | None:
    """The targets that a package without compiled libraries has for others; None for any other package."""
    if view.target.resolve(name) is not None or view.providers.find_installed_cmake(name):
        return None
    own = view.workspace.packages.get(name)
    if own is not None:
        compiled = own.build.unresolved or any(t.kind not in ("interface", "custom", "test") for t in own.build.targets)
        return None if compiled else [t.export_name or t.name for t in own.build.targets if t.kind == "interface"]
    offer = view.offers.find_package(name)
    if offer is None or not offer.exact or any(part in ("targets", "libraries") for part, _ in offer.build.unknown):
        return None
    compiled = offer.build.libraries or any(target.kind != "interface" for target in offer.build.targets)
    return None if compiled else [target.name for target in offer.build.targets]
