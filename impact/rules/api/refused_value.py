"""refused-value: a parameter of a released node or plugin is set to a value of another type than its default has.

What it does
    Reports numbers, truth values and lists that parameter files of ROS 2 set for nodes and plugins of released
    packages, where the target's version of the package declares the parameter with a default of another type. Whose a
    parameter is, is told by the `plugin:` beside it, the `type:` that the controller manager has for the node, or the
    launch files that start the node.

Why it breaks
    From Galactic on, no type of a parameter is converted into another, also no integer into a double: declaring the
    parameter throws InvalidParameterTypeException, and the node stops, or does not load the plugin.

Example
    progress_checker:
      plugin: "nav2_controller::SimpleProgressChecker"
      required_movement_radius: 1         # a double, 0.5 by default

Use instead
    required_movement_radius: 1.0

Not reported
    Defaults that are computed; a whole number as the default of what is set to a real one, since the type may be given
    beside it; texts, which launch files often replace; nodes of packages that have several programs; names that several
    plugins of a package declare with different types; tests; parameter files of ROS 1.
"""

from ...model.refused_settings import RefusedSetting, list_refused_settings
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .diagnosis import is_of_another_distro


@rule(
    severity="warning",
    preview=True,
    texts=Text(
        "the parameter `{subject}` is set to {article} {given}, and {upstream} {version} declares it as {declared} "
        "(default: `{default}`)",
        help="{remedy}",
    ),
)
def refused_value(view: TargetView, package: Package):
    files = frozenset(package.linked.files)
    for refused in list_refused_settings(view, package):
        if is_of_another_distro(view, refused.use.at.path, files):
            continue
        data = {
            "article": "an" if refused.use.type.startswith("integer") else "a",
            "given": refused.use.type,
            "upstream": refused.package,
            "version": refused.version,
            "declared": refused.declared,
            "default": refused.default,
            "remedy": _make_remedy(refused),
        }
        yield Diagnostic(refused.use.at, refused.use.name, package.name, data)


def _make_remedy(refused: RefusedSetting) -> str:
    if (refused.use.type, refused.declared) == ("integer", "double"):
        return f"write `{refused.use.text}.0`"
    return f"give a value of type {refused.declared}"
