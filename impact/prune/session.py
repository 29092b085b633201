"""Pruning from a path: the plan, its diff, and writing it, to the workspace or to a copy, or back again."""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ...edges.console import UserError
from ...edges.documents import DocumentError, load_json
from ...edges.files import read_file, write_file
from ..analysis.fields import KnownMessages, open_fields
from ..analysis.fix import make_unified_diff
from ..model.fields.report import FieldReport
from ..model.fields.topics import TopicReader, extract_uses
from ..model.flow.workspace import get_flow
from ..tree.paths import Tree
from .planner import Planner, PrunePlan

JOURNAL = ".rosimpact-prune"
"""The folder in a workspace that keeps what --undo brings back."""
_RECORD = "record.json"
_MOST_BYTES = 100_000_000


class Prepared(NamedTuple):
    """A plan with the bytes of the files that it changes, as they are now. report: the fields that it rests on;
    ros: the generation of the workspace."""

    plan: PrunePlan
    originals: dict[str, bytes]
    report: FieldReport
    ros: int


class _Change(msgspec.Struct, frozen=True):
    """A file that was changed or created. digest: of what was written; saved: the file that holds what was there,
    empty for a new one."""

    path: str
    digest: str
    saved: str = ""


def prepare(
    path: Path, *, topics: Sequence[str] = (), length: int = 10, jobs: int | None = None, **given: Any
) -> Prepared:  # fmt: skip
    """What pruning the workspace at a path would change. topics: these alone. length: of strings and arrays, for sizes.
    The others as for open_fields(). Raises UserError with a text for the user."""
    with open_fields(path, jobs=jobs, **given) as opened:
        workspace, tree = opened.workspace, opened.tree
        reader = TopicReader(workspace, get_flow(workspace).code, opened.graph, extract_uses(workspace, jobs))
        report = opened.close_topics(reader.report(), topics)
        planner = Planner(
            workspace, reader, report, opened.select_closed(report), lambda each: _read(tree, each), length,
            KnownMessages(workspace, tree).find,
        )  # fmt: skip
        plan = planner.plan(topics)
    return Prepared(plan, {each: _read(tree, each) or b"" for each in plan.changed}, report, workspace.ros)


def _read(tree: Tree, path: str) -> bytes | None:
    try:
        return tree.read(path)
    except OSError:
        return None


def make_diff(prepared: Prepared) -> str:
    """All changes as a patch."""
    changed = [make_unified_diff(path, prepared.originals[path], data) for path, data in prepared.plan.changed.items()]
    created = [_show_new(path, data) for path, data in prepared.plan.created.items()]
    return "".join((*changed, *created))


def _show_new(path: str, data: bytes) -> str:
    lines = data.decode("utf-8", "surrogateescape").splitlines(keepends=True)
    body = "".join(f"+{line}" if line.endswith("\n") else f"+{line}\n\\ No newline at end of file\n" for line in lines)
    head = f"diff --git a/{path} b/{path}\nnew file mode 100644\n--- /dev/null\n+++ b/{path}\n"
    return f"{head}@@ -0,0 +1,{len(lines)} @@\n{body}"


def apply_plan(root: Path, prepared: Prepared) -> None:
    """Writes the changes to the workspace, all or none; what was there is kept for undo(). Raises UserError."""
    journal = root / JOURNAL
    if journal.exists():
        raise UserError(f"{journal}: an earlier pruning is kept here; take it back with --undo, or remove the folder")
    for path in prepared.plan.created:
        if (root / path).exists():
            raise UserError(f"{root / path}: is there already; move it away")
    journal.mkdir()
    rows: list[_Change] = []
    for number, (path, data) in enumerate(prepared.plan.changed.items()):
        saved = f"{number}.bytes"
        write_file(journal / saved, prepared.originals[path])
        rows.append(_Change(path, _digest(data), saved))
    rows += [_Change(path, _digest(data)) for path, data in prepared.plan.created.items()]
    write_file(journal / _RECORD, msgspec.json.encode(rows))
    try:
        for path, data in prepared.plan.created.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            write_file(root / path, data)
        for path, data in prepared.plan.changed.items():
            write_file(root / path, data, beneath=root, instead_of=prepared.originals[path])
    except OSError as error:
        _restore(root, rows, force=True)
        why = f"{error.filename or root}: cannot be written: {error.strerror or error}; nothing is changed"
        raise UserError(why) from None


def undo(root: Path) -> list[str]:
    """Takes the last pruning of a workspace back; gives the paths. Files that were changed since are left alone, and
    then nothing is done. Raises UserError."""
    journal = root / JOURNAL
    try:
        data = read_file(journal / _RECORD, _MOST_BYTES)
    except OSError:
        raise UserError(f"{root}: nothing was pruned here, or {JOURNAL} is gone; use your version control") from None
    try:
        load_json(data.decode())
        rows = msgspec.json.decode(data, type=list[_Change])
    except (DocumentError, UnicodeDecodeError, msgspec.MsgspecError) as error:
        raise UserError(f"{journal / _RECORD}: cannot be read: {error}; use your version control") from None
    for row in rows:
        if ".." in Path(row.path).parts or Path(row.path).is_absolute() or "/" in row.saved:
            raise UserError(f"{journal / _RECORD}: names a file outside of the workspace; use your version control")
        at = root / row.path
        if not at.is_file() or _digest(read_file(at, _MOST_BYTES)) != row.digest:
            raise UserError(f"{at}: was changed since; take that back first, or use your version control")
    _restore(root, rows, force=False)
    return [row.path for row in rows]


def _restore(root: Path, rows: Sequence[_Change], force: bool) -> None:
    for row in rows:
        at = root / row.path
        if row.saved:
            write_file(at, read_file(root / JOURNAL / row.saved, _MOST_BYTES))
        elif at.exists():
            at.unlink()
            if not any(at.parent.iterdir()):
                at.parent.rmdir()
    shutil.rmtree(root / JOURNAL)


def write_copy(root: Path, target: Path, prepared: Prepared) -> None:
    """Writes a copy of a workspace with the changes to a folder that is not there yet, or empty. Raises UserError."""
    if target.exists() and any(target.iterdir()):
        raise UserError(f"--out {target}: is not empty; name a new folder")
    skipped = shutil.ignore_patterns(".git", "build", "devel", "install", "log", JOURNAL)
    inside = os.path.realpath(target).startswith(os.path.realpath(root) + os.sep)
    if inside:
        raise UserError(f"--out {target}: lies in the workspace itself; name a folder elsewhere")
    try:
        shutil.copytree(root, target, symlinks=True, ignore=skipped, dirs_exist_ok=True)
        for path, data in {**prepared.plan.changed, **prepared.plan.created}.items():
            (target / path).parent.mkdir(parents=True, exist_ok=True)
            write_file(target / path, data)
    except (OSError, shutil.Error) as error:
        raise UserError(f"--out {target}: cannot be written: {error}") from None


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
