"""Imports between the rooms point one way, in the order of pyproject.toml, and none go in a circle."""

from pathlib import Path

import grimp
import networkx
from importlinter.cli import lint_imports

ROOT = Path(__file__).parents[1]
ROOMS = tuple(f"rosimpact.{room}" for room in ("impact", "corpus", "classifier", "databuild", "edges"))


def test_imports_point_one_way(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    status = lint_imports(config_filename=str(ROOT / "pyproject.toml"), no_cache=True)
    assert status == 0, capsys.readouterr().out


def test_no_imports_go_in_a_circle():
    """Late imports inside functions count, and so do those that only type checkers follow."""
    graph = grimp.build_graph(*ROOMS, cache_dir=None)
    arrows = networkx.DiGraph(
        (module, other) for module in graph.modules for other in graph.find_modules_directly_imported_by(module)
    )
    assert arrows.number_of_edges() > 1_000
    assert [sorted(circle) for circle in networkx.strongly_connected_components(arrows) if len(circle) > 1] == []
