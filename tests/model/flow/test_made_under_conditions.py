"""Objects that are made only where a condition holds that does not: what they make depends on it."""

import pytest
from joining import graph

CPP = """
    #include <rclcpp/rclcpp.hpp>
    using std_msgs::msg::Empty;
    class Lamp {
     public:
      explicit Lamp(rclcpp::Node::SharedPtr node) : node_(node) { pub_ = node->create_publisher<Empty>("lamp", 1); }
      void open() { more_ = node_->create_publisher<Empty>("more", 1); }
      rclcpp::Node::SharedPtr node_;
      rclcpp::Publisher<Empty>::SharedPtr pub_, more_;
    };
    class Desk {
     public:
      explicit Desk(rclcpp::Node::SharedPtr node) : node_(node) {
        lit_ = node_->declare_parameter("lit", DEFAULT);
        begin();
      }
      void begin() {
        if (lit_) {
          lamp_ = std::make_unique<Lamp>(node_);
          lamp_->open();
        }
        BESIDE
      }
      bool lit_ = DEFAULT;
      rclcpp::Node::SharedPtr node_;
      std::unique_ptr<Lamp> lamp_, other_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("desk");
      Desk desk(node);
    }
"""
PYTHON = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty

class Lamp:
    def __init__(self, node):
        self.pub = node.create_publisher(Empty, "lamp", 1)

class Desk(Node):
    def __init__(self):
        super().__init__("desk")
        self.declare_parameter("lit", DEFAULT)
        if self.get_parameter("lit").value:
            self.lamp = Lamp(self)
        BESIDE

rclpy.init()
rclpy.spin(Desk())
"""


def find_conditions(files: dict[str, str]) -> set[tuple[str, str]]:
    return {(one.topic, one.only_if) for one in graph(files).endpoints if not one.implied}


@pytest.mark.parametrize(
    ("default", "beside", "expected"),
    [
        ("false", "", "lit_"),
        ("true", "", ""),
        # One that is made all the same.
        ("false", "other_ = std::make_unique<Lamp>(node_);", ""),
        ("false", "if (!lit_) { other_ = std::make_unique<Lamp>(node_); }", ""),
    ],
)
def test_what_an_object_of_cpp_makes(default, beside, expected):
    text = CPP.replace("DEFAULT", default).replace("BESIDE", beside)
    # What is made in a method depends on who calls that, too.
    called = "" if default == "true" else "lit_"
    assert find_conditions({"p/src/desk.cpp": text}) == {("/lamp", expected), ("/more", called)}


@pytest.mark.parametrize(
    ("default", "beside", "closed"),
    [("False", "pass", True), ("True", "pass", False), ("False", "self.other = Lamp(self)", False)],
)
def test_what_an_object_of_python_makes(default, beside, closed):
    text = PYTHON.replace("DEFAULT", default).replace("BESIDE", beside)
    ((topic, only_if),) = find_conditions({"p/desk.py": text})
    assert (topic, bool(only_if)) == ("/lamp", closed)


def test_objects_of_objects_too():
    holder = """
    class Holder {
     public:
      explicit Holder(rclcpp::Node::SharedPtr node) { lamp_ = std::make_unique<Lamp>(node); }
      std::unique_ptr<Lamp> lamp_;
    };
    class Desk {"""
    text = CPP.replace("DEFAULT", "false").replace("BESIDE", "").replace("    class Desk {", holder)
    text = text.replace("lamp_ = std::make_unique<Lamp>(node_);\n          lamp_->open();",
                        "held_ = std::make_unique<Holder>(node_);")  # fmt: skip
    text = text.replace("lamp_, other_;", "lamp_;\n      std::unique_ptr<Holder> held_;")
    assert ("/lamp", "lit_") in find_conditions({"p/src/desk.cpp": text})


def test_a_function_that_is_called_only_under_a_condition():
    text = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty

class Desk(Node):
    def __init__(self):
        super().__init__("desk")
        self.declare_parameter("ask", False)
        self.create_timer(1.0, self.begin)

    def ask(self):
        self.pub = self.create_publisher(Empty, "asked", 1)

    def begin(self):
        self.more = self.create_publisher(Empty, "begun", 1)

def main():
    rclpy.init()
    node = Desk()
    if node.get_parameter("ask").value:
        node.ask()
        node.begin()
    rclpy.spin(node)

main()
"""
    conditions = dict(find_conditions({"p/desk.py": text}))
    assert "ask" in conditions["/asked"]
    # A timer calls the other one all the same.
    assert conditions["/begun"] == ""
