"""Launch files are followed once for all who ask what they start, and not again when nothing changed."""

import pytest
from joining import manifest, write
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow import launches
from rosimpact.impact.model.flow.workspace import link_for_flow, make_graph

PLUGINS = '<library path="plug"><class type="host::Red" base_class_type="host::Layer"/></library>'
PLUG = """
    #include <pluginlib/class_list_macros.hpp>
    #include <rclcpp/rclcpp.hpp>
    namespace host {
    class Red : public Layer {
     public:
      void initialize(rclcpp::Node::SharedPtr node) { p_ = node->create_publisher<Bool>("red", 1); }
    };
    }
    PLUGINLIB_EXPORT_CLASS(host::Red, host::Layer)
"""
LAUNCH = """
    <launch>
      <node pkg="other" exec="server" name="NAME"><param name="layer.plugin" value="host::Red"/></node>
    </launch>
"""
BUILD = """
    project(host)
    add_library(plug SHARED plug.cpp)
    pluginlib_export_plugin_description_file(host plugins.xml)
    ament_package()
"""


def list_hosts(root) -> set[str]:
    with Store(root / ".cache") as store:
        found = make_graph(link_for_flow(open_tree(root, ""), store), store)
    return {node.name for node in found.nodes if node.plugin}


@pytest.fixture
def followed(monkeypatch):
    """The launch files that are followed."""
    found = []
    follow = launches.follow

    def count(package, path, *more, **given):
        found.append(path)
        return follow(package, path, *more, **given)

    monkeypatch.setattr(launches, "follow", count)
    return found


def test_plugins_that_launch_files_load(tmp_path, followed):
    files = {
        "host/package.xml": manifest("host", "ament_cmake"), "host/CMakeLists.txt": BUILD, "host/plugins.xml": PLUGINS,
        "host/plug.cpp": PLUG, "host/launch/a.launch.xml": LAUNCH.replace("NAME", "map"),
    }  # fmt: skip
    write(tmp_path, files)
    assert list_hosts(tmp_path) == {"/map"}
    assert followed == ["launch/a.launch.xml"]
    assert list_hosts(tmp_path) == {"/map"}
    assert followed == ["launch/a.launch.xml"]
    write(tmp_path, {"host/launch/a.launch.xml": LAUNCH.replace("NAME", "field")})
    assert list_hosts(tmp_path) == {"/field"}
    assert len(followed) == 2
