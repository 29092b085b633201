"""removed-python-name: a Python module, class, function or method of another package is gone, or not there yet.

What it does
    Reports imports and uses of names that the target's version of the providing package does not have, and an earlier
    or later version of it has: modules, what is imported from them, attributes, and members of objects whose class
    shows; and imports of names that no version of the package has anywhere. What each version has was read from its
    sources.

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

from ...model.package import PythonApiUse
from ...model.view import View
from ...targets.surface.offers_python import Lost
from ..rule import SEVERITIES, Hit, rule
from .python_api import evidence_of, severity_of, uses_lost

_STATES = {
    "removed": "is gone in {}",
    "absent": "is not yet in {}",
    "unknown": "is not in {}, nor in any other version of it that was read",
}


@rule(severity="error")
def removed_python_name(view: View):
    for package in view:
        # Of each name the worst place in a file: what follows a failed import is not reached.
        worst: dict[tuple[str, str], tuple[int, PythonApiUse, Lost]] = {}
        for found, lost in uses_lost(view, package):
            if lost.state in _STATES:
                key, rank = (found.at.path, lost.name), SEVERITIES.index(severity_of(found, lost))
                if key not in worst or rank > worst[key][0]:
                    worst[key] = rank, found, lost
        for rank, found, lost in worst.values():
            state = _STATES[lost.state].format(f"{lost.package} {lost.version}")
            cure = f"use `{lost.instead}`" if lost.instead else ""
            evidence = None if lost.state == "unknown" else evidence_of(lost)
            yield Hit(found.at, lost.name, f"`{lost.name}` {state}", cure, package.name, severity=SEVERITIES[rank],
                      evidence=evidence)  # fmt: skip
