"""Lines of the sources, from the debug information of clang."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable

from ..outcomes import NOWHERE, CodeLine
from .reader import IrUnit

_LINE = re.compile(r"\bline: (\d+)")
_SCOPE = re.compile(r"\bscope: !(\d+)")
_INLINED = re.compile(r"\binlinedAt: !(\d+)")
_FILE = re.compile(r"\bfile: !(\d+)")
_FILE_NAME = re.compile(r'\bfilename: "((?:[^"\\]|\\.)*)"')
_DIRECTORY = re.compile(r'\bdirectory: "((?:[^"\\]|\\.)*)"')


class PlaceReader:
    """Finds the line of the workspace that an instruction belongs to."""

    def __init__(self, is_workspace_file: Callable[[str], bool]):
        self._is_workspace_file = is_workspace_file
        self._known: dict[tuple[int, int], CodeLine] = {}
        self._files: dict[tuple[int, str], str] = {}
        self._answers: dict[str, bool] = {}

    def find_place(self, unit: IrUnit, location: int) -> CodeLine:
        """The innermost line of a workspace's file at a location: its own, or where it was inlined."""
        if not location:
            return NOWHERE
        key = (unit.number, location)
        if key not in self._known:
            self._known[key] = self._look_up(unit, str(location))
        return self._known[key]

    def has_line(self, unit: IrUnit, location: int) -> bool:
        """Whether a location names a line: that of instructions that were joined does not."""
        line = _LINE.search(unit.metadata.get(str(location), "")) if location else None
        return line is not None and line[1] != "0"

    def make_place(self, path: str, line: int) -> CodeLine:
        """A line of the workspace, or none."""
        return CodeLine(path, line) if line and self._is_of_workspace(path) else NOWHERE

    def _look_up(self, unit: IrUnit, location: str) -> CodeLine:
        while location:
            text = unit.metadata.get(location, "")
            scope, line = _SCOPE.search(text), _LINE.search(text)
            if scope and line and int(line[1]):
                path = self._find_file(unit, scope[1])
                if path and self._is_of_workspace(path):
                    return CodeLine(path, int(line[1]))
            inlined = _INLINED.search(text)
            location = inlined[1] if inlined else ""
        return NOWHERE

    def _is_of_workspace(self, path: str) -> bool:
        if path not in self._answers:
            self._answers[path] = self._is_workspace_file(path)
        return self._answers[path]

    def _find_file(self, unit: IrUnit, scope: str) -> str:
        key = (unit.number, scope)
        if key not in self._files:
            text = unit.metadata.get(scope, "")
            found = _FILE.search(text)
            if found:
                name_of = unit.metadata.get(found[1], "")
                name, directory = _FILE_NAME.search(name_of), _DIRECTORY.search(name_of)
                path = name[1] if name else ""
                if path and directory and not path.startswith("/"):
                    path = posixpath.join(directory[1], path)
                self._files[key] = posixpath.normpath(path) if path else ""
            else:
                outer = _SCOPE.search(text)
                self._files[key] = self._find_file(unit, outer[1]) if outer and outer[1] != scope else ""
        return self._files[key]
