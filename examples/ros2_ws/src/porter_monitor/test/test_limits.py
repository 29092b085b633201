# Copyright 2026 The rosimpact authors
# SPDX-License-Identifier: Apache-2.0

import pytest
from porter_monitor.limits import Limits, Verdict, read_limits


@pytest.mark.parametrize(
    ("voltage", "verdict"), [(25.0, Verdict.GO_ON), (22.4, Verdict.RETURN), (20.9, Verdict.STOP)]
)
def test_judgement(voltage, verdict):
    assert Limits(low=22.5, critical=21.0).judge(voltage) is verdict


def test_limits_the_wrong_way_round():
    with pytest.raises(ValueError, match="below low"):
        read_limits("low: 20\ncritical: 21\n")
