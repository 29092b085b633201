"""The main job on one page: tree → facts → model → rules → report."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from . import findings as after
from .config import Config, load
from .facts.store import Store
from .gather import Gathered, gather
from .model.view import View
from .model.watch import watched
from .model.workspace import Workspace, link
from .report.report import Coverage, Report, ReportedPackage, ReportedTarget, Sources
from .rules.rule import Finding, Hit, Rule, all_rules
from .targets.providers import default_providers
from .targets.resolve import ChosenTarget, choose_targets
from .tree import GitTree, Tree, TreeError, WorkingTree

__version__ = "0.1.0"


class CheckError(Exception):
    """The check cannot be run; the text names what is wrong and what to do."""


class Options(NamedTuple):
    """How to check. targets: as given on the command line. rev: a git revision instead of the files on disk. base: the
    revision to compare with, or PATH=REV pairs. baseline: text of a baseline file."""

    targets: tuple[str, ...] = ()
    rev: str = ""
    base: tuple[str, ...] = ()
    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    preview: bool = False
    jobs: int | None = None
    config: Path | None = None
    baseline: str = ""
    cache: Path | None = None


def check(
    path: str | os.PathLike[str], options: Options = Options(), progress: Callable[[int, int], None] | None = None, *,
    base_tree: Tree | None = None,
) -> Report:  # fmt: skip
    """Checks a workspace and says what breaks, and for whom.

    path: a workspace, package, or git repository. progress: called with (done, total) bytes while files are parsed.
    base_tree: the tree to compare with, instead of the revision that the options name.
    Raises CheckError, TreeError, TargetError or ConfigError with a text for the user.
    """
    started = time.perf_counter()
    with open_workspace(path, options, progress) as opened:
        tree, store, gathered, workspace, targets, views, config = opened
        rules = after.chosen(all_rules(), select=options.select or config.select, ignore=options.ignore or config.ignore,
                             preview=options.preview)  # fmt: skip
        sources = Sources(lambda p: tree.read(p) if tree.exists(p) else None)
        found, suppression = judge(workspace, views, rules, sources, config)
        if options.base or base_tree is not None:
            from .base import against_base, base_tree as tree_of_base

            found = against_base(base_tree or tree_of_base(tree, options.base), found, workspace, views, rules, store, sources,
                                 lambda w, v, s: judge(w, v, rules, s, config))  # fmt: skip
        known: Sequence[Finding] = ()
        if options.baseline:
            found, known = after.without_known(found, after.known_from(options.baseline))
        notes = tuple(store.notes)
    return Report(
        version=__version__,
        data=targets[0].target.data_date if targets else "",
        targets=tuple(
            ReportedTarget(t.target.name, t.target.distro, t.target.date, t.target.platform, t.reason, tuple(t.target.notes) + (notes if i == 0 else ()))
            for i, t in enumerate(targets)
        ),
        findings=tuple(found),
        coverage=coverage(workspace, gathered, views),
        packages=tuple(ReportedPackage(p.name, p.path) for p in workspace),
        suppressed=tuple(suppression),
        known=tuple(known),
        rules=tuple(rules.values()),
        seconds=time.perf_counter() - started,
        excerpt=sources.excerpt,
        root=str(path),
        base=" ".join(options.base),
        failure="" if workspace.packages else f"{path}: no package found (no package.xml outside ignored folders)",
    )


class Opened(NamedTuple):
    """A workspace ready to be asked: its files, facts, model, and how each target sees it."""

    tree: Tree
    store: Store
    gathered: Gathered
    workspace: Workspace
    targets: Sequence[ChosenTarget]
    views: Sequence[View]
    config: Config


@contextmanager
def open_workspace(
    path: str | os.PathLike[str], options: Options = Options(), progress: Callable[[int, int], None] | None = None
) -> Iterator[Opened]:
    """Reads a workspace up to its views. The store is closed at the end. Raises as check() does."""
    root = Path(path)
    if not root.exists():
        raise CheckError(f"{path}: there is no such file or folder; give the path of a workspace")
    config = load(root if root.is_dir() else root.parent, options.config)
    tree = open_tree(root, options.rev)
    with Store(options.cache) as store:
        gathered = gather(tree, store, jobs=options.jobs, progress=progress)
        workspace = link(tree, gathered, store, None, watched())
        targets = choose_targets(options.targets, config, workspace, tree)
        views = [View(workspace, t.target, default_providers(), config) for t in targets]
        yield Opened(tree, store, gathered, workspace, targets, views, config)


def open_tree(root: Path, rev: str) -> Tree:
    """The files on disk, or a revision of the repository when one is asked for or the path is a bare repository."""
    if rev:
        return GitTree(root, rev)
    if root.is_dir() and (root / "objects").is_dir() and (root / "HEAD").is_file():
        return GitTree(root, "HEAD")
    if not root.is_dir():
        raise TreeError(f"{root}: not a folder; give the path of a workspace")
    return WorkingTree(root)


def judge(
    workspace: Workspace, views: Sequence[View], rules: dict[str, Rule], sources: Sources, config: Config
) -> tuple[list[Finding], list[Finding]]:
    """Runs the rules. Returns the findings, and those that allow comments silence."""
    names = [view.target.name for view in views]
    found = after.merge(_hits(workspace, views, rules.values()), targets=names, rules=rules, line_text=sources.line)
    families = {name: rule.family for name, rule in all_rules().items()}
    found = after.with_settings(found, config.paths, families)
    allows = {path: comments for package in workspace for path, comments in package.digest.allows}
    result = after.suppressed(found, allows, families=families, ran=rules)
    kept = list(result.kept)
    if "unused-suppression" in rules and result.unused:
        from .rules.general.unused_suppression import unused

        hits = [("unused-suppression", "", hit) for hit in unused(workspace, result.unused)]
        kept += after.merge(hits, targets=names, rules=rules, line_text=sources.line)
    return kept, list(result.suppressed)


def _hits(workspace: Workspace, views: Sequence[View], rules: Iterable[Rule]) -> Iterable[tuple[str, str, Hit]]:
    for rule in rules:
        if rule.family == "interfaces" or rule.name == "unused-suppression":
            continue
        if not rule.per_target:
            for hit in rule.run(workspace):
                yield rule.name, "", hit
            continue
        for view in views:
            for hit in rule.run(view):
                yield rule.name, view.target.name, hit


def coverage(workspace: Workspace, gathered: Gathered, views: Sequence[View]) -> Coverage:
    """How much was read and resolved."""
    broken = {path for package in workspace for path, _, _ in package.digest.problems}
    unresolved: dict[str, set[str]] = {}
    for view in views:
        for kind, names in view.unresolved.items():
            unresolved.setdefault(kind, set()).update(names)
    counts = {kind: len(names) for kind, names in sorted(unresolved.items()) if names}
    cmake = sum(len(p.build.unresolved) for p in workspace)
    if cmake:
        counts["cmake"] = counts.get("cmake", 0) + cmake
    files = len(gathered.kinds) + len(gathered.problems)
    return Coverage(len(workspace.packages), files, len(gathered.kinds) - len(broken & gathered.kinds.keys()), counts)


def check_workspace(path: str | os.PathLike[str], *, targets: Sequence[str] = (), **options) -> list[Finding]:
    """Findings of a workspace, most useful for other tools.

    path: the workspace. targets: as on the command line (`jazzy`, `humble@2024-03-01`, a captured file, a name of
    rosimpact.toml). options: fields of Options. Raises as check() does.
    """
    return list(check(path, Options(targets=tuple(targets), **options)).findings)
