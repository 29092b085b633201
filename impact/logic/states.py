"""Two states of some packages compared, wherever their files are from; and digests as they are kept."""

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any

import msgspec

from ...edges.console import escape
from ...edges.limits import format_limits
from ..facts.kinds import make_overall_version
from ..facts.store import Store, pack, unpack
from ..model.flow import join
from ..source_keys import compute_source_key
from ..targets.tables import compute_data_version
from .changes import LogicChange, Side, changes, is_unchanged
from .guard_renames import propose_moves, propose_renames
from .guard_solver import limit_questions
from .guards import Language
from .history import PackageFile, PackageState
from .match import Renames
from .statements import EMPTY, Before, PackageStatements, digest_package

_LONGEST_TEXT = 500_000
_decoder = msgspec.msgpack.Decoder(PackageStatements)


@limit_questions()
def compare_sides(
    old: Side, new: Side, renamed: Callable[[], Mapping[str, str]], read: Callable[[PackageFile], bytes]
) -> list[LogicChange]:
    """What happened to publishing from one side to the other, by path and line, rewordings included.

    renamed: gives files that are called otherwise now, as paths of the repository; asked where anything differs. read:
    the bytes of a file of either side.
    """
    if is_unchanged(old, new):
        return []
    files = renamed()
    old, new = old._replace(read=read), new._replace(read=read)
    found = list(changes(old, new, Renames({}, files)))
    if old.packages and new.packages and any(change.kind != "equivalent" for change in found):
        words = find_renamed_words([one for one, _ in old.packages], [one for one, _ in new.packages], files, read)
        if words:
            found = list(changes(old, new, Renames(words, files)))
    return sorted(found, key=lambda change: (change.path, change.line, change.kind, change.why))


def find_renamed_words(
    old: Sequence[PackageState],
    new: Sequence[PackageState],
    files: Mapping[str, str],
    read: Callable[[PackageFile], bytes],
) -> dict[str, str]:
    """Identifiers that are called otherwise in the files that differ. files: those that are called otherwise."""
    was = {state.locate(file.path): file for state in old for file in state.files}
    is_now = {state.locate(file.path): file for state in new for file in state.files}
    found: dict[str, str] = {}
    languages: tuple[Language, ...] = ("cpp", "python")
    for language in languages:
        before: list[str] = []
        after: list[str] = []
        for path, file in sorted(was.items()):
            other = is_now.get(files.get(path, path))
            if file.kind == language and other is not None and other.id != file.id:
                before.append(read(file).decode("utf-8", "replace"))
                after.append(read(other).decode("utf-8", "replace"))
        if before and sum(map(len, before)) + sum(map(len, after)) <= _LONGEST_TEXT:
            texts = "\n".join(before), "\n".join(after)
            found.update({**propose_moves(*texts, language), **propose_renames(*texts, language)})
    return found


def make_digest_row(state: PackageState, facts: Mapping[str, Any], before: Before | None = None) -> tuple[bytes, bytes]:
    """The key of a state and its digest, packed; an empty one of code that is nested beyond all reason: it must not end
    the run."""
    try:
        return state.key, _pack_digest(digest_package(state, facts, before))
    except RecursionError:
        if before is not None:
            before.code = None
        return state.key, _pack_digest(EMPTY)


def _pack_digest(digest: PackageStatements) -> bytes:
    """A digest as it is kept. Names of bytes that are no UTF-8, which msgpack cannot carry, are kept as they are
    shown."""
    try:
        return pack(msgspec.msgpack.encode(digest))
    except UnicodeEncodeError:
        return pack(msgspec.msgpack.encode(_make_visible(msgspec.to_builtins(digest))))


def make_unread_digest(state: PackageState) -> tuple[bytes, bytes]:
    """What stands for the digest of a state that could not be made: all its files count as not read."""
    files = tuple(file.path for file in state.files)
    return state.key, _pack_digest(msgspec.structs.replace(EMPTY, unread=files))


def _make_visible(value: Any) -> Any:
    if isinstance(value, str):
        return escape(value)
    if isinstance(value, (list, tuple)):
        return [_make_visible(item) for item in value]
    if isinstance(value, dict):
        return {_make_visible(key): _make_visible(item) for key, item in value.items()}
    return value


def decode_digest(data: bytes | None) -> PackageStatements:
    """A digest as it was packed; an empty one where that cannot be read."""
    if data is None:
        return EMPTY
    try:
        return _decoder.decode(unpack(data))
    except (ValueError, msgspec.MsgspecError):
        return EMPTY


class Digests:
    """Digests by the keys of the states they are of, packed until they are asked for."""

    def __init__(self, store: Store):
        self._store = store
        self.packed: dict[bytes, bytes] = {}

    def load(self, keys: Iterable[bytes]) -> dict[bytes, bytes]:
        """All that are known, those of these keys that the store has among them."""
        wanted = {key + compute_stamp(__name__): key for key in keys if key not in self.packed}
        for row, data in self._store.find_memos("digest", wanted).items():
            self.packed[wanted[row]] = pack(data)
        return self.packed

    def add(self, rows: Iterable[tuple[bytes, bytes]], lost: Iterable[tuple[bytes, bytes]] = ()) -> None:
        """Takes in keys and packed digests, and those that could not be made, which are not remembered."""
        made = dict(rows)
        self.packed.update(made)
        self.packed.update(lost)
        self._store.remember("digest", [(key + compute_stamp(__name__), unpack(data)) for key, data in made.items()])

    def decode_state(self, key: bytes) -> PackageStatements:
        """The digest of the state with this key."""
        return decode_digest(self.packed.get(key))


@cache
def compute_stamp(module: str) -> bytes:
    """Changes whenever the code does that makes facts, joins them, or compares, or the data; module: what does so."""
    code = compute_source_key(module, join.__name__)
    found = f"{code} {make_overall_version()} {compute_data_version()} {format_limits()}"
    return hashlib.sha1(found.encode()).digest()[:8]
