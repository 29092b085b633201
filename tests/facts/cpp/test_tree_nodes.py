"""Nodes of behaviour trees that C++ registers: source in, names with their classes and conditions out."""

import pytest
from rosimpact.impact.facts.cpp.lexical import extract, scan
from rosimpact.impact.facts.cpp.tree_nodes import COMPUTED, PortFunction

TABLE = [
    ('factory.registerNodeType<nav2::Spin>("Spin");', [("Spin", "nav2::Spin")]),
    ('factory.registerNodeType<LoopNode<std::string>>("LoopString", true);', [("LoopString", "LoopNode<std::string>")]),
    ('factory.registerBuilder<arm::Wave>(\n  "Wave", builder);', [("Wave", "arm::Wave")]),
    ('factory.registerSimpleCondition("IsReady", [](BT::TreeNode &) { return check(); });', [("IsReady", "")]),
    ('CreateRosNodePlugin(Sleep, "SleepAction");', [("SleepAction", "Sleep")]),
    ('BT_REGISTER_NODES(factory)\n{\n  register_node<Wave>(factory, "Wave");\n}', [("Wave", "Wave")]),
    ('const char * NAME = "Wave";\nfactory.registerNodeType<Wave>(NAME);', [("Wave", "Wave")]),
    ('struct Wave { static constexpr auto NAME{"Wave"}; };\nf.registerNodeType<Wave>(Wave::NAME);', [("Wave", "Wave")]),
    ("factory.registerNodeType<T>(name);", [(COMPUTED, "T")]),
    ("#define ADD(T) factory.registerNodeType<T>(#T)\n", [(COMPUTED, "T")]),
    ("void registerBuilder(const TreeNodeManifest& manifest, const NodeBuilder& builder);", []),
    ('// factory.registerNodeType<Wave>("Wave");\n', []),
    ('node.registerCallback("wave"); tree.registerBehaviorTreeFromFile("registerNodeType.xml");', []),
    ('factory.registerNodeType<Wave>(', []),
    ("for (auto & [id, build] : list) factory->registerBuilder<Wave>(id + suffix, build);", [(COMPUTED, "Wave")]),
]


@pytest.mark.parametrize(("text", "expected"), TABLE)
def test_registered_nodes(text, expected):
    assert [(node.name, node.type) for node in scan(text.encode()).list_tree_nodes()] == expected


def test_conditions_of_a_registration():
    text = b'#ifdef OLD\nf.registerNodeType<A>("Old");\n#endif\nf.registerNodeType<A>("New");\n'
    assert [(node.name, len(node.conditions)) for node in scan(text).list_tree_nodes()] == [("Old", 1), ("New", 0)]
    assert [node.name for node in extract(text).tree_nodes.nodes] == ["New", "Old"]


def test_nodes_that_are_given_more_than_the_ports_of_their_class():
    text = b'f.registerNodeType<A>("A");\nf.registerNodeType<B>("B", ports);\nf.registerBuilder<C>("C", build);\n'
    text += b'f.registerSimpleAction("D", act);\n'
    found = scan(text).list_tree_nodes()
    assert [(node.name, node.class_name) for node in found] == [("A", "A"), ("B", ""), ("C", "C"), ("D", "")]


CLASSES = [
    ("class A : public B<C<D>>, private virtual e::F {};", [("A", ("B", "F"), False)]),
    ("struct A final : BT::SyncActionNode { static BT::PortsList providedPorts(); };",
     [("A", ("SyncActionNode",), True)]),
    ("class ActionNode;\nclass Plain {};", []),
    ("class TreeNode { };", [("TreeNode", (), False)]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), CLASSES)
def test_classes(text, expected):
    facts = extract((text + "\nBT::NodeStatus status;").encode()).tree_nodes
    found = facts.classes if facts is not None else ()
    assert [(one.name, one.bases, one.own) for one in found] == expected


UNKNOWN = ("*", "")
FUNCTIONS = [
    ('return {InputPort<int>("a"), BT::OutputPort<std::vector<int>>("b", {1, 2}, "text")};', ("a", "b"), ()),
    ("return {};", (), ()),
    ('return {InputPort<int>(KEY)};', ("key",), ()),
    ("return {InputPort<int>(key())};", (), (UNKNOWN,)),
    ('return providedBasicPorts({InputPort<int>("a")});', ("a",), (("", "providedBasicPorts"),)),
    ('PortsList all = Base<int>::providedPorts();\nall.insert(InputPort<int>("a"));\nreturn all;', ("a",),
     (("Base", "providedPorts"),)),
    ("return others;", (), (UNKNOWN,)),
    ("return make();", (), (UNKNOWN,)),
    ("BT::describe<Pose>();\nreturn {};", (), ()),
    ('return {{"a", PortInfo(INPUT)}};', (), (UNKNOWN,)),
    ("throw 1;", (), (UNKNOWN,)),
]  # fmt: skip


@pytest.mark.parametrize(("body", "ports", "calls"), FUNCTIONS)
def test_ports_that_functions_return(body, ports, calls):
    text = f'static const char KEY[] = "key";\nstruct A : Node {{ static PortsList providedPorts() {{ {body} }} }};'
    assert extract(text.encode()).tree_nodes.functions == (PortFunction("A", "providedPorts", ports, calls),)


def test_functions_outside_of_their_class_and_with_parameters():
    text = b"""template<class T> class A : public Node { static PortsList providedPorts(); };
template<class T> PortsList A<T>::providedPorts() { return {InputPort<T>("a")}; }
PortsList withMorePorts(PortsList more) { more.insert(InputPort<int>("b")); return more; }
"""
    functions = extract(text).tree_nodes.functions
    assert [(one.of, one.name, one.ports, one.calls) for one in functions] == [
        ("", "withMorePorts", ("b",), ()), ("A", "providedPorts", ("a",), ()),
    ]  # fmt: skip
