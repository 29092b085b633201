"""Reads the text of LLVM IR (opaque pointers, clang 15 to 20). Bodies of functions, initial values of variables and
debug information are read when they are asked for: of what <string> and <vector> bring, little runs.

What the operands of an instruction are, by opcode:

    binary, icmp, fcmp   (left, right); extra: the predicate
    cast                 (value,); extra: (name, type of the value)
    load                 (address,); extra: alignment
    store                (value, address); type: of the value; extra: alignment
    gep                  (base, *indices); extra: (source type, types of the indices)
    br, switch           (condition, ...); extra: labels
    phi                  values; extra: labels
    call                 (callee, *arguments as `Argument`); extra: (label of the normal end, label of unwinding)
    landingpad           typeinfos; extra: kinds (`catch`, `filter`), and whether it is a cleanup
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

from .layout import (
    DOUBLE,
    FLOAT,
    POINTER,
    VOID,
    ArrayType,
    IrType,
    LongDoubleType,
    StructureType,
    get_integer_type,
)
from .module import (
    NULL,
    UNDEFINED,
    Argument,
    BasicBlock,
    BytesConstant,
    Composite,
    Computed,
    Function,
    GlobalName,
    GlobalVariable,
    Instruction,
    ReadingError,
    Zeros,
)

_TOKEN = re.compile(
    r"""\s*(c?"(?:[^"\\]|\\.)*"|[%@$]"[^"]*"|[%@$][-\w$.]+|![\w.]*|\#\d+|\.\.\.|-?\d+\.\d+(?:e[+-]?\d+)?"""
    r"""|0x[KLMHR]?[0-9A-Fa-f]+|-?\d+|[A-Za-z_][\w.$]*|[\[\]{}()<>,=*:|])"""
)
_HEAD = re.compile(r"^define [^\n]*?(@\"[^\"]*\"|@[-\w$.]+)\(", re.MULTILINE)
_VARIABLE = re.compile(r"^(@\"[^\"]*\"|@[-\w$.]+) = ([^\n]*)$", re.MULTILINE)
_TYPE = re.compile(r"^(%\"[^\"]*\"|%[-\w$.:]+) = type ([^\n]*)$", re.MULTILINE)
_DECLARED = re.compile(r"^declare [^\n]*?(@\"[^\"]*\"|@[-\w$.]+)\(", re.MULTILINE)
_METADATA = re.compile(r"^!(\d+) = (?:distinct )?(!DI(?:Location|Subprogram|Lexical|File)[^\n]*)$", re.MULTILINE)
_LABEL = re.compile(r'([-\w$.]+|"[^"]*"):')
_ATTACHED = re.compile(r",? ![A-Za-z][\w.]* (?:!\d+|!\{\})")
_PLACE = re.compile(r"!dbg !(\d+)")
_LOCAL_LINKAGE = re.compile(r"(?:private|internal)\b")

_SKIPPED = frozenset(
    (
        "noundef", "nonnull", "nocapture", "readonly", "writeonly", "readnone", "noalias", "signext", "zeroext",
        "returned", "immarg", "inreg", "nofree", "local_unnamed_addr", "unnamed_addr", "dso_local",
        "dso_preemptable", "internal", "private", "linkonce_odr", "linkonce", "weak", "weak_odr", "external",
        "extern_weak", "hidden", "protected", "default", "tail", "musttail", "notail", "fastcc", "ccc",
        "coldcc", "nest", "swiftself", "allocptr", "allocalign", "available_externally", "comdat",
        "thread_local", "appending", "common", "nuw", "nsw", "exact", "inbounds", "fast", "nnan", "ninf", "nsz",
        "arcp", "contract", "afn", "reassoc", "volatile", "disjoint", "nneg", "samesign", "nusw", "noext",
        "writable", "dead_on_unwind", "dead_on_return", "inrange", "externally_initialized", "icmp_samesign",
        "cxx_fast_tlscc", "swiftcc", "swifttailcc",
    )
)  # fmt: skip
_SKIPPED_WITH_VALUE = frozenset(
    (
        "comdat", "align", "dereferenceable", "dereferenceable_or_null", "sret", "captures", "initializes", "range",
        "memory", "inrange", "elementtype", "preallocated", "inalloca", "nofpclass", "addrspace",
        "thread_local", "vscale_range", "alignstack",
    )
)  # fmt: skip
INTEGER_OPERATIONS = (
    "add", "sub", "mul", "udiv", "sdiv", "urem", "srem", "and", "or", "xor", "shl", "lshr", "ashr",
)  # fmt: skip
FLOAT_OPERATIONS = ("fadd", "fsub", "fmul", "fdiv", "frem")
_BINARY = frozenset((*INTEGER_OPERATIONS, *FLOAT_OPERATIONS))
_CASTS = frozenset(
    (
        "zext", "sext", "trunc", "fptosi", "fptoui", "sitofp", "uitofp", "fpext", "fptrunc", "bitcast", "ptrtoint",
        "inttoptr", "addrspacecast",
    )
)  # fmt: skip
_IGNORED_CALLS = ("@llvm.dbg.", "@llvm.lifetime.", "@llvm.experimental.noalias", "@llvm.assume", "@llvm.pseudoprobe")


class _Tokens:
    """The tokens of one line (or of several that belong together), read from left to right."""

    def __init__(self, text: str, unit: IrUnit):
        self.unit = unit
        self.position = 0
        self.extent = 0
        self.tokens: list[str] = []
        position, end = 0, len(text)
        while position < end:
            match = _TOKEN.match(text, position)
            if match is None:
                if text[position:].lstrip().startswith(";") or not text[position:].strip():
                    break
                raise ReadingError(text[position : position + 60])
            self.tokens.append(match.group(1))
            position = match.end()

    def peek(self, ahead: int = 0) -> str:
        place = self.position + ahead
        return self.tokens[place] if place < len(self.tokens) else ""

    def take(self) -> str:
        if self.position >= len(self.tokens):
            raise ReadingError("end of the line: " + " ".join(self.tokens[:12]))
        self.position += 1
        return self.tokens[self.position - 1]

    def accept(self, token: str) -> bool:
        if self.peek() == token:
            self.position += 1
            return True
        return False

    def expect(self, token: str):
        found = self.take()
        if found != token:
            raise ReadingError(f"`{found}` instead of `{token}`: " + " ".join(self.tokens[:12]))

    def skip_parentheses(self):
        """After an opening one."""
        depth = 1
        while depth:
            token = self.take()
            depth += (token == "(") - (token == ")")

    def skip_attributes(self) -> IrType | None:
        """Skips what says nothing here; gives the type of a byval attribute, and keeps how many bytes there are."""
        copied, self.extent = None, 0
        while True:
            token = self.peek()
            if token in ("dereferenceable", "dereferenceable_or_null") and self.peek(2).isdigit():
                self.extent = int(self.peek(2))
            if token == "byval" or (token == "byref" and self.peek(1) == "("):
                self.take()
                self.expect("(")
                copied = self.read_type()
                self.expect(")")
            elif token in _SKIPPED_WITH_VALUE and (self.peek(1) == "(" or self.peek(1).isdigit()):
                self.take()
                if self.accept("("):
                    self.skip_parentheses()
                else:
                    self.take()
            elif token in _SKIPPED or token.startswith("#") or (token.startswith('"') and token.endswith('"')):
                self.take()
                if self.peek() == "=" and self.peek(1).startswith('"'):
                    self.position += 2
            else:
                return copied

    def read_type(self) -> IrType:
        token = self.take()
        found: IrType
        if token == "ptr":
            found = POINTER
            if self.accept("addrspace"):
                self.expect("(")
                self.skip_parentheses()
        elif token[0] == "i" and token[1:].isdigit():
            found = get_integer_type(int(token[1:]))
        elif token == "double":
            found = DOUBLE
        elif token == "float":
            found = FLOAT
        elif token == "void" or token in ("label", "metadata", "token"):
            found = VOID
        elif token == "[":
            count = int(self.take())
            self.expect("x")
            found = ArrayType(count, self.read_type(), False)
            self.expect("]")
        elif token == "<":
            if self.accept("{"):
                found = StructureType(self._read_types("}"), True)
            else:
                count = int(self.take())
                self.expect("x")
                found = ArrayType(count, self.read_type(), True)
            self.expect(">")
        elif token == "{":
            found = StructureType(self._read_types("}"), False)
        elif token[0] == "%":
            found = self.unit.find_type(token)
        elif token in ("x86_fp80", "fp128"):
            found = LongDoubleType(16)
        elif token in ("half", "bfloat"):
            found = LongDoubleType(2)
        elif token == "opaque":
            found = StructureType([], False, True)
        else:
            raise ReadingError(f"type `{token}`")
        return found

    def _read_types(self, end: str) -> list[IrType]:
        types = []
        while not self.accept(end):
            types.append(self.read_type())
            self.accept(",")
        return types

    def read_operand(self, type_: IrType) -> Any:
        """A value whose type was read."""
        token = self.take()
        first = token[0]
        if first == "%":
            return token
        if first == "@":
            return GlobalName(self.unit.make_key(token))
        if type_.is_float:
            if token.startswith("0x"):
                return struct.unpack("<d", struct.pack("<Q", int(token, 16)))[0]
            if first.isdigit() or first == "-":
                return float(token)
        if first.isdigit() or first == "-":
            if isinstance(type_, LongDoubleType):
                return UNDEFINED
            return int(token, 16 if token.startswith("0x") else 10) & ((1 << type_.bits) - 1)
        if token == "true":
            return 1
        if token in ("false", "none"):
            return 0
        if token == "null":
            return NULL
        if token == "zeroinitializer":
            return make_zero(type_)
        if token in ("undef", "poison"):
            return UNDEFINED
        if first == "c" and token[1:2] == '"':
            return BytesConstant(_unescape(token[2:-1]))
        if token in ("[", "{"):
            return Composite(tuple(self._read_typed({"[": "]", "{": "}"}[token])))
        if token == "<":
            if self.accept("{"):
                parts = Composite(tuple(self._read_typed("}")))
                self.expect(">")
                return parts
            return Composite(tuple(self._read_typed(">")))
        if token == "splat" and isinstance(type_, ArrayType):
            self.expect("(")
            part = self.read_typed()
            self.expect(")")
            return Composite((part,) * type_.count)
        return self._read_expression(token, type_)

    def _read_expression(self, token: str, type_: IrType) -> Any:
        self.skip_attributes()
        if token == "getelementptr":
            self.skip_attributes()
            self.expect("(")
            source = self.read_type()
            self.expect(",")
            parts = self._read_typed(")")
            return Computed("gep", type_, (source, tuple(parts)))
        if token in _CASTS:
            self.expect("(")
            source, operand = self.read_typed()
            self.expect("to")
            target = self.read_type()
            self.expect(")")
            return Computed("cast", target, (token, source, operand))
        if token in _BINARY:
            self.expect("(")
            return Computed(token, type_, tuple(self._read_typed(")")))
        if token == "icmp":
            predicate = self.take()
            self.expect("(")
            return Computed("icmp", type_, (predicate, *self._read_typed(")")))
        if token == "select":
            self.expect("(")
            return Computed("select", type_, tuple(self._read_typed(")")))
        if token in ("dso_local_equivalent", "no_cfi"):
            return GlobalName(self.unit.make_key(self.take()))
        raise ReadingError(f"constant `{token}`")

    def read_typed(self) -> tuple[IrType, Any]:
        self.skip_attributes()
        type_ = self.read_type()
        self.skip_attributes()
        return type_, self.read_operand(type_)

    def _read_typed(self, end: str) -> list[tuple[IrType, Any]]:
        parts = []
        while not self.accept(end):
            parts.append(self.read_typed())
            self.accept(",")
        return parts

    def read_arguments(self) -> list[Argument]:
        """Those of a call, after the opening parenthesis."""
        arguments = []
        while not self.accept(")"):
            if self.accept("..."):
                continue
            self.skip_attributes()
            type_ = self.read_type()
            copied = self.skip_attributes()
            if type_ is VOID:
                depth = 0
                while depth or self.peek() not in (",", ")"):
                    token = self.take()
                    depth += (token == "(") - (token == ")")
                arguments.append(Argument(type_, UNDEFINED, None))
            else:
                extent = self.extent
                arguments.append(Argument(type_, self.read_operand(type_), copied, extent))
            self.accept(",")
        return arguments

    def read_alignment(self) -> int:
        """`, align 8` at the end of a load or a store; 1 where it is not there."""
        while self.peek():
            if self.take() == "align":
                return int(self.take())
        return 1


def _unescape(text: str) -> bytes:
    return re.sub(rb"\\([0-9A-Fa-f]{2})", lambda found: bytes([int(found[1], 16)]), text.encode("latin-1"))


def make_zero(type_: IrType) -> Any:
    """The zero of a type, as an operand."""
    if type_.is_integer:
        return 0
    if type_.is_float:
        return 0.0
    if type_.is_pointer:
        return NULL
    return Zeros(type_)


class IrUnit:
    """The text of one module. Names of its own (private, internal) are told from those of other modules by its
    number."""

    def __init__(self, text: str, number: int):
        self.text = text
        self.number = number
        self._types: dict[str, IrType] = {}
        self._type_texts = dict(_TYPE.findall(text))
        self.function_places: dict[str, int] = {}
        self.variable_texts: dict[str, str] = {}
        self.declared: set[str] = set(_DECLARED.findall(text))
        self._own: set[str] = set()
        for found in _HEAD.finditer(text):
            self.function_places[found[1]] = found.start()
            if _LOCAL_LINKAGE.search(text, found.start(), found.start(1)):
                self._own.add(found[1])
        for found in _VARIABLE.finditer(text):
            self.variable_texts[found[1]] = found[2]
            if _LOCAL_LINKAGE.match(found[2]):
                self._own.add(found[1])

    @cached_property
    def metadata(self) -> dict[str, str]:
        return dict(_METADATA.findall(self.text))

    def make_key(self, name: str) -> str:
        """The name among all modules."""
        plain = name[1:].strip('"')
        return f"{plain}#{self.number}" if name in self._own else plain

    def find_type(self, name: str) -> IrType:
        if name not in self._types:
            text = self._type_texts.get(name)
            if text is None:
                raise ReadingError(f"type `{name}` is not defined")
            self._types[name] = _Tokens(text, self).read_type()
        return self._types[name]

    def list_keys(self) -> Iterator[tuple[str, str]]:
        """Of functions and variables: key and name."""
        for name in (*self.function_places, *self.variable_texts):
            yield self.make_key(name), name

    def read_variable(self, name: str) -> GlobalVariable | str | None:
        """The variable of that name, or the key of what it is an alias of; None where the text is not understood."""
        text = self.variable_texts[name]
        alias = re.search(r"\b(?:alias|ifunc)\b[^@]*(@\"[^\"]*\"|@[-\w$.]+)", text.split('"', 1)[0] or text)
        if alias and not re.search(r"\b(?:global|constant)\b", text[: alias.start()]):
            return self.make_key(alias[1])
        tokens = _Tokens(re.sub(r",? !\w+ !\d+", "", text), self)
        is_external = False
        while tokens.peek() not in ("global", "constant"):
            token = tokens.take()
            is_external |= token in ("external", "extern_weak")
            if tokens.peek() == "(":
                tokens.take()
                tokens.skip_parentheses()
        is_constant = tokens.take() == "constant"
        type_ = tokens.read_type()
        value = None if is_external else tokens.read_operand(type_)
        return GlobalVariable(self.make_key(name), name[1:].strip('"'), type_, value, is_constant)

    def read_function(self, name: str) -> Function:
        start = self.function_places[name]
        end = self.text.index("\n}", start)
        lines = self.text[start:end].split("\n")
        head = lines[0]
        located = _PLACE.search(head)
        parameters = self._read_parameters(head, name)
        unnamed = sum(1 for each in parameters if each[1:].isdigit())
        function = Function(
            self.make_key(name), name[1:].strip('"'), parameters, {}, f"%{unnamed}", self,
            int(located[1]) if located else 0,
        )  # fmt: skip
        self._read_body(function, lines[1:])
        return function

    def _read_parameters(self, head: str, name: str) -> list[str]:
        start = head.index(name + "(") + len(name) + 1
        depth, end = 1, start
        while depth and end < len(head):
            depth += (head[end] == "(") - (head[end] == ")")
            end += 1
        tokens = _Tokens(head[start:end], self)
        parameters: list[str] = []
        while not tokens.accept(")"):
            if tokens.accept("..."):
                continue
            tokens.skip_attributes()
            tokens.read_type()
            tokens.skip_attributes()
            parameters.append(tokens.take() if tokens.peek()[:1] == "%" else f"%{len(parameters)}")
            tokens.accept(",")
        return parameters

    def _read_body(self, function: Function, lines: Sequence[str]):
        block: BasicBlock | None = None
        position, count = 0, len(lines)
        while position < count:
            line = lines[position]
            position += 1
            if not line.strip() or line.startswith(";"):
                continue
            if line[0] != " ":
                label = _LABEL.match(line)
                if label:
                    block = BasicBlock("%" + label[1], len(function.blocks), [], [])
                    if not function.blocks:
                        function.entry = block.label
                    function.blocks[block.label] = block
                continue
            stripped = line.lstrip()
            if stripped.startswith("#dbg"):
                continue
            if block is None:
                block = BasicBlock(function.entry, 0, [], [])
                function.blocks[block.label] = block
            if stripped.startswith("switch") and line.rstrip().endswith("["):
                while not lines[position].strip().startswith("]"):
                    line += " " + lines[position]
                    position += 1
                line += " " + lines[position]
                position += 1
            elif "invoke " in line and "unwind label" not in line:
                line += " " + lines[position]
                position += 1
            elif "landingpad" in line:
                while position < count and lines[position].strip().startswith(("cleanup", "catch", "filter")):
                    line += " " + lines[position]
                    position += 1
            if any(each in line for each in _IGNORED_CALLS):
                continue
            self._read_line(line, block)

    def _read_line(self, line: str, block: BasicBlock):
        located = _PLACE.search(line)
        text = _ATTACHED.sub("", line) if "!" in line else line
        try:
            instruction = _read_instruction(_Tokens(text, self))
        except (ReadingError, ValueError, IndexError, KeyError) as problem:
            result = re.match(r"\s*(%[-\w$.]+) =", line)
            said = f"{problem}: {text.strip()[:60]}"
            instruction = Instruction("unsupported", result[1] if result else "", VOID, (), said)
        instruction.location = int(located[1]) if located else 0
        (block.phis if instruction.opcode == "phi" else block.instructions).append(instruction)


def _read_instruction(tokens: _Tokens) -> Instruction:
    result = ""
    if tokens.peek()[0] == "%" and tokens.peek(1) == "=":
        result = tokens.take()
        tokens.take()
    opcode = tokens.take()
    while opcode in ("tail", "musttail", "notail"):
        opcode = tokens.take()
    if opcode in _BINARY:
        tokens.skip_attributes()
        type_ = tokens.read_type()
        left = tokens.read_operand(type_)
        tokens.expect(",")
        return Instruction(opcode, result, type_, (left, tokens.read_operand(type_)))
    if opcode in _CASTS:
        tokens.skip_attributes()
        source, operand = tokens.read_typed()
        tokens.expect("to")
        return Instruction("cast", result, tokens.read_type(), (operand,), (opcode, source))
    return _READERS.get(opcode, _read_other)(tokens, opcode, result)


def _read_other(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    raise ReadingError(f"instruction `{opcode}`")


def _read_comparison(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    tokens.skip_attributes()
    predicate = tokens.take()
    tokens.skip_attributes()
    type_ = tokens.read_type()
    left = tokens.read_operand(type_)
    tokens.expect(",")
    return Instruction(opcode, result, type_, (left, tokens.read_operand(type_)), predicate)


def _read_unary(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    type_, operand = tokens.read_typed()
    return Instruction(opcode, result, type_, (operand,))


def _read_alloca(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    tokens.skip_attributes()
    type_ = tokens.read_type()
    count: Any = 1
    if tokens.accept(",") and tokens.peek() != "align":
        count = tokens.read_typed()[1]
    return Instruction(opcode, result, type_, (count,))


def _read_load(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    while tokens.peek() in ("atomic", "volatile"):
        tokens.take()
    type_ = tokens.read_type()
    tokens.expect(",")
    address = tokens.read_typed()[1]
    return Instruction(opcode, result, type_, (address,), tokens.read_alignment())


def _read_store(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    while tokens.peek() in ("atomic", "volatile"):
        tokens.take()
    type_, value = tokens.read_typed()
    tokens.expect(",")
    address = tokens.read_typed()[1]
    return Instruction(opcode, result, type_, (value, address), tokens.read_alignment())


def _read_exchange(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    while tokens.peek() in ("weak", "volatile"):
        tokens.take()
    operation = tokens.take() if opcode == "atomicrmw" else ""
    address = tokens.read_typed()[1]
    tokens.expect(",")
    type_, first = tokens.read_typed()
    operands: tuple = (address, first)
    if opcode == "cmpxchg":
        tokens.expect(",")
        operands = (address, first, tokens.read_typed()[1])
    return Instruction(opcode, result, type_, operands, operation)


def _read_fence(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    return Instruction(opcode, result, VOID, ())


def _read_address(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    tokens.skip_attributes()
    source = tokens.read_type()
    tokens.expect(",")
    operands, types = [], []
    while True:
        type_, operand = tokens.read_typed()
        operands.append(operand)
        types.append(type_)
        if not tokens.accept(","):
            break
    if any(isinstance(each, ArrayType) for each in types):
        raise ReadingError("addresses of a vector")
    return Instruction("gep", result, POINTER, tuple(operands), (source, tuple(types[1:])))


def _read_branch(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    if tokens.accept("label"):
        return Instruction("jump", "", VOID, (), (tokens.take(),))
    _, condition = tokens.read_typed()
    labels = []
    while tokens.accept(","):
        tokens.expect("label")
        labels.append(tokens.take())
    return Instruction(opcode, "", VOID, (condition,), tuple(labels))


def _read_switch(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    type_, value = tokens.read_typed()
    tokens.expect(",")
    tokens.expect("label")
    default = tokens.take()
    tokens.expect("[")
    cases = []
    while not tokens.accept("]"):
        _, constant = tokens.read_typed()
        tokens.expect(",")
        tokens.expect("label")
        cases.append((constant, tokens.take()))
    return Instruction(opcode, "", type_, (value,), (default, tuple(cases)))


def _read_phi(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    tokens.skip_attributes()
    type_ = tokens.read_type()
    values: dict[str, Any] = {}
    while True:
        tokens.expect("[")
        value = tokens.read_operand(type_)
        tokens.expect(",")
        values[tokens.take()] = value
        tokens.expect("]")
        if not tokens.accept(","):
            break
    return Instruction(opcode, result, type_, (), values)


def _read_select(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    _, condition = tokens.read_typed()
    tokens.expect(",")
    type_, first = tokens.read_typed()
    tokens.expect(",")
    return Instruction(opcode, result, type_, (condition, first, tokens.read_typed()[1]))


def _read_return(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    if tokens.accept("void"):
        return Instruction(opcode, "", VOID, ())
    type_, value = tokens.read_typed()
    return Instruction(opcode, "", type_, (value,))


def _read_call(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    tokens.skip_attributes()
    type_ = tokens.read_type()
    if tokens.accept("("):
        tokens.skip_parentheses()
    if tokens.peek() == "asm":
        return Instruction("asm", result, type_, (), " ".join(tokens.tokens[tokens.position :])[:80])
    callee = tokens.read_operand(POINTER)
    tokens.expect("(")
    arguments = tokens.read_arguments()
    labels: tuple[str, str] = ("", "")
    if opcode == "invoke":
        while tokens.peek() != "to":
            tokens.take()
        tokens.take()
        tokens.expect("label")
        normal = tokens.take()
        tokens.expect("unwind")
        tokens.expect("label")
        labels = (normal, tokens.take())
    return Instruction("call", result, type_, (callee, *arguments), labels)


def _read_landing(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    type_ = tokens.read_type()
    kinds, infos, is_cleanup = [], [], False
    while tokens.peek():
        kind = tokens.take()
        if kind == "cleanup":
            is_cleanup = True
        else:
            kinds.append(kind)
            infos.append(tokens.read_typed()[1])
    return Instruction(opcode, result, type_, tuple(infos), (tuple(kinds), is_cleanup))


def _read_part(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    type_, whole = tokens.read_typed()
    operands: list[Any] = [whole]
    if opcode == "insertvalue":
        tokens.expect(",")
        operands.append(tokens.read_typed()[1])
    indices = []
    while tokens.accept(","):
        indices.append(int(tokens.take()))
    return Instruction(opcode, result, type_, tuple(operands), tuple(indices))


def _read_lanes(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    type_, first = tokens.read_typed()
    operands: list[Any] = [first]
    while tokens.accept(","):
        operands.append(tokens.read_typed()[1])
    return Instruction(opcode, result, type_, tuple(operands))


def _read_variadic(tokens: _Tokens, opcode: str, result: str) -> Instruction:
    _, address = tokens.read_typed()
    tokens.expect(",")
    return Instruction(opcode, result, tokens.read_type(), (address,))


_READERS = {
    "icmp": _read_comparison,
    "fcmp": _read_comparison,
    "fneg": _read_unary,
    "freeze": _read_unary,
    "alloca": _read_alloca,
    "load": _read_load,
    "store": _read_store,
    "atomicrmw": _read_exchange,
    "cmpxchg": _read_exchange,
    "fence": _read_fence,
    "getelementptr": _read_address,
    "br": _read_branch,
    "switch": _read_switch,
    "phi": _read_phi,
    "select": lambda tokens, opcode, result: (tokens.skip_attributes(), _read_select(tokens, opcode, result))[1],
    "ret": _read_return,
    "call": _read_call,
    "invoke": _read_call,
    "landingpad": _read_landing,
    "resume": _read_unary,
    "unreachable": _read_fence,
    "extractvalue": _read_part,
    "insertvalue": _read_part,
    "extractelement": _read_lanes,
    "insertelement": _read_lanes,
    "shufflevector": _read_lanes,
    "va_arg": _read_variadic,
}


class Program:
    """Several modules as one, as a linker would join them: functions, variables and types by key."""

    def __init__(self, texts: Sequence[str]):
        self.units = [IrUnit(text, number) for number, text in enumerate(texts)]
        self._functions: dict[str, tuple[IrUnit, str]] = {}
        self._variables: dict[str, list[tuple[IrUnit, str]]] = {}
        for unit in self.units:
            for name in unit.function_places:
                self._functions.setdefault(unit.make_key(name), (unit, name))
            for name in unit.variable_texts:
                self._variables.setdefault(unit.make_key(name), []).append((unit, name))
        self._declared = {unit.make_key(name) for unit in self.units for name in unit.declared}
        self._read_functions: dict[str, Function] = {}
        self._read_variables: dict[str, GlobalVariable | str | None] = {}

    def is_function(self, key: str) -> bool:
        """Whether a key names a function, with a body or without."""
        return key in self._functions or (key in self._declared and key not in self._variables)

    def has_body(self, key: str) -> bool:
        return key in self._functions

    def get_function(self, key: str) -> Function:
        """A function with its body. Raises KeyError where there is none."""
        if key not in self._read_functions:
            unit, name = self._functions[key]
            self._read_functions[key] = unit.read_function(name)
        return self._read_functions[key]

    def get_variable(self, key: str) -> GlobalVariable | str | None:
        """A variable, the key of what it is an alias of, or None. One with a value is preferred."""
        if key not in self._read_variables:
            found: GlobalVariable | str | None = None
            for unit, name in self._variables.get(key, ()):
                each = unit.read_variable(name)
                if found is None or isinstance(each, str) or (each is not None and each.value is not None):
                    found = each
            self._read_variables[key] = found
        return self._read_variables[key]

    def list_constructors(self) -> list[str]:
        """Keys of the functions that initialize variables before main, in their order."""
        found: list[tuple[int, str]] = []
        for unit in self.units:
            if "@llvm.global_ctors" not in unit.variable_texts:
                continue
            variable = unit.read_variable("@llvm.global_ctors")
            if not isinstance(variable, GlobalVariable) or not isinstance(variable.value, Composite):
                continue
            for _, entry in variable.value.parts:
                if isinstance(entry, Composite) and isinstance(entry.parts[1][1], GlobalName):
                    found.append((entry.parts[0][1], entry.parts[1][1].name))
        return [key for _, key in sorted(found, key=lambda each: each[0])]
