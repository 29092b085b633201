"""Which of several classes of one name is meant: the nearest."""

import pytest
from joining import joined

GLOBAL, INSIDE = "class Talker {};", "namespace n { class Talker {}; }"


@pytest.mark.parametrize(("files", "scope", "meant"), [
    ({"a/main.cpp": GLOBAL, "a/b.cpp": INSIDE, "c/b.cpp": GLOBAL}, "", "a/main.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "c/b.cpp": GLOBAL}, "", "a/b.cpp"),
    ({"a/main.cpp": "", "c/b.cpp": GLOBAL}, "", "c/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "a/c.cpp": INSIDE}, "", None),
    # The file counts more than a namespace, and so does the package; the namespace decides within one.
    ({"a/main.cpp": GLOBAL, "a/b.cpp": INSIDE}, "n", "a/main.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": GLOBAL, "c/b.cpp": INSIDE}, "n", "a/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": INSIDE, "a/c.cpp": GLOBAL}, "n", "a/b.cpp"),
    ({"a/main.cpp": "", "a/b.cpp": INSIDE, "a/c.cpp": GLOBAL}, "other", None),
    ({"a/main.cpp": GLOBAL + INSIDE}, "n", "a/main.cpp"),
])  # fmt: skip
def test_the_nearest_class_is_meant(files, scope, meant):
    code = joined(files).code
    source = next(source for source in code.sources if source.path == "a/main.cpp")
    found = code.find_class("Talker", source, scope)
    assert (found and found.source.path) == meant
