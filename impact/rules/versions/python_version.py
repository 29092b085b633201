"""python-version: a Python file uses syntax that a target's Python does not accept.

What it does
    Reports syntax that only Python 2 accepts if the target has Python 3, and syntax newer than the target's Python. On
    a target with Python 2 it reports what the newest distro's Python 3 does not accept.

Why it breaks
    The node stops with a SyntaxError before it runs.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, and for the first place of a
    package that only the newest distro does not accept; note for examples and the rest of those.

Example
    except urllib2.URLError, e:

Use instead
    except urllib.error.URLError as e:
"""

from collections.abc import Iterator

from ...model.view import View
from ...model.workspace import Package
from ...targets.target import Target
from ..rule import rule
from .python_files import Refused, report_refused


@rule(scope="target", severity="error")
def python_version(view: View):
    def find(package: Package, target: Target) -> Iterator[Refused]:
        reported = set()
        for use in package.digest.syntax:
            if use.needs == 2 and use.at.path not in reported:
                reported.add(use.at.path)
                message = f"{use.what} is a syntax error in Python 3.{target.python}"
                yield Refused(use, use.what, message, "use syntax that Python 3 accepts")
            elif use.needs > max(2, target.python) and view.target.python_major >= 3:
                message = f"{use.what} needs Python 3.{use.needs}, but the target has 3.{target.python}"
                yield Refused(use, use.what, message, "use syntax that the Python of every target accepts")

    yield from report_refused(view, find)
