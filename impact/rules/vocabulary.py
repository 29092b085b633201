"""The vocabulary of rules: the workspace as they see it, and what they yield, to be imported from one place."""

from ..model.cmake.build import At
from ..model.view import Need, TargetView, weight
from ..model.workspace import Package, Workspace
from .fix_actions import Declare, FixAction, Insert, Remove, Replace
from .rule import SEVERITIES, Diagnostic, Finding, rule
from .severity import Doubt, Together, doubts_of_place, severity
from .text import Text, Value
from .upcoming import Upcoming, rate_upcoming

__all__ = [
    "SEVERITIES", "At", "Declare", "Diagnostic", "Doubt", "Finding", "FixAction", "Insert", "Need", "Package",
    "Remove", "Replace", "TargetView", "Text", "Together", "Upcoming", "Value", "Workspace", "doubts_of_place",
    "rate_upcoming", "rule", "severity", "weight",
]  # fmt: skip
