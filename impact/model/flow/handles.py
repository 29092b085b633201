"""Namespaces of node handles: of ROS 1's, of transports that are made with one, and of sub-nodes of ROS 2."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property

from ...facts.flow import Assignment, FlowExpr
from .calls import Calls, FrameworkCall
from .code import Fn, Variable, find_parameter, get_tail
from .elements import select_reaching
from .reaching import FlowValue
from .values import LOST, FlowValues, spell_condition

_HANDLES = frozenset(("handle", "image_transport", "cloud_transport"))
_WRITTEN = frozenset(("make", "list", "call", "name", "text", "choice", "join"))
_SUB_NODE = "create_sub_node"
_DEEPEST = 8
_MOST_STEPS = 300
# http://docs.ros.org/en/noetic/api/controller_interface/html/c++/classcontroller__interface_1_1Controller.html
_CONTROLLER_BEGINS = frozenset(("init", "initRequest"))
_CONTROLLER_BASES = ("controller_interface::Controller", "controller_interface::MultiInterfaceController")
_OWN = FlowValue("")
_LOST = FlowValue(LOST)


class NodeHandles:
    """Asks a body of code for the namespaces of its node handles: `~` is that of a private one, empty the node's own,
    and what begins with LOST is not known."""

    def __init__(self, calls: Calls):
        self.calls, self.code = calls, calls.code
        self._left = 0
        # Whether a handle was come to that is made of no other.
        self._is_made_anew = False

    def is_of_process(self, use: FrameworkCall, values: FlowValues) -> bool:
        """Whether the handle that a name is given to is made of no other, so that it has the namespace and the
        remappings of the process, also in a nodelet, whose own come with its getNodeHandle(). values: as for
        list_prefixes()."""
        self._is_made_anew = False
        return len(self.list_prefixes(use, values)) == 1 and self._is_made_anew

    def list_prefixes(self, use: FrameworkCall, values: FlowValues) -> list[FlowValue]:
        """What the namespace of the handle may be that a name is given to. values: what expressions are worth where it
        runs."""
        handle = self._find_handle(use)
        self._left = _MOST_STEPS
        found = self._list_spaces(handle, use.fn, use.call.line, values, ()) if handle is not None else ()
        return list(dict.fromkeys(found)) or [_OWN]

    def _find_handle(self, use: FrameworkCall) -> FlowExpr | None:
        """The handle, node or transport that a use is made on; None where it does not tell a namespace."""
        row = use.row
        if row.first == "node" and use.call.arguments:
            return next((a for a in use.call.arguments if self.calls.is_node(a, use.fn)), None)
        if row.does in ("action server", "action client") and use.call.arguments:
            handle = use.call.arguments[0]
            return handle if self.calls.is_node(handle, use.fn) else None
        receiver = self.calls.get_receiver(use)
        sub_nodes = row.framework in ("rclcpp", "rclcpp_action") and self._has_sub_nodes
        if not receiver or (row.framework not in ("roscpp", "image_transport") and not sub_nodes):
            return None
        if not receiver.endswith("()"):
            return FlowExpr("name", receiver)
        made = receiver.removesuffix("()")
        near = [call for call in use.fn.facts.calls if call.callee == made]
        near.sort(key=lambda call: abs(call.line - use.call.line))
        return FlowExpr("call", made, near[0].arguments if near else ())

    @cached_property
    def _has_sub_nodes(self) -> bool:
        return bool(self.code.list_calls_named((_SUB_NODE,)))

    def _list_spaces(
        self, value: FlowExpr, fn: Fn, line: int, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        """The namespaces that an expression may have. line: at which it stands, 0 for any; seen: the variables that are
        being followed."""
        self._left -= 1
        if len(seen) > _DEEPEST or self._left < 0:
            yield _LOST
        elif value.kind == "call":
            yield from self._list_called(value, fn, line, values, seen)
        elif value.kind == "make" and self._makes_node(value.text, fn):
            yield _OWN
        elif value.kind in ("make", "list"):
            yield from self._list_made(value.parts, fn, line, values, seen)
        elif value.kind == "choice" and len(value.parts) == 3:
            for part in value.parts[1:]:
                yield from self._list_spaces(part, fn, line, values, seen)
        elif self._is_text(value, fn):
            yield from self._evaluate(value, fn, line, values)
        elif value.kind == "name":
            yield from self._list_named(value, fn, line, values, seen)
        else:
            yield _OWN

    def _list_called(
        self, value: FlowExpr, fn: Fn, line: int, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        last = get_tail(value.text)
        if "PrivateNodeHandle" in last or last in ("getPrivateNodeHandle", "private_node_handle"):
            yield FlowValue("~")
            return
        if last == _SUB_NODE:
            node = FlowExpr("name", value.text.rpartition(".")[0] or "this")
            yield from self._list_made((node, *value.parts), fn, line, values, seen)
            return
        if self.calls.find_kinds(self.code.resolve_written(value.text, fn.source, fn.scope), fn) & _HANDLES:
            yield from self._list_made(value.parts, fn, line, values, seen)
            return
        found = False
        near = [call for call in fn.list_calls(value.text) if call.arguments == value.parts]
        for target in self.code.list_targets(value.text, fn):
            inside = values.limit_to_calls({**values.way, target: near[0]}) if near else values
            for each in target.facts.assignments:
                if each.operator == "return":
                    found = True
                    yield from self._list_spaces(each.value, target, each.line, inside, seen)
        if not found:
            yield self._resolve_unless_handle(value, fn)

    def _list_named(
        self, value: FlowExpr, fn: Fn, line: int, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        variable = self.code.identify(value.text, fn)
        if variable in seen:
            return
        seen = (*seen, variable)
        if "[]" in value.text:
            # Which of several it is, is not known.
            kept = set(self._list_kept(variable, fn, values, seen))
            yield kept.pop() if len(kept) == 1 else _LOST
            return
        found = list(self._list_written(variable, value, fn, line, values, seen))
        setters = self._list_setters_of_copies(variable) if not found else []
        for setter in [one for one in setters if values.runs(one)] or setters:
            found += self._list_spaces(value, setter, 0, values, seen)
        if not found and variable.kind == "member":
            for declared, holder in self.code.list_declared_values(variable, fn):
                found += self._list_spaces(declared, holder, 0, values, seen)
        if found:
            yield from found
            return
        named = "priv" in value.text.lower() or get_tail(value.text).strip("_") in ("pnh", "nh_p")
        private = FlowValue("~") if named else None
        for one in self.code.list_enclosing_chain(fn) if variable.kind == "local" else ():
            place = find_parameter(one, variable.name)
            if place is not None:
                for handle, giver, at in values.list_given(one, place[0], variable.name):
                    found += self._list_spaces(handle, giver, at, values, seen)
                told = self._find_controller_handle(one, place[0])
                yield from found or [told or private or self._resolve_unless_handle(value, fn)]
                return
        if "NodeHandle" in self.code.find_declared_type(variable, fn)[0] and not self._is_pointer(variable, fn):
            self._is_made_anew = True
        # A member of an object that a call gives, which no class of the code is.
        unknown = "()." in value.text and not self.code.list_class_bodies(variable.owner)
        yield private or (_LOST if unknown else _OWN)

    def _find_controller_handle(self, fn: Fn, place: int) -> FlowValue | None:
        """What ros_control gives the method that begins a controller for a parameter of it, None for all else: the
        handle of the controller, whose name is its namespace, behind that of the manager if it takes both."""
        owner = self.code.find_owner(fn) if get_tail(fn.name) in _CONTROLLER_BEGINS else None
        names = self.code.list_base_names(owner) if owner is not None else ()
        if not any(name.partition("<")[0].startswith(_CONTROLLER_BASES) for name in names):
            return None
        handles = [at for at, one in enumerate(fn.facts.parameters) if "NodeHandle" in one.type]
        if place not in handles:
            return None
        return FlowValue("~") if place == handles[-1] else _OWN

    def _list_written(
        self, variable: Variable, value: FlowExpr, fn: Fn, line: int, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        """What is written into a variable, or what it is made anew with."""
        rows = [
            (writer, each)
            for writer, each in self.code.list_writes(variable)
            if each.value.kind in _WRITTEN and each.value != value and not (each.value.kind == "list" and each.key)
        ]
        rows = self._select_running(rows, values)
        rows = [row for row in rows if not values.is_left_out(row[0])] or rows
        last = self._select_last(rows, fn, line)
        # What is made empty is given something later.
        last = [row for row in last if row[1].value.parts or row[1].value.kind != "make"] or last
        known: dict[str, list[FlowValue]] = {}
        for writer, each in last:
            branch = values.decide_branch(each.guard, writer)
            if branch.holds is False:
                continue
            condition = self._spell_condition(writer, each.guard, last) if not branch.holds else ""
            for one in self._list_spaces(each.value, writer, each.line, values, seen):
                both = " && ".join(dict.fromkeys(filter(None, (condition, one.only_if))))
                known.setdefault(one.text or "", []).append(one._replace(only_if=both))
        if last and not self._is_surely_written(last, fn, line) and not self._is_pointer(variable, fn):
            beginning = FlowValue("", only_if="the node handle is not replaced")
            known.setdefault("", []).append(beginning)
        # Where all give the same, it is the same under any condition.
        for found in known.values():
            yield from found if len(known) > 1 else [min(found, key=lambda one: one.only_if != "")._replace(only_if="")]
        if last:
            return
        kept = [row for row in self.code.list_results(variable) if get_tail(row[1].callee).startswith("make_")]
        for caller, call in self._select_running(kept, values):
            if self._makes_node(call.types, caller):
                yield _OWN
            else:
                yield from self._list_made(call.arguments, caller, call.line, values, seen)
        if not kept:
            for caller, given in self._select_running(self.code.list_resets(variable), values):
                yield from self._list_spaces(given, caller, 0, values, seen)

    def _makes_node(self, written: str, fn: Fn) -> bool:
        """Whether an object of a type is a node, whose first argument is no namespace."""
        kind = self.code.resolve_written(written, fn.source, fn.scope) if written else None
        return kind is not None and "node" in self.calls.find_kinds(kind, fn)

    def _list_kept(
        self, variable: Variable, fn: Fn, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        """The namespaces of the handles in a list or dictionary."""
        for writer, each in self._select_running(self.code.list_writes(variable), values):
            inside = each.target.endswith("[]")
            parts = each.value.parts if each.value.kind == "list" and not inside else ()
            for part in parts or ((each.value,) if inside else ()):
                yield from self._list_spaces(part, writer, each.line, values, seen)
        for caller, call in self.code.list_calls_named(("push_back", "emplace_back")):
            if self.code.identify(call.callee.rpartition(".")[0], caller) != variable:
                continue
            if get_tail(call.callee) == "emplace_back":
                yield from self._list_made(call.arguments, caller, call.line, values, seen)
            else:
                for part in call.arguments[:1]:
                    yield from self._list_spaces(part, caller, call.line, values, seen)

    @staticmethod
    def _is_surely_written(rows: Sequence[tuple[Fn, Assignment]], fn: Fn, line: int) -> bool:
        """Whether one of some assignments has run when a line of a function is come to."""
        around = {place for guard in fn.collect_guards(line) for place in fn.list_guards_around(guard)}
        for writer, each in rows:
            if each.guard < 0 or (writer is fn and each.guard in around):
                return True
            guards = writer.facts.guards
            one, inner = guards[each.guard], [row.guard for w, row in rows if w is writer and row.guard >= 0]
            if any(
                (guards[place].text, guards[place].line) == (one.text, one.line) and guards[place].kind != one.kind
                for place in inner
            ):
                return True
        return False

    def _is_pointer(self, variable: Variable, fn: Fn) -> bool:
        written = self.code.find_declared_type(variable, fn)[0]
        return not written or "*" in written or "&" in written or "ptr" in written.lower()

    def _spell_condition(self, fn: Fn, guard: int, rows: Sequence[tuple[Fn, Assignment]]) -> str:
        """Under which condition an assignment is what a handle has, where others may be. rows: all of them."""
        if guard >= 0:
            one = fn.facts.guards[guard]
            return spell_condition(one.kind, one.text)
        later = any(writer is fn and each.guard >= 0 for writer, each in rows)
        others = not self.code.is_constructor(fn) and any(writer is not fn for writer, _ in rows)
        elsewhere = any(writer is not fn and not self.code.is_constructor(writer) for writer, _ in rows)
        return "the node handle is not replaced" if later or others or elsewhere else ""

    @staticmethod
    def _select_running(rows: Sequence[tuple], values: FlowValues) -> Sequence[tuple]:
        """Of rows that begin with a function those whose function runs; all where none does."""
        return [row for row in rows if values.runs(row[0])] or rows

    @staticmethod
    def _select_last(rows: Sequence[tuple], fn: Fn, line: int) -> list[tuple]:
        """Of assignments those that may hold on a line of a function, 0 for any; of those of other functions that one
        comes after another in, the last."""
        found: list[tuple] = []
        for writer in dict.fromkeys(row[0] for row in rows):
            own = [row for row in rows if row[0] is writer]
            found += select_reaching(own, fn, line) if writer is fn and line else select_reaching(own, writer, 0)
        return found

    def _list_setters_of_copies(self, variable: Variable) -> list[Fn]:
        """A function of each file that includes the header of a variable, and sets it."""
        found: dict[str, Fn] = {}
        for copy in self.code.list_copies(variable):
            rows = (*self.code.list_writes(copy), *self.code.list_results(copy), *self.code.list_resets(copy))
            found.update((copy.owner, setter) for setter, _ in rows)
        return list(found.values())

    def _resolve_unless_handle(self, value: FlowExpr, fn: Fn) -> FlowValue:
        """The node's own namespace for what only stands for a node; that of a handle from elsewhere is not known."""
        own = value.kind == "call" and get_tail(value.text).endswith("NodeHandle")
        known = self.calls.find_kinds(self.code.resolve_type(value, fn), fn)
        return _LOST if "handle" in known and not own else _OWN

    def _list_made(
        self, arguments: tuple[FlowExpr, ...], fn: Fn, line: int, values: FlowValues, seen: tuple[Variable, ...]
    ) -> Iterator[FlowValue]:  # fmt: skip
        """The namespaces of a handle that is made with some arguments."""
        if not arguments:
            self._is_made_anew = True
            yield _OWN
            return
        first = arguments[0]
        if self._is_text(first, fn):
            self._is_made_anew = True
            yield from self._evaluate(first, fn, line, values)
            return
        if first.kind == "index":
            yield _LOST  # no handle: those are not kept in lists, texts are
            return
        bases = list(dict.fromkeys(self._list_spaces(first, fn, line, values, seen)))
        second = arguments[1] if len(arguments) > 1 else None
        if second is None or not (self._is_text(second, fn) or second.kind in ("index", "choice")):
            yield from bases
            return
        for below in self._evaluate(second, fn, line, values):
            for base in bases:
                yield join_spaces(base, below)

    def _is_text(self, value: FlowExpr, fn: Fn) -> bool:
        if value.kind == "choice" and len(value.parts) == 3:
            return all(self._is_text(part, fn) for part in value.parts[1:])
        if value.kind in ("text", "join"):
            return True
        return not self.calls.is_node(value, fn) and self.calls.is_textual(value, fn)

    @staticmethod
    def _evaluate(value: FlowExpr, fn: Fn, line: int, values: FlowValues) -> Iterable[FlowValue]:
        """What a namespace may be that is given to a handle. roscpp takes the slash at the end away before it resolves
        it, so that `/` is that of the node or handle around."""
        found = values.evaluate(value, fn, line)
        return [_LOST if one.text is None else one._replace(text="") if one.text == "/" else one for one in found]


def join_spaces(base: FlowValue, below: FlowValue) -> FlowValue:
    """A name, or a namespace, in a namespace; it is known as the less certain of both is."""
    space, text = base.text or "", below.text or ""
    if text[:1] in ("/", "~") or text.startswith(LOST) or not space:
        joined = text
    elif not text:
        joined = space
    else:
        joined = f"~{text}" if space == "~" else f"{space.rstrip('/')}/{text}"
    certain = base if below.how == "literal" else below
    only_if = " && ".join(dict.fromkeys(filter(None, (base.only_if, below.only_if))))
    return below._replace(text=joined, how=certain.how, only_if=only_if)
