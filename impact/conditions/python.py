"""Tests in Python sources about the interpreter and the machine: `sys.version_info`, PY3, ROS_DISTRO and the like."""

import ast
import warnings
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from ..facts.python.text import COMPARISONS, format_dotted
from .environment import Environment
from .logic import combine_and, combine_or, negate

_UNKNOWN = object()
_ON_LINUX = {"sys.platform": "linux", "platform": "linux", "os.name": "posix"}


class _VersionInfo(tuple):
    """sys.version_info; its patch release is not known."""


@lru_cache(2048)
def parse_expression(text: str) -> ast.expr | None:
    """The expression that a text is, None for what is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return None


def evaluate(text: str, environment: Environment) -> bool | None:
    if text == "TYPE_CHECKING":
        return False
    node = None if text == "try" else parse_expression(text)
    return None if node is None else evaluate_truth(node, environment)


def evaluate_truth(node: ast.expr, environment: Environment) -> bool | None:
    """Whether an expression is true on a machine, None where that cannot be known."""
    if isinstance(node, ast.BoolOp):
        join = combine_and if isinstance(node.op, ast.And) else combine_or
        value = evaluate_truth(node.values[0], environment)
        for other in node.values[1:]:
            value = join(value, evaluate_truth(other, environment))
        return value
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return negate(evaluate_truth(node.operand, environment))
    value = _evaluate(node, environment)
    return None if value is _UNKNOWN else bool(value)


def _evaluate(node: ast.expr, environment: Environment) -> Any:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Tuple | ast.List | ast.Set):
        values = tuple(_evaluate(item, environment) for item in node.elts)
        return _UNKNOWN if any(value is _UNKNOWN for value in values) else values
    if isinstance(node, ast.Compare):
        return _evaluate_comparison(node, environment)
    if isinstance(node, ast.Name | ast.Attribute):
        return _evaluate_name(format_dotted(node), environment)
    if isinstance(node, ast.Subscript):
        return _evaluate_subscript(node, environment)
    if isinstance(node, ast.Call):
        return _evaluate_call(node, environment)
    if isinstance(node, ast.BoolOp | ast.UnaryOp):
        known = not isinstance(node, ast.UnaryOp) or isinstance(node.op, ast.Not)
        value = evaluate_truth(node, environment) if known else None
        return _UNKNOWN if value is None else value
    return _UNKNOWN


def _evaluate_name(name: str, environment: Environment) -> Any:
    if name.endswith("TYPE_CHECKING"):
        return False
    if name in _ON_LINUX:
        return _ON_LINUX[name]
    if name in ("ROS_DISTRO", "ROS_VERSION"):
        return _evaluate_variable(name, environment)
    if environment.python is None:
        return _UNKNOWN
    major, minor = environment.python
    last = name.rpartition(".")[2]
    if name in ("sys.version_info", "version_info"):
        return _VersionInfo((major, minor))
    if name.endswith("version_info.major"):
        return major
    if name.endswith("version_info.minor"):
        return minor
    if last in ("PY2", "IS_PY2", "PYTHON2", "IS_PYTHON2", "python2", "is_python2"):
        return major == 2
    if last in ("PY3", "IS_PY3", "PYTHON3", "IS_PYTHON3", "python3", "is_python3"):
        return major == 3
    if name in ("sys.version", "platform.python_version"):
        return f"{major}.{minor}."
    if name == "sys.hexversion":
        # The patch release is not known; comparisons are with whole minor versions as a rule.
        return major << 24 | minor << 16 | 1 << 8
    return _UNKNOWN


def _evaluate_subscript(node: ast.Subscript, environment: Environment) -> Any:
    key = node.slice
    name = format_dotted(node.value)
    if name.endswith("environ") and isinstance(key, ast.Constant):
        return _evaluate_variable(key.value, environment)
    value = _evaluate(node.value, environment)
    if value is _UNKNOWN:
        return _UNKNOWN
    if isinstance(key, ast.Slice):
        stop = key.upper.value if isinstance(key.upper, ast.Constant) else None
        if key.lower is not None or key.step is not None or not isinstance(stop, int) or not 0 <= stop <= 3:
            return _UNKNOWN
        if isinstance(value, _VersionInfo):
            return tuple(value[:stop]) if stop <= 2 else _UNKNOWN
        return value[:stop]
    index = key.value if isinstance(key, ast.Constant) else None
    return value[index] if isinstance(index, int) and 0 <= index < len(value) else _UNKNOWN


def _evaluate_variable(name: object, environment: Environment) -> Any:
    if name == "ROS_DISTRO":
        return environment.ros_distro or _UNKNOWN
    if name == "ROS_VERSION":
        return environment.ros_version or _UNKNOWN
    if name == "ROS_PYTHON_VERSION" and environment.python:
        return str(environment.python[0])
    return _UNKNOWN


def _evaluate_call(node: ast.Call, environment: Environment) -> Any:
    name = format_dotted(node.func)
    arguments = [_evaluate(argument, environment) for argument in node.args]
    if name.endswith(("environ.get", "getenv")) and arguments:
        return _evaluate_variable(arguments[0], environment)
    if name == "platform.system":
        return "Linux"
    if name in ("platform.python_version", "platform.python_version_tuple") and environment.python:
        text = "{}.{}.".format(*environment.python)
        return text if name.endswith("version") else tuple(map(str, environment.python))
    if name in ("int", "float", "str", "bool") and len(arguments) == 1 and arguments[0] is not _UNKNOWN:
        return {"int": int, "float": float, "str": str, "bool": bool}[name](arguments[0])
    if isinstance(node.func, ast.Attribute) and node.func.attr in ("startswith", "lower") and len(arguments) < 2:
        value = _evaluate(node.func.value, environment)
        if isinstance(value, str) and node.func.attr == "lower":
            return value.lower()
        if isinstance(value, str) and isinstance(arguments[0], str):
            return value.startswith(arguments[0])
    return _UNKNOWN


def _evaluate_comparison(node: ast.Compare, environment: Environment) -> Any:
    result: bool | None = True
    left = _evaluate(node.left, environment)
    for kind, right_node in zip(node.ops, node.comparators, strict=True):
        right = _evaluate(right_node, environment)
        compare = COMPARISONS.get(type(kind))
        if left is _UNKNOWN or right is _UNKNOWN or compare is None:
            result = combine_and(result, None)
        elif isinstance(left, _VersionInfo) or isinstance(right, _VersionInfo):
            result = combine_and(result, _compare_version_info(left, right, compare))
        else:
            result = combine_and(result, bool(compare(left, right)))
        left = right
    return _UNKNOWN if result is None else result


def _compare_version_info(left: Any, right: Any, compare: Callable[[Any, Any], bool]) -> bool | None:
    """sys.version_info against a tuple: the real one has five parts, of which two are known."""
    other = right if isinstance(left, _VersionInfo) else left
    if not isinstance(other, tuple) or not all(isinstance(part, int) for part in other[:3]):
        return None
    known = left if isinstance(left, _VersionInfo) else right
    if len(other) > 2 and tuple(known) == other[:2]:
        return None
    full = (*known, 1, "final", 0)
    return bool(compare(full, other) if isinstance(left, _VersionInfo) else compare(other, full))
