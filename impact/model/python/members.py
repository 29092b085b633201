"""Fields and constants of other packages' interfaces that a Python file uses, of those that only some versions have."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING

from ...facts.python.source import PythonFile
from ...facts.python.uses import ELEMENT, KINDS, FieldUse
from ...targets.surface.fields import Fields
from ..members import FoundField, InterfaceScope, MemberType, NamedInterface, find_imported_interfaces, find_section

if TYPE_CHECKING:
    from ...targets.asked_versions import AskedVersions


def may_use_interfaces(
    file: PythonFile, table: Fields, asked: AskedVersions | None = None, home: Collection[str] = frozenset()
) -> bool:
    """Whether a file may use members that some version of their interface lacks, by its imports and words. asked, home:
    as in Scope."""
    modules = [(one.module, one.names) for one in file.imports if not one.level]
    if any(KINDS & {module.partition(".")[2], *names} and not (module.partition(".")[2] in KINDS and names)
           for module, names in modules):  # fmt: skip
        return True  # `import pkg.msg`, `from pkg import msg`
    return not InterfaceScope(find_imported_interfaces(modules, table), table, asked, home).changing.isdisjoint(
        file.words.split(" ")
    )


def list_used(uses: Iterable[FieldUse], table: Fields) -> list[NamedInterface]:
    """The interfaces that uses are of, of both generations where both have one of that name."""
    named = dict.fromkeys(tuple(use.type.split(".")[:3]) for use in uses)
    return find_imported_interfaces([(f"{package}.{kind}", (name,)) for package, kind, name in named], table)


def find_changing_members(uses: Iterable[FieldUse], scope: InterfaceScope) -> Iterator[tuple[FieldUse, FoundField]]:
    """The uses of members that some version lacks."""
    for use in uses:
        if use.steps[-1] not in scope.changing:
            continue
        type_ = _resolve_type(use.type, scope)
        for step in use.steps[:-1]:
            if type_ is None:
                break
            if step == ELEMENT:
                type_ = type_._replace(several=False) if type_.several else None
            else:
                type_ = scope.resolve_field(type_, step)
        section = scope.find_changed_section(type_, use.steps[-1]) if type_ is not None else None
        if type_ is not None and section is not None:
            yield use, FoundField(type_.interface, section, use.steps[-1], None, True)


def _resolve_type(text: str, scope: InterfaceScope) -> MemberType | None:
    """The type that `pkg.kind.Name` or `pkg.kind.Name.Request` is."""
    package, kind, name, *rest = text.split(".")
    for member in scope.by_name.get(name, ()):
        if member[0].package == package and member[0].name.startswith(f"{kind}/"):
            section = find_section(member, rest)
            return MemberType(member[0], section) if section is not None else None
    return None
