"""incomplete-metapackage: a metapackage brings every package of its repository except one.

What it does
    Compares what a metapackage declares with the packages in the folders beside it.

Why it breaks
    Whoever installs the metapackage misses that package.

Example
    a metapackage `arm` that declares `arm_driver`, `arm_msgs` and `arm_description`, beside an `arm_control`

Use instead
    <exec_depend>arm_control</exec_depend>

Not reported
    Packages for tests, examples, demos or simulation by their names; metapackages that bring few of their neighbours;
    packages that another one of them brings.
"""

import posixpath
import re

from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule, translate_tag

# A metapackage that brings fewer packages says nothing of what it should.
_MEMBERS = 3
_APART = re.compile(
    r"(^|_)(tests?|testing|examples?|demos?|tutorials?|benchmarks?|experimental|data|dev|simulation|gazebo)(_|$)"
)


@rule(
    severity="warning",
    group="undeclared-package",
    texts=Text(
        "the metapackage `{package}` brings every package of its repository except `{subject}`",
        help="add `<{tag}>{subject}</{tag}>`, if that is not meant",
    ),
)
def incomplete_metapackage(view: TargetView, package: Package):
    if not package.manifest.metapackage:
        return
    declared = view.collect_declared(package)
    folder = posixpath.dirname(package.path)
    members = {p.name for p in view.list_built() if not p.manifest.metapackage and posixpath.dirname(p.path) == folder}
    missing = [name for name in members - declared.keys() if not _APART.search(name)]
    if len(missing) != 1 or len(members & declared.keys()) < _MEMBERS:
        return
    if missing[0] in view.list_transitive({package.name, *declared}):
        return
    data = {"tag": translate_tag("exec_depend", package.manifest.format)[0]}
    yield Diagnostic(At(package.linked.manifest_path, 1), missing[0], package.name, data)
