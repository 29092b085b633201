"""setup.py, setup.cfg and pyproject.toml to facts: what an ament_python or catkin package installs."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterable
from typing import Any

import msgspec

from ...edges.documents import DocumentError, load_toml
from .markup import decode
from .place import Problem
from .python import PythonFile


class SetupFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Installed things, read from literals (setup.py is parsed, never run).

    entry_points: (name, module, line) of console_scripts. data_files: (destination, pattern, line), where glob(...) and
    os.path.join(...) of literals become a pattern such as `launch/*.launch.py`. scripts, packages: as written, `*` when
    find_packages. requires: install_requires names. unresolved: what was not a literal, in one clause each.
    python: of a setup.py, its imports and syntax like those of any Python file (filled by kinds.extract).
    install_scripts: of a setup.cfg, where executables go (`$base/lib/package`, without which `ros2 run` misses them).
    """

    packages: tuple[str, ...] = ()
    package_dirs: dict[str, str] = {}
    entry_points: tuple[tuple[str, str, int], ...] = ()
    data_files: tuple[tuple[str, str, int], ...] = ()
    scripts: tuple[str, ...] = ()
    requires: tuple[str, ...] = ()
    unresolved: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()
    python: PythonFile | None = None
    install_scripts: str = ""


def extract(data: bytes, kind: str) -> SetupFile:
    """Facts of a file of the kind setup_py, setup_cfg or pyproject; never raises.

    A setup.py is parsed and its literals evaluated, never run: what only running it tells is named in `unresolved`.
    """
    try:
        return {"setup_py": _setup_py, "setup_cfg": _setup_cfg, "pyproject": _pyproject}[kind](data)
    except (RecursionError, MemoryError):
        return SetupFile(problems=(Problem(1, "nested too deeply to be read"),))


class _Text(str):
    """A string of the file, with the line it stands on."""

    line: int

    def __new__(cls, text: str, line: int) -> _Text:
        made = super().__new__(cls, text)
        made.line = line
        return made


class _Unresolved:
    """A value that only running the file would give; what: its source in a clause."""

    __slots__ = ("what",)

    def __init__(self, what: str):
        self.what = what


REQUIREMENT = re.compile(r"\s*([A-Za-z0-9][A-Za-z0-9._-]*)")
ENTRY_POINT = re.compile(r"\s*([^=\s][^=]*)=\s*([\w.]+)(?:\s*:[\w.]+)?(?:\s*\[.*\])?\s*\Z")
SETUP_CALLS = frozenset({"setup", "generate_distutils_setup"})
JOINS = frozenset({"os.path.join", "path.join", "join", "posixpath.join", "osp.join"})
GLOBS = frozenset({"glob", "glob.glob", "iglob", "glob.iglob"})
SAME = frozenset({"list", "tuple", "sorted", "str", "os.path.normpath", "set"})


def _setup_py(data: bytes) -> SetupFile:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(data)
    except SyntaxError as error:
        last = data.count(b"\n") + 1
        return SetupFile(problems=(Problem(min(max(error.lineno or 1, 1), last), f"not Python 3: {error.msg}"),))
    except ValueError as error:
        return SetupFile(problems=(Problem(1, f"not Python 3: {error}"),))
    reader = _Reader()
    reader.run(tree.body)
    return reader.file()


class _Reader:
    """Goes through the statements of a setup.py in order and keeps what is assigned and what setup() is given."""

    def __init__(self) -> None:
        self.names: dict[str, Any] = {}
        self.arguments: dict[str, Any] = {}
        self.unresolved: list[str] = []

    def run(self, body: list[ast.stmt]) -> None:
        """Statements in order; both branches of an if, and the body of a loop once, since each may run."""
        for statement in body:
            if isinstance(statement, ast.Assign):
                value = self.value(statement.value)
                for target in statement.targets:
                    self.assign(target, value)
            elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
                self.assign(statement.target, self.value(statement.value))
            elif isinstance(statement, ast.AugAssign) and isinstance(statement.op, ast.Add):
                before, more = self.value(statement.target), self.value(statement.value)
                if isinstance(before, list):
                    before.extend(more if isinstance(more, list) else [more])
            elif isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
                self.call(statement.value)
            elif isinstance(statement, (ast.For, ast.While)):
                if isinstance(statement, ast.For):
                    self.assign(statement.target, _Unresolved("a loop variable"))
                self.run(statement.body)
            elif isinstance(statement, (ast.If, ast.With, ast.Try, ast.FunctionDef)):
                for field in ("body", "handlers", "orelse", "finalbody"):
                    for child in getattr(statement, field, ()):
                        self.run(child.body if isinstance(child, ast.ExceptHandler) else [child])

    def assign(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            self.names[target.id] = value
        elif isinstance(target, (ast.Tuple, ast.List)):
            for element in target.elts:
                self.assign(element, _Unresolved("a tuple's part"))
        elif isinstance(target, ast.Subscript) and isinstance(target.value, ast.Name):
            owner, key = self.names.get(target.value.id), self.value(target.slice)
            if isinstance(owner, dict) and isinstance(key, str):
                owner[key] = value

    def call(self, call: ast.Call) -> None:
        """setup(...), and append or extend of a list that is known."""
        name = _dotted(call.func)
        if name.rpartition(".")[2] in SETUP_CALLS:
            for keyword, value in self.keywords(call).items():
                self.arguments.setdefault(keyword, value)
        elif isinstance(call.func, ast.Attribute) and call.args and call.func.attr in ("append", "extend"):
            owner = self.value(call.func.value)
            if isinstance(owner, list):
                more = self.value(call.args[0])
                owner.extend(more if call.func.attr == "extend" and isinstance(more, list) else [more])

    def keywords(self, call: ast.Call) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for keyword in call.keywords:
            value = self.value(keyword.value)
            if keyword.arg is not None:
                found[keyword.arg] = value
            elif isinstance(value, dict):
                found.update(value)
            elif isinstance(value, _Unresolved):
                self.unresolved.append(f"arguments are {value.what}")
        return found

    def value(self, node: ast.expr) -> Any:
        """A str (with its line), list, dict, or _Unresolved; a file pattern is a str."""
        if isinstance(node, ast.Constant):
            return _Text(node.value, node.lineno) if isinstance(node.value, str) else node.value
        if isinstance(node, (ast.List, ast.Tuple, ast.Set)):
            return [self.value(element) for element in node.elts]
        if isinstance(node, ast.Starred):
            return self.value(node.value)
        if isinstance(node, ast.Dict):
            pairs = [
                (None if k is None else self.value(k), self.value(v))
                for k, v in zip(node.keys, node.values, strict=True)
            ]
            merged: dict[str, Any] = {}
            for key, value in pairs:
                if isinstance(key, str):
                    merged[key] = value
                elif key is None and isinstance(value, dict):
                    merged.update(value)
            return merged
        if isinstance(node, ast.Name):
            return self.names.get(node.id, _Unresolved(f"`{node.id}`"))
        if isinstance(node, ast.BinOp):
            return self.operation(node)
        if isinstance(node, ast.JoinedStr):
            parts = [self.value(v.value if isinstance(v, ast.FormattedValue) else v) for v in node.values]
            if all(isinstance(part, str) for part in parts):
                return _Text("".join(parts), node.lineno)
        if isinstance(node, ast.Call):
            return self.result(node)
        if isinstance(node, ast.IfExp):
            return self.value(node.body)
        return _Unresolved(_source(node))

    def operation(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        if isinstance(node.op, (ast.Add, ast.Div)):
            if isinstance(left, str) and isinstance(right, str):
                between = "/" if isinstance(node.op, ast.Div) else ""
                return _Text(left + between + right, node.lineno)
            if isinstance(left, list) and isinstance(right, list):
                return left + right
            if isinstance(left, list) or isinstance(right, list):
                return (left if isinstance(left, list) else [left]) + (right if isinstance(right, list) else [right])
        if isinstance(node.op, ast.Mod) and isinstance(left, str):
            values = right if isinstance(right, list) else [right]
            if all(isinstance(v, str) for v in values) and left.count("%s") == len(values) == left.count("%"):
                pieces = left.split("%s")
                return _Text(pieces[0] + "".join(v + p for v, p in zip(values, pieces[1:], strict=True)), node.lineno)
        return _Unresolved(_source(node))

    def result(self, call: ast.Call) -> Any:
        name = _dotted(call.func)
        last = name.rpartition(".")[2]
        if last in ("find_packages", "find_namespace_packages"):
            return [_Text("*", call.lineno)]
        if last in SETUP_CALLS or name == "dict":
            return self.keywords(call)
        arguments = [self.value(argument) for argument in call.args]
        if name in JOINS or last == "Path":
            if arguments and all(isinstance(a, str) for a in arguments):
                return _Text("/".join(a.rstrip("/") for a in arguments if a), call.lineno)
        elif (name in GLOBS or last == "glob") and len(arguments) >= 1:
            if isinstance(arguments[0], str):
                return [_Text(arguments[0], call.lineno)]
        elif name in SAME and len(arguments) == 1:
            return arguments[0]
        elif last == "format" and isinstance(call.func, ast.Attribute):
            template = self.value(call.func.value)
            if isinstance(template, str) and all(isinstance(a, str) for a in arguments) and not call.keywords:
                pieces = template.split("{}")
                if len(pieces) == len(arguments) + 1 and "{" not in "".join(pieces):
                    return _Text(
                        pieces[0] + "".join(a + p for a, p in zip(arguments, pieces[1:], strict=True)), call.lineno
                    )
        return _Unresolved(_source(call))

    def file(self) -> SetupFile:
        given = self.arguments
        directories = given.get("package_dir")
        return SetupFile(
            tuple(self.strings("packages") + self.strings("py_modules")),
            {str(k): str(v) for k, v in directories.items() if isinstance(v, str)}
            if isinstance(directories, dict)
            else {},
            tuple(self.entry_points(given.get("entry_points"))),
            tuple(self.data_files(given.get("data_files"))),
            tuple(self.strings("scripts")),
            tuple(_requirements(self.strings("install_requires"))),
            tuple(self.unresolved),
        )

    def strings(self, argument: str) -> list[str]:
        """A list argument's strings; the rest is noted as unresolved."""
        value = self.arguments.get(argument)
        found: list[str] = []
        stack = [value] if value is not None else []
        while stack:
            item = stack.pop(0)
            if isinstance(item, str):
                found.append(str(item))
            elif isinstance(item, list):
                stack[:0] = item
            elif isinstance(item, _Unresolved):
                self.unresolved.append(f"{argument}: {item.what}")
        return found

    def entry_points(self, value: Any) -> list[tuple[str, str, int]]:
        found: list[tuple[str, str, int]] = []
        if isinstance(value, str):
            line = getattr(value, "line", 1)
            group = ""
            for number, text in enumerate(value.split("\n")):
                opened = re.match(r"\s*\[([\w.-]+)\]", text)
                if opened is not None:
                    group = opened.group(1)
                elif group in ("console_scripts", "gui_scripts") and (entry := ENTRY_POINT.match(text)):
                    found.append((entry[1].rstrip(), entry[2], line + number))
        elif isinstance(value, dict):
            for group in ("console_scripts", "gui_scripts"):
                entries = value.get(group, [])
                for item in entries if isinstance(entries, list) else [entries]:
                    if isinstance(item, _Unresolved):
                        self.unresolved.append(f"entry_points: {item.what}")
                    elif isinstance(item, str) and (entry := ENTRY_POINT.match(item)):
                        found.append((entry[1].rstrip(), entry[2], getattr(item, "line", 1)))
        elif isinstance(value, _Unresolved):
            self.unresolved.append(f"entry_points: {value.what}")
        return found

    def data_files(self, value: Any) -> list[tuple[str, str, int]]:
        found: list[tuple[str, str, int]] = []
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, _Unresolved):
                self.unresolved.append(f"data_files: {item.what}")
            if not isinstance(item, list) or len(item) != 2:
                continue
            destination, files = item
            if not isinstance(destination, str):
                what = destination.what if isinstance(destination, _Unresolved) else "a destination"
                self.unresolved.append(f"data_files: {what}")
                continue
            for file in files if isinstance(files, list) else [files]:
                if isinstance(file, str):
                    found.append((str(destination), str(file), getattr(file, "line", 1)))
                elif isinstance(file, _Unresolved):
                    self.unresolved.append(f"data_files: {file.what}")
                elif isinstance(file, list):
                    found.extend((str(destination), str(f), getattr(f, "line", 1)) for f in file if isinstance(f, str))
        return found


def _dotted(node: ast.expr) -> str:
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    parts.append(node.id if isinstance(node, ast.Name) else "")
    return ".".join(reversed(parts))


def _source(node: ast.expr) -> str:
    text = " ".join(ast.unparse(node).split())
    return f"`{text if len(text) <= 60 else text[:57] + '...'}`"


def _requirements(texts: Iterable[str]) -> list[str]:
    return [found.group(1) for text in texts if (found := REQUIREMENT.match(text)) is not None]


class _Lines:
    """Finds the line of an entry again in a file whose parser keeps none."""

    def __init__(self, text: str):
        self.first: dict[str, int] = {}
        for number, line in enumerate(text.split("\n"), 1):
            for key in (line.strip(), line.partition("=")[0].strip(" \t\"'")):
                self.first.setdefault(key, number)

    def of(self, *entries: str) -> int:
        return next((self.first[entry] for entry in entries if entry in self.first), 1)


def _setup_cfg(data: bytes) -> SetupFile:
    import configparser

    text = decode(data)
    lines = _Lines(text)
    parser = configparser.RawConfigParser(strict=False, delimiters=("=", ":"), comment_prefixes=("#", ";"))
    try:
        parser.read_string(text)
    except configparser.Error as error:
        line = getattr(error, "lineno", None) or (getattr(error, "errors", None) or [(1, "")])[0][0]
        last = text.count("\n") + 1
        said = str(error).split("\n")[0]
        return SetupFile(problems=(Problem(min(max(int(line), 1), last), f"not readable as a configuration: {said}"),))

    def entries(section: str, option: str) -> list[str]:
        value = parser.get(section, option, fallback="") or ""
        return [part.strip() for part in re.split(r"[\n,]", value) if part.strip()]

    packages = entries("options", "packages")
    if packages and packages[0] in ("find:", "find_namespace:"):
        packages = ["*"]
    directories: dict[str, str] = {}
    for entry in entries("options", "package_dir"):
        key, _, value = entry.partition("=")
        directories[key.strip()] = value.strip()
    points: list[tuple[str, str, int]] = []
    for group in ("console_scripts", "gui_scripts"):
        for entry in entries("options.entry_points", group):
            if (found := ENTRY_POINT.match(entry)) is not None:
                points.append((found[1].rstrip(), found[2], lines.of(entry)))
    files: list[tuple[str, str, int]] = []
    if parser.has_section("options.data_files"):
        for destination in parser.options("options.data_files"):
            files.extend((destination, f, lines.of(f, destination)) for f in entries("options.data_files", destination))
    scripts_to = next(
        (
            parser.get("install", o) or ""
            for o in ("install_scripts", "install-scripts")
            if parser.has_option("install", o)
        ),
        "",
    )
    return SetupFile(
        tuple(packages + entries("options", "py_modules")),
        directories,
        tuple(points),
        tuple(files),
        tuple(entries("options", "scripts")),
        tuple(_requirements(entries("options", "install_requires"))),
        install_scripts=scripts_to.strip(),
    )


def _pyproject(data: bytes) -> SetupFile:
    text = decode(data)
    try:
        document = load_toml(text)
    except DocumentError as error:
        line = error.line or text.count("\n") + 1
        return SetupFile(problems=(Problem(min(line, text.count("\n") + 1), f"not readable as TOML: {error}"),))
    lines = _Lines(text)
    project = _table(document, "project")
    setuptools = _table(document, "tool", "setuptools")
    points: list[tuple[str, str, int]] = []
    for table in (
        _table(project, "scripts"),
        _table(project, "gui-scripts"),
        _table(document, "tool", "poetry", "scripts"),
    ):
        for name, target in table.items():
            if isinstance(target, str):
                points.append((name, target.partition(":")[0].strip(), lines.of(name)))
    packages = setuptools.get("packages", [])
    files = [
        (destination, file, lines.of(destination))
        for destination, patterns in _table(setuptools, "data-files").items()
        for file in _texts(patterns)
    ]
    return SetupFile(
        ("*",) if isinstance(packages, dict) else (*_texts(packages), *_texts(setuptools.get("py-modules"))),
        {k: v for k, v in _table(setuptools, "package-dir").items() if isinstance(v, str)},
        tuple(points),
        tuple(files),
        tuple(_texts(setuptools.get("script-files"))),
        tuple(_requirements(_texts(project.get("dependencies")))),
    )


def _table(document: dict[str, Any], *path: str) -> dict[str, Any]:
    for key in path:
        inner = document.get(key)
        if not isinstance(inner, dict):
            return {}
        document = inner
    return document


def _texts(value: Any) -> list[str]:
    return [item for item in value if isinstance(item, str)] if isinstance(value, list) else []
