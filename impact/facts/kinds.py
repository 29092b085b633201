"""Which extractor reads a file, told by its name; the one entry to all extractors, and facts as bytes for the store."""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from typing import Any, Generic, TypeVar

import msgspec

from ...edges.limits import limits, limits_stamp, size_text
from .allow import allows
from .place import Allow, Problem

T = TypeVar("T")


class FileFacts(msgspec.Struct, Generic[T], frozen=True, array_like=True, gc=False):
    """Everything one file tells. kind: as extracted, so `script` has become `python` or `shell`, or stays where it is
    neither. facts: Manifest, CMakeFile, Interface, CppFile, PythonFile, ReferenceFile or SetupFile, None when
    the kind has none."""

    kind: str
    facts: T
    allows: tuple[Allow, ...] = ()


EXTRACTORS: dict[str, tuple[str, str, int]] = {
    "manifest": ("manifest", "Manifest", 3),
    "manifest_variant": ("manifest", "Manifest", 3),
    "cmake": ("cmake", "CMakeFile", 1),
    "msg": ("interface", "Interface", 2),
    "srv": ("interface", "Interface", 2),
    "action": ("interface", "Interface", 2),
    "idl": ("interface", "Interface", 2),
    "cpp": ("cpp", "CppFile", 2),
    "python": ("python", "PythonFile", 3),
    "launch_xml": ("launch", "ReferenceFile", 5),
    "launch_yaml": ("launch", "ReferenceFile", 5),
    "xacro": ("launch", "ReferenceFile", 5),
    "plugin_xml": ("launch", "ReferenceFile", 5),
    "xml": ("launch", "ReferenceFile", 5),
    "params": ("launch", "ReferenceFile", 5),
    "shell": ("launch", "ReferenceFile", 5),
    "setup_py": ("setup", "SetupFile", 3),
    "setup_cfg": ("setup", "SetupFile", 3),
    "pyproject": ("setup", "SetupFile", 3),
    "gitignore": ("gitignore", "IgnoreFile", 1),
    "script": ("", "", 1),
    "flow_cpp": ("flow_cpp", "FlowFile", 4),
    "flow_python": ("flow_python", "FlowFile", 4),
    "flow_script": ("", "", 1),
    "surface_cpp": ("surface_cpp", "HeaderSurface", 2),
    "surface_python": ("surface_python", "ModuleSurface", 1),
    "parameters_cpp": ("parameters", "ParametersFile", 2),
    "parameters_python": ("parameters", "ParametersFile", 2),
    "parameters_cfg": ("parameters", "ParametersFile", 2),
    "parameters_yaml": ("parameters", "ParametersFile", 2),
}
"""kind: (module, struct, version). Raise the version with every change of what an extractor says: it is part of the key
under which facts are stored."""
WITH_KIND = frozenset({"interface", "launch", "parameters", "setup"})
FLOW = {"cpp": "flow_cpp", "python": "flow_python", "script": "flow_script"}
"""The second look that the message-flow graph takes at files of a kind."""
SURFACE = {"cpp": "surface_cpp"}
"""The look at headers that tells what they offer to others."""

BY_NAME = {
    "package.xml": "manifest",
    "cmakelists.txt": "cmake",
    "setup.py": "setup_py",
    "setup.cfg": "setup_cfg",
    "pyproject.toml": "pyproject",
    ".gitignore": "gitignore",
}
BY_ENDING = {
    "msg": "msg",
    "srv": "srv",
    "action": "action",
    "idl": "idl",
    "cmake": "cmake",
    "py": "python",
    "launch": "launch_xml",
    "test": "launch_xml",
    "yaml": "params",
    "yml": "params",
    "sh": "shell",
    "bash": "shell",
    "zsh": "shell",
    "cfg": "script",
    "xml": "xml",
    **dict.fromkeys(("xacro", "urdf", "sdf", "srdf", "world", "gazebo"), "xacro"),
    **dict.fromkeys(("h", "hpp", "hh", "hxx", "h++", "ipp", "tpp", "tcc", "txx", "inl", "impl", "cuh", "cu"), "cpp"),
    **dict.fromkeys(("c", "cc", "cpp", "cxx", "c++"), "cpp"),
}
# Templates that configure_file() fills in; what they mention is mentioned all the same.
TEMPLATES = {"cmake", "h", "hpp", "cpp", "cc", "launch", "urdf", "xacro", "world", "sdf", "sh", "bash"}
VARIANT = re.compile(r"package[._-][\w.-]*\.xml$|package\.xml[._-]?ros[\w.-]*$")
PLUGIN = re.compile(r"plugin|nodelet|_controllers?\.xml$|_layers?\.xml$")
# Names without an ending that are prose, data or marks, never scripts.
PROSE = frozenset({
    "license", "licence", "copying", "copyright", "readme", "changelog", "authors", "contributors", "notice", "version",
    "makefile", "dockerfile", "colcon_ignore", "ament_ignore", "catkin_ignore", "codeowners", "install", "news", "todo",
})  # fmt: skip


def kind_of(path: str) -> str | None:
    """The kind of facts a file holds, by its name alone; None for files that are of no interest. Upper and lower case
    count the same, as on machines where a workspace was written on another file system."""
    name = path.rpartition("/")[2].lower()
    known = BY_NAME.get(name)
    if known is not None:
        return known
    stem, _, ending = name.rpartition(".")
    if not stem:
        return None if not ending or name[0] == "." or ending in PROSE else "script"
    if ending == "in":
        stem, _, ending = stem.rpartition(".")
        if ending not in TEMPLATES:
            return None
        name = f"{stem}.{ending}"
    if ending in ("xml", "ros1", "ros2") or name.startswith("package.xml"):
        if name.endswith((".launch.xml", "_launch.xml", ".test.xml")):
            return "launch_xml"
        if PLUGIN.search(name):
            return "plugin_xml" if ending == "xml" else None
        if VARIANT.match(name):
            return "manifest_variant"
    if ending in ("yaml", "yml") and (stem.endswith((".launch", "_launch"))):
        return "launch_yaml"
    return BY_ENDING.get(ending)


def largest(kind: str) -> int:
    """Bytes above which a file of a kind is taken for generated, or for an attack, and not read."""
    budget = limits()
    module = EXTRACTORS[kind][0]
    if kind in _BUDGETS:
        return getattr(budget, _BUDGETS[kind])
    if module in ("cmake", "manifest", "interface", "launch"):
        return getattr(budget, module)
    return budget.cpp if kind.endswith("cpp") else budget.python if "python" in kind else budget.script


# Names of limits, where the extractor's name does not say it.
_BUDGETS = {
    **dict.fromkeys(("launch_yaml", "params", "parameters_yaml"), "parameters"),
    **dict.fromkeys(("setup_cfg", "pyproject"), "settings"),
    "setup_py": "python",
    "shell": "script",
    "gitignore": "script",
}


def version_of(kind: str) -> str:
    """The part of a store key that changes when an extractor does, or what it may read at most."""
    return _extractors_of(kind) + limits_stamp()


def _extractors_of(kind: str) -> str:
    if kind == "script":
        return f"script.{EXTRACTORS['python'][2]}.{EXTRACTORS['shell'][2]}.{EXTRACTORS[kind][2]}"
    if kind == "flow_script":
        return f"{kind}.{EXTRACTORS['flow_python'][2]}.{EXTRACTORS[kind][2]}"
    if kind == "setup_py":
        return f"{kind}.{EXTRACTORS[kind][2]}.{EXTRACTORS['python'][2]}"
    if kind == "cpp":
        from ..targets.uses import stamp

        return f"{kind}.{EXTRACTORS[kind][2]}.{stamp()}"
    return f"{kind}.{EXTRACTORS[kind][2]}"


SHELLS = re.compile(rb"#!.*\b(?:ba|z|da|k)?sh\b")
PYTHONS = re.compile(rb"#!.*python")


def script_kind(data: bytes) -> str:
    """`python` or `shell` by the first line, `script` when it is neither. A dynamic_reconfigure .cfg is Python even
    where the first line was forgotten."""
    first = data[:256].partition(b"\n")[0]
    if first.startswith(b"#!"):
        if PYTHONS.match(first):
            return "python"
        if SHELLS.match(first):
            return "shell"
    if b"ParameterGenerator" in data:
        return "python"
    return "script"


def extract(kind: str, data: bytes) -> FileFacts[Any]:
    """Facts of a file of a kind as given by kind_of(); never raises: what fails is a Problem of empty facts."""
    if kind == "script":
        kind = script_kind(data)
        if kind == "script":
            return FileFacts(kind, None)
    if kind == "flow_script":
        if script_kind(data) != "python":
            return FileFacts(kind, None)
        kind = "flow_python"
    if len(data) > largest(kind):
        return FileFacts(kind, empty(kind, Problem(1, f"larger than {size_text(largest(kind))}")))
    return FileFacts(kind, _facts(kind, data), allows(data))


def _facts(kind: str, data: bytes) -> Any:
    module = EXTRACTORS[kind][0]
    try:
        read = import_module(f".{module}", __package__).extract
        facts = read(data, kind) if module in WITH_KIND else read(data)
        if kind == "cpp":
            from ..targets.uses import looked_for  # the one table that says what to look for

            facts = import_module(".usage", __package__).with_uses(facts, data, looked_for())
        if kind == "setup_py":
            python = _facts("python", data)
            # Python 2 is no mistake on a target that runs it: the rule on Python versions knows, and what it installs
            # is then merely not known.
            old = {"problems": (), "unresolved": ("written for Python 2",)} if python.python2_only else {}
            facts = msgspec.structs.replace(facts, python=python, **old)
        return _within_limits(facts)
    except (MemoryError, ImportError, OSError):
        raise  # of this run and not of the file: such facts must not be remembered
    except RecursionError:
        return empty(kind, Problem(1, "nested too deeply to be read"))
    except Exception as error:  # one file must not end the run: what broke is named with it
        return empty(kind, Problem(1, f"cannot be read: {type(error).__name__}: {error}"[:200]))


# Sets of names, which are looked up and not gone through.
_LOOKED_UP = frozenset(("words", "qualified", "mentioned"))


def _within_limits(facts: Any) -> Any:
    """The same facts; lists that are longer than any person or generator writes are cut, which is a problem."""
    most = limits().items
    cut: dict[str, Any] = {}
    for field in type(facts).__struct_fields__:
        value = getattr(facts, field)
        if type(value) is tuple and len(value) > most and field not in _LOOKED_UP:
            cut[field] = value[:most]
    if not cut:
        return facts
    named = ", ".join(sorted(field.replace("_", " ") for field in cut))
    problems = (Problem(1, f"lists more than {most:,} {named}; the rest was not read"), *facts.problems)
    return msgspec.structs.replace(facts, **{**cut, "problems": problems[:most]})


def empty(kind: str, *problems: Problem) -> Any:
    """Facts of a kind that say nothing but their problems."""
    struct = _struct(kind)
    blank = {"problems": problems}
    values: list[Any] = []
    for field in msgspec.structs.fields(struct):
        if field.name in blank:
            values.append(blank[field.name])
        elif not field.required:
            values.append(field.default if field.default is not msgspec.NODEFAULT else field.default_factory())
        else:
            values.append({str: "", int: 1}.get(field.type, ()))
    return struct(*values)


@cache
def _struct(kind: str) -> type[Any]:
    module, struct, _ = EXTRACTORS[kind]
    return getattr(import_module(f".{module}", __package__), struct)


_encoder = msgspec.msgpack.Encoder()


def encode(facts: FileFacts[Any]) -> bytes:
    """Facts as msgpack, to be read by decode()."""
    return _encoder.encode(facts)


def decode(kind: str, data: bytes) -> FileFacts[Any]:
    """The facts that encode() wrote, for a kind as given by kind_of().

    Raises msgspec.DecodeError (its subclass ValidationError where the shape differs) when the bytes are not such facts.
    """
    try:
        if kind in ("script", "flow_script"):
            kind = _raw.decode(data).kind
            if kind not in EXTRACTORS:
                raise msgspec.ValidationError(f"no kind of facts is called `{kind}`")
        return _decoder(kind).decode(data)
    except (UnicodeDecodeError, RecursionError) as error:
        raise msgspec.DecodeError(f"these bytes are no facts: {error}") from error


_raw = msgspec.msgpack.Decoder(FileFacts[msgspec.Raw])


@cache
def _decoder(kind: str) -> msgspec.msgpack.Decoder[FileFacts[Any]]:
    return msgspec.msgpack.Decoder(FileFacts[None] if kind in ("script", "flow_script") else FileFacts[_struct(kind)])
