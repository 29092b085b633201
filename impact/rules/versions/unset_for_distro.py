"""unset-for-distro: something is given for some distros alone and used, or needed, on all.

What it does
    Reports names of Python and arguments of launch files in XML and YAML that the branches of tests of ROS_DISTRO set,
    none of which is for the target, where what follows uses the name whichever branch was taken; tables that are asked
    by ROS_DISTRO and have no entry for the target; and branches each of which starts something, where none is for the
    target.

Why it breaks
    Python raises a NameError, UnboundLocalError or KeyError, and launch reports an argument that does not exist: the
    launch file or program does not start. Where nothing is started, the rest of the system waits for it.

Severity
    error in files that are launched or run, at the top of the file or in generate_launch_description(); warning in
    other functions and in tests, for arguments that whoever starts the launch file may give, and where nothing is
    started.

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
    Tests that cannot be decided; names that are bound anywhere else; uses in a `try`, or that only some ways reach; a
    single branch that starts something, and elements of launch files that start things which have no name, package,
    program or file in common.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

_START = ("", "generate_launch_description")


@rule(
    preview=True,
    texts={
        "name": Text(
            "`{subject}` is used here, but no branch on ROS_DISTRO sets it in {distro}",
            "set it in a branch for {distro}",
        ),
        "key": Text(
            "`{subject}` is asked for ROS_DISTRO here, but has no entry for {distro}", "add an entry for {distro}"
        ),
        "start": Text(
            "nothing is started here in {distro}, since all branches on `{subject}` are for other distros",
            "add a branch for {distro}",
        ),
    },
)
def unset_for_distro(view: TargetView, package: Package):
    for use in package.linked.branched:
        if use.role not in ("build", "run", "test") or any(map(view.applies, use.branches)):
            continue
        sure = use.function in _START and use.kind != "start"
        doubts = (*list_place_doubts(view, use.role), sure or Doubt.LATE)
        yield Diagnostic(use.at, use.name, package.name, {"distro": view.target.distro}, use.kind, doubts)
