"""Which fields of a message its subscribers read, and which its publishers set."""
