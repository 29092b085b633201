"""Runs the rules on a workspace for every target: in several processes when there is much to do, and not at all when an
earlier run had the same input."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from ...edges import processes
from ...edges.console import describe_unforeseen
from ...edges.groups import group_pairs
from ..model.view import TargetView, UnresolvedUse
from ..model.workspace import Workspace
from ..rules.rule import Diagnostic, Rule
from ..targets.snapshot import SnapshotError
from . import result_cache
from .findings import drop_outweighed, lower_repeats
from .result_cache import Yielded
from .session import OpenedWorkspace

# Starting processes costs about as much as running the rules on this many packages for one target.
_ALONE = 16
# Rules of a family ask for the same tables, which a process makes for itself: a family's packages go to few processes.
_JOBS_PER_PART = 2
# The families that take longest, measured on navigation2, moveit2 and ros2_control: 30, 38 and 31 % of the time.
_LONGEST = ("sources", "packages", "api")
# So many tasks are made of each of the last, so that no process waits long for the others.
_PARTS_OF_LAST = 3
# The rules may take as much time for a package as extraction takes for this much text, and as much more for each file.
_PACKAGE_BYTES = 1 << 20
_FILE_BYTES = 20 << 10
# Of the message flow of a whole workspace, beyond what a process may need.
_PACKAGE_MEMORY = 8 << 20
# Stands for the place of a view where the message flow is meant.
_FLOW = -1
# (rule, why it failed) to the targets on which it did
Crashes = dict[tuple[str, str], list[str]]


class _Slice(NamedTuple):
    """Packages of a group, from a number to another."""

    group: int
    start: int
    end: int


class _Task(NamedTuple):
    """What a process does at once: the rules of a family, on a view (its place), on some packages."""

    place: int
    slices: tuple[_Slice, ...] = ()
    family: str = ""


class _Done(NamedTuple):
    """What a task gives: what the rules yield, each with the place of its group; what its view did not resolve; and the
    rules that failed."""

    hits: list[tuple[int, Yielded]]
    unresolved: set[UnresolvedUse]
    failures: Crashes


_FLOW_TASK = _Task(_FLOW)


def run_rules(
    opened: OpenedWorkspace, rules: Iterable[Rule], crashed: Crashes, before: Workspace | None, jobs: int | None = None
) -> Iterator[tuple[str, str, Diagnostic]]:
    """(rule, target, diagnostic) of all the rules; the target is empty for rules that know none.

    before: the workspace at the base, for rules that compare. crashed: receives the rules that failed; the results of
    the others are kept. jobs: processes to use, all available cores when None.
    """
    every = list(rules)
    flow_rules = [rule for rule in every if rule.reads_flow]
    target_rules = [rule for rule in every if rule.scope == "target"]
    ran: dict[str, tuple[list[tuple[TargetView, Diagnostic]], Crashes]] = {}

    def run_on_all_targets() -> Iterator[None]:
        for rule in every:
            if rule.scope == "targets" and rule.name not in ran:
                failed: Crashes = {}
                yielded = list(_run_safely(rule, "", failed, lambda rule=rule: rule.run(opened.views)))
                ran[rule.name] = yielded, failed
                opened.store.close()  # no process that is forked now may go on with a connection of this one
                yield

    with processes.run_meanwhile(run_on_all_targets()):
        by_target, on_flow = _run_remembered(
            opened, target_rules, flow_rules, crashed, before, jobs or processes.count_cores()
        )
    for _ in run_on_all_targets():
        pass  # those for which no process had to be waited for
    for rule in every:
        if rule.scope == "target":
            for view in opened.views:
                target = view.target.name
                yield from ((name, target, each) for name, each in by_target[target] if name == rule.name)
        elif rule.scope == "install_space":
            yield from _run_on_install(opened, rule, crashed)
        elif rule.scope == "targets":
            yielded, failed = ran[rule.name]
            crashed.update(failed)
            yield from ((rule.name, view.target.name, each) for view, each in yielded)
        elif rule.reads_flow:
            yield from ((name, "", each) for name, each in on_flow if name == rule.name)
        else:
            yield from ((rule.name, "", each) for each in _run_safely(rule, "", crashed, _bind(rule, opened, before)))


def _run_remembered(
    opened: OpenedWorkspace,
    rules: Sequence[Rule],
    flow_rules: Sequence[Rule],
    crashed: Crashes,
    before: Workspace | None,
    jobs: int,
) -> tuple[dict[str, list[Yielded]], list[Yielded]]:
    """What rules yield on each target, by its name, and what flow_rules yield on the message flow: remembered from an
    earlier run where nothing changed. The rest is done side by side, since linking the flow is slow."""
    names = [rule.name for rule in rules]
    by_name = {rule.name: rule for rule in rules}
    groups = opened.workspace.groups
    # By the place of the view and of the group.
    keys = {
        (place, at): result_cache.make_results_key(view, names, group)
        for place, view in enumerate(opened.views)
        for at, group in enumerate(groups)
    }
    found: dict[tuple[int, int], list[Yielded]] = {}
    for (place, at), key in keys.items():
        if (known := result_cache.load_yielded(opened.store, key)) is not None:
            found[place, at], unresolved = known
            opened.views[place].unresolved.update(unresolved)
    fresh = [each for each in keys if each not in found]
    key, on_flow = b"", None if flow_rules else []
    if flow_rules:
        key = result_cache.make_flow_key(opened.workspace, before, [rule.name for rule in flow_rules])
        known = result_cache.load_yielded(opened.store, key)
        on_flow = known[0] if known is not None else None
    asked = flow_rules if on_flow is None else ()
    failed: Crashes = {}
    for place, at, yielded in _run_in_parts(opened, rules, fresh, asked, before, crashed, failed, jobs):
        if place == _FLOW:
            on_flow = yielded
            if not failed:
                result_cache.store_yielded(opened.store, key, yielded)
        else:
            found[place, at] = yielded
    if not crashed:
        for place, at in fresh:
            group = frozenset(groups[at])
            unresolved = [each for each in opened.views[place].unresolved if each.package in group]
            result_cache.store_yielded(opened.store, keys[place, at], found[place, at], unresolved)
    crashed.update(failed)
    of_rules = {name: number for number, name in enumerate(names)}
    of_packages = {name: number for number, name in enumerate(opened.workspace.packages)}
    on_views = {}
    for place, view in enumerate(opened.views):
        yielded = [each for at in range(len(groups)) for each in found[place, at]]
        yielded.sort(key=lambda each: (of_rules[each[0]], of_packages.get(each[1].package, -1)))
        on_views[view.target.name] = lower_repeats(drop_outweighed(yielded, by_name), by_name)
    return on_views, on_flow or []


def _run_in_parts(
    opened: OpenedWorkspace,
    rules: Sequence[Rule],
    fresh: Sequence[tuple[int, int]],
    flow_rules: Sequence[Rule],
    before: Workspace | None,
    crashed: Crashes,
    failed: Crashes,
    jobs: int,
) -> Iterator[tuple[int, int, list[Yielded]]]:
    """What the rules yield for each of these groups of packages, given by the places of its view and its own, with
    these; and what flow_rules yield on the message flow, with _FLOW for a place. failed: receives those of them that
    failed."""
    groups = opened.workspace.groups
    if not groups or not processes.may_fork():
        for place, at in fresh:
            whole = _Slice(at, 0, len(groups[at]))
            hits = [
                hit
                for family in dict.fromkeys(rule.family for rule in rules)
                for _, hit in _run_part(opened, rules, _Task(place, (whole,), family), crashed)
            ]
            yield place, at, hits
        if flow_rules:
            yield _FLOW, 0, _run_flow_part(opened, flow_rules, before, failed)
        return
    places = group_pairs(fresh)
    count = max((sum(len(groups[at]) for at in those) for those in places.values()), default=0)
    if count * len(places) < _ALONE and not flow_rules:
        jobs = 1
    # A rule that does not end on a package must not stop the run: no rule runs in this process.
    size = -(-count // -(-jobs // _JOBS_PER_PART))
    asked = {rule.family for rule in rules}
    families = [*(each for each in _LONGEST if each in asked), *sorted(asked.difference(_LONGEST))]
    sizes = {family: -(-size // _PARTS_OF_LAST) if family == _LONGEST[-1] else size for family in families}
    parts = [
        _Task(place, slices, family)
        for place, those in places.items()
        for family in families
        for slices in _cut([(at, len(groups[at])) for at in those], sizes[family])
    ]
    if flow_rules:
        from ..model.flow.workspace import get_flow

        get_flow(opened.workspace).jobs = jobs
    # The message flow takes longest.
    tasks = [_FLOW_TASK, *parts] if flow_rules else parts
    done: dict[_Task, Any] = {}
    if tasks:
        opened.store.close()  # no other process may go on with a connection of this one
    for task, result in processes.run_forked(_run_task, tasks, jobs, opened, rules, flow_rules, before):
        if isinstance(result, processes.Died) and task != _FLOW_TASK:
            result = _run_singly(opened, rules, task)
        done[task] = result
    yielded: dict[tuple[int, int], list[Yielded]] = {each: [] for each in fresh}
    for task in parts:
        view = opened.views[task.place]
        hits, unresolved, failures = done[task]
        for at, hit in hits:
            yielded[task.place, at].append(hit)
        view.unresolved.update(unresolved)
        for failure in failures:
            _record_failure(crashed, failure, view.target.name)
    yield from ((place, at, hits) for (place, at), hits in yielded.items())
    if flow_rules:
        result = done[_FLOW_TASK]
        if isinstance(result, processes.Died):
            failed[", ".join(rule.name for rule in flow_rules), f"the check of the message flow {result.why}"] = []
            result = _Done([], set(), {})
        failed.update(result.failures)
        yield _FLOW, 0, [hit for _, hit in result.hits]


def _cut(groups: Iterable[tuple[int, int]], size: int) -> Iterator[tuple[_Slice, ...]]:
    """Groups of packages, each with how many it has, cut into pieces of `size` packages, which may be of several."""
    piece: list[_Slice] = []
    room = size
    for group, count in groups:
        start = 0
        while start < count:
            end = min(start + room, count)
            piece.append(_Slice(group, start, end))
            room -= end - start
            start = end
            if not room:
                yield tuple(piece)
                piece, room = [], size
    if piece:
        yield tuple(piece)


def _run_task(
    opened: OpenedWorkspace, rules: Sequence[Rule], flow_rules: Sequence[Rule], before: Workspace | None, task: _Task
) -> _Done:
    """What a process does: a part of a view, or the message flow."""
    failed: Crashes = {}
    if task == _FLOW_TASK:
        return _Done([(_FLOW, each) for each in _run_flow_part(opened, flow_rules, before, failed)], set(), failed)
    return _Done(_run_part(opened, rules, task, failed), opened.views[task.place].unresolved, failed)


def _run_part(
    opened: OpenedWorkspace, rules: Sequence[Rule], task: _Task, failed: Crashes
) -> list[tuple[int, Yielded]]:
    """What rules yield for some packages on one view, each with its group. failed: receives the rules that failed."""
    view, groups = opened.views[task.place], opened.workspace.groups
    asked = [rule for rule in rules if rule.family == task.family]
    found: list[tuple[int, Yielded]] = []
    parts = [groups[group][start:end] for group, start, end in task.slices]
    processes.begin_part(0, _estimate_bytes(opened.workspace, [name for part in parts for name in part]))
    try:
        for part, (group, *_) in zip(parts, task.slices, strict=True):
            view.part = frozenset(part)
            found += [(group, each) for each in _run_all(asked, view, failed)]
        return found
    finally:
        view.part = None


def _estimate_bytes(workspace: Workspace, packages: Collection[str]) -> int:
    """The amount of text whose extraction may take as long as the rules on these packages."""
    files = sum(len(workspace.packages[name].linked.files) for name in packages)
    return (1 + len(packages)) * _PACKAGE_BYTES + files * _FILE_BYTES


def _run_singly(opened: OpenedWorkspace, rules: Sequence[Rule], task: _Task) -> _Done:
    """As _run_task, package by package, to name the package on which the rules end the process."""
    places = ((group, at) for group, start, end in task.slices for at in range(start, end))
    singles = [task._replace(slices=(_Slice(group, at, at + 1),)) for group, at in places]
    done = _Done([], set(), {})
    for single, result in processes.run_forked(_run_task, singles, 1, opened, rules, (), None):
        if isinstance(result, processes.Died):
            group, at, _ = single.slices[0]
            names = ", ".join(rule.name for rule in rules if rule.family == task.family)
            done.failures[names, f"the check of `{opened.workspace.groups[group][at]}` {result.why}"] = []
            continue
        done.hits.extend(result.hits)
        done.unresolved.update(result.unresolved)
        done.failures.update(result.failures)
    return done


def _run_all(rules: Iterable[Rule], view, crashed: Crashes) -> Iterator[Yielded]:
    for rule in rules:
        for hit in _run_safely(rule, view.target.name, crashed, lambda rule=rule: rule.run(view)):
            if not view.is_refused(hit.package, hit.place):
                yield rule.name, hit


def _run_flow_part(
    opened: OpenedWorkspace, rules: Sequence[Rule], before: Workspace | None, failed: Crashes
) -> list[Yielded]:
    """What rules yield on the message flow. failed: receives the rules that failed."""
    packages = opened.workspace.packages
    processes.begin_part(0, _estimate_bytes(opened.workspace, packages))
    processes.allow_memory(len(packages) * _PACKAGE_MEMORY)
    return [(rule.name, each) for rule in rules for each in _run_safely(rule, "", failed, _bind(rule, opened, before))]


def _run_on_install(opened: OpenedWorkspace, rule: Rule, crashed: Crashes) -> Iterator[tuple[str, str, Diagnostic]]:
    """What a rule yields for the built files, machine by machine. It is not stored, since a machine can change at any
    time."""
    installed = opened.installed
    if installed is None:
        return
    views = {view.target.name: view for view in opened.views}
    for libraries in opened.shared_libraries:
        view = views.get(libraries.target, opened.views[0])
        yielded = _run_safely(
            rule, libraries.target, crashed, lambda view=view, libraries=libraries: rule.run(view, installed, libraries)
        )
        yield from ((rule.name, libraries.target, each) for each in yielded)


def _bind(rule: Rule, opened: OpenedWorkspace, before: Workspace | None) -> Callable[[], Iterable[Diagnostic]]:
    """The call of a rule that asks no target."""
    if not rule.has_base:
        return lambda: rule.run(opened.workspace)
    return lambda: rule.run(opened.workspace, before) if before is not None else ()


def _run_safely(rule: Rule, target: str, crashed: Crashes, run: Callable[[], Iterable[Any]]) -> Iterator[Any]:
    """What a rule yields up to where it fails, if it does."""
    try:
        for each in run():
            rule.verify(each[1] if rule.scope == "targets" else each)
            yield each
    except SnapshotError:
        raise  # no rule can do without the data
    except Exception as error:
        # The results of the other rules stay valid; the failure is reported and decides the exit status.
        _record_failure(crashed, (rule.name, describe_unforeseen(error)), target)


def _record_failure(crashed: Crashes, failure: tuple[str, str], target: str) -> None:
    targets = crashed.setdefault(failure, [])
    if target and target not in targets:
        targets.append(target)
