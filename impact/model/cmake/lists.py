"""Commands over texts: list(), string(), run_math(), separate_arguments()."""

import re
from collections.abc import Sequence

from ...conditions.preprocessor import evaluate_number
from ...facts.condition import Condition
from .blocks import CommandCall
from .interpreter import Interpreter, handles
from .regex import REGEX_STEPS, compile_if_usable
from .standard import note_variable
from .values import (
    MAX_TEXT,
    MAX_WORDS,
    UNSET,
    CMakeValue,
    Word,
    add_conditions,
    find_position,
    join,
    split_list,
    split_words,
    wrap,
)

# A text that is cut or given up afterwards may be so long.
_LONGEST = 4 * MAX_TEXT


def list_items(values: list[Word]) -> list[Word]:
    """List items of a value, empty ones kept when there is nothing else."""
    if len(values) == 1 and ";" not in values[0]:
        return values
    items: list[Word] = []
    for value in values:
        if ";" in value:
            items.extend(value.parts or [wrap(part, value.at, value.conditions, value.sure) for part in _split(value)])
        else:
            items.append(value)
    return items


def _split(text: str) -> list[str]:
    """List items with escaped semicolons left as they are."""
    return split_list(text) if "\\;" not in text else re.split(r"(?<!\\);", text)


_OF_PACKAGE = re.compile(r"(.+?)_(?:INCLUDE_DIRS?|LIBRARIES|LIBRARY|LIBRARY_DIRS|LIBS|DEFINITIONS|EXPORTED_TARGETS)\Z")


def may_be_set_elsewhere(run: Interpreter, name: str) -> bool:
    """Whether a package that was looked for, or a command of which nothing is known, may set a variable, whose value
    is then not known."""
    set_by = _OF_PACKAGE.match(name)
    stem = set_by[1].lower() if set_by is not None else ""
    return name in run.maybe_set or any(stem and stem in (f.name.lower(), f.prefix.lower()) for f in run.found)


@handles("list", least=2)
def list_(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """list()."""
    action, name, rest = str(args[0]).upper(), str(args[1]), args[2:]
    held = run.get(name)
    if held is not None:
        run.spend(len(held.words) >> 5)
    if action in ("APPEND", "PREPEND", "INSERT"):
        index = 0
        if action == "INSERT" and rest:
            index = parse_int(rest[0]) or 0
            rest = rest[1:]
        added = add_conditions(split_words(rest), run.conditions)
        if held is None:
            unknown = may_be_set_elsewhere(run, name)
            before = (wrap(f"${{{name}}}", call.at, (), False),) if unknown else ()
            sure = not unknown and not name.startswith("CMAKE_")
        else:
            before = tuple(item for item in held.words if item)
            sure = held.sure
        words = before + added if action == "APPEND" else before[:index] + added + before[index:]
        if len(words) > MAX_WORDS:
            run.give_up(call.at, f"`{name}` has more than {MAX_WORDS} items")
            words = words[:MAX_WORDS]
        run.assign(run.scope, name, CMakeValue(words, sure and all(item.sure for item in added)))
        note_variable(run, name, ";".join(added), args[1])
        return
    if held is None:
        held = UNSET if run.lookup("", name) is None else CMakeValue(())
        known = False
    else:
        known = held.sure
    words = tuple(item for item in held.words if item or len(held.words) > 1)
    if action == "LENGTH" and rest:
        run.set_text(rest[0], str(len(words)) if known else None, call.at)
    elif action == "GET" and len(rest) >= 2:
        chosen = [_get_at(words, index) for index in rest[:-1]]
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
                run.assign(run.scope, str(variable), CMakeValue((item,), known) if item is not None else UNSET)
        run.assign(run.scope, name, CMakeValue(tuple(left), known))
    elif action == "FIND" and len(rest) == 2:
        if known and not rest[0].sure:
            run.assign(run.scope, rest[1], _find_in_each(rest[0], words))
        else:
            place = str(words.index(rest[0]) if rest[0] in words else -1)
            run.set_text(rest[1], place if known else None, call.at)
    elif action == "JOIN" and len(rest) == 2:
        run.set_text(rest[1], _join_words(str(rest[0]), words), call.at, known)
    elif action == "SUBLIST" and len(rest) == 3:
        start, length = parse_int(rest[0]), parse_int(rest[1])
        if start is None or length is None:
            run.set_unknown(rest[2], call.at)
        else:
            run.set(rest[2], words[start:] if length < 0 else words[start : start + length], known)
    elif action == "REMOVE_ITEM":
        gone = set(split_words(rest))
        _store(run, name, [item for item in words if item not in gone], known)
    elif action == "REMOVE_AT":
        gone_at = {index if index >= 0 else len(words) + index for index in map(parse_int, rest) if index is not None}
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
            pattern = compile_if_usable(rest[2], item, run.spend)
            hit = pattern.search(item) is not None if pattern is not None else rest[0] == "INCLUDE"
            if hit == (rest[0] == "INCLUDE"):
                kept.append(item)
        _store(run, name, kept, known)
    elif action == "TRANSFORM" and rest:
        _transform(run, name, words, rest, known)


def _store(run: Interpreter, name: str, words: list[Word], known: bool) -> None:
    """Writes a changed list back; items keep the conditions they had."""
    run.assign(run.scope, name, CMakeValue(tuple(words), known))


def _get_at(words: tuple[Word, ...], index: Word) -> Word | None:
    number = parse_int(index)
    return words[number] if number is not None and -len(words) <= number < len(words) else None


def _find_in_each(item: Word, words: Sequence[Word]) -> CMakeValue:
    """The places in a list that something which is not known may have, each where it is that."""
    tests = [(Condition("cmake", f"{item} STREQUAL {word}"),) for word in words]
    absent = (Condition("cmake", f"{item} IN_LIST {';'.join(words)};", negated=True),)
    places = [*map(str, range(len(words))), "-1"]
    return join([CMakeValue((wrap(place, item.at),)) for place in places], [*tests, absent]) or UNSET


def _join_words(separator: str, words: Sequence[Word]) -> str:
    """Words joined, up to about the length that a text may have."""
    if len(separator) * len(words) + sum(map(len, words)) <= _LONGEST:
        return separator.join(words)
    parts: list[str] = []
    length = 0
    for item in words:
        parts.append(item)
        length += len(item) + len(separator)
        if length > MAX_TEXT:
            break
    return separator.join(parts)


def parse_int(text: str) -> int | None:
    """The number a text is, None when it is none."""
    try:
        return int(text)
    except ValueError:
        return None


def _transform(run: Interpreter, name: str, words: tuple[Word, ...], rest: list[Word], known: bool) -> None:
    """list(TRANSFORM)."""
    action = rest[0]
    output = name
    if "OUTPUT_VARIABLE" in rest:
        index = find_position(rest, "OUTPUT_VARIABLE")
        output = str(rest[index + 1]) if index + 1 < len(rest) else name
        rest = rest[:index]
    operands = {"APPEND": 1, "PREPEND": 1, "REPLACE": 2}.get(action, 0)
    selector = rest[1 + operands :]
    chosen: object = None
    pattern_text = ""
    if selector[:1] == ["REGEX"] and len(selector) > 1:
        pattern_text = selector[1]
    elif selector[:1] == ["AT"]:
        chosen = {index % len(words) if words else 0 for index in map(parse_int, selector[1:]) if index is not None}
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
            pattern = compile_if_usable(pattern_text, item, run.spend)
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
            text = _replace_matches(run, rest[1], rest[2], item) or item
        made.append(wrap(text, item.at, item.conditions, item.sure))
    run.assign(run.scope, output, CMakeValue(tuple(made), known))


@handles("string", least=2)
def run_string(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """string()."""
    action, rest = str(args[0]).upper(), args[1:]
    sure = all(item.sure for item in rest)
    at = call.at

    def put(name: str, text: str | None) -> None:
        if text is None:
            run.set_unknown(name, at)
        else:
            run.set(
                name,
                [wrap(part, at, (), sure) for part in _split(text[:MAX_TEXT])]
                if ";" in text
                else [wrap(text[:MAX_TEXT], at, (), sure)],
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
        put(rest[1], _join_words(str(rest[0]), rest[2:]))
    elif action == "STRIP" and len(rest) == 2:
        put(rest[1], rest[0].strip())
    elif action == "LENGTH" and len(rest) == 2:
        put(rest[1], str(len(rest[0].encode())))
    elif action == "REPLACE" and len(rest) >= 4:
        text = "".join(rest[3:])
        fits = rest[0] and len(text) + text.count(rest[0]) * len(rest[1]) <= _LONGEST
        put(rest[2], text.replace(rest[0], rest[1]) if fits else None)
    elif action == "SUBSTRING" and len(rest) == 4:
        begin, length = parse_int(rest[1]), parse_int(rest[2])
        known = begin is not None and length is not None
        put(rest[3], (rest[0][begin:] if length < 0 else rest[0][begin : begin + length]) if known else None)  # type: ignore[operator]
    elif action == "FIND" and len(rest) >= 3:
        put(rest[2], str(rest[0].rfind(rest[1]) if "REVERSE" in rest[3:] else rest[0].find(rest[1])))
    elif action == "REPEAT" and len(rest) == 3:
        count = parse_int(rest[1])
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
        _run_regex(run, rest, sure, put)
    elif action in ("MD5", "SHA1", "SHA256", "RANDOM", "TIMESTAMP", "UUID", "CONFIGURE", "JSON", "HEX", "ASCII"):
        target = {"RANDOM": len(rest) - 1, "CONFIGURE": 1, "ASCII": len(rest) - 1, "HEX": 1, "MD5": 0}.get(action, 0)
        if 0 <= target < len(rest):
            run.set_unknown(rest[target], at)


def _run_regex(run: Interpreter, rest: list[Word], sure: bool, put) -> None:
    """string(REGEX MATCH | MATCHALL | REPLACE)."""
    run.spend(REGEX_STEPS)
    mode = rest[0]
    if mode == "REPLACE" and len(rest) >= 5:
        put(rest[3], _replace_matches(run, rest[1], rest[2], "".join(rest[4:])))
        return
    if mode not in ("MATCH", "MATCHALL"):
        return
    text = "".join(rest[3:])
    pattern = compile_if_usable(rest[1], text, run.spend)
    if pattern is None:
        put(rest[2], None)
    elif not sure:
        run.set_unknown(rest[2], rest[2].at)
    elif mode == "MATCH":
        found = pattern.search(text)
        if found:
            run.set_match_groups((found.group(), *(group or "" for group in found.groups())))
        put(rest[2], found.group() if found else "")
    else:
        put(rest[2], ";".join(found.group() for found in pattern.finditer(text)))


def _replace_matches(run: Interpreter, pattern_text: str, replacement: str, text: str) -> str | None:
    """The text with every match replaced, None when it cannot be known."""
    pattern = compile_if_usable(pattern_text, text, run.spend)
    if pattern is None:
        return None

    def expand(found: re.Match[str]) -> str:
        def group(reference: re.Match[str]) -> str:
            number = reference.group(1)
            if not number.isdigit():
                return "\n" if number == "n" else number
            return (found.group(int(number)) or "") if int(number) <= len(found.groups()) else ""

        return re.sub(r"\\(.)", group, replacement, flags=re.DOTALL)

    parts: list[str] = []
    length = last = 0
    for found in pattern.finditer(text):
        parts += [text[last : found.start()], expand(found)]
        length += len(parts[-1])
        last = found.end()
        if length > MAX_TEXT:
            return None
    return "".join([*parts, text[last:]])


# What run_math() reads; its operators are those of C, whose octal numbers it does not have.
_MATH = re.compile(r"(?:\s|0[xX][0-9a-fA-F]{1,15}|\d{1,18}\b|<<|>>|[-+*/%|&^~()])+")
_LEADING_ZEROS = re.compile(r"\b0+(?=\d)")


@handles("math", least=3)
def run_math(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """math(EXPR)."""
    value = calculate(args[2]) if args[2].sure else None
    shown = hex if "HEXADECIMAL" in args[3:] else str
    run.set_text(args[1], None if value is None else shown(value), call.at)


def calculate(text: str) -> int | None:
    """Value of a math(EXPR) text in 64 bit, None when it is malformed."""
    if len(text) > 1000 or not _MATH.fullmatch(text):
        return None
    value = evaluate_number(_LEADING_ZEROS.sub("", text))
    return None if value is None else (value + 2**63) % 2**64 - 2**63


@handles("separate_arguments")
def separate_arguments(run: Interpreter, call: CommandCall, args: list[Word]) -> None:
    """separate_arguments()."""
    if len(args) == 1:
        held = run.get(args[0])
        if held is not None:
            words = [wrap(part, item.at, item.conditions, item.sure) for item in held.words for part in item.split(" ")]
            run.set(args[0], [item for item in words if item], held.sure)
    elif len(args) >= 3:
        run.set(args[0], [wrap(part, args[-1].at, (), args[-1].sure) for part in args[-1].split()])
