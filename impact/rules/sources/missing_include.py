"""missing-include: a name is used and its header reaches the file only by luck.

What it does
    Reports names of the standard library, of Boost and of ROS packages (types, and tf2's conversions) in files that do
    not include the header that offers them, when the headers that they do include stopped bringing it along; names of
    Boost that none of them brings, where some of them are Boost's; and types of messages, services and actions whose
    header none of them brings.

Why it breaks
    Some other header brought it. The next compiler or library version stops including it, and the build fails on the
    machine that has that version.

Severity
    error when a source compiles the file, none of the headers that reach it there brings the name on the target, under
    the C++ standard in force, and all of them are known, or for a ROS package's name none of the others depends on
    that; warning when something else is not known, or is known to announce the type, and in installed headers that only
    tests compile, or nothing; note for files that no source compiles, and for what lies ahead, in the newest distro.

Example
    uint32_t width;                             // and no #include <cstdint>: GCC 13 stops here
    tf2_ros::Buffer buffer;                     // and only transform_listener.h, which stopped bringing it in Galactic

Use instead
    #include <cstdint>
    #include <tf2_ros/buffer.h>

Not reported
    Names that a header which reaches the file may still bring; names of the standard library and of Boost in files that
    something unknown reaches; types that a file of the package announces itself; types of the workspace's own
    interfaces; names of the standard library that packages found bring under a later C++ standard which they ask for;
    macros that a file of the workspace defines.
"""

import re
from typing import NamedTuple

from ...model.cmake.build import for_tests
from ...model.package import NeededHeader
from ...model.view import View
from ...targets.providers.includes import Machine, announced, offered
from ...targets.providers.message_headers import package_of, type_in
from ...targets.providers.standard import bit_of, named_by, offering, oldest
from ..fix_actions import Insert
from ..rule import Diagnostic, rule
from ..severity import Doubt, Together
from ..text import Text

# Headers that other ones include and that bring nothing: made of macros while a library is built, of the Apache
# Portable Runtime, which needs no other library, or of Boost, whose own headers are all known as far as they are there.
_GENERATED = re.compile(r"(?:_export|_config|visibility(?:_control)?|/export)\.h(?:pp)?$|^apr_?\w*\.h$|^boost/|@")
# Functions that packages add their own forms of.
_EXTENDED = frozenset({"tf2::toMsg", "tf2::fromMsg", "tf2::convert", "tf2::doTransform"})
# What compilers have for one processor.
_OF_PROCESSOR = re.compile(r"intrin(?:sics)?\.h$|^(?:altivec|msa|arm_\w+|builtins)\.h$")


_LOST = "`{name}` is used without `<{subject}>`, "


@rule(
    scope="target",
    severity="error",
    texts={
        "dropped": Text(_LOST + "which {by} {version}[[ of {horizon}]] no longer brings along", "#include <{subject}>"),
        "never": Text(
            _LOST + "and nothing that is included brings it along with {by} {version}[[ of {horizon}]]",
            "#include <{subject}>",
        ),
    },
)
def missing_include(view: View):
    # Macros that a file of the workspace defines, maybe where nothing else does.
    defined = frozenset().union(*(package.digest.defined for package in view.workspace))
    for package in view:
        reaches = {path: [view.outward(p) for p in found] for path, found in package.digest.reaches}
        reported, year = set(), view.language(package)
        built = {t.name for t in package.build.targets if t.kind != "test" and not for_tests(t.conditions)}
        compiled = {path for path, targets in package.digest.source_targets if built.intersection(targets)}
        offered_to_others = {path for path, _ in package.digest.source_targets}.intersection(
            package.digest.public_headers
        )
        for need in package.digest.needed_headers:
            if need.role == "aside" or need.name in defined or not view.active(need.conditions):
                continue
            reach = reaches[need.at.path]
            lost, now = _lost(view, need, reach, year, view.machine, view.earlier_machines), True
            if lost is None and view.later_machine is not None and view.later_active(need.conditions):
                lost, now = _lost(view, need, reach, year, view.later_machine, (view.machine,)), False
            if lost is None or (need.at.path, lost.header) in reported:
                continue
            if lost.plain and (asked := view.language_asked(package)) > year:
                # What packages from elsewhere ask for is looked up for the few that are left.
                machine, earlier = (
                    (view.machine, view.earlier_machines) if now else (view.later_machine, (view.machine,))
                )
                lost = _lost(view, need, reach, asked, machine, earlier) if machine is not None else None
                if lost is None:
                    continue
            here = now and (
                need.at.path in compiled
                or need.at.path in offered_to_others
                or (lost.sure and not lost.plain and need.at.path in package.digest.public_headers)
            )
            sure = (
                need.at.path in compiled and lost.sure and need.role == "build" and view.certain(need.conditions)
            )
            if lost.plain and not lost.once and not (sure and now):
                continue
            reported.add((need.at.path, lost.header))
            doubt = None if sure else Doubt.INCOMPLETE if here else Doubt.UNCOMPILED
            data = {"name": need.name, "by": lost.by, "version": lost.version, "horizon": "" if now else view.horizon}
            yield Diagnostic(
                need.at,
                lost.header,
                package.name,
                data,
                kind="dropped" if lost.once else "never",
                doubts=(Doubt.UPCOMING if sure and not now else doubt,),
                together=Together(lost.by, everywhere=True) if not now else None,
                fix=_included(view, package, need, lost.header) if lost.by == "gcc" else (),
            )


class _Lost(NamedTuple):
    """A header that nothing brings along. by, version: what did, or else whose it is; sure: all that is included is
    known; once: something did; plain: a name of the standard libraries."""

    header: str
    by: str
    version: str
    sure: bool
    once: bool
    plain: bool


def _lost(
    view: View,
    need: NeededHeader,
    reaches: list[tuple[frozenset[str], frozenset[str]]],
    year: int,
    machine: Machine,
    earlier: tuple[Machine, ...],
) -> _Lost | None:
    """What one of the sources that compile a file misses on a machine: what an earlier one brought along, or nothing
    ever did."""
    standard = bool(bit_of(need.name))
    if standard and not need.whole and need.name.startswith("std::"):
        return None  # a reference to a string or stream, which are announced everywhere
    headers = offering()[need.name] if standard else _offering(view, need.name)
    if not headers or not (
        machine.names(need.name) if standard else any(machine.includes(header) is not None for header in headers)
    ):
        return None
    wanted, best = frozenset(headers), None
    bits, made = machine.bits(wanted), type_in(need.name)
    # To a type that is announced, pointers may be made.
    pointed = 0 if need.whole or standard else machine.bits(announced(need.name))
    for reach, own in reaches:
        brought = machine.brings(need.name, reach, year) if standard else bits & machine.mask(reach)
        if brought or not wanted.isdisjoint(own):
            continue
        if need.name in _EXTENDED and any(package_of(header, machine.ros) is None for header in own):
            continue  # another package of the workspace may have added one
        outside = _outside(view, need.name, reach, machine)
        # Of what the workspace generates itself, all that it brings along reaches the file too.
        if outside is None or (made is not None and not machine.tells_all(reach - own)):
            continue
        if standard:
            dropped = _dropped_name(view, need.name, reach, year, machine, earlier)
            told = need.name.startswith("std::") and not outside and machine.gcc >= oldest()
            found = dropped or (("gcc", machine.version("gcc") or "") if told else None)
        else:
            dropped = _dropped(view, wanted, reach, machine, earlier)
            # Whose headers a platform library's bring, no table tells.
            told = made is not None or all(p.kind == "ros" for path in outside for p in view.header(path))
            found = dropped or (_never(need.name, headers, reach, machine) if told else None)
        if found is None or (best is not None and (best.sure or outside)):
            continue
        # Of what reaches the file and is not known, nothing depends on a ROS package whose name it is.
        known = not outside or not (standard or machine.of_library(headers[0]))
        sure = known and not pointed & machine.mask(reach)
        best = _Lost(headers[0], *found, sure, dropped is not None, standard)
    return best


def _offering(view: View, name: str) -> tuple[str, ...]:
    """The headers that offer a name, best first; none for types of interfaces that are the workspace's own, or not
    known on the target."""
    made = type_in(name)
    if made is None:
        return offered().get(name) or ()
    known = made.ros == view.target.ros and made.package not in view.workspace.packages
    return made.headers if known and view.machine.tells(made.headers[0]) else ()


def _never(name: str, offering: tuple[str, ...], reach: frozenset[str], machine: Machine) -> tuple[str, str] | None:
    """Whose a name is that nothing ever brought, and its version: a Boost library's, where a file includes some of its
    headers, or an interface's."""
    if (made := type_in(name)) is not None:
        version = machine.version(made.package)
        return (made.package, version) if version else None
    if not name.startswith(("boost::", "BOOST_")):
        return None
    owners = {owner for header in offering if (owner := machine.owner(header)) is not None}
    return next((owner for header in sorted(reach) if (owner := machine.owner(header)) in owners), None)


def _dropped(
    view: View, wanted: frozenset[str], reach: frozenset[str], machine: Machine, earlier: tuple[Machine, ...]
) -> tuple[str, str] | None:
    """Who brought one of the wanted headers along on the last earlier machine that had it, and its version by now."""
    for before in earlier:
        bits = before.bits(wanted)
        if not bits & before.mask(reach):
            continue
        for header in sorted(reach):
            if bits & before.mask(frozenset((header,))):
                if view.is_standard(header):
                    return "gcc", machine.version("gcc") or ""
                return machine.owner(header)
    return None


def _dropped_name(
    view: View, name: str, reach: frozenset[str], year: int, machine: Machine, earlier: tuple[Machine, ...]
) -> tuple[str, str] | None:
    """The same for a name of the standard libraries."""
    for before in earlier:
        if not before.names(name):
            continue
        for header in sorted(reach):
            if not before.brings(name, frozenset((header,)), year):
                continue
            still = machine.brought(header).standard
            if view.is_standard(header) or any((named_by(h, before.gcc, year) or 0) & bit_of(name) for h in still):
                return "gcc", machine.version("gcc") or ""
            return machine.owner(header)
    return None


def _outside(view: View, name: str, reach: frozenset[str], machine: Machine) -> list[str] | None:
    """Headers among those that reach a file of which nothing is known; None when one of them may well bring the name.

    Any that the file itself includes may bring a name of the standard library; one whose package depends on the name's
    may bring another.
    """
    outside = {
        path
        for path in machine.outside(reach)
        if not view.is_standard(path)
        and not _OF_PROCESSOR.search(path)
        and (path in reach or (view.header(path) and not _GENERATED.search(path)))
    }
    if bit_of(name):
        return None if outside & reach else sorted(outside)
    if (made := type_in(name)) is not None:
        owners = {made.package}
    else:
        owners = {owner[0] for header in offered()[name] if (owner := machine.owner(header)) is not None}
    for path in outside:
        around = view.around(path)
        if not around or (path in reach and machine.knows(path)) or not owners.isdisjoint(around):
            return None
    return sorted(outside)


def _included(view: View, package, need, header: str) -> tuple[Insert, ...]:
    """The cure that includes a header behind the standard C++ headers of the file that sort before it; nothing where it
    includes none outside of conditions."""
    standard = [
        i
        for i in package.digest.includes
        if i.at.path == need.at.path
        and i.at.line < need.at.line
        and not i.conditions
        and "." not in i.path
        and view.is_standard(i.path)
    ]
    before = [i for i in standard if i.path < header] or standard
    return (Insert(need.at.path, max(i.at.line for i in before), f"#include <{header}>"),) if before else ()
