"""Runs the rules on a workspace for every target: in several processes when there is much to do, and not at all when an
earlier run had the same input."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

from ...edges import processes
from ...edges.console import describe_unforeseen
from ..model.view import TargetView
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
# What a process does at once: the rules of a family, on a view (its place), on packages from a number to another.
_Task = tuple[int, int, int, str]
_FLOW_TASK: _Task = (_FLOW, 0, 0, "")

# (rule, why it failed) to the targets on which it did
Crashes = dict[tuple[str, str], list[str]]


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
    found: dict[str, list[Yielded]] = {}
    fresh = []
    for place, view in enumerate(opened.views):
        known = result_cache.load_results(opened.store, view, names)
        if known is None:
            fresh.append(place)
        else:
            found[view.target.name] = known
    key, on_flow = b"", None if flow_rules else []
    if flow_rules:
        key = result_cache.make_flow_key(opened.workspace, before, [rule.name for rule in flow_rules])
        known = result_cache.load_yielded(opened.store, key)
        on_flow = known[0] if known is not None else None
    asked = flow_rules if on_flow is None else ()
    failed: Crashes = {}
    for place, yielded in _run_in_parts(opened, rules, fresh, asked, before, crashed, failed, jobs):
        if place == _FLOW:
            on_flow = yielded
            if not failed:
                result_cache.store_yielded(opened.store, key, yielded, {})
            continue
        view = opened.views[place]
        by_name = {rule.name: rule for rule in rules}
        found[view.target.name] = yielded = lower_repeats(drop_outweighed(yielded, by_name), by_name)
        if not crashed:
            result_cache.store_results(opened.store, view, names, yielded)
    crashed.update(failed)
    return found, on_flow or []


def _run_in_parts(
    opened: OpenedWorkspace,
    rules: Sequence[Rule],
    places: Sequence[int],
    flow_rules: Sequence[Rule],
    before: Workspace | None,
    crashed: Crashes,
    failed: Crashes,
    jobs: int,
) -> Iterator[tuple[int, list[Yielded]]]:
    """What the rules yield for these views, each with its place among them, and flow_rules on the message flow, with
    _FLOW for a place; failed: receives those of them that failed."""
    packages = list(opened.workspace.packages)
    if not packages or not processes.may_fork():
        for place in places:
            yield place, list(_run_all(rules, opened.views[place], crashed))
        if flow_rules:
            yield _FLOW, _run_flow_part(opened, flow_rules, before, failed)
        return
    if len(packages) * len(places) < _ALONE and not flow_rules:
        jobs = 1
    # A rule that does not end on a package must not stop the run: no rule runs in this process.
    size = -(-len(packages) // -(-jobs // _JOBS_PER_PART))
    asked = {rule.family for rule in rules}
    families = [*(each for each in _LONGEST if each in asked), *sorted(asked.difference(_LONGEST))]
    sizes = {family: -(-size // _PARTS_OF_LAST) if family == _LONGEST[-1] else size for family in families}
    parts = [
        (place, at, min(at + sizes[family], len(packages)), family)
        for place in places
        for family in families
        for at in range(0, len(packages), sizes[family])
    ]
    if flow_rules:
        from ..model.flow.workspace import get_flow

        get_flow(opened.workspace).jobs = jobs
    # The message flow takes longest.
    tasks = [_FLOW_TASK, *parts] if flow_rules else parts
    done = {}
    if tasks:
        opened.store.close()  # no other process may go on with a connection of this one
    for task, result in processes.run_forked(_run_task, tasks, jobs, opened, rules, packages, flow_rules, before):
        if isinstance(result, processes.Died) and task != _FLOW_TASK:
            result = _run_singly(opened, rules, packages, task)
        done[task] = result
    for place, tasks_of_view in groupby(parts, key=lambda task: task[0]):
        view = opened.views[place]
        yielded: dict[str, list[Yielded]] = {}
        for task in tasks_of_view:
            hits, unresolved, failures = done[task]
            for name, hit in hits:
                yielded.setdefault(name, []).append((name, hit))
            for kind, unknown in unresolved.items():
                view.unresolved.setdefault(kind, set()).update(unknown)
            for failure in failures:
                _record_failure(crashed, failure, view.target.name)
        yield place, [each for rule in rules for each in yielded.get(rule.name, ())]
    if flow_rules:
        result = done[_FLOW_TASK]
        if isinstance(result, processes.Died):
            failed[", ".join(rule.name for rule in flow_rules), f"the check of the message flow {result.why}"] = []
            result = [], {}
        failed.update(result[1])
        yield _FLOW, result[0]


def _run_task(
    opened: OpenedWorkspace,
    rules: Sequence[Rule],
    packages: Sequence[str],
    flow_rules: Sequence[Rule],
    before: Workspace | None,
    task: _Task,
):
    """What a process does: a part of a view, or the message flow."""
    if task == _FLOW_TASK:
        failed: Crashes = {}
        return _run_flow_part(opened, flow_rules, before, failed), failed
    return _run_part(opened, rules, packages, task)


def _run_part(
    opened: OpenedWorkspace, rules: Sequence[Rule], packages: Sequence[str], task: _Task
) -> tuple[list[Yielded], dict[str, set[str]], Crashes]:
    """What rules yield for some packages on one view, what was not resolved, and the rules that failed."""
    place, at, end, family = task
    view = opened.views[place]
    crashed: Crashes = {}
    part = packages[at:end]
    view.part = frozenset(part)
    asked = [rule for rule in rules if rule.family == family]
    processes.begin_part(0, _estimate_bytes(opened.workspace, part))
    try:
        return list(_run_all(asked, view, crashed)), view.unresolved, crashed
    finally:
        view.part = None


def _estimate_bytes(workspace: Workspace, packages: Collection[str]) -> int:
    """The amount of text whose extraction may take as long as the rules on these packages."""
    files = sum(len(workspace.packages[name].linked.files) for name in packages)
    return (1 + len(packages)) * _PACKAGE_BYTES + files * _FILE_BYTES


def _run_singly(
    opened: OpenedWorkspace, rules: Sequence[Rule], packages: Sequence[str], task: _Task
) -> tuple[list[Yielded], dict[str, set[str]], Crashes]:
    """As _run_part, package by package, to name the package on which the rules end the process."""
    place, at, end, family = task
    singles = [(place, each, each + 1, family) for each in range(at, end)]
    hits: list[Yielded] = []
    unresolved: dict[str, set[str]] = {}
    crashed: Crashes = {}
    found = dict(processes.run_forked(_run_part, singles, 1, opened, rules, packages))
    for single in singles:
        result = found[single]
        if isinstance(result, processes.Died):
            names = ", ".join(rule.name for rule in rules if rule.family == family)
            failure = (names, f"the check of `{packages[single[1]]}` {result.why}")
            crashed.setdefault(failure, [])
            continue
        hits += result[0]
        for kind, unknown in result[1].items():
            unresolved.setdefault(kind, set()).update(unknown)
        crashed.update(result[2])
    return hits, unresolved, crashed


def _run_all(rules: Iterable[Rule], view, crashed: Crashes) -> Iterator[Yielded]:
    for rule in rules:
        for hit in _run_safely(rule, view.target.name, crashed, lambda rule=rule: rule.run(view)):
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
