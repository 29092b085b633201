"""What the code imports is what pyproject.toml asks for, no more and no less; both name the same version."""

import ast
import re
import sys
from functools import cache
from importlib.metadata import packages_distributions
from pathlib import Path

from rosimpact.edges.version import __version__

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[2]
ROOMS = ("impact", "corpus", "classifier", "databuild", "edges")
# Never imported by name: the kernel that notebooks run in, and what measuring nodes load when they run.
UNNAMED = {"ipykernel", "cyclonedds"}


def declared(*extras: str) -> set[str]:
    """Distributions that pyproject.toml asks for, those of the extras included, in their normal form."""
    project = _project()
    asked = [*project["dependencies"], *(r for extra in extras for r in project["optional-dependencies"][extra])]
    return {normal(re.split(r"[\s<>=!~;\[]", requirement)[0]) for requirement in asked}


def _project() -> dict:
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def normal(name: str) -> str:
    """A distribution's name as PEP 503 compares it."""
    return re.sub(r"[-_.]+", "-", name).lower()


@cache
def imported() -> dict[str, str]:
    """Top-level names of other people's modules that the rooms import, each with a file that does."""
    found = {}
    for room in ROOMS:
        for path in (ROOT / room).rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_bytes())):
                names = []
                if isinstance(node, ast.Import):
                    names = [alias.name for alias in node.names]
                elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
                    names = [node.module]
                for name in names:
                    top = name.partition(".")[0]
                    if top not in sys.stdlib_module_names:
                        found.setdefault(top, str(path.relative_to(ROOT)))
    return found


def test_every_import_is_asked_for():
    known = packages_distributions()
    asked = declared("bags", "cluster", "measure", "study")
    missing = {
        name: where
        for name, where in imported().items()
        if name not in {"rosimpact", "tomllib"} and not {normal(d) for d in known.get(name, [name])} & asked
    }
    assert missing == {}


def test_nothing_is_asked_for_in_vain():
    known = packages_distributions()
    used = {normal(d) for name in imported() for d in known.get(name, [name])}
    assert declared("bags", "cluster", "measure", "study") - used - UNNAMED == set()


def test_the_version_is_that_of_the_package():
    assert _project()["version"] == __version__
