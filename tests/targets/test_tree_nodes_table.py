"""Nodes of behaviour trees by version, and the ports that classes have, by what several packages tell."""

import pytest
from rosimpact.impact.facts.cpp.tree_nodes import NodeClass, PortFunction, RegisteredNode, TreeNodes
from rosimpact.impact.targets.tree_nodes import PackageNodes, PortsFinder, load_tree_nodes

LIBRARY = TreeNodes(
    classes=(NodeClass("ActionNode", ("TreeNode",), False), NodeClass("TreeNode", (), False)),
)
OWN = TreeNodes(
    classes=(
        NodeClass("Computed", ("ActionNode",), True),
        NodeClass("Foreign", ("SomebodysNode",), False),
        NodeClass("Loop", ("Loop",), False),
        NodeClass("More", ("Wave",), True),
        NodeClass("Plain", ("ActionNode", "TreeNode"), False),
        NodeClass("Twice", ("ActionNode",), False),
        NodeClass("Twice", ("Wave",), False),
        NodeClass("Wave", ("ActionNode",), True),
    ),
    functions=(
        PortFunction("Computed", "providedPorts", ("a",), (("*", ""),)),
        PortFunction("More", "providedPorts", ("b",), (("", "basicPorts"), ("Wave", "providedPorts"))),
        PortFunction("Wave", "basicPorts", ("c",), ()),
        PortFunction("Wave", "providedPorts", ("a",), ()),
    ),
)
TABLE = [
    ("Wave", {"a"}),
    ("More", {"a", "b", "c"}),
    ("Plain", set()),
    ("Computed", None),
    ("Foreign", None),
    ("Twice", None),
    ("Loop", None),
    ("Unheard", None),
    ("", None),
]


@pytest.mark.parametrize(("name", "expected"), TABLE)
def test_ports(name, expected):
    assert PortsFinder((OWN, LIBRARY)).find_ports(name) == expected


def test_the_first_scope_that_knows_a_class_decides():
    other = TreeNodes(
        classes=(NodeClass("Wave", ("TreeNode",), True),),
        functions=(PortFunction("Wave", "providedPorts", ("z",), ()),),
    )
    assert PortsFinder((other, OWN, LIBRARY)).find_ports("Wave") == {"z"}
    assert PortsFinder((OWN, other, LIBRARY)).find_ports("Wave") == {"a"}


def test_versions():
    package = PackageNodes(
        ("1.0.0", "1.10.0", "2.0.0"),
        ((RegisteredNode("Old", "A"), (0, 0)), (RegisteredNode("Wave", "A"), ())),
        unsure=(("Maybe", (1, 2)),),
    )
    nodes = {version: package.read_version(version) for version in ("0.9.0", "1.0.5", "1.10.0", "3.0.0")}
    assert {version: found and [node.name for node in found.nodes] for version, found in nodes.items()} == {
        "0.9.0": None, "1.0.5": ["Old", "Wave"], "1.10.0": ["Wave"], "3.0.0": ["Wave"],
    }  # fmt: skip
    assert (package.list_unsure("1.0.0"), package.list_unsure("2.1.0")) == (frozenset(), {"Maybe"})


def test_the_shipped_table():
    table = load_tree_nodes()
    assert table.libraries == {"behaviortree_cpp", "behaviortree_cpp_v3"}
    assert table.list_owners("ComputePathToPose")[0] == "nav2_behavior_tree"
    nodes = table.packages["nav2_behavior_tree"].read_version("1.3.12")
    library = table.packages["behaviortree_cpp"].read_version("4.9.0")
    classes = {node.name: node.class_name for node in nodes.nodes}
    ports = PortsFinder((nodes, library)).find_ports(classes["Wait"])
    assert ports == {"wait_duration", "server_name", "server_timeout"}
