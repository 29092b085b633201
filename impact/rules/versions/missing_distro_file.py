"""missing-distro-file: a file that is chosen by ROS_DISTRO is not there for the target.

What it does
    Reports launch files and scripts that open a file named by the distro (`config/$ROS_DISTRO.yaml`), where the package
    has it for other distros, and not for the target.

Why it breaks
    The node or launch file that reads it stops: the file does not exist.

Severity
    error; warning where it is opened under a condition, or in a test.

Example
    params = os.path.join(share, "config", os.environ["ROS_DISTRO"] + ".yaml")      # with config/humble.yaml alone

Use instead
    A file for each distro that the package is for, or one that is right on all.

Not reported
    Files that ask whether a path exists; names that the package has for no distro.
"""

import re

from ...targets.changes import DISTROS
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

_DISTRO = "{distro}"


@rule(
    preview=True,
    texts=Text(
        "`{subject}` is chosen by ROS_DISTRO, but `{owner}` has it for {others} only", "add the file for {distro}"
    ),
)
def missing_distro_file(view: TargetView, package: Package):
    distro = view.target.distro
    for use in package.linked.references:
        reference = use.reference
        owner = view.workspace.packages.get(reference.package or package.name)
        if reference.kind != "distro file" or use.role not in ("build", "run", "test") or owner is None:
            continue
        first, *others = map(re.escape, reference.name.split(_DISTRO))
        rest = r"\1".join(others)
        end = re.compile(rf"(?:.*/)?{first}([a-z]+){rest}(?:\.in)?")
        files = (*owner.linked.files, *(path for path in owner.build.made))
        there = {found[1] for path in files if (found := end.fullmatch(path)) is not None and found[1] in DISTROS}
        if not there or distro in there:
            continue
        doubts = (*list_place_doubts(view, use.role), not reference.conditional or Doubt.CONDITIONAL)
        data = {"owner": owner.name, "others": ", ".join(sorted(there)), "distro": distro}
        yield Diagnostic(use.at, reference.name.replace(_DISTRO, distro), package.name, data, doubts=doubts)
