"""Changes the code in small ways and counts which of the changes the tests notice.

usage: mutation.py [--rev REV ...] [--number 40] [--seed 1] [--skip 0] [--timeout 900] [FOLDER ...]

Of the given folders (impact/rules, impact/model and impact/facts without any) `number` places are drawn, in modules as
likely as they are long, and for each of them one of the changes that cosmic-ray's operators can make there (`pip
install cosmic-ray`). Each change is made in a copy of the tree; the tests that are about the changed module run until
one fails. `killed`: one failed; `timed out`: they did not end; `survived`: all passed. With several revisions the
changes are drawn from the first one and made in all of them, so that their tests can be compared; a file that a
revision does not have word for word is left out there.

Tests of a module: for a rule those of its cases, the cases of all rules, then the files below tests/rules that name
the rule; for another module the files of its room's tests that import it or lie in the folder of its name, then the
cases of all rules.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

ROOT = Path(__file__).parents[1]
FOLDERS = ("impact/rules", "impact/model", "impact/facts")
_ROOMS = ("impact", "corpus", "classifier", "edges", "databuild")
# `A | B` is a type in most places, and annotations are not evaluated.
_LEFT_OUT = re.compile("BitOr|RemoveDecorator|VariableInserter|VariableReplacer")


class Mutant(NamedTuple):
    """A change: path below the root, line, operator of cosmic-ray, and which of the places that it can change."""

    path: str
    line: int
    operator: str
    occurrence: int


def find_mutants(root: Path, path: str) -> dict[tuple[int, int], list[Mutant]]:
    """All changes that can be made to a module, by line and column. Annotations and what only type checkers run are
    left out."""
    source = (root / path).read_text(encoding="utf-8")
    nodes = list(ast_nodes(get_ast(source)))
    ignored = list(find_ignored(ast.parse(source)))
    found: dict[tuple[int, int], list[Mutant]] = {}
    for name in operator_names():
        if _LEFT_OUT.search(name):
            continue
        operator = get_operator(name)()
        places = [start for node in nodes for start, _ in operator.mutation_positions(node)]
        for occurrence, start in enumerate(places):
            if not any(first <= start < last for first, last in ignored):
                found.setdefault(start, []).append(Mutant(path, start[0], name, occurrence))
    return found


def find_ignored(module: ast.Module) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Ranges (line, column) of annotations and of blocks under TYPE_CHECKING."""
    for node in ast.walk(module):
        parts: list[ast.AST | None] = [getattr(node, "annotation", None), getattr(node, "returns", None)]
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
            parts.append(node)
        for part in parts:
            if isinstance(part, (ast.expr, ast.stmt)):
                yield (part.lineno, part.col_offset), (part.end_lineno or 0, part.end_col_offset or 0)


def draw_mutants(root: Path, folders: Iterable[str], number: int, seed: int) -> list[Mutant]:
    """A sample: modules as likely as they are long, in each of them a place, and there one of its changes."""
    lines = {
        file.relative_to(root).as_posix(): len(file.read_bytes().splitlines())
        for folder in folders
        for file in sorted((root / folder).rglob("*.py"))
    }
    chance = random.Random(seed)
    places: dict[str, list[list[Mutant]]] = {}
    drawn: list[Mutant] = []
    while len(drawn) < number and lines:
        path = chance.choices(list(lines), list(lines.values()))[0]
        if path not in places:
            places[path] = [mutants for _, mutants in sorted(find_mutants(root, path).items())]
        if not places[path]:
            del lines[path]
            continue
        drawn.append(chance.choice(places[path].pop(chance.randrange(len(places[path])))))
    return drawn


def choose_tests(root: Path, path: str) -> list[list[str]]:
    """Arguments of pytest for the tests of a module, those that fail soonest first."""
    module = path.removesuffix(".py").removesuffix("/__init__")
    room, *_, name = module.split("/")[1:]
    cases = ["tests/rules/test_rules.py"]
    if room == "rules" and module.count("/") == 3:
        pattern = re.compile(rf"\b{name}\b|\b{name.replace('_', '-')}\b")
        return [[*cases, "-k", name], [*cases, *find_tests(root / "tests/rules", pattern)]]
    dotted = module.replace("/", r"\.")
    parent, _, last = dotted.rpartition(r"\.")
    pattern = re.compile(rf"rosimpact\.(?:{dotted}\b|{parent} import (?:[\w, ]*\W)?{last}\b)")
    chosen = find_tests(root / "tests" / room, pattern)
    if module.count("/") > 2:
        chosen += [file for file in find_tests(root / "tests" / Path(*module.split("/")[1:-1])) if file not in chosen]
    return [[*chosen, *cases]]


def find_tests(folder: Path, pattern: re.Pattern[str] = re.compile("")) -> list[str]:
    """Files of tests, other than the cases of rules, whose text matches; small ones first."""
    files = [file for file in folder.rglob("test_*.py") if pattern.search(file.read_text(encoding="utf-8"))]
    files.sort(key=lambda file: (file.stat().st_size, file))
    return [str(file) for file in files if file.name != "test_rules.py"]


def run_tests(tree: Path, tests: Iterable[list[str]], packages: Path, timeout: float) -> str:
    """Runs tests until one fails, and returns `killed`, `timed out` or `survived`."""
    environment = {**os.environ, "PYTHONPATH": str(packages), "PYTHONDONTWRITEBYTECODE": "1"}
    end = time.monotonic() + timeout
    for arguments in tests:
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]
        command += ["-o", "addopts=", *arguments]
        process = subprocess.Popen(
            command, cwd=tree, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True,
        )  # fmt: skip
        try:
            status = process.wait(max(1.0, end - time.monotonic()))
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return "timed out"
        if status not in (0, 5):  # 5: no test has such a name
            return "killed"
    return "survived"


def make_tree(folder: Path, rev: str) -> tuple[Path, Path]:
    """A copy of the files of a revision; and a folder for PYTHONPATH in which `rosimpact` is this copy."""
    tree, packages = folder / "tree", folder / "packages"
    tree.mkdir(parents=True)
    archive = subprocess.Popen(["git", "-C", ROOT, "archive", rev], stdout=subprocess.PIPE)
    subprocess.run(["tar", "x", "-C", tree], stdin=archive.stdout, check=True)
    if archive.wait():
        raise SystemExit(f"{rev}: no such revision")
    (packages / "rosimpact").mkdir(parents=True)
    for room in _ROOMS:
        if (tree / room).exists():
            (packages / "rosimpact" / room).symlink_to(tree / room)
    return tree, packages


def try_mutant(mutant: Mutant, original: str, tree: Path, packages: Path, timeout: float) -> str:
    """Makes a change in a tree, runs the tests, and takes it back."""
    file = tree / mutant.path
    if not file.exists() or file.read_text(encoding="utf-8") != original:
        return "other text"
    changed = mutate_code(original, get_operator(mutant.operator)(), mutant.occurrence)
    if changed is None:
        return "no change"
    file.write_text(changed, encoding="utf-8")
    try:
        return run_tests(tree, choose_tests(tree, mutant.path), packages, timeout)
    finally:
        file.write_text(original, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", default=FOLDERS)
    parser.add_argument("--rev", action="append", default=[], help="a revision; HEAD without any")
    parser.add_argument("--number", type=int, default=40, help="how many changes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--skip", type=int, default=0, help="how many of them to leave out, the first ones")
    parser.add_argument("--timeout", type=float, default=900, help="seconds for the tests of one change")
    arguments = parser.parse_args()
    revisions = arguments.rev or ["HEAD"]
    with tempfile.TemporaryDirectory(prefix="mutation-") as scratch:
        trees = [make_tree(Path(scratch) / str(at), rev) for at, rev in enumerate(revisions)]
        counts: list[Counter[str]] = [Counter() for _ in revisions]
        mutants = draw_mutants(trees[0][0], arguments.folders, arguments.number, arguments.seed)
        for mutant in mutants[arguments.skip :]:
            original = (trees[0][0] / mutant.path).read_text(encoding="utf-8")
            outcomes = [try_mutant(mutant, original, *tree, arguments.timeout) for tree in trees]
            for count, outcome in zip(counts, outcomes, strict=True):
                count[outcome] += 1
            operator = mutant.operator.removeprefix("core/")
            print(f"{mutant.path}:{mutant.line} {operator} {mutant.occurrence}: {', '.join(outcomes)}", flush=True)
        for rev, count in zip(revisions, counts, strict=True):
            caught = count["killed"] + count["timed out"]
            tried = caught + count["survived"]
            told = ", ".join(f"{outcome} {number}" for outcome, number in sorted(count.items()))
            print(f"{rev}: {caught} of {tried} changes were noticed ({told})")


if __name__ == "__main__":
    main()
