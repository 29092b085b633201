"""What is kept of a person: the name to attribute a text to."""

from __future__ import annotations

import re

_ADDRESS = re.compile(r"[^\s@]+@[^\s@]+\.[^\s@]+\Z")


def make_public_name(name: object) -> str:
    """A public name as it was given; of one that is a mail address, only what stands before the @."""
    text = " ".join(str(name or "").split())
    return text.partition("@")[0] if _ADDRESS.match(text) else text
