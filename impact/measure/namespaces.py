"""Where the two sides of the experiment are: three network namespaces with shaped links between them, or one machine's
loopback.

A namespace is called rosimpact-PROCESS-START-ROLE, by the process that made it and the time that one started, and so is
the folder for temporary files. Whoever comes next so knows which were left behind by a run that was killed, and removes
them with all that still runs in them. Cables lie between namespaces and end with them.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from ...edges.console import UserError
from ...edges.files import read_file
from .children import find_program, hold_signals, run_program
from .plan import format_link

PREFIX = "rosimpact-"
_NAME = re.compile(rf"{PREFIX}(\d+)-(\d+)-(?:publisher|router|subscriber)")
_WORK = re.compile(rf"{PREFIX}(\d+)-(\d+)-work-\w+")
_ROLES = ("publisher", "router", "subscriber")
_FOLDERS = ("/run/netns", "/var/run/netns")
_CAPABILITIES = {"CAP_NET_ADMIN": 12, "CAP_SYS_ADMIN": 21}
_STATUS = 1 << 16
# A bucket that holds two packets; for fast links what they send in 50 µs, which timers are late by.
_BURST, _BURST_SECONDS = 4_096, 50e-6
_WAITING_MS = 50


class NetworkSite(NamedTuple):
    """One side: what a command begins with to be run there, and its address as the other side sees it."""

    prefix: tuple[str, ...]
    address: str


class NetworkSites(NamedTuple):
    """Both sides. The master runs at the subscriber's."""

    publisher: NetworkSite
    subscriber: NetworkSite


LOOPBACK = NetworkSites(NetworkSite((), "127.0.0.1"), NetworkSite((), "127.0.0.1"))


def find_missing() -> list[str]:
    """What namespaces need and this machine lacks, each as a clause with what to do."""
    if sys.platform != "linux":
        return ["network namespaces exist on Linux alone: measure with --loopback"]
    missing = []
    lacking = _list_lacking_capabilities()
    if lacking:
        missing.append(f"root, or {' and '.join(lacking)}: run it with sudo, or measure without a link with --loopback")
    if absent := [name for name in ("ip", "tc") if not find_program(name)]:
        missing.append(f"{' and '.join(absent)}: apt-get install -y iproute2")
    return missing


def _list_lacking_capabilities() -> list[str]:
    match = re.search(rb"^CapEff:\s*([0-9a-f]+)", read_file("/proc/self/status", _STATUS), re.MULTILINE)
    held = int(match[1], 16) if match else 0
    return [name for name, bit in _CAPABILITIES.items() if not held >> bit & 1]


def remove_leftovers() -> list[str]:
    """Removes the namespaces and temporary folders of runs that are no more, with the processes in them. Returns their
    names."""
    names = [name for name in list_namespaces() if not _is_alive(_NAME, name)]
    for name in names:
        _remove_namespace(name)
    still = list_namespaces()  # those of root, where this is not
    names = [name for name in names if name not in still]
    folders = [path for path in Path(tempfile.gettempdir()).glob(f"{PREFIX}*") if _WORK.fullmatch(path.name)]
    for folder in folders:
        if not _is_alive(_WORK, folder.name) and folder.lstat().st_uid == os.geteuid():
            shutil.rmtree(folder, ignore_errors=True)
            names.append(folder.name)
    return names


def list_namespaces() -> list[str]:
    """The namespaces that runs of the experiment made and that are there."""
    found: set[str] = set()
    for folder in _FOLDERS:
        with contextlib.suppress(OSError):
            found.update(name for name in os.listdir(folder) if _NAME.fullmatch(name))
    return sorted(found)


@contextlib.contextmanager
def open_work_folder() -> Iterator[Path]:
    """A folder for temporary files, which is removed however it ends."""
    with tempfile.TemporaryDirectory(prefix=f"{_make_owner()}-work-", ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def _make_owner() -> str:
    return f"{PREFIX}{os.getpid()}-{_read_start(os.getpid())}"


def _is_alive(pattern: re.Pattern[str], name: str) -> bool:
    match = pattern.fullmatch(name)
    return match is not None and _read_start(int(match[1])) == match[2]


def _read_start(process: int) -> str:
    """When a process started, in ticks since the machine did; empty when there is none."""
    try:
        fields = read_file(f"/proc/{process}/stat", _STATUS).rpartition(b")")[2].split()
    except OSError:
        return ""
    return fields[19].decode() if len(fields) > 19 else ""


def _remove_namespace(name: str) -> None:
    """Ends what runs in a namespace and removes it; says nothing of one that is not there."""
    ip = find_program("ip")
    with contextlib.suppress(UserError):
        for process in run_program([ip, "netns", "pids", name]).split():
            with contextlib.suppress(OSError, ValueError):
                os.kill(int(process), signal.SIGKILL)
    with contextlib.suppress(UserError):
        run_program([ip, "netns", "delete", name])


@contextlib.contextmanager
def open_namespaces(link: int) -> Iterator[NetworkSites]:
    """Both sides in namespaces of their own, with a router between them and links of so many bits per second, 0 for no
    limit. They are removed however it ends. Raises UserError where they cannot be made."""
    names = {role: f"{_make_owner()}-{role}" for role in _ROLES}
    try:
        for name in names.values():
            _run_ip("netns", "add", name)
        for place, role in enumerate(("publisher", "subscriber"), 1):
            _connect(names[role], names["router"], place, role)
        run_program([
            find_program("ip"), "netns", "exec", names["router"], "sh", "-c", "echo 1 > /proc/sys/net/ipv4/ip_forward",
        ])  # fmt: skip
        if link:
            for place, role in enumerate(("publisher", "subscriber"), 1):
                _limit_link(names[role], "eth0", link)
                _limit_link(names["router"], f"eth{place}", link)
        yield NetworkSites(*(
            NetworkSite((find_program("ip"), "netns", "exec", names[role]), f"10.77.{place}.2")
            for place, role in enumerate(("publisher", "subscriber"), 1)
        ))  # fmt: skip
    finally:
        with hold_signals():
            for name in names.values():
                _remove_namespace(name)


def _connect(name: str, router: str, place: int, role: str) -> None:
    """Lays a cable from a side to the router, and brings both ends up."""
    end = f"eth{place}"
    _run_ip("link", "add", "eth0", "netns", name, "type", "veth", "peer", "name", end, "netns", router)
    for namespace, device, last in ((name, "eth0", 2), (router, end, 1)):
        _run_ip("-n", namespace, "address", "add", f"10.77.{place}.{last}/24", "dev", device)
        _run_ip("-n", namespace, "link", "set", device, "up")
        _run_ip("-n", namespace, "link", "set", "lo", "up")
    _run_ip("-n", name, "route", "add", "default", "via", f"10.77.{place}.1")


def _run_ip(*words: str) -> None:
    try:
        run_program([find_program("ip"), *words])
    except UserError as error:
        raise UserError(
            f"network namespaces cannot be set up: {error}; give this container or machine the right to, or measure "
            "without a link with --loopback"
        ) from None


def _limit_link(name: str, device: str, link: int) -> None:
    burst = max(_BURST, int(link / 8 * _BURST_SECONDS))
    try:
        run_program([
            find_program("tc"), "-n", name, "qdisc", "add", "dev", device, "root", "tbf", "rate", f"{link}bit",
            "burst", str(burst), "latency", f"{_WAITING_MS}ms",
        ])  # fmt: skip
    except UserError as error:
        raise UserError(
            f"the link cannot be limited to {format_link(link)}: {error}; load the kernel module sch_tbf, or give "
            "--link none"
        ) from None
