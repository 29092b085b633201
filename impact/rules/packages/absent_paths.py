"""Paths that neither the tree has nor the build makes, as the rules on them ask for it."""

import posixpath
import re

from ..vocabulary import Package, TargetView

# What compilers and linkers write.
_BUILT = re.compile(r"\.(?:o|obj|a|dylib|so(?:\.[\d.]+)?)\Z")


def is_absent(view: TargetView, package: Package, path: str) -> bool:
    """True for a path, relative to the workspace, that is neither a file or folder of its packages, nor configured,
    built or otherwise made by the package, nor in a folder that was not read."""
    if path in package.files or path in package.folders or path in ("", ".", package.path) or _BUILT.search(path):
        return False
    if f"{path}.in" in package.files or view.workspace.is_unread(path):
        return False
    if any(path in other.files for other in view.list_built()):
        return False
    name = posixpath.basename(path)
    return not any(
        made.rstrip("/").rpartition("/")[2] == name
        or made.startswith(f"{path}/")
        or (made.endswith("/") and f"{path}/".startswith(made))
        for made in package.build.made
    )
