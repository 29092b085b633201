"""Models of what libstdc++ keeps in its library: trees of std::map and std::set, lists, hashes.

Trees are kept in order, not balanced: nobody sees the difference. All texts have one hash: a hash may be anything, and
an unordered map compares keys of equal hashes.
"""

from __future__ import annotations

from typing import Any

from .access import load, store
from .executor import Call
from .layout import POINTER, get_integer_type
from .models import model, model_pattern
from .module import NULL, Pointer
from .terms import add_offsets

_COLOR, _PARENT, _LEFT, _RIGHT = 0, 8, 16, 24
_I32, _I64 = get_integer_type(32), get_integer_type(64)


def _get(call: Call, node: Pointer, place: int) -> Any:
    return load(call.run, call.state, Pointer(node.object, add_offsets(node.offset, place)), POINTER)


def _set(call: Call, node: Pointer, place: int, value: Any):
    store(call.run, call.state, Pointer(node.object, add_offsets(node.offset, place)), POINTER, value)


@model("_ZSt29_Rb_tree_insert_and_rebalancebPSt18_Rb_tree_node_baseS0_RS_")
def insert_node(call: Call) -> Any:
    is_left, node, parent, header = call.arguments
    is_left = call.run.decide(call.state, is_left)
    _set(call, node, _PARENT, parent)
    _set(call, node, _LEFT, NULL)
    _set(call, node, _RIGHT, NULL)
    store(call.run, call.state, Pointer(node.object, add_offsets(node.offset, _COLOR)), _I32, 1)
    if is_left:
        _set(call, parent, _LEFT, node)
        if parent == header:
            _set(call, header, _PARENT, node)
            _set(call, header, _RIGHT, node)
        elif parent == _get(call, header, _LEFT):
            _set(call, header, _LEFT, node)
    else:
        _set(call, parent, _RIGHT, node)
        if parent == _get(call, header, _RIGHT):
            _set(call, header, _RIGHT, node)


def _find_end(call: Call, node: Pointer, place: int) -> Pointer:
    while True:
        following = _get(call, node, place)
        if following == NULL:
            return node
        node = following


@model_pattern(r"_ZSt18_Rb_tree_incrementPK?St18_Rb_tree_node_base")
def find_next_node(call: Call) -> Any:
    node = call.arguments[0]
    right = _get(call, node, _RIGHT)
    if right != NULL:
        return _find_end(call, right, _LEFT)
    parent = _get(call, node, _PARENT)
    while node == _get(call, parent, _RIGHT):
        node, parent = parent, _get(call, parent, _PARENT)
    return parent if _get(call, node, _RIGHT) != parent else node


@model_pattern(r"_ZSt18_Rb_tree_decrementPK?St18_Rb_tree_node_base")
def find_previous_node(call: Call) -> Any:
    node = call.arguments[0]
    color = load(call.run, call.state, Pointer(node.object, add_offsets(node.offset, _COLOR)), _I32)
    parent = _get(call, node, _PARENT)
    if color == 0 and (parent == NULL or _get(call, parent, _PARENT) == node):
        # The header: the only red node whose parent's parent is itself.
        return _get(call, node, _RIGHT)
    left = _get(call, node, _LEFT)
    if left != NULL:
        return _find_end(call, left, _RIGHT)
    while node == _get(call, parent, _LEFT):
        node, parent = parent, _get(call, parent, _PARENT)
    return parent


@model("_ZSt28_Rb_tree_rebalance_for_erasePSt18_Rb_tree_node_baseRS_")
def remove_node(call: Call) -> Any:
    node, header = call.arguments
    left, right, parent = (_get(call, node, place) for place in (_LEFT, _RIGHT, _PARENT))
    if left == NULL or right == NULL:
        child = right if left == NULL else left
        _replace_child(call, parent, node, child, header)
    else:
        child = _find_end(call, right, _LEFT)
        if _get(call, child, _PARENT) != node:
            _replace_child(call, _get(call, child, _PARENT), child, _get(call, child, _RIGHT), header)
            _set(call, child, _RIGHT, right)
            _set(call, right, _PARENT, child)
        _replace_child(call, parent, node, child, header)
        _set(call, child, _LEFT, left)
        _set(call, left, _PARENT, child)
    root = _get(call, header, _PARENT)
    if root == NULL:
        _set(call, header, _LEFT, header)
        _set(call, header, _RIGHT, header)
    else:
        _set(call, header, _LEFT, _find_end(call, root, _LEFT))
        _set(call, header, _RIGHT, _find_end(call, root, _RIGHT))
    return node


def _replace_child(call: Call, parent: Pointer, old: Pointer, new: Any, header: Pointer):
    if _get(call, header, _PARENT) == old:
        _set(call, header, _PARENT, new)
        if new != NULL:
            _set(call, new, _PARENT, header)
        return
    _set(call, parent, _LEFT if _get(call, parent, _LEFT) == old else _RIGHT, new)
    if new != NULL:
        _set(call, new, _PARENT, parent)


# Lists: next at 0, previous at 8.


@model("_ZNSt8__detail15_List_node_base7_M_hookEPS0_")
def insert_list_node(call: Call) -> Any:
    node, position = call.arguments
    previous = _get(call, position, 8)
    _set(call, node, 0, position)
    _set(call, node, 8, previous)
    _set(call, previous, 0, node)
    _set(call, position, 8, node)


@model("_ZNSt8__detail15_List_node_base9_M_unhookEv")
def remove_list_node(call: Call) -> Any:
    node = call.arguments[0]
    following, previous = _get(call, node, 0), _get(call, node, 8)
    _set(call, previous, 0, following)
    _set(call, following, 8, previous)


@model("_ZNSt8__detail15_List_node_base11_M_transferEPS0_S1_")
def move_nodes(call: Call) -> Any:
    position, first, last = call.arguments
    if position == last:
        return
    last_previous, first_previous, previous = (_get(call, each, 8) for each in (last, first, position))
    _set(call, last_previous, 0, position)
    _set(call, first_previous, 0, last)
    _set(call, previous, 0, first)
    _set(call, position, 8, last_previous)
    _set(call, last, 8, first_previous)
    _set(call, first, 8, previous)


# Hashes.


@model("_ZSt11_Hash_bytesPKvmm", "_ZSt15_Fnv_hash_bytesPKvmm")
def hash_bytes(call: Call) -> Any:
    return 0


@model("_ZNKSt8__detail20_Prime_rehash_policy11_M_next_bktEm")
def find_bucket_count(call: Call) -> Any:
    run, state = call.run, call.state
    wanted = call.arguments[1]
    if not isinstance(wanted, int):
        values = run.list_values(state, wanted, 64, 64)
        if values is None:
            raise run.make_unknown("an unordered map whose size an input gives")
        wanted = run.choose(state, wanted, values)
    count = next((prime for prime in (2, 5, 13, 29, 59, 127, 257, 541, 1109, 2357, 5087) if prime >= wanted), 0)
    if not count:
        raise run.make_unknown("a large unordered map")
    policy = call.arguments[0]
    store(run, state, Pointer(policy.object, add_offsets(policy.offset, 8)), _I64, count)
    return count


@model("_ZNKSt8__detail20_Prime_rehash_policy14_M_need_rehashEmmm")
def check_rehash(call: Call) -> Any:
    """Grows as the tables of libstdc++ do: where there are more elements than buckets."""
    run, state = call.run, call.state
    buckets, elements, new = call.arguments[1:4]
    if not all(isinstance(each, int) for each in (buckets, elements, new)):
        raise run.make_unknown("an unordered map whose size an input gives")
    if elements + new <= max(buckets, 1) and buckets > 1:
        return [0, 0]
    wanted = max(elements + new, 2 * buckets, 11)
    count = next((prime for prime in (13, 29, 59, 127, 257, 541, 1109, 2357, 5087) if prime >= wanted), 0)
    if not count:
        raise run.make_unknown("a large unordered map")
    policy = call.arguments[0]
    store(run, state, Pointer(policy.object, add_offsets(policy.offset, 8)), _I64, count)
    return [1, count]


@model("_ZNKSt8__detail20_Prime_rehash_policy15_M_bkt_for_elementsEm")
def count_buckets(call: Call) -> Any:
    return call.arguments[1]
