"""Attacks on the command line, as a table: see README.md."""
