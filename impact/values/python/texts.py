"""Methods of texts whose characters are symbolic. Sizes are decided on first: of few characters, each is a way."""

from __future__ import annotations

from typing import Any

import z3

from .run import PythonRun
from .terms import ListValue, NotModelledError, Real, SymbolicText, Truth, Whole, make_truth, make_whole

Character = z3.BitVecRef | int
_BLANKS = tuple(map(ord, " \t\n\r\v\f"))


def make_text(characters: tuple[Character, ...]) -> SymbolicText | str:
    """A text of characters; a str where all of them are known."""
    plain = [one if isinstance(one, int) else z3.simplify(one) for one in characters]
    known = [one.as_long() if isinstance(one, z3.BitVecNumRef) else one for one in plain]
    if all(isinstance(one, int) for one in known):
        return "".join(map(chr, known))  # type: ignore[arg-type]
    return SymbolicText(tuple(known))


def list_characters(run: PythonRun, value: SymbolicText | str) -> tuple[Character, ...]:
    """The characters of a text; its size is decided on. Raises NotModelledError for what is no ASCII."""
    if isinstance(value, SymbolicText):
        return run.fix_text(value)
    if not value.isascii():
        raise NotModelledError("a text that is no ASCII")
    return tuple(map(ord, value))


def match_characters(left: tuple[Character, ...], right: tuple[Character, ...]) -> Truth | bool:
    """Whether two texts of one length are the same."""
    terms = [_make_term(a) == _make_term(b) for a, b in zip(left, right, strict=True)]
    return make_truth(z3.And(*terms)) if terms else True


def are_equal(run: PythonRun, left: SymbolicText | str, right: SymbolicText | str) -> Truth | bool:
    """Whether two texts are equal, without a decision where one of them is known."""
    if isinstance(left, str):
        left, right = right, left
    if isinstance(left, str):
        return left == right
    if isinstance(right, str):
        if not right.isascii() or len(right) > len(left.characters):
            return False
        same = [_make_term(a) == ord(b) for a, b in zip(left.characters, right, strict=False)]
        if left.size is None:
            return make_truth(z3.And(*same)) if len(left.characters) == len(right) else False
        return make_truth(z3.And(left.size.term == len(right), *same))
    a, b = run.fix_text(left), run.fix_text(right)
    return match_characters(a, b) if len(a) == len(b) else False


def get_length(value: SymbolicText) -> Whole | int:
    """`len` of a text."""
    return value.size if value.size is not None else len(value.characters)


def call_method(run: PythonRun, text: SymbolicText | str, name: str, given: list[Any]) -> Any:
    """A method of a text. Raises NotModelledError where it is not known, and what Python raises."""
    method = _METHODS.get(name)
    if method is None:
        raise NotModelledError(f"str.{name} of a text that is not known")
    return method(run, list_characters(run, text), given)


def _start(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> Truth | bool:
    return _fit(run, own, given, at_end=False)


def _end(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> Truth | bool:
    return _fit(run, own, given, at_end=True)


def _fit(run: PythonRun, own: tuple[Character, ...], given: list[Any], *, at_end: bool) -> Truth | bool:
    choices = given[0].elements if isinstance(given[0], ListValue) else [given[0]]
    terms: list[Any] = []
    for choice in choices:
        other = list_characters(run, choice)
        if len(other) <= len(own):
            part = own[len(own) - len(other) :] if at_end else own[: len(other)]
            terms.append(match_characters(part, other))
    if any(term is True for term in terms):
        return True
    symbolic = [term.term for term in terms if isinstance(term, Truth)]
    return make_truth(z3.Or(*symbolic)) if symbolic else False


def _strip(
    run: PythonRun, own: tuple[Character, ...], given: list[Any], left: bool = True, right: bool = True
) -> SymbolicText | str:
    blanks = _BLANKS if not given or given[0] is None else tuple(map(_read_number, list_characters(run, given[0])))
    start, end = 0, len(own)
    while left and start < end and run.decide(_is_one_of(own[start], blanks)):
        start += 1
    while right and start < end and run.decide(_is_one_of(own[end - 1], blanks)):
        end -= 1
    return make_text(own[start:end])


def _lower(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> SymbolicText | str:
    return make_text(tuple(_shift_case(one, "A", "Z", 32) for one in own))


def _make_upper(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> SymbolicText | str:
    return make_text(tuple(_shift_case(one, "a", "z", -32) for one in own))


def _shift_case(one: Character, first: str, last: str, by: int) -> Character:
    if isinstance(one, int):
        return one + by if ord(first) <= one <= ord(last) else one
    return z3.simplify(z3.If(z3.And(z3.UGE(one, ord(first)), z3.ULE(one, ord(last))), one + by, one))


def _split(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> ListValue:
    most = given[1] if len(given) > 1 else -1
    if not isinstance(most, int):
        raise NotModelledError("str.split with a number that is not known")
    parts: list[Any] = []
    if not given or given[0] is None:
        word: list[Character] = []
        for one in own:
            if run.decide(_is_one_of(one, _BLANKS)):
                if word:
                    parts.append(make_text(tuple(word)))
                word = []
            else:
                word.append(one)
        if word:
            parts.append(make_text(tuple(word)))
        return ListValue(parts)
    mark = list_characters(run, given[0])
    if not mark:
        raise run.throw("ValueError", "empty separator")
    start = position = 0
    while position + len(mark) <= len(own):
        if (most < 0 or len(parts) < most) and run.decide(match_characters(own[position : position + len(mark)], mark)):
            parts.append(make_text(own[start:position]))
            position += len(mark)
            start = position
        else:
            position += 1
    parts.append(make_text(own[start:]))
    return ListValue(parts)


def _find(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> int:
    mark = list_characters(run, given[0])
    for position in range(len(own) - len(mark) + 1):
        if run.decide(match_characters(own[position : position + len(mark)], mark)):
            return position
    return -1


def _locate(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> int:
    found = _find(run, own, given)
    if found < 0:
        raise run.throw("ValueError", "substring not found")
    return found


def contains(run: PythonRun, text: SymbolicText | str, mark: SymbolicText | str) -> bool:
    """`mark in text`."""
    return _find(run, list_characters(run, text), [mark]) >= 0


def _replace(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> SymbolicText | str:
    old, new = list_characters(run, given[0]), list_characters(run, given[1])
    if not old:
        raise NotModelledError("str.replace of nothing")
    result: list[Character] = []
    position = 0
    while position < len(own):
        fits = position + len(old) <= len(own)
        if fits and run.decide(match_characters(own[position : position + len(old)], old)):
            result.extend(new)
            position += len(old)
        else:
            result.append(own[position])
            position += 1
    return make_text(tuple(result))


def _is_digits(run: PythonRun, own: tuple[Character, ...], given: list[Any]) -> Truth | bool:
    terms = [_is_between(one, "0", "9") for one in own]
    return make_truth(z3.And(*terms)) if terms else False


def parse_whole(run: PythonRun, text: SymbolicText | str) -> Whole | int:
    """`int(text)`: blanks around, a sign, digits. Raises the ValueError of the program for others; underscores between
    digits are not modelled, and what stands between blanks is any number."""
    own: list[Character] = list(list_characters(run, text))
    if not own:
        raise run.throw("ValueError", "invalid literal for int()")
    blank = [_is_one_of_term(one, _BLANKS) for one in own]
    if run.decide(make_truth(z3.Or(blank[0], blank[-1]))):
        if not run.decide(make_truth(_is_padded_number(tuple(own), blank))):
            raise run.throw("ValueError", "invalid literal for int()")
        most = 10 ** len(own)
        run.assumed["a number between blanks is any number"] = None
        value = run.get_whole(run.make_name("~int of a text"), 64, True)
        run.assume(z3.And(value.term < min(most, 2**62), value.term > -min(most, 2**62)))
        return value
    negative = _make_term(own[0]) == ord("-")
    signed = z3.Or(negative, _make_term(own[0]) == ord("+"))
    digits = [_is_between(one, "0", "9") for one in own]
    rest = z3.And(*digits[1:], z3.BoolVal(True))
    valid = z3.And(rest, z3.Or(digits[0], signed) if len(own) > 1 else digits[0])
    if not run.decide(make_truth(valid)):
        raise run.throw("ValueError", "invalid literal for int()")
    term = z3.If(signed, z3.BitVecVal(0, 128), z3.ZeroExt(120, _make_term(own[0]) - ord("0")))
    for one in own[1:]:
        term = term * 10 + z3.ZeroExt(120, _make_term(one) - ord("0"))
    most = 10 ** len(own) - 1
    return make_whole(z3.If(negative, -term, term), -most, most)


def _is_padded_number(own: tuple[Character, ...], blank: list[z3.BoolRef]) -> z3.BoolRef:
    """Whether characters are blanks, a number, and blanks."""
    digits = [_is_between(one, "0", "9") for one in own]
    ways: list[z3.BoolRef] = []
    for start in range(len(own)):
        for end in range(start + 1, len(own) + 1):
            sign = _is_one_of_term(own[start], (ord("-"), ord("+"))) if end - start > 1 else z3.BoolVal(False)
            ways.append(z3.And(*blank[:start], *blank[end:], z3.Or(digits[start], sign), *digits[start + 1 : end]))
    return z3.Or(*ways)


def parse_real(run: PythonRun, text: SymbolicText | str) -> Real | float:
    """`float(text)` as far as it is a whole number; `nan` and `inf` apart. Other texts with a point or an exponent are
    any float, and what is none of these raises."""
    own = list_characters(run, _strip(run, list_characters(run, text), []))
    if not own:
        raise run.throw("ValueError", "could not convert string to float")
    for word, value in (("nan", float("nan")), ("inf", float("inf")), ("-inf", float("-inf"))):
        if len(word) == len(own) and run.decide(match_characters(own, tuple(map(ord, word)))):
            return value
    point = z3.Or(*[_is_one_of_term(one, tuple(map(ord, ".eE_nNiI"))) for one in own])
    if run.decide(make_truth(point)):
        return (
            run.get_real(run.make_name("~float of a text"), 64)
            if run.choose("a text with a point is a float")
            else (_refuse(run))
        )
    whole = parse_whole(run, make_text(own))
    if isinstance(whole, int):
        return float(whole)
    from .terms import convert_to_real, get_span, make_real

    return make_real(convert_to_real(whole), get_span(whole))


def _refuse(run: PythonRun) -> float:
    raise run.throw("ValueError", "could not convert string to float")


def cut_text(run: PythonRun, text: SymbolicText | str, start: Any, stop: Any, step: Any) -> SymbolicText | str:
    """`text[start:stop:step]` with bounds that are known."""
    own = list_characters(run, text)
    return make_text(own[slice(start, stop, step)])


def _make_term(one: Character) -> z3.BitVecRef:
    return z3.BitVecVal(one, 8) if isinstance(one, int) else one


def _read_number(one: Character) -> int:
    if not isinstance(one, int):
        raise NotModelledError("a set of characters that is not known")
    return one


def _is_one_of_term(one: Character, others: tuple[int, ...]) -> z3.BoolRef:
    return z3.Or(*[_make_term(one) == other for other in others])


def _is_one_of(one: Character, others: tuple[int, ...]) -> Truth | bool:
    return make_truth(_is_one_of_term(one, others))


def _is_between(one: Character, first: str, last: str) -> z3.BoolRef:
    return z3.And(z3.UGE(_make_term(one), ord(first)), z3.ULE(_make_term(one), ord(last)))


_METHODS = {
    "startswith": _start, "endswith": _end, "strip": _strip, "lower": _lower, "upper": _make_upper, "split": _split,
    "find": _find, "index": _locate, "replace": _replace, "isdigit": _is_digits, "isnumeric": _is_digits,
    "isdecimal": _is_digits,
    "lstrip": lambda run, own, given: _strip(run, own, given, right=False),
    "rstrip": lambda run, own, given: _strip(run, own, given, left=False),
    "encode": lambda run, own, given: make_text(own), "decode": lambda run, own, given: make_text(own),
}  # fmt: skip
