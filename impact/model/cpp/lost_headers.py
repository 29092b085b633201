"""Headers that bring a name which a file uses, where nothing that the file includes brings it.

Whether an include brings a name is asked of a Machine, which knows what headers of the standard libraries, of Boost, of
platform libraries, of released packages and of generated interfaces include in a version. Of names that were brought
along by an earlier version it is known who brought them.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from ....edges.memory import cache_method
from ...targets.providers.includes import HeadersOfMachine, is_called_after, list_announcing_headers, load_offered
from ...targets.providers.message_headers import find_package, parse_type
from ...targets.providers.standard import find_named, find_oldest_gcc, get_bit, index_headers

if TYPE_CHECKING:
    from ..package import NeededHeader
    from ..view import TargetView
    from ..workspace import Package

# Headers that other ones include and that bring nothing: made of macros while a library is built, of the Apache
# Portable Runtime, which needs no other library, or of Boost, whose own headers are all known as far as they are there.
_GENERATED = re.compile(r"_config\.h(?:pp)?$|^apr_?\w*\.h$|^boost/|@")
# Headers that CMake writes for the linker (generate_export_header()): they include nothing.
_OF_LINKER = re.compile(r"(?:_export|visibility(?:_control)?|/export)\.h(?:pp)?$")
# Functions that packages add their own forms of.
_EXTENDED = frozenset({"tf2::toMsg", "tf2::fromMsg", "tf2::convert", "tf2::doTransform"})
# What compilers have for one processor.
_OF_PROCESSOR = re.compile(r"intrin(?:sics)?\.h$|^(?:altivec|msa|arm_\w+|builtins)\.h$")

_Reach = tuple[frozenset[str], frozenset[str]]


class LostHeader(NamedTuple):
    """A header that nothing brings along to a file which uses one of its names. by, version: what did, or else whose it
    is. sure: all that is included is known. once: something did. standard: it is one of the standard libraries. now:
    on the target, else on the newest distro."""

    header: str
    by: str
    version: str
    sure: bool
    once: bool
    standard: bool
    now: bool


class _Times(NamedTuple):
    """A machine that is asked about and those before it. now: it is the target's."""

    machine: HeadersOfMachine
    earlier: tuple[HeadersOfMachine, ...]
    now: bool


class LostHeaders:
    """The headers that files of one package lack."""

    def __init__(self, view: TargetView, package: Package):
        self._view = view
        self._package = package
        self._reaches = {path: [view.find_outward(p) for p in found] for path, found in package.linked.reaches}
        self._year = view.compute_language(package)

    @cache_method
    def _find_year_asked(self, now: bool) -> int:
        """The C++ standard that packages from elsewhere ask for, looked up for the few that need it."""
        offers = self._view.offers if now else self._view.later_offers
        return self._view.compute_asked_language(self._package, offers)

    def find(self, need: NeededHeader) -> LostHeader | None:
        """The header that a use of a name lacks on the target or, where it lacks none, on the newest distro."""
        for times in self._list_times(need):
            lost = _find_lost(self._view, need, self._reaches[need.at.path], self._year, times)
            if lost is not None and lost.standard and (asked := self._find_year_asked(times.now)) > self._year:
                return _find_lost(self._view, need, self._reaches[need.at.path], asked, times)
            if lost is not None:
                return lost
        return None

    def _list_times(self, need: NeededHeader) -> list[_Times]:
        view = self._view
        times = [_Times(view.machine, view.earlier_machines, True)]
        if view.later_machine is not None and view.is_active_later(need.conditions):
            times.append(_Times(view.later_machine, (view.machine,), False))
        return times


def _find_lost(
    view: TargetView, need: NeededHeader, reaches: list[_Reach], year: int, times: _Times
) -> LostHeader | None:
    """What one of the sources that compile a file misses on a machine: what an earlier one brought along, or nothing
    ever did. year: of the C++ standard."""
    machine, earlier = times.machine, times.earlier
    standard = bool(get_bit(need.name))
    if standard and not need.whole and need.name.startswith("std::"):
        return None  # a reference to a string or stream, which are announced everywhere
    headers = index_headers()[need.name] if standard else _list_offering(view, need.name)
    if not headers or not (
        machine.knows_name(need.name) if standard else any(machine.includes(header) is not None for header in headers)
    ):
        return None
    wanted, best = frozenset(headers), None
    bits, made = machine.find_bits(wanted), parse_type(need.name)
    # To a type that is announced, pointers may be made.
    pointed = 0 if need.whole or standard else machine.find_bits(list_announcing_headers(need.name))
    for reach, own in reaches:
        if not wanted.isdisjoint(own | reach):
            continue
        if machine.brings(need.name, reach, year) if standard else machine.brings_any(bits, reach):
            continue
        if need.name in _EXTENDED and any(find_package(header, machine.ros) is None for header in own):
            continue  # another package of the workspace may have added one
        outside = _list_outside(view, need.name, reach, machine)
        # Of what the workspace generates itself, all that it brings along reaches the file too.
        if outside is None or (made is not None and not machine.tells_all(reach - own)):
            continue
        if standard:
            dropped = _find_dropped_name(view, need.name, reach, year, machine, earlier)
            known_gcc = need.name.startswith("std::") and not outside and machine.gcc >= find_oldest_gcc()
            found = dropped or (("gcc", machine.find_version("gcc") or "") if known_gcc else None)
        else:
            dropped = _find_dropped(view, wanted, reach, machine, earlier)
            # Whose headers a platform library's bring, no table tells.
            all_known = made is not None or all(p.kind == "ros" for path in outside for p in view.find_header(path))
            found = dropped or (_find_owner(need, headers, reach, machine) if all_known else None)
        if found is None or (best is not None and (best.sure or outside)):
            continue
        # Of what reaches the file and is not known, nothing depends on a ROS package whose name it is.
        known = not outside or not (standard or machine.is_from_library(headers[0]))
        sure = known and not pointed & machine.compute_mask(reach)
        best = LostHeader(headers[0], *found, sure, dropped is not None, standard, times.now)
    return best


def _list_offering(view: TargetView, name: str) -> tuple[str, ...]:
    """The headers that offer a name, best first; none where they are the workspace's own, nor for types of interfaces
    that are not known on the target."""
    made = parse_type(name)
    if made is None:
        headers = load_offered().get(name) or ()
        holders = (view.machine.surfaces.list_holders(header) for header in headers)
        return headers if view.workspace.packages.keys().isdisjoint(chain.from_iterable(holders)) else ()
    known = made.ros == view.target.ros and made.package not in view.workspace.packages
    return made.headers if known and view.machine.tells(made.headers[0]) else ()


def _find_owner(
    need: NeededHeader, offering: tuple[str, ...], reach: frozenset[str], machine: HeadersOfMachine
) -> tuple[str, str] | None:
    """Whose a name is that nothing ever brought, and its version. Of Boost it is a library's some of whose headers a
    file includes: it has other names like those of the standard library. Else a folder or file with the name is called
    after its namespace, for others define names there by macros, by which types are announced too."""
    name = need.name
    if (made := parse_type(name)) is not None:
        version = machine.find_version(made.package)
        return (made.package, version) if version else None
    head = name.partition("::")[0]
    called = (header for header in offering if head == name or is_called_after(header, head))
    owners = {owner for header in called if (owner := machine.find_owner(header)) is not None}
    if not name.startswith(("boost::", "BOOST_")):
        return min(owners, default=None) if need.whole else None
    return next((owner for header in sorted(reach) if (owner := machine.find_owner(header)) in owners), None)


def _find_dropped(
    view: TargetView,
    wanted: frozenset[str],
    reach: frozenset[str],
    machine: HeadersOfMachine,
    earlier: tuple[HeadersOfMachine, ...],
) -> tuple[str, str] | None:
    """Who brought one of the wanted headers along on the last earlier machine that had it, and its version by now."""
    for before in earlier:
        bits = before.find_bits(wanted)
        for header in sorted(reach):
            if bits & before.compute_mask(frozenset((header,))):
                if view.is_standard(header):
                    return "gcc", machine.find_version("gcc") or ""
                return machine.find_owner(header)
    return None


def _find_dropped_name(
    view: TargetView,
    name: str,
    reach: frozenset[str],
    year: int,
    machine: HeadersOfMachine,
    earlier: tuple[HeadersOfMachine, ...],
) -> tuple[str, str] | None:
    """The same for a name of the standard libraries."""
    for before in earlier:
        if not before.knows_name(name):
            continue
        for header in sorted(reach):
            if not before.brings(name, frozenset((header,)), year):
                continue
            still = machine.find_brought(header).standard
            if view.is_standard(header) or any((find_named(h, before.gcc, year) or 0) & get_bit(name) for h in still):
                return "gcc", machine.find_version("gcc") or ""
            return machine.find_owner(header)
    return None


def _list_outside(view: TargetView, name: str, reach: frozenset[str], machine: HeadersOfMachine) -> list[str] | None:
    """Headers among those that reach a file of which nothing is known; None when one of them may well bring the name.

    Any that the file itself includes may bring a name of the standard library; one whose package depends on the name's
    may bring another.
    """
    unknown = machine.list_unknown_headers(reach)
    outside = {
        path
        for path in unknown
        if not view.is_standard(path)
        and not _OF_PROCESSOR.search(path)
        and not _OF_LINKER.search(path)
        and (path in reach or (view.find_header(path) and not _GENERATED.search(path)))
    }
    if get_bit(name):
        return None if outside & reach else sorted(outside)
    if (made := parse_type(name)) is not None:
        owners = {made.package}
    else:
        owners = {owner[0] for header in load_offered()[name] if (owner := machine.find_owner(header)) is not None}
    # A header that its package makes from a template is in none of its versions' trees.
    folders = {path.partition("/")[0] for path in reach if (machine.find_owner(path) or ("",))[0] in owners}
    if any(path.partition("/")[0] in folders and not view.find_header(path) for path in unknown):
        return None
    for path in outside:
        around = view.list_around(path)
        if not around or (path in reach and machine.knows(path)) or not owners.isdisjoint(around):
            return None
    return sorted(outside)
