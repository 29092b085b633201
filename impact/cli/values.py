"""rosimpact values."""

from pathlib import Path

from ...edges.console import UserError
from ...edges.processes import count_cores
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar, validate_choice


@make_command("text", "json")
def values(
    path: Path, file: Path | None = None, *, node, topic, callback, kind, text, array, loops, seconds, compiling,
    replay, fuzz, emit, out, workspace, publishers, base, follow_links, format, output, all, jobs, quiet,
) -> str | tuple[str, int]:  # fmt: skip
    """For which values callbacks act, do nothing, only log or crash, and which of them publishers send."""
    from ..analysis.values import explore_values
    from ..report.values import render_values_json, render_values_text
    from ..values.outcomes import Bounds

    if file is not None:
        if str(path) != "replay":
            raise UserError(
                f"{path} {file}: one workspace at a time; to replay witnesses: rosimpact values replay FILE"
            )
        return _replay(file, workspace, jobs, follow_links)
    validate_choice("--emit", emit, ("", "klee", "tests", "yaml", "witnesses"))
    if bool(emit) != (out is not None):
        raise UserError("--emit and --out: are given together: what to write, and the folder for it")
    if not path.is_dir():
        raise UserError(f"{path}: is no folder; give a workspace")
    answer = explore_values(
        path, nodes=node, topics=topic, callbacks=callback, kinds=kind or ["subscriber"],
        bounds=Bounds(text=text, array=array, loops=loops, seconds=seconds, compiling=compiling), replays=replay,
        fuzz_seconds=fuzz, emit=emit, out=out, publishers=publishers, base=base,
        jobs=jobs or count_cores(), progress=None if quiet else make_progress_bar(), follow_links=follow_links,
    )  # fmt: skip
    if format == "json":
        return render_values_json(answer, __version__)
    return render_values_text(answer, all, find_style(output))


def _replay(file: Path, workspace: Path, jobs: int | None, follow_links: bool) -> tuple[str, int]:
    """The witnesses of a file, each with what was seen; status 1 where one of them was not."""
    from ..analysis.values import replay_witnesses
    from ..report.values import render_replays

    rows = replay_witnesses(workspace, file, jobs=jobs or count_cores(), follow_links=follow_links)
    return render_replays(rows), 0 if all(same for _, _, same in rows) else 1
