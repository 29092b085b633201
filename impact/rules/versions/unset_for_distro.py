"""unset-for-distro: a Python name is set for some distros alone and used on all.

What it does
    Reports names that the branches of one `if` on ROS_DISTRO set, none of which is for the target, where the code
    behind them uses the name whichever branch was taken.

Why it breaks
    Python raises a NameError or UnboundLocalError: the launch file or program does not start.

Severity
    error in files that are launched or run, at the top of the file or in generate_launch_description(); warning in
    other functions and in tests.

Example
    if os.environ["ROS_DISTRO"] == "humble":
        package = "gazebo_ros"
    elif os.environ["ROS_DISTRO"] == "foxy":
        package = "gazebo_ros_pkgs"
    return LaunchDescription([Node(package=package, executable="spawn_entity.py")])

Use instead
    else:
        package = "ros_gz_sim"

Not reported
    Tests that cannot be decided; names that are bound anywhere else; uses in a `try`, or that only some ways reach.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

_START = ("", "generate_launch_description")


@rule(
    preview=True,
    texts=Text(
        "`{subject}` is used here, but no branch on ROS_DISTRO sets it in {distro}", "set it in a branch for {distro}"
    ),
)
def unset_for_distro(view: TargetView, package: Package):
    for use in package.linked.branched:
        if use.role not in ("build", "run", "test") or any(map(view.applies, use.branches)):
            continue
        doubts = (*list_place_doubts(view, use.role), use.function in _START or Doubt.LATE)
        yield Diagnostic(use.at, use.name, package.name, {"distro": view.target.distro}, doubts=doubts)
