"""Callbacks explored: for which values of a message a callback acts, does nothing, only logs, or crashes."""
