"""What a Python module offers: names, parameters, deprecations, and what cannot be told."""

import textwrap

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.databuild.extract.python import extract
from rosimpact.impact.facts.python.surface import ModuleSurface


def surface(text):
    return extract(textwrap.dedent(text).encode())


def names(text):
    return [(bound.name, bound.kind) for bound in surface(text).names]


def shown(parameter):
    star = {"args": "*", "kwargs": "**"}.get(parameter.kind, "")
    mark = {"positional": " /", "keyword": " *"}.get(parameter.kind, "")
    return f"{star}{parameter.name}{'' if parameter.default is None else '=' + parameter.default}{mark}"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("def f(): pass", [("f", "function")]),
        ("async def f(): pass", [("f", "function")]),
        ("class A:\n  def m(self): pass", [("A", "class"), ("A.m", "method")]),
        ("class A:\n  @property\n  def p(self): pass\n  @p.setter\n  def p(self, v): pass",
         [("A", "class"), ("A.p", "property")]),
        ("class A:\n  @functools.cached_property\n  def p(self): pass", [("A", "class"), ("A.p", "property")]),
        ("class A:\n  @staticmethod\n  def s(): pass\n  @classmethod\n  def c(cls): pass",
         [("A", "class"), ("A.s", "staticmethod"), ("A.c", "classmethod")]),
        ("class A:\n  B = 1\n  c: int\n  class D: pass",
         [("A", "class"), ("A.B", "attribute"), ("A.c", "attribute"), ("A.D", "class")]),
        ("class A:\n  def m(self):\n    self.x = 1\n    if a:\n      self.y, self._z = b\n    other.q = 1",
         [("A", "class"), ("A.m", "method"), ("A.x", "instance"), ("A.y", "instance"), ("A._z", "instance")]),
        ("A = B = 1\nx, (y, *z) = f()", [("A", "attribute"), ("B", "attribute"), ("x", "attribute"),
                                         ("y", "attribute"), ("z", "attribute")]),
        ("x: int", []),
        ("x: int = 1", [("x", "attribute")]),
        ("for i in a:\n  j = 1", [("i", "attribute"), ("j", "attribute")]),
        ("with a as b:\n  c = 1", [("b", "attribute"), ("c", "attribute")]),
        ("a = 1\ndef f(): pass\ndel a, f", []),
        ("if __name__ == '__main__':\n  a = 1", []),
        ("class A: pass\nA.b = 1", [("A", "class"), ("A.b", "attribute")]),
        ("def f():\n  global state\n  state = 1\n  other = 2", [("f", "function"), ("state", "attribute")]),
        ("def f():\n  global os, low\n  import os.path\n  from x import high as low, other",
         [("f", "function"), ("os", "attribute"), ("low", "attribute")]),
        ("def f():\n  global a, b, C, d\n  for a in x: pass\n  with x as (b, c): pass\n  class C: ...\n  def d(): ...",
         [("f", "function"), *((name, "attribute") for name in "abCd")]),
        ("globals()['a'] = 1", [("a", "attribute")]),
        ("@make\nclass __getattr__:\n  late = warn(3)\n  @property\n  def soon(self): ...",
         [("__getattr__", "class"), ("__getattr__.late", "attribute"), ("__getattr__.soon", "property"),
          ("late", "attribute"), ("soon", "attribute")]),
    ],
)  # fmt: skip
def test_names_that_are_bound(text, expected):
    assert names(text) == expected


@pytest.mark.parametrize(
    ("head", "expected"),
    [
        ("a, b=1", ["a", "b=1"]),
        ("a, /, b, *, c, d=2", ["a /", "b", "c *", "d=2 *"]),
        ("*args, **kwargs", ["*args", "**kwargs"]),
        ("a='x', b=\"x\", c=A.B, d=[ 1,2 ]", ["a='x'", "b='x'", "c=A.B", "d=[1, 2]"]),
    ],
)
def test_parameters_of_a_function(head, expected):
    (bound,) = surface(f"def f({head}): pass").names
    assert [shown(p) for p in bound.parameters] == expected


def test_annotations_are_kept_as_written():
    (bound,) = surface("def f(a: 'Optional[int]' = None, *b: str) -> List[ int ]: pass").names
    assert [p.annotation for p in bound.parameters] == ["'Optional[int]'", "str"]
    assert bound.annotation == "List[int]"


def test_self_and_cls_are_left_out_and_the_argument_of_a_static_method_is_not():
    _, *methods = surface(
        """
        class A:
            def m(self, a): pass
            @classmethod
            def c(cls, a): pass
            @staticmethod
            def s(a): pass
            def __new__(cls, a): pass
            def odd(*args): pass
        """
    ).names
    assert [[shown(p) for p in m.parameters] for m in methods] == [["a"], ["a"], ["a"], ["a"], ["*args"]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("@deprecated('use g')\ndef f(): pass", "use g"),
        ("@warnings.deprecated('use g', category=None)\ndef f(): pass", "use g"),
        ("@deprecated\ndef f(): pass", "deprecated"),
        ("def f():\n  '''doc'''\n  import warnings\n  warnings.warn('use g', DeprecationWarning)", "use g"),
        ("def f():\n  warn(f'use {g} now', category=FutureWarning)", "use now"),
        ("def f():\n  warnings.warn('slow', RuntimeWarning)", ""),
        ("def f(a):\n  if a:\n    warnings.warn('use g', DeprecationWarning)", ""),
        ("def f():\n  a()\n  b()\n  c()\n  d()\n  warnings.warn('use g', DeprecationWarning)", ""),
        ("class f:\n  def __init__(self):\n    warnings.warn('use g', DeprecationWarning)", "use g"),
    ],
)
def test_deprecations(text, message):
    assert surface(text).names[0].deprecated == message


def test_a_module_that_warns_is_deprecated_as_a_whole():
    assert surface("import warnings\nwarnings.warn('moved to b', DeprecationWarning)").deprecated == "moved to b"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import a.b, c as d", [("a", "a.b", 0, ""), ("d", "c", 0, "")]),
        ("from .a import b as c, d", [("c", "a", 1, "b"), ("d", "a", 1, "d")]),
        ("from . import a", [("a", "", 1, "a")]),
        ("from a import *", [("*", "a", 0, "*")]),
    ],
)
def test_imports(text, expected):
    assert [(t.name, t.module, t.level, t.original) for t in surface(text).imports] == expected


@pytest.mark.parametrize(
    ("text", "conditions"),
    [
        ("try:\n  def x(): pass\nexcept ImportError:\n  pass", ["try"]),
        ("try:\n  x = 1\nexcept ValueError:\n  pass", []),
        ("try:\n  pass\nexcept ImportError:\n  x = None", ["not try"]),
        ("if sys.version_info >= (3, 8):\n  x = 1", ["sys.version_info >= (3, 8)"]),
        ("if A:\n  pass\nelse:\n  x = 1", ["not A"]),
        ("with suppress(ImportError):\n  x = 1", ["try"]),
    ],
)
def test_conditions(text, conditions):
    (bound,) = surface(text).names
    assert [("not " if c.negated else "") + c.text for c in bound.conditions] == conditions


@pytest.mark.parametrize(
    ("text", "everything", "more"),
    [
        ("", None, False),
        ("__all__ = ['a', 'b']", ("a", "b"), False),
        ("__all__ = ['a']\n__all__ += ['b']\n__all__.extend(('c',))\n__all__.append('d')", ("a", "b", "c", "d"), False),
        ("__all__ = ['a'] + sub.__all__", ("a", "+sub"), False),
        ("__all__ = [n for n in dir()]", (), True),
        ("__all__ = ['a']\n__all__.remove('a')", (), False),
    ],
)
def test_all(text, everything, more):
    found = surface(text)
    assert (found.all, found.all_open) == (everything, more)


SERVES = [
    ("if name == 'a':\n    return 1", {"a": ""}),
    (
        "if name in ('a', 'b'):\n    warnings.warn('x', DeprecationWarning)\n    return load(name)",
        {"a": "deprecated", "b": "deprecated"},
    ),
    ("if name not in OLD:\n    raise AttributeError(name)\nreturn OLD[name]", {"c": "", "d": ""}),
    ("try:\n    made, why = MADE[name]\nexcept KeyError:\n    pass\nelse:\n    return made", {"e": "", "f": ""}),
    ("try:\n    return globals()[name]\nexcept KeyError:\n    pass", {}),
    ("if name in OLD:\n    return importlib.import_module(f'arm.{name}')", {}),
    ("if name in OLD:\n    raise AttributeError(OLD[name])", {}),
    ("if name in elsewhere.NAMES:\n    return 1", None),
    ("if name in TAKEN:\n    return 1", None),
    ("if name in GROWN:\n    return 1", None),
    ("return load(name)", None),
    ("for one in OLD:\n    return 1", None),
]


@pytest.mark.parametrize(("body", "served"), SERVES)
def test_what_a_module_getattr_serves(body, served):
    text = (
        "from elsewhere import TAKEN\nOLD = {'c': 1}\nOLD['d'] = 2\nGROWN = []\nGROWN.append(n)\n"
        "PAIRS = [('e', 1), ('f', 2)]\nMADE = {}\nMADE.update({n: (a, n) for n, a in PAIRS})\n"
        f"def __getattr__(name):\n{textwrap.indent(body, '    ')}\n    raise AttributeError(name)\n"
    )
    found = surface(text)
    names = {one.name: one.deprecated for one in found.names if one.name in "abcdef"}
    assert (None if found.open else names) == served


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("def __getattr__(name): pass", [("", "__getattr__")]),
        ("__getattr__, *rest = serve(x)", [("", "__getattr__")]),
        ("from x import serve as __getattr__", [("", "__getattr__")]),
        (
            "@make\nclass __getattr__:\n  locals().update(x)",
            [("__getattr__", "locals().update()"), ("", "__getattr__")],
        ),
        ("@make\nclass __getattr__:\n  late = warn(lambda self: 1)", []),
        ("class A:\n  def __getattr__(self, n): pass", [("A", "__getattr__")]),
        ("globals().update(x)", [("", "globals().update()")]),
        ("globals()[n] = 1", [("", "globals()[...]")]),
        ("sys.modules[__name__] = X()", [("", "sys.modules[...]")]),
        ("class A: pass\nfor n in x:\n  setattr(A, n, 1)", [("A", "setattr()")]),
        ("class A:\n  def f(self):\n    setattr(self, n, 1)", [("A", "setattr()")]),
        ("class A:\n  def f(self, o):\n    setattr(o, n, 1)", []),
        ("class A: pass\ndef f():\n  setattr(A, n, 1)", [("A", "setattr()")]),
        ("class A:\n  def f(self):\n    self.__dict__.update(x)", [("A", "__dict__.update()")]),
        ("class A(metaclass=Meta): pass", [("A", "metaclass Meta")]),
        ("class A(metaclass=abc.ABCMeta): pass", []),
        ("def f():\n  here = sys.modules[__package__]\n  setattr(here, n, 1)", [("", "setattr()")]),
        ("exec(code)", [("", "exec()")]),
        ("def f():\n  exec(code)", []),
    ],
)
def test_what_may_have_more_names_than_are_written(text, expected):
    assert list(surface(text).open) == expected


def test_private_names_are_told():
    found = {
        bound.name: bound.private for bound in surface("class _A:\n  x = 1\nclass B:\n  def __init__(s): pass").names
    }
    assert found == {"_A": True, "_A.x": True, "B": False, "B.__init__": False}


def test_python_2_is_read():
    found = surface("class A:\n    def f(self, a):\n        print 'x'\n        raise E, 'x'\n")
    assert found.parsed
    assert [bound.name for bound in found.names] == ["A", "A.f"]


def test_what_does_not_parse_offers_nothing_that_is_known():
    found = surface("def f(:\n")
    assert (found.names, found.parsed) == ((), False)
    assert found.problems


PIECES = st.sampled_from(
    [
         "class ", "def ", "f", "A", "(self)", "(a, /, b=1, *, c)", ":\n  ", "\n", "  ", "pass", "@property\n",
         "@deprecated('x')\n", "import ", "from . ", "*", "x = ", "1", "__all__", "[", "]", "'é'", "global x",
         "self.x", "del ", "try:\n  ", "except ImportError:\n  ", "if a:\n  ", "setattr(", ")", ",", "lambda: ",
         "warn(",
    ]
)  # fmt: skip


@given(st.lists(PIECES, max_size=30).map("".join) | st.text(max_size=60))
def test_any_text_gives_facts_that_survive_the_store(text):
    found = extract(text.encode("utf-8", "replace"))
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(found), type=ModuleSurface) == found
    assert all(1 <= bound.line <= text.count("\n") + text.count("\r") + 1 for bound in found.names)


@given(st.binary(max_size=200))
def test_any_bytes_are_read(data):
    assert isinstance(extract(data), ModuleSurface)
