"""The sources of a workspace as files that a compiler can read, wherever the workspace itself lies."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ...edges.files import write_file
from ..tree import Tree, WorkingTree

_COMPILED = (
    ".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp", ".txx", ".inc", ".def", ".impl",
)  # fmt: skip
_MOST_BYTES = 4_000_000


@contextmanager
def open_sources(tree: Tree) -> Iterator[Path]:
    """A folder with the C++ sources and headers of a tree: its own, or a temporary one with what a revision has."""
    if isinstance(tree, WorkingTree):
        yield Path(tree.root)
        return
    with tempfile.TemporaryDirectory(prefix="rosimpact-sources-") as folder:
        for entry in tree.list_entries():
            if entry.path.endswith(_COMPILED):
                with suppress(OSError):
                    write_file(Path(folder) / entry.path, tree.read(entry.path, _MOST_BYTES))
        yield Path(folder)
