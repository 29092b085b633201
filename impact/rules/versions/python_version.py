"""python-version: a Python file uses syntax that a target's Python does not accept.

What it does
    Reports syntax that only Python 2 accepts if the target has Python 3, and syntax newer than the target's Python, as
    well as annotations that it evaluates and cannot (`list[int]`, `int | None`). On a target with Python 2 it reports
    what the newest distro's Python 3 does not accept, syntax of Python 3 in files whose first line names `python`, and
    `print` with keywords in modules that do not import it from `__future__`.
    Setup files that the build runs are included, and lines that no Python accepts, except in templates, and in files
    without the ending `.py` that nothing installs by their name or starts: their first line may be there for editors.

Why it breaks
    The node stops with a SyntaxError, or a TypeError for annotations, before it runs.

Severity
    error for files that are nodes, scripts or modules of the package; warning for tests, for files that only an install
    rule of unknown files may install, for modules that Python 2 most likely runs, and for the first place of a package
    that only the newest distro does not accept; note for examples and the rest of those.

Example
    except urllib2.URLError, e:

Use instead
    except urllib.error.URLError as e:
"""

import posixpath
import sys
from collections.abc import Iterator

from ...facts.python.source import NEVER_PYTHON, NO_PYTHON
from ...targets.distro.distro import DistroTarget
from ..packages.install_rules import list_references
from ..python_files import RejectedUse, report_refused
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule


@rule(
    scope="target",
    texts={
        "python 2": Text(
            "{subject} is a syntax error in Python {version}[[ ({horizon})]]", "use syntax that Python 3 accepts"
        ),
        "python 3": Text(
            "{subject} is a syntax error in Python 2, which runs this file",
            "start the file with `#!/usr/bin/env python3`",
        ),
        "print": Text(
            "{subject} is a syntax error in Python 2, which the target's ROS uses",
            "write `from __future__ import print_function` at the start of the file",
        ),
        "newer": Text(
            "{subject} needs Python {needs}, but the target has {version}",
            "use syntax that the Python of every target accepts",
        ),
        "none": Text("Python {version} cannot read the file from this line on", "correct the syntax"),
    },
)
def python_version(view: TargetView):
    def find(package: Package, target: DistroTarget) -> Iterator[RejectedUse]:
        reported = set()
        for use in package.linked.syntax:
            if use.needs == 2 and use.at.path not in reported:
                reported.add(use.at.path)
                yield RejectedUse(use, use.what, "python 2")
            elif use.needs in (NO_PYTHON, NEVER_PYTHON):
                # What a newer Python than this one may read is not known.
                known = use.needs == NEVER_PYTHON or target.python <= sys.version_info.minor
                if view.target.python_major >= 3 and known and not _may_be_no_python(view, package, use.at.path):
                    yield RejectedUse(use, use.what, "none")
            elif use.needs > max(2, target.python) and view.target.python_major >= 3:
                yield RejectedUse(use, use.what, "newer", use.needs)

    yield from report_refused(view, find)
    for package in view if view.target.python_major == 2 else ():
        others = set(package.linked.scripts) - set(package.linked.plain_scripts)  # which may be for Python 3
        for use in package.linked.syntax:
            doubts = list_place_doubts(view, use.role)
            if use.needs not in (2, NO_PYTHON, NEVER_PYTHON) and use.plain:
                yield Diagnostic(use.at, use.what, package.name, kind="python 3", doubts=doubts)
            elif use.needs == 0 and use.what.startswith("`print`") and not others:
                yield Diagnostic(use.at, use.what, package.name, kind="print", doubts=(*doubts, Doubt.LATE))


def _may_be_no_python(view: TargetView, package: Package, path: str) -> bool:
    """Whether the first line alone says that a file is Python: neither its ending, nor that it is a program."""
    if path.endswith((".py", ".pyw")):
        return False
    items = (item for i in package.build.installs if i.kind in ("programs", "python", "files") for item in i.items)
    named = any(posixpath.normpath(item) == path for item in items)
    name = posixpath.basename(path)
    return not (named or name in package.linked.interpreted or name in list_references(view, package, "executable"))
