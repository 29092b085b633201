"""removed-parameter: a parameter is set that the target's version of a node or plugin does not declare.

What it does
    Reports parameters that parameter files of ROS 2 and launch files set for nodes and plugins of released packages,
    that an earlier or later version of the package declares, and that the target's does not. Whose a parameter is, is
    told by the `plugin:` beside it, the `type:` that the controller manager has for the node, or the node's program.

Why it matters
    Most nodes ignore what they do not declare, without a word: the robot runs with the default.

Severity
    warning for the first of a package; note for the others.

Example
    progress_checker_plugin: "progress_checker"         # nav2_controller until Iron

Use instead
    progress_checker_plugins: ["progress_checker"]      # Jazzy and later

Not reported
    Names that no version declares; names that the sources of the target's version, or of what is installed with it,
    still mention; nodes and plugins of the workspace; names beside which the new one is set as well; values that hold
    without being set, by the default of the new name or of the removed parameter; tests, examples and files in folders
    that are called after another distro; parameter files of ROS 1.
"""

from ...model.undeclared_parameters import list_undeclared_parameters
from ...targets.evidence import make_offer_evidence
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .diagnosis import is_of_another_distro, make_version_together

_HELP = "[[set `{replacement}`]]"


@rule(
    severity="warning",
    texts={
        "removed": Text("the parameter `{subject}` is no longer declared by {upstream} {version}", _HELP),
        "not yet": Text(
            "the parameter `{subject}` is not declared by {upstream} {version}[[ (added in {since})]]", _HELP
        ),
    },
)
def removed_parameter(view: TargetView, package: Package):
    files = frozenset(package.linked.files)
    # What a reviewed row about a value says at the same place says more.
    explained = {(use.at.path, use.at.line) for use in package.linked.uses if use.language == "yaml"}
    for one in list_undeclared_parameters(view, package):
        at, offered = one.use.at, one.offered
        if (at.path, at.line) in explained or is_of_another_distro(view, at.path, files):
            continue
        data = {
            "upstream": offered.package,
            "version": offered.version,
            "since": "" if one.is_gone else offered.first,
            "replacement": one.instead,
        }
        yield Diagnostic(
            at, one.use.name, package.name, data, "removed" if one.is_gone else "not yet",
            evidence=make_offer_evidence(offered), together=make_version_together(offered.package),
        )  # fmt: skip
