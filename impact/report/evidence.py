"""The evidence of a finding as the reports show it: a few lines for a person, an object for programs."""

from typing import Any

from ..rules.rule import Finding
from ..targets.changes import format_versions
from ..targets.evidence_record import Evidence, OnTarget

_MOST_DECLARATIONS = 2
_MOST_TARGETS = 5


def format_lines(finding: Finding) -> list[tuple[str, str]]:
    """(label, text) of what the message does not contain: the declarations `was` and `now`, and `when` each target got
    the change. Empty when nothing more is known."""
    evidence = finding.evidence
    if evidence is None:
        return []
    since = "new" if evidence.change == "added" else "now"
    # Overloads that stayed tell nothing, unless they are all that is left.
    old = tuple(one for one in evidence.old if one not in evidence.new)
    new = tuple(one for one in evidence.new if one not in evidence.old) or evidence.new
    found = [*_format_declarations("was", old), *_format_declarations(since, new)]
    when = _format_period(evidence)
    return [*found, ("when", when)] if when else found


def make_object(evidence: Evidence) -> dict[str, Any]:
    """The evidence as findings.schema.json describes it."""
    data: dict[str, Any] = {"package": evidence.package, "change": evidence.change}
    for key in ("name", "instead", "old", "new", "last", "first", "source"):
        if value := getattr(evidence, key):
            data[key] = list(value) if isinstance(value, tuple) else value
    data["targets"] = [
        {"target": one.target, "version": one.version, "holds": one.holds} | ({"since": one.since} if one.since else {})
        for one in evidence.targets
    ]
    return data


def _format_declarations(label: str, declarations: tuple[str, ...]) -> list[tuple[str, str]]:
    shown = [(label, text) for text in declarations[:_MOST_DECLARATIONS]]
    more = len(declarations) - len(shown)
    return [*shown[:-1], (label, f"{shown[-1][1]} (and {more} more)")] if more else shown


def _format_period(evidence: Evidence) -> str:
    """`removed between rclcpp 28.3.1 and 28.3.2: rolling since 2024-08-21, still on humble (16.0.20)`; empty when
    neither a version nor a date is known, or no target differs from the message."""
    got = [f"{one.target} since {one.since}" for one in evidence.targets if one.holds and one.since]
    others = [one for one in evidence.targets if not one.holds]
    if not got and not others and not evidence.first[:1].isdigit():
        return ""
    word = evidence.change
    if evidence.last and evidence.first:
        head = f"{word} between {evidence.package} {evidence.last} and {evidence.first}"
    elif versions := format_versions(dict(evidence.new_in)):
        head = f"{word} in {versions}"
    elif evidence.first == "ros2":
        head = f"{word} in ROS 2"
    elif evidence.first:
        head = f"{word} in " + (f"{evidence.package} " if evidence.first[0].isdigit() else "") + evidence.first
    else:
        head = word
    lasting = "still on" if evidence.change == "removed" else "not on"
    got += [f"{lasting} {_format_target(one)}" for one in others[:1]] + [_format_target(one) for one in others[1:]]
    more = len(got) - _MOST_TARGETS
    return f"{head}: {', '.join(got[:_MOST_TARGETS])}" + (f" and {more} more" if more > 0 else "") if got else head


def _format_target(one: OnTarget) -> str:
    until = f", until {one.since}" if one.since else ""
    return f"{one.target} ({one.version}{until})"
