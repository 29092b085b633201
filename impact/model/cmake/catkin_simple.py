"""catkin_simple, which finds what package.xml declares, and builds, installs and exports by convention.

Source: the README and the macros of catkin_simple 0.1.1.
"""

from ...facts.cmake import CMakeArgument, Command
from .blocks import CommandCall
from .build import FoundPackage
from .catkin import add_interface_files, generate_dynamic_reconfigure_options, generate_messages, run_catkin_package
from .find import find_package, set_catkin_destinations
from .interpreter import Interpreter, stands_in_for
from .names import make_name_set, split_names
from .targets import add_executable, add_library, add_links, include_directories, resolve_target
from .values import CMakeValue, Word, group_by_keyword, split_words, wrap

_LEFT_OUT = frozenset({"NO_AUTO_LINK", "NO_AUTO_DEP", "NO_AUTO_EXPORT"})
_EXPORTED = make_name_set("INCLUDE_DIRS LIBRARIES CATKIN_DEPENDS DEPENDS CFG_EXTRAS")
_SHARED = split_names("launch rviz urdf meshes maps worlds Media param")
_GENERATED = {"action": "add_action_files", "msg": "add_message_files", "srv": "add_service_files"}


def _has_folder(run: Interpreter, name: str) -> bool:
    return bool(run.has_path(run.resolve(name)))


def _get_list(run: Interpreter, name: str) -> list[Word]:
    held = run.get(name)
    return list(held.words) if held is not None else []


def _make_call(call: CommandCall, name: str, argument: str = "") -> CommandCall:
    """A command that a macro calls, where the macro is called."""
    place = (call.at.line, call.at.column)
    arguments = (CMakeArgument(argument, "", *place),) if argument else ()
    return CommandCall(Command(name, arguments, *place, call.at.line), call.at.path)


@stands_in_for("catkin_simple")
def find_declared_packages(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """catkin_simple(): finds every build dependency, and makes the package's interfaces."""
    required = "ALL_DEPS_REQUIRED" in args
    project = run.installed_name
    found = [wrap(word, call.at) for word in ("catkin", "REQUIRED")]
    find_package(run, _make_call(call, "find_package", "catkin"), found)
    set_catkin_destinations(run, call, [])
    for name in run.declared.build:
        conditions = run.declared.add_condition(name, run.conditions)
        if name != "catkin":
            run.add_found(FoundPackage(name, "declared", run.locate(call.at), required, conditions=conditions))
            run.extend(name, call.at)
    if _has_folder(run, "include"):
        include_directories(run, call, [wrap("include", call.at)])
    if "message_generation" in run.declared.build:
        folders = [folder for folder in _GENERATED if _has_folder(run, folder)]
        if any(run.resolve_tree_path(wrap(folder, call.at)) in run.made for folder in _GENERATED):
            run.give_up(call.at, "catkin_simple(): a program makes the interfaces")
        for folder in folders:
            add_interface_files(run, _make_call(call, _GENERATED[folder]), [])
        if folders:
            names = [wrap(name, call.at) for name in run.declared.build if name != "message_generation"]
            generate_messages(run, call, [wrap("DEPENDENCIES", call.at), *names])
    if "dynamic_reconfigure" in run.declared.build and _has_folder(run, "cfg"):
        relative = run.make_relative(run.resolve("cfg"))
        files = run.glob(f"{relative}/*.cfg", False) if relative is not None else []
        generate_dynamic_reconfigure_options(run, call, [wrap(run.make_absolute(file), call.at) for file in files])
    for name in ("TARGETS", "LIBRARIES"):
        run.assign(run.scope, f"{project}_{name}", CMakeValue(()))


@stands_in_for("cs_add_executable", "cs_add_library", least=1)
def add_simple_target(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """cs_add_executable() and cs_add_library(): what is found is linked, and installed by cs_install()."""
    name, library = args[0], call.name == "cs_add_library"
    plain = _make_call(call, call.name.removeprefix("cs_"))
    (add_library if library else add_executable)(run, plain, [item for item in args if item not in _LEFT_OUT])
    draft = resolve_target(run, name)
    if "NO_AUTO_LINK" not in args:
        add_links(run, draft, [wrap("${catkin_LIBRARIES}", call.at)], "link")
    if "NO_AUTO_DEP" not in args:
        order = ("${catkin_EXPORTED_TARGETS}", f"${{{run.installed_name}_EXPORTED_TARGETS}}")
        add_links(run, draft, [wrap(target, call.at) for target in order], "order")
    kept = ("TARGETS", "LIBRARIES") if library and "NO_AUTO_EXPORT" not in args else ("TARGETS",)
    for each in kept:
        variable = f"{run.installed_name}_{each}"
        run.assign(run.scope, variable, CMakeValue((*_get_list(run, variable), name)))


@stands_in_for("cs_install")
def install_simple_targets(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """cs_install(): targets, headers and the folders that are called as shared content is."""
    project = run.installed_name
    for name in (*_get_list(run, f"{project}_TARGETS"), *split_words(args)):
        made = run.targets.get(name)
        destination = f"lib/{project}" if made is not None and made.kind == "executable" else "lib"
        run.add_install("targets", (str(name),), destination, call)
    if _has_folder(run, "include"):
        headers = (run.resolve_tree_path(wrap("include/", call.at)),)
        run.add_install("directory", headers, "include", call, patterns=("*.h", "*.hpp"), only=True)
    for folder in _SHARED:
        if _has_folder(run, folder):
            held = (run.resolve_tree_path(wrap(f"{folder}/", call.at)),)
            run.add_install("directory", held, f"share/{project}/{folder}", call)


@stands_in_for("cs_install_scripts")
def install_simple_scripts(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """cs_install_scripts(): programs beside the executables."""
    for item in split_words(args):
        run.add_install("programs", (run.resolve_tree_path(item),), f"lib/{run.installed_name}", item)


@stands_in_for("cs_export")
def export_simple_package(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """cs_export(): catkin_package() with the libraries, the include folder and what is declared to run."""
    given = {keyword: list(items) for keyword, items in group_by_keyword(args, _EXPORTED).items()}
    given["LIBRARIES"] = [*_get_list(run, f"{run.installed_name}_LIBRARIES"), *given.get("LIBRARIES", [])]
    if _has_folder(run, "include"):
        given["INCLUDE_DIRS"] = [wrap("include", call.at), *given.get("INCLUDE_DIRS", [])]
    words = [word for key, items in given.items() if key and items for word in (wrap(key, call.at), *items)]
    run_catkin_package(run, call, words)
