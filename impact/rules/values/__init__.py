"""Rules over values that publishers send and subscribers cannot handle; see docs/values.md. They take long."""
