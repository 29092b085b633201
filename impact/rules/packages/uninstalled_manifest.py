"""uninstalled-manifest: an ament_python package, or one of plain CMake, does not install its package.xml.

What it does
    Reports packages whose data_files do not install package.xml into `share/` and the name of the package, and packages
    of the build type cmake whose install rules leave it out.

Why it breaks
    `ros2 pkg` and plugin loaders read the manifest there. colcon still adds a missing one, with a warning
    that it will stop doing so; a Debian package of the package has none, nor has a package of plain CMake, whatever
    builds it. Source: REP 136.

Severity
    warning; note for a package of plain CMake whose manifest exports nothing: nobody is known to read it there.

Example
    data_files=[('shared/sled', ['package.xml'])]

Use instead
    data_files=[('share/sled', ['package.xml'])]

Not reported
    data_files that setup.py computes; packages without setup.py, or without programs and data files; packages of plain
    CMake that install nothing, or what is not known.
"""

import fnmatch
import posixpath

from ...model.cmake.interpreter import calls_unmodelled
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule
from .data_files import read_data_files
from .install_rules import is_installed


@rule(
    severity="warning",
    texts={
        "plain": Text(
            "no install rule takes `package.xml`", "install(FILES package.xml DESTINATION share/${{PROJECT_NAME}})"
        ),
        "absent": Text("setup.py does not install `package.xml`", "add `('{share}', ['package.xml'])` to data_files"),
        "elsewhere": Text("`package.xml` is installed into `{folder}`", "install it into `{share}`"),
    },
)
def uninstalled_manifest(view: TargetView, package: Package):
    if package.build_type == "cmake":
        yield from _check_plain(package)
        return
    data = read_data_files(package)
    share = f"share/{package.name}"
    if data is None or any(fnmatch.fnmatchcase("package.xml", path.removeprefix("./")) for path in data.find_in(share)):
        return
    folder = next((place for place, path in data.files if path == "package.xml"), "")
    if "$" in folder or "*" in folder:
        return
    kind = "elsewhere" if folder else "absent"
    yield Diagnostic(At(data.setup, 1), "package.xml", package.name, {"share": share, "folder": folder}, kind)


def _check_plain(package: Package):
    """A package of plain CMake, for which no function of ament or catkin installs the manifest."""
    build, own = package.build, posixpath.join(package.path, "package.xml")
    if not build.installs or build.unresolved or build.builds_others or is_installed(build.installs, own):
        return
    if build.packaged is None and not calls_unmodelled(build):
        read = any(export.tag != "build_type" for export in package.manifest.exports)
        doubts = (read or Doubt.UNCHECKED,)
        yield Diagnostic(At(build.files[0], 1), "package.xml", package.name, kind="plain", doubts=doubts)
