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


@pytest.mark.parametrize("register", ["", "RCLCPP_COMPONENTS_REGISTER_NODE(yard::Crane)"])
def test_what_one_class_gives_a_base_is_not_what_another_gives_it(register):
    code = (
        OWN
        + """namespace yard {
class Hoist : public Winch {
 public:
  explicit Hoist(const rclcpp::NodeOptions & options) : Winch("hoist", options) {}
};
}
int main(int c, char ** v) {
  rclcpp::init(c, v);
  rclcpp::NodeOptions options;
  auto crane = std::make_shared<yard::Crane>(options);
  auto hoist = std::make_shared<yard::Hoist>(options);
  rclcpp::spin(crane);
}
"""
        + register
    )
    found = graph({"p/robot.cpp": code})
    names = {node.id: node.name for node in found.nodes}
    expected = {("/crane", "/crane/out"), ("/hoist", "/hoist/out")}
    made = {(names[one.node], one.topic) for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made == expected


def test_a_member_has_what_the_constructor_gives_that_is_not_passed_over():
    found = graph({"p/robot.cpp": """
        #include <rclcpp/rclcpp.hpp>
        class Part {
         public:
          explicit Part(rclcpp::Node * node) : Part(node, "plain") {}
          Part(rclcpp::Node * node, const std::string & name) : node_(node), name_(name) {}
          void start() { pub_ = node_->create_publisher<std_msgs::msg::Bool>(name_, 1); }
          rclcpp::Node * node_;
          std::string name_;
          rclcpp::PublisherBase::SharedPtr pub_;
        };
        class Arm : public Part { public: explicit Arm(rclcpp::Node * node) : Part(node, "arm") {} };
        class Leg : public Part {
         public:
          explicit Leg(rclcpp::Node * node) : Part(node, "leg") {}
          void step() { step_ = node_->create_publisher<std_msgs::msg::Bool>(name_ + "_step", 1); }
          rclcpp::PublisherBase::SharedPtr step_;
        };
        int main(int argc, char ** argv) {
          rclcpp::init(argc, argv);
          auto node = std::make_shared<rclcpp::Node>("robot");
          Arm arm(node.get());
          Leg leg(node.get());
          arm.start();
          leg.start();
          leg.step();
          rclcpp::spin(node);
        }
    """})  # fmt: skip
    made = {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made == {"/arm", "/leg", "/leg_step"}
