"""The table of constants of released packages, from small trees."""

from textwrap import dedent

from rosimpact.databuild.constants import build_table, read_constants
from rosimpact.impact.analysis.session import open_tree

PACKAGE = "<package format='3'><name>{}</name><version>1.0.0</version></package>"
FILES = {
    "nav_util/package.xml": PACKAGE.format("nav_util"),
    "nav_util/include/nav_util/names.hpp": """
        #define NAV_MAP "map"
        #define NAV_TEXT "no name at all"
        namespace nav_util {
        constexpr const char * kPlan = "plan";
        static const std::string kGoal{"~/goal"};
        const int kCount = 3;
        struct Names { static constexpr char SCAN[] = "/scan/raw"; std::string frame_ = "map"; };
        std::string changed = "plan";
        }
    """,
    "nav_util/src/inner.hpp": 'const char * kInner = "inner";\n',
    "nav_util/test/include/nav_util/test.hpp": 'const char * kTest = "test";\n',
    "nav_util/msg/Names.msg": """
        string SCAN=scan
        string<=10 ODOM = 'odom'
        string TEXT=what is it?
        int8 N=3
        string name
    """,
    "nav_names/package.xml": PACKAGE.format("nav_names"),
    "nav_names/nav_names/__init__.py": "PLAN = 'plan'\nTEXT = 'a text'\nchanged = 'plan'\n",
    "nav_names/nav_names/inner.py": "class Names:\n    MAP = 'map'\n",
    "nav_names/setup.py": "NAME = 'name'\n",
    "nav_names/scripts/tool.py": "TOOL = 'tool'\n",
    "other/package.xml": PACKAGE.format("other"),
    "other/include/other/names.hpp": 'const char * kOther = "other";\n',
}


def read(folder, files):
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(dedent(text).lstrip())
    return list(read_constants(open_tree(folder, ""), ["nav_util", "nav_names"], {}))


def test_constants_that_names_may_be(tmp_path):
    table = build_table(read(tmp_path, FILES))
    assert table.headers == {
        "nav_util/names.hpp": {
            "NAV_MAP": "map", "nav_util::Names::SCAN": "/scan/raw", "nav_util::kGoal": "~/goal",
            "nav_util::kPlan": "plan",
        }
    }  # fmt: skip
    assert table.modules == {"nav_names": {"PLAN": "plan"}, "nav_names.inner": {"Names.MAP": "map"}}
    assert table.messages == {"nav_util/Names": {"ODOM": "odom", "SCAN": "scan"}}


def test_what_two_versions_disagree_on_is_left_out(tmp_path):
    newer = {
        "nav_util/package.xml": FILES["nav_util/package.xml"],
        "nav_util/include/nav_util/names.hpp": '#define NAV_MAP "charts"\n#define NAV_NEW "fresh"\n',
    }
    table = build_table([*read(tmp_path / "old", FILES), *read(tmp_path / "new", newer)])
    assert "NAV_MAP" not in table.headers["nav_util/names.hpp"]
    assert table.headers["nav_util/names.hpp"]["NAV_NEW"] == "fresh"
    assert table.headers["nav_util/names.hpp"]["nav_util::kPlan"] == "plan"
