"""Builds data/gazebo_topics.json.zst: the topics and services that plugins of Gazebo Classic have in ROS 2.

They are those of the message-flow graph of gazebo_ros_pkgs at its newest release for ROS 2, by the library that a world
or a model names, as far as the code gives their names.

    python -P -m rosimpact.databuild.gazebo_topics CLONES      # ros-simulation+gazebo_ros_pkgs
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

from ..edges.groups import group_pairs
from ..impact.analysis.session import open_tree
from ..impact.facts.store import Store
from ..impact.model.flow.graph import Endpoint
from ..impact.model.flow.workspace import get_flow, link_for_flow
from ..impact.targets.gazebo_topics import GazeboTopic, GazeboTopics
from ..impact.targets.tables import DATA
from ..impact.targets.version import parse
from .git import BuildError, open_repository
from .surface.releases import find_git_directory
from .table_file import write_table

_RELEASE = re.compile(r"refs/tags/(3\.\d+\.\d+)\Z")


def build_table(clone: Path) -> GazeboTopics:
    """The table from the clone. Raises BuildError."""
    folder = find_git_directory(clone) or clone
    versions = sorted((m[1] for name in open_repository(folder).references if (m := _RELEASE.match(name))), key=parse)
    if not versions:
        raise BuildError(f"{clone} has no tags of releases for ROS 2")
    with tempfile.TemporaryDirectory() as cache, Store(Path(cache)) as store:
        graph = get_flow(link_for_flow(open_tree(folder, versions[-1]), store)).graph
    built = [node for node in graph.nodes if node.kind == "library" and node.executable]
    libraries = {node.id: f"lib{node.executable}.so" for node in built}
    named = [one for one in graph.endpoints if one.node in libraries and one.code_name and not one.implied]
    found = group_pairs((libraries[one.node], one) for one in named)
    return GazeboTopics(versions[-1], {library: _list_topics(rows) for library, rows in sorted(found.items())})


def _list_topics(rows: list[Endpoint]) -> tuple[GazeboTopic, ...]:
    types = group_pairs(((one.role, one.code_name), one.type) for one in rows)
    rows_of = sorted(types.items())
    return tuple(GazeboTopic(role, name, given[0] if len(set(given)) == 1 else "") for (role, name), given in rows_of)


def main(arguments: list[str]) -> None:
    """Writes the table."""
    table = build_table(Path(arguments[0]) / "ros-simulation+gazebo_ros_pkgs")
    write_table(DATA / "gazebo_topics.json.zst", table)


if __name__ == "__main__":
    main(sys.argv[1:])
