"""The JSON schemas of what msgspec describes: the message flow, and what a change reaches in it."""

import json
from collections.abc import Mapping
from typing import Any

SCHEMA = 1
STABLE = "Fields may be added without a new schema number; none is removed, renamed or given another meaning."
"""What every schema promises."""


def generate_schema(
    title: str, description: str, properties: Mapping[str, Any], parts: dict[str, Any], further: Mapping[str, Any]
) -> str:
    """A JSON schema (draft 2020-12) as text, of which msgspec made the parts. further: what need not be there."""
    for part in parts.values():
        part["description"] = " ".join(part.get("description", "").split())
        # Whoever reads must not trip over a new field.
        part.pop("additionalProperties", None)
    text = {"type": "string"}
    tool = {"type": "object", "required": ["name", "version"], "properties": {"name": text, "version": text}}
    properties = {"schema": {"const": SCHEMA}, "tool": tool, **properties}
    whole = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"rosimpact {title}, schema {SCHEMA}",
        "description": description,
        "type": "object",
        "required": list(properties),
        "properties": {**properties, **further},
        "$defs": dict(sorted(parts.items())),
    }
    return json.dumps(whole, indent=1) + "\n"
