"""Units of what publishers put into fields and of what subscribers take from them: degrees and radians, millimetres and
metres.

A unit is known by the name of what is assigned (`yaw_deg`, `distance_mm`), by a conversion that the code does
(`* M_PI / 180`, `math.radians()`, `/ 1000.0` of millimetres), and by REP-103 for the fields of common messages. An
expression that is anything else has no unit here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from ..facts.flow import FlowExpr
from ..model.flow.code import Fn, get_tail
from ..model.flow.graph import Endpoint, Graph, Publish
from ..model.flow.workspace import get_flow
from ..model.workspace import Workspace
from .outcomes import CodeLine

RADIANS, DEGREES, METRES, CENTIMETRES, MILLIMETRES = "radians", "degrees", "metres", "centimetres", "millimetres"
_ANGLES = (RADIANS, DEGREES)
_MADE_BY = {
    "radians": RADIANS, "deg2rad": RADIANS, "degToRad": RADIANS, "DegToRad": RADIANS, "from_degrees": RADIANS,
    "degrees_to_radians": RADIANS, "toRadians": RADIANS, "degrees": DEGREES, "rad2deg": DEGREES, "radToDeg": DEGREES,
    "RadToDeg": DEGREES, "to_degrees": DEGREES, "radians_to_degrees": DEGREES, "toDegrees": DEGREES,
}  # fmt: skip
_TAKEN_BY = {name: DEGREES if unit == RADIANS else RADIANS for name, unit in _MADE_BY.items()}
_SUFFIXES = (
    (re.compile(r"_(deg|degs|degree|degrees)_?$|[a-z]Deg(rees)?_?$"), DEGREES),
    (re.compile(r"_(rad|rads|radian|radians)_?$|[a-z]Rad(ians)?_?$"), RADIANS),
    (re.compile(r"_(mm|millimeters?|millimetres?)_?$"), MILLIMETRES),
    (re.compile(r"_(cm|centimeters?|centimetres?)_?$"), CENTIMETRES),
    (re.compile(r"_(meters?|metres?)_?$"), METRES),
)  # fmt: skip
_PI = r"(?:M_PI|PI|pi|math\.pi|np\.pi|numpy\.pi|std::numbers::pi|3\.14\d*)"
_NAME = r"[A-Za-z_][\w.:\[\]]*"
_TO_RADIANS = re.compile(rf"({_NAME}) ?\* ?(?:\(? ?{_PI} ?/ ?180(?:\.0*f?)? ?\)?|DEG2RAD|DEG_TO_RAD|kDegToRad)$")
_TO_RADIANS_BY_PARTS = re.compile(rf"({_NAME}) ?/ ?180(?:\.0*f?)? ?\* ?{_PI}$")
_TO_DEGREES = re.compile(rf"({_NAME}) ?\* ?(?:\(? ?180(?:\.0*f?)? ?/ ?{_PI} ?\)?|RAD2DEG|RAD_TO_DEG|kRadToDeg)$")
_TO_DEGREES_BY_PARTS = re.compile(rf"({_NAME}) ?/ ?{_PI} ?\* ?180(?:\.0*f?)?$")
_THOUSANDTH = re.compile(rf"({_NAME}) ?(?:/ ?1000(?:\.0*f?)?|\* ?(?:0\.001f?|1e-3))$")
_HUNDREDTH = re.compile(rf"({_NAME}) ?(?:/ ?100(?:\.0*f?)?|\* ?(?:0\.01f?|1e-2))$")
_THOUSANDFOLD = re.compile(rf"({_NAME}) ?\* ?1000(?:\.0*f?)?$")
_CAST = re.compile(r"^(?:static_cast<[\w: ]+> ?|float|double|int|np\.float32|np\.float64) ?\((.*)\)$")
_CONVERTED = (
    (_TO_RADIANS, DEGREES, RADIANS), (_TO_RADIANS_BY_PARTS, DEGREES, RADIANS), (_TO_DEGREES, RADIANS, DEGREES),
    (_TO_DEGREES_BY_PARTS, RADIANS, DEGREES),
)  # fmt: skip

# REP-103: https://www.ros.org/reps/rep-0103.html. Fields by the end of their path, in messages of these packages.
_STANDARD = ("geometry_msgs", "nav_msgs", "sensor_msgs", "ackermann_msgs", "turtlesim")
_FIELDS = (
    (re.compile(r"(^|\.)angular(_velocity)?\.[xyz]$"), RADIANS),
    (re.compile(r"(^|\.)(angle_min|angle_max|angle_increment|field_of_view|steering_angle|theta)$"), RADIANS),
    (re.compile(r"(^|\.)(position|translation|linear|point)\.[xyz]$"), METRES),
    (re.compile(r"(^|\.)(range_min|range_max|min_range|max_range|range|ranges(\.\[\])?)$"), METRES),
)  # fmt: skip


class UnitUse(NamedTuple):
    """A unit that code gives a field or takes it to have. how: what tells, as written."""

    field: str
    unit: str
    how: str
    place: CodeLine
    function: str


class UnitMismatch(NamedTuple):
    """A field that is written in one unit and read in another. read: None where REP-103 alone tells; expected: the unit
    that the field should have."""

    topic: str
    type: str
    written: UnitUse
    read: UnitUse | None
    expected: str


def list_unit_mismatches(workspace: Workspace, graph: Graph) -> list[UnitMismatch]:
    """Where the units of publishers and subscribers differ, topic by topic."""
    functions = get_flow(workspace).code.code.functions_in
    read: dict[str, list[tuple[Endpoint, UnitUse]]] = {}
    for one in graph.endpoints:
        if one.role == "subscriber" and one.topic and one.callback is not None:
            for fn in functions.get(one.callback.path, ()):
                if fn.facts.line == one.callback.line and fn.name == one.callback.name:
                    read.setdefault(one.topic, []).extend((one, use) for use in _list_read(fn))
    found: dict[tuple[object, ...], UnitMismatch] = {}
    for statement in graph.publishes:
        if not statement.topic or not statement.type:
            continue
        for written in _list_written(statement, list(functions.get(statement.path, ()))):
            for each in _compare(statement, written, read.get(statement.topic, [])):
                found.setdefault((each.topic, each.written.place, written.field, each.read and each.read.place), each)
    return list(found.values())


def _compare(statement: Publish, written: UnitUse, read: list[tuple[Endpoint, UnitUse]]) -> Iterator[UnitMismatch]:
    own = [use for one, use in read if use.field == written.field and one.type in ("", "*", statement.type)]
    for use in own:
        if _differ(use.unit, written.unit):
            yield UnitMismatch(statement.topic, statement.type, written, use, use.unit)
    expected = find_standard_unit(statement.type, written.field)
    # Where both sides of a workspace agree on another unit, they do so on purpose.
    if expected and _differ(expected, written.unit) and not own:
        yield UnitMismatch(statement.topic, statement.type, written, None, expected)


def _differ(one: str, other: str) -> bool:
    return one != other and (one in _ANGLES) == (other in _ANGLES)


def find_standard_unit(type_: str, field: str) -> str:
    """The unit that REP-103 gives a field of a common message; empty for others."""
    if type_.partition("/")[0] not in _STANDARD:
        return ""
    return next((unit for pattern, unit in _FIELDS if pattern.search(field)), "")


def _list_written(statement: Publish, functions: list[Fn]) -> Iterator[UnitUse]:
    """The units of the fields of what a statement publishes, as far as its function shows them."""
    fn = _find_function(statement, functions)
    if fn is None:
        return
    call = next((
        each for each in fn.facts.calls if each.line == statement.line and get_tail(each.callee) == "publish"
    ), None)  # fmt: skip
    if call is None or not call.arguments:
        return
    given = call.arguments[0]
    if given.kind in ("keyword", "make", "call"):
        rows = call.arguments if given.kind == "keyword" else given.parts
        yield from _read_keywords(fn, rows, statement.line)
        return
    if given.kind != "name":
        return
    stem = given.text.removeprefix("*")
    counts: dict[str, int] = {}
    for one in fn.facts.assignments:
        counts[one.target] = counts.get(one.target, 0) + 1
    for one in fn.facts.assignments:
        if one.target == stem and one.value.kind in ("make", "call"):
            yield from _read_keywords(fn, one.value.parts, one.line)
        elif one.target.startswith(f"{stem}.") and one.operator == "=" and counts[one.target] == 1:
            unit = find_unit(one.value, fn)
            if unit is not None:
                field = one.target.removeprefix(f"{stem}.")
                yield UnitUse(field, unit[0], unit[1], CodeLine(fn.source.path, one.line), fn.name)


def _find_function(statement: Publish, functions: list[Fn]) -> Fn | None:
    named = [one for one in functions if one.name == statement.function]
    return named[0] if len(named) == 1 else None


def _read_keywords(fn: Fn, parts: tuple[FlowExpr, ...], line: int) -> Iterator[UnitUse]:
    for part in parts:
        if part.kind == "keyword" and part.text.isidentifier() and part.parts:
            unit = find_unit(part.parts[0], fn)
            if unit is not None:
                yield UnitUse(part.text, unit[0], unit[1], CodeLine(fn.source.path, line), fn.name)


def find_unit(value: FlowExpr, fn: Fn) -> tuple[str, str] | None:
    """The unit of an expression, with what tells it; None where nothing does."""
    if value.kind == "call" and len(value.parts) == 1:
        unit = _MADE_BY.get(get_tail(value.text).rpartition(".")[2])
        return (unit, f"{value.text}()") if unit else None
    text = _spell(value)
    for pattern, _, unit in _CONVERTED:
        if pattern.search(text) and _is_whole(pattern, text):
            return unit, text
    for pattern, small in ((_THOUSANDTH, MILLIMETRES), (_HUNDREDTH, CENTIMETRES)):
        match = pattern.fullmatch(text)
        if match is not None and _find_named_unit(match[1]) == small:
            return METRES, text
    match = _THOUSANDFOLD.fullmatch(text)
    if match is not None and _find_named_unit(match[1]) == METRES:
        return MILLIMETRES, text
    plain = text.removeprefix("-").strip()
    if not re.fullmatch(_NAME, plain):
        return None
    unit = _find_named_unit(plain)
    if unit:
        return unit, plain
    # A local variable that is assigned once has the unit of what it is assigned.
    made = [one for one in fn.facts.assignments if one.target == plain]
    if len(made) == 1 and made[0].operator == "=" and (made[0].value.kind != "name" or made[0].value.text != plain):
        inner = made[0].value
        return find_unit(inner, fn) if inner.kind in ("call", "other", "join") else None
    return None


def _is_whole(pattern: re.Pattern[str], text: str) -> bool:
    """Whether an expression is a conversion, or its negative, and nothing besides."""
    match = pattern.search(text)
    return match is not None and text[: match.start()].strip() in ("", "-")


def _find_named_unit(name: str) -> str:
    last = name.rpartition(".")[2].rpartition("::")[2]
    return next((unit for pattern, unit in _SUFFIXES if pattern.search(last)), "")


def _spell(value: FlowExpr) -> str:
    """An expression as text, members written with dots, without casts around the whole."""
    if value.kind == "join":
        text = f" {value.text} ".join(_spell(part) for part in value.parts)
    else:
        text = value.text.replace("->", ".")
    if value.kind == "call" and len(value.parts) == 1 and value.text in ("float", "double", "int"):
        return _spell(value.parts[0])
    cast = _CAST.match(text)
    if cast is not None and "(" not in cast[1]:
        return cast[1]
    return text.strip("() ") if text.startswith("(") and text.endswith(")") and text.count("(") == 1 else text


def _list_read(fn: Fn) -> Iterator[UnitUse]:
    """The units in which a callback takes the fields of its message."""
    if not fn.facts.parameters:
        return
    message = fn.facts.parameters[0].name
    found: dict[str, dict[str, UnitUse]] = {}

    def note(field: str, unit: str, how: str, line: int) -> None:
        use = UnitUse(field, unit, how, CodeLine(fn.source.path, line), fn.name)
        found.setdefault(field, {}).setdefault(unit, use)

    def look(value: FlowExpr, line: int, depth: int = 0) -> None:
        if value.kind == "call" and len(value.parts) == 1:
            unit = _TAKEN_BY.get(get_tail(value.text).rpartition(".")[2])
            field = _find_field(_spell(value.parts[0]), message)
            if unit and field:
                note(field, unit, f"{value.text}()", line)
        text = _spell(value)
        for pattern, unit, _ in _CONVERTED:
            for match in pattern.finditer(text):
                field = _find_field(match[1], message)
                if field:
                    note(field, unit, text, line)
        if depth < 4:
            for part in value.parts:
                look(part, line, depth + 1)

    for one in fn.facts.assignments:
        look(one.value, one.line)
        target = _find_named_unit(one.target)
        text = _spell(one.value)
        field = _find_field(text, message)
        if target and field and one.operator == "=":
            note(field, target, f"{one.target} = {text}", one.line)
        for pattern, small in ((_THOUSANDTH, MILLIMETRES), (_HUNDREDTH, CENTIMETRES)):
            match = pattern.fullmatch(text)
            field = _find_field(match[1], message) if match is not None else ""
            if field and target == METRES:
                note(field, small, text, one.line)
    for call in fn.facts.calls:
        for argument in call.arguments:
            look(argument, call.line)
    for units in found.values():
        if len(units) == 1:
            yield next(iter(units.values()))


def _find_field(text: str, message: str) -> str:
    """The field of a message that an expression is; empty for others."""
    plain = text.removeprefix("-").strip()
    if not re.fullmatch(_NAME, plain) or not plain.startswith(f"{message}."):
        return ""
    return plain.removeprefix(f"{message}.")
