"""removed-header: an included header is not available on a target.

What it does
    Reports `#include` lines whose header the target's version of the providing package does not install: removed,
    renamed, or only added in a later version; headers of platform libraries that the newest distro no longer has;
    and generated headers whose interface the version lacks.

Why it breaks
    The compiler stops with "No such file or directory" on that developer's machine and nowhere else.

Severity
    error for compiled code that is not guarded, tests of ROS 2 included; warning for tests of ROS 1, for a path that is
    there where something exports the folder above (`x/x/y.h`), under CMake conditions that are not known, and for the
    first use of each package or library that goes with an update or on the newest distro's platform, or is deprecated
    and removed on the newest distro; note for its other uses, for examples, for installed headers that the package does
    not compile itself, and under other tests of the code itself.

Example
    #include <tf2_geometry_msgs/tf2_geometry_msgs.h>     // gone from tf2_geometry_msgs 0.36

Use instead
    #include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>   // there since 0.25

Not reported
    Includes under `#if __has_include(...)` or a version test that excludes the target; headers of the workspace itself;
    headers that no known package has, where something that the package depends on has unknown contents; generated
    headers of ROS 1 in a package that also includes ROS 1 headers, as bridges do; spellings that no version ever had
    (unknown-header reports them).
"""

from ...model.absent_headers import find_misspelt, is_bridge
from ...model.package import is_header
from ..vocabulary import Doubt, Package, TargetView, Text, rule
from .diagnosis import build_availability_texts, diagnose
from .included_headers import get_included_headers
from .interface_headers import find_interface_fault


@rule(
    texts={
        **build_availability_texts("include"),
        "broken": Text("no package of the workspace has or generates `{subject}`"),
        "platform": Text("no package of {upstream} has `{subject}`"),
        "nested": Text("`{subject}` is not installed by {upstream} {version}", "[[include `{replacement}`]]"),
    },
)
def removed_header(view: TargetView, package: Package):
    headers = get_included_headers(view)
    for include, doubts in headers.list_asked(package):
        path, at = include.path, include.at
        order = (not is_header(at.path), at.path, at.line)
        loss = headers.find_loss(package, include)
        if loss is not None:
            if loss.found is not None:
                if loss.kind == "nested":
                    doubts = (*doubts, Doubt.LUCKY)  # whatever exports the folder above brings this path too
                yield diagnose(
                    loss.found, at, path, package.name, doubts,
                    kind=loss.kind, fix=loss.fix, order=order if loss.ordered else (),
                )  # fmt: skip
            continue
        if find_misspelt(view, package, path, include.at.path) is not None:
            continue  # which unknown-header reports
        fault = find_interface_fault(view, path)
        found = fault.found if fault is not None else None
        if fault is None:
            headers.skip(path)
        elif found is not None and found.state == "upcoming":
            yield diagnose(found, at, path, package.name, doubts, order=order)
        elif found is not None and not is_bridge(view, package):
            yield diagnose(found, at, path, package.name, doubts)
