"""rosimpact why."""

from pathlib import Path

from ...edges.console import UserError, format_json
from .output import make_command


@make_command("text", "json")
def why(name: str, path: Path | None, target: tuple[str, ...], format: str, follow_links: bool) -> tuple[str, int]:
    """Who provides a name on each target, in which version, since when, and who in the workspace uses it; that of the
    current folder when no path is given, if it is one. The status is 1 when nobody provides it on some target."""
    from ..analysis import why as analysis

    if not name.strip():
        raise UserError("why: no name was given; name a package, header, module, executable or symbol")
    here = path or Path()
    looked = path is not None or analysis.is_workspace(here)
    found = analysis.find_answers(name, here if looked else None, target, follow_links=follow_links)
    answered = {a.target for a in found if any(offer.kind != "absent" for offer in a.offers)}
    status = int(answered != {a.target for a in found})
    if format == "text":
        return analysis.render_text(name, found, looked=looked), status
    return format_json([one._asdict() | {"offers": [offer._asdict() for offer in one.offers]} for one in found]), status
