"""The value of a variable where it is used: that of the loop around the use, or of the last assignment before it."""

import re
from textwrap import dedent, indent

import pytest
from joining import graph

# What a publisher is made by, and a program around the lines that make some.
PYTHON = (
    "self.create_publisher(Empty, {}, 1)",
    """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty

class Panel(Node):
    def __init__(self):
        super().__init__("panel")
        HERE

def main():
    rclpy.spin(Panel())
""",
)
SCRIPT = (
    "rospy.Publisher({}, Empty, queue_size=1)",
    """
import rospy
from std_msgs.msg import Empty

if __name__ == "__main__":
    rospy.init_node("panel")
    HERE
    rospy.spin()
""",
)
CPP = (
    "pubs_.push_back(create_publisher<std_msgs::msg::Empty>({}, 1))",
    """
class Panel : public rclcpp::Node {
 public:
  Panel() : Node("panel") {
    HERE
  }
  std::vector<rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr> pubs_;
};
int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Panel>()); }
""",
)


def list_published(program: tuple[str, str], path: str, body: str) -> list[set[str]]:
    """The names of the publishers that the lines of a body make by `pub(name)`, line by line."""
    call, around = program
    text = re.sub(r"pub\((\w+)\)", lambda match: call.format(match[1]), dedent(body).strip())
    column = len(re.findall(r"(?m)^( *)HERE", around)[0])
    found = graph(
        {path: around.replace(" " * column + "HERE", indent(text, " " * column))}, 1 if "rospy" in call else 2
    )
    names: dict[int, set[str]] = {}
    for one in found.endpoints:
        if one.role == "publisher" and not one.implied:
            names.setdefault(one.line, set()).add(one.topic)
    return [names[line] for line in sorted(names)]


IN_PYTHON = [
    # Two loops with one variable, on lines of their own and on one line.
    ("""
     for name in ["a", "b"]:
         full = f"{name}/set"
         pub(full)
     for name in ["c"]:
         full = name + "/get"
         pub(full)
     """, [{"/a/set", "/b/set"}, {"/c/get"}]),
    ("""
     for name in ["a", "b"]: pub(name)
     for name in ["c"]: pub(name)
     """, [{"/a", "/b"}, {"/c"}]),
    ("""
     for name in ["a", "b"]:
         for side in range(2):
             pub(name)
     for name in ["c"]:
         pub(name)
     """, [{"/a", "/b"}, {"/c"}]),
    # Comprehensions have a variable each.
    ("""
     one = [pub(name) for name in ("a", "b")]
     two = [
         pub(name)
         for name in ("c", "d")
     ]
     """, [{"/a", "/b"}, {"/c", "/d"}]),
    ("""
     name = "x"
     both = [pub(name) for name in ("a",)] + [pub(name) for name in ("b",)]
     """, [{"/a", "/b"}]),
    # Assigned anew between two uses.
    ("""
     name = "a"
     pub(name)
     name = "b"
     full = name + "/on"
     pub(full)
     name = "c"
     """, [{"/a"}, {"/b/on"}]),
    # What the next turn of a loop uses may be assigned behind the use.
    ("""
     name = "a"
     for turn in range(3):
         pub(name)
         name = "b"
     for turn in range(3):
         name = "c"
     """, [{"/a", "/b"}]),
    # Of two branches either may be the one.
    ("""
     name = "a"
     if turn:
         name = "b"
     pub(name)
     """, [{"/a", "/b"}]),
]  # fmt: skip


@pytest.mark.parametrize(("body", "expected"), IN_PYTHON)
@pytest.mark.parametrize("program", [PYTHON, SCRIPT], ids=["function", "module"])
def test_in_python(program, body, expected):
    assert list_published(program, "p/panel.py", body) == expected


@pytest.mark.parametrize(("body", "expected"), [
    ("""
     for (const std::string& name : {"a", "b"}) {
       const std::string full = name + "/set";
       pub(full);
     }
     for (const std::string& name : {"c"}) {
       const std::string full = name + "/get";
       pub(full);
     }
     """, [{"/a/set", "/b/set"}, {"/c/get"}]),
    ("""
     for (auto name : {"a", "b"}) pub(name);
     for (auto name : {"c"}) pub(name);
     """, [{"/a", "/b"}, {"/c"}]),
    ("""
     { std::string name = "a"; pub(name); }
     { std::string name = "b"; pub(name); }
     """, [{"/a"}, {"/b"}]),
    ("""
     std::string name = "a";
     pub(name);
     for (int turn = 0; turn < 2; ++turn) {
       name = "b";
       auto full = name + "/on";
       pub(full);
     }
     """, [{"/a"}, {"/b/on"}]),
    ("""
     std::string name = "a";
     for (int turn = 0; turn < 2; ++turn) {
       pub(name);
       name = "b";
     }
     """, [{"/a", "/b"}]),
])  # fmt: skip
def test_in_cpp(body, expected):
    assert list_published(CPP, "p/panel.cpp", body) == expected
