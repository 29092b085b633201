"""The source of parts of a Python syntax tree, and the pieces of strings that are put together."""

import ast
import operator
import re
import string
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

# A comment, or a string in which a `#` is none.
_COMMENT = re.compile(r"(\"\"\"[\s\S]*?\"\"\"|'''[\s\S]*?'''|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*')|#[^\n]*|\\\n")
_PERCENT = re.compile(
    r"%(?:\((?P<key>[^()]*)\))?[#0\- +]*(?P<width>\*|[1-9]\d*)?(?:\.(?P<precision>\*|\d+))?[hlL]?"
    r"(?P<kind>[diouxXeEfFgGcrsa%])"
)
_AT_MOST_LINES = 40


# What the operators of expressions do with values.
ARITHMETIC: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
}
SIGNS = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%", ast.Pow: "**",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitOr: "|", ast.BitXor: "^", ast.BitAnd: "&", ast.MatMult: "@",
}  # fmt: skip
"""How operators are written."""
COMPARISONS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda left, right: left in right,
    ast.NotIn: lambda left, right: left not in right,
    ast.Is: operator.eq,
    ast.IsNot: operator.ne,
}


_NO_NODES = frozenset((
    "arg", "attr", "asname", "conversion", "ctx", "id", "is_async", "kind", "kwd_attrs", "level", "lineno", "module",
    "name", "op", "ops", "rest", "simple", "str", "tag", "type_comment", "type_ignores",
))  # fmt: skip
CHILD_FIELDS: dict[type, tuple[str, ...]] = {
    # Only of a type alias the name is a node.
    cls: tuple(field for field in cls._fields if field not in _NO_NODES or (field == "name" and "value" in cls._fields))
    for cls in vars(ast).values()
    if isinstance(cls, type) and issubclass(cls, ast.AST)
} | dict.fromkeys((ast.Constant, ast.Global, ast.Nonlocal, ast.MatchSingleton), ())
"""For every node class the fields that can hold nodes; those of the last ones hold strings and constants."""


def iterate_children(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes right below a node, in the order of the source as far as fields have it."""
    for field in CHILD_FIELDS[node.__class__]:
        child = getattr(node, field, None)
        if child.__class__ is list:
            for one in child:  # type: ignore[union-attr]
                if one is not None:
                    yield one
        elif child is not None:
            yield child


def walk_nodes(node: ast.AST) -> Iterator[ast.AST]:
    """A node and all below it, but for those that only tell of an operator or of how a name is used."""
    rest = [node]
    for one in rest:
        yield one
        rest += iterate_children(one)


def list_parameters(arguments: ast.arguments) -> Iterator[tuple[str, ast.arg, ast.expr | None]]:
    """(kind, parameter, default) in order. kind: `positional` (before `/`), `normal`, `args` (`*args`), `keyword`
    (behind `*`) or `kwargs`."""
    kinds = ["positional"] * len(arguments.posonlyargs) + ["normal"] * len(arguments.args)
    defaults = [None] * (len(kinds) - len(arguments.defaults)) + arguments.defaults
    yield from zip(kinds, (*arguments.posonlyargs, *arguments.args), defaults, strict=True)
    if arguments.vararg is not None:
        yield "args", arguments.vararg, None
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        yield "keyword", argument, default
    if arguments.kwarg is not None:
        yield "kwargs", arguments.kwarg, None


def join_dotted(module: str, name: str) -> str:
    """The dotted name of what a module has; of a relative one that is only dots, these before the name."""
    return f"{module}{'' if module.endswith('.') else '.'}{name}"


def list_imported(node: ast.Import | ast.ImportFrom) -> Iterator[tuple[str, str]]:
    """Names that an import binds and what they stand for, dotted; `*` and the module for all that one has."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            name = alias.name if alias.asname else alias.name.partition(".")[0]
            yield alias.asname or name, name
        return
    module = "." * node.level + (node.module or "")
    for alias in node.names:
        yield alias.asname or alias.name, module if alias.name == "*" else join_dotted(module, alias.name)


def make_mapping(call: ast.Call) -> ast.Dict:
    """The keyword arguments of a call as the mapping that `dict(...)` would make of them."""
    keys: list[ast.expr | None] = [
        ast.Constant(one.arg, lineno=one.lineno, col_offset=one.col_offset) if one.arg is not None else None
        for one in call.keywords
    ]
    return ast.Dict(keys, [one.value for one in call.keywords])


def format_dotted(node: ast.expr) -> str:
    """A path of names; nothing stands before the first dot of one that begins with anything else."""
    parts: list[str] = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    parts.append(node.id if isinstance(node, ast.Name) else "")
    return ".".join(reversed(parts))


def get_source(node: ast.AST) -> str:
    """The source of a node, written evenly in one line, without what no fact can hold."""
    return " ".join(drop_surrogates(ast.unparse(node)).split())


def list_caught_exceptions(handlers: Iterable[ast.ExceptHandler]) -> set[str]:
    """The last parts of the names of exceptions that are caught; `Exception` for all of them."""
    caught: set[str] = set()
    for handler in handlers:
        for kind in handler.type.elts if isinstance(handler.type, ast.Tuple) else [handler.type]:
            caught.add("Exception" if kind is None else format_dotted(kind).rpartition(".")[2])
    return caught


_EXITS = frozenset(("exit", "quit", "sys.exit", "os._exit"))


def gives_up(body: Sequence[ast.stmt]) -> bool:
    """True for what always ends the program, or raises an error: a test that is skipped goes on."""
    if any(isinstance(node, (ast.Return, ast.Break, ast.Continue)) for one in body for node in ast.walk(one)):
        return False
    last = body[-1]
    if isinstance(last, ast.Expr) and isinstance(last.value, ast.Call):
        return format_dotted(last.value.func) in _EXITS
    if not isinstance(last, ast.Raise):
        return False
    raised = last.exc.func if isinstance(last.exc, ast.Call) else last.exc
    return raised is None or format_dotted(raised).endswith(("Error", "Exception", "Exit"))


class SourceText:
    """The text that a syntax tree was made from, by lines."""

    def __init__(self, text: str) -> None:
        self.lines = text.split("\n")
        # Inside strings of several lines, the places that nodes tell differ between interpreters.
        self.unplaced = False

    def format_source(self, node) -> str:
        """The source of an expression or pattern, white space as single blanks, comments left out."""
        if self.unplaced:
            return get_source(node)
        first, last = node.lineno - 1, node.end_lineno - 1
        lines = self.lines
        if first == last:
            line = lines[first]
            if line.isascii():
                text = line[node.col_offset : node.end_col_offset]
            else:
                encoded = line.encode("utf-8", "replace")[node.col_offset : node.end_col_offset]
                text = encoded.decode("utf-8", "replace")
            return text if "  " not in text and "\t" not in text else " ".join(text.split())
        parts = [line.encode("utf-8", "replace") for line in lines[first : min(last + 1, first + _AT_MOST_LINES)]]
        if last < first + _AT_MOST_LINES:
            parts[-1] = parts[-1][: node.end_col_offset]
        parts[0] = parts[0][node.col_offset :]
        text = b"\n".join(parts).decode("utf-8", "replace")
        return " ".join(_COMMENT.sub(lambda match: match.group(1) or " ", text).split())

    def find_column(self, line: int, offset: int) -> int:
        """A parser's offset in UTF-8 bytes as a column in characters, from 1."""
        text = self.lines[line - 1]
        if text.isascii():
            return min(offset, len(text)) + 1
        return len(text.encode("utf-8", "replace")[:offset].decode("utf-8", "ignore")) + 1


def drop_surrogates(text: str) -> str:
    """The text without lone surrogates, which no fact can hold."""
    return text if text.isascii() else text.encode("utf-8", "replace").decode("utf-8")


class FormatPiece(NamedTuple):
    """A value in a format. value: its place, or its name. spec: how it is written, empty where as str() does."""

    value: int | str
    spec: str = ""


def split_percent_format(text: str) -> list[str | FormatPiece] | None:
    """What `text % values` is made of: literal text, and values of a tuple, or of a mapping; None for what is no format
    or takes its widths from values."""
    pieces: list[str | FormatPiece] = []
    literal, at, number = "", 0, 0
    for match in _PERCENT.finditer(text):
        before, at = text[at : match.start()], match.end()
        if "%" in before or "*" in (match["width"], match["precision"]):
            return None
        literal += before
        if match["kind"] == "%":
            literal += "%"
            continue
        pieces += [literal] if literal else []
        written = match[0].removeprefix("%")
        written = written if match["key"] is None else written.removeprefix(f"({match['key']})")
        spec = "" if written in ("s", "d", "i") else written
        pieces.append(FormatPiece(number if match["key"] is None else match["key"], spec))
        literal, number = "", number + (match["key"] is None)
    literal += text[at:]
    return None if "%" in text[at:] else [*pieces, *([literal] if literal else [])]


def format_pieces(text: str) -> list[str | FormatPiece] | None:
    """What `text.format(...)` is made of: literal text, positional arguments, and keywords, members and elements
    included; None for what is no format."""
    pieces: list[str | FormatPiece] = []
    number = 0
    try:
        for literal, field, spec, conversion in string.Formatter().parse(text):
            if literal:
                pieces.append(literal)
            if field is None:
                continue
            if spec and "{" in spec:
                return None
            written = (f"!{conversion}" if conversion not in (None, "s") else "") + ("" if spec == "s" else spec or "")
            if not field:
                pieces.append(FormatPiece(number, written))
                number += 1
            else:
                pieces.append(FormatPiece(int(field) if field.isdecimal() else field, written))
    except ValueError:
        return None
    return pieces


def fill_percent(text: str, values: Sequence[Any]) -> list[Any]:
    """What `text % values` puts together, where it is all `%s`; a None for anything else."""
    first, *others = text.split("%s")
    if not text.count("%") == len(others) == len(values):
        return [None]
    return [first, *(piece for pair in zip(values, others, strict=True) for piece in pair)]


def fill_format(text: str, values: Mapping[int | str, Any]) -> list[Any]:
    """What `text.format(...)` puts together, where it writes values as str() does; a None for anything else. values: of
    the arguments, by their places and names."""
    pieces = format_pieces(text)
    if pieces is None or any(spec for _, _, spec, _ in string.Formatter().parse(text)):
        return [None]
    return [piece if isinstance(piece, str) else values.get(piece.value) for piece in pieces]
