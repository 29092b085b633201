"""Flat commands to blocks: if, foreach, while, function, macro and block with what they hold."""

from ...facts.cmake import CMakeArgument, CMakeFile, Command
from .build import At
from .values import Template

# Deeper than any real file; what lies deeper is read as if its outermost surplus block were not there.
MAX_DEPTH = 60

_ENDS = {
    "endif": "if",
    "endforeach": "foreach",
    "endwhile": "while",
    "endfunction": "function",
    "endmacro": "macro",
    "endblock": "block",
}
_STARTS = frozenset(_ENDS.values())


class CommandCall:
    """One command invocation; its arguments are made ready when it is first run."""

    __slots__ = ("_templates", "arguments", "at", "name", "path")

    def __init__(self, command: Command, path: str):
        self.name = command.name
        self.arguments: tuple[CMakeArgument, ...] = command.arguments
        self.path = path
        self.at = At(path, command.line, command.column)
        self._templates: tuple[Template, ...] | None = None

    @property
    def templates(self) -> tuple[Template, ...]:
        """The arguments, ready for expansion."""
        made = self._templates
        if made is None:
            path = self.path
            made = self._templates = tuple([Template(argument, path) for argument in self.arguments])
        return made


class Block:
    """A block command with its body. kind is if, foreach, while, function, macro or block; an if has branches: pairs of
    the if(), elseif() or else() call and its body."""

    __slots__ = ("body", "branches", "head", "kind")

    def __init__(self, kind: str, head: CommandCall):
        self.kind = kind
        self.head = head
        self.body: list[CommandCall | Block] = []
        self.branches: list[tuple[CommandCall, list[CommandCall | Block]]] = [(head, self.body)] if kind == "if" else []


def build_blocks(facts: CMakeFile, path: str) -> tuple[list[CommandCall | Block], list[tuple[At, str]]]:
    """The file's commands in their blocks, and what does not match. An end without a start is skipped, a block without
    an end lasts until its parent's."""
    top: list[CommandCall | Block] = []
    stack: list[tuple[Block, list[CommandCall | Block]]] = []
    body = top
    problems: list[tuple[At, str]] = []
    surplus = 0
    for command in facts.commands:
        name = command.name
        if name in _STARTS:
            if len(stack) >= MAX_DEPTH:
                surplus += 1
                if surplus == 1:
                    problems.append((At(path, command.line, command.column), "blocks are nested too deeply"))
                continue
            block = Block(name, CommandCall(command, path))
            body.append(block)
            stack.append((block, body))
            body = block.body
        elif name in _ENDS:
            if surplus:
                surplus -= 1
                continue
            kind = _ENDS[name]
            depth = len(stack) - 1
            while depth >= 0 and stack[depth][0].kind != kind:
                depth -= 1
            if depth < 0:
                problems.append((At(path, command.line, command.column), f"{name}() without {kind}()"))
                continue
            for open_block, _ in stack[depth + 1 :]:
                problems.append((open_block.head.at, f"{open_block.kind}() is never closed"))
            body = stack[depth][1]
            del stack[depth:]
        elif name in ("else", "elseif"):
            if surplus:
                continue
            if stack and stack[-1][0].kind == "if":
                body = []
                stack[-1][0].branches.append((CommandCall(command, path), body))
            else:
                problems.append((At(path, command.line, command.column), f"{name}() without if()"))
        else:
            body.append(CommandCall(command, path))
    problems.extend((block.head.at, f"{block.kind}() is never closed") for block, _ in stack)
    return top, problems
