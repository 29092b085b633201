"""Builds a file of surfaces: what released versions of packages offer, read from clones at their tags.

One job for each clone, in processes of joblib or whatever joblib is told to run. What a job gives is kept in a file
beside the output, so that a run that was stopped goes on from there; a job is done anew when its tags, the packages
asked for or the code have changed.
"""

from __future__ import annotations

import hashlib
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

from ..facts.store import Store
from ..tree import TreeError
from .build_surface_changes import Lines
from .clones import Clone, Clones, VersionError
from .distro import DistroTarget, TargetError, known_distros
from .snapshot import Snapshot, default
from .surface import State, surfaces_of
from .surface_changes import unpack
from .surface_store import History, Packed, Stored, pack, write
from .version import parts


class Wanted(NamedTuple):
    """A state of a clone. packages: those whose version it stands for. generations: of ROS that have it."""

    version: str
    revision: str
    approximate: bool
    packages: tuple[str, ...]
    generations: tuple[int, ...]


class Job(NamedTuple):
    """What one worker does: the states of one clone. Everything in it can be sent to another machine that sees the
    same clones."""

    place: str
    name: str
    states: tuple[Wanted, ...]
    trees: tuple[str, ...]

    def key(self) -> str:
        """Changes with all that the result depends on."""
        from ..cache import code_stamp

        return hashlib.sha1(repr((self.name, self.states, self.trees, code_stamp())).encode()).hexdigest()


class Result(NamedTuple):
    """packages: packed versions by package. failed: what could not be read, a line each."""

    packages: dict[str, Packed]
    failed: tuple[str, ...]


class Built(NamedTuple):
    """What was written. missing: packages asked for by a distro that no clone has, with the distro. approximate:
    packages with versions that a branch stands for."""

    packages: int
    versions: int
    missing: tuple[str, ...]
    approximate: int
    failed: tuple[str, ...]


def plan(
    clones: Clones, distros: Sequence[str], packages: Iterable[str] = (), data: Snapshot | None = None
) -> tuple[list[Job], tuple[str, ...]]:
    """The jobs that read the newest versions of packages in distros, and what no clone has (`package distro`). Without
    packages all that the distros released. Raises TargetError for an unknown distro."""
    data = data or default()
    asked = frozenset(packages)
    states: dict[str, dict[tuple[str, str, bool], set[str]]] = {}
    generations: dict[tuple[str, str], set[int]] = {}
    opened: dict[str, Clone] = {}
    missing: list[str] = []
    by_repository: dict[tuple[str, str, str], tuple[Clone, str, bool] | None] = {}
    for distro in distros:
        target = DistroTarget(distro, data=data)
        for package in sorted(target.released_names()):
            if asked and package not in asked:
                continue
            home, version = target.repository(package), target.version(package)
            if home is None or version is None:
                continue
            key = (distro, home[0], version)
            if key not in by_repository:
                try:
                    found = next(clones.find(package, distro), None)
                except VersionError:
                    found = None
                by_repository[key] = None if found is None else (found.clone, found.revision, found.approximate)
            known = by_repository[key]
            if known is None:
                missing.append(f"{package} {distro}")
                continue
            clone, revision, approximate = known
            opened[clone.name] = clone
            state = version, revision, approximate
            states.setdefault(clone.name, {}).setdefault(state, set()).add(package)
            generations.setdefault((clone.name, revision), set()).add(target.ros)
    jobs = []
    for name in sorted(states):
        order = sorted(states[name], key=lambda state: (parts(state[0]), state))
        wanted = tuple(
            Wanted(*state, tuple(sorted(states[name][state])), tuple(sorted(generations[name, state[1]])))
            for state in order
        )
        trees = tuple(opened[name].folder_id(state.revision) for state in wanted)
        jobs.append(Job(str(opened[name].place), name, wanted, trees))
    return jobs, tuple(missing)


def run(job: Job) -> Result:
    """Does a job, in whatever process: reads each state once and packs the versions of each package."""
    clone = Clone(Path(job.place), job.name)
    found: dict[str, list[Stored]] = {}
    failed: list[str] = []
    read: dict[str, State] = {}
    lines = Lines()
    with Store() as store:
        for state, tree in zip(job.states, job.trees, strict=True):
            if tree not in read:
                read.clear()  # one state at a time is enough
                try:
                    read[tree] = State(surfaces_of(clone.tree(state.revision), store, 1))
                except (TreeError, OSError) as error:
                    failed.append(f"{job.name} {state.version}: {error}")
                    continue
            for package in state.packages:
                surface = read[tree].surfaces.get(package)
                if surface is not None:
                    found.setdefault(package, []).append(Stored(state.version, state.approximate, surface))
                    lines.add(package, state.version, state.generations, read[tree], state.approximate)
                elif not state.approximate:
                    failed.append(f"{package} {state.version}: not in {job.name} at its tag")
    changes = lines.packed()
    return Result(
        {package: Packed(pack(versions), changes[package]) for package, versions in found.items()}, tuple(failed)
    )


def build(
    clones: Clones,
    distros: Sequence[str],
    output: Path,
    packages: Iterable[str] = (),
    jobs: int | None = None,
    progress: Callable[[str, int, int], None] | None = None,
) -> Built:
    """Reads what is asked for and writes it. jobs: processes, all cores when None. progress: called with (clone, done,
    total). What was done stays in `OUTPUT.work` when KeyboardInterrupt passes through; it is removed at the end.
    Raises TargetError, OSError."""
    todo, missing = plan(clones, distros, packages)
    output.parent.mkdir(parents=True, exist_ok=True)
    work = output.with_name(f"{output.name}.work")
    failed: list[str] = []
    with closing(sqlite3.connect(work)) as db:
        db.execute("CREATE TABLE IF NOT EXISTS done(key TEXT PRIMARY KEY, failed TEXT)")
        db.execute(
            "CREATE TABLE IF NOT EXISTS part"
            "(key TEXT, package TEXT, data BLOB, changes BLOB, PRIMARY KEY(key, package))"
        )
        keys = {job.key(): job for job in todo}
        done = {key for (key,) in db.execute("SELECT key FROM done") if key in keys}
        left = [job for key, job in keys.items() if key not in done]
        left.sort(key=lambda job: -len(job.states))
        for number, (job, result) in enumerate(_results(left, jobs), len(done) + 1):
            rows = ((job.key(), package, *packed) for package, packed in result.packages.items())
            db.executemany("INSERT OR REPLACE INTO part VALUES(?, ?, ?, ?)", rows)
            db.execute("INSERT OR REPLACE INTO done VALUES(?, ?)", (job.key(), "\n".join(result.failed)))
            db.commit()
            if progress is not None:
                progress(job.name, number, len(todo))
        found: dict[str, list[Packed]] = {}
        for key in keys:
            for package, *packed in db.execute("SELECT package, data, changes FROM part WHERE key = ?", (key,)):
                found.setdefault(package, []).append(Packed(*packed))
            (why,) = db.execute("SELECT failed FROM done WHERE key = ?", (key,)).fetchone()
            failed += why.split("\n") if why else []
    written = {package: _merged(package, each) for package, each in found.items()}
    write(output, written)
    work.unlink()
    histories = [History(package, packed.data) for package, packed in written.items()]
    versions = sum(len(history.versions) for history in histories)
    approximate = sum(bool(history.approximate) for history in histories)
    return Built(len(written), versions, missing, approximate, tuple(failed))


def _results(todo: list[Job], jobs: int | None) -> Iterator[tuple[Job, Result]]:
    """Jobs with their results as they end."""
    from joblib import Parallel, delayed

    if jobs == 1 or len(todo) < 2:
        yield from ((job, run(job)) for job in todo)
        return
    parallel: Any = Parallel(n_jobs=jobs or -1, return_as="generator_unordered", pre_dispatch="2*n_jobs")
    yield from parallel(delayed(_with_job)(job) for job in todo)


def _with_job(job: Job) -> tuple[Job, Result]:
    return job, run(job)


def _merged(package: str, packed: list[Packed]) -> Packed:
    """The versions of a package that several clones gave, as one."""
    if len(packed) == 1:
        return packed[0]
    generations: dict[str, set[int]] = {}
    for one in packed:
        for generation, line in unpack(one.changes).items():
            for version in line.versions:
                generations.setdefault(version, set()).add(generation)
    stored = {one.version: one for each in packed for one in History(package, each.data).stored()}
    lines = Lines()
    for version in sorted(stored, key=parts):
        one = stored[version]
        state = State({package: one.surface})  # what went to another package counts as gone
        lines.add(package, version, sorted(generations.get(version, ())), state, one.approximate)
    return Packed(pack(stored.values()), lines.packed()[package])


def all_distros(names: Sequence[str]) -> tuple[str, ...]:
    """The distros asked for, each once. Raises TargetError for one that is not known."""
    known = {distro.name for distro in known_distros()}
    for name in names:
        if name not in known:
            raise TargetError(f"`{name}` is no distro; known are {', '.join(sorted(known))}")
    return tuple(dict.fromkeys(names))
