"""What the publishing side answers over the network, without ROS: only what a subscriber of ours asks for."""

import json
import socket
import threading
import time

import pytest
from rosimpact.impact.measure import machines
from rosimpact.impact.measure.plan import Conditions, NetworkCell, NetworkPlan

HELLO = {"do": "hello", "conditions": {"network": "machines", "link": 0}, "fields": [25]}
CELL = {"publishers": 1, "fields": 25, "rate": 50, "variant": "full"}


@pytest.fixture
def asked(tmp_path, monkeypatch):
    """Asks a session questions, and gives its answers and what it started."""
    started = []

    class Bench:
        def __init__(self, conditions, messages, *_, **__):
            self.conditions, self.messages = conditions, messages

        def read_clock(self):
            return 7

    class Publishers:
        def __init__(self, bench):
            self.bench = bench

        def start(self, cell, topic):
            started.append((cell, topic))

        def stop(self):
            started.append("stop")

    monkeypatch.setattr(machines, "Bench", Bench)
    monkeypatch.setattr(machines, "LocalPublishers", Publishers)

    def ask(*questions, given=None):
        here, there = socket.socketpair()
        session = machines._Session(there, "roscpp", "http://x", "127.0.0.1", tmp_path, given)
        worker = threading.Thread(target=session.serve)
        worker.start()
        answers = []
        with here, here.makefile("rb") as lines:
            here.settimeout(10)
            for question in questions:
                here.sendall((question if isinstance(question, bytes) else json.dumps(question).encode()) + b"\n")
                answers.append(json.loads(lines.readline()))
        here.close()
        there.shutdown(socket.SHUT_RDWR)
        worker.join(10)
        assert not worker.is_alive()
        return answers, started

    return ask


def test_a_subscriber_of_ours(asked):
    answers, started = asked(
        HELLO, {"do": "clock"}, {"do": "start", "cell": CELL, "topic": "/rosimpact_measure/a_1"}, {"do": "stop"}
    )
    assert answers == [{}, {"received": 7, "sent": 7}, {}, {}]
    assert started[1] == (NetworkCell(1, 25, 50, "full"), "/rosimpact_measure/a_1")
    assert started[-1] == "stop"


@pytest.mark.parametrize(
    ("question", "said"),
    [
        (b"nonsense", "malformed"),
        (b"[" * 5000, ""),
        ({"do": "hello", "conditions": {"nodes": "rospy"}}, "the same --nodes"),
        ({"do": "hello", "conditions": {"seconds": 1e9}, "fields": [25]}, "--seconds"),
        ({"do": "hello", "conditions": {"queue": -1}, "fields": [25]}, "--queue"),
        ({"do": "hello", "conditions": {}, "fields": [10**9]}, "--fields"),
        ({"do": "hello", "conditions": {"field_bytes": 10**7}, "fields": [10**4]}, "a message of more than"),
        ({"do": "hello", "conditions": {"message": "own_msgs/A"}, "fields": []}, "was started for synthetic"),
        ({"do": "clock"}, "the first question has to be `hello`"),
    ],
)
def test_what_is_refused_before_anything_is_prepared(asked, question, said):
    (answer,), started = asked(question)
    assert said in answer["error"] and started == []


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"topic": "/cmd_vel"}, "not one of a measurement"),
        ({"topic": "/rosimpact_measure/a b"}, "not one of a measurement"),
        ({"cell": {**CELL, "fields": 50}}, "not one of those"),
        ({"cell": {**CELL, "publishers": 10**6}}, "--publishers"),
        ({"cell": {**CELL, "rate": 1e9}}, "--rates"),
        ({"cell": None}, "not one of those"),
        ({"do": "remove"}, "`remove` is not known"),
    ],
)
def test_what_is_refused_afterwards(asked, more, said):
    start = {"do": "start", "cell": CELL, "topic": "/rosimpact_measure/a_1", **more}
    answers, started = asked(HELLO, start)
    assert said in answers[1]["error"]
    assert [each for each in started if each != "stop"] == []


def test_both_sides_need_the_same_message(asked):
    given = machines.ServedMessage("own_msgs/A", {}, "digest")
    conditions = {"message": "own_msgs/A", "contents": "another"}
    (answer,), _ = asked({"do": "hello", "conditions": conditions}, given=given)
    assert "the same workspace" in answer["error"]


def test_nobody_answers_at_the_address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        with pytest.raises(machines.UserError, match="start `rosimpact measure publisher` there"):
            machines.RemotePublishers(f"127.0.0.1:{probe.getsockname()[1]}", lambda: 0)


def test_a_question_is_what_the_other_side_reads():
    question = machines.Question("hello", Conditions(), (25,))
    assert machines.msgspec.json.decode(machines.msgspec.json.encode(question), type=machines.Question) == question


def test_no_route_leads_to_the_other_machine(monkeypatch):
    class Probe(socket.socket):
        def connect(self, address):
            raise OSError("Network is unreachable")

    monkeypatch.setattr(machines.socket, "socket", Probe)
    with pytest.raises(machines.UserError, match="give it with --address"):
        machines.find_address()


AHEAD = 3_600_000_000_000


@pytest.mark.parametrize("ahead", [0, AHEAD, -AHEAD])
def test_the_offset_of_two_clocks_over_a_real_connection(tmp_path, monkeypatch, ahead):
    """Both sides on this machine; the subscriber's clock is an hour ahead, or behind."""

    class Bench:
        def __init__(self, conditions, messages, *_, **__):
            self.messages = messages

        def read_clock(self):
            return time.time_ns()

    monkeypatch.setattr(machines, "Bench", Bench)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve():
            connection = server.accept()[0]
            with connection:
                machines._Session(connection, "roscpp", "http://x", "127.0.0.1", tmp_path, None).serve()

        worker = threading.Thread(target=serve)
        worker.start()
        where = f"127.0.0.1:{server.getsockname()[1]}"
        publishers = machines.RemotePublishers(where, lambda: time.time_ns() + ahead)
        publishers.prepare(NetworkPlan(conditions=Conditions(network="machines", link=0), fields=(25,)))
        offset = publishers.read_offset()
        publishers.close()
        worker.join(10)
    assert not worker.is_alive()
    # The round trip bounds the error, whatever this machine does beside it.
    assert abs(offset.nanoseconds - ahead) <= offset.uncertainty
    assert offset.uncertainty < 1e9
