"""Which ROS distros a text names."""

from __future__ import annotations

import re

ROS1 = (
    "boxturtle", "cturtle", "diamondback", "electric", "fuerte", "groovy", "hydro", "indigo", "jade", "kinetic",
    "lunar", "melodic", "noetic",
)  # fmt: skip
ROS2 = (
    "ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic", "humble", "iron", "jazzy", "kilted",
    "lyrical", "rolling",
)  # fmt: skip
DISTROS = (*ROS1, *ROS2)
"""In the order of their release, ROS 1 first."""

# Words that also stand for something else in a report: these count only where ROS or a distro is plainly meant.
_AMBIGUOUS = ("electric", "hydro", "jade", "lunar", "ardent", "bouncy", "crystal", "dashing", "galactic", "iron",
              "kinetic", "lyrical", "rolling")  # fmt: skip
_NAMED = re.compile(rf"\b(?:{'|'.join(DISTROS)})(?![a-z])")
_PLAIN = frozenset(DISTROS) - frozenset(_AMBIGUOUS)
_NEIGHBOURS = rf"(?:{'|'.join(name for name in DISTROS if name in _PLAIN)})"
_BETWEEN = r"\s*(?:,|/|and|or|to|vs\.?|->|\+|&)\s*(?:ros ?2?\s+)?"
_NEAR = 40
"""How many characters before and after a name are looked at."""
_BEFORE = re.compile(
    rf"(?:\bros[\s_-]?[12]?[\s:/=_-]*[\"'(]?|/opt/ros/|\bros_?distro\W{{0,4}}|\b{_NEIGHBOURS}{_BETWEEN})\Z"
)
_AFTER = re.compile(
    r"[\s_-](?:distro|devel|release|ridley|emys|turtle|hawksbill|ninjemys|morenia|loggerhead|igloo|irwini|kame|mitten|"
    rf"diademata|geochelone|lut|apalone)|{_BETWEEN}{_NEIGHBOURS}\b"
)


def find_distros(text: str) -> tuple[str, ...]:
    """The distros that a text names, in the order of their release.

    Names that are ordinary words too, as `iron` or `rolling`, count only beside ROS, a path of ROS, a branch or
    another distro.
    """
    lowered = text.lower()
    found: set[str] = set()
    for match in _NAMED.finditer(lowered):
        name, start, end = match.group(), match.start(), match.end()
        if name not in found and (
            name in _PLAIN
            or _BEFORE.search(lowered[max(0, start - _NEAR) : start])
            or _AFTER.match(lowered[end : end + _NEAR])
        ):
            found.add(name)
    return tuple(name for name in DISTROS if name in found)
