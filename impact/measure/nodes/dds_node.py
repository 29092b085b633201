"""A measuring node of ROS 2's default middleware but one, Cyclone DDS, through its Python package.

Reliable, volatile, keep last N, as rclcpp and rclpy have it by default. A thread takes samples from the reader as they
come, which is an arrival, and puts them into a queue of N from which the callback is called, as an executor does.
"""

from __future__ import annotations

import importlib
import sys
import threading
from collections import deque
from typing import Any

import msgspec

from ....edges.files import read_file
from ..messages import ROOT, SentSchema, decode
from .node_loop import NodeLoop, read_contents

_SCHEMA = 1 << 24
_BLOCKED = 10
_HISTORY = 100_000
_NAMES = {"bool": bool, "string": str}


def main(arguments: list[str]) -> None:
    """Runs a node until the runner ends it."""
    loop = NodeLoop(arguments)
    schema = msgspec.json.decode(read_file(loop.options["schema"], _SCHEMA), type=SentSchema)
    core, types, domain, topics, util = (
        importlib.import_module(f"cyclonedds.{name}") for name in ("core", "idl.types", "domain", "topic", "util")
    )
    structs = _make_structs(schema, importlib.import_module("cyclonedds.idl"), types)
    participant = domain.DomainParticipant(loop.get_number("domain"))
    topic = topics.Topic(participant, loop.options["topic"].strip("/").replace("/", "_"), structs[ROOT])
    policy = core.Policy

    def make_qos(length: int) -> Any:
        return core.Qos(
            policy.Reliability.Reliable(util.duration(seconds=_BLOCKED)), policy.Durability.Volatile,
            policy.History.KeepLast(length),
        )  # fmt: skip

    queue = loop.get_number("queue")
    if loop.role == "publish":
        writer = importlib.import_module("cyclonedds.pub").DataWriter(participant, topic, make_qos(queue))
        contents = [_make_value(schema, schema.name, decode(schema, data), structs, types)
                    for data in read_contents(loop.options["contents"])]  # fmt: skip
        index = loop.get_number("index")
        loop.publish(
            lambda: len(writer.get_matched_subscriptions()) > 0,
            lambda number, sent: writer.write(structs[ROOT](number, sent, index, contents[number % len(contents)])),
        )
    else:
        reader = importlib.import_module("cyclonedds.sub").DataReader(participant, topic, make_qos(_HISTORY))
        _run_subscriber(loop, participant, reader, queue, core, util)


def _run_subscriber(loop: NodeLoop, participant: Any, reader: Any, length: int, core: Any, util: Any) -> None:
    waiting: deque[Any] = deque(maxlen=length)
    some = threading.Semaphore(0)

    def take_samples() -> None:
        condition = core.ReadCondition(reader, core.ViewState.Any | core.InstanceState.Any | core.SampleState.NotRead)
        waits = core.WaitSet(participant)
        waits.attach(condition)
        while True:
            waits.wait(util.duration(milliseconds=100))
            for sample in reader.take(N=_HISTORY):
                if hasattr(sample, "number"):  # and no note that a writer is gone
                    loop.note_arrival(sample.publisher, sample.number, sample.sent)
                    waiting.append(sample)
                    some.release()

    def call_back() -> None:
        while True:
            some.acquire()
            if waiting:  # less than were released when some were dropped
                sample = waiting.popleft()
                loop.note_callback(sample.publisher, sample.number, sample.sent)

    for work in (take_samples, call_back):
        threading.Thread(target=work, daemon=True).start()
    loop.wait_until_idle()
    loop.finish()


def _make_structs(schema: SentSchema, idl: Any, types: Any) -> dict[str, Any]:
    """The messages as classes of cyclonedds, the sample included."""
    made: dict[str, Any] = {}
    moments = {
        name: idl.make_idl_struct(f"Moment_{name}", f"rosimpact_measure.Moment_{name}", {"sec": kind, "nanosec": kind})
        for name, kind in (("time", types.uint32), ("duration", types.int32))
    }

    def find_type(name: str) -> Any:
        if name in moments:
            return moments[name]
        return _NAMES.get(name) or getattr(types, name, None) or make_struct(name)

    def make_struct(name: str) -> Any:
        if name not in made:
            fields = {}
            for field in schema.messages[name]:
                inner = find_type(field.type)
                several = types.sequence[inner] if field.size == 0 else types.array[inner, field.size]
                fields[field.name] = inner if field.size < 0 else several
            # Cyclone has no empty structs.
            made[name] = idl.make_idl_struct(name, f"rosimpact_measure.{name}", fields or {"empty": types.uint8})
        return made[name]

    content = make_struct(schema.name)
    head = {"number": types.uint64, "sent": types.int64, "publisher": types.uint32, "content": content}
    return {**made, **moments, ROOT: idl.make_idl_struct(ROOT, f"rosimpact_measure.{ROOT}", head)}


def _make_value(schema: SentSchema, name: str, value: dict[str, Any], structs: dict[str, Any], types: Any) -> Any:
    """A message that was decoded, as cyclonedds sends it."""

    def convert(type_: str, each: Any) -> Any:
        if type_ in schema.messages:
            return _make_value(schema, type_, each, structs, types)
        if type_ in ("time", "duration"):
            return structs[type_](each.sec, each.nanosec)
        return each.decode("utf-8", "replace") if type_ == "string" else each.item()

    given = {
        field.name: convert(field.type, value[field.name]) if field.size < 0
        else [convert(field.type, each) for each in value[field.name]]
        for field in schema.messages[name]
    }  # fmt: skip
    return structs[name](**(given or {"empty": 0}))


if __name__ == "__main__":
    main(sys.argv[1:])
