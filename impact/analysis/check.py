"""The main job on one page: tree → facts → model → rules → report."""

import os
import time
from collections.abc import Sequence
from pathlib import Path

from ...edges import processes
from ..rules.rule import Finding, import_rules
from ..tree import Tree, WorkingTree
from . import report_cache
from .report import Checked, Report
from .session import DEFAULTS, CheckError, Options, Progress, link_workspace, read_workspace


def check(
    path: str | os.PathLike[str],
    options: Options = DEFAULTS,
    progress: Progress | None = None,
    *,
    tree: Tree | None = None,
    base_tree: Tree | None = None,
) -> Report:
    """Checks a workspace and says what breaks, and for whom.

    path: a workspace, package, or git repository. progress: called with (done, total) bytes while files are parsed.
    tree: what is read instead of what is at the path. base_tree: the tree to compare with, instead of the revision that
    the options name.
    Raises CheckError, TreeError, TargetError, SettingsError, SnapshotError or ConfigError with a text for the user.
    """
    return run(path, options, progress, tree=tree, base_tree=base_tree).report


def run(
    path: str | os.PathLike[str],
    options: Options = DEFAULTS,
    progress: Progress | None = None,
    *,
    tree: Tree | None = None,
    base_tree: Tree | None = None,
) -> Checked:
    """check(), with the configuration and the tree that it was made with. Raises as check() does."""
    started = time.perf_counter()
    compared = bool(options.base) or base_tree is not None
    with (
        processes.run_meanwhile(import_rules()),
        read_workspace(path, options, progress, report_cache.asks_flow, tree) as read,
    ):
        key = None if compared else report_cache.report_key(read, options)
        if key is not None and (known := report_cache.load_report(path, read, key, started)) is not None:
            return known
        from .check_opened import check_opened

        opened = link_workspace(read, path, options)
        checked = check_opened(path, options, opened, base_tree=base_tree, started=started)
        if key is not None and opened.workspace.whole and not checked.report.failure:
            report_cache.store_report(read, key, checked)
        return checked


def check_workspace(
    path: str | os.PathLike[str],
    *,
    targets: Sequence[str] = (),
    rev: str = "",
    base: Sequence[str] = (),
    select: Sequence[str] = (),
    ignore: Sequence[str] = (),
    preview: bool = False,
    jobs: int | None = None,
    config: str | os.PathLike[str] | None = None,
) -> list[Finding]:
    """Findings of a workspace, for other tools. They come sorted by path and line.

    path: the workspace. targets: as on the command line (`jazzy`, `humble@2024-03-01`, a captured file, a name of
    rosimpact.toml); none means those the workspace itself tells. rev: a git revision instead of the files on disk.
    base: what to compare with; findings that the base has too come with `new` False. select, ignore: rules or families.
    preview: also run rules whose precision is not measured yet. jobs: processes to parse with. config: another
    rosimpact.toml.
    Raises as check() does, and CheckError when there is no package to analyse.
    """
    options = Options(
        tuple(targets), rev, tuple(base), tuple(select), tuple(ignore), preview, jobs, Path(config) if config else None
    )
    report = check(path, options)
    if not report.packages:
        raise CheckError(report.failure)
    return list(report.findings)


def compare(path: str | os.PathLike[str], base: str | os.PathLike[str], options: Options | None = None) -> Report:
    """Checks the workspace at path against another folder as its base. For tools that keep both states as folders;
    `check` with Options(base=...) reads them from git. Raises as check() does."""
    return check(path, options or DEFAULTS, base_tree=WorkingTree(base))
