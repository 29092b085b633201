"""Nodes of behaviour trees that C++ registers: source in, names with their classes and conditions out."""

import pytest
from rosimpact.impact.facts.cpp.lexical import extract, scan
from rosimpact.impact.facts.cpp.tree_nodes import COMPUTED

TABLE = [
    ('factory.registerNodeType<nav2::Spin>("Spin");', [("Spin", "nav2::Spin")]),
    ('factory.registerNodeType<LoopNode<std::string>>("LoopString", true);', [("LoopString", "LoopNode<std::string>")]),
    ('factory.registerBuilder<arm::Wave>(\n  "Wave", builder);', [("Wave", "arm::Wave")]),
    ('factory.registerSimpleCondition("IsReady", [](BT::TreeNode &) { return check(); });', [("IsReady", "")]),
    ('CreateRosNodePlugin(Sleep, "SleepAction");', [("SleepAction", "")]),
    ('BT_REGISTER_NODES(factory)\n{\n  register_node<Wave>(factory, "Wave");\n}', [("Wave", "Wave")]),
    ('const char * NAME = "Wave";\nfactory.registerNodeType<Wave>(NAME);', [("Wave", "Wave")]),
    ('struct Wave { static constexpr auto NAME{"Wave"}; };\nf.registerNodeType<Wave>(Wave::NAME);', [("Wave", "Wave")]),
    ("factory.registerNodeType<T>(name);", [(COMPUTED, "T")]),
    ("#define ADD(T) factory.registerNodeType<T>(#T)\n", [(COMPUTED, "T")]),
    ("void registerBuilder(const TreeNodeManifest& manifest, const NodeBuilder& builder);", []),
    ('// factory.registerNodeType<Wave>("Wave");\n', []),
    ('node.registerCallback("wave"); tree.registerBehaviorTreeFromFile("registerNodeType.xml");', []),
    ('factory.registerNodeType<Wave>(', []),
]


@pytest.mark.parametrize(("text", "expected"), TABLE)
def test_registered_nodes(text, expected):
    assert [(node.name, node.type) for node in scan(text.encode()).list_tree_nodes()] == expected


def test_conditions_of_a_registration():
    text = b'#ifdef OLD\nf.registerNodeType<A>("Old");\n#endif\nf.registerNodeType<A>("New");\n'
    assert [(node.name, len(node.conditions)) for node in scan(text).list_tree_nodes()] == [("Old", 1), ("New", 0)]
    assert extract(text).tree_nodes == ("New", "Old")
