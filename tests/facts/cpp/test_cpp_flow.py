"""What C++ sources tell about the flow of messages."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.facts.cpp.flow import extract
from rosimpact.impact.facts.cpp.flow_clean import clean_further, clean_source
from rosimpact.impact.facts.cpp.flow_grammar import PARSER, find_errors
from rosimpact.impact.facts.cpp.parse import _parse_again
from rosimpact.impact.facts.flow import FlowExpr, FlowFile


def said(expr: FlowExpr | None) -> str:
    """An expression as `kind:text(parts)`."""
    if expr is None:
        return ""
    parts = f"({', '.join(map(said, expr.parts))})" if expr.parts else ""
    return f"{expr.kind}:{expr.text}{parts}"


def function(body: str, parameters: str = ""):
    """The facts of one function with this body."""
    return next(f for f in extract(f"void f({parameters}) {{\n{body}\n}}".encode()).functions if f.name == "f")


def guards(fn, callee: str = "g") -> list[str]:
    """The guards of the one call of a function, from the outside in."""
    place = next(call.guard for call in fn.calls if call.callee == callee)
    found = []
    while place >= 0:
        guard = fn.guards[place]
        found.insert(0, f"{guard.kind} {guard.text}")
        place = guard.outer
    return found


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("g();", []),
        ("if (a) g();", ["if a"]),
        ("if (a\n     /* why */ && b) { g(); }", ["if a && b"]),
        ("if (a) {} else g();", ["unless a"]),
        ("if (a) {} else if (b) {} else { g(); }", ["unless a", "unless b"]),
        ("if (a) {} else if (b) g();", ["unless a", "if b"]),
        ("if (auto x = h(); x > 3) g();", ["if x > 3"]),
        ("if (auto x = h()) g();", ["if auto x = h()"]),
        ("if constexpr (a) g();", ["if a"]),
        ("if (a) [[likely]] { g(); }", ["if a"]),
        # what jumps
        ("if (a) return; g();", ["unless a"]),
        ("if (a) { h(); return; } g();", ["unless a"]),
        ("if (a) { h(); } else { return; } g();", ["if a"]),
        ("if (a) {} else if (b) {} else { return; } g();", ["if a || b"]),
        ("if (a) {} else if (b) { return; } g();", ["unless !(a) && b"]),
        ("if (a) return; else if (b) return; g();", ["unless a", "unless b"]),
        ("if (a) { if (b) return; } g();", ["unless a && b"]),
        ("if (a || c) { if (b) return; h(); } g();", ["unless (a || c) && b"]),
        ("if (a) { if (b) return; if (c) return; } g();", ["unless a && (b || c)"]),
        ("if (a) throw E(); g();", ["unless a"]),
        ("if (a) exit(1); g();", ["unless a"]),
        ("if (a) { rclcpp::shutdown(); return; } g();", ["unless a"]),
        ("if (a) goto end; g(); end: ;", ["unless a"]),
        ("if (a) goto end; h(); end: g();", []),
        ("assert(a); g();", ["if a"]),
        ("while (a) { if (b) continue; g(); }", ["while a", "unless b"]),
        ("while (a) { if (b) break; g(); }", ["while a", "unless b"]),
        ("while (a) { if (b) return; } g();", []),
        ("{ if (a) return; } g();", ["unless a"]),
        ("do { if (a) return; } while (b); g();", []),
        ("do { g(); } while (b);", ["do b"]),
        # behind what always jumps
        ("return; g();", ["never after return"]),
        ("throw E(); if (a) g();", ["never after throw", "if a"]),
        ("exit(1); g();", ["never after exit"]),
        ("if (a) { return; } else { return; } g();", ["never after if"]),
        ("if (a) return; return; g();", ["unless a", "never after return"]),
        ("{ return; } g();", ["never after return"]),
        ("while (a) { break; g(); }", ["while a", "never after break"]),
        ("while (a) { return; } g();", []),
        ("do { return; } while (a); g();", ["never after do"]),
        ("do { continue; } while (a); g();", []),
        ("goto end; end: g();", []),
        ("switch (x) { case 1: break; g(); }", ["case x == 1", "never after break"]),
        ("switch (x) { case 1: return; case 2: g(); }", ["case x == 2"]),
        ("switch (x) { case 1: return; default: return; } g();", ["never after switch"]),
        ("try { return; } catch (...) { return; } g();", ["never after try"]),
        ("#if A\nreturn;\n#else\nreturn;\n#endif\ng();", ["never after if"]),
        ("auto h = [] { return 1; }; g();", []),
        # loops
        ("for (int i = 0; i < n; ++i) g();", ["while i < n"]),
        ("for (;;) g();", ["while true"]),
        ("for (const auto & x : xs) g();", ["for const auto & x : xs"]),
        ("while (auto x = h()) g();", ["while auto x = h()"]),
        ("BOOST_FOREACH(const T & x, xs) { g(); }", ["for const T & x, xs"]),
        ("BOOST_FOREACH(T x, a.b(1, 2)) { if (c) continue; g(); }", ["for T x, a.b(1, 2)", "unless c"]),
        ("Q_FOREACH (T x, xs) g();", ["for T x, xs"]),
        ("foreach (T x, xs) g();", ["for T x, xs"]),
        ("EACH_ONE(x, xs) { g(); }", ["macro EACH_ONE(x, xs)"]),
        ("EACH_ONE(x.y())\n  g();", ["macro EACH_ONE(x.y())"]),
        ("NO_LOOP(x)\ng();", []),
        # switch
        ("switch (x) { case 1: g(); break; case 2: h(); }", ["case x == 1"]),
        ("switch (x) { case 1: case A::b: g(); }", ["case x == 1 or A::b"]),
        ("switch (x) { case 1: h(); case 2: g(); }", ["case x == 1 or 2"]),
        ("switch (x) { case 1: h(); break; case 2: g(); }", ["case x == 2"]),
        ("switch (x) { case 1: h(); return; case 2: g(); }", ["case x == 2"]),
        ("switch (x) { case 1: h(); break; case 2: break; default: g(); }", ["case x other than 1, 2"]),
        ("switch (x) { case 1: h(); break; case 2: default: g(); }", ["case x other than 1"]),
        ("switch (x) { case 1: if (a) break; g(); break; }", ["case x == 1", "unless a"]),
        ("switch (x) { case 1: { if (a) return; } g(); }", ["case x == 1", "unless a"]),
        ("switch (x) { case 1: break; default: return; } g();", ["case x == 1"]),
        ("switch (x) { case 1: case 2: return; case 3: h(); } g();", ["case x other than 1, 2"]),
        ("switch (x) {\n#ifdef A\ncase 1: g(); break;\n#endif\ncase 2: break; }", ["cpp defined(A)", "case x == 1"]),
        # exceptions
        ("try { g(); } catch (const E & e) { h(); }", []),
        ("try { h(); } catch (const E & e) { g(); }", ["catch const E & e"]),
        ("try { h(); } catch (...) { g(); }", ["catch ..."]),
        ("try { h(); } catch (const E & e) { return; } g();", ["unless catch (const E & e)"]),
        ("try { h(); } catch (const E & e) { i(); } g();", []),
        ("try { if (a) return; } catch (...) { return; } g();", ["unless a", "unless catch (...)"]),
        ("if (a) { try { h(); } catch (const E & e) { return; } } g();", ["unless a && catch (const E & e)"]),
        ("try { return; } catch (...) {} g();", ["catch ..."]),
        # inside expressions
        ("a ? g() : h();", ["if a"]),
        ("x = a ? h() : g();", ["unless a"]),
        ("a && g();", ["if a"]),
        ("if (a && b && g()) {}", ["if a", "if b"]),
        ("if (a || g()) {}", ["unless a"]),
        ("if ((a || b) && g()) {}", ["if a || b"]),
        ("x = a == b && g();", ["if a == b"]),
        ("x = c || (a && g());", ["unless c", "if a"]),
        ("x = a && b || g();", ["unless a && b"]),
        # preprocessor
        ("#ifdef A\ng();\n#endif", ["cpp defined(A)"]),
        ("#ifndef A\ng();\n#endif", ["cpp !(defined(A))"]),
        ("#if A > 3 // why\nh();\n#elif B\ng();\n#endif", ["cpp !(A > 3)", "cpp B"]),
        ("#if A\nh();\n#else\ng();\n#endif", ["cpp !(A)"]),
        ("#if A\nreturn;\n#endif\ng();", ["cpp !(A)"]),
        ("if (a) {\n#ifdef A\n} else if (b) {\ng();\n#endif\n}", ["unless a", "cpp defined(A)", "if b"]),
        ("h(1,\n#ifdef A\n2);\nreturn;\n#else\n3);\n#endif\ng();", ["cpp !(defined(A))"]),
        ("#ifdef A\nif (a) {\n#else\nif (b) {\n#endif\ng();\n}", ["cpp defined(A)", "if a"]),
        ("if (a) h();\n#ifdef A\nelse if (b) g();\n#endif", ["unless a", "cpp defined(A)", "if b"]),
        ("h(1,\n#ifdef A\n 2\n#else\n 3\n#endif\n); if (a) g();", ["if a"]),
    ],
)  # fmt: skip
def test_guards(body, expected):
    assert guards(function(body)) == expected


def test_a_guard_has_the_line_of_what_asks():
    fn = function("if (a)\n{\n  while (b)\n    g();\n}")
    assert [(guard.text, guard.line) for guard in fn.guards] == [("a", 2), ("b", 4)]


@pytest.mark.parametrize(
    ("text", "callee", "arguments", "types", "target"),
    [
        ("pub_ = nh.advertise<std_msgs::String>(\"a\" \"b\", 10);", "nh.advertise", ["text:ab", "number:10"],
         "std_msgs::String", "pub_"),
        ("this->p_ = this->node()->make<A, B<C>>();", "this.node().make", [], "A, B<C>", "this.p_"),
        ("auto p = node->template make<T>(1);", "node.make", ["number:1"], "T", "p"),
        ("a::b<T>::make<U>(x);", "a::b::make", ["name:x"], "U", ""),
        ("(*pub).publish(*m);", "pub.publish", ["name:m"], "", ""),
        ("(*this).run();", "this.run", [], "", ""),
        ("pubs_[i]->publish(m);", "pubs_.[].publish", ["name:m"], "", ""),
        ("pubs_.at(i)->publish(m);", "pubs_.[].publish", ["name:m"], "", ""),
        ("get().publish(m.x->y);", "get().publish", ["name:m.x.y"], "", ""),
        ("(a ? b : c).publish(m);", "().publish", ["name:m"], "", ""),
        ("static_cast<T *>(p)->publish(std::move(m));", "p.publish", ["name:m"], "", ""),
        ("this->Base::run(1);", "this.Base::run", ["number:1"], "", ""),
        ("sub = nh.subscribe(\"t\", 1, &A<T>::cb, this);", "nh.subscribe",
         ["text:t", "number:1", "function:A::cb", "name:this"], "", "sub"),
        ("sub = nh.subscribe(\"t\", 1, boost::bind(&A::cb, this, _1));", "nh.subscribe",
         ["text:t", "number:1", "bind:(function:A::cb, name:this, name:_1)"], "", "sub"),
        ("x = f(a + \"/b\", c ? 1 : -2, {1, k::N}, v[0], !d, new T<U>(2), T{3});", "f",
         ["join:+(name:a, text:/b)", "choice:(name:c, number:1, number:-2)", "list:(number:1, name:k::N)",
          "index:(name:v, number:0)", "other:!d", "make:T<U>(number:2)", "make:T(number:3)"], "", "x"),
        ("f(std::make_shared<M>(1), R\"(a\"b)\", \"x\\n\\\"\", nullptr, true);", "f",
         ["make:M(number:1)", "text:a\"b", "text:x\n\"", "number:nullptr", "number:true"], "", ""),
        ("f(/* no */ a, // b\n c);", "f", ["name:a", "name:c"], "", ""),
        ("f(\"%\" PRId64 \"x\", a);", "f", ["text:%x", "name:a"], "", ""),
        ("f(1,\n#ifdef A\n2\n#else\n3\n#endif\n);", "f", ["number:1", "number:2"], "", ""),
    ],
)  # fmt: skip
def test_calls(text, callee, arguments, types, target):
    call = next(call for call in function(text).calls if call.callee == callee)
    assert ([said(argument) for argument in call.arguments], call.types, call.target) == (arguments, types, target)


def test_a_call_stands_where_its_name_does():
    call = function("node\n  ->make<T>(1);").calls[0]
    assert (call.line, call.column) == (3, 5)
    assert [call.column for call in function("é(); x.g();").calls] == [1, 8]


def test_what_is_returned_is_marked():
    fn = function("return make<T>(1);")
    assert [(call.callee, call.returned, call.target) for call in fn.calls] == [("make", True, "")]
    assert [(a.target, a.operator, said(a.value)) for a in fn.assignments] == [("", "return", "call:make(number:1)")]


@pytest.mark.parametrize(
    ("text", "called"),
    [
        ('ROS_INFO("%s", name().c_str());', ["name"]),
        ("RCLCPP_INFO_STREAM(get_logger(), a.b() << c);", ["get_logger", "a.b"]),
        ("EXPECT_EQ(a(), 1);", ["a"]),
        ("for (auto i = v.begin(); i != v.end(); ++i) x(v.size());", ["x"]),
        ("move(goal);", ["move"]),
    ],
)
def test_noise_is_left_out_and_what_it_is_given_is_not(text, called):
    assert [call.callee for call in function(text).calls] == called


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("int a = 1, *b = &c;", [("a", "int", "=", "number:1"), ("b", "int*", "=", "function:c")]),
        ("const T & a = m->b;", [("a", "const T&", "=", "name:m.b")]),
        ("int a = /* seconds */ 1;", [("a", "int", "=", "number:1")]),
        ("ros::NodeHandle n;", [("n", "ros::NodeHandle", "=", "make:ros::NodeHandle")]),
        ('ros::NodeHandle n("~");', [("n", "ros::NodeHandle", "=", "make:ros::NodeHandle(text:~)")]),
        ("ros::Rate r(rate);", [("r", "ros::Rate", "=", "make:ros::Rate(name:rate)")]),
        ("ros::Rate r(rate());", [("r", "ros::Rate", "=", "make:ros::Rate(call:rate)")]),
        ('F<A, B> s(n, "t", 1);', [("s", "F<A, B>", "=", "make:F<A, B>(name:n, text:t, number:1)")]),
        ("T a{1};", [("a", "T", "=", "make:T(number:1)")]),
        ("T a = {1};", [("a", "T", "=", "list:(number:1)")]),
        ("auto a{1};", [("a", "auto", "=", "number:1")]),
        ("auto [a, b] = f();", [("a", "auto", "=", "index:(call:f, number:0)"),
                                ("b", "auto", "=", "index:(call:f, number:1)")]),
        ("a = b = 1;", [("b", "", "=", "number:1"), ("a", "", "=", "number:1")]),
        ("this->a.b[i]->c += x;", [("this.a.b.[].c", "", "+=", "name:x")]),
        ("*a = 1; ++b; c--;", [("a", "", "=", "number:1"), ("b", "", "+=", "number:1"), ("c", "", "-=", "number:1")]),
        ("for (auto & a : b.c) {}", [("a", "auto&", "=", "index:(name:b.c, other:)")]),
        ("T f(int a);", []),
    ],
)  # fmt: skip
def test_assignments(text, expected):
    found = [(a.target, a.type, a.operator, said(a.value)) for a in function(text).assignments]
    assert found == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("if (m->a > 3) {}", []),
        ("if (!m) {}", []),
        ("if (m == nullptr) {}", []),
        ("if (*m == last_) {}", [("m", "escape")]),
        ("last_ = m;", [("m", "escape")]),
        ("last_ = *m;", [("m", "escape")]),
        ("x.h = m->h;", [("m.h", "escape")]),
        ("auto h = m->h; h.s = 1;", [("h.s", "write")]),
        ("f(m->a, *m);", [("m.a", "pass"), ("m", "pass")]),
        ("p.publish(std::move(m));", [("m", "pass")]),
        ("Iter it(*m, \"x\");", [("m", "pass")]),
        ("Iter it(m);", [("m", "pass")]),
        ("std::cout << *m;", [("m", "escape")]),
        ("x = \"a\" + m->b;", [("m.b", "escape")]),
        ("return m->b;", [("m.b", "escape")]),
        ("v = {m->b, 1};", [("m.b", "escape")]),
        ("throw E(m->b);", [("m.b", "pass")]),
        ("y_ = m->r[i].x;", [("m.r.[].x", "escape")]),
        ("y_ = m->r.at(m->i).x;", [("m.r.[].x", "escape")]),
        ("for (auto & r : m->r) { r.x = 1; }", [("r.x", "write")]),
        ("m->r.resize(3);", [("m.r", "write")]),
        ("n = m->r.size();", []),
        ("m->s.odd();", [("m.s", "pass")]),
        ("ROS_INFO(\"%s\", m->s.c_str());", []),
        ("auto l = [m, this](int k) { q_ = m->a + k; };", []),
        ("m->a = 1; m->b += m->c;", [("m.a", "write"), ("m.b", "write")]),
        ("a ? m->x : m->y;", []),
        ("other->a = 1;", []),
    ],
)  # fmt: skip
def test_accesses(text, expected):
    fn = function(text, "const M::SharedPtr m")
    assert [(a.path, a.kind) for a in fn.accesses] == expected


def test_a_lambda_is_a_function_that_knows_what_is_around_it():
    text = b"void A::f(M m) {\n  if (a) x = [m, k = h()](const T & t) -> int { if (b) { g(m.y); } return t.z; };\n}"
    inner, outer = extract(text).functions
    assert (inner.name, inner.owner, inner.line, inner.returns) == ("A::f::lambda@2:14", "A", 2, "int")
    assert [(p.name, p.type) for p in inner.parameters] == [("t", "const T &")]
    assert guards(inner) == ["if b"]
    assert [(a.path, a.kind) for a in inner.accesses] == [("m.y", "pass"), ("t.z", "escape")]
    assert [(a.target, said(a.value)) for a in outer.assignments] == [("x", "lambda:A::f::lambda@2:14")]
    assert guards(outer, "h") == ["if a"]


def test_functions_and_whom_they_belong_to():
    text = b"""
    namespace n { namespace { void free() {} } namespace m::o { T & A<T>::g(int, const X x[3], Y y = 2) const {} }
    template<class T> struct B { B() = default; virtual ~B() {} void h() override; int operator()(int a) const {} };
    void n::p() {} }
    extern "C" { static auto q() -> int { return 1; } }
    int main(int argc, char ** argv) try { g(); } catch (...) {}
    """
    found = {f.name: (f.owner, [(p.name, p.type, said(p.default)) for p in f.parameters], f.returns)
             for f in extract(text).functions}  # fmt: skip
    assert found == {
        "n::free": ("", [], "void"),
        "n::m::o::A::g": (
            "n::m::o::A", [("", "int", ""), ("x", "const X [3]", ""), ("y", "Y", "number:2")], "T&",
        ),
        "n::B::~B": ("n::B", [], ""),
        "n::B::operator()": ("n::B", [("a", "int", "")], "int"),
        "n::n::p": ("n::n", [], "void"),
        "q": ("", [], "int"),
        "main": ("", [("argc", "int", ""), ("argv", "char **", "")], "int"),
    }  # fmt: skip


def test_what_a_constructor_initialises():
    text = b'A::A(O o) : rclcpp::Node("n", o), p_(create<T>("t", 1)), q_{o.x}, r_(1, 2), s_() { g(); }'
    fn = extract(text).functions[0]
    assert [(a.target, said(a.value)) for a in fn.assignments] == [
        ("this.rclcpp::Node", "make:(text:n, name:o)"),
        ("this.p_", "call:create(text:t, number:1)"),
        ("this.q_", "name:o.x"),
        ("this.r_", "make:(number:1, number:2)"),
        ("this.s_", "make:"),
    ]
    assert [(call.callee, call.target) for call in fn.calls] == [("create", "this.p_"), ("g", "")]


def test_classes():
    text = b"""
    namespace n {
    class A_PUBLIC Talker final : public rclcpp::Node, private B<T>
    {
      Q_OBJECT
    public:
      A_PUBLIC explicit Talker(int x);
      void on(const M & m);
      virtual void off() = 0;
      template<class T> void on(T t) { t.x(); }
    private Q_SLOTS:
      void slot();
    signals:
      void signal();
    private:
      rclcpp::Publisher<M>::SharedPtr pub_ = create_publisher<M>("t", 1), *other_;
      static constexpr int N{3};
      std::function<void(int)> cb_;
      struct In { int i; } in_;
    };
    class MACRO_WITHOUT_END Odd { void f() { g(); } };
    }
    """
    facts = extract(text)
    inner, talker, odd = facts.classes
    assert (talker.name, talker.bases, talker.line, talker.end) == ("n::Talker", ("rclcpp::Node", "B<T>"), 3, 20)
    assert [(m.name, m.type, said(m.value)) for m in talker.members] == [
        ("pub_", "rclcpp::Publisher<M>::SharedPtr", "call:create_publisher(text:t, number:1)"),
        ("other_", "rclcpp::Publisher<M>::SharedPtr*", ""),
        ("N", "constexpr int", "number:3"),
        ("cb_", "std::function<void(int)>", ""),
        ("in_", "In", ""),
    ]
    assert (inner.name, odd.name) == ("n::Talker::In", "n::Odd")
    outside = next(f for f in facts.functions if not f.name)
    assert (outside.owner, [(c.callee, c.types, c.target) for c in outside.calls]) == (
        "n::Talker", [("create_publisher", "M", "this.pub_")],
    )  # fmt: skip
    assert not facts.unread


def test_names_of_other_things():
    text = b"""
    using namespace a::b;
    using std::string;
    namespace n { namespace fs = std::filesystem; using A = B<C>; typedef D<E> * F; struct G { using H = I; }; }
    void f() { using namespace j; using K = L; }
    """
    assert [(alias.name, alias.target, alias.scope) for alias in extract(text).aliases] == [
        ("*", "a::b", ""),
        ("string", "std::string", ""),
        ("fs", "std::filesystem", "n"),
        ("A", "B<C>", "n"),
        ("F", "D<E>*", "n"),
        ("H", "I", "n::G"),
        ("*", "j", "f"),
        ("K", "L", "f"),
    ]


def test_constants():
    text = b"""
    #define TOPIC "scan" // the one
    #define RATE (10)
    #define CALL(x) x
    #define OTHER a + b
    static const char * const kName = "x";
    namespace n { constexpr int k{3}; ros::Publisher pub; int f(int a); std::string s("t"); }
    """
    assert [(m.name, m.type, said(m.value), m.line) for m in extract(text).constants] == [
        ("TOPIC", "", "text:scan", 2),
        ("RATE", "", "number:10", 3),
        ("kName", "const char*", "text:x", 6),
        ("n::k", "constexpr int", "number:3", 7),
        ("n::pub", "ros::Publisher", "", 7),
        ("n::s", "std::string", "text:t", 7),
    ]


def test_a_name_that_has_the_word_operator_in_it_is_like_others():
    text = b"""
    namespace fork_operator {
    void Lift::on_operator_input(int a) { std::make_shared<fork_operator::Mast<int>>(a); }
    bool Lift::operator<(const Lift & other) const { return true; }
    }
    """
    facts = extract(text)
    assert [(f.name, f.owner) for f in facts.functions if f.name] == [
        ("fork_operator::Lift::on_operator_input", "fork_operator::Lift"),
        ("fork_operator::Lift::operator<", "fork_operator::Lift"),
    ]
    assert [(c.callee, c.types) for f in facts.functions for c in f.calls] == [
        ("std::make_shared", "fork_operator::Mast<int>")
    ]


def test_enumerators_are_constants_as_far_as_their_numbers_are_known():
    text = b"""
    enum Kind { LASER = 1, SONAR, OWN = SONAR + 4, NEXT };
    namespace n { typedef enum { A, B } T; enum Late : int { C = 5, D }; }
    enum class Scoped { X, Y };
    enum Ahead : int;
    class K { enum In { P, Q = 7 }; };
    """
    facts = extract(text)
    known = [("LASER", 1), ("SONAR", 2), ("n::A", 0), ("n::B", 1), ("n::C", 5), ("n::D", 6)]
    assert [(m.name, said(m.value)) for m in facts.constants] == [(name, f"number:{value}") for name, value in known]
    assert [(m.name, said(m.value)) for m in facts.classes[0].members] == [("P", "number:0"), ("Q", "number:7")]


def test_what_plugins_are_exported():
    text = b"PLUGINLIB_EXPORT_CLASS(a::B, c::D)\nRCLCPP_COMPONENTS_REGISTER_NODE(e::F)\nvoid f() {}\n"
    facts = extract(text)
    assert facts.exports == ("a::B", "e::F")
    assert "f" in [fn.name for fn in facts.functions]


def test_a_header_guard_is_no_condition_and_others_are():
    text = b"#ifndef A_H\n#define A_H\ninline void f() { g(); }\n#ifdef B\ninline void h() { g(); }\n#endif\n#endif\n"
    first, second = extract(text).functions
    assert (guards(first), guards(second)) == ([], ["cpp defined(B)"])


@pytest.mark.parametrize(
    "text",
    [
        "#if __has_include(<a/b.hpp>)\n#include <a/b.hpp>\n#endif\n",
        "#if PCL_VERSION_COMPARE(>=, 1, 12, 0)\n#include <a>\n#endif\n",
        '#ifdef __cplusplus\nextern "C" {\n#endif\nint f(int a);\n#ifdef __cplusplus\n}\n#endif\n',
        "void k() { x = new double *[3]; }",
        'struct K { void k(const std::vector<P> & p = {}, const S & s = {"a"}, int i = 1); };',
        "void k() { x = typename A::B(); }",
        'void k() { a->template set("b", 1); }',
        "void k() { connect(a, SIGNAL(b(const C *, int)), this, SLOT(d(E<F> *))); }",
        "void k() {\n  CHECK_THIS(a)  // so\n  const A & b = c();\n}",
        "class K { Q_OBJECT\npublic Q_SLOTS:\n  void a();\nsignals:\n  void b();\n};",
        "class FOO_EXPORT K : public B { FOO_EXPORT K(); FOO_EXPORT static int a(); };",
        'void k() { printf("a %" PRIu64 " b", c); }',
        "struct P {\n  // of PCL\n  ADD_POINT_4D  // x, y, z\n  float i;\n  ALIGNED_NEW_\n} ALIGN_16;",
        "REGISTER_POINT_STRUCT(n::P,\n  (float, x, x)  // so\n  (float, y, y)\n)\n",
    ],
)
def test_macros_and_what_the_grammar_does_not_know_hide_nothing(text):
    facts = extract(f"{text}\nvoid f() {{ g(); }}\n".encode())
    assert not facts.unread
    assert guards(next(f for f in facts.functions if f.name == "f")) == []


def test_a_word_alone_on_its_line_may_be_a_value():
    facts = extract(b"""
    enum E {
      FIRST_ONE,
      SECOND_ONE
    };
    int x =
      FIRST_VALUE
      + 1;
    struct P {
      ADD_POINT_4D
      float i;
    };
    void f() {
      g(
        THIRD_VALUE
      );
    }
    """)
    assert not facts.unread
    (fn,) = (one for one in facts.functions if one.name == "f")
    assert [said(argument) for argument in fn.calls[0].arguments] == ["name:THIRD_VALUE"]
    assert [(member.name, member.type) for member in facts.classes[-1].members] == [("i", "float")]


@pytest.mark.parametrize("text", [
    "class API Arm { void go() { g(); } };", "struct API Arm { Arm() { g(); } };",
    "class API Arm { public: void go() { g(); } };",
])  # fmt: skip
def test_a_class_behind_a_macro_is_no_function(text):
    facts = extract(f"{text}\nvoid f() {{ h(); }}\n".encode())
    assert sorted((f.name, [call.callee for call in f.calls]) for f in facts.functions) == [("", ["g"]), ("f", ["h"])]


def test_what_did_not_parse_is_said():
    facts = extract(b"void f() { g(); }\n\nint x = = 3 ] ;\n\nvoid h() { g(); }\n")
    assert facts.unread and all(3 <= first <= last <= 4 for first, last in facts.unread)
    assert [f.name for f in facts.functions] == ["f", "h"]
    left_out = extract(b"void f() {\n#ifdef A\nif (a) {\n#else\nif (b) {\n#endif\ng();\n}\n}\n")
    assert left_out.unread == ((5, 5),)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\0void f() {\0 g(); }",
        b"\xef\xbb\xbfvoid f() {\r\n g();\r\n}\r\n",
        b'void f() { h("\xe9\xff"); g(); }',
        "void f() { /* ü */ g(); }".encode("utf-16"),
        b"void f() { x = " + b"(" * 5000 + b")" * 5000 + b"; }",
        b"void f() { x = " + b"a(" * 5000 + b")" * 5000 + b"; }",
        b"void f() " + b"{" * 5000 + b"}" * 5000,
        b"void f() { x = " + b"a + " * 5000 + b"1; }",
        b"void f() { if (a) {}" + b"else if (g()) {}" * 5000 + b"}",
        b"void f() { a" + b".b()" * 5000 + b"; }",
        b"void f() { " + b"if (a()) return;" * 5000 + b" g(); }",
        b"void f() { switch (x) {" + b"case 1: g();" * 5000 + b"} }",
        b"namespace a {" * 5000,
        b"class A {" * 5000,
        b"#if A\n" * 5000,
        b"BOOST_FOREACH(" * 2000,
        b"int x = " + b"{" * 5000,
        b'void f() { "',
        b"}{)(" * 5000,
    ],
)
def test_hostile_sources_come_back(data):
    facts = extract(data)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(facts), type=FlowFile) == facts


def test_what_is_too_deep_is_a_problem_of_its_function_alone():
    facts = extract(b"void f() { x = " + b"(" * 5000 + b")" * 5000 + b"; }\nvoid h() { g(); }")
    assert [problem.message for problem in facts.problems] == ["nested too deeply to be read in full"]
    assert guards(next(f for f in facts.functions if f.name == "h")) == []


PIECES = st.sampled_from([
    "if (a) ", "else ", "{", "}", "g();", "return;", "x = ", "(", ")", "case 1:", "switch (x) ", "for (;;) ", "do ",
    "\n#if A\n", "\n#else\n", "\n#endif\n", "[&](int i) ", "class A ", "void f() ", ";", '"', "/*", "*/", "//",
    "\\\n", "é", "<", ">", "::", "try ", "catch (...) ", "->", "&", "new ", "T x(y);", ", ", ": ", "template ",
])  # fmt: skip


@given(st.lists(PIECES, max_size=40).map("".join))
def test_any_text_comes_back(text):
    facts = extract(text.encode())
    for fn in facts.functions:
        for place, guard in enumerate(fn.guards):
            assert -1 <= guard.outer < place
        assert all(call.guard < len(fn.guards) for call in fn.calls)


@given(st.binary(max_size=200))
def test_any_bytes_come_back(data):
    assert extract(data).language == "cpp"


# What is rewritten where a source did not parse as it was, and what such lines stand among.
_PIECES = (
    "#if A\nif (a) {\n#else\nif (b) {\n#endif\n}\n", "#ifdef A\n", "#endif\n", "#else\n", "void f() {\n", "}\n",
    "FOO_DECL class K {\n", "};\n", "x = new (std::nothrow) T[3];\n", "emit(SIGNAL(s(const T &)));\n", "MACRO(a, b)\n",
    "for_each (T t, ts)\n", "BOOST_FOREACH (T t, ts) {\n", "if (a <b> (c)) {\n", 'printf("%" PRIu64, a);\n', "\n",
    "public slots:\n", "typename T::X x{};\n", "  pub.publish(m);\n", "é\n", '"\n', "/*\n", "*/\n", "\\\n", "\0\r\n",
)  # fmt: skip


@given(st.lists(st.sampled_from(_PIECES), max_size=14).map("".join))
def test_what_is_parsed_again_is_as_if_parsed_at_once(text):
    before = clean_source(text.encode())
    tree = PARSER.parse(before.source)
    after = clean_further(text.encode(), before)
    assert len(after.source) == len(before.source)
    at_once = PARSER.parse(after.source).root_node
    assert find_errors(_parse_again(tree, before.source, after.source), after.starts) == find_errors(
        at_once, after.starts
    )
