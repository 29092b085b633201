"""unknown-field: a field of a message is used that the target's definition of the message lacks.

What it does
    Reports fields and constants of messages, services and actions of other packages that the target's release of the
    package has no longer, or not yet; the same for interfaces that Python imports. Whose field it is, is told by the
    declared type of the variable, followed through nested messages. Says as well what goes when a dated target's
    distro is updated.

Why it breaks
    The compiler stops with "has no member named"; Python raises an AttributeError when the line is reached, on the
    robot, or an ImportError.

Severity
    error for code that is built or run, tests of ROS 2 included, also for what goes with the distro's next sync, since
    its build farm builds against that already; warning in tests of ROS 1, for what only goes with a later update, and
    where a telling name is used on something whose type does not show; note in examples.

Example
    request->start_controllers = {"arm"};       // controller_manager_msgs of Iron has activate_controllers

Use instead
    request->activate_controllers = {"arm"};

Not reported
    Code that a version test excludes on the target, or that stands under a test which cannot be told; variables whose
    type does not show, unless only one interface of those that the file uses has such a name; interfaces that the
    workspace itself brings.
"""

from ...model.package import MemberUse
from ...model.view import View
from ..rule import Hit, rule
from ..severity import Doubt, doubts_of_place, severity
from .upcoming import Upcoming, rated


@rule(severity="error")
def unknown_field(view: View):
    own = {
        member.name
        for package in view.workspace
        for interface in package.digest.interfaces
        for section in interface.definition.sections
        for member in (*section.fields, *section.constants)
    }
    # What the tables of names tell already is removed-symbol's.
    named = {
        c.old
        for c in view.changes("api-removed", "api-renamed", "api-changed", "python-removed", "python-api")
        if c.state == "removed"
    }
    for package in view:
        upcoming: list[Upcoming] = []
        for use in package.digest.members:
            if (not use.sure and use.member in own) or not named.isdisjoint(_spellings(use)):
                continue
            # A test of the code itself around such a use is there to tell versions apart, even where it cannot be told.
            if not view.active(use.conditions) or not view.certain(c for c in use.conditions if c.language == "cpp"):
                continue
            lacking = view.lacking_member(use)
            doubts = doubts_of_place(view, use.role, use.conditions)
            if not use.sure:
                doubts = (*doubts, Doubt.INCOMPLETE)
            if lacking is None:
                coming = view.coming_member(use)
                if coming is not None and coming.ahead is not None:
                    hit = Hit(use.at, use.member, coming.message, coming.help, package.name, evidence=coming.evidence)
                    order = use.at.path, use.at.line, use.at.column
                    upcoming.append(Upcoming(hit, f"{use.package}/{use.interface}", coming.ahead, doubts, order))
                continue
            yield Hit(
                use.at,
                use.member,
                lacking.message,
                lacking.help,
                package.name,
                severity=severity(*doubts),
                evidence=lacking.evidence,
            )
        yield from rated(upcoming)
        for imported in package.digest.imports:
            for name in imported.names:
                lost = view.lost_interface_module(imported.module, name)
                if lost is None or f"{imported.module}.{name}" in named or not view.active(imported.conditions):
                    continue
                yield Hit(
                    imported.at,
                    f"{imported.module}.{name}",
                    lost.message,
                    lost.help,
                    package.name,
                    severity=severity(*doubts_of_place(view, imported.role, imported.conditions), Doubt.LATE),
                    evidence=lost.evidence,
                )


def _spellings(use: MemberUse) -> tuple[str, ...]:
    """A constant as the tables of names have it."""
    kind, _, name = use.interface.partition("/")
    part = "" if use.section == "message" else use.section.capitalize()
    parts = (use.package, kind, name, *((part,) if part else ()), use.member)
    return ("::".join(parts), ".".join(parts), f"{use.package}::{name}{part}::{use.member}")
