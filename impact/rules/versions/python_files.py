"""What the place of a Python file in its package says about a finding in it, for the rules on Python versions."""

from __future__ import annotations

from ..severity import Doubt


def doubts_of_role(role: str) -> tuple[Doubt, ...]:
    """What speaks against an error in a file. role: build, run, test or aside, as the model has it."""
    if role in ("run", "build"):
        return ()
    return (Doubt.TEST,) if role == "test" else (Doubt.EXAMPLE,)
