"""What the changes since a base reach in a workspace: from a path to nodes downstream."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from ..facts.store import Store
from ..model.flow.workspace import linked
from .downstream import Impact, impact_of
from .session import link_flow, open_tree


class ImpactResult(NamedTuple):
    """What was found; what the workspace and its base are called; and what to know about the base."""

    impact: Impact
    root: str
    rev: str
    base: str
    notes: tuple[str, ...]


def reached(
    path: Path, base: Sequence[str], *, rev: str = "", jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, cache: Path | None = None, follow_links: bool = False,
) -> ImpactResult:  # fmt: skip
    """What the changes since the base reach in the workspace at a path.

    base, rev, jobs, cache, follow_links: as for check. progress: called with (done, total) bytes while files are
    parsed. Raises CheckError, TreeError and BaseError with a text for the user.
    """
    from .revision_compare import base_tree

    tree = open_tree(path, rev, follow_links=follow_links)
    with Store(cache) as store:
        old_tree, notes = base_tree(tree, tuple(base))
        now = link_flow(path, tree, store, jobs, progress)
        before = linked(old_tree, store, jobs)
        return ImpactResult(impact_of(now, before), os.fspath(path), rev, " ".join(base), (*notes, *store.notes))
