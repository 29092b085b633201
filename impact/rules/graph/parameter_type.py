"""parameter-type: a launch or parameter file sets a parameter to a value of another type than it is declared with.

What it does
    Compares the values that launch files, and the parameter files that they load, set for nodes with the types that the
    nodes declare. In ROS 2: by the default value, by the template argument or the named type of `declare_parameter`, or
    in a file of generate_parameter_library; in ROS 1: in a .cfg file of dynamic_reconfigure, for nodes in C++.

Why it breaks
    ROS 2 converts no type into another, also no integer into a double: declaring the parameter throws
    InvalidParameterTypeException, and the node stops. So it is from Galactic on; in Foxy, nodes in Python take any
    type. In ROS 1, dynamic_reconfigure leaves the value unread, and the node runs with its default.

Severity
    error in ROS 2; warning in ROS 1, which makes a number of one type into the other.

Example
    base_node:
      ros__parameters:
        max_speed: 1             # declare_parameter("max_speed", 0.5)

Use instead
    max_speed: 1.0

Not reported
    Parameters that are declared with dynamic_typing, with a descriptor that is not written out, or under a condition;
    values that are not known, and files that the launch file changes before they are loaded.
"""

from ..vocabulary import Text, Workspace, rule
from .refused_values import find_refused_values


@rule(
    scope="flow",
    severity="error",
    preview=True,
    texts={
        "refused": Text(
            "the parameter `{subject}` is set to {article} {given}, and `{program}` declares it as {declared} at "
            "{place}",
            help="{remedy}",
        ),
        "clamped": Text(
            "the parameter `{subject}` is set to {article} {given}, and dynamic_reconfigure does not read it for "
            "`{program}`, since it is declared as {declared} at {place}",
            help="{remedy}",
        ),
    },
)
def parameter_type(workspace: Workspace):
    return (found for refused, found in find_refused_values(workspace) if refused.is_type)
