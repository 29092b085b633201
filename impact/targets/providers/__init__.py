"""Who provides a header, module, CMake name or key."""
