"""Comparison with a base revision: what is new because of the change."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...edges import files
from ...edges.documents import DocumentError, load_yaml
from ...edges.limits import get_limits
from ..facts.extract import extract_all
from ..model.discovery import REPOSITORY_LISTS
from ..model.flow.file_selection import make_code_selector
from ..model.view import TargetView
from ..model.workspace import link
from ..tree import GitTree, Tree, TreeError, normalize_path, open_merge_bases, shown
from .result_cache import load_tracked_names
from .session import OpenedWorkspace


class BaseError(TreeError):
    """The base cannot be found; the text names what was asked for and what to write."""


def open_base_tree(tree: Tree, base: Sequence[str]) -> tuple[Tree, list[str]]:
    """The tree to compare with, every repository of the workspace at its merge base with the revision asked for; and
    what to know about it.

    base: `REV` for all repositories, `PATH=REV` for one, or the path of a pinned .repos (or .rosinstall) file.
    Raises TreeError.
    """
    everywhere = ""
    revisions: dict[str, str] = {}
    pinned: dict[str, str] = {}
    for item in base:
        if item.endswith(REPOSITORY_LISTS) and "=" not in item:
            pinned.update(read_pinned(Path(item)))
        elif "=" in item:
            path, _, revision = item.partition("=")
            if not revision:
                raise BaseError(f"--base {item}: names no revision; write --base {path}=REV")
            revisions[_find_repository(tree, path)] = revision
        elif everywhere and item != everywhere:
            raise BaseError(f"--base {item}: {everywhere} was given too; for single repositories write --base PATH=REV")
        else:
            everywhere = item
    if pinned and not isinstance(tree, GitTree):
        found = {folder: rev for folder in tree.repositories if (rev := _find_pin(folder, pinned))}
        if not found:
            names = ", ".join(list(pinned)[:5])
            raise BaseError(f"--base: no repository of {tree.label} is one that the file pins ({names})")
        revisions = {**found, **revisions}
    joined = open_merge_bases(tree, revisions, everywhere)
    left = [] if everywhere or isinstance(tree, GitTree) else [f for f in tree.repositories if f not in revisions]
    notes = [
        f"base: no revision was named for `{shown(folder or '.')}`, so nothing in it counts as new" for folder in left
    ]
    return joined, notes


def _find_repository(tree: Tree, path: str) -> str:
    """The folder of the repository that a person means by a path: as written, or by its last parts where clear."""
    folder = normalize_path(path.rstrip("/"))
    known = tree.repositories
    if folder is None or folder in known:
        return folder if folder is not None else path
    ending = [each for each in known if each.endswith("/" + folder)]
    return ending[0] if len(ending) == 1 else folder


def _find_pin(folder: str, pinned: dict[str, str]) -> str:
    """The version that a .repos file pins for a folder; its paths are relative to wherever it was imported."""
    matching = [name for name in pinned if folder == name or folder.endswith("/" + name)]
    return pinned[max(matching, key=len)] if matching else ""


def read_pinned(path: Path) -> dict[str, str]:
    """Versions by path of a .repos file (vcstool) or a .rosinstall file (wstool); git repositories alone.

    Raises BaseError when there is no such file, or it is none of these.
    """
    try:
        data: Any = load_yaml(files.read_file(path, get_limits().settings))
    except OSError as error:
        raise BaseError(f"{path}: cannot be read ({error.strerror}); give a revision or a .repos file") from None
    except DocumentError as error:
        raise BaseError(f"{path}: is no YAML ({error}); `vcs export --exact` writes such a file") from None
    found: dict[str, str] = {}
    if isinstance(data, dict) and isinstance(data.get("repositories"), dict):
        for name, entry in data["repositories"].items():
            if isinstance(entry, dict) and entry.get("type", "git") == "git" and entry.get("version"):
                found[str(name)] = str(entry["version"])
    elif isinstance(data, list):
        for item in data:
            entry = item.get("git") if isinstance(item, dict) else None
            if isinstance(entry, dict) and entry.get("local-name") and entry.get("version"):
                found[str(entry["local-name"])] = str(entry["version"])
    else:
        raise BaseError(f"{path}: has no `repositories`; `vcs export --exact` writes such a file")
    if not found:
        raise BaseError(f"{path}: pins no version of a git repository; `vcs export --exact` writes such a file")
    return {name.strip("/"): version for name, version in found.items()}


def open_base(tree: Tree, opened: OpenedWorkspace, *, jobs: int | None = None) -> OpenedWorkspace:
    """The workspace as it was in another tree, seen by the same targets."""
    second = make_code_selector(tree) if opened.extraction.second is not None else None
    watched = load_tracked_names(opened.store)
    extraction = extract_all(tree, opened.store, jobs=jobs, second=second, along=watched.make_searches)
    linked = {
        ros: link(tree, extraction, opened.store, ros, watched, jobs, asked=opened.asked)
        for ros in {opened.workspace.ros, *(view.workspace.ros for view in opened.views)}
    }
    views = [
        TargetView(linked[view.workspace.ros], view.target, view.providers, view.config, view.asked)
        for view in opened.views
    ]
    workspace = linked[opened.workspace.ros]
    # What is installed is of no revision.
    return opened._replace(
        tree=tree, extraction=extraction, workspace=workspace, views=views, installed=None, shared_libraries=()
    )
