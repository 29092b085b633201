"""Messages and help, rendered from the data of diagnostics after those of several targets were merged."""

import re

import pytest
from rosimpact.impact.analysis.findings import merge_diagnostics
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.rules.rule import Diagnostic, Rule, load_rules
from rosimpact.impact.rules.severity import Doubt
from rosimpact.impact.rules.text import Text, list_names, render_template

# (template, data by target, text)
RENDERED = [
    ("plain", {"": {}}, "plain"),
    ("`{name}` is gone", {"": {"name": "x.h"}}, "`x.h` is gone"),
    # what braces and brackets are in a value stays
    ("`{name}`", {"": {"name": "f<{T}>[[0]]"}}, "`f<{T}>[[0]]`"),
    ("every {period:g} s", {"": {"period": 0.10}}, "every 0.1 s"),
    ("{count:,} pairs", {"": {"count": 12345}}, "12,345 pairs"),
    # names, and none of them
    ("used by {users:nothing}", {"": {"users": ("a", "b")}}, "used by `a` and `b`"),
    ("used by {users:nothing}", {"": {"users": ()}}, "used by nothing"),
    # an optional part
    ("x[[, since {since}]]; y", {"": {"since": "4.7"}}, "x, since 4.7; y"),
    ("x[[, since {since}]]; y", {"": {"since": ""}}, "x; y"),
    ("x[[, used by {users}]]", {"": {"users": ()}}, "x"),
    # what differs names its targets, the rest does not
    ("`{name}` is not in tf2 {version}",
     {"jazzy": {"name": "x.h", "version": "0.36"}, "rolling": {"name": "x.h", "version": "0.41"}},
     "`x.h` is not in tf2 0.36 (jazzy), 0.41 (rolling)"),
    ("in tf2 {version}", {"a": {"version": "1"}, "b": {"version": "2"}, "c": {"version": "1"}},
     "in tf2 1 (a, c), 2 (b)"),
    # code stays code, value by value
    ("write `{replacement}`", {"a": {"replacement": "f(x)"}, "b": {"replacement": "g"}}, "write `f(x)` (a), `g` (b)"),
    # a target that is named in the value is not named again
    ("not released in {distro}", {"jazzy": {"distro": "jazzy"}, "rolling": {"distro": "rolling"}},
     "not released in jazzy, rolling"),
    # an optional part that only some targets have stays away
    ("x[[, since {since}]]", {"a": {"since": "4.7"}, "b": {"since": ""}}, "x"),
]  # fmt: skip


@pytest.mark.parametrize(("template", "data", "expected"), RENDERED)
def test_render_template(template, data, expected):
    assert render_template(template, list(data.items())) == expected


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ((), ""),
        (("a",), "`a`"),
        (("a", "b", "c"), "`a`, `b` and `c`"),
        (("a", "b", "c", "d"), "`a`, `b`, `c` and `d`"),
        (("a", "b", "c", "d", "e", "f"), "`a`, `b`, `c`, `d` and 2 more"),
    ],
)
def test_list_names(names, expected):
    assert list_names(names) == expected


RULE = Rule(
    "lost-name",
    "api",
    "error",
    lambda: iter(()),
    texts={
        "removed": Text("`{subject}` was removed in {version}"),
        "moved": Text("`{subject}` was moved in {version}", help="use `{replacement}`"),
        "counted": Text("{count:,} uses of `{subject}`"),
    },
)


def of(target: str, kind="removed", doubts=(), **data):
    """A diagnostic of RULE on a target."""
    return "lost-name", target, Diagnostic(At("a.cpp", 1), "f", "p", data, kind, doubts)


# (diagnostics, message and help of each finding)
MERGED = [
    ([of("a", version="1"), of("b", version="1")], [("`f` was removed in 1", "")]),
    ([of("a", version="1"), of("b", version="2")], [("`f` was removed in 1 (a), 2 (b)", "")]),
    # another kind of fact on another target is told as well
    ([of("a", version="1"), of("b", "moved", version="2", replacement="g")],
     [("`f` was removed in 1 (a); `f` was moved in 2 (b)", "use `g`")]),
    # two facts about one target stay two
    ([of("a", version="1"), of("a", version="2")], [("`f` was removed in 1", ""), ("`f` was removed in 2", "")]),
    # twice the same fact is one
    ([of("a", version="1"), of("a", version="1")], [("`f` was removed in 1", "")]),
    # another severity is another finding
    ([of("a", version="1"), of("b", doubts=(Doubt.EXAMPLE,), version="1")],
     [("`f` was removed in 1", ""), ("`f` was removed in 1", "")]),
]  # fmt: skip


@pytest.mark.parametrize(("diagnostics", "expected"), MERGED)
def test_diagnostics_are_merged_by_their_data(diagnostics, expected):
    found = merge_diagnostics(diagnostics, targets=("a", "b"), rules={RULE.name: RULE}, line_text=lambda path, line: "")
    assert [(finding.message, finding.help) for finding in found] == expected


@pytest.mark.parametrize(
    ("usual", "doubts", "expected"),
    [
        ("error", (), "error"),
        ("error", (Doubt.CONDITIONAL,), "warning"),
        ("error", (Doubt.CONDITIONAL, Doubt.EXAMPLE), "note"),
        # doubts never raise what a rule is worth at most
        ("note", (Doubt.CONDITIONAL,), "note"),
        ("note", (), "note"),
    ],
)
def test_doubts_lower_the_usual_severity(usual, doubts, expected):
    rule = RULE._replace(severity=usual)
    assert rule.compute_severity(Diagnostic(None, "f", doubts=doubts)) == expected


@pytest.mark.parametrize(
    ("diagnostic", "complaint"),
    [
        (Diagnostic(None, "f", kind="added"), "no text for diagnostics of the kind `added`"),
        (Diagnostic(None, "f", kind="moved", data={"version": "1"}), "the data of `f` lacks replacement"),
        (Diagnostic(None, "f", kind="counted", data={"count": "many"}), "`f`: Cannot specify ','"),
    ],
)
def test_a_diagnostic_without_its_text_or_data_is_refused(diagnostic, complaint):
    with pytest.raises(ValueError, match=complaint):
        RULE.verify(diagnostic)


def test_every_template_of_every_rule_can_be_rendered():
    for rule in load_rules().values():
        for kind, text in rule.texts.items():
            names = re.findall(r"\{(\w+):[a-z ]{3,}\}", text.message + text.help)
            message, help = text.render([("", dict.fromkeys(text.fields, 1) | dict.fromkeys(names, ("x",)))])
            plain = re.sub(r"\$\{\w+\}", "", message + help)  # variables of CMake
            assert message and not set("{}") & set(plain), (rule.name, kind)
