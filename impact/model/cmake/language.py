"""Commands of the language itself: variables, lists, strings, paths, files, includes."""

import itertools
import posixpath

from .blocks import CommandCall
from .build import FoundPackage
from .conditions import make_version_key
from .interpreter import BREAK, CONTINUE, FATAL, RETURN, Interpreter, handles
from .lists import list_items, may_be_set_elsewhere, parse_int
from .names import MODULES, MODULES_WITH, ONLY_NEW, make_name_set
from .standard import note_variable
from .targets import note_written
from .values import (
    UNSET,
    CMakeValue,
    Word,
    add_conditions,
    find_next,
    find_position,
    make_unsure,
    split_list,
    split_words,
    wrap,
)


@handles("set", least=1)
def set_(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """set(): normal, parent scope, cache and environment variables."""
    name = str(args[0])
    values = args[1:]
    if name.startswith("ENV{"):
        run.assign(run.environment, name[4:].rstrip("}"), CMakeValue(tuple(values[:1])))
        return
    if "CACHE" in values:
        index = find_position(values, "CACHE")
        kind = values[index + 1] if index + 1 < len(values) else ""
        fixed = kind == "INTERNAL" or "FORCE" in values[index + 1 :]
        kept = CMakeValue(add_conditions(split_words(values[:index]), run.conditions))
        note_variable(run, name, kept.text, args[0])
        if fixed:
            run.scope.pop(name, None)
        run.assign(run.cache, name, kept if fixed else make_unsure(kept))
        return
    if run.get(name) is None and not name.startswith("CMAKE_") and not may_be_set_elsewhere(run, name):
        values = [value for value in values if value != f"${{{name}}}"]  # a list that begins with itself begins empty
    if values and values[-1] == "PARENT_SCOPE":
        values = values[:-1]
        where = run.scopes[-2] if len(run.scopes) > 1 else {}
        items = add_conditions(list_items(values), run.conditions)
        run.assign(where, name, CMakeValue(items, all(item.sure for item in items)) if items else UNSET)
        return
    if not values:
        run.assign(run.scope, name, UNSET)
        return
    run.set(name, list_items(values))
    note_variable(run, name, run.scope[name].text, args[0])


@handles("unset", least=1)
def unset(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """unset()."""
    name = str(args[0])
    if name.startswith("ENV{"):
        return
    if "CACHE" in args[1:]:
        run.assign(run.cache, name, UNSET)
    elif "PARENT_SCOPE" in args[1:]:
        if len(run.scopes) > 1:
            run.assign(run.scopes[-2], name, UNSET)
    else:
        run.assign(run.scope, name, UNSET)


@handles("option", "cmake_dependent_option", least=1)
def run_option(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """option(): the default is remembered, but a user may choose otherwise."""
    default = args[2] if len(args) > 2 else wrap("OFF", call.at)
    if run.scope.get(args[0]) is None:
        run.assign(run.cache, str(args[0]), make_unsure(CMakeValue((wrap(str(default), call.at),))))


@handles("include", least=1)
def include(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """include() of a file of the tree, of a module on CMAKE_MODULE_PATH, or of one of CMake's own."""
    name = args[0]
    optional = "OPTIONAL" in args[1:]
    answer = find_next(args, "RESULT_VARIABLE")
    if answer is not None:
        run.set_unknown(answer, call.at)
    if "/" not in name and not name.startswith("${"):
        held = run.get("CMAKE_MODULE_PATH")
        for directory in held.words if held is not None else ():
            path = run.make_relative(run.resolve(posixpath.join(directory, f"{name}.cmake"))) if directory else None
            if path is not None and run.run_file(path, call.at) is not None:
                return
        add_module(run, str(name))
        if not optional:
            run.use_feature(str(name), name.at)
            run.use_dropped(str(name), name.at)
        if name in MODULES:
            if name.startswith("Find") and not name.startswith("FindPackage"):
                place = run.locate(name.at)
                run.add_found(
                    FoundPackage(name.removeprefix("Find"), "find_package", place, conditions=run.merge_with(name))
                )
            return
    if name.endswith("_USE_FILE}") or name.startswith("$ENV{ROS_ROOT}/core/rosbuild/"):
        return  # settings of a found package, or rosbuild itself, whose macros are known
    path = run.make_relative(run.resolve(name))
    if path is None:
        if not optional:
            run.add_read(path, call.name, name)
            run.give_up(name.at, f"include({run.clean(name)}) is outside the tree")
        return
    if run.run_file(path, name.at) is not None:
        if not optional and not run.is_in_package(path):
            run.add_read(path, call.name, name)
        return
    installed = run.find_exported_file(name)
    if (installed is None or run.run_file(installed, name.at) is None) and not optional:
        run.add_read(path, call.name, name)
        run.give_up(name.at, f"include({run.clean(name)}) is not in the tree")


def add_module(run: Interpreter, name: str) -> None:
    """Notes that a module of CMake is loaded."""
    run.modules.add(name)
    run.modules.update(MODULES_WITH.get(name, ()))


@handles("include_guard")
def include_guard(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """include_guard()."""
    if call.path in run.guarded:
        return RETURN
    run.guarded.add(call.path)
    return 0


@handles("add_subdirectory", "subdirs")
def add_subdirectory(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """add_subdirectory()."""
    for directory in args if call.name == "subdirs" else args[:1]:
        relative = run.make_relative(run.resolve(directory))
        if relative is None:
            run.add_read(relative, call.name, directory)
            run.give_up(directory.at, f"add_subdirectory({run.clean(directory)}) is outside the tree")
            continue
        policies = run.minimum_policy, dict(run.policies)
        signal = run.run_file(posixpath.join(relative, "CMakeLists.txt"), directory.at, relative)
        run.minimum_policy, run.policies = policies
        if signal is None or not run.is_in_package(f"{relative}/"):
            run.add_read(relative, call.name, directory)
        if signal is None:
            run.give_up(directory.at, f"add_subdirectory({run.clean(directory)}) has no CMakeLists.txt in the tree")
        elif signal == FATAL:
            return FATAL
    return 0


@handles("return")
def return_(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """return(), with PROPAGATE."""
    if args and args[0] == "PROPAGATE" and len(run.scopes) > 1:
        for name in args[1:]:
            value = run.scope.get(name)
            run.assign(run.scopes[-2], str(name), value if value is not None else UNSET)
    return RETURN


@handles("break")
def break_(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """break()."""
    return BREAK


@handles("continue")
def continue_(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """continue()."""
    return CONTINUE


@handles("message")
def run_message(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """message(): FATAL_ERROR ends the run."""
    if not args or args[0] != "FATAL_ERROR":
        return 0
    if not run.silent and run.is_in_package(call.path) and run.conditions:
        run.stops.append((run.locate(call.at), "".join(args[1:])[:80], run.conditions))
    return FATAL


@handles("cmake_minimum_required", least=2)
def require_cmake_version(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """require_cmake_version(): also sets policies."""
    if args[0].upper() != "VERSION":
        return
    lower, _, upper = args[1].partition("...")
    if not run.silent and (run.minimum is None or (run.is_in_package(call.path) and call.path == run.minimum[1].path)):
        run.minimum = (str(args[1]), run.locate(args[1].at))
    else:
        run.use_policy("policies", str(args[1]), args[1].at)
    run.minimum_policy = make_version_key(upper or lower)


@handles("cmake_policy")
def set_cmake_policy(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """cmake_policy(VERSION) and cmake_policy(SET)."""
    if len(args) >= 2 and args[0] == "VERSION":
        run.use_policy("policies", str(args[1]), args[1].at)
        run.minimum_policy = max(run.minimum_policy, make_version_key(args[1].split("...")[-1]))
    elif args[:1] == ["SET"] and len(args) > 1:
        run.use_feature(str(args[1]), args[1].at)
        run.policies[str(args[1])] = str(args[2]) if len(args) > 2 and not run.conditions else ""
        if args[2:3] == ["OLD"] and args[1] in ONLY_NEW:
            run.use_policy("old policy", str(args[1]), args[1].at)
    if args[:2] == ["SET", "CMP0054"] and args[2:3] == ["NEW"]:
        run.minimum_policy = max(run.minimum_policy, (3, 1))
    if args[:2] == ["SET", "CMP0048"]:
        run.versions_projects = True


@handles("project", least=1)
def run_project(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """project()."""
    name = args[0]
    directory = run.scope["CMAKE_CURRENT_SOURCE_DIR"]
    binary = run.scope["CMAKE_CURRENT_BINARY_DIR"]
    if not run.project and not run.silent:
        run.project = str(name)
        run.assign(run.scope, "CMAKE_PROJECT_NAME", CMakeValue((name,)))
    values = {
        "PROJECT_NAME": CMakeValue((wrap(str(name), name.at),)),
        "PROJECT_SOURCE_DIR": directory,
        "PROJECT_BINARY_DIR": binary,
        f"{name}_SOURCE_DIR": directory,
        f"{name}_BINARY_DIR": binary,
    }
    version = find_next(args, "VERSION")
    if version is not None and run.minimum_policy < (3,) and not run.versions_projects:
        run.refuse("version", name)  # CMP0048
    if version is not None:
        values["PROJECT_VERSION"] = values[f"{name}_VERSION"] = CMakeValue((version,), version.sure)
        for part, number in zip(("MAJOR", "MINOR", "PATCH", "TWEAK"), version.split("."), strict=False):
            values[f"PROJECT_VERSION_{part}"] = CMakeValue((wrap(number, version.at),))
            values[f"{name}_VERSION_{part}"] = values[f"PROJECT_VERSION_{part}"]
    for key, value in values.items():
        run.assign(run.scope, key, value)


@handles("cmake_parse_arguments")
def parse_cmake_arguments(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """parse_cmake_arguments() in both signatures."""
    if args and args[0] == "PARSE_ARGV":
        if len(args) < 6:
            return
        first = parse_int(args[1]) or 0
        held = run.get("ARGV")
        given = list(held.words[first:]) if held is not None else []
        prefix, heads = str(args[2]), args[3:6]
    else:
        if len(args) < 4:
            return
        prefix, heads = str(args[0]), args[1:4]
        given = split_words(args[4:])
    options, singles, multiples = (set(split_list(head)) for head in heads)
    keywords = options | singles | multiples
    values: dict[str, list[Word]] = {}
    unparsed: list[Word] = []
    missing: list[Word] = []
    current = ""
    for item in given:
        if item in keywords:
            if current in singles and not values[current]:
                missing.append(wrap(current, item.at))
            current = str(item)
            values.setdefault(current, [])
            if current in options:
                values[current] = [item]
                current = ""
        elif current in singles:
            values[current] = [item]
            current = ""
        elif current:
            values[current].append(item)
        else:
            unparsed.append(item)
    scope = run.scope
    for name in keywords:
        found = values.get(name)
        if name in options:
            state = CMakeValue((wrap("TRUE" if found else "FALSE", call.at),))
        else:
            state = CMakeValue(tuple(found), all(item.sure for item in found)) if found else UNSET
        run.assign(scope, f"{prefix}_{name}", state)
    run.assign(scope, f"{prefix}_UNPARSED_ARGUMENTS", CMakeValue(tuple(unparsed)) if unparsed else UNSET)
    run.assign(scope, f"{prefix}_KEYWORDS_MISSING_VALUES", CMakeValue(tuple(missing)) if missing else UNSET)


@handles("execute_process", "exec_program", "try_compile", "try_run")
def execute_process(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Commands that run something: what they answer is not known."""
    if call.name in ("try_compile", "try_run"):
        for name in args[:1]:
            run.set_unknown(name, call.at)
    folder = next((str(name) for keyword, name in itertools.pairwise(args) if keyword == "WORKING_DIRECTORY"), "")
    for keyword, name in itertools.pairwise(args):
        if keyword in _ANSWERS:
            run.set_unknown(name, call.at)
        else:
            note_written(run, name, folder if folder.startswith("/") else "")
    begins = [0] if call.name == "exec_program" else [place + 1 for place, word in enumerate(args) if word == "COMMAND"]
    for begin in begins:
        for item in args[begin : begin + 2]:  # a program, or what runs a script and the script
            path = run.make_relative(posixpath.join(folder, item)) if f"{folder}{item}".startswith("/") else None
            if path and run.exists(path):
                run.starts[path] = None
        if call.name == "execute_process" and "OUTPUT_VARIABLE" not in args and not _is_cmake(args[begin:]):
            run.starts.update(dict.fromkeys(map(str, args[begin : begin + 1])))


def _is_cmake(command: list[Word]) -> bool:
    """Whether a command is one of CMake's own tools, of which is known what they write."""
    return command[:1] in (["cmake"], ["${CMAKE_COMMAND}"]) and command[1:2] == ["-E"]


_ANSWERS = make_name_set(
    """
    RESULT_VARIABLE OUTPUT_VARIABLE ERROR_VARIABLE RESULTS_VARIABLE RETURN_VALUE RUN_OUTPUT_VARIABLE
    """
)


@handles(
    "check_cxx_compiler_flag",
    "check_c_compiler_flag",
    "check_cxx_source_compiles",
    "check_c_source_compiles",
    "check_cxx_source_runs",
    "check_c_source_runs",
    "check_function_exists",
    "check_include_file",
    "check_include_file_cxx",
    "check_include_files",
    "check_symbol_exists",
    "check_cxx_symbol_exists",
    "check_library_exists",
    "check_type_size",
    "check_variable_exists",
    "check_compiler_flag",
    "check_linker_flag",
    "check_struct_has_member",
    "check_ipo_supported",
    "processorcount",
    "test_big_endian",
)
def check(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Compiler checks: the answer is in a variable, and is not known."""
    if call.name in ("processorcount", "test_big_endian"):
        names = args[:1]
    elif call.name == "check_ipo_supported":
        names = [name for keyword, name in itertools.pairwise(args) if keyword in ("RESULT", "OUTPUT")]
    elif call.name in ("check_include_file", "check_include_file_cxx"):
        names = args[1:2]
    else:
        names = args[-1:]
    for name in names:
        run.set_unknown(str(name), call.at)


@handles(
    "get_property",
    "get_target_property",
    "get_directory_property",
    "get_source_file_property",
    "get_cmake_property",
    least=2,
)
def get_property(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """Properties: those set in the tree are known, all others not."""
    key = _make_property_key(call.name, args)
    held = run.properties.get(key)
    if held is not None:
        run.assign(run.scope, str(args[0]), make_unsure(held))
    else:
        run.set_unknown(args[0], call.at)


def _make_property_key(command: str, args: list[Word]) -> str:
    """Where a property is kept: its scope, its owner and its name."""
    if command == "get_property" and "PROPERTY" in args[:-1]:
        index = find_position(args, "PROPERTY")
        return " ".join([*args[1:index], args[index + 1]])
    if command == "get_target_property" and len(args) >= 3:
        return f"TARGET {args[1]} {args[2]}"
    return " ".join(["?", *args[1:]])


@handles("cmake_language")
def run_cmake_language(run: Interpreter, call: CommandCall, args: list[Word]) -> int:
    """cmake_language(CALL name ...)."""
    if len(args) >= 2 and args[0] == "CALL":
        from ...facts.cmake import CMakeArgument, Command

        given = tuple(
            CMakeArgument(template.raw, '"' if template.quoted else "", template.at.line, template.at.column)
            for template in call.templates[2:]
        )
        return run.run_call(
            CommandCall(Command(args[1].lower(), given, call.at.line, call.at.column, call.at.line), call.path)
        )
    if args and args[0] in ("EVAL", "DEFER"):
        run.give_up(call.at, f"cmake_language({args[0]}) is not followed")
    return 0
