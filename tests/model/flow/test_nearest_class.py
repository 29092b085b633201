"""Which of several classes of one name is meant: the nearest."""

import pytest
from joining import ends, graph, joined

GLOBAL, INSIDE = "class Talker {};", "namespace n { class Talker {}; }"


@pytest.mark.parametrize(("files", "scope", "meant"), [
    ({"a/main.cpp": GLOBAL, "a/b.cpp": INSIDE, "c/b.cpp": GLOBAL}, "", "a/main.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "c/b.cpp": GLOBAL}, "", "a/b.cpp"),
    ({"a/main.cpp": "", "c/b.cpp": GLOBAL}, "", "c/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "a/c.cpp": INSIDE}, "", None),
    # The file counts more than a namespace, and so does the package; the namespace decides within one.
    ({"a/main.cpp": GLOBAL, "a/b.cpp": INSIDE}, "n", "a/main.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "c/b.cpp": INSIDE}, "n", "a/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": INSIDE, "a/c.cpp": GLOBAL}, "n", "a/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": INSIDE, "a/c.cpp": GLOBAL}, "other", None),
    ({"a/main.cpp": GLOBAL + INSIDE}, "n", "a/main.cpp"),
])  # fmt: skip
def test_the_nearest_class_is_meant(files, scope, meant):
    code = joined(files).code
    source = next(source for source in code.sources if source.path == "a/main.cpp")
    found = code.find_class("Talker", source, scope)
    assert (found and found.source.path) == meant


@pytest.mark.parametrize(("main", "meant"), [
    # Of its own package first, unless another package's is included.
    ("", "a/talker.hpp"),
    ("#include <c/talker.hpp>", "c/include/c/talker.hpp"),
    ("#include <c/all.hpp>", "c/include/c/talker.hpp"),
    ("#include <d/talker.hpp>", "a/talker.hpp"),
])  # fmt: skip
def test_a_class_that_is_included_is_meant_before_others(main, meant):
    files = {
        "a/main.cpp": main, "a/talker.hpp": GLOBAL, "c/include/c/talker.hpp": GLOBAL,
        "c/include/c/all.hpp": '#include "talker.hpp"',
    }  # fmt: skip
    code = joined(files).code
    found = code.find_class("Talker", next(one for one in code.sources if one.path == "a/main.cpp"))
    assert found is not None
    assert found.source.path == meant


MAIN = """
    {included}
    int main(int c, char** v) {{
      ros::init(c, v, "talker");
      {type} nh;
      ros::Publisher pub = nh.advertise<std_msgs::Empty>("go", 1);
      ros::spin();
    }}
"""
# What libraries for microcontrollers have.
RENAMED = "namespace ros { typedef NodeHandle_<Serial> NodeHandle; }"
SHORT = "namespace own { using Handle = ros::NodeHandle; }"


@pytest.mark.parametrize(("included", "type", "files", "expected"), [
    ("#include <ros/ros.h>", "ros::NodeHandle", {"board/lib/ros.h": RENAMED}, {"/go"}),
    ("#include <ros/ros.h>", "ros::NodeHandle", {"a/board/lib/ros.h": RENAMED}, {"/go"}),
    ("#include <ros/ros.h>\nusing namespace ros;", "NodeHandle", {"a/board/lib/ros.h": RENAMED}, {"/go"}),
    # Copies of headers of other packages, which lead to it, are for the board too.
    ("#include <tf/tf.h>", "ros::NodeHandle", {"board/lib/ros.h": RENAMED, "board/lib/tf/tf.h": "#include <ros.h>"},
     {"/go"}),
    ("#include <tf/tf.h>", "ros::NodeHandle",
     {"a/board/lib/ros.h": RENAMED, "a/board/lib/tf/tf.h": '#include "ros.h"'}, {"/go"}),
    # The program of the board itself is none of roscpp.
    ('#include "board/lib/ros.h"', "ros::NodeHandle", {"a/board/lib/ros.h": RENAMED}, set()),
    ('#include "own.h"', "own::Handle", {"a/own.h": SHORT}, {"/go"}),
    ("#include <b/all.h>", "own::Handle", {"b/include/b/all.h": "#include <b/own.h>", "b/include/b/own.h": SHORT},
     {"/go"}),
    ("#include <own/own.h>", "own::Handle", {"a/src/own/own.h": SHORT}, {"/go"}),
    ("#include <own/own.h>", "own::Handle", {"b/own/own.h": SHORT, "b/b.cpp": ""}, set()),
    ("#include <b/own.h>", "own::Handle", {"b/own.h": SHORT}, {"/go"}),
    # A header sees what whoever includes it has included before.
    ('#include "own.h"\n#include "more.h"', "More", {"a/own.h": SHORT, "a/more.h": "using More = own::Handle;"},
     {"/go"}),
    ("#include <ros/ros.h>", "own::Handle", {"b/include/b/own.h": SHORT}, set()),
])  # fmt: skip
def test_another_name_of_a_class_holds_where_it_is_included(included, type, files, expected):
    found = graph({"a/main.cpp": MAIN.format(included=included, type=type), **files}, ros=1)
    assert {topic for _, topic, _ in ends(found, "publisher")} == expected
    assert found.coverage.calls == 1


def test_calls_on_classes_that_nobody_has_are_counted():
    text = """
        class Driver : public other::Base {
         public:
          Driver() {
            one_ = advertise<std_msgs::Empty>("one", 1);
            two_ = this->advertise<std_msgs::Empty>("two", 1);
            three_ = wrapper_.advertise<std_msgs::Empty>("three", 1);
            four_ = own_.advertise<std_msgs::Empty>("four", 1);
          }
          other::Wrapper wrapper_;
          Own own_;
        };
        struct Own { template <class T> int advertise(const char* name, int size) { return size; } };
        int main(int c, char** v) { ros::init(c, v, "a"); Driver driver; }
    """
    found = graph({"a/main.cpp": text}, ros=1)
    assert not ends(found, "publisher")
    assert [(one.what, one.written) for one in found.coverage.unresolved] == [
        ("call", "advertise"), ("call", "this.advertise"), ("call", "wrapper_.advertise"),
    ]  # fmt: skip
