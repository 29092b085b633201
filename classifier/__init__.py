"""Triage: sends a new bug report to the check that fits it."""

__version__ = "0.1.0"
