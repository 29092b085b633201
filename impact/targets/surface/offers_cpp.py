"""What a target's version of a package makes of a use of a C++ name: gone, not yet there, not with these arguments, no
longer overriding, on its way out. Asked of the names that only some stored versions have, or have so (offers.py)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from ...facts.usage import arguments_at
from ..version import at_least
from .changes import Form, Overload
from .offers import Offer, Offered, Offers, declarations


class Judged(NamedTuple):
    """What is wrong with a use on a target.

    kind: `removed`, `absent`, `arguments`, `types`, `override`, `deprecated` or `default`. earlier: a version before
    the target's took it; else a later one does. version: the first that is so, or, of what is not yet there, the first
    that takes it; gone_in: of what is deprecated, the first without it. sure: nothing about it is guessed."""

    kind: str
    offered: Offered
    earlier: bool
    sure: bool


def judged(offers: Offers, package: str, name: str, how: str, arguments: int, given: tuple[str, ...]) -> Judged | None:
    """What is wrong with a use of a package's name; None for nothing, or where it cannot be told. The use is described
    as in model.package.CppApiUse."""
    offer = offers.package(package)
    offered = offer.get("c++", name) if offer is not None else None
    if offer is None or offered is None or offered.state == "moved" or _between(offer, offered):
        return None
    if offered.here is None and offered.state in ("removed", "absent"):
        return _lacking(offers, offered, how)
    found = _of_what_is_there(offers, offered, how, arguments, given)
    if found is None or offers.there("c++", name, package):
        return found
    return _inherited(offers, offer, name, how, arguments, given)


def _of_what_is_there(
    offers: Offers, offered: Offered, how: str, arguments: int, given: tuple[str, ...]
) -> Judged | None:
    """The same of a name that the target's version has."""
    package, name = offered.package, offered.name
    if offered.here is None or (how != "override" and _is_alias(offers, package, name)):
        return None
    if how == "override":
        return _override(offered, given)
    if offered.state == "deprecated":
        return Judged("deprecated", offered, True, offered.sure)
    return _call(offered, arguments, given) if how == "call" and arguments >= 0 else None


def _inherited(
    offers: Offers, offer: Offer, name: str, how: str, arguments: int, given: tuple[str, ...]
) -> Judged | None:
    """The same of a member that the target's version has no longer, or not yet, in the class itself but in a base of
    it: its form is that of the base's. None where the base cannot be told."""
    class_, _, member = name.rpartition("::")
    for base in offer.line.bases.get(class_, ()):
        for package in dict.fromkeys((offer.package, base.partition("::")[0])):
            if offers.there("c++", base, package):
                return judged(offers, package, f"{base}::{member}", how, arguments, given)
    return None


def _between(offer: Offer, offered: Offered) -> bool:
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


def _lacking(offers: Offers, offered: Offered, how: str) -> Judged | None:
    name = offered.name
    if not offered.sure or _by_macro(offers, offered):
        return None  # headers that are made or brought while building may have it
    if any(other != offered.package and offers.there("c++", name, other) for other in offers.surfaces.elsewhere(name)):
        return None
    if how == "override":
        form = offered.before if offered.state == "removed" else None
        virtual = form is not None and any("virtual" in one.traits for one in form.overloads)
        return Judged("override", offered, True, offered.sure) if virtual else None
    if _is_alias(offers, offered.package, name):
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
    return Judged("removed" if offered.state == "removed" else "absent", offered, offered.state == "removed", sure)


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


# -- calls -------------------------------------------------------------------------------------------------------------


def _call(offered: Offered, arguments: int, given: tuple[str, ...]) -> Judged | None:
    here = _callable(offered.here)
    if not here:
        return None
    if offered.what == "constructor" and arguments < 2:
        return None  # what the compiler makes by itself is not told
    if not any(one.accepts(arguments) for one in here):
        for form, earlier in ((offered.before, True), (offered.after, False)):
            if any(one.accepts(arguments) for one in _callable(form)):
                return Judged("arguments", offered, earlier, offered.sure)
        return None
    if any(given) and not any(_takes(one, given) for one in here if one.accepts(arguments)):
        for form, earlier in ((offered.before, True), (offered.after, False)):
            if any(one.accepts(arguments) and _takes(one, given) for one in _callable(form)):
                return Judged("types", offered, earlier, offered.sure)
        return None
    if offered.first and all(told.kind == "default" for told in offered.told):
        relying = [one for one in here if one.accepts(arguments) and (one.most < 0 or arguments < one.most)]
        if len(relying) == len([one for one in here if one.accepts(arguments)]):
            return Judged("default", offered, True, offered.sure)
    return None


def _callable(form: Form | None) -> list[Overload]:
    return [one for one in form.overloads if "deleted" not in one.traits] if form is not None else []


def _takes(overload: Overload, given: Iterable[str]) -> bool:
    """False when an argument shows itself to be what its parameter does not take."""
    return not any(_clash(shown, type_) for shown, type_ in zip(given, overload.types, strict=False))


def _clash(shown: str, type_: str) -> bool:
    if shown == "profile":
        return bool(re.search(r"\brclcpp::(?:\w*QoS)\b", type_))
    if shown == "qos":
        return "rmw_qos_profile_t" in type_
    if shown == "this":
        return "NodeInterfaces<" in type_ or type_.removesuffix("&").endswith("RequiredInterfaces")
    if shown == "text":
        return type_ in ("rmw_qos_profile_t", "const rmw_qos_profile_t&")
    return False


def defaults_changed(offers: Offers, found: Judged, arguments: int) -> tuple[str, str] | None:
    """The default of the first argument left out that was another before, then and now; None where they mean the same,
    or it cannot be told. Reads both versions."""
    offered = found.offered
    old, new = (
        [_defaults(one, offered.name) for one in declarations(offers.surfaces, offered.package, "c++", offered.name, v)]
        for v in (offered.last, offered.first)
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


# -- overrides ---------------------------------------------------------------------------------------------------------


def _override(offered: Offered, given: tuple[str, ...]) -> Judged | None:
    """Whether a method that a class declares overrides none of its base's any more, or not yet."""
    const = "const" in given
    types = tuple(one for one in given if one not in ("const", "override"))
    here = _virtual(offered.here)
    if any(_same(one, types, const) is not False for one in here):
        return None
    for form, earlier in ((offered.before, True), (offered.after, False)):
        # A method that is not to override anything need not do so yet.
        if any(_same(one, types, const) for one in _virtual(form)) and (earlier or "override" in given):
            return Judged("override", offered, earlier, offered.sure)
    return None


def _virtual(form: Form | None) -> list[Overload]:
    return [one for one in form.overloads if "virtual" in one.traits] if form is not None else []


def _same(overload: Overload, types: tuple[str, ...], const: bool) -> bool | None:
    """Whether a method with these parameters overrides another; None where their types are spelt otherwise."""
    if len(overload.types) != len(types) or ("const" in overload.traits) != const:
        return False
    mine, theirs = [_last(one) for one in types], [_last(one) for one in overload.types]
    if mine == theirs:
        return True
    return None if any(a == b for a, b in zip(mine, theirs, strict=True)) or not mine else False


def _last(type_: str) -> str:
    """A type without its scopes and without what callers do not see."""
    bare = re.sub(r"(?:\w+::)+(?=\w)", "", type_)
    bare = re.sub(r"\bconst\b|\btypename\b", " ", bare) if not bare.endswith(("&", "*")) else bare
    return "".join(bare.split())
