"""Launch files followed: what they start, with which names and parameters."""
