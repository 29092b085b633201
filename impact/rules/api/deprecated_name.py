"""deprecated-name: a name that is used will go.

What it does
    Reports classes, functions, constants and CMake names that the target still has and has marked as deprecated: by the
    known-changes table, and of C++ and Python names by what the sources of the target's version say; of C++ with the
    first stored version that has them no more.

Why it matters
    The version that drops the name may be on a colleague's machine already.

Example
    rclcpp::executor::FutureReturnCode          // deprecated since Foxy

Use instead
    rclcpp::FutureReturnCode

Not reported
    Code that a version test excludes on the target.
"""

from ...targets.symbol import Symbol
from ..vocabulary import Doubt, TargetView, rule
from .diagnosis import build_availability_texts, diagnose
from .uses import list_cpp_uses, list_python_uses

_KINDS = {"cpp": "c++", "python": "python"}


@rule(
    scope="target",
    doubts=(Doubt.DEPRECATED,),
    texts=build_availability_texts(),
    yields_to=("changed-signature", "removed-cmake-name", "removed-python-name", "removed-symbol"),
)
def deprecated_name(view: TargetView):
    seen = set()
    for package in view:
        uses = list_python_uses(view, package)
        named = set()
        for use in uses:
            if use.found.state == "deprecated" and (use.at.path, use.name) not in named:
                named.add((use.at.path, use.name))
                seen.add((use.at.path, use.at.line))
                yield diagnose(use.found, use.at, use.name, package.name)
    for package in view:
        gone = tuple(f"{use.name}." for use in list_python_uses(view, package) if use.found.state == "removed")
        names = [(_KINDS[use.language], use.text, use.at, use.conditions) for use in package.linked.names]
        names += [(use.kind, use.name, use.at, use.conditions) for use in package.build.uses]
        for kind, text, at, conditions in names:
            row = next((row for row in view.find_reviewed(kind, text) if row.state == "deprecated"), None)
            if row is None or not view.applies(conditions):
                continue
            if not view.may_concern(package, row.package, at.path, kind):
                continue
            if not f"{text}.".startswith(gone):  # else what it stands in has gone with it, which is reported
                seen.add((at.path, at.line))
                # What the next distro removes of CMake, removed-cmake-name says, once for the package.
                if kind in _KINDS.values() or view.find_availability(Symbol(kind, text)).state != "upcoming":
                    yield diagnose(row, at, text, package.name)
    for package in view:
        for use in list_cpp_uses(view, package):
            if use.found.state == "deprecated" and use.sure and (use.at.path, use.at.line) not in seen:
                yield diagnose(use.found, use.at, use.name, package.name)
