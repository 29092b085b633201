"""What lies downstream in a message-flow graph."""

import pytest
from rosimpact.impact.model.flow.graph import Coverage, Endpoint, Graph, Node, Publish, Trigger
from rosimpact.impact.model.flow.reach import DownstreamSearch


def graph(publishes=(), endpoints=()) -> Graph:
    names = sorted({each.node for each in (*publishes, *endpoints)})
    nodes = tuple(Node(name, f"/{name}", "p", "executable") for name in names)
    return Graph(nodes, tuple(endpoints), tuple(publishes), (), (), Coverage(0, 0, 0, 0))


def hears(node: str, topic: str, line: int = 1, role="subscriber") -> Endpoint:
    return Endpoint(role, node, topic, "std_msgs/String", f"{node}.cpp", line)


def says(node: str, topic: str, *triggers: Trigger) -> Publish:
    return Publish(node, topic, "std_msgs/String", f"{node}.cpp", 9, triggers=triggers)


def by(node: str, line: int, kind: str = "subscriber") -> Trigger:
    return Trigger(kind, "", f"{node}.cpp", line)


CHAIN = graph(
    [
        says("driver", "/scan"),
        says("filter", "/clean", by("filter", 1)),
        says("planner", "/plan", by("planner", 5, "timer")),
    ],
    [hears("filter", "/scan"), hears("planner", "/clean"), hears("mover", "/plan")],
)


def test_a_chain_is_walked_with_its_path():
    reached = DownstreamSearch(CHAIN).find_downstream([("/scan", "publisher")])
    assert [each.node for each in reached] == ["filter", "planner", "mover"]
    assert [step.name for step in reached[-1].steps] == ["/scan", "/clean", "/plan"]
    further = DownstreamSearch(CHAIN).find_downstream([("/clean", "publisher")], "filter")
    assert [each.node for each in further] == ["planner", "mover"]


def test_what_another_callback_publishes_is_not_reached():
    found = graph(
        [says("a", "/in"), says("b", "/out", by("b", 2))],
        [hears("b", "/in", 1), hears("b", "/other", 2), hears("c", "/out")],
    )
    assert [each.node for each in DownstreamSearch(found).find_downstream([("/in", "publisher")])] == ["b"]
    assert [each.node for each in DownstreamSearch(found).find_downstream([("/other", "publisher")])] == ["b", "c"]


def test_circles_end_and_topics_of_all_nodes_lead_nowhere():
    found = graph(
        [says("a", "/x"), says("b", "/y"), says("b", "/rosout")],
        [hears("b", "/x"), hears("a", "/y"), hears("logger", "/rosout")],
    )
    assert [each.node for each in DownstreamSearch(found).find_downstream([("/x", "publisher")])] == ["b", "a"]


@pytest.mark.parametrize(("client", "server"), [("client", "server"), ("action client", "action server")])
def test_requests_reach_who_serves_them(client, server):
    found = graph([], [hears("a", "/do", 1, client), hears("b", "/do", 1, server)])
    (reached,) = DownstreamSearch(found).find_downstream([("/do", client)], "a")
    assert (reached.node, reached.steps[0].kind) == ("b", "service" if server == "server" else "action")
