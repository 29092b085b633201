"""A class that several programs make: each has the names that it gives, and none those of another."""

from joining import ends, graph, joined

CLASS = """
    class Lamp {
     public:
      Lamp(rclcpp::Node::SharedPtr node, const std::string & name) {
        node->create_publisher<std_msgs::msg::Empty>(name + "/light", 1);
      }
    };
"""
MAIN = """
    #include "lamp.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("NODE");
      std::string names[2] = {"/zero", "/one"};
      Lamp lamp(node, GIVEN);
    }
"""


def make_programs(**given: str) -> dict[str, str]:
    """A source for each program, by its name, with what it gives the class."""
    mains = {f"pier/src/{name}.cpp": MAIN.replace("NODE", name).replace("GIVEN", text) for name, text in given.items()}
    return {"pier/src/lamp.hpp": CLASS, **mains}


def test_what_a_program_gives_that_is_not_known_is_no_name_of_another():
    found = graph(make_programs(first='"/a"', second="argv[1]", third="find(4)"))
    assert ends(found, "publisher") == {
        ("pier/first", "/a/light", "std_msgs/Empty"), ("pier/second", "?", "std_msgs/Empty"),
        ("pier/third", "?", "std_msgs/Empty"),
    }  # fmt: skip


def test_a_call_whose_name_one_program_leaves_open_is_not_resolved():
    assert graph(make_programs(first='"/a"', second='"/b"')).coverage.resolved == 1
    coverage = graph(make_programs(first='"/a"', second="find(4)")).coverage
    assert (coverage.calls, coverage.resolved) == (1, 0)
    assert [(one.what, one.line) for one in coverage.unresolved] == [("publisher name", 5)]


def test_an_object_that_is_made_with_an_element_is_no_function():
    assert ends(graph(make_programs(first="names[1]")), "publisher") == {
        ("pier/first", "/one/light", "std_msgs/Empty")
    }
    # A function that is declared makes nothing.
    main = MAIN.replace("GIVEN", '"/a"').replace("Lamp lamp(node", "int lamp(int [3], Lamp);\n      Lamp(node")
    code = joined({"pier/src/lamp.hpp": CLASS, "pier/src/first.cpp": main})
    assert not any(each.target == "lamp" for fn in code.code.functions for each in fn.facts.assignments)


def test_a_name_that_ros_refuses_is_not_resolved():
    coverage = graph(make_programs(first='"/1"')).coverage
    assert (coverage.resolved, [one.reason for one in coverage.unresolved]) == (
        0, ["`/1/light` is no name of a topic or service"],
    )  # fmt: skip
