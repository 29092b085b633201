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
        if any(row.library for row in found):  # a copy has the names that it uses
            copied = self._is_copy(use.at.path)
            found = [row for row in found if not row.library or not (copied or self._is_main(use.at.path, row.package))]
        return found

    def _is_copy(self, path: str) -> bool:
        """Whether a file is a library's own header, in a copy that the workspace carries."""
        parts = path.split("/")
        return any(self._view.machine.is_from_library("/".join(parts[at:])) for at in range(1, len(parts) - 2))

    def _is_main(self, path: str, library: str) -> bool:
        """Whether a file is the main header of a library, or the source beside it, in a copy of the workspace: they are
        called as the library is (`tinyxml2.h`), and so is a header that the platform's package has."""
        if path.rpartition("/")[2].rpartition(".")[0] != library:
            return False
        platform = self._view.target.platform
        names = (f"{library}.h", f"{library}.hpp")
        names = tuple(name for name in names if self._view.providers.has_system_header(name, platform))
        headers = (header for package in self._view.workspace for header in package.linked.headers)
        return any(header.rpartition("/")[2] in names for header in headers)

    def list_rows(self, kind: str, name: str, *states: str) -> list[Availability]:
        """The rows on a name that say that it is in one of these states."""
        # What the workspace itself brings is as it brings it, whatever a release did.
        rows = self._view.find_reviewed(kind, name)
        return [row for row in rows if row.state in states and not self._view.may_have(row.package)]
