"""Platform names in one spelling, and the Python version of a library cell."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.targets.platform import normalize_library_name, normalize_platform, parse_python_minor


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ubuntu jammy", "ubuntu jammy"),
        ("Ubuntu 22.04", "ubuntu jammy"),
        ("ubuntu:22.04", "ubuntu jammy"),
        ("ubuntu-noble", "ubuntu noble"),
        ("jammy", "ubuntu jammy"),
        ("Debian 12", "debian bookworm"),
        ("debian 12.5", "debian bookworm"),
        ("ubuntu 22.04.3", "ubuntu jammy"),
        ("rhel 9.4", "rhel 9"),
        ("fedora 43", "fedora 43"),
        ("windows", "windows"),
    ],
)
def test_one_spelling(text, expected):
    assert normalize_platform(text) == expected


@given(st.text(max_size=30))
def test_a_spelling_stays(text):
    assert normalize_platform(normalize_platform(text)) == normalize_platform(text)


@pytest.mark.parametrize(("version", "minor"), [("3.10.4", 10), ("3.8", 8), ("", None), (None, None), ("x", None)])
def test_python_minor(version, minor):
    assert parse_python_minor(version) == minor


@pytest.mark.parametrize(("name", "expected"), [("python3", "python"), ("OpenCV", "opencv"), ("Eigen", "eigen3")])
def test_library_aliases(name, expected):
    assert normalize_library_name(name) == expected
