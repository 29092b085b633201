"""In each turn of a loop, its variables have what belongs together; what does not is no name."""

import pytest
from joining import graph

PYTHON = """
    import rospy
    from std_msgs.msg import Empty
    NAMES = ["x", "y"]
    SIDES = {{"l": 0, "r": 1}}

    def make(first, second):
        rospy.Publisher(f"{{first}}_{{second}}", Empty)

    def run():
        rospy.init_node("n")
        {loop}
            {call}

    run()
"""
PUT = "rospy.Publisher({}, Empty)".format


@pytest.mark.parametrize(("loop", "call", "expected"), [
    ("for i, n in enumerate(NAMES):", PUT('f"b{i}/{n}"'), {"b0/x", "b1/y"}),
    ("for i, n in enumerate(NAMES, 2):", PUT('f"{n}/a{i}"'), {"x/a2", "y/a3"}),
    ("for i, n in enumerate(NAMES, start=1):", PUT('f"a{i}"'), {"a1", "a2"}),
    ("for k, v in SIDES.items():", PUT('f"{k}{v}"'), {"l0", "r1"}),
    ("for a, b in zip(NAMES, ['p', 'q']):", PUT('a + "/" + b'), {"x/p", "y/q"}),
    ("for i, (a, b) in enumerate(zip(NAMES, ['p', 'q'])):", PUT('f"{a}/{b}/c{i}"'), {"x/p/c0", "y/q/c1"}),
    ("for i in range(2):", PUT('f"{NAMES[i]}{i}"'), {"x0", "y1"}),
    # In a function that is called in each turn.
    ("for k, v in SIDES.items():", "make(k, v)", {"l_0", "r_1"}),
    # Of two loops, each with each.
    ("for a in NAMES:", "for b in ('p', 'q'):\n                " + PUT('a + "/" + b'), {"x/p", "x/q", "y/p", "y/q"}),
    ("for a in NAMES:", PUT("a"), {"x", "y"}),
])  # fmt: skip
def test_python(loop, call, expected):
    names = {f"/{name}" for name in expected}
    found = graph({"p/n.py": PYTHON.format(loop=loop, call=call)}, ros=1)
    made = {(one.topic, one.only_if) for one in found.endpoints if one.topic and not one.implied}
    assert made == {(name, "") for name in names}


def test_comprehension():
    loop = "pubs = [\n            rospy.Publisher(f'a{i}/{n}', Empty)"
    found = graph({"p/n.py": PYTHON.format(loop=loop, call="for i, n in enumerate(NAMES)]")}, ros=1)
    assert {one.topic for one in found.endpoints if one.topic and not one.implied} == {"/a0/x", "/a1/y"}


def test_an_order_that_is_not_known_gives_no_name():
    loop, call = "for i, n in enumerate(sorted(NAMES)):", PUT('f"a{i}/{n}"')
    found = graph({"p/n.py": PYTHON.format(loop=loop, call=call)}, ros=1)
    assert not any(one.topic.startswith(("/a0", "/a1")) for one in found.endpoints)


CPP = """
    #include <ros/ros.h>
    #include <std_msgs/Empty.h>
    int main(int argc, char ** argv) {{
      ros::init(argc, argv, "n");
      ros::NodeHandle nh;
      std::vector<std::string> names = {{"x", "y"}};
      std::map<std::string, std::string> sides = {{{{"l", "p"}}, {{"r", "q"}}}};
      std::vector<ros::Publisher> pubs;
      {loop} {{
        pubs.push_back(nh.advertise<std_msgs::Empty>({name}, 1));
      }}
    }}
"""


@pytest.mark.parametrize(("loop", "name", "expected"), [
    ("for (int i = 0; i < 2; ++i)", '"a" + std::to_string(i) + "_" + std::to_string(i)', {"/a0_0", "/a1_1"}),
    ("for (int i = 0; i < 2; ++i)", "names[i] + std::to_string(i)", {"/x0", "/y1"}),
    ("for (const auto & side : sides)", 'side.first + "/" + side.second', {"/l/p", "/r/q"}),
    ("for (const auto & [key, value] : sides)", 'key + "/" + value', {"/l/p", "/r/q"}),
    ("for (const auto & name : names)", "name + name", {"/xx", "/yy"}),
])  # fmt: skip
def test_cpp(loop, name, expected):
    found = graph({"p/n.cpp": CPP.format(loop=loop, name=name)}, ros=1)
    made = {(one.topic, one.only_if) for one in found.endpoints if not one.implied}
    assert made == {(name, "") for name in expected}


def test_what_may_belong_together_is_not_certain():
    main = """
        std::string a = argc > 1 ? "x" : "y";
        std::string b = argc > 1 ? "p" : "q";
        auto pub = nh.advertise<std_msgs::Empty>(a + b, 1);
    """
    found = graph({"p/n.cpp": CPP.format(loop=main + "for (;;)", name='"z"')}, ros=1)
    assert all(one.only_if for one in found.endpoints if not one.implied and one.topic != "/z")
