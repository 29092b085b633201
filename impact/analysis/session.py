"""A workspace opened: its tree, facts, model and targets, ready for the rules and for whatever else is asked of it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ...edges.console import UserError
from ...edges.limits import get_limits
from ..config import Config, ConfigError, load, parse
from ..facts.extract import ExtractedFacts, extract_all
from ..facts.store import Store
from ..model.discovery import Discovered, detect_generation, discover, list_versions
from ..targets.resolve import Chosen, choose_targets
from ..tree import LEAVES, GitTree, PathProblem, Tree, TreeError, WorkingTree, shown
from ..tree.ignore import Index, find_enclosing_repository
from ..tree.paths import is_within

if TYPE_CHECKING:
    from ..model.install_space import InstallSpace
    from ..model.package import Watched
    from ..model.view import TargetView
    from ..model.workspace import Workspace
    from ..rules.rule import Rule
    from ..targets.asked_versions import AskedVersions
    from ..targets.machine.shared_libraries import SharedLibraries


class CheckError(UserError):
    """The check cannot be run; the text names what is wrong and what to do."""


class Options(NamedTuple):
    """How to check.

    targets: as given on the command line. rev: a git revision instead of the files on disk. base: the revision to
    compare with, PATH=REV pairs, or a pinned .repos file. select, ignore: rules or families, over those of the
    configuration. config: another rosimpact.toml. baseline: text of a baseline file. cache: folder of the facts.
    install: an install space whose built files are checked too. follow_links: also read what links lead to that leave
    the workspace.
    """

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
    install: Path | None = None
    follow_links: bool = False


DEFAULTS = Options()
Progress = Callable[[int, int], None]


class OpenedWorkspace(NamedTuple):
    """A workspace ready to be asked: its files, facts, model, and how each target sees it; the versions of other
    packages that uses of them may be wrong in; what is installed of it, and what there is to run that with."""

    tree: Tree
    store: Store
    extraction: ExtractedFacts
    workspace: Workspace
    targets: Sequence[Chosen]
    views: Sequence[TargetView]
    config: Config
    asked: AskedVersions
    installed: InstallSpace | None = None
    shared_libraries: Sequence[SharedLibraries] = ()

    def split_by_target(self) -> Iterator[OpenedWorkspace]:
        """The same workspace on each of its targets alone."""
        for chosen, view in zip(self.targets, self.views, strict=True):
            yield self._replace(targets=[chosen], views=[view])


class Read(NamedTuple):
    """A workspace whose files are read: its facts, where its packages are, and the targets that it is asked about. ros:
    its generation. tracked_names: gives the names that rules look out for, worked out when first asked for."""

    tree: Tree
    store: Store
    extraction: ExtractedFacts
    discovered: Discovered
    ros: int
    targets: Sequence[Chosen]
    config: Config
    tracked_names: Callable[[], Watched]


@contextmanager
def open_workspace(
    path: str | os.PathLike[str],
    options: Options = DEFAULTS,
    progress: Progress | None = None,
    chosen: Callable[[Config], Mapping[str, Rule]] | None = None,
    tree: Tree | None = None,
) -> Iterator[OpenedWorkspace]:
    """Reads a workspace up to its views. The store is closed at the end. Raises as check() does.

    chosen: gives the rules that will be asked, so that all facts they need are made in one pass. tree: what is read
    instead of what is at the path.
    """

    def asks_flow(config: Config, store: Store, options: Options) -> bool:
        return chosen is not None and any(rule.reads_flow for rule in chosen(config).values())

    with read_workspace(path, options, progress, asks_flow, tree) as read:
        yield link_workspace(read, path, options)


@contextmanager
def read_workspace(
    path: str | os.PathLike[str],
    options: Options,
    progress: Progress | None,
    asks_flow: Callable[[Config, Store, Options], bool],
    tree: Tree | None = None,
) -> Iterator[Read]:
    """Reads the files of a workspace, without linking what they say. The store is closed at the end. Raises as check()
    does.

    asks_flow: whether facts of the message flow will be needed. tree: as for open_workspace().
    """
    root = Path(path)
    if tree is None:
        tree = open_tree(root, options.rev, follow_links=options.follow_links)
    config = load_settings(root, tree, options.config, follow_links=options.follow_links)
    with Store(options.cache) as store:

        @cache
        def load_names() -> Watched:
            from .result_cache import load_tracked_names

            return load_tracked_names(store)

        second = None
        if asks_flow(config, store, options):
            from ..model.flow.file_selection import make_code_selector

            second = make_code_selector(tree)
        extraction = extract_all(
            tree,
            store,
            jobs=options.jobs,
            progress=progress,
            second=second,
            along=lambda: load_names().make_searches(),
        )
        discovered = discover(tree, extraction)
        ros = detect_generation(discovered, extraction)
        packages = list_versions(discovered, extraction)
        versions = [(package.name, package.version) for package in packages]
        targets = [
            Chosen(target.follow_release(versions), reason)
            for target, reason in choose_targets(options.targets, config, ros, tree, packages=packages)
        ]
        yield Read(tree, store, extraction, discovered, ros, targets, config, load_names)


def link_workspace(read: Read, path: str | os.PathLike[str], options: Options) -> OpenedWorkspace:
    """A workspace that is read, linked and seen from each of its targets."""
    from ..model.package import build_type_of
    from ..model.view import TargetView
    from ..model.workspace import link
    from ..targets.asked_versions import AskedVersions
    from ..targets.providers.providers import load_providers

    tree, store, extraction, discovered, ros, targets, config, tracked_names = read
    asked_versions = AskedVersions(chosen.target for chosen in targets)
    generations = {chosen.target.ros for chosen in targets}
    if len(generations) == 1:
        (ros,) = generations  # packages for both are linked as the targets build them
    link_for = partial(
        link, tree, extraction, store,
        watched=tracked_names(), jobs=options.jobs, discovered=discovered, asked=asked_versions,
    )  # fmt: skip
    workspace = link_for(ros)
    linked = {ros: workspace}
    if len(generations) > 1:
        # Packages for both are linked once more, as the targets of the other generation build them.
        both = any(build_type_of(package.manifest, 1) != build_type_of(package.manifest, 2) for package in workspace)
        linked[3 - ros] = link_for(3 - ros) if both else workspace
    extraction.problems += [*workspace.discovered.problems, *_list_shadowed_packages(workspace)]
    asked = frozenset(chosen.target.distro for chosen in targets)
    views = [TargetView(linked[each.target.ros], each.target, load_providers(), config, asked) for each in targets]
    installed, shared_libraries = None, ()
    if options.install is not None:
        from ..model import install_space as built

        installed = built.read_space(options.install, Path(path), workspace, store, options.jobs)
        shared_libraries = built.list_shared_libraries(installed, targets, config)
        extraction.problems += [*installed.problems, *built.list_foreign_files(installed, shared_libraries)]
    return OpenedWorkspace(
        tree, store, extraction, workspace, targets, views, config, asked_versions, installed, shared_libraries
    )


def _list_shadowed_packages(workspace: Workspace) -> Iterator[PathProblem]:
    """Packages that another of the same name stands for; build tools refuse such a workspace."""
    paths = {package.name: package.path for package in workspace}
    for place in workspace.hidden:
        other = shown(paths.get(place.name) or ".")
        yield PathProblem(
            place.manifest_path, f"not analysed, because another package named `{place.name}` is in {other}"
        )


def load_settings(root: Path, tree: Tree, file: Path | None, *, follow_links: bool = False) -> Config:
    """The configuration: the file given, else rosimpact.toml on disk, else that of the tree. Raises ConfigError."""
    config = load(root, file, follow_links=follow_links)
    name = "rosimpact.toml"
    if config.path is None and not isinstance(tree, WorkingTree) and tree.exists(name) and not tree.is_dir(name):
        try:
            data = tree.read(name, get_limits().settings)
        except OSError as error:
            raise ConfigError(f"{root / name}: cannot be read: {error.strerror}; correct the file") from None
        return parse(data, root / name, trusted=follow_links)
    return config


def open_tree(root: Path, rev: str, *, follow_links: bool = False) -> Tree:
    """The files on disk, or a revision of the repository when one is asked for or the path is a bare repository.

    A folder below a repository's root stays the root of what is read. follow_links: whether links that leave it are
    followed. Raises TreeError.
    """
    bare = (root / "objects").is_dir() and (root / "refs").is_dir() and (root / "HEAD").is_file()
    if not follow_links and (link := _find_leaving_link(root)):
        raise TreeError(
            f"`{shown(link)}` is a link that leads out of its repository, and is not followed; give the folder that "
            "it leads to, or --follow-links"
        )
    # A change can add all that makes a folder look like a bare repository, and show another workspace in it.
    bare = bare and find_enclosing_repository(os.path.realpath(root)) is None
    if not root.exists() or not (rev or bare):
        return WorkingTree(root, follow_links=follow_links)
    if not root.is_dir():
        raise TreeError(f"`{shown(os.fspath(root))}` is a file, not a folder; give the folder of a git repository")
    tree = GitTree(root, rev or "HEAD", follow_links=follow_links)
    place = tree.repositories[""]
    folder = os.path.relpath(os.path.realpath(root), os.path.realpath(place))
    inside = folder != "." and not folder.startswith("..") and not bare and folder.split(os.sep)[0] != ".git"
    if not inside:
        return tree
    return GitTree(root, rev or "HEAD", folder.replace(os.sep, "/"), follow_links=follow_links)


def _find_leaving_link(root: Path) -> str:
    """The first link on the way to a folder that a git repository tracks and that leads out of the repository; empty
    without one. A change can put such a link where the workspace was."""
    place = Path(os.path.abspath(root))
    for path in (*reversed(place.parents), place):
        if path.is_symlink():
            parent = os.path.realpath(path.parent)
            repository = find_enclosing_repository(parent)
            if repository is not None and not is_within(os.path.realpath(path), repository):
                index = Index.open_index(repository)
                if index is None or index.tracks(os.path.relpath(os.path.join(parent, path.name), repository)):
                    return os.fspath(path)
    return ""


def make_reader(tree: Tree) -> Callable[[str], bytes | None]:
    """Bytes of a path, None when there are none to be had."""

    def read(path: str) -> bytes | None:
        try:
            return tree.read(path)
        except OSError:
            return None

    return read


def explain_nothing_analysed(path: str | os.PathLike[str], opened: OpenedWorkspace) -> str:
    """Why there is no package, and what to do, for a workspace without any."""
    where = shown(os.fspath(path))
    ignored = [PathProblem(place.path or ".", place.ignored) for place in opened.workspace.discovered.ignored]
    ignored += [skipped for skipped in opened.tree.skipped if "IGNORE" in skipped.message]
    if ignored:
        named = "; ".join(f"`{shown(each.path)}`: {each.message}" for each in ignored[:3])
        more = f", and {len(ignored) - 3} more" if len(ignored) > 3 else ""
        remedy = "remove the markers or give another folder"
        return f"{where}: no package is left to analyse, all are ignored ({named}{more}); {remedy}"
    linked = [problem for problem in opened.tree.problems if problem.message == LEAVES]
    if linked:
        named = ", ".join(f"`{shown(problem.path)}`" for problem in linked[:3])
        more = f" and {len(linked) - 3} more" if len(linked) > 3 else ""
        return f"{where}: no package was found; links lead out of it ({named}{more}), follow them with --follow-links"
    problems = opened.extraction.problems
    unread = [problem for problem in problems if problem.path.rpartition("/")[2].startswith("package")]
    if unread:
        named = "; ".join(f"`{shown(problem.path)}`: {problem.message}" for problem in unread[:3])
        return f"{where}: no package could be read ({named}); make the files readable"
    return _describe_no_package(path)


def _describe_no_package(path: str | os.PathLike[str]) -> str:
    where = shown(os.fspath(path))
    return f"{where}: no package was found (no package.xml outside of ignored folders); give the folder of a workspace"


def link_flow(path: Path, tree: Tree, store: Store, jobs: int | None, progress: Progress | None) -> Workspace:
    """A workspace as far as message flow needs it. Raises CheckError when it has no package."""
    from ..model.flow.workspace import link_for_flow

    workspace = link_for_flow(tree, store, jobs, progress)
    if not workspace.packages:
        raise CheckError(_describe_no_package(path))
    return workspace


def select_rules(options: Options, config: Config) -> dict[str, Rule]:
    """The rules to run. What is asked for on the command line goes over the configuration, list by list.

    Raises SettingsError for a name that is neither a rule nor a family.
    """
    from ..rules.rule import load_rules
    from .findings import SettingsError, choose_rules

    rules = load_rules()
    select, ignore = options.select or config.select, options.ignore or config.ignore
    try:
        return choose_rules(rules, select=select, ignore=ignore, preview=options.preview)
    except SettingsError as error:
        option = "--select or --ignore" if options.select or options.ignore else f"{config.path}: [check]"
        raise SettingsError(f"{option}: {error}") from None
