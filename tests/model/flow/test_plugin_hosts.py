"""Plugins belong to the nodes that load them: as the code of the host says, or a launch file's parameters."""

from pathlib import Path

import pytest
from joining import graph_on_disk, manifest

BUILD = """
    cmake_minimum_required(VERSION 3.16)
    project(host)
    find_package(ament_cmake REQUIRED)
    find_package(rclcpp REQUIRED)
    find_package(pluginlib REQUIRED)
    add_executable(server server.cpp)
    add_library(plug SHARED plug.cpp)
    pluginlib_export_plugin_description_file(host plugins.xml)
    ament_package()
"""
PLUGINS = """
    <library path="plug">
      <class name="host/Blue" type="host::Blue" base_class_type="host::Layer"/>
      <class type="host::Red" base_class_type="host::Layer"/>
    </library>
"""
BASE = """
    #include <rclcpp/rclcpp.hpp>
    namespace host {
    class Layer {
     public:
      virtual void initialize(rclcpp::Node::SharedPtr node, const std::string & name) = 0;
    };
    }
"""
PLUG = """
    #include "base.hpp"
    #include <pluginlib/class_list_macros.hpp>
    using std_msgs::msg::Bool;
    namespace host {
    class Blue : public Layer {
     public:
      void initialize(rclcpp::Node::SharedPtr node, const std::string & name) override {
        p_ = node->create_publisher<Bool>("~/" + name + "/blue", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr p_;
    };
    class Red : public Layer {
     public:
      void initialize(rclcpp::Node::SharedPtr node, const std::string & name) override {
        p_ = node->create_publisher<Bool>("~/" + name + "/red", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr p_;
    };
    }
    PLUGINLIB_EXPORT_CLASS(host::Blue, host::Layer)
    PLUGINLIB_EXPORT_CLASS(host::Red, host::Layer)
"""
SERVER = """
    #include "base.hpp"
    #include <pluginlib/class_loader.hpp>
    class Server : public rclcpp::Node {
     public:
      Server() : Node("server"), loader_("host", "host::Layer") {}
      void start() {
        BODY
      }
      pluginlib::ClassLoader<host::Layer> loader_;
      std::shared_ptr<host::Layer> layer_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto server = std::make_shared<Server>();
      server->start();
    }
"""
LAUNCH = """
    from launch import LaunchDescription
    from launch_ros.actions import Node
    def generate_launch_description():
        return LaunchDescription([Node(PROGRAM, name="it", namespace="robot", parameters=[PARAMETERS])])
"""
HERE = 'package="host", executable="server"'
TWO = {"/robot/it/a/blue", "/robot/it/b/red"}


def list_made(
    root: Path, body: str, parameters: str, program: str = HERE, launch: str = ""
) -> set[tuple[str, str, str]]:  # fmt: skip
    """(node, topic, condition) of all publishers."""
    files = {
        "host/package.xml": manifest("host", "ament_cmake"), "host/CMakeLists.txt": BUILD, "host/plugins.xml": PLUGINS,
        "host/base.hpp": BASE, "host/plug.cpp": PLUG, "host/server.cpp": SERVER.replace("BODY", body),
        "host/launch/a.launch.py": LAUNCH.replace("PROGRAM", program).replace("PARAMETERS", parameters),
    }  # fmt: skip
    found = graph_on_disk(root, files, launch)
    return {(one.node, one.topic or "?", one.only_if) for one in found.endpoints if not one.implied}


@pytest.mark.parametrize(("body", "parameters", "expected"), [
    # A parameter of any name whose value is handed to the loader.
    ('declare_parameter("layer", "host/Blue");\n'
     'layer_ = loader_.createSharedInstance(get_parameter("layer").as_string());\n'
     'layer_->initialize(shared_from_this(), "a");', '{"layer": "host::Red"}', {"/robot/it/a/red"}),
    ('std::string type = declare_parameter<std::string>("plugin");\nlayer_ = loader_.createUniqueInstance(type);\n'
     'layer_->initialize(shared_from_this(), "a");', '{"plugin": "host/Blue"}', {"/robot/it/a/blue"}),
    # A list of names, each with its plugin.
    ('auto names = declare_parameter<std::vector<std::string>>("layers");\nfor (auto & name : names) {\n'
     'auto type = declare_parameter<std::string>(name + ".plugin");\nauto layer = loader_.createSharedInstance(type);\n'
     'layer->initialize(shared_from_this(), name);\n}',
     '{"layers": ["a", "b"], "a.plugin": "host/Blue", "b": {"plugin": "host::Red"}}', TWO),
    # Each is called by what its own call gives.
    ('auto one = loader_.createSharedInstance("host/Blue");\none->initialize(shared_from_this(), "a");\n'
     'auto two = loader_.createSharedInstance("host::Red");\ntwo->initialize(shared_from_this(), "b");', "{}", TWO),
    ('layer_ = loader_.createSharedInstance("host/Blue");\nlayer_->initialize(shared_from_this(), "a");\n'
     'layer_ = loader_.createSharedInstance("host::Red");\nlayer_->initialize(shared_from_this(), "b");', "{}", TWO),
    ('layer_ = loader_.createSharedInstance("host/Blue");\n'
     'layer_->initialize(shared_from_this(), loader_.getName("host/Blue"));', "{}", {"/robot/it/Blue/blue"}),
])  # fmt: skip
def test_a_host_of_the_workspace_has_what_it_loads(tmp_path, body, parameters, expected):
    made = {("/robot/it", topic, "") for topic in expected}
    assert list_made(tmp_path, body, parameters, launch="host/launch/a.launch.py") == made
    # In the graph of all it is there once, and what nothing loads is beside it.
    every = list_made(tmp_path, body, parameters)
    assert {row for row in every if row[0] == "/robot/it"} == made
    loaded = {topic.rpartition("/")[2].title() for topic in expected}
    assert {node for node, _, _ in every} - {"/robot/it"} == {
        f"host/host::{name}" for name in ("Blue", "Red") if name not in loaded
    }  # fmt: skip


def test_a_host_of_all_plugins_of_a_base_may_have_each(tmp_path):
    body = """
        for (const auto & each : loader_.getDeclaredClasses()) {
          auto layer = loader_.createSharedInstance(each);
          layer->initialize(shared_from_this(), "x");
        }
    """
    assert list_made(tmp_path, body, "{}", launch="host/launch/a.launch.py") == {
        ("/robot/it", f"/robot/it/x/{name}", "it is among the plugins that are loaded") for name in ("blue", "red")
    }


def test_what_a_host_loads_is_not_guessed(tmp_path):
    body = 'layer_ = loader_.createSharedInstance(find());\nlayer_->initialize(shared_from_this(), "a");'
    assert list_made(tmp_path, body, '{"speed": "fast"}', launch="host/launch/a.launch.py") == set()


@pytest.mark.parametrize(("parameters", "nodes"), [
    ('{"G.plugin": "host/Blue"}', {"/robot/it", "host/host::Red"}),
    ('{"G": {"plugin": "host/Blue"}}', {"/robot/it", "host/host::Red"}),
    ('{"plugin": "host/Blue"}', {"/robot/it", "host/host::Red"}),
    ('{"G.title": "host/Blue"}', {"host/host::Blue", "host/host::Red"}),
])  # fmt: skip
def test_a_host_elsewhere_has_what_its_parameters_name(tmp_path, parameters, nodes):
    made = list_made(tmp_path, "", parameters, 'package="nav2_planner", executable="planner_server"')
    assert {node for node, _, _ in made} == nodes


def test_a_parameter_file_is_for_the_node_that_a_launch_file_gives_it(tmp_path):
    (tmp_path / "host/config").mkdir(parents=True)
    (tmp_path / "host/config/p.yaml").write_text("/**:\n  ros__parameters:\n    G:\n      plugin: host/Blue\n")
    parameters = 'os.path.join(get_package_share_directory("host"), "config", "p.yaml")'
    made = list_made(tmp_path, "", parameters, 'package="nav2_planner", executable="planner_server"')
    assert {node for node, _, _ in made} == {"/robot/it", "host/host::Red"}


def test_a_node_that_a_loaded_plugin_makes_is_none_of_its_host(tmp_path, monkeypatch):
    own = """
        own_ = std::make_shared<rclcpp::Node>("own");
        q_ = own_->create_publisher<Bool>("/of_own", 1);
        p_ = node->create_publisher<Bool>("~/" + name + "/blue", 1);
    """
    plug = PLUG.replace('p_ = node->create_publisher<Bool>("~/" + name + "/blue", 1);', own)
    monkeypatch.setattr(f"{__name__}.PLUG", plug)
    body = 'layer_ = loader_.createSharedInstance("host/Blue");\nlayer_->initialize(shared_from_this(), "a");'
    assert {row[:2] for row in list_made(tmp_path, body, "{}") if "red" not in row[1]} == {
        ("/robot/it", "/robot/it/a/blue"), ("host/host::Blue/own", "/of_own"),
    }  # fmt: skip
