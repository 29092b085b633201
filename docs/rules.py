"""Prints docs/rules.md, every rule with its severity and first line: `python docs/rules.py > docs/rules.md`."""

from __future__ import annotations

from itertools import groupby

from rosimpact.impact.rules.rule import Rule, all_rules

FAMILIES = {
    "api": "What other packages and libraries offer, and used to offer.",
    "general": "The run itself.",
    "graph": "Topics, services, actions and parameters: who uses them, and what meets nobody.",
    "interfaces": "Messages, services and actions compared with a base; they speak with `--base` alone.",
    "logic": "When nodes publish, compared with a base; they speak with `--base` alone.",
    "packages": "What packages declare, find, build, install and export.",
    "qos": "Quality of service: publishers and subscribers that refuse each other.",
    "sources": "What source files include.",
    "versions": "Versions that are asked for, against those that a target has.",
}
HEAD = """\
# Rules

Every rule with its usual severity; a single finding may be graver or milder, as the rule's documentation says.
`rosimpact explain RULE` prints that documentation: what it reports, why it breaks, an example, what to use instead, and
what it leaves alone. The links lead to the same text, at the top of each rule.

How rules and whole families are chosen, silenced and given another severity is in [findings.md](findings.md) and
[configuration.md](configuration.md).
"""


def page() -> str:
    """The text of docs/rules.md."""
    parts = [HEAD]
    for family, rules in groupby(sorted(all_rules().values(), key=lambda rule: rule.family), lambda rule: rule.family):
        parts.append(f"\n## {family}\n\n{FAMILIES[family]}\n\n| rule | severity | what it reports |\n|---|---|---|\n")
        parts += [row(rule) for rule in rules]
    return "".join(parts)


def row(rule: Rule) -> str:
    """One line of a table. The rule's file is named as the rule is, with underscores."""
    path = f"../impact/rules/{rule.family}/{rule.name.replace('-', '_')}.py"
    severity = rule.severity + (", preview" if rule.preview else "")
    summary = rule.documentation.splitlines()[0].partition(": ")[2].rstrip(".").replace("|", "\\|")
    return f"| [`{rule.name}`]({path}) | {severity} | {summary} |\n"


if __name__ == "__main__":
    print(page(), end="")
