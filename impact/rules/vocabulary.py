"""The vocabulary of rules: the workspace as they see it, and what they yield, to be imported from one place."""

from ..model.cmake.build import At
from ..model.view import Need, TargetView, make_sort_key
from ..model.workspace import Package, Workspace
from .fix_actions import Declare, FixAction, Insert, Remove, Replace, translate_tag
from .rule import Diagnostic, Finding, Upcoming, rate_upcoming, rule
from .severity import (
    SEVERITIES,
    Doubt,
    Together,
    limit_severity,
    list_ended_doubts,
    list_place_doubts,
    rate_newest,
)
from .text import Text, Value

__all__ = [
    "SEVERITIES", "At", "Declare", "Diagnostic", "Doubt", "Finding", "FixAction", "Insert", "Need", "Package", "Remove",
    "Replace", "TargetView", "Text", "Together", "Upcoming", "Value", "Workspace", "limit_severity",
    "list_ended_doubts", "list_place_doubts", "make_sort_key", "rate_newest", "rate_upcoming", "rule", "translate_tag",
]  # fmt: skip
