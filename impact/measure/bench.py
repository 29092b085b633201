"""One side of the experiment: the messages that are ready to be sent, and the nodes that run for one cell."""

from __future__ import annotations

import contextlib
import hashlib
import os
import struct
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ...edges.console import UserError
from ...edges.documents import DocumentError, load_json
from ...edges.files import write_file
from . import ros1
from .children import Child
from .intervals import PublishReport, Window, read_samples
from .messages import HEAD_BYTES, SentSchema
from .namespaces import NetworkSite
from .plan import TAIL, Conditions, NetworkCell

_CONNECT = 40.0
_START_AHEAD = 0.1
_IDLE, _LONGEST = 0.4, 60.0
_NANO = 1_000_000_000
CLOCKS = {"monotonic": time.CLOCK_MONOTONIC, "realtime": time.CLOCK_REALTIME}


class PreparedMessage(NamedTuple):
    """A message as a cell sends it. contents: what it is filled with, in turn. bytes: on the wire, on average, with the
    sample's head."""

    schema: SentSchema
    contents: Sequence[bytes]

    @property
    def bytes(self) -> int:
        return HEAD_BYTES + round(sum(map(len, self.contents)) / len(self.contents))


Messages = Mapping[tuple[int, str], PreparedMessage]
"""The messages of a plan by the number of fields (0 for a real one) and the variant."""


class Bench:
    """What one side needs to run nodes: a site, a folder for their files, how each message's node is started.

    clock: monotonic or realtime. master: the address of ROS's master, empty for DDS. peers: both addresses, for DDS.
    """

    def __init__(
        self, conditions: Conditions, messages: Messages, site: NetworkSite, folder: Path, *, clock: str = "monotonic",
        master: str = "", peers: Sequence[str] = (), address: str = "", domain: int = 0,
    ):  # fmt: skip
        self.conditions, self.messages, self.site, self.folder = conditions, messages, site, folder
        self.clock, self._files = clock, 0
        self._commands: dict[tuple[int, str], list[str]] = {}
        self._environment: dict[str, str] = {}
        self._further: dict[tuple[int, str], dict[str, str]] = {}
        folder.mkdir(parents=True, exist_ok=True)
        if conditions.nodes == "dds":
            self._prepare_dds(peers, domain)
        else:
            self._prepare_ros1(master, address or site.address)

    def _prepare_ros1(self, master: str, address: str) -> None:
        ros, missing = ros1.find_ros1(self.conditions.nodes)
        if ros is None:
            raise UserError("; ".join(missing))
        keys = list(self.messages)
        schemas = [self.messages[key].schema for key in keys]
        self._environment = ros.make_environment(master, address, self.folder / "logs")
        for key, folder in zip(keys, ros1.prepare_nodes(ros, self.conditions.nodes, schemas), strict=True):
            self._commands[key], self._further[key] = ros1.make_command(ros, self.conditions.nodes, folder)

    def _prepare_dds(self, peers: Sequence[str], domain: int) -> None:
        addresses = "".join(f'<Peer address="{peer}"/>' for peer in dict.fromkeys(peers))
        interfaces = f'<Interfaces><NetworkInterface address="{self.site.address}"/></Interfaces>'
        settings = (
            f"<CycloneDDS><Domain><General>{interfaces}<AllowMulticast>false</AllowMulticast></General><Discovery>"
            f"<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>120</MaxAutoParticipantIndex>"
            f"<Peers>{addresses}</Peers></Discovery></Domain></CycloneDDS>"
        )
        self._environment = {**os.environ, "CYCLONEDDS_URI": settings, "PYTHONDONTWRITEBYTECODE": "1"}
        for key, message in self.messages.items():
            schema = self.folder / f"{_hash_name(key)}.json"
            write_file(schema, msgspec.json.encode(message.schema))
            module = f"{__package__}.nodes.dds_node"
            self._commands[key] = [sys.executable, "-m", module, f"schema={schema}", f"domain={domain}"]

    def start_node(self, role: str, cell: NetworkCell, topic: str, options: Mapping[str, object]) -> Child:
        """Starts a publisher (`publish`) or a subscriber (`subscribe`) of a cell's message."""
        key = cell.fields, cell.variant
        command = self._commands[key]
        own = [word for word in command if "=" in word]
        given = {"topic": topic, "queue": self.conditions.queue, "clock": self.clock, **options}
        words = [*(word for word in command if "=" not in word), role, *own, *(f"{k}={v}" for k, v in given.items())]
        self._files += 1
        environment = self._environment | self._further.get(key, {})
        return Child([*self.site.prefix, *words], environment, self.folder / f"{role}-{self._files}.log")

    def write_contents(self, cell: NetworkCell) -> Path:
        """The file that publishers of a cell read what they send from."""
        key = cell.fields, cell.variant
        path = self.folder / f"{_hash_name(key)}.contents"
        if not path.exists():
            parts = (struct.pack("<I", len(one)) + one for one in self.messages[key].contents)
            write_file(path, b"".join(parts))
        return path

    def read_clock(self) -> int:
        """Nanoseconds of the clock that the nodes use."""
        return time.clock_gettime_ns(CLOCKS[self.clock])


def _hash_name(key: tuple[int, str]) -> str:
    return hashlib.sha256(repr(key).encode()).hexdigest()[:12]


def count_messages(conditions: Conditions, rate: float) -> tuple[int, Window]:
    """How many messages each publisher sends, and which of them count."""
    first = round(conditions.warm_up * rate)
    end = first + max(1, round(conditions.seconds * rate))
    return end + round(TAIL * rate), Window(first, end)


class LocalPublishers:
    """The publishers of one cell on this machine."""

    def __init__(self, bench: Bench):
        self._bench = bench
        self._nodes: list[Child] = []
        self._seconds = 0.0

    def start(self, cell: NetworkCell, topic: str) -> None:
        """Starts them, each a part of a period behind the one before, and returns once all are connected. Raises
        UserError."""
        bench = self._bench
        count, _ = count_messages(bench.conditions, cell.rate)
        period = round(_NANO / cell.rate)
        self._seconds = count / cell.rate
        contents = bench.write_contents(cell)
        for index in range(cell.publishers):
            given = {"index": index, "period": period, "offset": index * period // cell.publishers, "count": count,
                     "contents": contents}  # fmt: skip
            self._nodes.append(bench.start_node("publish", cell, topic, given))
        for node in self._nodes:
            _expect(node, "ready", _CONNECT)

    def publish(self) -> PublishReport:
        """Has them publish all they have to. Raises UserError."""
        start = self._bench.read_clock() + int(_START_AHEAD * _NANO)
        for node in self._nodes:
            node.send(f"start {start}")
        # A publisher that cannot keep up needs longer, and says so.
        said = [_read_report(node, 20 * self._seconds + 60) for node in self._nodes]
        published, late = (sum(one[name] for one in said) for name in ("published", "late"))
        rate = min((one["published"] - 1) * _NANO / max(1, one["elapsed"]) for one in said)
        return PublishReport(rate, 100 * late / published)

    def stop(self) -> None:
        """Ends them."""
        while self._nodes:
            self._nodes.pop().stop()


class LocalSubscriber:
    """The subscriber of one cell on this machine."""

    def __init__(self, bench: Bench, cell: NetworkCell, topic: str):
        self._output = bench.folder / "samples"
        given = {"work": round(bench.conditions.callback_ms * 1e6), "idle": int(_IDLE * _NANO),
                 "longest": int(_LONGEST * _NANO), "output": self._output}  # fmt: skip
        self._node = bench.start_node("subscribe", cell, topic, given)
        try:
            _expect(self._node, "ready", _CONNECT)
        except BaseException:
            self.stop()
            raise

    def finish(self) -> Any:
        """What it saw, once nothing arrives any more. Raises UserError."""
        self._node.send("end")
        _expect(self._node, "done", _LONGEST + 30)
        return read_samples(self._output)

    def stop(self) -> None:
        """Ends it."""
        self._node.stop()
        with contextlib.suppress(OSError):
            self._output.unlink()


def _expect(node: Child, word: str, seconds: float) -> None:
    said = node.wait_for_line(seconds)
    if said != word:
        raise UserError(f"a node said `{said[:80]}` where `{word}` was expected: {node.read_end()}")


def _read_report(node: Child, seconds: float) -> dict[str, int]:
    said = node.wait_for_line(seconds)
    try:
        report = load_json(said)
        return {name: int(report[name]) for name in ("published", "late", "elapsed")}
    except (DocumentError, KeyError, TypeError, ValueError):
        raise UserError(f"a publisher reported `{said[:80]}`: {node.read_end()}") from None
