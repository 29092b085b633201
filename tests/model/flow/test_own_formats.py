"""Names by functions of the code's own that format or join what they are given."""

import pytest
from joining import graph

PACK = """
    template <typename... Args>
    std::string format(const std::string& fmt, Args... args) {
      std::string ret;
      auto size = std::snprintf(nullptr, 0, fmt.c_str(), args...);
      ret.resize(size);
      std::snprintf(&ret.front(), size + 1, fmt.c_str(), args...);
      return ret;
    }
"""
LIST = """
    std::string format(const char* fmt, ...) {
      char buffer[200];
      va_list list;
      va_start(list, fmt);
      vsnprintf(buffer, sizeof(buffer), fmt, list);
      va_end(list);
      return std::string(buffer);
    }
"""
# What is formatted beside something else, or by one of several formats, is not known.
BESIDE = PACK.replace("fmt.c_str(), args...", "fmt.c_str(), 1, args...")
ENDED = PACK.replace("return ret;", 'return ret + "/end";')
NUMBER = "int format(const char* fmt, int more) { return snprintf(nullptr, 0, fmt, more); }"
NODE = """
    class Talker : public rclcpp::Node {
     public:
      Talker() : Node("talker") { create_publisher<std_msgs::msg::Bool>(HERE, 1); }
      std::string own_ = "/own";
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Talker>()); }
"""


@pytest.mark.parametrize(
    ("helper", "written", "expected"),
    [
        (PACK, 'format("%s/in", own_.c_str())', {"/own/in"}),
        (PACK, 'format("/a%d/%s", 3, "b")', {"/a3/b"}),
        (PACK, 'format("/plain")', {"/plain"}),
        (LIST, 'format("/a/%s", "b")', {"/a/b"}),
        (LIST, 'format("/a/%*d", 3, 4)', set()),
        (PACK, 'format(find(), "b")', set()),
        (BESIDE, 'format("/a/%d/%s", "b")', set()),
        (ENDED, 'format("/a/%s", "b")', set()),
        (NUMBER, 'format("/a/%s", 2)', set()),
    ],
)
def test_formats(helper, written, expected):
    found = graph({"p/talker.cpp": helper + NODE.replace("HERE", written)})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {e.topic for e in made if e.how == "literal"} == expected


PYTHON = """
import argparse

import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

SPACE = "space"
LEADING = ["", SPACE]


def name_topic(*names):
    return "/" + "/".join((SPACE,) + names)


def sort_topic(*names):
    return "/" + "/".join(sorted(names))


class Talker(Node):
    def __init__(self, space):
        super().__init__("talker")
        BODY


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--space", default=SPACE)
    args = parser.parse_args()
    rclpy.init()
    rclpy.spin(Talker(args.space))


main()
"""


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ('name_topic("a", "b")', {"/space/a/b"}),
        ("name_topic()", {"/space"}),
        ("name_topic(*find())", set()),
        ('sort_topic("b", "a")', set()),
        ('"/".join(LEADING)', {"/space"}),
        ('"/".join(LEADING + ["a"])', {"/space/a"}),
        ('"/".join(find())', set()),
        ('"/" + space + "/a"', {"/space/a"}),
    ],
)
def test_joins(written, expected):
    found = graph({"p/talker.py": PYTHON.replace("BODY", f"self.create_publisher(Bool, {written}, 1)")})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {e.topic for e in made if e.how not in ("partly", "unresolved")} == expected
