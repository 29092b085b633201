"""missing-own-header: a source uses a class of its package and does not include the header that has it.

What it does
    Reports compiled sources that define members of a class, or name it, where a header of the package is called like
    the class and defines it, and nothing that the source includes does.

Why it breaks
    The compiler does not know the class: "has not been declared".

Severity
    error where all that the source includes from elsewhere is known; warning otherwise, in tests, and under conditions
    that are not known.

Example
    #include <Eigen/Dense>                      // and no #include "tracker/pose_estimator.hpp"
    PoseEstimator::PoseEstimator() {}

Use instead
    #include "tracker/pose_estimator.hpp"

Not reported
    Classes that a file which the source includes announces; sources that another file includes, that open namespaces
    of other packages, that a precompiled header may reach, or that include what is not found under its path and is
    called like a header of the workspace.
"""

import posixpath

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule


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
        unknown = {posixpath.basename(p) for p in outward if not (view.is_standard(p) or view.find_header(p))}
        if view.applies(use.conditions) and unknown.isdisjoint(view.workspace.headers):
            doubts = (*list_place_doubts(view, use.role, use.conditions), Doubt.INCOMPLETE if unknown else None)
            data = {"header": package.strip_path(header).removeprefix("include/")}
            yield Diagnostic(use.at, use.text, package.name, data, doubts=doubts)
