"""Conditions of publishing compared between revisions."""
