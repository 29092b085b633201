"""Which standard header brings which name along, by version of GCC."""

import pytest
from rosimpact.databuild import std_names
from rosimpact.impact.targets.providers.standard import (
    DEFINED_IN,
    find_named,
    get_bit,
    index_headers,
    list_brought,
    load_names,
)


def reaches(headers, name, gcc):
    """Whether any of these standard headers brings the definition of a name in a GCC; None for an unknown name."""
    wanted = DEFINED_IN.get(name)
    return None if wanted is None else any(not list_brought(header, gcc).isdisjoint(wanted) for header in headers)


@pytest.mark.parametrize(
    ("headers", "name", "gcc", "there"),
    [
        # Porting to GCC 13: <string> and <iostream> stopped bringing <cstdint>
        ({"string"}, "uint32_t", 12, True),
        ({"string"}, "uint32_t", 13, False),
        ({"iostream", "vector"}, "std::uint8_t", 12, True),
        ({"iostream", "vector"}, "std::uint8_t", 13, False),
        ({"chrono"}, "uint64_t", 14, True),
        ({"stdint.h"}, "uint32_t", 15, True),
        ({"stdint.h"}, "std::uint32_t", 15, False),
        # Porting to GCC 7: <memory> and <mutex> stopped bringing <functional>
        ({"memory"}, "std::function", 5, True),
        ({"mutex"}, "std::bind", 5, True),
        ({"mutex"}, "std::bind", 7, False),
        ({"functional"}, "std::function", 15, True),
        # Porting to GCC 11: <algorithm> stopped bringing <limits>
        ({"algorithm"}, "std::numeric_limits", 10, True),
        ({"algorithm"}, "std::numeric_limits", 11, False),
        ({"thread"}, "std::shared_ptr", 10, True),
        # C's own headers: <string> reads <stdlib.h>, which has the types with a sign, and no others
        ({"string"}, "int16_t", 13, True),
        ({"string"}, "std::int16_t", 13, False),
        ({"vector"}, "int16_t", 13, False),
        ({"inttypes.h"}, "uint8_t", 13, True),
        ({"netinet/in.h"}, "uint16_t", 13, True),
        ({"sys/types.h"}, "uint16_t", 13, False),
        ({"iostream"}, "std::vector", 13, False),
        ({"vector"}, "std::no_such_name", 13, None),
        (set(), "std::vector", 13, False),
    ],
)
def test_reaches(headers, name, gcc, there):
    assert reaches(headers, name, gcc) is there


@pytest.mark.parametrize(("gcc", "same_as"), [(4, 5), (6, 5), (8, 7), (99, 16)])
def test_an_unknown_version_is_answered_as_its_neighbour(gcc, same_as):
    assert list_brought("string", gcc) == list_brought("string", same_as)


def test_the_public_header_brings_its_names():
    # <shared_mutex> and the like came with newer standards; what is listed here is in all versions from GCC 9 on.
    assert not [name for name, (public, *_) in DEFINED_IN.items() if not reaches({public}, name, 9)]


@pytest.mark.parametrize(
    ("header", "name", "gcc", "year", "there"),
    [
        # Porting to GCC 13: <string> stopped bringing <cstdint>, whose signed types <cstdlib> still brings
        ("string", "uint32_t", 11, 2017, True),
        ("string", "uint32_t", 13, 2017, False),
        ("string", "int32_t", 13, 2017, True),
        ("regex", "uint8_t", 13, 2017, False),
        ("regex", "uint8_t", 13, 2020, True),
        # C++20 brings much more along than C++17
        ("memory", "std::find", 13, 2017, False),
        ("memory", "std::find", 13, 2020, True),
        ("algorithm", "std::function", 9, 2014, False),
        ("algorithm", "std::function", 9, 2017, True),
        # what is only announced is not there
        ("vector", "std::string", 13, 2017, False),
        ("utility", "std::array", 13, 2017, False),
        ("shared_mutex", "std::unique_lock", 11, 2017, False),
        ("stdlib.h", "memcpy", 13, 2017, False),
        ("string.h", "memcpy", 13, 2017, True),
        ("string.h", "std::memcpy", 13, 2017, False),
        ("cmath", "M_PI", 15, 2017, True),
        # declared in the same file as std::reverse
        ("algorithm", "std::reverse_copy", 15, 2017, True),
        ("vector", "std::reverse_copy", 15, 2017, False),
    ],
)
def test_names_that_a_header_brings_alone(header, name, gcc, year, there):
    told = find_named(header, gcc, year)
    assert told is not None and bool(told & get_bit(name)) is there


def test_headers_and_names_that_are_not_told_of():
    assert find_named("winch/winch.hpp", 13, 2017) is None
    assert get_bit("std::winch") == 0


@pytest.mark.parametrize(
    ("gcc", "year", "gcc_told", "year_told"), [(12, 2017, 11, 2017), (99, 2023, 16, 2020), (13, 2011, 13, 2017)]
)
def test_versions_and_standards_that_are_not_told_of_are_answered_as_their_neighbours(gcc, year, gcc_told, year_told):
    assert find_named("memory", gcc, year) == find_named("memory", gcc_told, year_told)


def test_the_table_has_the_names_that_its_builder_asks_for():
    assert load_names().names == std_names.find_home_headers()


def test_each_name_is_brought_by_the_header_that_is_said_to_offer_it():
    late = {name for name, header in load_names().names.items() if header in ("span", "charconv")}
    told = {n: h for n, (h, *_) in index_headers().items() if get_bit(n) and n not in late}
    assert [n for n, h in told.items() if not (find_named(h, 13, 2017) or 0) & get_bit(n)] == []


def test_probes_refuse_types_that_are_only_announced():
    lines = dict(std_names.list_probes())
    assert lines["std::vector"] == "enum { size = sizeof(std::vector<int>) };"
    assert lines["std::mutex"] == "enum { size = sizeof(std::mutex) };"
    assert lines["std::sort"] == "using std::sort;" and lines["memcpy"] == "using ::memcpy;"
