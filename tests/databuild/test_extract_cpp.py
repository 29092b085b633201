"""What a C++ header offers: one declaration in, its entities out; then what spoils other readers; then any bytes."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.databuild.extract.cpp import extract
from rosimpact.impact.facts.cpp.lexical import find_words
from rosimpact.impact.facts.kinds import FileFacts, decode, encode
from rosimpact.impact.facts.kinds import extract as facts_of
from rosimpact.impact.facts.surface import Entity, drop_inline, format_declaration


def offered(text: str) -> list[Entity]:
    return list(extract(text.encode()).entities)


def shown(one: Entity) -> str:
    """An entity in one line."""
    text = f"{one.kind} {one.name}"
    if one.parameters is not None:
        listed = [
            f"{parameter.type} {parameter.name}".strip() + (f"={parameter.default}" if parameter.default else "")
            for parameter in one.parameters
        ]
        text += f"({', '.join(listed)})"
    if one.type:
        text += f": {one.type}"
    if one.traits:
        text += f" [{' '.join(one.traits)}]"
    return text


FUNCTIONS = [
    ("void f();", "function f(): void"),
    ("int f(void);", "function f(): int"),
    ("int const & f(std::string const&s, long unsigned n);",
     "function f(const std::string& s, unsigned long n): const int&"),
    ("void f(const int a, T * const p);", "function f(int a, T* p): void"),
    ("void f(class A a, struct B *b, typename T::X x);", "function f(A a, B* b, T::X x): void"),
    ("void f(int = 3, bool b = (a < c), M<int, 2> m = M<int, 2>());",
     "function f(int=3, bool b=(a<c), M<int, 2> m=M<int, 2>()): void"),
    ("void f(Options o = {}, const char *s = \"a;{\");", "function f(Options o={}, const char* s=\"a;{\"): void"),
    ("void f(char c = ';', int n = 1);", "function f(char c=';', int n=1): void"),
    ("void f(const char * format, ...);", "function f(const char* format): void [variadic]"),
    ("auto f(int a) -> std::vector<int>;", "function f(int a): std::vector<int>"),
    ("void f(void (*cb)(int x, A const& a), int (&arr)[3], int v[4]);",
     "function f(void(*)(int, const A&) cb, int(&)[3] arr, int[4] v): void"),
    ("template<class... A> void f(A &&... a) noexcept;", "function f(A&&... a): void [noexcept]"),
    ("static inline constexpr int f() { if (a) { return 1; } return 2; }",
     "function f(): int [constexpr inline static]"),
    ("FOO_PUBLIC const A & f(std::function<void(A::SharedPtr a, int)> g);",
     "function f(std::function<void(A::SharedPtr, int)> g): const A&"),
    ("[[nodiscard]] int f() MAY_BE_A_MACRO;", "function f(): int [nodiscard]"),
    ("__attribute__((visibility(\"default\"))) void f();", "function f(): void"),
    ("extern \"C\" void f();", "function f(): void [extern]"),
    ("bool operator<(const A & a, const A & b);", "function operator<(const A& a, const A& b): bool"),
    ("std::ostream & operator<<(std::ostream & o, A a) { return o; }",
     "function operator<<(std::ostream& o, A a): std::ostream&"),
    ("template<typename T> requires C<T> void f(T t);", "function f(T t): void"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), FUNCTIONS)
def test_functions(text, expected):
    assert [shown(one) for one in offered(text)] == [expected]


MEMBERS = [
    ("A();", "constructor A::A()"),
    ("explicit A(int a) : a_(a), b_{1} {}", "constructor A::A(int a) [explicit]"),
    ("A(const A &) = delete;", "constructor A::A(const A&) [deleted]"),
    ("FOO_PUBLIC A(A &&) = default;", "constructor A::A(A&&) [defaulted]"),
    ("virtual ~A() = default;", "destructor A::~A() [defaulted virtual]"),
    ("virtual void f() const = 0;", "method A::f(): void [const pure virtual]"),
    ("void f() const override final;", "method A::f(): void [const final override virtual]"),
    ("void f() &&;", "method A::f(): void [&&]"),
    ("static A::Ptr make();", "method A::make(): A::Ptr [static]"),
    ("operator bool() const;", "conversion A::operator bool(): bool [const]"),
    ("int operator()(int a) const { return a; }", "method A::operator()(int a): int [const]"),
    ("A & operator=(const A & a) = delete;", "method A::operator=(const A& a): A& [deleted]"),
    ("friend bool operator==(const A & a, const A & b);",
     "function operator==(const A& a, const A& b): bool [friend]"),
    ("int a;", "field A::a: int"),
    ("std::atomic<bool> a{false};", "field A::a: std::atomic<bool>"),
    ("int a RCPPUTILS_TSA_GUARDED_BY(mutex_);", "field A::a: int"),
    ("unsigned a : 3;", "field A::a: unsigned int"),
    ("using Ptr = std::shared_ptr<A const>;", "alias A::Ptr: std::shared_ptr<const A>"),
    ("typedef void (*Callback)(int a);", "alias A::Callback: void(*)(int)"),
    ("using B::f;", "using A::f: B::f"),
    ("union { int a; };", "field A::a: int"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), MEMBERS)
def test_members(text, expected):
    class_, member = offered("class A { public: " + text + " };")
    assert (class_.kind, class_.name) == ("class", "A")
    assert shown(member) == expected


OTHERS = [
    ("enum class E : uint8_t { A, B = 4, C, D = X, F };",
     ["enum E: uint8_t [scoped]", "enumerator E::A: E", "enumerator E::B: E", "enumerator E::C: E",
      "enumerator E::D: E", "enumerator E::F: E"]),
    ("namespace n { typedef enum { A = 1 << 2 } E; }", ["enum n::E", "enumerator n::A: n::E"]),
    ("typedef struct { int x; } S, *P;", ["struct S", "alias P: S*", "field S::x: int"]),
    ("struct S { int x; } b, * c;", ["struct S", "variable b: S", "variable c: S*", "field S::x: int"]),
    ("namespace a { inline namespace v1 { struct S {}; int n; } }", ["struct a::v1::S", "variable a::v1::n: int"]),
    # the semicolon is missing
    ("struct A {}\nusing B = int;", ["struct A", "alias B: int"]),
    ("struct A {}\nstatic int f();", ["struct A", "function f(): int [static]"]),
    ("namespace a::b { struct S; int n = 1, *m; }", ["variable a::b::n: int", "variable a::b::m: int*"]),
    ("namespace a = b::c; using namespace a;", ["namespace alias a: b::c", "using namespace : a"]),
    ("template<typename T> concept C = requires(T t) { t.f(); };", ["concept C"]),
    ("#define F(a, b) a\n#define N 3\n#define G\n", ["macro F(a, b)", "macro N", "macro G"]),
    ("template<> struct hash<A> { int f(); };", ["struct hash", "method hash<A>::f(): int"]),
    ("void A::f(int) {}\ntemplate<class T> A<T>::A(int a) : B(a) {}\nint A::n = 1;", []),
    ("friend class B; struct C; enum D : int; extern template class E<int>;", []),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), OTHERS)
def test_other_declarations(text, expected):
    assert [shown(one) for one in offered(text)] == expected


def test_values_of_enumerators_are_numbers_where_the_text_tells():
    values = [one.value for one in offered("enum E { A, B = 0x10, C, D = X, F, G = -1 };") if one.kind == "enumerator"]
    assert values == ["0", "16", "17", "X", "X+1", "-1"]


def test_private_members_count_only_where_somebody_can_meet_them():
    text = (
        "class A { int a; void f(); virtual void g(); A(const A&) = delete; struct B { int c; }; protected: int d; };"
    )
    assert [(one.name, one.access) for one in offered(text)[1:]] == [
        ("A::g", "private"),
        ("A::A", "private"),
        ("A::d", "protected"),
    ]


def test_bases_templates_and_final():
    (one,) = offered(
        "template<typename T = int, int N = 3, template<class> class C> class A final : B<T>, public virtual D {};"
    )
    assert [(base.type, base.access, base.virtual) for base in one.bases] == [
        ("B<T>", "private", False),
        ("D", "public", True),
    ]
    assert [(parameter.kind, parameter.name, parameter.default) for parameter in one.template or ()] == [
        ("type", "T", "int"),
        ("value", "N", "3"),
        ("template", "C", None),
    ]
    assert one.traits == ("final",)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("template<class T, int N, typename... A> class B : public C {};",
         "template<typename T, int N, typename... A> class B : public C"),
        ("template<typename> struct D;\ntemplate<typename> struct D {};", "template<typename> struct D"),
        ("enum class E : int { F };", "enum class E : int"),
    ],
)  # fmt: skip
def test_how_an_entity_could_be_written(text, line):
    assert format_declaration(offered(text)[0]) == line


def test_a_macro_may_stand_for_final():
    (one,) = offered("class ARM_PUBLIC Arm ARM_FINAL : public Base {};")
    assert (one.name, one.traits, [base.type for base in one.bases]) == ("Arm", ("final",), ["Base"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[deprecated("use g")]] void f();', "use g"),
        ("__attribute__((deprecated)) void f();", ""),
        ("ROS_DEPRECATED void f();", ""),
        ("void f() FOO_DEPRECATED;", ""),
        ('PCL_DEPRECATED(1, 12, "use g") void f();', "use g"),
        ('class [[deprecated("gone")]] A {};', "gone"),
        ("void f();", None),
        ("static const int OLD_DEPRECATED = 3;", None),
    ],
)
def test_deprecation(text, message):
    assert [one.deprecated for one in offered(text)] == [message]


def test_a_header_that_warns_is_deprecated():
    surface = extract(
        b'#ifndef A_H\n#define A_H\n#include "rclcpp/visibility.hpp"\n'
        b"#warning This header is obsolete, include a/b.hpp\n#include <a/b.hpp>\n#endif\n"
    )
    assert (surface.deprecated, surface.instead) == ("This header is obsolete, include a/b.hpp", "a/b.hpp")
    assert extract(b"/* \n#warning deprecated\n*/ int a;").deprecated is None
    assert extract(b"#warning slow without SSE\n").deprecated is None


def test_macros_of_ros_declare_what_they_stand_for():
    names = [one.name for one in offered("class A { public: RCLCPP_SMART_PTR_ALIASES_ONLY(A)\n int a; };")]
    assert names == [
        "A", "A::SharedPtr", "A::ConstSharedPtr", "A::WeakPtr", "A::ConstWeakPtr", "A::UniquePtr", "A::make_shared",
        "A::a",
    ]  # fmt: skip
    aliases = {one.name: one.type for one in offered("namespace m { MOVEIT_CLASS_FORWARD(Foo);  // Defines FooPtr\n}")}
    assert aliases["m::FooConstPtr"] == "std::shared_ptr<const Foo>"


UNKNOWN = [
    "class FOO_PUBLIC A { public: void f(); };",
    "class FOO(3) A : public B { public: UNKNOWN_MACRO(A, 3)\n void f(); };",
    "class A {\n Q_OBJECT\npublic Q_SLOTS:\n void f(); };",
    "class A { public: UNKNOWN(a, b); void f(); };",
    "class A : public B {\n#if X\npublic:\n#endif\npublic: void f(); };",
    "#ifdef X\nclass A : public B {\n#else\nclass A {\n#endif\npublic: void f(); };",
    "#if 0\nclass A { \n#endif\nclass A { public: void f(); };",
    "ALIGNED(class) A { public: void f(); };",
    "extern \"C\" {\nclass A { public: static int g() { return '}'; } void f(); };\n}",
]  # fmt: skip


@pytest.mark.parametrize("text", UNKNOWN)
def test_unknown_macros_and_branches_hide_nothing(text):
    assert {"A", "A::f"} <= {one.name for one in offered(text) if not one.conditions or "X" in one.conditions[0].text}
    assert extract(text.encode()).lost == 0


def test_conditions_lines_and_scopes():
    text = "namespace n { inline namespace v1 {\n#if N > 2\nvoid\nf();\n#endif\nnamespace detail { void g(); } } }"
    surface = extract(text.encode())
    f, g = surface.entities
    assert (f.name, f.line, [one.text for one in f.conditions]) == ("n::v1::f", 4, ["N > 2"])
    assert (drop_inline(f.name, surface.inline), f.internal, g.internal, g.conditions) == ("n::f", False, True, ())


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("void f(std::string const & a);", "void\nf( const std::string &b ) ;"),
        ("void f(unsigned a = 1);", "void f(unsigned int a=1);"),
        ("struct A\n: B { int a; };", "struct A : public B\n{\n  int a;  // speed\n};"),
        ("int f(struct A * a);", "int f(A* a);"),
    ],
)
def test_what_reformatting_changes_is_no_change(one, other):
    def bare(text):
        return [
            (e.kind, e.name, e.type, [(p.type, p.default) for p in e.parameters or ()], e.bases) for e in offered(text)
        ]

    assert bare(one) == bare(other)


def test_it_is_a_kind_of_facts():
    facts = facts_of("rosimpact.databuild.extract.cpp", b"#include <a.h>\nint f();")
    assert isinstance(facts, FileFacts)
    assert decode("rosimpact.databuild.extract.cpp", encode(facts)) == facts
    assert [include.path for include in facts.facts.includes] == ["a.h"]


WORDS = st.sampled_from([
    "class", "struct", "enum", "union", "namespace", "template", "typename", "<", ">", "(", ")", "{", "}", "[", "]",
    ";", ":", "::", ",", "=", "&", "*", "~", "operator", "using", "typedef", "friend", "static", "virtual", "const",
    "public", "private", "A", "f", "int", '"s"', "'c'", "0", "...", "->", "&&", "\n#if", "\n#else", "\n#endif", "\n",
    "requires", "decltype", "noexcept", "DEPRECATED", "RCLCPP_DISABLE_COPY", "Q_OBJECT", "[[deprecated]]", "//", "/*",
    "*/", "\\", "final", "concept", "extern", "\n#define", "public:",
])  # fmt: skip


@settings(deadline=None)
@given(st.one_of(st.binary(max_size=200), st.lists(WORDS, max_size=60).map(lambda words: " ".join(words).encode())))
def test_any_bytes_give_a_surface(data):
    surface = extract(data)
    assert 0 <= surface.lost <= max(len(data), 1)
    lines = data.count(b"\n") + data.count(b"\r") + 1
    assert all(one.name or one.kind == "using namespace" for one in surface.entities)
    assert all(1 <= one.line <= max(lines, 1) for one in surface.entities)


@settings(deadline=None)
@given(st.lists(st.sampled_from([text for text, _ in FUNCTIONS]), max_size=8))
def test_declarations_do_not_touch_each_other(texts):
    together = [shown(one) for one in offered("\n".join(texts))]
    assert together == [shown(one) for text in texts for one in offered(text)]


def test_a_name_that_ends_with_colons_is_nowhere():
    assert [*find_words("", "void f();")] == []
    extract(b"namespace a { int b:: ; void A:: (int) ; }")
