"""Surfaces built on a real Dask cluster: nothing is lost or done twice, whoever dies; what cannot work is refused."""

import multiprocessing
import sys
import time
from collections import Counter

import cluster_process
import pytest
from late import Late
from rosimpact.databuild import cluster
from rosimpact.databuild.cluster import ClusterError, run_on_cluster
from rosimpact.databuild.surface.clones import Clones
from rosimpact.databuild.surfaces import build, plan
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.surface.store import Surfaces
from test_build_surfaces import release

distributed = Late("distributed")
PACKAGES = {
    "rclcpp": "ros2+rclcpp",
    "cv_bridge": "ros-perception+vision_opencv",
    "angles": "ros+angles",
    "xacro": "ros+xacro",
    "pluginlib": "ros+pluginlib",
    "class_loader": "ros+class_loader",
    "filters": "ros+filters",
    "urdf": "ros2+urdf",
}
EVERYTHING = ("humble",), tuple(PACKAGES)


# Children of a process that has imported all they need: a tenth of the time that starting them anew takes.
PROCESSES = multiprocessing.get_context("forkserver")
PROCESSES.set_forkserver_preload(
    ["distributed", "rosimpact.databuild.cluster", "rosimpact.databuild.surface.package"]
)


class Cluster:
    """Processes of a cluster. address: of its scheduler. folder: see cluster_process.py."""

    def __init__(self, folder, failures):
        self.folder, self.pipes, self.processes = folder, [], []
        self.scheduler = self._start(cluster_process.scheduler, failures)
        assert self.pipes[0].poll(60)
        self.address = self.pipes[0].recv()

    def worker(self, name, hold=0, digest=""):
        return self._start(cluster_process.worker, self.address, name, self.folder, hold, digest)

    def _start(self, main, *arguments):
        ours, theirs = PROCESSES.Pipe()
        process = PROCESSES.Process(target=main, args=(theirs, *arguments), daemon=True)
        process.start()
        theirs.close()
        self.pipes.append(ours)
        self.processes.append(process)
        return process

    def ready(self, workers):
        """Waits until so many workers are there."""
        with distributed.Client(self.address, set_as_default=False) as client:
            client.wait_for_workers(workers, timeout=60)

    def journal(self, what):
        """(worker, clone) of all that began or ended."""
        journal = self.folder / "journal"
        lines = [line.split(" ", 2) for line in journal.read_text().splitlines()] if journal.exists() else []
        return [(worker, clone) for kind, worker, clone in lines if kind == what]

    def wait_for(self, condition):
        end = time.monotonic() + 60
        while not condition():
            assert time.monotonic() < end, f"never came; the journal has {self.journal('begin')}"
            time.sleep(0.01)

    def go(self):
        (self.folder / "go").touch()

    def end(self):
        for process in self.processes:
            process.kill()
        for process in self.processes:
            process.join()


@pytest.fixture
def start(tmp_path, monkeypatch):
    """Starts a cluster that ends with the test."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    (tmp_path / "cluster").mkdir()
    started = []

    def start(failures=3):
        started.append(Cluster(tmp_path / "cluster", failures))
        return started[-1]

    yield start
    for each in started:
        each.end()


@pytest.fixture
def clones(tmp_path):
    """Clones of eight repositories, each with the version that humble has."""
    for package, repository in PACKAGES.items():
        version = DistroTarget("humble").find_version(package)
        release(tmp_path / "clones" / repository, package, version, f"void of_{package}();")
    return Clones(tmp_path / "clones")


def local(clones, tmp_path):
    """What the same build gives on this machine."""
    build(clones, EVERYTHING[0], tmp_path / "local", EVERYTHING[1], 1)
    return (tmp_path / "local").read_bytes()


def test_a_worker_is_killed_in_the_middle(start, clones, tmp_path):
    cluster = start()
    doomed = cluster.worker("doomed", hold=2)
    cluster.worker("other", hold=3)
    cluster.ready(2)
    told = []

    def kill(name, done, total):
        told.append((name, done, total))
        if done == 3:  # the first job of the one and two of the other have come, and both begin one more
            cluster.wait_for(lambda: len(cluster.journal("begin")) == 5)
            doomed.kill()  # SIGKILL
            cluster.go()

    output = tmp_path / "surfaces"
    built = build(clones, EVERYTHING[0], output, EVERYTHING[1], progress=kill, dask=cluster.address)
    assert (built.packages, built.versions, built.missing) == (8, 8, ())
    assert output.read_bytes() == local(clones, tmp_path)
    # Every job has come once, and only the one that was being done when its worker died was begun again.
    assert [number for _, number, _ in told] == list(range(1, 9))
    names = {name for name, _, _ in told}
    assert len(names) == 8
    assert Counter(clone for _, clone in cluster.journal("end")) == Counter(names)
    begun = [clone for worker, clone in cluster.journal("begin") if worker == "doomed"]
    assert len(begun) == 2
    assert Counter(clone for _, clone in cluster.journal("begin")) - Counter(names) == Counter(begun[1:])


def test_a_stopped_run_goes_on(start, clones, tmp_path):
    cluster = start()
    for name in ("one", "two"):
        cluster.worker(name, hold=2)
    cluster.ready(2)
    came = []

    def stop(name, done, total):
        came.append(name)
        if done == 2:
            cluster.wait_for(lambda: len(cluster.journal("begin")) == 4)
            raise KeyboardInterrupt

    output = tmp_path / "surfaces"
    with pytest.raises(KeyboardInterrupt):
        build(clones, EVERYTHING[0], output, EVERYTHING[1], progress=stop, dask=cluster.address)
    assert not output.exists()
    cluster.go()
    later = []
    build(
        clones, EVERYTHING[0], output, EVERYTHING[1],
        progress=lambda name, done, total: later.append((name, done, total)), dask=cluster.address,
    )  # fmt: skip
    assert [told[1:] for told in later] == [(number, 8) for number in range(3, 9)]
    assert len({*came, *(name for name, _, _ in later)}) == 8
    assert output.read_bytes() == local(clones, tmp_path)
    begun = Counter(clone for _, clone in cluster.journal("begin"))
    assert [begun[name] for name in came] == [1, 1]
    # The cluster was let go of the rest: no more was begun than what was held, and what lay ready behind it.
    assert begun.total() <= 12


def test_the_scheduler_ends(start, clones, tmp_path):
    cluster = start()
    cluster.worker("one", hold=2)
    cluster.ready(1)
    output = tmp_path / "surfaces"
    with pytest.raises(ClusterError, match="the scheduler is gone; what was read is kept"):
        build(
            clones, EVERYTHING[0], output, EVERYTHING[1],
            progress=lambda *told: cluster.scheduler.kill(), dask=cluster.address,
        )  # fmt: skip
    later = []
    build(clones, EVERYTHING[0], output, EVERYTHING[1], 1, lambda name, done, total: later.append(done))
    assert later == list(range(2, 9))


def test_the_last_worker_ends(start, clones, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "_LOST", 1)
    cluster_ = start()
    worker = cluster_.worker("one", hold=2)
    cluster_.ready(1)
    with pytest.raises(ClusterError, match="the last worker is gone; what was read is kept"):
        build(
            clones, EVERYTHING[0], tmp_path / "surfaces", EVERYTHING[1],
            progress=lambda *told: worker.kill(), dask=cluster_.address,
        )  # fmt: skip


def test_a_job_that_its_workers_do_not_survive_is_named(start, clones):
    cluster = start(failures=0)
    for name in ("one", "two"):
        cluster.worker(name)
    cluster.ready(2)
    jobs, _ = plan(clones, ("humble",), ("rclcpp",))
    deadly = jobs[0]._replace(name="deadly")
    results = {job.name: result for job, result in run_on_cluster(cluster.address, [deadly, jobs[0]])}
    assert results["deadly"] == ({}, ("deadly: every worker that reads it dies, so it is left out",))
    assert set(results["ros2/rclcpp"].packages) == {("rclcpp", 2)}


def test_workers_that_cannot_do_it(start, clones, tmp_path, monkeypatch):
    cluster_ = start()
    (job,), _ = plan(clones, ("humble",), ("rclcpp",))

    def refused(job=job):
        with pytest.raises(ClusterError) as error:
            list(run_on_cluster(cluster_.address, [job]))
        assert cluster_.journal("end") == []
        return str(error.value).removeprefix(f"--dask {cluster_.address}: ")

    with monkeypatch.context() as patch:
        patch.setattr(cluster, "_REACH", 1)
        assert refused() == f"has no workers; start some: `dask worker {cluster_.address}`"
    cluster_.worker("good")
    cluster_.ready(1)
    (state,) = job.states
    away = refused(job._replace(states=(state._replace(place="/nowhere/ros2+rclcpp"),)))
    assert away.startswith("worker tcp://127.0.0.1:")
    assert away.endswith(" does not see /nowhere/ros2+rclcpp; give it the clones at the same path")
    moved = refused(job._replace(trees=("0" * 40,)))
    assert moved.startswith(f"a worker has another {state.revision} in {state.place}; `git fetch --tags` there")
    # One of two has other code.
    cluster_.worker("other", digest="0123456789")
    cluster_.ready(2)
    here = cluster.CodeState.detect()
    other = f"has {here._replace(digest='0123456789')}, and here is {here}; install there what is installed here"
    assert other in refused()


def test_there_is_no_cluster(clones, monkeypatch):
    monkeypatch.setattr(cluster, "_REACH", 1)
    (job,), _ = plan(clones, ("humble",), ("rclcpp",))
    for address, reason in {
        "tcp://127.0.0.1:1": "Timed out .*; give the address of a running `dask scheduler`",
        "127.0.0.1": "missing port number",
        "nothing://127.0.0.1:1": "unknown address scheme",
    }.items():
        with pytest.raises(ClusterError, match=f"--dask {address}: {reason}"):
            next(run_on_cluster(address, [job]))
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ClusterError, match=r"pip install 'rosimpact\[cluster\]'"):
        next(run_on_cluster("tcp://127.0.0.1:1", [job]))


def test_what_is_done_needs_no_cluster(clones, tmp_path):
    asked = EVERYTHING[0], tmp_path / "surfaces", EVERYTHING[1]

    def stop(name, done, total):
        if done == total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build(clones, *asked, 1, stop)
    assert build(clones, *asked, dask="tcp://127.0.0.1:1").packages == 8
    assert "of_rclcpp" in Surfaces(tmp_path / "surfaces").find_history("rclcpp", 2).index_names()
