"""uninstalled-plugin-description: a description of plugins does not exist, is not installed or is not exported.

What it does
    Reports plugin descriptions that `<export>` of package.xml names with `${prefix}` but that do not exist, or that a
    catkin package does not install; and descriptions of plugins in a library of the package that are not exported.

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
    Descriptions that configure_file() makes; packages without CMake.
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
        "not exported": Text(_NOT_EXPORTED, "pluginlib_export_plugin_description_file({base} {subject})"),
        "not exported, catkin": Text(_NOT_EXPORTED, '<{base} plugin="${{prefix}}/{file}"/> in package.xml'),
    },
)
def uninstalled_plugin_description(view: TargetView, package: Package):
    installs = read_installs(view, package)
    if installs is not None:
        yield from _list_descriptions(view, package, installs)
        yield from _list_not_exported(view, package, installs)


def _list_descriptions(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Plugin descriptions that the manifest exports (catkin)."""
    for export in package.manifest.exports:
        value = export.attributes.get("plugin", "")
        if not value.startswith("${prefix}"):
            continue
        at, file = At(package.linked.manifest_path, export.line), value[len("${prefix}/") :]
        path = posixpath.normpath(posixpath.join(package.path, file))
        if is_installed(installs, path):
            continue
        if path not in package.files:
            if path + ".in" not in package.files:
                yield Diagnostic(at, file, package.name, kind="no description", doubts=(Doubt.DISTURBS,))
        elif package.build_type == "catkin":
            doubts = (_is_shipped(view, package, installs, path) or Doubt.DISTURBS,)
            yield Diagnostic(at, posixpath.basename(path), package.name, {"file": file}, "description", doubts)


def _is_shipped(view: TargetView, package: Package, installs, description: str) -> bool:
    """True when a library that the description names is installed, so that the plugins are there for others."""
    if package.build.unresolved:
        return False
    libraries = (posixpath.basename(c.library) for path, c in package.linked.plugins if path == description)
    names = {name.removeprefix("lib").removesuffix(".so") for name in libraries}
    return any(
        item in names and view.is_sure(i.conditions) for i in installs if i.kind == "targets" for item in i.items
    )


def _list_not_exported(view: TargetView, package: Package, installs) -> Iterator[Diagnostic]:
    """Descriptions of plugins in libraries of the package that nothing exports and nothing installs."""
    libraries = {t.output_name or t.name: t for t in package.build.targets if t.kind in ("library", "module")}
    exports = {value.rpartition("/")[2] for e in package.manifest.exports for value in e.attributes.values()}
    exports |= {posixpath.basename(e.item) for e in package.build.exports if e.how == "plugin_description"}
    seen = {p.type for path, p in package.linked.plugins if posixpath.basename(path) in exports}
    for path, plugin in package.linked.plugins:
        name = posixpath.basename(plugin.library).removeprefix("lib").removesuffix(".so")
        target = libraries.get(name)
        if plugin.type in seen or path in seen or target is None or is_installed(installs, path):
            continue
        aside = find_folder_role(package.strip_path(path))
        if aside or not path.endswith(".xml") or not view.is_sure(target.conditions):
            continue
        seen.add(path)
        base = plugin.base.partition("::")[0] or "BASE_PACKAGE"
        kind = "not exported, catkin" if package.build_type == "catkin" else "not exported"
        data = {"library": name, "base": base, "file": package.strip_path(path)}
        yield Diagnostic(At(path, 1), posixpath.basename(path), package.name, data, kind, (Doubt.DISTURBS,))
