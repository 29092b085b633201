"""The topics and services of plugins of Gazebo Classic in ROS 2: data/gazebo_topics.json.zst, see DATA.md."""

from __future__ import annotations

from functools import cache

import msgspec

from .tables import find_table
from .unpacked import read_table


class GazeboTopic(msgspec.Struct, frozen=True, array_like=True):
    """A topic or service of a plugin. role: as in the message-flow graph; name: as its code gives it to ROS; type:
    `package/Name`, empty where settings decide."""

    role: str
    name: str
    type: str


class GazeboTopics(msgspec.Struct, frozen=True):
    """version: the release that was read. plugins: by the name of the library."""

    version: str
    plugins: dict[str, tuple[GazeboTopic, ...]]


@cache
def load_gazebo_topics() -> GazeboTopics:
    """The shipped table. Raises SnapshotError."""
    return read_table(find_table("gazebo_topics.json.zst"), GazeboTopics)
