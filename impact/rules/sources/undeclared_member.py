"""undeclared-member: a source uses a member that its class does not declare, or a value or function that nothing does.

What it does
    Reports names that end with an underscore, as names of members do, in methods that a source defines outside of their
    class, values whose names are several words, and functions of the package's namespace, where neither the source, nor
    any file of the workspace that it includes, nor a package that it depends on declares something of this name.

Why it breaks
    The compiler stops: "was not declared in this scope".

Severity
    warning, since a macro may leave out what it is given, as assertions do; note under conditions of the code that are
    not known.

Example
    class Tracker : public rclcpp::Node { void publish(); Publisher::SharedPtr pub_odom_; };
    void Tracker::publish() { pub_odometry_->publish(message); }

Use instead
    void Tracker::publish() { pub_odom_->publish(message); }

Not reported
    Sources that include something of which nothing is known, and members in those that define classes themselves;
    classes that are templates, or whose bases are, or are of a package of which nothing is known; where a base is of
    another package, members whose names are like none of the class, since a version of that package which was not read
    may have them; other functions, types, and what a macro is given.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .known_includes import is_known_include


@rule(
    severity="warning",
    preview=True,
    texts={
        "member": Text("`{subject}` is used, but `{owner}` does not declare it", "declare it, or correct its name"),
        "value": Text("`{subject}` is used, but nothing declares it", "declare it, or correct its name"),
    },
)
def undeclared_member(view: TargetView, package: Package):
    for use, bases, outward in package.linked.undeclared:
        kind = "member" if use.text.endswith("_") else "value"
        # What is declared beside functions and members has namespaces in packages of ROS.
        unsure = [path for path in outward if not is_known_include(view, path)]
        if kind == "value" and "::" not in use.text:
            unsure = [path for path in unsure if path.partition("/")[0] not in package.declared]
            # Names of C libraries begin as these are called.
            unsure += [path for path in outward if use.text.partition("_")[0] in path.lower()]
        if unsure or not view.applies(use.conditions):
            continue
        histories = [view.offers.find_history(name) for name in view.build_environment(package)]
        known = all(view.offers.find_history(base.partition("::")[0]) is not None for base in bases)
        last = use.text.rpartition("::")[2]
        if known and not any(history.has_declared(last) for history in histories if history is not None):
            doubts = list_place_doubts(view, use.role, use.conditions)
            yield Diagnostic(use.at, use.text, package.name, {"owner": use.shown}, kind, doubts)
