"""Values of launch and parameter files that the parameters of nodes do not take."""

from collections.abc import Iterator

from ...model.flow.launches import RefusedValue
from ...model.parameter_values import GivenValue, ParameterTerms
from ..vocabulary import At, Diagnostic, Doubt, Workspace
from .launch_settings import group_by_line


def find_refused_values(workspace: Workspace) -> Iterator[tuple[RefusedValue, Diagnostic]]:
    """Each such value once, with the diagnostic about the first node that refuses it."""
    settings = group_by_line(workspace, lambda start: start.refused, lambda refused: refused.given.name)
    for (path, line, name), rows in settings:
        start, refused = rows[0]
        data = describe_refused(refused, start.program.partition("/")[2])
        kind = "clamped" if refused.clamped else "refused"
        doubts = (Doubt.DISTURBS,) if refused.clamped else ()
        yield refused, Diagnostic(At(path, line), name, start.package, data, kind, doubts)


def describe_refused(refused: RefusedValue, program: str) -> dict[str, str]:
    """What the texts say about a value."""
    given, terms = refused.given, refused.terms
    return {
        "program": program,
        "value": f"`{given.text}`",
        "given": given.type,
        "article": "an" if given.type.startswith("integer") else "a",
        "declared": terms.type,
        "broken": refused.broken,
        "place": f"{terms.path}:{terms.line}",
        "remedy": make_remedy(given, terms),
    }


def make_remedy(given: GivenValue, terms: ParameterTerms) -> str:
    """How to write a value so that it has the type of its parameter."""
    if (given.type, terms.type) == ("integer", "double"):
        return f"write `{given.text}.0`"
    if given.type != "string" and terms.type == "string":
        return f'write `"{given.text}"`'
    return f"give a value of type {terms.type}"
