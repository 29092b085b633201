"""removed-python-module: a Python file imports a module that a target's Python no longer has.

What it does
    Reports imports of modules of the standard library that the target's Python does not have. On a target with Python 2
    it reports what the newest distro's Python 3 does not have.

Why it breaks
    The node stops at the import: ModuleNotFoundError or ImportError.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, for imports inside functions,
    for distutils, which setuptools provides where it is installed, and for the first place of a package that only the
    newest distro does not accept; note for examples and the rest of those.

Example
    import imp                                  # removed in Python 3.12

Use instead
    import importlib

Not reported
    Imports with an except branch, and code under a test of the Python version.
"""

from collections.abc import Iterator

from ...targets.distro.distro import DistroTarget
from ...targets.providers.stdlib import find_successor, has_substitute, is_in_stdlib, was_ever_in_stdlib
from ..python_files import RejectedUse, report_refused
from ..vocabulary import Doubt, Package, TargetView, Text, rule


@rule(
    scope="target",
    group="python-version",
    texts=Text(
        "the standard library of Python {version} does not have `{subject}`[[ ({horizon})]]",
        "use its successor[[ `{replacement}`]], with an except branch if both versions must work",
    ),
)
def removed_python_module(view: TargetView):
    def find(package: Package, target: DistroTarget) -> Iterator[RejectedUse]:
        for item in package.linked.imports:
            if not view.is_sure(item.conditions) or item.module.split(".")[0] in view.workspace.modules:
                continue
            if was_ever_in_stdlib(item.module) and not is_in_stdlib(item.module, target.python, 3):
                doubts = (Doubt.LATE,) if item.lazy or has_substitute(item.module) else ()
                new = find_successor(item.module)
                yield RejectedUse(item, item.module, replacement=new, doubts=doubts, conditions=item.conditions)

    yield from report_refused(view, find)
