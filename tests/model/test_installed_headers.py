"""What install rules copy, patterns included."""

import pytest
from rosimpact.impact.model.cmake.build import At, Install
from rosimpact.impact.model.cmake.installed import list_copied_files

FILES = ("p/include/p/a.h", "p/include/p/b.hpp", "p/include/p/detail/c.h", "p/src/d.h")


@pytest.mark.parametrize(
    ("items", "options", "places"),
    [
        (("p/include/",), {}, ["include/p/a.h", "include/p/b.hpp", "include/p/detail/c.h"]),
        (("p/include",), {}, ["include/include/p/a.h", "include/include/p/b.hpp", "include/include/p/detail/c.h"]),
        (("p/include/",), {"patterns": ("*.h",), "only": True}, ["include/p/a.h", "include/p/detail/c.h"]),
        (("p/include/",), {"patterns": ("*.hpp", "*.h"), "only": True},
         ["include/p/a.h", "include/p/b.hpp", "include/p/detail/c.h"]),
        (("p/include/",), {"patterns": ("!detail",)}, ["include/p/a.h", "include/p/b.hpp"]),
        (("p/include/",), {"patterns": ("!~\\.hpp$",)}, ["include/p/a.h", "include/p/detail/c.h"]),
        (("${X}",), {}, []),
    ],
)  # fmt: skip
def test_directories(items, options, places):
    rule = Install("directory", items, "include", At("p/CMakeLists.txt", 1), **options)
    assert [place for _, place in list_copied_files(rule, "include", FILES)] == places


def test_files_may_be_renamed():
    rule = Install("files", ("p/src/d.h",), "include/p", At("p/CMakeLists.txt", 1), rename="e.h")
    assert list(list_copied_files(rule, "include/p", FILES)) == [("p/src/d.h", "include/p/e.h")]
