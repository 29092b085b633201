"""Documents within limits: what is read, and what is refused with a reason and a line."""

import datetime

import pytest
from rosimpact.edges.documents import DocumentError, load_json, load_toml, load_yaml

ALIASES = "a: &a0 [x]\n" + "".join(f"b{n}: &a{n + 1} [{', '.join([f'*a{n}'] * 9)}]\n" for n in range(9))
MERGES = "a0: &a0 {k: v}\n" + "".join(
    f"a{n + 1}: &a{n + 1}\n" + f"  <<: [{', '.join([f'*a{n}'] * 9)}]\n  k{n}: v\n" for n in range(9)
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("", None),
        ("a: [1, x]\nb: {c: null}", {"a": [1, "x"], "b": {"c": None}}),
        (b"\xef\xbb\xbfa: 1", {"a": 1}),
        ("x: &x {k: 1}\ny: {<<: *x, l: 2}", {"x": {"k": 1}, "y": {"k": 1, "l": 2}}),
        ("day: 2024-03-01", {"day": datetime.date(2024, 3, 1)}),
        ("one: 1\n---\ntwo: 2", {"one": 1}),
        ("[" * 150 + "]" * 150, None),
    ],
)
def test_yaml(text, value):
    found = load_yaml(text)
    assert found == value or str(text).startswith("[[")


@pytest.mark.parametrize(
    ("text", "reason", "line"),
    [
        (ALIASES, "more than 200,000 nodes, aliases included", 7),
        (MERGES, "more than 200,000 nodes, aliases included", 15),
        # PyYAML 6.0.4 stops at 1,000 levels by itself.
        ("[" * 5000, "nested deeper than 200 levels|exceeded maximum nesting depth", 1),
        ("- " * 50_000 + "x", "nested deeper than 200 levels", 1),
        ("a: 1\nb: &b [*b]", "an alias stands for something that contains it", 2),
        ("a: !!python/object/apply:os.system [ls]", "could not determine a constructor", 1),
        ("a: !own 1", "could not determine a constructor", 1),
        ("? [a]\n: b", "found unhashable key", 1),
        ("day: 2024-13-01", "month must be in 1..12", 0),
        ("n: !!int x", "invalid literal", 0),
        ("t: !!timestamp x", "groupdict", 0),
        ("a: b: c", "mapping values are not allowed", 1),
        ("a: 1\n\t- b", ".", 2),
        (b"a: \xff", "invalid", 0),
        ("a: \x00", "not allowed", 0),
    ],
)
def test_yaml_is_refused(text, reason, line):
    with pytest.raises(DocumentError, match=reason) as refused:
        load_yaml(text)
    assert refused.value.line == line


@pytest.mark.parametrize(
    ("text", "reason", "line"),
    [
        ("a = 1\n" + ".".join("k" * 5000) + " = 1", "a key of more than 200 parts", 2),
        ("[" + ".".join("k" * 5000) + "]", "a key of more than 200 parts", 1),
        ("a = " + "[" * 5000, "nested too deeply", 0),
        ("a = " + "{b = " * 5000, "nested too deeply", 0),
        ("a = " + "9" * 5000, "4300 digits", 0),
        ("a = 1\nb", "Expected '=' after a key", 2),
        ("a = 1\na = 2", "Cannot overwrite", 2),
    ],
)
def test_toml_is_refused(text, reason, line):
    with pytest.raises(DocumentError, match=reason) as refused:
        load_toml(text)
    assert refused.value.line == line


def test_toml():
    assert load_toml('a.b = "1.2.3"\n[c.d]\ne = [1, 2]') == {"a": {"b": "1.2.3"}, "c": {"d": {"e": [1, 2]}}}


@pytest.mark.parametrize(
    ("text", "reason", "line"),
    [
        ("[" * 200_000, "nested too deeply", 0),
        ("1" * 6000, "4300 digits", 0),
        (b"\xff", "can't decode", 0),
        ("{\n\n1: 2}", "Expecting property name", 3),
    ],
)
def test_json_is_refused(text, reason, line):
    with pytest.raises(DocumentError, match=reason) as refused:
        load_json(text)
    assert refused.value.line == line


@pytest.mark.parametrize("text", [b"\xef\xbb\xbf[1]", "\ufeff[1]", "[1]"])
def test_json(text):
    assert load_json(text) == [1]
