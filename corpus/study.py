"""`rosimpact study run`: executes the notebooks and says which of them could not make their figures.

A notebook runs in a fresh kernel of this very Python. It opens its page (see figures.py) and writes figures and tables
through it; the executed notebook is written beside them, without anything that differs between two runs.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..edges.console import format_count, run_command, say
from ..edges.documents import load_json
from ..edges.files import read_file, write_file
from ..edges.limits import get_limits
from .figures import SETTINGS
from .report import CorpusError
from .store import open_reports

_BESIDE = Path(__file__).resolve().parent.parent / "notebooks"
"""Where the notebooks are in a checkout."""

_NEEDED = ("nbclient", "nbformat", "ipykernel", "matplotlib")


class Outcome(NamedTuple):
    """What became of one notebook: its name, the figures it made, and why it failed; empty when it did not."""

    name: str
    figures: tuple[str, ...]
    failure: str


def find_notebooks() -> Path:
    """The notebooks of the checkout one stands in, else those beside the package."""
    here = Path("notebooks")
    return here.resolve() if any(here.glob("*.ipynb")) else _BESIDE


def run_study(
    names: Sequence[str] = (), full: bool = False, reports: Path | None = None, output: Path = Path("study"),
    notebooks: Path | None = None, quiet: bool = False,
) -> int:  # fmt: skip
    """Runs the command and returns its exit status: 0, 1 when a notebook failed, 2 when none could be started."""

    def work() -> int:
        outcomes = run(names, full, reports, output, notebooks, (lambda _: None) if quiet else say)
        failed = [one for one in outcomes if one.failure]
        made = sum(len(one.figures) for one in outcomes)
        done = f"{len(outcomes) - len(failed)} of {format_count(len(outcomes), 'notebook')}"
        say(f"{done}, {format_count(made, 'figure')}: {output}")
        return 1 if failed else 0

    return run_command(work, "interrupted; notebooks that were finished are kept")


def run(
    names: Sequence[str] = (), full: bool = False, reports: Path | None = None, output: Path = Path("study"),
    notebooks: Path | None = None, progress: Callable[[str], None] = say,
) -> list[Outcome]:  # fmt: skip
    """Executes notebooks and writes NAME.ipynb, figures/ and tables/ to the output folder.

    names: `03_updates` or `03`; none means all. full: compute from the reports' texts and from all distros; `reports`
    is the file that holds the texts. notebooks: the folder they are in. progress: gets a line at a time.
    Raises CorpusError when the study cannot be started; what fails inside a notebook is in its Outcome.
    """
    _needs()
    folder = _find_folder(notebooks)
    chosen = _select_notebooks(names, folder)
    reading = [path.stem for path in chosen if _read_metadata(path).get("texts")]
    if full and reports is None and reading:
        raise CorpusError(
            f"{reading[0]} reads the reports' texts: `rosimpact corpus hydrate` gets them; give the file with --reports"
        )
    if reports is not None and not full:
        raise CorpusError(f"{reports}: the small form reads no texts; add --full, or leave --reports out")
    if reports is not None and not reports.is_file():
        raise CorpusError(
            f"{reports}: no such file; give the store that `rosimpact corpus hydrate` fills, or JSON Lines"
        )
    if reports is not None and next(open_reports(reports), None) is None:
        raise CorpusError(f"{reports}: holds no reports; `rosimpact corpus hydrate` gathers them")
    output.mkdir(parents=True, exist_ok=True)
    settings = {
        "output": str(output.resolve()),
        "data": str((folder / "data").resolve()),
        "full": full,
        "reports": str(reports.resolve()) if reports else None,
    }
    outcomes = []
    for number, path in enumerate(chosen, 1):
        progress(f"[{number}/{len(chosen)}] {path.stem}")
        outcome = _execute(path, settings, output, progress)
        if outcome.failure:
            progress(f"rosimpact: {path.name}: {outcome.failure}")
        outcomes.append(outcome)
    return outcomes


def _needs() -> None:
    from importlib.util import find_spec

    missing = [name for name in _NEEDED if find_spec(name) is None]
    if missing:
        raise CorpusError(f"the study needs {', '.join(missing)}: pip install 'rosimpact[study]'")


def _find_folder(notebooks: Path | None) -> Path:
    folder = notebooks or find_notebooks()
    if not any(folder.glob("*.ipynb")):
        where = (
            "give another folder" if notebooks else "run from a checkout of rosimpact, or give it with --notebooks DIR"
        )
        raise CorpusError(f"{folder}: holds no notebooks; {where}")
    return folder


def _select_notebooks(names: Sequence[str], folder: Path) -> list[Path]:
    there = sorted(folder.glob("*.ipynb"))
    if not names:
        return there
    chosen = []
    for name in names:
        wanted = Path(name).stem
        found = [path for path in there if path.stem == wanted or path.stem.split("_")[0] == wanted]
        if not found:
            raise CorpusError(f"no notebook `{name}` in {folder}; there are {', '.join(path.stem for path in there)}")
        chosen += [path for path in found if path not in chosen]
    return chosen


def _read_metadata(path: Path) -> dict[str, Any]:
    """What a notebook says of itself: `figures`, the names of those it makes; `texts`, whether its full form reads
    reports. Nothing when it cannot be read: it then fails when it is executed."""
    try:
        return load_json(read_file(path, get_limits().report))["metadata"].get("rosimpact", {})
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _execute(path: Path, settings: dict[str, Any], output: Path, progress: Callable[[str], None]) -> Outcome:
    import nbformat
    from jupyter_client.kernelspec import KernelSpecManager
    from jupyter_client.manager import AsyncKernelManager
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError

    try:
        notebook = nbformat.reads(read_file(path, get_limits().report).decode(), as_version=4)
    except Exception as error:
        return Outcome(path.stem, (), f"is no notebook ({error}); take the file from the repository")
    expected = tuple(_read_metadata(path).get("figures", ()))
    for name in expected:
        for kind in ("svg", "png"):
            (output / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
    total = len(notebook.cells)

    def report_cell(cell: Any, cell_index: int) -> None:
        if cell.cell_type == "code" and sys.stderr.isatty():
            progress(f"    cell {cell_index + 1} of {total}")

    # Notebooks import the modules that lie beside them.
    paths = [str(path.parent.resolve()), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {
        **os.environ, SETTINGS: json.dumps(settings), "PYTHONPATH": os.pathsep.join(paths),
        "PYTHONHASHSEED": "0", "PYTHONDONTWRITEBYTECODE": "1",
    }  # fmt: skip
    failure = ""
    with tempfile.TemporaryDirectory(prefix="rosimpact-") as sockets:
        # No kernel of the user's own: the notebook runs with the Python that runs this. Sockets are files, where files
        # can be: what goes through a TCP port can be read by others on the machine.
        as_files = {} if os.name == "nt" else {"transport": "ipc", "ip": str(Path(sockets) / "kernel")}
        specs = KernelSpecManager(kernel_dirs=[])
        manager = AsyncKernelManager(kernel_name="python3", kernel_spec_manager=specs, **as_files)
        client = NotebookClient(
            notebook, km=manager, timeout=None, record_timing=False, on_cell_execute=report_cell, allow_errors=False,
            resources={"metadata": {"path": str(output.resolve())}},
        )  # fmt: skip
        client.owns_km = True  # so that it ends the kernel
        try:
            client.execute(env=environment)
        except CellExecutionError as error:
            failure = f"cell {_find_failed_cell(notebook)}: {error.ename}: {' '.join(str(error.evalue).split())[:300]}"
        except (CellTimeoutError, DeadKernelError, RuntimeError) as error:
            failure = f"the kernel ended: {' '.join(str(error).split())[:300]}"
    made = tuple(name for name in expected if _is_drawn(output / "figures", name))
    if not failure and len(made) < len(expected):
        failure = f"made no figure {', '.join(f'`{name}`' for name in expected if name not in made)}"
    try:
        write_file(output / path.name, (nbformat.writes(_strip_run_details(notebook)) + "\n").encode())
    except OSError as error:
        failure = failure or f"cannot be written: {error.strerror}"
    return Outcome(path.stem, made, failure)


def _find_failed_cell(notebook: Any) -> int:
    for number, cell in enumerate(notebook.cells, 1):
        if any(one.get("output_type") == "error" for one in cell.get("outputs", ())):
            return number
    return len(notebook.cells)


def _is_drawn(folder: Path, name: str) -> bool:
    return all((folder / f"{name}.{kind}").is_file() for kind in ("svg", "png"))


def _strip_run_details(notebook: Any) -> Any:
    """The notebook without what differs between two runs or two machines: times, paths, versions of Python."""
    for cell in notebook.cells:
        cell.metadata = {key: value for key, value in cell.metadata.items() if key == "tags"}
        for one in cell.get("outputs", ()):
            one.get("metadata", {}).pop("execution", None)
            if one.get("output_type") == "error":
                # A traceback names folders of this machine.
                one["traceback"] = [f"{one['ename']}: {one['evalue']}"]
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
        "rosimpact": notebook.metadata.get("rosimpact", {}),
    }
    return notebook
