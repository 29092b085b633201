"""The checker and its sisters: what a change breaks, and for whom."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .analysis.check import check, check_workspace
    from .analysis.report import Report
    from .analysis.session import Options
    from .rules.rule import Finding

__all__ = ["Finding", "Options", "Report", "check", "check_workspace"]

_WHERE = {
    "check": "analysis.check",
    "check_workspace": "analysis.check",
    "Options": "analysis.check",
    "Report": "analysis.report",
    "Finding": "rules.rule",
}


def __getattr__(name: str):
    # Imported when asked for, so that `rosimpact --help` loads nothing of this.
    if name in _WHERE:
        from importlib import import_module

        return getattr(import_module(f".{_WHERE[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
