"""unknown-field: a field of a message is used that the target's definition of the message lacks.

What it does
    Reports fields and constants of messages, services and actions of other packages that the target's release of the
    package has no longer, or not yet; the same for interfaces that Python imports, also from packages of the workspace.
    Whose field it is, is told by the declared type of the variable, followed through nested messages. Says as well what
    goes when a dated target's distro is updated. Of interfaces that the workspace defines, reports fields that its
    Python files use and they lack; and imports of interfaces from packages of the workspace that have none.

Why it breaks
    The compiler stops with "has no member named"; Python raises an AttributeError when the line is reached, on the
    robot, or an ImportError.

Severity
    error for code that is built or run, tests of ROS 2 included; warning in tests of ROS 1, for an interface that is
    imported in a function, for the first of each package that only goes with an update of the distro, and where a
    telling name is used on something whose type does not show; note in examples, and for the rest of those.

Example
    request->start_controllers = {"arm"};       // controller_manager_msgs of Iron has activate_controllers

Use instead
    request->activate_controllers = {"arm"};

Not reported
    Code that a version test excludes on the target, or that stands under a test which cannot be known; variables whose
    type does not show, unless only one interface of those that the file uses has such a name; in C++, fields of
    interfaces that the workspace itself brings.
"""

from collections.abc import Iterator

from ...model.python.own_interfaces import get_own_interfaces, may_generate, may_have_interface
from ...targets.symbol import Symbol
from ..python_files import list_python_doubts
from ..vocabulary import (
    Diagnostic,
    Doubt,
    Package,
    TargetView,
    Text,
    Together,
    Upcoming,
    list_place_doubts,
    rate_upcoming,
    rule,
)
from .diagnosis import UPSTREAM, build_availability_texts, build_data, diagnose, find_missing

_MISSING = f"`{{interface}}` has no field `{{subject}}` in {UPSTREAM}"
_CODE = ("cpp", "python")
_HELP = "[[use `{replacement}`]][[perhaps `{alike}` replaces it]]"


@rule(
    scope="target",
    texts={
        **build_availability_texts(),
        "root": Text("`{interface}` does not have `{subject}`: it is in `{module}`", "import it from `{module}`"),
        "none": Text("`{interface}` has no interface `{module}`", "correct the name, or add the interface"),
        "no interfaces": Text("`{interface}` has no interfaces", "import them from the package that has them"),
        "own": Text("`{interface}` has no field `{subject}`", "use a field that it has"),
        "field removed": Text(f"{_MISSING}[[ (removed in {{since}})]]", _HELP),
        "field not yet": Text(f"{_MISSING}[[ (added in {{since}})]]", _HELP),
        "field upcoming": Text(
            f"`{{subject}}` of `{{interface}}` will be removed: not in {UPSTREAM} ({{horizon}})", _HELP
        ),
    },
)
def unknown_field(view: TargetView):
    own = get_own_interfaces(view.workspace)
    for package in view:
        for use in package.linked.own_fields:
            if view.is_sure(use.conditions) and (type_ := own.find_lacking(use)):
                data = {"interface": type_.replace(".", "/")}
                doubts = list_python_doubts(view, package, use.role, use.at.path)
                same = (Together(type_),)
                yield Diagnostic(use.at, use.steps[-1], package.name, data, "own", doubts, together=same)
        yield from rate_upcoming(_list_members(view, package, own.member_names))
        yield from rate_upcoming(_list_imports(view, package))
        yield from _list_of_workspace(view, package)


def _list_members(view: TargetView, package: Package, own: set[str]) -> Iterator[Diagnostic | Upcoming]:
    for use in package.linked.members:
        if use.ros != view.target.ros or (not use.sure and use.member in own) or _is_reviewed(view, *use.spellings):
            continue
        # A test of the code itself around such a use is there to tell versions apart, even where it cannot be known.
        if not view.applies(use.conditions) or not view.is_sure(c for c in use.conditions if c.language in _CODE):
            continue
        found = find_missing(view, "field", f"{use.interface}.{use.section}.{use.member}", (use.package,))
        if found is not None:
            doubts = (*list_place_doubts(view, use.role, use.conditions), use.sure or Doubt.INCOMPLETE)
            data = {**build_data(found), "interface": f"{use.package}/{use.interface}"}
            kind = f"field {found.state}"
            subject = ".".join((*use.section.split(".")[1:], use.member))
            yield diagnose(found, use.at, subject, package.name, doubts, kind=kind, data=data)


def _is_reviewed(view: TargetView, *names: str) -> bool:
    """Whether reviewed rows say that one of the names is gone, which removed-symbol reports."""
    found = (row for name in names for kind in ("c++", "python") for row in view.find_reviewed(kind, name))
    return any(row.state in ("removed", "changed") for row in found)


def _list_imports(view: TargetView, package: Package) -> Iterator[Diagnostic | Upcoming]:
    """Interfaces that Python imports."""
    for imported in package.linked.imports:
        head, _, kind = imported.module.partition(".")
        if kind not in ("msg", "srv", "action"):
            continue
        for name in imported.names:
            full = f"{imported.module}.{name}"
            found = view.find_availability(Symbol("interface", f"{kind}/{name}", (head,)))
            if found.is_missing and not _is_reviewed(view, full) and view.applies(imported.conditions):
                doubts = (*list_place_doubts(view, imported.role, imported.conditions), not imported.lazy or Doubt.LATE)
                yield diagnose(found, imported.at, full, package.name, doubts)


def _list_of_workspace(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Interfaces that Python imports from a package of the workspace which does not have them, or not there."""
    for imported in package.linked.imports:
        name, _, kind = imported.module.partition(".")
        owner = view.workspace.packages.get(name)
        if owner is None or not view.is_sure(imported.conditions):
            continue
        doubts = (*list_python_doubts(view, package, imported.role, imported.at.path), not imported.lazy or Doubt.LATE)
        if not owner.is_interface_package:
            if kind in ("msg", "srv", "action") and not may_generate(owner, kind, view.target.ros):
                data = {"interface": name}
                yield Diagnostic(imported.at, imported.module, package.name, data, "no interfaces", doubts)
            continue
        interfaces = {one.name: one.definition.kind for one in owner.linked.interfaces}
        for one in imported.names:
            if not kind and one in interfaces and one not in owner.linked.modules:
                data = {"interface": name, "module": f"{name}.{interfaces[one]}"}
                yield Diagnostic(imported.at, one, package.name, data, "root", doubts)
            elif kind in ("msg", "srv", "action") and not may_have_interface(owner, one):
                full = f"{imported.module}.{one}"
                yield Diagnostic(imported.at, full, package.name, {"interface": name, "module": one}, "none", doubts)
