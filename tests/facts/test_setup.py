"""What setup.py, setup.cfg and pyproject.toml install."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.requirements import Requirement
from rosimpact.impact.facts.setup import extract

AMENT = """
import os
from glob import glob
from setuptools import find_packages, setup

package_name = 'walker'
share = os.path.join('share', package_name)

setup(
    name=package_name,
    packages=[package_name, f'{package_name}.gait'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        (share, ['package.xml']),
        (os.path.join(share, 'launch'), glob('launch/*.launch.py')),
        ('share/%s/config' % package_name, glob(os.path.join('config', '*.yaml')) + ['extra.yaml']),
        ('share/{}/maps'.format(package_name), sorted(glob('maps/*'))),
        (share, files()),
    ],
    install_requires=['setuptools', 'numpy>=1.2'],
    entry_points={
        'console_scripts': [
            'walk = walker.walk:main',
            f'run = {package_name}.run:main',
        ],
    },
)
"""


def test_ament_python():
    facts = extract(AMENT.encode(), "setup_py")
    assert facts.packages == ("walker", "walker.gait")
    assert facts.entry_points == (("walk", "walker.walk", 23, "main"), ("run", "walker.run", 24, "main"))
    assert facts.data_files == (
        ("share/ament_index/resource_index/packages", "resource/walker", 13),
        ("share/walker", "package.xml", 14),
        ("share/walker/launch", "launch/*.launch.py", 15),
        ("share/walker/config", "config/*.yaml", 16),
        ("share/walker/config", "extra.yaml", 16),
        ("share/walker/maps", "maps/*", 17),
    )
    assert [each.text for each in facts.requirements] == ["setuptools", "numpy>=1.2"]
    assert facts.unresolved == ("data_files: `files()`",)
    assert facts.problems == ()


CATKIN = """
from distutils.core import setup
from catkin_pkg.python_setup import generate_distutils_setup

d = generate_distutils_setup(packages=['walker'], package_dir={'': 'src'}, scripts=['scripts/walk', 'bin/run'])
setup(**d)
"""


def test_catkin():
    facts = extract(CATKIN.encode(), "setup_py")
    assert (facts.packages, facts.package_dirs, facts.scripts) == (
        ("walker",),
        {"": "src"},
        ("scripts/walk", "bin/run"),
    )
    assert facts.unresolved == ()


def test_a_setup_of_both_generations_is_read_as_that_of_ros_2():
    of_catkin = "\n".join(f"    {line}" for line in CATKIN.splitlines())
    of_ament = "    from setuptools import setup\n    setup(packages=['walker', 'walker.gait'])"
    code = f"import os\nif os.environ['ROS_VERSION'] == '1':{of_catkin}\nelse:\n{of_ament}"
    facts = extract(code.encode(), "setup_py")
    assert (facts.packages, facts.package_dirs, facts.scripts) == (("walker", "walker.gait"), {}, ())
    assert facts.unresolved == ()


GIVEN = [
    ("setup(packages=find_packages(exclude=['test']))", "packages", ("*",)),
    ("setup(packages=setuptools.find_packages())", "packages", ("*",)),
    ("setup(packages=['a'] + ['b'])", "packages", ("a", "b")),
    ("setup(scripts=['{0}/{tool}'.format('bin', tool='run')])", "scripts", ("bin/run",)),
    ("setup(scripts=['{:>9}'.format('run')])", "unresolved", ("scripts: `'{:>9}'.format('run')`",)),
    ("p = ('a', 'b')\nsetup(packages=list(p))", "packages", ("a", "b")),
    ("setup(packages=['a'], py_modules=['m'])", "packages", ("a", "m")),
    ("d = dict(packages=['a'])\nd['scripts'] = ['s']\nsetup(**d)", "scripts", ("s",)),
    ("d = {'scripts': ['s']}\nsetup(**d)", "scripts", ("s",)),
    ("if True:\n    setup(scripts=['s'])", "scripts", ("s",)),
    ("def main():\n    setup(scripts=['s'])", "scripts", ("s",)),
    ("try:\n    x = 1\nexcept E:\n    setup(scripts=['s'])", "scripts", ("s",)),
    ("f = []\nf.append(('d', ['a']))\nf += [('e', ['b'])]\nf.extend([('g', ['c'])])\nsetup(data_files=f)", "data_files",
     (("d", "a", 2), ("e", "b", 3), ("g", "c", 4))),
    ("setup(data_files=[('d', glob.glob('**/*.py', recursive=True))])", "data_files", (("d", "**/*.py", 1),)),
    ("setup(data_files=[('d', [str(p) for p in x])])", "unresolved", ("data_files: `[str(p) for p in x]`",)),
    ("for p, d, f in os.walk('x'):\n    files.append((p, f))\nsetup(data_files=files)", "unresolved",
     ("data_files: `files`",)),
    ("setup(entry_points='''\n[console_scripts]\na = b.c:main\n''')", "entry_points", (("a", "b.c", 3, "main"),)),
    ("setup(entry_points={'gui_scripts': ['a=b:c [x]']})", "entry_points", (("a", "b", 1, "c"),)),
    ("setup(entry_points={'ros2cli.command': ['a=b:c']})", "entry_points", ()),
    ("setup(options={'install': {'install_scripts': 'a'},\n'develop': {'script_dir': 'b', 'user': True}})",
     "script_folders", (("install", "a", 1), ("develop", "b", 2))),
    ("setup(options={'develop': read(), 'build': {}})", "unresolved", ("options: `read()`",)),
    ("setup(options=read())", "unresolved", ("options: `read()`",)),
    ("print 'a'\nsetup(packages=['b'])", "packages", ("b",)),  # as Python 2 has it
    ("setup(**read())", "unresolved", ("arguments: `read()`",)),
    ("setup(entry_points=dict(**read()))", "unresolved", ("entry_points: `read()`",)),
]  # fmt: skip


@pytest.mark.parametrize(("text", "field", "expected"), GIVEN)
def test_literals(text, field, expected):
    assert getattr(extract(text.encode(), "setup_py"), field) == expected


PROBLEMS = [
    ("setup_py", "x = (\n", 1, "not parsed: "),
    ("setup_py", "\0", 1, "not parsed: "),
    ("setup_cfg", "[a]\nx=1\n no section\nfoo\n", 4, "not readable as a configuration: "),
    ("setup_cfg", "x = 1\n", 1, "not readable as a configuration: "),
    ("pyproject", "[a]\nx = \n", 2, "not readable as TOML: "),
]


@pytest.mark.parametrize(("kind", "text", "line", "message"), PROBLEMS)
def test_what_cannot_be_read_is_named(kind, text, line, message):
    (problem,) = extract(text.encode(), kind).problems
    assert problem.line == line
    assert problem.message.startswith(message)


SETUP_CFG = """\
[metadata]
name = walker
[develop]
script_dir=$base/lib/walker
[install]
install_scripts=$base/lib/walker
[options]
packages = find:
python_requires = >=3.8
package_dir = = src
install_requires =
  numpy >= 1.2
  scipy
[options.entry_points]
console_scripts =
  walk = walker.walk:main
[options.data_files]
share/walker = package.xml
share/walker/launch =
  launch/a.py
  launch/b.py
"""


def test_setup_cfg():
    facts = extract(SETUP_CFG.encode(), "setup_cfg")
    assert facts.packages == ("*",)
    assert facts.package_dirs == {"": "src"}
    assert [(each.text, each.line) for each in facts.requirements] == [("numpy >= 1.2", 12), ("scipy", 13)]
    assert facts.python_requires == Requirement(">=3.8", 9)
    assert facts.entry_points == (("walk", "walker.walk", 16, "main"),)
    assert facts.data_files == (
        ("share/walker", "package.xml", 18),
        ("share/walker/launch", "launch/a.py", 20),
        ("share/walker/launch", "launch/b.py", 21),
    )
    assert facts.script_folders == (("install", "$base/lib/walker", 6), ("develop", "$base/lib/walker", 4))


PYPROJECT = """\
[project]
name = "walker"
dependencies = ["numpy>=1.2", "scipy"]
requires-python = ">=3.8"
[project.scripts]
walk = "walker.walk:main"
[tool.setuptools]
packages = ["walker"]
package-dir = {"" = "src"}
script-files = ["bin/x"]
[tool.setuptools.data-files]
"share/walker" = ["package.xml"]
[tool.distutils.install]
install-scripts = "$base/lib/walker"
"""


def test_pyproject():
    facts = extract(PYPROJECT.encode(), "pyproject")
    assert facts.packages == ("walker",)
    assert facts.package_dirs == {"": "src"}
    assert facts.entry_points == (("walk", "walker.walk", 6, "main"),)
    assert facts.data_files == (("share/walker", "package.xml", 12),)
    assert facts.scripts == ("bin/x",)
    assert [(each.text, each.line) for each in facts.requirements] == [("numpy>=1.2", 3), ("scipy", 3)]
    assert facts.python_requires == Requirement(">=3.8", 4)


PIECES = [
    "setup(", ")", "packages=", "data_files=", "[", "]", "(", "'a'", ",", "\n", "x", " = ", "+", "f'{x}'", "**d", "%",
    "é", "glob('*')", "entry_points={'console_scripts': ['a = b:c']}",
    "if x:\n    ", "for a in b:\n    ", ".append(", "#",
    "[options]\n", "[project]\n", "scripts = ", "packages = find:\n", '"b"', "[[", "os.path.join(", ": ",
]  # fmt: skip


@pytest.mark.parametrize("kind", ["setup_py", "setup_cfg", "pyproject"])
@given(
    st.one_of(
        st.binary(max_size=150), st.lists(st.sampled_from(PIECES), max_size=20).map(lambda p: "".join(p).encode())
    )
)
def test_never_raises_and_lines_lie_in_the_file(kind, data):
    facts = extract(data, kind)
    last = len(re.findall(rb"\r\n|\r|\n", data)) + 1
    lines = [e[2] for e in (*facts.entry_points, *facts.data_files)] + [p.line for p in facts.problems]
    assert all(1 <= line <= last for line in lines)


@pytest.mark.parametrize("kind", ["setup_py", "setup_cfg", "pyproject"])
@pytest.mark.parametrize("text", ["x = " + "[" * 3000, "x = " + "-" * 100000 + "1", "x = " + "1+" * 20000 + "1"])
def test_deep_nesting_is_survived(kind, text):
    assert extract(text.encode(), kind).entry_points == ()
