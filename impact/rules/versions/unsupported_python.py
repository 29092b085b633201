"""unsupported-python: a package does not accept the target's Python.

What it does
    Compares `requires-python` in pyproject.toml, and `python_requires` in setup.py and setup.cfg, with the target's
    Python.

Why it breaks
    pip stops with "requires a different Python". colcon does not ask, so the package is installed for a Python that its
    authors excluded.

Severity
    warning, since colcon installs the package all the same.

Example
    requires-python = ">=3.8,<3.11"             # Ubuntu noble has Python 3.12

Use instead
    requires-python = ">=3.8"

Not reported
    Setup files that do not install the package: those in folders below it, and those of packages that are built with
    ament_cmake.
"""

from ...targets.requirements import find_refused_python
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule


@rule(
    severity="warning",
    texts=Text(
        "`{package}` accepts Python `{subject}`, but the target has {version}",
        help="accept the Python of every target",
    ),
)
def unsupported_python(view: TargetView, package: Package):
    for path, setup in package.setup_files:
        asked = setup.python_requires
        version = find_refused_python(view.target, asked.text) if asked is not None else ""
        if asked is not None and version:
            yield Diagnostic(At(path, asked.line), asked.text, package.name, {"version": version})
