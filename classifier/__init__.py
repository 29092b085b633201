"""Triage: sends a new bug report to the check that fits it."""

from ..edges.version import __version__ as __version__
