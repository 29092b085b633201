"""What the packages of a target offer beside what other versions of them do: which names are gone there, not there yet,
changed or on their way out. Asked of the shipped surfaces; packages of which none are stored are not known."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from typing import NamedTuple

from ....edges.memory import cache_method
from ...facts.surface import format_declaration
from ..distro.distro import DistroTarget
from .changes import ChangeEvent, ComparedThing, Form, Line
from .python import SurfaceNames
from .store import SurfaceHistory, Surfaces
from .surface import BuildSurface

# Sides whose names many packages have alike (`launch/demo.launch`), so that another package's is no successor.
_OF_EVERY_PACKAGE = frozenset(("launch file", "launch argument"))


class Offered(NamedTuple):
    """A name that the target's version of a package does not offer as every version does.

    side: as in surface_changes.Line. what: the sort of thing (`class`, `method`, `executable` ...).
    state: `removed` (earlier versions of this ROS generation had it), `moved` (the same, and another package of the
    target, moved_to, has it now), `absent` (only later ones have it), `deprecated` (there, and it warns), `changed`
    (there, and other versions had or have it in another form).
    version: the target's. here: its form there, None when it is not there. before: its form in the version `last`,
    before the present state began with the version `first` (both empty where all stored versions up to the target's
    are alike); of what is absent, first is the first version that has it. after: its form from the version `coming`
    on (empty: nothing later is known); gone_in: the first later version without it.
    reported: what the comparison of `last` and `first` reported; of what is there unchanged, that of the next change.
    instead: what to use now, empty where that is not known. sure: nothing about it is guessed.
    """

    package: str
    side: str
    name: str
    what: str
    state: str
    version: str
    here: Form | None
    before: Form | None
    last: str
    first: str
    after: Form | None
    coming: str
    gone_in: str
    reported: tuple[ComparedThing, ...]
    instead: str
    moved_to: str
    sure: bool


class Offers:
    """The packages of a target. surfaces: where to look, by default the shipped file."""

    def __init__(self, target: DistroTarget, surfaces: Surfaces | None = None):
        self.target = target
        self._given = surfaces

    @cached_property
    def surfaces(self) -> Surfaces:
        """The stored surfaces."""
        from .store import load_shipped

        return self._given or load_shipped()

    @cache_method
    def find_package(self, name: str) -> PackageOffer | None:
        """What a package offers there; None when it is not there, or nothing comparable is stored."""
        version = self._find_version(name)
        line = self.surfaces.find_line(name, self.target.ros) if version else None
        place = line.find_place(version) if line is not None and version else None
        return None if line is None or place is None or not version else PackageOffer(self, name, version, line, place)

    def _find_version(self, name: str) -> str | None:
        """The target's version of a package; of a library as far as its surfaces tell versions apart."""
        if not self.surfaces.is_library(name):
            return self.target.find_version(name)
        version, line = self.target.find_library(name), self.surfaces.find_line(name, self.target.ros)
        if version is None or line is None or (name == "python" and not self.target.python):
            return None  # code of a distro of Python 2 does not run on the platform's Python 3
        return ".".join(version.split(".")[: line.versions[-1].count(".") + 1])

    def find_history(self, package: str) -> SurfaceHistory | None:
        """All stored versions of a package that the target's ROS generation has; None when there is none."""
        return self.surfaces.find_history(package, self.target.ros)

    @cache_method
    def list_library_owners(self, library: str, ros: int = 0) -> list[str]:
        """Packages whose newest stored version has a library of this name, of those that are called after it: they
        begin with the same word. ros: their ROS generation, by default the target's."""
        word = re.split(r"[_-]", library)[0]
        alike = sorted(name for name in self.surfaces.packages if re.split(r"[_-]", name)[0] == word)
        return [name for name in alike if library in self._list_libraries(name, ros or self.target.ros)]

    def _list_libraries(self, package: str, ros: int) -> tuple[str, ...]:
        history = self.surfaces.find_history(package, ros)
        build = history.build(history.versions[-1], ("libraries", "targets")) if history is not None else None
        if build is None:
            return ()
        targets = (target.name.rpartition("::")[2] for target in build.targets if target.kind in ("library", "module"))
        return (*build.libraries, *targets)

    def has_plugin(self, package: str, name: str) -> bool | None:
        """Whether the newest stored version of a package has a plugin of this name or type; None where none is
        stored."""
        history = self.find_history(package)
        build = history.build(history.versions[-1], ("plugins",)) if history is not None else None
        return None if build is None else any(name in (plugin.name, plugin.type) for plugin in build.plugins)

    def has_plugin_owner(self, name: str) -> bool:
        """Whether any version of any package of the target's ROS generation has a plugin of this name or type."""
        return any(ros == self.target.ros for _, ros in self.surfaces.plugin_owners.get(name, ()))

    def find_standard(self, name: str) -> int:
        """The C++ standard that a package asks of those who link it, as CMake writes it; 0 when nothing tells."""
        offer = self.find_package(name)
        return offer.build.standard if offer is not None else 0

    def list_exports(self, name: str) -> tuple[str, ...] | None:
        """What a package hands on to its dependants by CMake: packages, and the CMake names of system libraries; None
        when nothing of it is stored."""
        offer = self.find_package(name)
        return offer.history.list_exports(offer.stored) if offer is not None else None

    def is_bundle(self, name: str) -> bool:
        """True for a package of which the stored version, or else the newest one, has no header, module, library,
        program, plugin, interface or launch file: it is there for what it depends on."""
        offer, history = self.find_package(name), self.find_history(name)
        if history is None:
            return False
        return history.is_bundle(offer.stored if offer is not None else history.versions[-1])

    def list_packages_with(self, header: str, packages: Iterable[str]) -> list[str]:
        """Those of some packages whose stored version has a header by the path that dependants include."""
        offers = (offer for package in packages if (offer := self.find_package(package)) is not None)
        return [offer.package for offer in offers if any(h.include == header for h in offer.build.headers)]

    def lives_on(self, old: str, new: str) -> bool:
        """Whether one package is another one that was renamed: at least half of what its last stored version has to
        include, import, start or send is in the newest of the other. False where nothing of it is stored."""
        before, after = self.find_history(old), self.find_history(new)
        had = before.list_own_names(before.versions[-1]) if before is not None else frozenset()
        kept = had & after.list_own_names(after.versions[-1]) if after is not None else had
        return bool(had) and after is not None and 2 * len(kept) >= len(had)

    @cached_property
    def has_one_include_folder(self) -> bool:
        """Whether the headers of all packages lie in one folder, so that whoever is given any package finds those of
        all: told by rclcpp, which was moved together with generated headers and the core of ROS 2. True where nothing
        of it is stored."""
        return self._has_own_folder("rclcpp", "rclcpp/rclcpp.hpp") is not True

    def has_own_folder(self, package: str, header: str) -> bool | None:
        """Whether a header lies in a folder that only those search who are given its package; None where that is not
        known."""
        own = self._has_own_folder(package, header)
        return False if own is None and self.has_one_include_folder else own

    def _has_own_folder(self, package: str, path: str) -> bool | None:
        offer = self.find_package(package)
        header = next((h for h in offer.build.headers if h.include == path), None) if offer is not None else None
        if header is None:
            return None
        # Where generators install to stands in none of the package's own files.
        return header.installed != f"include/{path}" if header.source else not self.has_one_include_folder

    def find(self, side: str, name: str, packages: Iterable[str]) -> Offered | None:
        """The first of these packages' names that is so called and not as everywhere; or what it stands in: a member
        of a class that is gone as a whole is told by its class."""
        separator = {"c++": "::", "python": "."}.get(side, "\0")
        offers = [offer for package in packages if (offer := self.find_package(package)) is not None]
        while name:
            for offer in offers:
                found = offer.get(side, name)
                if found is not None:
                    return found
            name = name.rpartition(separator)[0]
        return None

    def has_name(self, side: str, name: str, package: str) -> bool:
        """Whether the stored version that stands for the target's has a name at all."""
        offer = self.find_package(package)
        return offer is not None and offer.history.has(name, offer.stored)


class PackageOffer:
    """One package on one target. stored: the version that stands for the target's; exact: it is the same."""

    def __init__(self, offers: Offers, package: str, version: str, line: Line, place: int):
        self._offers, self.package, self.version = offers, package, version
        self.line, self.place = line, place
        self.stored = line.versions[place]
        self.exact = self.stored == version

    @cache_method
    def get(self, side: str, name: str) -> Offered | None:
        """A name that only some versions have, or have in the same form; None for one that all do, or that none has."""
        events = self.line.events.get(side, {}).get(name)
        return self._make_offered(side, name, events) if events else None

    @property
    def history(self) -> SurfaceHistory:
        """All its stored versions, which stand beside what changed from one to the next."""
        found = self._offers.find_history(self.package)
        assert found is not None
        return found

    @cached_property
    def build(self) -> BuildSurface:
        """What the stored version gives to CMake and at run time."""
        from .surface import BuildSurface

        return self.history.build(self.stored) or BuildSurface(self.package)

    @property
    def exports_targets_alone(self) -> bool:
        """Whether it fills no variable with its libraries here, and does in another version."""
        build, history = self.build, self.history
        if build.libraries or build.variables or any(part in ("libraries", "targets") for part, _ in build.unknown):
            return False
        if not any(target.kind == "library" and target.sure for target in build.targets):
            return False
        others = (history.build(version, ("libraries",)) for version in history.versions if version != self.stored)
        return any(other is not None and other.libraries for other in others)

    @cached_property
    def parameters(self) -> dict[str, str | None]:
        """The parameters that the stored version declares, with their defaults, as in Surface."""
        return dict(self.history.list_parameters(self.stored))

    def find_last_default(self, parameter: str) -> str | None:
        """The default that a parameter had in the last earlier version that declares it; None where there is none."""
        for version in reversed(self.line.versions[: self.place]):
            declared = dict(self.history.list_parameters(version))
            if parameter in declared:
                return declared[parameter]
        return None

    def list_offered(self, side: str) -> Iterator[Offered]:
        """All such names."""
        for name in self.line.events.get(side, ()):
            found = self.get(side, name)
            if found is not None:
                yield found

    def _make_offered(self, side: str, name: str, events: tuple[ChangeEvent, ...]) -> Offered:
        versions = self.line.versions
        standing = find_standing(side, events, self.place)
        past, future, there = standing.past, standing.future, standing.there
        reported = (past[-1] if past else future[0]).reported
        deciding = past[-1:] if past else future[:1]
        state = "deprecated" if standing.deprecated else "changed" if there else "removed" if past else "absent"
        sure = all(t.sure >= 1 for event in deciding for t in event.reported)
        if not self.exact and future and future[0].place == self.place + 1:
            # Which of the versions between the two stored ones made the next change is not known.
            sure = False
        first = versions[past[-1].place] if past else versions[future[0].place] if state == "absent" else ""
        coming = future[0] if future and there else None
        instead = next((t.instead for t in reported if t.instead), "")
        moved_to = ""
        if state == "removed" and side not in _OF_EVERY_PACKAGE:
            moved_to = next((t.moved_to for t in reported if t.moved_to), "") or self._find_other_package(side, name)
        return Offered(
            self.package,
            side,
            name,
            reported[0].what,
            "moved" if moved_to else state,
            self.version,
            standing.here,
            standing.before,
            versions[past[-1].place - 1] if past else "",
            first,
            standing.after,
            versions[coming.place] if coming is not None else "",
            next((versions[e.place] for e in future if there and classify_event(side, e) == "gone"), ""),
            reported,
            instead,
            moved_to,
            sure,
        )

    def _find_other_package(self, side: str, name: str) -> str:
        """Another package of the target that has the name."""
        others = self._offers.surfaces.list_other_packages(name)
        return next((p for p in others if p != self.package and self._offers.has_name(side, name, p)), "")


def iterate_other_forms(offers: Offers, offered: Offered) -> Iterator[tuple[ChangeEvent, Form, bool]]:
    """The other forms of a name, the nearest first: an event, the form on the other side of it, and whether that is of
    earlier versions."""
    offer = offers.find_package(offered.package)
    events = offer.line.events.get(offered.side, {}).get(offered.name, ()) if offer is not None else ()
    for event in reversed(events):
        if offer is not None and event.place <= offer.place and event.had is not None:
            yield event, event.had, True
    for event in events:
        if offer is not None and event.place > offer.place and event.has is not None:
            yield event, event.has, False


def make_offered(offers: Offers, offered: Offered, event: ChangeEvent, earlier: bool) -> Offered:
    """A name as one of its changes tells of it, where a use of it fits the form on the other side of that change.
    earlier: the target's version has that change already."""
    offer = offers.find_package(offered.package)
    assert offer is not None
    version = offer.line.versions[event.place]
    if not earlier:
        return offered._replace(after=event.has, coming=version)
    return offered._replace(
        before=event.had, last=offer.line.versions[event.place - 1], first=version, reported=event.reported,
        instead=next((one.instead for one in event.reported if one.instead), ""),
        sure=all(one.sure >= 1 for one in event.reported),
    )  # fmt: skip


def list_declared(history: SurfaceHistory | None, side: str, name: str, version: str) -> tuple[str, ...]:
    """How a stored version of a package declares a name of C++ or Python, a line for each overload; empty for anything
    else."""
    if history is None or side not in ("c++", "python"):
        return ()
    if side == "c++":
        return tuple(dict.fromkeys(format_declaration(entity) for entity in history.iterate_entities(name, version)))
    from .python import UNKNOWN, describe

    names = _load_names(history, version)
    entry = names.find(name) if names is not None else None
    if entry is None or entry is UNKNOWN or entry.bound is None:
        return ()  # a module declares nothing by its name alone
    text = describe(entry)
    return (f"{name} = {text}" if text and not text.startswith("(") else f"{name}{text}",)


@lru_cache(maxsize=8)
def _load_names(history: SurfaceHistory, version: str) -> SurfaceNames | None:
    from .python import SurfaceNames

    python = history.load_python(version)
    return SurfaceNames(python) if python is not None else None


class Standing(NamedTuple):
    """How one version stands to the changes of a name. there: it has the name; deprecated: and warns of it. here,
    before, after: the form of the name in it, before the last change up to it, and after the next one; None where the
    name is not there, or forms say nothing. past, future: the changes up to it, and later ones."""

    there: bool
    deprecated: bool
    here: Form | None
    before: Form | None
    after: Form | None
    past: Sequence[ChangeEvent]
    future: Sequence[ChangeEvent]


def find_standing(side: str, events: Sequence[ChangeEvent], place: int) -> Standing:
    """How the version at a place of its line stands to all events of a name."""
    past = [event for event in events if event.place <= place]
    future = [event for event in events if event.place > place]
    before = past[-1].had if past else None
    if (classify_event(side, past[-1]) == "gone") if past else (classify_event(side, future[0]) == "come"):
        return Standing(False, False, None, before, None, past, future)
    here = past[-1].has if past else future[0].had
    reported = past[-1].reported if past else ()
    deprecated = here.deprecated is not None if here is not None else any(one.kind == "deprecated" for one in reported)
    return Standing(True, deprecated, here, before, future[0].has if future else None, past, future)


def classify_event(side: str, event: ChangeEvent) -> str:
    """What an event does to a name: it is `gone`, it has `come`, or it has another `form`."""
    whole = [reported for reported in event.reported if "overload" not in reported.aspects]
    come = any(reported.kind == "added" for reported in whole)
    gone = any(one.kind == "removed" or (one.kind == "moved" and (side != "c++" or one.moved_to)) for one in whole)
    return "form" if come == gone else "come" if come else "gone"
