"""Explores Python programs from their start, for what they send before and beside their callbacks."""

from __future__ import annotations

import ast
import time
from typing import Any

import z3

from ..outcomes import Bounds, CallbackPath, Exploration, Reaction
from .explore import CallbackCode
from .machine import PythonMachine
from .messages import Messages
from .modules import FindModule, ModuleCode, PythonClass, PythonFunction, Scope
from .run import ProgramEndedError, ProgramRounds, PythonRun, PythonThrownError
from .terms import NotModelledError, Opaque

# What these cannot do leaves names that nothing is known of; what else cannot be executed ends the way.
_HARMLESS = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign, ast.AugAssign)


def explore_program(code: CallbackCode, messages: Messages, find_module: FindModule, bounds: Bounds) -> Exploration:
    """All ways through a program up to bounds: a module's top (`name` empty), a function `main`, or the constructor of
    a class. Loops that run until ROS is shut down are followed for a few rounds; where one goes on, a way is left."""
    started = time.monotonic()
    deadline = started + bounds.seconds
    found = Exploration(bounds=bounds)
    pending: list[list[bool]] = [[]]
    cut = 0
    while pending:
        if time.monotonic() > deadline or len(found.paths) >= bounds.paths:
            break
        run = PythonRun(pending.pop(), bounds, found.inputs, deadline)
        run.program = ProgramRounds()
        path = _take_way(code, run, messages, find_module)
        found.instructions += run.steps
        pending.extend(run.open_ways)
        cut += run.program.is_cut
        if path is not None:
            found.paths.append(path)
    found.left = len(pending) + cut
    found.seconds = time.monotonic() - started
    return found


def _take_way(code: CallbackCode, run: PythonRun, messages: Messages, find_module: FindModule) -> CallbackPath | None:
    modules: dict[str, ModuleCode] = {}

    def find_fresh(name: str) -> ModuleCode | None:
        if name not in modules:
            known = find_module(name)
            if known is None:
                return None
            modules[name] = ModuleCode(known.name, known.path, known.tree)
        return modules[name]

    machine = PythonMachine(run, messages, find_fresh)
    module = ModuleCode(code.module.name, code.module.path, code.module.tree)
    modules[module.name] = module
    result, reason = Reaction.IGNORED, ""
    try:
        _run_program(machine, module, code.name)
    except ProgramEndedError:
        pass
    except PythonThrownError as error:
        # Raised on purpose or not, the program ends here; what it has sent is sent.
        if error.name != "SystemExit":
            result, reason = Reaction.UNKNOWN, f"{error.name} ends the program"
    except (NotModelledError, RecursionError) as error:
        result, reason = Reaction.UNKNOWN, str(error) or "nested too deep"
    except z3.Z3Exception as error:
        result, reason = Reaction.UNKNOWN, f"the solver refused a term: {str(error)[:80]}"
    except Exception as error:  # a mistake of the executor is no verdict on the program
        result, reason = Reaction.UNKNOWN, f"the executor failed: {type(error).__name__}: {str(error)[:80]}"
    if run.is_possible() is False:
        return None
    if result is Reaction.IGNORED and run.effects:
        result = Reaction.HANDLED
    return CallbackPath(
        result, tuple(run.condition), tuple(run.effects), tuple(run.logs), tuple(run.sent), place=run.place,
        reason=reason, assumed=tuple(run.assumed),
    )  # fmt: skip


def _run_program(machine: PythonMachine, module: ModuleCode, name: str) -> None:
    if name:
        machine.is_quiet = True
        machine.load(module)
        machine.is_quiet = False
        value: Any = module.names.get(name.partition(".")[0])
        if isinstance(value, PythonClass):
            machine.make_instance(value, _make_arguments(value.find("__init__"), 1), {})
        elif isinstance(value, PythonFunction):
            machine.call_function(value, _make_arguments(value, 0), {})
        else:
            raise NotModelledError(f"{name} is not at the top of its module")
        return
    module.is_loaded = True
    module.names["__name__"] = "__main__"
    scope = Scope(module, module.names)
    for statement in module.tree.body:
        if isinstance(statement, _HARMLESS):
            machine.execute_leniently(statement, scope)
        else:
            machine.execute(statement, scope)


def _make_arguments(function: Any, given: int) -> list[Any]:
    """Arguments that a function asks for: nothing is known of them."""
    if not isinstance(function, PythonFunction):
        return []
    arguments = function.node.args
    wanted = [*arguments.posonlyargs, *arguments.args]
    return [Opaque(one.arg) for one in wanted[given : len(wanted) - len(arguments.defaults)]]
