"""How severe a finding is: the one policy, asked by every rule.

A finding is an error when nothing speaks against it: what it says is known to hold on the target, and it stops a build
or a run there. Whatever speaks against it is a Doubt, and each doubt allows a severity at most; the lowest counts. A
rule therefore states what it knows of the place and of its evidence, and never a severity:

    severity(*doubts_of_place(view, use.role, use.conditions), found.sure or Doubt.INCOMPLETE)

Findings of one kind that are worth one warning together (what is upcoming, what is passed on to others) name it as
Together; where there are more than a few, the first stays a warning and the rest become notes, when the findings of all
packages are known.
"""

from __future__ import annotations

import enum
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from ..facts.condition import Condition

if TYPE_CHECKING:
    from ..model.view import TargetView


class Doubt(enum.Enum):
    """A reason why a finding may be less than an error, with the severity that it allows at most."""

    allows: str

    # Of the place
    CONDITIONAL = "it stands under a condition of the build or launch that is not known to hold", "warning"
    OPTIONAL = "the build or the program is prepared for its absence", "warning"
    TEST = "it is in a test, which is not built or run with the package", "warning"
    LATE = "it is not known to be reached whenever the package is built or started", "warning"
    GUARDED = "a test in the code itself stands around it, which most likely tells the versions apart", "note"
    UNCOMPILED = "nothing in the package compiles it on its own", "note"
    UNINSTALLED = "nothing is known to install or start the file that it stands in", "note"
    EXAMPLE = "it is an example, or documentation", "note"
    DISPENSABLE = "builds and programs go on without it, at least where a condition does not hold", "note"
    # Of the evidence
    INCOMPLETE = "what decides is not known completely: a type, a version, the contents of a package", "warning"
    AMBIGUOUS = "something else of the same name may be meant", "warning"
    OWN = "the workspace has something of this name itself", "note"
    PRIVATE = "nobody knows the name in public; it may belong to a private repository", "note"
    UNCHECKED = "it says what was left out, and that something is wrong there is not known", "note"
    # Of what follows
    UPCOMING = "it holds only after an update of the distro, or on a newer one", "warning"
    FAR = "it holds only some long-term distros later", "note"
    LUCKY = "it is there as long as something else that is declared happens to bring it", "warning"
    DISTURBS = "builds and programs go on, and others that use it may not", "warning"
    CHANGED = "it is built and runs, and does something else", "note"
    ENDED = "the distro has ended: what brings it there stays, and nothing is released into it any more", "note"
    DEPRECATED = "it is there, and produces a warning", "note"
    REPEATED = "a warning says the same of another place already", "note"

    def __new__(cls, reason: str, allows: str) -> Doubt:
        self = object.__new__(cls)
        self._value_, self.allows = reason, allows
        return self


SEVERITIES = ("note", "warning", "error")


def limit_severity(*doubts: Doubt | bool | None) -> str:
    """`error` where there is no doubt, else the highest severity that all doubts allow. True and None count for
    nothing, so that `known or Doubt.INCOMPLETE` can be written. Raises TypeError for False, which is a slip."""
    if any(doubt is False for doubt in doubts):
        raise TypeError("False is no doubt; write `known or Doubt...`")
    allowed = (doubt.allows for doubt in doubts if isinstance(doubt, Doubt))
    return min(allowed, key=SEVERITIES.index, default=SEVERITIES[-1])


def rate_newest(view: TargetView) -> Doubt:
    """What speaks against an error for what holds only on the newest distro."""
    return Doubt.FAR if any(ahead.platform and ahead.far for ahead in view.horizons) else Doubt.UPCOMING


def list_ended_doubts(view: TargetView) -> tuple[Doubt, ...]:
    """What speaks against more than a note for what only later changes of a distro, or releases into it, would break,
    on a target whose distro had ended by its day."""
    return (Doubt.ENDED,) if view.target.has_ended() else ()


# Languages whose conditions a file states about itself.
_IN_CODE = frozenset(("cpp", "macro", "python"))


def list_place_doubts(view: TargetView, role: str, conditions: Iterable[Condition] = ()) -> tuple[Doubt, ...]:
    """What speaks against an error at a place. role: build, run, test or aside, as the model has it. conditions: those
    that it stands under; that they can hold at all, a rule has asked before."""
    doubts = []
    if role == "aside":
        doubts.append(Doubt.EXAMPLE)
    elif not view.is_built(role):
        doubts.append(Doubt.TEST)
    conditions = tuple(conditions)
    if not view.is_sure(conditions):
        own = tuple(condition for condition in conditions if condition.language in _IN_CODE)
        doubts.append(Doubt.CONDITIONAL if view.is_sure(own) else Doubt.GUARDED)
    return tuple(doubts)


class Together(NamedTuple):
    """What findings share that are worth one warning together: lower_repeats() makes notes of the rest.

    cause: of the findings, within their rule and package. everywhere: those of all rules and of the whole workspace
    count together, since one thing outside it is the cause. few: so many of them are oversights, each worth a warning
    of its own; more are a habit, of which one warning is enough."""

    cause: str
    everywhere: bool = False
    few: int = 1
