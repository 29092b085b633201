"""Messages without what nobody reads."""
