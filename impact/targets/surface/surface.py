"""What one version of one package offers, in the form that is stored."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from ...facts.interface import Interface
from ...facts.surface import HeaderSurface
from ...facts.surface_python import ModuleSurface
from .build import BuildSurface

if TYPE_CHECKING:
    pass


class Surface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What one version of one package offers.

    headers: by the path that dependants write; generated ones are in the build only. interfaces: by `msg/Name`,
    without comments. guessed: the build does not tell which headers are installed, so those of `include/` are taken.
    runs_with: packages that come along when this one is installed. parameters: that its nodes declare, by name, with
    their default: None for none, `?` where it is no plain value, or not one. mentioned: names that its sources mention,
    as ParametersFile.mentioned, and those of its parameters; None where they are not known, as in what is stored. The
    C++ standard, re-exported packages, targets, programs and launch files are in the build.
    """

    package: str
    version: str
    build: BuildSurface
    python: PythonSurface
    headers: tuple[tuple[str, HeaderSurface], ...] = ()
    interfaces: tuple[tuple[str, Interface], ...] = ()
    guessed: bool = False
    runs_with: tuple[str, ...] = ()
    parameters: tuple[tuple[str, str | None], ...] = ()
    mentioned: tuple[str, ...] | None = None


class Module(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An installed module. name: dotted. path: its source, relative to the package. package: it is an `__init__.py`."""

    name: str
    path: str
    package: bool
    surface: ModuleSurface


class PythonSurface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a package version offers to Python. unknown: dotted names below which there may be anything: extensions,
    generated interfaces. unresolved: what kept the modules from being told, in a clause each."""

    package: str
    modules: tuple[Module, ...] = ()
    unknown: tuple[str, ...] = ()
    unresolved: tuple[str, ...] = ()
