"""What a target's version of a package offers beside what others do: gone, not there yet, changed, on its way out."""

from types import SimpleNamespace

import pytest
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.extract.python import extract as module
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.compare import RepositorySurfaces
from rosimpact.databuild.surface_file import write
from rosimpact.impact.targets.surface.offers import Offers, list_declared
from rosimpact.impact.targets.surface.offers_cpp import check_use
from rosimpact.impact.targets.surface.store import Surfaces
from rosimpact.impact.targets.surface.surface import (
    BuildSurface,
    Header,
    InstalledLaunchFile,
    InstalledModule,
    InstalledProgram,
    PythonSurface,
    Surface,
)


def surface(package, version, code="", python="", programs=(), path="", launches=()):
    path = path or f"{package}/a.hpp"
    build = BuildSurface(
        package,
        version,
        headers=(Header(path, f"include/{path}", path),),
        programs=tuple(InstalledProgram(name, f"lib/{package}", "binary") for name in programs),
        launches=tuple(InstalledLaunchFile(path) for path in launches),
    )
    modules = (InstalledModule(package, f"{package}/__init__.py", True, module(python.encode())),) if python else ()
    return Surface(package, version, build, PythonSurface(package, modules), ((path, header(code.encode())),))


def target(ros=2, **versions):
    return SimpleNamespace(ros=ros, find_version=versions.get)


@pytest.fixture
def store(tmp_path):
    """A function that stores surfaces, each of a state of its own unless several are given as one, in order."""

    def made(*states, generations=(2,), approximate=()):
        packing = Packing()
        for state in states:
            together = RepositorySurfaces(
                {one.package: one for one in (state if isinstance(state, tuple) else (state,))}
            )
            for one in together.surfaces.values():
                packing.add(one.package, one.version, generations, together, one.version in approximate)
        file = tmp_path / "surfaces.sqlite"
        write(file, packing.pack_packages())
        return Surfaces(file)

    return made


def test_gone_not_there_yet_and_everywhere(store):
    surfaces = store(
        surface("arm", "1.0.0", "void always(); void old();"),
        surface("arm", "2.0.0", "void always(); void old();"),
        surface("arm", "3.0.0", "void always(); void fresh();"),
    )
    early, late = (Offers(target(arm=v), surfaces).find_package("arm") for v in ("2.0.0", "3.0.0"))
    gone = late.get("c++", "old")
    assert (gone.state, gone.last, gone.first, gone.version, gone.sure) == ("removed", "2.0.0", "3.0.0", "3.0.0", True)
    assert (early.get("c++", "old").state, early.get("c++", "old").gone_in) == ("changed", "3.0.0")
    awaited = early.get("c++", "fresh")
    assert (awaited.state, awaited.first, awaited.here) == ("absent", "3.0.0", None)
    assert early.get("c++", "always") is None and early.get("c++", "never") is None
    assert [one.name for one in late.list_offered("c++")] == ["fresh", "old"]


def test_what_goes_and_comes_back_is_there(store):
    surfaces = store(
        *(surface("arm", f"{n}.0.0", code) for n, code in enumerate(("", "void f();", "", "void f();"), 1))
    )
    states = [Offers(target(arm=f"{n}.0.0"), surfaces).find_package("arm").get("c++", "f").state for n in (1, 2, 3, 4)]
    assert states == ["absent", "changed", "removed", "changed"]


def test_forms_say_how_a_function_is_called(store):
    surfaces = store(
        surface("arm", "1.0.0", "struct A { void f(int a, double b = 0); };"),
        surface("arm", "2.0.0", "struct A { void f(int a, double b, bool c); };"),
    )
    old, new = (Offers(target(arm=v), surfaces).find_package("arm").get("c++", "A::f") for v in ("1.0.0", "2.0.0"))
    assert [(o.fewest, o.most, o.types) for o in new.here.overloads] == [(3, 3, ("int", "double", "bool"))]
    assert [(o.fewest, o.most) for o in new.before.overloads] == [(1, 2)]
    assert old.here == new.before and old.after == new.here and (old.coming, new.last) == ("2.0.0", "1.0.0")
    package = Offers(target(arm="2.0.0"), surfaces).find_package("arm")
    assert list_declared(package.history, "c++", "A::f", "1.0.0") == ("void A::f(int, double = 0)",)


def test_an_overload_that_goes_leaves_the_name(store):
    surfaces = store(surface("arm", "1.0.0", "void f(); void f(int);"), surface("arm", "2.0.0", "void f(int);"))
    found = Offers(target(arm="2.0.0"), surfaces).find_package("arm").get("c++", "f")
    assert (found.state, [o.fewest for o in found.here.overloads]) == ("changed", [1])


def test_a_member_is_told_by_its_class(store):
    surfaces = store(surface("arm", "1.0.0", "namespace n { struct A { void f(); }; }"), surface("arm", "2.0.0"))
    offers = Offers(target(arm="2.0.0"), surfaces)
    assert offers.find("c++", "n::A::f", ("leg", "arm")).name == "n::A"
    assert offers.find("c++", "n::B", ("arm",)) is None


def test_deprecated_until_it_goes(store):
    warning = '[[deprecated("use g")]] void f(); void g();'
    surfaces = store(
        surface("arm", "1.0.0", "void f(); void g();"),
        surface("arm", "2.0.0", warning),
        surface("arm", "3.0.0", "void g();"),
    )
    found = Offers(target(arm="2.0.0"), surfaces).find_package("arm").get("c++", "f")
    assert (found.state, found.here.deprecated, found.gone_in) == ("deprecated", "use g", "3.0.0")


def test_python_and_programs(store):
    surfaces = store(
        surface("arm", "1.0.0", python="def move(x): ...\ndef rest(): ...\n", programs=("drive",)),
        surface("arm", "2.0.0", python="def move(x, *, speed): ...\n", programs=()),
    )
    package = Offers(target(arm="2.0.0"), surfaces).find_package("arm")
    assert package.get("python", "arm.rest").state == "removed"
    moved = package.get("python", "arm.move")
    assert (moved.state, moved.last, moved.first) == ("changed", "1.0.0", "2.0.0")
    assert package.get("executable", "drive").state == "removed"
    assert list_declared(package.history, "python", "arm.move", "2.0.0") == ("arm.move(x, *, speed)",)


def test_what_another_package_has_now_is_moved(store):
    surfaces = store(
        (surface("arm", "1.0.0", "void f();"), surface("leg", "1.0.0")),
        (surface("arm", "2.0.0"), surface("leg", "2.0.0", "void f();")),
    )
    found = Offers(target(arm="2.0.0", leg="2.0.0"), surfaces).find_package("arm").get("c++", "f")
    assert (found.state, found.moved_to) == ("moved", "leg")


def test_a_launch_file_of_another_package_is_not_the_one_that_is_gone(store):
    file = ("launch/demo.launch",)
    surfaces = store(
        (surface("arm", "1.0.0", launches=file), surface("leg", "1.0.0", launches=file)),
        (surface("arm", "2.0.0"), surface("leg", "2.0.0", launches=file)),
    )
    found = Offers(target(arm="2.0.0", leg="2.0.0"), surfaces).find_package("arm").get("launch file", *file)
    assert (found.state, found.moved_to) == ("removed", "")


def test_declarations_of_python_modules_and_values(store):
    surfaces = store(surface("arm", "1.0.0", python="SPEED = 2\n"))
    package = Offers(target(arm="1.0.0"), surfaces).find_package("arm")
    assert list_declared(package.history, "python", "arm", "1.0.0") == ()
    assert list_declared(package.history, "python", "arm.SPEED", "1.0.0") == ("arm.SPEED = 2",)


def test_what_another_repository_has_is_moved_where_the_target_has_that(store):
    surfaces = store(
        surface("arm", "1.0.0", "void f();"), surface("arm", "2.0.0"), surface("leg", "5.0.0", "void f();")
    )
    with_leg, without = target(arm="2.0.0", leg="5.0.0"), target(arm="2.0.0")
    assert Offers(with_leg, surfaces).find_package("arm").get("c++", "f").moved_to == "leg"
    assert Offers(without, surfaces).find_package("arm").get("c++", "f").state == "removed"


def test_a_version_that_is_not_stored_is_sure_only_between_equal_ones(store):
    surfaces = store(
        surface("arm", "1.0.0", "void f(); void g();"),
        surface("arm", "2.0.0", "void g();"),
        surface("arm", "4.0.0"),
    )
    package = Offers(target(arm="3.0.0"), surfaces).find_package("arm")
    assert (package.stored, package.exact) == ("2.0.0", False)
    assert (package.get("c++", "f").state, package.get("c++", "f").sure) == ("removed", True)
    assert not package.get("c++", "g").sure
    newer = Offers(target(arm="5.0.0"), surfaces).find_package("arm")
    assert newer.get("c++", "f").sure  # patches bring nothing back
    assert Offers(target(arm="0.1.0"), surfaces).find_package("arm") is None


def test_a_branch_answers_for_no_release(store):
    surfaces = store(surface("arm", "1.0.0", "void f();"), surface("arm", "2.0.0"), approximate=("2.0.0",))
    package = Offers(target(arm="2.0.0"), surfaces).find_package("arm")
    assert (package.stored, package.exact) == ("1.0.0", False)
    assert (package.get("c++", "f").state, package.get("c++", "f").sure) == ("changed", False)


def test_generations_of_ros_have_lines_of_their_own(store):
    surfaces = store(surface("arm", "1.0.0", "void f();"), surface("arm", "2.0.0"), generations=(1,))
    assert Offers(target(ros=1, arm="2.0.0"), surfaces).find_package("arm").get("c++", "f").state == "removed"
    assert Offers(target(ros=2, arm="2.0.0"), surfaces).find_package("arm") is None


def test_a_method_that_moved_to_a_base_is_judged_as_the_base_has_it(store):
    inherited = "namespace arm { struct Part { virtual int tick() const; }; struct Arm : Part {}; }"
    own = "namespace arm { struct Arm { int tick() const; }; }"
    surfaces = store(*(surface("arm", f"{n}.0.0", code) for n, code in enumerate((inherited, own, inherited), 1)))

    def override(version):
        offers = Offers(target(arm=version), surfaces)
        return check_use(offers, "arm", "arm::Arm::tick", "override", 0, ("const",))

    assert override("2.0.0").form == "override"
    assert override("3.0.0") is None


def test_an_override_of_what_moved_to_a_base_and_changed_there_is_judged_by_the_base(store):
    old, new = "virtual void tick(int a);", "virtual void tick(int a, int b);"
    forms = ("", old), ("", old + new), (old + new, ""), (new, "")
    code = "namespace arm {{ struct Part {{ {} }}; struct Arm : Part {{ {} }}; }}"
    surfaces = store(*(surface("arm", f"{n}.0.0", code.format(*form)) for n, form in enumerate(forms, 1)))
    found = [
        check_use(Offers(target(arm=f"{n}.0.0"), surfaces), "arm", "arm::Arm::tick", "override", 1,
                            ("int", "override"))
        for n in (1, 2, 3, 4)
    ]  # fmt: skip
    assert found[:3] == [None, None, None]
    assert (found[3].state, found[3].form, found[3].symbol.name) == ("changed", "override", "arm::Part::tick")
    # The version that took the form, not that which only declared another one beside it.
    assert found[3].since == "4.0.0"


def test_what_stands_for_a_name_is_there_and_called_the_same_way(store):
    states = (
        "struct State; struct Arm {{ void set_state(const State& s); {} }};",
        "struct State; struct Arm {{ void set_arm_state(const State& s); {} }};",
        "struct State; struct Arm {{ void set_arm_state(const State& s); void set_state(int a, int b); {} }};",
    )
    codes = ("namespace arm { " + code.format("int other();") + " }" for code in states)
    surfaces = store(*(surface("arm", f"{n}.0.0", code) for n, code in enumerate(codes, 1)))

    def find(version, arguments):
        found = check_use(Offers(target(arm=version), surfaces), "arm", "arm::Arm::set_state", "call", arguments, ())
        return found and (found.form or found.state, found.replacement)

    new = "arm::Arm::set_arm_state"
    assert [find("1.0.0", n) for n in (1, 2)] == [None, ("arguments", "")], "the first version has no other name"
    assert [find("2.0.0", n) for n in (1, 2)] == [("removed", new), ("removed", "")]
    assert find("3.0.0", 2) is None


def test_a_call_of_what_a_base_has_is_judged_by_the_base(store):
    own = "struct Part {{}}; struct Arm : Part {{ void move({}); }};"
    base = "struct Part {{ void move({}); }}; struct Arm : Part {{}};"
    codes = own.format("int"), own.format("int, int"), base.format("int, int"), base.format("int")
    codes += (base.format("int, int, int"),)
    surfaces = store(*(surface("arm", f"{n}.0.0", f"namespace arm {{ {code} }}") for n, code in enumerate(codes, 1)))

    def call(version):
        return check_use(Offers(target(arm=version), surfaces), "arm", "arm::Arm::move", "call", 1, ())

    assert (call("2.0.0").form, call("2.0.0").symbol.name) == ("arguments", "arm::Arm::move")
    assert call("4.0.0") is None
    assert (call("5.0.0").form, call("5.0.0").symbol.name) == ("arguments", "arm::Part::move")


def test_a_call_is_judged_by_every_change_of_the_function_not_by_the_last_alone(store):
    codes = "void f(int);", "void f(int, rmw_qos_profile_t);", "void f(int, rclcpp::QoS);", "void f(long, rclcpp::QoS);"
    surfaces = store(*(surface("arm", f"{n}.0.0", code) for n, code in enumerate(codes, 1)))

    def call(version, *given):
        found = check_use(Offers(target(arm=version), surfaces), "arm", "f", "call", len(given), given)
        return found and (found.form, found.since, found.earlier, found.evidence.last)

    assert call("4.0.0", "integer") == ("arguments", "2.0.0", True, "1.0.0")
    assert call("4.0.0", "", "profile") == ("types", "3.0.0", True, "2.0.0")
    assert call("1.0.0", "", "qos") == ("arguments", "2.0.0", False, "")
    assert call("2.0.0", "", "qos") == ("types", "3.0.0", False, "1.0.0")
    assert call("4.0.0", "", "qos") is None and call("2.0.0", "", "profile") is None


@pytest.mark.parametrize(
    ("codes", "how", "arguments", "given", "kinds"),
    [
        # an exported class does not have a method that its base made pure
        (("virtual void stop();", "virtual void stop() = 0;"), "implement", -1, (), (None, "pure")),
        (("", "virtual void stop() = 0;"), "implement", -1, (), (None, "pure")),
        (("virtual void stop(int) = 0;", "virtual void stop(char) = 0;"), "implement", -1, (), (None, None)),
        (("virtual void stop() = 0;", ""), "implement", -1, (), ("pure", None)),
        # a template argument that nothing tells any more
        (("void stop(int); template<class T> void stop(int, T = {});", "template<class T> void stop(int, T t);"
          "template<class T> void stop(int, bool b = true);"), "call", 1, ("integer",), (None, "template")),
        (("void stop(int); void stop(bool);", "template<class T> void stop(T);"), "call", 1, ("integer",),
         (None, None)),
        (("void stop(int); void stop(bool);", "template<class T = int> void stop(bool);"), "call", 1, ("integer",),
         (None, None)),
        # a raw pointer where a smart one is wanted
        (("void stop(Part * p);", "void stop(std::shared_ptr<Part> p);"), "call", 1, ("new",), (None, "types")),
        (("void stop(Part * p);", "void stop(std::shared_ptr<Part> p);"), "call", 1, ("",), (None, None)),
        # an override that differs by a reference, or by the sort of a pointer
        (("virtual void stop(int a, const A & b);", "virtual void stop(int a, A b);"), "override", 2,
         ("int", "const A&"), (None, "override")),
        (("virtual void stop(int a, A::SharedPtr b);", "virtual void stop(int a, A::WeakPtr b);"), "override", 2,
         ("int", "A::SharedPtr"), (None, "override")),
        # the same types in other spellings
        (("virtual void stop(A::SharedPtr a);", "using P = std::shared_ptr<A>; virtual void stop(P a);"), "override", 1,
         ("std::shared_ptr<A>", "override"), (None, None)),
        (("virtual void stop(const A & a);", "virtual void stop(A const & a);"), "override", 1,
         ("B = const A&", "override"), (None, None)),
        (("virtual void stop(const A & a);", "virtual void stop(C & c, int d);"), "override", 1,
         ("B = A const&", "override"), (None, "override")),
        # what is not converted to the type of a parameter, and what may be
        (("void stop(int ms);", "void stop(std::chrono::milliseconds ms);"), "call", 1, ("integer",), (None, "types")),
        (("void stop(std::string how);", "void stop(int how);"), "call", 1, ("text",), (None, "types")),
        (("void stop(std::string how);", "void stop(bool how);"), "call", 1, ("text",), (None, None)),
        (("void stop(int how);", "void stop(const std::string & how);"), "call", 1, ("integer",), (None, None)),
        (("void stop(bool how);", "void stop(const std::string & how);"), "call", 1, ("bool",), (None, "types")),
        (("void stop(bool how);", "void stop(const a_msgs::msg::How & how);"), "call", 1, ("bool",), (None, "types")),
        (("void stop(bool how);", "void stop(Mode how);"), "call", 1, ("bool",), (None, None)),
        (("void stop(int how);", "void stop(std::string how); template<class T> void stop(T how);"), "call", 1,
         ("float",), (None, None)),
        (("virtual void stop(int a, A b);", "virtual void stop(int a, C b);"), "override", 2, ("int", "A"),
         (None, None)),
    ],
)  # fmt: skip
def test_what_is_made_of_a_use(codes, how, arguments, given, kinds, store):
    code = "namespace arm {{ class Arm {{ public: {} }}; }}"
    surfaces = store(*(surface("arm", f"{n}.0.0", code.format(each)) for n, each in enumerate(codes, 1)))
    found = (
        check_use(Offers(target(arm=version), surfaces), "arm", "arm::Arm::stop", how, arguments, given)
        for version in ("1.0.0", "2.0.0")
    )
    assert tuple(one.form if one is not None else None for one in found) == kinds


OBJECTS = """namespace arm {{
struct Base {{}}; struct Tool : Base {{}}; struct Pose {{ Pose(double x, std::string frame = ""); }};
struct Other {{}}; using Same = Tool; template<class T> struct Grip {{}};
{0}
}}"""


@pytest.mark.parametrize(
    ("before", "after", "given", "found"),
    [
        # the type of the parameter, then and now, and the class of the argument
        ("const Tool & a", "const Other & a", "arm::Tool", "types"),
        ("Tool a", "Pose & a", "arm::Tool", "types"),
        ("const geometry_msgs::msg::Pose2D & a", "const geometry_msgs::msg::Pose & a", "geometry_msgs::msg::Pose2D",
         "types"),
        ("const Tool & a", "geometry_msgs::msg::Pose a", "arm::Tool", "types"),
        ("const geometry_msgs::msg::Pose & a", "const Pose & a", "geometry_msgs::msg::Pose", "types"),
        # it was never taken
        ("const Tool & a", "const Other & a", "arm::Pose", None),
        # a base class, one of the two derived from the other, an alias, a template, a pointer, what is not known
        ("const Tool & a", "const Base & a", "arm::Tool", None),
        ("const Base & a", "const Tool & a", "arm::Base", None),
        ("const Tool & a", "const Same & a", "arm::Tool", None),
        ("const Tool & a", "const Grip<int> & a", "arm::Tool", None),
        ("const Tool & a", "std::shared_ptr<Other> a", "arm::Tool", None),
        ("const Tool & a", "const Unseen & a", "arm::Tool", None),
        ("const Tool & a", "const Other & a", "arm::Unseen", None),
        ("const leg::Pose & a", "const Other & a", "leg::Pose", None),
    ],
)
def test_whether_an_object_of_a_class_is_refused(before, after, given, found, store):
    codes = (OBJECTS.format(f"struct Arm {{ void put({one}); }};") for one in (before, after))
    surfaces = store(*(surface("arm", f"{n}.0.0", code) for n, code in enumerate(codes, 1)))
    new = check_use(Offers(target(arm="2.0.0"), surfaces), "arm", "arm::Arm::put", "call", 1, (given,))
    assert (new and new.form) == found


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("struct Tool {}; struct Other { Other(int a); explicit Other(const Tool & a); };", "types"),
        ("struct Tool { explicit Tool(const Other & a); bool ready(); }; struct Other {};", "types"),
        ("struct Tool {}; struct Other { Other(const Tool & a, int b = 0); };", None),
        ("struct Base {}; struct Tool : Base {}; struct Other { Other(const Base & a); };", None),
        ("struct Tool {}; struct Other { template<class T> Other(const T & a); };", None),
        ("struct Tool {}; struct Other { Other(const Unseen & a); };", None),
        ("struct Tool {}; using Any = Tool; struct Other { Other(Any a); };", None),
        ("struct Tool {}; struct Base { Base(const Tool & a); }; struct Other : Base { using Base::Base; };", None),
        ("struct Tool {}; struct Other : Unseen {};", None),
        ("struct Tool : Unseen {}; struct Other {};", None),
        ("struct Other {}; struct Tool { operator Other() const; };", None),
        ("struct Other {}; struct Base { operator Other() const; }; struct Tool : Base {};", None),
        ("struct Tool {}; template<class T> struct Other {};", None),
        ("struct Tool {}; typedef Tool Other;", None),
        # a base of the class, or its template, may mean another by the name
        ("struct Tool {}; struct Other {}; struct Root { using Other = Tool; }; #define BASE : Root", None),
        ("struct Tool {}; struct Other {}; #define BASE : Unseen", None),
    ],
)
def test_what_a_class_takes_in_place_of_an_object_of_its_own(code, found, store):
    code, _, base = code.partition("#define BASE")
    versions = (f"namespace arm {{ {code} struct Arm{base} {{ void put({one} a); }}; }}" for one in ("Tool", "Other"))
    surfaces = store(*(surface("arm", f"{n}.0.0", text) for n, text in enumerate(versions, 1)))
    new = check_use(Offers(target(arm="2.0.0"), surfaces), "arm", "arm::Arm::put", "call", 1, ("arm::Tool",))
    assert (new and new.form) == found


def test_an_object_is_taken_by_any_overload_and_by_functions_of_a_namespace(store):
    surfaces = store(
        surface("arm", "1.0.0", OBJECTS.format("struct Arm { void put(Tool a); }; void put(Tool a);")),
        surface("arm", "2.0.0", OBJECTS.format("struct Arm { void put(Other a); template<class T> void put(T a); };"
                                               " void put(Other a);")),
    )  # fmt: skip
    offers = Offers(target(arm="2.0.0"), surfaces)
    assert check_use(offers, "arm", "arm::Arm::put", "call", 1, ("arm::Tool",)) is None
    assert check_use(offers, "arm", "arm::put", "call", 1, ("arm::Tool",)) is None


@pytest.mark.parametrize(
    ("before", "after", "number", "kinds"),
    [
        # how many template arguments are written, and what is told of the first version and of the second
        ("template<class A> struct T {};", "template<class A, class B> struct T {};", 1, (None, "template arguments")),
        ("template<class A> struct T {};", "template<class A, class B> struct T {};", 2, ("template arguments", None)),
        ("template<class A> struct T {};", "template<class A, class B = int> struct T {};", 1, (None, None)),
        ("template<class A> struct T {};", "template<class... A> struct T {};", 0, ("template arguments", None)),
        ("template<class A> struct T {};", "struct T {};", 1, (None, "template arguments")),
        ("template<class A> struct T {};", "template<class A, class B> struct T {};", 3, (None, None)),
        ("template<class A> struct T {};", "template<class A, class B> struct T {};"
         "template<class A> struct T<A, int> {};", 1, (None, "template arguments")),
        ("template<class A, class B> using T = A;", "template<class A> using T = A;", 2, (None, "template arguments")),
        # defaults may stand where it is announced
        ("template<class A> struct T {};", "template<class A, class B = int> struct T;"
         "template<class A, class B> struct T {};", 1, (None, None)),
        # what is left out, the arguments of a call may tell
        ("template<class A> void T(A);", "template<class A, class B> void T(A, B);", 1, (None, None)),
        ("template<class A, class B> void T(A, B);", "template<class A> void T(A);", 2, (None, "template arguments")),
        ("template<class A> void T(A);", "void T(int);", 0, (None, "template arguments")),
        ("template<class A, class B> void T(A);", "template<class... A> void T(A...);", 2, (None, None)),
        ("template<class A, class B> void T(A);", "template<class A> void T(A); template<class A, int B> void T(A);", 2,
         (None, None)),
    ],
)
def test_how_many_template_arguments_are_taken(before, after, number, kinds, store):
    codes = (f"namespace arm {{ {one} }}" for one in (before, after))
    surfaces = store(*(surface("arm", f"{n}.0.0", code) for n, code in enumerate(codes, 1)))
    found = (
        check_use(Offers(target(arm=version), surfaces), "arm", "arm::T", "name", -1, (), number)
        for version in ("1.0.0", "2.0.0")
    )
    assert tuple(one.form if one is not None else None for one in found) == kinds
