"""missing-own-header: a source uses a class of its package and does not include the header that has it.

What it does
    Reports compiled sources that define members of a class, or name it, where a header of the package is called like
    the class and defines it, and nothing that the source includes does.

Why it breaks
    The compiler does not know the class: "has not been declared".

Severity
    error; warning in tests, and under conditions that are not known.

Example
    #include <Eigen/Dense>                      // and no #include "tracker/pose_estimator.hpp"
    PoseEstimator::PoseEstimator() {}

Use instead
    #include "tracker/pose_estimator.hpp"

Not reported
    Classes that a file which the source includes announces; sources that another file includes, that open namespaces
    of other packages, that a precompiled header may reach, or that include something of which nothing is known.
"""

from ...model.package import normalise_stem
from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(
    texts=Text(
        "`{subject}` is used, but no included file declares it; `{header}` does",
        "include `{header}`",
    ),
)
def missing_own_header(view: TargetView, package: Package):
    if any(use.name == "target_precompile_headers" for use in package.build.uses):
        return
    for use, header, outward in package.linked.unincluded:
        stems = map(normalise_stem, outward)  # of a message, or in a folder that the build makes
        if view.applies(use.conditions) and use.text.lower() not in stems and all(_is_known(view, p) for p in outward):
            data = {"header": package.strip_path(header).removeprefix("include/")}
            doubts = list_place_doubts(view, use.role, use.conditions)
            yield Diagnostic(use.at, use.text, package.name, data, doubts=doubts)


def _is_known(view: TargetView, path: str) -> bool:
    """Whether an included header is of the compiler, of somebody else, or of an interface of the workspace."""
    owner, _, rest = path.partition("/")
    if owner in view.workspace.packages:
        return path in view.workspace.headers or view.workspace.is_interface_header(owner, rest)
    return not path.startswith(".") and bool(view.find_header(path))
