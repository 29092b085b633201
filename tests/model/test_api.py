"""Which uses of other packages' changing C++ names are found in a source file, as tables."""

import pytest
from rosimpact.databuild.surface_changes import Lines
from rosimpact.impact.facts.surface_cpp import extract as header
from rosimpact.impact.model.api import ASSIGNING, Changes, Vocabulary
from rosimpact.impact.model.api_cpp import ApiUses, parameter_type, shown_as
from rosimpact.impact.model.expressions_cpp import regions
from rosimpact.impact.targets.surface.changes import unpack
from rosimpact.impact.targets.surface.compare import State
from rosimpact.impact.targets.surface.surface import BuildSurface, Header, PythonSurface, Surface

# `went` and `Old` are in the first version alone; `f` takes one argument, then two; `tick` is virtual and changes.
ARM = (
    """
#define ARM_OLD(x) x
using ArmResult = int;
namespace arm {
enum Mode { SLOW, OFF };
class Old {};
class Base { public: void went(int a); virtual void tick(); int speed; void stays(); };
class Arm : public Base { public: explicit Arm(int a); void f(int a); static void make(); };
template<class T> class Grip { public: void grab(); };
void helper(int a, int b);
}""",
    """
namespace arm {
enum Mode { SLOW };
class Base { public: virtual void tick(double dt); void stays(); Base & operator+=(int by); };
class Arm : public Base { public: explicit Arm(int a, int b); void f(int a, int b); };
template<class T> class Grip { public: };
}""",
)
# Another package that builds upon it.
LEG = ("namespace leg { class Leg : public arm::Arm { public: void old(); }; }",
       "namespace leg { class Leg : public arm::Arm { public: }; }")  # fmt: skip


@pytest.fixture(scope="module")
def changes() -> Changes:
    lines = Lines()
    for number, version in enumerate(("1.0.0", "2.0.0")):
        surfaces = {}
        for package, code in (("arm", ARM[number]), ("leg", LEG[number])):
            path = f"{package}/a.hpp"
            build = BuildSurface(package, version, headers=(Header(path, f"include/{path}", path),))
            surfaces[package] = Surface(package, version, build, PythonSurface(package),
                                        ((path, header(code.encode())),))  # fmt: skip
        state = State(surfaces)
        for package in surfaces:
            lines.add(package, version, (2,), state)
    packed = lines.packed()
    return Changes(lambda package: unpack(packed[package]) if package in packed else {})


def uses(text: str, changes: Changes, *headers: str) -> list[str]:
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes)
    words = [word for word in sorted(vocabulary.words) if word in text or word in ASSIGNING]
    found = ApiUses(text, headers, vocabulary, {"arm", "leg"}).found(words)
    told = []
    for use in sorted(found, key=lambda use: use.offset):
        arguments = "" if use.how == "name" else f"/{use.arguments}"
        told.append(("" if use.sure else "?") + use.name + arguments + ("!" if use.how == "override" else ""))
    return told


@pytest.mark.parametrize(
    ("text", "found"),
    [
        # names with their scopes
        ("arm::Old * o;", ["arm::Old"]),
        ("::arm::Old * o;", ["arm::Old"]),
        ("int m = arm::OFF;", ["arm::OFF"]),
        ("namespace a = arm; a::Old * o;", ["arm::Old"]),
        ("using arm::Old; Old * o;", ["arm::Old"] * 2),
        ("using namespace arm; Old * o;", ["?arm::Old"]),
        ("using Fast = arm::Arm; void g() { Fast::make(); }", ["arm::Arm::make/0"]),
        ("void g() { arm::helper(1, h(2, 3)); }", ["arm::helper/2"]),
        ("other::Old * o; Old * p;", []),
        ("class Old {}; using namespace arm; Old * o;", []),
        # operators behind an object
        ("void g() { arm::Base b; b += 1; }", ["arm::Base::operator+="]),
        ("class C { arm::Arm a_; void g() { a_ += h(2); this->a_ += 1; } };", ["arm::Base::operator+="] * 2),
        ("void g(arm::Base * b, int c) { b += 1; c += 1; d += 1; }", []),
        ("void g() { arm::Base b; b -= 1; b + 1; }", []),
        # a type in no namespace, where nothing else can be so called
        ("namespace mine { ArmResult f() { return 0; } }", ["ArmResult"]),
        ("ArmResult Robot::f() {}", ["ArmResult"]),
        ("class Robot : Other { ArmResult f(); };", []),
        ("void f() { ArmResult r; }", []),
        ("using namespace other; ArmResult f();", []),
        ("using other::ArmResult; ArmResult f();", []),
        ("using ArmResult = int; ArmResult f();", []),
        ("namespace arm { ArmResult f(); }", []),
        ("namespace arm { class Old; }", []),
        ("int x = ARM_OLD(1);", ["ARM_OLD/1"]),
        ("#define ARM_OLD(x) 2\nint x = ARM_OLD(1);", []),
        # members of objects
        ("void g(arm::Arm & a) { a.went(1); }", ["arm::Base::went/1"]),
        ("void g(const std::shared_ptr<arm::Arm> & a) { a->went(1); }", ["arm::Base::went/1"]),
        ("void g(std::shared_ptr<arm::Arm> a) { a.went(1); }", []),
        ("void g(arm::Arm * a) { a->speed = 1; }", ["arm::Base::speed"]),
        ("void g(leg::Leg::SharedPtr l) { l->went(1); }", ["arm::Base::went/1"]),
        ("void g() { auto a = std::make_shared<arm::Arm>(1); a->f(1); }", ["arm::Arm::Arm/1", "arm::Arm::f/1"]),
        ("void g(std::vector<arm::Arm> v) { v[0].went(1); for (auto & a : v) { a.went(2); } v.went(3); }",
         ["arm::Base::went/1"] * 2),
        ("void g(arm::Grip<int> & grip) { grip.grab(); }", ["arm::Grip::grab/0"]),
        ("void g(Other & a) { a.went(1); } void h(arm::Arm & a) {}", []),
        ("void g(arm::Arm & a) { a.stays(); a.f(1, 2); }", ["arm::Arm::f/2"]),
        # constructors
        ("void g() { arm::Arm a(1); auto b = arm::Arm(1, 2); }", ["arm::Arm::Arm/1", "arm::Arm::Arm/2"]),
        ("arm::Arm make(int a);", []),
        ("void g() { auto b = arm::Base(); b += 1; b.went(1); }", ["arm::Base::operator+=", "arm::Base::went/1"]),
        ("void g() { auto b = arm::Base().reach(); b += 1; b.went(1); }", []),
        ("void g() { auto b = arm::Base{} - arm::Base{}; b.went(1); }", []),
        ("class M : public arm::Arm { M() : Arm(1) {} };", ["arm::Arm::Arm/1"]),
        # members of the class around
        ("class M : public arm::Arm { void g() { went(1); this->went(2); } };", ["arm::Base::went/1"] * 2),
        ("class M : public arm::Arm { void went(int a); void g() { went(1); } };", []),
        ("class M : public arm::Arm, public Strange { void g() { went(1); } };", ["?arm::Base::went/1"]),
        ("class M : public leg::Leg { void g() { old(); } };", ["leg::Leg::old/0"]),
        ("class N { void g() { went(1); } };", []),
        ("class M : public arm::Arm { void g() { auto went = [&](int a) {}; went(1); } };", []),
        # overrides
        ("class M : public arm::Arm { void tick() override; };", ["arm::Base::tick/0!"]),
        ("class M : public arm::Arm { void tick(double dt) {} void g() { x.tick(); } };", ["arm::Base::tick/1!"]),
        ("class K : public arm::Arm {}; class M : public K { void tick(); };", ["arm::Base::tick/0!"]),
        # what cannot be told
        ("void g() { arm::Arm a(std::map<int, std::function<void(int)>>{}); }", ["arm::Arm::Arm/-1"]),
    ],
)  # fmt: skip
def test_what_is_found(text, found, changes):
    if any(one.endswith("/-1") for one in found):
        found = []  # that the number of arguments differs cannot be told
    assert uses(text, changes) == found


@pytest.mark.parametrize(
    ("text", "headers", "found"),
    [
        ("void M::g() { arm_->went(1); }", ("class M { std::unique_ptr<arm::Arm> arm_; };",), ["arm::Base::went/1"]),
        ("void M::g() { went(1); }", ("class M : public arm::Arm {};",), ["arm::Base::went/1"]),
        ("void M::g() { went(1); }", ("class M : public arm::Arm { void went(int a); };",), []),
        ("void M::g() { a_.went(1); }", ("struct M { arm::Arm a_; };", "struct N { Other a_; };"), []),
        ("void g(Hand h) { h->went(1); }", ("using Hand = std::shared_ptr<arm::Arm>;",), ["arm::Base::went/1"]),
        ("M::M() : arm::Arm(1), x_{2} { went(3); }", ("class M : public arm::Arm { int x_; };",),
         ["arm::Arm::Arm/1", "arm::Base::went/1"]),
    ],
)  # fmt: skip
def test_what_headers_tell(text, headers, found, changes):
    assert uses(text, changes, *headers) == found


def test_a_name_is_looked_for_where_its_class_can_be_meant(changes):
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes)
    assert vocabulary.can_be_meant("went", [frozenset(), frozenset({"Leg"})])
    assert not vocabulary.can_be_meant("went", [frozenset({"Grip"})])


def test_a_package_does_not_look_for_its_own_names(changes):
    assert "Old" not in Vocabulary(["arm"], "arm", changes).words


def test_names_of_the_workspace_are_known_but_not_looked_for(changes):
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes, home={"leg"})
    text = "void g(leg::Leg & l) { l.old(); l.went(1); }"
    assert [use.name for use in ApiUses(text, (), vocabulary).found(["old", "went"])] == ["arm::Base::went"]
    assert "old" not in vocabulary.words and "went" in vocabulary.words


def test_classes_namespaces_and_functions_are_told_apart():
    text = """namespace a::b { class API_EXPORT C final : public D<E, F>, virtual private G { int f() { if (x) {} } };
C::C(int x) : D{x}, y_(2) { go(); } enum class H { I }; }"""
    assert [(r.kind, r.name, r.bases) for r in regions(text) if r.kind != "other"] == [
        ("namespace", "a::b", ()),
        ("class", "C", ("D<E, F>", "G")),
        ("function", "", ()),
        ("function", "C", ()),
        ("function", "C", ()),
    ]


@pytest.mark.parametrize(
    ("argument", "shown"),
    [('"a"', "text"), ("1.5f", "float"), ("-3", "integer"), ("[this](int a) { return a; }", "lambda"), ("true", "bool"),
     ("std::bind(&A::b, this)", "bind"), ("nullptr", "null"), ("rmw_qos_profile_default", "profile"),
     ("rclcpp::SensorDataQoS()", "qos"), ("qos.get_rmw_qos_profile()", "profile"), ("this", "this"), ("x + 1", "")],
)  # fmt: skip
def test_what_an_argument_shows_itself_to_be(argument, shown):
    assert shown_as(argument) == shown


@pytest.mark.parametrize(
    ("parameter", "type_"),
    [("const A & a", "const A&"), ("const A &", "const A&"), ("int", "int"), ("unsigned int n = 3", "unsigned int"),
     ("std::vector< A > v", "std::vector<A>"), ("A * const * p", "A*const*"), ("const A", "const A")],
)  # fmt: skip
def test_the_type_of_a_parameter(parameter, type_):
    assert parameter_type(parameter) == type_
