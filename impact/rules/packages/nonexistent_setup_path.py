"""nonexistent-setup-path: setup.py of an ament_python package names a file or folder that does not exist.

What it does
    Reports files in data_files and scripts, and packages listed by name, that do not exist, in setup.py, setup.cfg and
    pyproject.toml. Also reports folders in data_files, since setuptools copies only files.

Why it breaks
    setuptools stops: "can't copy 'resource/sled': doesn't exist or not a regular file", "package directory 'sled' does
    not exist".

Example
    data_files=[('share/sled/launch', ['launch/sled.launch.py'])]       # but the file is launch/sled_launch.py

Use instead
    data_files=[('share/sled/launch', ['launch/sled_launch.py'])]

Not reported
    Patterns given to glob(), which may match nothing; paths that setup.py computes; folders that were not read, such as
    submodules; packages that CMake builds, and packages of ROS 1.
"""

import posixpath
import re
from collections.abc import Iterator

from ...facts.setup import SetupFile
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule
from .absent_paths import is_absent

# Patterns, and paths of the machine.
_PATTERN = re.compile(r"[*?\[]|^/")


@rule(
    texts={
        "file": Text(
            "`{subject}` is listed for installation but does not exist", "correct the path, or create the file"
        ),
        "folder": Text(
            "`{subject}` is a folder, but data_files accepts only files",
            "list its files, e.g. with `glob('{subject}/*')`",
        ),
        "package": Text(
            "Python package `{subject}` is listed for installation, but its folder does not exist",
            "list only packages that exist, or use find_packages()",
        ),
    },
)
def nonexistent_setup_path(view: TargetView, package: Package):
    if package.build_type != "ament_python":
        return
    for file, setup in package.linked.setup:
        folder = posixpath.dirname(file)
        if folder != package.path:
            continue
        for name, path, line, kind in _list_paths(setup):
            place = posixpath.normpath(posixpath.join(folder, path))
            if posixpath.relpath(place, folder or ".").startswith(".."):
                continue
            if kind == "package" and f"{place}.py" in package.files:
                continue  # some list single modules as packages
            is_folder = place in package.folders and kind != "package"
            if is_folder or is_absent(view, package, place):
                yield Diagnostic(At(file, line), name, package.name, {}, "folder" if is_folder else kind)


def _list_paths(setup: SetupFile) -> Iterator[tuple[str, str, int, str]]:
    """What a setup file names, its path below the package, the line, and the kind of the text that reports it."""
    seen = set()
    for _, path, line in setup.data_files:
        if path and path not in seen and not _PATTERN.search(path):
            seen.add(path)
            yield path, path, line, "file"
    for path in setup.scripts:
        if not _PATTERN.search(path):
            yield path, path, 1, "file"
    for name in setup.packages:
        if name != "*":
            yield name, posixpath.dirname(setup.list_module_paths("", name)[1]), 1, "package"
