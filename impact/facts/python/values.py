"""What expressions of a Python source are known to be, without running it: text, or a place in a package.

Module-level and local names bound to one such value count; anything else is unknown.
"""

import ast
import re
from typing import NamedTuple

from ..condition import Condition

# Functions and launch substitutions whose first argument is a package's name.
PACKAGE_CALLS = frozenset(
    (
        "get_package_share_directory",
        "get_package_share_path",
        "get_package_prefix",
        "get_pkg_dir",
        "load_manifest",
        "FindPackage",
        "FindPackagePrefix",
        "FindPackageShare",
    )
)
JOINS = frozenset(("join", "joinpath", "PathJoinSubstitution"))
# Wrappers through which the first argument's value passes unchanged, as far as naming a file goes.
WRAPPERS = frozenset(
    (
        "abspath",
        "normpath",
        "realpath",
        "expanduser",
        "str",
        "Path",
        "PurePath",
        "PythonLaunchDescriptionSource",
        "AnyLaunchDescriptionSource",
        "FrontendLaunchDescriptionSource",
        "XMLLaunchDescriptionSource",
        "YAMLLaunchDescriptionSource",
        "TextSubstitution",
        "ParameterFile",
        "as_posix",
        "resolve",
    )
)
PACKAGE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_\-]*")
VALUED = frozenset((ast.Constant, ast.Name, ast.BinOp, ast.JoinedStr, ast.List, ast.Tuple, ast.Call))


class PackagePath(NamedTuple):
    """A value known to lie in the share folder of a package; path is empty for the folder itself."""

    package: str
    path: str
    assumed: bool = False


class Scope:
    """Names of a module, class or function: imported, otherwise bound, and bound to a known value."""

    __slots__ = ("bound", "imports", "is_class", "module", "objects", "parameters", "parent", "values")

    def __init__(self, parent: "Scope | None", is_class: bool) -> None:
        # A class body is no scope for the functions in it.
        while parent is not None and parent.is_class and not is_class:
            parent = parent.parent
        self.parent = parent
        self.is_class = is_class
        self.imports: dict[str, list[tuple[str, tuple[Condition, ...]]]] = {}
        self.bound: set[str] = set()
        self.values: dict[str, object] = {}
        # Types of what variables hold, see python_objects.py.
        self.objects: dict[str, str] = {}
        self.parameters: list[str] = []
        self.module: Scope = self if parent is None else parent.module


def _concatenated(parts) -> "str | PackagePath | None":
    """Texts and at most one package folder, put together. `/` between parts of a path is never doubled."""
    base: PackagePath | None = None
    text = ""
    for part in parts:
        if isinstance(part, PackagePath):
            if base is not None or text not in ("", "file://"):
                return None
            base, text = part, part.path
        elif text.endswith("/") and part.startswith("/"):
            text += part[1:]
        elif base is not None and not text and not part.startswith("/"):
            return None
        else:
            text += part
    return text if base is None else PackagePath(base.package, text.lstrip("/"), base.assumed)


class Values:
    """Evaluates expressions within the scope being read. Launch arguments count by their declared default."""

    def __init__(self, text: str) -> None:
        self.has_rospkg = "rospkg" in text
        self.scope = Scope(None, False)
        self.launch_defaults: dict[str, str] = {}

    def imported(self, name: str, scope: Scope | None = None) -> list[tuple[str, tuple[Condition, ...]]]:
        """What a name stands for by the imports in view; empty when it is bound otherwise."""
        looking: Scope | None = scope or self.scope
        while looking is not None:
            if name in looking.imports:
                return looking.imports[name]
            if name in looking.bound:
                return []
            looking = looking.parent
        return []

    def value(self, node, trace: list) -> "str | PackagePath | None":
        """What an expression is known to be: text or a place in a package. trace collects the nodes that told it."""
        kind = node.__class__
        if kind is ast.Constant:
            return node.value if node.value.__class__ is str else None
        trace.append(node)
        if kind is ast.Name:
            scope: Scope | None = self.scope
            while scope is not None:
                if node.id in scope.values:
                    return scope.values[node.id]  # type: ignore[return-value]
                if node.id in scope.bound:
                    return None
                scope = scope.parent
            return None
        if kind is ast.BinOp:
            joined = node.op.__class__ is ast.Div
            if not joined and node.op.__class__ is not ast.Add:
                return None
            left = self.value(node.left, trace)
            if left is None:
                return None
            right = self.value(node.right, trace)
            return None if right is None else _concatenated((left, "/", right) if joined else (left, right))
        if kind is ast.JoinedStr:
            parts = []
            for part in node.values:
                value = self.value(part.value if part.__class__ is ast.FormattedValue else part, trace)
                if value is None:
                    return None
                parts.append(value)
            return _concatenated(parts)
        if kind is ast.List or kind is ast.Tuple:
            # Substitutions of a launch file in a list are concatenated. Long lists are data.
            if len(node.elts) > 20:
                return None
            parts = []
            for part in node.elts:
                value = self.value(part, trace)
                if value is None:
                    return None
                parts.append(value)
            return _concatenated(parts)
        if kind is ast.Call:
            return self.value_of_call(node, trace)
        return None

    def value_of_call(self, node: ast.Call, trace: list) -> "str | PackagePath | None":
        function = self.callee(node.func)
        if function in PACKAGE_CALLS or (function == "get_path" and self.has_rospkg):
            package = self.package_argument(node, trace)
            return None if package is None else PackagePath(package[0], "", package[1])
        if function == "find" and isinstance(node.func, ast.Attribute):
            receiver = node.func.value
            if isinstance(receiver, ast.Call) and self.callee(receiver.func) in PACKAGE_CALLS:
                package = self.package_argument(node, trace)
                trace.append(receiver)
                return None if package is None else PackagePath(package[0], "", package[1])
            return None
        if function in JOINS:
            arguments = node.args
            if len(arguments) == 1 and isinstance(arguments[0], (ast.List, ast.Tuple)):
                trace.append(arguments[0])
                arguments = arguments[0].elts
            parts = []
            if function == "joinpath" and isinstance(node.func, ast.Attribute):
                arguments = [node.func.value, *arguments]
            for argument in arguments:
                value = self.value(argument, trace)
                if value is None:
                    return None
                parts += (value, "/")
            return _concatenated(parts[:-1])
        if function in WRAPPERS:
            if function in ("as_posix", "resolve") and isinstance(node.func, ast.Attribute):
                return self.value(node.func.value, trace)
            inner = node.args or [keyword.value for keyword in node.keywords if keyword.arg in ("text", "param_file")]
            return self.value(inner[0], trace) if inner else None
        return None

    def callee(self, node) -> str:
        """The last name of what is called, import aliases resolved."""
        if node.__class__ is ast.Attribute:
            return node.attr
        if node.__class__ is not ast.Name:
            return ""
        imported = self.imported(node.id)
        return imported[0][0].rpartition(".")[2] if imported else node.id

    def package_argument(self, node: ast.Call, trace: list) -> tuple[str, bool] | None:
        """The package a call names, and whether that rests on a launch argument's default."""
        argument = node.args[0] if node.args else None
        for keyword in node.keywords:
            if keyword.arg in ("package", "package_name"):
                argument = keyword.value
        if argument is None:
            return None
        return self.package_name(argument, trace)

    def package_name(self, argument, trace: list) -> tuple[str, bool] | None:
        value = self.value(argument, trace)
        if value.__class__ is str and PACKAGE_NAME.fullmatch(value):  # type: ignore[arg-type]
            return value, False  # type: ignore[return-value]
        if isinstance(argument, ast.Call) and self.callee(argument.func) == "LaunchConfiguration" and argument.args:
            name = self.value(argument.args[0], trace)
            default = self.launch_defaults.get(name) if isinstance(name, str) else None
            if default and PACKAGE_NAME.fullmatch(default):
                return default, True
        return None
