"""From hits to findings: merging over targets, fingerprints, comparison, selection, suppression, baseline."""

import json
import time

import hypothesis
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.analysis.findings import (
    SettingsError,
    _reach,
    add_fingerprints,
    apply_settings,
    choose_rules,
    drop_outweighed,
    format_baseline,
    has_failures,
    lower_repeats,
    mark_new,
    matches_glob,
    merge_diagnostics,
    prune_baseline,
    read_baseline,
    split_by_baseline,
    suppress,
    verify_settings,
)
from rosimpact.impact.config import PathSetting
from rosimpact.impact.facts.place import Allow
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.rules.fix_actions import Edit
from rosimpact.impact.rules.rule import Diagnostic, Finding, Rule, group_rules, load_rules
from rosimpact.impact.rules.severity import Doubt, Together
from rosimpact.impact.rules.text import Text
from rosimpact.impact.targets.evidence_record import Evidence

TARGETS = ("humble", "jazzy", "rolling")
TEXTS = {"": Text("{message}[[ in tf2 {version}]]")}
RULES = {
    name: Rule(name, family, severity, lambda: iter(()), preview=preview, texts=TEXTS)
    for name, family, severity, preview in (
        ("removed-header", "api", "error", False),
        ("deprecated-name", "api", "note", True),
        ("undeclared-package", "packages", "error", False),
        ("unused-dependency", "packages", "note", False),
        ("unused-suppression", "sources", "note", False),
    )
}
# `lost-name` was a rule, and is three now; of `lost-header` nothing is left under its own name.
SPLIT = RULES | {
    name: Rule(name, "api", "error", lambda: iter(()), group=group, preview=preview, texts=TEXTS)
    for name, group, preview in (
        ("lost-name", "", False),
        ("lost-macro", "lost-name", False),
        ("lost-type", "lost-name", True),
        ("lost-c-header", "lost-header", False),
    )
}
FIX = (Edit("a.xml", 0, 0, "x"),)


def hit(message="gone", *, line=1, column=1, subject="x.h", path="a.cpp", version="", **rest) -> Diagnostic:
    return Diagnostic(At(path, line, column), subject, "p", {"message": message, "version": version}, **rest)


def merged(*hits, line_text=lambda path, line: f"line {line}", targets=TARGETS) -> list[Finding]:
    named = [(rule, target, each) for rule, target, each in hits]
    return merge_diagnostics(named, targets=targets, rules=RULES, line_text=line_text)


def brief(findings):
    return [(finding.severity, finding.line, finding.targets, finding.message) for finding in findings]


# (hits as (target, hit), what is found)
MERGED = [
    # one fact on all targets, asked order whatever order the hits come in
    ([("rolling", hit()), ("humble", hit()), ("jazzy", hit())], [("error", 1, TARGETS, "gone")]),
    # an empty target name stands for all
    ([("", hit())], [("error", 1, TARGETS, "gone")]),
    ([("", hit()), ("jazzy", hit())], [("error", 1, TARGETS, "gone")]),
    # the versions where they differ
    ([("jazzy", hit(version="0.36")), ("rolling", hit(version="0.41"))],
     [("error", 1, ("jazzy", "rolling"), "gone in tf2 0.36 (jazzy), 0.41 (rolling)")]),
    # another line, another subject, another severity: another finding
    ([("jazzy", hit()), ("rolling", hit(line=2))],
     [("error", 1, ("jazzy",), "gone"), ("error", 2, ("rolling",), "gone")]),
    ([("jazzy", hit(doubts=(Doubt.LATE,))), ("rolling", hit()), ("humble", hit(doubts=(Doubt.LATE,)))],
     [("error", 1, ("rolling",), "gone"), ("warning", 1, ("humble", "jazzy"), "gone")]),
    # what is still to come on one is not what broke on another
    ([("humble", hit("there, and gone", version="0.41", evidence=Evidence("tf2", "removed", ahead=True))),
      ("rolling", hit(version="0.41", evidence=Evidence("tf2", "removed")))],
     [("error", 1, ("rolling",), "gone in tf2 0.41"), ("error", 1, ("humble",), "there, and gone in tf2 0.41")]),
    # two things said of one target in one place stay two
    ([("jazzy", hit("one")), ("jazzy", hit("two"))],
     [("error", 1, ("jazzy",), "one"), ("error", 1, ("jazzy",), "two")]),
    # twice on one line is one finding
    ([("jazzy", hit(column=9)), ("jazzy", hit(column=20))], [("error", 1, ("jazzy",), "gone")]),
]  # fmt: skip


@pytest.mark.parametrize(("hits", "expected"), MERGED)
def test_merge(hits, expected):
    assert brief(merged(*(("removed-header", target, each) for target, each in hits))) == expected


@pytest.mark.parametrize(
    ("fixes", "expected"),
    [
        ({"humble": FIX, "jazzy": FIX, "rolling": FIX}, FIX),
        ({"": FIX}, FIX),
        ({"humble": FIX, "jazzy": FIX}, ()),
        ({"humble": FIX, "jazzy": FIX, "rolling": ()}, ()),
        ({"humble": FIX, "jazzy": FIX, "rolling": (Edit("a.xml", 1, 1, "x"),)}, ()),
    ],
)
def test_a_fix_is_kept_when_every_target_asked_for_yields_it(fixes, expected):
    (finding,) = merged(*(("removed-header", target, hit(fix=fix)) for target, fix in fixes.items()))
    assert finding.fix == expected


def test_a_fix_is_kept_where_it_is_right_without_a_hit():
    hits = [("removed-header", target, hit(fix=FIX)) for target in ("jazzy", "rolling")]
    asked = []

    def holds(fix, target):
        asked.append((fix, target))
        return target == "humble"

    options = {"rules": RULES, "line_text": lambda path, line: ""}
    assert merge_diagnostics(hits, targets=TARGETS, holds=holds, **options)[0].fix == FIX
    assert asked == [(FIX, "humble")]
    assert merge_diagnostics(hits, targets=(*TARGETS, "noetic"), holds=holds, **options)[0].fix == ()


def test_findings_come_in_file_order_and_a_hit_without_place_is_kept():
    findings = merged(
        ("removed-header", "", hit(path="b.cpp")),
        ("removed-header", "", hit(line=7)),
        ("unused-dependency", "", hit()._replace(at=None, subject="")),
    )
    assert [(finding.path, finding.line) for finding in findings] == [("", 0), ("a.cpp", 7), ("b.cpp", 1)]


def lines_of(text):
    rows = text.split("\n")
    return lambda path, line: rows[line - 1] if 0 < line <= len(rows) else ""


def test_fingerprints_stand_still_when_lines_move():
    before = merged(
        *(("removed-header", "", hit(line=line)) for line in (1, 2, 3)), line_text=lines_of("#include <x.h>\ny\ny")
    )
    after = merged(
        *(("removed-header", "", hit(line=line)) for line in (3, 6, 7)),
        line_text=lines_of("\n\n  #include   <x.h>\n\n\ny\ny"),
    )
    assert [finding.fingerprint for finding in before] == [finding.fingerprint for finding in after]
    assert len({finding.fingerprint for finding in before}) == 3, "equal lines are told apart"


@pytest.mark.parametrize("change", [{"path": "b.cpp"}, {"subject": "y.h"}, {"line": 2}])
def test_fingerprints_differ_with_what_they_identify(change):
    (first,) = merged(("removed-header", "", hit()))
    (second,) = merged(("removed-header", "", hit(**change)))
    assert first.fingerprint != second.fingerprint


# (rule, package, causes, doubts, severity when all come one after the other)
REPEATS = [
    ("removed-header", "p", (Together("late"),), (Doubt.LATE,), "warning"),
    ("removed-header", "q", (Together("late"),), (Doubt.LATE,), "warning"),
    ("removed-header", "p", (Together("late"),), (Doubt.EXAMPLE,), "note"),
    ("removed-header", "p", (Together("late"),), (), "error"),
    ("removed-header", "p", (Together("late"),), (Doubt.LATE,), "note"),
    ("undeclared-package", "p", (Together("late"),), (Doubt.LATE,), "warning"),
    ("removed-header", "p", (Together("other"),), (Doubt.LATE,), "warning"),
    ("removed-header", "p", (Together("new"), Together("other")), (Doubt.LATE,), "note"),
    ("removed-header", "p", (Together("new"),), (Doubt.LATE,), "note"),
    ("removed-header", "p", (Together("late", everywhere=True),), (Doubt.LATE,), "warning"),
    ("undeclared-package", "q", (Together("late", everywhere=True),), (Doubt.LATE,), "note"),
    ("removed-header", "q", (), (Doubt.LATE,), "warning"),
    ("removed-header", "q", (), (Doubt.LATE,), "warning"),
    ("removed-header", "q", (Together("few", few=2),), (Doubt.LATE,), "warning"),
    ("removed-header", "q", (Together("few", few=2),), (Doubt.LATE,), "warning"),
    ("removed-header", "r", (Together("few", few=2),), (Doubt.LATE,), "warning"),
    ("removed-header", "r", (Together("few", few=2),), (Doubt.LATE,), "note"),
    ("removed-header", "r", (Together("few", few=2),), (Doubt.LATE,), "note"),
]


def test_repeats_are_notes():
    diagnostics = [
        (rule, hit(line=line, doubts=doubts, together=together)._replace(package=package))
        for line, (rule, package, together, doubts, _) in enumerate(REPEATS)
    ]
    lowered = lower_repeats(diagnostics, RULES)
    assert [RULES[name].compute_severity(diagnostic) for name, diagnostic in lowered] == [row[-1] for row in REPEATS]
    found = merged(*((name, "jazzy", diagnostic) for name, diagnostic in lowered))
    assert [each.line for each in found if each.repeated] == [4, 7, 8, 10, 16, 17]


def test_a_warning_is_about_the_packages_whose_repeats_are_notes():
    same = (Together("no joystick", everywhere=True),)
    told = (
        ("removed-header", "p"), ("removed-header", "q"), ("undeclared-package", "r"), ("removed-header", "q"),
        ("removed-header", "p"),
    )  # fmt: skip
    diagnostics = [
        (rule, hit(line=line, doubts=(Doubt.LATE,), together=same)._replace(package=package))
        for line, (rule, package) in enumerate(told)
    ]
    lowered = lower_repeats(diagnostics, RULES)
    assert [diagnostic.also for _, diagnostic in lowered] == [("q",), (), (), (), ()]
    found = merged(*((name, "jazzy", diagnostic) for name, diagnostic in lowered))
    assert next(each for each in found if each.severity == "warning").packages == ("p", "q")


def test_what_another_rule_tells_of_the_same_place_with_more_weight_is_left_out():
    rules = {**RULES, "moved-header": RULES["removed-header"]._replace(yields_to=("removed-header",))}
    yielded = [
        ("moved-header", hit(line=1)),
        ("moved-header", hit(line=2)),
        ("removed-header", hit(line=1)),
        ("removed-header", hit(line=1)),  # the same twice
    ]
    kept = [(name, diagnostic.at.line) for name, diagnostic in drop_outweighed(yielded, rules)]
    assert kept == [("moved-header", 2), ("removed-header", 1)]


def test_rules_yield_to_rules_that_are_asked_with_them():
    rules = load_rules()
    for rule in rules.values():
        assert all(other in rules and rules[other].scope == rule.scope == "target" for other in rule.yields_to), rule


def test_a_fingerprint_does_not_depend_on_message_or_targets():
    (first,) = merged(("removed-header", "", hit()))
    (second,) = merged(("removed-header", "jazzy", hit("gone in 0.36")))
    assert first.fingerprint == second.fingerprint


def finding(
    rule="removed-header", *, path="a.cpp", line=1, severity="error", subject="x", targets=("jazzy",), mark="1"
):
    return Finding(rule, severity, "p", path, line, 1, subject, targets, "m", fingerprint=mark)


# (findings now, findings of the base, which are new)
COMPARED = [
    ([finding()], [], [True]),
    ([finding()], [finding()], [False]),
    ([finding(line=9)], [finding(line=1)], [False]),
    # the line was edited, the fact stayed
    ([finding(mark="2")], [finding(mark="1")], [False]),
    # the file was moved
    ([finding(mark="2", path="b.cpp")], [finding(mark="1")], [False]),
    # one more than before
    ([finding(mark="1"), finding(mark="2")], [finding(mark="1")], [False, True]),
    ([finding(mark="3"), finding(mark="1")], [finding(mark="1")], [True, False]),
    # worse than before, or on more targets
    ([finding()], [finding(severity="warning")], [True]),
    ([finding(severity="note")], [finding()], [False]),
    ([finding(targets=("humble", "jazzy"))], [finding()], [True]),
    ([finding()], [finding(targets=("humble", "jazzy"))], [False]),
    ([finding(subject="y", mark="2")], [finding()], [True]),
    # it was a note since another place was the warning, which is mended now
    ([finding(severity="warning")], [finding(severity="note")._replace(repeated=True)], [False]),
    ([finding()], [finding(severity="note")._replace(repeated=True)], [True]),
]


@pytest.mark.parametrize(("now", "base", "expected"), COMPARED)
def test_what_is_new_against_a_base(now, base, expected):
    assert [each.new for each in mark_new(now, base)] == expected


# (select, ignore, preview, rules that run)
CHOSEN = [
    ((), (), False, {"removed-header", "undeclared-package", "unused-dependency", "unused-suppression"}),
    ((), (), True, set(RULES)),
    (("packages",), (), False, {"undeclared-package", "unused-dependency"}),
    (("packages",), ("unused-dependency",), False, {"undeclared-package"}),
    (("removed-header",), ("api",), False, {"removed-header"}),
    (("api",), ("api",), True, set()),
    ((), ("all",), False, set()),
    (("unused-dependency",), ("all",), False, {"unused-dependency"}),
    (("deprecated-name",), (), False, {"deprecated-name"}),
    (("api",), (), False, {"removed-header"}),
]


@pytest.mark.parametrize(("select", "ignore", "preview", "expected"), CHOSEN)
def test_chosen(select, ignore, preview, expected):
    assert set(choose_rules(RULES, select=select, ignore=ignore, preview=preview)) == expected


# (select, ignore, preview, rules that run of those that were split)
CHOSEN_GROUPS = [
    ((), (), False, {"lost-name", "lost-macro", "lost-c-header"}),
    (("lost-name",), (), False, {"lost-name", "lost-macro", "lost-type"}),
    (("lost-header",), (), False, {"lost-c-header"}),
    ((), ("lost-name",), True, {"lost-c-header"}),
    # a rule's own name is more specific than that of its group, and that more than the family
    (("lost-macro",), ("lost-name",), False, {"lost-macro"}),
    (("lost-name",), ("lost-macro",), False, {"lost-name", "lost-type"}),
    (("lost-name",), ("api",), False, {"lost-name", "lost-macro", "lost-type"}),
    (("api",), ("lost-name",), False, {"lost-c-header"}),
]


@pytest.mark.parametrize(("select", "ignore", "preview", "expected"), CHOSEN_GROUPS)
def test_the_name_of_a_group_means_its_rules(select, ignore, preview, expected):
    found = choose_rules(SPLIT, select=select, ignore=ignore, preview=preview)
    assert {name for name in found if name.startswith("lost")} == expected


@pytest.mark.parametrize(
    ("severity", "expected"),
    [
        ({"lost-name": "note"}, ["note", "note", "error"]),
        ({"lost-name": "note", "lost-macro": "warning"}, ["note", "warning", "error"]),
        ({"lost-name": "warning", "api": "note"}, ["warning", "warning", "note"]),
        ({"lost-header": "off"}, ["error", "error"]),
    ],
)
def test_severities_of_groups(severity, expected):
    findings = [finding(rule) for rule in ("lost-name", "lost-macro", "lost-c-header")]
    settings = verify_settings([PathSetting("**", severity=severity)], SPLIT)
    assert [each.severity for each in apply_settings(findings, settings, SPLIT)] == expected


@pytest.mark.parametrize(
    ("name", "ran", "stay", "unused"),
    [
        ("lost-name", SPLIT, ["lost-c-header"], []),
        ("lost-macro", SPLIT, ["lost-name", "lost-c-header"], []),
        ("lost-header", SPLIT, ["lost-name", "lost-macro"], []),
        # no rule of the group ran, so that the comment cannot be called unused
        ("lost-header", ("lost-name",), ["lost-name"], []),
        ("lost-name", ("lost-type", "lost-c-header"), ["lost-c-header"], [("a.cpp", 1, "lost-name")]),
        ("lost-type", SPLIT, ["lost-name", "lost-macro", "lost-c-header"], [("a.cpp", 1, "lost-type")]),
    ],
)
def test_comments_that_name_a_group(name, ran, stay, unused):
    found = [finding(rule) for rule in ("lost-name", "lost-macro", "lost-c-header") if rule in ran]
    outcome = suppress(found, {"a.cpp": [Allow(1, (name,), False)]}, rules=SPLIT, ran=ran)
    assert [each.rule for each in outcome.kept] == stay
    assert outcome.unused == unused


def test_a_rule_that_was_split_keeps_its_fingerprints():
    def merged_as(rule, rules):
        found = merge_diagnostics([(rule, "", hit())], targets=(), rules=rules, line_text=lambda path, line: "x")
        return found[0].fingerprint

    assert merged_as("lost-macro", SPLIT) == merged_as("lost-name", SPLIT)
    names = ("lost-header", "lost-c-header")
    alone = {name: Rule(name, "api", "error", lambda: iter(()), texts=TEXTS) for name in names}
    assert merged_as("lost-c-header", SPLIT) == merged_as("lost-header", alone)
    assert merged_as("lost-c-header", SPLIT) != merged_as("lost-c-header", alone)


def test_a_rule_that_was_split_again_is_of_all_its_groups():
    rules = load_rules()
    split_again = ("unset-install-variable", "nonexistent-install", "missing-install")
    assert rules["unset-install-variable"].names == (*split_again, "packages")
    for name in split_again:
        assert "unset-install-variable" in choose_rules(rules, select=(name,))
    fingerprints = {
        merge_diagnostics(
            [(name, "", Diagnostic(At("a.cpp", 1, 1), "x", "p", kind=next(iter(rules[name].texts))))],
            targets=(),
            rules=rules,
            line_text=lambda path, line: "x",
        )[0].fingerprint
        for name in ("unset-install-variable", "nonexistent-install")
    }
    assert len(fingerprints) == 1


def test_groups_by_name():
    listed = {name: [rule.name for rule in members] for name, members in group_rules(SPLIT).items()}
    assert listed == {"lost-header": ["lost-c-header"], "lost-name": ["lost-name", "lost-macro", "lost-type"]}


def test_an_unknown_rule_is_named_with_the_nearest():
    with pytest.raises(SettingsError, match=r"`removed-headers`; did you mean `removed-header`\?"):
        choose_rules(RULES, select=("removed-headers",))


GLOBS = [
    ("src/vendor", "src/vendor/a/b.cpp", True),
    ("src/vendor/", "src/vendor/b.cpp", True),
    ("src/vendor", "src/vendored/b.cpp", False),
    ("src/*/test", "src/a/test/x.cpp", True),
    ("src/*/test", "src/a/b/test/x.cpp", False),
    ("src/**/test", "src/a/b/test/x.cpp", True),
    ("src/**/test", "src/test/x.cpp", True),
    ("**/*.launch", "a.launch", True),
    ("**/*.launch", "x/y/a.launch", True),
    ("*.launch", "x/a.launch", False),
    ("src/**", "src/a", True),
    ("**", "anything/at/all", True),
    ("a?.cpp", "ab.cpp", True),
    ("a?.cpp", "a/.cpp", False),
    ("[!a]*.cpp", "b.cpp", True),
    ("[!a]*.cpp", "a.cpp", False),
    ("a[b", "a[b", True),
    ("[b-a]", "[b-a]", True),
    ("[a-c].cpp", "b.cpp", True),
    ("a[!b]c", "a/c", False),
    ("./src", "src/a", True),
    ("a+(b)", "a+(b)", True),
]


@pytest.mark.parametrize(("glob", "path", "expected"), GLOBS)
def test_globs(glob, path, expected):
    assert matches_glob(glob, path) is expected


@given(st.text("ab/*?[]!.-^\\&", max_size=12), st.text("ab/.", max_size=8))
def test_any_glob_can_be_asked(glob, path):
    assert matches_glob(glob, path) in (True, False)


# (settings, severities of [removed-header in src/v, unused-dependency in src/v, removed-header in src/w])
SETTINGS = [
    ([], ["error", "note", "error"]),
    ([PathSetting("src/v", ignore=("all",))], ["error"]),
    ([PathSetting("src/v", ignore=("*",), select=("removed-header",))], ["error", "error"]),
    ([PathSetting("src/v", select=("packages",))], ["note", "error"]),
    ([PathSetting("src/v", severity={"api": "note"})], ["note", "note", "error"]),
    ([PathSetting("src/v", severity={"api": "note", "removed-header": "warning"})], ["warning", "note", "error"]),
    ([PathSetting("**", severity={"packages": "off"})], ["error", "error"]),
    ([PathSetting("**", severity={"api": "note"}), PathSetting("src/w", severity={"api": "error"})],
     ["note", "note", "error"]),
]  # fmt: skip


@pytest.mark.parametrize(("settings", "expected"), SETTINGS)
def test_settings_by_path(settings, expected):
    findings = [
        finding(path="src/v/a.cpp"),
        finding("unused-dependency", path="src/v/package.xml", severity="note"),
        finding(path="src/w/a.cpp"),
    ]
    assert [each.severity for each in apply_settings(findings, settings, RULES)] == expected


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        (PathSetting("src", ignore=("removed-heade",)), "did you mean `removed-header`"),
        (PathSetting("src", severity={"api": "fatal"}), "severity of `api` is `fatal`; write note"),
    ],
)
def test_settings_that_cannot_be_obeyed_are_named(setting, message):
    with pytest.raises(SettingsError, match=message) as error:
        verify_settings([setting], RULES)
    assert '[paths."src"]' in str(error.value)


# (comments of a.cpp, lines of findings that stay, comments without effect)
ALLOWED = [
    ([Allow(3, ("removed-header",), False)], [2, 4], []),
    ([Allow(2, ("removed-header",), True)], [4], []),
    ([Allow(3, ("api",), False)], [2, 4], []),
    ([Allow(3, ("*",), False)], [2, 4], []),
    ([Allow(3, ("unused-dependency",), False)], [2, 3, 4], [("a.cpp", 3, "unused-dependency")]),
    ([Allow(3, ("removed-header", "undeclared-package"), False)], [2, 4], [("a.cpp", 3, "undeclared-package")]),
    # a rule that did not run cannot have used its comment; a name that is no rule never will
    ([Allow(3, ("deprecated-name",), False)], [2, 3, 4], []),
    ([Allow(3, ("removed-heade",), False)], [2, 3, 4], [("a.cpp", 3, "removed-heade")]),
    # a block of comments reaches the line behind it
    ([Allow(1, ("removed-header",), True), Allow(2, ("undeclared-package",), True)], [2, 4],
     [("a.cpp", 2, "undeclared-package")]),
    # line 0: the whole file
    ([Allow(0, ("removed-header",), True)], [], []),
    ([], [2, 3, 4], []),
]  # fmt: skip


@pytest.mark.parametrize(("comments", "stay", "unused"), ALLOWED)
def test_suppression(comments, stay, unused):
    findings = [finding(line=line) for line in (2, 3, 4)]
    ran = {"removed-header", "undeclared-package", "unused-dependency"}
    outcome = suppress(findings, {"a.cpp": comments}, rules=RULES, ran=ran)
    assert [each.line for each in outcome.kept] == stay
    assert len(outcome.kept) + len(outcome.suppressed) == 3
    assert outcome.unused == unused


def test_a_comment_holds_for_its_own_file_only():
    outcome = suppress([finding()], {"b.cpp": [Allow(1, ("*",), False)]}, rules=RULES, ran=set(RULES))
    assert outcome.kept == [finding()]
    assert outcome.unused == [("b.cpp", 1, "*")]


def test_baseline_knows_by_content_and_count():
    old = [finding(mark="1"), finding(mark="1"), finding(mark="2")]
    known = read_baseline(format_baseline(old))
    now = [finding(mark="1", line=40), finding(mark="1"), finding(mark="1"), finding(mark="3")]
    fresh, seen = split_by_baseline(now, known)
    assert [each.fingerprint for each in fresh] == ["1", "3"]
    assert len(seen) == 2
    text, gone = prune_baseline(known, now)
    assert gone == 1
    assert read_baseline(text) == {"1": 2}, "what is fixed goes, what is new is not added"


def test_baseline_is_the_same_for_the_same_findings_in_any_order():
    findings = [finding(mark=str(mark), path=f"{mark % 3}.cpp\udcff") for mark in range(9)]
    text = format_baseline(findings)
    assert text == format_baseline(findings[::-1])
    assert json.loads(text.encode())["schema"] == 1


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "{}",
        "null",
        '{"schema": 2, "findings": []}',
        '{"schema": 1, "findings": [1]}',
        "[" * 9999,
        '{"schema": 1, "findings": [{"fingerprint": "a", "count": 1e999}]}',
        '{"schema": 1, "findings": [{"fingerprint": "a", "count": ' + "9" * 5000 + "}]}",
    ],
)
def test_what_is_no_baseline_is_refused_with_advice(text):
    with pytest.raises(SettingsError, match="baseline"):
        read_baseline(text)


@pytest.mark.parametrize(
    ("severity", "new", "fail_on", "expected"),
    [
        ("error", True, "error", True),
        ("warning", True, "error", False),
        ("warning", True, "warning", True),
        ("error", False, "note", False),
        ("note", True, "note", True),
        ("error", True, "never", False),
    ],
)
def test_fail_on(severity, new, fail_on, expected):
    assert has_failures([finding(severity=severity)._replace(new=new)], fail_on) is expected


def test_counts_of_a_baseline_have_a_limit():
    entries = ({"fingerprint": name, "count": count} for name, count in (("a", 10**4000), ("b", -3), ("c", 2)))
    known = read_baseline(json.dumps({"schema": 1, "findings": list(entries)}))
    assert known["a"] == 1_000_000 and known["b"] == 0 and known["c"] == 2
    assert prune_baseline(known, [])[1] == 1_000_002


def test_a_block_of_comments_is_walked_once():
    """The time of each comment does not grow with the block that it stands in."""
    most = 20_000
    comments = [Allow(line, ("x",), True) for line in range(1, most + 1)]
    started = time.process_time()
    reach = _reach(comments)
    assert time.process_time() - started < 2
    assert reach[most + 1] == {"x": (0, 1)}
    assert reach[5] == {"x": (4, 5)}


def test_a_long_line_with_many_findings_is_read_once():
    asked = []

    def line_text(path, line):
        asked.append((path, line))
        return "a " * 500_000

    found = [Finding("rule", "note", "p", "a.cpp", 1, column, f"name{column}", (), "") for column in range(1, 2_000)]
    started = time.process_time()
    prints = {finding.fingerprint for finding in add_fingerprints(found, line_text)}
    assert time.process_time() - started < 2
    assert asked == [("a.cpp", 1)]
    assert len(prints) == len(found)


_GLOB_PARTS = ["a", "b", "/", "*", "**", "**/", "/**", "?", "[ab]", "[!a]", "[z-a]", "."]


def _by_trying(glob: str, path: str) -> bool:
    """What a glob means, by trying all ways: slow, and short enough to be read."""
    if not glob:
        return not path or path[0] == "/"
    if glob == "/**":
        return path[:1] == "/"
    if glob.startswith("**/"):
        return any(_by_trying(glob[3:], path[at:]) for at in range(len(path) + 1) if not at or path[at - 1] == "/")
    if glob.startswith("**"):
        return any(_by_trying(glob[2:], path[at:]) for at in range(len(path) + 1))
    if glob[0] == "*":
        return any(_by_trying(glob[1:], path[at:]) for at in range(len(path) + 1) if "/" not in path[:at])
    if glob[:4] in ("[ab]", "[!a]"):
        fits = path[:1] in ("a", "b") if glob[1] == "a" else path[:1] not in ("", "a", "/")
        return fits and _by_trying(glob[4:], path[1:])
    return bool(path) and (path[0] == glob[0] or (glob[0] == "?" and path[0] != "/")) and _by_trying(glob[1:], path[1:])


@given(st.lists(st.sampled_from(_GLOB_PARTS), max_size=6).map("".join), st.text("ab/.z", max_size=8))
def test_a_glob_matches_what_trying_all_ways_matches(glob, path):
    odd = glob.startswith("./") or glob.endswith("/") or "***" in glob or "[z-a]" in glob
    hypothesis.assume(not odd)
    assert matches_glob(glob, path) is _by_trying(glob, path)


def test_no_glob_is_slow():
    assert not matches_glob("**/*a" * 400 + "b", "a/" * 400)
    assert matches_glob("**/*a" * 400, "a/" * 400 + "a")
