"""A Dask scheduler and workers for the tests, each the main function of a process of its own, which ends when the
other end of its pipe is closed."""

import asyncio
import os
import threading
import time
from contextlib import closing

from late import Late
from rosimpact.databuild import cluster, jobs

dask, distributed = Late("dask"), Late("distributed")
QUIET = {"host": "127.0.0.1", "dashboard_address": ":0"}


def scheduler(pipe, failures):
    """Sends its address. failures: how many workers may die of a job before it is given up."""
    _end_with(pipe)
    dask.config.set({"distributed.scheduler.allowed-failures": failures})

    async def run():
        async with distributed.Scheduler(port=0, **QUIET) as it:
            pipe.send(it.address)
            await it.finished()

    asyncio.run(run())


def worker(pipe, address, name, folder, hold, digest):
    """Writes to folder/journal what it begins and ends. hold: the number of the job before which it waits until there
    is folder/go. digest: of the code that it says it has. A job of a clone called `deadly` ends its process."""
    _end_with(pipe)
    os.environ["ROSIMPACT_CACHE"] = str(folder / "cache")
    begun = 0
    real = jobs.run

    def write(what, job):
        with (folder / "journal").open("a") as journal:
            journal.write(f"{what} {name} {job.name}\n")

    def run(job):
        nonlocal begun
        begun += 1
        write("begin", job)
        if job.name == "deadly":
            os._exit(1)
        while begun == hold and not (folder / "go").exists():
            time.sleep(0.01)
        result = real(job)
        write("end", job)
        return result

    async def work():
        async with distributed.Worker(address, name=name, nthreads=1, local_directory=folder, **QUIET) as it:
            await it.finished()

    jobs.run = run
    if digest:
        cluster.compute_code_digest = lambda: digest
    asyncio.run(work())


def _end_with(pipe):
    def wait():
        with closing(pipe):
            try:
                pipe.recv()
            except EOFError:
                os._exit(0)

    threading.Thread(target=wait, daemon=True).start()
