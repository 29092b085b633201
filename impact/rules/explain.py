"""The documentation of rules as `rosimpact explain` prints it."""

from collections.abc import Mapping
from difflib import get_close_matches
from itertools import groupby
from pathlib import Path

import msgspec

from .rule import Rule, group_rules, read_imprecise

PRECISION = Path(__file__).with_name("precision.json")


class BatchPrecision(msgspec.Struct, frozen=True):
    """How many findings of a rule were right in one batch. Readers judged them by the sources, before they changed the
    rule. repositories: how many the findings are in. right: includes those on targets or builds that are hardly used.
    badly_said: there is a fault, but the text misleads."""

    batch: str
    repositories: int
    findings: int
    right: int
    badly_said: int


def read_precision() -> dict[str, list[BatchPrecision]]:
    """How the findings of each rule were judged, batch by batch, from what `benchmarks/verdicts.py precision` wrote."""
    return msgspec.json.decode(PRECISION.read_bytes(), type=dict[str, list[BatchPrecision]])


def describe_precision(judged: list[BatchPrecision]) -> str:
    """The paragraph on how many findings of a rule were right."""
    if not judged:
        return "Precision at first sight\n    No finding of this rule was judged yet."
    lines = []
    for row in judged:
        rest = f", {row.badly_said} badly said" if row.badly_said else ""
        lines.append(
            f"    {row.batch}: {row.right} of {row.findings} findings right{rest} (repositories: {row.repositories})"
        )
    return "\n".join(("Precision at first sight", *lines))


def list_rules(rules: Mapping[str, Rule]) -> str:
    """All rules by family, and the groups."""
    lines = []
    for family, members in group_by_family(rules).items():
        lines.append(f"{family}:")
        lines += [f"  {rule.name:26s} {rule.severity:8s} {rule.summary}" for rule in members]
    found = group_rules(rules)
    if found:
        lines.append("groups (one name for several rules):")
        lines += [f"  {name:26s} {', '.join(rule.name for rule in members)}" for name, members in found.items()]
    return "\n".join(lines)


def group_by_family(rules: Mapping[str, Rule]) -> dict[str, list[Rule]]:
    """The rules of every family, by its name."""
    ordered = sorted(rules.values(), key=lambda rule: (rule.family, rule.name))
    return {family: list(members) for family, members in groupby(ordered, key=lambda rule: rule.family)}


def explain(name: str, rules: Mapping[str, Rule]) -> str:
    """The documentation of a rule, a group or a family. Raises KeyError for a name that is none; its text says what
    is."""
    families = group_by_family(rules)
    members = group_rules(rules).get(name, [])
    others = [rule for rule in members if rule.name != name]
    listed = "\n".join(f"    {rule.name}: {rule.summary}" for rule in others)
    if name in rules:
        own = read_precision().get(name, [])
        documentation = f"{rules[name].documentation.rstrip()}\n\n{describe_precision(own)}"
        if name in read_imprecise():
            right, of = read_imprecise()[name]
            documentation += f"\n    A preview: of its newest findings on heads, {right} of {of} were true."
        return f"{documentation}\n\nThe name also stands for\n{listed}" if others else documentation
    if others:
        return f"{name}: a group of rules.\n\nThe name stands for\n{listed}"
    if name in families:
        listed = "\n".join(f"    {rule.name}: {rule.summary}" for rule in families[name])
        return f"{name}: a family of rules.\n\nThe name stands for\n{listed}"
    close = get_close_matches(name, [*rules, *group_rules(rules), *families], 1)
    hint = f"did you mean `{close[0]}`?" if close else "`rosimpact explain` lists them"
    raise KeyError(f"no rule, group or family is called `{name}`; {hint}")
