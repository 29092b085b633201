"""Nodes of behaviour trees by version, built from what packages have at their tags."""

import pytest
from rosimpact.databuild.surface.package import link_build
from rosimpact.databuild.tree_nodes import build_table, list_libraries, list_packages, read_package
from rosimpact.impact.facts.cpp.tree_nodes import NodeClass, PortFunction, RegisteredNode, TreeNodes
from rosimpact.impact.facts.store import Store
from rosimpact.impact.targets.snapshot import load_snapshot
from rosimpact.impact.targets.tree_nodes import PackageNodes
from rosimpact.impact.tree import WorkingTree

FILES = {
    "package.xml": """<package format="3"><name>arm</name><version>1.2.3</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>ament_cmake</buildtool_depend>
<export><build_type>ament_cmake</build_type></export></package>""",
    "CMakeLists.txt": """
cmake_minimum_required(VERSION 3.16)
project(arm)
find_package(ament_cmake REQUIRED)
add_library(nodes SHARED src/nodes.cpp)
add_executable(run src/run.cpp)
add_executable(show src/show.cpp)
install(TARGETS nodes run DESTINATION lib/arm)
ament_package()
""",
    "include/arm/wave.hpp": """class Wave : public BT::SyncActionNode
{
  static BT::PortsList providedPorts() { return {BT::InputPort<int>("times")}; }
};
class Widget : public QWidget {};
""",
    "src/nodes.cpp": """
void add(Factory & factory)
{
  factory.registerNodeType<Wave>("Wave");
#ifdef OLD_NAMES
  factory.registerNodeType<Wave>("WaveStar");
#endif
  factory.registerNodeType<Wave>(name);
}
""",
    "src/run.cpp": 'int main() { f.registerNodeType<Wave>("Run"); }',
    "src/show.cpp": 'int main() { f.registerNodeType<Wave>("Show"); }',
    "test/nodes.cpp": "class TestNode : public BT::SyncActionNode {};",
}


@pytest.fixture
def read(tmp_path):
    for path, text in FILES.items():
        (tmp_path / "arm" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "arm" / path).write_text(text)
    tree = WorkingTree(tmp_path)
    with Store(tmp_path / "cache") as store:
        return read_package(link_build(tree, store, 1).packages["arm"], tree, {})


def test_what_installed_targets_register_and_what_classes_tell(read):
    nodes, unsure = read
    assert nodes.nodes == (RegisteredNode("Run", "Wave"), RegisteredNode("Wave", "Wave"))
    assert unsure == ("*", "WaveStar")
    assert [one.name for one in nodes.classes] == ["Wave", "Widget"]
    assert nodes.functions == (PortFunction("Wave", "providedPorts", ("times",), ()),)


def test_the_table_has_versions_in_order_and_only_classes_of_nodes(read):
    first = TreeNodes((RegisteredNode("Wave", "Wave"),), (NodeClass("SyncActionNode", ("TreeNode",), False),))
    packages = build_table([("arm", "1.10.0", *read), ("arm", "1.9.0", first, ())]).packages
    assert packages == {
        "arm": PackageNodes(
            ("1.9.0", "1.10.0"),
            ((RegisteredNode("Run", "Wave"), (1, 1)), (RegisteredNode("Wave", "Wave"), ())),
            ((NodeClass("SyncActionNode", ("TreeNode",), False), (0, 0)),
             (NodeClass("Wave", ("SyncActionNode",), True), (1, 1))),
            ((PortFunction("Wave", "providedPorts", ("times",), ()), (1, 1)),),
            (("*", (1, 1)), ("WaveStar", (1, 1))),
        )
    }  # fmt: skip


def test_packages_that_are_built_with_the_library():
    data = load_snapshot()
    found = list_packages(data)
    assert list_libraries(data) == {"behaviortree_cpp", "behaviortree_cpp_v3"}
    assert {"nav2_behavior_tree", "plansys2_executor", "as2_behavior_tree", "behaviortree_cpp"} < found
    assert not {"rclcpp", "nav2_msgs"} & found
