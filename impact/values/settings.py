"""Values of parameters that launch files give nodes, for what these send."""

from __future__ import annotations

from collections.abc import Sequence

from ..model.flow.workspace import get_flow
from ..model.parameter_values import GivenValue
from ..model.workspace import Workspace
from .narrowing import ParameterValues


def find_parameters(workspace: Workspace, nodes: Sequence[str]) -> ParameterValues:
    """What the parameters of some nodes may be, by name, over all launch files that start one of them: see
    ParameterValues; an empty tuple for what is not known."""
    starts = [one for launch in get_flow(workspace).launches for one in launch.starts if one.node in nodes]
    given = [{value.name: value for value in one.values} for one in starts]
    names = dict.fromkeys(name for row in given for name in row)
    found: dict[str, tuple[str | float | None, ...]] = {}
    for name in names:
        values = [_read_value(row[name]) if name in row else (None,) for row in given]
        found[name] = tuple(dict.fromkeys(value for each in values for value in each)) if all(values) else ()
    return found


def _read_value(value: GivenValue) -> tuple[str | float | None, ...]:
    """A number or truth value; nothing for others."""
    if value.type == "bool":
        return (value.text.lower() == "true",)
    if value.type in ("integer", "double") and len(value.numbers) == 1:
        number = value.numbers[0]
        return (int(number) if value.type == "integer" else float(number),)
    return ()
