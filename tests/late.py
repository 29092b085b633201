"""Modules that take long to load, for files of tests: each process of -n loads every file, and tests of few of them."""

from __future__ import annotations

import importlib
from typing import Any


class Late:
    """Stands for a module, which is loaded when something of it is first asked for."""

    def __init__(self, name: str):
        self._name = name

    def __getattr__(self, name: str) -> Any:
        if name.startswith(("_", "pytest")):  # what pytest asks of everything
            raise AttributeError(name)
        return getattr(importlib.import_module(self._name), name)
