"""Bug reports of the field: gathered, labelled, published as ids and labels."""

__version__ = "0.1.0"
"""Of rosimpact, all rooms of it."""
