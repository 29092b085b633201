"""All callbacks of a workspace that were asked for: explored within bounds, and their examples replayed if wanted."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ...edges.console import describe_unforeseen
from ...edges.processes import Died, reset_memory, run_forked
from ..facts.interface import Section
from ..facts.python import source
from ..model.flow.graph import Graph
from ..model.flow.workspace import list_code
from ..model.workspace import Workspace
from .answers import CallbackAnswer, CallbackExample, SentThrough, ValuesReport
from .evaluate import Evaluated, evaluate, list_sent
from .field_types import find_integer
from .harness.callbacks import CppCallback, list_callbacks
from .harness.compile import CannotCompile
from .harness.fuzzing import run_fuzzer
from .harness.interfaces import KnownInterfaces, list_constants
from .harness.replay import Replayed, is_confirmed
from .harness.session import HarnessSession, PreparedCallback, is_asked
from .ir.explore import explore
from .narrowing import (
    GivenMessage,
    MessageOutcome,
    ParameterValues,
    judge_message,
    narrow_to_messages,
    narrow_to_parameters,
)
from .outcomes import Bounds, CodeLine, Exploration, InputKind, Reaction, Witness
from .python.explore import CallbackCode, explore_callback
from .python.messages import Messages
from .python.modules import ModuleCode
from .python.programs import explore_program
from .python.replay import ReplayPlace, list_folders, replay_witness
from .settings import find_parameters
from .witnesses import WitnessRecord, format_publish_command, write_tests

_FIRST_SHARE = 0.75
"""Of the time that is left, where a callback is reached in another way, too."""
KINDS = ("subscriber", "service", "timer", "action", "main")
LANGUAGES = ("cpp", "python")
_ANY_NUMBER = (InputKind.INTEGER, 64, False)
Progress = Callable[[int, int], None]


class Asked(NamedTuple):
    """Which callbacks: nodes by id or its last part, topics by name, callbacks by name or its last part; all where
    nothing is named. kinds: of KINDS."""

    nodes: Collection[str] = ()
    topics: Collection[str] = ()
    callbacks: Collection[str] = ()
    kinds: Collection[str] = ("subscriber",)
    places: Collection[tuple[str, int]] = ()
    """Path and line of the calls that make them, where only some are asked for."""


@dataclass
class _Target:
    """A callback that can be explored. identity: as _identify() has it; prepared: its harness; code: of a Python one;
    types: of messages that it has to do with, known once it was explored."""

    identity: tuple[str, str, int, str]
    answer: CallbackAnswer
    names: Mapping[str, Mapping[int, str]]
    prepared: PreparedCallback | None = None
    code: CallbackCode | None = None
    types: tuple[str, ...] = ()
    parameters: ParameterValues | None = None

    @property
    def key(self) -> CallbackKey:
        return get_key(self.answer)


class CallbackKey(NamedTuple):
    """What tells a callback from all others of a workspace."""

    kind: str
    path: str
    line: int
    callback: str
    type: str
    topics: tuple[str, ...]


def get_key(answer: CallbackAnswer) -> CallbackKey:
    """Of an answer."""
    return CallbackKey(answer.kind, answer.path, answer.line, answer.callback, answer.message_type, answer.topics)


class Request(NamedTuple):
    """A callback, and messages that it is given. is_joined: whether what it sends is asked for, too."""

    key: CallbackKey
    messages: tuple[GivenMessage, ...]
    is_joined: bool


class Judged(NamedTuple):
    """What follows from each message of a request, what is sent then, and what is sent if one of them comes, None where
    that is not known."""

    outcomes: tuple[MessageOutcome, ...]
    sent: tuple[tuple[SentThrough, ...], ...]
    together: tuple[SentThrough, ...] | None


class Survey:
    """Explores the callbacks of one workspace. root: its folder on disk, for what is compiled and run. To be closed."""

    def __init__(self, root: Path, workspace: Workspace, graph: Graph, bounds: Bounds):
        self.root, self.workspace, self.graph, self.bounds = root.resolve(), workspace, graph, bounds
        self._definitions = KnownInterfaces(workspace)
        self._session: HarnessSession | None = None
        self._known: dict[CallbackKey, _Target] = {}

    def __enter__(self) -> Survey:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Removes what was compiled."""
        if self._session is not None:
            self._session.close()
        self._session = None

    def _open_session(self) -> HarnessSession:
        if self._session is None:
            self._session = HarnessSession(self.root, self.workspace, self.graph, self.bounds)
        return self._session

    def explore(
        self, asked: Asked, *, publishers: bool = False, replays: bool = False, fuzz_seconds: float = 0.0,
        jobs: int = 1, progress: Progress | None = None,
    ) -> tuple[ValuesReport, tuple[CallbackAnswer, ...]]:  # fmt: skip
        """What was found out about the callbacks that are asked for, in the order of their places, and, with
        publishers, about those that publish what these receive. replays: whether examples of the former are run for
        real, which compiles and runs code of the workspace, apart from this process. fuzz_seconds: for which each of
        their C++ callbacks is fuzzed besides; 0 for not."""
        own = self._choose(asked)
        rows = {language: [*own[language]] for language in LANGUAGES}
        if publishers:
            places = self._list_publishing({topic for chosen in own.values() for one in chosen for topic in one.topics})
            for language, chosen in rows.items():
                chosen += [
                    one for one in self._callbacks[language] if (one.path, one.line) in places and one not in chosen
                ]
        offline: list[bool] = []
        targets = [*self._list_cpp(self._open_session(), rows["cpp"]), *self._list_python(rows["python"])]
        ready = [number for number, one in enumerate(targets) if not one.answer.reason]
        found = [one.answer for one in targets]
        for target in targets:
            target.parameters = find_parameters(self.workspace, target.answer.nodes)
            self._known[target.key] = target
        asked_for = {_identify(one) for chosen in own.values() for one in chosen}
        results = run_forked(_explore_target, ready, jobs, targets, self._make_messages(), self._modules)
        for done, (number, result) in enumerate(results, 1):
            target = targets[number]
            answer = _read_result(target.answer, result, self.root)
            if isinstance(result, Evaluated):
                target.types = result.asked
            is_own = target.identity in asked_for
            if replays and is_own and answer.examples:
                answer, is_offline = self._replay(target, answer)
                offline.append(is_offline)
            if fuzz_seconds and is_own and target.prepared is not None:
                answer = _run_fuzzer(target.prepared, answer, fuzz_seconds)
            found[number] = answer
            if progress is not None:
                progress(done, len(ready))
        pairs = sorted(zip(found, targets, strict=True), key=lambda pair: _get_place(pair[0]))
        kept = tuple(answer for answer, target in pairs if target.identity in asked_for)
        known = {_get_place(one) for one in kept}
        others = tuple(answer for answer, _ in pairs if _get_place(answer) not in known)
        return ValuesReport(kept, self.bounds, replays, all(offline) if offline else None), others

    @cached_property
    def _callbacks(self) -> dict[str, list[CppCallback]]:
        """All callbacks of the workspace, by language."""
        return {language: list_callbacks(self.workspace, self.graph, language) for language in LANGUAGES}

    def _choose(self, asked: Asked) -> dict[str, list[CppCallback]]:
        """The callbacks that are asked for, by language."""
        given = asked.nodes, asked.topics, asked.callbacks, asked.kinds, asked.places
        return {language: [one for one in rows if is_asked(one, *given)] for language, rows in self._callbacks.items()}

    def _list_publishing(self, topics: Collection[str]) -> set[tuple[str, int]]:
        """Places of what makes the statements run that publish on some topics: of subscriptions, timers, services, and
        of the programs themselves."""
        statements = [one for one in self.graph.publishes if one.topic in topics]
        found = {(way.trigger.path, way.trigger.line) for one in statements for way in one.by}
        untold = {one.path for one in statements if not one.by}
        rows = (one for each in self._callbacks.values() for one in each if one.kind in KINDS)
        return found | {(one.path, one.line) for one in rows if _get_file(one) in untold}

    def explore_publishing(
        self, topics: Collection[str], jobs: int = 1, progress: Progress | None = None
    ) -> tuple[CallbackAnswer, ...]:
        """What was found out about the callbacks that publish on some topics and were not explored yet."""
        places = self._list_publishing(topics)
        known = {(target.identity[1], target.identity[2]) for target in self._known.values()}
        if not places - known:
            return ()
        report, _ = self.explore(Asked(kinds=KINDS, places=places - known), jobs=jobs, progress=progress)
        return report.callbacks

    def judge(self, requests: Sequence[Request], jobs: int = 1) -> dict[CallbackKey, Judged]:
        """What follows from messages that callbacks are given, which explore() has met; those that cannot be told are
        left out."""
        found: dict[CallbackKey, Judged] = {}
        ready = [one for one in requests if one.key in self._known and not self._known[one.key].answer.reason]
        numbers = list(range(len(ready)))
        messages = self._make_messages()
        for number, result in run_forked(_judge_target, numbers, jobs, ready, self._known, messages, self._modules):
            if isinstance(result, Judged):
                found[ready[number].key] = _shorten_places(result, self.root)
        return found

    def replay(self, records: Sequence[WitnessRecord]) -> list[tuple[WitnessRecord, Replayed]]:
        """Runs recorded witnesses for real, as explore() does with its own. Those whose callback is not there any
        longer, or cannot be compiled, are unknown, with the reason."""
        found: list[tuple[WitnessRecord, Replayed]] = []
        prepared: dict[tuple[str, str], list[_Target]] = {}
        for record in records:
            key = record.callback, record.kind
            if key not in prepared:
                chosen = self._choose(Asked(callbacks=(record.callback,), kinds=(record.kind,)))
                prepared[key] = [
                    *self._list_cpp(self._open_session(), chosen["cpp"]),
                    *self._list_python(chosen["python"]),
                ]
            rows = prepared[key]
            target = next((one for one in rows if one.answer.path == record.path), rows[0] if rows else None)
            if target is None:
                seen = Replayed(Reaction.UNKNOWN, reason=f"no callback {record.callback} in {record.path}")
            elif target.answer.reason:
                seen = Replayed(Reaction.UNKNOWN, reason=target.answer.reason)
            else:
                seen = self._replay_one(target, record.witness)
            found.append((record, seen))
        return found

    def _replay_one(self, target: _Target, witness: Witness) -> Replayed:
        if target.prepared is not None:
            try:
                return target.prepared.replay([witness])[0]
            except CannotCompile as error:
                return Replayed(Reaction.UNKNOWN, reason=str(error))
        assert target.code is not None
        messages = self._make_messages()
        # A short look tells which messages the callback has to do with, and what its members are.
        known = explore_callback(target.code, messages, self._modules.get, replace(self.bounds, paths=50, seconds=5.0))
        kinds = {name: (one.kind, one.bits, one.is_signed) for name, one in known.inputs.items()}
        target.types = tuple(messages.asked)
        return self._replay_python(target, witness, CallbackExample(witness.result, witness.values, kinds))

    def emit_klee(self, asked: Asked, folder: Path) -> list[Path]:
        """Writes the harnesses of the C++ callbacks that are asked for, for KLEE; gives their folders."""
        made: list[Path] = []
        for number, target in enumerate(self._list_cpp(self._open_session(), self._choose(asked)["cpp"])):
            if target.prepared is not None and not target.answer.reason:
                name = "".join(each if each.isalnum() else "_" for each in target.answer.callback)
                made.append(target.prepared.emit_klee(folder / f"{number:02d}_{name}").folder)
        return made

    def write_tests(self, records: Sequence[WitnessRecord]) -> dict[str, str]:
        """Regression tests for witnesses, by file name."""
        return write_tests(self._definitions, records)

    def write_commands(self, records: Sequence[WitnessRecord]) -> list[str]:
        """Commands that send witnesses to a running node."""
        return [command for one in records if (command := format_publish_command(self._definitions, one))]

    # C++.

    def _list_cpp(self, session: HarnessSession, callbacks: Iterable[CppCallback]) -> Iterator[_Target]:
        for one in session.prepare_each(callbacks):
            path, line = one.function_place
            answer = CallbackAnswer(
                one.callback, one.kind, "cpp", path, line, one.message_type, one.topics, one.nodes, self.bounds,
                one.reason, stood_for=one.stood_for, compiled_in=one.compiled_in, rounds=one.rounds,
            )  # fmt: skip
            identity = one.kind, one.path, one.line, one.callback
            yield _Target(identity, answer, _name_constants(one.constants, self.workspace.ros), one)

    # Python.

    @cached_property
    def _modules(self) -> dict[str, ModuleCode]:
        """The modules of the workspace's Python code, by dotted name."""
        tree = self.workspace.extraction.tree
        paths = [
            path for path in list_code(self.workspace) if path.endswith(".py") or "." not in path.rpartition("/")[2]
        ]
        packages = {path.rpartition("/")[0] for path in paths if path.endswith("__init__.py")}
        found: dict[str, ModuleCode] = {}
        for path in paths:
            try:
                parsed = source.read(tree.read(path))
            except (OSError, ValueError):
                continue
            if parsed.tree is None:
                continue
            name = _name_module(path, packages)
            code = ModuleCode(name, path, parsed.tree)
            found.setdefault(name, code)
            found[f"~{path}"] = code
        return found

    def _make_messages(self) -> Messages:
        def find_section(type_: str) -> Section | None:
            package, _, name = type_.partition("/")
            interface = self._definitions.find(f"{package}/msg/{name}")
            if interface is not None and interface.sections:
                return interface.sections[0]
            for end, place in (("Request", 0), ("Response", 1)):
                service = self._definitions.find(f"{package}/srv/{name.removesuffix(end)}")
                if name.endswith(end) and service is not None and len(service.sections) > place:
                    return service.sections[place]
            for end, place in (("Goal", 0), ("Result", 1), ("Feedback", 2)):
                action = self._definitions.find(f"{package}/action/{name.removesuffix(end)}")
                if name.endswith(end) and action is not None and len(action.sections) > place:
                    return action.sections[place]
            return None

        return Messages(find_section, self.workspace.ros)

    def _list_python(self, callbacks: Iterable[CppCallback]) -> Iterator[_Target]:
        for one in callbacks:
            function = one.function
            path, line = (function.source.path, function.facts.line) if function is not None else (one.path, one.line)
            answer = CallbackAnswer(
                one.name, one.kind, "python", path, line, one.message_type, one.topics, one.nodes, self.bounds,
                _refuse(one),
            )  # fmt: skip
            if answer.reason:
                yield _Target(_identify(one), answer, {})
                continue
            module = self._modules.get(f"~{path}")
            if module is None:
                yield _Target(_identify(one), replace(answer, reason=f"{path} cannot be read"), {})
                continue
            # The top of a module has no name.
            name = one.site.name if one.kind == "main" else one.name
            code = CallbackCode(
                module, name, line, one.message_type, one.joined, one.place, one.kind, self.workspace.ros == 2,
                one.role,
            )
            yield _Target(_identify(one), answer, self._name_python_constants(one.message_type), code=code)

    def _name_python_constants(self, type_: str) -> Mapping[str, Mapping[int, str]]:
        package, _, name = type_.partition("/")
        found = list_constants(self._definitions, f"{package}/msg/{name}") if name else {}
        return _name_constants(found, self.workspace.ros)

    # Replays.

    def _replay(self, target: _Target, answer: CallbackAnswer) -> tuple[CallbackAnswer, bool]:
        witnesses = [Witness(dict(one.values), one.result, one.crash, one.place) for one in answer.examples]
        if target.prepared is not None:
            try:
                seen = target.prepared.replay(witnesses)
            except CannotCompile as error:
                note = f"not replayed: {error}"
                return replace(answer, examples=tuple(replace(one, note=note) for one in answer.examples)), True
        else:
            seen = [self._replay_python(target, one, answer.examples[at]) for at, one in enumerate(witnesses)]
        examples = [
            _judge(example, witness, one)
            for example, witness, one in zip(answer.examples, witnesses, seen, strict=True)
        ]
        return replace(answer, examples=tuple(examples)), all(one.is_isolated for one in seen)

    def _replay_python(self, target: _Target, witness: Witness, example: CallbackExample) -> Replayed:
        assert target.code is not None
        if target.answer.kind == "action":
            return Replayed(Reaction.UNKNOWN, reason="callbacks of actions in Python are not run")
        path = self.root / target.answer.path
        folders = list_folders([self.root / code.path for code in self._modules.values()])
        own = list_folders([path])
        place = ReplayPlace(
            self.root, (*own, *[one for one in folders if one not in own]), target.code.module.name,
            target.answer.callback, tuple(target.code.list_messages()), path, target.code.kind == "service",
        )  # fmt: skip
        with tempfile.TemporaryDirectory(prefix="rosimpact-replay-") as folder:
            messages = self._make_messages()
            messages.asked.update(target.types)
            return replay_witness(place, witness, example.kinds, messages, Path(folder))


def _identify(callback: CppCallback) -> tuple[str, str, int, str]:
    """What tells one callback from the others: kind, where it is given to the framework, name."""
    return callback.kind, callback.path, callback.line, callback.name


def _get_place(answer: CallbackAnswer) -> tuple[str, int, str]:
    return answer.path, answer.line, answer.callback


def _get_file(callback: CppCallback) -> str:
    return callback.function.source.path if callback.function is not None else callback.path


def _run_fuzzer(prepared: PreparedCallback, answer: CallbackAnswer, seconds: float) -> CallbackAnswer:
    """An answer with the crashes that a fuzzer found besides."""
    try:
        crashes = run_fuzzer(prepared, seconds)
    except CannotCompile as error:
        return replace(answer, assumed=(*answer.assumed, f"not fuzzed: {error}"))
    known = {(one.crash, one.place.line) for one in answer.examples}
    kinds = dict(next((one.kinds for one in answer.examples), {}))
    more = [
        CallbackExample(
            Reaction.CRASH, one.witness.values, {path: kinds.get(path, _ANY_NUMBER) for path in one.witness.values},
            one.witness.crash, one.witness.place, "found by fuzzing", confirmed=True,
        )
        for one in crashes
        if (one.witness.crash, one.witness.place.line) not in known
    ]  # fmt: skip
    counts = dict(answer.counts)
    if more:
        counts[Reaction.CRASH] = counts.get(Reaction.CRASH, 0) + len(more)
    return replace(answer, examples=(*more, *answer.examples), counts=counts)


def make_records(report: ValuesReport) -> list[WitnessRecord]:
    """The examples of a report as records that can be written to a file."""
    return [
        WitnessRecord(
            one.kind, one.nodes[0] if one.nodes else "", one.topics[0] if one.topics else "", one.callback,
            one.message_type, one.path, one.line,
            Witness(dict(each.values), each.result, each.crash, each.place), one.language,
        )
        for one in report.callbacks
        for each in one.examples
    ]  # fmt: skip


def _refuse(callback: CppCallback) -> str:
    """Why a Python callback is not explored; empty where it is."""
    place = f"{callback.path}:{callback.line}"
    if callback.function is None:
        return f"{place}: the callback is not known"
    parameters = [one for one in callback.function.facts.parameters if one.default is None and one.name != "self"]
    if callback.is_filtered and not callback.joined and len(parameters) != 1:
        return f"{place}: which of the messages that a synchronizer gives is this one is not known"
    is_known = callback.message_type or callback.kind in ("timer", "main")
    return "" if is_known else f"{place}: the type of its message is not known"


def _explore_target(
    targets: Sequence[_Target], messages: Messages, modules: Mapping[str, ModuleCode], number: int
) -> Evaluated | Died:
    """What one callback does; runs in a process of its own. What is unforeseen costs this callback alone."""
    target = targets[number]
    reset_memory()
    try:
        found = _explore(target, messages, modules)
        evaluated = evaluate(found, target.names, parameters=target.parameters)
    except Exception as error:
        return Died(describe_unforeseen(error))
    return evaluated if target.prepared is not None else evaluated._replace(asked=tuple(sorted(messages.asked)))


def _explore(target: _Target, messages: Messages, modules: Mapping[str, ModuleCode]) -> Exploration:
    if target.prepared is not None:
        bounds, own = target.answer.bounds, target.prepared
        found = _explore_entries(own, bounds)
        if target.answer.kind == "main":
            found.left += 1  # its loops were followed for two rounds
        return found
    assert target.code is not None
    follow = explore_program if target.answer.kind == "main" else explore_callback
    return follow(target.code, messages, modules.get, target.answer.bounds)


def _judge_target(
    requests: Sequence[Request], targets: Mapping[CallbackKey, _Target], messages: Messages,
    modules: Mapping[str, ModuleCode], number: int,
) -> Judged | Died:  # fmt: skip
    """What one callback does with messages; runs in a process of its own. What is unforeseen costs this callback
    alone."""
    reset_memory()
    try:
        return _judge_request(requests[number], targets, messages, modules)
    except Exception as error:
        return Died(describe_unforeseen(error))


def _judge_request(
    request: Request, targets: Mapping[CallbackKey, _Target], messages: Messages, modules: Mapping[str, ModuleCode]
) -> Judged:
    target = targets[request.key]
    found = _explore(target, messages, modules)
    outcomes = tuple(judge_message(found, one) for one in request.messages)
    if not request.is_joined:
        return Judged(outcomes, (), None)
    sending = narrow_to_parameters(found, target.parameters)
    fixed = sending.fixed
    sent: list[tuple[SentThrough, ...]] = []
    for one in request.messages:
        narrowed = narrow_to_messages(sending, [one])
        if narrowed is not None:
            narrowed = replace(narrowed, fixed={**fixed, **narrowed.fixed})
        sent.append(tuple(list_sent(narrowed, 3.0)) if narrowed is not None else ())
    together = narrow_to_messages(sending, request.messages)
    return Judged(outcomes, tuple(sent), None if together is None else tuple(list_sent(together, 5.0)))


def _shorten_places(judged: Judged, root: Path) -> Judged:
    def shorten(rows: Sequence[SentThrough]) -> tuple[SentThrough, ...]:
        return tuple(_shorten_sent(one, root) for one in rows)

    outcomes = tuple(
        one._replace(crashes=tuple(each._replace(place=_shorten_place(each.place, root)) for each in one.crashes))
        for one in judged.outcomes
    )
    together = shorten(judged.together) if judged.together is not None else None
    return Judged(outcomes, tuple(map(shorten, judged.sent)), together)


def _shorten_sent(sent: SentThrough, root: Path) -> SentThrough:
    ways = tuple(one._replace(place=_shorten_place(one.place, root)) for one in sent.ways)
    return replace(sent, places=tuple(_shorten_place(place, root) for place in sent.places), ways=ways)


def _explore_entries(prepared: PreparedCallback, bounds: Bounds) -> Exploration:
    """What comes of the first entry that leads to a verdict; of the first of all where none does. They share the time
    of the callback."""
    first: Exploration | None = None
    left = bounds.seconds
    ways = {prepared.entry: prepared.way, **{one.name: one.way for one in prepared.others}}
    for number, (entry, way) in enumerate(ways.items(), 1):
        seconds = left if number == len(ways) else left * _FIRST_SHARE
        found = explore(prepared.ir_texts, entry, replace(bounds, seconds=seconds), prepared.is_workspace_file)
        left -= found.seconds
        found.is_bare = way == "bare"
        if any(path.result is not Reaction.UNKNOWN for path in found.paths):
            return found
        first = first or found
        if left <= 0:
            break
    assert first is not None
    return first


def _read_result(answer: CallbackAnswer, result: Evaluated | Died, root: Path) -> CallbackAnswer:
    if isinstance(result, Died):
        return replace(answer, reason=f"the exploration ended early: {result.why}")
    if not result.counts and not result.left:
        return replace(answer, reason="no way of making the node leads to the callback", seconds=result.seconds)
    examples = tuple(replace(one, place=_shorten_place(one.place, root)) for one in result.examples)
    sent = tuple(_shorten_sent(one, root) for one in result.sent)
    return replace(
        answer, counts=result.counts, fields=result.fields, examples=examples, sent=sent,
        unknown=result.unknown, assumed=result.assumed, left=result.left, seconds=result.seconds,
        is_bare=result.is_bare, beyond=result.beyond,
    )  # fmt: skip


def _shorten_place(place: CodeLine, root: Path) -> CodeLine:
    """A line of the debug information as the workspace has it."""
    return CodeLine(place.path.removeprefix(f"{root}/"), place.line)


def _judge(example: CallbackExample, witness: Witness, seen: Replayed) -> CallbackExample:
    if seen.result.value == "unknown":
        return replace(example, note=f"not replayed: {seen.reason or seen.detail}")
    if is_confirmed(witness, seen):
        return replace(example, confirmed=True)
    place = f" at {seen.place.path}:{seen.place.line}" if seen.place.line else ""
    what = f"{seen.crash.value}{place}" if seen.crash is not None else seen.result.value
    return replace(example, confirmed=False, note=f"the replay saw: {what}")


def _name_constants(constants: Mapping[str, tuple[str, str]], ros: int) -> Mapping[str, Mapping[int, str]]:
    """Names of constants by the type of the fields that they are for, `uint8`."""
    found: dict[str, dict[int, str]] = {}
    for name, (type_, value) in constants.items():
        number = find_integer(type_, ros)
        key = f"{'int' if number.is_signed else 'uint'}{number.bits}" if number is not None else type_
        with suppress(ValueError):
            found.setdefault(key, {}).setdefault(int(value, 0), name)
    return found


def _name_module(path: str, packages: Collection[str]) -> str:
    """The dotted name of a file: from the outermost folder with an __init__.py on."""
    folder, _, name = path.rpartition("/")
    parts = [] if name == "__init__.py" else [name.removesuffix(".py")]
    while folder and folder in packages:
        folder, _, last = folder.rpartition("/")
        parts.insert(0, last)
    return ".".join(parts)
