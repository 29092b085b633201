"""Launch files and files like them: what they refer to (references.py), and what they start and set (flow.py)."""
