"""What a target's version of a package makes of a use of a C++ name: gone, not yet there, not with these arguments, no
longer overriding, on its way out. Asked of the names that only some stored versions have, or have so (offers.py)."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING

from ...facts.surface import Entity
from ...facts.usage import arguments_at
from ..evidence import of_offered
from ..symbol import Availability, State, Symbol
from ..version import at_least
from .changes import Form, Overload
from .offers import Offered, Offers, PackageOffer, declarations, offered_by, other_forms
from .overrides import Override, virtual_forms

if TYPE_CHECKING:
    from .store import SurfaceHistory


def _found(state: State, offered: Offered, form: str = "", earlier: bool = True, sure: bool = True) -> Availability:
    """What surfaces say of a use of a name. earlier: a version before the target's took it."""
    since = offered.first if earlier or state == "not yet" or not offered.coming else offered.coming
    if state == "deprecated":
        detail = offered.here.deprecated if offered.here is not None else ""
    else:
        detail = offered.before.deprecated if state == "removed" and offered.before is not None else ""
    return Availability(
        Symbol("c++", offered.name, (offered.package,)), state, offered.package, offered.version, since,
        offered.instead, sure=sure and offered.sure, evidence=of_offered(offered), form=form, earlier=earlier,
        detail=detail or "", gone_in=offered.gone_in if state == "deprecated" else "",
    )  # fmt: skip


def availability_of_use(
    offers: Offers,
    package: str,
    name: str,
    how: str,
    arguments: int,
    given: tuple[str, ...],
    templated: bool = False,
) -> Availability | None:
    """How the target stands to a use of a package's name, where it does not serve it; None where it does, or where that
    cannot be told. The use is described as in model.package.CppApiUse."""
    offer = offers.package(package)
    offered = offer.get("c++", name) if offer is not None else None
    if offer is None or offered is None or offered.state == "moved" or _between(offer, offered):
        return None
    if how == "override":
        return _override(offers, offered, arguments, given)
    if offered.here is None and offered.state in ("removed", "absent"):
        return _lacking(offers, offered, how)
    if offers.there("c++", name, package):
        return _of_what_is_there(offers, offered, how, arguments, given, templated)
    return _inherited(offers, offer, name, how, arguments, given)


def _of_what_is_there(
    offers: Offers, offered: Offered, how: str, arguments: int, given: tuple[str, ...], templated: bool
) -> Availability | None:
    """The same of a name that the target's version has."""
    package, name = offered.package, offered.name
    if offered.here is None or (how != "implement" and _is_alias(offers, package, name)):
        return None
    if how == "implement":
        return _unmade(offered)
    if offered.state == "deprecated":
        return _found("deprecated", offered)
    if how != "call" or arguments < 0:
        return None
    return _call(offers, offered, arguments, given) or (None if templated else _untold(offers, offered, arguments))


def _inherited(
    offers: Offers, offer: PackageOffer, name: str, how: str, arguments: int, given: tuple[str, ...]
) -> Availability | None:
    """The same of a member that the target's version has no longer, or not yet, in the class itself but in a base of
    it: its form is that of the base's. None where the base cannot be told."""
    holder = next(_holders(offers, offer, name), None)
    return None if holder is None else availability_of_use(offers, *holder, how, arguments, given)


def _holders(offers: Offers, offer: PackageOffer, name: str) -> Iterator[tuple[str, str]]:
    """The packages and names of a member of a class in the bases of the class, as the target has them."""
    class_, _, member = name.rpartition("::")
    for base in offer.line.bases.get(class_, ()):
        for package in dict.fromkeys((offer.package, base.partition("::")[0])):
            if offers.there("c++", base, package):
                yield package, f"{base}::{member}"
                break


def _override(offers: Offers, offered: Offered, arguments: int, given: tuple[str, ...]) -> Availability | None:
    """Whether a method that a class declares overrides none of its base's any more, or not yet."""
    if offered.here is None and (not offered.sure or _elsewhere(offers, offered)):
        return None
    line = [(offered.package, offered.name)]
    for package, name in line:
        near = offers.package(package)
        line.extend(one for one in _holders(offers, near, name) if one not in line) if near is not None else ()
    lost = Override(offers, given, arguments).lost(line)
    return _found("changed", lost[0], "override", lost[1]) if lost is not None else None


def _between(offer: PackageOffer, offered: Offered) -> bool:
    """Whether the target's version lies before the first stored one with the next change, and may have it already."""
    if offer.exact:
        return False
    versions = offer.line.versions
    newer = next((n for n, known in enumerate(versions) if not at_least(offer.version, known)), len(versions))
    following = versions[offer.place + 1 : newer + 1]
    return any(
        version in following
        for version in (offered.coming, offered.first if offered.state == "absent" else "", offered.gone_in)
    )


def _lacking(offers: Offers, offered: Offered, how: str) -> Availability | None:
    name = offered.name
    if not offered.sure or _by_macro(offers, offered):
        return None  # headers that are made or brought while building may have it
    if _elsewhere(offers, offered) or how == "implement" or _is_alias(offers, offered.package, name):
        return None
    sure = True
    if offered.state == "absent":
        offer = offers.package(offered.package)
        owner = name.rpartition("::")[0]
        bases = offer.line.bases.get(owner, ()) if offer is not None else ()
        # The compiler may make it, or a base has had it before.
        if offered.what in ("constructor", "destructor") or any(not _known(offers, base) for base in bases):
            return None
        sure = sure and not bases
    elif offered.what in ("constructor", "destructor"):
        return None
    return _found("removed" if offered.state == "removed" else "not yet", offered, sure=sure)


def _elsewhere(offers: Offers, offered: Offered) -> bool:
    """Whether another package of the target has a name."""
    name, others = offered.name, offers.surfaces.elsewhere(offered.name)
    return any(other != offered.package and offers.there("c++", name, other) for other in others)


_POINTER = re.compile(r"(?:Const|Shared|Unique|Weak)*Ptr\Z")


def _by_macro(offers: Offers, offered: Offered) -> bool:
    """Whether a name is one that macros of other packages declare: a pointer to a class that is still there."""
    class_ = _POINTER.sub("", offered.name)
    return class_ != offered.name and offers.there("c++", class_, offered.package)


def _known(offers: Offers, class_: str) -> bool:
    """Whether a class is of a package whose surfaces are stored."""
    return class_.partition("::")[0] in offers.surfaces.packages


def _is_alias(offers: Offers, package: str, name: str) -> bool:
    """Whether the class around a name is something else on some versions, so that its members are not comparable."""
    offer = offers.package(package)
    owner = name.rpartition("::")[0]
    if offer is None or not owner:
        return False
    events = offer.line.events.get("c++", {}).get(owner, ())
    return any("kind" in told.aspects or told.what == "alias" for event in events for told in event.told)


def _call(offers: Offers, offered: Offered, arguments: int, given: tuple[str, ...]) -> Availability | None:
    here = callable_forms(offered.here)
    if not here:
        return None
    if offered.what == "constructor" and arguments < 2:
        return None  # what the compiler makes by itself is not told
    if not any(one.accepts(arguments) for one in here):
        for event, form, earlier in other_forms(offers, offered):
            if any(one.accepts(arguments) for one in callable_forms(form)):
                return _found("changed", offered_by(offers, offered, event, earlier), "arguments", earlier)
        return None
    if any(given) and not any(_takes(one, given) for one in here if one.accepts(arguments)):
        for event, form, earlier in other_forms(offers, offered):
            if any(one.accepts(arguments) and _takes(one, given) for one in callable_forms(form)):
                return _found("changed", offered_by(offers, offered, event, earlier), "types", earlier)
        return None
    if offered.first and all(told.kind == "default" for told in offered.told):
        relying = [one for one in here if one.accepts(arguments) and (one.most < 0 or arguments < one.most)]
        if len(relying) == len([one for one in here if one.accepts(arguments)]):
            return _found("changed", offered, "default")
    return None


def callable_forms(form: Form | None) -> list[Overload]:
    """The overloads of a form that may be called."""
    return [one for one in form.overloads if "deleted" not in one.traits] if form is not None else []


def _takes(overload: Overload, given: Iterable[str]) -> bool:
    """False when an argument shows itself to be what its parameter does not take."""
    return not any(_clash(shown, type_) for shown, type_ in zip(given, overload.types, strict=False))


# What takes a raw pointer only where it is asked to.
_OWNING = re.compile(r"(?:const )?(?:(?:std|boost)::(?:shared|unique)_ptr<|[\w:]+::(?:Const)?(?:Shared|Unique)Ptr\b)")


REFUSED = frozenset(("profile", "qos", "this", "new", "text"))
"""What an argument may show itself to be that some parameters do not take."""


@lru_cache(maxsize=4096)
def refused_by(type_: str) -> frozenset[str]:
    """What an argument must not show itself to be for a parameter of a type."""
    return frozenset(shown for shown in REFUSED if _clash(shown, type_))


def _clash(shown: str, type_: str) -> bool:
    if shown == "profile":
        return bool(re.search(r"\brclcpp::(?:\w*QoS)\b", type_))
    if shown == "qos":
        return "rmw_qos_profile_t" in type_
    if shown == "this":
        return "NodeInterfaces<" in type_ or type_.removesuffix("&").endswith("RequiredInterfaces")
    if shown == "new":
        return bool(_OWNING.match(type_))
    if shown == "text":
        return type_ in ("rmw_qos_profile_t", "const rmw_qos_profile_t&")
    return False


def defaults_changed(offers: Offers, found: Availability, arguments: int) -> tuple[str, str] | None:
    """The default of the first argument left out that was another before, then and now; None where they mean the same,
    or it cannot be told. Reads both versions."""
    assert found.evidence is not None
    history, evidence = offers.history(found.package), found.evidence
    return default_changed(history, found.symbol.name, evidence.last, evidence.first, arguments)


def default_changed(
    history: SurfaceHistory | None, name: str, last: str, first: str, arguments: int
) -> tuple[str, str] | None:
    """The same of a name between two stored versions of its package."""
    old, new = (
        [_defaults(one, name) for one in declarations(history, "c++", name, version)] for version in (last, first)
    )
    if len(old) != 1 or len(new) != 1:
        return None
    for was, now in list(zip(old[0], new[0], strict=False))[arguments:]:
        if was and now and _meaning(was) != _meaning(now) and not (_constant(was) or _constant(now)):
            return was, now
    return None


def _defaults(declaration: str, name: str) -> list[str]:
    """The defaults of a function's parameters, empty for those without."""
    at = declaration.find(f"{name}(")
    found = arguments_at(declaration, at + len(name)) if at >= 0 else None
    return [one.partition(" = ")[2].strip() for one in found[0]] if found is not None else []


def _constant(default: str) -> bool:
    """Whether a name stands for the value."""
    return default.replace("::", "").isidentifier() and default not in ("true", "false", "nullptr", "NULL")


def _meaning(default: str) -> str:
    """A default without what only its spelling tells."""
    text = re.sub(r"(?:\w+::)+(?=\w)", "", "".join(default.split()))
    return {"NULL": "nullptr", "0": "nullptr", "string()": '""', "{}": "", '""': '""'}.get(text, text.rstrip("."))


def _untold(offers: Offers, offered: Offered, arguments: int) -> Availability | None:
    """Whether a call of what an earlier version took does not tell the template arguments any more."""
    offer = offers.package(offered.package)
    if not offered.first or offer is None:
        return None
    place = offer.line.place(offered.last)
    before = offer.line.versions[place] if place is not None else ""
    untold = is_untold(offer.history, offered.name, offered.here, offered.before, offer.stored, before, arguments)
    return _found("changed", offered, "template") if untold else None


def is_untold(
    history: SurfaceHistory, name: str, here: Form | None, before: Form | None, version: str, last: str, arguments: int
) -> bool:
    """Whether every overload that takes so many arguments has a template parameter that none of them tells, where an
    earlier version had one without. here, before: the forms in the stored versions `version` and `last`."""
    if here is None or not any(one.accepts(arguments) for one in lost_forms(before, here)):
        return False
    now = _accepting(history, name, version, arguments)
    if not now or any(_is_told(one, arguments) for one in now):
        return False
    return any(_is_told(one, arguments) for one in _accepting(history, name, last, arguments))


def _accepting(history: SurfaceHistory, name: str, version: str, arguments: int) -> list[Entity]:
    """The overloads of a function in a stored version that take so many arguments."""
    found = []
    for one in history.entities(name, version):
        parameters = one.parameters or ()
        most = len(parameters) if "variadic" not in one.traits and not any(p.pack for p in parameters) else arguments
        if sum(p.default is None and not p.pack for p in parameters) <= arguments <= most and one.access != "private":
            found.append(one)
    return found


def _is_told(one: Entity, arguments: int) -> bool:
    """Whether the arguments of a call tell all parameters of a function's template."""
    given = " ".join(parameter.type for parameter in (one.parameters or ())[:arguments])
    return all(
        parameter.default is not None or parameter.pack or not parameter.name
        or re.search(rf"\b{re.escape(parameter.name)}\b", given)
        for parameter in one.template or ()
    )  # fmt: skip


def _unmade(offered: Offered) -> Availability | None:
    """Whether a method that a class does not implement is pure in its base, and was not or will not be."""
    here = virtual_forms(offered.here)
    if not here or not all("pure" in one.traits for one in here):
        return None
    for form, earlier in ((offered.before, True), (offered.after, False)):
        place = offered.first if earlier else offered.coming
        if place and (form is None or not any("pure" in one.traits for one in form.overloads)):
            return _found("changed", offered, "pure", earlier)
    return None


def lost_forms(before: Form | None, here: Form | None) -> set[Overload]:
    """The overloads of a form that may be called, and that a later one has not."""
    return set(callable_forms(before)).difference(callable_forms(here))
