"""What happened to the guards of a statement, as tables."""

import pytest
from rosimpact.impact.flow.guards import compare
from rosimpact.impact.model.flow.graph import GuardAt


def guards(path: str, *written: str) -> tuple[GuardAt, ...]:
    """Guards from `kind: text`."""
    return tuple(
        GuardAt(kind, text, path, line, "f")
        for line, (kind, text) in enumerate((guard.split(": ", 1) for guard in written), 1)
    )


CPP = [
    (["if: a && b"], ["if: a", "if: b"], "equivalent"),
    (["if: a && b"], ["unless: !a", "unless: not b"], "equivalent"),
    (["if: x > 0"], ["if: x > 3"], "tightened"),
    (["if: a"], ["if: a", "if: b"], "tightened"),
]


@pytest.mark.parametrize(("old", "new", "kind"), CPP, ids=str)
def test_cpp(old, new, kind):
    assert compare(guards("n.cpp", *old), guards("n.cpp", *new)) == kind
