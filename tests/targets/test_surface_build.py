"""What a package offers to CMake and at run time, and what changed between two states of it."""

import textwrap

import pytest
from rosimpact.databuild.surface.build import KINDS, build_surface
from rosimpact.databuild.surface.compare_build import compare
from rosimpact.impact.facts.extract import extract_all
from rosimpact.impact.facts.kinds import find_kind
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.package import Watched
from rosimpact.impact.model.workspace import link
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>arm</name><version>1.2.3</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>{tool}</buildtool_depend>
<export><build_type>{tool}</build_type></export></package>"""


def wanted(path):
    kind = find_kind(path)
    return kind if kind in KINDS else None


@pytest.fixture
def surface(tmp_path_factory):
    """The surface of a package called arm: its CMake between project() and the end, other files by path."""

    def make(cmake="", files=(), tool="ament_cmake"):
        folder = tmp_path_factory.mktemp("ws")
        files = dict.fromkeys(files, "") if not isinstance(files, dict) else files
        head = "cmake_minimum_required(VERSION 3.16)\nproject(arm)\n"
        made = {"package.xml": MANIFEST.format(tool=tool), **files}
        if tool != "ament_python":
            made["CMakeLists.txt"] = head + textwrap.dedent(cmake)
        for path, text in made.items():
            (folder / "arm" / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / "arm" / path).write_text(textwrap.dedent(text))
        tree = WorkingTree(folder)
        with Store(tmp_path_factory.mktemp("cache")) as store:
            extraction = extract_all(tree, store, jobs=1, kind_of=wanted)
            workspace = link(tree, extraction, store, None, Watched(), 1)
            return build_surface(workspace, workspace.packages["arm"])

    return make


LIBRARY = """
add_library(core SHARED a.cpp)
target_include_directories(core PUBLIC $<INSTALL_INTERFACE:include/${PROJECT_NAME}>)
target_compile_features(core PUBLIC cxx_std_17)
install(TARGETS core EXPORT export_arm LIBRARY DESTINATION lib)
install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})
ament_export_targets(export_arm HAS_LIBRARY_TARGET)
ament_export_libraries(core)
ament_export_dependencies(rclcpp tf2)
ament_package()
"""


def test_an_ament_library(surface):
    found = surface(LIBRARY, ["include/arm/a.hpp", "include/arm/notes.txt", "a.cpp"])
    assert (found.version, found.build_type, found.cmake_names) == ("1.2.3", "ament_cmake", ("arm",))
    assert [(t.name, t.kind, t.standard, t.sure) for t in found.targets] == [("arm::core", "library", 17, True)]
    assert (found.libraries, found.dependencies, found.standard) == (("core",), ("rclcpp", "tf2"), 17)
    assert [(h.include, h.installed, h.source) for h in found.headers] == [
        ("arm/a.hpp", "include/arm/arm/a.hpp", "include/arm/a.hpp")
    ]
    assert found.unknown == ()


@pytest.mark.parametrize(
    ("cmake", "targets"),
    [
        ("install(TARGETS core EXPORT e)\nament_export_targets(e NAMESPACE other::)", ["other::core"]),
        ("install(TARGETS core EXPORT e)\ninstall(EXPORT e NAMESPACE a:: DESTINATION share)", ["a::core"]),
        ("install(TARGETS core EXPORT e)\ninstall(EXPORT e DESTINATION share)", ["core"]),
        ("set_target_properties(core PROPERTIES EXPORT_NAME c)\ninstall(TARGETS core EXPORT arm)\n"
         "ament_export_targets(arm)", ["arm::c"]),
        ("install(TARGETS core EXPORT e)", []),
        ("if(WITH)\n  install(TARGETS core EXPORT e)\nendif()\nament_export_targets(e)", ["arm::core?"]),
        ("if(BUILD_TESTING)\n  install(TARGETS core EXPORT e)\n  ament_export_targets(e)\nendif()", []),
    ],
)  # fmt: skip
def test_exported_targets(surface, cmake, targets):
    found = surface(f"add_library(core a.cpp)\n{cmake}\nament_package()")
    assert [t.name + ("" if t.sure else "?") for t in found.targets] == targets


def test_an_export_set_that_nothing_fills_is_unknown(surface):
    assert surface("ament_export_targets(${UNSET}_x)\nament_package()").unknown


def test_a_standard_for_the_package_alone_is_none_for_its_users(surface):
    cmake = "set(CMAKE_CXX_STANDARD 17)\n" + LIBRARY.replace("PUBLIC cxx_std_17", "PRIVATE cxx_std_20")
    assert surface(cmake).standard == 0


def test_interfaces(surface):
    cmake = 'rosidl_generate_interfaces(${PROJECT_NAME} "msg/JointState.msg" DEPENDENCIES std_msgs)\nament_package()'
    found = surface(cmake, ["msg/JointState.msg"])
    assert [t.name for t in found.targets] == ["arm::arm__rosidl_typesupport_c", "arm::arm__rosidl_typesupport_cpp"]
    assert [(h.include, h.source) for h in found.headers] == [
        ("arm/msg/joint_state.h", ""),
        ("arm/msg/joint_state.hpp", ""),
    ]
    assert found.dependencies == ("std_msgs",)
    assert found.unknown == (("targets", "`arm::arm__*` is generated"),)


def test_a_catkin_package(surface):
    cmake = """
    find_package(catkin REQUIRED COMPONENTS roscpp message_generation)
    add_message_files(FILES A.msg)
    generate_messages()
    catkin_package(INCLUDE_DIRS include LIBRARIES arm CATKIN_DEPENDS roscpp DEPENDS Boost CFG_EXTRAS arm-extras.cmake)
    add_library(arm a.cpp)
    install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION}
            FILES_MATCHING PATTERN "*.h" PATTERN ".svn" EXCLUDE)
    add_executable(node n.cpp)
    install(TARGETS node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
    catkin_install_python(PROGRAMS scripts/tool.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
    """
    extras = """
    set(ARM_FLAG 1)
    function(arm_add thing)
      set(inner 1)
    endfunction()
    macro(_arm_hidden)
    endmacro()
    """
    files = {"include/arm/a.h": "", "include/arm/b.hpp": "", "include/arm/.svn/c.h": "", "msg/A.msg": "",
             "cmake/arm-extras.cmake.in": extras}  # fmt: skip
    found = surface(cmake, files, "catkin")
    assert (found.cmake_names, found.libraries, found.dependencies, found.system) == (
        ("arm",),
        ("arm",),
        ("roscpp",),
        ("Boost",),
    )
    assert [h.include for h in found.headers] == ["arm/A.h", "arm/a.h"]
    assert (found.commands, found.variables) == (("arm_add",), ("ARM_FLAG",))
    assert [(p.name, p.place, p.how) for p in found.programs] == [
        ("node", "lib/arm", "binary"),
        ("tool.py", "lib/arm", "script"),
    ]


@pytest.mark.parametrize(
    ("cmake", "headers"),
    [
        ("install(DIRECTORY include/ DESTINATION include)", ["arm/a.hpp", "arm/deep/b.h"]),
        ("install(DIRECTORY include/arm DESTINATION include)", ["arm/a.hpp", "arm/deep/b.h"]),
        ("install(DIRECTORY include/ DESTINATION include PATTERN deep EXCLUDE)", ["arm/a.hpp"]),
        ('install(DIRECTORY include/ DESTINATION include FILES_MATCHING REGEX "[.]h$")', ["arm/deep/b.h"]),
        ("install(FILES include/arm/a.hpp DESTINATION include/arm RENAME c.hpp)", ["arm/c.hpp"]),
        ("install(FILES ${CMAKE_CURRENT_BINARY_DIR}/export.h DESTINATION include/arm)", ["arm/export.h"]),
        ("install(FILES ${CATKIN_DEVEL_PREFIX}/include/arm/made.h DESTINATION include/arm)", ["arm/made.h"]),
        ("if(X)\n  install(FILES include/arm/a.hpp DESTINATION include/arm)\nendif()", ["arm/a.hpp?"]),
        ("install(DIRECTORY include/ DESTINATION include/arm)\nament_export_include_directories(include/arm)",
         ["arm/a.hpp", "arm/deep/b.h"]),
        # The folder that is searched is not where they go: the prefix's own is searched too.
        ("install(DIRECTORY include/ DESTINATION include)\nament_export_include_directories(include/arm)",
         ["arm/a.hpp?", "deep/b.h"]),
        ("install(DIRECTORY include/ DESTINATION share/arm)", []),
    ],
)  # fmt: skip
def test_headers(surface, cmake, headers):
    found = surface(f"{cmake}\nament_package()", ["include/arm/a.hpp", "include/arm/deep/b.h"])
    assert [h.include + ("" if h.sure else "?") for h in found.headers] == headers


def test_headers_of_a_folder_that_cannot_be_told_are_unknown(surface):
    found = surface("install(DIRECTORY ${SOMEWHERE}/include/ DESTINATION include)\nament_package()")
    assert found.headers == ()
    assert found.unknown == (("headers", "`${SOMEWHERE}/include/` is installed"),)


def test_a_catkin_package_in_depends_is_a_dependency_like_others(surface):
    cmake = "find_package(catkin REQUIRED COMPONENTS tf2 urdf)\ncatkin_package(DEPENDS tf2 Boost)"
    found = surface(cmake, tool="catkin")
    assert (found.dependencies, found.system) == (("tf2",), ("Boost",))


def test_components_and_plugins(surface):
    cmake = """
    add_library(core SHARED a.cpp)
    rclcpp_components_register_node(core PLUGIN "arm::Node" EXECUTABLE node)
    pluginlib_export_plugin_description_file(base plugins.xml)
    ament_package()
    """
    xml = '<library path="core"><class name="arm/P" type="arm::P" base_class_type="base::B"/></library>'
    found = surface(cmake, {"plugins.xml": xml})
    assert [(p.name, p.type, p.base) for p in found.plugins] == [
        ("arm/P", "arm::P", "base::B"),
        ("arm::Node", "arm::Node", "rclcpp_components"),
    ]
    assert [(p.name, p.how) for p in found.programs] == [("node", "component")]


LAUNCH = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
def generate_launch_description():
    return LaunchDescription([DeclareLaunchArgument('ns'), DeclareLaunchArgument('sim', default_value='false')])
"""


def test_launch_files_and_their_arguments(surface):
    cmake = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\nament_package()"
    xml = '<launch><arg name="a"/><group><arg name="b" default="$(var a)"/></group></launch>'
    found = surface(cmake, {"launch/a.launch.py": LAUNCH, "launch/b.launch.xml": xml, "other/c.launch.py": LAUNCH})
    assert [(f.path, f.arguments) for f in found.launches] == [
        ("launch/a.launch.py", (("ns", None), ("sim", "false"))),
        ("launch/b.launch.xml", (("a", None), ("b", "?"))),
    ]


def test_an_ament_python_package(surface):
    setup = """
    setup(packages=['arm'], data_files=[('share/arm/launch', glob('launch/*.py'))],
          entry_points={'console_scripts': ['talk = arm.talk:main']})
    """
    files = {"setup.py": setup, "setup.cfg": "[install]\ninstall_scripts=$base/lib/arm", "launch/a.launch.py": LAUNCH}
    found = surface(files=files, tool="ament_python")
    assert [(p.name, p.place, p.how) for p in found.programs] == [("talk", "lib/arm", "entry point")]
    assert [f.path for f in found.launches] == ["launch/a.launch.py"]
    assert found.cmake_names == ()


def test_a_plain_cmake_package_with_a_configuration_of_its_own(surface):
    cmake = """
    include(CMakePackageConfigHelpers)
    configure_package_config_file(cmake/ArmConfig.cmake.in ArmConfig.cmake INSTALL_DESTINATION lib)
    """
    found = surface(cmake, {"cmake/ArmConfig.cmake.in": "macro(arm_use)\nendmacro()\n"}, "cmake")
    assert (found.cmake_names, found.commands) == (("Arm",), ("arm_use",))


# -- what changed


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (LIBRARY, LIBRARY, []),
        (LIBRARY, LIBRARY.replace("HAS_LIBRARY_TARGET", "NAMESPACE a::"),
         [("moved", "target", "arm::core", "a::core")]),
        (LIBRARY, LIBRARY.replace("rclcpp ", ""), [("removed", "dependency", "rclcpp", "")]),
        (LIBRARY, LIBRARY.replace("std_17", "std_20"), [("signature", "standard", "C++", "20")]),
        (LIBRARY, LIBRARY.replace("/${PROJECT_NAME}", ""), []),
        (LIBRARY, LIBRARY.replace("DESTINATION include/${PROJECT_NAME})", "DESTINATION include/${PROJECT_NAME}/b)"),
         [("moved", "header", "arm/a.hpp", "b/arm/a.hpp")]),
        (LIBRARY, LIBRARY.replace("install(DIRECTORY include/", "install(DIRECTORY ${X}/include/"),
         [("removed", "header", "arm/a.hpp", "unsure")]),
    ],
)  # fmt: skip
def test_compare(surface, old, new, expected):
    files = ["include/arm/a.hpp", "a.cpp"]
    changes = compare(surface(old, files), surface(new, files))
    assert [(c.kind, c.what, c.name, (c.now or c.instead) if c.sure == 1 else "unsure") for c in changes] == expected


def test_launch_arguments_that_changed(surface):
    cmake = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\nament_package()"
    old = '<launch><arg name="a" default="1"/><arg name="b" default="1"/><arg name="c" default="1"/></launch>'
    new = '<launch><arg name="a" default="2"/><arg name="b"/><arg name="d"/></launch>'
    changes = compare(*(surface(cmake, {"launch/x.launch": text}) for text in (old, new)))
    assert [(c.kind, c.name, c.breaks) for c in changes] == [
        ("default", "launch/x.launch a", False),
        ("signature", "launch/x.launch b", True),
        ("removed", "launch/x.launch c", True),
        ("added", "launch/x.launch d", True),
    ]
