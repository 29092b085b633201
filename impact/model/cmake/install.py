"""What is installed."""

import re
from itertools import pairwise

from ....edges.groups import group_pairs
from ...facts.condition import Condition
from .blocks import CommandCall
from .interpreter import Interpreter, handles
from .names import make_name_set
from .values import Word, find_next, merge, split_words

_ARTIFACTS = make_name_set(
    """
    ARCHIVE LIBRARY RUNTIME OBJECTS FRAMEWORK BUNDLE PRIVATE_HEADER PUBLIC_HEADER RESOURCE
    """
)
_KEYWORDS = make_name_set(
    """
    DESTINATION PERMISSIONS CONFIGURATIONS COMPONENT RENAME OPTIONAL EXCLUDE_FROM_ALL EXPORT TYPE FILE_PERMISSIONS
    DIRECTORY_PERMISSIONS USE_SOURCE_PERMISSIONS MESSAGE_NEVER FILES_MATCHING PATTERN REGEX EXCLUDE NAMELINK_ONLY
    NAMELINK_SKIP NAMELINK_COMPONENT INCLUDES RUNTIME_DEPENDENCIES RUNTIME_DEPENDENCY_SET FILE_SET NAMESPACE FILE
    CXX_MODULES_BMI CXX_MODULES_DIRECTORY EXPORT_LINK_INTERFACE_LIBRARIES
    """
)
_OF_ITEMS = make_name_set("TARGETS FILES PROGRAMS")
"""Forms of install() with which CMake does nothing where no item is given: nothing that they read is missed."""
# cmake-commands(7), install(), "TYPE": where each type goes.
_TYPES = {
    "BIN": "bin",
    "SBIN": "sbin",
    "LIB": "lib",
    "INCLUDE": "include",
    "SYSCONF": "etc",
    "SHAREDSTATE": "com",
    "LOCALSTATE": "var",
    "RUNSTATE": "var/run",
    "DATA": "share",
    "INFO": "share/info",
    "LOCALE": "share/locale",
    "MAN": "share/man",
    "DOC": "share/doc",
    "LIBEXEC": "libexec",
}
_CONFIGURATION = re.compile(r"(?:-config|Config)\.cmake\Z")
_OF_CATKIN_PACKAGE = re.compile(r"\$\{(CATKIN_PACKAGE_[A-Z]+_DESTINATION)\}")


@handles("install", least=1)
def install(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """install() of targets, files, programs, folders and exports. Scripts and code are not followed."""
    if run.silent:
        return
    form = args[0]
    if form in _OF_ITEMS and (len(args) == 1 or args[1] in _KEYWORDS or args[1] in _ARTIFACTS):
        places = {run.locate(template.at) for template in call.templates}
        run.uses = {use: None for use in run.uses if use.at not in places}
        return
    if not run.catkin_destinations:
        for name in _OF_CATKIN_PACKAGE.findall(" ".join(argument.text for argument in call.arguments)):
            run.use_variable(name, call.at)
    if form in ("TARGETS", "IMPORTED_RUNTIME_ARTIFACTS"):
        _install_targets(run, call, args[1:])
    elif form in ("FILES", "PROGRAMS"):
        _install_files(run, call, form.lower(), args[1:])
    elif form == "DIRECTORY":
        _install_directory(run, call, args[1:])
    elif form == "EXPORT" and len(args) > 1:
        destination = find_next(args, "DESTINATION") or ""
        space = str(find_next(args, "NAMESPACE") or "")
        run.add_install("export", (str(args[1]),), run.clean(destination), args[1], namespace=space)


@handles("install_targets", "install_files", "install_programs")
def run_old_install(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """install_targets() and kin, as CMake had them before install()."""
    if len(args) > 1:
        kind = call.name.partition("_")[2]
        items = [str(item) if kind == "targets" else run.resolve_tree_path(item) for item in args[1:]]
        run.add_install(kind, items, run.clean(args[0].lstrip("/")), call)


def _install_targets(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    names: list[Word] = []
    destinations: dict[str, str] = {}
    artifact = ""
    expecting = ""
    in_names = True
    export = ""
    includes: list[str] = []
    for item in args:
        if item == "TARGETS":  # written again, it begins the same list
            in_names = True
            continue
        if in_names and item not in _KEYWORDS and item not in _ARTIFACTS:
            names.append(item)
            continue
        in_names = False
        if item in _ARTIFACTS:
            artifact = str(item)
            expecting = ""
        elif item in _KEYWORDS:
            expecting = str(item)
            if item == "INCLUDES":
                artifact = "INCLUDES"
        elif expecting == "DESTINATION" and artifact == "INCLUDES":
            includes.append(run.clean(item))
        elif expecting == "DESTINATION":
            destinations[artifact] = run.clean(item)  # of several, the last
            expecting = ""
        elif expecting == "EXPORT":
            export = str(item)
            expecting = ""
    fallback = destinations.get("", "")
    rules: dict[tuple[str, tuple[Condition, ...]], list[Word]] = {}
    for name in split_words(names):
        draft = run.targets.get(name)
        form = draft.installed_as if draft is not None else ""
        if form in ("executable", "test"):
            destination = destinations.get("RUNTIME", fallback or "bin")
        elif form == "static":
            destination = destinations.get("ARCHIVE", fallback or "lib")
        elif form in ("library", "module"):
            destination = destinations.get("LIBRARY") or fallback or destinations.get("ARCHIVE", "lib")
        elif form == "interface":
            destination = fallback or destinations.get("LIBRARY") or destinations.get("ARCHIVE", "")
        else:
            destination = fallback or destinations.get("LIBRARY") or destinations.get("RUNTIME", "")
        rules.setdefault((destination, run.merge_with(name)), []).append(name)
    for (destination, conditions), members in rules.items():
        more = {"conditions": conditions, "export": export, "includes": tuple(includes)}
        run.add_install("targets", map(str, members), destination, members[0], **more)


def _install_files(run: Interpreter, call: CommandCall, kind: str, args: list[Word]) -> None:
    items: list[Word] = []
    for item in args:
        if item in _KEYWORDS:
            break
        items.append(item)
    if kind == "files" and "PERMISSIONS" in args and any(item.endswith("_EXECUTE") for item in args):
        kind = "programs"
    destination, optional = _resolve_destination(run, call, args), "OPTIONAL" in args
    for conditions, members in group_pairs((item.conditions, item) for item in split_words(items)).items():
        more = {"conditions": merge(run.conditions, conditions), "rename": run.clean(find_next(args, "RENAME") or "")}
        more["optional"], more["guessed"] = optional, _is_guessed(args)
        paths = tuple(map(run.resolve_tree_path, members))
        for path in paths:
            if _CONFIGURATION.search(path):
                run.hand_on(path, call.at, whole=True)
        run.add_install(kind, paths, destination, members[0] if len(members) == 1 else call, **more)


def _resolve_destination(run: Interpreter, call: CommandCall, args: list[Word]) -> str:
    """Where files go, the last of several: empty where the call surely does not say so, at which CMake stops."""
    given = [folder for keyword, folder in pairwise(args) if keyword == "DESTINATION"]
    destination = run.clean(given[-1] if given else "") or _TYPES.get(find_next(args, "TYPE") or "", "")
    return destination or ("${DESTINATION}" if any("$" in argument.text for argument in call.arguments) else "")


def _is_guessed(args: list[Word]) -> bool:
    """Whether where files go rests on a value that is not known, or that differs between branches."""
    given = [folder for keyword, folder in pairwise(args) if keyword == "DESTINATION"]
    return bool(given) and not given[-1].sure


def _install_directory(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    items: list[Word] = []
    patterns: list[str] = []
    mode = ""
    in_items = True
    for item in args:
        if item in _KEYWORDS:
            in_items = False
            mode = str(item)
            if item == "EXCLUDE" and patterns:
                patterns[-1] = f"!{patterns[-1]}"
        elif in_items:
            items.append(item)
        elif mode in ("PATTERN", "REGEX"):
            patterns.append(f"~{item}" if mode == "REGEX" else str(item))
            mode = ""
    paths = tuple(run.resolve_tree_path(item) for item in split_words(items))
    executable = "USE_SOURCE_PERMISSIONS" in args or any(item.endswith("_EXECUTE") for item in args)
    more = {"patterns": tuple(patterns), "only": "FILES_MATCHING" in args, "executable": executable}
    more["optional"], more["guessed"] = "OPTIONAL" in args, _is_guessed(args)
    run.add_install("directory", paths, _resolve_destination(run, call, args), call, **more)
