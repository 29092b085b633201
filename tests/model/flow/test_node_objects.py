"""Programs that make several node objects: each is a node by itself, and talks in its own name."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

CPP = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/bool.hpp>
    using std_msgs::msg::Bool;
    class Aide {{
    public:
      explicit Aide(rclcpp::Node::SharedPtr node) : node_(node) {{ pub_ = node_->create_publisher<Bool>("aide", 1); }}
      rclcpp::Node::SharedPtr node_;
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    }};
    class Ear : public rclcpp::Node {{
    public:
      explicit Ear(const std::string & name) : Node(name, "ears") {{ pub_ = create_publisher<Bool>("~/heard", 1); }}
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    }};
    class Head : public rclcpp::Node {{
    public:
      Head() : Node("head") {{
        pub_ = create_publisher<Bool>("~/nod", 1);
        {inside}
      }}
      void nod() {{ pub_->publish(Bool()); {publishes} }}
      rclcpp::Publisher<Bool>::SharedPtr pub_, inner_pub_;
      rclcpp::Node::SharedPtr inner_;
      std::shared_ptr<Ear> left_, right_;
      std::shared_ptr<Aide> aide_;
    }};
    int main(int argc, char ** argv) {{
      rclcpp::init(argc, argv);
      auto head = std::make_shared<Head>();
      {main}
      rclcpp::spin(head);
    }}
"""


def list_publishers(files: dict[str, str]) -> set[tuple[str, str]]:
    """(name of the node, topic) of the publishers that the program is seen to make."""
    found = graph(files)
    names = {node.id: node.name for node in found.nodes}
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied and not one.only_if]
    return {(names[one.node], one.topic or "?") for one in made}


HEAD = ("/head", "/head/nod")


@pytest.mark.parametrize(
    "inside, main, expected",
    [
        ("", "", {HEAD}),
        (
            'inner_ = std::make_shared<rclcpp::Node>("inner"); inner_pub_ = inner_->create_publisher<Bool>("~/a", 1);',
            "",
            {HEAD, ("/inner", "/inner/a")},
        ),
        (
            "",
            'auto more = rclcpp::Node::make_shared("more"); auto p = more->create_publisher<Bool>("~/a", 1);',
            {HEAD, ("/more", "/more/a")},
        ),
        # Objects of one class, each with its name, in the namespace that their class gives.
        (
            'left_ = std::make_shared<Ear>("left"); right_ = std::make_shared<Ear>("right");',
            "",
            {HEAD, ("/ears/left", "/ears/left/heard"), ("/ears/right", "/ears/right/heard")},
        ),
        ("left_ = std::make_shared<Ear>(choose());", "", {HEAD, ("/ears/<Ear>", "/ears/<Ear>/heard")}),
        # In the namespace of another node, and below its name.
        (
            'inner_ = std::make_shared<rclcpp::Node>("inner", get_namespace());'
            'inner_pub_ = inner_->create_publisher<Bool>("a", 1);',
            "",
            {HEAD, ("/inner", "/a")},
        ),
        (
            'inner_ = std::make_shared<rclcpp::Node>("inner", get_fully_qualified_name());'
            'inner_pub_ = inner_->create_publisher<Bool>("a", 1);',
            "",
            {HEAD, ("/<namespace>/inner", "/<namespace>/a")},
        ),
        # What another class makes on a node that it is given.
        (
            'inner_ = std::make_shared<rclcpp::Node>("inner"); aide_ = std::make_shared<Aide>(inner_);',
            "",
            {HEAD, ("/inner", "/aide")},
        ),
        ("aide_ = std::make_shared<Aide>(shared_from_this());", "", {HEAD, ("/head", "/aide")}),
        # A node that is only handed on is no other.
        ("inner_ = shared_from_this(); inner_pub_ = inner_->create_publisher<Bool>(\"~/a\", 1);", "",
         {HEAD, ("/head", "/head/a")}),
    ],
)  # fmt: skip
def test_nodes_of_cpp(inside, main, expected):
    assert list_publishers({"body/main.cpp": CPP.format(inside=inside, main=main, publishes="")}) == expected


def test_a_statement_publishes_in_the_name_of_its_publisher():
    inside = 'inner_ = std::make_shared<rclcpp::Node>("inner"); inner_pub_ = inner_->create_publisher<Bool>("a", 1);'
    found = graph({"body/main.cpp": CPP.format(inside=inside, main="", publishes="inner_pub_->publish(Bool());")})
    names = {node.id: node.name for node in found.nodes}
    assert {(names[one.node], one.topic) for one in found.publishes} == {("/head", "/head/nod"), ("/inner", "/a")}


PYTHON = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Bool
    from elsewhere import Ready

    class Part(Node):
        def __init__(self, kind, name):
            super().__init__(name, namespace="parts")
            self.pub = self.create_publisher(Bool, kind + "_" + name, 1)

    class Arm(Part):
        def __init__(self, side):
            super().__init__("arm", side)
            self.more = self.create_publisher(Bool, "~/bent", 1)

    class Mixed(Ready):
        def __init__(self):
            super().__init__("anything")
            self.pub = self.create_publisher(Bool, "~/mixed", 1)

    class Body(Node):
        def __init__(self):
            super().__init__("body")
            self.pub = self.create_publisher(Bool, "~/whole", 1)
            {inside}

    def main():
        rclpy.init()
        body = Body()
        {main}
        rclpy.spin(body)
"""
BODY = ("/body", "/body/whole")


@pytest.mark.parametrize(
    "inside, main, expected",
    [
        ("pass", "pass", {BODY}),
        ("self.arm = Arm('left')", "pass", {
            BODY, ("/parts/left", "/parts/arm_left"), ("/parts/left", "/parts/left/bent"),
        }),
        ("self.arms = [Arm('left'), Arm('right')]", "leg = Part('leg', 'third')", {
            BODY, ("/parts/left", "/parts/arm_left"), ("/parts/left", "/parts/left/bent"),
            ("/parts/right", "/parts/arm_right"), ("/parts/right", "/parts/right/bent"),
            ("/parts/third", "/parts/leg_third"),
        }),
        ("pass", "more = rclpy.create_node('more')\n        more.create_publisher(Bool, '~/a', 1)",
         {BODY, ("/more", "/more/a")}),
        # A class from elsewhere that does what nodes do: another node, whose name nothing here tells.
        ("self.mixed = Mixed()", "pass", {BODY, ("/<Mixed>", "/<Mixed>/mixed")}),
        ("self.other = self\n            self.other.create_publisher(Bool, '~/a', 1)", "pass",
         {BODY, ("/body", "/body/a")}),
    ],
)  # fmt: skip
def test_nodes_of_python(inside, main, expected):
    assert list_publishers({"body/body.py": PYTHON.format(inside=inside, main=main)}) == expected


@pytest.mark.parametrize(
    "started, expected",
    [
        ("", {("/body", "/body/whole"), ("/parts/left", "/parts/left/bent")}),
        ('namespace="/robot"', {("/robot/body", "/robot/body/whole"), ("/robot/left", "/robot/left/bent")}),
        # ROS 2 gives the name to all nodes of the process.
        ('name="only"', {("/only", "/only/whole"), ("/parts/only", "/parts/only/bent")}),
    ],
)
def test_nodes_of_a_program_that_is_started(tmp_path, started, expected):
    found = graph_on_disk(tmp_path, {
        "body/package.xml": manifest("body", "ament_python"),
        "body/setup.py": """
            from setuptools import setup
            setup(name="body", packages=["body"], entry_points={"console_scripts": ["body = body.body:main"]})
        """,
        "body/body/__init__.py": "",
        "body/body/body.py": PYTHON.format(inside="self.arm = Arm('left')", main="pass"),
        "body/launch/body.launch.xml": f'<launch><node pkg="body" exec="body" {started}/></launch>',
    }, "body/launch/body.launch.xml")  # fmt: skip
    told = {(node, topic) for node, topic, _ in ends(found, "publisher")}
    assert told >= expected
    assert {node for node, _ in told} == {node for node, _ in expected}


def test_a_component_and_the_node_that_it_makes(tmp_path):
    """The name and the remappings that a launch gives a component are in its options; a node that is made without them
    is one of the process, which the launch names like the container."""
    found = graph_on_disk(tmp_path, {
        "body/package.xml": manifest("body", "ament_cmake"),
        "body/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.16)
            project(body)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp_components REQUIRED)
            add_library(body SHARED body.cpp)
            rclcpp_components_register_nodes(body "Eye")
            ament_package()
        """,
        "body/body.cpp": """
            #include <rclcpp/rclcpp.hpp>
            class Eye : public rclcpp::Node {
            public:
              explicit Eye(const rclcpp::NodeOptions & options) : Node("eye", options) {
                pub_ = create_publisher<std_msgs::msg::Bool>("seen", 1);
                inner_ = std::make_shared<rclcpp::Node>("lid");
                lid_ = inner_->create_publisher<std_msgs::msg::Bool>("seen", 1);
              }
              rclcpp::Node::SharedPtr inner_;
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_, lid_;
            };
            RCLCPP_COMPONENTS_REGISTER_NODE(Eye)
        """,
        "body/launch/eye.launch.xml": """
            <launch><node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="">
              <composable_node pkg="body" plugin="Eye" name="left_eye" namespace="face">
                <remap from="seen" to="looked"/>
              </composable_node>
            </node_container></launch>
        """,
    }, "body/launch/eye.launch.xml")  # fmt: skip
    told = {(node, topic) for node, topic, _ in ends(found, "publisher")}
    assert told == {("/face/left_eye", "/face/looked"), ("/box", "/seen")}


def test_of_several_constructors_the_one_that_takes_as_many_arguments_is_called():
    text = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/bool.hpp>
    class Beat : public rclcpp::Node {
    public:
      Beat(const rclcpp::NodeOptions & options) : Beat("", options) {}
      Beat(const std::string & space, const rclcpp::NodeOptions & options) : rclcpp::Node("beat", space, options) {
        pub_ = create_publisher<std_msgs::msg::Bool>("tick", 1);
      }
      rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::NodeOptions options;
      rclcpp::spin(std::make_shared<Beat>(%s));
    }
    """
    for given, expected in (("options", ("/beat", "/tick")), ('"left", options', ("/left/beat", "/left/tick"))):
        assert list_publishers({"p/main.cpp": text % given}) == {expected}
