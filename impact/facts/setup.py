"""setup.py, setup.cfg and pyproject.toml to facts: what an ament_python or catkin package installs."""

import ast
import posixpath
import re
from collections.abc import Iterator
from typing import Any

import msgspec
from msgspec import structs

from ...edges.documents import DocumentError, load_toml
from .markup import decode
from .place import Problem
from .python.constants import MORE, Constants, TextConstant, UnknownValue
from .python.source import PythonFile, read
from .python.source import extract as read_python
from .python.text import format_dotted
from .requirements import Requirement


class SetupFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Installed things, read from literals (setup.py is parsed, never run).

    entry_points: (name, module, line, function) of console_scripts. data_files: (destination, pattern, line), where
    glob(...) and os.path.join(...) of literals become a pattern such as `launch/*.launch.py`. scripts: as written.
    packages: dotted, `*` when find_packages. requirements: of install_requires. python_requires: the versions of Python
    that the package accepts, as written. unresolved: what was not a literal, in one clause each. python: of a setup.py,
    its imports and syntax like those of any Python file.
    script_folders: (command, folder, line) of the commands `install` and `develop` (--symlink-install): where programs
    are installed, as written (`$base/lib/package`, without which `ros2 run` does not find them). namespaces: whether
    packages are looked for that have no __init__.py too.
    """

    packages: tuple[str, ...] = ()
    package_dirs: dict[str, str] = {}
    entry_points: tuple[tuple[str, str, int, str], ...] = ()
    data_files: tuple[tuple[str, str, int], ...] = ()
    scripts: tuple[str, ...] = ()
    requirements: tuple[Requirement, ...] = ()
    unresolved: tuple[str, ...] = ()
    problems: tuple[Problem, ...] = ()
    python: PythonFile | None = None
    script_folders: tuple[tuple[str, str, int], ...] = ()
    python_requires: Requirement | None = None
    namespaces: bool = False

    def list_module_paths(self, folder: str, module: str) -> tuple[str, str]:
        """The paths that a module of the package in this folder can have: as a file, and as a package."""
        parts = module.split(".")
        count = next((n for n in range(len(parts), 0, -1) if ".".join(parts[:n]) in self.package_dirs), 0)
        root = self.package_dirs.get(".".join(parts[:count]), "")
        path = posixpath.normpath(posixpath.join(folder, root, *parts[count:]))
        return f"{path}.py", f"{path}/__init__.py"


def extract(data: bytes, kind: str) -> SetupFile:
    """Facts of a file of the kind setup_py, setup_cfg or pyproject; never raises.

    A setup.py is parsed and its literals evaluated, never run: what only running it tells is named in `unresolved`.
    """
    try:
        return {"setup_py": _setup_py, "setup_cfg": _read_setup_cfg, "pyproject": _read_pyproject}[kind](data)
    except (RecursionError, MemoryError):
        return SetupFile(problems=(_TOO_DEEP,))


_TOO_DEEP = Problem(1, "nested too deeply to be read")
ENTRY_POINT = re.compile(r"\s*([^=\s][^=]*)=\s*([\w.]+)(?:\s*:\s*([\w.]+))?(?:\s*\[.*\])?\s*\Z")
# What each command of setuptools calls the folder that it installs programs into.
_FOLDER_OPTIONS = {"install": "install_scripts", "develop": "script_dir"}
_GROUPS = ("console_scripts", "gui_scripts")
_OF_CATKIN = "generate_distutils_setup"
SETUP_CALLS = frozenset({"setup", _OF_CATKIN})


def _setup_py(data: bytes) -> SetupFile:
    source = read(data)
    facts = read_python(data)
    if source.tree is None:
        # Python 2 is no mistake on a target that runs it: the rule on Python versions knows.
        if source.python2_only:
            return SetupFile(unresolved=("written for Python 2",), python=facts)
        return SetupFile(problems=source.problems, python=facts)
    reader = _Reader()
    try:
        reader.run(source.tree.body)
        return structs.replace(reader.make_file(), python=facts)
    except (RecursionError, MemoryError):
        return SetupFile(problems=(_TOO_DEEP,), python=facts)


class _Reader(Constants):
    """Goes through the statements of a setup.py in order and keeps what is assigned and what setup() is given."""

    def __init__(self) -> None:
        super().__init__()
        self.calls: list[dict[str, Any]] = []
        self.unresolved: list[str] = []
        self.namespaces = False

    def run(self, body: list[ast.stmt]) -> None:
        """Statements in order; both branches of an if, and the body of a loop once, since each may run."""
        for statement in body:
            if isinstance(statement, ast.Assign):
                value = self.find_value(statement.value)
                for target in statement.targets:
                    self.assign(target, value)
            elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
                self.assign(statement.target, self.find_value(statement.value))
            elif isinstance(statement, ast.AugAssign) and isinstance(statement.op, ast.Add):
                before, more = self.find_value(statement.target), self.find_value(statement.value)
                if isinstance(before, list):
                    before.extend(more if isinstance(more, list) else [more])
            elif isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
                self.call(statement.value)
            elif isinstance(statement, (ast.For, ast.While)):
                if isinstance(statement, ast.For):
                    self.assign(statement.target, UnknownValue("a loop variable"))
                self.run(statement.body)
            elif isinstance(statement, (ast.If, ast.With, ast.Try, ast.FunctionDef)):
                for field in ("body", "handlers", "orelse", "finalbody"):
                    for child in getattr(statement, field, ()):
                        self.run(child.body if isinstance(child, ast.ExceptHandler) else [child])

    def call(self, call: ast.Call) -> None:
        """setup(...), and append or extend of a list that is known."""
        name = format_dotted(call.func)
        if name.rpartition(".")[2] in SETUP_CALLS:
            self.calls.append(self._find_arguments(call))
        elif isinstance(call.func, ast.Attribute) and call.args and call.func.attr in ("append", "extend"):
            owner = self.find_value(call.func.value)
            if isinstance(owner, list):
                more = self.find_value(call.args[0])
                owner.extend(more if call.func.attr == "extend" and isinstance(more, list) else [more])

    def find_result(self, call: ast.Call) -> Any:
        last = format_dotted(call.func).rpartition(".")[2]
        if last in ("find_packages", "find_namespace_packages"):
            self.namespaces = self.namespaces or last == "find_namespace_packages"
            return [TextConstant("*", call.lineno)]
        return self._find_arguments(call) if last in SETUP_CALLS else super().find_result(call)

    def _find_arguments(self, call: ast.Call) -> dict[str, Any]:
        given = self.find_keywords(call)
        of_catkin = format_dotted(call.func).rpartition(".")[2] == _OF_CATKIN
        return {**given, _OF_CATKIN: True} if of_catkin else given

    def _merge_calls(self) -> dict[str, Any]:
        """What all calls of setup() are given, the first first. Where one of them is catkin's, and another is not, that
        is for ROS 1, and what it is given is not what ament_python installs."""
        own = [given for given in self.calls if _OF_CATKIN not in given]
        return {keyword: value for given in reversed(own or self.calls) for keyword, value in given.items()}

    def make_file(self) -> SetupFile:
        given = self._merge_calls()
        self.note_unknown("arguments", given.get(MORE))
        directories = given.get("package_dir")
        return SetupFile(
            # Paths of folders do as well as dotted names.
            tuple(name.strip("/").replace("/", ".") for name in self.list_strings("packages", given.get("packages")))
            + tuple(self.list_strings("py_modules", given.get("py_modules"))),
            {str(k): str(v) for k, v in directories.items() if isinstance(v, str)}
            if isinstance(directories, dict)
            else {},
            tuple(self.list_entry_points(given.get("entry_points"))),
            tuple(self.list_data_files(given.get("data_files"))),
            tuple(self.list_strings("scripts", given.get("scripts"))),
            tuple(
                Requirement(str(text).strip(), _find_line(text))
                for text in self.iterate_strings("install_requires", given.get("install_requires"))
            ),
            python_requires=_make_python(given.get("python_requires")),
            script_folders=tuple(self.list_script_folders(given.get("options"))),
            unresolved=tuple(self.unresolved),
            namespaces=self.namespaces,
        )

    def list_strings(self, argument: str, value: Any) -> list[str]:
        """The strings of an argument that is a list."""
        return [str(text) for text in self.iterate_strings(argument, value)] if value is not None else []

    def iterate_strings(self, argument: str, value: Any) -> Iterator[str]:
        """The strings of a value, in lists at any depth; what is not known is noted as unresolved."""
        if isinstance(value, str):
            yield value
        for item in value if isinstance(value, list) else ():
            yield from self.iterate_strings(argument, item)
        self.note_unknown(argument, value)

    def note_unknown(self, argument: str, value: Any) -> None:
        value = value.get(MORE) if isinstance(value, dict) else value
        if isinstance(value, UnknownValue):
            self.unresolved.append(f"{argument}: {value.what}")

    def list_entry_points(self, value: Any) -> list[tuple[str, str, int, str]]:
        found: list[tuple[str, str, int, str]] = []
        if isinstance(value, str):
            line = _find_line(value)
            group = ""
            for number, text in enumerate(value.split("\n")):
                opened = re.match(r"\s*\[([\w.-]+)\]", text)
                if opened is not None:
                    group = opened.group(1)
                elif group in _GROUPS:
                    found += _parse_entry_point(text, line + number)
        elif isinstance(value, dict):
            for text in (text for group in _GROUPS for text in self.iterate_strings("entry_points", value.get(group))):
                found += _parse_entry_point(text, _find_line(text))
        self.note_unknown("entry_points", value)
        return found

    def list_script_folders(self, value: Any) -> Iterator[tuple[str, str, int]]:
        """Of setup(options={"install": {"install_scripts": ...}})."""
        self.note_unknown("options", value)
        for command, option in _FOLDER_OPTIONS.items() if isinstance(value, dict) else ():
            options = value.get(command)
            folder = options.get(option) if isinstance(options, dict) else options
            if isinstance(folder, str):
                yield command, str(folder), _find_line(folder)
            self.note_unknown("options", folder)

    def list_data_files(self, value: Any) -> Iterator[tuple[str, str, int]]:
        for item in value if isinstance(value, list) else [value]:
            self.note_unknown("data_files", item)
            if not isinstance(item, list) or len(item) != 2:
                continue
            destination, files = item
            if isinstance(destination, str):
                for file in self.iterate_strings("data_files", files):
                    yield str(destination), str(file), _find_line(file)
            else:
                what = destination.what if isinstance(destination, UnknownValue) else "a destination"
                self.unresolved.append(f"data_files: {what}")


def _find_line(text: str) -> int:
    return getattr(text, "line", 1)


def _parse_entry_point(text: str, line: int) -> list[tuple[str, str, int, str]]:
    """The entry point that a text is, none where it is none."""
    found = ENTRY_POINT.match(text)
    return [(found[1].rstrip(), found[2], line, found[3] or "")] if found is not None else []


def _make_python(value: Any) -> Requirement | None:
    return Requirement(str(value).strip(), _find_line(value)) if isinstance(value, str) else None


class _Lines:
    """Finds the line of an entry again in a file whose parser keeps none."""

    def __init__(self, text: str):
        self.first: dict[str, int] = {}
        for number, line in enumerate(text.split("\n"), 1):
            for key in (line.strip(), line.partition("=")[0].strip(" \t\"'"), line.strip(" \t\"',")):
                self.first.setdefault(key, number)

    def find_line(self, *entries: str) -> int:
        return next((self.first[entry] for entry in entries if entry in self.first), 1)


def _read_setup_cfg(data: bytes) -> SetupFile:
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

    def list_entries(section: str, option: str) -> list[str]:
        value = parser.get(section, option, fallback="") or ""
        return [part.strip() for part in re.split(r"[\n,]", value) if part.strip()]

    packages = list_entries("options", "packages")
    namespaces = packages[:1] == ["find_namespace:"]
    if packages and packages[0] in ("find:", "find_namespace:"):
        packages = ["*"]
    directories: dict[str, str] = {}
    for entry in list_entries("options", "package_dir"):
        key, _, value = entry.partition("=")
        directories[key.strip()] = value.strip()
    entries = [entry for group in _GROUPS for entry in list_entries("options.entry_points", group)]
    points = [point for entry in entries for point in _parse_entry_point(entry, lines.find_line(entry))]
    files: list[tuple[str, str, int]] = []
    if parser.has_section("options.data_files"):
        for destination in parser.options("options.data_files"):
            files.extend(
                (destination, f, lines.find_line(f, destination))
                for f in list_entries("options.data_files", destination)
            )
    folders = [
        (command, (parser.get(command, option) or "").strip(), lines.find_line(option))
        for command, wanted in _FOLDER_OPTIONS.items()
        for option in (parser.options(command) if parser.has_section(command) else ())
        if option.replace("-", "_") == wanted
    ]
    requires = (parser.get("options", "install_requires", fallback="") or "").split("\n")
    python = parser.get("options", "python_requires", fallback="")
    return SetupFile(
        tuple(packages + list_entries("options", "py_modules")),
        directories,
        tuple(points),
        tuple(files),
        tuple(list_entries("options", "scripts")),
        tuple(
            Requirement(text, lines.find_line(text, "install_requires")) for each in requires if (text := each.strip())
        ),
        python_requires=Requirement(python, lines.find_line("python_requires")) if python else None,
        script_folders=tuple(folder for folder in folders if folder[1]),
        namespaces=namespaces,
    )


def _read_pyproject(data: bytes) -> SetupFile:
    text = decode(data)
    try:
        document = load_toml(text)
    except DocumentError as error:
        line = error.line or text.count("\n") + 1
        return SetupFile(problems=(Problem(min(line, text.count("\n") + 1), f"not readable as TOML: {error}"),))
    lines = _Lines(text)
    project = _find_table(document, "project")
    setuptools = _find_table(document, "tool", "setuptools")
    points: list[tuple[str, str, int, str]] = []
    for table in (
        _find_table(project, "scripts"),
        _find_table(project, "gui-scripts"),
        _find_table(document, "tool", "poetry", "scripts"),
    ):
        for name, target in table.items():
            if isinstance(target, str):
                module, _, function = target.partition(":")
                points.append((name, module.strip(), lines.find_line(name), function.partition("[")[0].strip()))
    packages, python = setuptools.get("packages", []), project.get("requires-python")
    files = [
        (destination, file, lines.find_line(destination))
        for destination, patterns in _find_table(setuptools, "data-files").items()
        for file in _list_texts(patterns)
    ]
    folders = [
        (command, folder, lines.find_line(option))
        for command, wanted in _FOLDER_OPTIONS.items()
        for option, folder in _find_table(document, "tool", "distutils", command).items()
        if option.replace("-", "_") == wanted and isinstance(folder, str)
    ]
    return SetupFile(
        ("*",) if isinstance(packages, dict) else (*_list_texts(packages), *_list_texts(setuptools.get("py-modules"))),
        {k: v for k, v in _find_table(setuptools, "package-dir").items() if isinstance(v, str)},
        tuple(points),
        tuple(files),
        tuple(_list_texts(setuptools.get("script-files"))),
        tuple(
            Requirement(text, lines.find_line(text, "dependencies"))
            for text in _list_texts(project.get("dependencies"))
        ),
        python_requires=Requirement(python, lines.find_line("requires-python")) if isinstance(python, str) else None,
        script_folders=tuple(folders),
        namespaces=isinstance(packages, dict),
    )


def _find_table(document: dict[str, Any], *path: str) -> dict[str, Any]:
    for key in path:
        inner = document.get(key)
        if not isinstance(inner, dict):
            return {}
        document = inner
    return document


def _list_texts(value: Any) -> list[str]:
    return [item for item in value if isinstance(item, str)] if isinstance(value, list) else []
