"""changed-python-signature: a Python function or method of another package is called in a way that a target refuses.

What it does
    Reports calls with more arguments than the target's version of the function takes, with a keyword that it does not
    know, or without an argument that it needs, where an earlier or later version takes the call; and methods that
    override one of a base class which is called with other arguments than it was.

Why it breaks
    Python raises a TypeError when the call is reached.

Severity
    error for calls that surely run when a file is imported or started, in code that is installed; warning for other
    calls, for overrides, and for tests; note in examples.

Example
    Node(package='a', node_executable='b')          // launch_ros of Galactic and later needs `executable`

Use instead
    Node(package='a', executable='b')

Not reported
    Calls that no known version takes; functions under decorators that may change their parameters; what stands under a
    `try` that expects it or a test of the version; what the workspace itself provides.
"""

from ...model.view import View
from ..rule import Hit, rule
from ..severity import severity
from .python_api import doubts_of, evidence_of, uses_coming, uses_lost
from .upcoming import Upcoming, rated


@rule(severity="error")
def changed_python_signature(view: View):
    # What parameters are called now, where a reviewed table knows: by `function.parameter`.
    renamed = {change.old: change.new.rpartition(".")[2] for change in view.changes("python-api") if change.new}
    for package in view:
        uses = [(found, lost, None) for found, lost in uses_lost(view, package)] + uses_coming(view, package)
        coming: list[Upcoming] = []
        for found, lost, ahead in uses:
            where = f"{lost.package} {lost.version}" + (f" ({ahead.name})" if ahead is not None else "")
            given = found.use.given.keywords if found.use.given is not None else ()
            cure = ""
            if lost.state == "refused":
                message = f"`{lost.name}` of {where} no longer accepts this call: {lost.why}"
                names = [f"`{renamed[key]}` for `{one}`" for one in given if (key := f"{lost.name}.{one}") in renamed]
                cure = f"write {' and '.join(names)}" if names else ""
            elif lost.state == "early":
                message = f"`{lost.name}` of {where} does not accept this call yet: {lost.why}"
            elif lost.state == "override":
                message = f"`{lost.name}`, overridden here, has changed in {where}: {lost.why}"
                cure = f"it is called as `{lost.new}`"
            else:
                continue
            doubts = doubts_of(view, found, lost)
            hit = Hit(found.at, lost.name, message, cure, package.name, evidence=evidence_of(lost))
            if ahead is None:
                yield hit._replace(severity=severity(*doubts))
            else:
                order = found.at.path, found.at.line, found.at.column
                coming.append(Upcoming(hit, lost.package, ahead, doubts, order))
        yield from rated(coming)
