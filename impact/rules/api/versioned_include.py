"""versioned-include: an include names the folder that a platform has for one version of a library.

What it does
    Reports paths such as `opencv4/opencv2/core.hpp`: the first folder is there where a platform packages this version
    of the library, and not where the library is older, newer or built from source.

Why it breaks
    The compiler stops with "No such file or directory" on a machine with another version, or one built from source.

Severity
    error where the target has another version; warning, once in a package, for the folder of the version that is there.

Example
    #include <opencv4/opencv2/core.hpp>

Use instead
    #include <opencv2/core.hpp>

Not reported
    Headers of the workspace itself; includes under a condition that excludes the target.
"""

from ...targets.providers.library import find_versioned_folder
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, list_place_doubts, rule

_INCLUDE = "[[include `{replacement}`]]"


@rule(
    group="removed-header",
    texts={
        "there": Text("`{folder}/` is where this platform installs {upstream} {version}; others may not", _INCLUDE),
        "other": Text("`{subject}` is not available with {upstream} {version}", _INCLUDE),
    },
)
def versioned_include(view: TargetView, package: Package):
    for include in package.linked.includes:
        path = include.path
        folder = find_versioned_folder(view.target, path)
        if folder is None or not view.applies(include.conditions) or view.workspace.provides_header(path):
            continue
        doubts = list_place_doubts(view, include.role, include.conditions)
        if not include.targets:
            doubts = (*doubts, Doubt.UNCOMPILED)
        data = {
            "upstream": folder.library,
            "version": folder.version,
            "folder": path.partition("/")[0],
            "replacement": folder.path,
        }
        one = Diagnostic(include.at, path, package.name, data, "other", doubts)
        if folder.there:
            one = one._replace(kind="there", doubts=(*doubts, Doubt.DISTURBS), together=(Together(path),))
        yield one
