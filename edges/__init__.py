"""Where rosimpact touches the world: files read and written, documents parsed, text printed, and the limits of each.

A workspace is hostile input (docs/security.md). Every room goes through these modules, which know nothing of ROS:

    files      opens regular files only, never waits, never reads more than a limit; writes whole files or nothing
    documents  YAML, TOML and JSON within limits of depth and size
    console    escapes what is shown, and speaks to people on both streams
    start      where the program begins; interrupts, what Ctrl-C does at any moment
    limits     every limit, and how a user changes it
"""
