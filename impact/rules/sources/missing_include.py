"""missing-include: a name is used and its header reaches the file only by luck.

What it does
    Reports names of Boost and of ROS packages (types, macros, and tf2's conversions) in files that do not include the
    header that offers them, when the headers that they do include stopped bringing it along;
    names of Boost that none of them brings, where some of them are Boost's; types of messages, services and actions,
    macros and types of much used ROS packages whose header none of them brings; and types of interfaces that another
    package of the workspace, which has interfaces alone, lacks.

Why it breaks
    Some other header brought it. The next version of a library stops including it, and the build fails on the machine
    that has that version.

Severity
    error when a source compiles the file, none of the headers that reach it there brings the name on the target, and
    all of them are known, or for a ROS package's name none of the others depends on that; warning in tests, under
    conditions, and in installed headers that only tests compile, or nothing; note where the contents of one of the
    headers are not known or it is known to announce the type, where no header ever brought a ROS package's name, for
    files that no source compiles, and for what lies ahead, in the newest distro.

Example
    tf2_ros::Buffer buffer;                     // and only transform_listener.h, which stopped bringing it in Galactic

Use instead
    #include <tf2_ros/buffer.h>

Not reported
    Names of the standard library, which missing-standard-include reports; names that a header which reaches the file
    may still bring; names of Boost in files that something unknown reaches; types that a file of the package announces
    itself; types of interfaces that the workspace has; other types of ROS packages that none of the headers ever
    brought, where the file has no variable of them; macros that a file of the workspace defines, or that macros alone
    use; packages with target_precompile_headers().
"""

from ..vocabulary import TargetView, Text, rule
from .lost_includes import LOST, find_missing_includes


@rule(
    preview=True,
    scope="target",
    texts={
        "dropped": Text(LOST + "which {by} {version}[[ of {horizon}]] no longer includes", "#include <{subject}>"),
        "never": Text(
            LOST + "and no included header includes it with {by} {version}[[ of {horizon}]]",
            "#include <{subject}>",
        ),
        "no interface": Text(
            "`{subject}` is used, but `{owner}` has no such interface, and no included header declares it",
            "define the interface, or use one that `{owner}` has",
        ),
    },
)
def missing_include(view: TargetView):
    yield from find_missing_includes(view, standard=False)
