"""Functions begin with a verb, as verbs.txt lists them: one that is missing there is added, a noun is not. What `of`
follows is a noun, however it is spelt (`hash_of`)."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parent.parent
VERBS = frozenset((Path(__file__).parent / "verbs.txt").read_text(encoding="utf-8").split())
# Searches are called as the facts that they make, and what libraries call has the name that they call.
_NAMED_OTHERWISE = (
    "main", "called_cpp", "declared_cpp", "mentioned_cpp", "searched_cpp", "searched_text", "used_cpp",
    "getresponse", "getheaders", "frombuf", "to_sec", "to_nsec", "to_msg", "now", "unregister", "create_module",
    "exec_module",
)  # fmt: skip

_NOUN = re.compile(r"_*(?!is_|list_|use_)[^_]+_of(?:_|\Z)")


def list_functions():
    for room in ("impact", "corpus", "classifier", "databuild", "edges"):
        for path in sorted((ROOT / room).rglob("*.py")):
            place = path.relative_to(ROOT).as_posix()
            for node in ast.walk(ast.parse(path.read_bytes())):
                if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                    decorated = " ".join(ast.unparse(each) for each in node.decorator_list)
                    shown = "cli" in path.with_suffix("").parts or decorated.startswith(
                        ("rule", "property", "cached_property")
                    )
                    if not (shown or "_property" in decorated or node.name.startswith("__")):
                        yield f"{place}:{node.lineno}", node.name


def test_functions_begin_with_a_verb():
    others = [
        f"{place} {name}"
        for place, name in list_functions()
        if name.lstrip("_") not in _NAMED_OTHERWISE
        and (name.strip("_").partition("_")[0] not in VERBS or _NOUN.match(name))
    ]
    assert others == []


def test_the_list_has_no_verb_that_nobody_uses():
    used = {name.strip("_").partition("_")[0] for _, name in list_functions()}
    assert used >= VERBS
