"""broken-entry-point: an entry point of setup.py names a module that is not there, or not installed.

What it does
    Looks for the modules of the entry points under console_scripts in packages of Python: whether the tree has them,
    and whether the packages that setup() lists hold them. That a module lacks the function, undefined-name says.

Why it breaks
    The program is installed and stops when it is started: ModuleNotFoundError.

Severity
    error.

Example
    entry_points={'console_scripts': ['drive = sled.driver:main']}      # and the module is sled/drive.py

Use instead
    entry_points={'console_scripts': ['drive = sled.drive:main']}

Not reported
    Modules of other packages; packages that only running setup.py tells; folders that were not read.
"""

import posixpath

from ...facts.setup import SetupFile
from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule


@rule(
    texts={
        "absent": Text("the program `{program}` starts the module `{subject}`, which does not exist",
                       "name the module that is there"),
        "not installed": Text(
            "the program `{program}` starts the module `{subject}`, and setup() does not install `{folder}`",
            "add `{folder}` to `packages`, or use find_packages()",
        ),
    },
)  # fmt: skip
def broken_entry_point(view: TargetView, package: Package):
    for file, setup in package.digest.setup:
        folder = posixpath.dirname(file)
        if folder != package.path or package.build_type != "ament_python":
            continue
        for program, module, line, _ in setup.entry_points:
            own = posixpath.dirname(setup.places_of("", module.partition(".")[0])[1])
            places = setup.places_of(folder, module)
            if any(map(view.workspace.is_unread, places)) or not package.has_files(own):
                continue  # a module of another package
            if package.files.isdisjoint(places):
                yield Diagnostic(At(file, line), module, package.name, {"program": program}, "absent")
            elif (missing := _find_uninstalled(setup, module, places[1] in package.files)) is not None:
                data = {"program": program, "folder": missing}
                yield Diagnostic(At(file, line), module, package.name, data, "not installed")


def _find_uninstalled(setup: SetupFile, module: str, is_package: bool) -> str | None:
    """The Python package that a module lies in, where setup() surely does not install it."""
    name = module if is_package else module.rpartition(".")[0]
    told = bool(setup.packages) and not any(clause.startswith(("packages", "arguments")) for clause in setup.unresolved)
    return name if name and told and "*" not in setup.packages and name not in setup.packages else None
