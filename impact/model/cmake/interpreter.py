"""Runs the CMake of one package without building it: scopes, control flow, calls, and what is collected on the way.

A test that cannot be decided is no obstacle: both branches run, each under its condition, and what they leave in
variables is joined.
"""

import itertools
import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import wraps
from typing import Any

from msgspec import structs

from ...conditions.cmake import asks_only_for_packages, list_tested_packages
from ...facts.cmake import CMakeFile
from ...facts.condition import Condition
from ...facts.distro_branches import VARIABLE, list_compared_words
from . import conditions as tests
from .blocks import Block, CommandCall, build_blocks
from .build import (
    At,
    Build,
    CMakeExport,
    CMakeUse,
    DeclaredPackages,
    DefinedMacro,
    DependencyCall,
    FoundPackage,
    GeneratedInterfaces,
    Install,
    ReadFile,
    RefusedName,
    WrittenPath,
    is_for_tests,
)
from .drafts import TargetDraft, Targets
from .names import (
    BUILTIN_COMMANDS,
    COMMANDS,
    DROPPED,
    FALSE_PLATFORMS,
    MODULE_OF,
    ONLY_NEW,
    READ_SUFFIXES,
    SINCE,
)
from .values import (
    LITERAL,
    MAX_TEXT,
    MAX_WORDS,
    QUOTED_REFERENCE,
    REFERENCE,
    UNSET,
    CMakeValue,
    Template,
    Word,
    add_conditions,
    find_position,
    join,
    make_unsure,
    merge,
    read_references,
    split_list,
    split_words,
    wrap,
)

# The tree, the build folder and the install prefix as they look from inside; no real path starts like this.
SOURCE = "/@source"
BINARY = "/@build"
PREFIX = "/@install"

MAX_STEPS = 40_000
MAX_ITERATIONS = 1_000
MAX_NESTING = 120
MAX_CONDITIONS = 50
_MAX_TEST = 1_000  # letters

NORMAL, BREAK, CONTINUE, RETURN, FATAL = range(5)

Handler = Callable[["Interpreter", CommandCall, list[Word]], "int | None"]


# Keywords of ExternalProject_Add and FetchContent_Declare, to the program that downloads.
_DOWNLOADERS = {"GIT_REPOSITORY": "git", "HG_REPOSITORY": "hg", "SVN_REPOSITORY": "svn", "CVS_REPOSITORY": "cvs"}


class _TooMuch(Exception):
    """The package asks for more work than any real one."""


SOURCES = (".c", ".C", ".cc", ".cpp", ".cxx", ".c++")
# Commands that read sources and compile nothing.
_MAKING_TARGETS = frozenset(("add_custom_target", "add_executable", "add_library"))
_NO_BUILDER = re.compile(r"lint|format|tidy|check|uncrustify|style|doc|translation|coverage|install|propert|package")
# Commands of other packages that call find_package() for their arguments.
_FINDER = re.compile(r"find\w*_packages?(?:_|\Z)")

# Commands that do something else, or stop, where an argument is missing.
_NEEDS_VALUES = frozenset(
    {"install", "add_subdirectory", "add_library", "add_executable", "target_link_libraries", "target_sources"}
)

# Commands of which a version of CMake has more forms than the one before.
_GROWN = frozenset(name.partition("(")[0] for name in SINCE if "(" in name)

# What the setup files of ros_environment set, where it is installed.
_ROS_ENVIRONMENT = re.compile(r"\bENV\{(ROS_(?:DISTRO|VERSION|PYTHON_VERSION))\}")

# What is collected under the names that Build has for it.
_COLLECTED = (
    *("macros", "found", "installs", "exports", "generated", "uses", "include_dirs", "links", "unresolved", "files"),
    *("message_files", "made", "starts", "from_found", "handed_on", "refused", "read_elsewhere", "asked", "stops"),
    *("dependency_calls", "compared"),
)


class Interpreter:
    """One run over one package. Command handlers read and write it; run() gives the Build."""

    def __init__(
        self,
        package_path: str,
        read: Callable[[str], CMakeFile | None],
        exists: Callable[[str], bool | None],
        glob: Callable[[str, bool], list[str]],
        package: str,
        declared: DeclaredPackages,
        extras: Callable[[str], tuple[str, ...]],
    ):
        self.package_path = package_path.strip("/")
        self.package = package or posixpath.basename(self.package_path)
        self.read = read
        self.exists = exists
        self.glob = glob
        self.declared = declared
        self.extras = extras

        self.scopes: list[dict[str, CMakeValue]] = [{}]
        self.scope = self.scopes[0]
        self.cache: dict[str, CMakeValue] = {}
        self.environment: dict[str, CMakeValue] = {}
        self.properties: dict[str, CMakeValue] = {}
        self.overlay: dict[str, CMakeValue] = {}  # arguments of the macro that is running
        self.definitions: dict[str, tuple[Block, dict[str, CMakeValue]]] = {}
        self.maybe_made: set[str] = set()  # targets
        self.conditions: tuple[Condition, ...] = ()
        self.assumed: dict[str, bool] = {}
        self.journal: list[tuple[dict[str, CMakeValue], str, CMakeValue | None]] = []
        self.recording = 0
        self.call_site: At | None = None
        self.via = ""  # the command of another package that is running
        self.command = ""  # the one whose arguments are being read
        self.silent = 0
        self.steps = 0
        self.nesting = 0
        self.maybe_break = False
        self.minimum_policy: tuple[int, ...] = (3, 5)
        self.versions_projects = False  # CMP0048 is set
        self.policies: dict[str, str] = {}  # set one by one: NEW or OLD, empty where it is not sure
        self.parsed: dict[str, list[CommandCall | Block] | None] = {}
        self.including: list[str] = []
        self.extended: set[str] = set()
        self.exported: dict[str, str] = {}  # folder of CMake files -> the package it belongs to
        self.modules: set[str] = set()
        self.guarded: set[str] = set()
        self.made: dict[str, None] = {}
        self.starts: dict[str, None] = {}
        self.from_found: dict[tuple[str, str], None] = {}
        self.handed_on: dict[FoundPackage, None] = {}
        self.handing_on = False
        # Sources given to commands that nothing defines, with the conditions that they are given under.
        self.passed: dict[str, tuple[At, list[tuple[str, tuple[Condition, ...]]]]] = {}
        self.automatic: list[TargetDraft] = []  # made by ament_auto_add_*()

        self.project = ""
        self.minimum: tuple[str, At] | None = None
        self.standards: list[tuple[int, At, bool, bool, tuple[Condition, ...]]] = []
        self.open_flags = False
        self.macros: dict[DefinedMacro, None] = {}
        self.found: dict[FoundPackage, None] = {}
        self.targets = Targets()
        self.installs: dict[Install, None] = {}
        self.exports: dict[CMakeExport, None] = {}
        self.generated: list[GeneratedInterfaces] = []
        self.uses: dict[CMakeUse, None] = {}
        self.include_dirs: dict[tuple[str, At], None] = {}
        self.links: dict = {}
        self.catkin_package: At | None = None
        self.catkin_destinations = False  # catkin's folders are set
        self.before_catkin_destinations: tuple[str, ...] = ()
        self.maybe_set: set[str] = set()  # arguments of commands of which nothing is known
        self.replaced: set[str] = set()  # references whose value another branch replaces
        self.renamed: set[str] = set()  # what find_package(x NAMES ...) calls its variables after
        self.refused: dict[RefusedName, None] = {}
        self.asked: dict[str, None] = {}
        self.compared: dict[tuple[str, At], None] = {}
        self.stops: list[tuple[At, str, tuple[Condition, ...]]] = []
        self.dependency_calls: dict[DependencyCall, None] = {}
        self.ament_package: At | None = None
        self.unresolved: dict[tuple[At, str], None] = {}
        self.files: dict[str, None] = {}
        self.message_files: list[WrittenPath] = []
        self.read_elsewhere: dict[ReadFile, None] = {}
        self.catkin_packages: list[tuple[str, tuple[Condition, ...]]] = []  # the projects that call catkin_package()
        self.empty_globs: dict[str, tuple[str, ...]] = {}  # variable -> the patterns of a file(GLOB) that found nothing

    def run(self) -> Build:
        """Interprets the package from its CMakeLists.txt on."""
        path = posixpath.join(self.package_path, "CMakeLists.txt")
        source = self.make_absolute(self.package_path)
        self.predefine(source)
        body = self.load(path)
        if body is not None:
            self.including.append(path)
            try:
                self.run_body(body)
            except _TooMuch as stop:
                self.unresolved[(At(path, 1), str(stop))] = None
        return self.build_result()

    def predefine(self, source: str) -> None:
        """Variables that CMake sets itself, on Linux with GCC."""
        binary = f"{BINARY}/{self.package}"
        at = At(posixpath.join(self.package_path, "CMakeLists.txt"), 1)
        known = {
            "CMAKE_SOURCE_DIR": source,
            "CMAKE_CURRENT_SOURCE_DIR": source,
            "CMAKE_CURRENT_LIST_DIR": source,
            "CMAKE_CURRENT_LIST_FILE": f"{source}/CMakeLists.txt",
            "CMAKE_BINARY_DIR": binary,
            "CMAKE_CURRENT_BINARY_DIR": binary,
            "CMAKE_INSTALL_PREFIX": PREFIX,
            "CMAKE_SYSTEM_NAME": "Linux",
            "CMAKE_HOST_SYSTEM_NAME": "Linux",
            "UNIX": "1",
            "LINUX": "1",
            "CMAKE_HOST_UNIX": "1",
            "CMAKE_COMPILER_IS_GNUCXX": "1",
            "CMAKE_COMPILER_IS_GNUCC": "1",
            "CMAKE_CXX_COMPILER_ID": "GNU",
            "CMAKE_C_COMPILER_ID": "GNU",
            "CMAKE_COMMAND": "cmake",
            "CMAKE_SHARED_LIBRARY_PREFIX": "lib",
            "CMAKE_SHARED_LIBRARY_SUFFIX": ".so",
            "CMAKE_STATIC_LIBRARY_PREFIX": "lib",
            "CMAKE_STATIC_LIBRARY_SUFFIX": ".a",
            "CMAKE_SHARED_MODULE_PREFIX": "lib",
            "CMAKE_SHARED_MODULE_SUFFIX": ".so",
            "CMAKE_INSTALL_LIBDIR": "lib",
            "CMAKE_INSTALL_BINDIR": "bin",
            "CMAKE_INSTALL_INCLUDEDIR": "include",
            "CMAKE_INSTALL_DATADIR": "share",
            "CMAKE_INSTALL_DATAROOTDIR": "share",
            "CMAKE_INSTALL_SYSCONFDIR": "etc",
            "CMAKE_INSTALL_LIBEXECDIR": "libexec",
        }
        for name, text in known.items():
            self.scope[name] = CMakeValue((wrap(text, at),))
        empty = CMakeValue((wrap("", at),))
        for name in FALSE_PLATFORMS:
            self.scope[name] = empty
        for name in ("CMAKE_CXX_FLAGS", "CMAKE_C_FLAGS", "CMAKE_MODULE_PATH", "CMAKE_PREFIX_PATH"):
            self.scope[name] = make_unsure(empty)

    def build_result(self) -> Build:
        """What was collected."""
        self.compile_passed()
        standard = None
        default_only = by_flag = False
        if self.standards:
            number, at, *_ = max(self.standards, key=lambda entry: entry[0] if entry[0] < 90 else entry[0] - 100)
            standard = (number, at)
            by_flag = all(entry[3] for entry in self.standards)
            default_only = all(entry[2] for entry in self.standards)
        return Build(
            project=self.project,
            minimum=self.minimum,
            standard=standard,
            standard_default_only=default_only,
            standard_by_flag=by_flag,
            open_flags=self.open_flags,
            standards=tuple((number, at, conditions) for number, at, _, _, conditions in self.standards),
            targets=self.targets.finish(),
            catkin_package=self.catkin_package,
            ament_package=self.ament_package,
            before_catkin_destinations=self.before_catkin_destinations,
            catkin_destinations=self.catkin_destinations,
            **{name: tuple(getattr(self, name)) for name in _COLLECTED},
        )

    def load(self, path: str) -> list[CommandCall | Block] | None:
        """Blocks of a file of the tree, None when it is not there."""
        if path in self.parsed:
            return self.parsed[path]
        facts = self.read(path)
        if facts is None:
            self.parsed[path] = None
            return None
        body, problems = build_blocks(facts, path)
        self.parsed[path] = body
        if not self.silent:
            self.files[path] = None
            for problem in problems:
                self.unresolved[problem] = None
        return body

    def run_body(self, body: list[CommandCall | Block]) -> int:
        """Runs commands in order; returns how they ended."""
        self.spend(1)
        self.nesting += 1
        if self.nesting > MAX_NESTING:
            self.nesting -= 1
            raise _TooMuch("calls are nested too deeply")
        try:
            for node in body:
                signal = self.run_call(node) if type(node) is CommandCall else self.run_block(node)  # type: ignore[arg-type]
                if signal:
                    return signal
        finally:
            self.nesting -= 1
        return NORMAL

    def run_call(self, call: CommandCall) -> int:
        """Runs one command."""
        self.spend(1)
        name = self.command = call.name
        self.use_feature(name, call.at)
        self.use_dropped(name, call.at)
        if name in _GROWN:
            for template in call.templates if name == "project" else call.templates[:1]:
                self.use_feature(f"{name}({template.raw})", call.at)
        handler = HANDLERS.get(name)
        if handler is not None:
            if name not in BUILTIN_COMMANDS:
                self.use_command(call)
            return handler(self, call, self.expand(call.templates)) or NORMAL
        defined = self.definitions.get(name)
        if defined is not None:
            return self.invoke(call, defined)
        wrapper = WRAPPERS.get(name)
        if wrapper is not None:
            self.use_command(call)
            return wrapper(self, call, self.expand(call.templates)) or NORMAL
        words = self.expand(call.templates)
        self.maybe_set.update(words)
        if name not in BUILTIN_COMMANDS:
            self.use_command(call, words)
            self.pass_sources(call, words)
            self.pass_packages(call, words)
        return NORMAL

    def pass_packages(self, call: CommandCall, words: list[Word]) -> None:
        """Notes what is given to a command that nothing defines and that is called as one which finds packages."""
        if _FINDER.search(call.name) and call.name not in MODULE_OF:
            for item in words:
                if not item.isupper():
                    place, conditions = self.locate(item.at), self.merge_with(item)
                    self.add_found(FoundPackage(str(item), "passed", place, conditions=conditions))

    def pass_sources(self, call: CommandCall, words: list[Word]) -> None:
        """Remembers the sources given to a command that nothing defines: it most likely builds them."""
        if self.silent or _NO_BUILDER.search(call.name):
            return
        for item in words:
            if item.endswith(SOURCES) and "$" not in item:
                path = self.make_relative(self.resolve(item))
                if path is not None and self.exists(path):
                    given = self.passed.setdefault(call.name, (self.locate(call.at), []))[1]
                    given.append((path, self.merge_with(item)))

    def compile_passed(self) -> None:
        """Gives these sources, where no target compiles them, to a target of which nothing else is known."""
        compiled = {path for target in self.targets.finish() for path in target.sources}
        for name, (at, given) in self.passed.items():
            for path, conditions in given:
                if path not in compiled:
                    self.targets.make(f"{name}()", "unknown", at, ()).add_source(path, conditions)

    def spend(self, steps: int) -> None:
        """Counts work in units of one short command; the run ends when it is more than any real package asks for."""
        self.steps += steps
        if self.steps > MAX_STEPS:
            raise _TooMuch("more work than 40,000 commands")

    def use_feature(self, name: str, at: At) -> None:
        """Notes a command, module or policy that only newer versions of CMake have."""
        since = SINCE.get(name)
        if since and not self.silent and name not in self.definitions:
            self.uses[CMakeUse("feature", name, self.locate(at), since, self.conditions)] = None

    def use_dropped(self, name: str, at: At) -> None:
        """Notes a command or module that a policy takes away under the policies that are set here."""
        policy = DROPPED.get(name, "")
        if not policy or self.silent or name in self.definitions or self.call_site is not None:
            return
        since = SINCE.get(policy, "3.0")
        default = "NEW" if self.minimum is not None and self.minimum_policy >= tests.make_version_key(since) else "OLD"
        if self.policies.get(policy, default) == "NEW":
            self.uses[CMakeUse("dropped", name, self.locate(at), policy, self.conditions)] = None

    def use_policy(self, kind: str, name: str, at: At) -> None:
        """Notes policies that not every version of CMake has. kind: as of CMakeUse."""
        if not self.silent and self.call_site is None:
            self.uses[CMakeUse(kind, name, self.locate(at), ONLY_NEW.get(name, ""), self.conditions)] = None

    def use_command(self, call: CommandCall, words: Sequence[Word] = ()) -> None:
        """Notes a command that neither CMake nor the tree defines. words: its arguments, where what it does is not
        known."""
        module = MODULE_OF.get(call.name, "")
        # What the configuration of a package finds first may bring the macro for it.
        first = self.handing_on and call.name == "find_dependency" and not self.handed_on
        if (self.silent and not first) or call.name in self.definitions:
            return
        if module and module in self.modules:
            return
        made = (*words[:1], *(to for before, to in itertools.pairwise(words) if before == "DESTINATION"))
        makes = tuple(str(item) for item in made if "$" not in item)
        use = CMakeUse("command", call.name, self.locate(call.at), module, self.conditions, makes=makes)
        self.uses[use] = None

    def run_block(self, block: Block) -> int:
        """Runs a block command."""
        kind = block.kind
        if kind == "if":
            return self.run_if(block)
        if kind == "foreach":
            return self.run_foreach(block)
        if kind == "while":
            return self.run_while(block)
        if kind == "block":
            return self.run_body(block.body)
        head = block.head
        names = self.expand(head.templates[:1])
        if names:
            self.definitions[names[0].lower()] = (block, self.overlay)
        return NORMAL

    def run_if(self, block: Block) -> int:
        """Runs the branches that may be taken."""
        outer = self.conditions
        before: tuple[Condition, ...] = ()
        outcomes: list[dict[tuple[int, str], tuple[dict[str, CMakeValue], CMakeValue | None]]] = []
        led: list[tuple[Condition, ...]] = []
        returned: list[tuple[Condition, ...]] = []
        signals: set[int] = set()
        exhaustive = False
        for head, body in block.branches:
            if head.name == "else":
                value: bool | None = True
                text = ""
            else:
                value, text = self.decide(head)
            if value is False:
                continue
            if value is True and not before:  # the only branch that can be taken
                return self.run_body(body)
            # Every branch stands under the tests of all before it; real chains are short.
            self.spend(len(before) ** 2 >> 6)
            own = before if value is True else (*before, self.make_test(text))
            signal, changes = self.run_branch(body, merge(outer, own))
            if signal in (RETURN, FATAL):
                signals.add(signal)
                if signal == RETURN:
                    returned.append(own)
                elif signal == FATAL and len(own) == 1:
                    self.assume(own[0].text, own[0].negated)
            else:
                if signal in (BREAK, CONTINUE):
                    self.maybe_break = True
                outcomes.append(changes)
                led.append(own)
            if value is True:
                exhaustive = True
                break
            before = (*before, self.make_test(text, negated=True))
        if not exhaustive:
            outcomes.insert(0, {})
            led.insert(0, before)
        if not outcomes:
            return RETURN if RETURN in signals else FATAL
        self.merge_outcomes(outcomes, before if len(before) == 1 and not exhaustive else (), led)
        for own in returned if len(self.conditions) < MAX_CONDITIONS else ():
            rest = own[0] if len(own) == 1 else self.make_test(format_all(own, ""))
            rest = structs.replace(rest, negated=not rest.negated, gate=self.is_at_gate(rest))
            self.conditions = merge(self.conditions, (rest,))
        return NORMAL

    def make_test(self, text: str, *, negated: bool = False) -> Condition:
        """A test of this package that is not decided."""
        asked = list_tested_packages(text) if "_FOUND" in text else ()
        self.asked.update(dict.fromkeys(asked))
        known = self.declared.names if asked else ()
        declared = tuple(name for name in asked if name in known)
        return Condition("cmake", text, negated, declared)

    def is_at_gate(self, test: Condition) -> bool:
        """Whether configuring the package, left on a test of what was found, has built nothing so far."""
        top = not self.recording and len(self.including) == 1 and len(self.scopes) == 1 and not self.overlay
        built = self.targets.finish() or self.installs or self.generated or self.message_files
        return top and not built and asks_only_for_packages(test.text)

    def run_branch(self, body, conditions):
        """Runs one branch on trial: returns how it ended and what it wrote, with the writes taken back."""
        kept = self.conditions
        self.conditions = conditions
        mark = len(self.journal)
        self.recording += 1
        overlay = self.overlay
        scope_depth = len(self.scopes)
        try:
            signal = self.run_body(body)
        finally:
            self.recording -= 1
            self.conditions = kept
            self.overlay = overlay
            del self.scopes[scope_depth:]
            self.scope = self.scopes[-1]
        changes: dict[tuple[int, str], tuple[dict[str, CMakeValue], CMakeValue | None]] = {}
        for where, name, _ in self.journal[mark:]:
            key = (id(where), name)
            if key not in changes:
                changes[key] = (where, where.get(name))
        for where, name, old in reversed(self.journal[mark:]):
            if old is None:
                where.pop(name, None)
            else:
                where[name] = old
        del self.journal[mark:]
        return signal, changes

    def merge_outcomes(self, outcomes, untaken: tuple[Condition, ...] = (), led=()) -> None:
        """Leaves in each variable what the branches wrote, joined. untaken: what holds where the only branch is not
        taken; what that branch takes out of a list is left under this. led: the tests that lead into each."""
        touched: dict[tuple[int, str], dict[str, CMakeValue]] = {}
        for changes in outcomes:
            for key, (where, _) in changes.items():
                touched[key] = where
        for (key, name), where in touched.items():
            left = [changes[(key, name)][1] if (key, name) in changes else where.get(name) for changes in outcomes]
            if None in left and name.endswith(READ_SUFFIXES):
                # Where no branch has set it, a found package may have.
                unknown = CMakeValue((wrap(f"${{{name}}}", self.get_current_place(), (), False),), False)
                left = [value if value is not None else unknown for value in left]
            whole, part = (left[0], left[-1]) if untaken and len(left) == 2 else (None, None)
            if whole is not None and part is not None and set(part.words) < set(whole.words):
                kept = set(part.words)
                words = (
                    item if item in kept else wrap(item, item.at, merge(item.conditions, untaken), item.sure)
                    for item in whole.words
                )
                left[0] = CMakeValue(tuple(words), whole.sure, whole.defined)
            value = join(left, led)
            if value is not None:
                self.spend(len(value.words) >> 5)
                self.assign(where, name, value)

    def decide(self, head: CommandCall) -> tuple[bool | None, str]:
        """The value of a test and its text."""
        self.command = head.name
        value, text = self.evaluate(head)
        if value is not None:
            return value, ""
        self.use_environment(text, head.at)
        if VARIABLE in text:
            self.compared.update(((word, self.locate(head.at)), None) for word in list_compared_words(text))
        for held in self.conditions:
            if held.text == text and held.language == "cmake":
                return not held.negated, text
        plain, negated = (text[4:], True) if text.startswith("NOT ") and text.count(" ") == 1 else (text, False)
        for held in self.conditions:
            if held.language == "cmake" and held.text == plain:
                return held.negated == negated, text
            if held.language == "cmake" and not negated and held.text == f"NOT {plain}":
                return held.negated, text
        assumed = self.assumed.get(plain)
        if assumed is not None:
            return assumed != negated, text
        return None, text

    def evaluate(self, head: CommandCall) -> tuple[bool | None, str]:
        """The value of a test, or its text where that is not known. What it reads of a variable that branches set
        differently is told by the tests that lead into these."""
        tokens = self.expand_condition(head)
        value = tests.evaluate(tokens, self)
        if value is not None:
            return value, ""
        text = self.clean(tests.format_condition(tokens, self))
        for where, name in self.list_tested(head):
            held = where[name]
            alternatives: list[tuple[str, bool]] = []
            try:
                for conditions, way in held.ways:
                    where[name] = way or CMakeValue((wrap(f"${{{name}}}", head.at, (), False),), False)
                    value, rest = self.evaluate(head)
                    if value is not False:
                        alternatives.append((format_all(conditions, rest), value is True))
            finally:
                where[name] = held
            if all(sure for _, sure in alternatives) and len(alternatives) in (0, len(held.ways)):
                return bool(alternatives), ""
            texts = [each for each, _ in alternatives]
            any_of = " OR ".join(map(group, texts)) if texts[1:] else texts[0]
            return None, any_of if len(any_of) <= _MAX_TEST else text
        return None, text

    def list_tested(self, head: CommandCall) -> Iterator[tuple[dict[str, CMakeValue], str]]:
        """The variables that a test reads and that branches set differently, each with what holds it."""
        for template in head.templates:
            if template.kind == LITERAL:
                names = () if template.quoted else map(str, template.words)
            else:
                names = (template.name,)
            for name in names:
                for where in (self.overlay, self.scope, self.cache):
                    if name in where:
                        if where[name].ways:
                            yield where, name
                        break

    def assume(self, text: str, value: bool) -> None:
        """Takes a test as decided from here on: configuring stops when it is otherwise."""
        if text.startswith("NOT ") and text.count(" ") == 1:
            self.assumed[text[4:]] = not value
        else:
            self.assumed[text] = value

    def expand_condition(self, head: CommandCall) -> list[tests.Token]:
        """Arguments of if() expanded; each remembers whether it was quoted."""
        tokens: list[tests.Token] = []
        for template in head.templates:
            if template.kind == LITERAL:
                tokens.extend(self.make_literal_token(item, template.quoted) for item in template.words)
                continue
            if template.kind in (REFERENCE, QUOTED_REFERENCE):
                value = self.resolve_reference(template)
                if not value.sure and value.defined:
                    text = self.choose_tested(value) or f"${{{template.name}}}"
                    tokens.append(tests.Token(text, template.quoted, False, False))
                    continue
                if template.kind == REFERENCE:
                    tokens.extend(tests.Token(item, False, item.sure, False) for item in value.words if item)
                    continue
            for item in self.expand_one(template):
                tokens.append(tests.Token(item, template.quoted, item.sure, False))
        return tokens

    def choose_tested(self, value: CMakeValue) -> str:
        """What a test reads of a value that is not sure; of those that differing branches leave, the one that a target
        knows, if any: the others stand for it where it is not set."""
        if value.chosen == value.words:
            return value.text
        known = next(filter(_ROS_ENVIRONMENT.search, value.words), "")
        self.replaced.add(known)
        return known

    def make_literal_token(self, item: Word, quoted: bool) -> tests.Token:
        """An argument of if() without a reference. A variable that holds an environment variable stands for it, which
        is known on a target."""
        held = None if quoted else self.lookup("", item)
        text = self.choose_tested(held) if held is not None and not held.sure else ""
        if text.startswith("$ENV{") and ";" not in text:
            return tests.Token(text, False, False, False)
        return tests.Token(item, quoted, True, True)

    def run_foreach(self, block: Block) -> int:
        """Runs a foreach() in any of its forms."""
        self.command = "foreach"
        args = self.expand(block.head.templates)
        if not args:
            return NORMAL
        variables = [args[0]]
        rounds: Iterable[tuple[Word, ...]] = ()
        rest = args[1:]
        mode = rest[0] if rest else ""
        if mode == "RANGE":
            rounds = ((wrap(str(number), block.head.at),) for number in self.compute_range(rest[1:], block.head))
        elif "IN" in args[1:] and ("LISTS" in rest or "ITEMS" in rest or "ZIP_LISTS" in rest):
            split = find_position(args, "IN")
            variables = args[:split]
            rounds = self.list_foreach_items(args[split + 1 :])
        else:
            rounds = [(item,) for item in rest]
        names = [str(name) for name in variables]
        scope = self.scope
        kept = {name: scope.get(name) for name in names}
        outer = self.conditions
        signal = NORMAL
        for count, items in enumerate(rounds):
            if count >= MAX_ITERATIONS:
                self.give_up(block.head.at, f"foreach() was left after {MAX_ITERATIONS} rounds")
                break
            if len(names) == 1 and len(items) > 1:
                for index, item in enumerate(items):
                    self.assign(scope, f"{names[0]}_{index}", CMakeValue((item,), item.sure))
            else:
                for name, item in zip(names, items, strict=False):
                    self.assign(scope, name, CMakeValue((item,), item.sure or len(names) == 1))
            self.conditions = merge(outer, items[0].conditions) if items else outer
            signal = self.run_body(block.body)
            if signal == BREAK or signal >= RETURN:
                break
        self.conditions = outer
        for name, value in kept.items():
            self.assign(scope, name, value if value is not None else UNSET)
        return signal if signal >= RETURN else NORMAL

    def list_foreach_items(self, args: list[Word]) -> list[tuple[Word, ...]]:
        """Rounds of foreach(IN LISTS / ITEMS / ZIP_LISTS)."""
        items: list[Word] = []
        zipped: list[tuple[Word, ...]] = []
        mode = ""
        for item in args:
            if item in ("LISTS", "ITEMS", "ZIP_LISTS"):
                mode = str(item)
            elif mode == "ITEMS":
                items.append(item)
            elif mode in ("LISTS", "ZIP_LISTS"):
                value = self.get(item)
                words = value.words if value is not None else (wrap(f"${{{item}}}", item.at, (), False),)
                words = tuple(each for each in words if each)
                if mode == "LISTS":
                    items.extend(words)
                else:
                    zipped.append(words)
        if mode == "ZIP_LISTS" and zipped:
            length = min(max(len(words) for words in zipped), MAX_ITERATIONS + 1)
            blank = wrap("", args[0].at)
            return [tuple(words[index] if index < len(words) else blank for words in zipped) for index in range(length)]
        return [(item,) for item in items]

    def compute_range(self, args: list[Word], head: CommandCall) -> range:
        """Rounds of foreach(RANGE)."""
        try:
            bounds = [int(item) for item in args[:3]]
        except ValueError:
            self.give_up(head.at, "foreach(RANGE) over bounds that are not known")
            return range(1)
        if not bounds:
            return range(0)
        start, stop = (0, bounds[0]) if len(bounds) == 1 else (bounds[0], bounds[1])
        step = abs(bounds[2]) if len(bounds) > 2 else 1
        if step == 0:
            return range(0)
        return range(start, stop + 1, step) if start <= stop else range(start, stop - 1, -step)

    def run_while(self, block: Block) -> int:
        """Runs a while(): once when its test is not known."""
        for _ in range(MAX_ITERATIONS):
            self.spend(1)
            value, text = self.decide(block.head)
            if value is False:
                return NORMAL
            if value is None:
                signal, changes = self.run_branch(block.body, merge(self.conditions, (self.make_test(text),)))
                self.merge_outcomes([{}, changes])
                return NORMAL
            self.maybe_break = False
            signal = self.run_body(block.body)
            if signal == BREAK or self.maybe_break:
                self.maybe_break = False
                return NORMAL
            if signal >= RETURN:
                return signal
        self.give_up(block.head.at, f"while() was left after {MAX_ITERATIONS} rounds")
        return NORMAL

    def invoke(self, call: CommandCall, defined: tuple[Block, dict[str, CMakeValue]]) -> int:
        """Calls a function or macro of the tree."""
        block, captured = defined
        templates = block.head.templates
        names = [template.raw for template in templates[1:]]
        args = self.expand(call.templates)
        at = call.at
        arguments: dict[str, CMakeValue] = dict(captured)
        for index, name in enumerate(names):
            if index < len(args):
                arguments[name] = CMakeValue((args[index],), args[index].sure)
            else:
                arguments[name] = UNSET
        arguments["ARGC"] = CMakeValue((wrap(str(len(args)), at),))
        arguments["ARGV"] = _make_arguments_value(args)
        arguments["ARGN"] = _make_arguments_value(args[len(names) :])
        for index, item in enumerate(args[:64]):
            arguments[f"ARGV{index}"] = CMakeValue((item,), item.sure)

        overlay, conditions, site, via = self.overlay, self.conditions, self.call_site, self.via
        if site is None and not self.is_in_package(block.head.path):
            self.call_site = at
            self.via = call.name
        try:
            if block.kind == "macro":
                self.overlay = arguments
                signal = self.run_body(block.body)
            else:
                self.overlay = captured
                scope = dict(self.scope)
                for name in (f"ARGV{index}" for index in range(len(args), 64)):
                    if name not in scope:
                        break
                    del scope[name]
                scope.update(arguments)
                directory = self.make_absolute(posixpath.dirname(block.head.path))
                scope["CMAKE_CURRENT_FUNCTION"] = CMakeValue((wrap(block.head.templates[0].raw, at),))
                scope["CMAKE_CURRENT_FUNCTION_LIST_DIR"] = CMakeValue((wrap(directory, at),))
                self.push(scope)
                try:
                    signal = self.run_body(block.body)
                finally:
                    self.pop()
        finally:
            self.overlay = overlay
            self.call_site = site
            self.via = via
            if block.kind != "macro":
                self.conditions = conditions
        if signal == RETURN and block.kind == "macro":
            return RETURN
        return FATAL if signal == FATAL else NORMAL

    def run_file(self, path: str, at: At, subdirectory: str | None = None) -> int | None:
        """Runs a file of the tree: as include() does, or as add_subdirectory() of `subdirectory`. None: not there."""
        body = self.load(path)
        if body is None:
            return None
        if path in self.including and self.including.count(path) > 3:
            self.give_up(at, f"{path} includes itself")
            return NORMAL
        listing = {
            "CMAKE_CURRENT_LIST_DIR": self.make_absolute(posixpath.dirname(path)),
            "CMAKE_CURRENT_LIST_FILE": self.make_absolute(path),
        }
        conditions, overlay = self.conditions, self.overlay
        self.overlay = {}
        site, via = self.call_site, self.via
        if site is None and not self.is_in_package(path):
            self.call_site, self.via = at, f"include({posixpath.basename(path)})"
        self.including.append(path)
        kept = {name: self.scope.get(name) for name in listing}
        try:
            if subdirectory is not None:
                self.push(dict(self.scope))
                listing["CMAKE_CURRENT_SOURCE_DIR"] = self.make_absolute(subdirectory)
                inside = posixpath.relpath(subdirectory, self.package_path or ".")
                listing["CMAKE_CURRENT_BINARY_DIR"] = posixpath.join(BINARY, self.package, inside)
            for name, text in listing.items():
                self.scope[name] = CMakeValue((wrap(text, at),))
            signal = self.run_body(body)
        finally:
            self.including.pop()
            self.call_site, self.via = site, via
            self.overlay = overlay
            self.conditions = conditions
            if subdirectory is not None:
                self.pop()
            else:
                for name, value in kept.items():
                    if value is not None:
                        self.scope[name] = value
        return FATAL if signal == FATAL else NORMAL

    def extend(self, package: str, at: At) -> None:
        """Makes known what a package of the workspace gives to those that find it: its functions and macros, and, from
        its extras files, its variables. Nothing that it finds or builds itself counts here."""
        if package in self.extended or package == self.package:
            return
        self.extended.add(package)
        paths = self.extras(package)
        if paths:
            # Installed, a package's CMake files lie together in the folder that <package>_DIR names.
            folder = next((posixpath.dirname(path) for path in paths if "/cmake/" in path), posixpath.dirname(paths[0]))
            self.exported[self.make_absolute(folder)] = package
            self.assign(self.scope, f"{package}_DIR", CMakeValue((wrap(self.make_absolute(folder), at),)))
        for path in paths:
            self.silent += 1
            try:
                name = posixpath.basename(path)
                body = self.load(path)
                if body is None:
                    continue
                self.define_all(body)
                if "extras" in name:
                    self.run_file(path, at)
            finally:
                self.silent -= 1

    def hand_on(self, path: str, at: At, whole: bool = False) -> None:
        """Runs a script that the package gives to those who find it, for what it looks for. Its files lie in one folder
        once they are installed, so that what it includes is known by its name. whole: it is the configuration itself,
        rather than a part of one that ament or catkin writes."""
        path = self.find_own_file(path) or path
        if path in self.including or self.load(path) is None:
            return
        outer, targets, macros, made = self.handing_on, self.targets, self.macros, self.made
        self.targets, self.macros, self.made = Targets(), {}, {}
        modules, self.modules = self.modules, set() if whole else self.modules | {"CMakeFindDependencyMacro"}
        self.handing_on = True
        self.silent += 1
        self.push(dict(self.scope))
        folder = self.make_absolute(posixpath.dirname(path))
        self.scope[f"{self.package}_DIR"] = CMakeValue((wrap(folder, at),))
        self.exported[folder] = self.package
        try:
            self.run_file(path, at)
        finally:
            self.pop()
            self.silent -= 1
            self.handing_on, self.targets, self.macros, self.made = outer, targets, macros, made
            self.modules = modules

    def find_own_file(self, name: str) -> str | None:
        """The CMake file of the package, or the template of one, that has a name once it is installed."""
        base = posixpath.basename(name).removesuffix(".in")
        files = self.glob(f"{self.package_path}/*.cmake*".lstrip("/"), True)
        return next((file for file in files if posixpath.basename(file).removesuffix(".in") == base), None)

    def find_exported_file(self, name: str) -> str | None:
        """The file in the tree from which `<package>_DIR/name` is installed, for a package of the workspace."""
        base = posixpath.basename(name)
        if self.handing_on and self.exported.get(posixpath.dirname(name)) == self.package:
            return self.find_own_file(name)
        for path in self.extras(self.exported.get(posixpath.dirname(name), "")):
            if posixpath.basename(path) in (base, f"{base}.in", f"{base}.em"):
                return path
        return None

    def define_all(self, body: list[CommandCall | Block]) -> None:
        """Learns the functions and macros of a body, and which targets it may make, without running it."""
        pending = list(body)
        while pending:
            node = pending.pop()
            if isinstance(node, CommandCall):
                if node.name in _MAKING_TARGETS and node.templates:
                    self.maybe_made.add(node.templates[0].raw)
                continue
            if node.kind in ("function", "macro"):
                templates = node.head.templates
                if templates:
                    self.definitions.setdefault(templates[0].raw.lower(), (node, {}))
            elif node.kind == "if":
                for _, branch in node.branches:
                    pending.extend(branch)

    def push(self, scope: dict[str, CMakeValue]) -> None:
        """Opens a variable scope."""
        self.spend(len(scope) >> 7)
        self.scopes.append(scope)
        self.scope = scope

    def pop(self) -> None:
        """Closes the innermost scope."""
        self.scopes.pop()
        self.scope = self.scopes[-1]

    def get(self, name: str) -> CMakeValue | None:
        """A normal or cache variable, None when nothing has set or unset it."""
        value = self.scope.get(name)
        return value if value is not None else self.cache.get(name)

    def assign(self, where: dict[str, CMakeValue], name: str, value: CMakeValue) -> None:
        """Writes into a scope, so that a branch on trial can take it back."""
        if len(value.text) > 4096:
            self.spend(len(value.text) >> 12)
        if self.recording:
            self.journal.append((where, name, where.get(name)))
        where[name] = value

    def set(self, name: str, words: Iterable[Word], sure: bool = True) -> None:
        """Sets a normal variable to a list; under a condition its words remember it."""
        kept = add_conditions(words, self.conditions)
        if len(kept) > MAX_WORDS:
            self.give_up(self.call_site, f"`{name}` has more than {MAX_WORDS} items")
            kept = kept[:MAX_WORDS]
        self.assign(self.scope, name, CMakeValue(kept, sure and all(item.sure for item in kept)))

    def set_text(self, name: str, text: str | None, at: At, sure: bool = True) -> None:
        """Sets a normal variable to a single text, or as set_unknown() where that is None."""
        if text is None:
            self.set_unknown(name, at)
            return
        self.assign(self.scope, name, CMakeValue((wrap(text[:MAX_TEXT], at, self.conditions, sure),), sure))

    def set_unknown(self, name: str, at: At) -> None:
        """Marks a variable as set to something that cannot be known; it reads as `${name}`."""
        self.assign(self.scope, name, CMakeValue((wrap(f"${{{name}}}", at, (), False),), False))

    def lookup(self, scope: str, name: str) -> CMakeValue | None:
        """What a reference reads."""
        if scope == "ENV":
            return self.environment.get(name)
        if scope == "CACHE":
            return self.cache.get(name)
        value = self.overlay.get(name) if self.overlay else None
        if value is None:
            value = self.get(name)
            if value is None and name.startswith("ARGV"):
                return UNSET  # beyond the last argument
        return value

    def expand(self, templates: Iterable[Template]) -> list[Word]:
        """Arguments after expansion and list splitting."""
        words: list[Word] = []
        for template in templates:
            kind = template.kind
            if kind == LITERAL:
                words.extend(template.words)
            elif kind == REFERENCE:
                value = self.resolve_reference(template)
                alone = not value.sure and not words and len(value.chosen) == 1
                words.extend([item for item in (value.chosen if alone else value.words) if item])
            else:
                words.extend(self.expand_one(template))
            if len(words) > MAX_WORDS:
                self.give_up(template.at, f"more than {MAX_WORDS} arguments")
                words = words[:MAX_WORDS]
                break
        self.spend(len(words) >> 5)
        return words

    def resolve_reference(self, template: Template) -> CMakeValue:
        """The value behind a plain `${name}`."""
        name = template.name
        value = self.lookup("", name)
        if value is None:
            self.use_variable(name, template.at)
            return CMakeValue((wrap(f"${{{name}}}", template.at, (), False),), False)
        if not value.sure:
            value = _put_unknown(value, f"${{{name}}}", template.at)
        return _flatten(value)

    def expand_one(self, template: Template) -> tuple[Word, ...]:
        """Words of a quoted reference or a mixed argument."""
        at = template.at
        if template.kind == QUOTED_REFERENCE:
            value = self.lookup("", template.name)
            if value is None:
                self.use_variable(template.name, at)
                return (wrap(f"${{{template.name}}}", at, (), False),)
            self.spend(len(value.text) >> 10)
            single = wrap(value.text, at, (), value.sure)
            single.parts = value.words if value.sure else value.chosen
            return (single,)
        text, sure, conditions = read_references(template.parts, self._lookup_used(at))
        self.spend(len(text) >> 10)
        if len(text) > MAX_TEXT:
            self.give_up(at, f"a value is longer than {MAX_TEXT} characters")
            text = text[:MAX_TEXT]
        if template.quoted:
            return (wrap(text, at, conditions, sure),)
        return tuple(wrap(part, at, conditions, sure) for part in split_list(text))

    def _lookup_used(self, at: At) -> Callable[[str, str], CMakeValue | None]:
        def lookup(scope: str, name: str) -> CMakeValue | None:
            value = self.lookup(scope, name)
            if value is None and not scope:
                self.use_variable(name, at)
            return value

        return lookup

    def use_variable(self, name: str, at: At) -> None:
        """Notes a variable that is read and that nothing sets, when its name tells that a package should."""
        if self.silent or name.startswith("CMAKE_"):
            return
        place = self.locate(at)
        if self.command == "install" and not name.startswith("CATKIN_") and not self._may_be_set(name):
            self.uses[CMakeUse("unset", name, place, self.command, self.conditions)] = None
        alike = "" if name.endswith(READ_SUFFIXES) else self.find_alike(name)
        if (
            not alike
            and not name.endswith(READ_SUFFIXES)
            and not (name.startswith("CATKIN_") and self.command == "install")
        ):
            return
        self.uses[CMakeUse("variable", name, place, self.command, self.conditions, alike)] = None

    def use_environment(self, test: str, at: At) -> None:
        """Notes the environment variables of ROS whose value a test reads, where no test asks whether they are set."""
        tests_around = [test, *(held.text for held in self.conditions)]
        for name in dict.fromkeys(_ROS_ENVIRONMENT.findall(test)):
            asks = re.compile(rf'DEFINED ENV\{{{name}\}}|(?:NOT )?\$ENV\{{{name}\}}(?: STREQUAL "")?\Z')
            if not self.silent and f"$ENV{{{name}}}" not in self.replaced and not any(map(asks.search, tests_around)):
                self.uses[CMakeUse("environment", name, self.locate(at), "", self.conditions)] = None

    def find_alike(self, name: str) -> str:
        """The variable that is set and has one word more or less in its name than one that a command which needs its
        value reads; empty where there is none, or something may have set that one."""
        words = name.split("_")
        if self.command not in _NEEDS_VALUES or len(name) < 8 or len(words) < 2 or self._may_be_set(name):
            return ""
        alike = [other for other in self.scope if abs(other.count("_") + 1 - len(words)) == 1]
        alike = [other for other in alike if _is_longer(other.split("_"), words) or _is_longer(words, other.split("_"))]
        return str(alike[0]) if len(alike) == 1 else ""

    def _may_be_set(self, name: str) -> bool:
        """Whether something that is not seen here may set a variable: a command of which nothing is known, or a
        package, whose variables begin as it is called (`find_package(Qt${VERSION})`)."""
        prefixes = (*self.renamed, *(found.name for found in self.found))
        if name in self.maybe_set or name.lower().startswith(tuple(prefix.lower() for prefix in prefixes)):
            return True
        return any(re.match(r"(?!find_package\()|find_package\(\$", reason) for _, reason in self.unresolved)

    def is_target(self, name: str) -> bool | None:
        """True when the tree makes this target, whatever other conditions hold than those which stand here."""
        draft = self.targets.get(name) if name in self.targets else None
        made = draft is not None and (not draft.ways or any(set(way).issubset(self.conditions) for way in draft.ways))
        return True if made or self.is_typesupport(name) else None

    def is_typesupport(self, name: str) -> bool:
        """True for `T__x`, where rosidl generates interfaces as T: which x there are hangs on what is installed."""
        base, separator, _ = name.partition("__")
        return bool(separator) and any(made.how == "rosidl" and made.target == base for made in self.generated)

    def is_command(self, name: str) -> bool | None:
        """True when the tree or any version of CMake defines this command."""
        name = name.lower()
        if name in SINCE and name not in self.definitions:
            return None
        return True if name in self.definitions or (name in COMMANDS and name not in MODULE_OF) else None

    def has_path(self, path: str) -> bool | None:
        """Whether a path of the package exists; None outside of it, and where that is not known: what is not there may
        have been written by a program that configuring has run before."""
        relative = self.make_relative(path) if path.startswith("/") else None
        if relative is None or not (self.is_in_package(relative) or relative == self.package_path):
            return None
        known = self.exists(relative)
        if known is None:
            return None
        if known or self.glob(f"{relative}/*" if relative else "*", True):
            return True
        return None if self.starts else False

    def set_match_groups(self, groups: tuple[str, ...]) -> None:
        """Sets CMAKE_MATCH_<n>."""
        at = self.get_current_place()
        for index, text in enumerate(groups[:10]):
            self.set_text(f"CMAKE_MATCH_{index}", text, at)

    def protects_quoted(self) -> bool:
        """CMP0054: quoted arguments of if() are no variable names from policy version 3.1 on."""
        return self.minimum_policy >= (3, 1)

    def make_absolute(self, relative: str) -> str:
        """A path of the tree as CMake code sees it."""
        return posixpath.normpath(f"{SOURCE}/{relative}") if relative else SOURCE

    def make_relative(self, path: str) -> str | None:
        """A path that CMake code holds, relative to the workspace root; None when it lies elsewhere."""
        if not path.startswith(SOURCE):
            return None
        normal = posixpath.normpath(path)
        if normal == SOURCE:
            return ""
        return normal[len(SOURCE) + 1 :] if normal.startswith(SOURCE + "/") else None

    def get_current_directory(self) -> str:
        """CMAKE_CURRENT_SOURCE_DIR as CMake code sees it."""
        value = self.scope.get("CMAKE_CURRENT_SOURCE_DIR")
        return value.text if value is not None else SOURCE

    def resolve(self, text: str, base: str | None = None) -> str:
        """A path argument, absolute: relative ones start at `base`, else at the current source folder."""
        if text.startswith(("/", "$", "~")):
            return text
        return posixpath.normpath(posixpath.join(base or self.get_current_directory(), text))

    def resolve_tree_path(self, text: str) -> str:
        """A path argument relative to the workspace root when it can be known, else as a reader would write it."""
        if not text or text.startswith("$<"):
            return self.clean(text)
        relative = self.make_relative(self.resolve(text))
        if relative is None:
            return self.clean(text)
        if "/../" in text and (owner := self.exported.get(text.partition("/../")[0], self.package)) != self.package:
            self.from_found[relative, owner] = None
        return relative + "/" if text.endswith("/") and relative else relative

    def clean(self, text: str) -> str:
        """A text without the names this interpreter gives to the tree, the build and the install folder."""
        if "/@" not in text:
            return str(text)
        text = text.replace(f"{SOURCE}/", "").replace(SOURCE, ".")
        text = text.replace(f"{BINARY}/{self.package}", "${CMAKE_BINARY_DIR}").replace(BINARY, "${CMAKE_BINARY_DIR}")
        return text.replace(f"{PREFIX}/", "").replace(PREFIX, "")

    def is_in_package(self, path: str) -> bool:
        """True for a file of the package itself."""
        return not self.package_path or path.startswith(self.package_path + "/")

    def locate(self, at: At) -> At:
        """The place a finding should point at: inside the package, so a call into another one's macro stands for it."""
        return self.call_site if self.call_site is not None and not self.is_in_package(at.path) else at

    def merge_with(self, item: Word) -> tuple[Condition, ...]:
        """The conditions that hold for a word here."""
        return merge(self.conditions, item.conditions)

    def get_current_place(self) -> At:
        """A place for what has none of its own."""
        return self.call_site or At(self.including[-1] if self.including else "", 1)

    def give_up(self, at: At | None, reason: str) -> None:
        """Notes what could not be known."""
        if not self.silent:
            self.unresolved[(self.locate(at or self.get_current_place()), reason)] = None

    def add_read(self, path: str | None, command: str, name: Word) -> None:
        """Collects a file of CMake code that lies outside of the package, or that does not exist. path: as relative()
        gives it. name: how it is written."""
        place = self.clean(name) if path is None else path
        if not self.silent and self.call_site is None and name.sure and "$" not in place:
            self.read_elsewhere[ReadFile(place, command, self.locate(name.at), self.merge_with(name))] = None

    def add_tools(self, args: list[Word]) -> None:
        """Collects the programs that the arguments of ExternalProject_Add() or FetchContent_Declare() start: what
        downloads, and the commands of steps."""
        for keyword, value in itertools.pairwise(args):
            program = _DOWNLOADERS.get(keyword) or (str(value) if keyword.endswith("_COMMAND") else "")
            if program and value and "$" not in program and "/" not in program:
                self.add_found(
                    FoundPackage(program, "program", self.locate(value.at), True, conditions=self.merge_with(value))
                )

    def add_found(self, found: FoundPackage) -> None:
        """Collects a package looked for."""
        if self.handing_on:
            self.handed_on[found] = None
        elif not self.silent:
            self.found[structs.replace(found, via=self.via) if self.via else found] = None

    def add_install(
        self, kind: str, items: Iterable[str], destination: str, of: Word | CommandCall, **more: Any
    ) -> None:
        """Collects an install rule. of: what names it, whose place and conditions it has. more: fields of Install."""
        conditions = self.merge_with(of) if isinstance(of, Word) else self.conditions
        fields = {"at": self.locate(of.at), "conditions": conditions, **more}
        install = Install(kind, tuple(items), destination, **fields)
        if not self.silent and install.items:
            self.installs[install] = None

    def add_export(
        self, item: str, how: str, at: At, conditions: tuple[Condition, ...], context: str = "", executable: str = ""
    ) -> None:
        """Collects a promise to dependants."""
        if not self.silent and item:
            self.exports[CMakeExport(self.clean(item), how, self.locate(at), conditions, context, executable)] = None

    def add_standard(self, number: int, at: At, is_default: bool, by_flag: bool) -> None:
        """Collects a C++ standard set for everything."""
        if not self.silent:
            self.standards.append((number, self.locate(at), is_default, by_flag, self.conditions))

    def add_target(self, name: Word, kind: str) -> TargetDraft:
        """Makes the target that add_library(), add_executable() or add_custom_target() adds."""
        before, conditions = self.targets.get(name), self.merge_with(name)
        if before is not None and before.added and kind not in ("imported", "alias") and name.sure and not self.silent:
            opposite = {(held.text, not held.negated) for held in conditions}
            asked = re.compile(rf"TARGET {re.escape(name)}(?!\S)")
            meeting = [way for way in before.ways if not any((held.text, held.negated) in opposite for held in way)]
            if meeting and not any(asked.search(held.text) for held in conditions):
                # One that every branch has made stands there under what these have in common.
                self.refuse("twice", name, before.conditions if len(meeting) == len(before.ways) else meeting[0])
        draft = self.ensure_target(name, kind, name.at)
        draft.added = name.sure and kind not in ("imported", "alias")
        return draft

    def refuse(
        self,
        kind: str,
        name: Word,
        conditions: tuple[Condition, ...] = (),
        patterns: Sequence[str] = (),
        ways: Sequence[tuple[Condition, ...]] = (),
    ) -> None:
        """Notes a name at which CMake stops. conditions: that it stops under besides those of the place. patterns,
        ways: as of RefusedName."""
        if name.sure and "$<" not in name and not self.silent:
            conditions = merge(conditions, self.merge_with(name))
            made = RefusedName(kind, str(name), self.locate(name.at), conditions, tuple(ways), tuple(patterns))
            self.refused[made] = None

    @property
    def installed_name(self) -> str:
        """The name under which the package installs itself."""
        return self.project or self.package

    def refuse_project(self) -> None:
        """Notes the name of the project where it is not that of the package, which ament_package_xml() of
        ament_cmake_core and catkin_package_xml() of catkin compare; they set the version too."""
        held = self.get("PROJECT_NAME")
        if held is not None and held.sure and held.text != self.package:
            folder = posixpath.dirname(self.locate(held.words[0].at).path)
            # A package below this one has a manifest of its own.
            if folder == self.package_path or not self.exists(posixpath.join(folder, "package.xml")):
                self.refuse("project", held.words[0])
        self.set_unknown(f"{self.project}_VERSION", self.get_current_place())

    def ensure_target(self, name: Word | str, kind: str, at: At) -> TargetDraft:
        """Makes or finds a target; a second one of the same name adds to the first."""
        conditions = self.merge_with(name) if isinstance(name, Word) else self.conditions
        return self.targets.make(str(name), kind, self.locate(at), conditions)


def format_all(conditions: Sequence[Condition], rest: str) -> str:
    """Conditions that hold together, and a further test, as one test."""
    tests_together = [f"NOT {group(held.text)}" if held.negated else group(held.text) for held in conditions]
    if rest:
        tests_together.append(group(rest))
    return " AND ".join(tests_together)


def group(test: str) -> str:
    """A test as a part of another one."""
    return f"( {test} )" if " AND " in test or " OR " in test else test


def _is_longer(long: list[str], short: list[str]) -> bool:
    """True for the words of a name with one more among them; numbers tell things apart."""
    return any(long[:i] + long[i + 1 :] == short and long[i].isalpha() for i in range(len(long)))


def _make_arguments_value(args: list[Word]) -> CMakeValue:
    """Arguments as the value of ARGV or ARGN."""
    words: list[Word] = []
    for item in args:
        if ";" in item and item.parts:
            words.extend(item.parts)
        else:
            words.append(item)
    return CMakeValue(tuple(words), all(item.sure for item in words))


def _put_unknown(value: CMakeValue, unknown: str, at: At) -> CMakeValue:
    """The value with what is not known of it standing where it is read."""
    if unknown not in value.words:
        return value
    here = wrap(unknown, at, (), False)
    made = CMakeValue(tuple(here if item == unknown else item for item in value.words), False, value.defined)
    if value.chosen is not value.words:
        made.chosen = tuple(here if item == unknown else item for item in value.chosen)
        made.text = value.text
    return made


def _flatten(value: CMakeValue) -> CMakeValue:
    """A value whose words hold no more lists: an argument in quotes may."""
    for item in value.words:
        if ";" in item:
            break
    else:
        return value
    made = CMakeValue(tuple(split_words(value.words)), value.sure, value.defined)
    if value.chosen is not value.words:
        made.chosen = tuple(split_words(value.chosen))
    return made


HANDLERS: dict[str, Handler] = {}
WRAPPERS: dict[str, Handler] = {}


def _register_in(table: dict[str, Handler]) -> Callable[..., Callable[[Handler], Handler]]:
    """A decorator that puts functions into a table."""

    def register(*names: str, least: int = 0) -> Callable[[Handler], Handler]:
        def keep(handler: Handler) -> Handler:
            @wraps(handler)
            def handle(run: Interpreter, call: CommandCall, args: list[Word]) -> int | None:
                return handler(run, call, args) if len(args) >= least else None

            table.update(dict.fromkeys(names, handle if least else handler))
            return handle

        return keep

    return register


# Registers the decorated function as the meaning of these commands, where they have at least so many arguments; the
# second, as one that is used only when the tree itself does not define the command.
handles, stands_in_for = _register_in(HANDLERS), _register_in(WRAPPERS)


def is_modelled(command: str, conditions: Iterable[Condition]) -> bool:
    """Whether it is known what a command does that nothing in the tree defines, or it is called for tests alone."""
    return command in HANDLERS or command in WRAPPERS or is_for_tests(conditions)


def calls_unmodelled(build: Build | Interpreter, for_tests: bool = False) -> bool:
    """Whether a package calls what may make anything, such as headers: a function of another package of which it is not
    known what it does. for_tests: what is called for tests alone counts too, as what tests use may come of it."""
    return any(
        use.kind == "command" and not is_modelled(use.name, () if for_tests else use.conditions) for use in build.uses
    )
