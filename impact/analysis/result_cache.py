"""What rules said of a workspace on a target, remembered by what it rests on: content, data, settings and our own code.

A second run on unchanged files then judges nothing anew. Time plays no part: the key is made of content ids.
"""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Iterable, Sequence

import msgspec
from msgspec import structs

from ..cache import code_stamp
from ..facts.store import Store, encodable
from ..model import tracked_names as watch
from ..model.cmake.build import At
from ..model.flow.file_selection import stamp
from ..model.package import Watched
from ..model.view import View
from ..model.workspace import Workspace
from ..rules.fix_actions import Declare, Insert, Remove, Replace
from ..rules.rule import Cure, Edit, Hit
from ..targets.evidence import Evidence
from ..targets.snapshot import data_stamp
from ..targets.surface.fields import default_fields
from ..targets.surface.store import shipped
from ..targets.target import Change, Target

_CURES: dict[str, type] = {kind.__name__: kind for kind in (Declare, Remove, Replace, Insert, Edit)}


class _Hit(msgspec.Struct, frozen=True, array_like=True):
    """A Hit as stored: its rule, its place taken apart, its cures as (kind, fields)."""

    rule: str
    path: str
    line: int
    column: int
    subject: str
    message: str
    help: str
    package: str
    severity: str
    fix: tuple[tuple[str, tuple[str | int, ...]], ...]
    evidence: Evidence | None = None


class _Judgement(msgspec.Struct, frozen=True, array_like=True):
    hits: tuple[_Hit, ...]
    unresolved: dict[str, tuple[str, ...]]


def watched(store: Store) -> Watched:
    """The names that rules look out for, as an earlier run gathered them from the same tables."""
    name = hashlib.sha1(f"{code_stamp()} {data_stamp()}".encode()).digest()
    data = store.memo("watched", name)
    if data is not None:
        with contextlib.suppress(msgspec.MsgspecError):
            known = msgspec.msgpack.decode(data, type=Watched)
            return structs.replace(known, fields=default_fields(), surfaces=shipped())
    names = watch.watched()
    # The table of fields and the surfaces are read from files of their own, where they are asked.
    bare = structs.replace(names, fields=None, surfaces=None)
    store.remember("watched", encodable([(name, bare)]))
    return names


def key(view: View, rules: Iterable[str]) -> bytes:
    """The key of a view's judgement by these rules."""
    found = hashlib.sha1(view.workspace.identity)
    config = view.config
    found.update(
        repr(
            (
                *(code_stamp(), view.target.identity(), view.horizon, sorted(rules)),
                *(config.private, config.underlays, config.repos),
            )
        ).encode()
    )
    return found.digest()


def recall(store: Store, view: View, rules: Sequence[str]) -> list[tuple[str, Hit]] | None:
    """(rule, hit) of an earlier run on the same content, None when there was none. Fills the view's unresolved."""
    found = _recalled(store, key(view, rules))
    if found is None:
        return None
    hits, unresolved = found
    for kind, names in unresolved.items():
        view.unresolved.setdefault(kind, set()).update(names)
    return hits


def remember(store: Store, view: View, rules: Sequence[str], hits: Iterable[tuple[str, Hit]]) -> None:
    """Keeps what the rules said for later runs."""
    unresolved = {kind: tuple(sorted(names)) for kind, names in view.unresolved.items()}
    _keep(store, key(view, rules), hits, unresolved)


def flow_key(workspace: Workspace, before: Workspace | None, rules: Iterable[str]) -> bytes:
    """The key of what these rules say of a workspace's message flow. before: the workspace at the base."""
    stamps = [stamp(each) for each in (workspace, before) if each is not None]
    return hashlib.sha1(repr((stamps, data_stamp(), sorted(rules))).encode()).digest()


def recall_flow(store: Store, key: bytes) -> list[tuple[str, Hit]] | None:
    """(rule, hit) on the message flow of an earlier run, None when there was none. key: a flow_key()."""
    found = _recalled(store, key)
    return found[0] if found is not None else None


def remember_flow(store: Store, key: bytes, hits: Iterable[tuple[str, Hit]]) -> None:
    """Keeps what rules said of the message flow for later runs."""
    _keep(store, key, hits, {})


def _keep(store: Store, key: bytes, hits: Iterable[tuple[str, Hit]], unresolved: dict[str, tuple[str, ...]]) -> None:
    stored = tuple(
        _Hit(
            rule,
            getattr(hit.at, "path", ""),
            getattr(hit.at, "line", 0),
            getattr(hit.at, "column", 0),
            hit.subject,
            hit.message,
            hit.help,
            hit.package,
            hit.severity,
            tuple((type(cure).__name__, tuple(cure)) for cure in hit.fix),
            hit.evidence,
        )
        for rule, hit in hits
    )
    store.remember("judgement", encodable([(key, _Judgement(stored, unresolved))]))


def _recalled(store: Store, key: bytes) -> tuple[list[tuple[str, Hit]], dict[str, tuple[str, ...]]] | None:
    data = store.memo("judgement", key)
    if data is None:
        return None
    try:
        judgement = msgspec.msgpack.decode(data, type=_Judgement)
        return [(h.rule, _hit(h)) for h in judgement.hits], judgement.unresolved
    except (msgspec.MsgspecError, UnicodeDecodeError, KeyError, TypeError):
        return None


def prepare(store: Store, target: Target) -> None:
    """Gives a target, and the newest distro that it is compared with, the changes an earlier run worked out."""
    newest = target.newest()
    for one in (target, newest) if newest is not None else (target,):
        if one.has_changes():
            continue
        name = hashlib.sha1(one.identity().encode()).digest()
        data = store.memo("changes", name)
        if data is not None:
            try:
                one.set_changes(msgspec.msgpack.decode(data, type=tuple[Change, ...]))
                continue
            except msgspec.MsgspecError:
                pass
        store.remember("changes", encodable([(name, [tuple(change) for change in one.changes()])]))


def _hit(h: _Hit) -> Hit:
    cures: tuple[Cure, ...] = tuple(_CURES[kind](*fields) for kind, fields in h.fix)
    return Hit(At(h.path, h.line, h.column), h.subject, h.message, h.help, h.package, h.severity, cures, h.evidence)
