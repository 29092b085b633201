"""The CMake interpreter: values, conditions, control flow, and what each family of commands means."""
