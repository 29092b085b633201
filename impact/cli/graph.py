"""rosimpact graph."""

import os
import re
from pathlib import Path

from ...edges.console import UserError, format_count, say
from .output import find_style, make_command, make_progress_bar, say_notes

_ADDRESS = re.compile(r"(?!(?:javascript|data|vbscript|blob):)[a-z][a-z0-9+.-]*:[^\s\"<>\\^`|]*\Z")


@make_command("text", "json", "graphml", "dot", "mermaid", "html", "nodl", folders=("nodl",))
def graph(
    path: Path, *, launch, set_, system, code, node, topic, package, around, hops, rev, base, observed, strict, config,
    format, output, all, editor, jobs, quiet, follow_links,
) -> tuple[str | dict[str, str], int]:  # fmt: skip
    """The message-flow graph, and the exit status."""
    given = dict(argument.partition(":=")[::2] for argument in set_)
    if any(":=" not in argument for argument in set_):
        raise UserError("--set: write NAME:=VALUE")
    if system and launch:
        raise UserError("--system: names launch files already; leave out --system or --launch")
    if given and not launch and not system:
        raise UserError("--set: arguments belong to a launch file; name it with --launch")
    if code and (launch or system):
        raise UserError("--code: shows the graph without launch files; leave out --code, or --launch and --system")
    if format == "nodl" and (base or topic or around):
        raise UserError("--format nodl: writes whole interfaces of one revision; choose nodes with --node or --package")
    if observed is not None and (base or format not in ("text", "json") or node or topic or package or around):
        raise UserError("--observed: compares a whole system at one revision, as text or json")
    address = _validate_editor(editor)
    from ..analysis.graph import build_graphs
    from ..report.graph import draw, draw_nodes, list_unknown_names

    seen = None
    if observed is not None:
        from ..analysis.observed import read_observation

        seen = read_observation(observed)
    found = build_graphs(
        path, rev=rev, base=base, launch=launch, arguments=given, system=system, config=config, jobs=jobs,
        progress=None if quiet else make_progress_bar(), follow_links=follow_links,
        code_alone=code or (format == "nodl" and not launch and not system),
    )  # fmt: skip
    say_notes(found.notes)
    if seen is not None:
        from ..model.flow.observed import compare_observed
        from ..report.graph.observed import render_observed

        difference = compare_observed(found.now, seen)
        return render_observed(difference, format, find_style(output)), int(difference.differs)
    asked = {"nodes": node, "topics": topic, "packages": package, "around": around, "hops": hops}
    text: str | dict[str, str]
    if format == "nodl":
        text = draw_nodes(found.now, nodes=node, packages=package)
    else:
        # What an editor opens is the file on disk, which another revision's lines do not fit.
        text = draw(
            found.now, format, found.before, everything=all, style=find_style(output), **asked,
            editor="" if rev else address, folder=os.path.realpath(path),
            interfaces=found.describe_interfaces() if format == "html" else None,
        )  # fmt: skip
    unknown = list_unknown_names(found.now, **asked) if strict else []
    for line in unknown:
        say(line)
    if unknown:
        count = format_count(len(unknown), "API call")
        say(f"rosimpact: --strict: {count} whose name or type is not fully known; write it out, or give it with --set")
    return text, int(bool(unknown))


def _validate_editor(pattern: str) -> str:
    """The address of a place in an editor, empty for no links. Raises UserError."""
    if pattern == "off":
        return ""
    if "{path}" not in pattern or not _ADDRESS.match(pattern):
        example = "vscode://file/{path}:{line}"
        raise UserError(f"--editor {pattern}: write an address such as {example}, or off for no links")
    return pattern
