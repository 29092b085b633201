"""What a Python does not accept: that of the target, or, where that is Python 2, that of the newest distro."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from ..facts.condition import Condition
from ..model.package import ImportUse, SyntaxUse, find_folder_role
from ..targets.distro.distro import DistroTarget
from .packages.install_rules import may_stay_behind
from .vocabulary import Diagnostic, Doubt, Package, TargetView, Upcoming, list_place_doubts, rate_upcoming


def list_python_doubts(view: TargetView, package: Package, role: str, path: str) -> tuple[Doubt, ...]:
    """What speaks against an error at a place in a Python file of a package. A script of ROS 1 that nothing installs or
    starts is no example yet: it is run where it lies."""
    script = role == "aside" and package.build_type == "catkin" and path in package.linked.scripts
    if (script and is_no_example(package, path)) or (role == "run" and may_stay_behind(view, package, path)):
        return (Doubt.LATE,)
    return list_place_doubts(view, role)


def is_no_example(package: Package, path: str) -> bool:
    """Whether neither a folder nor the name of a file says that it is an example, or part of a test."""
    return find_folder_role(package.strip_path(path)) is None


class RejectedUse(NamedTuple):
    """What is not accepted. kind, needs, replacement: of the rule's text. doubts: beside those of its place.
    conditions: of the file, under which it stands."""

    use: SyntaxUse | ImportUse
    subject: str
    kind: str = ""
    needs: int = 0
    replacement: str = ""
    doubts: tuple[Doubt | bool, ...] = ()
    conditions: tuple[Condition, ...] = ()


def report_refused(
    view: TargetView, find: Callable[[Package, DistroTarget], Iterable[RejectedUse]]
) -> Iterator[Diagnostic]:
    """Diagnostics on what the Python of a view's target does not accept. find: gives it, for a package and a target
    with Python 3. Their data has `version`, that of Python, and `horizon`, which is empty for the target itself."""
    target, ahead = view.target, None
    if target.python_major < 3:
        ahead = next((one for one in view.horizons if one.target.python_major >= 3), None)
        if ahead is None:
            return
        target = ahead.target
    for package in view if target.python else ():
        if package.build.makes_environment:
            continue
        found: list[Diagnostic | Upcoming] = []
        for refused in find(package, target):
            use = refused.use
            doubts = (*list_place_doubts(view, use.role), *refused.doubts, use.role != "test" or Doubt.TEST)
            if use.role == "run" and may_stay_behind(view, package, use.at.path):
                doubts = (*doubts, Doubt.LATE)
            data = {"version": f"3.{target.python}", "needs": f"3.{refused.needs}", "replacement": refused.replacement}
            data["horizon"] = ahead.name if ahead is not None else ""
            one = Diagnostic(use.at, refused.subject, package.name, data, refused.kind, doubts)
            if ahead is None:
                found.append(one)
            elif view.is_active_on(ahead, refused.conditions):
                found.append(Upcoming(one, "python", ahead, (use.at.path, use.at.line)))
        yield from rate_upcoming(found)
