"""What is the same in many nodes is worked out once, and what is not stays apart."""

import pytest

from rosimpact.impact.model.flow import values as flow_values
from joining import ends, joined

SHARED = """
    #include <rclcpp/rclcpp.hpp>

    inline void run(rclcpp::Node & node, const std::string & topic)
    {
      std::string mode = node.declare_parameter("mode", "wide");
      if (mode == "wide") {
        node.create_publisher<std_msgs::msg::String>("shared", 1);
      }
      node.create_publisher<std_msgs::msg::String>(topic, 1);
    }
"""


def make_files(nodes: str) -> dict[str, str]:
    """Programs that run the same function, one for each letter."""
    mains = {
        f"p/{name}.cpp": f"""
            #include "shared.hpp"

            int main()
            {{
              rclcpp::Node node("{name}");
              run(node, "of_{name}");
            }}
        """
        for name in nodes
    }
    return {"p/shared.hpp": SHARED, **mains}


@pytest.fixture
def count(monkeypatch):
    """Conditions that were decided."""
    decided = []

    class Counting(flow_values.ConditionReader):
        def decide_guard(self, guard):
            decided.append(guard.text)
            return super().decide_guard(guard)

    monkeypatch.setattr(flow_values, "ConditionReader", Counting)
    return decided


@pytest.mark.parametrize("nodes", ["a", "ab", "abcd"])
def test_a_condition_is_decided_once_for_all_nodes(nodes, count):
    joined(make_files(nodes)).build()
    assert count == ['mode == "wide"']


def test_what_each_node_passes_stays_its_own():
    found = joined(make_files("ab")).build()
    assert ends(found, "publisher") == {
        (f"p/{name}", topic, "std_msgs/String") for name in "ab" for topic in ("/shared", f"/of_{name}")
    }
