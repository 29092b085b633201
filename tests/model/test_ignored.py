"""Which paths git ignores, after gitignore(5)."""

import pytest
from rosimpact.impact.facts.gitignore import extract
from rosimpact.impact.model.ignored import holds_ignored, is_ignored


@pytest.mark.parametrize(
    ("patterns", "path", "ignored"),
    [
        ("template", "pkg/template", True),
        ("template/", "pkg/template/a.yaml", True),
        ("/template", "pkg/template", False),  # anchored at the file's own folder
        ("/pkg/template", "pkg/template", True),
        ("pkg/*.yaml", "pkg/a.yaml", True),
        ("pkg/*.yaml", "pkg/sub/a.yaml", False),
        ("pkg/**/a.yaml", "pkg/one/two/a.yaml", True),
        ("*.yaml\n!keep.yaml", "pkg/keep.yaml", False),
        ("data[0-9]", "pkg/data1", True),
        ("# template", "pkg/template", False),
        ("temp", "pkg/template", False),
    ],
)
def test_patterns(patterns, path, ignored):
    assert is_ignored(path, [("", extract(patterns.encode()).patterns)]) is ignored


def test_a_file_further_down_counts_from_its_folder():
    assert is_ignored("pkg/data/a.bin", [("", ()), ("pkg", ("/data",))])


@pytest.mark.parametrize(
    ("pattern", "folder", "holds"),
    [
        ("template/*png", "pkg/template", True),
        ("/template/a/b.xml", "pkg/template", True),
        ("template/*png", "pkg/templates", False),
        ("!template/*png", "pkg/template", False),
        ("*.png", "pkg/template", False),
    ],
)
def test_folders_that_hold_ignored_files(pattern, folder, holds):
    assert holds_ignored(folder, [("", ()), ("pkg", (pattern,))]) is holds
