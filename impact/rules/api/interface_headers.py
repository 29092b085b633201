"""Headers that are generated from interfaces: by a path of the other ROS generation, of C, or of no interface."""

import re
from typing import NamedTuple

from ...model.absent_headers import INTERFACE_FOLDERS, find_interface_folder, generates_interfaces, is_nobody
from ...model.misspelling import SpellingIndex
from ...model.package import IncludeUse, is_header
from ...model.workspace import make_snake_case
from ...targets.surface.fields import load_fields
from ...targets.symbol import Availability, Symbol
from ..vocabulary import Doubt, Package, TargetView, Text, Value
from .diagnosis import find_missing

TEXTS = {
    "ros 1 name": Text("`{subject}` is the ROS 1 name of a generated header", "include `{replacement}`"),
    "ros 2 name": Text("`{subject}` is the ROS 2 name of a generated header", "include `{replacement}`"),
    "case": Text("no header `{subject}` is generated: generated headers are in lower case", "include `{replacement}`"),
    "folder": Text("no header `{subject}` is generated: `{folder}` holds them", "include `{replacement}`"),
    "moved": Text("`{upstream}` generates no `{subject}`", "include `{replacement}`"),
    "never generated": Text(
        "no known version of {upstream} has an interface for `{subject}`", "[[did you mean `{replacement}`?]]"
    ),
    "c": Text("`{subject}` is the generated header for C; C++ code needs the `.hpp`", "include `{replacement}`"),
}

# Generated headers that users include, by ROS generation; dynamic_reconfigure makes `XConfig.h`.
_GENERATED_HEADER = {
    1: re.compile(r"[A-Z][A-Za-z0-9]*(?<!Config)\.h\Z"),
    2: re.compile(r"(?:msg|srv|action)/[a-z][a-z0-9_]*(?<!__struct)(?<!__traits)(?<!__builder)\.hpp\Z"),
}
_CAMEL = re.compile(r"[A-Z][A-Za-z0-9]*\Z")
_C_HEADER = re.compile(r"(?P<stem>(?P<package>\w+)/(?:msg|srv|action)/[a-z0-9_]+)\.h\Z")


class Fault(NamedTuple):
    """What is wrong with an include path. kind, data: of TEXTS; empty where found, how the target stands to the
    interface, says it."""

    kind: str
    data: dict[str, Value]
    found: Availability | None = None


def find_interface_fault(view: TargetView, path: str) -> Fault | None:
    """What is wrong with the path of a generated header on this target; None when nothing is known to be."""
    head, _, rest = path.partition("/")
    if not rest:
        return None
    if (other := _respell(view, head, rest)) is not None:
        return other
    stem, _, ending = rest.rpartition(".")
    of_this_generation = ("/" in stem) == (view.target.ros == 2)
    name = ""
    if stem and of_this_generation and ending == ("hpp" if "/" in stem else "h"):
        history = load_fields().find_history(head, view.target.ros)
        name = history.by_header.get(stem, "") if history is not None else ""
    fault = None
    if head in view.workspace.packages:
        if of_this_generation and (name or _CAMEL.match(stem)):
            fault = _find_moved(view, head, rest)
    elif name:
        found = find_missing(view, "interface", name, (head,))
        fault = Fault("", {}, found) if found is not None else None
    else:
        fault = _find_never_generated(view, path)
        if fault is None and _GENERATED_HEADER[view.target.ros].match(rest) and is_nobody(view, head):
            fault = _find_moved(view, head, rest)
    match = _C_HEADER.match(path) if fault is None and view.target.ros == 2 else None
    if match and generates_interfaces(view, match["package"]):
        return Fault("c", {"replacement": f"{match['stem']}.hpp"})
    return fault


def _respell(view: TargetView, head: str, rest: str) -> Fault | None:
    """A spelling of the other generation, in another case, or without the folder."""
    if not generates_interfaces(view, head):
        return None
    parts = rest.split("/")
    name = parts[-1].rsplit(".", 1)[0]
    if view.target.ros == 2:
        if len(parts) == 1 and rest.endswith(".h") and _CAMEL.match(name):
            folder = "srv" if name.endswith(("Request", "Response")) else "msg"
            return Fault("ros 1 name", {"replacement": f"{head}/{folder}/{make_snake_case(name)}.hpp"})
        if len(parts) == 1 and rest.endswith(".hpp") and (folder := find_interface_folder(view, head, name)):
            return Fault("folder", {"folder": f"{head}/{folder}", "replacement": f"{head}/{folder}/{rest}"})
        if len(parts) == 2 and parts[0] in INTERFACE_FOLDERS and name != name.lower():
            return Fault("case", {"replacement": f"{head}/{parts[0]}/{make_snake_case(name).replace('__', '_')}.hpp"})
    elif len(parts) == 2 and parts[0] in INTERFACE_FOLDERS and rest.endswith(".hpp"):
        return Fault("ros 2 name", {"replacement": f"{head}/<Name>.h"})
    return None


def _find_moved(view: TargetView, head: str, rest: str) -> Fault | None:
    """A header of a package of the workspace whose interface another one there defines."""
    workspace = view.workspace
    makers = [n for n in workspace.interface_names if n != head and workspace.is_interface_header(n, rest)]
    return Fault("moved", {"upstream": head, "replacement": f"{makers[0]}/{rest}"}) if len(makers) == 1 else None


def _find_never_generated(view: TargetView, path: str) -> Fault | None:
    """A path that looks like that of a generated header, where no version of the package that was read has such an
    interface, all of them were read up to the target's, and the release has no such file."""
    head, _, rest = path.partition("/")
    version = view.target.find_version(head)
    history = load_fields().find_history(head, view.target.ros) if version else None
    if not version or history is None or history.find_state(version) is None:
        return None
    if not _GENERATED_HEADER[view.target.ros].match(rest) or not history.read_up_to(version):
        return None
    if view.providers.list_header_spans(head, path) or view.has_released_header(head, path):
        return None
    if view.has_released_header(head, path) is None and view.offers.find_package(head) is None:
        return None
    if view.find_availability(Symbol("header", path, (head,))).state == "present":
        return None
    stem, _, ending = rest.rpartition(".")
    close = SpellingIndex(s for s in history.by_header if ("/" in s) == ("/" in rest)).find_nearest(stem)
    return Fault("never generated", {"upstream": head, "replacement": f"{head}/{close}.{ending}" if close else ""})


def collect_c_header_doubts(view: TargetView, package: Package, include: IncludeUse) -> tuple[Doubt, ...] | None:
    """What speaks against an error where a file includes a header of C; None where the file may be about C."""
    beside = frozenset(i.path for i in package.linked.includes if i.at.path == include.at.path) - {include.path}
    if include.role == "aside" or include.path + "pp" in beside:
        return None
    if not any(path.startswith("rclcpp") for path in beside):
        return None
    own = any(path == include.at.path and inner for path, inner in package.linked.inner)
    if own or not is_header(include.at.path) or not view.is_sure(include.conditions):
        return (Doubt.UNCOMPILED,)  # what the package's own headers bring along is not followed
    machine, wanted = view.machine, include.path + "pp"
    unknown = [path for path in machine.list_unknown_headers(beside) if path in beside and not view.is_standard(path)]
    brought = machine.find_bits((wanted,)) & machine.compute_mask(beside)
    return (Doubt.UNCOMPILED,) if unknown or brought else (Doubt.INCOMPLETE,)
