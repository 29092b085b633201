"""The documentation of rules as `rosimpact explain` prints it."""

from collections.abc import Mapping
from difflib import get_close_matches
from itertools import groupby

from .rule import Rule, groups


def summarize(rule: Rule) -> str:
    """What a rule reports, in the first sentence of its documentation."""
    return rule.documentation.strip().partition("\n")[0].partition(": ")[2]


def list_rules(rules: Mapping[str, Rule]) -> str:
    """All rules by family, and the groups."""
    lines = []
    ordered = sorted(rules.values(), key=lambda rule: (rule.family, rule.name))
    for family, members in groupby(ordered, key=lambda rule: rule.family):
        lines.append(f"{family}:")
        lines += [f"  {rule.name:26s} {rule.severity:8s} {summarize(rule)}" for rule in members]
    found = groups(rules)
    if found:
        lines.append("groups (one name for several rules):")
        lines += [f"  {name:26s} {', '.join(rule.name for rule in members)}" for name, members in found.items()]
    return "\n".join(lines)


def explain(name: str, rules: Mapping[str, Rule]) -> str:
    """The documentation of a rule or a group. Raises KeyError for a name that is neither; its text says what is."""
    members = groups(rules).get(name, [])
    others = [rule for rule in members if rule.name != name]
    listed = "\n".join(f"    {rule.name}: {summarize(rule)}" for rule in others)
    if name in rules:
        documentation = rules[name].documentation.rstrip()
        return f"{documentation}\n\nThe name also stands for\n{listed}" if others else documentation
    if others:
        return f"{name}: a group of rules.\n\nThe name stands for\n{listed}"
    close = get_close_matches(name, [*rules, *groups(rules)], 1)
    hint = f"did you mean `{close[0]}`?" if close else "`rosimpact explain` lists them"
    raise KeyError(f"no rule is called `{name}`; {hint}")
