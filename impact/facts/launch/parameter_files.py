"""Files of parameters: the values of a YAML file with their places, in its order; launch files in YAML too."""

import math
import re
from typing import Any

import msgspec

from ..markup import decode
from ..place import Problem
from ..python.text import drop_surrogates


class ParameterEntry(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A value of a parameter file. path: its keys from the root. value: bool, int, float, str, None, list or, below a
    list, dict. line: of the value, of its key where it is a list."""

    path: tuple[str, ...]
    value: Any
    line: int


class ParameterFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The values of a YAML file in its order; mappings are followed, an empty one is a value."""

    entries: tuple[ParameterEntry, ...]
    problems: tuple[Problem, ...] = ()


DEEPEST = 60
MOST_ENTRIES = 50_000


class YamlNode(msgspec.Struct, eq=False):
    """A node of a YAML file. value: a scalar's value, the items of a list, or the (key, node) pairs of a mapping. line,
    offset: where a scalar begins behind its quote; of a block the place of its key."""

    kind: str
    value: Any
    line: int
    offset: int = 0
    height: int = 0


_BOOLEAN = {word: flag for flag, stems in ((True, ("true", "yes", "on")), (False, ("false", "no", "off")))
            for stem in stems for word in (stem, stem.capitalize(), stem.upper())}  # fmt: skip
_NULL = frozenset(("", "~", "null", "Null", "NULL"))
_INTEGER = re.compile(r"[-+]?(?:0b[01_]+|0x[0-9a-fA-F_]+|0o?[0-7_]*|[1-9][0-9_]*)\Z")
_FLOAT = re.compile(r"[-+]?(?:(?:\.[0-9]+|[0-9][0-9_]*\.[0-9_]*)(?:[eE][-+]?[0-9]+)?|[0-9]+[eE][-+]?[0-9]+)\Z")
_NOT_FINITE = re.compile(r"([-+]?)\.(?:inf|Inf|INF)\Z|\.(?:nan|NaN|NAN)\Z")


def parse_scalar(text: str) -> Any:
    """What a plain scalar of YAML stands for: None, bool, int, float or str. Integers beyond 64 bits stay text.

    `1e-4` is a float, as for rcl; PyYAML, which ROS 1 reads with, would ask for a dot.
    """
    if text in _NULL:
        return None
    if text in _BOOLEAN:
        return _BOOLEAN[text]
    if text[:1] not in "+-.0123456789" or len(text) > 40:
        return text
    if _INTEGER.match(text):
        digits = text.replace("_", "")
        sign = -1 if digits[0] == "-" else 1
        digits = digits.lstrip("+-")
        try:
            octal = len(digits) > 1 and digits[0] == "0" and digits[1].isdigit()
            number = sign * (int(digits, 8) if octal else int(digits, 0))
        except ValueError:
            return text
        return number if -(2**63) <= number < 2**63 else text
    if _FLOAT.match(text):
        return float(text.replace("_", ""))
    special = _NOT_FINITE.match(text)
    if special is not None:
        return float(f"{special[1]}inf") if special[1] is not None else float("nan")
    return text


def parse_yaml_tree(text: str) -> tuple[YamlNode | None, list[Problem]]:
    """The first document of a YAML text, as far as it can be read."""
    import yaml

    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    problems: list[Problem] = []
    root: list[YamlNode] = []
    # Each level: the node, the key that waits for its value, that key's node, whose place is also a block's, and what
    # the node is called.
    levels: list[list[Any]] = []
    anchors: dict[str, YamlNode] = {}

    def add(node: YamlNode) -> None:
        if not levels:
            if not root:
                root.append(node)
            return
        above, key, _, _ = levels[-1]
        if above.kind == "list":
            above.value.append(node)
        elif key is None:
            levels[-1][1] = str(node.value) if node.kind == "scalar" and node.value is not None else "~"
            levels[-1][2] = node
            return
        else:
            if node.kind != "scalar" and levels[-1][2].line <= node.line:
                node.line, node.offset = levels[-1][2].line, levels[-1][2].offset
            above.value.append((key, node))
            levels[-1][1] = None
        above.height = max(above.height, node.height + 1)
        if above.height > DEEPEST:
            raise ValueError(f"nested more than {DEEPEST} deep")

    try:
        for event in yaml.parse(text, loader):
            if isinstance(event, yaml.DocumentEndEvent):
                break
            if isinstance(event, yaml.ScalarEvent):
                is_key = bool(levels) and levels[-1][0].kind == "map" and levels[-1][1] is None
                bare = event.implicit[0] and not is_key
                value = parse_scalar(event.value) if bare else drop_surrogates(event.value)
                if event.tag is not None and not is_key:
                    value = _parse_tagged(event.tag, value)
                mark = event.start_mark
                node = YamlNode("scalar", value, mark.line + 1, mark.index + (event.style in ("'", '"')))
                if event.anchor:
                    anchors[event.anchor] = node
                add(node)
            elif isinstance(event, (yaml.MappingStartEvent, yaml.SequenceStartEvent)):
                kind = "map" if isinstance(event, yaml.MappingStartEvent) else "list"
                if len(levels) >= DEEPEST:
                    raise ValueError(f"nested more than {DEEPEST} deep")
                mark = event.start_mark
                levels.append([YamlNode(kind, [], mark.line + 1, mark.index), None, None, event.anchor])
            elif isinstance(event, (yaml.MappingEndEvent, yaml.SequenceEndEvent)):
                node, _, _, anchor = levels.pop()
                if anchor:
                    anchors[anchor] = node
                add(node)
            elif isinstance(event, yaml.AliasEvent):
                node = anchors.get(event.anchor)
                if node is None:
                    problems.append(Problem(event.start_mark.line + 1, f"`*{event.anchor}` names nothing above it"))
                    node = YamlNode("scalar", None, event.start_mark.line + 1)
                add(node)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = min(mark.line if mark is not None else 0, text.count("\n")) + 1
        problems.append(Problem(line, f"not readable as YAML: {getattr(error, 'problem', None) or 'syntax error'}"))
    except (RecursionError, ValueError) as error:
        problems.append(Problem(1, f"not readable as YAML: {error}"))
    # What was open when reading ended still holds what it had.
    while levels:
        node = levels.pop()[0]
        try:
            add(node)
        except ValueError:
            break
    return (root[0] if root else None), problems


def _parse_tagged(tag: str, value: str) -> Any:
    """A scalar with a tag of its own: `!!str 5`, `!!int "5"`, rosparam's `!degrees 90`."""
    if tag.endswith(":str") or tag == "!":
        return value
    number = parse_scalar(value)
    if tag == "!degrees" and isinstance(number, (int, float)):
        return math.radians(number)
    return number


def extract(data: bytes | str) -> ParameterFile:
    """The values of a YAML file of parameters. Never raises; what cannot be read is a problem, the rest is kept."""
    root, problems = parse_yaml_tree(
        decode(data) if isinstance(data, bytes) else drop_surrogates(data).lstrip("\ufeff")
    )
    entries: list[ParameterEntry] = []
    budget = [MOST_ENTRIES]
    if root is not None and root.kind == "map":
        _flatten(root, (), entries, budget)
    elif root is not None and (root.kind == "list" or root.value is not None):
        entries.append(ParameterEntry((), _convert_to_plain(root, budget), root.line))
    if budget[0] <= 0:
        problems.append(Problem(1, f"has more than {MOST_ENTRIES} values"))
    return ParameterFile(tuple(entries), tuple(problems))


def _flatten(node: YamlNode, path: tuple[str, ...], entries: list[ParameterEntry], budget: list[int]) -> bool:
    """Adds the values below a mapping; False when the budget is used up."""
    own = {key for key, _ in node.value if key != "<<"}
    for key, child in node.value:
        if budget[0] <= 0:
            return False
        budget[0] -= 1
        if key == "<<":
            for source in child.value if child.kind == "list" else [child]:
                if isinstance(source, YamlNode) and source.kind == "map":
                    merged = YamlNode("map", [(k, n) for k, n in source.value if k not in own], source.line)
                    if not _flatten(merged, path, entries, budget):
                        return False
        elif child.kind == "map" and child.value:
            if not _flatten(child, (*path, key), entries, budget):
                return False
        else:
            entries.append(ParameterEntry((*path, key), _convert_to_plain(child, budget), child.line))
    return True


def _convert_to_plain(node: YamlNode, budget: list[int]) -> Any:
    budget[0] -= 1
    if budget[0] <= 0:
        return None
    if node.kind == "list":
        return [_convert_to_plain(item, budget) for item in node.value]
    if node.kind == "map":
        return {key: _convert_to_plain(item, budget) for key, item in node.value}
    return node.value
