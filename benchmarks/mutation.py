"""Changes the code in small ways and counts which of the changes the tests notice.

usage: mutation.py --results FILE [--rev HEAD] [--number 200] [--first N] [--seed 1] [--jobs 2] [--budget 20]
                   [FOLDER ...]

Of the given folders (impact/rules, impact/model and impact/facts without any) `number` places are drawn, in modules as
likely as they are long, and for each of them one of the changes that cosmic-ray's operators can make there (`pip
install cosmic-ray`; the tests need pytest-xdist).

The whole suite runs once, in a copy of the tree in which the statement of each place records which test executes it
(FILE.reached.json keeps the sample and that). Then each change is made in a copy of the tree, and tests run until one
fails:

1. those that execute its statement, and those with the same parameters in the same file, which may use what the
   former have made; for a place that is executed on import, those that call a function of its module
2. the other tests of these files; for a place that is executed on import, of the files that import its module

each of them the shortest first, as many as the budget (seconds of processor time; a quarter of it for the second group)
allows. They may take longer than in the whole suite, where others have filled caches before: after twice the budget no
further one begins. A test that fails without the change too does not count. Outcomes, a line of FILE each:

    killed        a test failed
    timed out     the tests took far more processor time than without the change
    survived      all tests passed; `first N of M tests` if the budget did not allow all of them
    not reached   no test executes the statement

A run that was stopped continues where FILE ends; the first N changes of a sample are a sample too (--first). To compare
two revisions, draw a sample of each (--rev, with a FILE of its own) and see whether the intervals of their shares of
noticed changes overlap. PYTEST_ADDOPTS can leave out tests, for both alike.
"""

from __future__ import annotations

import argparse
import ast
import itertools
import json
import math
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[1]
FOLDERS = ("impact/rules", "impact/model", "impact/facts")
_ROOMS = ("impact", "corpus", "classifier", "edges", "databuild")
# `A | B` is a type in most places, and annotations are not evaluated.
_LEFT_OUT = re.compile("BitOr|RemoveDecorator|VariableInserter|VariableReplacer")
_MEMORY = 8 << 30
_LONGEST = 1200  # seconds on the clock, for tests that wait for something that does not come

Place = tuple[int, int]


class Mutant(NamedTuple):
    """A change: path below the root, line and column, operator of cosmic-ray, and which of the places that it can
    change."""

    path: str
    line: int
    column: int
    operator: str
    occurrence: int

    def __str__(self) -> str:
        return f"{self.path}:{self.line}:{self.column} {self.operator.removeprefix('core/')} {self.occurrence}"

    def change(self, source: str) -> str | None:
        """The source with this change; None if that is no Python."""
        from cosmic_ray.mutating import mutate_code
        from cosmic_ray.plugins import get_operator

        changed = mutate_code(source, get_operator(self.operator)(), self.occurrence)
        try:
            compile(changed or "", self.path, "exec")
        except SyntaxError:
            return None
        return changed


class Sample(NamedTuple):
    """Mutants, and what a run of the whole suite records. seconds: processor time of each test that passes. tests: by
    the number of a mutant the tests that execute its place, for a place that is executed on import those that call a
    function of its module; "" among them if it was executed outside of tests. on_import: the numbers of the latter
    mutants."""

    mutants: list[Mutant]
    seconds: dict[str, float]
    tests: dict[int, list[str]]
    on_import: list[int]


class Tree(NamedTuple):
    """A copy of the files of a revision; and a folder for PYTHONPATH in which `rosimpact` is this copy."""

    files: Path
    packages: Path


# Drawing


def find_mutants(root: Path, path: str) -> dict[Place, list[Mutant]]:
    """All changes that can be made to a module, by line and column. Annotations and what only type checkers run are
    left out."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    source = (root / path).read_text(encoding="utf-8")
    nodes = list(ast_nodes(get_ast(source)))
    ignored = list(find_ignored(ast.parse(source)))
    found: dict[Place, list[Mutant]] = {}
    for name in sorted(operator_names()):
        if _LEFT_OUT.search(name):
            continue
        operator = get_operator(name)()
        places = [start for node in nodes for start, _ in operator.mutation_positions(node)]
        for occurrence, start in enumerate(places):
            if not any(first <= start < last for first, last in ignored):
                found.setdefault(start, []).append(Mutant(path, start[0], start[1], name, occurrence))
    return found


def find_ignored(module: ast.Module) -> Iterator[tuple[Place, Place]]:
    """Ranges of annotations and of blocks under TYPE_CHECKING."""
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
        mutant = chance.choice(places[path].pop(chance.randrange(len(places[path]))))
        if mutant.change((root / path).read_text(encoding="utf-8")) is not None:
            drawn.append(mutant)
    return drawn


# Which tests execute a place

_RECORD = '''
def _record_(*numbers, _seen=["", set()]):
    import os
    test = os.environ.get("PYTEST_CURRENT_TEST", "")
    if test != _seen[0]:
        _seen[:] = test, set()
    if numbers not in _seen[1]:
        _seen[1].add(numbers)
        try:
            file = os.open(FOLDER + str(os.getpid()), os.O_WRONLY | os.O_APPEND | os.O_CREAT)
            os.write(file, (" ".join(map(str, numbers)) + "\\t" + test + "\\n").encode())
            os.close(file)
        except OSError:
            pass
'''


def find_statement(module: ast.Module, place: Place) -> ast.stmt | None:
    """The innermost statement at a place; None if it is executed on import."""

    def walk(node: ast.AST, inside: bool) -> Iterator[tuple[ast.stmt, bool]]:
        inside |= isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.stmt):
                yield child, inside
            yield from walk(child, inside)

    found: ast.stmt | None = None
    for node, inside in walk(module, False):
        first = min((part.lineno for part in getattr(node, "decorator_list", [])), default=node.lineno)
        if (first, 0 if first < node.lineno else node.col_offset) <= place < (node.end_lineno, node.end_col_offset):
            found = node if inside else None
    return found


class ProbeInserter(ast.NodeTransformer):
    """Puts calls that record the given numbers before statements, and into all functions the numbers of `on_import`."""

    def __init__(self, before: Mapping[ast.stmt, list[int]], on_import: Sequence[int]) -> None:
        self.before = before
        self.on_import = on_import

    def visit(self, node: ast.AST) -> Any:
        self.generic_visit(node)
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and self.on_import:
            node.body.insert(int(ast.get_docstring(node) is not None), make_probe(self.on_import))
        if isinstance(node, ast.stmt) and node in self.before:
            return [make_probe(self.before[node]), node]
        return node


def make_probe(numbers: Iterable[int]) -> ast.stmt:
    return ast.parse(f"_record_({', '.join(map(str, numbers))})").body[0]


def insert_probes(source: str, mutants: Mapping[int, Mutant], folder: Path) -> tuple[str, list[int]]:
    """A module that records in a folder which of the mutants' places are executed; and the numbers of those that are
    executed on import."""
    module = ast.parse(source)
    before: dict[ast.stmt, list[int]] = defaultdict(list)
    on_import: list[int] = []
    for number, mutant in mutants.items():
        statement = find_statement(module, (mutant.line, mutant.column))
        (on_import if statement is None else before[statement]).append(number)
    ProbeInserter(before, on_import).visit(module)
    start = int(ast.get_docstring(module) is not None)
    while isinstance(first := module.body[start], ast.ImportFrom) and first.module == "__future__":
        start += 1
    module.body[start:start] = ast.parse(_RECORD.replace("FOLDER", repr(f"{folder}/"))).body
    return ast.unparse(ast.fix_missing_locations(module)), on_import


def record_reached(rev: str, mutants: list[Mutant], scratch: Path, jobs: int) -> Sample:
    """Runs the whole suite of a revision with a probe at each mutant's place."""
    tree = make_tree(scratch / "probes", rev)
    probes, finished = scratch / "reached", scratch / "finished"
    probes.mkdir()
    by_path: dict[str, dict[int, Mutant]] = defaultdict(dict)
    for number, mutant in enumerate(mutants):
        by_path[mutant.path][number] = mutant
    on_import: list[int] = []
    for path, numbered in by_path.items():
        file = tree.files / path
        changed, numbers = insert_probes(file.read_text(encoding="utf-8"), numbered, probes)
        file.write_text(changed, encoding="utf-8")
        on_import += numbers
    command = [*_PYTEST, "-n", str(jobs), "--dist=loadfile", f"--basetemp={scratch}/temporary"]
    with open(scratch / "suite.log", "wb") as log:
        subprocess.run(command, cwd=tree.files, env=_environment(tree, finished), stdout=log, stderr=log, check=False)
    seconds = {test: taken for test, taken, passed in _read_finished(finished) if passed}
    tests: dict[int, dict[str, None]] = defaultdict(dict)
    for file in sorted(probes.iterdir()):
        for line in file.read_text(encoding="utf-8").splitlines():
            numbers, _, test = line.partition("\t")
            name, _, phase = test.rpartition(" ")
            # What a fixture makes may serve all tests of its file.
            names = [other for other in seconds if _file(other) == _file(name)] if phase == "(setup)" else [name]
            for number in map(int, numbers.split()):
                tests[number].update(dict.fromkeys(each for each in names if not each or each in seconds))
    return Sample(mutants, seconds, {number: sorted(found) for number, found in tests.items()}, on_import)


# Running tests

_PYTEST = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "mutation", "--hypothesis-seed=1"]
_PYTEST += ["-o", "addopts="]


def _environment(tree: Tree, finished: Path, chosen: Path | None = None, longest: float = math.inf) -> dict[str, str]:
    """For pytest with this module as its plugin."""
    return {
        **os.environ,
        "PYTHONPATH": str(tree.packages),
        "MUTATION_FINISHED": str(finished),
        "MUTATION_CHOSEN": str(chosen or ""),
        "MUTATION_LONGEST": str(longest),
    }


def pytest_collection_modifyitems(items: list[Any]) -> None:
    """Leaves the chosen tests, in their order."""
    if chosen := os.environ["MUTATION_CHOSEN"]:
        order = {test: at for at, test in enumerate(json.loads(Path(chosen).read_text(encoding="utf-8")))}
        items[:] = sorted((item for item in items if item.nodeid in order), key=lambda item: order[item.nodeid])


_started = 0.0
_taken = 0.0
_failed: set[str] = set()


def pytest_runtest_logstart() -> None:
    global _started
    _started = sum(os.times()[:4])


def pytest_runtest_makereport(item: Any, call: Any) -> None:
    """Records a test with its processor time and whether it passed."""
    skipped = call.excinfo is not None and call.excinfo.typename in ("Skipped", "XFailed")
    if call.excinfo is not None and not skipped:
        _failed.add(item.nodeid)
    if call.when == "teardown":
        global _taken
        taken = sum(os.times()[:4]) - _started
        _taken += taken
        if _taken > float(os.environ["MUTATION_LONGEST"]):
            item.session.shouldstop = "the tests have had their time"
        line = json.dumps([item.nodeid, round(taken, 3), item.nodeid not in _failed])
        with open(os.environ["MUTATION_FINISHED"], "a", encoding="utf-8") as file:
            file.write(line + "\n")


def _read_finished(file: Path) -> list[tuple[str, float, bool]]:
    return [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()] if file.exists() else []


def _file(test: str) -> str:
    return test.partition("::")[0]


def _parameters(test: str) -> str:
    return test.partition("[")[2]


class Outcome(NamedTuple):
    """status: `passed`, `failed` or `timed out`. run: how many tests were run. failed: those that failed; none if no
    test could start."""

    status: str
    run: int = 0
    failed: Sequence[str] = ()


def run_tests(tree: Tree, tests: Sequence[str], longest: float, *options: str) -> Outcome:
    """Runs tests with options of pytest. longest: after how many seconds of processor time no further one begins."""
    scratch = tree.files.parent
    chosen, finished, temporary = (scratch / name for name in ("chosen.json", "finished", "temporary"))
    chosen.write_text(json.dumps(tests), encoding="utf-8")
    finished.unlink(missing_ok=True)
    allowed = int(120 + 2 * min(longest, 300))

    def set_limits() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (allowed, allowed))
        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))

    command = [*_PYTEST, *options, "-p", "no:xdist", f"--basetemp={temporary}", *dict.fromkeys(map(_file, tests))]
    process = subprocess.Popen(
        command, cwd=tree.files, env=_environment(tree, finished, chosen, longest), stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=set_limits,
    )  # fmt: skip
    try:
        status = process.wait(_LONGEST)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return Outcome("timed out")
    finally:
        shutil.rmtree(tree.files / ".hypothesis", ignore_errors=True)
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        return Outcome("timed out")
    run = _read_finished(finished)
    failed = [test for test, _, passed in run if not passed]
    stopped = status == 2 and run and not failed
    return Outcome("passed" if status in (0, 5) or stopped else "failed", len(run), failed)  # 5: no tests


def choose_tests(root: Path, sample: Sample, number: int) -> tuple[list[str], list[str]]:
    """Tests that may notice a mutant: those that execute it or are like them, and others. The shortest first."""
    found = set(sample.tests.get(number, ()))
    files = {_file(test) for test in found}
    if number in sample.on_import or found == {""}:
        files |= find_importing(root, sample.mutants[number].path)
    alike = {(_file(test), _parameters(test)) for test in found if _parameters(test)}
    ranked = [
        (test not in found and (_file(test), _parameters(test)) not in alike, seconds, test)
        for test, seconds in sample.seconds.items()
        if _file(test) in files
    ]
    ranked.sort()
    return [test for other, _, test in ranked if not other], [test for other, _, test in ranked if other]


def find_importing(root: Path, path: str) -> set[str]:
    """Files of tests that import a module or lie in a folder of its name; for a rule those that name it."""
    module = path.removesuffix(".py").removesuffix("/__init__")
    room, *_, name = module.split("/")[1:]
    if room == "rules" and module.count("/") == 3:
        pattern = re.compile(rf"\b{name}\b|\b{name.replace('_', '-')}\b")
    else:
        dotted = module.replace("/", r"\.")
        parent, _, last = dotted.rpartition(r"\.")
        pattern = re.compile(rf"rosimpact\.(?:{dotted}\b|{parent} import (?:[\w, ]*\W)?{last}\b)")
    files = {file for file in root.glob("tests/**/test_*.py") if pattern.search(file.read_text(encoding="utf-8"))}
    files.update((root / "tests" / Path(*module.split("/")[1:-1])).rglob("test_*.py") if module.count("/") > 2 else ())
    return {file.relative_to(root).as_posix() for file in files} | {"tests/rules/test_rules.py"}


def take_affordable(tests: Sequence[str], seconds: Mapping[str, float], budget: float) -> list[str]:
    """The first tests that take no more than the budget together, at least one."""
    taken = itertools.accumulate(seconds[test] for test in tests)
    return [test for at, (test, so_far) in enumerate(zip(tests, taken, strict=True)) if so_far <= budget or not at]


def order_tests(tests: Iterable[str], seconds: Mapping[str, float]) -> list[str]:
    """Those of a file in a row; quick files and quick tests first."""
    by_file: dict[str, list[str]] = defaultdict(list)
    for test in tests:
        by_file[_file(test)].append(test)
    rows = sorted(by_file.values(), key=lambda row: sum(seconds[test] for test in row))
    return [test for row in rows for test in sorted(row, key=lambda test: seconds[test])]


def try_mutant(sample: Sample, number: int, tree: Tree, budget: float, unsound: Collection[str]) -> str:
    """Makes a change in a tree, runs the tests that the budget allows, takes the change back, and tells the outcome.
    unsound: tests that fail without a change."""
    mutant, seconds = sample.mutants[number], sample.seconds
    groups = [[test for test in group if test not in unsound] for group in choose_tests(tree.files, sample, number)]
    parts = zip(groups, (budget, budget / 4), strict=True)
    chosen = [test for group, part in parts for test in order_tests(take_affordable(group, seconds, part), seconds)]
    if not chosen:
        return "not reached"
    file = tree.files / mutant.path
    original, status = file.read_text(encoding="utf-8"), file.stat()
    try:
        file.write_text(mutant.change(original) or "", encoding="utf-8")
        outcome = run_tests(tree, chosen, 2 * budget, "-x")
    finally:
        file.write_text(original, encoding="utf-8")
        os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns))  # its compiled form is valid again
    if outcome.status == "failed":
        return f"killed ({outcome.failed[0]})" if outcome.failed else f"killed (before {chosen[0]})"
    if outcome.status == "timed out":
        return outcome.status
    known = sum(map(len, groups))
    return f"survived ({f'first {outcome.run} of ' if outcome.run < known else ''}{known} tests)"


# The whole


def make_tree(folder: Path, rev: str) -> Tree:
    """A copy of the files of a revision."""
    tree = Tree(folder / "tree", folder / "packages")
    tree.files.mkdir(parents=True)
    archive = subprocess.Popen(["git", "-C", ROOT, "archive", rev], stdout=subprocess.PIPE)
    subprocess.run(["tar", "x", "-C", tree.files], stdin=archive.stdout, check=True)
    if archive.wait():
        raise SystemExit(f"{rev}: no such revision")
    (tree.packages / "rosimpact").mkdir(parents=True)
    shutil.copy(__file__, tree.packages / "mutation.py")
    for room in _ROOMS:
        if (tree.files / room).exists():
            (tree.packages / "rosimpact" / room).symlink_to(tree.files / room)
    return tree


def compute_interval(noticed: int, tried: int) -> tuple[float, float]:
    """Wilson's interval of 95 % for a share."""
    z = 1.96
    middle = (noticed + z * z / 2) / (tried + z * z)
    half = z / (tried + z * z) * math.sqrt(noticed * (tried - noticed) / tried + z * z / 4)
    return middle - half, middle + half


def read_results(file: Path) -> dict[int, str]:
    """Outcomes that were found already, by the numbers of their mutants."""
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    return {int(line.split("\t")[0]): line.split("\t")[2] for line in lines}


def find_killers(outcome: str) -> set[str]:
    """The test, if any, that failed or could not start."""
    found = re.match(r"killed \((?:before )?(.*)\)$", outcome)
    return {found[1]} if found else set()


def find_unsound(tree: Tree, outcomes: Mapping[int, str], seconds: Mapping[str, float]) -> set[str]:
    """The tests among those that noticed changes that fail in a tree without a change."""
    killers = order_tests(set[str]().union(*map(find_killers, outcomes.values())), seconds)
    outcome = run_tests(tree, killers, math.inf) if killers else Outcome("passed")
    if outcome.status != "passed" and not outcome.failed:
        raise SystemExit(f"{tree.files}: tests do not run without a change either")
    return set(outcome.failed)


def drop_results(file: Path, tests: set[str]) -> None:
    """Forgets the changes that were noticed by tests that are not sound."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    file.write_text("".join(line for line in lines if not find_killers(line.split("\t")[2]) & tests), encoding="utf-8")


def summarize(rev: str, outcomes: Collection[str]) -> str:
    counts = Counter(re.match(r"[a-z ]*[a-z]", outcome)[0] for outcome in outcomes)  # type: ignore[index]
    noticed, tried = counts["killed"] + counts["timed out"], len(outcomes)
    low, high = compute_interval(noticed, tried)
    told = ", ".join(f"{outcome} {count}" for outcome, count in sorted(counts.items()))
    return f"{rev}: {noticed} of {tried} changes were noticed, {noticed / tried:.0%} ({low:.0%} to {high:.0%}; {told})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", default=FOLDERS)
    parser.add_argument("--results", type=Path, required=True, help="where outcomes are appended")
    parser.add_argument("--rev", default="HEAD")
    parser.add_argument("--number", type=int, default=200, help="how many changes are drawn")
    parser.add_argument("--first", type=int, help="how many of them to try; all without it")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2, help="how many to try at a time")
    parser.add_argument("--budget", type=float, default=20, help="seconds for the tests of one change")
    arguments = parser.parse_args()
    results: Path = arguments.results
    rev = subprocess.check_output(["git", "-C", ROOT, "rev-parse", arguments.rev], text=True).strip()
    with tempfile.TemporaryDirectory(prefix="mutation-", ignore_cleanup_errors=True) as folder:
        scratch = Path(folder)
        trees: SimpleQueue[Tree] = SimpleQueue()
        first, *others = (make_tree(scratch / str(at), rev) for at in range(arguments.jobs))
        for tree in (first, *others):
            trees.put(tree)
        kept = results.with_name(results.name + ".reached.json")
        if not kept.exists():
            mutants = draw_mutants(first.files, arguments.folders, arguments.number, arguments.seed)
            kept.write_text(json.dumps(record_reached(rev, mutants, scratch, arguments.jobs)), encoding="utf-8")
        mutants, seconds, tests, on_import = json.loads(kept.read_text(encoding="utf-8"))
        mutants = [Mutant(*fields) for fields in mutants]
        sample = Sample(mutants, seconds, {int(number): found for number, found in tests.items()}, on_import)
        asked = range(len(mutants))[: arguments.first]
        unsound: set[str] = set()

        def try_numbered(number: int) -> None:
            tree, start = trees.get(), time.monotonic()
            try:
                outcome = try_mutant(sample, number, tree, arguments.budget, unsound)
            finally:
                trees.put(tree)
            line = f"{number}\t{mutants[number]}\t{outcome}\t{time.monotonic() - start:.0f} s"
            with open(results, "a", encoding="utf-8") as file:
                file.write(line + "\n")
            print(line, flush=True)

        while True:
            done = read_results(results)
            with ThreadPoolExecutor(arguments.jobs) as pool:
                list(pool.map(try_numbered, [number for number in asked if number not in done]))
            failing = find_unsound(first, read_results(results), seconds)
            if not failing:
                break
            unsound |= failing
            drop_results(results, failing)
    done = read_results(results)
    print(summarize(rev, [done[number] for number in asked]))


if __name__ == "__main__":
    main()
