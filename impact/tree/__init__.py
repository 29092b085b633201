"""Where paths and bytes come from: a directory as it stands, or any revision of a git repository without a checkout.

WorkingTree and GitTree answer the same questions, name a file's content by the same id (git's blob id) and skip the
same folders, so whatever is known about a file's bytes holds for both.

Skipped, as colcon 0.21 and colcon-ros 0.5 do: folders that hold COLCON_IGNORE, AMENT_IGNORE, CATKIN_IGNORE, or the
_setup_util.py and _order_isolated_packages.py of an install space. Beyond colcon: folders that colcon or CMake has
built in (they hold colcon_build.rc, or CMakeCache.txt and no CMakeLists.txt); the database folders of version control;
build, install, devel and log at the root, hidden folders other than those of CI services and containers, and virtual
environments, each only where git governs the folder and tracks nothing below it. Without git every file counts as
tracked.

A link to a file counts as that file. A link to a folder is followed once per target, never into its own parents. A link
that leaves the tree, or leads into a database of version control, is named and not followed: what it leads to belongs
to somebody else. Whoever runs rosimpact may ask for links out of the tree to be followed; a workspace cannot.

Only regular files are read, as many bytes of each as its reader allows. What cannot be read, or is too large or too
many, costs that file or folder alone and is among the tree's problems.
"""

from .git import GitTree
from .joined import JoinedTree, open_merge_bases
from .paths import (
    LEAVES,
    PathProblem,
    Tree,
    TreeEntry,
    TreeError,
    compute_blob_id,
    find_ignore_marker,
    normalize_path,
    shown,
)
from .working import WorkingTree

__all__ = [
    "LEAVES", "GitTree", "JoinedTree", "PathProblem", "Tree", "TreeEntry", "TreeError", "WorkingTree",
    "compute_blob_id", "find_ignore_marker", "normalize_path", "open_merge_bases", "shown",
]  # fmt: skip
