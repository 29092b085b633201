"""Constants of released packages that the code of a workspace uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ....edges.memory import cache_method
from ...targets.constants import load_constants
from .code import FlowCode, Fn


class OutsideConstants:
    """Asks what constants are worth that a body of code has from released packages."""

    def __init__(self, code: FlowCode):
        self._code = code

    def find(self, path: str, fn: Fn) -> str | None:
        """The value of a constant by its path in a function: of a header that its file sees, or of a module of Python
        that is not here. None for what is neither, or may be several."""
        if fn.source.facts.language == "python":
            own = path.partition(".")[0] in fn.locals
            return None if own else self._find_in_modules(self._code.resolve_name(path, fn.source))
        if self._code.identify(path, fn).kind != "global":
            return None
        ending = f"::{path.replace('.', '::').removeprefix('::')}"
        rows = [row for names in self._list_headers(fn.source.path) for row in names.items()]
        found = {row for row in rows if f"::{row[0]}".endswith(ending)}
        return found.pop()[1] if len(found) == 1 else None

    def _find_in_modules(self, name: str) -> str | None:
        modules = load_constants().modules
        head, dot, _ = name.rpartition(".")
        while dot:
            if head in modules:
                return modules[head].get(name[len(head) + 1 :])
            head, dot, _ = head.rpartition(".")
        return None

    @cache_method
    def _list_headers(self, path: str) -> tuple[Mapping[str, str], ...]:
        """The constants of the released headers that a file of C++ sees."""
        return tuple(self._iterate_headers(path))

    def _iterate_headers(self, path: str) -> Iterator[Mapping[str, str]]:
        known = load_constants().headers
        seen = {header for one in self._code.list_seen_sources(path) for header in one.facts.includes}
        yield from (known[header] for header in sorted(seen) if header in known)
