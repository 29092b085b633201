"""Changes of the logic of publishing as one self-contained page: a timeline that can be searched and filtered."""

from pathlib import Path
from typing import Any

from ..logic.changes import KINDS
from ..logic.repository import Logic
from .logic import summarize, trim_common_ends
from .page import render_page


def render(logic: Logic, version: str) -> str:
    """The page as text."""
    return render_page(
        Path(__file__).with_name("timeline.html"), f"rosimpact logic: {logic.repository}", _build_data(logic, version)
    )


def _build_data(logic: Logic, version: str) -> dict[str, Any]:
    commits: dict[str, int] = {}
    heads: list[list[str]] = []
    rows: list[list] = []
    for commit, change in logic.changes:
        if commit.id not in commits:
            commits[commit.id] = len(heads)
            heads.append([commit.id, commit.date, commit.summary])
        reached = [[one.package, one.node, one.callback, one.path, one.line] for one in change.reaches]
        old, new = change.old, change.new
        if old is not None and new is not None:
            old, new = trim_common_ends(old, new)
        rows.append(
            [commits[commit.id], change.kind, change.package, change.path, change.line, change.node, change.topic,
             old, new, change.why, reached]
        )  # fmt: skip
    return {
        "version": version,
        "repository": logic.repository,
        "summary": summarize(logic),
        "kinds": list(KINDS),
        "commits": heads,
        "changes": rows,
    }
