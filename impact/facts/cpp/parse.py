"""C++ sources to syntax trees."""

from collections.abc import Callable

from tree_sitter import Node, Tree

from .flow_clean import Cleaned, clean_further, clean_source
from .flow_grammar import PARSER, find_errors


def parse_source(
    data: bytes, is_misread: Callable[[Cleaned, Node], bool] = lambda source, root: False
) -> tuple[Cleaned, Node, set[tuple[int, int]]]:
    """A source as it is parsed, its root, and the lines (first, last) that did not parse. is_misread: whether something
    is wrong with a tree that has no errors. Where either is so, the source is cleaned further, and the better tree
    taken."""
    source = clean_source(data)
    tree = PARSER.parse(source.source)
    root = tree.root_node
    wrong = find_errors(root, source.starts)
    if wrong or is_misread(source, root):
        further = clean_further(data, source)
        if further.source != source.source:
            again = _parse_again(tree, source.source, further.source)
            still_wrong = find_errors(again, further.starts)
            if len(still_wrong) <= len(wrong):
                return further, again, still_wrong
    return source, root, wrong


def _parse_again(tree: Tree, before: bytes, after: bytes) -> Node:
    """The root of a source some of whose bytes were replaced by as many others: only what the lines touch in which they
    lie is parsed anew. tree: of the source as it was; it is changed, and places in it are by bytes alone."""
    start = 0
    for row, line in enumerate(before.splitlines(keepends=True)):
        end = start + len(line)
        if after[start:end] != line:
            tree.edit(start, end, end, (row, 0), (row + 1, 0), (row + 1, 0))
        start = end
    return PARSER.parse(after, tree).root_node
