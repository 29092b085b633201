"""rosimpact values."""

from pathlib import Path

from ...edges.console import UserError
from ...edges.processes import count_cores
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar


@make_command("text", "json")
def values(
    path: Path, *, node, topic, callback, kind, text, array, loops, seconds, replay, publishers, follow_links, format,
    output, all, jobs, quiet,
) -> str:  # fmt: skip
    """For which values callbacks act, do nothing, only log or crash, and which of them publishers send."""
    from ..analysis.values import survey_values
    from ..report.values import render_values_json, render_values_text
    from ..values.outcomes import Bounds

    if not path.is_dir():
        raise UserError(f"{path}: is no folder; give a workspace")
    answer = survey_values(
        path, nodes=node, topics=topic, callbacks=callback, kinds=kind or ["subscriber"],
        bounds=Bounds(text=text, array=array, loops=loops, seconds=seconds), replays=replay, publishers=publishers,
        jobs=jobs or count_cores(), progress=None if quiet else make_progress_bar(), follow_links=follow_links,
    )  # fmt: skip
    if format == "json":
        return render_values_json(answer, __version__)
    return render_values_text(answer, all, find_style(output))
