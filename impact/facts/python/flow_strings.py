"""Strings and paths that Python puts together: `+`, `/`, `%`, format and f-strings as joins of their pieces."""

from __future__ import annotations

import ast

from ..flow import Expr
from .flow_reading import ANY, LONGEST_OTHER, Reading
from .text import format_pieces, percent_pieces, printable


class Strings(Reading):
    """The reader of strings that are put together."""

    def value_BinOp(self, node: ast.BinOp, use: str, to: str, position: int, keyword: str, target: str) -> Expr:
        op = node.op.__class__
        if op is ast.Add:
            # Long sums lean to the left.
            operands = [node.right]
            left = node.left
            while left.__class__ is ast.BinOp and left.op.__class__ is ast.Add:  # type: ignore[attr-defined]
                operands.append(left.right)  # type: ignore[attr-defined]
                left = left.left  # type: ignore[attr-defined]
            operands.append(left)
            operands.reverse()
            return Expr("join", "+", tuple(self.value(operand, "read") for operand in operands))
        if op is ast.Mod and node.left.__class__ is ast.Constant and node.left.value.__class__ is str:  # type: ignore[attr-defined]
            return self.percent(node)
        if op is ast.Div:
            left = self.value(node.left, "read")
            right = self.value(node.right, "read")
            if (
                "text" in (left.kind, right.kind)
                or left.text.endswith("Path")
                or (left.kind, left.text) == ("join", "/")
            ):
                parts = left.parts if (left.kind, left.text) == ("join", "/") else (left,)
                return Expr("join", "/", (*parts, right))
            return self.other(node)
        self.visit(node.left)
        self.visit(node.right)
        return self.other(node)

    def percent(self, node: ast.BinOp) -> Expr:
        pieces = percent_pieces(node.left.value)  # type: ignore[attr-defined]
        right = node.right
        values: dict[int | str, Expr] = {}
        if right.__class__ is ast.Tuple:
            for place, element in enumerate(right.elts):  # type: ignore[attr-defined]
                values[place] = self.value(element, "read")
        elif right.__class__ is ast.Dict and None not in right.keys:  # type: ignore[attr-defined]
            for key, element in zip(right.keys, right.values, strict=False):  # type: ignore[attr-defined]
                known = key.value if key.__class__ is ast.Constant else ""
                values[known if known.__class__ is str else ""] = self.value(element, "read")
        else:
            values[0] = self.value(right, "read")
        return self.put_together(node, pieces, values)

    def put_together(self, node, pieces: list[str | int | tuple[str]] | None, values: dict[int | str, Expr]) -> Expr:
        """The join of literal pieces and values; other when a value is not told apart."""
        if pieces is None:
            return self.other(node)
        parts: list[Expr] = []
        for piece in pieces:
            if piece.__class__ is str:
                parts.append(Expr("text", printable(piece)))  # type: ignore[arg-type]
            elif piece.__class__ is int:
                if piece not in values:
                    return self.other(node)
                parts.append(values[piece])  # type: ignore[index]
            else:
                key = piece[0]  # type: ignore[index]
                parts.append(values[key] if key in values else Expr("other", printable(key)[:LONGEST_OTHER]))
        if len(parts) == 1 and parts[0].kind == "text":
            return parts[0]
        return Expr("join", "", tuple(parts))

    def formatted(self, node: ast.Call) -> Expr:
        """`"...".format(...)`."""
        values: dict[int | str, Expr] = {}
        unpacked = False
        for place, argument in enumerate(node.args):
            unpacked = unpacked or argument.__class__ is ast.Starred
            values[place] = self.value(argument, "read")
        for keyword in node.keywords:
            value = self.value(keyword.value, "read")
            if keyword.arg is not None:
                values[keyword.arg] = value
        if unpacked:
            return self.other(node)
        return self.put_together(node, format_pieces(node.func.value.value), values)  # type: ignore[attr-defined]

    def value_JoinedStr(self, node: ast.JoinedStr, use: str, *_: object) -> Expr:
        outermost = not self.unplaced and node.lineno != node.end_lineno
        if outermost:
            # Where things stand in a string of several lines, interpreters before 3.12 do not know.
            self.unplaced = True
            for inner in ast.walk(node):
                if hasattr(inner, "lineno"):
                    inner.lineno, inner.end_lineno = node.lineno, node.lineno  # type: ignore[attr-defined]
                    inner.col_offset = inner.end_col_offset = node.col_offset  # type: ignore[attr-defined]
        parts: list[Expr] = []
        for piece in node.values:
            if piece.__class__ is ast.Constant:
                parts.append(self.constant(piece))  # type: ignore[arg-type]
            elif piece.__class__ is ast.FormattedValue:
                parts.append(self.value(piece.value, "read"))  # type: ignore[attr-defined]
                if piece.format_spec is not None:  # type: ignore[attr-defined]
                    self.visit(piece.format_spec)  # type: ignore[attr-defined]
            else:
                self.visit(piece)
                parts.append(ANY)
        if outermost:
            self.unplaced = False
        if not parts:
            return Expr("text", "")
        return parts[0] if len(parts) == 1 and parts[0].kind == "text" else Expr("join", "", tuple(parts))
