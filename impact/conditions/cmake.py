"""CMake's if(): its grammar, and its value as far as a machine is known. Source: cmake-commands(7)."""

import operator
import re
from collections.abc import Callable, Collection, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from .environment import PARTS, Environment, compare_version, find_version, parse_version_numbers
from .logic import combine_and, combine_or, negate

_CMAKE_TOKEN = re.compile(r'\s*(?:"((?:[^"\\]|\\.)*)"|([()])|((?:[^\s()"\\]|\\.)+))', re.DOTALL)
# Environment variables that a shell, a build tool or the setup files of ROS set; any other is unset where nobody says
# otherwise. Source: environ(7), cmake-env-variables(7), REP 149 and the setup files of ament and colcon.
_USUALLY_SET = re.compile(
    r"(?i)(?:HOME|PATH|USER|LOGNAME|PWD|OLDPWD|SHELL|TERM|LANG|LC_\w+|TMPDIR|HOSTNAME|DISPLAY|EDITOR|VIRTUAL_ENV|"
    r"CC|CXX|FC|CPP|AR|LD|CFLAGS|CXXFLAGS|CPPFLAGS|LDFLAGS|DESTDIR|VERBOSE|PYTHONPATH|LD_LIBRARY_PATH|"
    r"LIBRARY_PATH|CPATH|PKG_CONFIG_PATH|CI|(?:CMAKE|CTEST|ROS|RMW|AMENT|COLCON|CATKIN|RCUTILS|CCACHE|DEB|DPKG)_\w+|"
    r"ProgramFiles\S*|\w*_PREFIX_PATH|\w*(?:VERBOSE|JOBS))\Z"
)
_DISTRO_FOLDER = re.compile(r"/opt/ros/([a-z]+)(/.*)?\Z")
_REFERENCE = re.compile(r"\$(ENV)?\{([^{}$]*)\}")
NUMBER = re.compile(r"\s*[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?\s*\Z")
_MAX_DEPTH = 60
_TRUE = frozenset(("1", "ON", "YES", "TRUE", "Y"))
_FALSE = frozenset(("0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND", ""))
_UNARY = frozenset((
    "EXISTS", "IS_DIRECTORY", "IS_SYMLINK", "IS_ABSOLUTE", "COMMAND", "DEFINED", "TARGET", "POLICY", "TEST",
    "IS_READABLE", "IS_WRITABLE", "IS_EXECUTABLE",
))  # fmt: skip
COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "EQUAL": operator.eq,
    "LESS": operator.lt,
    "GREATER": operator.gt,
    "LESS_EQUAL": operator.le,
    "GREATER_EQUAL": operator.ge,
}
_BINARY = frozenset(f"{prefix}{name}" for prefix in ("", "STR", "VERSION_") for name in COMPARISONS)
_BINARY |= {"MATCHES", "IN_LIST", "IS_NEWER_THAN", "PATH_EQUAL"}
_ROS1_ONLY = frozenset(("catkin", "roscpp", "rospy", "message_generation", "genmsg", "nodelet", "roslaunch", "rosunit"))
_ROS2_ONLY = frozenset(("ament_cmake", "ament_cmake_auto", "ament_cmake_ros", "ament", "rclcpp", "rclpy"))
_ROS2_ONLY |= {"rosidl_default_generators", "rclcpp_components", "ament_lint_auto", "launch_testing_ament_cmake"}
_SYSTEM = {
    **dict.fromkeys(("UNIX", "LINUX", "CMAKE_HOST_UNIX", "CMAKE_COMPILER_IS_GNUCXX", "CMAKE_COMPILER_IS_GNUCC"), "1"),
    **dict.fromkeys(("WIN32", "APPLE", "MSVC", "MINGW", "CYGWIN", "MSYS", "ANDROID", "IOS", "CMAKE_HOST_WIN32"), ""),
    **dict.fromkeys(("CMAKE_SYSTEM_NAME", "CMAKE_HOST_SYSTEM_NAME"), "Linux"),
    **dict.fromkeys(("CMAKE_CXX_COMPILER_ID", "CMAKE_C_COMPILER_ID"), "GNU"),
}


class Token(NamedTuple):
    """One argument of if(). sure: whether all that it refers to is known. written: it stands in the file as it is, no
    reference in it."""

    text: str
    quoted: bool
    sure: bool = True
    written: bool = True


def parse_constant(text: str) -> bool | None:
    """The truth of a constant, None when the text is no constant."""
    upper = text.upper()
    if upper in _TRUE:
        return True
    if upper in _FALSE or upper.endswith("-NOTFOUND"):
        return False
    return float(text) != 0 if NUMBER.match(text) else None


class CMakeTest:
    """The grammar of if() after cmake-commands(7): parentheses, unary tests, binary tests, NOT, then AND and OR from
    left to right. Three-valued: True, False, or None when it cannot be known. Subclasses say what operands mean."""

    def __init__(self, tokens: Sequence[Token]) -> None:
        self.tokens = tokens
        self.at = 0

    def evaluate_tokens(self) -> bool | None:
        """The value of all tokens, of which there is at least one; None where they are no test."""
        value = self.evaluate_and_or(0)
        return value if self.at == len(self.tokens) else None

    def peek_word(self, offset: int = 0) -> str:
        """The unquoted word ahead, which alone can be an operator."""
        index = self.at + offset
        return self.tokens[index].text if index < len(self.tokens) and not self.tokens[index].quoted else ""

    def evaluate_and_or(self, depth: int) -> bool | None:
        value = self.evaluate_not(depth)
        while self.peek_word() in ("AND", "OR"):
            join = combine_and if self.peek_word() == "AND" else combine_or
            self.at += 1
            value = join(value, self.evaluate_not(depth))
        return value

    def evaluate_not(self, depth: int) -> bool | None:
        negated = False
        while self.peek_word() == "NOT":
            self.at += 1
            negated = not negated
        value = self.evaluate_test(depth)
        return negate(value) if negated else value

    def evaluate_test(self, depth: int) -> bool | None:
        if self.at >= len(self.tokens):
            return None
        token, word = self.tokens[self.at], self.peek_word()
        self.at += 1
        if word == "(":
            value = self.evaluate_and_or(depth + 1) if depth < _MAX_DEPTH else None
            # what no parenthesis closes is no test
            self.at = self.at + 1 if self.peek_word() == ")" else len(self.tokens) + 1
            if self.peek_word() in _BINARY:
                # `(X) STREQUAL Y`: legal, and nobody's meaning.
                self.at += 2
                return None
            return value
        if word in _UNARY and self.at < len(self.tokens) and self.peek_word() not in _BINARY:
            self.at += 1
            return self.evaluate_unary(word, self.tokens[self.at - 1])
        if self.peek_word() in _BINARY and self.at + 1 < len(self.tokens):
            self.at += 2
            return self.evaluate_comparison(token, self.peek_word(-2), self.tokens[self.at - 1])
        return self.evaluate_argument(token)

    def evaluate_argument(self, token: Token) -> bool | None:
        """Whether one argument is true."""
        raise NotImplementedError

    def evaluate_unary(self, kind: str, operand: Token) -> bool | None:
        """The value of `EXISTS path` and its kin."""
        raise NotImplementedError

    def evaluate_comparison(self, left: Token, kind: str, right: Token) -> bool | None:
        """The value of a comparison."""
        raise NotImplementedError


@lru_cache(4096)
def _split_tokens(text: str) -> tuple[Token, ...]:
    """Every argument of a test; empty when the text is none."""
    tokens: list[Token] = []
    position, text = 0, text.strip()
    while position < len(text):
        match = _CMAKE_TOKEN.match(text, position)
        if match is None:
            return ()
        tokens.append(Token(match.group(match.lastindex or 0), match.lastindex == 1))
        position = match.end()
    return tuple(tokens)


class _OnMachine(CMakeTest):
    """A test on somebody's machine."""

    def __init__(self, text: str, environment: Environment, declared: Collection[str]) -> None:
        super().__init__(_split_tokens(text))
        self.environment = environment
        self.declared = declared

    def evaluate_argument(self, token: Token) -> bool | None:
        expanded = self.expand(token.text)
        if expanded is None:
            return None
        value = parse_constant(expanded)
        if value is not None or token.quoted:
            return value
        if expanded == "CATKIN_ENABLE_TESTING" and self.environment.ros_version == "2":
            return False  # catkin sets it
        if expanded in ("BUILD_TESTING", "CATKIN_ENABLE_TESTING"):
            return self.environment.testing
        if expanded.endswith("_FOUND"):
            return self.is_found(expanded.removesuffix("_FOUND"))
        held = self.resolve_variable(expanded)
        return None if held is None else held.upper() not in _FALSE

    def is_found(self, package: str) -> bool | None:
        """Packages that exist in one generation of ROS alone, what is declared and there, and what was taken out of ROS
        or renamed: what else is installed is not known."""
        if self.environment.ros_version and package in _ROS1_ONLY | _ROS2_ONLY:
            return (package in _ROS1_ONLY) == (self.environment.ros_version == "1")
        if package in self.declared:
            return True if self.environment.packages(package) else None
        return False if self.environment.gone("package", package) else None

    def evaluate_unary(self, kind: str, operand: Token) -> bool | None:
        argument = operand.text
        if kind == "DEFINED":
            environment = re.fullmatch(r"ENV\{(ROS_DISTRO|ROS_VERSION|ROS_PYTHON_VERSION)\}", argument)
            if environment or argument in ("CMAKE_VERSION", "PROJECT_NAME", "CMAKE_SYSTEM_NAME"):
                return True
            if argument.startswith("ENV{") and not _USUALLY_SET.match(argument[4:-1]):
                return False
        if kind == "COMMAND" and self.environment.gone("command", argument):
            return False
        if kind in ("EXISTS", "IS_DIRECTORY"):
            return self.exists(self.expand(argument) or "")
        return None

    def exists(self, path: str) -> bool | None:
        """Whether the folder of a distro is there: a machine has the one that it is built for. Source: REP 142, the
        setup files of binary packages."""
        folder = _DISTRO_FOLDER.match(path)
        if folder is None or not self.environment.ros_distro:
            return None
        if folder.group(1) != self.environment.ros_distro:
            return False
        return True if folder.group(2) in (None, "/", "/setup.sh", "/setup.bash") else None

    def expand(self, text: str) -> str | None:
        """References replaced; None when one is not known."""
        unknown = False

        def replace(match: re.Match[str]) -> str:
            nonlocal unknown
            value = self.resolve_variable(match.group(2))
            if value is None and match.group(1) and not _USUALLY_SET.match(match.group(2)):
                return ""
            unknown |= value is None
            return value or ""

        for _ in range(4):
            expanded = _REFERENCE.sub(replace, text)
            if unknown or expanded == text:
                break
            text = expanded
        return None if unknown or "${" in text or "$<" in text else text

    def resolve_variable(self, name: str) -> str | None:
        environment = self.environment
        if name in _SYSTEM:
            return _SYSTEM[name]
        if name in ("ROS_DISTRO", "ROS_VERSION"):
            return (environment.ros_distro if name == "ROS_DISTRO" else environment.ros_version) or None
        if name == "ROS_PYTHON_VERSION":
            return str(environment.python[0]) if environment.python else None
        if name.endswith("CODENAME"):
            return environment.codename or None
        match = re.fullmatch(
            r"(\w[\w.+-]*?)_(?:VERSION(?:_(STRING|MAJOR|MINOR|PATCH))?|(MAJOR|MINOR|PATCH)_VERSION)", name
        )
        if match is None:
            return None
        version = find_version(match.group(1), environment)
        part = match.group(2) or match.group(3)
        if version is None:
            return None
        numbers = parse_version_numbers(version)
        if part and part != "STRING":
            index = PARTS[part]
            return str(numbers[index]) if index < len(numbers) else None
        return ".".join(map(str, numbers)) or None

    def resolve_operand(self, token: Token, literal: bool) -> str | None:
        """The value compared: a variable's when unquoted and known, else the text, when it can be one."""
        expanded = self.expand(token.text)
        if expanded is None or token.quoted or _REFERENCE.fullmatch(token.text):
            return expanded
        value = self.resolve_variable(expanded)
        if value is not None:
            return value
        # A name that nothing here knows is a variable of the project, unless it looks like a value.
        return expanded if literal or not re.search(r"[A-Z_]", expanded) else None

    def evaluate_comparison(self, left: Token, kind: str, right: Token) -> bool | None:
        if kind in ("IS_NEWER_THAN", "PATH_EQUAL"):
            return None
        known = self.resolve_operand(left, False)
        if kind == "IN_LIST":
            # A list that is known stands for its name, see format_condition() of model.cmake.conditions.
            return known in right.text.split(";") if known is not None and right.text.endswith(";") else None
        wanted = self.resolve_operand(right, True)
        if known is None or wanted is None:
            return None
        if kind == "MATCHES":
            return re.search(wanted, known) is not None if len(wanted) < 200 else None
        if kind.startswith("VERSION_"):
            order = compare_version(known, parse_version_numbers(wanted)) if parse_version_numbers(wanted) else None
            return None if order is None else COMPARISONS[kind.removeprefix("VERSION_")](order, 0)
        if kind.startswith("STR"):
            return COMPARISONS[kind.removeprefix("STR")](known, wanted)
        if left.text.strip("${}") == "Boost_VERSION":
            # Before policy CMP0093 it was the number of the macro; compared with a number, it is meant so.
            numbers = (*parse_version_numbers(known), 0, 0)
            known = str(numbers[0] * 100000 + numbers[1] * 100 + numbers[2])
        return COMPARISONS[kind](float(known), float(wanted))


def evaluate(text: str, environment: Environment, declared: Collection[str] = ()) -> bool | None:
    """The value of a test; None where it cannot be known. declared: as in Condition. Raises ValueError where
    numbers are compared that are none."""
    return _OnMachine(text, environment, declared).evaluate_tokens() if _split_tokens(text) else None


_FOUND = re.compile(r"(?<![\w}.+-])([\w.+-]+)_FOUND\b")


def list_tested_packages(text: str) -> tuple[str, ...]:
    """The packages whose `X_FOUND` a test reads."""
    return tuple(dict.fromkeys(_FOUND.findall(text)))


def asks_only_for_packages(text: str) -> bool:
    """Whether a test is of nothing but what was found."""
    words = text.replace("(", " ").replace(")", " ").split()
    return bool(words) and all(word in ("NOT", "AND", "OR") or _FOUND.fullmatch(word) for word in words)


def lacks(text: str, environment: Environment) -> bool:
    """Whether a package that a test asks for is one that the machine does not have."""
    return any(environment.packages(name) is False for name in list_tested_packages(text))
