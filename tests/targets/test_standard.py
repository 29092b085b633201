"""Which standard header brings which name along, by version of GCC."""

import pytest
from rosimpact.impact.targets.standard import DEFINED_IN, brought_by, reaches


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
    assert reaches(frozenset(headers), name, gcc) is there


@pytest.mark.parametrize(("gcc", "same_as"), [(4, 5), (6, 5), (8, 7), (99, 15)])
def test_an_unknown_version_is_answered_as_its_neighbour(gcc, same_as):
    assert brought_by("string", gcc) == brought_by("string", same_as)


def test_the_public_header_brings_its_names():
    # <shared_mutex> and the like came with newer standards; what is listed here is in all versions from GCC 9 on.
    assert not [name for name, (public, *_) in DEFINED_IN.items() if not reaches(frozenset({public}), name, 9)]
