"""Two machines: one serves publishers, the other subscribes, drives the run and keeps the results.

They speak in lines of JSON over TCP; the subscriber finds the address at the ROS master. Nothing that comes over the
network is run or compiled: a cell is numbers within limits, and a real message is built from the workspace that each
side was given.
"""

from __future__ import annotations

import contextlib
import re
import socket
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import urlsplit

import msgspec

from ...edges.console import UserError, describe
from ...edges.documents import DocumentError, load_json
from . import ros1
from .bench import Bench, LocalPublishers, Messages
from .clocks import ClockOffset, take_trips
from .contents import make_synthetic_messages
from .intervals import PublishReport
from .namespaces import NetworkSite, open_work_folder
from .plan import NODES, SYNTHETIC, Conditions, NetworkCell, NetworkPlan, check_number, check_plan
from .results import ResultsFile
from .run import Progress, list_left, make_header, measure_cell

PARAMETER = "/rosimpact_measure/publisher"
TWO_CLOCKS = (
    "two machines: CLOCK_REALTIME on both; before and behind each cell the offset is taken from the shortest of 200 "
    "round trips; it is uncertain by half of its time on the way and half of what it moved (clock_uncertainty_ms)"
)
_TOPIC = re.compile(r"/rosimpact_measure/\w{1,120}")
_LINE = 1 << 16
_SECONDS = 60.0
_LONGEST = 24 * 3_600.0
_DOCUMENTATION = "192.0.2.1"  # RFC 5737; nothing is sent there


class Question(msgspec.Struct, frozen=True):
    """What the subscriber asks for. do: hello, clock, start, publish or stop."""

    do: str
    conditions: Conditions | None = None
    fields: tuple[int, ...] = ()
    cell: NetworkCell | None = None
    topic: str = ""


class ServedMessage(NamedTuple):
    """The real message that this side was given: its name, the fields that are kept, messages and their digest."""

    message: str
    messages: Messages
    digest: str


def find_address(towards: str = _DOCUMENTATION) -> str:
    """The address that this machine has on the way to another one. Raises UserError where there is no way."""
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.connect((towards, 9))
            return probe.getsockname()[0]
    except OSError:
        raise UserError(
            "no route leads to the other machine, so that the address of this one is not known; give it with --address"
        ) from None


def serve_publishers(
    nodes: str, master: str, address: str, port: int, given: ServedMessage | None, progress: Progress
) -> None:  # fmt: skip
    """Serves subscribers until it is interrupted. master: empty to use the one on this machine's port, or to start one.
    given: the real message, none for synthetic ones. Raises UserError."""
    ros, missing = ros1.find_ros1(nodes)
    if ros is None:
        raise UserError("the measurement needs\n  " + "\n  ".join(missing))
    with contextlib.ExitStack() as opened:
        place = opened.enter_context(open_work_folder())
        (place / "logs").mkdir()
        address = address or find_address(urlsplit(master).hostname or _DOCUMENTATION if master else _DOCUMENTATION)
        uri = master or f"http://{address}:{port}"
        if not master and not _has_master(uri):
            opened.enter_context(ros1.open_master(ros, NetworkSite((), address), port, place / "logs"))
        server = opened.enter_context(_open_server(address))
        known = ros1.check_master(uri)
        where = f"{address}:{server.getsockname()[1]}"
        known.setParam("/rosimpact", PARAMETER, where)
        opened.callback(_forget, uri)
        progress(f"on the other machine: rosimpact measure subscriber --master {uri}")
        while True:
            connection, peer = server.accept()
            with connection:
                progress(f"{peer[0]} is connected")
                _Session(connection, nodes, uri, address, place, given).serve()
                progress(f"{peer[0]} is done")


def _has_master(uri: str) -> bool:
    try:
        ros1.check_master(uri)
    except UserError:
        return False
    return True


def _open_server(address: str) -> socket.socket:
    try:
        return socket.create_server((address, 0))
    except OSError as error:
        raise UserError(f"--address {address}: {error.strerror}; give an address of this machine") from None


def _forget(uri: str) -> None:
    with contextlib.suppress(UserError, OSError):
        ros1.check_master(uri).deleteParam("/rosimpact", PARAMETER)


class _Session:
    """One subscriber that is connected."""

    def __init__(
        self, connection: socket.socket, nodes: str, uri: str, address: str, place: Path, given: ServedMessage | None
    ):
        connection.settimeout(_LONGEST)
        self._connection, self._nodes, self._uri, self._address = connection, nodes, uri, address
        self._place, self._given = place, given
        self._bench: Bench | None = None
        self._publishers: LocalPublishers | None = None

    def serve(self) -> None:
        """Answers until the other side hangs up."""
        try:
            with self._connection.makefile("rb") as lines:
                while line := lines.readline(_LINE):
                    received = self._bench.read_clock() if self._bench is not None else 0
                    try:
                        question = msgspec.json.decode(line, type=Question)
                        answer = self._answer(question, received)
                    except (UserError, msgspec.DecodeError, msgspec.ValidationError, RecursionError) as error:
                        answer = {"error": " ".join(describe(error).split())}
                    self._connection.sendall(msgspec.json.encode(answer) + b"\n")
        except OSError:
            return
        finally:
            if self._publishers is not None:
                self._publishers.stop()

    def _answer(self, question: Question, received: int) -> dict[str, Any]:
        if question.do == "hello":
            self._prepare(question)
        elif self._bench is None or self._publishers is None:
            raise UserError("the first question has to be `hello`")
        elif question.do == "clock":
            return {"received": received, "sent": self._bench.read_clock()}
        elif question.do == "start":
            self._publishers.stop()
            self._publishers.start(self._check_cell(question.cell), _check_topic(question.topic))
        elif question.do == "publish":
            return self._publishers.publish()._asdict()
        elif question.do == "stop":
            self._publishers.stop()
        else:
            raise UserError(f"`{question.do[:40]}` is not known; use the same version of rosimpact on both machines")
        return {}

    def _prepare(self, question: Question) -> None:
        conditions = question.conditions or Conditions()
        _check_conditions(conditions, self._nodes)
        mine = self._given.message if self._given is not None else SYNTHETIC
        if conditions.message != mine:
            raise UserError(f"the publisher was started for {mine}, the subscriber for {conditions.message[:100]}")
        if self._given is not None:
            if conditions.contents != self._given.digest:
                raise UserError("both sides have to be given the same workspace, --keep, --length and --bag")
            messages = self._given.messages
        else:
            for fields in question.fields:
                check_number("fields", fields, 1)
            plan = NetworkPlan(conditions=conditions, fields=question.fields or (1,))
            check_plan(plan)
            messages = make_synthetic_messages(plan)
        folder = Path(tempfile.mkdtemp(dir=self._place))
        self._bench = Bench(
            conditions, messages, NetworkSite((), self._address), folder, clock="realtime", master=self._uri,
            address=self._address,
        )  # fmt: skip
        self._publishers = LocalPublishers(self._bench)

    def _check_cell(self, cell: NetworkCell | None) -> NetworkCell:
        assert self._bench is not None
        if cell is None or (cell.fields, cell.variant) not in self._bench.messages:
            raise UserError("the cell is not one of those that `hello` named")
        check_number("publishers", cell.publishers, 1)
        check_number("rates", cell.rate)
        return cell


def _check_topic(topic: str) -> str:
    if not _TOPIC.fullmatch(topic):
        raise UserError("the topic is not one of a measurement")
    return topic


def _check_conditions(conditions: Conditions, nodes: str) -> None:
    """Raises UserError for conditions that no subscriber of ours asks for."""
    if conditions.nodes != nodes or nodes not in NODES:
        raise UserError(f"the publisher was started for {nodes}; give both sides the same --nodes")
    check_number("queue", conditions.queue, 1)
    check_number("seconds", conditions.seconds)
    check_number("warm-up", conditions.warm_up, 0)
    check_number("field-bytes", conditions.field_bytes, 0)
    check_number("fields", max(1, conditions.keep), 1)


class RemotePublishers:
    """The publishers of the other machine."""

    def __init__(self, where: str, read_clock: Callable[[], int]):
        host, _, port = where.rpartition(":")
        self._read_clock = read_clock
        try:
            self._connection = socket.create_connection((host, int(port)), _SECONDS)
        except (OSError, ValueError) as error:
            raise UserError(
                f"{where}: the publishing side does not answer ({error}); start `rosimpact measure publisher` there"
            ) from None
        self._connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._lines = self._connection.makefile("rb")

    def close(self) -> None:
        """Hangs up."""
        self._lines.close()
        self._connection.close()

    def prepare(self, plan: NetworkPlan) -> None:
        """Has the other side prepare its nodes, which may mean to compile them. Raises UserError."""
        self._ask(Question("hello", plan.conditions, plan.fields), 1_800)

    def read_offset(self) -> ClockOffset:
        """What the clock here is ahead of the one there."""

        def ask() -> tuple[int, int]:
            answer = self._ask(Question("clock"))
            return int(answer["received"]), int(answer["sent"])

        return take_trips(self._read_clock, ask)

    def start(self, cell: NetworkCell, topic: str) -> None:
        """Starts the publishers of a cell. Raises UserError."""
        self._ask(Question("start", cell=cell, topic=topic))

    def publish(self) -> PublishReport:
        """Has them publish. Raises UserError."""
        answer = self._ask(Question("publish"), _LONGEST)
        return PublishReport(float(answer["rate"]), float(answer["late_percent"]))

    def stop(self) -> None:
        """Ends them."""
        with contextlib.suppress(UserError):
            self._ask(Question("stop"))

    def _ask(self, question: Question, seconds: float = _SECONDS) -> dict[str, Any]:
        try:
            self._connection.settimeout(seconds)
            self._connection.sendall(msgspec.json.encode(question) + b"\n")
            answer = load_json(self._lines.readline(_LINE))
            if "error" in answer:
                raise UserError(f"the publishing side: {answer['error']}")
            return answer
        except (OSError, DocumentError, TypeError) as error:
            raise UserError(f"the publishing side does not answer: {error}") from None


def run_subscriber(
    plan: NetworkPlan, messages: Messages, master: str, address: str, output: Path, progress: Progress
) -> ResultsFile:
    """Measures all cells of a plan with publishers on another machine. Raises UserError."""
    ros, missing = ros1.find_ros1(plan.conditions.nodes)
    if ros is None:
        raise UserError("the measurement needs\n  " + "\n  ".join(missing))
    status, _, where = ros1.check_master(master).getParam("/rosimpact", PARAMETER)
    if status != 1 or not isinstance(where, str):
        raise UserError(f"--master {master}: no publishing side is there; start `rosimpact measure publisher` first")
    file = ResultsFile(output, make_header(plan.conditions, TWO_CLOCKS))
    left = list_left(plan, file, progress)
    with open_work_folder() as folder:
        progress("preparing nodes on both machines")
        address = address or find_address(urlsplit(master).hostname or "")
        bench = Bench(plan.conditions, messages, NetworkSite((), address), folder, clock="realtime", master=master)
        publishers = RemotePublishers(where, bench.read_clock)
        try:
            publishers.prepare(plan)
            for number, (repetition, cell) in enumerate(left, 1):
                progress(f"[{number}/{len(left)}] {cell.describe()}, repetition {repetition + 1}")
                file.add(measure_cell(publishers, bench, cell, repetition, progress, publishers.read_offset))
        finally:
            publishers.close()
    return file
