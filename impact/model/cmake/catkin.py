"""catkin, genmsg, dynamic_reconfigure and rostest, and the rosbuild macros that older packages still carry.

Source: catkin's API reference and the CMake files of genmsg, actionlib_msgs, dynamic_reconfigure and rostest.
"""

import posixpath
import re

from ...facts.condition import Condition
from .blocks import CommandCall
from .build import At, GeneratedInterfaces, WrittenPath
from .find import set_catkin_destinations
from .interpreter import Interpreter, handles
from .names import make_name_set
from .targets import add_links, add_sources, note_made
from .values import CMakeValue, Word, group_by_keyword, split_words, wrap

_PACKAGE = make_name_set(
    """
    INCLUDE_DIRS LIBRARIES CATKIN_DEPENDS DEPENDS CFG_EXTRAS EXPORTED_TARGETS SKIP_CMAKE_CONFIG_GENERATION
    SKIP_PKG_CONFIG_GENERATION
    """
)
_PROMISES = {
    "INCLUDE_DIRS": "include_dirs",
    "LIBRARIES": "libraries",
    "CATKIN_DEPENDS": "catkin_depends",
    "DEPENDS": "system_depends",
    "CFG_EXTRAS": "cfg_extras",
}


@handles("catkin_package")
def run_catkin_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """catkin_package()."""
    run.refuse_project()
    if not run.silent:
        run.catkin_package = run.locate(call.at)
        run.catkin_packages.append((_get_project(run), run.conditions))
    set_catkin_destinations(run, call, args)
    for keyword, items in group_by_keyword(_mark_forgotten(args), _PACKAGE).items():
        how = _PROMISES.get(keyword)
        if how is None:
            continue
        for item in split_words(items):
            text: str = item
            if how == "include_dirs":
                text = run.resolve_tree_path(item)
            elif how == "cfg_extras":
                text = _resolve_extras_path(run, item)
                run.hand_on(text, item.at)
            run.add_export(text, how, item.at, run.merge_with(item))
    package = run.installed_name
    run.set_unknown(f"{package}_EXPORTED_TARGETS", call.at)


def _get_project(run: Interpreter) -> str:
    held = run.get("PROJECT_NAME")
    return held.text if held is not None else ""


def refuse_late(run: Interpreter, call: CommandCall) -> None:
    """Refuses a macro that stops where catkin_package() was called for the same project."""
    opposite = {(held.text, not held.negated) for held in run.conditions}
    for project, conditions in run.catkin_packages:
        if project == _get_project(run) and not any((held.text, held.negated) in opposite for held in conditions):
            run.refuse("late", wrap(call.name, call.at, run.conditions), conditions)


def refuse_unguarded(run: Interpreter, call: CommandCall) -> None:
    """Refuses a command for tests that stops where tests are switched off. Who switches on what is off by default asks
    for it. Source: _generate_function_if_testing_is_disabled() of catkin."""
    tested = any("TESTING" in held.text or _is_off_by_default(run, held) for held in run.conditions)
    if not tested and not call.name.startswith(("rosbuild", "roslaunch")):
        run.refuse("unguarded", wrap(call.name, call.at, run.conditions))


def _is_off_by_default(run: Interpreter, held: Condition) -> bool:
    """Whether a condition holds only where an option is set that is not set by default."""
    options = set(re.findall(r"\w+", held.text)) - {"AND", "OR"}
    values = [run.cache.get(name) for name in options]
    return not held.negated and bool(values) and all(one is not None and one.text.upper() in _OFF for one in values)


_OFF = frozenset(("OFF", "0", "FALSE", "NO", "N"))
# parse_cmake_arguments() as a script, which it was before CMake 3.5, forgets what followed a keyword that comes again.
_KEEPS_ALL = Condition("cmake", "CMAKE_VERSION VERSION_LESS 3.5", negated=True)


def _mark_forgotten(args: list[Word]) -> list[Word]:
    """Arguments, those that stand behind a keyword which comes again under the version of CMake that keeps them."""
    last = {str(item): place for place, item in enumerate(args) if item in _PACKAGE}
    found, keyword = [], ""
    for place, item in enumerate(args):
        if item in last:
            keyword = str(item)
        elif place < last.get(keyword, 0):
            item = wrap(item, item.at, (*item.conditions, _KEEPS_ALL), item.sure)
        found.append(item)
    return found


def _resolve_extras_path(run: Interpreter, item: Word) -> str:
    """The file a CFG_EXTRAS entry is made from: `cmake/x.cmake`, or the same with `.in` or `.em`."""
    base = run.resolve_tree_path(item if "/" in item else wrap(f"cmake/{item}", item.at))
    return next((path for path in (base, f"{base}.in", f"{base}.em") if run.exists(path)), base)


@handles("catkin_metapackage")
def run_catkin_metapackage(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """run_catkin_metapackage()."""
    run.refuse_project()
    if not run.silent:
        run.catkin_package = run.locate(call.at)


_MESSAGE_FOLDERS = {"add_message_files": "msg", "add_service_files": "srv", "add_action_files": "action"}
_ADD_FILES = make_name_set("DIRECTORY FILES PACKAGE BASE_DIR NOINSTALL")


@handles(*_MESSAGE_FOLDERS)
def add_interface_files(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_message_files() and kin; without files it takes the whole folder."""
    if run.silent:
        return
    set_catkin_destinations(run, call, args)
    kind = _MESSAGE_FOLDERS[call.name]
    given = group_by_keyword(args, _ADD_FILES)
    folder = str(given["DIRECTORY"][0]) if given.get("DIRECTORY") else kind
    files = split_words([*given.get("FILES", []), *given[""]])
    if "FILES" not in given and not files:
        relative = run.make_relative(run.resolve(folder))
        hits = run.glob(posixpath.join(relative, f"*.{kind}"), False) if relative is not None else []
        for path in sorted(hits):
            run.message_files.append(WrittenPath(path, "read", call.name, run.locate(call.at), run.conditions))
        return
    for item in files:
        path = run.resolve_tree_path(wrap(posixpath.join(folder, item), item.at))
        run.message_files.append(WrittenPath(path, "read", call.name, run.locate(item.at), run.conditions))


_GENERATORS = ("cpp", "py", "lisp", "eus", "nodejs")


@handles("generate_messages")
def generate_messages(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """generate_messages(): its targets are X_generate_messages, X_generate_messages_cpp, X_gencpp and so on."""
    if run.silent:
        return
    refuse_late(run, call)
    set_catkin_destinations(run, call, args)
    given = group_by_keyword(args, frozenset({"DEPENDENCIES", "LANGS"}))
    package = run.installed_name
    target = f"{package}_generate_messages"
    files = tuple(file.path for file in run.message_files if file.by in _MESSAGE_FOLDERS)
    wanted = tuple((str(item), run.locate(item.at)) for item in split_words(given.get("DEPENDENCIES", [])))
    run.generated.append(GeneratedInterfaces("catkin", target, files, wanted, run.locate(call.at), run.conditions))
    run.ensure_target(target, "generated", call.at)
    for language in _GENERATORS:
        run.ensure_target(f"{target}_{language}", "generated", call.at)
        run.ensure_target(f"{package}_gen{language}", "generated", call.at)


@handles("generate_dynamic_reconfigure_options")
def generate_dynamic_reconfigure_options(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """generate_dynamic_reconfigure_options(): its target is X_gencfg."""
    if run.silent:
        return
    refuse_late(run, call)
    set_catkin_destinations(run, call, args)
    target = f"{run.installed_name}_gencfg"
    files = tuple(run.resolve_tree_path(item) for item in split_words(args))
    run.generated.append(GeneratedInterfaces("reconfigure", target, files, (), run.locate(call.at), run.conditions))
    run.ensure_target(target, "generated", call.at)


@handles("catkin_python_setup")
def install_python_setup(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """install_python_setup(): what setup.py names is installed."""
    item = run.resolve_tree_path("setup.py")
    destination = f"lib/python3/dist-packages/{run.installed_name}"
    run.add_install("python", (item,), destination, call)


@handles("catkin_install_python")
def install_python_programs(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """catkin_install_python(PROGRAMS ... DESTINATION ...)."""
    given = group_by_keyword(args, frozenset({"PROGRAMS", "DESTINATION", "OPTIONAL"}))
    destination = run.clean(given["DESTINATION"][0]) if given.get("DESTINATION") else ""
    for item in split_words(given.get("PROGRAMS", [])):
        run.add_install("programs", (run.resolve_tree_path(item),), destination, item, rewritten=True)


_TEST_OPTIONS = make_name_set("WORKING_DIRECTORY TIMEOUT ENVIRONMENT DEPENDENCIES ARGS")


@handles(
    "catkin_add_gtest",
    "catkin_add_gmock",
    "catkin_add_executable_with_gtest",
    "catkin_add_executable_with_gmock",
    "add_rostest_gtest",
    "add_rostest_gmock",
    "rosbuild_add_gtest",
    "rosbuild_add_gtest_build_flags",
    least=1,
)
def add_catkin_gtest(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Tests that are executables: add_catkin_gtest(), add_rostest_gtest() and kin."""
    refuse_unguarded(run, call)
    draft = run.add_target(args[0], "test")
    given = group_by_keyword(args[1:], _TEST_OPTIONS)
    sources = given[""]
    if call.name.startswith("add_rostest"):
        sources = [item for item in sources if not item.endswith((".test", ".launch", ".xml"))]
    add_sources(run, draft, sources)
    add_links(run, draft, split_words(given.get("DEPENDENCIES", [])), "order")


@handles(
    "add_rostest",
    "catkin_add_nosetests",
    "rosbuild_add_rostest",
    "rosbuild_add_pyunit",
    "roslaunch_add_file_check",
    least=1,
)
def add_catkin_test(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Tests that are launch files or Python: a test target named after the file."""
    refuse_unguarded(run, call)
    item = args[0]
    name = f"{run.package}_{item.replace('/', '_')}"
    draft = run.ensure_target(wrap(name, item.at, item.conditions), "test", item.at)
    add_sources(run, draft, [item])
    given = group_by_keyword(args[1:], _TEST_OPTIONS)
    add_links(run, draft, split_words(given.get("DEPENDENCIES", [])), "order")


@handles("catkin_download_test_data", "catkin_download", least=1)
def add_download(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """catkin_download_test_data(): a custom target, and the file that it fetches."""
    run.ensure_target(args[0], "custom", args[0].at)
    given = group_by_keyword(args[1:], frozenset({"DESTINATION", "FILENAME", "MD5"}))
    for folder in given.get("DESTINATION", []):
        for name in given.get("FILENAME", []) or [wrap(posixpath.basename(args[-1]), call.at)]:
            note_made(run, run.resolve(posixpath.join(folder, name)))


@handles("catkin_add_env_hooks", "catkin_add_env_hooks_", "rosbuild_init", "rosbuild_genmsg", "rosbuild_gensrv")
def run_minor_command(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Commands that set destinations or nothing at all."""
    if call.name == "rosbuild_init" and not run.project:
        at = At(call.path, call.at.line, call.at.column)
        run.assign(run.scope, "PROJECT_NAME", CMakeValue((wrap(run.package, at),)))
        run.project = run.package
    elif call.name in ("rosbuild_genmsg", "rosbuild_gensrv") and not run.silent:
        kind = call.name[-3:]
        relative = run.make_relative(run.resolve(kind))
        files = tuple(sorted(run.glob(f"{relative}/*.{kind}", False))) if relative is not None else ()
        target = f"ROSBUILD_gen{kind}_cpp"
        run.generated.append(GeneratedInterfaces("catkin", target, files, (), run.locate(call.at), run.conditions))
        run.ensure_target(target, "generated", call.at)
