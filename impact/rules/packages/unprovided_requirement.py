"""unprovided-requirement: a Python module that a package imports is listed for pip, and rosdep does not install it.

What it does
    Reports requirements in requirements.txt, setup.py, setup.cfg and pyproject.toml that the package imports by the
    same name, and that no rosdep key of the target installs, or none that package.xml declares.

Why it matters
    `rosdep install` leaves the module out without a word, so that the node stops with "No module named ..." on a clean
    machine.

Severity
    note: whether the machine has the module is not known.

Not reported
    Modules of another name than their package on PyPI; modules that are known to come with a package or key of the
    target (undeclared-package reports those).
"""

from collections.abc import Iterator

from ...targets.requirements import normalize_name, read_requirement
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule


@rule(
    severity="note",
    preview=True,
    texts={
        "no key": Text(
            "no rosdep key installs `{subject}`, which `{package}` imports, so `rosdep install` leaves it out",
            "install it with pip on every machine, or add a rule to `[workspace] rosdep_sources` in rosimpact.toml",
        ),
        "key": Text(
            "`{package}` imports `{subject}` and does not depend on `{replacement}`, so `rosdep install` leaves it out",
            "add `<exec_depend>{replacement}</exec_depend>` to package.xml",
        ),
    },
)
def unprovided_requirement(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    imported = {use.module.partition(".")[0] for use in package.linked.imports}
    by_name = {normalize_name(module): module for module in imported}
    reported: set[str] = set()
    for at, text in package.list_requirements():
        requirement = read_requirement(text)
        name = normalize_name(requirement.name) if requirement is not None else ""
        if requirement is None or name in reported or name not in by_name or view.find_module(by_name[name]):
            continue
        reported.add(name)
        keys = view.target.python_keys.get(name, ())
        if not keys:
            yield Diagnostic(at, requirement.name, package.name, kind="no key")
        elif view.build_environment(package).isdisjoint(keys):
            yield Diagnostic(at, requirement.name, package.name, {"replacement": keys[0]}, "key")
