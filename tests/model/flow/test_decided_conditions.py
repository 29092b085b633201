"""Conditions that code asks of parameters and arguments: what a node does not come to is not there."""

import pytest
from joining import graph, graph_on_disk, manifest
from rosimpact.impact.facts.flow import Guard
from rosimpact.impact.model.flow.conditions import ConditionReader

KNOWN = {
    "mode": ["lidar"], "this.mode": ["lidar"], "count": ["2"], "kOne": ["1"], "on": ["true"], "off": ["False"],
    "none": [""], "either": ["1", "2"], "path": ["/a/"], "p.kind": ["3"], "n::kTwo": ["2"], "nothing": ["None"],
    "points": ["[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]"],
}  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "text", "cpp", "python"),
    [
        ("if", 'mode == "lidar"', True, True),
        ("unless", 'mode == "lidar"', False, False),
        ("if", "mode == 'lidar'", True, True),
        ("if", 'mode != "lidar"', False, False),
        ("if", "count == 2", True, True),
        ("if", "count > 2.5", False, False),
        ("if", "count >= 2", True, True),
        ("if", "count == -2", False, False),
        ("if", "on", True, True),
        ("if", "(off)", False, False),
        ("if", "on == true", True, None),
        ("if", "on and off", False, False),
        ("if", "on && !off", True, None),
        ("if", "not off or unknown", True, True),
        ("if", "unknown && off", False, None),
        ("if", "unknown || off", None, None),
        ("if", "!mode.empty() && mode.back() == 'r'", True, None),
        ("if", "mode[0] == 'l' and str(mode).strip()", None, True),
        ("if", "points.size() == 6", None, None),
        ("if", "len(points) == 6 or points[0] == '0'", None, None),
        ("if", "path.startswith('/') and not path.endswith('/')", False, False),
        ("if", "mode.lower() in ('camera', 'radar')", False, False),
        ("if", "none", None, False),  # C++ asks no string
        ("if", "mode", None, True),
        ("if", "nothing is not None", None, None),
        ("if", "this->mode == \"camera\"", False, None),
        ("if", "self.mode == 'camera'", False, False),
        ("if", "p->kind == 3", True, None),
        ("if", "count == n::kTwo", True, None),
        ("case", "count == 1 or 2", True, True),
        ("case", "count other than 1, 2", False, False),
        ("if", "either == 2", None, None),
        ("if", "either < 3", True, True),
        # What is not followed.
        ("if", "count & 2", None, None),
        ("if", "auto x = make(); x", None, None),
        ("if", "1 < count < 3", None, None),
        ("if", "!count == 0", None, None),
        ("while", "on", None, None),
        ("for", "x in mode", None, None),
        ("if", "on and " * 200 + "on", None, None),
    ],
)  # fmt: skip
def test_a_condition_is_decided_by_what_is_known(kind, text, cpp, python):
    def list_values(value):
        return [(each, "launch") for each in KNOWN.get(value.text, [])] or None

    found = [ConditionReader(language, list_values).decide_guard(Guard(kind, text, 1)) for language in (True, False)]
    assert [one.holds for one in found] == [cpp, python]
    assert all(one.is_given for one in found if one.holds is not None)


HELPER = """
    class Board : public rclcpp::Node {{
     public:
      Board() : Node("board") {{
        space_ = declare_parameter<std::string>("space"{default});
        state_ = create_publisher<std_msgs::msg::Empty>({name}, 1);
        other_ = create_publisher<std_msgs::msg::Empty>(join("/other/", "x"), 1);
      }}
      static std::string join(const std::string & space, const std::string & leaf) {{
        if (space.empty() || space == "/") return "/" + leaf;
        if (space.back() == '/') return space + leaf;
        return space + "/" + leaf;
      }}
      static std::string select(int side, bool far) {{
        switch (side) {{
          case 0: return "left";
          case 1: return far ? "right/far" : "right";
          default: return "middle";
        }}
      }}
      std::string space_;
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr state_, other_;
    }};
    int main(int c, char ** v) {{ rclcpp::init(c, v); rclcpp::spin(std::make_shared<Board>()); }}
"""

@pytest.mark.parametrize(
    ("name", "default", "expected"),
    [
        ('join("/buttons", "ok")', "", {("/buttons/ok", "literal", "")}),
        ('join("/buttons/", "ok")', "", {("/buttons/ok", "literal", "")}),
        ('join("/", "ok")', "", {("/ok", "literal", "")}),
        ('join(space_, "ok")', ', "/keys"', {("/keys/ok", "default", "")}),
        ('join(space_, "ok")', ', ""', {("/ok", "default", "")}),  # rests on the default, though the text does not
        ('join(space_, "ok")', "", {("/ok", "literal", 'space.empty() || space == "/"')}),
        ("select(1, true)", "", {("/right/far", "literal", "")}),
        ("select(2, true)", "", {("/middle", "literal", "")}),
        ("select(0, ask())", "", {("/left", "literal", "")}),
        ("select(1, ask())", "", {("/right/far", "literal", "far"), ("/right", "literal", "!far")}),
        ("select(ask(), false)", "", {
            ("/left", "literal", "side == 0"), ("/right", "literal", "side == 1"),
            ("/middle", "literal", "side other than 0, 1"),
        }),
    ],
)  # fmt: skip
def test_of_the_returns_of_a_helper_the_one_that_is_come_to_counts(name, default, expected):
    found = graph({"p/board.cpp": HELPER.format(name=name, default=default)})
    ends = {(one.topic, one.how, one.only_if) for one in found.endpoints if one.role == "publisher" and not one.implied}
    # Of another call of the same helper there is nothing in it.
    assert ends - {("/other/x", "literal", "")} == expected


FALLBACK = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Gate(Node):
        def __init__(self):
            super().__init__("gate")
            topic = str(self.declare_parameter("topic", "{default}").value).strip() or "/open"
            self.pub = self.create_publisher(Empty, topic, 1)

    def main():
        rclpy.spin(Gate())
"""


@pytest.mark.parametrize(("default", "expected"), [("", "/open"), ("shut", "/shut")])
def test_of_what_is_given_and_what_stands_for_it_one_counts(default, expected):
    found = graph({"p/gate.py": FALLBACK.format(default=default)})
    ends = [(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert ends == [(expected, "default")]


RIG = """
    #include <rclcpp/rclcpp.hpp>
    enum Kind { LASER = 1, SONAR };
    class Filter {
     public:
      Filter() : kind(LASER) {}
      void set(int given) { kind = given; }
      int kind;
    };
    class Rig : public rclcpp::Node {
     public:
      Rig() : Node("rig"), filter_(new Filter()) {
        declare_parameter<int>("kind", LASER);
        get_parameter_or<int>("kind", filter_->kind, LASER);
        mode_ = declare_parameter<std::string>("mode", "slow");
        if (filter_->kind == LASER) {
          laser_ = create_subscription<std_msgs::msg::Empty>("laser", 1, [](std_msgs::msg::Empty::SharedPtr) {});
        } else {
          sonar_ = create_subscription<std_msgs::msg::Empty>("sonar", 1, [](std_msgs::msg::Empty::SharedPtr) {});
        }
        if (mode_ == "fast") fast_ = create_publisher<std_msgs::msg::Empty>("fast", 1);
        if (ask()) asked_ = create_publisher<std_msgs::msg::Empty>("asked", 1);
      }
      std::shared_ptr<Filter> filter_;
      std::string mode_;
    };
    int main(int c, char ** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Rig>()); }
"""
WORKSPACE = {
    "rig/package.xml": manifest("rig", "ament_cmake"),
    "rig/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.10)
        project(rig)
        find_package(rclcpp REQUIRED)
        add_executable(rig src/rig.cpp)
        install(TARGETS rig DESTINATION lib/rig)
        install(DIRECTORY launch config DESTINATION share/rig)
        ament_package()
    """,
    "rig/src/rig.cpp": RIG,
    "rig/launch/rig.launch.xml": """
        <launch>
          <node pkg="rig" exec="rig" name="rig"><param from="$(find-pkg-share rig)/config/rig.yaml"/></node>
        </launch>
    """,
}


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        # Defaults are those of the code: what they close may be opened.
        ("{mood: fast}", {("/laser", ""), ("/sonar", "!(filter_->kind == LASER)"), ("/fast", 'mode_ == "fast"'),
                        ("/asked", "")}),
        ("{kind: 1}", {("/laser", ""), ("/fast", 'mode_ == "fast"'), ("/asked", "")}),
        ("{kind: 2}", {("/sonar", ""), ("/fast", 'mode_ == "fast"'), ("/asked", "")}),
        ("{kind: 2, mode: fast}", {("/sonar", ""), ("/fast", ""), ("/asked", "")}),
        ("{kind: 1, mode: slow}", {("/laser", ""), ("/asked", "")}),
    ],
)  # fmt: skip
def test_a_branch_that_the_launch_closes_is_not_there(tmp_path, settings, expected):
    files = {**WORKSPACE, "rig/config/rig.yaml": f"rig:\n  ros__parameters: {settings}\n"}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {(one.topic, one.only_if) for one in found.endpoints if not one.implied} == expected


def test_a_value_that_may_be_changed_meanwhile_leaves_the_branch_open(tmp_path):
    rig = RIG.replace("if (filter_->kind", "filter_->set(ask());\n        if (filter_->kind")
    files = {**WORKSPACE, "rig/src/rig.cpp": rig, "rig/config/rig.yaml": "rig:\n  ros__parameters: {kind: 2}\n"}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {"/laser", "/sonar"} < {one.topic for one in found.endpoints}


DRIVER = """
    #include <rclcpp/rclcpp.hpp>
    class Driver {
     public:
      explicit Driver(rclcpp::Node::SharedPtr node) : node_(node) {}
      virtual void begin() = 0;
      rclcpp::Node::SharedPtr node_;
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    class Laser : public Driver {
     public:
      explicit Laser(rclcpp::Node::SharedPtr node) : Driver(node) {}
      void begin() override { pub_ = node_->create_publisher<std_msgs::msg::Empty>("laser", 1); }
    };
    class Sonar : public Driver {
     public:
      explicit Sonar(rclcpp::Node::SharedPtr node) : Driver(node) {}
      void begin() override { pub_ = node_->create_publisher<std_msgs::msg::Empty>("sonar", 1); }
    };
    void listen(rclcpp::Node::SharedPtr node) { node->create_publisher<std_msgs::msg::Empty>("heard", 1); }
    int main(int c, char ** v) {
      rclcpp::init(c, v);
      auto node = std::make_shared<rclcpp::Node>("rig");
      std::string kind;
      node->declare_parameter<std::string>("kind", "laser");
      node->get_parameter("kind", kind);
      bool hear = node->declare_parameter<bool>("hear", true);
      std::shared_ptr<Driver> driver;
      if (kind == "laser") {
        driver = std::make_shared<Laser>(node);
      } else if (kind == "sonar") {
        driver = std::make_shared<Sonar>(node);
      } else {
        throw std::invalid_argument(kind);
      }
      driver->begin();
      if (hear) {
        listen(node);
      }
      rclcpp::spin(node);
    }
"""


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("{other: 1}", {"/laser", "/sonar", "/heard"}),
        ("{kind: laser}", {"/laser", "/heard"}),
        ("{kind: sonar, hear: false}", {"/sonar"}),
        ("{kind: camera}", set()),  # it stops
    ],
)
def test_what_is_made_or_called_in_a_closed_branch_alone_is_not_there(tmp_path, settings, expected):
    files = {**WORKSPACE, "rig/src/rig.cpp": DRIVER, "rig/config/rig.yaml": f"rig:\n  ros__parameters: {settings}\n"}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {one.topic for one in found.endpoints if not one.implied} == expected


NODES = """
    #include <rclcpp/rclcpp.hpp>
    class Laser : public rclcpp::Node {
     public:
      explicit Laser(const std::string & name) : Node(name) {
        pub_ = create_publisher<std_msgs::msg::Empty>("~/laser", 1);
      }
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    class Sonar : public rclcpp::Node {
     public:
      Sonar() : Node("sonar") { pub_ = create_publisher<std_msgs::msg::Empty>("~/sonar", 1); }
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    int main(int c, char ** v) {
      rclcpp::init(c, v);
      auto rig = std::make_shared<rclcpp::Node>("rig");
      auto state = rig->create_publisher<std_msgs::msg::Empty>("~/state", 1);
      int kind = rig->declare_parameter<int>("kind", 1);
      if (kind == 1) {
        rclcpp::spin(std::make_shared<Laser>("front"));
      } else if (kind == 2) {
        rclcpp::spin(std::make_shared<Laser>("back"));
      } else if (kind == 3) {
        rclcpp::spin(std::make_shared<Sonar>());
      } else {
        auto plain = std::make_shared<rclcpp::Node>("plain");
        auto pub = plain->create_publisher<std_msgs::msg::Empty>("~/plain", 1);
      }
    }
"""


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("{other: 1}", {"/front/laser", "/back/laser", "/sonar/sonar", "/plain/plain"}),
        ("{kind: 1}", {"/front/laser"}),
        ("{kind: 2}", {"/back/laser"}),
        ("{kind: 3}", {"/sonar/sonar"}),
        ("{kind: 4}", {"/plain/plain"}),
    ],
)
def test_of_the_nodes_of_a_program_those_are_there_that_it_makes(tmp_path, settings, expected):
    files = {**WORKSPACE, "rig/src/rig.cpp": NODES, "rig/config/rig.yaml": f"/**:\n  ros__parameters: {settings}\n"}
    files["rig/launch/rig.launch.xml"] = WORKSPACE["rig/launch/rig.launch.xml"].replace(' name="rig"', "")
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {one.topic for one in found.endpoints if not one.implied} == {"/rig/state", *expected}
    assert {one.name for one in found.nodes} == {"/rig", *("/" + topic.split("/")[1] for topic in expected)}


CONFIGURED = """
    #include <rclcpp/rclcpp.hpp>
    class Config : public rclcpp::Node {
     public:
      Config() : Node("config") { kind = declare_parameter<int>("kind", 1); }
      int kind;
    };
    void listen(rclcpp::Node::SharedPtr any) { any->create_publisher<std_msgs::msg::Empty>("seen", 1); }
    int main(int c, char ** v) {
      rclcpp::init(c, v);
      auto config = std::make_shared<Config>();
      if (config->kind == 1) {
        auto plain = std::make_shared<rclcpp::Node>("plain");
        auto pub = plain->create_publisher<std_msgs::msg::Empty>("~/plain", 1);
      }
      listen(choose());
    }
"""


@pytest.mark.parametrize(
    ("settings", "expected"),
    [("{kind: 1}", {("/plain", "/plain/plain"), ("/plain", "/seen")}), ("{kind: 2}", {("/config", "/seen")})],
)
def test_where_the_first_node_is_not_made_another_has_what_is_of_none(tmp_path, settings, expected):
    files = {**WORKSPACE, "rig/src/rig.cpp": CONFIGURED}
    files["rig/config/rig.yaml"] = f"/**:\n  ros__parameters: {settings}\n"
    files["rig/launch/rig.launch.xml"] = WORKSPACE["rig/launch/rig.launch.xml"].replace(' name="rig"', "")
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {(one.node, one.topic) for one in found.endpoints if not one.implied} == expected


def test_what_a_parameter_is_read_into_has_no_more_of_what_it_is_declared_with(tmp_path):
    rig = RIG.replace("Filter() : kind(LASER) {}", "").replace("int kind;", "int kind = LASER;")
    files = {**WORKSPACE, "rig/src/rig.cpp": rig, "rig/config/rig.yaml": "rig:\n  ros__parameters: {kind: 2}\n"}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml")
    assert {"/laser", "/sonar"}.intersection(one.topic for one in found.endpoints) == {"/sonar"}


ASKED_FOR = """
    #include <ros/ros.h>
    int main(int argc, char** argv) {
      ros::init(argc, argv, "a");
      ros::NodeHandle nh("~"), out;
      ros::Publisher pub;
      bool on = false;
      if (nh.getParam("on", on)) {
        pub = out.advertise<std_msgs::Empty>("/there", 1);
      } else {
        pub = out.advertise<std_msgs::Empty>("/lacking", 1);
      }
      if (on) {
        pub = out.advertise<std_msgs::Empty>("/on", 1);
      }
      ros::spin();
    }
"""


@pytest.mark.parametrize(("launch", "expected"), [
    ("", {("/there", ""), ("/lacking", ""), ("/on", "on")}),
    ('<param name="on" value="true"/>', {("/there", ""), ("/on", "")}),
    ('<param name="on" value="false"/>', {("/there", "")}),
])  # fmt: skip
def test_a_call_that_reads_a_parameter_tells_whether_it_is_there(tmp_path, launch, expected):
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\ncatkin_package()\nadd_executable(a src/a.cpp)\n",
        "p/src/a.cpp": ASKED_FOR,
        "p/launch/a.launch": f'<launch><node pkg="p" type="a" name="a">{launch}</node></launch>',
    }
    found = graph_on_disk(tmp_path, files, "p/launch/a.launch")
    assert {(one.topic, one.only_if) for one in found.endpoints if not one.implied} == expected
