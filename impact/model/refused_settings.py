"""Values that files of parameters set for nodes and plugins of released packages, whose version on the target declares
the parameter with a default of another type.

The default tells the type as far as it is written: `0.5` is a double, `5` may be an integer or the default of a double.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ..targets.parameters import find_last_part
from ..targets.surface.offers import PackageOffer
from ..targets.version import is_at_least
from .package import ValueUse
from .undeclared_parameters import means
from .view import TargetView
from .workspace import Package

# Since Galactic.
_STRICT = "9.0.0"


class RefusedSetting(NamedTuple):
    """A value of another type than the parameter has. declared: the type of that, `number` for an integer or a double;
    default: as the package writes it."""

    use: ValueUse
    package: str
    version: str
    declared: str
    default: str


def list_refused_settings(view: TargetView, package: Package) -> Iterator[RefusedSetting]:
    """Those of the parameter files of a package of ROS 2, tests left out. Texts are not looked at, since launch files
    replace them by values."""
    version = view.target.find_version("rclcpp")
    if version is None or not is_at_least(version, _STRICT):
        return
    for use in package.linked.values:
        if use.role == "run" and use.package not in view.workspace.packages:
            yield from _check(view, use)


def _check(view: TargetView, use: ValueUse) -> Iterator[RefusedSetting]:
    offer = _find_owner(view, use)
    if offer is None:
        return
    last = find_last_part(use.name)
    declared_so = offer.history.list_parameters(offer.stored)
    named = [(name, default) for name, default in declared_so if find_last_part(name) == last]
    defaults = [default for name, default in named if means(name, use.name, of_plugin=bool(use.plugin))]
    types = {_find_default_type(default) for default in defaults}
    if len(types) != 1 or len(defaults) != len(named):
        return
    declared, default = types.pop(), defaults[0]
    if declared and default is not None and not _fits(use.type, declared):
        yield RefusedSetting(use, offer.package, offer.version, declared, default)


def _find_owner(view: TargetView, use: ValueUse) -> PackageOffer | None:
    """The package that has the node or plugin on the target."""
    offer = view.offers.find_package(use.package)
    if offer is None:
        return None
    if not use.plugin:
        # Which of several programs declares a parameter is not stored.
        return offer if {program.name for program in offer.build.programs} == {use.node} else None
    return offer if use.plugin in {name for one in offer.build.plugins for name in (one.name, one.type)} else None


def _find_default_type(default: str | None) -> str:
    """The type that a stored default shows, empty for none."""
    if default is None or default == "?":
        return ""
    if default in ("true", "false"):
        return "bool"
    if default[:1] == '"':
        return "string"
    if default[:1] == "{":
        kinds = {_find_default_type(item.strip()) for item in default.strip("{}").split(",")}
        kind = kinds.pop() if len(kinds) == 1 and '"' not in default else ""
        return f"{kind} array" if kind else ""
    try:
        float(default)
    except ValueError:
        return ""
    return "number" if default.lstrip("+-").isdecimal() else "double"


def _fits(given: str, declared: str) -> bool:
    if declared.startswith("number"):
        return given in (declared.replace("number", "integer"), declared.replace("number", "double"))
    return given == declared
