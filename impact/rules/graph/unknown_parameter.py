"""unknown-parameter: a launch or parameter file sets a parameter that the node never asks for.

What it does
    Reports parameters that a launch file, or a parameter file it loads, sets for one node, and that the node's code
    neither declares nor reads. All parameters of the node have to be known. In ROS 1, names are compared in full: one
    that is set for the node, and read in the namespace of the node, is not the same.

Why it breaks
    The value has no effect, and the node runs with its default: mostly the name is outdated.

Example
    base_node:
      ros__parameters:
        max_rpm: 900             # the node declares max_speed

Use instead
    max_speed: 0.5

Not reported
    Nodes that ask for parameters by prefix or by names that are not known, load plugins, or pass themselves to code
    outside of the workspace; files of parameters where the node reads files of YAML by itself; values in a file's
    `/**`, which is for every node; misspellings of a parameter of the node (misspelt-parameter).
"""

from ....edges.groups import group_pairs
from ..vocabulary import Text, Workspace, rule
from .unasked_parameters import find_unasked


@rule(
    scope="flow",
    severity="note",
    preview=True,
    texts={
        "one": Text(
            "`{program}` does not declare or read the parameter `{subject}`",
            help="remove it, or declare it in the node",
        ),
        "namespace": Text(
            "`{program}` reads the parameter `{read}`, and this sets `{full}`",
            help="set `{read}`, or read `{full}`",
        ),
        "several": Text(
            "`{program}` does not declare or read the parameter `{subject}` and {count} more that this line loads",
            help="remove them, or declare them in the node",
        ),
    },
)
def unknown_parameter(workspace: Workspace):
    unknown = (found for found in find_unasked(workspace) if not found.data["replacement"])
    for first, *others in group_pairs((found.at, found) for found in unknown).values():
        data = {**first.data, "count": len(others)}
        yield first._replace(data=data, kind="several" if others else first.kind or "one")
