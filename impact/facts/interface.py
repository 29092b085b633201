"""msg, srv, action and IDL definitions to facts."""

import msgspec

from .place import Problem


class Field(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A field. type is as written without array part (`geometry_msgs/Point`, `string<=10`); array is ``, `[]`, `[3]`
    or `[<=3]`; default as written or empty."""

    name: str
    type: str
    array: str
    default: str
    line: int
    column: int = 0
    comment: str = ""


class Constant(msgspec.Struct, frozen=True, array_like=True, gc=False):
    name: str
    type: str
    value: str
    line: int
    column: int = 0


class Section(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One part of a definition: `message`; `request` and `response`; `goal`, `result` and `feedback`."""

    name: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]


class Interface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A definition. kind is msg, srv, action or idl (then `name` and `module` come from the text)."""

    kind: str
    sections: tuple[Section, ...]
    name: str = ""
    problems: tuple[Problem, ...] = ()
