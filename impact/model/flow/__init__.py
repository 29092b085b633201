"""Who talks to whom: facts of nodes, joined into a message-flow graph."""
