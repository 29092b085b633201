"""rosimpact prune."""

from pathlib import Path

from ...edges.console import UserError, format_count
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar, say_notes


@make_command("text", "json", "patch")
def prune(
    path: Path, *, topic, assume_closed, apply, out, undo, length, config, follow_links, format, output, all, jobs,
    quiet,
) -> str:  # fmt: skip
    """The plan of lighter messages, as text, JSON or a patch; written where that is asked for."""
    if sum((apply, undo, out is not None)) > 1:
        raise UserError("--apply, --out and --undo: choose one")
    from ..prune import session
    from ..report.prune import render_plan_json, render_plan_text

    if undo:
        count = format_count(len(session.undo(path)), "file")
        return f"taken back: {count}\n"
    prepared = session.prepare(
        path, topics=topic, closed=assume_closed, config=config, length=length, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links,
    )  # fmt: skip
    if prepared.plan.plans and apply:
        session.apply_plan(path, prepared)
        say_notes([f"written to {path}; `rosimpact prune --undo {path}` takes it back"])
    elif out is not None:
        session.write_copy(path, out, prepared)
        say_notes([f"the changed copy is in {out}"])
    if format == "patch":
        return session.make_diff(prepared)
    if format == "json":
        return render_plan_json(prepared.plan, __version__)
    return render_plan_text(prepared.plan, session.make_diff(prepared), all, find_style(output))
