"""missing-package-marker: an ament_python package is not registered in the ament index, or lacks its package.xml.

What it does
    Reports packages that install programs or data, but whose data_files do not install a marker file with the name of
    the package into `share/ament_index/resource_index/packages`, or package.xml into `share/<package>`.

Why it breaks
    `ros2 run`, `ros2 launch` and get_package_share_directory() look for the package in this index. colcon still adds a
    missing marker or package.xml, with a warning that it will stop doing so; a Debian package of the package has none.

Example
    data_files=[('share/sled', ['package.xml'])]

Use instead
    data_files=[('share/ament_index/resource_index/packages', ['resource/sled']), ('share/sled', ['package.xml'])]

Not reported
    data_files that setup.py computes; packages without setup.py, or without programs and data files.
"""

import posixpath
from fnmatch import fnmatch

from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule

_INDEX = "share/ament_index/resource_index/packages"


@rule(
    severity="warning",
    texts={
        "": Text(
            "setup.py does not register `{package}` in the ament index",
            "add `('{index}', ['resource/{package}'])` to data_files; resource/{package} is an empty file",
        ),
        "manifest": Text(
            "setup.py does not install `{subject}` into `share/{package}`",
            "add `('share/{package}', ['package.xml'])` to data_files",
        ),
    },
)
def missing_package_marker(view: TargetView, package: Package):
    own = [(path, setup) for path, setup in package.digest.setup if posixpath.dirname(path) == package.path]
    code = next((path for path, _ in own if posixpath.basename(path) == "setup.py"), None)
    if package.build_type != "ament_python" or code is None:
        return
    if any(setup.problems or any("data_files" in clause or "arguments" in clause for clause in setup.unresolved)
           for _, setup in own):  # fmt: skip
        return
    files = [(posixpath.normpath(destination), path) for _, setup in own for destination, path, _ in setup.data_files]
    if not files and not any(setup.entry_points or setup.packages for _, setup in own):
        return
    markers = [path for destination, path in files if destination == _INDEX]
    # nonexistent-setup-path reports markers that do not exist.
    named = any(posixpath.basename(path) in (package.name, "*") for path in markers)
    if not named and all(posixpath.join(package.path, path) in package.files for path in markers):
        yield Diagnostic(At(code, 1), package.name, package.name, {"index": _INDEX})
    manifests = {destination for destination, path in files if fnmatch("package.xml", posixpath.normpath(path))}
    if files and f"share/{package.name}" not in manifests:
        yield Diagnostic(At(code, 1), "package.xml", package.name, kind="manifest")
