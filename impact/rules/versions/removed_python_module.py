"""removed-python-module: a Python file imports a module that a target's Python no longer has.

What it does
    Reports imports of modules and names of the standard library that the target's Python does not have.

Why it breaks
    The node stops at the import: ModuleNotFoundError or ImportError.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, for imports inside functions
    and for distutils, which setuptools provides where it is installed; note for examples.

Example
    import imp                                  # removed in Python 3.12

Use instead
    import importlib

Not reported
    Imports with an except branch, and code under a test of the Python version.
"""

from ...model.view import View
from ...targets.providers.stdlib import stood_in_for
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .python_files import doubts_of_role


@rule(
    scope="target",
    severity="error",
    group="python-version",
    texts=Text(
        "the standard library of Python {version} does not have `{subject}`",
        help="use its successor, with an except branch if both versions must work",
    ),
)
def removed_python_module(view: View):
    minor = view.target.python
    if view.target.python_major < 3 or not minor:
        return
    for package in view:
        for item in package.digest.imports:
            if not view.certain(item.conditions) or not view.left_python(item.module):
                continue
            if item.module.split(".")[0] not in view.workspace.modules:
                late = item.lazy or stood_in_for(item.module)
                doubts = (*doubts_of_role(item.role), *((Doubt.LATE,) if late else ()))
                yield Diagnostic(item.at, item.module, package.name, {"version": f"3.{minor}"}, doubts=doubts)
