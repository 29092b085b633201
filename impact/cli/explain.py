"""rosimpact explain."""

from ...edges.console import UserError
from .output import make_command


@make_command()
def explain(rule: str | None) -> str:
    """The documentation of a rule, group or family, or the list of them."""
    from ..rules import explain as pages
    from ..rules.rule import load_rules

    rules = load_rules()
    try:
        return pages.list_rules(rules) if rule is None else pages.explain(rule, rules)
    except KeyError as error:
        raise UserError(error.args[0]) from None
