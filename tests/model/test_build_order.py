"""The build order of small workspaces: manifests in, names out."""

import pytest
from rosimpact.impact.analysis.session import Options, open_workspace
from rosimpact.impact.model.build_order import build_order

MANIFEST = """<package format="3"><name>{}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>{}
<export><build_type>ament_cmake</build_type></export></package>
"""


def depends(*names: str, tag: str = "depend", condition: str = "") -> str:
    attribute = f' condition="{condition}"' if condition else ""
    return "".join(f"<{tag}{attribute}>{name}</{tag}>" for name in names)


@pytest.mark.parametrize(
    ("packages", "expected"),
    [
        ({"b": "", "a": "", "c": ""}, "a b c"),
        ({"a": depends("b"), "b": depends("c"), "c": ""}, "c b a"),
        ({"a": depends("z", "rclcpp"), "m": "", "z": ""}, "m z a"),
        # What a dependency needs when it runs has to be there too; what the package itself needs when it runs, not.
        ({"a": depends("b"), "b": depends("z", tag="exec_depend"), "z": ""}, "b z a"),
        ({"a": depends("z", tag="exec_depend"), "z": ""}, "a z"),
        ({"a": depends("z", tag="test_depend"), "z": ""}, "z a"),
        ({"a": depends("z", condition="$ROS_DISTRO == humble"), "z": ""}, "a z"),
        ({"a": depends("z", condition="$ROS_DISTRO == jazzy"), "z": ""}, "z a"),
        ({"a": depends("types", tag="group_depend"), "z": depends("types", tag="member_of_group")}, "z a"),
        # A circle, and what needs it, comes last.
        ({"a": depends("b"), "b": depends("a"), "c": depends("a"), "d": ""}, "d a b c"),
    ],
)
def test_the_order(tmp_path, packages, expected):
    for name, body in packages.items():
        (tmp_path / "ws" / name).mkdir(parents=True)
        (tmp_path / "ws" / name / "package.xml").write_text(MANIFEST.format(name, body))
    with open_workspace(tmp_path / "ws", Options(targets=("jazzy",), cache=tmp_path / "cache")) as opened:
        assert build_order(opened.views[0]) == expected.split()
