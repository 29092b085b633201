"""Bytes to facts: one extractor per file type. Extractors know no paths and do no I/O."""
