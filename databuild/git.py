"""The versions that a file went through in a git repository, read without a checkout."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..edges.console import UserError

Report = Callable[[str, int, int], None]
"""Told (what, done, total) while something long goes on."""


class BuildError(UserError):
    """The data cannot be built from what was given; the message says why."""


class FileVersion(NamedTuple):
    """A file from one commit on. ts: seconds since 1970, always rising. blob: its id, empty: the file is gone."""

    ts: int
    path: str
    blob: str


class FirstParents(NamedTuple):
    """First parents of a commit, oldest first: (commit id, ts) with ts always rising."""

    commits: tuple[tuple[str, int], ...]


def open_repository(path: Path) -> Any:
    """A pygit2 repository, bare or not. Raises BuildError."""
    import pygit2

    try:
        return pygit2.Repository(str(path))
    except (pygit2.GitError, KeyError):
        raise BuildError(f"{path} is no git repository") from None


def read_first_parents(repository: Any, start: Any) -> FirstParents:
    """The first-parent line that ends in a commit.

    Some commits of rosdistro go back in time or share a second; each then counts one second after the one before it, so
    that a sync made between two of them keeps what it held apart from what came later.
    """
    line = []
    commit = start
    while True:
        line.append((str(commit.id), commit.commit_time))
        parents = commit.parent_ids
        if not parents or parents[0] not in repository:
            break
        commit = repository[parents[0]]
    line.reverse()
    steady, latest = [], 0
    for oid, ts in line:
        latest = max(latest + 1, ts)
        steady.append((oid, latest))
    return FirstParents(tuple(steady))


def read_file_versions(
    repository: Any, line: FirstParents, wanted: Mapping[str, Sequence[str]], report: Report | None = None
) -> dict[str, list[FileVersion]]:
    """For each name the versions of its file: of the paths given, the first that exists at a commit counts.

    A file that came in through a merge brings the history that it had on the other side.
    """
    versions: dict[str, list[FileVersion]] = {name: [] for name in wanted}
    finders = {name: [tuple(path.split("/")) for path in paths] for name, paths in wanted.items()}
    folders = sorted({parts[0] for choices in finders.values() for parts in choices})
    last_folders: dict[str, str] = {}
    last_root = ""
    for done, (oid, ts) in enumerate(line.commits):
        if report and done % 2000 == 0:
            report("reading commits", done, len(line.commits))
        commit = repository[oid]
        root = str(commit.tree_id)
        if root == last_root:
            continue
        last_root = root
        tree = repository[commit.tree_id]
        now = {name: str(tree[name].id) for name in folders if name in tree}
        changed = {name for name in folders if now.get(name) != last_folders.get(name)}
        last_folders = now
        for name, choices in finders.items():
            if changed.isdisjoint(parts[0] for parts in choices):
                continue
            path, blob = _find(tree, choices)
            old = versions[name][-1].blob if versions[name] else ""
            if blob == old:
                continue
            if not old and len(commit.parent_ids) > 1 and not versions[name]:
                versions[name].extend(_read_side(repository, commit, choices, ts))
                if versions[name] and versions[name][-1].blob == blob:
                    continue
            versions[name].append(FileVersion(ts, path, blob))
    return versions


def _find(tree: Any, choices: Sequence[tuple[str, ...]]) -> tuple[str, str]:
    for parts in choices:
        entry = tree
        for part in parts:
            if getattr(entry, "type_str", "") != "tree" or part not in entry:
                break
            entry = entry[part]
        else:
            return "/".join(parts), str(entry.id)
    return "/".join(choices[0]), ""


def _read_side(repository: Any, merge: Any, choices: Sequence[tuple[str, ...]], until: int) -> list[FileVersion]:
    """Versions of a file on the merged side, oldest first, not later than the merge."""
    parts: list[list[FileVersion]] = []
    while True:
        side = next(
            (
                repository[parent]
                for parent in merge.parent_ids[1:]
                if parent in repository and _find(repository[parent].tree, choices)[1]
            ),
            None,
        )
        if side is None:
            break
        found: list[FileVersion] = []
        first = None
        for oid, ts in read_first_parents(repository, side).commits:
            path, blob = _find(repository[oid].tree, choices)
            if blob != (found[-1].blob if found else ""):
                found.append(FileVersion(min(ts, until), path, blob))
                first = first or oid
        parts.append(found)
        # That side may itself have got the file through a merge.
        until, merge = found[0].ts, repository[first]
    return [version for part in reversed(parts) for version in part]


def find_on_line(repository: Any, oid: str, cuts: Mapping[str, int]) -> int | None:
    """When a commit stood on the line; beside it: the second after its nearest ancestor there, None without one."""
    beside = 0
    commit = repository[oid]
    while str(commit.id) not in cuts:
        beside = 1
        if not commit.parent_ids or commit.parent_ids[0] not in repository:
            return None
        commit = repository[commit.parent_ids[0]]
    return cuts[str(commit.id)] + beside


def insert_side_version(
    repository: Any, versions: Sequence[FileVersion], oid: str, ts: int, paths: Sequence[str]
) -> list[FileVersion]:
    """The versions of a file with the one of a commit beside the line put in at `ts`, followed by the line's own again.

    Some syncs were tagged beside the main line, on a commit that holds a release back for that sync only.
    """
    path, blob = _find(repository[oid].tree, [tuple(choice.split("/")) for choice in paths])
    before = [version for version in versions if version.ts < ts]
    after = list(versions[len(before) :])
    if not before or not blob or blob == before[-1].blob or (after and after[0].ts <= ts):
        return list(versions)
    back = [FileVersion(ts + 1, before[-1].path, before[-1].blob)]
    return [*before, FileVersion(ts, path, blob), *(back if not after or after[0].ts > ts + 1 else []), *after]


def list_tags(repository: Any) -> Iterator[tuple[str, str, int]]:
    """(name without `refs/tags/`, commit id, commit time) of each tag that leads to a commit."""
    import pygit2

    for name in sorted(repository.references):
        if name.startswith("refs/tags/"):
            commit = repository.references[name].peel()
            if isinstance(commit, pygit2.Commit):
                yield name.removeprefix("refs/tags/"), str(commit.id), commit.commit_time
