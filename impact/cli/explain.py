"""rosimpact explain."""

from ...edges.console import say
from .output import deliver_answer


def explain(rule: str | None) -> int:
    """Prints the documentation of a rule or group, or the list of them. Returns the exit status: 0, or 2 (no such
    rule)."""
    from ..rules import explain as pages
    from ..rules.rule import all_rules

    rules = all_rules()
    try:
        text = pages.list_rules(rules) if rule is None else pages.explain(rule, rules)
    except KeyError as error:
        say(f"rosimpact: {error.args[0]}")
        return 2
    return deliver_answer(lambda: text)
