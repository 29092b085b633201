"""Parts of a message-flow graph."""

import pytest
from robot import robot
from rosimpact.impact.model.flow.select import NothingSelected, select_graph

WHOLE = robot(log="""
    class Log : public rclcpp::Node {
     public:
      Log() : Node("log") {
        sub_ = create_subscription<rcl_interfaces::msg::Log>("/rosout", 10, [](rcl_interfaces::msg::Log m) {});
      }
    };
    int main(int c, char** v) { rclcpp::spin(std::make_shared<Log>()); }
""")  # fmt: skip


def names(**asked) -> tuple[set[str], set[str]]:
    part = select_graph(WHOLE, **asked).graph
    return {node.package for node in part.nodes}, {e.topic for e in part.endpoints if e.topic}


def test_what_every_node_has_is_hidden_and_counted():
    assert select_graph(WHOLE).hidden == 1
    assert "/rosout" not in names()[1]
    assert "/rosout" in names(everything=True)[1]
    assert names(topics=["rosout"])[1] == {"/rosout"}


@pytest.mark.parametrize("name", ["/mover", "mover", "mover/mover", "mov*"])
def test_a_node_with_whom_it_talks_to(name):
    assert names(nodes=[name]) == ({"mover", "planner"}, {"/plan"})


@pytest.mark.parametrize("name", ["scan", "/scan", "*can"])
def test_a_topic_with_who_uses_it(name):
    assert names(topics=[name]) == ({"driver", "planner"}, {"/scan"})


def test_a_package():
    assert names(packages=["planner"]) == ({"planner"}, {"/scan", "/plan", "/calibrate"})


@pytest.mark.parametrize(
    ("around", "hops", "packages"),
    [
        ("driver", 1, {"driver", "planner"}),
        ("driver", 2, {"driver", "planner", "mover"}),
        ("plan", 1, {"driver", "planner", "mover"}),
        ("/mover", 1, {"planner", "mover"}),
    ],
)
def test_what_is_near(around, hops, packages):
    assert names(around=around, hops=hops)[0] == packages


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"nodes": ["plannr"]}, "`plannr`: no node of this name; there is `planner`, `planner/planner`"),
        ({"topics": ["scam"]}, "no topic, service or action of this name; there is `scan`"),
        ({"around": "nowhere-near"}, "no node or topic"),
        ({"packages": ["none"]}, "`none`: no package with nodes of this name; there is `planner`"),
    ],
)
def test_what_is_not_there(asked, said):
    with pytest.raises(NothingSelected, match=said):
        select_graph(WHOLE, **asked)
