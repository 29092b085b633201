"""Reviewed rows of known changes on classes, functions, constants and macros, by the name that a target lacks."""

from __future__ import annotations

from ...model.package import NameUse, is_header
from ...model.view import View
from ...targets.symbol import Symbol
from ...targets.target import Change

KINDS_OF_NAMES = ("api-removed", "api-renamed", "api-changed", "python-removed", "python-api")
"""The kinds of such rows."""
# Namespaces of libraries whose names are in the table without them.
_ROOTS = ("cv::", "boost::", "pcl::", "YAML::", "gazebo::", "rclcpp::", "ros::")


class ReviewedNames:
    """The reviewed rows on names that the target lacks, by name, and what the workspace calls so itself."""

    def __init__(self, view: View):
        self.cpp: dict[str, list[Change]] = {}
        self.python: dict[str, list[Change]] = {}
        self.early: dict[str, list[Change]] = {}
        for change in view.changes(*KINDS_OF_NAMES):
            if change.package in view.workspace.packages:
                continue  # what the workspace itself brings is as it brings it, whatever a release did
            if change.state == "removed" and change.old:
                rows = self.python if change.kind.startswith("python") else self.cpp
                rows.setdefault(change.old, []).append(change)
            elif change.state == "absent" and change.new:
                self.early.setdefault(change.new, []).append(change)
        # A method that a header of the workspace has may be meant wherever its name stands.
        self.own = {
            use.text
            for package in view.workspace
            for use in package.digest.names
            if use.language == "cpp" and is_header(use.at.path) and "::" not in use.text and not use.text.isupper()
        }
        self.own.update(name for package in view.workspace for name in package.digest.defined)

    def find(self, use: NameUse) -> list[Change]:
        """The rows on a name that is gone."""
        rows = self.python if use.language == "python" else self.cpp
        found = rows.get(use.text, [])
        if not found and use.language == "cpp" and use.text.count("::") == 1 and use.text.startswith(_ROOTS):
            found = rows.get(use.text.rsplit("::", 1)[-1], [])
        return found


def is_contradicted(view: View, symbol: Symbol, change: Change) -> bool:
    """Whether what is stored of the very release contradicts a reviewed row."""
    if change.library or change.kind == "api-changed":
        return False
    asked = symbol._replace(name=change.old, packages=(change.package,))
    return view.availability(asked).state in ("present", "deprecated")
