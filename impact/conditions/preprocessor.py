"""#if of the C and C++ preprocessor, evaluated as far as a machine's versions are known.

Sources: the C++ standard, [cpp.cond]; version macros from the headers that define them (ros/common.h, rclcpp/version.h,
opencv2/core/version.hpp, pcl/pcl_config.h, boost/version.hpp, Eigen/src/Core/util/Macros.h, QtCore/qtversionchecks.h,
OgrePrerequisites.h).
"""

import operator
import re
from functools import lru_cache

from .environment import COMPARISONS, PARTS, Environment, compare_version, find_version, parse_version_numbers
from .logic import combine_and, combine_or, negate

_CPP_TOKEN = re.compile(
    r"\s*(?:(?P<include>__has_include(?:_next)?\s*\(\s*(?:<[^>\n]*>|\"[^\"\n]*\")\s*\))"
    r"|(?P<number>0[xX][0-9a-fA-F']+|0[bB][01']+|[0-9][0-9']*)[uUlLzZ]*"
    r"|(?P<name>[^\W\d]\w*)|(?P<char>'(?:[^'\\]|\\.)')|(?P<operator><<|>>|<=|>=|==|!=|&&|\|\||[-+*/%<>!~&|^?:(),]))"
)
_WORD_OPERATORS = {"and": "&&", "or": "||", "not": "!", "bitand": "&", "bitor": "|", "xor": "^", "not_eq": "!="}
_PRECEDENCE = {
    sign: strength
    for strength, signs in enumerate(("||", "&&", "|", "^", "&", "== !=", "< > <= >=", "<< >>", "+ -", "* / %"), 1)
    for sign in signs.split()
}
_PRESENT = frozenset((
    "__cplusplus", "__linux__", "__linux", "linux", "__unix__", "__unix", "unix", "__gnu_linux__", "__GNUC__",
    "__has_include", "Q_OS_LINUX", "Q_OS_UNIX", "__ELF__", "__STDC__",
))  # fmt: skip
_ABSENT = frozenset((
    "_WIN32", "WIN32", "__WIN32__", "_WIN64", "WIN64", "_MSC_VER", "__APPLE__", "__MACH__", "__MINGW32__",
    "__MINGW64__", "__CYGWIN__", "__FreeBSD__", "__OpenBSD__", "__NetBSD__", "__sun", "__ANDROID__", "__EMSCRIPTEN__",
    "__BORLANDC__", "Q_OS_WIN", "Q_OS_WIN32", "Q_OS_MAC", "Q_OS_MACOS", "Q_MOC_RUN", "SWIG", "DOXYGEN",
    "__INTELLISENSE__", "DOXYGEN_SHOULD_SKIP_THIS", "__VXWORKS__", "__QNX__", "ARDUINO",
))  # fmt: skip
_PART = re.compile(
    r"(?:__)?(\w+?)_(?:VERSION_(MAJOR|MINOR|PATCH|REVISION|SUBMINOR)|(MAJOR|MINOR|PATCH|SUBMINOR)_VERSION)"
)
# Macros that are one number of a version each. Eigen 3.4.0 is world 3, major 4, minor 0.
_NUMBERS = {
    name: (library, place)
    for library, names in (
        ("gcc", ("__GNUC__", "__GNUC_MINOR__", "__GNUC_PATCHLEVEL__")),
        ("eigen", ("EIGEN_WORLD_VERSION", "EIGEN_MAJOR_VERSION", "EIGEN_MINOR_VERSION")),
    )
    for place, name in enumerate(names)
}
# X_VERSION as one number: how much major, minor and patch weigh.
_WEIGHTS = {
    **dict.fromkeys(("BOOST_VERSION", "PCL_VERSION"), (100000, 100, 1)),
    **dict.fromkeys(("FMT_VERSION", "SPDLOG_VERSION", "ZMQ_VERSION"), (10000, 100, 1)),
    **dict.fromkeys(("QT_VERSION", "OGRE_VERSION", "MOVEIT_FCL_VERSION"), (65536, 256, 1)),
    **dict.fromkeys((f"LIBAV{part}_VERSION_INT" for part in ("CODEC", "FORMAT", "UTIL")), (65536, 256, 1)),
    "OMPL_VERSION_VALUE": (1000000, 1000, 1),
    "PY_VERSION_HEX": (1 << 24, 1 << 16, 1 << 8),
}
# Macros that make such a number from three.
_MAKERS = {
    **dict.fromkeys(("QT_VERSION_CHECK", "OGRE_VERSION_CHECK", "FCL_VERSION_CHECK", "AV_VERSION_INT"), (65536, 256, 1)),
    "PCL_VERSION_CALC": (100000, 100, 1),
    "ZMQ_MAKE_VERSION": (10000, 100, 1),
}
_AT_LEAST = re.compile(r"(\w+?)_(?:VERSION_(?:GTE|GE|AT_LEAST|MINIMUM)|MIN_VERSION)")
_LESS_THAN = re.compile(r"(\w+?)_VERSION_(?:LT|LESS)")


@lru_cache(4096)
def _split_tokens(text: str) -> tuple[tuple[str, str], ...]:
    """(kind, text) of every token, an end behind them; none of a text that is no expression."""
    tokens: list[tuple[str, str]] = []
    position, text = 0, text.strip()
    while position < len(text):
        match = _CPP_TOKEN.match(text, position)
        if match is None:
            return ()
        kind = match.lastgroup or ""
        value = match.group(kind)
        if kind == "name" and value in _WORD_OPERATORS:
            kind, value = "operator", _WORD_OPERATORS[value]
        tokens.append((kind, value))
        position = match.end()
    return (*tokens, ("end", ""))


class _Cpp:
    """A recursive descent over the tokens of one #if to its value on a machine: a number, or None where it cannot be
    told. Raises ValueError or LookupError where the tokens are no expression."""

    def __init__(self, text: str, environment: Environment) -> None:
        self.tokens = _split_tokens(text)
        self.environment = environment
        self.at = 0

    def take(self) -> tuple[str, str]:
        token = self.tokens[self.at]
        self.at += 1
        return token

    def takes(self, value: str) -> bool:
        if self.tokens[self.at] == ("operator", value):
            self.at += 1
            return True
        return False

    def expect(self, value: str) -> None:
        if not self.takes(value):
            raise ValueError(f"`{value}` expected")

    def evaluate_tokens(self) -> int | None:
        value = self.evaluate_ternary()
        if self.tokens[self.at][0] != "end":
            raise ValueError("more than an expression")
        return value

    def evaluate_ternary(self) -> int | None:
        value = self.evaluate_binary(1)
        if not self.takes("?"):
            return value
        test, yes = _convert_to_bool(value), self.evaluate_ternary()
        self.expect(":")
        no = self.evaluate_ternary()
        return (yes if yes == no else None) if test is None else yes if test else no

    def evaluate_binary(self, least: int) -> int | None:
        left = self.evaluate_unary()
        while True:
            kind, value = self.tokens[self.at]
            strength = _PRECEDENCE.get(value, 0) if kind == "operator" else 0
            if strength < least:
                return left
            self.at += 1
            left = _apply_operator(value, left, self.evaluate_binary(strength + 1))

    def evaluate_unary(self) -> int | None:
        kind, value = self.take()
        if kind == "operator" and value in ("!", "-", "+", "~"):
            operand = self.evaluate_unary()
            if value == "!":
                return negate(_convert_to_bool(operand))
            return None if operand is None else -operand if value == "-" else ~operand if value == "~" else operand
        if kind == "operator" and value == "(":
            inside = self.evaluate_ternary()
            self.expect(")")
            return inside
        if kind == "number":
            digits = value.replace("'", "")
            octal = len(digits) > 1 and digits.isdigit() and digits[0] == "0"
            if len(digits) > 20:
                raise ValueError("number too long")
            return int(digits, 8 if octal else 0)
        if kind == "include":
            return self.environment.headers(re.sub(r"^[^<\"]*[<\"]|[>\"]\s*\)$", "", value))
        if kind != "name":
            raise ValueError("operand expected")
        if value == "defined":
            opened = self.takes("(")
            kind, value = self.take()
            if kind != "name":
                raise ValueError("name expected")
            if opened:
                self.expect(")")
            return _is_defined(value, self.environment)
        if self.takes("("):
            return _evaluate_macro_call(value, self.evaluate_arguments(), self.environment)
        return _evaluate_macro(value, self.environment)

    def evaluate_arguments(self) -> list[int | str | None]:
        """Arguments of a macro: expressions, or one operator as PCL_VERSION_COMPARE takes it."""
        arguments: list[int | str | None] = []
        while not self.takes(")"):
            if self.tokens[self.at][1] in COMPARISONS and self.tokens[self.at + 1] == ("operator", ","):
                arguments.append(self.take()[1])
            else:
                arguments.append(self.evaluate_ternary())
            if not self.takes(",") and self.tokens[self.at] != ("operator", ")"):
                raise ValueError("`,` expected")
        return arguments


def _evaluate(text: str, environment: Environment) -> int | None:
    try:
        return _Cpp(text, environment).evaluate_tokens()
    except (ValueError, LookupError, RecursionError):
        return None


def evaluate(text: str, environment: Environment) -> bool | None:
    return _convert_to_bool(_evaluate(text, environment))


def evaluate_number(text: str) -> int | None:
    """The value of an expression of numbers alone; None for what is none, or compares them."""
    value = _evaluate(text, Environment())
    return None if isinstance(value, bool) else value


def _convert_to_bool(value: int | None) -> bool | None:
    return None if value is None else value != 0


def _apply_operator(kind: str, left: int | None, right: int | None) -> int | None:
    """The value of a binary operator."""
    if kind == "&&":
        return combine_and(_convert_to_bool(left), _convert_to_bool(right))
    if kind == "||":
        return combine_or(_convert_to_bool(left), _convert_to_bool(right))
    if left is None or right is None:
        return None
    return COMPARISONS[kind](left, right) if kind in COMPARISONS else _compute(kind, left, right)


def _compute(kind: str, left: int, right: int) -> int | None:
    if kind in ("<<", ">>"):
        if not 0 <= right < 64:
            return None
        value = left << right if kind == "<<" else left >> right
    elif kind in ("/", "%"):
        if right == 0:
            return None
        quotient = abs(left) // abs(right) * (1 if (left < 0) == (right < 0) else -1)
        value = quotient if kind == "/" else left - quotient * right
    else:
        operations = {"+": operator.add, "-": operator.sub, "*": operator.mul, "|": operator.or_}
        operations |= {"&": operator.and_, "^": operator.xor}
        value = operations[kind](left, right)
    return value if abs(value) < 1 << 64 else None


def _is_defined(name: str, environment: Environment) -> bool | None:
    if name in _PRESENT:
        return True
    if name in _ABSENT:
        return False
    if name == "CV_VERSION_EPOCH":
        # OpenCV 2 alone has it.
        order = compare_version(find_version("opencv", environment), (3,))
        return None if order is None else order < 0
    return None


def _evaluate_macro(name: str, environment: Environment) -> int | None:
    """The number a macro stands for; 0 for one that is surely not defined."""
    if name in _ABSENT or name == "false":
        return 0
    if name == "true":
        return 1
    if name in _PRESENT and name not in _NUMBERS:
        return None if name in ("__cplusplus", "__has_include") else 1
    weights = _WEIGHTS.get(name)
    if weights is not None:
        prefix = "py" if name == "PY_VERSION_HEX" else name.partition("_VERSION")[0]
        known = parse_version_numbers(find_version(prefix, environment) or "")
        if len(known) < 2:
            return None
        return sum(weight * part for weight, part in zip(weights, (*known, 0, 0), strict=False))
    if name in _NUMBERS:
        library, index = _NUMBERS[name]
    elif (part := _PART.fullmatch(name)) is not None:
        library, index = part[1], PARTS[part[2] or part[3]]
    else:
        return None
    known = parse_version_numbers(find_version(library, environment) or "")
    return known[index] if index < len(known) else None


def _evaluate_macro_call(name: str, arguments: list[int | str | None], environment: Environment) -> int | None:
    wanted = tuple(argument for argument in arguments if isinstance(argument, int))
    if not wanted or None in arguments:
        return None
    if name in _MAKERS:
        return sum(weight * part for weight, part in zip(_MAKERS[name], (*wanted, 0, 0), strict=False))
    if name == "PCL_VERSION_COMPARE" and isinstance(arguments[0], str):
        order = compare_version(find_version("pcl", environment), wanted)
        return None if order is None else COMPARISONS[arguments[0]](order, 0)
    for pattern, compare in ((_AT_LEAST, operator.ge), (_LESS_THAN, operator.lt)):
        match = pattern.fullmatch(name)
        if match:
            order = compare_version(find_version(match.group(1), environment), wanted)
            return None if order is None else compare(order, 0)
    return None
