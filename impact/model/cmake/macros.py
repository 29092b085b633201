"""Preprocessor macros that CMake gives to the compiler, in every form that they can be given."""

from __future__ import annotations

import re

from .build import DefinedMacro
from .interpreter import Interpreter
from .values import Word

_MACRO = re.compile(r"(?:-D)?\s*([A-Za-z_]\w*)(?:=(.*))?\Z", re.DOTALL)
_FLAGS = re.compile(r"(?:^|[\s;\"])-D\s*([A-Za-z_]\w*)(?:=([^\s;\"]*))?")


def note_macro(run: Interpreter, item: Word, target: str) -> None:
    """Collects one definition (`NAME=value`, `-DNAME`) of a target, or of all that follow when its name is empty."""
    found = _MACRO.match(item)
    if found is not None:
        conditions = tuple(dict.fromkeys((*run.conditions, *item.conditions)))
        run.macros[DefinedMacro(found.group(1), found.group(2) or "", target, conditions)] = None


def note_flag(run: Interpreter, item: Word) -> None:
    """Collects a definition or an include directory among options; others are passed over."""
    if item.startswith("-D"):
        note_macro(run, item, "")
    elif item.startswith("-I"):
        run.include_dirs[(run.resolve_tree_path(item[2:]), run.locate(item.at))] = None


def note_flag_macros(run: Interpreter, text: str) -> None:
    """Collects definitions in the text of CMAKE_CXX_FLAGS, which may hold those of earlier texts."""
    for name, value in _FLAGS.findall(text):
        before = [m for m in run.macros if m.name == name and not m.target]
        opposite = {(c.text, not c.negated) for c in run.conditions}
        if all(opposite.intersection((c.text, c.negated) for c in m.conditions) for m in before):
            run.macros[DefinedMacro(name, value, "", run.conditions)] = None
