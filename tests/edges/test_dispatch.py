"""Methods found by their names."""

import ast

from rosimpact.edges.dispatch import collect_methods, collect_node_methods


class Base:
    def visit_If(self):
        return "if"

    visit_While = visit_If


class Reader(Base):
    def visit_Name(self):
        return "name"

    def visit_Nonsense(self):
        return "of no Python"

    def visited_For(self):
        return "another word"


def test_methods_by_what_stands_behind_the_prefix():
    assert {name: method(Reader()) for name, method in collect_methods(Reader, "visit_").items()} == {
        "If": "if", "While": "if", "Name": "name", "Nonsense": "of no Python",
    }  # fmt: skip


def test_methods_by_the_class_of_nodes():
    assert set(collect_node_methods(Reader, "visit_")) == {ast.If, ast.While, ast.Name}
