"""Names that nothing in a Python source binds."""

import sys

import pytest
from rosimpact.impact.facts.python.source import extract


@pytest.mark.parametrize(("source", "expected"), [
    ("import os\nprint(os.name, __file__)", []),
    ("def f():\n    return lost", [("lost", 2, True)]),
    ("lost.there()\ndef f():\n    return lost", [("lost", 1, False)]),
    ("def f():\n    global kept\n    kept = 1\ndef g():\n    return kept", []),
    ("def f():\n    lost = 1\ndef g():\n    return lost", [("lost", 4, True)]),
    ("class C:\n    own = 1\n    def f(self):\n        return own", [("own", 4, True)]),
    ("[one for one in range(3)]\n(lambda two: two)(1)", []),
    ("def f():\n    return [one for one in range(3)] and one", [("one", 2, True)]),
    ("[last := one for one in range(3)]\nprint(last, one)", [("one", 2, False)]),
    ("class C:\n    own = [1]\n    two = [one for one in own]", []),
    ("def f():\n    return later()\nlater = 1", []),
    ("def f():\n    def g():\n        return later\n    later = 1", []),
    ("del lost", []),
    ("from __future__ import annotations\ndef f(x: lost) -> lost: pass", []),
    ("def f(x: lost): pass", [("lost", 1, False)]),
    ("from os import *\nlost", []),
    ("globals()['lost'] = 1\nlost", []),
    ("match 1:\n    case kept:\n        print(kept)", []),
    ("def f(x):\n    match x:\n        case [kept, *rest] | {'a': kept, **rest}:\n            print(kept, rest)", []),
    ("print 1\nlost", []),
    ("try:\n    unicode\nexcept NameError:\n    pass", [("unicode", 2, True)]),
    ("{}.iteritems()", [(".iteritems", 1, False)]),
    ("{}.iteritems", []),
    ("import six\nsix.iteritems({})", []),
    ("class C:\n    def has_key(self): pass\nC().has_key()", []),
])  # fmt: skip
def test_unbound(source, expected):
    assert [(use.text, use.line, use.lazy) for use in extract(source.encode()).unbound] == expected


def test_a_try_that_expects_it_is_a_condition():
    (use,) = extract(b"try:\n    unicode\nexcept NameError:\n    pass").unbound
    assert use.conditions


@pytest.mark.parametrize(("source", "expected"), [
    ("import os.path as p, sys\nA = B = 1\nfor c in (): pass\ndef f(x): y = 1", "A B c f p sys"),
    ("def f():\n    global g\n    g = 1", "f g"),
    ("if 1:\n    with f() as w: {v := x for x in f}\nelse:\n    try: del d\n    except E as e: 1", "d e v w"),
    ("match 1:\n    case {'a': k, **r} | [k, *r]: pass", "k r"),
    ("from os import *", ""),
    ("def __getattr__(name): return name", ""),
    ("import sys\nsys.modules[__name__] = 1", ""),
])  # fmt: skip
def test_bound(source, expected):
    assert extract(source.encode()).bound.split() == expected.split()


@pytest.mark.skipif(sys.version_info < (3, 12), reason="needs Python 3.12")
@pytest.mark.parametrize("source", [
    "def f[T](x: T) -> T: pass", "class C[*Ts, **P]:\n    x: Ts\n    y: P", "type A = int\nA", "type A[T] = list[T]",
])  # fmt: skip
def test_parameters_of_types_are_bound(source):
    assert extract(source.encode()).unbound == ()
