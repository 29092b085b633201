"""Commands of the language itself: variables, lists, strings, paths, files, includes."""

from __future__ import annotations

import itertools
import posixpath
import re

from .blocks import Call
from .conditions import version_key
from .interpreter import BREAK, CONTINUE, FATAL, RETURN, Interpreter, handles
from .names import MODULES, MODULES_WITH, name_set
from .regex import REGEX_STEPS, usable
from .standard import note_variable
from .values import (
    MAX_TEXT,
    MAX_WORDS,
    UNSET,
    Value,
    Word,
    following,
    position,
    split_list,
    split_words,
    unsure,
    with_conditions,
    word,
)


@handles("set")
def set_(run: Interpreter, call: Call, args: list[Word]) -> None:
    """set(): normal, parent scope, cache and environment variables."""
    if not args:
        return
    name = str(args[0])
    values = args[1:]
    if name.startswith("ENV{"):
        run.assign(run.environment, name[4:].rstrip("}"), Value(tuple(values[:1])))
        return
    if "CACHE" in values:
        index = position(values, "CACHE")
        kind = values[index + 1] if index + 1 < len(values) else ""
        fixed = kind == "INTERNAL" or "FORCE" in values[index + 1 :]
        kept = Value(with_conditions(split_words(values[:index]), run.conditions))
        note_variable(run, name, kept.text, args[0])
        if fixed:
            run.scope.pop(name, None)
        run.assign(run.cache, name, kept if fixed else unsure(kept))
        return
    if values and values[-1] == "PARENT_SCOPE":
        values = values[:-1]
        where = run.scopes[-2] if len(run.scopes) > 1 else {}
        items = with_conditions(_items(values), run.conditions)
        run.assign(where, name, Value(items, all(item.sure for item in items)) if items else UNSET)
        return
    if not values:
        if any(template.kind for template in call.templates[1:]):  # set(X ${EMPTY}) gives an unset variable as well
            run.assign(run.scope, name, UNSET)
        else:
            run.assign(run.scope, name, UNSET)
        return
    run.set(name, _items(values))
    note_variable(run, name, run.scope[name].text, args[0])


def _items(values: list[Word]) -> list[Word]:
    """List items of a value, empty ones kept when there is nothing else."""
    if len(values) == 1 and ";" not in values[0]:
        return values
    items: list[Word] = []
    for value in values:
        if ";" in value:
            items.extend(value.parts or [word(part, value.at, value.conditions, value.sure) for part in _raw(value)])
        else:
            items.append(value)
    return items


def _raw(text: str) -> list[str]:
    """List items with escaped semicolons left as they are."""
    return split_list(text) if "\\;" not in text else re.split(r"(?<!\\);", text)


@handles("unset")
def unset(run: Interpreter, call: Call, args: list[Word]) -> None:
    """unset()."""
    if not args:
        return
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


@handles("option", "cmake_dependent_option")
def option(run: Interpreter, call: Call, args: list[Word]) -> None:
    """option(): the default is remembered, but a user may choose otherwise."""
    if not args:
        return
    default = args[2] if len(args) > 2 else word("OFF", call.at)
    if run.scope.get(args[0]) is None:
        run.assign(run.cache, str(args[0]), unsure(Value((word(str(default), call.at),))))


@handles("list")
def list_(run: Interpreter, call: Call, args: list[Word]) -> None:
    """list()."""
    if len(args) < 2:
        return
    action, name, rest = str(args[0]).upper(), str(args[1]), args[2:]
    held = run.get(name)
    if held is not None:
        run.spend(len(held.words) >> 5)
    if action in ("APPEND", "PREPEND", "INSERT"):
        index = 0
        if action == "INSERT" and rest:
            index = _integer(rest[0]) or 0
            rest = rest[1:]
        added = with_conditions(split_words(rest), run.conditions)
        if held is None:
            before: tuple[Word, ...] = ()
            sure = True
            if name.startswith("CMAKE_"):
                sure = False
        else:
            before = tuple(item for item in held.words if item)
            sure = held.sure
        words = before + added if action == "APPEND" else before[:index] + added + before[index:]
        if len(words) > MAX_WORDS:
            run.give_up(call.at, f"`{name}` has more than {MAX_WORDS} items")
            words = words[:MAX_WORDS]
        run.assign(run.scope, name, Value(words, sure and all(item.sure for item in added)))
        note_variable(run, name, ";".join(added), args[1])
        return
    if held is None:
        held = UNSET if run.lookup("", name) is None else Value(())
        known = False
    else:
        known = held.sure
    words = tuple(item for item in held.words if item or len(held.words) > 1)
    if action == "LENGTH" and rest:
        if known:
            run.set_text(rest[0], str(len(words)), call.at)
        else:
            run.set_unknown(rest[0], call.at)
    elif action == "GET" and len(rest) >= 2:
        chosen = [_at(words, index) for index in rest[:-1]]
        if known and all(item is not None for item in chosen):
            run.set(rest[-1], [item for item in chosen if item is not None])
        else:
            run.set_unknown(rest[-1], call.at)
    elif action in ("POP_BACK", "POP_FRONT"):
        back = action == "POP_BACK"
        left = list(words)
        for variable in rest or [None]:
            item = (left.pop() if back else left.pop(0)) if left else None
            if variable is not None:
                run.assign(run.scope, str(variable), Value((item,), known) if item is not None else UNSET)
        run.assign(run.scope, name, Value(tuple(left), known))
    elif action == "FIND" and len(rest) == 2:
        if known:
            run.set_text(rest[1], str(words.index(rest[0]) if rest[0] in words else -1), call.at)
        else:
            run.set_unknown(rest[1], call.at)
    elif action == "JOIN" and len(rest) == 2:
        run.set_text(rest[1], str(rest[0]).join(words), call.at, known)
    elif action == "SUBLIST" and len(rest) == 3:
        start, length = _integer(rest[0]), _integer(rest[1])
        if start is None or length is None:
            run.set_unknown(rest[2], call.at)
        else:
            run.set(rest[2], words[start:] if length < 0 else words[start : start + length], known)
    elif action == "REMOVE_ITEM":
        gone = set(split_words(rest))
        _store(run, name, [item for item in words if item not in gone], known)
    elif action == "REMOVE_AT":
        gone_at = {index if index >= 0 else len(words) + index for index in map(_integer, rest) if index is not None}
        _store(run, name, [item for index, item in enumerate(words) if index not in gone_at], known)
    elif action == "REMOVE_DUPLICATES":
        _store(run, name, list(dict.fromkeys(words)), known)
    elif action == "REVERSE":
        _store(run, name, list(reversed(words)), known)
    elif action == "SORT":
        _store(run, name, sorted(words, reverse="DESCENDING" in rest), known)
    elif action == "FILTER" and len(rest) == 3:
        kept: list[Word] = []
        run.spend(REGEX_STEPS * len(words) >> 2)
        for item in words:
            pattern = usable(rest[2], item)
            hit = pattern.search(item) is not None if pattern is not None else rest[0] == "INCLUDE"
            if hit == (rest[0] == "INCLUDE"):
                kept.append(item)
        _store(run, name, kept, known)
    elif action == "TRANSFORM" and rest:
        _transform(run, name, words, rest, known)


def _store(run: Interpreter, name: str, words: list[Word], known: bool) -> None:
    """Writes a changed list back; items keep the conditions they had."""
    run.assign(run.scope, name, Value(tuple(words), known))


def _at(words: tuple[Word, ...], index: Word) -> Word | None:
    number = _integer(index)
    return words[number] if number is not None and -len(words) <= number < len(words) else None


def _integer(text: str) -> int | None:
    try:
        return int(text)
    except ValueError:
        return None


def _transform(run: Interpreter, name: str, words: tuple[Word, ...], rest: list[Word], known: bool) -> None:
    """list(TRANSFORM)."""
    action = rest[0]
    output = name
    if "OUTPUT_VARIABLE" in rest:
        index = position(rest, "OUTPUT_VARIABLE")
        output = str(rest[index + 1]) if index + 1 < len(rest) else name
        rest = rest[:index]
    operands = {"APPEND": 1, "PREPEND": 1, "REPLACE": 2}.get(action, 0)
    selector = rest[1 + operands :]
    chosen: object = None
    pattern_text = ""
    if selector[:1] == ["REGEX"] and len(selector) > 1:
        pattern_text = selector[1]
    elif selector[:1] == ["AT"]:
        chosen = {index % len(words) if words else 0 for index in map(_integer, selector[1:]) if index is not None}
    elif selector:
        run.set_unknown(output, rest[0].at)
        return
    made: list[Word] = []
    if pattern_text or action == "REPLACE":
        run.spend(REGEX_STEPS * len(words) >> 2)
    for index, item in enumerate(words):
        if isinstance(chosen, set) and index not in chosen:
            made.append(item)
            continue
        if pattern_text:
            pattern = usable(pattern_text, item)
            if pattern is None or not pattern.search(item):
                made.append(item)
                continue
        text: str = item
        if action == "APPEND" and len(rest) > 1:
            text = item + rest[1]
        elif action == "PREPEND" and len(rest) > 1:
            text = rest[1] + item
        elif action == "TOLOWER":
            text = item.lower()
        elif action == "TOUPPER":
            text = item.upper()
        elif action == "STRIP":
            text = item.strip()
        elif action == "REPLACE" and len(rest) > 2:
            text = _regex_replace(rest[1], rest[2], item) or item
        made.append(word(text, item.at, item.conditions, item.sure))
    run.assign(run.scope, output, Value(tuple(made), known))


@handles("string")
def string(run: Interpreter, call: Call, args: list[Word]) -> None:
    """string()."""
    if len(args) < 2:
        return
    action, rest = str(args[0]).upper(), args[1:]
    sure = all(item.sure for item in rest)
    at = call.at

    def put(name: str, text: str | None) -> None:
        if text is None:
            run.set_unknown(name, at)
        else:
            run.set(
                name,
                [word(part, at, (), sure) for part in _raw(text[:MAX_TEXT])]
                if ";" in text
                else [word(text[:MAX_TEXT], at, (), sure)],
            )

    if action in ("TOLOWER", "TOUPPER") and len(rest) == 2:
        put(rest[1], rest[0].lower() if action == "TOLOWER" else rest[0].upper())
    elif action in ("APPEND", "PREPEND"):
        held = run.get(rest[0])
        old = held.text if held is not None else ""
        added = "".join(rest[1:])
        sure = sure and (held is None or held.sure)
        put(rest[0], old + added if action == "APPEND" else added + old)
        note_variable(run, rest[0], added, rest[0])
    elif action == "CONCAT":
        put(rest[0], "".join(rest[1:]))
    elif action == "JOIN" and len(rest) >= 2:
        put(rest[1], str(rest[0]).join(rest[2:]))
    elif action == "STRIP" and len(rest) == 2:
        put(rest[1], rest[0].strip())
    elif action == "LENGTH" and len(rest) == 2:
        put(rest[1], str(len(rest[0].encode())))
    elif action == "REPLACE" and len(rest) >= 4:
        put(rest[2], "".join(rest[3:]).replace(rest[0], rest[1]) if rest[0] else None)
    elif action == "SUBSTRING" and len(rest) == 4:
        begin, length = _integer(rest[1]), _integer(rest[2])
        known = begin is not None and length is not None
        put(rest[3], (rest[0][begin:] if length < 0 else rest[0][begin : begin + length]) if known else None)  # type: ignore[operator]
    elif action == "FIND" and len(rest) >= 3:
        put(rest[2], str(rest[0].rfind(rest[1]) if "REVERSE" in rest[3:] else rest[0].find(rest[1])))
    elif action == "REPEAT" and len(rest) == 3:
        count = _integer(rest[1])
        put(rest[2], rest[0] * count if count is not None and 0 <= count * len(rest[0]) <= MAX_TEXT else None)
    elif action == "COMPARE" and len(rest) == 4:
        order = {
            "EQUAL": rest[1] == rest[2],
            "NOTEQUAL": rest[1] != rest[2],
            "LESS": str(rest[1]) < str(rest[2]),
            "GREATER": str(rest[1]) > str(rest[2]),
            "LESS_EQUAL": str(rest[1]) <= str(rest[2]),
            "GREATER_EQUAL": str(rest[1]) >= str(rest[2]),
        }.get(rest[0])
        put(rest[3], None if order is None or not sure else ("1" if order else "0"))
    elif action == "MAKE_C_IDENTIFIER" and len(rest) == 2:
        made = re.sub(r"[^A-Za-z0-9_]", "_", rest[0])
        put(rest[1], f"_{made}" if made[:1].isdigit() else made)
    elif action == "GENEX_STRIP" and len(rest) == 2:
        put(rest[1], re.sub(r"\$<[^<>]*>", "", rest[0]))
    elif action == "REGEX" and len(rest) >= 4:
        _regex(run, rest, sure, put)
    elif action in ("MD5", "SHA1", "SHA256", "RANDOM", "TIMESTAMP", "UUID", "CONFIGURE", "JSON", "HEX", "ASCII"):
        target = {"RANDOM": len(rest) - 1, "CONFIGURE": 1, "ASCII": len(rest) - 1, "HEX": 1, "MD5": 0}.get(action, 0)
        if 0 <= target < len(rest):
            run.set_unknown(rest[target], at)


def _regex(run: Interpreter, rest: list[Word], sure: bool, put) -> None:
    """string(REGEX MATCH | MATCHALL | REPLACE)."""
    run.spend(REGEX_STEPS)
    mode = rest[0]
    if mode == "REPLACE" and len(rest) >= 5:
        put(rest[3], _regex_replace(rest[1], rest[2], "".join(rest[4:])))
        return
    if mode not in ("MATCH", "MATCHALL"):
        return
    text = "".join(rest[3:])
    pattern = usable(rest[1], text)
    if pattern is None:
        put(rest[2], None)
    elif not sure:
        run.set_unknown(rest[2], rest[2].at)
    elif mode == "MATCH":
        found = pattern.search(text)
        if found:
            run.matched((found.group(), *(group or "" for group in found.groups())))
        put(rest[2], found.group() if found else "")
    else:
        put(rest[2], ";".join(found.group() for found in pattern.finditer(text)))


def _regex_replace(pattern_text: str, replacement: str, text: str) -> str | None:
    """The text with every match replaced, None when it cannot be told."""
    pattern = usable(pattern_text, text)
    if pattern is None:
        return None

    def expand(found: re.Match[str]) -> str:
        def group(reference: re.Match[str]) -> str:
            number = reference.group(1)
            if not number.isdigit():
                return "\n" if number == "n" else number
            return (found.group(int(number)) or "") if int(number) <= len(found.groups()) else ""

        return re.sub(r"\\(.)", group, replacement, flags=re.DOTALL)

    return pattern.sub(expand, text)


_MATH = re.compile(r"\s*(0[xX][0-9a-fA-F]{1,15}|\d{1,18}|<<|>>|[-+*/%|&^~()])")
_PRECEDENCE = {"|": 1, "^": 2, "&": 3, "<<": 4, ">>": 4, "+": 5, "-": 5, "*": 6, "/": 6, "%": 6}


@handles("math")
def math(run: Interpreter, call: Call, args: list[Word]) -> None:
    """math(EXPR)."""
    if len(args) < 3:
        return
    value = calculate(args[2]) if args[2].sure else None
    if value is None:
        run.set_unknown(args[1], call.at)
    else:
        run.set_text(args[1], hex(value) if "HEXADECIMAL" in args[3:] else str(value), call.at)


def calculate(text: str) -> int | None:
    """Value of a math(EXPR) text in 64 bit, None when it is malformed."""
    values: list[int] = []
    operators: list[str] = []
    position = 0
    want_value = True

    def apply() -> bool:
        operator = operators.pop()
        if operator.startswith("u"):
            if not values:
                return False
            values[-1] = {"u-": -values[-1], "u+": values[-1], "u~": ~values[-1]}[operator]
            return True
        if len(values) < 2:
            return False
        right, left = values.pop(), values.pop()
        if operator in "/%" and right == 0:
            return False
        if operator in ("<<", ">>") and not 0 <= right < 64:
            return False
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1) if operator in "/%" else 0
        result = {
            "|": lambda: left | right,
            "^": lambda: left ^ right,
            "&": lambda: left & right,
            "<<": lambda: left << right,
            ">>": lambda: left >> right,
            "+": lambda: left + right,
            "-": lambda: left - right,
            "*": lambda: left * right,
            "/": lambda: quotient,
            "%": lambda: left - quotient * right,
        }[operator]()
        values.append((result + 2**63) % 2**64 - 2**63)
        return True

    text = text.rstrip()
    if len(text) > 1000:
        return None
    while position < len(text):
        token = _MATH.match(text, position)
        if token is None:
            return None
        position = token.end()
        piece = token.group(1)
        if piece[0].isdigit():
            if not want_value:
                return None
            values.append(int(piece, 0) if piece[:2] in ("0x", "0X") else int(piece))
            want_value = False
        elif piece == "(":
            operators.append(piece)
        elif piece == ")":
            while operators and operators[-1] != "(":
                if not apply():
                    return None
            if not operators:
                return None
            operators.pop()
            want_value = False
        elif want_value:
            if piece not in "-+~":
                return None
            operators.append("u" + piece)
        else:
            while operators and operators[-1] != "(" and _PRECEDENCE.get(operators[-1], 9) >= _PRECEDENCE.get(piece, 0):
                if not apply():
                    return None
            if piece == "~":
                return None
            operators.append(piece)
            want_value = True
    while operators:
        if operators[-1] == "(" or not apply():
            return None
    return values[0] if len(values) == 1 else None


@handles("get_filename_component")
def get_filename_component(run: Interpreter, call: Call, args: list[Word]) -> None:
    """get_filename_component()."""
    if len(args) < 3:
        return
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
        start = following(args, "BASE_DIR")
        result = run.resolve(text, str(start) if start is not None else None)
    else:
        run.set_unknown(name, call.at)
        return
    run.assign(run.scope, str(name), Value((word(result, path.at, run.conditions, path.sure),), path.sure))


@handles("cmake_path")
def cmake_path(run: Interpreter, call: Call, args: list[Word]) -> None:
    """cmake_path(), the forms that scripts use."""
    if len(args) < 2:
        return
    action, name, rest = str(args[0]), str(args[1]), args[2:]
    if action == "SET":
        rest = [item for item in rest if item != "NORMALIZE"]
        if rest:
            text = posixpath.normpath(rest[0]) if "NORMALIZE" in args else str(rest[0])
            run.assign(run.scope, name, Value((word(text, rest[0].at, run.conditions, rest[0].sure),), rest[0].sure))
        return
    held = run.get(name)
    if held is None and action in ("APPEND", "APPEND_STRING"):
        held = UNSET
    output = name
    if "OUTPUT_VARIABLE" in rest:
        index = position(rest, "OUTPUT_VARIABLE")
        output = str(rest[index + 1]) if index + 1 < len(rest) else name
        rest = rest[:index] + rest[index + 2 :]
    text = held.text if held is not None else ""
    base = posixpath.basename(text)
    if action == "GET" and len(rest) >= 2:
        last = "LAST_ONLY" in rest
        stem_end = base.rfind(".") if last else base.find(".", 1)
        stem_end = stem_end if stem_end > 0 else len(base)
        result = {
            "FILENAME": base,
            "PARENT_PATH": posixpath.dirname(text),
            "EXTENSION": base[stem_end:],
            "STEM": base[:stem_end],
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
        start = following(rest, "BASE_DIRECTORY")
        result = run.resolve(text, str(start) if start is not None else None)
    elif action == "REMOVE_FILENAME":
        result = text[: len(text) - len(base)]
    elif action == "REPLACE_FILENAME" and rest:
        result = text[: len(text) - len(base)] + rest[0]
    elif action in ("REMOVE_EXTENSION", "REPLACE_EXTENSION"):
        stem_end = base.rfind(".") if "LAST_ONLY" in rest else base.find(".", 1)
        stem = base[:stem_end] if stem_end > 0 else base
        suffix = rest[-1] if action == "REPLACE_EXTENSION" and rest else ""
        suffix = f".{suffix}" if suffix and not suffix.startswith(".") else suffix
        result = text[: len(text) - len(base)] + stem + suffix
    else:
        result = None
        output = str(rest[-1]) if rest else name
    if result is None or held is None:
        run.set_unknown(output, call.at)
    else:
        run.assign(run.scope, output, Value((word(result, call.at, run.conditions, held.sure),), held.sure))


@handles("file")
def file(run: Interpreter, call: Call, args: list[Word]) -> None:
    """file(): GLOB is answered from the tree, paths are computed, everything else is not known."""
    if len(args) < 2:
        return
    action, rest = str(args[0]).upper(), args[1:]
    if action in ("GLOB", "GLOB_RECURSE"):
        _glob(run, call, action == "GLOB_RECURSE", rest)
    elif action == "RELATIVE_PATH" and len(rest) == 3:
        known = rest[1].startswith("/") and rest[2].startswith("/")
        result = posixpath.relpath(rest[2], rest[1]) if known else str(rest[2])
        run.set_text(rest[0], "" if result == "." else result, call.at, known)
    elif action in ("TO_CMAKE_PATH", "TO_NATIVE_PATH") and len(rest) == 2:
        run.set(rest[1], [rest[0]])
    elif action == "REAL_PATH" and len(rest) >= 2:
        run.set_text(rest[1], run.resolve(rest[0]), call.at, rest[0].sure)
    elif action in ("READ", "STRINGS", "TIMESTAMP", "SIZE", "READ_SYMLINK", "MD5", "SHA1", "SHA256") and len(rest) >= 2:
        run.set_unknown(rest[1], call.at)


def _glob(run: Interpreter, call: Call, recursive: bool, rest: list[Word]) -> None:
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
        relative = run.relative(run.resolve(pattern))
        if relative is None:
            run.give_up(pattern.at, f"file(GLOB) outside the tree: {run.shown(pattern)}")
            continue
        for path in sorted(run.glob(relative, recursive))[: MAX_WORDS - len(hits)]:
            full = run.absolute(path)
            hits.append(word(posixpath.relpath(full, start) if start else full, pattern.at))
    run.set(name, dict.fromkeys(hits))


@handles("aux_source_directory")
def aux_source_directory(run: Interpreter, call: Call, args: list[Word]) -> None:
    """aux_source_directory()."""
    if len(args) < 2:
        return
    relative = run.relative(run.resolve(args[0]))
    hits = [] if relative is None else run.glob(posixpath.join(relative, "*"), False)
    sources = [path for path in sorted(hits) if path.endswith((".c", ".C", ".cc", ".cpp", ".cxx", ".c++", ".m", ".mm"))]
    held = run.get(args[1])
    before = held.words if held is not None else ()
    run.set(args[1], (*before, *(word(run.absolute(path), args[0].at) for path in sources)))


@handles("include")
def include(run: Interpreter, call: Call, args: list[Word]) -> None:
    """include() of a file of the tree, of a module on CMAKE_MODULE_PATH, or of one of CMake's own."""
    if not args:
        return
    name = args[0]
    optional = "OPTIONAL" in args[1:]
    answer = following(args, "RESULT_VARIABLE")
    if answer is not None:
        run.set_unknown(answer, call.at)
    if "/" not in name and not name.startswith("${"):
        held = run.get("CMAKE_MODULE_PATH")
        for directory in held.words if held is not None else ():
            path = run.relative(run.resolve(posixpath.join(directory, f"{name}.cmake"))) if directory else None
            if path is not None and run.run_file(path, call.at) is not None:
                return
        add_module(run, str(name))
        if name in MODULES:
            return
    if name.endswith("_USE_FILE}") or name.startswith("$ENV{ROS_ROOT}/core/rosbuild/"):
        return  # settings of a found package, or rosbuild itself, whose macros are known
    path = run.relative(run.resolve(name))
    if path is None:
        if not optional:
            run.give_up(name.at, f"include({run.shown(name)}) is outside the tree")
        return
    if run.run_file(path, name.at) is not None:
        return
    installed = run.exported_file(name)
    if (installed is None or run.run_file(installed, name.at) is None) and not optional:
        run.give_up(name.at, f"include({run.shown(name)}) is not in the tree")


def add_module(run: Interpreter, name: str) -> None:
    """Notes that a module of CMake is loaded."""
    run.modules.add(name)
    run.modules.update(MODULES_WITH.get(name, ()))


@handles("include_guard")
def include_guard(run: Interpreter, call: Call, args: list[Word]) -> int:
    """include_guard()."""
    if call.path in run.guarded:
        return RETURN
    run.guarded.add(call.path)
    return 0


@handles("add_subdirectory", "subdirs")
def add_subdirectory(run: Interpreter, call: Call, args: list[Word]) -> int:
    """add_subdirectory()."""
    for directory in args if call.name == "subdirs" else args[:1]:
        relative = run.relative(run.resolve(directory))
        if relative is None:
            run.give_up(directory.at, f"add_subdirectory({run.shown(directory)}) is outside the tree")
            continue
        signal = run.run_file(posixpath.join(relative, "CMakeLists.txt"), directory.at, relative)
        if signal is None:
            run.give_up(directory.at, f"add_subdirectory({run.shown(directory)}) has no CMakeLists.txt in the tree")
        elif signal == FATAL:
            return FATAL
    return 0


@handles("return")
def return_(run: Interpreter, call: Call, args: list[Word]) -> int:
    """return(), with PROPAGATE."""
    if args and args[0] == "PROPAGATE" and len(run.scopes) > 1:
        for name in args[1:]:
            value = run.scope.get(name)
            run.assign(run.scopes[-2], str(name), value if value is not None else UNSET)
    return RETURN


@handles("break")
def break_(run: Interpreter, call: Call, args: list[Word]) -> int:
    """break()."""
    return BREAK


@handles("continue")
def continue_(run: Interpreter, call: Call, args: list[Word]) -> int:
    """continue()."""
    return CONTINUE


@handles("message")
def message(run: Interpreter, call: Call, args: list[Word]) -> int:
    """message(): FATAL_ERROR ends the run."""
    return FATAL if args and args[0] == "FATAL_ERROR" else 0


@handles("cmake_minimum_required")
def cmake_minimum_required(run: Interpreter, call: Call, args: list[Word]) -> None:
    """cmake_minimum_required(): also sets policies."""
    if len(args) < 2 or args[0].upper() != "VERSION":
        return
    lower, _, upper = args[1].partition("...")
    if not run.silent and (run.minimum is None or (run.inside(call.path) and call.path == run.minimum[1].path)):
        run.minimum = (str(args[1]), run.place(args[1].at))
    run.minimum_policy = version_key(upper or lower)


@handles("cmake_policy")
def cmake_policy(run: Interpreter, call: Call, args: list[Word]) -> None:
    """cmake_policy(VERSION) and CMP0054."""
    if len(args) >= 2 and args[0] == "VERSION":
        run.minimum_policy = max(run.minimum_policy, version_key(args[1].split("...")[-1]))
    elif args[:2] == ["SET", "CMP0054"] and args[2:3] == ["NEW"]:
        run.minimum_policy = max(run.minimum_policy, (3, 1))


@handles("project")
def project(run: Interpreter, call: Call, args: list[Word]) -> None:
    """project()."""
    if not args:
        return
    name = args[0]
    directory = run.scope["CMAKE_CURRENT_SOURCE_DIR"]
    binary = run.scope["CMAKE_CURRENT_BINARY_DIR"]
    if not run.project and not run.silent:
        run.project = str(name)
        run.assign(run.scope, "CMAKE_PROJECT_NAME", Value((name,)))
    values = {
        "PROJECT_NAME": Value((word(str(name), name.at),)),
        "PROJECT_SOURCE_DIR": directory,
        "PROJECT_BINARY_DIR": binary,
        f"{name}_SOURCE_DIR": directory,
        f"{name}_BINARY_DIR": binary,
    }
    version = following(args, "VERSION")
    if version is not None:
        values["PROJECT_VERSION"] = values[f"{name}_VERSION"] = Value((version,), version.sure)
        for part, number in zip(("MAJOR", "MINOR", "PATCH", "TWEAK"), version.split("."), strict=False):
            values[f"PROJECT_VERSION_{part}"] = Value((word(number, version.at),))
            values[f"{name}_VERSION_{part}"] = values[f"PROJECT_VERSION_{part}"]
    for key, value in values.items():
        run.assign(run.scope, key, value)


@handles("cmake_parse_arguments")
def cmake_parse_arguments(run: Interpreter, call: Call, args: list[Word]) -> None:
    """cmake_parse_arguments() in both signatures."""
    if args and args[0] == "PARSE_ARGV":
        if len(args) < 6:
            return
        first = _integer(args[1]) or 0
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
                missing.append(word(current, item.at))
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
            state = Value((word("TRUE" if found else "FALSE", call.at),))
        else:
            state = Value(tuple(found), all(item.sure for item in found)) if found else UNSET
        run.assign(scope, f"{prefix}_{name}", state)
    run.assign(scope, f"{prefix}_UNPARSED_ARGUMENTS", Value(tuple(unparsed)) if unparsed else UNSET)
    run.assign(scope, f"{prefix}_KEYWORDS_MISSING_VALUES", Value(tuple(missing)) if missing else UNSET)


@handles("separate_arguments")
def separate_arguments(run: Interpreter, call: Call, args: list[Word]) -> None:
    """separate_arguments()."""
    if len(args) == 1:
        held = run.get(args[0])
        if held is not None:
            words = [word(part, item.at, item.conditions, item.sure) for item in held.words for part in item.split(" ")]
            run.set(args[0], [item for item in words if item], held.sure)
    elif len(args) >= 3:
        run.set(args[0], [word(part, args[-1].at, (), args[-1].sure) for part in args[-1].split()])


@handles("configure_file")
def configure_file(run: Interpreter, call: Call, args: list[Word]) -> None:
    """configure_file(): a generated file, remembered so that it counts as existing in the build folder."""
    if len(args) >= 2:
        value = run.scope.get("CMAKE_CURRENT_BINARY_DIR")
        made = run.resolve(args[1], value.text if value is not None else None)
        run.configured[run.shown(made)] = None


@handles("execute_process", "exec_program", "try_compile", "try_run")
def execute_process(run: Interpreter, call: Call, args: list[Word]) -> None:
    """Commands that run something: what they answer is not known."""
    if call.name in ("try_compile", "try_run"):
        for name in args[:1]:
            run.set_unknown(name, call.at)
    for keyword, name in itertools.pairwise(args):
        if keyword in _ANSWERS:
            run.set_unknown(name, call.at)


_ANSWERS = name_set(
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
def check(run: Interpreter, call: Call, args: list[Word]) -> None:
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
        run.assign(run.scope, str(name), Value((word(f"${{{name}}}", call.at, (), False),), False))


@handles(
    "get_property", "get_target_property", "get_directory_property", "get_source_file_property", "get_cmake_property"
)
def get_property(run: Interpreter, call: Call, args: list[Word]) -> None:
    """Properties: those set in the tree are known, all others not."""
    if len(args) < 2:
        return
    key = _property_key(call.name, args)
    held = run.properties.get(key)
    if held is not None:
        run.assign(run.scope, str(args[0]), unsure(held))
    else:
        run.set_unknown(args[0], call.at)


@handles("set_directory_properties")
def set_directory_properties(run: Interpreter, call: Call, args: list[Word]) -> None:
    """set_directory_properties() changes nothing that is collected."""


def _property_key(command: str, args: list[Word]) -> str:
    """Where a property is kept: its scope, its owner and its name."""
    if command == "get_property" and "PROPERTY" in args[:-1]:
        index = position(args, "PROPERTY")
        return " ".join([*args[1:index], args[index + 1]])
    if command == "get_target_property" and len(args) >= 3:
        return f"TARGET {args[1]} {args[2]}"
    return " ".join(["?", *args[1:]])


@handles("cmake_language")
def cmake_language(run: Interpreter, call: Call, args: list[Word]) -> int:
    """cmake_language(CALL name ...)."""
    if len(args) >= 2 and args[0] == "CALL":
        from ...facts.cmake import Argument, Command

        given = tuple(
            Argument(template.raw, '"' if template.quoted else "", template.at.line, template.at.column)
            for template in call.templates[2:]
        )
        return run.run_call(
            Call(Command(args[1].lower(), given, call.at.line, call.at.column, call.at.line), call.path)
        )
    if args and args[0] in ("EVAL", "DEFER"):
        run.give_up(call.at, f"cmake_language({args[0]}) is not followed")
    return 0
