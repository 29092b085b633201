"""rosimpact graph."""

import os
import re
from pathlib import Path

from ...edges.console import UserError
from .output import find_style, make_command, make_progress_bar, say_notes

_ADDRESS = re.compile(r"(?!(?:javascript|data|vbscript|blob):)[a-z][a-z0-9+.-]*:[^\s\"<>\\^`|]*\Z")


@make_command("text", "json", "graphml", "dot", "mermaid", "html")
def graph(
    path: Path, *, launch, set_, code, node, topic, package, around, hops, rev, base, format, output, all, editor, jobs,
    quiet, follow_links,
) -> str:  # fmt: skip
    """The message-flow graph."""
    given = dict(argument.partition(":=")[::2] for argument in set_)
    if any(":=" not in argument for argument in set_):
        raise UserError("--set: write NAME:=VALUE")
    if given and not launch:
        raise UserError("--set: arguments belong to a launch file; name it with --launch")
    if code and launch:
        raise UserError("--code: shows the graph without launch files; leave out --code or --launch")
    address = _validate_editor(editor)
    from ..analysis.graph import build_graphs
    from ..report.graph import draw

    found = build_graphs(
        path, rev=rev, base=base, launch=launch, arguments=given, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links, code_alone=code,
    )  # fmt: skip
    say_notes(found.notes)
    # What an editor opens is the file on disk, which another revision's lines do not fit.
    address = "" if rev else address
    return draw(
        found.now, format, found.before, nodes=node, topics=topic, packages=package, around=around,
        hops=hops, everything=all, style=find_style(output), editor=address, folder=os.path.realpath(path),
        interfaces=found.describe_interfaces() if format == "html" else None,
    )  # fmt: skip


def _validate_editor(pattern: str) -> str:
    """The address of a place in an editor, empty for no links. Raises UserError."""
    if pattern == "off":
        return ""
    if "{path}" not in pattern or not _ADDRESS.match(pattern):
        example = "vscode://file/{path}:{line}"
        raise UserError(f"--editor {pattern}: write an address such as {example}, or off for no links")
    return pattern
