"""The checks of outputs see what they are there to see."""

from __future__ import annotations

from typing import NamedTuple

import pytest

from . import outputs


class Ended(NamedTuple):
    status: int = 1


def plain(text: str, *command: str) -> list[str]:
    return list(outputs.plain_failures("output", text.encode("utf-8", "surrogateescape"), command, False, "utf-8"))


def document(format: str, text: str) -> list[str]:
    return list(outputs.format_failures(("check", "-f", format), Ended(), {"output": text.encode()}))


@pytest.mark.parametrize(
    "text",
    [
        "::error::x",
        "  ::error::x",
        "\u3000::x",
        "a\r::x",
        "a ##[group]b",
        "##vso[x]",
        "##teamcity[x]",
        "a\x1b[31m",
        "a\x9bb",
        "a\u202eb",
        "a\u2028b",
        "a\0b",
        "\udcff",
        "Traceback (most recent call last)",
        "this is a fault of rosimpact",
    ],
)
def test_what_speaks_is_heard(text):
    assert plain(text)


@pytest.mark.parametrize("text", ["a::b", "a: b\n\tc\n", "## heading", "\u4e2d\u6587", "\\x1b", "#[derive]"])
def test_what_is_harmless_is_let_be(text):
    assert not plain(text)


@pytest.mark.parametrize(
    ("line", "good"),
    [
        ("::error file=a,line=1,title=x::text", True),
        ("::notice::text", True),
        ("::add-mask::x", False),
        ("::error file=a:b::x", False),
        ("::error evil=1::x", False),
        (" ::error::x", False),
    ],
)
def test_workflow_commands(line, good):
    assert (not plain(line + "\n", "check", "-f", "github")) is good


@pytest.mark.parametrize(
    ("format", "text"),
    [
        ("json", "{"),
        ("markdown", "- ![x](y)"),
        ("markdown", "- [a](https://evil.example)"),
        ("markdown", "a <img src=x>"),
        ("markdown", "by @evil"),
        ("markdown", "`a` @evil ``b"),
        ("markdown", "https://evil.example"),
        ("html", "<p>x</p>"),
        ("html", "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'\"><p onclick=x>"),
        (
            "html",
            "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'\"><script>a</script><script>"
            "b</script><script>c</script>",
        ),
        ("html", "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'\"><img src=x>"),
        ("graphml", "<a><b></a>"),
        ("graphml", "<!DOCTYPE a><a/>"),
        ("dot", 'digraph { "a" -> evil; }'),
        ("dot", 'digraph { "a" [URL="x"]; }'),
        ("dot", 'digraph { "a" [label=<b>]; }'),
        ("dot", 'digraph { "a"'),
        ("mermaid", 'a["x"]\nclick evil "y"'),
        ("mermaid", 'a["<img src=evil>"]'),
        ("sarif", '{"message": {"text": "[evil](https://x)"}}'),
    ],
)
def test_what_is_wrong_in_a_format_is_seen(format, text):
    assert document(format, text)


@pytest.mark.parametrize(
    ("format", "text"),
    [
        ("json", "{}"),
        ("markdown", "- `@evil` ``a`b`` `<img>`\n\n<sub>x</sub>\n<details><summary>x</summary>\n\n</details>"),
        ("graphml", "<a><b/></a>"),
        ("dot", 'digraph g {\n  rankdir=LR;\n  "evil" -> "a\\"b" [label="x\\n"];\n}'),
        ("mermaid", 'flowchart LR\n  n0["evil"]\n  n0 --> n1'),
        ("sarif", '{"message": {"text": "\\\\[evil\\\\](x)"}}'),
    ],
)
def test_what_is_right_in_a_format_is_let_be(format, text):
    assert document(format, text) == []
