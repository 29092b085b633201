"""Reviewed rows of known changes on classes, functions, constants and macros, by the name that a target lacks."""

from collections.abc import Iterable

from ...model.package import NameUse, is_header
from ...targets.symbol import Symbol
from ...targets.target import ChangeInForce
from ..vocabulary import TargetView

_CPP_KINDS = ("api-removed", "api-renamed", "api-changed")
_PYTHON_KINDS = ("python-removed", "python-api")
KINDS_OF_NAMES = (*_CPP_KINDS, *_PYTHON_KINDS)
"""The kinds of such rows."""
# Namespaces of libraries whose names are in the table without them.
_ROOTS = ("cv::", "boost::", "pcl::", "YAML::", "gazebo::", "rclcpp::", "ros::")


class ReviewedNames:
    """The reviewed rows on names that the target lacks, by name, and what the workspace calls so itself."""

    def __init__(self, view: TargetView):
        self._view = view
        self._by_name = view.target.changes().by_name
        self._packages = view.workspace.packages
        # A method that a header of the workspace has may be meant wherever its name stands.
        self.own = {
            use.text
            for package in view.workspace
            for use in package.digest.names
            if use.language == "cpp" and is_header(use.at.path) and "::" not in use.text and not use.text.isupper()
        }
        self.own.update(name for package in view.workspace for name in package.digest.defined)

    def find(self, use: NameUse) -> list[ChangeInForce]:
        """The rows on a name that is gone."""
        kinds = _PYTHON_KINDS if use.language == "python" else _CPP_KINDS
        found = self._list(kinds, use.text, "removed")
        if not found and use.language == "cpp" and use.text.count("::") == 1 and use.text.startswith(_ROOTS):
            found = self._list(kinds, use.text.rsplit("::", 1)[-1], "removed")
        if any(row.library for row in found) and self._is_copy(use.at.path):
            return [row for row in found if not row.library]  # its own version has the names that it uses
        return found

    def _is_copy(self, path: str) -> bool:
        """Whether a file is a library's own header, in a copy that the workspace carries."""
        parts = path.split("/")
        return any(self._view.machine.is_from_library("/".join(parts[at:])) for at in range(1, len(parts) - 2))

    def find_early(self, name: str) -> list[ChangeInForce]:
        """The rows on a name that is not there yet."""
        return self._list(KINDS_OF_NAMES, name, "absent")

    def _list(self, kinds: Iterable[str], name: str, state: str) -> list[ChangeInForce]:
        # What the workspace itself brings is as it brings it, whatever a release did.
        rows = (row for kind in kinds for row in self._by_name.get((kind, name), ()))
        return [row for row in rows if row.state == state and row.package not in self._packages]


def is_contradicted(view: TargetView, symbol: Symbol, change: ChangeInForce) -> bool:
    """Whether what is stored of the very release contradicts a reviewed row."""
    if change.library or change.kind == "api-changed":
        return False
    asked = symbol._replace(name=change.old, packages=(change.package,))
    return view.find_availability(asked).state in ("present", "deprecated", "upcoming")
