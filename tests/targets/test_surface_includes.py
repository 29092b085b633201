"""What headers of stored versions include, and what they bring along on a target across packages."""

import pytest
from rosimpact.databuild.extract.cpp import extract as header
from rosimpact.databuild.jobs import Packing
from rosimpact.databuild.surface.compare import RepositorySurfaces
from rosimpact.databuild.surface.headers import keep_compiled_includes
from rosimpact.databuild.surface_file import IncludesPacker, write
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.facts.cpp.lexical import Include
from rosimpact.impact.facts.interface import extract as interface
from rosimpact.impact.targets.providers.includes import HeadersOfMachine, Includes, IncludesTable
from rosimpact.impact.targets.surface.includes import Included
from rosimpact.impact.targets.surface.store import Surfaces
from rosimpact.impact.targets.surface.surface import BuildSurface, PythonSurface, Surface
from rosimpact.impact.targets.unpacked import read_packed


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ('#include <vector>\n#include "a/b.h"', [("vector", True, ()), ("a/b.h", False, ())]),
        ("#if 0\n#include <a>\n#else\n#include <b>\n#endif", [("b", True, ())]),
        ("#ifdef _WIN32\n#include <windows.h>\n#else\n#include <unistd.h>\n#endif", [("unistd.h", True, ())]),
        ("#ifndef Q_MOC_RUN\n#include <tf2/time.h>\n#endif", [("tf2/time.h", True, ())]),
        ("#ifdef WITH_ROPE\n#include <rope>\n#endif", [("rope", True, (Condition("cpp", "defined(WITH_ROPE)"),))]),
        ("// #include <a>\n/*\n#include <b>\n*/", []),
    ],
)
def test_includes_that_some_linux_compiles(code, expected):
    assert keep_compiled_includes(header(code.encode())).includes == tuple(
        Include(path, angled, 0, 0, conditions) for path, angled, conditions in expected
    )


@pytest.mark.parametrize(
    ("code", "announced"),
    [
        ("class A; struct B; enum C : int; class D {};", ("A", "B", "C")),
        ("namespace arm { class A; template <typename T> class B; void f(class C c); }", ("arm::A", "arm::B")),
        ("namespace arm { inline namespace v1 { class A; } }", ("arm::A",)),
        ("class A { class Inner; friend class B; }; typedef class C D; struct E e;", ()),
    ],
)
def test_types_that_a_header_only_announces(code, announced):
    assert keep_compiled_includes(header(code.encode())).announced == announced


def _header(code):
    return keep_compiled_includes(header(code.encode()))


def test_each_version_includes_what_it_did():
    including = IncludesPacker()
    including.add("1.0.0", [("arm/a.h", _header("#include <x>\n#include <y>")), ("arm/b.h", _header("class B;"))])
    including.add("2.0.0", [("arm/a.h", _header("#include <y>\n#include <x>"))])
    including.add("3.0.0", [("arm/a.h", _header("#include <x>\n#include <y>"))], True)
    included = read_packed(including.pack_versions(), Included)
    written = {version: included.list_includes("arm/a.h", version) for version in ("1.0.0", "2.0.0", "3.0.0", "4.0.0")}
    assert {version: None if told is None else [one.path for one in told] for version, told in written.items()} == {
        "1.0.0": ["x", "y"],
        "2.0.0": ["y", "x"],
        "3.0.0": ["x", "y"],
        "4.0.0": None,
    }
    assert included.list_includes("arm/b.h", "1.0.0") == () and included.list_includes("arm/b.h", "2.0.0") is None
    assert (
        included.list_announced_types("arm/b.h", "1.0.0") == ("B",)
        and included.list_announced_types("arm/b.h", "2.0.0") == ()
    )
    # A branch stands for no other version.
    stands = {version: included.stands_for(version) for version in ("0.5.0", "1.5.0", "3.5.0")}
    assert stands == {"0.5.0": None, "1.5.0": "1.0.0", "3.5.0": "2.0.0"}


def _surface(package, version, headers, messages):
    definitions = tuple((name, interface(text.encode(), name.partition("/")[0])) for name, text in messages.items())
    read = tuple((path, _header("\n".join(f"#include {one}" for one in lines))) for path, lines in headers.items())
    return Surface(package, version, BuildSurface(package), PythonSurface(package), read, definitions)


@pytest.fixture
def machine(tmp_path):
    """A function that gives a machine with these versions of packages, of which version to headers are stored. Beside
    them it has GCC 13 and generators."""

    def made(stored, versions, ros=2, messages=None):
        packing = Packing()
        for package, each in stored.items():
            for version, headers in each.items():
                one = _surface(package, version, headers, (messages or {}).get(package, {}))
                packing.add(package, version, (ros,), RepositorySurfaces({package: one}))
        write(tmp_path / "x", packing.pack_packages())
        generators = {"gencpp": "<gencpp>", "rosidl_generator_cpp": "<rosidl_generator_cpp>"}
        owners = {owner: {pattern: "0 0"} for owner, pattern in generators.items()}
        table = IncludesTable(
            ("string",), {**owners, "rope": {"rope/rope.h": "1.0 0"}}, frozenset(("rope",)), frozenset()
        )
        versions = {"gcc": "13", "gencpp": "0.6.5", "rosidl_generator_cpp": "3.1.0", "rope": "1.2", **versions}
        return HeadersOfMachine(ros, lambda owner, _: versions.get(owner), Includes(table), Surfaces(tmp_path / "x"))

    return made


ARM = {
    "arm": {
        "1.0.0": {"arm/all.hpp": ['"arm/joint.hpp"', "<leg/leg.hpp>"], "arm/joint.hpp": ["<rope/rope.h>"]},
        "2.0.0": {"arm/all.hpp": ['"joint.hpp"'], "arm/joint.hpp": ['"../hand/hand.h"'], "hand/hand.h": ["<gone.h>"]},
    },
    "leg": {"0.5.0": {"leg/leg.hpp": ["<leg/visibility.h>", "<body/body.h>"]}},
}


@pytest.mark.parametrize(
    ("version", "brought", "outside"),
    [
        (
            "1.0.0",
            {"arm/joint.hpp", "rope/rope.h", "leg/leg.hpp", "leg/visibility.h", "body/body.h"},
            {"leg/visibility.h", "body/body.h"},
        ),
        ("1.4.0", {"arm/joint.hpp", "rope/rope.h", "leg/leg.hpp"}, {"leg/visibility.h", "body/body.h"}),
        ("2.0.0", {"arm/joint.hpp", "hand/hand.h", "gone.h"}, {"gone.h"}),
    ],
)
def test_what_a_header_brings_along_through_packages(machine, version, brought, outside):
    told = machine(ARM, {"arm": version, "leg": "0.5.0"}).find_brought("arm/all.hpp")
    assert brought <= told.headers and "arm/all.hpp" in told.headers
    assert ("leg/leg.hpp" in told.headers) == (version < "2")
    assert told.outside == outside


def test_a_package_that_is_not_there_is_outside(machine):
    told = machine(ARM, {"arm": "1.0.0"}).find_brought("arm/all.hpp")
    assert told.outside == {"leg/leg.hpp"} and "rope/rope.h" in told.headers


def test_versions_older_than_all_are_not_known(machine):
    known = machine(ARM, {"arm": "0.9.0"})
    assert known.find_brought("arm/all.hpp").outside == {"arm/all.hpp"}
    assert known.find_owner("arm/all.hpp") is None and known.knows("arm/all.hpp") and not known.knows("arm/none.hpp")


def test_whose_a_header_is(machine):
    known = machine(ARM, {"arm": "2.3.0"})
    assert [known.find_owner(header) for header in ("arm/all.hpp", "hand/hand.h", "rope/rope.h", "leg/leg.hpp")] == [
        ("arm", "2.3.0"),
        ("arm", "2.3.0"),
        ("rope", "1.2"),
        None,
    ]


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("if LEG_VERSION_GTE(0, 6, 0)", False),
        ("if LEG_VERSION_GTE(0, 4, 0)", True),
        ("if __has_include(<leg/leg.hpp>)", True),
        ("if __has_include(<leg/old.hpp>)", False),
        ("if __has_include(<tail/tail.hpp>)", True),
        ("ifdef WITH_LEG", True),
    ],
)
def test_an_include_counts_unless_its_condition_surely_fails(machine, condition, expected):
    arm = f"x>\n#{condition}\n#include <y>\n#endif\n#include <z"
    leg = {"0.4.0": {"leg/old.hpp": []}, "0.5.0": {"leg/leg.hpp": []}}
    known = machine({"arm": {"1.0.0": {"arm/a.hpp": [f"<{arm}>"]}}, "leg": leg}, {"arm": "1.0.0", "leg": "0.5.0"})
    assert known.includes("arm/a.hpp") == (("x", "y", "z") if expected else ("x", "z"))


MESSAGES = {
    "arm_msgs": {"msg/Grip": "hand_msgs/Finger[] fingers\nfloat64 x", "srv/Hold": "Grip g\n---\nbool b"},
    "hand_msgs": {"msg/Finger": "std_msgs/Header h"},
    "std_msgs": {"msg/Header": "time stamp"},
}
GRIP = "arm_msgs/msg/detail/grip"


@pytest.mark.parametrize(
    ("ros", "header", "expected"),
    [
        (1, "arm_msgs/Grip.h", {"hand_msgs/Finger.h", "std_msgs/Header.h", "string"}),
        (1, "arm_msgs/Hold.h", {"arm_msgs/HoldRequest.h", "arm_msgs/Grip.h", "hand_msgs/Finger.h"}),
        (
            2,
            "arm_msgs/msg/grip.hpp",
            {f"{GRIP}__struct.hpp", "hand_msgs/msg/detail/finger__traits.hpp"},
        ),
        (
            2,
            "arm_msgs/srv/hold.hpp",
            {f"{GRIP}__struct.hpp", "std_msgs/msg/detail/header__struct.hpp"},
        ),
    ],
)
def test_what_headers_of_messages_bring_along(machine, ros, header, expected):
    stored = {package: {"1.0.0": {}} for package in MESSAGES}
    told = machine(stored, dict.fromkeys(MESSAGES, "1.0.0"), ros, MESSAGES).find_brought(header)
    assert expected <= told.headers and not told.outside
    # A header that a field's type has for its users is not taken in by ROS 2's.
    assert "hand_msgs/msg/finger.hpp" not in told.headers
