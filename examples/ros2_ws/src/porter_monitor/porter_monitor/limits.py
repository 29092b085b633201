# Copyright 2026 The rosimpact authors
# SPDX-License-Identifier: Apache-2.0

"""What a voltage means for the porter."""

from dataclasses import dataclass
from enum import Enum

import yaml


class Verdict(Enum):
    """What the porter should do."""

    GO_ON = "battery is fine"
    RETURN = "battery is low: return to the dock"
    STOP = "battery is critical: stop"


@dataclass(frozen=True)
class Limits:
    """Voltages below which the porter returns, and stops."""

    low: float
    critical: float

    def judge(self, voltage: float) -> Verdict:
        """Say what a voltage asks for."""
        if voltage < self.critical:
            return Verdict.STOP
        if voltage < self.low:
            return Verdict.RETURN
        return Verdict.GO_ON


def read_limits(text: str) -> Limits:
    """Read the text of a limits file; raises ValueError when the limits are the wrong way round."""
    data = yaml.safe_load(text)
    limits = Limits(low=float(data["low"]), critical=float(data["critical"]))
    if limits.critical >= limits.low:
        raise ValueError("critical must be below low")
    return limits
