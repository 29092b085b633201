"""Lists of repositories of vcstool (`.repos`) and wstool (`.rosinstall`): what is put beside a workspace."""

from __future__ import annotations

from typing import Any

import msgspec

from ...edges.documents import DocumentError, load_yaml
from .place import Problem


class ListedRepository(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A repository. name: the folder that it is put into. url: as written. version: a branch, tag or commit; empty for
    the branch that the repository has by default."""

    name: str
    url: str
    version: str = ""

    @property
    def names(self) -> frozenset[str]:
        """What it may be called: the last parts of its folder and of its URL, in lower case and with `_` for `-`."""
        tail = self.url.rstrip("/").removesuffix(".git")
        parts = (self.name.rstrip("/").rpartition("/")[2], tail.rpartition("/")[2].rpartition(":")[2])
        return frozenset(fold_repository(part) for part in parts if part)


class RepositoryList(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The repositories of a file, in its order."""

    repositories: tuple[ListedRepository, ...] = ()
    problems: tuple[Problem, ...] = ()


def fold_repository(name: str) -> str:
    """The name of a repository without what people spell in several ways."""
    return name.lower().replace("-", "_")


def extract(data: bytes) -> RepositoryList:
    """The repositories of a file; never raises: one that is no YAML has a problem and none."""
    try:
        document: Any = load_yaml(data)
    except DocumentError as error:
        return RepositoryList((), (Problem(1, f"is no YAML ({error})"),))
    found = []
    if isinstance(document, dict) and isinstance(document.get("repositories"), dict):
        for name, entry in document["repositories"].items():
            if isinstance(entry, dict):
                found.append(_make_repository(name, entry.get("url"), entry.get("version")))
    elif isinstance(document, list):
        for item in document:
            entries = item.values() if isinstance(item, dict) else ()
            for entry in (entry for entry in entries if isinstance(entry, dict)):
                found.append(_make_repository(entry.get("local-name"), entry.get("uri"), entry.get("version")))
    return RepositoryList(tuple(one for one in found if one.name or one.url))


def _make_repository(name: object, url: object, version: object) -> ListedRepository:
    return ListedRepository(*("" if value is None else str(value) for value in (name, url, version)))
