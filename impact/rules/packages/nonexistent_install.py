"""nonexistent-install: an install rule names a file or folder that does not exist.

What it does
    Reports files, programs and folders in install() that neither the tree has nor the build makes, patterns such as
    `lib/*.so`, which install() does not expand, and folders that ament_python_install_package() is to find.

Why it breaks
    `make install` stops: "file INSTALL cannot find".

Severity
    error; warning for folders of Python packages, for folders of headers, which may be there and empty, for folders of
    which only matching files are installed, since CMake goes on without them, and where something is run while the
    package is configured or built, which may write them.

Example
    install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})     # there is no folder `config`

Use instead
    install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})

Not reported
    Libraries, what is OPTIONAL, and folders `lib` and `bin`, which git cannot keep while they are empty; files that the
    build makes; rules under a condition that is unknown on the target.
"""

import posixpath
import re

from ...model.absent_headers import may_be_made
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .absent_paths import is_absent
from .install_rules import list_copying_rules

# Endings of files that people write; the build itself may write others.
_BY_HAND = (".launch", ".xml", ".yaml", ".py", ".h", ".hpp", ".md", ".rviz")
# What the build makes there, such as the modules of interfaces, is not always known.
_MAYBE_MADE = (Doubt.INCOMPLETE,)


@rule(
    group="missing-install",
    texts={
        "absent": Text("`{subject}` is installed but does not exist", "create it, or drop it from the rule"),
        "pattern": Text(
            "install({kind}) does not expand `{subject}` and finds no file of that name",
            "use install(DIRECTORY) with `FILES_MATCHING PATTERN`, or list the files by `file(GLOB)`",
        ),
        "nothing": Text("`{subject}` does not exist, so the rule installs nothing", "correct the folder"),
        "python": Text(
            "`{subject}` does not exist, so ament_python_install_package() stops", "create it, or name the folder"
        ),
    },
)
def nonexistent_install(view: TargetView, package: Package):
    for install in package.build.installs:
        if install.kind == "python" and install.destination and view.is_sure(install.conditions):
            for path in map(posixpath.normpath, install.items):
                if "$" not in path and is_absent(view, package, path):
                    yield Diagnostic(install.at, package.strip_path(path), package.name, {}, "python", _MAYBE_MADE)
    for install in list_copying_rules(view, package):
        # A folder of which only some files are installed may be missing.
        kind, doubts = ("nothing", (Doubt.DISTURBS,)) if install.only else ("absent", ())
        for item in () if install.optional else install.items:
            path = posixpath.normpath(item)
            if re.search(r"[*?]", item) and "$<" not in item:
                subject, data = path.removeprefix(f"{package.path}/"), {"kind": install.kind.upper()}
                yield Diagnostic(install.at, subject, package.name, data, "pattern", doubts=doubts)
                continue
            if item.startswith(("/", "build", "devel")) or re.search(r"[$<>]", item):
                continue
            if package.path and not path.startswith(package.path + "/"):
                continue
            besides = ()
            if install.kind == "directory" and (role := _may_be_empty(package, path)):
                if role != "include" or install.only:
                    continue
                besides = (Doubt.LATE,)  # nothing stops where the folder is there, empty
            if install.kind == "files" and "." in path and not path.endswith(_BY_HAND):
                continue
            if is_absent(view, package, path):
                subject = package.strip_path(path)
                made = not may_be_made(package, posixpath.basename(path)) or Doubt.INCOMPLETE
                yield Diagnostic(install.at, subject, package.name, kind=kind, doubts=(*doubts, *besides, made))


def _may_be_empty(package: Package, path: str) -> str:
    """What a folder is for, `include`, `lib` or `bin`, that may be there and that git cannot keep while it is empty:
    not one of `include` beside others that are there."""
    above = f"{posixpath.dirname(path)}/"
    if "/include/" in f"/{above}" and any(name.startswith(above) for name in package.linked.files):
        return ""
    role = re.search(r"(?:^|/)(include|lib|bin)(?:/|$)", path)
    return role.group(1) if role else ""
