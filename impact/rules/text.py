"""Templates of messages and help, and how they are rendered from what diagnostics of several targets say.

A template names fields in braces: `{subject}`, `{package}`, and whatever is in the data of the diagnostic. A field in
backticks is code, and stays so where there are several values. Formats:

    {version}                a text or number as it is
    {period:g}               a number, as str.format has it
    {users:nothing}          names, each as code, the first four of them and how many more; `nothing` without any
    [[, from {since} on]]    left out where one of its fields is empty

Where the value of a field differs between targets, each value names its targets: 0.36.2 (jazzy), 0.41.0 (rolling).
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from string import Formatter
from typing import Any

Value = str | int | float | tuple[str, ...]
# (target, data of a diagnostic there); the target is empty for what holds for all
ByTarget = Sequence[tuple[str, Mapping[str, Value]]]

_MOST_NAMES = 4
_CODE_FIELD = re.compile(r"`\{(\w+)\}`")
_CODE = "code"
_OPTIONAL = re.compile(r"\[\[(.*?)\]\]")


class Text:
    """The message of a diagnostic and its help, as templates. fields: the names that they ask for."""

    __slots__ = ("fields", "help", "message")

    def __init__(self, message: str, help: str = "") -> None:
        self.message, self.help = message, help
        self.fields = frozenset((*_list_fields(message), *_list_fields(help)))

    def render(self, data: ByTarget) -> tuple[str, str]:
        """Message and help for what is said of one or several targets. Raises KeyError for a field without a value."""
        return render_template(self.message, data), render_template(self.help, data)


def _list_fields(template: str) -> list[str]:
    return [name for _, name, _, _ in Formatter().parse(template) if name]


def render_template(template: str, data: ByTarget) -> str:
    """A template with the values of its fields; where they differ between targets, each with its targets."""
    # A field as code is put in backticks value by value, so that the names of targets stay outside of them.
    template = _CODE_FIELD.sub(rf"{{\1:{_CODE}}}", template)
    fields = {
        name: [(target, values[name]) for target, values in data if name in values] for name in _list_fields(template)
    }

    def keep(part: re.Match[str]) -> str:
        known = all(value != "" and value != () for name in _list_fields(part[1]) for _, value in fields[name])
        return part[1] if known else ""

    template = _OPTIONAL.sub(keep, template)
    return _Renderer().vformat(template, (), fields)


class _Renderer(Formatter):
    """Formats fields that are given as [(target, value)]."""

    def format_field(self, value: Any, format_spec: str) -> str:
        by_text: dict[str, list[str]] = {}
        for target, each in value:
            by_text.setdefault(_format_value(each, format_spec), []).append(target)
        if len(by_text) == 1:
            return next(iter(by_text))
        return ", ".join(append_targets(text, targets) for text, targets in by_text.items())


def _format_value(value: Value, spec: str) -> str:
    if isinstance(value, tuple):
        return list_names(value) or spec
    return f"`{value}`" if spec == _CODE else format(value, spec)


def list_names(names: Sequence[str]) -> str:
    """Names as code: "`a`, `b` and `c`", or the first four "and 3 more"; empty without any."""
    shown = [f"`{name}`" for name in names[:_MOST_NAMES]]
    more = len(names) - len(shown)
    if more:
        return f"{', '.join(shown)} and {more} more"
    return " and ".join(filter(None, (", ".join(shown[:-1]), *shown[-1:])))


def append_targets(text: str, targets: Iterable[str]) -> str:
    """A text with the targets it holds for behind it, unless it names them itself."""
    words = set(re.split(r"[\s`,;:()]+", text))
    named = [name for name in targets if name and name not in words and not (" " in name and name in text)]
    return f"{text} ({', '.join(named)})" if named else text
