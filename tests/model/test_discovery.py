"""Which folders are packages: as colcon finds them, with the differences the module names."""

import os

import pytest
from rosimpact.impact.facts.extract import extract_all
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.discovery import detect_generation, discover
from rosimpact.impact.tree import WorkingTree


def manifest(name):
    return (
        f"<package format='3'><name>{name}</name><version>1.0.0</version><description>d</description>"
        "<maintainer email='m@example.org'>m</maintainer><license>MIT</license></package>"
    )


def find(root, files, ask=discover):
    """files: content by path; `->x` is a link. ask: what is asked of the files."""
    for path, text in files.items():
        place = root / "ws" / path
        place.parent.mkdir(parents=True, exist_ok=True)
        if text.startswith("->"):
            os.symlink(text[2:], place)
        else:
            place.write_text(text)
    (root / "ws").mkdir(exist_ok=True)
    tree = WorkingTree(root / "ws")
    with Store(root / "cache") as store:
        extraction = extract_all(tree, store, jobs=1)
        found = discover(tree, extraction)
        return found if ask is discover else ask(found, extraction)


A, B = manifest("a"), manifest("b")
CMAKE = "project(lib)\n"
SETUP = "from setuptools import setup\nsetup(name='tool')\n"

# files, {path: name} of packages with a manifest, {path: name} of packages without
FOUND = {
    "side by side": ({"src/a/package.xml": A, "src/b/package.xml": B}, {"src/a": "a", "src/b": "b"}, {}),
    "the root is a package": ({"package.xml": A, "b/package.xml": B}, {"": "a"}, {}),
    "nothing below a package": (
        {"a/package.xml": A, "a/x/b/package.xml": B, "a/CMakeLists.txt": CMAKE},
        {"a": "a"},
        {},
    ),
    "the folder's name does not matter": ({"src/some-repo/package.xml": A}, {"src/some-repo": "a"}, {}),
    "a name that is another's beginning": ({"a/package.xml": A, "a_b/package.xml": B}, {"a": "a", "a_b": "b"}, {}),
    "ignored": ({"a/package.xml": A, "b/COLCON_IGNORE": "", "b/package.xml": B}, {"a": "a"}, {}),
    "hidden": ({"a/package.xml": A, ".b/package.xml": B, "c/.d/CMakeLists.txt": CMAKE}, {"a": "a"}, {}),
    "plain CMake": ({"a/package.xml": A, "lib/CMakeLists.txt": CMAKE}, {"a": "a"}, {"lib": "lib"}),
    "plain CMake below plain CMake": ({"l/CMakeLists.txt": CMAKE, "l/m/setup.py": SETUP}, {}, {"l": "lib"}),
    "a manifest below plain CMake": ({"l/CMakeLists.txt": CMAKE, "l/a/package.xml": A}, {"l/a": "a"}, {"l": "lib"}),
    "CMake without a name": ({"some_lib/CMakeLists.txt": "cmake_minimum_required()"}, {}, {"some_lib": "some_lib"}),
    "a name in a comment": ({"l/CMakeLists.txt": '# project(no)\nPROJECT( "yes" CXX )'}, {}, {"l": "yes"}),
    "catkin's top level file": (
        {"src/CMakeLists.txt": "# toplevel\nproject(Project)\ncatkin_workspace()\n", "src/a/package.xml": A},
        {"src/a": "a"},
        {},
    ),
    "a link to catkin's top level file": (
        {"src/CMakeLists.txt": "->/nowhere/toplevel.cmake", "src/a/package.xml": A},
        {"src/a": "a"},
        {},
    ),
    "plain Python": ({"t/setup.py": SETUP}, {}, {"t": "tool"}),
    "Python named in setup.cfg": (
        {"t/setup.py": "setup()", "t/setup.cfg": "[flake8]\nname = no\n[metadata]\nversion = 1\nname = cfg-tool\n"},
        {},
        {"t": "cfg-tool"},
    ),
    "Python named by a variable": (
        {"t/setup.py": "from setuptools import setup\npackage_name = 'v'\nsetup(\n name=package_name,\n)"},
        {},
        {"t": "v"},
    ),
    "Python named in pyproject.toml": (
        {
            "t/setup.py": "import setuptools\nsetuptools.setup()",
            "t/pyproject.toml": "[tool.x]\nname = 'no'\n[project]\nversion='1'\nname = 'toml'\n",
        },
        {},
        {"t": "toml"},
    ),
    "Python without a name": ({"t/setup.py": "setup()"}, {}, {}),
    "pyproject.toml alone": ({"t/pyproject.toml": "[project]\nname='t'"}, {}, {}),
    "rosbuild": (
        {"old/manifest.xml": "<package/>", "old/CMakeLists.txt": CMAKE, "old/l/CMakeLists.txt": CMAKE},
        {},
        {},
    ),
    "a manifest without a name": ({"odd/package.xml": "<package format='3'/>"}, {"odd": "odd"}, {}),
    "a manifest that is cut off": ({"odd/package.xml": "<package><name>od"}, {"odd": "odd"}, {}),
    "a link to a package": ({"pkgs/z/package.xml": A, "src/a": "->../pkgs/z"}, {"pkgs/z": "a"}, {}),
    "a link to an ignored package": (
        {"store/COLCON_IGNORE": "", "store/a/package.xml": A, "src/a": "->../store/a"},
        {"src/a": "a"},
        {},
    ),
    "a link to a folder of packages": ({"z/a/package.xml": A, "s": "->z"}, {"z/a": "a"}, {}),
    "colcon.pkg gives a name": ({"l/CMakeLists.txt": CMAKE, "l/colcon.pkg": "name: mine\n"}, {}, {"l": "mine"}),
    "colcon.pkg alone": ({"l/colcon.pkg": "{name: mine, type: bazel}"}, {}, {"l": "mine"}),
    "colcon.pkg says too little": ({"l/colcon.pkg": "name: mine"}, {}, {}),
    "colcon.pkg beside a manifest": ({"a/package.xml": A, "a/colcon.pkg": "{name: mine}"}, {"a": "mine"}, {}),
    "colcon.pkg is no YAML": ({"a/package.xml": A, "a/colcon.pkg": "{{"}, {"a": "a"}, {}),
    "colcon.meta by path": (
        {"colcon.meta": "{paths: {./l: {name: meta, type: cmake}}}", "l/CMakeLists.txt": CMAKE},
        {},
        {"l": "meta"},
    ),
    "colcon.meta is something else": ({"colcon.meta": "[1, 2]", "a/package.xml": A}, {"a": "a"}, {}),
    "packages-ignore": (
        {"colcon_defaults.yaml": "build: {packages-ignore: [a]}", "a/package.xml": A, "b/package.xml": B},
        {"b": "b"},
        {},
    ),
    "packages-skip-regex": (
        {"defaults.yaml": "{build: {packages-skip-regex: ['a.*', '(']}}", "a/package.xml": A, "b/package.xml": B},
        {"b": "b"},
        {},
    ),
    "base-paths": (
        {"colcon_defaults.yaml": "build: {base-paths: [src, ../x]}", "a/package.xml": A, "src/b/package.xml": B},
        {"src/b": "b"},
        {},
    ),
    "base-paths with a wildcard": (
        {
            "colcon_defaults.yaml": "build: {base-paths: ['*/src']}",
            "one/src/a/package.xml": A,
            "two/src/b/package.xml": B,
            "two/other/c/package.xml": manifest("c"),
        },
        {"one/src/a": "a", "two/src/b": "b"},
        {},
    ),
    "paths beside base-paths": (
        {
            "colcon_defaults.yaml": "build: {base-paths: [two], paths: [src/*]}",
            "src/b/package.xml": B,
            "src/g/a/package.xml": A,
            "two/x/c/package.xml": manifest("c"),
        },
        {"src/b": "b", "two/x/c": "c"},
        {},
    ),
    "defaults of another tool": ({"defaults.yaml": "robot: {speed: 1}", "a/package.xml": A}, {"a": "a"}, {}),
    "two manifests to choose from": (
        {"a/package_ROS1.xml": manifest("one"), "a/package_ROS2.xml": manifest("two"), "a/CMakeLists.txt": CMAKE},
        {"a": "two"},
        {},
    ),
    "nothing": ({}, {}, {}),
}


@pytest.mark.parametrize(("files", "packages", "foreign"), FOUND.values(), ids=FOUND)
def test_what_is_found(tmp_path, files, packages, foreign):
    found = find(tmp_path, files)
    assert {place.path: place.name for place in found.packages} == packages
    assert {place.path: place.name for place in found.foreign} == foreign


def test_nested_manifests_are_told(tmp_path):
    found = find(tmp_path, {"a/package.xml": A, "a/test/ws/b/package.xml": B, "a/lib/package.xml": B})
    assert found.packages[0].nested == ("a/lib/package.xml", "a/test/ws/b/package.xml")


def test_what_colcon_would_not_look_for_is_told(tmp_path):
    found = find(tmp_path, {"l/CMakeLists.txt": CMAKE, "l/ros/a/package.xml": A})
    assert found.packages[0].hidden_by == "lib"


def test_variants(tmp_path):
    files = {
        "a/package.xml": A,
        "a/package.ros2.xml": A,
        "a/package_ros1.xml": A,
        "a/package-lock.xml": "",
        "a/package3.xml": "",
    }
    place = find(tmp_path, files).packages[0]
    assert place.manifest_path == "a/package.xml"
    assert place.variants == ((1, "a/package_ros1.xml"), (2, "a/package.ros2.xml"))


def test_a_manifest_chosen_among_variants(tmp_path):
    files = {"a/package_ROS1.xml": A, "a/package_ROS2.xml": A, "b/package_ROS1.xml": B}
    assert [p.manifest_path for p in find(tmp_path, files).packages] == ["a/package_ROS2.xml", "b/package_ROS1.xml"]


def test_ignored_packages_are_told(tmp_path):
    found = find(tmp_path, {"colcon_defaults.yaml": "build: {packages-skip: a}", "a/package.xml": A})
    assert [(place.name, place.ignored) for place in found.ignored] == [("a", "packages-skip in colcon_defaults.yaml")]
    assert found.find_owner("a/x.cpp") is None


@pytest.mark.parametrize("name", ["{{cookiecutter.name}}", "@(name)", "${NAME}", "<name>", "%name%"])
def test_templates_of_packages_are_left_out(tmp_path, name):
    manifest = A.replace("<name>a</name>", f"<name>{name.replace('<', '&lt;').replace('>', '&gt;')}</name>")
    found = find(tmp_path, {"template/package.xml": manifest, "b/package.xml": B})
    assert [place.name for place in found.packages] == ["b"]
    assert [place.path for place in found.ignored] == ["template"]


def test_duplicates_are_told(tmp_path):
    found = find(tmp_path, {"one/package.xml": A, "two/package.xml": A, "b/package.xml": B})
    assert found.duplicates == (("a", "one", "two"),)


def test_settings_that_cannot_be_read_are_told(tmp_path):
    found = find(tmp_path, {"colcon.meta": "a: [", "colcon_defaults.yaml": "build: {base-paths: [/elsewhere]}"})
    assert [(p.path, p.message.split(" (")[0]) for p in found.problems] == [
        ("colcon.meta", "is no YAML"),
        ("colcon_defaults.yaml", "`/elsewhere` lies outside of the workspace and is not read"),
    ]


def test_patterns_that_take_too_long_match_nothing(tmp_path):
    long = "b" * 200
    patterns = ", ".join([*(f"'(x{{300}}){{9}}{letter}'" for letter in "abcdefghijkl"), "'b'"])
    files = {"colcon_defaults.yaml": f"build: {{packages-skip-regex: [{patterns}]}}", "b/package.xml": B}
    found = find(tmp_path, {**files, "c/package.xml": manifest(long)})
    assert [place.name for place in found.packages] == [long]
    assert [problem.message for problem in found.problems] == [
        "packages-skip-regex: takes too long, the rest of it is not matched"
    ]


def test_extra_dependencies(tmp_path):
    files = {
        "colcon.meta": "names: {a: {dependencies: [x], cmake-args: [-DA=1]}, c: {dependencies: [no]}}",
        "a/package.xml": A,
        "l/CMakeLists.txt": CMAKE,
        "l/colcon.pkg": "{dependencies: [y], run-dependencies: [z, y]}",
    }
    found = find(tmp_path, files)
    assert [place.extra_dependencies for place in (*found.packages, *found.foreign)] == [("x",), ("y", "z")]


def test_repositories(tmp_path):
    for folder in ("src/one", "src/two/p"):
        (tmp_path / "ws" / folder / ".git").mkdir(parents=True)
    files = {
        "src/one/package.xml": A,
        "src/two/p/q/package.xml": B,
        "src/own/package.xml": manifest("own"),
        "src/two/l/CMakeLists.txt": CMAKE,
    }
    assert find(tmp_path, files).repositories == {
        "src/one": "src/one",
        "src/two/p/q": "src/two/p",
        "src/own": None,
        "src/two/l": None,
    }


# path, name of the owner
OWNERS = [
    ("src/a/package.xml", "a"), ("src/a", "a"), ("src/a/deep/er/x.cpp", "a"), ("src/a_b/x", "b"), ("src/a.txt", None),
    ("src", None), ("x", None), ("", None), ("src/l/x.cpp", None), ("src/l/ros/x.cpp", "c"),
]  # fmt: skip


def test_owners(tmp_path):
    files = {
        "src/a/package.xml": A,
        "src/a_b/package.xml": B,
        "src/l/CMakeLists.txt": CMAKE,
        "src/l/ros/package.xml": manifest("c"),
    }
    found = find(tmp_path, files)
    for _ in ("asked", "asked again"):
        owners = [(path, found.find_owner(path)) for path, _ in OWNERS]
        assert [(path, place.name if place else None) for path, place in owners] == OWNERS


def test_the_root_owns_everything_below_it(tmp_path):
    found = find(tmp_path, {"package.xml": A})
    assert [found.find_owner(path).name for path in ("", "x", "a/b/c")] == ["a"] * 3


def of_build(*lines):
    return manifest("x").replace("</package>", "".join(lines) + "</package>")


CATKIN = of_build("<buildtool_depend>catkin</buildtool_depend>")
AMENT = of_build("<buildtool_depend>ament_cmake</buildtool_depend>")
PLAIN = of_build("<export><build_type>cmake</build_type></export>")
PLAIN_TWO = of_build(
    "<exec_depend condition='$ROS_VERSION == 2'>ament_cmake</exec_depend>",
    "<export><build_type>cmake</build_type></export>",
)
PYTHON = of_build("<export><build_type>ament_python</build_type></export>")
BOTH = of_build("<buildtool_depend>catkin</buildtool_depend><buildtool_depend>ament_cmake</buildtool_depend>")


@pytest.mark.parametrize(
    ("manifests", "expected"),
    [
        ([CATKIN], 1),
        ([manifest("x")], 1),
        ([AMENT], 2),
        ([PYTHON], 2),
        ([BOTH], 2),
        ([PLAIN], 2),
        ([PLAIN_TWO], 2),
        ([CATKIN, PLAIN], 1),
        ([CATKIN, PLAIN_TWO], 2),
        ([CATKIN, CATKIN, AMENT], 1),
        ([CATKIN, AMENT], 2),
    ],
)
def test_the_generation_is_that_of_most_packages_that_tell_one(manifests, expected, tmp_path):
    files = {f"p{at}/package.xml": text for at, text in enumerate(manifests)}
    assert find(tmp_path, files, detect_generation) == expected
