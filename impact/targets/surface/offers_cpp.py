"""What a target's version of a package makes of a use of a C++ name: gone, not yet there, not with these arguments, no
longer overriding, on its way out. Asked of the names that only some stored versions have, or have so (offers.py)."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import lru_cache, partial

from ...facts.surface import CLASSES, FUNCTIONS, Entity, format_declaration
from ...facts.usage import split_arguments
from ..evidence import make_offer_evidence
from ..symbol import Availability, State, Symbol
from ..version import is_at_least
from .changes import Form, Overload
from .conversions import MEMBERS, Conversions, names_class
from .offers import Offered, Offers, PackageOffer, iterate_other_forms, list_declared, make_offered
from .overrides import Override
from .store import SurfaceHistory


def _answer(state: State, offered: Offered, form: str = "", earlier: bool = True, sure: bool = True) -> Availability:
    """What surfaces say of a use of a name. earlier: a version before the target's took it."""
    since = offered.first if earlier or state == "not yet" or not offered.coming else offered.coming
    if state == "deprecated":
        detail = offered.here.deprecated if offered.here is not None else ""
    else:
        detail = offered.before.deprecated if state == "removed" and offered.before is not None else ""
    return Availability(
        Symbol("c++", offered.name, (offered.package,)), state, offered.package, offered.version, since,
        offered.instead, sure=sure and offered.sure, evidence=make_offer_evidence(offered), form=form, earlier=earlier,
        detail=detail or "", gone_in=offered.gone_in if state == "deprecated" else "",
    )  # fmt: skip


def check_use(
    offers: Offers,
    package: str,
    name: str,
    how: str,
    arguments: int,
    given: tuple[str, ...],
    templated: int = -1,
) -> Availability | None:
    """How the target stands to a use of a package's name, where it does not serve it; None where it does, or where that
    cannot be known. The use is described as in model.package.CppApiUse."""
    found = _check_use(offers, package, name, how, arguments, given, templated)
    if found is None or not found.replacement or _can_replace(offers, found, arguments if how == "call" else -1):
        return found
    evidence = found.evidence._replace(instead="") if found.evidence is not None else None
    return found._replace(replacement="", evidence=evidence)


def _can_replace(offers: Offers, found: Availability, arguments: int) -> bool:
    """Whether the target has what stands for a name, and as a function takes so many arguments; -1 for any."""
    new = found.replacement
    owners = (found.package, *offers.surfaces.list_other_packages(new))
    for package in owners:
        offer = offers.find_package(package)
        declared = list(offer.history.iterate_entities(new, offer.stored)) if offer is not None else []
        if offer is not None and declared:
            functions = any(one.kind in FUNCTIONS for one in declared)
            return arguments < 0 or not functions or bool(_list_accepting(offer.history, new, offer.stored, arguments))
    return False


def _check_use(
    offers: Offers,
    package: str,
    name: str,
    how: str,
    arguments: int,
    given: tuple[str, ...],
    templated: int,
) -> Availability | None:
    """The same, with what stands for the name by the comparison of versions, whether or not the target has it."""
    offer = offers.find_package(package)
    offered = offer.get("c++", name) if offer is not None else None
    if offer is None or offered is None or offered.state == "moved" or _lies_between(offer, offered):
        return None
    if how == "override":
        return _check_override(offers, offered, arguments, given)
    if offered.here is None and offered.state in ("removed", "absent"):
        return None if offer.build.has_empty_folders else _check_lacking(offers, offered, how)
    if offers.has_name("c++", name, package):
        return _check_present(offers, offered, how, arguments, given, templated)
    return _check_inherited(offers, offer, name, how, arguments, given)


def _check_present(
    offers: Offers, offered: Offered, how: str, arguments: int, given: tuple[str, ...], templated: int
) -> Availability | None:
    """The same of a name that the target's version has."""
    package, name = offered.package, offered.name
    if offered.here is None or (how != "implement" and _is_alias(offers, package, name)):
        return None
    if how == "implement":
        return _check_unimplemented(offers, offered)
    if offered.state == "deprecated":
        return _answer("deprecated", offered)
    refused = _check_types(offers, offered, templated) if templated >= 0 else None
    if refused is not None or how != "call" or arguments < 0:
        return refused
    return _check_call(offers, offered, arguments, given) or (
        None if templated != -1 else _check_template_arguments(offers, offered, arguments)
    )


def _check_inherited(
    offers: Offers, offer: PackageOffer, name: str, how: str, arguments: int, given: tuple[str, ...]
) -> Availability | None:
    """The same of a member that the target's version has no longer, or not yet, in the class itself but in a base of
    it: its form is that of the base's. None where the base cannot be known."""
    holder = next(_find_holders(offers, offer, name), None)
    return None if holder is None else check_use(offers, *holder, how, arguments, given)


def _find_holders(offers: Offers, offer: PackageOffer, name: str) -> Iterator[tuple[str, str]]:
    """The packages and names of a member of a class in the bases of the class, as the target has them."""
    class_, _, member = name.rpartition("::")
    for base in offer.line.bases.get(class_, ()):
        for package in dict.fromkeys((offer.package, base.partition("::")[0])):
            if offers.has_name("c++", base, package):
                yield package, f"{base}::{member}"
                break


def _check_override(offers: Offers, offered: Offered, arguments: int, given: tuple[str, ...]) -> Availability | None:
    """Whether a method that a class declares overrides none of its base's any more, or not yet."""
    if offered.here is None and (not offered.sure or _is_elsewhere(offers, offered)):
        return None
    line = [(offered.package, offered.name)]
    for package, name in line:
        near = offers.find_package(package)
        line.extend(one for one in _find_holders(offers, near, name) if one not in line) if near is not None else ()
    override = Override(offers, given, arguments)
    lost = override.find_lost_change(line)
    if lost is not None:
        return _answer("changed", *lost)
    unmatched = override.find_unmatched(offered.name.rpartition("::")[2])
    if unmatched is None:
        return None
    method, packages = unmatched
    return Availability(
        Symbol("c++", method.name, packages), "changed", offered.package, offered.version,
        form="unmatched", detail=format_declaration(method),
    )  # fmt: skip


def _lies_between(offer: PackageOffer, offered: Offered) -> bool:
    """Whether the target's version lies before the first stored one with the next change, and may have it already."""
    if offer.exact:
        return False
    versions = offer.line.versions
    newer = next((n for n, known in enumerate(versions) if not is_at_least(offer.version, known)), len(versions))
    following = versions[offer.place + 1 : newer + 1]
    return any(
        version in following
        for version in (offered.coming, offered.first if offered.state == "absent" else "", offered.gone_in)
    )


def _check_lacking(offers: Offers, offered: Offered, how: str) -> Availability | None:
    name = offered.name
    if not offered.sure or _is_from_macro(offers, offered):
        return None  # headers that are made or brought while building may have it
    if _is_elsewhere(offers, offered) or how == "implement" or _is_alias(offers, offered.package, name):
        return None
    sure = True
    if offered.state == "absent":
        offer = offers.find_package(offered.package)
        owner = name.rpartition("::")[0]
        bases = offer.line.bases.get(owner, ()) if offer is not None else ()
        # The compiler may make it, or a base has had it before.
        if offered.what in ("constructor", "destructor") or any(not _is_known_class(offers, base) for base in bases):
            return None
        sure = sure and not bases
    elif offered.what in ("constructor", "destructor"):
        return None
    return _answer("removed" if offered.state == "removed" else "not yet", offered, sure=sure)


def _is_elsewhere(offers: Offers, offered: Offered) -> bool:
    """Whether another package of the target has a name."""
    name, others = offered.name, offers.surfaces.list_other_packages(offered.name)
    return any(other != offered.package and offers.has_name("c++", name, other) for other in others)


_POINTER = re.compile(r"(?:Const|Shared|Unique|Weak)*Ptr\Z")


def _is_from_macro(offers: Offers, offered: Offered) -> bool:
    """Whether a name is one that macros of other packages declare: a pointer to a class that is still there."""
    class_ = _POINTER.sub("", offered.name)
    return class_ != offered.name and offers.has_name("c++", class_, offered.package)


def _is_known_class(offers: Offers, class_: str) -> bool:
    """Whether a class is of a package whose surfaces are stored."""
    return class_.partition("::")[0] in offers.surfaces.packages


def _is_alias(offers: Offers, package: str, name: str) -> bool:
    """Whether the class around a name is something else on some versions, so that its members are not comparable."""
    offer = offers.find_package(package)
    owner = name.rpartition("::")[0]
    if offer is None or not owner:
        return False
    events = offer.line.events.get("c++", {}).get(owner, ())
    return any("kind" in one.aspects or one.what == "alias" for event in events for one in event.reported)


def _check_call(offers: Offers, offered: Offered, arguments: int, given: tuple[str, ...]) -> Availability | None:
    here = list_callable_forms(offered.here)
    if not here:
        return None
    shown = [(one,) for one in given]
    if offered.what == "constructor" and may_be_implicit(offered.name, here, arguments, shown):
        return None
    fitting = [one for one in here if one.accepts(arguments)]
    if any("::" in one for one in given):
        conversions = Conversions(offered.package, partial(_find_stored, offers))
        members = offered.what in MEMBERS
        shown = select_refused(shown, fitting, lambda *pair: members and conversions.is_refused(offered.name, *pair))
    if not fitting or not any(is_accepted(one, shown) for one in fitting):
        for event, form, earlier in iterate_other_forms(offers, offered):
            others = (one for one in list_callable_forms(form) if one.accepts(arguments))
            if any(not fitting or may_have_taken(one, shown) for one in others):
                if not fitting and _is_accepted_by_count(offers, offered, arguments):
                    return None
                why = "types" if fitting else "arguments"
                return _answer("changed", make_offered(offers, offered, event, earlier), why, earlier)
        return None
    relying = all(one.most < 0 or arguments < one.most for one in fitting)
    if relying and offered.first and all(reported.kind == "default" for reported in offered.reported):
        return _answer("changed", offered, "default")
    return None


def _is_accepted_by_count(offers: Offers, offered: Offered, arguments: int) -> bool:
    """Whether the stored version takes so many arguments. Forms tell what breaks somebody: a default that a parameter
    got since changes none."""
    offer = offers.find_package(offered.package)
    found = _list_accepting(offer.history, offered.name, offer.stored, arguments) if offer is not None else ()
    return any("deleted" not in one.traits for one in found)


def may_be_implicit(name: str, here: Iterable[Overload], arguments: int, given: Sequence[Sequence[str]]) -> bool:
    """Whether a call may be one of a constructor that no header declares, since the compiler makes it: one that copies,
    or takes nothing where no other is declared. here: those that are. given: by argument, what it may show itself to
    be."""
    if arguments == 0:
        return not any(makes_anew(one, name) for one in here)
    return arguments == 1 and not any(_ANYTHING.intersection(shown) for shown in given)


_TEMPLATES = FUNCTIONS | CLASSES | {"alias"}
_COPIED = re.compile(r"(?:const )?(?:\w*::)*(?:<.*>)?(?: const)?&{1,2}")


def makes_anew(overload: Overload, name: str) -> bool:
    """Whether a constructor is another than the ones that take nothing or copy. name: its own, in full."""
    class_ = name.rpartition("::")[2]
    return any(type_ and not _COPIED.fullmatch(type_.replace(class_, "")) for type_ in overload.types)


def list_callable_forms(form: Form | None) -> list[Overload]:
    """The overloads of a form that may be called."""
    return [one for one in form.overloads if "deleted" not in one.traits] if form is not None else []


def select_refused(
    given: Sequence[Sequence[str]], here: Collection[Overload], refuses: Callable[[str, str], bool]
) -> list[Sequence[str]]:
    """What arguments may show themselves to be, without the classes of those objects that one of some overloads may
    take. refuses: whether a parameter of a type takes no object of a class."""
    return [
        tuple(one for one in shown if "::" not in one or all(
            place < len(overload.types) and refuses(overload.types[place], one) for overload in here
        ))
        for place, shown in enumerate(given)
    ]  # fmt: skip


def is_accepted(overload: Overload, given: Sequence[Sequence[str]]) -> bool:
    """Whether no argument shows itself to be what its parameter does not take. given: as by select_refused()."""
    pairs = zip(given, overload.types, strict=False)
    return all(
        list_refused_kinds(type_).isdisjoint(shown) and not any("::" in one for one in shown) for shown, type_ in pairs
    )


def may_have_taken(overload: Overload, given: Sequence[Sequence[str]]) -> bool:
    """Whether each argument may be something that its parameter takes; an object of a class: of the very same."""
    pairs = zip(given, overload.types, strict=False)
    return all(
        not shown or (not list_refused_kinds(type_).issuperset(shown) and all(names_class(type_, one) for one in shown))
        for shown, type_ in pairs
    )


def _find_stored(offers: Offers, package: str) -> tuple[SurfaceHistory, str] | None:
    """What is stored of a package, and the version that stands for the target's."""
    offer = offers.find_package(package)
    return (offer.history, offer.stored) if offer is not None else None


# What an argument may show itself to be and no object of a class is.
_ANYTHING = frozenset(("text", "float", "integer", "bool", "null", "lambda", "this", "new"))
# Types of parameters, to what an argument may show itself to be that is not converted to them. `0` is a null pointer,
# and a pointer is a bool; of other classes, constructors may take anything.
_REFUSING = [
    (re.compile(pattern), frozenset(kinds))
    for pattern, kinds in (
        (r".*\brclcpp::\w*QoS\b.*", ("profile",)),
        (r".*rmw_qos_profile_t.*", ("qos",)),
        (r"rmw_qos_profile_t|const rmw_qos_profile_t&", ("text",)),
        (r".*NodeInterfaces<.*|.*RequiredInterfaces&*", ("this",)),
        (r"(?:const )?(?:(?:std|boost)::(?:shared|unique)_ptr<|[\w:]+::(?:Const)?(?:Shared|Unique)Ptr\b).*", ("new",)),
        (r"(?:const )?(?:unsigned int|int|(?:std::)?(?:u?int\d+_t|size_t)|long|float|double)&?",
         ("text", "lambda", "this", "new")),
        (r"(?:const )?std::string&?", ("float", "bool", "lambda", "this")),
        (r"(?:const )?\w+::(?:msg|srv|action)::\w+&?", _ANYTHING),
        (r"(?:const )?std::chrono::(?:(?:nano|micro|milli|)seconds|minutes|hours)&?", _ANYTHING),
    )
]  # fmt: skip


@lru_cache(maxsize=4096)
def list_refused_kinds(type_: str) -> frozenset[str]:
    """What an argument must not show itself to be for a parameter of a type."""
    return frozenset().union(*(kinds for pattern, kinds in _REFUSING if pattern.fullmatch(type_)))


def find_changed_default(offers: Offers, found: Availability, arguments: int) -> tuple[str, str] | None:
    """The default of the first argument left out that was another before, then and now; None where they mean the same,
    or it cannot be known. Reads both versions."""
    assert found.evidence is not None
    history, evidence = offers.find_history(found.package), found.evidence
    return compare_defaults(history, found.symbol.name, evidence.last, evidence.first, arguments)


def compare_defaults(
    history: SurfaceHistory | None, name: str, last: str, first: str, arguments: int
) -> tuple[str, str] | None:
    """The same of a name between two stored versions of its package."""
    old, new = (
        [_list_defaults(one, name) for one in list_declared(history, "c++", name, version)] for version in (last, first)
    )
    if len(old) != 1 or len(new) != 1:
        return None
    for was, now in list(zip(old[0], new[0], strict=False))[arguments:]:
        if was and now and _normalize(was) != _normalize(now) and not (_is_constant(was) or _is_constant(now)):
            return was, now
    return None


def _list_defaults(declaration: str, name: str) -> list[str]:
    """The defaults of a function's parameters, empty for those without."""
    at = declaration.find(f"{name}(")
    found = split_arguments(declaration, at + len(name)) if at >= 0 else None
    return [one.partition(" = ")[2].strip() for one in found[0]] if found is not None else []


def _is_constant(default: str) -> bool:
    """Whether a name stands for the value."""
    return default.replace("::", "").isidentifier() and default not in ("true", "false", "nullptr", "NULL")


def _normalize(default: str) -> str:
    """A default without what only its spelling tells."""
    text = re.sub(r"(?:\w+::)+(?=\w)", "", "".join(default.split()))
    return {"NULL": "nullptr", "0": "nullptr", "string()": '""', "{}": "", '""': '""'}.get(text, text.rstrip("."))


def _check_template_arguments(offers: Offers, offered: Offered, arguments: int) -> Availability | None:
    """Whether a call of what an earlier version took does not tell the template arguments any more."""
    offer = offers.find_package(offered.package)
    if not offered.first or offer is None:
        return None
    place = offer.line.find_place(offered.last)
    before = offer.line.versions[place] if place is not None else ""
    lost = is_not_deducible(offer.history, offered.name, offered.here, offered.before, offer.stored, before, arguments)
    return _answer("changed", offered, "template") if lost else None


def _check_types(offers: Offers, offered: Offered, number: int) -> Availability | None:
    """Whether a template takes so many arguments no longer, or not yet."""
    offer = offers.find_package(offered.package)
    if offer is None or takes_types(offer.history, offered.name, offer.stored, number):
        return None
    for event, _, earlier in iterate_other_forms(offers, offered):
        version = offer.line.versions[event.place - 1 if earlier else event.place]
        if takes_types(offer.history, offered.name, version, number):
            return _answer("changed", make_offered(offers, offered, event, earlier), "template arguments", earlier)
    return None


def takes_types(history: SurfaceHistory, name: str, version: str, number: int) -> bool:
    """Whether a version's template of a name takes so many arguments; True where it is not known. Those of a function
    may be told by what it is called with, and defaults of a class may stand where it is only announced."""
    every = [one for one in history.iterate_entities(name, version) if not one.arguments]
    if any(one.kind not in _TEMPLATES or one.macro for one in every):
        return True
    for one in every:
        parameters = one.template or ()
        packed = any(parameter.pack for parameter in parameters)
        required = sum(parameter.default is None and not parameter.pack for parameter in parameters)
        enough = one.kind in FUNCTIONS or required <= number or history.has_announced(name, version)
        if one.template is not None and enough and (packed or number <= len(parameters)):
            return True
    return not every


def is_not_deducible(
    history: SurfaceHistory, name: str, here: Form | None, before: Form | None, version: str, last: str, arguments: int
) -> bool:
    """Whether every overload that takes so many arguments has a template parameter that none of them tells, where an
    earlier version had one without. here, before: the forms in the stored versions `version` and `last`."""
    if here is None or not any(one.accepts(arguments) for one in find_lost_forms(before, here)):
        return False
    now = _list_accepting(history, name, version, arguments)
    if not now or any(_is_deducible(one, arguments) for one in now):
        return False
    return any(_is_deducible(one, arguments) for one in _list_accepting(history, name, last, arguments))


def _list_accepting(history: SurfaceHistory, name: str, version: str, arguments: int) -> list[Entity]:
    """The overloads of a function in a stored version that take so many arguments."""
    found = []
    for one in history.iterate_entities(name, version):
        parameters = one.parameters or ()
        most = len(parameters) if "variadic" not in one.traits and not any(p.pack for p in parameters) else arguments
        if sum(p.default is None and not p.pack for p in parameters) <= arguments <= most and one.access != "private":
            found.append(one)
    return found


def _is_deducible(one: Entity, arguments: int) -> bool:
    """Whether the arguments of a call tell all parameters of a function's template."""
    given = " ".join(parameter.type for parameter in (one.parameters or ())[:arguments])
    return all(
        parameter.default is not None or parameter.pack or not parameter.name
        or re.search(rf"\b{re.escape(parameter.name)}\b", given)
        for parameter in one.template or ()
    )  # fmt: skip


def _check_unimplemented(offers: Offers, offered: Offered) -> Availability | None:
    """Whether a method that a class does not implement is pure in its base, and was not or will not be."""
    offer = offers.find_package(offered.package)
    # That a method is pure no longer breaks nobody, so that changes do not tell of it.
    declared = offer.history.iterate_entities(offered.name, offer.stored) if offer is not None else ()
    here = [one for one in declared if "virtual" in one.traits]
    if not here or not all("pure" in one.traits for one in here):
        return None
    for form, earlier in ((offered.before, True), (offered.after, False)):
        place = offered.first if earlier else offered.coming
        if place and (form is None or not any("pure" in one.traits for one in form.overloads)):
            return _answer("changed", offered, "pure", earlier)
    return None


def find_lost_forms(before: Form | None, here: Form | None) -> set[Overload]:
    """The overloads of a form that may be called, and that a later one has not."""
    return set(list_callable_forms(before)).difference(list_callable_forms(here))
