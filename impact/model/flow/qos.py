"""Quality of service as code gives it: depths, profiles and their settings; and as parameters override it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from msgspec import structs

from ...facts.flow import FlowExpr
from .calls import Calls, FrameworkCall
from .code import Fn, get_tail, is_number
from .graph import Qos
from .values import FlowValues

# Profiles of rmw (https://docs.ros.org/en/rolling/Concepts/Intermediate/About-Quality-of-Service-Settings.html).
_PLAIN = Qos("reliable", "volatile", "keep_last", 10)
_SENSOR = Qos("best_effort", "volatile", "keep_last", 5)
_SYSTEM = Qos("system_default", "system_default", "system_default", -1)
_PROFILES = {
    "SensorDataQoS": _SENSOR, "qos_profile_sensor_data": _SENSOR, "rmw_qos_profile_sensor_data": _SENSOR,
    "SystemDefaultsQoS": _SYSTEM, "qos_profile_system_default": _SYSTEM, "rmw_qos_profile_system_default": _SYSTEM,
    "rmw_qos_profile_default": _PLAIN, "QoS": _PLAIN, "QoSProfile": Qos("reliable", "volatile", "keep_last", -1),
    "ServicesQoS": _PLAIN, "qos_profile_services_default": _PLAIN, "rmw_qos_profile_services_default": _PLAIN,
    "ParametersQoS": Qos("reliable", "volatile", "keep_last", 1_000),
    "qos_profile_parameters": Qos("reliable", "volatile", "keep_last", 1_000),
    "ClockQoS": Qos("best_effort", "volatile", "keep_last", 1),
    "RosoutQoS": Qos("reliable", "transient_local", "keep_last", 1_000),
    "SENSOR_DATA": _SENSOR, "SYSTEM_DEFAULT": _SYSTEM, "SERVICES_DEFAULT": _PLAIN,
    "qos_profile_action_status_default": Qos("reliable", "transient_local", "keep_last", 1),
}  # fmt: skip
_SETTINGS = {
    "reliable": ("reliability", "reliable"), "best_effort": ("reliability", "best_effort"),
    "transient_local": ("durability", "transient_local"), "durability_volatile": ("durability", "volatile"),
    "volatile": ("durability", "volatile"), "keep_all": ("history", "keep_all"), "keep_last": ("history", "keep_last"),
    "reliability_best_available": ("reliability", "best_available"),
    "durability_best_available": ("durability", "best_available"),
    "liveliness_automatic": ("liveliness", "automatic"), "manual_by_topic": ("liveliness", "manual_by_topic"),
}  # fmt: skip

# Settings that are given a value, and what the last letters of the value's name mean.
_TAKING = {
    "reliability": "reliability", "durability": "durability", "history": "history", "liveliness": "liveliness",
    "deadline": "deadline", "liveliness_lease_duration": "lease",
}  # fmt: skip
_WORDS = {
    "reliability": (("BESTEFFORT", "best_effort"), ("RELIABLE", "reliable")),
    "durability": (("TRANSIENTLOCAL", "transient_local"), ("VOLATILE", "volatile")),
    "history": (("KEEPALL", "keep_all"), ("KEEPLAST", "keep_last")),
    "liveliness": (("MANUALBYTOPIC", "manual_by_topic"), ("AUTOMATIC", "automatic")),
}
_LITERAL = re.compile(r"([\d.']+)(h|min|s|ms|us|ns)")
_UNITS = {
    "h": 3600, "min": 60, "s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "hours": 3600, "minutes": 60, "seconds": 1,
    "milliseconds": 1e-3, "microseconds": 1e-6, "nanoseconds": 1e-9, "from_seconds": 1, "from_nanoseconds": 1e-9,
}  # fmt: skip


def find_qos(calls: Calls, values: FlowValues, use: FrameworkCall) -> Qos | None:
    """The quality of service that a use asks for; None where its framework has none or it gives none.

    A queue of ROS 1 is its depth. What is not known is empty, so that nothing is judged by it.
    """
    from .endpoints import unparse

    if use.row.framework in ("roscpp", "rospy", "image_transport") and use.row.queue and not use.row.qos:
        value = calls.find_argument(use, use.row.queue)
        latch = calls.find_argument(use, use.row.latch) if use.row.latch else None
        depth = _evaluate_number(value, use.fn, values)
        made = use.fn.assigned.get(latch.text, ()) if latch is not None and latch.kind == "name" else ()
        latch = made[0].value if len(made) == 1 else latch
        latched = "transient_local" if latch is not None and latch.text in ("true", "True") else ""
        return Qos(durability=latched, depth=depth, written=unparse(value)) if value is not None or latched else None
    value = calls.find_argument(use, use.row.qos) if use.row.qos else None
    if value is None:
        return None
    found = _evaluate(value, use.fn, calls, values, 0)
    return structs.replace(found, written=unparse(value))


# What with_default_policies() of QosOverridingOptions makes parameters of (rclcpp, qos_overriding_options.hpp; rclpy,
# rclpy/qos_overriding_options.py; from Galactic on).
_OPTIONS = "qos_overriding_options"
_BY_DEFAULT = ("history", "depth", "reliability")
_FIELDS = {"liveliness_lease_duration": "lease"}


def list_overridable(use: FrameworkCall) -> tuple[str, ...]:
    """The policies of a use for which its node declares parameters `qos_overrides.TOPIC.ROLE.POLICY`: those that its
    options name (`options.qos_overriding_options = ...` in the same function, or the keyword), by the names that they
    have there."""
    named = {argument.text for argument in use.call.arguments if argument.kind == "name"}
    given = [each.parts[0] for each in use.call.arguments if each.kind == "keyword" and each.text == _OPTIONS]
    for each in use.fn.facts.assignments:
        owner, _, member = each.target.rpartition(".")
        if member == _OPTIONS and owner in named:
            given.append(each.value)
    return tuple(dict.fromkeys(policy for value in given for policy in _list_policies(value)))


def _list_policies(options: FlowExpr) -> Iterator[str]:
    if get_tail(options.text) == "with_default_policies":
        yield from _BY_DEFAULT
    elif options.kind == "name" and "Kind" in options.text:
        yield re.sub(r"(?<=[a-z])(?=[A-Z])", "_", get_tail(options.text)).lower()
    else:
        for part in options.parts:
            yield from _list_policies(part)


def apply_overrides(qos: Qos, topic: str, role: str, policies: Iterable[str], settings: Mapping[str, str]) -> Qos:
    """The quality of service after the parameters that a launch gives. topic: as it is after remapping; settings:
    values by name. Durations are nanoseconds. A value that is none of the policy makes it unknown."""
    fields = structs.asdict(qos)
    for policy in policies:
        value = settings.get(f"qos_overrides.{topic}.{_SIDES[role]}.{policy}")
        field = _FIELDS.get(policy, policy)
        if value is None or field not in fields:
            continue
        number = int(value) if is_number(value) and value.isdigit() else None
        if field == "depth":
            fields[field] = -1 if number is None else number
        elif field in ("deadline", "lease"):
            fields[field] = None if number is None else number * 1e-9
        else:
            fields[field] = value if any(value == meant for _, meant in _WORDS[field]) else ""
    return Qos(**fields)


_SIDES = {"publisher": "publisher", "subscriber": "subscription"}


def _evaluate_number(value: FlowExpr | None, fn: Fn, values: FlowValues) -> int:
    if value is None:
        return -1
    text = values.find_only_text(value, fn)
    return int(text) if text and is_number(text) else -1


def _evaluate(value: FlowExpr, fn: Fn, calls: Calls, values: FlowValues, depth: int) -> Qos:
    if depth > 6:
        return Qos()
    if value.kind == "number":
        return Qos("reliable", "volatile", "keep_last", int(value.text)) if is_number(value.text) else Qos()
    if value.kind in ("call", "make"):
        return _evaluate_built(value, fn, calls, values, depth)
    if value.kind == "name":
        known = _PROFILES.get(get_tail(value.text.removesuffix(".value")))
        if known is not None:
            return known
        variable = calls.code.identify(value.text, fn)
        found = [
            (_evaluate(each.value, writer, calls, values, depth + 1), writer)
            for writer, each in calls.code.list_writes(variable)
            if each.operator == "="
        ]
        found += [
            (_evaluate(given, holder, calls, values, depth + 1), holder)
            for given, holder in calls.code.list_declared_values(variable, fn)
        ]
        if found:
            return _set_later(_merge_common([qos for qos, _ in found]), value.text, found[0][1], values)
        text = values.find_only_text(value, fn)
        if text and is_number(text):
            return Qos("reliable", "volatile", "keep_last", int(text))
    if value.kind == "list" and value.parts:
        return _evaluate(value.parts[0], fn, calls, values, depth + 1)
    return Qos()


def _merge_common(found: list[Qos]) -> Qos:
    """What several qualities agree on: code may choose any of them."""
    first = structs.asdict(found[0])
    nothing = structs.asdict(Qos())
    for other in found[1:]:
        fields = structs.asdict(other)
        first = {name: value if fields[name] == value else nothing[name] for name, value in first.items()}
    return Qos(**first)


def _evaluate_built(value: FlowExpr, fn: Fn, calls: Calls, values: FlowValues, depth: int) -> Qos:
    """Profiles with settings behind them: `rclcpp::QoS(1).transient_local().reliable()`, `QoSProfile(depth=1, ...)`."""
    links = _split_chain(value)
    names = [name for name, _ in links]
    base = next((_PROFILES[name] for name in names if name in _PROFILES), None)
    fields = structs.asdict(base) if base is not None else structs.asdict(Qos())
    if names[-1] == "from_rmw" and value.parts:
        return _evaluate(value.parts[0], fn, calls, values, depth + 1)
    if base is None and value.kind == "call":
        variable = value.text.split(".")[0]
        found = [
            _evaluate(each.value, writer, calls, values, depth + 1)
            for writer, each in calls.code.list_writes(calls.code.identify(variable, fn))
        ]
        if not found and len(links) == 1:
            found = [
                _evaluate(each.value, target, calls, values, depth + 1)
                for target in calls.code.list_targets(value.text, fn)
                for each in target.facts.assignments
                if each.operator == "return"
            ]
        fields = structs.asdict(_merge_common(found)) if found else fields
    positional = [part for part in links[0][1] if part.kind != "keyword"]
    if positional and names[0] in ("QoS", "KeepLast", "keep_last", "QoSProfile", "SensorDataQoS"):
        _apply_constructor(positional[0], fields, fn, calls, values, depth)
    for place, (name, given) in enumerate(links):
        if place or name in _SETTINGS:
            _set(name, given[0] if given else None, fields, fn, values)
            if place and name == "keep_last":
                fields["depth"] = _evaluate_number(given[0] if given else None, fn, values)
    for part in value.parts:
        if part.kind == "keyword" and part.parts:
            if part.text == "depth":
                fields["depth"] = _evaluate_number(part.parts[0], fn, values)
            elif part.text in _TAKING:
                _set(part.text, part.parts[0], fields, fn, values)
    fields["written"] = ""
    return Qos(**fields)


def _apply_constructor(first: FlowExpr, fields: dict, fn: Fn, calls: Calls, values: FlowValues, depth: int) -> None:
    """What a profile's constructor is given: a depth, a history, or another profile."""
    if first.kind in ("call", "make") and get_tail(first.text) in ("KeepLast", "KeepAll"):
        fields["history"] = "keep_all" if get_tail(first.text) == "KeepAll" else "keep_last"
        fields["depth"] = _evaluate_number(first.parts[0] if first.parts else None, fn, values)
        return
    other = _evaluate(first, fn, calls, values, depth + 1) if first.kind != "number" else Qos()
    if other != Qos():
        fields.update(structs.asdict(other))
    elif first.kind in ("call", "make"):
        fields.update(structs.asdict(Qos()))  # of what is not known
    else:
        fields["depth"] = _evaluate_number(first, fn, values)


def _split_chain(value: FlowExpr) -> list[tuple[str, tuple[FlowExpr, ...]]]:
    """The calls of a chain, the first one first, with their arguments."""
    before = _split_chain(value.receiver) if value.receiver is not None else []
    return [*before, (get_tail(value.text), value.parts)]


def _set(name: str, value: FlowExpr | None, fields: dict, fn: Fn, values: FlowValues) -> str:
    """Does what a function or member of this name does with an expression; gives the setting, empty for none. It is not
    told where the expression is not known."""
    field, setting = _SETTINGS.get(name) or (_TAKING.get(name, ""), "")
    if field in ("deadline", "lease"):
        fields[field] = parse_seconds(value, fn, values) if value is not None else None
    elif field:
        words = get_tail(value.text).upper().replace("_", "") if value is not None and value.kind == "name" else ""
        found = (meant for word, meant in _WORDS[field] if words.endswith(word))
        fields[field] = setting or next(found, "")
    return field


def parse_seconds(value: FlowExpr, fn: Fn, values: FlowValues) -> float | None:
    """A duration of rclcpp, rclpy or std::chrono in seconds; None for what is not written as numbers."""
    if value.kind == "other":
        literal = _LITERAL.fullmatch(value.text)
        return float(literal[1]) * _UNITS[literal[2]] if literal else None
    if value.kind not in ("call", "make"):
        return None
    name = get_tail(value.text)
    found = []
    for place, part in enumerate(value.parts):
        inner = part.parts[0] if part.kind == "keyword" and part.parts else part
        if inner.kind != "number":
            return parse_seconds(inner, fn, values) if len(value.parts) == 1 and name in ("Duration", "QoS") else None
        word = part.text if part.kind == "keyword" else name if len(value.parts) == 1 else ("s", "ns")[min(place, 1)]
        try:
            found.append(float(inner.text.replace("'", "").rstrip("fFuUlL")) * _UNITS[word])
        except (ValueError, KeyError):
            return None
    return sum(found) if found else None


def _set_later(found: Qos, name: str, fn: Fn, values: FlowValues) -> Qos:
    """Settings that follow the making: `qos.best_effort();`, `qos.reliability = ...`. What is set under a condition
    only is not known."""
    fields = structs.asdict(found)
    nothing = structs.asdict(Qos())
    said = [(call.callee, call.arguments[0] if call.arguments else None, call.guard) for call in fn.facts.calls]
    said += [(each.target, each.value, each.guard) for each in fn.facts.assignments if get_tail(each.target) in _TAKING]
    for path, value, guard in said:
        if path.startswith(name + "."):
            field = _set(path[len(name) + 1 :].rpartition("().")[2], value, fields, fn, values)
            if field and guard >= 0:
                fields[field] = nothing[field]
    return Qos(**fields)
