"""Prints docs/rules.md, every rule with its severity and first line: `python docs/rules.py > docs/rules.md`."""

from __future__ import annotations

from itertools import groupby

from rosimpact.impact.rules.rule import Rule, group_rules, load_rules

FAMILIES = {
    "api": "What other packages and libraries offer, and used to offer.",
    "general": "The run itself.",
    "graph": "Topics, services, actions and parameters: who uses them, and what meets nobody.",
    "interfaces": "Messages, services and actions compared with a base; they speak with `--base` alone.",
    "logic": "When nodes publish, compared with a base; they speak with `--base` alone.",
    "packages": "What packages declare, find, build, install and export.",
    "qos": "Quality of service: publishers and subscribers that refuse each other.",
    "sources": "What source files include.",
    "values": "Values that publishers send and subscribers cannot handle; they run only where selected by name.",
    "versions": "Versions that are asked for, against those that a target has.",
}
HEAD = """\
# Rules

All rules with their usual severity; a single finding can have another one, as the rule's documentation says.
`rosimpact explain RULE` prints that documentation: what the rule reports, why it breaks, an example, what to use
instead, and what it does not report. The links lead to the same text, at the top of each rule.

[findings.md](findings.md) and [configuration.md](configuration.md) describe how to select rules and families, how to
suppress findings and how to change severities.
"""


GROUPS = """
## Groups

A group is the name of a rule that was split into several. In settings, comments and baselines it still stands for all
of its rules. The name of a rule is more specific than that of its group.

| group | rules |
|---|---|
"""


def page() -> str:
    """The text of docs/rules.md."""
    parts = [HEAD]
    for family, rules in groupby(sorted(load_rules().values(), key=lambda rule: rule.family), lambda rule: rule.family):
        parts.append(f"\n## {family}\n\n{FAMILIES[family]}\n\n| rule | severity | what it reports |\n|---|---|---|\n")
        parts += [row(rule) for rule in rules]
    parts.append(GROUPS)
    for name, members in group_rules(load_rules()).items():
        parts.append(f"| `{name}` | {', '.join(f'`{rule.name}`' for rule in members)} |\n")
    return "".join(parts)


def row(rule: Rule) -> str:
    """One line of a table. The rule's file is named as the rule is, with underscores."""
    path = f"../impact/rules/{rule.family}/{rule.name.replace('-', '_')}.py"
    severity = rule.severity + (", preview" if rule.preview else "")
    summary = rule.summary.rstrip(".").replace("|", "\\|")
    return f"| [`{rule.name}`]({path}) | {severity} | {summary} |\n"


if __name__ == "__main__":
    print(page(), end="")
