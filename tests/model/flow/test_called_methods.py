"""Methods that nothing calls, or that only such methods call: what they make depends on who calls them."""

import pytest
from joining import graph

HEAD = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool
"""
MOVER = """
class Kin:
    def compute(self):
        pass


class Mover:
    def __init__(self, node):
        self._node = node

    def compute(self):
        self.__prepare()

    def __prepare(self):
        self.client = self._node.create_client(Bool, "fk")

    @property
    def lazy(self):
        return self._node.create_client(Bool, "lazy")


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.mover = Mover(self)
        self.kin = Kin()
        CALLS


def main():
    rclpy.init()
    rclpy.spin(Talker())


main()
"""
DEAD = {("/fk", "something calls `Mover.__prepare`"), ("/lazy", "something calls `Mover.lazy`")}


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ("pass", DEAD),
        ("self.kin.compute()", DEAD),  # of another class
        ("self.mover.compute()", {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
        ("self.create_timer(1.0, self.mover.compute)", {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
        ("getattr(self.mover, self.name)()", {("/fk", ""), ("/lazy", "")}),
        ('getattr(self.mover, "compute")()', {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
        ("self.mover.lazy.call(1)", {("/fk", "something calls `Mover.__prepare`"), ("/lazy", "")}),
        ("while not self.mover.lazy: pass", {("/fk", "something calls `Mover.__prepare`"), ("/lazy", "")}),
        # A text names a method only where methods are looked up by texts.
        ("self.state = 'compute'", DEAD),
        ("if self.state == 'compute' or 'lazy' in self.state: pass", DEAD),
        ("self.kin.send('compute')", DEAD),
        ("self.state = 'compute'; getattr(self.mover, self.state)()", {("/fk", ""), ("/lazy", "")}),
        ("eval('self.mover.compute()')", {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
        ("self.made = {'run': self.mover.compute}", {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
        ("given(self.mover).compute()", {("/fk", ""), ("/lazy", "something calls `Mover.lazy`")}),
    ],
)
def test_what_a_method_makes_depends_on_who_calls_it(calls, expected):
    found = graph({"p/talker.py": HEAD + MOVER.replace("CALLS", calls)})
    assert {(one.topic, one.only_if) for one in found.endpoints if one.role == "client"} == expected


CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Robot : public rclcpp::Node {
     public:
      Robot() : Node("robot") { BODY }
      void more() { prepare(); }
      bool begin() { pub_ = create_publisher<std_msgs::msg::Bool>("begun", 1); return true; }
     private:
      void prepare() { pub_ = create_publisher<std_msgs::msg::Bool>("more", 1); }
      rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
      rclcpp::TimerBase::SharedPtr timer_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Robot>());
    }
"""


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("", "something calls `Robot::prepare`"),
        ("more();", ""),
        ("timer_ = create_wall_timer(1s, [this]() { more(); });", ""),
        ("timer_ = create_wall_timer(1s, std::bind(&Robot::more, this));", ""),
    ],
)
def test_in_cpp_too(body, expected):
    found = graph({"p/robot.cpp": CPP.replace("BODY", body)})
    made = {one.topic: one.only_if for one in found.endpoints if one.role == "publisher" and not one.implied}
    # Facts have no call of what is called like a container's `begin`.
    assert made == {"/more": expected, "/begun": ""}


def test_a_function_that_is_handed_on_as_a_named_argument_is_reached():
    found = graph({"p/talker.py": HEAD + """
from threading import Thread


class Talker(Node):
    def __init__(self):
        super().__init__("talker")

    def attach(self):
        self.create_publisher(Bool, "out", 1)


def watch():
    talker.attach()


def main():
    global talker
    rclpy.init()
    talker = Talker()
    Thread(target=watch).start()


talker = None
main()
"""})  # fmt: skip
    made = {(one.topic, one.only_if) for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made == {("/out", "")}


@pytest.mark.parametrize(
    ("leave", "expected"),
    [
        ("return", "something runs after return"),
        ("raise ValueError", "something runs after raise"),
        ("sys.exit(1)", "something runs after exit"),
        ("if self.count_publishers('/a'): return", ""),
        ("pass", ""),
    ],
)
def test_nothing_behind_what_surely_leaves_a_function_runs(leave, expected):
    found = graph({"p/talker.py": HEAD + f"""
import sys


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.create_publisher(Bool, "/a", 1)
        {leave}
        self.create_publisher(Bool, "/b", 1)


rclpy.init()
rclpy.spin(Talker())
"""})  # fmt: skip
    made = {one.topic: one.only_if for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made == {"/a": "", "/b": expected}


def test_in_cpp_neither():
    code = CPP.replace("BODY", 'return; pub_ = create_publisher<std_msgs::msg::Bool>("late", 1);')
    found = graph({"p/robot.cpp": code})
    made = {one.topic: one.only_if for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert made["/late"] == "something runs after return"
