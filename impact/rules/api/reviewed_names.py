"""Reviewed rows of known changes on classes, functions, constants and macros, by the name that a target lacks."""

from ...model.package import NameUse, is_header
from ...targets.symbol import Availability
from ..vocabulary import TargetView

# Namespaces of libraries whose names are in the table without them.
_ROOTS = ("cv::", "boost::", "pcl::", "YAML::", "gazebo::", "rclcpp::", "ros::")


class ReviewedNames:
    """The reviewed rows on names that the target lacks, by name, and what the workspace calls so itself."""

    def __init__(self, view: TargetView):
        self._view = view
        # A method that a header of the workspace has may be meant wherever its name stands.
        self.own = {
            use.text
            for package in view.workspace
            for use in package.linked.names
            if use.language == "cpp" and is_header(use.at.path) and "::" not in use.text and not use.text.isupper()
        }
        self.own.update(name for package in view.workspace for name in package.linked.defined)

    def find(self, use: NameUse) -> list[Availability]:
        """The rows on a name that is gone, or changed its meaning."""
        kind = "python" if use.language == "python" else "c++"
        found = self.list_rows(kind, use.text, "removed", "changed")
        if not found and use.language == "cpp" and use.text.count("::") == 1 and use.text.startswith(_ROOTS):
            found = self.list_rows(kind, use.text.rsplit("::", 1)[-1], "removed", "changed")
        if any(row.library for row in found) and self._is_copy(use.at.path):
            return [row for row in found if not row.library]  # its own version has the names that it uses
        return found

    def _is_copy(self, path: str) -> bool:
        """Whether a file is a library's own header, in a copy that the workspace carries."""
        parts = path.split("/")
        return any(self._view.machine.is_from_library("/".join(parts[at:])) for at in range(1, len(parts) - 2))

    def list_rows(self, kind: str, name: str, *states: str) -> list[Availability]:
        """The rows on a name that say that it is in one of these states."""
        # What the workspace itself brings is as it brings it, whatever a release did.
        rows = self._view.find_reviewed(kind, name)
        return [row for row in rows if row.state in states and not self._view.may_have(row.package)]
