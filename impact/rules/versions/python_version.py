"""python-version: a Python file does not parse, or imports a removed module, on a target's Python.

What it does
    Reports syntax that only Python 2 takes where the target has Python 3, syntax newer than the target's Python, and
    modules and names of the standard library that the target's Python no longer has.

Why it breaks
    The node stops at its first line: SyntaxError or ModuleNotFoundError.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, for imports inside functions
    and for distutils, which setuptools brings back where it is installed; note for examples.

Example
    except urllib2.URLError, e:

Use instead
    except urllib.error.URLError as e:

Not reported
    Imports with an except branch, and code under a test of the Python version.
"""

from ...model.view import View
from ...targets.providers.stdlib import stood_in_for
from ..rule import Hit, rule

_SEVERITY = {"run": "error", "build": "error", "test": "warning", "aside": "note"}


@rule(severity="error")
def python_version(view: View):
    if view.target.python_major < 3:
        return
    minor = view.target.python
    for package in view:
        told = set()
        for use in package.digest.syntax:
            severity = _SEVERITY.get(use.role, "note")
            if use.needs == 2 and minor and use.at.path not in told:
                told.add(use.at.path)
                yield Hit(
                    use.at,
                    use.what,
                    f"Python 3.{minor} refuses {use.what}",
                    "write it so that Python 3 takes it",
                    package.name,
                    severity=severity,
                )
            elif use.needs > 2 and minor and use.needs > minor:
                yield Hit(
                    use.at,
                    use.what,
                    f"{use.what} needs Python 3.{use.needs}, and the target has 3.{minor}",
                    "write it so that every target's Python takes it",
                    package.name,
                    severity=severity,
                )
        for item in package.digest.imports:
            if not minor or not view.certain(item.conditions):
                continue
            if view.left_python(item.module) and item.module.split(".")[0] not in view.workspace.modules:
                severity = _SEVERITY.get(item.role, "note")
                milder = item.lazy or stood_in_for(item.module)
                yield Hit(
                    item.at,
                    item.module,
                    f"module `{item.module}` is not in Python 3.{minor}",
                    "use its successor, with an except branch where both must work",
                    package.name,
                    severity="warning" if milder and severity == "error" else severity,
                )
