"""unknown-header: the path of an included header has a name that no package provides.

What it does
    Reports `#include` lines that no version of any package provides: spellings of generated headers that belong to the
    other ROS generation, or to C where rclcpp is used, in another case, or without their folder; generated headers
    whose interface no version of the package has, or another package of the workspace has; headers that no version of
    the released package has which they are called after, or that miss one of its headers by a letter; own headers with
    a letter, the case or the ending wrong; `<math>` for `<cmath>`; headers that no file of the workspace is called
    like, where all that the package declares and finds is known; configuration headers of dynamic_reconfigure below a
    name that no package has.

Why it breaks
    The compiler stops with "No such file or directory".

Severity
    error for compiled code that is not guarded, and for an installed header that includes what nobody has, so that
    nobody can compile it; warning for tests of ROS 1, under CMake conditions that are not known, for headers of C where
    nothing else brings the C++ types, and for headers that miss one of a package by a letter which makes others while
    it is built; note for examples, for other headers that the package does not compile
    itself, and under tests of the code itself.

Example
    #include <sensor_msgs/LaserScan.h>                  // in ROS 2

Use instead
    #include <sensor_msgs/msg/laser_scan.hpp>

Not reported
    Includes under `#if __has_include(...)`; ROS 1 names in a package that also includes ROS 1 headers, as bridges do;
    what a later or an earlier version has (removed-header reports it); headers of a released package whose list of
    headers is not completely known, which count as unresolved includes.
"""

from ...model.absent_headers import find_misspelt, find_never_installed, find_standard_header, is_bridge, is_nowhere
from ...model.package import IncludeUse
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .diagnosis import build_availability_texts, diagnose
from .included_headers import get_included_headers
from .interface_headers import TEXTS, collect_c_header_doubts, find_interface_fault


@rule(
    preview=True,
    group="removed-header",
    texts={
        **TEXTS,
        "never": build_availability_texts("include")["never"],
        "nowhere": Text(
            "no file of the workspace and no known package has `{subject}`", "include a header that is there, or add it"
        ),
        "standard": Text("the standard library has no header `{subject}`", "include `<{replacement}>`"),
        "misspelt": Text("no package has `{subject}`, but `{package}` has `{replacement}`", "include `{replacement}`"),
    },
)
def unknown_header(view: TargetView, package: Package):
    headers = get_included_headers(view)
    for include, doubts in headers.list_asked(package):
        path, at = include.path, include.at
        own, fault = find_misspelt(view, package, path, at.path), find_interface_fault(view, path)
        if own is None and fault is None:
            if (meant := find_standard_header(view, path)) is not None:
                yield Diagnostic(at, path, package.name, {"replacement": meant}, "standard", doubts)
            elif (never := find_never_installed(view, package, include)) is not None:
                loss = headers.find_loss(package, include)
                if loss is not None and loss.kind == "nested":
                    continue  # it is there under a folder above, as removed-header says
                if never.form == "never":
                    yield diagnose(never, at, path, package.name, doubts)
                else:
                    data = {"package": never.package, "replacement": never.alike}
                    yield diagnose(never, at, path, package.name, doubts, kind="misspelt", data={**data})
            elif view.guess_by_include(path):
                continue  # undeclared-package names the package that it is of
            elif is_nowhere(view, package, include) and headers.find_loss(package, include) is None:
                yield Diagnostic(at, path, package.name, {}, "nowhere", doubts)
            continue
        if headers.find_loss(package, include) is not None:
            continue
        if own is not None:
            doubts = _collect_misspelling_doubts(view, package, include)
            yield Diagnostic(at, path, package.name, {"replacement": own}, "misspelt", doubts)
        elif fault is not None and fault.kind == "c":
            of_c = collect_c_header_doubts(view, package, include)
            if of_c is not None:
                yield Diagnostic(at, path, package.name, fault.data, "c", of_c)
        elif fault is not None and fault.found is None and not is_bridge(view, package):
            if fault.kind == "never generated" and include.public and include.role != "aside":
                # Nobody can compile what is installed.
                doubts = () if view.is_sure(include.conditions) else (Doubt.GUARDED,)
            yield Diagnostic(at, path, package.name, fault.data, fault.kind, doubts)


def _collect_misspelling_doubts(view: TargetView, package: Package, include: IncludeUse) -> tuple[Doubt | bool, ...]:
    """Nobody can compile an installed header with it, nor the package itself where it does."""
    if include.role == "aside" or not (include.targets or include.public):
        return (Doubt.UNCOMPILED,)
    name = include.path.rpartition("/")[2]
    made = package.build.unresolved or any(path.rstrip("/").endswith(name) for path in package.build.made)
    return (not made or Doubt.INCOMPLETE, view.is_sure(include.conditions) or Doubt.GUARDED)
