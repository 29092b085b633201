"""What one C++ or Python file does with variables and what is below them: what the reading of fields rests on.

Every place where a variable, a member or the result of a call stands in a function is one PathUse, told by what is
done with it there. What is not understood is told too (`use`): whoever asks which fields of a message are read takes
such a one for a reading of everything below it. Both languages give the same facts; nothing is resolved here.
"""

from __future__ import annotations

import msgspec

from .place import Problem

TYPE_TESTS = frozenset(("isinstance", "type"))
"""Functions of Python that ask for the class of what they are given: tests, by `to`."""


class PathUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What is done with a path. path: a name and its members, joined by `.`: `msg.pose.position.x`, `this.last_.level`;
    `[]` for an element; the result of a call is `name()`, of whatever function of that name. line: of the name.

    | how | what is done | to | place, count | type |
    |---|---|---|---|---|
    | read | its value goes into an operator, a test or a log | which | | |
    | test | only whether it is there is asked: a null pointer, an end; or for its class | the function | | |
    | size | only how many elements it has is asked | | | |
    | write | it is assigned | the operator | | |
    | change | a method changes what it holds | the method | | |
    | kept | a variable, or an element of one, becomes it | the path of that one | count 1: it is `given` to make it too
      | the type declared for it; `?` for none, `lambda@line:column` of the lambda that captures or takes it |
    | added | it is an argument of a method that adds to a container, if it is one | callee | as for `given` | |
    | given | it is an argument | the callee | which of how many; -1 by a keyword, named in `type` | of what is made |
    | method | a method is called on it | the method | | |
    | returned | the function gives it back | | | |
    | use | anything else | what, in a word or two | | |
    """

    path: str
    how: str
    line: int
    to: str = ""
    place: int = 0
    count: int = 0
    type: str = ""


class FieldFunction(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A function's uses. name: of a lambda `lambda@line:column`, of others the last part of it. line, end: as
    FlowFunction has them; 0 for what stands outside of functions."""

    name: str
    line: int
    end: int
    uses: tuple[PathUse, ...] = ()


class FieldFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """language: `cpp` or `python`. unread: spans of lines (first, last) that did not parse. macros: the words in front
    of `.` and `->` in bodies of C++ macros, which read members of variables that their users have."""

    language: str
    functions: tuple[FieldFunction, ...] = ()
    unread: tuple[tuple[int, int], ...] = ()
    macros: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()
