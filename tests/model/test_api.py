"""Which uses of other packages' changing C++ names are found in a source file, as tables."""

from collections.abc import Iterator

import pytest
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.surface.compare import RepositorySurfaces
from rosimpact.databuild.surface_changes import Lines
from rosimpact.impact.facts.cpp.code import CppCode
from rosimpact.impact.facts.surface import Entity, list_offered
from rosimpact.impact.model.api import ASSIGNING, Changes, Vocabulary
from rosimpact.impact.model.cpp.resolver import Resolver
from rosimpact.impact.model.cpp.uses import ApiUses, normalise_parameter
from rosimpact.impact.targets.surface.changes import Line
from rosimpact.impact.targets.surface.surface import BuildSurface, Header, InstalledProgram, PythonSurface, Surface
from rosimpact.impact.targets.unpacked import read_packed

from tests.model.known_files import make_known

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


class Asked:
    """One version of every package, which a target has or only an update of it brings."""

    def __init__(self, version: str, ahead: bool):
        self._versions = ((version, ahead),)

    def list_asked(self, package: str, ros: int) -> tuple[tuple[str, bool], ...]:
        return self._versions


class Declared:
    """What both versions of a package declare, as its history tells it."""

    versions = ("1.0.0", "2.0.0")
    converting = frozenset()

    def is_understood(self, name: str) -> bool:
        return True

    def has_announced(self, name: str, version: str) -> bool:
        return False

    def __init__(self, codes: tuple[str, str]):
        self._of = dict(zip(self.versions, (header(code.encode()) for code in codes), strict=True))

    def iterate_entities(self, name: str, version: str) -> Iterator[Entity]:
        return (entity for entity in list_offered([self._of[version]]) if entity.name == name)


def changes_of(packages: dict[str, tuple[str, str]], asked: Asked | None = None) -> Changes:
    """What changed from the first to the second version of packages, given the code of their headers. asked: as in
    Changes."""
    lines = Lines()
    for number, version in enumerate(("1.0.0", "2.0.0")):
        surfaces = {}
        for package, codes in packages.items():
            path = f"{package}/a.hpp"
            build = BuildSurface(package, version, headers=(Header(path, f"include/{path}", path),))
            surfaces[package] = Surface(package, version, build, PythonSurface(package),
                                        ((path, header(codes[number].encode())),))  # fmt: skip
        state = RepositorySurfaces(surfaces)
        for package in surfaces:
            lines.add(package, version, (2,), state)
    packed = lines.pack_lines()
    histories = {package: Declared(codes) for package, codes in packages.items()}
    return Changes(
        lambda package: {2: read_packed(packed[package, 2], Line)} if (package, 2) in packed else {},
        asked,
        lambda package, ros: histories.get(package),
    )


@pytest.fixture(scope="module")
def changes() -> Changes:
    return changes_of({"arm": ARM, "leg": LEG})


def resolver(text: str, vocabulary: Vocabulary, *headers: str) -> Resolver:
    return Resolver([make_known(one) for one in (text, *headers)], vocabulary, None)


def uses(text: str, changes: Changes, *headers: str) -> list[str]:
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes)
    words = [word for word in sorted(vocabulary.select_wanted(vocabulary.words)) if word in text or word in ASSIGNING]
    found = ApiUses(resolver(text, vocabulary, *headers), {"arm", "leg"}).find_uses(words)
    told = []
    for use in sorted(found, key=lambda use: use.at):
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
        ("void g() { using arm::Old; Old * o; }", ["arm::Old"] * 2),
        ("void g() { Old * o; using arm::Old; }", ["arm::Old"]),
        ("void g() { { using arm::Old; } Old * o; }", ["arm::Old"]),
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
        ("class M : public arm::Arm { M() : Arm{1} {} };", ["arm::Arm::Arm/1"]),
        ("void g() { arm::Arm a{1, 2}; arm::Arm b = {1}; auto c = arm::Arm{1}; new arm::Arm{1}; }",
         ["arm::Arm::Arm/2", *["arm::Arm::Arm/1"] * 3]),
        ("class C { arm::Arm a_{1, 2}; arm::Arm b_[2]{1, 2}; };", ["arm::Arm::Arm/2"]),
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
        ("class K {}; namespace n { class K : public arm::Arm {}; void g(K & k) { k.went(1); } }",
         ["arm::Base::went/1"]),
        ("class K : public arm::Arm {}; namespace n { class K {}; void g(K & k) { k.went(1); } }", []),
        ("class K : public arm::Arm {}; namespace n { class K {}; void g(::K & k) { k.went(1); } }",
         ["arm::Base::went/1"]),
        ("class K : public arm::Arm {}; namespace n { class K : public ::K { void tick(); }; }",
         ["arm::Base::tick/0!"]),
        ("namespace n { class K : public ::arm::Arm { void tick(); }; }", ["arm::Base::tick/0!"]),
        ("void g() { arm::Arm a(std::map<int, std::function<void(int)>>{}, 1); }", ["arm::Arm::Arm/2"]),
        # how many arguments a pack has cannot be told
        ("template<class... T> void g(arm::Base & b, T... t) { b.went(t...); }", ["arm::Base::went/-1"]),
    ],
)  # fmt: skip
def test_what_is_found(text, found, changes):
    assert uses(text, changes) == found


@pytest.mark.parametrize(
    ("text", "first", "second", "update"),
    [
        # text, what is found where a target has the first version, the second, or an update brings the second
        ("arm::Old * o;", [], ["arm::Old"], ["arm::Old"]),
        ("void g(arm::Arm & a) { a.went(1); }", [], ["arm::Base::went/1"], ["arm::Base::went/1"]),
        ("void g(arm::Arm & a) { a.f(1); }", [], ["arm::Arm::f/1"], ["arm::Arm::f/1"]),
        ("void g(arm::Arm & a) { a.f(1, 2); }", ["arm::Arm::f/2"], [], []),
        ("void g(arm::Arm & a) { a.f(1, 2, 3); }", [], [], []),
        ("void g(arm::Arm & a) { a.f(h(1, 2) /* , */, h(\"a,b\")); }", ["arm::Arm::f/2"], [], []),
        ("void g() { auto a = std::make_shared<arm::Arm>(1); }", [], ["arm::Arm::Arm/1"], ["arm::Arm::Arm/1"]),
        ("void g() { auto a = std::make_shared<arm::Arm>(1, 2); }", ["arm::Arm::Arm/2"], [], []),
        ("void g() { arm::Base b; b += 1; }", ["arm::Base::operator+="], [], []),
        # whether an override is one is left to the rule, where the version or one beside it has another form
        *[(f"class M : public arm::Arm {{ void tick({given}); }};", *[[f"arm::Base::tick/{count}!"]] * 3)
          for given, count in (("", 0), ("double d", 1))],
    ],
)  # fmt: skip
def test_what_is_found_is_what_may_be_wrong_in_the_versions_asked_about(text, first, second, update):
    packages = {"arm": ARM, "leg": LEG}
    assert uses(text, changes_of(packages, Asked("1.0.0", False))) == first
    assert uses(text, changes_of(packages, Asked("2.0.0", False))) == second
    assert uses(text, changes_of(packages, Asked("2.0.0", True))) == update


@pytest.mark.parametrize(
    ("text", "headers", "found"),
    [
        ("void M::g() { arm_->went(1); }", ("class M { std::unique_ptr<arm::Arm> arm_; };",), ["arm::Base::went/1"]),
        ("void M::g() { went(1); }", ("class M : public arm::Arm {};",), ["arm::Base::went/1"]),
        ("void M::g() { went(1); }", ("class M : public arm::Arm { void went(int a); };",), []),
        ("void M::g() { a_.went(1); }", ("struct M { arm::Arm a_; };", "struct N { Other a_; };"),
         ["arm::Base::went/1"]),
        ("void N::g() { a_.went(1); }", ("struct M { arm::Arm a_; };", "struct N { Other a_; };"), []),
        ("void g(Hand h) { h->went(1); }", ("using Hand = std::shared_ptr<arm::Arm>;",), ["arm::Base::went/1"]),
        ("M::M() : arm::Arm(1), x_{2} { went(3); }", ("class M : public arm::Arm { int x_; };",),
         ["arm::Arm::Arm/1", "arm::Base::went/1"]),
        ("void g(Grab & a) { a.f(1); }", ("class Holder { using Grab = arm::Arm; };",), ["arm::Arm::f/1"]),
        ("void g(Grab & a) { a.f(1); }",
         ("class Holder { using Grab = arm::Arm; };", "class Other { using Grab = arm::Base; };"), []),
        ("namespace n::m { void g(K & k) { k.went(1); } }",
         ("namespace o { class K {}; } namespace n { class K : public arm::Arm {}; }",), ["arm::Base::went/1"]),
        ("namespace o { void g(K & k) { k.went(1); } }",
         ("namespace o { class K {}; } namespace n { class K : public arm::Arm {}; }",), []),
    ],
)  # fmt: skip
def test_what_headers_tell(text, headers, found, changes):
    assert uses(text, changes, *headers) == found


# `stop` is pure in the second version alone, `go` in both.
PART = (
    "namespace part { class Base { public: virtual void go() = 0; virtual void stop(); }; }",
    "namespace part { class Base { public: virtual void go() = 0; virtual void stop() = 0; }; }",
)


@pytest.mark.parametrize(
    ("text", "headers", "found"),
    [
        ("namespace n { class M : public part::Base { void go() override; }; }", (), ["part::Base::stop"]),
        ("namespace n { class M : public part::Base { void go(); void stop(); }; }", (), []),
        ("namespace n { class O : public part::Base { void go(); }; }", (), []),  # nobody exports it
        ("namespace n { class M : public Own { void go(); }; }", ("class Own : public part::Base {};",),
         ["part::Base::stop"]),
        ("namespace n { class M : public Own { void go(); }; }", ("class Own : public part::Base { void stop(); };",),
         []),
        ("namespace n { template<class T> class M : public part::Base { void go(); }; }", (), []),
    ],
)  # fmt: skip
def test_what_an_exported_class_does_not_implement(text, headers, found):
    vocabulary = Vocabulary(["part"], "mine", changes_of({"part": PART}))
    assert [use.name for use in ApiUses(resolver(text, vocabulary, *headers)).find_unimplemented({"n::M"})] == found


def test_a_name_is_looked_for_where_its_class_can_be_meant(changes):
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes)
    assert vocabulary.can_be_meant("went", [frozenset(), frozenset({"Leg"})])
    assert not vocabulary.can_be_meant("went", [frozenset({"Grip"})])


def test_a_package_does_not_look_for_its_own_names(changes):
    assert "Old" not in Vocabulary(["arm"], "arm", changes).words


def test_names_of_the_workspace_are_known_but_not_looked_for(changes):
    vocabulary = Vocabulary(["arm", "leg"], "mine", changes, home={"leg"})
    text = "void g(leg::Leg & l) { l.old(); l.went(1); }"
    assert [use.name for use in ApiUses(resolver(text, vocabulary)).find_uses(["old", "went"])] == ["arm::Base::went"]
    assert "old" not in vocabulary.words and "went" in vocabulary.words


@pytest.mark.parametrize(
    ("argument", "shown"),
    [('"a"', "text"), ("1.5f", "float"), ("-3", "integer"), ("[this](int a) { return a; }", "lambda"), ("true", "bool"),
     ("std::bind(&A::b, this)", "bind"), ("nullptr", "null"), ("rmw_qos_profile_default", "profile"),
     ("rclcpp::SensorDataQoS()", "qos"), ("qos.get_rmw_qos_profile()", "profile"), ("this", "this"),
     ("*this", "*this"), ("*other", ""), ("!true", ""), ("x + 1", ""), ("100ms", ""), ('"a"s', "")],
)  # fmt: skip
def test_what_an_argument_shows_itself_to_be(argument, shown, changes):
    vocabulary = Vocabulary(["arm"], "mine", changes)
    found = resolver(f"class C {{ void g() {{ call({argument}); }} }};", vocabulary)
    (use,) = found.known.list_uses(found.known.list_mentions(["call"]))
    assert ApiUses(found).classify(use.call[0], use.place) == shown


@pytest.mark.parametrize(
    ("before", "shown"),
    [("static rmw_qos_profile_t v = f();", "profile"), ("const rclcpp::QoS & v = f();", "qos"),
     ("auto v = rmw_qos_profile_default;", "profile"), ("auto v = rclcpp::SensorDataQoS();", "qos"),
     ("auto v = f();", ""), ("QoS v(3);", ""), ("", "profile"),
     ("auto v =\n#if A\n rclcpp::QoS(1);\n#else\n rmw_qos_profile_default;\n#endif\n", ""),
     ("#if A\n rclcpp::QoS v;\n#else\n rmw_qos_profile_t v;\n#endif\n", "")],
)  # fmt: skip
def test_what_a_variable_shows_itself_to_be(before, shown, changes):
    vocabulary = Vocabulary(["arm"], "mine", changes)
    found = resolver(f"class C {{ rmw_qos_profile_t v; void g() {{\n{before} call(v); }} }};", vocabulary)
    (use,) = found.known.list_uses(found.known.list_mentions(["call"]))
    assert ApiUses(found).classify(use.call[0], use.place) == shown


# What is put into it is a tool, then a pose; what it is moved to a message, then another.
RACK = """namespace rack {{ struct Tool {{ void turn({}); }}; struct Pose {{}}; struct Rack {{
void put({}); void move(const a_msgs::msg::{} & m); void hang({}); Tool tool(); Tool first; }}; }}"""
RACKS = (RACK.format("", "const Tool & t", "A", "Unseen u"), RACK.format("int a", "const Pose & p", "B", "Other o"))


@pytest.mark.parametrize(
    ("text", "given"),
    [
        ("void g(rack::Rack r, const rack::Tool & t) { r.put(t); }", ["rack::Tool"]),
        ("void g(rack::Rack r) { rack::Pose p; r.put(p); r.put(rack::Pose{}); r.put(rack::Pose()); }",
         ["rack::Pose"] * 3),
        ("void g(rack::Rack r) { r.put(r.tool()); auto t = r.first; r.put(std::move(t)); }", ["rack::Tool"] * 2),
        ("void g(rack::Rack r, a_msgs::msg::A a) { r.move(a); }", ["a_msgs::msg::A"]),
        ("class C { a_msgs::msg::B b_; void g(rack::Rack r) { r.move(b_); } };", ["a_msgs::msg::B"]),
        # what is no object of such a class, or may be another where a directive decides
        ("void g(rack::Rack r, rack::Tool * t) { r.put(t); r.put(f()); }", []),
        ("struct Tool : rack::Tool {}; void g(rack::Rack r, Tool t) { r.put(t); }", []),
        ("namespace rack { struct Tool {}; } void g(rack::Rack r, rack::Tool t) { r.put(t); }", []),
        ("void g(rack::Rack r, std::vector<rack::Tool> t) { r.put(t); r.put({t}); r.put(rack::Grip<int>()); }", []),
        ("void g(rack::Rack r) {\n#if A\n rack::Tool t;\n#else\n rack::Pose t;\n#endif\n r.put(t); }", []),
        ("void g(rack::Rack r, a_msgs::msg::A::SharedPtr a) { r.move(a); r.hang(r.tool()); }", []),
    ],
)
def test_which_objects_of_classes_are_given(text, given):
    vocabulary = Vocabulary(["rack"], "mine", changes_of({"rack": RACKS}, Versions("1.0.0", "2.0.0")))
    uses = ApiUses(resolver(text, vocabulary), {"rack"}).find_uses(["hang", "move", "put"])
    assert [one for use in sorted(uses, key=lambda use: use.at) for one in use.given] == given


@pytest.mark.parametrize(
    ("version", "read"), [("1.0.0", ["put", "move"]), ("2.0.0", ["put", "move"])]
)
def test_a_file_is_parsed_where_an_argument_may_be_refused(version, read):
    vocabulary = Vocabulary(["rack"], "mine", changes_of({"rack": RACKS}, Asked(version, False)))
    known = resolver("void g(rack::Rack r) { r.put(a); r.put(1); r.move(b); r.hang(c); }", vocabulary)
    uses, mentions = ApiUses(known, {"rack"}), known.known.list_mentions(["put", "move", "hang"])
    assert [one.word for one in mentions if uses._may_matter(one)] == read


# How many template arguments they have differs, of `keep` alone not.
SHELF = """namespace shelf {{ template<class A{}> class Shelf {{}}; template<class A> class Keep {{ {} f(); }};
template<class A{}> void lay(int a); template<class... A> void stack(A... {}); class Plain {{}}; }}"""
SHELVES = (SHELF.format("", "int", ", class B", "a"), SHELF.format(", class B = int", "bool", "", "b"))


@pytest.mark.parametrize(
    ("text", "first", "second"),
    [
        # text, and how many template arguments what is found has where a target has the first version, or the second
        ("shelf::Shelf<int, std::vector<int>> s;", [2], []),
        ("using namespace shelf; Shelf<int, f(1, 2)> s;", [2], []),
        ("std::shared_ptr<shelf::Shelf<int, int>> s; class C : shelf::Shelf<a, b> { C(); };", [2, 2], []),
        ("shelf::Shelf<int> s; shelf::Shelf t;", [], []),
        ("shelf::Shelf<> s;", [0], [0]),
        ("template<class... T> void g(shelf::Shelf<T...> s);", [], []),
        ("void g() { shelf::lay<int, int>(1); shelf::lay<int>(1); shelf::lay(1); }", [], [2]),
        ("void g() { shelf::stack<int, int>(1, 2); shelf::Keep<int, int> k; }", [], []),
        ("template<> class shelf::Shelf<int, bool> {};", [], []),
    ],
)  # fmt: skip
def test_how_many_template_arguments_are_found(text, first, second):
    for version, found in (("1.0.0", first), ("2.0.0", second)):
        vocabulary = Vocabulary(["shelf"], "mine", changes_of({"shelf": SHELVES}, Asked(version, False)))
        uses = ApiUses(resolver(text, vocabulary), {"shelf"}).find_uses(["Shelf", "Keep", "lay", "stack"])
        assert [use.templated for use in sorted(uses, key=lambda use: use.at)] == found


@pytest.mark.parametrize(
    ("parameter", "type_"),
    [("const A & a", "const A&"), ("const A &", "const A&"), ("int", "int"), ("unsigned int n = 3", "unsigned int"),
     ("std::vector< A > v", "std::vector<A>"), ("A * const * p", "A*const*"), ("const A", "const A")],
)  # fmt: skip
def test_the_type_of_a_parameter(parameter, type_):
    (function,) = CppCode(f"void f({parameter});".encode()).declarations.names
    assert [normalise_parameter(one) for one in function.parameters] == [type_]


@pytest.mark.parametrize(
    ("text", "names", "members"),
    [
        ("enum Mode { A };", [("type", "", "Mode"), ("enumerator", "", "A")], []),
        ("enum class Mode { A };", [("type", "", "Mode"), ("enumerator", "Mode", "A")], []),
        ("class C { enum Mode { A }; };", [], [("type", "C", "Mode"), ("enumerator", "C", "A")]),
        ("class C { enum struct Mode { A } m; };", [("enumerator", "C::Mode", "A")],
         [("type", "C", "Mode"), ("variable", "C", "m")]),
    ],
)  # fmt: skip
def test_enumerators_stand_beside_an_enum_or_in_it(text, names, members):
    file = CppCode(text.encode()).declarations
    inside = [one for cls in file.classes for those in cls.members.values() for one in those]
    assert [[(one.kind, one.scope, one.name) for one in those] for those in (file.names, inside)] == [names, members]


@pytest.mark.parametrize(
    ("before", "after", "found"),
    [
        ("Can(int a, int b);", "Can(int a, int b, int c);", ["can::Can::Can/2"]),
        # an aggregate, now or before; a list of any length; what the compiler could write itself
        ("", "Can(int a, int b);", []),
        ("Can(int a, int b);", "", []),
        ("Can(int a);", "Can(std::initializer_list<int> all);", []),
        ("Can(int a, int b);", "Can() = default; Can(const Can & other) = default;", []),
    ],
)
def test_braces_may_be_those_of_an_aggregate(before, after, found):
    header = "namespace can {{ struct Can {{ int a; int b; {0} }}; }}"
    changes = changes_of({"can": (header.format(before), header.format(after))}, Versions("1.0.0", "2.0.0"))
    vocabulary = Vocabulary(["can"], "mine", changes)
    uses = ApiUses(resolver("void g() { can::Can c{1, 2}; }", vocabulary), {"can"}).find_uses(["Can"])
    assert [f"{use.name}/{use.arguments}" for use in uses if use.how == "call"] == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("class C { arm::Arm a_; C() : a_(1), b_(2) {} };", ["arm::Arm::Arm/1"]),
        ("class C { arm::Arm a_; C() : a_{1, 2} {} };", ["arm::Arm::Arm/2"]),
        ("void g() { std::vector<arm::Arm> v; v.emplace_back(1, 2); v.push_back(1); }", ["arm::Arm::Arm/2"]),
        ("void g(std::optional<arm::Arm> & o) { o.emplace(1); }", ["arm::Arm::Arm/1"]),
        ("void g(std::vector<arm::Arm *> v, Other w) { v.emplace_back(1, 2); w.emplace_back(1); }", []),
        ("void g(std::vector<arm::Arm> v) { v.emplace(v.begin(), 1); }", []),
    ],
)
def test_constructors_that_are_called_without_their_name(text, found, changes):
    vocabulary = Vocabulary(["arm"], "mine", changes)
    known = resolver(text, vocabulary)
    uses = ApiUses(known).find_initialized(vocabulary.constructed, known.files)
    assert [f"{use.name}/{use.arguments}" for use in uses] == found


DRILL = "class Drill {{ public: void spin(int a{0}); }};"
BOX = """class Box {{ public: void close({0}); std::shared_ptr<Drill> drill() const;
std::shared_ptr<const Drill> drill(); Drill first; typedef Drill Any; template<class T> Drill pick();
std::vector<Drill> all(); {1} other(); typedef Box::Round Ring; typedef Box::Ring Round; }};
class Chest : public Box {{}};"""
WORKSHOP = (
    f"namespace shop {{ {DRILL.format('')} {BOX.format('', 'Drill')} }}",
    f"namespace shop {{ {DRILL.format(', int b')} {BOX.format('int a', 'Box')} }}",
)
SPIN = ["shop::Drill::spin/1"]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("void g(shop::Box b) { b.drill()->spin(1); }", SPIN),
        ("void g(shop::Box b) { auto d = b.drill(); d->spin(1); }", SPIN),
        ("void g(shop::Box b) { b.first.spin(1); }", SPIN),
        ("void g(shop::Box b) { b.all()[0].spin(1); for (auto & one : b.all()) one.spin(1); }", SPIN * 2),
        ("void g() { shop::Box::Any d; d.spin(1); }", SPIN),
        ("void g(shop::Chest b) { b.drill()->spin(1); }", SPIN),
        ("void g() { shop::Box::Ring r; r.spin(1); }", []),  # it stands for itself in the end
        # of a class of this package that has it of its base
        ("class C : public shop::Box { void g() { drill()->spin(1); this->first.spin(1); } };", SPIN * 2),
        ("class C : public shop::Box { void g() { first.spin(1); } };", SPIN),
        ("class C : public shop::Box { void g(Other first) { first.spin(1); } };", []),
        ("class C : public shop::Box, Other { void g() { drill()->spin(1); } };", []),
        ("class C : public shop::Box { int drill(); void g() { drill()->spin(1); } };", []),
        # through pairs, tuples, iterators and nested containers
        ("void g(std::map<int, shop::Drill> m) { auto it = m.find(1); it->second.spin(1); m.end()->second.spin(1); }",
         SPIN * 2),
        ("void g(std::map<int, shop::Drill> m) { for (auto & p : m) p.second.spin(1); m[0].spin(1); }", SPIN * 2),
        ("void g(std::map<int, shop::Drill> m) { for (auto & [k, v] : m) { k.spin(1); v.spin(1); } }", SPIN),
        ("void g(std::map<shop::Drill, int> m) { for (auto & [k, v] : m) { k.spin(1); v.spin(1); } m[0].spin(1); }",
         SPIN),
        ("using M = std::map<int, shop::Drill>; void g(M m) { for (M::iterator it = m.begin();;) it->second.spin(1); }",
         SPIN),
        ("void g(std::vector<shop::Drill> v) { for (auto it = v.begin();; ++it) { it->spin(1); (*it).spin(1); } }",
         SPIN * 2),
        ("void g(std::vector<shop::Drill *> v) { auto it = v.begin(); (*it)->spin(1); it->spin(1); v[0]->spin(1); }",
         SPIN * 2),
        ("void g(std::vector<std::vector<shop::Drill>> v) { v[0][1].spin(1); v[0].spin(1); v.at(0).back().spin(1); }",
         SPIN * 2),
        ("void g(std::vector<shop::Drill> v) { auto it = std::find_if(v.begin(), v.end(), f); it->spin(1); }", SPIN),
        ("void g(std::pair<int, shop::Drill> p) { auto [a, b] = p; a.spin(1); b.spin(1); p.second.spin(1); }",
         SPIN * 2),
        ("void g(std::tuple<int, shop::Drill> t) { std::get<0>(t).spin(1); std::get<1>(t).spin(1); }", SPIN),
        ("void g(std::vector<std::pair<int, shop::Drill>> v) { for (auto & [a, b] : v) b.spin(1); }", SPIN),
        ("void g(std::variant<int, shop::Drill> v) { std::get<1>(v).spin(1); std::get_if<1>(&v)->spin(1); }", SPIN * 2),
        ("void g() { auto & d = std::get<shop::Drill>(f()); d.spin(1); std::get_if<shop::Drill>(f())->spin(1); }",
         SPIN * 2),
        ("void g(std::tuple<shop::Drill> t) { std::get<int>(t).spin(1); std::get<N>(t).spin(1); get<0>(t).spin(1); }",
         []),
        # through what maps give back of what is put into them
        *[(f"void g(std::map<int, shop::Drill> m) {{ auto r = m.{put}; r.first->second.spin(1); r->second.spin(1); }}",
           SPIN) for put in ("insert({1, d})", "emplace(1, d)", "try_emplace(1)", "insert_or_assign(1, d)")],
        ("void g(std::map<int, shop::Drill> m) { auto [at, made] = m.emplace(1, d); at->second.spin(1); at->spin(1); }",
         SPIN),
        ("void g(std::map<int, shop::Drill> m) { m.emplace_hint(m.end(), 1, d)->second.spin(1); }", SPIN),
        ("void g(std::vector<shop::Drill> v) { v.emplace_back().spin(1); v.insert(v.end(), d).first->spin(1); }", SPIN),
        # through structured bindings of this package's structs
        ("struct S { static int n; int a; shop::Drill b; int f(); }; void g(S s) { auto & [x, y] = s; y.spin(1); }",
         SPIN),
        ("struct S { int a; shop::Drill b; }; void g(std::vector<S> v) { for (auto [x, y] : v) { x.spin(1); } }", []),
        ("struct R { shop::Drill a; }; struct S : R { void f(); }; void g(S s) { auto [x] = s; x.spin(1); }", SPIN),
        ("template<class T> struct S { int a; T b; }; void g(S<shop::Drill> s) { auto [x, y] = s; y.spin(1); }", SPIN),
        ("struct S {\n#if A\n int a;\n#endif\n shop::Drill b, c; }; void g(S s) { auto [x, y] = s; y.spin(1); }", []),
        ("struct S { int a; shop::Drill b; }; template<> struct std::tuple_size<S>;"
         " void g(S s) { auto [x, y] = s; y.spin(1); }", []),
        # through parameters of lambdas that algorithms call
        *[(f"void g(std::vector<shop::Drill> v) {{ {call}; }}", SPIN) for call in (
            "std::for_each(v.begin(), v.end(), [](auto & d) { d.spin(1); })",
            "std::any_of(std::begin(v), std::end(v), [&](const auto & d) { return d.spin(1); })",
            "v.erase(std::remove_if(v.begin(), v.end(), [](auto && d) { return d.spin(1); }), v.end())",
            "std::transform(v.begin(), v.end(), w.begin(), out, [](auto d, auto e) { e.spin(1); return d.spin(1); })",
            "std::accumulate(v.begin(), v.end(), 0, [](auto sum, auto & d) { sum.spin(1); return sum + d.spin(1); })",
            "std::erase_if(v, [](auto & d) { return d.spin(1); })",
            "for (auto & w : v) std::for_each(u.begin(), u.end(), [&](auto & v) { v.spin(1); w.spin(1); })",
        )],
        ("void g(std::vector<shop::Drill> v) { std::sort(v.begin(), v.end(), [](auto & a, auto & b) {"
         " return a.spin(1) < b.spin(1); }); }", SPIN * 2),
        ("void g(std::map<int, shop::Drill *> m) { std::count_if(m.cbegin(), m.cend(), [](auto & p) {"
         " return p.second->spin(1); }); }", SPIN),
        *[(f"void g(std::vector<shop::Drill> v) {{ {call}; }}", []) for call in (
            "mine::for_each(v.begin(), v.end(), [](auto & d) { d.spin(1); })",
            "std::for_each(f(v), f(v), [](auto & d) { d.spin(1); })",
            "std::for_each(v.begin(), v.end(), h([](auto & d) { d.spin(1); }))",
            "auto f = [](auto & d) { d.spin(1); }",
        )],
        ("void g(std::weak_ptr<shop::Drill> p) { if (auto q = p.lock()) q->spin(1); p->spin; }", SPIN),
        ("void g(std::optional<shop::Drill> p) { p.value().spin(1); if (auto q = p; q) q->spin(1); }", SPIN * 2),
        ("void g() { auto [a, b] = f(); b.spin(1); for (auto & [c, d] : f()) d.spin(1); }", []),
        # a class of this package is not the one that the other package means
        ("class Drill {}; void g(shop::Box b) { b.first.spin(1); }", SPIN),
        # not the same in both versions, with template arguments, through the wrong operator, nobody's
        ("void g(shop::Box b) { b.other().spin(1); b.pick<int>().spin(1); b.drill().spin(1); b.none().spin(1); }", []),
    ],
)
def test_what_members_of_other_packages_are(text, found):
    changes = changes_of({"shop": WORKSHOP}, Versions("1.0.0", "2.0.0"))
    vocabulary = Vocabulary(["shop"], "mine", changes)
    uses = ApiUses(resolver(text, vocabulary), {"shop"}).find_uses(["spin"])
    assert [f"{use.name}/{use.arguments}" for use in uses] == found


class Versions:
    """Several versions of every package, which targets have."""

    def __init__(self, *versions: str):
        self._versions = tuple((version, False) for version in versions)

    def list_asked(self, package: str, ros: int) -> tuple[tuple[str, bool], ...]:
        return self._versions


@pytest.mark.parametrize(
    ("has_headers", "programs", "gone"),
    [(True, 1, {"away::Sled"}), (False, 1, set()), (False, 0, {"away::Sled"})],
)
def test_names_of_a_version_that_was_read_without_its_headers_are_not_gone(has_headers, programs, gone):
    lines = Lines()
    for version, code in (("1.0.0", "namespace away { struct Sled {}; }"), ("2.0.0", "")):
        there = (Header("a.hpp", "include/a.hpp", "a.hpp"),) if code or has_headers else ()
        read = tuple(("a.hpp", header(code.encode())) for _ in there)
        made = (InstalledProgram("sled", "bin", "binary"),) * programs
        build = BuildSurface("away", version, headers=there, programs=made)
        state = RepositorySurfaces({"away": Surface("away", version, build, PythonSurface("away"), read)})
        lines.add("away", version, (2,), state)
    events = read_packed(lines.pack_lines()["away", 2], Line).events
    assert {name for name, found in events.get("c++", {}).items() if any(e.has is None for e in found)} == gone
    assert ("header" in events) == (not has_headers and bool(gone))


def test_names_that_are_back_after_a_version_without_its_headers_are_not_new():
    lines = Lines()
    once = "namespace away { struct Sled {}; struct Rope {}; }"
    later = "namespace away { struct Sled {}; struct Bell {}; }"
    for version, code in (("1.0.0", once), ("2.0.0", ""), ("3.0.0", later)):
        there = (Header("a.hpp", "include/a.hpp", "a.hpp"),) if code else ()
        read = tuple(("a.hpp", header(code.encode())) for _ in there)
        build = BuildSurface("away", version, headers=there, programs=(InstalledProgram("sled", "bin", "binary"),))
        lines.add("away", version, (2,), RepositorySurfaces(
            {"away": Surface("away", version, build, PythonSurface("away"), read)}
        ))  # fmt: skip
    events = read_packed(lines.pack_lines()["away", 2], Line).events
    told = {name: [each.kind for event in found for each in event.reported] for name, found in events["c++"].items()}
    assert told == {"away::Rope": ["removed"], "away::Bell": ["added"]}
    assert "header" not in events
