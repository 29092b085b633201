"""Quality of service as code tells it: depths, profiles and the settings of them."""

from __future__ import annotations

from ...facts.flow import Expr
from .calls import Calls, Use
from .code import Fn, tail
from .graph import Qos
from .values import Values

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


def qos_of(calls: Calls, values: Values, use: Use) -> Qos | None:
    """The quality of service that a use asks for; None where its framework has none or it gives none.

    A queue of ROS 1 is its depth. What is not told is empty, so that nothing is judged by it.
    """
    from .sites import shown

    if use.row.framework in ("roscpp", "rospy", "image_transport") and use.row.queue and not use.row.qos:
        value = calls.argument(use, use.row.queue)
        latch = calls.argument(use, use.row.latch) if use.row.latch else None
        depth = _number(value, use.fn, values)
        latched = "transient_local" if latch is not None and latch.text in ("true", "True") else ""
        return Qos(durability=latched, depth=depth, written=shown(value)) if value is not None or latched else None
    value = calls.argument(use, use.row.qos) if use.row.qos else None
    if value is None:
        return None
    found = _of(value, use.fn, calls, values, 0)
    return Qos(**{**_fields(found), "written": shown(value)})


def _fields(qos: Qos) -> dict:
    return {name: getattr(qos, name) for name in qos.__struct_fields__}


def _number(value: Expr | None, fn: Fn, values: Values) -> int:
    if value is None:
        return -1
    text = values.of(value, fn)[0].text
    return int(text) if text and text.isdigit() else -1


def _of(value: Expr, fn: Fn, calls: Calls, values: Values, depth: int) -> Qos:
    if depth > 6:
        return Qos()
    if value.kind == "number":
        return Qos("reliable", "volatile", "keep_last", int(value.text)) if value.text.isdigit() else Qos()
    if value.kind in ("call", "make"):
        return _built(value, fn, calls, values, depth)
    if value.kind == "name":
        known = _PROFILES.get(tail(value.text))
        if known is not None:
            return known
        variable = calls.code.identity(value.text, fn)
        for writer, each in calls.code.writes.get(variable, ()):
            found = _of(each.value, writer, calls, values, depth + 1)
            if found != Qos():
                return _set_later(found, value.text, writer, calls, values)
        text = values.of(value, fn)[0].text
        if text and text.isdigit():
            return Qos("reliable", "volatile", "keep_last", int(text))
    if value.kind == "list" and value.parts:
        return _of(value.parts[0], fn, calls, values, depth + 1)
    return Qos()


def _built(value: Expr, fn: Fn, calls: Calls, values: Values, depth: int) -> Qos:
    """Profiles with settings behind them: `rclcpp::QoS(1).transient_local().reliable()`, `QoSProfile(depth=1, ...)`."""
    names = [tail(part) for part in value.text.split("().")]
    base = next((_PROFILES[name] for name in names if name in _PROFILES), None)
    fields = _fields(base) if base is not None else _fields(Qos())
    if base is None and value.kind == "call":
        variable = value.text.split(".")[0]
        for writer, each in calls.code.writes.get(calls.code.identity(variable, fn), ()):
            fields = _fields(_of(each.value, writer, calls, values, depth + 1))
    positional = [part for part in value.parts if part.kind != "keyword"]
    if positional and names[-1] in ("QoS", "KeepLast", "keep_last", "QoSProfile", "SensorDataQoS"):
        first = positional[0]
        if first.kind in ("call", "make") and tail(first.text) in ("KeepLast", "KeepAll"):
            fields["history"] = "keep_all" if tail(first.text) == "KeepAll" else "keep_last"
            fields["depth"] = _number(first.parts[0], fn, values) if first.parts else -1
        elif first.kind in ("call", "make"):
            fields = {
                **fields,
                **{
                    k: v
                    for k, v in _fields(_of(first, fn, calls, values, depth + 1)).items()
                    if v not in ("", -1, None)
                },
            }
        else:
            fields["depth"] = _number(first, fn, values)
    for name in names:
        if name in _SETTINGS:
            field, setting = _SETTINGS[name]
            fields[field] = setting
    for part in value.parts:
        if part.kind == "keyword" and part.parts:
            _keyword(part.text, part.parts[0], fields, fn, values)
    for name, field in (("deadline", "deadline"), ("liveliness_lease_duration", "lease")):
        if name in names[1:]:
            fields[field] = None
    fields["written"] = ""
    return Qos(**fields)


def _keyword(name: str, value: Expr, fields: dict, fn: Fn, values: Values) -> None:
    setting = tail(value.text).upper()
    if name == "depth":
        fields["depth"] = _number(value, fn, values)
    elif name == "reliability":
        fields[name] = "best_effort" if "BEST_EFFORT" in setting else "reliable" if "RELIABLE" in setting else ""
    elif name == "durability":
        fields[name] = "transient_local" if "TRANSIENT" in setting else "volatile" if "VOLATILE" in setting else ""
    elif name == "history":
        fields[name] = "keep_all" if "KEEP_ALL" in setting else "keep_last" if "KEEP_LAST" in setting else ""
    elif name == "liveliness":
        fields[name] = (
            "manual_by_topic" if "MANUAL_BY_TOPIC" in setting else "automatic" if "AUTOMATIC" in setting else ""
        )


def _set_later(found: Qos, name: str, fn: Fn, calls: Calls, values: Values) -> Qos:
    """Settings that follow the making: `qos.best_effort();`, `qos.reliability = ...`."""
    fields = _fields(found)
    for call in fn.facts.calls:
        if call.callee.startswith(name + "."):
            for part in call.callee[len(name) + 1 :].replace("()", "").split("."):
                if part in _SETTINGS:
                    field, setting = _SETTINGS[part]
                    fields[field] = setting
    for each in fn.facts.assignments:
        if each.target.startswith(name + ".") and each.value.kind == "name":
            _keyword(tail(each.target), each.value, fields, fn, values)
    return Qos(**fields)
