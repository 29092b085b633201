"""rosdep rules: which packages a key installs where, as rosdep's own lookup answers (REP 111)."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.targets.distro.rosdep import resolve_rule, split_platform

PIP = {"pip": {"packages": ["transforms3d"]}}

RULES = [
    # rule below the system's name, platform, expected (manager, packages) or None
    (["libboost-all-dev"], "ubuntu jammy", ("apt", ("libboost-all-dev",))),
    ("libogg-dev libvorbis-dev", "ubuntu jammy", ("apt", ("libogg-dev", "libvorbis-dev"))),
    ([], "ubuntu jammy", ("apt", ())),  # nothing needed is not the same as not to be had
    (None, "ubuntu jammy", None),
    ({"*": ["a"], "focal": ["b"]}, "ubuntu focal", ("apt", ("b",))),
    ({"*": ["a"], "focal": ["b"]}, "ubuntu noble", ("apt", ("a",))),
    ({"*": ["a"], "focal": None}, "ubuntu focal", None),  # null stands above the wildcard
    ({"*": None, "noble": ["a"]}, "ubuntu noble", ("apt", ("a",))),
    ({"*": None, "noble": ["a"]}, "ubuntu jammy", None),
    ({"focal": ["b"]}, "ubuntu noble", None),
    (PIP, "ubuntu noble", ("pip", ("transforms3d",))),
    ({"*": ["python3-transforms3d"], "focal": PIP}, "ubuntu focal", ("pip", ("transforms3d",))),
    ({"apt": {"packages": ["x"]}, "pip": {"packages": ["y"]}}, "ubuntu noble", ("apt", ("x",))),
    ({"apt": "x y"}, "ubuntu noble", ("apt", ("x", "y"))),
    ({"jammy": {"packages": ["x"]}}, "ubuntu jammy", ("apt", ("x",))),
    (["boost-devel"], "rhel 9", ("dnf", ("boost-devel",))),
    (["boost-devel"], "rhel 7", ("yum", ("boost-devel",))),
    ({"*": ["a"], "8": ["b"]}, "rhel 8", ("dnf", ("b",))),
    (["a"], "gentoo", ("", ("a",))),
]


@pytest.mark.parametrize(("rule", "platform", "expected"), RULES)
def test_a_rule_on_a_platform(rule, platform, expected):
    found = resolve_rule(rule, *split_platform(platform))
    assert (found and tuple(found)) == expected


JSON = st.recursive(
    st.none() | st.text(max_size=5) | st.integers(),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["*", "jammy", "apt", "pip", "packages", "x"]), inner, max_size=4)
    ),
    max_leaves=8,
)


@given(JSON)
def test_no_rule_raises_and_names_are_texts(rule):
    found = resolve_rule(rule, "ubuntu", "jammy")
    assert found is None or all(isinstance(name, str) for name in found.packages)
