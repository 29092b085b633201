"""What one C or C++ header offers to those who include it: its entities with all that a caller can depend on.

Nothing is resolved: types are as written, brought into one form, so that reformatting a header changes nothing here.
"""

from collections.abc import Collection, Iterable, Iterator

import msgspec

from .condition import Condition
from .cpp.lexical import Include
from .place import Problem


class CppParameter(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter of a function. type: normalised, without a `const` that callers do not see. default: as written,
    white space as single blanks, None for none. pack: `T... name`."""

    type: str
    name: str = ""
    default: str | None = None
    pack: bool = False


class TemplateParameter(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A parameter of a template. kind: `type`, `value`, `template` or `concept`; type: of a value, the concept of a
    constrained type, else empty."""

    kind: str
    name: str
    type: str = ""
    default: str | None = None
    pack: bool = False


class Base(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A base class, as written. access: public, protected or private."""

    type: str
    access: str
    virtual: bool = False


class Entity(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One thing that a header declares.

    name: qualified by namespaces and classes, inline ones included (see `plain`), template arguments left out. Members
    of an unnamed union are named as members of what is around it. `operator()`, `operator bool`, `~Foo` and `Foo::Foo`
    are names too. An enumerator of an unscoped enum stands in the scope of its enum, as users write it.

    | kind | type | value | others |
    |---|---|---|---|
    | class, struct, union | | | template, arguments (of a specialisation), bases |
    | enum | underlying type as written | | `scoped` in traits |
    | enumerator | qualified name of its enum | its number where that can be known, else the expression | |
    | function, method, constructor, destructor, conversion | result (`auto` where it is deduced) | | parameters |
    | variable, field | type | of a constant: what it is | |
    | alias | what it stands for | | template |
    | macro | | of an object-like macro, when it is one literal: that | parameters, None for an object-like one |
    | concept | | | template |
    | namespace alias | the namespace | | |
    | using | what is taken over: `ns::name` (name is then as it can be called here) | | |
    | using namespace | the namespace; name is the scope where it is written | | |

    access: empty outside classes. traits, sorted: const, constexpr, consteval, static, virtual, pure, override, final,
    noexcept, explicit, deleted, defaulted, friend, inline, extern, mutable, volatile, scoped, nodiscard, variadic, `&`,
    `&&`. deprecated: None, or the message, which may be empty. internal: stands in a namespace that is called detail,
    internal, impl or the like. macro: the macro that declares it, where it is not spelt out. A private entity is only
    there when it is virtual, deleted, or a constructor or destructor (the compiler then makes none)."""

    kind: str
    name: str
    line: int
    type: str = ""
    parameters: tuple[CppParameter, ...] | None = None
    template: tuple[TemplateParameter, ...] | None = None
    traits: tuple[str, ...] = ()
    access: str = ""
    value: str = ""
    deprecated: str | None = None
    bases: tuple[Base, ...] = ()
    arguments: str = ""
    internal: bool = False
    macro: str = ""
    conditions: tuple[Condition, ...] = ()


class HeaderSurface(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """entities in the order of the file; includes as in CppFile; announced: qualified names of types that are declared
    but not defined here, outside of classes; inline: qualified names of inline namespaces;
    deprecated: the message with which the whole header warns whoever includes it, None for no warning; instead: the
    header that it then takes in, empty when that cannot be known; lost: characters of declarations that were not
    understood; problems: what could not be read."""

    entities: tuple[Entity, ...]
    includes: tuple[Include, ...] = ()
    inline: tuple[str, ...] = ()
    deprecated: str | None = None
    instead: str = ""
    lost: int = 0
    problems: tuple[Problem, ...] = ()
    announced: tuple[str, ...] = ()


FUNCTIONS = frozenset(("function", "method", "constructor", "destructor", "conversion"))
CLASSES = frozenset(("class", "struct", "union"))


def drop_inline(name: str, inline: Collection[str]) -> str:
    """A qualified name without the inline namespaces in it: as users write it."""
    if not inline:
        return name
    parts = name.split("::")
    kept = [part for index, part in enumerate(parts) if "::".join(parts[: index + 1]) not in inline]
    return "::".join(kept)


def list_offered(surfaces: Iterable[HeaderSurface]) -> Iterator[Entity]:
    """The entities of some headers, named as users write them."""
    surfaces = list(surfaces)
    inline = {name for surface in surfaces for name in surface.inline}
    for surface in surfaces:
        for entity in surface.entities:
            name = drop_inline(entity.name, inline)
            yield entity if name == entity.name else msgspec.structs.replace(entity, name=name)


def format_declaration(one: Entity) -> str:
    """An entity as it could be written, in one line."""
    parts = []
    if one.template is not None:
        parameters = (f"{p.type or 'typename'}{'...' if p.pack else ''} {p.name}".strip() for p in one.template)
        parts.append(f"template<{', '.join(parameters)}>")
    parts += [trait for trait in ("explicit", "virtual", "static", "constexpr") if trait in one.traits]
    if one.kind in CLASSES or one.kind == "enum":
        scoped = "enum class" if "scoped" in one.traits else one.kind
        bases = ", ".join(f"{base.access} {base.type}".strip() for base in one.bases)
        under = f" : {one.type}" if one.type else ""
        parts += [
            scoped,
            one.name
            + (f"<{one.arguments}>" if one.arguments and not one.name.endswith(">") else "")
            + (f" : {bases}" if bases else under),
        ]
    elif one.kind == "macro":
        arguments = "" if one.parameters is None else f"({', '.join(p.name or p.type for p in one.parameters)})"
        parts += [f"#define {one.name}{arguments}", one.value]
    elif one.kind == "alias":
        parts += [f"using {one.name} =", one.type]
    elif one.kind in FUNCTIONS:
        arguments = ", ".join(
            f"{p.type}{'...' if p.pack else ''} {p.name}".strip() + (f" = {p.default}" if p.default is not None else "")
            for p in one.parameters or ()
        )
        parts += [one.type, f"{one.name}({arguments})"]
        parts += [t for t in ("const", "&", "&&", "noexcept", "override", "final") if t in one.traits]
        parts += [f"= {end}" for trait, end in (("pure", "0"), ("deleted", "delete")) if trait in one.traits]
    else:
        parts += ["" if one.kind == "enumerator" else one.type, one.name, f"= {one.value}" if one.value else ""]
    return " ".join(part for part in parts if part)
