"""rosimpact graph."""

from pathlib import Path

from ...edges.console import UserError
from .output import find_style, make_command, make_progress_bar, say_notes


@make_command("text", "json", "graphml", "dot", "mermaid", "html", "nodl", folders=("nodl",))
def graph(
    path: Path, *, launch, set_, code, node, topic, package, around, hops, rev, base, format, output, all, jobs, quiet,
    follow_links, observed,
) -> str | dict[str, str] | tuple[str, int]:  # fmt: skip
    """The message-flow graph."""
    given = dict(argument.partition(":=")[::2] for argument in set_)
    if any(":=" not in argument for argument in set_):
        raise UserError("--set: write NAME:=VALUE")
    if given and not launch:
        raise UserError("--set: arguments belong to a launch file; name it with --launch")
    if code and launch:
        raise UserError("--code: shows the graph without launch files; leave out --code or --launch")
    if format == "nodl" and (base or topic or around):
        raise UserError("--format nodl: writes whole interfaces of one revision; choose nodes with --node or --package")
    if observed is not None and (base or format not in ("text", "json") or node or topic or package or around):
        raise UserError("--observed: compares a whole system at one revision, as text or json")
    from ..analysis.graph import build_graphs
    from ..report.graph import draw, draw_nodes

    seen = None
    if observed is not None:
        from ..analysis.observed import read_observation

        seen = read_observation(observed)
    found = build_graphs(
        path, rev=rev, base=base, launch=launch, arguments=given, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links,
        code_alone=code or (format == "nodl" and not launch),
    )  # fmt: skip
    say_notes(found.notes)
    if seen is not None:
        from ..model.flow.observed import compare_observed
        from ..report.graph.observed import render_observed

        difference = compare_observed(found.now, seen)
        return render_observed(difference, format, find_style(output)), int(difference.differs)
    if format == "nodl":
        return draw_nodes(found.now, nodes=node, packages=package)
    return draw(
        found.now, format, found.before, nodes=node, topics=topic, packages=package, around=around,
        hops=hops, everything=all, style=find_style(output),
    )  # fmt: skip
