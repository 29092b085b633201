"""Launch XML and YAML, xacro, URDF, plugin descriptions, parameter YAML and shell scripts: what they refer to."""

import msgspec

from .place import Problem, Reference


class PluginClass(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A <class> of a plugin description: lookup name, C++ type, base type, library path it lies in."""

    name: str
    type: str
    base: str
    library: str
    line: int


class ReferenceFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Any file whose only interest is what it mentions. plugins is filled for plugin descriptions."""

    references: tuple[Reference, ...]
    plugins: tuple[PluginClass, ...] = ()
    problems: tuple[Problem, ...] = ()
