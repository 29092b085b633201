"""changed-signature: a call or a type is written as the target's version of a library does not take it.

What it does
    Reports calls with arguments, template arguments, or in a form that the known-changes table says the target's
    version of a package or library takes no longer, or not yet; what the C++ standard that the package is compiled with
    refuses or lacks; and what libraries of the newest distro take no longer.

Why it breaks
    The compiler finds no matching function, or Python raises a TypeError or an AttributeError: the name is there, but
    not with these arguments.

Severity
    error for code that is built or run, tests of ROS 2 included; warning in tests of ROS 1 and in Python's, under CMake
    conditions that are not known, and for the first call of a library that only the newest distro refuses, where that
    is at most two long-term distros ahead; note in examples, under an `#if` that is not known, and for the rest.

Example
    auto timeout = rclcpp::Duration(0.5);       // Humble's Duration takes no floating point number

Use instead
    auto timeout = rclcpp::Duration::from_seconds(0.5);

Not reported
    Code that a version test excludes on the target; packages that do not depend on the library; what is passed in
    variables whose type does not show in the file.
"""

from ...model.view import View
from ..evidence import uses_refused
from ..rule import rule


@rule(severity="error")
def changed_signature(view: View):
    yield from uses_refused(view, "call-changed")
