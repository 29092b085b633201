"""The systems of rosimpact.toml, as the launch files of a workspace and of its base."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from ..config import SystemSetting
from ..model.flow.system import ChosenLaunch
from ..model.flow.workspace import get_flow
from ..model.workspace import Workspace
from ..tree import Tree
from .graph import parse_launch
from .session import CheckError


def choose_systems(
    path: Path, systems: Mapping[str, SystemSetting], states: Iterable[tuple[Workspace, Tree]]
) -> list[str]:  # fmt: skip
    """Tells the flow of workspaces which launch files are started together. path: of the workspace; states: it and its
    base. Gives notes on systems that a state has no launch file for."""
    notes: list[str] = []
    for place, (workspace, tree) in enumerate(states):
        found: dict[str, tuple[ChosenLaunch, ...]] = {}
        for name, system in systems.items():
            try:
                own = [parse_launch(path, workspace, tree, f"[systems.{name}]", text) for text in system.launch]
            except CheckError as error:
                notes += [] if place else [str(error)]
                continue
            found[name] = tuple(one._replace(arguments={**system.arguments, **one.arguments}) for one in own)
        get_flow(workspace).systems = found
    return notes
