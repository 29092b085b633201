"""Renamed names, as two texts and what is proposed."""

import pytest
from one_way import compare
from rosimpact.impact.logic.guard_renames import propose_renames
from rosimpact.impact.model.flow.graph import GuardAt

CPP = """
class A {
  bool scan_ok_ = false;  // whether a scan came
  void onScan(const Scan & scan) { last_ = scan; scan_ok_ = true; }
  void onTimer() { if (scan_ok_ && count_ > 3) { pub_->publish(last_); } }
};
"""
PYTHON = """
class A:
    def __init__(self):
        self.scan_ok = False

    def on_scan(self, scan):
        self.scan_ok = True

    def on_timer(self):
        if self.scan_ok:
            self.pub.publish(self.last)
"""

CASES = [
    ("renamed", "cpp", CPP, CPP.replace("scan_ok_", "has_scan_"), {"scan_ok_": "has_scan_"}),
    (
        "renamed and laid out otherwise",
        "cpp",
        CPP,
        CPP.replace("scan_ok_", "has_scan_").replace("{ ", "{\n    ").replace("// whether", "// if"),
        {"scan_ok_": "has_scan_"},
    ),
    (
        "two at once",
        "cpp",
        CPP,
        CPP.replace("scan_ok_", "has_scan_").replace("last_", "scan_"),
        {"last_": "scan_", "scan_ok_": "has_scan_"},
    ),
    ("renamed", "python", PYTHON, PYTHON.replace("scan_ok", "ready"), {"scan_ok": "ready"}),
    ("nothing", "cpp", CPP, CPP, {}),
    ("nothing", "cpp", "", "", {}),
    ("another one is asked", "cpp", CPP, CPP.replace("if (scan_ok_", "if (map_ok_"), {}),
    ("what is asked is not made here", "cpp", "if (ok()) { f(ok()); }", "if (fine()) { f(fine()); }", {}),
    ("the old one is still there", "cpp", CPP, CPP.replace("scan_ok_", "has_scan_") + "bool scan_ok_;", {}),
    ("the new one was there before", "cpp", CPP + "int has_scan_;", CPP.replace("scan_ok_", "has_scan_"), {}),
    (
        "two became one",
        "cpp",
        "bool a; bool b; a = 1; b = 1; if (a) { f(); } if (b) { f(); }",
        "bool c; bool c; c = 1; c = 1; if (c) { f(); } if (c) { f(); }",
        {},
    ),
    (
        "one became two",
        "cpp",
        "bool a; a = 1; if (a) { f(); } a = 2; g(a);",
        "bool b; b = 1; if (b) { f(); } c = 2; g(c);",
        {},
    ),
    (
        "the text around it is another",
        "cpp",
        "bool a; a = read(port); if (a > 3) { f(); }",
        "bool b; b = listen(socket, 3); if (x && b == 4) { f(); }",
        {},
    ),
    ("in a text alone", "cpp", 'bool a; f("old"); f("old");', 'bool a; f("new"); f("new");', {}),
    ("in a comment alone", "python", "# old = 1\n# old\n", "# new = 1\n# new\n", {}),
]


@pytest.mark.parametrize(("name", "language", "old", "new", "renames"), CASES, ids=[case[0] for case in CASES])
def test_proposed(name, language, old, new, renames):
    assert propose_renames(old, new, language) == renames
    assert propose_renames(new, old, language) == {after: before for before, after in renames.items()}


def test_a_renamed_guard_is_the_same():
    old, new = (GuardAt("if", f"{name} && count_ > 3", "a.cpp", 5) for name in ("scan_ok_", "has_scan_"))
    renames = propose_renames(CPP, CPP.replace("scan_ok_", "has_scan_"), "cpp")
    assert compare([old], [new]) == "changed"
    assert compare([old], [new], renames) == "equivalent"
