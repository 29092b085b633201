"""Which headers define a name of the standard library, since which C++ standard, and what headers of C bring."""

from pathlib import Path

from rosimpact.databuild.std_headers import (
    DeclaredNames,
    ReadCompiler,
    build_table,
    find_beside,
    find_brought_by_c,
    find_defining,
    find_since,
    split_files,
)

SORTING = DeclaredNames(("find_end", "sort"))
WARNS = "#if __cplusplus < 201103L\n# include <bits/c++0x_warning.h>\n"


def make_compiler(headers, texts=None, of_c=None):
    return ReadCompiler(headers, of_c or {}, texts or {})


def test_a_header_is_of_the_first_standard_under_which_it_has_names():
    part, own, reserved = DeclaredNames(("iota",)), DeclaredNames((), ("optional",)), DeclaredNames()
    read = make_compiler(
        {
            "numeric": {98: {"bits/stl_numeric": part}, 17: {"numeric": own, "bits/stl_numeric": part}},
            "optional": {98: {}, 14: {}, 17: {"optional": own}},
            # Helpers of its own are no names for users, and neither are those of what it includes.
            "bit": {98: {}, 14: {"bit": reserved, "type_traits": own}, 20: {"bit": own, "type_traits": own}},
            "mdspan": {11: {"array": own}, 23: {"array": own, "mdspan": own}},
            "filesystem": {98: {}, 17: {"bits/fs_path": own}},
            "cfenv": {11: {"cfenv": own}},
            "cfloat": {98: {}, 26: {}},
        },
        {"cfenv": WARNS},
    )
    assert find_since({13: read}) == {11: ["cfenv"], 17: ["filesystem", "optional"], 20: ["bit"], 23: ["mdspan"]}


def test_the_compiler_that_has_a_header_first_counts():
    own = DeclaredNames(("from_chars",))
    old, new = ({"charconv": {98: {}, since: {"charconv": own}}} for since in (17, 14))
    assert find_since({8: make_compiler(old), 13: make_compiler(new)}) == {14: ["charconv"]}


def test_a_name_is_defined_by_its_header_and_by_what_that_includes():
    declaring = {
        "bits/stl_algo": SORTING,
        "bits/algorithmfwd": SORTING,
        "bits/streambuf_iterator": DeclaredNames(("sort",)),
        "bits/std_abs": DeclaredNames(("sqrt",)),
    }
    texts = {"algorithm": "#include <bits/algorithmfwd.h>\n#include <bits/stl_algo.h>\n", "math.h": ""}
    read = {13: make_compiler({"algorithm": {17: declaring}, "cmath": {17: declaring}}, texts)}
    assert find_defining(["sort", "sqrt", "nothing"], read) == {
        "sort": ("algorithm", "bits/stl_algo"),
        "sqrt": ("cmath", "math.h"),
    }


def test_functions_beside_one_that_is_asked_about():
    later = {"bits/stl_algo": DeclaredNames(("find_end", "sort", "shift_left"))}
    read = make_compiler({"algorithm": {17: {"bits/stl_algo": SORTING}, 20: later}})
    # `shift_left` is not there wherever `sort` is.
    assert find_beside({13: read}) == {"sort": ["find_end"]}


def test_what_headers_of_c_bring_in_any_release():
    old = make_compiler({}, of_c={"stdint.h": ("stdint.h", "bits/stdint-intn"), "netdb.h": ("bits/stdint-intn",)})
    new = make_compiler({}, of_c={"elf.h": ("stdint.h", "bits/stdint-intn"), "math.h": ("math.h",)})
    found = find_brought_by_c([old, new])
    assert found["stdint.h"] == ["elf.h"] and found["bits/stdint-intn"] == ["netdb.h"] and found["math.h"] == []


def test_the_table_tells_of_the_names_that_the_one_before_has():
    before = {"defined": [{"headers": ["algorithm"], "names": "sort random_shuffle gone"}]}
    read = {
        13: make_compiler({"algorithm": {17: {"bits/stl_algo": SORTING}}}, {"algorithm": "#include <bits/stl_algo.h>"})
    }
    table = build_table(read, before)
    assert table["defined"] == [
        {"headers": ["algorithm"], "names": "random_shuffle gone"},
        {"headers": ["algorithm", "bits/stl_algo"], "names": "sort"},
    ]
    assert table["brought_by_c"]["unistd.h"] == "" and table["since"] == {"17": "algorithm"}


def test_what_a_preprocessor_leaves_of_each_file():
    read = (
        ("<built-in>", "int a;"),
        ("/usr/c++/bits/x.h", "int b;"),
        ("/usr/c++/y", "int c;"),
        ("/usr/c++/bits/x.h", ""),
    )
    text = "".join(f'# 1 "{file}" 3\n{code}\n' for file, code in read)
    assert split_files(text, [Path("/usr"), Path("/usr/c++")]) == {"bits/x.h": "int b;\n\n", "y": "int c;\n"}
