"""What a package offers to Python: which modules it installs, what a dotted name stands for, and what changed."""

import textwrap

import pytest
from rosimpact.databuild.extract import python
from rosimpact.databuild.surface.compare_python import compare, explain_break
from rosimpact.databuild.surface.python import build_surface, find_installed_modules, find_kind
from rosimpact.impact.facts import kinds
from rosimpact.impact.facts.extract import extract_all
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.package import Watched
from rosimpact.impact.model.workspace import link
from rosimpact.impact.targets.surface.python import UNKNOWN, SurfaceNames, write_signature
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>arm</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>{tool}</buildtool_depend>
<export><build_type>{tool}</build_type></export></package>"""
SETUP = "from setuptools import setup\nsetup(name='arm', packages=['arm', 'arm.sub'])\n"
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\n"


@pytest.fixture
def package(tmp_path_factory):
    """Makes a package called arm of files and their texts, and gives it with the facts of its modules."""

    def make(files, tool="ament_python"):
        folder = tmp_path_factory.mktemp("ws")
        for path, text in {"package.xml": MANIFEST.format(tool=tool), **files}.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(textwrap.dedent(text))
        tree = WorkingTree(folder)
        with Store(tmp_path_factory.mktemp("cache")) as store:
            main = extract_all(tree, store, jobs=1)
            workspace = link(tree, main, store, None, Watched(), 1)
            modules = extract_all(tree, store, jobs=1, kind_of=find_kind)
            facts = {path: modules.get_facts(path).facts for path in modules.kinds}
        return workspace.packages["arm"], facts.get

    return make


@pytest.fixture
def surface(package):
    """The surface of a package of these modules, the paths relative to its Python package."""

    def make(files):
        files = {"arm/__init__.py": "", **{f"arm/{path}": text for path, text in files.items()}}
        setup = "from setuptools import setup, find_packages\nsetup(packages=find_packages())\n"
        return build_surface(*package({"setup.py": setup, **files}))

    return make


# -- which modules are installed


@pytest.mark.parametrize(
    ("tool", "files", "modules", "unknown"),
    [
        ("ament_python", {"setup.py": SETUP, "arm/__init__.py": "", "arm/a.py": "", "arm/sub/__init__.py": "",
                          "arm/rest/b.py": "", "test/test_a.py": ""}, ["arm", "arm.a", "arm.sub"], ()),
        ("ament_python", {"setup.py": "setup(packages=find_packages(exclude=['test']))", "arm/__init__.py": "",
                          "arm/sub/__init__.py": "", "arm/no/a.py": "", "test/__init__.py": ""}, ["arm", "arm.sub"],
         ()),
        ("ament_python", {"setup.py": "setup(packages=['arm'], package_dir={'': 'src'}, py_modules=['one'])",
                          "src/arm/__init__.py": "", "src/one.py": ""}, ["arm", "one"], ()),
        ("ament_python", {"setup.py": "setup(packages=['arm'], package_dir={'arm': 'python'})",
                          "python/__init__.py": "", "python/a.py": ""}, ["arm", "arm.a"], ()),
        ("catkin", {"CMakeLists.txt": f"{CMAKE}catkin_python_setup()\ncatkin_package()\n",
                    "setup.py": "d = generate_distutils_setup(packages=['arm'], package_dir={'': 'src'})\nsetup(**d)",
                    "src/arm/__init__.py": "", "src/arm/a.py": ""}, ["arm", "arm.a"], ()),
        ("catkin", {"CMakeLists.txt": f"{CMAKE}catkin_package()\n", "setup.py": SETUP, "arm/__init__.py": ""}, [], ()),
        ("ament_cmake", {"CMakeLists.txt": f"{CMAKE}ament_python_install_package(${{PROJECT_NAME}})\n",
                         "arm/__init__.py": "", "arm/deep/a.py": ""}, ["arm", "arm.deep.a"], ()),
        ("ament_cmake", {"CMakeLists.txt": f"{CMAKE}ament_python_install_package(arm PACKAGE_DIR src/arm)\n",
                         "src/arm/__init__.py": ""}, ["arm"], ()),
        ("ament_cmake", {"CMakeLists.txt": f"{CMAKE}ament_python_install_package(arm)\npybind11_add_module(_core c.cpp)"
                         "\ninstall(TARGETS _core DESTINATION ${PYTHON_INSTALL_DIR}/arm)", "arm/__init__.py": ""},
         ["arm"], ("arm._core",)),
        ("ament_cmake", {"CMakeLists.txt": f'{CMAKE}rosidl_generate_interfaces(arm "msg/A.msg" "srv/B.srv")',
                         "msg/A.msg": "", "srv/B.srv": "---\n"}, [], ("arm.msg", "arm.srv")),
    ],
)  # fmt: skip
def test_installed_modules(package, tool, files, modules, unknown):
    found = find_installed_modules(package(files, tool)[0])
    assert (sorted(found.modules), found.unknown, found.unresolved) == (modules, unknown, ())


def test_what_a_setup_py_computes_is_named(package):
    found = find_installed_modules(package({"setup.py": "setup(packages=names())"})[0])
    assert found.unresolved == ("packages: `names()`",)


# -- what a name stands for

NODE = """
class Base:
    def spin(self): pass
class Node(Base, Outer.Thing):
    class Kind: pass
    def create(self, name, *, depth=10): pass
"""


@pytest.mark.parametrize(
    ("files", "name", "where"),
    [
        ({"node.py": NODE}, "arm.node.Node.create", "arm.node.Node.create"),
        ({"node.py": NODE}, "arm.node.Node.spin", "arm.node.Base.spin"),
        ({"node.py": NODE}, "arm.node.Base.create", None),
        ({"node.py": NODE}, "arm.node.Node.other", "unknown"),
        ({"node.py": NODE}, "arm.node.Other", None),
        ({"node.py": NODE}, "arm.other", None),
        ({"node.py": NODE}, "other", None),
        ({"__init__.py": "from arm.node import Node", "node.py": NODE}, "arm.Node.Kind", "arm.node.Node.Kind"),
        ({"__init__.py": "from .node import Node as N", "node.py": NODE}, "arm.N", "arm.node.Node"),
        ({"__init__.py": "from .a import *", "a.py": "from .node import *", "node.py": NODE}, "arm.Node",
         "arm.node.Node"),
        ({"__init__.py": "from .a import *", "a.py": "__all__ = ['x']\nx = y = 1"}, "arm.y", None),
        ({"__init__.py": "from other import *"}, "arm.y", "unknown"),
        ({"__init__.py": "from other import y"}, "arm.y", "other.y"),
        ({"__init__.py": "def __getattr__(name): pass"}, "arm.y", "unknown"),
        ({"a.py": "def f(:"}, "arm.a.f", "unknown"),
        ({"a.py": "class A(Exception): pass"}, "arm.a.A.args", "Exception.args"),
        ({"a.py": "class A(Exception): pass"}, "arm.a.A.code", None),
        ({"a.py": "class A:\n  def f(self): self.x = 1"}, "arm.a.A.x", "arm.a.A.x"),
        ({"a.py": "from .b import c", "b.py": "from .a import c"}, "arm.a.c", "arm.a.c"),
        ({"a.py": "class A(A): pass"}, "arm.a.A.x", "unknown"),
    ],
)  # fmt: skip
def test_find(surface, files, name, where):
    found = SurfaceNames(surface(files)).find(name)
    assert (found and ("unknown" if found is UNKNOWN else found.where)) == where


def test_generated_and_compiled_modules_are_neither_there_nor_missing(package):
    cmake = f'{CMAKE}rosidl_generate_interfaces(arm "msg/A.msg")'
    names = SurfaceNames(build_surface(*package({"CMakeLists.txt": cmake, "msg/A.msg": ""}, "ament_cmake")))
    assert names.find("arm.msg.A") is UNKNOWN
    assert names.find("arm.srv.A") is None


# -- what changed


def changes(surface, old, new):
    return [
        (c.kind, c.name, *([c.instead] if c.kind == "moved" else []), *([] if c.sure == 1 else ["unsure"]))
        for c in compare(surface(old), surface(new))
        if c.breaks or c.kind not in ("added", "signature")
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ({"a.py": NODE}, {"a.py": NODE}, []),
        ({"a.py": "def f(): pass"}, {"a.py": ""}, [("removed", "arm.a.f")]),
        ({"a.py": "def _f(): pass"}, {"a.py": ""}, []),
        ({"a.py": "import os\nfrom .b import g", "b.py": "def g(): pass"}, {"a.py": "", "b.py": "def g(): pass"}, []),
        # A name that is imported where it was defined is still there.
        ({"a.py": "class A: pass"}, {"a.py": "from .b import A", "b.py": "class A: pass"}, []),
        ({"a.py": "class A:\n  def f(self): pass"}, {"b.py": "class A:\n  def f(self): pass"},
         [("removed", "arm.a"), ("moved", "arm.a.A", "arm.b.A")]),
        ({"a.py": "X = 1\nY = 2"}, {}, [("removed", "arm.a")]),
        ({"a.py": "class A:\n  def f(self): pass"}, {"a.py": "class A: pass"}, [("removed", "arm.a.A.f")]),
        ({"a.py": "class A:\n  def f(self): pass"}, {"a.py": "class B:\n  def f(self): pass\nclass A(B): pass"}, []),
        ({"a.py": "class A:\n  def f(self): pass"}, {"a.py": "from x import B\nclass A(B): pass"}, []),
        ({"a.py": "class A:\n  def __del__(self): pass"}, {"a.py": "class A: pass"}, []),
        ({"__init__.py": "from .a import f", "a.py": "def f(): pass"}, {"a.py": "def f(): pass"},
         [("moved", "arm.f", "arm.a.f")]),
        ({"a.py": "def f(x): pass"}, {"a.py": "def f(y): pass"}, [("signature", "arm.a.f")]),
        ({"a.py": "@magic\ndef f(x): pass"}, {"a.py": "@magic\ndef f(y): pass"}, [("signature", "arm.a.f", "unsure")]),
        ({"a.py": "def f(x=1): pass"}, {"a.py": "def f(x=2): pass"}, [("default", "arm.a.f(x)")]),
        ({"a.py": "def f(x=_b.A): pass"}, {"a.py": "def f(x=A): pass"}, []),
        ({"a.py": "X = 1"}, {"a.py": "X = 2"}, [("default", "arm.a.X")]),
        ({"a.py": "def f(): pass"}, {"a.py": "@deprecated('no')\ndef f(): pass"}, [("deprecated", "arm.a.f")]),
        ({"a.py": "class A:\n  def f(self): pass"}, {"a.py": "class A:\n  @property\n  def f(self): pass"},
         [("kind", "arm.a.A.f")]),
        ({"a.py": "A = make()"}, {"a.py": "class A: pass"}, []),
        ({"a.py": "try:\n  X = 1\nexcept ImportError:\n  pass"}, {"a.py": ""}, [("removed", "arm.a.X", "unsure")]),
        ({"a.py": "def f(): pass"}, {"a.py": "def __getattr__(n): pass"}, []),
        ({"a.py": "def f(): pass"}, {"a.py": "def f(:"}, []),
        ({"a.py": "@dataclass\nclass A:\n  x: int\n  y: int"}, {"a.py": "@dataclass\nclass A:\n  x: int"},
         [("signature", "arm.a.A.__init__"), ("removed", "arm.a.A.y")]),
    ],
)  # fmt: skip
def test_compare(surface, old, new, expected):
    assert changes(surface, old, new) == expected


def test_what_is_new_is_told(surface):
    old, new = surface({"a.py": "class A: pass"}), surface({"a.py": "class A:\n  def f(self): pass\ndef g(x): pass"})
    assert [(c.kind, c.name, c.now or c.instead) for c in compare(old, new)] == [
        ("added", "arm.a.A.f", "()"),
        ("added", "arm.a.g", "(x)"),
    ]


@pytest.fixture
def parameters(surface):
    def of(head):
        found = SurfaceNames(surface({"a.py": f"def f({head}): pass"})).find("arm.a.f")
        return found.bound.parameters

    return of


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("a, b=1", "a, b=1", ""),
        ("a", "a, b=1", ""),
        ("a", "a, *, b=1", ""),
        ("a", "a, *rest, **more", ""),
        ("a, b", "a, **more", "`b` is no longer taken by position"),
        ("a", "a, b", "`b` must be given"),
        ("a", "a, *, b", "`b` must be given"),
        ("a=1", "a", "`a` must be given"),
        ("a, b", "a", "`b` is gone"),
        ("a, b", "b, a", "`b` stands where `a` stood"),
        ("a, b=1", "a, c=2, b=1", "`c` stands where `b` stood"),
        ("a, b=1", "a, *, b=1", "`b` is no longer taken by position"),
        ("*, a, b", "*, b, a", ""),
        ("a, /", "b, /", ""),
        ("*args", "", "`*args` is gone"),
        ("**more", "a=1", "`**more` is gone"),
        ("a, b", "*args, **more", ""),
    ],
)
def test_which_changes_of_parameters_break_calls(parameters, old, new, problem):
    assert explain_break(parameters(old), parameters(new)) == problem


@pytest.mark.parametrize("head", ["a, /, b, *, c=1", "*args, c, **more", "a, /", "a=1, *, b"])
def test_a_signature_is_written_as_python_does(parameters, head):
    assert write_signature(parameters(head)) == f"({head})"


def test_nothing_else_asks_for_these_facts():
    assert python.__name__ not in {kinds.find_kind(path) for path in ("a.py", "b/__init__.py", "scripts/run")}
    assert (find_kind("a.py"), find_kind("setup.py"), find_kind("a.txt")) == (python.__name__, None, None)


def test_modules_that_take_all_names_from_each_other(surface):
    made = surface({"__init__.py": "from .sub import *\n", "sub/__init__.py": "from arm.sub import *\ndef f(): ...\n"})
    assert set(SurfaceNames(made).offered) == {"arm.f", "arm.sub.f"}
