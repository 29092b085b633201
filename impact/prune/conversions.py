"""The functions that fill a lighter message from the full one, and the full one from the lighter, in C++ and Python."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .shape import LightField


class Conversion(NamedTuple):
    """A conversion between two messages. full, light: `package/Name`. name: of the function. topic: it is made for.
    widens: from the lighter to the full one. fields: what both have in common."""

    name: str
    full: str
    light: str
    topic: str
    fields: tuple[LightField, ...]
    widens: bool = False

    @property
    def result(self) -> str:
        """The message that is made."""
        return self.full if self.widens else self.light

    @property
    def given(self) -> str:
        """The message that it is made from."""
        return self.light if self.widens else self.full


def write_cpp(one: Conversion, ros: int, pointers: bool) -> str:
    """The function in C++, with another of its name that takes a pointer where asked for. ros: the generation."""
    made, given = spell_cpp(one.result, ros), spell_cpp(one.given, ros)
    to, source = ("full", "light") if one.widens else ("light", "full")
    lines = [
        f"// {describe(one)}",
        f"inline {made} {one.name}(const {given} & {source})",
        "{",
        f"  {made} {to};",
        *_assign_cpp(one.fields, to, source, "  ", 0),
        f"  return {to};",
        "}",
    ]
    if pointers:
        lines += [
            "",
            "template<typename Pointer>",
            f"inline auto {one.name}(const Pointer & {source}) -> decltype({one.name}(*{source}))",
            "{",
            f"  return {one.name}(*{source});",
            "}",
        ]
    return "\n".join(lines) + "\n"


def spell_cpp(type_: str, ros: int) -> str:
    """The name of a message `package/Name` in C++."""
    package, _, name = type_.partition("/")
    return f"{package}::{name}" if ros == 1 else f"{package}::msg::{name}"


def _assign_cpp(fields: Sequence[LightField], to: str, source: str, indent: str, depth: int) -> Iterator[str]:
    for field in fields:
        one, other = f"{to}.{field.name}", f"{source}.{field.name}"
        if not field.members:
            yield f"{indent}{one} = {other};"
        elif not field.array:
            yield from _assign_cpp(field.members, one, other, indent, depth)
        else:
            index = "ijklmn"[depth % 6]
            if not field.fixed:
                yield f"{indent}{one}.resize({other}.size());"
            yield f"{indent}for (size_t {index} = 0; {index} < {other}.size(); ++{index}) {{"
            yield from _assign_cpp(field.members, f"{one}[{index}]", f"{other}[{index}]", indent + "  ", depth + 1)
            yield f"{indent}}}"


def write_python(one: Conversion) -> str:
    """The function in Python."""
    to, source = ("full", "light") if one.widens else ("light", "full")
    lines = [
        f"def {one.name}({source}):",
        f'    """{describe(one)}"""',
        f"    {to} = {one.result.partition('/')[2]}()",
        *_assign_python(one.fields, to, source, "    ", 0),
        f"    return {to}",
    ]
    return "\n".join(lines) + "\n"


def list_python_types(fields: Sequence[LightField]) -> Iterator[str]:
    """The nested lighter messages, `package/Name`, that the function in Python makes one by one."""
    for field in fields:
        if field.members and field.array:
            yield field.light
        yield from list_python_types(field.members)


def _assign_python(fields: Sequence[LightField], to: str, source: str, indent: str, depth: int) -> Iterator[str]:
    for field in fields:
        one, other = f"{to}.{field.name}", f"{source}.{field.name}"
        if not field.members:
            yield f"{indent}{one} = {other}"
        elif not field.array:
            yield from _assign_python(field.members, one, other, indent, depth)
        else:
            each, made = f"each{depth or ''}", f"made{depth or ''}"
            yield f"{indent}{one} = []"
            yield f"{indent}for {each} in {other}:"
            yield f"{indent}    {made} = {field.light.partition('/')[2]}()"
            yield from _assign_python(field.members, made, each, indent + "    ", depth + 1)
            yield f"{indent}    {one}.append({made})"


def describe(one: Conversion) -> str:
    """What a conversion does, in a line for whoever reads the code."""
    if one.widens:
        return f"The message that the lighter one of {one.topic} stands for; fields that nobody reads stay empty."
    return f"Fills the lighter message of {one.topic} with the fields that its subscribers read."
