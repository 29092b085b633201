"""Where reports come from: one module per service."""
