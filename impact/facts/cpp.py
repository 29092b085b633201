"""C and C++ sources to facts: includes with their preprocessor conditions, and the names that are used."""

import msgspec

from .condition import Condition
from .place import Problem


class Include(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An #include. path as written between the delimiters; angled True for <...>."""

    path: str
    angled: bool
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class Name(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use of a name outside comments, strings and #include lines, per distinct set of conditions.

    text: a qualified name as written without spaces (`std::min`, `cv::imread`, `tf2_ros::Buffer`), or a bare word.
    """

    text: str
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class CppFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """includes in order; qualified: distinct qualified names; words: distinct bare identifiers (not keywords) with at
    least four characters, space-joined and sorted (positions are found again in the bytes when a finding needs them);
    defined: macros and include guards the file defines; using: namespaces named by `using namespace` and `using a::b`.
    """

    includes: tuple[Include, ...]
    qualified: tuple[Name, ...]
    words: str
    defined: tuple[str, ...] = ()
    using: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()
