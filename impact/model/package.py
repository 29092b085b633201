"""One package, joined from the facts of its files: what it builds, what each file needs, under which condition.

The join is a pure function of facts, so its outcome is remembered by the content ids it read (see workspace.py).
"""

from __future__ import annotations

import itertools
import posixpath
import re
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Any

import msgspec

from ...edges.groups import group_pairs
from ...edges.memory import cache_method
from ...edges.reach import walk
from ..conditions import Environment, holds
from ..facts.cmake import CMakeFile
from ..facts.condition import Condition
from ..facts.cpp.lexical import CppFile, Include
from ..facts.cpp.schema import CodeSpot
from ..facts.cpp.tree_nodes import TreeNodes, mark_extended, merge_tree_nodes
from ..facts.distro_branches import BranchedName, ComparedDistro
from ..facts.distros import DistroFile
from ..facts.interface import Interface
from ..facts.kinds import HEADER_ENDINGS, make_empty
from ..facts.launch.actions import LaunchFile
from ..facts.launch.references import ControlledJoint, PluginClass
from ..facts.manifest import Manifest
from ..facts.place import Allow, Reference
from ..facts.python.reader import Import
from ..facts.python.source import PythonFile
from ..facts.python.uses import KINDS, PythonUse
from ..facts.requirements import RequirementsFile
from ..facts.searches import SearchedCpp, WordUse
from ..facts.setup import SetupFile
from ..facts.usage import Pattern, Rows, UsageTable
from ..facts.words import mentions
from ..targets.providers.compiled import CompiledNames
from ..targets.providers.message_headers import parse_type
from ..targets.providers.standard import list_own_names
from ..targets.surface.fields import Fields
from ..tree.paths import is_vendored
from .cmake.build import At, Build
from .cpp.offered_headers import OfferedHeaders, collect_words
from .macros import Macros
from .misspelling import is_slip
from .python.api import find_top_modules
from .python.undefined import (
    PythonOffer,
    list_above,
    list_called_by_path,
    list_siblings,
    list_undefined,
    list_undefined_functions,
    list_unlisted,
    offer_python,
)

# What looks for uses is imported where it does: most packages are read back as they were joined before.
if TYPE_CHECKING:
    from ..facts.extract import ExtractedFacts
    from ..facts.launch.parameter_files import ParameterEntry
    from ..targets.asked_versions import AskedVersions
    from .api import Changes, Vocabulary
    from .cpp.own_classes import LeftOut, OwnClasses
    from .cpp.resolver import KnownFile
    from .discovery import PackagePlace
    from .members import FoundField
    from .members import NamedInterface as Meant
    from .python.api import Changing
    from .settings import NamedNode, Setting

# Folders whose files run only by hand or are read only by people: what they need is worth a note at most.
ASIDE = frozenset({"example", "examples", "demo", "demos", "doc", "docs", "tutorial", "tutorials", "sample", "samples"})
TESTS = frozenset({"test", "tests", "gtest", "testing", "unittest", "integration_tests", "benchmark", "benchmarks"})


# `<urdf::...>` in the label of a use stands for the template arguments that are written.
_OPEN_TYPES = re.compile(r"<[^<>]*\.\.\.>")
_PLAIN_PYTHON = re.compile(r"#!\s*(?:/usr(?:/local)?)?/bin/(?:env\s+)?python(?!\S)")
# Where users put a Python of their own.
_PYTHON_AT_HOME = re.compile(r"#!\s*((?:/home/|/root/|/Users/)\S*python\S*)")


def _is_part(facts: PythonFile) -> bool:
    """Whether a Python file cannot be started itself, since it imports relative to its package."""
    return any(item.level and not item.lazy for item in facts.imports)


def _list_imported_beside(python: Mapping[str, PythonFile]) -> tuple[str, ...]:
    """The files with an interpreter in their first line that another file of their folder imports by their name."""
    modules = {
        posixpath.join(posixpath.dirname(path), f"{item.module}.py")
        for path, file in python.items()
        for item in file.imports
        if not item.level and item.module
    }
    return tuple(path for path, file in python.items() if file.interpreter and path in modules)


_ASIDE_NAME = re.compile(r"(?:^|[_-])(?:example|demo|tutorial|sample)s?(?:[_-]|\.|\d|$)")
# Modules and sources of tests, and launch files by which a node is tried out.
_TEST_NAME = re.compile(r"(?:test_.*|.*_test|conftest)\.\w+$|(?:.*[_-])?test\.launch(?:\.\w+)?$")


_STD_NAME = re.compile(r"std::(\w+)")
# So many of the sources that compile a header are looked at.
_SOURCES = 6


class IncludeUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An include that no file of the package answers. role: build, test or aside; public: in an installed header.
    targets: CMake targets that compile it. idle: no file of the package names anything of the namespace, or a macro,
    that its first folder is called after, nor of a standard header since C++17 any of its names. angled: in <...>, not
    in quotes."""

    path: str
    at: At
    role: str
    public: bool
    conditions: tuple[Condition, ...] = ()
    targets: tuple[str, ...] = ()
    idle: bool = False
    angled: bool = False


class ImportUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A Python import that no module of the package answers, of its own interfaces too. role: run, test, build
    (setup.py) or aside."""

    module: str
    names: tuple[str, ...]
    at: At
    role: str
    conditions: tuple[Condition, ...] = ()
    lazy: bool = False


class ReferenceUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A mention of another package in a launch file, script, URDF ... role: run, test or aside."""

    reference: Reference
    at: At
    role: str


class NameUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of a name that some rule watches. shown: how to call it, where that says more."""

    text: str
    at: At
    role: str
    public: bool
    language: str
    conditions: tuple[Condition, ...] = ()
    targets: tuple[str, ...] = ()
    shown: str = ""


class NeededHeader(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A name whose header the file does not include, itself or through files of the package. whole: a variable of the
    type stands there, or a macro outside of other ones, so that it has to be defined, not just announced."""

    name: str
    at: At
    role: str
    conditions: tuple[Condition, ...] = ()
    whole: bool = False


class InterfaceFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A message, service or action definition of the package."""

    name: str
    path: str
    definition: Interface


class FieldOfWorkspace(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use in Python of a member of an interface that belongs to a package of the workspace. type, steps, conditions:
    as FieldUse has them. role: as in ImportUse."""

    type: str
    steps: tuple[str, ...]
    at: At
    role: str
    conditions: tuple[Condition, ...] = ()


class SyntaxUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Python syntax that some version refuses. needs: 2 for Python 2 only, else the minor version of Python 3,
    NO_PYTHON or NEVER_PYTHON. plain: the first line of the file says that `python` runs it, which Python 2 may be."""

    needs: int
    what: str
    at: At
    role: str
    plain: bool = False


class MemberUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of a field or constant of another package's interface that some version lacks. ros: the generation whose
    interface it is. interface: `kind/Name`.
    sure: the receiver's type shows in the file; else only the name speaks, and no interface that is known to reach the
    file has it besides. role, language and conditions as in NameUse."""

    package: str
    ros: int
    interface: str
    section: str
    member: str
    at: At
    role: str
    language: str
    sure: bool
    conditions: tuple[Condition, ...] = ()

    @property
    def spellings(self) -> tuple[str, ...]:
        """A constant as the tables of names have it."""
        kind, _, name = self.interface.partition("/")
        part = "" if self.section == "message" else self.section.capitalize()
        parts = (self.package, kind, name, *filter(None, [part]), self.member)
        return ("::".join(parts), ".".join(parts), f"{self.package}::{name}{part}::{self.member}")


class PythonApiUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of a Python name of another package that may not be the same in all its versions. role: as in ImportUse."""

    use: PythonUse
    at: At
    role: str


class CppApiUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of a C++ name of a package outside of the workspace that only some stored versions of it have, or have in
    this form.

    package, name: as in the surfaces. how: `name`, `call`, `override` or `implement` (of a class that does not).
    arguments, given, templated, sure, through: as in api.Found. role and conditions as in NameUse."""

    package: str
    name: str
    how: str
    arguments: int
    given: tuple[str, ...]
    at: At
    role: str
    sure: bool
    through: tuple[str, ...] = ()
    templated: int = -1
    conditions: tuple[Condition, ...] = ()
    targets: tuple[str, ...] = ()


class SettingUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter that is set for a node or plugin of another package, see settings.py, and that some version of that
    package does not declare. role: as in ImportUse. value: as text, empty where it is not known."""

    name: str
    package: str
    plugin: str
    node: str
    others: tuple[str, ...]
    at: At
    role: str
    value: str = ""


class ValueUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A value that a file of parameters sets for a node or plugin of a package, see settings.py; no text. name,
    package, plugin, node: as in SettingUse. type, text: as GivenValue has them."""

    name: str
    package: str
    plugin: str
    node: str
    at: At
    role: str
    type: str
    text: str


class LostOverrideUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A method that is to override one of a base class of the workspace, and does not. kind, base, method, class_,
    declared, outer: as LostOverride has them."""

    kind: str
    base: str
    method: str
    class_: str
    declared: str
    at: At
    role: str
    conditions: tuple[Condition, ...] = ()
    outer: tuple[str, ...] = ()


class InterfaceClaim(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """An interface of joints that a file of parameters gives a controller. kind: `command` or `state`."""

    controller: str
    kind: str
    interface: str
    joints: tuple[str, ...]
    at: At
    role: str


class BranchedUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What is there in branches on the distro alone, see BranchedName of facts/distro_branches.py. branches: the
    conditions of each after which it can be used."""

    name: str
    at: At
    role: str
    branches: tuple[tuple[Condition, ...], ...]
    function: str = ""
    kind: str = "name"


class AbstractUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A class of which objects are made, and that leaves out a pure virtual method of a base of the workspace. at: the
    class, or where an object is made where another package has it. made: where an object is made; None for a plugin."""

    base: str
    method: str
    class_: str
    declared: str
    at: At
    made: At | None
    role: str
    conditions: tuple[Condition, ...] = ()


class LinkedPackage(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """All that rules ask of one package. Paths are relative to the workspace.

    path: the package's folder, empty for the workspace itself. includes: of C++ files. imports: of Python files, those
    that no module of the package answers. references: what launch files, scripts and URDF mention, of other packages
    and of this one. setup: each setup.py, setup.cfg and pyproject.toml with its path, also those in folders below.
    scripts: Python files whose first line names an interpreter, and that import
    nothing relative to their package, which a program cannot. plain_scripts: those
    whose first line names `python`, of no version. at_home: Python files whose first line names a Python in the home
    folder of a user, and that. imported_beside: the scripts that another
    file of their folder imports by their bare name. shells: shell scripts without an ending. interpreted: names of
    Python files that CMake code gives to an interpreter. tree_nodes: what C++ files tell of nodes of behaviour trees,
    see facts/cpp/tree_nodes.py; trees, modelled: see ReferenceFile.
    """

    name: str
    path: str
    manifest_path: str
    manifest: Manifest
    build_type: str
    build: Build
    includes: tuple[IncludeUse, ...] = ()
    imports: tuple[ImportUse, ...] = ()
    references: tuple[ReferenceUse, ...] = ()
    names: tuple[NameUse, ...] = ()
    needed_headers: tuple[NeededHeader, ...] = ()
    # Of files with needed headers: the includes of other places that reach each source which compiles them; of headers
    # that none does, those that reach themselves.
    reaches: tuple[tuple[str, tuple[tuple[str, ...], ...]], ...] = ()
    # Of headers: the headers of the package that they include.
    inner: tuple[tuple[str, tuple[str, ...]], ...] = ()
    # The same, as they are written.
    written_inner: tuple[tuple[str, tuple[IncludeUse, ...]], ...] = ()
    interfaces: tuple[InterfaceFile, ...] = ()
    syntax: tuple[SyntaxUse, ...] = ()
    headers: tuple[str, ...] = ()
    public_headers: tuple[str, ...] = ()
    modules: tuple[str, ...] = ()
    plugins: tuple[tuple[str, PluginClass], ...] = ()
    registered: tuple[str, ...] = ()
    tree_nodes: TreeNodes = TreeNodes()
    trees: tuple[str, ...] = ()
    modelled: tuple[str, ...] = ()
    setup: tuple[tuple[str, SetupFile], ...] = ()
    allows: tuple[tuple[str, tuple[Allow, ...]], ...] = ()
    problems: tuple[tuple[str, int, str], ...] = ()
    files: tuple[str, ...] = ()
    scripts: tuple[str, ...] = ()
    plain_scripts: tuple[str, ...] = ()
    at_home: tuple[tuple[str, str], ...] = ()
    shells: tuple[str, ...] = ()
    interpreted: tuple[str, ...] = ()
    imported_beside: tuple[str, ...] = ()
    source_targets: tuple[tuple[str, tuple[str, ...]], ...] = ()
    # Declared dependencies and own libraries that words of launch files, YAML or robot descriptions name.
    named: tuple[str, ...] = ()
    # Watched names that the package's own files #define.
    defined: tuple[str, ...] = ()
    # Watched uses, by their labels.
    uses: tuple[NameUse, ...] = ()
    # Functions that a watched use calls and that the package declares itself, a method of its own base class maybe.
    functions: tuple[str, ...] = ()
    # The same of methods in Python.
    methods: tuple[str, ...] = ()
    # Fields and constants of other packages' interfaces that only some versions have.
    members: tuple[MemberUse, ...] = ()
    python_api: tuple[PythonApiUse, ...] = ()
    # C++ names of packages outside of the workspace that only some versions have, or have so.
    cpp_api: tuple[CppApiUse, ...] = ()
    # Members that may be such names, of objects whose type is not known.
    unresolved_receivers: int = 0
    settings: tuple[SettingUse, ...] = ()
    # Names that neither the Python file itself nor the module of the package that it imports them from defines.
    undefined: tuple[ImportUse, ...] = ()
    # What Python code of other packages can import from it.
    python_offer: PythonOffer = PythonOffer()
    # Sources, each with another one that defines a function which it seems to use, and the function.
    own_calls: tuple[tuple[str, str, str], ...] = ()
    # C++ files that define or run tests of gtest.
    testing: tuple[str, ...] = ()
    # Files that name folders of distros.
    distros: tuple[tuple[str, DistroFile], ...] = ()
    # Each requirements.txt, with its path.
    requirements: tuple[tuple[str, RequirementsFile], ...] = ()
    # Includes in compiled files that headers of the package are called like, in folders that no target searches, each
    # with such a header.
    unsearched: tuple[tuple[IncludeUse, str], ...] = ()
    # Classes of the package's headers that compiled sources use without them, each with its header and with all that
    # the source includes from elsewhere.
    unincluded: tuple[tuple[NameUse, str, tuple[str, ...]], ...] = ()
    # Members that methods use and no file of the package declares, each with the bases of the class that are of other
    # packages, and with all that the source includes from elsewhere; where there are such bases, misspelt ones alone.
    undeclared: tuple[tuple[NameUse, tuple[str, ...], tuple[str, ...]], ...] = ()
    own_fields: tuple[FieldOfWorkspace, ...] = ()
    values: tuple[ValueUse, ...] = ()
    # #error lines in files that are compiled, with their messages as names.
    errors: tuple[NameUse, ...] = ()
    # Classes whose bases are classes of the workspace.
    lost_overrides: tuple[LostOverrideUse, ...] = ()
    abstract: tuple[AbstractUse, ...] = ()
    # What robot descriptions give to ros2_control, with their paths.
    controlled_joints: tuple[tuple[str, ControlledJoint], ...] = ()
    # What controllers ask for of it.
    claims: tuple[InterfaceClaim, ...] = ()
    branched: tuple[BranchedUse, ...] = ()
    # What Python and launch files compare ROS_DISTRO with.
    compared: tuple[tuple[str, At], ...] = ()
    # Files that targets compile, each with what it surely uses of libraries that need a link: functions that it calls
    # and classes of which it makes objects.
    compiled: tuple[tuple[str, tuple[str, ...]], ...] = ()


# What no other package is asked about but one that has to do with it, see Workspace.groups: what its code says.
_INWARD = {
    field.name: field.default
    for field in msgspec.structs.fields(LinkedPackage)
    if field.name in {
        "includes", "imports", "needed_headers", "reaches", "inner", "written_inner", "syntax", "allows", "problems",
        "uses", "members", "python_api", "cpp_api", "unresolved_receivers", "undefined", "own_calls", "unsearched",
        "unincluded", "undeclared", "settings", "testing", "python_offer", "values", "errors", "compiled",
        "lost_overrides", "abstract", "claims", "branched", "compared",
    }
}  # fmt: skip


def encode_outline(linked: LinkedPackage) -> bytes:
    """What any package of the workspace may be asked about another one: all but what its code says, of which there are
    the names in its headers alone. Raises UnicodeEncodeError for names that are no UTF-8."""
    names = sorted({use.text for use in linked.names if is_header(use.at.path)})
    return msgspec.msgpack.encode((msgspec.structs.replace(linked, names=(), **_INWARD), names))


BUILD_TOOLS = ("ament_cmake_auto", "ament_cmake", "ament_python", "catkin")
"""Build types that ROS packages declare as tools; `ament_python` is no package."""


def build_type_of(manifest: Manifest, ros: int) -> str:
    """The build type that holds for a ROS generation: `catkin`, `ament_cmake`, `ament_python`, `cmake` ..."""
    fallback = ""
    here = Environment(ros_version=str(ros))
    for kind, condition in manifest.build_types:
        if not condition or holds(Condition("manifest", condition), here):
            return kind
        fallback = fallback or kind
    tools = {
        d.name
        for d in manifest.dependencies
        if d.kind == "buildtool" and (not d.condition or holds(Condition("manifest", d.condition), here) is not False)
    }
    for kind in BUILD_TOOLS:
        if kind in tools:
            return kind.removesuffix("_auto")
    if fallback:
        return fallback
    return "catkin" if manifest.format < 3 or "catkin" in tools else "cmake"


def normalise_stem(path: str) -> str:
    """The name of a file without its ending, as the class that is called like it would be in lower case."""
    return posixpath.basename(path).partition(".")[0].replace("_", "").lower()


def is_called_example(path: str) -> bool:
    """Whether the name of a file calls it an example, a demonstration, a sample or a tutorial."""
    return _ASIDE_NAME.search(path.rsplit("/", 1)[-1].lower()) is not None


def find_folder_role(path: str, module: str = "") -> str | None:
    """`test` or `aside` when a folder of the path says so, else None. Hidden folders hold what development needs. path
    is relative to the package. module: the folder of the package's own module, which may be called like one of tests.
    """
    parts = path.lower().removeprefix(f"{module.lower()}/").split("/")[:-1]
    if any(part in TESTS or part.startswith("test_") or part.endswith("_test") for part in parts):
        return "test"
    name = path.rsplit("/", 1)[-1].lower()
    if name.startswith("test_") or _TEST_NAME.match(name):
        return "test"
    if any(part in ASIDE or part[:1] == "." for part in parts) or is_called_example(name):
        return "aside"
    return None


class Watched(msgspec.Struct, frozen=True, dict=True):
    """The names that rules ask for: bare words, qualified names, heads of qualified names, Python names, and for names
    of the standard library the headers that offer them. modules: labels and patterns of uses in Python, by the
    package that is imported. fields: the table of interfaces. surfaces: what versions of packages offer, as
    surface_store.Surfaces. compiled: gives the names that need a link. parameters: labels and patterns of uses in files
    of parameters. uses: labels and patterns of uses in C++ by a word of each, read when they are asked for."""

    words: frozenset[str] = frozenset()
    qualified: frozenset[str] = frozenset()
    python: frozenset[str] = frozenset()
    headers_of: dict[str, tuple[str, ...]] = {}
    modules: dict[str, list[tuple[str, Pattern]]] = {}
    version: str = ""
    fields: Fields | None = None
    surfaces: Any = None
    compiled: Callable[[], CompiledNames] | None = None
    parameters: list[tuple[str, Pattern]] = []
    uses: Callable[[], Mapping[str, Sequence[tuple[str, Pattern]]]] | None = None

    @cached_property
    def in_tables(self) -> frozenset[str]:
        """Every name of C++ that a table asks for."""
        return self.words.union(self.qualified, self.headers_of)

    @cached_property
    def in_cpp(self) -> UsageTable:
        """What to look for in C++ files."""
        words = {name for name in self.headers_of if "::" not in name}
        return UsageTable(self.uses() if self.uses is not None else {}, self.words | words)

    def make_searches(self) -> dict[str, tuple[str, UsageTable]]:
        """What is looked for in files while their facts are made, since every join asks for it; as gather() has it."""
        return {"cpp": ("searched_cpp", self.in_cpp)}

    @cached_property
    def in_parameters(self) -> Rows[tuple[str, Pattern]]:
        """What to look for in files of parameters."""
        return Rows(self.parameters)

    @cached_property
    def in_python(self) -> dict[str, Rows[tuple[str, Pattern]]]:
        """What to look for in Python files, by the package that they import."""
        return {name: Rows(rows) for name, rows in self.modules.items()}

    @property
    def changing_parameters(self) -> dict[str, frozenset[str]]:
        """As Surfaces.changing_parameters."""
        return self.surfaces.changing_parameters if self.surfaces is not None else {}

    @cached_property
    def changing_python(self) -> Changing | None:
        """Python names that surfaces tell to have changed."""
        from .python.api import Changing

        return Changing(self.surfaces) if self.surfaces is not None else None

    @cache_method
    def describe_name(self, written: str) -> tuple[str, str, tuple[str, ...] | None]:
        """Of a qualified name of C++: the watched name that it is a use of, as meant() says; the name, or the type of
        an interface that it begins with; and the headers one of which has to define that, None where any may."""
        text = written.removeprefix("::")
        headers = self.headers_of.get(text)
        if headers is None and (made := parse_type(text)) is not None:
            return self.find_watched_name(text), made.name, made.headers
        return self.find_watched_name(text), text, headers

    def find_watched_name(self, text: str) -> str:
        """The watched name that a qualified name of C++ is a use of, empty when it is of none. It is its own name where
        a watched bare word ends it."""
        wanted = text
        while wanted not in self.qualified and "::" in wanted:
            wanted = wanted.rpartition("::")[0]
        if wanted not in self.qualified:
            wanted = text if text in self.words or text.rsplit("::", 1)[-1] in self.words else ""
        return wanted


# What a program does with gtest that needs its library.
_OF_TESTS = frozenset(("TEST", "TEST_F", "TEST_P", "TYPED_TEST", "TYPED_TEST_P", "RUN_ALL_TESTS", "InitGoogleTest",
                       "InitGoogleMock"))  # fmt: skip


_CLAIMS = {"command_interfaces": "command", "state_interfaces": "state"}


class PackageJoin:
    """Joins the facts of a package's files. build: what its CMake says. files: all its paths. home: packages of the
    same workspace, which are not looked for in what changed elsewhere. asked: the versions of other packages that
    uses may be wrong in, all when None. changing: C++ names of other packages that are not alike in those. offered:
    headers of other packages of the workspace. offered_read: those that were looked into."""

    def __init__(
        self, place: PackagePlace, manifest: Manifest, build: Build, build_type: str, files: Iterable[str],
        extraction: ExtractedFacts, watched: Watched, home: Collection[str] = frozenset(),
        asked: AskedVersions | None = None, changing: Changes | None = None, offered: OfferedHeaders | None = None,
    ):  # fmt: skip
        self.name, self.path, self.manifest_path = place.name or manifest.name, place.path, place.manifest_path
        self.manifest, self.build, self.build_type, self.files = manifest, build, build_type, tuple(files)
        self.generation = 2 if build_type.startswith("ament") else 1 if build_type == "catkin" else 0
        self.kinds, self.facts, self.look = extraction.kinds, extraction.get_facts, extraction.look
        self.watched, self.home, self.asked, self.changing, self.offered = watched, home, asked, changing, offered
        self.offered_read: set[str] = set()
        self.prefix = f"{self.path}/" if self.path else ""
        self.cpp: dict[str, CppFile] = {}
        self.searched: Mapping[str, SearchedCpp] = {}
        self.python_methods: set[str] = set()
        self.by_name: dict[str, list[str]] = {}
        self.resolved: dict[str, list[tuple[str | None, Include]]] = {}
        # Python files that run since a launch file or script of the package starts them, and what they import.
        self.started: set[str] = set()
        self.interpreted: set[str] = set()
        self.setup: tuple[tuple[str, SetupFile], ...] = ()
        self.macros = Macros((), ())
        self.unresolved_receivers = 0
        self._vocabulary: Vocabulary | None = None

    def strip_prefix(self, path: str) -> str:
        return path[len(self.prefix) :]

    def list_inner_includes(self, path: str) -> tuple[IncludeUse, ...]:
        """The includes of a header that files of the package answer."""
        return tuple(
            IncludeUse(i.path, At(path, i.line, i.column), "", True, i.conditions, angled=i.angled)
            for to, i in self.resolved.get(path, ())
            if to is not None
        )

    def build_package(self) -> LinkedPackage:
        """All that rules ask of the package."""
        allows, problems, distros = [], [], []
        of_tests = self.name.startswith("test_") or self.name.endswith(("_test", "_tests"))
        # Files whose references nobody follows where the package is used.
        unused = set(self.files) if of_tests else set()
        # What the launch system or shell of this generation refuses: from before a migration, or for the other build of
        # a package for both generations. Its tests run nowhere.
        leftover: set[str] = set()
        python: dict[str, PythonFile] = {}
        interpreted = self.interpreted
        shells: list[str] = []
        parameters: list[str] = []
        launches: list[tuple[str, str]] = []
        data_words: list[str] = []
        references, plugins, registered, setup, requirements, interfaces = [], [], [], [], [], []
        controlled: list[tuple[str, ControlledJoint]] = []
        branched: list[tuple[str, BranchedName]] = []
        compared: list[tuple[str, ComparedDistro]] = []
        tree_nodes: list[TreeNodes] = []
        trees: set[str] = set()
        modelled: set[str] = set()
        for path in self.files:
            kind = self.kinds.get(path)
            if kind is None:
                continue
            file = self.facts(path)
            if file is None:
                continue
            if file.allows:
                allows.append((path, file.allows))
            if file.distros is not None:
                distros.append((path, file.distros))
            facts = file.facts
            if facts is None:
                continue
            if file.kind == "shell" and "." not in posixpath.basename(path):
                shells.append(path)
            problems.extend((path, problem.line, problem.message) for problem in facts.problems)
            if isinstance(facts, CppFile):
                self.cpp[path] = facts
                registered.extend(getattr(facts, "exports", ()))
                if facts.tree_nodes is not None:
                    beside = find_folder_role(self.strip_prefix(path)) is not None
                    tree_nodes.append(mark_extended(facts.tree_nodes) if beside else facts.tree_nodes)
                references.extend((path, r) for r in getattr(facts, "references", ()))
            elif isinstance(facts, PythonFile):
                python[path] = facts
                branched.extend((path, one) for one in facts.branched)
                compared.extend((path, one) for one in facts.compared)
                references.extend((path, r) for r in facts.references)
                if any(item.module.split(".")[0] == "launch_ros" for item in facts.imports):
                    launches.append((path, "launch_python"))
                    data_words.append(facts.words)
                    if self.generation == 1:
                        leftover.add(path)
            elif isinstance(facts, Interface):
                name = facts.name or posixpath.basename(path).rsplit(".", 1)[0]
                interfaces.append(InterfaceFile(name, path, facts))
            elif isinstance(facts, SetupFile):
                setup.append((path, facts))
            elif isinstance(facts, RequirementsFile):
                requirements.append((path, facts))
            elif isinstance(facts, CMakeFile):
                interpreted.update(_list_interpreted(facts))
            else:
                data_words.append(getattr(facts, "words", ""))
                if kind in ("params", "launch_yaml"):
                    parameters.append(path)
                if kind in ("launch_xml", "launch_yaml"):
                    launches.append((path, kind))
                if {getattr(facts, "generation", 0), self.generation} == {1, 2}:
                    leftover.add(path)
                references.extend((path, r) for r in getattr(facts, "references", ()))
                plugins.extend((path, p) for p in getattr(facts, "plugins", ()))
                trees.update(getattr(facts, "trees", ()))
                modelled.update(getattr(facts, "modelled", ()))
                controlled.extend((path, joint) for joint in getattr(facts, "joints", ()))
                branched.extend((path, one) for one in getattr(facts, "branched", ()))
                compared.extend((path, one) for one in getattr(facts, "compared", ()))
        unused |= leftover
        if self.build_type == "catkin":  # which starts programs from the source space too
            own = (r for p, r in references if r.package == self.name and self.find_role(p) is None)
            names = {r.name for r in own if r.kind == "executable"}
            if not self.build.installs and not self.manifest.metapackage:  # there alone
                programs = (p for p, f in python.items() if f.interpreter and not _is_part(f))
                names.update(posixpath.basename(p) for p in programs if self.find_role(p) is None)
            self.start_scripts(python, names)
        elif self.build_type == "ament_python":
            self.setup = tuple(setup)
            own = (reference for _, reference in references if reference.package == self.name)
            self.start_scripts(python, {posixpath.basename(reference.name) for reference in own})
        table = self.watched.in_cpp
        if table.patterns or table.words:
            self.searched = self.look(self.cpp, "searched_cpp", table)
        links = {target.name: {link.item for link in target.links} for target in self.build.targets}
        self.macros = Macros(self.build.macros, {name for facts in self.cpp.values() for name in facts.defined}, links)
        roles = self.compute_roles()
        includes, names, needed = self.collect_sources(roles)
        imports, python_names, syntax, modules = self.collect_python(python)
        by_commands = (path for use in self.build.uses for path in use.makes)
        # A library called like the folder of modules that it lies in may be one of them.
        extensions = [f"{t.output_name or t.name}.so" for t in self.build.targets if t.kind in ("library", "module")]
        made = modules.union(part for path in by_commands for part in path.split("/"))
        made.update(posixpath.basename(path)[:-3] for path in self.build.made if path.endswith(".py"))
        run_setup = {
            path: file.python
            for path, file in (setup if self.build_type in ("ament_python", "catkin") else ())
            if self.strip_prefix(path) == "setup.py" and file.python is not None
        }
        for path, facts in run_setup.items():
            syntax.extend(_list_syntax(path, "build", facts))

        roots, programs = self.list_python_roots(setup), set(self.list_programs())
        uses = [*self.list_uses(roles), *self.list_python_uses(python), *self.list_parameter_uses(parameters)]
        lost_overrides, abstract = self.read_own_classes(roles)
        return LinkedPackage(
            self.name,
            self.path,
            self.manifest_path,
            self.manifest,
            self.build_type,
            self.build,
            includes=tuple(includes),
            imports=tuple(imports),
            references=tuple(
                ReferenceUse(r, At(p, r.line, r.column), self.find_role(p) or ("aside" if p in unused else "run"))
                for p, r in references
                if p not in leftover or self.find_role(p) != "test"
            ),
            names=tuple(names + python_names),
            needed_headers=tuple(needed),
            reaches=tuple(self.compute_reaches(dict.fromkeys(n.at.path for n in needed), roles).items()),
            inner=tuple(
                (path, inner)
                for path, found in self.resolved.items()
                if is_header(path) and (inner := tuple(to for to, _ in found if to is not None))
            ),
            written_inner=tuple(
                (path, written) for path in roles if is_header(path) and (written := self.list_inner_includes(path))
            ),
            interfaces=tuple(interfaces),
            syntax=tuple(syntax),
            headers=tuple(p for p in self.cpp if is_header(p)),
            public_headers=tuple(p for p, r in roles.items() if r[1] and is_header(p)),
            modules=tuple(sorted(modules)),
            plugins=tuple(plugins),
            registered=tuple(registered),
            tree_nodes=merge_tree_nodes(tree_nodes),
            trees=tuple(sorted(trees)),
            modelled=tuple(sorted(modelled)),
            testing=tuple(path for path in self.cpp if not _OF_TESTS.isdisjoint(self.list_words(path))),
            setup=tuple(setup),
            allows=tuple(allows),
            problems=tuple(problems),
            files=self.files,
            scripts=tuple(p for p, f in python.items() if f.interpreter and not _is_part(f)),
            plain_scripts=tuple(p for p, f in python.items() if _PLAIN_PYTHON.match(f.interpreter) and not _is_part(f)),
            at_home=tuple((p, found[1]) for p, f in python.items() if (found := _PYTHON_AT_HOME.match(f.interpreter))),
            shells=tuple(shells),
            interpreted=tuple(sorted(interpreted)),
            imported_beside=_list_imported_beside(python),
            named=self.find_named(data_words),
            defined=tuple(sorted(self.list_defined_names())),
            source_targets=tuple((p, r[2]) for p, r in roles.items() if r[2]),
            uses=tuple(uses),
            functions=tuple(sorted({name for found in self.searched.values() for name in found.functions})),
            methods=tuple(sorted(self.python_methods)),
            members=(*self.list_member_uses(roles), *self.list_python_member_uses(python)),
            python_api=tuple(self.list_python_api_uses(python)),
            cpp_api=tuple(self.list_cpp_api_uses(roles)),
            undefined=tuple(
                self.make_import_use(p, i)
                for p, i in (
                    *list_undefined(python, made, (*self.files, *extensions)),
                    *list_undefined(run_setup, (), ()),
                    *list_undefined_functions(python, setup),
                    *list_above(python, roots, programs),
                    *list_called_by_path(python, self.path, roots, programs | self.started),
                    *list_siblings(python, setup),
                    *list_unlisted(python, [(p, f) for p, f in setup if p in run_setup]),
                )
            ),
            python_offer=offer_python(python, made, self.files, roots),
            own_calls=tuple(self.list_own_calls(roles)),
            unresolved_receivers=self.unresolved_receivers,
            settings=tuple(self.list_settings(parameters, launches)),
            values=tuple(self.list_values(parameters, launches)),
            errors=tuple(self.list_errors(roles)),
            compiled=tuple(self.list_compiled(roles)),
            distros=tuple(distros),
            requirements=tuple(requirements),
            unsearched=tuple(self.list_unsearched(roles)),
            unincluded=tuple(self.list_unincluded(roles)),
            undeclared=tuple(self.list_undeclared(roles)),
            lost_overrides=tuple(lost_overrides),
            abstract=tuple(abstract),
            controlled_joints=tuple(controlled),
            claims=tuple(self.list_claims(parameters)),
            branched=tuple(
                BranchedUse(one.name, At(path, one.line, one.column),
                            self.find_python_role(path) if path in python
                            else self.find_role(path) or ("aside" if path in unused else "run"),
                            tuple(branch.conditions for branch in one.branches), one.function, one.kind)
                for path, one in branched
            ),
            compared=tuple((one.name, At(path, one.line, one.column)) for path, one in compared),
            own_fields=tuple(
                FieldOfWorkspace(
                    use.type, use.steps, At(path, use.line, use.column), self.find_python_role(path), use.conditions
                )
                for path, facts in python.items()
                for use in facts.fields
                if use.type.partition(".")[0] in self.home
            ),
        )

    def find_included_file(self, include: str, includer: str) -> str | None:
        """The file of the package that an include names, or None."""
        if include.startswith("."):
            wanted = posixpath.normpath(posixpath.join(posixpath.dirname(includer), include))
            return wanted if wanted in self.cpp else None
        candidates = self.by_name.get(include.rsplit("/", 1)[-1], ())
        if not candidates:
            return None
        beside = posixpath.join(posixpath.dirname(includer), include)
        for path in (beside, f"{beside}.in"):
            if path in self.cpp:
                return path
        ending = "/" + include
        for path in candidates:
            plain = path.removesuffix(".in")
            if (plain.endswith(ending) or plain == include) and not self._is_copy(plain, include):
                return path
        return None

    def _is_copy(self, path: str, include: str) -> bool:
        """Whether a file is called like a header of another package of the workspace, and lies in no folder that a
        target searches."""
        head = include.partition("/")[0]
        return head != self.name and head in self.home and path.removesuffix(include).rstrip("/") not in self._folders

    @cached_property
    def _folders(self) -> frozenset[str]:
        """The folders that targets are given to search for headers."""
        items = [item for item, _ in self.build.include_dirs]
        items += [link.item for link in self.build.target_links if link.how == "include"]
        return frozenset(posixpath.normpath(item).removeprefix(".") for item in items)

    def compute_roles(self) -> dict[str, tuple[str, bool, tuple[str, ...], tuple[Condition, ...]]]:
        """For every C++ file that something reaches: role, public, the targets that compile it, their conditions."""
        self.by_name = group_pairs((path.rsplit("/", 1)[-1].removesuffix(".in"), path) for path in self.cpp)
        for path, facts in self.cpp.items():
            self.resolved[path] = [(self.find_included_file(i.path, path), i) for i in facts.includes]
        roots = group_pairs(
            (source, target) for target in self.build.targets for source in target.sources if source in self.cpp
        )
        reached: dict[str, tuple[str, bool, set[str], list]] = {}

        def walk(path: str, role: str, public: bool, names: tuple[str, ...], conditions) -> None:
            stack = [(path, conditions)]
            seen: dict[str, tuple[Condition, ...]] = {}
            while stack:
                at, under = stack.pop()
                if at in seen and (public or set(seen[at]) <= set(under)):
                    continue
                seen[at] = under
                known = reached.get(at)
                if known is None:
                    reached[at] = (role, public, set(names), list(under))
                else:
                    merged = role if known[0] == role else "build"
                    kept = known[3] if public else _merge_conditions(known[3], under)  # installing builds nothing
                    reached[at] = (merged, known[1] or public, known[2] | set(names), kept)
                for to, include in self.resolved.get(at, ()):
                    if to is not None:
                        around = self.macros.resolve_conditions(include.conditions, names)
                        stack.append((to, under + around if around else under))

        # A header among the sources of a target is compiled with the sources that include it, and not for itself.
        for source, targets in sorted(roots.items(), key=lambda root: is_header(root[0])):
            if is_header(source) and source in reached:
                continue
            inside = find_folder_role(self.strip_prefix(source))
            for target in targets:
                role = "test" if target.kind == "test" or inside == "test" else "build"
                if role == "build" and any(
                    "BUILD_TESTING" in c.text or "ENABLE_TESTING" in c.text for c in target.conditions
                ):
                    role = "test"
                own = next((conditions for path, conditions in target.guarded if path == source), ())
                names = () if is_header(source) else (target.name,)
                walk(source, role, False, names, target.conditions + own)
        for header, conditions in self.list_installed_headers():
            walk(header, "build", True, (), conditions)
        return {p: (r[0], r[1], tuple(sorted(r[2])), tuple(r[3])) for p, r in reached.items()}

    def list_own_calls(self, roles) -> Iterator[tuple[str, str, str]]:
        """As LinkedPackage.own_calls."""
        from .cpp.own_calls import list_own_calls

        targets = {path: role[2] for path, role in roles.items() if role[2]}
        sources = {path: targets.get(path, ()) for path in self.cpp if not is_header(path)}
        if len(set(sources.values())) < 2 or self.build.unresolved:
            return

        def list_included(path: str) -> Collection[str]:
            # What nothing compiles may belong to something that is not built here.
            return {to for to, i in self.resolved.get(path, ()) if to is not None and not i.conditions}

        find_linked = cache(self.build.find_linked)

        def may_lack(path: str, other: str) -> bool:
            return any(each.isdisjoint(sources[other]) for each in filter(None, map(find_linked, sources[path])))

        declared = partial(self.look, kind="called_cpp")
        yield from list_own_calls(sources, list_included, self.list_words, may_lack, declared)

    def list_installed_headers(self) -> Iterator[tuple[str, tuple[Condition, ...]]]:
        """The headers that are installed, each under what all rules that install it have in common."""
        folders, single = [], {}
        for rule in self.build.installs:
            if rule.kind == "directory" and "include" in rule.destination.lower():
                folders.extend((f"{item.rstrip('/')}/".lstrip("/"), rule.conditions) for item in rule.items)
            elif rule.kind == "files":
                for item in rule.items:
                    single.setdefault(item, []).append(rule.conditions)
        for path in filter(is_header, self.cpp):
            around = [*single.get(path, ()), *(held for folder, held in folders if path.startswith(folder))]
            if around:
                yield path, tuple(c for c in around[0] if all(c in other for other in around))

    def list_unsearched(self, roles) -> Iterator[tuple[IncludeUse, str]]:
        """As LinkedPackage.unsearched. What is reached only through a header of which another file may be meant does
        not count."""
        sources = {one for target in self.build.targets for one in target.sources if one in self.cpp}
        surely = set(walk(sources, self._list_searched)) | sources
        for path, (role, public, targets, conditions) in roles.items():
            for to, include in self.resolved.get(path, ()) if targets and path in surely else ():
                if to is None or self._is_searched(path, to, include):
                    continue
                around = conditions + self.macros.resolve_conditions(include.conditions, targets)
                at = At(path, include.line, include.column)
                yield IncludeUse(include.path, at, role, public, around, targets, angled=include.angled), to

    def _list_searched(self, path: str) -> Iterator[str]:
        """The files that the includes of a file are resolved to, where compilers find them."""
        found = self.resolved.get(path, ())
        return (to for to, include in found if to is not None and self._is_searched(path, to, include))

    def _is_searched(self, path: str, to: str, include: Include) -> bool:
        """Whether the compiler finds the file that an include is resolved to, beside the one that has it or in a folder
        that it is told to search, or that cannot be known."""
        ending = f"/{include.path}"
        if include.path.startswith(".") or to.endswith(".in"):
            return True
        if f"/{to}".removesuffix(ending).lstrip("/") in self._folders:
            return True  # as most are, so that no other file is looked at
        if to == posixpath.normpath(posixpath.join(posixpath.dirname(path), include.path)):
            return True
        same = (f"/{file.removesuffix('.in')}" for file in self.by_name[posixpath.basename(include.path)])
        roots = {one.removesuffix(ending).lstrip("/") for one in same if one.endswith(ending)}
        return not roots.isdisjoint(self._folders)

    def list_unincluded(self, roles) -> Iterator[tuple[NameUse, str, tuple[str, ...]]]:
        """As LinkedPackage.unincluded. A header counts that is called like its class, or the only one of a class whose
        members the source defines."""
        headers: dict[str, list[str]] = {}
        for path in filter(is_header, self.cpp):
            for word in self.cpp[path].type_names:
                headers.setdefault(word, []).append(path)
        alike = {
            word: [path for path in paths if normalise_stem(path) == word.lower()]
            for word, paths in headers.items()
            if len(word) > 5
        }
        inner = {to for resolved in self.resolved.values() for to, _ in resolved}
        for path, (role, _, targets, conditions) in roles.items() if headers else ():
            if not targets or is_header(path) or path in inner or self._includes_template(path):
                continue
            scopes = {part for use in self.cpp[path].qualified for part in use.text.split("::")[:-1]}
            for word in sorted(headers.keys() & self.list_words(path)):
                found = alike.get(word) or (headers[word] if word in scopes and len(headers[word]) == 1 else ())
                if not found or not {*headers[word]}.isdisjoint(self.list_reached(path)):
                    continue
                anyhow = bool(alike.get(word)) and self._lacks_class(path, word)
                if not anyhow and (word not in scopes or not self._lacks_class(path, word, True)):
                    continue
                spot = next(self._find_class_uses(path, word, anyhow), None)
                if spot is not None:
                    around = conditions + self.macros.resolve_conditions(spot.conditions or (), targets)
                    use = NameUse(word, At(path, spot.line, spot.column), role, False, "cpp", around, targets)
                    yield use, found[0], self.list_outward(path)

    def _includes_template(self, path: str) -> bool:
        """Whether a source includes a header that CMake makes of a template, which may declare anything."""
        return any(at.endswith(".in") for at in self.list_reached(path))

    def _lacks_class(self, path: str, word: str, announced: bool = False) -> bool:
        """Whether nothing of the workspace that a source includes says what a class is, nor may it be another one.
        announced: it may say that there is such a class."""
        for file in map(self.load, (*self.list_reached(path), *self.list_offered(path))):
            told = word in file.type_names if announced else file.declares_type(word)
            if told or word in (*file.facts.defined, *file.facts.namespaces):
                return False
        known = self.load(path)
        own = {space for at in self.cpp.values() for space in at.namespaces}
        return word not in known.using and own.union(("std",)).issuperset(
            space.partition("::")[0] for space in known.facts.opened
        )

    def _find_class_uses(self, path: str, word: str, anyhow: bool) -> Iterator[CodeSpot]:
        """Where a source defines members of a class; anyhow: or has some of its type, makes objects of it, or uses it
        as a scope; to a macro, a name can be anything."""
        known = self.load(path)
        defined = any(found.scope.rpartition("::")[2] == word for found in known.declarations.names)
        if not defined and not anyhow:
            return
        alone = re.compile(rf"(?<![\w:]){word}(?!\w)")
        members = (one for own in known.declarations.classes for same in own.members.values() for one in same)
        has_member = any(one.kind == "variable" and alone.search(one.type) for one in members)
        for use in known.list_uses(known.list_mentions((word,))):
            bare = use.form == "bare"
            used = use.made if not bare else use.made or not use.last or has_member
            own = bare or use.name.partition("::")[0] in self._own_spaces
            used = own and anyhow and used and use.local is None
            if used or (bare and defined and not use.last and not use.place.function):
                yield use.at

    @cached_property
    def _own_spaces(self) -> frozenset[str]:
        """First parts of the namespaces of its files."""
        return frozenset(space.partition("::")[0] for at in self.cpp.values() for space in at.namespaces)

    def list_undeclared(self, roles) -> Iterator[tuple[NameUse, tuple[str, ...], tuple[str, ...]]]:
        """As LinkedPackage.undeclared: words that end with an underscore, in sources that define no class."""
        for path, (role, _, targets, conditions) in roles.items():
            if not targets or is_header(path) or self.cpp[path].type_names or self._includes_template(path):
                continue
            others = [self.list_words(at) for at in (*self.list_reached(path)[1:], *self.list_offered(path))]
            ending = (word for word in self.list_words(path) if word.endswith("_") and len(word) > 4)
            words = {word for word in ending if others and word[0].islower() and not any(word in one for one in others)}
            if not words:
                continue
            known, uses = self.load(path), {}
            for use in known.list_uses(known.list_mentions(sorted(words - known.defines - {*self.cpp[path].defined}))):
                uses.setdefault(use.word, []).append(use)
            for word, same in uses.items():
                first, plain = same[0], all(one.form == "bare" and one.last and one.call is None for one in same)
                if not plain or any(one.local is not None or not one.place.owner for one in same):
                    continue
                bases = self._list_outer_bases(path, first.place.owner)
                if bases is not None and (not bases or self._has_alike(path, first.place.owner, word)):
                    around = conditions + self.macros.resolve_conditions(first.at.conditions or (), targets)
                    at = At(path, first.at.line, first.at.column)
                    use = NameUse(word, at, role, False, "cpp", around, targets, first.place.owner)
                    yield use, bases, self.list_outward(path)

    def read_own_classes(self, roles) -> tuple[list[LostOverrideUse], list[AbstractUse]]:
        """As LinkedPackage.lost_overrides and LinkedPackage.abstract."""
        lost: list[LostOverrideUse] = []
        left_out: dict[str, list[LeftOut]] = {}
        for path, (role, _, targets, conditions) in roles.items():
            facts = self.cpp.get(path)
            if not targets or facts is None or not facts.parents:
                continue
            types = {word for at in self._list_around(path) for word in self.load(at).type_names}
            derived = {last for last, words in facts.parents if not (types - {last}).isdisjoint(words.split())}
            if not derived:
                continue
            classes = self._find_own_classes(path)
            for class_ in self.load(path).declarations.classes:
                if class_.name.rpartition("::")[2] not in derived or class_.specialised:
                    continue
                for found in classes.list_lost_overrides(class_):
                    around = conditions + self.macros.resolve_conditions(found.spot.conditions or (), targets)
                    at = At(path, found.spot.line, found.spot.column)
                    lost.append(LostOverrideUse(found.kind, found.base, found.method, found.class_, found.declared, at,
                                                role, around, found.outer))  # fmt: skip
                left_out[class_.name] = list(classes.list_left_out(class_, path))
        return lost, list(self._list_abstract(roles, {name: found for name, found in left_out.items() if found}))

    def _list_abstract(self, roles, left_out: Mapping[str, list[LeftOut]]) -> Iterator[AbstractUse]:
        """left_out: by the class that has no such method."""
        lasts = {name.rpartition("::")[2] for name in left_out}
        seen: set[str] = set()
        for path, (role, _, targets, conditions) in roles.items() if left_out else ():
            if not targets or path not in self.cpp or lasts.isdisjoint(self.list_words(path)):
                continue
            for name, spot in self._find_own_classes(path).list_made(lasts, self.cpp[path].exports):
                if name not in left_out or name in seen or (spot is not None and spot.conditions is None):
                    continue
                seen.add(name)
                around = spot.conditions or () if spot is not None else ()
                around = conditions + self.macros.resolve_conditions(around, targets)
                made = At(path, spot.line, spot.column) if spot is not None else None
                for found in left_out[name]:
                    at = At(found.path, found.spot.line, found.spot.column)
                    yield AbstractUse(found.base, found.method, name, found.declared, at, made, role, around)

    def _list_around(self, path: str) -> list[str]:
        """A C++ file, and the headers of the workspace that it reaches."""
        own = (at for at in self.list_reached(path) if at != path and at in self.cpp)
        return [path, *own, *self.list_offered(path)]

    @cache_method
    def _find_own_classes(self, path: str) -> OwnClasses:
        from .cpp.own_classes import ClassFile, OwnClasses
        from .cpp.resolver import Resolver

        files = [ClassFile(at, self.load(at)) for at in self._list_around(path)]
        return OwnClasses(files, Resolver([file.known for file in files], None, None), self._count_classes)

    @cache_method
    def _count_classes(self, name: str) -> int:
        """How many definitions of a class the package has."""
        last = name.rpartition("::")[2]
        known = (self.load(path) for path, facts in self.cpp.items() if last in facts.type_names)
        return sum(one.name == name for file in known for one in file.list_classes(last))

    def _has_alike(self, path: str, owner: str, word: str) -> bool:
        """Whether a class has a member that a word may stand for: one letter off, or shortened."""
        last = owner.rpartition("::")[2]
        classes = (one for at in self.list_reached(path) for one in self.load(at).list_classes(last))
        names = {name for one in classes for name in one.members if name.endswith("_") and len(name) > 4}
        stem = word.rstrip("_")
        return any(is_slip(word, name) or stem.startswith(name[:-1]) or name.startswith(stem) for name in names)

    def _list_outer_bases(self, path: str, owner: str) -> tuple[str, ...] | None:
        """The bases of a class, of their bases too, that no file which a source reaches defines; None where the class
        is not fully known."""
        last, outer, seen = owner.rpartition("::")[2], [], {owner.rpartition("::")[2]}
        waiting = [last]
        while waiting:
            word = waiting.pop()
            found = [one for at in self.list_reached(path) for one in self.load(at).list_classes(word)]
            if len(found) != 1 or found[0].open or found[0].template:
                return None
            for base in found[0].bases:
                name = base.rpartition("::")[2]
                own = [one for at in self.list_reached(path) for one in self.load(at).list_classes(name)]
                if "<" in base or "$" in base:
                    return None
                if not any(f"::{one.name}".endswith(f"::{base.removeprefix('::')}") for one in own):
                    outer.append(base)
                elif name not in seen:
                    seen.add(name)
                    waiting.append(name)
        return tuple(outer)

    def collect_sources(self, roles):
        includes: list[IncludeUse] = []
        names: list[NameUse] = []
        needed: list[NeededHeader] = []
        watched = self.watched
        # What the package defines itself is its own, whatever a library of that name did.
        defined = {name for facts in self.cpp.values() for name in facts.defined}.union(self.own_constants)
        for path, (role, public, targets, conditions) in roles.items():
            facts = self.cpp.get(path)
            if facts is None:
                continue
            for to, include in self.resolved[path]:
                if to is None:
                    includes.append(
                        IncludeUse(include.path, At(path, include.line, include.column), role, public,
                                   conditions + self.macros.resolve_conditions(include.conditions, targets), targets,
                                   self.is_idle(include.path), include.angled)
                    )  # fmt: skip
            types = set()
            for name in facts.qualified:
                wanted, text, headers = watched.describe_name(name.text)
                if wanted:
                    names.append(NameUse(wanted, At(path, name.line, name.column), role, public, "cpp",
                                         conditions + self.macros.resolve_conditions(name.conditions, targets),
                                         targets))  # fmt: skip
                if headers is None or text in types:
                    continue
                if parse_type(text) is not None:
                    types.add(text)
                if self.list_reaching_paths(path).isdisjoint(headers) and not self.declares(path, text):
                    around = conditions + self.macros.resolve_conditions(name.conditions, targets)
                    std = text.startswith("std::") and text not in _ANNOUNCED
                    whole = std or text in facts.variables
                    needed.append(NeededHeader(text, At(path, name.line, name.column), role, around, whole))
            found = self.searched.get(path)
            for word in found.words if found is not None else ():
                if word.text in defined:
                    continue
                if word.text in watched.words and not word.own:
                    names.append(self.make_bare_use(word, path, role, public, targets, conditions))
                headers = watched.headers_of.get(word.text)
                if headers is not None and self.list_reaching_paths(path).isdisjoint(headers):
                    at = At(path, word.line, word.column)
                    around = conditions + self.macros.resolve_conditions(word.conditions, targets)
                    needed.append(NeededHeader(word.text, at, role, around, not word.in_macro))
        return includes, names, needed

    @cached_property
    def qualified(self) -> frozenset[str]:
        """The qualified names and namespaces in C++ files."""
        names = {name.text for facts in self.cpp.values() for name in facts.qualified}
        names.update(name for facts in self.cpp.values() for name in (*facts.using, *facts.opened, *facts.namespaces))
        names.update(space for facts in self.cpp.values() for _, space in facts.spaces)
        return frozenset(name.removeprefix("::") for name in names)

    @cached_property
    def spaces(self) -> frozenset[str]:
        """First parts of the qualified names and namespaces in C++ files."""
        return frozenset(name.partition("::")[0] for name in self.qualified)

    @cache_method
    def is_idle(self, path: str) -> bool:
        """Whether no C++ file names anything of the namespace, or a macro, that the first folder of an included header
        is called after; of a standard header whose names are known, any of these."""
        if offered := list_own_names(path):
            opened = "std" in self.qualified
            words = {name.rpartition("::")[2] for name in offered} if opened else ()
            if any(name.startswith(offered) for name in self.qualified):
                return False
            return not any(word in facts.words for facts in self.cpp.values() for word in words)
        space = path.partition("/")[0]
        macro = f"{space.upper()}_"
        return space not in self.spaces and not any(macro in facts.words for facts in self.cpp.values())

    @property
    def own_constants(self) -> frozenset[str]:
        """Words of a table that the package calls constants of its own, as macros are called."""
        words = (word for found in self.searched.values() for word in found.words)
        return frozenset(word.text for word in words if word.own and word.text.isupper())

    def list_defined_names(self) -> Iterator[str]:
        """Macros and types that the package defines and that somebody asks about: names of a table, and those in a
        namespace that is called like another package, one whose versions are stored or a declared one."""
        asked, surfaces = self.watched.in_tables, self.watched.surfaces
        stored = surfaces.packages if surfaces is not None else frozenset()
        declared = {dependency.name for dependency in self.manifest.dependencies}
        names = {name for facts in self.cpp.values() for name in (*facts.defined, *facts.types)}
        for name in names.union(self.own_constants):
            head = name.partition("::")[0]
            if name in asked or (head != self.name and (head in stored or head in declared)):
                yield name

    def list_uses(self, roles) -> Iterator[NameUse]:
        """Every use that some table row is about, in files that something compiles."""
        members = {label for rows in self.watched.in_cpp.patterns.values() for label, one in rows if one.shows_no_class}
        for path, (role, public, targets, conditions) in roles.items():
            found = self.searched.get(path)
            words = {one.label for one in found.uses} & members if found is not None else ()
            strange = self._list_strange_calls(path, words, roles) if words else frozenset()
            for use in found.uses if found is not None else ():
                if use.label in members and (use.line, use.column) in strange:
                    continue
                if use.label.startswith("std::") and self._brings_into_std(path, use.label):
                    continue
                yield NameUse(use.label, At(path, use.line, use.column), role, public, "cpp",
                              conditions + self.macros.resolve_conditions(use.conditions, targets), targets,
                              f"<{use.types}>".join(_OPEN_TYPES.split(use.label)))  # fmt: skip

    def _list_strange_calls(self, path: str, labels: Collection[str], roles) -> Collection[tuple[int, int]]:
        """Where a file calls methods that rows with some labels are about, of objects of other classes."""
        from ..targets.changes import load_uses
        from .cpp.receivers import Receivers
        from .cpp.resolver import Resolver

        vocabulary = self._find_vocabulary(roles)
        if vocabulary is None:
            return ()
        patterns = [row for rows in self.watched.in_cpp.patterns.values() for row in rows if row[0] in labels]
        known = load_uses()
        of_libraries = {pattern.word for label, pattern in patterns if label not in known or known[label].library}
        files = (path, *sorted(to for to in self.list_reached(path) if to != path and to in self.cpp))
        resolver = Resolver([*map(self.load, files), *map(self.load, self.list_offered(path))], vocabulary, None)
        declared = {dependency.name for dependency in self.manifest.dependencies}
        receivers = Receivers(resolver, frozenset({*declared, *self.home, self.name}))
        return receivers.list_strange_calls({pattern.word for _, pattern in patterns}, of_libraries)

    def list_errors(self, roles) -> Iterator[NameUse]:
        """The #error lines of files that targets compile."""
        for path, (role, public, targets, conditions) in roles.items():
            facts = self.cpp.get(path)
            for use in facts.errors if facts is not None and targets else ():
                around = conditions + self.macros.resolve_conditions(use.conditions, targets)
                yield NameUse(use.text, At(path, use.line, use.column), role, public, "cpp", around, targets)

    def list_compiled(self, roles) -> Iterator[tuple[str, tuple[str, ...]]]:
        """As LinkedPackage.compiled."""
        load = self.watched.compiled
        for path, (_, _, targets, _) in roles.items() if load is not None else ():
            facts = self.cpp.get(path)
            if facts is None or not targets or load is None:
                continue
            known = load()
            made = {*facts.variables, *facts.made}
            found = {
                name.text
                for name in facts.qualified
                if not name.conditions
                and (name.text in known.functions or (name.text in known.classes and name.text in made))
            }
            found.update(_list_alternatives(facts, known))
            if not known.words.isdisjoint(words := facts.words.split(" ")):
                found.update(known.words.intersection(words).difference(facts.defined))
            if found:
                yield path, tuple(sorted(found))

    def _brings_into_std(self, path: str, label: str) -> bool:
        """Whether a file, or a header of the package that it reaches, adds a namespace of the package to `std` in which
        the name that stands first in a label may be."""
        named = _STD_NAME.match(label)
        if named is None:
            return False
        added = {
            space.removeprefix("::")
            for at in self.list_reached(path)
            if at in self.cpp and "std" in self.cpp[at].namespaces
            for space in self.cpp[at].opened
        }
        return bool(added) and any(
            not added.isdisjoint(facts.namespaces) and named[1] in facts.type_names for facts in self.cpp.values()
        )

    def find_named(self, texts: Iterable[str]) -> tuple[str, ...]:
        """The declared dependencies, and libraries of the package, that stand among the words of files."""
        declared = {dependency.name for dependency in self.manifest.dependencies}
        declared.update(target.name for target in self.build.targets if target.kind == "library")
        return tuple(sorted({name for text in texts for name in declared.intersection(text.split(" "))}))

    def list_python_uses(self, files: dict[str, PythonFile]) -> Iterator[NameUse]:
        """The same in Python files that import the package which the row is about."""
        importing: dict[str, list[str]] = {}
        for path, facts in files.items():
            imported = {item.module.split(".")[0] for item in facts.imports if not item.level}
            for package in imported & self.watched.modules.keys():
                importing.setdefault(package, []).append(path)
        found = {p: self.look(paths, "searched_text", self.watched.in_python[p]) for p, paths in importing.items()}
        self.python_methods.update(name for each in found.values() for one in each.values() for name in one.functions)
        for path in files:
            for package in sorted(found):
                yield from self.list_text_uses(path, "python", found[package])

    def list_parameter_uses(self, paths: Collection[str]) -> Iterator[NameUse]:
        """The same in files of parameters."""
        if self.watched.parameters:
            found = self.look(paths, "searched_text", self.watched.in_parameters)
            for path in paths:
                yield from self.list_text_uses(path, "yaml", found)

    def list_text_uses(self, path: str, language: str, found: Mapping[str, Any]) -> Iterator[NameUse]:
        """The uses that were found in a file that no compiler reads."""
        for use in found[path].uses if path in found else ():
            yield NameUse(use.label, At(path, use.line, use.column), self.find_python_role(path), False, language)

    def list_settings(self, parameters: Iterable[str], launches: list[tuple[str, str]]) -> Iterator[SettingUse]:
        """Parameters of other packages' nodes that files of parameters and launch files set, of those that change."""
        from .settings import list_launch_settings, list_settings, mentions_changing

        changing = self.watched.changing_parameters
        if not changing:
            return
        find_node = self.make_node_finder(launches)
        words = self.read_words
        wanted = [p for p in parameters if "ros__parameters" in words(p) and words(p) & changing.keys()]
        for path, file in self.look(wanted, "flow_parameters").items():
            for found in list_settings(file, changing, find_node):
                yield self.make_setting_use(path, found)
        for path, kind in launches:
            for file in self.read_launches(path, kind) if mentions_changing(words(path), changing) else ():
                for found in list_launch_settings(file, changing):
                    yield self.make_setting_use(path, found)

    def list_values(self, parameters: Iterable[str], launches: list[tuple[str, str]]) -> Iterator[ValueUse]:
        """What files of parameters set for nodes and plugins of known packages, but for texts."""
        from .parameter_values import find_type, show_value
        from .settings import list_every_setting

        find_node = self.make_node_finder(launches)
        wanted = [path for path in parameters if "ros__parameters" in self.read_words(path)]
        for path, file in self.look(wanted, "flow_parameters").items():
            for found in list_every_setting(file, find_node):
                type_ = find_type(found.value)
                if found.package and type_ and not type_.startswith("string"):
                    place = At(path, found.line), self.find_python_role(path)
                    yield ValueUse(
                        found.name, found.package, found.plugin, found.node, *place, type_, show_value(found.value)
                    )

    def list_claims(self, parameters: Iterable[str]) -> Iterator[InterfaceClaim]:
        """The interfaces of joints that files of parameters name beside `joints`."""
        words = self.read_words
        wanted = [p for p in parameters if "joints" in words(p) and not _CLAIMS.keys().isdisjoint(words(p))]
        for path, file in self.look(wanted, "flow_parameters").items():
            nodes: dict[tuple[str, ...], dict[str, ParameterEntry]] = {}
            for entry in file.entries:
                if "ros__parameters" in entry.path[:-1]:
                    nodes.setdefault(entry.path[:-1], {})[entry.path[-1]] = entry
            for place, known in nodes.items():
                joints = known["joints"].value if place[-1] == "ros__parameters" and "joints" in known else None
                # A controller that commands another one names the joints of that.
                if not isinstance(joints, list) or "command_joints" in known:
                    continue
                plain = tuple(joint for joint in joints if isinstance(joint, str) and "$" not in joint)
                for key, kind in _CLAIMS.items():
                    asked = known[key].value if key in known else None
                    for name in asked if isinstance(asked, list) else ():
                        if isinstance(name, str) and "$" not in name and "/" not in name:
                            at = At(path, known[key].line)
                            controller = place[-2].rpartition("/")[2] if len(place) > 1 else ""
                            yield InterfaceClaim(controller, kind, name, plain, at, self.find_python_role(path))

    @cache_method
    def read_words(self, path: str) -> set[str]:
        """The words of a parameter or launch file."""
        return set(self.facts(path).facts.words.split(" "))

    def read_launches(self, path: str, kind: str) -> Iterable[LaunchFile]:
        """A launch file as the message flow has it; none where it cannot be read."""
        return self.look((path,), f"flow_{kind}").values()

    def make_node_finder(
        self, launches: list[tuple[str, str]]
    ) -> Callable[[str, Collection[str]], NamedNode | None]:  # fmt: skip
        """What gives the node that launch files start by a name, one of some packages first."""
        from .settings import list_named_nodes

        started: dict[str, list[NamedNode]] = {}

        @cache
        def find_node(name: str, packages: Collection[str]) -> NamedNode | None:
            other = None
            for path, kind in launches:
                if path not in started and mentions(name, self.read_words(path)):
                    started[path] = [one for file in self.read_launches(path, kind) for one in list_named_nodes(file)]
                for one in started.get(path, ()):
                    if one.name == name and one.package in packages:
                        return one
                    other = one if one.name == name else other
            return other

        return find_node

    def make_setting_use(self, path: str, found: Setting) -> SettingUse:
        """A value that a file sets, as rules ask of it."""
        value = "" if found.value is None else str(found.value)
        place = At(path, found.line), self.find_python_role(path)
        return SettingUse(found.name, found.package, found.plugin, found.node, found.others, *place, value)

    def list_member_uses(self, roles) -> Iterator[MemberUse]:
        """Uses of fields and constants that only some versions of an interface have, in files that are compiled."""
        from .cpp.resolver import Resolver
        from .cpp.uses import MemberUses
        from .members import InterfaceScope, find_included_interfaces, find_interface

        table, asked = self.watched.fields, self.asked
        if table is None:
            return
        paths = {include.path for resolved in self.resolved.values() for to, include in resolved if to is None}
        paths.update(*map(self.list_offered_includes, self.cpp))
        # Interfaces that come along with other headers are told by their names.
        kinds = {name.text: None for facts in self.cpp.values() for name in facts.qualified}
        meant = {text: interface for text in kinds if (interface := find_interface(text, table)) is not None}
        changing = InterfaceScope(
            (*find_included_interfaces(paths, table)[0], *meant.values()), table, asked, self.home
        ).changing
        if not changing:
            return
        scopes: dict[frozenset[Meant], InterfaceScope] = {}
        for path, (role, _, targets, conditions) in roles.items():
            facts = self.cpp.get(path)
            if facts is None:
                continue
            spoken = self.list_words(path)
            if not changing & spoken:
                continue
            included, unknown = find_included_interfaces(
                sorted(self.list_reaching_paths(path) | self.list_offered_includes(path)), table
            )
            named = [meant[name.text] for name in facts.qualified if name.text in meant]
            key = frozenset((*included, *named))
            scope = scopes.get(key)
            if scope is None:
                scope = scopes[key] = InterfaceScope(key, table, asked, self.home)
            if not scope.changing & spoken:
                continue
            words = sorted(scope.changing & spoken)
            reached = sorted(to for to in self.list_reached(path) if to != path)
            headers = map(self.load, (*reached, *self.list_offered(path)))
            seen = set()
            for found in MemberUses(Resolver((self.load(path), *headers), None, scope)).find_uses(words, not unknown):
                assert found.at is not None
                around = self.macros.resolve_conditions(found.at.conditions or (), targets)
                key = (found.interface, found.section, found.member, around)
                if key not in seen:
                    seen.add(key)
                    at = At(path, found.at.line, found.at.column)
                    yield _make_member_use(found, at, role, "cpp", conditions + around)

    def list_cpp_api_uses(self, roles) -> Iterator[CppApiUse]:
        """Uses of C++ names of packages outside of the workspace that are not the same in all versions, in files that
        are compiled."""
        from .api import ASSIGNING
        from .cpp.resolver import Resolver
        from .cpp.uses import ApiUses, collect_bases

        vocabulary = self._find_vocabulary(roles)
        if vocabulary is None:
            return
        spoken = {path: self.list_words(path) for path in self.cpp if path in roles}
        assigning = vocabulary.select_wanted(vocabulary.words & ASSIGNING.keys())
        exported = {name.removeprefix("::") for facts in self.cpp.values() for name in facts.exports}
        # Of classes that are not exported, those count of which objects are made and whose base is named beside them.
        deriving = {path for path, words in spoken.items() if not words.isdisjoint(vocabulary.speakers_of_pure)}
        made = {name for path in spoken for name in self.cpp[path].made} if deriving else set[str]()
        asked_of = {True: exported | made, False: exported}
        last_parts = {derives: {name.rpartition("::")[2] for name in names} for derives, names in asked_of.items()}
        for path, (role, _, targets, conditions) in roles.items():
            words = vocabulary.select_wanted(vocabulary.words & spoken[path]) | assigning if path in spoken else set()
            asked, asked_words = asked_of[path in deriving], last_parts[path in deriving]
            has_asked = path in spoken and not asked_words.isdisjoint(spoken[path])
            initializes = path in spoken and self.cpp[path].initializes
            if not words and not has_asked and not initializes:
                continue
            own = [path, *sorted(to for to in self.list_reached(path) if to != path and to in spoken)]
            offered = self.list_offered(path)
            near = [*(spoken[at] for at in own if at in spoken), *map(self.list_words, offered)]
            if has_asked:
                bases = collect_bases(asked_words & self.load(path).type_names, map(self.load, (*own, *offered)))
                has_asked = vocabulary.has_pure(bases, spoken[path])
            words = [word for word in sorted(words) if vocabulary.can_be_meant(word, near)]
            # What a class initializes is its own, so that its package declares it.
            sources = [spoken[at] for at in own if at in spoken] if initializes else []
            built = frozenset().union(*map(vocabulary.constructed.intersection, sources))
            if not words and not has_asked and not built:
                continue
            seen = set()
            files = [self.load(at) for at in own]
            resolver = Resolver([*files, *map(self.load, offered)], vocabulary, None)
            heads = {include.partition("/")[0] for include in self.list_reaching_paths(path)}
            uses = ApiUses(resolver, heads)
            every = (
                uses.find_uses(words),
                uses.find_unimplemented(asked) if has_asked else (),
                uses.find_initialized(built, files) if built else (),
            )
            for found in itertools.chain(*every):
                line, column, around = found.at
                # Every call is a use of its own.
                key = (*(found if found.how == "call" else found._replace(at=CodeSpot(0, 0))), around)
                if around is not None and key not in seen:
                    seen.add(key)
                    yield CppApiUse(found.package, found.name, found.how, found.arguments, found.given,
                                    At(path, line, column), role, found.sure, found.through,
                                    found.templated, conditions + around, targets)  # fmt: skip
            self.unresolved_receivers += len(uses.unresolved)

    def _find_vocabulary(self, roles) -> Vocabulary | None:
        """The names of other packages that its files can mean; None where no versions are known."""
        from .api import Vocabulary

        if self._vocabulary is None and self.changing is not None:
            packages = {i.path.partition("/")[0] for found in self.resolved.values() for to, i in found if to is None}
            packages.update(dependency.name for dependency in self.manifest.dependencies)
            packages.update(name.text.partition("::")[0] for facts in self.cpp.values() for name in facts.qualified)
            packages.update(self.list_packages_of_offered(path for path in self.cpp if path in roles))
            packages.discard(self.name)
            self._vocabulary = Vocabulary(sorted(packages), self.name, self.changing, self.generation, self.home)
        return self._vocabulary

    @cache_method
    def load(self, path: str) -> KnownFile:
        """What a file declares and uses."""
        from .cpp.resolver import KnownFile

        return KnownFile(self.facts(path).facts, self.list_words(path), partial(self.look_into, path))

    def look_into(self, path: str, kind: str, table: Any) -> Any:
        """Facts of another kind of a file, empty ones where it cannot be read any more."""
        return self.look((path,), kind, table).get(path) or make_empty(kind)

    @cache_method
    def list_words(self, path: str) -> frozenset[str]:
        """Every word of a C++ file, and all parts of its qualified names."""
        if path not in self.cpp and self.offered is not None:
            return self.offered.list_words(path)
        return collect_words(self.cpp[path])

    def list_python_member_uses(self, files: dict[str, PythonFile]) -> Iterator[MemberUse]:
        """The same in Python files."""
        from .members import InterfaceScope
        from .python.members import find_changing_members, list_used, may_use_interfaces

        table, asked = self.watched.fields, self.asked
        if table is None:
            return
        for path, facts in files.items():
            used = list_used(facts.fields, table) if may_use_interfaces(facts, table, asked, self.home) else []
            seen = set()
            # Both generations import an interface alike: each is followed for itself.
            for ros in sorted({interface.ros for interface in used}):
                scope = InterfaceScope(
                    (interface for interface in used if interface.ros == ros), table, asked, self.home
                )
                for use, found in find_changing_members(facts.fields, scope) if scope.changing else ():
                    key = (found.interface, found.section, found.member, use.conditions)
                    if key not in seen:
                        seen.add(key)
                        at = At(path, use.line, use.column)
                        yield _make_member_use(found, at, self.find_python_role(path), "python", use.conditions)

    def list_python_api_uses(self, files: dict[str, PythonFile]) -> Iterator[PythonApiUse]:
        """Uses of Python names of other packages that may not be the same in all versions."""
        from .python.api import count_unresolved, find_python_packages, find_uses
        from .python.own_types import OwnTypes

        changing = self.watched.changing_python
        if changing is None:
            return
        own = {self.name, *find_python_packages(self.files)}
        own.update(posixpath.basename(path).removesuffix(".py") for path in files)
        types = OwnTypes(files, own)
        for path, facts in files.items():
            self.unresolved_receivers += count_unresolved(facts, changing)
            for use in find_uses(facts, frozenset(own), changing, types, path):
                yield PythonApiUse(use, At(path, use.line, use.column), self.find_python_role(path))

    def make_bare_use(self, word: WordUse, path, role, public, targets, conditions) -> NameUse:
        """A use of a bare word, with the preprocessor conditions around it."""
        around = self.macros.resolve_conditions(word.conditions, targets)
        return NameUse(word.text, At(path, word.line, word.column), role, public, "cpp", conditions + around, targets)

    @cache_method
    def list_reaching_paths(self, path: str) -> frozenset[str]:
        """All include paths that reach a file, through files of the package."""
        return frozenset(include.path for at in self.list_reached(path) for _, include in self.resolved.get(at, ()))

    def compute_reaches(self, paths: Iterable[str], roles) -> dict[str, tuple[tuple[str, ...], ...]]:
        """For each file, what reaches it in the sources that compile it; the least of them tell enough. A header that
        none does is taken alone, and one that is only a part of another, as a source that no target compiles is, as
        that one includes it."""
        compiled = {source for target in self.build.targets for source in target.sources if not is_header(source)}
        found: dict[str, set[tuple[str, ...]]] = {p: {self.list_outward(p)} if p in compiled else set() for p in paths}
        besides: dict[str, set[tuple[str, ...]]] = {p: set() for p in found}
        own = {path: frozenset(self.list_outward(path)) for path in found if path not in compiled}
        for source, (role, *_) in roles.items():
            if source not in compiled:
                continue
            for path, before in self.list_met_headers(source, own):
                # An installed header may be compiled by nothing but programs that are called tests.
                (found if role == roles[path][0] else besides)[path].add(tuple(sorted(own[path] | before)))
        for path, sets in found.items():
            sets.update(besides[path] if not sets else ())
        parts = {p: own[p] for p, sets in found.items() if not sets and (_PART.search(p) or not is_header(p))}
        for header in self.list_outermost(roles) if parts else ():
            for path, before in self.list_met_headers(header, parts):
                found[path].add(tuple(sorted(own[path] | before)))
        return {
            path: tuple(sorted(sets, key=lambda s: (len(s), s))[:_SOURCES]) or (self.list_outward(path),)
            for path, sets in found.items()
        }

    def list_outermost(self, roles) -> Iterator[str]:
        """The headers that no other header of the package includes."""
        inner = {to for path, resolved in self.resolved.items() if is_header(path) for to, _ in resolved}
        return (path for path in roles if is_header(path) and path not in inner)

    def list_met_headers(self, source: str, wanted: Container[str]) -> Iterator[tuple[str, frozenset[str]]]:
        """Headers among the wanted ones as a source comes to include them, with the include paths that no file of the
        package answers up to there."""
        before: dict[str, None] = {}
        seen, stack = {source}, [iter(self.resolved.get(source, ()))]
        while stack:
            to, include = next(stack[-1], (None, None))
            if include is None:
                stack.pop()
            elif to is None:
                before[include.path] = None
            elif to not in seen:
                if self._is_by_chance(to, include):
                    before[include.path] = None
                seen.add(to)
                if to in wanted:
                    yield to, frozenset(before)
                stack.append(iter(self.resolved.get(to, ())))

    def list_outward(self, path: str) -> tuple[str, ...]:
        """The include paths among them that no file of the package answers, or one that is only called so."""
        found = {
            include.path
            for at in self.list_reached(path)
            for to, include in self.resolved.get(at, ())
            if to is None or self._is_by_chance(to, include)
        }
        return tuple(sorted(found))

    def _is_by_chance(self, to: str, include: Include) -> bool:
        """Whether a file that answers an include lies where no target is known to search, so that a header of another
        package may be meant."""
        folder = to.removesuffix(".in").removesuffix(include.path).rstrip("/")
        usual = posixpath.basename(folder) == "include" or self.strip_prefix(folder) in ("", "src")
        return include.angled and "/" in include.path and not usual and folder not in self._folders

    @cache_method
    def list_reached(self, path: str) -> tuple[str, ...]:
        """The file and the files of the package that it includes, directly or not."""
        return tuple(walk([path], lambda at: (to for to, _ in self.resolved.get(at, ()) if to is not None)))

    @cache_method
    def list_offered(self, path: str) -> list[str]:
        """The headers of other packages of the workspace that a file includes, directly or not."""
        if self.offered is None:
            return []
        headers = (self.offered.find(include, self.path) for include in self.list_outward(path))
        found = frozenset().union(*(self.offered.list_with(header) for header in headers if header))
        self.offered_read |= found
        return sorted(found - self.cpp.keys())

    @cache_method
    def list_offered_includes(self, path: str) -> frozenset[str]:
        """What those headers include."""
        return frozenset(i.path for header in self.list_offered(path) for i in self.facts(header).facts.includes)

    def list_packages_of_offered(self, paths: Iterable[str]) -> set[str]:
        """First parts of what those of them include that these files reach."""
        return {include.partition("/")[0] for path in paths for include in self.list_offered_includes(path)}

    def declares(self, path: str, name: str) -> bool:
        """True when the file, or one of the package that it includes, announces or defines a type or function of this
        name."""
        space, _, word = name.rpartition("::")
        head = space.partition("::")[0]
        if head in ("", "std"):
            return False
        reached = [self.load(at) for at in self.list_reached(path)]
        if parse_type(name) is not None:  # tf2 has a Quaternion too
            return any(head in file.facts.namespaces and file.declares_type(word) for file in reached)
        if space == "tf2" and word[0].islower():
            speaking = (file for file in reached if file.mentions(word))
            return any(file.declares_in(space, word) or file.has_special_form(word) for file in speaking)
        return any(file.declares_type(word) for file in reached)

    def collect_python(self, files: dict[str, PythonFile]):
        """Imports, watched names and syntax of Python files, and the modules that the package has itself."""
        modules, own = self.list_python_modules(), find_top_modules(files)
        imports: list[ImportUse] = []
        names: list[NameUse] = []
        syntax: list[SyntaxUse] = []
        for path, facts in files.items():
            role = self.find_python_role(path)
            others = [item for item in facts.imports if not item.level]
            for item in others:
                head, _, rest = item.module.partition(".")
                # Its interfaces are no modules of the package.
                own_interface = head == self.name and rest in KINDS and rest not in modules
                if own_interface or (head and head != self.name and head not in modules):
                    imports.append(self.make_import_use(path, item))
            mentioned = [(attribute.text, attribute) for attribute in facts.attributes]
            mentioned += [(text, i) for i in others for text in (i.module, *(f"{i.module}.{n}" for n in i.names))]
            known = {(text, place.conditions) for text, place in mentioned}
            for attribute in facts.attributes:
                text = self._find_watched_head(attribute.text)
                if text and (text, attribute.conditions) not in known:
                    known.add((text, attribute.conditions))
                    mentioned.append((text, attribute))
            names.extend(
                NameUse(text, At(path, place.line, place.column), role, False, "python", place.conditions)
                for text, place in mentioned
                if text in self.watched.python and text.partition(".")[0] not in own
            )
            syntax.extend(_list_syntax(path, role, facts))
        return imports, names, syntax, modules

    def _find_watched_head(self, text: str) -> str:
        """The watched name in a module that a longer one is of: `os.errno` of `os.errno.EAGAIN`. Empty for none."""
        while text.count(".") > 1 and text not in self.watched.python:
            text = text.rpartition(".")[0]
        return text if text in self.watched.python else ""

    def list_python_modules(self) -> set[str]:
        """Names of modules, packages and built libraries that Python files of the package may import."""
        modules: set[str] = set()
        for path in self.files:
            inside = self.strip_prefix(path)
            if inside.endswith(".py"):
                parts = inside[:-3].split("/")
                if parts[-1] == "__init__":
                    modules.update(parts[-2:-1])
                modules.add(parts[-1])
                modules.update(parts[:-1][-3:])
            elif inside.endswith((".so", ".pyx", ".pyi")):
                modules.add(posixpath.basename(inside).split(".")[0])
        modules.update(t.name for t in self.build.targets if t.kind in ("module", "library"))
        modules.update(t.output_name for t in self.build.targets if t.output_name)
        return modules

    def make_import_use(self, path: str, item: Import) -> ImportUse:
        """An import of a Python file."""
        at, role = At(path, item.line, item.column), self.find_python_role(path)
        return ImportUse(item.module, item.names, at, role, item.conditions, item.lazy)

    def list_python_roots(self, setup: Iterable[tuple[str, SetupFile]]) -> set[str]:
        """Where Python packages may lie that others can import once the package is installed."""
        roots = {posixpath.join(self.path, folder, self.name) for folder in ("", "src")}
        for path, file in setup:
            if posixpath.dirname(path) == self.path:
                tops = (name.partition(".")[0] for name in file.packages if name.isidentifier())
                roots.update(file.list_module_paths(self.path, top)[0].removesuffix(".py") for top in tops)
        return roots

    def list_programs(self) -> Iterator[str]:
        """The files that CMake installs to be started."""
        for rule in self.build.installs:
            if rule.kind == "programs" and "python" not in rule.destination.lower():
                yield from map(posixpath.normpath, rule.items)

    @cache_method
    def find_python_role(self, path: str) -> str:
        """The role of what a Python file needs, as ImportUse has it."""
        inside = self.strip_prefix(path)
        if inside in ("setup.py", "conanfile.py"):
            return "build"
        role = self.find_role(path)
        if role == "test" and (self._is_test_of_other_project(path) or not self.is_run_as_test(path)):
            return "aside"
        if role is None and is_vendored(inside) and self._is_left_out(path):
            return "aside"
        if role is None and path not in self.started and self._is_left_by_setup(path):
            return "aside"
        return role or ("run" if path in self.started or self.is_installed(path) else "aside")

    def _is_left_out(self, path: str) -> bool:
        """Whether a Python file is in no package of Python, and nothing starts it or is known to install it."""
        if self.build_type == "ament_python" or path in self.started or posixpath.basename(path) in self.interpreted:
            return False
        if f"{posixpath.dirname(path)}/__init__.py" in self.files:
            return False
        items = (posixpath.normpath(item) if item else "" for rule in self.build.installs for item in rule.items)
        return not any(not item or f"{path}/".startswith(f"{item}/") for item in items)

    def _is_test_of_other_project(self, path: str) -> bool:
        """Whether a test in Python is of a project of Python in a folder of a package that CMake builds, and came with
        somebody else's code: CMake runs no setup.py, and neither starts, tests with nor installs the file."""
        if not self.build.files or self.build_type == "ament_python" or path in self.started or self._is_tested(path):
            return False
        if posixpath.basename(path) in self.interpreted or "setup.py" in self.interpreted or self.build.unresolved:
            return False
        folder = posixpath.dirname(path)
        while folder.startswith(f"{self.path}/" if self.path else "") and folder not in ("", self.path):
            if folder in self._projects:
                return not self.is_installed(path)
            folder = posixpath.dirname(folder)
        return False

    @cached_property
    def _projects(self) -> frozenset[str]:
        """The folders with what makes a project of Python."""
        return frozenset(posixpath.dirname(path) for path in self.files if posixpath.basename(path) in _PROJECT_FILES)

    def _is_left_by_setup(self, path: str) -> bool:
        """Whether a setup.py of which all is known that it installs leaves a Python file out: it is in no package or
        module of Python that may be installed, no data_files and no script. Launch files are started where they lie."""
        folder = posixpath.dirname(path)
        own = [file for place, file in self.setup if posixpath.dirname(place) == self.path]
        if self.build_type != "ament_python" or not any(file.packages or file.entry_points for file in own):
            return False
        if posixpath.splitext(path)[1] not in ("", ".py"):  # settings are judged wherever they lie
            return False
        if f"{folder}/__init__.py" in self.files or path.endswith((".launch.py", "_launch.py")):
            return False
        inside = self.strip_prefix(path)
        if inside.startswith((f"{self.name}/", "launch/")) or "/" not in inside:
            return False
        if any(file.problems or file.namespaces for file in own):
            return False
        if any(clause.startswith(_INSTALLING) for file in own for clause in file.unresolved):
            return False
        modules = (file.list_module_paths(self.path, name) for file in own for name in file.packages)
        if any(path == module or folder == posixpath.dirname(below) for module, below in modules):
            return False
        copied = (one for file in own for one in (*(pattern for _, pattern, _ in file.data_files), *file.scripts))
        patterns = map(posixpath.normpath, copied)
        return not any(fnmatchcase(inside, one) or inside.startswith(f"{one}/") for one in patterns)

    def is_run_as_test(self, path: str) -> bool:
        """True for Python files of tests that the build runs, or may run: whatever lies in a folder of one, and modules
        of packages of Python, which they may import."""
        build = self.build
        if self.build_type == "ament_python" or not build.files or path in self.started or self.is_installed(path):
            return True
        if build.unresolved or any(_MAY_TEST.search(u.name) for u in build.uses if u.kind == "command"):
            return True
        folder, name = posixpath.split(path)
        if name in self.interpreted or f"{folder}/__init__.py" in self.files:
            return True
        return self._is_tested(path)

    def _is_tested(self, path: str) -> bool:
        """Whether a file lies in a folder of a test of CMake."""
        run = [source for target in self.build.targets if target.kind == "test" for source in target.sources]
        folders = [one if "." not in posixpath.basename(one) else posixpath.dirname(one) for one in run]
        return any("$" in folder or path.startswith(f"{folder}/") for folder in folders)

    def start_scripts(self, files: dict[str, PythonFile], names: Container[str]) -> None:
        """Notes the scripts of these names, and the modules beside them that they import."""
        waiting = [path for path in files if posixpath.basename(path) in names]
        while waiting:
            path = waiting.pop()
            if path in files and path not in self.started:
                self.started.add(path)
                folder = posixpath.dirname(path)
                waiting.extend(f"{folder}/{item.module.split('.')[0]}.py" for item in files[path].imports)

    @cache_method
    def find_role(self, path: str) -> str | None:
        """As find_folder_role(). What only the name of the file or of the package calls an example is none where the
        package installs the file, along with others of its things."""
        inside = self.strip_prefix(path)
        role = find_folder_role(inside)
        by_folder = find_folder_role(f"{posixpath.dirname(inside)}/")
        if role == "test" or by_folder is not None or (role is None and not _ASIDE_NAME.search(self.name)):
            return role
        installs = self.build_type == "ament_python" or bool(self.build.installs)
        return None if installs and self.is_installed(path) else "aside"

    @cached_property
    def _covered(self) -> tuple[set[str], list[str]]:
        """The files and the folders that the package installs."""
        single, folders = set(), []
        for rule in self.build.installs:
            if rule.kind in ("directory", "python"):
                folders.extend(posixpath.normpath(item) if item else "" for item in rule.items)
            else:
                single.update(posixpath.normpath(item) for item in rule.items)
        made = {item for item in single if _BUILT.match(item)}  # a folder there may hold copies of what is here
        if any("$" in item for item in (*(single - made), *folders)):
            folders.append(self.path)
        return single, folders

    def is_installed(self, path: str) -> bool:
        """True for files that reach the installed package, as far as its rules tell."""
        if self.build_type == "ament_python" or not self.build.files:
            return True
        single, folders = self._covered
        if path in single or any(not f or path.startswith(f + "/") or f == self.path for f in folders):
            return True
        # install_python_setup() installs what setup.py names, which by custom lies in src/.
        inside = self.strip_prefix(path)
        return self.build_type == "catkin" and inside.startswith("src/") and self.prefix + "setup.py" in self.files


# Arguments of setup() that say what is installed, as unresolved clauses begin.
_INSTALLING = ("packages", "package_dir", "py_modules", "data_files", "scripts", "arguments", "written")
# What makes a folder a project of Python.
_PROJECT_FILES = frozenset(("setup.py", "pyproject.toml"))
# Commands that may run tests, besides those that the interpreter knows and those of linters.
_MAY_TEST = re.compile(r"\A(?!ament_|catkin_add|roslaunch_add|add_(?:launch|ros)).*test")
_BUILT = re.compile(r"\$\{(?:\w*BINARY_DIR|CATKIN_DEVEL_PREFIX)\}")


def _list_alternatives(facts: CppFile, known: CompiledNames) -> Iterator[str]:
    """Names that need a link and are used in one branch of an #if where another one of the same library, or of the
    same package, is in the other branch."""
    used: dict[tuple[str, Condition], str] = {}
    for name in facts.qualified:
        if len(name.conditions) == 1 and (name.text in known.functions or name.text in known.classes):
            used.setdefault((known.find(name.text).owner, name.conditions[0]), name.text)
    for (owner, condition), name in used.items():
        if (owner, msgspec.structs.replace(condition, negated=not condition.negated)) in used:
            yield name


def _make_member_use(
    found: FoundField, at: At, role: str, language: str, conditions: tuple[Condition, ...] = ()
) -> MemberUse:
    kind = found.interface
    return MemberUse(kind.package, kind.ros, kind.name, found.section, found.member, at, role, language, found.sure,
                     conditions)  # fmt: skip


def _list_syntax(path: str, role: str, facts: PythonFile) -> Iterator[SyntaxUse]:
    """The syntax of a file that some Python refuses."""
    for problem in facts.python2_only:
        yield SyntaxUse(2, problem.message, At(path, problem.line), role)
    if facts.needs is not None:
        minor, line, what = facts.needs
        plain = "python" in facts.interpreter and "python3" not in facts.interpreter
        yield SyntaxUse(minor, what, At(path, line), role, plain)


def _list_interpreted(facts: CMakeFile) -> Iterator[str]:
    """Names of the Python files that CMake code mentions, where it starts a Python interpreter."""
    texts = [[argument.text for argument in c.arguments] for c in facts.commands if "install" not in c.name]
    if any(one == "COMMAND" and "python" in other.lower() for text in texts for one, other in itertools.pairwise(text)):
        yield from (one.rpartition("/")[2] for text in texts for one in text if one.endswith(".py"))


# Headers that nobody includes by themselves.
_PART = re.compile(r"[_-](?:impl?|inl|details?)\.\w+\Z|/(?:impl|details?|internal)/|\.(?:hxx|ipp|tpp|txx)\Z")
# What <iosfwd> announces, and with it most standard headers, so that references may be made to it.
_ANNOUNCED = frozenset({"std::string"}).union(
    f"std::{name}{kind}" for name in ("i", "o", "io", "f", "if", "of", "string", "istring", "ostring")
    for kind in ("stream", "streambuf")
)  # fmt: skip
# Stands for a test of which only is known that one of several branches of it has to be taken.
_ONE_OF_SEVERAL = Condition("cmake", "<one of several conditions>")


def _merge_conditions(one: list[Condition], other: tuple[Condition, ...]) -> list[Condition]:
    """What holds where a file is built under one set of conditions or another."""
    common = [c for c in one if c in other]
    return common if len(common) in (len(one), len(other)) else [*common, _ONE_OF_SEVERAL]


def is_header(path: str) -> bool:
    """True for C and C++ header names."""
    return path.removesuffix(".in").endswith(HEADER_ENDINGS)
