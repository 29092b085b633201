"""Changes of the logic of publishing as one self-contained page: a timeline that can be searched and filtered.

As the report of `check`, it works from a file, loads nothing, and runs no code but its own.
"""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

from ..findings import printable
from ..report import html as page
from ..report.report import safe
from .logic import Logic
from .logic_changes import KINDS
from .logic_report import apart, summary

_PLACEHOLDER = re.compile(r"\{\{(policy|title|style|data)\}\}")


def render(logic: Logic, version: str) -> str:
    """The page. What comes from the repository stands only in a JSON block that cannot be left."""
    folder = Path(page.__file__).parent
    template = folder.joinpath("timeline.html").read_text(encoding="utf-8")
    shared = re.search(r"<style>(.*?)</style>", folder.joinpath("page.html").read_text(encoding="utf-8"), re.DOTALL)
    template = template.replace("{{style}}", shared[1] if shared else "")
    values = {
        "policy": page.policy_of(template),
        "title": html.escape(safe(printable(f"rosimpact logic: {logic.repository}"))),
        "data": _data(logic, version),
    }
    return _PLACEHOLDER.sub(lambda match: values[match[1]], template)


def _data(logic: Logic, version: str) -> str:
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
            old, new = apart(old, new)
        rows.append(
            [commits[commit.id], change.kind, change.package, change.path, change.line, change.node, change.topic,
             old, new, change.why, reached]
        )  # fmt: skip
    data = {
        "version": version,
        "repository": logic.repository,
        "summary": summary(logic),
        "kinds": list(KINDS),
        "commits": heads,
        "changes": rows,
    }
    text = printable(json.dumps(page.clean(data), ensure_ascii=False, separators=(",", ":")))
    return re.sub("[<>&\u2028\u2029]", lambda match: f"\\u{ord(match[0]):04x}", text)
