"""misspelt-parameter: a launch or parameter file misspells the name of a parameter.

What it does
    Reports parameters that a launch file, or a parameter file it loads, sets for one node, that the node's code neither
    declares nor reads, and whose name differs from one of its parameters by a letter, a plural, an underscore, or upper
    and lower case. All parameters of the node have to be known.

Why it breaks
    The value has no effect, and the node runs with its default.

Example
    base_node:
      ros__parameters:
        max_sped: 0.5            # the node declares max_speed

Use instead
    max_speed: 0.5

Not reported
    Nodes that ask for parameters by prefix or by names that are not known, load plugins, or pass themselves to code
    outside of the workspace; values in a file's `/**`, which is for every node.
"""

from ..vocabulary import Text, Workspace, rule
from .unasked_parameters import find_unasked


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    group="unknown-parameter",
    texts=Text(
        "`{program}` does not declare or read the parameter `{subject}`",
        help="write `{replacement}`",
    ),
)
def misspelt_parameter(workspace: Workspace):
    return (found for found in find_unasked(workspace) if found.data["replacement"])
