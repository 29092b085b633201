"""What libstdc++'s headers bring along: which standard header reaches the definition of a name in which GCC.

`data/std_names.json.zst`, which build/std_names.py makes by asking the compilers, tells for GCC 9 and later which names
each header brings under C++14, 17 and 20, which is much more from standard to standard.

`data/providers_std.json` was made by preprocessing each standard header of GCC 5, 7 and 9 to 15 under the language
standards in use, and listing the standard headers that it read. Where standards differ, all that any of them reads
counts. It tells of GCC 5 and 7, of which names brought more than later versions did.
"""

from functools import cache

import msgspec

from ..snapshot import DATA, read_table

_DEFINED: dict[tuple[str, ...], str] = {
    ("algorithm", "bits/stl_algo"): (
        "sort stable_sort find_if copy_n copy_if remove_if transform count_if count max_element min_element "
        "minmax_element reverse replace for_each unique binary_search upper_bound nth_element any_of all_of none_of "
        "clamp shuffle random_shuffle generate set_difference partial_sort rotate search merge includes "
        "next_permutation partition remove find minmax"
    ),
    ("algorithm", "bits/stl_algobase"): "min max fill copy lower_bound",
    ("any",): "any",
    ("array",): "array",
    ("atomic",): "atomic",
    ("bitset",): "bitset",
    ("cmath", "math.h"): "isnan isinf isfinite sqrt hypot fabs atan2 round",
    ("complex",): "complex",
    ("condition_variable",): "condition_variable",
    ("cstdint",): "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t intptr_t uintptr_t",
    ("deque", "bits/stl_deque"): "deque",
    ("fstream",): "ifstream ofstream",
    ("functional",): "bind mem_fn placeholders::_1 placeholders::_2 placeholders::_3",
    ("functional", "bits/refwrap"): "ref cref",
    ("functional", "bits/std_function"): "function",
    ("future",): "future promise async",
    ("iomanip",): "setprecision setw setfill",
    ("iostream",): "cout cerr",
    ("iterator",): "ostream_iterator istream_iterator",
    ("limits",): "numeric_limits",
    ("list", "bits/stl_list"): "list",
    ("map", "bits/stl_map"): "map",
    ("memory", "bits/shared_ptr"): "shared_ptr weak_ptr make_shared",
    ("memory", "bits/unique_ptr"): "unique_ptr make_unique",
    ("mutex",): "recursive_mutex call_once once_flag",
    ("mutex", "bits/std_mutex"): "mutex lock_guard",
    ("mutex", "bits/unique_lock"): "unique_lock",
    ("numeric",): "accumulate iota inner_product",
    ("optional",): "optional nullopt",
    ("queue",): "queue priority_queue",
    ("regex",): "regex smatch",
    ("set", "bits/stl_set"): "set",
    ("shared_mutex",): "shared_mutex shared_lock",
    ("sstream",): "stringstream ostringstream istringstream",
    ("stack",): "stack",
    ("stdexcept",): "runtime_error logic_error invalid_argument out_of_range length_error domain_error",
    ("string_view",): "string_view",
    ("system_error",): "system_error",
    ("thread", "bits/std_thread"): "thread",
    ("thread", "bits/this_thread_sleep"): "this_thread::sleep_for this_thread::sleep_until",
    ("tuple",): "tuple make_tuple",
    ("unordered_map",): "unordered_map",
    ("unordered_set",): "unordered_set",
    ("utility",): "exchange",
    ("utility", "bits/stl_pair"): "pair make_pair",
    ("variant",): "variant",
    ("vector", "bits/stl_vector"): "vector",
}
"""The headers that define names of `std`, the public one first; a `bits/` one is libstdc++'s own that does."""

DEFINED_IN: dict[str, tuple[str, ...]] = {
    **{f"std::{name}": headers for headers, names in _DEFINED.items() for name in names.split()},
    **{
        name: ("cstdint", "stdint.h", f"bits/stdint-{'uintn' if name[0] == 'u' else 'intn'}")
        for name in _DEFINED["cstdint",].split()
    },
    **dict.fromkeys(("FLT_MAX", "FLT_MIN", "FLT_EPSILON", "DBL_MAX", "DBL_MIN", "DBL_EPSILON"), ("cfloat", "float.h")),
    **dict.fromkeys(("INT_MAX", "INT_MIN", "UINT_MAX", "LONG_MAX"), ("climits", "limits.h")),
    **dict.fromkeys(("M_PI", "M_PI_2"), ("cmath", "math.h")),
    "usleep": ("unistd.h",),
    **{
        f"{sign}INT{bits}_{end}": ("cstdint", "stdint.h")
        for sign, end in (("U", "MAX"), ("", "MAX"), ("", "MIN"))
        for bits in (8, 16, 32, 64)
    },
}
"""Every name to the headers that define it, likewise."""

HEADER_SINCE: dict[str, int] = {
    **dict.fromkeys(
        (
            *("array", "atomic", "chrono", "condition_variable", "forward_list", "future", "initializer_list", "mutex"),
            *("random", "ratio", "regex", "scoped_allocator", "system_error", "thread", "tuple", "type_traits"),
            *("typeindex", "unordered_map", "unordered_set", "cfenv", "cinttypes", "cstdint"),
        ),
        11,
    ),
    "shared_mutex": 14,
    **dict.fromkeys(
        ("any", "charconv", "execution", "filesystem", "memory_resource", "optional", "string_view", "variant"), 17
    ),
    **dict.fromkeys(
        (
            *("barrier", "bit", "compare", "concepts", "coroutine", "latch", "numbers", "ranges", "semaphore"),
            *("source_location", "span", "stop_token", "syncstream"),
        ),
        20,
    ),
}
"""Standard headers to the C++ standard that they are of: libstdc++'s stop the compiler below C++11, and are empty below
a later one. Source: cppreference.com, "Standard library headers"; libstdc++'s bits/c++0x_warning.h."""


_BROUGHT_BY_C = {
    "stdint.h": (
        "arpa/nameser.h complex.h elf.h inttypes.h link.h net/ethernet.h net/if_arp.h net/if_ppp.h "
        "net/if_shaper.h netinet/ether.h netinet/icmp6.h netinet/if_ether.h netinet/if_fddi.h netinet/if_tr.h "
        "netinet/in_systm.h netinet/ip6.h netinet/ip_icmp.h netinet/tcp.h netinet/udp.h netipx/ipx.h nss.h "
        "protocols/talkd.h resolv.h sys/acct.h sys/auxv.h sys/epoll.h sys/eventfd.h sys/fanotify.h sys/inotify.h "
        "sys/mount.h sys/raw.h sys/rseq.h sys/signalfd.h tgmath.h thread_db.h"
    ),
    "bits/stdint-uintn": (
        "arpa/inet.h linux/fuse.h linux/idxd.h linux/mptcp.h linux/netfilter_bridge.h "
        "linux/netfilter_bridge/ebtables.h net/route.h netdb.h netinet/igmp.h netinet/in.h netinet/ip.h"
    ),
    "bits/stdint-intn": (
        "aio.h aliases.h arpa/inet.h fts.h ftw.h ifaddrs.h lastlog.h linux/atmbr2684.h linux/bpfilter.h "
        "linux/fuse.h linux/gsmmux.h linux/icmp.h linux/idxd.h linux/if.h linux/if_arp.h linux/if_bonding.h "
        "linux/if_pppox.h linux/if_tunnel.h linux/input.h linux/ip6_tunnel.h linux/joystick.h linux/llc.h "
        "linux/mctp.h linux/mptcp.h linux/netdevice.h linux/netfilter/xt_RATEEST.h linux/netfilter/xt_hashlimit.h "
        "linux/netfilter/xt_physdev.h linux/netfilter/xt_rateest.h linux/netfilter_arp/arp_tables.h "
        "linux/netfilter_arp/arpt_mangle.h linux/netfilter_bridge.h linux/netfilter_bridge/ebtables.h "
        "linux/netfilter_ipv4/ip_tables.h linux/netfilter_ipv6/ip6_tables.h linux/route.h linux/uhid.h "
        "linux/uinput.h linux/vm_sockets.h linux/wireless.h math.h mqueue.h net/if.h net/route.h netatalk/at.h "
        "netdb.h netinet/igmp.h netinet/in.h netinet/ip.h netrose/rose.h proc_service.h protocols/routed.h "
        "protocols/rwhod.h protocols/timed.h re_comp.h regex.h semaphore.h spawn.h stdlib.h sys/bitypes.h "
        "sys/fsuid.h sys/gmon.h sys/mtio.h sys/param.h sys/procfs.h sys/profil.h sys/quota.h sys/random.h "
        "sys/sem.h sys/sendfile.h sys/socket.h sys/socketvar.h sys/types.h sys/uio.h sys/xattr.h utmp.h"
    ),
    "limits.h": "argp.h arpa/nameser.h resolv.h sys/param.h values.h",
    "math.h": "complex.h tgmath.h",
    "float.h": "values.h",
    "unistd.h": "arpa/nameser.h resolv.h signal.h sys/param.h sys/signal.h sys/unistd.h sys/wait.h wait.h",
}
"""What headers of C and POSIX define: of a header above (`bits/` for glibc's own, which has the types only, with or
without a sign), those that bring it. Found by compiling each header of glibc 2.36 and Linux 6.1 alone as C++, with a
use of one name."""


@cache
def _of_c() -> dict[str, frozenset[str]]:
    """The same by header: what it brings."""
    found: dict[str, set[str]] = {}
    for brought, headers in _BROUGHT_BY_C.items():
        for header in headers.split():
            found.setdefault(header, set()).add(brought)
    return {header: frozenset(brought) for header, brought in found.items()}


@cache
def _tables() -> tuple[tuple[int, dict[str, frozenset[str]]], ...]:
    read = read_table(DATA / "providers_std.json", dict[str, dict[str, str]])
    return tuple(
        (int(major), {header: frozenset(text.split()) for header, text in table.items()})
        for major, table in sorted(read.items(), key=lambda item: int(item[0]))
    )


def brought_by(header: str, gcc: int) -> frozenset[str]:
    """Standard headers (and `bits/` ones of DEFINED_IN) that a standard header reads in a GCC, itself included.

    gcc: major version; one that is not known is answered as the nearest older one, or the oldest. Raises SnapshotError
    when the data cannot be read.
    """
    return _table(gcc).get(header, frozenset()) | {header}


@cache
def _table(gcc: int) -> dict[str, frozenset[str]]:
    older = [table for major, table in _tables() if major <= gcc]
    of_c, read = _of_c(), older[-1] if older else _tables()[0][1]
    return {
        **of_c,
        **{header: found.union(*(of_c.get(h, ()) for h in (header, *found))) for header, found in read.items()},
    }


class StandardNames(msgspec.Struct, frozen=True):
    """The shipped table. names: each with the header that is its own, whose places stand for them. gcc: major version
    to C++ standard to header to the names that it brings, as a hexadecimal number with a bit for each."""

    names: dict[str, str]
    gcc: dict[str, dict[str, dict[str, str]]]


@cache
def names() -> StandardNames:
    """The names that are known. Raises SnapshotError when the data cannot be read."""
    return read_table(DATA / "std_names.json.zst", StandardNames)


@cache
def oldest() -> int:
    """The first GCC whose headers are known name by name."""
    return min(map(int, names().gcc))


# Headers of C that are known: `cmath` is `math.h` as well.
_C = frozenset(
    ("cstdint", "cfloat", "climits", "cmath", "cstdlib", "cstring", "cstdio", "cassert", "cerrno", "cinttypes",
     "csignal", "cstdarg")
)  # fmt: skip


@cache
def offering() -> dict[str, tuple[str, ...]]:
    """Names of the standard libraries to the headers that offer them, the one to include first."""
    told = {
        name: (header, f"{header[1:]}.h") if header in _C and not name.startswith("std::") else (header,)
        for name, header in names().names.items()
    }
    return {**DEFINED_IN, **told}


@cache
def _places() -> dict[str, int]:
    return {name: 1 << place for place, name in enumerate(names().names)}


def bit_of(name: str) -> int:
    """The bit that stands for a name in named_by(); 0 for one that is not known."""
    return _places().get(name, 0)


@cache
def named_by(header: str, gcc: int, standard: int) -> int | None:
    """The names that a header brings alone, as bits; None for a header that is not known.

    gcc: major version; one that is not known is answered as the nearest older one, or the oldest. standard: year of the
    C++ standard, likewise.
    """
    table = _names_of(gcc, standard)
    told = table.get(header)
    return None if told is None else int(told, 16)


@cache
def _names_of(gcc: int, standard: int) -> dict[str, str]:
    majors = {int(major): table for major, table in names().gcc.items()}
    standards = majors[max((major for major in majors if major <= gcc), default=min(majors))]
    years = {2000 + int(number): table for number, table in standards.items()}
    return years[max((year for year in years if year <= standard), default=min(years))]


def reaches(headers: frozenset[str], name: str, gcc: int) -> bool | None:
    """Whether any of these standard headers brings the definition of a name in a GCC; None for an unknown name."""
    wanted = DEFINED_IN.get(name)
    if wanted is None:
        return None
    return any(not brought_by(header, gcc).isdisjoint(wanted) for header in headers)
