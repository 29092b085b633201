"""What versions of packages offer, and what changed between two states of a repository, all kinds in one list."""

import subprocess
import textwrap

import pytest
from rosimpact.databuild.surface.clones import Clone, Clones, VersionError
from rosimpact.databuild.surface.compare import RepositorySurfaces, compare, compare_states
from rosimpact.databuild.surface.package import build_surfaces
from rosimpact.impact.facts.extract import kinds
from rosimpact.impact.facts.store import Store
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.surface.changes import PARAMETER
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>{name}</name><version>{version}</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>{tool}</buildtool_depend>{more}
<export><build_type>{tool}</build_type></export></package>"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name})
find_package(ament_cmake REQUIRED)
{body}
ament_package()
"""
HEADERS = "install(DIRECTORY include/ DESTINATION include)"


def files(name, headers=None, body=HEADERS, version="1.0.0", more="", **others):
    """The files of a C++ package: headers by their path as included."""
    made = {
        f"{name}/package.xml": MANIFEST.format(name=name, version=version, tool="ament_cmake", more=more),
        f"{name}/CMakeLists.txt": CMAKE.format(name=name, body=body),
    }
    made.update({f"{name}/include/{path}": text for path, text in (headers or {}).items()})
    made.update({f"{name}/{path}": text for path, text in others.get("also", {}).items()})
    return made


def python(name, modules, package=None, more=""):
    """The files of a Python package whose importable package may be called differently."""
    package = package or name
    setup = f"from setuptools import setup\nsetup(name='{name}', packages=['{package}'])\n"
    return {
        f"{name}/package.xml": MANIFEST.format(name=name, version="1.0.0", tool="ament_python", more=more),
        f"{name}/setup.py": setup,
        f"{name}/{package}/__init__.py": "",
        **{f"{name}/{package}/{path}": text for path, text in modules.items()},
    }


@pytest.fixture
def state(tmp_path_factory):
    """The state of a repository of these files."""

    def make(*parts):
        folder = tmp_path_factory.mktemp("ws")
        write(folder, *parts)
        with Store(tmp_path_factory.mktemp("cache")) as store:
            return RepositorySurfaces(build_surfaces(WorkingTree(folder), store, 1))

    return make


def write(folder, *parts):
    for path, text in {path: text for part in parts for path, text in part.items()}.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(textwrap.dedent(text))


@pytest.fixture
def told(state):
    """What a comparison says, as short rows."""

    def make(old, new, package="arm"):
        before, after = state(*old), state(*new)
        changes = compare(before.surfaces[package], after.surfaces[package], before, after)
        return [
            " ".join(filter(None, (c.side, c.kind, c.what, c.name, c.instead and f"-> {c.instead}",
                                   c.moved_to and f"in {c.moved_to}", "" if c.breaks else "ok")))
            for c in changes
        ]  # fmt: skip

    return make


def test_nothing_changed(told):
    old = files("arm", {"arm/a.hpp": "struct A { void f(int a = 1); };", "arm/b.hpp": '#include "a.hpp"\nvoid g();'})
    assert told([old], [old]) == []


def test_headers_and_names_that_are_gone(told):
    old = files("arm", {"arm/a.hpp": "void f();\nvoid g(int);", "arm/b.hpp": "struct B { int x; };"})
    new = files("arm", {"arm/a.hpp": "void g(int, int);"})
    assert told([old], [new]) == [
        "c++ removed header arm/b.hpp",
        "c++ removed struct B",
        "c++ removed function f",
        "c++ signature function g",
    ]


def test_a_header_that_is_not_installed_is_no_part_of_it(told):
    also = {"src/inner.hpp": "void inner();"}
    assert told([files("arm", {"arm/a.hpp": "void f();"}, also=also)], [files("arm", {"arm/a.hpp": "void f();"})]) == []


def test_a_renamed_header_names_its_successor(told):
    assert told(
        [files("arm", {"arm/a.h": "namespace arm { void f(); }"})],
        [files("arm", {"arm/a.hpp": "namespace arm { void f(); }"})],
    ) == ["c++ removed header arm/a.h -> arm/a.hpp", "c++ added header arm/a.hpp ok"]


def test_a_header_that_warns_names_what_to_include(state):
    headers = {"arm/a.hpp": "void f();", "arm/b.hpp": "void f();"}
    warning = {**headers, "arm/b.hpp": '#warning obsolete, include arm/a.hpp\n#include "arm/a.hpp"\nvoid f();'}
    before, after = (state(files("arm", each)) for each in (headers, warning))
    (change,) = compare(before.surfaces["arm"], after.surfaces["arm"], before, after)
    assert (change.kind, change.what, change.name, change.instead) == ("deprecated", "header", "arm/b.hpp", "arm/a.hpp")


# How a name can still be there: old headers, new headers.
STILL_THERE = {
    "in a header that the old one includes": (
        {"arm/a.hpp": "void f();"},
        {"arm/a.hpp": '#include "arm/inner.hpp"', "arm/inner.hpp": "void f();"},
    ),
    "over two includes": (
        {"arm/a.hpp": "void f();"},
        {"arm/a.hpp": "#include <arm/b.hpp>", "arm/b.hpp": '#include "c.hpp"', "arm/c.hpp": "void f();"},
    ),
    "in a new base class": (
        {"arm/a.hpp": "struct A { void f(int); int x; };"},
        {"arm/a.hpp": "struct Base { void f(int); int x; };\nstruct A : Base {};"},
    ),
    "in the base of the base": (
        {"arm/a.hpp": "namespace n { struct A { void f(); }; }"},
        {"arm/a.hpp": "namespace n { struct C { void f(); }; struct B : public n::C {}; struct A : B {}; }"},
    ),
    "through using": (
        {"arm/a.hpp": "namespace n { void f(); }"},
        {"arm/a.hpp": "namespace m { void f(); } namespace n { using m::f; }"},
    ),
    "through using namespace": (
        {"arm/a.hpp": "namespace n { struct A {}; }"},
        {"arm/a.hpp": "namespace n { namespace v2 { struct A {}; } using namespace v2; }"},
    ),
    "in an inline namespace": (
        {"arm/a.hpp": "namespace n { struct A {}; }"},
        {"arm/a.hpp": "namespace n { inline namespace v2 { struct A {}; } }"},
    ),
    "an override less": (
        {"arm/a.hpp": "struct B { virtual void f(); };\nstruct A : B { void f() override; };"},
        {"arm/a.hpp": "struct B { virtual void f(); };\nstruct A : B {};"},
    ),
    "as an alias of a class that has the members": (
        {"arm/a.hpp": "struct A { void f(); int x; };"},
        {"arm/a.hpp": "struct New { void f(); int x; };\nusing A = New;"},
    ),
}


@pytest.mark.parametrize("case", STILL_THERE)
def test_a_name_that_can_still_be_written_is_not_gone(told, case):
    old, new = STILL_THERE[case]
    rows = told([files("arm", old)], [files("arm", new)])
    assert [row for row in rows if not row.endswith(" ok")] == []


def test_a_base_class_of_another_package_of_the_repository(told):
    old = files("arm", {"arm/a.hpp": "struct A { void f(); void g(); };"})
    new = files("arm", {"arm/a.hpp": "#include <core/b.hpp>\nstruct A : core::B {};"})
    core = files("core", {"core/b.hpp": "namespace core { struct B { void f(); }; }"})
    assert told([old], [new, core]) == ["c++ base struct A ok", "c++ removed method A::g"]


def test_a_member_is_not_sure_to_be_gone_when_there_is_a_new_base_that_nobody_knows(state):
    before = state(files("arm", {"arm/a.hpp": "struct A { void f(); };"}))
    after = state(files("arm", {"arm/a.hpp": "struct A : strange::B {};"}))
    removed = [c for c in compare_states(before, after)["arm"] if c.kind == "removed"]
    assert [(c.name, c.sure) for c in removed] == [("A::f", 0.5)]


def test_a_header_that_moved_to_another_package(told):
    header = {"arm/a.hpp": "void f();"}
    old = files("arm", header)
    alone = files("arm")
    reexported = files("arm", body="find_package(core REQUIRED)\nament_export_dependencies(core)")
    core = files("core", header)
    assert told([old], [alone, core]) == ["c++ moved header arm/a.hpp in core"]
    assert told([old], [reexported, core]) == ["build added dependency core ok"]


def test_a_name_that_moved_to_a_header_of_another_package(told):
    old = files("arm", {"arm/a.hpp": "void f();\nvoid g();"})
    new = files("arm", {"arm/a.hpp": "void g();"})
    core = files("core", {"core/f.hpp": "void f();"})
    assert told([old], [new, core]) == ["c++ moved function f -> core/f.hpp in core"]


def test_python_names_that_moved_to_another_package(told):
    code = {"buffer.py": "class Buffer:\n    def get(self, a): ...\n"}
    old, empty = python("arm", code), files("arm")
    kept = files("arm", more="<exec_depend>arm_py</exec_depend>")
    home = python("arm_py", code, package="arm")
    assert told([old], [empty, home])[:1] == ["python moved module arm in arm_py"]
    assert "python moved module arm in arm_py ok" in told([old], [kept, home])


def test_python_signatures(told):
    old = python("arm", {"a.py": "def f(x, y=1): ...\ndef g(): ...\n"})
    new = python("arm", {"a.py": "def f(x, y, z): ...\n"})
    assert told([old], [new]) == ["python signature function arm.a.f", "python removed function arm.a.g"]


INTERFACES = "find_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces(${{PROJECT_NAME}} {})"


def messages(name="arm", **texts):
    listed = " ".join(f'"msg/{short}.msg"' for short in texts)
    also = {f"msg/{short}.msg": text for short, text in texts.items()}
    return files(name, body=INTERFACES.format(listed), also=also)


def test_messages(told):
    old = messages(Pose="float32 x\nint8 mode 1\nPose2 inner\nuint8 A=1\nuint8 B=2\n", Pose2="int8 a\n", Old="int8 a\n")
    new = messages(Pose="float64 x\nint8 mode 2\narm/msg/Pose2 inner\nuint8 A=3\nint8 z\n", Pose2="int8 b\n")
    rows = [row for row in told([old], [new]) if row.startswith("message")]
    assert rows == [
        "message removed interface arm/msg/Old",
        "message wire interface arm/msg/Pose ok",
        "message value constant arm/msg/Pose.A ok",
        "message removed constant arm/msg/Pose.B",
        "message default field arm/msg/Pose.mode ok",
        "message type field arm/msg/Pose.x",
        "message added field arm/msg/Pose.z ok",
        "message wire interface arm/msg/Pose2 ok",
        "message removed field arm/msg/Pose2.a -> b",
        "message added field arm/msg/Pose2.b ok",
    ]


@pytest.mark.parametrize(
    ("body", "offered"),
    [
        (INTERFACES.format("msg/Pose.msg"), True),
        (INTERFACES.format("msg/Pose.msg SKIP_INSTALL"), False),
        (f"if(BUILD_TESTING)\n{INTERFACES.format('msg/Pose.msg')}\nendif()", False),
        (f"{INTERFACES.format('msg/Pose.msg')}\nif(BUILD_TESTING)\n{INTERFACES.format('msg/Pose.msg')}\nendif()", True),
    ],
)
def test_messages_that_only_the_package_itself_has_are_not_offered(state, body, offered):
    arm = state(files("arm", body=body, also={"msg/Pose.msg": "float32 x\n"})).surfaces["arm"]
    assert [name for name, _ in arm.interfaces] == ["msg/Pose"] * offered
    assert ("arm/msg/pose.hpp" in [header.include for header in arm.build.headers]) == offered
    assert ("arm.msg" in arm.python.unknown) == offered


def test_parameters_of_nodes(told):
    def arm(*lines, test=""):
        cpp = "".join(f"declare_parameter({line});\n" for line in lines)
        return files("arm", also={"src/node.cpp": cpp, "test/node.cpp": test})

    old = arm('"rate", 20.0', '"frame", "map"', '"speed", 1', '"size", 2', '"mode", mode()')
    new = arm('"rate", 20.0f', '"frame", "odom"', '"speed", 2', '"speed", 3', '"mode", 1', '"size", 2')
    assert told([old], [new]) == ["build default parameter of a node frame ok"]
    assert told([old], [arm('"rate", 20.0', '"new", 1', test='declare_parameter("frame", 1);')]) == [
        "build removed parameter of a node frame",
        "build removed parameter of a node mode",
        "build added parameter of a node new ok",
        "build removed parameter of a node size",
        "build removed parameter of a node speed",
    ]


@pytest.mark.parametrize(
    ("beside", "sure"),
    [
        ("", True),
        ('for (auto name : {"rate"}) declare_parameter(name, 1);', False),
        ('// was "rate"', False),
        ('set("base.rate");', False),
        ('set("mean_rate");', True),
        ('set(prefix + "_rate");', True),
    ],
)
def test_a_parameter_is_surely_gone_where_nothing_mentions_it(state, beside, sure):
    def changed(old, new):
        before, after = state(old), state(new)
        changes = compare(before.surfaces["arm"], after.surfaces["arm"], before, after)
        return [(c.kind, c.name, c.sure == 1) for c in changes if c.what == PARAMETER]

    old = files("arm", also={"src/node.cpp": 'declare_parameter("rate", 1);'})
    new = files("arm", also={"src/node.cpp": beside})
    assert changed(old, new) == [("removed", "rate", sure)]
    # The other way round it is as sure that it was not there.
    assert changed(new, old) == [("added", "rate", sure)]


@pytest.mark.parametrize(("more", "sure"), [("", True), ("<depend>base</depend>", False)])
def test_what_comes_along_may_declare_a_parameter_too(state, more, sure):
    before = state(files("arm", also={"src/node.cpp": 'declare_parameter("rate", 1);'}, more=more))
    after = state(files("arm", more=more), files("base", also={"src/node.cpp": 'set("rate");'}))
    changes = compare(before.surfaces["arm"], after.surfaces["arm"], before, after)
    assert [c.sure == 1 for c in changes if c.what == PARAMETER] == [sure]


def test_a_message_that_moved_to_another_package(told):
    old = [messages(Pose="int8 x\n", Keep="int8 a\n")]
    new = [messages(Keep="int8 a\n"), messages("core", Pose="int8 x\n")]
    assert "message moved interface arm/msg/Pose -> core/msg/Pose in core" in told(old, new)


def test_an_executable_that_moved_to_another_package(told):
    body = "add_executable(drive a.cpp)\ninstall(TARGETS drive DESTINATION lib/${PROJECT_NAME})"
    old, new = files("arm", body=body), files("arm", body="")
    assert told([old], [new, files("core", body=body)]) == ["build moved executable drive in core"]
    assert told([old], [new]) == ["build removed executable drive"]


def test_packages_that_come_and_go(state):
    found = compare_states(state(files("arm"), files("old")), state(files("arm"), files("new")))
    assert {name: [(c.kind, c.what) for c in changes] for name, changes in found.items()} == {
        "arm": [],
        "new": [("added", "package")],
        "old": [("removed", "package"), ("removed", "cmake package")],
    }


def test_what_a_package_that_is_gone_had_may_be_in_another_one(state):
    header = {"old/a.hpp": "void f();", "old/b.hpp": "void g();"}
    changes = compare_states(state(files("old", header)), state(files("new", {"old/a.hpp": "void f();"})))["old"]
    assert [(c.kind, c.what, c.name, c.moved_to) for c in changes if c.side == "c++"] == [
        ("moved", "header", "old/a.hpp", "new"),
        ("removed", "header", "old/b.hpp", ""),
        ("removed", "function", "g", ""),
    ]


# -- versions in clones ------------------------------------------------------------------------------------------------


def git(folder, *arguments):
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(["git", "-C", str(folder), *identity, *arguments], check=True, capture_output=True)


@pytest.fixture
def clone(tmp_path):
    """A folder of clones with one repository, ros2+rclcpp, of two releases and a branch."""
    place = tmp_path / "clones" / "ros2+rclcpp"
    place.mkdir(parents=True)
    git(place, "init", "-q", "-b", "rolling")
    for tag, text in (("16.0.0", "void f();"), ("v28.1.0", "void f(int);")):
        write(place, files("rclcpp", {"rclcpp/a.hpp": text}, version=tag.removeprefix("v")))
        git(place, "add", "-A")
        git(place, "commit", "-qm", "x")
        git(place, "tag", tag)
    git(place, "branch", "humble", "16.0.0")
    return place


@pytest.fixture
def store(tmp_path):
    with Store(tmp_path / "cache") as opened:
        yield opened


def test_a_version_is_found_by_its_tag(clone, store):
    clones = Clones(clone.parent)
    versions = {}
    for asked in ("16.0.0", "28.1.0"):
        version, state = clones.find_surface("rclcpp", asked, store, 1)
        versions[asked] = (version.revision, version.approximate, state.surfaces["rclcpp"].version)
    assert versions == {
        "16.0.0": ("refs/tags/16.0.0", False, "16.0.0"),
        "28.1.0": ("refs/tags/v28.1.0", False, "28.1.0"),
    }


def test_a_branch_stands_for_a_tag_that_is_missing(clone, store):
    version, _ = Clones(clone.parent).find_surface("rclcpp", "humble", store, 1)
    assert (version.revision, version.approximate) == ("refs/heads/humble", True)


def test_the_same_tag_of_another_repository_that_once_had_the_package_is_not_taken(tmp_path, store):
    # topic_tools came from ros_comm in ROS 1 and has a repository of its own in ROS 2.
    place = tmp_path / "clones" / "ros+ros_comm"
    place.mkdir(parents=True)
    git(place, "init", "-q")
    write(place, files("topic_tools"))
    git(place, "add", "-A")
    git(place, "commit", "-qm", "x")
    git(place, "tag", DistroTarget("humble").find_version("topic_tools"))
    with pytest.raises(VersionError, match="of which there is no clone"):
        Clones(place.parent).find_surface("topic_tools", "humble", store, 1)


def test_tags_of_release_repositories(clone):
    for increment in ("9", "10"):
        git(clone, "tag", f"release/jazzy/rclcpp/28.0.1-{increment}", "v28.1.0")
    assert Clone(clone).tag("28.0.1", "rclcpp", "jazzy") == "refs/tags/release/jazzy/rclcpp/28.0.1-10"
    assert Clone(clone).tag("28.0.1", "rclcpp", "humble") is None
    assert Clone(clone).tag("28.0.1", "rclpy", "jazzy") is None
    # The tag of all that came from upstream has the other packages too.
    git(clone, "tag", "upstream/28.0.1", "v28.1.0")
    assert Clone(clone).tag("28.0.1", "rclcpp", "jazzy") == "refs/tags/upstream/28.0.1"
    assert Clone(clone).tag("28.0.1", "rclpy", "jazzy") is None


def test_a_release_repository_has_what_its_tags_say_whatever_it_is_called(clone, store):
    version = DistroTarget("jazzy").find_version("rclcpp")
    git(clone, "tag", f"release/jazzy/rclcpp/{version}-1", "v28.1.0")
    clone.rename(clone.parent / "ros2-gbp+cpp_client-release")
    found, state = Clones(clone.parent).find_surface("rclcpp", "jazzy", store, 1)
    assert (found.clone.name, found.version, found.approximate) == ("ros2-gbp/cpp_client-release", version, False)
    assert "rclcpp" in state.surfaces
    with pytest.raises(VersionError, match="of which there is no clone"):
        Clones(clone.parent).find_surface("rclcpp", "kilted", store, 1)


@pytest.mark.parametrize(
    ("package", "asked", "why"),
    [
        ("rclcpp", "1.2.3", "has no tag for it"),
        ("rclcpp", "noetic", "noetic has no `rclcpp`; released in "),
        ("rclcpp", "jazy", "jazzy"),
        ("nav2_core", "humble", "no clone in "),
    ],
)
def test_what_cannot_be_read_is_told(clone, store, package, asked, why):
    with pytest.raises(VersionError, match=why):
        Clones(clone.parent).find_surface(package, asked, store, 1)


def test_what_is_equal_in_two_tags_is_read_once(clone, store, monkeypatch):
    first = Clone(clone).read_surfaces("16.0.0", store, 1)
    read = []
    monkeypatch.setattr(kinds, "extract", lambda kind, data: read.append(kind))
    assert Clone(clone).read_surfaces("humble", store, 1) == first
    assert read == []
