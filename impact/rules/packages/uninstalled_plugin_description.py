"""uninstalled-plugin-description: a description of plugins is not there, not installed, not exported or of no library.

What it does
    Reports plugin descriptions that `<export>` of package.xml names with `${prefix}` but that do not exist, or that a
    catkin package does not install; descriptions of plugins in a library of the package that are not exported, also
    those that package.xml alone exports in ROS 2; and exported descriptions whose library no package builds.

Why it breaks
    pluginlib reads the description from the install space, and finds its path in package.xml (ROS 2: in the index
    that export_plugin_description() writes). Without it, loading any plugin of the package fails.

Severity
    error where a library that the description names is installed, so that others expect its plugins; warning otherwise.

Example
    <nav_core plugin="${prefix}/planner_plugin.xml"/>                   # and install() leaves out planner_plugin.xml

Use instead
    install(FILES planner_plugin.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})

Not reported
    Descriptions that configure_file() makes; packages without CMake; libraries of packages that build none, and names
    that the package's folders have, as those of plugins in Python.
"""

import posixpath
from collections.abc import Iterator

from ...model.package import find_folder_role
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule
from .install_rules import is_installed, read_installs

_NOT_EXPORTED = "`{subject}` describes plugins of `{library}` but is not exported, so pluginlib does not find them"


@rule(
    group="missing-install",
    texts={
        "no description": Text("the exported plugin description `{subject}` does not exist", "correct the path"),
        "description": Text(
            "the exported plugin description `{subject}` is not installed",
            "install(FILES {file} DESTINATION ${{CATKIN_PACKAGE_SHARE_DESTINATION}})",
        ),
        "not exported, ament": Text(
            "`{subject}` is exported in package.xml, where ROS 2 does not look for plugin descriptions",
            "pluginlib_export_plugin_description_file({base} {file}) in CMakeLists.txt",
        ),
        "no library": Text(
            "the plugin description `{file}` names the library `{subject}`, which is not built",
            "name the library that has the plugins[[, such as `{built}`]]",
        ),
        "not exported": Text(_NOT_EXPORTED, "pluginlib_export_plugin_description_file({base} {subject})"),
        "not exported, catkin": Text(_NOT_EXPORTED, '<{base} plugin="${{prefix}}/{file}"/> in package.xml'),
    },
)
def uninstalled_plugin_description(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if installs is not None:
        yield from _list_descriptions(view, package, installs)
        yield from _list_not_exported(view, package, installs)
        yield from _list_not_built(view, package)


def _list_descriptions(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Plugin descriptions that the manifest exports (catkin)."""
    for export in package.manifest.exports:
        value = export.attributes.get("plugin", "")
        if not value.startswith("${prefix}"):
            continue
        line, column = export.places["plugin"]
        start = len("${prefix}/")
        at, file = At(package.linked.manifest_path, line, column + start), value[start:]
        path = posixpath.normpath(posixpath.join(package.path, file))
        if view.target.ros == 2 and view.is_available(export.tag) and _is_left_out(package, installs, path):
            data = {"base": export.tag, "file": file}
            yield Diagnostic(at, file, package.name, data, "not exported, ament", (Doubt.DISTURBS,))
        if is_installed(installs, path):
            continue
        if path not in package.files:
            if path + ".in" not in package.files:
                yield Diagnostic(at, file, package.name, kind="no description", doubts=(Doubt.DISTURBS,))
        elif package.build_type == "catkin":
            doubts = (_is_shipped(view, package, installs, path) or Doubt.DISTURBS,)
            yield Diagnostic(at, posixpath.basename(path), package.name, {"file": file}, "description", doubts)


def _is_left_out(package: Package, installs, path: str) -> bool:
    """Whether CMake exports no description at all, though one that is there has classes that sources of the package
    register."""
    own = {plugin.type for description, plugin in package.linked.plugins if description == path}
    known = package.build.unresolved or any(e.how == "plugin_description" for e in package.build.exports)
    indexed = any("resource_index" in install.destination or "$" in install.destination for install in installs)
    return not known and not indexed and not own.isdisjoint(package.linked.registered)


def _list_not_built(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Exported descriptions of a library that no package of the workspace builds, of packages that build others."""
    build, built = package.build, view.workspace.library_names
    own = sorted(t.name for t in build.targets if t.kind in ("library", "module") and not t.static)
    if not own or build.unresolved or build.builds_others or any("$" in name for name in built):
        return
    described = {e.item for e in build.exports if e.how == "plugin_description" and view.is_sure(e.conditions)}
    if build.catkin_package is not None:
        values = (e.attributes.get("plugin", "") for e in package.manifest.exports)
        described = {posixpath.join(package.path, value.removeprefix("${prefix}/")) for value in values}
    seen = set()
    for path, plugin in package.linked.plugins:
        name = plugin.library_name
        if path not in described or name in built or name in seen or "::" not in plugin.type or not name:
            continue
        seen.add(name)
        if "$" not in name and posixpath.join(package.path, plugin.library) not in package.folders:
            data = {"file": package.strip_path(path), "built": own[0] if len(own) == 1 else ""}
            yield Diagnostic(At(path, plugin.line), name, package.name, data, "no library", (Doubt.DISTURBS,))


def _is_shipped(view: TargetView, package: Package, installs, description: str) -> bool:
    """True when a library that the description names is installed, so that the plugins are there for others."""
    names = {plugin.library_name for path, plugin in package.linked.plugins if path == description}
    targets = [i for i in installs if i.kind == "targets" and not names.isdisjoint(i.items)]
    return not package.build.unresolved and any(view.is_sure(i.conditions) for i in targets)


def _list_not_exported(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Descriptions of plugins in libraries of the package that nothing exports and nothing installs."""
    libraries = {t.output_name or t.name: t for t in package.build.targets if t.kind in ("library", "module")}
    exports = {value.rpartition("/")[2] for e in package.manifest.exports for value in e.attributes.values()}
    exports |= {posixpath.basename(e.item) for e in package.build.exports if e.how == "plugin_description"}
    seen = {p.type for path, p in package.linked.plugins if posixpath.basename(path) in exports}
    for path, plugin in package.linked.plugins:
        target = libraries.get(plugin.library_name)
        if plugin.type in seen or path in seen or target is None or is_installed(installs, path):
            continue
        aside = find_folder_role(package.strip_path(path))
        if aside or not path.endswith(".xml") or not view.is_sure(target.conditions):
            continue
        seen.add(path)
        base = plugin.base.partition("::")[0] or "BASE_PACKAGE"
        kind = "not exported, catkin" if package.build_type == "catkin" else "not exported"
        data = {"library": plugin.library_name, "base": base, "file": package.strip_path(path)}
        yield Diagnostic(At(path, 1), posixpath.basename(path), package.name, data, kind, (Doubt.DISTURBS,))
