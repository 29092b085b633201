"""The jobs of surfaces.py on the workers of a Dask cluster that is there already.

Futures of `distributed`, not joblib's dask backend: joblib ends a whole run when one job ends its workers, and cannot
say which. A job of a worker that died is done again by another (the scheduler's part); each result is fetched as soon
as it is there, so that a worker takes nothing with it that was given away already.

Jobs and results travel as distributed packs them, pickles among them: only between processes of a cluster whose address
the user gave, and never by way of a file.
"""

from __future__ import annotations

import hashlib
import sys
import time
from collections.abc import Generator, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import edges, impact
from ..edges.console import UserError
from ..impact.tree import TreeError
from .surface.clones import Clone
from .surface.releases import find_git_directory

if TYPE_CHECKING:
    from .jobs import Job, Result

# Seconds to wait for the scheduler and for its first worker, and for another when the last one is gone.
_REACH = 5
_LOST = 30


@cache
def compute_code_digest() -> str:
    """The same on every machine that has the same checker and builder: names and contents of their files."""
    digest = hashlib.sha1()
    for root in (Path(impact.__path__[0]), Path(__file__).parent, Path(edges.__path__[0])):
        for path in sorted(root.rglob("*")):
            if path.suffix != ".pyc" and path.is_file():
                data = path.read_bytes()
                digest.update(f"{path.relative_to(root).as_posix()} {len(data)}\n".encode("utf-8", "surrogateescape"))
                digest.update(data)
    return digest.hexdigest()


class ClusterError(UserError):
    """A cluster that cannot do the work; the message says why and what to do."""


class CodeState(NamedTuple):
    """What the results of a process depend on, beside the clones. python: syntax trees differ between its versions."""

    version: str
    python: str
    digest: str

    @classmethod
    def detect(cls) -> CodeState:
        from ..edges.version import __version__

        return cls(__version__, "{}.{}".format(*sys.version_info), compute_code_digest())

    def __str__(self) -> str:
        return f"rosimpact {self.version} ({self.digest[:8]}) on Python {self.python}"


def run_on_cluster(address: str, jobs: Sequence[Job]) -> Generator[tuple[Job, Result], None, None]:
    """The jobs with their results as they end, each once. address: of a Dask scheduler, such as tcp://host:8786. The
    cluster lets go of what is not done yet when the iterator is closed.

    A job that its workers do not survive has a result that says so. Raises ClusterError: `distributed` is not
    installed, nobody answers, a worker has other code or does not see the clones as they are here."""
    try:
        import distributed
        from distributed.comm.addressing import resolve_address
    except ImportError:
        raise ClusterError(
            "--dask: distributed is missing; install it with `pip install 'rosimpact[cluster]'`"
        ) from None
    import logging
    import warnings

    # It writes tracebacks for what is told in one line here, and tables about libraries that no job uses.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    try:
        resolve_address(address)  # a client of an address that is none cannot be closed
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            client = distributed.Client(address, timeout=_REACH, set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        raise ClusterError(f"--dask {address}: {error}; give the address of a running `dask scheduler`") from None
    try:
        code = CodeState.detect()
        _check(client, address, code, sorted({state.place for job in jobs for state in job.states}))
        yield from _iterate_results(client, address, code, jobs)
    finally:
        client.close()


def _check(client: Any, address: str, code: CodeState, places: list[str]) -> None:
    """Raises ClusterError unless there are workers and each can do the work."""
    try:
        client.wait_for_workers(1, timeout=_REACH)
    except TimeoutError:
        raise ClusterError(f"--dask {address}: has no workers; start some: `dask worker {address}`") from None
    found = client.run(_explain_unfit, code, places, on_error="return")
    unfit = {worker: _explain_refusal(each) for worker, each in found.items() if each}
    if unfit:
        worker = min(unfit)
        more = f" (and {len(unfit) - 1} more of {len(found)} workers)" if len(unfit) > 1 else ""
        raise ClusterError(f"--dask {address}: worker {worker}{more} {unfit[worker]}")


def _explain_refusal(answer: str | Exception) -> str:
    if isinstance(answer, str):
        return answer
    if "No module named" in str(answer) or "Can't get attribute" in str(answer):
        return "has no rosimpact, or an older one; install there what is installed here"
    return f"cannot work: {' '.join(str(answer).split())[:200]}"


def _explain_unfit(code: CodeState, places: Sequence[str]) -> str:
    """Why this process cannot do jobs on these clones, as the rest of a sentence; empty when it can."""
    if CodeState.detect() != code:
        return f"has {CodeState.detect()}, and here is {code}; install there what is installed here, and start it again"
    lacking = [place for place in places if find_git_directory(Path(place)) is None]
    if lacking:
        more = f" and {len(lacking) - 1} more of {len(places)} clones" if len(lacking) > 1 else ""
        return f"does not see {lacking[0]}{more}; give it the clones at the same path"
    return ""


def _run_job(code: CodeState, job: Job) -> Result | str:
    """Does a job on a worker; says why it cannot be done there. Workers come later too, and clones are fetched."""
    from .jobs import run

    places = sorted({state.place for state in job.states})
    why = _explain_unfit(code, places)
    if why:
        return why
    clones = {place: Clone(Path(place)) for place in places}
    for state, tree in zip(job.states, job.trees, strict=True):
        try:
            same = clones[state.place].find_folder_id(state.revision) == tree
        except TreeError:
            same = False
        if not same:
            return f"has another {state.revision} in {state.place}; `git fetch --tags` there"
    return run(job)


def _iterate_results(client: Any, address: str, code: CodeState, jobs: Sequence[Job]) -> Iterator[tuple[Job, Result]]:
    from distributed import as_completed

    running = {client.submit(_run_job, code, job, pure=False): job for job in jobs}
    ended = as_completed(running, loop=client.loop)
    while running:
        _wait(client, ended, address)
        for future in ended.next_batch(block=False):
            job = running.pop(future)
            yield job, _read_result(future, address, job)


def _read_result(future: Any, address: str, job: Job) -> Result:
    """What a future gave. Raises ClusterError, and what the job raised."""
    from concurrent.futures import CancelledError

    from distributed import KilledWorker

    from .jobs import Result

    try:
        result = future.result()
    except KilledWorker:
        return Result({}, (f"{job.name}: every worker that reads it dies, so it is left out",))
    except CancelledError:
        raise ClusterError(f"--dask {address}: the scheduler is gone; {_KEPT}") from None
    if isinstance(result, str):
        raise ClusterError(f"--dask {address}: a worker {result}; {_KEPT}")
    return result


_KEPT = "what was read is kept, and the next run continues from there"


def _wait(client: Any, ended: Any, address: str) -> None:
    """Returns when a job has ended. Raises ClusterError when nobody is left who could end one."""
    asked = seen = time.monotonic()
    while not ended.has_ready():
        time.sleep(0.02)
        now = time.monotonic()
        if now - asked > 1:
            asked = now
            if client.scheduler_info()["workers"]:
                seen = now
            elif now - seen > _LOST:
                raise ClusterError(f"--dask {address}: the last worker is gone; {_KEPT}")
