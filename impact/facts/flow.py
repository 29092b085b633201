"""What one C++ or Python file tells about the flow of messages: classes, functions, calls and their guards.

Both languages give the same facts, so that whatever joins them need not know which it reads. Nothing is resolved here:
names are as written, and which call advertises or subscribes is known to the table of frameworks alone.
"""

from __future__ import annotations

import msgspec

from .place import Problem


class FlowExpr(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An expression as far as it is followed. text: what it says, by kind; parts: what it is made of.

    | kind | text | parts |
    |---|---|---|
    | text | value of a string literal (adjacent ones joined) | |
    | number | as written; also True, False, None, nullptr | |
    | name | a path: `topic_`, `this.pub_` (C++ members through `this->` and Python's `self.` alike), `a.b.c`
      (`->` is `.`), `ns::kName` | |
    | index | | the container, the index |
    | call | the callee as a path, without template arguments (as in Call) | the arguments |
    | make | the type of an object that is made: `T(...)`, `T{...}`, `std::make_shared<T>(...)` | the arguments |
    | join | operator `+`, `/` of paths, or `%` and f-strings as their pieces | the operands in order |
    | choice | | condition, value if true, value if false |
    | function | a function or method referred to and not called: `&A::b`, `self.on_scan`, `free` | |
    | lambda | the name of the Function it became | |
    | bind | | the function, then the bound arguments (std::bind, boost::bind, functools.partial) |
    | list | | its elements (tuples, braces) |
    | keyword | name of the argument; `*` and `**` for what Python unpacks | its value |
    | other | the source, its white space as single blanks, at most 120 characters | of a comprehension, what each
      element is |

    receiver: of a call that is made on what another call or a made object gives (`QoS(1).reliable()`), that one; in
    Python also of a name that begins with a call (`get_parameter("a").value`), and the literal that a method is called
    on (`"/".join(names)`).
    """

    kind: str
    text: str = ""
    parts: tuple[FlowExpr, ...] = ()
    receiver: FlowExpr | None = None


class Guard(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A condition under which statements run. outer: the place of the guard around it in Function.guards, -1 for none.

    text: the condition as written, white space as single blanks. line: of the statement that asks.

    What follows a jump in a branch of a branch is under the conditions of both, joined (`unless a and b`); what
    follows a handler that jumps is `unless` `except E` or `catch (E)`. The else of a Python loop that `break` leaves is
    `unless` `break`. A jump in a loop tells nothing of what follows the loop.

    | kind | holds |
    |---|---|
    | if | the condition (also of `? :`, `and`, `&&` before a call, assert) is true |
    | unless | it is false: an else branch, or what follows a branch that always jumps; text `except X`, `catch (X)`:
      nothing of this kind was raised in the try that begins at the line |
    | while | the loop goes round: condition of while and three-part for |
    | for | once for each of what is walked through; text: the whole head |
    | do | at least once; text: the condition at its end |
    | case | `subject == value`, written so; more values joined by ` or ` where cases fall through; `default` as
      `subject other than a, b` |
    | catch | the exception named was raised |
    | cpp | the preprocessor's condition is true (negated ones written `!(...)`) |
    | macro | inside the block of an unknown macro; text: its head |
    | with | inside a Python `with`; text: its head |
    | never | it stands behind a jump that always happens; text: `after return`, the jump's first word |
    """

    kind: str
    text: str
    line: int
    outer: int = -1


class FlowCall(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A call. callee: path as in Expr (`this.nh_.advertise`, `std::bind`, `node.create_publisher`), its last part being
    the function; empty receiver pieces that are no path are written `()`: `get().publish`. types: template arguments as
    written, without the angle brackets. guard: place in Function.guards, -1 for none. target: what the result is kept
    in, a path, empty for nothing. returned: the result is what the function returns.

    An element of a receiver or target is `[]` as in Access: `this.pubs_.[].publish`."""

    callee: str
    arguments: tuple[FlowExpr, ...]
    line: int
    column: int
    guard: int = -1
    types: str = ""
    target: str = ""
    returned: bool = False


class Assignment(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """target = value, initialisation included. target: a path; type: as written where it is declared here (`auto` too).
    operator: `=`, `+=`, ...; `return` with an empty target for what a function returns. key: of the element that is
    assigned, where it is a literal (`remappings["image"] = ...`)."""

    target: str
    value: FlowExpr
    line: int
    guard: int = -1
    type: str = ""
    operator: str = "="
    key: FlowExpr | None = None


class Access(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """How a parameter or local variable, or something below it, may be changed: reading it is not listed. path: with
    its members (`msg.header.stamp`; `[]` for an element: `msg.ranges.[]`). kind: `write`, `pass` (it is given to
    what is called, or a method of it is called) or `escape` (handed to something that cannot be followed, whole or in
    part, or captured by a Function inside)."""

    path: str
    kind: str


class FlowParameter(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter of a function. type: as written (annotation in Python), empty for none. Python's `self` and `cls` are
    left out; the others are named `*args`, `**kwargs`, and `*` alone before those that are given by keyword only."""

    name: str
    type: str = ""
    default: FlowExpr | None = None


class FlowFunction(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A function's body. name: scopes joined by `::` in C++ and `.` in Python, template arguments left out; a lambda is
    called as what it stands in, followed by `lambda@line:column`. owner: the class it belongs to, as far as the file
    says (`ns::Class` for `void Class::f()` inside `namespace ns`), empty for none. returns: the type as written.
    outside: names that Python declares `global` or `nonlocal`. types: parameters of the C++ template that it is written
    as, empty for those that are no types.

    The body of a Python class is a Function of the class's name, in which the names it binds are `this.name`."""

    name: str
    owner: str
    parameters: tuple[FlowParameter, ...]
    line: int
    end: int
    guards: tuple[Guard, ...] = ()
    calls: tuple[FlowCall, ...] = ()
    assignments: tuple[Assignment, ...] = ()
    accesses: tuple[Access, ...] = ()
    returns: str = ""
    outside: tuple[str, ...] = ()
    types: tuple[str, ...] = ()


class DataMember(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A data member or a constant. type as written; value: its initialiser. shared: it is of the class, not of each
    object."""

    name: str
    type: str
    line: int
    value: FlowExpr | None = None
    shared: bool = False


class FlowClass(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A class or struct. name: with its scopes. bases: as written, template arguments kept. types: parameters of a
    template, empty for those that are no types."""

    name: str
    bases: tuple[str, ...]
    members: tuple[DataMember, ...]
    line: int
    end: int
    types: tuple[str, ...] = ()


class Alias(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """`using name = target`, typedef, namespace alias, `using a::b` (name `b`), `import a.b as name`, `from a import b`
    (target `a.b`). scope: where it stands. A `using namespace a` or `from a import *` has the name `*`."""

    name: str
    target: str
    scope: str = ""


class FlowFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """language: `cpp` or `python`. constants: variables outside functions and classes, `#define`s of one literal and
    enumerators among them, and what Python functions assign to names declared global; in Python once for each place
    that assigns. exports: classes given to nodelet, component and plugin macros. includes: headers, as written between
    the brackets or quotes. unread: spans of lines (first, last) that did not parse. defaults: of the C++ functions that
    are declared without a body and with defaults, the name and for each parameter its default. The body of the file
    outside functions is a Function called `` (empty name)."""

    language: str
    aliases: tuple[Alias, ...] = ()
    classes: tuple[FlowClass, ...] = ()
    functions: tuple[FlowFunction, ...] = ()
    constants: tuple[DataMember, ...] = ()
    exports: tuple[str, ...] = ()
    unread: tuple[tuple[int, int], ...] = ()
    problems: tuple[Problem, ...] = ()
    includes: tuple[str, ...] = ()
    defaults: tuple[tuple[str, tuple[FlowExpr | None, ...]], ...] = ()
