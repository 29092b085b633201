"""Python facts: what a source imports, uses and refers to, and which Python can read it."""

import sys

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.python.source import NEVER_PYTHON, NO_PYTHON, PythonFile, extract


def conditions_of(item):
    return [("not " if c.negated else "") + c.text for c in item.conditions]


def imports(text):
    return [("." * i.level + i.module, *i.names, *conditions_of(i)) for i in extract(text.encode()).imports]


def attributes(text):
    return [(a.text, *conditions_of(a)) for a in extract(text.encode()).attributes]


def references(text):
    return [(r.kind, r.package, r.name) for r in extract(text.encode()).references]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import a, b.c as d", [("a",), ("b.c",)]),
        ("from a.b import c, d as e", [("a.b", "c", "d")]),
        ("from a import *", [("a", "*")]),
        ("from . import x\nfrom ..y import z", [(".", "x"), ("..y", "z")]),
        ("try:\n  import a\nexcept ImportError:\n  import b", [("a", "try"), ("b", "not try")]),
        ("try:\n  import a\nexcept (ValueError, ModuleNotFoundError):\n  pass", [("a", "try")]),
        ("try:\n  import a\nexcept:\n  pass\nfinally:\n  import c", [("a", "try"), ("c",)]),
        ("try:\n  import a\nexcept ValueError:\n  import b", [("a",), ("b",)]),
        ("try:\n  import a\nexcept ImportError:\n  import sys\n  sys.exit('a')", [("a",), ("sys", "not try")]),
        ("try:\n  import a\nexcept ImportError as e:\n  raise RuntimeError('no a') from e", [("a",)]),
        ("try:\n  import a\nexcept ImportError:\n  raise", [("a",)]),
        ("try:\n  import a\nexcept ImportError:\n  raise SkipTest('no a')", [("a", "try")]),
        ("def f():\n  try:\n    import a\n  except ImportError:\n    if x:\n      return\n    raise", [("a", "try")]),
        ("with contextlib.suppress(ImportError):\n  import a", [("a", "try")]),
        ("if TYPE_CHECKING:\n  import a", [("a", "TYPE_CHECKING")]),
        ("if typing.TYPE_CHECKING:\n  import a", [("a", "TYPE_CHECKING")]),
        ("if sys.version_info[0] == 2:\n  import a\nelse:\n  import b",
         [("a", "sys.version_info[0] == 2"), ("b", "not sys.version_info[0] == 2")]),
        ("if not PY3:\n  import a", [("a", "not PY3")]),
        ("if A:\n  pass\nelif B:\n  import b", [("b", "not A", "B")]),
        ("if (A and\n     B):\n  import a", [("a", "A and B")]),
        ("if __name__ == '__main__':\n  import a", [("a",)]),
    ],
)  # fmt: skip
def test_imports(text, expected):
    assert imports(text) == expected


def test_places_and_laziness_of_imports():
    first, second = extract("é = 1; import a\ndef f():\n    from b import c\n".encode()).imports
    assert (first.line, first.column, first.lazy) == (1, 15, False)
    assert (second.line, second.column, second.lazy) == (3, 5, True)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import time as t\nt.clock()", [("time.clock",)]),
        ("import a.b\na.b.c.d()", [("a.b.c.d",)]),
        ("from a import b\nb.c", [("a.b",), ("a.b.c",)]),
        ("from a import b as z", [("a.b",)]),
        ("from .a import b\nb.c", []),
        ("x.y", []),
        ("import a\ndef f(a):\n  a.b", []),
        ("import a\ndef f():\n  a = 1\n  a.b", []),
        ("import a\nclass C:\n  a = 1\n  def f(self):\n    a.b", [("a.b",)]),
        ("def f():\n  a.b\nimport a", [("a.b",)]),
        ("def f():\n  import a\n  a.b\ndef g():\n  a.c", [("a.b",)]),
        ("def f():\n  global a\n  import a\ndef g():\n  a.c", [("a.c",)]),
        ("import a\na.b\na.b", [("a.b",)]),
        # What the file assigns is there.
        ("import sys\nif hasattr(sys, 'a') and \\\n  hasattr(sys, 'b'):\n  sys.c",
         [("sys.c", "hasattr(sys, 'a') and hasattr(sys, 'b')")]),
        ("import sys\nif not hasattr(sys, 'maxint'):\n  sys.maxint = sys.maxsize\nsys.maxint",
         [("sys.maxsize", "not hasattr(sys, 'maxint')")]),
        ("import a as z\ndef f():\n  z.b.c = 1\nz.b.c\nz.b.d", [("a.b.d",)]),
        ("import a\na.b().c", [("a.b",)]),
        ("import a\nif a.ok:\n  a.b", [("a.ok",), ("a.b",)]),
        ("import sys\nif sys.version_info > (3,):\n  sys.b",
         [("sys.version_info",), ("sys.b", "sys.version_info > (3,)")]),
        ("import a\ntry:\n  a.b\nexcept AttributeError:\n  a.c", [("a.b", "try"), ("a.c", "not try")]),
        ("import a\ntry:\n  a.b\nexcept AttributeError:\n  exit(1)", [("a.b",)]),
        ("try:\n  import a as x\nexcept ImportError:\n  import b as x\nx.y", [("a.y", "try"), ("b.y", "not try")]),
        ("import a\ny = a.b if PY2 else a.c", [("a.b", "PY2"), ("a.c", "not PY2")]),
        ("import a\n@a.deco\ndef f(x: a.T = a.d) -> a.R: ...",
         [("a.deco",), ("a.T",), ("a.d",), ("a.R",)]),
        ("import a\nf = lambda a: a.b", []),
    ],
)  # fmt: skip
def test_attributes(text, expected):
    assert attributes(text) == expected


SHARE = "from ament_index_python.packages import get_package_share_directory as share\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("get_package_share_directory('p')", [("package", "p", "")]),
        (SHARE + "share('p')", [("package", "p", "")]),
        ("pkg = 'p'\nget_package_prefix(pkg)", [("package", "p", "")]),
        ("get_package_share_directory(name)", []),
        ("pkg = 'p'\npkg = 'q'\nget_package_prefix(pkg)", []),
        ("import rospkg\nrospkg.RosPack().get_path('p')", [("package", "p", "")]),
        ("import rospkg\nself.pack.get_path('p') + '/launch/x.launch'", [("file", "p", "launch/x.launch")]),
        ("sysconfig.get_path('purelib')", []),
        ("roslib.packages.get_pkg_dir('p')", [("package", "p", "")]),
        ("roslib.load_manifest('p')", [("package", "p", "")]),
        ("os.path.join(get_package_share_directory('p'), 'launch', 'x.py')", [("file", "p", "launch/x.py")]),
        ("s = get_package_share_directory('p')\nos.path.join(s, 'launch', 'x.py')",
         [("package", "p", ""), ("file", "p", "launch/x.py")]),
        ("s = get_package_share_directory('p')\ndef f():\n  return s + '/a.yaml'",
         [("package", "p", ""), ("file", "p", "a.yaml")]),
        ("Path(get_package_share_directory('p')) / 'a' / 'b.yaml'", [("file", "p", "a/b.yaml")]),
        ("s = get_package_share_path('p')\nf'{s}/a.yaml'", [("package", "p", ""), ("file", "p", "a.yaml")]),
        ("os.path.join(get_package_share_directory('p'), name)", [("package", "p", "")]),
        ("FindPackageShare('p')", [("package", "p", "")]),
        ("FindPackageShare(package='p').find('p')", [("package", "p", "")]),
        ("PathJoinSubstitution([FindPackageShare('p'), 'config', 'a.yaml'])", [("file", "p", "config/a.yaml")]),
        ("PathJoinSubstitution([FindPackageShare('p'), 'config', LaunchConfiguration('a')])", [("package", "p", "")]),
        ("PythonLaunchDescriptionSource([FindPackageShare('p'), '/launch/a.py'])", [("file", "p", "launch/a.py")]),
        ("x = [get_package_share_directory('p'), 'a']", [("package", "p", "")]),
        ("Node(package='p', executable='e')", [("executable", "p", "e")]),
        ("Node(package='p', node_executable='e')", [("executable", "p", "e")]),
        ("roslaunch.core.Node('p', 'e', name='n')", [("executable", "p", "e")]),
        ("roslaunch.core.Node(package='p', node_type='e')", [("executable", "p", "e")]),
        ("xml.dom.Node('p', 'e')", []),
        ("Node(package='p', executable=name)", [("package", "p", "")]),
        ("Node(package=name, executable='e')", []),
        ("ComposableNode(package='p', plugin='ns::C')", [("plugin", "p", "ns::C")]),
        ("ComposableNodeContainer(package='p', executable='e', composable_node_descriptions=[\n"
         " ComposableNode(package='q', plugin='C')])", [("executable", "p", "e"), ("plugin", "q", "C")]),
        ("Command(['xacro ', FindPackageShare('p'), '/u.xacro'])", [("command", "", "xacro"), ("package", "p", "")]),
        ("Command([FindExecutable(name='xacro'), ' ', path])", [("command", "", "xacro")]),
        ("ExecuteProcess(cmd=['ros2', 'run', 'p', 'e'])", [("executable", "p", "e")]),
        ("subprocess.Popen(['rosrun', 'p', 'e', arg])", [("executable", "p", "e")]),
        ("os.system('roslaunch p x.launch a:=b')", [("sought", "p", "x.launch")]),
        ("subprocess.run(command)", []),
        ("import subprocess\nsubprocess.run(['ffmpeg', path])", [("command", "", "ffmpeg")]),
        ("from os import system as do\ndo('sudo ffmpeg -i ' + path)", [("command", "", "ffmpeg")]),
        ("import subprocess as sp\nsp.call(f'rosrun p e {path}', shell=True)", [("executable", "p", "e")]),
        ("import os\nos.system('ffmpeg{}'.format(path))", []),
        ("import os\nos.system('ffmpeg {}'.format(path))", [("command", "", "ffmpeg")]),
        ("import subprocess\ndef f(x):\n  c = ['ffmpeg', x]\n  c.append('-y')\n  subprocess.run(c)",
         [("command", "", "ffmpeg")]),
        ("import client\nclient.call('ffmpeg -i x')", []),
        ("self.run(['ffmpeg'])", []),
        ("x = 'package://p/meshes/a.dae'", [("file", "p", "meshes/a.dae")]),
        ("x = '$(find p)/launch/a.launch'", [("file", "p", "launch/a.launch")]),
        ("'''about package://p/a'''", []),
        ("def f():\n  '''about $(find p)'''", []),
        ("MoveItConfigsBuilder('panda', package_name='p')", [("package", "p", "")]),
        ("MoveItConfigsBuilder('panda')", [("package", "panda_moveit_config", "")]),
        ("MoveItConfigsBuilder(**given, package_name='p')", [("package", "p", "")]),
        ("MoveItConfigsBuilder(**given)", []),
        ("def load(name, path):\n  return open(get_package_share_directory(name) + path)\nload('p', 'a.yaml')",
         [("package", "p", "")]),
    ],
)  # fmt: skip
def test_references(text, expected):
    assert references(text) == expected


@pytest.mark.parametrize(
    ("text", "conditional"),
    [
        ("FindPackageShare('p')", False),
        ("if gui:\n  FindPackageShare('p')", True),
        ("Node(package='p', executable='e', condition=IfCondition(x))", True),
        ("Node(package='p', executable='e', condition=None)", False),
        ("Include(Source([FindPackageShare('p'), '/a.py']), condition=IfCondition(x))", True),
        ("DeclareLaunchArgument('d', default_value='p')\nFindPackageShare(LaunchConfiguration('d'))", True),
        ("try:\n  get_package_prefix('p')\nexcept PackageNotFoundError:\n  pass", True),
    ],
)
def test_conditional_references(text, conditional):
    (reference,) = extract(text.encode()).references
    assert (reference.package, reference.conditional) == ("p", conditional)


def test_a_reference_stands_where_the_name_does():
    (reference,) = extract(b"x = Node(\n    package='p',\n    executable='e')").references
    assert (reference.line, reference.column) == (3, 16)


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ('print "a"', 1, "print statement"),
        ("print >>sys.stderr, x", 1, "print statement"),
        ("if a: print b", 1, "print statement"),
        ("\ntry:\n  pass\nexcept A, e:\n  pass", 4, "`except A, e`"),
        ("try:\n  pass\nexcept (A, B), e:\n  pass", 3, "`except (A, B), e`"),
        ("try:\n  pass\nexcept E, (a, b):\n  pass", 3, "`except E, (a, b)`"),
        ('exec "a = 1"', 1, "exec statement"),
        ("exec code in ns", 1, "exec statement"),
        ('raise E, "m"', 1, '`raise E, "message"`'),
        ("a <> b", 1, "`<>`"),
        ("x = 0777", 1, "octal number without 0o"),
        ("x = 10L", 1, "long integer"),
        ("x = ur'a'", 1, "ur string"),
        ("x = `a`", 1, "backticks"),
        ("def f(a, (b, c)):\n  pass", 1, "tuple parameter"),
        ("f(async=True)", 1, "`async` as a name"),
        ("from a import async", 1, "`async` as a name"),
        ("x = a.None", 1, "`None` as a name"),
        ("if a:\n        b\n\tc", 3, "tabs mixed with spaces"),
    ],
)
def test_python_2(text, line, what):
    facts = extract(text.encode())
    assert (line, what) in [(p.line, p.message) for p in facts.python2_only]
    assert facts.problems == ()


@pytest.mark.parametrize(
    "text",
    [
        "print('a')",
        "print (a), b",
        "print",
        "x = 'print \"a\"'",
        "def f(:",
        "x = {{ template }}{",
        "match = 1; match(x)",
        "1 +",
    ],
)
def test_not_python_2(text):
    assert extract(text.encode()).python2_only == ()


def test_imports_of_a_python_2_file_are_read():
    facts = extract(b"import a\nif PY2:\n    print 'x', a.b\n    import c\n")
    assert [(i.module, conditions_of(i)) for i in facts.imports] == [("a", []), ("c", ["PY2"])]
    assert [a.text for a in facts.attributes] == ["a.b"]


def test_columns_of_a_file_with_mixed_tabs():
    facts = extract(b"if a:\n        x = 1\n\timport b; print 'x'\n")
    assert [(i.line, i.column) for i in facts.imports] == [(3, 9)]
    assert [p.message for p in facts.python2_only] == ["print statement", "tabs mixed with spaces"]


def test_imports_of_a_broken_file_are_read_by_their_look():
    facts = extract(
        b"import a, b.c as d\nfrom e import (f,\n  g)\ndef (:\n  import h\n'''\nimport no\n'''\n# import no\n"
    )
    assert [(i.module, i.names, conditions_of(i)) for i in facts.imports] == [
        ("a", (), []),
        ("b.c", (), []),
        ("e", ("f", "g"), []),
        ("h", (), ["try"]),
    ]
    assert facts.problems[0].line == 4


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = 1", None),
        ("print('a' % b)", None),
        ("def f(*, a): pass", (0, 1)),
        ("def f() -> int: pass", (0, 1)),
        ("x: int = 1", (6, 1)),
        ("\nf'{x}'", (6, 2)),
        ("async def f(): pass", (5, 1)),
        ("if (x := 1): pass", (8, 1)),
        ("def f(a, /): pass", (8, 1)),
        ("with (open(a) as b, open(c) as d): pass", (9, 1)),
        ("with (open(a)) as b, (open(c)): pass", None),
        ("with (open(a)): pass", None),
        ("match x:\n  case 1: pass", (10, 1)),
        ("match x:\n  case None: f'{x}'", (10, 1)),
    ],
)
def test_needs(text, expected):
    needs = extract(text.encode()).needs
    assert (needs and needs[:2]) == expected


@pytest.mark.parametrize(
    ("text", "minor"),
    [
        ("try: pass\nexcept* A: pass", 11),
        ("type X = int", 12),
        ("def f[T](x: T): pass", 12),
        ("class C[T]: pass", 12),
        ("f'{a['b']}'", 12),
        ("f'{\"\\n\".join(a)}'", 12),
        ("t'{a}'", 14),
    ],
)
def test_needs_of_newer_syntax(text, minor):
    facts = extract(text.encode())
    if sys.version_info >= (3, minor):
        assert facts.needs and facts.needs[:2] == (minor, 1)
    else:
        assert facts.needs == (NO_PYTHON, 1, "SyntaxError")
        assert len(facts.problems) == 1 and facts.python2_only == ()


@pytest.mark.parametrize("text", ["bfrom setuptools import setup", "a = (1, 2", "x = 3 3", "if a\n    b"])
def test_what_no_python_reads(text):
    facts = extract(f"import a\n{text}\n".encode())
    assert facts.needs and facts.needs[:2] == (NEVER_PYTHON, 2)


@pytest.mark.parametrize(
    ("data", "refused"), [(b"a = 1\n# caf\xe9\n", True), (b"# coding: latin-1\n# caf\xe9\n", False)]
)
def test_bytes_that_the_encoding_does_not_have_are_refused_by_every_python(data, refused):
    facts = extract(data)
    assert facts.needs == ((NEVER_PYTHON, 2, "SyntaxError") if refused else None)


@pytest.mark.parametrize("text", ["type A = int )", "x = f'{a['b')'", "with a as b c:", "x = [*a for a in b c]"])
def test_what_a_newer_python_may_read(text):
    facts = extract(f"import a\n{text}\n".encode())
    assert facts.needs and facts.needs[:2] == (NO_PYTHON, 2)


@pytest.mark.skipif(sys.version_info >= (3, 14), reason="this interpreter may read it")
def test_syntax_newer_than_this_interpreter_is_a_problem():
    facts = extract(b"import a\nx = t'{a'\n")
    assert facts.python2_only == ()
    assert facts.problems[0].line == 2
    assert facts.imports[0].module == "a"


def test_interpreter():
    facts = extract(b"#!/usr/bin/env python\nif __name__ == '__main__':\n    main()\n")
    assert facts.interpreter == "#!/usr/bin/env python"
    assert extract(b"#!/bin/sh\n").interpreter == ""


@pytest.mark.parametrize(
    ("data", "problems"),
    [
        ("# coding: latin-1\nx = 'é'; import a".encode("latin-1"), []),
        ("\ufeffimport a".encode(), []),
        ("x = 'é'\nimport a".encode("latin-1"), [1]),
        (b"# -*- coding: no-such -*-\nimport a", [1]),
        (b"# coding: rot13\nimport a", [1]),
        (b"import a\nx = '\0'", [2]),
        (b"import a\nx = " + b"(" * 5000 + b")" * 5000, [2]),
        (b"import a\nx = " + b"-" * 100000 + b"1", [2]),
        (b"import a\nx = " + b"+".join([b"a"] * 3000), None),
        (b"import a\nif x:\n", [2]),
    ],
)
def test_odd_files_still_give_their_imports(data, problems):
    facts = extract(data)
    assert [i.module for i in facts.imports] == ["a"]
    assert facts.python2_only == ()
    if problems is not None:
        assert len(facts.problems) == len(problems)


PIECES = st.sampled_from([
    "import a\n", "from b import c\n", "try:\n", " pass\n", "except A, e:\n", "print 'x'\n", "if PY2:\n", " ", "\n",
    "\t", "(", ")", "[", "]", "'", '"""', "#", "\\", "f'{a}'", "é", "\0", "Node(package='p', executable='e')\n", ", ",
    "x = ", "share + ", "'/a'", "os.path.join(", "FindPackageShare('p')", "lambda a: ", "def f(a, (b, c)):\n", "a.b.c",
    "0777", "`a`", "<>", "@", "with (a as b): pass\n", "'package://p/a'", ":=", "match x:\n", "class C: ", "\r\n",
    "get_path(", "global a\n", ".find('p')",
])  # fmt: skip


def check(data):
    facts = extract(data)
    lines = data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for item in (*facts.imports, *facts.attributes, *facts.references):
        assert 1 <= item.line <= len(lines)
        assert 1 <= item.column <= len(lines[item.line - 1]) + 1
    for problem in (*facts.problems, *facts.python2_only):
        assert 1 <= problem.line <= len(lines)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(facts), type=PythonFile) == facts


@given(st.binary())
def test_never_raises_on_bytes(data):
    check(data)


@given(st.lists(PIECES).map("".join))
def test_never_raises_on_pieces(text):
    check(text.encode())
