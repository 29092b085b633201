"""Builds data/std_names.json.zst: which names of the standard libraries each standard header brings, by GCC.

    python -P -m rosimpact.databuild.std_names 13=FOLDER 15=FOLDER ... --output DATA

FOLDER holds the unpacked Debian packages of a release that has this GCC (`dpkg-deb -x`): g++-N, libstdc++-N-dev,
libgcc-N-dev, libc6-dev, linux-libc-dev, libcrypt-dev, libc6, libgmp10, libmpfr6, libmpc3, libisl23, libzstd1, zlib1g.
The compiler is asked itself, header by header and under each language standard: a type counts when it is complete,
anything else when it is declared. Only names and versions are kept. With --onto the other GCCs of the table stay as
they are.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import zstandard

from ..impact.targets.providers.standard import HEADER_SINCE
from ..impact.targets.tables import DATA
from .table_file import write_table

NAMES = {
    "algorithm": """
        sort stable_sort find find_if find_if_not copy copy_n copy_if remove_if remove transform count_if count
        max_element min_element minmax_element reverse replace replace_if for_each unique binary_search upper_bound
        lower_bound equal_range nth_element any_of all_of none_of clamp shuffle generate generate_n set_difference
        set_intersection set_union partial_sort rotate search merge includes next_permutation partition minmax min max
        fill fill_n equal iter_swap swap_ranges is_sorted adjacent_find mismatch sample make_heap push_heap pop_heap
        copy_backward find_first_of lexicographical_compare is_permutation stable_partition
    """,
    "any": "any{} any_cast bad_any_cast{}",
    "array": "array<int,2>",
    "atomic": "atomic<int> atomic_bool{} atomic_int{} atomic_flag{} memory_order_relaxed memory_order_acquire",
    "bitset": "bitset<4>",
    "charconv": "from_chars to_chars",
    "chrono": """
        chrono::milliseconds{} chrono::seconds{} chrono::microseconds{} chrono::nanoseconds{} chrono::minutes{}
        chrono::duration<int> chrono::duration_cast chrono::steady_clock{} chrono::system_clock{}
        chrono::high_resolution_clock{} chrono::time_point<std::chrono::steady_clock>
        chrono::time_point_cast chrono::steady_clock::now chrono::system_clock::now chrono::high_resolution_clock::now
        chrono::steady_clock::time_point{} chrono::system_clock::time_point{}
    """,
    "complex": "complex<double>",
    "condition_variable": "condition_variable{} condition_variable_any{} cv_status",
    "deque": "deque<int>",
    "exception": "exception{} exception_ptr{} current_exception rethrow_exception make_exception_ptr terminate",
    "filesystem": """
        filesystem::path{} filesystem::exists filesystem::create_directories filesystem::create_directory
        filesystem::remove filesystem::remove_all filesystem::directory_iterator{} filesystem::is_directory
        filesystem::is_regular_file filesystem::temp_directory_path filesystem::current_path filesystem::copy_file
        filesystem::absolute filesystem::recursive_directory_iterator{} filesystem::filesystem_error{}
    """,
    "forward_list": "forward_list<int>",
    "fstream": "ifstream{} ofstream{} fstream{} filebuf{}",
    "functional": """
        function<void()> bind mem_fn ref cref reference_wrapper<int> less<int> greater<int> plus<int> minus<int>
        multiplies<int> equal_to<int> placeholders::_1 placeholders::_2 placeholders::_3 placeholders::_4 not_fn invoke
        bad_function_call{}
    """,
    "future": "future<int> promise<int> async packaged_task<void()> shared_future<int> future_status launch",
    "initializer_list": "initializer_list<int>",
    "iomanip": "setprecision setw setfill put_time get_time quoted setbase",
    "ios": "ios_base{} fixed hex dec boolalpha scientific left right showpoint streamsize",
    "iostream": "cout cerr cin clog",
    "istream": "istream{} iostream{} ws",
    "iterator": """
        back_inserter inserter front_inserter ostream_iterator<int> istream_iterator<int> istreambuf_iterator<char>
        next prev distance advance make_move_iterator reverse_iterator<int*> begin end rbegin rend cbegin cend
    """,
    "limits": "numeric_limits<int>",
    "list": "list<int>",
    "locale": "locale{} use_facet",
    "map": "map<int,int> multimap<int,int>",
    "memory": """
        unique_ptr<int> make_unique shared_ptr<int> weak_ptr<int> make_shared enable_shared_from_this<int>
        static_pointer_cast dynamic_pointer_cast const_pointer_cast addressof allocator<int> default_delete<int>
        allocate_shared owner_less<std::shared_ptr<int>>
    """,
    "mutex": """
        mutex{} recursive_mutex{} timed_mutex{} recursive_timed_mutex{} lock_guard<probed::lockable>
        unique_lock<probed::lockable> scoped_lock<probed::lockable> call_once once_flag{} lock try_lock adopt_lock
        defer_lock try_to_lock
    """,
    "numeric": "accumulate iota inner_product partial_sum gcd lcm adjacent_difference reduce transform_reduce",
    "optional": "optional<int> nullopt make_optional bad_optional_access{}",
    "ostream": "ostream{} endl flush",
    "queue": "queue<int,probed::container> priority_queue<int,probed::container,probed::order>",
    "random": """
        mt19937{} mt19937_64{} random_device{} uniform_real_distribution<double> uniform_int_distribution<int>
        normal_distribution<double> default_random_engine{} bernoulli_distribution{} discrete_distribution<int>
    """,
    "ratio": "ratio<1,2> milli{} micro{}",
    "regex": """
        regex{} smatch{} cmatch{} regex_match regex_search regex_replace sregex_iterator{}
        sregex_token_iterator{}
    """,
    "set": "set<int> multiset<int>",
    "shared_mutex": "shared_mutex{} shared_lock<probed::lockable> shared_timed_mutex{}",
    "span": "span<int>",
    "sstream": "stringstream{} ostringstream{} istringstream{} stringbuf{}",
    "stack": "stack<int,probed::container>",
    "stdexcept": """
        runtime_error{} logic_error{} invalid_argument{} out_of_range{} length_error{} domain_error{} overflow_error{}
        underflow_error{} range_error{}
    """,
    "streambuf": "streambuf{}",
    "string": "string{} wstring{} to_string stoi stol stoul stoull stod stof getline char_traits<char>",
    "string_view": "string_view{}",
    "system_error": """
        system_error{} error_code{} errc error_category{} generic_category system_category
        make_error_code
    """,
    "thread": """
        thread{} this_thread::sleep_for this_thread::sleep_until this_thread::get_id this_thread::yield thread::id{}
        thread::hardware_concurrency
    """,
    "tuple": "tuple<int> make_tuple tie forward_as_tuple tuple_cat apply ignore",
    "type_traits": """
        is_same<int,int> enable_if<true> decay<int> conditional<true,int,int> remove_reference<int> is_base_of<int,int>
        true_type{} false_type{} is_integral<int> is_floating_point<int> is_convertible<int,int> is_arithmetic<int>
        is_enum<int> underlying_type<probed::kind> remove_const<int> remove_cv<int> integral_constant<int,1>
    """,
    "typeindex": "type_index{}",
    "typeinfo": "type_info{} bad_cast{}",
    "unordered_map": "unordered_map<int,int> unordered_multimap<int,int>",
    "unordered_set": "unordered_set<int> unordered_multiset<int>",
    "utility": "pair<int,int> make_pair exchange swap move forward as_const index_sequence<0> make_index_sequence<1>",
    "valarray": "valarray<int>",
    "variant": "variant<int> visit get_if holds_alternative monostate{} bad_variant_access{}",
    "vector": "vector<int>",
    "cmath": """
        isnan isinf isfinite sqrt hypot fabs atan2 round floor ceil pow sin cos tan asin acos atan exp log log10 fmod
        cbrt trunc lround copysign signbit nan tanh sinh cosh
    """,
    "cstdint": """
        int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t intptr_t uintptr_t uint_fast32_t uintmax_t
        uint_least32_t intmax_t
    """,
    "cstdlib": "getenv exit abort malloc free atoi atof strtol strtod strtoul rand srand system",
    "cstring": "memcpy memset memcmp memmove strcmp strncmp strlen strcpy strncpy strstr strchr strerror strtok",
    "cstdio": "printf snprintf sprintf fprintf FILE fopen fclose sscanf perror fflush fgets remove rename",
    "cstddef": "size_t ptrdiff_t nullptr_t max_align_t byte",
    "ctime": "time clock localtime strftime time_t tm{} gmtime mktime difftime",
    "cctype": "isspace isdigit tolower toupper isalnum isalpha isupper islower isxdigit ispunct",
    "csignal": "signal raise sig_atomic_t",
    "cstdarg": "va_list",
    "clocale": "setlocale",
}
"""Names of namespace std by the header that is theirs. A type is written with its arguments, or with {}."""

BARE = {
    "cstdint": """
        int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t intptr_t uintptr_t
        UINT8_MAX UINT16_MAX UINT32_MAX UINT64_MAX INT8_MAX INT16_MAX INT32_MAX INT64_MAX
        INT8_MIN INT16_MIN INT32_MIN INT64_MIN SIZE_MAX
    """,
    "cfloat": "FLT_MAX FLT_MIN FLT_EPSILON DBL_MAX DBL_MIN DBL_EPSILON",
    "climits": "INT_MAX INT_MIN UINT_MAX LONG_MAX LONG_MIN ULONG_MAX CHAR_BIT UCHAR_MAX USHRT_MAX SHRT_MAX PATH_MAX",
    "cmath": "M_PI M_PI_2 M_PI_4 M_SQRT2 INFINITY HUGE_VAL",
    "cstdlib": "EXIT_SUCCESS EXIT_FAILURE getenv setenv strtol strtod atoi atof",
    "cstring": "memcpy memset memcmp memmove strcmp strncmp strlen strcpy strncpy strstr strerror bzero strdup",
    "cstdio": "snprintf sprintf fprintf sscanf vsnprintf perror stderr stdout fopen",
    "cassert": "assert",
    "cerrno": "errno EINVAL EAGAIN EINTR ENOENT",
    "cinttypes": "PRIu64 PRId64 PRIu32 PRId32 PRIx64",
    "csignal": "SIGINT SIGTERM SIGKILL SIGSEGV sigaction",
    "cstdarg": "va_list va_start",
    "unistd.h": "usleep getpid STDIN_FILENO getcwd gethostname readlink",
    "fcntl.h": "O_RDWR O_RDONLY O_WRONLY O_CREAT O_NONBLOCK",
    "sys/time.h": "gettimeofday timeval",
    "time.h": "clock_gettime CLOCK_MONOTONIC CLOCK_REALTIME nanosleep timespec",
    "pthread.h": "pthread_create pthread_mutex_t pthread_self pthread_setname_np",
}
"""Macros and global names of C and POSIX by the header that is theirs."""

_STANDARDS = (14, 17, 20)
"""C++ standards that are told apart: of GCC's default ones, and the next."""
_CPP = """
    cassert cctype cerrno cfenv cfloat cinttypes climits clocale cmath complex csetjmp csignal cstdarg cstddef cstdint
    cstdio cstdlib cstring ctime cwchar cwctype cxxabi.h bits/stdc++.h experimental/filesystem experimental/optional new
    iosfwd istream ostream streambuf ios typeinfo exception codecvt memory_resource execution
"""
_FOLDERS = ("", "sys", "netinet", "arpa")
_COMMON = """
#include "{header}"
namespace probed {{
struct lockable {{ void lock(); void unlock(); bool try_lock(); void lock_shared(); void unlock_shared(); }};
struct container {{ typedef int value_type; typedef int& reference; typedef const int& const_reference;
  typedef unsigned long size_type; int* begin(); int* end(); }};
struct order {{ bool operator()(int, int) const; }};
enum kind {{ one }};
}}
"""


class Probe:
    """Asks one GCC. folder: see above; major: its version."""

    def __init__(self, folder: Path, major: int):
        self.folder = folder
        tools = sorted(folder.glob(f"usr/**/gcc/x86_64-linux-gnu/{major}/cc1plus"))
        if not tools:
            raise FileNotFoundError(f"{folder}: no cc1plus of GCC {major}; unpack g++-{major} there")
        lib, gnu = folder / "usr/include", "x86_64-linux-gnu"
        own = folder / f"usr/lib/gcc/{gnu}/{major}/include"
        places = (lib / f"c++/{major}", lib / f"{gnu}/c++/{major}", lib / f"c++/{major}/backward", own, lib / gnu, lib)
        self.libraries = ":".join(str(folder / at) for at in (f"lib/{gnu}", f"usr/lib/{gnu}", "lib", "usr/lib"))
        loader = next(iter(sorted(folder.glob(f"**/{gnu}/ld-linux-x86-64.so.2"))))
        self.command = [str(loader), "--library-path", self.libraries, str(tools[0]), "-quiet", "-fsyntax-only", "-w",
                        "-fmax-errors=0", "-nostdinc", "-nostdinc++", "-D_GNU_SOURCE", "-imultiarch", gnu]  # fmt: skip
        for place in places:
            self.command += ["-isystem", str(place)]
        self.places = places

    def has(self, header: str) -> bool:
        """True when this compiler finds a header."""
        return any((place / header).is_file() for place in self.places)

    def list_headers(self) -> list[str]:
        """Those that are asked about: C++'s, and those of C and POSIX."""
        found = dict.fromkeys((*NAMES, *BARE, *HEADER_SINCE, *_CPP.split()))
        for folder in _FOLDERS:
            place = self.folder / "usr/include"
            for below in (place / folder, place / "x86_64-linux-gnu" / folder):
                found.update(dict.fromkeys(p.relative_to(below.parent if folder else below).as_posix()
                                           for p in sorted(below.glob("*.h"))))  # fmt: skip
        return [header for header in found if header and self.has(header)]

    def find_names(self, header: str, standard: int) -> frozenset[str]:
        """The names that a header brings under a language standard; none when it is no header of it."""
        lines, asked = _COMMON.format(header=header).split("\n"), {}
        for name, probe in list_probes():
            if probe.startswith("#"):
                lines.append(probe)
            else:
                asked[len(lines) + 1] = name
                lines.append(f"namespace p{len(lines)} {{ {probe} }}")
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "probe.cpp")
            source.write_text("\n".join(lines) + "\n")
            run = subprocess.run(
                [*self.command, f"-std=gnu++{standard}", str(source)], capture_output=True, text=True, timeout=300
            )
        reported = [int(line) for line in re.findall(r"probe\.cpp:(\d+):", run.stderr)]
        if run.returncode not in (0, 1) or "fatal error" in run.stderr:
            return frozenset()
        missing = {asked[line] for line in reported if line in asked}
        return frozenset(asked.values()) - missing


def list_probes() -> Iterator[tuple[str, str]]:
    """Names, and the line that the compiler refuses where a name is not there; directives around it have no name."""
    for name, spelled in _list_entries(NAMES):
        if spelled != name:
            yield f"std::{name}", f"enum {{ size = sizeof(std::{spelled.removesuffix('{}')}) }};"
        elif name.endswith(("::now", "::hardware_concurrency")):
            yield f"std::{name}", f"enum {{ size = sizeof(&std::{name}) }};"
        else:
            yield f"std::{name}", f"using std::{name};"
    for name, _ in _list_entries(BARE):
        yield "", f"#ifndef {name}"
        yield name, f"using ::{name};"
        yield "", "#endif"


def _list_entries(groups: dict[str, str]) -> Iterator[tuple[str, str]]:
    """Names and how they are written."""
    for text in groups.values():
        for entry in text.split():
            yield re.sub(r"<.*|\{\}$", "", entry), entry


def list_names(text: str) -> list[str]:
    """The names in an entry of NAMES, without how they are written."""
    return [name for name, _ in _list_entries({"": text})]


def find_home_headers() -> dict[str, str]:
    """Names to the header that is theirs."""
    of_std = {f"std::{name}": header for header, text in NAMES.items() for name, _ in _list_entries({header: text})}
    return {**of_std, **{name: header for header, text in BARE.items() for name in text.split()}}


def build_table(folders: dict[int, Path]) -> dict:
    """The shipped table: names, the header of each, and GCC to language standard to header to the names' places."""
    names = find_home_headers()
    place = {name: number for number, name in enumerate(names)}
    found: dict[str, dict[str, dict[str, str]]] = {}
    for major, folder in sorted(folders.items()):
        probe = Probe(folder, major)
        rows: dict[str, str] = {}
        for standard in _STANDARDS[:2] if major < 11 else _STANDARDS[1:]:
            # What C's own headers declare does not hang on the standard of C++.
            headers = [header for header in probe.list_headers() if not (header.endswith(".h") and header in rows)]
            with ThreadPoolExecutor(2) as pool:
                brought = pool.map(lambda header: probe.find_names(header, standard), headers)  # noqa: B023
                rows = dict(rows)
                for header, there in zip(headers, brought, strict=True):
                    rows[header] = f"{sum(1 << place[name] for name in there):x}"
            found.setdefault(str(major), {})[str(standard)] = rows
    return {"names": names, "gcc": found}


def add_compilers(table: dict, before: dict) -> dict:
    """A table with the compilers that one before it has besides. Raises ValueError where that is of other names."""
    if table["names"] != before["names"]:
        raise ValueError("the table before has other names; build it with all compilers")
    gcc = {**before["gcc"], **table["gcc"]}
    return {"names": table["names"], "gcc": {major: gcc[major] for major in sorted(gcc, key=int)}}


def _main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", metavar="GCC=FOLDER")
    parser.add_argument("--output", type=Path, default=DATA)
    parser.add_argument("--onto", action="store_true", help="keep what the table has of other GCCs")
    asked = parser.parse_args()
    folders = {int(major): Path(folder) for major, _, folder in (text.partition("=") for text in asked.folders)}
    table, file = build_table(folders), asked.output / "std_names.json.zst"
    if asked.onto:
        table = add_compilers(table, json.loads(zstandard.ZstdDecompressor().decompress(file.read_bytes())))
    write_table(file, table)


if __name__ == "__main__":
    _main()
