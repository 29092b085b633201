"""What becomes of a use of a Python name on a target: gone there, not there yet, called in a way that is refused there.

Told by the stored surfaces themselves, since a name can be reached by several paths, through re-exports and base
classes; what only some versions have or take is reported, so that nothing rests on one reading alone.
"""

import ast
from collections.abc import Iterable
from functools import lru_cache
from typing import Any

from ....edges.memory import cache_method
from ...facts.python.surface import PythonParameter, make_parameters
from ...facts.python.uses import CallArguments, PythonUse
from ..evidence_record import Evidence
from ..symbol import Availability, State, Symbol
from .offers import Offers, PackageOffer
from .python import UNKNOWN, PythonName, SurfaceNames, is_wrapped, write_signature


class PythonOffers:
    """The Python names of a target's packages."""

    def __init__(self, offers: Offers):
        self._offers = offers
        self._answers: dict[tuple, Availability | None] = {}
        # By package and the last part of a name, the places in the line of versions around its changes.
        self._places: dict[str, dict[str, set[int]]] = {}

    def ask(self, use: PythonUse, packages: Iterable[str]) -> Availability | None:
        """How the target stands to a use of a name that one of the packages may have, where it does not serve it; None
        where nothing is known."""
        offered = [offer for name in packages if (offer := self._offers.find_package(name)) is not None]
        if len(offered) > 1:  # one that has no Python says nothing of it
            offered = [offer for offer in offered if self.load_names(offer.package, offer.stored)] or offered
        key = (use.name, use.how, use.given, use.parameters, tuple(offer.package for offer in offered))
        if key not in self._answers:
            found = [self._check_use(offer, use) for offer in offered]
            # What one of them has is there, whatever the others lost.
            self._answers[key] = found[0] if found and None not in found else None
        return self._answers[key]

    @cache_method
    def load_names(self, package: str, version: str) -> SurfaceNames | None:
        """The Python names of a stored version; None where it has no Python."""
        history = self._offers.find_history(package)
        python = history.load_python(version) if history is not None else None
        return SurfaceNames(python) if python is not None and python.modules else None

    def _check_use(self, offer: PackageOffer, use: PythonUse) -> Availability | None:
        if use.how == "from":
            return self._check_imported(offer, use) if not self._is_partial(offer) else None
        lost = self._check_at(offer, use, offer.place)
        if lost is None or lost.state == "deprecated" or offer.exact:
            return lost
        # The target's version lies between two that are stored: both have to say the same.
        after = self._check_at(offer, use, offer.place + 1) if offer.place + 1 < len(offer.line.versions) else lost
        return lost if after is not None and _make_comparison_key(after) == _make_comparison_key(lost) else None

    def _check_at(self, offer: PackageOffer, use: PythonUse, place: int) -> Availability | None:
        names = self.load_names(offer.package, offer.line.versions[place])
        if names is None:
            return None
        entry = names.find(use.name)
        if entry is None:
            return self._check_gone(offer, use, place, names)
        if entry is UNKNOWN:
            return None
        # `Class.method(object, ...)` gives `self` among the arguments; nothing is said of it.
        if use.given is not None and not (use.how == "call" and entry.kind == "method"):
            refused = self._check_call(offer, use, place, names, entry)
            if refused is not None:
                return refused
        if use.how == "override":
            return self._check_override(offer, use, place, entry)
        if entry.bound is not None and entry.bound.deprecated:
            message = entry.bound.deprecated
            detail = "" if message == "deprecated" else message
            return self._answer("deprecated", offer, use.name, sure=not entry.conditional, detail=detail)
        return None

    def _answer(
        self,
        state: State,
        offer: PackageOffer,
        name: str,
        *,
        first: str = "",
        last: str = "",
        old: str = "",
        new: str = "",
        **more: Any,
    ) -> Availability:
        """last, first: the last version that has, or takes, it and the first that has not; of what is not there yet
        first is the first that has it. old, new: the declarations in them. more: of the answer."""
        earlier, form = more.get("earlier", True), more.get("form", "")
        evidence = Evidence(
            offer.package, {"not yet": "added"}.get(state, state), name, more.get("replacement", ""), "python",
            tuple(filter(None, (old,))), tuple(filter(None, (new,))), last, first, stored=True,
        )  # fmt: skip
        if not earlier:
            evidence = evidence._replace(old=evidence.new, new=evidence.old)
        return Availability(Symbol("python", name, (offer.package,)), state, offer.package, offer.version, first,
                            evidence=evidence if form != "never" else None, **more)  # fmt: skip

    def _check_gone(self, offer: PackageOffer, use: PythonUse, place: int, names: SurfaceNames) -> Availability | None:
        if use.how == "override":
            return None
        parts = use.name.split(".")
        gone = next(name for n in range(1, len(parts) + 1) if names.find(name := ".".join(parts[:n])) is None)
        if hasattr(object, gone.rpartition(".")[2]):
            return None  # every class has it
        versions = offer.line.versions
        earlier, later = self._find_telling_places(offer, gone, place)
        # Versions of older distros that got it meanwhile stand before those of newer ones that have not.
        for other in later:
            has = self._find_entry(offer, other, gone)
            if has is not None:
                return self._answer("not yet", offer, gone, first=versions[other], new=_describe(gone, has),
                                  sure=not has.conditional)  # fmt: skip
        for other in earlier:
            had = self._find_entry(offer, other, gone)
            if had is not None:
                if any(self._has(package, gone) for package in self._offers.surfaces.list_other_packages(gone)):
                    return None
                instead = self._find_replacement(offer, gone, had)
                return self._answer("removed", offer, gone, last=versions[other], first=self._find_next(offer, other),
                                   replacement=instead, old=_describe(gone, had), sure=not had.conditional)  # fmt: skip
        if offer.exact and gone == use.name and not self._is_partial(offer) and self._has_never_had(offer, gone, place):
            return self._answer("not yet", offer, gone, form="never")
        return None

    def _is_partial(self, offer: PackageOffer) -> bool:
        """Whether only what changes is stored, as of libraries of the platform."""
        return self._offers.surfaces.is_library(offer.package)

    def _has_never_had(self, offer: PackageOffer, name: str, place: int) -> bool:
        """Whether a module that is there surely lacks a name that others of the package have, in the version at a place
        and in those beside it."""
        module, _, word = name.rpartition(".")
        if word not in offer.history.python_words:
            return False
        versions = offer.line.versions[max(place - 1, 0) : place + 2]
        read = [
            self.load_names(offer.package, version) for version in versions if version not in offer.line.approximate
        ]
        return len(read) > 1 and all(
            names is not None and module in names.modules and names.find(name) is None for names in read
        )

    def _check_imported(self, offer: PackageOffer, use: PythonUse) -> Availability | None:
        """A name that is imported from a module that is there, or taken of a class that is, and that no version knows
        anywhere, or knows in other modules alone."""
        module, _, word = use.name.rpartition(".")
        if offer.stored in offer.line.approximate:
            return None
        if word in offer.history.python_words and not self._has_never_had(offer, use.name, offer.place):
            return None
        if not offer.exact and offer.place + 1 == len(offer.line.versions):
            return None  # newer than all that were read, and may have got it
        names = self.load_names(offer.package, offer.stored)
        if names is None or names.find(use.name) is not None:
            return None
        of = names.find(module)
        if module not in names.modules and (of is None or of.kind != "class"):
            return None
        return self._answer("not yet", offer, use.name, sure=offer.exact, form="never")

    def _find_telling_places(self, offer: PackageOffer, name: str, place: int) -> tuple[list[int], list[int]]:
        """Places of the versions before and after one in which a name may be otherwise, the nearest first: those on
        both sides of each change of a name that ends alike."""
        if offer.package not in self._places:
            known = self._places[offer.package] = {}
            for changed, events in offer.line.events.get("python", {}).items():
                parts = changed.split(".")
                last = parts[-2] if parts[-1] in ("__init__", "__new__") and len(parts) > 1 else parts[-1]
                known.setdefault(last, set()).update(at for event in events for at in (event.place - 1, event.place))
        last = name.removesuffix(".__init__").rpartition(".")[2]
        places = sorted(at for at in self._places[offer.package].get(last, ()) if at >= 0)
        return [at for at in reversed(places) if at < place], [at for at in places if at > place]

    def _find_entry(self, offer: PackageOffer, place: int, name: str) -> PythonName | None:
        """What a name is in a stored version; None where it is not there, or that cannot be known."""
        version = offer.line.versions[place]
        names = self.load_names(offer.package, version) if version not in offer.line.approximate else None
        found = names.find(name) if names is not None else None
        return None if found is UNKNOWN else found

    def _find_next(self, offer: PackageOffer, place: int) -> str:
        """The version after a stored one, as far as releases were read."""
        later = offer.line.versions[place + 1 : offer.place]
        return next((version for version in later if version not in offer.line.approximate), offer.stored)

    def _has(self, package: str, name: str) -> bool:
        offer = self._offers.find_package(package)
        return offer is not None and self._find_entry(offer, offer.place, name) is not None

    def _find_replacement(self, offer: PackageOffer, gone: str, had: PythonName) -> str:
        """What the comparison of versions tells to use, by the name itself or by where it was defined."""
        for name in (gone, had.where):
            known = offer.get("python", name)
            if known is not None and known.state in ("removed", "moved"):
                return known.instead
        return ""

    def _check_call(
        self, offer: PackageOffer, use: PythonUse, place: int, names: SurfaceNames, entry: PythonName
    ) -> Availability | None:
        here = find_parameters(names, entry)
        assert use.given is not None
        why = explain_refusal(use.given, here) if here is not None else ""
        if here is None or not why:
            return None
        versions = offer.line.versions
        earlier, later = self._find_telling_places(offer, use.name, place)
        for other in (*earlier, *later):
            took = self._find_entry(offer, other, use.name)
            known = self.load_names(offer.package, versions[other])
            then = find_parameters(known, took) if known is not None and took is not None else None
            if then is None or took is None or explain_refusal(use.given, then):
                continue
            if other > place:
                last, first = "", versions[other]
            else:
                last, first = versions[other], self._find_next(offer, other)
            return self._answer(
                "changed", offer, use.name, form="call", earlier=other < place, last=last, first=first, detail=why,
                old=f"{use.name}{write_signature(then)}", new=f"{use.name}{write_signature(here)}",
                sure=not (entry.conditional or took.conditional),
            )  # fmt: skip
        return None

    def _check_override(
        self, offer: PackageOffer, use: PythonUse, place: int, entry: PythonName
    ) -> Availability | None:
        """The base class has a method that is overridden, with other parameters than it had."""
        own = read_parameters(use.parameters)
        if own is None or entry.bound is None or entry.bound.kind != "method" or is_wrapped(entry.bound):
            return None
        here = entry.bound.parameters
        why = explain_difference(own, here)
        versions = offer.line.versions
        for other in self._find_telling_places(offer, use.name, place)[0] if why else ():
            had = self._find_entry(offer, other, use.name)
            if had is None or had.bound is None or had.bound.kind != "method":
                continue
            if not explain_difference(own, had.bound.parameters):
                return self._answer(
                    "changed", offer, use.name, form="override", last=versions[other],
                    first=self._find_next(offer, other), detail=why,
                    old=f"{use.name}{write_signature(had.bound.parameters)}", new=f"{use.name}{write_signature(here)}",
                    sure=not (entry.conditional or had.conditional),
                )  # fmt: skip
        return None


def _make_comparison_key(found: Availability) -> tuple[str, str, bool, str]:
    return found.state, found.form, found.earlier, found.symbol.name


def _describe(name: str, entry: PythonName) -> str:
    if entry.bound is None or entry.bound.kind in ("class", "attribute", "instance", "property"):
        return name
    return f"{name}{write_signature(entry.bound.parameters)}"


def find_parameters(names: SurfaceNames, entry: PythonName) -> tuple[PythonParameter, ...] | None:
    """The parameters of a function or class; None where they cannot be known."""
    if entry.kind == "class":
        maker = names.find_member(entry, "__new__")
        found = names.list_members(entry).get("__init__") or names.find_member(entry, "__init__")
        # A class that makes its objects itself may take what its __init__ does not.
        if (maker is not None and maker.bound is not None) or found is None or found is UNKNOWN:
            return None
        entry = found
    bound = entry.bound
    if bound is None or bound.kind not in ("function", "method", "classmethod", "staticmethod") or is_wrapped(bound):
        return None
    return bound.parameters


def explain_refusal(given: CallArguments, parameters: Iterable[PythonParameter]) -> str:
    """Why a call with these arguments fails, in a clause; empty where it does not, as far as can be known."""
    parameters = tuple(parameters)
    kinds = {parameter.kind for parameter in parameters}
    positional = [p for p in parameters if p.kind in ("positional", "normal")]
    if given.positional > len(positional) and "args" not in kinds:
        return f"it takes {f'at most {len(positional)}' if positional else 'no'} arguments by position"
    by_name = {p.name for p in parameters if p.kind in ("normal", "keyword")}
    for keyword in given.keywords:
        if keyword not in by_name and "kwargs" not in kinds:
            return f"it has no parameter `{keyword}`"
    taken = {p.name for p in positional[: given.positional]}
    for keyword in given.keywords:
        if keyword in taken and keyword in by_name:
            return f"`{keyword}` is given by position and by name"
    if given.open:
        return ""
    needed = (p.name for p in parameters if p.default is None and p.kind in ("positional", "normal", "keyword"))
    return next((f"`{name}` must be given" for name in needed if name not in taken and name not in given.keywords), "")


def explain_difference(own: tuple[PythonParameter, ...], base: tuple[PythonParameter, ...]) -> str:
    """Why a method with its own parameters cannot stand for one of the base's: by what has to be given to either."""
    kinds = {p.kind for p in own}
    wanted = [p for p in base if p.kind in ("positional", "normal") and p.default is None]
    taken = [p for p in own if p.kind in ("positional", "normal")]
    if len(wanted) > len(taken) and "args" not in kinds:
        return f"`{wanted[len(taken)].name}` is given to it and not taken"
    most = sum(p.kind in ("positional", "normal") for p in base)
    needed = [p for p in taken if p.default is None]
    if len(needed) > most and not any(p.kind == "args" for p in base):
        return f"`{needed[most].name}` is not given to it"
    names = {p.name for p in own}
    asked = (p.name for p in base if p.kind == "keyword" and p.default is None)
    missed = next((name for name in asked if name not in names), "")
    return f"`{missed}` is given to it and not taken" if missed and "kwargs" not in kinds else ""


@lru_cache(maxsize=4096)
def read_parameters(text: str) -> tuple[PythonParameter, ...] | None:
    """Parameters as Python writes them, `(a, b=..., *, c)`; None for what is none."""
    try:
        (function,) = ast.parse(f"def f{text}: pass").body
    except (SyntaxError, ValueError):
        return None
    return tuple(make_parameters(function.args)) if isinstance(function, ast.FunctionDef) else None
