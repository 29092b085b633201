"""The message-flow graph beside the truth: real nodes of ROS 1 from Debian, run, against what their sources tell.

Each node is started on a master of its own (ros_nodes.py) and its publishers, subscribers and services are read from
it; nothing of that is written down here. The same node is then looked up in the graph of the source package that the
running program was built from. Arguments of the command line count as known: both sides are given them.

`.ci/debian-sources FOLDER` unpacks the sources, ROSIMPACT_DEBIAN_SOURCES names the folder; `.ci/run` names the packages
with the nodes.
"""

from __future__ import annotations

import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
import ros_nodes
from ros_nodes import NodeFailed, Registered
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.graph import Graph
from rosimpact.impact.model.flow.join import Join
from rosimpact.impact.model.flow.workspace import join_code, link_for_flow
from rosimpact.impact.tree import WorkingTree
from rosrun import rosrun

SOURCES = os.environ.get("ROSIMPACT_DEBIAN_SOURCES", "")
ROBOT = (
    '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/>'
    '<child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
)
CALIBRATE = ("--size", "8x6", "--square", "0.1", "--no-service-check")
AT_ONCE = 4


class Case(NamedTuple):
    """A node. source: the source package; package and program: what rosrun would be given; arguments: those of the
    command line, PICTURE standing for a file."""

    source: str
    package: str
    program: str
    arguments: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.package}/{self.program}"


# topic_tools name themselves after a topic, by a function that takes its name apart: they are given another name.
CASES = (
    Case("ros-ros-comm", "rosout", "rosout"),
    Case("ros-ros-comm", "topic_tools", "relay", ("/in", "/out", "__name:=tested")),
    Case("ros-ros-comm", "topic_tools", "throttle", ("messages", "/in", "1.0", "/out_throttle", "__name:=tested")),
    Case("ros-ros-comm", "topic_tools", "drop", ("/in", "1", "2", "/out_drop", "__name:=tested")),
    Case("ros-ros-comm", "topic_tools", "mux", ("/sel", "/in1", "/in2", "__name:=tested")),
    Case("ros-ros-comm", "topic_tools", "transform", ("/in", "/out", "std_msgs/Int64", "len(m.data)")),
    Case("ros-image-pipeline", "image_proc", "image_proc"),
    Case("ros-image-pipeline", "stereo_image_proc", "stereo_image_proc"),
    Case("ros-image-pipeline", "image_rotate", "image_rotate"),
    Case("ros-image-pipeline", "image_publisher", "image_publisher", ("PICTURE",)),
    Case("ros-image-pipeline", "camera_calibration", "cameracheck.py", ("--size", "8x6")),
    Case("ros-image-pipeline", "camera_calibration", "cameracalibrator.py", CALIBRATE),
    Case("ros-robot-state-publisher", "robot_state_publisher", "robot_state_publisher"),
)  # fmt: skip

Ends = frozenset[tuple[str, str, str]]


class Compared(NamedTuple):
    """Endpoints as (role, name, type). truth: what the node registers; told: what the graph says; by their names of
    the node, `~` for the node's own at the beginning of a name."""

    truth: Ends
    told: Ends

    @property
    def missing(self) -> list[tuple[str, str, str]]:
        """What the node registers and the graph lacks."""
        return sorted(one for one in self.truth if not any(_same(one, other) for other in self.told))

    @property
    def extra(self) -> list[tuple[str, str, str]]:
        """What the graph says and the node does not register."""
        return sorted(one for one in self.told if not any(_same(one, other) for other in self.truth))


def _same(one: tuple[str, str, str], other: tuple[str, str, str]) -> bool:
    return one[:2] == other[:2] and (one[2] == other[2] or "*" in (one[2], other[2]))


def folder(source: str) -> Path:
    """Where a source package lies; skips the test when it is not there."""
    if not SOURCES:
        pytest.skip("ROSIMPACT_DEBIAN_SOURCES is not set; unpack the sources with .ci/debian-sources FOLDER")
    path = Path(SOURCES) / source
    if not path.is_dir():
        pytest.skip(f"{source} is not in {SOURCES}; .ci/debian-sources says why it could not be had")
    return path


def version_built(program: str) -> str:
    """The upstream version of the source package that an installed program was built from; empty where dpkg does not
    know."""
    told = subprocess.run(["dpkg-query", "-S", os.path.realpath(program)], capture_output=True, text=True)
    owner = told.stdout.partition(": ")[0]
    version = subprocess.run(["dpkg-query", "-W", "-f", "${source:Version}", owner], capture_output=True, text=True)
    match = re.match(r"(?:\d+:)?([\d.]+)", version.stdout)
    return match[1] if match else ""


def version_read(case: Case) -> str:
    """The version that the package's manifest in the sources gives."""
    for manifest in folder(case.source).rglob("package.xml"):
        text = manifest.read_text(encoding="utf-8", errors="replace")
        if re.search(rf"<name>\s*{case.package}\s*</name>", text) and ".pc" not in manifest.parts:
            found = re.search(r"<version>\s*([\d.]+)", text)
            return found[1] if found else ""
    return ""


def usable(case: Case) -> str:
    """The program of a case; skips the test where it is not installed or not built from the sources at hand."""
    folder(case.source)
    if lacking():
        pytest.skip(lacking())
    program = ros_nodes.program(case.package, case.program)
    if not program:
        pytest.skip(f"{case} is not installed; .ci/run names the packages that bring it")
    built, read = version_built(program), version_read(case)
    if built != read:
        pytest.skip(f"{case} was built from {built or 'what dpkg does not know'}, the sources are of {read}")
    return program


@cache
def lacking() -> str:
    """What every node needs and is not there."""
    return ros_nodes.missing()


@pytest.fixture(scope="module")
def truth(tmp_path_factory):
    """What each node registers, or why it does not come up; some run at once, since they mostly wait."""
    logs = tmp_path_factory.mktemp("nodes")
    picture = str(ros_nodes.png(logs / "picture.png"))

    def run(case: Case) -> Registered | NodeFailed | None:
        program = ros_nodes.program(case.package, case.program)
        if not program or not SOURCES or lacking():
            return None
        arguments = [picture if argument == "PICTURE" else argument for argument in case.arguments]
        try:
            return ros_nodes.registered(
                [program, *arguments],
                logs / case.package / case.program,
                ("/in", "/in1"),
                {"/robot_description": ROBOT},
            )
        except NodeFailed as failure:
            return failure

    with ThreadPoolExecutor(AT_ONCE) as pool:
        return dict(zip(CASES, pool.map(run, CASES), strict=True))


@pytest.fixture(scope="module")
def code(tmp_path_factory):
    """Gives the code of a source package, joined."""
    cache_folder = tmp_path_factory.mktemp("facts")

    @cache
    def of(source: str) -> Join:
        with Store(cache_folder) as store:
            return join_code(link_for_flow(WorkingTree(folder(source)), store))

    return of


@pytest.fixture(scope="module")
def compare(truth, code):
    """Gives a case's truth beside its graph; skips the test where there is none."""

    @cache
    def of(case: Case) -> Compared:
        usable(case)
        run = truth[case]
        if isinstance(run, NodeFailed):
            pytest.fail(str(run))
        graph = code(case.source).build(launch=rosrun(case.package, case.program, case.arguments))
        assert [node.executable for node in graph.nodes] == [case.program]
        # `/image_rotate_1795328266704156340`, `/transform_18151_1795221221877`: nodes that call themselves anonymous.
        plain = re.sub(r"(_\d+)+\Z", "_<anonymous>", run.name)
        assert graph.nodes[0].name == plain
        return Compared(registered_ends(run, plain), told_ends(graph))

    return of


def registered_ends(run: Registered, plain: str) -> Ends:
    """What a node registered, its own name without what makes it unique."""

    def name(full: str) -> str:
        own = full.startswith((f"{run.name}/", f"{run.name}_"))
        return f"{plain}{full[len(run.name) :]}" if own else full

    kinds = (("publisher", run.publishers), ("subscriber", run.subscribers), ("server", run.services))
    return frozenset((kind, name(full), of) for kind, rows in kinds for full, of in rows)


def told_ends(graph: Graph) -> Ends:
    """What the graph says of its one node. Clients are not registered anywhere, names not known are not said."""
    roles = ("publisher", "subscriber", "server")
    return frozenset((e.role, e.topic, e.type) for e in graph.endpoints if e.topic and e.role in roles)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_what_a_node_registers_is_in_the_graph(compare, case):
    both = compare(case)
    assert len(both.truth) >= 4
    assert len(both.missing) <= 0.05 * len(both.truth), f"missing: {both.missing}\nextra: {both.extra}"


def test_hardly_anything_else_is_in_the_graph(compare):
    """Over all nodes, since a node may be able to register more than it does when it is run like this."""
    all_of = {case: compare(case) for case in CASES if runnable(case)}
    if not all_of:
        pytest.skip("no node can be run")
    truth = sum(len(both.truth) for both in all_of.values())
    missing = {str(case): both.missing for case, both in all_of.items() if both.missing}
    extra = {str(case): both.extra for case, both in all_of.items() if both.extra}
    assert sum(map(len, missing.values())) <= 0.05 * truth, missing
    assert sum(map(len, extra.values())) <= 0.05 * truth, extra


def runnable(case: Case) -> bool:
    """Whether usable() would not skip."""
    try:
        return bool(usable(case))
    except pytest.skip.Exception:
        return False
