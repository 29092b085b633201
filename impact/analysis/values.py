"""Values that callbacks handle, ignore and crash on, against what publishers send: from a path to a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges.files import read_text, write_file
from ..facts.store import Store
from ..model.flow.graph import Graph
from ..model.flow.workspace import get_flow, link_for_flow
from ..tree import Tree
from ..values.answers import CallbackAnswer, ValuesReport
from ..values.comparing import ValueChange, compare_values
from ..values.disk import open_sources
from ..values.harness.replay import Replayed, is_confirmed
from ..values.joining import Joined, describe_units, join_publishers
from ..values.matching import Mismatch
from ..values.outcomes import Bounds, Reaction
from ..values.survey import KINDS, Asked, Survey, make_records
from ..values.witnesses import WitnessError, WitnessRecord, format_witnesses, parse_witnesses
from .session import CheckError, open_tree

_MOST_BYTES = 20_000_000


class ValuesAnswer(NamedTuple):
    """The callbacks that were asked for, and what their publishers send that they do not handle. others: callbacks that
    were explored for what they publish. changes: since the base, empty without one; base: what it was asked for as."""

    report: ValuesReport
    others: tuple[CallbackAnswer, ...]
    mismatches: tuple[Mismatch, ...]
    changes: tuple[ValueChange, ...] = ()
    base: str = ""


def explore_values(
    path: Path, *, nodes: Sequence[str] = (), topics: Sequence[str] = (), callbacks: Sequence[str] = (),
    kinds: Sequence[str] = ("subscriber",), bounds: Bounds | None = None, replays: bool = False,
    fuzz_seconds: float = 0.0, emit: str = "", out: Path | None = None,
    publishers: bool = True, jobs: int = 1, progress: Callable[[int, int], None] | None = None,
    follow_links: bool = False, base: Sequence[str] = (),
) -> ValuesAnswer:  # fmt: skip
    """Explores callbacks of the workspace at a path. publishers: whether those callbacks are explored too that publish
    what these receive. base: what the workspace is compared with, as open_base_tree() takes it. emit: what is written
    to the folder out besides: `klee`, `tests`, `yaml` or `witnesses`. The others as Survey has them. Raises CheckError
    and TreeError with a text for the user."""
    for kind in kinds:
        if kind not in KINDS:
            raise CheckError(f"--kind {kind}: is none of {', '.join(KINDS)}")
    tree = open_tree(path, "", follow_links=follow_links)
    with Store() as store:
        workspace = link_for_flow(tree, store, jobs, None)
        graph = get_flow(workspace).system
        with Survey(path, workspace, graph, bounds or Bounds()) as survey:
            asked = Asked(nodes, topics, callbacks, kinds)
            report, others = survey.explore(
                asked, publishers=publishers, replays=replays, fuzz_seconds=fuzz_seconds, jobs=jobs, progress=progress
            )
            if (nodes or topics or callbacks) and not report.callbacks:
                raise CheckError(f"{_spell(nodes, topics, callbacks)}: no such callback; list them without it")
            if out is not None:
                _write(survey, asked, report, emit, out)
            joined = Joined((), ())
            if publishers:
                joined = join_publishers(survey, report.callbacks, others, jobs, progress)
            units: list[Mismatch] = []
            if publishers:
                received = {topic for one in report.callbacks for topic in one.topics}
                narrowed = bool(nodes or topics or callbacks)
                units = [
                    one
                    for one in describe_units(workspace, graph, report.callbacks)
                    if one.topic in received or not narrowed
                ]
            changes: tuple[ValueChange, ...] = ()
            if base:
                # Imported here alone: what compares revisions takes longer to import than a small workspace to read.
                from .revision_compare import open_base_tree

                before, _ = open_base_tree(tree, base)
                now = [*report.callbacks, *joined.others]
                changes = tuple(_compare(before, store, asked, publishers, survey.bounds, now, graph, jobs))
    return ValuesAnswer(report, joined.others, (*joined.mismatches, *units), changes, " ".join(base))


def _compare(
    tree: Tree, store: Store, asked: Asked, publishers: bool, bounds: Bounds, now: Sequence[CallbackAnswer],
    graph: Graph, jobs: int,
) -> list[ValueChange]:  # fmt: skip
    """What changed since a tree."""
    workspace = link_for_flow(tree, store, jobs, None)
    old = get_flow(workspace).system
    with open_sources(tree) as root, Survey(root, workspace, old, bounds) as survey:
        report, others = survey.explore(asked, publishers=publishers, jobs=jobs)
        joined = join_publishers(survey, report.callbacks, others, jobs) if publishers else Joined((), ())
    return compare_values([*report.callbacks, *joined.others], old, now, graph)


def _write(survey: Survey, asked: Asked, report: ValuesReport, emit: str, out: Path) -> None:
    """Writes what was asked for into a folder. Raises CheckError."""
    records = make_records(report)
    if emit == "klee":
        survey.emit_klee(asked, out)
        return
    if emit == "tests":
        crashing = [one for one in records if one.witness.result is Reaction.CRASH]
        files = survey.write_tests(crashing)
    elif emit == "yaml":
        files = {"commands.sh": "\n".join([*survey.write_commands(records), ""])}
    else:
        files = {"witnesses.json": format_witnesses(records)}
    for name, text in files.items():
        write_file(out / name, text.encode())


def replay_witnesses(
    path: Path, file: Path, *, jobs: int = 1, follow_links: bool = False
) -> list[tuple[WitnessRecord, Replayed, bool]]:
    """Runs the witnesses of a file on the workspace at a path: each with what was seen, and whether it is what the file
    says. Raises CheckError and TreeError with a text for the user."""
    try:
        records = parse_witnesses(read_text(file, _MOST_BYTES))
    except OSError as error:
        raise CheckError(f"{file}: cannot be read: {error.strerror}") from None
    except WitnessError as error:
        raise CheckError(f"{file}: {error}") from None
    tree = open_tree(path, "", follow_links=follow_links)
    with Store() as store:
        workspace = link_for_flow(tree, store, jobs, None)
        with Survey(path, workspace, get_flow(workspace).system, Bounds()) as survey:
            return [(record, seen, is_confirmed(record.witness, seen)) for record, seen in survey.replay(records)]


def _spell(nodes: Sequence[str], topics: Sequence[str], callbacks: Sequence[str]) -> str:
    rows = (("--node", nodes), ("--topic", topics), ("--callback", callbacks))
    return " ".join(f"{option} {name}" for option, names in rows for name in names)
