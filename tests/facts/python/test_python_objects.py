"""What Python sources do with things of other packages."""

import textwrap

import pytest
from rosimpact.impact.facts.launch.references import extract as extract_launch
from rosimpact.impact.facts.python.source import extract
from rosimpact.impact.facts.python.uses import CallArguments, PythonUse


def uses(source: str) -> list[PythonUse]:
    return list(extract(textwrap.dedent(source).encode()).uses)


def told(source: str) -> set[tuple[str, str]]:
    return {(use.name, use.how) for use in uses(source)}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        # what imports bring, under any name
        ("import a.b\na.b.f(1)", {("a.b.f", "call")}),
        ("from a.b import f as g\ng(1)", {("a.b.f", "call")}),
        ("from .b import f\nf()", {(".b.f", "call")}),
        # objects that a constructor made
        ("from a import C\nx = C()\nx.m(1)", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\nx = C()\ny = x\ny.field", {("a.C", "call"), ("a.C.field", "member")}),
        ("from a import C\nC().m()", {("a.C", "call"), ("a.C.m", "method")}),
        # not any more once the name is bound to something else
        ("from a import C\nx = C()\nx = 3\nx.m(1)", {("a.C", "call")}),
        ("from a import C\nx = C()\nfor x in y: x.m(1)", {("a.C", "call")}),
        ("from a import C\ndef f(x):\n    x.m()\nx = C()", {("a.C", "call")}),
        # but again once it is bound to such a thing, in a branch and in every turn of a loop
        ("from a import C\nx = f()\nx = C()\nx.m(1)", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\nif y: x = C()\nx.m(1)", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\nx = None\nif y: x = C()\nx.m(1)", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\nif y: x = C()\nelse: x = f()\nx.m(1)", {("a.C", "call")}),
        ("from a import C\nx = C()\nwhile y:\n  x.m(1)\n  x = C()", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\nx = C()\nwhile y:\n  x.m(1)\n  x = f()", {("a.C", "call")}),
        ("from a import C\ndef f(x=None):\n  x = x or 1\n  if not x: x = C()\n  x.m(1)", {("a.C", "call")}),
        ("from a import C\ndef f(x=None):\n  if not x: x = C()\n  x.m(1)", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\ntry:\n  x = C()\nexcept E:\n  x.m(1)", {("a.C", "call")}),
        ("from a import C\nclass D:\n  def f(self):\n    self.x = C()\n    a, self.x = y\n    self.x.m()",
         {("a.C", "call")}),
        # nor when it is imported under a condition
        ("try:\n  from a import C\nexcept ImportError:\n  C = None\nx = C()\nx.m(1)", set()),
        # annotations
        ("from a import C\ndef f(x: C): x.m()", {("a.C.m", "method")}),
        ("from a import C\ndef f(x: 'C'): x.m()", {("a.C.m", "method")}),
        ("from a import C\ndef f(x: list[C]): x.m()", set()),
        ("from a import C\nfrom typing import Optional\ndef f(x: Optional[C]): x.m()", {("a.C.m", "method")}),
        ("from a import C\ndef f(x: 'C | None' = None): x.m()", {("a.C.m", "method")}),
        ("from a import C\nclass D:\n  c: C = None\n  def f(self): self.c.m()", {("a.C.m", "method")}),
        ("from a import C\nclass D:\n  c: C\ndef f(d: D): d.c.m()", {("a.C.m", "method")}),
        # what functions of the file give, and variables that hold nothing at first
        ("from a import C\ndef f() -> C: ...\nf().m()", {("a.C.m", "method")}),
        ("from a import C\ndef f(): return C()\nf().m()", {("a.C", "call"), ("a.C.m", "method")}),
        ("from a import C\ndef f(): yield C()\nf().m()", {("a.C", "call")}),
        ("from a import C\nclass D:\n  def f(self) -> C: ...\n  def g(self): self.f().m()", {("a.C.m", "method")}),
        ("from a import C\nclass D:\n  def f(self):\n    self.c = None\n    self.c = C()\n    self.c.m()",
         {("a.C", "call"), ("a.C.m", "method")}),
        # one star import brings what nothing else binds
        ("from a import *\nf(1)\nprint(2)", {("a.f", "call")}),
        # self and super() of a subclass, also over several steps in the file
        ("from a import C\nclass D(C):\n  def f(self): self.m(1)", {("a.C.f", "override"), ("a.C.m", "method")}),
        ("from a import C\nclass D(C):\n  def _f(self): super()._f(1)", {("a.C._f", "method")}),
        ("from a import C\nclass D(C): pass\nclass E(D):\n  def _f(me): me.x", {("a.C.x", "member")}),
        ("from a import C\nclass D(C):\n  @classmethod\n  def _f(cls): cls.m()", {("a.C.m", "method")}),
        ("from a import C\nclass M:\n  def _f(self): pass\nclass D(M, C):\n  def _f(self): super()._f(1)", set()),
        # a constructor is called by its class, also where that is a subclass which has none itself
        ("from a import C\nclass D(C):\n  def __init__(self): super().__init__(1)", {("a.C", "call")}),
        ("from a import C\nclass D(C): pass\nclass E(D, object): pass\nE(1)", {("a.C", "call")}),
        ("from a import C\nclass D(C):\n  def __init__(self): pass\nD(1)", set()),
        ("from a import C\nclass D(C):\n  def __new__(cls): pass\nclass E(D): pass\nE(1)", set()),
        ("from a import C\n@dataclass\nclass D(C):\n  x: int\nD(1)", set()),
        ("from a import C\nclass D(C):\n  def _f(self): self._g()\n  def _g(self): pass", set()),
        ("from a import C\nclass D(C):\n  def _f(self):\n    self.x = 1\n    self.x.y", set()),
        ("from a import C\nclass D(C):\n  @staticmethod\n  def _f(self): self.m()", set()),
        # what self holds
        (
            "from a import C\nclass D:\n  def f(self): self.c = C()\n  def g(self): self.c.m(2)",
            {("a.C", "call"), ("a.C.m", "method")},
        ),
        # setting a member is no use of one
        ("from a import C\nx = C()\nx.y = 1", {("a.C", "call")}),
        (
            "import threading\nclass D(threading.Thread):\n  def f(self): self.start()",
            {("threading.Thread.start", "method"), ("threading.Thread.f", "override")},
        ),
    ],
)
def test_uses_are_told_by_what_names_are_bound_to(source, expected):
    assert told(source) == expected


def test_members_of_what_shows_no_type_are_counted():
    facts = extract(b"import a\ndef f(x):\n    x.m()\n    x.m\n    a.f\n    ''.join(x)\n    g(x)[0].n\n    x.o = 1\n")
    assert facts.unknown == {"m": 2, "n": 1}


def test_arguments_of_a_call():
    found = [use.given for use in uses("from a import f\nf(1, 2, k=3)\nf(*x)\nf(1, **y)")]
    assert found == [CallArguments(2, ("k",)), CallArguments(0, (), True), CallArguments(1, (), True)]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("f(1, **{'k': 1, 'l': 2}, m=3)", CallArguments(1, ("k", "l", "m"))),
        ("o = {'k': 1}\nf(**o)", CallArguments(0, ("k",))),
        ("o = dict(k=1)\ndef g(): f(**o, l=2)", CallArguments(0, ("k", "l"))),
        ("def g():\n  o = {}\ndef h():\n  o = {'k': 1}\n  f(**o)", CallArguments(0, ("k",))),
        # what is not all known, or may be another mapping, or have been changed
        ("o = {'k': 1, x: 2}\nf(**o)", CallArguments(0, ("k",), True)),
        ("f(**{'k': 1, **x})", CallArguments(0, ("k",), True)),
        ("o = dict(x, k=1)\nf(**o)", CallArguments(0, (), True)),
        ("o = {'k': 1}\no['l'] = 2\nf(**o)", CallArguments(0, (), True)),
        ("o = {'k': 1}\nprint(o)\nf(**o)", CallArguments(0, (), True)),
        ("o = {'k': 1}\ndef g(o): f(**o)", CallArguments(0, (), True)),
        ("if x:\n  o = {'k': 1}\nelse:\n  o = {}\nf(**o)", CallArguments(0, (), True)),
    ],
)
def test_arguments_that_a_mapping_gives(source, expected):
    found = [use.given for use in uses(f"from a import f\n{source}") if use.name == "a.f"]
    assert found == [expected]


@pytest.mark.parametrize(
    ("parameters", "shown"),
    [
        ("self", "()"),
        ("self, a, b=1", "(a, b=...)"),
        ("self, a, /, b", "(a, /, b)"),
        ("self, *args, k, l=2, **more", "(*args, k, l=..., **more)"),
        ("self, *, k", "(*, k)"),
    ],
)
def test_parameters_of_an_override(parameters, shown):
    (use,) = uses(f"from a import C\nclass D(C):\n    def f({parameters}): pass")
    assert (use.name, use.how, use.parameters) == ("a.C.f", "override", shown)


def test_only_what_surely_runs_is_not_lazy():
    found = uses(
        """
        from a import f, g, h, i, j
        f()
        def main():
            g()
            if x:
                h()
        def other():
            i()
        if __name__ == '__main__':
            j()
        """
    )
    assert {use.name[-1]: use.lazy for use in found} == {"f": False, "g": False, "h": True, "i": True, "j": False}


def test_an_attribute_is_lazy_when_every_use_of_it_is():
    facts = extract(b"import a\ndef f():\n    a.x\n    a.y\na.x\n")
    assert {attribute.text: attribute.lazy for attribute in facts.attributes} == {"a.x": False, "a.y": True}


def test_a_second_base_class_leaves_it_open_whose_member_it_is():
    found = uses("from a import C, E\nclass D(C, E):\n    def _f(self): self.m()")
    assert {(use.name, use.alone) for use in found} == {("a.C.m", False), ("a.E.m", False)}
    found = uses("from a import C, E\nclass D(C, E):\n    def __init__(self): super().__init__(1)")
    assert {(use.name, use.alone) for use in found} == {("a.C", False), ("a.E", False)}


def test_what_stands_under_a_try_says_so():
    (use,) = uses("import a\ntry:\n    a.f()\nexcept AttributeError:\n    pass")
    assert [condition.text for condition in use.conditions] == ["try"]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("", ()),
        (", launch_arguments={'x': '1', 'y': z}.items()", ("x", "y")),
        (", launch_arguments=dict(x='1').items()", ("x",)),
        (", launch_arguments=[('x', '1')]", ("x",)),
        (", launch_arguments={**more}.items()", None),
        (", launch_arguments=more", None),
    ],
)
def test_arguments_that_an_include_gives(given, expected):
    source = f"""
from launch.actions import IncludeLaunchDescription
IncludeLaunchDescription([FindPackageShare('p'), '/launch/a.launch.py']{given})
"""
    (reference,) = extract(source.encode()).references
    assert (reference.kind, reference.name, reference.arguments) == ("file", "launch/a.launch.py", expected)


@pytest.mark.parametrize(
    ("attributes", "inside", "expected"),
    [
        ("", '<arg name="x" value="1"/>', ("x",)),
        ("", '<let name="x" value="1"/>', ("x",)),
        ("", '<arg name="$(var x)" value="1"/>', None),
        ('pass_all_args="true"', "", None),
    ],
)
def test_arguments_that_an_include_in_xml_gives(attributes, inside, expected):
    source = f'<launch><include file="$(find p)/launch/a.launch" {attributes}>{inside}</include></launch>'
    (reference,) = extract_launch(source.encode(), "launch_xml").references
    assert reference.arguments == expected


def test_an_except_for_type_errors_guards_calls_alone():
    found = uses(
        """
        from a import C
        c = C()
        try:
            c.f(1)
            c.x
        except TypeError:
            c.g(2)
        """
    )
    shown = {use.name: [(c.text, c.negated) for c in use.conditions] for use in found}
    assert shown == {"a.C": [], "a.C.f": [("try", False)], "a.C.x": [], "a.C.g": [("try", True)]}
