"""What a rule is, what it yields, and how rules are found."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterator
from functools import cache
from typing import NamedTuple

from ..targets.evidence import Evidence
from .fix_actions import Declare, Insert, Remove, Replace

SEVERITIES = ("note", "warning", "error")


class Edit(NamedTuple):
    """A replacement in one file, by byte offsets; start == end inserts."""

    path: str
    start: int
    end: int
    text: str


Cure = Edit | Declare | Remove | Replace | Insert


class Hit(NamedTuple):
    """What a rule yields for one target. check.py merges equal hits of several targets into one Finding.

    at: anything with path, line, column. message: one clause, code in backticks. help: the cure, or empty.
    severity: empty for the rule's own. fix: what cures it, see cure.py; kept only when every target asked for yields
    the same. evidence: the change that it rests on, without targets; check.py adds how each stands to it.
    """

    at: object
    subject: str
    message: str
    help: str = ""
    package: str = ""
    severity: str = ""
    fix: tuple[Cure, ...] = ()
    evidence: Evidence | None = None


class Finding(NamedTuple):
    """A finding as reported, see docs/findings.md."""

    rule: str
    severity: str
    package: str
    path: str
    line: int
    column: int
    subject: str
    targets: tuple[str, ...]
    message: str
    help: str = ""
    new: bool = True
    fingerprint: str = ""
    fix: tuple[Cure, ...] = ()
    evidence: Evidence | None = None


class Rule(NamedTuple):
    """A registered rule: name, family (folder), severity, whether it is a preview, function, documentation.

    per_target: asked once for each target. compares: asked about a workspace and its base, and silent without one.
    flow: rests on the message flow, and on nothing that is not remembered with it. installed: asked about the built
    files of an install space, on each machine, and silent without one. deprecation: warns of what will go. across:
    asked once about all targets together."""

    name: str
    family: str
    severity: str
    preview: bool
    per_target: bool
    run: Callable[..., Iterator[Hit]]
    documentation: str
    compares: bool = False
    flow: bool = False
    installed: bool = False
    deprecation: bool = False
    across: bool = False


_RULES: dict[str, Rule] = {}


def rule(
    *,
    severity: str,
    preview: bool = False,
    per_target: bool = True,
    compares: bool = False,
    flow: bool = False,
    installed: bool = False,
    deprecation: bool = False,
    across: bool = False,
):
    """Registers the decorated generator as a rule. It is called as f(view), a workspace as one target sees it, and
    reports on the packages that the view iterates over, which may be a part of the workspace; or as f(workspace) when
    per_target is False or it asks for the flow; or as f(workspace, base) when it compares; or as f(view, installed,
    shelf) when it is about built files; or as f(views) across targets, and then yields each hit with its view. The name
    is the module's, with dashes."""

    def register(function):
        parts = function.__module__.split(".")
        module = importlib.import_module(function.__module__)
        name = parts[-1].replace("_", "-")
        per = per_target and not (compares or flow or installed or across)
        documentation = module.__doc__ or ""
        _RULES[name] = Rule(
            name, parts[-2], severity, preview, per, function, documentation, compares, flow, installed, deprecation,
            across,
        )  # fmt: skip
        return function

    return register


def all_rules() -> dict[str, Rule]:
    """Every rule by name, importing the families on first use."""
    _import_families()
    return dict(sorted(_RULES.items()))


@cache
def _import_families() -> None:
    package = importlib.import_module(__name__.rpartition(".")[0])
    for family in pkgutil.iter_modules(package.__path__, package.__name__ + "."):
        if family.ispkg:
            folder = importlib.import_module(family.name)
            for module in pkgutil.iter_modules(folder.__path__, folder.__name__ + "."):
                importlib.import_module(module.name)
