"""Triage: sends a new bug report to the check that fits it."""
