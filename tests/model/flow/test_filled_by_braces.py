"""Members of objects that braces fill one by one."""

import pytest
from joining import graph, manifest

CODE = """
    #include <ros/ros.h>
    #include <std_msgs/Empty.h>
    struct Part {
      static int count;
      std::string input;
      std::string output = "out";
      int depth{1};
    };
    struct Made {
      Made(const std::string & first, const std::string & second) : input(second), output(first) {}
      std::string input, output;
    };
    struct Derived : Part {};
    static const Part PARTS[] = {{"a", "b"}, {"c", "d", 5}};
    SEND
    class Arm {
     public:
      explicit Arm(ros::NodeHandle & nh) {
        BODY
      }
     private:
      Part part_{"x", "y"};
      std::vector<Part> parts_ = {{"m", "n"}, {"o", "p"}};
      ros::Publisher pub_;
    };
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "arm");
      ros::NodeHandle nh;
      Arm arm(nh);
      ros::spin();
    }
"""
SEND = """
    void send(ros::NodeHandle & nh, const Part & part) { pub = nh.advertise<std_msgs::Empty>(part.output, 1); }
"""


def list_topics(body: str) -> set[str]:
    code = CODE.replace("BODY", body).replace("SEND", SEND if "send(" in body else "")
    found = graph({"p/package.xml": manifest("p", "catkin"), "p/arm.cpp": code}, 1)
    return {e.topic or "?" for e in found.endpoints if e.role == "publisher" and not e.implied}


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('Part part{"a", "b"}; pub_ = nh.advertise<std_msgs::Empty>(part.output, 1);', {"/b"}),
        ('Part part = {"a", "b"}; pub_ = nh.advertise<std_msgs::Empty>(part.input + "/raw", 1);', {"/a/raw"}),
        ('auto part = Part{"a", "b"}; pub_ = nh.advertise<std_msgs::Empty>(part.input, 1);', {"/a"}),
        ("pub_ = nh.advertise<std_msgs::Empty>(part_.output, 1);", {"/y"}),
        ("for (const auto & one : PARTS) pub_ = nh.advertise<std_msgs::Empty>(one.output, 1);", {"/b", "/d"}),
        ("for (const Part & one : parts_) pub_ = nh.advertise<std_msgs::Empty>(one.input, 1);", {"/m", "/o"}),
        ('send(nh, Part{"a", "b"});', {"/b"}),
        ('send(nh, {"a", "b"}); send(nh, {"c", "d"});', {"/b", "/d"}),
        # What braces leave out is what it is declared with.
        ('Part part{"a"}; pub_ = nh.advertise<std_msgs::Empty>(part.output, 1);', {"/out"}),
    ],
)
def test_what_braces_fill(body, expected):
    assert list_topics(body) == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        # A constructor may put them elsewhere.
        ('Made made{"a", "b"}; pub_ = nh.advertise<std_msgs::Empty>(made.input, 1);', {"/b"}),
        # What is written later takes its place.
        ('Part part{"a", "b"}; part.input = "c"; pub_ = nh.advertise<std_msgs::Empty>(part.input, 1);', {"/c"}),
        # Braces fill the base first.
        ('Derived part{"a", "b"}; pub_ = nh.advertise<std_msgs::Empty>(part.output, 1);', {"/out"}),
    ],
)
def test_what_braces_do_not_fill_in_this_order(body, expected):
    assert list_topics(body) == expected
