"""Shared libraries of one machine."""
