"""What a finding rests on, for all targets together: which of them have the change, since when, and what to write when
they need different names."""

from collections.abc import Iterable, Mapping, Sequence
from functools import cmp_to_key
from typing import NamedTuple

from ..model.view import TargetView
from ..rules.rule import Finding
from ..targets.changes import find_version
from ..targets.evidence import add_target_states, holds_on
from ..targets.evidence_record import Evidence, OnTarget
from ..targets.providers.version_macros import make_version_test
from ..targets.version import compare, is_at_least

_CMAKE = ("cmake", "command", "target", "variable")


class Split(NamedTuple):
    """Two spellings of one name, the older and the newer, with the targets that take only the one or the other.

    first: the version of the package from which on the newer one is to be written; empty when not known. oldest: the
    lowest version of it on a target asked for. ros: the generation of all targets, 0 where they differ.
    """

    evidence: Evidence
    old: str
    new: str
    old_only: tuple[str, ...]
    new_only: tuple[str, ...]
    first: str
    oldest: str
    ros: int


def add_evidence(
    findings: Iterable[Finding], views: Sequence[TargetView]
) -> tuple[list[Finding], list[tuple[Finding, Split]]]:
    """The findings with how every target stands to the change that each rests on, and with the guarded form as help
    where the targets asked for need different spellings; and these alone."""
    known: dict[tuple[Evidence, tuple[str, ...]], tuple[Evidence | None, Split | None]] = {}
    result, parted = [], []
    for finding in findings:
        if finding.evidence is not None:
            key = (finding.evidence, finding.targets)
            if key not in known:
                known[key] = _combine_evidence(*key, views)
            evidence, split = known[key]
            finding = finding._replace(evidence=evidence, help=_suggest_guard(split) if split else finding.help)
            if split is not None:
                parted.append((finding, split))
        result.append(finding)
    return result, parted


def _combine_evidence(
    evidence: Evidence, spoken_of: tuple[str, ...], views: Sequence[TargetView]
) -> tuple[Evidence | None, Split | None]:
    if not views:
        return None, None
    seen = add_target_states(evidence, [view.target for view in views], spoken_of, views[0].providers)
    return seen, find_split(seen, spoken_of, views) if seen is not None else None


def find_split(evidence: Evidence, spoken_of: Iterable[str], views: Sequence[TargetView]) -> Split | None:
    """How the targets differ, when on some only the one and on others only the other spelling is there; else None.

    evidence: as add_target_states() gives it. spoken_of: targets on which the name that is used is not there.
    """
    if evidence.change not in ("removed", "added") or not evidence.instead or evidence.ahead:
        return None
    spoken = frozenset(spoken_of)
    if spoken.issuperset(view.target.name for view in views):
        return None
    used = {view.target.name: _has_used_spelling(evidence, view, spoken) for view in views}
    other = {view.target.name: _has_other_spelling(evidence, view) for view in views}
    only_used = tuple(name for name in used if used[name] is True and other[name] is False)
    only_other = tuple(name for name in used if used[name] is False and other[name] is True)
    if not only_used or not only_other or any(used[name] is False and other[name] is False for name in used):
        return None
    removed = evidence.change == "removed"
    old, new = (evidence.name, evidence.instead) if removed else (evidence.instead, evidence.name)
    old_only, new_only = (only_used, only_other) if removed else (only_other, only_used)
    first, oldest = _find_boundary(evidence, views, old_only, new_only)
    generations = {view.target.ros for view in views}
    ros = generations.pop() if len(generations) == 1 else 0
    return Split(evidence, old, new, old_only, new_only, first, oldest, ros)


def _has_used_spelling(evidence: Evidence, view: TargetView, spoken: frozenset[str]) -> bool | None:
    """Whether the spelling that is used is there."""
    if view.target.name in spoken:
        return False
    if evidence.side == "header":
        return view.environment.headers(evidence.name)
    on: Mapping[str, OnTarget] = {one.target: one for one in evidence.targets}
    here = on.get(view.target.name)
    return None if here is None else here.holds == (evidence.change == "added")


def _has_other_spelling(evidence: Evidence, view: TargetView) -> bool | None:
    """Whether the other spelling is there."""
    if evidence.other is not None:
        holds = holds_on(evidence.other, view.target, view.providers)
        if holds is not None:
            return holds == (evidence.other.change == "added")
    return view.environment.headers(evidence.instead) if evidence.side == "header" else None


def _find_boundary(
    evidence: Evidence, views: Sequence[TargetView], old_only: Sequence[str], new_only: Sequence[str]
) -> tuple[str, str]:
    """The version that parts the targets, and the lowest one of them: a bound of the tables that does, else the lowest
    version of those that need the newer spelling, where all others are below it."""
    versions = {
        view.target.name: version
        for view in views
        if (version := find_version(evidence.package, evidence.library, view.target))
    }
    if not versions:
        return "", ""
    oldest = _find_lowest(versions.values())
    above, below = [versions[name] for name in new_only], [versions[name] for name in old_only]
    pair = [evidence, evidence.other] if evidence.change == "added" else [evidence.other, evidence]
    bounds = [one.first for one in pair if one is not None and one.first[:1].isdigit()]
    for bound in (*bounds, _find_lowest(above)):
        if all(is_at_least(version, bound) for version in above) and not any(is_at_least(one, bound) for one in below):
            return bound, oldest
    return "", oldest


def _find_lowest(versions: Iterable[str]) -> str:
    return min(versions, key=cmp_to_key(compare), default="")


def _suggest_guard(split: Split) -> str:
    """What to write when neither name works on all targets."""
    evidence = split.evidence
    where = f"{_format_names(split.old_only)} {'has' if len(split.old_only) == 1 else 'have'} only `{split.old}`"
    if evidence.side == "header":
        return f"`#if __has_include(<{split.new}>)`, include it, `#else` include `{split.old}`: {where}"
    if evidence.side == "python":
        return f"use `{split.new}` if it is available (`try`, or `hasattr`), else `{split.old}`: {where}"
    package = evidence.package
    if evidence.side == "c++" and split.first:
        test = make_version_test(package, evidence.library, split.first, ros=split.ros, oldest=split.oldest)
        if test is not None:
            return f"`#if {test.text}` use `{split.new}`, `#else` `{split.old}`, with `{test.header}` included: {where}"
    if split.first:
        cmake = f"`if({package}_VERSION VERSION_GREATER_EQUAL {split.first})`"
        if evidence.side in _CMAKE:
            return f"{cmake} use `{split.new}`, else `{split.old}`: {where}"
        return f"choose between `{split.new}` and `{split.old}` with a definition that CMake sets {cmake}: {where}"
    return f"use `{split.new}` or `{split.old}`, whichever is available: {where}"


def _format_names(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
