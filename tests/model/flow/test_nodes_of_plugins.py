"""Nodes that a plugin makes which is none itself, as hardware of ros2_control does."""

import pytest
from joining import graph

CODE = """
    #include <hardware_interface/system_interface.hpp>
    #include <pluginlib/class_list_macros.hpp>
    #include <rclcpp/rclcpp.hpp>
    class Board : public hardware_interface::SystemInterface {
     public:
      CallbackReturn on_configure(const rclcpp_lifecycle::State &) override {
        BODY
        return CallbackReturn::SUCCESS;
      }
     private:
      std::string ask();
      std::shared_ptr<rclcpp::Node> node_, other_;
      rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
    };
    PLUGINLIB_EXPORT_CLASS(Board, hardware_interface::SystemInterface)
"""
LOADED = "what loads it is in no namespace"
PUB = 'pub_ = node_->create_publisher<std_msgs::msg::Bool>("{}", 1);'


@pytest.mark.parametrize(("body", "expected"), [
    ('node_ = std::make_shared<rclcpp::Node>("aux");' + PUB.format("~/state"), {("/aux", "/aux/state", LOADED)}),
    ('if (!node_) { node_ = rclcpp::Node::make_shared("aux"); }' + PUB.format("state"), {("/aux", "/state", LOADED)}),
    ('node_ = std::make_shared<rclcpp::Node>("aux", "arm");' + PUB.format("state"),
     {("/arm/aux", "/arm/state", LOADED)}),
    ('node_ = std::make_shared<rclcpp::Node>("aux");\nother_ = std::make_shared<rclcpp::Node>("more");'
     + PUB.format("~/a") + PUB.format("~/b").replace("node_->", "other_->"),
     {("/aux", "/aux/a", LOADED), ("/more", "/more/b", LOADED)}),
    ('node_ = std::make_shared<rclcpp::Node>("aux");' + PUB.format("/state"), {("/aux", "/state", "")}),
    # Of a name that is not known it is as before.
    ("node_ = std::make_shared<rclcpp::Node>(ask());" + PUB.format("~/state"), {("", "/<Board>/state", "")}),
])  # fmt: skip
def test_nodes_that_a_plugin_makes(body, expected):
    found = graph({"p/board.cpp": CODE.replace("BODY", body)})
    names = {node.id: node.name for node in found.nodes}
    made = (one for one in found.endpoints if one.role == "publisher" and not one.implied)
    assert {(names[one.node], one.topic, one.only_if) for one in made} == expected
