"""python-version: a Python file does not parse, or imports a removed module, on a target's Python.

What it does
    Reports syntax that only Python 2 accepts where the target has Python 3, syntax newer than the target's Python, and
    modules of the standard library that the target's Python no longer has. On a target with Python 2 it reports what
    the newest distro's Python 3 does not accept.

Why it breaks
    The node stops at its first line: SyntaxError or ModuleNotFoundError.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, for imports inside functions,
    for distutils, which setuptools brings back where it is installed, and for the first place of a package that only
    the newest distro does not accept; note for examples and the rest of those.

Example
    except urllib2.URLError, e:

Use instead
    except urllib.error.URLError as e:

Not reported
    Imports with an except branch, and code under a test of the Python version.
"""

from collections.abc import Iterator
from typing import NamedTuple

from ...facts.condition import Condition
from ...model.package import ImportUse, SyntaxUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import Horizon
from ...targets.providers.stdlib import ever_stdlib, stdlib, stood_in_for
from ...targets.target import Target
from ..api.upcoming import Upcoming, rated_all
from ..rule import Hit, rule
from ..severity import Doubt, doubts_of_place, severity


@rule(severity="error")
def python_version(view: View):
    target, ahead = view.target, None
    if target.python_major < 3:
        ahead = next((one for one in view.horizons if one.target.python_major >= 3), None)
        if ahead is None:
            return
        target = ahead.target
    if not target.python:
        return
    for package in view:
        found = (_rated(view, package.name, use, problem, ahead) for use, problem in _problems(view, package, target))
        yield from rated_all(one for one in found if one is not None)


class _Problem(NamedTuple):
    subject: str
    message: str
    help: str
    doubts: tuple[Doubt, ...]
    conditions: tuple[Condition, ...]


def _rated(
    view: View, package: str, use: SyntaxUse | ImportUse, problem: _Problem, ahead: Horizon | None
) -> Hit | Upcoming | None:
    hit = Hit(use.at, problem.subject, problem.message, problem.help, package)
    doubts = (*doubts_of_place(view, use.role), *problem.doubts, use.role != "test" or Doubt.TEST)
    if ahead is None:
        return hit._replace(severity=severity(*doubts))
    if not view.active_on(ahead, problem.conditions):
        return None
    hit = hit._replace(message=f"{problem.message} ({ahead.name})")
    return Upcoming(hit, "python", ahead, doubts, (use.at.path, use.at.line))


def _problems(view: View, package: Package, target: Target) -> Iterator[tuple[SyntaxUse | ImportUse, _Problem]]:
    """What a Python 3 does not accept."""
    minor, told = target.python, set()
    for use in package.digest.syntax:
        if use.needs == 2 and use.at.path not in told:
            told.add(use.at.path)
            yield use, _Problem(use.what, f"Python 3.{minor} does not accept {use.what}",
                                "write it so that Python 3 accepts it", (), ())  # fmt: skip
        elif use.needs > 2 and use.needs > minor and view.target.python_major >= 3:
            yield use, _Problem(use.what, f"{use.what} needs Python 3.{use.needs}, and the target has 3.{minor}",
                                "write it so that every target's Python accepts it", (), ())  # fmt: skip
    for item in package.digest.imports:
        if not view.certain(item.conditions) or item.module.split(".")[0] in view.workspace.modules:
            continue
        if ever_stdlib(item.module) and not stdlib(item.module, minor, 3):
            doubts = (Doubt.LATE,) if item.lazy or stood_in_for(item.module) else ()
            yield item, _Problem(item.module, f"module `{item.module}` is not in Python 3.{minor}",
                                 "use its successor, with an except branch where both must work", doubts,
                                 item.conditions)  # fmt: skip
