"""Callbacks of Python nodes, run on symbolic messages by their syntax trees."""
