"""Commands over paths and files: what they answer comes from the tree alone."""

import itertools
import posixpath

from .blocks import CommandCall
from .interpreter import Interpreter, handles
from .targets import note_made
from .values import MAX_WORDS, UNSET, CMakeValue, Word, find_next, find_position, wrap


@handles("get_filename_component", least=3)
def get_filename_component(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """get_filename_component()."""
    name, path, mode = args[0], args[1], str(args[2])
    text = str(path)
    base = posixpath.basename(text.rstrip("/"))
    if mode in ("DIRECTORY", "PATH"):
        result = posixpath.dirname(text.rstrip("/"))
    elif mode == "NAME":
        result = base
    elif mode == "EXT":
        result = base[base.find(".") :] if "." in base else ""
    elif mode == "LAST_EXT":
        result = posixpath.splitext(base)[1]
    elif mode == "NAME_WE":
        result = base[: base.find(".")] if "." in base else base
    elif mode == "NAME_WLE":
        result = posixpath.splitext(base)[0]
    elif mode in ("ABSOLUTE", "REALPATH"):
        start = find_next(args, "BASE_DIR")
        result = run.resolve(text, str(start) if start is not None else None)
    else:
        result = None
    run.set_text(str(name), result, path.at, path.sure)


@handles("cmake_path", least=2)
def run_cmake_path(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """run_cmake_path(), the forms that scripts use."""
    action, name, rest = str(args[0]), str(args[1]), args[2:]
    if action == "SET":
        rest = [item for item in rest if item != "NORMALIZE"]
        if rest:
            text = posixpath.normpath(rest[0]) if "NORMALIZE" in args else str(rest[0])
            run.assign(
                run.scope, name, CMakeValue((wrap(text, rest[0].at, run.conditions, rest[0].sure),), rest[0].sure)
            )
        return
    held = run.get(name)
    if held is None and action in ("APPEND", "APPEND_STRING"):
        held = UNSET
    output = name
    if "OUTPUT_VARIABLE" in rest:
        index = find_position(rest, "OUTPUT_VARIABLE")
        output = str(rest[index + 1]) if index + 1 < len(rest) else name
        rest = rest[:index] + rest[index + 2 :]
    text = held.text if held is not None else ""
    base = posixpath.basename(text)
    dot = base.rfind(".") if "LAST_ONLY" in rest else base.find(".", 1)
    stem = base[:dot] if dot > 0 else base
    if action == "GET" and len(rest) >= 2:
        result = {
            "FILENAME": base,
            "PARENT_PATH": posixpath.dirname(text),
            "EXTENSION": base[len(stem) :],
            "STEM": stem,
            "RELATIVE_PART": text.lstrip("/"),
            "ROOT_PATH": "/" if text.startswith("/") else "",
            "ROOT_NAME": "",
            "ROOT_DIRECTORY": "/" if text.startswith("/") else "",
        }.get(rest[0])
        output = str(rest[-1])
    elif action in ("APPEND", "APPEND_STRING"):
        result = posixpath.join(text, *rest) if action == "APPEND" else text + "".join(rest)
    elif action == "NORMAL_PATH":
        result = posixpath.normpath(text) if text else ""
    elif action == "ABSOLUTE_PATH":
        start = find_next(rest, "BASE_DIRECTORY")
        result = run.resolve(text, str(start) if start is not None else None)
    elif action == "REMOVE_FILENAME":
        result = text[: len(text) - len(base)]
    elif action == "REPLACE_FILENAME" and rest:
        result = text[: len(text) - len(base)] + rest[0]
    elif action in ("REMOVE_EXTENSION", "REPLACE_EXTENSION"):
        suffix = rest[-1] if action == "REPLACE_EXTENSION" and rest else ""
        suffix = f".{suffix}" if suffix and not suffix.startswith(".") else suffix
        result = text[: len(text) - len(base)] + stem + suffix
    else:
        result = None
        output = str(rest[-1]) if rest else name
    run.set_text(output, None if held is None else result, call.at, held is not None and held.sure)


@handles("file", least=2)
def run_file_command(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """file(): GLOB is answered from the tree, paths are computed, everything else is not known."""
    action, rest = str(args[0]).upper(), args[1:]
    if action in ("GLOB", "GLOB_RECURSE"):
        _run_glob(run, call, action == "GLOB_RECURSE", rest)
    elif action == "RELATIVE_PATH" and len(rest) == 3:
        known = rest[1].startswith("/") and rest[2].startswith("/")
        result = posixpath.relpath(rest[2], rest[1]) if known else str(rest[2])
        run.set_text(rest[0], "" if result == "." else result, call.at, known)
    elif action in ("TO_CMAKE_PATH", "TO_NATIVE_PATH") and len(rest) == 2:
        run.set(rest[1], [rest[0]])
    elif action == "REAL_PATH" and len(rest) >= 2:
        run.set_text(rest[1], run.resolve(rest[0]), call.at, rest[0].sure)
    elif action in ("WRITE", "APPEND", "TOUCH", "DOWNLOAD", "MAKE_DIRECTORY", "GENERATE", "COPY", "INSTALL"):
        _write(run, action, rest)
    elif action in ("READ", "STRINGS", "TIMESTAMP", "SIZE", "READ_SYMLINK", "MD5", "SHA1", "SHA256") and len(rest) >= 2:
        run.set_unknown(rest[1], call.at)


def _write(run: Interpreter, action: str, rest: list[Word]) -> None:
    """The forms of file() that write into the tree."""
    if action in ("TOUCH", "MAKE_DIRECTORY"):
        written = rest
    elif action in ("GENERATE", "COPY", "INSTALL"):
        written = [item for keyword, item in itertools.pairwise(rest) if keyword in ("OUTPUT", "DESTINATION")]
    else:
        written = rest[1:2] if action == "DOWNLOAD" else rest[:1]
    for item in written:
        note_made(run, run.resolve(item), folder=action in ("MAKE_DIRECTORY", "COPY", "INSTALL"))


def _run_glob(run: Interpreter, call: CommandCall, recursive: bool, rest: list[Word]) -> None:
    """file(GLOB) and file(GLOB_RECURSE)."""
    name, rest = rest[0], rest[1:]
    start = ""
    patterns: list[Word] = []
    index = 0
    while index < len(rest):
        item = rest[index]
        if item == "RELATIVE" and index + 1 < len(rest):
            start = run.resolve(rest[index + 1])
            index += 1
        elif item == "LIST_DIRECTORIES" and index + 1 < len(rest):
            index += 1
        elif item not in ("FOLLOW_SYMLINKS", "CONFIGURE_DEPENDS"):
            patterns.append(item)
        index += 1
    hits: list[Word] = []
    run.spend(20 * len(patterns))
    for pattern in patterns:
        relative = run.make_relative(run.resolve(pattern))
        if relative is None:
            run.give_up(pattern.at, f"file(GLOB) outside the tree: {run.clean(pattern)}")
            continue
        for path in sorted(run.glob(relative, recursive))[: MAX_WORDS - len(hits)]:
            full = run.make_absolute(path)
            hits.append(wrap(posixpath.relpath(full, start) if start else full, pattern.at))
    run.set(name, dict.fromkeys(hits))
    run.empty_globs.pop(str(name), None)
    if not hits and patterns and all(pattern.sure and "$" not in pattern for pattern in patterns):
        run.empty_globs[str(name)] = tuple(run.resolve_tree_path(pattern) for pattern in patterns)


@handles("aux_source_directory", least=2)
def list_source_directory(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """list_source_directory()."""
    relative = run.make_relative(run.resolve(args[0]))
    hits = [] if relative is None else run.glob(posixpath.join(relative, "*"), False)
    sources = [path for path in sorted(hits) if path.endswith((".c", ".C", ".cc", ".cpp", ".cxx", ".c++", ".m", ".mm"))]
    held = run.get(args[1])
    before = held.words if held is not None else ()
    run.set(args[1], (*before, *(wrap(run.make_absolute(path), args[0].at) for path in sources)))


@handles("configure_file", least=2)
def configure_file(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """configure_file(): a generated file."""
    value = run.scope.get("CMAKE_CURRENT_BINARY_DIR")
    note_made(run, run.resolve(args[1], value.text if value is not None else None))
