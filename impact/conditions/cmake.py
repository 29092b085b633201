"""CMake's if(), evaluated as far as a machine is known. Source: cmake-commands(7)."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Collection
from functools import lru_cache
from typing import Any

from .environment import PARTS, Environment, against, numbers_of, version_of
from .logic import both, either, negation

_CMAKE_TOKEN = re.compile(r'\s*(?:"((?:[^"\\]|\\.)*)"|([()])|((?:[^\s()"\\]|\\.)+))', re.DOTALL)
_REFERENCE = re.compile(r"\$(ENV)?\{([^{}$]*)\}")
_TRUE = frozenset(("1", "ON", "YES", "TRUE", "Y"))
_FALSE = frozenset(("0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND", ""))
_UNARY = frozenset(
    ("EXISTS", "IS_DIRECTORY", "IS_SYMLINK", "IS_ABSOLUTE", "COMMAND", "DEFINED", "TARGET", "POLICY", "TEST")
) | {"IS_READABLE", "IS_WRITABLE", "IS_EXECUTABLE"}
_CMAKE_COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "EQUAL": operator.eq,
    "LESS": operator.lt,
    "GREATER": operator.gt,
    "LESS_EQUAL": operator.le,
    "GREATER_EQUAL": operator.ge,
}
_BINARY = frozenset(f"{prefix}{name}" for prefix in ("", "STR", "VERSION_") for name in _CMAKE_COMPARISONS) | {
    "MATCHES",
    "IN_LIST",
    "IS_NEWER_THAN",
    "PATH_EQUAL",
}
_ROS1_ONLY = frozenset(("catkin", "roscpp", "rospy", "message_generation", "genmsg", "nodelet", "roslaunch", "rosunit"))
_ROS2_ONLY = frozenset(("ament_cmake", "ament_cmake_auto", "ament_cmake_ros", "ament", "rclcpp", "rclpy"))
_ROS2_ONLY |= {"rosidl_default_generators", "rclcpp_components", "ament_lint_auto", "launch_testing_ament_cmake"}
_SYSTEM = {
    **dict.fromkeys(("UNIX", "LINUX", "CMAKE_HOST_UNIX", "CMAKE_COMPILER_IS_GNUCXX", "CMAKE_COMPILER_IS_GNUCC"), "1"),
    **dict.fromkeys(("WIN32", "APPLE", "MSVC", "MINGW", "CYGWIN", "MSYS", "ANDROID", "IOS", "CMAKE_HOST_WIN32"), ""),
    **dict.fromkeys(("CMAKE_SYSTEM_NAME", "CMAKE_HOST_SYSTEM_NAME"), "Linux"),
    **dict.fromkeys(("CMAKE_CXX_COMPILER_ID", "CMAKE_C_COMPILER_ID"), "GNU"),
}


@lru_cache(4096)
def _cmake_tokens(text: str) -> tuple[tuple[str, bool], ...]:
    """(text, quoted) of every argument; empty when the text is none."""
    tokens: list[tuple[str, bool]] = []
    position, text = 0, text.strip()
    while position < len(text):
        match = _CMAKE_TOKEN.match(text, position)
        if match is None:
            return ()
        tokens.append((match.group(match.lastindex or 0), match.lastindex == 1))
        position = match.end()
    return tuple(tokens)


class _CMake:
    """if() after cmake-commands(7): parentheses, tests, NOT, then AND and OR from left to right."""

    def __init__(self, text: str, environment: Environment, declared: Collection[str]) -> None:
        self.tokens = _cmake_tokens(text)
        self.environment = environment
        self.declared = declared
        self.at = 0

    def word(self, offset: int = 0) -> str:
        """The unquoted word ahead, which alone can be an operator."""
        index = self.at + offset
        if index >= len(self.tokens) or self.tokens[index][1]:
            return ""
        return self.tokens[index][0]

    def whole(self) -> bool | None:
        if not self.tokens:
            return None
        value = self.disjunction()
        if self.at < len(self.tokens):
            raise ValueError("more than an expression")
        return value

    def disjunction(self) -> bool | None:
        value = self.negation()
        while self.word() in ("AND", "OR"):
            joined = self.word()
            self.at += 1
            right = self.negation()
            value = both(value, right) if joined == "AND" else either(value, right)
        return value

    def negation(self) -> bool | None:
        if self.word() == "NOT":
            self.at += 1
            return negation(self.negation())
        return self.test()

    def test(self) -> bool | None:
        if self.word() == "(":
            self.at += 1
            value = self.disjunction()
            if self.word() != ")":
                raise ValueError("`)` expected")
            self.at += 1
            if self.word() in _BINARY:
                # `(X) STREQUAL Y`: legal, and nobody's meaning.
                self.at += 2
                return None
            return value
        if self.at >= len(self.tokens):
            raise ValueError("operand expected")
        if self.word(1) in _BINARY and self.at + 2 < len(self.tokens):
            left, kind, right = self.tokens[self.at], self.word(1), self.tokens[self.at + 2]
            self.at += 3
            return self.comparison(left, kind, right)
        if self.word() in _UNARY and self.at + 1 < len(self.tokens):
            kind, (argument, _) = self.word(), self.tokens[self.at + 1]
            self.at += 2
            return self.presence(kind, argument)
        token = self.tokens[self.at]
        self.at += 1
        return self.truth(*token)

    def truth(self, text: str, quoted: bool) -> bool | None:
        expanded = self.expand(text)
        if expanded is None:
            return None
        upper = expanded.upper()
        if upper in _TRUE:
            return True
        if upper in _FALSE or upper.endswith("-NOTFOUND"):
            return False
        if re.fullmatch(r"[-+]?\d{1,15}(?:\.\d*)?", expanded):
            return float(expanded) != 0
        if quoted:
            return None
        if expanded in ("BUILD_TESTING", "CATKIN_ENABLE_TESTING"):
            return self.environment.testing
        if expanded.endswith("_FOUND"):
            return self.found(expanded.removesuffix("_FOUND"))
        value = self.variable(expanded)
        return None if value is None else value.upper() not in _FALSE

    def found(self, package: str) -> bool | None:
        """Packages that exist in one generation of ROS alone, and what is declared and there: what else is installed is
        not known."""
        if self.environment.ros_version and package in _ROS1_ONLY | _ROS2_ONLY:
            return (package in _ROS1_ONLY) == (self.environment.ros_version == "1")
        return True if package in self.declared and self.environment.packages(package) else None

    def presence(self, kind: str, argument: str) -> bool | None:
        if kind == "DEFINED":
            environment = re.fullmatch(r"ENV\{(ROS_DISTRO|ROS_VERSION|ROS_PYTHON_VERSION)\}", argument)
            if environment or argument in ("CMAKE_VERSION", "PROJECT_NAME", "CMAKE_SYSTEM_NAME"):
                return True
        return None

    def expand(self, text: str) -> str | None:
        """References replaced; None when one is not known."""
        unknown = False

        def replace(match: re.Match[str]) -> str:
            nonlocal unknown
            value = self.variable(match.group(2))
            unknown |= value is None
            return value or ""

        for _ in range(4):
            expanded = _REFERENCE.sub(replace, text)
            if unknown or expanded == text:
                break
            text = expanded
        return None if unknown or "${" in text or "$<" in text else text

    def variable(self, name: str) -> str | None:
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
        version = version_of(match.group(1), environment)
        part = match.group(2) or match.group(3)
        if version is None:
            return None
        numbers = numbers_of(version)
        if part and part != "STRING":
            index = PARTS[part]
            return str(numbers[index]) if index < len(numbers) else None
        return ".".join(map(str, numbers)) or None

    def operand(self, token: tuple[str, bool], literal: bool) -> str | None:
        """The value compared: a variable's when unquoted and known, else the text, when it can be one."""
        text, quoted = token
        if _REFERENCE.fullmatch(text):
            return self.expand(text)
        expanded = self.expand(text)
        if expanded is None or quoted:
            return expanded
        value = self.variable(expanded)
        if value is not None:
            return value
        # A name that nothing here knows is a variable of the project, unless it looks like a value.
        return expanded if literal or not re.search(r"[A-Z_]", expanded) else None

    def comparison(self, left: tuple[str, bool], kind: str, right: tuple[str, bool]) -> bool | None:
        if kind in ("IN_LIST", "IS_NEWER_THAN", "PATH_EQUAL"):
            return None
        known = self.operand(left, False)
        wanted = self.operand(right, True)
        if known is None or wanted is None:
            return None
        if kind == "MATCHES":
            return re.search(wanted, known) is not None if len(wanted) < 200 else None
        if kind.startswith("VERSION_"):
            order = against(known, numbers_of(wanted)) if numbers_of(wanted) else None
            return None if order is None else _CMAKE_COMPARISONS[kind.removeprefix("VERSION_")](order, 0)
        if kind.startswith("STR"):
            return _CMAKE_COMPARISONS[kind.removeprefix("STR")](known, wanted)
        if left[0].strip("${}") == "Boost_VERSION":
            # Before policy CMP0093 it was the number of the macro; compared with a number, it is meant so.
            numbers = (*numbers_of(known), 0, 0)
            known = str(numbers[0] * 100000 + numbers[1] * 100 + numbers[2])
        return _CMAKE_COMPARISONS[kind](float(known), float(wanted))


def evaluate(text: str, environment: Environment, declared: Collection[str] = ()) -> bool | None:
    """The value of a test; None where it cannot be told. declared: as in Condition. Raises ValueError for what is no
    test."""
    return _CMake(text, environment, declared).whole()


_FOUND = re.compile(r"(?<![\w}])(\w+)_FOUND\b")


def packages_asked(text: str) -> tuple[str, ...]:
    """The packages whose `X_FOUND` a test reads."""
    return tuple(dict.fromkeys(_FOUND.findall(text)))


def asks_only_for_packages(text: str) -> bool:
    """Whether a test is of nothing but what was found."""
    words = text.replace("(", " ").replace(")", " ").split()
    return bool(words) and all(word in ("NOT", "AND", "OR") or _FOUND.fullmatch(word) for word in words)


def lacks(text: str, environment: Environment) -> bool:
    """Whether a package that a test asks for is one that the machine does not have."""
    return any(environment.packages(name) is False for name in packages_asked(text))
