"""unknown-field: a field of a message is used that the target's definition of the message lacks.

What it does
    Reports fields of messages, services and actions of other packages that the target's release of the package has no
    longer, or not yet, in files that include or import the message.

Why it breaks
    The compiler stops with "has no member named"; Python raises an AttributeError when the line is reached, on the
    robot.

Severity
    error for C++ that is built; warning in tests, for Python, and under conditions that are not known; note in
    examples.

Example
    request->start_controllers = {"arm"};       // controller_manager_msgs of Iron has activate_controllers

Use instead
    request->activate_controllers = {"arm"};

Not reported
    Code that a version test excludes on the target; fields whose names the message's newer definition, or another
    message that the file uses, has too.
"""

from ...model.view import View
from ..evidence import uses_refused
from ..rule import Hit, rule


@rule(severity="error")
def unknown_field(view: View):
    yield from uses_refused(view, "field-changed")
    own = {
        member.name
        for package in view.workspace
        for interface in package.digest.interfaces
        for section in interface.definition.sections
        for member in (*section.fields, *section.constants)
    }
    for package in view:
        for use in package.digest.members:
            if not use.sure and use.member in own:
                continue
            lacking = view.lacking_member(use)
            if lacking is None or not view.active(use.conditions):
                continue
            built = use.role in ("build", "run") and use.language == "cpp" and view.certain(use.conditions)
            yield Hit(
                use.at,
                use.member,
                lacking.message,
                lacking.help,
                package.name,
                severity="note" if use.role == "aside" else "error" if built and use.sure else "warning",
            )
        for imported in package.digest.imports:
            for name in imported.names:
                lost = view.lost_interface_module(imported.module, name)
                if lost is None or not view.active(imported.conditions):
                    continue
                sure = imported.role == "run" and not imported.lazy and view.certain(imported.conditions)
                yield Hit(
                    imported.at,
                    f"{imported.module}.{name}",
                    lost.message,
                    lost.help,
                    package.name,
                    severity="note" if imported.role == "aside" else "error" if sure else "warning",
                )
