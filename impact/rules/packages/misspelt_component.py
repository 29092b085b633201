"""misspelt-component: a component that find_package() is given is misspelt.

What it does
    Reports components that no known version of a library has, where one of the target's version is one edit or a
    different case away: `Widget` of Qt5, which has `Widgets`. Components are what has a configuration of its own beside
    the package's, else what its exported targets and pkg-config files are called.

Why it breaks
    CMake does not find the component: it stops, or the library of that name is not linked.

Severity
    error where the component is required and would have a configuration of its own; else warning.

Example
    find_package(Qt5 REQUIRED COMPONENTS Widget)

Use instead
    find_package(Qt5 REQUIRED COMPONENTS Widgets)

Not reported
    Components that are like none of the target's version; those that are misspelt on one of the other targets alone;
    packages that the workspace has itself.
"""

from ...model.misspelling import is_slip
from ..vocabulary import Diagnostic, Doubt, Package, Replace, TargetView, Text, rule

# Letters of a name: shorter ones are alike by chance.
_SHORTEST = 5


@rule(
    preview=True,
    texts=Text("{library}[[ {version}]] has no component `{subject}`", "write `{replacement}`"),
)
def misspelt_component(view: TargetView, package: Package):
    for found in package.build.found:
        if found.how != "find_package" or found.name in view.workspace.packages or not found.components:
            continue
        if view.workspace.find_modules.get(found.name):
            continue
        known = view.list_components(found.name)
        for name, at in found.components if known else ():
            if name in known or not view.applies(found.conditions):
                continue
            same = [each for each in known if each.lower() == name.lower()]
            # A letter before the others makes the name of another module: `xfeatures2d`, beside `features2d`.
            alike = (each for each in known if each[0] == name[0] and len(name) >= _SHORTEST and is_slip(each, name))
            near = same or list(alike)
            if len(near) != 1 or not known[near[0]]:
                continue
            doubts = (
                found.required or Doubt.OPTIONAL,
                view.is_sure(found.conditions) or Doubt.CONDITIONAL,
                bool(view.providers.list_configured_components(found.name)) or Doubt.DISTURBS,
            )
            data = {"library": found.name, "version": view.find_library_version(found.name), "replacement": near[0]}
            fix = (Replace(at.path, at.line, at.column, name, near[0]),)
            yield Diagnostic(at, name, package.name, data, doubts=doubts, fix=fix)
