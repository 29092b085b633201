"""changed-signature: a call, a type or an override does not fit the target's version of a library.

What it does
    Reports calls with arguments, template arguments, or in a form that the known-changes table says the target's
    version of a package or library takes no longer, or not yet; calls of C++ functions with so many arguments as no
    overload of the target's stored version takes and another version's does, or with arguments that show themselves to
    be of another type, among them objects of a class that neither is nor becomes the parameter's; templates with a
    number of arguments that they do not take there and do in another version; methods that override none of their
    base's there and did, or do, in another version; exported classes that lack a method which their base made pure
    virtual; calls that leave out a template argument that nothing else tells; what the C++ standard that the package is
    compiled with refuses or lacks; and what libraries of the newest distro take no longer.

Why it breaks
    The compiler finds no matching function, or Python raises a TypeError or an AttributeError: the name is there, but
    not with these arguments.

Severity
    error for code that is built or run, tests of ROS 2 included; warning in tests of ROS 1 and in Python's, under CMake
    conditions that are not known, and for the first call of a library, in tests too, that only the newest distro
    refuses, where that is at most two long-term distros ahead; note in examples, under an `#if` that is not known, and
    for the rest. A method that no longer overrides, and does not say `override`, compiles: warning; so does what fails
    when the program comes by.

Example
    auto timeout = rclcpp::Duration(0.5);       // Humble's Duration takes no floating point number

Use instead
    auto timeout = rclcpp::Duration::from_seconds(0.5);

Not reported
    Code that a version test excludes on the target; packages that do not depend on the library; what is passed in
    variables whose type does not show in the file; methods that come later, where another package that is declared
    declares one of that name.
"""

from collections.abc import Iterator

from ....edges.console import format_count
from ...model.package import NameUse
from ...model.standards import find_failing_standard
from ...targets.changes import find_function, find_standards, shows_no_class, shows_no_type
from ...targets.symbol import Availability
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rate_upcoming, rule
from .diagnosis import UPSTREAM, build_data, diagnose
from .uses import UnservedUse, list_cpp_uses

# What every C++ file is compiled with, whatever its package declares.
_COMPILER = frozenset({"gcc", "glibc", "linux-headers"})

_HERE = f"{UPSTREAM}[[ ({{horizon}})]]"
_LATER = f"{_HERE}[[ (added in {{since}})]]"
_HELP = "[[use `{replacement}`]][[it is declared as `{detail}`]]"
_LOST = {
    "arguments": f"`{{subject}}` does not accept {{arguments}} in {_HERE}; an earlier version does",
    "types": f"`{{subject}}` does not accept arguments of these types in {_HERE}; an earlier version does",
    "template arguments": f"`{{subject}}` does not accept {{types}} in {_HERE}; an earlier version does",
    "template": f"the template argument of `{{subject}}` cannot be deduced from this call in {_HERE}",
    "override": f"this method does not override `{{subject}}` in {_HERE}: its signature changed",
    "gone": f"this method does not override `{{subject}}` in {_HERE}: it was removed",
    "pure": f"this class does not implement `{{subject}}`, which is pure virtual in {_HERE}",
    "unmatched": f"this method does not override `{{subject}}` in {_HERE}",
}
_EARLY = {
    "arguments": f"`{{subject}}` does not accept {{arguments}} in {_LATER}",
    "types": f"`{{subject}}` does not accept arguments of these types in {_LATER}",
    "template arguments": f"`{{subject}}` does not accept {{types}} in {_LATER}",
    "override": f"this method does not override `{{subject}}` in {_LATER}",
    "pure": f"this class does not implement `{{subject}}`, which is pure virtual in {_HERE}",
}
_REVIEWED = f"{UPSTREAM}[[ in {{standard}}]][[ ({{horizon}})]]"


@rule(
    scope="target",
    texts={
        **{form: Text(text, _HELP) for form, text in _LOST.items()},
        **{f"{form} early": Text(text, _HELP) for form, text in _EARLY.items()},
        "reviewed": Text(f"`{{subject}}` is no longer accepted by {_REVIEWED}", "{advice}"),
        "compiles": Text(f"`{{subject}}` compiles with {_REVIEWED}, but {{clause}}", "{advice}"),
        "reviewed early": Text(f"`{{subject}}` is not available in {_REVIEWED}[[ (added in {{since}})]]", "{advice}"),
    },
)
def changed_signature(view: TargetView):
    seen = set()
    for package in view:
        for found in rate_upcoming(_list_reviewed(view, package)):
            seen.add((found.at.path, found.at.line))
            yield found
    for package in view:
        yield from rate_upcoming(
            _diagnose_use(use, package)
            for use in list_cpp_uses(view, package)
            if use.found.form in _LOST and (use.at.path, use.at.line) not in seen
        )


def _diagnose_use(use: UnservedUse, package: Package) -> Diagnostic | Upcoming:
    counts = {"arguments": format_count(use.arguments, "argument"),
              "types": format_count(use.templated, "template argument")}  # fmt: skip
    data = {**build_data(use.found), **counts}
    kind = use.found.form if use.found.earlier else f"{use.found.form} early"
    return diagnose(use.found, use.at, use.name, package.name, use.doubts, kind=kind, data=data)


def _find_row(view: TargetView, label: str) -> Availability | None:
    rows = (row for row in view.find_reviewed("use", label) if not view.may_have(row.package))
    return next((row for row in rows if row.state != "upcoming" or row.package not in _COMPILER), None)


def _list_reviewed(view: TargetView, package: Package) -> Iterator[Diagnostic | Upcoming]:
    """What the tables of known changes tell. What the workspace itself brings is as it brings it."""
    uses = [(use, found) for use in package.linked.uses if (found := _find_row(view, use.text)) is not None]
    if not uses:
        return
    # A method that the package or what it is built with declares may be meant wherever its name is called.
    within = [
        view.workspace.packages[name] for name in view.build_environment(package) if name in view.workspace.packages
    ]
    own = {
        "cpp": {function for each in within for function in each.linked.functions},
        "python": {method for each in within for method in each.linked.methods},
    }
    for use, found in uses:
        if (
            find_function(use.text, use.language) in own.get(use.language, ())
            or not view.applies(use.conditions)
            or not (found.package in _COMPILER or view.may_concern(package, found.package, use.at.path))
            or (found.horizon is not None and not view.is_active_on(found.horizon, use.conditions))
        ):
            continue
        of_another = _may_be_of_another(view, package, use, found.package)
        if of_another and not found.earlier and not found.detail:
            continue
        standard = find_failing_standard(view, package, use, *find_standards(use.text))
        if standard is None:
            continue
        shown = use.shown or use.text
        doubts = list_place_doubts(view, use.role, use.conditions)
        doubts = doubts if use.language == "cpp" else (*doubts, Doubt.LATE)
        doubts = (*doubts, Doubt.AMBIGUOUS) if shows_no_type(use.text) else doubts
        if shows_no_class(use.text):
            doubts = (
                *doubts,
                not of_another or Doubt.AMBIGUOUS,
                not _has_unread_classes(view, package) or Doubt.INCOMPLETE,
            )
        doubts = (*doubts, Doubt.GUARDED) if view.is_included_under_conditions(package, found.package) else doubts
        doubts = (*doubts, Doubt.LATE) if found.detail else doubts
        data = {**build_data(found), "standard": standard, "advice": found.replacement, "clause": found.detail}
        if standard:
            data["since"] = ""  # the version is bound to the standard
            found = found._replace(evidence=None)
        kind = "compiles" if found.detail else "reviewed" if found.earlier else "reviewed early"
        yield diagnose(found, use.at, shown, package.name, doubts, kind=kind, data=data)


def _may_be_of_another(view: TargetView, package: Package, use: NameUse, owner: str) -> bool:
    """Whether a C++ method may be that of a class of another declared package, whose stored versions declare one of its
    name."""
    function = find_function(use.text, use.language) if use.language == "cpp" else ""
    if not function:
        return False
    offers = (view.offers.find_package(name) for name in view.collect_declared(package) if name != owner)
    return any(offer.history.has_declared(function) for offer in offers if offer is not None)


def _has_unread_classes(view: TargetView, package: Package) -> bool:
    """Whether a package is built with another whose classes nobody has read, so that an object may be of one of them
    and have a method of its own."""
    unread = view.unknown_contents
    return bool(unread.list_unread(package)) or unread.may_come_along(package)
