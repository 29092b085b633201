"""Facts of launch files in Python."""

import textwrap

import pytest
from rosimpact.impact.facts.launch.actions import LaunchFile, find_literal
from rosimpact.impact.facts.launch.flow import extract
from rosimpact.impact.facts.launch.python_walk import MOST_STEPS


def said(value):
    """A value in short, as a person would note it down."""
    shown = []
    for p in value:
        parts = ", ".join(said(part) for part in p.parts)
        name = f"{p.kind} {p.text}".strip()
        shown.append(p.text if p.kind == "text" else f"<{name}{f': {parts}' if parts else ''}>")
    return "".join(shown)


def lines(actions, depth=0):
    found = []
    for action in actions:
        attributes = " ".join(f"{key}={said(value)}" for key, value in action.attributes)
        conditions = "".join(f" [{c.kind} {said(c.value)}]" for c in action.conditions)
        found.append(f"{'  ' * depth}{action.kind} {attributes}".rstrip() + conditions)
        found += lines(action.children, depth + 1)
    return found


def read(body, before=""):
    """The actions of a launch file whose generate_launch_description() has a body."""
    inside = textwrap.indent(textwrap.dedent(body), "    ")
    text = f"{textwrap.dedent(before)}\ndef generate_launch_description():\n{inside}\n"
    file = extract(text.encode(), "launch_python")
    assert (file.language, file.generation, file.problems) == ("python", 2, ())
    return lines(file.actions)


def test_what_actions_say():
    body = """
    return LaunchDescription([
        DeclareLaunchArgument('ns', default_value='r1', description='d'),
        DeclareLaunchArgument(name='must'),
        SetLaunchConfiguration('a', 'b'),
        SetEnvironmentVariable('E', 'v'),
        SetParameter(name='use_sim_time', value=True),
        SetRemap(src='/tf', dst='tf'),
        PushRosNamespace(LaunchConfiguration('ns')),
        launch_ros.actions.Node(
            package='p', executable='e', name='n', namespace='s', output='screen',
            remappings=[('a', 'b'), (LaunchConfiguration('from'), ['x/', LaunchConfiguration('to')])],
            parameters=[{'f': 0.5, 'b': False, 's': '5', 'l': [1, 2], 'k': LaunchConfiguration('k'),
                         'deep': {'er': ['a', 'b']}}, os.path.join(get_package_share_directory('q'), 'a.yaml'),
                        ParameterFile('b.yaml', allow_substs=True)],
            arguments=['--ros-args', '--log-level', LaunchConfiguration('level')],
            condition=IfCondition(LaunchConfiguration('go'))),
        ComposableNodeContainer(
            name='box', namespace='', package='rclcpp_components', executable='component_container',
            composable_node_descriptions=[ComposableNode(package='p', plugin='p::A', name='a')]),
        LoadComposableNodes(target_container='box', composable_node_descriptions=[
            ComposableNode(package='p', plugin='p::B', condition=UnlessCondition('true'))]),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource([FindPackageShare('q'), '/launch/a.launch.py']),
            launch_arguments={'ns': LaunchConfiguration('ns'), 'k': 'v'}.items()),
        GroupAction([Node(package='p', executable='f')], scoped=False),
        TimerAction(period=5.0, actions=[ExecuteProcess(cmd=['ros2', 'run', 'p', 'g'])]),
        RegisterEventHandler(OnProcessExit(target_action=x, on_exit=[Node(package='p', executable='h')])),
        LogInfo(msg='hello'),
    ])
    """
    assert read(body, "import launch_ros\nx = 1") == [
        "argument name=ns default=r1",
        "argument name=must",
        "let name=a value=b",
        "environment name=E value=v",
        "parameter name=use_sim_time value=True type=bool",
        "remap from=/tf to=tf",
        "namespace namespace=<arg ns>",
        "node package=p executable=e name=n namespace=s arguments=--ros-args arguments=--log-level"
        " arguments=<arg level> [if <arg go>]",
        "  remap from=a to=b",
        "  remap from=<arg from> to=x/<arg to>",
        "  parameter name=f value=0.5 type=double",
        "  parameter name=b value=False type=bool",
        "  parameter name=s value=5 type=str",
        "  parameter name=l value=[1, 2] type=list",
        "  parameter name=k value=<arg k>",
        '  parameter name=deep.er value=["a", "b"] type=list',
        "  parameter-file file=<join: <find q>, a.yaml>",
        "  parameter-file file=b.yaml substitute=true",
        "container package=rclcpp_components executable=component_container name=box namespace=",
        "  composable package=p plugin=p::A name=a",
        "load container=box",
        "  composable package=p plugin=p::B [unless true]",
        "include file=<find q>/launch/a.launch.py",
        "  pass name=ns value=<arg ns>",
        "  pass name=k value=v",
        "group scoped=false".replace("false", "False"),
        "  node package=p executable=f",
        "group scoped=false [after 5.0 s]",
        "  process command=ros2 command=run command=p command=g",
        "group scoped=false [after OnProcessExit]",
        "  node package=p executable=h",
    ]


VALUES = [
    ("'a' + 'b'", "ab"),
    ("LaunchConfiguration('p') + ['/', x]", "<arg p>/b"),
    ("[x, '/'] + LaunchConfiguration('p')", "b/<arg p>"),
    ("str(LaunchConfiguration('p')) + x", "<arg p>b"),
    ("str(8) + x", "8b"),
    ("x + str(2 * 3)", "b6"),
    ("'a' if 2 > 1 else 'c'", "a"),
    ("f'a{x}c'", "abc"),
    ("'%s/%s' % ('a', x)", "a/b"),
    ("'{}-{k}'.format(x, k=1)", "b-1"),
    ("'/'.join(['a', x])", "a/b"),
    ("['a', x]", "ab"),
    ("os.path.join('a', x)", "<join: a, b>"),
    ("Path(x) / 'a'", "<join: b, a>"),
    ("str(Path(__file__).parent / 'a')", "<join: <dirname>, a>"),
    ("os.path.dirname(os.path.dirname(__file__))", "<join: <dirname>, ..>"),
    ("PathJoinSubstitution([FindPackageShare(LaunchConfiguration('p')), 'a'])", "<join: <find: <arg p>>, a>"),
    ("os.path.join(FindPackageShare('a').find('b'), 'c')", "<join: <find b>, c>"),
    ("FindPackageShare(package='b').find(package_name=x)", "<find b>"),
    ("FindPackagePrefix('b').find(LaunchConfiguration('p').perform(None))", "<prefix: <arg p>>"),
    ("get_package_share_directory('b').find('c')", "<other get_package_share_directory('b').find('c')>"),
    ("'abc'.find('c')", "<other 'abc'.find('c')>"),
    ("FindExecutable(name='a').find('a')", "<other FindExecutable(name='a').find('a')>"),
    ("LaunchConfiguration('p', default='d')", "<arg p: d>"),
    ("LaunchConfiguration('p').perform(None) + x", "<arg p>b"),
    ("EnvironmentVariable('E', default_value='d')", "<env E: d>"),
    ("os.environ['E']", "<env E>"),
    ("os.environ.get('E', 'd')", "<env E: d>"),
    ("os.getenv('E', default='d')", "<env E: d>"),
    ("ThisLaunchFileDir()", "<dirname>"),
    ("AnonName('n')", "<anon n>"),
    ("PythonExpression(['not ', LaunchConfiguration('p')])", "<eval launch: not <arg p>>"),
    ("Command(['xacro ', x])", "<command: xacro b>"),
    ("AndSubstitution(LaunchConfiguration('p'), NotSubstitution('q'))", "<and: <arg p>, <not: q>>"),
    ("NotEqualsSubstitution(LaunchConfiguration('p'), '')", "<not: <equals: <arg p>, >>"),
    ("IfElseSubstitution(LaunchConfiguration('p'), 'a', 'b')", "<choose: <arg p>, a, b>"),
    ("'a' if LaunchConfiguration('p').perform(None) == 'q' else 'b'", "<choose: <equals: <arg p>, q>, a, b>"),
    ("'a' if x == 'b' else 'c'", "a"),
    ("unknown_thing(x) or 'a'", "<other unknown_thing(x) or 'a'>"),
    ("unknown_thing(x) and x", "<other unknown_thing(x) and x>"),
    ("x or unknown_thing(x)", "b"),
    ("x == 'a' or LaunchConfiguration('p').perform(None) == 'q'", "<equals: <arg p>, q>"),
    ("'a' if unknown_thing(x) or LaunchConfiguration('p').perform(None) == 'q' else 'b'",
     "<choose: <or: <other unknown_thing(x)>, <equals: <arg p>, q>>, a, b>"),
    ("{'b': 'found'}[x]", "found"),
    ("('a', 'second')[1]", "second"),
    ("(lambda y: y + 'c')(x)", "bc"),
    ("helper(x, second='z')", "bz"),
    ("unknown_thing(x)", "<other unknown_thing(x)>"),
    ("x.upper()", "<method upper: b>"),
    ("open('f').read()", "<content: f>"),
    ("RewrittenYaml(source_file='f', root_key=x, param_rewrites={'a': 'c'})", "<rewritten: f, b, a, c>"),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "expected"), VALUES)
def test_values(expression, expected):
    before = "import os\nfrom pathlib import Path\nx = 'b'\ndef helper(first, second='s'):\n    return first + second"
    found = read(f"return LaunchDescription([SetLaunchConfiguration('v', {expression})])", before)
    assert found == [f"let name=v value={expected}"]


BODIES = {
    "lists": (
        """
        ld = LaunchDescription()
        nodes = [Node(package='p', executable='a')]
        nodes.append(Node(package='p', executable='b'))
        nodes += [Node(package='p', executable='c')]
        nodes.extend([Node(package='p', executable='d')])
        ld.add_action(nodes[0])
        for node in nodes[1:]:
            ld.add_action(node)
        return LaunchDescription(nodes + [Node(package='p', executable='e')])
        """,
        [f"node package=p executable={e}" for e in "abcde"],
    ),
    "ranges": (
        """
        return LaunchDescription([
            Node(package='p', executable=e, name=f'n{i}')
            for e, turns in {'a': range(1, 3), 'b': range(5, 0, -3), 'c': range(1, 9, 0)}.items() for i in turns])
        """,
        ["node package=p executable=a name=n1", "node package=p executable=a name=n2",
         "node package=p executable=b name=n5", "node package=p executable=b name=n2",
         "node package=p executable=c name=n<other i> [each <other for i in turns>]"],
    ),
    "loop": (
        """
        return LaunchDescription(
            [Node(package='p', executable='e', name=f'n{i}') for i in range(2)]
            + [Node(package='p', executable=e, name=n) for n, e in {'a': 'b', 'c': 'd'}.items() if n != 'a'])
        """,
        ["node package=p executable=e name=n0", "node package=p executable=e name=n1",
         "node package=p executable=d name=c"],
    ),
    "unknown loop": (
        """
        ld = LaunchDescription()
        for robot in read_robots():
            ld.add_action(Node(package='p', executable='e', namespace=robot))
        return ld
        """,
        ["node package=p executable=e namespace=<other robot> [each <other for robot in read_robots()>]"],
    ),
    "branches": (
        """
        ld = LaunchDescription()
        if os.environ['E'] == 'x':
            name = 'a'
            ld.add_action(Node(package='p', executable='e'))
        elif len(sys.argv) > 2:
            name = 'b'
        else:
            name = 'c'
        ld.add_action(Node(package='p', executable='f', name=name))
        return ld
        """,
        [
            "node package=p executable=e [if <equals: <env E>, x>]",
            "node package=p executable=f name=<choose: <equals: <env E>, x>, a,"
            " <choose: <other len(sys.argv) > 2>, b, c>>",
        ],
    ),
    "early return": (
        """
        if os.environ['E'] == 'x':
            return LaunchDescription([Node(package='p', executable='a')])
        ld = LaunchDescription()
        ld.add_action(Node(package='p', executable='b'))
        return ld
        """,
        [
            "node package=p executable=a [if <equals: <env E>, x>]",
            "node package=p executable=b [unless <equals: <env E>, x>]",
        ],
    ),
    "a boolean argument of MoveIt": (
        "return LaunchDescription([DeclareBooleanLaunchArg('debug', False), DeclareBooleanLaunchArg('go', "
        "default_value=True)])",
        ["argument name=debug default=False", "argument name=go default=True"],
    ),
    "opaque function": (
        """
        def setup(context, name):
            value = LaunchConfiguration('v').perform(context)
            if value == 'x' or context.launch_configurations['w'] in ('y', 'z'):
                return [Node(package='p', executable='a', name=name)]
            return [Node(package='p', executable=value)]
        return LaunchDescription([OpaqueFunction(function=setup, args=['n'])])
        """,
        [
            "group scoped=false",
            "  node package=p executable=a name=n [if <or: <equals: <arg v>, x>, <in: <arg w>, y, z>>]",
            "  node package=p executable=<arg v> [unless <or: <equals: <arg v>, x>, <in: <arg w>, y, z>>]",
        ],
    ),
    "parameters of a file": (
        """
        with open(os.path.join('a', 'b.yaml')) as f:
            values = yaml.safe_load(f)['/**']['ros__parameters']
        return LaunchDescription([Node(package='p', executable='e', parameters=[values, {'x': values}])])
        """,
        [
            "node package=p executable=e",
            "  parameter-file file=<join: a, b.yaml> below=/** below=ros__parameters",
            "  parameter-file file=<join: a, b.yaml> below=/** below=ros__parameters name=x",
        ],
    ),
    "class": (
        """
        class Maker:
            def __init__(self, name):
                self.name = name
            def make(self):
                return [Node(package='p', executable='e', name=self.name)]
        return LaunchDescription(Maker('n').make())
        """,
        ["node package=p executable=e name=n"],
    ),
    "container object": (
        """
        box = ComposableNodeContainer(name='box', namespace='s', package='c', executable='m')
        return LaunchDescription([box, LoadComposableNodes(
            target_container=box, composable_node_descriptions=[ComposableNode(package='p', plugin='p::A')])])
        """,
        ["container package=c executable=m name=box namespace=s", "load container-node=s/box",
         "  composable package=p plugin=p::A"],
    ),
    "what is not followed": (
        """
        return LaunchDescription([make_one(), Node(package='p', executable='e', remappings=rules(), parameters=more()),
                                  *others])
        """,
        ["unknown text=<other make_one()>", "node package=p executable=e", "  unknown text=<other remappings: rules()>",
         "  unknown text=<other parameters: more()>", "unknown text=<other *others>"],
    ),
    "conditions": (
        """
        return LaunchDescription([
            Node(package='p', executable='a', condition=LaunchConfigurationEquals('m', 'x')),
            Node(package='p', executable='b', condition=LaunchConfigurationNotEquals('m', 'x')),
            Node(package='p', executable='c', condition=strange())])
        """,
        ["node package=p executable=a [if <equals: <arg m>, x>]",
         "node package=p executable=b [unless <equals: <arg m>, x>]",
         "node package=p executable=c [if <other strange()>]"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", BODIES)
def test_bodies(name):
    body, expected = BODIES[name]
    assert read(body, "import os\nimport sys\nimport yaml") == expected


def test_lines_are_those_of_the_call():
    text = (
        b"def generate_launch_description():\r\n    return LaunchDescription([\r\n        Node(\r\n package='p')])\r\n"
    )
    (node,) = extract(text, "launch_python").actions
    assert (node.line, find_literal(node.get("package"))) == (3, "p")


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"x = 1", "has no generate_launch_description()"),
        (b"def generate_launch_description(:\n", "not parsed"),
        (b"def generate_launch_description():\n  return f()\ndef f():\n  return f()", None),
        (b"def generate_launch_description():\n  while True:\n    x = 1\n  return LaunchDescription()", None),
        (b"x = " + b"(" * 300 + b")" * 300, "not parsed"),
        (b"def generate_launch_description():\n  return " + b"+".join([b"x"] * 20_000), ""),
        (b"\x00", "not parsed"),
        (b"\xff\xfe", "not"),
        (
            b"a = []\n"
            + b"\n".join(b"a = a + a + [1]" for _ in range(60))
            + b"\ndef generate_launch_description():\n  pass",
            "takes more than",
        ),
    ],
)
def test_odd_files_come_back(data, problem):
    file = extract(data, "launch_python")
    assert isinstance(file, LaunchFile)
    if problem is not None:
        assert any(problem in p.message for p in file.problems)


def test_steps_are_bounded():
    inner = "\n".join(f"{'  ' * (d + 1)}for x{d} in range(100):" for d in range(6))
    text = f"def generate_launch_description():\n{inner}\n{'  ' * 7}y = 1\n"
    assert extract(text.encode(), "launch_python").problems[0].message == f"takes more than {MOST_STEPS} steps"
