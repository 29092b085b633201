"""What a package says of publishing, in short: its publish statements with all that decides when they run, its
publishers and its subscribers. Small enough to be kept for every commit of a repository's life."""

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

import msgspec

from ...edges.memory import cache_method
from ..facts import kinds
from ..facts.flow import FlowCall, FlowExpr, FlowFile
from ..model.flow.code import FlowCode, Fn, get_tail
from ..model.flow.endpoints import Site, Statement, unparse
from ..model.flow.graph import GuardAt, Node, Trigger
from ..model.flow.join import CallWay, Join, Owner
from ..model.flow.nodes import BuiltPackage, asks_for_name, find_entry_point
from ..model.flow.qos import find_qos
from ..model.flow.values import FlowValue
from .history import PackageFile, PackageState
from .meaning import Given, Meaning, format_expression, select_given, split_conjuncts
from .periods import parse_period

_LIVE = frozenset(
    ("ros::ok()", "rclcpp::ok()", "ok()", "true", "True", "1", "rclpy.ok()", "not rospy.is_shutdown()",
     "not rospy.core.is_shutdown()", "!ros::isShuttingDown()", "not is_shutdown()", "(1)", "(true)")
)  # fmt: skip
_OK = re.compile(r"(?:(?:[\w.]|->)+(?:\.|->))?(?:ros_?)?ok\(\)")
"""That a node, its library or a wrapper of that is up."""
_LOOPS = frozenset(("while", "do"))
_CALLS = re.compile(r"\w\s*[(\[]|\]\s*\(")
_NAMES = re.compile(r"(?<![\w.>:\"'])(?:this->|self\.)?([A-Za-z_]\w*)(?![\w\"':])")
"""Variables in a condition, without what stands behind a point or in a scope."""
_RUN_AS_PROGRAM = re.compile(r"__name__\s*==\s*(['\"])__main__\1")
_CAUGHT = re.compile(r"except (.*)|catch \((.*)\)", re.DOTALL)
_WORDS = frozenset(("and", "or", "not", "is", "in", "true", "false", "True", "False", "None", "nullptr", "NULL"))


class Gate(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A guard. kind, text and of as in GuardAt; meaning: the text with local variables and predicates of the package
    put back into what they stand for, empty where that is the text. fixed: what it asks is the same wherever its
    function asks it, since nothing there changes it. tried: of a guard that says that nothing was raised, the calls
    that might do so, each up to the end of its first argument and without blanks. kind: `passed` besides, for such a
    guard that asks for nothing, since what is raised leads nowhere anyway."""

    kind: str
    text: str
    of: str
    meaning: str = ""
    fixed: bool = False
    given: Given = ()
    names: tuple[str, ...] = ()
    tried: tuple[str, ...] = ()


class StatementStart(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What makes a statement run. kind: as in Trigger, `loop` where a loop does that the start of a program leads to,
    `thread` for one that nothing leads to; detail: the period, topic or service, the rate of a loop. open: the detail
    is an expression, and which topic or service that is is not known."""

    kind: str
    detail: str = ""
    open: bool = False


class Path(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One way to a statement; gates outermost first. Loops that last as long as the node does are not among them. root:
    the function where it begins when nothing is seen that leads to it: no caller, or nobody who makes the object.
    functions: those that it runs through before the statement's own. times: how many ways with the same guards it
    stands for."""

    start: StatementStart
    gates: tuple[Gate, ...] = ()
    root: str = ""
    functions: tuple[str, ...] = ()
    times: int = 1


class Outlet(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A publisher. path: relative to the package. topic: as the node knows it (`~name` for a private one), empty when
    it is not known. full: its names in a running system, for each node that has it. offers: (setting, value) of its
    queue and quality of service as far as they are known; written: the expression of it."""

    path: str
    line: int
    function: str
    variable: str
    topic: str
    full: tuple[str, ...]
    type: str
    offers: tuple[tuple[str, str], ...] = ()
    written: str = ""


class PublishStatement(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A publish statement. path: relative to the package. variable: the publisher as written. outlets: places in
    Digest.outlets of those that it may use. nodes: names of the nodes that run it."""

    path: str
    line: int
    function: str
    variable: str
    outlets: tuple[int, ...]
    type: str
    expression: str
    language: str
    nodes: tuple[str, ...]
    ways: tuple[Path, ...]


class Inlet(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A subscriber. path: relative to the package, of the callback where that is known, as line is; topic: its full
    name."""

    topic: str
    node: str
    callback: str
    path: str
    line: int


class PackageStatements(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A package at one commit. unread: files that were not read, or not in full. unclear: path, function and callee of
    calls that may publish, of which it is not known. swallowed: names of functions of which it does not matter to what
    follows a call that they raised something."""

    statements: tuple[PublishStatement, ...] = ()
    outlets: tuple[Outlet, ...] = ()
    inlets: tuple[Inlet, ...] = ()
    unread: tuple[str, ...] = ()
    unclear: tuple[tuple[str, str, str], ...] = ()
    swallowed: tuple[str, ...] = ()


EMPTY = PackageStatements()


class Before:
    """The code of the state that was digested last, for the next one of the same package."""

    def __init__(self) -> None:
        self.code: FlowCode | None = None


def digest_package(state: PackageState, facts: Mapping[str, Any], before: Before | None = None) -> PackageStatements:
    """What a package says of publishing. facts: of each file of the state by its path: a FlowFile, CMakeFile or
    SetupFile; those of a file that did not change are the same objects. before: of neighbouring states, to be quick."""
    sources = {f.path: facts[f.path] for f in state.files if isinstance(facts.get(f.path), FlowFile)}
    before = before or Before()
    last, before.code = before.code, None
    join = Join(sources, lambda _: state.name, (read_build(state, facts),), state.ros, before=last)
    before.code = join.code
    if not join.calls.uses:
        return PackageStatements(unread=_list_unread_files(join), unclear=_list_unclear(join))
    return _Digester(join, state).build_digest()


def _list_unread_files(join: Join) -> tuple[str, ...]:
    return tuple(sorted(one.path for one in join.code.sources if one.facts.unread or one.facts.problems))


def _list_unclear(join: Join) -> tuple[tuple[str, str, str], ...]:
    names = {name for name, rows in join.calls.table.calls.items() if any(row.does == "publish" for row in rows)}
    clear = {id(statement.use.call) for statement in join.sites.statements}
    return tuple(
        (fn.source.path, fn.name, call.callee)
        for fn in join.code.functions
        for call in fn.facts.calls
        if get_tail(call.callee) in names and "." in call.callee and id(call) not in clear
    )


def _find_handler(fn: Fn, what: str, line: int) -> int:
    """The line of the first handler of a try that begins at a line and catches something; 0 where none is seen."""
    lines = [row.line for row in fn.facts.guards if row.kind == "catch" and row.line >= line]
    last = min((row.line for row in fn.facts.guards if row.kind == "catch" and row.text == what and row.line >= line),
               default=0)  # fmt: skip
    return min([one for one in lines if one <= last], default=last)


def _is_in_handler(fn: Fn, call: FlowCall, line: int) -> bool:
    """Whether a call stands in a handler of a try that begins at a line, or of one inside it."""
    place, rows = call.guard, fn.facts.guards
    while 0 <= place < len(rows):
        if rows[place].kind == "catch" and rows[place].line >= line:
            return True
        place = rows[place].outer
    return False


def _list_swallowed(join: Join) -> tuple[str, ...]:
    """The names of functions called before a handler behind which the function that has it goes on, or ends."""
    found: set[str] = set()
    for fn in join.code.functions:
        rows = fn.facts.guards
        left = {
            (caught[1] or caught[2], row.line)
            for row in rows
            if row.kind == "unless" and (caught := _CAUGHT.fullmatch(row.text))
        }
        for row in rows:
            if row.kind == "catch" and not any(what == row.text and line <= row.line for what, line in left):
                before = (call for call in fn.facts.calls if call.line <= row.line)
                found.update(get_tail(call.callee) for call in before if not _is_in_handler(fn, call, row.line))
    return tuple(sorted(found))


class _Digester:
    def __init__(self, join: Join, state: PackageState):
        self.join, self.state = join, state
        self.running = join.list_running()
        self.meaning = Meaning(join.code)
        # What a framework subscribes to by itself (a transform listener) makes nothing run.
        self.implied = {
            (site.use.fn.source.path, site.use.call.line)
            for site in join.sites.endpoints
            if site.implied and site.role == "subscriber"
        }
        # Of a function that is given names and callbacks it is not known which name is that of which callback.
        self.unnamed = {
            (site.use.fn.source.path, site.use.call.line)
            for site in join.sites.endpoints
            if site.role != "publisher"
            and (
                not any(value.text for value in site.names)
                or (len({value.text for value in site.names}) > 1 and len(site.callbacks) > 1)
            )
        }

    def build_digest(self) -> PackageStatements:
        join = self.join
        outlets: list[Outlet] = []
        places: dict[int, int] = {}
        inlets: list[Inlet] = []
        for site in join.sites.endpoints:
            if site.role == "publisher":
                places[id(site)] = len(outlets)
                outlets.append(self._make_outlet(site))
            elif site.role == "subscriber":
                inlets.extend(self._make_inlets(site))
        known = {site: place for site in join.sites.endpoints if (place := places.get(id(site))) is not None}
        published: list[PublishStatement] = []
        for statement in join.sites.statements:
            if statement.through or self._has_no_publisher(statement):
                continue
            numbers: list[int] = []
            for site in statement.sites:
                if site not in known:  # published by name
                    known[site] = len(outlets)
                    outlets.append(self._make_outlet(site))
                numbers.append(known[site])
            published.append(self._build_statement(statement, tuple(dict.fromkeys(numbers))))
        return PackageStatements(
            tuple(published), tuple(outlets), tuple(
                dict.fromkeys(inlets)
            ), _list_unread_files(join), _list_unclear(join), _list_swallowed(join)
        )

    def _has_no_publisher(self, statement: Statement) -> bool:
        """Whether a statement in Python is of a member that nothing assigns, of a class of which all is seen."""
        fn, code = statement.use.fn, self.join.code
        before, _, name = self.join.calls.get_receiver(statement.use).rpartition(".")
        owner = code.find_owner(fn) if before == "this" and fn.source.facts.language == "python" else None
        if statement.sites or owner is None or owner.key in code.derived:
            return False
        classes = code.list_bases(owner)
        if not self._assigned.isdisjoint((key, name) for key in ("", *(cls.key for cls in classes))):
            return False
        bases = ((base, cls) for cls in classes for base in cls.facts.bases if base not in ("", "object"))
        return all(code.find_class(base, cls.source, cls.name) is not None for base, cls in bases)

    @cached_property
    def _assigned(self) -> frozenset[tuple[str, str]]:
        """What something is assigned to, or the result of a call is kept in: members by class and name, with an empty
        class where they are of another object, or of a class that is not seen."""
        found: set[tuple[str, str]] = set()
        for fn in self.join.code.functions:
            owner = self.join.code.find_owner(fn)
            key = owner.key if owner is not None else ""
            for target in (*(row.target for row in fn.facts.assignments), *(call.target for call in fn.facts.calls)):
                before, _, name = target.rpartition(".")
                found.add((key if before == "this" else "", name))
        return frozenset(found)

    def _find_owners(self, fn: Fn) -> list[Owner]:
        found: list[Owner] = [one for one in self.running if fn in one.functions]
        return found or [one for one in self.running if fn.source.path in one.program.files] or [self._make_library(fn)]

    def _make_library(self, fn: Fn) -> Node:
        path = fn.source.path
        made = self.join.built[0].libraries
        name = next((name for name, files in made.items() if path in files), path.rpartition("/")[2])
        return Node(f"{self.state.name}/{name}", "", self.state.name, "library")

    def _make_outlet(self, site: Site) -> Outlet:
        use = site.use
        full = tuple(dict.fromkeys(self._resolve_topics(site)))
        value = site.names[0] if len({value.text for value in site.names}) == 1 else FlowValue(None)
        found = find_qos(self.join.calls, self.join.values, use)
        offers: list[tuple[str, str]] = []
        for name in found.__struct_fields__ if found is not None else ():
            setting = getattr(found, name)
            if name != "written" and setting not in ("", -1, None):
                offers.append((name, str(setting)))
        written = " ".join(found.written.split()) if found is not None else ""
        variable = use.call.target or (site.variable.name if site.variable else "")
        return Outlet(
            use.fn.source.path, use.call.line, use.fn.name, variable,
            _resolve_local_topic(site, value), full, site.type, tuple(offers), written,
        )  # fmt: skip

    def _resolve_topics(self, site: Site) -> Iterator[str]:
        for value in site.names:
            for owner in self._find_owners(site.use.fn):
                node = _get_node(owner)
                own = _resolve_local_topic(site, value).startswith("~") or "{" in (value.text or "")
                if value.text is None or (own and (node is None or node.kind == "library")):
                    continue  # the name of a node that is not known is not guessed
                topic, _, _ = self.join.resolve_name(site, value, owner)
                if topic:
                    yield topic

    def _make_inlets(self, site: Site) -> Iterator[Inlet]:
        use = site.use
        callback = site.callbacks[0] if site.callbacks else None
        fn = callback or use.fn
        line = callback.facts.line if callback is not None else use.call.line
        for value in site.names:
            for owner in self._find_owners(use.fn):
                node = _get_node(owner)
                for topic in self._resolve_topics(site._replace(names=(value,))):
                    yield Inlet(topic, node.id if node else "", callback.name if callback else "", fn.source.path, line)

    def _build_statement(self, statement: Statement, outlets: tuple[int, ...]) -> PublishStatement:
        use, join = statement.use, self.join
        fn = use.fn
        own = join.list_guards(fn, use.call.guard)
        led = ((way, way.trigger) for way in join.list_ways(fn))
        found = [way for way, by in led if by.kind != "subscriber" or (by.path, by.line) not in self.implied]
        found = found or [CallWay(Trigger("unknown", "", "", 0))]
        ways = [self._build_path(way, fn, own) for way in found]
        nodes = tuple(sorted({node.id for node in map(_get_node, self._find_owners(fn)) if node is not None}))
        return PublishStatement(
            fn.source.path, use.call.line, fn.name, join.calls.get_receiver(use), outlets, statement.type,
            statement.expression, fn.source.facts.language, nodes, tuple(dict.fromkeys(ways)),
        )  # fmt: skip

    @cached_property
    def _handed(self) -> dict[str, Fn]:
        """Lambdas that no call is seen of, by their names: they run where they stand, or when who got them wants."""
        code = self.join.code
        return {fn.name: fn for fn in code.functions if fn.is_lambda and not code.callers.get(fn)}

    def _find_trigger(self, way: CallWay, fn: Fn) -> Trigger:
        """What a way begins with: not known where the start of a program hands a lambda to something."""
        if way.trigger.kind == "start":
            handed = next((self._handed[name] for name in (*way.functions, fn.name) if name in self._handed), None)
            if handed is not None:
                return Trigger("unknown", get_tail(handed.name), handed.source.path, handed.facts.line)
        return way.trigger

    def _build_path(self, way: CallWay, fn: Fn, own: tuple[GuardAt, ...]) -> Path:
        trigger, guards = self._find_trigger(way, fn), (*way.guards, *own)
        is_open = trigger.kind != "timer" and (trigger.path, trigger.line) in self.unnamed
        start = StatementStart(trigger.kind, self._find_period(trigger) or trigger.detail, is_open)
        unsaid = trigger.kind in ("start", "unknown")
        unled = trigger.kind == "unknown" or (trigger.kind == "start" and trigger.detail not in ("", "main"))
        gates: list[Gate] = []
        given = self._list_given(way, fn)
        for place, guard in enumerate(guards):
            asked, lives = _strip_liveness(guard.text) if guard.kind in _LOOPS else (guard.text, False)
            loops = any(one.kind in _LOOPS for one in guards[:place])
            if unsaid and loops and guard.kind == "if" and _is_live(guard.text):
                asked, lives = "", True  # what stands in the loop's condition itself
            if unsaid and (lives or (guard.kind in _LOOPS and trigger.kind == "start")):
                kind = "loop" if trigger.kind == "start" else "thread"
                start = StatementStart(kind, self._find_rate(guard) or (start.detail if start.kind == kind else ""))
            if asked and not _is_program(guard):
                meaning, names = self.meaning.resolve_guard(guard) if asked == guard.text else ("", ())
                known = select_given(meaning or asked, given.get((guard.path, guard.of), ()))
                tried = self._list_tried(guard)
                gates.append(Gate(guard.kind, asked, guard.of, meaning, self._is_fixed(guard), known, names, tried))
        if start.kind in ("start", "unknown"):
            start = StatementStart(start.kind)
        return Path(start, tuple(gates), self._find_root(trigger) if unled else "", way.functions, way.times)

    @cache_method
    def _find_period(self, trigger: Trigger) -> str:
        """The period of a timer that is written with names, where these stand for a number; empty otherwise."""
        if trigger.kind != "timer" or parse_period(trigger.detail) is not None:
            return ""
        functions = self.join.code.functions_in.get(trigger.path, ())
        maker = next((fn for fn in functions if any(call.line == trigger.line for call in fn.facts.calls)), None)
        meant = self.meaning.resolve_text(trigger.detail, maker, trigger.line) if maker is not None else ""
        return meant if parse_period(meant) is not None else ""

    def _list_given(self, way: CallWay, fn: Fn) -> dict[tuple[str, str], Given]:
        """What the parameters of functions are on a way, as far as guards ask for them; by path and name."""
        root = way.steps[0][0] if way.steps else fn
        known = self.meaning.mark_parameters(root)
        found = {(root.source.path, root.name): known}
        for (caller, call), callee in zip(way.steps, [*(one for one, _ in way.steps[1:]), fn], strict=False):
            if call is not None:
                asked = self.join.list_asked_parameters(callee)
                known = self.meaning.resolve_arguments(call, caller, callee, asked, known) if asked else ()
            if known:
                found[callee.source.path, callee.name] = known
        return found

    def _find_root(self, trigger: Trigger) -> str:
        """The whole name of the function that a way begins in."""
        functions = self.join.code.functions_in.get(trigger.path, ())
        return next((fn.name for fn in functions if fn.facts.line == trigger.line), trigger.detail)

    @cache_method
    def _list_tried(self, guard: GuardAt) -> tuple[str, ...]:
        """The calls that may raise what a guard says that it was not, as in Gate."""
        fn = self.join.code.by_name.get((guard.path, guard.of))
        caught = _CAUGHT.fullmatch(guard.text) if guard.kind == "unless" else None
        if fn is None or caught is None:
            return ()
        what = caught[1] or caught[2]
        end = _find_handler(fn, what, guard.line)
        python = fn.source.facts.language == "python"
        found: dict[str, None] = {}
        for call in fn.facts.calls if end else ():
            if guard.line <= call.line <= end and not _is_in_handler(fn, call, guard.line):
                first = format_expression(call.arguments[0], python, fn, call.line) if call.arguments else ""
                text = f"{get_tail(call.callee)}({first or ''}"
                found[strip_spelling(text)] = None
        return tuple(found)

    @cache_method
    def _is_fixed(self, guard: GuardAt) -> bool:
        """Whether a guard asks for variables alone that its function, and what that calls of the code, leaves alone."""
        fn = self.join.code.by_name.get((guard.path, guard.of))
        plain = guard.kind in ("if", "unless") and not _CALLS.search(guard.text)
        return plain and fn is not None and all(self._is_constant(name, fn) for name in _NAMES.findall(guard.text))

    def _is_constant(self, name: str, fn: Fn) -> bool:
        if name in _WORDS or name.isupper():
            return True
        local = name in fn.locals
        made = [row for target in (name, f"this.{name}") for row in fn.assigned.get(target, ())]
        parameter = any(one.name == name for one in fn.facts.parameters)
        if len(made) > (local and not parameter) or any(row.operator != "=" for row in made):
            return False
        return name not in self._changes(fn) and (local or not self._calls_own(fn))

    @cache_method
    def _changes(self, fn: Fn) -> frozenset[str]:
        """The variables of which a function changes more than by assigning to them."""
        return frozenset(one.path.removeprefix("this.").partition(".")[0] for one in fn.facts.accesses)

    @cache_method
    def _calls_own(self, fn: Fn) -> bool:
        return any(self.join.code.list_targets(call.callee, fn) for call in fn.facts.calls)

    def _find_rate(self, guard: GuardAt) -> str:
        """The rate at which a loop goes round, as it is written where it is made; empty when none is seen, or several
        that only some rounds keep."""
        fn = self.join.code.by_name.get((guard.path, guard.of))
        if fn is None:
            return ""
        rows = fn.facts.guards
        paces: list[tuple[bool, bool, str]] = []
        for call in fn.facts.calls:
            if get_tail(call.callee) not in ("sleep", "sleep_for"):
                continue
            place = call.guard
            while 0 <= place < len(rows) and (rows[place].line, rows[place].text) != (guard.line, guard.text):
                place = rows[place].outer
            if 0 <= place < len(rows):
                pace = self._describe_sleep(call, fn)
                if pace:
                    paces.append((bool(call.arguments), place != call.guard, pace))
        # What is made to keep a rate goes before pauses, what every round meets before what some do.
        best = [pace for *kind, pace in paces if kind == list(min(paces)[:2])]
        return best[0] if best and (len(set(best)) == 1 or not min(paces)[1]) else ""

    def _describe_sleep(self, call: FlowCall, fn: Fn) -> str:
        if call.arguments:
            return f"every {_describe_number(call.arguments[0], fn)}"
        receiver = call.callee.rpartition(".")[0]
        if receiver.endswith("()"):
            name, line = receiver.removesuffix("()"), call.line
            made = [one for one in fn.facts.calls if one.callee == name and one.line == line]
            pace = _describe_number(made[0].arguments[0], fn) if made and made[0].arguments else ""
            return f"{get_tail(name).lower()} {pace}" if pace else ""
        code = self.join.code
        variable = code.identify(receiver, fn)
        for writer, each in code.list_writes(variable):
            parts = [part for part in each.value.parts if part.text not in ("this", "self", "*this")]
            paces = [_describe_number(part, writer) for part in parts]
            if paces and each.value.kind in ("make", "call", "list"):
                kind = get_tail(each.value.text).lower() if each.value.text else "rate"
                return f"{kind} {paces[0]}"
        return ""


def _is_program(guard: GuardAt) -> bool:
    """Whether a guard only asks that the file is run, and not imported."""
    return guard.kind == "if" and bool(_RUN_AS_PROGRAM.fullmatch(guard.text))


def strip_spelling(text: str) -> str:
    """A text without blanks, line breaks and the choice of quotes."""
    return "".join(text.split()).replace("'", '"')


def _describe_number(value: FlowExpr, fn: Fn) -> str:
    """A number or duration as written; that of a variable that is one and nothing else."""
    made = fn.assigned.get(value.text, []) if value.kind == "name" and value.text in fn.locals else []
    if len(made) == 1 and made[0].operator == "=" and (made[0].value.kind == "number" or _is_duration(made[0].value)):
        return unparse(made[0].value)
    return unparse(value)


def _is_duration(value: FlowExpr) -> bool:
    """Whether a value is an object that is made of one number."""
    return value.kind == "make" and len(value.parts) == 1 and value.parts[0].kind == "number"


def _get_node(owner: Owner) -> Node | None:
    return owner if owner is None or isinstance(owner, Node) else owner.node


def _resolve_local_topic(site: Site, value: FlowValue) -> str:
    """A topic as the node's code knows it, before the node's own name."""
    if value.text is None:
        return ""
    text, prefix = value.text, site.prefix
    if not prefix or text[:1] in ("/", "~"):
        return text
    return f"~{text}" if prefix == "~" else f"{prefix.rstrip('/')}/{text}"


def _strip_liveness(text: str) -> tuple[str, bool]:
    """A loop's condition without what only says that the node runs, and whether it says so."""
    parts = split_conjuncts(text)
    left = [part for part in parts if not _is_live(part)]
    return (text, False) if len(left) == len(parts) else (f" {_AND[' and ' in text]} ".join(left), True)


_AND = ("&&", "and")


def _is_live(text: str) -> bool:
    plain = text.strip()
    return plain in _LIVE or bool(_OK.fullmatch(plain))


def read_build(state: PackageState, facts: Mapping[str, Any]) -> BuiltPackage:
    """What the build of a package makes, as far as its CMake files and setup.py say it without variables."""
    executables: dict[str, tuple[str, ...]] = {}
    libraries: dict[str, tuple[str, ...]] = {}
    components: dict[str, tuple[str, ...]] = {}
    links: dict[str, tuple[str, ...]] = {}
    scripts: dict[str, str] = {}
    paths = {file.path for file in state.files}
    for file in state.files:
        one = facts.get(file.path)
        if one is None:
            continue
        if file.kind == "cmake":
            folder = file.path.rpartition("/")[0]
            for name, arguments in _iterate_commands(one):
                if not arguments or "$" in arguments[0]:
                    continue
                target, rest = arguments[0], arguments[1:]
                sources = tuple(path for path in (f"{folder}/{item}".lstrip("/") for item in rest) if path in paths)
                if name in ("add_executable", "rosbuild_add_executable", "cuda_add_executable"):
                    if sources:  # those of tests are not read
                        executables[target] = sources
                elif name in ("add_library", "rosbuild_add_library", "cuda_add_library"):
                    libraries[target] = sources
                elif name in ("target_link_libraries", "rosbuild_link_boost"):
                    links[target] = (*links.get(target, ()), *rest)
                elif name == "rclcpp_components_register_node":
                    given = dict(zip(rest[::2], rest[1::2], strict=False))
                    if "PLUGIN" in given:
                        name, program = given["PLUGIN"].strip('"'), given.get("EXECUTABLE", "").strip('"')
                        components[name] = (*components.get(name, ()), *((program,) if program else ()))
        elif file.kind == "setup_py":
            for name, module, _, function in one.entry_points:
                where = find_entry_point(module, function, "", paths)
                if where:
                    scripts[name] = where
    reached = {where.partition(":")[0] for where in scripts.values()}
    for file in state.files:
        one = facts.get(file.path)
        program = file.kind == "python" and isinstance(one, FlowFile) and asks_for_name(one)
        if program and file.path not in reached:
            scripts.setdefault(file.path.rpartition("/")[2].removesuffix(".py"), file.path)
    return BuiltPackage(state.name, executables, libraries, components, scripts, links)


def _iterate_commands(facts: Any) -> Iterator[tuple[str, list[str]]]:
    """The commands of a CMake file with their arguments, variables that hold plain words put in."""
    values: dict[str, list[str]] = {}
    for command in facts.commands:
        arguments: list[str] = []
        for argument in command.arguments:
            text = argument.text
            if text.startswith("${") and text.endswith("}") and text.count("$") == 1:
                arguments.extend(values.get(text[2:-1], [text]))
            elif "${" in text:
                for name, words in values.items():
                    if len(words) == 1:
                        text = text.replace(f"${{{name}}}", words[0])
                arguments.append(text)
            else:
                arguments.append(text)
        if command.name == "set" and arguments:
            values[arguments[0]] = arguments[1:]
        elif command.name == "project" and arguments:
            values["PROJECT_NAME"] = arguments[:1]
        yield command.name, arguments


def find_facts_kind(file: PackageFile) -> str:
    """The kind of facts that are wanted of a file."""
    return kinds.FLOW.get(file.kind, file.kind)
