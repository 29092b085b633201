"""Names by Boost's formats, by paths, by namespaces that have another name, and by constants in them."""

import pytest
from joining import graph

CONSTANTS = """
    #pragma once
    namespace robot { namespace topics {
    constexpr char kScan[] = "scan";
    struct Names { static constexpr auto kOdom = "odom"; };
    } }
"""
MAIN = """
    #include "topics.hpp"
    #include <rclcpp/rclcpp.hpp>
    namespace t = robot::topics;
    int main(int argc, char ** argv) {{
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("n");
      {before}
      auto pub = node->create_publisher<std_msgs::msg::Empty>({name}, 1);
    }}
"""


@pytest.mark.parametrize(("before", "name", "expected"), [
    ("", "t::kScan", "/scan"),
    ("", "t::Names::kOdom", "/odom"),
    ("", "u::kScan", ""),
    ("", '(boost::format("/cam_%1%/x") % 3).str()', "/cam_3/x"),
    ("", 'boost::str(boost::format("/cam_%d/%s") % 3 % "x")', "/cam_3/x"),
    ("", '(boost::format("/cam_%2%/%1%") % "x" % "y").str()', "/cam_y/x"),
    ("", '(boost::format("/%1$s") % "x").str()', ""),
    ("", '(boost::format("/cam_%02d") % 3).str()', ""),
    ("", '(boost::format("/%1%/%2%") % "x").str()', ""),
    ("", '(std::filesystem::path("a") / "b").string()', "/a/b"),
    ('fs::path path("a");', 'path.string() + "/x"', "/a/x"),
    ('fs::path path("a");', '(path / "x").generic_string()', "/a/x"),
    ('std::filesystem::path path = "a";\npath /= "x";', "path.string()", "/a/x"),
    ('std::filesystem::path path = "a";\nif (argc > 1) {\npath /= find();\n}', "path.string()", "?"),
])  # fmt: skip
def test_names(before, name, expected):
    found = graph({"p/topics.hpp": CONSTANTS, "p/n.cpp": MAIN.format(before=before, name=name)})
    made = {(one.topic, one.how) for one in found.endpoints if not one.implied}
    if expected == "?":
        assert ("/a", "literal") not in made
    else:
        assert {topic for topic, how in made if how == "literal"} == ({expected} if expected else set())
