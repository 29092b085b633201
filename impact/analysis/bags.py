"""What a bag tells of its topics: how often and how large messages are, and what their fields ever held."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from fnmatch import fnmatchcase
from pathlib import Path

import msgspec

from ...edges.console import escape
from ...edges.limits import get_limits
from ..facts.interface import Section, extract
from ..model.wire import Encoding, LayoutError, build_layout
from .bag_files import BagError, BagTopic, OpenedBag, open_bag
from .field_tally import FieldTally, MessageTally, WrongBytes

FindText = Callable[[str], "bytes | None"]
Progress = Callable[[str, int, int], None]

_RULE = "=" * 80
_STEP = 5_000
_SIZES_AT_MOST = 50_000
_TOPICS_NAMED = 12
# Fewer messages than one in so many may be unlike their definition before it is taken for the wrong one.
_WRONG_ONE_IN = 100


class LengthFacts(msgspec.Struct, frozen=True):
    """Elements that arrays held, or bytes of strings. times: how often one was met."""

    least: int
    mean: float
    most: int
    times: int


class BagField(msgspec.Struct, frozen=True):
    """A field. field: its path, such as `points[].x`. type: as written, of an array of messages with the array part.
    filled: a message had another value than 0, false or empty. nonzero: one had a value other than 0: an array of
    zeros is filled. bytes: of a message, on average, padding excluded; share: of all bytes of the topic. lengths: of
    strings, and of arrays."""

    field: str
    type: str
    filled: bool
    nonzero: bool
    bytes: float
    share: float
    lengths: LengthFacts | None = None


class SizeFacts(msgspec.Struct, frozen=True):
    """Bytes of the messages of a topic as they were sent."""

    mean: float
    p50: int
    p95: int
    max: int


class BagTopicFacts(msgspec.Struct, frozen=True):
    """A topic. type: `package/Name`. duration: seconds from the first message to the last. rate: messages a second
    between these, None of fewer than two. bytes_per_second: rate times mean size. overhead: bytes of a message, on
    average, that are no field's: four that name the encoding, and padding. definition: where that of the type is from:
    bag, workspace, or the definitions of a distro. unlike: messages that are not as it says. problem: why there are no
    fields."""

    topic: str
    type: str
    count: int
    duration: float
    rate: float | None
    bytes: SizeFacts
    bytes_per_second: float | None
    fields: tuple[BagField, ...] = ()
    overhead: float = 0
    definition: str = ""
    unlike: int = 0
    problem: str = ""


class BagFacts(msgspec.Struct, frozen=True):
    """A bag. form: rosbag (of ROS 1), sqlite3 or mcap. encoding: ros1 or cdr. count: messages that were read; whole:
    False where --limit ended it before the last. duration: seconds from the first message to the last. topics: those
    that take most bytes first; empty_topics: those without a message."""

    form: str
    encoding: Encoding
    count: int
    whole: bool
    duration: float
    topics: tuple[BagTopicFacts, ...]
    empty_topics: tuple[str, ...] = ()


def measure_bag(
    path: Path, topics: Iterable[str] = (), *, limit: int | None = None, find_text: FindText | None = None,
    progress: Progress | None = None,
) -> BagFacts:  # fmt: skip
    """Reads a bag once, message by message.

    topics: only these; `*` matches any text. limit: only so many messages, the first ones. find_text: gives the
    definition of `package/Name` where the bag has none. progress: as make_step_reporter() makes it. Raises BagError.
    """
    with open_bag(path) as bag:
        patterns = tuple(topics)
        chosen = [each for each in bag.topics if not patterns or _is_chosen(each.topic, patterns)]
        for pattern in patterns:
            if not any(_is_chosen(each.topic, (pattern,)) for each in bag.topics):
                raise BagError(f"--topic {escape(pattern)}: {escape(str(path))} has no such topic; {_list_topics(bag)}")
        counts = {each.id: _TopicCount(each, bag, find_text) for each in chosen}
        number, whole = 0, True
        what = f"reading {path.name or path}"
        for id_, time, data in bag.read_messages(counts.keys()):
            counts[id_].add(time, data)
            number += 1
            if progress is not None and number % _STEP == 0:
                progress(what, number, max(bag.count, number))
            if number == limit:
                # What comes next is not asked for: it may be damaged.
                whole = number == bag.count
                break
        if progress is not None and number >= _STEP:
            progress(what, number, number)
        met = [each for each in counts.values() if each.count]
        begin = min((each.first for each in met), default=0)
        end = max((each.last for each in met), default=0)
        met.sort(key=lambda each: (-each.size, each.topic.topic))
        return BagFacts(
            bag.form, bag.encoding, number, whole, (end - begin) / 1e9, tuple(each.finish() for each in met),
            tuple(sorted({each.topic.topic for each in counts.values() if not each.count})) if whole else (),
        )  # fmt: skip


def _is_chosen(topic: str, patterns: Iterable[str]) -> bool:
    return any(fnmatchcase(topic, prefix + pattern) for pattern in patterns for prefix in ("", "/"))


def _list_topics(bag: OpenedBag) -> str:
    names = sorted({topic.topic for topic in bag.topics})
    more = f" and {len(names) - _TOPICS_NAMED} more" if len(names) > _TOPICS_NAMED else ""
    return f"it has {escape(', '.join(names[:_TOPICS_NAMED]))}{more}" if names else "it has none"


class _TopicCount:
    """One topic while its messages are read."""

    def __init__(self, topic: BagTopic, bag: OpenedBag, find_text: FindText | None):
        self.topic = topic
        self.count = self.size = self.unlike = 0
        self.first = self.last = 0
        self.sizes: Counter[int] = Counter()
        self.step = 1
        self.problem = topic.problem
        self.definition = ""
        self.tally: MessageTally | None = None
        if not self.problem:
            definitions = _Definitions(topic, bag, find_text)
            try:
                self.tally = MessageTally(build_layout(definitions.find, topic.type, bag.encoding), bag.encoding)
            except LayoutError as error:
                self.problem = str(error)
            self.definition = ", ".join(definitions.sources)

    def add(self, time: int, data: bytes) -> None:
        if not self.count:
            self.first = self.last = time
        self.first, self.last = min(self.first, time), max(self.last, time)
        self.count += 1
        self.size += len(data)
        self.sizes[-(-len(data) // self.step) * self.step] += 1
        if len(self.sizes) > _SIZES_AT_MOST:
            self.merge_sizes()
        if self.tally is not None:
            try:
                self.tally.add(data)
            except WrongBytes as error:
                if not self.unlike:
                    self.problem = f"a message {error}"
                self.unlike += 1

    def merge_sizes(self) -> None:
        """Counts sizes in wider steps, so that they stay few."""
        while len(self.sizes) > _SIZES_AT_MOST // 2:
            self.step *= 2
            wider: Counter[int] = Counter()
            for size, times in self.sizes.items():
                wider[-(-size // self.step) * self.step] += times
            self.sizes = wider

    def finish(self) -> BagTopicFacts:
        duration = (self.last - self.first) / 1e9
        rate = (self.count - 1) / duration if duration > 0 else None
        mean = self.size / self.count
        largest = max(self.sizes)
        sizes = SizeFacts(round(mean, 2), self.find_quantile(50), self.find_quantile(95), largest)
        fields: list[BagField] = []
        overhead = 0.0
        understood = self.tally is not None and self.unlike * _WRONG_ONE_IN < self.count
        if self.tally is not None and understood:
            self.tally.finish()
            fields = [self.describe(each) for each in self.tally.fields]
            overhead = (self.size - sum(each.size for each in self.tally.fields)) / self.count
        return BagTopicFacts(
            self.topic.topic, self.topic.type, self.count, duration, rate, sizes,
            None if rate is None else rate * mean, tuple(fields), overhead, self.definition, self.unlike,
            self.problem if self.unlike or not understood else "",
        )  # fmt: skip

    def find_quantile(self, percent: int) -> int:
        """The size that so many of a hundred messages do not exceed."""
        left = -(-self.count * percent // 100)
        for size in sorted(self.sizes):
            left -= self.sizes[size]
            if left <= 0:
                return size
        return max(self.sizes)

    def describe(self, tally: FieldTally) -> BagField:
        field = tally.field
        lengths = None
        if tally.met:
            lengths = LengthFacts(tally.least, round(tally.total / tally.met, 2), tally.most, tally.met)
        array = "" if field.elements is None else f"[{field.elements if field.elements >= 0 else ''}]"
        return BagField(
            field.path, f"{field.type}{array}", tally.filled, tally.nonzero, round(tally.size / self.count, 2),
            tally.size / self.size if self.size else 0, lengths,
        )  # fmt: skip


class _Definitions:
    """The definitions that a topic needs. sources: where they are from."""

    def __init__(self, topic: BagTopic, bag: OpenedBag, find_text: FindText | None):
        self.bag = bag
        self.find_text = find_text
        self.sources: dict[str, None] = {}
        self.own = _parse_definitions(topic) if topic.definition else {}

    def find(self, name: str) -> Section | None:
        if name in self.own:
            self.sources["bag"] = None
            return self._check(name, self.own[name])
        text = self.find_text(name) if self.find_text is not None else None
        if text is not None:
            self.sources["workspace"] = None
            return self._check(name, extract(text, "msg"))
        store, text = _find_released(name, self.bag.distro, self.bag.encoding)
        if text is not None:
            self.sources[store] = None
            return extract(text.encode(), "msg").sections[0]
        return None

    @staticmethod
    def _check(name: str, facts) -> Section:
        for problem in facts.problems:
            raise LayoutError(f"the definition of {name} cannot be read: line {problem.line} {problem.message}")
        return facts.sections[0]


def _parse_definitions(topic: BagTopic) -> dict:
    """The definitions of a bag's connection by `package/Name`: that of the topic first, the others each below a line of
    `=` and its name."""
    found = {}
    parts = topic.definition[: get_limits().interface].replace("\r\n", "\n").split(f"{_RULE}\n")
    for number, part in enumerate(parts):
        name, text = topic.type, part
        head, _, below = part.partition("\n")
        kind, _, title = head.partition(": ")
        if kind in ("MSG", "IDL"):
            name, text = title.strip().replace("/msg/", "/"), below
        elif number:
            continue
        if text.strip() or number or topic.form == "msg":
            found.setdefault(name, extract(text.encode("utf-8", "replace"), topic.form))
    return found


@functools.cache
def _find_released(name: str, distro: str, encoding: Encoding) -> tuple[str, str | None]:
    """(whose definition it is, text) of a message that ROS itself has, as rosbags ships them."""
    from rosbags.typesys import Stores, get_typestore  # pyright: ignore[reportMissingImports]

    wanted = "ros1_noetic" if encoding == "ros1" else f"ros2_{distro}"
    known = {store.value: store for store in Stores}
    store = known.get(wanted, known["latest"])
    with suppress(Exception):
        package, _, short = name.partition("/")
        types = get_typestore(store)
        text = types.generate_msgdef(f"{package}/msg/{short}", ros_version=1 if encoding == "ros1" else 2)[0]
        return f"rosbags ({store.value})", text.partition(_RULE)[0]
    return "", None


def list_silent_fields(topic: BagTopicFacts) -> Iterator[BagField]:
    """The fields of a topic that never had another value than 0, false or empty."""
    return (each for each in topic.fields if not each.filled)
