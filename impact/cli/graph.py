"""rosimpact graph."""

from pathlib import Path

from ...edges.console import UserError
from .output import find_style, make_command, make_progress_bar, say_notes


@make_command("text", "json", "graphml", "dot", "mermaid", "html", "nodl", folders=("nodl",))
def graph(
    path: Path, *, launch, set_, code, node, topic, package, around, hops, rev, base, format, output, all, jobs, quiet,
    follow_links,
) -> str | dict[str, str]:  # fmt: skip
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
    from ..analysis.graph import build_graphs
    from ..report.graph import draw, draw_nodes

    found = build_graphs(
        path, rev=rev, base=base, launch=launch, arguments=given, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links,
        code_alone=code or (format == "nodl" and not launch),
    )  # fmt: skip
    say_notes(found.notes)
    if format == "nodl":
        return draw_nodes(found.now, nodes=node, packages=package)
    return draw(
        found.now, format, found.before, nodes=node, topics=topic, packages=package, around=around,
        hops=hops, everything=all, style=find_style(output),
    )  # fmt: skip
