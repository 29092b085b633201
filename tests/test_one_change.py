"""One edit, wherever it is: what is remembered of the run before is used where nothing changed, and only there.

Every edit here is made to one package and changes what is true of another one. The answer of a cache that knows the
workspace as it was has to be that of an empty one.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import rule_cases
from msgspec import structs
from rosimpact.impact.analysis import run_rules
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options, open_workspace
from rosimpact.impact.model import tracked_names as watch
from rosimpact.impact.model import workspace
from rosimpact.impact.model.package import _INWARD, is_header
from rosimpact.impact.model.view import TargetView
from rosimpact.impact.model.workspace import Package, Workspace
from rosimpact.impact.rules.rule import load_rules

MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
{depends}<export><build_type>ament_cmake</build_type></export></package>
"""
# arm uses what hand has, declares or gives its dependants; hand uses tip.
FILES = {
    "hand/package.xml": MANIFEST.format(
        name="hand", depends="<depend>angles</depend>\n<depend>tip</depend>\n<exec_depend>rclpy</exec_depend>\n"
    ),
    "hand/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(hand)
find_package(ament_cmake REQUIRED)
find_package(angles REQUIRED)
find_package(tip REQUIRED)
add_library(hand src/hand.cpp)
target_include_directories(hand PUBLIC include)
ament_target_dependencies(hand angles tip)
install(DIRECTORY include/ DESTINATION include)
install(TARGETS hand DESTINATION lib)
ament_export_libraries(hand)
ament_export_dependencies(angles)
ament_package(CONFIG_EXTRAS cmake/hand.cmake)
""",
    "hand/cmake/hand.cmake": """macro(hand_setup)
  find_package(rclcpp REQUIRED)
endmacro()
""",
    "hand/include/hand/hand.hpp": "#include <angles/angles.h>\nint hand();\n",
    "hand/include/hand/finger.hpp": "int finger();\n",
    "hand/cmake/grip-config.cmake.in": "set(grip_FOUND TRUE)\n",
    "hand/hand_tools/__init__.py": "",
    "hand/src/hand.cpp": "#include <hand/hand.hpp>\n#include <tip/tip.hpp>\nint hand() { return 1; }\n",
    "tip/package.xml": MANIFEST.format(name="tip", depends=""),
    "tip/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(tip)
find_package(ament_cmake REQUIRED)
add_library(tip INTERFACE)
install(DIRECTORY include/ DESTINATION include)
install(TARGETS tip DESTINATION lib)
ament_package()
""",
    "tip/include/tip/tip.hpp": "int tip();\n",
    "tip/include/tip/nail.hpp": "int nail();\n",
    "hand_msgs/package.xml": MANIFEST.format(
        name="hand_msgs",
        depends="<build_depend>rosidl_default_generators</build_depend>\n<exec_depend>rosidl_default_runtime</exec_depend>"
        "\n<member_of_group>rosidl_interface_packages</member_of_group>\n",
    ),
    "hand_msgs/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(hand_msgs)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} "msg/Grip.msg" "msg/Touch.msg")
ament_package()
""",
    "hand_msgs/msg/Grip.msg": "int32 force\n",
    "hand_msgs/msg/Touch.msg": "int32 where\n",
    "arm/package.xml": MANIFEST.format(
        name="arm",
        depends="<depend>hand</depend>\n<depend>hand_msgs</depend>\n<depend>rclcpp</depend>\n<depend>our_secret</depend>\n",
    ),
    "arm/CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
find_package(hand REQUIRED)
find_package(hand_msgs REQUIRED)
find_package(grip)
hand_setup()
add_executable(arm src/arm.cpp)
ament_target_dependencies(arm hand hand_msgs rclcpp)
install(TARGETS arm DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/wave.py DESTINATION lib/${PROJECT_NAME})
ament_package()
""",
    "arm/src/arm.cpp": "#include <hand/hand.hpp>\n#include <hand/finger.hpp>\n#include <angles/angles.h>\n"
    "#include <rclcpp/rclcpp.hpp>\n#include <hand_msgs/msg/grip.hpp>\nint main() { return hand(); }\n",
    "arm/scripts/wave.py": "#!/usr/bin/env python3\nimport hand_tools\n",
}


@pytest.fixture
def ws(tmp_path) -> Path:
    for name, text in FILES.items():
        path = tmp_path / "ws" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "ws"


@pytest.fixture
def run(cache, tmp_path, monkeypatch) -> Callable[..., list]:
    """Findings of a workspace with a named cache of facts; each name has a folder of its own."""
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))

    def findings(ws: Path, name: str) -> list:
        report = check(ws, Options(targets=("jazzy", "humble"), preview=True, cache=tmp_path / name))
        return [report.findings, report.coverage]

    return findings


def replaced(path: str, old: str, new: str) -> Callable[[Path], None]:
    def edit(ws: Path) -> None:
        text = (ws / path).read_text()
        assert old in text
        (ws / path).write_text(text.replace(old, new))

    return edit


def removed(path: str) -> Callable[[Path], None]:
    return lambda ws: (ws / path).unlink()


def added(path: str, text: str) -> Callable[[Path], None]:
    return lambda ws: (ws / path).write_text(text)


# What is edited, the edit, and the package of which something else is said then (none: what is unresolved).
EDITS = [
    ("a header goes", removed("tip/include/tip/tip.hpp"), "hand"),
    ("a declared dependency goes", replaced("hand/package.xml", "<depend>angles</depend>", ""), "arm"),
    ("a declared kind changes", replaced("hand/package.xml", "<depend>angles<", "<test_depend>angles<"), "hand"),
    ("a macro finds less", replaced("hand/cmake/hand.cmake", "find_package(rclcpp REQUIRED)", ""), "arm"),
    ("a macro goes", removed("hand/cmake/hand.cmake"), "arm"),
    ("a package is ignored", added("hand/COLCON_IGNORE", ""), "arm"),
    ("a package is renamed", replaced("tip/package.xml", "<name>tip<", "<name>top<"), "hand"),
    ("a package includes another", added("hand/src/hand.cpp", "#include <arm/arm.hpp>\n"), "hand"),
    ("an export goes", replaced("hand/CMakeLists.txt", "ament_export_dependencies(angles)\n", ""), "hand"),
    ("nobody includes it any more", replaced("hand/src/hand.cpp", "#include <tip/tip.hpp>\n", ""), "tip"),
    ("a message goes", removed("hand_msgs/msg/Grip.msg"), "arm"),
    ("a CMake configuration goes", removed("hand/cmake/grip-config.cmake.in"), ""),
    ("a Python module goes", removed("hand/hand_tools/__init__.py"), ""),
    ("a cycle", replaced("tip/package.xml", "<export>", "<depend>arm</depend><export>"), "arm"),
    ("a name is private", added("rosimpact.toml", '[workspace]\nprivate = ["our_secret"]\n'), "arm"),
]


@pytest.mark.parametrize(("edit", "concerned"), [e[1:] for e in EDITS], ids=[e[0] for e in EDITS])
def test_what_is_remembered_never_hides_a_change(ws, run, edit, concerned):
    before = run(ws, "kept")
    assert run(ws, "kept") == before
    edit(ws)
    fresh = run(ws, "fresh")
    assert run(ws, "kept") == fresh
    assert run(ws, "kept") == fresh
    # An edit that changes nothing would show nothing.
    assert about(concerned, before) != about(concerned, fresh)


def about(package: str, found: list) -> list:
    """Findings of a package; everything, what could not be resolved included, without one."""
    return [finding for finding in found[0] if finding.package == package] if package else found


def test_edits_one_after_the_other_and_back(ws, run):
    first = run(ws, "kept")
    for _, edit, _ in EDITS:
        text = {path: path.read_bytes() for path in ws.rglob("*") if path.is_file()}
        edit(ws)
        run(ws, "kept")
        for path in [path for path in ws.rglob("*") if path.is_file() and path not in text]:
            path.unlink()
        for path, data in text.items():
            path.write_bytes(data)
        assert run(ws, "kept") == first


def test_a_package_of_the_workspace_is_not_the_released_one(ws, run):
    source = ws / "arm/src/arm.cpp"
    source.write_text(source.read_text().replace("hand();", "rclcpp::copy_all_parameter_values(a, b), hand();"))
    (told,) = [finding for finding in run(ws, "kept")[0] if finding.rule == "removed-symbol"]
    assert "rclcpp::copy_all_parameter_values" in told.message and told.targets == ("humble",)
    (ws / "rclcpp").mkdir()
    (ws / "rclcpp/package.xml").write_text(MANIFEST.format(name="rclcpp", depends=""))
    assert not [finding for finding in run(ws, "kept")[0] if finding.rule == "removed-symbol"]


@pytest.fixture
def across(ws) -> Path:
    """arm uses a member whose type only a header of hand shows."""
    member = "nav2_costmap_2d::Costmap2DPublisher * map;"
    header = f"#include <nav2_costmap_2d/costmap_2d_publisher.hpp>\nstruct Grip {{ {member} }};\n"
    (ws / "hand/include/hand/grip.hpp").write_text(header)
    replaced("hand/package.xml", "<export>", "<depend>nav2_costmap_2d</depend><export>")(ws)
    (ws / "hand/include/hand/hand.hpp").write_text('#include "grip.hpp"\nint hand();\n')
    source = ws / "arm/src/arm.cpp"
    source.write_text(source.read_text() + "bool is_active(Grip & grip) { return grip.map->active(); }\n")
    return ws


@pytest.mark.parametrize(
    ("old", "new", "still", "joined"),
    [
        ("struct", "// What the arm grips.\nstruct", True, []),
        ("Costmap2DPublisher * map", "Costmap2DROS * map", False, ["arm", "hand"]),
        ("struct Grip", "struct Claw", False, ["arm", "hand"]),
    ],
)
def test_a_header_of_another_package(across, run, monkeypatch, old, new, still, joined):
    def list_removed() -> list[str]:
        return [one.path for one in run(across, "kept")[0] if one.rule == "removed-symbol" and "active" in one.subject]

    assert list_removed() == ["arm/src/arm.cpp"]
    anew: list[str] = []
    combine = workspace._Linker.combine
    monkeypatch.setattr(
        workspace._Linker, "combine",
        lambda self, places, stale: anew.extend(p.name for p in places) or combine(self, places, stale),
    )  # fmt: skip
    replaced("hand/include/hand/grip.hpp", old, new)(across)
    assert list_removed() == (["arm/src/arm.cpp"] if still else [])
    assert [name for name in sorted(anew) if name != "hand"] == [name for name in joined if name != "hand"]


JUDGED = [
    ("nothing", lambda ws: None, False),
    ("a comment in a header", replaced("hand/include/hand/hand.hpp", "int hand();", "int hand();  // grips"), False),
    ("a comment in a macro", replaced("hand/cmake/hand.cmake", "endmacro()", "endmacro()  # done"), False),
    ("a function's body", replaced("hand/src/hand.cpp", "return 1;", "return 2;"), False),
    ("an include in a header", replaced("hand/include/hand/hand.hpp", "int", "#include <vector>\nint"), True),
    ("a call in a macro", replaced("hand/cmake/hand.cmake", "REQUIRED)", "REQUIRED)\n  find_package(tip)"), True),
]


@pytest.mark.parametrize(("edit", "anew"), [row[1:] for row in JUDGED], ids=[row[0] for row in JUDGED])
def test_rules_run_only_when_a_digest_changed(ws, run, monkeypatch, edit, anew):
    run(ws, "kept")
    edit(ws)
    ran = record_groups(monkeypatch)
    run(ws, "kept")
    assert [target for target, _ in ran] == (["jazzy", "humble"] if anew else [])


def record_groups(monkeypatch) -> list[tuple[str, tuple[str, ...]]]:
    """The targets and groups of packages that rules are run on from now on."""
    ran: list[tuple[str, tuple[str, ...]]] = []
    run_in_parts = run_rules._run_in_parts

    def record(opened, rules, fresh, *rest):
        ran.extend((opened.views[place].target.name, opened.workspace.groups[at]) for place, at in fresh)
        return run_in_parts(opened, rules, fresh, *rest)

    monkeypatch.setattr(run_rules, "_run_in_parts", record)
    return ran


def test_names_to_look_out_for_are_gathered_once(ws, run, monkeypatch):
    first = run(ws, "kept")
    monkeypatch.setattr(watch, "load_watched", _refuse)
    assert run(ws, "kept") == first


def _refuse():
    raise AssertionError("what was gathered before is to be read")


class _Unseen:
    """Stands for what no rule that is remembered may look at: the digests' identity does not speak of it."""

    def __getattr__(self, name: str):
        raise AssertionError(f"a rule asked for `{name}` of what is no digest")


CASES = [case for case in rule_cases.find_cases() if case.findings]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_rules_per_target_see_nothing_but_digests(case, cache, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    rules = [rule for rule in load_rules().values() if rule.scope == "target"]
    options, tree = Options(targets=("jazzy", "noetic"), cache=cache), rule_cases.MemoryTree(case.files)
    with open_workspace("case", options, tree=tree) as opened:
        for view in opened.views:
            whole = [list(rule.run(view)) for rule in rules]
            digests = [package.linked for package in opened.workspace]
            unseen: object = _Unseen()
            # The identity speaks of what was not read, and of files outside of packages, too.
            ros, unread, outside = opened.workspace.ros, opened.workspace.unread, opened.workspace.outside
            bare = Workspace(digests, unseen, ros, unseen, unseen, unread=unread, outside=outside)  # type: ignore[arg-type]
            again = TargetView(bare, view.target, view.providers, view.config)
            assert [list(rule.run(again)) for rule in rules] == whole


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_rules_per_target_see_nothing_of_the_code_of_other_groups(case, cache, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    monkeypatch.setattr(workspace, "_SMALL_GROUP", 1)
    rules = [rule for rule in load_rules().values() if rule.scope == "target"]
    options, tree = Options(targets=("jazzy", "noetic"), cache=cache), rule_cases.MemoryTree(case.files)
    with open_workspace("case", options, tree=tree) as opened:
        known = opened.workspace
        for group in known.groups if len(known.groups) > 1 else ():
            linked = [
                each.linked
                if each.name in group
                else structs.replace(
                    each.linked, names=tuple(n for n in each.linked.names if is_header(n.at.path)), **_INWARD
                )
                for each in known
            ]
            less = Workspace(
                *(linked, known.discovered, known.ros, known.extraction, known.read),
                unread=known.unread,
                outside=known.outside,
            )
            for view in opened.views:
                again = TargetView(less, view.target, view.providers, view.config)
                view.part = again.part = frozenset(group)
                assert [list(rule.run(again)) for rule in rules] == [list(rule.run(view)) for rule in rules]


def add_lone(ws: Path) -> None:
    """Adds a package that has to do with no other."""
    for name in ("package.xml", "CMakeLists.txt", "include/tip/tip.hpp"):
        path = ws / "lone" / name.replace("tip", "lone")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text((ws / "tip" / name).read_text().replace("tip", "lone"))


def test_an_edit_of_code_has_the_rules_run_on_its_group_alone(ws, run, monkeypatch):
    monkeypatch.setattr(workspace, "_SMALL_GROUP", 1)
    add_lone(ws)
    run(ws, "kept")
    replaced("hand/include/hand/hand.hpp", "int", "#include <nowhere/nothing.hpp>\nint")(ws)
    ran = record_groups(monkeypatch)
    assert run(ws, "kept") == run(ws, "fresh")
    kept, fresh = ran[:2], ran[2:]
    assert [group for _, group in kept] == [("arm", "hand", "hand_msgs", "tip")] * 2
    assert {group for _, group in fresh} == {("arm", "hand", "hand_msgs", "tip"), ("lone",)}


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("lone/package.xml", "<export>", "<depend>tip</depend><export>"),
        ("lone/CMakeLists.txt", "ament_package()", "find_package(tip)\nament_package()"),
        ("lone/CMakeLists.txt", "ament_package()", "find_package(grip)\nament_package()"),
        ("lone/include/lone/lone.hpp", "int lone();", "#include <tip/tip.hpp>\n"),
        ("lone/include/lone/lone.hpp", "int lone();", "#include <tip/gone.hpp>\n"),
        ("tip/include/tip/nail.hpp", "int nail();", '#include "lone.hpp"\n'),
        ("lone/setup_it.py", "", "import hand_tools\n"),
        ("lone/launch/all.launch.py", "", "launch_ros.actions.Node(package='arm', executable='arm')\n"),
        ("lone/msg/Part.msg", "", "hand_msgs/Touch where\n"),
    ],
)
def test_a_package_is_of_the_group_of_what_it_names(ws, monkeypatch, tmp_path, path, old, new):
    monkeypatch.setattr(workspace, "_SMALL_GROUP", 1)
    add_lone(ws)

    def list_groups() -> list[tuple[str, ...]]:
        with open_workspace(ws, Options(targets=("jazzy",), cache=tmp_path / "facts")) as opened:
            return list(opened.workspace.groups)

    assert list_groups() == [("arm", "hand", "hand_msgs", "tip"), ("lone",)]
    file = ws / path
    file.parent.mkdir(exist_ok=True)
    before = file.read_text() if file.exists() else ""
    file.write_text(before.replace(old, new) if old else before + new)
    assert list_groups() == [("arm", "hand", "hand_msgs", "lone", "tip")]


def test_a_package_says_nothing_that_its_digest_does_not(ws, run, cache, tmp_path):
    with open_workspace(ws, Options(targets=("jazzy",), cache=tmp_path / "facts")) as opened:
        for package in opened.workspace:
            kept = {name for name, value in vars(package).items() if value is not package.linked}
            assert kept == {"name", "path", "manifest", "build", "build_type"}
            assert all(getattr(package, name) is getattr(package.linked, name) for name in kept)
            assert isinstance(package, Package)


def test_what_is_asked_of_names_that_grow_is_answered_anew(ws, run, cache, tmp_path):
    with open_workspace(ws, Options(targets=("jazzy",), cache=tmp_path / "facts")) as opened:
        (view,) = opened.views
        providers, names = view.find_header("angles/angles.h"), {"rclcpp"}
        assert not view.is_met(providers, names)
        names.add("angles")
        assert view.is_met(providers, names)
        assert view.is_met(providers, frozenset({"angles"})) and not view.is_met(providers, frozenset({"rclpy"}))
        with pytest.raises(TypeError):
            view.collect_declared(opened.workspace.packages["arm"])["angles"] = {"build"}  # type: ignore[index]
