"""Builds a file of surfaces: what released versions of packages offer, read from clones at their tags.

One job for the clones that have versions of the same packages, in processes of joblib or on a Dask cluster
(cluster.py). What a job gives is kept in a file beside the output, so that a run that was stopped goes on from there; a
job is done anew when its tags, the packages asked for or the code have changed.
"""

from __future__ import annotations

import os
import sqlite3
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, Literal, NamedTuple

from ..edges.files import check_writable_path
from ..impact.targets.distro.distro import DistroTarget, TargetError
from ..impact.targets.distro.known import list_known_distros
from ..impact.targets.snapshot import Snapshot, load_snapshot
from ..impact.targets.surface.store import SurfaceHistory
from ..impact.targets.version import parse
from .jobs import CloneState, Job, Result, run
from .surface.clones import Clone, Clones, DistroVersion, Version
from .surface_file import Packed, read_packages, write

Versions = Literal["newest", "all"]
"""Which versions are read: those that distros have, or all that they ever had."""


class BuiltSurfaces(NamedTuple):
    """What was written. missing: packages asked for by a distro that no clone has, with the distro. approximate:
    packages with versions that a branch stands for."""

    packages: int
    versions: int
    missing: tuple[str, ...]
    approximate: int
    failed: tuple[str, ...]


def plan(
    clones: Clones,
    distros: Sequence[str],
    packages: Iterable[str] = (),
    versions: Versions = "newest",
    data: Snapshot | None = None,
) -> tuple[list[Job], tuple[str, ...]]:
    """The jobs that read what distros have (`newest`) or ever had (`all`) of packages, and what no clone has (`package
    version distro`). Without packages all that the distros released. Raises TargetError for an unknown distro."""
    data = data or load_snapshot()
    asked = frozenset(packages)
    # A package of ROS 1 and one of ROS 2 may have the same name and version, and come from two repositories.
    found: dict[tuple[str, str, int], Version] = {}
    missing: list[str] = []
    for distro in distros:
        target = DistroTarget(distro, data=data)
        tagged: set[str] = set()
        for package, release in (_list_released if versions == "all" else _list_newest)(target, data):
            if asked and package not in asked:
                continue
            key = package, release.version, target.ros
            state = found.get(key)
            if state is None or state.approximate:
                state = next(clones.find_candidates(package, release), state)
            if state is None or (state.approximate and package in tagged):
                # The distro's version before it stands for it better than a branch does, which may be years older.
                missing.append(f"{package} {release.version} {distro}")
                continue
            if not state.approximate:
                tagged.add(package)
            if key not in found or not state.approximate:
                found[key] = state
    return _make_jobs(found), tuple(missing)


def _list_newest(target: DistroTarget, data: Snapshot) -> Iterator[tuple[str, DistroVersion]]:
    """What a distro has of each package."""
    for package in sorted(target.list_released()):
        home, version = target.find_repository(package), target.find_version(package)
        if home is not None and version is not None:
            _, url, branch = home
            yield package, DistroVersion(target.distro, version, (url,) if url else (), branch)


def _list_released(target: DistroTarget, data: Snapshot) -> Iterator[tuple[str, DistroVersion]]:
    """What a distro ever had of each package."""
    urls: dict[int, dict[str, None]] = {}
    branches: dict[int, str] = {}
    for repository, url, branch in data.fetch(
        "SELECT s.repository, u.text, s.branch FROM source s JOIN distro d ON d.id = s.distro"
        " JOIN url u ON u.id = s.url WHERE d.name = ? ORDER BY s.ts DESC",
        (target.distro,),
    ):
        urls.setdefault(repository, {})[url] = None
        branches.setdefault(repository, branch or "")
    reported = set()
    for repository, version, names in data.fetch(
        "SELECT r.repository, r.version, p.names FROM release r JOIN distro d ON d.id = r.distro"
        " JOIN packages p ON p.id = r.packages WHERE d.name = ? AND r.version IS NOT NULL ORDER BY r.ts",
        (target.distro,),
    ):
        plain = version.partition("-")[0]
        for package in names.split(" "):
            if (package, plain) not in reported:
                reported.add((package, plain))
                release = DistroVersion(target.distro, plain, tuple(
                    urls.get(repository, ())
                ), branches.get(repository, ""),
                                  target.find_version(package) != plain)  # fmt: skip
                yield package, release


def _make_jobs(found: Mapping[tuple[str, str, int], Version]) -> list[Job]:
    """States of packages, by name, version and ROS generation, each as often as it differs in who has it; one job has
    all states of a package, and those of all that is in one of them."""
    import networkx as nx

    clones: dict[str, Clone] = {}
    states: dict[CloneState, list[str]] = {}
    together = nx.Graph()
    sharing: dict[tuple[str, str, str, str], list[int]] = {}
    for (package, version, ros), (clone, revision, *_) in found.items():
        sharing.setdefault((package, version, clone.name, revision), []).append(ros)
    for (package, version, ros), (clone, revision, _, approximate) in found.items():
        clones[clone.name] = clone
        whose = tuple(sorted(sharing[package, version, clone.name, revision]))
        if ros != whose[0]:
            continue  # the same state for both, which is read once
        state = CloneState(version, os.path.abspath(clone.place), clone.name, revision, approximate, (), whose)
        states.setdefault(state, []).append(package)
        together.add_edge((clone.name, revision), package)
    number_of = {
        node: number
        for number, nodes in enumerate(nx.connected_components(together))
        for node in sorted(nodes, key=str)
    }
    grouped: dict[int, list[CloneState]] = {}
    for state, packages in states.items():
        grouped.setdefault(number_of[state.clone, state.revision], []).append(
            state._replace(packages=tuple(sorted(packages)))
        )
    jobs = []
    for group in grouped.values():
        order = tuple(sorted(group, key=lambda state: (parse(state.version), state)))
        name = Counter(state.clone for state in order).most_common(1)[0][0]
        jobs.append(Job(name, order, tuple(clones[state.clone].find_folder_id(state.revision) for state in order)))
    return sorted(jobs)


def build(
    clones: Clones,
    distros: Sequence[str],
    output: Path,
    packages: Iterable[str] = (),
    jobs: int | None = None,
    progress: Callable[[str, int, int], None] | None = None,
    *,
    versions: Versions = "newest",
    dask: str | None = None,
    onto: Path | None = None,
) -> BuiltSurfaces:
    """Reads what is asked for, as plan() has it, and writes it. onto: a file of surfaces whose packages are written
    too; of a package that is read now, the history that has more versions. jobs: processes, all cores when None.
    progress: called with (clone, done, total). dask: address of a scheduler whose workers do the jobs instead. What was
    done stays in `OUTPUT.work` when an error or KeyboardInterrupt passes through; it is removed at the end. Raises
    TargetError, OSError, StoredSurfacesError, and ClusterError."""
    written, older = read_packages(onto) if onto else ({}, ())
    todo, missing = plan(clones, distros, packages, versions)
    work = output.with_name(f"{output.name}.work")
    for file in (output, work):
        check_writable_path(file)
    output.parent.mkdir(parents=True, exist_ok=True)
    failed: list[str] = []
    with closing(sqlite3.connect(work)) as db:
        db.execute("CREATE TABLE IF NOT EXISTS done(key TEXT PRIMARY KEY, failed TEXT)")
        db.execute(
            "CREATE TABLE IF NOT EXISTS part"
            "(key TEXT, package TEXT, ros INTEGER, data BLOB, changes BLOB, includes BLOB,"
            " PRIMARY KEY(key, package, ros))"
        )
        keys = {job.compute_key(): job for job in todo}
        done = {key for (key,) in db.execute("SELECT key FROM done") if key in keys}
        left = [job for key, job in keys.items() if key not in done]
        left.sort(key=lambda job: -len(job.states))
        with closing(_run_jobs(left, jobs, dask)) as ended:
            for number, (job, result) in enumerate(ended, len(done) + 1):
                rows = ((job.compute_key(), *whose, *packed) for whose, packed in result.packages.items())
                db.executemany("INSERT OR REPLACE INTO part VALUES(?, ?, ?, ?, ?, ?)", rows)
                db.execute("INSERT OR REPLACE INTO done VALUES(?, ?)", (job.compute_key(), "\n".join(result.failed)))
                db.commit()
                if progress is not None:
                    progress(job.name, number, len(todo))
        for key in keys:
            for package, ros, *columns in db.execute(
                "SELECT package, ros, data, changes, includes FROM part WHERE key = ?", (key,)
            ):
                packed, stored = Packed(*columns), written.get((package, ros))
                if stored is None or _count_versions(package, packed) >= _count_versions(package, stored):
                    written[package, ros] = packed
            (why,) = db.execute("SELECT failed FROM done WHERE key = ?", (key,)).fetchone()
            failed += why.split("\n") if why else []
    about = write(output, written, list(dict.fromkeys((*older, *distros))), load_snapshot().date)
    work.unlink()
    histories = (SurfaceHistory(package, packed.data, packed.includes) for (package, _), packed in written.items())
    approximate = {history.package for history in histories if history.approximate}
    return BuiltSurfaces(about.packages, about.versions, missing, len(approximate), tuple(failed))


def _count_versions(package: str, packed: Packed) -> int:
    return len(SurfaceHistory(package, packed.data, packed.includes).versions)


def _run_jobs(todo: list[Job], jobs: int | None, dask: str | None) -> Generator[tuple[Job, Result], None, None]:
    """Jobs with their results as they end."""
    if dask is not None and todo:
        from .cluster import run_on_cluster

        yield from run_on_cluster(dask, todo)
        return
    from joblib import Parallel, delayed

    if jobs == 1 or len(todo) < 2:
        yield from ((job, run(job)) for job in todo)
        return
    parallel: Any = Parallel(n_jobs=jobs or -1, return_as="generator_unordered", pre_dispatch="2*n_jobs")
    yield from parallel(delayed(_run_with_job)(job) for job in todo)


def _run_with_job(job: Job) -> tuple[Job, Result]:
    return job, run(job)


def list_distros(names: Sequence[str]) -> tuple[str, ...]:
    """The distros asked for, each once. Raises TargetError for one that is not known."""
    known = {distro.name for distro in list_known_distros()}
    for name in names:
        if name not in known:
            raise TargetError(f"`{name}` is no distro; known are {', '.join(sorted(known))}")
    return tuple(dict.fromkeys(names))
