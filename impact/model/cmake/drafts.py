"""Targets while they are being described, command by command."""

import msgspec
from msgspec import structs

from ...facts.condition import Condition
from .build import At, BuildTarget, Link


class TargetDraft(msgspec.Struct, eq=False):
    """A BuildTarget that still grows; lists keep the order of the commands. sources: path to the conditions under which
    it was added. ways: the conditions of each command that makes it. installed_as: the artifact: executable, library,
    static or module. signatures: of link_target_libraries(), True with keywords, False without, each with the
    conditions of its first call."""

    name: str
    kind: str
    at: At
    conditions: tuple[Condition, ...]
    installed_as: str
    sources: dict[str, tuple[Condition, ...]] = {}
    links: dict[Link, None] = {}
    definitions: dict[str, None] = {}
    standard: int = 0
    output_name: str = ""
    alias_of: str = ""
    export_name: str = ""
    public_standard: int = 0
    installed_includes: dict[str, None] = {}
    excluded: bool = False
    added: bool = False
    archive: bool = False
    signatures: dict[bool, tuple[Condition, ...]] = {}
    ways: tuple[tuple[Condition, ...], ...] = ()

    def finish(self) -> BuildTarget:
        """The target as it stands."""
        return BuildTarget(
            self.name,
            self.kind,
            self.at,
            tuple(self.sources),
            tuple(structs.replace(link, conditions=self._merge(link.conditions)) for link in self.links),
            tuple(self.definitions),
            self.standard,
            self.output_name,
            self.alias_of,
            self.conditions,
            tuple(
                (path, own)
                for path, conditions in self.sources.items()
                if (own := tuple(c for c in conditions if c not in self.conditions))
            ),
            self.export_name,
            self.public_standard,
            tuple(self.installed_includes),
            self.installed_as == "static",
            self.excluded,
            self.archive,
        )

    def _merge(self, conditions: tuple[Condition, ...]) -> tuple[Condition, ...]:
        return (*self.conditions, *(c for c in conditions if c not in self.conditions))

    def add_source(self, path: str, conditions: tuple[Condition, ...]) -> None:
        """Adds a source; one that is added twice stands under what both times have in common."""
        before = self.sources.get(path)
        self.sources[path] = conditions if before is None else tuple(c for c in before if c in conditions)


class Targets:
    """The targets of a package by name."""

    def __init__(self) -> None:
        self._drafts: dict[str, TargetDraft] = {}

    def __contains__(self, name: str) -> bool:
        draft = self._drafts.get(name)
        return draft is not None and draft.kind != "unknown"

    def get(self, name: str) -> TargetDraft | None:
        """The target of this name, if there is one."""
        return self._drafts.get(name)

    def make(self, name: str, kind: str, at: At, conditions: tuple[Condition, ...]) -> TargetDraft:
        """The target of this name; made when it is new. One that was only mentioned takes kind and place from here."""
        draft = self._drafts.get(name)
        if draft is None:
            draft = self._drafts[name] = TargetDraft(name, kind, at, conditions, kind)
        elif draft.kind == "unknown" and kind != "unknown":
            draft.kind = draft.installed_as = kind
            draft.at = at
            draft.conditions = conditions
        elif kind != "unknown" and conditions != draft.conditions:
            # Made in both branches of an if: only what both have in common is a condition of the target.
            draft.conditions = tuple(held for held in draft.conditions if held in conditions)
            draft.kind = "test" if kind == "test" else draft.kind
        if kind != "unknown":
            draft.ways = (*draft.ways, conditions)
        return draft

    def finish(self) -> tuple[BuildTarget, ...]:
        """All targets in the order they were first named."""
        return tuple(draft.finish() for draft in self._drafts.values())
