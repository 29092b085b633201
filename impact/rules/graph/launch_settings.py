"""Remappings and parameters that launch files set for the nodes they start, line by line."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from ...model.flow.launches import GivenParameter, GivenRemapping, LaunchedNode, RefusedValue
from ...model.flow.workspace import get_flow
from ...model.workspace import Workspace

T = TypeVar("T", GivenRemapping, GivenParameter, RefusedValue)


def group_by_line(
    workspace: Workspace, of: Callable[[LaunchedNode], Iterable[T]], name: Callable[[T], str]
) -> Iterator[tuple[tuple[str, int, str], list[tuple[LaunchedNode, T]]]]:
    """(path, line, name) of each setting, with all starts that it applies to, in the order of the launch files.

    of: the settings of a start. name: the name of a setting. Lines that also apply to a program outside of the
    workspace are left out.
    """
    found: dict[tuple[str, int, str], list[tuple[LaunchedNode, T]]] = {}
    elsewhere = {place for launch in get_flow(workspace).launches for place in launch.elsewhere}
    for launch in get_flow(workspace).launches:
        for start in launch.starts:
            for each in of(start):
                found.setdefault((each.path, each.line, name(each)), []).append((start, each))
    return ((place, rows) for place, rows in found.items() if f"{place[0]}:{place[1]}" not in elsewhere)
