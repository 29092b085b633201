"""unfound-vendored-library: a library is used whose vendor package no longer finds it.

What it does
    Reports vendor packages that CMake looks for and that, in the target's version, only tell where the configuration of
    their library is, where compiled code includes headers of the library and nothing else finds it.

Why it breaks
    The compiler misses the library's headers, or the linker the library.

Severity
    error; warning where CMake does not require the vendor package.

Example
    find_package(yaml_cpp_vendor REQUIRED)      # from 9.0.0 on it does not find yaml-cpp itself

Use instead
    find_package(yaml_cpp_vendor REQUIRED)
    find_package(yaml-cpp REQUIRED)

Not reported
    Libraries that may come along with another package that is found, or that a target is linked to by name.
"""

from ...targets.platform import strip_to_letters
from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

# Vendor packages that only tell CMake where the library's configuration is, from which version on: package, version,
# CMake package, how its include paths begin. Source: the vendor packages' `-extras.cmake.in`.
_PLACING = (("yaml_cpp_vendor", "9.0.0", "yaml-cpp", "yaml-cpp/"),)


@rule(
    group="missing-find-package",
    texts=Text(
        "`{header}` is included, but {vendor} {version} no longer finds `{subject}`",
        "add find_package({subject} REQUIRED) and link it",
    ),
)
def unfound_vendored_library(view: TargetView, package: Package):
    found = {f.name: f for f in package.build.found}
    for vendor, since, library, root in _PLACING if package.is_ros_cmake else ():
        version = view.target.find_version(vendor)
        asked = found.get(vendor)
        if asked is None or library in found or not version or not is_at_least(version, since):
            continue
        if any(strip_to_letters(link.item) == strip_to_letters(library) for link in package.build.target_links):
            continue
        use = next((i for i in package.linked.includes if i.path.startswith(root) and i.targets), None)
        if use is None or not view.is_sure(use.conditions):
            continue
        others = view.list_transitive(name for name in found if name != vendor)
        if vendor not in others and library not in others:  # it may come along with those
            data = {"header": use.path, "vendor": vendor, "version": version}
            yield Diagnostic(asked.at, library, package.name, data, doubts=(asked.required or Doubt.OPTIONAL,))
