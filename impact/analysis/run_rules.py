"""The rules, run over a workspace on every target: in several processes where there is much to judge, and not at all
where an earlier run judged the same."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

from ...edges import processes
from ...edges.console import unforeseen
from ..rules.rule import Hit, Rule
from ..targets.snapshot import SnapshotError
from . import result_cache as memo

if TYPE_CHECKING:
    from ..model.workspace import Workspace
    from .session import Opened

# Starting processes costs about as much as judging this many packages on one target.
_ALONE = 16
_PARTS_PER_JOB = 4
# Judging a package may take as much time as extracting from this much text, and as much more for each file.
_PACKAGE_BYTES = 1 << 20
_FILE_BYTES = 20 << 10
# Of the message flow of a whole workspace, beyond what a process may need.
_PACKAGE_MEMORY = 8 << 20

# (rule, why it failed) to the targets on which it did
Crashes = dict[tuple[str, str], list[str]]


def hits_of(
    opened: Opened, rules: Iterable[Rule], crashed: Crashes, before: Workspace | None, jobs: int | None = None
) -> Iterator[tuple[str, str, Hit]]:
    """(rule, target, hit) of all the rules; the target is empty for rules that know none.

    before: the workspace at the base, for rules that compare. crashed: gets the rules that failed; what the others
    found stands. jobs: processes to use, all available cores when None.
    """
    every = list(rules)
    told = [rule for rule in every if rule.per_target]
    names = [rule.name for rule in told]
    kept: dict[str, list[tuple[str, Hit]]] = {}
    fresh = []
    for place, view in enumerate(opened.views):
        known = memo.recall(opened.store, view, names)
        if known is None:
            fresh.append(place)
            memo.prepare(opened.store, view.target)
        else:
            kept[view.target.name] = known
    for place, said in _judged(opened, told, fresh, crashed, jobs or processes.cores()):
        view = opened.views[place]
        kept[view.target.name] = said
        if not crashed:
            memo.remember(opened.store, view, names, said)
    of_flow = _of_flow(opened, [rule for rule in every if rule.flow], crashed, before)
    for rule in every:
        if rule.name in names:
            for view in opened.views:
                target = view.target.name
                yield from ((name, target, hit) for name, hit in kept[target] if name == rule.name)
        elif rule.installed:
            yield from _of_install(opened, rule, crashed)
        elif rule.across:
            hits = _tried(rule, "", crashed, lambda rule=rule: rule.run(opened.views))
            yield from ((rule.name, view.target.name, hit) for view, hit in hits)
        elif rule.flow:
            yield from ((name, "", hit) for name, hit in of_flow if name == rule.name)
        else:
            yield from ((rule.name, "", hit) for hit in _tried(rule, "", crashed, _run(rule, opened, before)))


def _judged(
    opened: Opened, rules: Sequence[Rule], places: Sequence[int], crashed: Crashes, jobs: int
) -> Iterator[tuple[int, list[tuple[str, Hit]]]]:
    """What the rules say of these views, each with its place among them."""
    packages = list(opened.workspace.packages)
    if not packages or not processes.may_fork():
        for place in places:
            yield place, list(_all(rules, opened.views[place], crashed))
        return
    if len(packages) * len(places) < _ALONE:
        jobs = 1
    # A rule that does not come to its end on a package does not stop the run: no package is judged in this process.
    size = max(1, -(-len(packages) // (_PARTS_PER_JOB * jobs) if jobs > 1 else len(packages)))
    tasks = [(place, at) for place in places for at in range(0, len(packages), size)]
    done = {}
    opened.store.close()  # no other process may go on with a connection of this one
    for task, result in processes.forked(_part, tasks, jobs, opened, rules, packages, size):
        done[task] = _one_by_one(opened, rules, packages, size, task) if isinstance(result, processes.Died) else result
    for place, tasks_of_view in groupby(tasks, key=lambda task: task[0]):
        view = opened.views[place]
        said: dict[str, list[tuple[str, Hit]]] = {}
        for task in tasks_of_view:
            hits, unresolved, failures = done[task]
            for name, hit in hits:
                said.setdefault(name, []).append((name, hit))
            for kind, unknown in unresolved.items():
                view.unresolved.setdefault(kind, set()).update(unknown)
            for failure in failures:
                _note(crashed, failure, view.target.name)
        yield place, [each for rule in rules for each in said.get(rule.name, ())]


def _part(
    opened: Opened, rules: Sequence[Rule], packages: Sequence[str], size: int, task: tuple[int, int]
) -> tuple[list[tuple[str, Hit]], dict[str, set[str]], Crashes]:
    """What rules say of some packages on one view, what was not resolved, and the rules that failed."""
    place, at = task
    view = opened.views[place]
    crashed: Crashes = {}
    part = packages[at : at + size]
    view.part = frozenset(part)
    processes.begin_part(0, _bytes(opened.workspace, part))
    try:
        return list(_all(rules, view, crashed)), view.unresolved, crashed
    finally:
        view.part = None


def _bytes(workspace: Workspace, packages: Collection[str]) -> int:
    """How much text it may take as long to extract from as to judge these packages."""
    files = sum(len(workspace.packages[name].digest.files) for name in packages)
    return (1 + len(packages)) * _PACKAGE_BYTES + files * _FILE_BYTES


def _one_by_one(
    opened: Opened, rules: Sequence[Rule], packages: Sequence[str], size: int, task: tuple[int, int]
) -> tuple[list[tuple[str, Hit]], dict[str, set[str]], Crashes]:
    """As _part, package by package, where the rules end the process on one of them: that one is named."""
    place, at = task
    singles = [(place, each) for each in range(at, min(at + size, len(packages)))]
    hits: list[tuple[str, Hit]] = []
    unresolved: dict[str, set[str]] = {}
    crashed: Crashes = {}
    found = dict(processes.forked(_part, singles, 1, opened, rules, packages, 1))
    for single in singles:
        result = found[single]
        if isinstance(result, processes.Died):
            failure = (", ".join(rule.name for rule in rules), f"the check of `{packages[single[1]]}` {result.why}")
            crashed.setdefault(failure, [])
            continue
        hits += result[0]
        for kind, unknown in result[1].items():
            unresolved.setdefault(kind, set()).update(unknown)
        crashed.update(result[2])
    return hits, unresolved, crashed


def _all(rules: Iterable[Rule], view, crashed: Crashes) -> Iterator[tuple[str, Hit]]:
    for rule in rules:
        for hit in _tried(rule, view.target.name, crashed, lambda rule=rule: rule.run(view)):
            yield rule.name, hit


def _of_flow(
    opened: Opened, rules: Sequence[Rule], crashed: Crashes, before: Workspace | None
) -> list[tuple[str, Hit]]:
    """What rules say of the message flow: remembered by all that it rests on, since joining it is dear."""
    if not rules:
        return []
    key = memo.flow_key(opened.workspace, before, [rule.name for rule in rules])
    known = memo.recall_flow(opened.store, key)
    if known is not None:
        return known
    failed: Crashes = {}
    said: list[tuple[str, Hit]] = []
    if processes.may_fork():
        opened.store.close()  # no other process may go on with a connection of this one
        found = dict(processes.forked(_flow_part, [0], 1, opened, rules, before))[0]
        if isinstance(found, processes.Died):
            failed[", ".join(rule.name for rule in rules), f"the check of the message flow {found.why}"] = []
        else:
            said, failed = found
    else:
        said, failed = _flow_part(opened, rules, before, 0)
    if not failed:
        memo.remember_flow(opened.store, key, said)
    crashed.update(failed)
    return said


def _flow_part(
    opened: Opened, rules: Sequence[Rule], before: Workspace | None, _: int
) -> tuple[list[tuple[str, Hit]], Crashes]:
    """What rules say of the message flow, and the rules that failed."""
    packages = opened.workspace.packages
    processes.begin_part(0, _bytes(opened.workspace, packages))
    processes.allow_memory(len(packages) * _PACKAGE_MEMORY)
    failed: Crashes = {}
    said = [(rule.name, hit) for rule in rules for hit in _tried(rule, "", failed, _run(rule, opened, before))]
    return said, failed


def _of_install(opened: Opened, rule: Rule, crashed: Crashes) -> Iterator[tuple[str, str, Hit]]:
    """What a rule says of the built files, machine by machine. What a machine has changes unseen, so it is not
    remembered."""
    installed = opened.installed
    if installed is None:
        return
    views = {view.target.name: view for view in opened.views}
    for shelf in opened.shelves:
        view = views.get(shelf.target, opened.views[0])
        hits = _tried(rule, shelf.target, crashed, lambda view=view, shelf=shelf: rule.run(view, installed, shelf))
        yield from ((rule.name, shelf.target, hit) for hit in hits)


def _run(rule: Rule, opened: Opened, before: Workspace | None) -> Callable[[], Iterable[Hit]]:
    """The call of a rule that asks no target."""
    if not rule.compares:
        return lambda: rule.run(opened.workspace)
    return lambda: rule.run(opened.workspace, before) if before is not None else ()


def _tried(rule: Rule, target: str, crashed: Crashes, run: Callable[[], Iterable[Any]]) -> Iterator[Any]:
    """The hits of a rule up to where it fails, if it does."""
    try:
        yield from run()
    except SnapshotError:
        raise  # no rule can do without the data
    except Exception as error:
        # What the other rules say stays true; the failure is named and decides the exit status.
        _note(crashed, (rule.name, unforeseen(error)), target)


def _note(crashed: Crashes, failure: tuple[str, str], target: str) -> None:
    targets = crashed.setdefault(failure, [])
    if target and target not in targets:
        targets.append(target)
