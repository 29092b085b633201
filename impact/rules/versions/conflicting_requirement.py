"""conflicting-requirement: a Python requirement excludes the version of a library that the target has.

What it does
    Compares requirements in requirements.txt, setup.py, setup.cfg and pyproject.toml with the version of the same
    library that the target's platform packages, where ROS packages of the target use that one too.

Why it breaks
    pip installs another version beside the platform's, or cannot build it for the target's Python. What ROS packages
    were built with then meets a library that they do not fit: "module compiled using NumPy 1.x cannot be run in NumPy
    2", or a version that an import misses.

Severity
    warning; note in examples and tests.

Example
    numpy==1.21.5                               # Ubuntu noble has 1.26.4

Use instead
    numpy>=1.21

Not reported
    Libraries whose version on the platform is not known; libraries that nothing installs that the package declares, or,
    for a file of no package, that any package declares; requirements whose marker does not hold on the target.
"""

from collections.abc import Iterable, Iterator

from ...model.package import find_folder_role
from ...targets.platform import PYTHON_LIBRARIES
from ...targets.requirements import find_refused_library, normalize_name, read_requirement
from ..vocabulary import At, Diagnostic, TargetView, Text, list_place_doubts, rule


@rule(
    scope="target",
    severity="warning",
    preview=True,
    texts=Text(
        "`{requirement}` excludes {subject} {version}, which the target has",
        help="accept the version that the platform packages",
    ),
)
def conflicting_requirement(view: TargetView) -> Iterator[Diagnostic]:
    for package in view:
        installed = view.build_environment(package)
        yield from _list_conflicts(view, package.list_requirements(), installed, package.name, package.path)
    for path, file in view.workspace.outside.requirements.items():
        asked = ((At(path, one.line), one.text) for one in file.requirements)
        yield from _list_conflicts(view, asked, view.brought_to_workspace)


def _list_conflicts(
    view: TargetView, asked: Iterable[tuple[At, str]], installed: frozenset[str], package: str = "", folder: str = ""
) -> Iterator[Diagnostic]:
    for at, text in asked:
        requirement = read_requirement(text)
        version = find_refused_library(view.target, requirement) if requirement is not None else ""
        if requirement is None or not version:
            continue
        name = normalize_name(requirement.name)
        if installed.isdisjoint(view.target.find_keys(PYTHON_LIBRARIES[name])):
            continue
        role = find_folder_role(at.path[len(folder) :].lstrip("/")) or "run"
        data = {"requirement": f"{name}{requirement.specifier}", "version": version}
        yield Diagnostic(at, name, package, data, doubts=list_place_doubts(view, role))
