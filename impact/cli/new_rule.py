"""Lays out a rule: its module and its first file of cases, from templates which work and are to be edited."""

import re
from pathlib import Path

from ...edges import files
from ...edges.console import UserError

_NAME = re.compile(r"[a-z][a-z0-9]*(?:-[a-z0-9]+)*")

TEMPLATES = Path(__file__).with_name("templates")


def write_rule(root: Path, name: str, family: str) -> tuple[Path, Path]:
    """Writes a rule's module and its file of cases, and returns their paths. root: a checkout of rosimpact.

    Raises UserError for a name that no rule can have, an unknown family, a rule that exists, and a root that is no
    checkout.
    """
    rules, cases = root / "impact/rules", root / "tests/rules"
    if not rules.is_dir() or not cases.is_dir():
        raise UserError(f"{root}: not a checkout of rosimpact; run the command where impact/ and tests/ are")
    if not _NAME.fullmatch(name):
        example = name.lower().replace("_", "-").replace(" ", "-")
        example = example if _NAME.fullmatch(example) else "removed-header"
        raise UserError(f"{name}: not a rule name; write lower-case words joined by dashes, such as {example}")
    families = sorted(folder.parent.name for folder in rules.glob("*/__init__.py"))
    if family not in families:
        raise UserError(f"--family {family}: unknown; choose one of {', '.join(families)}")
    function = name.replace("-", "_")
    if known := [path for path in rules.glob(f"*/{function}.py")]:
        raise UserError(f"{known[0]}: exists; choose another name")
    module, first = rules / family / f"{function}.py", cases / family / f"{function}.md"
    for path, template in ((module, "rule.py.txt"), (first, "cases.md")):
        text = (TEMPLATES / template).read_text(encoding="utf-8")
        filled = text.format(name=name, function=function, subject="replace_me")
        files.write_file(path, filled.encode(), beneath=root, instead_of=None)
    return module, first
