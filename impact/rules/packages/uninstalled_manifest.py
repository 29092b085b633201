"""uninstalled-manifest: an ament_python package does not install its package.xml.

What it does
    Reports packages whose data_files do not install package.xml into `share/` and the name of the package.

Why it breaks
    `ros2 pkg` and plugin loaders read the manifest there. colcon still adds a missing one, with a warning
    that it will stop doing so; a Debian package of the package has none.

Example
    data_files=[('shared/sled', ['package.xml'])]

Use instead
    data_files=[('share/sled', ['package.xml'])]

Not reported
    data_files that setup.py computes; packages without setup.py, or without programs and data files.
"""

import fnmatch

from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule
from .data_files import read_data_files


@rule(
    severity="warning",
    texts={
        "absent": Text("setup.py does not install `package.xml`", "add `('{share}', ['package.xml'])` to data_files"),
        "elsewhere": Text("`package.xml` is installed into `{folder}`", "install it into `{share}`"),
    },
)
def uninstalled_manifest(view: TargetView, package: Package):
    data = read_data_files(package)
    share = f"share/{package.name}"
    if data is None or any(fnmatch.fnmatchcase("package.xml", path.removeprefix("./")) for path in data.find_in(share)):
        return
    folder = next((place for place, path in data.files if path == "package.xml"), "")
    if "$" in folder or "*" in folder:
        return
    kind = "elsewhere" if folder else "absent"
    yield Diagnostic(At(data.setup, 1), "package.xml", package.name, {"share": share, "folder": folder}, kind)
