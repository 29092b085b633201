"""What is built: libraries, executables, custom targets, and what is given to them."""

import posixpath
import re

from ...conditions.cmake import parse_constant
from .blocks import CommandCall
from .build import GeneratedInterfaces, Link, RefusedName, is_for_tests
from .drafts import TargetDraft
from .genex import reduce_expression, rejoin
from .interpreter import BINARY, Interpreter, calls_unmodelled, handles
from .macros import note_flag, note_macro
from .names import make_name_set
from .standard import note_options, parse_feature_standard, parse_flag_standard
from .values import CMakeValue, Word, find_next, find_position, split_words, wrap

_LIBRARY_KINDS = {
    "STATIC": "library",
    "SHARED": "library",
    "OBJECT": "library",
    "UNKNOWN": "library",
    "MODULE": "module",
    "INTERFACE": "interface",
}
_LIBRARY_FLAGS = frozenset({"EXCLUDE_FROM_ALL", "IMPORTED", "GLOBAL", "WITH_SOABI", "THIN_LTO", "NO_EXTRAS", "SYSTEM"})


def makes_archives(run: Interpreter) -> bool:
    """Whether add_library() makes an archive where no type is given: unless BUILD_SHARED_LIBS is set, by the package or
    by what it finds, of which catkin and ament_cmake_ros are known to. Source: cmake-commands(7), add_library()."""
    found = {package.name for package in run.found}
    value = run.get("BUILD_SHARED_LIBS")
    if value is not None and parse_constant(value.text) is not False:
        return False
    return not found.isdisjoint(_AMENT) and found.isdisjoint(_SHARING)


_AMENT = frozenset({"ament_cmake", "ament_cmake_auto"})
_SHARING = frozenset({"catkin", "ament_cmake_ros", "ament_cmake_ros_core"})


@handles("add_library", "cuda_add_library", "rosbuild_add_library", "python_add_library", "python3_add_library",
         "pybind11_add_module", "pybind_add_module", "python_add_module", "ament_python_add_module",
         least=1)  # fmt: skip
def add_library(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_library() in all its signatures, and the modules' variants of it."""
    if _is_alias(run, args):
        return
    name, rest = args[0], args[1:]
    kind = "module" if call.name not in ("add_library", "cuda_add_library", "rosbuild_add_library") else "library"
    form = ""
    sources: list[Word] = []
    for item in rest:
        if item in _LIBRARY_KINDS and not sources:
            form = str(item)
            kind = _LIBRARY_KINDS[item]
        elif item not in _LIBRARY_FLAGS:
            sources.append(item)
    if "IMPORTED" in rest:
        kind = "imported"
    draft = run.add_target(name, kind)
    if form in ("STATIC", "OBJECT"):
        draft.installed_as = "static"
    draft.archive = draft.installed_as == "static" or (kind == "library" and not form and makes_archives(run))
    draft.excluded = "EXCLUDE_FROM_ALL" in rest
    add_sources(run, draft, sources)
    if kind in ("library", "module"):
        note_sourceless(run, call, name, sources)


@handles("add_executable", "cuda_add_executable", "rosbuild_add_executable", "qt_add_executable", "qt5_add_executable",
         least=1)  # fmt: skip
def add_executable(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_executable() in all its signatures."""
    if _is_alias(run, args):
        return
    name, rest = args[0], args[1:]
    draft = run.add_target(name, "imported" if rest[:1] == ["IMPORTED"] else "executable")
    draft.excluded = "EXCLUDE_FROM_ALL" in rest
    sources = [item for item in rest if item not in ("WIN32", "MACOSX_BUNDLE", *_LIBRARY_FLAGS)]
    add_sources(run, draft, sources)
    note_sourceless(run, call, name, sources)


def note_sourceless(run: Interpreter, call: CommandCall, name: Word, sources: list[Word]) -> None:
    """Refuses a target all of whose sources are of a file(GLOB) that finds none, or of a variable that some branches
    leave empty."""
    variables = [template.raw[2:-1] for template in call.templates[1:] if template.raw.startswith("${")]
    if sources:
        held = run.get(variables[0]) if len(variables) == 1 else None
        known = held is not None and all(value is None or value.sure for _, value in held.left)
        if held is not None and known and len(sources) == len(held.words):
            empty = [conditions for conditions, value in held.left if value is None or not value.words]
            paths = [run.resolve_tree_path(source) for source in sources]
            set_elsewhere = any(use.kind == "command" and variables[0] in use.makes for use in run.uses)
            if empty and "$" not in held.text and not set_elsewhere:
                run.refuse("branch sources", name, patterns=paths, ways=empty)
        return
    patterns = [pattern for variable in variables for pattern in run.empty_globs.get(variable, ())]
    if patterns and len(variables) == sum(variable in run.empty_globs for variable in variables):
        run.refuse("no sources", name, patterns=patterns)


def _is_alias(run: Interpreter, args: list[Word]) -> bool:
    """Makes the target of `add_...(name ALIAS other)`; False for any other signature."""
    if len(args) < 3 or args[1] != "ALIAS":
        return False
    run.ensure_target(args[0], "alias", args[0].at).alias_of = str(args[2])
    return True


def add_sources(run: Interpreter, draft: TargetDraft, items: list[Word]) -> None:
    """Gives sources to a target, as paths relative to the workspace root where they can be known."""
    current = run.get("CMAKE_INCLUDE_CURRENT_DIR")
    if items and current is not None and parse_constant(current.text):
        run.include_dirs[(run.resolve_tree_path("."), run.locate(items[0].at))] = None
    for item in rejoin(items):
        for part in reduce_expression(item):
            if part.startswith("$<TARGET_OBJECTS"):
                objects = wrap(part.partition(":")[2].rstrip(">"), part.at, part.conditions, part.sure)
                add_links(run, draft, [objects], "objects")
            elif part:
                path = run.resolve_tree_path(part)
                tried = (path + ending for ending in _ENDINGS if "." not in posixpath.basename(path))
                draft.add_source(next(filter(run.exists, tried), path), run.merge_with(part))


# What CMake adds to the name of a source that does not exist, as far as it is code of C or C++.
_ENDINGS = (".c", ".C", ".c++", ".cc", ".cpp", ".cxx", ".cu", ".h", ".hh", ".hpp")


@handles("target_sources", least=1)
def add_target_sources(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_target_sources(), FILE_SET forms included: the base folders of a set of headers are searched."""
    draft = resolve_target(run, args[0])
    check_scope(run, draft, args)
    kept: list[Word] = []
    searched: list[Word] = []
    section = scope = ""
    for item in args[1:]:
        if item in ("PUBLIC", "PRIVATE", "INTERFACE"):
            section, scope = "", item
        elif item in ("FILE_SET", "TYPE", "BASE_DIRS"):
            section = str(item)
        elif item == "FILES":
            section = ""
        elif not section:
            kept.append(item)
        elif section == "BASE_DIRS":
            searched.extend([scope, item] if scope else [item])
    add_sources(run, draft, kept)
    if "FILE_SET" in args and "CXX_MODULES" not in args:
        folder = wrap(run.scope["CMAKE_CURRENT_SOURCE_DIR"].text, args[0].at)
        add_links(run, draft, searched if "BASE_DIRS" in args else [folder], "include")


@handles("target_precompile_headers", least=2)
def add_precompiled_headers(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """target_precompile_headers(): the headers of the tree are compiled like sources; `<vector>` is of the compiler."""
    draft = resolve_target(run, args[0])
    check_scope(run, draft, args)
    if args[1] != "REUSE_FROM":
        add_sources(run, draft, [item for item in args[1:] if item not in _SCOPES and item[:1] not in ("<", '"')])


def check_scope(run: Interpreter, draft: TargetDraft, args: list[Word]) -> None:
    """Refuses a call that gives a target something without PUBLIC, PRIVATE or INTERFACE."""
    items = [item for item in args[1:4] if item not in _INCLUDE_FLAGS or run.command != "target_include_directories"]
    if items and items[0] not in (*_SCOPES, "REUSE_FROM") and "$" not in items[0] and draft.kind != "unknown":
        run.refuse("no scope", items[0])


def resolve_target(run: Interpreter, name: Word) -> TargetDraft:
    """The target of this name; one that nothing makes is noted as unknown."""
    draft = run.targets.get(name)
    followed = run.targets.get(draft.alias_of) if draft is not None and draft.kind == "alias" else None
    if followed is not None and followed.kind != "alias":
        draft = followed
    if draft is not None:
        note_branches(run, draft, name)
        return draft
    typesupport = run.is_typesupport(name)
    known = typesupport or name in run.maybe_set or name in run.maybe_made or "::" in name
    known = known or (run.command == "add_dependencies" and _may_be_made_along(run, name))
    for_tests = is_for_tests(run.merge_with(name))
    if not known and not _is_asked_for(run, name) and not calls_unmodelled(run, for_tests):
        run.refuse("no target", name)
    return run.ensure_target(name, "generated" if typesupport else "unknown", name.at)


# What catkin, rosbuild, genmsg and ament add beside what they are asked for. Sources: catkin's cmake/all.cmake and
# cmake/test/tests.cmake, rosbuild's public.cmake, genmsg's pkg-genmsg.cmake.em, ament_cmake_python.
MADE_ALONG = re.compile(
    r"tests?|_?run_tests(?:_[\w.+-]+)?|clean_test_results(?:_[\w.+-]+)?|download_extra_data|doxygen|ros(?:build|pack)_\w+|"
    r"\w+_generate_messages(?:_\w+)?|_\w+_check_deps_\w+|ament_cmake_python_\w+|uninstall"
)


def _may_be_made_along(run: Interpreter, name: Word) -> bool:
    """Whether a command that is given no such name may add a target: one of these, or, where what a command does is not
    known, one that is called after the project."""
    return MADE_ALONG.fullmatch(name) is not None or (run.installed_name in name and calls_unmodelled(run))


def note_branches(run: Interpreter, draft: TargetDraft, name: Word) -> None:
    """Notes a target that is used where only other branches make it."""
    here = run.merge_with(name)
    made_here = any(set(way).issubset(here) for way in draft.ways)
    if draft.ways and not made_here and name.sure and not run.silent and not _is_asked_for(run, name):
        run.refused[RefusedName("branch", draft.name, run.locate(name.at), here, draft.ways)] = None


def _is_asked_for(run: Interpreter, name: Word) -> bool:
    """Whether a place stands under if(TARGET name)."""
    there = re.compile(rf"(?<!NOT )TARGET {re.escape(name)}(?!\S)")
    return any(there.search(held.text) and not held.negated for held in run.merge_with(name))


# The folders of the prefix that those who link a target search; spaces stand where a list was split.
_INSTALLED = re.compile(r"\$<INSTALL_INTERFACE:([^<>]*)>")
_VISIBILITY = {
    "PUBLIC": "PUBLIC",
    "PRIVATE": "PRIVATE",
    "INTERFACE": "INTERFACE",
    "LINK_PUBLIC": "PUBLIC",
    "LINK_PRIVATE": "PRIVATE",
    "LINK_INTERFACE_LIBRARIES": "INTERFACE",
}
_LINK_FLAGS = frozenset({"debug", "optimized", "general"})
_INCLUDE_FLAGS = frozenset({"SYSTEM", "BEFORE", "AFTER"})
_SCOPES = frozenset({"PUBLIC", "PRIVATE", "INTERFACE"})


def add_links(run: Interpreter, draft: TargetDraft, items: list[Word], how: str, visibility: str = "") -> None:
    """Gives items to a target, generator expressions reduced."""
    if run.silent:
        return
    for item in rejoin(items):
        if item in _VISIBILITY:
            visibility = _VISIBILITY[item]
            continue
        for part in reduce_expression(item):
            if part:
                text = run.resolve_tree_path(part) if how == "include" else run.clean(part)
                draft.links[Link(text, how, run.locate(part.at), visibility, run.merge_with(part))] = None


@handles("target_link_libraries", "swig_link_libraries", least=1)
def link_target_libraries(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """link_target_libraries(), old and new keywords."""
    items = split_words(item for item in args[1:] if item not in _LINK_FLAGS)
    draft = resolve_target(run, args[0])
    note_signature(run, draft, args)
    add_links(run, draft, items, "link")


def note_signature(run: Interpreter, draft: TargetDraft, args: list[Word]) -> None:
    """Remembers which signature of link_target_libraries() a call has, and refuses what has both (CMP0023). A variable
    that is not known may hold a keyword."""
    if len(args) < 2 or run.silent or run.minimum_policy < (2, 8, 12) or not args[0].sure:
        return
    keyword = args[1] in ("PUBLIC", "PRIVATE", "INTERFACE")
    if not keyword and (not args[1].sure or "$" in args[1]) and not re.fullmatch(r"\$\{\w+_LIBRARIES\}", args[1]):
        return
    other = draft.signatures.get(not keyword)
    opposite = {(held.text, not held.negated) for held in other or ()}
    if other is not None and not any((held.text, held.negated) in opposite for held in run.merge_with(args[0])):
        run.refuse("mixed", args[0], other)
    draft.signatures.setdefault(keyword, run.merge_with(args[0]))


@handles("target_include_directories", least=1)
def add_target_includes(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_target_includes()."""
    items = split_words(item for item in args[1:] if item not in _INCLUDE_FLAGS)
    draft = resolve_target(run, args[0])
    check_scope(run, draft, args)
    add_links(run, draft, items, "include")
    for found in _INSTALLED.findall(" ".join(items)):
        draft.installed_includes.update(dict.fromkeys(run.clean(folder) for folder in found.split()))


@handles("include_directories")
def include_directories(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """include_directories()."""
    for item in rejoin(split_words(args)):
        if item in _INCLUDE_FLAGS or run.silent:
            continue
        for part in reduce_expression(item):
            run.include_dirs[(run.resolve_tree_path(part), run.locate(part.at))] = None


@handles("link_libraries")
def link_libraries(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """link_libraries(): for every target that follows."""
    for item in rejoin(split_words(args)):
        if item in _LINK_FLAGS or run.silent:
            continue
        for part in reduce_expression(item):
            run.links[Link(run.clean(part), "link", run.locate(part.at), "", run.merge_with(part))] = None


@handles("rosbuild_link_boost", "target_link_boost", least=1)
def link_boost(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """rosbuild_link_boost(): Boost libraries by component."""
    items = [wrap(f"Boost::{item}", item.at, item.conditions, item.sure) for item in split_words(args[1:])]
    add_links(run, resolve_target(run, args[0]), items, "link")


@handles("add_dependencies", least=1)
def add_dependencies(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_dependencies()."""
    add_links(run, resolve_target(run, args[0]), split_words(args[1:]), "order")


_DEVEL = "${CATKIN_DEVEL_PREFIX}"


def note_made(run: Interpreter, path: str, *, folder: bool = False) -> None:
    """Remembers a file, or a folder, that configuring or building writes into the tree or the build folder, in which
    catkin's devel space lies."""
    if path.startswith(_DEVEL):
        path = f"{BINARY}/devel{path[len(_DEVEL) :]}"
    place = run.make_relative(path) or (run.clean(path) if path.startswith(BINARY) else "")
    if place:
        run.made[f"{place}/" if folder else place] = None


def note_written(run: Interpreter, item: Word, folder: str = "") -> None:
    """Remembers an argument of a program, or a word of one for a shell, that names a path of the tree which does not
    exist: the program makes it. folder: where the program runs, as an absolute path; a relative name of a file is one
    of it."""
    for word in [item, *(wrap(each, item.at) for each in item.split())] if " " in item else [item]:
        if folder and _FILE.fullmatch(word):
            word = wrap(posixpath.join(folder, word), item.at)
        path = run.make_relative(word) if word.startswith("/") else None
        if path and not run.has_path(word):
            run.made[path] = run.made[f"{path}/"] = None


_FILE = re.compile(r"(?![-./])[\w./+-]+\.[A-Za-z]\w*")


@handles("add_custom_command")
def add_custom_command(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_custom_command(): its outputs are made by the build. What is not absolute lies in the build folder, but where
    the command runs in the source folder its outputs are often written as if they lay there too."""
    section = ""
    for item in args:
        if item in _OF_CUSTOM_COMMANDS:
            section = str(item)
        elif section in ("OUTPUT", "BYPRODUCTS"):
            note_made(run, run.resolve(item))
            if not item.startswith("/"):
                note_made(run, run.resolve(item, run.scope["CMAKE_CURRENT_BINARY_DIR"].text))
        else:
            note_written(run, item)


_OF_CUSTOM_COMMANDS = make_name_set(
    """
    OUTPUT BYPRODUCTS COMMAND MAIN_DEPENDENCY DEPENDS IMPLICIT_DEPENDS WORKING_DIRECTORY COMMENT DEPFILE JOB_POOL
    VERBATIM APPEND USES_TERMINAL COMMAND_EXPAND_LISTS TARGET PRE_BUILD PRE_LINK POST_BUILD ARGS
    """
)


@handles("add_custom_target", least=1)
def add_custom_target(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_custom_target(): its SOURCES are shown by editors, and not compiled."""
    draft = run.add_target(args[0], "custom")
    section = ""
    for item in args[1:]:
        if item in ("DEPENDS", "SOURCES", "BYPRODUCTS"):
            section = str(item)
        elif item in ("COMMAND", "WORKING_DIRECTORY", "COMMENT", "ALL", "VERBATIM", "USES_TERMINAL"):
            section = ""
        elif section == "BYPRODUCTS":
            note_made(run, run.resolve(item))
        elif section == "DEPENDS" and "/" not in item and "." not in item:
            add_links(run, draft, [item], "order")
        elif section != "SOURCES":
            note_written(run, item)


@handles("target_compile_definitions", least=1)
def add_target_definitions(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_target_definitions()."""
    draft = resolve_target(run, args[0])
    check_scope(run, draft, args)
    for item in split_words(args[1:]):
        if item not in _VISIBILITY:
            draft.definitions[item[2:] if item.startswith("-D") else str(item)] = None
            note_macro(run, item, str(args[0]))


@handles("target_compile_options", "target_compile_features", least=1)
def add_target_options(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_target_options() and target_compile_features(), of which the C++ standard is kept."""
    draft = resolve_target(run, args[0])
    check_scope(run, draft, args)
    seen = "PUBLIC"
    for item in args[1:]:
        seen = str(item) if item in _VISIBILITY else seen
        run.open_flags = run.open_flags or "${" in item
        draft.standard = max(draft.standard, parse_flag_standard(item), parse_feature_standard(item))
        if seen != "PRIVATE":
            draft.public_standard = max(draft.public_standard, parse_feature_standard(item))


@handles("add_compile_options", "add_definitions")
def add_compile_options(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_compile_options() and add_definitions()."""
    note_options(run, args)
    for item in split_words(args):
        note_flag(run, item)


@handles("add_compile_definitions")
def add_compile_definitions(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_compile_definitions()."""
    for item in split_words(args):
        note_macro(run, item, "")


@handles("set_target_properties")
def set_target_properties(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """set_target_properties()."""
    if "PROPERTIES" in args:
        split = find_position(args, "PROPERTIES")
        pairs = args[split + 1 :]
        versions = {f"${{{run.project}_VERSION}}", "${PROJECT_VERSION}"}
        if not any(template.quoted for template in call.templates):
            for item in pairs[1::2]:
                if item in versions and run.get(item[2:-1]) is None:
                    run.refuse("no value", wrap(item, item.at, item.conditions))
        for name in split_words(args[:split]):
            for key, value in zip(pairs[::2], pairs[1::2], strict=False):
                set_target_property(run, name, key, value)


@handles("set_directory_properties")
def set_directory_properties(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """set_directory_properties(PROPERTIES key value ...)."""
    if "PROPERTIES" in args:
        pairs = args[find_position(args, "PROPERTIES") + 1 :]
        for key, value in zip(pairs[::2], pairs[1::2], strict=False):
            set_directory_property(run, key, [value])


def set_directory_property(run: Interpreter, key: str, values: list[Word]) -> None:
    """Keeps what a property of the folder gives to every target in it."""
    items = list(split_words(values))
    if key == "COMPILE_OPTIONS":
        note_options(run, items)
        for item in items:
            note_flag(run, item)
    elif key == "COMPILE_DEFINITIONS":
        for item in items:
            note_macro(run, item, "")
    elif key == "INCLUDE_DIRECTORIES" and not run.silent:
        for item in items:
            run.include_dirs[(run.resolve_tree_path(item), run.locate(item.at))] = None


@handles("set_property")
def set_property(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """set_property() on targets and folders; others are remembered for get_property()."""
    if "PROPERTY" not in args[:-1]:
        return
    split = find_position(args, "PROPERTY")
    key, values = args[split + 1], args[split + 2 :]
    owners = [item for item in args[1:split] if item not in ("APPEND", "APPEND_STRING")]
    if args[0] == "TARGET":
        for name in owners:
            for value in values[:1]:
                set_target_property(run, name, key, value)
            run.assign(run.properties, f"TARGET {name} {key}", CMakeValue(tuple(values)))
        return
    if args[0] == "DIRECTORY":
        set_directory_property(run, key, values)
    owner = " ".join([args[0], *owners[:1], key])
    if "APPEND" in args[:split] and owner in run.properties:
        values = [*run.properties[owner].words, *values]
    run.assign(run.properties, owner, CMakeValue(tuple(values)))


def set_target_property(run: Interpreter, name: Word, key: str, value: Word) -> None:
    """Keeps the properties that matter: the standard, the output name, compile flags, what is linked."""
    draft = run.targets.get(name)
    run.assign(run.properties, f"TARGET {name} {key}", CMakeValue((value,)))
    if draft is None:
        return
    if key == "CXX_STANDARD":
        if value.isdigit():
            draft.standard = max(draft.standard, int(value))
    elif key in ("COMPILE_FLAGS", "COMPILE_OPTIONS"):
        run.open_flags = run.open_flags or "${" in value
        draft.standard = max(draft.standard, parse_flag_standard(value))
    elif key in ("OUTPUT_NAME", "LIBRARY_OUTPUT_NAME", "RUNTIME_OUTPUT_NAME"):
        draft.output_name = str(value)
    elif key == "EXPORT_NAME":
        draft.export_name = str(value)
    elif key == "EXCLUDE_FROM_ALL":
        draft.excluded = value.upper() not in ("FALSE", "OFF", "0", "NO")
    elif key in ("INTERFACE_LINK_LIBRARIES", "LINK_LIBRARIES"):
        add_links(run, draft, list(split_words([value])), "link", "INTERFACE" if key.startswith("INTERFACE") else "")
    elif key == "INTERFACE_INCLUDE_DIRECTORIES":
        add_links(run, draft, list(split_words([value])), "include", "INTERFACE")


@handles("add_test")
def add_test(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """add_test() makes no target."""


@handles("generate_export_header", least=1)
def generate_export_header(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """generate_export_header(): a header in the build folder."""
    base = find_next(args, "EXPORT_FILE_NAME") or f"{args[0].lower()}_export.h"
    value = run.scope.get("CMAKE_CURRENT_BINARY_DIR")
    note_made(run, run.resolve(base, value.text if value is not None else None))


_QT_OPTIONS = frozenset({"OPTIONS", "TARGET", "DEPENDS"})


@handles("qt4_wrap_cpp", "qt5_wrap_cpp", "qt6_wrap_cpp", "qt_wrap_cpp", "qt4_wrap_ui", "qt5_wrap_ui", "qt6_wrap_ui",
         "qt_wrap_ui", "qt4_add_resources", "qt5_add_resources", "qt6_add_resources", "qt_add_resources",
         least=1)  # fmt: skip
def wrap_qt_files(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Qt's generators: the variable lists files of the build folder, named as Qt names them."""
    shape = {"cpp": "moc_{}.cpp", "ui": "ui_{}.h"}.get(call.name.rpartition("_")[2], "qrc_{}.cpp")
    binary = run.scope["CMAKE_CURRENT_BINARY_DIR"].text
    held = run.get(args[0])
    made = list(held.words) if held is not None else []
    for item in args[1:]:
        if item in _QT_OPTIONS:
            break
        base = item.rpartition("/")[2].rpartition(".")[0] or item.rpartition("/")[2]
        made.append(wrap(f"{binary}/{shape.format(base)}", item.at, item.conditions, item.sure))
    run.set(args[0], made)


@handles("protobuf_generate_cpp", "protobuf_generate_python")
def generate_protobuf_cpp(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """protobuf_generate_cpp(SRCS HDRS files...)."""
    outputs = 2 if call.name.endswith("cpp") else 1
    endings = (".pb.cc", ".pb.h") if outputs == 2 else ("_pb2.py",)
    files = [item for item in args[outputs:] if item.endswith(".proto")]
    binary = run.scope["CMAKE_CURRENT_BINARY_DIR"].text
    for name, ending in zip(args[:outputs], endings, strict=False):
        made = [wrap(f"{binary}/{item.rpartition('/')[2][:-6]}{ending}", item.at) for item in files]
        run.set(name, made)
    if files and not run.silent:
        paths = tuple(run.resolve_tree_path(item) for item in files)
        run.generated.append(GeneratedInterfaces("protobuf", "", paths, (), run.locate(call.at), run.conditions))


@handles("protobuf_generate")
def generate_protobuf(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """protobuf_generate(TARGET t PROTOS files...)."""
    target = str(find_next(args, "TARGET") or "")
    files = tuple(run.resolve_tree_path(item) for item in args if item.endswith(".proto"))
    if not run.silent:
        run.generated.append(GeneratedInterfaces("protobuf", target, files, (), run.locate(call.at), run.conditions))
