"""misspelt-distro: a test compares ROS_DISTRO with a name that no distro has.

What it does
    Reports names in tests of ROS_DISTRO, in CMake, package.xml, Python and launch files, that are one slip of the
    keyboard away from the name of a distro.

Why it breaks
    The branch is taken on no machine: what it does for that distro is left out there.

Example
    if("$ENV{ROS_DISTRO}" STREQUAL "humbel")

Use instead
    if("$ENV{ROS_DISTRO}" STREQUAL "humble")

Not reported
    Names that are like that of no distro, which may be somebody's own.
"""

from collections.abc import Iterator

from ...facts.distro_branches import list_compared_words
from ...model.misspelling import SpellingIndex
from ...targets.distro.known import list_known_distros
from ..vocabulary import At, Diagnostic, Package, Text, Workspace, rule


@rule(
    scope="workspace",
    severity="warning",
    preview=True,
    texts=Text("no distro is called `{subject}`, which ROS_DISTRO is compared with", "did you mean `{alike}`?"),
)
def misspelt_distro(workspace: Workspace) -> Iterator[Diagnostic]:
    known = SpellingIndex(one.name for one in list_known_distros())
    for package in workspace:
        for name, at in _list_compared(package):
            alike = known.find_nearest(name)
            if name not in known.names and alike is not None:
                yield Diagnostic(at, name, package.name, {"alike": alike})


def _list_compared(package: Package) -> Iterator[tuple[str, At]]:
    yield from package.build.compared
    yield from package.linked.compared
    for dependency in package.linked.manifest.dependencies:
        for word in list_compared_words(dependency.condition) if dependency.condition else ():
            yield word, At(package.linked.manifest_path, dependency.line)
