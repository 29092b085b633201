"""parameter-range: a launch or parameter file sets a parameter to a value that its declaration excludes.

What it does
    Compares the values that launch files, and the parameter files that they load, set for nodes with what the nodes
    allow: the range of a ParameterDescriptor, the validators of generate_parameter_library, and in ROS 1 the smallest
    and largest value of a parameter of dynamic_reconfigure.

Why it breaks
    In ROS 2, declaring the parameter throws InvalidParameterValueException, and the node stops. In ROS 1, the server of
    dynamic_reconfigure moves the value to the nearest bound without a word, and the robot runs with that.

Severity
    error in ROS 2; warning in ROS 1.

Example
    base_node:
      ros__parameters:
        max_speed: 4.0           # descriptor.floating_point_range: from 0.0 to 2.0

Use instead
    max_speed: 2.0

Not reported
    Ranges that are not written out in numbers; parameters of dynamic_reconfigure whose server is in a namespace of its
    own.
"""

from ..vocabulary import Text, Workspace, rule
from .refused_values import find_refused_values


@rule(
    scope="flow",
    severity="error",
    preview=True,
    texts={
        "refused": Text(
            "the parameter `{subject}` is set to {value}, and `{program}` allows only values {broken} (at {place})",
            help="set a value {broken}",
        ),
        "clamped": Text(
            "the parameter `{subject}` is set to {value}, and dynamic_reconfigure changes it to a value {broken} for "
            "`{program}` (at {place})",
            help="set a value {broken}, or widen the range",
        ),
    },
)
def parameter_range(workspace: Workspace):
    return (found for refused, found in find_refused_values(workspace) if not refused.is_type)
