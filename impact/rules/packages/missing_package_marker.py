"""missing-package-marker: an ament_python package is not registered in the ament index.

What it does
    Reports packages that install programs or data, but whose data_files do not install a marker file with the name of
    the package into `share/ament_index/resource_index/packages`.

Why it breaks
    `ros2 run`, `ros2 launch` and get_package_share_directory() look for the package in this index. colcon still adds a
    missing marker, with a warning that it will stop doing so; a Debian package of the package has none.

Example
    data_files=[('share/sled', ['package.xml'])]

Use instead
    data_files=[('share/ament_index/resource_index/packages', ['resource/sled']), ('share/sled', ['package.xml'])]

Not reported
    data_files that setup.py computes; packages without setup.py, or without programs and data files.
"""

import posixpath

from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule
from .data_files import read_data_files

_INDEX = "share/ament_index/resource_index/packages"


@rule(
    severity="warning",
    texts=Text(
        "setup.py does not register `{package}` in the ament index",
        "add `('{index}', ['resource/{package}'])` to data_files; resource/{package} is an empty file",
    ),
)
def missing_package_marker(view: TargetView, package: Package):
    data = read_data_files(package)
    if data is None:
        return
    markers = data.find_in(_INDEX)
    # nonexistent-setup-path reports markers that do not exist.
    named = any(posixpath.basename(path) in (package.name, "*") for path in markers)
    if not named and all(posixpath.join(package.path, path) in package.files for path in markers):
        yield Diagnostic(At(data.setup, 1), package.name, package.name, {"index": _INDEX})
