"""The version of rosimpact, all rooms of it."""

__version__ = "0.1.0"
