"""What is made of the message-flow graph: drawings of it, and what changed in it between revisions."""
