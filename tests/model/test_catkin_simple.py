"""What catkin_simple makes of a package, from its conventions."""

from test_build import build, guards

SOURCE = """
project(p)
find_package(catkin_simple REQUIRED)
catkin_simple(ALL_DEPS_REQUIRED)
cs_add_library(rope rope.cpp)
cs_add_library(knot STATIC knot.cpp NO_AUTO_EXPORT NO_AUTO_DEP)
if(WITH_HOIST)
  cs_add_executable(hoist hoist.cpp NO_AUTO_LINK)
endif()
cs_install()
cs_install_scripts(scripts/lower)
cs_export(LIBRARIES extra DEPENDS EIGEN3)
"""
FILES = {
    "pkg/include/p/rope.h": "",
    "pkg/launch/hoist.launch": "",
    "pkg/msg/Tension.msg": "",
    "pkg/cfg/Limits.cfg": "",
    "pkg/scripts/lower": "",
}
DECLARED = ("catkin", "message_generation", "dynamic_reconfigure", "std_msgs")


def make(source=SOURCE, files=FILES, dependencies=DECLARED):
    return build(source, dict(files), dependencies=dependencies)


def test_everything_declared_is_found():
    assert [(f.name, f.how, f.required) for f in make().found] == [
        ("catkin_simple", "find_package", True),
        ("catkin", "find_package", True),
        ("message_generation", "declared", True),
        ("dynamic_reconfigure", "declared", True),
        ("std_msgs", "declared", True),
    ]
    optional = make(SOURCE.replace("ALL_DEPS_REQUIRED", "")).found
    assert not any(f.required for f in optional if f.how == "declared")


def test_interfaces_are_made_of_the_folders():
    made = make().generated
    assert [(g.how, g.files) for g in made] == [
        ("catkin", ("pkg/msg/Tension.msg",)),
        ("reconfigure", ("pkg/cfg/Limits.cfg",)),
    ]
    assert make(dependencies=("catkin", "std_msgs")).generated == ()
    assert make(files={}).generated == ()


def test_interfaces_that_a_program_makes_are_not_known():
    running = "execute_process(COMMAND python3 make.py ${CMAKE_CURRENT_SOURCE_DIR}/msg)\n"
    made = make(SOURCE.replace("catkin_simple(ALL", running + "catkin_simple(ALL"), files={})
    assert [reason for _, reason in made.unresolved] == ["catkin_simple(): a program makes the interfaces"]


def test_targets_link_and_wait_for_what_is_found():
    targets = {t.name: t for t in make().targets if t.kind in ("library", "executable")}
    links = {name: {(link.how, link.item) for link in t.links} for name, t in targets.items()}
    waits = {("order", "${catkin_EXPORTED_TARGETS}"), ("order", "${p_EXPORTED_TARGETS}")}
    assert links == {"rope": {("link", "${catkin_LIBRARIES}")} | waits, "knot": {("link", "${catkin_LIBRARIES}")},
                     "hoist": waits}  # fmt: skip
    assert targets["knot"].sources == ("pkg/knot.cpp",)
    assert targets["knot"].static
    assert guards(targets["hoist"]) == "WITH_HOIST"


def test_targets_headers_and_shared_folders_are_installed():
    assert [(i.kind, i.items, i.destination, i.patterns) for i in make().installs] == [
        ("targets", ("rope",), "lib", ()),
        ("targets", ("knot",), "lib", ()),
        ("targets", ("hoist",), "lib/p", ()),
        ("directory", ("pkg/include/",), "include", ("*.h", "*.hpp")),
        ("directory", ("pkg/launch/",), "share/p/launch", ()),
        ("programs", ("pkg/scripts/lower",), "lib/p", ()),
    ]


def test_libraries_are_exported():
    made = make()
    assert {(e.how, e.item) for e in made.exports} == {
        ("include_dirs", "pkg/include"),
        ("libraries", "rope"),
        ("libraries", "extra"),
        ("system_depends", "EIGEN3"),
    }
    assert made.catkin_package is not None
    assert made.before_catkin_destinations == ()


def test_a_tree_that_defines_the_macros_itself_is_followed():
    own = "macro(cs_add_library name)\n  add_library(${name}_impl x.cpp)\nendmacro()\n"
    names = [t.name for t in make(own + SOURCE).targets if t.kind == "library"]
    assert names == ["rope_impl", "knot_impl"]
