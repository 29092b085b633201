"""Facts of message flow in Python: calls, what they are given and kept in, their guards, uses of variables."""

import ast
import contextlib
import itertools
import sys
import textwrap
import time

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.flow import FlowFile
from rosimpact.impact.facts.python.flow import extract


def facts(text):
    return extract(textwrap.dedent(text).encode())


def function(found, name):
    (only,) = [f for f in found.functions if f.name == name]
    return only


def shown(expr):
    """An expression as one line: `kind text(parts)`, the common kinds shorter."""
    if expr is None:
        return None
    if expr.kind in ("name", "number"):
        return expr.text
    if expr.kind == "text":
        return repr(expr.text)
    if expr.kind == "other":
        return f"<{expr.text}>"
    inside = ", ".join(shown(part) for part in expr.parts)
    return f"{expr.kind} {expr.text}({inside})" if expr.text else f"{expr.kind}({inside})"


def guards_of(function, place):
    chain = []
    while place >= 0:
        guard = function.guards[place]
        chain.append(f"{guard.kind} {guard.text}")
        place = guard.outer
    return chain[::-1]


def guards(text, callee="p"):
    """The guards around the only call of `p` in the body of a function."""
    found = facts("def f():\n" + textwrap.indent(textwrap.dedent(text).strip("\n"), "    "))
    assert not found.problems
    body = function(found, "f")
    (call,) = [call for call in body.calls if call.callee == callee]
    return guards_of(body, call.guard)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("p()", []),
        ("if a: p()", ["if a"]),
        ("if a: x()\nelse: p()", ["unless a"]),
        ("if a: x()\nelif b: p()", ["unless a", "if b"]),
        ("if a: x()\nelif b: y()\nelse: p()", ["unless a", "unless b"]),
        ("if (a and\n    b):  # why\n    p()", ["if a and b"]),
        ("if (a and  # why\n    b):\n    p()", ["if a and b"]),
        ("if a  ==   'x#y': p()", ["if a == 'x#y'"]),
        ("while a: p()", ["while a"]),
        ("while True:\n    if a: break\n    p()", ["while True", "unless a"]),
        ("for x, y in  z: p()", ["for x, y in z"]),
        ("with a as b, c(): p()", ["with a as b, c()"]),
        ("async with a: p()", ["with a"]),
        ("try: p()\nexcept E: x()", []),
        ("try: x()\nexcept E as e: p()", ["catch E"]),
        ("try: x()\nexcept (E, F): p()", ["catch (E, F)"]),
        ("try: x()\nexcept: p()", ["catch BaseException"]),
        ("try: x()\nexcept E: y()\nelse: p()", ["unless except E"]),
        ("try: x()\nfinally: p()", []),
        ("a and p()", ["if a"]),
        ("a and b and p()", ["if a", "if b"]),
        ("a or p()", ["unless a"]),
        ("x = p() if a else b", ["if a"]),
        ("x = b if a else p()", ["unless a"]),
        ("if not a or p(): x()", ["unless not a"]),
        ("[p() for x in y if x]", ["for x in y", "if x"]),
        ("x = {a: p() for a in b}", ["for a in b"]),
        ("any(p() for x in y)", ["for x in y"]),
        ("x = [q for q in p()]", []),
        ("assert a, 'm'\np()", ["if a"]),
        ("match a:\n  case 1: p()", ["case a == 1"]),
        ("match a:\n  case 1 | B.c: p()", ["case a == 1 or B.c"]),
        ("match a:\n  case 1: x()\n  case 2 | 3: y()\n  case _: p()", ["case a other than 1, 2, 3"]),
        ("match a:\n  case 1 if b: p()", ["case a == 1", "if b"]),
        ("match a:\n  case 1 if b: x()\n  case _: p()", ["unless a == 1 and b"]),
        ("match a:\n  case 1 if b: x()\n  case 2: p()", ["case a == 2"]),
        ("match a, b:\n  case (1, x): p()", ["case (a, b) == (1, x)"]),
        ("match a:\n  case C(x=1) as c: p()", ["case a == C(x=1)"]),
        ("match a.b:\n  case x: p()", []),
    ],
)  # fmt: skip
def test_guards(text, expected):
    assert guards(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("if a: return\np()", ["unless a"]),
        ("if a: return\nif b: return\np()", ["unless a", "unless b"]),
        ("if not a: raise E\np()", ["unless not a"]),
        ("if a: sys.exit(1)\np()", ["unless a"]),
        ("if a: x()\np()", []),
        ("if a: return\nelif b: return\np()", ["unless a", "unless b"]),
        ("if a: x()\nelse: return\np()", ["if a"]),
        ("if a: x()\nelif b: y()\nelse: return\np()", ["if a or b"]),
        ("if a: return\nelif b: y()\nelse: return\np()", ["unless a", "if b"]),
        ("if a: x()\nelif b: return\np()", ["unless not a and b"]),
        ("if not a: x()\nelif b: return\np()", ["unless a and b"]),
        ("if a == 1: x()\nelif b or c: return\np()", ["unless not (a == 1) and (b or c)"]),
        ("if a: return\nelif b: y()\nelif c: return\np()", ["unless a", "unless not b and c"]),
        ("if a:\n    if b: return\n    x()\np()", ["unless a and b"]),
        ("if a:\n    if not b: return\n    x()\np()", ["unless a and not b"]),
        ("if a or b:\n    if c: return\np()", ["unless (a or b) and c"]),
        ("if a and b:\n    if c: return\np()", ["unless a and b and c"]),
        ("if a if b else c:\n    if d: return\np()", ["unless (a if b else c) and d"]),
        ("if a:\n    assert b\np()", ["unless a and not (b)"]),
        ("if a:\n    if b: return\n    else: raise E\np()", ["unless a"]),
        ("if a:\n    with b: return\np()", ["unless a"]),
        ("with b:\n    if a: return\np()", ["unless a"]),
        ("for x in y:\n    if x: continue\n    p()", ["for x in y", "unless x"]),
        ("for x in y:\n    if x: continue\np()", []),
        ("for x in y:\n    if x: return\np()", []),
        ("for x in y:\n    if a:\n        if b: break\n    p()", ["for x in y", "unless a and b"]),
        ("for x in y:\n    if x: break\nelse:\n    p()", ["unless break"]),
        ("for x in y:\n    if x: break\nelse:\n    return\np()", ["if break"]),
        ("for x in y: x()\nelse: p()", []),
        ("while a: x()\nelse: p()", ["unless a"]),
        ("if a:\n    while True: x()\np()", ["unless a"]),
        ("if a:\n    while True:\n        if b: break\np()", []),
        ("try: x()\nexcept E: return\np()", ["unless except E"]),
        ("try: x()\nexcept E: return\nexcept F: y()\np()", ["unless except E"]),
        ("try: return x()\nexcept E: y()\np()", ["catch E"]),
        ("try: return x()\nexcept E: return\np()", ["never after try"]),
        ("if a:\n    try: return x()\n    except E: raise\np()", ["unless a"]),
        ("try:\n    if a: return\nfinally: x()\np()", ["unless a"]),
        ("try:\n    if a: return\nexcept E: x()\np()", []),
        ("try:\n    if a: return\nfinally: p()", []),
        ("try:\n    if a: return\nexcept E: x()\nelse: p()", ["unless a", "unless except E"]),
        ("match a:\n  case 1: return\np()", ["case a other than 1"]),
        ("match a:\n  case 1 | 2: x()\n  case _: return\np()", ["case a == 1 or 2"]),
        ("match a:\n  case 1 if b: return\np()", ["unless a == 1 and b"]),
        ("if a:\n    return\n    x()\np()", ["unless a"]),
        ("if a:\n    def g(): return\np()", []),
        # behind what always jumps
        ("return\np()", ["never after return"]),
        ("raise E\nif a: p()", ["never after raise", "if a"]),
        ("sys.exit()\np()", ["never after exit"]),
        ("if a: return\nelse: return\np()", ["never after if"]),
        ("if a: return\nreturn\np()", ["unless a", "never after return"]),
        ("for x in y:\n    continue\n    p()", ["for x in y", "never after continue"]),
        ("for x in y:\n    break\np()", []),
        ("while True:\n    x()\np()", ["never after while"]),
        ("with b: return\np()", ["never after with"]),
        ("with suppress(E): return\np()", []),
        ("if a:\n    with contextlib.suppress(E): return\np()", []),
        ("try: return\nfinally: p()", []),
    ],
)  # fmt: skip
def test_what_follows_a_jump(text, expected):
    assert guards(text) == expected


def test_lines_of_guards_are_those_of_the_statements_that_ask():
    body = function(facts("def f():\n\n    if (\n        a): return\n    elif b: x()\n    p()\n"), "f")
    assert [(g.kind, g.text, g.line) for g in body.guards] == [
        ("if", "a", 3),
        ("unless", "a", 3),
        ("if", "b", 5),
        ("unless", "a", 3),
    ]


@pytest.mark.skipif(sys.version_info < (3, 11), reason="except* is newer")
def test_groups_of_exceptions():
    assert guards("try: x()\nexcept* E: p()") == ["catch E"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("'a' 'b'", "'ab'"),
        ("b'a'", "<b'a'>"),
        ("0x10", "0x10"),
        ("-1.5", "-1.5"),
        ("None", "None"),
        ("True", "True"),
        ("a.b.c", "a.b.c"),
        ("a().b", "a().b"),
        ("a[0].b", "a.[].b"),
        ("(a or b).c", "().c"),
        ("a[i]", "index(a, i)"),
        ("a['k'][1]", "index(index(a, 'k'), 1)"),
        ("a[1:]", "index(a, <1:>)"),
        ("f(x, 1)", "call f(x, 1)"),
        ("a.f(x)(y)", "call a.f()(y)"),
        ("m.String(data='x')", "make m.String(keyword data('x'))"),
        ("QoS(1)", "make QoS(1)"),
        ("rospy.get_param('~a', 'b')", "call rospy.get_param('~a', 'b')"),
        ("f(*a, **b)", "call f(keyword *(a), keyword **(b))"),
        ("a + '/b' + c", "join +(a, '/b', c)"),
        ("base / 'b' / c", "join /(base, 'b', c)"),
        ("a / 2", "<a / 2>"),
        ("a * 2", "<a * 2>"),
        ("'%s/x_%d' % (a, b)", "join(a, '/x_', b)"),
        ("'%(n)s/x%%' % {'n': a}", "join(a, '/x%')"),
        ("'%s' % a", "join(a)"),
        ("'x%%' % ()", "'x%'"),
        ("'%s %s' % a", "<'%s %s' % a>"),
        ("'%*d' % a", "<'%*d' % a>"),
        ("a % 3", "<a % 3>"),
        ("f'{a}/b{c.d:>3}'", "join(a, '/b', call format(c.d, '>3'))"),
        ("f'x'", "'x'"),
        ("f''", "''"),
        ("'{}/{n}{}'.format(a, b, n=c)", "join(a, '/', c, b)"),
        ("'{1}{0.x}'.format(a, b)", "join(b, <0.x>)"),
        ("'{'.format(a)", "<'{'.format(a)>"),
        ("'{}'.format(*a)", "<'{}'.format(*a)>"),
        ("a if b > 1 else c", "choice(<b > 1>, a, c)"),
        ("a or 'x'", "choice(<a>, a, 'x')"),
        ("a and b", "choice(<a>, b, a)"),
        ("lambda m: f(m)", "lambda lambda@1:5()"),
        ("partial(f, 1, k=2)", "bind(f, 1, keyword k(2))"),
        ("functools.partial(f)", "bind(f)"),
        ("[1, (a, 'b')]", "list(1, list(a, 'b'))"),
        ("{'a': f, **b}", "list(list('a', f), keyword **(b))"),
        ("{1}", "list(1)"),
        ("a == b", "<a == b>"),
        ("not a", "<not a>"),
        ("(y := f())", "call f()"),
        ("...", "<...>"),
        ("'\\ud800'", "'?'"),
    ],
)  # fmt: skip
def test_values(text, expected):
    found = facts("x = " + text)
    (value,) = [shown(each.value) for each in found.functions[0].assignments if each.target == "x"]
    assert value == expected


def test_awaited_values():
    body = function(facts("async def f():\n    x = await g()\n    return await h()"), "f")
    assert [(call.callee, call.target, call.returned) for call in body.calls] == [("g", "x", False), ("h", "", True)]


NODE = """
import rospy
from std_msgs.msg import String as S
from . import helpers
from ..a.b import *
import x.y, z as w

class Talker(Base, mixins.M):
    RATE = 10
    out: Publisher

    class Inner:
        def g(self): self.h = 1

    def __init__(self, name: 'str' = 'n', *rest, flag=True, **more) -> None:
        super().__init__('talker')
        self.pub = None
        self.pub = rospy.Publisher('a', S)
        self.timer: Timer = self.create_timer(1.0, self.tick)
        self.by_name['x'] = rospy.Publisher('b', S)
        self.all.append(rospy.Publisher('c', S))
        self.some = [rospy.Publisher(t, S) for t in ('d', 'e')]
        self.one, self.two = rospy.Publisher('f', S), self.create_publisher(S, 'g', 1)
        rospy.Subscriber('h', S, callback=lambda m: self.tick(m))
        rospy.Subscriber('i', S, helper)
        rospy.Subscriber('j', S, self.value)

    @property
    def value(self): return self.pub

    @staticmethod
    def make(a, b): pass

    @classmethod
    def other(cls, a): cls.pub.publish(a)

    @node.on('x', 1)
    def tick(this, event):
        def inner(m):
            this.pub.publish(m)
        this.all[0].publish(event)
        return inner

def helper(msg): pass
"""


def test_classes():
    talker, inner = facts(NODE).classes
    assert (talker.name, talker.bases, inner.name, inner.bases) == ("Talker", ("Base", "mixins.M"), "Talker.Inner", ())
    assert [(m.name, m.type, m.line, shown(m.value)) for m in talker.members] == [
        ("RATE", "", 9, "10"),
        ("out", "Publisher", 10, None),
        ("pub", "rospy.Publisher", 18, "make rospy.Publisher('a', S)"),
        ("timer", "Timer", 19, "call this.create_timer(1.0, function this.tick())"),
        ("some", "", 22, "<[rospy.Publisher(t, S) for t in ('d', 'e')]>"),
        ("one", "rospy.Publisher", 23, "make rospy.Publisher('f', S)"),
        ("two", "", 23, "call this.create_publisher(S, 'g', 1)"),
    ]
    assert [member.name for member in inner.members] == ["h"]


def test_functions():
    found = facts(NODE)
    assert [(f.name, f.owner, f.line, f.end) for f in found.functions] == [
        ("", "", 1, 45),
        ("Talker", "Talker", 8, 42),
        ("Talker.Inner.g", "Talker.Inner", 13, 13),
        ("Talker.__init__", "Talker", 15, 26),
        ("Talker.__init__.lambda@24:43", "Talker", 24, 24),
        ("Talker.value", "Talker", 29, 29),
        ("Talker.make", "Talker", 32, 32),
        ("Talker.other", "Talker", 35, 35),
        ("Talker.tick", "Talker", 38, 42),
        ("Talker.tick.inner", "Talker", 39, 40),
        ("helper", "", 44, 44),
    ]
    init = function(found, "Talker.__init__")
    assert [(p.name, p.type, shown(p.default)) for p in init.parameters] == [
        ("name", "str", "'n'"),
        ("*rest", "", None),
        ("flag", "", "True"),
        ("**more", "", None),
    ]
    assert init.returns == "None"
    assert [p.name for p in function(found, "Talker.make").parameters] == ["a", "b"]
    assert [p.name for p in function(found, "Talker.other").parameters] == ["a"]


def test_calls_with_what_they_are_kept_in():
    found = facts(NODE)
    calls = [
        (call.callee, shown(call.arguments[0]) if call.arguments else "", call.target)
        for f in found.functions
        for call in f.calls
    ]
    assert calls == [
        ("node.on", "'x'", ""),
        ("super().__init__", "'talker'", ""),
        ("rospy.Publisher", "'a'", "this.pub"),
        ("this.create_timer", "1.0", "this.timer"),
        ("rospy.Publisher", "'b'", "this.by_name.[]"),
        ("rospy.Publisher", "'c'", "this.all.[]"),
        ("this.all.append", "make rospy.Publisher('c', S)", ""),
        ("rospy.Publisher", "t", "this.some.[]"),
        ("rospy.Publisher", "'f'", "this.one"),
        ("this.create_publisher", "S", "this.two"),
        ("rospy.Subscriber", "'h'", ""),
        ("rospy.Subscriber", "'i'", ""),
        ("rospy.Subscriber", "'j'", ""),
        ("this.tick", "m", ""),
        ("this.pub.publish", "a", ""),
        ("this.all.[].publish", "event", ""),
        ("this.pub.publish", "m", ""),
    ]
    init = function(found, "Talker.__init__")
    assert [shown(c.arguments[2]) for c in init.calls if c.callee == "rospy.Subscriber"] == [
        "keyword callback(lambda Talker.__init__.lambda@24:43())",
        "function helper()",
        "this.value",
    ]
    assert [(c.line, c.column) for c in init.calls][1] == (18, 20)


def test_aliases():
    assert [(a.name, a.target) for a in facts(NODE).aliases] == [
        ("rospy", "rospy"),
        ("S", "std_msgs.msg.String"),
        ("helpers", ".helpers"),
        ("*", "..a.b"),
        ("x", "x"),
        ("w", "z"),
    ]
    assert [a.scope for a in facts("class C:\n  def f(self):\n    import a").aliases] == ["C.f"]


def test_constants_and_what_is_global():
    found = facts("""
        T = 'a'
        def f():
            global pub, n
            pub = rospy.Publisher(T)
            local = 1
            def g():
                nonlocal local
                local = pub
        if __name__ == '__main__':
            T = 'b'
    """)
    assert [(c.name, c.line, shown(c.value)) for c in found.constants] == [
        ("T", 2, "'a'"),
        ("T", 11, "'b'"),
        ("pub", 5, "make rospy.Publisher(T)"),
    ]
    assert function(found, "f").outside == ("pub", "n")
    assert function(found, "f.g").outside == ("local",)


def test_class_bodies_bind_members():
    found = facts("""
        class A(B):
            TOPIC = 'a'
            pub = rospy.Publisher(TOPIC, S)
            handlers = {'a': on_a for x in y}
            def on_a(self): pass
            table = [on_a]
    """)
    body = function(found, "A")
    assert [(a.target, shown(a.value)) for a in body.assignments] == [
        ("this.TOPIC", "'a'"),
        ("this.pub", "make rospy.Publisher(this.TOPIC, S)"),
        ("x", "index(y, <>)"),
        ("this.handlers", "<{'a': on_a for x in y}>"),
        ("this.table", "list(function this.on_a())"),
    ]
    assert [m.name for m in found.classes[0].members] == ["TOPIC", "pub", "handlers", "table"]


def test_functions_named_without_being_called():
    found = facts("""
        def free(m): pass
        class A(object):
            def on(self, m): pass
        class B(A):
            def __init__(self, cb):
                def inner(m): pass
                s(self.on, free, inner, A.on, cb, self.unknown, other, B.on)
    """)
    (call,) = function(found, "B.__init__").calls
    assert [shown(a) for a in call.arguments] == [
        "function this.on()", "function free()", "function inner()", "function A.on()", "cb", "this.unknown", "other",
        "function B.on()",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("if m.a > m.b.c: pass", []),
        ("x = m.a", []),
        ("self.x = m.a", ["escape m.a"]),
        ("g[0] = m", ["escape m"]),
        ("x = m\nx.y = 1", ["write x.y"]),
        ("m.a = 1", ["write m.a"]),
        ("m.a[i].b = 1", ["write m.a.[].b"]),
        ("m.n += 1", ["write m.n"]),
        ("del m.a", ["write m.a"]),
        ("o = T()\no.h = m.h", ["write o.h"]),
        ("g(1, m.a)", ["pass m.a"]),
        ("g(k=m)", ["pass m"]),
        ("g(*m.a)", ["escape m.a"]),
        ("g([m])", ["escape m"]),
        ("g(m.a + 1)", []),
        ("g(m[0].a)", ["pass m.[].a"]),
        ("g(m.a[0])", ["pass m.a.[]"]),
        ("g(m.a[1:])", ["pass m.a"]),
        ("g(m.a if m.b else 0)", ["escape m.a"]),
        ("len(m.a)", []),
        ("x = float(m.a)", []),
        ("[p for p in m.a]", ["escape p"]),
        ("m.a.append(1)", ["pass m.a"]),
        ("x = f'{m.a}'", []),
        ("x = '%s' % m.a", []),
        ("return m.a", ["escape m.a"]),
        ("yield m", ["escape m"]),
        ("raise E(m.a)", ["pass m.a"]),
        ("for p in m.a: p.x", []),
        ("x = [p.x for p in m.a]", ["escape p.x"]),
        ("x = lambda: m.a", ["escape m"]),
        ("def g(): return m.a", ["escape m"]),
        ("def g(m): return m.a", []),
        ("other.a", []),
        ("print(other)", []),
        ("match m.k:\n  case 1: pass", []),
        ("if (n := m.a) > n: pass", []),
        ("with m.a as x: pass", []),
        ("a, b = m.x, m.y", ["escape m.x", "escape m.y"]),
        ("global m2\nm2 = m.a", ["escape m.a"]),
    ],
)  # fmt: skip
def test_accesses(text, expected):
    body = function(facts("def f(m):\n" + textwrap.indent(text, "  ")), "f")
    assert [f"{access.kind} {access.path}" for access in body.accesses] == expected


def test_a_captured_variable_is_told_at_every_function_between():
    found = facts("def f(m):\n  def g():\n    return lambda: m.a\n")
    for name, path in (("f", "m"), ("f.g", "m"), ("f.g.lambda@3:12", "m.a")):
        assert [(a.path, a.kind) for a in function(found, name).accesses] == [(path, "escape")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("for x in y: pass", [("x", "index(y, <>)")]),
        ("for i, x in enumerate(y): pass", [("i", "index(call enumerate(), <>)"), ("x", "index(y, <>)")]),
        ("for i, x in enumerate(y, 2): pass", [("i", "index(call enumerate(2), <>)"), ("x", "index(y, <>)")]),
        # In another order, which turn it is tells nothing.
        ("for i, x in enumerate(sorted(y)): pass", [("i", "<>"), ("x", "index(y, <>)")]),
        ("for i, (a, b) in enumerate(zip(c, d)): pass",
         [("i", "index(call enumerate(), <>)"), ("a", "index(c, <>)"), ("b", "index(d, <>)")]),
        ("for a, b in zip(c, d): pass", [("a", "index(c, <>)"), ("b", "index(d, <>)")]),
        ("for k, v in d.items(): pass",
         [("k", "index(index(call d.items(), <>), 0)"), ("v", "index(index(call d.items(), <>), 1)")]),
        ("for t in ['a', 'b']: pass", [("t", "index(list('a', 'b'), <>)")]),
        ("for x in sorted(y): pass", [("x", "index(y, <>)")]),
        ("a, b = f()", [("a", "index(call f(), 0)"), ("b", "index(call f(), 1)")]),
        ("a, *b = f()", [("a", "index(call f(), <>)"), ("b", "index(call f(), <>)")]),
        ("a = b = 1", [("a", "1"), ("b", "1")]),
        ("a, (b, c) = 1, (2, 3)", [("a", "1"), ("b", "2"), ("c", "3")]),
        ("a: int = 1", [("a", "1")]),
        ("with f() as g: pass", [("g", "call f()")]),
        ("match s:\n  case C(x=y): pass\n  case z: pass", [("y", "index(s, <>)"), ("z", "s")]),
        ("return 1", [("", "1")]),
    ],
)  # fmt: skip
def test_bindings(text, expected):
    body = function(facts("def f():\n" + textwrap.indent(text, "  ")), "f")
    assert [(a.target, shown(a.value)) for a in body.assignments] == expected


def test_python_2():
    found = facts("""
        import rospy
        def f(m):
            if not m.ok:
                raise ValueError, "no"
            print "x %s" % m.a
            try:
                pub.publish(m)
            except rospy.ROSException, e:
                return
            done()
    """)
    body = function(found, "f")
    assert found.problems == () and found.unread == ()
    assert [(c.callee, guards_of(body, c.guard)) for c in body.calls] == [
        ("pub.publish", ["unless not m.ok"]),
        ("done", ["unless not m.ok", "unless except rospy.ROSException"]),
    ]


def test_strings_of_several_lines_are_read_alike_by_all_interpreters():
    module = facts("x = h(f'''\n''', f'''a\n  {g( b )}''')\n").functions[0]
    assert [call.callee for call in module.calls] == ["g", "h"]
    assert shown(module.assignments[0].value) == "call h('\\n', join('a\\n  ', call g(b)))"


def test_columns_count_characters():
    found = facts("é = 'é'; f(é)\n")
    assert [(c.callee, c.line, c.column) for c in found.functions[0].calls] == [("f", 1, 10)]


@pytest.mark.parametrize(
    ("data", "unread"),
    [
        (b"x = (", ((1, 1),)),
        (b"a\nif x:\n", ((1, 3),)),
        (b"x = '\0'\nf()", ((1, 2),)),
        (b"x = " + b"(" * 5000, ((1, 1),)),
        (b"x = " + b"-" * 100000 + b"1", ((1, 1),)),
        (b"\x80\x81(", ((1, 1),)),
    ],
)
def test_what_does_not_parse_is_said(data, unread):
    found = extract(data)
    assert found.unread == unread
    assert found.problems


@pytest.mark.parametrize(
    "data",
    [
        "# coding: latin-1\nx = 'é'; f()".encode("latin-1"),
        b"\xef\xbb\xbff()",
        b"a = 1\r\nf()\r\n",
        b"a = 1\rf()",
        b"f()",
    ],
)
def test_odd_encodings_and_ends_of_lines(data):
    found = extract(data)
    assert found.problems == ()
    assert [call.callee for call in found.functions[0].calls] == ["f"]


def test_deep_nesting_is_contained_in_its_function():
    deep = "f(" + "a.b()" + ".c()" * 900 + ")"
    found = facts(f"def bad():\n  x = {deep}\ndef good():\n  p()\n")
    assert [c.callee for c in function(found, "good").calls] == ["p"]
    assert found.unread == () or found.unread == ((1, 2),)


@pytest.mark.parametrize(
    "text",
    [
        "x = " + " + ".join(["a"] * 3000),
        "x = [" + "1," * 200_000 + "]",
        "x = {" + "'a': 1," * 100_000 + "}",
        " = ".join(f"x{number}" for number in range(5000)) + " = [" + "1," * 500 + "]",
        ", ".join(f"x{number}" for number in range(5000)) + " = f(" + "1," * 500 + ")",
        "x = " + "(" * 60 + "a and b" + " or c) and d" * 60,
        "if a: pass\n" + "elif b: f()\n" * 800,
        "if a: pass\n" + "elif b: return\nelif c: f()\n" * 300,
        "\n".join(" " * depth + "if a:" for depth in range(90)) + "\n" + " " * 90 + "return",
        "if a: return\n" * 20_000,
        "def f(m):\n" + "".join(" " * depth + f"def f{depth}(a):\n" for depth in range(1, 60)) + " " * 60 + "m.a",
    ],
)  # fmt: skip
def test_hostile_sources_come_back_small_and_soon(text):
    start = time.process_time()
    found = extract(text.encode())
    assert time.process_time() - start < 10
    assert len(msgspec.msgpack.encode(found)) < 200 * len(text) + 1_000_000


PIECES = st.sampled_from([
    "import a\n", "from b import c\n", "try:\n", " pass\n", "except A, e:\n", "print 'x'\n", "if a and b():\n", " ",
    "\n", "\t", "(", ")", "[", "]", "'", '"""', "#", "\\", "f'{a}'", "f'''\n{a}'''", "é", "\0", "self.x = ", "return ",
    ", ", "x = ", "'%s' % ", ".format(", "lambda a: ", "def f(self, (b, c)):\n", "a.b.c", "0777", "`a`", "<>", "@",
    "with (a as b): pass\n", ":=", "match x:\n", "class C: ", "\r\n", "global a\n", "else:\n", "for x in y:\n",
    "raise E, 1", "case 1: p()\n", "while True:\n", "  ", "del a.b\n", "*", "yield ", "await ", "\x0c",
    "\ud800", "\u2028",
])  # fmt: skip


def check(data):
    found = extract(data)
    lines = data.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for body in found.functions:
        assert 1 <= body.line <= body.end <= len(lines)
        for each in (*body.calls, *body.assignments):
            assert 1 <= each.line <= len(lines)
            assert -1 <= each.guard < len(body.guards)
        for call in body.calls:
            assert 1 <= call.column <= len(lines[call.line - 1]) + 1
        for place, guard in enumerate(body.guards):
            assert -1 <= guard.outer < place
    for problem in found.problems:
        assert 1 <= problem.line <= len(lines)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(found), type=FlowFile) == found


@given(st.binary())
def test_never_raises_on_bytes(data):
    check(data)


@given(st.lists(PIECES).map("".join))
def test_never_raises_on_pieces(text):
    check(text.encode("utf-8", "surrogatepass"))


NAMES = "abcd"
CONDITIONS = st.sampled_from(
    ["a", "b", "c", "d", "not a", "a and b", "b or c", "not (c or d)", "a if b else c", "a == d"]
)


SIMPLE = st.sampled_from(
    ["p()", "p()", "p()", "x = a and p()", "x = p() if c else d", "return", "assert b or p()", "raise E"]
)


def indented(text):
    return textwrap.indent(text, " ")


@st.composite
def programs(draw, depth=3):
    """Statements that branch and jump; every `p()` in them is a place to be reached."""

    def body():
        return indented(draw(programs(depth - 1)))

    statements = []
    for _ in range(draw(st.integers(1, 3))):
        kind = (
            draw(st.sampled_from(["simple", "simple", "if", "if", "match", "with", "finally"])) if depth else "simple"
        )
        if kind == "simple":
            statements.append(draw(SIMPLE))
        elif kind == "if":
            tests = draw(st.lists(CONDITIONS, min_size=1, max_size=3))
            text = "\nel".join(f"if {test}:\n{body()}" for test in tests)
            statements.append(text + (f"\nelse:\n{body()}" if draw(st.booleans()) else ""))
        elif kind == "match":
            other = f"\n case _:\n{indented(body())}" if draw(st.booleans()) else ""
            statements.append(f"match {draw(CONDITIONS)}:\n case True:\n{indented(body())}{other}")
        elif kind == "with":
            statements.append(f"with w:\n{body()}")
        else:
            statements.append(f"try:\n{body()}\nfinally:\n{body()}")
    return "\n".join(statements)


class Anything:
    """A context that does nothing."""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return False


def holds(guard, values):
    if guard.kind == "with":
        return True
    if guard.kind == "case":
        return eval(guard.text.replace(" other than ", " != "), {}, values)
    assert guard.kind in ("if", "unless")
    return bool(eval(guard.text, {"p": lambda number: False}, values)) == (guard.kind == "if")


@given(programs())
def test_calls_are_reached_exactly_when_their_guards_hold(program):
    """Where nothing loops and nothing is caught, guards say all: every program is run under every valuation."""
    lines = program.split("\n")
    numbered = "\n".join(line.replace("p()", f"p({number})") for number, line in enumerate(lines))
    text = "def f(a, b, c, d, p, w, E):\n" + indented(numbered)
    body = function(extract(text.encode()), "f")
    code = compile(text, "program", "exec")
    runs = []
    for values in itertools.product((False, True), repeat=4):
        reached, scope = set(), {}
        exec(code, scope)
        with contextlib.suppress(AssertionError, ValueError):
            scope["f"](
                *values, lambda number, reached=reached: not reached.add(number) and False, Anything(), ValueError
            )
        runs.append((dict(zip(NAMES, values, strict=True)), reached))
    ever = set().union(*(reached for _, reached in runs))
    for call in body.calls:
        number = int(call.arguments[0].text)
        chain, place = [], call.guard
        while place >= 0:
            chain.append(body.guards[place])
            place = body.guards[place].outer
        for values, reached in runs:
            if number in ever:
                assert (number in reached) == all(holds(guard, values) for guard in chain), (text, values, chain)


SEEN_THROUGH = ("enumerate", "sorted", "zip")


def test_every_call_of_a_source_is_told():
    """Compared with a plain walk over the syntax tree, on this test's own source."""
    with open(__file__, encoding="utf-8") as file:
        text = file.read()
    told = sorted(
        (call.line, call.column)
        for body in extract(text.encode()).functions
        for call in body.calls
        if call.callee not in SEEN_THROUGH
    )
    walked = sorted(
        (node.lineno, len(text.split("\n")[node.lineno - 1].encode()[: node.col_offset].decode()) + 1)
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and not (isinstance(node.func, ast.Name) and node.func.id in SEEN_THROUGH)
    )
    assert told == walked
