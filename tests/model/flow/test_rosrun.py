"""Nodes of ROS 1 as a command starts them: arguments, and nodelets that a program loads into itself."""

import pytest
from joining import joined
from rosimpact.impact.model.flow.nodes import BuiltPackage
from rosrun import rosrun

RELAY = """
    std::string out_topic;
    ros::NodeHandle* handle;
    void heard(const std_msgs::String& message) { handle->advertise<std_msgs::String>(out_topic, 1); }
    int main(int argc, char** argv) {
      ros::init(argc, argv, "relay");
      ros::NodeHandle n;
      handle = &n;
      if (argc == 2)
        out_topic = std::string(argv[1]) + "_relay";
      else
        out_topic = argv[2];
      ros::Subscriber sub = n.subscribe(std::string(argv[1]), 10, heard);
    }
"""
SEVERAL = """
    std::vector<std::string> names;
    void heard(const std_msgs::String& message) {}
    int main(int argc, char** argv) {
      ros::init(argc, argv, "several");
      ros::NodeHandle n;
      for (int i = 1; i < argc; i++) {
        if (std::string(argv[i]) == "--out")
          n.advertise<std_msgs::String>(argv[i + 1], 1);
      }
      for (int at = 2; at < argc; at++)
        names.push_back(argv[at]);
      for (auto& name : names)
        n.subscribe(name, 10, heard);
    }
"""
ARGPARSE = """
    #!/usr/bin/env python3
    import argparse, rospy, roslib.message
    from std_msgs.msg import String
    if __name__ == "__main__":
        parser = argparse.ArgumentParser()
        parser.add_argument("input")
        parser.add_argument("--output", default="/plain")
        args = parser.parse_args(rospy.myargv()[1:])
        rospy.init_node("relay")
        pub = rospy.Publisher(args.output, String, queue_size=1)
        rospy.Subscriber(args.input, String, pub.publish)
"""
LOADER = """
    namespace proc {
    class Rectify : public nodelet::Nodelet {
      void onInit() {
        pub_ = getNodeHandle().advertise<sensor_msgs::Image>("image_rect", 1);
        own_ = getPrivateNodeHandle().advertise<std_msgs::String>("state", 1);
      }
      ros::Publisher pub_, own_;
    };
    }
    PLUGINLIB_EXPORT_CLASS(proc::Rectify, nodelet::Nodelet)
    void side(nodelet::Loader& loader, const std::string& name) {
      nodelet::M_string remappings;
      remappings["unused"] = "gone";
      remappings.clear();
      remappings["image_rect"] = name + "/image_rect";
      loader.load(ros::this_node::getName() + "_" + name, "proc/rectify", remappings, {});
    }
    int main(int argc, char** argv) {
      ros::init(argc, argv, "stereo");
      nodelet::Loader loader(false);
      side(loader, "left");
      side(loader, "right");
    }
"""


def ends(files, command, **more) -> set[tuple[str, str, str, str]]:
    """(role, topic, type, how) of the endpoints that a command has, what every node has left out."""
    found = joined(files, 1, **more).build(launch=rosrun(*command))
    return {(e.role, e.topic, e.type, e.how) for e in found.endpoints if not e.implied}


def test_a_loop_over_all_arguments_has_each_and_an_option_has_what_follows():
    found = ends({"p/several.cpp": SEVERAL}, ("p", "several", ("--out", "/a", "/b")))
    has = {(role, topic) for role, topic, _, _ in found}
    assert has == {("publisher", "/a"), ("subscriber", "/a"), ("subscriber", "/b")}


@pytest.mark.parametrize(
    "arguments, output",
    [(("/in", "/out"), "/out"), (("/in",), "/in_relay"), (("/in", "/out", "/out:=/there"), "/there")],
)
def test_arguments_of_cpp(arguments, output):
    found = ends({"p/relay.cpp": RELAY}, ("p", "relay", arguments))
    assert {(role, topic) for role, topic, _, _ in found} == {("subscriber", "/in"), ("publisher", output)}


def test_arguments_of_argparse():
    found = ends({"p/relay.py": ARGPARSE}, ("p", "relay.py", ("/in",)))
    assert found == {
        ("subscriber", "/in", "std_msgs/String", "given"),
        ("publisher", "/plain", "std_msgs/String", "default"),
    }
    found = ends({"p/relay.py": ARGPARSE}, ("p", "relay.py", ("/in", "--output", "/out")))
    assert ("publisher", "/out", "std_msgs/String", "given") in found


OPTIONS = {
    "py": """
        import sys, rospy
        from std_msgs.msg import String
        class Relay:
            def __init__(self):
                self.space = "/plain"
                for i in range(0, len(sys.argv)):
                    if sys.argv[i] == '-ns' or sys.argv[i] == '--namespace':
                        if len(sys.argv) > i+1:
                            self.space = sys.argv[i+1]
                self.pub = rospy.Publisher(self.space + "/out", String, queue_size=1)
        rospy.init_node("relay")
        Relay()
    """,
    "cpp": """
        int main(int argc, char** argv) {
          ros::init(argc, argv, "relay");
          std::string space = "/plain", other;
          for (int i = 1; i < argc; i++) {
            if (std::string(argv[i]) == "-ns") { space = argv[i + 1]; }
            if (!strcmp(argv[i], "--namespace") || strcmp(argv[i], "--space") == 0) { space = argv[i + 1]; }
            if (strcmp(argv[i], "-x")) { other = argv[i + 1]; }
          }
          ros::NodeHandle n;
          ros::Publisher pub = n.advertise<std_msgs::String>(space + "/out", 1);
        }
    """,
}


@pytest.mark.parametrize("language", ["py", "cpp"])
@pytest.mark.parametrize(
    "arguments, expected",
    [
        (("-ns", "/room"), {("/room/out", "given")}),
        (("-x", "1", "--namespace", "/room", "-y", "2"), {("/room/out", "given")}),
        (("-x", "1", "-y", "2"), {("/plain/out", "literal")}),  # the words behind other options are not it
        (("-x", "-ns"), {("", "unresolved")}),  # nothing is behind it
        ((), {("/plain/out", "literal")}),
    ],
)
def test_the_word_behind_an_option(language, arguments, expected):
    program = "relay.py" if language == "py" else "relay"
    found = ends({f"p/relay.{language}": OPTIONS[language]}, ("p", program, arguments))
    assert {(topic, how) for role, topic, _, how in found if role == "publisher"} == expected


PARSED = """
        parser = argparse.ArgumentParser()
        parser.add_argument("--space")
        parser.add_argument("--other")
        {} parser.parse_args({})
"""


@pytest.mark.parametrize("helped", [False, True])
@pytest.mark.parametrize("kept", ["args.space or '/plain'", "args.space if args.space else '/plain'"])
@pytest.mark.parametrize(
    "arguments, expected",
    [
        (None, ("/plain/out", "default")),  # nobody is known to give it
        ((), ("/plain/out", "literal")),
        (("--space", "/room"), ("/room/out", "given")),
        (("--other", "/room"), ("/plain/out", "literal")),
    ],
)
def test_what_stands_in_for_an_argument_that_is_not_given(helped, kept, arguments, expected):
    """helped: the arguments are parsed in a function of their own."""
    parsed = PARSED.format("return" if helped else "args =", "args" if helped else "")
    own, inside = (parsed, "        args = parse_args(rospy.myargv()[1:])") if helped else ("        pass", parsed)
    code = f"""
import argparse, rospy
from std_msgs.msg import String
def parse_args(args):
{own}
def main():
{inside}
        rospy.init_node("relay")
        space = {kept}
        rospy.Publisher(space + "/out", String, queue_size=1)
        rospy.Publisher(args.other + "/out", String, queue_size=1)
main()
    """
    files = {"p/relay.py": code}
    if arguments is None:
        found = {(e.topic, e.how) for e in joined(files, 1).build().endpoints if not e.implied}
    else:
        found = {(topic, how) for _, topic, _, how in ends(files, ("p", "relay.py", arguments))}
    assert expected in found
    other = ("/room/out", "given") if "--other" in (arguments or ()) else ("", "unresolved")
    assert found == {expected, other}


def test_arguments_without_those_of_ros():
    code = """
        int main(int argc, char** argv) {
          ros::init(argc, argv, "relay");
          ros::V_string words;
          ros::removeROSArgs(argc, argv, words);
          ros::NodeHandle n;
          ros::Publisher pub = n.advertise<std_msgs::String>(words[1], 1);
        }
    """
    found = ends({"p/relay.cpp": code}, ("p", "relay", ("/in", "__name:=other")))
    assert found == {("publisher", "/in", "std_msgs/String", "given")}


def test_arguments_that_nobody_gives_are_not_known():
    found = joined({"p/relay.cpp": RELAY}, 1).build()
    assert {e.topic for e in found.endpoints if not e.implied} == {""}


def test_a_program_loads_one_nodelet_twice():
    built = (BuiltPackage("p", {"stereo": ("p/stereo.cpp",)}, {}, {}, {}, {}, {"proc/rectify": "proc::Rectify"}),)
    found = ends({"p/stereo.cpp": LOADER}, ("p", "stereo"), built=built)
    assert {(topic, kind) for _, topic, kind, _ in found} == {
        ("/left/image_rect", "sensor_msgs/Image"), ("/right/image_rect", "sensor_msgs/Image"),
        ("/stereo_left/state", "std_msgs/String"), ("/stereo_right/state", "std_msgs/String"),
    }  # fmt: skip


def test_what_every_node_has():
    found = joined({"p/relay.cpp": RELAY}, 1).build(launch=rosrun("p", "relay", ("/in", "__name:=other")))
    assert {(e.role, e.topic, e.type) for e in found.endpoints if e.implied} == {
        ("publisher", "/rosout", "rosgraph_msgs/Log"),
        ("server", "/other/get_loggers", "roscpp/GetLoggers"),
        ("server", "/other/set_logger_level", "roscpp/SetLoggerLevel"),
    }


@pytest.mark.parametrize(
    "made, expected",
    [
        ("nodelet::Loader box;", {"/box/load_nodelet", "/box/unload_nodelet", "/box/list"}),
        (
            "auto box = std::make_shared<nodelet::Loader>(true);",
            {"/box/load_nodelet", "/box/unload_nodelet", "/box/list"},
        ),
        ('ros::NodeHandle nh("in"); nodelet::Loader box(nh);', {"/in/load_nodelet", "/in/unload_nodelet", "/in/list"}),
        ("nodelet::Loader box(false);", set()),
    ],
)
def test_services_of_a_manager_of_nodelets(made, expected):
    main = f'int main(int argc, char** argv) {{ ros::init(argc, argv, "box"); {made} ros::spin(); }}'
    found = joined({"p/box.cpp": main}, 1).build()
    assert {e.topic for e in found.endpoints if e.framework == "nodelet"} == expected
