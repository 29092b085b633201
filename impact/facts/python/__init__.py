"""Python sources: read once (source.py), then told what they use (reader.py) and do (flow.py)."""
