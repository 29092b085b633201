"""python2-key: a declared key installs a module of Python 2, and the target has Python 3.

What it does
    Reports keys `python-x` that install packages of Python 2 alone, where a key `python3-x` exists on the target.

Why it breaks
    The key is installed, but Python 3 does not find modules of Python 2.

Severity
    warning, since only the import fails.

Example
    <exec_depend>python-numpy</exec_depend>

Use instead
    <exec_depend>python3-numpy</exec_depend>

Not reported
    Keys that install modules of both.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .unresolved_names import list_unresolved


@rule(
    doubts=(Doubt.LATE,),
    group="unresolvable-key",
    texts=Text(
        "`{subject}` installs a module of Python 2, but {platform} runs ROS with Python 3", "declare `{replacement}`"
    ),
)
def python2_key(view: TargetView, package: Package):
    target = view.target
    if target.python_major < 3:
        return
    for name, at, found in list_unresolved(view, package):
        replacement = name.replace("python-", "python3-", 1)
        if found is None or found.manager != "apt" or replacement == name:
            continue
        if view.is_for_other_python(name) and target.resolve(replacement) is not None:
            data = {"platform": target.platform, "replacement": replacement}
            yield Diagnostic(at, name, package.name, data)
