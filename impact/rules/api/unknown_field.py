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
from ..rule import rule


@rule(severity="error")
def unknown_field(view: View):
    yield from uses_refused(view, "field-changed")
