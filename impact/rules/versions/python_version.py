"""python-version: a Python file uses syntax that a target's Python does not accept.

What it does
    Reports syntax that only Python 2 accepts if the target has Python 3, and syntax newer than the target's Python.

Why it breaks
    The node stops with a SyntaxError before it runs.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests; note for examples.

Example
    except urllib2.URLError, e:

Use instead
    except urllib.error.URLError as e:
"""

from ...model.view import View
from ..rule import Diagnostic, rule
from ..text import Text
from .python_files import doubts_of_role


@rule(
    scope="target",
    severity="error",
    texts={
        "older": Text("{subject} is a syntax error in Python {version}", help="use syntax that Python 3 accepts"),
        "newer": Text(
            "{subject} needs Python {since}, but the target has {version}",
            help="use syntax that the Python of every target accepts",
        ),
    },
)
def python_version(view: View):
    minor = view.target.python
    if view.target.python_major < 3 or not minor:
        return
    for package in view:
        reported = set()
        for use in package.digest.syntax:
            data = {"version": f"3.{minor}", "since": f"3.{use.needs}"}
            doubts = doubts_of_role(use.role)
            if use.needs == 2 and use.at.path not in reported:
                reported.add(use.at.path)
                yield Diagnostic(use.at, use.what, package.name, data, kind="older", doubts=doubts)
            elif use.needs > max(2, minor):
                yield Diagnostic(use.at, use.what, package.name, data, kind="newer", doubts=doubts)
