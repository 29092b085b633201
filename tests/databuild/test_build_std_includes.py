"""Which standard headers a header reads, by what a compiler tells make."""

from pathlib import Path

from rosimpact.databuild.std_includes import list_told, parse_read

TOLD = list_told(["vector", "cstdint", "string"])


def test_headers_of_a_rule_for_make():
    text = (
        "probe.o: /tmp/probe.cpp /gcc/include/c++/15/vector \\\n /gcc/include/c++/15/bits/stl_vector.h \\\n"
        " /gcc/include/c++/15/bits/c++config.h /gcc/include/stdint.h /gcc/include/bits/types.h\n"
    )
    places = (Path("/gcc/include/c++/15"), Path("/gcc/include"))
    assert parse_read(text, places, TOLD) == {"vector", "bits/stl_vector", "stdint.h"}


def test_headers_of_c_are_told_of_as_well():
    assert {"vector", "cstdint", "stdint.h", "pthread.h", "bits/stl_vector"} <= TOLD and "types.h" not in TOLD
