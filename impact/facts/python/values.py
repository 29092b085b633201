"""What expressions of a Python source are known to be, without running it: text, or a place in a package.

Module-level and local names bound to one such value count; anything else is unknown.
"""

import ast
import re
from collections.abc import Iterator
from typing import Any

from ....edges.dispatch import collect_node_methods
from ..condition import Condition
from .constants import Constants, PackagePath, join_path, put_together

# Functions and launch substitutions whose first argument is a package's name.
PACKAGE_CALLS = frozenset((
    "get_package_share_directory", "get_package_share_path", "get_package_prefix", "get_pkg_dir", "load_manifest",
    "FindPackage", "FindPackagePrefix", "FindPackageShare",
))  # fmt: skip
JOINS = frozenset(("join", "joinpath", "PathJoinSubstitution"))
# Wrappers through which the first argument's value passes unchanged, as far as naming a file goes.
WRAPPERS = frozenset((
    "abspath", "normpath", "realpath", "expanduser", "str", "Path", "PurePath", "PythonLaunchDescriptionSource",
    "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource", "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource", "TextSubstitution", "ParameterFile", "as_posix", "resolve",
))  # fmt: skip
PACKAGE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_\-]*")
VALUED = frozenset((ast.Constant, ast.Name, ast.BinOp, ast.JoinedStr, ast.List, ast.Tuple, ast.Call))


class PythonScope:
    """Names of a module, class or function: imported, otherwise bound, and bound to a known value."""

    __slots__ = (
        "binder", "bound", "chain", "imports", "is_class", "lists", "machine", "objects", "parameters", "parent",
        "values",
    )  # fmt: skip

    def __init__(self, parent: "PythonScope | None", is_class: bool) -> None:
        # A class body is no scope for the functions in it.
        while parent is not None and parent.is_class and not is_class:
            parent = parent.parent
        self.parent = parent
        self.is_class = is_class
        self.imports: dict[str, list[tuple[str, tuple[Condition, ...]]]] = {}
        self.bound: set[str] = set()
        self.values: dict[str, object] = {}
        # Lists that names are bound to, as they are written.
        self.lists: dict[str, ast.List] = {}
        # Names bound once, to what reads a variable of the environment that ROS sets, with the source of that.
        self.machine: dict[str, str] = {}
        # Types of what variables hold, see uses.py.
        self.objects: dict[str, str] = {}
        self.parameters: list[str] = []
        # Where `:=` binds: of a comprehension the scope around it.
        self.binder = self
        # From the innermost scope on.
        self.chain: tuple[PythonScope, ...] = (self, *(parent.chain if parent is not None else ()))

    def knows(self, name: str) -> bool:
        """Whether the scope, or one around it, has bound a name so far."""
        return any(name in scope.bound or name in scope.imports for scope in self.chain)


class PythonValues(Constants):
    """Evaluates expressions within the scope being read. Launch arguments count by their declared default."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text
        self.has_rospkg = "rospkg" in text
        self.scope = PythonScope(None, False)
        self.launch_defaults: dict[str, str] = {}

    def find_imported(self, name: str, scope: PythonScope | None = None) -> list[tuple[str, tuple[Condition, ...]]]:
        """What a name stands for by the imports in view; empty when it is bound otherwise."""
        for looking in (scope or self.scope).chain:
            if name in looking.imports:
                return looking.imports[name]
            if name in looking.bound:
                return []
        return []

    def find_text(self, node) -> str | PackagePath | None:
        """The text or the place in a package that an expression is known to be. A list is one text, as substitutions
        of a launch file are."""
        value = self.find_value(node) if node.__class__ in VALUED else None
        if isinstance(value, list):
            value = put_together(_flatten_list(value))
        return str(value) if isinstance(value, str) else value if isinstance(value, PackagePath) else None

    def find_unpacked(self, name: str, node: ast.expr) -> dict[str, Any] | None:
        """The mapping that a name is bound to, where all that is done with the name in the file is to unpack it."""
        made = node.__class__ is ast.Dict or (isinstance(node, ast.Call) and self.find_callee(node.func) == "dict")
        if not made or f"**{name}" not in self.text:
            return None
        if re.search(rf"(?<!\*\*)\b{name}\b(?!\s*=\s*(?:\{{|dict\())", self.text):
            return None
        value = self.find_value(node)
        return value if isinstance(value, dict) else None

    def evaluate_Name(self, node: ast.Name) -> Any:
        for scope in self.scope.chain:
            if node.id in scope.values or node.id in scope.bound:
                return scope.values.get(node.id)
        return None

    def evaluate_List(self, node: ast.List | ast.Tuple | ast.Set) -> Any:
        return super().evaluate_List(node) if len(node.elts) <= 20 else None  # a longer one is data

    evaluate_Tuple = evaluate_List

    def evaluate_IfExp(self, node: ast.IfExp) -> None:
        return None

    def find_result(self, call: ast.Call) -> Any:
        function, receiver = self.find_callee(call.func), getattr(call.func, "value", None)
        asked = self.find_callee(receiver.func) if function == "find" and isinstance(receiver, ast.Call) else function
        if asked in PACKAGE_CALLS or (function == "get_path" and self.has_rospkg):
            package = self.find_package_argument(call)
            return None if package is None else PackagePath(package[0], "", package[1])
        if function in JOINS:
            arguments = call.args
            if len(arguments) == 1 and isinstance(arguments[0], (ast.List, ast.Tuple)):
                arguments = arguments[0].elts
            if function == "joinpath" and receiver is not None:
                arguments = [receiver, *arguments]
            return join_path(map(self.find_text, arguments), call.lineno)
        if function == "dict" and receiver is None and not call.args:
            return self.find_keywords(call)
        if function in ("as_posix", "resolve") and receiver is not None:
            return self.find_text(receiver)
        if function in WRAPPERS:
            inner = call.args or [keyword.value for keyword in call.keywords if keyword.arg in ("text", "param_file")]
            return self.find_text(inner[0]) if inner else None
        return None

    def find_callee(self, node) -> str:
        """The last name of what is called, import aliases resolved."""
        if node.__class__ is ast.Attribute:
            return node.attr
        if node.__class__ is not ast.Name:
            return ""
        imported = self.find_imported(node.id)
        return imported[0][0].rpartition(".")[2] if imported else node.id

    def find_package_argument(self, node: ast.Call) -> tuple[str, bool] | None:
        """The package a call names, and whether that rests on a launch argument's default."""
        named = [keyword.value for keyword in node.keywords if keyword.arg in ("package", "package_name")]
        given = named[-1:] or node.args
        return self.find_package_name(given[0]) if given else None

    def find_package_name(self, argument) -> tuple[str, bool] | None:
        value = self.find_text(argument)
        if isinstance(value, str) and PACKAGE_NAME.fullmatch(value):
            return value, False
        if (
            isinstance(argument, ast.Call)
            and self.find_callee(argument.func) == "LaunchConfiguration"
            and argument.args
        ):
            name = self.find_text(argument.args[0])
            default = self.launch_defaults.get(name) if isinstance(name, str) else None
            if default and PACKAGE_NAME.fullmatch(default):
                return default, True
        return None


PythonValues.evaluators = collect_node_methods(PythonValues, "evaluate_")


def _flatten_list(value: Any) -> Iterator[Any]:
    """The items of a list, of those in it too; what is none as the only one."""
    for item in value if isinstance(value, list) else (value,):
        yield from _flatten_list(item) if isinstance(item, list) else (item,)
