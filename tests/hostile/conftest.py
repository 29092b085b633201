"""Which attacks are made: a sample with a fixed seed, all of them with --attacks=all or ROSIMPACT_ATTACKS=all."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from .harness import Range
from .table import attacks, sample


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--attacks", choices=("sample", "all"), default=None, help="a sample of the attacks, or all of them"
    )


def are_all_chosen(config: pytest.Config) -> bool:
    return (config.getoption("--attacks", None) or os.environ.get("ROSIMPACT_ATTACKS", "sample")) == "all"


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for each attack."""
    if "attack" not in metafunc.fixturenames:
        return
    rows = attacks() if are_all_chosen(metafunc.config) else sample()
    attacks.cache_clear()  # what is not chosen holds 140 MB of text, which every fork would take along
    metafunc.parametrize(
        "attack", rows, ids=[f"{row.group}: {row.name}".encode("ascii", "backslashreplace").decode() for row in rows]
    )


@pytest.fixture(scope="session")
def shooting_range(tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config) -> Iterator[Range]:
    with Range(root=tmp_path_factory.mktemp("hostile"), experience=not are_all_chosen(pytestconfig)) as place:
        yield place
