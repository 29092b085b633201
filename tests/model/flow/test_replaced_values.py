"""What a variable is worth where one value takes the place of another."""

from textwrap import dedent, indent

import pytest
from joining import graph, graph_on_disk, manifest

UNKNOWN = "?"
"""A name that is not known beside those that are, which are in part then."""


def find_names(found):
    """Names of publishers, and `?` for what is not known."""
    names = {one.topic or UNKNOWN for one in found.endpoints if one.role == "publisher" and not one.implied}
    hows = {one.how for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert ("partly" in hows) == (UNKNOWN in names and len(names) > 1)
    assert (found.coverage.resolved == found.coverage.calls) == (UNKNOWN not in names)
    return names


@pytest.mark.parametrize(("body", "expected"), [
    # Something that is not known takes the place of the only value, or may.
    ("ns = ''\nif not ns:\n    ns = ask()", {"?"}),
    ("ns = ''\nif len(ns) == 0:\n    ns = ask()", {"?"}),
    ("ns = None\nif ns is None:\n    ns = ask()", {"?"}),
    ("ns = 'a'\nns = ask()", {"?"}),
    ("ns = 'a'\nif busy:\n    ns = ask()", {"/a/go", "?"}),
    ("ns = 'a'\nfor one in ask():\n    ns = one.name", {"/a/go", "?"}),
    ("ns = ask()\nif not ns:\n    ns = 'a'", {"/a/go", "?"}),
    ("try:\n    ns = ask()\nexcept OSError:\n    ns = 'a'", {"/a/go", "?"}),
    ("ns = ''\nif not ns:\n    if busy:\n        ns = ask()", {"/go", "?"}),
    ("ns = ask() if busy else 'a'", {"/a/go", "?"}),
    ("if busy:\n    ns = 'a'\nelse:\n    ns = ask()", {"/a/go", "?"}),
    # It does not where the test fails for what is known.
    ("ns = 'a'\nif not ns:\n    ns = ask()", {"/a/go"}),
    ("ns = 'a'\nif ns is None:\n    ns = ask()", {"/a/go"}),
    ("ns = 'a'\nif ns == 'b':\n    ns = ask()", {"/a/go"}),
    # All is known.
    ("ns = ask()\nns = 'a'", {"/a/go"}),
    ("ns = 'a'\nif busy:\n    ns = 'b'", {"/a/go", "/b/go"}),
    ("ns = None\nif ns is None:\n    ns = 'a'", {"/a/go"}),
    ("ns = 'x'\nif busy:\n    ns = 'a'\nelse:\n    ns = 'b'", {"/a/go", "/b/go"}),
    ("ns = 'x'\nif busy:\n    ns = 'a'\nelif idle:\n    ns = 'b'\nelse:\n    ns = 'c'", {"/a/go", "/b/go", "/c/go"}),
    ("ns = 'x'\nif busy:\n    ns = 'a'\nelif idle:\n    ns = 'b'", {"/x/go", "/a/go", "/b/go"}),
    ("ns = 'x'\nif busy:\n    ns = 'a'\n    ns = 'b'", {"/x/go", "/b/go"}),
    # Parameters and arguments are what a launch file may give.
    ("ns = 'a'\nif rospy.has_param('~ns'):\n    ns = rospy.get_param('~ns')", {"/a/go"}),
    ("ns = rospy.get_param('~ns', '')\nif not ns:\n    ns = 'a'", {"/a/go"}),
    ("ns = 'a'\nif len(sys.argv) > 1:\n    ns = sys.argv[1]", {"/a/go"}),
    ("args = parser.parse_args()\nns = 'a'\nif args.ns:\n    ns = args.ns", {"/a/go"}),
    # What is made of the variable itself.
    ("ns = 'a'\nns = ns + '/b'", {"/a/b/go"}),
    ("ns = 'a'\nns = ns.strip()", {"/a/go"}),
    ("ns = 'a'\nns = rospy.get_param('~ns', ns)", {"/a/go"}),
    ("ns = 'a'\nns = ask(ns)", {"?"}),
    ("ns = 'a'\nfor one in range(3):\n    ns = ns + '/b'", {"/a/go", "?"}),
    # Texts that are put together.
    ("ns = 'a'\nns += '/b'", {"/a/b/go"}),
    ("ns = 'a'\nif busy:\n    ns += '/b'", {"/a/go", "/a/b/go"}),
    ("ns = 'a'\nwhile busy:\n    ns += '/b'", {"/a/go", "?"}),
    ("ns = '1'\nns += number", {"?"}),
])  # fmt: skip
def test_values_of_a_variable_of_python(body, expected):
    publish = "pub = rospy.Publisher(ns + '/go', Empty, queue_size=1)\n"
    head = "import rospy\nimport sys\nfrom std_msgs.msg import Empty\n"
    whole = f"{body}\n{publish}"
    inside = f"{head}def main():\n{indent(whole, '    ')}\nmain()\n"
    assert find_names(graph({"p/a.py": inside}, ros=1)) == expected
    # So do variables of the module, and members.
    assert find_names(graph({"p/a.py": f"{head}{whole}"}, ros=1)) == expected
    members = whole.replace("ns", "self.ns").replace("~self.", "~").replace("args.self.", "args.")
    made = f"{head}class Node:\n    def __init__(self):\n{indent(members, ' ' * 8)}\nNode()\n"
    assert find_names(graph({"p/a.py": made}, ros=1)) == expected


@pytest.mark.parametrize(("body", "expected"), [
    ('std::string ns = ""; if (ns.empty()) { ns = std::getenv("ROBOT"); }', {"?"}),
    ('std::string ns; if (ns == "") { ns = ask(); }', {"?"}),
    ('std::string ns = "a";\n if (busy) { ns = ask(); }', {"/a/go", "?"}),
    ('std::string ns = "a";\n ns = ask();', {"?"}),
    ('std::string ns = busy ? ask() : "a";', {"/a/go", "?"}),
    ('std::string ns = "a";\n if (ns.empty()) { ns = ask(); }', {"/a/go"}),
    ('std::string ns = "";\n nh.param<std::string>("ns", ns, "a");\n if (!ns.empty()) { ns = "b"; }', {"/b/go"}),
    ('std::string ns = "a";\n nh.getParam("ns", ns);', {"/a/go"}),
    ('std::string ns = "a";\n if (argc > 1) { ns = argv[1]; }', {"/a/go"}),
    ('std::string ns;\n if (busy) { ns = "a"; } else { ns = "b"; }', {"/a/go", "/b/go"}),
])  # fmt: skip
def test_values_of_a_variable_of_cpp(body, expected):
    text = f"""
        int main(int argc, char** argv) {{
          ros::init(argc, argv, "a");
          ros::NodeHandle nh;
          {body}
          ros::Publisher pub = nh.advertise<std_msgs::Empty>(ns + "/go", 1);
        }}
    """.replace("; if", ";\nif")
    assert find_names(graph({"p/a.cpp": text}, ros=1)) == expected


FAR = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty
    class A(Node):
        def __init__(self, ns={default}):
            super().__init__("a")
            {written}
            self.begin()
        def begin(self):
            self.pub = self.create_publisher(Empty, self.ns + "/go", 10)
        def on_message(self, message):
            {later}
    A({given})
"""


@pytest.mark.parametrize(("default", "written", "later", "given", "expected"), [
    ("''", "self.ns = ns or ask()", "pass", "'a'", {"?"}),
    ("''", "self.ns = ns\n            if not self.ns: self.ns = ask()", "pass", "", {"?"}),
    ("''", "self.ns = ns\n            if not self.ns: self.ns = ask()", "pass", "'a'", {"/a/go"}),
    ("'b'", "self.ns = ns\n            if busy: self.ns = ask()", "pass", "", {"/b/go", "?"}),
    # What a callback writes later is another matter.
    ("'b'", "self.ns = ns", "self.ns = message.data", "", {"/b/go"}),
    ("'b'", "self.ns = ns", "if message.data: self.ns = message.data", "", {"/b/go"}),
])  # fmt: skip
def test_values_that_another_function_writes(default, written, later, given, expected):
    text = FAR.format(default=default, written=written, later=later, given=given)
    assert find_names(graph({"p/a.py": text})) == expected


def test_objects_that_are_made_with_known_and_unknown_names_have_both():
    text = """
        import rospy
        from std_msgs.msg import Empty
        class Talker:
            def __init__(self, name):
                self.name = name
                self.pub = rospy.Publisher(self.name, Empty, queue_size=1)
        Talker("a")
        Talker(ask())
    """
    found = graph({"p/a.py": dedent(text)}, ros=1)
    assert [(one.topic, one.how) for one in found.endpoints] == [("/a", "literal")]


def test_what_is_always_unknown_takes_no_place():
    """A function that gives a known text or another has both, as before."""
    text = """
        import rospy
        from std_msgs.msg import Empty
        def complete(topic):
            if topic.startswith("/"):
                return topic
            namespace = ask()
            return namespace + topic
        rospy.Publisher(complete("/a"), Empty, queue_size=1)
    """
    found = graph({"p/a.py": dedent(text)}, ros=1)
    assert [(one.topic, one.how) for one in found.endpoints] == [("/a", "literal")]


@pytest.mark.parametrize(("before", "inside", "expected"), [
    ("", "ns = 'a'\n    ns = ns + '/b'", {"/a/b"}),
    ("", "ns = 'a'\n    ns += '/b'", {"/a/b"}),
    ("ns = 'a'", "ns = ns + '/b'", {"?"}),
])  # fmt: skip
def test_a_value_that_each_turn_of_a_loop_begins_anew(before, inside, expected):
    head = "import rospy\nfrom std_msgs.msg import Empty\n"
    text = f"{head}{before}\nfor one in ask():\n    {inside}\n    rospy.Publisher(ns, Empty, queue_size=1)\n"
    assert find_names(graph({"p/a.py": text}, ros=1)) == expected


def test_a_name_that_may_be_replaced_says_so():
    text = """
        import rospy
        from std_msgs.msg import Empty
        topic = 'a'
        if busy:
            topic = ask()
        rospy.Publisher(topic, Empty, queue_size=1)
    """
    (known, unknown) = graph({"p/a.py": dedent(text)}, ros=1).endpoints
    assert (known.topic, known.how, known.only_if) == ("/a", "partly", "the name is not replaced")
    assert (unknown.topic, unknown.how, unknown.reason) == ("", "unresolved", "what `ask` gives is not known")


@pytest.mark.parametrize(("value", "expected"), [("robot", {"/robot/go"}), ("", {"?"})])
def test_what_a_launch_file_sets_decides_a_test(tmp_path, value, expected):
    text = """
        #!/usr/bin/env python3
        import rospy
        from std_msgs.msg import Empty
        rospy.init_node("a")
        ns = rospy.get_param("~ns", "")
        if not ns:
            ns = ask()
        rospy.Publisher(ns + "/go", Empty, queue_size=1)
    """
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\ncatkin_package()\ncatkin_install_python(PROGRAMS scripts/a.py)\n",
        "p/scripts/a.py": text,
        "p/launch/a.launch": f"""
            <launch><node pkg="p" type="a.py" name="a"><param name="ns" value="{value}"/></node></launch>
        """,
    }
    found = graph_on_disk(tmp_path, files, "p/launch/a.launch")
    assert {one.topic or UNKNOWN for one in found.endpoints if one.role == "publisher" and not one.implied} == expected


@pytest.mark.parametrize(("body", "depth"), [
    ("depth = 5", 5),
    ("depth = 5\nif busy:\n    depth = ask()", -1),
])  # fmt: skip
def test_a_depth_that_may_be_another_is_not_known(body, depth):
    text = f"""
import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty
class A(Node):
    def __init__(self):
        super().__init__("a")
{indent(body, ' ' * 8)}
        self.pub = self.create_publisher(Empty, "go", QoSProfile(depth=depth))
A()
"""
    (one,) = (each for each in graph({"p/a.py": text}).endpoints if each.role == "publisher" and not each.implied)
    assert one.qos is not None
    assert one.qos.depth == depth
