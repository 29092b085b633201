"""What the elements of lists and dictionaries are: in loops, at a place, at a key."""

import pytest
from joining import graph

PYTHON = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty

LIMITS = {"low": 0, "high": 9}
TOPICS = {"scan": "/front", "odom": "/base"}
ORDER = ("/first", "/second")


class Panel(Node):
    ROWS = [("left", 1), ("right", 2)]

    def __init__(self):
        super().__init__("panel")
        self.fill()

    def fill(self):
        HERE

    def list_rows(self):
        return [{"topic": "/r1", "depth": 1}, {"topic": "/r2", "depth": 2}]

    def list_full(self, names):
        return [name + "/full" for name in names]


def main():
    rclpy.spin(Panel())
"""
CPP = """
class Panel : public rclcpp::Node {
 public:
  Panel() : Node("panel") {
    HERE
  }
};
int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Panel>()); }
"""
PARAMETERS_IN_PYTHON = [
    ("for name, value in (('a', 1), ('b', 2)): self.declare_parameter(name, value)", {"a", "b"}),
    ("for name, value in LIMITS.items(): self.declare_parameter('limit.' + name, value)", {"limit.low", "limit.high"}),
    ("for name in LIMITS: self.declare_parameter(name)", {"low", "high"}),
    ("for name in LIMITS.keys(): self.declare_parameter(name)", {"low", "high"}),
    ("for row in self.ROWS: self.declare_parameter(row[0], row[1])", {"left", "right"}),
    ("for count in range(3): self.declare_parameter(f'motor{count}')", {"motor0", "motor1", "motor2"}),
    ("for count in range(1, 3): self.declare_parameter('motor' + str(count))", {"motor1", "motor2"}),
    ("self.declare_parameters('', [(name, 0) for name in ('a', 'b')])", {"a", "b"}),
    ("rows = [('a', 1), ('b', 2)]; self.declare_parameters(namespace='arm', parameters=rows)", {"arm.a", "arm.b"}),
    ("[self.declare_parameter(name, value) for name, value in [('a', 1), ('b', 2)]]", {"a", "b"}),
    ("for name in ['a'] + ['b']: self.declare_parameter(name)", {"a", "b"}),
    # What is not written out is not known, and said so.
    ("for count in range(self.count): self.declare_parameter(f'motor{count}')", set()),
    ("for name, value in self.read().items(): self.declare_parameter(name, value)", set()),
    ("self.declare_parameters('', self.read())", set()),
    ("for value in LIMITS.values(): self.declare_parameter(self.names[value])", set()),
]
PARAMETERS_IN_CPP = [
    ('for (const auto& name : {"a", "b"}) declare_parameter(name, 0);', {"a", "b"}),
    ('for (std::string name : std::vector<std::string>{"a", "b"}) declare_parameter("x." + name, 0);', {"x.a", "x.b"}),
    ('const std::map<std::string, double> all = {{"a", 1.0}, {"b", 2.0}};\n'
     "for (const auto& [name, value] : all) declare_parameter(name, value);", {"a", "b"}),
    ('const std::map<std::string, double> all{{"a", 1.0}, {"b", 2.0}};\n'
     "for (const auto& one : all) declare_parameter(one.first, one.second);", {"a", "b"}),
    ('for (int i = 0; i < 2; ++i) declare_parameter("motor" + std::to_string(i), 0);', {"motor0", "motor1"}),
    ('for (int i = 1; i <= 2; i++) declare_parameter("motor" + std::to_string(i), 0);', {"motor1", "motor2"}),
    ('for (int i = 0; i < count_; ++i) declare_parameter("motor" + std::to_string(i), 0);', set()),
    ('for (int i = 0; i < 4; i += 2) declare_parameter("motor" + std::to_string(i), 0);', set()),
    ('for (int i = 0; i < 3; ++i) { if (i > 0) declare_parameter("motor" + std::to_string(i), 0); }', set()),
    ('double d = 0.5; declare_parameter("motor" + std::to_string(d), 0);', set()),
    ('std::vector<std::string> names(2, "a"); for (auto name : names) declare_parameter(name, 0);', set()),
]  # fmt: skip
TOPICS = [
    ("ORDER[0]", {"/first"}),
    ("ORDER[-1]", {"/second"}),
    ("TOPICS['scan']", {"/front"}),
    ("TOPICS.get('scan', '/none')", {"/front"}),
    ("TOPICS['none']", set()),
    ("ORDER[7]", set()),
    ("ORDER[self.place]", {"/first", "/second"}),
]
LOOPS = [
    ("for key in ('scan', 'odom'): pub(TOPICS[key])", {"/front", "/base"}),
    ("for key in ('scan', 'none'): pub(TOPICS[key])", set()),
    ("for topic in TOPICS.values(): pub(topic)", {"/front", "/base"}),
    ("for row in self.list_rows(): pub(row['topic'])", {"/r1", "/r2"}),
    ("for name in self.list_full(['/a', '/b']): pub(name)", {"/a/full", "/b/full"}),
    # A list that is changed has no places that are known.
    ("names = ['/a', '/b']; names.reverse(); pub(names[0])", set()),
    ("names = []; names.append('/a'); names.append('/b'); pub(names[0])", set()),
    # Of two lists, that which holds where the loop is.
    ("names = ['/a']\n        names = ['/b']\n        for name in names: pub(name)", {"/b"}),
    ("count = 0\n        while count < 3:\n            pub(f'/m{count}')\n            count += 1", set()),
    ("table = {'a': '/a'}; table['a'] = '/b'; pub(table['a'])", set()),
]


def list_parameters(path: str, around: str, body: str) -> tuple[set[str], int]:
    """The names of parameters that some code declares or reads, and how many calls it says it does not understand."""
    found = graph({path: around.replace("HERE", body.replace("\n", "\n        "))})
    unknown = [one for one in found.coverage.unresolved if one.what == "parameter name"]
    return {one.name for one in found.parameters if "<" not in one.name}, len(unknown)


@pytest.mark.parametrize(("body", "names"), PARAMETERS_IN_PYTHON)
def test_parameters_in_python(body, names):
    assert list_parameters("deck/panel.py", PYTHON, body) == (names, 0 if names else 1)


@pytest.mark.parametrize(("body", "names"), PARAMETERS_IN_CPP)
def test_parameters_in_cpp(body, names):
    assert list_parameters("deck/panel.cpp", CPP, body) == (names, 0 if names else 1)


def list_certain(body: str) -> set[str]:
    """The names of the publishers that some code makes by `pub(name)`, as far as they are stated as certain."""
    calls = body.replace("pub(", "self.create_publisher(Empty, qos_profile=1, topic=")
    found = graph({"deck/panel.py": PYTHON.replace("HERE", calls)})
    return {one.topic for one in found.endpoints if one.role == "publisher" and one.how == "literal"}


@pytest.mark.parametrize(("written", "names"), TOPICS)
def test_what_stands_at_a_place_or_a_key(written, names):
    assert list_certain(f"pub({written})") == names


@pytest.mark.parametrize(("body", "names"), LOOPS)
def test_loops_over_what_holds_more_than_texts(body, names):
    assert list_certain(body) == names


def test_a_parameter_that_is_named_in_part():
    body = """declare_parameter(plugin_name_ + ".speed", 1.0);
    declare_parameter(plugin_name_ + "." + kind(), 1.0);
    declare_parameter(plugin_name_, 1.0);
    declare_parameter(std::string("x") + "." + "y", 1.0);"""
    code = CPP.replace("HERE", body).replace("};\nint", " std::string plugin_name_;\n};\nint")
    found = graph({"deck/panel.cpp": code})
    assert [one.name for one in found.parameters] == ["<plugin_name_>.speed", "x.y"]
    assert [one.line for one in found.coverage.unresolved if one.what == "parameter name"] == [5, 6, 7]
