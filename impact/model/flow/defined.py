"""Which messages, services and actions a package defines: as the workspace has it, or as it was ever released."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache

from ...targets.surface.fields import load_fields

# Messages that ROS 1 makes of an action.
_OF_ACTIONS = ("ActionGoal", "ActionResult", "ActionFeedback", "Action", "Goal", "Result", "Feedback")


class DefinedInterfaces:
    """Asks whether an interface is there. own: package of the workspace to the names of its interfaces; ros: the
    generation of released packages, which are not asked when it is 0. texts: the constants of the workspace's messages
    that are strings, with their values, by `package/Name`."""

    def __init__(
        self, own: Mapping[str, Collection[str]] | None = None, ros: int = 0,
        texts: Mapping[str, Mapping[str, str]] | None = None,
    ):  # fmt: skip
        self.own, self.ros, self.texts = own or {}, ros, texts or {}

    def has(self, interface: str) -> bool | None:
        """Whether `package/Name` is defined; None for a package that is not known."""
        package, _, name = interface.partition("/")
        names = self.own.get(package)
        if names is None and self.ros:
            names = list_released(package, self.ros) or None
        if names is None:
            return None
        return name in names or any(name.endswith(part) and name.removesuffix(part) in names for part in _OF_ACTIONS)


@cache
def list_released(package: str, ros: int) -> frozenset[str]:
    """The interfaces that a released package ever had, none when it is not known."""
    history = load_fields().find_history(package, ros)
    return frozenset(name.rpartition("/")[2] for name in history.interfaces) if history is not None else frozenset()
