"""What rules said of a workspace on a target, remembered by what it rests on: content, data, settings and our own code.

A second run on unchanged files then judges nothing anew. Time plays no part: the key is made of content ids.
"""

import contextlib
import hashlib
from collections.abc import Iterable
from functools import lru_cache

import msgspec
from msgspec import structs

from ..facts.store import Store, encode_rows
from ..model import tracked_names as watch
from ..model.cmake.build import At
from ..model.flow.file_selection import compute_stamp
from ..model.flow.workspace import get_flow
from ..model.package import Watched
from ..model.view import TargetView, UnresolvedUse
from ..model.workspace import Workspace
from ..rules.rule import Diagnostic
from ..source_keys import compute_code_stamp
from ..targets.changes import index_uses
from ..targets.providers.compiled import load_compiled
from ..targets.surface.fields import load_fields
from ..targets.surface.store import load_shipped
from ..targets.tables import compute_data_stamp

# (rule, what it yields)
Yielded = tuple[str, Diagnostic]


class _Stored(msgspec.Struct, frozen=True, array_like=True):
    """A diagnostic as stored: its rule, its place, and all else."""

    rule: str
    at: At
    diagnostic: Diagnostic


class _Judgement(msgspec.Struct, frozen=True, array_like=True):
    diagnostics: tuple[_Stored, ...]
    unresolved: tuple[UnresolvedUse, ...]


def load_tracked_names(store: Store) -> Watched:
    """The names that rules look out for, as an earlier run collected them from the same tables."""
    name = hashlib.sha1(f"{compute_code_stamp()} {compute_data_stamp()}".encode()).digest()
    data = store.find_memo("watched", name)
    if data is not None:
        with contextlib.suppress(msgspec.MsgspecError):
            return _unpack_tracked(data)
    names = watch.load_watched()
    # The table of fields, the surfaces, the compiled names and the uses are read from files of their own, where they
    # are asked.
    bare = structs.replace(names, fields=None, surfaces=None, compiled=None, uses=None)
    store.remember("watched", encode_rows([(name, bare)]))
    return names


@lru_cache(maxsize=1)
def _unpack_tracked(data: bytes) -> Watched:
    """The names as they were stored. What is derived from them is made once in a process. Raises MsgspecError."""
    known = msgspec.msgpack.decode(data, type=Watched)
    return structs.replace(
        known, fields=load_fields(), surfaces=load_shipped(), compiled=load_compiled, uses=index_uses
    )


def make_results_key(view: TargetView, rules: Iterable[str], group: Iterable[str]) -> bytes:
    """The key of what these rules say of a group of packages, see Workspace.groups."""
    workspace = view.workspace
    found = hashlib.sha1(workspace.outline)
    config = view.config
    found.update(
        repr(
            (
                *(compute_code_stamp(), view.target.compute_identity(), view.horizon, sorted(rules)),
                *(config.private, config.installed, config.underlays, config.repos),
                [(name, workspace.contents[name]) for name in group],
            )
        ).encode()
    )
    return found.digest()


def make_flow_key(workspace: Workspace, before: Workspace | None, rules: Iterable[str]) -> bytes:
    """The key of what these rules say of a workspace's message flow. before: the workspace at the base."""
    both = [each for each in (workspace, before) if each is not None]
    stamps = [(compute_stamp(each), sorted(get_flow(each).systems.items())) for each in both]
    return hashlib.sha1(repr((stamps, compute_data_stamp(), sorted(rules))).encode()).digest()


def store_yielded(
    store: Store, key: bytes, diagnostics: Iterable[Yielded], unresolved: Iterable[UnresolvedUse] = ()
) -> None:
    """Keeps what rules yielded, and what they could not resolve, for later runs."""
    stored = tuple(_Stored(rule, At(*one.place), one._replace(at=None)) for rule, one in diagnostics)
    store.remember("judgement", encode_rows([(key, _Judgement(stored, tuple(sorted(unresolved))))]))


def load_yielded(store: Store, key: bytes) -> tuple[list[Yielded], tuple[UnresolvedUse, ...]] | None:
    """What store_yielded() kept; None when there is none."""
    data = store.find_memo("judgement", key)
    if data is None:
        return None
    try:
        judgement = msgspec.msgpack.decode(data, type=_Judgement)
        found = [(stored.rule, stored.diagnostic._replace(at=stored.at)) for stored in judgement.diagnostics]
        return found, judgement.unresolved
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
