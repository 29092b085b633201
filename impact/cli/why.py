"""rosimpact why."""

from pathlib import Path

from ...edges.console import json_text
from .output import TEXT_OR_JSON, deliver_answer


def why(name: str, path: Path | None, target: tuple[str, ...], format: str, follow_links: bool) -> int:
    """Prints who provides a name on each target, in which version, since when, and who in the workspace uses it; that
    of the current folder when no path is given, if it is one. Returns 1 when nobody provides it on some target."""
    unanswered = False

    def answer() -> str:
        nonlocal unanswered
        from ..analysis.why import answers, as_text, is_workspace

        here = path or Path()
        looked = path is not None or is_workspace(here)
        found = answers(name, here if looked else None, target, follow_links=follow_links)
        answered = {a.target for a in found if any(offer.kind != "absent" for offer in a.offers)}
        unanswered = answered != {a.target for a in found}
        if format == "text":
            return as_text(name, found, looked=looked)
        return json_text(
            [answer._asdict() | {"offers": [offer._asdict() for offer in answer.offers]} for answer in found]
        )

    return deliver_answer(answer, format, TEXT_OR_JSON, path=path or Path()) or int(unanswered)
