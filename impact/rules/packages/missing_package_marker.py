"""missing-package-marker: an ament_python package does not install its marker in the package index.

What it does
    Looks in data_files of setup.py for `share/ament_index/resource_index/packages` with a file that is called like the
    package, where setup.py installs programs or data.

Why it breaks
    `ros2 run`, `ros2 launch` and get_package_share_directory() look a package up in the index. colcon puts the marker
    in for now and says that it will stop doing so; a Debian package of it has none.

Severity
    warning.

Example
    data_files=[('share/sled', ['package.xml'])]

Use instead
    data_files=[('share/ament_index/resource_index/packages', ['resource/sled']), ('share/sled', ['package.xml'])]

Not reported
    data_files that only running setup.py tells; packages without setup.py, and without programs and launch files.
"""

import posixpath

from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule

_INDEX = "share/ament_index/resource_index/packages"


@rule(
    severity="warning",
    texts=Text(
        "`{package}` does not install its marker in the package index",
        "add ('{index}', ['resource/{package}']) to data_files, with the empty file resource/{package}",
    ),
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
    if not files and not any(setup.entry_points for _, setup in own):
        return
    markers = [path for destination, path in files if destination == _INDEX]
    # Of files that do not exist, nonexistent-setup-path tells.
    named = any(posixpath.basename(path) in (package.name, "*") for path in markers)
    if not named and all(posixpath.join(package.path, path) in package.files for path in markers):
        yield Diagnostic(At(code, 1), package.name, package.name, {"index": _INDEX})
