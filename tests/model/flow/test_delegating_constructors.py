"""Constructors that hand on to another one of their class: which of them begins an object decides the node's name."""

import pytest
from joining import graph

CLASSES = """
#include <rclcpp/rclcpp.hpp>
namespace yard {
class Winch : public rclcpp::Node {
 public:
  explicit Winch(const rclcpp::NodeOptions & options);
  Winch(const std::string & name, const rclcpp::NodeOptions & options);
 private:
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
};
Winch::Winch(const rclcpp::NodeOptions & options) : Winch("winch", options) {}
Winch::Winch(const std::string & name, const rclcpp::NodeOptions & options) : Node(name, options), turns_(0) {
  pub_ = create_publisher<std_msgs::msg::String>("~/out", 1);
}
class Crane : public Winch { public: explicit Crane(const rclcpp::NodeOptions & options); };
Crane::Crane(const rclcpp::NodeOptions & options) : %s {}
}
"""
OWN = CLASSES % 'Winch("crane", options)'
INHERITED = CLASSES % "Winch(options)"


def make_main(name: str) -> str:
    return f"""int main(int c, char ** v) {{
  rclcpp::init(c, v);
  rclcpp::NodeOptions options;
  rclcpp::spin(std::make_shared<yard::{name}>(options));
}}
"""


@pytest.mark.parametrize(
    "code, expected",
    [
        (OWN + make_main("Crane"), {"p/robot": "/crane"}),
        (OWN + make_main("Winch"), {"p/robot": "/winch"}),
        (INHERITED + make_main("Crane"), {"p/robot": "/winch"}),
        (OWN + "RCLCPP_COMPONENTS_REGISTER_NODE(yard::Crane)", {"p/yard::Crane": "/crane"}),
        (INHERITED + "RCLCPP_COMPONENTS_REGISTER_NODE(yard::Crane)", {"p/yard::Crane": "/winch"}),
        (
            OWN + "RCLCPP_COMPONENTS_REGISTER_NODE(yard::Crane)\nRCLCPP_COMPONENTS_REGISTER_NODE(yard::Winch)",
            {"p/yard::Crane": "/crane", "p/yard::Winch": "/winch"},
        ),
    ],
)  # fmt: skip
def test_a_node_is_called_as_the_constructor_that_begins_it_says(code, expected):
    found = graph({"p/robot.cpp": code})
    assert {node.id: node.name for node in found.nodes} == expected
    names = {node.id: node.name for node in found.nodes}
    topics = {(names[each.node], each.topic) for each in found.endpoints if each.role == "publisher"}
    assert topics >= {(name, f"{name}/out") for name in expected.values()}
