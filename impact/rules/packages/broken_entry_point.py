"""broken-entry-point: an entry point of setup.py names a module that does not exist or is not installed.

What it does
    Reports console_scripts entry points of ament_python packages whose module does not exist, or lies in a Python
    package that setup() does not install. undefined-name reports functions that the module does not define.

Why it breaks
    The program is installed, but stops with a ModuleNotFoundError when it is started.

Example
    entry_points={'console_scripts': ['drive = sled.driver:main']}      # but the module is sled/drive.py

Use instead
    entry_points={'console_scripts': ['drive = sled.drive:main']}

Not reported
    Modules of other packages; lists of packages that setup.py computes; folders that were not read.
"""

import posixpath

from ...facts.setup import SetupFile
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule


@rule(
    texts={
        "absent": Text("entry point `{program}` names module `{subject}`, which does not exist",
                       "correct the module path in the entry point"),
        "not installed": Text(
            "entry point `{program}` names module `{subject}`, but setup() does not install package `{owner}`",
            "add `{owner}` to `packages`, or use find_packages()",
        ),
    },
)  # fmt: skip
def broken_entry_point(view: TargetView, package: Package):
    for file, setup in package.linked.setup:
        folder = posixpath.dirname(file)
        if folder != package.path or package.build_type != "ament_python":
            continue
        for program, module, line, _ in setup.entry_points:
            own = posixpath.dirname(setup.list_module_paths("", module.partition(".")[0])[1])
            places = setup.list_module_paths(folder, module)
            if any(map(view.workspace.is_unread, places)) or not package.has_files(own):
                continue  # a module of another package
            if package.files.isdisjoint(places):
                yield Diagnostic(At(file, line), module, package.name, {"program": program}, "absent")
            elif (missing := _find_uninstalled(setup, module, places[1] in package.files)) is not None:
                data = {"program": program, "owner": missing}
                yield Diagnostic(At(file, line), module, package.name, data, "not installed")


def _find_uninstalled(setup: SetupFile, module: str, is_package: bool) -> str | None:
    """The Python package that a module lies in, where setup() surely does not install it."""
    name = module if is_package else module.rpartition(".")[0]
    known = bool(setup.packages) and not any(
        clause.startswith(("packages", "arguments")) for clause in setup.unresolved
    )
    return name if name and known and "*" not in setup.packages and name not in setup.packages else None
