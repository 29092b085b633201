"""Mismatches of values as diagnostics, for the rules of this family."""

from collections.abc import Iterator

from ...model.package import find_folder_role
from ...values.joining import find_mismatches, find_unit_mismatches
from ...values.matching import UNIT, Mismatch
from ..vocabulary import At, Diagnostic, Doubt, Value, Workspace

_DOUBTS = {"error": (), "warning": (Doubt.INCOMPLETE,), "note": (Doubt.UNCHECKED,)}


def find_diagnostics(workspace: Workspace, kind: str) -> Iterator[Diagnostic]:
    """The mismatches of a rule. A crash is reported where it happens, what waits for a value where it waits, and all
    else where it is sent."""
    for one in find_unit_mismatches(workspace) if kind == UNIT else find_mismatches(workspace):
        if one.kind != kind:
            continue
        path, line = _find_place(one)
        package = next((each.name for each in _list_packages(workspace, path)), "")
        variant = "standard" if kind == UNIT and one.subscriber is None else ""
        doubts = (*_DOUBTS[one.severity], *_list_role_doubts(one, path))
        yield Diagnostic(At(path, line), one.field, package, describe(one), variant, doubts)


def _list_role_doubts(one: Mismatch, path: str) -> list[Doubt]:
    """What speaks against a finding whose publisher or subscriber is a test or an example."""
    paths = [path, *(place.path for place in (one.sender.places if one.sender is not None else ()))]
    roles = {find_folder_role(each) for each in paths}
    found = {"test": Doubt.TEST, "aside": Doubt.EXAMPLE}
    return [doubt for role, doubt in found.items() if role in roles]


def _find_place(one: Mismatch) -> tuple[str, int]:
    if one.sender is not None and (one.place is None or one.kind == UNIT):
        return one.sender.places[0].path, one.sender.places[0].line
    if one.place is not None:
        return one.place.path, one.place.line
    return (one.subscriber.path, one.subscriber.line) if one.subscriber is not None else ("", 0)


def _list_packages(workspace: Workspace, path: str):
    """The packages around a path, the nearest first."""
    found = [each for each in workspace if not each.path or path.startswith(each.path + "/")]
    return sorted(found, key=lambda each: -len(each.path))


def describe(one: Mismatch) -> dict[str, Value]:
    """What the texts say of a mismatch."""
    sender, subscriber = one.sender, one.subscriber
    place = sender.places[0] if sender is not None else None
    hops = sender.via if sender is not None else ()
    return {
        "topic": one.topic,
        "value": one.values,
        "crash": one.why,
        "expected": one.why,
        "word": "is" if one.is_sent else "may be",
        "ends": "ends" if one.sure else "may end",
        "reads": "is read" if one.sure else "may be read",
        "sender": f"{place.path}:{place.line}" if place is not None else "",
        "subscriber": subscriber.callback if subscriber is not None else "",
        "reader": f"{subscriber.path}:{subscriber.line}" if subscriber is not None else "",
        "origin": "".join(f"{hop.place.path}:{hop.place.line}" for hop in hops),
    }
