"""How often a timer fires, where its period is written as a number."""

import re

_NUMBER = r"(\d+(?:\.\d*)?|\.\d+)"
_UNITS = {
    "h": 3600.0, "hours": 3600.0, "min": 60.0, "minutes": 60.0, "s": 1.0, "seconds": 1.0, "": 1.0,
    "ms": 1e-3, "milliseconds": 1e-3, "us": 1e-6, "microseconds": 1e-6, "ns": 1e-9, "nanoseconds": 1e-9,
}  # fmt: skip
_LITERAL = re.compile(rf"{_NUMBER}\s*(h|min|s|ms|us|ns)?\Z")
_CALL = re.compile(
    r"(?:\w+::|\w+\.)*(hours|minutes|seconds|milliseconds|microseconds|nanoseconds|[dD]uration|WallDuration|Rate|WallRate)"
    r"(?:<(?:double|float)>)?\s*[({](.*)[)}]\Z"
)
_INVERSE = re.compile(rf"1(?:\.0?f?)?\s*/\s*{_NUMBER}f?\Z")


def find_rate(period: str) -> float | None:
    """Times a second; None for a period that is not written as a number.

    period: as the source has it: `100ms`, `std::chrono::milliseconds(20)`, `ros::Duration(0.1)`, `1.0 / 30`, `0.5`.
    """
    seconds = _find_seconds(period.strip())
    return 1 / seconds if seconds else None


def _find_seconds(text: str) -> float | None:
    if literal := _LITERAL.match(text):
        return float(literal[1]) * _UNITS[literal[2] or ""]
    if inverse := _INVERSE.match(text):
        return 1 / float(inverse[1]) if float(inverse[1]) else None
    if call := _CALL.match(text):
        inner = _find_seconds(call[2].strip())
        if inner and call[1].endswith("Rate"):
            return 1 / inner
        return inner and inner * _UNITS.get(call[1], 1.0)
    return None
