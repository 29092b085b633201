"""Checks a workspace that is read and linked: runs the rules, merges what they yield, and makes the report."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ...edges.console import describe_unforeseen
from ...edges.version import __version__
from ..config import Config, PathSetting
from ..facts.extract import ExtractedFacts
from ..model.cmake.link_forms import find_link_form
from ..model.view import TargetView
from ..model.workspace import Workspace
from ..rules.fix_actions import Declare, FixAction, Insert, Replace
from ..rules.rule import Diagnostic, Finding, Rule, load_rules
from ..tree import Tree
from .cross_target_fix import Split, add_evidence
from .findings import (
    SettingsError,
    Suppression,
    apply_settings,
    mark_new,
    merge_diagnostics,
    read_baseline,
    sort_findings,
    split_by_baseline,
    suppress,
    verify_settings,
)
from .report import AnalysisCoverage, Checked, Report, ReportedPackage, ReportedTarget, SourceLines, report_target
from .run_rules import Crashes, run_rules
from .session import (
    OpenedWorkspace,
    Options,
    explain_nothing_analysed,
    make_reader,
    select_rules,
)

if TYPE_CHECKING:
    from ..model.install_space import InstallSpace
    from ..targets.machine.shared_libraries import SharedLibraries
    from .effects import Impact


def check_opened(
    path: str | os.PathLike[str],
    options: Options,
    opened: OpenedWorkspace,
    *,
    base_tree: Tree | None = None,
    started: float | None = None,
) -> Checked:
    """The check of a workspace that is read already. Raises as check() does.

    base_tree: as for check(). started: when the work began, by time.perf_counter(); now when None.
    """
    started = time.perf_counter() if started is None else started
    rules = load_rules()
    tree, store, extraction, workspace, targets, views, config, _, installed, shared_libraries = opened
    chosen = select_rules(options, config)
    settings = _collect_settings(rules, config)
    sources = SourceLines(make_reader(tree))
    crashed: Crashes = {}
    reached: Impact | None = None
    notes: list[str] = []
    if options.base or base_tree is not None:
        from . import revision_compare as bases

        if base_tree is None:
            base_tree, notes = bases.open_base_tree(tree, options.base)
        before = bases.open_base(base_tree, opened, jobs=options.jobs)
        if config.systems:
            from .systems import choose_systems

            notes += choose_systems(Path(path), config.systems, ((workspace, tree), (before.workspace, base_tree)))
        old = run_and_merge(before, chosen, settings, SourceLines(make_reader(base_tree)), crashed, jobs=options.jobs)
        now = run_and_merge(opened, chosen, settings, sources, crashed, before.workspace, options.jobs)
        found: Sequence[Finding] = mark_new(now.kept, old.kept)
        reached = _find_impact(workspace, before.workspace, crashed, options.jobs)
    else:
        now = run_and_merge(opened, chosen, settings, sources, crashed, jobs=options.jobs)
        found = now.kept
    if any(finding.evidence for finding in found):
        found, parted = add_evidence(found, views)
        if parted and "unguarded-split" in chosen:
            found = sort_findings([*found, *_find_splits(parted, opened, chosen, settings, sources)])
    originals: dict[str, bytes] = {}
    if any(finding.fix for finding in found):
        from . import fix

        found = fix.make_fixes(found, make_reader(tree), originals, getattr(tree, "submodules", ()))
    known: Sequence[Finding] = ()
    if options.baseline:
        found, known = split_by_baseline(found, read_baseline(options.baseline))
    notes += store.notes
    failures = [] if workspace.packages else [explain_nothing_analysed(path, opened)]
    for (rule, why), failed_on in crashed.items():
        failures.append(f"the rule {rule} failed{' on ' if failed_on else ''}{', '.join(failed_on)}: {why}")
    report = Report(
        version=__version__,
        data=targets[0].target.data_date if targets else "",
        targets=(
            *(report_target(chosen_target, notes if i == 0 else ()) for i, chosen_target in enumerate(targets)),
            *_list_file_only_targets({chosen_target.target.name for chosen_target in targets}, shared_libraries),
        ),
        findings=tuple(found),
        coverage=measure_coverage(workspace, extraction, views, installed),
        packages=tuple(ReportedPackage(package.name, package.path) for package in workspace),
        suppressed=tuple(now.suppressed),
        known=tuple(known),
        rules=lambda: tuple(chosen.values()),
        seconds=time.perf_counter() - started,
        excerpt=sources.read_excerpt,
        root=os.fspath(path),
        base=" ".join(options.base) or (base_tree.label if base_tree is not None else ""),
        failure="; ".join(failures),
        impact=reached,
    )
    return Checked(report, config, tree, originals)


def _find_splits(
    parted: Sequence[tuple[Finding, Split]],
    opened: OpenedWorkspace,
    rules: Mapping[str, Rule],
    settings: Sequence[PathSetting],
    sources: SourceLines,
) -> list[Finding]:
    """Findings of unguarded-split, which rest on findings of other rules; new where all of those are."""
    from ..rules.api.unguarded_split import list_splits

    found_splits = list_splits((finding, one.evidence, one.old_only, one.new_only) for finding, one in parted)
    found = merge_diagnostics(
        (("unguarded-split", target, one) for target, one in found_splits),
        targets=[view.target.name for view in opened.views],
        rules=rules,
        line_text=sources.read_line,
    )
    old = {finding.package for finding, _ in parted if not finding.new}
    marked = [finding._replace(new=finding.package not in old) for finding in found]
    allows = {path: comments for package in opened.workspace for path, comments in package.linked.allows}
    configured = apply_settings(marked, settings, rules)
    return suppress(configured, allows, rules=rules, ran=()).kept


def _find_impact(workspace: Workspace, base: Workspace, crashed: Crashes, jobs: int | None) -> Impact | None:
    """What the changes since the base reach; None where that failed, which is noted as a rule's failure is."""
    from .downstream import compute_impact, use_processes

    try:
        use_processes((workspace, base), jobs)
        return compute_impact(workspace, base)
    except Exception as error:
        crashed.setdefault(("impact", describe_unforeseen(error)), [])
        return None


def _list_file_only_targets(
    names: Container[str], shared_libraries: Iterable[SharedLibraries]
) -> Iterator[ReportedTarget]:
    """Machines that only built files are checked on: this one, where no target is it."""
    for libraries in shared_libraries:
        if libraries.target not in names:
            note = "only built files were checked on it"
            yield ReportedTarget(libraries.target, "", "", libraries.platform, "where --install lies", (note,))


def _collect_settings(rules: Mapping[str, Rule], config: Config) -> tuple[PathSetting, ...]:
    """Settings by path, those for the whole workspace first, so that the others go over them."""
    everywhere = (PathSetting("**", severity=config.severity),) if config.severity else ()
    try:
        verify_settings(everywhere, rules)
    except SettingsError as error:
        text = str(error).removeprefix('[paths."**"]: ')
        raise SettingsError(f"{config.path}: [check]: {text}") from None
    try:
        return (*everywhere, *verify_settings(config.paths, rules))
    except SettingsError as error:
        raise SettingsError(f"{config.path}: {error}") from None


def run_and_merge(
    opened: OpenedWorkspace,
    rules: Mapping[str, Rule],
    settings: Sequence[PathSetting],
    sources: SourceLines,
    crashed: Crashes,
    before: Workspace | None = None,
    jobs: int | None = None,
) -> Suppression:
    """Runs the rules. before: the workspace at the base, for rules that compare. crashed: gets the rules that
    failed; what the others found stands."""
    workspace, views = opened.workspace, opened.views
    names = [view.target.name for view in views]
    known = load_rules()
    by_name = {view.target.name: view for view in views}

    def merge(diagnostics: Iterable[tuple[str, str, Diagnostic]]) -> list[Finding]:
        found = merge_diagnostics(
            diagnostics,
            targets=names,
            rules=rules,
            line_text=sources.read_line,
            holds=lambda fix, target: all(is_right_on(action, by_name[target]) for action in fix),
        )
        return apply_settings(found, settings, known)

    allows = {path: comments for package in workspace for path, comments in package.linked.allows}
    result = suppress(
        merge(run_rules(opened, rules.values(), crashed, before, jobs)),
        allows,
        rules=known,
        ran=[name for name in rules if name != "unguarded-split"],  # it runs last, see _find_splits()
    )
    kept = list(result.kept)
    if "unused-suppression" in rules and result.unused:
        from ..rules.general.unused_suppression import find_unused

        kept = sort_findings(
            [*kept, *merge(("unused-suppression", "", hit) for hit in find_unused(workspace, result.unused))]
        )
    return result._replace(kept=kept)


def is_right_on(action: FixAction, view: TargetView) -> bool:
    """Whether an action of a fix is right on a target where the rule found nothing to fix.

    A declaration is when the package is there and its modules are for the target's Python, an include when its header
    surely is, what links when the packages have it for CMake; anything else cannot be known.
    """
    if isinstance(action, (Replace, Insert)) and action.needs:
        forms = ((find_link_form(view, package), item) for package, item in action.needs)
        return all(form is not None and item in form.items for form, item in forms)
    if isinstance(action, Declare):
        return view.is_available(action.name) and not view.is_for_other_python(action.name)
    if isinstance(action, Replace):
        return _has_header(view, action.new.strip('<>"'))
    if isinstance(action, Insert):
        text = action.text.strip()
        return text.startswith("#include <") and "\n" not in text and view.is_standard(text[10:].rstrip("> "))
    return False


def _has_header(view: TargetView, path: str) -> bool:
    if view.is_standard(path) or view.workspace.provides_header(path):
        return True
    released = (provider.name for provider in view.find_header(path) if provider.kind == "ros")
    if any(view.may_have_released_header(name, path) for name in released):
        return True
    return view.target.platform in view.providers.list_header_platforms(path)


def measure_coverage(
    workspace: Workspace, extraction: ExtractedFacts, views: Sequence[TargetView], installed: InstallSpace | None = None
) -> AnalysisCoverage:
    """How much was read and resolved."""
    broken = {path for package in workspace for path, _, _ in package.linked.problems}
    unresolved = {(each.kind, each.name) for view in views for each in view.unresolved}
    counts = dict(sorted(Counter(kind for kind, _ in unresolved).items()))
    cmake = sum(len(package.build.unresolved) for package in workspace)
    if cmake:
        counts["cmake"] = counts.get("cmake", 0) + cmake
    platforms = {view.target.platform for view in views if not view.target.knows_libraries}
    if platforms:
        counts["platform"] = len(platforms)
    receivers = sum(package.linked.unresolved_receivers for package in workspace)
    if receivers:
        counts["receiver"] = receivers
    # A file can be read and still have something wrong with it, such as its name.
    files = len(extraction.kinds.keys() | {problem.path for problem in extraction.problems})
    parsed = len(extraction.kinds) - len(broken & extraction.kinds.keys())
    if installed is not None:
        sound = sum(not binary.elf.problem for binary in installed.binaries)
        files, parsed = files + sound, parsed + sound
    return AnalysisCoverage(len(workspace.packages), files, parsed, counts)
