"""The CMake of a package interpreted: small packages in, what they find, build, install and export out."""

import fnmatch
import json
import posixpath
import shutil
import subprocess

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.conditions.cmake import Token
from rosimpact.impact.facts.cmake import extract
from rosimpact.impact.facts.condition import Condition
from rosimpact.impact.model.cmake.build import Build, DeclaredPackages
from rosimpact.impact.model.cmake.conditions import evaluate, make_version_key
from rosimpact.impact.model.cmake.genex import reduce_expression, rejoin
from rosimpact.impact.model.cmake.interpret import interpret, list_extras
from rosimpact.impact.model.cmake.interpreter import Interpreter
from rosimpact.impact.model.cmake.lists import calculate
from rosimpact.impact.model.cmake.regex import match
from rosimpact.impact.model.cmake.standard import parse_flag_standard
from rosimpact.impact.model.cmake.values import split_list, wrap
from rosimpact.impact.model.workspace import _Linker


class Tree:
    """A workspace in memory: paths to texts."""

    def __init__(self, files):
        self.files = files

    def read(self, path):
        return extract(self.files[path].encode()) if path in self.files else None

    def exists(self, path):
        return path in self.files

    def glob(self, pattern, recursive):
        folder, _, last = pattern.rpartition("/")
        return [
            path
            for path in self.files
            if fnmatch.fnmatchcase(posixpath.basename(path), last)
            and (posixpath.dirname(path) == folder or (recursive and path.startswith(folder + "/")))
        ]


def build(source, files=None, **options) -> Build:
    """The Build of a package `pkg` with this CMakeLists.txt and these other files of the workspace."""
    tree = Tree({"pkg/CMakeLists.txt": source} | (files or {}))
    return interpret("pkg", tree.read, tree.exists, tree.glob, package="pkg", **options)


def guards(thing):
    return " & ".join(("!" if c.negated else "") + c.text for c in thing.conditions)


def found(source, files=None, **options):
    """Names found, with their conditions in brackets."""
    return [f.name + (f" [{guards(f)}]" if f.conditions else "") for f in build(source, files, **options).found]


FOUND = [
    ("find_package(A)", ["A"]),
    ("find_package(catkin REQUIRED COMPONENTS a b)", ["catkin", "a", "b"]),
    ("find_package(catkin REQUIRED a b)", ["catkin", "a", "b"]),
    ("set(D a b)\nfind_package(catkin REQUIRED COMPONENTS ${D} c)", ["catkin", "a", "b", "c"]),
    ("foreach(d a b)\nfind_package(${d} REQUIRED)\nendforeach()", ["a", "b"]),
    ("set(D a b)\nforeach(d ${D})\nfind_package(${d})\nendforeach()", ["a", "b"]),
    ("set(D a b)\nforeach(d IN LISTS D ITEMS c)\nfind_package(${d})\nendforeach()", ["a", "b", "c"]),
    ("foreach(n RANGE 1 3)\nfind_package(p${n})\nendforeach()", ["p1", "p2", "p3"]),
    ("if(BUILD_TESTING)\nfind_package(A)\nendif()", ["A [BUILD_TESTING]"]),
    ("if(NOT BUILD_TESTING)\nreturn()\nendif()\nfind_package(A)", ["A [!NOT BUILD_TESTING]"]),
    ("if(X)\nfind_package(A)\nelse()\nfind_package(B)\nendif()", ["A [X]", "B [!X]"]),
    (
        "if(X)\nfind_package(A)\nelseif(Z)\nfind_package(B)\nelse()\nfind_package(C)\nendif()",
        ["A [X]", "B [!X & Z]", "C [!X & !Z]"],
    ),
    ("if(WIN32)\nfind_package(A)\nelseif(UNIX)\nfind_package(B)\nelse()\nfind_package(C)\nendif()", ["B"]),
    ("if(X)\nif(X)\nfind_package(A)\nelse()\nfind_package(B)\nendif()\nendif()", ["A [X]"]),
    ("if(X)\nif(NOT X)\nfind_package(A)\nendif()\nendif()", []),
    ('if("$ENV{ROS_DISTRO}" STREQUAL "noetic")\nfind_package(A)\nendif()', ["A [$ENV{ROS_DISTRO} STREQUAL noetic]"]),
    ("if(A_FOUND)\nfind_package(B)\nendif()", ["B [A_FOUND]"]),
    ("if(yaml-cpp_FOUND)\nfind_package(A)\nelse()\nfind_package(B)\nendif()",
     ["A [yaml-cpp_FOUND]", "B [!yaml-cpp_FOUND]"]),
    ("find_package(A REQUIRED)\nif(A_FOUND)\nfind_package(B)\nelse()\nfind_package(C)\nendif()", ["A", "B"]),
    (
        "find_package(A)\nif(NOT A_FOUND)\nmessage(FATAL_ERROR no)\nendif()\nif(A_FOUND)\nfind_package(B)\nendif()",
        ["A", "B"],
    ),
    ("option(W x ON)\nif(W)\nfind_package(A)\nendif()", ["A [W]"]),
    ("set(W ON CACHE BOOL x)\nif(W)\nfind_package(A)\nendif()", ["A [W]"]),
    ("set(W OFF)\nif(W)\nfind_package(A)\nendif()", []),
    ("set(D a)\nif(X)\nlist(APPEND D b)\nendif()\nforeach(d ${D})\nfind_package(${d})\nendforeach()", ["a", "b [X]"]),
    # A list that begins with itself, and was not set before, begins empty.
    ("set(D ${D} a)\nset(D ${D} b)\nfind_package(${D})", ["a"]),
    ("find_package(x)\nset(x_LIBS ${x_LIBS} a)\nfind_package(${x_LIBS})", ["x"]),
    ("make_names(D)\nset(D ${D} a)\nfind_package(${D})", []),
    ("if(X)\nset(P Qt4)\nelse()\nset(P Qt5)\nendif()\nfind_package(${P})", ["Qt4 [X]", "Qt5 [!X]"]),
    ("macro(m)\nfind_package(${ARGV0} ${ARGN})\nendmacro()\nm(A REQUIRED)", ["A"]),
    ("function(f x)\nfind_package(${x})\nendfunction()\nf(A)\nf(B)", ["A", "B"]),
    ("function(f)\nset(v A PARENT_SCOPE)\nset(v B)\nendfunction()\nf()\nfind_package(${v})", ["A"]),
    ("function(f)\nreturn()\nfind_package(A)\nendfunction()\nf()\nfind_package(B)", ["B"]),
    (
        "function(f)\nif(X)\nreturn()\nendif()\nfind_package(A)\nendfunction()\nf()\nfind_package(B)",
        ["A [!X]", "B"],
    ),
    (
        "macro(m)\nif(X)\nreturn()\nendif()\nfind_package(A)\nendmacro()\nm()\nfind_package(B)",
        ["A [!X]", "B [!X]"],
    ),
    ("while(TRUE)\nfind_package(A)\nbreak()\nendwhile()", ["A"]),
    ("find_package(A)\nbroken(\nfind_package(B)\n", ["A", "B"]),
    ("find_package(${UNKNOWN} REQUIRED)", []),
    ("cmake_language(CALL find_package A)", ["A"]),
    ("set(a_b X)\nset(k b)\nfind_package(${a_${k}})", ["X"]),
    ("find_package(A)\nif(0)\n#[[\n]]\nfind_package(B)\nendif()", ["A"]),
    ("if(FALSE)\nelse()\nfind_package(A)\nendif()", ["A"]),
    ("if(TARGET x)\nfind_package(A)\nendif()", ["A [TARGET x]"]),
    ("add_library(x x.c)\nif(TARGET x)\nfind_package(A)\nendif()", ["A"]),
    ("if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt)\nfind_package(A)\nendif()", ["A"]),
    ("if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/none)\nfind_package(A)\nendif()", []),
    ("if(EXISTS /opt/x)\nfind_package(A)\nendif()", ["A [EXISTS /opt/x]"]),
    ("set(v X)\nif(A)\nset(v Y)\nelse()\nfind_package(${v})\nendif()", ["X [!A]"]),
    ("if(X)\nset(v a)\nelse()\nset(v b)\nendif()\nif(${v} STREQUAL b)\nfind_package(A)\nendif()",
     ["A [NOT X]"]),
    ("if(X)\nset(v a)\nelseif(Z)\nset(v b)\nelse()\nset(v c)\nendif()\nif(NOT v STREQUAL a)\nfind_package(A)\nendif()",
     ["A [( NOT X AND Z ) OR ( NOT X AND NOT Z )]"]),
    ("if(X)\nset(v a)\nelse()\nset(v b)\nendif()\nif(v MATCHES \"^[ab]$\")\nfind_package(A)\nendif()", ["A"]),
    ("set(v a)\nif(X)\nset(v b)\nendif()\nif(Z)\nset(v c)\nendif()\nif(v STREQUAL b)\nfind_package(A)\nendif()",
     ["A [NOT Z AND X]"]),
    ("set(l b c)\nif(NOT $ENV{ROS_DISTRO} IN_LIST l)\nfind_package(A)\nendif()",
     ["A [NOT $ENV{ROS_DISTRO} IN_LIST b;c;]"]),
    ("set(l b c)\nlist(FIND l $ENV{ROS_DISTRO} at)\nif(at EQUAL -1)\nfind_package(A)\nendif()",
     ["A [NOT $ENV{ROS_DISTRO} IN_LIST b;c;]"]),
    ("set(l b c)\nlist(FIND l $ENV{ROS_DISTRO} at)\nif(NOT at LESS 0)\nfind_package(A)\nendif()",
     ["A [$ENV{ROS_DISTRO} STREQUAL b OR $ENV{ROS_DISTRO} STREQUAL c]"]),
    ("set(v a)\nif(DEFINED ENV{ROS_DISTRO})\nset(v $ENV{ROS_DISTRO})\nendif()\n"
     "if(\"${v}\" STREQUAL b)\nfind_package(A)\nendif()",
     ["A [DEFINED ENV{ROS_DISTRO} AND $ENV{ROS_DISTRO} STREQUAL b]"]),
    ("if(X)\nif(NOT X)\nfind_package(A)\nelse()\nfind_package(B)\nendif()\nendif()", ["B [X]"]),
    ("if(NOT X)\nif(NOT X)\nfind_package(A)\nelse()\nfind_package(B)\nendif()\nendif()", ["A [NOT X]"]),
    ("if(NOT X)\nif(X)\nfind_package(A)\nelse()\nfind_package(B)\nendif()\nendif()", ["B [NOT X]"]),
    ("ament_auto_find_build_dependencies()", ["rclcpp", "tf2"]),
    ("ament_auto_find_build_dependencies(REQUIRED tf2)", ["tf2", "rclcpp"]),
    ("ament_lint_auto_find_test_dependencies()", ["ament_lint_common"]),
    ("if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/../elsewhere)\nfind_package(A)\nendif()", ["A [EXISTS pkg/../elsewhere]"]),
    ("gz_find_package(A REQUIRED VERSION 1 PKGCONFIG a)", ["A"]),
]


CONDITIONAL = [
    ("ament_auto_find_build_dependencies()", ["rclcpp [($ROS_VERSION == 2)]", "tf2"]),
    ("ament_auto_find_build_dependencies(REQUIRED rclcpp)", ["rclcpp", "tf2"]),
    ("if(X)\nament_auto_find_build_dependencies()\nendif()", ["rclcpp [X & ($ROS_VERSION == 2)]", "tf2 [X]"]),
    ("ament_lint_auto_find_test_dependencies()", ["ament_lint_common"]),
]


@pytest.mark.parametrize(("source", "expected"), CONDITIONAL)
def test_what_is_declared_under_a_condition_is_found_under_it(source, expected):
    conditions = {"rclcpp": Condition("manifest", "($ROS_VERSION == 2)")}
    declared = dict(dependencies=("rclcpp", "tf2"), test_dependencies=("ament_lint_common",))
    assert found(source, **declared, conditional_dependencies=conditions) == expected


@pytest.mark.parametrize(("source", "expected"), FOUND)
def test_found_under_which_condition(source, expected):
    declared = dict(dependencies=("rclcpp", "tf2"), test_dependencies=("ament_lint_common",))
    assert found(source, **declared) == expected


GATE = "if(NOT A_FOUND)\nament_package()\nreturn()\nendif()\n"


@pytest.mark.parametrize(
    ("source", "gates"),
    [
        (GATE, True),
        (GATE.replace("NOT A_FOUND", "NOT (A_FOUND AND B_FOUND)"), True),
        ("if(A_FOUND)\nfind_package(C)\nelse()\nreturn()\nendif()\n", True),
        (GATE.replace("NOT A_FOUND", "NOT BUILD_ARM"), False),
        (GATE.replace("NOT A_FOUND", "NOT A_FOUND OR SKIP"), False),
        (GATE.replace("ament_package()", "add_library(empty empty.cpp)"), False),
        ("add_library(core core.cpp)\n" + GATE, False),
        ("install(FILES a.yaml DESTINATION share)\n" + GATE, False),
        (f"if(X)\n{GATE}endif()\n", False),
        (f"function(f)\n{GATE}endfunction()\nf()\n", False),
    ],
)
def test_what_nothing_of_a_package_is_built_without(source, gates):
    (target,) = (t for t in build(source + "add_library(arm arm.cpp)").targets if t.name == "arm")
    assert any(condition.gate for condition in target.conditions) is gates


def test_a_test_knows_which_of_its_packages_are_declared():
    options = dict(dependencies=("A", "B"), test_dependencies=("C",), exported_dependencies=("D",))
    source = "if(A_FOUND AND X_FOUND OR D_FOUND)\nfind_package(F)\nendif()\nif(E)\nfind_package(G)\nendif()"
    assert [c.declared for f in build(source, **options).found for c in f.conditions] == [("A", "D"), ()]


SIGNATURES = [
    ("find_package(X 1.2 EXACT QUIET)", dict(version="1.2", exact=True, quiet=True, required=False)),
    ("find_package(X 1.2...<2 REQUIRED)", dict(version="1.2...<2", required=True)),
    ("find_package(X REQUIRED c1 OPTIONAL_COMPONENTS o1)", dict(components=("c1",), optional_components=("o1",))),
    ("find_package(X COMPONENTS c1 c2 REQUIRED)", dict(components=("c1", "c2"), required=True)),
    ("find_package(X NO_MODULE)", dict(components=())),
    ("find_package(Y 1.2 NAMES X REQUIRED COMPONENTS c)", dict(version="1.2", required=True, components=("c",))),
    ("find_package(X CONFIG HINTS /a /b)", dict(components=())),
    ("find_package(X ${V} REQUIRED COMPONENTS c)", dict(version="", components=("c",))),
    ("pkg_check_modules(P REQUIRED X>=1.2)", dict(how="pkg_check_modules", version="1.2", prefix="P", required=True)),
    ("pkg_check_modules(P QUIET IMPORTED_TARGET X=1.2)", dict(version="1.2", exact=True, quiet=True)),
    ("pkg_check_modules(P X<2)", dict(version="<2")),
    ("pkg_search_module(P X Y)", dict(optional_components=("Y",))),
    ("find_library(V NAMES X Y PATHS /a)", dict(how="find_library", prefix="V", optional_components=("Y",))),
    ("find_library(V X /a)", dict(how="find_library", prefix="V", optional_components=())),
    ("find_path(V X PATHS /a)", dict(how="find_path")),
    ("find_program(V X REQUIRED)", dict(how="find_program", required=True)),
]


def test_any_of_several_names_will_do():
    found = build("find_package(Y REQUIRED NAMES X1 X2 PATHS /a)").found
    assert [(one.name, one.required, one.quiet) for one in found] == [("X1", False, True), ("X2", False, True)]


@pytest.mark.parametrize(("source", "expected"), SIGNATURES)
def test_signatures_of_finding(source, expected):
    (one,) = build(source).found
    assert one.name == "X"
    seen = {key: getattr(one, key) for key in expected}
    if "components" in seen:
        seen["components"] = tuple(name for name, _ in one.components)
    assert seen == expected


def test_a_found_package_stands_where_its_name_is_written():
    source = "set(DEPS\n  rclcpp\n  tf2)\nforeach(d ${DEPS})\n  find_package(${d} REQUIRED)\nendforeach()\n"
    assert [(f.at.path, f.at.line, f.at.column) for f in build(source).found] == [
        ("pkg/CMakeLists.txt", 2, 3),
        ("pkg/CMakeLists.txt", 3, 3),
    ]


def targets(source, files=None, **options):
    return {target.name: target for target in build(source, files, **options).targets}


TARGETS = [
    # source, name, kind, sources
    ("add_library(x SHARED a.cpp src/b.cpp)", "x", "library", ("pkg/a.cpp", "pkg/src/b.cpp")),
    ("add_library(x INTERFACE)", "x", "interface", ()),
    ("add_library(x MODULE a.c)", "x", "module", ("pkg/a.c",)),
    ("add_library(x SHARED IMPORTED GLOBAL)", "x", "imported", ()),
    (
        "add_executable(x a.cpp ${CMAKE_CURRENT_BINARY_DIR}/g.cpp)",
        "x",
        "executable",
        ("pkg/a.cpp", "${CMAKE_BINARY_DIR}/g.cpp"),
    ),
    ("project(p)\nadd_executable(${PROJECT_NAME}_node a.cpp)", "p_node", "executable", ("pkg/a.cpp",)),
    ("file(GLOB S src/*.cpp)\nadd_library(x ${S})", "x", "library", ("pkg/src/one.cpp",)),
    (
        "file(GLOB_RECURSE S src/*.cpp)\nadd_library(x ${S})",
        "x",
        "library",
        ("pkg/src/deep/two.cpp", "pkg/src/one.cpp"),
    ),
    ("aux_source_directory(src S)\nadd_library(x ${S})", "x", "library", ("pkg/src/one.cpp",)),
    ("ament_auto_add_library(x SHARED DIRECTORY src)", "x", "library", ("pkg/src/deep/two.cpp", "pkg/src/one.cpp")),
    (
        "if(A)\nset(S a.cpp)\nelse()\nset(S b.cpp)\nendif()\nadd_library(x ${S})",
        "x",
        "library",
        ("pkg/a.cpp", "pkg/b.cpp"),
    ),
    ("add_library(x a.cpp)\ntarget_sources(x PRIVATE b.cpp)", "x", "library", ("pkg/a.cpp", "pkg/b.cpp")),
    ("catkin_add_gtest(x t.cpp WORKING_DIRECTORY d)", "x", "test", ("pkg/t.cpp",)),
    ("add_rostest_gtest(x t.test t.cpp)", "x", "test", ("pkg/t.cpp",)),
    ("ament_add_gtest(x t.cpp TIMEOUT 10 SKIP_TEST u.cpp)", "x", "test", ("pkg/t.cpp", "pkg/u.cpp")),
    ("ament_add_pytest_test(x test/t.py)", "x", "test", ("pkg/test/t.py",)),
    ("add_custom_target(x ALL)", "x", "custom", ()),
    ("ament_vendor(x VCS_URL https://example.org/x.git VCS_VERSION 1.2)", "x", "external", ()),
    (
        'function(f y)\nif(A)\nset(y x)\nendif()\nadd_library(${y} a.cpp)\nendfunction()\nf("b;c")',
        "x",
        "library",
        ("pkg/a.cpp",),
    ),
    ("target_link_libraries(x y)", "x", "unknown", ()),
    ("generate_parameter_library(x p.yaml)", "x", "generated", ()),
    ("rosidl_generate_interfaces(x msg/A.msg)", "x", "generated", ()),
]


@pytest.mark.parametrize(("source", "name", "kind", "sources"), TARGETS)
def test_targets(source, name, kind, sources):
    made = targets(source, {"pkg/src/one.cpp": "", "pkg/src/deep/two.cpp": "", "pkg/src/x.h": ""})[name]
    assert (made.kind, made.sources) == (kind, sources)


GUARDED = [
    (
        "option(USE_X OFF)\nset(S a.cpp)\nif(USE_X)\nlist(APPEND S x.cpp)\nendif()\nadd_library(t ${S})",
        {"x.cpp": "USE_X"},
    ),
    (
        'if("$ENV{ROS_DISTRO}" STREQUAL "foxy")\nset(S "${S}" f.cpp)\nelse()\nset(S "${S}" g.cpp)\nendif()\n'
        "add_library(t ${S})",
        {"f.cpp": "$ENV{ROS_DISTRO} STREQUAL foxy", "g.cpp": "!$ENV{ROS_DISTRO} STREQUAL foxy"},
    ),
    ("if(A)\nset(S x.cpp)\nelseif(B)\nset(S x.cpp y.cpp)\nendif()\nadd_library(t ${S})", {"y.cpp": "!A & B"}),
    ("add_library(t a.cpp)\nif(A)\ntarget_sources(t PRIVATE x.cpp)\nendif()", {"x.cpp": "A"}),
    ("set(S a.cpp x.cpp)\nif(NOT A)\nlist(REMOVE_ITEM S x.cpp)\nendif()\nadd_library(t ${S})", {"x.cpp": "!NOT A"}),
    ("set(S a.cpp)\nif(A)\nset(S a.cpp x.cpp)\nendif()\nadd_library(t ${S})", {"x.cpp": "A"}),
    ("set(S a.cpp x.cpp)\nif(A)\nlist(REMOVE_ITEM S x.cpp)\nelse()\nset(S a.cpp)\nendif()\nadd_library(t ${S})", {}),
    ("add_library(t a.cpp)\nif(A)\ntarget_sources(t PRIVATE a.cpp)\nendif()", {}),
    ("if(A)\nadd_library(t a.cpp)\nendif()", {}),
]


@pytest.mark.parametrize(("source", "expected"), GUARDED)
def test_a_source_stands_under_the_conditions_it_was_added_under(source, expected):
    guarded = {
        path.removeprefix("pkg/"): " & ".join(("!" if c.negated else "") + c.text for c in conditions)
        for path, conditions in targets(source)["t"].guarded
    }
    assert guarded == expected


LINKS = [
    ("target_link_libraries(x a PUBLIC b debug c)", ["link a", "link b PUBLIC", "link c PUBLIC"]),
    ("target_link_libraries(x ${catkin_LIBRARIES})", ["link ${catkin_LIBRARIES}"]),
    ('target_link_libraries(x "${A_LIBRARIES};b")', ["link ${A_LIBRARIES}", "link b"]),
    ("set(L a b)\ntarget_link_libraries(x ${L})", ["link a", "link b"]),
    ("target_link_libraries(x $<BUILD_INTERFACE:a::a> $<INSTALL_INTERFACE:b>)", ["link a::a"]),
    ("target_link_libraries(x $<$<CONFIG:Debug>:a>)", ["link a [$<CONFIG:Debug>]"]),
    ("ament_target_dependencies(x SYSTEM PUBLIC rclcpp)", ["ament rclcpp PUBLIC"]),
    ("add_dependencies(x ${catkin_EXPORTED_TARGETS} y_gencfg)", ["order ${catkin_EXPORTED_TARGETS}", "order y_gencfg"]),
    (
        "target_include_directories(x PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>\n"
        "$<INSTALL_INTERFACE:include> ${A_INCLUDE_DIRS})",
        ["include pkg/include PUBLIC", "include ${A_INCLUDE_DIRS} PUBLIC"],
    ),
    (
        'rosidl_get_typesupport_target(t p "rosidl_typesupport_cpp")\ntarget_link_libraries(x "${t}")',
        ["link p__rosidl_typesupport_cpp"],
    ),
    ('rosidl_target_interfaces(x p "rosidl_typesupport_cpp")', ["interfaces p"]),
    ("if(A)\ntarget_link_libraries(x a)\nendif()", ["link a [A]"]),
    ("set_target_properties(x PROPERTIES INTERFACE_LINK_LIBRARIES a)", ["link a INTERFACE"]),
    ("add_library(y ALIAS x)\ntarget_link_libraries(y a)", ["link a"]),
    (
        "set_property(GLOBAL PROPERTY P a)\nset_property(GLOBAL PROPERTY Q b)\nget_property(L GLOBAL PROPERTY Q)\n"
        "target_link_libraries(x ${L})",
        ["link b"],
    ),
    (
        "set_target_properties(x PROPERTIES P a Q b)\nget_target_property(L x Q)\ntarget_link_libraries(x ${L})",
        ["link b"],
    ),
    ("get_property(L GLOBAL PROPERTY P)\ntarget_link_libraries(x ${L})", ["link ${L}"]),
]


@pytest.mark.parametrize(("source", "expected"), LINKS)
def test_what_is_given_to_a_target(source, expected):
    made = targets(f"add_library(x a.cpp)\n{source}")["x"]
    assert [
        " ".join(filter(None, (link.how, link.item, link.visibility, f"[{guards(link)}]" if link.conditions else "")))
        for link in made.links
    ] == expected


@pytest.mark.parametrize(
    ("source", "by_flag"),
    [
        ("add_compile_options(-std=c++14)", True),
        ('set(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -std=c++14")', True),
        ("set(CMAKE_CXX_STANDARD 14)", False),
        ("set(CMAKE_CXX_STANDARD 14)\nadd_compile_options(-std=c++14)", False),
        ("set(CMAKE_CXX_STANDARD 14)\nadd_compile_options(-std=c++17)", False),
        ("", False),
    ],
)
def test_a_standard_that_flags_alone_set(source, by_flag):
    assert build(source).standard_by_flag is by_flag


@pytest.mark.parametrize(("required", "certain"), [("", False), ("REQUIRED", True)])
def test_an_optional_module_may_be_found_or_not(required, certain):
    (found,) = [
        f
        for f in build(
            f"set(X_FOUND 0)\npkg_check_modules(X {required} x)\nif(X_FOUND)\nfind_package(Y)\nendif()"
        ).found
        if f.name == "Y"
    ]
    assert (found.conditions == ()) is certain


STANDARDS = [
    ("set(CMAKE_CXX_STANDARD 17)", 17, False),
    ("if(NOT CMAKE_CXX_STANDARD)\nset(CMAKE_CXX_STANDARD 14)\nendif()", 14, True),
    ('set(CMAKE_CXX_FLAGS "-std=c++11 ${CMAKE_CXX_FLAGS}")', 11, False),
    ('set(CMAKE_CXX_FLAGS "--std=c++11 ${CMAKE_CXX_FLAGS}")', 11, False),
    ('set(CMAKE_CXX_FLAGS "${CMAKE_CXX_FLAGS} -std=gnu++1z -Wall")', 17, False),
    ("add_compile_options(-std=c++0x)", 11, False),
    ('add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-std=c++17>")', 17, False),
    ("add_definitions(-std=c++20 -DX)", 20, False),
    ("add_compile_options(-std=c99)", None, False),
    ("set(CMAKE_CXX_STANDARD 98)\nset(CMAKE_CXX_STANDARD 11)", 11, False),
    ("check_cxx_compiler_flag(-std=c++11 HAS11)\nif(HAS11)\nadd_compile_options(-std=c++11)\nendif()", 11, False),
    ("project(p)", None, False),
]


@pytest.mark.parametrize(("source", "standard", "default_only"), STANDARDS)
def test_standard_for_everything(source, standard, default_only):
    made = build(source)
    assert (made.standard[0] if made.standard else None, made.standard_default_only) == (standard, default_only)


@pytest.mark.parametrize(
    ("source", "standard"),
    [
        ("target_compile_features(x PUBLIC cxx_std_17)", 17),
        ("set_target_properties(x PROPERTIES CXX_STANDARD 14 OUTPUT_NAME y)", 14),
        ("set_property(TARGET x PROPERTY CXX_STANDARD 20)", 20),
        ("target_compile_options(x PRIVATE -std=c++11)", 11),
        ('set_target_properties(x PROPERTIES COMPILE_FLAGS "-std=c++14 -g")', 14),
    ],
)
def test_standard_of_one_target(source, standard):
    assert targets(f"add_library(x a.cpp)\n{source}")["x"].standard == standard


INSTALLS = [
    (
        "add_library(l a.c)\nadd_executable(e a.c)\ninstall(TARGETS l e EXPORT x ARCHIVE DESTINATION lib\n"
        "LIBRARY DESTINATION lib RUNTIME DESTINATION lib/${PROJECT_NAME} INCLUDES DESTINATION include)",
        [("targets", ("l",), "lib", ()), ("targets", ("e",), "lib/p", ())],
    ),
    (
        "install(FILES a.xml b.xml DESTINATION share/${PROJECT_NAME})",
        [("files", ("pkg/a.xml", "pkg/b.xml"), "share/p", ())],
    ),
    ("install(FILES a.h TYPE INCLUDE)", [("files", ("pkg/a.h",), "include", ())]),
    (
        'install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_PREFIX}/include FILES_MATCHING PATTERN "*.h"\n'
        'PATTERN ".svn" EXCLUDE)',
        [("directory", ("pkg/include/",), "include", ("*.h", "!.svn"))],
    ),
    (
        "find_package(catkin)\ncatkin_install_python(PROGRAMS s/a.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})",
        [("programs", ("pkg/s/a.py",), "lib/p", ())],
    ),
    ("catkin_python_setup()", [("python", ("pkg/setup.py",), "lib/python3/dist-packages/p", ())]),
    ("ament_python_install_package(${PROJECT_NAME} PACKAGE_DIR src/p)", [("python", ("pkg/src/p",), "p", ())]),
    ("install(EXPORT x DESTINATION cmake)", [("export", ("x",), "cmake", ())]),
    ("install(CODE [[message(x)]])", []),
    (
        "pluginlib_export_plugin_description_file(base plugins/x.xml)",
        [("files", ("pkg/plugins/x.xml",), "share/p/plugins", ())],
    ),
    (
        "ament_auto_add_executable(n a.cpp)\nament_auto_package(INSTALL_TO_SHARE launch)",
        [("targets", ("n",), "lib/p", ()), ("directory", ("pkg/launch",), "share/p", ())],
    ),
]


def test_catkin_package_xml_tells_what_is_declared_and_where_things_go():
    source = """
    project(p)
    catkin_package_xml()
    foreach(name ${${PROJECT_NAME}_BUILD_DEPENDS})
      find_package(${name} REQUIRED)
    endforeach()
    install(FILES a.yaml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
    """
    made = build(source, dependencies=("roscpp", "tf"), exported_dependencies=("roscpp",))
    assert [f.name for f in made.found] == ["roscpp", "tf"]
    assert [i.destination for i in made.installs] == ["share/p"]
    assert [use.kind for use in made.uses] == ["command"]


@pytest.mark.parametrize(
    ("source", "refused"),
    [
        ("target_compile_options(gmock PRIVATE -w)", ["gmock"]),
        ("if(TARGET gmock)\ntarget_compile_options(gmock PRIVATE -w)\nendif()", []),
        ("foreach(t gmock gtest)\nif(TARGET ${t})\ntarget_compile_options(${t} PRIVATE -w)\nendif()\nendforeach()", []),
        ("if(X AND TARGET gmock)\ntarget_compile_options(gmock PRIVATE -w)\nendif()", []),
        ("cmake_minimum_required(VERSION 2.8.3)\nproject(q VERSION 1.0)", ["q"]),
        ("cmake_minimum_required(VERSION 2.8.3...3.10)\nproject(q VERSION 1.0)", []),
        ("cmake_minimum_required(VERSION 2.8.3)\ncmake_policy(SET CMP0048 NEW)\nproject(q VERSION 1.0)", []),
        ("cmake_minimum_required(VERSION 2.8.3)\ncmake_policy(VERSION 3.5)\nproject(q VERSION 1.0)", []),
        ("cmake_minimum_required(VERSION 2.8.3)\nproject(q)", []),
        ("if(NOT TARGET gmock)\ntarget_compile_options(gmock PRIVATE -w)\nendif()", ["gmock"]),
        ("if(TARGET gmock_main)\ntarget_compile_options(gmock PRIVATE -w)\nendif()", ["gmock"]),
    ],
)
def test_names_at_which_cmake_stops(source, refused):
    assert [one.name for one in build("project(p)\n" + source).refused] == refused


def test_what_is_appended_to_what_a_package_sets_stands_beside_it():
    added = "list(APPEND catkin_INCLUDE_DIRS other)\ninclude_directories(${catkin_INCLUDE_DIRS})"
    made = [build(f"project(p)\nfind_package({name})\n{added}") for name in ("catkin", "Boost")]
    folders = [[folder for folder, _ in one.include_dirs] for one in made]
    assert folders == [["${catkin_INCLUDE_DIRS}", "pkg/other"], ["pkg/other"]]


@pytest.mark.parametrize(("source", "expected"), INSTALLS)
def test_installs(source, expected):
    made = build("project(p)\n" + source).installs
    assert [(rule.kind, rule.items, rule.destination, rule.patterns) for rule in made] == expected


@pytest.mark.parametrize("source", ["src/a", "src/a.cpp"])
def test_cmake_adds_the_ending_of_a_source(source):
    (target,) = build(f"add_executable(x {source})", {"pkg/src/a.cpp": ""}).targets
    assert target.sources == ("pkg/src/a.cpp",)


EXPORTS = [
    (
        "catkin_package(INCLUDE_DIRS include LIBRARIES l CATKIN_DEPENDS a b DEPENDS EIGEN3 CFG_EXTRAS x.cmake)",
        ["include_dirs pkg/include", "libraries l", "catkin_depends a", "catkin_depends b", "system_depends EIGEN3",
         "cfg_extras pkg/cmake/x.cmake.in"],
    ),
    ("ament_export_dependencies(a b)", ["ament_export_dependencies a", "ament_export_dependencies b"]),
    ("ament_export_include_directories(include/p)", ["ament_export_include_directories include/p"]),
    ("ament_export_targets(t HAS_LIBRARY_TARGET)", ["ament_export_targets t"]),
    ('ament_package(CONFIG_EXTRAS "cmake/x.cmake")', ["cfg_extras pkg/cmake/x.cmake"]),
    ('rclcpp_components_register_nodes(l "a::B" "a::C")', ["component a::B", "component a::C"]),
    ('rclcpp_components_register_node(l PLUGIN "a::B" EXECUTABLE n)', ["component a::B"]),
    ("pluginlib_export_plugin_description_file(base x.xml)", ["plugin_description pkg/x.xml"]),
]  # fmt: skip


@pytest.mark.parametrize(("source", "expected"), EXPORTS)
def test_exports(source, expected):
    made = build(source, {"pkg/cmake/x.cmake.in": ""}).exports
    assert [f"{promise.how} {promise.item}" for promise in made] == expected


GENERATED = [
    (
        'set(M "msg/A.msg" "srv/B.srv")\nrosidl_generate_interfaces(${PROJECT_NAME} ${M} DEPENDENCIES std_msgs)',
        ("rosidl", "p", ("pkg/msg/A.msg", "pkg/srv/B.srv"), ["std_msgs"]),
    ),
    (
        "add_message_files(FILES A.msg)\nadd_service_files(DIRECTORY srv FILES B.srv)\n"
        "generate_messages(DEPENDENCIES std_msgs geometry_msgs)",
        ("catkin", "p_generate_messages", ("pkg/msg/A.msg", "pkg/srv/B.srv"), ["std_msgs", "geometry_msgs"]),
    ),
    ("add_message_files()\ngenerate_messages()", ("catkin", "p_generate_messages", ("pkg/msg/Globbed.msg",), [])),
    ("generate_dynamic_reconfigure_options(cfg/A.cfg)", ("reconfigure", "p_gencfg", ("pkg/cfg/A.cfg",), [])),
    ("generate_parameter_library(params src/p.yaml)", ("parameters", "params", ("pkg/src/p.yaml",), [])),
    ("protobuf_generate_cpp(S H a.proto)", ("protobuf", "", ("pkg/a.proto",), [])),
]


@pytest.mark.parametrize(("source", "expected"), GENERATED)
def test_generated(source, expected):
    (made,) = build("project(p)\n" + source, {"pkg/msg/Globbed.msg": ""}).generated
    assert (made.how, made.target, made.files, [name for name, _ in made.dependencies]) == expected


def test_each_generator_of_a_package_for_both_generations_has_its_own_files():
    source = """project(p)
if($ENV{ROS_VERSION} EQUAL 2)
  rosidl_generate_interfaces(p msg/ros2/A.msg DEPENDENCIES builtin_interfaces)
else()
  add_message_files(FILES A.msg)
  generate_messages(DEPENDENCIES std_msgs)
endif()"""
    files = {made.how: made.files for made in build(source).generated}
    assert files == {"rosidl": ("pkg/msg/ros2/A.msg",), "catkin": ("pkg/msg/A.msg",)}


USES = [
    ("ament_add_gtest(x a.cpp)", ["command ament_add_gtest"]),
    ("macro(mine)\nendmacro()\nmine()", []),
    ("ADD_LIBRARY(x a.cpp)", []),
    ("check_cxx_compiler_flag(-Wall W)", ["command check_cxx_compiler_flag"]),
    ("include(CheckCXXCompilerFlag)\ncheck_cxx_compiler_flag(-Wall W)", []),
    ("find_package(PkgConfig)\npkg_check_modules(X x)\ninclude_directories(${X_INCLUDE_DIRS})", []),
    ("include_directories(${Eigen3_INCLUDE_DIR})", ["variable Eigen3_INCLUDE_DIR"]),
    ("set(E_LIBRARIES x)\nlink_libraries(${E_LIBRARIES} ${OTHER})", []),
    ("find_library(X_LIBRARY x)\nlink_libraries(${X_LIBRARY})", []),
]


@pytest.mark.parametrize(("source", "expected"), USES)
def test_uses(source, expected):
    assert [f"{use.kind} {use.name}" for use in build(source).uses] == expected


def test_a_variable_that_nothing_sets_tells_where_it_is_read():
    (use,) = build("add_library(x a.cpp)\ntarget_link_libraries(x ${A_LIBRARIES})").uses
    assert (use.kind, use.name, use.context, use.at.line, use.at.column) == ("variable", "A_LIBRARIES",
                                                                           "target_link_libraries", 2, 25)  # fmt: skip


def test_a_policy_stands_where_its_name_is_written():
    (use,) = build("cmake_policy(SET\n  CMP0072 NEW)").uses
    assert (use.kind, use.name, use.at.line, use.at.column) == ("feature", "CMP0072", 2, 3)


def test_several_files_share_their_scopes_as_cmake_has_it():
    made = build(
        "project(p)\nset(V outer)\nadd_subdirectory(sub)\ninclude(cmake/more.cmake)\n"
        "find_package(${V})\nfind_package(${U})\n",
        {
            "pkg/sub/CMakeLists.txt": "set(U child PARENT_SCOPE)\nset(V inner)\n"
            "add_library(x s.cpp)\nfind_package(${V})\n",
            "pkg/cmake/more.cmake": "set(V included)\nadd_library(y ${CMAKE_CURRENT_LIST_DIR}/m.cpp n.cpp)\n",
        },
    )
    assert [one.name for one in made.found] == ["inner", "included", "child"]
    assert [target.sources for target in made.targets] == [("pkg/sub/s.cpp",), ("pkg/cmake/m.cpp", "pkg/n.cpp")]
    assert made.files == ("pkg/CMakeLists.txt", "pkg/sub/CMakeLists.txt", "pkg/cmake/more.cmake")


OTHER_PACKAGE = {
    "other/CMakeLists.txt": "project(other)\nament_package(CONFIG_EXTRAS other-extras.cmake)",
    "other/other-extras.cmake": 'include("${other_DIR}/other_test.cmake")\nfind_package(HIDDEN)\nset(FROM_EXTRAS yes)',
    "other/cmake/other_test.cmake": (
        "macro(other_add_test name)\n  find_package(Inner REQUIRED)\n  ament_add_gtest(${name} ${ARGN})\nendmacro()\n"
    ),
}


def test_macros_of_another_package_are_known_once_it_is_found():
    tree = Tree(OTHER_PACKAGE)
    source = "project(p)\nfind_package(other)\n\n  other_add_test(t a.cpp)\nfind_package(A_${FROM_EXTRAS})"
    made = build(source, OTHER_PACKAGE, extras=lambda name: list_extras(name, tree.glob) if name == "other" else ())
    assert [(one.name, one.at.path, one.at.line, one.via) for one in made.found] == [
        ("other", "pkg/CMakeLists.txt", 2, ""),
        ("Inner", "pkg/CMakeLists.txt", 4, "other_add_test"),
        ("A_yes", "pkg/CMakeLists.txt", 5, ""),
    ]
    assert [(target.name, target.kind, target.sources) for target in made.targets] == [("t", "test", ("pkg/a.cpp",))]
    assert made.files == ("pkg/CMakeLists.txt",)
    assert made.unresolved == ()


def test_an_unknown_macro_is_a_use():
    assert [use.name for use in build("find_package(other)\nother_add_test(t a.cpp)").uses] == ["other_add_test"]


UNRESOLVED = [
    ("include(cmake/none.cmake)", "not in the tree"),
    ("include(NoSuchModule)", "not in the tree"),
    ("add_subdirectory(none)", "has no CMakeLists.txt"),
    ("add_subdirectory(${UNKNOWN})", "outside the tree"),
    ("find_package(${UNKNOWN})", "not known"),
    ("include(${CMAKE_CURRENT_LIST_FILE})", "includes itself"),
    ("macro(m)\nm()\nendmacro()\nm()", "too deeply"),
    ("function(f)\nf()\nendfunction()\nf()", "too deeply"),
    ("while(TRUE)\nendwhile()", "left after"),
    ("foreach(i RANGE 100000)\nendforeach()", "left after"),
    ("set(L a b)\nforeach(i RANGE 40)\nlist(APPEND L ${L})\nendforeach()", "more than"),
    ("set(T ab)\nforeach(i RANGE 40)\nset(T ${T}${T})\nendforeach()", "longer than"),
    (
        "foreach(a RANGE 999)\nforeach(b RANGE 999)\nset(x ${b})\nendforeach()\nendforeach()",
        "more work than",
    ),
    ("set(X ON)\n" + "while(X)\n" * 4 + "endwhile()\n" * 4, "more work than"),
    ("foreach(i RANGE 990)\nlist(APPEND L a;b;c;d;e;f)\nset(M ${L} ${L} ${L})\nendforeach()", "more work than"),
    ("if(X)\nfind_package(A)", "never closed"),
    ("endif()\nfind_package(A)", "without if"),
    ("if(A)\n" * 5000, "too deeply"),
]


@pytest.mark.parametrize(("source", "said"), UNRESOLVED)
def test_what_cannot_be_told_is_listed_and_the_run_ends(source, said):
    assert any(said in reason for _, reason in build(source).unresolved)


OPTIONAL = ["include(none.cmake OPTIONAL)", "include(CTest)", "include(GNUInstallDirs)", "find_package(A)"]


@pytest.mark.parametrize("source", OPTIONAL)
def test_what_is_no_problem(source):
    assert build(source).unresolved == ()


def test_a_package_without_cmake_is_empty():
    tree = Tree({})
    assert interpret("pkg", tree.read, tree.exists, tree.glob) == Build()


def test_a_package_at_the_root_of_the_workspace():
    tree = Tree(
        {
            "CMakeLists.txt": "project(p)\nadd_library(x src/a.cpp)\ninclude(cmake/b.cmake)",
            "cmake/b.cmake": "find_package(A)",
        }
    )
    made = interpret("", tree.read, tree.exists, tree.glob, package="p")
    assert made.targets[0].sources == ("src/a.cpp",)
    assert made.found[0].at.path == "cmake/b.cmake"


def test_the_result_can_be_stored():
    source = (
        "project(p)\nset(D a b)\nif(X)\nlist(APPEND D c)\nendif()\nfind_package(catkin COMPONENTS ${D})\n"
        + "\n".join(source for source, *_ in [*TARGETS, *LINKS, *INSTALLS, *EXPORTS, *GENERATED, *USES])
    )
    made = build(source)
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(made), type=Build) == made
    assert type(made.found[1].name) is str


CONDITIONS = [
    ("TRUE", True), ("OFF", False), ("X-NOTFOUND", False), ("0", False), ("2", True), ("-0.0", False),
    ("UNKNOWN", None), ("NOT UNKNOWN", None), ("NOT FALSE", True), ("NOT NOT FALSE", False),
    ("UNKNOWN AND FALSE", False), ("UNKNOWN OR TRUE", True), ("UNKNOWN AND TRUE", None),
    ("TRUE OR FALSE AND FALSE", False), ("TRUE OR ( FALSE AND FALSE )", True),
    ("a STREQUAL a", None), ("UNKNOWN STREQUAL a", None), ("( TRUE", None), ("1 LESS 2", True),
    ("1 GREATER_EQUAL 2", False), ("1.10 VERSION_GREATER 1.9", True), ("1.0 VERSION_EQUAL 1", True),
    ("3 EQUAL x", False), ("POLICY CMP0022", True), ("TARGET t", None), ("COMMAND message", True),
    # Only newer versions of CMake have these.
    ("POLICY CMP0054", None), ("COMMAND add_link_options", None),
    ("COMMAND nothing", None), ("DEFINED UNKNOWN", None), ("IS_ABSOLUTE /x", True), ("", False),
]  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), CONDITIONS)
def test_conditions_are_three_valued(text, expected):
    tokens = [Token(part, False, True, True) for part in text.split()]
    tree = Tree({})
    assert (
        evaluate(tokens, Interpreter("p", tree.read, tree.exists, tree.glob, "p", DeclaredPackages(), lambda name: ()))
        is expected
    )


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a", ["a"]),
        ("$<BUILD_INTERFACE:a;b>", ["a", "b"]),
        ("$<INSTALL_INTERFACE:a>", []),
        ("$<LINK_ONLY:a::b>", ["a::b"]),
        ("$<$<NOT:$<BOOL:1>>:a>", ["a"]),
        ("$<IF:$<CONFIG:Debug>,a,b>", ["a", "b"]),
        ("$<TARGET_NAME_IF_EXISTS:a>", ["a"]),
        ("$<TARGET_FILE:a>", ["$<TARGET_FILE:a>"]),
        ("$<BUILD_INTERFACE:a", ["$<BUILD_INTERFACE:a"]),
        ("x$<CONFIG>y", ["x$<CONFIG>y"]),
    ],
)
def test_generator_expressions(text, expected):
    assert list(reduce_expression(wrap(text, None))) == expected


def test_generator_expressions_taken_apart_are_joined_again():
    assert rejoin([wrap(part, None) for part in ("$<BUILD_INTERFACE:a", "b>", "c")]) == ["$<BUILD_INTERFACE:a;b>", "c"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [("1 + 2 * 3", 7), ("(1 + 2) * 3", 9), ("-4 / 3", -1), ("7 % -3", 1), ("1 << 4 | 1", 17), ("~0", -1),
     ("1 / 0", None), ("0x10 - 1", 15), ("1 +", None), ("", None), ("5 - -5", 10), ("((", None)],
)  # fmt: skip
def test_math(text, expected):
    assert calculate(text) == expected


@pytest.mark.parametrize(
    ("pattern", "text", "expected"),
    [
        ("([0-9]+)\\.([0-9]+)", "v1.24", ("1.24", "1", "24")),
        ("^[a-z]$", "ab", False),
        ("^(a|b|c|d|e|f|g|h|i|j|k|l|m)-.*$", "m-x", ("m-x", "m")),
        ("^-?[0-9]+(\\.[0-9]+)?(e[+-]?[0-9]+)?$", "-1.5e3", ("-1.5e3", ".5", "e3")),
        ("([0-9]+\\.)+", "1.2.3", ("1.2.", "2.")),
        ("(", "a", None),
        ("(a+)+b", "a" * 60, None),
        ("(((a+)+)+)+b", "a" * 16, None),
        ("(a?a?)*b", "a" * 60, None),
        ("a?" * 30 + "a" * 30, "a" * 30, None),
        ("(a|a)" * 30 + "b", "a" * 30, None),
        ("a*a*a*b", "a" * 200, None),
        ("a*b", "a" * 200_000, None),
        ("a" * 100_000, "a", None),
    ],
)
def test_regular_expressions_end(pattern, text, expected):
    assert match(pattern, text, lambda steps: None) == expected


def test_regular_expressions_cost_what_they_may_take():
    spent = []
    match("a*b", "a" * 20_000, spent.append)
    match("(.*)/(.*)", "src/node.cpp", spent.append)
    assert spent[0] > 1000
    assert spent[1] == 0


@pytest.mark.parametrize(
    ("text", "expected"), [("-std=c++2a", 20), ("x -std=gnu++17 y", 17), ("-std=c++11 -std=c++14", 14), ("-std=c11", 0)]
)
def test_standard_flags(text, expected):
    assert parse_flag_standard(text) == expected


def test_versions_compare_by_component():
    assert make_version_key("1.10") > make_version_key("1.9.9")
    assert make_version_key("1.0.0") == make_version_key("1")


@given(st.lists(st.text(st.sampled_from("ab;\\[]"), max_size=6)))
def test_splitting_a_list_loses_no_text(parts):
    text = ";".join(parts)
    assert len("".join(split_list(text))) <= len(text)


LINES = st.sampled_from(
    """
    if(X)
    if(NOT X OR (Y
    elseif(Y)
    else()
    endif()
    foreach(a ${L} b)
    foreach(a IN LISTS L)
    endforeach()
    while(X)
    while(TRUE)
    endwhile()
    function(f a)
    endfunction()
    macro(m a)
    endmacro()
    f(1)
    m(2)
    set(L a b ${L})
    set(L)
    unset(L)
    list(APPEND L ${a})
    list(REMOVE_ITEM L a)
    return()
    break()
    list(GET L 0 x)
    string(REGEX REPLACE "(a)" "\\1" x ${L})
    find_package(${L} REQUIRED)
    add_library(${L})
    target_link_libraries(a ${L} $<$<X>:y>)
    include(sub.cmake)
    add_subdirectory(.)
    install(TARGETS ${L} DESTINATION ${D})
    math(EXPR x "1 + ${L}")
    cmake_parse_arguments(P "o" "s" "m" ${L})
    set_property(TARGET a PROPERTY
    get_filename_component(x ${L} DIRECTORY)
    set(${L} ${${L}} PARENT_SCOPE)
    generate_messages(DEPENDENCIES ${L})
    project()
    project(p VERSION 1.2)
    catkin_package(${L})
    file(GLOB L *)
    foreach(a RANGE ${x})
    list(TRANSFORM L REPLACE a b)
    cmake_language(CALL f 1)
    message(FATAL_ERROR x)
    """.strip().splitlines()
)


@settings(max_examples=150, deadline=None)
@given(st.lists(LINES, max_size=25))
def test_any_order_of_commands_ends_without_an_error(lines):
    made = build("\n".join(lines), {"pkg/sub.cmake": "set(L ${L} c)\ninclude(sub.cmake)\nm(3)"})
    msgspec.msgpack.encode(made)


# Each script is run by CMake too, which says what every command was given.
SCRIPTS = {
    "lists": """
        set(A a;b "c;d")
        list(APPEND A e)
        list(LENGTH A n)
        list(GET A 0 -1 ends)
        list(REMOVE_ITEM A c)
        list(INSERT A 1 x)
        list(FIND A x at)
        list(REVERSE A)
        list(SORT A)
        list(JOIN A - joined)
        list(SUBLIST A 1 2 some)
        list(FILTER A EXCLUDE REGEX "^[ab]$")
        list(TRANSFORM A TOUPPER OUTPUT_VARIABLE B)
        list(TRANSFORM A APPEND .cpp)
        list(POP_FRONT A first)
        message("${A}|${n}|${ends}|${at}|${joined}|${some}|${B}|${first}")
        set(E "")
        list(APPEND E one)
        message(${E} "${E}")
        set(Q "")
        message("<${Q}>" ${Q} end)
    """,
    "strings": """
        set(v "Hello World 1.2.3")
        string(TOUPPER "${v}" up)
        string(REGEX MATCH "([0-9]+)\\\\.([0-9]+)" m "${v}")
        message("${up} ${m} ${CMAKE_MATCH_1} ${CMAKE_MATCH_2}")
        string(REGEX REPLACE "([a-z])o" "<\\\\1>" r "${v}")
        string(REGEX MATCHALL "[0-9]" all "${v}")
        string(REPLACE " " ";" parts ${v})
        string(SUBSTRING "${v}" 6 -1 tail)
        string(FIND "${v}" World where)
        string(LENGTH "${v}" length)
        string(CONCAT c a b "c d")
        string(APPEND c e f)
        string(STRIP "  x " s)
        string(MAKE_C_IDENTIFIER "a-b.c" id)
        string(COMPARE LESS a b less)
        message("${r}|${all}|${parts}|${tail}|${where}|${length}|${c}|${s}|${id}|${less}")
        foreach(p ${parts})
          message(${p})
        endforeach()
        math(EXPR x "(3 + 4) * 2 % 5 - -1")
        message(${x})
    """,
    "conditions": """
        set(T TRUE)
        set(N T)
        set(EMPTY "")
        set(V 1.10)
        foreach(x 1 2)
          if(x EQUAL 1 AND NOT EMPTY)
            message(one ${x})
          elseif(${x} EQUAL 2)
            message(two ${x})
          else()
            message(never)
          endif()
        endforeach()
        if(T AND (NOT N STREQUAL "T" OR V VERSION_GREATER 1.9) AND NOT "T" STREQUAL "TRUE")
          message(yes)
        endif()
        if(TRUE OR FALSE AND FALSE)
          message(and-first)
        else()
          message(left-to-right)
        endif()
        if("abc" MATCHES "a(.)c")
          message(${CMAKE_MATCH_1})
        endif()
        set(L a b)
        if(a IN_LIST L AND NOT c IN_LIST L)
          message(in)
        endif()
        if(${N})
          message(through)
        endif()
        if("${N}" STREQUAL "T" AND NOT "N")
          message(quoted)
        endif()
        if(DEFINED T AND NOT DEFINED EMPTY_NOT AND DEFINED EMPTY)
          message(defined)
        endif()
        unset(T)
        if(DEFINED T)
          message(still)
        endif()
    """,
    "calls": """
        function(f a b)
          message("${a}|${b}|${ARGC}|${ARGN}|${ARGV}|${ARGV2}")
          set(out "${a}${b}" PARENT_SCOPE)
          set(out local)
          message(${out})
        endfunction()
        macro(m a)
          message("${a}|${ARGN}|${ARGC}")
          set(out "m${a}")
          foreach(x ${ARGN})
            message(item ${x})
          endforeach()
        endmacro()
        f(1 2)
        message(${out})
        f("p q" r s "t;u")
        message(${out})
        m(z 1;2 "3;4")
        message(${out})
        function(g)
          cmake_parse_arguments(A "FLAG;OTHER" "ONE" "MANY;MORE" ${ARGN})
          message("${A_FLAG}|${A_OTHER}|${A_ONE}|${A_MANY}|${A_MORE}|${A_UNPARSED_ARGUMENTS}")
          if(A_FLAG AND NOT A_MORE)
            message(flagged)
          endif()
          if(A_ONE STREQUAL "1")
            return()
          endif()
          message(after)
        endfunction()
        g(x FLAG ONE 1 MANY a b y)
        g(MANY a;b MORE c ONE 2)
        macro(outer)
          g(${ARGV})
        endmacro()
        outer(FLAG MANY 1 2)
    """,
    "loops": """
        foreach(i RANGE 3)
          message(${i})
        endforeach()
        foreach(i RANGE 10 1 -4)
          message(${i})
        endforeach()
        set(A 1 2 3)
        set(B x y)
        foreach(i IN LISTS A B ITEMS z)
          if(i STREQUAL 2)
            continue()
          endif()
          if(i STREQUAL y)
            break()
          endif()
          message(${i})
        endforeach()
        foreach(p IN ZIP_LISTS A B)
          message("${p_0}-${p_1}")
        endforeach()
        set(n 0)
        while(n LESS 5)
          math(EXPR n "${n} + 2")
          message(${n})
        endwhile()
    """,
    "paths": """
        set(p /a/b.c/file.tar.gz)
        foreach(k DIRECTORY NAME EXT NAME_WE LAST_EXT NAME_WLE)
          get_filename_component(r ${p} ${k})
          message("${k} ${r}")
        endforeach()
        get_filename_component(r ../x ABSOLUTE BASE_DIR /a/b)
        message(${r})
        file(RELATIVE_PATH r /a/b /a/c/d)
        message(${r})
        cmake_path(GET p FILENAME n)
        cmake_path(GET p STEM LAST_ONLY s)
        cmake_path(APPEND p2 /x y z)
        message("${n} ${s} ${p2}")
    """,
    "references": """
        set(a_b 1)
        set(k b)
        message("${a_${k}} \\${k} ${undefined_but_empty_FLAG}" a\\;b [[${k}]] ${k}x${k})
        set(list "x;y;z")
        message(${list} "${list}" pre${list}post)
        set(${k}_name v)
        message(${b_name})
        set(ENV{MINE} here)
        message($ENV{MINE})
    """,
}


class Recorder(Interpreter):
    """An interpreter that writes down each message() it runs, in the manner of CMake's trace: lists in one piece."""

    def run_call(self, call):
        if call.name == "message":
            given = [self.clean(";".join(self.expand([template]))) for template in call.templates]
            self.said.append((call.at.line, given))
        return super().run_call(call)


def traced(path, folder=""):
    """The messages in a trace of CMake: (line, arguments)."""
    entries = [json.loads(line) for line in path.read_text().splitlines()]
    return [
        (entry["line"], [text.replace(f"{path.parent}/", "").replace("\\;", ";") for text in entry["args"]])
        for entry in entries
        if entry.get("cmd") == "message" and entry["file"].startswith(str(path.parent / folder))
    ]


@pytest.mark.parametrize("name", SCRIPTS)
def test_same_messages_as_cmake_traces(name, tmp_path):
    cmake = shutil.which("cmake")
    if cmake is None:
        pytest.skip("cmake is not installed; the interpreter is checked against its own tables only")
    text = "cmake_minimum_required(VERSION 3.10)\nset(undefined_but_empty_FLAG)\n" + SCRIPTS[name]
    script = tmp_path / "script.cmake"
    script.write_text(text)
    trace = tmp_path / "trace.json"
    command = [cmake, "--trace-expand", "--trace-format=json-v1", f"--trace-redirect={trace}", "-P", str(script)]
    subprocess.run(command, check=True, capture_output=True)
    expected = traced(trace)
    tree = Tree({"pkg/CMakeLists.txt": text})
    run = Recorder("pkg", tree.read, tree.exists, tree.glob, "pkg", DeclaredPackages(), lambda package: ())
    run.said = []
    run.run()
    assert run.said == expected
    assert len(expected) > 2


PROJECT = {
    "CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.10)
        project(top VERSION 1.2.3 LANGUAGES NONE)
        include(cmake/mine.cmake)
        add_subdirectory(sub)
        message("${FROM_SUB} ${PROJECT_NAME} ${top_VERSION_MINOR} ${FROM_INCLUDE} ${CMAKE_CURRENT_SOURCE_DIR}")
        mine(a b)
        file(GLOB found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} sub/*.txt sub/*.h)
        message("${found}")
        file(GLOB_RECURSE deep ${CMAKE_CURRENT_SOURCE_DIR}/sub/*.h)
        message(${deep})
        add_custom_target(t)
        if(TARGET t)
          message(target)
        endif()
        set_property(GLOBAL PROPERTY P x)
        list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)
        include(Mine2)
    """,
    "cmake/mine.cmake": """
        set(FROM_INCLUDE ${CMAKE_CURRENT_LIST_DIR})
        include_guard()
        function(mine)
          message("${ARGV} ${CMAKE_CURRENT_LIST_DIR} ${CMAKE_CURRENT_FUNCTION_LIST_DIR} ${CMAKE_CURRENT_SOURCE_DIR}")
        endfunction()
    """,
    "cmake/Mine2.cmake": """
        message("${CMAKE_CURRENT_LIST_FILE}")
        if(1)
          return()
        endif()
        message(never)
    """,
    "sub/CMakeLists.txt": """
        project(below NONE)
        set(FROM_SUB "sub of ${CMAKE_PROJECT_NAME} in ${PROJECT_NAME}" PARENT_SCOPE)
        message("${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_SOURCE_DIR} ${PROJECT_SOURCE_DIR} ${top_SOURCE_DIR}")
        mine(from sub)
    """,
    "sub/a.h": "",
    "sub/in/b.h": "",
}


def test_same_messages_as_cmake_traces_over_several_files(tmp_path):
    cmake = shutil.which("cmake")
    if cmake is None:
        pytest.skip("cmake is not installed; the interpreter is checked against its own tables only")
    for path, text in PROJECT.items():
        (tmp_path / "pkg" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "pkg" / path).write_text(text)
    trace = tmp_path / "trace.json"
    command = [cmake, "--trace-expand", "--trace-format=json-v1", f"--trace-redirect={trace}"]
    subprocess.run([*command, "-S", str(tmp_path / "pkg"), "-B", str(tmp_path / "b")], check=True, capture_output=True)
    expected = traced(trace, "pkg")
    tree = Tree({f"pkg/{path}": text for path, text in PROJECT.items()})
    run = Recorder("pkg", tree.read, tree.exists, tree.glob, "pkg", DeclaredPackages(), lambda package: ())
    run.said = []
    run.run()
    assert run.said == expected
    assert len(expected) == 8


FILES = ["a/CMakeLists.txt", "a/src/x.cpp", "a/src/y.hpp", "a/src/deep/z.cpp", "a/src0/w.cpp", "a/src-b/v.cpp"]


@pytest.mark.parametrize(
    ("pattern", "recurse", "expected"),
    [
        ("a/src/*.cpp", False, ["a/src/x.cpp"]),
        ("a/src/*.cpp", True, ["a/src/deep/z.cpp", "a/src/x.cpp"]),
        ("a/*.cpp", True, ["a/src-b/v.cpp", "a/src/deep/z.cpp", "a/src/x.cpp", "a/src0/w.cpp"]),
        ("a/src*/*.cpp", False, ["a/src-b/v.cpp", "a/src/deep/z.cpp", "a/src/x.cpp", "a/src0/w.cpp"]),
        ("*.cpp", True, ["a/src-b/v.cpp", "a/src/deep/z.cpp", "a/src/x.cpp", "a/src0/w.cpp"]),
        ("*.cpp", False, []),
        ("b/*", True, []),
    ],
)
def test_files_that_match_a_pattern(pattern, recurse, expected):
    find = _Linker.make_glob(None, FILES)  # type: ignore[arg-type]
    assert find(pattern, recurse) == expected
    assert find(pattern, recurse) == expected


@pytest.mark.parametrize(
    "source",
    [
        'set_directory_properties(PROPERTIES COMPILE_OPTIONS "-Wall;-std=c++14")',
        "set_property(DIRECTORY APPEND PROPERTY COMPILE_OPTIONS -std=c++14)",
        'set_property(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} PROPERTY COMPILE_OPTIONS "-std=c++14")',
    ],
)
def test_options_of_a_directory_count(source):
    assert [number for number, _, _ in build(source).standards] == [14]


@pytest.mark.parametrize(
    ("source", "made"),
    [
        ("configure_file(a.in ${CMAKE_CURRENT_SOURCE_DIR}/a.yaml)", ["pkg/a.yaml"]),
        ("configure_file(a.in a.yaml)", ["${CMAKE_BINARY_DIR}/a.yaml"]),
        ("add_custom_command(OUTPUT a.h COMMAND run)", ["pkg/a.h", "${CMAKE_BINARY_DIR}/a.h"]),
        ("file(WRITE ${CMAKE_CURRENT_SOURCE_DIR}/a.yaml x)", ["pkg/a.yaml"]),
        ("file(MAKE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/data)", ["pkg/data/"]),
        ("add_custom_command(OUTPUT ${CMAKE_CURRENT_SOURCE_DIR}/a.yaml COMMAND run)", ["pkg/a.yaml"]),
        ("execute_process(COMMAND run -o ${CMAKE_CURRENT_SOURCE_DIR}/out)", ["pkg/out", "pkg/out/"]),
        ("execute_process(COMMAND run ${CMAKE_CURRENT_SOURCE_DIR}/there.txt)", []),
        ("catkin_download_test_data(x http://e/a.bag DESTINATION ${CMAKE_CURRENT_SOURCE_DIR}/test FILENAME a.bag)",
         ["pkg/test/a.bag"]),
    ],
)  # fmt: skip
def test_what_configuring_or_building_writes_into_the_tree(source, made):
    assert list(build(source, {"pkg/there.txt": ""}).made) == made


def test_sources_given_to_an_unknown_command_are_compiled():
    source = "add_executable(known src/a.cpp)\nsome_nodelet(src/a.cpp src/b.cpp src/absent.cpp)\nroslint_cpp(src/c.cpp)"
    files = {f"pkg/src/{name}.cpp": "" for name in "abc"}
    assert {t.name: (t.kind, t.sources) for t in build(source, files).targets} == {
        "known": ("executable", ("pkg/src/a.cpp",)),
        "some_nodelet()": ("unknown", ("pkg/src/b.cpp",)),
    }


def test_a_find_module_of_the_tree_makes_its_targets_and_looks_for_nothing_on_behalf_of_the_package():
    module = "FetchContent_MakeAvailable(arm)\nfind_package(Other REQUIRED)\nset(Arm_LIBRARIES arm)"
    made = build(
        "list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_SOURCE_DIR}/cmake)\nfind_package(Arm REQUIRED)\n"
        "add_executable(x x.cpp)\ntarget_link_libraries(x ${Arm_LIBRARIES})",
        {"pkg/cmake/FindArm.cmake": module},
    )
    assert [f.name for f in made.found] == ["Arm"]
    assert {t.name: t.kind for t in made.targets} == {"arm": "fetched", "x": "executable"}
    assert not made.uses or all(use.name != "Arm_LIBRARIES" for use in made.uses)


def test_scripts_that_a_package_hands_on_are_read_for_what_they_find():
    extras = 'include("${pkg_DIR}/generate.cmake")\nfind_package(rmw REQUIRED)\nadd_library(not_ours a.cpp)'
    files = {
        "pkg/pkg-extras.cmake.in": extras,
        "pkg/cmake/generate.cmake": "ament_register_extension(point pkg later.cmake)\nfind_package(rcutils)",
        "pkg/cmake/later.cmake": "find_package(tf2 REQUIRED)",
    }
    made = build("project(pkg)\nament_package(CONFIG_EXTRAS pkg-extras.cmake.in)", files)
    assert sorted((f.name, f.required) for f in made.handed_on) == [("rcutils", False), ("rmw", True), ("tf2", True)]
    assert (made.found, made.targets) == ((), ())


def test_targets_before_catkin_destinations_are_in_the_order_of_the_run_and_of_its_own_branch():
    source = (
        "project(pkg)\nif(USE_ROSBUILD)\nrosbuild_add_library(old a.cpp)\nelse()\nadd_library(early a.cpp)\n"
        "catkin_package()\nadd_library(late a.cpp)\nendif()"
    )
    assert build(source).before_catkin_destinations == ("early",)


@pytest.mark.parametrize("name", ["pkg__rosidl_typesupport_introspection_cpp", "pkg__rosidl_generator_rs"])
def test_every_type_support_of_generated_interfaces_is_a_target(name):
    made = build(
        f"rosidl_generate_interfaces(pkg msg/A.msg)\nif(TARGET {name})\nset(seen yes)\nendif()\n"
        f"add_executable(${{seen}} a.cpp)\ntarget_link_libraries(yes {name})"
    )
    assert "yes" in [t.name for t in made.targets]


def test_an_environment_variable_is_seen_through_a_variable():
    source = "set(V $ENV{ROS_VERSION})\nif(V EQUAL 1)\nfind_package(catkin)\nendif()"
    assert found(source) == ["catkin [$ENV{ROS_VERSION} EQUAL 1]"]
