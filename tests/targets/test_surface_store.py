"""Surfaces of many versions in one file: what is packed comes back, and only what is asked for is read."""

import msgspec
import pytest
import zstandard
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.extract.python import extract as module
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.compare import RepositorySurfaces, compare
from rosimpact.databuild.surface.headers import keep_compiled_includes
from rosimpact.databuild.surface_file import write
from rosimpact.impact.facts.cpp.lexical import Include
from rosimpact.impact.facts.interface import extract as interface
from rosimpact.impact.targets.surface.store import StoredSurfacesError, SurfaceHistory, Surfaces
from rosimpact.impact.targets.surface.surface import (
    BuildSurface,
    ExportedTarget,
    Header,
    InstalledLaunchFile,
    InstalledModule,
    InstalledProgram,
    PythonSurface,
    Surface,
)

CODE = """#pragma once
#include <vector>
namespace arm { template<typename T = int>
class A : public B { public: [[deprecated("no")]] virtual void f(int) const; };
enum class E { one, two = 5 }; using Alias = std::vector<int>; }
#define ARM_MAX 3
"""


PYTHON = "def f(a, *, b=1): ...\nclass C(Base):\n    x = 1\n"


def surface(version, code=CODE):
    build = BuildSurface(
        "arm",
        version,
        "ament_cmake",
        ("arm",),
        (ExportedTarget("arm::core", "shared", 17),),
        headers=(Header("a.hpp", "include/a.hpp", "a.hpp"),),
        programs=(InstalledProgram("drive", "lib/arm", "binary"),),
        launches=(InstalledLaunchFile("launch/a.launch.py", (("x", None), ("y", "1"))),),
        unknown=(("headers", "why"),),
        standard=17,
    )
    modules = (InstalledModule("arm", "arm/__init__.py", True, module(PYTHON.encode())),)
    definitions = (("msg/M", interface(b"int8 a 1\nint8 B=2\n", "msg")),)
    python = PythonSurface("arm", modules, ("arm.msg",))
    headers = (("a.hpp", keep_compiled_includes(header(code.encode()))),)
    parameters = (("a", None), ("rate", "2.0"))
    return Surface("arm", version, build, python, headers, definitions, False, ("rclcpp",), parameters)


def packed(*surfaces, approximate=False):
    packing = Packing()
    for one in surfaces:
        packing.add("arm", one.version, (2,), RepositorySurfaces({"arm": one}), approximate)
    return packing.pack_packages()["arm", 2]


def stored(*surfaces):
    data, _, includes = packed(*surfaces)
    return SurfaceHistory("arm", data, includes)


def test_what_comes_back_is_what_was_packed():
    one = surface("1.0.0")
    back = stored(one).load_surface("1.0.0")
    assert compare(one, back) == compare(back, one) == ()
    told = ("build", "runs_with", "parameters")
    assert [getattr(back, name) for name in told] == [getattr(one, name) for name in told]
    entities = [msgspec.structs.replace(e, line=0) for _, h in one.headers for e in h.entities]
    nameless = [
        msgspec.structs.replace(e, parameters=tuple(msgspec.structs.replace(p, name="") for p in e.parameters))
        if e.parameters is not None
        else e
        for e in entities
    ]
    assert [e for _, h in back.headers for e in h.entities] == nameless
    assert [h.includes for _, h in back.headers] == [(Include("vector", True, 0, 0),)]


def test_each_version_has_what_it_had():
    history = stored(surface("1.0.0"), surface("2.0.0", CODE.replace("f(int)", "g(int)")), surface("10.0.0"))
    assert history.versions == ("1.0.0", "2.0.0", "10.0.0")
    assert history.index_names()["arm::A::f"] == ("1.0.0", "10.0.0")
    every = ("a.hpp", "arm/msg/M", "arm::A", "ARM_MAX", "arm", "arm.f", "arm.C.x")
    assert {history.index_names()[name] for name in every} == {history.versions}
    changes = compare(history.load_surface("1.0.0"), history.load_surface("2.0.0"))
    assert [(c.kind, c.name) for c in changes] == [("removed", "arm::A::f"), ("added", "arm::A::g")]
    assert history.load_surface("3.0.0") is None


def test_nothing_but_facts_is_stored():
    code = "// secret\n/// told\nvoid f(int count_of_things) { secret(); }"
    plain = b"".join(map(zstandard.ZstdDecompressor().decompress, packed(surface("1.0.0", code))))
    assert b"secret" not in plain and b"told" not in plain and b"count_of_things" not in plain


def test_statements_and_long_messages_are_not_stored():
    message = "no more of this, " * 20
    lambda_ = "[](){ int told = 1; return told; }()"
    code = f"[[deprecated(\"{message}\")]] void f(int n = {lambda_}, char c = ';');"
    history = stored(surface("1.0.0", code))
    (one,) = (e for _, h in history.load_surface("1.0.0").headers for e in h.entities)
    assert message.startswith(one.deprecated.removesuffix(" ...")) and 100 < len(one.deprecated) <= 164
    assert "told" not in one.parameters[0].default and one.parameters[1].default == "';'"
    # Another lambda is another default still.
    changed = stored(surface("2.0.0", code.replace("told", "tale"))).load_surface("2.0.0")
    assert [(c.kind, c.name) for c in compare(history.load_surface("1.0.0"), changed)] == [("default", "f")]


def test_a_file_of_packages(tmp_path):
    file = tmp_path / "surfaces.sqlite"
    arm = packed(surface("1.0.0"), approximate=True)
    about = write(file, {("arm", 2): arm}, ("humble", "jazzy"), "2026-08-22")
    surfaces = Surfaces(file)
    assert surfaces.about == about == (1, 1, "humble jazzy", "2026-08-22")
    assert surfaces.packages == {"arm"}
    assert surfaces.find_history("arm", 2).approximate == {"1.0.0"}
    assert {generation: line.versions for generation, line in surfaces.find_lines("arm").items()} == {2: ("1.0.0",)}
    assert surfaces.find_included("arm", 2).versions == ("1.0.0",)
    assert surfaces.find_lines("leg") == {}
    assert surfaces.find_history("leg", 2) is surfaces.find_included("arm", 1) is surfaces.find_line("arm", 1) is None


def test_a_package_of_each_generation_answers_for_its_own(tmp_path):
    """Two packages of one name and version, as ros_control and ros2_control have them."""
    packing = Packing()
    for ros, code in ((1, "void one();"), (2, "void two();")):
        one = surface("0.11.0", code)
        packing.add("arm", "0.11.0", (ros,), RepositorySurfaces({"arm": one}))
    write(tmp_path / "x", packing.pack_packages())
    surfaces = Surfaces(tmp_path / "x")
    assert surfaces.list_ros("arm") == (1, 2)
    for ros, has in ((1, "one"), (2, "two")):
        history = surfaces.find_history("arm", ros)
        assert [name for name in ("one", "two") if history.has(name, "0.11.0")] == [has]
        assert surfaces.find_line("arm", ros).events == {}
    assert surfaces.about.packages == surfaces.about.versions == 1


def test_which_package_may_have_a_header(tmp_path):
    surfaces = write(tmp_path / "x", {("arm", 2): packed(surface("1.0.0"))}) and Surfaces(tmp_path / "x")
    assert [surfaces.list_holders(header) for header in ("a.hpp", "arm/any.hpp", "b.hpp")] == [("arm",), ("arm",), ()]


def test_a_file_that_is_none(tmp_path):
    (tmp_path / "x").write_text("hello, I am no database, however long this text may be")
    with pytest.raises(StoredSurfacesError, match="surface build"):
        Surfaces(tmp_path / "x")


def test_which_parameters_surely_came_or_went(tmp_path):
    def version(number, *names, mentioned=()):
        one = msgspec.structs.replace(surface(number), parameters=tuple((name, None) for name in names))
        return msgspec.structs.replace(one, mentioned=(*mentioned, *(name.rpartition(".")[2] for name in names)))

    arm = packed(
        version("1.0.0", "kept", "*.gone", "hidden"),
        version("2.0.0", "kept", mentioned=("hidden",)),
        version("3.0.0", "kept", "base.fresh"),
    )
    surfaces = write(tmp_path / "x", {("arm", 2): arm}) and Surfaces(tmp_path / "x")
    assert surfaces.changing_parameters == {"fresh": {"arm"}, "gone": {"arm"}}
    assert [name for name, _ in surfaces.find_history("arm", 2).list_parameters("1.0.0")] == [
        "*.gone",
        "hidden",
        "kept",
    ]
    unknown = packed(
        *(msgspec.structs.replace(surface(v), parameters=p) for v, p in (("1", (("a", None),)), ("2", ())))
    )
    assert (write(tmp_path / "y", {("arm", 2): unknown}) and Surfaces(tmp_path / "y")).changing_parameters == {}
