"""Python sources to facts: imports, names used, and mentions of packages (launch files in Python included)."""

import ast
import codecs
import re
import warnings
from collections.abc import Iterable
from functools import lru_cache
from operator import attrgetter
from typing import NamedTuple

import msgspec

from ..distro_branches import BranchedName, ComparedDistro
from ..markup import find_text_encoding
from ..place import Problem, Reference
from ..words import list_words
from . import python2
from .branches import list_branched_names, list_compared_distros, list_distro_files
from .reader import TRY, AttributeUse, Import, PythonReader
from .text import drop_surrogates
from .uses import FieldUse, PythonUse, TypedName

NO_PYTHON = 1000
"""The minor version of Python 3 that syntax needs which this interpreter refuses and nothing explains."""
NEVER_PYTHON = 2000
"""The same of syntax on a line that has nothing which a newer Python may read otherwise."""


class PythonFile(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """imports, attributes and references in the order of the source.

    python2_only: (line, what) of syntax that Python 3 refuses (print statement, except X, e, backticks ...), found when
    the file does not parse, and `print >>f`, which parses and then fails. needs: the highest minor version of Python 3
    its syntax asks for, with line and reason (match: 10, except*: 11, type parameters: 12, ...; 0 for what any Python 3
    has and Python 2 has not; NO_PYTHON; NEVER_PYTHON), or None. interpreter: the first line when it is a `#!` that
    names python. uses: what calls and objects tell besides the attributes. fields: of interfaces. words: see
    list_words(). unbound: names that nothing in the file binds, and methods, with a dot before, that nothing in it
    defines and only Python 2 has; and what PythonReader.list_misused() lists. bound: names, between spaces, that others
    can import from it; empty where that cannot be known, and two spaces where there are none. typed: what of these
    shows its type. unknown: members of objects whose types do not show, with the number of places. branched,
    compared: see distro_branches.py and branches.py, where the `distro file`s among the references are explained too.
    """

    imports: tuple[Import, ...]
    attributes: tuple[AttributeUse, ...]
    references: tuple[Reference, ...]
    python2_only: tuple[Problem, ...] = ()
    needs: tuple[int, int, str] | None = None
    interpreter: str = ""
    problems: tuple[Problem, ...] = ()
    uses: tuple[PythonUse, ...] = ()
    words: str = ""
    fields: tuple[FieldUse, ...] = ()
    unbound: tuple[AttributeUse, ...] = ()
    bound: str = ""
    typed: tuple[TypedName, ...] = ()
    unknown: dict[str, int] = {}
    branched: tuple[BranchedName, ...] = ()
    compared: tuple[ComparedDistro, ...] = ()


class PythonSource(NamedTuple):
    """A source and its syntax tree. text: decoded, with `\\n` as the end of line. parsed: what the tree was made from:
    the text, or where Python 2 was rewritten the same lines with other words. tree: None for what does not parse.
    python2_only: as in PythonFile, of a text that was refused. refused: the line at which this interpreter refuses what
    is meant to be Python 3, or 0."""

    text: str
    parsed: str
    tree: ast.Module | None
    python2_only: tuple[Problem, ...]
    problems: tuple[Problem, ...]
    refused: int = 0


_NO_TEXT = " text"
_COOKIE = re.compile(rb"^[ \t\f]*#.*?coding[:=][ \t]*([-\w.]+)")
# What is no Python and not meant to be: places that a generator fills in, commands of a notebook.
_TEMPLATE = re.compile(r"@\w+@|@[({\[]|\$|\{%|<%|\{\{\s*[\w.]+\s*\}\}|^\s*[%!]\s*\w", re.MULTILINE)
# What Python 3.10 and later read, or may come to read, otherwise than those before: words that begin a statement, and
# strings that hold expressions. Of a string of several lines the error may be reported at any of them.
_MAY_BE_NEWER = re.compile(
    r"\s*(?:async|case|class|def|except|finally|from\s+__future__|lazy|match|type|with)\b"
    r"|[\w)\]]\s*\[\s*\*|[\[({]\s*\*|(?:\b|\d)[rR]?[fFtT][rR]?[\"']"
)
_LONG_STRING = re.compile(r"\b[rR]?[fFtT][rR]?(?:\"{3}|'{3})")
_SHEBANG = re.compile(r"#!.*python")
_IMPORT_LINE = re.compile(
    r"^(?P<indent>[ \t]*)(?:import[ \t]+(?P<modules>[\w., \t]+)"
    r"|from[ \t]+(?![ \t])(?P<dots>\.*)(?!\.)(?:[ \t]*(?P<module>[\w.]+))?[ \t]+import[ \t]*"
    r"(?P<names>\([^()]*\)|[\w.*, \t]+))",
    re.MULTILINE,
)


def _decode(data: bytes) -> tuple[str, tuple[Problem, ...]]:
    """The text of a source by its byte order mark or coding comment, as PEP 263 says, UTF-8 without."""
    problems: list[Problem] = []
    if data[:3] == codecs.BOM_UTF8:
        data = data[3:]
    encoding, cookie_line = "utf-8", 1
    for number, line in enumerate(data.split(b"\n", 2)[:2], 1):
        cookie = _COOKIE.match(line)
        if cookie:
            encoding, cookie_line = cookie.group(1).decode("ascii", "replace").lower(), number
            break
        if line.strip() and not line.lstrip().startswith(b"#"):
            break
    try:
        text = data.decode(find_text_encoding(encoding))
    except LookupError:
        problems.append(Problem(cookie_line, f"unknown encoding `{encoding}`"))
        text = data.decode("utf-8", "replace")
    except (UnicodeError, ValueError) as error:
        at = error.start if isinstance(error, UnicodeDecodeError) else 0
        problems.append(Problem(data.count(b"\n", 0, at) + 1, f"not {encoding}{_NO_TEXT}"))
        text = data.decode("latin-1")
    text = drop_surrogates(text)  # which escapes of odd codecs may give
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return text, tuple(problems)


def _parse(text: str) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(text)


def _parse_python2(text: str, error: SyntaxError) -> tuple[tuple[Problem, ...], ast.Module | None, str]:
    """What only Python 2 reads in a refused text, the tree of the text rewritten, when that parses, and that text."""
    old, rewritten = python2.find(text)
    tabs = error if isinstance(error, TabError) else None
    for _ in range(2):
        if tabs is not None:
            old = (*old, Problem(tabs.lineno or 1, "tabs mixed with spaces"))
            rewritten = python2.expand_tabs(rewritten)
        if not old:
            break
        try:
            return old, _parse(rewritten), rewritten
        except TabError as again:
            tabs = again
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            break
    return old, None, text


@lru_cache(maxsize=1)
def read(data: bytes) -> PythonSource:
    """One Python source parsed by this interpreter's own parser, Python 2 as far as it can be rewritten. Never raises.

    The last source is remembered for the second look that message flow takes at it. Syntax newer than this interpreter
    is a problem, never `python2_only`.
    """
    text, problems = _decode(data)
    try:
        # Bytes that the encoding does not have are refused wherever they stand, in comments too.
        undecoded = next((problem.line for problem in problems if problem.message.endswith(_NO_TEXT)), 0)
        return PythonSource(text, text, _parse(text), (), problems, undecoded)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        old, tree, rewritten = _parse_python2(text, error) if isinstance(error, SyntaxError) else ((), None, text)
        if not old:
            line = min(getattr(error, "lineno", None) or 1, text.count("\n") + 1)
            what = error.msg if isinstance(error, SyntaxError) else str(error) or type(error).__name__
            problems = (*problems, Problem(line, f"not parsed: {what}"))
            if isinstance(error, SyntaxError) and not _TEMPLATE.search(python2.mask(text)):
                return PythonSource(text, rewritten, tree, old, problems, line)
        return PythonSource(text, rewritten, tree, old, problems)


# How a robot description is written: by xacro, which is given where to, or as any file.
_WRITES = re.compile(
    r"\bxacro\b.{0,300}?[\s\"'](?:-o|--output)[\s\"'=]|\bopen\([^\n]*,\s*(?:mode=)?[\"'][wx]", re.DOTALL
)
_DESCRIPTION = (".urdf", ".sdf", ".srdf")


def _sort_references(text: str, references: Iterable[Reference]) -> tuple[Reference, ...]:
    """References in the order of the source. Where it writes descriptions, those that it names may be made by it, so
    that nothing needs to be there."""
    if _WRITES.search(text):
        references = (
            msgspec.structs.replace(one, conditional=True) if one.name.endswith(_DESCRIPTION) else one
            for one in references
        )
    return tuple(sorted(references, key=attrgetter("line", "column")))


def extract(data: bytes) -> PythonFile:
    """The facts of one Python file. Never raises.

    Where the file cannot be parsed, imports are read line by line and all else is left out.
    """
    text, parsed, tree, old, problems, refused = read(data)
    first_line = text.split("\n", 1)[0]
    interpreter = first_line.strip() if _SHEBANG.match(first_line) else ""
    if tree is not None:
        try:
            reader = PythonReader(parsed, text)
            # What was rewritten may have lost names that it binds.
            reader.watches_names = reader.watches_names and not old
            reader.read(tree)
            bound = reader.find_bound_names()
            uses = reader.list_object_uses(reader.find_column)
            asks = "ROS_DISTRO" in parsed
            by_distro = tuple(list_distro_files(tree)) if asks else ()
            undecoded = (NEVER_PYTHON, refused, "SyntaxError") if refused else None
            return PythonFile(
                imports=tuple(reader.imports),
                attributes=reader.list_attributes(),
                references=_sort_references(text, (*reader.references, *by_distro)),
                python2_only=old or tuple(reader.python2_only),
                needs=undecoded or (None if old else reader.needs),
                interpreter=interpreter,
                problems=problems,
                uses=uses,
                words=list_words(data),
                fields=reader.list_field_uses(reader.find_column),
                unbound=() if old else reader.list_unbound_names(bound),
                bound="" if bound is None else f" {' '.join(sorted(bound))} ",
                typed=reader.list_typed_names(),
                unknown=reader.unknown,
                branched=tuple(list_branched_names(tree)) if asks and not old else (),
                compared=tuple(list_compared_distros(tree)) if asks else (),
            )
        except RecursionError:
            problems = (*problems, Problem(1, "nested too deeply"))
    return PythonFile(
        imports=_find_imports_by_line(text),
        attributes=(),
        references=(),
        python2_only=old,
        needs=(_find_needed(text, refused), refused, "SyntaxError") if refused else None,
        interpreter=interpreter,
        problems=problems,
        words=list_words(data),
    )


def _find_needed(text: str, line: int) -> int:
    """The version that a text needs which this interpreter refuses from a line on."""
    newer = _MAY_BE_NEWER.search(text.split("\n")[line - 1]) or _LONG_STRING.search(text)
    return NO_PYTHON if newer else NEVER_PYTHON


def _find_imports_by_line(text: str) -> tuple[Import, ...]:
    """Imports of text that no parser reads: by their look. An indented one is taken for optional, whatever it is in."""
    visible = python2.mask(text)
    imports: list[Import] = []
    line, at = 1, 0
    for match in _IMPORT_LINE.finditer(visible):
        start = match.end("indent")
        line += visible.count("\n", at, start)
        at = start
        column = len(match.group("indent")) + 1
        conditions = (TRY,) if column > 1 else ()
        if match.group("modules") is not None:
            for module in match.group("modules").split(","):
                words = module.split()
                if words:
                    imports.append(Import(words[0], (), 0, line, column, column > 1, conditions))
        else:
            names = [part.split() for part in match.group("names").strip("()").split(",")]
            given, dots = tuple(words[0] for words in names if words), len(match.group("dots"))
            imports.append(Import(match.group("module") or "", given, dots, line, column, column > 1, conditions))
    return tuple(imports)
