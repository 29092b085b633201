"""What launch files start, told on small workspaces."""

import textwrap
from xml.sax.saxutils import quoteattr

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from launched_names import full_name
from rosimpact.impact.facts.launch.flow import extract
from rosimpact.impact.facts.launch.parameter_files import extract as parameters
from rosimpact.impact.model.launch.follow import MOST_ACTIONS, follow
from rosimpact.impact.model.launch.result import SettingFile, select_file_values
from rosimpact.impact.model.launch.text import CannotTell, LaunchText, evaluate, make_either, parse_ros1_value


class Files:
    """Launch and parameter files by `package/path`."""

    def __init__(self, files):
        self.files = {name: textwrap.dedent(text).strip().encode() for name, text in files.items()}

    def find_launch_file(self, package, path):
        data = self.files.get(f"{package}/{path}")
        ending = path.rpartition(".")[2]
        kind = {"py": "launch_python", "yaml": "launch_yaml"}.get(ending, "launch_xml")
        return None if data is None else extract(data, kind)

    def find_parameter_file(self, package, path):
        data = self.files.get(f"{package}/{path}")
        return None if data is None else parameters(data)


def launched(files, top="p/a.launch", **options):
    if isinstance(files, str):
        files = {top: files}
    package, _, path = top.partition("/")
    return follow(package, path, Files(files), **options)


def names(launch):
    return [full_name(started).value or full_name(started).shown for started in launch.started]


def remaps(started):
    return [(remap.old.shown, remap.new.shown) for remap in started.remaps]


def values(launch, place=0, name=""):
    started = launch.started[place]
    found = launch.collect_parameters(started, name or full_name(started).value or "")
    return {key: setting.text.value for key, setting in found.items()}


def node(name, more="", inside=""):
    return f'<node pkg="k" type="t" name="{name}" {more}>{inside}</node>'


# ROS 1


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (node("n"), ["/n"]),
        (node("n", 'ns="a"'), ["/a/n"]),
        ('<group ns="g">' + node("n", 'ns="a"') + node("m", 'ns="/a"') + "</group>" + node("o"),
         ["/g/a/n", "/a/m", "/o"]),
        ('<group ns="g"><group ns="h">' + node("n") + "</group>" + node("m") + "</group>", ["/g/h/n", "/g/m"]),
        (node("n", 'args="__name:=m __ns:=/q"'), ["/q/m"]),
        (node("$(anon n)"), ["/n_<anonymous>"]),
        ('<arg name="a" default="x"/>' + node("n", "if=\"$(eval a == 'x')\"")
         + node("m", "unless=\"$(eval a == 'x')\""),
         ["/n"]),
        ('<arg name="a" default="false"/>' + node("n", 'if="$(arg a)"'), []),
        ('<arg name="a" default="1"/><group ns="$(arg a)" if="$(arg a)">' + node("n") + "</group>", ["/1/n"]),
        ('<arg name="a" default="x"/><arg name="b" value="$(arg a)y"/>' + node("$(arg b)"), ["/xy"]),
        ('<group><arg name="a" value="x"/>' + node("$(arg a)") + "</group>" + node("$(arg a)"), ["/x", "/<a>"]),
        (node("$(env NAME)"), ["/<$NAME>"]),
        (node("$(optenv NAME n)"), ["/n"]),
        (node("$(eval 'a' + str(1 + 2))"), ["/a3"]),
        (node("$(eval open('x'))"), ["/<$(eval open('x'))>"]),
    ],
)  # fmt: skip
def test_names_of_ros1(text, expected):
    assert names(launched(f"<launch>{text}</launch>")) == expected


def test_arguments_given_and_by_default():
    both = node("n", 'if="$(arg a)"') + node("m", 'unless="$(arg a)"')
    text = f'<launch><arg name="a" default="true"/>{both}</launch>'
    assert names(launched(text)) == ["/n"]
    assert names(launched(text, arguments={"a": "false"})) == ["/m"]


def test_includes_of_ros1():
    files = {
        "p/a.launch": f"""<launch>
            <arg name="robot" default="r1"/>
            <remap from="scan" to="front"/>
            <include file="$(find q)/launch/b.launch" ns="$(arg robot)"><arg name="n" value="x"/></include>
            <include file="$(find q)/launch/b.launch" pass_all_args="true"/>
            <include file="$(find q)/launch/gone.launch"/>
            <include file="/tmp/c.launch"/>
            <include file="$(find q)/launch/$(env KIND).launch"/>
            {node("last")}</launch>""",
        "q/launch/b.launch": f"""<launch>
            <arg name="n" default="d"/> <arg name="robot" default="none"/>
            <remap from="odom" to="o"/>
            {node("$(arg n)_$(arg robot)")}
            <include file="$(dirname)/c.launch"/></launch>""",
        "q/launch/c.launch": f"<launch>{node('c')}</launch>",
    }
    launch = launched(files)
    assert names(launch) == ["/r1/x_none", "/r1/c", "/d_r1", "/c", "/last"]
    assert remaps(launch.started[1]) == [("scan", "front"), ("odom", "o")]
    assert remaps(launch.started[4]) == [("scan", "front")]
    started = launch.started[1]
    assert (started.at.package, started.at.path, started.at.line) == ("q", "launch/c.launch", 1)
    assert launch.files == (("p", "a.launch"), ("q", "launch/b.launch"), ("q", "launch/c.launch"))


def test_remaps_of_ros1():
    inside = '<remap from="b" to="own"/><remap from="c" to="own"/>'
    launch = launched(f"""<launch>
        <remap from="a" to="one"/><remap from="b" to="one"/>
        {node("n", "args='c:=words plain _p:=1'", inside)}
        <group><remap from="a" to="two"/>{node("m")}</group>
        {node("o")}</launch>""")
    assert remaps(launch.started[0]) == [("a", "one"), ("b", "own"), ("c", "own"), ("c", "words")]
    assert remaps(launch.started[1]) == [("b", "one"), ("a", "two")]
    assert remaps(launch.started[2]) == [("a", "one"), ("b", "one")]
    assert values(launch) == {"p": "1"}


def test_server_of_ros1():
    files = {
        "p/a.launch": """<launch>
            <arg name="v" default="7"/>
            <param name="top" value="1.5"/>
            <param name="/abs" value="true"/>
            <group ns="g">
              <param name="~each" value="e"/> <param name="~p" value="0"/>
              <param name="text" value="5" type="str"/>
              <rosparam file="$(find p)/v.yaml"/>
              <rosparam file="$(find p)/w.yaml" subst_value="true"/>
              <rosparam ns="in" subst_value="true">{a: $(arg v), $(arg v)b: [1, 2]}</rosparam>
              <node pkg="k" type="t" name="n"><param name="p" value="$(arg v)"/><rosparam>{r: {x: 1}, p: 8}</rosparam>
                <param name="d" command="xacro"/></node>
              <rosparam command="delete" param="gone"/>
            </group></launch>""",
        "p/v.yaml": "f: 1\nraw: $(arg v)\ngone: {x: 1, y: 2}\nn: {deep: {er: z}}",
        "p/w.yaml": "filled: $(arg v)",
    }
    launch = launched(files)
    assert {key: setting.text.value for key, setting in launch.server.items()} == {
        "/top": "1.5", "/abs": "true", "/g/text": "5", "/g/f": "1", "/g/raw": "$(arg v)", "/g/filled": "7",
        "/g/n/deep/er": "z", "/g/in/a": "7", "/g/in/7b": "[1, 2]", "/g/n/p": "7",
        "/g/n/r/x": "1", "/g/n/d": None, "/g/n/each": "e",
    }  # fmt: skip
    assert values(launch) == {"deep/er": "z", "p": "7", "r/x": "1", "d": None, "each": "e"}
    assert launch.server["/g/n/d"].text.reasons == ("it is the output of a command",)


def test_nodelets():
    launch = launched("""<launch><group ns="g">
        <node pkg="nodelet" type="nodelet" name="box" args="manager"/>
        <node pkg="nodelet" type="nodelet" name="a" args="load p/A box image:=/i"/>
        <node pkg="nodelet" type="nodelet" name="b" args="standalone p/B"/>
        <node pkg="nodelet" type="nodelet" name="c" args="unload a box"/></group></launch>""")
    assert [(s.kind, s.plugin.value) for s in launch.started] == [
        ("container", ""), ("composable", "p/A"), ("node", "p/B"), ("node", ""),
    ]  # fmt: skip
    assert remaps(launch.started[1]) == [("image", "/i")]


def test_tests_of_ros1():
    launch = launched(f'<launch>{node("n")}<test pkg="k" type="t" name="m" test-name="tries"/></launch>')
    assert [(s.kind, full_name(s).value) for s in launch.started] == [("node", "/n"), ("test", "/m")]


# ROS 2


def python(body, before=""):
    return f"{before}\ndef generate_launch_description():\n    return LaunchDescription([{textwrap.dedent(body)}])\n"


def run2(body, **options):
    return launched({"p/a.launch.py": python(body)}, "p/a.launch.py", **options)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("Node(package='k', executable='e', name='n')", ["/n"]),
        ("Node(package='k', executable='e')", ["/<its own>"]),
        ("Node(package='k', executable='e', name='n', namespace='a')", ["/a/n"]),
        ("PushRosNamespace('g'), Node(package='k', executable='e', name='n', namespace='a')", ["/g/a/n"]),
        ("PushRosNamespace('g'), Node(package='k', executable='e', name='n', namespace='/a')", ["/a/n"]),
        ("GroupAction([PushRosNamespace('g'), PushRosNamespace('h'), Node(package='k', executable='e', name='n')]),"
         "Node(package='k', executable='e', name='m')", ["/g/h/n", "/m"]),
        ("GroupAction([PushRosNamespace('g')], scoped=False), Node(package='k', executable='e', name='m')", ["/g/m"]),
        ("Node(package='k', executable='e', name='n', arguments=['--ros-args', '-r', '__ns:=/q', '-r', '__node:=m'])",
         ["/q/m"]),
        ("DeclareLaunchArgument('u', default_value='False'), DeclareLaunchArgument('ns', default_value='x'),"
         "PushRosNamespace(condition=IfCondition(LaunchConfiguration('u')), namespace=LaunchConfiguration('ns')),"
         "Node(package='k', executable='e', name='n')", ["/n"]),
        ("Node(package='k', executable='e', name=['a', LaunchConfiguration('b', default='c')])", ["/ac"]),
        ("Node(package='k', executable='e', name=LaunchConfiguration('b'))", ["/<b>"]),
        ("Node(package='k', executable='e', name='n', condition=IfCondition(PythonExpression(['1 > ', '2'])))", []),
        ("SetLaunchConfiguration('b', 'x'), GroupAction([SetLaunchConfiguration('b', 'y'), Node(package='k', "
         "executable='e', name=LaunchConfiguration('b'))]), Node(package='k', executable='e', "
         "name=LaunchConfiguration('b'))", ["/y", "/x"]),
        ("GroupAction([Node(package='k', executable='e', name=LaunchConfiguration('b', default='d'))], "
         "launch_configurations={'b': 'y'})", ["/y"]),
        ("SetLaunchConfiguration('b', 'x'), GroupAction([Node(package='k', executable='e', "
         "name=LaunchConfiguration('b', default='d'))], forwarding=True)", ["/x"]),
        ("SetLaunchConfiguration('b', 'x'), GroupAction([Node(package='k', executable='e', "
         "name=LaunchConfiguration('b', default='d'))], forwarding=False), Node(package='k', executable='e', "
         "name=LaunchConfiguration('b'))", ["/d", "/x"]),
        ("DeclareLaunchArgument('m', default_value='b'), Node(package='k', executable='e', "
         "name='x' if LaunchConfiguration('m').perform(None) in ('a', 'b') else 'y')", ["/x"]),
        ("DeclareLaunchArgument('m', default_value='c'), Node(package='k', executable='e', "
         "name='x' if LaunchConfiguration('m').perform(None) in ('a', 'b') else 'y')", ["/y"]),
    ],
)  # fmt: skip
def test_names_of_ros2(body, expected):
    assert names(run2(body)) == expected


def test_an_undecided_condition_is_kept():
    launch = run2("""DeclareLaunchArgument('go'), DeclareLaunchArgument('ns', default_value='x'),
        PushRosNamespace(LaunchConfiguration('ns'), condition=IfCondition(LaunchConfiguration('go'))),
        SetLaunchConfiguration('ns', 'y', condition=IfCondition(LaunchConfiguration('go'))),
        Node(package='k', executable='e', name='n', condition=UnlessCondition(LaunchConfiguration('go')),
             remappings=[('a', LaunchConfiguration('ns'))]),
        TimerAction(period=2.0, actions=[Node(package='k', executable='e', name='/m')])""")
    first, second = launch.started
    assert first.conditions == ("not ($(arg go))",)
    assert (first.namespace.value, first.namespace.shown) == (None, "</ or /x>")
    assert remaps(first) == [("a", "<x or y>")]
    assert second.conditions == ()


def test_what_is_set_again_and_again_is_shown_once():
    """Each of two values is put over the other many times; a third is put over both."""
    steps = [f"SetLaunchConfiguration('ns', '{value}', condition=IfCondition(LaunchConfiguration('go')))"
             for value in (*"yzyzyzy", "w")]  # fmt: skip
    launch = run2(f"""DeclareLaunchArgument('go'), DeclareLaunchArgument('ns', default_value='x'), {', '.join(steps)},
        Node(package='k', executable='e', name='n', remappings=[('a', LaunchConfiguration('ns'))])""")
    assert remaps(launch.started[0]) == [("a", "<x or y or z or w>")]


@pytest.mark.parametrize(
    "first, second, expected",
    [
        ("<a>", "<a>", "<a>"),
        ("a", "a", "<a>"),
        ("/<a>/<b>", "<a or <b or c>>", "</<a>/<b> or a or <b or c>>"),
        ("<a> or <b>", "x", "<<a> or <b> or x>"),
        ("<1 or 2 or 3>", "<4 or 5 or 6 or 7>", "<1 or 2 or 3 or 4 or 5 or 6 or ...>"),
        ("<1 or 2 or 3 or 4 or 5 or 6 or ...>", "1", "<1 or 2 or 3 or 4 or 5 or 6 or ...>"),
    ],
)
def test_either_of_two_texts(first, second, expected):
    assert make_either(first, second) == LaunchText(None, expected)


def test_includes_of_ros2():
    files = {
        "p/a.launch.py": python("""
            DeclareLaunchArgument('robot', default_value='r1'),
            SetRemap('/tf', 'tf'),
            IncludeLaunchDescription([FindPackageShare('q'), '/b.launch.xml'],
                                     launch_arguments=[('name', LaunchConfiguration('robot'))]),
            Node(package='k', executable='e', name=LaunchConfiguration('left'))"""),
        "q/b.launch.xml": """<launch>
            <arg name="name" default="none"/><arg name="left" default="over"/>
            <node pkg="k" exec="e" name="$(var name)"><remap from="a" to="b"/></node>
            <include file="$(dirname)/sub/c.yaml"/></launch>""",
        "q/sub/c.yaml": "launch:\n- node: {pkg: k, exec: e, name: $(var name)_c}",
    }
    launch = launched(files, "p/a.launch.py")
    # What an included file declares stays: launch has one set of configurations unless a group scopes it
    assert names(launch) == ["/r1", "/r1_c", "/over"]
    assert remaps(launch.started[0]) == [("/tf", "tf"), ("a", "b")]
    assert launch.arguments == {"robot", "name", "left"}


def test_one_argument_given_may_name_another():
    files = {
        "p/a.launch": """<launch><arg name="id" default="1"/>
            <include file="$(find-pkg-share p)/b.launch"><arg name="n" value="$(eval '1 + int(\\'$(var id)\\')')"/>
              <arg name="ns" value="uas_$(var n)"/></include></launch>""",
        "p/b.launch": '<launch><node pkg="k" exec="e" name="n" namespace="$(var ns)"/></launch>',
    }
    assert names(launched(files)) == ["/uas_2/n"]


def test_circles_end():
    files = {"p/a.launch.py": python("IncludeLaunchDescription([ThisLaunchFileDir(), '/a.launch.py'])")}
    assert launched(files, "p/a.launch.py").actions == 5
    node = '<node pkg="k" exec="e" name="n"/>'
    twice = "<launch>" + '<include file="$(find p)/a.launch"/>' * 4 + node + "</launch>"
    assert len(launched(twice).started) == 341  # 1 + 4 + 16 + 64 + 256


def test_composables():
    launch = run2("""
        PushRosNamespace('g'),
        ComposableNodeContainer(name='box', namespace='s', package='c', executable='m', composable_node_descriptions=[
            ComposableNode(package='k', plugin='k::A', name='a', namespace='t', remappings=[('x', 'y')],
                           parameters=[{'v': 1}]),
            ComposableNode(package='k', plugin='k::B', condition=IfCondition('false'))]),
        LoadComposableNodes(target_container='other', composable_node_descriptions=[
            ComposableNode(package='k', plugin='k::C', name='c')])""")
    assert [(s.kind, s.plugin.value, full_name(s).value) for s in launch.started] == [
        ("container", "", "/g/s/box"), ("composable", "k::A", "/g/t/a"), ("composable", "k::C", "/g/c"),
    ]  # fmt: skip
    assert remaps(launch.started[1]) == [("x", "y")]
    assert values(launch, 1) == {"v": "1"}


def test_parameters_of_ros2():
    files = {
        "p/a.launch.py": python("""
            DeclareLaunchArgument('file', default_value=[FindPackageShare('p'), '/v.yaml']),
            DeclareLaunchArgument('rate', default_value='5'),
            SetParameter('use_sim_time', True),
            Node(package='k', executable='e', name='n', namespace='g', parameters=[
                {'early': 1}, LaunchConfiguration('file'), {'rate': LaunchConfiguration('rate'), 'text': '5'}],
                arguments=['--ros-args', '-p', 'word:=[1, 2]']),
            Node(package='k', executable='e', parameters=[LaunchConfiguration('file'), 'gone.yaml']),
            Node(package='k', executable='e', name='n', parameters=[RewrittenYaml(
                source_file=LaunchConfiguration('file'), root_key='', param_rewrites={'rate': '9'},
                value_rewrites={'ALL': 'True'})])"""),
        "p/v.yaml": """
            /**: {ros__parameters: {early: 2, all: ALL}}
            n: {ros__parameters: {only: a}}
            g: {n: {ros__parameters: {only: b, deep: {er: 3}}}}
            /*/n: {ros__parameters: {rate: 1}}""",
    }
    launch = launched(files, "p/a.launch.py")
    assert values(launch) == {"word": "[1, 2]", "use_sim_time": "True", "all": "ALL", "early": "2", "only": "b",
                              "deep.er": "3", "rate": "5", "text": "5"}  # fmt: skip
    assert values(launch, 1) == {"use_sim_time": "True", "early": "2", "all": "ALL"}
    assert values(launch, 1, "/n")["only"] == "a"
    assert values(launch, 2)["only"] == "a"
    assert values(launch, 2)["all"] == "True"


def test_a_rewritten_file_holds_below_its_root_key():
    body = """Node(package='k', executable='e', name='n', namespace='robot', parameters=[RewrittenYaml(
        source_file=[FindPackageShare('p'), '/v.yaml'], root_key='robot', param_rewrites={'rate': '9'})])"""
    files = {"p/a.launch.py": python(body), "p/v.yaml": "n: {ros__parameters: {rate: 1, only: b}}"}
    assert values(launched(files, "p/a.launch.py")) == {"rate": "9", "only": "b"}


@pytest.mark.parametrize(
    ("file", "node", "expected"),
    [
        ("'/v.yaml'", "'n'", []),
        ("'/v.yaml'", "'g'", [()]),
        ("'/v.yaml'", "'empty'", [()]),
        ("'/v.yaml'", "'other'", []),
        ("'/v.yaml'", "LaunchConfiguration('of')", [("$(has-node $(find p)/v.yaml $(arg of))",)]),
        ("'/gone.yaml'", "'n'", [("$(has-node $(find p)/gone.yaml n)",)]),
    ],
)  # fmt: skip
def test_whether_a_file_has_parameters_for_a_node(file, node, expected):
    """nav2_common asks for a key of the file itself."""
    asked = f"HasNodeParams(source_file=[FindPackageShare('p'), {file}], node_name={node})"
    body = f"Node(package='k', executable='e', name='n', condition=IfCondition({asked}))"
    files = {"p/a.launch.py": python(body), "p/v.yaml": "g: {n: {ros__parameters: {only: b}}}\nempty: {}"}
    assert [started.conditions for started in launched(files, "p/a.launch.py").started] == expected


@pytest.mark.parametrize(
    ("keys", "name", "holds"),
    [
        ("/**", "/a/b", True), ("**", "/a/b", True), ("/**", "", True), ("/a/b", "/a/b", True), ("a/b", "/a/b", True),
        ("b", "/a/b", False), ("b", "/b", True), ("*", "/b", True), ("*", "/a/b", False), ("/*/b", "/a/b", True),
        ("/**/b", "/b", True), ("/**/b", "/a/c/b", True), ("/a/**", "/a/c/b", True), ("/a/**", "/b", False),
        ("b", "", False),
    ],
)  # fmt: skip
def test_which_node_a_file_means(keys, name, holds):
    entries = parameters(f"{keys}: {{ros__parameters: {{x: 1}}}}" if "*" not in keys else
                         f"'{keys}': {{ros__parameters: {{x: 1}}}}").entries  # fmt: skip
    setting = SettingFile(LaunchText("f", "f"), entries, None)  # type: ignore[arg-type]
    assert bool(select_file_values(setting, name)) == holds


def test_processes():
    launch = run2(
        "ExecuteProcess(cmd=['ros2', 'run', 'k', 'e', '--ros-args', '-r', 'a:=b']), ExecuteProcess(cmd=['ls'])"
    )
    assert [(s.kind, s.package.value, s.executable.value) for s in launch.started] == [
        ("process", "k", "e"), ("process", "", "ls"),
    ]  # fmt: skip
    assert remaps(launch.started[0]) == [("a", "b")]


@pytest.mark.parametrize(
    ("text", "expected"), [("1", 1), ("1.0", 1.0), ("1_0", "1_0"), ("True", True), ("a", "a"), ("1.a", "1.a")]
)
def test_values_of_ros1(text, expected):
    assert parse_ros1_value(text) == expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [("1 + 2 * 3", 7), ("'a' in 'abc' and not False", True), ("'a' if 1 > 2 else 'b'", "b"),
     ("'a-b'.split('-')[1]", "b"),
     ("1 < 2 < 3", True), ("'abc'[1:]", "bc"), ("len('ab') == 2", True)],
)  # fmt: skip
def test_expressions(expression, expected):
    assert evaluate(expression, {"False": False}, {}) == expected


@pytest.mark.parametrize(
    "expression",
    ["__import__('os')", "'a' * 10**9", "2 ** 99", "().__class__", "[x for x in y]", "unknown", "1 +",
     "'a'.format()",
     "'a'.replace('a', 1)", "'" + "a" * 900 + "'.replace('a', '" + "b" * 900 + "')", "1 / 0",
     "'%9999999s' % 1", "(" * 500, "9" * 5000],
)  # fmt: skip
def test_expressions_that_are_not_evaluated(expression):
    with pytest.raises(CannotTell):
        evaluate(expression, {}, {})


def test_deep_and_wide_launches_end():
    deep = "<launch>" + "<group>" * 55 + '<include file="$(find p)/{}.launch"/>' + "</group>" * 55 + "</launch>"
    launch = launched({f"p/{n}.launch": deep.format(n + 1) for n in range(40)}, "p/0.launch")
    assert launch.files[-1] != ("p", "39.launch")
    wide = "<launch>" + '<include file="$(find p)/{}.launch"/>' * 10 + "</launch>"
    launch = launched({f"p/{n}.launch": wide.replace("{}", str(n + 1)) for n in range(9)}, "p/0.launch")
    assert launch.actions == MOST_ACTIONS
    doubled = '<arg name="a" default="x"/>' + '<let name="a" value="$(var a)$(var a)"/>' * 40
    launch = launched(f'<launch>{doubled}<node pkg="k" exec="e" name="$(var a)"/></launch>')
    assert launch.started[0].name.reasons == ("is too long",)


PIECES = st.sampled_from(
    ["$(arg a)", "$(var a)", "$(eval 1 + )", "$(eval '$(var a)')", "$(find p)", "$(dirname)", "$(not x)", "$(if 1 2 3)",
     "$(and)", "$(equals a b)", "$(command x)", "$(env A)", "$(exec-in-pkg a b)", "a", "/", "~", "", "true", ":="],
)  # fmt: skip
ATTRIBUTES = st.sampled_from(
    ["name", "value", "default", "if", "unless", "ns", "namespace", "pkg", "type", "exec", "args", "file", "from", "to",
     "plugin", "target", "param", "command", "subst_value", "scoped", "cmd", "period", "clear_params"],
)  # fmt: skip
TAGS = st.sampled_from(
    ["node", "group", "arg", "let", "include", "param", "rosparam", "remap", "composable_node", "node_container",
     "load_composable_node", "push_ros_namespace", "executable", "env", "set_parameter", "test", "timer", "odd"],
)  # fmt: skip
ELEMENTS = st.recursive(
    st.tuples(TAGS, st.dictionaries(ATTRIBUTES, st.lists(PIECES, max_size=3).map("".join), max_size=5), st.just([])),
    lambda inner: st.tuples(
        TAGS, st.dictionaries(ATTRIBUTES, st.lists(PIECES, max_size=3).map("".join), max_size=5), st.lists(inner)
    ),
    max_leaves=12,
)


def written(element):
    tag, attributes, children = element
    values = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items())
    return f"<{tag}{values}>{''.join(map(written, children))}</{tag}>"


@settings(max_examples=60, deadline=None)
@given(st.lists(ELEMENTS, max_size=6), st.sampled_from([1, 2]))
def test_following_never_raises(elements, generation):
    text = f"<launch>{''.join(map(written, elements))}</launch>"
    launch = launched(text, generation=generation)
    for started in launch.started:
        launch.collect_parameters(started, full_name(started).value or "")
        assert full_name(started).value is None or full_name(started).value.startswith("/")


def test_no_launch_file():
    launch = launched({}, "p/a.launch")
    assert (launch.started, launch.files) == ((), ())
