"""`rosimpact why NAME`: who provides a name on a target, since when, who uses it, and whether that is safe."""

import os
from collections.abc import Sequence
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from ...edges.console import escape, format_count
from ..model.cmake.build import At, CMakeUse
from ..model.view import Need, TargetView
from ..model.workspace import Package
from ..rules.packages.undeclared_needs import choose_name
from ..rules.rule import Finding
from ..targets.changes import iterate_in_force
from ..targets.evidence import find_arrival
from ..targets.platform import find_neighbours
from ..targets.providers.libraries import load_libraries
from ..targets.symbol import Availability, Symbol
from ..targets.target import Provider
from ..tree import JoinedTree
from .check_opened import check_opened
from .session import Options, open_workspace

# Files that make a folder a workspace or a package.
_MARKS = ("package.xml", "rosimpact.toml", "colcon.meta")
# How many levels of folders are looked through for a manifest (src/repository/package), and how many names.
_LEVELS, _LOOKS_AT_MOST = 4, 5_000
_SHOWN = 12
_PRODUCTS = frozenset(("build", "install", "devel", "log"))


class NameOffer(NamedTuple):
    """One way to get a name. kind: workspace, package, key. version and since may be empty where not known. note: what
    else there is to say; of a released package, that the build farm is taken to have built it."""

    kind: str
    name: str
    version: str
    since: str
    note: str


class WhyAnswer(NamedTuple):
    """What a name is on one target. as_what: header, CMake package, command or target, Python module, executable,
    package or key. used: `path:line` of uses in the workspace. undeclared: packages that use it and do not declare it.
    findings: what check reports on it, as `path:line: severity: message [rule]`."""

    target: str
    as_what: str
    offers: tuple[NameOffer, ...]
    used: tuple[str, ...]
    undeclared: tuple[str, ...]
    changes: tuple[str, ...]
    findings: tuple[str, ...]


def is_workspace(folder: Path) -> bool:
    """Whether a folder that nobody named looks like a workspace or a package, told by a few folders of it alone.

    The root of the file system and a home folder are none, whatever they hold, but for their own package.xml or
    rosimpact.toml: all of it would be read.
    """
    if any((folder / name).is_file() for name in _MARKS):
        return True
    if os.path.realpath(folder) in ("/", os.path.realpath(os.path.expanduser("~"))):
        return False
    level = [str(folder)]
    seen = 0
    for _ in range(_LEVELS):
        below: list[str] = []
        for place in level:
            with suppress(OSError), os.scandir(place) as scan:
                for item in islice(scan, _LOOKS_AT_MOST):
                    seen += 1
                    if item.name == "package.xml":
                        return True
                    if item.name[0] != "." and item.name not in _PRODUCTS and item.is_dir(follow_symlinks=False):
                        below.append(item.path)
            if seen > _LOOKS_AT_MOST:
                return False
        level = below
    return False


def find_answers(
    name: str, path: Path | None, targets: tuple[str, ...], *, follow_links: bool = False
) -> list[WhyAnswer]:
    """One answer a target and a meaning of the name. path: the workspace; None for answers without uses. Raises as
    check() does."""
    options = Options(targets=targets, follow_links=follow_links)
    with open_workspace(path or Path(), options, tree=None if path is not None else JoinedTree({})) as opened:
        found: Sequence[Finding] = ()
        if opened.workspace.packages:
            found = check_opened(path or Path(), options, opened).report.findings
        return [answer for view in opened.views for answer in _find_answers(view, name, found)]


def _find_answers(view: TargetView, name: str, findings: Sequence[Finding]) -> list[WhyAnswer]:
    """findings: what check reports; those at a use of the name, and those that name it, are about it."""
    found = []
    commands = view.providers.commands.get(view.target.ros, {}).get(name.lower(), "").split()
    offer = view.offers.find_package(name.partition("::")[0]) if "::" in name else None
    exported = offer is not None and any(target.name == name for target in offer.build.targets)
    for what, kind, providers in (
        ("header", "header", view.find_header(name)),
        ("CMake package", "", view.find_cmake(name)),
        ("CMake command", "command", tuple(Provider("ros", package) for package in commands)),
        ("CMake target", "target", (Provider("ros", name.partition("::")[0]),) if exported else ()),
        ("Python module", "python", view.find_module(name)),
        ("executable", "executable", tuple(view.providers.find_executable(name))),
    ):
        named = [(p, Symbol(kind, name, (p.name,)) if kind else None) for p in providers if p.name]
        offers = tuple(dict.fromkeys(_offer(view, p.name, p.package, symbol) for p, symbol in named))
        # What is not there is told only where nothing else is.
        offers = tuple(offer for offer in offers if offer.kind != "absent") or offers[:1]
        if not offers and any(not p.name for p in providers):
            offers = (NameOffer("system", "", "", "", "comes with the compiler, CMake or Python"),)
        if offers:
            found.append((what, offers))
    if view.is_available(name) or view.target.was_ever_released(name) or view.target.knows_key(name):
        kind = "package" if view.target.was_ever_released(name) or name in view.workspace.packages else "rosdep key"
        found.insert(0, (kind, (_offer(view, name, ""),) if view.is_available(name) else ()))
    used, undeclared = _find_uses(view, name)
    changes = tuple(
        f"{row.kind}: `{row.old}`"
        + (f" → `{row.new}`" if row.new else "")
        + f" ({state}{', since ' + since if (since := row.format_arrival()) else ''})"
        for row, state in iterate_in_force(view.target)
        if name in (row.old, row.new, row.package) or name == row.old.rsplit("::", 1)[-1]
    )
    lost = view.find_lost_header(name)
    if lost is not None:
        where = f" in {lost.package} {lost.version}".rstrip() if lost.package else ""
        instead = f"; include `{lost.replacement}`" if lost.replacement else ""
        changes = (f"gone: `{name}` is not available{where}{instead}", *changes)
    if not found:
        found = [("name", ())]
    target = view.target.name
    here = tuple(
        f"{each.path}:{each.line}: {each.severity}: {each.message} [{each.rule}]"
        for each in findings
        if (f"{each.path}:{each.line}" in used or _is_about(each, name))
        and (not each.targets or target in each.targets)
    )
    return [WhyAnswer(target, what, offers, used, undeclared, changes[:8], here) for what, offers in found]


def _is_about(finding: Finding, name: str) -> bool:
    """True for a finding about a name, or that is based on a change in the package of that name."""
    changed = finding.evidence.package if finding.evidence is not None else ""
    return name in (finding.subject, changed) or f"`{name}`" in finding.message


def _offer(view: TargetView, name: str, package: str, symbol: Symbol | None = None) -> NameOffer:
    """How a package or key is there. symbol: what is asked of it, where that is not its name."""
    target = view.target
    here = view.workspace.packages.get(name)
    if here is not None:
        return NameOffer("workspace", name, here.manifest.version, "", here.path)
    version = target.find_version(name)
    if version is not None and symbol is None:
        return NameOffer("package", name, version, target.find_first_day(name), _tell_assumed(view, name))
    if version is not None and symbol is not None:
        found = view.find_availability(symbol)
        if found.is_missing:
            return NameOffer("absent", name, version, "", f"does not have it ({_tell_change(found)})")
        since = find_arrival(symbol.kind, symbol.name, name, target, view.providers)
        return NameOffer("package", name, version, since, _tell_assumed(view, name))
    resolution = target.resolve(name)
    if resolution is not None:
        known = ((library, target.find_library(library)) for library in view.list_libraries(name))
        versions = ", ".join(f"{library} {version}" for library, version in known if version)
        note = f"{resolution.manager}: {' '.join(resolution.packages) or 'nothing to install'}"
        return NameOffer("key", name, versions, "", note + _tell_stand_ins(target.platform, resolution.packages))
    last = target.find_last_distro(name)
    note = f"not there; last seen in {last}" if last else f"not there ({package})" if package else "not there"
    return NameOffer("absent", name, "", "", note)


def _tell_stand_ins(platform: str, packages: Sequence[str]) -> str:
    """Which releases of Debian tell what the files of system packages hold on Ubuntu, of which only lists of files were
    read. Empty for other platforms, and for packages that were read in no release."""
    if not platform.startswith("ubuntu "):
        return ""
    libraries = load_libraries()
    library = next(filter(None, map(libraries.find_by_package, packages)), "")
    versions = libraries.list_versions(library) if library else {}
    before, after = find_neighbours(platform, versions)
    both = [f"{release} ({versions[release]})" for release in dict.fromkeys((before, after)) if release]
    if not both:
        return ""
    where = ", where they agree" if len(both) == 2 else ", a later release" if after else ", an earlier release"
    return f"; what its files hold is judged by {' and '.join(both)}{where}"


def _tell_assumed(view: TargetView, package: str) -> str:
    return f"taken to be built for {view.target.platform}" if view.target.assumes_built(package) else ""


def _calls(use: CMakeUse, name: str) -> bool:
    """Whether CMake calls a command of a name, or links a target that is so called in a namespace."""
    return use.name.lower() == name.lower() if use.kind == "command" else use.name == name and "::" in name


def _tell_change(found: Availability) -> str:
    if found.form == "never" or not found.since:
        return "nor does any known version" if found.form == "never" else found.state
    return f"{'added' if found.state == 'not yet' else 'removed'} in {found.since}"


def _find_uses(view: TargetView, name: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    used, undeclared = [], []
    for package in view:
        closure = None
        for need in view.list_needs(package):
            if name not in (need.subject, *_list_names(view, package, need)):
                continue
            used.append(f"{need.at.path}:{need.at.line}")
            closure = view.build_environment(package) if closure is None else closure
            if not view.is_met(need.providers, closure) and package.name not in undeclared:
                undeclared.append(package.name)
        places = [At(package.linked.manifest_path, d.line) for d in package.manifest.dependencies if d.name == name]
        places += [use.at for use in package.build.list_uses() if _calls(use, name)]
        used += [f"{at.path}:{at.line}" for at in places]
    used = list(dict.fromkeys(used))
    return tuple(used), tuple(undeclared)


def _list_names(view: TargetView, package: Package, need: Need) -> frozenset[str]:
    """What may be declared for a need: the name that a person would choose, and keys that install the same."""
    chosen = choose_name(view, package, need) or need.providers[0].name
    debs = view.list_debs(chosen)
    return frozenset((chosen, *(p.name for p in need.providers if debs and view.list_debs(p.name) == debs)))


def render_text(name: str, found: list[WhyAnswer], *, looked: bool = True) -> str:
    """The answers for people. Meanings of a name that lead to the same offers are told together. looked: whether uses
    were looked for."""
    lines: list[str] = []
    for target in dict.fromkeys(answer.target for answer in found):
        here = [answer for answer in found if answer.target == target]
        meanings: dict[tuple[NameOffer, ...], list[str]] = {}
        for answer in here:
            meanings.setdefault(answer.offers, []).append(answer.as_what)
        for offers, whats in meanings.items():
            lines.append(f"on {target}: `{name}` as {', '.join(whats)}")
            lines += [_offer_line(offer) for offer in offers] or ["  nobody is known to provide it there"]
        lines += [f"  {change}" for change in here[0].changes]
    if not found:
        return ""
    if not looked:
        lines.append(f"uses were not looked for, since this folder is no workspace: rosimpact why {escape(name)} PATH")
        return "\n".join(lines)
    used = found[0].used
    lines += [f"used at {format_count(len(used), 'place')}" + (":" if used else ""), *_format_first(used)]
    undeclared = sorted({package for answer in found for package in answer.undeclared})
    if undeclared:
        lines.append("not safe: used and not declared in " + ", ".join(undeclared))
    gone = sorted({a.target for a in found if any(_is_gone(change, name) for change in a.changes)})
    if gone and used:
        lines.append(f"not safe: `{name}` is gone on " + ", ".join(gone))
    reported = list(dict.fromkeys(line for answer in found for line in answer.findings))
    if reported:
        lines += [f"not safe: check reports {format_count(len(reported), 'finding')} on it:", *_format_first(reported)]
    elif used and not undeclared and not gone:
        lines.append(
            "safe: every package that uses it declares it, or something that brings it, and check reports nothing on it"
        )
    return "\n".join(map(escape, lines))


def _format_first(lines: Sequence[str]) -> list[str]:
    more = [f"and {len(lines) - _SHOWN} more"] if len(lines) > _SHOWN else []
    return [f"  {line}" for line in (*lines[:_SHOWN], *more)]


def _is_gone(change: str, name: str) -> bool:
    """True for a change that takes the very name away from a target."""
    return change.startswith("gone: ") or (f"`{name}`" in change.partition(" → ")[0] and "(removed" in change)


def _offer_line(offer: NameOffer) -> str:
    since = f"since {offer.since}" if offer.since else ""
    return "  " + "  ".join(
        part for part in (f"{offer.kind} {offer.name}".rstrip(), offer.version, since, offer.note) if part
    )
