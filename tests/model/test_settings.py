"""Parameters that files set for nodes of other packages: one file in, whose parameters it sets out."""

import pytest
from rosimpact.impact.facts.launch.flow import extract
from rosimpact.impact.facts.launch.parameter_files import extract as parameters
from rosimpact.impact.facts.words import list_words
from rosimpact.impact.model.settings import (
    NamedNode,
    Setting,
    list_launch_settings,
    list_named_nodes,
    list_settings,
    mentions_changing,
)
from rosimpact.impact.model.undeclared_parameters import means

CHANGING = {
    "old_rate": frozenset(("base_driver",)),
    "old_gain": frozenset(("path_follower", "base_driver")),
    "old_scale": frozenset(("path_follower",)),
}
DRIVE = """
controller_server:
  ros__parameters:
    old_rate: 20.0
    kept: 1
    FollowPath:
      plugin: "path_follower::Follower"
      old_gain: 0.5
      critics.old_scale: 2.0
    Other:
      plugin: "other_follower::Follower"
      old_gain: 0.5
"""
CONTROLLERS = """
/rover/controller_manager:
  ros__parameters:
    wheels: {type: base_driver/Wheels}
/rover/wheels:
  ros__parameters:
    gains:
      left: {old_gain: 1.0}
"""
TABLE = [
    (
        DRIVE,
        [
            ("old_rate", "", "", "controller_server", 4),
            ("old_gain", "path_follower", "path_follower::Follower", "controller_server", 8),
            ("critics.old_scale", "path_follower", "path_follower::Follower", "controller_server", 9),
        ],
    ),
    (CONTROLLERS, [("gains.left.old_gain", "base_driver", "base_driver/Wheels", "wheels", 8)]),
    ("/**:\n  ros__parameters:\n    old_rate: 1.0\n", []),  # every node's
    ("/**/base:\n  ros__parameters:\n    old_rate: 1.0\n", [("old_rate", "", "", "base", 3)]),
    ("/**:\n  base:\n    ros__parameters:\n      old_rate: 1.0\n", [("old_rate", "", "", "base", 4)]),
    ("ros__parameters:\n  old_rate: 1.0\n", []),
    ("base:\n  old_rate: 1.0\n", []),  # a file of ROS 1
    ("base:\n  ros__parameters:\n    kept: 1.0\n", []),
    ("base:\n  ros__parameters:\n    old_rate: {plugin: [\n", []),
    ("base:\n  ros__parameters: old_rate\n", []),
]


def nobody(name, packages):
    return None


@pytest.mark.parametrize(("text", "expected"), TABLE)
def test_what_a_file_of_parameters_sets(text, expected):
    found = list_settings(parameters(text), CHANGING, nobody)
    assert [(one.name, one.package, one.plugin, one.node, one.line) for one in found] == expected


def test_the_plugins_of_a_node_are_known_together():
    assert {one.others for one in list_settings(parameters(DRIVE), CHANGING, nobody)} == {
        ("other_follower", "path_follower")
    }


def test_a_launch_file_tells_whose_name_a_node_has():
    def named(name, packages):
        return NamedNode("base_driver", "driver", name) if (name, set(packages)) == ("base", {"base_driver"}) else None

    file = parameters(b"base:\n  ros__parameters:\n    old_rate: 1.0\n")
    assert list(list_settings(file, CHANGING, named)) == [
        Setting("old_rate", "base_driver", "", "driver", 3, value=1.0)
    ]


def test_a_name_that_another_package_has_is_not_guessed():
    text = b"base:\n  ros__parameters:\n    old_rate: 1.0\n"
    assert (
        list(list_settings(parameters(text), CHANGING, lambda name, packages: NamedNode("other", "driver", name))) == []
    )


PYTHON = b"""
from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer, Node
from launch_ros.descriptions import ComposableNode

def generate_launch_description():
    return LaunchDescription([
        Node(package='base_driver', executable='driver', name='base', parameters=[{'old_rate': 1.0, 'kept': 2}]),
        Node(package='other', executable='driver', parameters=[{'old_rate': 1.0}]),
        ComposableNodeContainer(
            package='rclcpp_components', executable='component_container', name='all', namespace='',
            composable_node_descriptions=[
                ComposableNode(
                    package='base_driver', plugin='base_driver::Driver', parameters=[{'a': {'old_gain': 1}}]
                ),
            ],
        ),
    ])
"""
XML = b"""<launch>
  <group>
    <node pkg="base_driver" exec="driver"><param name="a.old_gain" value="1"/><param name="kept" value="2"/></node>
  </group>
  <node pkg="base_driver" exec="$(var which)"><param name="old_rate" value="1"/></node>
</launch>
"""
ROS1 = b"""<launch>
  <node pkg="base_driver" type="driver" name="base"><param name="~old_rate" value="1"/></node>
</launch>
"""


@pytest.mark.parametrize(
    ("kind", "data", "expected"),
    [
        (
            "launch_python",
            PYTHON,
            [
                ("old_rate", "base_driver", "", "driver"),
                ("a.old_gain", "base_driver", "base_driver::Driver", ""),
            ],
        ),
        ("launch_xml", XML, [("a.old_gain", "base_driver", "", "driver")]),
        ("launch_xml", ROS1, [("old_rate", "base_driver", "", "driver")]),
    ],
)
def test_what_a_launch_file_sets(kind, data, expected):
    found = list_launch_settings(extract(data, kind), CHANGING)
    assert [(one.name, one.package, one.plugin, one.node) for one in found] == expected


def test_nodes_and_their_names():
    assert list(list_named_nodes(extract(PYTHON, "launch_python")))[:2] == [
        NamedNode("base_driver", "driver", "base"),
        NamedNode("other", "driver", "driver"),
    ]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"base_driver old_rate", True),
        (b"old_rate of other_driver", False),
        (b"base_driver new_rate", False),
        (b"\xff", False),
    ],
)
def test_files_worth_reading(data, expected):
    assert mentions_changing(set(list_words(data).split(' ')), CHANGING) is expected


@pytest.mark.parametrize(
    ("declared", "name", "of_plugin", "expected"),
    [
        ("rate", "rate", False, True),
        ("rate", "base.rate", False, False),
        ("base.rate", "base.rate", False, True),
        ("*.rate", "base.rate", False, True),
        ("*.rate", "a.b.rate", False, True),
        ("*.rate", "rate", False, False),
        ("*.rate", "rate", True, True),  # the plugin's own name stands for the star
        ("gains.*.i_clamp", "gains.wheel.i_clamp", False, True),
        ("gains.*.i_clamp", "gains.i_clamp", False, False),
        ("turbo/steps", "turbo.steps", False, True),
    ],
)
def test_what_a_declared_name_means(declared, name, of_plugin, expected):
    assert means(declared, name, of_plugin=of_plugin) is expected
