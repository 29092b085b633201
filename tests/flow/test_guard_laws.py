"""Comparison of guards against the laws of logic, and against trying all values."""

import itertools
import operator

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from one_way import compare, compare_ways, explain, is_impossible
from rosimpact.impact.logic import guard_reading
from rosimpact.impact.logic.guard_renames import propose_renames
from rosimpact.impact.model.flow.graph import GuardAt

# Formulas: ("a",) is a boolean, ("<", sum, number) compares, ("not", f), ("and", f, g), ("or", f, g).
BOOLEANS = ("a", "b_", "s.ok")
NUMBERS = ("x", "y")
# What conditions with such constants tell apart lies within these.
CONSTANTS = st.integers(-1, 1)
# Between 1/2 and 1, two numbers of which one is the smaller: 2 * x > 1, x < y, y < 1.
FRACTIONS = [number / 8 for number in range(-34, 35) if number % 2 == 0 or abs(number) < 18]
WHOLES = range(-4, 5)
SUMS = {
    "x": lambda values: values["x"],
    "y": lambda values: values["y"],
    "x + y": lambda values: values["x"] + values["y"],
    "x - y": lambda values: values["x"] - values["y"],
    "2 * x": lambda values: 2 * values["x"],
}
COMPARE = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
WORDS = {
    "cpp": {"and": "&&", "or": "||", "not": "!"},
    "python": {"and": "and", "or": "or", "not": "not "},
}
SETTINGS = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))

atoms = st.one_of(
    st.sampled_from(BOOLEANS).map(lambda name: (name,)),
    st.tuples(
        st.sampled_from(tuple(COMPARE)),
        st.sampled_from(tuple(SUMS)),
        CONSTANTS,
    ),
)
formulas = st.recursive(
    atoms,
    lambda inner: st.one_of(st.tuples(st.just("not"), inner), st.tuples(st.sampled_from(("and", "or")), inner, inner)),
    max_leaves=6,
)
languages = st.sampled_from(("cpp", "python"))


def written(formula, language: str) -> str:
    kind = formula[0]
    words = WORDS[language]
    if kind == "not":
        return f"{words['not']}({written(formula[1], language)})"
    if kind in ("and", "or"):
        return f"({written(formula[1], language)}) {words[kind]} ({written(formula[2], language)})"
    return f"{formula[1]} {kind} {formula[2]}" if len(formula) == 3 else kind


def true(formula, values: dict) -> bool:
    kind = formula[0]
    if kind == "not":
        return not true(formula[1], values)
    if kind in ("and", "or"):
        left, right = true(formula[1], values), true(formula[2], values)
        return left and right if kind == "and" else left or right
    if len(formula) == 3:
        return COMPARE[kind](SUMS[formula[1].removesuffix(" - 1")](values) - formula[1].endswith(" - 1"), formula[2])
    return values[kind]


def names(formula) -> set[str]:
    if formula[0] in ("and", "or", "not"):
        return set().union(*map(names, formula[1:]))
    return {formula[0]} if len(formula) == 1 else {name for name in NUMBERS if name in formula[1]}


def worlds(numbers, *parts):
    """All values of the names in some formulas."""
    used = sorted(set().union(*map(names, parts)))
    domains = [numbers if name in NUMBERS else (False, True) for name in used]
    return (dict(zip(used, values, strict=True)) for values in itertools.product(*domains))


def possible(formula) -> bool:
    return any(true(formula, values) for values in worlds(WHOLES, formula))


def rewritten(formula, draw):
    """The formula in other words, by laws."""
    kind = formula[0]
    if kind == "not":
        inner = formula[1]
        if inner[0] in ("and", "or") and draw(st.booleans()):
            other = "or" if inner[0] == "and" else "and"
            return (other, rewritten(("not", inner[1]), draw), rewritten(("not", inner[2]), draw))
        if inner[0] == "not" and draw(st.booleans()):
            return rewritten(inner[1], draw)
        return ("not", rewritten(inner, draw))
    if kind in ("and", "or"):
        left, right = rewritten(formula[1], draw), rewritten(formula[2], draw)
        other = "or" if kind == "and" else "and"
        if right[0] == other and draw(st.booleans()):
            return (other, (kind, left, right[1]), (kind, left, right[2]))
        return (kind, right, left) if draw(st.booleans()) else (kind, left, right)
    law = draw(st.sampled_from(("as it is", "twice not", "otherwise", "moved")))
    if law == "twice not":
        return ("not", ("not", formula))
    if len(formula) == 3 and law == "otherwise":
        opposite = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "=="}
        return ("not", (opposite[kind], *formula[1:]))
    if len(formula) == 3 and law == "moved":
        return (kind, f"{formula[1]} - 1", formula[2] - 1)
    return formula


def guards(language: str, *pairs: tuple[str, str]) -> tuple[GuardAt, ...]:
    path = {"cpp": "n.cpp", "python": "n.py"}[language]
    return tuple(GuardAt(kind, text, path, line, "f") for line, (kind, text) in enumerate(pairs, 1))


def nested(formula, language: str, draw) -> tuple[tuple[str, str], ...]:
    """The formula as guards one inside the other, some of them early returns."""
    if formula[0] == "and" and draw(st.booleans()):
        return nested(formula[1], language, draw) + nested(formula[2], language, draw)
    if draw(st.booleans()):
        return (("unless", written(("not", formula), language)),)
    return (("if", written(formula, language)),)


@SETTINGS
@given(formulas, languages, st.data())
def test_the_same_in_other_words(formula, language, data):
    other = rewritten(formula, data.draw)
    old, new = (guards(language, ("if", written(each, language))) for each in (formula, other))
    assert compare(old, new) == "equivalent"
    assert explain(old, new) == ""
    assume(possible(formula))
    assert compare(old, guards(language, *nested(other, language, data.draw))) == "equivalent"


@SETTINGS
@given(formulas, formulas, languages, st.data())
def test_one_more_condition(formula, more, language, data):
    both = ("and", formula, more)
    assume(possible(both))
    old = guards(language, *nested(formula, language, data.draw))
    new = guards(language, *nested(both, language, data.draw))
    kind, back = compare(old, new), compare(new, old)
    assert (kind, back) in (("tightened", "widened"), ("equivalent", "equivalent"), ("changed", "changed"))
    lost = [values for values in worlds(FRACTIONS, formula, more) if true(formula, values) and not true(more, values)]
    if kind == "equivalent":
        assert not lost
    else:
        assert lost
        assert explain(old, new)
    if kind == "changed":
        # What only fractions and numbers below zero tell apart is not decided.
        assert all(any(value not in WHOLES or value < 0 for value in values.values()) for values in lost)


@SETTINGS
@given(formulas, formulas, languages)
def test_any_two(first, second, language):
    assume(possible(first) and possible(second))
    old, new = (guards(language, ("if", written(each, language))) for each in (first, second))
    kind = compare(old, new)
    assert compare(new, old) == {"tightened": "widened", "widened": "tightened"}.get(kind, kind)
    fractions = list(worlds(FRACTIONS, first, second))
    loses = any(true(first, values) and not true(second, values) for values in fractions)
    gains = any(true(second, values) and not true(first, values) for values in fractions)
    if kind != "changed":
        assert (loses, gains) == {
            "tightened": (True, False), "widened": (False, True), "equivalent": (False, False)
        }[kind]  # fmt: skip
    if kind == "changed":
        assert loses or gains


@SETTINGS
@given(formulas, formulas, languages)
def test_ways_are_alternatives(first, second, language):
    together = guards(language, ("if", written(("or", first, second), language)))
    apart = [guards(language, ("if", written(each, language))) for each in (first, second)]
    assert compare_ways([together], apart) == "equivalent"


KINDS = st.sampled_from(("if", "unless", "while", "for", "do", "case", "catch", "cpp", "macro", "with", "unheard of"))
PIECES = (
    "(",
    ")",
    "a",
    "&&",
    "and ",
    "or",
    "!",
    "not ",
    "[",
    "]",
    "{",
    "x.y",
    "->",
    "::",
    "==",
    "<",
    " or ",
    ",",
    "0x",
)
ODD = st.one_of(st.text(max_size=40), st.lists(st.sampled_from((*PIECES, '"', "'", "\\", "\n", ";", ":")), max_size=12))


@settings(max_examples=300, deadline=None)
@given(languages, KINDS, ODD.map("".join), ODD.map("".join))
def test_odd_text_never_raises(language, kind, old, new):
    reading = guard_reading.read(language, kind, old)
    assert all(piece.term for piece in reading.pieces)
    before, after = guards(language, (kind, old), ("if", "a")), guards(language, (kind, new), ("if", "a"))
    assert compare(before, before) == "equivalent"
    kinds = {compare(before, after), compare(after, before)}
    assert kinds in ({"equivalent"}, {"changed"}, {"tightened", "widened"})
    explain(before, after)
    is_impossible(before)
    propose_renames(old, new, language)


@pytest.mark.parametrize("language", ["cpp", "python"])
@pytest.mark.parametrize(
    "text",
    [
        "(" * 1900 + "a" + ")" * 1900,
        "!" * 3000 + "a",
        "not " * 900 + "a",
        "-" * 3000 + "a",
        " && ".join(f"a{i}" for i in range(500)),
        " and ".join(f"a{i}" for i in range(500)),
        " + ".join(["a"] * 900) + " > 3",
        "a" + "[0" * 900 + "]" * 900,
        "f(" * 900 + ")" * 900,
        "a ? " * 800 + "b" + " : c" * 800,
        "x > 1e999999999",
        "x > " + "9" * 3000,
        "x > 0x" + "f" * 3000,
        "a\0b",
        "\ud800",
        "a) ; } void g() { if (b",
        "a # b",
        "a // b",
        "1 / 0 > x",
        "x / 0.0 > 1",
    ],
    ids=lambda text: ascii(text[:20]),
)
def test_hostile_text_comes_back(language, text):
    old, new = guards(language, ("if", text)), guards(language, ("if", text), ("if", "b"))
    assert compare(old, new) in ("tightened", "changed")
    assert compare(new, new) == "equivalent"
    explain(old, new)


def test_variables_that_double_each_other_come_back():
    old = guards("cpp", *(("if", f"auto a{place + 1} = f(a{place}, a{place})") for place in range(60)))
    assert compare(old, guards("cpp", *((guard.kind, guard.text) for guard in old), ("if", "b"))) == "tightened"
