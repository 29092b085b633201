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

from ..vocabulary import Package, TargetView, Text, rule
from .diagnosis import UPSTREAM, build_data, diagnose
from .uses import list_python_uses

_HERE = f"{UPSTREAM}[[ ({{horizon}})]]"


@rule(
    texts={
        "call": Text(f"`{{subject}}` of {_HERE} no longer accepts this call: {{detail}}", "[[write {spelling}]]"),
        "call early": Text(
            f"`{{subject}}` of {_HERE} does not accept this call: {{detail}}[[ (accepted since {{since}})]]"
        ),
        "override": Text(
            f"`{{subject}}`, which is overridden here, has another signature in {_HERE}: {{detail}}",
            "the base class calls it as `{declaration}`",
        ),
    },
)
def changed_python_signature(view: TargetView, package: Package):
    for use in list_python_uses(view, package):
        found = use.found
        if found.form not in ("call", "override"):
            continue
        evidence = found.evidence
        data = {**build_data(found), "detail": found.detail}
        data["declaration"] = evidence.new[0] if evidence is not None and evidence.new else ""
        # What parameters are called now, where a reviewed row knows: by `function.parameter`.
        rows = [(one, view.find_reviewed("python", f"{use.name}.{one}")) for one in use.keywords]
        names = [f"`{row.replacement.rpartition('.')[2]}` for `{one}`" for one, (row, *_) in filter(all, rows)]
        data["spelling"] = " and ".join(names)
        kind = found.form if found.earlier else f"{found.form} early"
        yield diagnose(found, use.at, use.name, package.name, use.doubts, kind=kind, data=data)
