"""rosimpact prune."""

from pathlib import Path

from ...edges.console import UserError, format_count
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar, say_notes


@make_command("text", "json", "patch")
def prune(
    path: Path, *, topic, assume_closed, apply, out, undo, verify, run, seconds, keep_builds, length, config,
    follow_links, format, output, all, jobs, quiet,
) -> str | tuple[str, int]:  # fmt: skip
    """The plan of lighter messages, as text, JSON or a patch; written where that is asked for."""
    if sum((apply, undo, out is not None)) > 1:
        raise UserError("--apply, --out and --undo: choose one")
    if not verify and (run or keep_builds is not None):
        raise UserError("--run and --keep-builds: are for --verify; add it")
    if verify and (undo or format != "text"):
        raise UserError("--verify: tells in text what it compared; leave out --undo and --format")
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
        return render_plan_json(prepared.plan, __version__)
    return render_plan_text(prepared.plan, session.make_diff(prepared), all, find_style(output))
