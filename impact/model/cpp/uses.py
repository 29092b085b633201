"""Uses in one C++ file of other packages' names that are not the same in all versions: C++ names, overrides, fields."""

import re
from collections.abc import Collection, Iterable, Iterator
from functools import lru_cache

from ....edges.memory import cache_method
from ...facts.cpp.lexical import KEYWORDS
from ...facts.cpp.schema import CodePlace, CppClass, Expr, WrittenParameter
from ...facts.cpp.schema import CppUse as Written
from ...facts.usage import find_template_arguments
from ...targets.surface.overrides import describe_bases, describe_override
from ..api import ASSIGNING, CALLED, CLASSES, ChangingName, FoundName
from ..members import FoundField as FoundMember
from .resolver import CppType, KnownFile, Resolver, locate_class

# Both are matched backwards from what stands behind them.
_LAST_WORD = re.compile(r"\w*[A-Za-z_]")
_OF_STD = re.compile(r"(?<![\w:])std\s*::\s*\w+\s*<[^<>;(){}]*>\s*::\s*\Z")
# What may stand before a name that is used, and is no type of one that is declared: `emit finished()`.
_NO_TYPES = KEYWORDS | {"emit", "not", "and", "or", "xor", "compl", "bitand", "bitor"}
_SCOPES = re.compile(r"(?:\s*::\s*\w*[A-Za-z_])+(?![\w>:])")
# What the text of arguments has where one of them shows itself to be something that can be refused.
_SHOWN = {
    shown: re.compile(pattern)
    for shown, pattern in (
        ("text", r"\""), ("this", r"\bthis\b"), ("new", r"\bnew\b"),
        ("qos", r"rclcpp\s*::\s*\w*QoS|(?i:qos)\w*\s*(?![\w\s:({])"),
        ("profile", r"rmw_qos_profile|(?i:qos|profile)\w*\s*(?![\w\s:({])"),
    )
}  # fmt: skip
# The types of quality of service: those of rclcpp, and the structure of rmw which they replaced.
_QOS_TYPES = {
    "qos": re.compile(r"(?:static |const )*rclcpp\s*::\s*\w*QoS\s*&?"),
    "profile": re.compile(r"(?:static |const |struct )*rmw_qos_profile_[ts]\s*&?"),
}
_DIRECTIVE = re.compile(r"^[ \t]*#", re.M)
_DECLARED_END = re.compile(r"[;{]|\Z")
_SPACE = re.compile(r"\s*")
_MARKS = re.compile(r"[()\[\]{},;<\"']|/[/*]|\.\.\.")
_LITERALS = {'"': re.compile(r'"(?:[^"\\\n]|\\.)*"'), "'": re.compile(r"'(?:[^'\\\n]|\\.)*'")}
_FARTHEST, _FAR = 4000, 160
_DEEPEST = 8
_INTERFACES = ("::msg", "::srv", "::action")
_CONSTRUCTED = re.compile(r"\s*(?:[({]|>\s*\(|[A-Za-z_]\w*\s*\()")
_INITIALIZED = re.compile(r"\s*\(")
INITIALIZES = re.compile(rb"\)\s*(?:noexcept\s*)?:\s*[A-Za-z_]")
"""What a text has where a constructor may initialize members."""
_INSTANTIATED = re.compile(rb"\b(?:new\s+|make_(?:shared|unique)\s*<\s*)(?:::)?([A-Za-z_]\w*(?:::\w+)*)\s*[>(;{,)]")
_TYPES = CLASSES | {"alias", "enum"}


class ApiUses:
    """Uses of C++ names of other packages. heads: first parts of the paths of other packages' headers that reach the
    file. unresolved: offsets of members that may be such names, of objects whose type is not known, in a file that
    names a class which has such a member."""

    def __init__(self, resolver: Resolver, heads: Collection[str] = ()):
        assert resolver.vocabulary is not None
        self.resolver, self.heads = resolver, heads
        self.vocabulary = resolver.vocabulary
        self.unresolved: set[int] = set()

    def find_uses(self, words: Iterable[str]) -> Iterator[FoundName]:
        """Every use of a name that is looked for and whose last part is among the words."""
        words = list(words)
        home = self.vocabulary.home
        for use in self.resolver.known.code.list_uses(words, self._may_matter):
            for found in (self._resolve_use(use), self._find_construction(use)):
                if found is not None and found.package not in home and self._differs(found):
                    yield found
        yield from (found for found in self._find_overrides(frozenset(words)) if found.package not in home)

    def _may_matter(self, word: str, at: int) -> bool:
        """Whether a word may be such a use, as far as the text around it shows."""
        text, vocabulary = self.resolver.known.code.text, self.vocabulary
        before = at
        while before and text[before - 1] in " \t\n":
            before -= 1
        if word in ASSIGNING:
            root = _find_ahead(_LAST_WORD, text, before)
            if not root:
                return text[before - 1 : before] == "]"
            speakers = vocabulary.list_member_speakers(word)
            return root.endswith("_") or any(self.resolver.known.mentions(one) for one in speakers)
        sign = text[before - 2 : before]
        if sign == "->" or sign.endswith("."):
            return vocabulary.is_member(word) and self._may_be_any(vocabulary.list_by_last(word), text, at + len(word))
        if sign != "::":
            return not _is_declared(text, before, at) and self._may_be_any(self._list_bare(word), text, at + len(word))
        scopes = _find_ahead(_SCOPES, text, before)
        if not scopes:  # behind template arguments, or of the global namespace
            of_std = _OF_STD.search(text, max(0, before - _FAR), before) is not None
            return not of_std and self._may_be_any(vocabulary.list_by_last(word), text, at + len(word))
        scope = "".join(scopes.split()).removesuffix("::")
        head = scope.partition("::")[0]
        if head == "std":
            return False
        full = f"{scope}::{word}"
        known = vocabulary.names.get(full)
        end = at + len(word)
        if known is not None and (known.there or (known.what in CALLED and _may_differ(known, text, end))):
            return True
        if f"{full}::{word}" in vocabulary.list_constructors(word):
            return _may_differ(vocabulary.names[f"{full}::{word}"], text, end)
        if known is not None or scope.endswith(_INTERFACES):
            return False
        if scope not in vocabulary.classes and vocabulary.has_space(head):
            return False
        return self._may_be_any(vocabulary.list_by_last(word), text, end)

    def _may_be_any(self, names: Iterable[str], text: str, end: int) -> bool:
        """Whether one of some names that all end alike may be used in a way that differs between versions."""
        every = map(self.vocabulary.names.__getitem__, names)
        return any(known.there or (known.what in CALLED and _may_differ(known, text, end)) for known in every)

    @cache_method
    def _list_bare(self, word: str) -> list[str]:
        """The names that a word without an object or scopes before it may be: what is around them has to be near."""
        owners = {name: name.rpartition("::")[0] for name in self.vocabulary.list_by_last(word)}
        return [n for n, owner in owners.items() if not owner or self._is_near(self.vocabulary.list_speakers(owner))]

    @cache_method
    def _is_near(self, names: frozenset[str]) -> bool:
        """Whether one of some names stands in the file or in a header of the package that it reaches."""
        return any(file.mentions_any(names) for file in self.resolver.files)

    def _differs(self, found: FoundName) -> bool:
        return self.vocabulary.names[found.name].differs(found.how, found.arguments, found.given, found.templated)

    def _resolve_use(self, use: Written) -> FoundName | None:
        if use.form == "member":
            return self._find_object_member(use)
        if use.form == "scoped":
            return self._find_scoped(use)
        if use.form == "bare":
            return self._find_bare(use)
        if use.form == "assigned" and use.object is not None:
            type_ = self.resolver.resolve_value(use.object, use.place)
            return self._find_member(type_, use) if type_ is not None and type_.plain else None
        return None

    def _find_object_member(self, use: Written) -> FoundName | None:
        assert use.object is not None
        if use.object.kind == "this":
            return self._find_this_member(use)
        type_ = self.resolver.resolve_value(use.object, use.place)
        if type_ is None:
            if any(self.resolver.known.mentions(one) for one in self.vocabulary.list_member_speakers(use.word)):
                self.unresolved.add(use.offset)
            return None
        return self._find_member(type_, use) if not type_.several and type_.pointer == use.arrow else None

    def _find_member(self, type_: CppType, use: Written) -> FoundName | None:
        if not type_.name:
            return None
        if type_.own:
            return self._find_own_member(type_.name, use)
        member = self.vocabulary.find_member(type_.name, use.word)
        return None if member is None else self._make_use(member[0], use, True, member[1])

    def _find_own_member(self, class_: str, use: Written) -> FoundName | None:
        member = self.resolver.find_own_member(class_, use.word)
        return None if member is None else self._make_use(member[0], use, "" not in member[1], member[1])

    def _find_scoped(self, use: Written) -> FoundName | None:
        """`scope::word`."""
        scope = use.name.rpartition("::")[0]
        if scope == "std" or scope.startswith("std::"):
            return None
        for full in self.resolver.list_meanings(scope, use.place):
            name = f"{full}::{use.word}"
            if name in self.vocabulary.names:
                return None if self.resolver.declares_in(full, use.word) else self._make_use(name, use, True, ())
        type_ = self.resolver.resolve_name(scope, use.place)
        return self._find_member(type_, use) if type_ is not None and not type_.own and type_.plain else None

    def _find_bare(self, use: Written) -> FoundName | None:
        names, word = self.vocabulary.names, use.word
        if use.local is not None:
            return None
        if word in names:
            # A macro, a function of C, or a type; what else lies in no namespace may be anybody's.
            known = names[word]
            if known.what in _TYPES:
                return self._make_use(word, use, True, ()) if self._is_bare_type(use, known.package) else None
            if known.what not in ("macro", "function", "enumerator") or "_" not in word:
                return None
            return None if self.resolver.declares(word) else self._make_use(word, use, known.package in self.heads, ())
        full = self._find_using(use)
        if full is not None:
            return self._make_use(full, use, True, ()) if full in names else None
        inner = self._find_this_member(use)
        if inner is not None:
            # Without the member, the name is that of the package, if it declares one.
            return None if self.resolver.declares(word) else inner
        for space in (*self._list_namespaces(use.place), *self.resolver.list_opened(use.place)):
            full = f"{space}::{word}"
            if full in names and names[full].what not in ("method", "field") and not self.resolver.declares(word):
                return self._make_use(full, use, False, ())
        return None

    def _list_namespaces(self, place: CodePlace) -> Iterator[str]:
        """The namespaces around a place."""
        around = place.scope
        while around:
            yield around
            around = around.rpartition("::")[0]

    def _find_using(self, use: Written) -> str | None:
        """The full name that a using declaration makes known."""
        for full in use.place.used:
            if full.rpartition("::")[2] == use.word:
                return full
        return next(
            (full for file in self.resolver.files
             if (full := file.code.using.get(use.word)) is not None), None
        )  # fmt: skip

    def _is_bare_type(self, use: Written, package: str) -> bool:
        """Whether a package's type that lies in no namespace is surely meant: outside of classes and functions, where
        no base class has a name like it, and where nothing makes one known by another way."""
        word, place = use.word, use.place
        return (
            package in self.heads
            and not (word.islower() or word.isupper())
            and not place.function
            and (not place.owner or place.scope != place.owner)
            and not self.vocabulary.knows(place.scope.partition("::")[0])
            and not any(
                file.code.opened or word in file.code.using or any(file.list_aliases(word))
                for file in self.resolver.files
            )
            and not self.resolver.declares(word)
        )

    def _find_this_member(self, use: Written) -> FoundName | None:
        """A member of the class around a place that one of its bases in another package has."""
        if not use.place.owner or not self.vocabulary.is_member(use.word):
            return None
        return self._find_own_member(use.place.owner, use)

    def _find_construction(self, use: Written) -> FoundName | None:
        """A constructor that is called where the name of its class stands."""
        if use.call is None or not use.last or use.form in ("member", "assigned") or use.local is not None:
            return None
        owners = self.vocabulary.list_constructors(use.word)
        if not owners:
            return None
        if not use.made and use.form != "initializer" and not use.place.function:
            return None
        type_ = self.resolver.resolve_name(use.name, use.place)
        if type_ is None or type_.own or not type_.plain or f"{type_.name}::{use.word}" not in owners:
            return None
        name = f"{type_.name}::{use.word}"
        count, given = self._describe_arguments(use)
        return FoundName(self.vocabulary.names[name].package, name, use.offset, "call", count, given,
                     use.template is not None, True, ())  # fmt: skip

    def find_initialized(self, classes: frozenset[str], files: Iterable[KnownFile]) -> Iterator[FoundName]:
        """Constructors of other packages' classes that initializer lists of the file call by the name of a member.
        classes: last parts of the classes that may be meant. files: where members may be declared."""
        code, home = self.resolver.known.code, self.vocabulary.home
        declared = (name for file in files for class_ in classes for name in file.list_like_members(class_))
        members = {name for name in declared if code.mentions(name)}
        for use in code.list_uses(sorted(members), self._may_initialize):
            type_ = self.resolver.resolve_variable(use.word, use.place) if use.form == "initializer" else None
            if type_ is None or type_.own or not type_.plain or use.call is None:
                continue
            name = f"{type_.name}::{type_.name.rpartition('::')[2]}"
            if name in self.vocabulary.names and self.vocabulary.names[name].package not in home:
                count, given = self._describe_arguments(use)
                found = FoundName(self.vocabulary.names[name].package, name, use.offset, "call", count, given, False,
                                  True, ())  # fmt: skip
                if self._differs(found):
                    yield found

    def _may_initialize(self, word: str, at: int) -> bool:
        """Whether a name at an offset may begin a part of an initializer list."""
        text = self.resolver.known.code.text
        return _INITIALIZED.match(text, at + len(word)) is not None and text[:at].rstrip()[-1:] in (":", ",")

    def _make_use(self, name: str, use: Written, sure: bool, through: tuple[str, ...]) -> FoundName:
        """The use that a name at a place is."""
        known = self.vocabulary.names[name]
        how, count, given = "name", -1, ()
        if known.what in CALLED and use.call is not None and not use.made:
            how = "call"
            count, given = self._describe_arguments(use)
        return FoundName(known.package, name, use.offset, how, count, given, use.template is not None, sure, through)

    def _describe_arguments(self, use: Written) -> tuple[int, tuple[str, ...]]:
        """How many arguments a call gives (-1: not to be told), and what each shows itself to be."""
        call = use.call or ()
        if any(argument.kind == "pack" for argument in call):
            return -1, ()
        return len(call), tuple(self.classify(argument, use.place) for argument in call)

    def classify(self, argument: Expr, place: CodePlace) -> str:
        """What an argument shows itself to be: `text`, `float`, `integer`, `bool`, `lambda`, `bind`, `null`, `this`,
        `*this`, `new`, `qos` (an rclcpp::QoS) or `profile` (an rmw_qos_profile_t); empty for the rest."""
        kind = argument.kind
        if kind == "literal":
            return argument.text
        if kind in ("lambda", "this", "new"):
            return kind
        if kind == "unary":
            inner = argument.parts[0] if argument.parts else None
            if inner is not None and argument.text == "*" and inner.kind == "this":
                return "*this"
            if inner is not None and argument.text in "+-" and inner.kind == "literal":
                return inner.text
            return ""
        if kind == "name":
            if argument.text == "NULL":
                return "null"
            made = argument.text.startswith("rmw_qos_profile_")
            return "profile" if made else self._classify_variable(argument, place)
        if kind not in ("call", "braces"):
            return ""
        callee = argument.parts[0] if kind == "call" else None
        name = argument.text if callee is None else callee.text
        if callee is not None and callee.kind == "name" and name in ("std::bind", "boost::bind"):
            return "bind"
        if callee is not None and callee.kind == "member":
            return "profile" if name == "get_rmw_qos_profile" else ""
        return "qos" if re.fullmatch(r"rclcpp\s*::\s*\w*QoS", name) else ""

    def _classify_variable(self, name: Expr, place: CodePlace) -> str:
        """The same of a variable, by the type that it is declared with, or by what it begins with; empty where a
        directive stands between its declaration and here, which may leave that out."""
        local = name.local
        if local is not None and _DIRECTIVE.search(self.resolver.known.code.text, local.offset, name.offset):
            return ""
        if local is not None and "auto" in local.type:
            return self.classify(local.value, place) if local.value is not None and local.how == "variable" else ""
        type_ = self.resolver.find_written_type(name, place)
        return next((shown for shown, known in _QOS_TYPES.items() if known.fullmatch(type_)), "")

    def _find_overrides(self, words: frozenset[str]) -> Iterator[FoundName]:
        """Methods that classes of the file declare and that a base in another package has, virtual in some version."""
        names = self.vocabulary.names
        code = self.resolver.known.code
        virtual = {
            word for word in words
            if self._is_near(self.vocabulary.list_virtual_speakers(word)) and code.may_declare(word)
        }  # fmt: skip
        for class_ in code.file.classes if virtual and code.may_derive else ():
            if not class_.bases:
                continue
            declared = sorted(virtual.intersection(class_.members))
            lines = (
                [self.resolver.list_known_bases(base, locate_class(class_)) for base in class_.bases]
                if declared
                else []
            )
            for word in declared:
                for method in class_.members[word]:
                    if method.kind != "function" or "static" in method.traits or _is_split(code.text, method.offset):
                        continue
                    for line in lines:
                        member = self._find_first(line, word)
                        if member is None:
                            continue
                        types = tuple(normalise_parameter(one) for one in method.parameters)
                        marks = tuple(mark for mark in ("const", "override") if mark in method.traits)
                        if "final" in method.traits and "override" not in marks:
                            marks = (*marks, "override")
                        if "override" in marks and (bases := self._list_all_bases(class_, word)):
                            marks = (*marks, describe_bases(bases))
                        given = describe_override(types, marks, normalise_parameter(method.type), class_.name)
                        yield FoundName(names[member[0]].package, member[0], method.offset, "override", len(types),
                                    given, False, True, member[1])  # fmt: skip

    def _list_all_bases(self, class_: CppClass, word: str, depth: int = 0) -> list[tuple[str, str]] | None:
        """The packages and names of the classes of other packages that a class is derived from; None where one of its
        bases is not known, or one of the package may have a member of that name itself."""
        found: list[tuple[str, str]] = []
        for base in class_.bases:
            type_ = self.resolver.find_type(base, locate_class(class_))
            if type_ is None or not type_.name or depth > _DEEPEST:
                return None
            if not type_.own:
                package = self.vocabulary.classes.get(type_.name)
                if package is None:
                    return None
                found.append((package, type_.name))
                continue
            own = self.resolver.list_own_classes(type_.name)
            if len(own) != 1 or own[0].open or word in own[0].members:
                return None
            inner = self._list_all_bases(own[0], word, depth + 1)
            if inner is None:
                return None
            found += inner
        return found

    def find_unimplemented(self, exported: Collection[str]) -> Iterator[FoundName]:
        """Methods that a base class in another package makes others implement in some version, and that a class of the
        file does not have of which objects are made. exported: the names of such classes."""
        code = self.resolver.known.code
        if not code.may_derive:
            return
        for class_ in code.file.classes:
            if class_.open or class_.template or not _is_among(class_.name, exported):
                continue
            own = self.resolver.list_own_lineage(class_.name)
            if any(one.open for one in own):
                continue
            # A macro may declare it (`MOCK_METHOD1(cancel, void(int))`): where the word stands, it may be there.
            names = [one.name.rpartition("::")[2] for one in own]
            files = [file for file in self.resolver.files if any(map(file.list_classes, names))]
            for one in own:
                for base in one.bases:
                    type_ = self.resolver.find_type(base, locate_class(one))
                    if type_ is None or type_.own or not type_.name:
                        continue
                    for name in self.vocabulary.list_pure(type_.name):
                        package, word = self.vocabulary.names[name].package, name.rpartition("::")[2]
                        if package not in self.vocabulary.home and not any(file.mentions(word) for file in files):
                            yield FoundName(package, name, class_.offset, "implement", -1, (), False, True, ())

    def _find_first(self, classes: Iterable[str], word: str) -> tuple[str, tuple[str, ...]] | None:
        return next((found for one in classes if (found := self.vocabulary.find_member(one, word)) is not None), None)


def find_instantiated(data: bytes) -> set[str]:
    """The names of classes of which a file makes objects by `new`, std::make_shared() or std::make_unique()."""
    return {name.decode() for name in _INSTANTIATED.findall(data)}


def _find_ahead(pattern: re.Pattern[str], text: str, end: int) -> str:
    """What stands before an offset of a text, empty where it does not match. pattern: of the same backwards."""
    found = pattern.match(text[max(0, end - _FAR) : end][::-1])
    return found[0][::-1] if found is not None else ""


def _is_declared(text: str, before: int, at: int) -> bool:
    """Whether the name at an offset stands behind a type, or in a sentence. before: where what stands before it ends.
    In capitals may be a macro, which is no type."""
    last = _find_ahead(_LAST_WORD, text, before) if "\n" not in text[before:at] else ""
    return last != "" and last not in _NO_TYPES and not last.isupper() and not last.startswith("__")


def _is_split(text: str, at: int) -> bool:
    """Whether a directive stands in the declaration at an offset, so that which parameters it has depends on it."""
    end = next(_DECLARED_END.finditer(text, at)).start()
    return _DIRECTIVE.search(text, at, end) is not None


def _may_differ(known: ChangingName, text: str, at: int) -> bool:
    """Whether what follows a name may call it in a way that not all versions take."""
    opened = _SPACE.match(text, at).end()  # type: ignore[union-attr]
    templated = text.startswith("<", opened)
    if templated:
        types = find_template_arguments(text, opened + 1)
        if types is None:
            return True
        opened = types.end()
    if known.what == "constructor":
        constructed = _CONSTRUCTED.match(text, opened)
        if constructed is None:
            return False
        opened = constructed.end() - 1
    else:
        opened = _SPACE.match(text, opened).end()  # type: ignore[union-attr]
        if not text.startswith("(", opened):
            return False
    found = _parse_arguments(text, opened)
    if found is None:
        return True
    count, given = found
    shown = [one for one in known.refuses if _SHOWN[one].search(given)]
    return known.differs("call", count, shown, templated)


@lru_cache(maxsize=64)  # every name that a word may be asks about the same place
def _parse_arguments(text: str, at: int) -> tuple[int, str] | None:
    """How many arguments a bracket gives that opens at an offset (-1 where it opens something else), and their text;
    None where that takes a parser."""
    depth, commas, place = 1, 0, at + 1
    while (mark := _MARKS.search(text, place, at + _FARTHEST)) is not None:
        sign, place = mark.group(), mark.end()
        if sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
            if depth == 0:
                given = text[at + 1 : place - 1]
                return (commas + 1 if given.strip() else 0), given
        elif sign == "," and depth == 1:
            commas += 1
        elif sign == ";" and depth == 1:
            return -1, ""  # the body of a class
        elif sign == "<" and depth == 1:
            types = find_template_arguments(text, place)
            if types is not None and "," in types.group():
                return None
        elif sign == "..." and depth == 1:
            return None
        elif sign == "//":
            place = text.find("\n", place)
        elif sign == "/*":
            place = text.find("*/", place)
        elif sign in _LITERALS and not (sign == "'" and text[mark.start() - 1].isalnum()):
            literal = _LITERALS[sign].match(text, mark.start())
            if literal is None or text[mark.start() - 1] == "R":
                return None
            place = literal.end()
        if place < 0:
            return None
    return None


def _is_among(class_: str, names: Collection[str]) -> bool:
    """Whether a class is one of those that are named, in full or without the namespaces around."""
    return any(f"::{class_}".endswith(f"::{name}") for name in names)


def normalise_parameter(parameter: WrittenParameter | str) -> str:
    """The type of a parameter in the form that surfaces have."""
    text = parameter if isinstance(parameter, str) else parameter.type
    return " ".join(re.sub(r"\s*([<>,&*:]+)\s*", r"\1", text).split())


class MemberUses:
    """Uses of fields and constants of other packages' interfaces that some version lacks."""

    def __init__(self, resolver: Resolver):
        assert resolver.scope is not None
        self.resolver, self.scope = resolver, resolver.scope

    def find_uses(self, words: Iterable[str], guess: bool) -> Iterator[FoundMember]:
        """Every use of such a member; guess: also accesses through something whose type does not show, of names that
        only one interface has."""
        for use in self.resolver.known.code.list_uses(words):
            if use.form == "scoped":
                found = self._find_constant(use)
            elif use.form == "member" and use.call is None:
                found = self._find_field(use, guess)
            else:
                continue
            if found is not None:
                yield found

    def _find_field(self, use: Written, guess: bool) -> FoundMember | None:
        assert use.object is not None
        type_ = self.resolver.resolve_value(use.object, use.place)
        if type_ is None:
            if not guess or "_" not in use.word or self._shows(use.object) or self.resolver.declares(use.word):
                return None
            known = self.scope.definitions.items()
            meant = [(i, s) for i, d in known for s in d.sections if "." not in s and use.word in d.sections[s]]
            return FoundMember(*meant[0], use.word, use.offset, False) if len(meant) == 1 else None
        if type_.interface is None or type_.several:
            return None
        section = self.scope.find_changed_section(type_.make_interface_type(), use.word)
        return FoundMember(type_.interface, section, use.word, use.offset, True) if section is not None else None

    def _shows(self, object_: Expr) -> bool:
        """Whether an object has a declared type of its own that is no interface's."""
        if object_.kind in ("this", "call"):
            return object_.kind == "this"
        if object_.kind != "name":
            return False
        local = object_.local
        if local is not None:
            return "auto" not in local.type
        return any(
            one.kind == "variable" and "auto" not in one.type
            for file in self.resolver.files
            if file.mentions(object_.text)
            for one in (*file.names.get(object_.text, ()), *_list_members(file, object_.text))
        )

    def _find_constant(self, use: Written) -> FoundMember | None:
        """`pkg::msg::Type::CONSTANT`, also through an alias or a part (`Type::Request::CONSTANT`)."""
        type_ = self.resolver.resolve_name(use.name.rpartition("::")[0], use.place)
        if type_ is None or type_.interface is None:
            return None
        if self.scope.find_changed_section(type_.make_interface_type(), use.word) is None:
            return None
        return FoundMember(type_.interface, type_.section, use.word, use.offset, True)


def _list_members(file: KnownFile, name: str):
    return [one for class_ in file.code.file.classes for one in class_.members.get(name, ())]
