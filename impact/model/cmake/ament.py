"""ament_cmake, ament_cmake_auto, rosidl, rclcpp_components, pluginlib and generate_parameter_library.

Source: the CMake files of those packages, and the ament_cmake user documentation.
"""

import posixpath

from ...facts.condition import Condition
from .blocks import CommandCall
from .build import At, DependencyCall, FoundPackage, GeneratedInterfaces, WrittenPath
from .find import set_catkin_destinations
from .interpreter import SOURCES, Interpreter, handles, stands_in_for
from .names import make_name_set
from .targets import add_links, add_sources, makes_archives, note_signature, resolve_target
from .values import CMakeValue, Word, group_by_keyword, split_words, wrap


@handles("ament_target_dependencies", least=1)
def add_target_dependencies(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_target_dependencies()."""
    items = [item for item in split_words(args[1:]) if item != "SYSTEM"]
    draft = resolve_target(run, args[0])
    # What has neither libraries nor targets (Eigen3) is not linked; packages of ROS are taken to have some.
    declared = run.declared.names
    if any(item in declared or "$" in item for item in items):
        note_signature(run, draft, [args[0], *items])
    add_links(run, draft, items, "ament")
    if not run.silent:
        conditions = run.merge_with(args[0])
        made = DependencyCall(run.locate(call.at), draft.name, _tell_arguments(run, call), conditions)
        run.dependency_calls[made] = None


def _tell_arguments(run: Interpreter, call: CommandCall) -> tuple[tuple[str, At, tuple[str, ...]], ...]:
    """The arguments of a call as DependencyCall has them."""
    arguments: list[tuple[str, At, tuple[str, ...]]] = []
    for template in call.templates:
        words = split_words(run.expand([template]))
        unsure = any(not word.sure or word.conditions or "$" in word for word in words)
        if template.quoted or unsure or run.locate(template.at) != template.at:
            return ()
        arguments.append((template.raw, template.at, tuple(map(str, words))))
    return tuple(arguments)


_EXPORTS = {
    "ament_export_dependencies": "ament_export_dependencies",
    "ament_export_include_directories": "ament_export_include_directories",
    "ament_export_libraries": "ament_export_libraries",
    "ament_export_library_names": "ament_export_libraries",
    "ament_export_targets": "ament_export_targets",
    "ament_export_interfaces": "ament_export_targets",
    "ament_export_definitions": "ament_export_definitions",
    "ament_export_link_flags": "ament_export_link_flags",
}


@handles(*_EXPORTS)
def run_ament_export(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_export_dependencies() and kin."""
    how = _EXPORTS[call.name]
    given = group_by_keyword(args, frozenset({"HAS_LIBRARY_TARGET", "NAMESPACE"}))
    space = str(given["NAMESPACE"][0]) if given.get("NAMESPACE") else ""
    for item in split_words([*given[""], *given.get("HAS_LIBRARY_TARGET", ()), *given.get("NAMESPACE", ())[1:]]):
        # Folders are relative to the install prefix here, unlike in catkin_package().
        run.add_export(item, how, item.at, run.merge_with(item), space)


@handles("ament_package")
def run_ament_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_package(CONFIG_EXTRAS ...)."""
    run.refuse_project()
    if not run.silent:
        run.ament_package = run.locate(call.at)
    given = group_by_keyword(args, frozenset({"CONFIG_EXTRAS", "CONFIG_EXTRAS_POST"}))
    held = run.get(f"{run.installed_name}_CONFIG_EXTRAS")
    extras = [*given.get("CONFIG_EXTRAS", []), *given.get("CONFIG_EXTRAS_POST", []), *(held.words if held else ())]
    for item in split_words(extras):
        path = run.resolve_tree_path(item)
        run.add_export(path, "cfg_extras", item.at, run.merge_with(item))
        run.hand_on(path, item.at)


@handles("ament_package_xml", "catkin_package_xml")
def read_package_xml(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_package_xml() and catkin_package_xml(): the version is known from here on, and with catkin where things are
    installed."""
    run.refuse_project()
    if call.name == "catkin_package_xml":
        set_catkin_destinations(run, call, args)
        for kind, names in (("BUILD", run.declared.build), ("RUN", run.declared.exported)):
            declared = CMakeValue(tuple(wrap(name, call.at) for name in names))
            run.assign(run.scope, f"{run.installed_name}_{kind}_DEPENDS", declared)


@handles("ament_register_extension")
def register_extension(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_register_extension(point package file): in a script that is given to others, the file runs for them."""
    if run.handing_on and len(args) >= 3:
        run.hand_on(run.resolve_tree_path(args[2]), call.at)


# What the generators of rosidl find where they make tests of what they generate.
_LINTERS = ("ament_cmake_cppcheck", "ament_cmake_cpplint", "ament_cmake_uncrustify")
_ROSIDL = make_name_set(
    """
    DEPENDENCIES LIBRARY_NAME SKIP_INSTALL SKIP_GROUP_MEMBERSHIP_CHECK ADD_LINTER_TESTS
    """
)


@handles("rosidl_generate_interfaces", least=1)
def generate_interfaces(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rosidl_generate_interfaces(target files... DEPENDENCIES packages...)."""
    if run.silent:
        return
    target = args[0]
    given = group_by_keyword(args[1:], _ROSIDL)
    if given.get("LIBRARY_NAME"):
        given[""].extend(given["LIBRARY_NAME"][1:])
    for flag in ("SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK", "ADD_LINTER_TESTS"):
        given[""].extend(given.get(flag, []))
    files: list[str] = []
    for item in split_words(given[""]):
        # `folder:path` gives the folder that the path is relative to.
        base, separator, rest = item.partition(":")
        text = posixpath.join(base, rest) if separator else str(item)
        path = run.resolve_tree_path(wrap(text, item.at))
        files.append(path)
        run.message_files.append(WrittenPath(path, "read", call.name, run.locate(item.at), run.conditions))
    wanted = tuple((str(item), run.locate(item.at)) for item in split_words(given.get("DEPENDENCIES", [])))
    run.generated.append(
        GeneratedInterfaces(
            "rosidl",
            str(target),
            tuple(files),
            wanted,
            run.locate(call.at),
            run.merge_with(target),
            "SKIP_INSTALL" not in given,
        )
    )
    if "ADD_LINTER_TESTS" in given:
        tested = (*run.conditions, Condition("cmake", "BUILD_TESTING"))
        for name in _LINTERS:
            run.add_found(
                FoundPackage(name, "find_package", run.locate(call.at), True, conditions=tested, via=call.name)
            )
    run.add_target(target, "generated")
    if "SKIP_INSTALL" not in given:  # else nothing is done under the name of the package
        run.refuse_project()
    run.set_text("rosidl_generate_interfaces_TARGET", str(target), call.at)
    for language in ("rosidl_typesupport_cpp", "rosidl_typesupport_c", "rosidl_generator_c", "rosidl_generator_cpp",
                     "rosidl_generator_py", "cpp", "py"):  # fmt: skip
        run.ensure_target(f"{target}__{language}", "generated", target.at)


@handles("rosidl_target_interfaces", least=2)
def link_interfaces(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rosidl_target_interfaces(target interfaces typesupport), until Humble."""
    add_links(run, resolve_target(run, args[0]), [args[1]], "interfaces")


@handles("rosidl_get_typesupport_target", least=3)
def get_typesupport_target(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rosidl_get_typesupport_target(variable interfaces typesupport)."""
    run.set_text(args[0], f"{args[1]}__{args[2]}", args[1].at)


@handles("rclcpp_components_register_nodes")
def register_component_nodes(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rclcpp_components_register_nodes(target classes...)."""
    for item in split_words(args[1:]):
        if item not in ("RESOURCE_INDEX", "rclcpp_components"):
            run.add_export(item, "component", item.at, run.merge_with(item), str(args[0]))


@handles("rclcpp_components_register_node", least=1)
def register_component_node(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rclcpp_components_register_node(target PLUGIN class EXECUTABLE name): also makes and installs an executable."""
    given = group_by_keyword(args[1:], make_name_set("PLUGIN EXECUTABLE EXECUTOR RESOURCE_INDEX NO_UNDEFINED_SYMBOLS"))
    programs = given.get("EXECUTABLE", [])[:1]
    for item in given.get("PLUGIN", [])[:1]:
        program = "".join(run.clean(one) for one in programs)
        run.add_export(item, "component", item.at, run.merge_with(item), str(args[0]), program)
    for item in programs:
        run.ensure_target(item, "executable", item.at)
        run.add_install("targets", (str(item),), f"lib/{run.installed_name}", item)


@handles("pluginlib_export_plugin_description_file", least=2)
def export_plugin_description(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """pluginlib_export_plugin_description_file(base_package file): the file is installed too."""
    item = args[1]
    path = run.resolve_tree_path(item)
    run.add_export(path, "plugin_description", item.at, run.merge_with(item), str(args[0]))
    folder = "" if item.startswith("/") else posixpath.dirname(item)
    destination = posixpath.join("share", run.installed_name, folder).rstrip("/")
    run.add_install("files", (path,), destination, item)


@handles("ament_python_install_package", "_ament_cmake_python_install_package", least=1)
def install_python_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_python_install_package(name PACKAGE_DIR folder)."""
    given = group_by_keyword(
        args[1:],
        make_name_set("PACKAGE_DIR VERSION SETUP_CFG DESTINATION SCRIPTS_DESTINATION SKIP_COMPILE"),
    )
    folder = given["PACKAGE_DIR"][0] if given.get("PACKAGE_DIR") else args[0]
    run.add_install("python", (run.resolve_tree_path(folder),), str(args[0]), args[0])


@handles("ament_python_install_module")
def install_python_module(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_python_install_module(file)."""
    for item in args[:1]:
        run.add_install("python", (run.resolve_tree_path(item),), "", item)


@handles("generate_parameter_library", "generate_parameter_module", least=2)
def generate_parameter_library(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """generate_parameter_library(target yaml [validation header])."""
    if run.silent:
        return
    files = tuple(run.resolve_tree_path(item) for item in args[1:])
    run.generated.append(
        GeneratedInterfaces("parameters", str(args[0]), files, (), run.locate(call.at), run.merge_with(args[0]))
    )
    run.ensure_target(args[0], "generated", args[0].at)


_TEST_OPTIONS = make_name_set(
    """
    RUNNER TIMEOUT WORKING_DIRECTORY ENV APPEND_ENV APPEND_LIBRARY_DIRS SKIP_LINKING_MAIN_LIBRARIES SKIP_TEST
    SKIP_RETURN_CODE PYTHON_EXECUTABLE COMMAND OUTPUT_FILE RESULT_FILE GENERATE_RESULT_FOR_RETURN_CODE_ZERO ARGS
    LABELS TARGET PROCESSORS EXCLUDE_FROM_ALL
    """
)
_FLAGS = frozenset({"SKIP_LINKING_MAIN_LIBRARIES", "SKIP_TEST", "EXCLUDE_FROM_ALL"})


def group_test_arguments(args: list[Word]) -> dict[str, list[Word]]:
    """Arguments of a test command by keyword; a flag takes none, so sources may follow it."""
    found = group_by_keyword(args, _TEST_OPTIONS)
    for flag in _FLAGS:
        found[""].extend(found.get(flag, []))
    return found


@handles(
    "ament_add_gtest",
    "ament_add_gmock",
    "ament_add_gtest_executable",
    "ament_add_gmock_executable",
    "ament_add_google_benchmark",
    "ament_add_google_benchmark_executable",
    "ament_add_ros_isolated_gtest",
    "ament_add_ros_isolated_gmock",
    "ament_add_catch2",
)
def add_ament_gtest(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Tests that are executables."""
    if args:
        draft = run.add_target(args[0], "test")
        add_sources(run, draft, group_test_arguments(args[1:])[""])


@handles("ament_add_pytest_test", "ament_add_nose_test", "add_launch_test", "add_ros_test", "ament_add_test",
         "ament_add_ros_isolated_pytest_test", "add_ros_isolated_launch_test", least=1)  # fmt: skip
def add_ament_test(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Tests that run a file; add_launch_test() names its test after the file unless TARGET says otherwise."""
    given = group_test_arguments(args[1:])
    name = args[0]
    sources = given[""][:1]
    if call.name in ("add_launch_test", "add_ros_test", "add_ros_isolated_launch_test"):
        sources = [name]
        name = given["TARGET"][0] if given.get("TARGET") else wrap(name.replace("/", "_"), name.at, name.conditions)
    if name in run.targets:
        return
    draft = run.ensure_target(name, "test", name.at)
    if call.name != "ament_add_test":
        add_sources(run, draft, sources)


@handles("ament_add_gtest_test", "ament_add_gmock_test", "ament_add_google_benchmark_test", "ament_add_test_label")
def accept_known_test(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Commands about a test executable that is there already."""


@handles("ament_vendor", least=1)
def add_vendor_target(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_vendor_target(): downloads and builds a project."""
    run.ensure_target(args[0], "external", args[0].at)


@handles("ament_auto_find_build_dependencies", "ament_auto_find_test_dependencies")
def find_build_dependencies(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """find_build_dependencies() and its twin for tests: find every dependency declared for it."""
    given = group_by_keyword(args, frozenset({"REQUIRED"}))
    required = {str(item) for item in given.get("REQUIRED", [])}
    declared = run.declared.test if call.name.endswith("test_dependencies") else run.declared.build
    names = [name for name in declared if name not in required]
    for item in split_words(given.get("REQUIRED", [])):
        run.add_found(FoundPackage(str(item), "declared", run.locate(item.at), True, conditions=run.merge_with(item)))
        run.extend(str(item), item.at)
    for name in names:
        conditions = run.declared.add_condition(name, run.conditions)
        run.add_found(FoundPackage(name, "declared", run.locate(call.at), conditions=conditions))
        run.extend(name, call.at)


@handles("ament_auto_add_library", "ament_auto_add_executable", "ament_auto_add_gtest", "ament_auto_add_gmock", least=1)
def add_auto_target(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """ament_auto_add_library() and kin; DIRECTORY takes all sources of a folder."""
    name = args[0]
    kind = {"library": "library", "executable": "executable"}.get(call.name.rpartition("_")[2], "test")
    given = group_by_keyword(
        args[1:],
        make_name_set(
            """
    DIRECTORY STATIC SHARED MODULE INTERFACE EXCLUDE_FROM_ALL NO_TARGET_LINK_LIBRARIES
    """
        )
        | (_TEST_OPTIONS if kind == "test" else frozenset()),
    )
    if "INTERFACE" in given:
        kind = "interface"
    draft = run.add_target(name, kind)
    if "STATIC" in given:
        draft.installed_as = "static"
    draft.archive = "STATIC" in given or (given.keys().isdisjoint(("SHARED", "MODULE")) and makes_archives(run))
    for section in ("", "STATIC", "SHARED", "MODULE", "INTERFACE", "EXCLUDE_FROM_ALL", "NO_TARGET_LINK_LIBRARIES",
                    "SKIP_LINKING_MAIN_LIBRARIES", "SKIP_TEST"):  # fmt: skip
        add_sources(run, draft, given.get(section, []))
    for directory in given.get("DIRECTORY", []):
        relative = run.make_relative(run.resolve(directory))
        hits = run.glob(posixpath.join(relative, "*"), True) if relative is not None else []
        for path in sorted(hits):
            if path.endswith(SOURCES):
                draft.add_source(path, run.merge_with(directory))
    if run.has_path(run.resolve("include")):
        add_links(run, draft, [wrap("include", call.at)], "include", "PUBLIC")
    if kind in ("executable", "test") and "NO_TARGET_LINK_LIBRARIES" not in given:
        libraries = [made.name for made in run.automatic if made.kind == "library"]
        add_links(run, draft, [wrap(name, call.at) for name in libraries], "link")
    dependencies = run.declared.build + (run.declared.test if kind == "test" else ())
    add_links(run, draft, [wrap(name, call.at, run.declared.add_condition(name, ())) for name in dependencies], "ament")
    if kind == "test":
        framework = f"ament_cmake_{call.name.rpartition('_')[2]}"
        run.add_found(FoundPackage(framework, "find_package", run.locate(call.at), True, True,
                                   conditions=run.conditions, via=call.name))  # fmt: skip
    else:
        run.automatic.append(draft)


@handles("ament_auto_package", "autoware_ament_auto_package", "autoware_auto_package")
def run_auto_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """run_auto_package(): installs what ament_auto_add_*() made, include/, and INSTALL_TO_SHARE folders."""
    given = group_by_keyword(
        args,
        make_name_set(
            """
    INSTALL_TO_PATH INSTALL_TO_SHARE CONFIG_EXTRAS CONFIG_EXTRAS_POST USE_SCOPED_HEADER_INSTALL_DIR
    """
        ),
    )
    package = run.installed_name
    path_destination = "bin" if "INSTALL_TO_PATH" in given else f"lib/{package}"
    for draft in run.automatic:
        destination = path_destination if draft.kind == "executable" else "lib"
        run.add_install("targets", (draft.name,), destination, call, conditions=draft.conditions)
        if draft.kind in ("library", "interface"):
            run.add_export(draft.name, "ament_export_libraries", call.at, run.conditions)
    include = run.resolve_tree_path("include/")
    if run.has_path(run.resolve("include")):
        headers = f"include/{package}" if "USE_SCOPED_HEADER_INSTALL_DIR" in given else "include"
        run.add_install("directory", (include,), headers, call)
        run.add_export(headers, "ament_export_include_directories", call.at, run.conditions)
    share = split_words([*given.get("INSTALL_TO_SHARE", []), *given.get("USE_SCOPED_HEADER_INSTALL_DIR", [])])
    for item in share:
        run.add_install("directory", (run.resolve_tree_path(item),), f"share/{package}", item)
    for dependency in run.declared.build:
        if dependency in run.declared.exported:
            conditions = run.declared.add_condition(dependency, run.conditions)
            run.add_export(dependency, "ament_export_dependencies", call.at, conditions)
    extras = ("CONFIG_EXTRAS", *given.get("CONFIG_EXTRAS", []))
    run_ament_package(run, call, [item for item in args if item in extras])


@stands_in_for("autoware_package")
def run_autoware_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """run_autoware_package() of autoware_cmake: C++17, ament_cmake_auto, all declared dependencies, Eigen."""
    _set_wrapper_standard(run, call)
    for name in ("ament_cmake_auto", "eigen3_cmake_module", "Eigen3"):
        run.add_found(FoundPackage(name, "find_package", run.locate(call.at), conditions=run.conditions, via=call.name))
    find_build_dependencies(run, call, [])


@stands_in_for("nav2_package", "moveit_package")
def set_compile_defaults(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """nav2_package() of nav2_common and moveit_package() of moveit_common: C++17 unless another is set."""
    _set_wrapper_standard(run, call)


@stands_in_for("set_compiler_options", "export_windows_symbols")
def set_ros2_control_defaults(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """set_compiler_options() and export_windows_symbols() of ros2_control_cmake: warnings, and C++17 unless set."""
    if call.name == "set_compiler_options":
        _set_wrapper_standard(run, call)


def _set_wrapper_standard(run: Interpreter, call: CommandCall) -> None:
    """C++17, where nothing else is set."""
    if run.get("CMAKE_CXX_STANDARD") is None and not run.silent:
        run.standards.append((17, run.locate(call.at), True, False, run.conditions))


@handles("ament_lint_auto_find_test_dependencies")
def find_lint_dependencies(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """find_lint_dependencies(): finds every declared test dependency."""
    for name in run.declared.test:
        conditions = run.declared.add_condition(name, run.conditions)
        run.add_found(FoundPackage(name, "ament_lint_auto", run.locate(call.at), conditions=conditions))
        run.extend(name, call.at)
