"""YAML, TOML and JSON within limits: what somebody wrote cannot make reading it take for ever, or all memory.

YAML is read with aliases expanded under a budget, so that ten lines that stand for a billion nodes are refused. TOML is
refused where keys nest too deeply for the standard library's reader, whose time is quadratic in that. Nothing of any
document is ever executed: YAML's tags for Python objects are errors.
"""

from __future__ import annotations

import json
import re
import sys
from typing import Any

from .limits import get_limits

_DIGITS_AT_MOST = 1_000
_NUMBERS = ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float")


class DocumentError(ValueError):
    """A document cannot be read, or exceeds a limit; the text is one clause. line: counted from 1, 0 when unknown."""

    def __init__(self, reason: str, line: int = 0):
        super().__init__(reason)
        self.line = line


def load_yaml(data: bytes | str) -> Any:
    """The first document of a YAML text as Python's own types. Raises DocumentError.

    Mappings whose keys are no plain values, and values that Python cannot build (a date in month 13), are errors.
    """
    return next(iter(load_yaml_documents(data, 1)), None)


def load_yaml_documents(data: bytes | str, most: int = sys.maxsize) -> list[Any]:
    """The same for all documents of a YAML text, or the first ones. Raises DocumentError."""
    import yaml

    return _load_documents(data, yaml, getattr(yaml, "CSafeLoader", yaml.SafeLoader), most)


def load_yaml_as_text(data: bytes | str) -> Any:
    """The same with every value as text, as it is written: `1e09040` is a commit and no number, `no` a title. Raises
    DocumentError."""
    import yaml

    return next(iter(_load_documents(data, yaml, getattr(yaml, "CBaseLoader", yaml.BaseLoader), 1)), None)


def _load_documents(data: bytes | str, yaml: Any, base: Any, most: int) -> list[Any]:
    try:
        return _construct(data, yaml, base, most)
    except DocumentError:
        raise
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise DocumentError(_format_error(error.problem or error), mark.line + 1 if mark is not None else 0) from None
    except (yaml.YAMLError, ValueError, TypeError, OverflowError, AttributeError, KeyError, IndexError) as error:
        raise DocumentError(_format_error(error)) from None
    except RecursionError:
        raise DocumentError("nested too deeply") from None


def _construct(data: bytes | str, yaml: Any, base: Any, most: int) -> list[Any]:
    budget = get_limits()
    _check_depth(data, yaml, base, budget.depth)
    loader = base(data)
    found = []
    try:
        while len(found) < most and loader.check_node():
            node = loader.get_node()
            _count(node, yaml, budget.nodes, budget.depth)
            found.append(loader.construct_document(node))
        return found
    finally:
        loader.dispose()


def _check_depth(data: bytes | str, yaml: Any, loader: Any, depth: int) -> None:
    """Raises DocumentError where a YAML text nests deeper than that; its composer would recurse, in C without end."""
    level = 0
    for event in yaml.parse(data, Loader=loader):
        if isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            level += 1
            if level > depth:
                raise DocumentError(f"nested deeper than {depth} levels", event.start_mark.line + 1)
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            level -= 1


def _count(node: Any, yaml: Any, budget: int, depth: int) -> None:
    """Raises DocumentError where the nodes below one, each alias counted with all that it stands for, are too many."""
    sizes: dict[int, int] = {}
    open_nodes: set[int] = set()

    def compute_size(each: Any, level: int) -> int:
        known = sizes.get(id(each))
        if known is not None:
            return known
        if id(each) in open_nodes:
            raise DocumentError("an alias stands for something that contains it", each.start_mark.line + 1)
        if level > depth:
            raise DocumentError(f"nested deeper than {depth} levels", each.start_mark.line + 1)
        total = 1
        if isinstance(each, yaml.ScalarNode):
            # Numbers in base 60 take quadratic time, and Python does not print those of thousands of digits.
            if len(each.value) > _DIGITS_AT_MOST and each.tag in _NUMBERS:
                raise DocumentError(f"a number of more than {_DIGITS_AT_MOST:,} digits", each.start_mark.line + 1)
        else:
            open_nodes.add(id(each))
            children = each.value if isinstance(each, yaml.SequenceNode) else [n for pair in each.value for n in pair]
            for child in children:
                total += compute_size(child, level + 1)
                if total > budget:
                    raise DocumentError(f"more than {budget:,} nodes, aliases included", each.start_mark.line + 1)
            open_nodes.discard(id(each))
        sizes[id(each)] = total
        return total

    compute_size(node, 0)


_DOTTED = re.compile(r"(?m)^[ \t]*\[{0,2}[^=\n\"'#\[\]]*")
# Reading a dotted key takes time quadratic in its parts, of which a line has at most one more than dots.
_DOTS_SQUARED = 2_000_000


def load_toml(text: str) -> dict[str, Any]:
    """A TOML document. Raises DocumentError."""
    import sys

    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib  # pyright: ignore[reportMissingImports]

    depth = get_limits().depth
    for match in _DOTTED.finditer(text):
        if match[0].count(".") > depth:
            raise DocumentError(f"a key of more than {depth} parts", text.count("\n", 0, match.start()) + 1)
    left = _DOTS_SQUARED
    for number, line in enumerate(text.split("\n"), 1):
        left -= line.count(".") ** 2
        if left < 0:
            raise DocumentError("too many dotted keys, or keys of too many parts", number)
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, ValueError) as error:
        line = re.search(r"at line (\d+)", str(error))
        last = text.rstrip("\n").count("\n") + 1 if "at end of document" in str(error) else 0
        raise DocumentError(_format_error(error), int(line[1]) if line else last) from None
    except RecursionError:
        raise DocumentError("nested too deeply") from None


def load_json(data: bytes | str) -> Any:
    """A JSON document, a byte-order mark left out. Raises DocumentError."""
    try:
        return json.loads(data.decode("utf-8-sig") if isinstance(data, bytes) else data.removeprefix("\ufeff"))
    except json.JSONDecodeError as error:
        raise DocumentError(error.msg, error.lineno) from None
    except RecursionError:
        raise DocumentError("nested too deeply") from None
    except ValueError as error:  # wrong UTF-8, integers of thousands of digits
        raise DocumentError(_format_error(error)) from None


def _format_error(error: object) -> str:
    return " ".join(str(error).split())[:200] or type(error).__name__
