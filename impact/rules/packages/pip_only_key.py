"""pip-only-key: rosdep installs a declared key with pip alone, in a package that is released.

What it does
    Reports keys that rosdep resolves to packages of pip on the target, in packages that some distro has released.

Why it breaks
    bloom refuses to release the package, since a Debian package can depend on packages of the platform alone.

Severity
    warning, since building from source works; of several such keys of a package the first, and the rest are notes, as
    one is enough to keep it from being released, and where the distro has ended, into which nothing is released any
    more.

Example
    <exec_depend>python3-quaternion-pip</exec_depend>

Use instead
    A key that apt resolves; or leave it out, and treat the module as optional.

Not reported
    Packages that were never released.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, list_ended_doubts, rule
from .unresolved_names import list_unresolved

_ONCE = (Together("pip"),)


@rule(
    doubts=(Doubt.DISTURBS,),
    group="unresolvable-key",
    texts=Text(
        "rosdep installs `{subject}` with pip alone, so bloom cannot release `{package}` as a Debian package",
        "declare a key that apt resolves, or treat the module as optional",
    ),
)
def pip_only_key(view: TargetView, package: Package):
    if view.target.was_ever_released(package.name):
        for name, at, resolution in list_unresolved(view, package):
            if resolution is not None and resolution.manager == "pip":
                yield Diagnostic(at, name, package.name, doubts=list_ended_doubts(view), together=_ONCE)
