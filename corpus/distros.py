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
_PLAIN = re.compile(rf"\b({'|'.join(name for name in DISTROS if name not in _AMBIGUOUS)})(?![a-z])", re.IGNORECASE)
_NAMES = "|".join(_AMBIGUOUS)
_MEANT = (
    re.compile(rf"\bros[\s_-]?[12]?[\s:/=_-]*[\"'(]?({_NAMES})(?![a-z])", re.IGNORECASE),
    re.compile(rf"/opt/ros/({_NAMES})\b", re.IGNORECASE),
    re.compile(rf"\bros_?distro\W{{0,4}}({_NAMES})\b", re.IGNORECASE),
    re.compile(rf"\b({_NAMES})[\s_-](?:distro|devel|release|ridley|emys|turtle|hawksbill|ninjemys|morenia|loggerhead|"
               rf"igloo|irwini|kame|mitten|diademata|geochelone|lut|apalone|tip)", re.IGNORECASE),
    re.compile(rf"(?:noetic|melodic|indigo|humble|foxy|jazzy|groovy|fuerte|kilted)\s*(?:,|/|and|or|to|vs\.?|->|\+|&)\s*"
               rf"(?:ros2?\s+)?({_NAMES})\b", re.IGNORECASE),
    re.compile(rf"\b({_NAMES})\s*(?:,|/|and|or|to|vs\.?|->|\+|&)\s*(?:ros2?\s+)?"
               rf"(?:noetic|melodic|indigo|humble|foxy|jazzy|groovy|fuerte|kilted)\b", re.IGNORECASE),
)  # fmt: skip


def distros_in(text: str) -> tuple[str, ...]:
    """The distros that a text names, in the order of their release.

    Names that are ordinary words too, as `iron` or `rolling`, count only beside ROS, a path of ROS, a branch or
    another distro.
    """
    found = {match.lower() for match in _PLAIN.findall(text)}
    for pattern in _MEANT:
        found.update(match.lower() for match in pattern.findall(text))
    return tuple(name for name in DISTROS if name in found)
