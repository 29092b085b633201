"""What the data_files of ament_python packages install, as the rules on them ask for it."""

import posixpath
from fnmatch import fnmatchcase
from typing import NamedTuple

from ...model.cmake.build import Install
from ..vocabulary import At, Package


class DataFiles(NamedTuple):
    """The data_files of a package. setup: the path of setup.py. files: (folder of the prefix, path as written)."""

    setup: str
    files: tuple[tuple[str, str], ...]

    def find_in(self, folder: str) -> list[str]:
        """The paths of what is installed into a folder of the prefix."""
        return [path for destination, path in self.files if destination == folder]


def read_data_files(package: Package) -> DataFiles | None:
    """The data_files of an ament_python package; None where not all of them can be known, or where it installs nothing
    at all."""
    own = [(path, setup) for path, setup in package.linked.setup if posixpath.dirname(path) == package.path]
    code = next((path for path, _ in own if posixpath.basename(path) == "setup.py"), None)
    if package.build_type != "ament_python" or code is None:
        return None
    if any(setup.problems or any("data_files" in clause or "arguments" in clause for clause in setup.unresolved)
           for _, setup in own):  # fmt: skip
        return None
    files = tuple((posixpath.normpath(place), path) for _, setup in own for place, path, _ in setup.data_files)
    if not files and not any(setup.entry_points or setup.packages for _, setup in own):
        return None
    return DataFiles(code, files)


def list_copied(package: Package) -> list[Install] | None:
    """data_files as install rules of CMake, with the files that each pattern of glob() finds in the tree; None as for
    read_data_files()."""
    data = read_data_files(package)
    if data is None:
        return None
    rules = []
    for place, path in data.files:
        pattern = posixpath.normpath(posixpath.join(package.path, path))
        items = tuple(file for file in package.linked.files if _matches(file, pattern))
        rules.append(Install("files", items or (pattern,), place, At(data.setup, 1)))
    return rules


def _matches(path: str, pattern: str) -> bool:
    """Whether glob() finds a path, where `**` stands for any folders."""
    if "**" not in pattern and path.count("/") != pattern.count("/"):
        return False
    return fnmatchcase(path, pattern.replace("**/", "*"))
