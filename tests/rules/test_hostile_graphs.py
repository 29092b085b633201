"""Graphs that hostile workspaces make: what is compared with what stays bounded."""

import random

import pytest
from rosimpact.impact.model.flow.slips import NearNames, is_in_namespace, is_slip

NAMES = ["/scan", "/scans", "/sacn", "/front/scan", "/odom", "/Odom", "/odom_", "scan", "/cmd_vel", "/cmdvel", "/arm_l"]


@pytest.mark.parametrize("namespaces", [False, True])
def test_near_names_are_those_that_a_comparison_of_all_finds(namespaces):
    chance = random.Random(7)
    letters = "abXY_1/"
    made = ["".join(chance.choice(letters) for _ in range(chance.randint(4, 9))).strip("/") or "a" for _ in range(200)]
    names = [*NAMES, *made, *(name[:2] + name[3:] for name in made if "/" not in name and len(name) > 5)]
    near = NearNames([(name, name) for name in names], namespaces=namespaces)
    for one in names:
        same = [n for n in names if is_slip(one, n) or (namespaces and is_in_namespace(one, n))]
        assert list(near.near(one)) == same


def test_very_long_names_are_near_to_nothing():
    near = NearNames([("a" * 1_000_000, 1), ("scan", 2)], namespaces=True)
    assert list(near.near("a" * 999_999)) == []
    assert list(near.near("scna")) == ([2] if is_slip("scna", "scan") else [])
