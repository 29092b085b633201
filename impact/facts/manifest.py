"""package.xml to facts, through catkin_pkg."""

import msgspec

from .place import Problem


class Dependency(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One dependency as one kind.

    kind: build, build_export, buildtool, buildtool_export, exec, test, doc, conflict, replace, group, member_of_group.
    A tag that means several kinds (`depend`, format 1's `run_depend`, `build_depend`) gives one Dependency for each.
    tag: the tag as written. condition: its attribute, as written. bounds: pairs such as ("version_gte", "1.2.0").
    """

    name: str
    kind: str
    tag: str
    line: int
    column: int = 0
    condition: str = ""
    bounds: tuple[tuple[str, str], ...] = ()


class Export(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One element of <export>: tag, attributes, text, condition."""

    tag: str
    attributes: dict[str, str]
    text: str
    line: int


class Manifest(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A package.xml. `build_types` holds (type, condition) pairs as in the export section; none means catkin."""

    name: str
    version: str
    format: int
    line: int
    dependencies: tuple[Dependency, ...] = ()
    build_types: tuple[tuple[str, str], ...] = ()
    exports: tuple[Export, ...] = ()
    metapackage: bool = False
    deprecated: bool = False
    problems: tuple[Problem, ...] = ()
