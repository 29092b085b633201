"""Whatever nodes, topics and types are called, a drawing is one of its format, and speaks to nobody."""

import json
import re
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosimpact.impact.model.flow.graph import Coverage, Endpoint, Graph, Node, Publish
from rosimpact.impact.report.graph import draw

PARTS = st.sampled_from([
    '"', "\\", "\\N", "\\\\", "]", "[", ";", "#", "%%{init: {}}%%", "\nclick a href x\n", "\r", "\x1b[2J",
    "\u202e", "\udcff", "\x00", "\ufffe", "\x0b", "</script>", "<!--", "]]>", "&amp;", "&", "<b>",
    "\n::add-mask::x", "##[group]x", "##vso[a]", "end", "`", "é", "日", " ", "a", "->", "{", "}", "|",
])  # fmt: skip
NAMES = st.lists(PARTS, min_size=1, max_size=6).map("".join)
STRING = r'"(?:[^"\\\x00-\x1f]|\\.)*"'
DOT = re.compile(rf"  {STRING}(?: -> {STRING})?(?: \[(?:[a-z]+=(?:{STRING}|\w+)(?:, )?)*\])?;|digraph message_flow {{|"
                 r"  rankdir=LR;|  node \[fontname=Helvetica, fontsize=10\];|}")  # fmt: skip
MERMAID = re.compile(r'flowchart LR|  [a-z]\d+(?:\(\["[^"\[\]{}<>`%|\\]*"\]\)|\["[^"\[\]{}<>`%|\\]*"\])|'
                     r"  [a-z]\d+ (?:-->|-\.->) [a-z]\d+|  linkStyle .*")  # fmt: skip


def graph_of(node, topic, kind):
    return Graph(
        (Node(node, node, topic, "executable"),),
        (Endpoint("publisher", node, topic, kind, topic, 3, topic), Endpoint("server", node, topic, kind, topic, 3)),
        (Publish(node, topic, kind, topic, 4),), (), (), Coverage(1, 1, 0, 1, (topic,)), root=topic, rev=node,
    )  # fmt: skip


def for_all(text):
    assert not re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202e\ud800-\udfff\ufffe]", text)
    assert not re.search(r"##[A-Za-z]{0,20}\[", text)
    assert not re.search(r"(?m)^\s*::", text)


@settings(max_examples=60, deadline=None)
@given(NAMES, NAMES, NAMES)
def test_drawings(node, topic, kind):
    now, before = graph_of(node, topic, kind), graph_of(node, topic, "other")
    for base in (None, before):
        drawn = {each: draw(now, each, base, everything=True) for each in ("dot", "mermaid", "graphml", "json", "html")}
        for text in drawn.values():
            for_all(text)
        assert all(map(DOT.fullmatch, drawn["dot"].splitlines())), drawn["dot"]
        assert all(map(MERMAID.fullmatch, drawn["mermaid"].splitlines())), drawn["mermaid"]
        tree = ElementTree.fromstring(drawn["graphml"].encode())
        assert len(tree.findall(".//{*}node")) == 3
        found = json.loads(drawn["json"])
        assert (found["workspace"], found["nodes"][0]["id"], found["topics"][0]["name"]) == (topic, node, topic)
        block = drawn["html"].partition('id="data">')[2].partition("</script>")[0]
        assert json.loads(block)["nodes"] and not re.search("[<>&]", block)


@settings(max_examples=60, deadline=None)
@given(NAMES, NAMES, NAMES)
def test_in_text_no_name_begins_a_line(node, topic, kind):
    text = draw(graph_of(node, topic, kind), "text", everything=True)
    for_all(text)
    for line in filter(None, text.splitlines()):
        assert line.startswith(("topic ", "service ", " ", "1 ")), line


@pytest.mark.parametrize("format", ["text", "dot", "mermaid"])
def test_bytes_of_names_are_shown(format):
    text = draw(graph_of("caf\udce9", "/t", "k"), format, everything=True)
    assert {"text": "caf\\xe9", "dot": "caf\\\\xe9", "mermaid": "caf#92;xe9"}[format] in text
