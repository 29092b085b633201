"""The format of case files: what is read, what is refused, and how expected findings are written."""

from __future__ import annotations

import pytest
import rule_cases
from rosimpact.impact.tree import WorkingTree

TEXT = """# lost-rope

Targets: humble, jazzy

What a rope is.

```text deck/rope.txt
one
two

two
## three
```

```empty
deck/mark
```

## Nothing is reported

## A rope is cut

Targets: noetic

```diff deck/rope.txt
-one
 two
+new

@@
-## three
+## four
```

```findings
error deck/rope.txt:2 rope [noetic]
  `rope` is short
  help: take another
```

## A deck of its own

````cpp deck/deck.cpp
```
````

```removed
deck/mark
```

Other rules: long-rope, wet-rope
"""
ROPE = "one\ntwo\n\ntwo\n## three\n"


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "deck/lost_rope__cut.md"
    path.parent.mkdir()
    path.write_text(TEXT)
    return path


def test_a_file_is_read(file):
    plain, cut, deck = rule_cases.read_cases(file)
    assert (plain.rule, plain.family, plain.name) == ("lost-rope", "deck", "deck/lost_rope__cut: Nothing is reported")
    assert plain.unchanged == plain.files == {"deck/rope.txt": ROPE, "deck/mark": ""}
    assert (plain.targets, plain.findings) == (("humble", "jazzy"), ())
    assert (cut.targets, cut.unchanged) == (("noetic",), plain.files)
    assert (plain.asked, deck.asked) == (("lost-rope",), ("lost-rope", "long-rope", "wet-rope"))
    assert cut.files == {"deck/rope.txt": "two\nnew\n\ntwo\n## four\n", "deck/mark": ""}
    assert cut.findings == ("error deck/rope.txt:2 rope [noetic]", "  `rope` is short", "  help: take another")
    assert deck.files == {"deck/rope.txt": ROPE, "deck/deck.cpp": "```\n"}


@pytest.mark.parametrize(
    ("old", "new", "error"),
    [
        ("-one\n two\n+new\n\n", " two\n+new\n", ":25: the file has 2 places with `two`, not one"),
        ("-one\n", "-none\n", ":25: the file has 0 places with `none`, not one"),
        ("-one\n", "one\n", ":25: `one` begins with none of"),
        ("diff deck/rope.txt", "diff deck/rop.txt", ":25: there is no file `deck/rop.txt` to change"),
        ("```findings", "```finding", ":35: a block is"),
        ("```removed\ndeck/mark", "```removed\ndeck/marks", ":47: there is no file `deck/marks` to remove"),
        ("## A deck of its own", "## A rope is cut", "two sections have the same heading"),
        ("```text deck/rope.txt", "`````text deck/rope.txt", ":7: the block is not closed"),
    ],
)
def test_what_is_wrong_is_named(file, old, new, error):
    assert TEXT.count(old) == 1
    file.write_text(TEXT.replace(old, new))
    with pytest.raises(rule_cases.CaseError) as raised:
        rule_cases.read_cases(file)
    assert str(raised.value).startswith(str(file)) and error in str(raised.value)


@pytest.mark.parametrize("text", ["# lost-rope\n", "# lost-rope\n\n## Nothing\n", "```text a\nb\n```\n"])
def test_a_file_holds_a_workspace_and_a_section(file, text):
    file.write_text(text)
    with pytest.raises(rule_cases.CaseError, match="holds no"):
        rule_cases.read_cases(file)


NEW = ["warning deck/rope.txt:1 rope [jazzy]", "  `rope` is wet"]
WRITTEN = "\n```findings\nwarning deck/rope.txt:1 rope [jazzy]\n  `rope` is wet\n```\n"
OLD = TEXT[TEXT.index("\n```findings") : TEXT.index("\n## A deck")]


@pytest.mark.parametrize(
    ("at", "lines", "expected"),
    [
        (0, NEW, TEXT.replace("## Nothing is reported\n", f"## Nothing is reported\n{WRITTEN}")),
        (1, NEW, TEXT.replace(OLD, WRITTEN)),
        (1, [], TEXT.replace(OLD, "")),
        (2, NEW, TEXT + WRITTEN),
        (2, [], TEXT),
    ],
)
def test_findings_are_written(file, at, lines, expected):
    case = rule_cases.read_cases(file)[at]
    rule_cases.update_findings(case, lines)
    assert file.read_text() == expected
    assert rule_cases.read_cases(file)[at] == case._replace(findings=tuple(lines))


def test_details_that_a_case_leaves_out_are_not_compared():
    lines = ["error a:1 x [jazzy]", "  one", "error b:1 y [jazzy]", "  two", "  help: do", "note c:1 z []", "  three"]
    expected = ["error a:1 x [jazzy]", "error b:1 y [jazzy]", "  other"]
    assert rule_cases.leave_out_details(lines, expected) == ["error a:1 x [jazzy]", *lines[2:]]


def test_a_tree_of_texts_answers_as_a_folder_does(tmp_path):
    files = {"a/package.xml": "<package/>\n", "a/src/a.cpp": "", "b/COLCON_IGNORE": "", "b/c/d.cpp": "int d;\n"}
    memory, folder = rule_cases.MemoryTree(files), WorkingTree(rule_cases.write_files(tmp_path, files))
    assert memory.list_entries() == folder.list_entries()
    assert memory.skipped == folder.skipped
    for path in (*files, "a", "a/src", "a/no", "../a", ""):
        assert memory.exists(path) == folder.exists(path), path
        assert memory.is_dir(path) == folder.is_dir(path), path
    for path in files:
        assert memory.read_with_id(path) == folder.read_with_id(path)
    with pytest.raises(OSError):
        memory.read("a/no")
    with pytest.raises(OSError):
        memory.read("a/package.xml", 3)
