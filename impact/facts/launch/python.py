"""Launch files in Python to the facts of flow_launch: what generate_launch_description() gives, without running it."""

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from ..place import Problem
from ..python.source import read
from .actions import Action, LaunchFile
from .parameter_files import DEEPEST
from .python_moveit import make
from .python_values import TooMuch
from .python_walk import MOST_STEPS, HelperModule, Walker

# What many launch files import is read once; the walks through it leave its tree as it is.
_read = lru_cache(maxsize=64)(read)


def extract(data: bytes, helpers: Mapping[str, tuple[bytes, str]] | None = None) -> LaunchFile:
    """The facts of a launch file in Python. Never raises.

    A file without generate_launch_description() says so as a problem. helpers: modules that it may import, by their
    dotted names: the source, and the package that relative imports in it are of.
    """
    source = _read(data)
    problems = source.problems
    if source.tree is None:
        return LaunchFile("python", 2, (), problems or (Problem(1, "not parsed: is not Python 3"),))
    parsed = {name: (_read(text).tree, package) for name, (text, package) in (helpers or {}).items()}
    modules = {name: HelperModule(tree, package) for name, (tree, package) in parsed.items() if tree is not None}
    try:
        walker = Walker(make, modules)
        actions, more = walker.launch(source.tree)
        _measure(actions)
        imports = tuple(path for path in walker.imports if path.partition(".")[0] not in _KNOWN)
        return LaunchFile("python", 2, actions, (*problems, *more), imports)
    except RecursionError:
        return LaunchFile("python", 2, (), (*problems, Problem(1, "nested too deeply to be read")))
    except TooMuch as error:
        return LaunchFile("python", 2, (), (*problems, Problem(1, str(error))))


# Packages whose names python_calls.py knows, wherever they are.
_KNOWN = frozenset((
    "ament_index_python", "launch", "launch_param_builder", "launch_ros", "launch_xml", "launch_yaml",
    "moveit_configs_utils", "nav2_common", "os", "pathlib", "sys", "typing", "yaml",
))  # fmt: skip


def _measure(actions: tuple[Action, ...]) -> None:
    """Raises TooMuch for facts too large or too deep to be handed on: values may hold one another many times over."""
    pieces = 0
    rest: list[tuple[Any, int]] = [(action, 0) for action in actions]
    while rest:
        item, depth = rest.pop()
        pieces += 1
        if pieces > MOST_STEPS or depth > DEEPEST:
            raise TooMuch("says too much to be kept")
        if isinstance(item, Action):
            values = [value for _, value in item.attributes] + [c.value for c in item.conditions]
            rest += [(child, depth + 1) for child in item.children]
        else:
            values = item.parts
        rest += [(piece, depth + 1) for value in values for piece in value]
