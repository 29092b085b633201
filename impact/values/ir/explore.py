"""Explores a function of a program that clang compiled to LLVM IR."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..outcomes import Bounds, CallbackPath, Exploration, Reaction
from . import harness_calls, library_containers, library_numbers, library_runtime, library_text
from .executor import Executor
from .layout import UnknownSizeError
from .models import find_model
from .module import ReadingError
from .reader import Program

# These modules register what they model.
_LIBRARIES = (harness_calls, library_containers, library_numbers, library_runtime, library_text)


def explore(
    ir_texts: Sequence[str], entry: str, bounds: Bounds, is_workspace_file: Callable[[str], bool]
) -> Exploration:
    """All ways through a function without parameters, up to bounds.

    ir_texts: modules of LLVM IR (text, clang 15 to 20), as a linker would join them. is_workspace_file: whether a path
    of the debug information is one of the workspace; lines are named only there. Never raises: what is not understood
    is a path that is unknown, with a reason.
    """
    try:
        return explore_program(Program(ir_texts), entry, bounds, is_workspace_file)
    except (ReadingError, UnknownSizeError, ValueError, KeyError, IndexError, RecursionError) as problem:
        failed = CallbackPath(Reaction.UNKNOWN, (), reason=f"the program cannot be read: {problem}")
        return Exploration(paths=[failed], bounds=bounds)


def explore_program(
    program: Program, entry: str, bounds: Bounds, is_workspace_file: Callable[[str], bool]
) -> Exploration:
    """The same for a program that was read: several callbacks of it need not read it again."""
    return Executor(program, bounds, is_workspace_file, find_model).explore(entry)
