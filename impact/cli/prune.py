"""rosimpact prune."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from ...edges.console import UserError, format_count, make_step_reporter, say
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar, say_notes, validate_choice

if TYPE_CHECKING:
    from ..measure.gains import TopicGain
    from ..prune.savings import TopicSaving
    from ..prune.session import Prepared


@make_command("text", "json", "patch")
def prune(
    path: Path, *, topic, assume_closed, apply, out, undo, verify, run, seconds, keep_builds, measure, bag, rate,
    repeat, nodes, link, loopback, results, length, config, follow_links, format, output, all, jobs, quiet,
) -> str | tuple[str, int]:  # fmt: skip
    """The plan of lighter messages, as text, JSON or a patch; written where that is asked for."""
    if sum((apply, undo, out is not None)) > 1:
        raise UserError("--apply, --out and --undo: choose one")
    if not verify and (run or keep_builds is not None):
        raise UserError("--run and --keep-builds: are for --verify; add it")
    if verify and (undo or format != "text"):
        raise UserError("--verify: tells in text what it compared; leave out --undo and --format")
    measuring = {"bag": bag, "rate": rate, "repeat": repeat, "nodes": nodes, "link": link, "loopback": loopback,
                 "results": results}  # fmt: skip
    beside = [f"--{name}" for name, value in measuring.items() if value]
    alone = [name for name in beside if name not in ("--bag", "--rate")]
    if not measure and alone:
        raise UserError(f"{', '.join(alone)}: for --measure; add it")
    if beside and not measure and (verify or undo or format == "patch"):
        raise UserError(f"{', '.join(beside)}: stands beside the plan; leave out --verify, --undo and --format patch")
    if measure and (verify or undo or format == "patch"):
        raise UserError("--measure: stands beside the plan; leave out --verify, --undo and --format patch")
    from ..prune import session
    from ..report.prune import render_plan_json, render_plan_text

    if undo:
        count = format_count(len(session.undo(path)), "file")
        return f"taken back: {count}\n"
    text = ""
    prepared = session.prepare(
        path, topics=topic, closed=assume_closed, config=config, length=length, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links,
    )  # fmt: skip
    if verify:
        from ..prune.verify import verify as verify_pruning
        from ..report.prune import render_verification

        report = (lambda text: None) if quiet else (lambda text: say_notes([text]))
        done = verify_pruning(path, prepared, commands=run, seconds=seconds, say=report, keep=keep_builds)
        if not done.is_equal:
            return render_verification(done, find_style(output)), 1
        text = render_verification(done, find_style(output))
    gains = _measure(path, prepared, seconds, length, quiet, **measuring) if measure else []
    savings = _find_savings(path, prepared, bag, rate, quiet) if beside and not measure else []
    if prepared.plan.plans and apply:
        session.apply_plan(path, prepared)
        say_notes([f"written to {path}; `rosimpact prune --undo {path}` takes it back"])
    elif out is not None:
        session.write_copy(path, out, prepared)
        say_notes([f"the changed copy is in {out}"])
    if verify:
        return text, 0
    if format == "patch":
        return session.make_diff(prepared)
    if format == "json":
        return render_plan_json(prepared.plan, __version__, gains, savings)
    return render_plan_text(prepared.plan, session.make_diff(prepared), all, find_style(output), gains, savings)


def _find_savings(
    path: Path, prepared: Prepared, bag: Path | None, rate: float | None, quiet: bool
) -> list[TopicSaving]:  # fmt: skip
    """What the plan saves in a second, at the rate that was given, or as the bag has it."""
    from ..analysis.bags import measure_bag
    from ..analysis.message_files import MessageFolders
    from ..prune.savings import find_savings

    facts = None
    topics = [topic for one in prepared.plan.plans for topic in one.topics]
    if bag is not None and topics:
        progress = None if quiet else make_step_reporter()
        facts = measure_bag(bag, topics, find_text=MessageFolders((path,), os.environ).find, progress=progress)
    return find_savings(prepared.plan, rate, facts)


def _measure(
    path: Path, prepared: Prepared, seconds: float, length: int, quiet: bool, *, bag: Path | None, rate: float | None,
    repeat: int | None, nodes: str, link: str, loopback: bool, results: Path | None,
) -> list[TopicGain]:  # fmt: skip
    """What the plan gains on the link, topic by topic."""
    from ..measure.gains import measure_gains
    from ..measure.plan import NODES, Conditions, check_number, choose_network

    nodes = nodes or ("roscpp" if prepared.ros == 1 else "dds")
    validate_choice("--nodes", nodes, NODES)
    conditions = Conditions(
        nodes=nodes, seconds=check_number("seconds", seconds, 0.1), **choose_network(loopback, link)
    )  # fmt: skip
    progress = (lambda _: None) if quiet else say
    with contextlib.ExitStack() as opened:
        folder = results or Path(opened.enter_context(tempfile.TemporaryDirectory()))
        folder.mkdir(parents=True, exist_ok=True)
        return measure_gains(
            path, prepared, conditions, rate=check_number("rates", rate) if rate else 0,
            repeat=int(check_number("repeat", repeat or 3, 1)), bag=bag, length=length, folder=folder,
            progress=progress,
        )  # fmt: skip
