"""Which extractor reads a file, told by its name; the one entry to all extractors, and facts as bytes for the store."""

import re
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any, Generic, TypeVar

import msgspec

from ...edges.limits import format_limits, format_size, get_limits
from ..source_keys import compute_source_key
from .allow import allows
from .distros import DistroFile, find_distros
from .place import Allow, Problem

T = TypeVar("T")


class FileFacts(msgspec.Struct, Generic[T], frozen=True, array_like=True, gc=False):
    """Everything one file tells. kind: as extracted, so `script` has become `python` or `shell`, or stays where it is
    neither. facts: Manifest, CMakeFile, Interface, CppFile, PythonFile, ReferenceFile or SetupFile, None when
    the kind has none. distros: folders of distros that it names, see distros.py."""

    kind: str
    facts: T
    allows: tuple[Allow, ...] = ()
    distros: DistroFile | None = None


_READ_BY: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("manifest", "Manifest", ("manifest", "manifest_variant")),
    ("cmake", "CMakeFile", ("cmake",)),
    ("interface", "Interface", ("msg", "srv", "action", "idl")),
    ("cpp.lexical", "CppFile", ("cpp",)),
    ("python.source", "PythonFile", ("python",)),
    ("launch.references", "ReferenceFile",
     ("launch_xml", "launch_yaml", "xacro", "plugin_xml", "xml", "params", "shell")),
    ("setup", "SetupFile", ("setup_py", "setup_cfg", "pyproject")),
    ("requirements", "RequirementsFile", ("requirements",)),
    ("repositories", "RepositoryList", ("repositories",)),
    ("gitignore", "IgnoreFile", ("gitignore",)),
    ("", "", ("script", "flow_script")),
    ("cpp.flow", "FlowFile", ("flow_cpp",)),
    ("python.flow", "FlowFile", ("flow_python",)),
    ("cpp.field_uses", "FieldFile", ("fields_cpp",)),
    ("python.field_uses", "FieldFile", ("fields_python",)),
    ("launch.flow", "LaunchFile", ("flow_launch_xml", "flow_launch_yaml", "flow_launch_python")),
    ("launch.parameter_files", "ParameterFile", ("flow_parameters",)),
    ("nodl", "NodlFile", ("flow_nodl",)),
    ("gazebo", "GazeboFile", ("flow_gazebo",)),
    ("reconfigure", "ReconfigureFile", ("flow_reconfigure",)),
    ("colcon", "ColconFile",
     ("colcon_cmake", "colcon_setup_py", "colcon_setup_cfg", "colcon_pyproject", "colcon_settings")),
    ("distros", "ContainerFile", ("dockerfile", "ci")),
    ("searches", "SearchedCpp", ("searched_cpp",)),
    ("searches", "SearchedText", ("searched_text",)),
    ("searches", "CalledCpp", ("called_cpp",)),
    ("cpp.syntax", "FileDeclarations", ("declared_cpp",)),
    ("cpp.syntax", "MentionedCpp", ("mentioned_cpp",)),
    ("cpp.syntax", "UsedCpp", ("used_cpp",)),
)  # fmt: skip
EXTRACTORS = {kind: (module, struct) for module, struct, kinds in _READ_BY for kind in kinds}
"""kind: (module, struct). A kind is stored under the key of its module\'s code.

A kind with a dot is the full name of a module of another room that makes facts, alone or with a variant:
`rosimpact.room.module:variant`. It needs no entry here: such a module has `extract`, which is given the variant where
there is one, `Facts`, its struct, and `LIMITS`, by variant the name of the limit that the size of its files has."""
WITH_KIND = frozenset({"colcon", "distros", "interface", "launch.flow", "launch.references", "setup"})
SEARCHES = frozenset(kind for kind, (module, _) in EXTRACTORS.items() if module in ("searches", "cpp.syntax"))
"""Kinds that are made of a file's first facts too, and of a table that says what to look for; see search()."""
_OTHERS_READ_TOO = {
    "script": ("python", "shell"),
    "flow_script": ("flow_python",),
}
"""Kinds whose facts are made by the extractors of other kinds too."""
FLOW = {"cpp": "flow_cpp", "python": "flow_python", "script": "flow_script"}
"""The second look that the message-flow graph takes at files of a kind."""

BY_NAME = {
    "package.xml": "manifest",
    "cmakelists.txt": "cmake",
    "setup.py": "setup_py",
    "setup.cfg": "setup_cfg",
    "pyproject.toml": "pyproject",
    "requirements.txt": "requirements",
    ".gitignore": "gitignore",
    ".rosinstall": "repositories",
}
HEADER_ENDINGS = (".h", ".hpp", ".hh", ".hxx", ".h++", ".ipp", ".tpp", ".tcc", ".txx", ".inl", ".impl", ".cuh")
BY_ENDING = {
    **{name: name for name in ("msg", "srv", "action", "idl", "cmake")},
    "py": "python",
    **dict.fromkeys(("launch", "test"), "launch_xml"),
    **dict.fromkeys(("yaml", "yml"), "params"),
    **dict.fromkeys(("sh", "bash", "zsh"), "shell"),
    "cfg": "script",
    **dict.fromkeys(("repos", "rosinstall"), "repositories"),
    "xml": "xml",
    **dict.fromkeys(("xacro", "urdf", "sdf", "srdf", "world", "gazebo"), "xacro"),
    **dict.fromkeys((ending[1:] for ending in HEADER_ENDINGS), "cpp"),
    **dict.fromkeys(("c", "cc", "cpp", "cxx", "c++", "cu"), "cpp"),
}
# Templates that configure_file() fills in; what they mention is mentioned all the same.
TEMPLATES = {"cmake", "h", "hpp", "cpp", "cc", "launch", "urdf", "xacro", "world", "sdf", "sh", "bash"}
VARIANT = re.compile(r"package[._-][\w.-]*\.xml$|package\.xml[._-]?ros[\w.-]*$")
DOCKERFILE = re.compile(r"(?:(?:.*\.)?dockerfile(?:\..*|[_-][^.]*)?|.*[_-]dockerfile)\Z")
CI = re.compile(
    r"(?:^|/)(?:\.github/workflows/[^/]+|\.gitlab-ci|\.gitlab/[^/]+|\.travis|\.circleci/config|azure-pipelines)"
    r"\.ya?ml\Z"
)
PLUGIN = re.compile(r"plugin|nodelet|_controllers?\.xml$|_layers?\.xml$")
# Names without an ending that are prose, data or marks, never scripts.
PROSE = frozenset({
    "license", "licence", "copying", "copyright", "readme", "changelog", "authors", "contributors", "notice", "version",
    "makefile", "dockerfile", "colcon_ignore", "ament_ignore", "catkin_ignore", "codeowners", "install", "news", "todo",
})  # fmt: skip


def find_kind(path: str) -> str | None:
    """The kind of facts a file holds, by its name alone; None for files that are of no interest. Upper and lower case
    count the same, as on machines where a workspace was written on another file system."""
    name = path.rpartition("/")[2].lower()
    known = BY_NAME.get(name)
    if known is not None:
        return known
    if DOCKERFILE.match(name):
        return "dockerfile"
    stem, _, ending = name.rpartition(".")
    if ending in ("yaml", "yml") and CI.search(path):
        return "ci"
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


def find_size_limit(kind: str) -> int:
    """Bytes above which a file of a kind is taken for generated, or for an attack, and not read."""
    budget = get_limits()
    if "." in kind:
        return getattr(budget, import_module(_find_module(kind)).LIMITS[kind.partition(":")[2]])
    module = EXTRACTORS[kind][0]
    if kind in _BUDGETS:
        return getattr(budget, _BUDGETS[kind])
    if module in ("cmake", "manifest", "interface", "launch.references"):
        return getattr(budget, module.partition(".")[0])
    return budget.cpp if kind.endswith("cpp") else budget.python if "python" in kind else budget.script


# Names of limits, where the extractor's name does not say it.
_BUDGETS = {
    **dict.fromkeys(("launch_yaml", "params", "flow_launch_yaml", "flow_parameters", "flow_nodl"), "parameters"),
    "flow_launch_xml": "launch",
    **dict.fromkeys(("setup_cfg", "pyproject", "colcon_setup_cfg", "colcon_pyproject", "colcon_settings"), "settings"),
    **dict.fromkeys(("setup_py", "colcon_setup_py"), "python"),
    "colcon_cmake": "cmake",
    "shell": "script",
    **dict.fromkeys(("dockerfile", "ci"), "script"),
    **dict.fromkeys(("gitignore", "requirements", "repositories"), "script"),
}


def make_version(kind: str) -> str:
    """The part of a store key that changes when the code of an extractor does, or what it may read at most."""
    modules = {_find_module(each) for each in (kind, *_OTHERS_READ_TOO.get(kind, ()))} - {""}
    return f"{kind}.{compute_source_key(_HERE, *sorted(modules))}{format_limits()}"


def make_overall_version() -> str:
    """The same for all extractors together."""
    return compute_source_key(_HERE, *sorted({_find_module(kind) for kind in EXTRACTORS} - {""}))


def _find_module(kind: str) -> str:
    """The full name of the module that makes a kind of facts, empty where others make it."""
    if "." in kind:
        return kind.partition(":")[0]
    module = EXTRACTORS[kind][0]
    return module and f"{_ROOM}.{module}"


_HERE = __name__
_ROOM = __name__.rpartition(".")[0]

SHELLS = re.compile(rb"#!.*\b(?:ba|z|da|k)?sh\b")
PYTHONS = re.compile(rb"#!.*python")


def find_script_kind(data: bytes) -> str:
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
    """Facts of a file of a kind as given by find_kind(); never raises: what fails is a Problem of empty facts."""
    if kind == "script":
        kind = find_script_kind(data)
        if kind == "script":
            return FileFacts(kind, None)
    if kind == "flow_script":
        if find_script_kind(data) != "python":
            return FileFacts(kind, None)
        kind = "flow_python"
    if len(data) > find_size_limit(kind):
        return FileFacts(kind, make_empty(kind, Problem(1, f"larger than {format_size(find_size_limit(kind))}")))
    facts = _catch_errors(kind, lambda: _extract_content(kind, data))
    return FileFacts(kind, facts, allows(data), find_distros(data, kind))


def search(kind: str, data: bytes, facts: Any, table: Any) -> FileFacts[Any]:
    """What one of the SEARCHES finds in a file; never raises, as extract(). facts: those of the file, as extracted by
    its name. table: what to look for; a store key names it beside the kind."""
    return FileFacts(kind, _catch_errors(kind, lambda: _load_extractor(kind)(data, facts, table)))


def _load_extractor(kind: str) -> Callable[..., Any]:
    return getattr(import_module(_find_module(kind)), kind if kind in SEARCHES else "extract")


def _extract_content(kind: str, data: bytes) -> Any:
    read = _load_extractor(kind)
    of_kind = kind in EXTRACTORS and EXTRACTORS[kind][0] in WITH_KIND
    variant = kind if of_kind else kind.partition(":")[2]
    return read(data, variant) if variant else read(data)


def _catch_errors(kind: str, make: Callable[[], Any]) -> Any:
    """What is made, within the limits, or empty facts with a problem that says why it failed."""
    try:
        return _cut_lists(make())
    except (MemoryError, ImportError, OSError):
        raise  # of this run and not of the file: such facts must not be remembered
    except RecursionError:
        return make_empty(kind, Problem(1, "nested too deeply to be read"))
    except Exception as error:  # one file must not end the run: what broke is named with it
        return make_empty(kind, Problem(1, f"cannot be read: {type(error).__name__}: {error}"[:200]))


# Sets of names, which are looked up and not gone through; and what its extractor has a limit of its own for.
_LOOKED_UP = frozenset(("words", "qualified", "mentioned", "entries"))


def _cut_lists(facts: Any) -> Any:
    """The same facts; lists that are longer than any person or generator writes are cut, which is a problem."""
    most = get_limits().items
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


def make_empty(kind: str, *problems: Problem) -> Any:
    """Facts of a kind that say nothing but their problems."""
    struct = _get_type(kind)
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
def _get_type(kind: str) -> type[Any]:
    struct = EXTRACTORS[kind][1] if kind in EXTRACTORS else "Facts"
    return getattr(import_module(_find_module(kind)), struct)


_encoder = msgspec.msgpack.Encoder()


def encode(facts: FileFacts[Any]) -> bytes:
    """Facts as msgpack, to be read by decode()."""
    return _encoder.encode(facts)


def decode(kind: str, data: bytes) -> FileFacts[Any]:
    """The facts that encode() wrote, for a kind as given by find_kind().

    Raises msgspec.DecodeError (its subclass ValidationError where the shape differs) when the bytes are not such facts.
    """
    try:
        if kind in ("script", "flow_script"):
            kind = _raw.decode(data).kind
            if kind not in EXTRACTORS:
                raise msgspec.ValidationError(f"no kind of facts is called `{kind}`")
        return _make_decoder(kind).decode(data)
    except (UnicodeDecodeError, RecursionError) as error:
        raise msgspec.DecodeError(f"these bytes are no facts: {error}") from error


_raw = msgspec.msgpack.Decoder(FileFacts[msgspec.Raw])


@cache
def _make_decoder(kind: str) -> msgspec.msgpack.Decoder[FileFacts[Any]]:
    generic: Any = FileFacts
    return msgspec.msgpack.Decoder(generic[None if kind in ("script", "flow_script") else _get_type(kind)])
