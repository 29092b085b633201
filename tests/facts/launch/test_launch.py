"""What launch files, descriptions, parameters and shell scripts refer to."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.launch.references import PluginClass, extract
from rosimpact.impact.facts.place import Reference


def found(kind, text):
    return [(r.kind, r.package, r.name) for r in extract(text.encode(), kind).references]


LAUNCH = [
    ('<node pkg="amcl" type="amcl" name="a"/>', [("executable", "amcl", "amcl")]),
    ('<node pkg="amcl" exec="amcl"/>', [("executable", "amcl", "amcl")]),
    ("<test test-name='t' pkg='amcl' type='t.py'/>", [("executable", "amcl", "t.py")]),
    ('<node pkg="amcl" type="$(arg exe)"/>', [("package", "amcl", "")]),
    ('<node pkg="$(arg pkg)" type="x"/>', []),
    ('<include file="$(find nav)/launch/a.launch"/>', [("file", "nav", "launch/a.launch")]),
    ('<include file="$(find-pkg-share nav)/launch/a.launch.xml"/>', [("file", "nav", "launch/a.launch.xml")]),
    ("<include file=\"$(find-pkg-share 'nav')/launch//a.xml\"/>", [("file", "nav", "launch/a.xml")]),
    ('<include file="$(find nav)/launch/$(arg robot).launch"/>', [("place", "nav", "launch")]),
    ('<include file="$(find nav)/launch/a_$(arg robot).launch"/>', [("place", "nav", "launch")]),
    ('<include file="$(find nav)/../other/a.launch"/>', [("package", "nav", "")]),
    ('<include file="$(find [TEMPLATE])/a.launch"/>', []),
    ('<include file="$(eval find(\'nav\') + arg(\'x\'))"/>', [("package", "nav", "")]),
    ('<rosparam file="$(find nav)/p.yaml" command="load"/>', [("file", "nav", "p.yaml")]),
    ("<param name=\"d\" command=\"$(find xacro)/xacro '$(find bot)/urdf/b.xacro' x:=1\"/>",
     [("file", "xacro", "xacro"), ("file", "bot", "urdf/b.xacro")]),
    ('<param name="d" command="xacro $(find bot)/b.xacro"/>', [("command", "", "xacro"), ("file", "bot", "b.xacro")]),
    ("<param name=\"d\" value=\"$(command 'xacro $(find-pkg-share bot)/b.xacro')\"/>",
     [("command", "", "xacro"), ("file", "bot", "b.xacro")]),
    ('<param name="d" command="rosrun xacro xacro.py $(find bot)/b.xacro"/>',
     [("executable", "xacro", "xacro.py"), ("file", "bot", "b.xacro")]),
    ('<arg name="map" default="$(find maps)/a.yaml"/>', [("file", "maps", "a.yaml")]),
    ('<executable cmd="ls -l $(find-pkg-prefix a)/lib/a/tool"/>', [("command", "", "ls"), ("executable", "a", "tool")]),
    ('<let name="x" value="$(exec-in-pkg tool a)"/>', [("executable", "a", "tool")]),
    ('<composable_node pkg="p" plugin="p::Node" name="n"/>', [("plugin", "p", "p::Node")]),
    ('<node_container pkg="rclcpp_components" exec="component_container"/>',
     [("executable", "rclcpp_components", "component_container")]),
    ('<node pkg="nodelet" type="nodelet" args="load img/Crop manager"/>',
     [("executable", "nodelet", "nodelet"), ("plugin", "", "img/Crop")]),
    ('<param name="planning_plugin" value="chomp_interface/CHOMPPlanner"/>',
     [("plugin", "", "chomp_interface/CHOMPPlanner")]),
    ('<param name="mesh" value="package://bot/m/a.dae"/>', [("file", "bot", "m/a.dae")]),
    ('<rosparam>file: $(find bot)/a.yaml</rosparam>', [("file", "bot", "a.yaml")]),
    ('<!-- <node pkg="a" type="b"/> -->', []),
]  # fmt: skip


@pytest.mark.parametrize(("element", "expected"), LAUNCH)
def test_launch_xml(element, expected):
    text = f"<launch>\n{element}\n</launch>"
    assert found("launch_xml", text) == expected
    assert found("xml", text) == expected
    assert extract(text.encode(), "launch_xml").problems == ()


def test_places_are_those_of_the_value():
    text = '<launch>\n  <include\n      file="$(find nav)/a.launch"/>\n'
    text += '  <node type="b" pkg="é"/><node type="b" pkg="a"/>\n'
    references = extract(text.encode(), "launch_xml").references
    assert references == (
        Reference("file", "nav", "a.launch", 3, 13, False, ()),
        Reference("executable", "a", "b", 4, 47, False),
    )


CONDITIONS = [
    ('<node pkg="a" type="b"/>', False),
    ('<node pkg="a" type="b" if="$(arg x)"/>', True),
    ('<node pkg="a" type="b" unless="$(var x)"/>', True),
    ('<node pkg="a" type="b" if="true"/>', False),
    ('<node pkg="a" type="b" unless="0"/>', False),
    ('<group if="$(arg x)"><group><node pkg="a" type="b"/></group></group>', True),
    ('<group if="$(arg x)"></group><node pkg="a" type="b"/>', False),
    ('<arg name="x" default="true"/><node pkg="a" type="b" if="$(arg x)"/>', False),
    ('<arg name="x" default="false"/><node pkg="a" type="b" if="$(var x)"/>', True),
    ('<arg name="x" value="0"/><node pkg="a" type="b" unless="$(arg x)"/>', False),
    ('<arg name="x"/><node pkg="a" type="b" if="$(arg x)"/>', True),
    ('<arg name="x" default="1"/><arg name="x" default="0"/><node pkg="a" type="b" if="$(arg x)"/>', True),
    ('<arg name="x" default="1" if="$(arg y)"/><node pkg="a" type="b" if="$(arg x)"/>', True),
    ('<group><arg name="x" default="1"/></group><node pkg="a" type="b" if="$(arg x)"/>', True),
]


@pytest.mark.parametrize(("element", "conditional"), CONDITIONS)
def test_if_and_unless_make_conditional(element, conditional):
    (reference,) = extract(f"<launch>{element}</launch>".encode(), "launch_xml").references
    assert reference.conditional is conditional


def test_what_only_running_tells_is_listed():
    text = '<launch><node pkg="$(arg p)" type="b"/>\n<include file="$(find-pkg-share $(var d))/a.xml"/></launch>'
    unresolved = extract(text.encode(), "launch_xml").unresolved
    assert [(u.line, u.message) for u in unresolved] == [
        (1, "$(arg p)"),
        (2, "$(find-pkg-share $(var d))/a.xml"),
    ]


BROKEN = [
    ('<launch><node pkg="a" type="b"/>\n<group>\n<node pkg="c" type="d"/></launch>', 3, "mismatched tag"),
    ('<launch>\n<!-- a -- b -->\n<node pkg="a" type="b"/>\n<node pkg="c" type="d"/></launch>', 2, "invalid token"),
    ('<launch>\n<node pkg="a" type="b"/>\n<x a=b/><node pkg="c" type="d"/>', 3, "invalid token"),
]


@pytest.mark.parametrize(("text", "line", "why"), BROKEN)
def test_malformed_xml_is_a_problem_and_read_on(text, line, why):
    facts = extract(text.encode(), "launch_xml")
    assert [(p.line, why in p.message) for p in facts.problems] == [(line, True)]
    assert [r.package for r in facts.references] == ["a", "c"]


LAUNCH_YAML = """\
launch:
- arg:
    name: x
    default: "$(find-pkg-share maps)/a.yaml"
- node:
    pkg: "demo"
    exec: talker
    if: $(var x)
- node: {pkg: other, exec: $(var exe)}
- include:
    file: $(find-pkg-share nav)/launch/a.launch.py
- group:
    unless: $(var x)
    children:
    - node: {exec: b, pkg: a}
- executable: {cmd: ls -l}
- node_container:
    pkg: rclcpp_components
    exec: component_container
    composable_node:
    - pkg: image
      plugin: image::Crop
    - pkg: $(var p)
      plugin: image::Flip
"""


def test_launch_yaml():
    facts = extract(LAUNCH_YAML.encode(), "launch_yaml")
    assert [(r.kind, r.package, r.name, r.line, r.conditional) for r in facts.references] == [
        ("file", "maps", "a.yaml", 4, False),
        ("executable", "demo", "talker", 6, True),
        ("package", "other", "", 9, False),
        ("file", "nav", "launch/a.launch.py", 11, False),
        ("executable", "a", "b", 15, True),
        ("command", "", "ls", 16, False),
        ("executable", "rclcpp_components", "component_container", 18, False),
        ("plugin", "image", "image::Crop", 22, False),
        ("plugin", "", "image::Flip", 24, False),
    ]
    assert facts.references[1].column == 11
    assert [u.message for u in facts.unresolved] == ["$(var p)"]
    assert extract(LAUNCH_YAML.encode(), "params") == facts


@pytest.mark.parametrize(
    ("given", "arguments"),
    [("", ()), ("    arg:\n    - {name: x, value: 1}\n    - {name: y, value: $(var z)}\n", ("x", "y")),
     ("    let: {name: $(var n), value: 1}\n", None)],
)  # fmt: skip
def test_arguments_given_to_includes_in_yaml(given, arguments):
    text = f"launch:\n- include:\n    file: $(find-pkg-share nav)/a.launch.py\n{given}"
    assert extract(text.encode(), "launch_yaml").references[0].arguments == arguments


def test_yaml_that_is_only_called_like_a_launch_file():
    text = "map: $(find-pkg-share maps)/a.yaml\nplugin: a::B\n"
    facts = extract(text.encode(), "launch_yaml")
    found = [(r.kind, r.package, r.name) for r in facts.references]
    assert found == [("file", "maps", "a.yaml"), ("plugin", "", "a::B")]
    assert facts.problems == ()


HOSTILE_YAML = [
    "launch: [" + "[" * 5000,
    "launch:\n- a: &a [x, x]\n- b: &b [*a, *a]\n- c: &c [*b, *b]\n- d: *c\n- node: {pkg: p, exec: e}\n",
    "launch:\n- node: {pkg: p, exec: e}\n- x: 'unfinished",
    "launch:\n- node: {pkg: p, exec: e}\n\t- tab\n",
]


@pytest.mark.parametrize("text", HOSTILE_YAML)
def test_hostile_yaml_is_read_as_far_as_it_goes(text):
    facts = extract(text.encode(), "launch_yaml")
    assert bool(facts.problems) != ("*a" in text)
    assert [r.package for r in facts.references] == (["p"] if "node" in text else [])


ROBOT = [
    ('<xacro:include filename="$(find bot)/urdf/a.xacro"/>', [("file", "bot", "urdf/a.xacro")]),
    ('<mesh filename="package://bot/meshes/a.dae"/>', [("file", "bot", "meshes/a.dae")]),
    ('<mesh filename="package://bot/meshes/${name}.dae"/>', [("place", "bot", "meshes")]),
    ("<uri>model://sun</uri>", [("model", "", "sun")]),
    ('<plugin name="p" filename="libgazebo_ros_p3d.so"/>', [("plugin", "", "libgazebo_ros_p3d.so")]),
    ('<plugin name="p" filename="lib${x}.so"/>', []),
    ("<hardware><plugin>mock_components/GenericSystem</plugin></hardware>",
     [("plugin", "", "mock_components/GenericSystem")]),
    ("<parameters>$(find bot)/config/c.yaml</parameters>", [("file", "bot", "config/c.yaml")]),
]  # fmt: skip


@pytest.mark.parametrize(("element", "expected"), ROBOT)
def test_robot_descriptions(element, expected):
    text = f"<robot>{element}</robot>"
    assert found("xacro", text) == expected
    assert found("xml", text) == expected


TOLERATED = [
    ('<?xml verison="1.0"?>\n<robot><link/></robot>', 0),
    ('\n<?xml version="1.0"?>\n<robot><!-- a -- b --></robot>', 0),
    ('<?xml verison="1.0"?>\n<robot><xacro:x/></robot>', 1),
    ("<robot><link></robot>", 1),
]


@pytest.mark.parametrize(("text", "problems"), TOLERATED)
def test_urdf_is_judged_as_tinyxml_would_and_xacro_is_not(text, problems):
    assert len(extract(text.encode(), "xacro").problems) == problems


def test_xacro_conditions():
    text = '<robot><xacro:if value="${x}"><a f="$(find a)/x"/></xacro:if><a f="$(find b)/x"/></robot>'
    assert [(r.package, r.conditional) for r in extract(text.encode(), "xacro").references] == [
        ("a", True),
        ("b", False),
    ]


PLUGINS = """<class_libraries>
  <library path="walker">
    <class name="w/Walk" type="w::Walk" base_class_type="nav2_core::Behavior"/>
    <class type="w::Run&lt;A&gt;" base_class_type="nav2_core::Behavior">
    </class>
  </library>
  <library path="lib/libother"><class type="o::Cached<a::B>" base_class_type="b::C"/></library>
</class_libraries>
"""


@pytest.mark.parametrize("kind", ["plugin_xml", "xml"])
def test_plugin_description(kind):
    facts = extract(PLUGINS.encode(), kind)
    assert facts.plugins == (
        PluginClass("w/Walk", "w::Walk", "nav2_core::Behavior", "walker", 3),
        PluginClass("w::Run<A>", "w::Run<A>", "nav2_core::Behavior", "walker", 4),
        PluginClass("o::Cached<a::B>", "o::Cached<a::B>", "b::C", "lib/libother", 7),
    )
    assert facts.problems == ()


def test_a_plugin_description_is_judged_as_tinyxml_would():
    text = "<library path='a'>\n<!-- - -- - --><class type='x'/>\n</library>\n"
    text += "<library path='b'><class type='y'/></library>"
    assert extract(text.encode(), "plugin_xml").problems == ()
    assert [p.line for p in extract(b"<library>\n<class type='x'></library>", "plugin_xml").problems] == [2]
    assert [p.message for p in extract(b"", "plugin_xml").problems] == ["is empty"]


@pytest.mark.parametrize("text", ["<root><node pkg='a' type='b'/></root>", "", "<ui>", "no xml"])
def test_xml_of_other_trades_says_nothing(text):
    assert extract(text.encode(), "xml") == extract(b"<x/>", "xml")


PARAMS = [
    ('plugin: "nav2_smac_planner::Lattice"', [("plugin", "", "nav2_smac_planner::Lattice")]),
    ("  plugin: nav2_x/Y # said", [("plugin", "", "nav2_x/Y")]),
    ("# plugin: nav2_x/Y", []),
    ("kinematics_solver: kdl_kinematics_plugin/KDL", [("plugin", "", "kdl_kinematics_plugin/KDL")]),
    ("- {name: o, type: 'costmap_2d::ObstacleLayer'}", [("plugin", "", "costmap_2d::ObstacleLayer")]),
    ("type: diff_drive_controller/DiffDriveController", [("plugin", "", "diff_drive_controller/DiffDriveController")]),
    ("type: sensor_msgs/Image", []),
    ("type: geometric::RRT", []),
    ("plugins: [a, b]", []),
    ("planning_plugins:\n  - ompl_interface/OMPL\n  - 'x/Y'\nother: a/b\n",
     [("plugin", "", "ompl_interface/OMPL"), ("plugin", "", "x/Y")]),
    ("request_adapters: >-\n  a/B\n  c/D\n", [("plugin", "", "a/B"), ("plugin", "", "c/D")]),
    ("mesh: package://bot/a.stl", [("file", "bot", "a.stl")]),
    ("map: $(find-pkg-share maps)/a.yaml # $(find-pkg-share x)", [("file", "maps", "a.yaml")]),
    ("url: https://example.org/plugin", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), PARAMS)
def test_parameter_files(text, expected):
    assert found("params", text) == expected


SHELL = [
    ("rosrun tf tf_echo a b", [("executable", "tf", "tf_echo")]),
    ("rosrun --prefix gdb tf tf_echo", [("executable", "tf", "tf_echo")]),
    ("roslaunch nav a.launch x:=1 &", [("sought", "nav", "a.launch")]),
    ("roslaunch a.launch", []),
    ("roslaunch nav robot:=r1", []),
    ("roslaunch nav demo", []),
    ("roslaunch --wait nav a.launch", [("sought", "nav", "a.launch")]),
    ('roslaunch nav "$1"', [("package", "nav", "")]),
    ("rostest nav a.test", [("sought", "nav", "a.test")]),
    ("ros2 run demo_nodes_cpp talker --ros-args", [("executable", "demo_nodes_cpp", "talker")]),
    ("ros2 launch nav2_bringup a.launch.py", [("sought", "nav2_bringup", "a.launch.py")]),
    ("cd $(rospack find nav)/maps", [("package", "nav", "")]),
    ("X=`rospack find nav`", [("package", "nav", "")]),
    ("source $(ros2 pkg prefix --share nav)/env.sh", [("package", "nav", "")]),
    ("ros2 component standalone img img::Crop", [("plugin", "img", "img::Crop")]),
    ("sleep 1 && rosrun a b; rosrun c d", [("executable", "a", "b"), ("executable", "c", "d")]),
    ("ROS_DOMAIN_ID=3 exec ros2 run a b", [("executable", "a", "b")]),
    ("# rosrun a b", []),
    ("echo 'use rosrun a b'", []),
    ("echo hi # rosrun a b", []),
    ("rosrun $PKG b", []),
    ("cat <<EOF\nrosrun a b\nEOF\nrosrun c d", [("executable", "c", "d")]),
    ("rostopic list", []),
]


@pytest.mark.parametrize(("text", "expected"), SHELL)
def test_shell(text, expected):
    assert found("shell", text) == expected


def test_shell_conditions():
    text = "if true; then\n  rosrun a b\nfi\nrosrun c d\n"
    assert [(r.package, r.line, r.conditional) for r in extract(text.encode(), "shell").references] == [
        ("a", 2, True),
        ("c", 4, False),
    ]


PIECES = [
    "<launch>", "</launch>", '<node pkg="a" type="b"', "/>", ">", '<include file="$(find a)/b"', "$(find ", "<robot>",
    "$(find-pkg-share x)", "package://a/b", "<library path='x'>", "<class type='y'>", "<!--", "-->", '"', "'", "\n",
    "é", "launch:\n", "- node: {pkg: p, exec: e}\n", "- ", "{", "}", "[", "]", "&a ", "*a ", "plugin: a::b\n",
    "plugins:\n",
    "rosrun a b", "; ", "`", "<<E", "if ", "fi\n", "#", "\t", "ros2 launch x y.py", "<!DOCTYPE x [", "<![CDATA[", "]]>",
]  # fmt: skip


@pytest.mark.parametrize("kind", ["launch_xml", "launch_yaml", "xacro", "plugin_xml", "xml", "params", "shell"])
@given(
    st.one_of(
        st.binary(max_size=200), st.lists(st.sampled_from(PIECES), max_size=25).map(lambda p: "".join(p).encode())
    )
)
def test_never_raises_and_lines_lie_in_the_file(kind, data):
    facts = extract(data, kind)
    last = data.count(b"\n") + 1
    lines = [x.line for x in (*facts.references, *facts.plugins, *facts.problems, *facts.unresolved)]
    assert all(1 <= line <= last for line in lines)


TREES = """\
<root BTCPP_format="4">
  <include path="other.xml"/>
  <BehaviorTree ID="Main">
    <Sequence>
      <Action ID="Wave" times="2"/>
      <Condition/>
      <SubTree ID="Home"><remap internal="a" external="b"/></SubTree>
      <Decorator ID="{kind}"><Wait/></Decorator>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Home"/>
  <TreeNodesModel><Action ID="Dance"><input_port name="x"/></Action></TreeNodesModel>
</root>
"""


def test_nodes_of_behaviour_trees():
    facts = extract(TREES.encode(), "xml")
    assert [(r.kind, r.name, r.line) for r in facts.references] == [
        ("tree node", "Sequence", 4), ("tree node", "Wave", 5), ("tree port", "Wave times", 5),
        ("tree node", "SubTree", 7), ("tree node", "Wait", 8),
    ]  # fmt: skip
    assert (facts.trees, facts.modelled) == (("Main", "Home"), ("Dance",))
    assert extract(b"<root><Sequence/></root>", "xml").references == ()
