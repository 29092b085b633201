"""undeclared-member: a method uses a member that its class does not declare.

What it does
    Reports names that end with an underscore, as names of members do, in methods that a source defines outside of their
    class, where neither the source, nor any file of the workspace that it includes, nor a package that it depends on
    declares something of this name.

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
    Sources that define classes themselves, or include something of which nothing is known; classes that are templates,
    or whose bases are, or are of a package of which nothing is known; where a base is of another package, names that
    are like none of the class, since a version of that package which was not read may have them.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .known_includes import is_known_include


@rule(
    severity="warning",
    texts=Text("`{subject}` is used, but `{owner}` does not declare it", "declare it, or correct its name"),
)
def undeclared_member(view: TargetView, package: Package):
    for use, bases, outward in package.linked.undeclared:
        if not view.applies(use.conditions) or not all(is_known_include(view, path) for path in outward):
            continue
        histories = [view.offers.find_history(name) for name in view.build_environment(package)]
        known = all(view.offers.find_history(base.partition("::")[0]) is not None for base in bases)
        if known and not any(history.has_declared(use.text) for history in histories if history is not None):
            doubts = list_place_doubts(view, use.role, use.conditions)
            yield Diagnostic(use.at, use.text, package.name, {"owner": use.shown}, doubts=doubts)
