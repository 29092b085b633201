"""stale-binary: a built program or library needs a shared library, or something of one, that is gone.

What it does
    With `--install FOLDER`, reads the built files of an install space and reports shared libraries, and versions of
    their symbols, that this machine or a target does not have: what is left behind when an upgrade of the system
    replaces `libpcl_common.so.1.12` by `libpcl_common.so.1.13`, or when a file is built on a newer system than the one
    that is to run it. Reports C++ functions and classes that this machine's libraries of the same name have no longer,
    as after an update of ROS that changed a signature.

Why it breaks
    The loader stops the program before it begins: "error while loading shared libraries: libpcl_common.so.1.12: cannot
    open shared object file", "version `GLIBC_2.38' not found", or "undefined symbol: _ZN6rclcpp4Node...". A plugin
    fails when it is loaded.

Severity
    error: it is only said where it is sure. What cannot be known is counted in the coverage.

Example
    apt upgrade                              # brings PCL 1.13 for 1.12
    ros2 run nav2_costmap_2d nav2_costmap_2d # built before

Use instead
    colcon build --packages-select nav2_costmap_2d --cmake-clean-cache

Not reported
    Libraries that the install space or an underlay holds; those that some ROS package of a target may bring in; a
    library that lies outside of the folders that the loader searches, where a program may know of it; on this machine
    without ROS sourced, libraries without a version; on a target whose files are not known (DATA.md says which are),
    libraries whose version does not tell the name of their files; files built for another kind of machine; symbols
    without a version on a target, in C, or of a plugin where no library has others of the same class.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from ...model.build_order import build_order
from ...model.on_target import UnresolvedUse
from ..vocabulary import At, Diagnostic, TargetView, Text, rule

if TYPE_CHECKING:
    from ...model.install_space import Binary, InstallSpace
    from ...targets.machine.shared_libraries import SharedLibraries


class _Missing(NamedTuple):
    """What a file asks for in vain. subject: soname, version or symbol; library: the soname; there: what is there
    instead; symbols: how many more are lost with the symbol, -1 where it is none."""

    subject: str
    library: str
    there: str
    symbols: int = -1


_ASKED = "`{subject}`[[ of `{library}`]][[ and {symbols} more]], needed by {files},"
_HELP = "[[install `{debian}`, or ]]rebuild [[{rebuilt}]][[{ordered} in this order]]"


@rule(
    scope="install_space",
    texts={
        "symbol": Text(f"{_ASKED} is not found in any library that is loaded", _HELP),
        "missing": Text(f"{_ASKED} is not available on {{machine}}[[, which has `{{there}}`]]", _HELP),
    },
)
def stale_binary(view: TargetView, installed: InstallSpace, libraries: SharedLibraries):
    askers: dict[_Missing, dict[str, list[Binary]]] = {}
    for binary in installed.binaries:
        if libraries.machine and binary.elf.machine != libraries.machine:
            continue
        for missing in _find_missing(view, binary, installed, libraries):
            askers.setdefault(missing, {}).setdefault(binary.package, []).append(binary)
    stale = {package for by_package in askers.values() for package in by_package if package}
    order = {package: place for place, package in enumerate(build_order(view))} if len(stale) > 1 else {}
    # What is not in the workspace comes first.
    ordered = sorted(stale, key=lambda package: (order.get(package, -1), package))
    for missing, by_package in askers.items():
        packages = [package for package in ordered if package in by_package]
        for package, binaries in by_package.items():
            files = tuple(sorted(binary.path for binary in binaries))
            rebuilt = ", ".join(packages) or files[0]
            data = {
                "files": files,
                "library": missing.library if missing.library != missing.subject else "",
                "symbols": max(missing.symbols, 0) or "",
                "machine": libraries.name,
                "there": missing.there,
                "debian": libraries.find_package(missing.subject),
                "rebuilt": rebuilt if len(packages) < 2 else "",
                "ordered": rebuilt if len(packages) > 1 else "",
            }
            known = view.workspace.packages.get(package)  # what is not in the workspace has no manifest there
            at = At(known.linked.manifest_path if known is not None else f"{installed.label}/{files[0]}", 0)
            kind = "symbol" if missing.symbols >= 0 else "missing"
            yield Diagnostic(at, missing.subject, package, data, kind)


def _find_missing(
    view: TargetView, binary: Binary, installed: InstallSpace, libraries: SharedLibraries
) -> Iterator[_Missing]:
    needed = [soname for soname in binary.elf.needed if soname not in installed.libraries]
    absent = set()
    for soname in needed:
        there = libraries.has(soname, binary.elf, binary.folder)
        if there is None:
            view.unresolved.add(UnresolvedUse("", "shared library", soname))
        elif not there:
            absent.add(soname)
            yield _Missing(soname, soname, libraries.find_other(soname))
    for asked in binary.elf.asked:
        if asked.library in absent or asked.library not in needed:
            continue
        lacks = libraries.lacks(asked, binary.elf, binary.folder)
        if lacks:
            yield _Missing(lacks[-1].version, asked.library, lacks[-1].there)
    for lost in () if absent else libraries.find_lost_symbols(binary.elf, binary.folder, installed.places) or ():
        yield _Missing(lost.name, lost.library, "", lost.more)
