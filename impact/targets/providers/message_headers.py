"""Which other generated headers a header includes that is made from a message, service or action.

Sources: gencpp's templates; rosidl_generator_cpp's, whose parts of a header lie in `detail/` since 0.9 (Foxy).
"""

import re
from collections.abc import Iterator
from functools import cached_property, lru_cache
from typing import NamedTuple

from ...facts.interface import PRIMITIVES, TIMES, Interface, make_full_name
from ..surface.fields import ROS1_SUFFIXES, make_snake_case

_ROS1 = re.compile(r"(?P<package>\w+)/(?P<name>[A-Z]\w*)\.h\Z")
_ROS2 = re.compile(
    r"(?P<folder>(?P<package>\w+)/(?P<kind>msg|srv|action)/)(?:detail/)?(?P<stem>[a-z0-9_]+?)(?P<part>__\w+)?\.hpp\Z"
)
_TYPE1 = re.compile(r"(?P<package>\w+_(?:msgs|srvs|actions))::[A-Z][A-Za-z0-9]*?(?=(?:Const)?Ptr\b|\b)")
_TYPE2 = re.compile(
    r"(?P<package>\w+)::"
    r"(?:msg::[A-Z][A-Za-z0-9]*\b|(?:srv|action)::[A-Z][A-Za-z0-9]*(?=_(?:Re|Goal|Send|Get|Feed)|\b))"
)
_ROS2_C = re.compile(r"(?P<package>\w+)/(?:msg|srv|action)/(?:detail/)?[a-z0-9_]+\.h\Z")
OF_C = (
    *("stdbool.h", "stddef.h", "stdint.h", "stdlib.h", "rosidl_typesupport_interface/macros.h"),
    *("rosidl_runtime_c/primitives_sequence.h", "rosidl_runtime_c/string.h", "rosidl_runtime_c/u16string.h"),
    *("rosidl_runtime_c/visibility_control.h", "rosidl_runtime_c/message_type_support_struct.h"),
)
"""What the headers for C include, those of nested messages aside, which include the same. Source: the templates of
rosidl_generator_c, 3.1 (Humble) to 4.6 (Jazzy)."""
_OF_ACTIONS = ("actionlib_msgs/GoalID.h", "actionlib_msgs/GoalStatus.h", "std_msgs/Header.h")


def find_package(header: str, ros: int) -> str | None:
    """The package of a header that is made from an interface in this ROS generation, by its path; None for others."""
    found = (_ROS1 if ros == 1 else _ROS2).match(header)
    return None if found is None else found["package"]


class InterfaceType(NamedTuple):
    """A type of C++ that is made from an interface. name: as code writes it. headers: that define it, first the one to
    include, then parts of it that other headers include."""

    name: str
    package: str
    ros: int
    headers: tuple[str, ...]


@lru_cache(maxsize=20000)
def parse_type(name: str) -> InterfaceType | None:
    """The type that a qualified name of C++ begins with; None where it looks like none. Of ROS 1, types in packages
    whose names say that they hold messages, without what only some of them have (`Ptr`)."""
    found, ros = _TYPE2.match(name), 2
    if found is None:
        found, ros = _TYPE1.match(name), 1
    return None if found is None else InterfaceType(found[0], found["package"], ros, _list_files(found[0].split("::")))


def _list_files(parts: list[str]) -> tuple[str, ...]:
    if len(parts) == 2:
        return (f"{parts[0]}/{parts[1]}.h",)
    folder, stem = f"{parts[0]}/{parts[1]}/", make_snake_case(parts[2])
    return f"{folder}{stem}.hpp", f"{folder}detail/{stem}__struct.hpp", f"{folder}{stem}__struct.hpp"


def find_package_for_c(header: str) -> str | None:
    """The package of a header for C that ROS 2 makes from an interface, by its path; None for others."""
    found = _ROS2_C.match(header)
    return None if found is None else found["package"]


class Definitions(dict[str, Interface]):
    """The interfaces of a package, by `msg/Name`."""

    @cached_property
    def by_stem(self) -> dict[tuple[str, str], Interface]:
        """The same by their kind and the stem of their headers in ROS 2."""
        found: dict[tuple[str, str], Interface] = {}
        for name, interface in self.items():
            kind, _, name = name.partition("/")
            found.setdefault((kind, make_snake_case(name)), interface)
        return found


def list_included(header: str, ros: int, interfaces: Definitions, apart: bool) -> tuple[str, ...] | None:
    """The generated headers that such a header includes; None when its package has no such interface. interfaces: those
    of its package. apart: the parts of a header lie in a folder of their own."""
    return _list_ros1(header, interfaces) if ros == 1 else _list_ros2(header, interfaces, "detail/" if apart else "")


def _list_ros1(header: str, interfaces: Definitions) -> tuple[str, ...] | None:
    found = _ROS1.match(header)
    if found is None:
        return None
    package, name = found.groups()
    for kind, stem in (("msg", name), ("srv", name), *_iterate_stems(name)):
        definition = interfaces.get(f"{kind}/{stem}")
        if definition is None:
            continue
        own = [f"{package}/{stem}{ending}.h" for ending in ROS1_SUFFIXES[kind] if stem + ending != name]
        nested = [f"{other}/{type_}.h" for other, type_ in _iterate_nested(definition, package)]
        return tuple(dict.fromkeys((*own, *nested, *(_OF_ACTIONS if kind == "action" else ()))))
    return None


def _iterate_stems(name: str) -> Iterator[tuple[str, str]]:
    """Services and actions that a header may be one of several of."""
    for kind, endings in ROS1_SUFFIXES.items():
        for ending in endings:
            if ending and name.endswith(ending):
                yield kind, name.removesuffix(ending)


def _list_ros2(header: str, interfaces: Definitions, detail: str) -> tuple[str, ...] | None:
    found = _ROS2.match(header)
    if found is None:
        return None
    definition = interfaces.by_stem.get((found["kind"], found["stem"]))
    if definition is None:
        return None
    own = f"{found['folder']}{detail}{found['stem']}"
    if found["part"] is None:
        return tuple(f"{own}{part}.hpp" for part in ("__builder", "__struct", "__traits"))
    if found["part"] == "__builder":
        return (f"{own}__struct.hpp",)
    return tuple(
        dict.fromkeys(
            f"{other}/msg/{detail}{make_snake_case(type_)}{found['part']}.hpp"
            for other, type_ in _iterate_nested(definition, found["package"])
        )
    )


def _iterate_nested(definition: Interface, package: str) -> Iterator[tuple[str, str]]:
    """Package and name of each interface that a field has as its type."""
    for section in definition.sections:
        for field in section.fields:
            type_ = field.type.partition("<")[0]
            if type_ in PRIMITIVES or type_ in TIMES:
                continue
            other, _, name = make_full_name(type_, package).partition("/")
            yield other, name
