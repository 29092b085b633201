"""Facts of plugins in worlds, models and robot descriptions."""

import pytest
from rosimpact.impact.facts.gazebo import GazeboFile, GazeboPlugin, GazeboRemapping, extract


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ()),
        ("<robot><plugin name='a'/></robot>", ()),
        ("<robot><plugin filename='libb.so'/></robot>", (GazeboPlugin("libb.so", "", "", (), 1),)),
        ("<sdf>\n<plugin filename=' /opt/lib/libb.so ' name='a'/></sdf>", (GazeboPlugin("libb.so", "a", "", (), 2),)),
        ("<robot><plugin filename='${lib}' name='a'/></robot>", ()),
        (
            "<robot><plugin filename='libb.so' name='a'>\n<ros><namespace> /n </namespace>\n<remapping>a:=b</remapping>"
            "\n<remapping>c:=d</remapping></ros><remapping>e:=f</remapping></plugin>",
            (GazeboPlugin("libb.so", "a", "/n", (GazeboRemapping("a:=b", 3), GazeboRemapping("c:=d", 4)), 1),),
        ),
    ],
)  # fmt: skip
def test_plugins_of_a_file(text, expected):
    assert extract(text.encode()).plugins == expected


def test_what_cannot_be_read_is_a_problem():
    found = extract(b"<robot><plugin filename='libb.so'>")
    assert isinstance(found, GazeboFile)
    assert (len(found.plugins), len(found.problems)) == (1, 1)
