"""What launch files give to the nodes they start, line by line: shared by the rules on remappings and parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Protocol, TypeVar

from ...model.flow.launches import Start
from ...model.workspace import Workspace


class Placed(Protocol):
    """Something given at a line of a file."""

    @property
    def path(self) -> str: ...

    @property
    def line(self) -> int: ...


T = TypeVar("T", bound=Placed)


def given(
    workspace: Workspace, of: Callable[[Start], Iterable[T]], name: Callable[[T], str]
) -> Iterator[tuple[tuple[str, int, str], list[tuple[Start, T]]]]:
    """Path, line and name of each thing given, with all starts that it is given to, in the order of the launches.

    of: what a start is given; name: what it is called. Lines that give it to a program outside of the workspace too are
    left out.
    """
    found: dict[tuple[str, int, str], list[tuple[Start, T]]] = {}
    elsewhere = {place for launch in workspace.launches for place in launch.elsewhere}
    for launch in workspace.launches:
        for start in launch.starts:
            for each in of(start):
                found.setdefault((each.path, each.line, name(each)), []).append((start, each))
    return ((place, rows) for place, rows in found.items() if f"{place[0]}:{place[1]}" not in elsewhere)
