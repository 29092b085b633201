"""`rosimpact data`: build the snapshot from git repositories, refresh it from the network, tell its date."""

import contextlib
import datetime
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ..edges.files import check_writable_path, read_file, write_file
from ..edges.limits import get_limits
from ..impact.cache import cache_folder
from ..impact.targets import snapshot as snapshots
from ..impact.targets.snapshot import Snapshot
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA, find_updated_folder, read_fetched, read_manifest
from .git import BuildError, Report
from .write import DistroRow, Sync

__all__ = ["BuildError", "BuiltSnapshot", "Status", "TablesStatus", "Updated", "build", "read_status", "update"]

_SAVE_EVERY = 2000


class BuiltSnapshot(NamedTuple):
    """What a build gave: sizes in bytes and counts, and per distro how many file versions could not be read."""

    date: str
    packed: int
    unpacked: int
    releases: int
    manifests: int
    rules: int
    unreadable: dict[str, int]


class TablesStatus(NamedTuple):
    """Which tables are in use. date: of their manifest; empty where there is none. updated: those that are not as
    shipped. unused: why those that `data update --from` fetched are not in use, as a clause; empty without any."""

    date: str
    updated: tuple[str, ...]
    unused: str


class Status(NamedTuple):
    """What data is in use. sources: repository → commit. folder: where it lies; updated: it is not the shipped one.

    last_syncs: newest sync known for each distro that has any; packed: bytes. surfaces: what is in use of
    them (see surface_store.About).
    """

    date: str
    sources: dict[str, str]
    folder: Path
    updated: bool
    packed: int
    last_syncs: dict[str, str]
    surfaces: dict[str, Any]
    tables: TablesStatus


class Updated(NamedTuple):
    """What an update brought, and the folder it was written to."""

    date: str
    folder: Path
    syncs: tuple[str, ...]
    releases: int
    manifests: int
    rules: int
    failures: tuple[str, ...]


def read_status(snapshot: Snapshot | None = None) -> Status:
    """Date and origin of the data in use. Raises SnapshotError when it cannot be read."""
    used = snapshot or snapshots.load_snapshot()
    return Status(
        used.date,
        dict(used.info.sources),
        used.data,
        used.data != DATA,
        (used.data / "distros.sqlite.zst").stat().st_size,
        dict(used.fetch("SELECT d.name, max(s.day) FROM sync s JOIN distro d ON d.id = s.distro GROUP BY d.id")),
        load_shipped().about._asdict(),
        _read_tables_status(),
    )


def _read_tables_status() -> TablesStatus:
    fetched, shipped = read_fetched(), None
    with contextlib.suppress(OSError, ValueError):  # a folder that ROSIMPACT_DATA names may have none
        shipped = read_manifest(DATA)
    if fetched is None or fetched.manifest is None or fetched.unused:
        return TablesStatus(shipped.date if shipped else "", (), fetched.unused if fetched is not None else "")
    before = shipped.tables if shipped else {}
    updated = tuple(name for name, table in fetched.manifest.tables.items() if before.get(name) != table)
    return TablesStatus(fetched.manifest.date, updated, "")


def update(
    output: Path | None = None,
    snapshot: Snapshot | None = None,
    index_url: str | None = None,
    sync_days: Callable[[str], Iterable[str]] | None = None,
    report: Report | None = None,
) -> Updated:
    """Adds what is newer than the data in use, over the network, and writes the result to the user's cache.

    output: another folder to write to. index_url: rosdistro's index with `{ref}` for the branch or tag. sync_days:
    gives the days of a distro's sync tags. Raises BuildError when there is no network; the data in use then stays.
    """
    from . import refresh, write

    used = snapshot or snapshots.load_snapshot()
    try:
        raw, found = refresh.refresh_database(
            used.unpack(),
            index_url or refresh.INDEX,
            sync_days or refresh.fetch_sync_days,
            report,
        )
    except BuildError as error:
        raise BuildError(f"{error}; the data of {used.date} stays in use") from None
    folder = output or find_updated_folder()
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    write.write_snapshot(raw, today, {**used.info.sources, "updated from": used.date}, folder)
    return Updated(today, folder, found.syncs, found.releases, found.manifests, found.rules, found.failures)


def build(
    rosdistro: Path,
    output: Path,
    work: Path | None = None,
    meta_ros: Path | None = None,
    report: Report | None = None,
) -> BuiltSnapshot:
    """Builds the snapshot from a clone of ros/rosdistro (bare or not, with its tags) and, where given, of ros/meta-ros.

    output: the data folder to write into. work: a folder for what was read so far (None: one in the user's cache); a
    second run with it continues, also with a newer clone. Raises BuildError when a repository is unusable.
    """
    from ..impact.targets.distro.distro import make_version_key
    from . import git, keys, manifests, releases, write

    tell = report or (lambda what, done, total: None)
    repository = git.open_repository(rosdistro)
    if repository.head_is_unborn:
        raise BuildError(f"{rosdistro} has no commits")
    head = repository[repository.head.target]
    distros = _index(repository, head, rosdistro)
    line = git.read_first_parents(repository, head)
    wanted = {row.name: releases.list_distribution_paths(row.name) for row in distros}
    wanted.update({path: (path,) for path in keys.FILES})
    versions = git.read_file_versions(repository, line, wanted, tell)
    syncs = _find_syncs(repository, line, versions, wanted)

    def read_blob(oid: str) -> bytes:
        return repository[oid].data

    work = work or cache_folder() / "build"
    for file in (work / "x.history", *(output / name for name in write.FILES)):
        check_writable_path(file)
    histories = {}
    for row in distros:
        path = work / f"{row.name}.history"
        history = _load(path, releases.DistroHistory)
        total = len(versions[row.name])
        while history is None or history.read != total or history.last != _get_last_blob(versions[row.name]):
            tell(f"reading {row.name}", history.read if history else 0, total)
            history = releases.read_history(versions[row.name], read_blob, history, _SAVE_EVERY)
            _save(path, history)
            if history.read >= total:
                break
        histories[row.name] = history or releases.DistroHistory()
    rule_files = {path: versions[path] for path in keys.FILES}
    count = sum(map(len, rule_files.values()))
    rules = keys.read_rules(rule_files, read_blob, lambda done: tell("reading rosdep rules", done, count))
    declared: list[manifests.DeclaredVersion] = []
    sources = {"ros/rosdistro": str(head.id)}
    if meta_ros is not None:
        caches = git.open_repository(meta_ros)
        sources["ros/meta-ros"] = str(caches.revparse_single("HEAD").id)
        found = manifests.cache_blobs(caches, lambda done: tell("reading commits of meta-ros", done, 0))
        for number, (distro, blobs) in enumerate(sorted(found.items())):
            tell(f"reading caches of {distro}", number, len(found))
            declared.extend(manifests.read_caches(distro, (caches[oid].data for oid in blobs)))
    known = manifests.changes_only(declared, make_version_key)
    date = _format_day(head.commit_time)
    data = write.SnapshotData(date, sources, distros, histories, syncs, rules, known)
    tell("writing", 0, 0)
    raw = write.build_database(data)
    packed = write.write_snapshot(raw, date, sources, output)
    return BuiltSnapshot(
        date,
        packed,
        len(raw),
        sum(len(history.events) for history in histories.values()),
        len(known),
        len(rules),
        {name: len(history.unreadable) for name, history in histories.items() if history.unreadable},
    )


def _find_syncs(repository, line, versions: dict, wanted: dict) -> list[Sync]:
    """The syncs that tags such as `humble/2024-03-01` name; what was tagged beside the line is put into `versions`."""
    from . import git

    cuts = dict(line.commits)
    syncs = []
    for name, oid, ts in git.list_tags(repository):
        distro, _, day = name.partition("/")
        if distro not in wanted or not day:
            continue
        cut = git.find_on_line(repository, oid, cuts)
        if cut is not None and oid not in cuts:
            versions[distro] = git.insert_side_version(repository, versions[distro], oid, cut, wanted[distro])
        # `noetic/final` names no day.
        syncs.append(Sync(distro, day[:10] if _is_day(day) else _format_day(ts), ts if cut is None else cut))
    return sorted(syncs)


def _get_last_blob(versions: list) -> str:
    return versions[-1].blob if versions else ""


def _load(path: Path, kind: type) -> Any:
    try:
        return msgspec.msgpack.decode(read_file(path, get_limits().report), type=kind)
    except (OSError, msgspec.MsgspecError):
        return None


def _save(path: Path, value: object) -> None:
    write_file(path, msgspec.msgpack.encode(value))


def _format_day(ts: int) -> str:
    return datetime.datetime.fromtimestamp(ts, datetime.timezone.utc).date().isoformat()


def _is_day(text: str) -> bool:
    try:
        datetime.date.fromisoformat(text[:10])
    except ValueError:
        return False
    return True


def _index(repository, head, path: Path) -> list[DistroRow]:
    """The distros of rosdistro's index-v4.yaml."""
    import yaml

    if "index-v4.yaml" not in head.tree:
        raise BuildError(f"{path} has no index-v4.yaml: a clone of ros/rosdistro is needed")
    index = yaml.safe_load(head.tree["index-v4.yaml"].data)
    return [
        DistroRow(
            name,
            2 if entry.get("distribution_type") == "ros2" else 1,
            int(entry.get("python_version") or 3),
            str(entry.get("distribution_status") or ""),
        )
        for name, entry in sorted(index["distributions"].items())
    ]
