"""What the rules of this family say of something that a target lacks, or will lack."""

import re
from collections.abc import Collection, Iterable, Iterator

from ...facts.condition import Condition
from ...model.package import ReferenceUse
from ...targets.changes import DISTROS
from ...targets.symbol import Availability, Symbol
from ..vocabulary import (
    Diagnostic,
    Doubt,
    FixAction,
    Package,
    TargetView,
    Text,
    Together,
    Upcoming,
    Value,
    list_place_doubts,
)

UPSTREAM = "{upstream}[[ {version}]]"
"""The package or library that decides, in the version that the target has."""


GONE_PACKAGE = Text(
    "`{subject}` belongs to {upstream}, which is not available in {distro}[[ (last in {last})]]", "[[{replacement}]]"
)
"""For what find_gone_package() yields."""


def build_availability_texts(verb: str = "use") -> dict[str, Text]:
    """The texts for what is_missing, deprecated or upcoming, by the kinds that diagnose() gives. verb: what one does
    with the replacement."""
    help = (
        f"[[{verb} `{{replacement}}`]][[, available since {{available}}]][[`{{moved_to}}` has it now]]"
        "[[{upstream} has `{alike}`]][[its declaration says: {detail}]]"
    )
    missing = f"`{{subject}}` is not available in {UPSTREAM}"
    return {
        "removed": Text(f"{missing}[[ (removed in {{since}})]]", help),
        "not yet": Text(f"{missing}[[ (added in {{since}})]]", help),
        "never": Text(f"{missing}, nor in any other version of it that is known", help),
        "upcoming": Text(f"`{{subject}}` will be removed: not in {UPSTREAM} ({{horizon}})", help),
        "deprecated": Text(f"`{{subject}}` is deprecated in {UPSTREAM}[[ and removed in {{gone}}]]", help),
    }


def build_data(found: Availability) -> dict[str, Value]:
    """The data that the texts name. Of what to do instead only the best is told."""
    moved = found.moved_to if found.state != "not yet" else ""
    replacement = "" if moved else found.replacement
    return {
        "upstream": found.package,
        "version": found.version,
        "since": found.since,
        "horizon": found.horizon.name if found.horizon is not None else "",
        "replacement": replacement,
        "available": found.replacement_since if replacement else "",
        "moved_to": moved,
        "gone": found.gone_in,
        "alike": "" if moved or replacement else found.alike,
        "detail": "" if moved or replacement or found.alike else found.detail,
    }


def find_missing(
    view: TargetView, kind: str, name: str, packages: Iterable[str], conditions: Iterable[Condition] = ()
) -> Availability | None:
    """What is known of a thing that none of these packages has here, or will have where a use under these conditions
    counts; None for all else."""
    found = view.find_availability(Symbol(kind, name, tuple(packages)), conditions)
    return found if found.is_missing or found.state == "upcoming" else None


def make_version_together(upstream: str) -> tuple[Together, ...]:
    """What all have in common that a package of another version, or its absence, breaks."""
    return (Together(f"version of {upstream}", everywhere=True),)


def diagnose(
    found: Availability,
    at: object,
    subject: str,
    package: str,
    doubts: Iterable[Doubt | bool | None] = (),
    *,
    kind: str = "",
    data: dict[str, Value] | None = None,
    fix: tuple[FixAction, ...] = (),
    order: tuple = (),
) -> Diagnostic | Upcoming:
    """What is to be said of something that a use needs. doubts: about the place. kind, data: which text, and what it
    names, where it is none of build_availability_texts(). order: see Upcoming; by default the place."""
    given = build_data(found) if data is None else data
    kind = kind or ("never" if found.form == "never" else found.state)
    all_doubts = (*doubts, found.sure or Doubt.INCOMPLETE)
    diagnostic = Diagnostic(
        at, subject, package, given, kind, all_doubts,
        fix=fix, evidence=found.evidence, together=make_version_together(found.package),
    )  # fmt: skip
    if found.state != "upcoming" or found.horizon is None:
        return diagnostic
    return Upcoming(diagnostic, found.package, found.horizon, order or diagnostic.place)


def find_gone_package(
    view: TargetView,
    package: Package,
    use: ReferenceUse,
    upstream: str,
    subject: str,
    reached: Doubt | bool = Doubt.LATE,
) -> Iterator[Diagnostic]:
    """Reports that a launch file or parameter file names something of a package that the target does not have, where
    no other rule does: package.xml does not declare it. reached: True where it is asked for in every run. Not in tests,
    and not in ROS 1, whose releases contain many launch files that are no longer used."""
    if view.target.ros == 1 or use.role == "test":
        return
    if not view.is_package(upstream) or view.may_have(upstream):
        return
    if view.is_available(upstream) or view.underlaid or view.is_private(upstream):
        return
    # What is declared for another distro is often used by files for that distro, unless these choose by it themselves.
    chosen = bool(use.reference.conditions) and not use.reference.conditional
    if upstream in package.declared and (not chosen or upstream in view.collect_declared(package)):
        return
    found = find_missing(view, "package", upstream, ())
    if found is not None and found.state in ("removed", "not yet"):
        last = view.target.find_last_distro(upstream)
        data = {
            "upstream": upstream, "distro": view.target.distro, "replacement": view.find_successor(upstream),
            "last": last if found.state == "removed" and last != view.target.distro else "",
        }  # fmt: skip
        doubts = (*list_place_doubts(view, use.role), reached)
        yield Diagnostic(
            use.at, subject, package.name, data, "package", doubts, together=make_version_together(upstream)
        )  # fmt: skip


_MARKED = re.compile(rf"[_-]({'|'.join(DISTROS)})(?![A-Za-z0-9])")


def is_of_another_distro(view: TargetView, path: str, files: Collection[str]) -> bool:
    """Whether a file is for other distros than the target: it, or one that stands for it there, lies in a folder that
    is called after a distro (`param/humble/burger.yaml`), or settings are called so themselves beside such as are for
    all others (`burger_humble.yaml`, `burger.yaml`). files: of its package."""
    folder, _, name = path.rpartition("/")
    distro = view.target.distro
    if any(part in DISTROS and part != distro for part in folder.split("/")) or f"{folder}/{distro}/{name}" in files:
        return True
    if not name.endswith((".yaml", ".yml")):
        return False
    marked = _MARKED.search(name)
    if marked is not None:
        return marked[1] != distro and f"{folder}/{name[: marked.start()]}{name[marked.end() :]}" in files
    stem, dot, ending = name.partition(".")
    return any(f"{folder}/{stem}{mark}{distro}{dot}{ending}" in files for mark in "_-")
