"""Facts of launch files in XML and YAML, and of files of parameters."""

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.facts.launch.actions import LaunchFile, ValuePart, find_literal
from rosimpact.impact.facts.launch.flow import extract, parse_substitutions, split_command_line
from rosimpact.impact.facts.launch.parameter_files import ParameterFile, parse_scalar
from rosimpact.impact.facts.launch.parameter_files import extract as parameters


def said(value):
    """A value in short: text as it is, other pieces as (kind, text, parts...)."""
    return [p.text if p.kind == "text" else (p.kind, p.text, *[said(part) for part in p.parts]) for p in value]


ROS1 = [
    ("plain", ["plain"]),
    ("$(arg a)/b$(arg c)", [("arg", "a"), "/b", ("arg", "c")]),
    ("$(find  p)/x.yaml", [("find", "p"), "/x.yaml"]),
    ("$(env HOME)", [("env", "HOME")]),
    ("$(optenv HOME)", [("env", "HOME", [""])]),
    ("$(optenv HOME /root and more)", [("env", "HOME", ["/root and more"])]),
    ("$(anon n)", [("anon", "n")]),
    ("$(dirname)/a", [("dirname", ""), "/a"]),
    ("$(eval arg('x') + '(1)')", [("eval", "roslaunch", ["arg('x') + '(1)'"])]),
    ("a $(eval 1)", ["a ", ("other", "$(eval 1)")]),
    ("$(find $(arg p))/x", [("other", "$(find"), ("arg", "p"), ")/x"]),
    ("$(nothing a)", [("other", "$(nothing a)")]),
    ("$(arg a", [("other", "$(arg a")]),
    ("$x (a) $", ["$x (a) $"]),
]
ROS2 = [
    ("$(var a)/b", [("arg", "a"), "/b"]),
    ("$(var a b)", [("arg", "a", ["b"])]),
    ("$(env HOME '')", [("env", "HOME", [""])]),
    ("$(find-pkg-share p)/x", [("find", "p"), "/x"]),
    ("$(find-pkg-share $(var p))/x", [("find", "", [("arg", "p")]), "/x"]),
    ("$(find-pkg-prefix 'p')", [("prefix", "p")]),
    ("$(exec-in-pkg tool p)", [("executable", "", ["tool"], ["p"])]),
    ("$(dirname)/a.xml", [("dirname", ""), "/a.xml"]),
    ("$(eval \"'$(var a)' == 'b'\")", [("eval", "launch", ["'", ("arg", "a"), "' == 'b'"])]),
    (r"$(eval '\'$(var a)\' == \'b\'')", [("eval", "launch", ["'", ("arg", "a"), "' == 'b'"])]),
    ("$(not $(var a))", [("not", "", [("arg", "a")])]),
    ("$(and $(var a) true)", [("and", "", [("arg", "a")], ["true"])]),
    ("$(not-equals $(var a) b)", [("not", "", [("equals", "", [("arg", "a")], ["b"])])]),
    ("$(if $(var a) x y)", [("choose", "", [("arg", "a")], ["x"], ["y"])]),
    ("$(command 'xacro $(var f)')", [("command", "", ["xacro ", ("arg", "f")])]),
    (r"\$(var a)", ["$(var a)"]),
    ("$(var", [("other", "$(var")]),
    ("$(strange a)", [("other", "$(strange a)")]),
]


@pytest.mark.parametrize(("text", "expected"), ROS1)
def test_substitutions_of_ros1(text, expected):
    assert said(parse_substitutions(text, 1)) == expected


@pytest.mark.parametrize(("text", "expected"), ROS2)
def test_substitutions_of_ros2(text, expected):
    assert said(parse_substitutions(text, 2)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a  b", [["a"], ["b"]]),
        ("'a b' \"c\"d", [["a b"], ["cd"]]),
        ("x$(arg a)y z", [["x", ("arg", "a"), "y"], ["z"]]),
        ("$(arg a) b $(arg c)", [[("arg", "a")], ["b"], [("arg", "c")]]),
        ("'' a", [[""], ["a"]]),
        ("", []),
    ],
)
def test_words_of_a_command_line(text, expected):
    assert [said(word) for word in split_command_line(parse_substitutions(text, 1))] == expected


def lines(actions, depth=0):
    """Actions as a person would note them down."""
    found = []
    for action in actions:
        attributes = " ".join(f"{key}={''.join(map(str, said(value)))}" for key, value in action.attributes)
        conditions = "".join(f" [{c.kind} {''.join(map(str, said(c.value)))}]" for c in action.conditions)
        found.append(f"{'  ' * depth}{action.line} {action.kind} {attributes}".rstrip() + conditions)
        found += lines(action.children, depth + 1)
    return found


def test_launch_file_of_ros1():
    text = b"""<launch>
  <arg name="robot" default="r1"/>
  <arg name="fixed" value="1"/>
  <remap from="odom" to="odometry"/>
  <group ns="$(arg robot)" if="$(arg go)">
    <node pkg="amcl" type="amcl" name="amcl" args="scan:=base_scan _a:=1" clear_params="true">
      <param name="~x" value="0.1" type="double"/>
      <rosparam file="$(find nav)/a.yaml" command="load" ns="below" subst_value="true"/>
      <rosparam param="list">
        [1,
         <!-- no -->
         2]
      </rosparam>
      <remap from="scan" to="/scan"/>
      <env name="A" value="b"/>
    </node>
  </group>
  <include file="$(find nav)/b.launch" ns="q" pass_all_args="true" unless="false">
    <arg name="robot" value="$(arg robot)"/>
  </include>
  <test test-name="t" pkg="p" type="t.py"/>
  <param name="d" command="xacro x.xacro"/>
  <machine name="m" address="a"/>
  <strange/>
</launch>"""
    file = extract(text, "launch_xml")
    assert (file.language, file.generation, file.problems) == ("xml", 1, ())
    assert lines(file.actions) == [
        "2 argument name=robot default=r1",
        "3 argument name=fixed value=1",
        "4 remap from=odom to=odometry",
        "5 group namespace=('arg', 'robot') [if ('arg', 'go')]",
        "  6 node package=amcl executable=amcl name=amcl arguments=scan:=base_scan arguments=_a:=1 clear=true",
        "    7 parameter name=~x value=0.1 type=double",
        "    8 parameter-file file=('find', 'nav')/a.yaml command=load name=below substitute=true",
        "    9 parameter-file name=list text=\n        [1,\n         \n         2]",
        "    14 remap from=scan to=/scan",
        "    15 environment name=A value=b",
        "18 include file=('find', 'nav')/b.launch namespace=q pass-all=true [unless false]",
        "  19 pass name=robot value=('arg', 'robot')",
        "21 test package=p executable=t.py name=t",
        "22 parameter name=d command=xacro x.xacro",
        "24 unknown text=<strange>",
    ]


XML2 = b"""<launch>
  <arg name="robot" default="r1"/>
  <let name="x" value="$(var robot)_x"/>
  <group scoped="false">
    <push-ros-namespace namespace="$(var robot)"/>
    <set_remap from="a" to="b"/>
    <node pkg="amcl" exec="amcl" name="amcl" namespace="n" args="--one" ros_args="-r a:=b">
      <param from="$(find-pkg-share nav)/a.yaml" allow_substs="true"/>
      <param name="p"><param name="q" value="1"/><param name="r" value="$(var x)" type="str"/></param>
      <remap from="scan" to="/scan"/>
    </node>
  </group>
  <node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="">
    <composable_node pkg="p" plugin="p::A" name="a" if="$(var x)"/>
  </node_container>
  <load_composable_node target="box"><composable_node pkg="p" plugin="p::B"/></load_composable_node>
  <include file="$(dirname)/b.xml"><arg name="robot" value="r2"/><let name="y" value="z"/></include>
  <timer period="2.0"><executable cmd="ros2 run a b"/></timer>
</launch>"""
YAML2 = b"""launch:
- arg: {name: robot, default: r1}
- let:
    name: x
    value: $(var robot)_x
- group:
    scoped: false
    children:
    - push_ros_namespace: {namespace: $(var robot)}
    - set_remap: {from: a, to: b}
    - node:
        pkg: amcl
        exec: amcl
        name: amcl
        namespace: n
        args: --one
        ros_args: -r a:=b
        param:
        - from: $(find-pkg-share nav)/a.yaml
          allow_substs: true
        - name: p
          param:
          - {name: q, value: 1}
          - {name: r, value: $(var x), type: str}
        remap:
        - {from: scan, to: /scan}
- node_container:
    pkg: rclcpp_components
    exec: component_container
    name: box
    namespace: ''
    composable_node:
    - {pkg: p, plugin: 'p::A', name: a, if: $(var x)}
- load_composable_node:
    target: box
    composable_node: [{pkg: p, plugin: 'p::B'}]
- include:
    file: $(dirname)/b.xml
    arg: [{name: robot, value: r2}]
    let: [{name: y, value: z}]
- timer: {period: 2.0, children: [executable: {cmd: ros2 run a b}]}
"""
EXPECTED2 = [
    "argument name=robot default=r1",
    "let name=x value=('arg', 'robot')_x",
    "group scoped=false",
    "  namespace namespace=('arg', 'robot')",
    "  remap from=a to=b",
    "  node package=amcl executable=amcl name=amcl namespace=n arguments=--one arguments=--ros-args arguments=-r"
    " arguments=a:=b",
    "    parameter-file file=('find', 'nav')/a.yaml substitute=true",
    "    parameter name=p.q value=1",
    "    parameter name=p.r value=('arg', 'x') type=str",
    "    remap from=scan to=/scan",
    "container package=rclcpp_components executable=component_container name=box namespace=",
    "  composable package=p plugin=p::A name=a [if ('arg', 'x')]",
    "load container=box",
    "  composable package=p plugin=p::B",
    "include file=('dirname', '')/b.xml",
    "  pass name=robot value=r2",
    "  pass name=y value=z",
    "group [after 2.0 s]",
    "  process command=ros2 command=run command=a command=b",
]


@pytest.mark.parametrize(("kind", "text"), [("launch_xml", XML2), ("launch_yaml", YAML2)])
def test_launch_file_of_ros2(kind, text):
    file = extract(text, kind)
    assert (file.generation, file.problems) == (2, ())
    numbered = lines(file.actions)
    without = [line[: len(line) - len(line.lstrip())] + line.lstrip().partition(" ")[2] for line in numbered]
    assert without == EXPECTED2


def test_yaml_tells_lines():
    assert [a.line for a in extract(YAML2, "launch_yaml").actions] == [2, 3, 6, 27, 34, 37, 41]


@pytest.mark.parametrize(
    ("text", "generation"),
    [
        ('<launch><node pkg="a" type="b" name="n"/></launch>', 1),
        ('<launch><node pkg="a" exec="b"/></launch>', 2),
        ('<launch><include file="$(find a)/b"/></launch>', 1),
        ('<launch><include file="$(find-pkg-share a)/b"/></launch>', 2),
        ('<launch><arg name="a" default="b"/></launch>', 0),
    ],
)
def test_generation(text, generation):
    assert extract(text.encode(), "launch_xml").generation == generation


@pytest.mark.parametrize(
    ("kind", "data", "problem"),
    [
        ("launch_xml", b"<robot/>", "has no `<launch>` element"),
        ("launch_xml", b"", "has no `<launch>` element"),
        ("launch_xml", b'<launch><node pkg="a" type="b">', "not well-formed"),
        ("launch_xml", b"<launch>" + b"<group>" * 5000, "nested more than"),
        ("launch_yaml", b"a: b", "has no `launch:` list"),
        ("launch_yaml", b"launch:\n- [", "not readable as YAML"),
        # As our own limit or, since PyYAML 6.0.4, its own says.
        ("launch_yaml", b"launch: " + b"[" * 5000, "nest"),
        ("launch_yaml", b"launch:\n" + b"- let: {name: a}\n" * 60_000, "has more than"),
    ],
)
def test_what_cannot_be_read_is_said(kind, data, problem):
    assert any(problem in p.message for p in extract(data, kind).problems)


def test_a_mistake_does_not_hide_what_comes_before_it():
    file = extract(b"launch:\n- node: {pkg: a, exec: b}\n- node: {pkg: [\n", "launch_yaml")
    assert [find_literal(a.get("package")) for a in file.actions][:1] == ["a"]
    assert file.problems


PARAMETERS = """
amcl:
  ros__parameters:
    alpha1: 0.2
    name: "5"
    flags: [true, no, 'no']
    nested: {a: 1, b: {c: 0x10}}
    empty: {}
/**:
  ros__parameters: &all
    use_sim_time: True
other:
  ros__parameters:
    <<: *all
    rate: 1e-3
    many:
    - {x: 1}
"""


def test_parameter_file():
    file = parameters(PARAMETERS.encode())
    assert file.problems == ()
    assert [(".".join(e.path), e.value, e.line) for e in file.entries] == [
        ("amcl.ros__parameters.alpha1", 0.2, 4),
        ("amcl.ros__parameters.name", "5", 5),
        ("amcl.ros__parameters.flags", [True, False, "no"], 6),
        ("amcl.ros__parameters.nested.a", 1, 7),
        ("amcl.ros__parameters.nested.b.c", 16, 7),
        ("amcl.ros__parameters.empty", {}, 8),
        ("/**.ros__parameters.use_sim_time", True, 11),
        ("other.ros__parameters.use_sim_time", True, 11),
        ("other.ros__parameters.rate", 0.001, 15),
        ("other.ros__parameters.many", [{"x": 1}], 16),
    ]


@pytest.mark.parametrize(
    ("text", "expected"),
    [("", None), ("~", None), ("yes", True), ("Off", False), ("y", "y"), ("12", 12), ("-3", -3), ("1_000", 1000),
     ("010", 8), ("0x1F", 31), ("1.5", 1.5), (".5", 0.5), ("1.", 1.0), ("1e3", 1000.0), (".inf", float("inf")),
     ("99999999999999999999", "99999999999999999999"), ("1.2.3", "1.2.3"), ("a", "a"), ("-", "-"), ("08", "08")],
)  # fmt: skip
def test_scalars(text, expected):
    assert parse_scalar(text) == expected
    assert type(parse_scalar(text)) is type(expected)


def test_degrees_are_radians():
    entries = parameters("a: !degrees 180\nb: !radians 2.0\nc: !!str 5").entries
    assert [e.value for e in entries] == [pytest.approx(3.141592653589793), 2.0, "5"]


@pytest.mark.parametrize("line", ["- 1", "- {b: 1}"])
def test_long_parameter_files_say_so(line):
    assert parameters("a:\n" + f"{line}\n" * 60_000).problems[0].message == "has more than 50000 values"


@pytest.mark.parametrize(
    "data",
    [
        b"a: &a [1, 2]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a]\nc: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b]\n"
        b"d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c]\ne: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d]\nf: [*e, *e, *e, *e]",
        b"a: *nobody",
        b"- 1\n- 2",
        b"\xff\xfea\x00:\x00 \x001\x00",
        b"\xef\xbb\xbfa: 1\r\nb: 2\r\n",
        b"a: \x00",
        b"a: \xff",
        b'a: "\\ud800"',
        b"? [a, b]\n: c",
        b"5",
        b"{" * 100_000,
    ],
)
def test_odd_parameter_files_come_back(data):
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(parameters(data)), type=ParameterFile)


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=300), st.sampled_from(["launch_xml", "launch_yaml", "launch_python"]))
def test_never_raises(data, kind):
    for given_ in (data, b"<launch>" + data, b"launch:\n- node:\n    pkg: " + data):
        file = extract(given_, kind)
        assert msgspec.msgpack.decode(msgspec.msgpack.encode(file), type=LaunchFile) == file
    parameters(data)


@settings(max_examples=150, deadline=None)
@given(st.text(alphabet="$()'\" \\abvr-", max_size=60))
def test_substitutions_never_raise(text):
    for generation in (1, 2):
        assert all(isinstance(piece, ValuePart) for piece in parse_substitutions(text, generation))
