"""Launch files in Python to the facts of flow_launch: what generate_launch_description() gives, without running it."""

from typing import Any

from ..place import Problem
from ..python.source import read
from .actions import Action, LaunchFile
from .parameter_files import DEEPEST
from .python_calls import make
from .python_values import TooMuch
from .python_walk import MOST_STEPS, Walker


def extract(data: bytes) -> LaunchFile:
    """The facts of a launch file in Python. Never raises.

    A file without generate_launch_description() says so as a problem.
    """
    source = read(data)
    problems = source.problems
    if source.tree is None:
        return LaunchFile("python", 2, (), problems or (Problem(1, "not parsed: is not Python 3"),))
    try:
        actions, more = Walker(make).launch(source.tree)
        _measure(actions)
        return LaunchFile("python", 2, actions, (*problems, *more))
    except RecursionError:
        return LaunchFile("python", 2, (), (*problems, Problem(1, "nested too deeply to be read")))
    except TooMuch as error:
        return LaunchFile("python", 2, (), (*problems, Problem(1, str(error))))


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
