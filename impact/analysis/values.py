"""Values that callbacks handle, ignore and crash on, against what publishers send: from a path to a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges.files import read_text, write_file
from ..facts.store import Store
from ..model.flow.workspace import get_flow, link_for_flow
from ..values.answers import CallbackAnswer, ValuesReport
from ..values.harness.replay import Replayed, is_confirmed
from ..values.matching import Mismatch, list_mismatches
from ..values.outcomes import Bounds, Reaction
from ..values.survey import KINDS, Asked, Survey, make_records
from ..values.witnesses import WitnessError, WitnessRecord, format_witnesses, parse_witnesses
from .session import CheckError, open_tree

_MOST_BYTES = 20_000_000


class ValuesAnswer(NamedTuple):
    """The callbacks that were asked for, and what their publishers send that they do not handle. others: callbacks that
    were explored for what they publish."""

    report: ValuesReport
    others: tuple[CallbackAnswer, ...]
    mismatches: tuple[Mismatch, ...]


def explore_values(
    path: Path, *, nodes: Sequence[str] = (), topics: Sequence[str] = (), callbacks: Sequence[str] = (),
    kinds: Sequence[str] = ("subscriber",), bounds: Bounds | None = None, replays: bool = False,
    fuzz_seconds: float = 0.0, emit: str = "", out: Path | None = None,
    publishers: bool = True, jobs: int = 1, progress: Callable[[int, int], None] | None = None,
    follow_links: bool = False,
) -> ValuesAnswer:  # fmt: skip
    """Explores callbacks of the workspace at a path. publishers: whether those callbacks are explored too that publish
    what these receive. emit: what is written to the folder out besides: `klee`, `tests`, `yaml` or `witnesses`. The
    others as Survey has them. Raises CheckError and TreeError with a text for the user."""
    for kind in kinds:
        if kind not in KINDS:
            raise CheckError(f"--kind {kind}: is none of {', '.join(KINDS)}")
    tree = open_tree(path, "", follow_links=follow_links)
    with Store() as store:
        workspace = link_for_flow(tree, store, jobs, None)
        graph = get_flow(workspace).system
        survey = Survey(path, workspace, graph, bounds or Bounds())
        asked = Asked(nodes, topics, callbacks, kinds)
        report, others = survey.explore(
            asked, publishers=publishers, replays=replays, fuzz_seconds=fuzz_seconds, jobs=jobs, progress=progress
        )
        if (nodes or topics or callbacks) and not report.callbacks:
            raise CheckError(f"{_spell(nodes, topics, callbacks)}: no such callback; list them without it")
        if out is not None:
            _write(survey, asked, report, emit, out)
        mismatches = list_mismatches([*report.callbacks, *others], graph)
    own = {(one.path, one.line, one.callback) for one in report.callbacks}
    kept = [one for one in mismatches if (one.subscriber.path, one.subscriber.line, one.subscriber.callback) in own]
    return ValuesAnswer(report, others, tuple(kept))


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
        survey = Survey(path, workspace, get_flow(workspace).system, Bounds())
        return [(record, seen, is_confirmed(record.witness, seen)) for record, seen in survey.replay(records)]


def _spell(nodes: Sequence[str], topics: Sequence[str], callbacks: Sequence[str]) -> str:
    rows = (("--node", nodes), ("--topic", topics), ("--callback", callbacks))
    return " ".join(f"{option} {name}" for option, names in rows for name in names)
