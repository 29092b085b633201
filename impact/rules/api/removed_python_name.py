"""removed-python-name: a Python module, class, function or method of another package is gone, or not there yet.

What it does
    Reports imports and uses of names that the target's version of the providing package, or of Python itself, does not
    have, and an earlier or later version of it has: modules, what is imported from them, attributes, and members of
    objects whose class shows; and imports of names, and constants of classes, that no version of the package has
    anywhere, or has in other modules alone. What each version has was read from its sources, of Python's standard
    library from typeshed's stubs.

Why it breaks
    Python raises ImportError or AttributeError when the line is reached; where it is an import, when the program or
    launch file starts.

Severity
    error for what surely runs when the file is imported or started, in code that is installed; warning for what is only
    used in a function, for tests, and where something about the target's version is guessed; note in examples.

Example
    from rclpy.qos import QoSDurabilityPolicy       // gone in rclpy 5.0

Use instead
    from rclpy.qos import DurabilityPolicy

Not reported
    What stands under a `try` that expects it, or a test of the version or of the name itself; what the workspace itself
    provides; names that the known-changes table treats, which removed-symbol tells; modules that are built rather than
    written.
"""

from ..vocabulary import SEVERITIES, Doubt, Package, TargetView, limit_severity, rule
from .diagnosis import build_availability_texts, diagnose
from .uses import UnservedUse, list_python_uses


@rule(texts=build_availability_texts(), yields_to=("removed-python-module", "removed-symbol"))
def removed_python_name(view: TargetView, package: Package):
    # Of each name the worst place in a file: what follows a failed import is not reached.
    worst: dict[tuple[str, str, bool], UnservedUse] = {}
    for use in list_python_uses(view, package):
        if use.found.is_missing or (use.found.state == "upcoming" and not use.found.form):
            key = use.at.path, use.name, use.found.is_missing
            if key not in worst or (use.found.is_missing and _rank(use) > _rank(worst[key])):
                worst[key] = use
    for use in worst.values():
        yield diagnose(use.found, use.at, use.name, package.name, use.doubts)


def _rank(use: UnservedUse) -> int:
    return SEVERITIES.index(limit_severity(*use.doubts, use.found.sure or Doubt.INCOMPLETE))
