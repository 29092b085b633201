"""Nodes that a component makes, and what of a launch is for them: the options that a container hands to the component,
or the arguments of the process of the container, as component_manager.cpp of rclcpp_components and rcl's remap.c do."""

import pytest
from joining import ends, graph_on_disk, manifest

CODE = """
    #include <rclcpp/rclcpp.hpp>
    #include <rclcpp_components/register_node_macro.hpp>
    #include <std_msgs/msg/bool.hpp>
    using std_msgs::msg::Bool;
    namespace eye {
    class Lid : public rclcpp::Node {
     public:
      explicit Lid(const rclcpp::NodeOptions & given) : Node("lid", given) {}
    };
    class Eye : public rclcpp::Node {
     public:
      explicit Eye(HANDED) : Node(OWN) {
        seen_ = create_publisher<Bool>("seen", 1);
        MAKE
        shut_ = lid_->create_publisher<Bool>("shut", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr seen_, shut_;
      rclcpp::Node::SharedPtr lid_;
    };
    }
    RCLCPP_COMPONENTS_REGISTER_NODE(eye::Eye)
"""
EYE = """
    <composable_node pkg="eye" plugin="eye::Eye" name="left" namespace="face">
      <remap from="seen" to="looked"/><remap from="shut" to="closed"/>
    </composable_node>
"""
IN_BOX = f"""
    <node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="head">
      {EYE}
    </node_container>
"""
LEFT = ("/face/left", "/face/looked")


def list_publishers(
    tmp_path, make, launched=IN_BOX, handed="const rclcpp::NodeOptions & options", own='"eye", options'
):
    code = CODE.replace("MAKE", make).replace("HANDED", handed).replace("OWN", own)
    found = graph_on_disk(tmp_path, {
        "eye/package.xml": manifest("eye", "ament_cmake"),
        "eye/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.16)
            project(eye)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp_components REQUIRED)
            add_library(eye SHARED eye.cpp)
            rclcpp_components_register_nodes(eye "eye::Eye")
            ament_package()
        """,
        "eye/eye.cpp": code,
        "eye/launch/eye.launch.xml": f"<launch>{launched}</launch>",
    }, "eye/launch/eye.launch.xml")  # fmt: skip
    return {(node, topic) for node, topic, _ in ends(found, "publisher")}


@pytest.mark.parametrize(("make", "expected"), [
    # It has the arguments of the process.
    ('lid_ = std::make_shared<rclcpp::Node>("lid");', ("/head/box", "/head/shut")),
    ("lid_ = std::make_shared<Lid>(rclcpp::NodeOptions());", ("/head/box", "/head/shut")),
    # It has what the container hands to the component.
    ('lid_ = std::make_shared<rclcpp::Node>("lid", options);', ("/face/left", "/face/closed")),
    ("lid_ = std::make_shared<Lid>(options);", ("/face/left", "/face/closed")),
    ("rclcpp::NodeOptions own(options); lid_ = std::make_shared<Lid>(own);", ("/face/left", "/face/closed")),
    ("lid_ = std::make_shared<Lid>(rclcpp::NodeOptions(options).use_intra_process_comms(true));",
     ("/face/left", "/face/closed")),
    # It has neither.
    ('lid_ = std::make_shared<rclcpp::Node>("lid", rclcpp::NodeOptions().use_global_arguments(false));',
     ("/lid", "/shut")),
    ('lid_ = std::make_shared<rclcpp::Node>("lid", get_namespace(), '
     "rclcpp::NodeOptions().use_global_arguments(false));", ("/face/lid", "/face/shut")),
    # Its own arguments come before those of the process.
    ('lid_ = std::make_shared<rclcpp::Node>("lid", '
     'rclcpp::NodeOptions().arguments({"--ros-args", "-r", "__node:=mine"}));', ("/head/mine", "/head/shut")),
    # It is the component.
    ('lid_ = create_sub_node("upper");', ("/face/left", "/face/upper/shut")),
    ('lid_ = this->create_sub_node("upper");', ("/face/left", "/face/upper/shut")),
])  # fmt: skip
def test_a_node_that_a_component_makes(tmp_path, make, expected):
    assert list_publishers(tmp_path, make) == {LEFT, expected}


def test_a_component_that_does_not_take_its_options_is_named_like_its_container(tmp_path):
    made = 'lid_ = std::make_shared<rclcpp::Node>("lid", rclcpp::NodeOptions().use_global_arguments(false));'
    found = list_publishers(tmp_path, made, handed="const rclcpp::NodeOptions &", own='"eye"')
    assert found == {("/head/box", "/head/seen"), ("/lid", "/shut")}


@pytest.mark.parametrize(("target", "node", "topic"), [
    ("/head/box", "/head/box", "/head/shut"),
    ("/elsewhere/box", "/elsewhere/box", "/elsewhere/shut"),
    ("$(var one)", "/<namespace>/<container>", "/<namespace>/shut"),
])  # fmt: skip
def test_a_component_that_is_loaded_into_a_container(tmp_path, target, node, topic):
    started = '<node pkg="rclcpp_components" exec="component_container" name="box" namespace="head"/>'
    loaded = f'<arg name="one"/>{started}<load_composable_node target="{target}">{EYE}</load_composable_node>'
    made = 'lid_ = std::make_shared<rclcpp::Node>("lid");'
    assert list_publishers(tmp_path, made, loaded) == {LEFT, (node, topic)}
