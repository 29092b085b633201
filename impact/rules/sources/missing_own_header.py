"""missing-own-header: a source uses a class of its package and does not include the header that has it.

What it does
    Reports compiled sources that define members of a class, or name it, where a header of the package is called like
    the class and defines it, and nothing that the source includes does.

Why it breaks
    The compiler does not know the class: "has not been declared".

Severity
    warning, since another class of that name may be meant.

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
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule
from .known_includes import is_known_include


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
        if not view.applies(use.conditions) or use.text.lower() in stems:
            continue
        if all(is_known_include(view, path) for path in outward):
            data = {"header": package.strip_path(header).removeprefix("include/")}
            doubts = (*list_place_doubts(view, use.role, use.conditions), Doubt.AMBIGUOUS)
            yield Diagnostic(use.at, use.text, package.name, data, doubts=doubts)
